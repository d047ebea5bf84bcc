//! Numbers in the sections of a task's file, little-endian.

use super::task_file::Block;
use crate::data::EdgeKind;
use crate::terrain::tiles::{
    Gate, GateSide, Residual, ResidualEdge, SubConstraint, TileTriangle, TileVertex, Waiting,
};

pub(super) fn put_u32(to: &mut Vec<u8>, value: u32) {
    to.extend_from_slice(&value.to_le_bytes());
}

pub(super) fn put_u64(to: &mut Vec<u8>, value: u64) {
    to.extend_from_slice(&value.to_le_bytes());
}

/// Appends where a block is, and its checksum.
pub(super) fn put_block(to: &mut Vec<u8>, block: Block) {
    put_u64(to, block.at);
    put_u64(to, block.length);
    put_u32(to, block.sum);
}

pub(super) fn put_numbers(to: &mut Vec<u8>, values: &[f64]) {
    values
        .iter()
        .for_each(|value| to.extend_from_slice(&value.to_le_bytes()));
}

fn put_vertex(to: &mut Vec<u8>, vertex: &TileVertex) {
    put_u32(to, vertex.tile);
    put_u32(to, vertex.number);
    put_numbers(to, &vertex.position);
    to.push(u8::from(vertex.is_tight));
}

/// The bytes of a vertex.
const VERTEX_BYTES: usize = 4 + 4 + 24 + 1;

/// Takes numbers from bytes; `None` where they end.
pub(super) struct NumberReader<'a> {
    rest: &'a [u8],
}

impl<'a> NumberReader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        NumberReader { rest: bytes }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.rest.split_first_chunk()?;
        self.rest = rest;
        Some(*first)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    pub(super) fn block(&mut self) -> Option<Block> {
        Some(Block {
            at: self.u64()?,
            length: self.u64()?,
            sum: self.u32()?,
        })
    }

    pub(super) fn point(&mut self) -> Option<[f64; 3]> {
        Some([self.f64()?, self.f64()?, self.f64()?])
    }

    fn vertex(&mut self) -> Option<TileVertex> {
        let (tile, number, position) = (self.u32()?, self.u32()?, self.point()?);
        Some(TileVertex {
            tile,
            number,
            position,
            is_tight: self.boolean()?,
        })
    }

    fn boolean(&mut self) -> Option<bool> {
        match self.take()? {
            [0] => Some(false),
            [1] => Some(true),
            _ => None,
        }
    }

    fn kind(&mut self) -> Option<EdgeKind> {
        let [number] = self.take()?;
        EdgeKind::ALL.get(usize::from(number)).copied()
    }
}

/// Returns the bytes of points.
pub(super) fn of_points(points: &[[f64; 3]]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(24 * points.len());
    put_numbers(&mut bytes, points.as_flattened());
    bytes
}

/// Appends the points with these bytes; `None` if they are not those of points.
pub(super) fn add_points(bytes: &[u8], to: &mut Vec<[f64; 3]>) -> Option<()> {
    let mut reader = NumberReader::new(bytes);
    to.reserve(bytes.len() / 24);
    while !reader.is_empty() {
        to.push(reader.point()?);
    }
    Some(())
}

/// Returns the bytes of sub-constraints.
pub(super) fn of_constraints(constraints: &[SubConstraint]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(CONSTRAINT_BYTES * constraints.len());
    for SubConstraint { ends, kind } in constraints {
        put_numbers(&mut bytes, ends.as_flattened());
        bytes.push(kind.number());
    }
    bytes
}

/// The bytes of a sub-constraint.
pub(super) const CONSTRAINT_BYTES: usize = 4 * 8 + 1;

/// Returns the sub-constraints with these bytes; `None` if they are damaged.
pub(super) fn to_constraints(bytes: &[u8]) -> Option<Vec<SubConstraint>> {
    let mut reader = NumberReader::new(bytes);
    let mut constraints = Vec::with_capacity(bytes.len() / CONSTRAINT_BYTES);
    while !reader.is_empty() {
        let ends = [
            [reader.f64()?, reader.f64()?],
            [reader.f64()?, reader.f64()?],
        ];
        constraints.push(SubConstraint {
            ends,
            kind: reader.kind()?,
        });
    }
    Some(constraints)
}

/// Returns the bytes of a residual.
pub(super) fn of_residual(residual: &Residual) -> Vec<u8> {
    let Residual {
        vertices,
        edges,
        pending,
        has_lines,
    } = residual;
    let mut bytes = Vec::with_capacity(17 + VERTEX_BYTES * vertices.len() + 10 * edges.len());
    bytes.push(u8::from(*has_lines));
    put_u64(&mut bytes, vertices.len() as u64);
    put_u64(&mut bytes, edges.len() as u64);
    vertices
        .iter()
        .for_each(|vertex| put_vertex(&mut bytes, vertex));
    for ResidualEdge {
        ends,
        is_seam,
        kind,
    } in edges
    {
        ends.iter().for_each(|&end| put_u32(&mut bytes, end));
        bytes.extend([u8::from(*is_seam), kind.number()]);
    }
    bytes.append(&mut of_constraints(pending));
    bytes
}

/// Returns the residual with these bytes; `None` if they are damaged.
pub(super) fn to_residual(bytes: &[u8]) -> Option<Residual> {
    let mut reader = NumberReader::new(bytes);
    let has_lines = reader.boolean()?;
    let mut count = |size: usize| {
        usize::try_from(reader.u64()?)
            .ok()
            .filter(|&count| count <= bytes.len() / size)
    };
    let (vertex_count, edge_count) = (count(VERTEX_BYTES)?, count(10)?);
    let vertices = (0..vertex_count)
        .map(|_| reader.vertex())
        .collect::<Option<_>>()?;
    let mut edge = || {
        let ends = [reader.u32()?, reader.u32()?];
        Some(ResidualEdge {
            ends,
            is_seam: reader.boolean()?,
            kind: reader.kind()?,
        })
    };
    let edges = (0..edge_count).map(|_| edge()).collect::<Option<_>>()?;
    Some(Residual {
        vertices,
        edges,
        pending: to_constraints(reader.rest)?,
        has_lines,
    })
}

/// Returns the bytes of the gates of what waits, and of its triangles.
pub(super) fn of_waiting(waiting: &Waiting) -> [Vec<u8>; 2] {
    let (mut gates, mut triangles) = (Vec::new(), Vec::new());
    for Gate { edge, side } in &waiting.gates {
        edge.iter().for_each(|&end| put_u64(&mut gates, end));
        let (kind, group) = match side {
            GateSide::Outside => (0, 0),
            GateSide::Open(group) => (1, *group),
            GateSide::Closed(group) => (2, *group),
        };
        gates.push(kind);
        put_u32(&mut gates, group);
    }
    for (triangle, group) in waiting.triangles.iter().zip(&waiting.group_of) {
        put_waiting(&mut triangles, triangle, *group);
    }
    [gates, triangles]
}

/// Appends the bytes of a triangle that waits, with a number.
pub(super) fn put_waiting(to: &mut Vec<u8>, triangle: &TileTriangle, number: u32) {
    triangle
        .corners
        .iter()
        .for_each(|corner| put_vertex(to, corner));
    to.extend(triangle.edges.map(EdgeKind::number));
    put_u32(to, number);
}

/// The bytes of a gate.
const GATE_BYTES: usize = 2 * 8 + 1 + 4;

/// Returns the gates with these bytes, of which there are some groups; `None` if they are not those
/// of gates.
pub(super) fn to_gates(bytes: &[u8], groups: u32) -> Option<Vec<Gate>> {
    let mut reader = NumberReader::new(bytes);
    let mut gates = Vec::with_capacity(bytes.len() / GATE_BYTES);
    while !reader.is_empty() {
        let edge = [reader.u64()?, reader.u64()?];
        let side = match (reader.take()?, reader.u32()?) {
            ([0], 0) => GateSide::Outside,
            ([1], group) if group < groups => GateSide::Open(group),
            ([2], group) if group < groups => GateSide::Closed(group),
            _ => return None,
        };
        gates.push(Gate { edge, side });
    }
    Some(gates)
}

/// The bytes of a triangle that waits.
pub(super) const WAITING_BYTES: usize = 3 * VERTEX_BYTES + 3 + 4;

/// Returns the triangle with these bytes and its number; `None` if they are damaged.
pub(super) fn to_waiting(bytes: &[u8]) -> Option<(TileTriangle, u32)> {
    let mut reader = NumberReader::new(bytes);
    let corners = [reader.vertex()?, reader.vertex()?, reader.vertex()?];
    let edges = [reader.kind()?, reader.kind()?, reader.kind()?];
    Some((TileTriangle { corners, edges }, reader.u32()?))
}

//! The one place where the verb meets the triangulation.

use crate::geometry::{Geometry, Plane};
use crate::kernel::Kernel;
use crate::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::{ConstrainedDelaunay, LineId, Location, OnCrossing, Refused};

/// A triangulation of points and segments, as plain lists. Vertices have numbers of their own.
#[derive(Debug, Default)]
pub(super) struct Built {
    /// Where the vertices are.
    pub(super) vertices: Vec<[f64; 2]>,
    /// The vertex of each point; points at one place share theirs.
    pub(super) vertex_of: Vec<u32>,
    /// The triangles; none if all points are on one line.
    pub(super) faces: Vec<Face>,
    /// The vertices along each segment.
    pub(super) chains: Vec<Vec<u32>>,
    /// Where each place that was asked for lies.
    pub(super) places: Vec<Place>,
}

/// A triangle: side `i` is opposite corner `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Face {
    /// Counter-clockwise.
    pub(super) corners: [u32; 3],
    pub(super) neighbors: [Option<u32>; 3],
    pub(super) is_wall: [bool; 3],
}

/// Where a place lies among the walls of a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// In this face, or on an edge or a vertex of it that is on no wall.
    Face(u32),
    /// On a wall: it is not told which side is meant.
    Wall,
    Outside,
}

/// Triangulates points and segments between them, and finds where places lie. Each segment is a line of the
/// triangulation, by its position.
pub(super) fn build<K: Kernel>(
    points: &[[f64; 2]],
    segments: &[[u32; 2]],
    places: &[[f64; 2]],
    on_crossing: OnCrossing,
) -> Result<Built, Refused> {
    // Zero has one sign only: places are compared bit by bit when sorted.
    let sites: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| x + 0.0)).collect();
    let (t, vertices) = ConstrainedDelaunay::<_>::from_lines(Plane::<K>::default(), &sites, segments, on_crossing)?;
    let chains: Vec<Vec<VertexId>> = (0..segments.len()).map(|i| t.chain(LineId::new(i))).collect();

    let number = |v: &VertexId| v.index() as u32;
    let cells: Vec<CellId> = if t.dimension() == 2 { t.finite_cells().collect() } else { Vec::new() };
    let mut face_of = vec![None; t.tds().cell_slots()];
    for (face, cell) in (0u32..).zip(&cells) {
        face_of[cell.index()] = Some(face);
    }
    let face = |cell: &CellId| Face {
        corners: t.tds().corners(*cell).map(|v| number(&v)),
        neighbors: [0, 1, 2].map(|i| face_of[t.tds().neighbor(*cell, i).index()]),
        is_wall: [0, 1, 2].map(|i| t.is_constrained(*cell, i)),
    };
    Ok(Built {
        vertices: t.points().to_vec(),
        vertex_of: vertices.iter().map(number).collect(),
        faces: cells.iter().map(face).collect(),
        chains: chains.iter().map(|chain| chain.iter().map(number).collect()).collect(),
        places: places.iter().map(|p| place(&t, &face_of, p.map(|x| x + 0.0))).collect(),
    })
}

fn place<K: Kernel>(t: &ConstrainedDelaunay<Plane<K>>, face_of: &[Option<u32>], p: [f64; 2]) -> Place {
    // A place that the predicates have no answer for is further out, or nearer to zero, than any vertex.
    if t.dimension() < 2 || !t.geometry().admits(&p) {
        return Place::Outside;
    }
    let in_face = |cell: CellId| face_of[cell.index()].map_or(Place::Outside, Place::Face);
    match t.locate(&p, None) {
        Location::Vertex(v) if walls(t, v).next().is_some() => Place::Wall,
        Location::Vertex(v) => {
            t.tds().around(v).find_map(|cell| face_of[cell.index()]).map_or(Place::Outside, Place::Face)
        }
        Location::Cell { cell, touching } => {
            match (0..3).any(|i| touching >> i & 1 == 1 && t.is_constrained(cell, i)) {
                true => Place::Wall,
                false => in_face(cell),
            }
        }
        Location::OutsideHull { .. } | Location::OutsideAffineHull => Place::Outside,
    }
}

/// The vertices at the other ends of the walls that start at one.
fn walls<K: Kernel>(t: &ConstrainedDelaunay<Plane<K>>, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
    t.tds().around(v).filter_map(move |cell| {
        let i = t.tds().index_of(cell, v)?;
        t.is_constrained(cell, cw(i)).then(|| t.tds().vertex(cell, ccw(i)))
    })
}

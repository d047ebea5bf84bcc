use std::io::{self, Write};

use crate::engine::ConstrainedEdges;
use crate::geometry::{Crossing, Geometry};
use crate::kinds::{Basic, Constrained, Delaunay, Regular};
use crate::lines::ConstrainedDelaunay;
use crate::tds::{CellId, Tds, VertexId};
use crate::triangulation::Triangulation;

use super::header::{HEADER, Header, INFINITE, NONE, pad};
use super::{Compact, Law};

/// Numbers without gaps for used slots, in the same order; `None` if there are no gaps.
struct DenseNumbers(Option<Vec<u32>>);

impl DenseNumbers {
    fn of(slots: usize, used: impl ExactSizeIterator<Item = usize>) -> Self {
        if used.len() == slots {
            return DenseNumbers(None);
        }
        let mut numbers = vec![NONE; slots];
        used.zip(0..)
            .for_each(|(slot, number)| numbers[slot] = number);
        DenseNumbers(Some(numbers))
    }

    fn at(&self, slot: usize) -> u32 {
        self.0.as_ref().map_or(slot as u32, |numbers| numbers[slot])
    }
}

struct FileNumbers {
    vertices: DenseNumbers,
    cells: DenseNumbers,
}

impl FileNumbers {
    fn vertex(&self, vertex: VertexId) -> u32 {
        match vertex {
            v if v == VertexId::INFINITE => INFINITE,
            v if v == VertexId::NONE => NONE,
            v => self.vertices.at(v.index()),
        }
    }

    fn cell(&self, cell: CellId) -> u32 {
        if cell == CellId::NONE {
            NONE
        } else {
            self.cells.at(cell.index())
        }
    }
}

fn write<G: Geometry<N, Point = [f64; D]>, V, C: Copy + Default, const N: usize, const D: usize>(
    t: &Triangulation<G, N, V, C>,
    law: Law,
    constraints: impl Fn(&C) -> u8,
    out: &mut impl Write,
) -> io::Result<()> {
    let tds: &Tds<N, V, C> = t.tds();
    let numbers = FileNumbers {
        vertices: DenseNumbers::of(tds.vertex_slots(), tds.vertices().map(VertexId::index)),
        cells: DenseNumbers::of(tds.cell_slots(), tds.cells().map(CellId::index)),
    };
    let header = Header {
        full: N as u32,
        width: (tds.dimension() + 1) as u32,
        doubles: D as u32,
        law,
        vertices: tds.vertex_count() as u64,
        cells: tds.cell_count() as u64,
        infinite_cell: tds
            .cell_of(VertexId::INFINITE)
            .map_or(NONE, |cell| numbers.cell(cell)),
    };
    let bytes = header.to_bytes();
    debug_assert_eq!(bytes.len(), HEADER);
    out.write_all(&bytes)?;
    for x in tds.vertices().flat_map(|v| t.point(v)) {
        out.write_all(&x.to_le_bytes())?;
    }
    for vertex in tds.vertices() {
        let cell = tds.cell_of(vertex).map_or(NONE, |cell| numbers.cell(cell));
        out.write_all(&cell.to_le_bytes())?;
    }
    pad(out, 4 * tds.vertex_count())?;
    for cell in tds.cells() {
        for vertex in tds.corners(cell) {
            out.write_all(&numbers.vertex(*vertex).to_le_bytes())?;
        }
        for i in 0..N {
            out.write_all(&numbers.cell(tds.neighbor(cell, i)).to_le_bytes())?;
        }
    }
    if law.has_constraints() {
        for cell in tds.cells() {
            out.write_all(&[constraints(tds.cell_data(cell))])?;
        }
        pad(out, tds.cell_count())?;
    }
    Ok(())
}

/// Returns bit `i` set if the edge opposite vertex `i` is constrained.
fn bits<C>(constraints: &ConstrainedEdges<C>) -> u8 {
    (0..3).map(|i| u8::from(constraints.has(i)) << i).sum()
}

impl<G: Geometry<N, Point = [f64; D]>, V, C: Copy + Default, const N: usize, const D: usize>
    Basic<G, N, V, C>
{
    /// Writes the triangulation in the format of [`Compact`](super::Compact), without payloads.
    ///
    /// Vertices and cells keep their numbers, unless some have been removed: then the gaps close.
    /// Writes a few bytes at a time, so `out` should be buffered.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_compact(&self, out: &mut impl Write) -> io::Result<()> {
        write(&self.inner, Law::None, |_| 0, out)
    }
}

impl<G: Geometry<N, Point = [f64; D]>, V, C: Copy + Default, const N: usize, const D: usize>
    Regular<G, N, V, C>
{
    /// Writes the triangulation like [`Basic::write_compact`], without its law and without hidden
    /// points.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_compact(&self, out: &mut impl Write) -> io::Result<()> {
        write(self, Law::None, |_| 0, out)
    }
}

impl<G: Geometry<N, Point = [f64; D]>, V, C: Copy + Default, const N: usize, const D: usize>
    Delaunay<G, N, V, C>
{
    /// Writes the triangulation like [`Basic::write_compact`], with its law, which queries for
    /// nearest vertices need.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_compact(&self, out: &mut impl Write) -> io::Result<()> {
        write(&self.inner, Law::Delaunay, |_| 0, out)
    }
}

impl<G: Geometry<3, Point = [f64; D]>, V, C: Copy + Default, const D: usize> Constrained<G, V, C> {
    /// Writes the triangulation like [`Basic::write_compact`], with its constraints.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_compact(&self, out: &mut impl Write) -> io::Result<()> {
        write(self, Law::Constrained, bits, out)
    }
}

impl<G: Crossing<Point = [f64; D]>, V, C: Copy + Default, const D: usize>
    ConstrainedDelaunay<G, V, C>
{
    /// Writes the triangulation like [`Basic::write_compact`], with its law and its constrained
    /// edges, but without its lines.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_compact(&self, out: &mut impl Write) -> io::Result<()> {
        write(&self.inner, Law::ConstrainedDelaunay, bits, out)
    }
}

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize>
    Compact<G, B, N>
{
    /// Writes the triangulation again, without its sections.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_compact(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(
            self.bytes
                .as_ref()
                .get(..self.offsets.end)
                .unwrap_or_default(),
        )
    }
}

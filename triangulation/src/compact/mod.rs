//! The compact, read-only triangulation, which is used in place: in bytes, or in a file mapped to
//! memory.

mod check;
mod error;
mod header;
mod law;
mod plane;
mod queries;
mod section;
mod space;
mod write;

use std::ops::Range;

use crate::embedded::Embedded;
use crate::geometry::Geometry;
use crate::tds::{CellId, Complex, VertexId};
pub use error::CompactError;
use header::{HEADER, Header, Offsets};
pub use law::Law;
pub use section::CompactSection;

/// A read-only triangulation that is used where its bytes are, without being loaded. `N` is the
/// number of vertices of a cell: 3 in the plane, 4 in space.
///
/// The kinds write it: [`Delaunay::write_compact`](crate::Delaunay::write_compact),
/// [`ConstrainedDelaunay::write_compact`](crate::ConstrainedDelaunay::write_compact) and so on. `B`
/// is anything that can be borrowed as bytes: a slice, a vector, or a file that another crate maps
/// to memory. Opening reads the header and the number of bytes, in constant time however many
/// points there are; a query then reads the bytes that it needs. Answers are those of the
/// triangulation that was written. A program can store attributes of its own behind it, each as a
/// [`CompactSection`].
///
/// Nothing in the bytes is trusted: each number is checked against its limits where it is used,
/// each point is one that the geometry [admits](Geometry::admits), and walks are bounded by the
/// number of cells. So damaged bytes lead to an error that names the cell or vertex, or to a wrong
/// answer, but never to a panic or an endless loop. [`check`](Self::check) reads all bytes.
///
/// Mapping a file is up to the caller, who knows whether the file stays unchanged meanwhile. With
/// the crate `memmap2`:
///
/// ```text
/// let map = unsafe { memmap2::Mmap::map(&File::open("valley.tin")?)? }; // nobody writes to it
/// let compact = Compact::open(Plane::default(), map)?;
/// ```
///
/// A point takes 8 bytes a coordinate, 4 bytes for a cell of its vertex, and 48 bytes for its two
/// triangles; two bytes more with constraints. In space a tetrahedron takes 32 bytes, and a point
/// has six or seven. The format is described in `docs/formats.md`.
///
/// ```
/// use breakline_triangulation::{geometry::Plane, Compact, CompactError, Delaunay};
///
/// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
/// let plane: Plane = Plane::default();
/// let (t, v) = Delaunay::from_points(plane, &points)?;
/// let mut bytes = Vec::new();
/// t.write_compact(&mut bytes)?;
///
/// let compact = Compact::open(plane, &bytes[..])?;
/// assert_eq!(compact.nearest(&[4.0, 2.0], None)?, Some(v[2]));
/// bytes.pop();
/// assert!(matches!(Compact::open(plane, &bytes[..]), Err(CompactError::Length { .. })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Compact<G, B, const N: usize = 3> {
    geometry: G,
    bytes: B,
    header: Header,
    offsets: Offsets,
}

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize>
    Compact<G, B, N>
{
    /// Opens a compact triangulation; checks its header and the number of bytes.
    ///
    /// # Errors
    /// If the header or the number of bytes is wrong, if the triangulation is one of space and the
    /// geometry of the plane (or the other), or if the points do not have the geometry's number of
    /// coordinates.
    ///
    /// # Complexity
    /// Linear in the number of sections; constant however many points there are.
    pub fn open(geometry: G, bytes: B) -> Result<Self, CompactError> {
        let all = bytes.as_ref();
        let header = Header::read(&all[..all.len().min(HEADER)])?;
        if header.full as usize != N {
            return Err(CompactError::Space {
                expected: N,
                found: header.full as usize,
            });
        }
        if header.doubles as usize != D {
            return Err(CompactError::Coordinates {
                expected: D,
                found: header.doubles as usize,
            });
        }
        let offsets = header
            .offsets()
            .ok_or(CompactError::Header("more bytes than can be addressed"))?;
        let length = |expected: u64| CompactError::Length {
            expected,
            found: all.len() as u64,
        };
        let mut rest = all.get(offsets.end..).ok_or(length(offsets.end as u64))?;
        while !rest.is_empty() {
            let start = (all.len() - rest.len()) as u64;
            rest = CompactSection::split_first(rest)
                .map_err(|needed| length(start.saturating_add(needed)))?
                .1;
        }
        Ok(Compact {
            geometry,
            bytes,
            header,
            offsets,
        })
    }

    /// Returns the law that the file claims.
    pub fn law(&self) -> Law {
        self.header.law
    }

    /// Returns the geometry.
    pub fn geometry(&self) -> &G {
        &self.geometry
    }

    /// Returns the dimension: -1 without points, 0 for a single point, 1 if all points are
    /// collinear, 2 in the plane or if all are coplanar, else 3.
    pub fn dimension(&self) -> i32 {
        Complex::dimension(self)
    }

    /// Returns the number of vertices, which are numbered from 0 without gaps.
    pub fn vertex_count(&self) -> usize {
        self.vertex_slots()
    }

    /// Returns the number of cells, infinite ones included; they are numbered from 0 without gaps.
    pub fn cell_count(&self) -> usize {
        self.cell_slots()
    }

    /// Returns the point of a finite vertex.
    ///
    /// # Errors
    /// If the vertex does not exist, or the geometry does not admit its point.
    pub fn point(&self, vertex: VertexId) -> Result<[f64; D], CompactError> {
        Embedded::point(self, vertex)
    }

    /// Returns all bytes: the triangulation, and its sections.
    pub fn bytes(&self) -> &[u8] {
        self.bytes.as_ref()
    }

    /// Returns all sections, in order.
    pub fn sections(&self) -> impl Iterator<Item = CompactSection<'_>> {
        let mut rest = self.bytes().get(self.offsets.end..).unwrap_or_default();
        std::iter::from_fn(move || {
            let (section, others) = CompactSection::split_first(rest).ok()?;
            rest = others;
            Some(section)
        })
    }

    /// Returns the contents of the first section with a tag; `None` if there is none. They begin at
    /// a multiple of 8 bytes.
    pub fn section(&self, tag: [u8; 8]) -> Option<&[u8]> {
        self.sections()
            .find(|section| section.tag == tag)
            .map(|section| section.contents)
    }

    /// Returns where the contents of [`section`](Self::section) are in [`bytes`](Self::bytes), for
    /// a program that reads them often.
    pub fn section_range(&self, tag: [u8; 8]) -> Option<Range<usize>> {
        let mut start = self.offsets.end;
        for section in self.sections() {
            if section.tag == tag {
                start += section::HEAD as usize;
                return Some(start..start + section.contents.len());
            }
            start += section.size();
        }
        None
    }

    /// Returns true if the edge opposite vertex `i` of a cell is constrained.
    ///
    /// # Errors
    /// If the cell does not exist.
    pub fn is_constrained(&self, cell: CellId, i: usize) -> Result<bool, CompactError> {
        if !self.is_used(cell) {
            return Err(CompactError::Cell(cell));
        }
        if !self.header.law.has_constraints() {
            return Ok(false);
        }
        match self.number(self.offsets.constraints + cell.index()) {
            Some([constraints]) if constraints < 8 => Ok(i < 3 && constraints >> i & 1 == 1),
            _ => Err(CompactError::Cell(cell)),
        }
    }

    #[inline]
    fn number<const W: usize>(&self, at: usize) -> Option<[u8; W]> {
        self.bytes.as_ref().get(at..)?.first_chunk().copied()
    }

    /// Returns a number from the array of cells: first the vertices, then the neighbors.
    #[inline]
    fn link(&self, cell: CellId, slot: usize) -> Result<u32, CompactError> {
        let at = self.offsets.cells + 8 * N * cell.index() + 4 * slot;
        let number = self.is_used(cell).then(|| self.number(at)).flatten();
        number
            .map(u32::from_le_bytes)
            .ok_or(CompactError::Cell(cell))
    }

    fn cell(&self, stored: u32) -> Option<CellId> {
        (u64::from(stored) < self.header.cells).then(|| CellId::new(stored as usize))
    }
}

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize> Complex<N>
    for Compact<G, B, N>
{
    type Error = CompactError;

    #[inline]
    fn dimension(&self) -> i32 {
        self.header.width as i32 - 1
    }

    #[inline]
    fn vertex_slots(&self) -> usize {
        self.header.vertices as usize
    }

    #[inline]
    fn cell_slots(&self) -> usize {
        self.header.cells as usize
    }

    #[inline]
    fn is_used(&self, cell: CellId) -> bool {
        cell.index() < self.cell_slots()
    }

    #[inline]
    fn corners(&self, cell: CellId) -> Result<[VertexId; N], CompactError> {
        let mut corners = [VertexId::NONE; N];
        for (slot, corner) in corners.iter_mut().enumerate().take(self.width()) {
            *corner = match self.link(cell, slot)? {
                header::INFINITE => VertexId::INFINITE,
                stored if u64::from(stored) < self.header.vertices => {
                    VertexId::new(stored as usize)
                }
                _ => return Err(CompactError::Cell(cell)),
            };
        }
        Ok(corners)
    }

    #[inline]
    fn neighbor(&self, cell: CellId, i: usize) -> Result<CellId, CompactError> {
        if i >= self.width() {
            return Err(CompactError::Cell(cell));
        }
        self.cell(self.link(cell, N + i)?)
            .ok_or(CompactError::Cell(cell))
    }

    #[inline]
    fn cell_of(&self, vertex: VertexId) -> Result<Option<CellId>, CompactError> {
        if vertex == VertexId::INFINITE {
            return Ok(self.cell(self.header.infinite_cell));
        }
        if vertex.index() >= self.vertex_slots() {
            return Err(CompactError::Vertex(vertex));
        }
        let stored = self.number(self.offsets.cells_of_vertices + 4 * vertex.index());
        let cell = stored.and_then(|stored| self.cell(u32::from_le_bytes(stored)));
        cell.map(Some).ok_or(CompactError::Vertex(vertex))
    }

    #[inline]
    fn ensure(&self, at: CellId, holds: impl FnOnce() -> bool) -> Result<(), CompactError> {
        if holds() {
            Ok(())
        } else {
            Err(CompactError::Cell(at))
        }
    }
}

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize> Embedded<N>
    for Compact<G, B, N>
{
    type Geometry = G;
    type Complex = Self;
    type Error = CompactError;
    type PointRef<'a>
        = [f64; D]
    where
        Self: 'a;

    #[inline]
    fn geometry(&self) -> &G {
        &self.geometry
    }

    #[inline]
    fn complex(&self) -> &Self {
        self
    }

    #[inline]
    fn point(&self, vertex: VertexId) -> Result<[f64; D], CompactError> {
        let mut point = [f64::NAN; D];
        if vertex.index() < self.vertex_slots() {
            for (axis, x) in point.iter_mut().enumerate() {
                let at = HEADER + 8 * (D * vertex.index() + axis);
                *x = self.number(at).map_or(f64::NAN, f64::from_le_bytes);
            }
        }
        if self.geometry.admits(&point) {
            Ok(point)
        } else {
            Err(CompactError::Vertex(vertex))
        }
    }

    #[inline]
    fn point_ref<'a>(point: &'a [f64; D]) -> [f64; D]
    where
        Self: 'a,
    {
        *point
    }
}

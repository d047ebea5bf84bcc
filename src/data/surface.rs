use std::ops::Range;

use crate::crs::Crs;

/// What an edge of a surface is, beyond a side of its triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
#[non_exhaustive]
pub enum EdgeKind {
    /// An edge within the surface, with no line along it.
    #[default]
    Plain,
    /// Part of a breakline (or of another constraint of the triangulation).
    Breakline,
    /// Part of a line that the surface was cut along: a boundary or bounds.
    Clip,
    /// An edge at the rim of the surface, with no line along it.
    Rim,
}

/// A face of a surface, with what there is to know of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// Its number.
    pub number: u32,
    /// Its corners, counter-clockwise.
    pub corners: [u32; 3],
    /// What the edge opposite each corner is.
    pub edges: [EdgeKind; 3],
}

impl EdgeKind {
    /// Whether it lies on a breakline or a clip line.
    pub fn is_constrained(self) -> bool {
        matches!(self, EdgeKind::Breakline | EdgeKind::Clip)
    }
}

/// A surface of triangles, in plan without overlaps: a TIN, a mesh from a file, the cells of a grid.
///
/// Vertices and faces are numbered from 0; some numbers may be unused. Corners are
/// counter-clockwise in plan, and neighbor `i` of a face lies across the edge opposite corner `i`.
pub trait Surface: Sync {
    /// One more than the largest vertex number.
    fn vertex_count(&self) -> usize;

    /// Where a vertex is.
    fn position(&self, vertex: u32) -> [f64; 3];

    /// One more than the largest face number.
    fn face_count(&self) -> usize;

    /// The corners of a face, counter-clockwise; `None` where the number is unused or the face is
    /// not part of the surface.
    fn face(&self, face: u32) -> Option<[u32; 3]>;

    /// The face across the edge opposite corner `i`; `None` at the edge of the surface.
    fn neighbor(&self, face: u32, i: usize) -> Option<u32>;

    /// What the edge opposite corner `i` is; the same seen from both of its faces. Where a clip line runs along a
    /// breakline, the edge is a [`Breakline`](EdgeKind::Breakline).
    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind;

    /// Whether there may be edges on breaklines or clip lines; if not, none has to be looked at for that.
    fn has_lines(&self) -> bool {
        true
    }

    /// Whether the edge opposite corner `i` lies on a breakline or a clip line.
    fn is_constrained(&self, face: u32, i: usize) -> bool {
        self.edge_kind(face, i).is_constrained()
    }

    /// Whether the face is a piece of a triangle that was cut. The Delaunay law holds between whole triangles only.
    fn is_fragment(&self, _face: u32) -> bool {
        false
    }

    /// Coordinate system, if known.
    fn crs(&self) -> Option<&Crs>;

    /// Where the corners of a face are; `None` where there is none.
    fn triangle(&self, face: u32) -> Option<[[f64; 3]; 3]> {
        Some(self.face(face)?.map(|v| self.position(v)))
    }

    /// Appends the faces with these numbers, in order, each with its corners, unused ones left out.
    ///
    /// `PERF:` this and [`faces_in`](Self::faces_in) are compiled for each kind of surface: one virtual call for many faces.
    fn corners_in(&self, numbers: Range<u32>, faces: &mut Vec<(u32, [u32; 3])>) {
        faces.extend(numbers.filter_map(|face| Some((face, self.face(face)?))));
    }

    /// Appends the faces with these numbers, in order, unused ones left out.
    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        faces.extend(numbers.filter_map(|number| {
            let corners = self.face(number)?;
            Some(Face { number, corners, edges: [0, 1, 2].map(|i| self.edge_kind(number, i)) })
        }));
    }

    /// Appends the faces with these numbers, in order, that are wanted for their lowest and highest corner, each with
    /// the heights of its corners.
    ///
    /// `is_wanted` may be asked for several faces at once, with the lowest and the highest corner of them all, so it
    /// must hold of every range that holds a wanted one.
    ///
    /// `PERF:` a raster asks once for the four faces between four cells: most of them are skipped at once.
    fn heights_in(&self, numbers: Range<u32>, is_wanted: &dyn Fn(f64, f64) -> bool, faces: &mut Vec<(u32, [f64; 3])>) {
        faces.extend(numbers.filter_map(|number| {
            let [a, b, c] = self.face(number)?.map(|v| self.position(v)[2]);
            is_wanted(a.min(b).min(c), a.max(b).max(c)).then_some((number, [a, b, c]))
        }));
    }
}

/// Faces that are asked for at a time: they stay in a core's cache.
const BATCH: u32 = 1 << 11;

/// All faces of a surface with their corners, in order of their numbers.
///
/// `PERF:` by `for_each` and the like, a loop over each batch; `next` asks each time whether the batch is over.
pub(crate) fn corners<S: Surface + ?Sized>(surface: &S) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
    batches(surface, S::corners_in)
}

/// All faces of a surface, in order of their numbers.
pub(crate) fn faces<S: Surface + ?Sized>(surface: &S) -> impl Iterator<Item = Face> + '_ {
    batches(surface, S::faces_in)
}

fn batches<'s, S: Surface + ?Sized, T: 's>(
    surface: &'s S,
    ask: impl Fn(&S, Range<u32>, &mut Vec<T>) + 's,
) -> impl Iterator<Item = T> + 's {
    let count = surface.face_count() as u32;
    (0..count.div_ceil(BATCH)).flat_map(move |batch| {
        let start = batch * BATCH;
        let mut items = Vec::with_capacity(BATCH as usize);
        ask(surface, start..start.saturating_add(BATCH).min(count), &mut items);
        items
    })
}

use std::convert::Infallible;
use std::io::Write;
use std::ops::{AddAssign, Range};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::Bounds;
use crate::crs::Crs;
use crate::error::{Error, Result};

/// The role of an edge in a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
#[non_exhaustive]
pub enum EdgeKind {
    /// Inside the surface, with no line along it.
    #[default]
    Plain,
    /// Part of a hard breakline (or of another constraint of the triangulation).
    Breakline,
    /// Part of a line that the surface was cut along: a boundary or bounds.
    Clip,
    /// At the rim of the surface, with no line along it.
    Rim,
    /// Part of a soft line: smooth methods of interpolation pass over it.
    Soft,
    /// Part of a line that was draped over the finished surface.
    Draped,
    /// Part of the upper or the lower chain of a wall.
    Wall,
    /// Part of the shore of level water.
    Shore,
    /// Part of a bank of a river, or of a level line across it.
    Bank,
}

/// A face of a surface, with its corners and the kinds of its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// The number of the face.
    pub number: u32,
    /// The corners, counter-clockwise.
    pub corners: [u32; 3],
    /// The kind of the edge opposite each corner.
    pub edges: [EdgeKind; 3],
}

/// A face on the other side of an edge.
///
/// See [`Surface::across`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceAcross {
    /// The number of the face.
    pub number: u32,
    /// The corner of the face that is not on the edge.
    pub corner: usize,
    /// The position of this corner.
    pub apex: [f64; 3],
}

/// A triangle under a surface, linked to its neighbors.
///
/// See [`Surface::base_faces_in`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BaseFace {
    /// The number of the triangle.
    pub number: u32,
    /// The corners, counter-clockwise.
    pub corners: [u32; 3],
    /// The triangle across the edge opposite each corner, if there is one.
    pub neighbors: [Option<u32>; 3],
    /// The kind of the edge opposite each corner.
    pub edges: [EdgeKind; 3],
}

impl EdgeKind {
    /// All kinds, each at the position of the number that stands for it in files.
    pub const ALL: [EdgeKind; 9] = [
        EdgeKind::Plain,
        EdgeKind::Breakline,
        EdgeKind::Clip,
        EdgeKind::Rim,
        EdgeKind::Soft,
        EdgeKind::Draped,
        EdgeKind::Wall,
        EdgeKind::Shore,
        EdgeKind::Bank,
    ];

    /// Returns the number that stands for the kind in files.
    pub fn number(self) -> u8 {
        match self {
            EdgeKind::Plain => 0,
            EdgeKind::Breakline => 1,
            EdgeKind::Clip => 2,
            EdgeKind::Rim => 3,
            EdgeKind::Soft => 4,
            EdgeKind::Draped => 5,
            EdgeKind::Wall => 6,
            EdgeKind::Shore => 7,
            EdgeKind::Bank => 8,
        }
    }

    /// Returns true for an edge on a line of any kind.
    pub fn is_constrained(self) -> bool {
        !matches!(self, EdgeKind::Plain | EdgeKind::Rim)
    }

    /// Returns true for an edge that smooth methods of interpolation do not pass over: on a hard
    /// breakline, a wall, a shore or a bank.
    pub fn is_hard(self) -> bool {
        matches!(
            self,
            EdgeKind::Breakline | EdgeKind::Wall | EdgeKind::Shore | EdgeKind::Bank
        )
    }

    /// Returns the position of the kind among all kinds: where several lines share an edge, or meet
    /// with different heights, the one with the lowest rank counts.
    pub(crate) fn rank(self) -> u8 {
        match self {
            EdgeKind::Shore => 0,
            EdgeKind::Bank => 1,
            EdgeKind::Wall => 2,
            EdgeKind::Breakline => 3,
            EdgeKind::Soft => 4,
            EdgeKind::Draped => 5,
            EdgeKind::Clip => 6,
            EdgeKind::Rim => 7,
            EdgeKind::Plain => 8,
        }
    }

    /// Returns what the edges are part of, in the plural: "breaklines", "clip lines".
    pub fn noun(self) -> &'static str {
        match self {
            EdgeKind::Plain => "plain edges",
            EdgeKind::Breakline => "breaklines",
            EdgeKind::Clip => "clip lines",
            EdgeKind::Rim => "rim",
            EdgeKind::Soft => "soft lines",
            EdgeKind::Draped => "draped lines",
            EdgeKind::Wall => "walls",
            EdgeKind::Shore => "shores",
            EdgeKind::Bank => "banks",
        }
    }
}

/// A surface of triangles that do not overlap in plan: a TIN, a mesh from a file, the cells of a
/// grid.
///
/// Vertices and faces are numbered from 0; some numbers may be unused. Corners are
/// counter-clockwise in plan, and neighbor `i` of a face lies across the edge opposite corner `i`:
///
/// ```text
///             0
///            / \
/// neighbor 2/   \neighbor 1
///          /     \
///         1-------2
///         neighbor 0
/// ```
pub trait Surface: Sync {
    /// One more than the largest vertex number.
    fn vertex_count(&self) -> usize;

    /// The coordinates of a vertex.
    fn position(&self, vertex: u32) -> [f64; 3];

    /// One more than the largest face number.
    fn face_count(&self) -> usize;

    /// The corners of a face, counter-clockwise; `None` if the number is unused or the face is not
    /// part of the surface.
    fn face(&self, face: u32) -> Option<[u32; 3]>;

    /// The face across the edge opposite corner `i`; `None` at the rim of the surface.
    fn neighbor(&self, face: u32, i: usize) -> Option<u32>;

    /// Returns the face across the edge opposite corner `i`, with the corner beyond the edge;
    /// `None` at the rim of the surface.
    ///
    /// `PERF:` all that a walk needs of the next face, by one virtual call. A surface in memory
    /// also prefetches the faces after it.
    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        across(self, face, i)
    }

    /// The kind of the edge opposite corner `i`; both faces of an edge return the same.
    ///
    /// Where several lines share an edge, the first of these counts: shore, bank, wall, breakline,
    /// soft line, draped line, clip line.
    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind;

    /// Returns false if no edge is on a line, so that callers can skip a search.
    fn has_lines(&self) -> bool {
        true
    }

    /// Returns true if the edge opposite corner `i` lies on a line.
    fn is_constrained(&self, face: u32, i: usize) -> bool {
        self.edge_kind(face, i).is_constrained()
    }

    /// Returns true if the face is a fragment of a triangle that was cut.
    ///
    /// The Delaunay law holds between whole triangles only.
    fn is_fragment(&self, _face: u32) -> bool {
        false
    }

    /// Returns true if the vertex was added between the heights that are given, as in the middle of
    /// four cells. Methods that take the nearest heights pass over it.
    fn is_between(&self, _vertex: u32) -> bool {
        false
    }

    /// A lower bound of the width of each face, in steps of an `f64` at the largest coordinate of
    /// the surface in plan; 0 if none is known. The width is twice the area, divided by the sum of
    /// the sides of the box around the face.
    ///
    /// Where it is large, callers can skip a search for faces that are thinner than rounding.
    fn least_width(&self) -> f64 {
        0.0
    }

    /// The coordinate system, if known.
    fn crs(&self) -> Option<&Crs>;

    /// Returns an error once something in the surface was found damaged, as can happen to a surface
    /// that is read while it is used.
    ///
    /// Such a surface answers a question about what is damaged as if it were not there, or with any
    /// position. So whoever writes a result asks here before the result counts.
    ///
    /// # Errors
    /// The first damage that any question has met.
    fn ensure_intact(&self) -> Result<()> {
        Ok(())
    }

    /// Writes the surface together with its triangulation, as a file `.tin`.
    ///
    /// # Errors
    /// Those of `out`, and if the surface has no triangulation: if it was not built from points.
    fn write_tin(&self, _out: &mut dyn Write) -> Result<()> {
        Err(
            Error::unsupported("a .tin holds a triangulation, and this surface has none")
                .cure("build the surface from points, or write .ply"),
        )
    }

    /// The coordinates of the corners of a face; `None` if the [face](Self::face) does not
    /// exist.
    fn triangle(&self, face: u32) -> Option<[[f64; 3]; 3]> {
        Some(self.face(face)?.map(|v| self.position(v)))
    }

    /// Appends the faces in a range of numbers, in order, each with its corners; unused numbers are
    /// skipped.
    ///
    /// `PERF:` this and [`faces_in`](Self::faces_in) are compiled for each kind of surface, so that
    /// one virtual call covers many faces.
    fn corners_in(&self, numbers: Range<u32>, faces: &mut Vec<(u32, [u32; 3])>) {
        faces.extend(numbers.filter_map(|face| Some((face, self.face(face)?))));
    }

    /// Appends the coordinates of the corners of the faces in a range of numbers, in order, each
    /// with the number of its face; unused numbers are skipped.
    fn triangles_in(&self, numbers: Range<u32>, triangles: &mut Vec<(u32, [[f64; 3]; 3])>) {
        triangles.extend(numbers.filter_map(|face| Some((face, self.triangle(face)?))));
    }

    /// Appends the faces in a range of numbers, in order; unused numbers are skipped.
    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        faces.extend(numbers.filter_map(|number| {
            let corners = self.face(number)?;
            Some(Face {
                number,
                corners,
                edges: [0, 1, 2].map(|i| self.edge_kind(number, i)),
            })
        }));
    }

    /// Counts the faces and the edges on lines, and finds the vertices that no face has.
    ///
    /// # Complexity
    /// Linear, on all threads.
    fn census(&self) -> Census {
        Census::by_faces(self)
    }

    /// One more than the largest number of a [base face](Self::base_faces_in).
    fn base_count(&self) -> usize {
        self.face_count()
    }

    /// Appends the triangles in a range of numbers that are under the surface: those that it had
    /// before it was cut.
    ///
    /// A face with a number below [`base_count`](Self::base_count) is the whole triangle of that
    /// number. A face with a larger number is a fragment of some triangle. Unless a surface keeps
    /// the triangles that it was cut from, its own faces are returned.
    fn base_faces_in(&self, numbers: Range<u32>, faces: &mut Vec<BaseFace>) {
        faces.extend(numbers.filter_map(|number| {
            let corners = self.face(number)?;
            let neighbors = [0, 1, 2].map(|i| self.neighbor(number, i));
            Some(BaseFace {
                number,
                corners,
                neighbors,
                edges: [0, 1, 2].map(|i| self.edge_kind(number, i)),
            })
        }));
    }

    /// Appends the faces that may contain a position, and in any case all that do, in any order.
    /// Returns false if these are not known without a search of all faces; then nothing is
    /// appended.
    ///
    /// `near` is where a walk starts: the face or triangle that the call before left there. The
    /// faces that contain the position do not depend on it.
    ///
    /// # Complexity
    /// That of a walk, for a triangulation; constant for a raster.
    fn faces_at(&self, _q: [f64; 2], _near: &mut Option<u32>, _faces: &mut Vec<u32>) -> bool {
        false
    }

    /// Appends the faces in a range of numbers whose heights are wanted, in order, each with the
    /// heights of its corners.
    ///
    /// `is_wanted` receives the lowest and the highest height of a face. It may also be called once
    /// for several faces, with the lowest and the highest height of all of them. So it must return
    /// true for every range that contains a wanted one.
    ///
    /// `PERF:` a raster calls it once for the four faces between four cells, and skips most of them
    /// together.
    fn heights_in(
        &self,
        numbers: Range<u32>,
        is_wanted: &dyn Fn(f64, f64) -> bool,
        faces: &mut Vec<(u32, [f64; 3])>,
    ) {
        faces.extend(numbers.filter_map(|number| {
            let [a, b, c] = self.face(number)?.map(|v| self.position(v)[2]);
            is_wanted(a.min(b).min(c), a.max(b).max(c)).then_some((number, [a, b, c]))
        }));
    }
}

/// Returns the face across an edge, see [`Surface::across`], by the numbers of corners.
pub(crate) fn across<S: Surface + ?Sized>(surface: &S, face: u32, i: usize) -> Option<FaceAcross> {
    let number = surface.neighbor(face, i)?;
    let own = surface.face(face)?;
    let corners = surface.face(number)?;
    let is_on_edge = |v: u32| v == own[(i + 1) % 3] || v == own[(i + 2) % 3];
    let corner = corners.iter().position(|&v| !is_on_edge(v))?;
    Some(FaceAcross {
        number,
        corner,
        apex: surface.position(corners[corner]),
    })
}

/// The numbers of edges of a surface that lie on lines, by their kinds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LineEdges([usize; EdgeKind::ALL.len()]);

impl LineEdges {
    /// Returns the number of edges of a kind; 0 for plain edges and the rim, which are not counted.
    pub fn of(&self, kind: EdgeKind) -> usize {
        self.0[usize::from(kind.number())]
    }

    /// Returns the number of edges of all kinds.
    pub fn total(&self) -> usize {
        self.0.iter().sum()
    }

    /// Returns the kinds of which there are edges, with their numbers.
    pub fn kinds(&self) -> impl Iterator<Item = (EdgeKind, usize)> + '_ {
        EdgeKind::ALL
            .into_iter()
            .map(|kind| (kind, self.of(kind)))
            .filter(|(_, count)| *count > 0)
    }

    /// Returns true if there are edges of kinds other than breaklines and clip lines.
    pub(crate) fn has_various(&self) -> bool {
        self.kinds()
            .any(|(kind, _)| !matches!(kind, EdgeKind::Breakline | EdgeKind::Clip))
    }

    /// Adds edges of a kind; plain edges and the rim do not count.
    pub(crate) fn add_edges(&mut self, kind: EdgeKind, count: usize) {
        if kind.is_constrained() {
            self.0[usize::from(kind.number())] += count;
        }
    }

    /// Adds the edges of a face. An edge between two faces counts with the face of the smaller
    /// number, so that it counts once when all faces are added.
    pub(crate) fn add<S: Surface + ?Sized>(
        &mut self,
        surface: &S,
        face: u32,
        edges: [EdgeKind; 3],
    ) {
        for (i, kind) in edges.into_iter().enumerate() {
            if kind.is_constrained() && surface.neighbor(face, i).is_none_or(|other| face < other) {
                self.add_edges(kind, 1);
            }
        }
    }
}

impl AddAssign for LineEdges {
    fn add_assign(&mut self, other: Self) {
        for (count, more) in self.0.iter_mut().zip(other.0) {
            *count += more;
        }
    }
}

/// The parts of a surface: what a file of it lists.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Census {
    /// For each vertex number, true if a face has the vertex.
    pub used: Vec<bool>,
    /// The number of faces.
    pub faces: usize,
    /// The numbers of edges on lines.
    pub lines: LineEdges,
}

impl Census {
    /// Looks at each face.
    fn by_faces<S: Surface + ?Sized>(surface: &S) -> Self {
        let used: Vec<AtomicBool> = (0..surface.vertex_count())
            .map(|_| AtomicBool::new(false))
            .collect();
        // PERF: what is marked already is not written: threads share what they only read.
        let mark = |corners: [u32; 3]| {
            for is_used in corners.map(|v| &used[v as usize]) {
                if !is_used.load(Ordering::Relaxed) {
                    is_used.store(true, Ordering::Relaxed);
                }
            }
        };
        let (mut count, mut lines) = (0, LineEdges::default());
        let add_lined = |faces: &[Face]| {
            let mut lines = LineEdges::default();
            for face in faces {
                mark(face.corners);
                lines.add(surface, face.number, face.edges);
            }
            (faces.len(), lines)
        };
        let add = |faces: &[(u32, [u32; 3])]| {
            faces.iter().for_each(|(_, corners)| mark(*corners));
            (faces.len(), LineEdges::default())
        };
        let sum = |(faces, of_faces)| {
            count += faces;
            lines += of_faces;
            Ok::<(), Infallible>(())
        };
        let Ok(()) = if surface.has_lines() {
            let ask = |numbers, faces: &mut _| surface.faces_in(numbers, faces);
            map_batches(surface.face_count(), ask, add_lined, sum)
        } else {
            let ask = |numbers, faces: &mut _| surface.corners_in(numbers, faces);
            map_batches(surface.face_count(), ask, add, sum)
        };
        Census {
            used: used.into_iter().map(AtomicBool::into_inner).collect(),
            faces: count,
            lines,
        }
    }
}

/// The number of faces fetched at a time: few enough to stay in a core's cache.
const BATCH: u32 = 1 << 11;

/// The number of batches for each thread that are worked on before results are taken.
const BATCHES_AT_ONCE: u32 = 32;

/// Works on faces or vertices with numbers below `count` on all threads, a batch at a time. `ask`
/// appends those in a range of numbers, as [`Surface::faces_in`] does. `take` receives what `make`
/// returns for each batch, in order, while the next batches are made.
///
/// # Errors
/// The first of `take`.
///
/// # Complexity
/// Linear. Memory: the faces of one batch and the results of 64, for each thread.
pub(crate) fn map_batches<T, R: Send, E: Send>(
    count: usize,
    ask: impl Fn(Range<u32>, &mut Vec<T>) + Sync,
    make: impl Fn(&[T]) -> R + Sync,
    mut take: impl FnMut(R) -> std::result::Result<(), E> + Send,
) -> std::result::Result<(), E> {
    let count = count as u32;
    let make = |batch: u32| {
        let start = batch * BATCH;
        let mut items = Vec::with_capacity(BATCH as usize);
        ask(start..start.saturating_add(BATCH).min(count), &mut items);
        make(&items)
    };
    let batches = count.div_ceil(BATCH);
    if batches <= 1 {
        // Other threads would take longer to wake up.
        return (0..batches).map(make).try_for_each(take);
    }
    let at_once = BATCHES_AT_ONCE * rayon::current_num_threads() as u32;
    let make_some = |first: u32| -> Vec<R> {
        let some = first..batches.min(first.saturating_add(at_once));
        some.into_par_iter().map(make).collect()
    };
    let mut ready = make_some(0);
    for next in (at_once..batches).step_by(at_once as usize) {
        let taken = || ready.into_iter().try_for_each(&mut take);
        let (taken, following) = rayon::join(taken, || make_some(next));
        taken?;
        ready = following;
    }
    ready.into_iter().try_for_each(take)
}

/// Returns the box around the faces of a surface.
///
/// # Complexity
/// Linear, on all threads.
pub(crate) fn bounds_of_faces(surface: &dyn Surface) -> Bounds {
    let mut all = Bounds::default();
    let ask = |numbers, triangles: &mut _| surface.triangles_in(numbers, triangles);
    let make = |triangles: &[(u32, [[f64; 3]; 3])]| {
        let mut bounds = Bounds::default();
        let corners = triangles.iter().flat_map(|(_, corners)| corners);
        corners.for_each(|&corner| bounds.add(corner));
        bounds
    };
    let Ok(()) = map_batches(surface.face_count(), ask, make, |bounds| {
        all.merge(&bounds);
        Ok::<(), Infallible>(())
    });
    all
}

/// All faces of a surface with their corners, in order of their numbers.
///
/// `PERF:` `for_each` and the like loop over each batch; `next` checks each time whether the batch
/// is exhausted.
pub(crate) fn corners<S: Surface + ?Sized>(
    surface: &S,
) -> impl Iterator<Item = (u32, [u32; 3])> + '_ {
    batches(surface, surface.face_count() as u32, S::corners_in)
}

/// All faces of a surface, in order of their numbers.
pub(crate) fn faces<S: Surface + ?Sized>(surface: &S) -> impl Iterator<Item = Face> + '_ {
    batches(surface, surface.face_count() as u32, S::faces_in)
}

/// All [base faces](Surface::base_faces_in) of a surface, in order of their numbers.
pub(crate) fn faces_under<S: Surface + ?Sized>(surface: &S) -> impl Iterator<Item = BaseFace> + '_ {
    batches(surface, surface.base_count() as u32, S::base_faces_in)
}

fn batches<'s, S: Surface + ?Sized, T: 's>(
    surface: &'s S,
    count: u32,
    ask: impl Fn(&S, Range<u32>, &mut Vec<T>) + 's,
) -> impl Iterator<Item = T> + 's {
    (0..count.div_ceil(BATCH)).flat_map(move |batch| {
        let start = batch * BATCH;
        let mut items = Vec::with_capacity(BATCH as usize);
        ask(
            surface,
            start..start.saturating_add(BATCH).min(count),
            &mut items,
        );
        items
    })
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    #[test]
    fn batches_are_taken_in_order_until_one_fails() {
        let count = 3 * BATCH * BATCHES_AT_ONCE * rayon::current_num_threads() as u32 + 5;
        let ask = |numbers: Range<u32>, items: &mut Vec<u32>| items.extend(numbers);
        let mut found = Vec::new();
        let Ok(()) = map_batches(count as usize, ask, <[u32]>::to_vec, |items| {
            found.extend(items);
            Ok::<(), Infallible>(())
        });
        assert!(found.into_iter().eq(0..count));
        let mut taken = 0;
        let stopped = map_batches(count as usize, ask, <[u32]>::len, |_| {
            taken += 1;
            if taken < 5 { Ok(()) } else { Err(taken) }
        });
        assert_eq!((stopped, taken), (Err(5), 5));
    }
}

//! Triangulates many points at once: in the plane by divide and conquer on faces with ghosts,
//! described below; in [`space`] by insertion.
//!
//! The algorithm is that of Guibas and Stolfi (1985). The cuts are those of Dwyer's variant (1987),
//! both directions in turn, but taken from a Morton order. There is no edge structure: a part of
//! the triangulation is a *sphere* of faces, in which each edge of the part's hull has a *ghost*, a
//! face that ends in the infinite vertex.
//!
//! 1. [`order`]: the points are sorted in Morton order. A range of them is cut where the highest
//!    bit in which its keys differ changes, so that one coordinate strictly separates the halves.
//!
//!    ```text
//!      +-------+-------+        +-------+-------+
//!      | c   d | g   h |        | c   d : g   h |
//!      |       |       |        | . . . : . . . |      keys: y x
//!      | a   b | e   f |        | a   b : e   f |            0 0 a b | 1 0 c d | 0 1 e f | 1 1 g h
//!      +-------+-------+        +-------+-------+
//!       first cut, in x          then in y
//!    ```
//! 2. [`small`]: ranges of up to four points are triangulated directly.
//! 3. [`merge`]: two halves are joined. Their lower common tangent is found on the rings of ghosts.
//!    The gap is then zipped from there upward. On each side the next hull vertex is a candidate;
//!    hull edges whose triangle it would destroy are flipped away first. The ghost of the chosen
//!    candidate *becomes* the new triangle.
//!
//!    ```text
//!        \ |      | /          \ |      | /
//!      ---c|      |d---      ---c|______|d---
//!         /|      |\           /| \     |\
//!        / |      | \         / |   \   | \
//!      --- a------b ---      ---a-----\ b ---
//!         left  right          d in the circle of a b c: a b d is next
//!    ```
//! 4. [`arc`]: a range of points on an arc is built from one end, because merges of such ranges
//!    destroy what they join.
//! 5. [`finish`]: twins of edges become neighbors of faces.
//!
//! A range of `m` points has exactly `2 m - 2` faces, and a merge adds exactly two: range
//! `[lo, hi)` owns the faces `2 lo .. 2 hi - 2`, a merge at `mid` adds `2 mid - 2` and `2 mid - 1`.
//! So nothing is allocated, and different threads can build the halves. Ties are broken as
//! everywhere else, so that the result is the same, cell for cell, as that of any other algorithm.
//! Collinear points have ghosts only.
//!
//! [`filter`] contains the arithmetic. It is used if the geometry has [exact
//! plans](Coordinates::exact_plan) of all points; otherwise the same algorithm evaluates every
//! predicate through the geometry.
//!
//! `PERF:` tried and dropped: *huge pages* (glibc's `malloc.hugetlb=1`, 1 million uniform points)
//! took 2 600 page faults instead of 30 600, and no less time. What the program saved, the system
//! of the virtual machine spent.

mod arc;
mod chunks;
mod curve;
mod faces;
mod filter;
mod finish;
mod grain;
mod merge;
mod order;
mod part;
mod small;
mod space;
#[cfg(test)]
mod tests;

use std::any::Any;

use crate::geometry::Coordinates;
use crate::parallel::*;
use crate::tds::{CellId, Links, Tds, VertexId};

use curve::{Curve, Span};
use faces::Range;
use filter::PlanePredicates;
use order::Keys;
use part::NONE;
use part::{Axis, BuiltRange};

pub(crate) use grain::{Grain, Stop};
pub(crate) use order::Sites;
pub use order::spatial_order;

/// The largest number of points whose edges can be numbered: `2 n - 2` faces with four numbers
/// each. Larger inputs are inserted one by one.
const MAX_POINTS: usize = 1 << 29;
const _: () = assert!(4 * (2 * MAX_POINTS as u64 - 2) <= u32::MAX as u64);

/// The recursion continues on a new stack each time that this many more ranges of equal keys lie
/// within each other.
const NESTED: usize = 4;

/// Triangulates sites; vertices are numbered like the points. The structure is `None` if the sites
/// do not span the plane or the space, if they are too many, or if the work was stopped; in space,
/// also if they have no [exact sites](Coordinates::exact_site), or if the predicates contradict
/// each other. There hidden vertices are in no cell; where the predicates contradict each other,
/// others may be, too.
///
/// # Complexity
/// O(n log n) at worst; linear for points that are spread evenly.
pub(crate) fn build<G, const N: usize, V, C>(
    geometry: &G,
    sites: Sites<G::Point>,
    grain: Grain,
) -> (Vec<G::Point>, Option<Tds<N, V, C>>)
where
    G: Coordinates<N>,
    V: Default,
    C: Copy + Default,
{
    let Sites {
        points,
        keys,
        curve,
        have_plans,
    } = sites;
    let count = points.len();
    if N == 4 && have_plans {
        drop(keys);
        let built = space::build(geometry, &points, grain);
        let tds =
            built.and_then(|built| assemble(built.links, built.of_vertices, built.of_infinite));
        return (points, tds);
    }
    if N != 3 || !(3..=MAX_POINTS).contains(&count) {
        return (points, None);
    }
    // PERF: initializing the faces of each part just before it is built, when its memory is then in
    // the cache, made no difference (262 against 253 ns a point), and needs unsafe code.
    let mut faces = unused(2 * count - 2, grain);
    if have_plans {
        fill::<G, N, true>(geometry, &points, &keys, &curve, &mut faces, grain);
    } else {
        fill::<G, N, false>(geometry, &points, &keys, &curve, &mut faces, grain);
    }
    drop(keys);
    if grain.is_stopped() {
        return (points, None);
    }
    let finished = finish::finish(&mut faces, count, grain);
    let tds = finished.and_then(|cells| assemble(faces, cells.of_vertices, cells.of_infinite));
    (points, tds)
}

/// Returns so many faces that are in use by nothing.
fn unused(count: usize, grain: Grain) -> Vec<Links<3>> {
    chunks::filled(count, grain.points, || Links::UNUSED)
}

/// Builds two parts, on two threads if another one is free.
fn both(
    left: &mut (dyn FnMut() -> BuiltRange + Send),
    right: &mut (dyn FnMut() -> BuiltRange + Send),
) -> (BuiltRange, BuiltRange) {
    join(left, right)
}

/// Returns the complex of cells with `M` vertices, if that is `N`, which the compiler does not
/// know.
fn assemble<const M: usize, const N: usize, V: Default, C: Copy + Default>(
    links: Vec<Links<M>>,
    of_vertices: Vec<CellId>,
    of_infinite: CellId,
) -> Option<Tds<N, V, C>> {
    let links: Box<dyn Any> = Box::new(links);
    let links = links.downcast::<Vec<Links<N>>>().ok()?;
    Some(Tds::from_links(*links, of_vertices, of_infinite))
}

/// Builds the faces; the slots for neighbors hold twins of edges.
fn fill<G: Coordinates<N>, const N: usize, const FILTERED: bool>(
    geometry: &G,
    points: &[G::Point],
    keys: &Keys,
    curve: &Curve,
    faces: &mut [Links<3>],
    grain: Grain,
) {
    let predicates = PlanePredicates::<G, N, FILTERED>::new(geometry, points, curve, grain);
    Range {
        predicates: &predicates,
        keys,
        first: 0,
        faces,
        offset: 0,
        grain,
        nesting: 0,
    }
    .build(0, points.len(), arc::MOST);
}

impl<G: Coordinates<N>, const N: usize, const FILTERED: bool> Range<'_, G, N, FILTERED> {
    /// Triangulates a range; ranges of up to `arcs` points are tested for being an arc.
    fn build(&mut self, lo: usize, hi: usize, mut arcs: usize) -> BuiltRange {
        match hi - lo {
            1 => {
                return BuiltRange {
                    bottom: NONE,
                    top: NONE,
                    first: lo as u32,
                };
            }
            2 => {
                let [bottom, top] = self.pair([lo, lo + 1].map(VertexId::new), 2 * lo as u32);
                return BuiltRange {
                    bottom,
                    top,
                    first: lo as u32,
                };
            }
            3 => return self.triple(lo),
            4 => {
                if let Some(part) = self.quadruple(lo) {
                    return part;
                }
            }
            _ => {}
        }
        if FILTERED && (arc::LEAST..=arcs).contains(&(hi - lo)) {
            if let Some(part) = self.arc(lo, hi) {
                return part;
            }
            arcs = (hi - lo) / 4 * 3;
        }
        let Some((mid, axis)) = self.halve(lo, hi) else {
            return self.build_dense(lo, hi, arcs);
        };
        let (left, right) = if hi - lo > self.grain.range {
            if self.grain.stops() {
                return self.unbuilt(lo);
            }
            let Range {
                predicates,
                keys,
                first,
                offset,
                grain,
                nesting,
                ..
            } = *self;
            let (left, right) = self.faces.split_at_mut(2 * mid - offset);
            let mut left = Range {
                predicates,
                keys,
                first,
                faces: left,
                offset,
                grain,
                nesting,
            };
            let mut right = Range {
                predicates,
                keys,
                first,
                faces: right,
                offset: 2 * mid,
                grain,
                nesting,
            };
            both(&mut || left.build(lo, mid, arcs), &mut || {
                right.build(mid, hi, arcs)
            })
        } else {
            (self.build(lo, mid, arcs), self.build(mid, hi, arcs))
        };
        // Of parts of this size one may be missing.
        if hi - lo > self.grain.range && self.grain.is_stopped() {
            return self.unbuilt(lo);
        }
        self.merge(left, right, mid, axis)
    }

    /// Returns what stands for a part that was not built because the work was stopped. It is never
    /// merged.
    #[cold]
    fn unbuilt(&self, lo: usize) -> BuiltRange {
        BuiltRange {
            bottom: NONE,
            top: NONE,
            first: lo as u32,
        }
    }

    /// Returns where the keys cut a range in two, and along which axis; `None` if the keys of all
    /// its points are equal.
    #[inline(always)]
    fn halve(&self, lo: usize, hi: usize) -> Option<(usize, Axis)> {
        let differing = self.keys.difference(lo - self.first, hi - 1 - self.first);
        if differing == 0 {
            return None;
        }
        let bit = 63 - differing.leading_zeros();
        // The bit of x stands above that of y.
        Some((
            self.cut(lo, hi, bit),
            if bit % 2 == 1 { Axis::X } else { Axis::Y },
        ))
    }

    /// Returns the first point of a range whose key has the bit set.
    ///
    /// `PERF:` without branches on comparisons, which would be unpredictable.
    #[inline(always)]
    fn cut(&self, lo: usize, hi: usize, bit: u32) -> usize {
        const FEW: usize = 16;
        let has = |i: usize| self.keys.has(i - self.first, bit);
        if hi - lo <= FEW {
            return hi - (lo..hi).map(|i| usize::from(has(i))).sum::<usize>();
        }
        let (mut from, mut length) = (lo, hi - lo);
        while length > 1 {
            let half = length / 2;
            from += if has(from + half - 1) { 0 } else { half };
            length -= half;
        }
        from + usize::from(!has(from))
    }

    /// Triangulates a range whose points have equal keys. Uses more bits of the keys, or keys along
    /// a curve through these points alone; see [`order`].
    #[cold]
    fn build_dense(&mut self, lo: usize, hi: usize, arcs: usize) -> BuiltRange {
        let count = hi - lo;
        let coordinates = |i: usize| self.predicates.coordinates(VertexId::new(lo + i));
        let mut keys = Keys::default();
        if !self.keys.are_whole() {
            keys = Keys::of(
                count,
                &|i| self.predicates.curve.key(coordinates(i).as_ref()),
                self.grain,
            );
        }
        if keys.is_empty() || keys.difference(0, count - 1) == 0 {
            let curve = Curve::through(
                count,
                &|range| Span::of(range.map(coordinates)),
                self.grain.points,
            );
            keys = Keys::of(count, &|i| curve.key(coordinates(i).as_ref()), self.grain);
        }
        let Range {
            predicates,
            offset,
            grain,
            nesting,
            ..
        } = *self;
        let mut range = Range {
            predicates,
            keys: &keys,
            first: lo,
            faces: &mut *self.faces,
            offset,
            grain,
            nesting: nesting + 1,
        };
        // Each range with keys of its own is up to 64 calls deep. How many lie within each other is
        // limited only by the exponents of doubles, however few points there are.
        if range.nesting.is_multiple_of(NESTED) {
            // The new thread is not one of the pool, but the one that waits for it may be. So the
            // new thread must not wait for the pool.
            range.grain = Grain {
                points: usize::MAX,
                range: usize::MAX,
                ..grain
            };
            on_new_stack(&mut || range.build(lo, hi, arcs))
        } else {
            range.build(lo, hi, arcs)
        }
    }
}

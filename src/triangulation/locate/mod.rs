//! Point location: a walk, and strategies for where it starts.
//!
//! | strategy | steps of a walk, for `n` evenly spread points |
//! |---|---|
//! | [`Near`] a cell, or the last insertion | as many as cells lie between |
//! | [`JumpAndWalk`] from the nearest of `n^(1/3)` vertices (Mücke, Saias and Zhu 1996) | `n^(1/3)`, and as many looks |
//! | [`Buckets`] from a vertex in the same square of a grid | a few; none the better where all points are in one square |
//! | [`Hierarchy`] of samples (Devillers 2002) | `log n`, however the points are spread |
//!
//! These walk from one triangle to the next across an edge that parts it from the place, with such edges tried in an
//! order that looks random (the remembering stochastic, or zigzag, walk); [`StraightLine`] goes through the triangles
//! that a line to the place meets (both: Devillers, Pion and Teillaud 2002).
//!
//! A strategy is a value of the caller's. Some of them learn from insertions and removals: pass these to
//! [`Locate::inserted`] and [`Locate::removed`], or insert and remove by way of the strategy:
//! [`Delaunay::insert_by`](super::Delaunay::insert_by), [`Delaunay::remove_by`](super::Delaunay::remove_by). One that
//! has not been told is slower, and as right.

mod buckets;
mod hierarchy;
mod start;
mod straight;

pub use buckets::Buckets;
pub use hierarchy::Hierarchy;
pub use start::{JumpAndWalk, Locate, Near};
pub use straight::StraightLine;

use std::borrow::Borrow;
use std::cmp::Ordering;

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId};

use super::Triangulation;
use super::embedded::{Embedded, PointOf};
use super::sides::{points_with, side_of_facet};

/// Where a point lies in a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// On a vertex.
    Vertex(VertexId),
    /// In a finite cell, or on its border. Bit `i` of `touching` is set if the point lies on the facet
    /// opposite vertex `i`: in the plane, no bit says inside of the triangle and one bit on that edge.
    Cell {
        /// The cell.
        cell: CellId,
        /// The facets that the point lies on.
        touching: u8,
    },
    /// Outside of the convex hull, in sight of the finite facet of this infinite cell.
    OutsideHull {
        /// An infinite cell.
        cell: CellId,
    },
    /// Outside of the line or plane that all points lie in; also for an empty triangulation, and for
    /// a second place beside a single point.
    OutsideAffineHull,
}

impl Location {
    /// A cell at the place: where to start looking for what is near.
    pub fn cell<G: Geometry<N>, const N: usize, V, C: Copy + Default>(
        self,
        triangulation: &Triangulation<G, N, V, C>,
    ) -> Option<CellId> {
        let Ok(cell) = self.cell_in(&triangulation.tds);
        cell
    }

    /// The same wherever the cells are kept.
    pub(super) fn cell_in<const N: usize, T: Complex<N>>(self, complex: &T) -> Result<Option<CellId>, T::Error> {
        match self {
            Location::Vertex(vertex) => complex.cell_of(vertex),
            Location::Cell { cell, .. } | Location::OutsideHull { cell } => Ok(Some(cell)),
            Location::OutsideAffineHull => Ok(None),
        }
    }
}

/// Marsaglia's xorshift: the walk turns corners in an order that no input can foresee, the same in
/// every run.
#[derive(Debug, Clone)]
struct Dice(u32);

impl Default for Dice {
    fn default() -> Self {
        Dice(0x9E37_79B9)
    }
}

impl Dice {
    #[inline(always)]
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        ((u64::from(self.0) * n as u64) >> 32) as usize
    }
}

/// Steps after which a walk looks for a better place to go on from. In spatial order nearly all are over long before.
const PATIENCE: usize = 64;

/// After that many steps more for each vertex that was looked at, a walk looks again. Where points are spread evenly, one
/// step for each is left in the mean.
const PATIENCE_EACH: usize = 2;

/// How many of `n` vertices a walk looks at, the first time and the second. Along a curve it comes by all vertices in
/// between: from the nearest of so many times `n^(1/2)`, looking and walking take equally long.
///
/// `PERF:` 100 000 points on a parabola, one by one in random order (`bench_triangulation --one-by-one`): 12 instead of 53 us
/// each with the second look; uniform points 4 to 5.
const LOOKS: [fn(f64) -> f64; 2] = [f64::cbrt, |n| 3.0 * n.sqrt()];

/// A walk of that many times more steps than there are cells is lost: on a Delaunay triangulation none comes to a cell
/// twice, and on others the chance is halved, at the least, with each round.
const WANDERING: usize = 8;

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Finds where `q` lies, by a remembering stochastic walk (Devillers, Pion, Teillaud 2002) from a cell nearby, or
    /// from the last insertion. Ends on any triangulation, with probability one. If it takes long, it goes on from the
    /// nearest of `n^(1/3)` of the `n` vertices (Mücke, Saias and Zhu 1996): then about as many steps are left where
    /// points are spread evenly. If it is many more, as along curves, it goes on from the nearest of `3 n^(1/2)`.
    ///
    /// The point must be one that the geometry [admits](Geometry::admits): for others the predicates have no
    /// answer, and so has this.
    pub fn locate(&self, q: &G::Point, near: Option<CellId>) -> Location {
        let start = near.filter(|&c| self.tds.is_used(c)).or(self.last);
        let Ok(location) = walk(self, q, start);
        location
    }

    fn nearest_of_some(&self, q: &G::Point) -> Option<VertexId> {
        let samples = LOOKS[0](self.tds.vertex_slots() as f64) as usize;
        let Ok(nearest) = nearest_of_some(self, q, f64::INFINITY, samples, &mut Dice::default());
        nearest
    }
}

/// Where `q` lies, by a walk from a cell, or if there is none by that number, from one at infinity.
///
/// On links that are damaged it ends with an error: if a link leads nowhere, or if there are many times more steps than
/// cells.
pub(super) fn walk<const N: usize, T: Embedded<N>>(
    t: &T,
    q: &PointOf<T, N>,
    start: Option<CellId>,
) -> Result<Location, T::Error> {
    let complex = t.complex();
    let start = match start.filter(|&c| complex.is_used(c)) {
        Some(cell) => Some(cell),
        None => complex.cell_of(VertexId::INFINITE)?,
    };
    let Some(start) = start else {
        return Ok(Location::OutsideAffineHull);
    };
    let width = complex.width();
    let mut cell = complex.inner(start)?;
    if width == 1 {
        let only = complex.vertex(cell, 0)?;
        return Ok(match t.geometry().compare(q, t.point(only)?.borrow()) {
            Ordering::Equal => Location::Vertex(only),
            _ => Location::OutsideAffineHull,
        });
    }
    if width < N && leaves_flat(t, cell, q)? {
        return Ok(Location::OutsideAffineHull);
    }
    let mut dice = Dice::default();
    let mut from = None;
    let mut steps = 0;
    let (mut patience, mut looks) = (PATIENCE, LOOKS.into_iter());
    'walk: loop {
        steps += 1;
        complex.ensure(cell, || steps < WANDERING * (complex.cell_slots() + PATIENCE))?;
        if steps == patience
            && let Some(look) = looks.next()
        {
            let samples = look(complex.vertex_slots() as f64) as usize;
            patience = steps + PATIENCE_EACH * samples;
            if let Some(nearer) = jump(t, cell, q, samples, &mut dice)? {
                (cell, from) = (nearer, None);
            }
        }
        let mut touching = 0u8;
        let first = dice.below(width);
        for turn in 0..width {
            let i = if first + turn < width { first + turn } else { first + turn - width };
            let beyond = complex.neighbor(cell, i)?;
            if from == Some(beyond) {
                continue; // we came from there: `q` lies strictly on this side
            }
            match side_of_facet(t, cell, i, q)? {
                Sign::Positive => {}
                Sign::Zero => touching |= 1 << i,
                Sign::Negative if complex.is_infinite(beyond)? => return Ok(Location::OutsideHull { cell: beyond }),
                Sign::Negative => {
                    from = Some(cell);
                    cell = beyond;
                    continue 'walk;
                }
            }
        }
        // On all facets lies nothing but what is flat.
        complex.ensure(cell, || (touching.count_ones() as usize) < width)?;
        if touching.count_ones() as usize == width - 1 {
            // On all facets but one: on the vertex opposite that one.
            return Ok(Location::Vertex(complex.vertex(cell, (!touching).trailing_zeros() as usize)?));
        }
        return Ok(Location::Cell { cell, touching });
    }
}

/// A finite cell that is nearer to `q` than this one, as far as some vertices tell.
#[cold]
fn jump<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
    samples: usize,
    dice: &mut Dice,
) -> Result<Option<CellId>, T::Error> {
    let distance = t.geometry().rough_distance(t.point(t.complex().vertex(cell, 0)?)?.borrow(), q);
    let Some(nearer) = nearest_of_some(t, q, distance, samples, dice)? else {
        return Ok(None);
    };
    t.complex().cell_of(nearer)?.map(|cell| t.complex().inner(cell)).transpose()
}

/// Of some vertices the one nearest to `q`, if it is nearer than that.
fn nearest_of_some<const N: usize, T: Embedded<N>>(
    t: &T,
    q: &PointOf<T, N>,
    mut than: f64,
    samples: usize,
    dice: &mut Dice,
) -> Result<Option<VertexId>, T::Error> {
    let slots = t.complex().vertex_slots();
    let mut nearest = None;
    for _ in 0..samples {
        let vertex = VertexId::new(dice.below(slots));
        if t.complex().cell_of(vertex)?.is_none() {
            continue;
        }
        let distance = t.geometry().rough_distance(t.point(vertex)?.borrow(), q);
        if distance < than {
            (than, nearest) = (distance, Some(vertex));
        }
    }
    Ok(nearest)
}

/// Whether `q` lies outside of the line or plane of all points, which a finite cell spans.
fn leaves_flat<const N: usize, T: Embedded<N>>(t: &T, cell: CellId, q: &PointOf<T, N>) -> Result<bool, T::Error> {
    let points = points_with(t, cell, usize::MAX, q)?;
    let mut simplex: Vec<&PointOf<T, N>> = points.iter().collect();
    simplex.push(q);
    let sign = match <[&PointOf<T, N>; N]>::try_from(simplex) {
        Ok(full) => t.geometry().orientation(full),
        Err(flat) => t.geometry().orientation_in_flat(&flat),
    };
    Ok(sign != Sign::Zero)
}

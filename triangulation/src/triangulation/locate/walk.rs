use std::borrow::Borrow;
use std::cmp::Ordering;

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId};

use super::super::engine::embedded::{Embedded, PointOf};
use super::super::engine::sides::{points_with, side_of_facet, simplex};
use super::Location;

/// Marsaglia's xorshift: the walk turns corners in an order that no input can foresee, the same in
/// every run.
#[derive(Debug, Clone)]
pub(in super::super) struct Dice(u32);

impl Default for Dice {
    fn default() -> Self {
        Dice(0x9E37_79B9)
    }
}

impl Dice {
    #[inline(always)]
    pub(in super::super) fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        ((u64::from(self.0) * n as u64) >> 32) as usize
    }
}

/// Steps after which a walk looks for a better cell to go on from. In spatial order nearly all are over long before.
pub(super) const PATIENCE: usize = 64;

/// After that many steps more for each vertex that was looked at, a walk looks again. Where points are spread evenly, one
/// step for each is left in the mean.
const PATIENCE_EACH: usize = 2;

/// Every so many steps a walk looks whether it could leave the hull there. It would sooner or later, but along a curve it
/// may come by a facet of the hull at each step until then.
const LOOKOUT: usize = 8;

/// How many of `n` vertices a walk looks at, the first time and the second. Along a curve it comes by all vertices in
/// between: from the nearest of so many times `n^(1/2)`, looking and walking take equally long.
///
/// `PERF:` 100 000 points on a parabola, one by one in random order (`bench_triangulation --one-by-one`): 12 instead of 53 us
/// each with the second look; uniform points 4 to 5.
pub(super) const LOOKS: [fn(f64) -> f64; 2] = [f64::cbrt, |n| 3.0 * n.sqrt()];

/// A walk of that many times more steps than there are cells is given up: on a Delaunay triangulation none of certain steps
/// comes to a cell twice, and on others the chance is halved, at the least, with each round.
const WANDERING: usize = 8;

/// Returns where `q` lies: exactly, by a walk from a cell nearby, or without one from a cell at infinity. A point that the
/// geometry does not admit lies [`Nowhere`](Location::Nowhere): no predicate is asked about it.
///
/// The complex fills its convex hull without overlap; it need not be Delaunay.
///
/// # Errors
/// If a link does not hold, or if there are many times more steps than cells, as damaged links may cause.
///
/// # Complexity
/// Time proportional to the number of cells between; if that is many, from about `n^(1/3)` of the `n` vertices on to as many
/// cells, where points are spread evenly. See [`Triangulation::locate`](crate::Triangulation::locate).
pub fn locate<const N: usize, T: Embedded<N>>(
    t: &T,
    q: &PointOf<T, N>,
    start: Option<CellId>,
) -> Result<Location, T::Error> {
    if !t.geometry().admits(q) {
        return Ok(Location::Nowhere);
    }
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
    // Where a certain step came from: the point is on this side of the facet.
    let mut from = None;
    let mut steps = 0;
    let (mut patience, mut looks) = (PATIENCE, LOOKS.into_iter());
    loop {
        complex.ensure(cell, || steps < WANDERING * (complex.cell_slots() + PATIENCE))?;
        let mut seems = Seems::Elsewhere;
        if width == N {
            let reached = approach(t, q, cell, patience.saturating_sub(steps))?;
            (cell, seems) = (reached.cell, reached.seems);
            steps += reached.steps;
            from = from.filter(|_| reached.steps == 0);
        }
        if let Seems::Outside(i) = seems
            && side_of_facet(t, cell, i, q)? == Sign::Negative
        {
            return Ok(Location::OutsideHull { cell: complex.neighbor(cell, i)? });
        }
        // `PERF:` an order that is known beforehand makes half the code. Not for ever: a walk in such an order may turn in
        // circles.
        let sides = if seems == Seems::There && steps < patience {
            ask_sides(t, cell, q, 0, from)?
        } else {
            ask_sides(t, cell, q, dice.below(width), from)?
        };
        let beyond = match sides {
            Sides::Outside(i) => complex.neighbor(cell, i)?,
            Sides::Touching(touching) => {
                // On all facets lies nothing but what is flat.
                complex.ensure(cell, || (touching.count_ones() as usize) < width)?;
                if touching.count_ones() as usize == width - 1 {
                    // On all facets but one: on the vertex opposite that one.
                    return Ok(Location::Vertex(complex.vertex(cell, (!touching).trailing_zeros() as usize)?));
                }
                return Ok(Location::Cell { cell, touching });
            }
        };
        if complex.is_infinite(beyond)? {
            return Ok(Location::OutsideHull { cell: beyond });
        }
        (cell, from) = (beyond, Some(cell));
        steps += 1;
        if steps >= patience
            && let Some(look) = looks.next()
        {
            let samples = look(complex.vertex_slots() as f64) as usize;
            patience = steps + PATIENCE_EACH * samples;
            if let Some(nearer) = jump(t, cell, q, samples, &mut dice)? {
                (cell, from) = (nearer, None);
            }
        }
    }
}

/// Where a walk by rounded numbers ended.
pub(super) struct Reached {
    pub(super) cell: CellId,
    steps: usize,
    pub(super) seems: Seems,
}

/// Where a point seems to be, seen from a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Seems {
    /// In the cell.
    There,
    /// Outside of the hull, beyond the facet opposite this vertex.
    Outside(usize),
    /// There is no telling, or it is further away.
    Elsewhere,
}

/// Goes from a full finite cell towards `q` without asking for certainty, for so many steps at most: across the facet
/// that `q` lies furthest beyond. Goes nowhere if the geometry has no numbers for that.
///
/// `PERF:` the neighbors are fetched while it is computed which one is next; and that is a branch, which is foretold
/// rightly half of the time, not a number, which would have to be waited for. 100 000 points by the hierarchy, the least
/// of many runs in turn: 1.43 us with an orientation for each step, 1.24 without, 1.08 with neighbors fetched; 1.35 where
/// the next one is computed.
#[inline(always)]
pub(super) fn approach<const N: usize, T: Embedded<N>>(
    t: &T,
    q: &PointOf<T, N>,
    mut cell: CellId,
    at_most: usize,
) -> Result<Reached, T::Error> {
    let complex = t.complex();
    let mut from = None;
    for steps in 0..at_most {
        complex.fetch_neighbors(cell);
        let sides = t.geometry().rough_sides(simplex(t, cell)?.each_ref().map(Borrow::borrow), q);
        let mut next = None;
        for i in 0..N {
            if sides[i] < 0.0 && sides.iter().all(|&side| sides[i] <= side) {
                next = Some((i, complex.neighbor(cell, i)?));
                break;
            }
        }
        let Some((i, beyond)) = next else {
            // All zero they are where the cell is too small to be seen from there.
            let is_there = sides.iter().all(|&side| side >= 0.0) && sides.iter().any(|&side| side > 0.0);
            return Ok(Reached { cell, steps, seems: if is_there { Seems::There } else { Seems::Elsewhere } });
        };
        if complex.is_infinite(beyond)? {
            return Ok(Reached { cell, steps, seems: Seems::Outside(i) });
        }
        if steps % LOOKOUT == LOOKOUT - 1
            && let Some(facet) = way_out(t, cell, q)?
        {
            return Ok(Reached { cell, steps, seems: Seems::Outside(facet) });
        }
        if from == Some(beyond) {
            return Ok(Reached { cell, steps, seems: Seems::Elsewhere }); // rounded numbers lead there and back
        }
        from = Some(cell);
        cell = beyond;
    }
    Ok(Reached { cell, steps: at_most, seems: Seems::Elsewhere })
}

/// The facet of the hull that a cell has and that `q` seems to lie beyond.
///
/// `PERF:` computes the sides anew, so that those of the many steps that do not ask need not be kept in memory.
#[cold]
fn way_out<const N: usize, T: Embedded<N>>(t: &T, cell: CellId, q: &PointOf<T, N>) -> Result<Option<usize>, T::Error> {
    let sides = t.geometry().rough_sides(simplex(t, cell)?.each_ref().map(Borrow::borrow), q);
    for i in (0..N).filter(|&i| sides[i] < 0.0) {
        if t.complex().is_infinite(t.complex().neighbor(cell, i)?)? {
            return Ok(Some(i));
        }
    }
    Ok(None)
}

/// Where a point is of a finite cell.
enum Sides {
    /// Outside of the facet opposite this vertex.
    Outside(usize),
    /// Outside of none, and on those whose bit is set.
    Touching(u8),
}

/// On which sides of a finite cell `q` lies, by the predicates: of one facet after the other from the `first` on, but for
/// that of a neighbor from which the point is known to be on this side.
#[inline(always)]
fn ask_sides<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
    first: usize,
    from: Option<CellId>,
) -> Result<Sides, T::Error> {
    let width = t.complex().width();
    let mut touching = 0;
    for turn in 0..N.min(width) {
        let i = if first + turn < width { first + turn } else { first + turn - width };
        if from.is_some() && from == Some(t.complex().neighbor(cell, i)?) {
            continue;
        }
        match side_of_facet(t, cell, i, q)? {
            Sign::Positive => {}
            Sign::Zero => touching |= 1 << i,
            Sign::Negative => return Ok(Sides::Outside(i)),
        }
    }
    Ok(Sides::Touching(touching))
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
pub(super) fn nearest_of_some<const N: usize, T: Embedded<N>>(
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

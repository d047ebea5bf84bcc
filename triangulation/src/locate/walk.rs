use std::borrow::Borrow;
use std::cmp::Ordering;

use crate::embedded::sides::{leaves_flat, side_of_facet, simplex};
use crate::embedded::{Embedded, PointOf};
use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId};

use super::{Facets, Location};

/// Marsaglia's xorshift. The walk tests facets in an order that no input can anticipate, and that
/// is the same in every run.
#[derive(Debug, Clone)]
pub(crate) struct Dice(u32);

impl Default for Dice {
    fn default() -> Self {
        Dice(0x9E37_79B9)
    }
}

impl Dice {
    #[inline(always)]
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        ((u64::from(self.0) * n as u64) >> 32) as usize
    }
}

/// The number of steps after which a walk looks for a better cell to continue from. In spatial
/// order nearly all walks end long before.
pub(super) const PATIENCE: usize = 64;

/// The number of further steps, for each vertex that was examined, after which a walk looks again.
/// Where points are spread evenly, one step for each is left on average.
const PATIENCE_EACH: usize = 2;

/// The number of steps after which a walk tests again if it can leave the hull. It would leave
/// sooner or later, but along a curve it may pass a facet of the hull at each step until then.
const LOOKOUT: usize = 8;

/// How many of `n` vertices a walk examines, the first time and the second. Along a curve it passes
/// all vertices in between; from the nearest of a multiple of `n^(1/2)`, examining and walking take
/// equally long.
///
/// `PERF:` 100 000 points on a parabola, one by one in random order
/// (`bench_triangulation --one-by-one`): 12 instead of 53 us each with the second examination;
/// uniform points 4 to 5.
pub(super) const LOOKS: [fn(f64) -> f64; 2] = [f64::cbrt, |n| 3.0 * n.sqrt()];

/// The ratio of steps to cells at which a walk ends: with an error if links may be damaged,
/// otherwise with a test of all cells. On a Delaunay triangulation no walk of exact steps visits a
/// cell twice, and on others the chance is at least halved with each round.
const WANDERING: usize = 8;

/// Returns where `q` lies, exactly, by a walk from a cell nearby, or without one from an infinite
/// cell. A point that the geometry does not admit lies [`Nowhere`](Location::Nowhere): no predicate
/// is evaluated for it.
///
/// It returns whatever the predicates say; if they contradict each other (the kernel
/// [`Fast`](crate::kernel::Fast)), perhaps a cell that does not contain the point.
///
/// The complex must fill its convex hull without overlap; it need not be Delaunay.
///
/// # Errors
/// If links of the structure contradict each other, or if there are many times more steps than
/// cells, as damaged links may cause.
///
/// # Complexity
/// Time proportional to the number of cells between. If that is large, the walk continues from one
/// of about `n^(1/3)` of the `n` vertices, with as many cells left if points are spread evenly. See
/// [`Triangulation::locate`](crate::Triangulation::locate).
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
        return beside_only(t, cell, q);
    }
    if width < N && leaves_flat(t, cell, q)? {
        return Ok(Location::OutsideAffineHull);
    }
    let mut dice = Dice::default();
    // The cell that an exact step came from: the point is on this side of the facet.
    let mut from = None;
    let mut steps = 0;
    let (mut patience, mut looks) = (PATIENCE, LOOKS.into_iter());
    loop {
        if steps >= WANDERING * (complex.cell_slots() + PATIENCE) {
            complex.ensure(cell, || false)?;
            return search(t, q, cell);
        }
        let mut seems = Seems::Elsewhere;
        if width == N {
            let reached = approach(t, q, cell, patience.saturating_sub(steps))?;
            (cell, seems) = (reached.cell, reached.seems);
            steps += reached.steps;
            from = from.filter(|_| reached.steps == 0);
        }
        if seems == Seems::Inside {
            return Ok(Location::Cell {
                cell,
                facets: Facets::default(),
            });
        }
        if let Seems::Outside(i) = seems
            && side_of_facet(t, cell, i, q)? == Sign::Negative
        {
            return Ok(Location::OutsideHull {
                cell: complex.neighbor(cell, i)?,
            });
        }
        // `PERF:` a test order that is known at compile time halves the code. It is used for the
        // first steps only: a walk in a fixed order may go around in circles.
        let sides = if seems == Seems::There && steps < patience {
            ask_sides(t, cell, q, 0, from)?
        } else {
            ask_sides(t, cell, q, dice.below(width), from)?
        };
        let beyond = match sides {
            CellSides::Outside(i) => complex.neighbor(cell, i)?,
            CellSides::On(facets) => return location_on(complex, cell, facets),
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

/// Returns where a point lies, by a test of one cell after the other. If it lies in none and beyond
/// no facet of the hull, predicates contradict each other: returns the given cell then.
#[cold]
fn search<const N: usize, T: Embedded<N>>(
    t: &T,
    q: &PointOf<T, N>,
    otherwise: CellId,
) -> Result<Location, T::Error> {
    let complex = t.complex();
    let numbers = (0..complex.cell_slots()).map(CellId::new);
    for cell in numbers.filter(|&cell| complex.is_used(cell)) {
        match complex.index_of(cell, VertexId::INFINITE)? {
            Some(infinite) => {
                if side_of_facet(t, cell, infinite, q)? == Sign::Positive {
                    return Ok(Location::OutsideHull { cell });
                }
            }
            None => {
                if let CellSides::On(facets) = ask_sides(t, cell, q, 0, None)?
                    && facets.len() < complex.width()
                {
                    return location_on(complex, cell, facets);
                }
            }
        }
    }
    Ok(Location::Cell {
        cell: otherwise,
        facets: Facets::default(),
    })
}

/// Returns where a point lies if there is a single vertex, that of a cell.
#[cold]
fn beside_only<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
) -> Result<Location, T::Error> {
    let only = t.complex().vertex(cell, 0)?;
    Ok(match t.geometry().compare(q, t.point(only)?.borrow()) {
        Ordering::Equal => Location::Vertex(only),
        _ => Location::OutsideAffineHull,
    })
}

/// Returns the location of a point in a cell, on these facets of it.
#[inline(always)]
fn location_on<const N: usize, T: Complex<N>>(
    complex: &T,
    cell: CellId,
    facets: Facets,
) -> Result<Location, T::Error> {
    let width = complex.width();
    // A point on all facets means a flat cell.
    complex.ensure(cell, || facets.len() < width)?;
    if facets.len() == width - 1 {
        // On all facets but one: on the vertex opposite that one.
        let opposite = (0..width).find(|&i| !facets.contains(i)).unwrap_or(0);
        return Ok(Location::Vertex(complex.vertex(cell, opposite)?));
    }
    Ok(Location::Cell { cell, facets })
}

/// The end of a walk by rounded numbers.
pub(super) struct Reached {
    pub(super) cell: CellId,
    steps: usize,
    pub(super) seems: Seems,
}

/// Where a point seems to be, seen from a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Seems {
    /// Inside of the cell; this is certain.
    Inside,
    /// In the cell, as far as rounded numbers tell.
    There,
    /// Outside of the hull, beyond the facet opposite this vertex.
    Outside(usize),
    /// Undecided, or further away.
    Elsewhere,
}

/// Walks from a full finite cell toward `q` by rounded numbers, at most `at_most` steps, each
/// across the facet that `q` lies furthest beyond. Stays where it is if the geometry has no numbers
/// for that.
///
/// `PERF:` the neighbors are prefetched while the next one is computed. The choice is a branch,
/// which is predicted correctly half of the time, not a number, which would have to be waited for.
/// 100 000 points with the hierarchy, the least of many runs in turn: 1.43 us with an orientation
/// for each step, 1.24 without, 1.08 with neighbors prefetched; 1.35 if the next one is computed.
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
        let Some(sides) = t
            .geometry()
            .rough_sides(simplex(t, cell)?.each_ref().map(Borrow::borrow), q)
        else {
            return Ok(Reached {
                cell,
                steps,
                seems: Seems::Elsewhere,
            });
        };
        let mut next = None;
        for i in 0..N {
            if sides[i] < 0.0 && sides.iter().all(|&side| sides[i] <= side) {
                next = Some((i, complex.neighbor(cell, i)?));
                break;
            }
        }
        let Some((i, beyond)) = next else {
            let error = t
                .geometry()
                .sides_error(simplex(t, cell)?.each_ref().map(Borrow::borrow), q);
            // All are zero if the cell is too small to be distinguished from there.
            let is_there =
                sides.iter().all(|&side| side >= 0.0) && sides.iter().any(|&side| side > 0.0);
            let seems = if sides.iter().all(|&side| side > error) {
                Seems::Inside
            } else if is_there {
                Seems::There
            } else {
                Seems::Elsewhere
            };
            return Ok(Reached { cell, steps, seems });
        };
        if complex.is_infinite(beyond)? {
            return Ok(Reached {
                cell,
                steps,
                seems: Seems::Outside(i),
            });
        }
        if steps % LOOKOUT == LOOKOUT - 1
            && let Some(facet) = hull_exit(t, cell, q)?
        {
            return Ok(Reached {
                cell,
                steps,
                seems: Seems::Outside(facet),
            });
        }
        if from == Some(beyond) {
            return Ok(Reached {
                cell,
                steps,
                seems: Seems::Elsewhere,
            }); // rounded numbers go in circles
        }
        from = Some(cell);
        cell = beyond;
    }
    Ok(Reached {
        cell,
        steps: at_most,
        seems: Seems::Elsewhere,
    })
}

/// Returns the facet of a cell that is on the hull and that `q` seems to lie beyond.
///
/// `PERF:` computes the sides anew, so that they need not be stored in the many steps that do not
/// ask for this.
#[cold]
fn hull_exit<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
) -> Result<Option<usize>, T::Error> {
    let Some(sides) = t
        .geometry()
        .rough_sides(simplex(t, cell)?.each_ref().map(Borrow::borrow), q)
    else {
        return Ok(None);
    };
    for i in (0..N).filter(|&i| sides[i] < 0.0) {
        if t.complex().is_infinite(t.complex().neighbor(cell, i)?)? {
            return Ok(Some(i));
        }
    }
    Ok(None)
}

/// The position of a point relative to a finite cell.
enum CellSides {
    /// Outside of the facet opposite this vertex.
    Outside(usize),
    /// Outside of no facet, and on these.
    On(Facets),
}

/// Returns on which sides of a finite cell `q` lies, exactly. Tests one facet after the other from
/// the `first` on, except the one shared with the neighbor `from`, since the point is known to lie
/// on this side of it.
#[inline(always)]
fn ask_sides<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
    first: usize,
    from: Option<CellId>,
) -> Result<CellSides, T::Error> {
    let width = t.complex().width();
    let mut on = Facets::default();
    for turn in 0..N.min(width) {
        let i = if first + turn < width {
            first + turn
        } else {
            first + turn - width
        };
        if from.is_some() && from == Some(t.complex().neighbor(cell, i)?) {
            continue;
        }
        match side_of_facet(t, cell, i, q)? {
            Sign::Positive => {}
            Sign::Zero => on.insert(i),
            Sign::Negative => return Ok(CellSides::Outside(i)),
        }
    }
    Ok(CellSides::On(on))
}

/// Returns a finite cell that is nearer to `q` than this one, if one of some vertices is.
#[cold]
fn jump<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    q: &PointOf<T, N>,
    samples: usize,
    dice: &mut Dice,
) -> Result<Option<CellId>, T::Error> {
    let Some(distance) = t
        .geometry()
        .rough_distance(t.point(t.complex().vertex(cell, 0)?)?.borrow(), q)
    else {
        return Ok(None);
    };
    let Some(nearer) = nearest_of_some(t, q, distance, samples, dice)? else {
        return Ok(None);
    };
    t.complex()
        .cell_of(nearer)?
        .map(|cell| t.complex().inner(cell))
        .transpose()
}

/// Returns the vertex nearest to `q` among some vertices, if its distance is less than `than`.
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
        let Some(distance) = t.geometry().rough_distance(t.point(vertex)?.borrow(), q) else {
            break;
        };
        if distance < than {
            (than, nearest) = (distance, Some(vertex));
        }
    }
    Ok(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Delaunay;
    use crate::geometry::{Plane, Space};

    /// Asserts that a search through all cells finds what walks find.
    fn compare<G: Geometry<N>, const N: usize>(t: &Delaunay<G, N>, q: &G::Point) {
        let complex = t.tds();
        let Ok(found) = search(&t.inner, q, CellId::NONE);
        let walked = t.locate(q, None);
        let cells = |location: Location| {
            let Ok(mut cells) = location.cells(complex);
            cells.sort_unstable();
            cells
        };
        assert_eq!(cells(found), cells(walked));
        assert_eq!(found.vertex(), walked.vertex());
        if let Location::OutsideHull { cell } = found {
            let infinite = complex.index_of(cell, VertexId::INFINITE).unwrap();
            let side = t.side_of_facet(cell, infinite, q);
            assert_eq!(side, Sign::Positive);
            assert!(matches!(walked, Location::OutsideHull { .. }));
        }
    }

    #[test]
    fn a_search_finds_what_walks_find() {
        let halves = |k: u32, n: u32| f64::from(k % n) / 2.0 - 0.5;
        let plane: Vec<_> = (0..16).map(|k| [k % 4, k / 4].map(f64::from)).collect();
        let (t, _) = Delaunay::from_points(Plane::new(), &plane).unwrap();
        (0..81).for_each(|k| compare(&t, &[halves(k, 9), halves(k / 9, 9)]));
        let space: Vec<_> = (0..27)
            .map(|k| [k % 3, k / 3 % 3, k / 9].map(f64::from))
            .collect();
        let (t, _) = Delaunay::from_points(Space::new(), &space).unwrap();
        (0..343).for_each(|k| compare(&t, &[k, k / 7, k / 49].map(|k| halves(k, 7))));
    }
}

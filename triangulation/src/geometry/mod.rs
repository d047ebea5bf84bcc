//! What a triangulation asks of its points: the "geometric traits" concept.
//!
//! A triangulation never looks at a coordinate. It asks a [`Geometry`], and the geometry decides
//! what a point is: a pair of numbers, a 3D point seen in plan, a record of the user's own. Nothing
//! is copied or projected for that.
//!
//! | model | points | predicates |
//! |---|---|---|
//! | [`Plane`] | `[f64; 2]` | in the plane |
//! | [`Terrain`] | `[f64; 3]` | in plan: on x and y; z is carried along |
//! | [`Steps`] | `[i32; 3]` | in plan, for points on a lattice like that of a LAS file |
//! | [`Mapped`] | any type | in the plane, on sites that a function computes: other planes ([`seen_along`]), scaled axes |
//! | [`Weighted`] | `[f64; 3]` | in the plane, with weights: x, y, weight |
//! | [`Space`] | `[f64; 3]` | in space |
//! | [`WeightedSpace`] | `[f64; 4]` | in space, with weights: x, y, z, weight |
//! | [`Unweighted`] | `[f64; 3]`, `[f64; 4]` | those of the sites of weighted points |
//!
//! Each takes a [`Kernel`](crate::kernel::Kernel) that chooses the arithmetic.
//!
//! | for | a geometry of your own needs |
//! |---|---|
//! | insertion one by one, location, checks | [`Geometry`] |
//! | construction in bulk | [`Coordinates`], too |
//! | constraints | [`Crossing`], too |
//! | the vertices nearest to a point | [`Metric`], too |
//!
//! Distances are used only to choose where a walk starts, and to find what is nearest. Angles are
//! never used, and units do not matter.

mod borrowed;
mod crossed;
mod mapped;
mod metric;
mod order;
mod perturbation;
mod plane;
mod space;
mod steps;
mod terrain;
mod unweighted;
mod weighted;
mod weighted_space;

pub use mapped::{Mapped, seen_along};
pub use metric::Metric;
pub(crate) use perturbation::{in_sphere, in_sphere_of_flat, in_tied_circle, in_tied_sphere};
pub use plane::{Plane, distance_to_segment};
pub use space::Space;
pub use steps::Steps;
pub use terrain::{Terrain, height_along};
pub use unweighted::Unweighted;
pub use weighted::Weighted;
pub use weighted_space::WeightedSpace;

use std::cmp::Ordering;
use std::fmt::Debug;
use std::hash::Hasher;

use rustc_hash::FxHasher;

use order::lexicographic;

use crate::kernel::{Orientation2, Predicate, RANGE};
use crate::num::{Bounded, Sign, unsigned_zero};

/// The predicates that a triangulation needs. `N` is the number of vertices of a cell: 3 for
/// triangles, 4 for tetrahedra.
///
/// # Laws
/// - `compare` is a total order; points that compare `Equal` are the same *site* for all other
///   predicates. Along any straight line it is monotone.
/// - `orientation` changes its sign when two points are exchanged, and is zero exactly when the
///   points lie in a common hyperplane (line, plane).
/// - `side_of_sphere` is positive inside for a positively oriented simplex, negative outside, zero
///   on the sphere, and changes its sign with the orientation.
/// - All answers are those for one and the same set of exact points.
///
/// # Models
/// [`Plane`], [`Terrain`], [`Steps`], [`Mapped`], [`Weighted`], [`Space`], [`WeightedSpace`],
/// [`Unweighted`]. For points that have a position in the plane, `Mapped` is a geometry in one
/// line. You can add your own; this one counts the in-circle tests:
///
/// ```
/// use std::cell::Cell;
/// use std::cmp::Ordering;
/// use breakline_triangulation::geometry::{Geometry, Plane};
/// use breakline_triangulation::num::Sign;
/// use breakline_triangulation::Delaunay;
///
/// #[derive(Default)]
/// struct Counting { plane: Plane, circles: Cell<usize> }
///
/// impl Geometry<3> for Counting {
///     type Point = [f64; 2];
///     fn admits(&self, p: &[f64; 2]) -> bool { self.plane.admits(p) }
///     fn compare(&self, p: &[f64; 2], q: &[f64; 2]) -> Ordering { self.plane.compare(p, q) }
///     fn orientation(&self, s: [&[f64; 2]; 3]) -> Sign { self.plane.orientation(s) }
///     fn side_of_sphere(&self, s: [&[f64; 2]; 3], q: &[f64; 2]) -> Sign {
///         self.circles.set(self.circles.get() + 1);
///         self.plane.side_of_sphere(s, q)
///     }
/// }
///
/// let mut delaunay = Delaunay::new(Counting::default());
/// for p in [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0], [1.0, 1.0]] {
///     delaunay.insert(p)?;
/// }
/// assert_eq!(delaunay.finite_cells().count(), 3);
/// assert!(delaunay.geometry().circles.get() < 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Geometry<const N: usize> {
    /// The type of the points that are triangulated.
    type Point: Copy + Debug + Send + Sync;

    /// Returns true if the point's coordinates are finite and in the range that the arithmetic is
    /// proven for.
    fn admits(&self, p: &Self::Point) -> bool;

    /// Returns false if a coordinate is NaN or infinite. Asked only of points that are not
    /// admitted, to say why; the default, true, says nothing of coordinates that are not finite.
    fn is_finite(&self, _: &Self::Point) -> bool {
        true
    }

    /// Compares two sites: a total order, lexicographic by coordinates in the models here.
    fn compare(&self, p: &Self::Point, q: &Self::Point) -> Ordering;

    /// Returns the orientation of a simplex: positive if counter-clockwise (right-handed in space).
    fn orientation(&self, simplex: [&Self::Point; N]) -> Sign;

    /// Returns on which side of the simplex's circumscribed sphere `q` lies: positive inside, if
    /// the simplex is positively oriented.
    fn side_of_sphere(&self, simplex: [&Self::Point; N], q: &Self::Point) -> Sign;

    /// Returns the approximate distance of two points, in any measure; `None`, the default, if
    /// there is none.
    ///
    /// Used to choose where a walk starts; no result depends on it. Without a measure, walks from
    /// far away take long.
    #[inline(always)]
    fn rough_distance(&self, _: &Self::Point, _: &Self::Point) -> Option<f64> {
        None
    }

    /// Returns about how far `q` lies inside of each facet of a positively oriented simplex,
    /// negative outside; `None`, the default, if there is no measure for that.
    ///
    /// The facets are in the order of the vertices opposite to them. Any measure will do that makes
    /// facets comparable, such as the area (volume) that each spans with `q`. Used to choose the
    /// direction of a walk; no result depends on it (structural filtering; Funke, Mehlhorn and
    /// Näher 1999). Without a measure, walks evaluate orientations at each step, and take 1.6 times
    /// as long.
    #[inline(always)]
    fn rough_sides(&self, _: [&Self::Point; N], _: &Self::Point) -> Option<[f64; N]> {
        None
    }

    /// Returns a bound on the errors of [`rough_sides`](Self::rough_sides) of these points;
    /// infinite, the default, if there is none.
    ///
    /// If a rough side is larger than the bound, [`orientation`](Self::orientation) would say, too,
    /// that `q` is inside of that facet, so that walks need not ask it. With the default, walks are
    /// slower, and as correct.
    #[inline(always)]
    fn sides_error(&self, _: [&Self::Point; N], _: &Self::Point) -> f64 {
        f64::INFINITY
    }

    /// Returns about where a point in space lies, relative to another one, and its lift there: the
    /// squared distance, less the weight if it has one; `None`, the default, if there are no such
    /// numbers.
    ///
    /// Used to guess the cells that fill a hole, which predicates verify. Without them, a removal
    /// in space takes several times as long.
    #[inline(always)]
    fn rough_lift(&self, _: &Self::Point, _: &Self::Point) -> Option<[f64; 4]> {
        None
    }

    /// Returns a hash of a point: equal for points on one site, if neither has the larger weight
    /// (see [`side_of_sphere_in_flat`](Self::side_of_sphere_in_flat)). `None`, the default, if
    /// there is none.
    ///
    /// [`Regular`](crate::Regular) finds out by it if a hidden point is given again. Without it,
    /// all points under a cell are searched.
    #[inline]
    fn point_hash(&self, _: &Self::Point) -> Option<u64> {
        None
    }

    /// Returns the orientation of fewer than `N` points within the flat (line, plane) that they
    /// span.
    ///
    /// For two points it is their order. For three (with `N = 4` only) it is their turn in the
    /// plane, seen from a side that is fixed for the plane. Zero if they span less. The default is
    /// for `N = 3`: a geometry of space overrides it.
    fn orientation_in_flat(&self, simplex: &[&Self::Point]) -> Sign {
        match simplex {
            [p, q] => self.compare(q, p).into(),
            _ => Sign::Zero,
        }
    }

    /// Returns on which side of a simplex's circumscribed sphere `q` lies, within the flat that the
    /// simplex spans and `q` lies in: positive inside, whatever the orientation of the simplex.
    ///
    /// For two points, inside means between them. A single point is only asked about for weighted
    /// points: `q` is then on the same site, and inside if its weight is larger. The default is
    /// for `N = 3` and points without weights: on one site, none is inside of another. A geometry
    /// of space, or one with weights, overrides it.
    fn side_of_sphere_in_flat(&self, simplex: &[&Self::Point], q: &Self::Point) -> Sign {
        match simplex {
            [_] => Sign::Zero,
            [a, b] => Sign::from(self.compare(q, a)) * Sign::from(self.compare(b, q)),
            _ => Sign::Negative,
        }
    }
}

/// A geometry whose points have coordinates.
///
/// Required for construction from many points at once
/// ([`from_points`](crate::Delaunay::from_points),
/// [`spatial_order`](crate::spatial_order)), for queries by rectangle, Voronoi
/// cells, natural neighbor coordinates and pictures, and by [`Crossing`].
///
/// # Laws
/// - In space, coordinates are for sorting, for the vertices within a box, for Voronoi cells and
///   for natural neighbor coordinates: no other result depends on them.
/// - They are exact: different sites have different coordinates, and if the predicates say that
///   points lie along a line in some order, so do the coordinates.
///
/// # Models
/// [`Plane`], [`Terrain`], [`Steps`], [`Mapped`], [`Weighted`] with two coordinates, [`Space`] and
/// [`WeightedSpace`] with three. A type of your own can forward all predicates to `Plane`:
///
/// ```
/// use std::cmp::Ordering;
/// use breakline_triangulation::geometry::{Coordinates, Geometry, Plane};
/// use breakline_triangulation::num::Sign;
/// use breakline_triangulation::Delaunay;
///
/// #[derive(Debug, Clone, Copy)]
/// struct Tree { kind: &'static str, at: [f64; 2] }
/// struct Forest(Plane);
///
/// impl Geometry<3> for Forest {
///     type Point = Tree;
///     fn admits(&self, p: &Tree) -> bool { self.0.admits(&p.at) }
///     fn compare(&self, p: &Tree, q: &Tree) -> Ordering { self.0.compare(&p.at, &q.at) }
///     fn orientation(&self, s: [&Tree; 3]) -> Sign { self.0.orientation(s.map(|p| &p.at)) }
///     fn side_of_sphere(&self, s: [&Tree; 3], q: &Tree) -> Sign { self.0.side_of_sphere(s.map(|p| &p.at), &q.at) }
/// }
///
/// impl Coordinates<3> for Forest {
///     type Coordinates = [f64; 2];
///     fn coordinates(&self, p: &Tree) -> [f64; 2] { p.at }
///     // The predicates are those of floating-point numbers in the plane: construction takes half the time.
///     fn exact_plan(&self, p: &Tree) -> Option<[f64; 2]> { self.0.exact_plan(&p.at) }
/// }
///
/// let trees = [("oak", [0.0, 0.0]), ("elm", [4.0, 0.0]), ("ash", [0.0, 3.0])].map(|(kind, at)| Tree { kind, at });
/// let (forest, v) = Delaunay::from_points(Forest(Plane::default()), &trees)?;
/// assert_eq!(forest.point(v[1]).kind, "elm");
/// let field = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
/// assert_eq!(forest.voronoi_cell(v[0], &field).area, 3.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Coordinates<const N: usize>: Geometry<N> + Sync {
    /// Up to three coordinates.
    type Coordinates: AsRef<[f64]>;

    /// Returns the coordinates of a point.
    fn coordinates(&self, p: &Self::Point) -> Self::Coordinates;

    /// Returns the position of a point in the plane, if the predicates are the signs of
    /// [`Orientation2`] and [`InCircle`](crate::kernel::InCircle) of such positions, within the
    /// [range](crate::kernel::RANGE) of floating point.
    ///
    /// Construction in bulk then asks the geometry only if floating point is not certain, and takes
    /// half the time.
    #[inline(always)]
    fn exact_plan(&self, _: &Self::Point) -> Option<[f64; 2]> {
        None
    }

    /// Returns the position of a point in space and its weight, if the predicates are the signs of
    /// [`Orientation3`](crate::kernel::Orientation3) and
    /// [`PowerTest3`](crate::kernel::PowerTest3) of such numbers, the positions within the
    /// [range](crate::kernel::RANGE) of floating point. Without weights the test is
    /// [`InSphere`](crate::kernel::InSphere), and the weight 0.
    ///
    /// Only then is construction in bulk possible in space; otherwise the points are inserted one
    /// by one, which takes several times as long. If the positions are not those of the predicates,
    /// the triangulation is wrong.
    #[inline(always)]
    fn exact_site(&self, _: &Self::Point) -> Option<[f64; 4]> {
        None
    }
}

/// A geometry of the plane that can create points where segments meet: what constrained
/// triangulations need beyond predicates.
///
/// # Laws
/// - The predicates of the geometry are those of the points' plans.
/// - `plan` of `meet` is the site that was passed to it.
/// - `meet` does not depend on the order of the segments, nor on the order of their ends.
///
/// Required for [`ConstrainedDelaunay`](crate::ConstrainedDelaunay). The other kind
/// with constraints, [`Constrained`](crate::Constrained), creates no points and does
/// not need it.
///
/// # Models
/// [`Plane`]; [`Terrain`], which takes the lowest of the lines' heights. These points know whether
/// they were surveyed or added:
///
/// ```
/// use std::cmp::Ordering;
/// use breakline_triangulation::geometry::{Coordinates, Crossing, Geometry, Plane};
/// use breakline_triangulation::num::Sign;
/// use breakline_triangulation::{ConstrainedDelaunay, OnCrossing};
///
/// #[derive(Debug, Clone, Copy)]
/// struct Station { at: [f64; 2], is_surveyed: bool }
/// struct Site(Plane);
///
/// impl Geometry<3> for Site {
///     type Point = Station;
///     fn admits(&self, p: &Station) -> bool { self.0.admits(&p.at) }
///     fn compare(&self, p: &Station, q: &Station) -> Ordering { self.0.compare(&p.at, &q.at) }
///     fn orientation(&self, s: [&Station; 3]) -> Sign { self.0.orientation(s.map(|p| &p.at)) }
///     fn side_of_sphere(&self, s: [&Station; 3], q: &Station) -> Sign {
///         self.0.side_of_sphere(s.map(|p| &p.at), &q.at)
///     }
/// }
///
/// impl Coordinates<3> for Site {
///     type Coordinates = [f64; 2];
///     fn coordinates(&self, p: &Station) -> [f64; 2] { p.at }
/// }
///
/// impl Crossing for Site {
///     fn plan(&self, p: &Station) -> [f64; 2] { p.at }
///     fn step(&self) -> f64 { self.0.step() }
///     fn meet(&self, site: [f64; 2], _: &[[&Station; 2]]) -> Station { Station { at: site, is_surveyed: false } }
/// }
///
/// let stations = [[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]].map(|at| Station { at, is_surveyed: true });
/// let lines = [[0, 1], [2, 3]];
/// let (t, _) = ConstrainedDelaunay::from_lines(Site(Plane::default()), &stations, &lines, OnCrossing::Split)?;
/// let added: Vec<_> = t.points().iter().filter(|p| !p.is_surveyed).map(|p| p.at).collect();
/// assert_eq!(added, [[2.0, 2.0]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Crossing: Coordinates<3> {
    /// Returns the point's coordinates in the plane, exactly.
    fn plan(&self, p: &Self::Point) -> [f64; 2];

    /// Returns a power of two of which all admitted coordinates are multiples, those near zero
    /// included; zero if there is none.
    fn step(&self) -> f64 {
        0.0
    }

    /// Returns a point at a site where segments meet. Each of them passes the site within a
    /// rounding.
    fn meet(&self, site: [f64; 2], segments: &[[&Self::Point; 2]]) -> Self::Point;

    /// Returns true if points are nothing but sites, so that [`meet`](Self::meet) does not depend
    /// on the segments. Nothing is interpolated then where vertices are added between lines.
    fn is_of_sites(&self) -> bool {
        false
    }

    /// Returns the point where segments `a b` and `c d` cross in their interiors, rounded.
    ///
    /// Or an end of one of them, if it is so near to the other segment that rounding may hide on
    /// which side of it the end lies.
    fn crossing(&self, ab: [&Self::Point; 2], cd: [&Self::Point; 2]) -> Self::Point {
        let site = crossed::site(ab.map(|p| self.plan(p)), cd.map(|p| self.plan(p)));
        self.meet(self.on_step(site), &[ab, cd])
    }

    /// Rounds a site to the nearest one whose coordinates are multiples of the [step](Self::step).
    /// The site lies on a line between points that are admitted.
    fn on_step(&self, site: [f64; 2]) -> [f64; 2] {
        let step = self.step();
        if step == 0.0 {
            site
        } else {
            // Numbers with their last place at the step or above it are multiples.
            let is_multiple = |x: f64| x.abs() * f64::EPSILON >= step;
            site.map(|x| {
                if is_multiple(x) {
                    x
                } else {
                    unsigned_zero((x / step).round() * step)
                }
            })
        }
    }
}

/// Returns the position of a point seen from above.
#[inline(always)]
fn plan(p: &[f64; 3]) -> [f64; 2] {
    [p[0], p[1]]
}

/// Returns twice the areas that `q` spans with the edges of a triangle, rounded. Coordinates are
/// relative to a corner, so that a triangle that is small compared to its distance from `q` is not
/// lost.
#[inline(always)]
fn rough_areas([a, b, c]: [[f64; 2]; 3], q: [f64; 2]) -> [f64; 3] {
    [[b, c], [c, a], [a, b]].map(|[from, to]| Orientation2([to, q, from]).value(|x, y| x - y))
}

/// Returns a bound on the errors of [`rough_areas`].
#[inline(always)]
fn areas_error(triangle: [[f64; 2]; 3], q: [f64; 2]) -> f64 {
    // The largest differences that there are, so that no term is larger.
    let largest = widths(triangle, q);
    largest.map_or(f64::INFINITY, |widths| {
        let area = Orientation2([widths, widths, [0.0; 2]]);
        area.value(Bounded::difference).error()
    })
}

/// Returns the widths of the box around a simplex and a point; `None` if rounded predicates of
/// points in the box may overflow or underflow.
///
/// Differences that are much smaller than the widths may underflow. All that is lost by it is far
/// less than a bound that is relative to the product of the widths.
#[inline(always)]
fn widths<const D: usize, const N: usize>(simplex: [[f64; D]; N], q: [f64; D]) -> Option<[f64; D]> {
    let width = |axis: usize| {
        let (mut low, mut high) = (q[axis], q[axis]);
        // `PERF:` one instruction each, unlike `min` and `max`.
        for p in &simplex {
            low = if p[axis] < low { p[axis] } else { low };
            high = if p[axis] > high { p[axis] } else { high };
        }
        high - low
    };
    let widths: [f64; D] = std::array::from_fn(width);
    are_ordinary(widths).then_some(widths)
}

/// Returns true if rounded predicates of differences up to these neither overflow nor lose more by
/// underflow than a bound relative to these allows.
#[inline(always)]
fn are_ordinary<const D: usize>(differences: [f64; D]) -> bool {
    let is_ordinary = |width: &f64| (RANGE.min..=2.0 * RANGE.max).contains(width);
    differences.iter().all(is_ordinary)
}

/// Returns the distance along the axes.
#[inline(always)]
fn manhattan<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|axis| (p[axis] - q[axis]).abs()).sum()
}

/// Returns a hash of coordinates; those that are equal have the same.
#[inline]
fn hash<const D: usize>(p: [f64; D]) -> u64 {
    let mut hasher = FxHasher::default();
    p.into_iter()
        .for_each(|x| hasher.write_u64(unsigned_zero(x).to_bits()));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    /// Counts sides that are certain, of those of a simplex that is positively oriented.
    fn certain<G: Geometry<N>, const N: usize>(
        geometry: &G,
        simplex: [G::Point; N],
        q: G::Point,
    ) -> usize {
        if geometry.orientation(simplex.each_ref()) != Sign::Positive {
            return 0;
        }
        let sides = geometry.rough_sides(simplex.each_ref(), &q).unwrap();
        let error = geometry.sides_error(simplex.each_ref(), &q);
        let is_certain = |&i: &usize| {
            let mut replaced = simplex;
            replaced[i] = q;
            let is_certain = sides[i] > error;
            let sign = geometry.orientation(replaced.each_ref());
            assert!(
                !is_certain || sign == Sign::Positive,
                "{simplex:?} {q:?}: {sides:?} {error}"
            );
            is_certain
        };
        (0..N).filter(is_certain).count()
    }

    /// Corners of few bits and of many, of any size; points on facets, up to a few roundings.
    #[test]
    fn sides_above_the_bound_are_certain() {
        let mut random = Random(1);
        let (mut in_plane, mut in_space) = (0, 0);
        for round in 0..40_000 {
            let scale = [1.0, 1e-300, 1e-55, 1e-40, 1e30, 1e60, 1e150][round % 7];
            let coarse = |x: f64| if round % 2 == 0 { (x * 5.0).floor() } else { x };
            let simplex = [[(); 3]; 4].map(|p| p.map(|()| scale * (1.0 + coarse(random.unit()))));
            let mut weights = [(); 4].map(|()| {
                let any = random.unit();
                random.pick(&[0.0, 1e-16, any])
            });
            let sum: f64 = weights.iter().sum();
            weights = weights.map(|weight| if sum > 0.0 { weight / sum } else { 0.25 });
            let q = [0, 1, 2].map(|axis| (0..4).map(|k| weights[k] * simplex[k][axis]).sum());
            in_space += certain(&Space::<crate::kernel::Wide>::default(), simplex, q);
            let [a, b, c, _] = simplex.map(|p| plan(&p));
            in_plane += certain(
                &Plane::<crate::kernel::Wide>::default(),
                [a, b, c],
                plan(&q),
            );
        }
        assert!(
            in_plane > 5_000 && in_space > 5_000,
            "{in_plane} {in_space}"
        );
    }
}

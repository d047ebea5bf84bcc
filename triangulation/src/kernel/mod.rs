//! Predicates: one formula, any arithmetic.
//!
//! A [`Predicate`] is a polynomial in differences of coordinates, written once for every
//! arithmetic; its sign answers a question such as on which side of a line a point lies. A
//! [`Kernel`] is a choice of arithmetic that finds that sign. Users change the arithmetic by
//! changing one type:
//!
//! | kernel | arithmetic | is |
//! |---|---|---|
//! | [`Fast`] | `f64` | no guarantee; for comparison and experiments |
//! | [`Exact`] | arbitrary precision | the reference in tests; any finite coordinates |
//! | [`Expansions`] | sums of `f64` | exact within [`RANGE`], never filtered |
//! | [`Adaptive`] | error-bounded `f64`, then integers on a common grid, of 128 bits, of 256, then pairs of `f64`, then expansions | the default |
//! | [`Interval`] | intervals of `f64`, then as `Adaptive` | for comparison: the dynamic filter of other libraries |
//! | [`Fixed`] | `f64` with a constant error bound, then as `Lattice` | whole numbers of 24 bits, or of up to 52 |
//! | [`Lattice`] | error-bounded `f64`, then integers, wide ones if needed | whole numbers up to 2^53, like those of LAS files |
//! | [`Wide`] | as `Adaptive`, scaled if needed, or arbitrary precision | any finite coordinates, fast |
//!
//! To build a new kernel, combine a quick [`Filter`], which may give up, with a kernel that always
//! answers: see [`Filtered`].
//!
//! Law: the answer is the sign of the real number (except [`Fast`]); swapping two points of an
//! orientation, or two points that span the circle, flips it.

mod adaptive;
mod center;
mod combined;
mod formula;
mod pixel_sides;
mod power;
mod radius;
mod scaled;
mod smallest;

pub use adaptive::{
    ErrorBound, FixedBound, FlooredErrorBound, IntervalBound, OnFineLattice, OnLattice, PairBound,
    WholeNumbers,
};
pub use center::{circumcenter, circumcenter_in_space, power_center, power_center_in_space};
pub(crate) use center::{normal_of_facet, power_center_of_facet};
pub use combined::{Adaptive, Fixed, Interval, Lattice, Wide};
pub use formula::{
    CompareDistance, DotProduct, InCircle, InCircleOfPlane, InSphere, Orientation2, Orientation3,
    PointArea, crossing, crossing_by, twice_area,
};
pub(crate) use formula::{facet_volumes, largest_minus};
pub use pixel_sides::{CornerSide, CrossingSide};
pub use power::{ComparePower, PowerInPlane, PowerOnLine, PowerTest2, PowerTest3};
pub(crate) use radius::{Congruence, RoundedRadius, SquaredRadii, SquaredRadius};
pub use scaled::Scaled;
pub(crate) use smallest::side_of_smallest_sphere;

use std::fmt::Debug;
use std::marker::PhantomData;

use crate::num::{Dyadic, Expansion, Number, Sign};

/// A polynomial in differences of coordinates, whose sign answers a geometric question.
///
/// # Laws
/// - Homogeneous: all terms are products of [`DEGREE`](Self::DEGREE) differences, so multiplying
///   all coordinates by a power of two does not change the sign.
/// - [`axis`](Self::axis) returns all coordinates that [`value`](Self::value) takes differences of,
///   and no others.
/// - `value` does not branch on what it computes: it is one formula in any [`Number`].
///
/// # Models
/// [`Orientation2`], [`Orientation3`], [`InCircle`], [`InSphere`], [`InCircleOfPlane`],
/// [`CompareDistance`], [`DotProduct`], [`PowerTest2`], [`PowerTest3`], [`PowerInPlane`],
/// [`PowerOnLine`], [`ComparePower`], and the predicates of snap rounding, [`CornerSide`] and
/// [`CrossingSide`]. A predicate of your own is exact at once, with every kernel but [`Fast`]:
///
/// ```
/// use breakline_triangulation::kernel::{Adaptive, Exact, Kernel, Predicate};
/// use breakline_triangulation::num::{Number, Sign};
///
/// /// Positive if the third point lies inside of the circle that has the first two as its diameter.
/// #[derive(Clone)]
/// struct InDiameter([[f64; 2]; 3]);
///
/// impl Predicate for InDiameter {
///     const DEGREE: i32 = 2;
///     const AXES: usize = 2;
///
///     fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
///         self.0.iter().map(move |p| p[axis])
///     }
///
///     fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
///         let [a, b, q] = self.0;
///         let [x, y] = [0, 1].map(|k| difference(a[k], q[k]) * difference(q[k], b[k]));
///         x + y
///     }
/// }
///
/// let side = |q| Adaptive::sign(&InDiameter([[0.0, 0.0], [1.0, 1.0], q]));
/// assert_eq!(side([0.0, 1.0]), Sign::Zero);
/// assert_eq!(side([1e-20, 1.0]), Sign::Positive);
/// assert_eq!(side([-1e-20, 1.0]), Exact::sign(&InDiameter([[0.0, 0.0], [1.0, 1.0], [-1e-20, 1.0]])));
/// ```
pub trait Predicate: Clone {
    /// The degree in the differences: at most 5, with fewer than 2^7 terms. The arithmetics are
    /// proven for these limits.
    const DEGREE: i32;

    /// The number of coordinate axes.
    const AXES: usize;

    /// Returns the coordinates on one axis. Differences are only taken between these; all terms are
    /// products of `DEGREE` of them.
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone;

    /// Returns the value of the polynomial, in the arithmetic that `difference` returns.
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T;

    /// Returns the predicate of points that are further apart: each difference that its
    /// [`value`](Self::value) takes is at least as large as the one that this predicate takes
    /// there, both rounded. `None`, the default, if there is none that is quick to find.
    ///
    /// A bound on the error of the one is a bound on the error of the other. If all its points but
    /// one are equal, the compiler is left with a few operations, and needs half of those that
    /// bound each term on its own.
    #[inline(always)]
    fn widest(&self) -> Option<Self> {
        None
    }
}

/// The magnitudes of coordinates for which an arithmetic is proven: `min..=max`, zero, and
/// multiples of the last place of `min` below it. If `max` is less than `min`, only these multiples
/// up to `max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The smallest magnitude from which on all numbers are admitted.
    pub min: f64,
    /// The largest magnitude.
    pub max: f64,
}

/// The range in which `f64` neither overflows nor underflows in any predicate of this crate:
/// `2^-160..=2^200`.
///
/// *Downwards.* Coordinates are multiples of `2^-160 / 2^52 = 2^-212` (below `2^-160` only these
/// are admitted), and so are their differences. Every intermediate result of degree `d`, rounded or
/// not, is a multiple of `2^(-212 d)`, which for degree 5 (in-sphere tests, the highest) is
/// `2^-1060 > 2^-1074`. So a result is rounded only if it is larger than its unit by 53 bits. It is
/// never subnormal: a rounded term is at least `2^-1007`, and an error bound relative to it does
/// not underflow. The error terms of exact products are multiples of `2^-1060` themselves; none is
/// lost.
///
/// *Upwards.* Fewer than 2^7 terms of differences up to `2^201` stay below
/// `2^(5 * 201 + 7) = 2^1012`, and the components of an expansion below twice its value. The
/// largest factor of a product is a volume of `6 (2^201)^3 < 2^606`, so splitting it, by
/// `2^27 + 1`, does not come near an overflow.
pub const RANGE: Range = Range {
    min: f64::from_bits((1023 - 160) << 52),
    max: f64::from_bits((1023 + 200) << 52),
};

impl Range {
    /// Every finite number.
    pub const FINITE: Range = Range {
        min: 0.0,
        max: f64::MAX,
    };

    /// Returns the range that both admit.
    const fn and(self, other: Range) -> Range {
        Range {
            min: if self.min > other.min {
                self.min
            } else {
                other.min
            },
            max: if self.max < other.max {
                self.max
            } else {
                other.max
            },
        }
    }

    /// Returns coordinates of this range, if they are within [`RANGE`], too.
    #[inline(always)]
    pub(crate) fn filtered<const D: usize>(self, coordinates: [f64; D]) -> Option<[f64; D]> {
        let is_within = RANGE.min <= self.min && self.max <= RANGE.max;
        (is_within || coordinates.iter().all(|&x| RANGE.admits(x))).then_some(coordinates)
    }

    /// Returns true if a coordinate is in the range. NaN never is.
    #[inline]
    pub fn admits(self, x: f64) -> bool {
        let magnitude = x.abs();
        let is_multiple = |magnitude: f64| {
            magnitude == 0.0 || (magnitude / (self.min * f64::EPSILON)).fract() == 0.0
        };
        magnitude <= self.max && (self.min <= magnitude || is_multiple(magnitude))
    }
}

/// A choice of arithmetic that always finds the sign of a predicate. All exactness of a
/// triangulation rests on it.
///
/// # Laws
/// - For coordinates in [`RANGE`](Self::RANGE) the answer is the sign of the real number, and the
///   same each time. Of the models, only [`Fast`] breaks this law.
/// - Outside of the range nothing is promised: a geometry does not
///   [admit](crate::geometry::Geometry::admits) such points.
///
/// # Models
/// See the table on the [module's page](self). Geometries take a kernel as their parameter. To
/// build one of your own, put a quick [`Filter`] before a kernel with [`Filtered`], or implement
/// the trait. This kernel checks another one:
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::kernel::{Adaptive, Exact, Kernel, Predicate, Range};
/// use breakline_triangulation::num::Sign;
/// use breakline_triangulation::Delaunay;
///
/// #[derive(Debug, Clone, Copy, Default)]
/// struct Watched;
///
/// impl Kernel for Watched {
///     const RANGE: Range = Adaptive::RANGE;
///
///     fn sign<P: Predicate>(predicate: &P) -> Sign {
///         let sign = Adaptive::sign(predicate);
///         assert_eq!(sign, Exact::sign(predicate));
///         sign
///     }
/// }
///
/// let grid: Vec<[f64; 2]> = (0..25).map(|k| [k % 5, k / 5].map(|i| f64::from(i) * 0.1)).collect();
/// let (t, _) = Delaunay::<Plane<Watched>, 3>::from_points(Plane::default(), &grid)?;
/// assert_eq!(t.vertex_count(), 25);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Kernel: Copy + Default + Debug + Send + Sync + 'static {
    /// The coordinates that it is proven for.
    const RANGE: Range;

    /// Returns the sign of a predicate.
    fn sign<P: Predicate>(predicate: &P) -> Sign;
}

/// A quick arithmetic that may fail to find the sign.
///
/// # Laws
/// Within [`RANGE`](Self::RANGE), a sign that it returns is that of the real number.
///
/// # Models
/// [`ErrorBound`], [`FlooredErrorBound`], [`PairBound`], [`IntervalBound`], [`FixedBound`];
/// [`OnLattice`], [`OnFineLattice`], [`WholeNumbers`]; [`Scaled`].
pub trait Filter: Copy + Default + Debug + Send + Sync + 'static {
    /// The coordinates that it is proven for.
    const RANGE: Range;

    /// Returns the sign of a predicate, or `None` if it is not certain.
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign>;
}

/// A kernel that tries the filter `Quick` first, and falls back to `Sure`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Filtered<Quick, Sure>(PhantomData<(Quick, Sure)>);

impl<Quick: Filter, Sure: Kernel> Kernel for Filtered<Quick, Sure> {
    const RANGE: Range = Quick::RANGE.and(Sure::RANGE);

    #[inline(always)]
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        match Quick::try_sign(predicate) {
            Some(sign) => sign,
            None => surely::<Sure, P>(predicate.clone()),
        }
    }
}

/// Kept out of line, so that the filter's code stays small in hot loops.
///
/// `PERF:` by value. Through a reference, the filter would read the points from memory to which
/// they have just been copied.
#[cold]
#[inline(never)]
fn surely<K: Kernel, P: Predicate>(predicate: P) -> Sign {
    K::sign(&predicate)
}

/// Plain floating point: wrong near zero.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fast;

impl Kernel for Fast {
    const RANGE: Range = RANGE;

    #[inline(always)]
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        Sign::of(&predicate.value(|a, b| a - b))
    }
}

/// Arbitrary precision: correct for every finite coordinate, and slow.
#[derive(Debug, Clone, Copy, Default)]
pub struct Exact;

impl Kernel for Exact {
    const RANGE: Range = Range::FINITE;

    #[inline(never)] // long, and no faster where it is called
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        predicate.value(Dyadic::difference).sign()
    }
}

/// Floating-point expansions: correct within [`RANGE`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Expansions;

impl Kernel for Expansions {
    const RANGE: Range = RANGE;

    #[inline(never)] // long, and no faster where it is called
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        predicate.value(Expansion::difference).sign()
    }
}

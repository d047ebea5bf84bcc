//! Predicates: one formula, any arithmetic.
//!
//! A [`Predicate`] is a polynomial in differences of coordinates, written once, in any arithmetic; its
//! sign says on which side something lies. A [`Kernel`] is a choice of arithmetic to find that sign, so a
//! user changes one type to change it:
//!
//! | kernel | arithmetic | is |
//! |---|---|---|
//! | [`Fast`] | `f64` | no guarantee; for comparison and experiments |
//! | [`Exact`] | arbitrary precision | the judge in tests; any finite coordinates |
//! | [`Expansions`] | sums of `f64` | exact within [`RANGE`], never filtered |
//! | [`Adaptive`] | error-bounded `f64`, then integers on a common grid, of 128 bits, of 256, then pairs of `f64`, then expansions | the default |
//! | [`Interval`] | intervals of `f64`, then as `Adaptive` | for comparison: the dynamic filter of other libraries |
//! | [`Fixed`] | `f64` with a constant error bound, then as `Lattice` | whole numbers of 24 bits, or of up to 52 |
//! | [`Lattice`] | error-bounded `f64`, then integers, wide ones if need be | whole numbers up to 2^53, like those of LAS files |
//! | [`Wide`] | as `Adaptive`, scaled if need be, or arbitrary precision | any finite coordinates, fast |
//!
//! New ones are combined with [`Filtered`]: a quick [`Filter`] that may give up, before a sure
//! kernel.
//!
//! Law: the answer is the sign of the real number (except [`Fast`]); swapping two points of an
//! orientation, or two points that span the circle, flips it.

mod adaptive;
mod center;
mod formula;
mod power;
mod rounding;
mod scaled;

pub use adaptive::{
    ErrorBound, FixedBound, FlooredErrorBound, IntervalBound, OnFineLattice, OnLattice, PairBound, WholeNumbers,
};
pub use center::{circumcenter, power_center};
pub use formula::{
    CompareDistance, DotProduct, InCircle, InCircleOfPlane, InSphere, Orientation2, Orientation3, crossing, twice_area,
};
pub use power::{ComparePower, PowerOnLine, PowerTest2};
pub use rounding::{CornerSide, CrossingSide};
pub use scaled::Scaled;

use std::fmt::Debug;
use std::marker::PhantomData;

use crate::num::{Dyadic, Expansion, Number, Sign};

/// A polynomial in differences of coordinates, whose sign answers a question.
///
/// # Laws
/// - Homogeneous: all terms are products of [`DEGREE`](Self::DEGREE) differences, so that coordinates times a power of
///   two leave the sign.
/// - [`axis`](Self::axis) tells all coordinates that [`value`](Self::value) takes differences of, and these only.
/// - `value` decides nothing by what it computes: it is one formula in any [`Number`].
///
/// # Models
/// [`Orientation2`], [`Orientation3`], [`InCircle`], [`InSphere`], [`InCircleOfPlane`], [`CompareDistance`],
/// [`PowerTest2`], [`PowerOnLine`], and the questions of snap rounding, [`CornerSide`] and [`CrossingSide`]. One of
/// one's own is exact at once, with every kernel but [`Fast`]:
///
/// ```
/// use breakline_triangulation::kernel::{Adaptive, Exact, Kernel, Predicate};
/// use breakline_triangulation::num::{Number, Sign};
///
/// /// Positive if the third point lies inside of the circle that has the first two as its diameter.
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
pub trait Predicate {
    /// Degree in the differences: 5 at the most, with fewer than 2^7 terms, which is what the arithmetics are
    /// proven for.
    const DEGREE: i32;

    /// Number of coordinate axes.
    const AXES: usize;

    /// The coordinates that enter, on one axis. Differences are only taken between these; all terms are products of
    /// `DEGREE` of them.
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone;

    /// The polynomial, in the arithmetic that `difference` returns.
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T;
}

/// Magnitudes of coordinates for which an arithmetic is proven: `min..=max`; and below, zero and other multiples of the
/// last place of `min`. Where `max` is below `min`, there are these multiples only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest magnitude at which all numbers are admitted.
    pub min: f64,
    /// Largest magnitude.
    pub max: f64,
}

/// Where `f64` neither overflows nor underflows in any predicate of this crate: `2^-160..=2^200`.
///
/// *Downwards.* Coordinates are multiples of `2^-160 / 2^52 = 2^-212` (below `2^-160` these only are admitted), and so
/// are their differences; what is computed of degree `d`, rounded or not, is a multiple of `2^(-212 d)`, which for
/// degree 5 (in-sphere, the highest) is `2^-1060 > 2^-1074`. A rounding thus happens only to what is larger than its
/// unit by 53 bits: it is never one of a subnormal number, terms that carry one are no less than `2^-1007`, and an
/// error bound relative to them is there, too. The error terms of exact products are multiples of `2^-1060` themselves;
/// none is lost.
///
/// *Upwards.* Fewer than 2^7 terms of differences up to `2^201` stay below `2^(5 * 201 + 7) = 2^1012`, and the
/// components of an expansion below twice its value. The largest factor of a product is a volume of
/// `6 (2^201)^3 < 2^606`, so that the splitting of factors, by `2^27 + 1`, does not come near an overflow.
pub const RANGE: Range = Range { min: f64::from_bits((1023 - 160) << 52), max: f64::from_bits((1023 + 200) << 52) };

impl Range {
    /// Every finite number.
    pub const FINITE: Range = Range { min: 0.0, max: f64::MAX };

    /// What both admit.
    const fn and(self, other: Range) -> Range {
        Range {
            min: if self.min > other.min { self.min } else { other.min },
            max: if self.max < other.max { self.max } else { other.max },
        }
    }

    /// Coordinates within this range, if they are within [`RANGE`], too.
    #[inline(always)]
    pub(crate) fn filtered<const D: usize>(self, coordinates: [f64; D]) -> Option<[f64; D]> {
        let is_within = RANGE.min <= self.min && self.max <= RANGE.max;
        (is_within || coordinates.iter().all(|&x| RANGE.admits(x))).then_some(coordinates)
    }

    /// Whether a coordinate is admitted. Never a NaN.
    #[inline]
    pub fn admits(self, x: f64) -> bool {
        let magnitude = x.abs();
        let is_multiple = |magnitude: f64| magnitude == 0.0 || (magnitude / (self.min * f64::EPSILON)).fract() == 0.0;
        magnitude <= self.max && (self.min <= magnitude || is_multiple(magnitude))
    }
}

/// A choice of arithmetic that can always tell a predicate's sign. All that is exact in a triangulation rests on it.
///
/// # Laws
/// - For coordinates in [`RANGE`](Self::RANGE) the answer is the sign of the real number, and the same each time. Of
///   the models [`Fast`] alone breaks this law.
/// - Outside of the range nothing is promised: a geometry does not [admit](crate::geometry::Geometry::admits) such
///   points.
///
/// # Models
/// See the table on the [module's page](self). Geometries take a kernel as their parameter. For one of one's own,
/// [`Filtered`] puts a quick [`Filter`] before a sure kernel; or, as here, one watches the other:
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
    /// The coordinates it is proven for.
    const RANGE: Range;

    /// The sign of the predicate.
    fn sign<P: Predicate>(predicate: &P) -> Sign;
}

/// An arithmetic that is quick and sometimes cannot tell.
///
/// # Laws
/// Within [`RANGE`](Self::RANGE), a sign that it does tell is that of the real number.
///
/// # Models
/// [`ErrorBound`], [`FlooredErrorBound`], [`PairBound`], [`IntervalBound`], [`FixedBound`]; [`OnLattice`],
/// [`OnFineLattice`], [`WholeNumbers`]; [`Scaled`].
pub trait Filter: Copy + Default + Debug + Send + Sync + 'static {
    /// The coordinates it is proven for.
    const RANGE: Range;

    /// The sign of the predicate, if certain.
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign>;
}

/// Tries `Quick`, and asks `Sure` when it cannot tell.
#[derive(Debug, Clone, Copy, Default)]
pub struct Filtered<Quick, Sure>(PhantomData<(Quick, Sure)>);

impl<Quick: Filter, Sure: Kernel> Kernel for Filtered<Quick, Sure> {
    const RANGE: Range = Quick::RANGE.and(Sure::RANGE);

    #[inline(always)]
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        match Quick::try_sign(predicate) {
            Some(sign) => sign,
            None => surely::<Sure, P>(predicate),
        }
    }
}

/// Out of line, so that the filter's code stays small in the hot loops.
#[cold]
#[inline(never)]
fn surely<K: Kernel, P: Predicate>(predicate: &P) -> Sign {
    K::sign(predicate)
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

/// Arbitrary precision: right for every finite coordinate, and slow.
#[derive(Debug, Clone, Copy, Default)]
pub struct Exact;

impl Kernel for Exact {
    const RANGE: Range = Range::FINITE;

    #[inline(never)] // long, and no faster where it is called
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        predicate.value(Dyadic::difference).sign()
    }
}

/// Floating-point expansions: right within [`RANGE`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Expansions;

impl Kernel for Expansions {
    const RANGE: Range = RANGE;

    #[inline(never)] // long, and no faster where it is called
    fn sign<P: Predicate>(predicate: &P) -> Sign {
        predicate.value(Expansion::difference).sign()
    }
}

/// The default: as fast as floating point where that is certain, exact everywhere within [`RANGE`].
pub type Adaptive = Filtered<ErrorBound, Nearly>;

/// What is left to it, where points are nearly collinear or cocircular.
type Nearly = Filtered<OnLattice, Filtered<OnFineLattice, Filtered<PairBound, Expansions>>>;

/// As [`Adaptive`], with intervals in place of the error bound: certain a little more often, and slower.
pub type Interval = Filtered<IntervalBound, Nearly>;

/// For coordinates that are whole numbers of magnitude `2^BITS` at the most (CGAL's `Fixed_precision_nt` has the same
/// 24 bits; [`Steps`](crate::geometry::Steps) have 31): the error bound is known before anything is computed, and an
/// orientation in the plane costs no more than with [`Fast`].
pub type Fixed<const BITS: i32 = 24> = Filtered<FixedBound<BITS>, NearlyWhole>;

/// For coordinates that are whole numbers, up to `2^53`: integers of 128 bits, and of 256, answer what floating point
/// cannot; in space, expansions what these cannot hold.
pub type Lattice = Filtered<ErrorBound, NearlyWhole>;

/// What is left to these two.
type NearlyWhole = Filtered<WholeNumbers, Filtered<OnFineLattice, Expansions>>;

/// For every finite coordinate, from `5e-324` to `1.8e308`: nearly as fast as [`Adaptive`] within its range, and where
/// a power of two brings the coordinates of a question there.
pub type Wide = Filtered<FlooredErrorBound, Filtered<OnLattice, Filtered<Scaled<Adaptive>, Exact>>>;

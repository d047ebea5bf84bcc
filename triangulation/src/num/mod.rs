//! Numbers for evaluating predicates: rounded ones with error bounds, and exact ones.
//!
//! A predicate of computational geometry is the sign of a polynomial in differences of coordinates.
//! The polynomials are written once, in [`kernel`](crate::kernel), generic in [`Number`]; kernels
//! differ in the numbers that they put in.
//!
//! | number | exact | cost | used for |
//! |---|---|---|---|
//! | `f64` | no | 1 | experiments, comparison |
//! | [`Bounded`] | computes an error bound | 2 | filter: nearly every call ends here |
//! | [`Fixed`] | has a constant error bound | 1 | filter for whole numbers of few bits |
//! | [`Interval`] | computes a lower and an upper bound | 10 | filter; exact on small whole numbers |
//! | `i128` | within its range, see [`lattice`] | 5 | coordinates on a common grid: ties are the rule there |
//! | [`Pair`] | to twice the digits of `f64` | 15 | positions that are then rounded; filter near zero, in [`Bounded`] |
//! | [`Integer`] | within its 256 bits | 20 | coordinates on a fine common grid |
//! | [`Expansion`] | within the exponents of `f64` | 100 | what the filters leave undecided |
//! | [`Dyadic`] | always | 500 | the reference in tests; magnitudes out of range of all others |

mod bounded;
mod dyadic;
mod expansion;
mod fixed;
mod integer;
mod interval;
pub(crate) mod lanes;
pub mod lattice;
mod pair;

pub use bounded::Bounded;
pub use dyadic::Dyadic;
pub use expansion::Expansion;
pub use fixed::Fixed;
pub use integer::Integer;
pub use interval::Interval;
pub use pair::Pair;

use std::ops::{Add, Mul, Neg, Sub};

/// Returns zero for negative zero, and any other number as it is, so that equal numbers have equal
/// bits.
///
/// ```
/// use breakline_triangulation::num::unsigned_zero;
///
/// assert_eq!(unsigned_zero(-0.0).to_bits(), 0.0f64.to_bits());
/// assert_eq!(unsigned_zero(-1.5), -1.5);
/// ```
#[inline(always)]
pub fn unsigned_zero(x: f64) -> f64 {
    x + 0.0
}

/// The sign of a real number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign {
    /// Below zero: clockwise, outside, below.
    Negative = -1,
    /// Zero: collinear, cocircular, coplanar.
    Zero = 0,
    /// Above zero: counter-clockwise, inside, above.
    Positive = 1,
}

impl Sign {
    /// Returns the sign of a number that is not NaN.
    #[inline]
    pub fn of<T: PartialOrd + Default>(value: &T) -> Self {
        let zero = T::default();
        if *value > zero {
            Sign::Positive
        } else if *value < zero {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }
}

impl Neg for Sign {
    type Output = Sign;

    #[inline]
    fn neg(self) -> Sign {
        match self {
            Sign::Negative => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Positive => Sign::Negative,
        }
    }
}

impl Mul for Sign {
    type Output = Sign;

    #[inline]
    fn mul(self, other: Sign) -> Sign {
        match other {
            Sign::Negative => -self,
            Sign::Zero => Sign::Zero,
            Sign::Positive => self,
        }
    }
}

impl From<Sign> for std::cmp::Ordering {
    #[inline]
    fn from(sign: Sign) -> Self {
        sign.cmp(&Sign::Zero)
    }
}

impl From<std::cmp::Ordering> for Sign {
    #[inline]
    fn from(ordering: std::cmp::Ordering) -> Self {
        match ordering {
            std::cmp::Ordering::Less => Sign::Negative,
            std::cmp::Ordering::Equal => Sign::Zero,
            std::cmp::Ordering::Greater => Sign::Positive,
        }
    }
}

/// The numbers in which polynomials are evaluated: a commutative ring.
///
/// # Laws
/// Sums, differences and products are those of real numbers. Or the type keeps track of the error,
/// so that its sign can be reported as uncertain. `f64` breaks this law; it is for experiments.
///
/// # Models
/// Everything that can be added, subtracted, multiplied and cloned is a `Number`; see the table on
/// the [module's page](self). This one counts products:
///
/// ```
/// use std::ops::{Add, Mul, Sub};
/// use breakline_triangulation::kernel::{InCircle, Orientation2, Predicate};
///
/// #[derive(Clone)]
/// struct Products(u32);
///
/// impl Add for Products { type Output = Self; fn add(self, other: Self) -> Self { Products(self.0 + other.0) } }
/// impl Sub for Products { type Output = Self; fn sub(self, other: Self) -> Self { Products(self.0 + other.0) } }
/// impl Mul for Products { type Output = Self; fn mul(self, other: Self) -> Self { Products(self.0 + other.0 + 1) } }
///
/// let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// assert_eq!(Orientation2([a, b, c]).value(|_, _| Products(0)).0, 2);
/// assert_eq!(InCircle([a, b, c, d]).value(|_, _| Products(0)).0, 15);
/// ```
pub trait Number: Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<T: Clone + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Number for T {}

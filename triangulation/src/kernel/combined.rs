//! The kernels that combine filters.

use super::adaptive::{
    ErrorBound, FixedBound, FlooredErrorBound, IntervalBound, OnFineLattice, OnLattice, PairBound,
    WholeNumbers,
};
use super::scaled::Scaled;
use super::{Exact, Expansions, Filtered};

/// The default kernel: as fast as floating point where that is certain, exact everywhere within
/// [`RANGE`](super::RANGE).
pub type Adaptive = Filtered<ErrorBound, Nearly>;

/// The fallback where points are nearly collinear or cocircular.
type Nearly = Filtered<OnLattice, Filtered<OnFineLattice, Filtered<PairBound, Expansions>>>;

/// Like [`Adaptive`], but with intervals instead of the error bound: certain a little more often,
/// and slower.
pub type Interval = Filtered<IntervalBound, Nearly>;

/// The kernel for coordinates that are whole numbers of magnitude up to `2^BITS`.
///
/// The error bound is known before anything is computed, and an orientation in the plane costs no
/// more than with [`Fast`](super::Fast). CGAL's `Fixed_precision_nt` has the same 24 bits;
/// [`Steps`](crate::geometry::Steps) have 31.
pub type Fixed<const BITS: i32 = 24> = Filtered<FixedBound<BITS>, NearlyWhole>;

/// The kernel for coordinates that are whole numbers, up to `2^53`.
///
/// Integers of 128 bits, then of 256, decide what floating point cannot; in space, expansions
/// decide what exceeds both.
pub type Lattice = Filtered<ErrorBound, NearlyWhole>;

/// The fallback of these two.
type NearlyWhole = Filtered<WholeNumbers, Filtered<OnFineLattice, Expansions>>;

/// The kernel for every finite coordinate, from `5e-324` to `1.8e308`.
///
/// Nearly as fast as [`Adaptive`] within its range, and where a power of two brings the coordinates
/// of a predicate into that range.
pub type Wide = Filtered<FlooredErrorBound, Filtered<OnLattice, Filtered<Scaled<Adaptive>, Exact>>>;

use std::cmp::Ordering;

use super::{Geometry, Plane, Steps, Terrain, Weighted};
use crate::kernel::{CompareDistance, ComparePower, Kernel};

/// A geometry of the plane that can tell which of two points is nearer: what queries for nearest vertices need.
///
/// # Laws
/// - The distance is the one that the circles of the [geometry](Geometry::side_of_sphere) are circles of: walks to the
///   nearest vertex follow from the empty circles.
/// - The answer is exact: `Equal` for equal distances, and `Less` for no two points at once.
///
/// # Models
/// [`Plane`], [`Terrain`], [`Steps`], [`Mapped`](super::Mapped); [`Weighted`], whose distance is the power. A geometry that leaves its points' places to one of these does so here:
///
/// ```
/// use std::cmp::Ordering;
/// use breakline::geometry::{Metric, Plane};
///
/// let plane: Plane = Plane::default();
/// assert_eq!(plane.compare_distance(&[0.0, 0.0], &[3.0, 4.0], &[0.0, 5.0]), Ordering::Equal);
/// ```
pub trait Metric: Geometry<3> {
    /// Whether `a` is nearer to `q` than `b` is (`Less`), or further away.
    fn compare_distance(&self, q: &Self::Point, a: &Self::Point, b: &Self::Point) -> Ordering;
}

fn compare<K: Kernel>(places: [[f64; 2]; 3]) -> Ordering {
    (K::sign(&CompareDistance(places)) as i8).cmp(&0)
}

impl<K: Kernel> Metric for Plane<K> {
    #[inline]
    fn compare_distance(&self, q: &[f64; 2], a: &[f64; 2], b: &[f64; 2]) -> Ordering {
        compare::<K>([*q, *a, *b])
    }
}

impl<K: Kernel> Metric for Terrain<K> {
    /// In plan.
    #[inline]
    fn compare_distance(&self, q: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> Ordering {
        compare::<K>([q, a, b].map(super::terrain::plan))
    }
}

impl<K: Kernel> Metric for Steps<K> {
    /// In plan.
    #[inline]
    fn compare_distance(&self, q: &[i32; 3], a: &[i32; 3], b: &[i32; 3]) -> Ordering {
        compare::<K>([q, a, b].map(super::steps::plan))
    }
}

impl<K: Kernel> Metric for Weighted<K> {
    /// By power: squared distance less weight. That of `q` counts for neither.
    #[inline]
    fn compare_distance(&self, q: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> Ordering {
        (K::sign(&ComparePower([*q, *a, *b])) as i8).cmp(&0)
    }
}

use std::cmp::Ordering;

use super::{Geometry, Plane, Space, Steps, Terrain, Weighted, WeightedSpace};
use crate::kernel::{CompareDistance, ComparePower, Kernel};

/// A geometry that can compare distances, in the plane (`N` is 3) or in space (4).
///
/// Required for [`Delaunay::nearest`](crate::Delaunay::nearest),
/// [`nearest_first`](crate::Delaunay::nearest_first) and
/// [`within`](crate::Delaunay::within).
///
/// # Laws
/// - The circles of [`side_of_sphere`](Geometry::side_of_sphere) are circles of this distance:
///   walks to the nearest vertex rely on the empty circles.
/// - The answer is exact: `Equal` for equal distances, and antisymmetric.
///
/// # Models
/// [`Plane`], [`Terrain`] and [`Steps`] (in plan), [`Mapped`](super::Mapped), [`Space`]; and
/// [`Weighted`] and [`WeightedSpace`], whose distance is the power. A geometry of your own that
/// forwards positions to one of these forwards distances, too. This one is for a map whose y axis
/// points down:
///
/// ```
/// use std::cmp::Ordering;
/// use breakline_triangulation::geometry::{Geometry, Metric, Plane};
/// use breakline_triangulation::num::Sign;
/// use breakline_triangulation::Delaunay;
///
/// type Pixel = [u16; 2];
/// struct Screen(Plane);
/// fn site([x, y]: &Pixel) -> [f64; 2] { [f64::from(*x), -f64::from(*y)] }
///
/// impl Geometry<3> for Screen {
///     type Point = Pixel;
///     fn admits(&self, _: &Pixel) -> bool { true }
///     fn compare(&self, p: &Pixel, q: &Pixel) -> Ordering { self.0.compare(&site(p), &site(q)) }
///     fn orientation(&self, s: [&Pixel; 3]) -> Sign { self.0.orientation(s.map(site).each_ref()) }
///     fn side_of_sphere(&self, s: [&Pixel; 3], q: &Pixel) -> Sign {
///         self.0.side_of_sphere(s.map(site).each_ref(), &site(q))
///     }
/// }
///
/// impl Metric for Screen {
///     fn compare_distance(&self, q: &Pixel, a: &Pixel, b: &Pixel) -> Ordering {
///         self.0.compare_distance(&site(q), &site(a), &site(b))
///     }
/// }
///
/// let mut t = Delaunay::new(Screen(Plane::default()));
/// for pixel in [[0, 0], [300, 400], [0, 501]] {
///     t.insert(pixel)?;
/// }
/// let by_distance: Vec<Pixel> = t.nearest_first(&[0, 0], None).map(|v| *t.point(v)).collect();
/// assert_eq!(by_distance, [[0, 0], [300, 400], [0, 501]]);
/// assert_eq!(t.within(&[0, 0], &[500, 0]).count(), 2, "a point on the rim is within");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Metric<const N: usize = 3>: Geometry<N> {
    /// Compares the distances from `q`: `Less` if `a` is nearer than `b`.
    fn compare_distance(&self, q: &Self::Point, a: &Self::Point, b: &Self::Point) -> Ordering;
}

fn compare<K: Kernel, const D: usize>(sites: [[f64; D]; 3]) -> Ordering {
    (K::sign(&CompareDistance(sites)) as i8).cmp(&0)
}

impl<K: Kernel> Metric for Plane<K> {
    #[inline]
    fn compare_distance(&self, q: &[f64; 2], a: &[f64; 2], b: &[f64; 2]) -> Ordering {
        compare::<K, 2>([*q, *a, *b])
    }
}

impl<K: Kernel> Metric for Terrain<K> {
    /// Compares in plan.
    #[inline]
    fn compare_distance(&self, q: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> Ordering {
        compare::<K, 2>([q, a, b].map(super::plan))
    }
}

impl<K: Kernel> Metric for Steps<K> {
    /// Compares in plan.
    #[inline]
    fn compare_distance(&self, q: &[i32; 3], a: &[i32; 3], b: &[i32; 3]) -> Ordering {
        compare::<K, 2>([q, a, b].map(super::steps::plan))
    }
}

impl<K: Kernel> Metric for Weighted<K> {
    /// Compares powers: squared distance less weight. The weight of `q` does not count.
    #[inline]
    fn compare_distance(&self, q: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> Ordering {
        (K::sign(&ComparePower([*q, *a, *b])) as i8).cmp(&0)
    }
}

impl<K: Kernel> Metric<4> for Space<K> {
    #[inline]
    fn compare_distance(&self, q: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> Ordering {
        compare::<K, 3>([*q, *a, *b])
    }
}

impl<K: Kernel> Metric<4> for WeightedSpace<K> {
    /// Compares powers, as for [`Weighted`].
    #[inline]
    fn compare_distance(&self, q: &[f64; 4], a: &[f64; 4], b: &[f64; 4]) -> Ordering {
        (K::sign(&ComparePower([*q, *a, *b])) as i8).cmp(&0)
    }
}

use std::cmp::Ordering;
use std::fmt::{self, Debug};
use std::marker::PhantomData;

use super::{Coordinates, Geometry, Metric, Plane};
use crate::kernel::{Adaptive, Kernel};
use crate::num::Sign;

/// Points of any type, by the site in the plane that a function computes: records of your own,
/// another plane, another metric.
///
/// The site is computed, in floating point, whenever a point is looked at. It must be the same each
/// time, or the laws are broken. What the function rounds is rounded before any predicate: all
/// answers are exact for these sites. Points with equal sites are one site. Constraints are not
/// supported: where lines cross, a point would have to be created from a site.
///
/// ```
/// use breakline_triangulation::geometry::Mapped;
/// use breakline_triangulation::kernel::Fixed;
/// use breakline_triangulation::Delaunay;
///
/// // A type of your own.
/// #[derive(Clone, Copy, Debug)]
/// struct Well { east: f64, north: f64, depth: f32 }
///
/// let wells = [(0.0, 0.0, 9.5), (4.0, 0.0, 12.0), (0.0, 3.0, 7.0)];
/// let wells = wells.map(|(east, north, depth)| Well { east, north, depth });
/// let (delaunay, vertices) = Delaunay::from_points(Mapped::new(|w: &Well| [w.east, w.north]), &wells)?;
/// assert_eq!(delaunay.finite_cells().count(), 1);
/// assert_eq!(delaunay.point(vertices[1]).depth, 12.0);
///
/// // A facade: points in space, seen along y. Whole numbers, so that a faster kernel will do.
/// let facade = Mapped::new(|p: &[f64; 3]| [p[0], p[2]]).with_kernel::<Fixed>();
/// let corners = [[0.0, 7.0, 0.0], [8.0, 7.0, 0.0], [8.0, 7.0, 6.0], [0.0, 7.0, 6.0], [4.0, 7.0, 9.0]];
/// assert_eq!(Delaunay::from_points(facade, &corners)?.0.finite_cells().count(), 3);
///
/// // A metric in which a step to the north is as long as ten to the east.
/// let anisotropic = Mapped::new(|p: &[f64; 2]| [p[0], 10.0 * p[1]]);
/// let points = [[0.0, 0.0], [5.0, 1.0], [0.0, 2.0], [-5.0, 1.0]];
/// let (delaunay, v) = Delaunay::from_points(anisotropic, &points)?;
/// assert!(delaunay.tds().edge(v[1], v[3]).is_some(), "its ends are 10 apart, those of the other diagonal 20");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy)]
pub struct Mapped<P, F, K = Adaptive> {
    site: F,
    of: PhantomData<fn(P) -> K>,
}

impl<P, F: Fn(&P) -> [f64; 2]> Mapped<P, F> {
    /// Returns the geometry whose points lie at the sites that the function computes.
    pub fn new(site: F) -> Self {
        Mapped {
            site,
            of: PhantomData,
        }
    }

    /// Returns the same geometry with another arithmetic.
    pub fn with_kernel<K: Kernel>(self) -> Mapped<P, F, K> {
        Mapped {
            site: self.site,
            of: PhantomData,
        }
    }
}

/// Returns a function that maps points in space to sites in a plane with this normal, of any
/// length. `None` if the normal is zero or not finite.
///
/// Triangles are counter-clockwise for a viewer toward whom the normal points.
///
/// Along an axis, sites are coordinates, perhaps with the other sign. Otherwise they are rounded:
/// to within a few units in the last place of a point's largest coordinate.
///
/// ```
/// use breakline_triangulation::geometry::{Mapped, seen_along};
/// use breakline_triangulation::Delaunay;
///
/// let roof = [[0.0, 0.0, 5.0], [9.0, 0.0, 5.0], [9.0, 4.0, 8.0], [0.0, 4.0, 8.0], [4.5, 2.0, 6.5]];
/// let geometry = Mapped::new(seen_along([0.0, -3.0, 4.0]).expect("a direction"));
/// assert_eq!(Delaunay::from_points(geometry, &roof)?.0.finite_cells().count(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn seen_along(normal: [f64; 3]) -> Option<impl Fn(&[f64; 3]) -> [f64; 2] + Copy + Send + Sync> {
    let [u, v] = axes_across(normal)?;
    let along = |p: &[f64; 3], axis: [f64; 3]| p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
    Some(move |p: &[f64; 3]| [along(p, u), along(p, v)])
}

/// Returns two axes of length one that are a right-handed system with the normal (Duff et al.,
/// *Building an Orthonormal Basis, Revisited*, 2017).
fn axes_across(normal: [f64; 3]) -> Option<[[f64; 3]; 2]> {
    // Relative to the largest: squares of extreme magnitudes would overflow or vanish.
    let largest = normal
        .iter()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let parts = normal.map(|x| x / largest);
    let length = parts.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !length.is_finite() {
        return None;
    }
    let [x, y, z] = parts.map(|x| x / length);
    let side = 1f64.copysign(z);
    let a = -1.0 / (side + z);
    let b = x * y * a;
    Some([
        [1.0 + side * x * x * a, side * b, -side * x],
        [b, side + y * y * a, -y],
    ])
}

impl<P, F, K: Kernel> Debug for Mapped<P, F, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mapped<{:?}>", K::default())
    }
}

impl<P, F, K> Geometry<3> for Mapped<P, F, K>
where
    P: Copy + Debug + Send + Sync,
    F: Fn(&P) -> [f64; 2],
    K: Kernel,
{
    type Point = P;

    #[inline]
    fn admits(&self, p: &P) -> bool {
        Plane::<K>::default().admits(&(self.site)(p))
    }

    #[inline]
    fn is_finite(&self, p: &P) -> bool {
        (self.site)(p).iter().all(|x| x.is_finite())
    }

    #[inline(always)]
    fn compare(&self, p: &P, q: &P) -> Ordering {
        Plane::<K>::default().compare(&(self.site)(p), &(self.site)(q))
    }

    #[inline]
    fn rough_distance(&self, p: &P, q: &P) -> Option<f64> {
        Plane::<K>::default().rough_distance(&(self.site)(p), &(self.site)(q))
    }

    #[inline(always)]
    fn rough_sides(&self, simplex: [&P; 3], q: &P) -> Option<[f64; 3]> {
        Plane::<K>::default().rough_sides(simplex.map(&self.site).each_ref(), &(self.site)(q))
    }

    #[inline(always)]
    fn sides_error(&self, simplex: [&P; 3], q: &P) -> f64 {
        Plane::<K>::default().sides_error(simplex.map(&self.site).each_ref(), &(self.site)(q))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&P; 3]) -> Sign {
        Plane::<K>::default().orientation(simplex.map(&self.site).each_ref())
    }

    #[inline(always)]
    fn side_of_sphere(&self, simplex: [&P; 3], q: &P) -> Sign {
        Plane::<K>::default().side_of_sphere(simplex.map(&self.site).each_ref(), &(self.site)(q))
    }
}

impl<P, F, K> Coordinates<3> for Mapped<P, F, K>
where
    P: Copy + Debug + Send + Sync,
    F: Fn(&P) -> [f64; 2] + Sync,
    K: Kernel,
{
    type Coordinates = [f64; 2];

    #[inline]
    fn coordinates(&self, p: &P) -> [f64; 2] {
        (self.site)(p)
    }

    #[inline(always)]
    fn exact_plan(&self, p: &P) -> Option<[f64; 2]> {
        Plane::<K>::default().exact_plan(&(self.site)(p))
    }
}

impl<P, F, K> Metric for Mapped<P, F, K>
where
    P: Copy + Debug + Send + Sync,
    F: Fn(&P) -> [f64; 2],
    K: Kernel,
{
    #[inline]
    fn compare_distance(&self, q: &P, a: &P, b: &P) -> Ordering {
        let [q, a, b] = [q, a, b].map(&self.site);
        Plane::<K>::default().compare_distance(&q, &a, &b)
    }
}

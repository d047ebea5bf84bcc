use std::cmp::Ordering;
use std::marker::PhantomData;

use super::{Coordinates, Crossing, Geometry, areas_error, lexicographic, manhattan, rough_areas};
use crate::kernel::{Adaptive, InCircle, Kernel, Orientation2};
use crate::num::Sign;

/// The geometry of points in the plane, `[x, y]`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Plane<K = Adaptive>(PhantomData<K>);

impl Plane {
    /// Returns the geometry with the kernel [`Adaptive`]. For another kernel, use
    /// `Plane::<K>::default()`.
    pub fn new() -> Self {
        Plane::default()
    }
}

impl<K: Kernel> Geometry<3> for Plane<K> {
    type Point = [f64; 2];

    #[inline]
    fn admits(&self, p: &[f64; 2]) -> bool {
        p.iter().all(|&x| K::RANGE.admits(x))
    }

    #[inline]
    fn is_finite(&self, p: &[f64; 2]) -> bool {
        p.iter().all(|x| x.is_finite())
    }

    #[inline(always)]
    fn compare(&self, p: &[f64; 2], q: &[f64; 2]) -> Ordering {
        lexicographic(*p, *q)
    }

    #[inline]
    fn rough_distance(&self, p: &[f64; 2], q: &[f64; 2]) -> Option<f64> {
        Some(manhattan(*p, *q))
    }

    #[inline(always)]
    fn rough_sides(&self, simplex: [&[f64; 2]; 3], q: &[f64; 2]) -> Option<[f64; 3]> {
        Some(rough_areas(simplex.map(|p| *p), *q))
    }

    #[inline(always)]
    fn sides_error(&self, simplex: [&[f64; 2]; 3], q: &[f64; 2]) -> f64 {
        areas_error(simplex.map(|p| *p), *q)
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 2]; 3]) -> Sign {
        K::sign(&Orientation2(simplex.map(|p| *p)))
    }

    #[inline(always)]
    fn side_of_sphere(&self, [a, b, c]: [&[f64; 2]; 3], q: &[f64; 2]) -> Sign {
        K::sign(&InCircle([*a, *b, *c, *q]))
    }
}

impl<K: Kernel> Coordinates<3> for Plane<K> {
    type Coordinates = [f64; 2];

    #[inline]
    fn coordinates(&self, p: &[f64; 2]) -> [f64; 2] {
        *p
    }

    #[inline(always)]
    fn exact_plan(&self, p: &[f64; 2]) -> Option<[f64; 2]> {
        K::RANGE.filtered(*p)
    }
}

impl<K: Kernel> Crossing for Plane<K> {
    #[inline]
    fn plan(&self, p: &[f64; 2]) -> [f64; 2] {
        *p
    }

    #[inline]
    fn step(&self) -> f64 {
        K::RANGE.min * f64::EPSILON
    }

    #[inline]
    fn meet(&self, site: [f64; 2], _: &[[&[f64; 2]; 2]]) -> [f64; 2] {
        site
    }

    #[inline]
    fn is_of_sites(&self) -> bool {
        true
    }
}

/// Returns the distance of a point from a segment, rounded, in the unit of the coordinates, which
/// is the same on both axes.
///
/// A segment whose ends coincide is a point. O(1).
pub fn distance_to_segment(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [ux, uy] = [b[0] - a[0], b[1] - a[1]];
    let [vx, vy] = [p[0] - a[0], p[1] - a[1]];
    let length = ux.hypot(uy);
    let along = vx * (ux / length) + vy * (uy / length);
    if along.is_nan() || along <= 0.0 {
        vx.hypot(vy) // beside the start, or the segment is a point
    } else if along >= length {
        (p[0] - b[0]).hypot(p[1] - b[1])
    } else {
        (vx * (uy / length) - vy * (ux / length)).abs()
    }
}

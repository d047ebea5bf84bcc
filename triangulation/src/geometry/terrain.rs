use std::cmp::Ordering;
use std::marker::PhantomData;

use super::{
    Coordinates, Crossing, Geometry, areas_error, lexicographic, manhattan, plan, rough_areas,
};
use crate::kernel::{Adaptive, InCircle, Kernel, Orientation2};
use crate::num::Sign;

/// The geometry of points in space, seen in plan: predicates look at x and y, the height is carried
/// along.
///
/// Points with equal x and y are one site, whatever their heights. Where breaklines cross, each has
/// a height of its own: the vertex there takes the lower one, as points of one site do.
#[derive(Debug, Clone, Copy, Default)]
pub struct Terrain<K = Adaptive>(PhantomData<K>);

impl Terrain {
    /// Returns the geometry with the kernel [`Adaptive`]. For another kernel, use
    /// `Terrain::<K>::default()`.
    pub fn new() -> Self {
        Terrain::default()
    }
}

impl<K: Kernel> Geometry<3> for Terrain<K> {
    type Point = [f64; 3];

    #[inline]
    fn admits(&self, p: &[f64; 3]) -> bool {
        K::RANGE.admits(p[0]) && K::RANGE.admits(p[1])
    }

    #[inline]
    fn is_finite(&self, p: &[f64; 3]) -> bool {
        plan(p).iter().all(|x| x.is_finite())
    }

    #[inline(always)]
    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        lexicographic(plan(p), plan(q))
    }

    #[inline]
    fn rough_distance(&self, p: &[f64; 3], q: &[f64; 3]) -> Option<f64> {
        Some(manhattan(plan(p), plan(q)))
    }

    #[inline(always)]
    fn rough_sides(&self, simplex: [&[f64; 3]; 3], q: &[f64; 3]) -> Option<[f64; 3]> {
        Some(rough_areas(simplex.map(plan), plan(q)))
    }

    #[inline(always)]
    fn sides_error(&self, simplex: [&[f64; 3]; 3], q: &[f64; 3]) -> f64 {
        areas_error(simplex.map(plan), plan(q))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 3]; 3]) -> Sign {
        K::sign(&Orientation2(simplex.map(plan)))
    }

    #[inline(always)]
    fn side_of_sphere(&self, [a, b, c]: [&[f64; 3]; 3], q: &[f64; 3]) -> Sign {
        K::sign(&InCircle([a, b, c, q].map(plan)))
    }
}

impl<K: Kernel> Coordinates<3> for Terrain<K> {
    type Coordinates = [f64; 2];

    #[inline]
    fn coordinates(&self, p: &[f64; 3]) -> [f64; 2] {
        plan(p)
    }

    #[inline(always)]
    fn exact_plan(&self, p: &[f64; 3]) -> Option<[f64; 2]> {
        K::RANGE.filtered(plan(p))
    }
}

impl<K: Kernel> Crossing for Terrain<K> {
    #[inline]
    fn plan(&self, p: &[f64; 3]) -> [f64; 2] {
        plan(p)
    }

    #[inline]
    fn step(&self) -> f64 {
        K::RANGE.min * f64::EPSILON
    }

    fn meet(&self, [x, y]: [f64; 2], segments: &[[&[f64; 3]; 2]]) -> [f64; 3] {
        let heights = segments.iter().map(|&[p, q]| height_along(*p, *q, [x, y]));
        [x, y, heights.fold(f64::NAN, f64::min)]
    }
}

/// Returns the height of a segment at a point in plan; the same for either order of its ends.
///
/// It is taken at the foot of the perpendicular in plan, or at the end that the point lies beyond.
/// If the ends have the same x and y, it is the lower height. In the unit of the ends' heights,
/// which need not be that of the plan. O(1).
pub fn height_along(p: [f64; 3], q: [f64; 3], [x, y]: [f64; 2]) -> f64 {
    let (p, q) = if lexicographic(plan(&p), plan(&q)).is_gt() {
        (q, p)
    } else {
        (p, q)
    };
    // Relative to the longer side: squares of extreme magnitudes would overflow or vanish.
    let [dx, dy] = [0, 1].map(|k| q[k] / 2.0 - p[k] / 2.0);
    let longer = dx.abs().max(dy.abs());
    let [ux, uy] = [dx / longer, dy / longer];
    let along = ((x / 2.0 - p[0] / 2.0) / longer * ux + (y / 2.0 - p[1] / 2.0) / longer * uy)
        / (ux * ux + uy * uy);
    if along.is_nan() {
        p[2].min(q[2])
    } else {
        p[2] + along.clamp(0.0, 1.0) * (q[2] - p[2])
    }
}

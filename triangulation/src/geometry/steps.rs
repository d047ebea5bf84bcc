use std::cmp::Ordering;
use std::marker::PhantomData;

use super::{Coordinates, Geometry, Plane, areas_error, manhattan, rough_areas};
use crate::kernel::{Kernel, Lattice};
use crate::num::Sign;

/// The geometry of points as LAS files store them, in whole steps on three axes, seen in plan: 12
/// bytes a point, and nothing is rounded.
///
/// A step has the same length on both horizontal axes. Points with equal x and y are one site,
/// whatever their heights. `data::Lattice` of the crate `breakline` converts coordinates to steps
/// and steps to coordinates.
#[derive(Debug, Clone, Copy, Default)]
pub struct Steps<K = Lattice>(PhantomData<K>);

impl Steps {
    /// Returns the geometry with the kernel [`Lattice`]. For another kernel, use
    /// `Steps::<K>::default()`.
    pub fn new() -> Self {
        Steps::default()
    }
}

/// Returns the position in plan. Every 32-bit integer is a double.
#[inline(always)]
pub(super) fn plan(p: &[i32; 3]) -> [f64; 2] {
    [p[0].into(), p[1].into()]
}

impl<K: Kernel> Geometry<3> for Steps<K> {
    type Point = [i32; 3];

    #[inline]
    fn admits(&self, p: &[i32; 3]) -> bool {
        Plane::<K>::default().admits(&plan(p))
    }

    #[inline(always)]
    fn compare(&self, p: &[i32; 3], q: &[i32; 3]) -> Ordering {
        p[..2].cmp(&q[..2])
    }

    #[inline]
    fn rough_distance(&self, p: &[i32; 3], q: &[i32; 3]) -> Option<f64> {
        Some(manhattan(plan(p), plan(q)))
    }

    #[inline(always)]
    fn rough_sides(&self, simplex: [&[i32; 3]; 3], q: &[i32; 3]) -> Option<[f64; 3]> {
        Some(rough_areas(simplex.map(plan), plan(q)))
    }

    #[inline(always)]
    fn sides_error(&self, simplex: [&[i32; 3]; 3], q: &[i32; 3]) -> f64 {
        areas_error(simplex.map(plan), plan(q))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[i32; 3]; 3]) -> Sign {
        Plane::<K>::default().orientation(simplex.map(plan).each_ref())
    }

    #[inline(always)]
    fn side_of_sphere(&self, simplex: [&[i32; 3]; 3], q: &[i32; 3]) -> Sign {
        Plane::<K>::default().side_of_sphere(simplex.map(plan).each_ref(), &plan(q))
    }
}

impl<K: Kernel> Coordinates<3> for Steps<K> {
    type Coordinates = [f64; 2];

    #[inline]
    fn coordinates(&self, p: &[i32; 3]) -> [f64; 2] {
        plan(p)
    }
    #[inline(always)]
    fn exact_plan(&self, p: &[i32; 3]) -> Option<[f64; 2]> {
        Plane::<K>::default().exact_plan(&plan(p))
    }
}

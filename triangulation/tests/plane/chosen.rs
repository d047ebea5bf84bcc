//! Geometries whose arithmetic is chosen at run time, so that triangulations are compiled once for
//! all kernels.

use std::cmp::Ordering;

use breakline_triangulation::geometry::{Coordinates, Crossing, Geometry, Plane, Weighted};
use breakline_triangulation::kernel::{Adaptive, Kernel};
use breakline_triangulation::num::Sign;

/// The functions of a geometry of points with `D` coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chosen<const D: usize> {
    admits: fn(&[f64; D]) -> bool,
    orientation: fn([&[f64; D]; 3]) -> Sign,
    side_of_sphere: fn([&[f64; D]; 3], &[f64; D]) -> Sign,
    in_flat: fn(&[&[f64; D]], &[f64; D]) -> Sign,
    exact_plan: fn(&[f64; D]) -> Option<[f64; 2]>,
    step: f64,
}

/// Returns a geometry with the functions of another one, but without exact plans.
fn of<G: Geometry<3, Point = [f64; D]> + Default, const D: usize>() -> Chosen<D> {
    Chosen {
        admits: |p| G::default().admits(p),
        orientation: |simplex| G::default().orientation(simplex),
        side_of_sphere: |simplex, q| G::default().side_of_sphere(simplex, q),
        in_flat: |simplex, q| G::default().side_of_sphere_in_flat(simplex, q),
        exact_plan: |_| None,
        step: 0.0,
    }
}

/// Returns the plane with this kernel.
pub(crate) fn plane<K: Kernel>() -> Chosen<2> {
    Chosen {
        exact_plan: |p| Plane::<K>::default().exact_plan(p),
        step: Plane::<K>::default().step(),
        ..of::<Plane<K>, 2>()
    }
}

/// Returns the weighted plane with this kernel.
pub(crate) fn weighted<K: Kernel>() -> Chosen<3> {
    of::<Weighted<K>, 3>()
}

fn plan<const D: usize>(p: &[f64; D]) -> [f64; 2] {
    [p[0], p[1]]
}

impl<const D: usize> Geometry<3> for Chosen<D> {
    type Point = [f64; D];

    fn admits(&self, p: &[f64; D]) -> bool {
        (self.admits)(p)
    }

    fn compare(&self, p: &[f64; D], q: &[f64; D]) -> Ordering {
        Plane::<Adaptive>::default().compare(&plan(p), &plan(q))
    }

    fn orientation(&self, simplex: [&[f64; D]; 3]) -> Sign {
        (self.orientation)(simplex)
    }

    fn side_of_sphere(&self, simplex: [&[f64; D]; 3], q: &[f64; D]) -> Sign {
        (self.side_of_sphere)(simplex, q)
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; D]], q: &[f64; D]) -> Sign {
        (self.in_flat)(simplex, q)
    }
}

impl<const D: usize> Coordinates<3> for Chosen<D> {
    type Coordinates = [f64; 2];

    fn coordinates(&self, p: &[f64; D]) -> [f64; 2] {
        plan(p)
    }

    fn exact_plan(&self, p: &[f64; D]) -> Option<[f64; 2]> {
        (self.exact_plan)(p)
    }
}

impl Crossing for Chosen<2> {
    fn plan(&self, p: &[f64; 2]) -> [f64; 2] {
        *p
    }

    fn step(&self) -> f64 {
        self.step
    }

    fn meet(&self, site: [f64; 2], _: &[[&[f64; 2]; 2]]) -> [f64; 2] {
        site
    }
}

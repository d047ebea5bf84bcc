//! A reference to a geometry is a geometry, too, with the same predicates.

use std::cmp::Ordering;

use crate::num::Sign;

use super::Geometry;

impl<G: Geometry<N>, const N: usize> Geometry<N> for &G {
    type Point = G::Point;

    #[inline]
    fn admits(&self, p: &G::Point) -> bool {
        (**self).admits(p)
    }

    #[inline]
    fn is_finite(&self, p: &G::Point) -> bool {
        (**self).is_finite(p)
    }

    #[inline]
    fn compare(&self, p: &G::Point, q: &G::Point) -> Ordering {
        (**self).compare(p, q)
    }

    #[inline]
    fn orientation(&self, simplex: [&G::Point; N]) -> Sign {
        (**self).orientation(simplex)
    }

    #[inline]
    fn side_of_sphere(&self, simplex: [&G::Point; N], q: &G::Point) -> Sign {
        (**self).side_of_sphere(simplex, q)
    }

    #[inline]
    fn rough_distance(&self, p: &G::Point, q: &G::Point) -> Option<f64> {
        (**self).rough_distance(p, q)
    }

    #[inline]
    fn rough_sides(&self, simplex: [&G::Point; N], q: &G::Point) -> Option<[f64; N]> {
        (**self).rough_sides(simplex, q)
    }

    #[inline]
    fn sides_error(&self, simplex: [&G::Point; N], q: &G::Point) -> f64 {
        (**self).sides_error(simplex, q)
    }

    #[inline]
    fn rough_lift(&self, p: &G::Point, origin: &G::Point) -> Option<[f64; 4]> {
        (**self).rough_lift(p, origin)
    }

    #[inline]
    fn point_hash(&self, p: &G::Point) -> Option<u64> {
        (**self).point_hash(p)
    }

    #[inline]
    fn orientation_in_flat(&self, simplex: &[&G::Point]) -> Sign {
        (**self).orientation_in_flat(simplex)
    }

    #[inline]
    fn side_of_sphere_in_flat(&self, simplex: &[&G::Point], q: &G::Point) -> Sign {
        (**self).side_of_sphere_in_flat(simplex, q)
    }
}

use std::cmp::Ordering;
use std::marker::PhantomData;

use super::space::projection;
use super::weighted::power_on_line;
use super::{Coordinates, Geometry, Space, hash, lexicographic};
use crate::kernel::{Adaptive, Kernel, PowerInPlane, PowerTest3};
use crate::num::Sign;

/// The geometry of points in space with a weight: `[x, y, z, weight]`, the weight in the square of
/// the unit of the coordinates.
///
/// Like [`Weighted`](super::Weighted), one dimension up: a point stands for a sphere of squared
/// radius `weight`, orientation and order are those of [`Space`], and a point is *inside* of the
/// sphere of a simplex if its [lift](PowerTest3) is below the hyperplane through the lifts of the
/// corners.
#[derive(Debug, Clone, Copy, Default)]
pub struct WeightedSpace<K = Adaptive>(PhantomData<K>);

impl WeightedSpace {
    /// Returns the geometry with the kernel [`Adaptive`]. For another kernel, use
    /// `WeightedSpace::<K>::default()`.
    pub fn new() -> Self {
        WeightedSpace::default()
    }
}

impl<K: Kernel> WeightedSpace<K> {
    /// Compares the weights of two points: of those at one site, the greater is in the regular
    /// triangulation.
    #[inline]
    pub fn compare_weights(&self, p: &[f64; 4], q: &[f64; 4]) -> Ordering {
        lexicographic([p[3]], [q[3]])
    }

    /// The geometry of the sites.
    fn space(&self) -> Space<K> {
        Space::default()
    }
}

#[inline(always)]
fn site(p: &[f64; 4]) -> [f64; 3] {
    [p[0], p[1], p[2]]
}

impl<K: Kernel> Geometry<4> for WeightedSpace<K> {
    type Point = [f64; 4];

    /// Returns true if the coordinates and the weight are admitted.
    #[inline]
    fn admits(&self, p: &[f64; 4]) -> bool {
        p.iter().all(|&x| K::RANGE.admits(x))
    }

    #[inline]
    fn is_finite(&self, p: &[f64; 4]) -> bool {
        p.iter().all(|x| x.is_finite())
    }

    #[inline(always)]
    fn compare(&self, p: &[f64; 4], q: &[f64; 4]) -> Ordering {
        lexicographic(site(p), site(q))
    }

    #[inline]
    fn rough_distance(&self, p: &[f64; 4], q: &[f64; 4]) -> Option<f64> {
        self.space().rough_distance(&site(p), &site(q))
    }

    #[inline(always)]
    fn rough_sides(&self, [a, b, c, d]: [&[f64; 4]; 4], q: &[f64; 4]) -> Option<[f64; 4]> {
        let sites = [&site(a), &site(b), &site(c), &site(d)];
        self.space().rough_sides(sites, &site(q))
    }

    #[inline(always)]
    fn sides_error(&self, [a, b, c, d]: [&[f64; 4]; 4], q: &[f64; 4]) -> f64 {
        let sites = [&site(a), &site(b), &site(c), &site(d)];
        self.space().sides_error(sites, &site(q))
    }

    #[inline]
    fn rough_lift(&self, p: &[f64; 4], origin: &[f64; 4]) -> Option<[f64; 4]> {
        let lift = self.space().rough_lift(&site(p), &site(origin));
        lift.map(|[x, y, z, square]| [x, y, z, square - p[3]])
    }

    #[inline]
    fn point_hash(&self, p: &[f64; 4]) -> Option<u64> {
        Some(hash(*p))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 4]; 4]) -> Sign {
        self.space().orientation(simplex.map(site).each_ref())
    }

    #[inline(always)]
    fn side_of_sphere(&self, [a, b, c, d]: [&[f64; 4]; 4], q: &[f64; 4]) -> Sign {
        K::sign(&PowerTest3([*a, *b, *c, *d, *q]))
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 4]]) -> Sign {
        match *simplex {
            [p, q] => self.compare(q, p).into(),
            [a, b, c] => self
                .space()
                .orientation_in_flat(&[a, b, c].map(site).each_ref()),
            _ => Sign::Zero,
        }
    }

    /// For two or three points, positive if the lift of `q`, anywhere on the line or in the plane
    /// through them, is below the flat through their lifts. For one, positive if `q`, on the same
    /// site, is heavier.
    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 4]], q: &[f64; 4]) -> Sign {
        match *simplex {
            [a] => self.compare_weights(q, a).into(),
            [a, b] => power_on_line::<K, 4>(*a, *b, *q),
            [a, b, c] => {
                projection::<K>([a, b, c].map(site)).map_or(Sign::Negative, |(axes, turn)| {
                    turn * K::sign(&PowerInPlane {
                        points: [*a, *b, *c, *q],
                        axes,
                    })
                })
            }
            _ => Sign::Negative,
        }
    }
}

impl<K: Kernel> Coordinates<4> for WeightedSpace<K> {
    type Coordinates = [f64; 3];

    #[inline]
    fn coordinates(&self, p: &[f64; 4]) -> [f64; 3] {
        site(p)
    }

    #[inline(always)]
    fn exact_site(&self, p: &[f64; 4]) -> Option<[f64; 4]> {
        K::RANGE.filtered(site(p)).map(|[x, y, z]| [x, y, z, p[3]])
    }
}

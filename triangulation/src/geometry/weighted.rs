use std::cmp::Ordering;
use std::marker::PhantomData;

use super::{
    Coordinates, Geometry, areas_error, hash, lexicographic, manhattan, plan, rough_areas,
};
use crate::kernel::{Adaptive, Kernel, Orientation2, PowerOnLine, PowerTest2};
use crate::num::Sign;

/// The geometry of points in the plane with a weight: `[x, y, weight]`, the weight in the square of
/// the unit of x and y.
///
/// A point stands for a circle of squared radius `weight`. Weights may be negative: only their
/// differences count. Orientation and order are those of the plane; points with equal x and y are
/// one site. The circumscribed circle of a simplex is replaced by the circle that is orthogonal to
/// those of its corners: a point is *inside* if its [lift](PowerTest2) is below the plane through
/// the lifts of the corners.
///
/// For regular triangulations, in which a point may be hidden by others.
/// [`Delaunay`](crate::Delaunay) triangulations have no hidden points: with unequal
/// weights their law is broken.
#[derive(Debug, Clone, Copy, Default)]
pub struct Weighted<K = Adaptive>(PhantomData<K>);

impl Weighted {
    /// Returns the geometry with the kernel [`Adaptive`]. For another kernel, use
    /// `Weighted::<K>::default()`.
    pub fn new() -> Self {
        Weighted::default()
    }
}

impl<K> Weighted<K> {
    /// Compares the weights of two points: of those at one site, the greater is in the regular
    /// triangulation.
    #[inline]
    pub fn compare_weights(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        lexicographic([p[2]], [q[2]])
    }
}

impl<K: Kernel> Geometry<3> for Weighted<K> {
    type Point = [f64; 3];

    /// Returns true if the coordinates and the weight are admitted.
    #[inline]
    fn admits(&self, p: &[f64; 3]) -> bool {
        p.iter().all(|&x| K::RANGE.admits(x))
    }

    #[inline]
    fn is_finite(&self, p: &[f64; 3]) -> bool {
        p.iter().all(|x| x.is_finite())
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

    #[inline]
    fn point_hash(&self, p: &[f64; 3]) -> Option<u64> {
        Some(hash(*p))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 3]; 3]) -> Sign {
        K::sign(&Orientation2(simplex.map(plan)))
    }

    #[inline(always)]
    fn side_of_sphere(&self, [a, b, c]: [&[f64; 3]; 3], q: &[f64; 3]) -> Sign {
        K::sign(&PowerTest2([*a, *b, *c, *q]))
    }

    /// For two points, positive if the lift of `q`, anywhere on the line through them, is below the
    /// line through their lifts. For one, positive if `q`, on the same site, is heavier.
    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
        match *simplex {
            [a] => self.compare_weights(q, a).into(),
            [a, b] => power_on_line::<K, 3>(*a, *b, *q),
            _ => Sign::Negative,
        }
    }
}

/// Returns a positive sign if the lift of `q`, a weighted point on the line through `a` and `b`, is
/// below the line through their lifts; zero if on it. Negative if `a` and `b` are one site. The
/// last of the `D` coordinates is the weight.
pub(super) fn power_on_line<K: Kernel, const D: usize>(
    a: [f64; D],
    b: [f64; D],
    q: [f64; D],
) -> Sign {
    let Some(along) = (0..D - 1).find(|&axis| a[axis] != b[axis]) else {
        return Sign::Negative;
    };
    let (a, b) = if a[along] < b[along] { (a, b) } else { (b, a) };
    K::sign(&PowerOnLine {
        points: [a, b, q],
        along,
    })
}

/// Coordinates for sorting and positions. There is no [`exact_plan`](Coordinates::exact_plan),
/// because the in-circle test is not that of the plane.
impl<K: Kernel> Coordinates<3> for Weighted<K> {
    type Coordinates = [f64; 2];

    #[inline]
    fn coordinates(&self, p: &[f64; 3]) -> [f64; 2] {
        plan(p)
    }
}

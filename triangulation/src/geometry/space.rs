use std::cmp::Ordering;
use std::marker::PhantomData;

use super::{Coordinates, Geometry, are_ordinary, lexicographic, manhattan};
use crate::kernel::{
    Adaptive, InCircleOfPlane, InSphere, Kernel, Orientation2, Orientation3, Predicate,
    facet_volumes, largest_minus,
};
use crate::num::{Bounded, Sign};

/// The geometry of points in space, `[x, y, z]`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Space<K = Adaptive>(PhantomData<K>);

impl Space {
    /// Returns the geometry with the kernel [`Adaptive`]. For another kernel, use
    /// `Space::<K>::default()`.
    pub fn new() -> Self {
        Space::default()
    }
}

/// Returns the first projection along an axis in which three points have an area, and its sign. For
/// all triangles of one plane, it is the same projection.
pub(super) fn projection<K: Kernel>(triangle: [[f64; 3]; 3]) -> Option<([usize; 2], Sign)> {
    [[0, 1], [1, 2], [2, 0]].into_iter().find_map(|axes| {
        let sign = K::sign(&Orientation2(triangle.map(|p| axes.map(|axis| p[axis]))));
        (sign != Sign::Zero).then_some((axes, sign))
    })
}

impl<K: Kernel> Geometry<4> for Space<K> {
    type Point = [f64; 3];

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
        lexicographic(*p, *q)
    }

    #[inline]
    fn rough_distance(&self, p: &[f64; 3], q: &[f64; 3]) -> Option<f64> {
        Some(manhattan(*p, *q))
    }

    #[inline(always)]
    fn rough_sides(&self, [a, b, c, d]: [&[f64; 3]; 4], q: &[f64; 3]) -> Option<[f64; 4]> {
        Some(facet_volumes([*a, *b, *c, *d], *q))
    }

    #[inline(always)]
    fn sides_error(&self, [a, b, c, d]: [&[f64; 3]; 4], q: &[f64; 3]) -> f64 {
        // All differences are those from `q`.
        let far = largest_minus([*a, *b, *c, *d], *q);
        if are_ordinary(far) {
            let volume = Orientation3([far, far, far, [0.0; 3]]);
            volume.value(Bounded::difference).error()
        } else {
            f64::INFINITY
        }
    }

    #[inline]
    fn rough_lift(&self, p: &[f64; 3], origin: &[f64; 3]) -> Option<[f64; 4]> {
        let [x, y, z] = [0, 1, 2].map(|axis| p[axis] - origin[axis]);
        Some([x, y, z, x * x + y * y + z * z])
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 3]; 4]) -> Sign {
        K::sign(&Orientation3(simplex.map(|p| *p)))
    }

    #[inline(always)]
    fn side_of_sphere(&self, [a, b, c, d]: [&[f64; 3]; 4], q: &[f64; 3]) -> Sign {
        K::sign(&InSphere([*a, *b, *c, *d, *q]))
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 3]]) -> Sign {
        match *simplex {
            [p, q] => self.compare(q, p).into(),
            [a, b, c] => projection::<K>([*a, *b, *c]).map_or(Sign::Zero, |(_, sign)| sign),
            _ => Sign::Zero,
        }
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
        match *simplex {
            [_] => Sign::Zero,
            [a, b] => Sign::from(self.compare(q, a)) * Sign::from(self.compare(b, q)),
            [a, b, c] => projection::<K>([*a, *b, *c]).map_or(Sign::Negative, |(axes, turn)| {
                turn * K::sign(&InCircleOfPlane {
                    points: [*a, *b, *c, *q],
                    axes,
                })
            }),
            _ => Sign::Negative,
        }
    }
}

impl<K: Kernel> Coordinates<4> for Space<K> {
    type Coordinates = [f64; 3];

    #[inline]
    fn coordinates(&self, p: &[f64; 3]) -> [f64; 3] {
        *p
    }

    #[inline(always)]
    fn exact_site(&self, p: &[f64; 3]) -> Option<[f64; 4]> {
        K::RANGE.filtered(*p).map(|[x, y, z]| [x, y, z, 0.0])
    }
}

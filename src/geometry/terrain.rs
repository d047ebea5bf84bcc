use std::cmp::Ordering;
use std::marker::PhantomData;

use super::crossed::Crossed;
use super::{Coordinates, Crossing, Geometry, lexicographic};
use crate::kernel::{Adaptive, InCircle, Kernel, Orientation2};
use crate::num::Sign;

/// Points in space, seen in plan: all questions are answered on x and y, the height is carried along.
///
/// Two heights over one footprint are one site. Where breaklines cross, each has a height of its own:
/// the vertex there takes the lower one, like [the rule for points](crate::terrain::DuplicateRule).
#[derive(Debug, Clone, Copy, Default)]
pub struct Terrain<K = Adaptive>(PhantomData<K>);

#[inline(always)]
fn plan(p: &[f64; 3]) -> [f64; 2] {
    [p[0], p[1]]
}

impl<K: Kernel> Geometry<3> for Terrain<K> {
    type Point = [f64; 3];

    #[inline]
    fn admits(&self, p: &[f64; 3]) -> bool {
        K::RANGE.admits(p[0]) && K::RANGE.admits(p[1])
    }

    #[inline(always)]
    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        lexicographic(plan(p), plan(q))
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
}

impl<K: Kernel> Crossing for Terrain<K> {
    fn crossing(&self, ab: [&[f64; 3]; 2], cd: [&[f64; 3]; 2]) -> [f64; 3] {
        let crossed = Crossed::new(ab, cd, plan);
        let [x, y] = crossed.place::<K>(plan);
        let height = |[p, q]: [&[f64; 3]; 2], along: f64| p[2] + along * (q[2] - p[2]);
        let z = height(crossed.ab, crossed.along_ab).min(height(crossed.cd, crossed.along_cd));
        [x, y, z]
    }
}

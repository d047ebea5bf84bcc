use super::Predicate;
use super::formula::minus;
use crate::num::Number;

/// Of the angle between the ways from a vertex to two points: positive if it is acute, zero if it is right (or a
/// point is the vertex), negative if it is obtuse. The vertex comes first.
#[derive(Debug, Clone, Copy)]
pub struct AngleAt(pub [[f64; 2]; 3]);

impl Predicate for AngleAt {
    const DEGREE: i32 = 2;
    const AXES: usize = 2;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [vertex, p, q] = self.0;
        let [[a, b], [c, d]] = [p, q].map(|to| minus(to, vertex, difference));
        a * c + b * d
    }
}

use rayon::prelude::*;

/// The number of points, vertices or faces that a thread takes at a time in a pass over all.
pub(crate) const AT_ONCE: usize = 1 << 14;

/// An axis-aligned box in space, or in plan if only `x` and `y` are used.
///
/// The default is empty (`min > max`), so that [`add`](Self::add) and [`merge`](Self::merge) can
/// start from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest x, y and z.
    pub min: [f64; 3],
    /// Largest x, y and z.
    pub max: [f64; 3],
}

impl Default for Bounds {
    fn default() -> Self {
        Bounds {
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        }
    }
}

impl Bounds {
    /// Returns the box around points.
    ///
    /// # Complexity
    /// Linear, on all threads.
    pub fn around(points: &[[f64; 3]]) -> Self {
        let of_some = |points: &[[f64; 3]]| {
            let mut bounds = Bounds::default();
            points.iter().for_each(|&p| bounds.add(p));
            bounds
        };
        let join = |mut bounds: Bounds, other: Bounds| {
            bounds.merge(&other);
            bounds
        };
        points
            .par_chunks(AT_ONCE)
            .map(of_some)
            .reduce(Bounds::default, join)
    }

    /// Grows the box to contain `p`. A NaN coordinate changes nothing.
    pub fn add(&mut self, p: [f64; 3]) {
        for ((min, max), value) in self.min.iter_mut().zip(&mut self.max).zip(p) {
            *min = min.min(value);
            *max = max.max(value);
        }
    }

    /// Grows the box to contain `other`. An empty box changes nothing.
    pub fn merge(&mut self, other: &Bounds) {
        for axis in 0..3 {
            self.min[axis] = self.min[axis].min(other.min[axis]);
            self.max[axis] = self.max[axis].max(other.max[axis]);
        }
    }

    /// Returns the largest amount of a coordinate on an axis; infinity if the box is empty.
    pub(crate) fn largest(&self, axis: usize) -> f64 {
        self.min[axis].abs().max(self.max[axis].abs())
    }

    /// Returns true if the box contains no position in plan.
    pub fn is_empty(&self) -> bool {
        !(self.min[0] <= self.max[0] && self.min[1] <= self.max[1])
    }

    /// Returns true if `(x, y)` lies in the box or on its border.
    pub fn holds(&self, x: f64, y: f64) -> bool {
        self.min[0] <= x && x <= self.max[0] && self.min[1] <= y && y <= self.max[1]
    }
}

/// Returns the lower of two numbers; `b` if one of them is NaN.
///
/// `PERF:` one instruction. [`f64::min`], which returns the number that is not NaN, takes four.
#[inline(always)]
pub(crate) fn lower(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns the higher of two numbers; `b` if one of them is NaN. See [`lower`].
#[inline(always)]
pub(crate) fn higher(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Returns the lowest and the highest of three numbers that are not NaN.
#[inline(always)]
pub(crate) fn lowest_and_highest([a, b, c]: [f64; 3]) -> [f64; 2] {
    [lower(lower(a, b), c), higher(higher(a, b), c)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_added_by_an_empty_box_or_a_nan() {
        let mut bounds = Bounds::default();
        bounds.merge(&Bounds::default());
        assert!(bounds.is_empty());
        bounds.add([1.0, 2.0, f64::NAN]);
        bounds.add([3.0, -2.0, 5.0]);
        let whole = bounds;
        bounds.merge(&Bounds::default());
        assert_eq!(bounds, whole);
        assert_eq!(
            bounds,
            Bounds {
                min: [1.0, -2.0, 5.0],
                max: [3.0, 2.0, 5.0]
            }
        );
        let mut empty = Bounds::default();
        empty.merge(&whole);
        assert_eq!(empty, whole);
    }
}

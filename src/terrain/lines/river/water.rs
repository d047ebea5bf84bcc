//! The height of a river at any position.

use super::{River, contains, flat};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::linear::linear;
use crate::terrain::nearest::{nearest_part, squared_distance};

/// The surface of a river, prepared for queries.
#[derive(Debug)]
pub(in crate::terrain) struct RiverWater<'a> {
    river: &'a River,
    stretches: Boxes<Stretch>,
}

/// What lies between two level lines, with the number of the first.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    number: usize,
    extent: Extent,
}

impl Boxed for Stretch {
    fn extent(&self) -> Extent {
        self.extent
    }
}

impl<'a> RiverWater<'a> {
    /// # Complexity
    /// O(n log n) for n level lines.
    pub(in crate::terrain) fn new(river: &'a River) -> Self {
        let boxed =
            |number: usize| Stretch { number, extent: Extent::of(river.triangles(number).into_iter().flatten()) };
        RiverWater { river, stretches: Boxes::new((0..river.stretch_count()).map(boxed).collect()) }
    }

    /// The height of the water at a position, the lowest if the river overlaps itself there;
    /// outside of it, that at the nearest position of the nearest stretch, since rounding moves
    /// vertices of banks out of the water.
    ///
    /// # Complexity
    /// O(log n) for n level lines, if few of them are close.
    pub(in crate::terrain) fn height(&self, q: [f64; 2]) -> f64 {
        self.height_within(q).unwrap_or_else(|| self.nearest_height(q))
    }

    /// The height of the water at a position, the lowest if the river overlaps itself there; `None`
    /// outside of it.
    pub(in crate::terrain) fn height_within(&self, q: [f64; 2]) -> Option<f64> {
        let mut lowest = f64::INFINITY;
        self.stretches.find(q, |stretch| {
            for corners in self.river.triangles(stretch.number).into_iter().filter(|corners| contains(*corners, q)) {
                lowest = lowest.min(linear(corners, q));
            }
            None::<()>
        });
        lowest.is_finite().then_some(lowest)
    }

    /// The height at the nearest position; of several, the lowest.
    fn nearest_height(&self, q: [f64; 2]) -> f64 {
        let mut nearest = (f64::INFINITY, f64::NAN);
        self.stretches.around(q, &mut Vec::new(), |stretch| {
            for [a, b, c] in self.river.triangles(stretch.number) {
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    let found = (squared_distance([flat(from), flat(to)], q), height_near([from, to], q));
                    if found < nearest || nearest.1.is_nan() {
                        nearest = found;
                    }
                }
            }
            nearest.0
        });
        nearest.1
    }
}

/// The height of a segment where it is nearest to a position: never beyond those of its ends.
fn height_near([from, to]: [[f64; 3]; 2], q: [f64; 2]) -> f64 {
    let height = from[2] + nearest_part([flat(from), flat(to)], q) * (to[2] - from[2]);
    height.clamp(from[2].min(to[2]), from[2].max(to[2]))
}

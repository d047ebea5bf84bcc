//! The height of a river at any position.

use super::{River, contains, flat};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::linear::linear;
use crate::terrain::nearest::squared_distance;

/// The surface of a river, prepared for queries.
#[derive(Debug)]
pub(in crate::terrain) struct RiverWater<'a> {
    river: &'a River,
    /// The stretches between level lines, by the number of the first.
    stretches: Boxes<Stretch>,
    level_lines: Boxes<Stretch>,
}

/// What lies between two level lines, or on one, with its number.
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
        let boxes = |lines: usize| {
            let all = river.stations.windows(lines).enumerate();
            let boxed = |(number, ends): (usize, &[[[f64; 3]; 2]])| Stretch {
                number,
                extent: Extent::of(ends.iter().flatten().copied()),
            };
            Boxes::new(all.map(boxed).collect())
        };
        RiverWater { river, stretches: boxes(2), level_lines: boxes(1) }
    }

    /// The height of the water at a position, the lowest if the river overlaps itself there;
    /// outside of it, that of the nearest level line.
    ///
    /// # Complexity
    /// O(log n) for n level lines, if few of them are close.
    pub(in crate::terrain) fn height(&self, q: [f64; 2]) -> f64 {
        let stations = &self.river.stations;
        let mut lowest = f64::INFINITY;
        self.stretches.find(q, |stretch| {
            let [[a, b], [c, d]] = [stations[stretch.number], stations[stretch.number + 1]];
            for corners in [[a, b, c], [b, d, c]] {
                if contains(corners, q) {
                    lowest = lowest.min(linear(corners, q));
                }
            }
            None::<()>
        });
        if lowest.is_finite() {
            return lowest;
        }
        let mut nearest = (f64::INFINITY, 0);
        self.level_lines.around(q, &mut Vec::new(), |line| {
            let found = (squared_distance(stations[line.number].map(flat), q), line.number);
            if found < nearest {
                nearest = found;
            }
            nearest.0
        });
        stations.get(nearest.1).map_or(f64::NAN, |ends| ends[0][2])
    }
}

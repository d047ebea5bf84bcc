//! The height of a river at any position.

use super::River;
use super::segments::contains;
use super::sites::flat;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::linear::linear;
use crate::terrain::nearest::{nearest_part, part_before, squared_distance};

/// The surface of a river, prepared for queries.
#[derive(Debug)]
pub(crate) struct RiverWater(Boxes<Part>);

/// A triangle on which the height is linear.
#[derive(Debug, Clone, Copy)]
struct Part([[f64; 3]; 3]);

impl Boxed for Part {
    fn extent(&self) -> Extent {
        Extent::of(self.0)
    }
}

impl Part {
    fn sides(&self) -> [[[f64; 3]; 2]; 3] {
        let [a, b, c] = self.0;
        [[a, b], [b, c], [c, a]]
    }
}

impl RiverWater {
    /// # Complexity
    /// O(n log n) for n level lines.
    pub(crate) fn new(river: &River) -> Self {
        RiverWater(Boxes::new(
            (0..river.stretch_count())
                .flat_map(|k| river.triangles(k))
                .map(Part)
                .collect(),
        ))
    }

    /// The height of the water at a position, the lowest if the river overlaps itself there;
    /// outside of it, that at the nearest position of the nearest stretch, since rounding moves
    /// vertices of banks out of the water.
    ///
    /// # Complexity
    /// O(log n) for n level lines, if few of them are close.
    pub(crate) fn height(&self, q: [f64; 2]) -> f64 {
        self.height_within(q)
            .unwrap_or_else(|| self.nearest_height(q))
    }

    /// The height of the water at a position, the lowest if the river overlaps itself there; `None`
    /// outside of it.
    pub(crate) fn height_within(&self, q: [f64; 2]) -> Option<f64> {
        let mut lowest = f64::INFINITY;
        self.0.find(q, |Part(corners)| {
            if contains(*corners, q) {
                lowest = lowest.min(linear(*corners, q));
            }
            None::<()>
        });
        lowest.is_finite().then_some(lowest)
    }

    /// Returns true if a position is in the water or no farther from it than a distance.
    pub(crate) fn is_near(&self, q: [f64; 2], distance: f64) -> bool {
        self.nearest(q).0 <= distance * distance || self.height_within(q).is_some()
    }

    /// The height at the nearest position of the borders of triangles; of several, the lowest.
    fn nearest_height(&self, q: [f64; 2]) -> f64 {
        self.nearest(q).1
    }

    /// The square of the distance to the nearest position of the borders of triangles, and the
    /// height there.
    fn nearest(&self, q: [f64; 2]) -> (f64, f64) {
        let mut nearest = (f64::INFINITY, f64::INFINITY);
        self.0.around(q, &mut Vec::new(), |part| {
            for side in part.sides() {
                let found = (squared_distance(side.map(flat), q), height_near(side, q));
                if found < nearest {
                    nearest = found;
                }
            }
            nearest.0
        });
        nearest
    }

    /// The parts of a segment, from 0 to 1, between which the height along it is linear. Triangles
    /// count if they are no farther from it than a distance.
    pub(crate) fn parts_of(&self, segment: [[f64; 2]; 2], distance: f64) -> Vec<f64> {
        let mut parts = Vec::new();
        self.0
            .find_in(Extent::of_plan(segment).grown(distance), |part| {
                parts.extend(
                    part.sides()
                        .map(|side| part_before(segment, side.map(flat))),
                );
                None::<()>
            });
        parts.retain(|part| *part > 0.0 && *part < 1.0);
        parts
    }
}

/// The height of a segment where it is nearest to a position: never beyond those of its ends.
pub(crate) fn height_near([from, to]: [[f64; 3]; 2], q: [f64; 2]) -> f64 {
    let height = from[2] + nearest_part([flat(from), flat(to)], q) * (to[2] - from[2]);
    height.clamp(from[2].min(to[2]), from[2].max(to[2]))
}

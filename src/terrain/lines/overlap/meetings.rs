//! Which waters overlap, and where.

use std::collections::BTreeSet;

use super::Zone;
use crate::data::orientation;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::lines::areas::{Level, Water};
use crate::terrain::lines::river::contains;
use crate::triangulation::num::Sign;

/// A triangle of a river.
#[derive(Debug, Clone, Copy)]
struct Part {
    water: usize,
    stretch: usize,
    corners: [[f64; 3]; 3],
}

impl Boxed for Part {
    fn extent(&self) -> Extent {
        Extent::of(self.corners)
    }
}

/// The waters that overlap, by their numbers.
#[derive(Debug)]
pub(super) struct Meetings {
    /// Pairs of a water whose height may count at the border of an overlap, and a river that may go
    /// on outside.
    pub(super) pairs: BTreeSet<[usize; 2]>,
    /// The stretches of rivers that take part: river, stretch.
    pub(super) stretches: BTreeSet<[usize; 2]>,
    taking_part: BTreeSet<usize>,
    /// The triangles of all rivers.
    parts: Boxes<Part>,
}

impl Meetings {
    /// # Complexity
    /// O(n log n) for n level lines and vertices of shores, if few stretches are close to each
    /// other.
    pub(super) fn find(waters: &[Water]) -> Self {
        let mut all: Vec<Part> = Vec::new();
        for (water, Water { level, .. }) in waters.iter().enumerate() {
            let Level::River(river) = level else { continue };
            for stretch in 0..river.stretch_count() {
                all.extend(river.triangles(stretch).into_iter().map(|corners| Part { water, stretch, corners }));
            }
        }
        let parts = Boxes::new(all.clone());
        let (mut pairs, mut stretches) = (BTreeSet::new(), BTreeSet::new());
        for part in &all {
            parts.find_in(part.extent(), |other| {
                if other.water > part.water && overlap(&part.corners, &other.corners) {
                    pairs.extend([[part.water, other.water], [other.water, part.water]]);
                    stretches.extend([[part.water, part.stretch], [other.water, other.stretch]]);
                }
                None::<()>
            });
        }
        for (water, Water { level, .. }) in waters.iter().enumerate() {
            let Level::Flat(lake) = level else { continue };
            for side in lake.rings.iter().flat_map(|ring| ring.windows(2)).map(|pair| [pair[0], pair[1]]) {
                parts.find_in(Extent::of(side), |part| {
                    if passes(side, &part.corners) {
                        pairs.insert([water, part.water]);
                        stretches.insert([part.water, part.stretch]);
                    }
                    None::<()>
                });
            }
        }
        let taking_part = pairs.iter().flatten().copied().collect();
        Meetings { pairs, stretches, taking_part, parts }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    pub(super) fn takes_part(&self, water: usize) -> bool {
        self.taking_part.contains(&water)
    }

    /// The rivers at a position, in order.
    pub(super) fn rivers_at(&self, q: [f64; 2]) -> Vec<usize> {
        let mut rivers = Vec::new();
        self.parts.find(q, |part| {
            if contains(part.corners, q) {
                rivers.push(part.water);
            }
            None::<()>
        });
        rivers.sort_unstable();
        rivers.dedup();
        rivers
    }

    /// The rivers that may go on outside of a water.
    pub(super) fn outside_of(&self, water: usize) -> Vec<usize> {
        self.pairs.range([water, 0]..[water + 1, 0]).map(|[_, outer]| *outer).collect()
    }

    /// The boxes around the stretches that take part, and a distance around them.
    pub(super) fn zones(&self, waters: &[Water], distance: f64) -> Boxes<Zone> {
        let mut zones = Vec::new();
        for &[water, stretch] in &self.stretches {
            if let Level::River(river) = &waters[water].level {
                zones.push(Zone(Extent::of(river.triangles(stretch).concat()).grown(distance)));
            }
        }
        Boxes::new(zones)
    }
}

/// Returns true if the insides of two triangles share a point.
fn overlap(p: &[[f64; 3]; 3], q: &[[f64; 3]; 3]) -> bool {
    let turns = [p, q].map(|corners| orientation(*corners));
    !turns.contains(&Sign::Zero) && !is_apart(p, turns[0], q) && !is_apart(q, turns[1], p)
}

/// Returns true if a segment passes through the inside of a triangle.
fn passes([u, v]: [[f64; 3]; 2], triangle: &[[f64; 3]; 3]) -> bool {
    let turn = orientation(*triangle);
    let sides = triangle.map(|corner| orientation([u, v, corner]));
    turn != Sign::Zero
        && sides.contains(&Sign::Positive)
        && sides.contains(&Sign::Negative)
        && !is_apart(triangle, turn, &[u, v])
}

/// Returns true if all points lie beyond one side of a triangle, or on it.
fn is_apart(triangle: &[[f64; 3]; 3], turn: Sign, points: &[[f64; 3]]) -> bool {
    let [a, b, c] = *triangle;
    [[a, b], [b, c], [c, a]]
        .iter()
        .any(|[from, to]| points.iter().all(|point| turn * orientation([*from, *to, *point]) != Sign::Positive))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_shares_area_overlaps() {
        let at = |corners: [[f64; 2]; 3]| corners.map(|[x, y]| [x, y, 0.0]);
        let p = at([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]);
        for (q, is_overlap) in [
            ([[1.0, 1.0], [9.0, 1.0], [9.0, 9.0]], true),
            ([[2.0, 2.0], [9.0, 1.0], [9.0, 9.0]], false),
            ([[4.0, 0.0], [0.0, 4.0], [4.0, 4.0]], false),
            ([[4.0, 0.0], [0.0, 4.0], [0.0, 3.0]], true),
            ([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]], true),
            ([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], false),
        ] {
            let q = at(q);
            let turned = [q[2], q[1], q[0]];
            assert_eq!([overlap(&p, &q), overlap(&turned, &p)], [is_overlap; 2], "{q:?}");
        }
        for ([u, v], is_through) in [
            ([[-1.0, 1.0], [9.0, 1.0]], true),
            ([[1.0, 1.0], [1.0, 2.0]], true),
            ([[0.0, 0.0], [9.0, 0.0]], false),
            ([[2.0, 2.0], [3.0, 3.0]], false),
            ([[0.0, 4.0], [5.0, 0.0]], false),
            ([[4.0, 0.0], [-1.0, 9.0]], false),
        ] {
            let [u, v] = [u, v].map(|[x, y]| [x, y, 0.0]);
            assert_eq!(passes([u, v], &p), is_through, "{u:?} {v:?}");
        }
    }
}

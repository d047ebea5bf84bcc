//! Which waters overlap or touch with different heights, and where.

use std::collections::BTreeSet;

use super::zone::{Zone, tolerance_of};
use crate::data::orientation;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::lines::areas::{Water, WaterLevel, rounding_of};
use crate::terrain::lines::river::{contains, height_near};
use crate::terrain::nearest::squared_distance;
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

/// The waters that overlap, or touch with different heights, by their numbers.
#[derive(Debug)]
pub(super) struct Meetings {
    /// Pairs of a water whose height may count at the border of an overlap, or where both touch,
    /// and a river that may go on outside.
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
            let WaterLevel::River(river) = level else {
                continue;
            };
            for stretch in 0..river.stretch_count() {
                all.extend(river.triangles(stretch).into_iter().map(|corners| Part {
                    water,
                    stretch,
                    corners,
                }));
            }
        }
        let parts = Boxes::new(all.clone());
        let corners = || all.iter().flat_map(|part| part.corners);
        let touching = Touching {
            rounding: rounding_of(corners()),
            tolerance: tolerance_of(corners()),
        };
        // Where a river goes on, it falls from the height of the one before to its own.
        let goes_on =
            |rivers: [usize; 2], at: [f64; 2]| match rivers.map(|number| &waters[number].level) {
                [WaterLevel::River(river), WaterLevel::River(other)] => {
                    river.goes_on_at(other, at, touching.rounding)
                }
                _ => false,
            };
        let (mut pairs, mut stretches) = (BTreeSet::new(), BTreeSet::new());
        for part in &all {
            parts.find_in(part.extent().grown(touching.rounding), |other| {
                let meet = || {
                    overlap(&part.corners, &other.corners)
                        || (touching.differences(&part.corners, &other.corners))
                            .any(|at| !goes_on([part.water, other.water], at))
                };
                if other.water > part.water && meet() {
                    pairs.extend([[part.water, other.water], [other.water, part.water]]);
                    stretches.extend([[part.water, part.stretch], [other.water, other.stretch]]);
                }
                None::<()>
            });
        }
        for (water, Water { level, .. }) in waters.iter().enumerate() {
            let WaterLevel::Flat(lake) = level else {
                continue;
            };
            for side in lake
                .rings
                .iter()
                .flat_map(|ring| ring.windows(2))
                .map(|pair| [pair[0], pair[1]])
            {
                parts.find_in(Extent::of(side).grown(touching.rounding), |part| {
                    if passes(side, &part.corners)
                        || touching.differences(&side, &part.corners).next().is_some()
                    {
                        pairs.insert([water, part.water]);
                        stretches.insert([part.water, part.stretch]);
                    }
                    None::<()>
                });
            }
        }
        let taking_part = pairs.iter().flatten().copied().collect();
        Meetings {
            pairs,
            stretches,
            taking_part,
            parts,
        }
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
        self.pairs
            .range([water, 0]..[water + 1, 0])
            .map(|[_, outer]| *outer)
            .collect()
    }

    /// The boxes around the stretches that take part, and a distance around them.
    pub(super) fn zones(&self, waters: &[Water], distance: f64) -> Boxes<Zone> {
        let mut zones = Vec::new();
        for &[water, stretch] in &self.stretches {
            if let WaterLevel::River(river) = &waters[water].level {
                zones.push(Zone(
                    Extent::of(river.triangles(stretch).concat()).grown(distance),
                ));
            }
        }
        Boxes::new(zones)
    }
}

/// What counts as touching, and as different heights.
#[derive(Debug, Clone, Copy)]
struct Touching {
    rounding: f64,
    tolerance: f64,
}

impl Touching {
    /// The corners of two convex polygons that lie on the border of the other one, but for
    /// rounding, and have another height there. Between corners heights are linear.
    fn differences<'a>(
        self,
        p: &'a [[f64; 3]],
        q: &'a [[f64; 3]],
    ) -> impl Iterator<Item = [f64; 2]> + 'a {
        [(p, q), (q, p)]
            .into_iter()
            .flat_map(move |(corners, other)| {
                corners
                    .iter()
                    .filter(move |corner| self.differs(**corner, other))
                    .map(|&[x, y, _]| [x, y])
            })
    }

    fn differs(self, [x, y, z]: [f64; 3], polygon: &[[f64; 3]]) -> bool {
        polygon
            .iter()
            .zip(polygon.iter().cycle().skip(1))
            .map(|(from, to)| [*from, *to])
            .any(|side| {
                let plan = side.map(|[x, y, _]| [x, y]);
                squared_distance(plan, [x, y]) <= self.rounding.powi(2)
                    && (z - height_near(side, [x, y])).abs() > self.tolerance
            })
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
    [[a, b], [b, c], [c, a]].iter().any(|[from, to]| {
        points
            .iter()
            .all(|point| turn * orientation([*from, *to, *point]) != Sign::Positive)
    })
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
            assert_eq!(
                [overlap(&p, &q), overlap(&turned, &p)],
                [is_overlap; 2],
                "{q:?}"
            );
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

//! The extents of files that were skipped. No triangle is drawn over them.

use serde_json::{Map, Value, json};

use super::Job;
use super::task_file::TaskFile;

/// The corners of a box in plan.
type Hole = [[f64; 2]; 2];

/// The name of the fact.
const HOLES: &str = "holes";

/// The extents of files that were skipped, as far as a task knows.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Holes(Vec<Hole>);

impl Holes {
    /// Adds the extent of a file that is skipped, as far as other files have no points there; not
    /// at all if one of them overlaps much of it.
    pub(super) fn add_file(&mut self, job: &Job, number: usize) {
        let files = &job.plan.files;
        let others = files.iter().enumerate().filter(|(at, _)| *at != number).map(|(_, other)| [other.min, other.max]);
        if let Some(hole) = without([files[number].min, files[number].max], others) {
            self.add(hole);
        }
    }

    /// Adds what another task knows.
    pub(super) fn add_known(&mut self, task: &TaskFile) {
        let known = task.facts.get(HOLES).and_then(|holes| serde_json::from_value::<Vec<Hole>>(holes.clone()).ok());
        known.into_iter().flatten().for_each(|hole| self.add(hole));
    }

    fn add(&mut self, hole: Hole) {
        if !self.0.contains(&hole) {
            self.0.push(hole);
        }
    }

    /// Writes down what the task knows.
    pub(super) fn note(&self, facts: &mut Map<String, Value>) {
        if !self.0.is_empty() {
            facts.insert(HOLES.to_owned(), json!(self.0));
        }
    }

    /// Returns true if a triangle reaches into one of the extents.
    pub(super) fn meet(&self, corners: [[f64; 3]; 3]) -> bool {
        self.0.iter().any(|hole| reaches_into(corners, *hole))
    }
}

/// The share of a box that another one may overlap on one axis, so that the rest is a hole.
const LITTLE: f64 = 0.01;

/// Returns a box without what others overlap of it at its sides; `None` if one of them overlaps
/// more.
fn without(hole: Hole, others: impl Iterator<Item = Hole>) -> Option<Hole> {
    let [mut min, mut max] = hole;
    let size = [0, 1].map(|k| hole[1][k] - hole[0][k]);
    for [low, high] in others {
        let common = [0, 1].map(|k: usize| f64::min(high[k], hole[1][k]) - f64::max(low[k], hole[0][k]));
        if common.iter().any(|length| *length < 0.0) {
            continue;
        }
        let k = usize::from(common[1] * size[0] < common[0] * size[1]);
        if common[k] > LITTLE * size[k] {
            return None;
        }
        if low[k] > hole[0][k] {
            max[k] = max[k].min(low[k]);
        } else {
            min[k] = min[k].max(high[k]);
        }
    }
    Some([min, max])
}

/// Returns true unless a side of the box, or an edge of the triangle, has the two on different
/// sides.
fn reaches_into(corners: [[f64; 3]; 3], [min, max]: Hole) -> bool {
    let is_beside = (0..2).any(|k| corners.iter().all(|p| p[k] <= min[k]) || corners.iter().all(|p| p[k] >= max[k]));
    if is_beside {
        return false;
    }
    let of_box = [min, [max[0], min[1]], max, [min[0], max[1]]];
    // The corners are counter-clockwise.
    let is_beyond = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        of_box.iter().all(|p| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) <= 0.0)
    };
    !(0..3).any(is_beyond)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn others_at_the_sides_make_a_hole_smaller() {
        let hole = [[0.0, 0.0], [100.0, 100.0]];
        let of = |others: &[Hole]| without(hole, others.iter().copied());
        assert_eq!(of(&[]), Some(hole));
        // Touching, and a hairline over it.
        assert_eq!(of(&[[[100.0, 0.0], [200.0, 100.0]], [[0.0, 100.0], [100.0, 200.0]]]), Some(hole));
        assert_eq!(of(&[[[99.5, 0.0], [200.0, 100.0]]]), Some([[0.0, 0.0], [99.5, 100.0]]));
        assert_eq!(of(&[[[-50.0, -9.0], [0.5, 50.0]]]), Some([[0.5, 0.0], [100.0, 100.0]]));
        // A flight line over it.
        assert_eq!(of(&[[[40.0, -50.0], [60.0, 200.0]]]), None);
        assert_eq!(of(&[[[-9.0, -9.0], [200.0, 200.0]]]), None);
    }

    #[test]
    fn triangles_beside_a_hole_do_not_reach_into_it() {
        let hole = [[2.0, 2.0], [4.0, 3.0]];
        for (corners, expected) in [
            ([[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]], true),
            ([[2.5, 2.1], [3.5, 2.1], [3.0, 2.9]], true),
            ([[0.0, 0.0], [2.0, 0.0], [2.0, 9.0]], false),
            ([[0.0, 0.0], [9.0, 0.0], [9.0, 2.0]], false),
            ([[0.0, 0.0], [3.0, 0.0], [0.0, 4.5]], false),
            ([[0.0, 9.0], [1.0, 2.5], [3.0, 2.5]], true),
            ([[4.0, 3.0], [9.0, 3.0], [9.0, 9.0]], false),
        ] {
            let corners: [[f64; 2]; 3] = corners;
            assert_eq!(reaches_into(corners.map(|[x, y]| [x, y, 0.0]), hole), expected, "{corners:?}");
        }
    }
}

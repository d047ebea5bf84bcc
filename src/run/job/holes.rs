//! The extents of files that were skipped. No triangle is drawn over them, also where other files
//! have points: what is missing there would be a surface that looks whole.

use super::Job;
use super::task_facts::{Hole, TaskFacts};

/// The extents of files that were skipped, as far as a task knows.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Holes(Vec<Hole>);

impl Holes {
    /// Adds the extent of a file that is skipped.
    pub(super) fn add_file(&mut self, job: &Job, number: usize) {
        let file = &job.plan.files[number];
        self.add([file.min, file.max]);
    }

    /// Adds what another task knows.
    pub(super) fn add_known(&mut self, facts: &TaskFacts) {
        facts.holes.iter().for_each(|hole| self.add(*hole));
    }

    fn add(&mut self, hole: Hole) {
        if !self.0.contains(&hole) {
            self.0.push(hole);
        }
    }

    /// Returns what the task knows.
    pub(super) fn known(&self) -> Vec<Hole> {
        self.0.clone()
    }

    /// Returns true if a triangle reaches into one of the extents.
    pub(super) fn meet(&self, corners: [[f64; 3]; 3]) -> bool {
        self.0.iter().any(|hole| reaches_into(corners, *hole))
    }
}

/// Returns true unless a side of the box, or an edge of the triangle, has the two on different
/// sides.
fn reaches_into(corners: [[f64; 3]; 3], [min, max]: Hole) -> bool {
    let is_beside = (0..2)
        .any(|k| corners.iter().all(|p| p[k] <= min[k]) || corners.iter().all(|p| p[k] >= max[k]));
    if is_beside {
        return false;
    }
    let of_box = [min, [max[0], min[1]], max, [min[0], max[1]]];
    // The corners are counter-clockwise.
    let is_beyond = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        of_box
            .iter()
            .all(|p| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) <= 0.0)
    };
    !(0..3).any(is_beyond)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(
                reaches_into(corners.map(|[x, y]| [x, y, 0.0]), hole),
                expected,
                "{corners:?}"
            );
        }
    }
}

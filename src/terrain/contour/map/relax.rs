//! Smooths lines inside the corridor.

use super::corridor::{Corridor, Spot};
use super::room::{Cell, Room};
use super::strand::{Strand, turns_back};
use crate::terrain::vertices_along;

/// How often each line is smoothed.
const ROUNDS: usize = 3;

/// The shares of the distance to its target that a point tries to move by.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// How far lines are smoothed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Relaxing {
    /// The half width of the mean along a line, where no end of a strand is nearer.
    pub(super) half_width: f64,
    /// The largest move of a point, in plan.
    pub(super) largest_move: f64,
}

/// Moves the points of strands toward means of their lines, as far as the lines then stay in the
/// corridor, cross nothing and do not turn back.
///
/// # Complexity
/// Quadratic in the points of the room in the worst case: each move is compared with all.
pub(super) fn relax(
    room: &mut Room,
    cell: &Cell,
    level: f64,
    corridor: &Corridor<'_>,
    by: Relaxing,
) {
    let first: Vec<Vec<[f64; 2]>> = room.strands.iter().map(|s| s.points.clone()).collect();
    for _ in 0..ROUNDS {
        let targets: Vec<Vec<[f64; 2]>> = room
            .strands
            .iter()
            .map(|strand| means(&strand.points, by.half_width))
            .collect();
        for strand in 0..room.strands.len() {
            for i in 1..room.strands[strand].points.len().saturating_sub(1) {
                let from = room.strands[strand].points[i];
                let target = targets[strand][i];
                let moved = PARTS.into_iter().find_map(|part| {
                    let to = [0, 1].map(|axis| from[axis] + part * (target[axis] - from[axis]));
                    let start = first[strand][i];
                    let shift = (to[0] - start[0]).hypot(to[1] - start[1]);
                    let is_near = shift <= by.largest_move && to != from;
                    if !is_near || !cell.has_inside(to) {
                        return None;
                    }
                    moved(room, [strand, i], to, level, corridor)
                });
                if let Some(Spot { point, at }) = moved {
                    let strand = &mut room.strands[strand];
                    (strand.points[i], strand.at[i]) = (point, at);
                }
            }
        }
    }
}

/// Returns where a point comes to that is moved, if it may be.
fn moved(
    room: &Room,
    [number, i]: [usize; 2],
    to: [f64; 2],
    level: f64,
    corridor: &Corridor<'_>,
) -> Option<Spot> {
    let strand = &room.strands[number];
    let [a, b, c] = [i - 1, i, i + 1].map(|k| strand.points[k]);
    let turns = || {
        let before = i.checked_sub(2).map(|k| [strand.points[k], a, to]);
        let after = strand.points.get(i + 2).map(|&next| [to, c, next]);
        let new = [Some([a, to, c]), before, after];
        new.into_iter().flatten().any(turns_back)
    };
    if turns() {
        return None;
    }
    let at = corridor.passes(strand.spot(i), to, level)?;
    let spot = Spot { point: to, at };
    // From the ends of the strand, as they are anchors where the face is known.
    for k in [i - 1, i + 1] {
        let is_end = k == 0 || k + 1 == strand.points.len();
        let passed = match is_end {
            true => corridor.passes(strand.spot(k), to, level),
            false => corridor.passes(spot, strand.points[k], level),
        };
        passed?;
    }
    let is_clear = room.is_empty([a, b, to], number, &[i - 1, i])
        && room.is_empty([c, b, to], number, &[i, i + 1])
        && room.is_free([number, i], [b, to]);
    is_clear.then_some(spot)
}

/// Returns the mean of a line around each of its points. It is of the segments within a distance
/// along the line, weighted, and the distance is at most that to the ends.
fn means(points: &[[f64; 2]], half_width: f64) -> Vec<[f64; 2]> {
    let along = vertices_along(points);
    let whole = along[along.len() - 1];
    let mean = |i: usize| {
        let own = points[i];
        let width = half_width.min(along[i]).min(whole - along[i]);
        let mut first = i;
        while first > 0 && along[i] - along[first] < width {
            first -= 1;
        }
        // Relative to the point, for precision.
        let (mut moment, mut total) = ([0.0; 2], 0.0);
        for k in first..points.len().saturating_sub(1) {
            if along[k] - along[i] >= width {
                break;
            }
            let distance = (0.5 * (along[k] + along[k + 1]) - along[i]) / width;
            let inner = 1.0 - distance * distance;
            if inner > 0.0 {
                let weight = (along[k + 1] - along[k]) * inner * inner;
                for axis in 0..2 {
                    let [from, to] = [k, k + 1].map(|k| points[k][axis] - own[axis]);
                    moment[axis] += weight * 0.5 * (from + to);
                }
                total += weight;
            }
        }
        if total > 0.0 {
            [0, 1].map(|axis| own[axis] + moment[axis] / total)
        } else {
            own
        }
    };
    (0..points.len()).map(mean).collect()
}

/// Returns true if a strand has points between its ends.
pub(super) fn has_inner(strand: &Strand) -> bool {
    strand.points.len() > 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_a_straight_line_are_on_it() {
        let line: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        for (mean, point) in means(&line, 4.0).iter().zip(&line) {
            assert!((mean[0] - point[0]).abs() < 1e-12 && (mean[1] - point[1]).abs() < 1e-12);
        }
        let jag = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [3.0, 0.0], [4.0, 0.0]];
        let mean = means(&jag, 2.0)[2];
        assert!(mean[0] == 2.0 && mean[1] < 0.75, "{mean:?}");
    }
}

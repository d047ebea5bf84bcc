//! Lines parallel to others.

use crate::terrain::linear::turn;
use crate::triangulation::num::Sign;

/// How much farther than the distance a corner may be, as a factor: sharper corners are cut off.
const LONGEST_MITER: f64 = 2.0;

/// The cosine of half a turn, below which the sum of normals says little about its direction.
const TURNS_BACK: f64 = 1e-6;

/// Returns a line parallel to one in plan, at a distance to its left (to its right if negative),
/// with a vertex for each of its vertices. A line that ends where it begins stays closed.
///
/// Corners are mitered. A line that turns back on itself turns left. Consecutive vertices must
/// differ in plan.
///
/// # Complexity
/// Linear.
pub(super) fn offset(line: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    offset_between(line, [None; 2], distance)
}

/// Like [`offset`], for a line that continues others: `neighbors` are the vertices before and after
/// it, to which its ends are mitered.
pub(super) fn offset_between(
    line: &[[f64; 2]],
    neighbors: [Option<[f64; 2]>; 2],
    distance: f64,
) -> Vec<[f64; 2]> {
    let is_closed = line.len() > 2 && line.first() == line.last();
    let [before, after] = if is_closed {
        [Some(line[line.len() - 2]), Some(line[1])]
    } else {
        neighbors
    };
    let at = |k: usize| {
        let from = k.checked_sub(1).map(|k| line[k]).or(before);
        let to = line.get(k + 1).copied().or(after);
        beside([from, to], line[k], distance)
    };
    (0..line.len()).filter_map(at).collect()
}

/// The vertex of a parallel line beside a vertex, by the vertices before and after it; `None` if
/// there are none.
fn beside([from, to]: [Option<[f64; 2]>; 2], vertex: [f64; 2], distance: f64) -> Option<[f64; 2]> {
    let (arriving, leaving) = (
        from.map(|from| normal([from, vertex])),
        to.map(|to| normal([vertex, to])),
    );
    let (before, after) = (arriving.or(leaving)?, leaving.or(arriving)?);
    let sum = [before[0] + after[0], before[1] + after[1]];
    // The miter is 1 / cos(half the turn), and the sum of the normals twice that cosine.
    let half_cosine = sum[0].hypot(sum[1]) / 2.0;
    let scale = distance / half_cosine.max(1.0 / LONGEST_MITER);
    let direction = match (from, to) {
        (Some(from), Some(to)) if half_cosine < TURNS_BACK => {
            // Along the line, beyond its tip on the outer side of the turn.
            let inward = [after[1] - before[1], before[0] - after[0]];
            let length = inward[0].hypot(inward[1]);
            let turn = turn(from, vertex, to);
            let sign = if turn == Sign::Negative { -1.0 } else { 1.0 };
            inward.map(|c| sign * c / length)
        }
        _ => sum.map(|c| c / (2.0 * half_cosine)),
    };
    Some([
        vertex[0] + scale * direction[0],
        vertex[1] + scale * direction[1],
    ])
}

/// Returns a parallel line without folds: where it runs against its line, as it does on the inside
/// of bends that are tighter than its distance, its vertices move to one point: where its straight
/// parts before and after the bend meet, or else their mean.
///
/// # Complexity
/// Linear.
pub(super) fn unfolded(parallel: &[[f64; 2]], line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    // Runs of vertices that become one, as pool adjacent violators: sums of both lines, and a
    // count.
    let mut runs: Vec<([[f64; 2]; 2], usize)> = Vec::new();
    for (&p, &q) in parallel.iter().zip(line) {
        let mut run = ([p, q], 1);
        while let Some((sums, count)) = runs.last()
            && !advances((sums, *count), (&run.0, run.1))
        {
            run = (
                [0, 1].map(|of| [0, 1].map(|axis| sums[of][axis] + run.0[of][axis])),
                count + run.1,
            );
            runs.pop();
        }
        runs.push(run);
    }
    let mut smooth: Vec<[f64; 2]> = Vec::with_capacity(parallel.len());
    for ([sum, _], count) in runs {
        let (first, next) = (smooth.len(), smooth.len() + count);
        let meet = || {
            let before = first.checked_sub(1)?;
            let [from, to] =
                [[before, first], [next - 1, next]].map(|ends| ends.map(|k| line.get(k)));
            let directions = [step(*from[0]?, *from[1]?), step(*to[0]?, *to[1]?)];
            meeting(parallel[before], parallel[next], directions)
        };
        let mean = sum.map(|c| c / count as f64);
        let point = if count > 1 {
            meet().unwrap_or(mean)
        } else {
            mean
        };
        smooth.extend(std::iter::repeat_n(point, count));
    }
    smooth
}

/// The least sine and cosine of the turn at which parts before and after a bend are extended: those
/// that are nearly parallel meet far away.
const LEAST_TURN: f64 = 0.1;
const LEAST_COSINE: f64 = -0.5;

/// The point that lies ahead of one point in one direction, and behind another in a second one.
/// `None` if the directions are nearly the same or opposite.
fn meeting(p: [f64; 2], q: [f64; 2], [ahead, onward]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let turn = cross(ahead, onward);
    let lengths = ahead[0].hypot(ahead[1]) * onward[0].hypot(onward[1]);
    let cosine = (ahead[0] * onward[0] + ahead[1] * onward[1]) / lengths;
    if !(turn.abs() / lengths > LEAST_TURN && cosine > LEAST_COSINE) {
        return None;
    }
    let gap = step(p, q);
    let (along, back) = (cross(gap, onward) / turn, cross(gap, ahead) / turn);
    (along > 0.0 && back < 0.0).then(|| [0, 1].map(|axis| p[axis] + along * ahead[axis]))
}

fn step(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Returns true if a parallel line runs in the direction of its line from one run to the next.
fn advances(from: (&[[f64; 2]; 2], usize), to: (&[[f64; 2]; 2], usize)) -> bool {
    let step = |of: usize| {
        [0, 1].map(|axis| to.0[of][axis] / to.1 as f64 - from.0[of][axis] / from.1 as f64)
    };
    let [parallel, line] = [step(0), step(1)];
    parallel[0] * line[0] + parallel[1] * line[1] > 0.0
}

/// The unit vector to the left of a segment.
pub(super) fn normal([[ax, ay], [bx, by]]: [[f64; 2]; 2]) -> [f64; 2] {
    let length = (bx - ax).hypot(by - ay);
    [-(by - ay) / length, (bx - ax) / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_mitered() {
        let line = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]];
        assert_eq!(
            offset(&line, 1.0),
            [[0.0, 1.0], [3.0, 1.0], [3.0, 4.0]].map(near(&offset(&line, 1.0)))
        );
        assert_eq!(
            offset(&line, -1.0),
            [[0.0, -1.0], [5.0, -1.0], [5.0, 4.0]].map(near(&offset(&line, -1.0)))
        );
    }

    #[test]
    fn a_ring_stays_closed_and_a_hairpin_is_cut_off() {
        let ring = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let inner = offset(&ring, 1.0);
        assert_eq!(inner[0], inner[4]);
        assert_eq!(
            inner,
            [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0], [1.0, 1.0]].map(near(&inner))
        );
        let hairpin = offset(&[[0.0, 0.0], [4.0, 0.0], [0.0, 0.0001]], 1.0);
        assert!((hairpin[1][0] - 4.0).hypot(hairpin[1][1]) < 2.001);
        // A line that turns back, or nearly so, is passed beyond its tip on its outer side.
        for y in [0.0, 1e-9, 1e-300] {
            let tip = offset(&[[0.0, 0.0], [4.0, 0.0], [0.5, y]], -1.0)[1];
            assert!((tip[0] - 6.0).hypot(tip[1]) < 1e-6, "{y}: {tip:?}");
        }
        let within = offset(&[[0.0, 0.0], [4.0, 0.0], [0.5, -1e-9]], -1.0)[1];
        assert!((within[0] - 2.0).hypot(within[1]) < 1e-6, "{within:?}");
        assert!(offset(&[[1.0, 1.0]], 1.0).is_empty());
    }

    /// Parts of a line that know each other have the vertices of the whole, to the last bit.
    #[test]
    fn parts_of_a_line_continue_each_other() {
        let line = [
            [0.1, 0.2],
            [10.0, 0.3],
            [1.0, 5.0],
            [1.5, 5.0],
            [1.0, 5.0],
            [4.0, -0.7],
            [0.1, 0.2],
        ];
        for distance in [0.3, -0.3] {
            let whole = offset(&line, distance);
            for k in 1..line.len() - 1 {
                let first =
                    offset_between(&line[..=k], [Some(line[5]), Some(line[k + 1])], distance);
                let second =
                    offset_between(&line[k..], [Some(line[k - 1]), Some(line[1])], distance);
                assert_eq!([first.as_slice(), &second[1..]].concat(), whole, "{k}");
            }
        }
    }

    #[test]
    fn folds_become_one_point() {
        // A right angle, rounded with a radius of 1.
        let arc = (0..=9)
            .map(|k| (f64::from(k) * 10.0 - 90.0).to_radians())
            .map(|a| [9.0 + a.cos(), 1.0 + a.sin()]);
        let line: Vec<[f64; 2]> = [[0.0, 0.0]]
            .into_iter()
            .chain(arc)
            .chain([[10.0, 10.0]])
            .collect();
        for distance in [0.5, 3.0, -3.0] {
            let parallel = offset(&line, distance);
            let smooth = unfolded(&parallel, &line);
            assert_eq!(smooth == parallel, distance < 1.0);
            let steps = smooth.windows(2).zip(line.windows(2));
            let along = steps.map(|(p, q)| {
                (0..2)
                    .map(|k| (p[1][k] - p[0][k]) * (q[1][k] - q[0][k]))
                    .sum::<f64>()
            });
            assert!(
                along.into_iter().all(|along| along >= 0.0),
                "{distance}: {smooth:?}"
            );
        }
        let inner = unfolded(&offset(&line, 3.0), &line);
        assert_eq!((inner[0], inner[11]), ([0.0, 3.0], [7.0, 10.0]));
        assert!(
            inner[1..11]
                .iter()
                .all(|p| p == &inner[1] && (p[0] - 7.0).hypot(p[1] - 3.0) < 1e-9),
            "{inner:?}"
        );
    }

    /// In a turn of about half a circle, the parts before and after do not meet: the bank stays
    /// near.
    #[test]
    fn bends_that_turn_back_stay_near_their_lines() {
        let turned =
            |[x, y]: [f64; 2], quarter: usize| [[x, y], [-y, x], [-x, -y], [y, -x]][quarter];
        for end in [[0.0, 1.0], [0.0, 0.9], [0.0, 0.999], [0.0, 1.1], [9.0, 1.0]] {
            for (quarter, side) in (0..4).flat_map(|quarter| [(quarter, 1.0), (quarter, -1.0)]) {
                let line = [[0.0, 0.0], [10.0, 0.0], [10.0, 1.0], end]
                    .map(|[x, y]| turned([x, side * y], quarter));
                for distance in [2.0, -2.0] {
                    let parallel = unfolded(&offset(&line, distance), &line);
                    let is_near =
                        |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0]).hypot(p[1] - q[1]) < 12.0;
                    assert!(
                        parallel.iter().zip(&line).all(is_near),
                        "{line:?} {distance}: {parallel:?}"
                    );
                }
            }
        }
    }

    /// Maps an expected point to the computed one that is within a rounding of it.
    fn near(computed: &[[f64; 2]]) -> impl Fn([f64; 2]) -> [f64; 2] + '_ {
        |[x, y]| {
            *computed
                .iter()
                .find(|p| (p[0] - x).hypot(p[1] - y) < 1e-12)
                .unwrap_or(&[x, y])
        }
    }
}

//! Lines across an axis.

use std::convert::Infallible;

use super::boxes::{Boxed, Boxes, Extent};
use super::linear::do_meet;

/// How sections lie across an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionWidths {
    /// The lengths to the left and to the right of the axis, seen along it, in its units.
    pub widths: [f64; 2],
    /// The angle in degrees from the direction of the axis to the left half of the section; 90 is
    /// square to the axis.
    pub angle: f64,
}

/// Returns the section at each distance along an axis: its left end, its point on the axis, and its
/// right end; `None` beyond the ends of the axis, or if the axis has no length.
///
/// Distances are in the units of the axis. At a vertex of the axis, its direction is halfway
/// between those of both segments.
///
/// # Complexity
/// O(n + m log n) for m sections across an axis of n vertices.
pub fn sections(
    axis: &[[f64; 2]],
    distances: &[f64],
    across: &SectionWidths,
) -> Vec<Option<[[f64; 2]; 3]>> {
    let ends = vertices_along(axis);
    // The cosine of a rounded right angle is not 0.
    let (sin, cos) = if across.angle == 90.0 {
        (1.0, 0.0)
    } else {
        across.angle.to_radians().sin_cos()
    };
    let one = |&distance: &f64| {
        let (at, direction) = on_axis(axis, &ends, distance)?;
        let [x, y] = direction;
        let left = [x * cos - y * sin, x * sin + y * cos];
        let [to_left, to_right] = across.widths;
        let end = |by: f64| [0, 1].map(|k| at[k] + by * left[k]);
        Some([end(to_left), at, end(-to_right)])
    };
    distances.iter().map(one).collect()
}

/// Returns the distance of each vertex from the start of a line, along it.
pub(crate) fn vertices_along(line: &[[f64; 2]]) -> Vec<f64> {
    let mut along = 0.0;
    let mut found = vec![0.0];
    for ends in line.windows(2) {
        let [x, y] = [0, 1].map(|k| ends[1][k] - ends[0][k]);
        along += x.hypot(y);
        found.push(along);
    }
    found
}

/// Returns the position at a distance along an axis, and the direction there.
fn on_axis(axis: &[[f64; 2]], ends: &[f64], distance: f64) -> Option<([f64; 2], [f64; 2])> {
    let last = *ends.last()?;
    if !(0.0..=last).contains(&distance) || axis.len() < 2 {
        return None;
    }
    // The first vertex that is not before, and the first one that is behind.
    let here = ends.partition_point(|&end| end < distance);
    let beyond = ends.partition_point(|&end| end <= distance);
    let direction = |from: usize| {
        let [x, y] = [0, 1].map(|k| axis[from + 1][k] - axis[from][k]);
        let length = x.hypot(y);
        (length > 0.0).then(|| [x / length, y / length])
    };
    if here == beyond {
        // Between two vertices.
        let from = here.checked_sub(1)?;
        let part = (distance - ends[from]) / (ends[here] - ends[from]);
        let at = [0, 1].map(|k| axis[from][k] + part * (axis[here][k] - axis[from][k]));
        return Some((at, direction(from)?));
    }
    let before = here.checked_sub(1).and_then(direction);
    let behind = (beyond < axis.len())
        .then(|| direction(beyond - 1))
        .flatten();
    let direction = match (before, behind) {
        (Some(a), Some(b)) => {
            let [x, y] = [0, 1].map(|k| a[k] + b[k]);
            let length = x.hypot(y);
            // Where the axis turns back, its direction is the one before.
            if length > 1e-9 {
                [x / length, y / length]
            } else {
                a
            }
        }
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => return None,
    };
    Some((axis[here], direction))
}

/// Returns the pairs of lines that cross or touch, by their positions, in order: the first ones if
/// there are more than `most`, and one more than that.
///
/// # Complexity
/// O((n + k) log n) for n lines and k pairs of which the boxes overlap.
pub fn crossing_pairs(lines: &[[[f64; 2]; 2]], most: usize) -> Vec<[usize; 2]> {
    let items = lines.iter().enumerate().map(|(number, ends)| Line {
        number,
        extent: Extent::of_plan(*ends),
    });
    let tree = Boxes::new(items.collect());
    let mut found = Vec::new();
    for (number, ends) in lines.iter().enumerate() {
        if found.len() > most {
            break;
        }
        let extent = Extent::of_plan(*ends);
        tree.find_in(extent, |other| {
            if other.number > number && other.extent.overlaps(&extent) {
                let is_met = do_meet(*ends, lines[other.number]);
                found.extend(is_met.then_some([number, other.number]));
            }
            None::<Infallible>
        });
    }
    found.sort_unstable();
    found.truncate(most.saturating_add(1));
    found
}

#[derive(Debug, Clone, Copy)]
struct Line {
    number: usize,
    extent: Extent,
}

impl Boxed for Line {
    fn extent(&self) -> Extent {
        self.extent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: SectionWidths = SectionWidths {
        widths: [2.0, 1.0],
        angle: 90.0,
    };

    #[test]
    fn sections_are_square_to_the_axis_and_halve_its_bends() {
        let axis = [[0.0, 0.0], [10.0, 0.0], [10.0, 0.0], [10.0, 10.0]];
        let at = |distance: f64| sections(&axis, &[distance], &SQUARE)[0];
        assert_eq!(at(0.0), Some([[0.0, 2.0], [0.0, 0.0], [0.0, -1.0]]));
        assert_eq!(at(4.0), Some([[4.0, 2.0], [4.0, 0.0], [4.0, -1.0]]));
        assert_eq!(at(15.0), Some([[8.0, 5.0], [10.0, 5.0], [11.0, 5.0]]));
        assert_eq!(at(20.0), Some([[8.0, 10.0], [10.0, 10.0], [11.0, 10.0]]));
        let half = 0.5f64.sqrt();
        let [left, _, right] = at(10.0).unwrap();
        for (found, expected) in [
            (left, [10.0 - 2.0 * half, 2.0 * half]),
            (right, [10.0 + half, -half]),
        ] {
            assert!(
                (0..2).all(|k| (found[k] - expected[k]).abs() < 1e-12),
                "{found:?}"
            );
        }
        assert_eq!([at(-0.1), at(20.1), at(f64::NAN)], [None; 3]);
        assert_eq!(sections(&[[1.0, 1.0], [1.0, 1.0]], &[0.0], &SQUARE), [None]);
        assert_eq!(sections(&[], &[0.0], &SQUARE), [None]);
    }

    #[test]
    fn an_angle_turns_the_left_half() {
        let askew = SectionWidths {
            angle: 45.0,
            ..SQUARE
        };
        let found = sections(&[[0.0, 0.0], [10.0, 0.0]], &[5.0], &askew)[0].unwrap();
        let half = 0.5f64.sqrt();
        let expected = [
            [5.0 + 2.0 * half, 2.0 * half],
            [5.0, 0.0],
            [5.0 - half, -half],
        ];
        let is_near = |k: usize, i: usize| (found[k][i] - expected[k][i]).abs() < 1e-12;
        assert!((0..3).all(|k| is_near(k, 0) && is_near(k, 1)), "{found:?}");
    }

    #[test]
    fn sections_cross_at_the_inside_of_a_bend() {
        let axis = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]];
        let wide = SectionWidths {
            widths: [4.0, 4.0],
            ..SQUARE
        };
        let distances = [2.0, 8.0, 12.0, 19.0];
        let lines: Vec<[[f64; 2]; 2]> = sections(&axis, &distances, &wide)
            .into_iter()
            .flatten()
            .map(|[left, _, right]| [left, right])
            .collect();
        assert_eq!(crossing_pairs(&lines, 9), [[1, 2]]);
        // Touching counts.
        let touching = [
            [[0.0, 0.0], [2.0, 0.0]],
            [[1.0, 0.0], [1.0, 5.0]],
            [[3.0, 0.0], [4.0, 0.0]],
        ];
        assert_eq!(crossing_pairs(&touching, 9), [[0, 1]]);
    }

    #[test]
    fn no_more_crossing_pairs_are_collected_than_are_asked_for() {
        let star: Vec<[[f64; 2]; 2]> = (0..40)
            .map(|i| [[f64::from(i), 0.0], [f64::from(40 - i), 9.0]])
            .collect();
        let all = crossing_pairs(&star, usize::MAX);
        assert_eq!(all.len(), 40 * 39 / 2);
        assert_eq!(crossing_pairs(&star, 50), all[..51]);
        assert_eq!(crossing_pairs(&star, all.len()), all);
    }
}

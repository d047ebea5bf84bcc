//! Where the heights of contours are written.

use rayon::prelude::*;

use super::MapLine;
use super::placing::{Candidate, Distances, chosen};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::in_order::in_order;
use crate::terrain::vertices_along;

/// How labels are placed; lengths are in plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LabelRules {
    /// The height of the text on the ground.
    pub height: f64,
    /// The least distance of a further label of a line from all others. It is at least one and a
    /// half times the longest text, which the first labels of two lines keep from each other.
    pub spacing: f64,
    /// Where the tops of labels are.
    pub tops: LabelTops,
}

/// Where the tops of labels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum LabelTops {
    /// Up on the sheet, so that no label stands upside down.
    #[default]
    Readable,
    /// Uphill.
    Uphill,
}

/// The height of a contour, written on the line.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContourLabel {
    /// The middle of the text.
    pub at: [f64; 2],
    /// The height of the line.
    pub level: f64,
    /// The direction in which the text runs: degrees counter-clockwise from the x axis. More than
    /// -90 and at most 90 if tops are [readable](LabelTops::Readable), else more than -180 and at
    /// most 180.
    pub rotation: f64,
    /// The size of the text: its length along the line, with a margin, and its height.
    pub size: [f64; 2],
}

/// The height of labels and their spacing, in intervals.
const SIZE: [f64; 2] = [2.0, 60.0];

/// The width of a character, and the margin of a text, in heights of the text.
const CHARACTER: f64 = 0.65;
const MARGIN: f64 = 1.0;

/// How far a line may be from the straight middle of its text, in heights of the text.
const LARGEST_BEND: f64 = 0.15;

/// The least length of the chord of a line under a text, relative to the text.
const LEAST_CHORD: f64 = 0.97;

/// Half of the height that no other line enters, in heights of the text.
const HALF_HEIGHT: f64 = 0.7;

/// How many points of the line under a text are compared with its chord.
const SAMPLES: usize = 9;

impl LabelRules {
    /// Returns the rules for contours with an interval.
    pub fn of_interval(interval: f64) -> Self {
        let [height, spacing] = SIZE.map(|size| size * interval);
        LabelRules {
            height,
            spacing,
            tops: LabelTops::default(),
        }
    }

    fn length_of(&self, level: f64) -> f64 {
        let characters = level.to_string().len() as f64;
        (characters * CHARACTER + MARGIN) * self.height
    }
}

/// Returns labels for some of the lines, where they are straight: none overlaps another one, or a
/// line other than its own.
///
/// A label may be at the middle of each segment where the line is straight under the text. Places
/// where the line bends least come first, and those with the least coordinates if some bend as
/// much. Each line gets its first label where the text is clear of those of other lines, before any
/// line gets further ones, which keep the spacing from all. So a line stays without a label only if
/// it has no straight place that is clear of the others.
///
/// # Complexity
/// Expected O(n log n) in the segments of all lines, on all threads; 48 bytes for each.
pub fn contour_labels(
    lines: &[MapLine],
    is_labeled: impl Fn(&MapLine) -> bool + Sync,
    rules: &LabelRules,
) -> Vec<ContourLabel> {
    let segments = lines.iter().enumerate().flat_map(|(number, line)| {
        let ends = line.line.points.windows(2);
        ends.map(move |ends| Side {
            line: number as u32,
            ends: [ends[0], ends[1]],
        })
    });
    let segments = Boxes::new(segments.collect());
    let wanted = lines
        .iter()
        .enumerate()
        .filter(|(_, line)| is_labeled(line));
    let wanted: Vec<(usize, &MapLine)> = wanted.collect();
    let lengths = wanted
        .iter()
        .map(|(_, line)| rules.length_of(line.line.level));
    let longest = lengths.fold(0.0, f64::max);
    let candidates: Vec<Candidate> = wanted
        .par_iter()
        .flat_map_iter(|&(number, line)| candidates(number as u32, line, rules, &segments))
        .collect();
    // Boxes of texts cannot meet at this distance.
    let first = 1.5 * longest;
    let least = Distances {
        first,
        further: rules.spacing.max(first),
    };
    let mut best = chosen(candidates, least);
    best.sort_by(|a, b| in_order(&(a.level, a.at), &(b.level, b.at)));
    let label = |candidate: &Candidate| ContourLabel {
        at: candidate.at,
        level: candidate.level,
        rotation: rotation(candidate.along, rules.tops),
        size: [rules.length_of(candidate.level), rules.height],
    };
    best.iter().map(label).collect()
}

/// Returns the direction of a text on a line with this direction, which has the higher ground on
/// its right.
fn rotation([x, y]: [f64; 2], tops: LabelTops) -> f64 {
    // A text that runs against the line has its top on the right of the line.
    let uphill = f64::atan2(-y, -x).to_degrees();
    let uphill = if uphill <= -180.0 { 180.0 } else { uphill };
    match tops {
        LabelTops::Uphill => uphill,
        LabelTops::Readable if uphill > 90.0 => uphill - 180.0,
        LabelTops::Readable if uphill <= -90.0 => uphill + 180.0,
        LabelTops::Readable => uphill,
    }
}

/// A segment of a line.
#[derive(Debug, Clone, Copy)]
struct Side {
    line: u32,
    ends: [[f64; 2]; 2],
}

impl Boxed for Side {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.ends)
    }
}

/// Returns the places on a line at which a label may be.
fn candidates(
    number: u32,
    MapLine { line, .. }: &MapLine,
    rules: &LabelRules,
    segments: &Boxes<Side>,
) -> Vec<Candidate> {
    let length = rules.length_of(line.level);
    let mut points = line.points.clone();
    let once = points.len().saturating_sub(1);
    if line.is_closed() {
        // Once more around, for texts at the point where it closes.
        points.extend_from_within(1..);
    }
    let along = vertices_along(&points);
    let whole = along[once];
    let mut found = Vec::new();
    for i in 0..once {
        let mut middle = 0.5 * (along[i] + along[i + 1]);
        if line.is_closed() && middle < 0.5 * length {
            middle += whole;
        }
        let [start, end] = [middle - 0.5 * length, middle + 0.5 * length];
        let fits = start >= 0.0 && end <= along[along.len() - 1] && length <= whole;
        let candidate = fits
            .then(|| candidate_at(&points, &along, [start, end], rules))
            .flatten();
        let Some((at, direction, bend)) = candidate else {
            continue;
        };
        let half = [0.5 * length, HALF_HEIGHT * rules.height];
        let reach = half[0].hypot(half[1]);
        let near = Extent::of_plan([at]).grown(reach);
        let is_free = segments
            .find_in(near, |side| {
                let enters = || enters_box(side.ends, at, direction, half);
                (side.line != number && enters()).then_some(())
            })
            .is_none();
        if is_free {
            found.push(Candidate {
                line: number,
                at,
                along: direction,
                level: line.level,
                bend,
            });
        }
    }
    found
}

/// Returns the middle of the chord between two distances along a line, its direction, and how far
/// the line is from it; `None` if it is too far.
fn candidate_at(
    points: &[[f64; 2]],
    along: &[f64],
    [start, end]: [f64; 2],
    rules: &LabelRules,
) -> Option<([f64; 2], [f64; 2], f64)> {
    let at = |distance: f64| {
        let after = along
            .partition_point(|&d| d <= distance)
            .clamp(1, along.len() - 1);
        let part = (distance - along[after - 1]) / (along[after] - along[after - 1]);
        let [a, b] = [points[after - 1], points[after]];
        [0, 1].map(|k| a[k] + part.clamp(0.0, 1.0) * (b[k] - a[k]))
    };
    let [first, last] = [at(start), at(end)];
    let [dx, dy] = [last[0] - first[0], last[1] - first[1]];
    let chord = dx.hypot(dy);
    let direction = [dx / chord, dy / chord];
    let off =
        |p: [f64; 2]| ((p[0] - first[0]) * direction[1] - (p[1] - first[1]) * direction[0]).abs();
    let samples = (1..SAMPLES - 1).map(|k| {
        let part = k as f64 / (SAMPLES - 1) as f64;
        off(at(start + part * (end - start)))
    });
    let bend = samples.fold(0.0, f64::max);
    let is_straight = bend <= LARGEST_BEND * rules.height && chord >= LEAST_CHORD * (end - start);
    let middle = [0, 1].map(|k| 0.5 * (first[k] + last[k]));
    is_straight.then_some((middle, direction, bend))
}

/// Returns true if a segment enters a box around a point that has a direction.
fn enters_box(ends: [[f64; 2]; 2], center: [f64; 2], [ex, ey]: [f64; 2], half: [f64; 2]) -> bool {
    // In the system of the box.
    let [a, b] = ends.map(|p| {
        let [x, y] = [p[0] - center[0], p[1] - center[1]];
        [x * ex + y * ey, y * ex - x * ey]
    });
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let step = b[axis] - a[axis];
        if step == 0.0 {
            if a[axis].abs() > half[axis] {
                return false;
            }
            continue;
        }
        let cuts = [-half[axis], half[axis]].map(|side| (side - a[axis]) / step);
        from = from.max(cuts[0].min(cuts[1]));
        to = to.min(cuts[0].max(cuts[1]));
    }
    from <= to
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tops_are_uphill_or_readable() {
        // A line to the east has higher ground in the south.
        for (along, uphill, readable) in [
            ([1.0, 0.0], 180.0, 0.0),
            ([-1.0, 0.0], 0.0, 0.0),
            ([0.0, 1.0], -90.0, 90.0),
            ([0.0, -1.0], 90.0, 90.0),
            ([1.0, 1.0], -135.0, 45.0),
            ([-1.0, 1.0], -45.0, -45.0),
        ] {
            assert_eq!(rotation(along, LabelTops::Uphill), uphill, "{along:?}");
            assert_eq!(rotation(along, LabelTops::Readable), readable, "{along:?}");
        }
    }

    #[test]
    fn segments_enter_a_box() {
        let enters = |ends| enters_box(ends, [10.0, 10.0], [0.0, 1.0], [4.0, 1.0]);
        assert!(enters([[0.0, 10.0], [20.0, 10.0]]));
        assert!(enters([[10.5, 12.0], [10.5, 13.0]]));
        assert!(!enters([[12.0, 0.0], [12.0, 20.0]]));
        assert!(!enters([[0.0, 15.0], [20.0, 15.0]]));
    }
}

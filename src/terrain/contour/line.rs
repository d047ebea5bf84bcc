use super::join::{Joined, rejoin};
use super::loops::cut_loops;
use super::narrow::Bends;
use crate::data::ContourLine;
use crate::terrain::in_order::in_order;
use std::cmp::Ordering;

/// Returns the finished lines of a level, sorted. Where rounding shows, the rule is applied to the
/// rounded arcs: if the crossing of an edge was rounded to one of its ends, an arc is bent, or a
/// line [falls together](falls_together).
pub(super) fn finish_level(
    level: f64,
    mut lines: Vec<Joined>,
    touches_vertices: bool,
    bends: &Bends,
) -> Vec<ContourLine> {
    let mut is_bent = false;
    for line in &mut lines {
        is_bent |= bends.bend(&mut line.points);
    }
    if touches_vertices || is_bent || lines.iter().any(falls_together) {
        lines = rejoin(&lines);
    }
    let mut finished = Vec::with_capacity(lines.len());
    for line in lines {
        finish(level, line, &mut finished);
    }
    finished.sort_by(|a, b| in_order(&a.points, &b.points));
    finished
}

/// Returns true if rounding has removed the length of an arc or the width of a line.
fn falls_together(line: &Joined) -> bool {
    let points = &line.points;
    // Also around the point where a ring closes.
    let closing = if line.closed { points.get(1) } else { None };
    let mut after_next = points.iter().skip(2).chain(closing);
    points
        .windows(2)
        .any(|pair| pair[0] == pair[1] || after_next.next() == Some(&pair[0]))
}

/// Adds the simple lines that a line consists of; the first point of a closed one depends on its
/// shape alone.
fn finish(level: f64, Joined { mut points, closed }: Joined, lines: &mut Vec<ContourLine>) {
    if closed {
        points.pop();
        start_at_smallest(&mut points);
    }
    let mut add = |mut points: Vec<[f64; 2]>, is_closed| {
        points.extend_from_within(..usize::from(is_closed));
        lines.push(ContourLine { level, points });
    };
    let is_cut = cut_loops(&points, closed, |mut points, is_closed| {
        if is_closed {
            start_at_smallest(&mut points);
        }
        add(points, is_closed);
    });
    if !is_cut {
        add(points, closed);
    }
}

/// Rotates a ring to its smallest point; if that occurs more than once, to the occurrence from
/// which the whole ring is smallest.
pub(super) fn start_at_smallest(ring: &mut [[f64; 2]]) {
    let (mut best, mut is_repeated) = (0, false);
    for (i, point) in ring.iter().enumerate().skip(1) {
        let smallest = ring[best];
        if point[0] < smallest[0] || (point[0] == smallest[0] && point[1] < smallest[1]) {
            (best, is_repeated) = (i, false);
        } else {
            is_repeated |= *point == smallest;
        }
    }
    if is_repeated {
        let occurrences = (best..ring.len()).filter(|&i| ring[i] == ring[best]);
        let from = |start: usize| ring[start..].iter().chain(&ring[..start]);
        let by_ring = |a: &usize, b: &usize| from(*a).partial_cmp(from(*b));
        best = occurrences
            .min_by(|a, b| by_ring(a, b).unwrap_or(Ordering::Equal))
            .unwrap_or(best);
    }
    ring.rotate_left(best);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(names: &str) -> Joined {
        let points: Vec<_> = names.bytes().map(|b| [f64::from(b), 0.0]).collect();
        Joined {
            closed: points.first() == points.last(),
            points,
        }
    }

    fn finished(names: &str) -> Vec<String> {
        let name = |p: &[f64; 2]| p[0] as u8 as char;
        let mut lines = Vec::new();
        finish(0.0, line(names), &mut lines);
        lines
            .iter()
            .map(|line| line.points.iter().map(name).collect())
            .collect()
    }

    #[test]
    fn what_falls_together_is_seen() {
        // The last of them where the ring closes.
        for names in ["aab", "abb", "cabad", "abba", "aba", "bcdcb", "bcdeacb"] {
            assert!(falls_together(&line(names)), "{names}");
        }
        for names in ["ab", "abc", "abca", "bcadeab"] {
            assert!(!falls_together(&line(names)), "{names}");
        }
    }

    #[test]
    fn rings_start_at_their_smallest_point() {
        assert_eq!(finished("zxyz"), ["xyzx"]);
        assert_eq!(finished("cab"), ["cab"]);
    }

    #[test]
    fn a_ring_that_passes_a_point_twice_is_cut_there() {
        for names in ["adeabca", "abcadea", "eabcade", "cadeabc"] {
            assert_eq!(finished(names), ["abca", "adea"], "{names}");
        }
    }
}

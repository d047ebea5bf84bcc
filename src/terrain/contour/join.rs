use super::cut::Direction;
use super::trace::{LooseEnd, Trace};
use crate::data::Surface;
use crate::terrain::in_order::in_order;
use crate::terrain::linear::sorted;
use crate::triangulation::kernel::{Exact, Kernel, Orientation2};
use crate::triangulation::num::Sign;
use std::cmp::Ordering;

/// The points of a line; a closed line repeats its first point at the end.
pub(super) struct Joined {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) closed: bool,
}

/// Joins lines that end and begin at the same vertex at the edge of the data: the turn rule across
/// the gaps between fans of faces.
pub(super) fn join<S: Surface + ?Sized>(surface: &S, traces: Vec<Trace>) -> Vec<Joined> {
    let mut joined = Vec::new();
    let mut open = Vec::new();
    let mut ends = Vec::new();
    let plan = |vertex: u32| {
        let [x, y, _] = surface.position(vertex);
        [x, y]
    };
    for trace in traces {
        match trace {
            Trace::Closed(points) => joined.push(Joined {
                points,
                closed: true,
            }),
            Trace::Open {
                points,
                ends: loose,
            } => {
                let line = open.len();
                open.push(points);
                for (loose, direction) in loose
                    .into_iter()
                    .zip([Direction::Forward, Direction::Backward])
                {
                    if let LooseEnd::Vertex { vertex, toward } = loose {
                        ends.push((
                            vertex,
                            End {
                                center: plan(vertex),
                                toward: plan(toward),
                                direction,
                                line,
                            },
                        ));
                    }
                }
            }
        }
    }
    ends.sort_by_key(|(vertex, _)| *vertex);
    let mut next = vec![None; open.len()];
    for group in ends.chunk_by(|a, b| a.0 == b.0) {
        pair(group.iter().map(|(_, end)| *end).collect(), &mut next);
    }
    chain(open, &next, |line, _| joined.push(line));
    joined
}

/// Applies the rule to lines whose points were rounded.
///
/// Arcs without length are removed, opposite arcs that coincide cancel, and the others are joined
/// again by the turn rule at each point.
pub(super) fn rejoin(lines: &[Joined]) -> Vec<Joined> {
    let mut arcs: Vec<[[f64; 2]; 2]> = lines
        .iter()
        .flat_map(|line| line.points.windows(2))
        .map(|p| [p[0], p[1]])
        .filter(|[a, b]| a != b)
        .collect();
    arcs.sort_by(|&a, &b| in_order(&sorted(a), &sorted(b)).then_with(|| in_order(&a, &b)));
    let mut open = Vec::new();
    for same in arcs.chunk_by(|&a, &b| sorted(a) == sorted(b)) {
        let first_direction = same.iter().take_while(|&&arc| arc == same[0]).count();
        let cancelled = first_direction.min(same.len() - first_direction);
        open.extend(
            same[cancelled..same.len() - cancelled]
                .iter()
                .map(|arc| arc.to_vec()),
        );
    }
    let mut ends = Vec::new();
    for (line, points) in open.iter().enumerate() {
        let [a, b] = [points[0], points[1]];
        ends.push(End {
            center: a,
            toward: b,
            direction: Direction::Forward,
            line,
        });
        ends.push(End {
            center: b,
            toward: a,
            direction: Direction::Backward,
            line,
        });
    }
    ends.sort_by(|a, b| in_order(&a.center, &b.center));
    let mut next = vec![None; open.len()];
    for group in ends.chunk_by(|a, b| a.center == b.center) {
        pair(group.to_vec(), &mut next);
    }
    let mut joined = Vec::new();
    chain(open, &next, |line, _| joined.push(line));
    joined
}

/// An end of an open line; forward if the line begins there.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub(super) center: [f64; 2],
    /// A point in the direction of the line, seen from the center.
    pub(super) toward: [f64; 2],
    pub(super) direction: Direction,
    pub(super) line: usize,
}

/// Pairs each line that arrives at a point with the first leaving line counter-clockwise from it
/// that is not taken by one arriving in between, like pairs of brackets around the vertex.
pub(super) fn pair(mut group: Vec<End>, next: &mut [Option<usize>]) {
    // Two ends have only one possible pairing.
    if group.len() > 2 {
        group.sort_by(|a, b| around(a.center, a.toward, b.toward));
    }
    let mut arrived = Vec::new();
    let mut left = vec![false; group.len()];
    // The second round closes the circle; arrivals were recorded in the first.
    for round in 0..2 {
        for (end, left) in group.iter().zip(&mut left) {
            match end.direction {
                Direction::Backward if round == 0 => arrived.push(end.line),
                Direction::Forward if !*left => {
                    if let Some(line) = arrived.pop() {
                        next[line] = Some(end.line);
                        *left = true;
                    }
                }
                _ => {}
            }
        }
    }
}

/// Compares the directions from the center to two points, counter-clockwise from east.
pub(super) fn around(center: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Ordering {
    let lower_half = |p: [f64; 2]| p[1] < center[1] || (p[1] == center[1] && p[0] < center[0]);
    lower_half(a).cmp(&lower_half(b)).then_with(|| {
        match Exact::sign(&Orientation2([center, a, b])) {
            Sign::Positive => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Greater,
        }
    })
}

/// Follows `next` from line to line. Calls `found` with each line that results, and with the first
/// and the last of those that it is made of.
pub(super) fn chain(
    mut open: Vec<Vec<[f64; 2]>>,
    next: &[Option<usize>],
    mut found: impl FnMut(Joined, [usize; 2]),
) {
    let mut has_previous = vec![false; open.len()];
    for &line in next.iter().flatten() {
        has_previous[line] = true;
    }
    let firsts = (0..open.len()).filter(|&line| !has_previous[line]);
    // The lines that remain after the open ones are closed.
    for first in firsts.chain(0..open.len()) {
        let mut points = std::mem::take(&mut open[first]);
        if points.is_empty() {
            continue;
        }
        let mut line = first;
        while let Some(following) = next[line].filter(|&line| !open[line].is_empty()) {
            points.pop();
            points.append(&mut open[following]);
            line = following;
        }
        found(
            Joined {
                points,
                closed: next[line].is_some(),
            },
            [first, line],
        );
    }
}

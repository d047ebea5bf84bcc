use super::cut::Way;
use super::trace::{LooseEnd, Trace};
use crate::data::Surface;
use std::cmp::Ordering;

/// The points of a line and whether it is closed.
pub(super) struct Joined {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) closed: bool,
}

/// Joins lines that end and begin at one vertex at the edge of the data: the turn rule over the gaps
/// between fans of faces.
pub(super) fn join<S: Surface + ?Sized>(surface: &S, traces: Vec<Trace>) -> Vec<Joined> {
    let mut joined = Vec::new();
    let mut open = Vec::new();
    let mut ends = Vec::new();
    for trace in traces {
        match trace {
            Trace::Closed(points) => joined.push(Joined { points, closed: true }),
            Trace::Open { points, start, end } => {
                let line = open.len();
                open.push(points);
                ends.extend(start.map(|at| End { at, way: Way::Forward, line }));
                ends.extend(end.map(|at| End { at, way: Way::Backward, line }));
            }
        }
    }
    let mut next = vec![None; open.len()];
    ends.sort_by_key(|end| end.at.vertex);
    for group in ends.chunk_by_mut(|a, b| a.at.vertex == b.at.vertex) {
        pair(surface, group, &mut next);
    }
    chain(open, &next, &mut joined);
    joined
}

/// An end of an open line, seen from its vertex: forward if the line begins there.
#[derive(Clone, Copy)]
struct End {
    at: LooseEnd,
    way: Way,
    line: usize,
}

/// Gives each line that arrives the first one counter-clockwise that leaves and is not taken by one
/// that arrives in between: as brackets are paired, around the vertex.
fn pair<S: Surface + ?Sized>(surface: &S, group: &mut [End], next: &mut [Option<usize>]) {
    if group.len() > 2 {
        let center = surface.position(group[0].at.vertex);
        group.sort_by(|a, b| around(center, surface.position(a.at.toward), surface.position(b.at.toward)));
    }
    let mut arrived = Vec::new();
    let mut left = vec![false; group.len()];
    // The second round closes the circle: nothing arrives anew.
    for round in 0..2 {
        for (end, left) in group.iter().zip(&mut left) {
            match end.way {
                Way::Backward if round == 0 => arrived.push(end.line),
                Way::Forward if !*left => {
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
fn around(center: [f64; 3], a: [f64; 3], b: [f64; 3]) -> Ordering {
    let lower_half = |p: [f64; 3]| p[1] < center[1] || (p[1] == center[1] && p[0] < center[0]);
    lower_half(a).cmp(&lower_half(b)).then_with(|| {
        let left = (a[0] - center[0]) * (b[1] - center[1]);
        let right = (a[1] - center[1]) * (b[0] - center[0]);
        right.total_cmp(&left)
    })
}

/// Follows the links from line to line.
fn chain(mut open: Vec<Vec<[f64; 2]>>, next: &[Option<usize>], joined: &mut Vec<Joined>) {
    let mut has_previous = vec![false; open.len()];
    for &line in next.iter().flatten() {
        has_previous[line] = true;
    }
    let firsts = (0..open.len()).filter(|&line| !has_previous[line]);
    // What is left after the open chains are closed ones.
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
        joined.push(Joined { points, closed: next[line].is_some() });
    }
}

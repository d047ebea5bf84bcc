//! The rim of a surface: where a segment comes onto it.

use std::cmp::Ordering;
use std::convert::Infallible;

use super::segment::{Event, Segment};
use super::step::{At, Steps, Toward, height_on};
use crate::data::Surface;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::linear::{plan, turn};
use crate::triangulation::num::Sign;

/// An edge at the rim of a surface: that of a face opposite a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct RimEdge {
    pub(super) face: u32,
    pub(super) corner: u8,
    extent: Extent,
}

impl Boxed for RimEdge {
    fn extent(&self) -> Extent {
        self.extent
    }
}

impl RimEdge {
    /// Returns the edge of a face opposite a corner.
    pub(super) fn new(surface: &dyn Surface, face: u32, corners: [u32; 3], corner: usize) -> Self {
        let ends = [1, 2].map(|k| surface.position(corners[(corner + k) % 3]));
        RimEdge {
            face,
            corner: corner as u8,
            extent: Extent::of(ends),
        }
    }
}

/// Where a segment comes onto a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) event: Event,
    pub(super) position: [f64; 3],
    pub(super) toward: Toward,
    /// Which entry counts of those at one position: 0 into a face, 1 along an edge with its face to
    /// the left, 2 with its face to the right.
    rank: u8,
}

impl Entry {
    fn face(&self) -> u32 {
        match self.toward {
            Toward::Edge(exit) => exit.face,
            Toward::Vertex { face, .. } => face,
        }
    }
}

/// Returns where a segment comes onto a surface, in order along the segment.
pub(super) fn entries(
    steps: &mut Steps<'_>,
    rim: &Boxes<RimEdge>,
    segment: &Segment,
) -> Vec<Entry> {
    let mut found = Vec::new();
    rim.find_where(
        |extent| may_meet(extent, segment),
        |edge| {
            if may_meet(&edge.extent, segment) {
                found.extend(entry(steps, edge, segment));
            }
            None::<Infallible>
        },
    );
    found.sort_by(|a, b| {
        let key = |entry: &Entry| (entry.rank, entry.face());
        segment
            .compare(&a.event, &b.event)
            .then(key(a).cmp(&key(b)))
    });
    found
}

/// Returns where a segment comes onto a surface at an edge of its rim, or at an end of it.
fn entry(steps: &mut Steps<'_>, edge: &RimEdge, segment: &Segment) -> Option<Entry> {
    let (face, i) = (edge.face, usize::from(edge.corner));
    let corners = steps.surface.face(face)?;
    // The face is to the left of the edge from `a` to `b`.
    let [a, b] = [1, 2].map(|k| steps.surface.position(corners[(i + k) % 3]));
    let is_within = |p: [f64; 3]| {
        segment.compare_points(segment.from, plan(p)).is_le()
            && segment.compare_points(plan(p), segment.to).is_lt()
    };
    let [of_a, of_b] = [a, b].map(|end| segment.seen(end));
    match (of_a.side, of_b.side) {
        (Sign::Positive, Sign::Negative) => {
            let at_start = turn(plan(a), plan(b), segment.from);
            let is_crossed =
                at_start != Sign::Positive && turn(plan(a), plan(b), segment.to) == Sign::Positive;
            let toward = steps.enter(face, i, segment)?;
            is_crossed.then(|| Entry {
                event: Event::Crossing([plan(a), plan(b)]),
                position: match at_start {
                    Sign::Zero => height_on([a, b], segment.from),
                    _ => segment.crossing(&of_a, &of_b),
                },
                toward,
                rank: 0,
            })
        }
        (Sign::Zero, Sign::Negative) if is_within(a) => {
            at_vertex(steps, face, (i + 1) % 3, segment)
        }
        (Sign::Positive, Sign::Zero) if is_within(b) => {
            at_vertex(steps, face, (i + 2) % 3, segment)
        }
        (Sign::Zero, Sign::Zero) => {
            let is_left = segment.compare_points(plan(a), plan(b)).is_lt();
            let (first, last) = if is_left { (a, b) } else { (b, a) };
            let starts_before = segment.compare_points(plan(first), segment.from).is_lt();
            let is_on = segment.compare_points(segment.from, plan(last)).is_lt()
                && segment.compare_points(plan(first), segment.to).is_lt();
            is_on.then(|| {
                let position = match starts_before {
                    true => height_on([a, b], segment.from),
                    false => first,
                };
                Entry {
                    event: Event::Point(plan(position)),
                    position,
                    toward: Toward::Vertex {
                        face,
                        corner: (i + if is_left { 2 } else { 1 }) % 3,
                        along: Some(i),
                    },
                    rank: if is_left { 1 } else { 2 },
                }
            })
        }
        _ => None,
    }
}

/// Returns the entry through a vertex of the rim into the faces that are linked around it.
fn at_vertex(steps: &mut Steps<'_>, face: u32, corner: usize, segment: &Segment) -> Option<Entry> {
    let toward = steps.around(face, corner, segment)?;
    let position = steps.surface.triangle(face)?[corner];
    Some(Entry {
        event: Event::Point([position[0], position[1]]),
        position,
        toward,
        rank: 0,
    })
}

/// Returns where a position on the rim is: of several edges, on that of the smallest face.
pub(super) fn on_rim(surface: &dyn Surface, rim: &Boxes<RimEdge>, q: [f64; 2]) -> At {
    let mut found: Option<RimEdge> = None;
    rim.find(q, |edge| {
        let is_first = found.is_none_or(|known| {
            (edge.face, edge.corner).cmp(&(known.face, known.corner)) == Ordering::Less
        });
        if is_first && edge.extent.overlaps(&Extent { min: q, max: q }) {
            let triangle = surface.triangle(edge.face)?;
            let [a, b] = [1, 2].map(|k| {
                let [x, y, _] = triangle[(usize::from(edge.corner) + k) % 3];
                [x, y]
            });
            if turn(a, b, q) == Sign::Zero {
                found = Some(*edge);
            }
        }
        None::<Infallible>
    });
    let Some(RimEdge { face, corner, .. }) = found else {
        return At::Off;
    };
    let corners = surface.triangle(face).unwrap_or_default();
    match corners.iter().position(|&[x, y, _]| [x, y] == q) {
        Some(corner) => At::Vertex { face, corner },
        None => At::Edge {
            face,
            corner: usize::from(corner),
        },
    }
}

/// Returns false if a segment certainly does not meet a box.
fn may_meet(extent: &Extent, segment: &Segment) -> bool {
    let Extent { min, max } = *extent;
    let (a, b) = (segment.from, segment.to);
    if (0..2).any(|k| a[k].max(b[k]) < min[k] || max[k] < a[k].min(b[k])) {
        return false;
    }
    let direction = [0, 1].map(|k| b[k] - a[k]);
    let half = [0, 1].map(|k| max[k] / 2.0 - min[k] / 2.0);
    let middle = [0, 1].map(|k| min[k] / 2.0 + max[k] / 2.0 - a[k]);
    let side = direction[0] * middle[1] - direction[1] * middle[0];
    let reach = direction[0].abs() * half[1] + direction[1].abs() * half[0];
    // Larger than all rounding errors.
    let corners = [a, b, min, max];
    let largest = corners
        .iter()
        .flatten()
        .fold(0.0, |most: f64, c| most.max(c.abs()));
    let error = 32.0 * f64::EPSILON * largest * (direction[0].abs() + direction[1].abs());
    // With values that are no numbers, nothing is certain.
    let is_beside = side.abs() > reach + error;
    !is_beside
}

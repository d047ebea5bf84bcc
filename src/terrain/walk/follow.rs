//! A segment over a whole surface, with its gaps.

use super::rim::{RimEdge, entries};
use super::segment::{Event, Segment};
use super::step::{At, Stepped, Steps};
use crate::terrain::boxes::Boxes;

/// Follows a segment from where it starts, and returns where it ends. `take` receives each
/// point on the surface where the segment starts, crosses an edge, passes a vertex, comes onto
/// the surface, leaves it, or ends; and `None` where there is a gap.
pub(super) fn follow(
    steps: &mut Steps<'_>,
    rim: &Boxes<RimEdge>,
    segment: &Segment,
    start: At,
    take: &mut impl FnMut(Option<[f64; 3]>),
) -> At {
    let mut here = Event::Point(segment.from);
    let mut toward = steps.depart(start, segment);
    if toward.is_some() {
        take(steps.point(start, segment.from));
    }
    let mut ahead = None;
    loop {
        let Some(next) = toward else {
            let list = ahead.get_or_insert_with(|| entries(steps, rim, segment).into_iter());
            let entry = list.find(|entry| segment.compare(&entry.event, &here).is_ge());
            let Some(entry) = entry else {
                take(None);
                return At::Off;
            };
            if segment.compare(&entry.event, &here).is_gt() {
                take(None);
            }
            take(Some(entry.position));
            here = entry.event;
            toward = Some(entry.toward);
            continue;
        };
        match steps.step(next, segment, take) {
            Stepped::Ended(at) => return at,
            Stepped::Reached(event, next) => {
                here = event;
                toward = next;
            }
        }
    }
}

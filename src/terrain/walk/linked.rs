//! A segment over linked faces, without a search for what is beyond their rim.

use super::segment::{Event, Segment};
use super::step::{At, Stepped, Steps, Toward};
use crate::data::Surface;

/// Where a segment ends that is followed over linked faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::terrain) enum Arrival {
    /// At its end, which is here.
    End(At),
    /// Where the faces end: at an edge, with the ends that the segment has on its left and right.
    Rim([[f64; 2]; 2]),
    /// At a vertex that it passes, or it does not leave its start into a face.
    Nowhere,
}

/// Follows a segment from a known start as long as faces are linked, up to the first vertex. `take`
/// receives each point at which it crosses an edge, and its end.
///
/// The start may be rounded: if it is said to be inside of a face but lies just beyond an edge, the
/// segment begins where it enters the face.
pub(in crate::terrain) fn follow_linked(
    surface: &dyn Surface,
    start: At,
    [from, to]: [[f64; 2]; 2],
    mut take: impl FnMut([f64; 3]),
) -> Arrival {
    let Some(segment) = Segment::new(from, to) else {
        return Arrival::End(start);
    };
    let mut steps = Steps::new(surface);
    let mut take = |point: Option<[f64; 3]>| point.into_iter().for_each(&mut take);
    let mut toward = steps.depart(start, &segment);
    loop {
        let stepped = match toward {
            Some(Toward::Edge(mut exit)) => loop {
                let across = steps.across(&exit);
                let stepped = steps.cross(&mut exit, across.as_ref(), &segment, &mut take);
                if let Some(stepped) = stepped {
                    break stepped;
                }
            },
            Some(Toward::Vertex {
                face,
                corner,
                along,
            }) => steps.reach(face, corner, along, &segment, &mut take),
            None => return Arrival::Nowhere,
        };
        match stepped {
            Stepped::Ended(at) => return Arrival::End(at),
            Stepped::Reached(Event::Crossing(edge), None) => return Arrival::Rim(edge),
            Stepped::Reached(Event::Crossing(_), next) => toward = next,
            Stepped::Reached(Event::Point(_), _) => return Arrival::Nowhere,
        }
    }
}

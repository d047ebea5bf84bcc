//! A segment over a whole surface, with its gaps.

use super::rim::{Entry, RimEdge, entries};
use super::segment::{Event, Segment};
use super::step::{At, Exit, Stepped, Steps, Toward};
use crate::data::FaceAcross;
use crate::terrain::boxes::Boxes;

/// A segment that is followed, from edge to edge.
///
/// What takes points receives each one on the surface where the segment starts, crosses an edge,
/// passes a vertex, comes onto the surface, leaves it, or ends; and `None` where there is a gap.
pub(super) struct Follow {
    segment: Segment,
    here: Event,
    toward: Option<Toward>,
    /// Where the segment comes onto the surface, once that was asked.
    ahead: Option<std::vec::IntoIter<Entry>>,
}

impl Follow {
    /// Begins a segment where it starts.
    pub(super) fn new(
        steps: &mut Steps<'_>,
        segment: Segment,
        start: At,
        take: &mut impl FnMut(Option<[f64; 3]>),
    ) -> Self {
        let toward = steps.depart(start, &segment);
        if toward.is_some() {
            take(steps.point(start, segment.from));
        }
        Follow {
            segment,
            here: Event::Point(segment.from),
            toward,
            ahead: None,
        }
    }

    /// Goes on to the next edge that the segment crosses.
    ///
    /// # Errors
    /// Returns where the segment ends, if it crosses none.
    pub(super) fn next_edge(
        &mut self,
        steps: &mut Steps<'_>,
        rim: &Boxes<RimEdge>,
        take: &mut impl FnMut(Option<[f64; 3]>),
    ) -> Result<Exit, At> {
        let segment = &self.segment;
        loop {
            match self.toward {
                Some(Toward::Edge(exit)) => return Ok(exit),
                Some(Toward::Vertex {
                    face,
                    corner,
                    along,
                }) => match steps.reach(face, corner, along, segment, take) {
                    Stepped::Ended(at) => return Err(at),
                    Stepped::Reached(event, next) => (self.here, self.toward) = (event, next),
                },
                None => {
                    let list = self
                        .ahead
                        .get_or_insert_with(|| entries(steps, rim, segment).into_iter());
                    let here = &self.here;
                    let entry = list.find(|entry| segment.compare(&entry.event, here).is_ge());
                    let Some(entry) = entry else {
                        take(None);
                        return Err(At::Off);
                    };
                    if segment.compare(&entry.event, here).is_gt() {
                        take(None);
                    }
                    take(Some(entry.position));
                    (self.here, self.toward) = (entry.event, Some(entry.toward));
                }
            }
        }
    }

    /// Goes over an edge, beyond which is a face, to the one that comes next. Returns true if that
    /// is in this face; else [`next_edge`](Self::next_edge) goes on.
    ///
    /// # Errors
    /// Returns where the segment ends, if it ends before.
    #[inline]
    pub(super) fn cross(
        &mut self,
        exit: &mut Exit,
        across: Option<&FaceAcross>,
        steps: &mut Steps<'_>,
        take: &mut impl FnMut(Option<[f64; 3]>),
    ) -> Result<bool, At> {
        match steps.cross(exit, across, &self.segment, take) {
            None => Ok(true),
            Some(Stepped::Ended(at)) => Err(at),
            Some(Stepped::Reached(event, next)) => {
                (self.here, self.toward) = (event, next);
                Ok(false)
            }
        }
    }

    /// Goes on to the end of the segment, and returns where it ends.
    pub(super) fn go_to_end(
        mut self,
        steps: &mut Steps<'_>,
        rim: &Boxes<RimEdge>,
        take: &mut impl FnMut(Option<[f64; 3]>),
    ) -> At {
        loop {
            let mut exit = match self.next_edge(steps, rim, take) {
                Ok(exit) => exit,
                Err(at) => break at,
            };
            let ended = loop {
                let across = steps.across(&exit);
                match self.cross(&mut exit, across.as_ref(), steps, take) {
                    Ok(true) => {}
                    ended => break ended,
                }
            };
            if let Err(at) = ended {
                break at;
            }
        }
    }
}

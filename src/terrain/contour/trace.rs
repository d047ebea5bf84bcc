use super::cut::{ContourArc, Cut, Direction, Face, Node};
use crate::data::Surface;
use rustc_hash::FxHashSet;

/// A line of one level, joined as far as faces are linked.
pub(super) enum Trace {
    /// The last point equals the first.
    Closed(Vec<[f64; 2]>),
    /// Begins and ends at the edge of the data.
    Open { points: Vec<[f64; 2]>, start: Option<LooseEnd>, end: Option<LooseEnd> },
}

/// All lines of a level.
pub(super) struct Traces {
    pub(super) traces: Vec<Trace>,
    /// True if the crossing of an edge was rounded to one of its ends.
    pub(super) touches_vertices: bool,
}

/// An end of a line at a vertex. The line may continue beyond the gap in the data.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct LooseEnd {
    pub(super) vertex: u32,
    /// A neighboring vertex in the same fan of faces, for the order of lines around the vertex.
    pub(super) toward: u32,
}

/// The set of arcs that are already part of a line: one bit per face. Each thread reuses its own
/// set, which is empty between levels.
pub(super) struct Done {
    across: Vec<u64>,
    /// A hash set, because arcs along edges are rare: they need an edge on the level.
    along: FxHashSet<(u32, u8)>,
}

impl Done {
    pub(super) fn new(face_count: usize) -> Self {
        Done { across: vec![0; face_count.div_ceil(64)], along: FxHashSet::default() }
    }

    /// Adds an arc; returns false if the set contains it already.
    fn insert(&mut self, arc: ContourArc) -> bool {
        match arc {
            ContourArc::Along(face, i) => self.along.insert((face, i)),
            ContourArc::Across(face) => {
                let (word, bit) = (&mut self.across[face as usize / 64], 1 << (face % 64));
                let new = *word & bit == 0;
                *word |= bit;
                new
            }
        }
    }

    fn clear(&mut self, arcs: &[ContourArc]) {
        self.along.clear();
        for arc in arcs {
            self.across[arc.face() as usize / 64] = 0;
        }
    }
}

/// Joins the arcs of a level to lines. Each arc must be given once.
pub(super) fn trace<S: Surface + ?Sized>(cut: &Cut<'_, S>, arcs: &[ContourArc], done: &mut Done) -> Traces {
    let mut tracer = Tracer { cut, done, touches_vertices: false };
    let traces = arcs.iter().filter_map(|&seed| tracer.line_of(seed)).collect();
    let touches_vertices = tracer.touches_vertices;
    done.clear(arcs);
    Traces { traces, touches_vertices }
}

struct Tracer<'t, 'a, S: ?Sized> {
    cut: &'t Cut<'a, S>,
    done: &'t mut Done,
    touches_vertices: bool,
}

enum Stop {
    /// Back at the first arc.
    Seed,
    /// At the edge of the data.
    Data(Option<LooseEnd>),
}

impl<S: Surface + ?Sized> Tracer<'_, '_, S> {
    /// The line that contains an arc, unless it was found before.
    fn line_of(&mut self, seed: ContourArc) -> Option<Trace> {
        if !self.done.insert(seed) {
            return None;
        }
        let face = self.cut.face(seed.face())?;
        let mut after = Vec::new();
        Some(match self.follow(face, seed, Direction::Forward, &mut after) {
            Stop::Seed => {
                after.extend_from_within(..1);
                Trace::Closed(after)
            }
            Stop::Data(end) => {
                let mut points = Vec::new();
                let start = match self.follow(face, seed, Direction::Backward, &mut points) {
                    Stop::Data(start) => start,
                    // Impossible: the forward search would have come here as well.
                    Stop::Seed => None,
                };
                points.reverse();
                points.append(&mut after);
                Trace::Open { points, start, end }
            }
        })
    }

    /// Follows arcs from the seed as far as possible; adds the far node of each arc.
    fn follow(&mut self, mut face: Face, seed: ContourArc, direction: Direction, points: &mut Vec<[f64; 2]>) -> Stop {
        let mut arc = seed;
        loop {
            let node = face.node(arc, direction);
            let point = self.cut.point(&face, node);
            points.push(point);
            let next = match node {
                Node::Edge(i) => {
                    self.touches_vertices |= face.ends_at(i, point);
                    self.cut.across(&face, i).map(|(next, _)| (next, ContourArc::Across(next.id)))
                }
                Node::Corner(i) => self.cut.continuation(&face, i, direction).map(|ray| (ray.face, ray.arc)),
            };
            match next {
                Some((next, next_arc)) if self.done.insert(next_arc) => (face, arc) = (next, next_arc),
                Some((_, next_arc)) if next_arc == seed => return Stop::Seed,
                // `Some` occurs only if the links between faces contradict each other.
                Some(_) | None => {
                    return Stop::Data(match node {
                        Node::Edge(_) => None,
                        Node::Corner(i) => {
                            Some(LooseEnd { vertex: face.vertices[i], toward: face.vertices[(i + 1) % 3] })
                        }
                    });
                }
            }
        }
    }
}

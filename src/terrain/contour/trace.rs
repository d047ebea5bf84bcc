use super::cut::{ContourArc, Cut, Direction, Face, Node};
use crate::data::Surface;
use rustc_hash::FxHashSet;

/// Pieces of one level, joined as far as the links between faces lead.
pub(super) enum Trace {
    /// The last point is the first.
    Closed(Vec<[f64; 2]>),
    /// Begins and ends at the edge of the data.
    Open { points: Vec<[f64; 2]>, start: Option<LooseEnd>, end: Option<LooseEnd> },
}

/// All lines of a level.
pub(super) struct Traces {
    pub(super) traces: Vec<Trace>,
    /// Whether the crossing of an edge was rounded to one of its ends.
    pub(super) touches_vertices: bool,
}

/// An end at a vertex. The line may go on beyond the gap in the data.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct LooseEnd {
    pub(super) vertex: u32,
    /// A neighboring vertex in the same fan of faces: says where around the vertex the line is.
    pub(super) toward: u32,
}

/// Pieces that are part of a line already. One bit a face, kept from level to level by the thread
/// that owns it, and empty between levels.
pub(super) struct Done {
    across: Vec<u64>,
    /// Few: they need an edge on the level.
    along: FxHashSet<(u32, u8)>,
}

impl Done {
    pub(super) fn new(face_count: usize) -> Self {
        Done { across: vec![0; face_count.div_ceil(64)], along: FxHashSet::default() }
    }

    /// Adds a piece; false if it was there.
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

/// Joins the pieces of a level, each of which is given once.
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
    /// Back at the piece that it began with.
    Seed,
    /// At the edge of the data.
    Data(Option<LooseEnd>),
}

impl<S: Surface + ?Sized> Tracer<'_, '_, S> {
    /// The line that a piece is part of, unless it was found before.
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
                    // Not possible: forward would have come here too.
                    Stop::Seed => None,
                };
                points.reverse();
                points.append(&mut after);
                Trace::Open { points, start, end }
            }
        })
    }

    /// Goes from the seed as far as it leads; adds the far node of each piece.
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
                // The first of these only if the links between faces contradict each other.
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

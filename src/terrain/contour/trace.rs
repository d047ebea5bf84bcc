use super::cut::{Cut, Face, Node, Piece, Way};
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
    fn insert(&mut self, piece: Piece) -> bool {
        match piece {
            Piece::Along(face, i) => self.along.insert((face, i)),
            Piece::Across(face) => {
                let (word, bit) = (&mut self.across[face as usize / 64], 1 << (face % 64));
                let new = *word & bit == 0;
                *word |= bit;
                new
            }
        }
    }

    fn clear(&mut self, pieces: &[Piece]) {
        self.along.clear();
        for piece in pieces {
            self.across[piece.face() as usize / 64] = 0;
        }
    }
}

/// Joins the pieces of a level, each of which is given once.
pub(super) fn trace<S: Surface + ?Sized>(cut: &Cut<'_, S>, pieces: &[Piece], done: &mut Done) -> Traces {
    let mut tracer = Tracer { cut, done, touches_vertices: false };
    let traces = pieces.iter().filter_map(|&seed| tracer.line_of(seed)).collect();
    let touches_vertices = tracer.touches_vertices;
    done.clear(pieces);
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
    fn line_of(&mut self, seed: Piece) -> Option<Trace> {
        if !self.done.insert(seed) {
            return None;
        }
        let face = self.cut.face(seed.face())?;
        let mut after = Vec::new();
        Some(match self.follow(face, seed, Way::Forward, &mut after) {
            Stop::Seed => {
                after.extend_from_within(..1);
                Trace::Closed(after)
            }
            Stop::Data(end) => {
                let mut points = Vec::new();
                let start = match self.follow(face, seed, Way::Backward, &mut points) {
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
    fn follow(&mut self, mut face: Face, seed: Piece, way: Way, points: &mut Vec<[f64; 2]>) -> Stop {
        let mut piece = seed;
        loop {
            let node = face.node(piece, way);
            let point = self.cut.point(&face, node);
            points.push(point);
            let next = match node {
                Node::Edge(i) => {
                    self.touches_vertices |= face.ends_at(i, point);
                    self.cut.across(&face, i).map(|(next, _)| (next, Piece::Across(next.id)))
                }
                Node::Corner(i) => self.cut.continuation(&face, i, way).map(|ray| (ray.face, ray.piece)),
            };
            match next {
                Some((next, next_piece)) if self.done.insert(next_piece) => (face, piece) = (next, next_piece),
                Some((_, next_piece)) if next_piece == seed => return Stop::Seed,
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

use super::cut::{Cut, Face, Node, Piece, Way};
use crate::data::Surface;
use std::collections::HashSet;

/// Pieces of one level, joined as far as the links between faces lead.
pub(super) enum Trace {
    /// The last point is the first.
    Closed(Vec<[f64; 2]>),
    /// Begins and ends at the edge of the data.
    Open { points: Vec<[f64; 2]>, start: Option<LooseEnd>, end: Option<LooseEnd> },
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
    along: HashSet<(u32, u8)>,
}

impl Done {
    pub(super) fn new(face_count: usize) -> Self {
        Done { across: vec![0; face_count.div_ceil(64)], along: HashSet::new() }
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
pub(super) fn trace<S: Surface + ?Sized>(cut: &Cut<'_, S>, pieces: &[Piece], done: &mut Done) -> Vec<Trace> {
    let mut traces = Vec::new();
    for &seed in pieces {
        if !done.insert(seed) {
            continue;
        }
        let Some(face) = cut.face(seed.face()) else { continue };
        let mut after = Vec::new();
        traces.push(match follow(cut, face, seed, Way::Forward, &mut after, done) {
            Stop::Seed => {
                after.extend_from_within(..1);
                Trace::Closed(after)
            }
            Stop::Data(end) => {
                let mut points = Vec::new();
                let start = match follow(cut, face, seed, Way::Backward, &mut points, done) {
                    Stop::Data(start) => start,
                    // Not possible: forward would have come here too.
                    Stop::Seed => None,
                };
                points.reverse();
                points.append(&mut after);
                Trace::Open { points, start, end }
            }
        });
    }
    done.clear(pieces);
    traces
}

enum Stop {
    /// Back at the piece that it began with.
    Seed,
    /// At the edge of the data.
    Data(Option<LooseEnd>),
}

/// Goes from the seed as far as it leads; adds the far node of each piece.
fn follow<S: Surface + ?Sized>(
    cut: &Cut<'_, S>,
    mut face: Face,
    seed: Piece,
    way: Way,
    points: &mut Vec<[f64; 2]>,
    done: &mut Done,
) -> Stop {
    let mut piece = seed;
    loop {
        let node = face.node(piece, way);
        points.push(cut.point(&face, node));
        let next = match node {
            Node::Edge(i) => cut.across(&face, i).map(|(next, _)| (next, Piece::Across(next.id))),
            Node::Corner(i) => cut.continuation(&face, i, way).map(|ray| (ray.face, ray.piece)),
        };
        match next {
            Some((next, next_piece)) if done.insert(next_piece) => (face, piece) = (next, next_piece),
            Some((_, next_piece)) if next_piece == seed => return Stop::Seed,
            // The first of these only if the links between faces contradict each other.
            Some(_) | None => {
                return Stop::Data(match node {
                    Node::Edge(_) => None,
                    Node::Corner(i) => Some(LooseEnd { vertex: face.vertices[i], toward: face.vertices[(i + 1) % 3] }),
                });
            }
        }
    }
}

use super::cut::{Beyond, ContourArc, Direction, Face, LevelCut, Node, PassedEdge};
use super::find::LevelArcs;
use super::index::LevelIndex;
use crate::data::Surface;
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use std::ops::Range;

/// A line of one level, joined as far as faces are linked.
pub(super) enum Trace {
    /// The last point equals the first.
    Closed(Vec<[f64; 2]>),
    /// Begins and ends at the edge of the data.
    Open {
        points: Vec<[f64; 2]>,
        ends: [LooseEnd; 2],
    },
}

/// All lines of a level.
pub(super) struct Traces {
    pub(super) traces: Vec<Trace>,
    /// True if the crossing of an edge was rounded to one of its ends.
    pub(super) touches_vertices: bool,
}

/// The first or last node of an open line, where it meets the edge of the data.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum LooseEnd {
    /// On the edge between two vertices, which has one face only.
    Edge([u32; 2]),
    /// At a vertex. The line may continue beyond the gap in the data.
    Vertex {
        vertex: u32,
        /// A neighboring vertex, for the order of lines around the vertex: the other end of an arc
        /// along an edge; for an arc across a face, the corner of the face clockwise from it.
        toward: u32,
    },
}

/// The set of arcs that are already part of a line: one bit per face. Each thread reuses its own
/// set, which is empty between levels.
struct Done {
    across: Vec<u64>,
    /// A hash set, because arcs along edges are rare: they need an edge on the level.
    along: FxHashSet<(u32, u8)>,
}

impl Done {
    fn new(face_count: usize) -> Self {
        Done {
            across: vec![0; face_count.div_ceil(64)],
            along: FxHashSet::default(),
        }
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

/// Joins the arcs of each level to lines, and maps these by `finish`. Levels are traced in
/// parallel.
pub(super) fn each_level<S: Surface + ?Sized, T: Send>(
    surface: &S,
    index: &LevelIndex,
    band: Range<usize>,
    arcs: &LevelArcs,
    finish: impl Fn(f64, Traces) -> T + Sync,
) -> Vec<T> {
    let traced = |done: &mut Done, at: usize| {
        let level = index.levels()[at];
        finish(
            level,
            trace(&LevelCut { surface, level }, arcs.of(at), done),
        )
    };
    band.into_par_iter()
        .map_init(|| Done::new(surface.face_count()), traced)
        .collect()
}

/// Joins the arcs of a level to lines. Each arc must be given once.
fn trace<S: Surface + ?Sized>(
    cut: &LevelCut<'_, S>,
    arcs: &[ContourArc],
    done: &mut Done,
) -> Traces {
    let mut tracer = Tracer {
        cut,
        done,
        touches_vertices: false,
    };
    let traces = arcs
        .iter()
        .filter_map(|&seed| tracer.line_of(seed))
        .collect();
    let touches_vertices = tracer.touches_vertices;
    done.clear(arcs);
    Traces {
        traces,
        touches_vertices,
    }
}

struct Tracer<'t, 'a, S: ?Sized> {
    cut: &'t LevelCut<'a, S>,
    done: &'t mut Done,
    touches_vertices: bool,
}

impl<S: Surface + ?Sized> Tracer<'_, '_, S> {
    /// The line that contains an arc, unless it was found before.
    fn line_of(&mut self, seed: ContourArc) -> Option<Trace> {
        if !self.done.insert(seed) {
            return None;
        }
        let face = self.cut.face(seed.face())?;
        let mut after = Vec::new();
        let Some(end) = self.follow(face, seed, Direction::Forward, &mut after) else {
            after.extend_from_within(..1);
            return Some(Trace::Closed(after));
        };
        let mut points = Vec::new();
        // It comes back to the seed only if the links between faces contradict each other: else the
        // forward search would have.
        let start = self
            .follow(face, seed, Direction::Backward, &mut points)
            .unwrap_or(end);
        points.reverse();
        points.append(&mut after);
        Some(Trace::Open {
            points,
            ends: [start, end],
        })
    }

    /// Follows arcs from the seed as far as possible; adds the far node of each arc. Returns where
    /// the data ends, or `None` at the seed.
    fn follow(
        &mut self,
        mut face: Face,
        seed: ContourArc,
        direction: Direction,
        points: &mut Vec<[f64; 2]>,
    ) -> Option<LooseEnd> {
        let mut arc = seed;
        loop {
            let node = face.node(arc, direction);
            let point = self.cut.point(&face, node);
            points.push(point);
            let i = match node {
                Node::Corner(i) => i,
                Node::Edge(i) => {
                    let edge = face.edge(i);
                    self.touches_vertices |= edge.ends_at(point);
                    match self.pass_edges(edge, seed, direction, points) {
                        Passage::Corner(next) => {
                            (face, arc) = (next, ContourArc::Across(next.id));
                            continue;
                        }
                        Passage::End(end) => return end,
                    }
                }
            };
            match self.cut.continuation(&face, i, direction) {
                Some(ray) if self.done.insert(ray.arc) => (face, arc) = (ray.face, ray.arc),
                Some(ray) if ray.arc == seed => return None,
                // `Some` occurs only if the links between faces contradict each other.
                Some(_) | None => return Some(face.loose_end(arc, i)),
            }
        }
    }

    /// Follows arcs beyond an edge, from edge to edge.
    ///
    /// `PERF:` most arcs are followed here, with one corner of each face.
    fn pass_edges(
        &mut self,
        mut edge: PassedEdge,
        seed: ContourArc,
        direction: Direction,
        points: &mut Vec<[f64; 2]>,
    ) -> Passage {
        loop {
            let loose = LooseEnd::Edge(edge.vertices);
            let Some(beyond) = self.cut.pass(&edge, direction) else {
                return Passage::End(Some(loose));
            };
            let (Beyond::Edge(PassedEdge { face, .. }) | Beyond::Corner(face)) = beyond;
            let arc = ContourArc::Across(face);
            if !self.done.insert(arc) {
                // This is the seed, unless the links between faces contradict each other.
                return Passage::End((arc != seed).then_some(loose));
            }
            match beyond {
                Beyond::Edge(next) => {
                    let point = self.cut.point_on(&next);
                    self.touches_vertices |= next.ends_at(point);
                    points.push(point);
                    edge = next;
                }
                Beyond::Corner(face) => {
                    let face = self.cut.face(face);
                    return face.map_or(Passage::End(Some(loose)), Passage::Corner);
                }
            }
        }
    }
}

/// Where arcs that are followed from edge to edge stop.
enum Passage {
    /// In this face, at the corner on the level.
    Corner(Face),
    /// At the edge of the data; `None` at the seed, where the line is closed.
    End(Option<LooseEnd>),
}

impl Face {
    /// Returns the loose end of an arc at corner `i`, where the faces end.
    fn loose_end(&self, arc: ContourArc, i: usize) -> LooseEnd {
        let toward = match arc {
            ContourArc::Along(_, opposite) => 3 - i - usize::from(opposite),
            ContourArc::Across(_) => (i + 1) % 3,
        };
        LooseEnd::Vertex {
            vertex: self.vertices[i],
            toward: self.vertices[toward],
        }
    }
}

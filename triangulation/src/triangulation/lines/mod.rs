//! Lines: constraints that may cross, have ids, and are edited.
//!
//! [`Lines`] owns all that a constrained Delaunay triangulation knows of them beyond the marks on edges: the vertices by
//! which each line was given, the chain of each segment, and which vertices are there for lines only. Nothing outside
//! of this folder changes it but by its methods.
//!
//! | file | holds |
//! |---|---|
//! | `paths` | ids of lines, chains of segments |
//! | `build` | points and lines, triangulated at once |
//! | `edit` | lines and points added and removed |
//! | `local`, `near` | what an edit changes, followed from where it is; what lies near a segment |
//! | `index` | which segments run along an edge, which lines have them |
//! | `rearrange` | all lines arranged anew |
//! | `constrain` | one sub-constraint, put in and taken out |
//! | `trace`, `corridor` | a sub-constraint made an edge: what it crosses, and the triangles on both of its sides |
//! | `parts` | the tables in a form to be saved |
//! | `check` | what the tables claim, checked |
//! | `simplify`, `nesting` | lines with fewer vertices; what lines enclose |

pub(super) mod build;
mod check;
pub(super) mod constrain;
mod corridor;
pub(super) mod edit;
mod index;
mod local_edit;
mod near_segment;
mod nesting;
pub(super) mod paths;
mod rearrange;
#[cfg(test)]
mod removal_tests;
#[cfg(feature = "serde")]
pub(super) mod saved_tables;
mod simplify;
pub(super) mod trace;
mod vertex_set;

pub use check::LinesFlaw;

use std::sync::OnceLock;

use crate::tds::VertexId;

use build::Rounding;
use index::Index;
use paths::Paths;
use trace::Scratch;
use vertex_set::VertexSet;

/// The lines of a triangulation: the owner of what holds its constrained edges.
///
/// # Invariants
/// What [`check`](Self::check) asks for:
/// - the chain of each segment consists of constrained edges, and the tables name nothing else;
/// - vertices that were added for crossings are on constraints, and no line was given by them;
/// - vertices that are owned are named by lines;
/// - segments wait for triangles only while there are none.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines {
    paths: Paths,
    /// Segments among collinear points, which no triangle can hold yet.
    waiting: Vec<[VertexId; 2]>,
    /// Vertices added where segments cross.
    added: VertexSet,
    /// The same as a list, once that was asked for.
    added_list: OnceLock<Vec<VertexId>>,
    /// Vertices that came with lines, and go with the last of them.
    owned: VertexSet,
    /// Made when it is first asked for; to be taken out when more changes than it is told.
    index: OnceLock<Index>,
    /// How many times all lines were arranged anew.
    rearrangements: usize,
    /// Sub-constraints that are not there whole, since others block them.
    missing: Vec<[VertexId; 2]>,
    /// How the crossings were rounded, if there are any.
    rounding: Option<Rounding>,
    /// Whether sub-constraints crossed after they had been arranged, possible off the grid only, and were arranged
    /// again.
    recrossed: bool,
    scratch: Scratch,
}

impl Lines {
    /// Records that a vertex splits an edge: a sub-constraint, or a part of one.
    pub(super) fn split_edge(&mut self, a: VertexId, b: VertexId, at: VertexId) {
        if let Some(index) = self.index.get_mut() {
            index.split(&self.paths, paths::undirected(a, b), at);
        }
        self.paths.split(a, b, at);
    }

    /// The vertices added where segments cross, in order.
    pub(super) fn added(&self) -> &[VertexId] {
        self.added_list.get_or_init(|| self.added.iter().collect())
    }

    /// Forgets what was derived of the vertices that were added.
    fn touch(&mut self) {
        self.added_list.take();
    }
}

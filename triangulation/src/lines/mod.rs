//! Lines: constraints that may cross, have ids, and can be edited.
//!
//! [`Lines`] owns everything that a constrained Delaunay triangulation stores of its lines, except
//! for the marks on edges: the vertices by which each line was given, the chain of each segment,
//! and which vertices exist for lines only. Outside of this folder it is changed by its methods
//! only.
//!
//! | file | contains |
//! |---|---|
//! | `constrained_delaunay` | the kind that owns lines |
//! | `paths` | line ids, chains of segments |
//! | `build` | bulk construction from points and lines |
//! | `edit` | insertion and removal of lines |
//! | `points` | insertion, removal and moves of points |
//! | `local_edit`, `near_segment` | the consequences of one edit, in its neighborhood; what lies near a segment |
//! | `change` | where the old and the new chain of a segment differ |
//! | `index` | which segments run along an edge, which lines contain them |
//! | `rearrange` | a new arrangement of all lines |
//! | `constrain` | insertion and removal of one sub-constraint |
//! | `saved_tables` | the tables in a form to be saved |
//! | `check` | checks of what the tables claim |
//! | `simplify`, `nesting` | lines with fewer vertices; what lines enclose |
//! | `vertex_set` | a set of vertices |

pub(crate) mod build;
mod change;
mod check;
pub(crate) mod constrain;
pub(crate) mod constrained_delaunay;
pub(crate) mod edit;
mod index;
mod local_edit;
mod near_segment;
mod nesting;
pub(crate) mod paths;
mod points;
mod rearrange;
#[cfg(test)]
mod removal_tests;
#[cfg(feature = "serde")]
pub(crate) mod saved_tables;
mod simplify;
mod vertex_set;

pub use build::{OnCrossing, Rounding};
pub use constrained_delaunay::{ConstrainedDelaunay, ConstrainedDelaunay2};

use std::sync::OnceLock;

use crate::engine::trace::Scratch;
use crate::tds::VertexId;
use index::Index;
use paths::Paths;
use vertex_set::VertexSet;

/// The lines of a triangulation: the owner of its constraints.
///
/// # Invariants
/// [`check`](Self::check) tests these:
/// - the chain of each segment consists of constrained edges, and the tables name nothing else;
/// - vertices that were added for crossings are on constraints, and no line was given by them;
/// - owned vertices are named by lines;
/// - segments wait for triangles only while there are none.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lines {
    paths: Paths,
    /// Segments among collinear points, which no triangle can hold yet.
    waiting: Vec<[VertexId; 2]>,
    /// Vertices added where segments cross.
    added: VertexSet,
    /// The vertices in `added` as a list, once it was asked for.
    added_list: OnceLock<Vec<VertexId>>,
    /// Vertices owned by lines, removed with the last of them.
    owned: VertexSet,
    /// Computed on first use; removed by changes that do not update it.
    index: OnceLock<Index>,
    /// How many times all lines were arranged anew.
    rearrangements: usize,
    /// Sub-constraints that could not be inserted completely, because others block them.
    missing: Vec<[VertexId; 2]>,
    /// How the crossings were rounded, if there are any.
    rounding: Option<Rounding>,
    /// True if sub-constraints crossed after they had been arranged, which is possible off the grid
    /// only, and were arranged again.
    recrossed: bool,
    /// True if constrained edges may belong to no line: those of the hull of a refined mesh.
    has_stray_edges: bool,
    scratch: Scratch,
}

impl Lines {
    /// Records that a vertex splits an edge: a sub-constraint, or a part of one.
    pub(crate) fn split_edge(&mut self, a: VertexId, b: VertexId, at: VertexId) {
        if let Some(index) = self.index.get_mut() {
            index.split(&self.paths, paths::undirected(a, b), at);
        }
        self.paths.split(a, b, at);
    }

    /// Records that constrained edges may belong to no line.
    pub(crate) fn expect_stray_edges(&mut self) {
        self.has_stray_edges = true;
    }

    /// Forgets splits of constrained edges that belong to no line.
    ///
    /// `PERF:` all splits are copied, so that this is done only if there can be such edges.
    pub(crate) fn drop_stray_splits(&mut self) {
        if self.has_stray_edges {
            self.paths.drop_stray_splits();
        }
    }

    /// Returns the vertices added where segments cross, in order.
    pub(crate) fn added(&self) -> &[VertexId] {
        self.added_list.get_or_init(|| self.added.iter().collect())
    }

    /// Returns how many triangles all insertions of sub-constraints have met.
    #[cfg(test)]
    pub(crate) fn met(&self) -> usize {
        self.scratch.met
    }

    /// Discards what was derived from the set of added vertices.
    fn touch(&mut self) {
        self.added_list.take();
    }
}

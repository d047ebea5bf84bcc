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
//! | `tables` | what is stored of lines: [`Lines`] |
//! | `chains` | the vertices by which lines were given, and the chains of their segments |
//! | `ids` | lines by their ids |
//! | `on_crossing` | what becomes of crossings |
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
//! | `mesh`, `vertex_set` | the triangulation that lines are in; a set of vertices |

mod build;
mod chains;
mod change;
mod check;
mod constrain;
mod constrained_delaunay;
mod edit;
mod ids;
mod index;
mod local_edit;
mod mesh;
mod near_segment;
mod nesting;
mod on_crossing;
mod points;
mod rearrange;
#[cfg(test)]
mod removal_tests;
#[cfg(feature = "serde")]
pub(crate) mod saved_tables;
mod simplify;
mod tables;
mod vertex_set;

pub use constrained_delaunay::{ConstrainedDelaunay, ConstrainedDelaunay2};
pub use on_crossing::{OnCrossing, Rounding};
#[cfg(feature = "serde")]
pub(crate) use tables::Lines;

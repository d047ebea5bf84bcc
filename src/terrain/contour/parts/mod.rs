//! Contours of a surface that is larger than memory, from the tasks that find its triangles.
//!
//! Each task of [`tiles`](crate::terrain::tiles) emits some triangles of the whole. A
//! [`ContourCollector`] in the task turns them into [`ContourParts`]: lines, as far as the
//! triangles of the task decide them, and what is needed to continue them. [`join_level`] joins the
//! parts of one level from all tasks. **The lines are those of [`contours`](super::contours) for
//! the whole surface, bit for bit**, however its triangles are split into tasks.
//!
//! ```
//! use breakline::terrain::contour::parts::{BendFinder, ContourCollector, StoredParts, join_level};
//! use breakline::terrain::{Levels, tiles};
//!
//! # fn main() -> breakline::Result<()> {
//! let levels = Levels::every(1.0, 0.0)?;
//! // A task: its parts go to a file.
//! let mut collector = ContourCollector::new(&levels);
//! let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 2.0], [0.0, 4.0, 0.0]];
//! tiles::leaf(&tiles::Tile::PLANE, 0, &points, &[], 0.0, &mut |triangle| collector.add(&triangle))?;
//! let mut file = Vec::new();
//! collector.finish()?.write(&mut file)?;
//!
//! // When all tasks are done: one level at a time, twice.
//! let tasks = [StoredParts::new(&file)?];
//! let low = tasks.iter().map(|task| task.heights()[0]).fold(f64::INFINITY, f64::min);
//! let high = tasks.iter().map(|task| task.heights()[1]).fold(f64::NEG_INFINITY, f64::max);
//! let parts_of = |level: f64| -> breakline::Result<Vec<_>> {
//!     tasks.iter().filter_map(|task| task.level(level).transpose()).collect()
//! };
//! let mut finder = BendFinder::default();
//! for level in levels.within(low, high)? {
//!     finder.add(level, parts_of(level)?)?;
//! }
//! let bends = finder.finish();
//! let mut lines = Vec::new();
//! for level in levels.within(low, high)? {
//!     lines.extend(join_level(level, parts_of(level)?, &bends)?);
//! }
//! assert_eq!(lines.len(), 1);
//! assert_eq!(lines[0].points, [[2.0, 0.0], [2.0, 2.0]]);
//! # Ok(())
//! # }
//! ```
//!
//! # Why the lines are the same
//!
//! [`contours`](super::contours) decides four things. Each is the same from parts:
//!
//! 1. *Which arcs there are.* An arc across a face depends on this face alone. An arc along an edge
//!    on the level depends on both faces of the edge. A task that has one of them hands on the side
//!    that it knows; where both sides are known, the rule decides. A side whose opposite is in no
//!    task lies at the edge of the data, and makes no arc. The crossing of an edge is computed from
//!    its smaller end, so that all tasks get the same bits.
//! 2. *Which arcs follow each other.* At the crossing of an edge there are two arcs at most. At a
//!    vertex, a task joins an arriving arc with the first leaving one counter-clockwise if it has
//!    all faces in between. These two are next to each other in the circle around the vertex, so
//!    the turn rule pairs them, whatever else is in the circle, and without them the other pairs
//!    stay the same. The other ends are handed on, with the vertex and a direction: a position of
//!    another vertex, never a rounded crossing. `join_level` applies the turn rule to all of them.
//! 3. *Whether rounding shows.* `contours` joins arcs again, by coordinates, where a crossing was
//!    rounded to an end of its edge or a line falls together. The first is a property of arcs,
//!    which tasks report; the second one of whole lines, which `join_level` has. The result then
//!    depends on the set of arcs alone.
//! 4. *Where arcs are bent*, lest they cross those of other levels. Whether a face is narrow
//!    depends on this face and on all levels, not on those within the heights of a task. Tasks hand
//!    on the sites at narrow faces. A [`BendFinder`] has the arcs at all of them.
//!
//! Ends are matched by the numbers of vertices, as `contours` follows the links between faces:
//! crossings of different edges may have the same bits although no line falls together. The loop
//! rule then cuts whole lines.
//!
//! # Levels
//!
//! A task does not know the heights of the others. But each level is computed independently of the
//! range, so that tasks agree in its bits. The levels of the whole are those within the heights of
//! all tasks, as in the example; [`Levels::within`](crate::terrain::Levels::within) also returns
//! the error that `contours` would.

mod bytes;
mod collect;
mod join;
mod keyed;
mod patch;
mod rows;
#[cfg(test)]
mod tests;

pub use super::narrow::Bends;
pub use bytes::StoredParts;
pub use collect::ContourCollector;
pub use join::{BendFinder, join_level};
pub(crate) use rows::parts_of_rows;

/// What the triangles of some tasks say about the contours of the whole surface.
#[derive(Debug, Clone, PartialEq)]
pub struct ContourParts {
    heights: [f64; 2],
    /// Ascending.
    levels: Vec<LevelParts>,
}

impl ContourParts {
    /// Returns the lowest and the highest height of the triangles; without triangles, infinity and
    /// its negative.
    pub fn heights(&self) -> [f64; 2] {
        self.heights
    }

    /// Returns the parts of each level that has some, by ascending levels.
    pub fn levels(&self) -> &[LevelParts] {
        &self.levels
    }
}

/// The heights of no triangles.
const NO_HEIGHTS: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// The parts of one level.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelParts {
    level: f64,
    /// True if the crossing of an edge was rounded to one of its ends.
    touches_vertices: bool,
    /// The points of lines that are complete; the last equals the first.
    closed: Vec<Vec<[f64; 2]>>,
    open: Vec<OpenLine>,
    sides: Vec<LevelSide>,
    /// The sites at faces so narrow that arcs of other levels may cross those of this level.
    narrow: Vec<[f64; 2]>,
}

impl LevelParts {
    fn new(level: f64) -> Self {
        LevelParts {
            level,
            touches_vertices: false,
            closed: Vec::new(),
            open: Vec::new(),
            sides: Vec::new(),
            narrow: Vec::new(),
        }
    }

    /// Returns the level.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Returns the number of edges of its lines.
    pub fn edge_count(&self) -> usize {
        let lines = self
            .closed
            .iter()
            .chain(self.open.iter().map(|line| &line.points));
        lines.map(|points| points.len() - 1).sum()
    }

    /// Returns true if arcs of other levels may cross those of this level, unless they are bent:
    /// [`BendFinder`] needs its parts.
    pub fn may_bend(&self) -> bool {
        !self.narrow.is_empty()
    }

    fn is_empty(&self) -> bool {
        self.closed.is_empty()
            && self.open.is_empty()
            && self.sides.is_empty()
            && self.narrow.is_empty()
    }
}

/// A vertex, by the number of its tile and its own.
type VertexKey = [u32; 2];

/// A line that may continue in another task, with high ground on its right.
#[derive(Debug, Clone, PartialEq)]
struct OpenLine {
    points: Vec<[f64; 2]>,
    /// Where the first point is, and the last.
    ends: [LineEnd; 2],
}

/// The end of a line in the whole surface.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LineEnd {
    /// The crossing of the edge between two vertices, the smaller first.
    Edge([VertexKey; 2]),
    /// A vertex.
    Vertex {
        vertex: VertexKey,
        /// The position of a neighboring vertex, for the order of lines around the vertex.
        toward: [f64; 2],
    },
}

/// One side of an edge on the level; the face on its other side belongs to another task, or does
/// not exist.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LevelSide {
    /// The ends of the edge, counter-clockwise around the face.
    vertices: [VertexKey; 2],
    at: [[f64; 2]; 2],
    /// True if the third corner of the face is on the level or above.
    is_high: bool,
}

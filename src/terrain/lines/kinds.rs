//! The kinds of the lines of a triangulation, and of the edges on them.

use crate::data::EdgeKind;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};

/// Which of the lines that meet at a vertex has its height there: the least.
///
/// That is the one of the kind that comes first; of walls, an upper edge, so that no lower edge
/// that crosses it tilts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Precedence {
    rank: u8,
    is_lower_edge: bool,
}

impl Precedence {
    pub(crate) fn of(kind: EdgeKind) -> Self {
        Precedence {
            rank: kind.rank(),
            is_lower_edge: false,
        }
    }

    /// That of the lower edge of a wall.
    pub(crate) fn of_lower_edge() -> Self {
        Precedence {
            is_lower_edge: true,
            ..Precedence::of(EdgeKind::Wall)
        }
    }
}

/// The kind of each line of a triangulation, by its number.
#[derive(Debug, Default)]
pub(crate) struct LineKinds {
    of_lines: Vec<EdgeKind>,
    /// True if all lines are hard breaklines, so that none needs to be looked up.
    are_breaklines: bool,
}

impl LineKinds {
    pub(crate) fn new(of_lines: Vec<EdgeKind>) -> Self {
        let are_breaklines = of_lines.iter().all(|kind| *kind == EdgeKind::Breakline);
        LineKinds {
            of_lines,
            are_breaklines,
        }
    }

    pub(crate) fn of_line(&self, line: usize) -> Option<EdgeKind> {
        self.of_lines.get(line).copied()
    }

    /// Returns true if all lines are hard breaklines.
    pub(crate) fn are_breaklines(&self) -> bool {
        self.are_breaklines
    }

    /// The kind of the edge opposite corner `i` of a cell; `None` if no line runs along it.
    #[inline]
    pub(crate) fn of_edge(
        &self,
        base: &ConstrainedDelaunay<Terrain>,
        cell: CellId,
        i: usize,
    ) -> Option<EdgeKind> {
        if !base.is_constrained(cell, i) {
            None
        } else if self.are_breaklines {
            Some(EdgeKind::Breakline)
        } else {
            // A seam of a part of a surface is an edge as any other.
            Some(self.first_of(base, base.tds().edge_ends(cell, i)))
                .filter(|kind| kind.is_constrained())
        }
    }

    /// The kind of the edge between two vertices; `None` if there is none, or no line runs along
    /// it.
    pub(crate) fn between(
        &self,
        base: &ConstrainedDelaunay<Terrain>,
        [u, v]: [VertexId; 2],
    ) -> Option<EdgeKind> {
        base.tds()
            .edge(u, v)
            .and_then(|(cell, i)| self.of_edge(base, cell, i))
    }

    /// The kind that comes first among those of the lines along an edge.
    fn first_of(&self, base: &ConstrainedDelaunay<Terrain>, [u, v]: [VertexId; 2]) -> EdgeKind {
        let kinds = base
            .lines_through(u, v)
            .map(|line| self.of_lines[line.index()]);
        kinds
            .min_by_key(|kind| kind.rank())
            .unwrap_or(EdgeKind::Breakline)
    }
}

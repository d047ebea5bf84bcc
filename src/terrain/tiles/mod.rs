//! The triangulation of more points than fit into memory, from tiles, triangle for triangle, with
//! lines.
//!
//! The triangulation is a function of the points and the lines alone. So it can be computed in
//! parts: a map over tiles and a reduction over a tree of them, in which every point is read once
//! and no tile needs the points around it.
//!
//! 1. A [`leaf`] triangulates the points of a tile. A triangle whose closed circumscribed disk
//!    lies within the tile is *final*: no point of another tile can be in it.
//! 2. What may still change is the [`Residual`]: the vertices with a triangle that is not final,
//!    and the *seams*, the edges between triangles that are final and others.
//! 3. A [`merge`] triangulates the vertices of several residuals, takes away what lies on the final
//!    side of their seams, and goes on as a leaf does, with the union of the tiles.
//! 4. At the root all points are known, and every triangle is final. The residual is the hull.
//!
//! *Why.* A triangle is in the triangulation of all points if and only if no other point is in
//! conflict with it, and a point in conflict lies in the closed disk, ties included. A vertex is
//! left out only if its whole star is final: no missing triangle uses it. So each missing triangle
//! is one of the triangulation of the residual vertices, and so are the seams; of that
//! triangulation, exactly what no seam closes off is missing. No triangle is found twice.
//!
//! # Lines
//!
//! Lines come as [sub-constraints](SubConstraint) that do not cross, to all tiles that they meet. A
//! triangle is in the constrained triangulation if no sub-constraint enters it, and no vertex in
//! its disk is visible from it past the constraints. Three things follow.
//!
//! - Of the disk of a final triangle, only what is *visible* has to lie in the tile, past
//!   constraints and seams.
//! - A sub-constraint is *pending* while an end of it is not known, and no triangle that it enters
//!   or runs along is final. It goes up until both ends are vertices of one task.
//! - Seams are constraints of a merge. Without lines they are edges of the triangulation of the
//!   residual by themselves; with lines a vertex beyond one may lie in a disk and be hidden only by
//!   a line that is final and forgotten.
//!
//! *Why.* A line of sight from a missing triangle into what is final crosses a seam. So what is
//! final needs not be known beyond the seams, and what is missing is the constrained triangulation
//! of the residual vertices with the residual edges, on the open sides of the seams. A vertex on a
//! pending sub-constraint is never left out, as triangles on both sides of it wait.
//!
//! ```text
//!      leaf A      :      leaf B             A and B know the sub-constraint by its two ends;
//!   .-----------.  :  .------------.         each has one vertex of it. Until they are merged,
//!   |     p ====|==:==|=========== q         the triangles along it wait. The tiles that it
//!   '-----------'  :  '------------'         runs through without an end have it pending, too.
//! ```
//!
//! Tasks are pure functions: they may run anywhere, in any order, and be repeated. The disks are
//! computed with bounds of their errors; where these leave a doubt, a triangle goes up.
//!
//! ```
//! use breakline::data::EdgeKind;
//! use breakline::terrain::tiles::{SubConstraint, Tile, leaf, merge};
//!
//! // Two tiles, left and right of x = 10, and a breakline across.
//! let (mut left, mut right) = (Tile::PLANE, Tile::PLANE);
//! (left.max[0], right.min[0]) = (10.0, 10.0);
//! let line = SubConstraint { ends: [[2.0, 2.0], [18.0, 3.0]], kind: EdgeKind::Breakline };
//! let mut found = Vec::new();
//! let mut emit = |triangle| found.push(triangle);
//! let a = leaf(&left, 0, &[[2.0, 2.0, 5.0], [8.0, 0.0, 1.0], [9.0, 6.0, 2.0]], &[line], 0.0, &mut emit)?;
//! let b = leaf(&right, 1, &[[18.0, 3.0, 4.0], [12.0, 1.0, 1.0], [11.0, 5.0, 2.0]], &[line], 0.0, &mut emit)?;
//! merge(&Tile::PLANE, &[a, b], 0.0, &mut emit)?;
//! assert_eq!(found.iter().flat_map(|triangle| triangle.edges).filter(|&kind| kind == line.kind).count(), 2);
//! # Ok::<(), breakline::error::Error>(())
//! ```
//!
//! Sources: Isenburg, Liu, Shewchuk and Snoeyink, *Streaming computation of Delaunay
//! triangulations* (2006); Caraffa, Memari, Yirci and Bredif, *Tile & merge* (2019).

mod clip;
#[cfg(test)]
mod clip_tests;
mod disk;
mod layout;
mod lines;
#[cfg(test)]
mod lines_tests;
mod node;
mod part;
mod residual;
mod rim;
mod sub_constraint;
#[cfg(test)]
mod tests;
mod traps;
#[cfg(test)]
mod traps_tests;
mod triangle;

pub use clip::{ClipSide, TileClip};
pub use layout::{Node, Spread, TileLayout, TileStep, Work};
pub use node::{leaf, leaf_with_part, merge, merge_with_part};
pub use part::TinPart;
pub use residual::{Residual, ResidualEdge};
pub use rim::{AtRim, EdgeKey, Gate, GateSide, Rim, Waiting, has_long_edge};
pub use sub_constraint::{SubConstraint, rounding_reach};
pub use triangle::{TileTriangle, TileVertex};

/// A rectangle in plan that owns the points in it: each axis includes its lowest coordinate and
/// excludes its highest.
///
/// Tiles at the rim of the data should be infinite toward the outside: else all triangles at the
/// rim wait for points beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    /// The lowest coordinates, included.
    pub min: [f64; 2],
    /// The highest coordinates, excluded.
    pub max: [f64; 2],
}

impl Tile {
    /// All positions: the tile of the root.
    pub const PLANE: Self = Tile {
        min: [f64::NEG_INFINITY; 2],
        max: [f64::INFINITY; 2],
    };

    /// Returns true if a position is in the tile.
    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        self.min[0] <= x && x < self.max[0] && self.min[1] <= y && y < self.max[1]
    }

    /// Returns true if every position is in the tile.
    pub fn is_plane(&self) -> bool {
        *self == Tile::PLANE
    }
}

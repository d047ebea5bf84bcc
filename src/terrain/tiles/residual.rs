//! What may still change of a part of the triangulation.

use super::sub_constraint::SubConstraint;
use super::triangle::TileVertex;
use crate::data::EdgeKind;
use crate::error::{Error, Result};

/// An edge of a residual: a seam, part of a line, or both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResidualEdge {
    /// The indices of its ends among the vertices.
    pub ends: [u32; 2],
    /// True for a seam: all triangles on the left side are final.
    pub is_seam: bool,
    /// The kind of its line; [`EdgeKind::Plain`] for a seam that no line runs along.
    pub kind: EdgeKind,
}

/// What may still change of a part of the triangulation: see [the module](super).
///
/// A tile of `n` evenly spread points, with tiles all around it, has about `5.6 sqrt(n)` vertices
/// here; lines across its border may double that.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Residual {
    /// The vertices of triangles that are not final.
    pub vertices: Vec<TileVertex>,
    /// The seams, and the constrained edges of triangles that are not final.
    pub edges: Vec<ResidualEdge>,
    /// The sub-constraints with an end that is not known yet.
    pub pending: Vec<SubConstraint>,
    /// True if a line met one of the tiles. The seams then hold only as constraints.
    pub has_lines: bool,
}

impl Residual {
    /// Returns the ends of all edges: of the root, those of the hull.
    pub fn hull(&self) -> impl Iterator<Item = [TileVertex; 2]> + '_ {
        self.edges.iter().filter_map(|edge| {
            let [a, b] = edge.ends.map(|end| self.vertices.get(end as usize));
            Some([*a?, *b?])
        })
    }

    /// Returns what several parts have in common: their vertices, edges and sub-constraints.
    ///
    /// # Errors
    /// If an edge names a vertex that does not exist.
    pub(super) fn joined(parts: &[Residual]) -> Result<Self> {
        let mut all = Residual::default();
        for (number, part) in parts.iter().enumerate() {
            let count = part.vertices.len();
            if let Some(end) = part
                .edges
                .iter()
                .flat_map(|edge| edge.ends)
                .find(|&end| end as usize >= count)
            {
                return Err(Error::format(format!(
                    "an edge of part {number} ends at vertex {end}, expected less than {count}"
                ))
                .cure("the part is damaged: compute it again"));
            }
            let first = all.vertices.len() as u32;
            all.vertices.extend_from_slice(&part.vertices);
            let edges = part.edges.iter().map(|edge| ResidualEdge {
                ends: edge.ends.map(|end| end + first),
                ..*edge
            });
            all.edges.extend(edges);
            all.pending.extend_from_slice(&part.pending);
            all.has_lines |= part.has_lines;
        }
        Ok(all)
    }
}

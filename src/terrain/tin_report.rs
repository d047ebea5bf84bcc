use super::{CrossingHeights, JoinedLake, LostAtRim, WaterOverlap};
use crate::data::{Bounds, LineEdges};
use crate::triangulation::Rounding;

/// Counts of what a [`TinBuilder`](super::TinBuilder) was given and what it built.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TinReport {
    /// Points added.
    pub points: usize,
    /// Points merged into another point at the same site.
    pub duplicates: usize,
    /// Points left out because they lie in water or between the edges of a wall.
    pub points_replaced: usize,
    /// Points replaced by a breakline's vertex at the same site.
    pub points_on_breaklines: usize,
    /// Lines added, of all kinds but draped ones; each part and each ring counts as one, a wall as
    /// two, a river as its banks and level lines.
    pub breaklines: usize,
    /// Distinct sites of the vertices of the breaklines.
    pub breakline_vertices: usize,
    /// Edges of the surface on lines, by their kinds.
    pub edges: LineEdges,
    /// Vertices added where breaklines cross between their vertices.
    pub crossings: usize,
    /// How the crossings were rounded; `None` if no breaklines cross.
    pub rounding: Option<Rounding>,
    /// The sites within the bounds at which breaklines meet with heights that differ by more than
    /// the tolerance, from west to east.
    pub crossing_heights: Vec<CrossingHeights>,
    /// The vertices of walls that have the height of water, which counts first, instead of their
    /// own; each with the number of its line and its site.
    pub walls_in_water: Vec<(usize, [f64; 2])>,
    /// The pairs of waters that overlap or touch with a step larger than the tolerance, with the
    /// largest of each.
    pub water_overlaps: Vec<WaterOverlap>,
    /// The lakes that have the height of a larger one, which they meet.
    pub lakes_joined: Vec<JoinedLake>,
    /// Vertices that [`add_ridges`](super::TinBuilder::add_ridges) has added.
    pub ridge_vertices: usize,
    /// Triangles that are flat because all of their corners are on lines of one height, before the
    /// surface is clipped. Counted if lines have more vertices than there are points.
    pub flat_triangles: usize,
    /// The share of these triangles in the area of all, from 0 to 1.
    pub flat_share: f64,
    /// The first line of each water that reaches beyond the rim of all points and of the lines with
    /// heights, and ends there.
    pub waters_ended: Vec<usize>,
    /// Vertices of the surface.
    pub vertices: usize,
    /// Triangles of the surface.
    pub triangles: usize,
    /// The box around the surface.
    pub extent: Bounds,
    /// Triangles left out at the rim, by `max_edge` and as caps.
    pub faces_beyond_max_edge: usize,
    /// What the surface loses with them.
    pub lost_at_rim: LostAtRim,
    /// Triangles left out by `max_edge_inside`, wherever they are.
    pub faces_with_long_edges: usize,
    /// Triangles within the bounds that points outside of the
    /// [window](super::TinBuilder::window) may change. If there are none, the surface is that of
    /// all points, in every triangle and height.
    pub uncertain: usize,
    /// Vertices left out of the surface because all of their triangles were left out at the rim or
    /// by `max_edge_inside`.
    pub vertices_beyond_max_edge: usize,
    /// Triangles left out by the boundary, the bounds or holes.
    pub faces_clipped: usize,
    /// Vertices left out of the surface because clipping left out all of their remaining triangles.
    pub vertices_clipped: usize,
    /// Vertices added where the boundary, the bounds, holes or draped lines cut triangles.
    pub vertices_cut: usize,
    /// Triangles cut by the boundary, the bounds, holes or draped lines; the surface contains
    /// fragments of them.
    pub faces_cut: usize,
}

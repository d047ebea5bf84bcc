//! What the rule of the rim leaves of a triangulation.

use rayon::prelude::*;

use super::caps::{LeftOutAtRim, LostAtRim};
use super::rim_rule::RimRule;
use crate::data::AT_ONCE;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId, ccw, cw};

/// Leaves out the faces that can be reached from outside of the hull over unconstrained edges that
/// are open to them: sets `inside`, by the numbers of cells, to false. Returns these faces.
pub(super) fn peel(
    triangulation: &ConstrainedDelaunay<Terrain>,
    inside: &mut [bool],
    rule: RimRule,
) -> Vec<CellId> {
    let tds = triangulation.tds();
    let mut peeled = Vec::new();
    let at_hull = tds
        .corners_around(VertexId::INFINITE)
        .map(|(cell, i)| (tds.neighbor(cell, i), cell));
    let mut exposed: Vec<(CellId, CellId)> = at_hull.collect();
    while let Some((cell, from)) = exposed.pop() {
        let i = tds.index_of_neighbor(cell, from);
        if !inside[cell.index()] || triangulation.is_constrained(cell, i) {
            continue;
        }
        let corners = tds.corners(cell).map(|vertex| *triangulation.point(vertex));
        if !rule.is_open(&corners, i) {
            continue;
        }
        inside[cell.index()] = false;
        peeled.push(cell);
        let onward = [ccw(i), cw(i)].map(|k| tds.neighbor(cell, k));
        exposed.extend(
            onward
                .into_iter()
                .filter(|n| inside[n.index()])
                .map(|n| (n, cell)),
        );
    }
    peeled
}

/// Returns what is lost with faces that were left out.
pub(super) fn lost_at_rim(
    triangulation: &ConstrainedDelaunay<Terrain>,
    peeled: &[CellId],
    rule: RimRule,
) -> LostAtRim {
    if peeled.is_empty() {
        return LostAtRim::default();
    }
    let tds = triangulation.tds();
    let number = |vertex: VertexId| vertex.index() as u64;
    let point = |vertex: VertexId| *triangulation.point(vertex);
    let mut left_out = LeftOutAtRim::new(rule.max_edge);
    for (cell, i) in tds.corners_around(VertexId::INFINITE) {
        let ends = tds.edge_ends(cell, i);
        left_out.add_hull(ends.map(number), ends.map(point));
    }
    for &cell in peeled {
        let corners = tds.corners(cell);
        left_out.add(corners.map(number), corners.map(point));
    }
    left_out.lost()
}

/// Returns for each cell number true if it is a finite face.
pub(super) fn finite_faces(triangulation: &ConstrainedDelaunay<Terrain>) -> Vec<bool> {
    let tds = triangulation.tds();
    let is_face = |cell| tds.is_used(cell) && !tds.is_infinite(cell);
    (0..tds.cell_slots())
        .into_par_iter()
        .with_min_len(AT_ONCE)
        .map(|index| is_face(CellId::new(index)))
        .collect()
}

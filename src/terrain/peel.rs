//! What the rule of the rim leaves of a triangulation.

use rayon::prelude::*;

use super::rim_rule::RimRule;
use crate::data::AT_ONCE;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId, ccw, cw};

/// Leaves out the faces that can be reached from outside of the hull over unconstrained edges that
/// are open to them: sets `inside`, by the numbers of cells, to false. Returns their number.
pub(super) fn peel(
    triangulation: &ConstrainedDelaunay<Terrain>,
    inside: &mut [bool],
    rule: RimRule,
) -> usize {
    let tds = triangulation.tds();
    let mut peeled = 0;
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
        peeled += 1;
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

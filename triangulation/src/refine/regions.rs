//! The triangles to refine, and the region that each lies in.

use crate::geometry::Crossing;
use crate::lines::ConstrainedDelaunay;
use crate::locate::Location;
use crate::tds::{CellId, VertexId};

use super::quality::{Domain, OUTSIDE, RegionBound};

/// Returns for each cell, by number: [`OUTSIDE`], or 0, or one more than the index of its region.
/// Makes the hull's edges constraints where the domain needs it.
pub(super) fn regions_of<G: Crossing, V: Default>(
    t: &mut ConstrainedDelaunay<G, V>,
    domain: &Domain,
    regions: &[RegionBound],
) -> Vec<u32> {
    let mut marks = match domain {
        Domain::Hull { holes } => {
            let hull: Vec<(CellId, usize)> = t.tds().corners_around(VertexId::INFINITE).collect();
            for edge in hull {
                t.inner.set_constrained(edge, true);
            }
            t.lines.expect_stray_edges();
            enclosed(t, holes)
        }
        Domain::Enclosed { holes } => enclosed(t, holes),
        Domain::Nested => {
            let is_inside = |level: u32| level % 2 == 1;
            t.nesting()
                .into_iter()
                .map(|level| if is_inside(level) { 0 } else { OUTSIDE })
                .collect()
        }
        Domain::Seeded { seeds } => {
            let mut marks = vec![OUTSIDE; t.tds().cell_slots()];
            let closed = enclosed(t, &[]);
            let is_closed = |cell: &CellId| closed[cell.index()] != OUTSIDE;
            let cells: Vec<CellId> = seeds
                .iter()
                .filter_map(|&seed| cell_at(t, seed))
                .filter(is_closed)
                .collect();
            spread(t, &mut marks, cells, 0);
            marks
        }
    };
    for (mark, region) in (1..).zip(regions) {
        let is_inside = |cell: &CellId| marks[cell.index()] != OUTSIDE;
        let cells: Vec<CellId> = cell_at(t, region.seed)
            .into_iter()
            .filter(is_inside)
            .collect();
        spread(t, &mut marks, cells, mark);
    }
    marks
}

/// Marks all cells that cannot be reached from outside of the hull or from a hole.
fn enclosed<G: Crossing, V: Default>(
    t: &ConstrainedDelaunay<G, V>,
    holes: &[[f64; 2]],
) -> Vec<u32> {
    let mut marks = vec![0; t.tds().cell_slots()];
    let mut outer: Vec<CellId> = t.tds().around(VertexId::INFINITE).collect();
    outer.extend(holes.iter().filter_map(|&hole| cell_at(t, hole)));
    spread(t, &mut marks, outer, OUTSIDE);
    marks
}

/// Marks all cells that can be reached from given cells without crossing a constraint.
fn spread<G: Crossing, V: Default>(
    t: &ConstrainedDelaunay<G, V>,
    marks: &mut [u32],
    mut cells: Vec<CellId>,
    mark: u32,
) {
    while let Some(cell) = cells.pop() {
        if std::mem::replace(&mut marks[cell.index()], mark) != mark {
            let open = (0..3).filter(|&i| !t.is_constrained(cell, i));
            cells.extend(open.map(|i| t.tds().neighbor(cell, i)));
        }
    }
}

/// Returns the finite cell that a point lies in, rounded to what the geometry admits; `None`
/// outside of the hull.
fn cell_at<G: Crossing, V: Default>(
    t: &ConstrainedDelaunay<G, V>,
    site: [f64; 2],
) -> Option<CellId> {
    let cell = t.finite_cells().next()?;
    let [a, b, _] = t.tds().corners(cell).map(|v| t.point(v));
    let p = t.geometry().meet(t.geometry().on_step(site), &[[a, b]]);
    match t.locate(&p, None) {
        Location::Cell { cell, .. } => Some(cell),
        Location::Vertex(vertex) => t
            .tds()
            .around(vertex)
            .find(|&cell| !t.tds().is_infinite(cell)),
        Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => None,
    }
}

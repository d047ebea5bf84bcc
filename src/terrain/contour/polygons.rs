//! Polygons that arcs bound together.

use super::simple_rings;
use crate::data::doubled_area;
use crate::error::{Error, Result};
use crate::terrain::arranged::arranged;
use crate::terrain::linear::plan;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::CellId;

/// Polygons, and a triangulation of their borders in which they are found.
pub(in crate::terrain) struct Polygons {
    triangulation: ConstrainedDelaunay<Terrain>,
    /// The polygon that each cell is in.
    of_cells: Vec<Option<usize>>,
    /// The rings of each polygon: the outer one, and its holes.
    pub(in crate::terrain) rings: Vec<Vec<Vec<[f64; 2]>>>,
}

impl Polygons {
    /// Returns the polygons that arcs bound together. Two arcs that coincide cancel, so that the
    /// polygons are valid however the ends of arcs were rounded.
    ///
    /// # Errors
    /// If the arcs leave a gap, or a coordinate is not covered by the arithmetic.
    pub(in crate::terrain) fn new(arcs: &[[[f64; 2]; 2]]) -> Result<Self> {
        let points: Vec<[f64; 3]> = arcs.iter().flatten().map(|&[x, y]| [x, y, 0.0]).collect();
        let lines: Vec<[u32; 2]> = (0..arcs.len() as u32).map(|i| [2 * i, 2 * i + 1]).collect();
        let triangulation = arranged(&points, &lines)?;
        let nesting = triangulation
            .nesting_of(triangulation.lines())
            .map_err(|e| Error::format(e.to_string()))?;
        let tds = triangulation.tds();
        let is_inside = |cell: CellId| nesting[cell.index()] % 2 == 1;
        let mut of_cells: Vec<Option<usize>> = vec![None; nesting.len()];
        let mut rings = Vec::new();
        for first in triangulation.finite_cells().filter(|&cell| is_inside(cell)) {
            if of_cells[first.index()].is_some() {
                continue;
            }
            let polygon = rings.len();
            let (mut open, mut border) = (vec![first], Vec::new());
            of_cells[first.index()] = Some(polygon);
            while let Some(cell) = open.pop() {
                for i in 0..3 {
                    let neighbor = tds.neighbor(cell, i);
                    if !is_inside(neighbor) {
                        // The polygon is on the right.
                        border.push(
                            [(i + 2) % 3, (i + 1) % 3]
                                .map(|k| plan(*triangulation.point(tds.vertex(cell, k)))),
                        );
                    } else if of_cells[neighbor.index()].is_none() {
                        of_cells[neighbor.index()] = Some(polygon);
                        open.push(neighbor);
                    }
                }
            }
            let mut found = simple_rings(border);
            found.sort_by(|one, other| doubled_area(one).total_cmp(&doubled_area(other)));
            rings.push(found);
        }
        Ok(Polygons {
            triangulation,
            of_cells,
            rings,
        })
    }

    /// Returns the polygon at a position; `near` is the cell of the position before.
    pub(in crate::terrain) fn at(
        &self,
        [x, y]: [f64; 2],
        near: &mut Option<CellId>,
    ) -> Option<usize> {
        let location = self.triangulation.locate(&[x, y, 0.0], *near);
        let cell = location.cell(&self.triangulation)?;
        *near = Some(cell);
        self.of_cells.get(cell.index()).copied().flatten()
    }
}

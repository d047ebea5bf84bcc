use std::collections::HashSet;

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns the finite edges that the open segment from `a` to `b` crosses in their interior,
    /// each once and in no particular order. `a` and `b` need not be vertices, nor lie in the hull.
    /// Edges that the segment runs along or touches with an end are not crossed. Empty if the
    /// geometry does not [admit](Geometry::admits) both points.
    ///
    /// # Complexity
    /// Linear in the number of triangles met, after location; in the size of the hull if `a` is
    /// outside. If the order matters, or the faces, use [`along`](Self::along), which can also end
    /// early.
    pub fn edges_crossed(&self, a: &G::Point, b: &G::Point) -> Vec<[VertexId; 2]> {
        let mut crossed = Vec::new();
        let is_segment = [a, b].into_iter().all(|p| self.geometry.admits(p))
            && self.geometry.compare(a, b).is_ne();
        if self.dimension() < 2 || !is_segment {
            return crossed;
        }
        let mut open = self.cells_at(a);
        let mut seen: HashSet<CellId> = open.iter().copied().collect();
        while let Some(cell) = open.pop() {
            let corners = *self.tds.corners(cell);
            let infinite = corners.iter().position(|&v| v == VertexId::INFINITE);
            for i in (0..3).filter(|&i| infinite.is_none_or(|infinite| infinite == i)) {
                let ends = [corners[ccw(i)], corners[cw(i)]];
                if self.crosses(a, b, ends) {
                    let beyond = self.tds.neighbor(cell, i);
                    if seen.insert(beyond) {
                        open.push(beyond);
                    }
                    // Of the two cells of an edge, the one that has it in this direction reports
                    // it.
                    crossed.extend((ends[0] < ends[1]).then_some(ends));
                }
            }
            // Through a vertex the segment may continue in any of its cells.
            for &vertex in corners
                .iter()
                .filter(|&&v| v != VertexId::INFINITE && self.is_between(a, b, v))
            {
                open.extend(self.tds.around(vertex).filter(|&cell| seen.insert(cell)));
            }
        }
        crossed.sort_unstable();
        crossed.dedup();
        crossed
    }

    /// Returns the cells that contain a point, inside or on their border; all infinite cells for a
    /// point outside.
    fn cells_at(&self, a: &G::Point) -> Vec<CellId> {
        let Ok(cells) = self.locate(a, None).cells(&self.tds);
        if cells.is_empty() {
            self.tds.around(VertexId::INFINITE).collect()
        } else {
            cells
        }
    }

    fn crosses(&self, a: &G::Point, b: &G::Point, [c, d]: [VertexId; 2]) -> bool {
        let (c, d) = (self.point(c), self.point(d));
        let turn = |p, q, r| self.geometry.orientation([p, q, r]);
        turn(a, b, c) * turn(a, b, d) == Sign::Negative
            && turn(c, d, a) * turn(c, d, b) == Sign::Negative
    }

    fn is_between(&self, a: &G::Point, b: &G::Point, v: VertexId) -> bool {
        let p = self.point(v);
        self.geometry.orientation([a, b, p]) == Sign::Zero
            && self.geometry.side_of_sphere_in_flat(&[a, b], p) == Sign::Positive
    }
}

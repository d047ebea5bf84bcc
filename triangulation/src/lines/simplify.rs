//! Simplification of a line that crosses no other line.

use std::collections::HashSet;

use crate::geometry::{Coordinates, Crossing, distance_to_segment};
use crate::line_id::LineId;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw};

use super::constrained_delaunay::ConstrainedDelaunay;

impl<G: Crossing + Coordinates<3>, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Simplifies a line in plan and returns the number of vertices removed from it. Each vertex
    /// removed lies within `tolerance` of the segment that replaces it. No line changes sides: the
    /// triangle between the line and its shortcut contains no other vertex of a line. The ends
    /// stay, and so do vertices that are shared with other lines or used twice. Vertices owned by
    /// the line are removed.
    ///
    /// Vertices are tried in order, each with all those removed before it on the same shortcut
    /// (after the vertex removal of Dyken, Dæhlen and Sevaldrud 2009).
    ///
    /// # Complexity
    /// For each vertex, the triangles along the shortcut and the vertices that it replaces; then as
    /// for [`insert_lines`](Self::insert_lines).
    pub fn simplify_line(&mut self, line: LineId, tolerance: f64) -> usize {
        let vertices = self.line_vertices(line).to_vec();
        if vertices.len() < 3 || self.dimension() < 2 {
            return 0;
        }
        let mut seen = HashSet::new();
        let twice: HashSet<VertexId> = vertices
            .iter()
            .copied()
            .filter(|&v| !seen.insert(v))
            .collect();
        let mut gone = HashSet::new();
        let mut kept = vec![vertices[0]];
        // The vertices removed since the last one that is kept.
        let mut skipped: Vec<VertexId> = Vec::new();
        for pair in vertices[1..].windows(2) {
            let (from, at, to) = (kept[kept.len() - 1], pair[0], pair[1]);
            skipped.push(at);
            let ends = [from, to].map(|v| self.geometry().plan(self.point(v)));
            let is_near = |&v: &VertexId| {
                distance_to_segment(self.geometry().plan(self.point(v)), ends) <= tolerance
            };
            if !twice.contains(&at)
                && from != to
                && skipped.iter().all(is_near)
                && self.is_of_one_line(at, line)
                && self.is_free([from, at, to], &gone)
            {
                gone.insert(at);
            } else {
                kept.push(at);
                skipped.clear();
            }
        }
        kept.extend(vertices.last());
        if !gone.is_empty() {
            self.change_lines(vec![(line, Some(kept[..].into()))]);
        }
        gone.len()
    }

    /// Returns true if all constrained edges at a vertex belong to this line and to no other.
    fn is_of_one_line(&self, vertex: VertexId, line: LineId) -> bool {
        let mut edges = self
            .tds()
            .around(vertex)
            .flat_map(|cell| *self.tds().corners(cell));
        edges.all(|other| {
            other == vertex
                || other == VertexId::INFINITE
                || !self.inner.has_constraint(vertex, other)
                || self.lines_through(vertex, other).eq([line])
        })
    }

    /// Returns true if no vertex of a line lies in a triangle or on its border, except for its
    /// corners and removed vertices.
    fn is_free(&self, [a, b, c]: [VertexId; 3], gone: &HashSet<VertexId>) -> bool {
        let turn = |p: VertexId, q: VertexId, r: VertexId| {
            self.geometry()
                .orientation([p, q, r].map(|v| self.point(v)))
        };
        let corners = match turn(a, b, c) {
            Sign::Positive => [a, b, c],
            Sign::Negative => [a, c, b],
            // A vertex on a straight line changes nothing; one at which the line turns back is
            // kept.
            Sign::Zero => {
                let [a, b, c] = [a, b, c].map(|v| self.point(v));
                return self.geometry().side_of_sphere_in_flat(&[a, c], b) == Sign::Positive;
            }
        };
        let beyond = |triangle: [VertexId; 3], points: [VertexId; 3]| {
            (0..3).any(|i| {
                points
                    .iter()
                    .all(|&p| turn(triangle[i], triangle[ccw(i)], p) != Sign::Positive)
            })
        };
        let holds =
            |p: VertexId| (0..3).all(|i| turn(corners[i], corners[ccw(i)], p) != Sign::Negative);
        let mut seen: HashSet<CellId> = HashSet::new();
        let mut open: Vec<CellId> = self.tds().around(b).collect();
        while let Some(cell) = open.pop() {
            let theirs = *self.tds().corners(cell);
            if self.tds().is_infinite(cell)
                || !seen.insert(cell)
                || beyond(corners, theirs)
                || beyond(theirs, corners)
            {
                continue;
            }
            let blocks = |&v: &VertexId| {
                !corners.contains(&v)
                    && !gone.contains(&v)
                    && self.lines.is_on_constraint(&self.inner, v)
                    && holds(v)
            };
            if theirs.iter().any(blocks) {
                return false;
            }
            open.extend(self.tds().cell_neighbors(cell));
        }
        true
    }
}

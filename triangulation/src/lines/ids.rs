//! Lines by their ids.

use crate::geometry::Crossing;
use crate::line_id::LineId;
use crate::num::Sign;
use crate::tds::VertexId;

use super::chains::undirected;
use super::constrained_delaunay::ConstrainedDelaunay;

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Appends the vertices of a segment to `chain`, without its start.
    fn walk(&self, a: VertexId, b: VertexId, chain: &mut Vec<VertexId>) {
        if self.dimension() == 2 {
            return self.lines.chains.walk(a, b, chain);
        }
        // While all points are collinear, the table has no splits.
        let first = chain.len();
        let ends = [a, b].map(|v| self.point(v));
        let is_between = |&v: &VertexId| {
            self.geometry().side_of_sphere_in_flat(&ends, self.point(v)) == Sign::Positive
        };
        chain.extend(self.tds().vertices().filter(is_between));
        chain[first..]
            .sort_unstable_by(|&u, &v| self.geometry().compare(self.point(u), self.point(v)));
        if self.geometry().compare(ends[0], ends[1]).is_gt() {
            chain[first..].reverse();
        }
        chain.push(b);
    }

    /// The ids of all lines, in order.
    pub fn lines(&self) -> impl Iterator<Item = LineId> + '_ {
        let given = self.lines.chains.given.iter().enumerate();
        given
            .filter(|(_, line)| line.is_some())
            .map(|(index, _)| LineId::new(index))
    }

    /// Returns the vertices by which a line was given, in order; points on one site share a vertex.
    /// Empty for a line that does not exist.
    pub fn line_vertices(&self, line: LineId) -> &[VertexId] {
        self.lines.chains.vertices(line)
    }

    /// Returns the vertices of a line in the triangulation, in order: those by which it was given,
    /// and those that it passes through between them. Each is joined to the next by a constrained
    /// edge. Empty for a line that does not exist.
    ///
    /// # Complexity
    /// Linear in the length of the result. For the vertices by which it was given, use
    /// [`line_vertices`](Self::line_vertices), which is free; for one segment,
    /// [`segment_chain`](Self::segment_chain).
    pub fn chain(&self, line: LineId) -> Vec<VertexId> {
        let vertices = self.line_vertices(line);
        let mut chain: Vec<VertexId> = vertices.first().copied().into_iter().collect();
        for pair in vertices.windows(2).filter(|pair| pair[0] != pair[1]) {
            self.walk(pair[0], pair[1], &mut chain);
        }
        chain
    }

    /// Returns the vertices that a segment passes through, between two consecutive vertices of a
    /// line. Empty if the segment is one edge, or if a vertex does not exist.
    ///
    /// # Complexity
    /// Linear in the length of the result.
    pub fn segment_chain(&self, a: VertexId, b: VertexId) -> Vec<VertexId> {
        let mut chain = Vec::new();
        if [a, b].into_iter().all(|v| self.tds().is_vertex(v)) {
            self.walk(a, b, &mut chain);
            chain.pop();
        }
        chain
    }

    /// The ids of all lines that run along the edge between two vertices, in order.
    ///
    /// # Complexity
    /// Constant time for each line. The first call after construction takes linear time and
    /// allocates about 40 bytes for each segment, and for each edge of segments that are more than
    /// one.
    pub fn lines_through(
        &self,
        a: VertexId,
        b: VertexId,
    ) -> impl ExactSizeIterator<Item = LineId> + '_ {
        let edge = undirected(a, b);
        let mut lines: Vec<LineId> = Vec::new();
        if self.dimension() < 2 {
            let runs_along = |line: &LineId| {
                self.chain(*line)
                    .windows(2)
                    .any(|pair| undirected(pair[0], pair[1]) == edge)
            };
            lines.extend(self.lines().filter(runs_along));
        } else if !self.lines.chains.splits.contains_key(&edge) {
            let index = self.lines.index();
            lines.extend(
                index
                    .segments_on(&self.lines.chains, edge)
                    .flat_map(|segment| index.lines_of(segment)),
            );
            lines.sort_unstable();
            lines.dedup();
        }
        lines.into_iter()
    }

    /// Returns true if a vertex was added where lines cross, rather than given.
    pub fn is_added(&self, vertex: VertexId) -> bool {
        self.lines.added.contains(vertex)
    }
}

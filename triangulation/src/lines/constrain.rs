//! Insertion and removal of one vertex or one sub-constraint. The tables are kept up to date.

use crate::engine::flip::WithConstraints;
use crate::engine::insert::Inserted;
use crate::engine::trace::TraceEnd;
use crate::geometry::Crossing;
use crate::locate::{Facets, Location};
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

use super::chains::undirected;
use super::mesh::Mesh;
use super::tables::Lines;

/// Inserts a point that was admitted at its location, unless its site is taken. A constraint that
/// the location names is replaced by the edges from the point to its ends.
fn insert_through<G: Crossing, V, C: Copy + Default>(
    t: &mut Mesh<G, V, C>,
    p: G::Point,
    data: V,
    location: Location,
) -> Inserted<V> {
    let split = t.constraint_at(location);
    let takes = |t: &Mesh<G, V, C>, from, i, beyond| {
        !t.tds.cell_data(from).has(i) && t.in_conflict(beyond, &p)
    };
    let inserted = t.insert_at(p, location, data, takes, |constrained, i| {
        constrained.only(i)
    });
    t.constrain_halves(split, inserted.vertex);
    inserted
}

impl Lines {
    /// Inserts a point that was admitted and returns its vertex; if the site is taken, the vertex
    /// that is there already. A point on a constraint splits it.
    pub(crate) fn insert_point<G: Crossing, V: Default, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        p: G::Point,
        near: Option<CellId>,
    ) -> VertexId {
        let location = t.locate(&p, near);
        self.insert_at(t, p, V::default(), location).vertex
    }

    /// Inserts a point that was admitted at its location, unless its site is taken. A point on a
    /// constraint splits it.
    pub(super) fn insert_at<G: Crossing, V, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        p: G::Point,
        data: V,
        location: Location,
    ) -> Inserted<V> {
        let split = t.constraint_at(location);
        let inserted = insert_through(t, p, data, location);
        if let Some([a, b]) = split {
            self.split_edge(a, b, inserted.vertex);
        }
        inserted
    }

    /// Inserts a point that was admitted, and bends the constraint opposite corner `i` of a
    /// triangle to it. The point must be in the triangle, and in the circle of the one beyond the
    /// constraint. The tables are not updated: that is the caller's task.
    ///
    /// From each triangle that is replaced, the point lies beyond the edge by which it was reached,
    /// and in the circle: so it sees the other two edges.
    ///
    /// ```text
    ///        c                 c
    ///      /   \             / | \
    ///     /  p  \           /  |  \
    ///    a-------b   ==>   a--p--b       p is a little above the line from a to b
    ///     \     /           \  |  /
    ///      \   /             \ | /
    ///        d                 d
    /// ```
    pub(super) fn bend_edge<G: Crossing, V: Default, C: Copy + Default>(
        t: &mut Mesh<G, V, C>,
        p: G::Point,
        cell: CellId,
        i: usize,
    ) -> VertexId {
        insert_through(
            t,
            p,
            V::default(),
            Location::Cell {
                cell,
                facets: Facets::only(i),
            },
        )
        .vertex
    }

    /// Inserts the sub-constraint between two vertices. All constraints enter the triangulation by
    /// this function. Vertices that the sub-constraint passes through split it. Returns `false` if
    /// another constraint blocks it; then it is present up to that one.
    ///
    /// While all points are collinear, it is stored and inserted later.
    pub(crate) fn constrain<G: Crossing, V, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        a: VertexId,
        b: VertexId,
    ) -> bool {
        if t.dimension() < 2 {
            self.waiting.push([a, b]);
            return true;
        }
        // A sub-constraint that is one edge already allocates nothing.
        let (mut first, mut parts) = (Some([a, b]), Vec::new());
        let mut is_whole = true;
        while let Some([a, b]) = first.take().or_else(|| parts.pop()) {
            if a == b || t.constrain_edge(a, b) {
                continue;
            }
            if let Some(&between) = self.chains.splits.get(&undirected(a, b)) {
                parts.extend([[between, b], [a, between]]);
                continue;
            }
            // Finding the direction takes long at a vertex of high degree.
            let [a, b] = if t.tds.is_busier(a, b) {
                [b, a]
            } else {
                [a, b]
            };
            match t.trace(a, b, &mut self.buffers) {
                TraceEnd::Vertex(v) => {
                    t.insert_traced(a, v, &mut self.buffers, Triangulation::triangulate);
                    if v != b {
                        self.chains.split(a, b, v);
                        parts.push([v, b]);
                    }
                }
                TraceEnd::Constraint(..) => is_whole = false,
            }
        }
        is_whole
    }

    /// Inserts the segments that were stored while all points were collinear.
    pub(super) fn constrain_waiting<G: Crossing, V, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
    ) {
        if t.dimension() == 2 && !self.waiting.is_empty() {
            self.index.take();
            for [a, b] in std::mem::take(&mut self.waiting) {
                self.constrain(t, a, b); // nothing blocks it: all are collinear
            }
        }
    }

    /// Removes a vertex that is on no constraint, and returns its point. Returns `None` if there is
    /// no such vertex, or a constraint ends at it or runs through it. The result is the
    /// triangulation of the other points with the same constraints. Numbers and time are as in
    /// [`Delaunay::remove`](crate::Delaunay::remove). No line may name the vertex when its number
    /// is used again.
    pub(crate) fn remove_free<G: Crossing, V, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        vertex: VertexId,
    ) -> Option<G::Point> {
        if !t.tds.is_vertex(vertex) || self.is_on_constraint(t, vertex) {
            return None;
        }
        if let Some(line) = t.line_without(vertex) {
            // No triangles will be left to hold the constraints.
            let constrained = line
                .windows(2)
                .filter(|pair| t.has_constraint(pair[0], pair[1]));
            self.waiting
                .extend(constrained.map(|pair| [pair[0], pair[1]]));
        }
        t.remove_vertex(WithConstraints, vertex);
        Some(*t.point(vertex))
    }

    /// Returns true if a constraint ends at a vertex or runs through it, or will as soon as there
    /// are triangles.
    pub(super) fn is_on_constraint<G: Crossing, V, C: Copy + Default>(
        &self,
        t: &Mesh<G, V, C>,
        vertex: VertexId,
    ) -> bool {
        t.is_on_constraint(vertex) || self.waiting.iter().flatten().any(|&end| end == vertex)
    }

    /// Releases the constrained edge between two vertices, which then remains only if it is a
    /// Delaunay edge. Returns false if there is no such constraint. The tables are not updated:
    /// that is the caller's task.
    ///
    /// # Complexity
    /// Linear in the degree of `a` and in the number of flips.
    pub(super) fn release<G: Crossing, V, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        a: VertexId,
        b: VertexId,
    ) -> bool {
        let Some(sides) = t.release_edge(a, b) else {
            let waiting = self.waiting.len();
            self.waiting
                .retain(|&pair| pair != [a, b] && pair != [b, a]);
            return self.waiting.len() < waiting;
        };
        self.buffers.to_legalize.extend(sides);
        t.legalize(WithConstraints, &mut self.buffers.to_legalize);
        true
    }
}

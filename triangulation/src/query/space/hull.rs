use crate::geometry::Geometry;
use crate::tds::space::OUTWARD;
use crate::tds::{VertexId, cw};
use crate::triangulation::Triangulation;

/// The convex hull of points in space, by the dimension that they span. Vertices on its border are
/// part of it, even if they are no corners: those in the interior of an edge or of a flat side.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ConvexHull {
    /// There are no points.
    Empty,
    /// The only vertex.
    Point(VertexId),
    /// All points are collinear: the two outermost ones, in the [order](Geometry::compare) of the
    /// geometry.
    Segment([VertexId; 2]),
    /// The vertices around a part of a plane, counter-clockwise as seen from the side from which
    /// the cells are.
    Polygon(Vec<VertexId>),
    /// The surface of a solid.
    Polyhedron {
        /// The vertices, in order of their numbers.
        vertices: Vec<VertexId>,
        /// The facets, counter-clockwise as seen from outside, so that their normals point
        /// outwards. Each starts with its smallest vertex, and they are sorted.
        triangles: Vec<[VertexId; 3]>,
    },
}

impl<G: Geometry<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Returns the convex hull of the points. It is a closed surface if they are not coplanar: `v`
    /// vertices have `2 v - 4` triangles.
    ///
    /// # Complexity
    /// O(k log k) for the k facets of the hull. If their order does not matter, use
    /// [`Tds::hull_facets`](crate::tds::Tds::hull_facets), which allocates nothing.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, ConvexHull, Delaunay};
    ///
    /// let mut points = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.0]];
    /// let (t, v) = Delaunay::from_points(Space::new(), &points)?;
    /// let ConvexHull::Polygon(corners) = t.convex_hull() else { panic!("coplanar") };
    /// assert!(corners.len() == 3 && !corners.contains(&v[3]));
    ///
    /// points.extend([[0.0, 0.0, 4.0], [0.5, 0.5, 0.5]]);
    /// let (t, _) = Delaunay::from_points(Space::new(), &points)?;
    /// let ConvexHull::Polyhedron { vertices, triangles } = t.convex_hull() else { panic!("solid") };
    /// assert_eq!((vertices.len(), triangles.len()), (5, 6)); // [1, 1, 0] is in a side
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn convex_hull(&self) -> ConvexHull {
        let tds = self.tds();
        match self.dimension() {
            3 => self.polyhedron(),
            2 => ConvexHull::Polygon(self.rim()),
            1 => {
                let mut ends: Vec<VertexId> = tds.vertices_around(VertexId::INFINITE);
                ends.sort_unstable_by(|&a, &b| {
                    self.geometry().compare(self.point(a), self.point(b))
                });
                match ends[..] {
                    [first, last] => ConvexHull::Segment([first, last]),
                    _ => ConvexHull::Empty, // not in a valid structure
                }
            }
            _ => tds
                .vertices()
                .next()
                .map_or(ConvexHull::Empty, ConvexHull::Point),
        }
    }

    fn polyhedron(&self) -> ConvexHull {
        let tds = self.tds();
        let triangle = |(outside, i): (_, usize)| {
            let cell = tds.neighbor(outside, i);
            let mut triangle =
                OUTWARD[tds.index_of_neighbor(cell, outside)].map(|k| tds.vertex(cell, k));
            let smallest = (0..3).min_by_key(|&k| triangle[k]).unwrap_or(0);
            triangle.rotate_left(smallest);
            triangle
        };
        let mut triangles: Vec<[VertexId; 3]> = tds.hull_facets().map(triangle).collect();
        triangles.sort_unstable();
        let mut vertices = triangles.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        ConvexHull::Polyhedron {
            vertices,
            triangles,
        }
    }

    /// The vertices around a triangulation of dimension 2.
    fn rim(&self) -> Vec<VertexId> {
        let tds = self.tds();
        let mut rim = Vec::new();
        let Some(start) = tds.cell_of(VertexId::INFINITE) else {
            return rim;
        };
        let mut cell = start;
        // No more steps than cells, whatever the links are.
        for _ in 0..tds.cell_count() {
            let Some(i) = tds.index_of(cell, VertexId::INFINITE) else {
                break;
            };
            rim.push(tds.vertex(cell, cw(i)));
            cell = tds.neighbor(cell, cw(i));
            if cell == start {
                break;
            }
        }
        rim
    }
}

//! Queries on a structure of your own: an array of triangles, as meshes come in files. The
//! triangles fill a convex polygon.
//!
//! Infinite cells are not stored: there is one for each edge of the hull, numbered after the
//! triangles.
//!
//! ```text
//!        ghost k: (b, a, infinity)
//!          b <------- a          The hull runs counter-clockwise, from a to b. Across the finite edge
//!           \        /           lies the triangle; across the edge at a lies ghost k - 1, across the
//!            \  hull/            edge at b ghost k + 1.
//! ```

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::collections::HashMap;
use std::convert::Infallible;

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::tds::{CellId, Complex, VertexId};
use breakline_triangulation::{Delaunay, Embedded, Location, Passage, query};

struct Mesh {
    plane: Plane,
    points: Vec<[f64; 2]>,
    /// Indices of points, counter-clockwise.
    triangles: Vec<[u32; 3]>,
    /// The cell across the edge opposite each corner: a triangle or a ghost.
    across: Vec<[u32; 3]>,
    /// The edges of the hull in order, each as the triangle and its corner opposite the edge.
    hull: Vec<(u32, usize)>,
    /// A triangle of each vertex.
    triangle_of: Vec<u32>,
}

impl Mesh {
    fn new(points: Vec<[f64; 2]>, triangles: Vec<[u32; 3]>) -> Self {
        let sides = || {
            (0u32..)
                .zip(&triangles)
                .flat_map(|(k, t)| (0..3).map(move |i| (k, i, t[(i + 1) % 3], t[(i + 2) % 3])))
        };
        let owner: HashMap<(u32, u32), (u32, usize)> =
            sides().map(|(k, i, a, b)| ((a, b), (k, i))).collect();
        // Maps the start of each edge of the hull to the edge.
        let next: HashMap<u32, (u32, u32, usize)> = sides()
            .filter(|(_, _, a, b)| !owner.contains_key(&(*b, *a)))
            .map(|(k, i, a, b)| (a, (b, k, i)))
            .collect();
        let mut hull = Vec::new();
        let mut at = next.keys().copied().min();
        while let Some(&(b, k, i)) = at
            .and_then(|a| next.get(&a))
            .filter(|_| hull.len() < next.len())
        {
            hull.push((k, i));
            at = Some(b);
        }
        let mut across = vec![[0; 3]; triangles.len()];
        for (k, i, a, b) in sides() {
            if let Some(&(beside, _)) = owner.get(&(b, a)) {
                across[k as usize][i] = beside;
            }
        }
        for (ghost, &(k, i)) in hull.iter().enumerate() {
            across[k as usize][i] = (triangles.len() + ghost) as u32;
        }
        let mut triangle_of = vec![0; points.len()];
        for (k, triangle) in triangles.iter().enumerate() {
            triangle
                .iter()
                .for_each(|&v| triangle_of[v as usize] = k as u32);
        }
        Mesh {
            plane: Plane::new(),
            points,
            triangles,
            across,
            hull,
            triangle_of,
        }
    }

    /// Returns the number of a ghost, counted around the hull.
    fn ghost(&self, number: usize) -> CellId {
        CellId::new(self.triangles.len() + number % self.hull.len())
    }
}

impl Complex<3> for Mesh {
    type Error = Infallible;

    fn dimension(&self) -> i32 {
        2
    }

    fn vertex_slots(&self) -> usize {
        self.points.len()
    }

    fn cell_slots(&self) -> usize {
        self.triangles.len() + self.hull.len()
    }

    fn is_used(&self, cell: CellId) -> bool {
        cell.index() < self.cell_slots()
    }

    fn corners(&self, cell: CellId) -> Result<[VertexId; 3], Infallible> {
        let vertex = |v: u32| VertexId::new(v as usize);
        Ok(match self.triangles.get(cell.index()) {
            Some(triangle) => triangle.map(vertex),
            None => {
                let (k, i) = self.hull[cell.index() - self.triangles.len()];
                let triangle = self.triangles[k as usize];
                [
                    vertex(triangle[(i + 2) % 3]),
                    vertex(triangle[(i + 1) % 3]),
                    VertexId::INFINITE,
                ]
            }
        })
    }

    fn neighbor(&self, cell: CellId, i: usize) -> Result<CellId, Infallible> {
        Ok(match self.across.get(cell.index()) {
            Some(across) => CellId::new(across[i] as usize),
            None => {
                let ghost = cell.index() - self.triangles.len();
                match i {
                    0 => self.ghost(ghost + self.hull.len() - 1),
                    1 => self.ghost(ghost + 1),
                    _ => CellId::new(self.hull[ghost].0 as usize),
                }
            }
        })
    }

    fn cell_of(&self, vertex: VertexId) -> Result<Option<CellId>, Infallible> {
        if vertex == VertexId::INFINITE {
            return Ok(Some(self.ghost(0)));
        }
        Ok(self
            .triangle_of
            .get(vertex.index())
            .map(|&k| CellId::new(k as usize)))
    }

    fn ensure(&self, _: CellId, _: impl FnOnce() -> bool) -> Result<(), Infallible> {
        Ok(())
    }
}

impl Embedded<3> for Mesh {
    type Geometry = Plane;
    type Complex = Mesh;
    type Error = Infallible;
    type PointRef<'a> = &'a [f64; 2];

    fn geometry(&self) -> &Plane {
        &self.plane
    }

    fn complex(&self) -> &Mesh {
        self
    }

    fn point(&self, vertex: VertexId) -> Result<&[f64; 2], Infallible> {
        Ok(&self.points[vertex.index()])
    }

    fn point_ref<'a>(point: &'a [f64; 2]) -> &'a [f64; 2]
    where
        Self: 'a,
    {
        point
    }
}

/// Returns what a segment meets, each part by its vertices in order of their numbers.
fn faces_and_vertices(
    passage: Passage,
    corners: &dyn Fn(CellId) -> Result<[VertexId; 3], Infallible>,
) -> Vec<VertexId> {
    let mut met = match passage {
        Passage::Face(cell) | Passage::Edge(cell, _) => {
            corners(cell).map_or(Vec::new(), |corners| corners.to_vec())
        }
        Passage::Along(ends) => ends.to_vec(),
        Passage::Vertex(vertex) => vec![vertex],
    };
    if let Passage::Edge(_, opposite) = passage {
        met.remove(opposite);
    }
    met.sort_unstable();
    met
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A mesh with the points of a Delaunay triangulation, whose answers are the expected ones. Many
    // points share a circle.
    let grid: Vec<[f64; 2]> = (0..400u32)
        .map(|k| [f64::from(k % 20), f64::from(k * 7 % 20 + k / 20)])
        .collect();
    let (t, _) = Delaunay::from_points(Plane::new(), &grid)?;
    let triangles = t
        .finite_cells()
        .map(|cell| t.tds().corners(cell).map(|v| v.index() as u32))
        .collect();
    let mesh = Mesh::new(t.points().to_vec(), triangles);

    // Cells of the two have different numbers but the same vertices.
    let ours = |cell: CellId| {
        let Ok(mut corners) = mesh.corners(cell);
        corners.sort_unstable();
        corners
    };
    let theirs = |cell: CellId| {
        let mut corners = *t.tds().corners(cell);
        corners.sort_unstable();
        corners
    };
    let mut compared = 0;
    for k in 0..2000u32 {
        let q = [f64::from(k % 97) / 4.0 - 2.0, f64::from(k % 89) / 2.0 - 3.0];
        let r = [f64::from(k % 31), f64::from(k % 43)];
        let (Ok(found), expected) = (query::locate(&mesh, &q, None), t.locate(&q, None));
        match (found, expected) {
            (Location::Vertex(a), Location::Vertex(b)) => assert_eq!(a, b),
            (Location::Cell { cell: a, facets }, Location::Cell { cell: b, .. })
                if facets.is_empty() =>
            {
                assert_eq!(ours(a), theirs(b));
            }
            _ => assert_eq!(
                std::mem::discriminant(&found),
                std::mem::discriminant(&expected)
            ),
        }
        assert_eq!(query::nearest(&mesh, &q, None), Ok(t.nearest(&q, None)));
        assert_eq!(
            query::within_rectangle(&mesh, [&q, &r], None),
            Ok(t.within_rectangle([&q, &r]))
        );
        let (Ok(zone), expected) = (
            query::conflict_zone(&mesh, &q, None, |_, _| Ok(true)),
            t.conflict_zone(&q, None),
        );
        let sorted = |mut cells: Vec<[VertexId; 3]>| {
            cells.sort_unstable();
            cells
        };
        let zone = zone.map(|zone| sorted(zone.cells.into_iter().map(ours).collect()));
        assert_eq!(
            zone,
            expected.map(|zone| sorted(zone.cells.into_iter().map(theirs).collect()))
        );
        let Ok(along) = query::along(&mesh, [&q, &r], None);
        let met: Vec<_> = along
            .map(|Ok(passage)| faces_and_vertices(passage, &|cell| mesh.corners(cell)))
            .collect();
        let expected = t
            .along([&q, &r], None)
            .map(|passage| faces_and_vertices(passage, &|cell| Ok(*t.tds().corners(cell))));
        assert_eq!(met, expected.collect::<Vec<_>>());
        compared += 1;
    }
    let Ok(faces) = query::faces_from(&mesh, VertexId::new(0));
    assert_eq!(faces.count(), mesh.triangles.len());
    println!(
        "{compared} queries on {} triangles: the answers agree",
        mesh.triangles.len()
    );
    Ok(())
}

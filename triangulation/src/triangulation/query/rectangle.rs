use rustc_hash::FxHashSet;

use crate::geometry::Coordinates;
use crate::kernel::{Kernel, Orientation2, Wide};
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId, plane};

use super::super::Triangulation;
use super::super::embedded::{Embedded, PointOf};
use super::super::locate::locate;
use super::{site, site_of};

/// An axis-aligned rectangle with its border; it may be unbounded, and is empty if a coordinate is
/// NaN.
#[derive(Clone, Copy)]
struct Rectangle {
    low: [f64; 2],
    high: [f64; 2],
}

impl Rectangle {
    fn new(p: [f64; 2], q: [f64; 2]) -> Self {
        // NaN compares with nothing, and nothing lies on either side of it.
        let [(left, right), (below, above)] = [0, 1].map(|k| if p[k] <= q[k] { (p[k], q[k]) } else { (q[k], p[k]) });
        Rectangle { low: [left, below], high: [right, above] }
    }

    fn is_bounded(self) -> bool {
        [self.low, self.high].as_flattened().iter().all(|x| x.is_finite())
    }

    fn holds(self, p: [f64; 2]) -> bool {
        (0..2).all(|k| self.low[k] <= p[k] && p[k] <= self.high[k])
    }

    fn corners(self) -> [[f64; 2]; 4] {
        let Rectangle { low, high } = self;
        [low, [high[0], low[1]], high, [low[0], high[1]]]
    }

    /// Returns true if the rectangle meets the bounding box of a triangle, as it does if it meets
    /// the triangle.
    fn meets_box(self, [a, b, c]: [[f64; 2]; 3]) -> bool {
        (0..2).all(|k| a[k].min(b[k]).min(c[k]) <= self.high[k] && self.low[k] <= a[k].max(b[k]).max(c[k]))
    }
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    Wide::sign(&Orientation2([a, b, c]))
}

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns the vertices whose coordinates lie in an axis-aligned rectangle or on its border, in
    /// order of their numbers. The rectangle is given by any two opposite corners, which may be
    /// infinite; with a NaN it is empty. Exact.
    ///
    /// # Complexity
    /// A [walk](Self::locate), and time proportional to the number of faces whose bounding boxes
    /// meet the rectangle and, where it reaches beyond the hull, of edges on the hull there.
    /// Proportional to the number of vertices below dimension 2, if a corner is infinite, or if the
    /// geometry does not [admit](crate::geometry::Geometry::admits) the first corner.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    /// let (t, v) = Delaunay::from_points(Plane::new(), &points)?;
    /// let mut found = t.within_rectangle([&[0.5, 0.0], &[5.0, 3.0]]);
    /// found.sort_by(|&a, &b| t.point(a)[0].total_cmp(&t.point(b)[0]));
    /// assert_eq!(found, [v[1], v[2]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn within_rectangle(&self, corners: [&G::Point; 2]) -> Vec<VertexId> {
        let Ok(vertices) = within_rectangle(self, corners, self.start(None));
        vertices
    }
}

/// Returns the vertices whose coordinates lie in an axis-aligned rectangle or on its border, in
/// order of their numbers. The rectangle is given by two opposite corners. The walk to the first
/// corner starts at a cell nearby. Exact.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// That of [`Triangulation::within_rectangle`].
pub fn within_rectangle<T: Embedded<3, Geometry: Coordinates<3>>>(
    t: &T,
    corners: [&PointOf<T, 3>; 2],
    near: Option<CellId>,
) -> Result<Vec<VertexId>, T::Error> {
    let complex = t.complex();
    let location = locate(t, corners[0], near)?;
    let [p, q] = corners.map(|corner| site_of(t.geometry(), corner));
    let rectangle = Rectangle::new(p, q);
    let mut vertices = Vec::new();
    let start = if complex.width() < 3 || !rectangle.is_bounded() { None } else { location.cell_in(complex)? };
    let Some(start) = start else {
        for vertex in plane::vertices(complex) {
            let vertex = vertex?;
            if rectangle.holds(site(t, vertex)?) {
                vertices.push(vertex);
            }
        }
        return Ok(vertices);
    };
    let mut seen = FxHashSet::from_iter([start]);
    let mut met = vec![start];
    while let Some(cell) = met.pop() {
        for vertex in complex.corners(cell)? {
            if vertex != VertexId::INFINITE && rectangle.holds(site(t, vertex)?) {
                vertices.push(vertex);
            }
        }
        for i in 0..3 {
            let beside = complex.neighbor(cell, i)?;
            if meets(t, rectangle, beside)? && seen.insert(beside) {
                met.push(beside);
            }
        }
    }
    vertices.sort_unstable();
    vertices.dedup();
    Ok(vertices)
}

/// Returns true if a cell meets the rectangle, or may. Such cells are connected across edges, the
/// infinite ones by what lies beyond the hull.
fn meets<T: Embedded<3, Geometry: Coordinates<3>>>(
    t: &T,
    rectangle: Rectangle,
    cell: CellId,
) -> Result<bool, T::Error> {
    let complex = t.complex();
    let Some(infinite) = complex.index_of(cell, VertexId::INFINITE)? else {
        let [a, b, c] = complex.corners(cell)?;
        return Ok(rectangle.meets_box([site(t, a)?, site(t, b)?, site(t, c)?]));
    };
    let [a, b] = plane::edge_ends(complex, cell, infinite)?;
    let [a, b] = [site(t, a)?, site(t, b)?];
    let inner = complex.inner(cell)?;
    let apex = complex.vertex(inner, complex.index_of_neighbor(inner, cell)?)?;
    let inside = turn(a, b, site(t, apex)?);
    Ok(rectangle.corners().into_iter().any(|corner| turn(a, b, corner) != inside))
}

//! The vertices in an axis-aligned rectangle of the plane or box of space.

use std::borrow::Borrow;

use rustc_hash::FxHashSet;

use crate::embedded::{Embedded, PointOf, position};
use crate::geometry::Coordinates;
use crate::kernel::{Kernel, Orientation2, Orientation3, Wide};
use crate::locate::locate;
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId, vertices_of};
use crate::triangulation::Triangulation;

/// An axis-aligned box with its border, of two dimensions for `N = 3` and of three for `N = 4`. It
/// may be unbounded, and is empty if a coordinate is NaN. In the plane the last coordinates are
/// zero.
#[derive(Clone, Copy)]
struct Bounds<const N: usize> {
    low: [f64; 3],
    high: [f64; 3],
}

impl<const N: usize> Bounds<N> {
    fn new([p, q]: [[f64; 3]; 2]) -> Self {
        // NaN compares with nothing, and nothing lies on either side of it.
        let ends = [0, 1, 2].map(|k| {
            if p[k] <= q[k] {
                (p[k], q[k])
            } else {
                (q[k], p[k])
            }
        });
        Bounds {
            low: ends.map(|(low, _)| low),
            high: ends.map(|(_, high)| high),
        }
    }

    fn are_finite(self) -> bool {
        [self.low, self.high]
            .as_flattened()
            .iter()
            .all(|x| x.is_finite())
    }

    fn hold(self, p: [f64; 3]) -> bool {
        (0..N - 1).all(|k| self.low[k] <= p[k] && p[k] <= self.high[k])
    }

    fn corners(self) -> impl Iterator<Item = [f64; 3]> {
        (0..1 << (N - 1)).map(move |corner| {
            [0, 1, 2].map(|k| {
                if corner >> k & 1 == 0 {
                    self.low[k]
                } else {
                    self.high[k]
                }
            })
        })
    }

    /// Returns true if the box meets the bounding box of a cell, as it does if it meets the cell.
    fn meet(self, cell: [[f64; 3]; N]) -> bool {
        (0..N - 1).all(|k| {
            let [low, high] =
                [f64::min, f64::max].map(|least| cell.iter().map(|p| p[k]).fold(cell[0][k], least));
            low <= self.high[k] && self.low[k] <= high
        })
    }
}

fn orientation<const N: usize>(simplex: [[f64; 3]; N]) -> Sign {
    match simplex[..] {
        [a, b, c, d] => Wide::sign(&Orientation3([a, b, c, d])),
        [a, b, c] => Wide::sign(&Orientation2([a, b, c].map(|[x, y, _]| [x, y]))),
        _ => Sign::Zero,
    }
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

impl<G: Coordinates<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Returns the vertices whose coordinates lie in an axis-aligned box or on its border, in order
    /// of their numbers. The box is given by any two opposite corners, which may be infinite; with
    /// a NaN it is empty. Exact. Of a regular triangulation, hidden points are not vertices.
    ///
    /// # Complexity
    /// A [walk](Self::locate), and time proportional to the number of cells whose bounding boxes
    /// meet the box and, where it reaches beyond the hull, of facets of the hull there.
    /// Proportional to the number of vertices below dimension 3, if a corner is infinite, or if the
    /// geometry does not [admit](crate::geometry::Geometry::admits) the first corner.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, Delaunay};
    ///
    /// let points: Vec<[f64; 3]> = (0..125).map(|k| [k % 5, k / 5 % 5, k / 25].map(f64::from)).collect();
    /// let (t, _) = Delaunay::from_points(Space::new(), &points)?;
    /// assert_eq!(t.within_box([&[0.5, 3.0, 1.0], &[2.0, 0.5, 1.0]]).len(), 2 * 3 * 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn within_box(&self, corners: [&G::Point; 2]) -> Vec<VertexId> {
        let Ok(vertices) = within_box(self, corners, self.start(None));
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
    within(t, corners, near)
}

/// Returns the vertices whose coordinates lie in an axis-aligned box or on its border, in order of
/// their numbers. The box is given by two opposite corners. The walk to the first corner starts at
/// a cell nearby. Exact.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// That of [`Triangulation::within_box`].
pub fn within_box<T: Embedded<4, Geometry: Coordinates<4>>>(
    t: &T,
    corners: [&PointOf<T, 4>; 2],
    near: Option<CellId>,
) -> Result<Vec<VertexId>, T::Error> {
    within(t, corners, near)
}

fn within<const N: usize, T: Embedded<N, Geometry: Coordinates<N>>>(
    t: &T,
    corners: [&PointOf<T, N>; 2],
    near: Option<CellId>,
) -> Result<Vec<VertexId>, T::Error> {
    let complex = t.complex();
    let location = locate(t, corners[0], near)?;
    let bounds = Bounds::<N>::new(corners.map(|corner| position(t.geometry(), corner)));
    let mut vertices = Vec::new();
    let start = if complex.width() < N || !bounds.are_finite() {
        None
    } else {
        location.cell_in(complex)?
    };
    let Some(start) = start else {
        for vertex in vertices_of(complex) {
            let vertex = vertex?;
            if bounds.hold(site(t, vertex)?) {
                vertices.push(vertex);
            }
        }
        return Ok(vertices);
    };
    let mut seen = FxHashSet::from_iter([start]);
    let mut met = vec![start];
    while let Some(cell) = met.pop() {
        for vertex in complex.corners(cell)? {
            if vertex != VertexId::INFINITE && bounds.hold(site(t, vertex)?) {
                vertices.push(vertex);
            }
        }
        for i in 0..N {
            let beside = complex.neighbor(cell, i)?;
            if !seen.contains(&beside) && meets(t, bounds, beside)? {
                seen.insert(beside);
                met.push(beside);
            }
        }
    }
    vertices.sort_unstable();
    vertices.dedup();
    Ok(vertices)
}

/// Returns the coordinates of a finite vertex.
fn site<const N: usize, T: Embedded<N, Geometry: Coordinates<N>>>(
    t: &T,
    vertex: VertexId,
) -> Result<[f64; 3], T::Error> {
    Ok(position(t.geometry(), t.point(vertex)?.borrow()))
}

/// Returns the coordinates of a finite cell.
fn sites<const N: usize, T: Embedded<N, Geometry: Coordinates<N>>>(
    t: &T,
    cell: CellId,
) -> Result<[[f64; 3]; N], T::Error> {
    let mut sites = [[0.0; 3]; N];
    for (site_of_corner, vertex) in sites.iter_mut().zip(t.complex().corners(cell)?) {
        *site_of_corner = site(t, vertex)?;
    }
    Ok(sites)
}

/// Returns true if a cell meets the box, or may. Such cells are connected across facets, the
/// infinite ones by what lies beyond the hull.
fn meets<const N: usize, T: Embedded<N, Geometry: Coordinates<N>>>(
    t: &T,
    bounds: Bounds<N>,
    cell: CellId,
) -> Result<bool, T::Error> {
    let complex = t.complex();
    if !complex.is_infinite(cell)? {
        return Ok(bounds.meet(sites(t, cell)?));
    }
    let inner = complex.inner(cell)?;
    let beyond = complex.index_of_neighbor(inner, cell)?;
    let mut simplex = sites(t, inner)?;
    let inside = orientation(simplex);
    Ok(bounds.corners().any(|corner| {
        simplex[beyond] = corner;
        orientation(simplex) != inside
    }))
}

//! A Delaunay triangulation with the numbers of scipy: points in the order in which they were
//! given, simplices without infinite ones.

use std::convert::Infallible;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use breakline::triangulation::geometry::{Coordinates, Metric};
use breakline::triangulation::num::unsigned_zero;
use breakline::triangulation::tds::{CellId, Complex, Neighbors, Tds, VertexId};
use breakline::triangulation::{Delaunay, InputError};
use rayon::prelude::*;

use super::lists::{CHUNK, Lists};

/// No simplex, and no point.
pub(super) const NONE: i32 = -1;

/// A geometry of the plane or of space, with `D` coordinates and simplices of `N` corners.
pub(super) trait Dimension<const N: usize, const D: usize>:
    Coordinates<N, Point = [f64; D]> + Metric<N> + Copy + Default
{
    /// Returns Sibson's coordinates, see [`Delaunay::sibson`].
    fn sibson(
        t: &Delaunay<Self, N>,
        q: &[f64; D],
        near: Option<CellId>,
    ) -> Option<Vec<(VertexId, f64)>>;

    /// Returns how far a position lies inside of each facet of a positively oriented simplex: the
    /// volumes, times `D!`, that both span, each right to the last bits.
    fn sides(simplex: [[f64; D]; N], q: [f64; D]) -> [f64; N];

    /// Returns the inverse of the matrix whose rows are these; `None` if it is nearly singular.
    fn inverse(rows: [[f64; D]; D]) -> Option<[[f64; D]; D]>;
}

/// The numbers of simplices.
struct Numbers {
    /// The cell of each simplex.
    cells: Vec<CellId>,
    /// The simplex of each cell; [`NONE`] for an infinite one.
    simplex_of: Vec<i32>,
}

/// A Delaunay triangulation of input points. Each vertex is named by the first point at its site.
pub(super) struct Mesh<G: Dimension<N, D>, const N: usize, const D: usize> {
    pub(super) t: Delaunay<G, N>,
    /// The number of points.
    count: usize,
    /// The first point at each vertex.
    pub(super) point_of: Vec<i32>,
    /// The other points at vertices, in order.
    repeated: Vec<(i32, VertexId)>,
    /// Made when first asked for: not all users ask.
    numbers: OnceLock<Numbers>,
    /// The bounding box of the points: the smallest coordinates, then the largest.
    pub(super) bounds: [[f64; D]; 2],
    /// How much the largest of the coordinates may be rounded, for each axis.
    pub(super) roundings: [f64; D],
}

impl<G: Dimension<N, D>, const N: usize, const D: usize> Mesh<G, N, D> {
    /// Triangulates points; negative zeros among them become zeros.
    ///
    /// # Errors
    /// If a point is refused, or the work is canceled.
    pub(super) fn new(points: &mut [[f64; D]], cancel: &AtomicBool) -> Result<Self, InputError> {
        make_zeros_unsigned(points);
        let (t, vertices) = Delaunay::from_points_unless(G::default(), points, cancel)?;
        let bounds = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        let (point_of, repeated) = (Vec::new(), Vec::new());
        let mut mesh = Mesh {
            t,
            count: 0,
            point_of,
            repeated,
            numbers: OnceLock::new(),
            bounds,
            roundings: [0.0; D],
        };
        mesh.adopt(points, &vertices);
        Ok(mesh)
    }

    /// Inserts more points; negative zeros among them become zeros.
    ///
    /// # Errors
    /// If a point is refused; nothing has changed then.
    pub(super) fn add(&mut self, points: &mut [[f64; D]]) -> Result<(), InputError> {
        make_zeros_unsigned(points);
        let vertices = self.t.insert_all(points)?;
        self.adopt(points, &vertices);
        Ok(())
    }

    /// Numbers new points, whose vertices are given.
    fn adopt(&mut self, points: &[[f64; D]], vertices: &[VertexId]) {
        let before = self.count as i32;
        self.count += points.len();
        self.point_of.resize(self.t.tds().vertex_slots(), NONE);
        for (point, &vertex) in (before..).zip(vertices) {
            let first = &mut self.point_of[vertex.index()];
            if *first == NONE {
                *first = point;
            } else {
                self.repeated.push((point, vertex));
            }
        }
        let [low, high] = &mut self.bounds;
        for p in points {
            for axis in 0..D {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
        let largest = |axis: usize| low[axis].abs().max(high[axis].abs());
        self.roundings = std::array::from_fn(|axis| largest(axis) * f64::EPSILON);
        self.numbers = OnceLock::new();
    }

    /// Waits for nothing while it makes them, so that threads of a pool may ask.
    fn numbers(&self) -> &Numbers {
        self.numbers.get_or_init(|| {
            let cells: Vec<CellId> = if self.has_no_simplices() {
                Vec::new()
            } else {
                self.t.finite_cells().collect()
            };
            let mut simplex_of = vec![NONE; self.t.tds().cell_slots()];
            for (simplex, cell) in (0..).zip(&cells) {
                simplex_of[cell.index()] = simplex;
            }
            Numbers { cells, simplex_of }
        })
    }

    /// Returns the cell itself if it is finite, or the finite one across the hull.
    pub(super) fn inside_of(&self, cell: CellId) -> CellId {
        let Ok(inside) = self.t.tds().inner(cell);
        inside
    }

    /// The cell of each simplex.
    pub(super) fn cells(&self) -> &[CellId] {
        &self.numbers().cells
    }

    /// The points at the site of an earlier one, each with the first there.
    pub(super) fn repeated_points(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let first = |vertex: VertexId| self.point_of[vertex.index()] as usize;
        let repeated = self.repeated.iter();
        repeated.map(move |&(point, vertex)| (point as usize, first(vertex)))
    }

    /// Returns true if the points do not span the plane or the space.
    pub(super) fn has_no_simplices(&self) -> bool {
        self.t.dimension() < D as i32
    }

    /// The number of input points.
    pub(super) fn point_count(&self) -> usize {
        self.count
    }

    /// The number of simplices; 0 if the points do not span the plane or the space.
    pub(super) fn simplex_count(&self) -> usize {
        self.numbers().cells.len()
    }

    /// Returns the simplex of a finite cell.
    pub(super) fn simplex(&self, cell: CellId) -> i32 {
        self.numbers().simplex_of[cell.index()]
    }

    /// Returns the corners of all simplices, as points.
    pub(super) fn simplices(&self) -> Vec<[i32; N]> {
        self.of_cells(|cell| self.t.tds().corners(cell).map(|v| self.point_of[v.index()]))
    }

    /// Returns the simplex opposite each corner; [`NONE`] beyond the hull.
    pub(super) fn neighbors(&self) -> Vec<[i32; N]> {
        self.of_cells(|cell| std::array::from_fn(|i| self.simplex(self.t.tds().neighbor(cell, i))))
    }

    /// Returns the affine maps from positions to barycentric coordinates: for each simplex `D` rows
    /// of an inverse matrix, then its last corner; not numbers where a simplex is nearly flat.
    pub(super) fn transforms(&self) -> Vec<[[f64; D]; N]> {
        self.of_cells(|cell| {
            let corners = self.t.tds().corners(cell).map(|v| *self.t.point(v));
            let last = corners[D];
            // Column `i` is the vector from the last corner to corner `i`.
            let matrix =
                std::array::from_fn(|row| std::array::from_fn(|i| corners[i][row] - last[row]));
            let mut map = [last; N];
            match G::inverse(matrix) {
                Some(inverse) => map[..D].copy_from_slice(&inverse),
                None => map = [[f64::NAN; D]; N],
            }
            map
        })
    }

    fn of_cells<T: Send>(&self, value: impl Fn(CellId) -> T + Sync) -> Vec<T> {
        self.numbers()
            .cells
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&cell| value(cell))
            .collect()
    }

    /// Returns the facets of the convex hull, as points: the corners of a simplex without one of
    /// them, in their order.
    pub(super) fn hull(&self) -> Vec<[i32; D]> {
        let mut facets = Vec::new();
        for &cell in &self.numbers().cells {
            for k in 0..N {
                if self.simplex(self.t.tds().neighbor(cell, k)) == NONE {
                    let corner =
                        |j: usize| self.t.tds().vertex(cell, if j < k { j } else { j + 1 });
                    facets.push(std::array::from_fn(|j| self.point_of[corner(j).index()]));
                }
            }
        }
        facets
    }

    /// Returns the points that are not corners, because another point is at their site: their
    /// number, a simplex there, and that other point.
    pub(super) fn coplanar(&self) -> Vec<[i32; 3]> {
        let at = self.simplices_at();
        let listed = self.repeated_points();
        listed
            .map(|(point, first)| [point as i32, at[first], first as i32])
            .collect()
    }

    /// Returns a simplex at each point: the first that has its site as a corner.
    pub(super) fn simplex_at(&self) -> Vec<i32> {
        let mut at = self.simplices_at();
        for (point, first) in self.repeated_points() {
            at[point] = at[first];
        }
        at
    }

    fn simplices_at(&self) -> Vec<i32> {
        let mut at = vec![NONE; self.point_count()];
        for (simplex, &cell) in self.numbers().cells.iter().enumerate().rev() {
            for v in self.t.tds().corners(cell) {
                at[self.point_of[v.index()] as usize] = simplex as i32;
            }
        }
        at
    }

    /// Returns the vertex of each point that is the first at its site.
    pub(super) fn first_at_vertices(&self) -> Vec<Option<VertexId>> {
        let mut vertex_of = vec![None; self.point_count()];
        for (vertex, &point) in self.point_of.iter().enumerate() {
            if point != NONE {
                vertex_of[point as usize] = Some(VertexId::new(vertex));
            }
        }
        vertex_of
    }

    /// Returns the vertex of each point.
    pub(super) fn vertices_of_points(&self) -> Vec<VertexId> {
        let firsts = self.first_at_vertices();
        let mut vertices: Vec<VertexId> = firsts
            .into_iter()
            .map(|vertex| vertex.unwrap_or(VertexId::INFINITE))
            .collect();
        for &(point, vertex) in &self.repeated {
            vertices[point as usize] = vertex;
        }
        vertices
    }

    /// Returns the neighbors of each point. A point that is not a corner has none.
    pub(super) fn neighbor_points(&self) -> Lists
    where
        Tds<N>: Neighbors<N, Error = Infallible>,
    {
        Lists::of(&self.first_at_vertices(), |&vertex, neighbors| {
            let Some(vertex) = vertex else { return };
            let Ok(around) = self.t.tds().neighbors_of(vertex);
            let finite = around.map(|Ok(v)| v).filter(|&v| v != VertexId::INFINITE);
            neighbors.extend(finite.map(|v| self.point_of[v.index()]));
            if D > 2 {
                // In space a neighbor may be met several times.
                neighbors.sort_unstable();
                neighbors.dedup();
            }
        })
    }
}

/// Negative zeros become zeros: equal points are recognized by their bits.
pub(super) fn make_zeros_unsigned<const D: usize>(points: &mut [[f64; D]]) {
    let chunks = points.as_flattened_mut().par_chunks_mut(CHUNK);
    chunks.for_each(|chunk| chunk.iter_mut().for_each(|x| *x = unsigned_zero(*x)));
}

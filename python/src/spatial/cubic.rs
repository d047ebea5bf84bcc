//! Interpolation by cubic macro-elements in the plane, with the gradients of
//! `scipy.interpolate.CloughTocher2DInterpolator`.
//!
//! # Gradients
//!
//! The curvature along all edges is minimized: the sum over the edges of the integral of the square
//! of the second derivative (Nielson 1983; Renka and Cline 1984). Over an edge `e` of length `L`
//! the surface is the cubic polynomial of the values and slopes at both ends. So with the gradient
//! `h` at the other end, the sum for one vertex is least where its gradient `g` solves
//!
//! ```text
//!     2 (sum of u u^T) g = sum of u (3 (f' - f) / sqrt(L^3) - u^T h),   u = e / sqrt(L^3),
//! ```
//!
//! with `f` and `f'` the values at the vertex and at the other end. Vertices are visited in the
//! order of the points, again and again (Gauss and Seidel), beginning with level gradients, until
//! none changes by more than a tolerance. Order, start and end are those of scipy, because what is
//! left of the error depends on them.
//!
//! # Directions
//!
//! The slope across an edge is linear along it in the direction between the two corners opposite
//! that edge, on the hull in that of the centroid. Unlike the normal, this direction does not
//! depend on the scale of the axes.

use std::convert::Infallible;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use breakline::terrain::CubicElement;
use breakline::triangulation::geometry::Plane;
use breakline::triangulation::tds::{CellId, Neighbors, VertexId};
use numpy::ndarray::Array3;
use rayon::prelude::*;

use super::lists::CHUNK;
use super::mesh::Mesh;
use super::queries::{Field, Site};

/// When the iteration for gradients ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// The largest change of a gradient, relative if it is larger than 1.
    pub(super) tolerance: f64,
    /// How often all vertices are visited.
    pub(super) rounds: usize,
}

/// Gradients at the vertices: one for each column of values.
pub(super) struct Gradients {
    columns: Vec<Vec<[f64; 2]>>,
    /// True if they changed by no more than the tolerance at the end.
    pub(super) have_converged: bool,
}

/// The edges at all vertices, in the order in which these are visited.
struct Network {
    /// In the order of their points.
    vertices: Vec<Hub>,
    /// Those of the first vertex, then those of the second, and so on.
    spokes: Vec<Spoke>,
}

struct Hub {
    vertex: VertexId,
    /// The number of its edges.
    count: usize,
    /// Half of the inverse of the sum of `u u^T`: its first row, and the last number.
    half_inverse: [f64; 3],
}

struct Spoke {
    to: VertexId,
    /// The edge over the square root of the cube of its length.
    scaled: [f64; 2],
}

impl Network {
    fn new(mesh: &Mesh<Plane, 3, 2>) -> Self {
        let vertices = mesh.first_at_vertices();
        let mut network = Network {
            vertices: Vec::with_capacity(vertices.len()),
            spokes: Vec::with_capacity(6 * vertices.len()),
        };
        for vertex in vertices.into_iter().flatten() {
            network.add(mesh, vertex);
        }
        network
    }

    fn add(&mut self, mesh: &Mesh<Plane, 3, 2>, vertex: VertexId) {
        let start = self.spokes.len();
        let from = *mesh.t.point(vertex);
        let Ok(neighbors) = mesh.t.tds().neighbors_of(vertex);
        for Ok::<_, Infallible>(to) in neighbors {
            if to != VertexId::INFINITE {
                let [x, y] = minus(*mesh.t.point(to), from);
                let length = x.hypot(y);
                let scale = 1.0 / (length * length.sqrt());
                self.spokes.push(Spoke {
                    to,
                    scaled: [x * scale, y * scale],
                });
            }
        }
        let spokes = &self.spokes[start..];
        self.vertices.push(Hub {
            vertex,
            count: spokes.len(),
            half_inverse: half_inverse(spokes),
        });
    }

    /// Calls `visit` for each vertex with its number in the order of visits, and its edges.
    fn each<'a>(&'a self, mut visit: impl FnMut(usize, &'a Hub, &'a [Spoke])) {
        let mut rest = &self.spokes[..];
        for (rank, hub) in self.vertices.iter().enumerate() {
            let (spokes, others) = rest.split_at(hub.count);
            rest = others;
            visit(rank, hub, spokes);
        }
    }

    /// Returns the gradients of values, and true if they have converged.
    fn gradients(
        &self,
        slots: usize,
        value: impl Fn(VertexId) -> f64,
        limits: Limits,
        cancel: &AtomicBool,
    ) -> (Vec<[f64; 2]>, bool) {
        // What does not change from round to round.
        let mut pulls = Vec::with_capacity(self.vertices.len());
        self.each(|_, hub, spokes| {
            let here = value(hub.vertex);
            pulls.push(spokes.iter().fold([0.0; 2], |[x, y], spoke| {
                let [ux, uy] = spoke.scaled;
                // The length of the edge is 1 over this.
                let inverse = ux * ux + uy * uy;
                let scale = 3.0 * (value(spoke.to) - here) * inverse * inverse.sqrt();
                [x + scale * ux, y + scale * uy]
            }));
        });
        let mut gradients = vec![[0.0; 2]; slots];
        for _ in 0..limits.rounds {
            let mut largest = 0.0_f64;
            self.each(|rank, hub, spokes| {
                let pull = spokes.iter().fold(pulls[rank], |[x, y], spoke| {
                    let ([ux, uy], [gx, gy]) = (spoke.scaled, gradients[spoke.to.index()]);
                    let along = ux * gx + uy * gy;
                    [x - along * ux, y - along * uy]
                });
                let [xx, xy, yy] = hub.half_inverse;
                let new = [xx * pull[0] + xy * pull[1], xy * pull[0] + yy * pull[1]];
                let old = std::mem::replace(&mut gradients[hub.vertex.index()], new);
                let greatest = |[x, y]: [f64; 2]| x.abs().max(y.abs());
                let change = greatest([new[0] - old[0], new[1] - old[1]]);
                largest = largest.max(change / greatest(new).max(1.0));
            });
            if largest < limits.tolerance {
                return (gradients, true);
            }
            if cancel.load(Ordering::Relaxed) {
                break;
            }
        }
        (gradients, false)
    }
}

/// Returns half of the inverse of the sum of `u u^T`. If all edges are nearly in a line, the
/// surface is level across it.
fn half_inverse(spokes: &[Spoke]) -> [f64; 3] {
    let [xx, xy, yy] = spokes.iter().fold([0.0; 3], |[xx, xy, yy], spoke| {
        let [x, y] = spoke.scaled;
        [xx + x * x, xy + x * y, yy + y * y]
    });
    let (determinant, spread) = (xx * yy - xy * xy, xx + yy);
    if determinant > 4.0 * f64::EPSILON * spread * spread {
        let half = 0.5 / determinant;
        [yy * half, -xy * half, xx * half]
    } else {
        let half = 0.5 / spread;
        [half, 0.0, half]
    }
}

/// What cubic values are computed from.
pub(super) struct Surface {
    gradients: Gradients,
    /// The elements over all triangles, by the numbers of their cells, one for each column of
    /// values. They take 152 bytes each, and are made when first worth it.
    elements: OnceLock<Vec<CubicElement>>,
}

impl Surface {
    pub(super) fn new(gradients: Gradients) -> Self {
        Surface {
            gradients,
            elements: OnceLock::new(),
        }
    }

    pub(super) fn gradients(&self) -> &Gradients {
        &self.gradients
    }
}

/// How many times as many positions as cells there must be before the elements of all are made:
/// so many that most elements are used, and that they take about three times the memory of the
/// positions and one column of values.
const MANY: usize = 2;

/// The elements over the last triangle in which a position was: one for each column of values.
struct Patch {
    cell: Option<CellId>,
    elements: Vec<CubicElement>,
}

impl Mesh<Plane, 3, 2> {
    /// Returns the gradients of values that make the curvature along edges least.
    pub(super) fn gradients(
        &self,
        field: &Field,
        limits: Limits,
        cancel: &AtomicBool,
    ) -> Gradients {
        let network = Network::new(self);
        let slots = self.point_of.len();
        let (columns, converged): (Vec<_>, Vec<bool>) = (0..field.width())
            .into_par_iter()
            .map(|column| {
                let value = |vertex: VertexId| field.at(vertex)[column];
                network.gradients(slots, value, limits, cancel)
            })
            .unzip();
        Gradients {
            columns,
            have_converged: converged.into_iter().all(|has| has),
        }
    }

    /// Returns the gradients at all points, for each column of values: an array of shape (n, k, 2).
    pub(super) fn gradients_at_points(&self, gradients: &Gradients) -> Array3<f64> {
        let vertices = self.vertices_of_points();
        let shape = (vertices.len(), gradients.columns.len(), 2);
        Array3::from_shape_fn(shape, |(point, column, axis)| {
            gradients.columns[column][vertices[point].index()][axis]
        })
    }

    /// Returns cubic values, and `outside` beyond the hull.
    pub(super) fn cubic(
        &self,
        queries: &[[f64; 2]],
        (field, surface): (&Field, &Surface),
        outside: &[f64],
        tolerance: f64,
        cancel: &AtomicBool,
    ) -> Vec<f64> {
        let (width, gradients) = (field.width(), &surface.gradients);
        let table = self.table(queries.len(), field, surface);
        self.each(queries, outside, cancel, || {
            let mut patch = Patch {
                cell: None,
                elements: vec![CubicElement::FLAT; width],
            };
            move |q, start, values: &mut [f64]| {
                let (site, near) = self.site(q, start, tolerance);
                match site {
                    Site::Vertex(vertex) => values.copy_from_slice(field.at(vertex)),
                    Site::Cell(cell, parts) => {
                        let elements = match table {
                            Some(table) => &table[cell.index() * width..][..width],
                            None => {
                                if patch.cell != Some(cell) {
                                    patch.cell = Some(cell);
                                    let triangle = self.triangle(cell);
                                    for (column, element) in patch.elements.iter_mut().enumerate() {
                                        *element = triangle.element(field, gradients, column);
                                    }
                                }
                                &patch.elements
                            }
                        };
                        // Relative to one corner, so that constant values are reproduced.
                        let origin = field.at(self.t.tds().vertex(cell, 0));
                        for ((value, element), origin) in
                            values.iter_mut().zip(elements).zip(origin)
                        {
                            *value = origin + element.height(parts);
                        }
                    }
                    Site::Outside => {}
                }
                near
            }
        })
    }

    /// Returns the elements over all triangles if they were made before, or if this number of
    /// positions is worth making them.
    fn table<'a>(
        &self,
        positions: usize,
        field: &Field,
        surface: &'a Surface,
    ) -> Option<&'a [CubicElement]> {
        let new = || -> Vec<CubicElement> {
            let cells = (0..self.t.tds().cell_slots())
                .into_par_iter()
                .map(CellId::new);
            let of_cell = |cell: CellId| {
                let is_absent = !self.t.tds().is_used(cell) || self.t.tds().is_infinite(cell);
                let none =
                    is_absent.then(|| std::iter::repeat_n(CubicElement::FLAT, field.width()));
                let some = (!is_absent).then(|| {
                    let triangle = self.triangle(cell);
                    let columns = 0..field.width();
                    columns.map(move |k| triangle.element(field, &surface.gradients, k))
                });
                none.into_iter().flatten().chain(some.into_iter().flatten())
            };
            cells.with_min_len(CHUNK).flat_map_iter(of_cell).collect()
        };
        let table = surface.elements.get();
        let table = table.or_else(|| {
            // Not made under a lock: a thread of a pool that waits may take up another call, which
            // would ask for it, too. Both may make it then; one is kept.
            (positions >= MANY * self.t.tds().cell_slots()).then(|| {
                let new = new();
                surface.elements.get_or_init(|| new)
            })
        });
        table.map(Vec::as_slice)
    }

    /// Returns what all elements over a triangle have in common.
    #[inline(always)]
    fn triangle(&self, cell: CellId) -> Triangle {
        let (tds, points) = (self.t.tds(), self.t.points());
        let vertices = *tds.corners(cell);
        let corners = vertices.map(|v| points[v.index()]);
        let numbers = vertices.map(VertexId::index);
        let feet = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            // `PERF:` what three numbers have more than two of them is the third, without a branch
            // or a search.
            let beyond = tds.corners(tds.neighbor(cell, i)).map(VertexId::index);
            let apex = beyond.iter().sum::<usize>() - numbers[j] - numbers[k];
            // The infinite vertex has no point.
            let Some(&apex) = points.get(apex) else {
                return 0.5;
            };
            // The line between both centroids is parallel to that between the apexes.
            let direction = minus(apex, corners[i]);
            let from_j = |corner: usize| cross(minus(corners[corner], corners[j]), direction);
            let foot = (1.0 + from_j(i) / from_j(k)) / 3.0;
            if foot.is_finite() { foot } else { 0.5 }
        });
        Triangle {
            vertices,
            corners,
            feet,
        }
    }
}

/// A triangle as elements need it.
struct Triangle {
    vertices: [VertexId; 3],
    corners: [[f64; 2]; 3],
    /// In which directions the slopes across its edges are linear, see [`CubicElement::new`].
    feet: [f64; 3],
}

impl Triangle {
    /// Returns the element for one column of values, relative to that at the first corner.
    #[inline(always)]
    fn element(&self, field: &Field, gradients: &Gradients, column: usize) -> CubicElement {
        let values = self.vertices.map(|v| field.at(v)[column]);
        let gradients = &gradients.columns[column];
        let corners = [0, 1, 2].map(|i| {
            let [x, y] = self.corners[i];
            [x, y, values[i] - values[0]]
        });
        CubicElement::new(
            corners,
            self.vertices.map(|v| gradients[v.index()]),
            self.feet,
        )
    }
}

fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

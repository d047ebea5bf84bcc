//! Voronoi diagrams in space, and what they share with [power diagrams](super::power).
//!
//! | of the triangulation | of the diagram |
//! |---|---|
//! | cell | vertex: the center of its sphere |
//! | facet | [edge](VoronoiEdge) |
//! | edge | [facet](VoronoiFacet) |
//! | vertex | [cell](VoronoiSolid) |
//!
//! The spheres of the [geometry](crate::geometry::Coordinates) must be spheres in its coordinates,
//! as they are for [`Space`](crate::geometry::Space). Results are rounded.

use crate::geometry::{Coordinates, Geometry};
use crate::kernel;
use crate::kinds::Delaunay;
use crate::num::unsigned_zero;
use crate::query::dual::{HalfSpace, VoronoiEdge, dot, minus, plus};
use crate::tds::space::{Edge, OUTWARD};
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

/// The part of a box that is nearest to one vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct VoronoiSolid {
    /// The facets, those towards neighbors in order of their numbers, then those on the box. What
    /// lies in a side of the box is on the box; up to rounding, it may be in parts, of which some
    /// are on the box. None if the cell has no volume in the box.
    pub facets: Vec<VoronoiFacet>,
    /// The volume, in cubic units of the coordinates.
    pub volume: f64,
}

impl VoronoiSolid {
    pub(super) const EMPTY: Self = VoronoiSolid {
        facets: Vec::new(),
        volume: 0.0,
    };
}

/// A convex polygon between the cells of two vertices, or where a cell meets the side of a box.
#[derive(Debug, Clone, PartialEq)]
pub struct VoronoiFacet {
    /// The vertex whose cell is on the other side; `None` on the box.
    pub beyond: Option<VertexId>,
    /// The corners, counter-clockwise as seen from the other side. Where more than four points lie
    /// on a sphere, a facet may have no area, or that of a rounding.
    pub corners: Vec<[f64; 3]>,
}

pub(super) fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i])
}

/// What half spaces leave of a box: a surface that is closed, however its corners are rounded.
struct Polyhedron {
    facets: Vec<VoronoiFacet>,
}

impl Polyhedron {
    /// Removes what is beyond a half space, which is bounded by the cell of a vertex.
    ///
    /// Each corner is on one side for all facets that it belongs to, and each side is cut at one
    /// point. So the new sides of the facets close up to the facet in the plane of the cut, also
    /// where that plane is the one of another facet up to rounding: neither is lost, or counted
    /// twice.
    fn cut(&mut self, half_space: &HalfSpace<3>, beyond: VertexId) {
        let corners = || {
            self.facets
                .iter()
                .flat_map(|facet| &facet.corners)
                .map(|&p| half_space.excess(p))
        };
        if corners().all(|excess| excess <= 0.0) {
            return;
        }
        if corners().all(|excess| excess >= 0.0) {
            return self.facets.clear();
        }
        let mut sides = Vec::new();
        for facet in &mut self.facets {
            // The new facet has the side in the other direction.
            let new_side = |[from, to]: [[f64; 3]; 2]| {
                if from != to {
                    sides.push([to, from]);
                }
            };
            facet.corners =
                half_space.clip_with_sides(std::mem::take(&mut facet.corners), new_side);
        }
        let new = polygons(sides).into_iter().map(|corners| VoronoiFacet {
            beyond: Some(beyond),
            corners,
        });
        self.facets.extend(new);
        // What has no area has its sides in both directions: the surface remains closed without it.
        self.facets.retain(|facet| facet.corners.len() > 2);
    }

    /// Returns the volume: that of the pyramids over the facets, from one of the corners.
    fn volume(&self) -> f64 {
        let Some(&apex) = self.facets.first().and_then(|facet| facet.corners.first()) else {
            return 0.0;
        };
        let six_volumes = |facet: &VoronoiFacet| -> f64 {
            let mut corners = facet.corners.iter().map(|&p| minus(p, apex));
            let Some(first) = corners.next() else {
                return 0.0;
            };
            let others: Vec<[f64; 3]> = corners.collect();
            others
                .windows(2)
                .map(|pair| dot(first, cross(pair[0], pair[1])))
                .sum()
        };
        unsigned_zero((self.facets.iter().map(six_volumes).sum::<f64>() / 6.0).max(0.0))
    }
}

/// Joins sides to polygons: each begins where another ends. There are few.
fn polygons(mut sides: Vec<[[f64; 3]; 2]>) -> Vec<Vec<[f64; 3]>> {
    let mut polygons = Vec::new();
    while let Some([start, mut end]) = sides.pop() {
        let mut polygon = vec![start];
        // No side follows if a corner is not a number, because a product overflowed.
        while let Some(next) = sides.iter().position(|side| end != start && side[0] == end) {
            polygon.push(end);
            end = sides.swap_remove(next)[1];
        }
        polygons.push(polygon);
    }
    polygons
}

/// Returns the part of a polygon in all half spaces.
fn clipped(
    polygon: Vec<[f64; 3]>,
    half_spaces: impl IntoIterator<Item = HalfSpace<3>>,
) -> Vec<[f64; 3]> {
    half_spaces
        .into_iter()
        .fold(polygon, |polygon, half_space| half_space.clip(polygon))
}

/// A box with sides along the axes: the lowest and the highest corner.
#[derive(Clone, Copy)]
struct Box3 {
    corners: [[f64; 3]; 2],
}

impl Box3 {
    /// Returns the box of two opposite corners, relative to a site; `None` if one is not finite.
    fn new([p, q]: [[f64; 3]; 2], site: [f64; 3]) -> Option<Self> {
        let corner = |of: fn(f64, f64) -> f64| minus([0, 1, 2].map(|k| of(p[k], q[k])), site);
        let corners = [corner(f64::min), corner(f64::max)];
        let is_finite = [p, q]
            .iter()
            .chain(&corners)
            .flatten()
            .all(|x| x.is_finite());
        is_finite.then_some(Box3 { corners })
    }

    /// The half spaces whose common part is the box.
    fn half_spaces(self) -> impl Iterator<Item = HalfSpace<3>> {
        [-1.0, 1.0]
            .into_iter()
            .zip(self.corners)
            .flat_map(|(sign, corner)| {
                [0, 1, 2].map(|axis| {
                    let mut normal = [0.0; 3];
                    normal[axis] = sign;
                    HalfSpace {
                        normal,
                        offset: sign * corner[axis],
                    }
                })
            })
    }

    /// The sides, counter-clockwise as seen from outside.
    fn sides(self) -> impl Iterator<Item = Vec<[f64; 3]>> {
        let side = move |axis: usize, end: usize| {
            let around = if end == 0 {
                [[0, 0], [0, 1], [1, 1], [1, 0]]
            } else {
                [[0, 0], [1, 0], [1, 1], [0, 1]]
            };
            let corner = |[along, across]: [usize; 2]| {
                let mut corner = self.corners[end];
                for (turn, which) in [(1, along), (2, across)] {
                    corner[(axis + turn) % 3] = self.corners[which][(axis + turn) % 3];
                }
                corner
            };
            around.map(corner).to_vec()
        };
        (0..6).map(move |k| side(k / 2, k % 2))
    }

    /// Returns a square in the plane that bounds a half space, counter-clockwise as seen from
    /// beyond: it contains the part of the plane that is in the box. Empty if there is none.
    fn square_around_section(self, plane: &HalfSpace<3>) -> Vec<[f64; 3]> {
        let [low, high] = self.corners;
        let middle = [0, 1, 2].map(|k| low[k] / 2.0 + high[k] / 2.0);
        let square = dot(plane.normal, plane.normal);
        let away = (plane.offset - dot(plane.normal, middle)) / square;
        let diagonal = minus(high, low);
        // More than half as wide as the section, which it contains.
        let width = dot(diagonal, diagonal).sqrt();
        let distance = away.abs() * square.sqrt();
        if distance.is_nan() || distance > width {
            return Vec::new();
        }
        let foot = plus(middle, plane.normal.map(|x| away * x));
        let unit = |p: [f64; 3]| {
            let length = dot(p, p).sqrt();
            p.map(|x| x / length)
        };
        let normal = plane.normal.map(|x| x / square.sqrt());
        let least = (0..3)
            .min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()))
            .unwrap_or(0);
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        let along = unit(cross(normal, axis));
        let across = cross(normal, along);
        let corner = |[s, t]: [f64; 2]| {
            plus(
                foot,
                [0, 1, 2].map(|k| width * (s * along[k] + t * across[k])),
            )
        };
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner);
        square.to_vec()
    }
}

/// A diagram of points with weights, or without.
pub(super) struct Diagram<'t, G: Geometry<4>, V, C, W> {
    pub(super) t: &'t Triangulation<G, 4, V, C>,
    /// Returns the coordinates of a point and its weight.
    pub(super) weighted: W,
}

impl<G: Geometry<4>, V, C: Copy + Default, W: Fn(&G::Point) -> [f64; 4]> Diagram<'_, G, V, C, W> {
    fn point(&self, vertex: VertexId) -> [f64; 4] {
        (self.weighted)(self.t.point(vertex))
    }

    /// Returns the point that has the same power to all corners of a finite cell of dimension 3.
    pub(super) fn center(&self, cell: CellId) -> Option<[f64; 3]> {
        let tds = self.t.tds();
        if self.t.dimension() < 3 || !tds.is_used(cell) || tds.is_infinite(cell) {
            return None;
        }
        let corners = tds.corners(cell).map(|vertex| self.point(vertex));
        Some(plus(
            site(corners[0]),
            kernel::power_center_in_space(corners),
        ))
    }

    /// Returns the dual of a facet; see [`Delaunay::voronoi_edge`].
    pub(super) fn edge(&self, (cell, i): (CellId, usize)) -> Option<VoronoiEdge<3>> {
        let tds = self.t.tds();
        let is_facet = tds.is_used(cell)
            && if self.t.dimension() == 3 {
                i < 4
            } else {
                i == 3
            };
        if self.t.dimension() < 2 || !is_facet {
            return None;
        }
        let vertices = OUTWARD[i].map(|k| tds.vertex(cell, k));
        if vertices.contains(&VertexId::INFINITE) {
            return None;
        }
        let corners = vertices.map(|vertex| self.point(vertex));
        let [a, b, c] = corners.map(site);
        let direction = kernel::normal_of_facet([a, b, c]);
        if self.t.dimension() == 2 {
            return Some(VoronoiEdge::Line {
                through: plus(a, kernel::power_center_of_facet(corners)),
                direction,
            });
        }
        Some(
            match [cell, tds.neighbor(cell, i)].map(|cell| self.center(cell)) {
                [Some(from), Some(to)] => VoronoiEdge::Segment([from, to]),
                [Some(from), None] => VoronoiEdge::Ray { from, direction },
                [None, from] => VoronoiEdge::Ray {
                    from: from?,
                    direction: direction.map(|x| -x),
                },
            },
        )
    }

    /// Returns the points of no more power to one point, the origin, than to a vertex.
    fn half_space(&self, of: [f64; 4], vertex: VertexId) -> HalfSpace<3> {
        let other = self.point(vertex);
        HalfSpace::of_less_power(minus(site(other), site(of)), of[3] - other[3])
    }

    /// Returns the dual of a finite edge, in a box; relative to the start of the edge. It is
    /// bounded by the cells of those vertices only that form a facet with the edge.
    fn facet(&self, edge: Edge, within: Box3) -> Vec<[f64; 3]> {
        let [start, end] = self.t.tds().edge_ends(edge);
        let of = self.point(start);
        let around = self
            .t
            .tds()
            .vertices_around_edge(edge)
            .filter(|&vertex| vertex != VertexId::INFINITE);
        let square = within.square_around_section(&self.half_space(of, end));
        clipped(
            square,
            around
                .map(|vertex| self.half_space(of, vertex))
                .chain(within.half_spaces()),
        )
    }

    /// Returns the dual of an edge; see [`Delaunay::voronoi_facet`].
    pub(super) fn facet_within(
        &self,
        (cell, i, j): Edge,
        within: [[f64; 3]; 2],
    ) -> Option<VoronoiFacet> {
        let tds = self.t.tds();
        if !tds.is_used(cell) || i == j || i.max(j) >= tds.cell_vertices(cell).len() {
            return None;
        }
        let [start, end] = tds.edge_ends((cell, i, j));
        if [start, end].contains(&VertexId::INFINITE) {
            return None;
        }
        let at = site(self.point(start));
        let corners =
            Box3::new(within, at).map_or_else(Vec::new, |within| self.facet((cell, i, j), within));
        Some(VoronoiFacet {
            beyond: Some(end),
            corners: corners.into_iter().map(|p| plus(p, at)).collect(),
        })
    }

    /// Returns the dual of a vertex, in a box; see [`Delaunay::voronoi_cell`].
    pub(super) fn cell(&self, vertex: VertexId, within: [[f64; 3]; 2]) -> VoronoiSolid {
        let tds = self.t.tds();
        if !tds.is_vertex(vertex) {
            return VoronoiSolid::EMPTY;
        }
        let of = self.point(vertex);
        let Some(within) = Box3::new(within, site(of)) else {
            return VoronoiSolid::EMPTY;
        };
        let sides = within.sides().map(|corners| VoronoiFacet {
            beyond: None,
            corners,
        });
        let mut polyhedron = Polyhedron {
            facets: sides.collect(),
        };
        for other in tds
            .vertices_around(vertex)
            .into_iter()
            .filter(|&other| other != VertexId::INFINITE)
        {
            polyhedron.cut(&self.half_space(of, other), other);
        }
        let volume = polyhedron.volume();
        let mut facets = polyhedron.facets;
        for facet in &mut facets {
            facet
                .corners
                .iter_mut()
                .for_each(|p| *p = plus(*p, site(of)));
        }
        facets.sort_by_key(|facet| (facet.beyond.is_none(), facet.beyond));
        VoronoiSolid { facets, volume }
    }
}

fn site([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

impl<G: Coordinates<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Returns the center of the sphere around a finite cell of dimension 3, ignoring weights;
    /// `None` if the cell is not one. Accurate to a few units in the last place of the larger of
    /// its coordinates and its [distance](kernel::power_center_in_space) from the corners. O(1).
    pub fn circumcenter(&self, cell: CellId) -> Option<[f64; 3]> {
        self.voronoi_diagram().center(cell)
    }

    fn voronoi_diagram(&self) -> Diagram<'_, G, V, C, impl Fn(&G::Point) -> [f64; 4]> {
        let weighted = |p: &G::Point| {
            let [x, y, z] = crate::query::site_of(&self.geometry, p);
            [x, y, z, 0.0]
        };
        Diagram { t: self, weighted }
    }
}

impl<G: Coordinates<4>, V, C: Copy + Default> Delaunay<G, 4, V, C> {
    /// Returns the edge of the Voronoi diagram at which the cells of the corners of a facet meet,
    /// given as a cell and the index of the vertex opposite.
    ///
    /// A segment runs from the center of the cell to that of the other one. `None` for facets with
    /// the infinite vertex, and if there is no such facet: in dimension 2 a face has index 3, below
    /// that there are none. O(1).
    pub fn voronoi_edge(&self, facet: (CellId, usize)) -> Option<VoronoiEdge<3>> {
        self.voronoi_diagram().edge(facet)
    }

    /// Returns the facet of the Voronoi diagram between the cells of the ends of an edge, clipped
    /// to a box, which is given by two opposite corners. It is counter-clockwise as seen from the
    /// end of the edge, and has no corners outside of the box. `None` for edges with the infinite
    /// vertex, and if there is no such edge.
    ///
    /// # Complexity
    /// The number of cells around the edge times the number of corners of the facet.
    pub fn voronoi_facet(&self, edge: Edge, within: [[f64; 3]; 2]) -> Option<VoronoiFacet> {
        self.voronoi_diagram().facet_within(edge, within)
    }

    /// Returns the Voronoi cell of a finite vertex, clipped to a box, which is given by two
    /// opposite corners.
    ///
    /// The cells of all vertices fill the box, in every dimension, as long as cubes of distances
    /// neither overflow nor underflow (distances between about `1e-100` and `1e100`). The cell has
    /// no facets if the vertex does not exist or a corner of the box is not finite.
    ///
    /// # Complexity
    /// The number of neighbors times that of the corners: about 15 and 25 for points that fill a
    /// volume evenly.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, Delaunay};
    ///
    /// let mut points: Vec<[f64; 3]> = (0..8).map(|k| [k % 2, k / 2 % 2, k / 4].map(|x| f64::from(2 * x + 1))).collect();
    /// points.push([2.0, 2.0, 2.0]);
    /// let (t, v) = Delaunay::from_points(Space::new(), &points)?;
    /// let cube = [[0.0, 0.0, 0.0], [4.0, 4.0, 4.0]];
    /// let middle = t.voronoi_cell(v[8], cube);
    /// assert_eq!(middle.facets.iter().filter(|facet| facet.beyond.is_some()).count(), 8);
    /// let volumes: f64 = v.iter().map(|&v| t.voronoi_cell(v, cube).volume).sum();
    /// assert!((volumes - 64.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn voronoi_cell(&self, vertex: VertexId, within: [[f64; 3]; 2]) -> VoronoiSolid {
        self.voronoi_diagram().cell(vertex, within)
    }
}

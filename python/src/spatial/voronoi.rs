//! Voronoi diagrams, as scipy lists them: the dual of a triangulation, in which all simplices on
//! one sphere have one vertex.
//!
//! Whether they are on one sphere is decided exactly. So rounding neither adds ridges without a
//! length or an area, nor removes others.

use std::ops::Range;

use breakline::triangulation::geometry::{Geometry, Plane, Space};
use breakline::triangulation::num::Sign;
use breakline::triangulation::tds::space::beside;
use breakline::triangulation::tds::{CellId, VertexId};
use rayon::prelude::*;

use super::groups::Groups;
use super::lists::{CHUNK, Lists, Part};
use super::mesh::{Dimension, Mesh, NONE};

/// A Voronoi diagram. Its vertices are numbered; [`NONE`] is the one at infinity.
pub(super) struct Diagram<const D: usize> {
    pub(super) vertices: Vec<[f64; D]>,
    /// The points on both sides of each ridge.
    pub(super) ridge_points: Vec<[i32; 2]>,
    /// The vertices around each ridge; the one at infinity is the first.
    pub(super) ridges: Lists,
    /// The vertices of the region of each point that is the first at its site; the one at
    /// infinity is the first.
    pub(super) regions: Lists,
    /// The region of each point.
    pub(super) region_of: Vec<i64>,
}

/// Some ridges.
#[derive(Default)]
pub(super) struct Ridges {
    points: Vec<[i32; 2]>,
    vertices: Part,
}

/// What differs between the plane and space. `vertex_of` has the Voronoi vertex of each simplex.
pub(super) trait Dual<const D: usize> {
    /// Returns the center of the sphere around a finite cell.
    fn center(&self, cell: CellId) -> [f64; D];

    /// Returns the ridges that are found from some simplices; each is found from one.
    fn ridges(&self, simplices: Range<usize>, vertex_of: &[i32]) -> Ridges;

    /// Returns the Voronoi vertices around each vertex.
    fn regions(&self, sites: &[VertexId], vertex_of: &[i32]) -> Lists;
}

impl<G: Dimension<N, D>, const N: usize, const D: usize> Mesh<G, N, D>
where
    Self: Dual<D>,
{
    /// Returns the Voronoi diagram of the points.
    pub(super) fn diagram(&self) -> Diagram<D> {
        let (vertex_of, vertices) = self.voronoi_vertices();
        let count = vertex_of.len();
        let parts: Vec<Ridges> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|k| self.ridges(k * CHUNK..count.min((k + 1) * CHUNK), &vertex_of))
            .collect();
        let mut ridge_points = Vec::new();
        let part = |ridges: Ridges| {
            ridge_points.extend(ridges.points);
            ridges.vertices
        };
        let ridges = parts.into_iter().map(part).collect();
        let first_at = self.first_at_vertices();
        let sites: Vec<VertexId> = first_at.iter().copied().flatten().collect();
        Diagram {
            vertices,
            ridge_points,
            ridges,
            regions: self.regions(&sites, &vertex_of),
            region_of: self.regions_of_points(&first_at),
        }
    }

    /// Returns the Voronoi vertex of each simplex, and the positions of these vertices.
    fn voronoi_vertices(&self) -> (Vec<i32>, Vec<[f64; D]>) {
        let cells = self.cells();
        let mut groups = Groups::new(cells.len());
        for pair in self.pairs_on_one_sphere() {
            groups.join(pair);
        }
        let mut vertex_of = vec![NONE; cells.len()];
        let mut of_vertices = Vec::new();
        for (s, &cell) in (0..).zip(cells) {
            let first = groups.first(s);
            vertex_of[s as usize] = if first == s {
                of_vertices.push(cell);
                of_vertices.len() as i32 - 1
            } else {
                vertex_of[first as usize]
            };
        }
        let centers = of_vertices.par_iter().with_min_len(CHUNK);
        (vertex_of, centers.map(|&cell| self.center(cell)).collect())
    }

    /// Returns pairs of neighboring simplices on one sphere.
    fn pairs_on_one_sphere(&self) -> Vec<[u32; 2]> {
        let tds = self.t.tds();
        let of_chunk = |(k, cells): (usize, &[CellId])| {
            let mut pairs = Vec::new();
            for (s, &cell) in (k * CHUNK..).zip(cells) {
                let corners = tds.corners(cell).map(|v| self.t.point(v));
                for i in 0..N {
                    let beyond = tds.neighbor(cell, i);
                    let t = self.simplex(beyond);
                    if t <= s as i32 {
                        continue;
                    }
                    let apex = tds.vertex(beyond, tds.index_of_neighbor(beyond, cell));
                    let side = self
                        .t
                        .geometry()
                        .side_of_sphere(corners, self.t.point(apex));
                    if side == Sign::Zero {
                        pairs.push([s as u32, t as u32]);
                    }
                }
            }
            pairs
        };
        let chunks = self.cells().par_chunks(CHUNK).enumerate();
        chunks.flat_map_iter(of_chunk).collect()
    }

    /// Returns the region of each point. They are numbered in the order of the first points at
    /// their sites.
    fn regions_of_points(&self, first_at: &[Option<VertexId>]) -> Vec<i64> {
        let mut next = 0..;
        let mut region_of: Vec<i64> = first_at
            .iter()
            .map(|vertex| vertex.and_then(|_| next.next()).unwrap_or_default())
            .collect();
        for (point, first) in self.repeated_points() {
            region_of[point] = region_of[first];
        }
        region_of
    }

    fn point_at(&self, vertex: VertexId) -> i32 {
        self.point_of[vertex.index()]
    }

    /// Returns the Voronoi vertex of a cell; that at infinity if the cell is infinite.
    fn voronoi_vertex(&self, cell: CellId, vertex_of: &[i32]) -> i32 {
        match self.simplex(cell) {
            NONE => NONE,
            simplex => vertex_of[simplex as usize],
        }
    }
}

/// Adds a Voronoi vertex to a list of those around something, unless it is the last there.
fn push(around: &mut Vec<i32>, vertex: i32) {
    if around.last() != Some(&vertex) {
        around.push(vertex);
    }
}

/// Ends a list of the Voronoi vertices around something: the last is not the first again, and that
/// at infinity is the first.
fn close(around: &mut Vec<i32>) {
    if around.len() > 1 && around.first() == around.last() {
        around.pop();
    }
    if let Some(k) = around.iter().position(|&vertex| vertex == NONE) {
        around.rotate_left(k);
    }
}

impl Dual<2> for Mesh<Plane, 3, 2> {
    fn center(&self, cell: CellId) -> [f64; 2] {
        self.t.circumcenter(cell).unwrap_or([f64::NAN; 2])
    }

    fn ridges(&self, simplices: Range<usize>, vertex_of: &[i32]) -> Ridges {
        let tds = self.t.tds();
        let mut ridges = Ridges::default();
        for (s, &cell) in simplices.clone().zip(&self.cells()[simplices]) {
            for i in 0..3 {
                let beyond = tds.neighbor(cell, i);
                let t = self.simplex(beyond);
                let [from, to] = [vertex_of[s], self.voronoi_vertex(beyond, vertex_of)];
                if (t != NONE && t < s as i32) || from == to {
                    continue;
                }
                let ends = tds.edge_ends(cell, i);
                ridges.points.push(ends.map(|v| self.point_at(v)));
                let vertices = if to == NONE { [to, from] } else { [from, to] };
                ridges.vertices.push(&vertices);
            }
        }
        ridges
    }

    fn regions(&self, sites: &[VertexId], vertex_of: &[i32]) -> Lists {
        Lists::of(sites, |&site, around| {
            for cell in self.t.tds().around(site) {
                push(around, self.voronoi_vertex(cell, vertex_of));
            }
            close(around);
        })
    }
}

impl Mesh<Space, 4, 3> {
    /// Returns true if a ridge around an edge has an area, by the vertices around it.
    ///
    /// Two vertices are the ends of a segment, unless one is at infinity: then the ridge is what
    /// two rays from the other enclose, which are perpendicular to the facets of the hull at the
    /// edge.
    fn has_area(&self, edge: (CellId, usize, usize), around: &[i32]) -> bool {
        if around.len() != 2 || !around.contains(&NONE) {
            return around.len() > 2;
        }
        let tds = self.t.tds();
        let infinite = tds
            .cells_around_edge(edge)
            .filter(|&(cell, ..)| self.simplex(cell) == NONE);
        let mut on_hull = infinite.flat_map(|(cell, i, j)| {
            let others = beside(i, j).map(|k| tds.vertex(cell, k));
            others.into_iter().filter(|&v| v != VertexId::INFINITE)
        });
        let (Some(p), Some(q)) = (on_hull.next(), on_hull.next()) else {
            return false;
        };
        let [a, b] = tds.edge_ends(edge);
        let corners = [a, b, p, q].map(|v| self.t.point(v));
        self.t.geometry().orientation(corners) != Sign::Zero
    }
}

impl Dual<3> for Mesh<Space, 4, 3> {
    fn center(&self, cell: CellId) -> [f64; 3] {
        self.t.circumcenter(cell).unwrap_or([f64::NAN; 3])
    }

    fn ridges(&self, simplices: Range<usize>, vertex_of: &[i32]) -> Ridges {
        const EDGES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let tds = self.t.tds();
        let mut ridges = Ridges::default();
        let mut around = Vec::new();
        for (s, &cell) in simplices.clone().zip(&self.cells()[simplices]) {
            for edge in EDGES.map(|(i, j)| (cell, i, j)) {
                // Only from the first simplex at the edge.
                around.clear();
                let is_first = tds.cells_around_edge(edge).all(|(other, ..)| {
                    push(&mut around, self.voronoi_vertex(other, vertex_of));
                    let t = self.simplex(other);
                    t == NONE || t >= s as i32
                });
                if !is_first {
                    continue;
                }
                close(&mut around);
                if !self.has_area(edge, &around) {
                    continue;
                }
                let ends = tds.edge_ends(edge);
                ridges.points.push(ends.map(|v| self.point_at(v)));
                ridges.vertices.push(&around);
            }
        }
        ridges
    }

    fn regions(&self, sites: &[VertexId], vertex_of: &[i32]) -> Lists {
        let tds = self.t.tds();
        // The Voronoi vertices of the simplices at each vertex, sorted by counting: those of `v`
        // are `around[starts[v]..starts[v + 1]]`.
        let mut starts = vec![0usize; tds.vertex_slots() + 1];
        for corner in self.cells().iter().flat_map(|&cell| tds.corners(cell)) {
            starts[corner.index() + 1] += 1;
        }
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut around = vec![NONE; starts.last().copied().unwrap_or_default()];
        let mut is_on_hull = vec![false; tds.vertex_slots()];
        let mut next = starts.clone();
        for (&cell, &vertex) in self.cells().iter().zip(vertex_of) {
            for corner in tds.corners(cell) {
                let slot = &mut next[corner.index()];
                around[*slot] = vertex;
                *slot += 1;
            }
            for i in (0..4).filter(|&i| self.simplex(tds.neighbor(cell, i)) == NONE) {
                for k in (0..4).filter(|&k| k != i) {
                    is_on_hull[tds.vertex(cell, k).index()] = true;
                }
            }
        }
        Lists::of(sites, |site, region| {
            let site = site.index();
            region.extend(is_on_hull[site].then_some(NONE));
            region.extend_from_slice(&around[starts[site]..starts[site + 1]]);
            region.sort_unstable();
            region.dedup();
        })
    }
}

//! Clipping a TIN to polygons.
//!
//! 1. The vertices of the clip line go in where they were given. Their heights are read off the surface, there and at
//!    new ones wherever the line crosses an edge. Where it crosses a breakline or the rim of the surface, the height of
//!    those stands.
//! 2. The rim becomes a constraint, so that it stays where it is; and so does the clip line.
//! 3. The rim, the bounds and each polygon are closed curves of constraints now: one flood over the faces tells in
//!    which of them each lies.

use crate::data::Bounds;
use crate::error::Result;
use crate::geometry::{Crossing, Geometry, height_along};
use crate::kernel::RANGE;
use crate::tds::{VertexId, ccw, cw};

use super::Tin;
use super::builder::{refused, sorted_segments};
use super::domains::{Domains, Region};

/// The numbers of the domains: the old surface, the bounds, and from then on the polygons.
const SURFACE: usize = 0;
const BOUNDS: usize = 1;
const POLYGONS: usize = 2;

/// Polygons and a box; what lies in any of the polygons (in the plane, if there are none) and in the box
/// stays.
pub(super) struct Clip {
    /// Each polygon's rings. By the even-odd rule: it does not matter which is a hole.
    pub(super) polygons: Vec<Vec<Vec<[f64; 2]>>>,
    pub(super) bounds: Option<Bounds>,
}

impl Clip {
    pub(super) fn is_everything(&self) -> bool {
        self.polygons.is_empty() && self.bounds.is_none()
    }

    /// The closed lines to insert, each with the number of the domain that it bounds.
    fn rings(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let polygons = self.polygons.iter().enumerate();
        let mut rings: Vec<(usize, Vec<[f64; 2]>)> =
            polygons.flat_map(|(i, rings)| rings.iter().map(move |ring| (POLYGONS + i, ring.clone()))).collect();
        if let Some(Bounds { min, max }) = self.bounds {
            // What is wider than the arithmetic goes is wider than any data.
            let within = |[x, y]: [f64; 2]| [x, y].map(|c| c.clamp(-RANGE.max, RANGE.max));
            let corners = [[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]];
            rings.push((BOUNDS, corners.map(within).to_vec()));
        }
        for (_, ring) in &mut rings {
            // Zero has one sign only, and what is closer to it than the arithmetic goes is zero.
            let tidy = |c: f64| if c.abs() < RANGE.min && !RANGE.admits(c) { 0.0 } else { c };
            ring.iter_mut().flatten().for_each(|c| *c = tidy(*c));
            ring.extend(ring.first().copied());
        }
        rings
    }

    /// Clips the surface; returns the number of faces left out.
    ///
    /// # Errors
    /// If a vertex of a polygon or a bound cannot be computed with.
    pub(super) fn apply(&self, tin: &mut Tin) -> Result<usize> {
        let rim = rim(tin);
        let lines = self.insert(tin, &rim)?;
        let rim = rim.iter().map(|edge| (SURFACE, edge.as_slice()));
        let curves = rim.chain(lines.iter().map(|(domain, line)| (*domain, line.as_slice())));
        let domains = Domains::new(&tin.triangulation, curves);
        tin.inside = vec![false; tin.triangulation.tds().cell_slots()];
        let mut left_out = 0;
        for Region { within, faces } in domains.regions(&tin.triangulation) {
            let is_within = |domain| within.contains(&domain);
            let in_polygon = self.polygons.is_empty() || within.last().is_some_and(|&last| last >= POLYGONS);
            if !is_within(SURFACE) {
                continue;
            }
            if in_polygon && (self.bounds.is_none() || is_within(BOUNDS)) {
                faces.iter().for_each(|face| tin.inside[face.index()] = true);
            } else {
                left_out += faces.len();
            }
        }
        Ok(left_out)
    }

    /// Inserts the clip lines; returns their vertices, each line with the number of its domain.
    fn insert(&self, tin: &mut Tin, rim: &[[VertexId; 2]]) -> Result<Vec<(usize, Vec<VertexId>)>> {
        let mut line = Vec::new();
        let mut line_ends = Vec::new();
        let rings = self.rings();
        for (_, ring) in &rings {
            for pair in ring.windows(2) {
                line.push(pair[0]);
                line.extend(crossings_between(tin, pair[0], pair[1]));
            }
            line.extend(ring.last());
            line_ends.push(line.len());
        }
        let heights: Vec<Option<f64>> = line.iter().map(|&[x, y]| tin.elevation(x, y)).collect();
        // Without heights at first, so that a crossing takes that of the breakline it crosses.
        let mut vertices = Vec::with_capacity(line.len());
        for &[x, y] in &line {
            let vertex = tin.triangulation.insert_apart([x, y, f64::NAN]);
            vertices.push(vertex.map_err(|_| refused([x, y, 0.0]).at("boundary"))?);
        }
        for &[a, b] in rim.iter().chain(&sorted_segments(&vertices, &line_ends)) {
            tin.triangulation.insert_segment(a, b);
        }
        for (&vertex, height) in vertices.iter().zip(heights) {
            if let Some(z) = height {
                set_height(tin, vertex, z);
            }
        }
        let starts = std::iter::once(&0).chain(&line_ends);
        let runs: Vec<&[VertexId]> = starts.zip(&line_ends).map(|(&start, &end)| &vertices[start..end]).collect();
        // Where the clip line crosses the rim or a breakline that it meets elsewhere too, and where it crosses itself.
        let mut solid: Vec<&[VertexId]> = rim.iter().map(<[VertexId; 2]>::as_slice).collect();
        solid.extend(tin.triangulation.lines().map(|line| tin.triangulation.line_vertices(line)));
        let on_solid = heights_between(tin, &solid);
        on_solid.into_iter().for_each(|(vertex, z)| set_height(tin, vertex, z));
        heights_between(tin, &runs).into_iter().for_each(|(vertex, z)| set_height(tin, vertex, z));
        // Outside of the data any will do.
        let is_bare = |&vertex: &VertexId| tin.triangulation.point(vertex)[2].is_nan();
        for vertex in tin.triangulation.tds().vertices().filter(is_bare).collect::<Vec<_>>() {
            set_height(tin, vertex, 0.0);
        }
        Ok(rings.iter().zip(runs).map(|((domain, _), run)| (*domain, run.to_vec())).collect())
    }
}

/// The heights on lines at the vertices that have none, between those that have one: in between the lines lie in one
/// triangle of the surface, so that all have the same height there but for a rounding. Sorted, the lowest first.
fn heights_between(tin: &Tin, lines: &[&[VertexId]]) -> Vec<(VertexId, f64)> {
    let triangulation = &tin.triangulation;
    let mut heights = Vec::new();
    for pair in lines.iter().flat_map(|line| line.windows(2)).filter(|pair| pair[0] != pair[1]) {
        let mut chain = vec![pair[0]];
        chain.extend(triangulation.way(pair[0], pair[1]));
        chain.push(pair[1]);
        let known: Vec<usize> = (0..chain.len()).filter(|&i| !triangulation.point(chain[i])[2].is_nan()).collect();
        for ends in known.windows(2) {
            let [p, q] = [ends[0], ends[1]].map(|i| *triangulation.point(chain[i]));
            heights.extend(chain[ends[0] + 1..ends[1]].iter().map(|&vertex| {
                let [x, y, _] = *triangulation.point(vertex);
                (vertex, height_along(p, q, [x, y]))
            }));
        }
    }
    heights.sort_by(|(u, low), (v, high)| u.cmp(v).then(low.total_cmp(high)));
    heights
}

/// The places between two others where the way crosses an edge within the surface that is no constraint, in
/// their order.
fn crossings_between(tin: &Tin, [ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> Vec<[f64; 2]> {
    let triangulation = &tin.triangulation;
    let (a, b) = ([ax, ay, f64::NAN], [bx, by, f64::NAN]);
    if !(triangulation.geometry().admits(&a) && triangulation.geometry().admits(&b)) {
        return Vec::new();
    }
    let is_open = |&[c, d]: &[VertexId; 2]| {
        triangulation.tds().edge(c, d).is_some_and(|(cell, i)| {
            let beside = triangulation.tds().neighbor(cell, i);
            !triangulation.is_constrained(cell, i) && tin.inside[cell.index()] && tin.inside[beside.index()]
        })
    };
    let crossed = triangulation.edges_crossed(&a, &b).into_iter().filter(is_open);
    let mut places: Vec<[f64; 2]> = crossed
        .map(|[c, d]| triangulation.geometry().crossing([&a, &b], [triangulation.point(c), triangulation.point(d)]))
        .map(|p| [p[0], p[1]])
        .collect();
    let along = |p: &[f64; 2]| (p[0] - ax) * (bx - ax) + (p[1] - ay) * (by - ay);
    places.sort_unstable_by(|p, q| along(p).total_cmp(&along(q)));
    places
}

fn set_height(tin: &mut Tin, vertex: VertexId, z: f64) {
    let [x, y, known] = *tin.triangulation.point(vertex);
    if known.is_nan() {
        tin.triangulation.replace_point(vertex, [x, y, z]);
    }
}

/// The edges between the surface and what is not part of it, in an order of their own.
fn rim(tin: &Tin) -> Vec<[VertexId; 2]> {
    let tds = tin.triangulation.tds();
    let mut rim = Vec::new();
    for cell in tin.triangulation.finite_cells().filter(|cell| tin.inside[cell.index()]) {
        for i in (0..3).filter(|&i| !tin.inside[tds.neighbor(cell, i).index()]) {
            let (a, b) = (tds.vertex(cell, ccw(i)), tds.vertex(cell, cw(i)));
            rim.push([a.min(b), a.max(b)]);
        }
    }
    rim.sort_unstable();
    rim
}

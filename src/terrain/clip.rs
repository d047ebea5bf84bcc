//! Clipping a TIN to polygons.
//!
//! 1. The rim of the surface becomes a constraint, so that it stays where it is.
//! 2. The clip line goes in as constraints, its vertices where they were given. Its heights are read off
//!    the surface: at its vertices, and at new ones wherever it crosses an edge. Where it crosses a
//!    breakline or the rim, the height of those stands.
//! 3. The faces fall into regions that no constraint divides; of each, one point tells whether it lies
//!    within the old rim, the bounds, and any of the polygons.

use geo::{Contains, Coord, LineString, Polygon};

use crate::data::Bounds;
use crate::geometry::{Crossing, Geometry};
use crate::tds::{CellId, VertexId, ccw, cw};

use super::Tin;
use super::builder::sorted_segments;

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

    /// The closed lines to insert.
    fn rings(&self) -> Vec<Vec<[f64; 2]>> {
        let mut rings: Vec<Vec<[f64; 2]>> = self.polygons.iter().flatten().cloned().collect();
        rings.extend(
            self.bounds.map(|Bounds { min, max }| {
                vec![[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]]
            }),
        );
        for ring in &mut rings {
            ring.iter_mut().flatten().for_each(|x| *x += 0.0); // zero has one sign only
            ring.extend(ring.first().copied());
        }
        rings
    }

    /// Clips the surface; returns the number of faces left out.
    pub(super) fn apply(&self, tin: &mut Tin) -> usize {
        let rim = rim(tin);
        let rim_places = rim.iter().map(|edge| edge.map(|v| plan(tin, v))).collect::<Vec<_>>();
        for &[a, b] in &rim {
            tin.triangulation.insert_segment(a, b);
        }
        self.insert(tin);
        tin.include_all();
        let before = tin.count().1;
        let polygons: Vec<Vec<Polygon>> =
            self.polygons.iter().map(|rings| rings.iter().map(|ring| polygon(ring)).collect()).collect();
        let in_data = |p| is_within(&rim_places, p);
        let stays = |p: [f64; 2]| {
            let at = Coord { x: p[0], y: p[1] };
            let in_polygon = |rings: &Vec<Polygon>| rings.iter().filter(|ring| ring.contains(&at)).count() % 2 == 1;
            self.bounds.is_none_or(|bounds| bounds.holds(p[0], p[1]))
                && (polygons.is_empty() || polygons.iter().any(in_polygon))
        };
        let mut outside_data = 0;
        for (faces, p) in regions(tin) {
            let data = in_data(p);
            if !data {
                outside_data += faces.len();
            }
            if !data || !stays(p) {
                faces.iter().for_each(|face| tin.inside[face.index()] = false);
            }
        }
        before - outside_data - tin.count().1
    }

    /// Inserts the clip line.
    fn insert(&self, tin: &mut Tin) {
        let mut line = Vec::new();
        let mut line_ends = Vec::new();
        for ring in self.rings() {
            for pair in ring.windows(2) {
                line.push(pair[0]);
                line.extend(crossings_between(tin, pair[0], pair[1]));
            }
            line.extend(ring.last());
            line_ends.push(line.len());
        }
        let heights: Vec<Option<f64>> = line.iter().map(|&[x, y]| tin.elevation(x, y)).collect();
        // Without heights at first, so that a crossing takes that of the breakline it crosses. Places that
        // the arithmetic does not admit are far outside of any data.
        let vertices: Vec<VertexId> = line
            .iter()
            .map(|&[x, y]| tin.triangulation.insert([x, y, f64::NAN]).unwrap_or(VertexId::INFINITE))
            .collect();
        for [a, b] in sorted_segments(&vertices, &line_ends) {
            if b != VertexId::INFINITE {
                tin.triangulation.insert_segment(a, b);
            }
        }
        for (&vertex, height) in vertices.iter().zip(heights) {
            if let (Some(z), true) = (height, vertex != VertexId::INFINITE) {
                set_height(tin, vertex, z);
            }
        }
        // Where the clip line crosses itself: between its neighbors.
        let is_bare = |&vertex: &VertexId| tin.triangulation.point(vertex)[2].is_nan();
        for vertex in tin.triangulation.tds().vertices().filter(is_bare).collect::<Vec<_>>() {
            let z = mean_around(tin, vertex);
            set_height(tin, vertex, z);
        }
    }
}

/// The places between two others where the way crosses an edge of the surface that is no constraint, in
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
            !triangulation.is_constrained(cell, i) && (tin.inside[cell.index()] || tin.inside[beside.index()])
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

fn polygon(ring: &[[f64; 2]]) -> Polygon {
    Polygon::new(LineString::from_iter(ring.iter().map(|&[x, y]| Coord { x, y })), Vec::new())
}

fn plan(tin: &Tin, vertex: VertexId) -> [f64; 2] {
    let p = tin.triangulation.point(vertex);
    [p[0], p[1]]
}

fn set_height(tin: &mut Tin, vertex: VertexId, z: f64) {
    let [x, y, known] = *tin.triangulation.point(vertex);
    if known.is_nan() {
        tin.triangulation.replace_point(vertex, [x, y, z]);
    }
}

/// The mean height of the neighbors that have one; 0 if none has, which are outside of the data.
fn mean_around(tin: &Tin, vertex: VertexId) -> f64 {
    let tds = tin.triangulation.tds();
    let corners = tds.around(vertex).flat_map(|cell| *tds.corners(cell)).filter(|&v| v != VertexId::INFINITE);
    let heights: Vec<f64> = corners.map(|v| tin.triangulation.point(v)[2]).filter(|z| z.is_finite()).collect();
    heights.iter().sum::<f64>() / heights.len().max(1) as f64
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

/// Whether a ray to the left crosses the edges an odd number of times.
fn is_within(edges: &[[[f64; 2]; 2]], [x, y]: [f64; 2]) -> bool {
    let crosses =
        |&&[a, b]: &&[[f64; 2]; 2]| (a[1] <= y) != (b[1] <= y) && a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) < x;
    edges.iter().filter(crosses).count() % 2 == 1
}

/// The sets of faces that no constraint divides, each with a place within.
fn regions(tin: &Tin) -> Vec<(Vec<CellId>, [f64; 2])> {
    let tds = tin.triangulation.tds();
    let mut seen = vec![false; tin.inside.len()];
    let mut regions = Vec::new();
    for start in tin.triangulation.finite_cells() {
        if std::mem::replace(&mut seen[start.index()], true) {
            continue;
        }
        let mut faces = vec![start];
        let mut next = 0;
        // In the middle of the largest face one is furthest from any rounding.
        let mut largest = (f64::NEG_INFINITY, [0.0; 2]);
        while next < faces.len() {
            let cell = faces[next];
            next += 1;
            let [a, b, c] = tds.corners(cell).map(|v| plan(tin, v));
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if area > largest.0 {
                largest = (area, [0, 1].map(|k| a[k] + ((b[k] - a[k]) + (c[k] - a[k])) / 3.0));
            }
            for i in (0..3).filter(|&i| !tin.triangulation.is_constrained(cell, i)) {
                let beside = tds.neighbor(cell, i);
                if !tds.is_infinite(beside) && !std::mem::replace(&mut seen[beside.index()], true) {
                    faces.push(beside);
                }
            }
        }
        regions.push((faces, largest.1));
    }
    regions
}

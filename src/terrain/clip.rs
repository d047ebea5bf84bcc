//! Clipping a TIN to polygons.
//!
//! 1. The polygons are united, and intersected with the bounds and the convex hull: every vertex of the
//!    clip line has a height then.
//! 2. The heights are read off the surface, and the line goes in as constraints. Where it crosses a
//!    breakline, the breakline's height stands.
//! 3. The faces fall into regions that no constraint divides; of each, one point tells whether it stays.

use geo::{BooleanOps, Contains, Coord, LineString, MultiPolygon, Polygon, unary_union};

use crate::data::Bounds;
use crate::tds::{CellId, VertexId};

use super::Tin;
use super::builder::sorted_segments;

fn polygon(ring: impl IntoIterator<Item = [f64; 2]>) -> Polygon {
    Polygon::new(LineString::from_iter(ring.into_iter().map(|[x, y]| Coord { x, y })), Vec::new())
}

/// What is to stay: within the hull, within the bounds, within any of the polygons.
fn region(tin: &Tin, boundaries: &[Vec<Vec<[f64; 2]>>], bounds: Option<Bounds>) -> MultiPolygon {
    let triangulation = tin.triangulation();
    let hull: Vec<[f64; 2]> = hull(tin).into_iter().map(|v| *triangulation.point(v)).map(|p| [p[0], p[1]]).collect();
    let mut region = MultiPolygon::from(polygon(hull));
    if let Some(Bounds { min, max }) = bounds {
        let corners = [[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]];
        region = region.intersection(&MultiPolygon::from(polygon(corners)));
    }
    if !boundaries.is_empty() {
        // By the even-odd rule, whichever way round and in whatever order the rings come.
        let even_odd = |rings: &Vec<Vec<[f64; 2]>>| {
            rings.iter().fold(MultiPolygon::new(Vec::new()), |sum, ring| {
                sum.xor(&MultiPolygon::from(polygon(ring.iter().copied())))
            })
        };
        let polygons: Vec<MultiPolygon> = boundaries.iter().map(even_odd).collect();
        region = region.intersection(&unary_union(&polygons));
    }
    region
}

/// The vertices of the convex hull, counter-clockwise.
fn hull(tin: &Tin) -> Vec<VertexId> {
    let tds = tin.triangulation().tds();
    let around = tds.around(VertexId::INFINITE);
    let mut hull: Vec<VertexId> = around
        .filter_map(|cell| {
            let infinite = tds.index_of(cell, VertexId::INFINITE)?;
            Some(tds.vertex(cell, crate::tds::ccw(infinite)))
        })
        .collect();
    hull.reverse(); // seen from infinity it runs the other way
    hull
}

/// Leaves only what is inside; returns the number of faces left out.
pub(super) fn clip(tin: &mut Tin, boundaries: &[Vec<Vec<[f64; 2]>>], bounds: Option<Bounds>) -> usize {
    let region = region(tin, boundaries, bounds);
    let rings = region.iter().flat_map(|p| std::iter::once(p.exterior()).chain(p.interiors()));
    let mut line: Vec<[f64; 3]> = Vec::new();
    let mut line_ends = Vec::new();
    for ring in rings {
        line.extend(ring.coords().map(|c| [c.x + 0.0, c.y + 0.0, f64::NAN]));
        line_ends.push(line.len());
    }
    let heights: Vec<f64> = line.iter().map(|p| height_near(tin, [p[0], p[1]])).collect();

    let before = tin.triangulation.vertex_count();
    // Without heights for now, so that a crossing takes that of the breakline it crosses.
    let Ok(vertices) = line.iter().map(|&p| tin.triangulation.insert(p)).collect::<Result<Vec<_>, _>>() else {
        return 0; // the region lies within the hull, whose coordinates were admitted
    };
    for [a, b] in sorted_segments(&vertices, &line_ends) {
        tin.triangulation.insert_segment(a, b);
    }
    for (&vertex, &z) in vertices.iter().zip(&heights) {
        set_height(tin, vertex, z);
    }
    // Where roundings made the clip line cross itself: the mean of what is around.
    for vertex in (before..tin.triangulation.vertex_count()).map(VertexId::new) {
        if tin.triangulation.point(vertex)[2].is_nan() {
            let tds = tin.triangulation.tds();
            let corners = tds.around(vertex).flat_map(|cell| *tds.corners(cell));
            let around = corners.filter(|&v| v != VertexId::INFINITE).map(|v| tin.triangulation.point(v)[2]);
            let known: Vec<f64> = around.filter(|z| z.is_finite()).collect();
            let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
            set_height(tin, vertex, mean);
        }
    }
    tin.include_all();
    let faces = tin.inside.iter().filter(|&&inside| inside).count();
    exclude_outside(tin, &region);
    faces - tin.inside.iter().filter(|&&inside| inside).count()
}

fn set_height(tin: &mut Tin, vertex: VertexId, z: f64) {
    let [x, y, known] = *tin.triangulation.point(vertex);
    if known.is_nan() {
        tin.triangulation.replace_point(vertex, [x, y, z]);
    }
}

/// The height of the surface at a place; beside the surface by a rounding, that of the edge next to it.
fn height_near(tin: &Tin, [x, y]: [f64; 2]) -> f64 {
    if let Some(z) = tin.elevation(x, y) {
        return z;
    }
    let hull = hull(tin);
    let ends = |i: usize| [hull[i], hull[(i + 1) % hull.len()]].map(|v| *tin.triangulation.point(v));
    let foot = |i: usize| {
        let [a, b] = ends(i);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let t = (((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        ((a[0] + t * dx - x).hypot(a[1] + t * dy - y), a[2] + t * (b[2] - a[2]))
    };
    let nearest = (0..hull.len()).map(foot).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or(f64::NAN, |(_, z)| z)
}

/// Takes out the regions of faces that lie outside.
fn exclude_outside(tin: &mut Tin, region: &MultiPolygon) {
    let tds = tin.triangulation.tds();
    let mut seen = vec![false; tin.inside.len()];
    let mut faces = Vec::new();
    for start in 0..tin.inside.len() {
        if seen[start] || !tin.inside[start] {
            continue;
        }
        faces.clear();
        faces.push(start);
        seen[start] = true;
        let mut next = 0;
        // Of the largest face the middle is furthest from any rounding.
        let mut largest = (f64::NEG_INFINITY, [0.0; 2]);
        while next < faces.len() {
            let cell = CellId::new(faces[next]);
            next += 1;
            let [a, b, c] = tds.corners(cell).map(|v| *tin.triangulation.point(v));
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if area > largest.0 {
                largest = (area, [0, 1].map(|k| a[k] + ((b[k] - a[k]) + (c[k] - a[k])) / 3.0));
            }
            for i in 0..3 {
                let beside = tds.neighbor(cell, i).index();
                if !tin.triangulation.is_constrained(cell, i) && tin.inside[beside] && !seen[beside] {
                    seen[beside] = true;
                    faces.push(beside);
                }
            }
        }
        let [x, y] = largest.1;
        if !region.contains(&Coord { x, y }) {
            faces.iter().for_each(|&face| tin.inside[face] = false);
        }
    }
}

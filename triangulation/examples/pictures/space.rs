//! Pictures of space: seen from afar, what is nearer over what is further away.

use std::fmt::Write;

use breakline_triangulation::geometry::Space;
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{ConvexHull, Delaunay};

type Site = [f64; 3];

/// The side of a drawing, in the unit of the picture.
const SIZE: f64 = 1000.0;

const STYLE: &str = "\
    .space{background:#fff}.space line{stroke:#999;stroke-width:1.5}.space .star{stroke:#36c;stroke-width:2.5}\
    .space polygon{stroke:#555;stroke-width:1;stroke-linejoin:round}\
    .space .border{fill:#fc6;fill-opacity:.35;stroke:#c33;stroke-width:2.5}.space .dot{fill:#36c}";

/// Returns coordinates to the right, upward, and towards the viewer, who looks slightly down.
/// The turns have rational sines and cosines, so that all machines draw the same.
fn seen([x, y, z]: Site) -> Site {
    let (right, back) = (0.8 * x + 0.6 * y, 0.8 * y - 0.6 * x);
    [right, 0.8 * z + 0.6 * back, 0.6 * z - 0.8 * back]
}

fn cross(p: Site, q: Site) -> Site {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i])
}

/// Shapes with their distance from the viewer, negative.
#[derive(Default)]
struct Scene(Vec<(f64, String)>);

impl Scene {
    fn pixel([right, up, _]: Site) -> [f64; 2] {
        [SIZE * (0.5 + right / 150.0), SIZE * (0.5 - up / 150.0)]
    }

    fn triangle(&mut self, corners: [Site; 3], style: &str) {
        let corners = corners.map(seen);
        let points: Vec<String> = corners
            .map(Self::pixel)
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .to_vec();
        let depth = corners.iter().map(|p| p[2]).sum::<f64>() / 3.0;
        self.0.push((
            depth,
            format!(r#"<polygon {style} points="{}"/>"#, points.join(" ")),
        ));
    }

    fn line(&mut self, ends: [Site; 2], class: &str) {
        let [p, q] = ends.map(seen);
        let [[x1, y1], [x2, y2]] = [p, q].map(Self::pixel);
        let line = format!(
            r#"<line class="{class}" x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}"/>"#
        );
        self.0.push(((p[2] + q[2]) / 2.0, line));
    }

    fn dot(&mut self, at: Site, radius: f64, class: &str) {
        let at = seen(at);
        let [x, y] = Self::pixel(at);
        self.0.push((
            at[2],
            format!(r#"<circle class="{class}" cx="{x:.1}" cy="{y:.1}" r="{radius}"/>"#),
        ));
    }

    fn svg(mut self) -> Result<String, std::fmt::Error> {
        self.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut svg = String::new();
        writeln!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" class="space" viewBox="0 0 {SIZE} {SIZE}">"#
        )?;
        writeln!(svg, "<style>{STYLE}</style>")?;
        self.0
            .iter()
            .try_for_each(|(_, shape)| writeln!(svg, "{shape}"))?;
        writeln!(svg, "</svg>")?;
        Ok(svg)
    }
}

/// Returns points spread evenly over a cube of side 100 around the origin, in an order of the R3
/// sequence (Roberts 2018).
fn spread(count: u32) -> impl Iterator<Item = Site> {
    let at = |k: u32, step: f64| ((f64::from(k) * step).fract() * 1000.0).round() / 10.0 - 50.0;
    (1..=count).map(move |k| {
        [
            at(k, 0.819_172_513),
            at(k, 0.671_043_607),
            at(k, 0.549_700_478),
        ]
    })
}

/// Draws the border of the cells that a new point would destroy, and the edges of its star.
pub(crate) fn conflict_zone() -> Result<String, Box<dyn std::error::Error>> {
    let points: Vec<Site> = spread(60).collect();
    let (t, _) = Delaunay::from_points(Space::new(), &points)?;
    let q = [4.0, -6.0, 8.0];
    let zone = t
        .conflict_zone(&q, None)
        .expect("it is inside of the hull, and no vertex");
    let corners = |(cell, i): (CellId, usize)| -> Vec<VertexId> {
        t.tds()
            .corners(cell)
            .iter()
            .enumerate()
            .filter(|&(k, _)| k != i)
            .map(|(_, &v)| v)
            .collect()
    };
    let mut scene = Scene::default();
    let mut star: Vec<VertexId> = Vec::new();
    for &facet in &zone.border {
        let vertices = corners(facet);
        scene.triangle(
            [0, 1, 2].map(|k| *t.point(vertices[k])),
            r#"class="border""#,
        );
        star.extend(vertices);
    }
    star.sort_unstable();
    star.dedup();
    star.iter()
        .for_each(|&v| scene.line([q, *t.point(v)], "star"));
    scene.dot(q, 9.0, "dot");
    t.points().iter().for_each(|&p| scene.dot(p, 4.0, ""));
    // The hull, for orientation.
    if let ConvexHull::Polyhedron { triangles, .. } = t.convex_hull() {
        for [a, b, c] in triangles {
            for [start, end] in [[a, b], [b, c], [c, a]]
                .into_iter()
                .filter(|[start, end]| start < end)
            {
                scene.line([*t.point(start), *t.point(end)], "");
            }
        }
    }
    Ok(scene.svg()?)
}

/// Draws the alpha shape of points in a ring: the smallest that is one solid with all of them.
pub(crate) fn alpha_shape() -> Result<String, Box<dyn std::error::Error>> {
    let is_in_ring = |&[x, y, z]: &Site| {
        let from_middle = (x * x + y * y).sqrt() - 44.0;
        from_middle * from_middle + 2.0 * z * z < 19.0 * 19.0
    };
    let points: Vec<Site> = spread(2400)
        .map(|[x, y, z]| [1.3 * x, 1.3 * y, 0.3 * z])
        .filter(is_in_ring)
        .collect();
    let (t, _) = Delaunay::from_points(Space::new(), &points)?;
    let shapes = t.alpha_shapes();
    let shape = shapes
        .with_components(1)
        .expect("the points are not coplanar");
    let mut scene = Scene::default();
    for triangle in shape.boundary().triangles {
        let corners = triangle.map(|v| *t.point(v));
        let [a, b, c] = corners.map(seen);
        let normal = cross(
            [0, 1, 2].map(|k| b[k] - a[k]),
            [0, 1, 2].map(|k| c[k] - a[k]),
        );
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        // From behind the viewer's left shoulder.
        let light = (normal[2] * 0.64 + normal[1] * 0.6 - normal[0] * 0.48) / length;
        if normal[2] > 0.0 {
            let [red, green, blue] =
                [255.0, 214.0, 130.0].map(|x| (x * (0.35 + 0.65 * light.max(0.0))).round());
            scene.triangle(corners, &format!(r#"fill="rgb({red},{green},{blue})""#));
        }
    }
    Ok(scene.svg()?)
}

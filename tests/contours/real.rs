//! Contours of real deliveries, with unchanged coordinates and heights.

use breakline::data::{ContourLine, PointBatch, Shape, Surface};
use breakline::terrain::{Levels, Tin, TinBuilder, contours};
use breakline::triangulation::kernel::{Adaptive, Kernel, Orientation2};
use breakline::triangulation::num::Sign;
use std::collections::{HashMap, HashSet};
use testkit::shared;

type Segment = [[f64; 2]; 2];

pub(crate) fn tin(points: &[&str], breaklines: Option<&str>) -> Tin {
    let mut builder = TinBuilder::default();
    for path in points {
        let mut source = breakline::io::points::open(shared(path)).unwrap();
        let mut batch = PointBatch::default();
        while source.read(&mut batch).map(|()| !batch.is_empty()).unwrap() {
            let is_used = |i: &usize| batch.class.is_empty() || batch.class[*i] == 2;
            let used: Vec<usize> = (0..batch.len()).filter(is_used).collect();
            let [x, y, z] = [&batch.x, &batch.y, &batch.z]
                .map(|c| used.iter().map(|&i| c[i]).collect::<Vec<_>>());
            builder.add_points(&x, &y, &z);
        }
    }
    if let Some(path) = breaklines {
        let layer = breakline::io::layer::read(shared(path).to_str().unwrap()).unwrap();
        for shape in layer.shapes {
            if let Shape::Lines(parts) | Shape::Polygon(parts) = shape {
                parts.iter().for_each(|part| builder.add_breakline(part));
            }
        }
    }
    builder.build().unwrap()
}

fn check(tin: &Tin, interval: f64) {
    let lines: Vec<ContourLine> = contours(tin, &Levels::every(interval, 0.0).unwrap())
        .unwrap()
        .collect();
    assert!(lines.len() > 20);
    let border = border(tin);
    for line in lines.iter().filter(|line| !line.is_closed()) {
        for end in [line.points[0], line.points[line.points.len() - 1]] {
            let off = border
                .iter()
                .map(|&edge| distance(end, edge))
                .fold(f64::INFINITY, f64::min);
            // A step of an f64 at such coordinates.
            assert!(
                off < 1e-9,
                "a line ends at {end:?}, {off} from the edge of the data"
            );
        }
    }
    let segments: Vec<Segment> = lines
        .iter()
        .flat_map(|line| line.points.windows(2))
        .map(|p| [p[0], p[1]])
        .collect();
    let mut seen = HashSet::new();
    for [a, b] in &segments {
        assert_ne!(a, b, "an arc of no length");
        let [a, b] = [a, b].map(|p| p.map(f64::to_bits));
        assert!(seen.insert([a.min(b), a.max(b)]), "an arc occurs twice");
    }
    assert_eq!(crossing(&segments), None);
}

fn border(surface: &impl Surface) -> Vec<Segment> {
    let site = |v: u32| [surface.position(v)[0], surface.position(v)[1]];
    let faces = (0..surface.face_count() as u32).filter_map(|f| Some((f, surface.face(f)?)));
    let sides = faces.flat_map(|(f, corners)| (0..3).map(move |i| (f, corners, i)));
    sides
        .filter(|&(f, _, i)| surface.neighbor(f, i).is_none())
        .map(|(_, corners, i)| [site(corners[(i + 1) % 3]), site(corners[(i + 2) % 3])])
        .collect()
}

fn distance(p: [f64; 2], [a, b]: Segment) -> f64 {
    let (ux, uy) = (b[0] - a[0], b[1] - a[1]);
    let t = (((p[0] - a[0]) * ux + (p[1] - a[1]) * uy) / (ux * ux + uy * uy)).clamp(0.0, 1.0);
    (p[0] - a[0] - t * ux).hypot(p[1] - a[1] - t * uy)
}

/// Two segments, of any levels, each with the ends of the other on both of its sides.
fn crossing(segments: &[Segment]) -> Option<[Segment; 2]> {
    let mean = segments
        .iter()
        .map(|[a, b]| (a[0] - b[0]).hypot(a[1] - b[1]))
        .sum::<f64>()
        / segments.len() as f64;
    let cell = |c: f64| (c / (4.0 * mean)).floor() as i64;
    let mut cells = HashMap::<[i64; 2], Vec<Segment>>::new();
    for &[a, b] in segments {
        let range = |k: usize| cell(a[k].min(b[k]))..=cell(a[k].max(b[k]));
        for x in range(0) {
            for y in range(1) {
                cells.entry([x, y]).or_default().push([a, b]);
            }
        }
    }
    let parts = |[a, b]: Segment, [c, d]: Segment| {
        let sign = |p| Adaptive::sign(&Orientation2([a, b, p]));
        matches!(
            (sign(c), sign(d)),
            (Sign::Negative, Sign::Positive) | (Sign::Positive, Sign::Negative)
        )
    };
    cells.values().find_map(|near| {
        let pairs = near
            .iter()
            .enumerate()
            .flat_map(|(i, s)| near[..i].iter().map(move |t| [*s, *t]));
        pairs.into_iter().find(|&[s, t]| parts(s, t) && parts(t, s))
    })
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn mass_points_and_breaklines() {
    let tin = tin(
        &["shp/shapelib_eg/masspntz.shp"],
        Some("shp/shapelib_eg/brklinz.shp"),
    );
    check(&tin, 1.0);
    check(&tin, 5.0);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_lake_with_its_shore() {
    let tin = tin(
        &["lidar/lake_breakline/lake.laz"],
        Some("lidar/lake_breakline/lake_breakline.shp"),
    );
    check(&tin, 0.5);
}

/// Heights in whole centimeters, all of them on levels.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn levels_through_all_vertices() {
    let tin = tin(&["lidar/bcts/bcts_1.laz"], None);
    check(&tin, 1.0);
    check(&tin, 0.01);
}

//! TINs of real deliveries: the counts are those that ../shared/data states, and every breakline is
//! present.

use breakline::data::{PointBatch, Shape};
use breakline::terrain::{Tin, TinBuilder};
use breakline::triangulation::Level;
use breakline::triangulation::tds::VertexId;

/// All points, or those of class 2, without reduction.
fn add_points(builder: &mut TinBuilder, path: &str, ground_only: bool) {
    let mut source = breakline::io::points::open(testkit::shared(path)).unwrap();
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch).unwrap();
        if batch.is_empty() {
            return;
        }
        let kept: Vec<usize> = (0..batch.len())
            .filter(|&i| !ground_only || batch.class[i] == 2)
            .collect();
        let column = |c: &[f64]| kept.iter().map(|&i| c[i]).collect::<Vec<_>>();
        builder.add_points(&column(&batch.x), &column(&batch.y), &column(&batch.z));
    }
}

fn lines(path: &str) -> Vec<Vec<[f64; 3]>> {
    let layer = breakline::io::layer::read(testkit::shared(path).to_str().unwrap()).unwrap();
    let parts = layer.shapes.into_iter().flat_map(|shape| match shape {
        Shape::Lines(parts) | Shape::Polygon(parts) => parts,
        _ => Vec::new(),
    });
    parts.collect()
}

/// Every segment of every line is a constrained edge, or a chain of them.
fn missing(tin: &Tin, lines: &[Vec<[f64; 3]>]) -> usize {
    let t = tin.triangulation();
    let vertex = |p: &[f64; 3]| match t.locate(p, None) {
        breakline::triangulation::Location::Vertex(v) => v,
        other => panic!("{p:?} is no vertex: {other:?}"),
    };
    let constrained = |a: VertexId, b: VertexId| {
        t.tds()
            .edge(a, b)
            .is_some_and(|(cell, i)| t.is_constrained(cell, i))
    };
    let segments = lines
        .iter()
        .flat_map(|line| line.windows(2))
        .map(|pair| [vertex(&pair[0]), vertex(&pair[1])]);
    segments
        .filter(|[a, b]| a != b && !constrained(*a, *b))
        .count()
}

fn check(points: &[&str], ground_only: bool, breaklines: Option<&str>, expected: [usize; 3]) {
    let mut builder = TinBuilder::default();
    points
        .iter()
        .for_each(|path| add_points(&mut builder, path, ground_only));
    let lines = breaklines.map(lines).unwrap_or_default();
    lines.iter().for_each(|line| builder.add_breakline(line));
    let tin = builder.build().unwrap();
    let report = tin.report();
    assert_eq!(
        [report.vertices, report.triangles, report.edges.total()],
        expected
    );
    assert_eq!(missing(&tin, &lines), 0);
    assert_eq!(tin.check(Level::Law), []);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn shapelib_mass_points_and_breaklines() {
    check(
        &["shp/shapelib_eg/masspntz.shp"],
        false,
        Some("shp/shapelib_eg/brklinz.shp"),
        [2547, 5077, 1614],
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn lake() {
    check(
        &["lidar/lake_breakline/lake.laz"],
        true,
        Some("lidar/lake_breakline/lake_breakline.shp"),
        [28_180, 56_326, 253],
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn delft() {
    let tiles = [
        "lidar/delft_ahn3_bgt/ahn3_cropped_1.laz",
        "lidar/delft_ahn3_bgt/ahn3_cropped_2.laz",
    ];
    check(
        &tiles,
        true,
        Some("lidar/delft_ahn3_bgt/breaklines_z_derived.shp"),
        [288_616, 577_182, 5775],
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn bcts() {
    let tiles = [1, 2, 3, 4].map(|i| format!("lidar/bcts/bcts_{i}.laz"));
    check(
        &tiles.each_ref().map(String::as_str),
        true,
        None,
        [150_341, 300_655, 0],
    );
}

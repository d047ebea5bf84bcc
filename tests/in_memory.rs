//! What bindings take from the library: results in memory are those that are written to files.

use std::path::{Path, PathBuf};

use breakline::data::{BlockSource, Mesh};
use breakline::io::geotiff::CellFormat;
use breakline::io::mesh;
use breakline::run::{
    self, CellProduct, Context, ContourOptions, DemOptions, Model, PointsRequest, Source,
    SurfaceProduct, SurfaceRequest, TinRequest,
};
use breakline::terrain::Classes;

/// The valley with breaklines, clipped to its boundary.
fn valley() -> SurfaceProduct {
    let tin = TinRequest {
        points: vec!["fixtures/valley.laz".into()],
        breaklines: vec!["fixtures/breaklines.shp".into()],
        boundary: vec!["fixtures/boundary.shp".into()],
        classes: Classes::Only(vec![2]),
        ..TinRequest::default()
    };
    let request = SurfaceRequest {
        source: Source::Points(Box::new(tin)),
        ..SurfaceRequest::default()
    };
    run::triangles(&request, &Context::default()).unwrap()
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

#[test]
fn points_that_are_read_are_those_that_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let (part, plain) = (
        folder.path().join("part.laz"),
        folder.path().join("plain.xyz"),
    );
    let request = PointsRequest {
        files: vec!["fixtures/valley.laz".into()],
        classes: vec![2],
        ..PointsRequest::default()
    };
    let context = Context::default();
    let read = run::read_points(&request, &context).unwrap();
    let written = run::write_points(&request, part.as_path().into(), &context).unwrap();
    assert_eq!(
        (read.report.read, read.report.other_class),
        (written.read, written.other_class)
    );
    assert_eq!(read.report.written, written.written);
    let again = run::read_points(
        &PointsRequest {
            files: vec![part.clone()],
            ..PointsRequest::default()
        },
        &context,
    )
    .unwrap();
    assert_eq!(
        (&again.points.x, &again.points.z),
        (&read.points.x, &read.points.z)
    );
    assert_eq!(
        (&again.points.class, &again.points.flags),
        (&read.points.class, &read.points.flags)
    );

    // Points of a file without classes have class 0, before and after others.
    std::fs::write(&plain, "1 2 3\n4 5 6\n").unwrap();
    let files: Vec<PathBuf> = vec![plain.clone(), part, plain];
    let mixed = run::read_points(
        &PointsRequest {
            files,
            ..PointsRequest::default()
        },
        &context,
    )
    .unwrap()
    .points;
    let count = mixed.len();
    assert_eq!(
        (count, mixed.class.len(), mixed.flags.len()),
        (again.points.len() + 4, count, count)
    );
    assert_eq!(
        (&mixed.class[..3], &mixed.class[count - 3..]),
        (&[0, 0, 2][..], &[2, 0, 0][..])
    );
}

#[test]
fn a_list_of_a_surface_is_the_surface() {
    let product = valley();
    let surface = product.triangles().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let [of_surface, of_list] = ["a.ply", "b.ply"].map(|name| folder.path().join(name));
    mesh::write(of_surface.as_path(), surface).unwrap();
    let listed = mesh::list(surface).unwrap();
    let edges = mesh::edges(surface).unwrap();
    assert!(
        edges
            .iter()
            .filter(|(_, kind)| kind.is_constrained())
            .eq(&listed.lines)
    );
    // By Euler's formula, for a surface in one part without holes.
    assert_eq!(listed.vertices.len() + listed.faces.len(), edges.len() + 1);
    mesh::write(of_list.as_path(), &Mesh::of(listed).unwrap()).unwrap();
    assert!(bytes(&of_surface) == bytes(&of_list));
    assert_eq!(
        run::surface_flaws(&product, &Context::default()).unwrap(),
        []
    );
}

#[test]
fn cells_and_contours_in_memory_are_written_as_if_computed() {
    let product = valley();
    let context = Context::default();
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);

    let cells = run::dem(&product, &DemOptions::default(), &context).unwrap();
    cells
        .write(path("a.tif").as_path().into(), &context)
        .unwrap();
    let grid = cells.collect(&context).unwrap();
    CellProduct::of_grid(&grid, CellFormat::Heights)
        .write(path("b.tif").as_path().into(), &context)
        .unwrap();
    assert!(bytes(&path("a.tif")) == bytes(&path("b.tif")));
    let (frame, heights) = cells.collect_cells(&context).unwrap();
    assert_eq!(frame, cells.frame());
    let same =
        |(a, b): (&f32, &f64)| f64::from(*a).to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
    assert!(heights.len() == grid.values.len() && heights.iter().zip(&grid.values).all(same));

    let contours = run::contour(&product, &ContourOptions::default(), &context).unwrap();
    contours
        .write(path("a.geojson").as_path().into(), &context)
        .unwrap();
    let lines = contours.collect(&context).unwrap();
    run::write_contours(
        &lines,
        product.crs(),
        path("b.geojson").as_path().into(),
        &context,
    )
    .unwrap();
    assert!(bytes(&path("a.geojson")) == bytes(&path("b.geojson")));
}

#[test]
fn a_model_becomes_a_product_without_a_report() {
    let Model::Tin(tin) = valley().model else {
        unreachable!()
    };
    let product = SurfaceProduct::from(Model::Tin(tin));
    assert!(product.built.is_none() && product.notices.is_empty());
}

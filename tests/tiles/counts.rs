//! Points at one site are counted in tiles as they are in one piece.

use std::fs;

use breakline::run::{
    self, Context, DemOptions, Division, Execution, Input, LineRequest, Origin, Source,
    SurfaceRequest, Targets, TileOptions, TinRequest, WriteReport, WriteRequest, Written,
    WrittenOf,
};

use super::{layer, run, valley};

/// Returns the number of points merged into others, of those at vertices of breaklines, and of
/// those in water.
fn counts(request: &WriteRequest, targets: &Targets, execution: &Execution) -> [u64; 3] {
    let report = run::write(request, targets, execution, &Context::default()).unwrap();
    let WriteReport::Written(written) = report else {
        panic!("{report:?}")
    };
    let Written { surface, files, .. } = *written;
    files.iter().for_each(|file| fs::remove_file(file).unwrap());
    match surface {
        WrittenOf::Tiles { report, .. } => [
            report.duplicates,
            report.points_on_breaklines,
            report.points_replaced,
        ],
        WrittenOf::Whole(surface) => {
            let Origin::Built(built) = surface.origin else {
                panic!("{:?}", surface.origin)
            };
            let tin = &built.tin;
            [
                tin.duplicates,
                tin.points_on_breaklines,
                tin.points_replaced,
            ]
            .map(|count| count as u64)
        }
    }
}

#[test]
fn points_at_one_site_are_counted_as_in_one_piece() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let on_grid = (0..64).map(|i| [f64::from(i % 8), f64::from(i / 8), 10.0 + f64::from(i)]);
    let others = [
        [6.0, 6.0, 1.0], // away from lines: two duplicates
        [6.0, 6.0, 2.0],
        [1.0, 1.0, 3.0], // at a vertex of a line: three points are replaced
        [1.0, 1.0, 4.0],
        [3.0, 3.0, 5.0], // at the crossing, where no line has a vertex: one duplicate
        [2.0, 2.0, 6.0], // on a line, between vertices: one
        [-0.0, 0.0, 7.0], // one, whatever the sign of zero
        [5.0, -0.0, 8.0], // at a vertex whose zero has the other sign: two are replaced
        [0.75, 5.25, 9.0], // at a vertex, alone: one is replaced
    ];
    let rows = |points: &mut dyn Iterator<Item = [f64; 3]>| {
        points.map(|[x, y, z]| format!("{x} {y} {z}\n")).collect()
    };
    let texts: [String; 2] = [
        rows(&mut on_grid.into_iter()),
        rows(&mut others.into_iter()),
    ];
    let names = [path("grid.xyz"), path("others.xyz")];
    names
        .iter()
        .zip(texts)
        .for_each(|(name, text)| fs::write(name, text).unwrap());
    let lines = [
        vec![[1.0, 1.0, 0.0], [5.0, 5.0, 0.0]],
        vec![[0.75, 5.25, 0.0], [5.25, 0.75, 0.0]],
        vec![[5.0, 0.0, 0.0], [7.0, 0.5, 0.0]],
    ];
    fs::write(path("lines.geojson"), layer(&lines, "LineString")).unwrap();
    // Twelve points of the grid are in it, and one of the others.
    let shore = [
        [2.5, 2.5, 7.0],
        [6.5, 2.5, 7.0],
        [6.5, 5.5, 7.0],
        [2.5, 5.5, 7.0],
        [2.5, 2.5, 7.0],
    ];
    fs::write(path("lake.geojson"), layer(&[shore.to_vec()], "Polygon")).unwrap();
    let files =
        |names: &[std::path::PathBuf]| names.iter().cloned().map(Input::File).collect::<Vec<_>>();
    let none = Vec::new;
    let given = |name: &str| vec![Input::File(path(name))];
    for (breaklines, flats, expected) in [
        (none(), none(), [8, 0, 0]),
        (given("lines.geojson"), none(), [5, 7, 0]),
        (none(), given("lake.geojson"), [7, 0, 13]),
    ] {
        let lines = LineRequest {
            flats,
            ..LineRequest::default()
        };
        let tin = TinRequest {
            points: files(&names),
            breaklines,
            lines,
            ..TinRequest::default()
        };
        let source = Source::Points(Box::new(tin));
        let request = WriteRequest::new(
            SurfaceRequest {
                source,
                ..SurfaceRequest::default()
            },
            DemOptions::default(),
        );
        let targets = Targets::of(path("dem.tif"));
        assert_eq!(counts(&request, &targets, &Execution::Whole), expected);
        for division in [Division::Grid([3, 2]), Division::Grid([1, 1])] {
            let tiles = Execution::Tiles(TileOptions {
                division,
                ..TileOptions::default()
            });
            assert_eq!(counts(&request, &targets, &tiles), expected, "{division:?}");
        }
    }
}

#[test]
fn what_leaves_no_point_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!(
        "dem {} --class 2 --return 3 --tiles 2x2 -o dem.tif",
        valley()
    );
    run(&folder, &words).fails(
        2,
        &[
            "no point is left of 62776 read: 40 withheld",
            "of other returns",
            "--return",
        ],
    );
}

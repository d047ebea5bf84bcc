use std::path::Path;

use rusqlite::Connection;

use super::{read_layer_with, write_contours, write_lines};
use crate::crs::Crs;
use crate::data::{Attributes, ContourLine, Layer, Shape, Value};
use crate::io::bytes::watch::unwatched;
use crate::io::options::layer::Options;

fn read(path: &Path) -> Layer {
    let options = Options {
        keeps_attributes: true,
        ..Options::default()
    };
    read_layer_with(path, &options, &unwatched).unwrap()
}

fn line(points: &[[f64; 3]]) -> Shape {
    Shape::Lines(vec![points.to_vec()])
}

/// A square whose outer ring is clockwise, with a hole.
fn square() -> Vec<Vec<[f64; 3]>> {
    let ring = |corners: [[f64; 2]; 5]| corners.map(|[x, y]| [x, y, 5.0]).to_vec();
    vec![
        ring([[0.0, 0.0], [0.0, 9.0], [9.0, 9.0], [9.0, 0.0], [0.0, 0.0]]),
        ring([[2.0, 2.0], [4.0, 2.0], [4.0, 4.0], [2.0, 4.0], [2.0, 2.0]]),
    ]
}

#[test]
fn layers_read_back_as_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("all kinds \"quoted\".gpkg");
    let other = square()
        .iter()
        .map(|ring| ring.iter().map(|[x, y, z]| [x + 20.0, *y, *z]).collect())
        .collect();
    let shapes = [
        vec![
            line(&[[0.1, 1e-300, -0.0], [1.0 / 3.0, 6e6, 2.5]]),
            Shape::Null,
        ],
        vec![Shape::Lines(vec![
            vec![[0.0; 3], [1.0; 3]],
            vec![[2.0; 3], [3.0; 3]],
        ])],
        vec![
            Shape::Points(vec![[1.0, 2.0, 3.0]]),
            Shape::Points(vec![[4.0, 5.0, 6.0]]),
        ],
        vec![
            Shape::Polygon(square()),
            Shape::Polygon([square(), other].concat()),
        ],
        vec![
            line(&[[0.0; 3], [1.0; 3]]),
            Shape::Polygon(square()),
            Shape::Points(vec![[7.0; 3]]),
        ],
    ];
    for shapes in shapes {
        let rows = (0..shapes.len() as i64).map(|i| {
            vec![
                Value::Whole(i),
                Value::Number(0.1 * i as f64),
                Value::Text(format!("text {i}: '\"é")),
                Value::Truth(i == 0),
                Value::Missing,
            ]
        });
        let layer = Layer {
            attributes: Some(Attributes {
                names: ["whole", "number", "text; drop", "truth", "nothing"]
                    .map(str::to_owned)
                    .into(),
                rows: rows.collect(),
            }),
            crs: Some(Crs::from_epsg(25832).unwrap()),
            shapes,
            ..Layer::default()
        };
        assert_eq!(write_lines(&path, &layer).unwrap(), Vec::<String>::new());
        let found = read(&path);
        assert_eq!(found.shapes, layer.shapes);
        assert_eq!(found.attributes, layer.attributes);
        assert_eq!(found.crs.unwrap().epsg, Some(25832));
    }
    // Nothing but the file is left.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn what_a_file_states_agrees_with_its_records() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gpkg_c.gpkg");
    let lines = [
        ContourLine {
            level: 10.0,
            points: vec![[0.0, 1.0], [2.0, 3.0]],
        },
        ContourLine {
            level: 11.0,
            points: vec![[9.0, 9.0]],
        },
        ContourLine {
            level: 12.0,
            points: vec![[4.0, -1.0], [5.0, 8.0], [4.0, -1.0]],
        },
    ];
    let write = |path: &Path| write_contours(path, &mut lines.clone().into_iter(), None).unwrap();
    assert_eq!(write(&path).lines, 2);
    let again = folder.path().join("again").with_extension("gpkg");
    write(&again);
    std::fs::rename(&again, folder.path().join("other")).unwrap();
    let database = Connection::open(&path).unwrap();
    let texts = |query: &str| -> Vec<String> {
        let mut statement = database.prepare(query).unwrap();
        let rows = statement.query_map([], |row| row.get(0)).unwrap();
        rows.map(Result::unwrap).collect()
    };
    assert_eq!(texts("PRAGMA integrity_check"), ["ok"]);
    assert_eq!(
        texts("SELECT count(*) || '' FROM pragma_foreign_key_check()"),
        ["0"]
    );
    assert_eq!(
        texts(
            "SELECT concat_ws(' ', table_name, min_x, min_y, max_x, max_y, srs_id, last_change) FROM gpkg_contents"
        ),
        ["layer_gpkg_c 0.0 -1.0 5.0 8.0 -1 1970-01-01T00:00:00.000Z"]
    );
    assert_eq!(
        texts("SELECT concat_ws(' ', geometry_type_name, z, m) FROM gpkg_geometry_columns"),
        ["LINESTRING 1 0"]
    );
    assert_eq!(
        texts(
            "SELECT concat_ws(' ', id, minx, maxx, miny, maxy) FROM rtree_layer_gpkg_c_geom ORDER BY id"
        ),
        ["1 0.0 2.0 1.0 3.0", "2 4.0 5.0 -1.0 8.0"]
    );
    assert_eq!(
        texts("SELECT name FROM sqlite_master WHERE type = 'trigger'").len(),
        6
    );
    let found = read(&path);
    assert!(found.crs.is_none());
    assert_eq!(found.fields, ["ID", "ELEV"]);
    assert_eq!(
        found.attributes.unwrap().rows,
        [10.0, 12.0].map(|level| vec![Value::Whole((level as i64 - 8) / 2), Value::Number(level)])
    );
    assert_eq!(found.shapes[0], line(&[[0.0, 1.0, 10.0], [2.0, 3.0, 10.0]]));
    // The triggers call functions of others: they are what the standard has, if they parse.
    database
        .execute_batch("DROP TRIGGER rtree_layer_gpkg_c_geom_delete; DELETE FROM layer_gpkg_c")
        .unwrap();
}

#[test]
fn the_same_data_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let written = [0, 1].map(|i| {
        std::fs::create_dir(folder.path().join(i.to_string())).unwrap();
        let path = folder.path().join(format!("{i}/c.gpkg"));
        let line = |i: u32| ContourLine {
            level: f64::from(i),
            points: vec![[f64::from(i), 0.0], [0.0, f64::from(i)]],
        };
        write_contours(&path, &mut (0..1000).map(line), None).unwrap();
        std::fs::read(path).unwrap()
    });
    assert!(written[0] == written[1]);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let status = std::process::Command::new("mkfifo").arg(&path).status();
    assert!(status.unwrap().success());
    let error = write_contours(&path, &mut std::iter::empty(), None).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("a.gpkg: a GeoPackage is a database, which a pipe cannot take")
    );
}

#[test]
fn names_that_collide_are_numbered() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let layer = Layer {
        shapes: vec![line(&[[0.0; 3], [1.0; 3]])],
        attributes: Some(Attributes {
            names: ["FID", "a", "A", "geom"].map(str::to_owned).into(),
            rows: vec![(1..5).map(Value::Whole).collect()],
        }),
        ..Layer::default()
    };
    assert_eq!(write_lines(&path, &layer).unwrap().len(), 3);
    assert_eq!(read(&path).fields, ["FID_2", "a", "A_2", "geom_2"]);
}

#[test]
fn layers_are_named_and_requests_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let layer = Layer {
        shapes: vec![line(&[[0.0; 3], [1.0; 3]])],
        attributes: Some(Attributes {
            names: vec!["H".to_owned(), "T".to_owned()],
            rows: vec![vec![Value::Number(7.5), Value::Text("oak".to_owned())]],
        }),
        ..Layer::default()
    };
    write_lines(&path, &layer).unwrap();
    let with = |options: Options| read_layer_with(&path, &options, &unwatched);
    let height = with(Options {
        height_field: Some("h"),
        columns: &["H"],
        ..Options::default()
    })
    .unwrap();
    assert_eq!(height.shapes, [line(&[[0.0, 0.0, 7.5], [1.0, 1.0, 7.5]])]);
    assert_eq!(height.columns[0].values, [7.5]);
    for (options, text) in [
        (
            Options {
                layer: Some("b"),
                ..Options::default()
            },
            "there is no layer \"b\"",
        ),
        (
            Options {
                height_field: Some("Z"),
                ..Options::default()
            },
            "there is no field Z",
        ),
        (
            Options {
                columns: &["T"],
                ..Options::default()
            },
            "layer a, fid 1: field T: expected a number, found 'oak'",
        ),
    ] {
        let error = with(options).unwrap_err().to_string();
        assert!(error.ends_with(text), "{error}");
    }
    let database = Connection::open(&path).unwrap();
    database
        .execute_batch(
            "CREATE TABLE b(fid INTEGER PRIMARY KEY, geom BLOB);
             INSERT INTO b VALUES (1, NULL), (2, x'47500001'), (3, 5);
             INSERT INTO gpkg_contents(table_name, data_type, srs_id) VALUES ('b', 'features', 0);
             INSERT INTO gpkg_geometry_columns VALUES ('b', 'geom', 'GEOMETRY', 0, 2, 0);",
        )
        .unwrap();
    let error = with(Options::default()).unwrap_err();
    assert!(error.to_string().ends_with("there are 2 layers in it"));
    assert!(
        error
            .cure_text()
            .unwrap()
            .plain()
            .contains("FILE:LAYER: a, b")
    );
    let error = with(Options {
        layer: Some("B"),
        ..Options::default()
    })
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("layer b, fid 2: a geometry that ends too early"),
        "{error}"
    );
    database
        .execute_batch("DELETE FROM b WHERE fid = 2")
        .unwrap();
    let error = with(Options {
        layer: Some("b"),
        ..Options::default()
    })
    .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("layer b, fid 3: Integer in place of a geometry"),
        "{error}"
    );
    let plain = folder.path().join("plain.gpkg");
    Connection::open(&plain)
        .unwrap()
        .execute_batch("CREATE TABLE t(a)")
        .unwrap();
    let error = read_layer_with(&plain, &Options::default(), &unwatched).unwrap_err();
    assert!(error.to_string().contains("not a GeoPackage"), "{error}");
}

/// Each byte of the first and last pages in turn, and cuts: a layer or an error, and no panic.
#[test]
fn damage_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let lines = (0..40).map(|i| ContourLine {
        level: f64::from(i),
        points: (0..30).map(|k| [f64::from(k), f64::from(i)]).collect(),
    });
    write_contours(&path, &mut lines.into_iter(), None).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let broken = folder.path().join("b.gpkg");
    let try_reading = |bytes: &[u8]| {
        std::fs::write(&broken, bytes).unwrap();
        match read_layer_with(&broken, &Options::default(), &unwatched) {
            Ok(layer) => assert!(layer.shapes.len() <= 40 * 40),
            Err(error) => assert!(error.to_string().starts_with(broken.to_str().unwrap())),
        }
    };
    let most: usize = std::env::var("BREAKLINE_DAMAGE").map_or(300, |n| n.parse().unwrap());
    let step = (whole.len() / most).max(1);
    for at in (0..whole.len()).step_by(step) {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        try_reading(&bytes);
        bytes[at] = 0xff;
        try_reading(&bytes);
    }
    for part in 0..200 {
        std::fs::write(&broken, &whole[..whole.len() * part / 200 - part % 2]).unwrap();
        assert!(read_layer_with(&broken, &Options::default(), &unwatched).is_err());
    }
}

#[test]
fn a_system_with_heights_keeps_both() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.gpkg");
    let crs = Crs::from_user("EPSG:26918+6360").unwrap();
    assert!(crs.vertical_unit.is_some());
    write_contours(&path, &mut std::iter::empty(), Some(&crs)).unwrap();
    let found = read(&path).crs.unwrap();
    assert!(found.is_same(&crs));
    assert_eq!(found.vertical_unit, crs.vertical_unit);
}

#[test]
fn numbers_among_texts_keep_their_digits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let values = [
        Value::Text("x".to_owned()),
        Value::Number(0.1 + 0.2),
        Value::Truth(true),
    ];
    let layer = Layer {
        shapes: vec![
            Shape::Points(Vec::new()),
            line(&[[0.0; 3], [1.0; 3]]),
            Shape::Lines(Vec::new()),
        ],
        attributes: Some(Attributes {
            names: vec!["a".to_owned()],
            rows: values.map(|value| vec![value]).into(),
        }),
        ..Layer::default()
    };
    write_lines(&path, &layer).unwrap();
    let found = read(&path);
    let texts = ["x", "0.30000000000000004", "true"].map(|text| vec![Value::Text(text.to_owned())]);
    assert_eq!(found.attributes.unwrap().rows, texts);
    assert_eq!(found.shapes[0], layer.shapes[0]);
    assert_eq!(found.shapes[2], line(&[]));
}

/// A log beside the file that is replaced is that of the old database.
#[cfg(unix)]
#[test]
fn a_log_of_the_file_before_goes() {
    let folder = tempfile::tempdir().unwrap();
    let [real, link] = ["REAL.GPKG", "link.gpkg"].map(|name| folder.path().join(name));
    write_contours(&real, &mut std::iter::empty(), None).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    std::fs::write(folder.path().join("REAL.GPKG-wal"), "of the old one").unwrap();
    write_contours(&link, &mut std::iter::empty(), None).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["REAL.GPKG", "link.gpkg"]);
}

/// As a copy of a database that another program had open: nothing is written beside it.
#[test]
fn a_database_with_a_log_is_read_without_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("with log 50%?#.gpkg");
    let contour = ContourLine {
        level: 7.0,
        points: vec![[0.0, 1.0], [2.0, 3.0]],
    };
    write_contours(&path, &mut std::iter::once(contour), None).unwrap();
    let database = Connection::open(&path).unwrap();
    database
        .query_row("PRAGMA journal_mode = WAL", [], |_| Ok(()))
        .unwrap();
    drop(database);
    assert_eq!(read(&path).shapes.len(), 1);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    std::fs::write(&path, "version https://git-lfs.github.com/spec/v1").unwrap();
    let error = read_layer_with(&path, &Options::default(), &unwatched).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("does not begin as an SQLite database"),
        "{error}"
    );
}

#[test]
fn a_query_without_an_end_is_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let layer = Layer {
        shapes: vec![line(&[[0.0; 3], [1.0; 3]])],
        ..Layer::default()
    };
    write_lines(path.as_path(), &layer).unwrap();
    let database = Connection::open(&path).unwrap();
    database
        .execute_batch(
            "PRAGMA foreign_keys = OFF;
             CREATE VIEW b AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c)
               SELECT max(x) AS n, NULL AS geom FROM c;
             UPDATE gpkg_geometry_columns SET table_name = 'b';",
        )
        .unwrap();
    drop(database);
    let calls = std::sync::atomic::AtomicUsize::new(0);
    let watch = |_| match calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed) {
        0 | 1 => Ok(()),
        _ => Err(crate::error::Error::canceled()),
    };
    let error = read_layer_with(&path, &Options::default(), &watch).unwrap_err();
    assert_eq!(error.kind(), crate::error::Kind::Canceled);
}

#[test]
fn a_system_may_be_stated_by_the_later_column_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gpkg");
    let layer = Layer {
        shapes: vec![line(&[[0.0; 3], [1.0; 3]])],
        crs: Some(Crs::from_user("EPSG:25832+7837").unwrap()),
        ..Layer::default()
    };
    write_lines(path.as_path(), &layer).unwrap();
    let database = Connection::open(&path).unwrap();
    database
        .execute_batch(
            "ALTER TABLE gpkg_spatial_ref_sys ADD COLUMN definition_12_063 TEXT;
             UPDATE gpkg_spatial_ref_sys SET definition_12_063 = definition, definition = 'undefined';",
        )
        .unwrap();
    drop(database);
    let back = read(&path);
    assert!(back.crs.unwrap().is_same(&layer.crs.unwrap()));
    assert!(back.warnings.is_empty());
}

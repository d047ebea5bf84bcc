//! What is written against what is read.

use std::io::Write;
use std::process::Command;

use super::{facts, read};
use breakline::crs::Crs;
use breakline::data::{self, Attributes, ContourLine, Layer, Shape};
use breakline::io::{contours, layer};
use serde_json::Value;

fn lines() -> Vec<ContourLine> {
    vec![
        ContourLine {
            level: 12.3,
            points: vec![[0.5, 0.25], [1e6 + 0.1, 5e6 + 0.7]],
        },
        ContourLine {
            level: 0.0,
            points: vec![[0., 0.], [1., 0.], [1., 1.], [0., 0.]],
        },
        ContourLine {
            level: -1.0 / 3.0,
            points: vec![[0., 0.], [0., 1.], [0., 2.], [3., 2.]],
        },
    ]
}

fn expected() -> Vec<Vec<[f64; 3]>> {
    lines()
        .iter()
        .map(|line| {
            line.points
                .iter()
                .map(|p| [p[0], p[1], line.level])
                .collect()
        })
        .collect()
}

#[test]
fn contours_come_back_from_each_format() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["c.shp", "c.gpkg", "c.geojson", "c.JSON", "c.geojsonl"] {
        let target = folder.path().join(name);
        let summary = contours::write(&target, &mut lines().into_iter(), None).unwrap();
        assert_eq!(
            (summary.lines, summary.vertices, summary.closed),
            (3, 10, 1)
        );
        assert_eq!(
            (summary.bounds.min, summary.bounds.max),
            ([0., 0., -1.0 / 3.0], [1e6 + 0.1, 5e6 + 0.7, 12.3])
        );
        for spec in [
            target.display().to_string(),
            format!("{}::elev", target.display()),
        ] {
            let layer = layer::read(&spec).unwrap();
            let shapes: Vec<Shape> = expected()
                .into_iter()
                .map(|line| Shape::Lines(vec![line]))
                .collect();
            assert_eq!(layer.shapes, shapes, "{spec}");
            assert!(layer.fields.contains(&"ELEV".to_owned()));
        }
    }
    let error =
        contours::write(&folder.path().join("c.kml"), &mut lines().into_iter(), None).unwrap_err();
    assert!(error.to_string().ends_with(
        "c.kml: contours are written as .shp, .geojson, .json, .geojsonl, .geojsons, .gpkg, .fgb or .dxf"
    ));
}

#[test]
fn another_reader_agrees_on_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("c.shp");
    contours::write(&target, &mut lines().into_iter(), None).unwrap();
    let mut reader = ::shapefile::Reader::from_path(&target).unwrap();
    for (i, pair) in reader.iter_shapes_and_records().enumerate() {
        let (::shapefile::Shape::PolylineZ(line), record) = pair.unwrap() else {
            panic!("no PolyLineZ")
        };
        let vertices: Vec<[f64; 3]> = line
            .parts()
            .iter()
            .flatten()
            .map(|p| [p.x, p.y, p.z])
            .collect();
        assert_eq!(vertices, expected()[i]);
        let number = |name: &str| match record.get(name) {
            Some(::shapefile::dbase::FieldValue::Numeric(Some(value))) => *value,
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!(
            (number("ID"), number("ELEV")),
            (i as f64 + 1.0, lines()[i].level)
        );
    }
    assert_eq!(reader.shape_count().unwrap(), 3);
}

#[test]
fn the_same_lines_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = |name: &str| {
        let target = folder.path().join(name);
        contours::write(&target, &mut lines().into_iter(), None).unwrap();
        ["shp", "shx", "dbf", "cpg"]
            .map(|extension| std::fs::read(target.with_extension(extension)).unwrap())
    };
    let [shp, shx, dbf, cpg] = bytes("a.shp");
    assert_eq!([&shp, &shx, &dbf, &cpg], bytes("b.shp").each_ref());
    assert_eq!(dbf[..4], [3, 70, 1, 1], "the date is constant");
    assert_eq!(
        (cpg.as_slice(), shx.len(), dbf.len()),
        (b"UTF-8".as_slice(), 100 + 3 * 8, 32 + 64 + 1 + 3 * 35 + 1)
    );
}

#[test]
fn a_failure_leaves_the_old_files() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("c.shp");
    // A folder where the .dbf should go; it is committed before the .shp.
    std::fs::create_dir(target.with_extension("dbf")).unwrap();
    std::fs::File::create(&target)
        .unwrap()
        .write_all(b"old")
        .unwrap();
    let error = contours::write(&target, &mut lines().into_iter(), None).unwrap_err();
    assert!(error.to_string().contains("c.dbf"), "{error}");
    assert_eq!(std::fs::read(&target).unwrap(), b"old");
}

#[test]
fn ogrinfo_reads_the_contours() {
    if Command::new("ogrinfo").arg("--version").output().is_err() {
        eprintln!("skipped: ogrinfo is not here (apt-get install gdal-bin)");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, elevation) in [
        ("c.shp", ["ELEV: Real (24.6)", "= 12.300000\n"]),
        ("c.geojson", ["ELEV: Real (0.0)", "= 12.3\n"]),
    ] {
        let target = folder.path().join(name);
        contours::write(&target, &mut lines().into_iter(), None).unwrap();
        let output = Command::new("ogrinfo")
            .args(["-al", "-ro"])
            .arg(&target)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{name}");
        for wanted in [
            "Geometry: 3D Line String",
            "Feature Count: 3",
            "Extent: (0.000000, 0.000000) - (1000000.100000, 5000000.700000)",
            "LINESTRING Z (0.5 0.25 12.3,1000000.1 5000000.7 12.3)",
        ]
        .into_iter()
        .chain(elevation)
        {
            assert!(
                text.contains(wanted),
                "{name}: {wanted:?} is not in\n{text}"
            );
        }
    }
}

/// Every file with a `.prj`, by folder.
const SYSTEMS: &[(&str, &[&str], u32)] = &[
    ("dem/hintereisferner", &["Hintereisferner"], 4326),
    ("dem/hintereisferner", &["Hintereisferner_UTM"], 32632),
    ("dem/lux", &["lux"], 4326),
    ("dem/qgis_3d", &["buildings", "points_with_z"], 27700),
    ("lidar/delft_ahn3_bgt", &["breaklines_z_derived"], 28992),
    (
        "lidar/delft_ahn3_bgt/bgt_shp",
        &[
            "bgt_begroeidterreindeel",
            "bgt_kunstwerkdeel",
            "bgt_onbegroeidterreindeel",
        ],
        28992,
    ),
    (
        "lidar/delft_ahn3_bgt/bgt_shp",
        &["bgt_overbruggingsdeel", "bgt_pand", "bgt_scheiding"],
        28992,
    ),
    (
        "lidar/delft_ahn3_bgt/bgt_shp",
        &["bgt_waterdeel", "bgt_wegdeel"],
        28992,
    ),
    ("lidar/ign_0292_6833", &["Lignes_3d_0292_6833"], 2154),
    (
        "lidar/quebec_lidR",
        &["efi_plot", "lake_polygons_UTM17"],
        26917,
    ),
    (
        "shp/geotools",
        &["archsites", "bugsites", "roads", "rstrct", "streams"],
        26713,
    ),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_prj_names_its_system() {
    let facts = facts();
    let mut seen = 0;
    for (folder, names, code) in SYSTEMS {
        for name in *names {
            let layer = read(&testkit::shared(&format!("{folder}/{name}.shp"))).unwrap();
            assert_eq!(
                layer.crs.and_then(|crs| crs.epsg),
                Some(*code),
                "{folder}/{name}"
            );
            seen += 1;
        }
    }
    let with_prj = |fact: &Value| {
        fact["sidecars"]
            .as_array()
            .is_some_and(|list| list.contains(&"prj".into()))
    };
    assert_eq!(seen, facts.values().filter(|fact| with_prj(fact)).count());
    for name in ["Lignes_2d", "Lignes_3d", "Points_virtuels"] {
        let path = testkit::shared(&format!("lidar/ign_0292_6833/{name}_0292_6833.geojson"));
        assert_eq!(
            read(&path).unwrap().crs.and_then(|crs| crs.epsg),
            Some(2154),
            "{name}"
        );
    }
}

#[test]
fn contours_keep_their_system() {
    let folder = tempfile::tempdir().unwrap();
    for code in [25832, 2154, 2263, 26917, 28992, 4326] {
        let crs = Crs::from_epsg(code).unwrap();
        for name in ["c.shp", "c.geojson"] {
            let target = folder.path().join(name);
            // Where degrees can be, so that GeoJSON without a `crs` member means EPSG:4326.
            let line = ContourLine {
                level: 5.0,
                points: vec![[1.0, 2.0], [3.0, 4.0]],
            };
            let summary = contours::write(&target, &mut [line].into_iter(), Some(&crs)).unwrap();
            assert_eq!(summary.warnings, [] as [&str; 0]);
            let layer = read(&target).unwrap();
            assert_eq!(layer.warnings, [] as [&str; 0], "{name} in EPSG:{code}");
            assert!(
                layer.crs.is_some_and(|found| found.is_same(&crs)),
                "{name} in EPSG:{code}"
            );
            if let Ok(output) = Command::new("ogrinfo")
                .args(["-al", "-so", "-ro"])
                .arg(&target)
                .output()
            {
                let text = String::from_utf8_lossy(&output.stdout);
                // GDAL makes WGS 84 with heights of GeoJSON that names no system.
                let shown = if name == "c.geojson" && code == 4326 {
                    4979
                } else {
                    code
                };
                let last = text.lines().rfind(|line| line.contains("ID[\"EPSG\""));
                assert_eq!(
                    last.map(str::trim),
                    Some(format!("ID[\"EPSG\",{shown}]]").as_str()),
                    "{name}:\n{text}"
                );
            }
        }
    }
}

/// More records than are evaluated together: the same are chosen of each format.
#[test]
fn a_condition_chooses_the_same_records_of_each_format() {
    let folder = tempfile::tempdir().unwrap();
    let count = 3000;
    let shape = |i: i64| {
        let x = 500_000.0 + i as f64;
        Shape::Lines(vec![vec![[x, 0.0, 1.0], [x + 0.5, 1.0, 2.0]]])
    };
    let row = |i: i64| {
        let kind = if i == 2500 { "high" } else { "7" };
        vec![data::Value::Whole(i), data::Value::Text(kind.to_owned())]
    };
    let lines = Layer {
        shapes: (1..=count).map(shape).collect(),
        attributes: Some(Attributes {
            names: vec!["id".to_owned(), "kind".to_owned()],
            rows: (1..=count).map(row).collect(),
        }),
        ..Layer::default()
    };
    for name in ["a.shp", "a.gpkg", "a.geojson", "a.fgb"] {
        let path = folder.path().join(name);
        layer::write_lines(&path, &lines).unwrap();
        let read = |text: &str| {
            let condition = layer::Condition::parse(text).unwrap();
            let options = layer::Options {
                columns: &["id"],
                condition: Some(&condition),
                ..layer::Options::default()
            };
            layer::read_with(&path, &options, &|_| Ok(()))
        };
        let whole = layer::read(&path.display().to_string()).unwrap();
        for text in [
            "id <= 3 OR id > 2990",
            "id BETWEEN 1000 AND 2100",
            "id > 0",
            "id < 0",
        ] {
            let chosen = read(text).unwrap();
            let ids: Vec<f64> = chosen.columns[0].values.clone();
            let holds = |&id: &f64| match text {
                "id <= 3 OR id > 2990" => id <= 3.0 || id > 2990.0,
                "id BETWEEN 1000 AND 2100" => (1000.0..=2100.0).contains(&id),
                "id > 0" => true,
                _ => false,
            };
            let mut sorted = ids.clone();
            sorted.sort_by(f64::total_cmp);
            let expected: Vec<f64> = (1..=count).map(|id| id as f64).filter(holds).collect();
            assert_eq!(sorted, expected, "{name} {text}");
            assert!(chosen.attributes.is_none());
            for (at, shape) in chosen.shapes.iter().enumerate() {
                assert_eq!(*shape, whole.shapes[chosen.record(at) - 1], "{name} {text}");
            }
            assert_eq!(chosen.shapes.len(), expected.len());
            let warned = chosen.warnings.iter();
            let warned = warned.filter(|text| text.plain().contains("none of 3000 records"));
            assert_eq!(warned.count(), usize::from(expected.is_empty()), "{name}");
        }
        let error = read("kind > 5").unwrap_err();
        let at = error.location().unwrap();
        assert!(at.starts_with("record "), "{name}: {error}");
        let record: usize = at["record ".len()..].parse().unwrap();
        let line = [500_000.0 + 2500.0, 0.0, 1.0];
        assert!(
            whole.shapes[record - 1].vertices().any(|&p| p == line),
            "{name} {at}"
        );
    }
}

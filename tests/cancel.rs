//! Reading under watch. `examples/cancel_latency.rs` measures how soon whole runs end.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use breakline::Result;
use breakline::data::{Frame, Grid};
use breakline::error::{Error, Kind};
use breakline::io::layer::Options;
use breakline::io::{Watch, geojson, geotiff, mesh, shapefile, triangle};

/// The side of a square grid of points, so that every file is larger than the bytes between two
/// calls of a watch.
const SIDE: usize = 260;

/// Writes a surface of `SIDE` times `SIDE` vertices in all formats that are read under watch.
fn files(folder: &Path) -> Vec<PathBuf> {
    let faces = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column));
    let faces: Vec<[usize; 3]> = faces
        .flat_map(|a| [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]])
        .collect();
    let points: Vec<[usize; 2]> = (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE]).collect();
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let list = |head: String, rows: &mut dyn Iterator<Item = String>| {
        rows.fold(head, |mut text, row| {
            writeln!(text, "{row}").unwrap();
            text
        })
    };
    let obj = list(
        list(
            String::new(),
            &mut points
                .iter()
                .map(|[x, y]| format!("v {x}.00000 {y}.00000 1.25")),
        ),
        &mut faces
            .iter()
            .map(|f| format!("f {} {} {}", f[0] + 1, f[1] + 1, f[2] + 1)),
    );
    let obj = write("a.obj", &obj);
    let surface = mesh::read(&obj).unwrap();
    let [ply, off] = ["a.ply", "a.off"].map(|name| folder.join(name));
    mesh::write(ply.as_path(), &surface).unwrap();
    mesh::write(off.as_path(), &surface).unwrap();
    let node = list(
        format!("{} 2 0 0\n", points.len()),
        &mut points
            .iter()
            .enumerate()
            .map(|(i, [x, y])| format!("{i} {x}.0000000000 {y}.0000000000")),
    );
    write("a.node", &node);
    let ele = list(
        format!("{} 3 0\n", faces.len()),
        &mut faces
            .iter()
            .enumerate()
            .map(|(i, f)| format!("{i} {} {} {}", f[0], f[1], f[2])),
    );
    let ele = write("a.ele", &ele);
    let features: Vec<String> = points
        .iter()
        .map(|[x, y]| {
            format!(
                r#"{{"type":"Feature","geometry":{{"type":"Point","coordinates":[{x},{y},1]}}}}"#
            )
        })
        .collect();
    let json = format!(
        r#"{{"type":"FeatureCollection","features":[{}]}}"#,
        features.join(",")
    );
    let json = write("a.geojson", &json);
    let shp = folder.join("a.shp");
    shapefile::write_layer(
        shp.as_path(),
        &geojson::read_layer(&json, None).unwrap(),
        &[],
    )
    .unwrap();
    let tif = folder.join("a.tif");
    let frame = Frame::north_up(0.0, 0.0, 1.0, 2048, 4096);
    let grid = Grid {
        frame,
        crs: None,
        values: (0..2048 * 4096).map(|i| f64::from(i % 1000)).collect(),
    };
    geotiff::write(tif.as_path(), &grid, geotiff::WriteOptions::default()).unwrap();
    vec![obj, ply, off, ele, json, shp, tif]
}

fn read(path: &Path, watch: Watch) -> Result<usize> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("geojson") => geojson::read_layer_with(path, &Options::default(), watch)
            .map(|layer| layer.shapes.len()),
        Some("shp") => shapefile::read_layer_with(path, &Options::default(), watch)
            .map(|layer| layer.shapes.len()),
        Some("tif") => geotiff::open(path)?
            .read_grid_with(watch)
            .map(|grid| grid.values.len()),
        Some("node") => triangle::read_with(path, watch).map(|graph| graph.nodes.points.len()),
        _ => mesh::read_triangles_with(path, watch).map(|mesh| mesh.vertices.len()),
    }
}

#[test]
fn every_reader_ends_with_the_error_of_its_watch() {
    let folder = tempfile::tempdir().unwrap();
    let mut files = files(folder.path());
    files.push(folder.path().join("a.node"));
    for path in files {
        let name = path.display();
        let (calls, counted) = (AtomicU64::new(0), AtomicU64::new(0));
        let all = read(&path, &|items| {
            calls.fetch_add(1, Ordering::Relaxed);
            counted.fetch_add(items, Ordering::Relaxed);
            Ok(())
        });
        let expected = if name.to_string().ends_with("tif") {
            2048 * 4096
        } else {
            SIDE * SIDE
        };
        assert_eq!(all.unwrap(), expected, "{name}");
        let calls = calls.into_inner();
        assert!(calls > 1, "{name}: {calls} calls");
        for last in 0..calls.min(20) {
            let done = AtomicU64::new(0);
            let watch = |_| {
                if done.fetch_add(1, Ordering::Relaxed) == last {
                    Err(Error::canceled())
                } else {
                    Ok(())
                }
            };
            let error = read(&path, &watch).unwrap_err();
            assert_eq!(
                (error.kind(), error.to_string().as_str()),
                (Kind::Canceled, "canceled"),
                "{name}"
            );
            assert_eq!(
                done.into_inner(),
                last + 1,
                "{name}: the watch is not called again"
            );
        }
    }
}

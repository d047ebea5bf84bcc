//! Reading under watch, and how soon a run ends after it was canceled.

#![allow(clippy::print_stdout, reason = "latencies are measured by hand")]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use breakline::data::{Frame, Grid};
use breakline::error::{Error, Kind};
use breakline::io::{Watch, geojson, geotiff, mesh, shapefile, triangle};
use breakline::run::{
    self, Context, ContourOptions, FrameOptions, HillshadeOptions, Monitor, Notice, PointsRequest, Progress, Size,
    Source, Stage, SurfaceRequest,
};
use breakline::{Result, io};

/// The side of a square grid of points, so that every file is larger than the bytes between two
/// calls of a watch.
const SIDE: usize = 260;

/// Writes a surface of `SIDE` times `SIDE` vertices in all formats that are read under watch.
fn files(folder: &Path) -> Vec<PathBuf> {
    let faces = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column));
    let faces: Vec<[usize; 3]> = faces.flat_map(|a| [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]]).collect();
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
        list(String::new(), &mut points.iter().map(|[x, y]| format!("v {x}.00000 {y}.00000 1.25"))),
        &mut faces.iter().map(|f| format!("f {} {} {}", f[0] + 1, f[1] + 1, f[2] + 1)),
    );
    let obj = write("a.obj", &obj);
    let surface = mesh::read(&obj).unwrap();
    let [ply, off] = ["a.ply", "a.off"].map(|name| folder.join(name));
    mesh::write(ply.as_path(), &surface).unwrap();
    mesh::write(off.as_path(), &surface).unwrap();
    let node = list(
        format!("{} 2 0 0\n", points.len()),
        &mut points.iter().enumerate().map(|(i, [x, y])| format!("{i} {x}.0000000000 {y}.0000000000")),
    );
    write("a.node", &node);
    let ele = list(
        format!("{} 3 0\n", faces.len()),
        &mut faces.iter().enumerate().map(|(i, f)| format!("{i} {} {} {}", f[0], f[1], f[2])),
    );
    let ele = write("a.ele", &ele);
    let features: Vec<String> = points
        .iter()
        .map(|[x, y]| format!(r#"{{"type":"Feature","geometry":{{"type":"Point","coordinates":[{x},{y},1]}}}}"#))
        .collect();
    let json = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","));
    let json = write("a.geojson", &json);
    let shp = folder.join("a.shp");
    shapefile::write_layer(shp.as_path(), &geojson::read_layer(&json, None).unwrap(), &[]).unwrap();
    let tif = folder.join("a.tif");
    let frame = Frame::north_up(0.0, 0.0, 1.0, 2048, 4096);
    let grid = Grid { frame, crs: None, values: (0..2048 * 4096).map(|i| f64::from(i % 1000)).collect() };
    geotiff::write(tif.as_path(), &grid, geotiff::WriteOptions::default()).unwrap();
    vec![obj, ply, off, ele, json, shp, tif]
}

fn read(path: &Path, watch: Watch) -> Result<usize> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("geojson") => geojson::read_layer_with(path, None, watch).map(|layer| layer.shapes.len()),
        Some("shp") => shapefile::read_layer_with(path, None, watch).map(|layer| layer.shapes.len()),
        Some("tif") => geotiff::open(path)?.read_grid_with(watch).map(|grid| grid.values.len()),
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
        let expected = if name.to_string().ends_with("tif") { 2048 * 4096 } else { SIDE * SIDE };
        assert_eq!(all.unwrap(), expected, "{name}");
        let calls = calls.into_inner();
        assert!(calls > 1, "{name}: {calls} calls");
        for last in 0..calls.min(20) {
            let done = AtomicU64::new(0);
            let watch = |_| if done.fetch_add(1, Ordering::Relaxed) == last { Err(Error::canceled()) } else { Ok(()) };
            let error = read(&path, &watch).unwrap_err();
            assert_eq!((error.kind(), error.to_string().as_str()), (Kind::Canceled, "canceled"), "{name}");
            assert_eq!(done.into_inner(), last + 1, "{name}: the watch is not called again");
        }
    }
}

/// What a verb does in a context.
type Work<'a> = dyn Fn(&Context) -> Result<()> + 'a;

/// Remembers the stage that began last.
#[derive(Default)]
struct Stages(Mutex<Option<Stage>>);

impl Monitor for Stages {
    fn start(&self, stage: Stage, _: Size) -> Box<dyn Progress> {
        *self.0.lock().unwrap() = Some(stage);
        Box::new(())
    }

    fn notice(&self, _: &Notice) {}
}

/// Prints, for each verb, the longest time from cancellation to its end, and the stage.
#[test]
#[ignore = "measures, and judges nothing: --ignored --nocapture"]
fn latency_of_cancellation() {
    let folder = tempfile::tempdir().unwrap();
    let lidar = [1, 2, 3, 4].map(|i| testkit::shared(&format!("lidar/bcts/bcts_{i}.laz")));
    let raster = testkit::shared("dem/Copernicus_DSM_COG_10_N54_00_W165_00_DEM.tif");
    let lakes = testkit::shared("shp/ne_10m_lakes_north_america.shp");
    let of = |files: &[PathBuf]| {
        let mut request = SurfaceRequest { source: Source::of_files(files).unwrap(), ..SurfaceRequest::default() };
        request.systems.degrees = run::Degrees::Allow;
        request
    };
    let ply = folder.path().join("a.ply");
    let tin = run::triangles(&of(&lidar), &Context::default()).unwrap();
    run::write_mesh(tin.triangles().unwrap(), ply.as_path().into(), &Context::default()).unwrap();

    let out = |name: &str| folder.path().join(name);
    let work: [(&str, &Work); 7] = [
        ("tin of LAZ", &|context| {
            let product = run::triangles(&of(&lidar), context)?;
            run::write_mesh(product.triangles()?, out("b.ply").as_path().into(), context).map(drop)
        }),
        ("dem of LAZ", &|context| {
            let product = run::triangles(&of(&lidar), context)?;
            let frame = FrameOptions { resolution: Some(0.2), ..FrameOptions::default() };
            run::dem(&product, &frame, context)?.write(out("b.tif").as_path().into(), context).map(drop)
        }),
        ("contour of PLY", &|context| {
            let product = run::surface(&of(std::slice::from_ref(&ply)), context)?;
            run::contour(&product, &ContourOptions::default(), context)?
                .write(out("b.shp").as_path().into(), context)
                .map(drop)
        }),
        ("contour of GeoTIFF", &|context| {
            let product = run::surface(&of(std::slice::from_ref(&raster)), context)?;
            run::contour(&product, &ContourOptions::default(), context)?
                .write(out("b.shp").as_path().into(), context)
                .map(drop)
        }),
        ("hillshade of GeoTIFF", &|context| {
            let product = run::surface(&of(std::slice::from_ref(&raster)), context)?;
            run::hillshade(&product, &HillshadeOptions::default(), context)?
                .write(out("b.tif").as_path().into(), context)
                .map(drop)
        }),
        ("points of LAZ", &|context| {
            let request = PointsRequest { files: lidar.to_vec(), ..PointsRequest::default() };
            run::write_points(&request, out("b.laz").as_path().into(), context).map(drop)
        }),
        ("info of a shapefile", &|context| run::facts(&lakes, io::points::Options::default(), context).map(drop)),
    ];
    for (name, work) in work {
        let start = Instant::now();
        work(&Context::default()).unwrap();
        let all = start.elapsed();
        let mut worst = (Duration::ZERO, None);
        for share in 1..40 {
            let (cancel, stages) = (AtomicBool::new(false), Stages::default());
            let context = Context { monitor: &stages, cancel: &cancel };
            let (set, done) = thread::scope(|scope| {
                let canceler = scope.spawn(|| {
                    thread::sleep(all * share / 40);
                    let stage = *stages.0.lock().unwrap();
                    cancel.store(true, Ordering::Relaxed);
                    (Instant::now(), stage)
                });
                let result = work(&context);
                let end = Instant::now();
                (canceler.join().unwrap(), result.is_err().then_some(end))
            });
            if let Some(end) = done {
                worst = worst.max((end.saturating_duration_since(set.0), set.1.map(|stage| format!("{stage:?}"))));
            }
        }
        println!("{name}: {all:.1?}, canceled within {:.0?} ({})", worst.0, worst.1.unwrap_or_default());
    }
}

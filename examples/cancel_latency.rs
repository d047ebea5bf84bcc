//! How soon a run ends after it was canceled.
//!
//! ```text
//! cargo run --release --features bench --example cancel_latency -- TILE.laz ... DEM.tif LAYER.shp
//! ```
//!
//! Each verb is run to its end once, then canceled at 39 times that are spread evenly over that
//! duration. Printed are the duration, the longest time from a cancellation to the end of the run,
//! and the stage in which that was. Verbs whose kind of file is missing are left out; LAS and LAZ
//! files are used together.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use breakline::run::{
    self, Context, ContourOptions, DemOptions, FrameOptions, HillshadeOptions, Monitor, Notice,
    PointsRequest, Progress, Size, Source, Stage, SurfaceRequest,
};
use breakline::{Result, io};

/// How many parts the duration of a run is divided into; it is canceled between each two.
const PARTS: u32 = 40;

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

fn main() -> Result<()> {
    let files: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let of_kind = |extensions: &[&str]| -> Vec<PathBuf> {
        let is_it = |path: &&PathBuf| {
            path.extension()
                .is_some_and(|e| extensions.iter().any(|known| e.eq_ignore_ascii_case(known)))
        };
        files.iter().filter(is_it).cloned().collect()
    };
    let folder = tempfile::tempdir()?;
    let out = |name: &str| folder.path().join(name);
    let lidar = of_kind(&["las", "laz"]);
    if !lidar.is_empty() {
        let ply = out("surface.ply");
        let product = run::triangles(&request(&lidar)?, &Context::default())?;
        run::write_mesh(
            product.triangles()?,
            ply.as_path().into(),
            &Context::default(),
        )?;
        drop(product);
        measure("tin of lidar", |context| {
            let product = run::triangles(&request(&lidar)?, context)?;
            run::write_mesh(product.triangles()?, out("a.ply").as_path().into(), context).map(drop)
        })?;
        measure("dem of lidar", |context| {
            let product = run::triangles(&request(&lidar)?, context)?;
            let frame = FrameOptions {
                resolution: Some(0.2),
                ..FrameOptions::default()
            };
            let options = DemOptions {
                frame,
                ..DemOptions::default()
            };
            run::dem(&product, &options, context)?
                .write(out("a.tif").as_path().into(), context)
                .map(drop)
        })?;
        measure("points of lidar", |context| {
            let request = PointsRequest {
                files: lidar.clone(),
                ..PointsRequest::default()
            };
            run::write_points(&request, out("a.laz").as_path().into(), context).map(drop)
        })?;
        measure("contour of PLY", |context| {
            contour(&ply, &out("a.shp"), context)
        })?;
    }
    for raster in of_kind(&["tif", "tiff"]) {
        measure("contour of GeoTIFF", |context| {
            contour(&raster, &out("a.shp"), context)
        })?;
        measure("hillshade of GeoTIFF", |context| {
            let product = run::surface(&request(std::slice::from_ref(&raster))?, context)?;
            run::hillshade(&product, &HillshadeOptions::default(), context)?
                .write(out("a.tif").as_path().into(), context)
                .map(drop)
        })?;
    }
    for layer in of_kind(&["shp", "geojson"]) {
        measure("info of a layer", |context| {
            run::facts(&layer, io::points::Options::default(), context).map(drop)
        })?;
    }
    Ok(())
}

fn request(files: &[PathBuf]) -> Result<SurfaceRequest> {
    let mut request = SurfaceRequest {
        source: Source::of_files(files)?,
        ..SurfaceRequest::default()
    };
    request.systems.degrees = run::Degrees::Allow;
    Ok(request)
}

fn contour(surface: &Path, target: &Path, context: &Context) -> Result<()> {
    let product = run::surface(&request(&[surface.to_path_buf()])?, context)?;
    run::contour(&product, &ContourOptions::default(), context)?
        .write(target.into(), context)
        .map(drop)
}

/// Runs the work to its end once, then cancels it at times spread over its duration, and prints the
/// longest time from a cancellation to the end.
///
/// # Errors
/// Those of the work that is not canceled.
fn measure(name: &str, work: impl Fn(&Context) -> Result<()>) -> Result<()> {
    let start = Instant::now();
    work(&Context::default())?;
    let all = start.elapsed();
    let mut worst = (Duration::ZERO, None);
    for part in 1..PARTS {
        let (cancel, stages) = (AtomicBool::new(false), Stages::default());
        let context = Context {
            monitor: &stages,
            cancel: &cancel,
        };
        let (canceled, stage, ended) = thread::scope(|scope| {
            let canceler = scope.spawn(|| {
                thread::sleep(all * part / PARTS);
                let stage = *stages.0.lock().unwrap();
                cancel.store(true, Ordering::Relaxed);
                (Instant::now(), stage)
            });
            let result = work(&context);
            let end = Instant::now();
            let (canceled, stage) = canceler.join().unwrap();
            (canceled, stage, result.is_err().then_some(end))
        });
        // A run may end before it is canceled.
        if let Some(end) = ended {
            worst = worst.max((
                end.saturating_duration_since(canceled),
                stage.map(|stage| format!("{stage:?}")),
            ));
        }
    }
    println!(
        "{name}: {all:.1?}, canceled within {:.0?} ({})",
        worst.0,
        worst.1.unwrap_or_default()
    );
    Ok(())
}

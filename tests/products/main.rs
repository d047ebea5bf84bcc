//! The products as files: the program is run as it is typed, and what it leaves behind is read by
//! others.
//!
//! | file | law |
//! |---|---|
//! | [`order`] | the bytes depend on the set of points and lines alone |
//! | [`shapes`] | planes and cones come out as planes and circles |
//! | [`peers`] | GDAL reads everything as it is meant |
//! | [`damaged`] | a damaged file ends in a sound result or in an error, soon and in little memory |

mod damaged;
mod order;
mod peers;
mod random;
mod shapes;

use std::path::Path;
use std::time::Duration;

use assert_cmd::Command;
use tempfile::TempDir;

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_breakline"))
}

/// Runs the program in a folder, fails unless it ends well; what it said.
#[track_caller]
fn breakline(folder: &Path, args: &[&str]) -> String {
    let output = Command::new(program())
        .current_dir(folder)
        .args(args)
        .timeout(Duration::from_secs(60))
        .output()
        .expect("the program can be started");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(
        output.status.code(),
        Some(0),
        "breakline {}\n{said}",
        args.join(" ")
    );
    said
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn fixture(name: &str) -> String {
    format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Points as text, as many decimals as it takes.
fn text(points: &[[f64; 3]]) -> String {
    points
        .iter()
        .map(|[x, y, z]| format!("{x} {y} {z}\n"))
        .collect()
}

/// Lines as GeoJSON, one feature each.
fn geojson(lines: &[Vec<[f64; 3]>]) -> String {
    let features: Vec<serde_json::Value> = lines
        .iter()
        .map(|line| {
            serde_json::json!({
                "type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": line}
            })
        })
        .collect();
    let crs =
        serde_json::json!({"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}});
    serde_json::json!({"type": "FeatureCollection", "crs": crs, "features": features}).to_string()
}

//! The program as it is run, in a temporary folder.

#[path = "../common/program.rs"]
mod program;

mod accuracy;
mod columns;
mod comparisons;
mod crossings;
mod crs;
mod demo;
mod drape;
mod ground;
mod habits;
mod inputs;
mod jobs;
mod lines;
mod maps;
mod memory;
mod methods;
#[cfg(unix)]
mod outputs;
mod point_tiles;
mod profiles;
mod relief;
mod results;
mod returns;
mod runs;
mod sampling;
mod simplify;
mod systems;
mod terrain_tiles;
mod thinning;
mod usage;
mod volumes;

use program::{Run, files_of, folder_with, run_in, run_with};
use tempfile::TempDir;

/// A square of 4 x 4 points, 1 apart, on a slope.
const SLOPE: &str = "\
0 0 10\n1 0 11\n2 0 12\n3 0 13\n0 1 10\n1 1 11\n2 1 12\n3 1 13\n\
0 2 10\n1 2 11\n2 2 12\n3 2 13\n0 3 10\n1 3 11\n2 3 12\n3 3 13\n";

/// A GeoJSON layer of one geometry.
fn geojson(epsg: u32, kind: &str, coordinates: &str) -> String {
    format!(
        r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::{epsg}"}}}},
        "features":[{{"type":"Feature","properties":{{"Z":11.5}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}]}}"#
    )
}

/// The fixtures that come with the program.
fn fixture(name: &str) -> String {
    format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join(name)).unwrap()
}

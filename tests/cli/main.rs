//! The program as it is run, in a temporary folder.

mod crossings;
mod results;
mod usage;

use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

/// What came out of a run.
struct Run {
    code: i32,
    stdout: String,
    stderr: String,
}

impl Run {
    /// Fails unless the run ended with this code and said all of this on stderr.
    #[track_caller]
    fn fails(&self, code: i32, said: &[&str]) {
        assert_eq!(self.code, code, "{}", self.stderr);
        self.says(said);
        assert!(self.stderr.contains("error: "), "{}", self.stderr);
    }

    /// Fails unless the run ended well and said all of this on stderr.
    #[track_caller]
    fn works(&self, said: &[&str]) {
        assert_eq!(self.code, 0, "{}", self.stderr);
        self.says(said);
    }

    #[track_caller]
    fn says(&self, said: &[&str]) {
        for part in said {
            assert!(self.stderr.contains(part), "expected `{part}` in:\n{}", self.stderr);
        }
    }
}

fn run_in(folder: &TempDir, args: &[&str]) -> Run {
    run_with(folder, args, "")
}

fn run_with(folder: &TempDir, args: &[&str], stdin: &str) -> Run {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
    let output = command.current_dir(folder.path()).args(args).write_stdin(stdin).output().unwrap();
    Run {
        code: output.status.code().expect("the program was killed"),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A square of 4 x 4 points, 1 apart, on a slope.
const SLOPE: &str = "\
0 0 10\n1 0 11\n2 0 12\n3 0 13\n0 1 10\n1 1 11\n2 1 12\n3 1 13\n\
0 2 10\n1 2 11\n2 2 12\n3 2 13\n0 3 10\n1 3 11\n2 3 12\n3 3 13\n";

fn folder_with(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn files_of(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

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

//! The pages of `docs/jobs`: their commands run as written, on the valley of the demo and on made
//! files.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{folder_with, geojson, run_in};

/// The commands of a page: its lines that begin with four blanks and the name of the program.
fn commands(page: &str) -> Vec<Vec<&str>> {
    page.lines()
        .filter_map(|line| line.strip_prefix("    breakline "))
        .map(|command| command.split_whitespace().collect())
        .collect()
}

/// Runs the commands of a page; returns what all of them print.
pub(super) fn run_page(page: &str, folder: &TempDir) -> String {
    let commands = commands(page);
    assert!(!commands.is_empty());
    let mut printed = String::new();
    for command in commands {
        let run = run_in(folder, &command);
        assert_eq!(run.code, 0, "{command:?}:\n{}", run.stderr);
        // A page that expects a warning explains it.
        assert!(
            page.contains("warning") || !run.stderr.contains("warning: "),
            "{command:?}:\n{}",
            run.stderr
        );
        printed += &run.stdout;
    }
    printed
}

fn valley() -> TempDir {
    let folder = folder_with(&[]);
    run_in(&folder, &["demo", "."]).works(&[]);
    folder
}

fn write(folder: &TempDir, name: &str, text: &str) {
    fs::write(folder.path().join(name), text).unwrap();
}

fn size(folder: &TempDir, name: &str) -> u64 {
    fs::metadata(Path::new(folder.path()).join(name))
        .unwrap()
        .len()
}

/// Points every two meters on ground that rises to the east, with a pile of 10 m around its middle.
fn flight(height_of_pile: f64) -> String {
    let mut text = String::new();
    for i in 0..=40 {
        for j in 0..=40 {
            let [x, y] = [i, j].map(|k| 2.0 * f64::from(k));
            let away = (x - 40.0).abs().max((y - 40.0).abs());
            let pile = height_of_pile * (1.0 - away / 20.0).max(0.0);
            writeln!(text, "{x} {y} {}", 100.0 + 0.05 * x + pile).unwrap();
        }
    }
    text
}

#[test]
fn a_stockpile_from_two_flights() {
    let folder = folder_with(&[("may.xyz", &flight(4.0)), ("june.xyz", &flight(10.0))]);
    let outline = "[[15,15],[65,15],[65,65],[15,65],[15,15]]";
    write(
        &folder,
        "outline.geojson",
        &geojson(25832, "Polygon", &format!("[{outline}]")),
    );
    let printed = run_page(include_str!("../../docs/jobs/stockpile.md"), &folder);
    // A pyramid of 40 m by 40 m that grew by 6 m has 3200; its edges are off diagonals of cells.
    assert!(printed.contains("3192 m3"), "{printed}");
    assert!(size(&folder, "difference.tif") > 0);
    // A header of 100 bytes, and one polygon.
    assert!(size(&folder, "changed.shp") > 200);
}

#[test]
fn a_reservoir_by_levels() {
    let folder = valley();
    let basin =
        "[[688040,5261080],[688360,5261080],[688360,5261200],[688040,5261200],[688040,5261080]]";
    write(
        &folder,
        "basin.geojson",
        &geojson(25832, "Polygon", &format!("[{basin}]")),
    );
    let printed = run_page(include_str!("../../docs/jobs/reservoir.md"), &folder);
    assert!(printed.contains("volumes in m3"), "{printed}");
    let table = fs::read_to_string(folder.path().join("storage.csv")).unwrap();
    assert_eq!(table.lines().count(), 10);
}

#[test]
fn a_road_with_its_profile_and_sections() {
    let folder = valley();
    let axis = "[[688050,5261130],[688350,5261165]]";
    write(&folder, "axis.geojson", &geojson(25832, "LineString", axis));
    let design = "688040 5261125 804\n688040 5261133 804\n688360 5261162 806\n688360 5261170 806\n";
    write(&folder, "design.xyz", design);
    let printed = run_page(include_str!("../../docs/jobs/road.md"), &folder);
    assert!(printed.contains("0+050"), "{printed}");
    let drawing = fs::read_to_string(folder.path().join("sections.dxf")).unwrap();
    assert!(drawing.contains("POLYLINE") && drawing.trim_end().ends_with("EOF"));
}

#[test]
fn a_delivery_against_checkpoints() {
    let folder = valley();
    // A surveyor finds exactly the heights of the DEM at centers of its cells.
    let centers: String = (0..40).fold("id,x,y\n".to_owned(), |mut text, i| {
        let [x, y] = [688101 + 10 * (i % 8), 5261101 + 10 * (i / 8)];
        writeln!(text, "{i},{x},{y}").unwrap();
        text
    });
    write(&folder, "centers.csv", &centers);
    let sampled = [
        "sample",
        "ground.tif",
        "--at",
        "centers.csv",
        "-o",
        "survey.csv",
    ];
    run_in(&folder, &sampled).works(&[]);
    let survey = fs::read_to_string(folder.path().join("survey.csv")).unwrap();
    write(
        &folder,
        "survey.csv",
        &survey.replace("id,x,y,surface_z", "id,x,y,z"),
    );
    let printed = run_page(include_str!("../../docs/jobs/delivery.md"), &folder);
    assert!(printed.contains("RMSE"), "{printed}");
    assert_eq!(
        fs::read_to_string(folder.path().join("points.csv"))
            .unwrap()
            .lines()
            .count(),
        41
    );
}

#[test]
fn a_light_tin_for_a_program_of_civil_engineers() {
    let folder = valley();
    run_page(include_str!("../../docs/jobs/light-tin.md"), &folder);
    assert!(size(&folder, "light.obj") < size(&folder, "full.obj") / 3);
}

#[test]
fn where_a_slope_exceeds_one_to_three() {
    let folder = valley();
    run_page(include_str!("../../docs/jobs/steep.md"), &folder);
    assert!(size(&folder, "steep.shp") > 100);
}

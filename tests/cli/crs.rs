//! `breakline crs`: what a system is; from one to another, it needs PROJ.

use serde_json::Value;
use testkit::lidar::{las, tile};

use super::{SLOPE, files_of, folder_with, geojson, run_in};

#[test]
fn a_system_is_described_by_code_text_or_file() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        (
            "l.geojson",
            &geojson(25832, "LineString", "[[0,0,1],[1,1,2]]"),
        ),
    ]);
    let run = run_in(&folder, &["crs", "EPSG:2264+6360"]);
    run.ends(
        0,
        &[
            "EPSG:2264 (NAD83 / North Carolina (ftUS)",
            "kind       projected",
            "unit       US survey foot, 0.30480060960121924 m",
            "axes       easting, northing, height",
            "heights    EPSG:6360, US survey foot",
            "wkt        COMPD_CS[",
        ],
    );
    let run = run_in(&folder, &["crs", "EPSG:4807"]);
    run.ends(
        0,
        &[
            "grad, 0.9 degrees",
            "longitude, latitude (the authority has latitude first)",
        ],
    );
    let run = run_in(&folder, &["crs", "EPSG:25832+ellipsoid"]);
    run.ends(0, &["heights    above the ellipsoid, metre"]);
    let run = run_in(&folder, &["crs", "l.geojson"]);
    run.ends(
        0,
        &["EPSG:25832 (ETRS89 / UTM zone 32N)", "heights    none"],
    );
    std::fs::write(folder.path().join("own.prj"), LOCAL).unwrap();
    run_in(&folder, &["crs", "own.prj"]).ends(0, &["site", "kind       local"]);
    run_in(&folder, &["crs", LOCAL]).ends(0, &["site", "kind       local"]);
    // Nothing is written.
    assert_eq!(files_of(folder.path()), ["a.xyz", "l.geojson", "own.prj"]);
}

const LOCAL: &str = "LOCAL_CS[\"site\",UNIT[\"metre\",1]]";

#[test]
fn a_system_as_json_has_what_the_text_has() {
    let folder = folder_with(&[]);
    let run = run_in(&folder, &["crs", "EPSG:31468+7837", "--json"]);
    run.works(&[]);
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(found["epsg"], 31468);
    assert_eq!(found["vertical_epsg"], 7837);
    assert_eq!(found["kind"], "projected");
    assert_eq!(
        found["axes"],
        serde_json::json!(["easting", "northing", "height"])
    );
    assert_eq!(found["authority_has_northing_first"], true);
    assert_eq!(found["heights"], "vertical system");
    assert!(found["epoch"].is_null());
    assert!(found["wkt"].as_str().unwrap().starts_with("COMPD_CS["));
}

#[test]
fn a_file_of_points_states_its_system() {
    let folder = folder_with(&[]);
    for (name, code) in [("with.las", Some(25832)), ("without.las", None)] {
        std::fs::write(folder.path().join(name), las(&tile([0.0, 0.0], 2), code)).unwrap();
    }
    run_in(&folder, &["crs", "with.las"]).ends(0, &["EPSG:25832 (ETRS89 / UTM zone 32N)"]);
    run_in(&folder, &["crs", "without.las"])
        .fails(1, &["without.las", "states no coordinate system"]);
}

#[test]
fn what_is_no_system_is_refused() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.prj", "PROJCS[\"half")]);
    run_in(&folder, &["crs", "EPSG:1"]).fails(2, &["EPSG:1", "hint: "]);
    run_in(&folder, &["crs", "nowhere.las"])
        .fails(2, &["nowhere.las", "no file has this name", "hint: "]);
    run_in(&folder, &["crs", "a.xyz"]).fails(1, &["a.xyz", "states no coordinate system"]);
    run_in(&folder, &["crs", "b.prj"]).fails(1, &["b.prj"]);
    run_in(&folder, &["crs"]).fails(2, &["FROM"]);
    run_in(&folder, &["crs", "EPSG:4326", "--at", "1", "2"]).fails(2, &["TO"]);
    run_in(&folder, &["crs", "EPSG:4326", "EPSG:3857", "--at", "1"]).fails(2, &["--at"]);
    run_in(
        &folder,
        &["crs", "EPSG:4326", "EPSG:3857", "--epoch", "nan"],
    )
    .fails(2, &["--epoch"]);
}

#[cfg(not(feature = "proj"))]
#[test]
fn two_systems_need_proj() {
    let folder = folder_with(&[]);
    run_in(&folder, &["crs", "EPSG:4326", "EPSG:25832"]).fails(
        1,
        &[
            "from EPSG:4326 (WGS 84) to EPSG:25832",
            "hint: build with `cargo build --release --features proj` (needs g++, make, cmake, sqlite3)",
        ],
    );
}

#[cfg(feature = "proj")]
#[test]
fn operations_are_listed_and_a_point_is_transformed() {
    let folder = folder_with(&[]);
    let run = run_in(
        &folder,
        &["crs", "EPSG:4326", "EPSG:32633", "--at", "15.5", "47"],
    );
    run.ends(
        0,
        &[
            "from        EPSG:4326 (WGS 84), degree",
            "1, used     UTM zone 33N",
            "accurate to 0 m, EPSG:16033",
            "becomes     538012.75499",
            "proj=utm",
        ],
    );
    let run = run_in(
        &folder,
        &[
            "crs",
            "EPSG:4326",
            "EPSG:32633",
            "--json",
            "--at",
            "-10",
            "-47",
            "7",
        ],
    );
    run.works(&[]);
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(found["to"]["epsg"], 32633);
    assert_eq!(found["operations"][0]["used"], true);
    assert_eq!(found["operations"][0]["accuracy"], 0.0);
    assert_eq!(found["point"]["to"][2], 7.0);
    let run = run_in(
        &folder,
        &["crs", "EPSG:4326", "EPSG:32633", "--at", "15", "4700"],
    );
    run.fails(1, &["(15, 4700)", "EPSG:32633"]);
    run_in(&folder, &["crs", LOCAL, "EPSG:32633"]).fails(2, &["local system"]);
}

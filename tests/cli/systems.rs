//! Coordinate systems on the command line: what is refused, what is taken over, and the cures.

use super::{SLOPE, files_of, folder_with, geojson, run_in};
use testkit::lidar::{las, tile};

#[test]
fn degrees_and_geocentric_systems_are_refused_with_the_cure() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(
        &folder,
        &["tin", "a.xyz", "--a-srs", "EPSG:4326", "-o", "t.ply"],
    );
    run.fails(
        1,
        &[
            "a.xyz",
            "EPSG:4326",
            "degree",
            "hint: reproject ",
            "--force-degrees",
        ],
    );
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--a-srs",
            "EPSG:4978",
            "--force-degrees",
            "-o",
            "t.ply",
        ],
    );
    run.fails(1, &["a.xyz", "EPSG:4978", "geocentric", "hint: reproject "]);
    // A surface that is there is not reprojected.
    let flags = [
        "--a-srs",
        "EPSG:4326",
        "--max-edge",
        "none",
        "--force-degrees",
    ];
    run_in(
        &folder,
        &[&["tin", "a.xyz", "-o", "d.ply"], &flags[..]].concat(),
    )
    .works(&[]);
    let run = run_in(&folder, &["contour", "d.ply", "-o", "c.shp"]);
    run.fails(
        1,
        &[
            "d.ply",
            "EPSG:4326",
            "hint: build it from points in a projected system",
            "--force-degrees",
        ],
    );
    assert_eq!(files_of(folder.path()), ["a.xyz", "d.ply"]);
    // Nothing that is checked is a length.
    run_in(&folder, &["check", "d.ply"]).works(&[]);
    run_in(
        &folder,
        &[
            "check",
            "a.xyz",
            "--a-srs",
            "EPSG:4326",
            "--max-edge",
            "none",
        ],
    )
    .works(&[]);
}

#[test]
fn local_coordinates_in_geojson_or_under_a_placeholder_have_a_cure() {
    let local = geojson(0, "LineString", "[[0,0,1],[3,3,1]]").replace("\"crs\"", "\"other\"");
    let folder = folder_with(&[("a.xyz", SLOPE), ("l.geojson", &local)]);
    let args = ["tin", "a.xyz", "--breaklines", "l.geojson", "-o", "t.ply"];
    let run = run_in(&folder, &args);
    run.fails(
        1,
        &[
            "l.geojson",
            "EPSG:4326",
            "hint: GeoJSON without a `crs` member",
            "--a-srs EPSG:CODE",
        ],
    );
    let site = "LOCAL_CS[\"local\",UNIT[\"metre\",1]]";
    assert!(run.stderr.contains(site), "{}", run.stderr);
    assert_eq!(
        run.stderr.contains("--t-srs"),
        cfg!(feature = "proj"),
        "{}",
        run.stderr
    );
    run_in(&folder, &[&args[..], &["--a-srs", site]].concat()).works(&["local"]);

    // What ogr2ogr writes where there is no system.
    run_in(&folder, &["contour", "a.xyz", "-o", "c.shp"]).works(&[]);
    let none = "GEOGCS[\"GCS_Undefined_geographic_SRS\",DATUM[\"D_unknown\",SPHEROID[\"unknown\",6378137.0,298.257223563]],\
                PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";
    std::fs::write(folder.path().join("c.prj"), none).unwrap();
    let run = run_in(
        &folder,
        &["tin", "a.xyz", "--breaklines", "c.shp", "-o", "u.ply"],
    );
    run.works(&["note: no coordinate system is stated"]);
}

#[test]
fn two_systems_are_an_error_that_names_both_and_the_files() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        (
            "l.geojson",
            &geojson(25832, "LineString", "[[0,0,1],[1,1,1]]"),
        ),
        (
            "m.geojson",
            &geojson(25833, "LineString", "[[0,0,1],[1,1,1]]"),
        ),
    ]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--breaklines",
            "l.geojson",
            "--breaklines",
            "m.geojson",
            "-o",
            "t.ply",
        ],
    );
    run.fails(
        1,
        &[
            "l.geojson",
            "EPSG:25832",
            "m.geojson",
            "EPSG:25833",
            "hint: reproject ",
            "--a-srs",
        ],
    );
}

#[test]
fn points_are_assigned_a_system() {
    let folder = folder_with(&[]);
    let points = tile([500_000.0, 5_000_000.0], 2);
    std::fs::write(folder.path().join("a.las"), las(&points, Some(25832))).unwrap();
    std::fs::write(folder.path().join("b.las"), las(&points, None)).unwrap();
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    run("points a.las -a_srs EPSG:25833+7837 -o c.laz").works(&[
        "a.las states EPSG:25832",
        "as given by --a-srs",
        "CRS         EPSG:25833",
    ]);
    assert!(run("info c.laz").stdout.contains("EPSG:7837"));
    run("points a.las b.las -o d.las").works(&[
        "b.las states no coordinate system",
        "points      32 points of 32",
    ]);
    run("points c.laz a.las -o e.las").fails(1, &["two coordinate systems: c.laz", "--a-srs CRS"]);
    run("points a.las --a-srs EPSG:1 -o f.las").fails(2, &["--a-srs EPSG:1: "]);
    run("points b.las --t-srs EPSG:25832 -o f.las")
        .fails(1, &["b.las: the file states no coordinate system"]);
}

#[cfg(feature = "proj")]
#[test]
fn a_file_without_points_does_not_prevent_reprojecting_the_others() {
    let folder = folder_with(&[]);
    let write = |name: &str, file: &[u8]| std::fs::write(folder.path().join(name), file).unwrap();
    write(
        "a.las",
        &las(&tile([500_000.0, 5_000_000.0], 2), Some(25832)),
    );
    // The extent in the header is no box, or zero: neither is where points could be.
    let mut empty = las(&[], Some(25832));
    write("no-box.las", &empty);
    empty[179..227].fill(0);
    write("zero.las", &empty);
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    run("points a.las --t-srs EPSG:25833 -o alone.las").works(&["points      16 points of 16"]);
    for inputs in [
        "no-box.las a.las",
        "a.las no-box.las",
        "zero.las a.las",
        "a.las zero.las no-box.las",
    ] {
        run(&format!(
            "points {inputs} --t-srs EPSG:25833 -o all.las --overwrite"
        ))
        .works(&["16 points of 16"]);
        assert!(
            super::bytes(&folder, "all.las") == super::bytes(&folder, "alone.las"),
            "{inputs}"
        );
    }
    run("points zero.las --t-srs EPSG:25833 -o none.las").fails(1, &["no points in the input"]);
}

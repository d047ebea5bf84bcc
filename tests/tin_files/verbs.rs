use std::path::Path;

use super::program::{files_of, folder_with, run_in};

const FIXTURES: &str = env!("CARGO_MANIFEST_DIR");

fn fixture(name: &str) -> String {
    Path::new(FIXTURES)
        .join("fixtures")
        .join(name)
        .to_str()
        .unwrap()
        .to_owned()
}

/// Every product of a surface is, byte for byte, the same from a `.tin` as straight from the input.
fn same_products(input: &[&str]) {
    let folder = folder_with(&[]);
    let run = |args: &[&str]| run_in(&folder, args).works(&[]);
    run(&[&["tin"], input, &["-o", "x.tin", "-o", "direct.ply"]].concat());
    for (verb, options, extension) in [
        ("tin", &[][..], "ply"),
        ("tin", &[], "obj"),
        ("tin", &[], "tin"),
        ("dem", &["--resolution", "2"], "tif"),
        ("contour", &["--interval", "1"], "geojson"),
        ("contour", &["--interval", "0.5"], "shp"),
        ("hillshade", &["--resolution", "3"], "png"),
    ] {
        let [direct, by_file] =
            ["direct", "by_file"].map(|name| format!("{name}-{verb}.{extension}"));
        run(&[&[verb], input, options, &["--overwrite", "-o", &direct]].concat());
        run(&[&[verb, "x.tin"], options, &["--overwrite", "-o", &by_file]].concat());
        let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
        assert!(
            read(&direct) == read(&by_file),
            "{verb} to .{extension} of {input:?}"
        );
    }
    run_in(&folder, &["check", "x.tin"]).ends(0, &["no flaw found"]);
    let [of_tin, of_ply] =
        ["x.tin", "direct.ply"].map(|name| run_in(&folder, &["info", name]).stdout);
    assert!(of_tin.contains("TIN"), "{of_tin}");
    let facts = |text: &str| text.lines().skip(2).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(facts(&of_tin), facts(&of_ply));
}

#[test]
fn lidar() {
    same_products(&[&fixture("valley.laz")]);
}

#[test]
fn lidar_with_breaklines_clipped() {
    let [points, lines, boundary] = ["valley.laz", "breaklines.shp", "boundary.shp"].map(fixture);
    same_products(&[&points, "--breaklines", &lines, "--boundary", &boundary]);
}

#[test]
fn another_system_and_a_short_edge() {
    let [points, lines] = ["valley.laz", "breaklines.shp"].map(fixture);
    let system = "EPSG:25832+7837";
    same_products(&[
        &points,
        "--breaklines",
        &lines,
        "--a-srs",
        system,
        "--max-edge",
        "5",
        "--class",
        "2,8",
    ]);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_real_delivery() {
    let [points, lines] = ["masspntz.shp", "brklinz.shp"]
        .map(|name| testkit::shared(&format!("shp/shapelib_eg/{name}")));
    let [points, lines] = [points, lines].map(|path| path.to_str().unwrap().to_owned());
    same_products(&[&points, "--breaklines", &lines, "--max-edge", "none"]);
}

#[test]
fn a_damaged_file_is_an_error_and_leaves_no_output() {
    let folder = folder_with(&[]);
    run_in(&folder, &["tin", &fixture("valley.laz"), "-o", "x.tin"]).works(&[]);
    let path = folder.path().join("x.tin");
    let mut bytes = std::fs::read(&path).unwrap();
    // Of a vertex in the middle, the height.
    let vertices = u64::from_le_bytes(bytes[24..32].try_into().unwrap()) as usize;
    let at = 48 + 24 * (vertices / 2) + 16;
    bytes[at..at + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    std::fs::write(&path, &bytes).unwrap();
    let said = [
        &format!("x.tin: vertex {} is damaged", vertices / 2)[..],
        "breakline check x.tin",
    ];
    for (verb, output) in [
        ("dem", "a.tif"),
        ("contour", "a.shp"),
        ("hillshade", "a.png"),
        ("tin", "a.ply"),
        ("tin", "a.stl"),
    ] {
        run_in(&folder, &[verb, "x.tin", "-o", output]).fails(1, &said);
        assert_eq!(files_of(folder.path()), ["x.tin"], "{verb}");
    }
    run_in(&folder, &["check", "x.tin"]).fails(1, &said);

    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    for args in [
        &["dem", "x.tin", "-o", "a.tif"][..],
        &["info", "x.tin"],
        &["check", "x.tin"],
    ] {
        run_in(&folder, args).fails(
            1,
            &[
                "x.tin: ",
                "bytes where",
                "write the file again with `breakline tin`",
            ],
        );
    }
    std::fs::write(&path, "TIN of another program").unwrap();
    run_in(&folder, &["dem", "x.tin", "-o", "a.tif"]).fails(1, &["wrong magic bytes"]);
}

#[test]
fn a_tin_is_known_by_its_bytes_too() {
    let folder = folder_with(&[]);
    run_in(&folder, &["tin", &fixture("valley.laz"), "-o", "x.tin"]).works(&[]);
    std::fs::rename(folder.path().join("x.tin"), folder.path().join("x.ply")).unwrap();
    run_in(&folder, &["dem", "x.ply", "-o", "a.tif"]).works(&[]);
    run_in(&folder, &["tin", "x.ply", "-o", "x.ply", "--overwrite"])
        .fails(2, &["the output is one of the inputs"]);
}

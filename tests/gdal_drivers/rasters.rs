//! Rasters by drivers of GDAL.

use breakline::data::Grid;
use breakline::io::gdal::open_raster;
use tempfile::TempDir;

use super::program::files_of;
use super::{gdalinfo, run_verb, surface};

/// Drivers that store heights exactly, with their position and their coordinate system (some in a
/// file beside), and the name of an output.
const EXACT: &[(&str, &str)] = &[
    ("AAIGrid", "a.asc"),
    ("BAG", "a.bag"),
    ("BT", "a.bt"),
    ("EHdr", "a.bil"),
    ("ENVI", "a.dat"),
    ("ERS", "a.ers"),
    ("GPKG", "a.gpkg"),
    ("GS7BG", "a.grd"),
    ("GSAG", "a.grd"),
    ("GSBG", "a.grd"),
    ("GTiff", "a.tif"),
    ("HFA", "a.img"),
    ("KRO", "a.kro"),
    ("PCRaster", "a.map"),
    ("R", "a.rda"),
    ("RRASTER", "a.grd"),
    ("SAGA", "a.sdat"),
    ("SIGDEM", "a.sigdem"),
    ("netCDF", "a.nc"),
];

/// Drivers that store the system in words of their own, or not at all.
const OTHER_SYSTEM: &[(&str, &str)] = &[
    ("GRIB", "a.grb2"),
    ("ILWIS", "a.mpr"),
    ("PCIDSK", "a.pix"),
    ("RST", "a.rst"),
    ("XYZ", "a.xyz"),
    ("ZMap", "a.zmap"),
    ("Zarr", "a.zarr"),
];

fn read(folder: &TempDir, name: &str) -> Grid {
    open_raster(folder.path().join(name))
        .unwrap()
        .read_grid()
        .unwrap()
}

fn written_by(driver: &str, name: &str) -> TempDir {
    let folder = surface();
    let run = run_verb(&folder, &["dem"], &["-of", driver, "-o", name, "-q"]);
    assert_eq!(run.code, 0, "{driver}: {}", run.stderr);
    let is_known = run.stderr.is_empty() || run.stderr.contains("without its coordinate system");
    assert!(is_known, "{driver}: {}", run.stderr);
    folder
}

#[test]
fn heights_of_every_driver_are_those_of_ours() {
    let ours = read(&written_by("GTiff", "a.tif"), "a.tif");
    assert_eq!([ours.frame.width, ours.frame.height], [6, 5]);
    assert!(ours.values.iter().any(|value| value.is_nan()));
    for (driver, name) in EXACT.iter().chain(OTHER_SYSTEM) {
        let folder = written_by(driver, name);
        let theirs = read(&folder, name);
        assert_eq!(theirs.frame, ours.frame, "{driver}");
        let bits = |grid: &Grid| {
            grid.values
                .iter()
                .map(|v| v.to_bits())
                .collect::<Vec<u64>>()
        };
        assert_eq!(bits(&theirs), bits(&ours), "{driver}");
        let judged = gdalinfo(&folder, name);
        assert_eq!(judged["size"], serde_json::json!([6, 5]), "{driver}");
        let highest = judged["bands"][0]["maximum"].as_f64().unwrap();
        assert!((highest - 117.125).abs() < 0.01, "{driver}: {judged}");
        let system = judged["coordinateSystem"]["wkt"]
            .as_str()
            .unwrap_or_default();
        let is_known = system.contains("32N") || system.contains("zone 32");
        let is_exact = EXACT.iter().any(|(own, _)| own == driver);
        assert!(is_known || !is_exact, "{driver}: {system}");
    }
}

#[test]
fn what_a_driver_changes_is_said_or_refused() {
    let folder = surface();
    // 16 bits for all between nodata and the highest.
    run_verb(&folder, &["dem"], &["-of", "NWT_GRD", "-o", "a.grd"]).fails(
        2,
        &[
            "a.grd: the driver NWT_GRD changes values by up to ",
            "write a GeoTIFF",
        ],
    );
    assert_eq!(files_of(folder.path()), ["points.xyz"]);
    run_verb(&folder, &["dem"], &["-of", "VICAR", "-o", "a.vic"]).works(&[
        "without its coordinate system and its position: the driver VICAR keeps none",
        "cells without a value (1) have one: the driver VICAR has no mark for them",
    ]);
    run_verb(&folder, &["dem"], &["-of", "HF2", "-o", "a.hf2"])
        .works(&["values differ by up to 0.0"]);
}

#[test]
fn a_compound_system_stays_compound() {
    for name in ["a.bt", "a.img", "a.nc", "a.sdat", "a.tif"] {
        let folder = surface();
        let args = [
            "dem",
            "points.xyz",
            "--a-srs",
            "EPSG:25832+7837",
            "-o",
            name,
        ];
        super::run_in(&folder, &args).works(&[]);
        let judged = gdalinfo(&folder, name);
        let system = judged["coordinateSystem"]["wkt"].as_str().unwrap();
        assert!(system.contains("COMPOUNDCRS"), "{name}: {system}");
    }
}

#[test]
fn the_extension_selects_the_driver() {
    for (name, driver) in [
        ("a.img", "HFA"),
        ("a.nc", "netCDF"),
        ("a.sdat", "SAGA"),
        ("a.bil", "EHdr"),
    ] {
        let folder = surface();
        run_verb(&folder, &["dem"], &["-o", name]).works(&["written"]);
        assert_eq!(gdalinfo(&folder, name)["driverShortName"], driver);
    }
    // Ours where both know it.
    let folder = surface();
    run_verb(&folder, &["dem"], &["-o", "a.asc", "-o", "a.img"]).works(&["written"]);
    let text = std::fs::read_to_string(folder.path().join("a.asc")).unwrap();
    assert!(text.starts_with("ncols"));
    // Several drivers write it.
    run_verb(&folder, &["dem"], &["-o", "a.grd"])
        .fails(2, &["GSAG, GSBG, GS7BG", "hint: choose one: --of"]);
    run_verb(&folder, &["dem"], &["-o", "a.nothing"]).fails(2, &["`.nothing` is not a format"]);
}

#[test]
fn heights_are_rounded_only_with_a_warning() {
    let folder = surface();
    run_verb(&folder, &["dem"], &["-of", "USGSDEM", "-o", "a.dem"])
        .works(&["heights are rounded: the driver USGSDEM stores whole numbers"]);
    run_verb(&folder, &["dem"], &["-of", "LAN", "-o", "a.lan"])
        .works(&["heights are rounded: the driver LAN stores whole numbers"]);
    let ours = read(&written_by("GTiff", "a.tif"), "a.tif");
    for (a, b) in ours.values.iter().zip(&read(&folder, "a.lan").values) {
        assert!(a.is_nan() || (a - b).abs() <= 0.5, "{a} {b}");
    }
}

#[test]
fn heights_are_not_squeezed_into_bytes() {
    for (driver, name) in [
        ("JPEG", "a.jpg"),
        ("GIF", "a.gif"),
        ("PNG", "a.png"),
        ("BMP", "a.bmp"),
    ] {
        let folder = surface();
        run_verb(&folder, &["dem"], &["-of", driver, "-o", name]).fails(
            2,
            &[
                &format!("the driver {driver} stores "),
                "heights, which have fractions",
            ],
        );
        assert_eq!(files_of(folder.path()), ["points.xyz"]);
    }
}

#[test]
fn shades_and_colors_have_bytes() {
    let folder = surface();
    run_verb(&folder, &["hillshade"], &["-o", "s.tif"]).works(&[]);
    let ours = read(&folder, "s.tif");
    for (driver, name) in [
        ("BMP", "s.bmp"),
        ("GIF", "s.gif"),
        ("HFA", "s.img"),
        ("PNM", "s.pgm"),
        ("AAIGrid", "s.asc"),
        ("netCDF", "s.nc"),
    ] {
        run_verb(&folder, &["hillshade"], &["-of", driver, "-o", name]).works(&[]);
        let theirs = read(&folder, name);
        for (a, b) in ours.values.iter().zip(&theirs.values) {
            assert!(
                a == b || a.is_nan() && (b.is_nan() || *b == 0.0),
                "{driver}: {a} {b}"
            );
        }
    }
    for (driver, name) in [
        ("HFA", "c.img"),
        ("ENVI", "c.dat"),
        ("PCIDSK", "c.pix"),
        ("GPKG", "c.gpkg"),
    ] {
        run_verb(&folder, &["color-relief"], &["-of", driver, "-o", name]).works(&[]);
        let bands = gdalinfo(&folder, name)["bands"].as_array().unwrap().len();
        assert_eq!(bands, 4, "{driver}");
    }
    // One band is not four.
    run_verb(
        &folder,
        &["color-relief"],
        &["-of", "AAIGrid", "-o", "c.asc"],
    )
    .fails(1, &["AAIG driver doesn't support 4 bands"]);
    run_verb(&folder, &["slope"], &["-of", "HFA", "-o", "slope.img"]).works(&["slope"]);
}

#[test]
fn all_files_of_a_driver_appear_and_nothing_else() {
    let folder = surface();
    run_verb(
        &folder,
        &["dem"],
        &["-of", "ENVI", "-o", "a.dat", "-o", "b.dat"],
    )
    .works(&["written     a.dat"]);
    let all = [
        "a.dat",
        "a.dat.aux.xml",
        "a.hdr",
        "b.dat",
        "b.dat.aux.xml",
        "b.hdr",
        "points.xyz",
    ];
    let found = files_of(folder.path());
    assert!(
        found.iter().all(|name| all.contains(&name.as_str())),
        "{found:?}"
    );
    assert!(
        ["a.dat", "a.hdr", "b.dat", "b.hdr"]
            .iter()
            .all(|name| found.iter().any(|own| own == name))
    );
    // What is beside it stays, unless it may be replaced.
    let hdr = folder.path().join("c.hdr");
    std::fs::write(&hdr, "mine").unwrap();
    run_verb(&folder, &["dem"], &["-of", "ENVI", "-o", "c.dat"])
        .fails(1, &["c.hdr: the file exists", "--overwrite"]);
    assert_eq!(std::fs::read(&hdr).unwrap(), b"mine");
    assert!(!folder.path().join("c.dat").exists());
    run_verb(
        &folder,
        &["dem"],
        &["-of", "ENVI", "-o", "c.dat", "--overwrite"],
    )
    .works(&[]);
    assert_ne!(std::fs::read(&hdr).unwrap(), b"mine");
    // Two outputs that would have one file.
    run_verb(
        &folder,
        &["dem"],
        &["-of", "ENVI", "-o", "d.dat", "-o", "d.raw"],
    )
    .fails(
        2,
        &["d.hdr: another output of this run writes this file, too"],
    );
    assert!(
        !files_of(folder.path())
            .iter()
            .any(|name| name.starts_with("d."))
    );
    assert!(
        !files_of(folder.path())
            .iter()
            .any(|name| name.starts_with(".breakline"))
    );
}

#[test]
fn what_is_written_to_a_pipe_is_the_file() {
    let folder = surface();
    run_verb(&folder, &["dem"], &["-of", "AAIGrid", "-o", "a.asc"]).works(&[]);
    let stream = run_verb(
        &folder,
        &["dem"],
        &["-of", "GSAG", "-o", "/dev/stdout", "-q"],
    );
    assert_eq!(
        (stream.code, &stream.stdout[..4]),
        (0, "DSAA"),
        "{}",
        stream.stderr
    );
}

#[test]
fn a_raster_that_refers_to_others_is_refused() {
    let folder = surface();
    run_verb(&folder, &["dem"], &["-of", "VRT", "-o", "a.vrt"])
        .fails(2, &["VRT", "refers to another file"]);
    run_verb(&folder, &["dem"], &["-of", "MEM", "-o", "a.mem"]).fails(2, &["MEM", "keeps nothing"]);
    assert_eq!(files_of(folder.path()), ["points.xyz"]);
}

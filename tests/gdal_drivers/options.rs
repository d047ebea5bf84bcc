//! Names of drivers and their options.

use super::program::files_of;
use super::{gdalinfo, run_verb, surface};

#[test]
fn creation_options_reach_the_driver() {
    let folder = surface();
    let size = |name: &str| std::fs::metadata(folder.path().join(name)).unwrap().len();
    let options = ["--resolution", "0.02"];
    run_verb(
        &folder,
        &["dem"],
        &[&options[..], &["-o", "a.img"]].concat(),
    )
    .works(&[]);
    run_verb(
        &folder,
        &["dem"],
        &[&options[..], &["-co", "COMPRESSED=YES", "-o", "b.img"]].concat(),
    )
    .works(&[]);
    assert!(size("b.img") < size("a.img"));
    run_verb(&folder, &["dem"], &["-of", "AAIGrid", "-o", "x.asc"]).works(&[]);
    run_verb(
        &folder,
        &["hillshade"],
        &[
            "--of=GPKG",
            "--co=TILE_FORMAT=PNG",
            "--co",
            "RASTER_TABLE=shades",
            "-o",
            "s.gpkg",
        ],
    )
    .works(&[]);
    let judged = gdalinfo(&folder, "s.gpkg");
    assert_eq!(judged["metadata"][""]["IDENTIFIER"], "shades");
    run_verb(
        &folder,
        &["contour"],
        &["-o", "c.csv", "-lco", "GEOMETRY=AS_WKT"],
    )
    .works(&[]);
    let text = std::fs::read_to_string(folder.path().join("c.csv")).unwrap();
    assert!(text.contains("LINESTRING Z ("), "{text}");
}

#[test]
fn misspelled_options_are_errors_with_the_nearest_name() {
    let folder = surface();
    for (args, said) in [
        (
            &["-co", "COMPRESED=YES", "-o", "a.img"][..],
            [
                "--co COMPRESED=YES: the driver HFA has no option COMPRESED",
                "did you mean COMPRESSED?",
            ],
        ),
        (
            &["-of", "HFa", "-co", "COMPRESSED", "-o", "a.img"],
            [
                "--co COMPRESSED: not an option and its value",
                "write --co NAME=VALUE",
            ],
        ),
        (
            &["-of", "HFB", "-o", "a.img"],
            ["GDAL has no driver HFB (--of)", "did you mean "],
        ),
        (
            &["-of", "KML", "-o", "a.kml"],
            [
                "the driver KML of GDAL does not write rasters",
                "choose another one: --of",
            ],
        ),
        (
            &["-co", "COMPRESS=LZW", "-o", "a.tif"],
            [
                "a.tif: --co COMPRESS=LZW: this format is not written by GDAL",
                "a GeoTIFF is tiled",
            ],
        ),
        (
            &["-of", "AAIGrid", "-o", "a.tif"],
            [
                "--of AAIGrid: the extension of the output is that of another format, .tif",
                "the extension .asc",
            ],
        ),
        (
            &["-lco", "A=B", "-o", "a.img"],
            ["--lco A=B: the driver HFA has no option A", "leave it out"],
        ),
    ] {
        run_verb(&folder, &["dem"], args).fails(2, &said);
    }
    run_verb(&folder, &["contour"], &["-of", "HFA", "-o", "a.img"])
        .fails(2, &["the driver HFA of GDAL does not write vector layers"]);
    run_verb(&folder, &["contour"], &["-o", "a.mif", "-lco", "BOUND=1"])
        .fails(2, &["did you mean BOUNDS?"]);
    assert_eq!(files_of(folder.path()), ["points.xyz"]);
}

#[test]
fn what_describes_our_own_formats_is_accepted() {
    let folder = surface();
    run_verb(
        &folder,
        &["dem"],
        &[
            "-of",
            "GTiff",
            "-co",
            "TILED=YES",
            "-co",
            "compress=deflate",
            "-o",
            "a.tif",
        ],
    )
    .works(&[]);
    run_verb(&folder, &["dem"], &["-of", "COG", "-o", "b.tif"]).works(&[]);
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.tif"), read("b.tif"));
    // Whatever the name is.
    run_verb(&folder, &["dem"], &["-of", "GTiff", "-o", "c.raster"]).works(&[]);
    assert_eq!(read("a.tif"), read("c.raster"));
    run_verb(
        &folder,
        &["contour"],
        &["-of", "GeoJSON", "-o", "c.geojson"],
    )
    .works(&[]);
    run_verb(&folder, &["contour"], &["-o", "d.geojson"]).works(&[]);
    assert_eq!(read("c.geojson"), read("d.geojson"));
}

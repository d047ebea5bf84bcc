//! What users of other programs type, and what of it works.

use super::{SLOPE, bytes, files_of, folder_with, run_in};

#[test]
fn words_of_gdal_and_lastools_give_the_same_files() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    run("dem a.xyz --resolution 0.5 --te 0 0 2 2 --a-srs EPSG:25832 --class 2 -o ours.tif")
        .works(&[]);
    run("tin a.xyz -o ours.ply").works(&[]);
    for (i, line) in [
        "las2dem -i a.xyz -step 0.5 -te 0 0 2 2 -a_srs EPSG:25832 -keep_class 2 -o",
        "dem -tr 0.5 0.5 -te 0 0 2 2 -of GTiff -co TILED=YES -a_srs EPSG:25832 --class ground a.xyz",
        "dem a.xyz --resolution 0.5 0.5 --te=0,0,2,2 --s-srs EPSG:25832 --output",
    ]
    .into_iter()
    .enumerate()
    {
        run(&format!("{line} {i}.tif")).works(&[&format!("written     {i}.tif")]);
        assert_eq!(bytes(&folder, &format!("{i}.tif")), bytes(&folder, "ours.tif"), "{line}");
    }
    run("tin a.xyz theirs.ply").works(&["written     theirs.ply"]);
    assert_eq!(bytes(&folder, "theirs.ply"), bytes(&folder, "ours.ply"));
    run("tin -overwrite a.xyz -o theirs.ply").works(&["written     theirs.ply"]);
    run("gdal_contour -i 0.5 ours.tif c.shp").works(&["written     c.shp"]);
}

#[test]
fn what_cannot_be_done_names_what_can() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.ply", "mine")]);
    let before = files_of(folder.path());
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    for (line, hint) in [
        (
            "dem -tr 0.5 1 a.xyz -o d.tif",
            "hint: --resolution 0.5, or --resolution 1",
        ),
        (
            "tin -te 0 0 1 1 a.xyz -o t.ply",
            "hint: --bounds XMIN,YMIN,XMAX,YMAX clips the surface",
        ),
        (
            "dem -of AAIGrid a.xyz -o d.tif",
            "hint: leave out --of, or give the output the extension .asc",
        ),
        ("tin -of PLY a.xyz -o t.obj", "hint: leave -of out"),
        (
            "dem -co COMPRESS=LZW a.xyz -o d.tif",
            "hint: leave it out: a GeoTIFF is tiled",
        ),
        (
            "lasclip -i a.xyz -poly b.shp",
            "hint: `breakline points IN --boundary AREA.shp",
        ),
        (
            "lasthin -i a.xyz -step 1 -o b.xyz",
            "hint: `breakline points IN --thin grid:1 --thin-keep lowest",
        ),
        (
            "las2las -i a.xyz -keep_every_nth 2 -o b.xyz",
            "hint: --thin nth:N keeps the first of every N points",
        ),
        ("foo -tr 1 2 a.xyz", "unrecognized subcommand 'foo'"),
        (
            "contour a.xyz -smooth 5 -o c.shp",
            "hint: --smooth TOLERANCE keeps lines this near to the surface",
        ),
        (
            "contour a.xyz -p -amin LOW -o c.shp",
            "hint: --bands has the fields ELEV_MIN and ELEV_MAX",
        ),
        (
            "tin a.xyz -p -o t.ply",
            "hint: switches of Triangle are for `breakline triangulate`",
        ),
        (
            "color-relief a.xyz -of PNG -o c.tif",
            "--of PNG: the extension of the output is that of another format, .tif",
        ),
        ("a.xyz", "hint: `breakline info a.xyz` shows what is in it"),
        (
            "tin a.xyz b.ply",
            "hint: to replace b.ply, which exists: -o b.ply --overwrite",
        ),
        (
            "triangulate -tr 1 1 a.poly -o t.ele",
            "an option of this program has two dashes",
        ),
        ("tin a.xyz -o t.ply --class gras", "`gras` is not a class"),
    ] {
        run(line).fails(2, &["error: ", hint]);
    }
    assert_eq!(files_of(folder.path()), before);
}

#[test]
#[cfg(not(feature = "gdal"))]
fn what_needs_gdal_says_so() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    for line in [
        "dem -of HFA a.xyz -o d.img",
        "dem -of HFA -co COMPRESSED=YES a.xyz -o d.tif",
        "contour a.xyz -o PG:dbname=gis:lines",
        "contour a.xyz -co A=B -o c.kml",
        "tin a.xyz --breaklines /vsizip/a.zip/b.shp:Z -o t.ply",
        "tin a.xyz --breaklines PG:dbname=gis:lines -o t.ply",
        "hillshade /vsicurl/http://127.0.0.1/a.tif -o s.tif",
        "info NETCDF:a.nc:z",
    ] {
        let said = [
            "GDAL, without which this program was built",
            "hint: build with `cargo build --release --features gdal`",
        ];
        run(line).fails(1, &said);
    }
    let run = run("tin a.xyz --breaklines PG:dbname=gis,password=s3cret -o t.ply");
    run.fails(1, &["password=***"]);
    assert!(!run.stderr.contains("s3cret"));
    assert_eq!(files_of(folder.path()), ["a.xyz"]);
}

//! Real deliveries in tiles.

use super::output_of;

/// Fails unless the words give the same file with and without tiles. Paths are those of the shared
/// data.
#[track_caller]
fn assert_same(verb: &str, files: &[&str], words: &str, tiles: &str) {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<String> = files
        .iter()
        .map(|file| testkit::shared(file).to_str().unwrap().to_owned())
        .collect();
    let words = words.replace(
        '@',
        &format!("{}/", testkit::shared("lidar").to_str().unwrap()),
    );
    let words = format!("{verb} {} {words}", files.join(" "));
    let extension = if verb == "contour" { "geojson" } else { "tif" };
    let (whole, _) = output_of(&folder, &words, &format!("whole.{extension}"));
    let (tiled, said) = output_of(
        &folder,
        &format!("{words} --tiles {tiles}"),
        &format!("tiled.{extension}"),
    );
    assert!(
        tiled == whole && said.contains("tiles       "),
        "{words}: {said}"
    );
}

const SURVEY: &[&str] = &[
    "lidar/bcts/bcts_1.laz",
    "lidar/bcts/bcts_2.laz",
    "lidar/bcts/bcts_3.laz",
    "lidar/bcts/bcts_4.laz",
];

const TOWN: &[&str] = &[
    "lidar/delft_ahn3_bgt/ahn3_cropped_1.laz",
    "lidar/delft_ahn3_bgt/ahn3_cropped_2.laz",
];

const LINES_OF_TOWN: &str = "--breaklines @delft_ahn3_bgt/breaklines_z_derived.shp";

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn four_tiles_of_a_survey() {
    assert_same("dem", SURVEY, "--resolution 0.5", "8x8");
    assert_same("contour", SURVEY, "", "3x20");
    assert_same("dem", SURVEY, "--max-edge auto", "6x6");
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_town_with_breaklines() {
    assert_same("dem", TOWN, LINES_OF_TOWN, "16x16");
    assert_same("contour", TOWN, LINES_OF_TOWN, "5x5");
    let auto = format!("{LINES_OF_TOWN} --max-edge auto");
    assert_same("contour", TOWN, &auto, "5x5");
}

#[cfg(feature = "proj")]
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn surveys_in_another_system() {
    assert_same("dem", SURVEY, "--t-srs EPSG:26910", "6x6");
    let systems = "--a-srs EPSG:28992 --t-srs EPSG:25831 --max-edge auto";
    let words = format!("{LINES_OF_TOWN} {systems}");
    assert_same("contour", TOWN, &words, "5x5");
}

/// Bounds that cut breaklines, and a boundary.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_part_of_a_town() {
    let part = format!("{LINES_OF_TOWN} --bounds 84850.1,447450.3,84960.7,447600.9");
    assert_same("dem", TOWN, &format!("{part} --resolution 0.25"), "9x7");
    assert_same("contour", TOWN, &format!("{part} --interval 0.25"), "4x11");
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_lake_that_is_level() {
    let water = "--flat @lake_breakline/lake_breakline.shp --flat-height 2733.95 --flat-buffer 1";
    assert_same("dem", &["lidar/lake_breakline/lake.laz"], water, "9x7");
    assert_same(
        "contour",
        &["lidar/lake_breakline/lake.laz"],
        &format!("{water} --interval 0.5"),
        "4x4",
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_national_tile() {
    let lines = "--breaklines @ign_0292_6833/Lignes_3d_0292_6833.geojson";
    assert_same(
        "dem",
        &["lidar/ign_0292_6833/test_semis_2023_0292_6833_LA93_IGN69.laz"],
        lines,
        "10x10",
    );
}

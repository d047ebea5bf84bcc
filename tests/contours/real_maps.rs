//! Contours for maps of real deliveries, judged exactly: lidar with and without lines, and rasters.

use breakline::data::{ContourLine, Surface};
use breakline::terrain::{
    GridSurface, LabelRules, Levels, MapContours, MapLine, MapRules, contour_labels, map_contours,
};
use testkit::shared;

use super::map_judge::{Ground, boxes_meet, check_crossings, doubled_area};
use super::real::tin;

/// Checks all that is promised of the lines, bands and labels of a surface, with the preset.
fn check(name: &str, surface: &dyn Surface, interval: f64) {
    let rules = MapRules {
        with_bands: true,
        ..MapRules::cartographic(interval)
    };
    let levels = Levels::every(interval, 0.0).unwrap();
    let found = map_contours(surface, &levels, &rules).unwrap();
    let lines: Vec<ContourLine> = found.lines.iter().map(|of| of.line.clone()).collect();
    check_crossings(&lines);
    let ground = Ground::new(surface);
    let off = lines.iter().map(|line| ground.deviation(line));
    let most = off.fold(0.0, f64::max);
    assert!(most <= 0.5 * interval, "{name}: {most} off the surface");
    let rounding = 1e-7 * interval;
    assert!(
        (most - found.deviation).abs() <= rounding,
        "{name}: {most} is not {}",
        found.deviation
    );
    check_area(name, surface, &found);
    let is_index = |line: &MapLine| line.number % 5 == 0;
    let labels = contour_labels(&found.lines, is_index, &LabelRules::of_interval(interval));
    for (i, label) in labels.iter().enumerate() {
        assert!(-90.0 < label.rotation && label.rotation <= 90.0);
        let meets = |other| boxes_meet(label, other);
        assert!(!labels[..i].iter().any(meets), "{name}: labels overlap");
    }
    eprintln!(
        "{name}: {} of {} lines, {} segments, none meet; {most} off at most; {} bands; {} labels",
        lines.len(),
        found.traced,
        lines
            .iter()
            .map(|line| line.points.len() - 1)
            .sum::<usize>(),
        found.bands.len(),
        labels.len()
    );
}

/// The bands have the area of the surface.
fn check_area(name: &str, surface: &dyn Surface, found: &MapContours) {
    let rings = found.bands.iter().flat_map(|band| &band.rings);
    let of_bands: f64 = rings.map(|ring| -doubled_area(ring)).sum();
    let triangles = (0..surface.face_count() as u32).filter_map(|face| surface.triangle(face));
    let of_triangle = |t: [[f64; 3]; 3]| doubled_area(&[0, 1, 2, 0].map(|i| [t[i][0], t[i][1]]));
    let whole: f64 = triangles.map(of_triangle).sum();
    assert!(
        (of_bands - whole).abs() <= 1e-9 * whole,
        "{name}: {of_bands} of {whole}"
    );
}

fn check_raster(path: &str, interval: f64) {
    let reader = breakline::io::raster::open(shared(path)).unwrap();
    let grid = reader.read_grid().unwrap();
    check(path, &GridSurface::new(&grid).unwrap(), interval);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_lake_with_its_shore() {
    let line = Some("lidar/lake_breakline/lake_breakline.shp");
    let lake = tin(&["lidar/lake_breakline/lake.laz"], line);
    check("lake", &lake, 1.0);
}

/// Heights are whole meters, many of them levels.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_raster_of_whole_heights() {
    check_raster("dem/zh_dem_25.tif", 20.0);
}

#[test]
#[ignore = "takes minutes, and needs ../shared"]
fn large_deliveries() {
    let tiles = ["1", "2", "3", "4"].map(|tile| format!("lidar/bcts/bcts_{tile}.laz"));
    check(
        "bcts",
        &tin(&tiles.each_ref().map(|tile| &tile[..]), None),
        1.0,
    );
    check("ign", &tin(&[IGN], None), 1.0);
    check(
        "delft",
        &tin(&["lidar/delft_ahn3_bgt/ahn3_cropped_1.laz"], None),
        0.5,
    );
    check_raster("dem/bigtujunga.tif", 50.0);
}

const IGN: &str = "lidar/ign_0292_6833/test_semis_2023_0292_6833_LA93_IGN69.laz";

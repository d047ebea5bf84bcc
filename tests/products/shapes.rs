//! Surfaces that are known: what comes out of the files is the plane, the cone and the input's own
//! heights.

use std::f64::consts::TAU;
use std::fs::File;
use std::path::Path;

use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use crate::random::Random;
use crate::{breakline, folder, text};

/// A contour as it stands in a file.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    level: f64,
    points: Vec<[f64; 3]>,
}

impl Line {
    fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }

    /// Twice the area within, above zero if the line turns left.
    fn double_area(&self) -> f64 {
        let [x0, y0, _] = self.points[0];
        let cross =
            |a: &[f64; 3], b: &[f64; 3]| (a[0] - x0) * (b[1] - y0) - (b[0] - x0) * (a[1] - y0);
        self.points
            .windows(2)
            .map(|pair| cross(&pair[0], &pair[1]))
            .sum()
    }
}

/// The contours of a shapefile, read by the crate `shapefile`, and of a GeoJSON file, which are the
/// same.
fn contours(shp: &Path, geojson: &Path) -> Vec<Line> {
    let mut from_shp = Vec::new();
    for pair in shapefile::Reader::from_path(shp)
        .unwrap()
        .iter_shapes_and_records_as::<shapefile::PolylineZ, _>()
    {
        let (line, row): (shapefile::PolylineZ, shapefile::dbase::Record) = pair.unwrap();
        let Some(shapefile::dbase::FieldValue::Numeric(Some(level))) = row.get("ELEV") else {
            panic!("{row:?}")
        };
        assert_eq!(line.parts().len(), 1);
        from_shp.push(Line {
            level: *level,
            points: line.parts()[0].iter().map(|p| [p.x, p.y, p.z]).collect(),
        });
    }
    let layer: serde_json::Value =
        serde_json::from_slice(&std::fs::read(geojson).unwrap()).unwrap();
    let from_geojson: Vec<Line> = layer["features"]
        .as_array()
        .unwrap()
        .iter()
        .map(feature)
        .collect();
    assert_eq!(from_shp, from_geojson);
    for line in &from_shp {
        assert!(
            line.points.len() > 1 && line.points.iter().all(|p| p[2] == line.level),
            "{line:?}"
        );
    }
    from_shp
}

fn feature(feature: &serde_json::Value) -> Line {
    let points = feature["geometry"]["coordinates"]
        .as_array()
        .unwrap()
        .iter();
    let points = points
        .map(|p| std::array::from_fn(|i| p[i].as_f64().unwrap()))
        .collect();
    Line {
        level: feature["properties"]["ELEV"].as_f64().unwrap(),
        points,
    }
}

/// A raster as the crate `tiff` reads it: size, corner in the north-west, cells row by row.
fn raster(path: &Path) -> ([usize; 2], [f64; 2], Vec<f32>) {
    let mut decoder = Decoder::new(File::open(path).unwrap()).unwrap();
    let tie = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap();
    assert_eq!(tie[..3], [0.0; 3]);
    let (width, height) = decoder.dimensions().unwrap();
    let DecodingResult::F32(cells) = decoder.read_image().unwrap() else {
        panic!("not Float32")
    };
    ([width as usize, height as usize], [tie[3], tie[4]], cells)
}

const RINGS: usize = 20;
const SPOKES: usize = 64;

/// A cone of rings a metre apart, 64 points each; each ring is one metre lower, or higher, than the
/// one within.
fn cone(center: [f64; 2], slope: f64) -> Vec<[f64; 3]> {
    let mut points = vec![[center[0], center[1], 100.0]];
    for ring in 1..=RINGS {
        for spoke in 0..SPOKES {
            let (sine, cosine) = (TAU * spoke as f64 / SPOKES as f64).sin_cos();
            let radius = ring as f64;
            points.push([
                center[0] + radius * cosine,
                center[1] + radius * sine,
                100.0 + slope * radius,
            ]);
        }
    }
    points
}

fn contours_of(points: &[[f64; 3]], options: &[&str]) -> Vec<Line> {
    let work = folder();
    std::fs::write(work.path().join("a.xyz"), text(points)).unwrap();
    let outputs = ["contour", "a.xyz", "-o", "c.shp", "-o", "c.geojson"];
    breakline(work.path(), &[&outputs[..], options].concat());
    contours(&work.path().join("c.shp"), &work.path().join("c.geojson"))
}

/// Far from the origin, where a coordinate is known to 1e-9.
const CENTER: [f64; 2] = [500_000.5, 5_400_000.25];

/// Every other level runs through points, the others half way between the rings.
#[test]
fn contours_of_a_cone_are_circles() {
    let half_angle = TAU / SPOKES as f64 / 2.0;
    for slope in [-1.0, 1.0] {
        let lines = contours_of(&cone(CENTER, slope), &["--interval", "0.5"]);
        // From half a metre of radius to that of the last ring but one, and half way to the last.
        let mut radii: Vec<f64> = lines
            .iter()
            .map(|line| (line.level - 100.0) * slope)
            .collect();
        radii.sort_by(f64::total_cmp);
        let wanted: Vec<f64> = (1..2 * RINGS).map(|i| i as f64 / 2.0).collect();
        assert_eq!(radii, wanted, "slope {slope}");
        for line in &lines {
            let radius = (line.level - 100.0) * slope;
            assert!(line.is_closed(), "radius {radius}");
            let distances: Vec<f64> = line
                .points
                .iter()
                .map(|p| (p[0] - CENTER[0]).hypot(p[1] - CENTER[1]))
                .collect();
            let on_ring = distances
                .iter()
                .filter(|d| (**d - radius).abs() < 1e-6)
                .count()
                - 1;
            assert_eq!(on_ring, SPOKES, "radius {radius}: {distances:?}");
            // Between two spokes a level between rings meets the diagonal of the quadrangle, in its
            // middle.
            let others: Vec<f64> = distances
                .iter()
                .copied()
                .filter(|d| (d - radius).abs() >= 1e-6)
                .collect();
            if radius.fract() == 0.0 || radius < 1.0 {
                assert!(others.is_empty(), "radius {radius}: {others:?}");
            } else {
                let (inner, outer) = (radius - 0.5, radius + 0.5);
                let middle = (inner * inner
                    + outer * outer
                    + 2.0 * inner * outer * (2.0 * half_angle).cos())
                .sqrt()
                    / 2.0;
                assert_eq!(others.len(), SPOKES, "radius {radius}");
                assert!(
                    others.iter().all(|d| (d - middle).abs() < 1e-6),
                    "radius {radius}: {others:?}, not {middle}"
                );
            }
            // Chords do not cut off more than they must.
            let nearest = line.points.windows(2).map(|pair| {
                let middle: [f64; 2] =
                    std::array::from_fn(|i| (pair[0][i] + pair[1][i]) / 2.0 - CENTER[i]);
                middle[0].hypot(middle[1])
            });
            let sagitta = radius - nearest.fold(f64::INFINITY, f64::min);
            assert!(
                sagitta < radius * (1.0 - half_angle.cos()) + 1e-6,
                "radius {radius}: {sagitta}"
            );
            // High ground on the right: a hill is gone round clockwise, a hollow counter-clockwise.
            assert!(
                line.double_area() * slope > 0.0,
                "radius {radius}, slope {slope}"
            );
        }
    }
}

/// z = x / 4 + y / 8 + 100 from the corner, without rounding.
fn plane(x: f64, y: f64) -> f64 {
    (x - 500_000.0) / 4.0 + (y - 5_400_000.0) / 8.0 + 100.0
}

/// Points of a plane in eighths of a metre, with the corners of a rectangle of 40 m x 30 m.
fn plane_points() -> Vec<[f64; 3]> {
    let mut random = Random(3);
    let mut positions = vec![[0, 0], [320, 0], [0, 240], [320, 240]];
    positions.extend((0..2000).map(|_| [random.below(321), random.below(241)]));
    let at = |[i, j]: [usize; 2]| (500_000.0 + i as f64 / 8.0, 5_400_000.0 + j as f64 / 8.0);
    positions
        .into_iter()
        .map(at)
        .map(|(x, y)| [x, y, plane(x, y)])
        .collect()
}

#[test]
fn the_dem_of_a_plane_is_the_plane() {
    let work = folder();
    std::fs::write(work.path().join("a.xyz"), text(&plane_points())).unwrap();
    // By default the thinnest triangles at the edges of the rectangle are left out.
    breakline(
        work.path(),
        &[
            "dem",
            "a.xyz",
            "--max-edge",
            "100",
            "--resolution",
            "0.25",
            "-o",
            "d.tif",
        ],
    );
    let ([width, height], [west, north], cells) = raster(&work.path().join("d.tif"));
    assert_eq!(
        ([width, height], [west, north]),
        ([160, 120], [500_000.0, 5_400_030.0])
    );
    for (i, cell) in cells.into_iter().enumerate() {
        let x = west + 0.25 * ((i % width) as f64 + 0.5);
        let y = north - 0.25 * ((i / width) as f64 + 0.5);
        // A multiple of 1/64 below 128 is a float: only its rounding could make a difference.
        assert_eq!(cell, plane(x, y) as f32, "at {x} {y}");
    }
}

#[test]
fn cells_on_points_have_their_heights_and_a_ply_gives_the_same_bytes() {
    let mut random = Random(5);
    let mut points = Vec::new();
    for i in 0..50 {
        for j in 0..40 {
            let z = 200.0 + random.below(4096) as f64 / 64.0;
            if random.below(3) > 0 || i % 49 == 0 || j % 39 == 0 {
                points.push([500_000.5 + f64::from(i), 5_400_000.5 + f64::from(j), z]);
            } else {
                let off = |random: &mut Random| random.below(100) as f64 / 100.0;
                points.push([
                    500_000.0 + f64::from(i) + off(&mut random),
                    5_400_000.0 + f64::from(j),
                    z,
                ]);
            }
        }
    }
    let work = folder();
    std::fs::write(work.path().join("a.xyz"), text(&points)).unwrap();
    let run = |args: &[&str]| breakline(work.path(), args);
    run(&["dem", "a.xyz", "-o", "d.tif"]);
    let ([width, height], [west, north], cells) = raster(&work.path().join("d.tif"));
    assert_eq!(
        ([width, height], [west, north]),
        ([50, 40], [500_000.0, 5_400_040.0])
    );
    let mut met = 0;
    for [x, y, z] in points {
        let (column, row) = (x - west - 0.5, north - y - 0.5);
        if column.fract() == 0.0 && row.fract() == 0.0 {
            met += 1;
            assert_eq!(
                f64::from(cells[row as usize * width + column as usize]),
                z,
                "at {x} {y}"
            );
        }
    }
    assert!(met > 1300, "{met} points at centers");

    run(&["tin", "a.xyz", "-o", "t.ply"]);
    run(&["tin", "a.xyz", "-o", "t.obj"]);
    for (mesh, kind) in [("t.ply", "ply"), ("t.obj", "obj")] {
        let name = |extension: &str| format!("{kind}.{extension}");
        run(&["dem", mesh, "-o", &name("tif")]);
        run(&["contour", mesh, "-o", &name("shp")]);
        run(&["hillshade", mesh, "-o", &name("png")]);
    }
    run(&["contour", "a.xyz", "-o", "d.shp"]);
    run(&["hillshade", "a.xyz", "-o", "d.png"]);
    let read = |name: &str| std::fs::read(work.path().join(name)).unwrap();
    for kind in ["ply", "obj"] {
        for extension in ["tif", "shp", "shx", "dbf", "png"] {
            let name = format!("{kind}.{extension}");
            assert!(read(&name) == read(&format!("d.{extension}")), "{name}");
        }
    }
}

/// Both are straight lines from edge to edge: the TIN ends at its outermost points, the DEM at its
/// outermost centers.
#[test]
fn contours_of_a_plane_agree_whether_from_the_tin_or_from_the_dem() {
    let work = folder();
    std::fs::write(work.path().join("a.xyz"), text(&plane_points())).unwrap();
    let run = |args: &[&str]| breakline(work.path(), args);
    let whole = ["tin", "a.xyz", "--max-edge", "100", "-o", "a.ply"];
    run(&whole);
    run(&["dem", "a.ply", "--resolution", "0.5", "-o", "d.tif"]);
    for (input, inset) in [("a.ply", 0.0), ("d.tif", 0.25)] {
        // Levels that miss the corners.
        let options = [
            "--base",
            "0.3",
            "--interval",
            "0.5",
            "-o",
            "c.shp",
            "-o",
            "c.geojson",
            "--overwrite",
        ];
        run(&[&["contour", input], &options[..]].concat());
        let lines = contours(&work.path().join("c.shp"), &work.path().join("c.geojson"));
        let (low, high) = (
            [500_000.0 + inset, 5_400_000.0 + inset],
            [500_040.0 - inset, 5_400_030.0 - inset],
        );
        let (bottom, top) = (plane(low[0], low[1]), plane(high[0], high[1]));
        let mut levels: Vec<f64> = lines.iter().map(|line| line.level).collect();
        levels.sort_by(f64::total_cmp);
        let all = (0..400)
            .map(|i| 0.3 + 0.5 * f64::from(i))
            .filter(|level| bottom < *level && *level < top);
        let wanted: Vec<f64> = all.collect();
        assert_eq!(levels.len(), wanted.len(), "{input}");
        assert!(
            levels
                .iter()
                .zip(&wanted)
                .all(|(a, b)| (a - b).abs() < 1e-9),
            "{input}: {levels:?}"
        );
        for line in lines {
            for [x, y, z] in &line.points {
                // A float keeps heights around 100 to 4e-6, and 1 m of height is 4 m of plan.
                assert!((plane(*x, *y) - z).abs() < 1e-5, "{input}: {x} {y} {z}");
            }
            // High ground lies to the north-east, on the right of who goes from the south-east to
            // the north-west.
            let rise = 8.0 * (line.level - 100.0);
            let on_west = [low[0], 5_400_000.0 + rise - 2.0 * (low[0] - 500_000.0)];
            let on_north = [500_000.0 + (rise - (high[1] - 5_400_000.0)) / 2.0, high[1]];
            let on_south = [500_000.0 + (rise - (low[1] - 5_400_000.0)) / 2.0, low[1]];
            let on_east = [high[0], 5_400_000.0 + rise - 2.0 * (high[0] - 500_000.0)];
            let start = if on_south[0] <= high[0] {
                on_south
            } else {
                on_east
            };
            let end = if on_west[1] <= high[1] {
                on_west
            } else {
                on_north
            };
            let ends = [line.points[0], line.points[line.points.len() - 1]];
            for (found, wanted) in ends.iter().zip([start, end]) {
                let off = (found[0] - wanted[0]).hypot(found[1] - wanted[1]);
                assert!(
                    off < 1e-4,
                    "{input}, level {}: {found:?}, not {wanted:?}",
                    line.level
                );
            }
        }
    }
}

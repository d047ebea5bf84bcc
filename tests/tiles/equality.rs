//! The same bytes as in one piece.

use testkit::random::Random;

use super::{assert_parts_are_whole, bytes, landscape, layer, output_of, program, valley};
use program::{files_of, run_in};
use testkit::lidar;

/// Fails unless the verb with these words gives the same file with and without each of the options
/// of tiles.
#[track_caller]
fn assert_same(folder: &tempfile::TempDir, words: &str, tilings: &[&str]) -> Vec<u8> {
    let (whole, _) = output_of(folder, words, "whole.tif");
    for tiling in tilings {
        let (tiled, said) = output_of(folder, &format!("{words} {tiling}"), "tiled.tif");
        assert!(tiled == whole, "{words} {tiling}: {said}");
        assert!(said.contains("tiles       "), "{said}");
    }
    assert!(
        !files_of(folder.path())
            .iter()
            .any(|name| name.ends_with(".job")),
        "a job is left"
    );
    whole
}

#[test]
fn the_valley_in_tiles_is_the_valley() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let all = [
        "--tiles 1x1",
        "--tiles 4x4",
        "--tiles 1x30",
        "--tiles 11x7",
        "--memory 16MB --tiles auto",
    ];
    assert_same(&folder, &format!("dem {valley}"), &all);
    let few = ["--tiles 5x3"];
    // Triangles that wait for the rim: few, many, all; and none.
    for max_edge in ["20", "3", "0.5", "none"] {
        let words = format!("dem {valley} --max-edge {max_edge} --resolution 0.7");
        assert_same(&folder, &words, &few);
    }
    assert_same(
        &folder,
        &format!("dem {valley} --max-edge-inside 4 --max-edge 9"),
        &few,
    );
    assert_same(
        &folder,
        &format!("dem {valley} --class 2,5 --duplicates highest --resolution 0.3"),
        &few,
    );
    let part = "--te 688100.3,5261050,688300,5261222.2 --resolution 0.9";
    assert_same(&folder, &format!("dem {valley} {part}"), &few);
    assert_same(&folder, &format!("hillshade {valley} --azimuth 200"), &few);
    assert_same(
        &folder,
        &format!("hillshade {valley} --shading combined"),
        &few,
    );
    // Colors by the range of all cells.
    assert_same(
        &folder,
        &format!("color-relief {valley} --ramp viridis"),
        &few,
    );
    for quantity in [
        "slope --percent",
        "aspect",
        "curvature --formula plan",
        "tri",
        "slope --formula faces",
        "aspect --formula faces",
    ] {
        let (verb, options) = quantity.split_once(' ').unwrap_or((quantity, ""));
        assert_same(
            &folder,
            &format!("{verb} {valley} --resolution 2 {options}"),
            &few,
        );
    }
    output_of(
        &folder,
        &format!("dem {valley} --resolution 2.5"),
        "grid.tif",
    );
    assert_same(&folder, &format!("dem {valley} --align-to grid.tif"), &few);
}

#[test]
fn contours_in_tiles_are_those_of_the_valley() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    for (words, tiling) in [
        ("--interval 1", "--tiles 4x4"),
        ("--interval 0.25 --max-edge 3", "--tiles 1x30"),
        (
            "--levels 800,812.35,844 --class 2,5 --duplicates highest",
            "--tiles 9x9",
        ),
    ] {
        let words = format!("contour {valley} {words}");
        for extension in ["geojson", "shp"] {
            let (whole, _) = output_of(&folder, &words, &format!("whole.{extension}"));
            let (tiled, said) = output_of(
                &folder,
                &format!("{words} {tiling}"),
                &format!("tiled.{extension}"),
            );
            assert!(
                tiled == whole && said.contains("tiles       "),
                "{words}: {said}"
            );
        }
    }
}

/// Heights are smoothed across seams, regions join there, and lines are followed over them.
#[test]
fn contours_for_maps_in_tiles_are_those_of_one_piece() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(108);
    let height = |x: f64, y: f64| {
        let waves = 4.0 * (x / 17.0).sin() + 3.0 * (y / 13.0).cos();
        (100.0 * (waves + 0.02 * x)).round() / 100.0
    };
    let edge: Vec<[f64; 3]> = (0..36)
        .map(|i| {
            let [x, y] = [10.0 + 5.0 * f64::from(i), 70.0 + 10.0 * f64::from(i % 3)];
            [x, y, height(x, y)]
        })
        .collect();
    let lines = layer(&[edge], "LineString");
    std::fs::write(folder.path().join("edge.geojson"), lines).unwrap();
    let points: String = (0..6000)
        .map(|_| {
            let [x, y] = [200.0, 160.0].map(|side| (side * random.unit() * 4.0).round() / 4.0);
            format!("{x} {y} {:.2}\n", height(x, y) + 0.2 * random.unit())
        })
        .collect();
    std::fs::write(folder.path().join("points.xyz"), points).unwrap();
    let files = "points.xyz --breaklines edge.geojson --max-edge 30 --labels-output labels.geojson";
    for options in [
        "--preset cartographic",
        "--preset cartographic --bands --min-length 15 --keep-depressions",
        "--smooth 0.25 --min-area 10",
        "--simplify 0.2 --index-every 2 --labels uphill",
        "--min-length 20",
        "--min-area 40 --bands",
        "--bands",
        "--index-every 5",
    ] {
        let words = format!("contour {files} --interval 1 --label-height 1 {options}");
        let whole = output_of(&folder, &words, "whole.geojson").0;
        let labels = || bytes(folder.path().join("labels.geojson"));
        let labels_of_whole = labels();
        for tiling in ["--tiles 8x8", "--tiles 1x5"] {
            let tiled = format!("{words} {tiling}");
            let (tiled, said) = output_of(&folder, &tiled, "tiled.geojson");
            assert!(tiled == whole, "{options} {tiling}: {said}");
            assert!(said.contains("tiles       "), "{said}");
            assert!(labels() == labels_of_whole, "labels: {options} {tiling}");
        }
    }
    let left = files_of(folder.path());
    assert!(!left.iter().any(|name| name.ends_with(".job")), "{left:?}");
}

/// Integer coordinates, where ties are the rule: many points share a site, files overlap, tiles are
/// one point thick or empty, cuts pass through points.
#[test]
fn grids_in_overlapping_files_are_the_same_in_any_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(31);
    for round in 0..12 {
        let side = [4, 9, 30][round % 3];
        let mut names = Vec::new();
        for file in 0..1 + round % 4 {
            let count = 3 + random.below(side * side);
            let mut point = || {
                [
                    random.below(side) as f64,
                    random.below(side) as f64,
                    random.below(5) as f64,
                ]
            };
            let points: Vec<([f64; 3], u8)> = (0..count).map(|_| (point(), 2)).collect();
            let name = format!("{file}.las");
            std::fs::write(folder.path().join(&name), lidar::las(&points, Some(25832))).unwrap();
            names.push(name);
        }
        let rule = ["lowest", "highest", "mean", "first", "last"][round % 5];
        let edge = ["none", "2", "1.5"][round % 3];
        let words = format!(
            "dem {} --duplicates {rule} --resolution 0.25 --max-edge {edge}",
            names.join(" ")
        );
        let [columns, rows] = [1 + random.below(side + 2), 1 + random.below(side + 2)];
        if run_in(
            &folder,
            &words
                .split(' ')
                .chain(["-o", "try.tif", "--overwrite"])
                .collect::<Vec<_>>(),
        )
        .code
            == 0
        {
            let tiles = format!("--tiles {columns}x{rows}");
            assert_same(&folder, &words, &[&tiles]);
            // Centers on edges and vertices, between tiles, too: one of the faces there counts.
            let verb = ["slope --percent", "aspect"][round % 2];
            let of_faces = words.replace("dem ", &format!("{verb} --formula faces "));
            assert_same(&folder, &of_faces, &[&tiles]);
            // Heights that are levels: plateaus, ridges, saddles.
            let words = words
                .replace("dem ", "contour ")
                .replace("--resolution 0.25", "--interval 1");
            let (whole, _) = output_of(&folder, &words, "whole.geojson");
            let (tiled, _) = output_of(&folder, &format!("{words} {tiles}"), "tiled.geojson");
            assert!(tiled == whole, "{words} {tiles}");
        }
    }
}

#[test]
fn breaklines_in_tiles_are_those_of_the_valley() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let lines = valley.replace("valley.laz", "breaklines.shp");
    let tilings = [
        "--tiles 1x1",
        "--tiles 4x4",
        "--tiles 17x9",
        "--tiles auto --memory 16MB",
    ];
    assert_same(
        &folder,
        &format!("dem {valley} --breaklines {lines} --resolution 0.7"),
        &tilings,
    );
    let words = format!("dem {valley} --soft-lines {lines} --max-edge 2.5 --max-edge-inside 2");
    assert_same(&folder, &words, &["--tiles 6x6"]);
    let words = format!("contour {valley} --breaklines {lines} --interval 0.5");
    let (whole, _) = output_of(&folder, &words, "whole.geojson");
    let (tiled, said) = output_of(&folder, &format!("{words} --tiles 5x8"), "tiled.geojson");
    assert!(tiled == whole && said.contains("lines       "), "{said}");
}

/// Lines of all kinds on grids: they cross, overlap, touch points and run along cuts; water
/// replaces points, and levels lines.
#[test]
fn lines_of_all_kinds_are_the_same_in_any_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(37);
    let mut built = 0;
    for round in 0..rounds() {
        let side = [6, 12, 30][round % 3];
        let mut point = || [0, 1, 2].map(|_| random.below(side) as f64);
        let points: Vec<([f64; 3], u8)> = (0..10 + 7 * (round % 9)).map(|_| (point(), 2)).collect();
        std::fs::write(
            folder.path().join("points.las"),
            lidar::las(&points, Some(25832)),
        )
        .unwrap();
        let mut words = "dem points.las --resolution 0.25".to_owned();
        for (kind, count) in [
            ("breaklines", 1 + round % 5),
            ("soft-lines", round % 3),
            ("walls", usize::from(round % 7 == 0)),
        ] {
            let lines: Vec<Vec<[f64; 3]>> = (0..count)
                .map(|_| {
                    (0..2 + random.index(3))
                        .map(|_| [0, 1, 2].map(|_| random.below(side) as f64))
                        .collect()
                })
                .collect();
            if count > 0 {
                std::fs::write(
                    folder.path().join(format!("{kind}.geojson")),
                    layer(&lines, "LineString"),
                )
                .unwrap();
                words += &format!(" --{kind} {kind}.geojson");
            }
        }
        if words.contains("--walls") {
            words += " --wall-drop 2";
        }
        if round % 3 == 2 {
            // They cross each other, and overlap the lake.
            let lines: Vec<Vec<[f64; 3]>> = (0..2 + round % 2)
                .map(|_| {
                    (0..2 + random.index(2))
                        .map(|_| [0, 1, 2].map(|_| random.below(side) as f64))
                        .collect()
                })
                .filter(|line: &Vec<[f64; 3]>| {
                    line.windows(2).any(|pair| pair[0][..2] != pair[1][..2])
                })
                .collect();
            std::fs::write(
                folder.path().join("rivers.geojson"),
                layer(&lines, "LineString"),
            )
            .unwrap();
            words += " --rivers rivers.geojson --river-width 1.5";
        }
        if round % 4 == 1 {
            let [x, y, z] = [0, 1, 2].map(|_| random.below(side) as f64);
            let lake = vec![
                [x, y, z],
                [x + 3.0, y, z],
                [x + 4.0, y + 3.0, z],
                [x, y + 2.0, z],
                [x, y, z],
            ];
            std::fs::write(
                folder.path().join("lake.geojson"),
                layer(&[lake], "Polygon"),
            )
            .unwrap();
            words += " --flat lake.geojson";
        }
        words += [" --max-edge none", " --max-edge 2.5", ""][round % 3];
        let words: Vec<&str> = words.split(' ').collect();
        let whole = run_in(
            &folder,
            &[&words[..], &["-o", "whole.tif", "--overwrite"]].concat(),
        );
        if whole.code != 0 {
            continue;
        }
        built += 1;
        let tiles = format!("{}x{}", 1 + random.below(side), 1 + random.below(side));
        let tiled = run_in(
            &folder,
            &[
                &words[..],
                &["--tiles", &tiles, "-o", "tiled.tif", "--overwrite"],
            ]
            .concat(),
        );
        assert_eq!(
            tiled.code, 0,
            "round {round}: {words:?} {tiles}: {}",
            tiled.stderr
        );
        let same = std::fs::read(folder.path().join("whole.tif")).unwrap()
            == std::fs::read(folder.path().join("tiled.tif")).unwrap();
        assert!(same, "round {round}: {words:?} {tiles}");
    }
    assert!(built * 2 > rounds(), "{built}");
}

/// Water that reaches beyond the points ends at their rim, which no tile knows by itself.
#[test]
fn waters_end_at_the_same_rim_in_any_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let lake = |x: f64, y: f64, size: f64, z: f64| {
        let corner = |dx: f64, dy: f64| [x + dx * size, y + dy * size, z];
        vec![
            corner(0.0, 0.0),
            corner(1.0, 0.2),
            corner(0.9, 1.1),
            corner(-0.1, 0.8),
            corner(0.0, 0.0),
        ]
    };
    let lakes = [
        lake(687_900.0, 5_261_000.0, 180.0, 801.0),
        lake(688_380.0, 5_261_280.0, 300.0, 803.0),
        lake(688_200.0, 5_261_100.0, 40.0, 802.0),
        lake(689_900.0, 5_261_100.0, 40.0, 802.0),
    ];
    let river = vec![
        [687_000.0, 5_261_130.0, 830.0],
        [688_250.0, 5_261_230.0, 825.0],
        [690_000.0, 5_261_190.0, 801.0],
    ];
    let file = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    file("lakes.geojson", layer(&lakes, "Polygon"));
    file("river.geojson", layer(&[river], "LineString"));
    for (words, tiling) in [
        ("--flat lakes.geojson", "--tiles 4x4"),
        ("--flat lakes.geojson --max-edge none", "--tiles 3x7"),
        ("--flat lakes.geojson --max-edge 3 --class 2", "--tiles 9x2"),
        (
            "--rivers river.geojson --river-width 9 --flat lakes.geojson --max-edge 5",
            "--tiles 5x5",
        ),
    ] {
        let words = format!("dem {valley} {words} --resolution 0.9");
        let (whole, said) = output_of(&folder, &words, "whole.tif");
        assert!(
            said.contains("at the rim that the surface has without water"),
            "{said}"
        );
        let (tiled, said) = output_of(&folder, &format!("{words} {tiling}"), "tiled.tif");
        assert!(tiled == whole, "{words} {tiling}: {said}");
        assert!(
            said.contains("at the rim that the surface has without water"),
            "{said}"
        );
    }
}

/// Surfaces that are cut: the lines cross tiles, cuts and seams, and run beyond the points.
#[test]
fn clipped_surfaces_are_the_same_in_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let [lines, boundary] =
        ["breaklines.shp", "boundary.shp"].map(|name| valley.replace("valley.laz", name));
    let bounds = "--bounds 688100.3,5261050.2,688300.7,5261222.9";
    for (words, tiles) in [
        (format!("--boundary {boundary} --resolution 0.7"), "4x4"),
        (format!("{bounds} --resolution 0.5"), "auto"),
        (
            format!("{bounds} --boundary {boundary} --breaklines {lines} --max-edge 3"),
            "7x5",
        ),
        (
            format!("--holes {boundary} --soft-lines {lines} --max-edge-inside 3"),
            "5x5",
        ),
        (format!("--draped-lines {lines} {bounds}"), "3x9"),
    ] {
        for verb in ["dem", "aspect --formula faces"] {
            assert_same(
                &folder,
                &format!("{verb} {valley} {words}"),
                &[&format!("--tiles {tiles}")],
            );
        }
    }
    for words in [
        format!("--boundary {boundary}"),
        format!("{bounds} --draped-lines {lines}"),
    ] {
        let words = format!("contour {valley} {words} --interval 0.5");
        let (whole, _) = output_of(&folder, &words, "whole.geojson");
        let (tiled, _) = output_of(&folder, &format!("{words} --tiles 6x4"), "tiled.geojson");
        assert!(tiled == whole, "{words}");
    }
    let nothing = format!("dem {valley} --bounds 0,0,1,1 --resolution 1 --tiles 2x2 -o out.tif");
    run_in(&folder, &nothing.split(' ').collect::<Vec<_>>())
        .fails(1, &["lie outside of the bounds\n"]);
}

/// The number of sets of lines, which the environment sets: `BREAKLINE_JOBS=2000 cargo test
/// --release --test tiles`.
fn rounds() -> usize {
    std::env::var("BREAKLINE_JOBS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(30)
}

#[test]
fn files_that_are_tiles_are_not_divided() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let mut names = Vec::new();
    for (name, bounds) in [
        ("a.laz", "688000,5261000,688199.999,5261149.999"),
        ("b.laz", "688200,5261000,688500,5261149.999"),
        ("c.laz", "688000,5261150,688500,5261400"),
    ] {
        output_of(&folder, &format!("points {valley} --bounds {bounds}"), name);
        names.push(name);
    }
    let files = names.join(" ");
    let (whole, _) = output_of(&folder, &format!("dem {valley}"), "whole.tif");
    let (tiled, said) = output_of(&folder, &format!("dem {files} --tiles auto"), "tiled.tif");
    assert!(
        tiled == whole && said.contains("tiles       3 (the files)"),
        "{said}"
    );
    // Files that touch may both have points there.
    output_of(
        &folder,
        &format!("points {valley} --bounds 688000,5261000,688200,5261150"),
        "a.laz",
    );
    output_of(
        &folder,
        &format!("points {valley} --bounds 688100,5261000,688500,5261150"),
        "b.laz",
    );
    let (tiled, said) = output_of(&folder, &format!("dem {files} --tiles auto"), "tiled.tif");
    assert!(tiled == whole && said.contains("divided first"), "{said}");
    // Text states neither number nor extent.
    output_of(&folder, &format!("points {valley} --class 2"), "ground.xyz");
    let (tiled, _) = output_of(
        &folder,
        "dem ground.xyz --a-srs EPSG:25832 --tiles 3x3",
        "tiled.tif",
    );
    let (whole, _) = output_of(&folder, "dem ground.xyz --a-srs EPSG:25832", "whole.tif");
    assert!(tiled == whole);
}

/// Rows of points with this corner and size, in steps of 1.
fn rows([x, y]: [u32; 2], [width, height]: [u32; 2]) -> String {
    let at = |i: u32| [x + i % width, y + i / width];
    let row = |[x, y]: [u32; 2]| format!("{x} {y} {}\n", f64::from(x * x % 97 + y * 7 % 31) / 8.0);
    (0..width * height).map(at).map(row).collect()
}

/// Three sides of a rectangle: what is between them is left out, as it is wider than the limit.
#[test]
fn a_limit_that_follows_from_the_points_is_that_of_one_piece() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("left.xyz", &rows([0, 0], [10, 300]));
    write("right.xyz", &rows([150, 0], [10, 300]));
    write("below.xyz", &rows([10, 0], [140, 3]));
    let line = vec![[5.0, 5.0, 9.0], [80.5, 1.0, 4.0], [155.0, 290.0, 2.0]];
    write("line.geojson", &layer(&[line], "LineString"));
    let ring = [
        [4.0, 200.0],
        [156.0, 200.0],
        [156.0, 230.0],
        [4.0, 230.0],
        [4.0, 200.0],
    ];
    let ring = ring.map(|[x, y]| [x, y, 3.0]).to_vec();
    write("ring.geojson", &layer(&[ring], "Polygon"));
    let files = "left.xyz right.xyz below.xyz --a-srs EPSG:25832";
    for words in [
        "",
        "--breaklines line.geojson",
        "--flat ring.geojson",
        "--boundary ring.geojson",
        "--bounds 3.2,50,157,250.5",
    ] {
        let words = format!("dem {files} {words}");
        let auto = format!("{words} --max-edge auto");
        let dem = assert_same(&folder, &auto, &["--tiles 7x5", "--tiles auto"]);
        let (all, _) = output_of(&folder, &format!("{words} --max-edge none"), "all.tif");
        assert!(dem != all, "{words}");
    }
    // 100 times the mean distance, which is 0.939 by the boxes of the files and their points.
    let limit = "edges over 94 m ";
    let words = format!("contour {files} --max-edge auto");
    let (whole, said) = output_of(&folder, &words, "whole.geojson");
    assert!(said.contains(limit), "{said}");
    let (tiled, said) = output_of(&folder, &format!("{words} --tiles 3x4"), "tiled.geojson");
    assert!(tiled == whole && said.contains(limit), "{said}");
    let part = format!("{words} --bounds 3.2,50,157,250.5");
    let (_, said) = output_of(&folder, &part, "part.geojson");
    assert!(said.contains(limit), "{said}");
    assert_parts_are_whole(&folder, &format!("{files} --max-edge auto"));
}

/// A window of a delivery that would not fit into memory: what is far from it is not read.
#[test]
fn files_far_from_the_bounds_do_not_make_tiles_necessary() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, [x, y]: [u32; 2], side: u32| {
        let at = |i: u32| [x + i % side, y + i / side].map(f64::from);
        let points: Vec<([f64; 3], u8)> = (0..side * side)
            .map(at)
            .map(|[x, y]| ([x, y, (x * 0.3).sin() + (y * 0.2).cos()], 2))
            .collect();
        std::fs::write(folder.path().join(name), lidar::las(&points, Some(25832))).unwrap();
    };
    write("a.las", [0, 0], 60);
    write("b.las", [5000, 0], 260);
    write("c.las", [0, 8000], 260);
    write("d.las", [5000, 8000], 260);
    let ring = [[20.0, 20.0], [30.0, 20.0], [30.0, 30.0], [20.0, 20.0]];
    let ring = ring.map(|[x, y]| [x, y, 3.0]).to_vec();
    let lake = layer(&[ring], "Polygon");
    std::fs::write(folder.path().join("lake.geojson"), lake).unwrap();
    let in_tiles = "tiles       ";
    let words = "dem a.las b.las c.las d.las --resolution 2";
    let bounds = "--bounds 10,10,50.5,50";
    let little = "--memory 16MB";
    let (part, said) = output_of(&folder, &format!("{words} {bounds} {little}"), "part.tif");
    assert!(
        !said.contains(in_tiles) && said.contains("3 of 4"),
        "{said}"
    );
    let (tiled, said) = output_of(
        &folder,
        &format!("{words} {bounds} --tiles 3x3"),
        "tiled.tif",
    );
    assert!(tiled == part && said.contains(in_tiles), "{said}");
    // All points are needed: there are no bounds, or where water ends may depend on any.
    for more in ["", "--bounds 10,10,50.5,50 --flat lake.geojson"] {
        let (_, said) = output_of(&folder, &format!("{words} {more} {little}"), "all.tif");
        assert!(said.contains(in_tiles), "{said}");
    }
}

/// Two million points in little memory.
#[test]
fn two_million_points_take_the_memory_that_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    landscape::write(&folder.path().join("in"), 2_000_000, 8).unwrap();
    let (tiled, said) = output_of(
        &folder,
        "dem in/*.laz --memory 64MB --threads 2",
        "tiled.tif",
    );
    assert!(said.contains("tiles       64 (the files)"), "{said}");
    let peak = said
        .split("peak memory ")
        .nth(1)
        .and_then(|text| text.split(" MB").next());
    let peak: f64 = peak.unwrap().parse().unwrap();
    assert!(peak < 100.0, "{said}");
    let (whole, _) = output_of(&folder, "dem in/*.laz --memory 10GB", "whole.tif");
    assert!(tiled == whole);
}

#[test]
fn what_tiles_do_not_have_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let lines = valley.replace("valley.laz", "breaklines.shp");
    for (words, said) in [
        (
            format!("{valley} --crossing-report a.csv"),
            "--crossing-report does not work with tiles yet",
        ),
        (
            format!("{valley} --method natural"),
            "tiles have linear heights only",
        ),
        (
            format!("{valley} --flat {lines} --max-edge-inside 3"),
            "--max-edge-inside together with --flat",
        ),
        ("-".to_owned(), "tiles are made of files"),
    ] {
        let words = format!("dem {words} --tiles 2x2 -o out.tif");
        run_in(&folder, &words.split(' ').collect::<Vec<_>>())
            .fails(if said.contains("made of") { 2 } else { 1 }, &[said]);
    }
    for (words, said) in [
        ("--bounds 5,5,1,1", "the bounds go from"),
        ("--boundary fixtures", "cannot"),
    ] {
        let words = format!("dem {valley} {words} --tiles 2x2 -o out.tif");
        let run = run_in(&folder, &words.split(' ').collect::<Vec<_>>());
        assert!(run.code != 0, "{said}: {}", run.stderr);
    }
    assert!(files_of(folder.path()).is_empty());
}

//! TINs in parts: the triangles of the whole, and one surface for all verbs.

use std::collections::BTreeSet;
use std::path::Path;

use breakline::data::{EdgeKind, Surface};
use breakline::io::mesh;
use breakline::run::{self, Context, Source, SurfaceRequest};
use breakline::terrain::Method;
use tempfile::TempDir;
use testkit::random::Random;

use super::program::{files_of, run_in};
use super::{bytes, layer, output_of, valley};
use testkit::lidar;

/// The triangles of a PLY, each from its smallest corner on, with the kinds of its edges.
fn triangles(path: &Path) -> BTreeSet<([[u64; 3]; 3], [u8; 3])> {
    let mesh = mesh::read(path).unwrap();
    let of_face = |face: u32| {
        let corners = mesh.triangle(face).unwrap().map(|p| p.map(f64::to_bits));
        // What is at the rim follows from the triangles.
        let kind = |i| {
            Some(mesh.edge_kind(face, i))
                .filter(|kind| kind.is_constrained())
                .unwrap_or(EdgeKind::Plain)
        };
        let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
        let order = [0, 1, 2].map(|k| (first + k) % 3);
        (order.map(|i| corners[i]), order.map(|i| kind(i).number()))
    };
    (0..mesh.face_count() as u32).map(of_face).collect()
}

/// Fails unless a TIN in parts is the TIN in one piece: in its triangles, its facts, and for each
/// verb that works on it from part to part.
#[track_caller]
fn assert_same(folder: &TempDir, words: &str, tilings: &[&str]) {
    output_of(folder, &format!("tin {words}"), "whole.ply");
    output_of(folder, &format!("tin {words}"), "whole.tin");
    let expected = triangles(&folder.path().join("whole.ply"));
    for tiling in tilings {
        let (_, said) = output_of(folder, &format!("tin {words} {tiling}"), "parts.tins");
        assert!(said.contains("parts       "), "{said}");
        // All bytes of all parts, and the counts that the index states.
        let checked = run_in(folder, &["check", "parts.tins"]);
        assert_eq!(
            checked.code, 0,
            "{words} {tiling}: {}{}",
            checked.stdout, checked.stderr
        );
        output_of(folder, "tin parts.tins", "joined.ply");
        let found = triangles(&folder.path().join("joined.ply"));
        assert!(
            found == expected,
            "{words} {tiling}: {} of {} triangles",
            found.len(),
            expected.len()
        );
        for (verb, out) in [
            ("dem --resolution 0.7", "a.tif"),
            ("hillshade --resolution 3", "a.png"),
            ("contour --interval 0.5", "a.geojson"),
        ] {
            let of_parts = output_of(folder, &format!("{verb} parts.tins"), out).0;
            assert!(
                of_parts == output_of(folder, &format!("{verb} whole.tin"), out).0,
                "{verb}: {words} {tiling}"
            );
        }
    }
    let folders = files_of(folder.path())
        .into_iter()
        .filter(|name| name.starts_with("parts.tins"));
    assert_eq!(
        folders.count(),
        2,
        "the index and its parts: {:?}",
        files_of(folder.path())
    );
}

#[test]
fn the_valley_in_parts_is_the_valley() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let lines = valley.replace("valley.laz", "breaklines.shp");
    assert_same(
        &folder,
        &format!("{valley} --breaklines {lines}"),
        &["", "--tiles 4x4", "--tiles 13x9"],
    );
    // Triangles that wait for the rim: few, many; some are left out inside.
    assert_same(
        &folder,
        &format!("{valley} --soft-lines {lines} --max-edge 3"),
        &["--tiles 5x3"],
    );
    assert_same(
        &folder,
        &format!("{valley} --max-edge 9 --max-edge-inside 3"),
        &["--tiles 2x7"],
    );
    // Fragments are in a part of their own.
    let boundary = valley.replace("valley.laz", "boundary.shp");
    assert_same(
        &folder,
        &format!("{valley} --breaklines {lines} --boundary {boundary}"),
        &["--tiles 4x6"],
    );
}

/// Methods other than linear use the triangles under the surface, also those that the rim or a clip
/// has left out.
#[test]
fn heights_of_all_methods_are_those_of_one_piece() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let [lines, boundary] =
        ["breaklines.shp", "boundary.shp"].map(|name| valley.replace("valley.laz", name));
    for words in [
        format!("--boundary {boundary} --walls {lines} --wall-drop 1 --max-edge 3"),
        format!("--holes {boundary} --draped-lines {lines}"),
    ] {
        output_of(&folder, &format!("tin {valley} {words}"), "whole.tin");
        output_of(
            &folder,
            &format!("tin {valley} {words} --tiles 3x2"),
            "parts.tins",
        );
        for slopes in ["slope --formula faces --percent", "aspect --formula faces"] {
            let of = |surface: &str| {
                let words = format!("{slopes} --resolution 1.3 {surface}");
                output_of(&folder, &words, "a.tif").0
            };
            assert!(of("parts.tins") == of("whole.tin"), "{slopes}: {words}");
        }
        for method in ["nearest", "natural", "laplace", "smooth", "idw"] {
            let dem = format!("dem --resolution 2.9 --method {method}");
            let of_parts = output_of(&folder, &format!("{dem} parts.tins"), "a.tif").0;
            assert!(
                of_parts == output_of(&folder, &format!("{dem} whole.tin"), "a.tif").0,
                "{method}: {words}"
            );
        }
    }
}

/// Lines of several kinds on grids, where ties are the rule: along cuts, across them, and at seams.
#[test]
fn grids_with_lines_are_the_same_in_parts() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(41);
    let mut built = 0;
    for round in 0..12 {
        let side = [6, 12, 30][round % 3];
        let mut point = || [0, 1, 2].map(|_| random.below(side) as f64);
        let points: Vec<([f64; 3], u8)> = (0..20 + 9 * round).map(|_| (point(), 2)).collect();
        std::fs::write(
            folder.path().join("points.las"),
            lidar::las(&points, Some(25832)),
        )
        .unwrap();
        let mut words = "points.las".to_owned();
        for kind in ["breaklines", "soft-lines"] {
            let lines: Vec<Vec<[f64; 3]>> = (0..1 + round % 3)
                .map(|_| vec![point(), point(), point()])
                .collect();
            std::fs::write(
                folder.path().join(format!("{kind}.geojson")),
                layer(&lines, "LineString"),
            )
            .unwrap();
            words += &format!(" --{kind} {kind}.geojson");
        }
        words += [" --max-edge none", " --max-edge 4", ""][round % 3];
        let try_words = format!("tin {words} -o try.tin --overwrite");
        if run_in(&folder, &try_words.split(' ').collect::<Vec<_>>()).code == 0 {
            built += 1;
            assert_same(
                &folder,
                &words,
                &[&format!(
                    "--tiles {}x{}",
                    1 + random.below(side),
                    1 + random.below(side)
                )],
            );
        }
    }
    assert!(built > 6, "{built}");
}

/// Heights at positions, on faces, vertices and edges between parts, and outside.
#[test]
fn heights_of_parts_are_those_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let boundary = valley.replace("valley.laz", "boundary.shp");
    for cut in ["", &format!(" --boundary {boundary}")] {
        assert_same_heights(&folder, &format!("tin {valley}{cut}"));
    }
}

#[track_caller]
fn assert_same_heights(folder: &TempDir, words: &str) {
    output_of(folder, &format!("{words} --tiles 6x5"), "parts.tins");
    output_of(folder, words, "whole.tin");
    let open = |name: &str| {
        let source = Source::of_files(&[folder.path().join(name)]).unwrap();
        run::surface(
            &SurfaceRequest {
                source,
                ..SurfaceRequest::default()
            },
            &Context::default(),
        )
        .unwrap()
    };
    let (parts, whole) = (open("parts.tins"), open("whole.tin"));
    let surface = whole.triangles().unwrap();
    let mut random = Random(3);
    let mut positions: Vec<[f64; 2]> = (0..3000)
        .map(|_| {
            [
                688_000.0 + 410.0 * random.unit() - 5.0,
                5_261_000.0 + 310.0 * random.unit() - 5.0,
            ]
        })
        .collect();
    positions.extend(
        (0..surface.vertex_count() as u32)
            .step_by(40)
            .map(|v| surface.position(v))
            .map(|[x, y, _]| [x, y]),
    );
    positions.extend([[f64::NAN, 0.0], [f64::INFINITY, 1.0]]);
    let heights = |product| {
        run::elevations(product, &positions, Method::Linear, &Context::default()).unwrap()
    };
    let (found, expected) = (heights(&parts), heights(&whole));
    for ((found, expected), q) in found.iter().zip(&expected).zip(&positions) {
        assert!(
            found.is_nan() && expected.is_nan() || (found - expected).abs() < 1e-9,
            "{q:?}: {found}, {expected}"
        );
    }
    assert!(found.iter().filter(|height| !height.is_nan()).count() > 2000);
}

/// A surface in parts is replaced as a whole, and one that cannot be written leaves the other one.
#[test]
fn a_surface_in_parts_is_replaced_as_a_whole() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let (index, _) = output_of(&folder, &format!("tin {valley} --tiles 2x2"), "v.tins");
    let before = files_of(folder.path());
    output_of(
        &folder,
        &format!("tin {valley} --tiles 2x2 --memory 32MB"),
        "v.tins",
    );
    assert_eq!(files_of(folder.path()), before);
    assert!(bytes(folder.path().join("v.tins")) == index);
    run_in(&folder, &["tin", &valley, "--tiles", "3x3", "-o", "v.tins"]).fails(1, &["exist"]);
    run_in(
        &folder,
        &[
            "tin",
            &valley,
            "--class",
            "77",
            "--tiles",
            "3x3",
            "-o",
            "v.tins",
            "--overwrite",
        ],
    )
    .fails(2, &["no point is left"]);
    assert_eq!(run_in(&folder, &["job", "clean", "v.tins.job"]).code, 0);
    assert_eq!(files_of(folder.path()), before);
    output_of(&folder, &format!("tin {valley} --tiles 3x3"), "v.tins");
    let after = files_of(folder.path());
    let parts = |names: &[String]| {
        names
            .iter()
            .filter(|name| name.starts_with("v.tins."))
            .cloned()
            .collect::<Vec<_>>()
    };
    assert!(parts(&before) != parts(&after), "{before:?} {after:?}");
    assert_eq!(run_in(&folder, &["check", "v.tins"]).code, 0);
}

/// An index that names what is not its own does not remove it.
#[test]
fn only_own_parts_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let at = |name: &str| folder.path().join(name);
    output_of(&folder, &format!("tin {valley} --tiles 2x2"), "v.tins");
    std::fs::copy(at("v.tins"), at("copy.tins")).unwrap();
    output_of(&folder, &format!("tin {valley} --tiles 1x2"), "copy.tins");
    assert_eq!(run_in(&folder, &["check", "v.tins"]).code, 0);
    // A folder of somebody else.
    std::fs::create_dir(at("keep")).unwrap();
    std::fs::write(at("keep/me.txt"), "me").unwrap();
    let index = String::from_utf8(bytes(at("v.tins"))).unwrap();
    let own = files_of(folder.path())
        .into_iter()
        .find(|name| name.starts_with("v.tins."))
        .unwrap();
    std::fs::write(at("v.tins"), index.replace(&own, "keep")).unwrap();
    output_of(&folder, &format!("tin {valley} --tiles 3x1"), "v.tins");
    assert!(at("keep/me.txt").exists());
    // A part that is missing, and one that is damaged, are written again.
    for damage in [
        |path: &Path| std::fs::remove_file(path).unwrap(),
        |path: &Path| std::fs::write(path, "x").unwrap(),
    ] {
        let own = files_of(folder.path())
            .into_iter()
            .filter(|name| name.starts_with("copy.tins."))
            .collect::<Vec<_>>();
        assert_eq!(own.len(), 1, "{own:?}");
        damage(&at(&own[0]).join("000000.tin"));
        output_of(&folder, &format!("tin {valley} --tiles 1x2"), "copy.tins");
        assert_eq!(run_in(&folder, &["check", "copy.tins"]).code, 0);
    }
    assert!(
        files_of(folder.path())
            .iter()
            .all(|name| !name.ends_with(".unfinished"))
    );
}

/// Damage of the index and of parts is found by all that reads them.
#[test]
fn damage_is_an_error_that_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    output_of(&folder, &format!("tin {} --tiles 3x2", valley()), "v.tins");
    let index = String::from_utf8(bytes(folder.path().join("v.tins"))).unwrap();
    let parts = files_of(folder.path())
        .into_iter()
        .find(|name| name.starts_with("v.tins."))
        .unwrap();
    let verbs = ["dem", "contour", "tin", "check", "info"];
    let assert_fails = |said: &str| {
        for verb in verbs {
            let out = ["out.tif", "out.geojson", "out.ply"]
                [verbs.iter().position(|v| *v == verb).unwrap().min(2)];
            let words: &[&str] = if ["check", "info"].contains(&verb) {
                &[]
            } else {
                &["-o", out]
            };
            let run = run_in(&folder, &[&[verb, "v.tins"], words].concat());
            assert!(
                run.code != 0 && run.stderr.contains(said),
                "{verb}: {}",
                run.stderr
            );
        }
    };
    let part = folder.path().join(&parts).join("000002.tin");
    let whole = bytes(&part);
    std::fs::write(&part, &whole[..whole.len() - 1]).unwrap();
    assert_fails("000002.tin");
    std::fs::remove_file(&part).unwrap();
    assert_fails("v.tins needs its folder next to it");
    std::fs::write(&part, &whole).unwrap();
    for (from, to) in [
        ("parts\":2", "parts\":9"),
        ("\"area\":", "\"era\":"),
        (parts.as_str(), "/tmp"),
    ] {
        std::fs::write(folder.path().join("v.tins"), index.replace(from, to)).unwrap();
        assert_fails("missing or wrong");
    }
    std::fs::write(
        folder.path().join("v.tins"),
        index.replacen("\"triangles\":", "\"triangles\":1", 1),
    )
    .unwrap();
    assert_fails("the counts of the parts are not those of the surface");
    // A count that is wrong in a part alone is found by a check.
    std::fs::write(
        folder.path().join("v.tins"),
        index.replace("\"vertices\":", "\"vertices\":1"),
    )
    .unwrap();
    run_in(&folder, &["check", "v.tins"])
        .fails(1, &["the counts or the extent are not those of the parts"]);
    // A byte that no law of triangulations knows of: the number of a vertex.
    std::fs::write(folder.path().join("v.tins"), &index).unwrap();
    let mut damaged = whole.clone();
    let end = damaged.len();
    damaged[end - 1] ^= 1;
    std::fs::write(&part, &damaged).unwrap();
    run_in(&folder, &["check", "v.tins"]).fails(1, &["000002.tin", "checksum"]);
    let left: Vec<String> = files_of(folder.path());
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
fn parts_come_from_a_job_like_all_else() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    assert_eq!(
        run(&format!("job plan j -- tin {valley} -o v.tins --tiles 2x2")).code,
        0
    );
    assert_eq!(run("job run j --task 0").code, 0);
    assert_eq!(run("job run j").code, 0);
    assert!(run("job status j --json").stdout.contains("\"output\""));
    assert_eq!(run("check v.tins").code, 0);
    // The last task can be repeated, as all others can.
    let repeated = run("job run j");
    assert!(
        repeated.code == 0 && repeated.stderr.contains("v.tins is written"),
        "{}",
        repeated.stderr
    );
    assert_eq!(run("job clean j").code, 0);
    run(&format!("tin {valley} -o v.ply --tiles 2x2"))
        .fails(2, &["tiles make a TIN in parts", "name the output .tins"]);
    run(&format!("tin {valley} -o w.tins -o v.ply")).fails(2, &["written alone"]);
    run("tin v.tins -o w.tins").fails(2, &["tiles are made of points"]);
    run(&format!("tin {valley} -o w.tins --crossing-report c.csv"))
        .fails(1, &["--crossing-report does not work with tiles yet"]);
    let planned = run(&format!("tin {valley} -o w.tins --dry-run"));
    assert!(
        planned.code == 0 && planned.stderr.contains("on the disk"),
        "{}",
        planned.stderr
    );
    assert_eq!(
        files_of(folder.path())
            .iter()
            .filter(|name| name.starts_with("v.tins"))
            .count(),
        2
    );
    assert!(
        !files_of(folder.path())
            .iter()
            .any(|name| name.starts_with("w.tins"))
    );
}

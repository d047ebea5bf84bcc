//! Heights between the vertices, as typed: `--method`.

use super::{SLOPE, bytes, fixture, folder_with, run_in};
use testkit::random::Random;

#[test]
fn each_method_makes_a_raster_of_its_own_and_linear_is_the_default() {
    let folder = folder_with(&[(
        "a.xyz",
        "0 0 0\n8 0 9\n8 8 0\n0 8 5\n3 4 7\n6 5 1\n2 2 4\n5 1 3\n",
    )]);
    let mut seen: Vec<Vec<u8>> = Vec::new();
    for method in ["linear", "nearest", "natural", "laplace", "smooth", "idw"] {
        let name = format!("{method}.tif");
        run_in(&folder, &["dem", "a.xyz", "--method", method, "-o", &name]).works(&["8 x 8 cells"]);
        let written = bytes(&folder, &name);
        assert!(!seen.contains(&written), "{method}");
        seen.push(written);
    }
    run_in(&folder, &["dem", "a.xyz", "-o", "default.tif"]).works(&[]);
    assert!(bytes(&folder, "default.tif") == seen[0]);
    // As typed for gdal_grid.
    run_in(
        &folder,
        &["dem", "a.xyz", "-a", "invdist", "-o", "gdal.tif"],
    )
    .works(&[]);
    assert!(bytes(&folder, "gdal.tif") == seen[5]);
    let wrong = run_in(
        &folder,
        &["dem", "a.xyz", "--method", "kriging", "-o", "k.tif"],
    );
    wrong.fails(
        2,
        &["kriging", "linear, nearest, natural, laplace, smooth, idw"],
    );
}

#[test]
fn the_file_of_a_tin_gives_the_same_cells_on_any_number_of_threads() {
    let folder = folder_with(&[]);
    let (points, lines, site) = (
        fixture("valley.laz"),
        fixture("breaklines.shp"),
        fixture("boundary.shp"),
    );
    let tin = [
        "tin",
        &points,
        "--breaklines",
        &lines,
        "--boundary",
        &site,
        "-o",
        "t.tin",
    ];
    run_in(&folder, &tin).works(&[]);
    for method in ["natural", "smooth"] {
        let name = |of: &str| format!("{method}-{of}.tif");
        let dem = [
            "dem",
            &points,
            "--breaklines",
            &lines,
            "--boundary",
            &site,
            "--method",
            method,
        ];
        run_in(&folder, &[&dem[..], &["-o", &name("points")]].concat()).works(&[]);
        for threads in ["1", "3"] {
            let target = name(threads);
            run_in(
                &folder,
                &[
                    "dem",
                    "t.tin",
                    "--method",
                    method,
                    "--threads",
                    threads,
                    "-o",
                    &target,
                ],
            )
            .works(&[]);
            assert!(
                bytes(&folder, &target) == bytes(&folder, &name("points")),
                "{method}, {threads} threads"
            );
        }
    }
}

#[test]
fn a_hillshade_of_a_tin_has_a_method_and_one_of_a_dem_has_none() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("b.xyz", "0 0 0\n8 0 9\n8 8 0\n0 8 5\n3 4 7\n6 5 1\n"),
    ]);
    run_in(&folder, &["hillshade", "b.xyz", "-o", "linear.png"]).works(&[]);
    run_in(
        &folder,
        &[
            "hillshade",
            "b.xyz",
            "--method",
            "smooth",
            "-o",
            "smooth.png",
        ],
    )
    .works(&[]);
    assert!(bytes(&folder, "linear.png") != bytes(&folder, "smooth.png"));
    run_in(&folder, &["dem", "a.xyz", "-o", "d.tif"]).works(&[]);
    run_in(
        &folder,
        &["hillshade", "d.tif", "--method", "natural", "-o", "s.png"],
    )
    .fails(2, &["--method is for a TIN", "hint: leave it out"]);
}

/// Other methods than linear read vertices that no triangle within the bounds shows.
#[test]
fn cells_within_bounds_are_those_of_the_whole_by_any_method() {
    let mut random = Random(7);
    let points: Vec<String> = (0..3000)
        .map(|_| {
            let [x, y, z] = [10_000, 10_000, 2000].map(|most| random.below(most) as f64 / 100.0);
            format!("{x} {y} {z}\n")
        })
        .collect();
    let folder = folder_with(&[("a.xyz", &points.concat())]);
    for window in ["48,48,52,52", "70,20,72,23"] {
        for method in ["linear", "nearest", "natural", "laplace", "smooth", "idw"] {
            let dem = |name: &str, options: &[&str]| {
                let shared = ["dem", "a.xyz", "--te", window, "--resolution", "0.1"];
                let of_method = ["--max-edge", "4", "--method", method, "-o", name];
                run_in(&folder, &[&shared[..], &of_method, options].concat())
            };
            let (part, whole) = (format!("{window}{method}.tif"), format!("{window}.tif"));
            dem(&part, &["--bounds", window]).works(&[match method {
                "linear" => "outside of the bounds are used",
                _ => "all points are used",
            }]);
            dem(&whole, &["--overwrite"]).works(&[]);
            assert!(
                bytes(&folder, &part) == bytes(&folder, &whole),
                "{window} {method}"
            );
        }
    }
}

//! Surfaces of chosen returns.

use super::{SLOPE, bytes, folder_with, run_in};
use testkit::lidar::las;

/// Ground as last returns 1 m apart, trees above half of it as first ones, and one bird.
fn forest() -> Vec<u8> {
    let mut points = Vec::new();
    let mut returns: Vec<(u8, u8)> = Vec::new();
    for i in 0..8 * 8 {
        let [x, y] = [i % 8, i / 8].map(f64::from);
        if x >= 4.0 {
            points.push(([x, y, 20.0], 5));
            returns.push((1, 2));
            points.push(([x, y, 10.0], 2));
            returns.push((2, 2));
        } else {
            points.push(([x, y, 10.0], 2));
            returns.push((1, 1));
        }
    }
    points.push(([3.5, 3.5, 200.0], 18));
    returns.push((1, 1));
    let mut file = las(&points, Some(25832));
    let start = file.len() - 20 * points.len();
    for (record, (number, count)) in file[start..].chunks_exact_mut(20).zip(returns) {
        record[14] = number | count << 3;
    }
    file
}

#[test]
fn first_returns_are_a_surface_model() {
    let folder = folder_with(&[("text.xyz", SLOPE)]);
    std::fs::write(folder.path().join("f.las"), forest()).unwrap();
    let dem = |options: &str, output: &str, said: &[&str]| {
        let line = format!("dem f.las --resolution 1 {options} -o {output}");
        let run = run_in(&folder, &line.split(' ').collect::<Vec<_>>());
        run.works(said);
        bytes(&folder, output)
    };
    let surface = dem(
        "--return first",
        "dsm.tif",
        &[
            "note: points of all classes are used, except noise (7 and 18)",
            "97 read, 64 used; dropped: 1 of other classes (18: 1), 32 of other returns",
        ],
    );
    let info = run_in(&folder, &["info", "--json", "dsm.tif"]);
    let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
    let raster = &files[0];
    assert_eq!(raster["max"], 20.0);
    let tiled = dem(
        "--return first --tiles 2x2",
        "tiled.tif",
        &["32 of other returns"],
    );
    assert!(surface == tiled, "tiles differ");
    assert!(surface == dem("-first_only", "las.tif", &[]));

    let ground = dem("--class 2", "ground.tif", &["97 read, 64 used"]);
    assert!(ground != surface);
    assert!(ground == dem("--return last", "last.tif", &["64 used"]));
    let everything = dem("--return all --class all", "all.tif", &["97 read, 97 used"]);
    assert!(everything == dem("--class 0-255", "range.tif", &["97 used"]));
    dem(
        "--return single --class 0-31",
        "single.tif",
        &["33 used", "no point has class 0, 1, 3 to 17, 19 to 31"],
    );
    dem("--return only,2 --class all", "two.tif", &["65 used"]);

    let run = run_in(&folder, &["dem", "f.las", "--return", "7", "-o", "no.tif"]);
    run.fails(1, &["97 of other returns", "choose with --return"]);
    let run = run_in(
        &folder,
        &["dem", "f.las", "--return", "second", "-o", "no.tif"],
    );
    run.fails(
        2,
        &["`second` is not a return", "`first`, `last`, `single`"],
    );
    let run = run_in(
        &folder,
        &["tin", "text.xyz", "--return", "first", "-o", "t.ply"],
    );
    run.works(&["warning: 16 points do not say which return they are, and are used, too"]);
    let run = run_in(
        &folder,
        &["points", "f.las", "--return", "last", "-o", "p.las"],
    );
    run.works(&["65 points of 97, 32 of other returns"]);
}

//! Which columns of text are taken.

use super::{SLOPE, folder_with, run_in};

/// Number, northing, easting, height, code; as surveyors keep them.
const PNEZD: &str = "1,5261002.10,688001.20,801.33,GS\n2,5261002.90,688009.70,802.00,GS\n\
                     3,5261009.80,688005.10,803.50,TB\n4,5261011.00,688001.00,801.00,GS\n";

fn extent(folder: &tempfile::TempDir, args: &[&str]) -> (serde_json::Value, serde_json::Value) {
    let run = run_in(folder, &[&["info", "--json"], args].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    let files: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    (
        files[0]["bounds"]["min"].clone(),
        files[0]["columns"].clone(),
    )
}

#[test]
fn names_of_arcgis_are_known() {
    let folder = folder_with(&[(
        "p.csv",
        "OBJECTID,POINT_Z,POINT_X,POINT_Y\n1,801.5,688001,5261002\n2,802,688009,5261003\n",
    )]);
    let (min, columns) = extent(&folder, &["p.csv"]);
    assert_eq!(min, serde_json::json!([688_001.0, 5_261_002.0, 801.5]));
    assert_eq!(
        columns,
        serde_json::json!({"x": 3, "y": 4, "z": 2, "class": null})
    );
}

#[test]
fn numbers_of_points_are_not_taken_for_coordinates() {
    let folder = folder_with(&[
        ("p.csv", PNEZD),
        ("x.xyz", SLOPE),
        ("h.csv", &format!("P,North,East,Elev,D\n{PNEZD}")),
    ]);
    let guessed = [
        "p.csv: ",
        "counts up by one",
        "northing, easting and height (PNEZD)",
        "hint: ",
        "--columns PNEZD",
    ];
    run_in(&folder, &["tin", "p.csv", "-o", "t.ply"]).fails(1, &guessed);
    run_in(&folder, &["info", "p.csv"]).fails(1, &guessed);
    let expected = serde_json::json!([688_001.0, 5_261_002.1, 801.0]);
    let taken = serde_json::json!({"x": 3, "y": 2, "z": 4, "class": null});
    for named in [
        &["p.csv", "--columns", "PNEZD"][..],
        &["p.csv", "--columns", "3,2,4"],
        &["p.csv", "--parse", "syxzs"],
        &["h.csv"],
        &["h.csv", "--columns", "pneZd"],
    ] {
        assert_eq!(
            extent(&folder, named),
            (expected.clone(), taken.clone()),
            "{named:?}"
        );
    }
    let text = run_in(&folder, &["info", "h.csv"]).stdout;
    assert!(text.contains("  columns    x 3, y 2, z 4\n"), "{text}");
    let run = run_in(
        &folder,
        &["tin", "p.csv", "--columns", "PNEZD", "-o", "t.ply"],
    );
    run.works(&["4 read, 4 used", "\ncolumns     x 3, y 2, z 4\n"]);
    assert_eq!(
        extent(&folder, &["p.csv", "--columns", "XYZ"]).0,
        serde_json::json!([1.0, 5_261_002.1, 688_001.0])
    );
    // Several files that differ.
    run_in(
        &folder,
        &["tin", "h.csv", "x.xyz", "--max-edge", "none", "-o", "u.ply"],
    )
    .works(&["\ncolumns     x 3, y 2, z 4 (1 file); x 1, y 2, z 3 (1 file)\n"]);
}

#[test]
fn what_only_resembles_numbers_is_taken_as_ever() {
    let rows = |row: &dyn Fn(usize) -> String| (0..20).map(row).collect::<String>();
    let folder = folder_with(&[
        ("three.xyz", &rows(&|i| format!("{i} {} 5\n", i * i))),
        (
            "grid.xyz",
            &rows(&|i| format!("{} {} 5 17\n", i % 5, i / 5)),
        ),
        (
            "halves.xyz",
            &rows(&|i| format!("{}.5 {} 5 17\n", i, i * i)),
        ),
        ("named.xyz", &rows(&|i| format!("{i} {} 5 tree\n", i * i))),
    ]);
    for name in ["three.xyz", "grid.xyz", "halves.xyz", "named.xyz"] {
        run_in(&folder, &["tin", name, "-o", &format!("{name}.ply")])
            .works(&["20 used", "columns     x 1, y 2, z 3\n"]);
    }
}

#[test]
fn columns_are_for_text_and_for_points() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("p.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n"),
        ("p.poly", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n0 0\n0\n"),
    ]);
    for name in ["p.node", "p.poly"] {
        for args in [
            &["tin", name, "-o", "t.ply"][..],
            &["dem", name, "-o", "t.tif"],
        ] {
            run_in(&folder, args).fails(
                1,
                &[
                    name,
                    "file of Triangle",
                    "hint: `breakline triangulate` reads it",
                ],
            );
        }
        assert!(
            run_in(&folder, &["info", name])
                .stdout
                .contains("vertices   3"),
            "{name}"
        );
    }
    let laz = super::fixture("valley.laz");
    run_in(&folder, &["tin", &laz, "--columns", "XYZ", "-o", "t.ply"])
        .fails(2, &["no input is text"]);
    run_in(
        &folder,
        &[
            "tin",
            &laz,
            "a.xyz",
            "--columns",
            "XYZ",
            "-q",
            "-o",
            "t.ply",
        ],
    )
    .works(&[]);
    for (wrong, said) in [
        ("XYQ", "`Q` is none of"),
        ("0,1,2", "from 1 on"),
        ("NEN", "two letters are for y"),
    ] {
        run_in(
            &folder,
            &["tin", "a.xyz", "--columns", wrong, "-o", "u.ply"],
        )
        .fails(2, &[said]);
    }
    run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--columns",
            "XYZ",
            "--parse",
            "xyz",
            "-o",
            "u.ply",
        ],
    )
    .fails(2, &["cannot be used with"]);
    run_in(
        &folder,
        &["dem", "t.ply", "--columns", "XYZ", "-o", "d.tif"],
    )
    .fails(2, &["--columns", "the input is a surface already"]);
    // A column that is not there.
    run_in(
        &folder,
        &["tin", "a.xyz", "--columns", "1,2,9", "-o", "u.ply"],
    )
    .fails(
        1,
        &["a.xyz: line 1: 3 fields separated by blanks, expected at least 9"],
    );
}

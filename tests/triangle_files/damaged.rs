use crate::{BOX, files_of, folder_with, run};

/// The box with one change.
fn changed(from: &str, to: &str) -> String {
    assert_eq!(BOX.matches(from).count(), 1, "{from}");
    BOX.replace(from, to)
}

#[test]
fn every_damage_is_told_with_line_value_and_cure() {
    let table: &[(&str, String, &str)] = &[
        (
            "a.node",
            String::new(),
            "line 1: the file ends where the number of vertices is expected",
        ),
        (
            "a.node",
            "# nothing\n".into(),
            "line 1: the file ends where the number of vertices is expected",
        ),
        (
            "a.node",
            "3 2\n1 0 0\n2 1 0\n".into(),
            "line 3: the file ends where vertex 3 of 3 is expected",
        ),
        (
            "a.node",
            "2 2\n1 0 0\n2 1 0\n3 1 1\n".into(),
            "line 4: '3' follows the last vertex",
        ),
        (
            "a.node",
            "99999999999999 2\n1 0 0\n".into(),
            "line 2: the file ends where vertex 2 of 99999999999999",
        ),
        (
            "a.node",
            "1 2 99999999999999\n1 0 0\n".into(),
            "line 2: there is no attribute",
        ),
        (
            "a.node",
            "-3 2\n1 0 0\n".into(),
            "line 1: -3 is out of range for the number of vertices",
        ),
        (
            "a.node",
            "3.5 2\n1 0 0\n".into(),
            "line 1: '3.5' is not a whole number for the number of vertices",
        ),
        (
            "a.node",
            "18446744073709551616 2\n".into(),
            "line 1: '18446744073709551616' is not a whole number",
        ),
        (
            "a.node",
            "1 4\n1 0 0 0\n".into(),
            "line 1: the dimension is 4, expected 2",
        ),
        (
            "a.node",
            "1 2 0 2\n1 0 0 0 0\n".into(),
            "line 1: the number of boundary markers is 2, expected 0 or 1",
        ),
        (
            "a.node",
            "1 2\n2 0 0\n".into(),
            "line 2: the first vertex has the number 2, expected 0 or 1",
        ),
        (
            "a.node",
            "1 2\n-1 0 0\n".into(),
            "line 2: the first vertex has the number -1, expected 0 or 1",
        ),
        (
            "a.node",
            "3 2\n0 0 0\n1 1 0\n3 0 1\n".into(),
            "line 4: vertex number 3 is out of sequence, expected 2",
        ),
        (
            "a.node",
            "2 2\n0 0 0\n0 1 0\n".into(),
            "line 3: vertex number 0 is out of sequence, expected 1",
        ),
        (
            "a.node",
            "1 2\n1 0 nan\n".into(),
            "line 2: the y coordinate is nan, expected a finite number",
        ),
        (
            "a.node",
            "1 2\n1 -inf 0\n".into(),
            "line 2: the x coordinate is -inf, expected a finite number",
        ),
        (
            "a.node",
            "1 2\n1 1e999 0\n".into(),
            "line 2: the x coordinate is 1e999, expected a finite number",
        ),
        (
            "a.node",
            "1 2 1\n1 0 0 nan\n".into(),
            "line 2: the attribute is nan, expected a finite number",
        ),
        (
            "a.node",
            "1 2\n1 0\n".into(),
            "line 2: there is no y coordinate",
        ),
        (
            "a.node",
            "1 2\n1 0 zero\n".into(),
            "line 2: 'zero' is not a number for the y coordinate",
        ),
        (
            "a.node",
            "1 2 0 1\n1 0 0\n".into(),
            "line 2: there is no boundary marker",
        ),
        (
            "a.node",
            "1 2 0 1\n1 0 0 4294967296\n".into(),
            "line 2: 4294967296 is out of range for the boundary marker",
        ),
        (
            "a.poly",
            changed("8 2 0 1", "9 2 0 1"),
            "line 14: vertex number 8 is out of sequence, expected 9",
        ),
        (
            "a.poly",
            changed("8 2 0 1", "7 2 0 1"),
            "line 12: this is not a line that counts segments",
        ),
        (
            "a.poly",
            changed("\n8 1\n", "\n9 1\n"),
            "line 24: there is no first end",
        ),
        (
            "a.poly",
            changed("\n8 1\n", "\n7 1\n"),
            "line 22: this is not a line that counts holes",
        ),
        (
            "a.poly",
            changed("\n8 1\n", "\n99999999999 1\n"),
            "line 24: there is no first end",
        ),
        (
            "a.poly",
            changed("\n8 1\n", "\n8 2\n"),
            "line 14: this is not a line that counts segments",
        ),
        (
            "a.poly",
            changed("5   6 5   10", "5   6 9   10"),
            "line 19: the second end is vertex 9, but the vertices are numbered 1 to 8",
        ),
        (
            "a.poly",
            changed("1   1 2   5", "1   0 2   5"),
            "line 15: the first end is vertex 0, but the vertices are numbered 1 to 8",
        ),
        (
            "a.poly",
            changed("1   1 2   5", "1   1 -2   5"),
            "line 15: the second end is vertex -2, but",
        ),
        (
            "a.poly",
            changed("1   1 2   5", "1   1 2"),
            "line 15: there is no boundary marker",
        ),
        (
            "a.poly",
            changed("1   1.5 1.5", "1   1.5 NaN"),
            "line 25: the y coordinate is NaN, expected a finite number",
        ),
        (
            "a.poly",
            changed("1   1.5 1.5\n", ""),
            "line 24: the file ends where hole 1 of 1 is expected",
        ),
        (
            "a.poly",
            changed("1   1.5 1.5\n", "1   1.5 1.5\n1\n"),
            "line 26: the file ends where region 1 of 1",
        ),
        (
            "a.poly",
            changed("1   1.5 1.5\n", "1   1.5 1.5\n1\n1 2 2\n"),
            "line 27: there is no attribute",
        ),
        (
            "a.poly",
            changed("1   1.5 1.5\n", "1   1.5 1.5\n0\n7 7 7\n"),
            "line 27: '7' follows the last list",
        ),
        (
            "a.poly",
            BOX.split("# One hole").next().unwrap().into(),
            "line 22: the file ends where the number of holes",
        ),
        ("a.poly", "0 2 0 0\n0\n0\n".into(), "a.node: "),
        (
            "a.poly",
            "\0\u{1}\u{fffd}binary".into(),
            "line 1: '\u{fffd}\u{fffd}\u{fffd}binary' is not a whole number for the number of",
        ),
    ];
    for (name, text, message) in table {
        let folder = folder_with(&[(name, text)]);
        let run = run(
            &folder,
            &format!("triangulate {name} -o out.ele -o out.off -o out.poly"),
        );
        run.ends(1, &["error: a.", message]);
        assert!(
            run.stderr.contains("hint: "),
            "{message}: no cure in\n{}",
            run.stderr
        );
        assert_eq!(files_of(folder.path()), [*name], "{message}");
    }
}

#[test]
fn surplus_values_are_a_warning() {
    let folder = folder_with(&[("a.node", "3 2\n1 0 0 7\n2 1 0\n3 0 1 8 9\n")]);
    let said = [
        "warning: a.node: line 2: there are more values than announced; they are not read (2 such lines)",
    ];
    run(&folder, "triangulate a.node -o b.ele").ends(0, &said);
    let numpy = "3.0e+00 2 0 0\n1.000e+00 0 0\n2.000e+00,1,0\r\n3.000e+00\t0\t1";
    let folder = folder_with(&[("a.node", numpy)]);
    run(&folder, "triangulate a.node -o b.ele").ends(0, &["triangles   1"]);
}

#[test]
fn no_prefix_does_harm() {
    let folder = folder_with(&[]);
    let mut good = 0;
    // Every length would take a minute; a prime step meets all kinds of places.
    for length in (0..BOX.len()).step_by(7) {
        std::fs::write(folder.path().join("a.poly"), &BOX[..length]).unwrap();
        let run = run(&folder, "triangulate a.poly -o out.off --overwrite");
        assert!(
            run.code == 0 || (run.code == 1 && run.stderr.starts_with("error: a.")),
            "{length}: {}",
            run.stderr
        );
        good += usize::from(run.code == 0);
    }
    assert!(good < 3, "{good} prefixes are taken for whole files");
}

/// What stands beside an `.ele`.
#[test]
fn damaged_triangles_are_told_too() {
    let node = "4 2\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n";
    let ele = "2 3 0\n1 1 2 3\n2 1 3 4\n";
    let table: &[(&[(&str, &str)], &str)] = &[
        (&[("a.ele", ele)], "a.node: "),
        (
            &[("a.node", node), ("a.ele", "2 3\n1 1 2 3\n2 1 3 5\n")],
            "a.ele: line 3: the corner is vertex 5, but the vertices are numbered 1 to 4",
        ),
        (
            &[("a.node", node), ("a.ele", "2 3\n1 1 2 3\n2 0 3 4\n")],
            "a.ele: line 3: the corner is vertex 0, but",
        ),
        (
            &[("a.node", node), ("a.ele", "3 3\n1 1 2 3\n2 1 3 4\n")],
            "a.ele: line 3: the file ends where triangle 3 of 3",
        ),
        (
            &[("a.node", node), ("a.ele", "1 3\n1 1 2 3\n2 1 3 4\n")],
            "a.ele: line 3: '2' follows the last triangle",
        ),
        (
            &[("a.node", node), ("a.ele", "1 4\n1 1 2 3 4\n")],
            "a.ele: line 1: a triangle has 4 vertices, expected 3 or 6",
        ),
        (
            &[("a.node", node), ("a.ele", "1 3 1\n1 1 2 3\n")],
            "a.ele: line 2: there is no attribute",
        ),
        (
            &[
                ("a.node", node),
                ("a.ele", ele),
                ("a.edge", "1 1\n1 1 9 1\n"),
            ],
            "a.edge: line 2: the second end is vertex 9",
        ),
        (
            &[
                ("a.node", node),
                ("a.ele", ele),
                ("a.edge", "2 1\n1 1 2 1\n"),
            ],
            "a.edge: line 2: the file ends where edge 2 of 2",
        ),
        (
            &[
                ("a.node", node),
                ("a.ele", ele),
                ("a.poly", "0 2\n1\n1 1 9\n0\n"),
            ],
            "a.poly: line 3: the second end is vertex 9",
        ),
        (
            &[("a.node", node), ("a.ele", ele), ("a.neigh", "3 3\n")],
            "a.neigh: line 1: there are 3 triangles, but the .ele file has 2",
        ),
        (
            &[
                ("a.node", node),
                ("a.ele", ele),
                ("a.neigh", "2 3\n1 -1 2 -1\n2 -1 -1 3\n"),
            ],
            "a.neigh: line 3: the neighbor is triangle 3",
        ),
        (
            &[
                ("a.node", node),
                ("a.ele", ele),
                ("a.neigh", "2 3\n1 -1 2 -1\n2 -1 0 -1\n"),
            ],
            "a.neigh: line 3: the neighbor is triangle 0",
        ),
    ];
    for (files, message) in table {
        let folder = folder_with(files);
        run(&folder, "check a.ele").ends(1, &["error: ", message]);
    }
}

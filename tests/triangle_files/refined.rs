use tempfile::TempDir;

use crate::{BOX, files_of, folder_with, run, table, triangles, twice_area};

/// The angles of `NAME.ele`, in degrees, and the areas.
fn shapes(folder: &TempDir, name: &str) -> (Vec<f64>, Vec<f64>) {
    let triangles = triangles(folder, name);
    let angle = |[a, b, c]: [[f64; 2]; 3]| {
        let ([ux, uy], [vx, vy]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        (ux * vy - uy * vx).atan2(ux * vx + uy * vy).to_degrees()
    };
    let angles = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]].map(angle));
    (
        angles.collect(),
        triangles.iter().map(|&t| twice_area(t) / 2.0).collect(),
    )
}

#[test]
fn switches_of_triangle_refine() {
    let folder = folder_with(&[
        ("box.poly", BOX),
        (
            "plain.node",
            "4 2 1 0\n1 0 0 0\n2 9 0 9\n3 9 1 10\n4 0 1 1\n",
        ),
    ]);
    for (switches, smallest, largest) in [
        ("-pq", 20.0, f64::INFINITY),
        ("-q30", 30.0, f64::INFINITY),
        ("-pq25a.1", 25.0, 0.1),
        ("--max-area 0.2", 0.0, 0.2),
    ] {
        run(
            &folder,
            &format!("triangulate {switches} box.poly -o out.ele --overwrite"),
        )
        .ends(0, &["for angles and areas"]);
        let (angles, areas) = shapes(&folder, "out");
        assert!(
            angles.iter().all(|&angle| angle >= smallest - 1e-9),
            "{switches}"
        );
        assert!(areas.iter().all(|&area| area <= largest), "{switches}");
        assert!(
            (areas.iter().sum::<f64>() - 8.0).abs() < 1e-9,
            "{switches}: the hole stays one"
        );
    }
    // Without segments the hull is refined; attributes, here the sum of the coordinates, are those
    // of the place.
    run(&folder, "triangulate -a0.05 plain.node -o fine.ele").ends(0, &["for angles and areas"]);
    assert!(shapes(&folder, "fine").1.iter().all(|&area| area <= 0.05));
    for row in &table(&folder, "fine.node")[1..] {
        assert!((row[3] - row[1] - row[2]).abs() < 1e-9, "{row:?}");
    }
    // The checker sees nothing wrong.
    assert_eq!(run(&folder, "check fine.ele").code, 0);
    for wrong in ["--min-angle 60", "-q0", "-a0", "--max-area=-1"] {
        assert_eq!(
            run(
                &folder,
                &format!("triangulate {wrong} box.poly -o wrong.ele")
            )
            .code,
            2,
            "{wrong}"
        );
    }
}

/// Attributes of added vertices are linear in the triangle that contained them before, whatever the
/// attributes are, and beside crossings, too. On the second of two segments that cross, they are
/// linear between its ends.
#[test]
fn attributes_are_interpolated_in_the_triangles_before() {
    let corners = "1 0 0 7\n2 100 0 1\n3 100 100 40\n4 0 100 3\n";
    let rows = (5..=20).map(|i| {
        let (x, y, value) = (i * 37 % 97, i * 53 % 89, i * i * 29 % 53);
        format!("{i} {x} {y} {value}\n")
    });
    let nodes = rows.collect::<String>();
    let folder = folder_with(&[(
        "drawing.poly",
        &format!("20 2 1 0\n{corners}{nodes}2 0\n1 1 3\n2 2 4\n0\n"),
    )]);
    for (switches, name) in [("-c", "coarse"), ("-cq30a20", "fine")] {
        run(
            &folder,
            &format!("triangulate {switches} drawing.poly -o {name}.ele"),
        )
        .ends(0, &[]);
    }
    let given = table(&folder, "coarse.node");
    let triangles = table(&folder, "coarse.ele");
    let fine = table(&folder, "fine.node");
    assert!(fine.len() > 100 && given.len() < 30);
    let is_on_second = |row: &[f64]| (row[1] + row[2] - 100.0).abs() < 1e-9;
    for row in &fine[given.len()..] {
        if is_on_second(row) {
            assert!((row[3] - (3.0 - row[1] / 50.0)).abs() < 1e-9, "{row:?}");
            continue;
        }
        let is_right = |triangle: &Vec<f64>| {
            let [a, b, c] = [1, 2, 3].map(|k| &given[triangle[k] as usize]);
            let area = |p: &[f64], q: &[f64], r: &[f64]| {
                (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1])
            };
            let weights =
                [area(b, c, row), area(c, a, row), area(a, b, row)].map(|w| w / area(a, b, c));
            let value = weights[0] * a[3] + weights[1] * b[3] + weights[2] * c[3];
            weights.iter().all(|&w| w > -1e-9) && (value - row[3]).abs() < 1e-6
        };
        assert!(triangles[1..].iter().any(is_right), "{row:?}");
    }
}

/// An angle that cannot be reached: an error that tells how far it came, or what is there at the
/// limit that was given.
#[test]
fn refinement_without_an_end_stops_at_its_limit() {
    let points = "8 2 0 0\n1 0 0\n2 10 0\n3 10 10\n4 0 10\n5 3 4\n6 7 2\n7 8 7\n8 2 8\n";
    let folder = folder_with(&[("eight.node", points)]);
    let unbounded = run(&folder, "triangulate -q45 eight.node -o e.1.ele");
    unbounded.fails(
        1,
        &[
            "eight.node: 1000000 vertices were added, and ",
            " are still not as requested",
            "--max-added",
        ],
    );
    assert_eq!(files_of(folder.path()), ["eight.node"]);
    for switches in ["-q45S500", "-q45 --max-added 500"] {
        let bounded = run(
            &folder,
            &format!("triangulate {switches} eight.node -o e.1.ele --overwrite"),
        );
        bounded.works(&[
            "triangles are not as requested: left when 500 vertices had been added (--max-added)",
        ]);
        assert_eq!(table(&folder, "e.1.node").len(), 1 + 508);
        assert_eq!(run(&folder, "check e.1.ele").code, 0);
    }
    // A limit that is not reached says nothing; none at all is a triangulation without added
    // vertices.
    run(&folder, "triangulate -q30S500 eight.node -o f.ele").works(&["for angles and areas"]);
    assert!(
        !run(&folder, "triangulate -q30S500 eight.node -o g.ele")
            .stderr
            .contains("warning")
    );
    run(&folder, "triangulate -q30S eight.node -o h.ele")
        .works(&["left when 0 vertices had been added"]);
    assert_eq!(table(&folder, "h.node").len(), 1 + 8);
    assert_eq!(
        run(&folder, "triangulate -q30S1.5 eight.node -o i.ele").code,
        2
    );
}

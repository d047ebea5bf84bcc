use std::collections::BTreeSet;

use crate::{BOX, files_of, folder_with, run, table, triangles, twice_area};
use testkit::random::Random;

#[test]
fn the_box_of_the_manual() {
    let folder = folder_with(&[("box.poly", BOX)]);
    let outputs = "-o box.1.ele -o box.1.edge -o box.1.neigh";
    run(&folder, &format!("triangulate box.poly {outputs}")).ends(
        0,
        &[
            "vertices    8 (8 in, 0 added",
            "segments    8 in, 8 constrained edges out",
            "triangles   8 (2 outside or in holes removed)",
            "written     box.1.ele",
            "written     box.1.node",
            "written     box.1.poly",
        ],
    );
    assert_eq!(
        files_of(folder.path()),
        [
            "box.1.edge",
            "box.1.ele",
            "box.1.neigh",
            "box.1.node",
            "box.1.poly",
            "box.poly"
        ]
    );
    let nodes = table(&folder, "box.1.node");
    assert_eq!(nodes[0], [8.0, 2.0, 0.0, 1.0]);
    let input = [
        [0, 0],
        [3, 0],
        [3, 3],
        [0, 3],
        [1, 1],
        [1, 2],
        [2, 1],
        [2, 2],
    ];
    for (i, ([x, y], marker)) in input
        .into_iter()
        .zip([5, 5, 33, 1, 10, 10, 10, 10])
        .enumerate()
    {
        assert_eq!(
            nodes[i + 1],
            [
                i as f64 + 1.0,
                f64::from(x),
                f64::from(y),
                f64::from(marker)
            ]
        );
    }
    let corners = triangles(&folder, "box.1");
    assert!(corners.iter().all(|&t| twice_area(t) > 0.0));
    assert_eq!(corners.iter().map(|&t| twice_area(t)).sum::<f64>(), 16.0);

    // The boundary is marked, whether the segments were or not.
    let edges = table(&folder, "box.1.edge");
    assert_eq!((&edges[0], edges.len()), (&vec![16.0, 1.0], 17));
    let marked = |rows: &[Vec<f64>]| -> BTreeSet<[i32; 3]> {
        let rows = rows
            .iter()
            .map(|row| [row[1], row[2], row[3]].map(|x| x as i32));
        rows.filter(|row| row[2] != 0)
            .map(|[a, b, m]| [a.min(b), a.max(b), m])
            .collect()
    };
    let expected: BTreeSet<[i32; 3]> = [
        [1, 2, 5],
        [2, 3, 1],
        [3, 4, 1],
        [1, 4, 1],
        [5, 7, 10],
        [7, 8, 10],
        [6, 8, 10],
        [5, 6, 10],
    ]
    .into();
    assert_eq!(marked(&edges[1..]), expected);
    let poly = table(&folder, "box.1.poly");
    assert_eq!(
        (&poly[0], &poly[1]),
        (&vec![0.0, 2.0, 0.0, 1.0], &vec![8.0, 1.0])
    );
    assert_eq!(marked(&poly[2..10]), expected);
    assert_eq!(poly[10..], [vec![1.0], vec![1.0, 1.5, 1.5]]);

    // Neighbors share the edge opposite the corner.
    let elements = table(&folder, "box.1.ele");
    let neighbors = table(&folder, "box.1.neigh");
    assert_eq!(
        (&elements[0], &neighbors[0]),
        (&vec![8.0, 3.0, 0.0], &vec![8.0, 3.0])
    );
    let mut at_rim = 0;
    for (element, around) in elements[1..].iter().zip(&neighbors[1..]) {
        assert_eq!(element[0], around[0]);
        for i in 0..3 {
            if around[1 + i] == -1.0 {
                at_rim += 1;
                continue;
            }
            let beside = &elements[around[1 + i] as usize][1..];
            assert!(!beside.contains(&element[1 + i]));
            assert!(
                beside.contains(&element[1 + (i + 1) % 3])
                    && beside.contains(&element[1 + (i + 2) % 3])
            );
        }
    }
    assert_eq!(at_rim, 8);
    run(&folder, "check box.1.ele").ends(
        0,
        &["8 vertices, 8 triangles, 8 constrained edges: no flaw found"],
    );

    // What was written is read again, and nothing changes any more.
    run(
        &folder,
        "triangulate box.1.poly -o box.2.ele -o box.2.edge -o box.2.neigh",
    )
    .ends(0, &["triangles   8"]);
    for part in ["node", "ele", "poly", "edge", "neigh"] {
        let [one, two] = [1, 2].map(|n| {
            std::fs::read_to_string(folder.path().join(format!("box.{n}.{part}"))).unwrap()
        });
        let sorted = |text: &str| {
            text.lines()
                .map(|line| line[4.min(line.len())..].to_owned())
                .collect::<BTreeSet<_>>()
        };
        match part {
            // The numbers of triangles and edges may differ.
            "node" => assert_eq!(one, two),
            "poly" => assert_eq!(sorted(&one).len(), sorted(&two).len()),
            _ => assert_eq!(one.lines().count(), two.lines().count()),
        }
    }
    let key = |name: &str| {
        let mut sets: Vec<_> = triangles(&folder, name)
            .iter()
            .map(|t| {
                let mut t = t.map(|p| p.map(|x| x as i32));
                t.sort_unstable();
                t
            })
            .collect();
        sets.sort_unstable();
        sets
    };
    assert_eq!(key("box.1"), key("box.2"));
}

/// Numberings, attributes, markers and ways to give the vertices.
#[test]
fn what_was_given_comes_back() {
    let points = [
        [0.1, 0.2],
        [4.0, 1e-7],
        [3.3333333333333335, 3.0],
        [-1e-9, 4.25],
        [1.5, 1.75],
    ];
    for first in [0usize, 1] {
        for attribute_count in 0..3usize {
            for marker_count in 0..2usize {
                let rows: String = points
                    .iter()
                    .enumerate()
                    .map(|(i, [x, y])| {
                        let attributes: String = (0..attribute_count)
                            .map(|k| format!(" {}.5", 10 * i + k))
                            .collect();
                        let marker = if marker_count == 1 {
                            format!(" {}", [-7, 0, 2, 0, 0][i])
                        } else {
                            String::new()
                        };
                        format!("{} {x} {y}{attributes}{marker}\n", i + first)
                    })
                    .collect();
                let node = format!("5 2 {attribute_count} {marker_count}\n{rows}");
                let ring: String = (0..4)
                    .map(|i| format!("{} {} {}\n", i + first, i + first, (i + 1) % 4 + first))
                    .collect();
                let lists = format!("4 0\n{ring}0\n");
                let folder = folder_with(&[
                    ("a.node", &node),
                    ("b.poly", &format!("{node}{lists}")),
                    ("c.node", &node),
                    ("c.poly", &format!("0 2 0 0\n{lists}")),
                ]);
                for input in ["a.node", "b.poly", "c.poly"] {
                    run(
                        &folder,
                        &format!("triangulate {input} -o out.ele --overwrite"),
                    )
                    .ends(0, &["triangles   4"]);
                    let nodes = table(&folder, "out.node");
                    assert_eq!(nodes[0], [5.0, 2.0, attribute_count as f64, 1.0]);
                    for (i, point) in points.iter().enumerate() {
                        let mut expected = vec![(i + first) as f64, point[0], point[1]];
                        expected.extend((0..attribute_count).map(|k| (10 * i + k) as f64 + 0.5));
                        let given = if marker_count == 1 {
                            [-7.0, 0.0, 2.0, 0.0, 0.0][i]
                        } else {
                            0.0
                        };
                        expected.push(if given == 0.0 && i < 4 { 1.0 } else { given });
                        assert_eq!(nodes[i + 1], expected, "{input}, first number {first}");
                    }
                    let used: BTreeSet<usize> = table(&folder, "out.ele")[1..]
                        .iter()
                        .flat_map(|row| [row[1], row[2], row[3]])
                        .map(|v| v as usize)
                        .collect();
                    assert_eq!(used, (first..first + 5).collect());
                    assert!(
                        triangles(&folder, "out")
                            .iter()
                            .all(|&t| twice_area(t) > 0.0)
                    );
                    run(&folder, "check out.ele").ends(0, &["4 triangles"]);
                }
            }
        }
    }
}

#[test]
fn all_doubles_come_back() {
    let mut random = Random(3);
    let mut value = || loop {
        let x = f64::from_bits(random.bits());
        if x.is_finite() && (x == 0.0 || (1e-40..1e50).contains(&x.abs())) {
            return x;
        }
    };
    let points: Vec<[f64; 3]> = (0..200).map(|_| [value(), value(), value()]).collect();
    let rows: String = points
        .iter()
        .enumerate()
        .map(|(i, [x, y, a])| format!("{i} {x:e} {y:e} {a:e}\n"))
        .collect();
    let folder = folder_with(&[("a.node", &format!("200 2 1\n{rows}"))]);
    run(&folder, "triangulate a.node -o b.node").ends(0, &["vertices    200"]);
    for (row, point) in table(&folder, "b.node")[1..].iter().zip(points) {
        assert_eq!(
            [row[1], row[2], row[3]].map(f64::to_bits),
            point.map(f64::to_bits)
        );
    }
}

/// Two diagonals with attributes and markers, in a square.
const CROSSED: &str = "\
4 2 2 1\n0 0 0 10 1 0\n1 4 0 20 1 0\n2 4 4 30 1 0\n3 0 4 40 1 0\n\
# a comment\n6 1\n0 0 1 0\n1 1 2 0\n2 2 3 0\n3 3 0 0\n10 1 3 7\n11 0 2 8\n0\n";

#[test]
fn crossings_are_split_or_rejected() {
    let folder = folder_with(&[("x.poly", CROSSED)]);
    run(&folder, "triangulate x.poly -o y.ele -o y.edge")
        .ends(0, &["5 (4 in, 1 added where", "6 in, 8 constrained"]);
    let nodes = table(&folder, "y.node");
    // On the first segment through it: halfway from vertex 1 to vertex 3, and its marker.
    assert_eq!(nodes[5], [4.0, 2.0, 2.0, 30.0, 1.0, 7.0]);
    assert_eq!(
        nodes[1..5].iter().map(|row| row[5]).collect::<Vec<_>>(),
        [8.0, 7.0, 8.0, 7.0]
    );
    let edges = table(&folder, "y.edge");
    let markers = |end: f64| {
        edges[1..]
            .iter()
            .filter(|row| row[1..3].contains(&4.0) && row[1..3].contains(&end))
            .map(|row| row[3])
            .next()
    };
    assert_eq!(
        [0.0, 1.0, 2.0, 3.0].map(markers),
        [Some(8.0), Some(7.0), Some(8.0), Some(7.0)]
    );
    run(&folder, "check y.ele").ends(0, &["8 constrained edges: no flaw found"]);

    let run = run(
        &folder,
        "triangulate x.poly -o z.ele -o z.off --on-crossing reject",
    );
    run.ends(
        1,
        &[
            "error: x.poly: lines 12 and 13: segments 10 and 11 cross at 2.0 2.0",
            "hint: ",
            "--on-crossing split",
        ],
    );
    assert_eq!(
        files_of(folder.path()),
        ["x.poly", "y.edge", "y.ele", "y.node", "y.poly"]
    );
}

#[test]
fn contacts_are_no_crossings() {
    // A T, an overlap, a repetition, a segment through a vertex, one without length.
    let text = "6 2\n1 0 0\n2 8 0\n3 4 6\n4 4 0\n5 2 0\n6 6 0\n\
                8\n1 1 2\n2 2 3\n3 3 1\n4 3 4\n5 1 6\n6 2 1\n7 5 2\n8 3 3\n0\n";
    let folder = folder_with(&[("t.poly", text)]);
    run(
        &folder,
        "triangulate t.poly -o t.1.ele --on-crossing reject",
    )
    .ends(0, &["6 in, 0 added", "8 in, 7 constrained"]);
    run(&folder, "check t.1.ele").ends(0, &["no flaw found"]);
}

#[test]
fn the_first_of_two_at_one_place_stands() {
    let text = "6 2\n1 0 0\n2 4 0\n3 4 0\n4 4 4\n5 0 4\n6 -0.0 0\n5\n1 6 3\n2 3 4\n3 4 5\n4 5 1\n5 2 3\n0\n";
    let folder = folder_with(&[("d.poly", text)]);
    run(&folder, "triangulate d.poly -o d.1.ele").ends(
        0,
        &["2 at the position of an earlier one, without a triangle"],
    );
    let nodes = table(&folder, "d.1.node");
    assert_eq!((nodes[0][0], nodes[6][1].is_sign_negative()), (6.0, true));
    let used: BTreeSet<i32> = table(&folder, "d.1.ele")[1..]
        .iter()
        .flat_map(|row| [row[1], row[2], row[3]])
        .map(|v| v as i32)
        .collect();
    assert_eq!(used, [1, 2, 4, 5].into());
    run(&folder, "check d.1.ele").ends(
        0,
        &["4 vertices, 2 triangles, 4 constrained edges: no flaw found"],
    );
}

#[test]
fn concavities_are_eaten_away_unless_the_hull_is_kept() {
    // A V, and the same with a hole where its left arm is.
    let v = "5 2\n0 0 0\n1 2 4\n2 1 4\n3 0 2\n4 -1 4\n5\n0 0 1\n1 1 2\n2 2 3\n3 3 4\n4 4 0\n";
    let folder = folder_with(&[
        ("v.poly", &format!("{v}0\n")),
        ("h.poly", &format!("{v}1\n0 -0.6 3\n")),
    ]);
    let area = |args: &str| {
        run(
            &folder,
            &format!("triangulate {args} -o out.ele --overwrite"),
        )
        .ends(0, &[]);
        run(&folder, "check out.ele").ends(0, &["no flaw"]);
        triangles(&folder, "out")
            .into_iter()
            .map(twice_area)
            .sum::<f64>()
    };
    assert_eq!([area("v.poly"), area("v.poly --convex")], [8.0, 12.0]);
    // The hole is bounded by the V's own sides: all of the V goes.
    run(&folder, "triangulate h.poly -o o.ele")
        .ends(1, &["h.poly: no triangle is left", "hint: close the outer"]);
    assert_eq!(area("h.poly --convex"), 4.0);
    let open = format!("{}0\n", v.replace("\n5\n", "\n4\n").replace("4 4 0\n", ""));
    std::fs::write(folder.path().join("open.poly"), open).unwrap();
    run(&folder, "triangulate open.poly -o o.ele")
        .ends(1, &["open.poly: no triangle is left", "--convex"]);
    assert_eq!(area("open.poly --convex"), 12.0);
    assert!(!folder.path().join("o.ele").exists());
}

#[test]
fn regions_give_their_attribute_to_triangles() {
    let halves = "6 2\n1 0 0\n2 2 0\n3 4 0\n4 4 4\n5 2 4\n6 0 4\n\
                  7\n1 1 2\n2 2 3\n3 3 4\n4 4 5\n5 5 6\n6 6 1\n7 2 5\n0\n2\n1 1 1 2.5 0.1\n2 2 2 9\n";
    let folder = folder_with(&[("r.poly", halves)]);
    let said = [
        "line 19: the region lies on a segment",
        "the largest areas of its regions are ignored",
    ];
    run(&folder, "triangulate r.poly -o r.1.ele").ends(0, &said);
    let elements = table(&folder, "r.1.ele");
    assert_eq!(elements[0], [4.0, 3.0, 1.0]);
    for (row, corners) in elements[1..].iter().zip(triangles(&folder, "r.1")) {
        let is_left = corners.iter().all(|p| p[0] <= 2.0);
        assert_eq!(row[4], if is_left { 2.5 } else { 0.0 });
    }
    let poly = table(&folder, "r.1.poly");
    assert_eq!(
        poly[poly.len() - 3..],
        [
            vec![2.0],
            vec![1.0, 1.0, 1.0, 2.5, 0.1],
            vec![2.0, 2.0, 2.0, 9.0, 9.0]
        ]
    );
}

#[test]
fn points_that_span_no_area_have_no_triangle() {
    let on_line = "4 2\n0 0 0\n1 3 3\n2 1 1\n3 2 2\n";
    let folder = folder_with(&[
        ("line.node", on_line),
        ("line.poly", &format!("{on_line}1 1\n0 0 1 5\n0\n")),
        ("one.node", "1 2\n1 5 5\n"),
        ("none.node", "0 2 0 0\n"),
    ]);
    for (input, count) in [
        ("line.node", 4.0),
        ("line.poly", 4.0),
        ("one.node", 1.0),
        ("none.node", 0.0),
    ] {
        let outputs = "-o out.ele -o out.poly -o out.neigh -o out.edge";
        run(
            &folder,
            &format!("triangulate {input} {outputs} --overwrite"),
        )
        .ends(0, &["there is no triangle"]);
        // A mesh of none is of no use to anyone.
        for mesh in ["none.ply", "none.obj", "none.off"] {
            run(
                &folder,
                &format!("triangulate {input} -o {mesh} -o {mesh}.ele"),
            )
            .ends(
                1,
                &[
                    &format!("error: {mesh}: "),
                    "no triangle to write",
                    "hint: ",
                ],
            );
            assert!(
                !folder.path().join(mesh).exists()
                    && !folder.path().join(format!("{mesh}.ele")).exists()
            );
        }
        assert_eq!(table(&folder, "out.node")[0][0], count);
        assert_eq!(table(&folder, "out.ele"), [[0.0, 3.0, 0.0]]);
        run(&folder, "check out.ele").ends(0, &["0 triangles"]);
        // The segment is there, in pieces.
        let poly = table(&folder, "out.poly");
        match input {
            "line.poly" => assert_eq!(
                poly[2..5],
                [
                    [0.0, 0.0, 2.0, 5.0],
                    [1.0, 2.0, 3.0, 5.0],
                    [2.0, 3.0, 1.0, 5.0]
                ]
            ),
            _ => assert_eq!(poly[1], [0.0, 1.0]),
        }
    }
}

#[test]
fn every_finite_coordinate_is_taken_by_what_is_exact() {
    let folder = folder_with(&[
        (
            "big.node",
            "4 2\n1 0 0\n2 1e300 0\n3 1.5e300 1.25e300\n4 0 1.7e308\n",
        ),
        (
            "small.node",
            "4 2\n1 0 0\n2 1e-310 0\n3 1.5e-310 1.25e-310\n4 0 5e-324\n",
        ),
        ("plain.node", "4 2\n1 0 0\n2 4 0\n3 3 4\n4 1 5\n"),
    ]);
    for input in ["big.node", "small.node", "plain.node"] {
        for kernel in ["exact", "adaptive"] {
            run(
                &folder,
                &format!("triangulate {input} -o out.ele --kernel {kernel} --overwrite"),
            )
            .ends(0, &["triangles   2"]);
        }
    }
    run(
        &folder,
        "triangulate plain.node -o out.ele --kernel fast --overwrite",
    )
    .ends(0, &["triangles   2"]);
    let said = [
        "error: big.node: line 3: vertex 2 is at 1e300 0.0, expected coordinates of 0 or between",
        "hint: ",
    ];
    run(&folder, "triangulate big.node -o fast.ele --kernel fast").ends(1, &said);
}

#[test]
fn meshes_are_written_too() {
    let folder = folder_with(&[("box.poly", BOX)]);
    run(&folder, "triangulate box.poly -o b.off -o b.obj -o b.ply")
        .ends(0, &["written     b.off", "written     b.ply"]);
    for (name, edges) in [("b.off", 0), ("b.obj", 0), ("b.ply", 8)] {
        let count = format!("8 vertices, 8 triangles, {edges} constrained edges");
        // Without constraints it is not Delaunay everywhere, or it happens to be: here it is.
        run(&folder, &format!("check {name}")).ends(0, &[&count]);
    }
    run(&folder, "tin b.off -o c.off").ends(0, &["triangles   8"]);
    run(&folder, "info b.off").ends(0, &["TIN, OFF", "vertices   8"]);
}

#[test]
fn nothing_is_replaced_unasked() {
    let folder = folder_with(&[("box.poly", BOX), ("a.node", "mine")]);
    run(&folder, "triangulate box.poly -o a.ele")
        .ends(1, &["error: a.node: the file exists", "--overwrite"]);
    run(&folder, "triangulate box.poly -o box.ele")
        .ends(2, &["box.poly: the output is one of the inputs"]);
    run(&folder, "triangulate box.poly -o b.dwg").ends(
        2,
        &["not a format that can be written", ".ele, .node, .poly"],
    );
    run(&folder, "triangulate box.txt -o b.ele").ends(1, &["box.txt: no such file"]);
    std::fs::write(folder.path().join("box.txt"), BOX).unwrap();
    run(&folder, "triangulate box.txt -o b.ele").ends(
        2,
        &["not that of a file of Triangle", "hint: use .node or .poly"],
    );
    run(&folder, "triangulate box.poly -o none/b.ele").ends(1, &["the folder does not exist"]);
    assert_eq!(
        std::fs::read_to_string(folder.path().join("a.node")).unwrap(),
        "mine"
    );
    assert_eq!(files_of(folder.path()), ["a.node", "box.poly", "box.txt"]);
}

/// Small grids, where ties, contacts and crossings are the rule: valid by `check`, of the right
/// area, and every segment covered by its pieces (where none is rounded).
#[test]
fn random_grids() {
    let mut random = Random(11);
    let mut crossed = 0;
    for case in 0..80 {
        let size = 2 + random.below(5);
        let count = 3 + random.index(20);
        let first = random.index(2);
        let points: Vec<[f64; 2]> = (0..count)
            .map(|_| [random.below(size + 1) as f64, random.below(size + 1) as f64])
            .collect();
        let rows: String = points
            .iter()
            .enumerate()
            .map(|(i, [x, y])| format!("{} {x} {y}\n", i + first))
            .collect();
        let segment_count = random.index(12);
        let segments: String = (0..segment_count)
            .map(|i| {
                format!(
                    "{i} {} {}\n",
                    random.index(count) + first,
                    random.index(count) + first
                )
            })
            .collect();
        let text = format!("{count} 2\n{rows}{segment_count}\n{segments}0\n");
        let folder = folder_with(&[("g.poly", &text)]);
        run(
            &folder,
            "triangulate g.poly -o g.1.ele -o g.1.neigh --convex -q",
        )
        .ends(0, &[]);
        let sum: f64 = triangles(&folder, "g.1").into_iter().map(twice_area).sum();
        let area = hull_area(points);
        assert!(
            (sum - area).abs() < 1e-9,
            "case {case}: {sum} is not {area}\n{text}"
        );
        if area > 0.0 {
            run(&folder, "check g.1.ele").ends(0, &["no flaw found"]);
        }
        let nodes = table(&folder, "g.1.node");
        if nodes.len() - 1 > count {
            crossed += 1;
            continue;
        }
        let site = |number: f64| {
            [
                nodes[1 + number as usize - first][1],
                nodes[1 + number as usize - first][2],
            ]
        };
        let poly = table(&folder, "g.1.poly");
        let parts: Vec<[[f64; 2]; 2]> = poly[2..2 + poly[1][0] as usize]
            .iter()
            .map(|row| [site(row[1]), site(row[2])])
            .collect();
        for row in segments.lines() {
            let words: Vec<f64> = row.split(' ').map(|word| word.parse().unwrap()).collect();
            let [a, b] = [site(words[1]), site(words[2])];
            let length = |[p, q]: [[f64; 2]; 2]| (p[0] - q[0]).abs() + (p[1] - q[1]).abs();
            let is_on = |p: &[f64; 2]| {
                twice_area([a, b, *p]) == 0.0 && length([a, *p]) + length([*p, b]) == length([a, b])
            };
            let covered: f64 = parts
                .iter()
                .filter(|part| part.iter().all(is_on))
                .map(|&part| length(part))
                .sum();
            assert_eq!(
                covered,
                if a == b { 0.0 } else { length([a, b]) },
                "case {case}: {a:?} {b:?}\n{text}"
            );
        }
    }
    assert!(
        (10..70).contains(&crossed),
        "{crossed} of 80 have crossings"
    );
}

/// Twice the area of the convex hull (Andrew's monotone chain, 1979).
fn hull_area(mut points: Vec<[f64; 2]>) -> f64 {
    points.sort_by(|p, q| p.partial_cmp(q).unwrap());
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1
                && twice_area([chain[chain.len() - 2], chain[chain.len() - 1], p]) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let lower = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    let ring = [lower, upper].concat();
    (1..ring.len().saturating_sub(1))
        .map(|i| twice_area([ring[0], ring[i], ring[i + 1]]))
        .sum()
}

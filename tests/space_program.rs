//! Points in space through the program as it is run: tetrahedra, alpha shapes, and their check.

#[path = "common/program.rs"]
mod program;

use program::{Run, folder_with, run_in};
use tempfile::TempDir;

fn run(folder: &TempDir, args: &str) -> Run {
    run_in(folder, &args.split(' ').collect::<Vec<_>>())
}

/// The numbers of a file of TetGen, line by line.
fn table(folder: &TempDir, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    rows.map(|line| {
        line.split_whitespace()
            .map(|word| word.parse().unwrap())
            .collect()
    })
    .collect()
}

/// A cube with its center, numbered from 1, with an attribute and a marker.
const CUBE: &str = "\
9 3 1 1
1 0 0 0  7 0
2 1 0 0  7 0
3 0 1 0  7 0
4 1 1 0  7 5
5 0 0 1  7 0
6 1 0 1  7 0
7 0 1 1  7 0
8 1 1 1  7 0
9 0.5 0.5 0.5  9 0
";

#[test]
fn a_cube_in_all_files_of_tetgen() {
    let folder = folder_with(&[("cube.node", CUBE)]);
    let all = "-o c.ele -o c.face -o c.edge -o c.neigh -o c.mesh -o c.vtu";
    run(&folder, &format!("triangulate cube.node {all}")).works(&[
        "dimension   3",
        "tetrahedra  12",
        "volume      1\n",
    ]);
    let nodes = table(&folder, "c.node");
    assert_eq!(nodes[0], [9.0, 3.0, 1.0, 1.0]);
    assert_eq!(nodes[4], [4.0, 1.0, 1.0, 0.0, 7.0, 5.0], "a marker stays");
    assert_eq!(
        (nodes[1][5], nodes[9][5]),
        (1.0, 0.0),
        "1 on the hull, 0 within"
    );
    let cells = table(&folder, "c.ele");
    assert_eq!(cells[0], [12.0, 4.0, 0.0]);
    let site = |number: f64| [1, 2, 3].map(|k| nodes[number as usize][k]);
    for cell in &cells[1..] {
        let [a, b, c, d] = [1, 2, 3, 4].map(|k| site(cell[k]));
        let [u, v, w] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        let cross = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        assert_eq!(
            (cross[0] * w[0] + cross[1] * w[1] + cross[2] * w[2]) / 6.0,
            1.0 / 12.0
        );
        assert!(cell[1..].contains(&9.0));
    }
    let faces = table(&folder, "c.face");
    assert_eq!((faces.len(), &faces[0][..]), (13, &[12.0, 1.0][..]));
    assert!(
        faces[1..]
            .iter()
            .all(|face| face[4] == 1.0 && !face[1..4].contains(&9.0))
    );
    let edges = table(&folder, "c.edge");
    // Euler: 9 vertices, 12 cells, 12 + (4 * 12 - 12) / 2 facets.
    assert_eq!(edges.len() - 1, 9 + 12 + (4 * 12 - 12) / 2 - 12 - 1);
    assert_eq!(
        edges[1..].iter().filter(|edge| edge[3] == 0.0).count(),
        8,
        "those of the center"
    );
    let neighbors = table(&folder, "c.neigh");
    for (cell, around) in cells[1..].iter().zip(&neighbors[1..]) {
        for i in 1..5 {
            assert_eq!(
                around[i] == -1.0,
                cell[i] == 9.0,
                "opposite the center is the hull"
            );
        }
    }
    let mesh = std::fs::read_to_string(folder.path().join("c.mesh")).unwrap();
    assert!(
        mesh.contains("\nTetrahedra\n12\n")
            && mesh.contains("\nTriangles\n12\n")
            && mesh.ends_with("End\n")
    );
    let vtu = std::fs::read(folder.path().join("c.vtu")).unwrap();
    let text = String::from_utf8_lossy(&vtu);
    assert!(text.contains("NumberOfPoints=\"9\" NumberOfCells=\"12\""));
    let start = vtu.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
    assert_eq!(vtu[start..start + 8], (9u64 * 24).to_le_bytes());
    let types = start + 8 + 9 * 24 + 8 + 12 * 32 + 8 + 12 * 8 + 8;
    assert_eq!(vtu[types..types + 12], [10; 12]);
    run(&folder, "check c.ele").ends(0, &["9 vertices, 12 tetrahedra: no flaw found"]);
}

#[test]
fn check_finds_what_is_wrong() {
    let folder = folder_with(&[("cube.node", CUBE)]);
    run(&folder, "triangulate cube.node -o c.ele -o c.neigh").works(&[]);
    let path = folder.path().join("c.ele");
    let whole = std::fs::read_to_string(&path).unwrap();
    let mut lines: Vec<&str> = whole.lines().collect();
    lines[0] = "11 4 0";
    lines.remove(12);
    std::fs::write(&path, lines.join("\n")).unwrap();
    run(&folder, "check c.ele").fails(1, &["c.neigh", "12 tetrahedra, but the .ele file has 11"]);
    std::fs::remove_file(folder.path().join("c.neigh")).unwrap();
    run(&folder, "check c.ele").ends(1, &["the hull is not convex there"]);
    // A flat one, two on the same side, and one across the center.
    for (cell, said) in [
        ("1 2 3 4", "lie in a plane"),
        ("1 2 3 9", "same side"),
        ("1 2 3 99", "vertices are numbered 1 to 9"),
    ] {
        std::fs::write(&path, format!("2 4 0\n1 1 2 3 5\n2 {cell}\n")).unwrap();
        run(&folder, "check c.ele").ends(1, &[said]);
    }
    let five = "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0.6 0.6 0.6\n";
    std::fs::write(folder.path().join("c.node"), five).unwrap();
    std::fs::write(&path, "2 4 0\n0 0 1 2 3\n1 1 2 3 4\n").unwrap();
    run(&folder, "check c.ele").ends(1, &["vertex 4 is inside of its sphere"]);
}

#[test]
fn weights_hide_points() {
    let nine = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n0.5 0.5 0.5\n";
    let folder = folder_with(&[
        ("p.xyz", nine),
        ("p.weights", "0\n0\n0\n0\n0\n0\n0\n0\n-1\n"),
        ("q.xyz", nine),
    ]);
    run(&folder, "triangulate --3d p.xyz --weighted -o p.ele")
        .works(&["1 hidden", "volume      1\n"]);
    run(&folder, "check p.ele --weighted").ends(0, &["9 vertices, 6 tetrahedra: no flaw found"]);
    assert_eq!(
        table(&folder, "p.node")[0],
        [9.0, 3.0, 1.0, 1.0],
        "weights are an attribute"
    );
    run(&folder, "check p.ele").ends(
        1,
        &[
            "vertex 8: it is in no tetrahedron, but should be",
            ": 1 flaw\n",
        ],
    );
    run(&folder, "triangulate --3d q.xyz --weighted -o q.ele").fails(
        1,
        &[
            "3 fields separated by blanks, expected at least 4",
            "q.weights",
        ],
    );
    std::fs::write(folder.path().join("q.weights"), "1\n2\n").unwrap();
    run(&folder, "triangulate --3d q.xyz --weighted -o q.ele")
        .fails(1, &["q.weights", "weight 3 of 9"]);
    assert!(!folder.path().join("q.ele").exists());
}

#[test]
fn weights_of_a_column() {
    let lines =
        |weight: &str| format!("0 0 0 0\n4 0 0 0\n0 4 0 0\n0 0 4 0\n1 1 1 {weight}\n9 9 9 0\n");
    let header = "x;y;z;class;weight\n".to_owned()
        + &lines("-12")
            .replace(' ', ";")
            .replace(";0\n", ";2;0\n")
            .replace(";-12", ";2;-12");
    let folder = folder_with(&[
        ("p.xyz", &lines("0.5")),
        ("q.xyz", &lines("-12")),
        ("r.csv", &header),
    ]);
    run(&folder, "triangulate --3d p.xyz --weighted -o p.ele").works(&["tetrahedra  6\n"]);
    for (file, name) in [("q.xyz", "q"), ("r.csv", "r")] {
        run(
            &folder,
            &format!("triangulate --3d {file} --weighted -o {name}.ele"),
        )
        .works(&["1 hidden"]);
        run(&folder, &format!("check {name}.ele --weighted")).ends(0, &["no flaw found"]);
        assert_eq!(table(&folder, &format!("{name}.node"))[5][4], -12.0);
    }
    run(
        &folder,
        "triangulate --3d q.xyz --weighted -o q.xyz.mesh --kernel fast",
    )
    .fails(2, &["--kernel fast"]);
    run(&folder, "check p.xyz --weighted").fails(2, &["--weighted is for the tetrahedra"]);
}

/// Point clouds in the formats of meshes, which have no faces.
#[test]
fn clouds_without_faces() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let off = "OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let folder = folder_with(&[("c.ply", ply), ("c.off", off), ("c.obj", obj)]);
    for extension in ["ply", "off", "obj"] {
        run(
            &folder,
            &format!("triangulate --3d c.{extension} -o {extension}.ele"),
        )
        .works(&["tetrahedra  1\n"]);
        run(&folder, &format!("check c.{extension}"))
            .fails(1, &["there are no faces", "triangulate --3d"]);
    }
}

#[test]
fn check_finds_vertices_that_were_left_out() {
    let five = "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0.2 0.2 0.2\n";
    let folder = folder_with(&[
        ("c.node", five),
        ("c.ele", "1 4 0\n0 0 1 2 3\n"),
        ("d.ele", "0 4 0\n"),
    ]);
    run(&folder, "check c.ele").ends(1, &["vertex 4: it is in no tetrahedron, but should be"]);
    std::fs::write(
        folder.path().join("c.node"),
        five.replace("0.2 0.2 0.2", "1 0 0"),
    )
    .unwrap();
    run(&folder, "check c.ele").ends(0, &["no flaw found"]);
    std::fs::write(
        folder.path().join("c.node"),
        five.replace("0.2 0.2 0.2", "9 0 0"),
    )
    .unwrap();
    run(&folder, "check c.ele").ends(1, &["vertex 4"]);
    std::fs::write(folder.path().join("d.node"), five).unwrap();
    run(&folder, "check d.ele").ends(
        1,
        &["there are no tetrahedra, but the vertices are not in one plane"],
    );
}

#[test]
fn alpha_shapes_are_meshes() {
    let mut text = String::new();
    // Two cubes of 3 x 3 x 3 points, far apart.
    for k in 0..54 {
        let (i, cube) = (k % 27, k / 27);
        text += &format!("{} {} {}\n", i % 3 + 100 * cube, i / 3 % 3, i / 9);
    }
    let folder = folder_with(&[("p.xyz", &text)]);
    run(
        &folder,
        "triangulate --3d p.xyz --alpha 0.75 -o a.ply -o a.stl",
    )
    .works(&["alpha       0.75: volume 16, 2 parts, 96 triangles"]);
    run(&folder, "info a.ply").ends(0, &["96"]);
    run(&folder, "triangulate --3d p.xyz --alpha auto -o b.obj").works(&["1 part"]);
    run(&folder, "triangulate --3d p.xyz -o c.ply").fails(2, &["add --alpha auto"]);
    run(&folder, "triangulate --3d p.xyz --alpha auto -o c.ele")
        .fails(2, &["no output is for the alpha shape"]);
    run(&folder, "triangulate --3d p.xyz --alpha -1 -o c.ply").ends(2, &["auto"]);
    run(&folder, "triangulate --3d p.xyz --convex -o c.ele")
        .fails(2, &["--convex is for the plane only"]);
}

#[test]
fn what_is_flat_has_no_tetrahedra() {
    let folder = folder_with(&[("p.xyz", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n1 1 1\n")]);
    run(&folder, "triangulate --3d p.xyz -o p.ele").works(&[
        "1 at the position of another one",
        "dimension   2",
        "tetrahedra  0",
        "there is no tetrahedron",
    ]);
    run(&folder, "check p.ele").ends(0, &["5 vertices, 0 tetrahedra: no flaw found"]);
    run(&folder, "triangulate --3d p.xyz --alpha auto -o p.ply").fails(1, &["no solid to write"]);
}

#[test]
fn damaged_nodes_are_errors_with_a_line() {
    let folder = folder_with(&[
        ("a.node", "2 3 0 0\n0 0 0 0\n1 1 0\n"),
        ("b.node", "2 2\n0 0 0\n1 1 0\n"),
    ]);
    run(&folder, "triangulate a.node -o a.1.ele").fails(1, &["a.node", "line 3", "z coordinate"]);
    run(&folder, "triangulate --3d b.node -o b.1.ele")
        .fails(1, &["b.node", "line 1", "the dimension is 2, expected 3"]);
}

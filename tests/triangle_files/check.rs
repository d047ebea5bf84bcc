use crate::{folder_with, run};

/// Five places: the corners of a square and one beyond.
const NODE: &str = "6 2\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 9 2\n6 3 2\n";

/// What `check` says of triangles given by numbers from 1.
#[track_caller]
fn says(ele: &str, beside: &[(&str, &str)], code: i32, said: &[&str]) {
    let count = ele.lines().count();
    let rows: String = ele
        .lines()
        .enumerate()
        .map(|(i, line)| format!("{} {line}\n", i + 1))
        .collect();
    let ele = format!("{count} 3\n{rows}");
    let folder = folder_with(&[&[("a.node", NODE), ("a.ele", &ele)], beside].concat());
    let run = run(&folder, "check a.ele");
    run.ends(code, said);
    assert!(
        !run.stderr.contains("error: "),
        "flaws are no errors: {}",
        run.stderr
    );
}

#[test]
fn sound_triangles_have_no_flaw() {
    says(
        "1 2 3\n1 3 4",
        &[],
        0,
        &["4 vertices, 2 triangles, 0 constrained edges: no flaw found"],
    );
    // Clockwise as a whole.
    says(
        "1 3 2\n1 4 3",
        &[("a.neigh", "2 3\n1 -1 -1 2\n2 -1 1 -1\n")],
        0,
        &["no flaw found"],
    );
    says("1 2 3\n1 3 4\n2 5 3", &[], 0, &["no flaw found"]);
}

#[test]
fn each_kind_of_flaw_is_listed() {
    let folded = "faces 0 and 1: both pass their edge";
    says("1 2 3\n1 2 4", &[], 1, &[folded, "1 flaw"]);
    says("1 2 3\n2 3 1", &[], 1, &[folded, "3 flaws"]);
    // One of two is turned around.
    says(
        "1 2 3\n1 4 3",
        &[],
        1,
        &[
            "in the same direction",
            "face 1: no area in plan, or clockwise",
        ],
    );
    says("1 2 3\n1 3 3", &[], 1, &["face 1: no area in plan"]);
    // Overlap without an edge in common.
    says(
        "1 2 3\n4 6 5",
        &[],
        1,
        &["face 1, edge 0: meets the border of other faces between its ends"],
    );
    // All six, and none in a circle.
    says(
        "2 3 6\n2 5 3\n1 2 6\n1 6 4\n6 3 4",
        &[],
        0,
        &["no flaw found"],
    );
    says(
        "1 2 3\n1 3 6",
        &[],
        1,
        &["face 1: no area in plan, or clockwise", "1 flaw"],
    );
    says(
        "1 2 3\n1 3 4",
        &[("a.neigh", "2 3\n1 -1 -1 -1\n2 -1 -1 1\n")],
        1,
        &["face 0, edge 1: its neighbor is stated as none, by its edges it is 1"],
    );
    says(
        "1 2 3\n1 3 4",
        &[("a.poly", "0 2\n1\n1 2 4\n0\n")],
        1,
        &["the constrained edge 1 3 is not an edge of any face"],
    );
}

#[test]
fn constraints_stand_between_a_face_and_the_vertex_beyond() {
    let node = "4 2\n1 0 0\n2 8 0\n3 4 1\n4 4 -1\n";
    let ele = "2 3\n1 1 2 3\n2 1 4 2\n";
    let with_vertices = format!("{node}1\n1 1 2\n0\n");
    for (beside, holds) in [
        (None, false),
        (Some(("a.poly", "0 2 0 1\n1 1\n1 2 1 0\n0\n")), true),
        (Some(("a.edge", "1 1\n1 1 2 7\n")), true),
        (Some(("a.edge", "1 1\n1 1 2 0\n")), false),
        // This .poly is about its own vertices.
        (Some(("a.poly", &with_vertices)), false),
    ] {
        let mut files = vec![("a.node", node), ("a.ele", ele)];
        files.extend(beside);
        let run = run(&folder_with(&files), "check a.ele");
        match holds {
            true => run.ends(0, &["1 constrained edges: no flaw found"]),
            false => run.ends(1, &["the vertex beyond lies in the circumcircle", "1 flaw"]),
        }
    }
}

#[test]
fn meshes_that_are_no_surface_are_listed_and_told_by_info() {
    let off = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 1 3\n";
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 nan\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
               element face 2\nproperty list uchar int vertex_indices\nelement constrained_edge 1\nproperty int vertex1\n\
               property int vertex2\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n1 3\n";
    let folder = folder_with(&[("a.off", off), ("b.obj", obj), ("c.ply", ply)]);
    let folded = "faces 0 and 1: both pass their edge 0 1 in the same direction";
    run(&folder, "check a.off").ends(
        1,
        &[
            folded,
            "4 vertices, 2 triangles, 0 constrained edges: 1 flaw",
        ],
    );
    run(&folder, "check b.obj").ends(1, &["vertex 2: a coordinate is not finite"]);
    run(&folder, "check c.ply").ends(1, &["the constrained edge 1 3 is not an edge of any face"]);
    run(&folder, "info a.off").ends(
        0,
        &[
            "triangles  2",
            "warning: a.off: this is not a surface: ",
            folded,
        ],
    );
    // Other verbs refuse it, with the same words.
    run(&folder, "dem a.off -o d.tif").ends(1, &["error: a.off: ", folded]);
}

//! Random meshes with one flaw each, which `check` finds, and sound ones, in which it finds none.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use breakline::data::{EdgeKind, Mesh, Triangles};
use breakline::io::mesh;
use breakline::run::{self, Context, FlawKind, LocatedFlaw, Source, SurfaceRequest};
use breakline::terrain::{SurfaceFlaw, TinBuilder};
use testkit::random::Random;

/// Returns true if flaws are those that are to be found.
type Verdict = Box<dyn Fn(&[LocatedFlaw]) -> bool>;

/// A sound mesh with breaklines: the triangulation of random points on a coarse grid.
fn sound(random: &mut Random) -> Triangles {
    let mut builder = TinBuilder::default();
    let at = |random: &mut Random| {
        [
            random.around(12) as f64,
            random.around(12) as f64,
            random.around(50) as f64 / 4.0,
        ]
    };
    let points: Vec<[f64; 3]> = (0..12 + random.index(40)).map(|_| at(random)).collect();
    let axis = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
    builder.add_points(&axis(0), &axis(1), &axis(2));
    for _ in 0..random.index(3) {
        builder.add_breakline(&[at(random), at(random), at(random)]);
    }
    mesh::list(&builder.build().unwrap()).unwrap()
}

fn check(path: &Path) -> breakline::Result<Vec<LocatedFlaw>> {
    let source = Source::Mesh(path.to_path_buf());
    run::check(
        &SurfaceRequest {
            source,
            ..SurfaceRequest::default()
        },
        &Context::default(),
    )
    .map(|found| found.flaws)
}

/// Writes triangles as they are, whatever is wrong with them, in the format of an extension.
fn write(folder: &Path, extension: &str, triangles: &Triangles) -> PathBuf {
    let path = folder.join(format!("mesh.{extension}"));
    let Triangles {
        vertices,
        faces,
        sides,
        ..
    } = triangles;
    let mut text = String::new();
    let row = |start: &str, values: &[String]| format!("{start}{}\n", values.join(" "));
    let corners = |face: &[u32; 3], first: u32| face.map(|v| (v + first).to_string());
    match extension {
        "obj" => {
            vertices
                .iter()
                .for_each(|p| text += &row("v ", &p.map(|c| c.to_string())));
            faces
                .iter()
                .for_each(|face| text += &row("f ", &corners(face, 1)));
        }
        "off" => {
            text = format!("OFF\n{} {} 0\n", vertices.len(), faces.len());
            vertices
                .iter()
                .for_each(|p| text += &row("", &p.map(|c| c.to_string())));
            faces
                .iter()
                .for_each(|face| text += &row("3 ", &corners(face, 0)));
        }
        _ => {
            text = format!(
                "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
                 element face {}\nproperty list uchar int vertex_indices\nproperty uchar edge1\nproperty uchar edge2\n\
                 property uchar edge3\nproperty uchar piece\nend_header\n",
                vertices.len(),
                faces.len()
            );
            vertices
                .iter()
                .for_each(|p| text += &row("", &p.map(|c| c.to_string())));
            for (face, [a, b, c]) in faces.iter().zip(sides.as_ref().unwrap()) {
                let kinds = [c, a, b].map(|kind| kind.number().to_string());
                text += &row(
                    "3 ",
                    &[&corners(face, 0)[..], &kinds, &["0".to_owned()]].concat(),
                );
            }
        }
    }
    std::fs::write(&path, text).unwrap();
    path
}

/// The kinds of the sides of each face, by the edges on lines.
fn add_sides(triangles: &mut Triangles) {
    let kinds: HashMap<[u32; 2], EdgeKind> = triangles
        .lines
        .iter()
        .map(|&([a, b], kind)| ([a.min(b), a.max(b)], kind))
        .collect();
    let side = |a: u32, b: u32| {
        kinds
            .get(&[a.min(b), a.max(b)])
            .copied()
            .unwrap_or_default()
    };
    let sides = triangles
        .faces
        .iter()
        .map(|&[a, b, c]| [side(b, c), side(c, a), side(a, b)])
        .collect();
    triangles.sides = Some(sides);
}

/// The number of edges that two faces share, and one of them with its faces and their corners.
fn shared(triangles: &Triangles) -> Vec<([usize; 2], [usize; 2])> {
    let mut seen: HashMap<[u32; 2], (usize, usize)> = HashMap::new();
    let mut found = Vec::new();
    for (f, face) in triangles.faces.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (face[(i + 1) % 3], face[(i + 2) % 3]);
            if let Some((g, j)) = seen.insert([a.min(b), a.max(b)], (f, i)) {
                found.push(([g, f], [j, i]));
            }
        }
    }
    found
}

/// Splits a mesh along a vertical line into two that share no vertex, and lifts some vertices of
/// the eastern one. Returns the number of edges that are cracks then, and of vertices with two
/// heights that are at no crack; `None` if all faces are on one side.
fn split(triangles: &mut Triangles, random: &mut Random) -> Option<(usize, usize)> {
    let middle = random.around(8) as f64 + 0.25;
    let is_east = |face: &[u32; 3]| {
        face.iter()
            .map(|&v| triangles.vertices[v as usize][0])
            .sum::<f64>()
            > 3.0 * middle
    };
    let east: Vec<bool> = triangles.faces.iter().map(is_east).collect();
    let of = |wanted: bool| -> HashSet<u32> {
        triangles
            .faces
            .iter()
            .zip(&east)
            .filter(|(_, east)| **east == wanted)
            .flat_map(|(face, _)| *face)
            .collect()
    };
    let both: Vec<u32> = of(true).intersection(&of(false)).copied().collect();
    if both.is_empty() {
        return None;
    }
    let mut lifted: HashSet<u32> = both
        .iter()
        .copied()
        .filter(|_| random.below(2) == 0)
        .collect();
    lifted.insert(both[random.index(both.len())]);
    let cracks: Vec<[u32; 2]> = shared(triangles)
        .into_iter()
        .filter(|&([f, g], _)| east[f] != east[g])
        .map(|([f, _], [i, _])| {
            [
                triangles.faces[f][(i + 1) % 3],
                triangles.faces[f][(i + 2) % 3],
            ]
        })
        .filter(|edge| edge.iter().any(|v| lifted.contains(v)))
        .collect();
    let alone = lifted
        .iter()
        .filter(|v| !cracks.iter().flatten().any(|end| end == *v))
        .count();
    let copies: HashMap<u32, u32> = both
        .iter()
        .zip(triangles.vertices.len() as u32..)
        .map(|(&v, copy)| (v, copy))
        .collect();
    for &v in &both {
        let mut copy = triangles.vertices[v as usize];
        copy[2] += if lifted.contains(&v) { 100.0 } else { 0.0 };
        triangles.vertices.push(copy);
    }
    for (face, _) in triangles
        .faces
        .iter_mut()
        .zip(&east)
        .filter(|(_, east)| **east)
    {
        *face = face.map(|v| copies.get(&v).copied().unwrap_or(v));
    }
    Some((cracks.len(), alone))
}

#[test]
fn every_flaw_is_found_and_sound_meshes_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let mut counts = [0; 8];
    for seed in 0..crate::cases("BREAKLINE_MESHES", 120) {
        let mut random = Random(seed as u64);
        let mut triangles = sound(&mut random);
        add_sides(&mut triangles);
        let flaw = random.index(counts.len());
        let extension = match flaw {
            // The law and kinds of edges are in PLY only; OFF has no numbers that are not finite.
            0 | 5 => "ply",
            6 => random.pick(&["ply", "obj"]),
            _ => random.pick(&["ply", "obj", "off"]),
        };
        let mut expected: Verdict = Box::new(|flaws| !flaws.is_empty());
        let face = random.index(triangles.faces.len());
        match flaw {
            0 => expected = Box::new(<[LocatedFlaw]>::is_empty),
            1 | 2 => {
                let Some((cracks, alone)) = split(&mut triangles, &mut random) else {
                    continue;
                };
                expected = Box::new(move |flaws| {
                    let count = |is: fn(&SurfaceFlaw) -> bool| {
                        flaws
                            .iter()
                            .filter(
                                |flaw| matches!(&flaw.flaw, FlawKind::Surface(flaw) if is(flaw)),
                            )
                            .count()
                    };
                    count(|flaw| matches!(flaw, SurfaceFlaw::Crack { .. })) == cracks
                        && count(|flaw| matches!(flaw, SurfaceFlaw::TwoHeights(_))) == alone
                        && flaws.len() == cracks + alone
                });
            }
            3 => triangles.faces[face].swap(0, 1),
            4 => {
                let [a, b, c] = triangles.faces[face];
                triangles.faces.push([a, b, c]);
                triangles.sides.as_mut().unwrap().push([EdgeKind::Plain; 3]);
            }
            5 => {
                let edges = shared(&triangles);
                if edges.is_empty() {
                    continue;
                }
                let ([f, _], [i, _]) = edges[random.index(edges.len())];
                let kind = &mut triangles.sides.as_mut().unwrap()[f][i];
                *kind = if kind.is_constrained() {
                    EdgeKind::Plain
                } else {
                    EdgeKind::Breakline
                };
                expected = Box::new(|flaws| {
                    flaws.len() == 1 && flaws[0].to_string().contains(": their edge ")
                });
            }
            6 => triangles.vertices[triangles.faces[face][0] as usize][2] = f64::NAN,
            _ => {
                // The corner on the other side of the edge, unless it turns all faces.
                let corner = triangles.faces[face][0];
                if triangles.faces.iter().all(|face| face.contains(&corner)) {
                    continue;
                }
                let [a, b, c] = triangles.faces[face].map(|v| triangles.vertices[v as usize]);
                let moved = &mut triangles.vertices[corner as usize];
                (moved[0], moved[1]) = (b[0] + c[0] - a[0], b[1] + c[1] - a[1]);
            }
        }
        // A face alone that is turned is a mesh that is clockwise.
        if flaw == 3 && triangles.faces.len() == 1 {
            continue;
        }
        let found = check(&write(folder.path(), extension, &triangles)).unwrap();
        let texts: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert!(
            expected(&found),
            "seed {seed}, flaw {flaw}, .{extension}: {texts:?}"
        );
        counts[flaw] += 1;
    }
    assert!(counts.iter().all(|&count| count > 0), "{counts:?}");
}

#[test]
fn two_triangles_over_one_edge_at_two_heights_are_a_crack() {
    let folder = tempfile::tempdir().unwrap();
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [10.0, 0.0, 0.0],
        [5.0, -5.0, 0.0],
        [0.0, 0.0, 100.0],
        [10.0, 0.0, 100.0],
        [5.0, 5.0, 100.0],
    ];
    let faces = vec![[0, 2, 1], [3, 4, 5]];
    let mut triangles = Triangles {
        vertices,
        faces,
        ..Triangles::default()
    };
    add_sides(&mut triangles);
    for extension in ["ply", "obj", "off"] {
        let flaws = check(&write(folder.path(), extension, &triangles)).unwrap();
        assert_eq!(flaws.len(), 1);
        let text = "faces 0 and 1: their edges have one position, but different heights: a crack, at (10 0) (0 0)";
        assert_eq!(flaws[0].to_string(), text);
    }
    // The same heights are a surface, though one that is not linked.
    triangles.vertices.iter_mut().for_each(|p| p[2] = 7.0);
    assert_eq!(check(&write(folder.path(), "ply", &triangles)).unwrap(), []);
    // Two islands that touch.
    let touching = [[0.0, 0.0, 100.0], [-10.0, 5.0, 0.0], [-10.0, -5.0, 0.0]];
    triangles.vertices.splice(3.., touching);
    let flaws = check(&write(folder.path(), "off", &triangles)).unwrap();
    assert_eq!(
        flaws[0].to_string(),
        "vertices 0 and 3: one position, but different heights, at (0 0)"
    );
}

#[test]
fn a_mesh_whose_faces_disagree_about_an_edge_is_no_surface() {
    let folder = tempfile::tempdir().unwrap();
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let mut triangles = Triangles {
        vertices,
        faces: vec![[0, 1, 2], [0, 2, 3]],
        ..Triangles::default()
    };
    triangles.sides = Some(vec![
        [EdgeKind::Rim, EdgeKind::Breakline, EdgeKind::Rim],
        [EdgeKind::Rim; 3],
    ]);
    let path = write(folder.path(), "ply", &triangles);
    let text = "faces 0 and 1: their edge 2 0 is of breaklines in one, of rim in the other";
    assert_eq!(
        check(&path).unwrap()[0].to_string(),
        format!("{text}, at (1 1) (0 0)")
    );
    let error = mesh::read(&path).unwrap_err().to_string();
    assert!(error.ends_with(text), "{error}");
    triangles.sides.as_mut().unwrap()[1][2] = EdgeKind::Breakline;
    let path = write(folder.path(), "ply", &triangles);
    assert_eq!(check(&path).unwrap(), []);
    assert!(Mesh::of(mesh::read_triangles(&path).unwrap()).is_ok());
}

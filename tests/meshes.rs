//! Mesh files: written, read again, foreign, damaged.

#[path = "common/bumps.rs"]
mod bumps;

use std::path::{Path, PathBuf};

use breakline::crs::Crs;
use breakline::data::{EdgeKind, Mesh, Surface, Triangles};
use breakline::io::mesh;

/// A bumpy field of `n` x `n` vertices at map coordinates, with a breakline through it.
fn field(n: u32) -> Mesh {
    let breakline: Vec<[u32; 2]> = (0..n - 1)
        .map(|i| [i * (n + 1), (i + 1) * (n + 1)])
        .collect();
    Mesh::new(bumps::vertices(n), bumps::faces(n, &[]), &breakline, None).unwrap()
}

/// The coordinates of a corner, and the kind of the edge that starts at it.
type Side = ([u64; 3], EdgeKind);

/// Each face by the coordinates of its corners, the kinds of its edges, and true if it is a
/// fragment; in canonical order.
fn content(surface: &impl Surface) -> Vec<([Side; 3], bool)> {
    let mut faces: Vec<_> = (0..surface.face_count() as u32)
        .filter_map(|f| {
            let corners = surface.face(f)?;
            let mut sides = [0, 1, 2].map(|i| {
                (
                    surface.position(corners[i]).map(f64::to_bits),
                    surface.edge_kind(f, i),
                )
            });
            let first = (0..3).min_by_key(|&i| sides[i]).unwrap();
            sides.rotate_left(first);
            Some((sides, surface.is_fragment(f)))
        })
        .collect();
    faces.sort_unstable();
    faces
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn written(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn ply_keeps_everything() {
    let folder = folder();
    let path = folder.path().join("field.ply");
    let field = field(40);
    let summary = mesh::write(&path, &field).unwrap();
    assert_eq!(
        (summary.vertices, summary.faces, summary.constrained_edges),
        (1600, 3042, 39)
    );
    let back = mesh::read(&path).unwrap();
    assert_eq!(content(&back), content(&field));
    let again = folder.path().join("again.PLY");
    mesh::write(&again, &back).unwrap();
    assert_eq!(
        std::fs::read(&path).unwrap(),
        std::fs::read(&again).unwrap()
    );
}

#[test]
fn ply_tells_breaklines_clip_lines_rim_and_pieces_apart() {
    // A strip of triangles, clipped at both ends.
    let at = |x: u32, y: u32| [f64::from(x), f64::from(y), f64::from(x * y)];
    let cut = Mesh::of(Triangles {
        vertices: (0..8).map(|i| at(i / 2, i % 2)).collect(),
        faces: (0..3)
            .flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]])
            .collect(),
        lines: vec![
            ([1, 0], EdgeKind::Clip),
            ([6, 7], EdgeKind::Clip),
            ([3, 2], EdgeKind::Breakline),
        ],
        fragments: vec![1, 4],
        ..Triangles::default()
    });
    let cut = cut.unwrap();
    let folder = folder();
    let path = folder.path().join("cut.ply");
    assert_eq!(mesh::write(&path, &cut).unwrap().constrained_edges, 3);
    assert_eq!(content(&mesh::read(&path).unwrap()), content(&cut));
    let bytes = std::fs::read(&path).unwrap();
    // From the first corner to the second, the third, and the first: face 1 is 0 3 1.
    let row = |face: usize| &bytes[bytes.len() - 17 * (6 - face)..][13..17];
    assert_eq!(
        [row(0), row(1), row(4)],
        [[3, 1, 0, 0], [0, 3, 2, 1], [3, 2, 0, 1]]
    );
    // Programs pass over no element that they do not know, and QGIS shows no faces beside edges.
    let header = String::from_utf8_lossy(&bytes);
    let elements: Vec<&str> = header
        .lines()
        .filter_map(|line| line.strip_prefix("element "))
        .collect();
    assert_eq!(elements, ["vertex 8", "face 6"]);
}

/// How breaklines stood in files of earlier versions.
#[test]
fn constrained_edges_as_an_element_are_still_read() {
    let old = "ply\nformat ascii 1.0\ncomment crs PROJCS[\"x\",GEOG\nelement vertex 4\nproperty double x\nproperty double y\n\
               property double z\nelement face 2\nproperty list uchar int vertex_indices\nelement constrained_edge 1\n\
               property int vertex1\nproperty int vertex2\nend_header\n0 0 1\n1 0 2\n1 1 3\n0 1 4\n3 0 1 2\n3 0 2 3\n0 2\n";
    let wkt = Crs::from_epsg(25832).unwrap().to_wkt();
    let (one, other) = wkt.split_at(150);
    let old = old.replace(
        "comment crs PROJCS[\"x\",GEOG",
        &format!("comment crs {one}\ncomment crs {other}"),
    );
    let folder = folder();
    let mesh = mesh::read(&written(folder.path(), "old.ply", old)).unwrap();
    assert_eq!(
        (mesh.edge_kind(0, 1), mesh.edge_kind(0, 0)),
        (EdgeKind::Breakline, EdgeKind::Rim)
    );
    assert_eq!(mesh.crs().unwrap().epsg, Some(25832));
}

#[test]
fn obj_gives_the_same_doubles_back() {
    let folder = folder();
    let path = folder.path().join("field.obj");
    let field = field(150);
    mesh::write(&path, &field).unwrap();
    let back = mesh::read(&path).unwrap();
    let without = Mesh::new(
        (0..field.vertex_count() as u32)
            .map(|v| field.position(v))
            .collect(),
        (0..field.face_count() as u32)
            .map(|f| field.face(f).unwrap())
            .collect(),
        &[],
        None,
    );
    assert_eq!(content(&back), content(&without.unwrap()));
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("\nv 512000.1 5403000.7 250\n"));
}

#[test]
fn off_gives_the_same_doubles_back() {
    let folder = folder();
    let [off, obj] = ["field.off", "field.obj"].map(|name| folder.path().join(name));
    let field = field(40);
    mesh::write(&off, &field).unwrap();
    mesh::write(&obj, &field).unwrap();
    assert_eq!(
        content(&mesh::read(&off).unwrap()),
        content(&mesh::read(&obj).unwrap())
    );
    let text = std::fs::read_to_string(&off).unwrap();
    assert!(text.starts_with("OFF\n1600 3042 0\n512000.1 5403000.7 250\n"));
}

#[test]
fn stl_counts_from_an_origin_that_stands_beside_it() {
    let folder = folder();
    let path = folder.path().join("field.stl");
    let field = field(10);
    let summary = mesh::write(&path, &field).unwrap();
    let (origin, beside) = summary.origin.unwrap();
    assert_eq!(origin, [512_000.0, 5_403_000.0, 249.0]);
    assert_eq!(
        std::fs::read_to_string(&beside).unwrap(),
        "512000 5403000 249\n"
    );
    assert_eq!(beside, folder.path().join("field.stl.origin.txt"));
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(bytes.len(), 84 + 50 * 162);
    assert!(!bytes.starts_with(b"solid"));
    assert_eq!(u32::from_le_bytes(bytes[80..84].try_into().unwrap()), 162);
    let float = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    for facet in (84..bytes.len()).step_by(50) {
        let numbers: Vec<f32> = (0..12).map(|i| float(facet + 4 * i)).collect();
        assert!(numbers[2] > 0.0, "a normal that points down");
        let length: f32 = numbers[..3].iter().map(|n| n * n).sum();
        assert!((length - 1.0).abs() < 1e-5);
        assert!((0.0..12.0).contains(&numbers[3]) && (0.0..4.0).contains(&numbers[4]));
    }
    // The first vertex, to a tenth of a millimetre.
    assert!((float(84 + 12) - 0.1).abs() < 1e-4 && (float(84 + 16) - 0.7).abs() < 1e-4);
}

#[test]
fn the_coordinate_system_comes_along() {
    let folder = folder();
    let local = |name: String| {
        Crs::from_wkt(&format!("LOCAL_CS[\"{name}  site\",UNIT[\"metre\",1]]")).unwrap()
    };
    // rply takes 1024 bytes a line.
    for (system, start) in [
        (Crs::from_epsg(25832).unwrap(), " crs: EPSG:25832\n"),
        (local("long ".repeat(180)), " crs: LOCAL_CS["),
        (local("long ".repeat(250)), " crs LOCAL_CS["),
    ] {
        let plain = field(3);
        let vertices = (0..9).map(|v| plain.position(v)).collect();
        let faces = (0..8).map(|f| plain.face(f).unwrap()).collect();
        let with = Mesh::new(vertices, faces, &[], Some(system.clone())).unwrap();
        for name in ["a.ply", "a.obj", "a.off"] {
            let path = folder.path().join(name);
            mesh::write(&path, &with).unwrap();
            let back = mesh::read(&path).unwrap();
            let back = back.crs().expect("a coordinate system");
            assert!(back.is_same(&system), "{back:?} is not {system:?}");
            assert_eq!((&back.name, back.epsg), (&system.name, system.epsg));
            let bytes = std::fs::read(&path).unwrap();
            assert!(
                bytes
                    .split(|&b| b == b'\n')
                    .take(6)
                    .all(|line| line.len() < 1024)
            );
            assert!(String::from_utf8_lossy(&bytes).contains(start), "{name}");
        }
    }
    let odd = FOREIGN[0].replace("comment VCGLIB generated", "comment crs nonsense");
    let error = mesh::read(&written(folder.path(), "odd.ply", odd))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("odd.ply: coordinate system in the comments: "),
        "{error}"
    );
}

/// Two triangles over a unit square, as others write them.
const FOREIGN: [&str; 6] = [
    "ply\r\nformat ascii 1.0\r\ncomment VCGLIB generated\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\n\
     property float z\r\nproperty uchar red\r\nelement face 2\r\nproperty list uchar int vertex_indices\r\n\
     end_header\r\n0 0 1 255\r\n1 0 2 255\r\n1 1 3 0\r\n0 1 4 0\r\n3 0 1 2\r\n3 0 2 3\r\n",
    // Face first, clockwise, with more lists; no line end at the end.
    "ply\nformat ascii 1.0\nelement face 2\nproperty list uint8 float32 texcoord\nproperty list uint8 uint32 vertex_index\n\
     property int flags\nelement vertex 4\nproperty double z\nproperty double x\nproperty double y\nend_header\n\
     6 0 0 0 0 0 0 3 2 1 0 7 0 3 3 2 0 9\n1e0 0 0 2 1 0 3 1 1 4 0 1",
    // One quad, and elements between.
    "ply\nformat ascii 1.0\nobj_info x\nelement camera 1\nproperty float view\nelement vertex 4\nproperty double x\n\
     property double y\nproperty double z\nelement nothing 0\nelement face 1\nproperty list uchar int vertex_indices\n\
     element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0.5\n0 0 1\n1 0 2\n1 1 3\n0 1 4\n\
     4 0 1 2 3\n0 1\n",
    "# Blender\nmtllib a.mtl\no Plane\nv 0 0 1\nv 1.0 0 2.0 1.0\nv 1 1 3 0.5 0.5 0.5\nv 0 1 4\nvn 0 0 1\nvt 0 0\ns off\n\
     f 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\n",
    "f -9999999999 1 2\n",
    "f 1 2 3 \\\n4\nv 0 0 1\r\nv 1 0 2\r\nv 1 1 3\r\nv 0 1 4",
];

#[test]
fn foreign_files_are_read() {
    let folder = folder();
    let square = |text: &str, name: &str| mesh::read(&written(folder.path(), name, text));
    let expected = content(&square(FOREIGN[0], "a.ply").unwrap());
    assert_eq!(expected.len(), 2);
    assert_eq!(content(&square(FOREIGN[1], "b.ply").unwrap()), expected);
    assert_eq!(content(&square(FOREIGN[2], "c.ply").unwrap()), expected);
    assert_eq!(content(&square(FOREIGN[3], "d.obj").unwrap()), expected);
    assert_eq!(content(&square(FOREIGN[5], "f.obj").unwrap()), expected);
    let back = "v 0 0 1\nv 1 0 2\nv 1 1 3\nv 0 1 4\nf -4 -3 -2\nf -4/5 -2/5 -1/5\n";
    assert_eq!(content(&square(back, "g.obj").unwrap()), expected);
    for off in [
        "OFF 4 2 0\n# a comment\n0 0 1\n1 0 2\n1 1 3\n0 1 4\n3 0 1 2 255 0 0\n3 2 3 0\n",
        "OFF\r\n4 1 4\r\n0 0 1\r\n1 0 2\r\n\r\n1 1 3 # here\r\n0 1 4\r\n4 0 1 2 3",
        "COFF\n4 2 0\n0 0 1 9 9 9 9\n1e0 0 2 9 9 9 9\n1 1 3 9 9 9 9\n0 1 4 9 9 9 9\n3 2 1 0\n3 0 2 3\n",
    ] {
        assert_eq!(content(&square(off, "h.off").unwrap()), expected);
    }
    let error = square(FOREIGN[4], "e.obj").unwrap_err().to_string();
    assert!(
        error.ends_with("e.obj: line 1: '-9999999999' names no vertex (the first is 1)"),
        "{error}"
    );
}

#[test]
fn binary_of_both_orders_and_all_types() {
    let folder = folder();
    let header = |order: &str| {
        format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty short x\nproperty ushort y\nproperty float z\n\
             property list ushort char extra\nelement face 2\nproperty list int uint vertex_indices\nproperty char f\nend_header\n"
        )
        .into_bytes()
    };
    let (mut little, mut big) = (header("little"), header("big"));
    fn put<const N: usize>(files: [&mut Vec<u8>; 2], le: [u8; N], be: [u8; N]) {
        let [little, big] = files;
        little.extend(le);
        big.extend(be);
    }
    macro_rules! put {
        ($value:expr) => {
            put(
                [&mut little, &mut big],
                $value.to_le_bytes(),
                $value.to_be_bytes(),
            )
        };
    }
    for (i, [x, y]) in [[0i16, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
        put!(x);
        put!(y as u16);
        put!((i as f32 + 1.0));
        put!(2u16);
        put!(-7i8);
        put!(9i8);
    }
    for face in [[0u32, 1, 2], [0, 2, 3]] {
        put!(3i32);
        for v in face {
            put!(v);
        }
        put!(0i8);
    }
    let ascii = mesh::read(&written(folder.path(), "a.ply", FOREIGN[0])).unwrap();
    for (name, bytes) in [("little.ply", little), ("big.ply", big)] {
        let mesh = mesh::read(&written(folder.path(), name, bytes)).unwrap();
        assert_eq!(content(&mesh), content(&ascii));
    }
}

#[test]
fn no_prefix_and_no_flipped_byte_does_harm() {
    let folder = folder();
    let path = folder.path().join("field.ply");
    mesh::write(&path, &field(4)).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let ascii = FOREIGN[1].as_bytes();
    // A new file each time: ext4 waits for the disk when one is written over.
    let read = |bytes: &[u8]| {
        let path = written(folder.path(), "odd.ply", bytes);
        let result = mesh::read(&path);
        std::fs::remove_file(path).unwrap();
        result
    };
    for bytes in [&whole, ascii] {
        for length in 0..bytes.len() - 1 {
            let error = read(&bytes[..length]).unwrap_err();
            assert!(error.path().is_some(), "{error}");
        }
        for i in 0..bytes.len() {
            for flip in [0x01, 0x10, 0x80, 0xff] {
                let mut odd = bytes.to_vec();
                odd[i] ^= flip;
                // An error or a mesh, but no panic, and nothing large.
                if let Err(error) = read(&odd) {
                    assert!(error.path().is_some());
                }
            }
        }
    }
}

#[test]
fn properties_of_other_programs_are_no_kinds_of_edges() {
    let folder = folder();
    let read = |properties: &str, values: &str| {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
             element face 1\nproperty list uchar int vertex_indices\n{properties}end_header\n\
             0 0 0 1 0 0 0 1 0 3 0 1 2 {values}"
        );
        mesh::read(&written(folder.path(), "other.ply", text.as_bytes())).unwrap()
    };
    let constrained = |mesh: &Mesh| (0..3).filter(|&i| mesh.is_constrained(0, i)).count();
    let all = |kind: &str| {
        ["edge1", "edge2", "edge3", "piece"]
            .map(|name| format!("property {kind} {name}\n"))
            .concat()
    };
    assert_eq!(constrained(&read(&all("uchar"), "1 1 1 0")), 3);
    assert_eq!(constrained(&read(&all("float"), "1 1 1 0")), 0);
    assert_eq!(constrained(&read("property uchar edge1\n", "7")), 0);
}

#[test]
fn errors_name_the_value_and_the_place() {
    let folder = folder();
    let message = |name: &str, bytes: &[u8]| {
        let path = written(folder.path(), name, bytes);
        let text = mesh::read(&path).unwrap_err().to_string();
        text.strip_prefix(&format!("{}: ", path.display()))
            .unwrap()
            .to_owned()
    };
    let ply = |vertices: &str, faces: &str, body: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n{body}"
        )
    };
    let square = "0 0 0 1 0 0 1 1 0 0 1 0 ";
    for (file, expected) in [
        (ply("4", "1", &format!("{square} 3 0 1 4")), "face 0: a face names vertex 4, but there are 4 vertices"),
        (ply("4", "1", &format!("{square} 3 0 1 -1")), "face 0: -1 is not the number of a vertex"),
        (ply("4", "1", &format!("{square} 3 0 1 1.5")), "face 0: 1.5 is not the number of a vertex"),
        (ply("4", "1", &format!("{square} 2 0 1 1")), "face 0: a face has 2 corners, expected 3 or more"),
        (ply("4", "1", &format!("{square} 99 0 1 1")), "face 0: a list of 99 values, with 6 bytes left"),
        (ply("4", "1", &format!("{square} 3 0 nul 1")), "face 0: 'nul' is not a number"),
        (ply("4", "1", &format!("{square} 3 0 0 1")), "face 0 names one vertex twice: 0 0 1"),
        (ply("4", "1", "0 0 0 1 0 0 nan 1 0 0 1 0 3 0 1 2"), "vertex 2 is at NaN 1 0, expected finite coordinates"),
        (
            ply("4", "1", "0 0 0 1 0 0 nan 1 0 0 1 0 4 0 1 2 3"),
            "face 0: vertex 2 is at NaN 1 0, expected finite coordinates",
        ),
        (
            ply("4", "1", "0 0 0 1 -inf 0 1 1 0 0 1 0 4 0 1 2 3"),
            "face 0: vertex 1 is at 1 -inf 0, expected finite coordinates",
        ),
        (ply("4", "1", "0 0 0 1 0 0 1 1 inf 0 1 0 4 0 1 2 3"), "vertex 2 is at 1 1 inf, expected finite coordinates"),
        (ply("4", "0", square), "there are no faces: the file is a point cloud"),
        (
            ply("9999999999999", "1", square),
            "the header states 9999999999999 of 'vertex', but there is room for 4 in the 24 bytes left",
        ),
        (ply("18446744073709551616", "1", square), "line 3: '18446744073709551616' is not a count"),
        (
            ply("4", "1", &format!("{square} 3 0 1 2 9 0 0 0")).replace(
                "end_header",
                "property uchar edge1\nproperty uchar edge2\nproperty uchar edge3\nproperty uchar piece\nend_header",
            ),
            "face 0: edge1 is 9, expected the number of a kind of edges, 0 to 8",
        ),
        ("solid x\n".into(), "the file does not begin with 'ply'"),
        ("ply\nformat ascii 1.0\n".into(), "the header has no end"),
        ("ply\nformat ascii 2.0\nend_header\n".into(), "line 2: 'format ascii 2.0' is not a line of a PLY 1.0 header"),
        ("ply\nproperty float x\n".into(), "line 2: a property before any element"),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n".into(),
            "line 4: 'half' is not a type of a property",
        ),
        (
            "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n".into(),
            "the faces are triangle strips ('tristrips')",
        ),
    ] {
        assert_eq!(message("odd.ply", file.as_bytes()), expected);
    }
    assert_eq!(message("odd.obj", b"v 0 0\n"), "line 1: a vertex without z");
    assert_eq!(
        message("odd.obj", b"v 0 0 z\n"),
        "line 1: 'z' is not a number for z"
    );
    assert_eq!(
        message("odd.obj", b"v 0 0 0\n"),
        "there are no faces: the file is a point cloud"
    );
    assert_eq!(
        message(
            "odd.obj",
            b"v 0 0 0\nv 1 0 0\nv 1 1e999 0\nv 0 1 0\nf 1 2 3 4\n"
        ),
        "line 5: vertex 2 is at 1 inf 0, expected finite coordinates"
    );
    let beyond = message("odd.obj", b"v 0 0 0\nf 1 2 3\n");
    assert_eq!(
        beyond,
        "line 2: a face names vertex 1, but there are 1 vertices"
    );
    let off = |rest: &str| {
        message(
            "odd.off",
            format!("OFF\n3 1 0\n0 0 0\n1 0 0\n{rest}").as_bytes(),
        )
    };
    assert_eq!(
        off("0 1 0\n3 0 1 3\n"),
        "line 6: a face names vertex 3, but there are 3 vertices"
    );
    assert_eq!(
        off("0 1 0\n2 0 1\n"),
        "line 6: a face has 2 corners, expected 3 or more"
    );
    assert_eq!(
        off("0 1 0\n99999999999 0 1\n"),
        "line 6: there is no vertex number"
    );
    assert_eq!(
        off("0 1 inf\n"),
        "line 5: the z coordinate is inf, expected a finite number"
    );
    assert_eq!(
        off("0 1 0\n"),
        "line 5: the file ends where face 0 of 1 is expected"
    );
    assert_eq!(
        off("0 1 0\n3 0 1 2\n3 0 1 2\n"),
        "line 7: '3' follows the last face, expected the end of the file"
    );
    assert_eq!(
        message("odd.off", b"OFF\n99999999999999 1 0\n0 0 0\n"),
        "line 3: the file ends where vertex 1 of 99999999999999 is expected"
    );
    assert_eq!(
        message("odd.off", b"4OFF\n"),
        "line 1: '4OFF' is a variant of OFF that is not supported"
    );
    assert_eq!(
        message("odd.off", b"solid\n"),
        "line 1: the file begins with 'solid', not with 'OFF'"
    );
    assert_eq!(
        message("odd.stl", b""),
        "STL meshes are not read: they have no exact coordinates"
    );
    assert_eq!(
        message("odd.dxf", b""),
        "the file's extension names no mesh format"
    );
    assert!(
        mesh::read(Path::new("nowhere.ply"))
            .unwrap_err()
            .to_string()
            .starts_with("nowhere.ply: ")
    );
    let error = mesh::write(&folder.path().join("none/x.ply"), &field(3)).unwrap_err();
    assert!(error.path().is_some());
}

//! Files `.tin`: a surface that is opened where its bytes are gives the results of the one that was
//! written; a damaged one gives errors or wrong results, and never a panic or an endless loop.

#[path = "../common/program.rs"]
mod program;
#[allow(dead_code)] // the judge of cuts uses more of it
#[path = "../cuts/scene.rs"]
mod scene;

mod damaged;
mod verbs;

use breakline::crs::Crs;
use breakline::data::{EdgeKind, Frame, Grid, Surface, SurfaceFacts};
use breakline::io::mesh;
use breakline::terrain::{self, CompactTin, Dem, Levels, Tin};
use testkit::random::Random;

type Opened = CompactTin<Vec<u8>>;

fn bytes_of(surface: &dyn Surface) -> Vec<u8> {
    let mut bytes = Vec::new();
    surface.write_tin(&mut bytes).unwrap();
    bytes
}

fn open(bytes: Vec<u8>) -> breakline::Result<Opened> {
    CompactTin::open(bytes, "some.tin")
}

/// A surface of one of the scenes that cuts are tested with; `None` if nothing is left of it.
fn tin_of(round: usize) -> Option<Tin> {
    let mut random = Random(round as u64);
    let (_, draw) = scene::KINDS[round % scene::KINDS.len()];
    let drawn = scene::Scene::new(&mut random, scene::UNITS[round % 3], draw);
    let mut builder = drawn.builder();
    // One in four is not clipped.
    if !round.is_multiple_of(4) {
        drawn
            .polygons
            .iter()
            .for_each(|rings| builder.add_boundary(rings));
        builder.bounds = drawn.bounds;
    }
    let systems = [
        None,
        Some("EPSG:25832"),
        Some("EPSG:25832+7837"),
        Some("EPSG:2994"),
    ];
    builder.crs = systems[round % 7 % 4].map(|text| Crs::from_user(text).unwrap());
    builder
        .build()
        .ok()
        .filter(|tin| tin.report().triangles > 0)
}

/// All faces, in order, with positions in place of numbers of vertices, and positions in the order
/// in place of numbers of faces.
#[allow(clippy::type_complexity)]
fn listed(surface: &dyn Surface) -> Vec<([[u64; 3]; 3], [EdgeKind; 3], [Option<usize>; 3], bool)> {
    let numbers: Vec<u32> = (0..surface.face_count() as u32)
        .filter(|&n| surface.face(n).is_some())
        .collect();
    let at = |face: u32| numbers.binary_search(&face).unwrap();
    let row = |&n: &u32| {
        let corners = surface.triangle(n).unwrap().map(|p| p.map(f64::to_bits));
        let neighbors = [0, 1, 2].map(|i| surface.neighbor(n, i).map(at));
        (
            corners,
            [0, 1, 2].map(|i| surface.edge_kind(n, i)),
            neighbors,
            surface.is_fragment(n),
        )
    };
    numbers.iter().map(row).collect()
}

fn frame_over(surface: &dyn Surface) -> Frame {
    let extent = SurfaceFacts::of(surface).extent;
    Frame::snapped(
        &extent,
        (extent.max[0] - extent.min[0]).max(extent.max[1] - extent.min[1]) / 23.0,
    )
    .unwrap()
}

fn heights(surface: &dyn Surface, frame: Frame) -> Vec<u64> {
    let grid = Grid::collect(&Dem::new(surface, frame).unwrap()).unwrap();
    grid.values.into_iter().map(f64::to_bits).collect()
}

fn written(surface: &dyn Surface, name: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    mesh::write(path.as_path(), surface).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn everything_is_as_in_the_surface_that_was_written() {
    let (mut surfaces, mut fragments, mut lines) = (0, 0, [0; 4]);
    for round in 0..600 {
        let Some(tin) = tin_of(round) else { continue };
        let bytes = bytes_of(&tin);
        let opened = open(bytes.clone()).unwrap();
        opened.check().unwrap();
        assert_eq!(*opened.facts(), SurfaceFacts::of(&tin), "round {round}");
        assert_eq!(opened.crs(), tin.crs());
        let faces = listed(&opened);
        assert!(faces == listed(&tin), "round {round}");
        assert_eq!(
            terrain::surface_flaws(&opened),
            terrain::surface_flaws(&tin),
            "round {round}"
        );
        let frame = frame_over(&tin);
        assert!(
            heights(&opened, frame) == heights(&tin, frame),
            "round {round}"
        );
        let levels = Levels::every(0.5, 0.1).unwrap();
        assert!(
            terrain::contours(&opened, &levels)
                .unwrap()
                .eq(terrain::contours(&tin, &levels).unwrap())
        );
        if round % 10 == 0 {
            assert!(
                written(&opened, "a.ply") == written(&tin, "a.ply"),
                "round {round}"
            );
            assert!(
                written(&opened, "a.tin") == bytes && written(&tin, "a.tin") == bytes,
                "round {round}"
            );
        }
        opened.ensure_intact().unwrap();
        surfaces += 1;
        fragments += faces.iter().filter(|face| face.3).count();
        faces
            .iter()
            .flat_map(|face| face.1)
            .for_each(|kind| lines[usize::from(kind.number())] += 1);
    }
    assert!(
        surfaces > 400 && fragments > 5000 && lines.iter().all(|&n| n > 500),
        "{surfaces} {fragments} {lines:?}"
    );
}

#[test]
fn the_coordinate_system_can_be_assigned() {
    let tin = tin_of(1).unwrap();
    let mut opened = open(bytes_of(&tin)).unwrap();
    let crs = Crs::from_user("EPSG:4326").ok();
    opened.set_crs(crs.clone());
    let again = open(bytes_of(&opened)).unwrap();
    assert_eq!(
        (again.crs(), crs == tin.crs().cloned()),
        (crs.as_ref(), false)
    );
    again.check().unwrap();
    assert!(listed(&again) == listed(&tin));
}

#[test]
fn a_mesh_is_not_written_as_a_tin() {
    let corners = vec![[0.0, 0.0, 1.0], [9.0, 0.0, 2.0], [9.0, 9.0, 3.0]];
    let mesh = breakline::data::Mesh::new(corners, vec![[0, 1, 2]], &[], None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tin");
    let error = mesh::write(path.as_path(), &mesh).unwrap_err();
    assert!(
        error.to_string().contains("this surface has none"),
        "{error}"
    );
    assert!(!path.exists());
}

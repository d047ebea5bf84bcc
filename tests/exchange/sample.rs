//! A small surface with lines of all kinds, a hole, and numbers that are hard to write; and what a
//! surface contains.

use breakline::crs::Crs;
use breakline::data::{EdgeKind, Mesh, Surface, Triangles};

use crate::bumps;

/// A field of 6 x 6 vertices at map coordinates, without the two cells in its middle.
pub(crate) fn field(crs: Option<&str>) -> Mesh {
    let n = 6;
    let kinds = EdgeKind::ALL
        .into_iter()
        .filter(|kind| kind.is_constrained());
    let lines = (0..5).flat_map(|i| [[i, i + 1], [i * n, (i + 1) * n]]);
    let lines = lines.zip(kinds.cycle()).collect();
    Mesh::of(Triangles {
        vertices: bumps::vertices(n),
        faces: bumps::faces(n, &[14, 15]),
        lines,
        crs: crs.map(|text| Crs::from_user(text).unwrap()),
        ..Triangles::default()
    })
    .unwrap()
}

/// The coordinates of a corner, and the kind of the edge that starts at it.
pub(crate) type Side = ([u64; 3], EdgeKind);

/// Each face by the coordinates of its corners and the kinds of its edges, in canonical order.
pub(crate) fn content(surface: &impl Surface) -> Vec<[Side; 3]> {
    let side = |f: u32, corners: [u32; 3], i: usize| {
        let at = surface.position(corners[i]).map(f64::to_bits);
        (at, surface.edge_kind(f, (i + 2) % 3))
    };
    let mut faces: Vec<_> = (0..surface.face_count() as u32)
        .filter_map(|f| {
            let corners = surface.face(f)?;
            let mut sides = [0, 1, 2].map(|i| side(f, corners, i));
            let first = (0..3).min_by_key(|&i| sides[i]).unwrap();
            sides.rotate_left(first);
            Some(sides)
        })
        .collect();
    faces.sort_unstable();
    faces
}

//! The lines of a surface as polylines, for formats that store lines of their own.

use std::collections::{HashMap, HashSet};

use crate::data::{self, EdgeKind, Surface};

/// The lines of one kind: the numbers of their vertices in the surface. A closed line ends with its
/// first vertex.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lines {
    pub(crate) kind: EdgeKind,
    pub(crate) lines: Vec<Vec<u32>>,
}

/// Returns the edges on lines, joined to polylines between vertices where lines end or meet, by
/// kind. Kinds without edges are left out.
///
/// # Complexity
/// Linear, and sorting for the edges on lines.
pub(crate) fn lines(surface: &dyn Surface) -> Vec<Lines> {
    if !surface.has_lines() {
        return Vec::new();
    }
    let mut edges: Vec<(EdgeKind, [u32; 2])> = Vec::new();
    for face in data::faces(surface) {
        for i in (0..3).filter(|&i| face.edges[i].is_constrained()) {
            let other = surface.neighbor(face.number, i);
            if other.is_none_or(|other| face.number < other) {
                let ends = [1, 2].map(|k| face.corners[(i + k) % 3]);
                edges.push((face.edges[i], ends));
            }
        }
    }
    let kinds = EdgeKind::ALL.into_iter().map(|kind| {
        let of_kind = edges.iter().filter(|(found, _)| *found == kind);
        Lines {
            kind,
            lines: chains(of_kind.map(|(_, ends)| *ends).collect()),
        }
    });
    kinds.filter(|of| !of.lines.is_empty()).collect()
}

/// Joins edges to polylines.
fn chains(edges: Vec<[u32; 2]>) -> Vec<Vec<u32>> {
    let ends = |(number, [a, b]): (usize, [u32; 2])| [(a, b, number), (b, a, number)];
    let mut steps: Vec<(u32, u32, usize)> =
        edges.iter().copied().enumerate().flat_map(ends).collect();
    steps.sort_unstable();
    let around = |vertex: u32| {
        let first = steps.partition_point(|step| step.0 < vertex);
        let count = steps[first..].iter().take_while(|step| step.0 == vertex);
        &steps[first..first + count.count()]
    };
    let mut is_used = vec![false; edges.len()];
    let mut chains = Vec::new();
    // First from vertices where lines end or meet, then what is closed.
    for is_closed in [false, true] {
        for &(start, second, number) in &steps {
            if is_used[number] || (!is_closed && around(start).len() == 2) {
                continue;
            }
            is_used[number] = true;
            let mut chain = vec![start, second];
            let mut last = second;
            while let [one, other] = around(last) {
                let Some(next) = [one, other].into_iter().find(|step| !is_used[step.2]) else {
                    break;
                };
                is_used[next.2] = true;
                last = next.1;
                chain.push(last);
            }
            chains.push(chain);
        }
    }
    chains
}

/// Returns the rings around the surface and around its holes, each without its first vertex at the
/// end: outer rings counter-clockwise, those of holes clockwise.
///
/// # Complexity
/// Linear.
pub(crate) fn rings(surface: &dyn Surface) -> Vec<Vec<u32>> {
    let is_rim = |face: u32, i: usize| surface.neighbor(face, i).is_none();
    let mut rim: Vec<(u32, usize)> = Vec::new();
    for (face, _) in data::corners(surface) {
        rim.extend((0..3).filter(|&i| is_rim(face, i)).map(|i| (face, i)));
    }
    let mut left: HashSet<(u32, usize)> = rim.iter().copied().collect();
    let mut rings = Vec::new();
    for first in rim {
        let mut ring = Vec::new();
        let mut side = Some(first);
        while let Some((face, i)) = side.filter(|side| left.remove(side)) {
            side = surface.face(face).and_then(|corners| {
                ring.push(corners[(i + 1) % 3]);
                next_on_rim(surface, (face, (i + 1) % 3), corners[(i + 2) % 3])
            });
        }
        split(ring, &mut rings);
    }
    rings
}

/// Adds the parts of a ring between visits of the same vertex, where holes touch each other or the
/// rim.
fn split(ring: Vec<u32>, rings: &mut Vec<Vec<u32>>) {
    let mut found: HashMap<u32, usize> = HashMap::new();
    let mut path: Vec<u32> = Vec::new();
    for vertex in ring {
        if let Some(first) = found.get(&vertex).copied() {
            let part = path.split_off(first);
            for vertex in &part {
                found.remove(vertex);
            }
            rings.push(part);
        }
        found.insert(vertex, path.len());
        path.push(vertex);
    }
    // Sides that were passed before begin no ring.
    if path.len() > 2 {
        rings.push(path);
    }
}

/// Turns around a vertex, from a side of a face that begins there, to one at the rim.
fn next_on_rim(surface: &dyn Surface, from: (u32, usize), vertex: u32) -> Option<(u32, usize)> {
    let (mut face, mut side) = from;
    while let Some(across) = surface.neighbor(face, side) {
        let at = surface.face(across)?.iter().position(|&v| v == vertex)?;
        (face, side) = (across, (at + 2) % 3);
        // Only damaged links turn all around.
        if (face, side) == from {
            return None;
        }
    }
    Some((face, side))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Mesh, Triangles};

    /// A square of 4 x 4 cells without the cell in its middle and without one next to it:
    /// holes touch at a vertex.
    fn with_holes() -> Mesh {
        let at = |i: u32| [f64::from(i % 5), f64::from(i / 5), f64::from(i)];
        let mut faces = Vec::new();
        for cell in (0..20).filter(|cell| cell % 5 < 4 && ![6, 12].contains(cell)) {
            faces.push([cell, cell + 1, cell + 6]);
            faces.push([cell, cell + 6, cell + 5]);
        }
        let kind = EdgeKind::Breakline;
        let lines = [[0, 1], [1, 2], [2, 7], [2, 3], [20, 15], [15, 10]];
        let wall = [[18, 19], [19, 24], [24, 18]];
        let edges = lines.map(|edge| (edge, kind)).into_iter();
        Mesh::of(Triangles {
            vertices: (0..25).map(at).collect(),
            faces,
            lines: edges
                .chain(wall.map(|edge| (edge, EdgeKind::Wall)))
                .collect(),
            ..Triangles::default()
        })
        .unwrap()
    }

    #[test]
    fn edges_are_joined_between_ends_and_junctions() {
        let mesh = with_holes();
        let found = lines(&mesh);
        let [breaklines, walls] = &found[..] else {
            panic!("{found:?}")
        };
        assert_eq!(breaklines.kind, EdgeKind::Breakline);
        assert_eq!(
            breaklines.lines,
            [vec![0, 1, 2], vec![2, 3], vec![2, 7], vec![10, 15, 20]]
        );
        assert_eq!(walls.lines, [vec![18, 19, 24, 18]]);
    }

    #[test]
    fn rings_go_around_the_surface_and_its_holes() {
        let mesh = with_holes();
        let found = rings(&mesh);
        let areas: Vec<f64> = found
            .iter()
            .map(|ring| {
                let closed = ring.iter().chain(ring.first());
                let closed: Vec<_> = closed.map(|&v| mesh.position(v)).collect();
                data::doubled_area(&closed) / 2.0
            })
            .collect();
        let mut sorted = areas.clone();
        sorted.sort_by(f64::total_cmp);
        // Two holes that share a vertex, each a ring of its own.
        assert_eq!(sorted, [-1.0, -1.0, 16.0]);
        let edges: usize = found.iter().map(Vec::len).sum();
        assert_eq!(edges, 24);
    }
}

use std::collections::HashSet;

use super::{EdgeKind, LinkFlaw, Surface, Triangles};
use crate::crs::Crs;
use crate::error::{Error, Result};
use crate::triangulation::kernel::{Adaptive, Exact, Kernel, Orientation2};
use crate::triangulation::num::Sign;

/// A surface of triangles as lists, like the content of a mesh file.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    neighbors: Vec<[u32; 3]>,
    /// Rim edges are plain here; they follow from the neighbors.
    kinds: Vec<[EdgeKind; 3]>,
    /// In ascending order.
    fragments: Vec<u32>,
    crs: Option<Crs>,
}

/// No neighbor; also the limit for numbers.
const NONE: u32 = u32::MAX;

impl Surface for Mesh {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.vertices[vertex as usize]
    }

    fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.faces.get(face as usize).copied()
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        Some(self.neighbors[face as usize][i]).filter(|&n| n != NONE)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        match self.kinds[face as usize][i] {
            EdgeKind::Plain if self.neighbors[face as usize][i] == NONE => EdgeKind::Rim,
            kind => kind,
        }
    }

    fn is_fragment(&self, face: u32) -> bool {
        self.fragments.binary_search(&face).is_ok()
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }
}

impl Mesh {
    /// Sets the coordinate system; coordinates do not change.
    pub fn set_crs(&mut self, crs: Option<Crs>) {
        self.crs = crs;
    }

    /// Builds a mesh: links triangles to their neighbors.
    ///
    /// Clockwise faces are reversed; vertices may be unused. A mesh is a surface, with one height
    /// at each position. Folds are detected where faces share an edge, not where they overlap
    /// without one. Numbers in messages count from 0.
    ///
    /// # Errors
    /// If a coordinate is not finite, a face or an edge names a vertex that does not exist, a face
    /// has no area in plan, two faces lie on the same side of an edge that they share (of three
    /// faces at one edge, two always do), or a constrained edge is not an edge of a face.
    ///
    /// # Complexity
    /// Linear, except for sorting the edges around each vertex; 24 bytes per face in addition to
    /// the result.
    pub fn new(
        vertices: Vec<[f64; 3]>,
        faces: Vec<[u32; 3]>,
        constrained_edges: &[[u32; 2]],
        crs: Option<Crs>,
    ) -> Result<Self> {
        let lines = constrained_edges
            .iter()
            .map(|&edge| (edge, EdgeKind::Breakline))
            .collect();
        Self::of(Triangles {
            vertices,
            faces,
            lines,
            crs,
            ..Triangles::default()
        })
    }

    /// Like [`new`](Self::new), but from everything that a file can contain.
    ///
    /// [`Triangles::neighbors`] is ignored.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), and if a clip edge is not an edge of a face, or two faces state
    /// different kinds for the edge that they share.
    pub fn of(triangles: Triangles) -> Result<Self> {
        let Triangles {
            vertices,
            mut faces,
            lines,
            fragments,
            mut sides,
            crs,
            ..
        } = triangles;
        check_numbers(&vertices, &faces)?;
        check_values(&vertices, &faces)?;
        turn_counter_clockwise(
            &vertices,
            &mut faces,
            sides.as_deref_mut().unwrap_or_default(),
        )?;
        let edges = EdgeTable::new(vertices.len(), &faces);
        let neighbors = match edges.neighbors(&faces) {
            (neighbors, flaws) if flaws.is_empty() => neighbors,
            (_, flaws) => return Err(folded(flaws[0])),
        };
        if let Some(flaw) =
            different_kinds(&faces, &neighbors, sides.as_deref().unwrap_or_default()).next()
        {
            return Err(Error::format(flaw.to_string())
                .cure("write the mesh again with the program that made it"));
        }
        let (kinds, unmet) = edges.kinds(faces.len(), &lines);
        if let Some(flaw) = unmet.first() {
            return Err(Error::format(flaw.to_string()));
        }
        Ok(Mesh {
            vertices,
            faces,
            neighbors,
            kinds,
            fragments,
            crs,
        })
    }

    /// Links triangles as far as possible, and returns the mesh with the flaws that were found.
    ///
    /// Meant for checks of files that [`of`](Self::of) refuses. Where faces fold, an edge has no
    /// neighbor. Faces are reversed only if all of them are clockwise.
    ///
    /// # Errors
    /// If a face names a vertex that does not exist, or there are more faces or vertices than can
    /// be numbered.
    ///
    /// # Complexity
    /// That of [`new`](Self::new).
    pub fn link(triangles: Triangles) -> Result<(Self, Vec<LinkFlaw>)> {
        let Triangles {
            vertices,
            mut faces,
            lines,
            fragments,
            mut sides,
            neighbors: stated,
            crs,
            ..
        } = triangles;
        check_numbers(&vertices, &faces)?;
        let is_turned = is_clockwise(&vertices, &faces);
        if is_turned {
            faces.iter_mut().for_each(|face| face.swap(1, 2));
            sides
                .iter_mut()
                .flatten()
                .for_each(|kinds| kinds.swap(1, 2));
        }
        let edges = EdgeTable::new(vertices.len(), &faces);
        let (neighbors, mut flaws) = edges.neighbors(&faces);
        flaws.extend(strays(&vertices, &faces));
        flaws.extend(different_kinds(
            &faces,
            &neighbors,
            sides.as_deref().unwrap_or_default(),
        ));
        let (kinds, unmet) = edges.kinds(faces.len(), &lines);
        flaws.extend(unmet);
        for (face, mut stated) in (0u32..).zip(stated.into_iter().flatten()).take(faces.len()) {
            if is_turned {
                stated.swap(1, 2);
            }
            for (corner, stated) in stated.into_iter().enumerate() {
                let found = Some(neighbors[face as usize][corner]).filter(|&n| n != NONE);
                if stated != found {
                    flaws.push(LinkFlaw::Neighbor {
                        face,
                        corner,
                        stated,
                        found,
                    });
                }
            }
        }
        Ok((
            Mesh {
                vertices,
                faces,
                neighbors,
                kinds,
                fragments,
                crs,
            },
            flaws,
        ))
    }
}

fn check_numbers(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<()> {
    // Half edges are numbered as well, three per face.
    if vertices.len() >= NONE as usize || faces.len() >= (NONE / 3) as usize {
        return Err(Error::limit(format!(
            "{} vertices and {} faces, but a mesh holds at most {} and {}",
            vertices.len(),
            faces.len(),
            NONE - 1,
            NONE / 3 - 1
        )));
    }
    for (i, face) in faces.iter().enumerate() {
        if let Some(v) = face.iter().find(|&&v| v as usize >= vertices.len()) {
            let count = vertices.len();
            return Err(Error::format(format!(
                "face {i} names vertex {v}, but there are {count} vertices"
            )));
        }
    }
    Ok(())
}

fn check_values(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<()> {
    if let Some(i) = vertices
        .iter()
        .position(|p| p.iter().any(|c| !c.is_finite()))
    {
        return Err(not_finite(i, vertices[i]));
    }
    if let Some(i) = faces
        .iter()
        .position(|&[a, b, c]| a == b || b == c || c == a)
    {
        let [a, b, c] = faces[i];
        return Err(Error::format(format!(
            "face {i} names one vertex twice: {a} {b} {c}"
        )));
    }
    Ok(())
}

/// Vertices with coordinates that are not finite, unless a face uses them.
fn strays(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Vec<LinkFlaw> {
    let is_nowhere = |&vertex: &u32| !vertices[vertex as usize].iter().all(|c| c.is_finite());
    let nowhere: Vec<u32> = (0..vertices.len() as u32).filter(is_nowhere).collect();
    if nowhere.is_empty() {
        return Vec::new();
    }
    let used: HashSet<u32> = faces.iter().flatten().copied().collect();
    nowhere
        .into_iter()
        .filter(|vertex| !used.contains(vertex))
        .map(LinkFlaw::StrayVertex)
        .collect()
}

/// The error for a vertex with coordinates that are not finite.
#[cold]
pub(crate) fn not_finite(vertex: usize, [x, y, z]: [f64; 3]) -> Error {
    Error::format(format!(
        "vertex {vertex} is at {x} {y} {z}, expected finite coordinates"
    ))
}

/// Returns true if there are clockwise faces and no counter-clockwise ones.
fn is_clockwise(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> bool {
    let corners = faces.iter().map(|face| face.map(|v| vertices[v as usize]));
    let finite = corners.filter(|corners| {
        corners
            .iter()
            .all(|[x, y, _]| x.is_finite() && y.is_finite())
    });
    let mut signs = finite
        .map(orientation)
        .filter(|sign| *sign != Sign::Zero)
        .peekable();
    signs.peek().is_some() && signs.all(|sign| sign == Sign::Negative)
}

/// Turns faces, and the kinds of their edges if there are any.
fn turn_counter_clockwise(
    vertices: &[[f64; 3]],
    faces: &mut [[u32; 3]],
    sides: &mut [[EdgeKind; 3]],
) -> Result<()> {
    for (i, face) in faces.iter_mut().enumerate() {
        match orientation(face.map(|v| vertices[v as usize])) {
            Sign::Positive => (),
            Sign::Negative => {
                face.swap(1, 2);
                sides
                    .get_mut(i)
                    .into_iter()
                    .for_each(|kinds| kinds.swap(1, 2));
            }
            Sign::Zero => {
                let [a, b, c] = *face;
                return Err(Error::format(format!("face {i} ({a} {b} {c}) has no area in plan"))
                    .cure("a surface has one height at each position: remove vertical and collapsed faces"));
            }
        }
    }
    Ok(())
}

/// Returns the edges between two faces for which these state different kinds. An edge on no line is
/// plain for a face, or at the rim: some programs that divide a mesh know no difference.
fn different_kinds(
    faces: &[[u32; 3]],
    neighbors: &[[u32; 3]],
    sides: &[[EdgeKind; 3]],
) -> impl Iterator<Item = LinkFlaw> {
    let line = |kind: EdgeKind| Some(kind).filter(|kind| kind.is_constrained());
    let all = (0u32..)
        .zip(sides)
        .flat_map(|(face, kinds)| (0..3).map(move |i| (face, i, kinds[i])));
    all.filter_map(move |(face, i, kind)| {
        let beside = neighbors.get(face as usize)?[i];
        let theirs = neighbors.get(beside as usize).filter(|_| face < beside)?;
        let other = sides.get(beside as usize)?[theirs.iter().position(|&back| back == face)?];
        let corners = faces.get(face as usize)?;
        let edge = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
        (line(kind) != line(other)).then_some(LinkFlaw::Kinds {
            faces: [face, beside],
            edge,
            kinds: [kind, other],
        })
    })
}

/// One side of a face: an edge as seen from one of its faces.
///
/// Ordered by the larger vertex of the edge, so that [`EdgeTable`] can be searched.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    high: u32,
    number: u32,
}

impl HalfEdge {
    fn face(self) -> usize {
        self.number as usize / 3
    }

    fn side(self) -> usize {
        self.number as usize % 3
    }

    /// The vertex at which the edge starts, counter-clockwise around its face.
    fn start(self, faces: &[[u32; 3]]) -> u32 {
        faces[self.face()][(self.side() + 1) % 3]
    }
}

/// All half edges, sorted by the smaller and then by the larger vertex of their edge.
struct EdgeTable {
    /// For each vertex, where the half edges that have it as the smaller one begin; and their
    /// number.
    first: Vec<u32>,
    halves: Vec<HalfEdge>,
}

impl EdgeTable {
    fn new(vertex_count: usize, faces: &[[u32; 3]]) -> Self {
        let ends = |face: &[u32; 3], side: usize| {
            let (a, b) = (face[(side + 1) % 3], face[(side + 2) % 3]);
            (a.min(b), a.max(b))
        };
        let mut first = vec![0u32; vertex_count + 1];
        for face in faces {
            for side in 0..3 {
                first[ends(face, side).0 as usize + 1] += 1;
            }
        }
        for v in 0..vertex_count {
            first[v + 1] += first[v];
        }
        let mut halves = vec![HalfEdge { high: 0, number: 0 }; 3 * faces.len()];
        let mut next = first.clone();
        for (i, face) in faces.iter().enumerate() {
            for side in 0..3 {
                let (low, high) = ends(face, side);
                let slot = &mut next[low as usize];
                halves[*slot as usize] = HalfEdge {
                    high,
                    number: (3 * i + side) as u32,
                };
                *slot += 1;
            }
        }
        for v in 0..vertex_count {
            halves[first[v] as usize..first[v + 1] as usize].sort_unstable();
        }
        EdgeTable { first, halves }
    }

    /// The face across each side, and the flaws. Sides where faces fold have no neighbor.
    fn neighbors(&self, faces: &[[u32; 3]]) -> (Vec<[u32; 3]>, Vec<LinkFlaw>) {
        let mut neighbors = vec![[NONE; 3]; faces.len()];
        let mut flaws = Vec::new();
        for range in self.first.windows(2) {
            let around = &self.halves[range[0] as usize..range[1] as usize];
            for twins in around.chunk_by(|a, b| a.high == b.high) {
                // Of three faces at an edge, two start at the same end.
                let folded = twins.iter().enumerate().find_map(|(i, one)| {
                    let other = twins[i + 1..]
                        .iter()
                        .find(|other| other.start(faces) == one.start(faces))?;
                    Some(LinkFlaw::Folded {
                        faces: [one.face() as u32, other.face() as u32],
                        edge: [one.start(faces), faces[one.face()][(one.side() + 2) % 3]],
                    })
                });
                match (folded, twins) {
                    (Some(flaw), _) => flaws.push(flaw),
                    (None, [one, other]) => {
                        neighbors[one.face()][one.side()] = other.face() as u32;
                        neighbors[other.face()][other.side()] = one.face() as u32;
                    }
                    _ => {}
                }
            }
        }
        (neighbors, flaws)
    }

    /// Returns the kinds of the sides of `face_count` faces, and a flaw for each listed edge that
    /// is not a side of any face.
    fn kinds(
        &self,
        face_count: usize,
        lines: &[([u32; 2], EdgeKind)],
    ) -> (Vec<[EdgeKind; 3]>, Vec<LinkFlaw>) {
        let mut kinds = vec![[EdgeKind::Plain; 3]; face_count];
        let mut strays = Vec::new();
        for &(edge, kind) in lines {
            let halves = self.find(edge);
            strays.extend(halves.is_empty().then_some(LinkFlaw::NoEdge(edge)));
            halves
                .iter()
                .for_each(|half| kinds[half.face()][half.side()] = kind);
        }
        (kinds, strays)
    }

    fn find(&self, [a, b]: [u32; 2]) -> &[HalfEdge] {
        let (low, high) = (a.min(b) as usize, a.max(b));
        if low + 1 >= self.first.len() {
            return &[];
        }
        let around = &self.halves[self.first[low] as usize..self.first[low + 1] as usize];
        let start = around.partition_point(|half| half.high < high);
        let end = around.partition_point(|half| half.high <= high);
        &around[start..end]
    }
}

#[cold]
fn folded(flaw: LinkFlaw) -> Error {
    Error::format(flaw.to_string())
        .cure("a surface has one height at each position: remove overhangs and repeated faces")
}

/// Returns the area of a triangle in plan; negative if it is clockwise.
pub(crate) fn area_of([a, b, c]: [[f64; 3]; 3]) -> f64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
}

/// The orientation of three points in plan: positive if counter-clockwise, zero if collinear. Exact
/// for all finite coordinates.
pub(crate) fn orientation(corners: [[f64; 3]; 3]) -> Sign {
    let turn = Orientation2(corners.map(|[x, y, _]| [x, y]));
    let is_ordinary = turn
        .0
        .as_flattened()
        .iter()
        .all(|&c| Adaptive::RANGE.admits(c));
    if is_ordinary {
        Adaptive::sign(&turn)
    } else {
        Exact::sign(&turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<[f64; 3]> {
        vec![
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 2.0],
            [1.0, 1.0, 3.0],
            [0.0, 1.0, 4.0],
        ]
    }

    #[test]
    fn two_triangles_see_each_other_whatever_their_direction() {
        for second in [[0, 2, 3], [0, 3, 2], [3, 0, 2]] {
            let mesh = Mesh::new(square(), vec![[0, 1, 2], second], &[[2, 0]], None).unwrap();
            assert_eq!(mesh.neighbor(0, 1), Some(1));
            assert_eq!(mesh.neighbor(0, 0), None);
            let corners = mesh.face(1).unwrap();
            let i = corners.iter().position(|&v| v == 3).unwrap();
            assert_eq!(mesh.neighbor(1, i), Some(0));
            assert!(mesh.is_constrained(0, 1) && mesh.is_constrained(1, i));
            assert!(!mesh.is_constrained(0, 0) && !mesh.is_constrained(0, 2));
            assert_eq!(
                orientation(corners.map(|v| mesh.position(v))),
                Sign::Positive
            );
        }
    }

    #[test]
    fn neighbors_of_a_grid_share_two_corners_and_point_back() {
        let n = 12u32;
        let vertices = (0..n * n)
            .map(|i| [f64::from(i % n), f64::from(i / n), 0.0])
            .collect();
        let mut faces = Vec::new();
        for row in 0..n - 1 {
            for column in 0..n - 1 {
                let a = row * n + column;
                faces.push([a, a + 1, a + n + 1]);
                faces.push([a + n, a, a + n + 1]);
            }
        }
        let mesh = Mesh::new(vertices, faces, &[], None).unwrap();
        let mut borders = 0;
        for f in 0..mesh.face_count() as u32 {
            let corners = mesh.face(f).unwrap();
            for i in 0..3 {
                let Some(g) = mesh.neighbor(f, i) else {
                    borders += 1;
                    continue;
                };
                let other = mesh.face(g).unwrap();
                let j = (0..3).find(|&j| mesh.neighbor(g, j) == Some(f)).unwrap();
                assert_eq!(other[(j + 1) % 3], corners[(i + 2) % 3]);
                assert_eq!(other[(j + 2) % 3], corners[(i + 1) % 3]);
            }
        }
        assert_eq!(borders, 4 * (n - 1));
    }

    #[track_caller]
    fn refuses(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>, edges: &[[u32; 2]], message: &str) {
        let error = Mesh::new(vertices, faces, edges, None).unwrap_err();
        assert_eq!(error.to_string(), message);
    }

    #[test]
    fn refuses_what_is_no_surface() {
        let mut odd = square();
        odd[3][2] = f64::NAN;
        refuses(
            odd,
            vec![],
            &[],
            "vertex 3 is at 0 1 NaN, expected finite coordinates",
        );
        refuses(
            square(),
            vec![[0, 1, 4]],
            &[],
            "face 0 names vertex 4, but there are 4 vertices",
        );
        refuses(
            square(),
            vec![[0, 1, 0]],
            &[],
            "face 0 names one vertex twice: 0 1 0",
        );
        let twice = vec![[0, 1, 2], [1, 0, 2]];
        refuses(
            square(),
            twice,
            &[],
            "faces 0 and 1: both pass their edge 0 1 in the same direction",
        );
        let three = vec![[0, 1, 2], [0, 2, 3], [1, 3, 0], [2, 3, 0]];
        refuses(
            square(),
            three,
            &[],
            "faces 0 and 2: both pass their edge 0 1 in the same direction",
        );
        let flat = vec![[0.0, 0.0, 0.0], [0.1, 0.1, 5.0], [0.3, 0.3, 0.0]];
        refuses(
            flat,
            vec![[0, 1, 2]],
            &[],
            "face 0 (0 1 2) has no area in plan",
        );
        refuses(
            square(),
            vec![[0, 1, 2]],
            &[[0, 3]],
            "the constrained edge 0 3 is not an edge of any face",
        );
        refuses(
            square(),
            vec![[0, 1, 2]],
            &[[9, 3]],
            "the constrained edge 9 3 is not an edge of any face",
        );
    }

    #[test]
    fn tells_the_smallest_slivers_from_flat_faces() {
        let p = |x: f64, y: f64| [x, y, 0.0];
        for scale in [1.0, 1e-300, 1e300] {
            let (a, b) = (p(0.1 * scale, 0.1 * scale), p(0.7 * scale, 0.7 * scale));
            let c = 0.3 * scale;
            assert_eq!(orientation([a, b, p(c, c)]), Sign::Zero);
            assert_eq!(orientation([a, b, p(c, c.next_up())]), Sign::Positive);
            assert_eq!(orientation([a, b, p(c, c.next_down())]), Sign::Negative);
            assert_eq!(orientation([b, a, p(c, c.next_up())]), Sign::Negative);
        }
    }
}

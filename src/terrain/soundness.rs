use std::cmp::Ordering;

use crate::data::{self, EdgeKind, Surface};
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::kernel::Wide;
use crate::triangulation::num::{Sign, unsigned_zero};

/// A flaw of a surface of triangles, found with exact predicates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceFlaw {
    /// A vertex of a face with a coordinate that is not finite, or too large or too small for exact
    /// arithmetic.
    Vertex(u32),
    /// A face whose neighbor across edge `i` does not link back to it, or has a different edge
    /// there.
    NotMutual(u32, usize),
    /// A face without area in plan, or with clockwise corners.
    Orientation(u32),
    /// A vertex whose faces do not form a single fan.
    NotManifold(u32),
    /// Two vertices at the rim, with the same position in plan and different heights.
    TwoHeights([u32; 2]),
    /// Two faces whose edges at the rim have the same ends in plan, but other heights: the surface
    /// has a crack between them.
    Crack {
        /// The faces.
        faces: [u32; 2],
        /// The corner of the first face that is opposite the edge.
        corner: usize,
    },
    /// A face whose neighbor across edge `i` has a different kind for the edge.
    Kinds(u32, usize),
    /// A face whose circumcircle contains the vertex across its unconstrained edge `i`.
    NotDelaunay(u32, usize),
}

impl std::fmt::Display for SurfaceFlaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SurfaceFlaw::Vertex(v) => {
                write!(f, "vertex {v}: a coordinate is not finite or out of range")
            }
            SurfaceFlaw::NotMutual(face, i) => write!(
                f,
                "face {face}, edge {i}: its neighbor does not share the edge"
            ),
            SurfaceFlaw::Orientation(face) => {
                write!(f, "face {face}: no area in plan, or clockwise")
            }
            SurfaceFlaw::NotManifold(v) => {
                write!(f, "vertex {v}: its faces do not form a single fan")
            }
            SurfaceFlaw::TwoHeights([a, b]) => {
                write!(
                    f,
                    "vertices {a} and {b}: one position, but different heights"
                )
            }
            SurfaceFlaw::Crack {
                faces: [one, other],
                ..
            } => {
                write!(
                    f,
                    "faces {one} and {other}: their edges have one position, but different heights: a crack"
                )
            }
            SurfaceFlaw::Kinds(face, i) => {
                write!(
                    f,
                    "face {face}, edge {i}: for its neighbor the edge is of another kind"
                )
            }
            SurfaceFlaw::NotDelaunay(face, i) => {
                write!(
                    f,
                    "face {face}, edge {i}: the vertex beyond lies in the circumcircle"
                )
            }
        }
    }
}

impl SurfaceFlaw {
    /// Returns the vertices of the flaw: one, the ends of an edge, or the corners of a face.
    pub fn vertices(&self, surface: &dyn Surface) -> Vec<u32> {
        let corners = |face| surface.face(face).into_iter();
        match *self {
            SurfaceFlaw::Vertex(v) | SurfaceFlaw::NotManifold(v) => vec![v],
            SurfaceFlaw::Orientation(face) => corners(face).flatten().collect(),
            SurfaceFlaw::TwoHeights([a, _]) => vec![a],
            SurfaceFlaw::NotMutual(face, i)
            | SurfaceFlaw::Kinds(face, i)
            | SurfaceFlaw::Crack {
                faces: [face, _],
                corner: i,
            }
            | SurfaceFlaw::NotDelaunay(face, i) => {
                corners(face).flat_map(|corners| edge(corners, i)).collect()
            }
        }
    }
}

/// Returns the flaws of a surface in shape and in the constrained Delaunay law.
///
/// These are the [`shape_flaws`], and edges that violate the law: unconstrained inner edges between
/// whole triangles. The law does not hold for fragments of cut triangles, so they are not checked.
/// Ties count as Delaunay. Each check relies on those before it; so only the flaws of the first
/// kind that has any are returned, but all of these.
///
/// # Complexity
/// That of [`shape_flaws`].
#[must_use]
pub fn surface_flaws(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let flaws = shape_flaws(surface);
    if flaws.is_empty() {
        bad_circles(surface)
    } else {
        flaws
    }
}

/// Returns the flaws of a surface in its shape.
///
/// The checks are: finite vertices, mutual links, orientation, fans around the vertices, one height
/// at each position, and one kind for each edge. These hold for any surface, even if its
/// constrained edges are unknown. All flaws of the first kind that has any are returned.
///
/// Two vertices at one position are both at the rim, unless faces overlap.
///
/// # Complexity
/// Linear, and O(n log n) in the edges at the rim.
#[must_use]
pub fn shape_flaws(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let checks: [fn(&dyn Surface) -> Vec<SurfaceFlaw>; 6] = [
        bad_vertices,
        bad_links,
        bad_orientations,
        bad_fans,
        bad_heights,
        bad_kinds,
    ];
    checks
        .iter()
        .map(|check| check(surface))
        .find(|flaws| !flaws.is_empty())
        .unwrap_or_default()
}

fn bad_vertices(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let geometry = Terrain::<Wide>::default();
    let bad = |v: u32| {
        let p = surface.position(v);
        !geometry.admits(&p) || !p[2].is_finite()
    };
    let mut flaws: Vec<u32> = data::corners(surface)
        .flat_map(|(_, corners)| corners)
        .filter(|&v| bad(v))
        .collect();
    flaws.sort_unstable();
    flaws.dedup();
    flaws.into_iter().map(SurfaceFlaw::Vertex).collect()
}

/// The ends of edge `i`, in the order of the face.
fn edge(corners: [u32; 3], i: usize) -> [u32; 2] {
    [corners[(i + 1) % 3], corners[(i + 2) % 3]]
}

/// The neighbor across edge `i`, and the index by which it links back to the face.
fn mirror(surface: &dyn Surface, face: u32, corners: [u32; 3], i: usize) -> Option<(u32, usize)> {
    let beside = surface.neighbor(face, i)?;
    let theirs = surface.face(beside)?;
    let [a, b] = edge(corners, i);
    let j =
        (0..3).find(|&j| edge(theirs, j) == [b, a] && surface.neighbor(beside, j) == Some(face))?;
    Some((beside, j))
}

fn bad_links(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    data::corners(surface)
        .flat_map(|(face, corners)| (0..3).map(move |i| (face, corners, i)))
        .filter(|&(face, corners, i)| {
            surface.neighbor(face, i).is_some() && mirror(surface, face, corners, i).is_none()
        })
        .map(|(face, _, i)| SurfaceFlaw::NotMutual(face, i))
        .collect()
}

fn bad_orientations(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let geometry = Terrain::<Wide>::default();
    let turned = |corners: [u32; 3]| {
        let points = corners.map(|v| surface.position(v));
        geometry.orientation(points.each_ref()) != Sign::Positive
    };
    data::corners(surface)
        .filter(|&(_, corners)| turned(corners))
        .map(|(face, _)| SurfaceFlaw::Orientation(face))
        .collect()
}

/// Finds vertices whose faces overlap: a closed fan and other faces besides.
///
/// A border may pass a vertex twice, because two parts of a clipped surface may touch there.
fn bad_fans(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let mut degree = vec![0u32; surface.vertex_count()];
    let mut border = vec![false; surface.vertex_count()];
    let mut start = vec![None; surface.vertex_count()];
    for (face, corners) in data::corners(surface) {
        for (i, v) in corners.into_iter().enumerate() {
            degree[v as usize] += 1;
            start[v as usize] = Some(face);
            if surface.neighbor(face, i).is_none() {
                edge(corners, i)
                    .into_iter()
                    .for_each(|v| border[v as usize] = true);
            }
        }
    }
    let fan = |vertex: u32, start: u32| {
        let next = |&face: &u32| {
            let corners = surface.face(face)?;
            let at = corners.iter().position(|&v| v == vertex)?;
            surface.neighbor(face, (at + 1) % 3).filter(|&n| n != start)
        };
        std::iter::successors(Some(start), next)
            .take(surface.face_count())
            .count() as u32
    };
    (0..surface.vertex_count() as u32)
        .filter(|&v| {
            !border[v as usize]
                && start[v as usize].is_some_and(|face| fan(v, face) != degree[v as usize])
        })
        .map(SurfaceFlaw::NotManifold)
        .collect()
}

/// An edge at the rim, from the lower to the higher of its ends in the order of their positions.
struct RimEdge {
    ends: [[f64; 2]; 2],
    heights: [f64; 2],
    vertices: [u32; 2],
    face: u32,
    corner: usize,
}

impl RimEdge {
    fn new(surface: &dyn Surface, face: u32, corners: [u32; 3], corner: usize) -> Self {
        let mut vertices = edge(corners, corner);
        let in_plan = |[x, y, _]: [f64; 3]| [unsigned_zero(x), unsigned_zero(y)];
        if order(
            &in_plan(surface.position(vertices[0])),
            &in_plan(surface.position(vertices[1])),
        )
        .is_gt()
        {
            vertices.reverse();
        }
        let points = vertices.map(|v| surface.position(v));
        RimEdge {
            ends: points.map(in_plan),
            heights: points.map(|[_, _, z]| z),
            vertices,
            face,
            corner,
        }
    }
}

fn order(a: &[f64; 2], b: &[f64; 2]) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// Finds cracks, and vertices with the same position and different heights that are not at a crack.
fn bad_heights(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let sides =
        data::corners(surface).flat_map(|(face, corners)| (0..3).map(move |i| (face, corners, i)));
    let rim = sides.filter(|&(face, _, i)| surface.neighbor(face, i).is_none());
    let mut rim: Vec<RimEdge> = rim
        .map(|(face, corners, i)| RimEdge::new(surface, face, corners, i))
        .collect();
    rim.sort_by(|a, b| {
        order(&a.ends[0], &b.ends[0])
            .then(order(&a.ends[1], &b.ends[1]))
            .then(a.face.cmp(&b.face))
    });
    let mut flaws = Vec::new();
    let mut cracked = Vec::new();
    for pair in rim
        .windows(2)
        .filter(|pair| pair[0].ends == pair[1].ends && pair[0].heights != pair[1].heights)
    {
        flaws.push(SurfaceFlaw::Crack {
            faces: [pair[0].face, pair[1].face],
            corner: pair[0].corner,
        });
        cracked.extend(pair[0].ends);
    }
    cracked.sort_by(order);
    let of_edge =
        |edge: &RimEdge| [0, 1].map(|k| (edge.ends[k], edge.heights[k], edge.vertices[k]));
    let mut vertices: Vec<([f64; 2], f64, u32)> = rim.iter().flat_map(of_edge).collect();
    vertices.sort_by(|a, b| {
        order(&a.0, &b.0)
            .then(a.1.total_cmp(&b.1))
            .then(a.2.cmp(&b.2))
    });
    for pair in vertices
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1)
    {
        if cracked
            .binary_search_by(|end| order(end, &pair[0].0))
            .is_err()
        {
            flaws.push(SurfaceFlaw::TwoHeights([pair[0].2, pair[1].2]));
        }
    }
    flaws
}

/// Finds edges for which the faces on both sides have different kinds.
fn bad_kinds(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let line = |kind: EdgeKind| Some(kind).filter(|kind| kind.is_constrained());
    data::corners(surface)
        .flat_map(|(face, corners)| (0..3).map(move |i| (face, corners, i)))
        .filter(|&(face, corners, i)| {
            mirror(surface, face, corners, i).is_some_and(|(beside, j)| {
                face < beside
                    && line(surface.edge_kind(face, i)) != line(surface.edge_kind(beside, j))
            })
        })
        .map(|(face, _, i)| SurfaceFlaw::Kinds(face, i))
        .collect()
}

fn bad_circles(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let geometry = Terrain::<Wide>::default();
    let mut flaws = Vec::new();
    for (face, corners) in data::corners(surface) {
        let points = corners.map(|v| surface.position(v));
        for i in (0..3).filter(|&i| !surface.is_constrained(face, i)) {
            let Some((beside, j)) = mirror(surface, face, corners, i) else {
                continue;
            };
            if surface.is_fragment(face) || surface.is_fragment(beside) {
                continue;
            }
            let Some(theirs) = surface.face(beside) else {
                continue;
            };
            let far = surface.position(theirs[j]);
            if face < beside && geometry.side_of_sphere(points.each_ref(), &far) == Sign::Positive {
                flaws.push(SurfaceFlaw::NotDelaunay(face, i));
            }
        }
    }
    flaws
}

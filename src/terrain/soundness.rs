use crate::data::{self, Surface};
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::kernel::Wide;
use crate::triangulation::num::Sign;

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
    /// A face whose circumcircle contains the vertex across its unconstrained edge `i`.
    NotDelaunay(u32, usize),
}

impl std::fmt::Display for SurfaceFlaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SurfaceFlaw::Vertex(v) => write!(f, "vertex {v}: a coordinate is not finite or out of range"),
            SurfaceFlaw::NotMutual(face, i) => write!(f, "face {face}, edge {i}: its neighbor does not share the edge"),
            SurfaceFlaw::Orientation(face) => write!(f, "face {face}: no area in plan, or clockwise"),
            SurfaceFlaw::NotManifold(v) => write!(f, "vertex {v}: its faces do not form a single fan"),
            SurfaceFlaw::NotDelaunay(face, i) => {
                write!(f, "face {face}, edge {i}: the vertex beyond lies in the circumcircle")
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
            SurfaceFlaw::NotMutual(face, i) | SurfaceFlaw::NotDelaunay(face, i) => {
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
/// Linear.
#[must_use]
pub fn surface_flaws(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let flaws = shape_flaws(surface);
    if flaws.is_empty() { bad_circles(surface) } else { flaws }
}

/// Returns the flaws of a surface in its shape.
///
/// The checks are: finite vertices, mutual links, orientation, and fans around the vertices. These
/// hold for any surface, even if its constrained edges are unknown. All flaws of the first kind
/// that has any are returned.
///
/// # Complexity
/// Linear.
#[must_use]
pub fn shape_flaws(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let checks: [fn(&dyn Surface) -> Vec<SurfaceFlaw>; 4] = [bad_vertices, bad_links, bad_orientations, bad_fans];
    checks.iter().map(|check| check(surface)).find(|flaws| !flaws.is_empty()).unwrap_or_default()
}

fn bad_vertices(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let geometry = Terrain::<Wide>::default();
    let bad = |v: u32| {
        let p = surface.position(v);
        !geometry.admits(&p) || !p[2].is_finite()
    };
    let mut flaws: Vec<u32> = data::corners(surface).flat_map(|(_, corners)| corners).filter(|&v| bad(v)).collect();
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
    let j = (0..3).find(|&j| edge(theirs, j) == [b, a] && surface.neighbor(beside, j) == Some(face))?;
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
                edge(corners, i).into_iter().for_each(|v| border[v as usize] = true);
            }
        }
    }
    let fan = |vertex: u32, start: u32| {
        let next = |&face: &u32| {
            let corners = surface.face(face)?;
            let at = corners.iter().position(|&v| v == vertex)?;
            surface.neighbor(face, (at + 1) % 3).filter(|&n| n != start)
        };
        std::iter::successors(Some(start), next).take(surface.face_count()).count() as u32
    };
    (0..surface.vertex_count() as u32)
        .filter(|&v| !border[v as usize] && start[v as usize].is_some_and(|face| fan(v, face) != degree[v as usize]))
        .map(SurfaceFlaw::NotManifold)
        .collect()
}

fn bad_circles(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let geometry = Terrain::<Wide>::default();
    let mut flaws = Vec::new();
    for (face, corners) in data::corners(surface) {
        let points = corners.map(|v| surface.position(v));
        for i in (0..3).filter(|&i| !surface.is_constrained(face, i)) {
            let Some((beside, j)) = mirror(surface, face, corners, i) else { continue };
            if surface.is_fragment(face) || surface.is_fragment(beside) {
                continue;
            }
            let Some(theirs) = surface.face(beside) else { continue };
            let far = surface.position(theirs[j]);
            if face < beside && geometry.side_of_sphere(points.each_ref(), &far) == Sign::Positive {
                flaws.push(SurfaceFlaw::NotDelaunay(face, i));
            }
        }
    }
    flaws
}

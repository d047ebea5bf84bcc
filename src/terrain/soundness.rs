use crate::data::{self, Surface};
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::kernel::Wide;
use crate::triangulation::num::Sign;

/// What is wrong with a surface of triangles, found with exact predicates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceFlaw {
    /// A vertex of a face has a coordinate that is not finite or too large or small to compute with.
    Vertex(u32),
    /// The neighbor across edge `i` of this face does not know it, or has another edge there.
    NotMutual(u32, usize),
    /// A face that has no area in plan, or is turned around.
    Orientation(u32),
    /// The faces around a vertex do not form one fan.
    NotManifold(u32),
    /// The vertex across the unconstrained edge `i` lies in the circumscribed circle of this face.
    NotDelaunay(u32, usize),
}

impl std::fmt::Display for SurfaceFlaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SurfaceFlaw::Vertex(v) => write!(f, "vertex {v}: a coordinate is not finite or out of range"),
            SurfaceFlaw::NotMutual(face, i) => write!(f, "face {face}, edge {i}: its neighbor does not share the edge"),
            SurfaceFlaw::Orientation(face) => write!(f, "face {face}: no area in plan, or turned around"),
            SurfaceFlaw::NotManifold(v) => write!(f, "vertex {v}: its faces do not hang together"),
            SurfaceFlaw::NotDelaunay(face, i) => {
                write!(f, "face {face}, edge {i}: the vertex beyond lies in the circumscribed circle")
            }
        }
    }
}

impl SurfaceFlaw {
    /// The vertices at which it shows: one, the ends of an edge, or the corners of a face.
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

/// Checks any surface as far as faces and neighbors tell: [`shape_flaws`], and the constrained Delaunay law across each
/// inner unconstrained edge between whole triangles, which is not asked of pieces of cut ones. Ties count as
/// Delaunay. Returns all flaws of the first kind that has any, as each check relies on those before.
///
/// # Complexity
/// Linear.
#[must_use]
pub fn surface_flaws(surface: &dyn Surface) -> Vec<SurfaceFlaw> {
    let flaws = shape_flaws(surface);
    if flaws.is_empty() { bad_circles(surface) } else { flaws }
}

/// Checks finite vertices, mutual links, orientation and fans around the vertices: what holds of any surface, also where
/// it is not known which edges are constrained. Returns all flaws of the first kind that has any.
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

/// The corners beside edge `i`, in the order of the face.
fn edge(corners: [u32; 3], i: usize) -> [u32; 2] {
    [corners[(i + 1) % 3], corners[(i + 2) % 3]]
}

/// The index by which the neighbor across edge `i` knows the face.
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

/// A border that passes a vertex twice is allowed (two pieces of a clipped surface may touch there), a
/// closed fan beside another face is not: the faces would overlap.
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

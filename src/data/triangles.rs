use super::Surface;
use crate::crs::Crs;

/// Triangles as a file lists them, whether they are a surface or not.
#[derive(Debug, Clone, Default)]
pub struct Triangles {
    /// Places; not all need to be used.
    pub vertices: Vec<[f64; 3]>,
    /// Corners, as positions among the vertices.
    pub faces: Vec<[u32; 3]>,
    /// Edges that are breaklines or other constraints.
    pub constrained_edges: Vec<[u32; 2]>,
    /// Edges along which the surface was cut.
    pub clip_edges: Vec<[u32; 2]>,
    /// Positions of the faces that are pieces of triangles that were cut, in ascending order.
    pub fragments: Vec<u32>,
    /// The face opposite each corner, where the file says so.
    pub neighbors: Option<Vec<[Option<u32>; 3]>>,
    /// Coordinate system, if known.
    pub crs: Option<Crs>,
}

/// Why triangles are no surface, found while linking them ([`Mesh::link`](super::Mesh::link)). Numbers count
/// from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkFlaw {
    /// Two faces run the same way along an edge: they overlap, or one is turned around.
    Folded {
        /// The faces.
        faces: [u32; 2],
        /// The vertices of the edge.
        edge: [u32; 2],
    },
    /// A vertex has a coordinate that is not finite, and no face has it as a corner.
    StrayVertex(u32),
    /// A constraint between these vertices is no edge of a face.
    NoEdge([u32; 2]),
    /// The file names another neighbor than the face that has the same edge.
    Neighbor {
        /// The face.
        face: u32,
        /// The corner opposite the edge.
        corner: usize,
        /// What the file says.
        stated: Option<u32>,
        /// What the edges say.
        found: Option<u32>,
    },
}

impl LinkFlaw {
    /// The vertices at which it shows: one, or the ends of an edge. Those of a constraint that is none may not exist.
    pub fn vertices(&self, surface: &dyn Surface) -> Vec<u32> {
        match *self {
            LinkFlaw::Folded { edge, .. } | LinkFlaw::NoEdge(edge) => edge.to_vec(),
            LinkFlaw::StrayVertex(vertex) => vec![vertex],
            LinkFlaw::Neighbor { face, corner, .. } => {
                let corners = surface.face(face).into_iter();
                corners.flat_map(|corners| [1, 2].map(|k| corners[(corner + k) % 3])).collect()
            }
        }
    }
}

impl std::fmt::Display for LinkFlaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = |face: Option<u32>| face.map_or("none".to_owned(), |face| face.to_string());
        match *self {
            LinkFlaw::Folded { faces: [one, other], edge: [a, b] } => {
                write!(f, "faces {one} and {other}: both run the same way along their edge {a} {b}")
            }
            LinkFlaw::StrayVertex(vertex) => {
                write!(f, "vertex {vertex}: a coordinate is not finite (no face uses it, but no reader can take it)")
            }
            LinkFlaw::NoEdge([a, b]) => write!(f, "the constrained edge {a} {b} is no edge of a face"),
            LinkFlaw::Neighbor { face, corner, stated, found } => {
                let (stated, found) = (name(stated), name(found));
                write!(f, "face {face}, edge {corner}: its neighbor is stated as {stated}, by its edges it is {found}")
            }
        }
    }
}

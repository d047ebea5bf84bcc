use super::{EdgeKind, Surface};
use crate::crs::Crs;
use crate::error::Wording;

/// Triangles as a file lists them; they need not form a surface.
#[derive(Debug, Clone, Default)]
pub struct Triangles {
    /// The coordinates of the vertices; some may be unused.
    pub vertices: Vec<[f64; 3]>,
    /// The corners of each face, as indices of vertices.
    pub faces: Vec<[u32; 3]>,
    /// Edges on lines, with their kinds. An edge that is listed with several kinds has the last.
    pub lines: Vec<([u32; 2], EdgeKind)>,
    /// The indices of the faces that are fragments of triangles that were cut, in ascending order.
    pub fragments: Vec<u32>,
    /// The kind of the edge opposite each corner of each face, if the file states kinds by faces.
    pub sides: Option<Vec<[EdgeKind; 3]>>,
    /// The face opposite each corner of each face, if the file states neighbors.
    pub neighbors: Option<Vec<[Option<u32>; 3]>>,
    /// The coordinate system, if known.
    pub crs: Option<Crs>,
    /// Warnings for the user.
    pub warnings: Vec<Wording>,
}

/// Why triangles do not form a surface, found by [`Mesh::link`](super::Mesh::link). Numbers count
/// from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkFlaw {
    /// Two faces pass an edge in the same direction: they overlap, or one of them is reversed.
    Folded {
        /// The faces.
        faces: [u32; 2],
        /// The vertices of the edge.
        edge: [u32; 2],
    },
    /// A vertex with a coordinate that is not finite, and that is not a corner of any face.
    StrayVertex(u32),
    /// A constrained edge between these vertices that is not an edge of any face.
    NoEdge([u32; 2]),
    /// Two faces state different kinds for the edge that they share.
    Kinds {
        /// The faces.
        faces: [u32; 2],
        /// The vertices of the edge.
        edge: [u32; 2],
        /// The kind that each face states.
        kinds: [EdgeKind; 2],
    },
    /// The file states a neighbor other than the face that shares the edge.
    Neighbor {
        /// The face.
        face: u32,
        /// The corner opposite the edge.
        corner: usize,
        /// The neighbor that the file states.
        stated: Option<u32>,
        /// The neighbor by the shared edge.
        found: Option<u32>,
    },
}

impl LinkFlaw {
    /// Returns the vertices of the flaw: one, or the ends of an edge.
    ///
    /// The ends of a constrained edge that is not an edge of any face may not exist.
    pub fn vertices(&self, surface: &dyn Surface) -> Vec<u32> {
        match *self {
            LinkFlaw::Folded { edge, .. }
            | LinkFlaw::NoEdge(edge)
            | LinkFlaw::Kinds { edge, .. } => edge.to_vec(),
            LinkFlaw::StrayVertex(vertex) => vec![vertex],
            LinkFlaw::Neighbor { face, corner, .. } => {
                let corners = surface.face(face).into_iter();
                corners
                    .flat_map(|corners| [1, 2].map(|k| corners[(corner + k) % 3]))
                    .collect()
            }
        }
    }
}

impl std::fmt::Display for LinkFlaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = |face: Option<u32>| face.map_or("none".to_owned(), |face| face.to_string());
        match *self {
            LinkFlaw::Folded {
                faces: [one, other],
                edge: [a, b],
            } => {
                write!(
                    f,
                    "faces {one} and {other}: both pass their edge {a} {b} in the same direction"
                )
            }
            LinkFlaw::StrayVertex(vertex) => {
                write!(
                    f,
                    "vertex {vertex}: a coordinate is not finite (no face uses it, but no reader can take it)"
                )
            }
            LinkFlaw::NoEdge([a, b]) => {
                write!(f, "the constrained edge {a} {b} is not an edge of any face")
            }
            LinkFlaw::Kinds {
                faces: [one, other],
                edge: [a, b],
                kinds,
            } => {
                let [first, second] = kinds.map(EdgeKind::noun);
                write!(
                    f,
                    "faces {one} and {other}: their edge {a} {b} is of {first} in one, of {second} in the other"
                )
            }
            LinkFlaw::Neighbor {
                face,
                corner,
                stated,
                found,
            } => {
                let (stated, found) = (name(stated), name(found));
                write!(
                    f,
                    "face {face}, edge {corner}: its neighbor is stated as {stated}, by its edges it is {found}"
                )
            }
        }
    }
}

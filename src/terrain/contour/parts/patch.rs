//! Triangles of a task that meet a level, as a mesh.

use super::VertexKey;
use super::keyed::Keyed;
use crate::data::{self, LinkFlaw, Mesh, Surface, Triangles};
use crate::error::{Error, Result};
use crate::terrain::contour::index::LevelIndex;
use crate::terrain::contour::narrow::{self, Narrowness};
use crate::terrain::tiles::{TileTriangle, TileVertex};
use rustc_hash::FxHashMap;

/// Triangles that are not linked yet.
#[derive(Default)]
pub(super) struct Patch {
    number_of: FxHashMap<VertexKey, u32>,
    vertices: Vec<[f64; 3]>,
    /// The key of each vertex.
    keys: Vec<VertexKey>,
    faces: Vec<[u32; 3]>,
}

/// Triangles, linked to their neighbors.
pub(super) struct LinkedPatch {
    pub(super) mesh: Mesh,
    /// The key of each vertex.
    keys: Vec<VertexKey>,
}

impl Patch {
    pub(super) fn push(&mut self, triangle: &TileTriangle) {
        let Patch {
            number_of,
            vertices,
            keys,
            faces,
        } = self;
        faces.push(triangle.corners.map(
            |TileVertex {
                 tile,
                 number,
                 position,
                 ..
             }| {
                *number_of.entry([tile, number]).or_insert_with(|| {
                    vertices.push(position);
                    keys.push([tile, number]);
                    vertices.len() as u32 - 1
                })
            },
        ));
    }

    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Links the faces that share an edge.
    ///
    /// # Errors
    /// If two of them are on the same side of an edge.
    pub(super) fn linked(self) -> Result<LinkedPatch> {
        let Patch {
            vertices,
            keys,
            faces,
            ..
        } = self;
        let (mesh, flaws) = Mesh::link(Triangles {
            vertices,
            faces,
            ..Triangles::default()
        })?;
        if let Some(&LinkFlaw::Folded { edge, .. }) = flaws.first() {
            let [a, b] = edge.map(|end| mesh.position(end));
            return Err(Error::usage(format!(
                "two triangles are on the same side of the edge from {a:?} to {b:?}"
            ))
            .cure("give each triangle of the whole to one collector, once"));
        }
        Ok(LinkedPatch { mesh, keys })
    }
}

impl LinkedPatch {
    /// The mesh as a part of the whole.
    pub(super) fn keyed(&self) -> Keyed<'_, Mesh, impl Fn(u32) -> VertexKey> {
        Keyed {
            surface: &self.mesh,
            key_of: |vertex: u32| self.keys[vertex as usize],
        }
    }

    /// The sites at narrow faces, each with the index of its level.
    pub(super) fn narrow_sites(
        &self,
        index: &LevelIndex,
        narrowness: Narrowness,
    ) -> Vec<(usize, Vec<[f64; 2]>)> {
        let is_narrow =
            |corners: [u32; 3]| narrowness.includes(corners.map(|v| self.mesh.position(v)));
        let narrow = data::corners(&self.mesh).filter(|&(_, corners)| is_narrow(corners));
        let sites = narrow.flat_map(|(face, _)| narrowness.sites_of(&self.mesh, index, face));
        narrow::by_level(sites.collect())
    }
}

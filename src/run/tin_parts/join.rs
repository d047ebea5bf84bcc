//! All parts as one mesh.

use rustc_hash::FxHashMap;

use super::TinParts;
use crate::data::{Mesh, Surface, Triangles};
use crate::error::{Error, Result};
use crate::io::mapped::Mapped;
use crate::terrain::CompactTin;
use crate::terrain::tiles::TileVertex;

/// Stands for a vertex that no face has used so far.
const UNUSED: u32 = u32::MAX;

/// Joins the parts: vertices that stand for the same point are one.
pub(super) fn joined(parts: &TinParts) -> Result<Mesh> {
    let shared = shared_vertices(parts)?;
    let mut joined = Joined { shared, triangles: Triangles { crs: parts.crs().cloned(), ..Triangles::default() } };
    for number in 0..parts.index().parts.len() {
        joined.add(&parts.part(number)?)?;
    }
    Mesh::of(joined.triangles)
}

/// The vertices of triangles between tiles. They may be vertices of several parts; all others are
/// those of one.
fn shared_vertices(parts: &TinParts) -> Result<FxHashMap<[u32; 2], u32>> {
    let mut shared = FxHashMap::default();
    for (number, _) in parts.index().parts.iter().enumerate().filter(|(_, part)| part.tile.is_none()) {
        let part = parts.part(number)?;
        let vertices = (0..part.vertex_count() as u32).filter_map(|vertex| part.tile_vertex(vertex));
        shared.extend(vertices.map(|TileVertex { tile, number, .. }| ([tile, number], UNUSED)));
        part.ensure_intact()?;
    }
    Ok(shared)
}

struct Joined {
    /// The number of each shared vertex in the mesh.
    shared: FxHashMap<[u32; 2], u32>,
    triangles: Triangles,
}

impl Joined {
    fn add(&mut self, part: &CompactTin<Mapped>) -> Result<()> {
        let Joined { shared, triangles } = self;
        let mut number_of = vec![UNUSED; part.vertex_count()];
        for face in 0..part.face_count() as u32 {
            let Some(corners) = part.face(face) else { continue };
            for vertex in corners {
                let number = &mut number_of[vertex as usize];
                if *number != UNUSED {
                    continue;
                }
                let Some(TileVertex { tile, number: own, position }) = part.tile_vertex(vertex) else { continue };
                let next = triangles.vertices.len() as u32;
                *number = match shared.get_mut(&[tile, own]) {
                    Some(number) if *number != UNUSED => *number,
                    Some(number) => {
                        *number = next;
                        next
                    }
                    None => next,
                };
                if *number == next {
                    triangles.vertices.push(position);
                }
            }
            let of_face = corners.map(|vertex| number_of[vertex as usize]);
            if part.is_fragment(face) {
                triangles.fragments.push(triangles.faces.len() as u32);
            }
            triangles.faces.push(of_face);
            for i in 0..3 {
                let kind = part.edge_kind(face, i);
                if kind.is_constrained() && part.neighbor(face, i).is_none_or(|other| face < other) {
                    triangles.lines.push(([of_face[(i + 1) % 3], of_face[(i + 2) % 3]], kind));
                }
            }
        }
        part.ensure_intact()?;
        if triangles.vertices.len() >= UNUSED as usize || triangles.faces.len() >= UNUSED as usize {
            return Err(Error::limit("the parts have more triangles than one mesh can number")
                .cure("make the raster or the contours of the parts as they are, with linear heights"));
        }
        Ok(())
    }
}

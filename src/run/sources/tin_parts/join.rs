//! Joins the parts.

use rustc_hash::FxHashMap;

use super::TinParts;
use super::joined::JoinedTin;
use crate::crs::Crs;
use crate::data::{BaseFace, EdgeKind, Mesh, Surface, SurfaceFacts, Triangles};
use crate::error::{Command, Error, Result, wording};
use crate::io::mapped::Mapped;
use crate::run::context::memory;
use crate::run::sources::checksum::checksum;
use crate::terrain::CompactTin;
use crate::terrain::tiles::TileVertex;

/// Stands for a vertex that no face has used so far.
const UNUSED: u32 = u32::MAX;

impl TinParts {
    /// Returns all parts as one surface, which is kept.
    ///
    /// # Errors
    /// If the parts do not fit into memory, a part is damaged, or the parts do not make a surface.
    ///
    /// # Complexity
    /// Linear in the bytes of the parts.
    pub(crate) fn joined(&self) -> Result<&JoinedTin> {
        if let Some(joined) = self.joined.get() {
            return Ok(joined);
        }
        let mut triangles = 0;
        for number in 0..self.index.parts.len() {
            triangles += self.part(number)?.face_count();
        }
        memory::require_for_parts(triangles).map_err(|e| e.in_file(&self.path))?;
        let joined = joined(self).map_err(|e| e.in_file(&self.path))?;
        Ok(self.joined.get_or_init(|| joined))
    }

    /// Checks all bytes of all parts, and that the counts and the extents that the index states are
    /// those of the parts.
    ///
    /// # Errors
    /// The first damage that is found, and if the parts are too many for one mesh.
    ///
    /// # Complexity
    /// Linear.
    pub fn check(&self) -> Result<()> {
        for (number, stated) in self.index.parts.iter().enumerate() {
            let part = self.part(number)?;
            part.check()?;
            if checksum(part.triangulation().bytes()) != stated.checksum {
                return Err(Error::format("the checksum is not that of the index")
                    .in_file(self.folder.join(&stated.file))
                    .cure("copy the index together with its folder, or write the surface again"));
            }
            let SurfaceFacts {
                triangles, extent, ..
            } = part.facts();
            if (*triangles as u64, *extent) != (stated.triangles, stated.extent) {
                return Err(Error::format(format!(
                    "the counts or the extent of {} are not those of its file",
                    stated.file
                ))
                .in_file(&self.path)
                .cure(wording!["write the surface again with ", Command::Tin]));
            }
        }
        if SurfaceFacts::of(self.joined()?) != self.index.facts {
            return Err(
                Error::format("the counts or the extent are not those of the parts")
                    .in_file(&self.path)
                    .cure(wording!["write the surface again with ", Command::Tin]),
            );
        }
        Ok(())
    }
}

/// Joins the parts: vertices that stand for the same point are one.
fn joined(parts: &TinParts) -> Result<JoinedTin> {
    let mut joining = Joining {
        shared: shared_vertices(parts)?,
        ..Joining::default()
    };
    for number in 0..parts.index().parts.len() {
        joining.add(&parts.part(number)?)?;
    }
    joining.finish(parts.crs().cloned())
}

/// The vertices of triangles between tiles. They may be vertices of several parts; all others are
/// those of one.
fn shared_vertices(parts: &TinParts) -> Result<FxHashMap<[u32; 2], u32>> {
    let mut shared = FxHashMap::default();
    for (number, _) in parts
        .index()
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| part.tile.is_none())
    {
        let part = parts.part(number)?;
        let vertices =
            (0..part.vertex_count() as u32).filter_map(|vertex| part.tile_vertex(vertex));
        shared.extend(vertices.map(|TileVertex { tile, number, .. }| ([tile, number], UNUSED)));
        part.ensure_intact()?;
    }
    Ok(shared)
}

/// An edge on a line, by its vertices.
type Line = ([u32; 2], EdgeKind);

/// Faces, with the kinds of the edges opposite their corners.
#[derive(Default)]
struct Faces {
    corners: Vec<[u32; 3]>,
    sides: Vec<[EdgeKind; 3]>,
}

impl Faces {
    fn push(&mut self, corners: [u32; 3], sides: [EdgeKind; 3]) {
        self.corners.push(corners);
        self.sides.push(sides);
    }

    fn append(&mut self, other: &mut Faces) {
        self.corners.append(&mut other.corners);
        self.sides.append(&mut other.sides);
    }
}

/// What of the parts was joined so far.
#[derive(Default)]
struct Joining {
    /// The number of each shared vertex.
    shared: FxHashMap<[u32; 2], u32>,
    vertices: Vec<[f64; 3]>,
    whole: Faces,
    fragments: Faces,
    lines: Vec<Line>,
    /// The triangles that are only under the surface, and the lines under it.
    left_out: Vec<[u32; 3]>,
    lines_under: Vec<Line>,
}

impl Joining {
    fn add(&mut self, part: &CompactTin<Mapped>) -> Result<()> {
        let mut number_of = vec![UNUSED; part.vertex_count()];
        for face in 0..part.face_count() as u32 {
            let Some(corners) = part.face(face) else {
                continue;
            };
            let of_face = corners.map(|vertex| self.number(part, vertex, &mut number_of));
            let kinds = [0, 1, 2].map(|i| part.edge_kind(face, i));
            let faces = if part.is_fragment(face) {
                &mut self.fragments
            } else {
                &mut self.whole
            };
            faces.push(of_face, kinds);
            let is_listed = |i: &usize| part.neighbor(face, *i).is_none_or(|other| face < other);
            self.lines.extend(
                (0..3)
                    .filter(is_listed)
                    .filter_map(|i| line(of_face, i, kinds[i])),
            );
        }
        for BaseFace {
            number,
            corners,
            edges,
            ..
        } in part.faces_under_whole()
        {
            let of_face = corners.map(|vertex| self.number(part, vertex, &mut number_of));
            if part.face(number).is_none() {
                self.left_out.push(of_face);
            }
            self.lines_under
                .extend((0..3).filter_map(|i| line(of_face, i, edges[i])));
        }
        part.ensure_intact()?;
        let faces = self
            .whole
            .corners
            .len()
            .max(self.fragments.corners.len())
            .max(self.left_out.len());
        if self.vertices.len() >= UNUSED as usize || faces >= UNUSED as usize {
            return Err(
                Error::limit("the parts have more triangles than one mesh can number").cure(
                    "make the raster or the contours of the parts as they are, with linear heights",
                ),
            );
        }
        Ok(())
    }

    /// Returns the number of a vertex of a part, which is given one with its first use.
    fn number(&mut self, part: &CompactTin<Mapped>, vertex: u32, number_of: &mut [u32]) -> u32 {
        let number = &mut number_of[vertex as usize];
        if *number != UNUSED {
            return *number;
        }
        // What is damaged is an error after the part.
        let Some(TileVertex {
            tile,
            number: own,
            position,
            ..
        }) = part.tile_vertex(vertex)
        else {
            return 0;
        };
        let next = self.vertices.len() as u32;
        *number = match self.shared.get_mut(&[tile, own]) {
            Some(number) if *number != UNUSED => *number,
            Some(number) => {
                *number = next;
                next
            }
            None => next,
        };
        if *number == next {
            self.vertices.push(position);
        }
        *number
    }

    fn finish(self, crs: Option<Crs>) -> Result<JoinedTin> {
        let Joining {
            vertices,
            mut whole,
            mut fragments,
            lines,
            mut left_out,
            lines_under,
            ..
        } = self;
        let count = whole.corners.len() as u32;
        let under = match (fragments.corners.is_empty(), left_out.is_empty()) {
            (true, true) => None,
            _ => {
                left_out.splice(0..0, whole.corners.iter().copied());
                let (vertices, faces) = (vertices.clone(), left_out);
                Some(Mesh::of(Triangles {
                    vertices,
                    faces,
                    lines: lines_under,
                    ..Triangles::default()
                })?)
            }
        };
        let numbers = (count..).take(fragments.corners.len()).collect();
        whole.append(&mut fragments);
        let Faces {
            corners: faces,
            sides,
        } = whole;
        let sides = Some(sides);
        let faces = Mesh::of(Triangles {
            vertices,
            faces,
            lines,
            fragments: numbers,
            sides,
            crs,
            ..Triangles::default()
        })?;
        Ok(JoinedTin {
            faces,
            under,
            whole: count,
        })
    }
}

/// Returns the edge opposite corner `i` of a face, if it is on a line.
fn line(face: [u32; 3], i: usize, kind: EdgeKind) -> Option<Line> {
    kind.is_constrained()
        .then_some(([face[(i + 1) % 3], face[(i + 2) % 3]], kind))
}

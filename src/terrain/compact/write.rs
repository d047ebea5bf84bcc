//! A TIN as bytes.

use std::io::{self, BufWriter, Write};

use super::attributes::Attributes;
use super::layout::{
    ATTRIBUTES, FRAGMENTS, Fragment, INSIDE, NUMBERS, OpenSide, SIDES, UNDER, VERTICES,
};
use crate::data::{EdgeKind, Face, Surface, SurfaceFacts};
use crate::error::{Error, Result};
use crate::terrain::lines::kinds::LineKinds;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{CompactSection, ConstrainedDelaunay};

/// Writes a surface over a triangulation, and the triangulation: faces and vertices of the surface
/// have the numbers of cells and vertices; those of fragments follow.
///
/// # Errors
/// Those of `out`, and if there are too many faces or vertices to be numbered.
///
/// # Complexity
/// Linear; in memory are a bit for each cell, and the fragments.
pub(crate) fn write(
    surface: &dyn Surface,
    triangulation: &ConstrainedDelaunay<Terrain>,
    kinds: &LineKinds,
    out: &mut dyn Write,
) -> Result<()> {
    // The rows are of a few bytes.
    let mut out = BufWriter::with_capacity(1 << 16, out);
    let facts = SurfaceFacts::of(surface);
    let layers = Layers::of(
        surface,
        triangulation,
        facts.edges.has_various() || !kinds.are_breaklines(),
    )?;
    triangulation.write_compact(&mut out)?;
    layers.write(&mut out)?;
    let attributes = Attributes {
        crs: surface.crs().cloned(),
        facts,
    };
    write_attributes(&attributes, &mut out)?;
    Ok(out.flush()?)
}

/// Writes the sections of a TIN that is part of a larger surface, after the others: the tile and
/// the number of each vertex, and for each cell, true for a triangle that is
/// [under](super::PartCell::Under) the surface or a face of it.
///
/// # Errors
/// Those of `out`.
pub(crate) fn write_part(
    numbers: &[[u32; 2]],
    under: impl ExactSizeIterator<Item = bool>,
    mut out: &mut dyn Write,
) -> Result<()> {
    let contents: Vec<u8> = numbers
        .as_flattened()
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    CompactSection {
        tag: NUMBERS,
        contents: &contents,
    }
    .write(&mut out)?;
    let mut bits = vec![0_u8; under.len().div_ceil(8)];
    under
        .enumerate()
        .for_each(|(at, is_under)| bits[at / 8] |= u8::from(is_under) << (at % 8));
    Ok(CompactSection {
        tag: UNDER,
        contents: &bits,
    }
    .write(&mut out)?)
}

/// Writes the section of coordinate system, counts and extent.
pub(super) fn write_attributes(attributes: &Attributes, out: &mut impl Write) -> Result<()> {
    Ok(CompactSection {
        tag: ATTRIBUTES,
        contents: attributes.to_json().as_bytes(),
    }
    .write(out)?)
}

/// What a surface has beside its triangulation, in bytes.
struct Layers {
    inside: Vec<u8>,
    vertices: Vec<u8>,
    fragments: Vec<u8>,
    sides: Vec<u8>,
}

impl Layers {
    fn of(
        surface: &dyn Surface,
        triangulation: &ConstrainedDelaunay<Terrain>,
        has_kinds: bool,
    ) -> Result<Self> {
        let tds = triangulation.tds();
        let mut fragments: Vec<Face> = Vec::new();
        surface.faces_in(
            tds.cell_slots() as u32..surface.face_count() as u32,
            &mut fragments,
        );
        let is_added = |vertex: &u32| *vertex as usize >= tds.vertex_slots();
        let mut added: Vec<u32> = fragments
            .iter()
            .flat_map(|face| face.corners)
            .filter(is_added)
            .collect();
        added.sort_unstable();
        added.dedup();
        let vertices = Numbers::new(
            tds.vertex_slots(),
            tds.vertices().map(VertexId::index),
            added,
        );
        let beyond = fragments.iter().map(|face| face.number).collect();
        let faces = Numbers::new(tds.cell_slots(), tds.cells().map(CellId::index), beyond);
        if faces.count() >= u32::MAX as usize || vertices.count() >= u32::MAX as usize {
            return Err(Error::limit(format!(
                "{} faces and {} vertices",
                faces.count(),
                vertices.count()
            )));
        }
        let renumbered = |face: &Face| {
            let neighbors =
                [0, 1, 2].map(|i| surface.neighbor(face.number, i).map(|face| faces.of(face)));
            let corners = face.corners.map(|vertex| vertices.of(vertex));
            Fragment::new(&Face { corners, ..*face }, neighbors).to_bytes()
        };
        let mut inside = vec![0; tds.cell_count().div_ceil(8)];
        let mut sides = Vec::new();
        let rows = SideRows {
            surface,
            triangulation,
            has_kinds,
            faces: &faces,
        };
        for (at, cell) in tds.cells().enumerate() {
            if surface.face(cell.index() as u32).is_some() {
                inside[at / 8] |= 1 << (at % 8);
                rows.add_of_face(cell, at as u32, &mut sides);
            } else if has_kinds {
                rows.add_under(cell, at as u32, &mut sides);
            }
        }
        let position = |&vertex: &u32| surface.position(vertex).map(f64::to_le_bytes);
        Ok(Layers {
            inside,
            vertices: vertices
                .beyond
                .iter()
                .flat_map(position)
                .flatten()
                .collect(),
            fragments: fragments.iter().flat_map(renumbered).collect(),
            sides,
        })
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let Layers {
            inside,
            vertices,
            fragments,
            sides,
        } = self;
        for (tag, contents) in [
            (INSIDE, inside),
            (VERTICES, vertices),
            (FRAGMENTS, fragments),
            (SIDES, sides),
        ] {
            CompactSection { tag, contents }.write(out)?;
        }
        Ok(())
    }
}

/// The rows of edges of triangles: of those that are more than the triangulation says.
struct SideRows<'a> {
    surface: &'a dyn Surface,
    triangulation: &'a ConstrainedDelaunay<Terrain>,
    /// True if some lines are not breaklines.
    has_kinds: bool,
    /// The numbers of faces in the file.
    faces: &'a Numbers,
}

impl SideRows<'_> {
    /// Adds the rows of a face of the surface; `number` is that in the file.
    fn add_of_face(&self, cell: CellId, number: u32, rows: &mut Vec<u8>) {
        let SideRows {
            surface,
            triangulation,
            has_kinds,
            faces,
        } = *self;
        let face = cell.index() as u32;
        for i in 0..3 {
            let beside = surface.face(triangulation.tds().neighbor(cell, i).index() as u32);
            if beside.is_some() && !has_kinds {
                continue; // the triangulation says it all
            }
            let (kind, is_breakline) = (
                surface.edge_kind(face, i),
                triangulation.is_constrained(cell, i),
            );
            // What a reader takes the edge for if it has no row.
            let derived = match beside {
                _ if is_breakline => EdgeKind::Breakline,
                Some(_) => EdgeKind::Plain,
                None => EdgeKind::Rim,
            };
            let neighbor = surface.neighbor(face, i);
            if kind != derived || beside.is_none() && neighbor.is_some() {
                let neighbor = neighbor.map(|face| faces.of(face));
                rows.extend(
                    OpenSide {
                        face: number,
                        corner: i as u8,
                        kind,
                        neighbor,
                    }
                    .to_bytes(),
                );
            }
        }
    }

    /// Adds the rows of a triangle that is not a face of the surface: of its edges on lines other
    /// than breaklines, for which methods of interpolation ask.
    fn add_under(&self, cell: CellId, number: u32, rows: &mut Vec<u8>) {
        let mut under = Vec::new();
        let face = cell.index() as u32;
        self.surface.base_faces_in(face..face + 1, &mut under);
        let kinds = under
            .first()
            .map_or([EdgeKind::Breakline; 3], |face| face.edges);
        for (corner, kind) in kinds.into_iter().enumerate() {
            if kind != EdgeKind::Breakline && self.triangulation.is_constrained(cell, corner) {
                rows.extend(
                    OpenSide {
                        face: number,
                        corner: corner as u8,
                        kind,
                        neighbor: None,
                    }
                    .to_bytes(),
                );
            }
        }
    }
}

/// Numbers without gaps, in the same order: first those of used slots, then some beyond all slots.
struct Numbers {
    slots: usize,
    used: usize,
    /// The number of each slot, if some slots are not used.
    of_slots: Option<Vec<u32>>,
    beyond: Vec<u32>,
}

impl Numbers {
    /// The numbers beyond the slots must be ascending.
    fn new(slots: usize, used: impl ExactSizeIterator<Item = usize>, beyond: Vec<u32>) -> Self {
        let count = used.len();
        let of_slots = (count < slots).then(|| {
            let mut numbers = vec![0; slots];
            used.zip(0..)
                .for_each(|(slot, number)| numbers[slot] = number);
            numbers
        });
        Numbers {
            slots,
            used: count,
            of_slots,
            beyond,
        }
    }

    fn count(&self) -> usize {
        self.used + self.beyond.len()
    }

    fn of(&self, old: u32) -> u32 {
        if old as usize >= self.slots {
            return (self.used + self.beyond.partition_point(|&other| other < old)) as u32;
        }
        self.of_slots
            .as_ref()
            .map_or(old, |numbers| numbers[old as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_gaps_and_keep_their_order() {
        let numbers = Numbers::new(6, [0, 2, 5].into_iter(), vec![7, 9]);
        assert_eq!([0, 2, 5, 7, 9].map(|old| numbers.of(old)), [0, 1, 2, 3, 4]);
        assert_eq!(numbers.count(), 5);
        let whole = Numbers::new(3, [0, 1, 2].into_iter(), vec![3, 8]);
        assert_eq!([0, 1, 2, 3, 8].map(|old| whole.of(old)), [0, 1, 2, 3, 4]);
    }
}

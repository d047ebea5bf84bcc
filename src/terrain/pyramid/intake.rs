//! What a pyramid is made of: read from a surface a batch of triangles at a time, so that the
//! surface need not be in memory.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use rustc_hash::FxHashMap;

use super::keys::key_of;
use super::lines::{Lines, OnLines, TileLines};
use super::plan::{FinestTiles, ToEarth, to_earth};
use crate::data::{EdgeKind, Surface, Tiling, area_of, map_batches};
use crate::error::{Error, Result};
use crate::terrain::cancel::go_on;
use crate::terrain::in_order::by_coordinates;
use crate::terrain::records::{Record, RecordFile, SortedRecords, Sorter};

/// Calls a function with each part of a surface, one after the other. A surface in one piece is its
/// only part.
pub type SurfaceParts<'a> = dyn Fn(&mut dyn FnMut(&dyn Surface) -> Result<()>) -> Result<()> + 'a;

/// The unit in which areas are summed, in tiles of the coarsest level: a power of two, far below
/// the area of any triangle.
const AREA: f64 = 1.0 / (1_u128 << 96) as f64;

/// Reads a surface.
pub(super) struct Intake<'a> {
    pub(super) parts: &'a SurfaceParts<'a>,
    pub(super) convert: &'a ToEarth<'a>,
    pub(super) tiling: Tiling,
    /// Where files without a name are.
    pub(super) folder: &'a Path,
    pub(super) cancel: &'a AtomicBool,
}

/// Some triangles of a surface.
struct Batch<'a> {
    surface: &'a dyn Surface,
    /// Their numbers in the surface, and those of their corners among the vertices.
    faces: Vec<(u32, [u32; 3])>,
    vertices: Vec<[f64; 3]>,
}

impl<'s> Batch<'s> {
    /// Some triangles of a surface, with the positions of their corners on the earth.
    fn of(
        surface: &'s dyn Surface,
        faces: &[(u32, [u32; 3])],
        tiling: Tiling,
        convert: &ToEarth,
    ) -> Result<Self> {
        let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
        let mut vertices = Vec::new();
        let mut number = |vertex: u32| {
            *numbers.entry(vertex).or_insert_with(|| {
                vertices.push(surface.position(vertex));
                vertices.len() as u32 - 1
            })
        };
        let faces = faces
            .iter()
            .map(|&(face, corners)| (face, corners.map(&mut number)))
            .collect();
        to_earth(&mut vertices, tiling, convert)?;
        Ok(Batch {
            surface,
            faces,
            vertices,
        })
    }

    fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> {
        let corners = |face: [u32; 3]| face.map(|v| self.vertices[v as usize]);
        self.faces.iter().map(move |&(_, face)| corners(face))
    }

    /// The edges on lines, of which one between two faces may be there twice. Without those of
    /// walls: a step sideways there is as far as a wall is high, so that tiles would need a vertex
    /// for each width of a wall along it.
    fn constrained(&self) -> impl Iterator<Item = [[f64; 3]; 2]> {
        let Batch {
            surface, vertices, ..
        } = self;
        let faces = self.faces.iter().filter(|_| surface.has_lines());
        faces.flat_map(move |&(number, face)| {
            let is_constrained = move |&i: &usize| {
                let kind = surface.edge_kind(number, i);
                kind.is_constrained() && kind != EdgeKind::Wall
            };
            let ends =
                move |i: usize| [(i + 1) % 3, (i + 2) % 3].map(|k| vertices[face[k] as usize]);
            (0..3).filter(is_constrained).map(ends)
        })
    }
}

/// The vertices of a surface, in the order of their keys, each once.
pub(super) struct Vertices {
    pub(super) file: RecordFile<3>,
    /// The area of all triangles, in tiles of the coarsest level.
    pub(super) area: f64,
}

/// What tiles need of the triangles of a surface.
pub(super) struct Triangles {
    pub(super) tiles: FinestTiles,
    pub(super) lines: TileLines,
    /// The edges on lines of the surface, divided by the lines between the tiles of the finest
    /// level; by the keys of their middles.
    pub(super) edges: SortedRecords<6>,
}

impl Intake<'_> {
    /// Passes on what a function makes of each batch, in their order.
    fn each<R: Send>(
        &self,
        make: &(dyn Fn(&Batch) -> Result<R> + Sync),
        take: &mut (dyn FnMut(R) -> Result<()> + Send),
    ) -> Result<()> {
        let Intake {
            convert,
            tiling,
            cancel,
            ..
        } = *self;
        (self.parts)(&mut |surface| {
            let ask = |numbers, faces: &mut _| surface.corners_in(numbers, faces);
            let make =
                |faces: &[(u32, [u32; 3])]| make(&Batch::of(surface, faces, tiling, convert)?);
            map_batches(surface.face_count(), ask, make, |result| {
                go_on(cancel)?;
                take(result?)
            })?;
            surface.ensure_intact()
        })
    }

    /// Reads the vertices.
    ///
    /// # Errors
    /// If a position cannot be converted or is beyond all tiles, or there are no triangles.
    pub(super) fn vertices(&self) -> Result<Vertices> {
        let mut sorter = Sorter::new(self.folder);
        let mut area = 0_u128;
        let tiling = self.tiling;
        // In tiles of the coarsest level.
        let in_tiles = |[x, y, z]: [f64; 3]| {
            let [x, y] = [(x, 0), (y, 1)].map(|(c, axis)| tiling.in_sides(axis, 0, c));
            [x, y, z]
        };
        let make = |batch: &Batch| {
            // Whole numbers: a sum that does not depend on the order of the parts.
            let parts = |face: [[f64; 3]; 3]| area_of(face.map(in_tiles)).abs() / AREA;
            let area: u128 = batch.triangles().map(|face| parts(face) as u128).sum();
            let keyed = |&p: &[f64; 3]| (key_of(p, tiling, Tiling::MAX_LEVEL), p);
            let vertices: Vec<Record<3>> = batch.vertices.iter().map(keyed).collect();
            Ok((vertices, area))
        };
        self.each(&make, &mut |(vertices, of_batch)| {
            area += of_batch;
            sorter.extend(vertices)
        })?;
        let mut file = RecordFile::create(self.folder)?;
        // Batches and parts share vertices.
        sorter.finish_once(&mut |record| file.add(&record))?;
        if file.count() == 0 || area == 0 {
            return Err(Error::format("the surface has no triangles"));
        }
        Ok(Vertices {
            file,
            area: area as f64 * AREA,
        })
    }

    /// Reads the tiles of the finest level, the heights on the lines between the tiles of a level
    /// that is not coarser, and the edges on lines of the surface. `area` is that of
    /// [`vertices`](Self::vertices).
    ///
    /// # Errors
    /// If the tiles are too many, or files cannot be written or read.
    pub(super) fn triangles(&self, area: f64, finest: u8, of_lines: u8) -> Result<Triangles> {
        let tiling = self.tiling;
        let [at_lines, between_tiles] = [of_lines, finest].map(|level| Lines { tiling, level });
        let make = |batch: &Batch| {
            let mut found = OnLines::default();
            let mut tiles = FinestTiles::new(tiling, finest);
            batch.triangles().try_for_each(|face| tiles.add(face))?;
            batch
                .triangles()
                .for_each(|face| at_lines.add(face, &mut found));
            let mut edges: Vec<Record<6>> = Vec::new();
            for ends in batch.constrained() {
                between_tiles.divide(ends, &mut |[p, q]| {
                    let middle = [0, 1, 2].map(|k| (p[k] + q[k]) / 2.0);
                    let key = key_of(middle, tiling, Tiling::MAX_LEVEL);
                    edges.push((key, [p[0], p[1], p[2], q[0], q[1], q[2]]));
                });
            }
            Ok((tiles, found, edges))
        };
        let mut tiles = FinestTiles::new(tiling, finest);
        tiles.require_room(area)?;
        let (mut heights, mut edges) = (Sorter::new(self.folder), Sorter::new(self.folder));
        let mut crossings: FxHashMap<[u32; 2], [f64; 3]> = FxHashMap::default();
        self.each(&make, &mut |(own, found, of_batch): (_, OnLines, _)| {
            tiles.merge(own)?;
            for (at, crossing) in found.crossings {
                // On the border of several triangles: whatever their order.
                let known = crossings.entry(at).or_insert(crossing);
                if by_coordinates(&crossing, known).is_lt() {
                    *known = crossing;
                }
            }
            heights.extend(found.heights)?;
            edges.extend(of_batch)
        })?;
        Ok(Triangles {
            tiles,
            lines: TileLines::new(of_lines, heights, crossings)?,
            edges: SortedRecords::of(edges)?,
        })
    }
}

//! The lines of a surface in tiles: arranged once, by one task, then given to the tiles.
//!
//! A tile alone cannot know where lines cross and which points bend them: crossings far away
//! matter. Points away from all lines do not. So the lines are built to a TIN of their own,
//! together with the points that are on them or next to them. Its constrained edges are those of
//! the surface, with the same heights, and no two of them cross.

use flate2::Crc;
use rustc_hash::{FxHashMap, FxHashSet};

use super::bytes::{self, NumberReader, put_block, put_u32};
use super::task_file::{Block, TaskFile, TaskWriter};
use crate::crs::Crs;
use crate::data::{Bounds, Surface};
use crate::error::Result;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal};
use crate::run::lines::crossings::{self, LineNames};
use crate::run::lines::inputs::{Added, LineLayers};
use crate::run::lines::notes::{self as line_notes, LevelRings, OtherHeights};
use crate::run::products::tin::{TinRequest, builder_of, default_tolerance};
use crate::run::sources::extents::LineExtents;
use crate::run::sources::transforms::{TargetSystem, Transforms};
use crate::terrain::tiles::{self, SubConstraint, TileClip, TileLayout};
use crate::terrain::{NearLines, Tin, TinBuilder};
use crate::triangulation::num::unsigned_zero;

/// The lines of a request, and what points have to do with them.
#[derive(Debug)]
pub(super) struct JobLines {
    /// Lines without points.
    builder: TinBuilder,
    names: LineNames,
    /// The lines in plan.
    near: NearLines,
    reach: f64,
    /// The box around all lines.
    pub(super) extent: Bounds,
    /// The boxes around those that have heights by themselves, and around waters.
    pub(super) extents: LineExtents,
    /// Lines that may be shores.
    pub(super) rings: Option<LevelRings>,
}

/// What the tasks get from the layers of lines.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) lines: Option<JobLines>,
    /// What the surface is cut along.
    pub(super) clip: Option<TileClip>,
    /// The warnings of the transforms that reproject the layers.
    pub(super) of_transforms: Vec<String>,
}

impl Known {
    /// Reads the layers of a request. `systems` are those that they are reprojected from, and that
    /// of the result; `extent` is the box around all points.
    ///
    /// # Errors
    /// If a layer cannot be read or reprojected, or is not what its option takes.
    pub(super) fn read(
        request: &TinRequest,
        systems: (&[Option<Crs>], TargetSystem),
        extent: &Bounds,
        journal: &Journal,
    ) -> Result<Self> {
        let layers = layers_of(request, journal)?;
        Self::of_layers(&layers, request, systems, extent, journal)
    }

    /// Like [`read`](Self::read), of layers that were read.
    pub(super) fn of_layers(
        layers: &LineLayers,
        request: &TinRequest,
        (from, to): (&[Option<Crs>], TargetSystem),
        extent: &Bounds,
        journal: &Journal,
    ) -> Result<Self> {
        // The plan has said which systems are reprojected.
        let transforms = Transforms::new(from, to, &Journal::new(&Context::default()))?;
        let crs = to.crs;
        let units = Units::of(crs);
        let mut builder = builder_of(request, &units, crs.cloned());
        let mut added = layers.add_to(&mut builder, &transforms.by_file, &transforms, &units)?;
        line_notes::note_uneven_shores(&added.uneven_shores, &units, journal);
        line_notes::note_uneven(&added.uneven, &units, journal);
        line_notes::note_lowered(std::mem::take(&mut added.lowered), journal);
        line_notes::note_overlaps(&added.overlaps, journal);
        builder.mark_overlaps();
        let in_plan = builder.lines_in_plan();
        let mut of_lines = Bounds::default();
        in_plan
            .iter()
            .flatten()
            .for_each(|&[x, y]| of_lines.add([x, y, 0.0]));
        let mut all = *extent;
        all.merge(&of_lines);
        builder.judged = builder.bounds;
        let clip = TileClip::take_from(&mut builder, &all)?;
        let with_heights = layers.has_lines_with_heights();
        let lines = with_heights
            .then(|| JobLines::new(builder, added, &in_plan, of_lines, request, &units));
        Ok(Known {
            lines,
            clip,
            of_transforms: transforms.warnings().collect(),
        })
    }
}

/// Reads the layers of lines of a request.
pub(super) fn layers_of<'a>(request: &'a TinRequest, journal: &Journal) -> Result<LineLayers<'a>> {
    LineLayers::read(
        &request.lines,
        &request.breaklines,
        &request.boundary,
        request.read.cut,
        journal,
    )
}

impl JobLines {
    fn new(
        builder: TinBuilder,
        added: Added,
        lines: &[Vec<[f64; 2]>],
        extent: Bounds,
        request: &TinRequest,
        units: &Units,
    ) -> Self {
        let largest = lines
            .iter()
            .flatten()
            .flatten()
            .fold(0.0_f64, |most, c| most.max(c.abs()));
        JobLines {
            builder,
            names: added.names,
            near: NearLines::new(
                lines
                    .iter()
                    .flat_map(|line| line.windows(2))
                    .map(|ends| [ends[0], ends[1]]),
            ),
            reach: tiles::rounding_reach(largest),
            extent,
            extents: added.extents,
            rings: LevelRings::of(added.level_rings, &request.lines, default_tolerance(units)),
        }
    }

    /// Returns the notice about lines that may be shores, from what all points say.
    pub(super) fn notice_of_rings(&self, found: &[OtherHeights], units: &Units) -> Option<Notice> {
        self.rings
            .as_ref()
            .and_then(|rings| rings.notice(found, &self.names, units))
    }

    /// Removes the points that water and walls replace, and returns their number.
    pub(super) fn take_replaced(&self, points: &mut Vec<[f64; 3]>) -> usize {
        self.builder.take_replaced(points)
    }

    /// Returns the points that may matter to a line.
    pub(super) fn near(&self, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        points
            .iter()
            .copied()
            .filter(|&[x, y, _]| self.near.pass([x, y], self.reach))
            .collect()
    }

    /// Returns true if there are waters, which end at the rim of all points.
    pub(super) fn need_rim(&self) -> bool {
        self.builder.has_waters()
    }

    /// Builds the lines with the points next to them. `at_rim` are the points that decide where
    /// waters end, `limit` is the longest edge there, and `extent` that of all points.
    ///
    /// # Errors
    /// If lines cross or differ in height where the rules refuse that.
    pub(super) fn build(
        &self,
        near: Vec<[f64; 3]>,
        (at_rim, limit): (Vec<[f64; 3]>, Option<f64>),
        extent: &Bounds,
        crs: Option<&Crs>,
        journal: &Journal,
    ) -> Result<Tin> {
        let mut builder = self.builder.clone();
        builder.end_waters(at_rim, limit);
        builder.add_owned_points(near);
        // A single line spans no area. These are far from all lines, and so decide nothing.
        let mut all = self.extent;
        [extent.min, extent.max]
            .into_iter()
            .for_each(|corner| all.add(corner));
        let size = [0, 1].map(|k| 1.0 + all.max[k] - all.min[k]);
        let sides = [0, 1].map(|k| [all.min[k] - size[k], all.max[k] + size[k]]);
        builder.add_owned_points(
            sides[0]
                .iter()
                .flat_map(|&x| sides[1].map(|y| [x, y, 0.0]))
                .collect(),
        );
        builder.max_edge_inside = None;
        let tin = builder.build_named(&|line| self.names.name(line), journal.context.cancel)?;
        let units = Units::of(crs);
        line_notes::note_water_overlaps(tin.report(), &self.names, &units, journal);
        line_notes::note_walls_in_water(tin.report(), &self.names, journal);
        line_notes::note_lakes_joined(tin.report(), &self.names, &units, journal);
        line_notes::note_waters_ended(tin.report(), &self.names, journal);
        crossings::note(tin.report(), &self.names, &units, journal);
        Ok(tin)
    }
}

/// What the lines give to a tile.
#[derive(Debug, Clone, Default)]
pub(super) struct LinesOfTile {
    /// The vertices of lines in the tile, and the points next to them.
    pub(super) vertices: Vec<[f64; 3]>,
    /// The sub-constraints that may meet the tile.
    pub(super) constraints: Vec<SubConstraint>,
}

/// Writes the edges and the vertices of lines, divided among the tiles. Returns the number of
/// edges.
pub(super) fn write(tin: &Tin, layout: &TileLayout, writer: &mut TaskWriter) -> Result<usize> {
    let mut tiles = vec![LinesOfTile::default(); layout.tile_count()];
    let mut is_used = vec![false; tin.vertex_count()];
    let mut edges = 0;
    for face in 0..tin.face_count() as u32 {
        let Some(corners) = tin.face(face) else {
            continue;
        };
        corners
            .iter()
            .for_each(|&vertex| is_used[vertex as usize] = true);
        for i in 0..3 {
            let kind = tin.edge_kind(face, i);
            if !kind.is_constrained() || tin.neighbor(face, i).is_some_and(|other| other < face) {
                continue;
            }
            edges += 1;
            let vertices = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
            let [a, b] = vertices.map(|vertex| tin.position(vertex));
            let constraint = SubConstraint {
                ends: [[a[0], a[1]], [b[0], b[1]]],
                kind,
            };
            let [min, max] = [f64::min, f64::max].map(|of| [of(a[0], b[0]), of(a[1], b[1])]);
            layout.tiles_in(min, max, &mut |tile| {
                tiles[tile as usize].constraints.push(constraint)
            });
        }
    }
    // Points next to lines, too: one that is in water by a rounding error has its height now. The
    // corners of the box are those that only make it an area.
    let Bounds { min, max } = tin.report().extent;
    let is_corner = |p: [f64; 3]| (0..2).all(|k| p[k] == min[k] || p[k] == max[k]);
    let used = (0..)
        .zip(is_used)
        .filter(|(_, is_used)| *is_used)
        .map(|(vertex, _)| tin.position(vertex));
    for p in used.filter(|p| !is_corner(*p)) {
        tiles[layout.tile_of([p[0], p[1]]) as usize]
            .vertices
            .push(p);
    }
    writer.begin("lines");
    let mut table = Vec::new();
    for (
        tile,
        LinesOfTile {
            vertices,
            constraints,
        },
    ) in (0..).zip(&tiles)
    {
        if vertices.is_empty() && constraints.is_empty() {
            continue;
        }
        put_u32(&mut table, tile);
        put_block(&mut table, writer.put_block(&bytes::of_points(vertices))?);
        put_block(
            &mut table,
            writer.put_block(&bytes::of_constraints(constraints))?,
        );
    }
    writer.begin("table");
    writer.put(&table)?;
    Ok(edges)
}

/// Returns the tiles that get something from the lines, each with where its vertices and its
/// constraints are.
fn tiles_in(file: &mut TaskFile) -> Result<Vec<(u32, [Block; 2])>> {
    let table = file.section("table")?;
    let mut entries = NumberReader::new(&table);
    let mut tiles = Vec::new();
    while let Some(tile) = entries.u32() {
        let [Some(vertices), Some(constraints)] = [(); 2].map(|()| entries.block()) else {
            return Err(file.damaged());
        };
        tiles.push((tile, [vertices, constraints]));
    }
    Ok(tiles)
}

/// Returns a checksum of what the lines give to a tile, which has these blocks.
fn sum_of(blocks: &[Block; 2]) -> u32 {
    let mut sum = Crc::new();
    for block in blocks {
        sum.update(&block.length.to_le_bytes());
        sum.update(&block.sum.to_le_bytes());
    }
    sum.sum()
}

/// Returns a checksum of what the lines give to each tile, by their numbers; those that get nothing
/// are left out.
pub(super) fn sums_of_tiles(file: &mut TaskFile) -> Result<FxHashMap<u32, u32>> {
    let tiles = tiles_in(file)?.into_iter();
    Ok(tiles
        .map(|(tile, blocks)| (tile, sum_of(&blocks)))
        .collect())
}

/// Returns the [checksum](sums_of_tiles) of what the lines give to one tile; 0 if it gets nothing.
pub(super) fn sum_of_tile(file: &mut TaskFile, tile: u32) -> Result<u32> {
    let mut tiles = tiles_in(file)?.into_iter();
    let own = tiles.find(|(of_tile, _)| *of_tile == tile);
    Ok(own.map_or(0, |(_, blocks)| sum_of(&blocks)))
}

/// Reads what the lines give to a tile.
pub(super) fn read(file: &mut TaskFile, tile: u32) -> Result<LinesOfTile> {
    let mut lines = LinesOfTile::default();
    let mut tiles = tiles_in(file)?.into_iter();
    if let Some((_, [vertices, constraints])) = tiles.find(|(of_tile, _)| *of_tile == tile) {
        let mut bytes = Vec::new();
        file.read(vertices, &mut bytes)?;
        bytes::add_points(&bytes, &mut lines.vertices).ok_or_else(|| file.damaged())?;
        file.read(constraints, &mut bytes)?;
        lines.constraints = bytes::to_constraints(&bytes).ok_or_else(|| file.damaged())?;
    }
    Ok(lines)
}

impl LinesOfTile {
    /// Returns the points that do not share a site with one of the vertices.
    pub(super) fn without_their_sites(&self, mut points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
        let site = |p: &[f64; 3]| [0, 1].map(|k| unsigned_zero(p[k]).to_bits());
        let own: FxHashSet<[u64; 2]> = self.vertices.iter().map(site).collect();
        if !own.is_empty() {
            points.retain(|point| !own.contains(&site(point)));
        }
        points
    }
}

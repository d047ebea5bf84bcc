//! One tile: its vertices are chosen, rounded to steps, and measured against all heights.

use std::borrow::Cow;
use std::sync::atomic::AtomicBool;

use super::heights::Heights;
use super::lines::{Chain, Rises, chain, height_along, height_on, in_steps, rises, steps_between};
use super::normals::normals;
use super::report::TileReport;
use super::rule::Level;
use crate::data::{TerrainTile, TilePosition, Tiling};
use crate::error::{Error, Result};
use crate::terrain::admitted::searched;
use crate::terrain::in_order::by_coordinates;
use crate::terrain::linear::plan;
use crate::terrain::sample::along_curve;
use crate::terrain::simplify::choose_around;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::CellId;
use crate::triangulation::{Delaunay, Location};

const STEPS: u16 = TerrainTile::STEPS;

/// How often the vertices of a tile are chosen again from few heights, with those that were too far
/// off, before these are only inserted.
const CHOICES: usize = 4;

/// A tile while its vertices are chosen.
pub(super) struct Work<'a> {
    pub(super) all: &'a Heights,
    pub(super) level: &'a Level,
    pub(super) at: TilePosition,
    pub(super) triangulation: Delaunay<Terrain, 3>,
}

/// The vertices that a tile has in any case: their positions and heights in steps.
struct Frame {
    vertices: Vec<([u16; 2], i32)>,
    rises: Rises,
}

/// Heights outside of the surface, in corners of the grids of the tiles below: by the numbers of
/// the lines that cross there.
pub(super) type Outside = Vec<([u32; 2], f64)>;

/// Makes one tile. Also returns the heights that the tiles below it need.
pub(super) fn tile(
    all: &Heights,
    level: &Level,
    finer: Option<&Level>,
    at: TilePosition,
    cancel: &AtomicBool,
) -> Result<(TerrainTile, TileReport, Outside)> {
    let frame = Frame::of(all, level, at)?;
    let few = all.few.get(&at);
    let from = few.map_or_else(|| all.heights_of(at).map(Cow::Owned), |few| Ok(few.into()))?;
    let [min, max] = all.tiling.bounds(at);
    let candidate = |&p: &[f64; 3]| {
        let [u, v, z] = in_tile(p, [min, max]);
        let [u, v] = [u, v].map(inner);
        ([f64::from(u), f64::from(v), z], false)
    };
    let of_frame = frame.vertices.iter().map(|&([u, v], height)| {
        let height = f64::from(height) * level.step;
        ([f64::from(u), f64::from(v), height], true)
    });
    let mut sites: Vec<Site> = of_frame.chain(from.iter().map(candidate)).collect();
    drop(from);
    let mut choices = if few.is_some() { CHOICES } else { 1 };
    let (mut work, found) = loop {
        let work = Work {
            all,
            level,
            at,
            triangulation: chosen(&mut sites, level, cancel)?,
        };
        let found = work.measure(true, cancel)?;
        choices -= 1;
        if choices == 0 || found.worst.is_empty() {
            break (work, found);
        }
        let more = found.candidates();
        sites.extend(more.map(|([u, v], z)| ([f64::from(u), f64::from(v), z], false)));
    };
    drop(sites);
    let found = work.repair(found, cancel)?;
    let mut tile = work.finish(at)?;
    tile.normals = normals(&tile, all.tiling, &frame.rises);
    let report = TileReport {
        vertices: tile.vertices.len(),
        triangles: tile.triangles.len(),
        heights: all.count_of(at),
        largest: found.largest,
        beyond: found.beyond,
    };
    let outside = finer.map_or_else(Vec::new, |finer| work.outside(all, finer, &tile));
    Ok((tile, report, outside))
}

/// A position in steps with its height in meters, and whether it stays in any case.
type Site = ([f64; 3], bool);

/// Returns the triangulation of those sites that are needed, with heights in whole steps. The sites
/// are sorted, and each position is kept once.
fn chosen(
    sites: &mut Vec<Site>,
    level: &Level,
    cancel: &AtomicBool,
) -> Result<Delaunay<Terrain, 3>> {
    sites.sort_unstable_by(|(p, p_stays), (q, q_stays)| {
        by_coordinates(&plan(*p), &plan(*q))
            .then(q_stays.cmp(p_stays))
            .then(p[2].total_cmp(&q[2]))
    });
    sites.dedup_by(|(q, _), (p, _)| p[0] == q[0] && p[1] == q[1]);
    let stay: Vec<u32> = (0..sites.len() as u32)
        .filter(|&site| sites[site as usize].1)
        .collect();
    let positions: Vec<[f64; 3]> = sites.iter().map(|(p, _)| *p).collect();
    let bound = (level.allowance - level.step / 2.0).max(level.allowance / 2.0);
    let chosen = choose_around(positions, &stay, bound, cancel)?;
    let round = |p| rounded(p, level.step);
    let vertices: Vec<[f64; 3]> = chosen.into_iter().map(round).collect();
    let (triangulation, _) = Delaunay::from_points(Terrain::default(), &vertices)
        .map_err(|e| Error::format(e.to_string()))?;
    Ok(triangulation)
}

/// Returns a position in steps of a tile, given the bounds of the tile.
pub(super) fn in_tile([x, y, z]: [f64; 3], [min, max]: [[f64; 2]; 2]) -> [f64; 3] {
    let [u, v] = [(x, 0), (y, 1)].map(|(c, axis)| steps_between(c, min[axis], max[axis]));
    let [u, v] = searched([u, v]);
    [u, v, z]
}

/// How many steps from the borders the vertices inside of a tile are, at least.
///
/// Between a border and a vertex that is one step from it, a triangle is as thin as what rounding
/// moves: a height there is on the wrong side of it, and no vertex can be added for it.
const INSIDE: u16 = 8;

/// A step inside of the tile: only vertices of borders are near to them.
pub(super) fn inner(steps: f64) -> u16 {
    (steps.round() as u16).clamp(INSIDE, STEPS - INSIDE)
}

/// Returns how often the steps of a level can be halved for a tile, so that the range of heights
/// that it states is hardly larger than its own: viewers take it for that. Ranges remain 32-bit
/// floats without rounding.
fn halvings([lowest, highest]: [i32; 2]) -> u32 {
    let [lowest, highest] = [lowest, highest].map(i64::from);
    let all = i64::from(STEPS);
    let fits = |halved: &u32| {
        let exact = (lowest << halved).abs() + all < 1 << 24;
        exact && (highest - lowest) << halved <= all
    };
    (1..16).take_while(fits).last().unwrap_or(0)
}

/// Returns how many steps the lines of a grid are from the first side of a tile.
fn grid_steps(tiling: Tiling, axis: usize, at: TilePosition, cells: u32) -> Vec<f64> {
    let along = |number| tiling.along_side(axis, at, cells, number);
    (0..=cells).map(|k| f64::from(STEPS) * along(k)).collect()
}

/// A position with its height in whole steps.
pub(super) fn rounded([u, v, z]: [f64; 3], step: f64) -> [f64; 3] {
    [u, v, (z / step).round() * step]
}

impl Frame {
    /// The vertices of the borders, and those of a grid that follows the earth.
    fn of(all: &Heights, level: &Level, at: TilePosition) -> Result<Self> {
        let cells = level.grid;
        let height = |i: u32, j: u32| (all.height(level, at, [i, j]) / level.step).round() as i32;
        let steps = [0, 1].map(|axis| {
            let lines = grid_steps(all.tiling, axis, at, cells);
            lines
                .iter()
                .map(|steps| steps.round() as u16)
                .collect::<Vec<u16>>()
        });
        let mut frame = Frame {
            vertices: Vec::new(),
            rises: Rises::default(),
        };
        for axis in 0..2 {
            for far in 0..2 {
                let corner = |k: u32| match axis {
                    0 => [far * cells, k],
                    _ => [k, far * cells],
                };
                let position = |along: u16| {
                    let across = STEPS * far as u16;
                    if axis == 0 {
                        [across, along]
                    } else {
                        [along, across]
                    }
                };
                let along_side = || (0..).zip(&steps[1 - axis]);
                let fixed: Chain = along_side()
                    .map(|(k, &along)| (along, height(corner(k)[0], corner(k)[1])))
                    .collect();
                let (crossings, ends) = all.along(at, axis, far)?;
                let crossings = in_steps(&crossings, ends);
                let heights: Vec<[f64; 2]> = crossings.iter().map(|&[t, z, ..]| [t, z]).collect();
                let chain = chain(&heights, &fixed, level.step, level.allowance);
                for (&(along, z), rise) in chain.iter().zip(rises(&crossings, &chain)) {
                    let p = position(along);
                    // Corners of the tile are on two borders.
                    if frame.rises.insert(p, rise).is_none() {
                        frame.vertices.push((p, z));
                    }
                }
                // Other borders meet there: what all of them know is the surface in this point.
                for (k, &along) in along_side() {
                    let rise = all.rise(level, at, corner(k));
                    frame.rises.insert(position(along), rise);
                }
            }
        }
        for i in 1..cells {
            let step = |j: u32| [steps[0][i as usize], steps[1][j as usize]];
            let column = (1..cells).map(|j| (step(j), height(i, j)));
            frame.vertices.extend(column);
        }
        Ok(frame)
    }
}

impl Work<'_> {
    /// The heights of the tile where the surface has none.
    fn outside(&self, all: &Heights, finer: &Level, tile: &TerrainTile) -> Outside {
        let cells = 2 * finer.grid;
        let steps = [0, 1].map(|axis| grid_steps(all.tiling, axis, tile.at, cells));
        let side = |axis: usize, at: u16| -> Vec<[f64; 2]> {
            let on_side = tile.vertices.iter().filter(|v| v[axis] == at);
            let mut side: Vec<[f64; 2]> = on_side
                .map(|v| [f64::from(v[1 - axis]), tile.height(v[2])])
                .collect();
            side.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            side
        };
        let sides = [0, STEPS].map(|at| [0, 1].map(|axis| side(axis, at)));
        let mut outside = Vec::new();
        let mut near = None;
        for i in 0..=cells {
            for j in 0..=cells {
                let numbers = [tile.at.column * cells + i, tile.at.row * cells + j];
                if all.lines.crossing(finer.of_lines(), numbers).is_some() {
                    continue;
                }
                let on_side = [(0, i, j), (1, j, i)]
                    .into_iter()
                    .find(|&(_, k, _)| k == 0 || k == cells);
                let height = match on_side {
                    // The same number in both tiles at the side.
                    Some((axis, k, along)) => {
                        let t = steps[1 - axis][along as usize];
                        height_along(&sides[usize::from(k > 0)][axis], t)
                    }
                    None => {
                        let q = [steps[0][i as usize], steps[1][j as usize]];
                        let location = self.triangulation.locate(&[q[0], q[1], 0.0], near);
                        near = location.cell(&self.triangulation).or(near);
                        self.height_at(location, q).map_or(all.fill, |(z, _)| z)
                    }
                };
                outside.push((numbers, height));
            }
        }
        outside
    }

    /// The height of the triangles at a position that was located, with the triangle there unless
    /// it is a vertex.
    pub(super) fn height_at(
        &self,
        location: Location,
        at: [f64; 2],
    ) -> Option<(f64, Option<CellId>)> {
        match location {
            Location::Vertex(vertex) => Some((self.triangulation.point(vertex)[2], None)),
            Location::Cell { cell, .. } => {
                let corners = self.triangulation.cell_points(cell)?;
                Some((height_on(corners.map(|p| *p), at), Some(cell)))
            }
            _ => None,
        }
    }

    /// The tile with its triangles along a curve, and its vertices in the order of their first use.
    fn finish(&self, at: TilePosition) -> Result<TerrainTile> {
        let tds = self.triangulation.tds();
        let cells: Vec<CellId> = self.triangulation.finite_cells().collect();
        let centers: Vec<[f64; 2]> = cells
            .iter()
            .map(|&cell| {
                let corners = tds
                    .corners(cell)
                    .map(|vertex| *self.triangulation.point(vertex));
                [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0)
            })
            .collect();
        let step = self.level.step;
        let steps_of = |z: f64| (z / step).round() as i32;
        let mut number_of = vec![u32::MAX; tds.vertex_slots()];
        let mut used: Vec<[f64; 3]> = Vec::new();
        let triangles: Vec<[u32; 3]> = along_curve(&centers)
            .into_iter()
            .map(|k| {
                tds.corners(cells[k as usize]).map(|vertex| {
                    let number = &mut number_of[vertex.index()];
                    if *number == u32::MAX {
                        *number = used.len() as u32;
                        used.push(*self.triangulation.point(vertex));
                    }
                    *number
                })
            })
            .collect();
        let heights = || used.iter().map(|p| steps_of(p[2]));
        let lowest = heights().min().unwrap_or(0);
        let halved = halvings([lowest, heights().max().unwrap_or(0)]);
        let vertices = used
            .iter()
            .map(|&[u, v, z]| {
                let height = u16::try_from((steps_of(z) - lowest) << halved);
                Some([u as u16, v as u16, height.ok().filter(|&h| h <= STEPS)?])
            })
            .collect::<Option<_>>()
            .ok_or_else(|| Error::limit("the heights of a tile are too far from each other"))?;
        Ok(TerrainTile {
            at,
            step: step / f64::from(1_u32 << halved),
            lowest: lowest << halved,
            vertices,
            triangles,
            normals: Vec::new(),
        })
    }
}

//! What a surface is simplified from: its vertices or cells, its lines and its rim.

use rayon::prelude::*;

use super::lattice::Lattice;
use super::lines::{EdgeRole, Lines};
use super::sites::{LatticeFrame, Sites};
use crate::data::{AT_ONCE, EdgeKind, Face, Frame, Grid, Surface};
use crate::error::{Error, Result};
use crate::terrain::admitted::refused;
use crate::terrain::in_order::by_coordinates;
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::kernel::RANGE;
use crate::triangulation::num::unsigned_zero;

/// How many faces are asked for at a time.
const FACES: u32 = 1 << 14;

/// How many columns of a raster are turned at a time.
///
/// PERF: so many cells of a row are next to each other in memory.
const STRIP: usize = 16;

/// The sites of a surface, and its constrained edges between them.
pub(super) struct Intake {
    pub(super) sites: Sites,
    pub(super) lines: Lines,
}

/// Returns an error unless a site can be computed with.
fn check(p: [f64; 3]) -> Result<()> {
    let geometry: Terrain = Terrain::default();
    if geometry.admits(&p) && RANGE.admits(p[2]) {
        Ok(())
    } else {
        Err(refused(p))
    }
}

/// The vertices of a surface of triangles, with its lines and its rim.
///
/// # Errors
/// If a coordinate is not admitted, or two vertices in one position have different heights.
pub(super) fn of_triangles(surface: &dyn Surface) -> Result<Intake> {
    let used = surface.census().used;
    let vertices = (0..used.len() as u32).into_par_iter().with_min_len(AT_ONCE);
    let mut sites: Vec<([f64; 3], u32)> = vertices
        .filter(|&vertex| used[vertex as usize])
        .map(|vertex| (surface.position(vertex).map(unsigned_zero), vertex))
        .collect();
    let bad = sites.par_iter().with_min_len(AT_ONCE);
    if let Some(Err(error)) = bad.map(|(p, _)| check(*p)).find_first(Result::is_err) {
        return Err(error);
    }
    sites.par_sort_unstable_by(|(p, _), (q, _)| by_coordinates(p, q));
    let mut site_of = vec![u32::MAX; used.len()];
    let mut positions: Vec<[f64; 3]> = Vec::with_capacity(sites.len());
    for ([x, y, z], vertex) in sites {
        match positions.last() {
            Some(&[a, b, c]) if [a, b] == [x, y] => {
                if c != z {
                    return Err(Error::format(format!(
                        "two vertices at {x} {y} have different heights, {c} and {z}"
                    )));
                }
            }
            _ => positions.push([x, y, z]),
        }
        site_of[vertex as usize] = positions.len() as u32 - 1;
    }
    let batches = (surface.face_count() as u32).div_ceil(FACES);
    let edges: Vec<_> = (0..batches)
        .into_par_iter()
        .flat_map_iter(|batch| {
            let first = batch * FACES;
            let last = (surface.face_count() as u32).min(first.saturating_add(FACES));
            let mut faces = Vec::new();
            surface.faces_in(first..last, &mut faces);
            faces.into_iter().flat_map(|face| edges_of(surface, face))
        })
        .collect();
    surface.ensure_intact()?;
    let mut lines = Lines::default();
    for (ends, role) in edges {
        let ends = ends.map(|vertex| site_of[vertex as usize]);
        lines.add(ends, role);
    }
    let sites = Sites::scattered(positions).map_err(|error| Error::limit(error.to_string()))?;
    Ok(Intake { sites, lines })
}

/// The edges of a face on lines and at the rim, with the surface to the left of them.
fn edges_of(
    surface: &dyn Surface,
    face: Face,
) -> impl Iterator<Item = ([u32; 2], EdgeRole)> + use<'_> {
    (0..3).filter_map(move |i| {
        let kind = face.edges[i];
        if kind == EdgeKind::Plain {
            return None;
        }
        let beside = surface.neighbor(face.number, i);
        // An edge between two faces is added once.
        if beside.is_some_and(|other| other < face.number) {
            return None;
        }
        let role = EdgeRole {
            kind,
            is_rim: beside.is_none(),
        };
        Some(([face.corners[(i + 1) % 3], face.corners[(i + 2) % 3]], role))
    })
}

/// The cells of a raster, with the rim around those that have heights.
///
/// # Errors
/// If the raster has no cells or too many, or is rotated; if a height or a position is not
/// admitted, or rounding makes two columns or rows one.
pub(super) fn of_cells(grid: &Grid) -> Result<Intake> {
    let frame = &grid.frame;
    let (width, height) = (frame.width, frame.height);
    if width * height != grid.values.len() || width * height >= u32::MAX as usize {
        return Err(Error::limit(format!(
            "a raster of {width} x {height} cells is too large to be simplified"
        ))
        .cure("use a part of it, or a coarser raster"));
    }
    if grid.values.is_empty() {
        return Err(Error::format("a raster without cells has no surface"));
    }
    let bad = |z: &f64| !z.is_nan() && !RANGE.admits(*z);
    let values = grid.values.par_iter().with_min_len(AT_ONCE);
    if let Some(at) = values.position_first(bad) {
        let [x, y] = center(frame, [at % width, at / width]);
        return Err(refused([x, y, grid.values[at]]));
    }
    let t = &frame.transform;
    if t[2] != 0.0 || t[4] != 0.0 {
        return Err(Error::unsupported("a rotated raster cannot be simplified")
            .cure("warp it to a grid along the axes"));
    }
    let order = SiteOrder {
        width,
        height,
        is_mirrored: t[1] < 0.0,
        is_north_up: t[5] < 0.0,
    };
    let positions = lattice_frame(frame, &order)?;
    let cells = Cells::of(grid);
    let mut heights = vec![0.0; width * height];
    let strips = heights.par_chunks_mut(height * STRIP).enumerate();
    strips.for_each(|(strip, heights)| {
        for row in 0..height {
            for (k, column) in heights.chunks_mut(height).enumerate() {
                column[row] = cells.height(order.turned([strip * STRIP + k, row]));
            }
        }
    });
    let lattice = Lattice::new(height as u32, heights);
    let is_flipped = order.is_mirrored != order.is_north_up;
    let lines = cells.rim(&|cell: [usize; 2]| order.site(cell), is_flipped);
    Ok(Intake {
        sites: Sites::Lattice {
            lattice,
            frame: positions,
        },
        lines,
    })
}

/// Returns the position of the center of a cell, given its column and row.
fn center(frame: &Frame, [column, row]: [usize; 2]) -> [f64; 2] {
    frame.to_map(column as f64 + 0.5, row as f64 + 0.5)
}

/// Returns where the columns and rows of cells are, in the order of sites.
///
/// # Errors
/// If rounding makes two of them one, or the raster is not in the range of the arithmetic.
fn lattice_frame(frame: &Frame, order: &SiteOrder) -> Result<LatticeFrame> {
    let at = |column: usize, row: usize| center(frame, [column, row]).map(unsigned_zero);
    let mut x: Vec<f64> = (0..order.width).map(|k| at(k, 0)[0]).collect();
    let mut y: Vec<f64> = (0..order.height).map(|k| at(0, k)[1]).collect();
    if order.is_mirrored {
        x.reverse();
    }
    if order.is_north_up {
        y.reverse();
    }
    if !is_increasing(&x) || !is_increasing(&y) {
        return Err(Error::format(
            "the cells of the raster are smaller than a rounding of their coordinates",
        ));
    }
    for end in [
        [x[0], y[0], 0.0],
        [x[order.width - 1], y[order.height - 1], 0.0],
    ] {
        check(end)?;
    }
    Ok(LatticeFrame { x, y })
}

/// How the cells of a raster are numbered as sites: column by column from west to east, each from
/// the south.
struct SiteOrder {
    width: usize,
    height: usize,
    /// True if columns run from east to west.
    is_mirrored: bool,
    /// True if rows run from north to south.
    is_north_up: bool,
}

impl SiteOrder {
    /// Returns the site of a cell.
    fn site(&self, cell: [usize; 2]) -> u32 {
        let [column, row] = self.turned(cell);
        (column * self.height + row) as u32
    }

    /// Maps a column and row of the raster to those of the lattice, or back.
    fn turned(&self, [column, row]: [usize; 2]) -> [usize; 2] {
        let column = if self.is_mirrored {
            self.width - 1 - column
        } else {
            column
        };
        let row = if self.is_north_up {
            self.height - 1 - row
        } else {
            row
        };
        [column, row]
    }
}

fn is_increasing(x: &[f64]) -> bool {
    x.windows(2).all(|pair| pair[0] < pair[1])
}

/// The cells of a raster that are part of its surface: corners of quads of which at most one has no
/// height.
struct Cells<'a> {
    grid: &'a Grid,
    is_complete: bool,
}

impl<'a> Cells<'a> {
    fn of(grid: &'a Grid) -> Self {
        Cells {
            grid,
            is_complete: grid.values.par_iter().all(|z| !z.is_nan()),
        }
    }

    fn has_height(&self, column: usize, row: usize) -> bool {
        !self.grid.value(column, row).is_nan()
    }

    /// Returns which corners of a quad have heights.
    fn quad(&self, column: usize, row: usize) -> Quad {
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let missing: Vec<usize> = (0..4)
            .filter(|&k| {
                let (right, down) = corners[k];
                !self.has_height(column + right, row + down)
            })
            .collect();
        match missing[..] {
            [] => Quad::Whole,
            [corner] => Quad::Without(corner),
            _ => Quad::Nothing,
        }
    }

    /// The height of a cell; NaN if no face of the surface has it.
    fn height(&self, [column, row]: [usize; 2]) -> f64 {
        let z = self.grid.value(column, row);
        if self.is_complete || z.is_nan() {
            return z;
        }
        let (width, height) = (self.grid.frame.width, self.grid.frame.height);
        let around =
            |at: usize, count: usize| at.saturating_sub(1)..=at.min(count.saturating_sub(2));
        let is_used = around(column, width).any(|c| {
            around(row, height).any(|r| {
                c + 1 < width && r + 1 < height && !matches!(self.quad(c, r), Quad::Nothing)
            })
        });
        if is_used { z } else { f64::NAN }
    }

    /// The edges at the rim, without those at the border of the raster.
    fn rim(&self, site_of: &dyn Fn([usize; 2]) -> u32, is_flipped: bool) -> Lines {
        let mut lines = Lines::default();
        let (width, height) = (self.grid.frame.width, self.grid.frame.height);
        if self.is_complete || width < 2 || height < 2 {
            return lines;
        }
        let role = EdgeRole {
            kind: EdgeKind::Rim,
            is_rim: true,
        };
        let mut add = |a: [usize; 2], b: [usize; 2]| {
            // Left of `a b` seen with rows downwards is right of it in a map with rows upwards.
            let ends = if is_flipped { [a, b] } else { [b, a] };
            lines.add(ends.map(site_of), role);
        };
        for row in 0..height - 1 {
            for column in 0..width - 1 {
                let quad = self.quad(column, row);
                let [c, r] = [column, row];
                // Counter-clockwise in a map with rows downwards that is north up.
                let ring = [[c, r], [c, r + 1], [c + 1, r + 1], [c + 1, r]];
                let beyond = |k: usize| match k {
                    0 => c.checked_sub(1).map(|c| [c, r]),
                    1 => Some([c, r + 1]).filter(|_| r + 2 < height),
                    2 => Some([c + 1, r]).filter(|_| c + 2 < width),
                    _ => r.checked_sub(1).map(|r| [c, r]),
                };
                let missing = match quad {
                    Quad::Nothing => continue,
                    Quad::Whole => None,
                    Quad::Without(corner) => Some([0, 3, 1, 2][corner]),
                };
                if let Some(k) = missing {
                    add(ring[(k + 3) % 4], ring[(k + 1) % 4]);
                }
                for k in 0..4 {
                    let next = (k + 1) % 4;
                    if missing == Some(k) || missing == Some(next) {
                        continue;
                    }
                    if let Some([c, r]) = beyond(k)
                        && !self.covers(c, r, [ring[k], ring[next]])
                    {
                        add(ring[k], ring[next]);
                    }
                }
            }
        }
        lines
    }

    /// Returns true if a face of a quad has an edge between two of its corners.
    fn covers(&self, column: usize, row: usize, ends: [[usize; 2]; 2]) -> bool {
        match self.quad(column, row) {
            Quad::Whole => true,
            Quad::Nothing => false,
            Quad::Without(corner) => {
                let at = [column + corner % 2, row + corner / 2];
                !ends.contains(&at)
            }
        }
    }
}

/// Which corners of a quad have heights.
enum Quad {
    Whole,
    /// All but this one: 0 to 3, by rows.
    Without(usize),
    Nothing,
}

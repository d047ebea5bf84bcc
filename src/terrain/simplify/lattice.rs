//! Points on a lattice: the cells of a raster, found by columns instead of lists.

use std::ops::Range;

use rayon::prelude::*;

use super::error::{Slopes, Worst, larger};

/// The side of the tiles whose ranges of heights are known, in cells.
const TILE: usize = 16;

/// Heights at all positions of a lattice, column by column, each from the south. The number of a
/// site is its position in this list. NaN is a cell without a height.
#[derive(Debug, Clone)]
pub(super) struct Lattice {
    pub(super) rows: u32,
    pub(super) heights: Vec<f64>,
    /// The lowest and the highest height of each tile, in the order of the sites.
    ranges: Vec<[f64; 2]>,
}

/// One column of a triangle: the sites from `first` on, and the height of the plane there.
pub(super) struct Column<'a> {
    pub(super) first: u32,
    pub(super) heights: &'a [f64],
    pub(super) base: f64,
    pub(super) step: f64,
}

impl Column<'_> {
    #[inline(always)]
    pub(super) fn residual(&self, k: usize) -> f64 {
        self.heights[k] - self.plane(k)
    }

    #[inline(always)]
    fn plane(&self, k: usize) -> f64 {
        self.base + self.step * k as f64
    }

    /// The largest distance of some cells from the plane; those without a height do not count.
    #[inline(always)]
    fn largest(&self, cells: Range<usize>) -> f64 {
        // PERF: compilers do not reorder the maximum of floating point numbers; four at a time.
        let mut largest = [0.0_f64; 4];
        let mut at = [0.0, 1.0, 2.0, 3.0].map(|lane| cells.start as f64 + lane);
        let (fours, rest) = self.heights[cells].as_chunks::<4>();
        for four in fours {
            for lane in 0..4 {
                let error = (four[lane] - (self.base + self.step * at[lane])).abs();
                largest[lane] = larger(error, largest[lane]);
                at[lane] += 4.0;
            }
        }
        for (lane, z) in rest.iter().enumerate() {
            let error = (z - (self.base + self.step * at[lane])).abs();
            largest[lane] = larger(error, largest[lane]);
        }
        largest.into_iter().fold(0.0, larger)
    }
}

impl Lattice {
    /// Heights column by column.
    ///
    /// # Complexity
    /// O(n), on all threads.
    pub(super) fn new(rows: u32, heights: Vec<f64>) -> Self {
        let in_column = rows.max(1) as usize;
        let strips = heights.par_chunks(in_column * TILE);
        let ranges = strips.flat_map_iter(|strip| {
            let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; in_column.div_ceil(TILE)];
            for column in strip.chunks(in_column) {
                for ([low, high], cells) in ranges.iter_mut().zip(column.chunks(TILE)) {
                    for &z in cells {
                        // NaN is neither.
                        *low = if z < *low { z } else { *low };
                        *high = larger(z, *high);
                    }
                }
            }
            ranges
        });
        Lattice {
            rows,
            ranges: ranges.collect(),
            heights,
        }
    }

    /// Column and row of a site.
    #[inline(always)]
    pub(super) fn position(&self, site: u32) -> [i32; 2] {
        [(site / self.rows) as i32, (site % self.rows) as i32]
    }

    /// The lowest and the highest height; infinity and its negative if there is none.
    pub(super) fn range(&self) -> [f64; 2] {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let join = |[low, high]: [f64; 2], tile: &[f64; 2]| [low.min(tile[0]), high.max(tile[1])];
        self.ranges.iter().fold(none, join)
    }

    /// The lowest and the highest height of the tile of a cell.
    #[inline]
    fn range_at(&self, column: usize, row: usize) -> [f64; 2] {
        self.ranges[column / TILE * (self.rows as usize).div_ceil(TILE) + row / TILE]
    }

    /// The first and the last site with a height in each column: no others may be corners of the
    /// convex hull.
    pub(super) fn ends_of_columns(&self) -> Vec<u32> {
        let mut ends = Vec::new();
        for (x, column) in self.heights.chunks(self.rows.max(1) as usize).enumerate() {
            let has_height = |z: &f64| !z.is_nan();
            let first = column.iter().position(has_height);
            let last = column.iter().rposition(has_height);
            let of_column = first.into_iter().chain(last.filter(|_| last != first));
            ends.extend(of_column.map(|row| x as u32 * self.rows + row as u32));
        }
        ends
    }

    /// The columns of a triangle. Sites on edges belong to them.
    ///
    /// The corners may be in any order; the result does not depend on it.
    ///
    /// # Errors
    /// If the triangle has no area, so that nothing can be measured: the first site on it that is
    /// none of its corners, if there is any.
    #[inline(always)]
    pub(super) fn columns(&self, mut corners: [u32; 3]) -> Result<Columns<'_>, Option<u32>> {
        corners.sort_unstable();
        let [a, b, c] = corners.map(|site| self.position(site));
        let site =
            |p: [i32; 2], n: u32| [f64::from(p[0]), f64::from(p[1]), self.heights[n as usize]];
        let Some(slopes) = Slopes::of([
            site(a, corners[0]),
            site(b, corners[1]),
            site(c, corners[2]),
        ]) else {
            return Err(self.between(corners));
        };
        let tile = TILE as i32;
        let is_large = c[0] - a[0] >= tile && a[1].max(b[1]).max(c[1]) - a[1].min(b[1]) >= tile;
        Ok(Columns {
            lattice: self,
            slopes,
            corners: [a, b, c],
            x: a[0],
            // PERF: small ones are not worth a look.
            needed: if is_large { a[0] } else { c[0] + 1 },
            is_large,
            long: Edge::of(a, c),
            short: Edge::of(a, b),
            is_long_below: turn([a, c, b]) > 0,
        })
    }

    /// The first site with a height between the first and the last of three sites on a line, except
    /// the one in the middle.
    fn between(&self, [a, b, c]: [u32; 3]) -> Option<u32> {
        let [p, r] = [a, c].map(|site| self.position(site));
        let (dx, dy) = (r[0] - p[0], r[1] - p[1]);
        let steps = gcd(dx.unsigned_abs(), dy.unsigned_abs()) as i32;
        let at = |k: i32| {
            let [x, y] = [p[0] + dx / steps * k, p[1] + dy / steps * k];
            x as u32 * self.rows + y as u32
        };
        let is_site = |site: &u32| *site != b && !self.heights[*site as usize].is_nan();
        (1..steps).map(at).find(is_site)
    }

    /// The worst cell of a triangle, by rounded numbers, and a bound of their errors. Ends early
    /// above `limit`.
    #[inline]
    pub(super) fn worst(&self, corners: [u32; 3], limit: f64) -> (Worst, f64) {
        let mut worst = Worst::NONE;
        let mut columns = match self.columns(corners) {
            Ok(columns) => columns,
            Err(None) => return (worst, 0.0),
            Err(Some(site)) => {
                let error = f64::MAX;
                return (Worst { error, site }, 0.0);
            }
        };
        while let Some(column) = columns.next_above(worst.error) {
            let cells = 0..column.heights.len();
            let largest = if cells.len() < 2 * TILE && !columns.is_large {
                column.largest(cells)
            } else {
                self.largest_by_tiles(&column, worst.error)
            };
            if largest > worst.error {
                let at = (0..column.heights.len()).find(|&k| column.residual(k).abs() == largest);
                worst = Worst {
                    error: largest,
                    site: column.first + at.unwrap_or(0) as u32,
                };
                if largest > limit {
                    break;
                }
            }
        }
        (worst, columns.uncertainty())
    }

    /// The largest distance of the cells of a column from the plane, if it is above `least`; else
    /// `least`.
    ///
    /// PERF: cells of a tile are not looked at if its range says that they are not above. Rounding
    /// is monotone: no rounded distance is above what the ends of the range give.
    fn largest_by_tiles(&self, column: &Column, least: f64) -> f64 {
        let [x, low] = [column.first / self.rows, column.first % self.rows].map(|k| k as usize);
        let end = low + column.heights.len();
        let mut largest = least;
        let mut row = low;
        while row < end {
            let next = end.min((row / TILE + 1) * TILE);
            let [lowest, highest] = self.range_at(x, row);
            let [p, q] = [row - low, next - 1 - low].map(|k| column.plane(k));
            if larger(highest - p.min(q), p.max(q) - lowest) > largest {
                largest = larger(column.largest(row - low..next - low), largest);
            }
            row = next;
        }
        largest
    }
}

/// The columns of a triangle, from west to east.
#[derive(Clone, Copy)]
pub(super) struct Columns<'a> {
    lattice: &'a Lattice,
    slopes: Slopes,
    /// From west to east, and from south to north.
    corners: [[i32; 2]; 3],
    /// The next column.
    x: i32,
    /// The columns before this one cannot be left out.
    needed: i32,
    /// True if the triangle is larger than tiles.
    is_large: bool,
    /// The edge from the first to the last corner, and those by way of the other one.
    long: Edge,
    short: Edge,
    is_long_below: bool,
}

impl<'a> Columns<'a> {
    /// A bound of the rounding errors of [`Column::residual`].
    pub(super) fn uncertainty(&self) -> f64 {
        self.slopes.uncertainty
    }

    /// All columns.
    #[inline]
    pub(super) fn all(mut self) -> impl Iterator<Item = Column<'a>> {
        std::iter::from_fn(move || self.next_above(f64::NEG_INFINITY))
    }

    /// The next column, without some in which no rounded distance is above `least`.
    #[inline(always)]
    pub(super) fn next_above(&mut self, least: f64) -> Option<Column<'a>> {
        let [a, b, c] = self.corners;
        loop {
            let x = self.x;
            if x > c[0] {
                return None;
            }
            if x == b[0] {
                self.short = Edge::of(b, c);
            }
            if x >= self.needed {
                *self = self.onwards(least);
                if self.x > x {
                    continue;
                }
            }
            let [lower, upper] = self.edges();
            let (low, high) = (lower.first_above(), upper.row);
            self.x += 1;
            self.long.step();
            self.short.step();
            if low > high {
                continue;
            }
            let first = x as usize * self.lattice.rows as usize + low as usize;
            let Slopes {
                origin,
                along: [gx, gy],
                ..
            } = self.slopes;
            return Some(Column {
                first: first as u32,
                heights: &self.lattice.heights[first..=first + (high - low) as usize],
                base: origin[2] + gx * f64::from(x - a[0]) + gy * f64::from(low - a[1]),
                step: gy,
            });
        }
    }

    /// The lower and the upper edge in the next column.
    #[inline(always)]
    fn edges(&self) -> [&Edge; 2] {
        if self.is_long_below {
            [&self.long, &self.short]
        } else {
            [&self.short, &self.long]
        }
    }

    /// The columns from the end of the next tiles on, or of an edge, if the ranges of the tiles say
    /// that no distance before is above `least`; else all, of which those before are needed.
    ///
    /// PERF: in large triangles, as on the sea, memory would be waited for in each column. By
    /// value, so that small triangles keep theirs in registers.
    #[cold]
    fn onwards(self, least: f64) -> Self {
        let [a, b, c] = self.corners;
        let tile = TILE as i32;
        let edge_end = if self.x < b[0] { b[0] } else { c[0] };
        let end = ((self.x / tile + 1) * tile).min(edge_end);
        let needed = Columns {
            needed: end,
            ..self
        };
        if end <= self.x {
            return needed;
        }
        let columns = (end - self.x) as u32;
        let there = Columns {
            x: end,
            long: self.long.moved(columns),
            short: self.short.moved(columns),
            ..self
        };
        let [from, to] = [&self, &there].map(|columns| columns.edges().map(|edge| edge.row));
        let (low, high) = (from[0].min(to[0]), from[1].max(to[1]));
        let Slopes {
            origin,
            along: [gx, gy],
            uncertainty,
        } = self.slopes;
        // A level plane is not rounded.
        let margin = if [gx, gy] == [0.0; 2] {
            0.0
        } else {
            2.0 * uncertainty
        };
        let across = gx * f64::from(end - self.x);
        let mut row = low;
        while row <= high {
            let next = high.min(row / tile * tile + tile - 1);
            let base = origin[2] + gx * f64::from(self.x - a[0]) + gy * f64::from(row - a[1]);
            let up = gy * f64::from(next - row);
            let lowest_plane = base + across.min(0.0) + up.min(0.0);
            let highest_plane = base + across.max(0.0) + up.max(0.0);
            let [lowest, highest] = self.lattice.range_at(self.x as usize, row as usize);
            if larger(highest - lowest_plane, highest_plane - lowest) + margin > least {
                return needed;
            }
            row = next + 1;
        }
        there
    }
}

/// Where an edge between lattice points is in a column, which moves from west to east.
#[derive(Clone, Copy)]
struct Edge {
    /// The last row at or below it.
    row: i32,
    /// How far it is above that row, in parts of which `width` are a row.
    rest: u32,
    width: u32,
    /// How much it rises from column to column: rows, and parts.
    rows: i32,
    parts: u32,
}

impl Edge {
    /// The edge at its western end.
    ///
    /// PERF: one division for all columns.
    #[inline(always)]
    fn of(p: [i32; 2], q: [i32; 2]) -> Self {
        let [width, height] = [q[0] - p[0], q[1] - p[1]];
        // An upright edge is in one column.
        let (rows, parts) = match width {
            0 => (0, 0),
            _ => (height.div_euclid(width), height.rem_euclid(width)),
        };
        Edge {
            row: p[1],
            rest: 0,
            width: width as u32,
            rows,
            parts: parts as u32,
        }
    }

    /// The first row at or above the edge.
    #[inline(always)]
    fn first_above(&self) -> i32 {
        self.row + i32::from(self.rest != 0)
    }

    /// Moves one column to the east.
    #[inline(always)]
    fn step(&mut self) {
        self.row += self.rows;
        self.rest += self.parts;
        if self.rest >= self.width {
            self.rest -= self.width;
            self.row += 1;
        }
    }

    /// The edge some columns further to the east.
    fn moved(&self, columns: u32) -> Self {
        let parts = u64::from(self.rest) + u64::from(self.parts) * u64::from(columns);
        let width = u64::from(self.width.max(1));
        Edge {
            row: self.row + self.rows * columns as i32 + (parts / width) as i32,
            rest: (parts % width) as u32,
            ..*self
        }
    }
}

/// Positive if the third of three lattice points is to the left of the line from the first to the
/// second.
#[inline(always)]
fn turn(points: [[i32; 2]; 3]) -> i64 {
    let [a, b, c] = points.map(|p| p.map(i64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

//! The surface along the lines between tiles.

use rustc_hash::FxHashMap;

use crate::data::{TerrainTile, Tiling};
use crate::error::Result;
use crate::terrain::boxes::Extent;
use crate::terrain::in_order::by_coordinates;
use crate::terrain::linear::{gradient, plan, turn};
use crate::terrain::records::{Record, SortedRecords, Sorter};
use crate::triangulation::num::Sign;

/// A height at a position along a line.
type Height = [f64; 2];

/// How the surface rises along x and y at the vertices on borders, by their positions in steps.
pub(super) type Rises = FxHashMap<[u16; 2], [f64; 2]>;

/// A position along a line, the height there, and how the surface rises along x and along y.
pub(super) type Crossing = [f64; 4];

/// The lines between the tiles of one level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lines {
    pub(super) tiling: Tiling,
    pub(super) level: u8,
}

/// What triangles of a surface say of lines between tiles.
#[derive(Default)]
pub(super) struct OnLines {
    /// By the keys of lines.
    pub(super) heights: Vec<Record<4>>,
    /// The heights where two lines cross, and how the surface rises there.
    pub(super) crossings: Vec<([u32; 2], [f64; 3])>,
}

/// The key of a line: the axis that is constant, and its number.
fn key_of(axis: usize, number: u32) -> u64 {
    (axis as u64) << 32 | u64::from(number)
}

impl Lines {
    /// Returns the lines that a range of coordinates meets: their numbers and coordinates.
    fn between(self, axis: usize, low: f64, high: f64) -> impl Iterator<Item = (u32, f64)> {
        let last = f64::from(self.tiling.size(self.level)[axis]);
        let number = |value: f64| self.tiling.in_sides(axis, self.level, value);
        let first = number(low).floor().clamp(0.0, last) as u32;
        (first..=number(high).ceil().clamp(0.0, last) as u32)
            .map(move |number| (number, self.tiling.line(axis, self.level, number)))
            .filter(move |&(_, at)| at >= low && at <= high)
    }

    /// Adds what a triangle of the surface says. It does not depend on the corner that is named
    /// first.
    pub(super) fn add(self, corners: [[f64; 3]; 3], found: &mut OnLines) {
        let corners = from_first(corners);
        let Extent { min, max } = Extent::of(corners);
        let rise = rise_of(corners);
        // The lines through the triangle: their numbers and coordinates.
        let inside: [Vec<(u32, f64)>; 2] =
            [0, 1].map(|axis| self.between(axis, min[axis], max[axis]).collect());
        for (axis, inside) in inside.iter().enumerate() {
            for &(number, at) in inside {
                for i in 0..3 {
                    let ends = [corners[i], corners[(i + 1) % 3]];
                    cross(ends, axis, at, &mut |[t, z]| {
                        let height = [t, z, rise[0], rise[1]];
                        found.heights.push((key_of(axis, number), height));
                    });
                }
            }
        }
        for &(column, x) in &inside[0] {
            for &(row, y) in &inside[1] {
                if let Some(height) = height_in(corners, [x, y]) {
                    let crossing = [height, rise[0], rise[1]];
                    found.crossings.push(([column, row], crossing));
                }
            }
        }
    }

    /// Passes on the parts of a segment between the lines, the ends of each in the order of their
    /// coordinates.
    pub(super) fn divide(self, ends: [[f64; 3]; 2], take: &mut dyn FnMut([[f64; 3]; 2])) {
        let [p, q] = match by_coordinates(&ends[0], &ends[1]).is_le() {
            true => ends,
            false => [ends[1], ends[0]],
        };
        let mut cuts = vec![p, q];
        for axis in 0..2 {
            let [low, high] = [p[axis].min(q[axis]), p[axis].max(q[axis])];
            for (_, at) in self.between(axis, low, high) {
                cross([p, q], axis, at, &mut |[t, z]| {
                    cuts.push(if axis == 0 { [at, t, z] } else { [t, at, z] });
                });
            }
        }
        // Along the segment: x does not fall from its first end to the last.
        let is_rising = p[1] <= q[1];
        cuts.sort_unstable_by(|a, b| {
            let along_y = match is_rising {
                true => a[1].total_cmp(&b[1]),
                false => b[1].total_cmp(&a[1]),
            };
            a[0].total_cmp(&b[0]).then(along_y)
        });
        cuts.dedup_by(|a, b| a[..2] == b[..2]);
        cuts.windows(2).for_each(|ends| take([ends[0], ends[1]]));
    }
}

/// The corners of a triangle in the same order, the smallest one first.
fn from_first(corners: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let [a, b, c] = corners;
    let turned = [[a, b, c], [b, c, a], [c, a, b]];
    let first = |p: &[[f64; 3]; 3], q: &[[f64; 3]; 3]| by_coordinates(&p[0], &q[0]);
    turned.into_iter().min_by(first).unwrap_or(corners)
}

/// The heights of a surface along all lines between the tiles of one level, and where they cross.
///
/// A line is linear between the heights that are kept: those at all edges that it crosses.
pub(super) struct TileLines {
    level: u8,
    heights: SortedRecords<4>,
    crossings: FxHashMap<[u32; 2], [f64; 3]>,
}

impl TileLines {
    /// Sorts the heights on lines of a level.
    ///
    /// # Errors
    /// Those of [`SortedRecords::of`].
    pub(super) fn new(
        level: u8,
        heights: Sorter<4>,
        crossings: FxHashMap<[u32; 2], [f64; 3]>,
    ) -> Result<Self> {
        Ok(TileLines {
            level,
            heights: SortedRecords::of(heights)?,
            crossings,
        })
    }

    /// Returns the heights along a line of a level that is not finer, between two positions on it.
    /// Where triangles meet at the line, the surface rises as in their mean.
    ///
    /// # Errors
    /// If they cannot be read.
    pub(super) fn along(
        &self,
        axis: usize,
        level: u8,
        number: u32,
        ends: [f64; 2],
    ) -> Result<Vec<Crossing>> {
        let key = key_of(axis, number << (self.level - level));
        let heights = self.heights.between((key, ends[0]), (key, ends[1]))?;
        let same = |a: &Record<4>, b: &Record<4>| a.1[..2] == b.1[..2];
        let mean = |all: &[Record<4>]| {
            let [t, z, ..] = all[0].1;
            let rise = [2, 3].map(|k| all.iter().map(|of| of.1[k]).sum::<f64>() / all.len() as f64);
            [t, z, rise[0], rise[1]]
        };
        Ok(heights.chunk_by(same).map(mean).collect())
    }

    /// Returns the height where two lines of a level that is not finer cross, and how the surface
    /// rises there.
    pub(super) fn crossing(&self, level: u8, numbers: [u32; 2]) -> Option<[f64; 3]> {
        let numbers = numbers.map(|number| number << (self.level - level));
        self.crossings.get(&numbers).copied()
    }
}

/// How a triangle rises along x and along y; not at all if it has no area.
fn rise_of(corners: [[f64; 3]; 3]) -> [f64; 2] {
    let rise = gradient(corners);
    if rise.iter().all(|rise| rise.is_finite()) {
        rise
    } else {
        [0.0; 2]
    }
}

/// Passes on the position and the height at which an edge crosses a line, or those of both ends if
/// the edge is on the line.
fn cross([p, q]: [[f64; 3]; 2], axis: usize, at: f64, add: &mut dyn FnMut(Height)) {
    // The same numbers from both sides of the edge.
    let [p, q] = if p[axis] <= q[axis] { [p, q] } else { [q, p] };
    if at < p[axis] || at > q[axis] {
        return;
    }
    let height_of = |p: [f64; 3]| [p[1 - axis], p[2]];
    if p[axis] == at {
        add(height_of(p));
    }
    if q[axis] == at {
        add(height_of(q));
    }
    if p[axis] < at && at < q[axis] {
        let t = (at - p[axis]) / (q[axis] - p[axis]);
        let [a, b] = [height_of(p), height_of(q)];
        add([0, 1].map(|k| a[k] + t * (b[k] - a[k])));
    }
}

/// Returns the height of a triangle at a position, if it is there.
fn height_in(corners: [[f64; 3]; 3], at: [f64; 2]) -> Option<f64> {
    let [a, b, c] = corners.map(plan);
    let is_left = |p, q| turn(p, q, at) != Sign::Negative;
    (is_left(a, b) && is_left(b, c) && is_left(c, a)).then(|| height_on(corners, at))
}

/// Returns the height of the plane through the corners of a triangle.
pub(super) fn height_on([a, b, c]: [[f64; 3]; 3], at: [f64; 2]) -> f64 {
    let minus = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1]];
    let ([bx, by], [cx, cy]) = (minus(b), minus(c));
    let [x, y] = [at[0] - a[0], at[1] - a[1]];
    let area = bx * cy - by * cx;
    let (s, t) = ((x * cy - y * cx) / area, (bx * y - by * x) / area);
    let height = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]);
    // A triangle without an area, rounded.
    if height.is_finite() { height } else { a[2] }
}

/// The vertices of a border: positions along it in steps, and heights in steps of height.
pub(super) type Chain = Vec<(u16, i32)>;

/// Chooses the vertices of a border: the ends and all others that are `fixed` stay. No height is
/// further from the line through them than the bound, if the steps are fine enough.
///
/// `heights` are in steps along the border, and in meters. The result depends on nothing else, so
/// that both tiles at a border have the same vertices.
///
/// # Complexity
/// Expected O(n log n) in the heights, quadratic at worst.
pub(super) fn chain(heights: &[Height], fixed: &[(u16, i32)], step: f64, bound: f64) -> Chain {
    let mut chain = fixed.to_vec();
    for ends in fixed.windows(2) {
        let mut open = vec![[ends[0], ends[1]]];
        while let Some([a, b]) = open.pop() {
            let Some([t, z]) = worst(heights, a, b, step, bound) else {
                continue;
            };
            if b.0 - a.0 < 2 {
                continue;
            }
            let at = (t.round() as u16).clamp(a.0 + 1, b.0 - 1);
            let middle = (at, (z / step).round() as i32);
            chain.push(middle);
            open.extend([[a, middle], [middle, b]]);
        }
    }
    chain.sort_unstable();
    // What later ones made unnecessary.
    let mut i = 1;
    while i + 1 < chain.len() {
        let is_fixed = fixed.binary_search(&chain[i]).is_ok();
        let [before, after] = [chain[i - 1], chain[i + 1]];
        if !is_fixed && worst(heights, before, after, step, bound).is_none() {
            chain.remove(i);
        } else {
            i += 1;
        }
    }
    chain
}

/// The height between two vertices that is furthest from the line between them, if one is further
/// than the bound.
fn worst(
    heights: &[Height],
    a: (u16, i32),
    b: (u16, i32),
    step: f64,
    bound: f64,
) -> Option<Height> {
    let [from, to] = [a, b].map(|(at, height)| [f64::from(at), f64::from(height) * step]);
    let first = heights.partition_point(|&[t, _]| t < from[0]);
    let last = heights.partition_point(|&[t, _]| t <= to[0]);
    let slope = (to[1] - from[1]) / (to[0] - from[0]);
    let off = |&[t, z]: &Height| (from[1] + slope * (t - from[0]) - z).abs();
    let mut worst: Option<(f64, Height)> = None;
    for height in &heights[first..last.max(first)] {
        let off = off(height);
        if off > bound && worst.is_none_or(|(most, _)| off > most) {
            worst = Some((off, *height));
        }
    }
    worst.map(|(_, height)| height)
}

/// Returns the height of a border at a position along it, given its vertices in their order.
pub(super) fn height_along(vertices: &[Height], t: f64) -> f64 {
    let after = vertices.partition_point(|&[at, _]| at < t).max(1);
    match vertices.get(after - 1..=after) {
        Some(&[[a, from], [b, to]]) => from + (t - a) / (b - a) * (to - from),
        _ => vertices.last().map_or(f64::NAN, |&[_, height]| height),
    }
}

/// Returns how the surface rises at the vertices of a border: as in the mean of the crossings up to
/// the vertices before and after it.
pub(super) fn rises(crossings: &[Crossing], chain: &[(u16, i32)]) -> Vec<[f64; 2]> {
    let limit = |i: usize| chain.get(i).map_or(f64::NAN, |&(at, _)| f64::from(at));
    let rise = |i: usize| {
        let [before, after] = [
            limit(i.saturating_sub(1)),
            limit((i + 1).min(chain.len() - 1)),
        ];
        let first = crossings.partition_point(|&[t, ..]| t < before);
        let last = crossings.partition_point(|&[t, ..]| t <= after);
        let near = &crossings[first..last.max(first)];
        let mean = |k: usize| near.iter().map(|of| of[k]).sum::<f64>() / near.len().max(1) as f64;
        [mean(2), mean(3)]
    };
    (0..chain.len()).map(rise).collect()
}

/// Returns crossings with positions in steps from one end of a border to the other.
pub(super) fn in_steps(crossings: &[Crossing], [first, last]: [f64; 2]) -> Vec<Crossing> {
    crossings
        .iter()
        .map(|&[t, z, x, y]| [steps_between(t, first, last), z, x, y])
        .collect()
}

/// Returns how many steps of a tile a coordinate is from its first side, within the tile.
pub(super) fn steps_between(value: f64, first: f64, last: f64) -> f64 {
    let all = f64::from(TerrainTile::STEPS);
    ((value - first) / (last - first) * all).clamp(0.0, all)
}

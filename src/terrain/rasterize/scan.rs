//! Scan conversion of one face into a block of cells.
//!
//! The value of a cell depends on its center and the surface, not on the order of the faces:
//! - center at a vertex: the height of the vertex;
//! - on an edge: the height on the edge, computed from its lower left end, so that both faces
//!   agree;
//! - inside a face: the height on the segment in which the row of centers cuts the face.
//!
//! Exact orientation tests decide which of these applies. Few cells need them: the ends of the
//! segment are computed with a known error, and a center farther than that from both is inside.

use std::ops::Range;

use super::placement::Centers;
use crate::data::orientation;
use crate::triangulation::kernel::{Filter, FlooredErrorBound, Orientation2};
use crate::triangulation::num::Sign;

/// The number in a cell whose center is in no face.
pub(super) const NO_FACE: u32 = u32::MAX;

/// A block of cells into which faces are drawn.
pub(super) struct Scan<'a> {
    pub(super) columns: &'a Centers,
    pub(super) rows: &'a Centers,
}

/// What faces are drawn with. Cells are numbered row by row, as many columns and rows as there are
/// centers.
pub trait Ink {
    /// Called before a face is drawn, with its corners as the surface has them.
    fn of_face(&mut self, _face: u32, _corners: &[[f64; 3]; 3]) {}

    /// Writes one cell, given its height.
    fn cell(&mut self, cell: usize, height: f64);

    /// Writes cells next to each other from `start` on, given their x and the x and height of both
    /// ends of the segment in which the row cuts the face.
    fn row(&mut self, start: usize, centers: &[f64], ends: [(f64, f64); 2]);
}

/// Returns the height at each x of a segment with these ends.
#[inline(always)]
pub(super) fn heights_along(centers: &[f64], ends: [(f64, f64); 2]) -> impl Iterator<Item = f32> {
    let height = height_along(ends);
    centers.iter().map(move |&x| height(x) as f32)
}

/// Returns the function from x to the height on a segment with these ends.
#[inline(always)]
fn height_along([left, right]: [(f64, f64); 2]) -> impl Fn(f64) -> f64 {
    let slope = (right.1 - left.1) / (right.0 - left.0);
    move |x| left.1 + (x - left.0) * slope
}

/// Returns the height of a triangle at a position, bit for bit that of a cell with this center;
/// `None` outside of the triangle, and on a triangle without area except at its corners. The
/// corners may be in any order.
pub(super) fn height_at(corners: [[f64; 3]; 3], [x, y]: [f64; 2]) -> Option<f64> {
    let face = Face::new(corners);
    let [low, _, high] = &face.corners;
    if !(low[1] <= y && y <= high[1]) {
        return None;
    }
    let ends = face.ends(y);
    let [left, right] = ends.map(|end| end.0);
    if x < left - face.error || x > right + face.error {
        None
    } else if x <= left + face.error || x >= right - face.error {
        face.judge(x, y, ends)
    } else {
        Some(height_along(ends)(x))
    }
}

/// Writes the number of the face.
pub(super) struct Numbers<'a> {
    pub(super) cells: &'a mut [u32],
    pub(super) face: u32,
}

impl Ink for Numbers<'_> {
    fn of_face(&mut self, face: u32, _corners: &[[f64; 3]; 3]) {
        self.face = face;
    }

    fn cell(&mut self, cell: usize, _height: f64) {
        self.cells[cell] = self.face;
    }

    fn row(&mut self, start: usize, centers: &[f64], _ends: [(f64, f64); 2]) {
        self.cells[start..start + centers.len()].fill(self.face);
    }
}

impl Scan<'_> {
    /// Returns true if the center of a cell is certainly outside of a triangle, because it is on
    /// different sides of two edges. False does not mean that it is inside: near an edge, nothing
    /// is certain.
    #[inline(always)]
    pub(super) fn misses(&self, corners: &[[f64; 3]; 3], row: usize, column: usize) -> bool {
        let center = [self.columns.values()[column], self.rows.values()[row]];
        let [a, b, c] = corners.map(|[x, y, _]| [x, y]);
        let side = |p, q| FlooredErrorBound::try_sign(&Orientation2([p, q, center]));
        let sides = [side(a, b), side(b, c), side(c, a)];
        sides.contains(&Some(Sign::Positive)) && sides.contains(&Some(Sign::Negative))
    }

    /// Writes the cells of `rows` and `columns` (counted in the block) whose centers lie in the
    /// triangle or on its border. The corners may be in any order.
    #[inline]
    pub(super) fn draw(
        &self,
        corners: [[f64; 3]; 3],
        rows: &Range<usize>,
        columns: &Range<usize>,
        ink: &mut impl Ink,
    ) {
        let face = Face::new(corners);
        let [low, _, high] = &face.corners;
        let first = self.rows.at_or_after(low[1]).max(rows.start);
        let end = self.rows.after(high[1]).min(rows.end);
        if first >= end {
            return;
        }
        let (columns_of_block, rows_of_block) = (self.columns, self.rows);
        let centers = columns_of_block.values();
        for row in first..end {
            let y = rows_of_block.values()[row];
            let [left, right] = face.ends(y);
            let from = columns_of_block
                .at_or_after(left.0 - face.error)
                .max(columns.start);
            let to = columns_of_block
                .after(right.0 + face.error)
                .min(columns.end);
            if from >= to {
                continue;
            }
            let line = row * centers.len();
            let mut inside = from..to;
            while !inside.is_empty() && centers[inside.start] <= left.0 + face.error {
                if let Some(height) = face.judge(centers[inside.start], y, [left, right]) {
                    ink.cell(line + inside.start, height);
                }
                inside.start += 1;
            }
            while !inside.is_empty() && centers[inside.end - 1] >= right.0 - face.error {
                inside.end -= 1;
                if let Some(height) = face.judge(centers[inside.end], y, [left, right]) {
                    ink.cell(line + inside.end, height);
                }
            }
            ink.row(line + inside.start, &centers[inside], [left, right]);
        }
    }
}

/// A triangle in the plane of the scan.
struct Face {
    /// Sorted by y, then x, so that their order does not depend on the numbering.
    corners: [[f64; 3]; 3],
    /// The largest rounding error of a cut.
    error: f64,
}

impl Face {
    #[inline]
    fn new(mut corners: [[f64; 3]; 3]) -> Self {
        for (i, j) in [(0, 1), (1, 2), (0, 1)] {
            if (corners[j][1], corners[j][0]) < (corners[i][1], corners[i][0]) {
                corners.swap(i, j);
            }
        }
        // The sum of the rounding errors in `cut`, with u = EPSILON / 2: 5 u of an extent in x of
        // at most 2 M, and u of the result. 16 u M is larger than that.
        let largest = corners
            .iter()
            .fold(0.0, |most: f64, p| most.max(p[0].abs()));
        Face {
            corners,
            error: 8.0 * f64::EPSILON * largest,
        }
    }

    /// Returns the left and the right end of the segment in which the row of centers at `y` cuts
    /// the face, each with its height.
    #[inline(always)]
    fn ends(&self, y: f64) -> [(f64, f64); 2] {
        let [low, middle, high] = &self.corners;
        let mut left = cut(low, high, y);
        let mut right = if y < middle[1] {
            cut(low, middle, y)
        } else {
            cut(middle, high, y)
        };
        if right.0 < left.0 {
            std::mem::swap(&mut left, &mut right);
        }
        [left, right]
    }

    /// Returns the height of a cell whose center is close to the border of the face, unless it is
    /// outside.
    #[cold]
    fn judge(&self, x: f64, y: f64, [left, right]: [(f64, f64); 2]) -> Option<f64> {
        let [a, b, c] = &self.corners;
        if let Some(corner) = self.corners.iter().find(|p| p[0] == x && p[1] == y) {
            return Some(corner[2]);
        }
        let center = [x, y, 0.0];
        let turn = orientation([*a, *b, *c]);
        if turn == Sign::Zero {
            // A face without area covers only what its neighbors cover as well.
            return None;
        }
        let mut edge = None;
        for (p, q) in [(a, b), (b, c), (c, a)] {
            match turn * orientation([*p, *q, center]) {
                Sign::Negative => return None,
                // The direction of the edge must not depend on the face.
                Sign::Zero => {
                    edge = Some(if (p[1], p[0]) < (q[1], q[0]) {
                        (p, q)
                    } else {
                        (q, p)
                    })
                }
                Sign::Positive => (),
            }
        }
        Some(match edge {
            Some((p, q)) => height_on_edge(p, q, x, y),
            None if right.0 > left.0 => between(left.1, right.1, (x - left.0) / (right.0 - left.0)),
            None => left.1,
        })
    }
}

/// The x at which the edge from `p` up to `q` meets the row of centers at `y`, and its height
/// there.
#[inline]
fn cut(p: &[f64; 3], q: &[f64; 3], y: f64) -> (f64, f64) {
    if y == q[1] && (p[1] != q[1]) {
        return (q[0], q[2]);
    }
    if y == p[1] {
        return (p[0], p[2]);
    }
    let part = (y - p[1]) / (q[1] - p[1]);
    (p[0] + part * (q[0] - p[0]), p[2] + part * (q[2] - p[2]))
}

/// The height at a point on the edge from `p` to `q`, interpolated along its longer extent.
fn height_on_edge(p: &[f64; 3], q: &[f64; 3], x: f64, y: f64) -> f64 {
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let part = if dx.abs() > dy.abs() {
        (x - p[0]) / dx
    } else {
        (y - p[1]) / dy
    };
    between(p[2], q[2], part)
}

fn between(from: f64, to: f64, part: f64) -> f64 {
    from + part.clamp(0.0, 1.0) * (to - from)
}

//! The parts of lines that tiles get.

use super::Tile;
use crate::data::EdgeKind;
use crate::error::{Error, Result};
use crate::terrain::admitted;
use crate::terrain::in_order::in_order;
use crate::triangulation::geometry::{Geometry, Plane};
use crate::triangulation::kernel::{Kernel, Orientation2, Wide};
use crate::triangulation::num::{Sign, unsigned_zero};

/// Returns how far from a line something may matter to how it is rounded, or bent, or cut: a
/// thousand units in the last place of the largest coordinate, in the units of the data.
///
/// Lines and edges are rounded by a unit or two, and bent by points within one. What is farther
/// away decides nothing.
pub fn rounding_reach(largest: f64) -> f64 {
    1024.0 * f64::EPSILON * largest
}

/// A part of a line that crosses no other one between its ends.
///
/// Points may lie on it; they split it. Others may end on it or overlap it; where they overlap, the
/// kind that counts most in a surface counts (shores before banks, walls, breaklines, soft lines,
/// draped lines and clip lines).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubConstraint {
    /// The positions of its ends.
    pub ends: [[f64; 2]; 2],
    /// What its edges are part of.
    pub kind: EdgeKind,
}

impl SubConstraint {
    /// Returns it with the ends in order, or an error if it cannot be part of a line.
    pub(super) fn checked(&self) -> Result<Self> {
        let mut ends = self.ends.map(|end| end.map(unsigned_zero));
        if let Some(&[x, y]) = ends.iter().find(|end| !Plane::new().admits(end)) {
            return Err(admitted::refused([x, y, 0.0]).at("an end of a line"));
        }
        if !self.kind.is_constrained() {
            let ([a, b], kind) = (ends, self.kind);
            return Err(Error::format(format!(
                "the line from {a:?} to {b:?} has the kind {kind:?}"
            ))
            .cure("pass the kind of a line, such as Breakline"));
        }
        ends.sort_unstable_by(in_order);
        Ok(SubConstraint {
            ends,
            kind: self.kind,
        })
    }

    /// Returns true if it has a point in a tile. Exact.
    ///
    /// Cut to the box of the segment, the tile has four corners, some of them excluded. The line
    /// meets it if there are corners on both sides, or if a corner on the line is included.
    pub(super) fn meets(&self, tile: &Tile) -> bool {
        let [a, b] = self.ends;
        let mut bounds = [[(0.0, false); 2]; 2];
        for axis in 0..2 {
            let [low, high] = [a[axis].min(b[axis]), a[axis].max(b[axis])];
            if high < tile.min[axis] || low >= tile.max[axis] {
                return false;
            }
            // The box includes its sides, and so does the tile its lower ones.
            bounds[axis] = [
                (low.max(tile.min[axis]), true),
                (high.min(tile.max[axis]), high < tile.max[axis]),
            ];
        }
        let [x, y] = bounds;
        let corners = x
            .iter()
            .flat_map(|x| y.iter().map(move |y| ([x.0, y.0], x.1 && y.1)));
        let mut sides = [false; 2];
        for (corner, is_included) in corners {
            match Wide::sign(&Orientation2([a, b, corner])) {
                Sign::Positive => sides[0] = true,
                Sign::Negative => sides[1] = true,
                Sign::Zero if is_included => return true,
                Sign::Zero => {}
            }
        }
        sides == [true; 2]
    }
}

//! Segments of banks and level lines in plan.

use super::sites::{flat, middle};
use crate::data::orientation;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::triangulation::num::Sign;

/// A position at which a ring meets itself.
pub(super) fn meeting_of(mut ring: Vec<[f64; 3]>) -> Option<[f64; 2]> {
    ring.extend(ring.first().copied());
    let all = sides(&ring);
    let boxes = Boxes::new(all.clone());
    all.iter().find_map(|side| {
        boxes.find_in(side.extent(), |other| {
            cross(&side.0, &other.0).then(|| middle(&side.0))
        })
    })
}

/// A segment of a bank.
#[derive(Debug, Clone, Copy)]
pub(super) struct BankSegment(pub(super) [[f64; 3]; 2]);

impl Boxed for BankSegment {
    fn extent(&self) -> Extent {
        Extent::of(self.0)
    }
}

pub(super) fn sides(line: &[[f64; 3]]) -> Vec<BankSegment> {
    line.windows(2)
        .map(|pair| BankSegment([pair[0], pair[1]]))
        .collect()
}

/// The point at a part of a segment, from 0 to 1.
pub(super) fn side_between([from, to]: [[f64; 2]; 2], part: f64) -> [f64; 2] {
    if part == 1.0 {
        to
    } else {
        [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]))
    }
}

/// Returns true if two segments share a point other than a common end.
pub(crate) fn cross([a, b]: &[[f64; 3]; 2], [c, d]: &[[f64; 3]; 2]) -> bool {
    let is_apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    if is_apart(0) || is_apart(1) {
        return false;
    }
    let same = |p: &[f64; 3], q: &[f64; 3]| flat(*p) == flat(*q);
    let (ab, cd) = ([a, b], [c, d]);
    let shared = ab
        .iter()
        .flat_map(|p| cd.iter().map(move |q| same(p, q)))
        .filter(|is_same| *is_same)
        .count();
    let sides =
        [[a, b, c], [a, b, d], [c, d, a], [c, d, b]].map(|[p, q, r]| orientation([*p, *q, *r]));
    if shared > 0 {
        return false;
    }
    let [s, t, u, v] = sides;
    (s == Sign::Zero || s != t) && (u == Sign::Zero || u != v)
}

/// Returns true if a position lies in a triangle or on its border, in either orientation.
pub(crate) fn contains(corners: [[f64; 3]; 3], [x, y]: [f64; 2]) -> bool {
    let [a, b, c] = corners;
    let q = [x, y, 0.0];
    let turn = orientation(corners);
    turn != Sign::Zero
        && [[a, b], [b, c], [c, a]]
            .iter()
            .all(|[p, r]| turn * orientation([*p, *r, q]) != Sign::Negative)
}

//! The lines of one level in a cell, with exact tests of what lies where one is to be moved.

use std::cmp::Ordering::{Greater, Less};

use super::strand::Strand;
use crate::terrain::boxes::Extent;
use crate::terrain::linear::{do_meet, turn};
use crate::triangulation::num::Sign;

/// A point of a strand: the number of the strand, and that of the point.
pub(super) type Member = [usize; 2];

/// The strands of one level in a cell of the lattice, with the points that are left of them.
pub(super) struct Room {
    pub(super) strands: Vec<Strand>,
    /// Which points are left.
    is_left: Vec<Vec<bool>>,
}

/// Returns true if a point lies in a closed triangle of either orientation, within its box.
fn is_in_triangle([a, b, c]: [[f64; 2]; 3], point: [f64; 2]) -> bool {
    let mut signs = [[a, b], [b, c], [c, a]]
        .map(|[p, q]| turn(p, q, point))
        .into_iter();
    let (mut has_left, mut has_right) = (false, false);
    signs.all(|sign| {
        has_left |= sign == Sign::Positive;
        has_right |= sign == Sign::Negative;
        !(has_left && has_right)
    })
}

/// Returns true if two closed segments have a point in common.
fn meet(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> bool {
    Extent::of_plan(one).overlaps(&Extent::of_plan(other)) && do_meet(one, other)
}

impl Room {
    /// Takes the strands in an order that depends on their points alone.
    pub(super) fn new(mut strands: Vec<Strand>) -> Self {
        strands.sort_by(Strand::compare);
        let is_left = strands.iter().map(|s| vec![true; s.points.len()]).collect();
        Room { strands, is_left }
    }

    /// Removes a point of a strand.
    pub(super) fn remove(&mut self, [strand, point]: Member) {
        self.is_left[strand][point] = false;
    }

    /// Drops the points that were removed, and returns the strands.
    pub(super) fn finish(mut self) -> Vec<Strand> {
        for (strand, is_left) in self.strands.iter_mut().zip(&self.is_left) {
            let mut left = is_left.iter();
            strand.points.retain(|_| left.next() == Some(&true));
            let mut left = is_left.iter();
            strand.at.retain(|_| left.next() == Some(&true));
        }
        self.strands
    }

    /// Returns true if no point lies in a closed triangle, besides points of one strand and those
    /// that are equal to its first or its last corner.
    pub(super) fn is_empty(&self, triangle: [[f64; 2]; 3], strand: usize, own: &[usize]) -> bool {
        let extent = Extent::of_plan(triangle);
        let [first, _, last] = triangle;
        self.strands.iter().enumerate().all(|(number, other)| {
            other.points.iter().enumerate().all(|(i, &point)| {
                !extent.contains(point)
                    || !self.is_left[number][i]
                    || number == strand && own.contains(&i)
                    || point == first
                    || point == last
                    || !is_in_triangle(triangle, point)
            })
        })
    }

    /// Returns true if no segment meets the path of a point, besides the two at the point. All
    /// points are left.
    pub(super) fn is_free(&self, [strand, moved]: Member, path: [[f64; 2]; 2]) -> bool {
        self.strands.iter().enumerate().all(|(number, other)| {
            other.points.windows(2).enumerate().all(|(i, ends)| {
                let is_own = number == strand && (i == moved || i + 1 == moved);
                is_own || !meet(path, [ends[0], ends[1]])
            })
        })
    }

    /// Returns true if another strand has the same ends.
    pub(super) fn has_twin(&self, strand: usize) -> bool {
        let ends = self.strands[strand].ends();
        let is_twin = |(number, other): (usize, &Strand)| number != strand && other.ends() == ends;
        self.strands.iter().enumerate().any(is_twin)
    }
}

/// A cell of the lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Cell {
    /// Returns true if a point lies inside, and not on the border.
    pub(super) fn has_inside(&self, point: [f64; 2]) -> bool {
        (0..2).all(|axis| {
            let orders = [self.low[axis], self.high[axis]].map(|c| c.partial_cmp(&point[axis]));
            orders == [Some(Less), Some(Greater)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_meet_at_ends_and_along_lines() {
        let path = [[0.0, 0.0], [2.0, 0.0]];
        for (other, expected) in [
            ([[1.0, -1.0], [1.0, 1.0]], true),
            ([[2.0, 0.0], [3.0, 0.0]], true),
            ([[1.0, 0.0], [1.5, 0.0]], true),
            ([[1.0, 0.5], [1.0, 1.0]], false),
            ([[2.5, 0.0], [3.0, 0.0]], false),
            ([[2.0, 1.0], [4.0, -2.0]], false),
        ] {
            assert_eq!(meet(path, other), expected, "{other:?}");
        }
    }

    #[test]
    fn triangles_are_closed() {
        let triangle = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        for (point, expected) in [
            ([1.0, 1.0], true),
            ([2.0, 2.0], true),
            ([4.0, 0.0], true),
            ([3.0, 2.0], false),
        ] {
            assert_eq!(is_in_triangle(triangle, point), expected, "{point:?}");
            let [a, b, c] = triangle;
            assert_eq!(is_in_triangle([c, b, a], point), expected, "{point:?}");
        }
    }
}

//! The order of triangles by their positions, on which results may depend: the numbering of a part
//! of a surface is not that of the whole.

use std::cmp::Ordering;

use crate::terrain::in_order::in_order;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::tds::CellId;

/// The index of the lexicographically smallest corner of a triangle.
pub(super) fn first_corner(base: &ConstrainedDelaunay<Terrain>, cell: CellId) -> usize {
    let corners = base.tds().corners(cell).map(|corner| base.point(corner));
    (0..3)
        .min_by(|&i, &j| base.geometry().compare(corners[i], corners[j]))
        .unwrap_or_default()
}

/// The corners of a triangle, counter-clockwise from the lexicographically smallest.
pub(super) fn corners(base: &ConstrainedDelaunay<Terrain>, cell: CellId) -> [[f64; 3]; 3] {
    let mut corners = base.tds().corners(cell).map(|corner| *base.point(corner));
    corners.rotate_left(first_corner(base, cell));
    corners
}

/// Compares triangles by the positions of their corners; infinite ones come last.
pub(super) fn compare(base: &ConstrainedDelaunay<Terrain>, a: CellId, b: CellId) -> Ordering {
    let key = |cell| {
        if base.tds().is_infinite(cell) {
            [[f64::INFINITY; 3]; 3]
        } else {
            corners(base, cell)
        }
    };
    in_order(&key(a), &key(b))
}

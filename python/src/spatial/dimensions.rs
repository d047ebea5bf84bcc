//! What differs between the plane and space.

use breakline::triangulation::Delaunay;
use breakline::triangulation::geometry::{Plane, Space};
use breakline::triangulation::kernel::{Orientation2, Orientation3, Predicate};
use breakline::triangulation::num::Expansion;
use breakline::triangulation::tds::{CellId, VertexId};

use super::mesh::Dimension;

impl Dimension<3, 2> for Plane {
    fn sibson(
        t: &Delaunay<Self, 3>,
        q: &[f64; 2],
        near: Option<CellId>,
    ) -> Option<Vec<(VertexId, f64)>> {
        t.sibson(q, near)
    }

    fn sides(simplex: [[f64; 2]; 3], q: [f64; 2]) -> [f64; 3] {
        replaced(simplex, q).map(|triangle| {
            Orientation2(triangle)
                .value(Expansion::difference)
                .estimate()
        })
    }

    fn inverse([[a, b], [c, d]]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let determinant = a * d - b * c;
        regular(
            [[a, b], [c, d]],
            [[d, -b], [-c, a]].map(|row| row.map(|x| x / determinant)),
        )
    }
}

impl Dimension<4, 3> for Space {
    fn sibson(
        t: &Delaunay<Self, 4>,
        q: &[f64; 3],
        near: Option<CellId>,
    ) -> Option<Vec<(VertexId, f64)>> {
        t.sibson(q, near)
    }

    fn sides(simplex: [[f64; 3]; 4], q: [f64; 3]) -> [f64; 4] {
        replaced(simplex, q)
            .map(|solid| Orientation3(solid).value(Expansion::difference).estimate())
    }

    fn inverse(rows: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
        let [a, b, c] = rows;
        // Columns of the inverse, times the determinant.
        let [u, v, w] = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = a[0] * u[0] + a[1] * u[1] + a[2] * u[2];
        regular(
            rows,
            [0, 1, 2].map(|i| [u[i], v[i], w[i]].map(|x| x / determinant)),
        )
    }
}

/// Returns a simplex with a position in the place of each of its corners.
fn replaced<const D: usize, const N: usize>(
    simplex: [[f64; D]; N],
    q: [f64; D],
) -> [[[f64; D]; N]; N] {
    std::array::from_fn(|i| {
        let mut replaced = simplex;
        replaced[i] = q;
        replaced
    })
}

/// Returns the inverse of a matrix if its condition allows to use it, by the measure of scipy: the
/// reciprocal of the condition number in the 1-norm is at least 1000 roundings.
fn regular<const D: usize>(matrix: [[f64; D]; D], inverse: [[f64; D]; D]) -> Option<[[f64; D]; D]> {
    let reciprocal = 1.0 / (norm(matrix) * norm(inverse));
    (reciprocal >= 1000.0 * f64::EPSILON).then_some(inverse)
}

/// Returns the largest sum of the magnitudes in a column.
fn norm<const D: usize>(matrix: [[f64; D]; D]) -> f64 {
    let column = |i: usize| matrix.iter().map(|row| row[i].abs()).sum::<f64>();
    (0..D).map(column).fold(0.0, |largest, sum| {
        if sum > largest || sum.is_nan() {
            sum
        } else {
            largest
        }
    })
}

fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

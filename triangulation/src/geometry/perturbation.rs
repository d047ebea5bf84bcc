//! One answer where several are correct: the symbolic perturbation.
//!
//! Points on a common empty sphere have many Delaunay triangulations. Lift each point to the
//! paraboloid, and raise the lifts by `e1 >> e2 >> ...`, the lexicographically largest point first:
//! the lower hull of the lifted points is then one definite triangulation, a function of the points
//! alone (Devillers and Teillaud 2011 perturb in the same spirit). Raising a corner of a simplex by
//! `e` raises its hyperplane at `q` by `e` times the barycentric coordinate of `q`; raising `q`
//! itself takes it out of the sphere. The first of the points, from the largest down, for which
//! that coordinate is not zero decides.

use std::cmp::Ordering;

use super::{Geometry, lexicographic};
use crate::num::Sign;

/// Returns true if `q` lies inside the circumscribed sphere of a positively oriented simplex; on
/// the sphere, if it does after the perturbation.
#[inline(always)]
pub(crate) fn in_sphere<G: Geometry<N>, const N: usize>(
    geometry: &G,
    simplex: [&G::Point; N],
    q: &G::Point,
) -> bool {
    match geometry.side_of_sphere(simplex, q) {
        Sign::Positive => true,
        Sign::Negative => false,
        Sign::Zero => in_tied_sphere(geometry, simplex, q),
    }
}

/// Like [`in_sphere`], for a `q` that lies on the sphere.
pub(crate) fn in_tied_sphere<G: Geometry<N>, const N: usize>(
    geometry: &G,
    simplex: [&G::Point; N],
    q: &G::Point,
) -> bool {
    decide(geometry, &simplex, q, |replaced| {
        let mut corners = simplex;
        corners[replaced] = q;
        geometry.orientation(corners)
    })
}

/// Returns true if `q`, which lies on the circle of three points in the plane, is inside after the
/// perturbation. `q` lies beyond the edge `a b`, seen from the point opposite to it.
///
/// Of the quadrilateral's diagonals, the one that ends at the largest point is removed. The result
/// is that of [`in_sphere`], in fewer steps.
#[inline]
pub(crate) fn in_tied_circle(opposite: [f64; 2], [a, b]: [[f64; 2]; 2], q: [f64; 2]) -> bool {
    let larger = |p, q| if lexicographic(p, q).is_lt() { q } else { p };
    lexicographic(larger(opposite, q), larger(a, b)).is_lt()
}

/// Like [`in_sphere`], but within the flat that the simplex spans, for either orientation of it.
pub(crate) fn in_sphere_of_flat<G: Geometry<N>, const N: usize>(
    geometry: &G,
    simplex: &[&G::Point],
    q: &G::Point,
) -> bool {
    match geometry.side_of_sphere_in_flat(simplex, q) {
        Sign::Positive => true,
        Sign::Negative => false,
        Sign::Zero => decide(geometry, simplex, q, |replaced| {
            let mut corners = simplex.to_vec();
            corners[replaced] = q;
            geometry.orientation_in_flat(&corners) * geometry.orientation_in_flat(simplex)
        }),
    }
}

/// Returns true if `q`, which lies on the sphere, is inside after the perturbation.
/// `barycentric(i)` is the sign of `q`'s barycentric coordinate for corner `i`.
#[cold]
fn decide<G: Geometry<N>, const N: usize>(
    geometry: &G,
    simplex: &[&G::Point],
    q: &G::Point,
    barycentric: impl Fn(usize) -> Sign,
) -> bool {
    let mut order = [0, 1, 2, 3];
    let order = &mut order[..simplex.len()];
    for k in 0..order.len() {
        // PERF: sorted only as far as needed; nearly always the first or the second decides.
        for other in k + 1..order.len() {
            if geometry
                .compare(simplex[order[k]], simplex[order[other]])
                .is_lt()
            {
                order.swap(k, other);
            }
        }
        let corner = order[k];
        if geometry.compare(q, simplex[corner]) != Ordering::Less {
            // A corner of the simplex itself (`compare` is `Equal`) is on the sphere, and stays
            // there.
            return false;
        }
        match barycentric(corner) {
            Sign::Positive => return true,
            Sign::Negative => return false,
            Sign::Zero => {}
        }
    }
    false
}

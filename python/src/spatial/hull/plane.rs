//! In the plane: the lower and the upper chain (Andrew 1979), of the points that are not inside of
//! a polygon of some outermost ones (Akl and Toussaint 1978).

use std::sync::atomic::{AtomicBool, Ordering};

use breakline::triangulation::InputError;
use breakline::triangulation::kernel::{Adaptive, Kernel, Orientation2};
use breakline::triangulation::num::Sign;
use rayon::prelude::*;

use super::listed::{Hull, equation};
use crate::spatial::lists::CHUNK;

/// The polygon has outermost points in these directions.
const DIRECTIONS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [1.0, 1.0],
    [0.0, 1.0],
    [-1.0, 1.0],
    [-1.0, 0.0],
    [-1.0, -1.0],
    [0.0, -1.0],
    [1.0, -1.0],
];

/// Returns the hull; `None` if the points are collinear.
pub(super) fn hull(
    points: &[[f64; 2]],
    cancel: &AtomicBool,
) -> Result<Option<Hull<2>>, InputError> {
    let polygon = corners(points, outermost(points));
    let candidates = outside(points, &polygon);
    if cancel.load(Ordering::Relaxed) {
        return Err(InputError::Canceled);
    }
    let corners = corners(points, candidates);
    Ok((corners.len() > 2).then(|| listed(points, &corners)))
}

fn turn(points: &[[f64; 2]], corners: [u32; 3]) -> Sign {
    Adaptive::sign(&Orientation2(corners.map(|p| points[p as usize])))
}

/// Returns a point that is farthest in each direction, up to rounding.
fn outermost(points: &[[f64; 2]]) -> Vec<u32> {
    let along = |[x, y]: [f64; 2], p: u32| {
        let [px, py] = points[p as usize];
        x * px + y * py
    };
    let farther = |mut most: [u32; 8], others: [u32; 8]| {
        for ((most, other), direction) in most.iter_mut().zip(others).zip(DIRECTIONS) {
            if along(direction, other) > along(direction, *most) {
                *most = other;
            }
        }
        most
    };
    if points.is_empty() {
        return Vec::new();
    }
    (0..points.len() as u32)
        .into_par_iter()
        .with_min_len(CHUNK)
        .fold(|| [0; 8], |most, p| farther(most, [p; 8]))
        .reduce(|| [0; 8], farther)
        .to_vec()
}

/// Returns the points that are not inside of a convex polygon.
fn outside(points: &[[f64; 2]], polygon: &[u32]) -> Vec<u32> {
    let is_inside = |p: u32| {
        let next = polygon.iter().cycle().skip(1);
        let mut sides = polygon.iter().zip(next);
        polygon.len() > 2 && sides.all(|(&a, &b)| turn(points, [a, b, p]) == Sign::Positive)
    };
    (0..points.len() as u32)
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter(|&p| !is_inside(p))
        .collect()
}

/// Returns the corners of the hull of some points, counter-clockwise; fewer than three if these
/// points are collinear.
fn corners(points: &[[f64; 2]], mut of: Vec<u32>) -> Vec<u32> {
    let position = |p: u32| points[p as usize];
    // The first of equal points is the one that is kept.
    of.par_sort_unstable_by(|&p, &q| {
        let by_position = position(p).partial_cmp(&position(q));
        by_position
            .unwrap_or(std::cmp::Ordering::Equal)
            .then(p.cmp(&q))
    });
    of.dedup_by_key(|p| position(*p));
    let mut corners = chain(points, of.iter().copied());
    let upper = chain(points, of.iter().rev().copied());
    // Both have the ends.
    corners.pop();
    corners.extend_from_slice(&upper[..upper.len().saturating_sub(1)]);
    corners
}

/// Returns those of sorted points after which the border turns left.
fn chain(points: &[[f64; 2]], sorted: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut chain: Vec<u32> = Vec::new();
    for p in sorted {
        while let [.., a, b] = chain[..]
            && turn(points, [a, b, p]) != Sign::Positive
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain
}

/// Returns a hull by its corners.
fn listed(points: &[[f64; 2]], corners: &[u32]) -> Hull<2> {
    let count = corners.len();
    let side = |k: usize| [k, (k + 1) % count].map(|k| corners[k]);
    let vector = |[a, b]: [u32; 2]| {
        let [[ax, ay], [bx, by]] = [a, b].map(|p| points[p as usize]);
        [bx - ax, by - ay]
    };
    let (mut volume, mut area) = (0.0, 0.0);
    let mut normals = Vec::with_capacity(count);
    for [a, b] in (0..count).map(side) {
        let [dx, dy] = vector([a, b]);
        let [ex, ey] = vector([corners[0], a]);
        volume += (ex * dy - ey * dx) / 2.0;
        area += dx.hypot(dy);
        normals.push(equation([dy, -dx], points[a as usize]));
    }
    Hull {
        vertices: corners.iter().map(|&p| p as i32).collect(),
        facets: (0..count).map(|k| side(k).map(|p| p as i32)).collect(),
        // Opposite the start of a side is the next one, which has its end.
        neighbors: (0..count)
            .map(|k| [k + 1, k + count - 1].map(|k| (k % count) as i32))
            .collect(),
        normals,
        volume,
        area,
    }
}

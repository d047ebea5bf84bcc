//! Flat sides of a hull in space: triangles in one plane become triangles between extreme points.

use std::collections::HashMap;

use breakline::triangulation::kernel::{Adaptive, Kernel, Orientation3};
use breakline::triangulation::num::Sign;
use rayon::prelude::*;

use crate::spatial::groups::Groups;
use crate::spatial::lists::CHUNK;

/// A triangle, counter-clockwise as seen from outside, and the facets opposite its corners.
#[derive(Clone, Copy)]
pub(super) struct Facet {
    pub(super) corners: [u32; 3],
    pub(super) neighbors: [u32; 3],
}

/// Returns facets between extreme points only, from those of a convex surface.
///
/// A point in the interior of an edge or a side is not a corner. A side with more than three
/// corners is a fan from the one with the smallest coordinates, so that the facets depend on the
/// set of points only.
pub(super) fn in_flat_sides(points: &[[f64; 3]], facets: Vec<Facet>) -> Vec<Facet> {
    let pairs = coplanar_neighbors(points, &facets);
    if pairs.is_empty() {
        return facets;
    }
    let mut groups = Groups::new(facets.len());
    pairs.into_iter().for_each(|pair| groups.join(pair));
    let triangles: Vec<[u32; 3]> = polygons(&facets, &mut groups)
        .into_iter()
        .flat_map(|mut polygon| {
            let position = |&k: &usize| points[polygon[k] as usize];
            let smaller = |k: usize, l: usize| if position(&l) < position(&k) { l } else { k };
            let first = (0..polygon.len()).reduce(smaller).unwrap_or_default();
            polygon.rotate_left(first);
            let (apex, others) = (polygon[0], polygon[1..].to_vec());
            (1..others.len()).map(move |k| [apex, others[k - 1], others[k]])
        })
        .collect();
    linked(&triangles)
}

/// Returns pairs of neighbors in one plane.
fn coplanar_neighbors(points: &[[f64; 3]], facets: &[Facet]) -> Vec<[u32; 2]> {
    let of_facet = |(f, facet): (usize, &Facet)| {
        let f = f as u32;
        let after = facet.neighbors.into_iter().filter(move |&g| g > f);
        let corners = facet.corners;
        let is_coplanar = move |&g: &u32| {
            let [a, b, c] = corners;
            let apex = facets[g as usize]
                .corners
                .into_iter()
                .find(|p| !corners.contains(p));
            apex.is_none_or(|apex| {
                let solid = [a, b, c, apex].map(|p| points[p as usize]);
                Adaptive::sign(&Orientation3(solid)) == Sign::Zero
            })
        };
        after.filter(is_coplanar).map(move |g| [f, g])
    };
    let all = facets.par_iter().with_min_len(CHUNK).enumerate();
    all.flat_map_iter(of_facet).collect()
}

/// Returns the corners of each side, counter-clockwise.
fn polygons(facets: &[Facet], groups: &mut Groups) -> Vec<Vec<u32>> {
    // The border of each side, and the number of sides at each point of it: the border of each of
    // these sides has exactly one edge that starts at the point.
    let mut border: Vec<(u32, [u32; 2])> = Vec::new();
    let mut sides_at: HashMap<u32, u32> = HashMap::new();
    for (f, facet) in (0..).zip(facets) {
        let side = groups.first(f);
        for (k, &beyond) in facet.neighbors.iter().enumerate() {
            if groups.first(beyond) != side {
                let ends = [(k + 1) % 3, (k + 2) % 3].map(|k| facet.corners[k]);
                border.push((side, ends));
                *sides_at.entry(ends[0]).or_default() += 1;
            }
        }
    }
    border.sort_unstable();
    border
        .chunk_by(|a, b| a.0 == b.0)
        .map(|border| {
            let next: HashMap<u32, u32> =
                border.iter().map(|&(_, [from, to])| (from, to)).collect();
            let first = border[0].1[0];
            let around = std::iter::successors(Some(first), |at| {
                next.get(at).copied().filter(|&to| to != first)
            });
            // Between two sides a point is in the interior of an edge.
            around
                .filter(|at| sides_at.get(at).is_some_and(|&count| count > 2))
                .collect()
        })
        .collect()
}

/// Returns the facets of a closed surface of triangles.
fn linked(triangles: &[[u32; 3]]) -> Vec<Facet> {
    let mut beside: HashMap<[u32; 2], u32> = HashMap::with_capacity(3 * triangles.len());
    for (f, corners) in (0..).zip(triangles) {
        for k in 0..3 {
            beside.insert([corners[k], corners[(k + 1) % 3]], f);
        }
    }
    let facet = |&corners: &[u32; 3]| Facet {
        corners,
        neighbors: [0, 1, 2].map(|k| {
            let back = [corners[(k + 2) % 3], corners[(k + 1) % 3]];
            beside.get(&back).copied().unwrap_or_default()
        }),
    };
    triangles.iter().map(facet).collect()
}

//! Snapping of cut lines to each other.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::arrangement::Arrangement;
use crate::triangulation::geometry::{Crossing, Terrain};

use super::met::met;
use crate::terrain::regions::{Domain, Segment};

/// Snaps the segments of closed curves to each other: afterwards, two segments share at most an
/// end, or are equal.
///
/// Segments are bent through the ends of others and the crossings that they come near. So a side
/// that runs along another one, or was meant to, becomes equal to it, and is rounded like it
/// wherever it crosses other lines. No segment moves by more than half a unit.
///
/// Segments that meet no triangle stay as they are.
///
/// # Complexity
/// O(n log n + k) for n segments that meet triangles and k pairs whose boxes overlap.
pub(super) fn snapped(
    base: &ConstrainedDelaunay<Terrain>,
    curves: &[(Domain, Segment)],
) -> Vec<(Domain, Segment)> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut at: HashMap<[u64; 2], u32> = HashMap::new();
    let mut number = |point: [f64; 2]| {
        *at.entry(point.map(f64::to_bits)).or_insert_with(|| {
            points.push(point);
            points.len() as u32 - 1
        })
    };
    let mut distinct: FxHashMap<[u32; 2], usize> = FxHashMap::default();
    let mut segments: Vec<[u32; 2]> = Vec::new();
    let mut drawn: Vec<Option<([u32; 2], usize)>> = Vec::with_capacity(curves.len());
    for ((_, segment), cells) in curves
        .iter()
        .zip(met(base, curves.iter().map(|(_, segment)| *segment)))
    {
        let ends = (!cells.is_empty()).then(|| segment.map(&mut number));
        drawn.push(ends.map(|[a, b]| {
            let next = segments.len();
            let segment = *distinct.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                segments.push([a.min(b), a.max(b)]);
                next
            });
            ([a, b], segment)
        }));
    }
    let step = base.geometry().step();
    let site = |i: u32| points[i as usize];
    let arrangement =
        Arrangement::with_snapped(points.len(), site, &segments, segments.len(), step)
            .crossing_free(site, &segments, step);
    let site = |site: u32| match (site as usize).checked_sub(points.len()) {
        Some(added) => arrangement.added()[added],
        None => points[site as usize],
    };
    let mut snapped = Vec::with_capacity(curves.len());
    for (&(domain, segment), drawn) in curves.iter().zip(drawn) {
        let Some(([a, b], at)) = drawn else {
            snapped.push((domain, segment));
            continue;
        };
        let mut chain: Vec<u32> = arrangement.chain(at as u32).to_vec();
        if a > b {
            chain.reverse();
        }
        let chain: Vec<u32> = std::iter::once(a).chain(chain).chain([b]).collect();
        snapped.extend(
            chain
                .windows(2)
                .map(|pair| (domain, [site(pair[0]), site(pair[1])])),
        );
    }
    snapped
}

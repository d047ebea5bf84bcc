//! The domains of closed curves that contain each face of a plane.

use rustc_hash::FxHashMap;

use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::num::Sign;

/// The number of an area that some closed curves bound together, by the even-odd rule.
pub(super) type Domain = usize;

/// The ends of a straight part of a line, in plan.
pub(super) type Segment = [[f64; 2]; 2];

/// The faces of a plane divided by curves: a face is a number, with sides from 0 to 2.
pub(super) trait Faces {
    /// Returns the face across a side; `None` if there is none. Appends the domains that the side
    /// bounds to `domains`, each as often as its curves run along the side.
    fn beyond(&self, face: u32, side: usize, domains: &mut Vec<Domain>) -> Option<u32>;
}

/// For each of `count` faces: what `value` returns for the sorted domains that contain it, or the
/// default if it is not connected to `start`. `within` are the domains of `start`.
///
/// # Complexity
/// Linear, plus, for each region that curves bound, the number of domains that contain it.
pub(super) fn label<T: Copy + Default>(
    faces: &impl Faces,
    count: usize,
    start: u32,
    within: Vec<Domain>,
    mut value: impl FnMut(&[Domain]) -> T,
) -> Vec<T> {
    let mut labels = vec![T::default(); count];
    let mut is_seen = vec![false; count];
    // Faces to continue from, each with the domains that contain it.
    let mut regions = vec![(start, within)];
    let mut here = Vec::new();
    let mut domains = Vec::new();
    while let Some((start, within)) = regions.pop() {
        if std::mem::replace(&mut is_seen[start as usize], true) {
            continue;
        }
        let label = value(&within);
        here.push(start);
        while let Some(face) = here.pop() {
            labels[face as usize] = label;
            for side in 0..3 {
                domains.clear();
                let Some(beyond) = faces.beyond(face, side, &mut domains) else {
                    continue;
                };
                if is_seen[beyond as usize] {
                    continue;
                }
                domains.sort_unstable();
                if domains.chunk_by(Domain::eq).all(|same| same.len() % 2 == 0) {
                    is_seen[beyond as usize] = true;
                    here.push(beyond);
                } else {
                    regions.push((beyond, toggled(&within, &domains)));
                }
            }
        }
    }
    labels
}

/// The sorted symmetric difference of domains and those that are listed an odd number of times.
fn toggled(within: &[Domain], listed: &[Domain]) -> Vec<Domain> {
    let mut all = [within, listed].concat();
    all.sort_unstable();
    all.chunk_by(Domain::eq)
        .filter(|same| same.len() % 2 == 1)
        .map(|same| same[0])
        .collect()
}

/// The sorted domains that contain a triangle, given all segments of the curves, none of which
/// crosses it.
///
/// A ray runs from the lowest corner to the right, a little above it. If a segment starts at the
/// corner, the other corners of the triangle decide on which side of it the triangle lies.
///
/// # Complexity
/// Linear in the number of segments.
pub(super) fn domains_at(
    geometry: &Terrain,
    corners: [[f64; 3]; 3],
    curves: &[(Domain, Segment)],
) -> Vec<Domain> {
    let lowest = (0..3).fold(0, |lowest, k| {
        if corners[k][1] < corners[lowest][1] {
            k
        } else {
            lowest
        }
    });
    let [start, next, last] = [0, 1, 2].map(|k| corners[(lowest + k) % 3]);
    let mut odd: FxHashMap<Domain, bool> = FxHashMap::default();
    for &(domain, [a, b]) in curves
        .iter()
        .filter(|(_, [a, b])| (a[1] > start[1]) != (b[1] > start[1]))
    {
        let [low, high] = if a[1] < b[1] { [a, b] } else { [b, a] }.map(|[x, y]| [x, y, 0.0]);
        let side = |p: &[f64; 3]| geometry.orientation([&low, &high, p]);
        let first = [start, next, last]
            .iter()
            .map(side)
            .find(|side| *side != Sign::Zero);
        *odd.entry(domain).or_default() ^= first == Some(Sign::Positive);
    }
    let mut within: Vec<Domain> = odd
        .into_iter()
        .filter(|&(_, is_odd)| is_odd)
        .map(|(domain, _)| domain)
        .collect();
    within.sort_unstable();
    within
}

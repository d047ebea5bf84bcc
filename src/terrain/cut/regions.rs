//! Which faces lie within which closed curves.

use rustc_hash::FxHashMap;

use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::num::Sign;

use super::{Domain, Segment};

/// Faces of a plane that curves divide: a face is a number, with sides from 0 to 2.
pub(super) trait Faces {
    /// The face beyond a side, and the domains that the side is a border of: of each as often as its curves run along
    /// it. `None` where nothing lies beyond.
    fn beyond(&self, face: u32, side: usize, domains: &mut Vec<Domain>) -> Option<u32>;
}

/// For each of `count` faces that hang together with `start` whether `is_kept` says so of the domains that it lies in,
/// which come sorted; given those that `start` lies in. Of all others, no.
///
/// # Complexity
/// Linear, and for each region that curves bound, the number of domains that it lies in.
pub(super) fn keep(
    faces: &impl Faces,
    count: usize,
    start: u32,
    within: Vec<Domain>,
    is_kept: impl Fn(&[Domain]) -> bool,
) -> Vec<bool> {
    let mut kept = vec![false; count];
    let mut is_seen = vec![false; count];
    // Faces to go on from, each with the domains that it lies in.
    let mut regions = vec![(start, within)];
    let mut here = Vec::new();
    let mut domains = Vec::new();
    while let Some((start, within)) = regions.pop() {
        if std::mem::replace(&mut is_seen[start as usize], true) {
            continue;
        }
        let is_kept = is_kept(&within);
        here.push(start);
        while let Some(face) = here.pop() {
            kept[face as usize] = is_kept;
            for side in 0..3 {
                domains.clear();
                let Some(beyond) = faces.beyond(face, side, &mut domains) else { continue };
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
    kept
}

/// Sorted domains, without those and with those others that are listed an odd number of times.
fn toggled(within: &[Domain], listed: &[Domain]) -> Vec<Domain> {
    let mut all = [within, listed].concat();
    all.sort_unstable();
    all.chunk_by(Domain::eq).filter(|same| same.len() % 2 == 1).map(|same| same[0]).collect()
}

/// The domains that a triangle lies in, sorted, given all segments of the curves, none of which crosses it.
///
/// A ray to the right of its lowest corner, a little above it, is followed: where a segment starts at the corner, the
/// triangle's other corners tell on which side of it the triangle lies.
///
/// # Complexity
/// Linear in the number of segments.
pub(super) fn domains_at(geometry: &Terrain, corners: [[f64; 3]; 3], curves: &[(Domain, Segment)]) -> Vec<Domain> {
    let lowest = (0..3).fold(0, |lowest, k| if corners[k][1] < corners[lowest][1] { k } else { lowest });
    let [start, next, last] = [0, 1, 2].map(|k| corners[(lowest + k) % 3]);
    let mut odd: FxHashMap<Domain, bool> = FxHashMap::default();
    for &(domain, [a, b]) in curves.iter().filter(|(_, [a, b])| (a[1] > start[1]) != (b[1] > start[1])) {
        let [low, high] = if a[1] < b[1] { [a, b] } else { [b, a] }.map(|[x, y]| [x, y, 0.0]);
        let side = |p: &[f64; 3]| geometry.orientation([&low, &high, p]);
        let first = [start, next, last].iter().map(side).find(|side| *side != Sign::Zero);
        *odd.entry(domain).or_default() ^= first == Some(Sign::Positive);
    }
    let mut within: Vec<Domain> = odd.into_iter().filter(|&(_, is_odd)| is_odd).map(|(domain, _)| domain).collect();
    within.sort_unstable();
    within
}

//! Simplifies lines inside the corridor.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::corridor::Corridor;
use super::room::Room;
use super::strand::turns_back;

/// A point that may be removed: the area of the triangle with its neighbors, its strand and its
/// number, and how often its neighbors had changed.
#[derive(Debug, PartialEq)]
struct Candidate {
    area: f64,
    member: [usize; 2],
    version: u32,
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_area = self.area.total_cmp(&other.area);
        by_area.then(self.member.cmp(&other.member))
    }
}

/// The points of a strand that are left, as a list.
struct Chain {
    before: Vec<usize>,
    after: Vec<usize>,
    versions: Vec<u32>,
}

/// Removes points of strands, those with the smallest triangles first (Visvalingam and Whyatt,
/// 1993), as long as the removed ones stay within a tolerance of the line, and the line in the
/// corridor, crosses nothing and does not turn back.
///
/// # Complexity
/// Quadratic in the points of the room in the worst case: each removal is compared with all.
pub(super) fn thin(room: &mut Room, level: f64, corridor: &Corridor<'_>, tolerance: f64) {
    let has_twin: Vec<bool> = (0..room.strands.len()).map(|s| room.has_twin(s)).collect();
    let mut chains: Vec<Chain> = room
        .strands
        .iter()
        .map(|strand| Chain {
            before: (0..strand.points.len())
                .map(|i| i.wrapping_sub(1))
                .collect(),
            after: (1..=strand.points.len()).collect(),
            versions: vec![0; strand.points.len()],
        })
        .collect();
    let mut heap = BinaryHeap::new();
    for strand in 0..room.strands.len() {
        for i in 1..room.strands[strand].points.len().saturating_sub(1) {
            heap.push(Reverse(candidate(room, &chains, [strand, i])));
        }
    }
    while let Some(Reverse(Candidate {
        member, version, ..
    })) = heap.pop()
    {
        let [strand, i] = member;
        let chain = &chains[strand];
        let is_current = version == chain.versions[i];
        if !is_current
            || !may_go(
                room,
                chain,
                member,
                has_twin[strand],
                level,
                corridor,
                tolerance,
            )
        {
            continue;
        }
        room.remove(member);
        let chain = &mut chains[strand];
        let [a, c] = [chain.before[i], chain.after[i]];
        chain.after[a] = c;
        chain.before[c] = a;
        chain.versions[i] = u32::MAX;
        let last = room.strands[strand].points.len() - 1;
        for k in [a, c].into_iter().filter(|&k| k != 0 && k != last) {
            chains[strand].versions[k] += 1;
            heap.push(Reverse(candidate(room, &chains, [strand, k])));
        }
    }
}

fn candidate(room: &Room, chains: &[Chain], member: [usize; 2]) -> Candidate {
    let [strand, i] = member;
    let chain = &chains[strand];
    let points = &room.strands[strand].points;
    let [a, b, c] = [chain.before[i], i, chain.after[i]].map(|k| points[k]);
    let cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    Candidate {
        area: cross.abs(),
        member,
        version: chain.versions[i],
    }
}

fn may_go(
    room: &Room,
    chain: &Chain,
    [number, i]: [usize; 2],
    has_twin: bool,
    level: f64,
    corridor: &Corridor<'_>,
    tolerance: f64,
) -> bool {
    let strand = &room.strands[number];
    let points = &strand.points;
    let last = points.len() - 1;
    let [before, after] = [chain.before[i], chain.after[i]];
    let [a, b, c] = [before, i, after].map(|k| points[k]);
    let joins_ends = before == 0 && after == last;
    let runs_along_border = || a[0] == c[0] || a[1] == c[1];
    if a == c || joins_ends && (has_twin || runs_along_border()) {
        return false;
    }
    // A ring keeps three points.
    let closes =
        |from: [f64; 2], other: usize| points[other] == from && (other == 0 || other == last);
    if before == 0 && after != last && closes(a, chain.after[after])
        || after == last && before != 0 && closes(c, chain.before[before])
    {
        return false;
    }
    let is_near = |p: &[f64; 2]| distance(*p, [a, c]) <= tolerance;
    if !points[before + 1..after].iter().all(is_near) {
        return false;
    }
    let earlier = (before != 0).then(|| [points[chain.before[before]], a, c]);
    let later = (after != last).then(|| [a, c, points[chain.after[after]]]);
    if [earlier, later].into_iter().flatten().any(turns_back) {
        return false;
    }
    let passes = if after == last && before != 0 {
        // From the end, whose face is known if it is an anchor.
        corridor.passes(strand.spot(after), a, level)
    } else {
        corridor.passes(strand.spot(before), c, level)
    };
    passes.is_some() && room.is_empty([a, b, c], number, &[before, i, after])
}

/// Returns the distance of a point from a segment.
fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [u, v] = [[b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]];
    let square = u[0] * u[0] + u[1] * u[1];
    let part = ((u[0] * v[0] + u[1] * v[1]) / square).clamp(0.0, 1.0);
    (v[0] - part * u[0]).hypot(v[1] - part * u[1])
}

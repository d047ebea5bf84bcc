//! The order in which points are inserted: in rounds (Amenta, Choi and Rote 2003).
//!
//! Each round has about fifteen times as many points as all before it together, drawn by a hash of
//! the rank in [spatial order](crate::bulk::spatial_order), so that the first rounds are a sample.
//! Within a round the points are in spatial order, every other round backward, so that each point
//! is close to the one inserted before it.

/// The binary logarithm of the ratio of two rounds.
const RATIO: u32 = 4;

/// The first round has no more points than about this number.
const FEW: usize = 1000;

/// The number of points in a sample.
const SAMPLE: usize = 2000;

/// Returns the indices of points, given by ascending ranks, in the order of insertion.
pub(super) fn rounds(ranks: &[u32]) -> Vec<u32> {
    let last = (0..)
        .find(|round| ranks.len() >> (RATIO * round) <= FEW)
        .unwrap_or(0);
    let round = |rank: u32| (last - (mixed(rank).trailing_zeros() / RATIO).min(last)) as usize;
    let mut starts = vec![0; last as usize + 2];
    ranks.iter().for_each(|&rank| starts[round(rank) + 1] += 1);
    for round in 1..starts.len() {
        starts[round] += starts[round - 1];
    }
    let mut order = vec![0; ranks.len()];
    let mut next = starts.clone();
    for (index, &rank) in (0u32..).zip(ranks) {
        let next = &mut next[round(rank)];
        order[*next] = index;
        *next += 1;
    }
    starts
        .windows(2)
        .skip(1)
        .step_by(2)
        .for_each(|ends| order[ends[0]..ends[1]].reverse());
    order
}

/// Returns some of the numbers `0..count`, ascending.
pub(super) fn sample(count: usize) -> Vec<u32> {
    let one_in = (count / SAMPLE).max(1) as u64;
    (0..count as u32)
        .filter(|&rank| mixed(rank).is_multiple_of(one_in))
        .collect()
}

/// Returns bits that depend on all bits of a number (Steele, Lea and Flood 2014).
fn mixed(rank: u32) -> u64 {
    let mut bits = u64::from(rank)
        .wrapping_add(1)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

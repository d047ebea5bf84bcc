//! Which of the places for labels get one.

use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::in_order::in_order;

/// A place for a label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    /// The number of the line.
    pub(super) line: u32,
    /// The middle of the text.
    pub(super) at: [f64; 2],
    /// The direction of the line.
    pub(super) along: [f64; 2],
    pub(super) level: f64,
    /// How far the line is from the chord under the text.
    pub(super) bend: f64,
}

/// The least distances of labels from each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distances {
    /// That of the first label of a line from those that are there before.
    pub(super) first: f64,
    /// That of any other label; at least as much.
    pub(super) further: f64,
}

/// Returns the places that get a label, in the order in which they do.
///
/// Places are asked in the order of their bends, and of their coordinates where these are equal.
/// First, each that has the first distance from all labels gets one, unless its line has one; then
/// each that has the further distance does. So a line stays without a label only where no place of
/// it has the first distance from all others.
///
/// # Complexity
/// Expected O(n log n), and the number of places around each label.
pub(super) fn chosen(mut candidates: Vec<Candidate>, least: Distances) -> Vec<Candidate> {
    candidates.sort_by(|a, b| {
        let rank = |candidate: &Candidate| (candidate.bend, candidate.at);
        let by_line = || a.line.cmp(&b.line);
        in_order(&rank(a), &rank(b)).then_with(by_line)
    });
    let sites = (0..).zip(&candidates);
    let sites = Boxes::new(sites.map(|(number, p)| Site { number, at: p.at }).collect());
    let lines = candidates
        .iter()
        .map(|candidate| candidate.line as usize + 1)
        .max();
    let mut has_label = vec![false; lines.unwrap_or(0)];
    // From each place to the label that is nearest, as far as it matters.
    let mut distances = vec![f64::INFINITY; candidates.len()];
    let mut found = Vec::new();
    for is_first in [true, false] {
        let wanted = if is_first { least.first } else { least.further };
        for (number, candidate) in candidates.iter().enumerate() {
            let line = candidate.line as usize;
            let distance = distances[number];
            // Not where one is, even if no distance is wanted.
            let has_room = distance > 0.0 && distance >= wanted;
            if !has_room || is_first && has_label[line] {
                continue;
            }
            has_label[line] = true;
            found.push(*candidate);
            let near = Extent::of_plan([candidate.at]).grown(least.further);
            sites.find_in(near, |site| -> Option<()> {
                let distance = (site.at[0] - candidate.at[0]).hypot(site.at[1] - candidate.at[1]);
                let nearest = &mut distances[site.number as usize];
                *nearest = nearest.min(distance);
                None
            });
        }
    }
    found
}

/// A place by its number.
#[derive(Debug, Clone, Copy)]
struct Site {
    number: u32,
    at: [f64; 2],
}

impl Boxed for Site {
    fn extent(&self) -> Extent {
        Extent::of_plan([self.at])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    /// Places on a small grid of whole coordinates, with few different bends.
    fn some(random: &mut Random) -> Vec<Candidate> {
        let (side, lines) = (3 + random.index(12), 1 + random.below(9) as u32);
        let count = random.index(60);
        let mut candidates: Vec<Candidate> = (0..count)
            .map(|_| Candidate {
                line: random.below(u64::from(lines)) as u32,
                at: [0, 1].map(|_| random.index(side) as f64),
                along: [1.0, 0.0],
                level: 0.0,
                bend: random.index(3) as f64,
            })
            .collect();
        // Lines have no place twice.
        candidates.sort_by(|a, b| in_order(&(a.at, a.bend), &(b.at, b.bend)));
        candidates.dedup_by_key(|candidate| (candidate.at.map(f64::to_bits), candidate.line));
        candidates
    }

    fn distance(a: &Candidate, b: &Candidate) -> f64 {
        (a.at[0] - b.at[0]).hypot(a.at[1] - b.at[1])
    }

    /// The same, by comparing all with all.
    fn naive(candidates: &[Candidate], least: Distances) -> Vec<Candidate> {
        let mut found: Vec<Candidate> = Vec::new();
        for is_first in [true, false] {
            loop {
                let may = |candidate: &&Candidate| {
                    let wanted = if is_first { least.first } else { least.further };
                    let is_free = |other: &Candidate| {
                        distance(candidate, other) >= wanted && other.at != candidate.at
                    };
                    let has_label = found.iter().any(|other| other.line == candidate.line);
                    found.iter().all(is_free) && !(is_first && has_label)
                };
                let rank = |candidate: &Candidate| {
                    (candidate.bend, candidate.at, f64::from(candidate.line))
                };
                let best = candidates
                    .iter()
                    .filter(may)
                    .min_by(|a, b| in_order(&rank(a), &rank(b)));
                match best {
                    Some(best) => found.push(*best),
                    None => break,
                }
            }
        }
        found
    }

    #[test]
    fn the_best_places_are_taken_and_no_line_stays_bare_where_there_is_room() {
        let (mut bare, mut both) = (0, 0);
        for seed in 0..2000 {
            let mut random = Random(seed);
            let mut candidates = some(&mut random);
            let first = random.pick(&[0.0, 1.0, 2.0, 5.0]);
            let least = Distances {
                first,
                further: first * random.pick(&[1.0, 2.0, 4.0]),
            };
            let found = chosen(candidates.clone(), least);
            assert_eq!(found, naive(&candidates, least), "seed {seed}");
            random.shuffle(&mut candidates);
            assert_eq!(found, chosen(candidates.clone(), least), "seed {seed}");
            for (i, one) in found.iter().enumerate() {
                assert!(found[..i].iter().all(|other| distance(one, other) >= first));
            }
            for candidate in &candidates {
                let has_label = found.iter().any(|label| label.line == candidate.line);
                let is_near = |label: &Candidate| {
                    label.at == candidate.at || distance(label, candidate) < first
                };
                assert!(has_label || found.iter().any(is_near), "seed {seed}");
                bare += usize::from(!has_label);
            }
            both += found.len();
        }
        assert!(bare > 0 && both > 0);
    }
}

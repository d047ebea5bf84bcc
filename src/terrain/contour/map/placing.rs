//! Which of the places for labels get one.

use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::in_order::in_order;

/// A place for a label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
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
pub(super) fn placed(mut places: Vec<Place>, least: Distances) -> Vec<Place> {
    places.sort_by(|a, b| {
        let rank = |place: &Place| (place.bend, place.at);
        let by_line = || a.line.cmp(&b.line);
        in_order(&rank(a), &rank(b)).then_with(by_line)
    });
    let sites = (0..).zip(&places);
    let sites = Boxes::new(sites.map(|(number, p)| Site { number, at: p.at }).collect());
    let lines = places.iter().map(|place| place.line as usize + 1).max();
    let mut has_label = vec![false; lines.unwrap_or(0)];
    // From each place to the label that is nearest, as far as it matters.
    let mut distances = vec![f64::INFINITY; places.len()];
    let mut found = Vec::new();
    for is_first in [true, false] {
        let wanted = if is_first { least.first } else { least.further };
        for (number, place) in places.iter().enumerate() {
            let line = place.line as usize;
            let distance = distances[number];
            // Not where one is, even if no distance is wanted.
            let has_room = distance > 0.0 && distance >= wanted;
            if !has_room || is_first && has_label[line] {
                continue;
            }
            has_label[line] = true;
            found.push(*place);
            let near = Extent::of_plan([place.at]).grown(least.further);
            sites.find_in(near, |site| -> Option<()> {
                let distance = (site.at[0] - place.at[0]).hypot(site.at[1] - place.at[1]);
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
    fn some(random: &mut Random) -> Vec<Place> {
        let (side, lines) = (3 + random.index(12), 1 + random.below(9) as u32);
        let count = random.index(60);
        let mut places: Vec<Place> = (0..count)
            .map(|_| Place {
                line: random.below(u64::from(lines)) as u32,
                at: [0, 1].map(|_| random.index(side) as f64),
                along: [1.0, 0.0],
                level: 0.0,
                bend: random.index(3) as f64,
            })
            .collect();
        // Lines have no place twice.
        places.sort_by(|a, b| in_order(&(a.at, a.bend), &(b.at, b.bend)));
        places.dedup_by_key(|place| (place.at.map(f64::to_bits), place.line));
        places
    }

    fn distance(a: &Place, b: &Place) -> f64 {
        (a.at[0] - b.at[0]).hypot(a.at[1] - b.at[1])
    }

    /// The same, by comparing all with all.
    fn naive(places: &[Place], least: Distances) -> Vec<Place> {
        let mut found: Vec<Place> = Vec::new();
        for is_first in [true, false] {
            loop {
                let may = |place: &&Place| {
                    let wanted = if is_first { least.first } else { least.further };
                    let is_free =
                        |other: &Place| distance(place, other) >= wanted && other.at != place.at;
                    let has_label = found.iter().any(|other| other.line == place.line);
                    found.iter().all(is_free) && !(is_first && has_label)
                };
                let rank = |place: &Place| (place.bend, place.at, f64::from(place.line));
                let best = places
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
            let mut places = some(&mut random);
            let first = random.pick(&[0.0, 1.0, 2.0, 5.0]);
            let least = Distances {
                first,
                further: first * random.pick(&[1.0, 2.0, 4.0]),
            };
            let found = placed(places.clone(), least);
            assert_eq!(found, naive(&places, least), "seed {seed}");
            random.shuffle(&mut places);
            assert_eq!(found, placed(places.clone(), least), "seed {seed}");
            for (i, one) in found.iter().enumerate() {
                assert!(found[..i].iter().all(|other| distance(one, other) >= first));
            }
            for place in &places {
                let has_label = found.iter().any(|label| label.line == place.line);
                let is_near =
                    |label: &Place| label.at == place.at || distance(label, place) < first;
                assert!(has_label || found.iter().any(is_near), "seed {seed}");
                bare += usize::from(!has_label);
            }
            both += found.len();
        }
        assert!(bare > 0 && both > 0);
    }
}

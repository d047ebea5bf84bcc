//! Rivers that end or begin at the banks of others.

mod joints;

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::River;
use super::segments::side_between;
use super::sites::{Key, by_site, flat, key};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::nearest::{nearest_part, squared_distance};
use joints::{Joint, Joints};

pub(super) use joints::{LevelStations, StationId};

/// A segment of a bank: river, side, and the number of its stretch.
#[derive(Debug, Clone, Copy)]
struct BankSide {
    river: usize,
    side: usize,
    stretch: usize,
    ends: [[f64; 2]; 2],
}

impl Boxed for BankSide {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.ends)
    }
}

/// A position on a bank.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spot {
    /// The square of the distance to the position that was asked for.
    squared: f64,
    stretch: usize,
    /// The part of the stretch before it.
    part: f64,
    at: [f64; 2],
    is_vertex: bool,
}

/// An end of a river, and where its level line touches the bank of another one.
#[derive(Debug, Clone, Copy)]
struct Touch {
    branch: usize,
    end: usize,
    main: usize,
    side: usize,
    spots: [Option<Spot>; 2],
}

/// Finds the ends of rivers on banks of others, by `reach` at most from them. The banks get
/// vertices there. Ends that `continue` another river join it at vertices only; ends side by side
/// that share nothing but a corner are left out.
///
/// # Complexity
/// O(n log n) for n level lines, each time that vertices were added at which other ends are.
pub(super) fn join_banks(
    rivers: &mut [River],
    reach: f64,
    continues: &dyn Fn(usize, usize, usize) -> bool,
) -> Joints {
    let touches = loop {
        let mut touches = touches(rivers, reach, continues);
        touches.retain(|touch| {
            touch
                .spots
                .iter()
                .flatten()
                .any(|spot| !is_beside(rivers, touch, spot))
        });
        if !insert_vertices(rivers, &touches) {
            break touches;
        }
    };
    let mains: BTreeSet<usize> = touches.iter().map(|touch| touch.main).collect();
    let mut stations: FxHashMap<(usize, usize, Key), usize> = FxHashMap::default();
    for river in mains {
        for (station, ends) in rivers[river].stations.iter().enumerate().rev() {
            stations.extend([0, 1].map(|side| ((river, side, key(flat(ends[side]))), station)));
        }
    }
    let joint = |touch: &Touch| {
        let Touch {
            branch,
            end,
            main,
            side,
            spots,
        } = *touch;
        let station = |spot: Spot| stations.get(&(main, side, key(spot.at))).copied();
        Joint {
            branch,
            end,
            main,
            side,
            stations: spots.map(|spot| spot.and_then(station)),
        }
    };
    Joints::new(rivers, &touches.iter().map(joint).collect::<Vec<Joint>>())
}

/// Inserts vertices where ends touch banks; returns true if there were any to insert.
fn insert_vertices(rivers: &mut [River], touches: &[Touch]) -> bool {
    let mut wanted: BTreeMap<usize, Vec<(usize, Spot)>> = BTreeMap::new();
    for touch in touches {
        for spot in touch.spots.iter().flatten().filter(|spot| !spot.is_vertex) {
            wanted
                .entry(touch.main)
                .or_default()
                .push((touch.side, *spot));
        }
    }
    for (river, spots) in &mut wanted {
        spots.sort_by(|(side, p), (other, q)| {
            (p.stretch.cmp(&q.stretch))
                .then(p.part.total_cmp(&q.part))
                .then(side.cmp(other))
                .then(by_site(p.at, q.at))
        });
        spots.dedup_by(|p, q| p.0 == q.0 && p.1.at == q.1.at);
        rivers[*river].insert_stations(spots);
    }
    !wanted.is_empty()
}

/// Returns true if an end and the same end of the other river share a corner there: both end side
/// by side, or begin so, and neither flows into the other.
fn is_beside(rivers: &[River], touch: &Touch, spot: &Spot) -> bool {
    let stations = &rivers[touch.main].stations;
    let is_corner = |station: usize| flat(stations[station][touch.side]) == spot.at;
    let [is_first, is_last] = [is_corner(0), is_corner(stations.len() - 1)];
    spot.is_vertex
        && if touch.end == 0 {
            is_first && !is_last
        } else {
            is_last && !is_first
        }
}

/// The heights at which level rivers that touch others could begin or end there: river, end, and
/// the height of the other one.
pub(super) fn heights_at_banks(
    rivers: &[River],
    reach: f64,
    continues: &dyn Fn(usize, usize, usize) -> bool,
) -> Vec<(usize, usize, f64)> {
    let height = |touch: &Touch| {
        let spots = touch.spots.iter().flatten();
        let lowest = spots
            .map(|spot| rivers[touch.main].level_at(spot.stretch, spot.part))
            .fold(f64::INFINITY, f64::min);
        (touch.branch, touch.end, lowest)
    };
    let touches = touches(rivers, reach, continues).into_iter();
    touches
        .filter(|touch| !continues(touch.branch, touch.end, touch.main))
        .map(|touch| height(&touch))
        .collect()
}

fn touches(
    rivers: &[River],
    reach: f64,
    continues: &dyn Fn(usize, usize, usize) -> bool,
) -> Vec<Touch> {
    let mut sides = Vec::new();
    for (river, of) in rivers.iter().enumerate() {
        for (stretch, pair) in of.stations.windows(2).enumerate() {
            let side = |side: usize| BankSide {
                river,
                side,
                stretch,
                ends: [flat(pair[0][side]), flat(pair[1][side])],
            };
            sides.extend(
                [side(0), side(1)]
                    .into_iter()
                    .filter(|side| side.ends[0] != side.ends[1]),
            );
        }
    }
    let sides = Boxes::new(sides);
    let mut touches = Vec::new();
    for (branch, river) in rivers.iter().enumerate() {
        for (end, line) in [river.stations.first(), river.stations.last()]
            .into_iter()
            .flatten()
            .enumerate()
        {
            let mut found: BTreeMap<[usize; 2], [Option<Spot>; 2]> = BTreeMap::new();
            for (corner, at) in line.iter().enumerate() {
                for (bank, spot) in spots(&sides, flat(*at), reach) {
                    if bank[0] != branch {
                        found.entry(bank).or_default()[corner] = Some(spot);
                    }
                }
            }
            for ([main, side], spots) in found {
                let is_along = spots.iter().all(Option::is_some) && !continues(branch, end, main);
                if is_along || spots.iter().flatten().any(|spot| spot.is_vertex) {
                    // Without a vertex there, one of two ends is not on the bank.
                    let spots = if is_along {
                        spots
                    } else {
                        spots.map(vertex_only)
                    };
                    touches.push(Touch {
                        branch,
                        end,
                        main,
                        side,
                        spots,
                    });
                }
            }
        }
    }
    touches
}

fn vertex_only(spot: Option<Spot>) -> Option<Spot> {
    spot.filter(|spot| spot.is_vertex)
}

/// The nearest position on each bank that is close to a position: at a vertex, if it is one.
fn spots(sides: &Boxes<BankSide>, q: [f64; 2], reach: f64) -> BTreeMap<[usize; 2], Spot> {
    let mut nearest: BTreeMap<[usize; 2], Spot> = BTreeMap::new();
    sides.find_in(Extent::of_plan([q]).grown(reach), |side| {
        let (squared, part) = (squared_distance(side.ends, q), nearest_part(side.ends, q));
        let vertex = side.ends.iter().position(|end| *end == q);
        let spot = match vertex {
            Some(end) => Spot {
                squared,
                stretch: side.stretch + end,
                part: 0.0,
                at: q,
                is_vertex: true,
            },
            None => Spot {
                squared,
                stretch: side.stretch,
                part,
                at: q,
                is_vertex: false,
            },
        };
        if squared <= reach * reach {
            let found = nearest.entry([side.river, side.side]).or_insert(spot);
            if (spot.squared, spot.stretch) < (found.squared, found.stretch) {
                *found = spot;
            }
        }
        None::<()>
    });
    nearest
}

impl River {
    /// The height of the water within a stretch.
    fn level_at(&self, stretch: usize, part: f64) -> f64 {
        let level = |k: usize| self.stations.get(k).map_or(f64::NAN, |ends| ends[0][2]);
        if part == 0.0 {
            level(stretch)
        } else {
            level(stretch) + part * (level(stretch + 1) - level(stretch))
        }
    }

    /// Inserts level lines from positions on banks, sorted downstream, to the opposite points.
    fn insert_stations(&mut self, spots: &[(usize, Spot)]) {
        let mut stations = Vec::with_capacity(self.stations.len() + spots.len());
        let mut middles = Vec::with_capacity(self.middles.len() + spots.len());
        let mut spots = spots.iter().peekable();
        for (stretch, &station) in self.stations.iter().enumerate() {
            stations.push(station);
            middles.extend(self.middles.get(stretch).copied());
            while let Some((side, Spot { part, at, .. })) =
                spots.next_if(|(_, spot)| spot.stretch == stretch)
            {
                let Some(&next) = self.stations.get(stretch + 1) else {
                    continue;
                };
                let level = self.level_at(stretch, *part);
                let between = |k: usize| side_between([flat(station[k]), flat(next[k])], *part);
                let opposite = between(1 - side);
                let ends = if *side == 0 {
                    [*at, opposite]
                } else {
                    [opposite, *at]
                };
                stations.push(ends.map(|[x, y]| [x, y, level]));
                if let (Some(&from), Some(&to)) =
                    (self.middles.get(stretch), self.middles.get(stretch + 1))
                {
                    middles.push(side_between([from, to], *part));
                }
            }
        }
        (self.stations, self.middles) = (stations, middles);
        self.level_meetings();
    }
}

#[cfg(test)]
mod tests;

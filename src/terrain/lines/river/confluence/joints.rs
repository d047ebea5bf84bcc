//! How heights depend on each other where rivers join.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use crate::terrain::lines::river::River;
use crate::terrain::lines::river::sites::{Key, by_site, distance, flat, key};

/// A station: the number of its river, and its own.
pub(crate) type StationId = [usize; 2];

/// An end of a river on the bank of another one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    /// The river that ends or begins there.
    pub(super) branch: usize,
    /// Its first level line (0), or its last (1).
    pub(super) end: usize,
    /// The other river.
    pub(super) main: usize,
    /// Its bank, left (0) or right (1).
    pub(super) side: usize,
    /// The stations of the other river at the left and the right corner of that level line.
    pub(super) stations: [Option<usize>; 2],
}

/// What the heights of rivers that join each other have to satisfy.
#[derive(Debug, Default)]
pub(crate) struct Joints {
    /// Groups of stations of one height.
    pub(crate) equal: Vec<LevelStations>,
    /// Pairs of stations: the second is no higher than the first.
    pub(crate) bounds: Vec<[StationId; 2]>,
    /// The ends that join others, by river and end.
    ends: BTreeMap<[usize; 2], End>,
    /// The stations that have the height of a vertex at which ends join others.
    at_sites: BTreeMap<Key, BTreeSet<StationId>>,
}

/// Stations of one height.
#[derive(Debug)]
pub(crate) struct LevelStations {
    pub(crate) stations: Vec<StationId>,
    /// The river whose end they share, if it is an end that makes them level.
    pub(crate) end: Option<usize>,
}

/// How the first or the last level line of a river joins others.
#[derive(Debug, Default)]
struct End {
    joints: Vec<Joint>,
    /// The joint with the river whose bank the level line follows, and the stations there, from
    /// left to right.
    along: Option<(Joint, Vec<usize>)>,
    /// If it follows none, the stations of other rivers at its corners, unless those end there.
    members: Vec<StationId>,
}

impl Joints {
    /// Finds what follows from ends of rivers that share vertices with banks of others.
    ///
    /// - At a vertex of several banks that an end shares, all of them have one height.
    /// - A level line with each corner on another river is level: both have one height there.
    /// - Where one river ends and another begins at a corner that is on no other bank, both have
    ///   one height.
    pub(super) fn new(rivers: &[River], joints: &[Joint]) -> Self {
        let mut found = Joints::default();
        for joint in joints {
            found
                .ends
                .entry([joint.branch, joint.end])
                .or_default()
                .joints
                .push(*joint);
        }
        found
            .ends
            .values_mut()
            .for_each(|end| end.find_heights(rivers));
        found.find_sites(rivers);
        let at_site = |stations: &BTreeSet<StationId>| LevelStations {
            stations: Vec::from_iter(stations.clone()),
            end: None,
        };
        let mut equal: Vec<LevelStations> = found.at_sites.values().map(at_site).collect();
        let mut bounds = Vec::new();
        for (&[river, number], end) in &found.ends {
            let own = own_station(rivers, [river, number]);
            let is_met = rivers[river].met_at_end(number).next().is_some();
            let mut level = end.members.clone();
            let mut ends = end.members.clone();
            if let Some((joint, stations)) = &end.along {
                let height = |station: usize| found.height_at(rivers, joint, station);
                ends.extend(joint.stations.into_iter().flatten().map(height));
                if is_met {
                    level.extend(stations.iter().copied().map(height));
                }
            }
            bounds.extend(ends.iter().map(|station| {
                if number == 0 {
                    [*station, own]
                } else {
                    [own, *station]
                }
            }));
            // A first level line that is lower than the other river becomes as high, and the water
            // falls from there. It cannot if the next level line meets the first.
            if !level.is_empty() && (number == 1 || is_met) {
                level.push(own);
            }
            equal.push(LevelStations {
                stations: level,
                end: Some(river),
            });
        }
        equal.retain(|level| level.stations.len() > 1);
        Joints {
            equal,
            bounds,
            ..found
        }
    }

    /// Finds the stations that have one height, by the vertices that they share.
    fn find_sites(&mut self, rivers: &[River]) {
        let mut on_banks: BTreeMap<Key, BTreeSet<StationId>> = BTreeMap::new();
        let mut of_ends: BTreeMap<Key, BTreeSet<[usize; 2]>> = BTreeMap::new();
        for (&id, end) in &self.ends {
            for joint in &end.joints {
                for station in joint.stations_along(rivers) {
                    let site = key(joint.site(rivers, station));
                    match joint.end_of_main(rivers, station) {
                        Some(number) => of_ends
                            .entry(site)
                            .or_default()
                            .extend([id, [joint.main, number]]),
                        None => on_banks
                            .entry(site)
                            .or_default()
                            .extend([[joint.main, station]]),
                    }
                }
            }
        }
        // An end that follows a bank has the heights of that.
        let follows = |end: &[usize; 2]| self.ends.get(end).is_some_and(|end| end.along.is_some());
        for (site, ends) in of_ends {
            if on_banks.contains_key(&site) {
                continue;
            }
            let all_follow = ends.iter().all(follows);
            let level = ends
                .iter()
                .filter(|end| all_follow || !follows(end))
                .map(|end| self.own_height(rivers, *end));
            let level: BTreeSet<StationId> = level.collect();
            on_banks.insert(site, level);
        }
        self.at_sites = on_banks;
    }

    /// The station that has the height of an end that follows no bank.
    fn own_height(&self, rivers: &[River], end: [usize; 2]) -> StationId {
        let member = self.ends.get(&end).and_then(|end| end.members.first());
        member.copied().unwrap_or_else(|| own_station(rivers, end))
    }

    /// The station that has the height of a corner, left (0) or right (1), of the first (0) or the
    /// last (1) level line of a river.
    pub(crate) fn height_of_end(
        &self,
        rivers: &[River],
        end: [usize; 2],
        corner: usize,
    ) -> StationId {
        let [river, station] = own_station(rivers, end);
        let site = key(flat(rivers[river].stations[station][corner]));
        let shared = self
            .at_sites
            .get(&site)
            .filter(|_| self.ends.contains_key(&end))
            .and_then(BTreeSet::first);
        shared
            .copied()
            .unwrap_or_else(|| self.own_height(rivers, end))
    }

    /// The station that has the height of a station of another river which an end joins there.
    fn height_at(&self, rivers: &[River], joint: &Joint, station: usize) -> StationId {
        let shared = self
            .at_sites
            .get(&key(joint.site(rivers, station)))
            .and_then(BTreeSet::first);
        shared.copied().unwrap_or([joint.main, station])
    }

    /// Gives the ends of rivers that join others the heights of those: they follow their banks.
    pub(crate) fn fit_ends(&self, rivers: &mut [River]) {
        let levels: Vec<Vec<f64>> = rivers.iter().map(River::station_levels).collect();
        let at = |[x, y]: [f64; 2], [river, station]: StationId| [x, y, levels[river][station]];
        let mut lines: Vec<([usize; 2], Vec<[f64; 3]>)> = Vec::new();
        for (&[river, number], end) in &self.ends {
            let line = match (&end.along, end.members.first()) {
                (Some((joint, stations)), _) => {
                    let height = |&station| {
                        at(
                            joint.site(rivers, station),
                            self.height_at(rivers, joint, station),
                        )
                    };
                    stations.iter().map(height).collect()
                }
                (None, Some(member)) => {
                    let of = &rivers[river];
                    of.stations[of.station_of_end(number)]
                        .map(|corner| at(flat(corner), *member))
                        .to_vec()
                }
                (None, None) => continue,
            };
            lines.push(([river, number], line));
        }
        for ([river, end], line) in lines {
            let corners = vec![line[0], line[line.len() - 1]];
            let (river, follows) = (&mut rivers[river], line.len() > 2);
            river.set_end_line(end, line);
            if follows && !river.is_simple_at(end) {
                river.set_end_line(end, corners);
            }
        }
        rivers.iter_mut().for_each(River::divide_ends);
    }
}

/// The first (0) or the last (1) station of a river.
fn own_station(rivers: &[River], [river, end]: [usize; 2]) -> StationId {
    [river, rivers[river].station_of_end(end)]
}

impl End {
    /// Chooses the bank to follow, whatever the order of rivers: the one with most vertices.
    fn find_heights(&mut self, rivers: &[River]) {
        let both = self
            .joints
            .iter()
            .filter(|joint| joint.stations.iter().all(Option::is_some));
        let along = both.map(|joint| (*joint, joint.stations_along(rivers)));
        let sites = |(joint, stations): &(Joint, Vec<usize>)| -> Vec<[f64; 2]> {
            stations
                .iter()
                .map(|station| joint.site(rivers, *station))
                .collect()
        };
        self.along = along.max_by(|p, q| {
            let pairs = sites(p)
                .into_iter()
                .zip(sites(q))
                .map(|(p, q)| by_site(p, q));
            p.1.len()
                .cmp(&q.1.len())
                .then_with(|| pairs.fold(Ordering::Equal, Ordering::then))
        });
        if self.along.is_none() {
            let inner = |joint: &Joint| {
                joint
                    .inner(rivers)
                    .map(|station| [joint.main, station])
                    .collect::<Vec<_>>()
            };
            self.members = self.joints.iter().flat_map(inner).collect();
        }
    }
}

impl Joint {
    /// The stations of the other river at the corners of the end, if that river goes on there.
    fn inner<'a>(&'a self, rivers: &'a [River]) -> impl Iterator<Item = usize> + 'a {
        self.stations
            .into_iter()
            .flatten()
            .filter(|station| self.end_of_main(rivers, *station).is_none())
    }

    /// The position of a station of the other river on its bank.
    fn site(&self, rivers: &[River], station: usize) -> [f64; 2] {
        flat(rivers[self.main].stations[station][self.side])
    }

    /// The first (0) or the last (1) level line of the other river, if its corner is at a station.
    fn end_of_main(&self, rivers: &[River], station: usize) -> Option<usize> {
        let site_of_end = |end: usize| self.site(rivers, rivers[self.main].station_of_end(end));
        (0..2).find(|end| self.site(rivers, station) == site_of_end(*end))
    }

    /// The stations of the other river that the end follows, from left to right; where the way
    /// along the bank is too long, and where only one corner is on it, just those at corners.
    fn stations_along(&self, rivers: &[River]) -> Vec<usize> {
        let [Some(left), Some(right)] = self.stations else {
            return self.stations.into_iter().flatten().collect();
        };
        let mut along: Vec<usize> = if left <= right {
            (left..=right).collect()
        } else {
            (right..=left).rev().collect()
        };
        along.dedup_by_key(|station| key(self.site(rivers, *station)));
        let line: Vec<[f64; 3]> = along
            .iter()
            .map(|station| rivers[self.main].stations[*station][self.side])
            .collect();
        if is_detour(&line) {
            vec![left, right]
        } else {
            along
        }
    }
}

/// How many times as long as the straight way between its ends a bank may be that an end follows.
const LONGEST_DETOUR: f64 = 2.0;

/// Returns true if a line is so long that what lies between it and the straight way is land: the
/// bank around a meander, for one, whose neck is as wide as the river that ends there.
fn is_detour(line: &[[f64; 3]]) -> bool {
    let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    length > LONGEST_DETOUR * distance(line[0], line[line.len() - 1])
}

//! Lakes that meet are one water.

use super::flat::Flat;
use crate::terrain::groups::Groups;
use crate::terrain::regions::Domain;

/// The height of each lake, where some meet.
pub(crate) struct LakeLevels {
    /// By the numbers of waters; what it is for a river does not matter.
    levels: Vec<f64>,
    /// The lakes that have the height of another one.
    pub(crate) joined: Vec<JoinedLake>,
}

/// A lake that has the height of a larger one, which it meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JoinedLake {
    /// The number of its first line.
    pub line: usize,
    /// The number of the first line of the larger one.
    pub to: usize,
    /// How far its height was moved.
    pub by: f64,
}

impl LakeLevels {
    /// Finds lakes that meet, given the areas around each vertex. Those whose heights differ by no
    /// more than the tolerances of both have the height of the largest of them.
    ///
    /// `waters` has each lake with the number of its first line, and `None` for rivers.
    pub(crate) fn new<'a>(
        waters: &[Option<(&Flat, usize)>],
        meetings: impl Iterator<Item = &'a [Domain]>,
    ) -> Self {
        let lake = |area: Domain| waters[area].map(|(flat, _)| flat);
        let line = |area: Domain| waters[area].map_or(0, |(_, line)| line);
        let is_within = |a: &Flat, b: &Flat| {
            (a.height() - b.height()).abs() <= a.tolerance().min(b.tolerance())
        };
        let mut groups = Groups::default();
        waters.iter().for_each(|_| _ = groups.add());
        for areas in meetings {
            let mut lakes = areas.iter().filter_map(|&area| Some((area, lake(area)?)));
            let Some((first, flat)) = lakes.next() else {
                continue;
            };
            lakes
                .filter(|(_, other)| is_within(flat, other))
                .for_each(|(other, _)| groups.join(first as u32, other as u32));
        }
        let mut largest: Vec<Option<Domain>> = vec![None; waters.len()];
        let rank = |area: Domain| lake(area).map(|flat| (flat.area(), -flat.height()));
        for area in (0..waters.len()).filter(|&area| lake(area).is_some()) {
            let of_group = &mut largest[groups.find(area as u32) as usize];
            if of_group.is_none_or(|other| rank(area) > rank(other)) {
                *of_group = Some(area);
            }
        }
        let mut found = LakeLevels {
            levels: Vec::with_capacity(waters.len()),
            joined: Vec::new(),
        };
        for area in 0..waters.len() {
            let own = lake(area).map_or(f64::NAN, Flat::height);
            let to = largest[groups.find(area as u32) as usize].unwrap_or(area);
            let level = match (lake(area), lake(to)) {
                (Some(flat), Some(larger)) if is_within(flat, larger) => larger.height(),
                _ => own,
            };
            found.levels.push(level);
            if level != own && !own.is_nan() {
                found.joined.push(JoinedLake {
                    line: line(area),
                    to: line(to),
                    by: (level - own).abs(),
                });
            }
        }
        found
    }

    /// Returns the height of a lake.
    pub(crate) fn of(&self, area: Domain) -> f64 {
        self.levels[area]
    }
}

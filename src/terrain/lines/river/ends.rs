//! Ends of rivers: level lines that may follow the bank of another river, and the stretches there.

use super::River;
use super::divided::divided;
use super::segments::meeting_of;
use super::sites::{flat, key};
use crate::terrain::nearest::squared_distance;

impl River {
    /// The number of the first (0) or the last (1) stretch.
    pub(super) fn stretch_of_end(&self, end: usize) -> usize {
        if end == 0 {
            0
        } else {
            self.stretch_count() - 1
        }
    }

    /// The number of the first (0) or the last (1) station.
    pub(super) fn station_of_end(&self, end: usize) -> usize {
        if end == 0 { 0 } else { self.stations.len() - 1 }
    }

    /// The first (0) or the last (1) level line.
    pub(super) fn end_line(&self, end: usize) -> [[f64; 3]; 2] {
        self.stations[self.station_of_end(end)]
    }

    /// The border of a stretch: four corners, and more where an end follows the bank of another
    /// river.
    pub(super) fn outline(&self, stretch: usize) -> Vec<[f64; 3]> {
        let [a, b, c, d] = self.corners(stretch);
        let inner = |is_there: bool, end: usize| if is_there { self.along_bank(end) } else { &[] };
        let first = inner(stretch == 0, 0).iter().copied();
        let last = inner(stretch + 1 == self.stretch_count(), 1)
            .iter()
            .rev()
            .copied();
        [a].into_iter()
            .chain(first)
            .chain([b, d])
            .chain(last)
            .chain([c])
            .collect()
    }

    /// Divides the first and the last stretch into triangles, if ends follow banks.
    pub(super) fn divide_ends(&mut self) {
        self.end_triangles = [0, 1].map(|end| {
            let outline = self.outline(self.stretch_of_end(end));
            if outline.len() > 4 {
                divided(&outline)
            } else {
                None
            }
        });
    }

    /// Returns true if the stretch at the first (0) or the last (1) level line is bounded by a line
    /// that does not meet itself; one of four corners counts as such.
    pub(super) fn is_simple_at(&self, end: usize) -> bool {
        let outline = self.outline(self.stretch_of_end(end));
        outline.len() == 4 || meeting_of(outline).is_none()
    }

    /// The vertices between the ends of the first (0) or the last (1) level line on the bank of
    /// another river.
    pub(super) fn along_bank(&self, end: usize) -> &[[f64; 3]] {
        self.along_banks[end].as_deref().unwrap_or_default()
    }

    /// Returns true if one of two rivers ends where the other one begins or ends, and a position is
    /// on the level line there, or no farther from it than a distance.
    pub(crate) fn goes_on_at(&self, other: &River, q: [f64; 2], distance: f64) -> bool {
        let mouths = [[0, 1], [1, 0], [1, 1]].into_iter();
        let mut common = mouths.filter(|[own, end]| key(self.ends[*own]) == key(other.ends[*end]));
        let is_on =
            |line: [[f64; 3]; 2]| squared_distance(line.map(flat), q) <= distance * distance;
        common.any(|[own, end]| is_on(self.end_line(own)) || is_on(other.end_line(end)))
    }

    /// The side on which two level lines meet in one vertex; `None` if they do not, or one does not
    /// exist.
    pub(super) fn meeting_side(&self, station: usize, other: usize) -> Option<usize> {
        let [line, other] = [self.stations.get(station)?, self.stations.get(other)?];
        (0..2).find(|&side| flat(line[side]) == flat(other[side]))
    }

    /// The level lines that meet the first (0) or the last (1) one, or one that does, in order from
    /// there: station, and the side on which it meets the one before.
    pub(super) fn met_at_end(&self, end: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        let beside = move |[station, _]: &[usize; 2]| {
            let next = if end == 0 {
                station + 1
            } else {
                station.checked_sub(1)?
            };
            Some([next, self.meeting_side(*station, next)?])
        };
        std::iter::successors(Some([self.station_of_end(end), 0]), beside).skip(1)
    }

    /// Lets the first (0) or the last (1) level line follow the bank of another river, from left to
    /// right, with its heights. Level lines that meet it get the height of the vertex.
    pub(super) fn set_end_line(&mut self, end: usize, line: Vec<[f64; 3]>) {
        let [left, inner @ .., right] = line.as_slice() else {
            return;
        };
        let mut before = self.station_of_end(end);
        self.stations[before] = [*left, *right];
        let is_along = !inner.is_empty() || left[2] != right[2];
        self.along_banks[end] = is_along.then(|| inner.to_vec());
        for [station, side] in self.met_at_end(end).collect::<Vec<_>>() {
            let level = self.stations[before][side][2];
            self.stations[station]
                .iter_mut()
                .for_each(|corner| corner[2] = level);
            before = station;
        }
    }
}

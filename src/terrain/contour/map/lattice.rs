//! The lattice: lines are smoothed and simplified in its cells.

use super::corridor::Corridor;
use super::room::Cell;
use super::strand::Strand;
use crate::terrain::in_order::in_order;
use crate::terrain::walk::{At, Locator};

/// Square cells in plan, from a coordinate on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// The side of a cell.
    pub(super) size: f64,
    pub(super) origin: f64,
    /// Where a ring begins that nothing else fixes.
    pub(super) start: RingStart,
}

/// Which point of a ring stays, if the ring lies inside of a cell and meets nothing.
#[derive(Debug, Clone, Copy)]
pub(super) enum RingStart {
    /// The point with the smallest coordinates.
    Least,
    /// The point with the largest coordinates.
    Greatest,
}

/// A line, with where on the surface its points are.
#[derive(Debug, Clone)]
pub(super) struct Tracked {
    /// The index of its level.
    pub(super) level: usize,
    /// The points; a ring repeats its first one at the end.
    pub(super) points: Vec<[f64; 2]>,
    /// Where each point is, as seen from the segment before it and from the one after it.
    pub(super) at: Vec<[At; 2]>,
}

impl Tracked {
    fn is_ring(&self) -> bool {
        self.points.len() > 2 && self.points.first() == self.points.last()
    }

    /// Joins strands, in order.
    pub(super) fn joined(level: usize, strands: &[Strand]) -> Self {
        let mut line = Tracked {
            level,
            points: Vec::new(),
            at: Vec::new(),
        };
        for strand in strands {
            let starts_at = line.at.pop().map(|[before, _]| before);
            line.points.pop();
            line.points.extend_from_slice(&strand.points);
            line.at.extend(strand.at.iter().map(|&at| [at; 2]));
            if let Some(before) = starts_at {
                let joint = line.points.len() - strand.points.len();
                line.at[joint][0] = before;
            }
        }
        if line.is_ring() {
            let last = line.at.len() - 1;
            let both = [line.at[last][0], line.at[0][1]];
            (line.at[0], line.at[last]) = (both, both);
        }
        line
    }
}

impl Lattice {
    /// Returns the coordinate of a line of the lattice.
    fn line(&self, number: i64) -> f64 {
        self.origin + number as f64 * self.size
    }

    /// Returns the number of the last line at a coordinate or below.
    fn number(&self, coordinate: f64) -> i64 {
        let mut number = ((coordinate - self.origin) / self.size).floor() as i64;
        while coordinate < self.line(number) {
            number -= 1;
        }
        while coordinate >= self.line(number + 1) {
            number += 1;
        }
        number
    }

    fn is_on_line(&self, point: [f64; 2]) -> bool {
        point.into_iter().any(|c| c == self.line(self.number(c)))
    }

    /// Returns the numbers of the cell that a strand is in.
    pub(super) fn cell_of(&self, strand: &Strand) -> [i64; 2] {
        let points = &strand.points;
        let inner = match points.len() {
            0..=2 => {
                [0, 1].map(|axis| 0.5 * points[0][axis] + 0.5 * points[points.len() - 1][axis])
            }
            _ => points[1],
        };
        inner.map(|c| self.number(c))
    }

    /// Returns a cell by its numbers.
    pub(super) fn cell(&self, numbers: [i64; 2]) -> Cell {
        Cell {
            low: numbers.map(|n| self.line(n)),
            high: numbers.map(|n| self.line(n + 1)),
        }
    }

    /// Returns the points at which a segment crosses lines of the lattice, besides its ends, in
    /// order. The same in both directions.
    fn crossings(&self, [a, b]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        let mut found = Vec::new();
        for axis in 0..2 {
            let [low, high] = if a[axis] < b[axis] { [a, b] } else { [b, a] };
            for number in self.number(low[axis]) + 1..=self.number(high[axis]) {
                let line = self.line(number);
                if line == high[axis] {
                    continue;
                }
                let part = (line - low[axis]) / (high[axis] - low[axis]);
                let other = 1 - axis;
                let mut point = [line; 2];
                let rounded = low[other] + part * (high[other] - low[other]);
                let [least, most] = [a[other].min(b[other]), a[other].max(b[other])];
                point[other] = rounded.max(least).min(most);
                found.push(point);
            }
        }
        let along = |p: &[f64; 2]| (p[0] - a[0]).abs() + (p[1] - a[1]).abs();
        found.sort_by(|p, q| along(p).total_cmp(&along(q)));
        found.dedup();
        found.retain(|&point| point != a && point != b);
        found
    }

    /// Cuts a line into strands: at the lattice, at its ends and its anchors.
    pub(super) fn cut(
        &self,
        number: u32,
        line: &Tracked,
        corridor: &Corridor<'_>,
        locator: &Locator<'_>,
    ) -> Vec<Strand> {
        let is_ring = line.is_ring();
        let mut points = Vec::with_capacity(line.points.len());
        let mut at = Vec::with_capacity(line.points.len());
        let mut is_fixed = Vec::with_capacity(line.points.len());
        for (i, &point) in line.points.iter().enumerate() {
            points.push(point);
            at.push(line.at[i]);
            is_fixed.push(corridor.is_anchor(point) || self.is_on_line(point));
            let Some(&next) = line.points.get(i + 1) else {
                break;
            };
            for cut in self.crossings([point, next]) {
                points.push(cut);
                at.push([locator.at(cut); 2]);
                is_fixed.push(true);
            }
        }
        if is_ring {
            points.pop();
            at.pop();
            is_fixed.pop();
            let start = is_fixed.iter().position(|&is| is).or_else(|| {
                let by_point = |&i: &usize, &k: &usize| in_order(&points[i], &points[k]);
                match self.start {
                    RingStart::Least => (0..points.len()).min_by(by_point),
                    RingStart::Greatest => (0..points.len()).max_by(by_point),
                }
            });
            let start = start.unwrap_or(0);
            points.rotate_left(start);
            at.rotate_left(start);
            is_fixed.rotate_left(start);
            points.extend_from_within(..1);
            at.extend_from_within(..1);
            is_fixed.extend_from_within(..1);
        }
        let last = points.len() - 1;
        (is_fixed[0], is_fixed[last]) = (true, true);
        let ends: Vec<usize> = (0..=last).filter(|&i| is_fixed[i]).collect();
        let strand = |(k, ends): (usize, &[usize])| {
            let range = ends[0]..=ends[1];
            // The last point as seen from the segment before it.
            let from_inside = at[ends[0]..ends[1]].iter().map(|&[_, after]| after);
            Strand {
                line: number,
                number: k as u32,
                points: points[range].to_vec(),
                at: from_inside.chain([at[ends[1]][0]]).collect(),
            }
        };
        ends.windows(2).enumerate().map(strand).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(origin: f64) -> Lattice {
        Lattice {
            size: 64.0,
            origin,
            start: RingStart::Least,
        }
    }

    #[test]
    fn crossings_are_the_same_in_both_directions() {
        for origin in [0.0, 32.0] {
            let lattice = lattice(origin);
            let ends = [[-70.3, 5.1], [200.7, 130.2]];
            let mut found = lattice.crossings(ends);
            assert_eq!(found.len(), if origin == 0.0 { 7 } else { 6 });
            found.reverse();
            assert_eq!(found, lattice.crossings([ends[1], ends[0]]));
            assert!(found.iter().all(|&point| lattice.is_on_line(point)));
        }
    }

    #[test]
    fn segments_along_the_lattice_are_not_cut_again() {
        let lattice = lattice(0.0);
        assert!(lattice.crossings([[64.0, 1.0], [64.0, 60.0]]).is_empty());
        assert_eq!(
            lattice.crossings([[64.0, 1.0], [64.0, 70.0]]),
            [[64.0, 64.0]]
        );
        assert!(lattice.crossings([[10.0, 1.0], [64.0, 60.0]]).is_empty());
        assert_eq!(
            lattice.crossings([[0.0, 0.0], [128.0, 128.0]]),
            [[64.0, 64.0]]
        );
    }

    #[test]
    fn lines_are_put_together_as_they_were() {
        let points: Vec<[f64; 2]> = [[1.0, 1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 1.0]].to_vec();
        let strand = |number: u32, range: std::ops::RangeInclusive<usize>| Strand {
            line: 0,
            number,
            at: vec![At::Inside { face: number }; range.clone().count()],
            points: points[range].to_vec(),
        };
        let line = Tracked::joined(3, &[strand(0, 0..=1), strand(1, 1..=3)]);
        assert_eq!((line.level, &line.points), (3, &points));
        let faces = |i: usize| line.at[i].map(|at| at == At::Inside { face: 0 });
        assert_eq!(faces(1), [true, false]);
        assert_eq!([faces(0), faces(3)], [[false, true]; 2]);
    }
}

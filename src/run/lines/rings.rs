//! Joining lines to rings: a boundary may consist of several lines.

use std::collections::HashMap;

use crate::error::Error;
use crate::run::context::units::neat;
use crate::triangulation::num::unsigned_zero;

/// A point whose coordinates are compared bit by bit.
type Key = [u64; 2];

/// An end of a line at which no other line continues.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gap {
    /// The position of the line that ends there.
    pub(crate) line: usize,
    end: [f64; 2],
    /// The nearest other end at which no line continues.
    nearest: Option<[f64; 2]>,
}

/// A ring of lines.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ring {
    /// The position of its first line.
    pub(crate) line: usize,
    /// Its points; the last is the first.
    pub(crate) points: Vec<[f64; 2]>,
}

/// Joins lines that meet end to end, in exactly the same point, to rings. If more than two meet,
/// any two can be joined: by the even-odd rule all choices bound the same area.
///
/// # Errors
/// If an end of a line meets no other.
///
/// # Complexity
/// Linear.
pub(crate) fn close(lines: &[Vec<[f64; 2]>]) -> Result<Vec<Ring>, Gap> {
    let flat: Vec<Vec<[f64; 2]>> = lines
        .iter()
        .map(|line| {
            line.iter()
                .map(|p| [unsigned_zero(p[0]), unsigned_zero(p[1])])
                .collect()
        })
        .collect();
    let mut at: HashMap<Key, Vec<usize>> = HashMap::new();
    for (number, line) in flat.iter().enumerate() {
        for end in ends(line) {
            at.entry(key(end)).or_default().push(number);
        }
    }
    let is_loose = |end: &[f64; 2]| at.get(&key(*end)).is_some_and(|lines| lines.len() % 2 == 1);
    let mut loose = flat
        .iter()
        .enumerate()
        .flat_map(|(line, points)| ends(points).map(move |end| (line, end)));
    if let Some((line, end)) = loose.find(|(_, end)| is_loose(end)) {
        let others = flat
            .iter()
            .flat_map(|line| ends(line))
            .filter(|other| is_loose(other) && *other != end);
        let nearest = others.min_by(|p, q| distance(end, *p).total_cmp(&distance(end, *q)));
        return Err(Gap { line, end, nearest });
    }

    // Every point has an even number of ends, so following lines while there are any leads back to
    // the start.
    let mut used = vec![false; flat.len()];
    let mut rings = Vec::new();
    for first in 0..flat.len() {
        if std::mem::replace(&mut used[first], true) {
            continue;
        }
        let mut ring = flat[first].clone();
        while let Some(here) = ring.last().copied().filter(|last| *last != flat[first][0]) {
            let Some(next) = at.get_mut(&key(here)).and_then(Vec::pop) else {
                break;
            };
            if std::mem::replace(&mut used[next], true) {
                continue;
            }
            match flat[next][0] == here {
                true => ring.extend(&flat[next][1..]),
                false => ring.extend(flat[next].iter().rev().skip(1)),
            }
        }
        rings.push(Ring {
            line: first,
            points: ring,
        });
    }
    Ok(rings)
}

fn ends(line: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> {
    line.first()
        .copied()
        .into_iter()
        .chain(line.last().copied())
}

fn key(p: [f64; 2]) -> Key {
    p.map(f64::to_bits)
}

fn distance([x, y]: [f64; 2], p: [f64; 2]) -> f64 {
    (p[0] - x).hypot(p[1] - y)
}

impl Gap {
    /// Returns the error, which names both ends and the distance between them.
    #[cold]
    pub(crate) fn error(self) -> Error {
        let [x, y] = self.end;
        let far = |p| neat(distance(self.end, p));
        let next = self.nearest.map(|p| {
            format!(
                ", the next loose end is {} away, at {} {}",
                far(p),
                p[0],
                p[1]
            )
        });
        Error::format(format!(
            "the lines are not closed: one ends at {x} {y}{}",
            next.unwrap_or_default()
        ))
        .cure("close the gap, so that lines end where others begin, or use polygons")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rings(lines: &[&[[f64; 2]]]) -> Result<Vec<Vec<[f64; 2]>>, Gap> {
        let rings = close(&lines.iter().map(|line| line.to_vec()).collect::<Vec<_>>())?;
        Ok(rings.into_iter().map(|ring| ring.points).collect())
    }

    #[test]
    fn lines_in_any_order_and_direction_make_rings() {
        let [a, b, c, d] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        assert_eq!(
            rings(&[&[a, b, c], &[a, d], &[c, d]]).unwrap(),
            [vec![a, b, c, d, a]]
        );
        let hole = [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [1.0, 1.0]];
        assert_eq!(
            rings(&[&hole, &[a, b, c], &[c, [-0.0, 0.0]]]).unwrap(),
            [hole.to_vec(), vec![a, b, c, a]]
        );
    }

    #[test]
    fn where_four_meet_all_lines_are_used_once() {
        let [a, b, c, d, m] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [2.0, 2.0]];
        let rings = rings(&[&[m, a], &[b, m], &[a, b], &[m, c], &[d, m], &[c, d]]).unwrap();
        assert_eq!(rings.iter().map(|ring| ring.len() - 1).sum::<usize>(), 6);
        assert!(rings.iter().all(|ring| ring.first() == ring.last()));
    }

    #[test]
    fn a_gap_is_reported_with_both_ends_and_its_width() {
        let error = rings(&[
            &[[0.0, 0.0], [4.0, 0.0]],
            &[[4.0, 0.5], [0.0, 4.0]],
            &[[0.0, 4.0], [0.0, 0.0]],
        ]);
        assert_eq!(
            error.unwrap_err().error().to_string(),
            "the lines are not closed: one ends at 4 0, the next loose end is 0.5 away, at 4 0.5"
        );
        let three = rings(&[
            &[[0.0, 0.0], [1.0, 0.0]],
            &[[0.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [-1.0, 0.0]],
        ]);
        assert!(
            three
                .unwrap_err()
                .error()
                .to_string()
                .contains("ends at 0 0, the next loose end is 1 away, at 1 0")
        );
    }
}

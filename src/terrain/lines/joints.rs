//! Where lines with a side meet: which line goes on on that side.

use std::cmp::Ordering;

use rustc_hash::FxHashMap;

use crate::terrain::linear::turn;
use crate::triangulation::num::{Sign, unsigned_zero};

/// A segment of a line at one of its vertices.
///
/// ```text
///              |  arriving: its right side is on the left, seen from the vertex
///              v
///              + ---->  leaving
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arm {
    vertex: [f64; 2],
    /// Its other end.
    away: [f64; 2],
    leaves: bool,
}

/// Returns, for each line, the vertices before and after it on the lines that it meets at its ends.
///
/// That is the next segment on its right side, by angle around the end. If the right side of that
/// one is on its other side, it counts only if it is nearer than half a turn. A line that ends
/// where it begins has none.
///
/// # Complexity
/// O(n) for n vertices, if few lines meet at one of them.
pub(super) fn neighbors(lines: &[Vec<[f64; 2]>]) -> Vec<[Option<[f64; 2]>; 2]> {
    let ends: Vec<[Option<Arm>; 2]> = lines.iter().map(|line| ends(line)).collect();
    let mut arms: FxHashMap<[u64; 2], Vec<Arm>> = ends
        .iter()
        .flatten()
        .flatten()
        .map(|arm| (key(arm.vertex), Vec::new()))
        .collect();
    for pair in lines
        .iter()
        .flat_map(|line| line.windows(2))
        .filter(|pair| key(pair[0]) != key(pair[1]))
    {
        let leaving = Arm {
            vertex: pair[0],
            away: pair[1],
            leaves: true,
        };
        let arriving = Arm {
            vertex: pair[1],
            away: pair[0],
            leaves: false,
        };
        for arm in [leaving, arriving] {
            if let Some(arms) = arms.get_mut(&key(arm.vertex)) {
                arms.push(arm);
            }
        }
    }
    let next = |arm: Arm| arm.next(arms.get(&key(arm.vertex))?);
    ends.into_iter()
        .map(|ends| ends.map(|end| end.and_then(next)))
        .collect()
}

/// The first and the last segment of a line that does not end where it begins.
fn ends(line: &[[f64; 2]]) -> [Option<Arm>; 2] {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return [None; 2];
    };
    if key(first) == key(last) {
        return [None; 2];
    }
    let second = line.iter().find(|p| key(**p) != key(first));
    let last_but_one = line.iter().rev().find(|p| key(**p) != key(last));
    [
        second.map(|&away| Arm {
            vertex: first,
            away,
            leaves: true,
        }),
        last_but_one.map(|&away| Arm {
            vertex: last,
            away,
            leaves: false,
        }),
    ]
}

/// Returns what two equal sites share.
fn key(site: [f64; 2]) -> [u64; 2] {
    site.map(|c| unsigned_zero(c).to_bits())
}

/// How far it is from one arm to another around their vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Turn {
    LessThanHalf,
    Half,
    MoreThanHalf,
    Full,
}

impl Arm {
    /// The other end of the segment that comes next on the right side of the line.
    fn next(self, arms: &[Arm]) -> Option<[f64; 2]> {
        let faces = |other: &Arm| other.leaves != self.leaves;
        let others = arms
            .iter()
            .filter(|other| faces(other) || self.turn_to(other) != Turn::Full);
        // Of arms in one direction, one that is continued; all of these are equal but for rounding.
        let order = |p: &&Arm, q: &&Arm| {
            let by_angle = self
                .turn_to(p)
                .cmp(&self.turn_to(q))
                .then_with(|| self.by_angle(p, q));
            let by_site = || {
                p.away[0]
                    .total_cmp(&q.away[0])
                    .then(p.away[1].total_cmp(&q.away[1]))
            };
            by_angle
                .then_with(|| faces(q).cmp(&faces(p)))
                .then_with(by_site)
        };
        let next = others.min_by(order)?;
        (faces(next) || self.turn_to(next) == Turn::LessThanHalf).then_some(next.away)
    }

    /// How far it is to another arm: clockwise if this one leaves the vertex, otherwise
    /// counter-clockwise.
    fn turn_to(self, other: &Arm) -> Turn {
        match self.side(self.away, other.away) {
            Sign::Positive => Turn::LessThanHalf,
            Sign::Negative => Turn::MoreThanHalf,
            Sign::Zero => {
                let is_same = |k: usize| {
                    let of = |away: [f64; 2]| away[k].partial_cmp(&self.vertex[k]);
                    of(self.away) == of(other.away)
                };
                if is_same(0) && is_same(1) {
                    Turn::Full
                } else {
                    Turn::Half
                }
            }
        }
    }

    /// The order of two arms that are both on one side.
    fn by_angle(self, p: &Arm, q: &Arm) -> Ordering {
        match self.side(p.away, q.away) {
            Sign::Positive => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Greater,
        }
    }

    /// Positive if one goes from one direction to another by less than half a turn: clockwise if
    /// this arm leaves the vertex, otherwise counter-clockwise.
    fn side(self, from: [f64; 2], to: [f64; 2]) -> Sign {
        let [from, to] = if self.leaves { [to, from] } else { [from, to] };
        turn(self.vertex, from, to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The neighbors of lines, which are not changed by the order of the lines.
    fn found(lines: &[&[[f64; 2]]]) -> Vec<[Option<[f64; 2]>; 2]> {
        let mut lines: Vec<Vec<[f64; 2]>> = lines.iter().map(|line| line.to_vec()).collect();
        let found = neighbors(&lines);
        lines.reverse();
        assert!(neighbors(&lines).iter().rev().eq(&found));
        found
    }

    const O: [f64; 2] = [0.0, 0.0];
    const EAST: [f64; 2] = [5.0, 0.0];
    const NORTH: [f64; 2] = [0.0, 5.0];
    const WEST: [f64; 2] = [-5.0, 0.0];
    const SOUTH: [f64; 2] = [0.0, -5.0];

    #[test]
    fn two_lines_continue_each_other_at_any_angle() {
        for to in [
            EAST,
            NORTH,
            SOUTH,
            [-5.0, 1e-300],
            [-5.0, -1e-300],
            [-4.0, 0.0],
        ] {
            assert_eq!(
                found(&[&[WEST, O], &[[-0.0, 0.0], to]]),
                [[None, Some(to)], [Some(WEST), None]],
                "{to:?}"
            );
        }
        // Both ways: each is before and after the other.
        assert_eq!(
            found(&[&[WEST, O, O], &[O, O, WEST]]),
            [[Some(O), Some(WEST)], [Some(WEST), Some(O)]]
        );
    }

    #[test]
    fn lines_that_are_drawn_against_each_other_end_short_of_each_other() {
        // Their right sides: south of the first, west of the second.
        assert_eq!(
            found(&[&[WEST, O], &[NORTH, O]]),
            [[None, None], [None, Some(WEST)]]
        );
        assert_eq!(
            found(&[&[WEST, O], &[SOUTH, O]]),
            [[None, Some(SOUTH)], [None, None]]
        );
        assert_eq!(
            found(&[&[O, WEST], &[O, NORTH]]),
            [[Some(NORTH), None], [None, None]]
        );
        assert_eq!(
            found(&[&[WEST, O], &[EAST, O]]),
            [[None, None], [None, None]]
        );
        // The same line twice.
        assert_eq!(
            found(&[&[WEST, O], &[WEST, O]]),
            [[None, None], [None, None]]
        );
    }

    #[test]
    fn of_several_lines_the_next_by_angle_counts() {
        let three = found(&[&[WEST, O], &[O, EAST], &[O, SOUTH]]);
        assert_eq!(
            three,
            [[None, Some(SOUTH)], [Some(SOUTH), None], [Some(WEST), None]]
        );
        // A line that passes, and one that ends on it.
        assert_eq!(
            found(&[&[WEST, O, EAST], &[SOUTH, O]]),
            [[None, None], [None, Some(EAST)]]
        );
        // A ring that begins there.
        let ring = [O, EAST, NORTH, O];
        assert_eq!(
            found(&[&ring, &[WEST, O]]),
            [[None, None], [None, Some(EAST)]]
        );
        // A wall with two sides, and a third.
        let four = found(&[&[WEST, O], &[O, WEST], &[O, EAST]]);
        assert_eq!(
            four,
            [[Some(O), Some(EAST)], [None, Some(O)], [Some(WEST), None]]
        );
    }
}

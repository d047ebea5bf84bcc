//! Lines beside a ring, no farther from it than a distance.

use crate::terrain::linear::turn;
use crate::terrain::lines::offset::normal;
use crate::triangulation::num::Sign;

/// A straight part of a line beside a ring.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    pub(super) ends: [[f64; 2]; 2],
    /// The side of the ring that it is beside, or twice the corner that it passes around.
    pub(super) side: [[f64; 2]; 2],
}

/// The largest angle between two vertices around a corner.
const ARC: f64 = std::f64::consts::FRAC_PI_4;

/// Turns by less are no corners: a miter is farther than the distance by 1e-9 of it there.
const STRAIGHT: f64 = 1e-4;

/// Returns what is beside the sides of a ring that are wanted, at a distance on both sides.
///
/// Around corners it is rounded. Inside of corners it ends where both sides meet, or else, where
/// sides are too short for that, it crosses itself.
///
/// # Complexity
/// Linear.
pub(super) fn beside(
    ring: &[[f64; 2]],
    distance: f64,
    is_wanted: impl Fn([[f64; 2]; 2]) -> bool,
) -> Vec<Beside> {
    let mut ring = ring.to_vec();
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let count = ring.len();
    let mut found = Vec::new();
    if count < 2 {
        return found;
    }
    for first in 0..count {
        let [before, from, to, after] = [count - 1, 0, 1, 2].map(|k| ring[(first + k) % count]);
        if !is_wanted([from, to]) {
            continue;
        }
        for by in [distance, -distance] {
            let normal = normal([from, to]);
            let [start, end] =
                [[before, from, to], [from, to, after]].map(|corner| Corner::new(corner, by));
            let ends = [start.point(from, normal, by), end.point(to, normal, by)];
            found.push(Beside {
                ends,
                side: [from, to],
            });
            if let Corner::Round { angle } = end {
                let parts = (angle.abs() / ARC).ceil().max(1.0);
                let at = |k: f64| beyond(to, turned(normal, angle * k / parts), by);
                let last = beyond(to, self::normal([to, after]), by);
                let inner = (1..parts as usize).map(|k| at(k as f64));
                let arc: Vec<[f64; 2]> = [ends[1]].into_iter().chain(inner).chain([last]).collect();
                found.extend(arc.windows(2).map(|pair| Beside {
                    ends: [pair[0], pair[1]],
                    side: [to; 2],
                }));
            }
        }
    }
    found
}

/// How a line beside two sides passes the corner between them.
#[derive(Debug, Clone, Copy)]
enum Corner {
    /// Through a point.
    Miter([f64; 2]),
    /// Around it, turning by an angle.
    Round { angle: f64 },
    /// The lines beside both sides end at the corner, and may cross.
    Open,
}

impl Corner {
    fn new([before, at, after]: [[f64; 2]; 3], by: f64) -> Self {
        let [first, second] = [normal([before, at]), normal([at, after])];
        let sine = first[0] * second[1] - first[1] * second[0];
        let cosine = first[0] * second[0] + first[1] * second[1];
        let angle = sine.atan2(cosine).abs();
        let turn = turn(before, at, after);
        let is_inside = turn
            == if by > 0.0 {
                Sign::Positive
            } else {
                Sign::Negative
            };
        // Along each side, the miter is that far from the corner.
        let reach = by.abs() * (angle / 2.0).tan();
        let is_long = [[before, at], [at, after]]
            .iter()
            .all(|[p, q]| reach <= (q[0] - p[0]).hypot(q[1] - p[1]) / 2.0);
        if angle <= STRAIGHT || is_inside && is_long {
            let scale = by / (1.0 + cosine);
            Corner::Miter([0, 1].map(|axis| at[axis] + scale * (first[axis] + second[axis])))
        } else if is_inside {
            Corner::Open
        } else {
            Corner::Round {
                angle: -by.signum() * angle,
            }
        }
    }

    /// Where the line beside one of the sides begins or ends.
    fn point(self, at: [f64; 2], normal: [f64; 2], by: f64) -> [f64; 2] {
        match self {
            Corner::Miter(point) => point,
            Corner::Round { .. } | Corner::Open => beyond(at, normal, by),
        }
    }
}

fn beyond(at: [f64; 2], normal: [f64; 2], by: f64) -> [f64; 2] {
    [0, 1].map(|axis| at[axis] + by * normal[axis])
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [x * cosine - y * sine, x * sine + y * cosine]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::nearest::squared_distance;

    /// Around any corner, the lines are no farther than the distance, and not much nearer outside.
    #[test]
    fn lines_around_a_corner_keep_their_distance() {
        for degrees in (-180..180).step_by(15) {
            let angle = f64::from(degrees).to_radians();
            let ring = [
                [-9.0, 0.0],
                [0.0, 0.0],
                [9.0 * angle.cos(), 9.0 * angle.sin()],
                [-20.0, -30.0],
            ];
            let sides = [[ring[0], ring[1]], [ring[1], ring[2]]];
            let lines = beside(&ring, 0.5, |[p, q]| sides.contains(&[p, q]));
            for p in lines
                .iter()
                .flat_map(|line| line.ends)
                .filter(|p| p[0].hypot(p[1]) < 4.0)
            {
                let near = sides
                    .map(|side| squared_distance(side, p).sqrt())
                    .into_iter()
                    .fold(9.0, f64::min);
                assert!((near - 0.5).abs() < 1e-9, "{degrees}: {p:?} is {near} away");
            }
        }
    }
}

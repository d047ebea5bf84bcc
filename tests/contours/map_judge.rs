//! A judge of contours for maps: all pairs of segments, and all segments with all triangles, in
//! exact arithmetic.

use std::collections::HashMap;

use breakline::data::{ContourLine, Surface};
use breakline::terrain::ContourLabel;
use dashu_ratio::RBig;

type Point = [f64; 2];
type Segment = [Point; 2];

fn exact(x: f64) -> RBig {
    RBig::try_from(x).unwrap()
}

/// Returns the sign of the area of a triangle: by doubles if they suffice, else without rounding.
pub(crate) fn side(a: Point, b: Point, c: Point) -> i32 {
    let products = [(b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])];
    let area = products[0] - products[1];
    if area.abs() > 1e-14 * (products[0].abs() + products[1].abs()) {
        return if area > 0.0 { 1 } else { -1 };
    }
    let [a, b, c] = [a, b, c].map(|p| p.map(exact));
    let left = (&b[0] - &a[0]) * (&c[1] - &a[1]);
    let right = (&b[1] - &a[1]) * (&c[0] - &a[0]);
    left.cmp(&right) as i32
}

fn are_apart(one: &[Point], other: &[Point]) -> bool {
    let least =
        |of: &[Point], axis: usize| of.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
    let most =
        |of: &[Point], axis: usize| of.iter().map(|p| p[axis]).fold(-f64::INFINITY, f64::max);
    (0..2).any(|axis| most(one, axis) < least(other, axis) || most(other, axis) < least(one, axis))
}

/// Returns true if two closed segments have a point in common.
pub(crate) fn meet([a, b]: Segment, [c, d]: Segment) -> bool {
    !are_apart(&[a, b], &[c, d])
        && side(a, b, c) * side(a, b, d) <= 0
        && side(c, d, a) * side(c, d, b) <= 0
}

/// Panics if two segments of lines have a point in common, besides the one at which a line goes
/// from one to the next.
pub(crate) fn check_crossings(lines: &[ContourLine]) {
    // The segments, with the number of their line, their own and that of the next.
    let mut segments: Vec<(Segment, usize, usize, usize)> = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let count = line.points.len() - 1;
        for (i, ends) in line.points.windows(2).enumerate() {
            assert_ne!(ends[0], ends[1], "a segment without length");
            let next = match i + 1 == count && line.is_closed() {
                true => 0,
                false => i + 1,
            };
            segments.push(([ends[0], ends[1]], number, i, next));
        }
    }
    segments.sort_by(|p, q| {
        p.0[0][0]
            .min(p.0[1][0])
            .total_cmp(&q.0[0][0].min(q.0[1][0]))
    });
    for (k, one) in segments.iter().enumerate() {
        let last = one.0[0][0].max(one.0[1][0]);
        let near =
            |other: &&(Segment, usize, usize, usize)| other.0[0][0].min(other.0[1][0]) <= last;
        for other in segments[k + 1..].iter().take_while(near) {
            if !meet(one.0, other.0) {
                continue;
            }
            let [before, after] = match (one.1 == other.1, one.3 == other.2, other.3 == one.2) {
                (true, true, _) => [one.0, other.0],
                (true, _, true) => [other.0, one.0],
                _ => panic!(
                    "lines {} and {} meet: {:?} {:?}",
                    one.1, other.1, one.0, other.0
                ),
            };
            // Neighbors have one point in common, unless one runs back over the other.
            let [[a, b], [_, c]] = [before, after];
            let runs_back = side(a, b, c) == 0
                && (0..2).any(|axis| (b[axis] - a[axis]) * (c[axis] - b[axis]) < 0.0);
            assert!(!runs_back, "a line runs back over itself at {b:?}");
        }
    }
}

/// All triangles of a surface, by the squares of a lattice that their boxes meet.
pub(crate) struct Ground {
    triangles: Vec<[[f64; 3]; 3]>,
    squares: HashMap<[i64; 2], Vec<usize>>,
    side: f64,
}

impl Ground {
    pub(crate) fn new(surface: &dyn Surface) -> Self {
        let triangles: Vec<[[f64; 3]; 3]> = (0..surface.face_count() as u32)
            .filter_map(|face| surface.triangle(face))
            .collect();
        let width = |t: &[[f64; 3]; 3]| (t[0][0] - t[1][0]).abs() + (t[0][0] - t[2][0]).abs();
        let side = 2.0 * triangles.iter().map(width).sum::<f64>() / triangles.len() as f64;
        let mut ground = Ground {
            triangles,
            squares: HashMap::new(),
            side,
        };
        for (number, triangle) in ground.triangles.iter().enumerate() {
            for square in ground.squares_of(&triangle.map(|p| [p[0], p[1]])) {
                ground.squares.entry(square).or_default().push(number);
            }
        }
        ground
    }

    fn squares_of(&self, points: &[Point]) -> Vec<[i64; 2]> {
        let [columns, rows] = [0, 1].map(|axis| {
            let numbers = points.iter().map(|p| (p[axis] / self.side).floor() as i64);
            let [least, most] = [numbers.clone().min(), numbers.max()].map(Option::unwrap);
            least..=most
        });
        let column = |x: i64| rows.clone().map(move |y| [x, y]);
        columns.flat_map(column).collect()
    }

    /// Returns the largest difference between the height of a line and the surface along it, exact
    /// but for a last rounding. The line may lie beyond the rim.
    pub(crate) fn deviation(&self, line: &ContourLine) -> f64 {
        let mut largest = exact(0.0);
        let mut known = 0.0;
        for ends in line.points.windows(2) {
            let squares = self.squares_of(ends);
            let near = squares.iter().filter_map(|square| self.squares.get(square));
            for &number in near.flatten() {
                let triangle = &self.triangles[number];
                let corners = triangle.map(|p| [p[0], p[1]]);
                let off = triangle.map(|p| (p[2] - line.level).abs());
                let may_be_larger = off.into_iter().fold(0.0, f64::max) > known;
                if may_be_larger && !are_apart(ends, &corners) {
                    let off = deviation_in(triangle, ends, line.level);
                    largest = off.filter(|off| *off > largest).unwrap_or(largest);
                    known = largest.to_f64().value().next_down();
                }
            }
        }
        largest.to_f64().value()
    }
}

/// The corners of the box of a label, with the first one at the end.
pub(crate) fn box_of(label: &ContourLabel) -> [Point; 5] {
    let (sin, cos) = label.rotation.to_radians().sin_cos();
    let [length, height] = label.size;
    [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, -1.0],
    ]
    .map(|[u, v]| {
        let [u, v] = [0.499 * length * u, 0.499 * height * v];
        [
            label.at[0] + u * cos - v * sin,
            label.at[1] + u * sin + v * cos,
        ]
    })
}

/// Returns true if the boxes of two labels have borders that meet.
pub(crate) fn boxes_meet(label: &ContourLabel, other: &ContourLabel) -> bool {
    let (own, beyond) = (box_of(label), box_of(other));
    own.windows(2).any(|side| {
        let mut others = beyond.windows(2);
        others.any(|other| meet([side[0], side[1]], [other[0], other[1]]))
    })
}

/// Returns the largest difference of heights along the part of a segment that is in a triangle.
fn deviation_in(triangle: &[[f64; 3]; 3], ends: &[Point], level: f64) -> Option<RBig> {
    let corners = triangle.map(|p| p.map(exact));
    let [p, q] = [ends[0], ends[1]].map(|p| p.map(exact));
    let area = |a: &[RBig], b: &[RBig], c: &[RBig]| {
        (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
    };
    let [zero, one] = [0.0, 1.0].map(exact);
    // Where each corner's share of the position is not negative.
    let (mut from, mut to) = (zero.clone(), one);
    let mut shares = Vec::new();
    for i in 0..3 {
        let [a, b] = [1, 2].map(|k| &corners[(i + k) % 3]);
        let [at_p, at_q] = [&p, &q].map(|at| area(a, b, at));
        let slope = &at_q - &at_p;
        if slope == zero {
            if at_p < zero {
                return None;
            }
        } else {
            let root = -&at_p / &slope;
            if slope > zero {
                from = from.max(root);
            } else {
                to = to.min(root);
            }
        }
        shares.push((at_p, slope));
    }
    if from > to {
        return None;
    }
    let whole = area(&corners[0], &corners[1], &corners[2]);
    let off = |t: &RBig| {
        let mut height = exact(0.0);
        for (corner, (at_p, slope)) in corners.iter().zip(&shares) {
            height += &corner[2] * (at_p + slope * t);
        }
        let off = height / &whole - exact(level);
        off.clone().max(-off)
    };
    Some(off(&from).max(off(&to)))
}

/// Panics unless polygons are valid: rings are simple, those of holes lie within the outer one, and
/// two meet in points at most.
pub(crate) fn check_polygon(rings: &[Vec<Point>]) {
    for (number, ring) in rings.iter().enumerate() {
        assert!(ring.len() > 3 && ring.first() == ring.last(), "{ring:?}");
        let area = doubled_area(ring);
        assert!(
            if number == 0 { area < 0.0 } else { area > 0.0 },
            "the direction of a ring"
        );
        let line = ContourLine {
            level: 0.0,
            points: ring.clone(),
        };
        check_crossings(&[line]);
        for other in &rings[..number] {
            check_touching(ring, other);
        }
        if number > 0 {
            let outer = &rings[0];
            let middle = |ends: &[Point]| [0, 1].map(|k| 0.5 * ends[0][k] + 0.5 * ends[1][k]);
            let inside = ring
                .windows(2)
                .filter(|ends| is_inside(outer, middle(ends)));
            assert_eq!(inside.count(), ring.len() - 1, "a hole outside");
        }
    }
}

/// Panics if two rings cross, or have more than a point in common.
fn check_touching(ring: &[Point], other: &[Point]) {
    for one in ring.windows(2) {
        for two in other.windows(2) {
            let [a, b] = [one[0], one[1]];
            let [c, d] = [two[0], two[1]];
            if meet([a, b], [c, d]) {
                let is_end = [a, b].into_iter().any(|p| p == c || p == d);
                let collinear = side(a, b, c) == 0 && side(a, b, d) == 0;
                let both = [a, b] == [c, d] || [a, b] == [d, c];
                assert!(
                    is_end && !both,
                    "rings meet at {a:?} {b:?} {c:?} {d:?} {collinear}"
                );
            }
        }
    }
}

/// Returns twice the area of a ring, relative to its first point.
pub(crate) fn doubled_area(ring: &[Point]) -> f64 {
    let [x, y] = ring[0];
    let sides = ring.windows(2);
    sides
        .map(|s| (s[0][0] - x) * (s[1][1] - y) - (s[1][0] - x) * (s[0][1] - y))
        .sum()
}

/// Returns true if a point is inside of a ring.
pub(crate) fn is_inside(ring: &[Point], point: Point) -> bool {
    let crossed = ring.windows(2).filter(|s| {
        (s[0][1] <= point[1]) != (s[1][1] <= point[1])
            && s[0][0] + (point[1] - s[0][1]) / (s[1][1] - s[0][1]) * (s[1][0] - s[0][0]) < point[0]
    });
    crossed.count() % 2 == 1
}

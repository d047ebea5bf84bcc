//! The expected contours, computed naively from the definition, in whole numbers.

use super::surface::Faces;
use breakline::data::ContourLine;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// Steps per unit of the lattice on which all crossings lie: coordinates and heights are whole
/// numbers, heights differ by at most 3, and levels are multiples of a half.
const LATTICE: i64 = 12;

pub(crate) type Point = [i64; 2];
pub(crate) type Segment = [Point; 2];

pub(crate) fn lattice_point(p: [f64; 2]) -> Point {
    p.map(|c| {
        let steps = (c * LATTICE as f64).round();
        assert!(
            (c * LATTICE as f64 - steps).abs() < 1e-9,
            "{c} is no multiple of 1/{LATTICE}"
        );
        steps as i64
    })
}

/// A coordinate that is off the lattice by less than a step of an `f64` at 5 000 000.
pub(crate) fn to_lattice(c: f64) -> f64 {
    let near = (c * LATTICE as f64).round() / LATTICE as f64;
    assert!((near - c).abs() < 1e-9, "{c} is no multiple of 1/{LATTICE}");
    near
}

/// The arcs of the contour at `half_level / 2`: the sum of the boundaries of the polygons
/// {height >= level} of all faces, without polygons of no area and without the edge of the data,
/// directed so that the polygons are on the right.
pub(crate) fn arcs(surface: &Faces, half_level: i64) -> Vec<Segment> {
    let mut sum = BTreeMap::<Segment, i64>::new();
    let mut sides = BTreeMap::<[u32; 2], i64>::new();
    for face in &surface.faces {
        for i in 0..3 {
            let mut side = [face[i], face[(i + 1) % 3]];
            side.sort_unstable();
            *sides.entry(side).or_default() += 1;
        }
    }
    for face in &surface.faces {
        let height = |v: u32| surface.vertices[v as usize][2] as i64 * 2 - half_level;
        let site = |v: u32| {
            lattice_point([
                surface.vertices[v as usize][0],
                surface.vertices[v as usize][1],
            ])
        };
        // Each vertex of the polygon with the side of the face that follows it.
        let mut polygon: Vec<(Point, usize)> = Vec::new();
        for i in 0..3 {
            let (a, b) = (face[i], face[(i + 1) % 3]);
            if height(a) >= 0 {
                polygon.push((site(a), i));
            }
            if height(a) * height(b) < 0 {
                let along = |k: usize| {
                    let (rise, run) = (height(b) - height(a), site(b)[k] - site(a)[k]);
                    assert_eq!(run * -height(a) % rise, 0);
                    site(a)[k] + run * -height(a) / rise
                };
                // Where heights fall, the next side is the new one through the face.
                polygon.push(([along(0), along(1)], if height(a) > 0 { 3 } else { i }));
            }
        }
        let area: i64 = (0..polygon.len())
            .map(|i| cross(polygon[i].0, polygon[(i + 1) % polygon.len()].0))
            .sum();
        assert!(area >= 0);
        if area == 0 {
            continue;
        }
        for i in 0..polygon.len() {
            let ((from, side), (to, _)) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            // From a corner on the level straight through the face.
            let on_side = side < 3 && is_between(to, site(face[side]), site(face[(side + 1) % 3]));
            if on_side {
                let mut side = [face[side], face[(side + 1) % 3]];
                side.sort_unstable();
                if sides[&side] == 1 {
                    continue;
                }
            }
            *sum.entry([to, from]).or_default() += 1;
            *sum.entry([from, to]).or_default() -= 1;
        }
    }
    sum.into_iter()
        .flat_map(|(segment, count)| std::iter::repeat_n(segment, count.max(0) as usize))
        .collect()
}

pub(crate) fn arcs_of(lines: &[ContourLine]) -> Vec<Segment> {
    let mut all: Vec<Segment> = lines
        .iter()
        .flat_map(|line| {
            line.points
                .windows(2)
                .map(|pair| [lattice_point(pair[0]), lattice_point(pair[1])])
        })
        .collect();
    all.sort_unstable();
    all
}

/// Checks how the lines of one level are joined; the arcs must be checked before.
pub(crate) fn check_lines(surface: &Faces, half_level: i64, lines: &[ContourLine]) {
    let segments = arcs_of(lines);
    let undirected: BTreeSet<Segment> = segments
        .iter()
        .map(|&[a, b]| [a.min(b), a.max(b)])
        .collect();
    assert_eq!(undirected.len(), segments.len(), "an arc occurs twice");
    for (i, &s) in segments.iter().enumerate() {
        assert_ne!(s[0], s[1], "an arc of no length");
        for &t in &segments[..i] {
            assert!(!cross_or_overlap(s, t), "{s:?} and {t:?} cross");
        }
    }
    let border = border(surface, half_level);
    let mut arrivals = BTreeMap::<Point, Vec<Passage>>::new();
    for line in lines {
        let points: Vec<Point> = line.points.iter().map(|&p| lattice_point(p)).collect();
        let closed = points.first() == points.last();
        assert_eq!(closed, line.is_closed());
        if closed {
            assert_eq!(
                points.iter().min(),
                points.first(),
                "a ring does not start at its smallest point"
            );
        } else {
            for end in [points[0], points[points.len() - 1]] {
                assert!(
                    border.contains(&end),
                    "a line ends at {end:?}, inside the data"
                );
            }
        }
        for i in 0..points.len() {
            let last = points.len() - 1;
            if closed && i == last {
                continue;
            }
            let before = if closed && i == 0 {
                Some(points[last - 1])
            } else {
                i.checked_sub(1).map(|i| points[i])
            };
            let after = points.get(i + 1).copied();
            arrivals.entry(points[i]).or_default().push((before, after));
        }
    }
    for (&node, passages) in &arrivals {
        check_turns(node, passages);
    }
}

/// The points before and after a point of a line.
type Passage = (Option<Point>, Option<Point>);

/// Checks that only whole pairs lie between an incoming ray and its outgoing one,
/// counter-clockwise, and that not both kinds are left over.
fn check_turns(node: Point, passages: &[Passage]) {
    let starts = passages
        .iter()
        .filter(|(before, _)| before.is_none())
        .count();
    let ends = passages.iter().filter(|(_, after)| after.is_none()).count();
    assert!(
        starts == 0 || ends == 0,
        "a line ends at {node:?} where another one begins"
    );
    for &(before, after) in passages {
        let (Some(before), Some(after)) = (before, after) else {
            continue;
        };
        let is_inside = |p: &Point| {
            let from_before = |q| (direction(node, before, q), q);
            from_before(*p).0.cmp(&from_before(after).0) == Ordering::Less && *p != before
        };
        for (other_before, other_after) in passages {
            if (*other_before, *other_after) == (Some(before), Some(after)) {
                continue;
            }
            let inside = [other_before, other_after].map(|p| p.as_ref().map(is_inside));
            match inside {
                [Some(a), Some(b)] => assert_eq!(a, b, "lines cross at {node:?}"),
                [a, b] => assert!(
                    a != Some(true) && b != Some(true),
                    "a sharper turn was left over at {node:?}"
                ),
            }
        }
    }
    // The sharpest turn to the right stays in one sector: only whole pairs lie between, whose
    // first ray, counter-clockwise, is an incoming one.
    for &(before, after) in passages {
        let (Some(before), Some(after)) = (before, after) else {
            continue;
        };
        let next = passages
            .iter()
            .flat_map(|(b, a)| [b.map(|p| (p, true)), a.map(|p| (p, false))])
            .flatten()
            .filter(|(p, _)| *p != before)
            .min_by(|(p, _), (q, _)| direction(node, before, *p).cmp(&direction(node, before, *q)));
        assert!(
            next.is_some_and(|(p, is_in)| p == after || is_in),
            "not the sharpest turn at {node:?}"
        );
    }
}

/// The angle from `zero` to `p`, counter-clockwise around the node, comparable.
fn direction(node: Point, zero: Point, p: Point) -> Angle {
    let zero = [zero[0] - node[0], zero[1] - node[1]];
    let p = [p[0] - node[0], p[1] - node[1]];
    // Turned so that `zero` is east.
    let (x, y) = (zero[0] * p[0] + zero[1] * p[1], cross(zero, p));
    Angle {
        lower: y < 0 || (y == 0 && x < 0),
        x,
        y,
    }
}

#[derive(PartialEq, Eq, Clone, Copy)]
struct Angle {
    lower: bool,
    x: i64,
    y: i64,
}

impl Ord for Angle {
    fn cmp(&self, other: &Self) -> Ordering {
        self.lower
            .cmp(&other.lower)
            .then_with(|| (other.x * self.y).cmp(&(self.x * other.y)))
    }
}

impl PartialOrd for Angle {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The sites where lines may end: vertices and crossings at the edge of the data.
fn border(surface: &Faces, half_level: i64) -> BTreeSet<Point> {
    let mut half_edges = BTreeSet::new();
    for face in &surface.faces {
        for i in 0..3 {
            half_edges.insert([face[i], face[(i + 1) % 3]]);
        }
    }
    let mut border = BTreeSet::new();
    for &[a, b] in half_edges
        .iter()
        .filter(|&&[a, b]| !half_edges.contains(&[b, a]))
    {
        let [a, b] = [a, b].map(|v| surface.vertices[v as usize]);
        border.extend([a, b].map(|p| lattice_point([p[0], p[1]])));
        let t = (half_level as f64 / 2.0 - a[2]) / (b[2] - a[2]);
        if t > 0.0 && t < 1.0 {
            border.insert(lattice_point([
                a[0] + t * (b[0] - a[0]),
                a[1] + t * (b[1] - a[1]),
            ]));
        }
    }
    border
}

/// The faces that contain the middle of a segment, also on their border.
pub(crate) fn faces_at(surface: &Faces, segment: Segment) -> Vec<usize> {
    (0..surface.faces.len())
        .filter(|&i| {
            turns_around(surface, i, segment)
                .iter()
                .all(|&turn| turn >= 0)
        })
        .collect()
}

/// Returns true if the middle of a segment lies on a side of one face only.
pub(crate) fn is_on_edge_of_data(surface: &Faces, segment: Segment) -> bool {
    let faces = faces_at(surface, segment);
    faces.len() == 1 && turns_around(surface, faces[0], segment).contains(&0)
}

/// The orientation of the middle of a segment relative to each side of a face.
fn turns_around(surface: &Faces, face: usize, segment: Segment) -> [i64; 3] {
    let middle = [segment[0][0] + segment[1][0], segment[0][1] + segment[1][1]];
    let at = surface.faces[face].map(|v| {
        let p = surface.vertices[v as usize];
        lattice_point([p[0], p[1]]).map(|c| 2 * c)
    });
    std::array::from_fn(|i| turn(at[i], at[(i + 1) % 3], middle))
}

fn cross(a: Point, b: Point) -> i64 {
    a[0] * b[1] - a[1] * b[0]
}

fn turn(a: Point, b: Point, c: Point) -> i64 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]).signum()
}

fn is_between(p: Point, a: Point, b: Point) -> bool {
    turn(a, b, p) == 0 && a.min(b) <= p && p <= a.max(b)
}

/// Returns true if two segments share more than an end of both.
fn cross_or_overlap(s: Segment, t: Segment) -> bool {
    let touches = |p: Point, other: Segment| {
        is_between(p, other[0], other[1]) && p != other[0] && p != other[1]
    };
    let proper = turn(s[0], s[1], t[0]) * turn(s[0], s[1], t[1]) < 0
        && turn(t[0], t[1], s[0]) * turn(t[0], t[1], s[1]) < 0;
    proper || s.iter().any(|&p| touches(p, t)) || t.iter().any(|&p| touches(p, s))
}

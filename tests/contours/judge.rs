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
    let mut drawn: Vec<Vec<Point>> = Vec::new();
    for line in lines {
        let points: Vec<Point> = line.points.iter().map(|&p| lattice_point(p)).collect();
        let is_closed = points.first() == points.last();
        assert_eq!(is_closed, line.is_closed());
        let sites: BTreeSet<Point> = points.iter().copied().collect();
        assert_eq!(
            sites.len(),
            points.len() - usize::from(is_closed),
            "{points:?} touches itself"
        );
        if is_closed {
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
        drawn.push(points);
    }
    check_nodes(&drawn);
    drawn.sort_unstable();
    assert_eq!(drawn, joined(&segments));
}

/// Checks that no two lines cross where they meet.
fn check_nodes(lines: &[Vec<Point>]) {
    let mut passages = BTreeMap::<Point, Vec<[Point; 2]>>::new();
    for points in lines {
        let closing = [points[points.len() - 2], points[0], points[1]];
        let closing = (points.first() == points.last()).then_some(&closing[..]);
        for three in points.windows(3).chain(closing) {
            passages
                .entry(three[1])
                .or_default()
                .push([three[0], three[2]]);
        }
    }
    for (node, passages) in passages {
        for (i, &one) in passages.iter().enumerate() {
            for &other in &passages[..i] {
                assert!(!is_crossing(node, one, other), "lines cross at {node:?}");
            }
        }
    }
}

/// Returns true if a passage of a node separates the ends of another one.
fn is_crossing(node: Point, [before, after]: [Point; 2], other: [Point; 2]) -> bool {
    let turn = direction(node, before, after);
    let [a, b] = other.map(|p| direction(node, before, p) < turn);
    a != b
}

/// The lines that arcs are joined to, by the rules, naively; sorted.
fn joined(arcs: &[Segment]) -> Vec<Vec<Point>> {
    // The turn rule: what is left of the circle of a node, until nothing fits.
    let mut next = BTreeMap::<Segment, Segment>::new();
    let nodes: BTreeSet<Point> = arcs.iter().flatten().copied().collect();
    for node in nodes {
        let arrives = |arc: &Segment| arc[1] == node;
        let far = |arc: &Segment| if arrives(arc) { arc[0] } else { arc[1] };
        let mut circle: Vec<Segment> = arcs
            .iter()
            .filter(|arc| arc.contains(&node))
            .copied()
            .collect();
        let zero = far(&circle[0]);
        circle.sort_by_key(|arc| direction(node, zero, far(arc)));
        while let Some(i) = (0..circle.len())
            .find(|&i| arrives(&circle[i]) && !arrives(&circle[(i + 1) % circle.len()]))
        {
            let pair = [circle[i], circle[(i + 1) % circle.len()]];
            next.insert(pair[0], pair[1]);
            circle.retain(|arc| !pair.contains(arc));
        }
    }
    let mut lines = Vec::new();
    let mut left: BTreeSet<Segment> = arcs.iter().copied().collect();
    let follows: BTreeSet<Segment> = next.values().copied().collect();
    while let Some(first) = left
        .iter()
        .find(|arc| !follows.contains(*arc))
        .or(left.first())
        .copied()
    {
        let mut points = vec![first[0]];
        let mut arc = Some(first);
        while let Some(taken) = arc.filter(|arc| left.remove(arc)) {
            points.push(taken[1]);
            arc = next.get(&taken).copied();
        }
        cut(points, arc.is_some(), &mut lines);
    }
    lines.sort_unstable();
    lines
}

/// The loop rule: the shortest loop is cut out, until there is none.
fn cut(mut points: Vec<Point>, is_closed: bool, lines: &mut Vec<Vec<Point>>) {
    let last = points.len() - 1;
    let loops = (0..last).flat_map(|i| (i + 1..=last).map(move |j| [i, j]));
    let shortest = loops
        .filter(|&[i, j]| points[i] == points[j] && !(is_closed && j - i == last))
        .min_by_key(|[i, j]| j - i);
    let Some([i, j]) = shortest else {
        if is_closed {
            points.pop();
            let smallest = (0..points.len()).min_by_key(|&i| points[i]).unwrap();
            points.rotate_left(smallest);
            points.push(points[0]);
        }
        return lines.push(points);
    };
    cut(points[i..=j].to_vec(), true, lines);
    let passes = [i.checked_sub(1), Some(j + 1).filter(|&j| j <= last)];
    if let [Some(before), Some(after)] = passes
        && !is_closed
        && is_crossing(
            points[i],
            [points[before], points[after]],
            [points[i + 1], points[j - 1]],
        )
    {
        cut(points[..=i].to_vec(), false, lines);
        return cut(points[j..].to_vec(), false, lines);
    }
    points.drain(i..j);
    cut(points, is_closed, lines);
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

//! The convex polygon that two triangles have in common.

use crate::terrain::linear::{linear, plan};

/// A corner of a polygon, relative to the origin of its [`Overlap`](super::Overlap).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// Its position in plan.
    pub(crate) at: [f64; 2],
    /// The heights of both surfaces.
    pub(crate) heights: [f64; 2],
}

/// The most corners of what two triangles have in common, with what a third one leaves of it.
const MOST: usize = 9;

/// Finds polygons, in memory that is kept from one to the next.
#[derive(Debug, Default)]
pub(super) struct Clipper {
    corners: Vec<Tagged>,
    next: Vec<Tagged>,
    found: Vec<Corner>,
}

/// A corner while a triangle is clipped by another one.
///
/// `PERF:` corners are copied often, so that numbers of corners and sides are bytes.
#[derive(Debug, Clone, Copy)]
struct Tagged {
    at: [f64; 2],
    is: Kind,
    /// On what the side from here to the next corner lies.
    side: Side,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    /// A corner of the first triangle.
    First(u8),
    /// A corner of the second one.
    Second(u8),
    /// Where a side of the first crosses one of the second; sides begin at the corner of their
    /// number.
    Crossing([u8; 2]),
}

#[derive(Debug, Clone, Copy)]
enum Side {
    First(u8),
    Second(u8),
}

type Triangle = [[f64; 3]; 3];

impl Clipper {
    /// Returns the origin and the corners of what two triangles have in common, counter-clockwise;
    /// fewer than three if there is nothing. Both are counter-clockwise.
    ///
    /// The corners of both are as they are given, so are their heights; where sides cross, the
    /// position is rounded, and both heights are interpolated along these sides. So no height is
    /// extrapolated, and errors are a few rounding errors of what the two have in common, wherever
    /// the origin of coordinates is. With the triangles exchanged, the same numbers are exchanged.
    pub(super) fn common(&mut self, triangles: [Triangle; 2]) -> ([f64; 3], &[Corner]) {
        let [a, b] = triangles.map(from_least);
        // One order, however they are given.
        let is_swapped = compare(&b, &a).is_lt();
        let [one, other] = if is_swapped { [b, a] } else { [a, b] };
        let origin = one[0];
        let local = |triangle: Triangle| triangle.map(|p| [0, 1, 2].map(|k| p[k] - origin[k]));
        let pair = [local(one), local(other)];
        self.found.clear();
        // Most pairs whose boxes overlap have nothing in common. (Sides of the other one are
        // tested as it clips.)
        let is_apart = |i| {
            let line = side(pair[0], i).map(plan);
            pair[1].iter().all(|&p| left_of(line, plan(p)) <= 0.0)
        };
        if (0..3).any(is_apart) {
            return (origin, &self.found);
        }
        self.clip(pair);
        for corner in &self.corners {
            let [first, second] = heights(pair, corner);
            let heights = if is_swapped {
                [second, first]
            } else {
                [first, second]
            };
            self.found.push(Corner {
                at: corner.at,
                heights,
            });
        }
        (origin, &self.found)
    }

    /// Clips the first triangle by the sides of the second.
    fn clip(&mut self, [one, other]: [Triangle; 2]) {
        self.corners.clear();
        self.corners.extend([0u8, 1, 2].map(|i| Tagged {
            at: plan(one[i as usize]),
            is: Kind::First(i),
            side: Side::First(i),
        }));
        for j in 0..3u8 {
            clip_by_side(&self.corners, &mut self.next, other, j);
            std::mem::swap(&mut self.corners, &mut self.next);
            if self.corners.len() < 3 {
                self.corners.clear();
                return;
            }
        }
    }
}

/// Clips a polygon by side `j` of the second triangle: what is to the left of its line, or on it,
/// stays.
fn clip_by_side(corners: &[Tagged], next: &mut Vec<Tagged>, other: Triangle, j: u8) {
    next.clear();
    let line = side(other, j).map(plan);
    let Some(mut to) = corners.first() else {
        return;
    };
    let mut height = left_of(line, to.at);
    for position in 0..corners.len() {
        let (from, before) = (to, height);
        to = &corners[(position + 1) % corners.len()];
        height = left_of(line, to.at);
        if before >= 0.0 {
            next.push(*from);
        }
        if (before >= 0.0) == (height >= 0.0) {
            continue;
        }
        let (at, is) = match from.side {
            Side::First(i) => {
                let t = before / (before - height);
                let at = [0, 1].map(|k| from.at[k] + t * (to.at[k] - from.at[k]));
                (at, Kind::Crossing([i, j]))
            }
            // Two sides of the second meet at its corner.
            Side::Second(k) => {
                let corner = if (k + 1) % 3 == j { j } else { k };
                (plan(other[corner as usize]), Kind::Second(corner))
            }
        };
        // From here on along the line, or along the side that comes in.
        let side = if before >= 0.0 {
            Side::Second(j)
        } else {
            from.side
        };
        next.push(Tagged { at, is, side });
    }
}

/// Returns the ends of side `i` of a triangle, which begins at corner `i`.
fn side(triangle: Triangle, i: u8) -> [[f64; 3]; 2] {
    let i = i as usize;
    [triangle[i], triangle[(i + 1) % 3]]
}

/// Returns the heights of both triangles at a corner of their polygon.
fn heights([one, other]: [Triangle; 2], corner: &Tagged) -> [f64; 2] {
    match corner.is {
        Kind::First(i) => [one[i as usize][2], within(other, corner.at)],
        Kind::Second(j) => [within(one, corner.at), other[j as usize][2]],
        Kind::Crossing([i, j]) => [side(one, i), side(other, j)].map(|ends| along(ends, corner.at)),
    }
}

/// Returns the height of a triangle at a position in it: exact at its corners.
pub(crate) fn within(triangle: Triangle, at: [f64; 2]) -> f64 {
    triangle
        .iter()
        .find(|p| plan(**p) == at)
        .map_or_else(|| linear(triangle, at), |p| p[2])
}

/// Returns the height of a side at a position on it; that of its first end if it has no length.
fn along([from, to]: [[f64; 3]; 2], at: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|k| to[k] - from[k]);
    let t = ((at[0] - from[0]) * x + (at[1] - from[1]) * y) / (x * x + y * y);
    if t.is_nan() {
        return from[2];
    }
    from[2] + t.clamp(0.0, 1.0) * (to[2] - from[2])
}

/// Twice the area of a triangle from a line to a position, positive to its left.
fn left_of([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// Returns the triangle with its least corner first, so that it does not show how it was listed.
pub(crate) fn from_least(triangle: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let least = (1..3).fold(0, |least, i| {
        if compare(&[triangle[i]], &[triangle[least]]).is_lt() {
            i
        } else {
            least
        }
    });
    [0, 1, 2].map(|i| triangle[(least + i) % 3])
}

fn compare(a: &[[f64; 3]], b: &[[f64; 3]]) -> std::cmp::Ordering {
    let mut pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs
        .find_map(|(p, q)| p.partial_cmp(q).filter(|order| order.is_ne()))
        .unwrap_or(std::cmp::Ordering::Equal)
}

/// Appends what a triangle leaves of a convex polygon: fewer than three corners if nothing. Both
/// are counter-clockwise; heights are interpolated along the sides of the polygon.
pub(crate) fn clipped(polygon: &[Corner], triangle: [[f64; 2]; 3], found: &mut Vec<Corner>) {
    let mut corners: [Corner; MOST] = [polygon[0]; MOST];
    let mut count = polygon.len().min(MOST);
    corners[..count].copy_from_slice(&polygon[..count]);
    for j in 0..3 {
        let line = [triangle[j], triangle[(j + 1) % 3]];
        let sides = corners.map(|corner| left_of(line, corner.at));
        let mut next = corners;
        let mut kept = 0;
        let mut push = |corner| {
            if kept < MOST {
                next[kept] = corner;
                kept += 1;
            }
        };
        for i in 0..count {
            let k = (i + 1) % count;
            if sides[i] >= 0.0 {
                push(corners[i]);
            }
            if (sides[i] >= 0.0) != (sides[k] >= 0.0) {
                let t = sides[i] / (sides[i] - sides[k]);
                let mix = |a: f64, b: f64| a + t * (b - a);
                push(Corner {
                    at: [0, 1].map(|n| mix(corners[i].at[n], corners[k].at[n])),
                    heights: [0, 1].map(|n| mix(corners[i].heights[n], corners[k].heights[n])),
                });
            }
        }
        (corners, count) = (next, kept);
        if count < 3 {
            return;
        }
    }
    found.extend(&corners[..count]);
}

//! The convex polygon that two triangles have in common.

use super::number::Number;
use crate::terrain::linear::plan;
use crate::triangulation::num::Pair;

/// A corner of a polygon, relative to the origin of its [`Overlap`](super::Overlap).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner<T = f64> {
    /// Its position in plan.
    pub(crate) at: [T; 2],
    /// The heights of both surfaces.
    pub(crate) heights: [T; 2],
}

/// What two triangles have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Common<'a> {
    pub(super) origin: [f64; 3],
    /// Counter-clockwise; fewer than three if there is nothing.
    pub(super) corners: &'a [Corner],
    /// The same with twice the digits, of a sliver.
    pub(super) fine: Option<&'a [Corner<Pair>]>,
}

/// The area of a polygon, relative to its length times the size of the triangles, below which its
/// corners have too few digits for 12 of its area.
const SLIVER: f64 = 1.0 / 2048.0;

/// A share of the terms of an area below which its sign may be that of rounding errors.
const UNSURE: f64 = 1e-14;

/// The area of a polygon, relative to its length times the size of the triangles, below which it is
/// what rounding leaves of nothing, with twice the digits.
const NOTHING: f64 = 1e-27;

/// The most corners of what two triangles have in common, with what a third one leaves of it.
const MOST: usize = 9;

/// Finds polygons, in memory that is kept from one to the next.
#[derive(Debug, Default)]
pub(super) struct Clipper {
    usual: Clipped<f64>,
    fine: Clipped<Pair>,
    found: Vec<Corner>,
    fine_found: Vec<Corner<Pair>>,
}

/// The polygon while it is clipped.
#[derive(Debug)]
struct Clipped<T> {
    corners: Vec<Tagged<T>>,
    next: Vec<Tagged<T>>,
}

impl<T> Default for Clipped<T> {
    fn default() -> Self {
        Clipped {
            corners: Vec::new(),
            next: Vec::new(),
        }
    }
}

/// A corner while a triangle is clipped by another one.
///
/// `PERF:` corners are copied often, so that numbers of corners and sides are bytes.
#[derive(Debug, Clone, Copy)]
struct Tagged<T> {
    at: [T; 2],
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

type Triangle<T = f64> = [[T; 3]; 3];

impl Clipper {
    /// Returns the origin and the corners of what two triangles have in common, counter-clockwise;
    /// fewer than three if there is nothing. Both are counter-clockwise.
    ///
    /// The corners of both are as they are given, so are their heights; where sides cross, the
    /// position is rounded, and both heights are interpolated along these sides. So no height is
    /// extrapolated, and errors are a few rounding errors of what the two have in common, wherever
    /// the origin of coordinates is. With the triangles exchanged, the same numbers are exchanged.
    ///
    /// Where triangles all but touch, what they have in common is a sliver no wider than rounding
    /// errors of its corners: it is computed with twice the digits.
    pub(super) fn common(&mut self, triangles: [Triangle; 2]) -> Common<'_> {
        let [a, b] = triangles.map(from_least);
        // One order, however they are given.
        let is_swapped = compare(&b, &a).is_lt();
        let [one, other] = if is_swapped { [b, a] } else { [a, b] };
        let origin = one[0];
        let pair: [Triangle; 2] = [local(one, origin), local(other, origin)];
        let Clipper {
            usual,
            fine,
            found,
            fine_found,
        } = self;
        found.clear();
        // Most pairs whose boxes overlap have nothing in common. (Sides of the other one are
        // tested as it clips.)
        let of_one = (0..3).map(|i| apart(pair, [one, other], i)).max();
        if of_one == Some(Apart::Surely) {
            return Common {
                origin,
                corners: found,
                fine: None,
            };
        }
        let size = pair.as_flattened().as_flattened().iter();
        let size = size.fold(0.0, |most: f64, c| most.max(c.abs()));
        let is_thin = match of_one {
            Some(Apart::Unsure) => true,
            _ => {
                usual.clip(pair);
                usual.is_thin(SLIVER * size)
            }
        };
        if !is_thin {
            usual.list(pair, is_swapped, found);
            return Common {
                origin,
                corners: found,
                fine: None,
            };
        }
        let exchanged = ([pair[1], pair[0]], [other, one]);
        if (0..3).any(|i| apart(exchanged.0, exchanged.1, i) == Apart::Surely) {
            return Common {
                origin,
                corners: found,
                fine: None,
            };
        }
        let pair: [Triangle<Pair>; 2] = [local(one, origin), local(other, origin)];
        fine.clip(pair);
        fine_found.clear();
        if !fine.is_thin(NOTHING * size) {
            fine.list(pair, is_swapped, fine_found);
        }
        let value = |numbers: [Pair; 2]| numbers.map(Number::value);
        found.extend(fine_found.iter().map(|corner| Corner {
            at: value(corner.at),
            heights: value(corner.heights),
        }));
        Common {
            origin,
            corners: found,
            fine: Some(fine_found),
        }
    }
}

/// Returns a triangle relative to an origin.
fn local<T: Number>(triangle: Triangle, origin: [f64; 3]) -> Triangle<T> {
    triangle.map(|p| [0, 1, 2].map(|k| T::difference(p[k], origin[k])))
}

/// Whether a triangle is to the right of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Apart {
    No,
    /// If at all, it reaches over the line by rounding errors.
    Unsure,
    Surely,
}

/// Returns whether the second triangle is to the right of side `i` of the first one; both are given
/// relative to an origin, and as they are.
fn apart([one, other]: [Triangle; 2], given: [Triangle; 2], i: u8) -> Apart {
    let line = side(one, i).map(plan);
    let mut apart = Apart::Surely;
    for (k, p) in other.into_iter().enumerate() {
        let [left, right] = terms(line, plan(p));
        let height = left - right;
        let unsure = UNSURE * (left.abs() + right.abs());
        if height > unsure {
            return Apart::No;
        }
        // On lines of a grid areas are 0.
        if height.abs() < unsure || height == 0.0 && unsure > 0.0 {
            let line = side(given[0], i).map(|[x, y, _]| [x, y]);
            let [x, y, _] = given[1][k];
            let [ab, ap] =
                [line[1], [x, y]].map(|p| [0, 1].map(|k| Pair::difference(p[k], line[0][k])));
            if (ab[0] * ap[1] - ab[1] * ap[0]).value() > 0.0 {
                apart = Apart::Unsure;
            }
        }
    }
    apart
}

impl<T: Number> Clipped<T> {
    /// Returns true if the area of the polygon is at most its length times `width`. A triangle that
    /// is within the other one has its own corners, and is not thin.
    fn is_thin(&self, width: f64) -> bool {
        let Some((first, others)) = self.corners.split_first() else {
            return true;
        };
        let is_first = |corner: &Tagged<T>| matches!(corner.is, Kind::First(_));
        let is_second = |corner: &Tagged<T>| matches!(corner.is, Kind::Second(_));
        if self.corners.len() == 3
            && (self.corners.iter().all(is_first) || self.corners.iter().all(is_second))
        {
            return false;
        }
        let from_first = |corner: &Tagged<T>| [0, 1].map(|k| corner.at[k] - first.at[k]);
        let mut length: f64 = 0.0;
        let mut area = T::of(0.0);
        let mut before = [T::of(0.0); 2];
        for corner in others {
            let to = from_first(corner);
            area = area + (before[0] * to[1] - before[1] * to[0]);
            to.iter().for_each(|d| length = length.max(d.value().abs()));
            before = to;
        }
        let is_wide = area.value() > 2.0 * length * width;
        // Also if it is not a number.
        !is_wide
    }

    /// Appends the corners with their heights.
    fn list(&self, pair: [Triangle<T>; 2], is_swapped: bool, found: &mut Vec<Corner<T>>) {
        for corner in &self.corners {
            let [first, second] = heights(pair, corner);
            let heights = if is_swapped {
                [second, first]
            } else {
                [first, second]
            };
            found.push(Corner {
                at: corner.at,
                heights,
            });
        }
    }

    /// Clips the first triangle by the sides of the second.
    fn clip(&mut self, [one, other]: [Triangle<T>; 2]) {
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
fn clip_by_side<T: Number>(
    corners: &[Tagged<T>],
    next: &mut Vec<Tagged<T>>,
    other: Triangle<T>,
    j: u8,
) {
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
        let is_before = before.value() >= 0.0;
        if is_before {
            next.push(*from);
        }
        if is_before == (height.value() >= 0.0) {
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
        let side = if is_before {
            Side::Second(j)
        } else {
            from.side
        };
        next.push(Tagged { at, is, side });
    }
}

/// Returns the ends of side `i` of a triangle, which begins at corner `i`.
fn side<T: Copy>(triangle: Triangle<T>, i: u8) -> [[T; 3]; 2] {
    let i = i as usize;
    [triangle[i], triangle[(i + 1) % 3]]
}

/// Returns the heights of both triangles at a corner of their polygon.
fn heights<T: Number>([one, other]: [Triangle<T>; 2], corner: &Tagged<T>) -> [T; 2] {
    match corner.is {
        Kind::First(i) => [one[i as usize][2], within(other, corner.at)],
        Kind::Second(j) => [within(one, corner.at), other[j as usize][2]],
        Kind::Crossing([i, j]) => [side(one, i), side(other, j)].map(|ends| along(ends, corner.at)),
    }
}

/// Returns the height of a triangle at a position in it: exact at its corners.
pub(crate) fn within<T: Number>(triangle: Triangle<T>, at: [T; 2]) -> T {
    let is_there = |p: &&[T; 3]| (0..2).all(|k| (p[k] - at[k]).value() == 0.0);
    let corner = triangle.iter().find(is_there);
    corner.map_or_else(|| T::linear(triangle, at), |p| p[2])
}

/// Returns the height of a side at a position on it; that of its first end if it has no length.
fn along<T: Number>([from, to]: [[T; 3]; 2], at: [T; 2]) -> T {
    let [x, y] = [0, 1].map(|k| to[k] - from[k]);
    let t = ((at[0] - from[0]) * x + (at[1] - from[1]) * y) / (x * x + y * y);
    let t = match t.value() {
        value if value.is_nan() => return from[2],
        value if value < 0.0 => T::of(0.0),
        value if value > 1.0 => T::of(1.0),
        _ => t,
    };
    from[2] + t * (to[2] - from[2])
}

/// Twice the area of a triangle from a line to a position, positive to its left.
fn left_of<T: Number>(line: [[T; 2]; 2], p: [T; 2]) -> T {
    let [left, right] = terms(line, p);
    left - right
}

/// Two products, the first minus the second of which is [`left_of`].
#[inline(always)]
fn terms<T: Number>([a, b]: [[T; 2]; 2], p: [T; 2]) -> [T; 2] {
    [(b[0] - a[0]) * (p[1] - a[1]), (b[1] - a[1]) * (p[0] - a[0])]
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

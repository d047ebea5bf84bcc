//! Distances in plan, in doubles, and heights, exact.

use dashu_ratio::RBig;

pub(crate) type Site = [f64; 2];

/// Returns the vector from one site to another.
pub(crate) fn from_to(p: Site, q: Site) -> Site {
    [q[0] - p[0], q[1] - p[1]]
}

pub(crate) fn cross(p: Site, q: Site) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

fn dot(p: Site, q: Site) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

/// Returns the point of a segment that is nearest to a site.
pub(crate) fn nearest([a, b]: [Site; 2], p: Site) -> Site {
    let along = from_to(a, b);
    let part = (dot(from_to(a, p), along) / dot(along, along)).clamp(0.0, 1.0);
    if part.is_nan() {
        a
    } else {
        [a[0] + part * along[0], a[1] + part * along[1]]
    }
}

pub(crate) fn distance(p: Site, q: Site) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// Returns the distance of a site from a line.
pub(crate) fn distance_to_line(line: &[Site], p: Site) -> f64 {
    line.windows(2)
        .map(|pair| distance(nearest([pair[0], pair[1]], p), p))
        .fold(f64::INFINITY, f64::min)
}

/// Returns true if a site is within closed rings by the even-odd rule. Sites on a ring may be
/// either.
pub(crate) fn is_within(rings: &[Vec<Site>], p: Site) -> bool {
    let sides = rings.iter().flat_map(|ring| ring.windows(2));
    sides.fold(false, |within, side| {
        let [a, b] = [side[0], side[1]].map(|q| from_to(p, q));
        within ^ ((a[1] > 0.0) != (b[1] > 0.0) && (cross(a, b) > 0.0) == (b[1] > a[1]))
    })
}

pub(crate) fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("coordinates are finite")
}

pub(crate) fn rounded(x: &RBig) -> f64 {
    x.to_f64().value()
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
fn turn([a, b, c]: [&[RBig; 2]; 3]) -> RBig {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

/// The height at a site of the plane through three points.
fn height_on(
    [a, b, c]: [usize; 3],
    corners: &[[RBig; 2]; 4],
    heights: &[RBig; 4],
    p: &[RBig; 2],
) -> RBig {
    let [u, v, w] = [&corners[a], &corners[b], &corners[c]];
    let size = turn([u, v, w]);
    let [at_a, at_b, at_c] = [turn([p, v, w]), turn([u, p, w]), turn([u, v, p])];
    (at_a * &heights[a] + at_b * &heights[b] + at_c * &heights[c]) / size
}

/// Returns the lowest and the highest height at a site of a quad with the corners left, right, next
/// left and next right, which may be divided along either diagonal.
pub(crate) fn heights_in(corners: [Site; 4], heights: [f64; 4], p: Site) -> [f64; 2] {
    let corners = corners.map(|corner| corner.map(exact));
    let heights = heights.map(exact);
    let p = p.map(exact);
    // The triangles on either side of a diagonal, first that of the left or the first corner.
    let divided = [
        ([1, 2], [0, 1, 2], [1, 3, 2]),
        ([0, 3], [0, 1, 3], [0, 3, 2]),
    ];
    let of = divided.map(|([from, to], first, second)| {
        let side = |q: &[RBig; 2]| turn([&corners[from], &corners[to], q]);
        let other = first
            .into_iter()
            .find(|corner| *corner != from && *corner != to)
            .expect("three corners");
        let is_in_first = (side(&p) >= RBig::ZERO) == (side(&corners[other]) > RBig::ZERO);
        rounded(&height_on(
            if is_in_first { first } else { second },
            &corners,
            &heights,
            &p,
        ))
    });
    [of[0].min(of[1]), of[0].max(of[1])]
}

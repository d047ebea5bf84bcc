//! Convex polygons, for judging the cells of diagrams.

use crate::grid::Point;

/// Returns the area, positive if counter-clockwise.
pub(crate) fn area(polygon: &[Point]) -> f64 {
    let pairs = (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]));
    pairs.map(|(p, q)| (p[0] * q[1] - p[1] * q[0]) / 2.0).sum()
}

/// Returns the part in which a function, linear in the coordinates, is not positive.
pub(crate) fn part(polygon: &[Point], far: impl Fn(Point) -> f64) -> Vec<Point> {
    let mut left = Vec::new();
    for k in 0..polygon.len() {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        if far(a) <= 0.0 {
            left.push(a);
        }
        if far(a) * far(b) < 0.0 {
            let t = far(a) / (far(a) - far(b));
            left.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    left
}

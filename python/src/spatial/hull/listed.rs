//! What a hull consists of.

/// A convex hull; `D` is the number of coordinates. Of equal points the first is a corner.
pub(crate) struct Hull<const D: usize> {
    /// The points that are corners: in the plane counter-clockwise, in space in order.
    pub(crate) vertices: Vec<i32>,
    /// The corners of each facet, counter-clockwise as seen from outside; in the plane from left to
    /// right.
    pub(crate) facets: Vec<[i32; D]>,
    /// The facet opposite each corner.
    pub(crate) neighbors: Vec<[i32; D]>,
    /// The unit normal of each facet, outward, and its product with the corners, negated.
    pub(crate) normals: Vec<([f64; D], f64)>,
    /// The area in the plane.
    pub(crate) volume: f64,
    /// The length of the border in the plane.
    pub(crate) area: f64,
}

/// Returns a vector of length 1, and its product with a point, negated.
pub(super) fn equation<const D: usize>(normal: [f64; D], point: [f64; D]) -> ([f64; D], f64) {
    // Scaled first: squares of small numbers would be 0.
    let scale = normal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let scaled = normal.map(|x| x / scale);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    let unit = scaled.map(|x| x / length);
    let along: f64 = unit.iter().zip(point).map(|(n, x)| n * x).sum();
    (unit, -along)
}

//! Faces that are thinner than rounding.

/// Returns true if a share of a face may be narrower than some steps of its coordinates.
#[inline]
pub(super) fn is_thin([a, b, c]: [[f64; 3]; 3], share: f64) -> bool {
    /// More than the errors of two positions that are computed on its edges, and of this test.
    const STEPS: f64 = 32.0;
    let axis = |axis: usize| [a[axis], b[axis], c[axis]];
    let range = |[a, b, c]: [f64; 3]| a.max(b).max(c) - a.min(b).min(c);
    let size = |[a, b, c]: [f64; 3]| a.abs().max(b.abs()).max(c.abs());
    let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let length = range(axis(0)) + range(axis(1));
    let step = f64::EPSILON * size(axis(0)).max(size(axis(1)));
    twice_area.abs() * share < STEPS * step * length
}

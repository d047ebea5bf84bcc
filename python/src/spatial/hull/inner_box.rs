//! Points in a box within the hull, which are not corners (Akl and Toussaint 1978).
//!
//! In each octant there is a point that is at least as far out as the corner of the box there,
//! along all three axes. So in any direction one of these eight is farther than all that is inside
//! of the box. Only comparisons decide, whichever eight points are chosen.
//!
//! ```text
//!     +-------------------- *     * a point of each quadrant (of each octant, in space)
//!     |   *                 |
//!     |     +-----------+   |
//!     |     |  not      |   |
//!     |     |  corners  |   |
//!     |     +-----------+   |
//!     |  *               *  |
//!     +---------------------+
//! ```

use rayon::prelude::*;

use crate::spatial::lists::CHUNK;

/// A box: the smallest coordinates, then the largest.
pub(super) type Bounds = [[f64; 3]; 2];

/// One of each two opposite octants, by the signs of the coordinates.
const OCTANTS: [[f64; 3]; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
];

/// A number, and the point that it is measured at.
type Measured = (f64, [f64; 3]);

/// Returns the bounding box of points.
pub(super) fn bounds(points: &[[f64; 3]]) -> Bounds {
    let around = |[low, high]: Bounds, [other_low, other_high]: Bounds| {
        [
            [0, 1, 2].map(|axis| lesser(low[axis], other_low[axis])),
            [0, 1, 2].map(|axis| greater(high[axis], other_high[axis])),
        ]
    };
    let none = || [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    let all = points.par_iter().with_min_len(CHUNK);
    all.fold(none, |bounds, &p| around(bounds, [p, p]))
        .reduce(none, around)
}

/// Returns the smaller number. One instruction, unlike `f64::min`: coordinates are numbers.
fn lesser(x: f64, y: f64) -> f64 {
    if y < x { y } else { x }
}

/// Like [`lesser`], but returns the larger number.
fn greater(x: f64, y: f64) -> f64 {
    if y > x { y } else { x }
}

/// Returns the points, with this bounding box, that are not inside of a box within their hull.
pub(super) fn not_inside(points: &[[f64; 3]], bounds: &Bounds) -> Vec<u32> {
    let Some(&any) = points.first() else {
        return Vec::new();
    };
    let [low, high] = inner_box(outermost(points, any, bounds));
    let is_inside = |p: [f64; 3]| (0..3).all(|axis| low[axis] < p[axis] && p[axis] < high[axis]);
    (0..points.len() as u32)
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter(|&p| !is_inside(points[p as usize]))
        .collect()
}

/// Returns the box within the hull of some points: for each octant, one for the opposite one and
/// one for itself. It is empty if these points have none.
fn inner_box(points: [[Measured; 2]; 4]) -> Bounds {
    let [mut low, mut high] = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
    for (octant, ends) in OCTANTS.into_iter().zip(points) {
        for (end, (_, p)) in [-1.0, 1.0].into_iter().zip(ends) {
            for axis in 0..3 {
                if end * octant[axis] < 0.0 {
                    low[axis] = greater(low[axis], p[axis]);
                } else {
                    high[axis] = lesser(high[axis], p[axis]);
                }
            }
        }
    }
    [low, high]
}

/// Returns points about as far out as any in the opposite of each octant, and in the octant; `any`
/// of them if that is unknown. Axes count alike, however wide the points are spread along them.
fn outermost(points: &[[f64; 3]], any: [f64; 3], [low, high]: &Bounds) -> [[Measured; 2]; 4] {
    let scales = [0, 1, 2].map(|axis| 1.0 / (high[axis] - low[axis]));
    let none = || [[(f64::INFINITY, any), (f64::NEG_INFINITY, any)]; 4];
    let farther = |[least, most]: &mut [Measured; 2], [low, high]: [Measured; 2]| {
        if low.0 < least.0 {
            *least = low;
        }
        if high.0 > most.0 {
            *most = high;
        }
    };
    let all = points.par_iter().with_min_len(CHUNK);
    let of_tasks = all.fold(none, |mut ends, &p| {
        let scaled = [0, 1, 2].map(|axis| scales[axis] * p[axis]);
        for (ends, octant) in ends.iter_mut().zip(OCTANTS) {
            let along = (octant[0] * scaled[0] + octant[1] * scaled[1]) + octant[2] * scaled[2];
            farther(ends, [(along, p); 2]);
        }
        ends
    });
    of_tasks.reduce(none, |mut ends, others| {
        ends.iter_mut()
            .zip(others)
            .for_each(|(ends, others)| farther(ends, others));
        ends
    })
}

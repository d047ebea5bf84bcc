use super::order::lexicographic;
use crate::kernel::{self, CompareDistance, Exact, Kernel};
use crate::num::Sign;

/// How near, in units of the largest coordinate on an axis, an end of one segment may be to the
/// other to be taken as the crossing: several times the rounding error of the crossing.
///
/// Segments that run along each other a rounding apart (a border digitized twice, a segment
/// inserted again after others have split it) cross anywhere and everywhere. If the rounded
/// crossing were always a new vertex, the parts of the split segment would cross the others anew,
/// without end.
const REACH: f64 = 4.0 * f64::EPSILON;

type Segment = [[f64; 2]; 2];

/// Returns where two segments cross, in plan: on the first of them, within its box; or, unless that
/// is exact, an end within [`REACH`] of the other segment.
///
/// The end divides that segment into shorter ones, so no sequence of such crossings goes on
/// forever. Does not depend on the order of segments and ends.
pub(super) fn site(ab: Segment, cd: Segment) -> [f64; 2] {
    let sorted = |[p, q]: Segment| {
        if lexicographic(p, q).is_gt() {
            [q, p]
        } else {
            [p, q]
        }
    };
    let (mut ab, mut cd) = (sorted(ab), sorted(cd));
    if lexicographic(ab[0], cd[0])
        .then_with(|| lexicographic(ab[1], cd[1]))
        .is_gt()
    {
        std::mem::swap(&mut ab, &mut cd);
    }
    let ([a, b], [c, d]) = (ab, cd);
    let along = kernel::crossing(a, b, c, d);
    let site = std::array::from_fn(|axis| {
        let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
        between(a[axis], b[axis], along).clamp(low, high)
    });
    if [ab, cd]
        .iter()
        .all(|&[p, q]| kernel::twice_area(p, q, site) == 0.0)
    {
        return site;
    }
    let reach: [f64; 2] = std::array::from_fn(|axis| {
        REACH
            * [a, b, c, d]
                .map(|p| p[axis].abs())
                .into_iter()
                .fold(0.0, f64::max)
    });
    let ends = [(a, cd), (b, cd), (c, ab), (d, ab)];
    let near = ends
        .into_iter()
        .find(|&(p, segment)| divides(p, segment) && is_near(p, segment, reach));
    near.map_or(site, |(end, _)| end)
}

/// Returns the number at a fraction of the interval between two others.
fn between(from: f64, to: f64, along: f64) -> f64 {
    let length = to - from;
    if length.is_finite() {
        from + along * length
    } else {
        from * (1.0 - along) + to * along
    }
}

/// Returns true if `p` is nearer to both ends of a segment than these are to each other.
fn divides(p: [f64; 2], [a, b]: Segment) -> bool {
    [[a, b], [b, a]]
        .into_iter()
        .all(|[a, b]| Exact::sign(&CompareDistance([a, b, p])) == Sign::Positive)
}

/// Returns true if the line through a segment touches the box of half sides `reach` around `p`.
fn is_near(p: [f64; 2], [a, b]: Segment, reach: [f64; 2]) -> bool {
    let touches = reach[0] * (b[1] - a[1]).abs() + reach[1] * (b[0] - a[0]).abs();
    // Where this overflows or vanishes (kernels without a range), no end is near.
    touches.is_finite() && kernel::twice_area(a, b, p).abs() < touches
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Crossing, Plane};

    #[test]
    fn crossings_are_points_that_the_geometry_admits() {
        let geometry: Plane = Plane::default();
        let tiny = crate::kernel::RANGE.min;
        // They cross at half of the smallest coordinate that is admitted.
        let (ab, cd) = ([[0.0, 0.0], [1.0, 1.0]], [[-1.0, tiny], [1.0, 0.0]]);
        let x = geometry.crossing(ab.each_ref(), cd.each_ref());
        assert_eq!(x, [0.0, 0.0]);
        let x = geometry.crossing(
            [[0.0, 0.0], [8.0, 8.0]].each_ref(),
            [[0.0, 2.0], [2.0, 0.0]].each_ref(),
        );
        assert_eq!(x, [1.0, 1.0]);
    }
}

use super::lexicographic;
use crate::kernel::{self, CompareDistance, Kernel};
use crate::num::Sign;

/// Where two segments cross, in plan, as fractions of the way along each; each segment is turned so
/// that it starts at its lexicographic minimum, and `ab` is the smaller segment of the two.
pub(super) struct Crossed<T> {
    pub(super) ab: [T; 2],
    pub(super) cd: [T; 2],
    pub(super) along_ab: f64,
    pub(super) along_cd: f64,
}

/// How near, in units of the largest coordinate on an axis, an end of one segment may be to the other to
/// be the place where they cross: several times what the place can be off by rounding.
///
/// Segments that run along each other a rounding apart (a border digitized twice, a segment drawn again
/// after others have split it) cross anywhere and everywhere. Were the rounded place always a new vertex, its
/// pieces would cross the others anew, without end.
const REACH: f64 = 4.0 * f64::EPSILON;

impl<T: Copy> Crossed<T> {
    pub(super) fn new(ab: [T; 2], cd: [T; 2], plan: impl Fn(T) -> [f64; 2]) -> Self {
        let sorted = |[p, q]: [T; 2]| if lexicographic(plan(p), plan(q)).is_gt() { [q, p] } else { [p, q] };
        let (mut ab, mut cd) = (sorted(ab), sorted(cd));
        let order = lexicographic(plan(ab[0]), plan(cd[0])).then_with(|| lexicographic(plan(ab[1]), plan(cd[1])));
        if order.is_gt() {
            std::mem::swap(&mut ab, &mut cd);
        }
        let [a, b, c, d] = [ab[0], ab[1], cd[0], cd[1]].map(plan);
        let along_ab = kernel::crossing(a, b, c, d);
        let along_cd = kernel::crossing(c, d, a, b);
        Crossed { ab, cd, along_ab, along_cd }
    }

    /// The place in plan: on the first segment, within its box and the range; or, unless that is exact, an
    /// end within [`REACH`] of the other segment. The end divides that segment into shorter ones, so that
    /// no sequence of such places goes on forever.
    pub(super) fn place<K: Kernel>(&self, plan: impl Fn(T) -> [f64; 2]) -> [f64; 2] {
        let segments @ [[a, b], [c, d]] = [self.ab, self.cd].map(|segment| segment.map(&plan));
        let place = std::array::from_fn(|axis| {
            let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
            let x = between(a[axis], b[axis], self.along_ab).clamp(low, high);
            // Nearer to zero than any coordinate that is admitted: zero lies in the box, too.
            if K::RANGE.admits(x) { x } else { 0.0 }
        });
        if segments.iter().all(|&[p, q]| kernel::twice_area(p, q, place) == 0.0) {
            return place;
        }
        let reach: [f64; 2] =
            std::array::from_fn(|axis| REACH * [a, b, c, d].map(|p| p[axis].abs()).into_iter().fold(0.0, f64::max));
        let ends = [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])];
        let near = ends.into_iter().find(|&(p, segment)| divides::<K>(p, segment) && is_near(p, segment, reach));
        near.map_or(place, |(end, _)| end)
    }
}

/// The number at a fraction of the way from one to another.
fn between(from: f64, to: f64, along: f64) -> f64 {
    let way = to - from;
    if way.is_finite() { from + along * way } else { from * (1.0 - along) + to * along }
}

/// Whether both ways from `p` to the ends of a segment are shorter than the segment.
fn divides<K: Kernel>(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> bool {
    [[a, b], [b, a]].into_iter().all(|[a, b]| K::sign(&CompareDistance([a, b, p])) == Sign::Positive)
}

/// Whether the line through a segment touches the box of half sides `reach` around `p`.
fn is_near(p: [f64; 2], [a, b]: [[f64; 2]; 2], reach: [f64; 2]) -> bool {
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
        // They cross at half of the smallest coordinate there is.
        let (ab, cd) = ([[0.0, 0.0], [1.0, 1.0]], [[-1.0, tiny], [1.0, 0.0]]);
        let x = geometry.crossing(ab.each_ref(), cd.each_ref());
        assert_eq!(x, [0.0, 0.0]);
        let x = geometry.crossing([[0.0, 0.0], [8.0, 8.0]].each_ref(), [[0.0, 2.0], [2.0, 0.0]].each_ref());
        assert_eq!(x, [1.0, 1.0]);
    }
}

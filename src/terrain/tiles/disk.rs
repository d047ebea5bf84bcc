//! A closed disk that contains the circumscribed one of a triangle, whatever rounding does.

use super::Tile;
use super::traps::{self, Rule};

/// The unit roundoff of an `f64`.
const U: f64 = f64::EPSILON / 2.0;

/// Twice the area of a triangle, below which nothing is concluded. Coordinates are zero or at least
/// [`RANGE.min`](crate::triangulation::kernel::RANGE), so that differences are zero or above
/// 2^-214, and nothing that is computed above this limit underflows.
const LEAST_AREA: f64 = 1e-120;

/// A closed disk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Disk {
    center: [f64; 2],
    radius: f64,
}

impl Disk {
    /// Returns a disk that contains the closed circumscribed disk of a triangle, whose corners are
    /// counter-clockwise. `None` if rounding leaves its size in doubt: the triangle is a sliver.
    ///
    /// Let `b` and `c` be the vectors from the first corner to the others. The center lies at `n /
    /// 2d` from it, where `d = b x c` and `n = (|b|^2 c - |c|^2 b)` turned by a right angle.
    ///
    /// *Errors.* A difference of coordinates has one rounding. On the path of each product of `d`
    /// there are 3, and one of their difference; of each product of `n` 6, and one. Hence the
    /// errors of both are below `16 U` times the sum of the absolute products (Higham 2002, lemma
    /// 3.1), which covers the roundings of the bound, too. With `D` the true value of `d` and `E`
    /// the error of `n`,
    ///
    /// ```text
    ///   |n / 2d - N / 2D|  <=  (E + 2 |n / 2d| |d - D|) / 2D
    /// ```
    ///
    /// The radius is the length of the vector to the center. Both errors of the center are added to
    /// it twice: once for that length, once because the disk lies around the rounded center.
    ///
    /// `PERF:` without inlining a leaf takes 10 % longer.
    #[inline(always)]
    pub(super) fn around([a, b, c]: [[f64; 2]; 3]) -> Option<Self> {
        let [b, c] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
        let products = [b[0] * c[1], b[1] * c[0]];
        let area = products[0] - products[1];
        let doubt = 16.0 * U * (products[0].abs() + products[1].abs());
        let least = area - doubt;
        // Not a number is in doubt, too.
        if least.is_nan() || least <= LEAST_AREA {
            return None;
        }
        let [b2, c2] = [b, c].map(|[x, y]| x * x + y * y);
        // Along x and along y.
        let vector = [[b2 * c[1], c2 * b[1]], [c2 * b[0], b2 * c[0]]];
        let offset = vector.map(|[p, q]| (p - q) / (2.0 * area));
        let mut error = 0.0;
        for (offset, [p, q]) in offset.iter().zip(vector) {
            let of_quotient =
                (16.0 * U * (p.abs() + q.abs()) + 2.0 * offset.abs() * doubt) / (2.0 * least);
            error += of_quotient * (1.0 + 8.0 * U) + 8.0 * U * offset.abs();
        }
        let center = [a[0] + offset[0], a[1] + offset[1]];
        let rounded = 2.0 * U * (center[0].abs() + center[1].abs());
        let length = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
        if traps::is_off(Rule::DiskBound) {
            return Some(Disk {
                center,
                radius: length,
            });
        }
        let radius = (length * (1.0 + 8.0 * U) + 2.0 * error + rounded) * (1.0 + 8.0 * U);
        radius.is_finite().then_some(Disk { center, radius })
    }

    /// Returns true if no point outside of a tile is in the disk.
    #[inline(always)]
    pub(super) fn is_within(&self, tile: &Tile) -> bool {
        (0..2).all(|axis| {
            let [low, high] = [
                self.center[axis] - self.radius,
                self.center[axis] + self.radius,
            ];
            tile.min[axis] <= low.next_down() && high.next_up() < tile.max[axis]
        })
    }

    /// Returns true if no point of a segment is in the disk. In doubt returns false.
    ///
    /// A direction in which both ends lie beyond the disk is a proof, however it was found. Taken
    /// is the one from the center to the nearest point of the segment.
    pub(super) fn misses(&self, [a, b]: [[f64; 2]; 2]) -> bool {
        let along = [b[0] - a[0], b[1] - a[1]];
        let to_center = [self.center[0] - a[0], self.center[1] - a[1]];
        let share = (dot(along, to_center) / dot(along, along)).clamp(0.0, 1.0);
        let normal = [0, 1].map(|axis| share * along[axis] - to_center[axis]);
        // The proof of the bound needs a direction that is at least as long as the radius.
        let is_outside = dot(normal, normal) > self.radius * self.radius;
        is_outside
            && [a, b]
                .iter()
                .all(|&origin| self.is_below([Slope { normal, origin }, Slope::FLAT]))
    }

    /// Returns true if no point outside of a tile is both in the disk and to the right of the line
    /// from `p` to `q`. In doubt returns false.
    ///
    /// ```text
    ///         . - - .   |
    ///      .          . |           the disk leaves the tile,
    ///     .            .|.
    ///     .             | .
    ///     .            .|.
    ///  p ---.---------.-|--- q
    ///         ' - - '   |           but not to the right of the line from p to q
    ///                   |
    ///              side of the tile
    /// ```
    ///
    /// For each side of the tile, no point of the disk may be beyond both the line and the side.
    /// Let `f` and `g` be linear functions that are not negative beyond the line and beyond the
    /// side. If `weight f + g` is negative on all of the disk, for any weight that is not negative,
    /// there is no such point. The converse is true of the best weight, as half-planes and disks
    /// are convex. So [`is_below`](Self::is_below) proves what a weight claims, and the weight
    /// itself may be rounded.
    pub(super) fn is_within_beyond(&self, [p, q]: [[f64; 2]; 2], tile: &Tile) -> bool {
        let right = [q[1] - p[1], p[0] - q[0]];
        let length = dot(right, right).sqrt();
        // Of the center, to the right of the line.
        let distance = dot(right, [self.center[0] - p[0], self.center[1] - p[1]]) / length;
        let half_chord = (self.radius * self.radius - distance * distance).sqrt();
        let is_clear = |axis: usize, sign: f64, side: f64| {
            if side == sign * f64::INFINITY {
                return true;
            }
            let (mut normal, mut origin) = ([0.0; 2], self.center);
            (normal[axis], origin[axis]) = (sign, side);
            let beyond_side = Slope { normal, origin };
            let beyond_line = |weight: f64| Slope {
                normal: right.map(|x| weight * x),
                origin: p,
            };
            // Below, `weight f + g` is `weight distance + g(center) + radius |weight right +
            // normal|`, for a vector `right` of length 1; its derivative by the weight is zero at
            // the best one.
            if half_chord > 0.0 {
                let [cos, sin] = [sign * right[axis] / length, right[1 - axis].abs() / length];
                let weight = (-cos - distance * sin / half_chord).max(0.0);
                self.is_below([beyond_line(weight / length), beyond_side])
            } else if distance < 0.0 {
                self.is_below([beyond_line(1.0), Slope::FLAT]) // nothing is beyond the line
            } else {
                self.is_below([Slope::FLAT, beyond_side]) // all of the disk is
            }
        };
        (0..2)
            .all(|axis| is_clear(axis, -1.0, tile.min[axis]) && is_clear(axis, 1.0, tile.max[axis]))
    }

    /// Returns true if the sum of two linear functions is negative on the whole disk. In doubt
    /// returns false.
    ///
    /// The largest value of `n . (y - o)` for `y` in the disk is `n . (center - o) + radius |n|`.
    ///
    /// *Errors.* Normals may have two roundings. On the path of each of the four products there are
    /// these two, one of the difference, one of the product, and at most 4 of sums: 8. On that of
    /// `radius |n|` there are two and one for the sum of the normals, relative to the sum of their
    /// absolute values; 3 for the length, one for the product, and one for the last sum: 8 again.
    /// Hence the error is below `16 U` times the sum of the absolute products and of `radius |n|`
    /// of both normals (Higham 2002, lemma 3.1), which covers the roundings of the bound, too. The
    /// last addition does not change the sign.
    ///
    /// *Underflow.* Twice the area of the triangle is above 1e-120, so the radius is above 1e-61.
    /// If the absolute coordinates of the normals sum up to 1e-64, which callers ensure, the bound
    /// is above 1e-140, more than all that underflows. What overflows makes the bound infinite, and
    /// the sum infinite or not a number.
    fn is_below(&self, slopes: [Slope; 2]) -> bool {
        let (mut most, mut size, mut normal) = (0.0, 0.0, [0.0; 2]);
        for slope in slopes {
            for (axis, sum) in normal.iter_mut().enumerate() {
                let product = slope.normal[axis] * (self.center[axis] - slope.origin[axis]);
                most += product;
                size += product.abs() + self.radius * slope.normal[axis].abs();
                *sum += slope.normal[axis];
            }
        }
        most += self.radius * dot(normal, normal).sqrt();
        most + 16.0 * U * size < 0.0
    }
}

/// A linear function: `normal . (y - origin)`.
#[derive(Debug, Clone, Copy)]
struct Slope {
    normal: [f64; 2],
    origin: [f64; 2],
}

impl Slope {
    const FLAT: Self = Slope {
        normal: [0.0; 2],
        origin: [0.0; 2],
    };
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangulation::kernel::{Adaptive, CompareDistance, InCircle, Kernel, Orientation2};
    use crate::triangulation::num::Sign;
    use testkit::random::Random;

    /// Calls `judge` with triangles, large and small, slanted and flat, the disks around them, and
    /// positions that are in the closed circumscribed disk by exact arithmetic: the corners, and
    /// others near the circle. Returns the number of triangles that are in doubt, and of positions.
    fn each_position(mut judge: impl FnMut([[f64; 2]; 3], Disk, [f64; 2])) -> [usize; 2] {
        let mut random = Random(5);
        let [mut doubts, mut count] = [0; 2];
        for _ in 0..1_500 {
            let away = [0.0, 1e3, 1e7][random.index(3)];
            let flat = [1.0, 1e-3, 1e-9, 1e-15][random.index(4)];
            // Near a slanted line.
            let mut corner = || {
                let along = random.unit();
                [away + along, away + 0.3 * along + flat * random.unit()]
            };
            let corners = [corner(), corner(), corner()];
            if Adaptive::sign(&Orientation2(corners)) != Sign::Positive {
                continue;
            }
            let Some(disk) = Disk::around(corners) else {
                doubts += 1;
                continue;
            };
            for corner in corners {
                judge(corners, disk, corner);
            }
            for k in 0..16 {
                let (sin, cos) = (f64::from(k) * 0.4).sin_cos();
                for stretch in [0.5, 0.999, 1.0 - 1e-9, 1.0 - 1e-12, 1.0 - 1e-14, 1.0, 1.001] {
                    let radius = stretch * disk.radius;
                    let p = [disk.center[0] + radius * cos, disk.center[1] + radius * sin];
                    let [a, b, c] = corners;
                    if Adaptive::sign(&InCircle([a, b, c, p])) != Sign::Negative {
                        count += usize::from(stretch > 0.9);
                        judge(corners, disk, p);
                    }
                }
            }
        }
        [doubts, count]
    }

    /// Returns tiles that lack a position by one step.
    fn beside(p: [f64; 2]) -> [Tile; 4] {
        let [mut left, mut right, mut below, mut above] = [Tile::PLANE; 4];
        (left.max[0], below.max[1]) = (p[0], p[1]);
        (right.min[0], above.min[1]) = (p[0].next_up(), p[1].next_up());
        [left, right, below, above]
    }

    #[test]
    fn what_is_in_the_circle_is_in_the_disk() {
        let [doubts, count] = each_position(|corners, disk, p| {
            assert!(
                beside(p).iter().all(|tile| !disk.is_within(tile)),
                "{corners:?} {p:?}"
            );
        });
        assert!(doubts > 5 && count > 10_000, "{doubts} {count}");
    }

    #[test]
    fn a_segment_to_a_position_in_the_circle_is_not_missed() {
        let mut random = Random(6);
        let mut missed = 0;
        each_position(|corners, disk, p| {
            let mut other =
                || [0, 1].map(|k| disk.center[k] + 4.0 * disk.radius * (random.unit() - 0.5));
            let q = other();
            assert!(
                !disk.misses([p, q]) && !disk.misses([q, p]) && !disk.misses([p, p]),
                "{corners:?} {p:?} {q:?}"
            );
            // Beside the disk.
            let [x, y] = [0, 1].map(|k| disk.center[k] + 1.01 * (p[k] - disk.center[k]));
            let along = [p[1] - disk.center[1], disk.center[0] - p[0]];
            missed += usize::from(
                disk.misses([[x - along[0], y - along[1]], [x + along[0], y + along[1]]]),
            );
        });
        assert!(missed > 10_000, "{missed}");
    }

    /// Lines are the edges of the triangle, and others through it.
    #[test]
    fn what_is_in_the_circle_beyond_a_line_is_not_within_a_tile_beside_it() {
        let mut random = Random(7);
        let [mut beyond, mut hidden] = [0; 2];
        each_position(|corners, disk, p| {
            let [a, b, c] = corners;
            let mut on = |from: [f64; 2], to: [f64; 2]| {
                let share = random.unit();
                [0, 1].map(|k| from[k] + share * (to[k] - from[k]))
            };
            let [through, to] = [on(a, b), on(b, c)];
            for [from, to] in [
                [a, b],
                [b, c],
                [c, a],
                [through, to],
                [to, through],
                [through, p],
            ] {
                if from == to {
                    continue;
                }
                // On the line is beyond it, too.
                if Adaptive::sign(&Orientation2([from, to, p])) != Sign::Positive {
                    beyond += 1;
                    let is_wrong = |tile: &Tile| disk.is_within_beyond([from, to], tile);
                    assert!(
                        !beside(p).iter().any(is_wrong),
                        "{corners:?} {from:?} {to:?} {p:?}"
                    );
                    continue;
                }
                hidden += beside(p)
                    .iter()
                    .filter(|tile| disk.is_within_beyond([from, to], tile))
                    .count();
            }
        });
        assert!(beyond > 10_000 && hidden > 10_000, "{beyond} {hidden}");
    }

    /// Disks whose radius is exact, and positions on the circle or one rounding inside of it: disks
    /// around triangles have room to spare, which would cover roundings by chance.
    #[test]
    fn roundings_are_covered_where_a_disk_has_no_room_to_spare() {
        let mut random = Random(9);
        let mut count = 0;
        for _ in 0..20_000 {
            let (radius, center) = (1.0 + random.unit(), [0.0, 1e3 * random.unit()]);
            let disk = Disk { center, radius };
            let (sin, cos) = (6.3 * random.unit()).sin_cos();
            let p = [radius * cos, center[1] + radius * sin];
            // That is as far away as the radius, exactly.
            let east = [radius, center[1]];
            if Adaptive::sign(&CompareDistance([center, p, east])) == Sign::Positive {
                continue;
            }
            count += 1;
            let q = [
                p[0] + cos + random.unit() - 0.5,
                p[1] + sin + random.unit() - 0.5,
            ];
            assert!(
                !disk.misses([p, q]) && !disk.misses([q, p]),
                "{disk:?} {p:?} {q:?}"
            );
            // On the line is beyond it, too.
            let is_wrong = |line| {
                beside(p)
                    .iter()
                    .any(|tile| disk.is_within_beyond(line, tile))
            };
            assert!(
                !is_wrong([p, q]) && !is_wrong([q, p]),
                "{disk:?} {p:?} {q:?}"
            );
        }
        assert!(count > 5_000, "{count}");
    }
}

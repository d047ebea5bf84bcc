//! The parts of a line that are on a surface.

use super::segment::Segment;
use crate::data::{LinePoint, Stretch};

/// The parts of a line that are on a surface, while it is followed.
#[derive(Default)]
pub(super) struct Stretches {
    done: Vec<Stretch>,
    open: Stretch,
    segment: Option<Segment>,
    /// The distances along the line at which the segment starts and ends.
    start: f64,
    end: f64,
}

impl Stretches {
    /// Goes on to the next segment of the line.
    pub(super) fn begin(&mut self, segment: &Segment) {
        self.start = self.end;
        self.end = self.start + distance(segment.to, segment.from);
        self.segment = Some(*segment);
    }

    /// Adds a point on the surface, or a gap.
    #[inline]
    pub(super) fn take(&mut self, point: Option<[f64; 3]>) {
        let Some(at) = point else {
            self.close();
            return;
        };
        let along = self.distance([at[0], at[1]]);
        match self.open.last() {
            Some(last) if last.at == at => {}
            // Rounded positions may be out of order by a rounding error.
            Some(last) => self.open.push(LinePoint {
                along: along.max(last.along),
                at,
            }),
            None => self.open.push(LinePoint { along, at }),
        }
    }

    fn distance(&self, q: [f64; 2]) -> f64 {
        let Some(Segment { from, to, .. }) = self.segment else {
            return self.start;
        };
        if q == to {
            return self.end;
        }
        // From the nearer end, where it is the more precise.
        let along = if is_nearer(q, from, to) {
            self.start + distance(q, from)
        } else {
            self.end - distance(q, to)
        };
        along.clamp(self.start, self.end)
    }

    fn close(&mut self) {
        let stretch = std::mem::take(&mut self.open);
        let is_there = |p: &LinePoint, q: &LinePoint| p.at[..2] == q.at[..2];
        if stretch.windows(2).any(|pair| !is_there(&pair[0], &pair[1])) {
            self.done.push(stretch);
        }
    }

    pub(super) fn end(mut self) -> Vec<Stretch> {
        self.close();
        self.done
    }
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// Returns true unless the [`distance`] to `a` is above that to `b`.
///
/// `PERF:` decided by squares where these are surely in the order of the distances.
fn is_nearer(q: [f64; 2], a: [f64; 2], b: [f64; 2]) -> bool {
    const SURELY: f64 = 1.0 + 1e-12;
    let square = |p: [f64; 2]| {
        let [x, y] = [0, 1].map(|k| q[k] - p[k]);
        x * x + y * y
    };
    let [to_a, to_b] = [square(a), square(b)];
    let (low, high) = (to_a.min(to_b), to_a.max(to_b));
    if high > f64::MIN_POSITIVE / f64::EPSILON && high.is_finite() && low * SURELY < high {
        return to_a < to_b;
    }
    distance(q, a) <= distance(q, b)
}

#[cfg(test)]
mod tests {
    use testkit::random::Random;

    use super::*;

    #[test]
    fn the_nearer_end_is_that_by_distances() {
        let mut random = Random(1);
        let mut is_near = [0; 2];
        for _ in 0..20_000 {
            let unit = random.pick(&[1.0, 0.01, 1e-170, 1e160]);
            let shift = random.pick(&[0.0, 5_400_000.0]) * unit;
            let mut point = || [0, 1].map(|_| shift + random.around(4) as f64 * unit);
            let [q, a, b] = [(); 3].map(|()| point());
            let expected = distance(q, a) <= distance(q, b);
            assert_eq!(is_nearer(q, a, b), expected, "{q:?} {a:?} {b:?}");
            is_near[usize::from(expected)] += 1;
        }
        assert!(is_near.iter().all(|&count| count > 4000), "{is_near:?}");
    }
}

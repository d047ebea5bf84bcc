//! What of a surface is at a position, and along a line.

mod follow;
mod hints;
mod rim;
mod segment;
mod step;
mod stepped;

use self::follow::follow;
use self::hints::Hints;
use self::rim::{RimEdge, on_rim};
use self::segment::Segment;
use self::step::{At, Steps};
pub(crate) use self::stepped::stepped;
use super::boxes::Boxes;
use super::linear::gradient;
use crate::data::{LinePoint, Stretch, Surface};
use crate::error::{Error, Result};

/// Finds positions on a surface, and follows lines over it.
///
/// Every decision is exact: which faces, edges and vertices a line passes, in which order, and
/// where it leaves the surface. A surface has its rim and its edges: a line along them, or through
/// a vertex, is on it.
///
/// ```
/// use breakline::terrain::{Locator, TinBuilder};
///
/// let mut builder = TinBuilder::default();
/// builder.add_points(&[0.0, 4.0, 4.0, 0.0, 2.0], &[0.0, 0.0, 4.0, 4.0, 2.0], &[0.0, 0.0, 0.0, 0.0, 8.0]);
/// let roof = builder.build()?;
/// let locator = Locator::new(&roof)?;
/// assert_eq!(locator.height([1.0, 2.0]), Some(4.0));
/// let stretches = locator.along(&[[-1.0, 1.0], [5.0, 1.0]])?;
/// let heights: Vec<[f64; 2]> = stretches[0].iter().map(|p| [p.along, p.at[2]]).collect();
/// assert_eq!(heights, [[1.0, 0.0], [2.0, 4.0], [4.0, 4.0], [5.0, 0.0]]);
/// # Ok::<(), breakline::Error>(())
/// ```
pub struct Locator<'a> {
    surface: &'a dyn Surface,
    hints: Hints,
    rim: Boxes<RimEdge>,
}

impl<'a> Locator<'a> {
    /// Prepares a surface.
    ///
    /// # Errors
    /// If the surface was found damaged.
    ///
    /// # Complexity
    /// Linear in the faces, on all threads, and O(r log r) for r edges at the rim. Less than a byte
    /// for each face, and about 56 bytes for each edge at the rim.
    pub fn new(surface: &'a dyn Surface) -> Result<Self> {
        Self::prepared(surface, surface)
    }

    /// Prepares a surface that is also seen under a watch, which counts the faces.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub(crate) fn prepared(surface: &'a dyn Surface, watched: &dyn Surface) -> Result<Self> {
        let (hints, rim) = Hints::new(watched);
        surface.ensure_intact()?;
        Ok(Locator {
            surface,
            hints,
            rim,
        })
    }

    /// Returns the height at a position, linear on the face there, on its edge, or that of a
    /// vertex; `None` outside of the surface, or if a coordinate is not finite.
    ///
    /// # Complexity
    /// Constant for an ordinary surface.
    pub fn height(&self, q: [f64; 2]) -> Option<f64> {
        let mut steps = Steps::new(self.surface);
        let at = self.locate(q, &mut steps);
        steps.point(at, q).map(|[_, _, z]| z)
    }

    /// Returns a face at a position: one of those around it, if it is on an edge or at a vertex;
    /// `None` outside of the surface, or if a coordinate is not finite.
    ///
    /// # Complexity
    /// That of [`height`](Self::height).
    pub fn face(&self, q: [f64; 2]) -> Option<u32> {
        match self.locate(q, &mut Steps::new(self.surface)) {
            At::Off => None,
            At::Inside { face } => Some(face),
            At::Edge { face, corner } => {
                let other = self.surface.neighbor(face, corner);
                Some(other.map_or(face, |other| other.min(face)))
            }
            At::Vertex { face, .. } => Some(face),
        }
    }

    /// Returns how much the height grows per unit of x and of y on the [face](Self::face) at a
    /// position; `None` if there is none. Not finite on a face without area.
    ///
    /// # Complexity
    /// That of [`height`](Self::height).
    pub fn gradient(&self, q: [f64; 2]) -> Option<[f64; 2]> {
        self.surface.triangle(self.face(q)?).map(gradient)
    }

    /// Returns the parts of a line that are on the surface, in order.
    ///
    /// Each has a point where it begins and ends, at each vertex of the line, at each edge of the
    /// surface that the line crosses, and at each vertex that it passes. The height at an edge is
    /// computed on the edge, so that the line has the same heights in the other direction. Where
    /// faces meet that are not linked, as at a step of the surface, two points may have one
    /// position. What has no length is left out.
    ///
    /// # Errors
    /// If a coordinate is not finite, the faces overlap, or the surface was found damaged.
    ///
    /// # Complexity
    /// Linear in the points that are returned, besides those of [`height`](Self::height) for the
    /// start. For each segment that leaves the surface, a search in the edges of the rim that are
    /// near to the segment, which are then sorted.
    pub fn along(&self, line: &[[f64; 2]]) -> Result<Vec<Stretch>> {
        if let Some(vertex) = line.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
            let [x, y] = line[vertex];
            let number = vertex + 1;
            return Err(Error::usage(format!(
                "vertex {number} of the line at {x} {y}: expected finite coordinates"
            )));
        }
        let mut found = Stretches::default();
        let mut at = None;
        for ends in line.windows(2) {
            let Some(segment) = Segment::new(ends[0], ends[1]) else {
                continue;
            };
            let mut steps = Steps::new(self.surface);
            let start = at.unwrap_or_else(|| self.locate(segment.from, &mut steps));
            found.begin(&segment);
            at = Some(follow(
                &mut steps,
                &self.rim,
                &segment,
                start,
                &mut |point| found.take(point),
            ));
            if steps.are_endless() {
                self.surface.ensure_intact()?;
                return Err(Error::format(format!(
                    "the faces near {} {} overlap",
                    segment.from[0], segment.from[1]
                ))
                .cure("a surface has one height at each position: repair it"));
            }
        }
        self.surface.ensure_intact()?;
        Ok(found.end())
    }

    /// Returns where a position is, by a walk from a face near to it.
    fn locate(&self, q: [f64; 2], steps: &mut Steps<'_>) -> At {
        if !q.iter().all(|c| c.is_finite()) {
            return At::Off;
        }
        let hint = self.hints.near(q);
        let Some((face, corners)) = hint.and_then(|f| Some((f, self.surface.triangle(f)?))) else {
            return At::Off;
        };
        let start = At::Vertex { face, corner: 0 };
        let at = match Segment::new([corners[0][0], corners[0][1]], q) {
            None => start,
            Some(segment) => follow(steps, &self.rim, &segment, start, &mut |_| ()),
        };
        match at {
            At::Off => on_rim(self.surface, &self.rim, q),
            at => at,
        }
    }
}

/// The parts of a line that are on a surface, while it is followed.
#[derive(Default)]
struct Stretches {
    done: Vec<Stretch>,
    open: Stretch,
    segment: Option<Segment>,
    /// The distances along the line at which the segment starts and ends.
    start: f64,
    end: f64,
}

impl Stretches {
    /// Goes on to the next segment of the line.
    fn begin(&mut self, segment: &Segment) {
        self.start = self.end;
        self.end = self.start + distance(segment.to, segment.from);
        self.segment = Some(*segment);
    }

    /// Adds a point on the surface, or a gap.
    fn take(&mut self, point: Option<[f64; 3]>) {
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

    fn end(mut self) -> Vec<Stretch> {
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

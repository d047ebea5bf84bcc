//! What of a surface is at a position, and along a line.

mod follow;
mod ground;
mod hints;
mod linked;
mod rim;
mod segment;
mod step;
mod stepped;
mod stretches;
mod turns;

use self::ground::Ground;
pub(in crate::terrain) use self::linked::{Arrival, follow_linked};
pub(in crate::terrain) use self::step::At;
use self::step::Steps;
pub(crate) use self::stepped::stepped;
use self::turns::in_turns;
use super::linear::gradient;
use crate::data::{Stretch, Surface};
use crate::error::Result;

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
    ground: Ground<'a>,
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
        let ground = Ground::new(surface, watched);
        surface.ensure_intact()?;
        Ok(Locator { ground })
    }

    /// Returns the height at a position, linear on the face there, on its edge, or that of a
    /// vertex; `None` outside of the surface, or if a coordinate is not finite.
    ///
    /// # Complexity
    /// Constant for an ordinary surface.
    pub fn height(&self, q: [f64; 2]) -> Option<f64> {
        let mut steps = Steps::new(self.ground.surface);
        let at = self.ground.locate(q, &mut steps);
        steps.point(at, q).map(|[_, _, z]| z)
    }

    /// Returns a face at a position: one of those around it, if it is on an edge or at a vertex;
    /// `None` outside of the surface, or if a coordinate is not finite.
    ///
    /// # Complexity
    /// That of [`height`](Self::height).
    pub fn face(&self, q: [f64; 2]) -> Option<u32> {
        match self.at(q) {
            At::Off => None,
            At::Inside { face } => Some(face),
            At::Edge { face, corner } => {
                let other = self.ground.surface.neighbor(face, corner);
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
        let face = self.face(q)?;
        self.ground.surface.triangle(face).map(gradient)
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
        self.along_each(&[line]).map(|mut each| each.swap_remove(0))
    }

    /// Returns the parts of each of some lines that are on the surface, as [`along`](Self::along)
    /// does.
    ///
    /// # Errors
    /// Those of [`along`](Self::along), for any of them.
    ///
    /// # Complexity
    /// That of [`along`](Self::along) for each. Faster together than one by one: while memory
    /// answers for one line, others go on.
    pub fn along_each<L: AsRef<[[f64; 2]]>>(&self, lines: &[L]) -> Result<Vec<Vec<Stretch>>> {
        let lines: Vec<&[[f64; 2]]> = lines.iter().map(AsRef::as_ref).collect();
        in_turns(&self.ground, &lines)
    }

    /// Returns where on the surface a position is.
    ///
    /// # Complexity
    /// That of [`height`](Self::height).
    pub(in crate::terrain) fn at(&self, q: [f64; 2]) -> At {
        self.ground.locate(q, &mut Steps::new(self.ground.surface))
    }
}

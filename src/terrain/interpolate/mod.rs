//! Heights between the vertices of a surface.
//!
//! | I want | method | |
//! |---|---|---|
//! | what the triangles say; the fastest | [`Linear`](Method::Linear) | kinks at all edges |
//! | round shapes of scattered points, no overshoot | [`Natural`](Method::Natural) | smooth except at vertices and hard edges |
//! | almost the same, in less time | [`Laplace`](Method::Laplace) | kinks at circles through vertices |
//! | a surface to compute slopes from | [`Smooth`](Method::Smooth) | smooth except at hard edges; may overshoot |
//! | a map of the areas nearest to points | [`Nearest`](Method::Nearest) | steps |
//! | what another program calls IDW | [`Idw`](Method::Idw) | steps; ignores lines, but not water |
//!
//! *Hard* edges are those of breaklines ([`EdgeKind::is_hard`](crate::data::EdgeKind::is_hard)).
//! The methods [`Nearest`](Method::Nearest) and [`Idw`](Method::Idw) know only vertices, except in
//! water, which is level with all methods.
//! The first four methods have the heights of the vertices at the vertices and those of a hard edge
//! on it, and reproduce a plane.
//!
//! Interpolation uses the triangles [under](Surface::base_faces_in) the surface. So clipping a
//! surface, or leaving out long edges at its rim, does not change heights. A
//! [`Mesh`](crate::data::Mesh) has only its own faces: there the natural methods treat edges that
//! are not Delaunay as hard, and end at the rim.
//!
//! A height depends on the position and the points and lines alone, not on the numbering of
//! triangles. Nothing is inserted.

mod base;
mod element;
mod natural;
mod smooth;
mod vertices;
mod waters;

use std::sync::{Arc, OnceLock};

use super::boxes::{Boxes, Extent, LocatedFace};
use super::linear::linear;
use crate::data::{Surface, faces_under};
use crate::error::Result;
use base::{Base, Site, holds};
use natural::{Tour, laplace, sibson};
use smooth::Patch;
use vertices::{Search, Vertices};
use waters::Waters;

pub use element::CubicElement;

/// How heights between the vertices of a surface are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum Method {
    /// Linear on each triangle.
    #[default]
    Linear,
    /// The height of the nearest vertex; of several, that of the one with the smallest x, then y.
    Nearest,
    /// Sibson's natural neighbor interpolation, stopped by hard edges.
    Natural,
    /// Laplace's (non-Sibsonian) natural neighbor interpolation, stopped by hard edges.
    Laplace,
    /// Cubic macro-elements of Clough and Tocher, without kinks except at hard edges.
    Smooth,
    /// Inverse distance weighting: the mean of the nearest 12 vertices, and all others exactly as
    /// far as the last of these, with weights of 1 over the square of the distance.
    Idw,
}

/// Heights of a surface by one method.
///
/// ```
/// use breakline::terrain::{Interpolant, Method, TinBuilder};
///
/// let mut builder = TinBuilder::default();
/// builder.add_points(&[0.0, 4.0, 4.0, 0.0, 1.0], &[0.0, 0.0, 4.0, 4.0, 2.0], &[0.0, 0.0, 0.0, 0.0, 8.0]);
/// let tin = builder.build()?;
/// let natural = Interpolant::new(&tin, Method::Natural)?;
/// assert_eq!(natural.height(1.0, 2.0), Some(8.0));
/// assert!(natural.height(2.0, 2.0).is_some_and(|z| 3.0 < z && z < 8.0));
/// assert_eq!(natural.height(5.0, 2.0), None);
/// # Ok::<(), breakline::Error>(())
/// ```
#[derive(Debug)]
pub struct Interpolant<'a, S: ?Sized> {
    surface: &'a S,
    prepared: Arc<Prepared>,
}

/// What a method needs to know of a surface, for any number of interpolants on it.
#[derive(Debug)]
pub(crate) struct Prepared {
    rule: Rule,
    /// The faces of the surface, for single positions.
    faces: OnceLock<Boxes<LocatedFace>>,
    /// The triangles that are not faces of the surface, for positions in fragments.
    beneath: OnceLock<Boxes<LocatedFace>>,
}

/// A method with what it has prepared.
#[derive(Debug)]
enum Rule {
    Linear,
    Nearest(Vertices, Waters),
    Natural(Base),
    Laplace(Base),
    Smooth(Base),
    Idw(Vertices, Waters),
}

/// The memory of queries, kept from one position to the next. Its content has no influence on
/// results.
#[derive(Debug, Default)]
pub(super) struct QueryBuffers {
    tour: Tour,
    search: Search,
    patch: Option<Patch>,
}

impl<'a, S: Surface + ?Sized> Interpolant<'a, S> {
    /// Prepares a method on a surface.
    ///
    /// # Errors
    /// If there are more triangles than can be numbered (2^31), or the surface was found damaged.
    ///
    /// # Complexity
    /// Constant for [`Method::Linear`]. O(n log n) and about 35 bytes for each vertex for
    /// [`Nearest`](Method::Nearest) and [`Idw`](Method::Idw). Linear and about 72 bytes for each
    /// vertex for the others.
    pub fn new(surface: &'a S, method: Method) -> Result<Self> {
        let delaunay = || {
            Base::new(surface).map(|mut base| {
                base.close_where_not_delaunay();
                base
            })
        };
        let rule = match method {
            Method::Linear => Rule::Linear,
            Method::Nearest => Rule::Nearest(Vertices::new(surface), Waters::new(surface)),
            Method::Natural => Rule::Natural(delaunay()?),
            Method::Laplace => Rule::Laplace(delaunay()?),
            Method::Smooth => Rule::Smooth(Base::new(surface)?),
            Method::Idw => Rule::Idw(Vertices::new(surface), Waters::new(surface)),
        };
        surface.ensure_intact()?;
        let prepared = Prepared {
            rule,
            faces: OnceLock::new(),
            beneath: OnceLock::new(),
        };
        Ok(Interpolant {
            surface,
            prepared: Arc::new(prepared),
        })
    }

    /// Returns a method on a surface for which it was prepared.
    pub(crate) fn of_prepared(surface: &'a S, prepared: Arc<Prepared>) -> Self {
        Interpolant { surface, prepared }
    }

    /// Returns what was prepared, to be used again on the same surface.
    pub(crate) fn prepared(&self) -> Arc<Prepared> {
        Arc::clone(&self.prepared)
    }

    /// Returns the method.
    pub fn method(&self) -> Method {
        match self.prepared.rule {
            Rule::Linear => Method::Linear,
            Rule::Nearest(..) => Method::Nearest,
            Rule::Natural(_) => Method::Natural,
            Rule::Laplace(_) => Method::Laplace,
            Rule::Smooth(_) => Method::Smooth,
            Rule::Idw(..) => Method::Idw,
        }
    }

    /// Returns the height at a position; `None` outside of the surface.
    ///
    /// # Complexity
    /// O(log n) for an ordinary surface; the first call prepares a search for faces, in O(n log n)
    /// and about 50 bytes for each face.
    pub fn height(&self, x: f64, y: f64) -> Option<f64> {
        let q = [x, y];
        let is_in = |face| {
            self.surface
                .triangle(face)
                .is_some_and(|triangle| holds(triangle, q))
        };
        let faces = self
            .prepared
            .faces
            .get_or_init(|| Boxes::by_one_thread(LocatedFace::all(self.surface).collect()));
        let face = faces.find(q, |face| is_in(face.number).then_some(face.number))?;
        Some(self.height_in(face, q, &mut QueryBuffers::default()))
    }

    /// Returns the height at a position in a face of the surface, or next to it by a rounding
    /// error. Returns the same for all faces around the position.
    pub(super) fn height_in(&self, face: u32, q: [f64; 2], scratch: &mut QueryBuffers) -> f64 {
        let height = match &self.prepared.rule {
            Rule::Linear => None,
            Rule::Nearest(vertices, waters) => waters
                .height(q)
                .or_else(|| vertices.nearest(q, &mut scratch.search)),
            Rule::Idw(vertices, waters) => waters
                .height(q)
                .or_else(|| vertices.inverse_distance(q, &mut scratch.search)),
            Rule::Natural(base) => self.in_triangle(base, face, q, |site| match site {
                Site::Height(height) | Site::Rim { height, .. } => Some(height),
                Site::Inside { face, first } => sibson(base, face, first, q, &mut scratch.tour),
            }),
            Rule::Laplace(base) => self.in_triangle(base, face, q, |site| match site {
                Site::Height(height) | Site::Rim { height, .. } => Some(height),
                Site::Inside { face, first } => laplace(base, face, first, q, &mut scratch.tour),
            }),
            Rule::Smooth(base) => self.in_triangle(base, face, q, |site| match site {
                Site::Height(height) => Some(height),
                Site::Inside { face, first } | Site::Rim { face, first, .. } => {
                    smooth(base, face, first, q, &mut scratch.patch)
                }
            }),
        };
        height.unwrap_or_else(|| {
            self.surface
                .triangle(face)
                .map_or(f64::NAN, |corners| linear(corners, q))
        })
    }

    /// Returns the height at a position, given how to compute it from its site in the triangles
    /// under the surface.
    fn in_triangle(
        &self,
        base: &Base,
        face: u32,
        q: [f64; 2],
        height: impl FnOnce(Site) -> Option<f64>,
    ) -> Option<f64> {
        let hint = if base.is_face(face) {
            Some(face)
        } else {
            self.triangle_under(base, q)
        };
        let site = base.site(q, hint?)?;
        height(site).or_else(|| match site {
            Site::Height(_) => None,
            Site::Inside { face, first } | Site::Rim { face, first, .. } => {
                // In an order that does not depend on the numbering.
                let mut corners = base.corners(face);
                corners.rotate_left(first);
                Some(linear(corners, q))
            }
        })
    }

    /// Returns a triangle at a position that is in a fragment.
    fn triangle_under(&self, base: &Base, q: [f64; 2]) -> Option<u32> {
        let beneath = self.prepared.beneath.get_or_init(|| {
            let is_cut = |number: u32| self.surface.face(number).is_none();
            let faces = faces_under(self.surface).filter(|face| is_cut(face.number));
            let extent = |corners: [u32; 3]| Extent::of(corners.map(|v| base.point(v)));
            Boxes::by_one_thread(
                faces
                    .map(|face| LocatedFace {
                        number: face.number,
                        extent: extent(face.corners),
                    })
                    .collect(),
            )
        });
        beneath.find(q, |face| {
            holds(base.corners(face.number), q).then_some(face.number)
        })
    }
}

/// Returns the height on the patch over a triangle; `patch` is the last one that was used.
fn smooth(
    base: &Base,
    face: u32,
    first: usize,
    q: [f64; 2],
    patch: &mut Option<Patch>,
) -> Option<f64> {
    if patch.as_ref().is_none_or(|patch| patch.face() != face) {
        *patch = Some(Patch::new(base, face, first));
    }
    patch.as_ref()?.height(q)
}

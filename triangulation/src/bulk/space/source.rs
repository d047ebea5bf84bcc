//! The points, by their ranks.

use crate::geometry::{Coordinates, in_sphere, in_sphere_of_flat, in_tied_sphere};
use crate::num::Sign;

/// Points in spatial order, and the predicates of their geometry, by their ranks.
///
/// `PERF:` called seldom, so that the rest need not be compiled for each geometry.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) count: usize,
    /// Coordinates, and the weight.
    pub(super) site: &'a (dyn Fn(u32) -> [f64; 4] + Sync),
    pub(super) orientation: &'a (dyn Fn([u32; 4]) -> Sign + Sync),
    /// The orientation of three points in a plane of theirs; zero if they are collinear.
    pub(super) turn: &'a (dyn Fn([u32; 3]) -> Sign + Sync),
    /// True if a point is in the sphere of four positively oriented ones, ties decided.
    pub(super) in_sphere: &'a (dyn Fn([u32; 4], u32) -> bool + Sync),
    /// Like `in_sphere`, for a point that lies on the sphere.
    pub(super) in_tied_sphere: &'a (dyn Fn([u32; 4], u32) -> bool + Sync),
    /// True if a point is in the circle of three others in its plane, ties decided.
    pub(super) in_circle: &'a (dyn Fn([u32; 3], u32) -> bool + Sync),
}

impl Source<'_> {
    pub(super) fn position(&self, rank: u32) -> [f64; 3] {
        let [position @ .., _] = (self.site)(rank);
        position
    }
}

/// Does some work on points of a geometry.
pub(super) fn with_source<G: Coordinates<N>, const N: usize, T>(
    geometry: &G,
    points: &[G::Point],
    work: impl FnOnce(Source) -> T,
) -> T {
    let point = |rank: u32| &points[rank as usize];
    let simplex = |ranks: [u32; 4]| std::array::from_fn::<_, N, _>(|i| point(ranks[i & 3]));
    work(Source {
        count: points.len(),
        site: &|rank| geometry.exact_site(point(rank)).unwrap_or([f64::NAN; 4]),
        orientation: &|ranks| geometry.orientation(simplex(ranks)),
        turn: &|ranks| geometry.orientation_in_flat(&ranks.map(point)),
        in_sphere: &|ranks, q| in_sphere(geometry, simplex(ranks), point(q)),
        in_tied_sphere: &|ranks, q| in_tied_sphere(geometry, simplex(ranks), point(q)),
        in_circle: &|ranks, q| in_sphere_of_flat::<G, N>(geometry, &ranks.map(point), point(q)),
    })
}

use std::cmp::Ordering;
use std::marker::PhantomData;

use super::{Coordinates, Geometry, Plane, Space, plan};
use crate::kernel::{Adaptive, Kernel};
use crate::num::Sign;

/// The geometry of the sites of weighted points, `[x, y, weight]` in the plane and
/// `[x, y, z, weight]` in space: that of [`Plane`] or [`Space`], whatever the weights are.
///
/// For samples of the vertices of a [`Regular`](crate::Regular) triangulation, as a
/// [`Hierarchy`](crate::Hierarchy) has them, and for the Delaunay triangulation of the same points.
///
/// ```
/// use breakline_triangulation::geometry::{Unweighted, WeightedSpace};
/// use breakline_triangulation::{Hierarchy, Locate, Location, Regular};
///
/// let mut t = Regular::<WeightedSpace, 4>::new(WeightedSpace::new());
/// let mut hierarchy = Hierarchy::<_, 4>::new(Unweighted::new());
/// for i in 0..500 {
///     let [x, y, z] = [7919, 104_729, 1_299_709].map(|prime| f64::from(i * prime % 499));
///     t.insert_by(&mut hierarchy, [x, y, z, f64::from(i % 7)], ())?;
/// }
/// assert!(matches!(hierarchy.locate(&t, &[250.5, 250.5, 250.5, 0.0]), Location::Cell { .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct Unweighted<K = Adaptive>(PhantomData<K>);

impl Unweighted {
    /// Returns the geometry with the kernel [`Adaptive`]. For another kernel, use
    /// `Unweighted::<K>::default()`.
    pub fn new() -> Self {
        Unweighted::default()
    }
}

impl<K: Kernel> Unweighted<K> {
    fn plane() -> Plane<K> {
        Plane::default()
    }

    fn space() -> Space<K> {
        Space::default()
    }
}

#[inline(always)]
fn site(p: &[f64; 4]) -> [f64; 3] {
    [p[0], p[1], p[2]]
}

/// Answers a question about up to three sites in space.
fn in_space(simplex: &[&[f64; 4]], answer: impl FnOnce(&[&[f64; 3]]) -> Sign) -> Sign {
    let mut sites = [[0.0; 3]; 3];
    let simplex = &simplex[..simplex.len().min(3)];
    sites
        .iter_mut()
        .zip(simplex)
        .for_each(|(at, p)| *at = site(p));
    answer(&sites.each_ref()[..simplex.len()])
}

impl<K: Kernel> Geometry<3> for Unweighted<K> {
    type Point = [f64; 3];

    #[inline]
    fn admits(&self, p: &[f64; 3]) -> bool {
        Self::plane().admits(&plan(p))
    }

    #[inline]
    fn is_finite(&self, p: &[f64; 3]) -> bool {
        Self::plane().is_finite(&plan(p))
    }

    #[inline(always)]
    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        Self::plane().compare(&plan(p), &plan(q))
    }

    #[inline]
    fn rough_distance(&self, p: &[f64; 3], q: &[f64; 3]) -> Option<f64> {
        Self::plane().rough_distance(&plan(p), &plan(q))
    }

    #[inline(always)]
    fn rough_sides(&self, simplex: [&[f64; 3]; 3], q: &[f64; 3]) -> Option<[f64; 3]> {
        Self::plane().rough_sides(simplex.map(plan).each_ref(), &plan(q))
    }

    #[inline(always)]
    fn sides_error(&self, simplex: [&[f64; 3]; 3], q: &[f64; 3]) -> f64 {
        Self::plane().sides_error(simplex.map(plan).each_ref(), &plan(q))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 3]; 3]) -> Sign {
        Self::plane().orientation(simplex.map(plan).each_ref())
    }

    #[inline(always)]
    fn side_of_sphere(&self, simplex: [&[f64; 3]; 3], q: &[f64; 3]) -> Sign {
        Self::plane().side_of_sphere(simplex.map(plan).each_ref(), &plan(q))
    }
}

impl<K: Kernel> Coordinates<3> for Unweighted<K> {
    type Coordinates = [f64; 2];

    #[inline]
    fn coordinates(&self, p: &[f64; 3]) -> [f64; 2] {
        plan(p)
    }

    #[inline(always)]
    fn exact_plan(&self, p: &[f64; 3]) -> Option<[f64; 2]> {
        Self::plane().exact_plan(&plan(p))
    }
}

impl<K: Kernel> Geometry<4> for Unweighted<K> {
    type Point = [f64; 4];

    #[inline]
    fn admits(&self, p: &[f64; 4]) -> bool {
        Self::space().admits(&site(p))
    }

    #[inline]
    fn is_finite(&self, p: &[f64; 4]) -> bool {
        Self::space().is_finite(&site(p))
    }

    #[inline(always)]
    fn compare(&self, p: &[f64; 4], q: &[f64; 4]) -> Ordering {
        Self::space().compare(&site(p), &site(q))
    }

    #[inline]
    fn rough_distance(&self, p: &[f64; 4], q: &[f64; 4]) -> Option<f64> {
        Self::space().rough_distance(&site(p), &site(q))
    }

    #[inline(always)]
    fn rough_sides(&self, simplex: [&[f64; 4]; 4], q: &[f64; 4]) -> Option<[f64; 4]> {
        Self::space().rough_sides(simplex.map(site).each_ref(), &site(q))
    }

    #[inline(always)]
    fn sides_error(&self, simplex: [&[f64; 4]; 4], q: &[f64; 4]) -> f64 {
        Self::space().sides_error(simplex.map(site).each_ref(), &site(q))
    }

    #[inline]
    fn rough_lift(&self, p: &[f64; 4], origin: &[f64; 4]) -> Option<[f64; 4]> {
        Self::space().rough_lift(&site(p), &site(origin))
    }

    #[inline(always)]
    fn orientation(&self, simplex: [&[f64; 4]; 4]) -> Sign {
        Self::space().orientation(simplex.map(site).each_ref())
    }

    #[inline(always)]
    fn side_of_sphere(&self, simplex: [&[f64; 4]; 4], q: &[f64; 4]) -> Sign {
        Self::space().side_of_sphere(simplex.map(site).each_ref(), &site(q))
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 4]]) -> Sign {
        in_space(simplex, |simplex| {
            Self::space().orientation_in_flat(simplex)
        })
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 4]], q: &[f64; 4]) -> Sign {
        in_space(simplex, |simplex| {
            Self::space().side_of_sphere_in_flat(simplex, &site(q))
        })
    }
}

impl<K: Kernel> Coordinates<4> for Unweighted<K> {
    type Coordinates = [f64; 3];

    #[inline]
    fn coordinates(&self, p: &[f64; 4]) -> [f64; 3] {
        site(p)
    }

    #[inline(always)]
    fn exact_site(&self, p: &[f64; 4]) -> Option<[f64; 4]> {
        Self::space().exact_site(&site(p))
    }
}

//! What floating point is sure of, before the geometry is asked.

use crate::kernel::{ErrorBound, Filter, InSphere, Orientation3, Predicate};
use crate::num::Sign;

use super::cell::{Cell, Corner, FACETS};
use super::source::Source;

/// The predicates of vertices.
#[derive(Clone, Copy)]
pub(super) struct Predicates<'a> {
    pub(super) source: Source<'a>,
    /// The points of the vertices.
    pub(super) ranks: &'a [u32],
    /// Determinants of orientations of absolute value above it have the right sign.
    pub(super) flatness: f64,
    /// True if vertices may be hidden: not all weights are equal.
    pub(super) may_hide: bool,
}

impl Predicates<'_> {
    fn points<const M: usize>(&self, vertices: [u32; M]) -> [u32; M] {
        vertices.map(|vertex| self.ranks[vertex as usize])
    }

    /// Returns the orientation of a facet and a vertex, all finite.
    #[inline(always)]
    pub(super) fn orientation(&self, corners: &[Corner], facet: [u32; 3], vertex: u32) -> Sign {
        let vertices = [facet[0], facet[1], facet[2], vertex];
        let determinant =
            Orientation3(vertices.map(|v| corners[v as usize].site)).value(|x, y| x - y);
        if determinant > self.flatness {
            Sign::Positive
        } else if determinant < -self.flatness {
            Sign::Negative
        } else {
            (self.source.orientation)(self.points(vertices))
        }
    }

    /// Returns true if a vertex destroys a cell.
    #[inline(never)]
    pub(super) fn conflict(&self, corners: &[Corner], cell: Cell, vertex: u32) -> bool {
        let infinite = corners.len() as u32 - 1;
        let Some(i) = cell.vertices.iter().position(|&v| v == infinite) else {
            return self.in_sphere(corners, cell.vertices, vertex);
        };
        let facet = FACETS[i].map(|k| cell.vertices[k]);
        match self.orientation(corners, facet, vertex) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => (self.source.in_circle)(self.points(facet), self.ranks[vertex as usize]),
        }
    }

    /// Returns true if a vertex is in the sphere of four others.
    ///
    /// `PERF:` on a surface the spheres of a tenth of the cells are not known well enough, on the
    /// moment curve hardly any is. The geometry would check the range of the sites again, and an
    /// error bound for each operation takes as long as the operations.
    #[inline(always)]
    fn in_sphere(&self, corners: &[Corner], vertices: [u32; 4], vertex: u32) -> bool {
        if !self.may_hide {
            let site = |v: u32| corners[v as usize].site;
            let [a, b, c, d] = vertices;
            let sites = [site(a), site(b), site(c), site(d), site(vertex)];
            if let Some(is_inside) = is_surely_inside(sites) {
                return is_inside;
            }
            if let Some(sign @ (Sign::Positive | Sign::Negative)) =
                ErrorBound::try_sign(&InSphere(sites))
            {
                return sign == Sign::Positive;
            }
        }
        (self.source.in_sphere)(self.points(vertices), self.ranks[vertex as usize])
    }
}

/// Returns true if the last site is in the sphere of the others, a positive cell; `None` if one
/// evaluation is not sure of it.
///
/// Let `X`, `Y` and `Z` be the largest absolute differences to the last site. The determinant is a
/// sum of 24 terms, none above `X Y Z (X^2 + Y^2 + Z^2)`, and on the path of each there are 16
/// roundings: of five differences, four products and seven sums (Higham 2002, lemma 3.1). So the
/// error is below `24 * 16 u = 4.27e-14` of it; the rest covers the roundings of the bound.
#[inline(always)]
pub(super) fn is_surely_inside(sites: [[f64; 3]; 5]) -> Option<bool> {
    let [a, b, c, d, e] = sites;
    let largest = |axis: usize| {
        let distance = |p: [f64; 3]| (p[axis] - e[axis]).abs();
        let larger = |x: f64, y: f64| if x > y { x } else { y };
        larger(
            larger(distance(a), distance(b)),
            larger(distance(c), distance(d)),
        )
    };
    let (x, y, z) = (largest(0), largest(1), largest(2));
    let bound = 4.4e-14 * (x * y * z) * (x * x + y * y + z * z);
    let determinant = InSphere(sites).value(|x, y| x - y);
    (determinant.abs() > bound).then_some(determinant > 0.0)
}

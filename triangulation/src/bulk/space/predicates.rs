//! What floating point is sure of, before the geometry is asked.

use crate::kernel::{ErrorBound, Filter, InSphere, Orientation3, Predicate};
use crate::num::{Sign, lattice};

use super::cell::{Cell, Corner, FACETS};
use super::source::Source;

/// How precisely floating point evaluates the determinants of some sites.
#[derive(Clone, Copy)]
pub(super) struct Precision {
    /// An orientation has the right sign if the absolute value of its determinant is larger.
    flatness: f64,
    /// An in-sphere test is not rounded at all if all differences of coordinates are smaller.
    exact: f64,
}

/// The value of `exact`, in units of which all coordinates are multiples. The determinant of an
/// in-sphere test is the sum of 72 products of five differences: if these are integers below `2^9`,
/// neither it nor any part of it exceeds `2^53`.
const EXACT: f64 = 512.0;

impl Precision {
    /// Returns the precision for sites with these extents along the axes. `numbers` are all of
    /// their coordinates, within the [range](crate::kernel::RANGE) of floating point.
    pub(super) fn of([x, y, z]: [f64; 3], numbers: impl Iterator<Item = f64>) -> Self {
        Precision {
            // Each of the six terms has eight roundings (Higham 2002, lemma 3.1).
            flatness: 6.0 * 9e-16 * x * y * z,
            exact: unit(numbers).map_or(0.0, |unit| EXACT * unit),
        }
    }

    /// Returns on which side of the sphere of four sites, a positive cell, the last site lies;
    /// `None` if one evaluation is not sure of it.
    ///
    /// Let `X`, `Y` and `Z` be the largest absolute differences to the last site. The determinant
    /// is a sum of 24 terms, none above `X Y Z (X^2 + Y^2 + Z^2)`, and on the path of each there
    /// are 16 roundings: of five differences, four products and seven sums (Higham 2002, lemma
    /// 3.1). So the error is below `24 * 16 u = 4.27e-14` of it; the rest covers the roundings of
    /// the bound.
    #[inline(always)]
    pub(super) fn side_of_sphere(&self, sites: [[f64; 3]; 5]) -> Option<Sign> {
        let [a, b, c, d, e] = sites;
        let larger = |x: f64, y: f64| if x > y { x } else { y };
        let largest = |axis: usize| {
            let distance = |p: [f64; 3]| (p[axis] - e[axis]).abs();
            larger(
                larger(distance(a), distance(b)),
                larger(distance(c), distance(d)),
            )
        };
        let (x, y, z) = (largest(0), largest(1), largest(2));
        let bound = 4.4e-14 * (x * y * z) * (x * x + y * y + z * z);
        let determinant = InSphere(sites).value(|x, y| x - y);
        let is_sure = determinant.abs() > bound || larger(x, larger(y, z)) < self.exact;
        is_sure.then(|| Sign::of(&determinant))
    }
}

/// Returns a power of two of which all numbers are multiples. `None` if a number is such a large
/// multiple that small ones among the differences are hardly to be expected.
///
/// `PERF:` of most sets of points, the first number ends the search.
fn unit(mut numbers: impl Iterator<Item = f64>) -> Option<f64> {
    const LARGEST: f64 = (1u64 << 40) as f64;
    numbers.try_fold(f64::INFINITY, |unit, x| {
        let bit = lattice::lowest_bit(x);
        let unit = bit.map_or(unit, |bit| unit.min(lattice::power_of_two(bit)));
        (x.abs() < LARGEST * unit).then_some(unit)
    })
}

/// The predicates of vertices.
#[derive(Clone, Copy)]
pub(super) struct Predicates<'a> {
    pub(super) source: Source<'a>,
    /// The points of the vertices.
    pub(super) ranks: &'a [u32],
    pub(super) precision: Precision,
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
        let flatness = self.precision.flatness;
        if determinant > flatness {
            Sign::Positive
        } else if determinant < -flatness {
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
    /// moment curve hardly any is, and on a lattice most points lie on them. The geometry would
    /// check the range of the sites again, and an error bound for each operation takes as long as
    /// the operations.
    #[inline(always)]
    fn in_sphere(&self, corners: &[Corner], vertices: [u32; 4], vertex: u32) -> bool {
        let (simplex, q) = (self.points(vertices), self.ranks[vertex as usize]);
        if !self.may_hide {
            let site = |v: u32| corners[v as usize].site;
            let [a, b, c, d] = vertices;
            let sites = [site(a), site(b), site(c), site(d), site(vertex)];
            let sign = self.precision.side_of_sphere(sites);
            match sign.or_else(|| ErrorBound::try_sign(&InSphere(sites))) {
                Some(Sign::Positive) => return true,
                Some(Sign::Negative) => return false,
                Some(Sign::Zero) => return (self.source.in_tied_sphere)(simplex, q),
                None => {}
            }
        }
        (self.source.in_sphere)(simplex, q)
    }
}

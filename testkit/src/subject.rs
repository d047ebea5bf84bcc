//! The only module in which the tests of lines call the crate that they test.

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::kernel::{
    Adaptive, Exact, Filter, Filtered, Kernel, Predicate, RANGE, Range,
};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{ConstrainedDelaunay, InputError, OnCrossing, Rounding};

use super::case::Case;

/// The default kernel in its range, exact numbers outside of it.
pub type AnyFinite = Filtered<WithinRange, Exact>;

#[derive(Debug, Clone, Copy, Default)]
pub struct WithinRange;

impl Filter for WithinRange {
    const RANGE: Range = Range::FINITE;

    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        let is_within = (0..P::AXES).all(|axis| predicate.axis(axis).all(|x| RANGE.admits(x)));
        is_within.then(|| Adaptive::sign(predicate))
    }
}

pub type Subject = ConstrainedDelaunay<Plane<AnyFinite>>;

/// A triangulation, and what it reports about its input.
#[derive(Debug)]
pub struct Built {
    pub triangulation: Subject,
    /// The vertex of each input point.
    pub vertices: Vec<VertexId>,
    /// The vertices of each line, in order.
    pub chains: Vec<Vec<VertexId>>,
    /// How crossings were rounded; `None` if there are none.
    pub rounding: Option<Rounding>,
}

pub fn build(case: &Case) -> Result<Built, InputError> {
    let (triangulation, vertices) = Subject::from_lines(
        Plane::default(),
        &case.points,
        &case.lines,
        OnCrossing::Split,
    )?;
    let chains = triangulation
        .lines()
        .map(|line| triangulation.chain(line))
        .collect();
    let rounding = triangulation.rounding();
    Ok(Built {
        triangulation,
        vertices,
        chains,
        rounding,
    })
}

use super::Tin;
use crate::crs::Crs;
use crate::error::Result;

/// Which height stands where several points share one place in plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DuplicateRule {
    /// The lowest: what is left of vegetation and noise lies above the ground.
    #[default]
    Lowest,
    /// The highest.
    Highest,
    /// The mean, summed from the lowest up.
    Mean,
    /// The one that came first; depends on the order of the input.
    First,
    /// The one that came last; depends on the order of the input.
    Last,
}

/// Collects points and lines and makes a [`Tin`] of them.
#[derive(Debug, Default)]
pub struct TinBuilder {
    /// Which height stands where several points share one place.
    pub duplicates: DuplicateRule,
    /// Faces that can be reached from outside over unconstrained edges longer than this are left
    /// out; `None` keeps the whole convex hull.
    pub max_edge: Option<f64>,
    /// Coordinate system of everything that is added.
    pub crs: Option<Crs>,
}

/// What a [`TinBuilder`] took and made.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TinReport {
    /// Points added.
    pub points: usize,
    /// Points that share a place with another point and were merged into it.
    pub duplicates: usize,
    /// Points that gave way to a breakline's vertex at the same place.
    pub points_on_breaklines: usize,
    /// Breaklines added (parts and rings count one each).
    pub breaklines: usize,
    /// Edges of the triangulation that are breaklines.
    pub constrained_edges: usize,
    /// Places where breaklines cross between their vertices.
    pub crossings: usize,
    /// Vertices of the surface.
    pub vertices: usize,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Triangles left out by `max_edge`.
    pub faces_beyond_max_edge: usize,
    /// Triangles left out by the boundary or the bounds.
    pub faces_clipped: usize,
}

impl TinBuilder {
    /// Adds points given as columns of equal length.
    pub fn add_points(&mut self, _x: &[f64], _y: &[f64], _z: &[f64]) {}

    /// Adds a breakline: its vertices and the straight pieces between them hold in the surface.
    pub fn add_breakline(&mut self, _line: &[[f64; 3]]) {}

    /// Clips the surface to a polygon (rings; nested rings are holes, then islands). Heights along
    /// the rings are taken from the surface. May be called several times: what is inside any
    /// polygon stays.
    pub fn add_boundary(&mut self, _rings: &[Vec<[f64; 2]>]) {}

    /// Makes the TIN.
    ///
    /// # Errors
    /// If a coordinate is not finite, there are more points than 32-bit numbers can count, or
    /// nothing spans an area.
    pub fn build(self) -> Result<Tin> {
        Ok(Tin { report: TinReport::default(), crs: self.crs })
    }
}

//! Building the triangulation for the verb, as plain lists.

use std::collections::HashMap;

use crate::triangulation::geometry::Plane;
use crate::triangulation::kernel::{Kernel, twice_area};
use crate::triangulation::num::unsigned_zero;
use crate::triangulation::refine::{Quality, Shortfall};
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, InputError, LineId, Location, OnCrossing};

/// A triangulation of points and segments, as plain lists. Vertices have numbers of their own.
#[derive(Debug, Default)]
pub(super) struct Built {
    /// The positions of the vertices.
    pub(super) vertices: Vec<[f64; 2]>,
    /// The vertex of each point; points at the same position have the same vertex.
    pub(super) vertex_of: Vec<u32>,
    /// The triangles; empty if all points are on one line.
    pub(super) faces: Vec<Face>,
    /// The vertices along each segment.
    pub(super) chains: Vec<Vec<u32>>,
    /// The location of each seed.
    pub(super) seeds: Vec<SeedLocation>,
    /// For each added vertex that is not at a crossing of segments: the corners of the triangle
    /// that contained it before refinement, and their weights at the vertex.
    pub(super) between: HashMap<u32, ([u32; 3], [f64; 3])>,
    /// The reasons why triangles are not as requested.
    pub(super) shortfall: Vec<Shortfall>,
}

/// A triangle; side `i` is opposite corner `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Face {
    /// Counter-clockwise.
    pub(super) corners: [u32; 3],
    pub(super) neighbors: [Option<u32>; 3],
    pub(super) is_constrained: [bool; 3],
}

/// The location of a seed among the constraints of a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SeedLocation {
    /// In this face, or on an edge or a vertex of it that is not on a constraint.
    Face(u32),
    /// On a constraint: its side is ambiguous.
    Constraint,
    Outside,
}

/// Triangulates points and segments, refines the triangulation if a quality is given, and locates
/// the seeds. The line id of each segment is its position in the list.
pub(super) fn build<K: Kernel>(
    points: &[[f64; 2]],
    segments: &[[u32; 2]],
    seeds: &[[f64; 2]],
    on_crossing: OnCrossing,
    quality: Option<&Quality<'_>>,
) -> Result<Built, InputError> {
    // Negative zero becomes zero: sites are compared bit by bit when sorted.
    let sites: Vec<[f64; 2]> = points.iter().map(|p| p.map(unsigned_zero)).collect();
    let (coarse, vertices) =
        ConstrainedDelaunay::from_lines(Plane::<K>::default(), &sites, segments, on_crossing)?;
    let refined = quality.map(|quality| coarse.clone().refined(quality));
    let t = refined.as_deref().unwrap_or(&coarse);
    let chains: Vec<Vec<VertexId>> = (0..segments.len())
        .map(|i| t.chain(LineId::new(i)))
        .collect();

    // Vertices that were added and removed again leave unused numbers.
    let mut numbers = vec![u32::MAX; t.tds().vertex_slots()];
    for (number, v) in (0..).zip(t.tds().vertices()) {
        numbers[v.index()] = number;
    }
    let number = |v: &VertexId| numbers[v.index()];
    let cells: Vec<CellId> = if t.dimension() == 2 {
        t.finite_cells().collect()
    } else {
        Vec::new()
    };
    let mut face_of = vec![None; t.tds().cell_slots()];
    for (face, cell) in (0u32..).zip(&cells) {
        face_of[cell.index()] = Some(face);
    }
    let face = |cell: &CellId| Face {
        corners: t.tds().corners(*cell).map(|v| number(&v)),
        neighbors: [0, 1, 2].map(|i| face_of[t.tds().neighbor(*cell, i).index()]),
        is_constrained: [0, 1, 2].map(|i| t.is_constrained(*cell, i)),
    };
    Ok(Built {
        vertices: t.tds().vertices().map(|v| *t.point(v)).collect(),
        vertex_of: vertices.iter().map(number).collect(),
        faces: cells.iter().map(face).collect(),
        chains: chains
            .iter()
            .map(|chain| chain.iter().map(number).collect())
            .collect(),
        seeds: seeds
            .iter()
            .map(|p| locate_seed(t, &face_of, p.map(unsigned_zero)))
            .collect(),
        between: refined
            .iter()
            .flat_map(|refined| refined.added())
            .filter_map(|v| {
                let (corners, weights) = weights(&coarse, t.point(*v))?;
                Some((number(v), (corners.map(|v| number(&v)), weights)))
            })
            .collect(),
        shortfall: refined
            .iter()
            .flat_map(|refined| refined.shortfall())
            .map(|&(_, why)| why)
            .collect(),
    })
}

/// Returns the corners of the triangle that contains a point, and their barycentric weights.
fn weights<K: Kernel>(
    t: &ConstrainedDelaunay<Plane<K>>,
    p: &[f64; 2],
) -> Option<([VertexId; 3], [f64; 3])> {
    let cell = match t.locate(p, None) {
        Location::Cell { cell, .. } => cell,
        // Outside of the hull by rounding only.
        Location::OutsideHull { cell } => t
            .tds()
            .neighbor(cell, t.tds().index_of(cell, VertexId::INFINITE)?),
        Location::Vertex(_) | Location::OutsideAffineHull | Location::Nowhere => return None,
    };
    let corners = *t.tds().corners(cell);
    let [a, b, c] = corners.map(|v| *t.point(v));
    let whole = twice_area(a, b, c);
    Some((
        corners,
        [
            twice_area(b, c, *p),
            twice_area(c, a, *p),
            twice_area(a, b, *p),
        ]
        .map(|part| part / whole),
    ))
}

fn locate_seed<K: Kernel>(
    t: &ConstrainedDelaunay<Plane<K>>,
    face_of: &[Option<u32>],
    p: [f64; 2],
) -> SeedLocation {
    if t.dimension() < 2 {
        return SeedLocation::Outside;
    }
    let in_face =
        |cell: CellId| face_of[cell.index()].map_or(SeedLocation::Outside, SeedLocation::Face);
    match t.locate(&p, None) {
        Location::Vertex(v) if t.constrained_around(v).next().is_some() => SeedLocation::Constraint,
        Location::Vertex(v) => t
            .tds()
            .around(v)
            .find_map(|cell| face_of[cell.index()])
            .map_or(SeedLocation::Outside, SeedLocation::Face),
        Location::Cell { cell, facets } => match facets.iter().any(|i| t.is_constrained(cell, i)) {
            true => SeedLocation::Constraint,
            false => in_face(cell),
        },
        // `Nowhere` is a coordinate larger, or nearer to zero, than any vertex can have.
        Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => {
            SeedLocation::Outside
        }
    }
}

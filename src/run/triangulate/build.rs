//! Building the triangulation for the verb, as plain lists.

use super::between::{Before, Between};
use crate::triangulation::geometry::Plane;
use crate::triangulation::kernel::Kernel;
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
    /// The vertices along each segment that is traced; empty for the others.
    pub(super) chains: Vec<Vec<u32>>,
    /// The location of each seed.
    pub(super) seeds: Vec<SeedLocation>,
    /// The number of vertices that the refinement added.
    pub(super) added: usize,
    /// If weights are requested, the triangle before of each vertex that the refinement added,
    /// unless it is on a chain; in order.
    pub(super) between: Vec<Between<u32>>,
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

/// What is computed for each vertex that a refinement adds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OfAdded {
    Position,
    /// Also its triangle before the refinement. The triangles are kept meanwhile.
    Weights,
}

/// Triangulates points and segments, refines the triangulation if a quality is given, and locates
/// the seeds. The line id of each segment is its position in the list. `is_traced` says for each
/// segment if it is traced; without triangles, all are.
pub(super) fn build<K: Kernel>(
    points: &[[f64; 2]],
    segments: &[[u32; 2]],
    is_traced: &[bool],
    seeds: &[[f64; 2]],
    on_crossing: OnCrossing,
    quality: Option<(&Quality<'_>, OfAdded)>,
) -> Result<Built, InputError> {
    // Negative zero becomes zero: sites are compared bit by bit when sorted.
    let sites: Vec<[f64; 2]> = points.iter().map(|p| p.map(unsigned_zero)).collect();
    let (t, vertices) =
        ConstrainedDelaunay::from_lines(Plane::<K>::default(), &sites, segments, on_crossing)?;
    let Some((quality, of_added)) = quality else {
        return Ok(listed(&t, &numbers(&t), &vertices, is_traced, seeds));
    };
    let before = (of_added == OfAdded::Weights)
        .then(|| Before::of(&t))
        .flatten();
    let refined = t.refined(quality);
    let numbers = numbers(&refined);
    let built = listed(&refined, &numbers, &vertices, is_traced, seeds);
    let between = before.map_or_else(Vec::new, |before| {
        let mut is_on_chain = vec![false; built.vertices.len()];
        built
            .chains
            .iter()
            .flatten()
            .for_each(|&v| is_on_chain[v as usize] = true);
        let number = |v: VertexId| numbers[v.index()];
        let all = before.between(&refined, |v| !is_on_chain[number(v) as usize]);
        let numbered = |between: Between<VertexId>| between.map(number);
        all.into_iter().map(numbered).collect()
    });
    let why = refined.shortfall().iter().map(|&(_, why)| why);
    Ok(Built {
        added: refined.added().len(),
        between,
        shortfall: why.collect(),
        ..built
    })
}

/// Returns the number of each vertex among those in use: vertices that were added and removed again
/// leave unused ids.
fn numbers<K: Kernel>(t: &ConstrainedDelaunay<Plane<K>>) -> Vec<u32> {
    let mut numbers = vec![u32::MAX; t.tds().vertex_slots()];
    for (number, v) in (0..).zip(t.tds().vertices()) {
        numbers[v.index()] = number;
    }
    numbers
}

/// Returns the lists of a triangulation, given the numbers of its vertices.
fn listed<K: Kernel>(
    t: &ConstrainedDelaunay<Plane<K>>,
    numbers: &[u32],
    vertices: &[VertexId],
    is_traced: &[bool],
    seeds: &[[f64; 2]],
) -> Built {
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
    // Without triangles, only chains have edges.
    let chain = |(segment, &is_traced): (usize, &bool)| {
        if is_traced || cells.is_empty() {
            t.chain(LineId::new(segment)).iter().map(number).collect()
        } else {
            Vec::new()
        }
    };
    Built {
        vertices: t.tds().vertices().map(|v| *t.point(v)).collect(),
        vertex_of: vertices.iter().map(number).collect(),
        faces: cells.iter().map(face).collect(),
        chains: is_traced.iter().enumerate().map(chain).collect(),
        seeds: seeds
            .iter()
            .map(|p| locate_seed(t, &face_of, p.map(unsigned_zero)))
            .collect(),
        ..Built::default()
    }
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

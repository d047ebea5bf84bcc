//! Flaws of a triangulation in space that was read from a file.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use super::super::context::{Context, Size, Stage};
use super::super::open;
use super::FACETS;
use crate::error::Result;
use crate::io::Watch;
use crate::io::tetgen::{self, Tetrahedralized};
use crate::triangulation::kernel::{InSphere, Kernel, Orientation3, Wide};
use crate::triangulation::num::Sign;

/// What is wrong with a triangulation in space. Tetrahedra and vertices have the numbers of the
/// file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SpaceFlaw {
    /// The corners of a tetrahedron lie in a plane.
    Flat(u32),
    /// Two tetrahedra overlap: they lie on the same side of their common facet.
    Folded(u32, u32),
    /// A facet belongs to more than two tetrahedra.
    Crowded([u32; 3]),
    /// The `.neigh` states another neighbor opposite a corner (from 0) of a tetrahedron.
    Neighbor(u32, usize),
    /// The surface of all tetrahedra is not convex at an edge.
    Dent([u32; 2]),
    /// The tetrahedra are not connected by facets.
    Apart,
    /// A vertex lies inside the sphere of a tetrahedron next to it.
    NotDelaunay(u32, u32),
}

impl fmt::Display for SpaceFlaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SpaceFlaw::Flat(cell) => write!(f, "tetrahedron {cell}: its corners lie in a plane"),
            SpaceFlaw::Folded(a, b) => write!(f, "tetrahedra {a} and {b}: on the same side of their common facet"),
            SpaceFlaw::Crowded([a, b, c]) => write!(f, "facet {a} {b} {c}: more than two tetrahedra have it"),
            SpaceFlaw::Neighbor(cell, i) => {
                write!(f, "tetrahedron {cell}: the .neigh states another neighbor opposite corner {}", i + 1)
            }
            SpaceFlaw::Dent([a, b]) => write!(f, "edge {a} {b}: the hull is not convex there"),
            SpaceFlaw::Apart => write!(f, "the tetrahedra are in several parts"),
            SpaceFlaw::NotDelaunay(cell, vertex) => {
                write!(f, "tetrahedron {cell}: vertex {vertex} is inside of its sphere")
            }
        }
    }
}

/// A triangulation in space, counted, and its flaws.
#[derive(Debug)]
#[non_exhaustive]
pub struct SpaceCheck {
    /// The number of vertices.
    pub vertices: usize,
    /// The number of tetrahedra.
    pub tetrahedra: usize,
    /// The flaws; empty if it is a Delaunay triangulation of its convex hull.
    pub flaws: Vec<SpaceFlaw>,
}

/// Checks the tetrahedra of an `.ele` with the `.node` next to it, and the `.neigh` if there is
/// one: neighbors, orientation, a convex hull, and the Delaunay law across each facet, all with
/// exact predicates.
///
/// Where all of this holds, the triangulation is Delaunay: what is locally convex in the lifted
/// space is convex (Devillers et al. 1998, "Checking the Convexity of Polytopes").
///
/// # Errors
/// If a file is damaged, or the run is canceled.
pub fn check_space(path: &Path, context: &Context) -> Result<SpaceCheck> {
    let triangulated = open::reading_stage(path, context, |watch: Watch| tetgen::read(path, watch))?;
    let work = context.start(Stage::CheckingFaces, Size::Uncounted)?;
    let flaws = flaws(&triangulated);
    work.end()?;
    Ok(SpaceCheck { vertices: triangulated.nodes.points.len(), tetrahedra: triangulated.tetrahedra.len(), flaws })
}

/// A tetrahedron, and one of its facets by the corner opposite to it.
type Side = (u32, usize);

fn flaws(triangulated: &Tetrahedralized) -> Vec<SpaceFlaw> {
    let Tetrahedralized { nodes, tetrahedra, neighbors: stated } = triangulated;
    let first = nodes.first_number;
    let point = |v: u32| nodes.points[v as usize];
    let orientation = |corners: [u32; 4]| Wide::sign(&Orientation3(corners.map(point)));
    let signs: Vec<Sign> = tetrahedra.iter().map(|&corners| orientation(corners)).collect();
    let mut flaws: Vec<SpaceFlaw> = Vec::new();
    flaws.extend((first..).zip(&signs).filter(|(_, sign)| **sign == Sign::Zero).map(|(cell, _)| SpaceFlaw::Flat(cell)));

    let mut facets: Vec<([u32; 3], Side)> = Vec::with_capacity(4 * tetrahedra.len());
    for (cell, corners) in (0..).zip(tetrahedra) {
        for (i, facet) in FACETS.iter().enumerate() {
            let mut facet = facet.map(|k| corners[k]);
            facet.sort_unstable();
            facets.push((facet, (cell, i)));
        }
    }
    facets.sort_unstable();
    let mut neighbors = vec![[None; 4]; tetrahedra.len()];
    let mut hull: Vec<Side> = Vec::new();
    for group in facets.chunk_by(|a, b| a.0 == b.0) {
        match *group {
            [(_, side)] => hull.push(side),
            [(facet, (a, i)), (_, (b, j))] => {
                neighbors[a as usize][i] = Some(b);
                neighbors[b as usize][j] = Some(a);
                let [p, q] = [(a, i), (b, j)].map(|(cell, i)| tetrahedra[cell as usize][i]);
                let [p, q] = [p, q].map(|apex| orientation([facet[0], facet[1], facet[2], apex]));
                if p * q == Sign::Positive {
                    flaws.push(SpaceFlaw::Folded(a + first, b + first));
                }
            }
            [(facet, _), ..] => flaws.push(SpaceFlaw::Crowded(facet.map(|v| v + first))),
            [] => {}
        }
    }
    for (cell, (found, stated)) in (first..).zip(neighbors.iter().zip(stated)) {
        flaws.extend((0..4).filter(|&i| found[i] != stated[i]).map(|i| SpaceFlaw::Neighbor(cell, i)));
    }
    if !flaws.is_empty() || tetrahedra.is_empty() {
        return flaws;
    }

    let mut is_seen = vec![false; tetrahedra.len()];
    let mut seen = vec![0u32];
    is_seen[0] = true;
    while let Some(cell) = seen.pop() {
        for next in neighbors[cell as usize].into_iter().flatten() {
            if !std::mem::replace(&mut is_seen[next as usize], true) {
                seen.push(next);
            }
        }
    }
    if is_seen.contains(&false) {
        flaws.push(SpaceFlaw::Apart);
    }
    for (cell, around) in (0u32..).zip(&neighbors) {
        for next in around.iter().flatten().filter(|&&next| next > cell) {
            let corners = tetrahedra[cell as usize];
            let [a, b, c, d] = corners.map(point);
            for &vertex in tetrahedra[*next as usize].iter().filter(|v| !corners.contains(v)) {
                let side = Wide::sign(&InSphere([a, b, c, d, point(vertex)])) * signs[cell as usize];
                if side == Sign::Positive {
                    flaws.push(SpaceFlaw::NotDelaunay(cell + first, vertex + first));
                }
            }
        }
    }
    flaws.extend(
        dents(tetrahedra, &signs, &hull, &orientation).into_iter().map(|edge| SpaceFlaw::Dent(edge.map(|v| v + first))),
    );
    flaws
}

/// Returns the edges of the hull at which it is not convex: those that have not exactly two facets,
/// or one of whose facets has the other on its outer side.
fn dents(
    tetrahedra: &[[u32; 4]],
    signs: &[Sign],
    hull: &[Side],
    orientation: &impl Fn([u32; 4]) -> Sign,
) -> Vec<[u32; 2]> {
    let mut around: HashMap<[u32; 2], Vec<([u32; 3], u32)>> = HashMap::new();
    for &(cell, i) in hull {
        let corners = tetrahedra[cell as usize];
        let mut facet = FACETS[i].map(|k| corners[k]);
        if signs[cell as usize] == Sign::Negative {
            facet.swap(0, 1);
        }
        let [a, b, c] = facet;
        for (p, q, apex) in [(a, b, c), (b, c, a), (c, a, b)] {
            around.entry([p.min(q), p.max(q)]).or_default().push((facet, apex));
        }
    }
    // Facets are counter-clockwise as seen from outside: positive is what lies beyond.
    let is_dent = |facets: &[([u32; 3], u32)]| match *facets {
        [([a, b, c], _), (_, apex)] => orientation([a, b, c, apex]) == Sign::Positive,
        _ => true,
    };
    let mut dents: Vec<[u32; 2]> = around.iter().filter(|(_, facets)| is_dent(facets)).map(|(edge, _)| *edge).collect();
    dents.sort_unstable();
    dents
}

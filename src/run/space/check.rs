//! Flaws of a triangulation in space that was read from a file.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use super::{FACETS, weights};
use crate::error::Result;
use crate::io::Watch;
use crate::io::tetgen::{self, Tetrahedralized};
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::sources::open;
use crate::triangulation::kernel::{
    InSphere, Kernel, Orientation2, Orientation3, PowerTest3, Wide,
};
use crate::triangulation::num::Sign;

/// The law that a triangulation in space is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpaceLaw {
    /// No vertex lies inside of the sphere of a tetrahedron.
    Delaunay,
    /// No vertex has a negative power to the sphere that is orthogonal to those of the corners of a
    /// tetrahedron. The weights are those of the `.weights` next to the file (one number a line),
    /// else the first attribute of the vertices.
    Regular,
}

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
    /// A vertex lies inside the sphere of a tetrahedron next to it, or has a negative power to it.
    NotDelaunay(u32, u32),
    /// A vertex is in no tetrahedron, although no other vertex is at its position, and the weights
    /// of others do not hide it.
    LeftOut(u32),
    /// There are no tetrahedra, but the vertices are not coplanar.
    Empty,
}

impl fmt::Display for SpaceFlaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SpaceFlaw::Flat(cell) => write!(f, "tetrahedron {cell}: its corners lie in a plane"),
            SpaceFlaw::Folded(a, b) => write!(
                f,
                "tetrahedra {a} and {b}: on the same side of their common facet"
            ),
            SpaceFlaw::Crowded([a, b, c]) => {
                write!(f, "facet {a} {b} {c}: more than two tetrahedra have it")
            }
            SpaceFlaw::Neighbor(cell, i) => {
                write!(
                    f,
                    "tetrahedron {cell}: the .neigh states another neighbor opposite corner {}",
                    i + 1
                )
            }
            SpaceFlaw::Dent([a, b]) => write!(f, "edge {a} {b}: the hull is not convex there"),
            SpaceFlaw::Apart => write!(f, "the tetrahedra are in several parts"),
            SpaceFlaw::LeftOut(vertex) => {
                write!(f, "vertex {vertex}: it is in no tetrahedron, but should be")
            }
            SpaceFlaw::Empty => write!(
                f,
                "there are no tetrahedra, but the vertices are not in one plane"
            ),
            SpaceFlaw::NotDelaunay(cell, vertex) => {
                write!(
                    f,
                    "tetrahedron {cell}: vertex {vertex} is inside of its sphere"
                )
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
    /// The flaws; empty if it is the Delaunay (regular) triangulation of all vertices, or one of
    /// several where there are ties.
    pub flaws: Vec<SpaceFlaw>,
}

/// Checks the tetrahedra of an `.ele` with the `.node` next to it, and the `.neigh` if there is
/// one: neighbors, orientation, a convex hull, the law across each facet, and vertices that were
/// left out, all with exact predicates.
///
/// Where all of this holds, the law holds everywhere: what is locally convex in the lifted space is
/// convex (Devillers et al. 1998, "Checking the Convexity of Polytopes").
///
/// # Errors
/// If a file is damaged, weights are missing, or the run is canceled.
pub fn check_space(path: &Path, law: SpaceLaw, context: &Context) -> Result<SpaceCheck> {
    let journal = Journal::new(context);
    let (triangulated, warnings) =
        open::reading_stage(path, context, |watch: Watch| tetgen::read(path, watch))?;
    journal.add_warnings(path, &warnings);
    let weights = match law {
        SpaceLaw::Delaunay => None,
        SpaceLaw::Regular => Some(weights(path, &triangulated.nodes, &journal)?),
    };
    let work = context.start(Stage::CheckingFaces, Size::Uncounted)?;
    let flaws = flaws(&triangulated, weights.as_deref());
    work.end()?;
    Ok(SpaceCheck {
        vertices: triangulated.nodes.points.len(),
        tetrahedra: triangulated.tetrahedra.len(),
        flaws,
    })
}

/// A tetrahedron, and one of its facets by the corner opposite to it.
type CellFacet = (u32, usize);

/// Returns the flaws of a triangulation; those that a check needs to be absent end the search.
fn flaws(triangulated: &Tetrahedralized, weights: Option<&[f64]>) -> Vec<SpaceFlaw> {
    let checked = Checked::new(triangulated, weights);
    let mut flaws = checked.flat();
    let (facets, of_facets) = checked.facets();
    flaws.extend(of_facets);
    flaws.extend(checked.wrong_neighbors(&facets));
    if checked.tetrahedra.is_empty() && !is_flat(&triangulated.nodes.points) {
        flaws.push(SpaceFlaw::Empty);
    }
    if !flaws.is_empty() || checked.tetrahedra.is_empty() {
        return flaws;
    }
    if !is_connected(&facets.neighbors) {
        flaws.push(SpaceFlaw::Apart);
    }
    flaws.extend(checked.broken_law(&facets));
    let dents = dents(
        checked.tetrahedra,
        &checked.signs,
        &facets.hull,
        &|corners| checked.orientation(corners),
    );
    flaws.extend(
        dents
            .into_iter()
            .map(|edge| SpaceFlaw::Dent(edge.map(|v| v + checked.first))),
    );
    if flaws.is_empty() {
        flaws = checked.left_out(&facets);
    }
    flaws
}

/// A triangulation that is checked, with the orientations of its tetrahedra.
struct Checked<'a> {
    points: &'a [[f64; 3]],
    weights: Option<&'a [f64]>,
    tetrahedra: &'a [[u32; 4]],
    /// The neighbors that a file states.
    stated: &'a [[Option<u32>; 4]],
    signs: Vec<Sign>,
    /// The number of the first tetrahedron and of the first vertex in the file.
    first: u32,
}

/// How tetrahedra are connected.
struct Facets {
    neighbors: Vec<[Option<u32>; 4]>,
    /// The facets that only one tetrahedron has.
    hull: Vec<CellFacet>,
}

impl<'a> Checked<'a> {
    fn new(triangulated: &'a Tetrahedralized, weights: Option<&'a [f64]>) -> Self {
        let Tetrahedralized {
            nodes,
            tetrahedra,
            neighbors: stated,
        } = triangulated;
        let mut checked = Checked {
            points: &nodes.points,
            weights,
            tetrahedra,
            stated,
            signs: Vec::new(),
            first: nodes.first_number,
        };
        checked.signs = tetrahedra
            .iter()
            .map(|&corners| checked.orientation(corners))
            .collect();
        checked
    }

    fn orientation(&self, corners: [u32; 4]) -> Sign {
        Wide::sign(&Orientation3(corners.map(|v| self.points[v as usize])))
    }

    /// Returns true if a vertex is inside the sphere of a tetrahedron, or has a negative power to
    /// it.
    fn is_in_sphere(&self, cell: u32, vertex: u32) -> bool {
        let [a, b, c, d] = self.tetrahedra[cell as usize];
        let point = |v: u32| self.points[v as usize];
        let sign = match self.weights {
            None => Wide::sign(&InSphere([a, b, c, d, vertex].map(point))),
            Some(weights) => Wide::sign(&PowerTest3([a, b, c, d, vertex].map(|v| {
                let [x, y, z] = point(v);
                [x, y, z, weights[v as usize]]
            }))),
        };
        sign * self.signs[cell as usize] == Sign::Positive
    }

    /// Returns the tetrahedra whose corners lie in a plane.
    fn flat(&self) -> Vec<SpaceFlaw> {
        let flat = (self.first..)
            .zip(&self.signs)
            .filter(|(_, sign)| **sign == Sign::Zero);
        flat.map(|(cell, _)| SpaceFlaw::Flat(cell)).collect()
    }

    /// Returns how tetrahedra are connected, and the facets on one side of which they overlap, or
    /// that too many have.
    fn facets(&self) -> (Facets, Vec<SpaceFlaw>) {
        let mut all: Vec<([u32; 3], CellFacet)> = Vec::with_capacity(4 * self.tetrahedra.len());
        for (cell, corners) in (0..).zip(self.tetrahedra) {
            for (i, facet) in FACETS.iter().enumerate() {
                let mut facet = facet.map(|k| corners[k]);
                facet.sort_unstable();
                all.push((facet, (cell, i)));
            }
        }
        all.sort_unstable();
        let mut facets = Facets {
            neighbors: vec![[None; 4]; self.tetrahedra.len()],
            hull: Vec::new(),
        };
        let mut flaws = Vec::new();
        for group in all.chunk_by(|a, b| a.0 == b.0) {
            match *group {
                [(_, side)] => facets.hull.push(side),
                [(facet, (a, i)), (_, (b, j))] => {
                    facets.neighbors[a as usize][i] = Some(b);
                    facets.neighbors[b as usize][j] = Some(a);
                    let [p, q] =
                        [(a, i), (b, j)].map(|(cell, i)| self.tetrahedra[cell as usize][i]);
                    let [p, q] =
                        [p, q].map(|apex| self.orientation([facet[0], facet[1], facet[2], apex]));
                    if p * q == Sign::Positive {
                        flaws.push(SpaceFlaw::Folded(a + self.first, b + self.first));
                    }
                }
                [(facet, _), ..] => flaws.push(SpaceFlaw::Crowded(facet.map(|v| v + self.first))),
                [] => {}
            }
        }
        (facets, flaws)
    }

    /// Returns the neighbors that a file states otherwise.
    fn wrong_neighbors(&self, facets: &Facets) -> Vec<SpaceFlaw> {
        let mut flaws = Vec::new();
        for (cell, (found, stated)) in (self.first..).zip(facets.neighbors.iter().zip(self.stated))
        {
            flaws.extend(
                (0..4)
                    .filter(|&i| found[i] != stated[i])
                    .map(|i| SpaceFlaw::Neighbor(cell, i)),
            );
        }
        flaws
    }

    /// Returns the vertices that break the law of a neighbor's tetrahedron.
    fn broken_law(&self, facets: &Facets) -> Vec<SpaceFlaw> {
        let mut flaws = Vec::new();
        for (cell, around) in (0u32..).zip(&facets.neighbors) {
            for next in around.iter().flatten().filter(|&&next| next > cell) {
                let corners = self.tetrahedra[cell as usize];
                for &vertex in self.tetrahedra[*next as usize]
                    .iter()
                    .filter(|v| !corners.contains(v))
                {
                    if self.is_in_sphere(cell, vertex) {
                        flaws.push(SpaceFlaw::NotDelaunay(
                            cell + self.first,
                            vertex + self.first,
                        ));
                    }
                }
            }
        }
        flaws
    }

    /// Returns the vertices that are in no tetrahedron, but should be. No other flaw may be there.
    fn left_out(&self, facets: &Facets) -> Vec<SpaceFlaw> {
        let mut is_used = vec![false; self.points.len()];
        self.tetrahedra
            .as_flattened()
            .iter()
            .for_each(|&v| is_used[v as usize] = true);
        let mut flaws = Vec::new();
        let mut cell = 0;
        for vertex in (0..)
            .zip(&is_used)
            .filter(|(_, is_used)| !**is_used)
            .map(|(vertex, _)| vertex)
        {
            let found = walk(self.tetrahedra, &facets.neighbors, cell, |cell, i| {
                let mut corners = self.tetrahedra[cell as usize];
                corners[i] = vertex;
                self.orientation(corners) * self.signs[cell as usize] == Sign::Negative
            });
            cell = found.unwrap_or(cell);
            if found.is_none_or(|cell| self.is_in_sphere(cell, vertex)) {
                flaws.push(SpaceFlaw::LeftOut(vertex + self.first));
            }
        }
        flaws
    }
}

/// Returns true if all tetrahedra can be reached from the first one across facets.
fn is_connected(neighbors: &[[Option<u32>; 4]]) -> bool {
    let mut is_seen = vec![false; neighbors.len()];
    let mut seen = vec![0u32];
    is_seen[0] = true;
    while let Some(cell) = seen.pop() {
        for next in neighbors[cell as usize].into_iter().flatten() {
            if !std::mem::replace(&mut is_seen[next as usize], true) {
                seen.push(next);
            }
        }
    }
    !is_seen.contains(&false)
}

/// Returns the tetrahedron that no facet separates from a point; `None` if the point is outside of
/// all. Such walks end where the law holds (Edelsbrunner 1989, "An acyclicity theorem for cell
/// complexes in d dimensions"); elsewhere after as many steps as there are tetrahedra.
fn walk(
    tetrahedra: &[[u32; 4]],
    neighbors: &[[Option<u32>; 4]],
    start: u32,
    is_beyond: impl Fn(u32, usize) -> bool,
) -> Option<u32> {
    let mut cell = start;
    for _ in tetrahedra {
        match (0..4).find(|&i| is_beyond(cell, i)) {
            None => return Some(cell),
            Some(i) => cell = neighbors[cell as usize][i]?,
        }
    }
    None
}

/// Returns true if all points lie in a plane.
fn is_flat(points: &[[f64; 3]]) -> bool {
    let Some(&a) = points.first() else {
        return true;
    };
    let Some(&b) = points.iter().find(|&&b| b != a) else {
        return true;
    };
    let turns = |c: [f64; 3]| {
        let turn = |axes: [usize; 2]| {
            Wide::sign(&Orientation2([a, b, c].map(|p| axes.map(|axis| p[axis]))))
        };
        [[0, 1], [1, 2], [2, 0]]
            .into_iter()
            .any(|axes| turn(axes) != Sign::Zero)
    };
    let Some(&c) = points.iter().find(|&&c| turns(c)) else {
        return true;
    };
    points
        .iter()
        .all(|&d| Wide::sign(&Orientation3([a, b, c, d])) == Sign::Zero)
}

/// Returns the edges of the hull at which it is not convex: those that have not exactly two facets,
/// or one of whose facets has the other on its outer side.
fn dents(
    tetrahedra: &[[u32; 4]],
    signs: &[Sign],
    hull: &[CellFacet],
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
            around
                .entry([p.min(q), p.max(q)])
                .or_default()
                .push((facet, apex));
        }
    }
    // Facets are counter-clockwise as seen from outside: positive is what lies beyond.
    let is_dent = |facets: &[([u32; 3], u32)]| match *facets {
        [([a, b, c], _), (_, apex)] => orientation([a, b, c, apex]) == Sign::Positive,
        _ => true,
    };
    let mut dents: Vec<[u32; 2]> = around
        .iter()
        .filter(|(_, facets)| is_dent(facets))
        .map(|(edge, _)| *edge)
        .collect();
    dents.sort_unstable();
    dents
}

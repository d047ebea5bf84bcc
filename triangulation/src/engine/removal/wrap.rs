//! The hole that a vertex within the hull leaves in space, filled by gift wrapping with rounded
//! numbers, and the filling verified by predicates.
//!
//! From each facet of the hole, the cell within has the vertex that a growing sphere through the
//! facet meets first (Chand and Kapur 1970). Which one that is, rounded numbers say
//! ([`rough_lift`](Geometry::rough_lift)), or the predicates where these are close to each other.
//!
//! *What is verified, and why that is enough.* All new cells are positive, and each of their facets
//! is matched by one of the hole or by one of another cell, in the opposite direction. So they
//! cover the hole exactly once. And all facets between two new cells fulfil the law. Let `f` be the
//! function that is linear on each of them, and at each vertex has the height of its lift, ties
//! decided. It is convex along all segments within the hole. The triangulation `D` of all other
//! vertices fills the hole, too. On a cell of `D`, which is convex, `f` is at most linear between
//! the corners. Neither is it less, because no lift is below a lifted cell of `D`. So `f` is linear
//! on the cells of `D`; and since no other lift is on the hyperplane of such a cell, the cells are
//! the same.
//!
//! *Where it gives up*: on the hull, where there are many neighbors, where the geometry has no such
//! numbers, and where they mislead.

use crate::geometry::{Geometry, in_sphere};
use crate::num::Sign;
use crate::tds::space::OUTWARD;
use crate::tds::{CellId, FacetSide, VertexId};
use crate::triangulation::Triangulation;

/// The largest number of cells around a vertex. The work grows with its square.
const MOST_CELLS: usize = 256;

/// How many times more cells there may be in the filling than around the vertex.
const MOST_TIMES: usize = 4;

/// Numbers whose difference is a smaller part of their magnitude are compared by predicates.
const CLOSE: f64 = 1e-11;

/// The cells that fill a hole, and the two sides of each of their facets.
pub(super) struct Filling {
    pub(super) cells: Vec<[VertexId; 4]>,
    pub(super) sides: Vec<[FacetSide; 2]>,
}

/// Returns the cells that fill the hole which a vertex leaves, given the cells around it; `None` if
/// they are not found that way.
pub(super) fn filling<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    vertex: VertexId,
    star: &[(CellId, usize)],
) -> Option<Filling> {
    if !t.is_full() || star.len() > MOST_CELLS {
        return None;
    }
    let mut hole = Hole::new(t, vertex, star)?;
    while let Some(facet) = hole.open.pop() {
        hole.keys.pop();
        if hole.cells.len() == MOST_TIMES * star.len() {
            return None;
        }
        let apex = hole.apex(facet.corners)?;
        hole.fill(facet, apex)?;
    }
    let vertices = &hole.vertices;
    let of_cell = |cell: &[u8; 4]| cell.map(|k| vertices[k as usize]);
    Some(Filling {
        cells: hole.cells.iter().map(of_cell).collect(),
        sides: hole.sides,
    })
}

/// A facet that has a cell on one side only.
struct OpenFacet {
    /// With a vertex on the open side they are a positive cell.
    corners: [u8; 3],
    side: FacetSide,
}

/// What is left of a hole, and what fills the rest. Vertices are numbered from 0.
struct Hole<'t, G: Geometry<4>> {
    geometry: &'t G,
    vertices: Vec<VertexId>,
    points: Vec<&'t G::Point>,
    /// Their positions relative to the vertex that is removed, and their lifts.
    lifts: Vec<[f64; 4]>,
    /// The largest coordinate of these positions, and the largest lift, without their signs.
    reach: [f64; 2],
    open: Vec<OpenFacet>,
    /// The corners of each open facet in order of their numbers, as one number.
    keys: Vec<u32>,
    cells: Vec<[u8; 4]>,
    sides: Vec<[FacetSide; 2]>,
}

/// A vertex in front of a facet.
struct Candidate {
    vertex: u8,
    /// The volume with the facet.
    volume: f64,
    /// How far its lift is above the plane through those of the corners, along the facet.
    rise: f64,
    /// The volume may be zero or negative.
    is_flat: bool,
}

impl<'t, G: Geometry<4>> Hole<'t, G> {
    /// `None` on the hull, and if the geometry has no numbers.
    fn new<V, C: Copy + Default>(
        t: &'t Triangulation<G, 4, V, C>,
        vertex: VertexId,
        star: &[(CellId, usize)],
    ) -> Option<Self> {
        let count = star.len() / 2 + 2; // by Euler's relation
        let mut hole = Hole {
            geometry: &t.geometry,
            vertices: Vec::with_capacity(count),
            points: Vec::with_capacity(count),
            lifts: Vec::with_capacity(count),
            reach: [0.0; 2],
            open: Vec::with_capacity(2 * star.len()),
            keys: Vec::with_capacity(2 * star.len()),
            cells: Vec::with_capacity(star.len()),
            sides: Vec::with_capacity(3 * star.len()),
        };
        let origin = t.point(vertex);
        for &(cell, i) in star {
            let corners = t.tds.corners(cell);
            let [b, a, c] = OUTWARD[i].map(|k| corners[k]);
            let mut numbers = [0; 3];
            for (number, v) in numbers.iter_mut().zip([a, b, c]) {
                *number = match hole.vertices.iter().position(|&other| other == v) {
                    Some(known) => known as u8,
                    None => hole.add_vertex(t, v, origin)?,
                };
            }
            let beyond = t.tds.neighbor(cell, i);
            let j = t.tds.index_of_neighbor(beyond, cell);
            hole.open(numbers, FacetSide::Outside(beyond, j));
        }
        Some(hole)
    }

    fn add_vertex<V, C: Copy + Default>(
        &mut self,
        t: &'t Triangulation<G, 4, V, C>,
        vertex: VertexId,
        origin: &G::Point,
    ) -> Option<u8> {
        if vertex == VertexId::INFINITE {
            return None;
        }
        let point = t.point(vertex);
        let lift = self.geometry.rough_lift(point, origin)?;
        self.lifts.push(lift);
        let [x, y, z, height] = lift.map(f64::abs);
        let [reach, highest] = self.reach;
        self.reach = [reach.max(x).max(y).max(z), highest.max(height)];
        self.vertices.push(vertex);
        self.points.push(point);
        u8::try_from(self.vertices.len() - 1).ok()
    }

    fn open(&mut self, corners: [u8; 3], side: FacetSide) {
        self.keys.push(key(corners));
        self.open.push(OpenFacet { corners, side });
    }

    /// Returns the vertex of the cell in front of a facet.
    ///
    /// `PERF:` what is close is decided by bounds on all terms, the same for all vertices. To add
    /// up those of each took twice as many instructions.
    fn apex(&self, corners: [u8; 3]) -> Option<u8> {
        let [a, b, c] = corners.map(|k| self.lifts[k as usize]);
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = cross(u, v);
        let [along_u, along_v] = [cross(v, normal), cross(normal, u)];
        let scale = 1.0 / dot(normal, normal);
        let slope = [0, 1, 2].map(|k| scale * (u[3] * along_u[k] + v[3] * along_v[k]));
        let [reach, height] = self.reach;
        let flat = 2.0 * CLOSE * reach * sum_of_sizes(normal);
        let close = 2.0 * CLOSE * (height + reach * sum_of_sizes(slope));
        let mut best: Option<Candidate> = None;
        for (vertex, lift) in (0..).zip(&self.lifts) {
            let w = minus(*lift, a);
            let volume = dot(normal, w);
            if volume < -flat || corners.contains(&vertex) {
                continue;
            }
            let is_flat = volume <= flat;
            if is_flat && !self.is_positive([corners[0], corners[1], corners[2], vertex]) {
                continue;
            }
            let candidate = Candidate {
                vertex,
                volume,
                rise: w[3] - dot(slope, w),
                is_flat,
            };
            let is_first = |best: &Candidate| self.is_met_first(corners, &candidate, best, close);
            if best.as_ref().is_none_or(is_first) {
                best = Some(candidate);
            }
        }
        best.map(|best| best.vertex)
    }

    /// Returns true if a growing sphere through the corners meets one vertex before another one.
    #[inline(always)]
    fn is_met_first(
        &self,
        [a, b, c]: [u8; 3],
        one: &Candidate,
        other: &Candidate,
        close: f64,
    ) -> bool {
        let difference = one.rise * other.volume - other.rise * one.volume;
        let is_sure = difference.abs() > close * (one.volume + other.volume);
        if is_sure && !one.is_flat && !other.is_flat {
            return difference < 0.0;
        }
        self.is_inside([a, b, c, other.vertex], one.vertex)
    }

    /// Adds the cell of an open facet and a vertex; `None` if the law is broken.
    fn fill(&mut self, facet: OpenFacet, apex: u8) -> Option<()> {
        let [a, b, c] = facet.corners;
        let (at, cell) = (self.cells.len(), [a, b, c, apex]);
        if !self.is_positive(cell) {
            return None;
        }
        self.cells.push(cell);
        self.join(facet.side, FacetSide::New(at, 3))?;
        for (i, facet) in OUTWARD[..3].iter().enumerate() {
            let corners = facet.map(|k| cell[k]);
            let side = FacetSide::New(at, i);
            let wanted = key(corners);
            match self.keys.iter().rposition(|&key| key == wanted) {
                Some(open) => {
                    self.keys.swap_remove(open);
                    let other = self.open.swap_remove(open);
                    if !are_opposite(corners, other.corners) {
                        return None;
                    }
                    self.join(other.side, side)?;
                }
                None => self.open(corners, side),
            }
        }
        Some(())
    }

    /// Joins the two sides of a facet; `None` if that breaks the law.
    fn join(&mut self, one: FacetSide, other: FacetSide) -> Option<()> {
        if let (FacetSide::New(of_one, _), FacetSide::New(of_other, i)) = (one, other)
            && self.is_inside(self.cells[of_one], self.cells[of_other][i])
        {
            return None;
        }
        self.sides.push([one, other]);
        Some(())
    }

    fn is_positive(&self, cell: [u8; 4]) -> bool {
        let simplex = cell.map(|k| self.points[k as usize]);
        self.geometry.orientation(simplex) == Sign::Positive
    }

    fn is_inside(&self, cell: [u8; 4], vertex: u8) -> bool {
        let simplex = cell.map(|k| self.points[k as usize]);
        in_sphere(self.geometry, simplex, self.points[vertex as usize])
    }
}

/// Returns three numbers, in any order, as one.
#[inline(always)]
fn key([a, b, c]: [u8; 3]) -> u32 {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let middle = a ^ b ^ c ^ low ^ high;
    u32::from(low) << 16 | u32::from(middle) << 8 | u32::from(high)
}

/// Returns true if two facets with the same corners have them in opposite directions.
fn are_opposite([a, b, c]: [u8; 3], other: [u8; 3]) -> bool {
    [[a, c, b], [c, b, a], [b, a, c]].contains(&other)
}

#[inline(always)]
fn minus(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|k| p[k] - q[k])
}

#[inline(always)]
fn cross<const D: usize, const E: usize>(u: [f64; D], v: [f64; E]) -> [f64; 3] {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| u[i] * v[j] - u[j] * v[i])
}

/// Returns the dot product of a vector and the position of a lift, or another vector.
#[inline(always)]
fn dot<const D: usize>(u: [f64; 3], v: [f64; D]) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

#[inline(always)]
fn sum_of_sizes([x, y, z]: [f64; 3]) -> f64 {
    x.abs() + y.abs() + z.abs()
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;
    use std::collections::BTreeSet;

    use testkit::random::Random;

    use super::*;
    use crate::geometry::{Space, WeightedSpace};
    use crate::{Delaunay, Level, Regular};

    type Cells = BTreeSet<[VertexId; 4]>;

    fn sorted(cells: impl IntoIterator<Item = [VertexId; 4]>) -> Cells {
        let sort = |mut corners: [VertexId; 4]| {
            corners.sort_unstable();
            corners
        };
        cells.into_iter().map(sort).collect()
    }

    /// Compares with the conflict zone among the neighbors, and returns the number of vertices
    /// within the hull, and of those whose holes were filled.
    fn compare<G: Geometry<4>>(t: &Triangulation<G, 4, (), ()>) -> (usize, usize) {
        let (mut inner, mut filled) = (0, 0);
        for vertex in t.tds.vertices() {
            let star = t.tds.cells_around(vertex);
            let is_on_hull = star.iter().any(|&(cell, _)| t.tds.is_infinite(cell));
            inner += usize::from(!is_on_hull);
            if let Some(filling) = filling(t, vertex, &star) {
                filled += 1;
                let zone = t.cells_without(vertex, &star).unwrap();
                assert_eq!(sorted(filling.cells), sorted(zone), "{vertex:?}");
            }
        }
        (inner, filled)
    }

    fn lattice(size: u64) -> Vec<[f64; 3]> {
        let site = |k: u64| [k / size / size, k / size % size, k % size].map(|x| x as f64);
        (0..size * size * size).map(site).collect()
    }

    #[test]
    fn holes_within_the_hull_are_filled() {
        let mut random = Random(1);
        let scattered = (0..300).map(|_| [(); 3].map(|()| random.unit())).collect();
        // Few heights: many neighbors in one plane.
        let mut random = Random(2);
        let layers = (0..300)
            .map(|_| [random.unit(), random.unit(), random.below(4) as f64])
            .collect();
        for points in [scattered, layers, lattice(6)] {
            let t = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
            let (inner, filled) = compare(&t.0.inner);
            assert_eq!(inner, filled);
            assert!(inner > 60, "{inner}");
            let weighted: Vec<_> = points
                .iter()
                .map(|&[x, y, z]| [x, y, z, 0.01 * random.unit()])
                .collect();
            let t = Regular::<WeightedSpace, 4>::from_points(WeightedSpace::new(), &weighted);
            let (inner, filled) = compare(&t.unwrap().0);
            assert_eq!(inner, filled);
        }
    }

    /// Positions and lifts that mislead.
    #[derive(Debug, Clone, Copy, Default)]
    struct Misled(Space);

    impl Geometry<4> for Misled {
        type Point = [f64; 3];

        fn admits(&self, p: &[f64; 3]) -> bool {
            self.0.admits(p)
        }

        fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
            self.0.compare(p, q)
        }

        fn orientation(&self, simplex: [&[f64; 3]; 4]) -> Sign {
            self.0.orientation(simplex)
        }

        fn side_of_sphere(&self, simplex: [&[f64; 3]; 4], q: &[f64; 3]) -> Sign {
            self.0.side_of_sphere(simplex, q)
        }

        fn orientation_in_flat(&self, simplex: &[&[f64; 3]]) -> Sign {
            self.0.orientation_in_flat(simplex)
        }

        fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
            self.0.side_of_sphere_in_flat(simplex, q)
        }

        fn rough_lift(&self, p: &[f64; 3], origin: &[f64; 3]) -> Option<[f64; 4]> {
            let [x, y, z, lift] = self.0.rough_lift(p, origin)?;
            match (p[0] * 1000.0) as u32 % 40 {
                0 => Some([x, y, -z, lift]),
                1 => Some([f64::NAN, y, z, lift]),
                2 => Some([x, y, z, f64::INFINITY]),
                3 => Some([x, y, z, lift - 0.02]),
                _ => Some([x, y, z, lift]),
            }
        }
    }

    #[test]
    fn numbers_that_mislead_change_no_triangulation() {
        let mut random = Random(3);
        let mut t = Delaunay::<Misled, 4>::new(Misled::default());
        for _ in 0..400 {
            t.insert([(); 3].map(|()| random.unit())).unwrap();
        }
        let (inner, filled) = compare(&t.inner);
        assert!(filled > 20 && inner > filled + 20, "{inner} {filled}");
        for vertex in t.tds().vertices().step_by(2).collect::<Vec<_>>() {
            t.remove(vertex).unwrap();
        }
        assert_eq!(t.check(Level::Law), []);
    }
}

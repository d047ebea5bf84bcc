//! Natural neighbor coordinates in space: those of the [plane](crate::query::plane::natural), one
//! dimension up.
//!
//! Sibson's weight is a volume, Laplace's the area of a facet over a distance. Nothing is inserted
//! to compute them: the corners of the new cell are centers of spheres over the border of the
//! [conflict zone](ConflictZone), those of what it takes from its neighbors also the centers of the
//! cells within.

use rustc_hash::FxHashMap;

use crate::geometry::Coordinates;
use crate::kernel;
use crate::kinds::Delaunay;
use crate::locate::Location;
use crate::query::dual::{dot, minus, plus};
use crate::tds::space::{OUTWARD, beside};
use crate::tds::{CellId, VertexId};

use super::dual::cross;
use crate::query::zone::ConflictZone;

/// Vertices with weights.
type VertexWeights = Vec<(VertexId, f64)>;

/// An edge of the new cell. It belongs to an edge of the triangulation on the border of the zone,
/// and joins the centers over the two facets of the border there. One who goes around that edge,
/// counter-clockwise seen from the end with the larger number, leaves the zone through one of the
/// two facets and enters it again through the other.
#[derive(Default, Clone, Copy)]
struct Ridge {
    exit: [f64; 3],
    entry: [f64; 3],
}

/// The cell that a point would have, and what it would replace. Coordinates are relative to the
/// point.
struct NewCell<'t, G: Coordinates<4>, V, C> {
    t: &'t Delaunay<G, 4, V, C>,
    zone: &'t ConflictZone,
    at: [f64; 3],
    /// The centers over the border, which are the corners of the cell.
    corners: FxHashMap<(CellId, usize), [f64; 3]>,
    /// The ridges, by the ends of their edges.
    ridges: FxHashMap<[VertexId; 2], Ridge>,
}

impl<'t, G: Coordinates<4>, V, C: Copy + Default> NewCell<'t, G, V, C> {
    fn new(t: &'t Delaunay<G, 4, V, C>, zone: &'t ConflictZone, at: [f64; 3]) -> Self {
        let mut cell = NewCell {
            t,
            zone,
            at,
            corners: FxHashMap::default(),
            ridges: FxHashMap::default(),
        };
        for &facet in &zone.border {
            let (inside, i) = facet;
            let corners = OUTWARD[i].map(|k| t.tds().vertex(inside, k));
            let [a, b, c] = corners.map(|vertex| t.site(vertex));
            let center = kernel::circumcenter_in_space([at, a, b, c]);
            cell.corners.insert(facet, center);
            for k in 0..3 {
                let [start, end] = [corners[k], corners[(k + 1) % 3]];
                if start < end {
                    cell.ridges.entry([start, end]).or_default().exit = center;
                } else {
                    cell.ridges.entry([end, start]).or_default().entry = center;
                }
            }
        }
        cell
    }

    fn offset(&self, vertex: VertexId) -> [f64; 3] {
        minus(self.t.site(vertex), self.at)
    }

    /// Returns twelve times the volume between the point and the facet towards each neighbor, in
    /// order of their numbers.
    fn facets(&self) -> VertexWeights {
        let mut parts = Vec::with_capacity(2 * self.ridges.len());
        for (&[start, end], &Ridge { exit, entry }) in &self.ridges {
            // The facet is in the plane halfway to its vertex.
            parts.push((start, dot(self.offset(start), cross(entry, exit))));
            parts.push((end, dot(self.offset(end), cross(exit, entry))));
        }
        summed(parts)
    }

    /// Returns twelve times the volume that each neighbor loses, in order of their numbers.
    fn lost(&self) -> VertexWeights {
        let tds = self.t.tds();
        let center = |&cell: &CellId| {
            let corners = tds.corners(cell).map(|vertex| self.t.site(vertex));
            (
                cell,
                plus(
                    minus(corners[0], self.at),
                    kernel::circumcenter_in_space(corners),
                ),
            )
        };
        let old: FxHashMap<CellId, [f64; 3]> = self.zone.cells.iter().map(center).collect();
        let mut parts = self.facets();
        // The facet between two neighbors is bounded by the centers around their edge, in a plane
        // halfway between them. Each pair of centers that follow each other is a side of it.
        let mut add = |[start, end]: [VertexId; 2], from: [f64; 3], to: [f64; 3]| {
            let twice_middle = plus(self.offset(start), self.offset(end));
            let part = dot(twice_middle, cross(from, to));
            parts.extend([(start, part), (end, -part)]);
        };
        for (&cell, &here) in &old {
            for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                // One direction in all cells around the edge.
                let (i, j) = if tds.vertex(cell, i) < tds.vertex(cell, j) {
                    (i, j)
                } else {
                    (j, i)
                };
                let ends = [i, j].map(|k| tds.vertex(cell, k));
                let [next, last] = beside(i, j);
                match self.corners.get(&(cell, next)) {
                    Some(&corner) => add(ends, here, corner),
                    None => add(ends, here, old[&tds.neighbor(cell, next)]),
                }
                if let Some(&corner) = self.corners.get(&(cell, last)) {
                    add(ends, corner, here);
                }
            }
        }
        for (&ends, ridge) in &self.ridges {
            add(ends, ridge.exit, ridge.entry);
        }
        summed(parts)
    }
}

/// Adds up the parts of each vertex. The order of additions is that of the parts' sizes, so that
/// the sum is a function of the parts alone.
fn summed(mut parts: VertexWeights) -> VertexWeights {
    parts.sort_unstable_by(|(v, part), (w, other)| v.cmp(w).then(part.total_cmp(other)));
    let of_one =
        |parts: &[(VertexId, f64)]| (parts[0].0, parts.iter().map(|&(_, part)| part).sum());
    parts.chunk_by(|p, q| p.0 == q.0).map(of_one).collect()
}

impl<G: Coordinates<4>, V, C: Copy + Default> Delaunay<G, 4, V, C> {
    /// Returns Sibson's coordinates of a point: vertices, in order of their numbers, with weights
    /// that are not negative, sum up to 1, and whose mean is the point. Rounded.
    ///
    /// Each weight is the part of the volume of the point's Voronoi cell, if it were a vertex, that
    /// the cell of that vertex would lose. On a vertex, returns that vertex with exactly `1.0`.
    /// Where the cell would not be bounded, returns barycentric coordinates in the facet or edge
    /// that the point lies on: on the hull, where they are the limit from within if no four
    /// vertices lie on a plane there, and in any triangulation below dimension 3.
    ///
    /// `None` outside of the hull, for a point that the geometry does not
    /// [admit](crate::geometry::Geometry::admits), and where fourth powers of distances overflow or
    /// underflow. The spheres of the geometry must be spheres in its coordinates.
    ///
    /// After Sibson 1981, *A brief description of natural neighbour interpolation*.
    ///
    /// # Complexity
    /// A [walk](crate::Triangulation::locate) from a cell nearby, and time
    /// proportional to the size of the conflict zone: some 20 cells.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, Delaunay};
    ///
    /// let corners: Vec<[f64; 3]> = (0..8).map(|k| [k % 2, k / 2 % 2, k / 4].map(f64::from)).collect();
    /// let (t, _) = Delaunay::from_points(Space::new(), &corners)?;
    /// let weights = t.sibson(&[0.5, 0.25, 0.5], None).expect("it is inside");
    /// let y: f64 = weights.iter().map(|&(v, weight)| weight * t.point(v)[1]).sum();
    /// assert!((y - 0.25).abs() < 1e-12);
    /// assert_eq!(t.sibson(&[0.5, 0.5, 1.5], None), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sibson(&self, q: &G::Point, near: Option<CellId>) -> Option<VertexWeights> {
        self.coordinates(q, near, |new| new.lost())
    }

    /// Returns Laplace's coordinates of a point, also called non-Sibsonian: each weight is
    /// proportional to the area of the facet between the cells of the point and of that vertex,
    /// over their distance. All else is as for [`sibson`](Self::sibson), in a third of the time.
    ///
    /// After Belikov, Ivanov, Kontorovich, Korytnik and Semenov 1997, *The non-Sibsonian
    /// interpolation*.
    pub fn laplace(&self, q: &G::Point, near: Option<CellId>) -> Option<VertexWeights> {
        self.coordinates(q, near, |new| {
            let mut weights = new.facets();
            for (vertex, weight) in &mut weights {
                let offset = new.offset(*vertex);
                *weight /= dot(offset, offset);
            }
            weights
        })
    }

    /// Returns weights that sum up to 1, from those that `inside` returns for a point within the
    /// hull.
    fn coordinates(
        &self,
        q: &G::Point,
        near: Option<CellId>,
        inside: impl FnOnce(&NewCell<'_, G, V, C>) -> VertexWeights,
    ) -> Option<VertexWeights> {
        let at = crate::query::site_of(&self.geometry, q);
        let location = self.locate(q, near);
        let (cell, facets) = match location {
            Location::Vertex(vertex) => return Some(vec![(vertex, 1.0)]),
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => {
                return None;
            }
            Location::Cell { cell, facets } => (cell, facets),
        };
        let Ok(zone) = crate::query::zone::zone_at(&self.inner, q, location, |_, _| Ok(true));
        let zone = zone?;
        let mut weights = if self.dimension() < 3
            || zone.cells.iter().any(|&cell| self.tds().is_infinite(cell))
        {
            let corners = self.tds().cell_vertices(cell).iter().enumerate();
            let on: Vec<VertexId> = corners
                .filter(|&(i, _)| !facets.contains(i))
                .map(|(_, &vertex)| vertex)
                .collect();
            self.barycentric(&on, at)?
        } else {
            inside(&NewCell::new(self, &zone, at))
        };
        weights
            .iter_mut()
            .for_each(|(_, weight)| *weight = weight.max(0.0));
        let sum: f64 = weights.iter().map(|&(_, weight)| weight).sum();
        // Products that overflow or underflow.
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Some(weights)
    }

    /// Returns the barycentric coordinates, scaled, of a point on an edge or in a triangle, in
    /// order of the vertices' numbers.
    fn barycentric(&self, on: &[VertexId], at: [f64; 3]) -> Option<VertexWeights> {
        let offset = |vertex: VertexId| minus(self.site(vertex), at);
        let length = |p: [f64; 3]| dot(p, p).sqrt();
        let mut weights = match *on {
            [a, b] => vec![(a, length(offset(b))), (b, length(offset(a)))],
            [a, b, c] => {
                let area = |p, q| length(cross(offset(p), offset(q)));
                vec![(a, area(b, c)), (b, area(c, a)), (c, area(a, b))]
            }
            _ => return None,
        };
        weights.sort_unstable_by_key(|&(vertex, _)| vertex);
        Some(weights)
    }
}

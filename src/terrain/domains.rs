//! Which faces lie within which closed curves of edges.

use crate::geometry::Terrain;
use crate::tds::{CellId, VertexId};
use crate::triangulation::ConstrainedDelaunay;

/// Curves along constrained edges. Those of one number bound one domain: by the even-odd rule, so that an edge along
/// which two of them run bounds nothing.
#[derive(Debug, Default)]
pub(super) struct Domains {
    /// The edges with the numbers of the domains that they bound, sorted.
    walls: Vec<Wall>,
}

type Wall = ([VertexId; 2], usize);

/// Faces that no curve divides.
#[derive(Debug)]
pub(super) struct Region {
    /// The numbers of the domains that it lies in, sorted.
    pub(super) within: Vec<usize>,
    pub(super) faces: Vec<CellId>,
}

impl Domains {
    /// The domains of curves that are closed, one by one or together, each with a number. Consecutive vertices of a
    /// curve are the ends of a constraint, which may have been split since.
    pub(super) fn new<'a>(
        triangulation: &ConstrainedDelaunay<Terrain>,
        curves: impl IntoIterator<Item = (usize, &'a [VertexId])>,
    ) -> Self {
        let mut walls = Vec::new();
        for (domain, curve) in curves {
            for pair in curve.windows(2).filter(|pair| pair[0] != pair[1]) {
                let mut at = pair[0];
                for next in triangulation.way(pair[0], pair[1]).into_iter().chain([pair[1]]) {
                    walls.push(([at.min(next), at.max(next)], domain));
                    at = next;
                }
            }
        }
        walls.sort_unstable();
        let odd = walls.chunk_by(|p, q| p == q).filter(|same| same.len() % 2 == 1).map(|same| same[0]);
        Domains { walls: odd.collect() }
    }

    /// All regions, that around the hull included, which may have no faces.
    ///
    /// # Complexity
    /// O(c log w) for c cells and w edges of curves, and for each region the number of domains that it lies in.
    pub(super) fn regions(&self, triangulation: &ConstrainedDelaunay<Terrain>) -> Vec<Region> {
        let tds = triangulation.tds();
        let mut seen = vec![false; tds.cell_slots()];
        let mut regions: Vec<Region> = Vec::new();
        // Cells to go on from, each with the region that it was seen from, if any, and the walls between.
        let mut ahead: Vec<(CellId, Option<usize>, &[Wall])> =
            tds.around(VertexId::INFINITE).map(|cell| (cell, None, [].as_slice())).collect();
        while let Some((start, from, walls)) = ahead.pop() {
            if std::mem::replace(&mut seen[start.index()], true) {
                continue;
            }
            let mut within = from.map(|from| regions[from].within.clone()).unwrap_or_default();
            for (_, domain) in walls {
                match within.binary_search(domain) {
                    Ok(at) => drop(within.remove(at)),
                    Err(at) => within.insert(at, *domain),
                }
            }
            let mut region = Region { within, faces: Vec::new() };
            let mut here = vec![start];
            while let Some(cell) = here.pop() {
                region.faces.extend((!tds.is_infinite(cell)).then_some(cell));
                for (i, &beside) in tds.cell_neighbors(cell).iter().enumerate() {
                    if seen[beside.index()] {
                        continue;
                    }
                    match self.between(triangulation, cell, i) {
                        [] => {
                            seen[beside.index()] = true;
                            here.push(beside);
                        }
                        walls => ahead.push((beside, Some(regions.len()), walls)),
                    }
                }
            }
            regions.push(region);
        }
        regions
    }

    /// The walls on the edge of a cell opposite its vertex `i`.
    fn between(&self, triangulation: &ConstrainedDelaunay<Terrain>, cell: CellId, i: usize) -> &[Wall] {
        if !triangulation.is_constrained(cell, i) {
            return &[];
        }
        let [a, b] = triangulation.tds().edge_ends(cell, i);
        let edge = [a.min(b), a.max(b)];
        let first = self.walls.partition_point(|(wall, _)| *wall < edge);
        let count = self.walls[first..].partition_point(|(wall, _)| *wall == edge);
        &self.walls[first..first + count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangulation::OnCrossing;

    /// Closed curves by their points in plan, each with the number of its domain.
    type Curves = &'static [(usize, &'static [[i32; 2]])];

    /// A plane of a grid of points with these curves drawn in, and the number of faces of area 1/2 in each set of
    /// domains.
    fn areas(curves: Curves) -> Vec<(Vec<usize>, usize)> {
        let at = |[x, y]: [i32; 2]| (y * 9 + x) as u32;
        let points: Vec<[f64; 3]> = (0..81).map(|i| [f64::from(i % 9), f64::from(i / 9), 0.0]).collect();
        let lines: Vec<Vec<u32>> = curves.iter().map(|(_, curve)| curve.iter().map(|&p| at(p)).collect()).collect();
        let (triangulation, vertices) =
            ConstrainedDelaunay::from_lines(Terrain::default(), &points, &lines, OnCrossing::Reject).unwrap();
        let drawn: Vec<Vec<VertexId>> =
            lines.iter().map(|line| line.iter().map(|&i| vertices[i as usize]).collect()).collect();
        let domains = Domains::new(
            &triangulation,
            curves.iter().zip(&drawn).map(|(&(domain, _), line)| (domain, line.as_slice())),
        );
        let mut areas: Vec<(Vec<usize>, usize)> = Vec::new();
        for Region { within, faces } in domains.regions(&triangulation) {
            match areas.iter_mut().find(|(known, _)| *known == within) {
                Some((_, count)) => *count += faces.len(),
                None => areas.push((within, faces.len())),
            }
        }
        areas.sort();
        areas
    }

    const OUTER: &[[i32; 2]] = &[[1, 1], [7, 1], [7, 7], [1, 7], [1, 1]];
    const INNER: &[[i32; 2]] = &[[3, 3], [5, 3], [5, 5], [3, 5], [3, 3]];
    const BESIDE: &[[i32; 2]] = &[[7, 1], [8, 1], [8, 7], [7, 7], [7, 1]];

    #[test]
    fn a_ring_within_a_ring_of_one_domain_is_a_hole_and_of_another_an_overlap() {
        assert_eq!(areas(&[(4, OUTER), (4, INNER)]), [(vec![], 56 + 8), (vec![4], 64)]);
        assert_eq!(areas(&[(4, OUTER), (2, INNER)]), [(vec![], 56), (vec![2, 4], 8), (vec![4], 64)]);
    }

    #[test]
    fn an_edge_of_two_rings_of_one_domain_bounds_nothing() {
        assert_eq!(areas(&[(0, OUTER), (0, BESIDE)]), [(vec![], 44), (vec![0], 84)]);
        assert_eq!(areas(&[(0, OUTER), (1, BESIDE)]), [(vec![], 44), (vec![0], 72), (vec![1], 12)]);
        assert_eq!(areas(&[(0, OUTER), (0, OUTER)]), [(vec![], 128)]);
    }

    #[test]
    fn a_curve_may_be_in_parts_and_double_back() {
        const HALVES: Curves = &[(3, &[[7, 7], [1, 7], [1, 1], [7, 1], [8, 1], [7, 1]]), (3, &[[7, 7], [7, 1]])];
        assert_eq!(areas(HALVES), [(vec![], 56), (vec![3], 72)]);
    }

    #[test]
    fn the_hull_itself_may_be_a_curve() {
        const HULL: Curves = &[(0, &[[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]]), (1, INNER)];
        assert_eq!(areas(HULL), [(vec![], 0), (vec![0], 120), (vec![0, 1], 8)]);
    }
}

//! Which rings lie within which.

use super::admitted::refused;
use super::arranged::arranged;
use super::lines::divided::Divided;
use crate::data::area_of;
use crate::error::Result;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::kernel::RANGE;

/// Which of some rings lie within which, and where they overlap in part.
#[derive(Debug, Default)]
pub(crate) struct Nesting {
    /// For each ring, the others that contain all of it, in order. Equal rings contain none of each
    /// other.
    pub(crate) around: Vec<Vec<usize>>,
    /// The area within two rings of which neither contains the other and that are not equal, in
    /// squares of the unit of the plan.
    pub(crate) overlap: f64,
}

impl Nesting {
    /// Finds which rings lie within which. Rings that do not end where they begin are closed; the
    /// even-odd rule applies to one that crosses itself.
    ///
    /// # Errors
    /// If a coordinate is not finite, or so large or small that the arithmetic does not cover it.
    ///
    /// # Complexity
    /// O((n + k) log n) for n vertices and k crossings; and, for each region that rings bound, the
    /// square of the number of rings around it.
    pub(crate) fn of(rings: &[Vec<[f64; 2]>]) -> Result<Self> {
        let mut found = Nesting {
            around: vec![Vec::new(); rings.len()],
            overlap: 0.0,
        };
        if rings.len() < 2 {
            return Ok(found);
        }
        let triangulation = triangulated(rings)?;
        let divided = Divided::by_rims(&triangulation, triangulation.lines().enumerate());
        let Some(labels) = divided.labels() else {
            return Ok(found);
        };
        // The rings around all parts of each ring that were seen; `None` before the first.
        let mut shared: Vec<Option<Vec<usize>>> = vec![None; rings.len()];
        for within in &labels.areas {
            for &ring in within {
                match &mut shared[ring] {
                    Some(others) => others.retain(|other| within.binary_search(other).is_ok()),
                    first => *first = Some(within.clone()),
                }
            }
        }
        let shared: Vec<Vec<usize>> = shared.into_iter().map(Option::unwrap_or_default).collect();
        let is_in = |a: usize, b: usize| shared[a].binary_search(&b).is_ok();
        for (ring, around) in found.around.iter_mut().enumerate() {
            let others = shared[ring].iter().copied();
            around.extend(others.filter(|&other| other != ring && !is_in(other, ring)));
        }
        let has_overlap = |within: &[usize]| {
            let mut pairs = (1..within.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
            pairs.any(|[i, j]| !is_in(within[i], within[j]) && !is_in(within[j], within[i]))
        };
        let overlaps: Vec<bool> = labels
            .areas
            .iter()
            .map(|within| has_overlap(within))
            .collect();
        found.overlap = triangulation
            .finite_cells()
            .filter(|cell| overlaps[labels.of_cells[cell.index()] as usize])
            .filter_map(|cell| triangulation.cell_points(cell))
            .map(|corners| area_of(corners.map(|&corner| corner)))
            .sum();
        Ok(found)
    }
}

/// Returns a triangulation of rings, whose lines are the rings, in order.
///
/// # Errors
/// Those of [`Nesting::of`].
pub(super) fn triangulated(rings: &[Vec<[f64; 2]>]) -> Result<ConstrainedDelaunay<Terrain>> {
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut lines: Vec<Vec<u32>> = Vec::new();
    for ring in rings {
        let first = points.len() as u32;
        for &[x, y] in ring {
            if ![x, y].iter().all(|&c| RANGE.admits(c)) {
                return Err(refused([x, y, 0.0]));
            }
            points.push([x, y, 0.0]);
        }
        // Ends that are equal share a vertex; others are closed by the last segment.
        let numbers = first..points.len() as u32;
        lines.push(numbers.chain((!ring.is_empty()).then_some(first)).collect());
    }
    arranged(&points, &lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::Inside;
    use testkit::random::Random;

    fn rectangle([x, y]: [f64; 2], [width, depth]: [f64; 2]) -> Vec<[f64; 2]> {
        let corners = [[0.0, 0.0], [width, 0.0], [width, depth], [0.0, depth]];
        corners.map(|[u, v]| [x + u, y + v]).to_vec()
    }

    /// Rectangles on a small grid: many share edges and corners, overlap or are equal.
    #[test]
    fn rectangles_nest_as_their_sides_say() {
        let mut random = Random(7);
        let (mut nested, mut overlapping) = (0, 0);
        for _ in 0..300 {
            let boxes: Vec<[[f64; 2]; 2]> = (0..4)
                .map(|_| {
                    let low = [0, 1].map(|_| random.below(5) as f64);
                    [low, low.map(|c| c + 1.0 + random.below(4) as f64)]
                })
                .collect();
            let of =
                |[low, high]: [[f64; 2]; 2]| rectangle(low, [high[0] - low[0], high[1] - low[1]]);
            let rings: Vec<_> = boxes.iter().map(|&sides| of(sides)).collect();
            let found = Nesting::of(&rings).unwrap();
            let is_in = |a: usize, b: usize| {
                let [[low, high], [min, max]] = [boxes[a], boxes[b]];
                (0..2).all(|k| min[k] <= low[k] && high[k] <= max[k])
            };
            for a in 0..4 {
                let around = (0..4).filter(|&b| b != a && is_in(a, b) && !is_in(b, a));
                assert_eq!(found.around[a], around.collect::<Vec<_>>(), "{boxes:?}");
                nested += found.around[a].len();
            }
            // Unit squares within two that overlap in part.
            let is_within = |a: usize, [x, y]: [f64; 2]| {
                let [low, high] = boxes[a];
                low[0] <= x && x < high[0] && low[1] <= y && y < high[1]
            };
            let cells = (0..100).map(|i| [i % 10, i / 10].map(f64::from));
            let twice = cells.filter(|&cell| {
                (0..4).any(|a| {
                    (0..a).any(|b| {
                        is_within(a, cell) && is_within(b, cell) && !is_in(a, b) && !is_in(b, a)
                    })
                })
            });
            let twice = twice.count();
            assert_eq!(found.overlap, twice as f64, "{boxes:?}");
            overlapping += twice;
        }
        assert!(nested > 100 && overlapping > 500, "{nested} {overlapping}");
    }

    #[test]
    fn a_ring_in_the_bay_of_another_is_beside_it() {
        let horseshoe = [
            [0, 0],
            [9, 0],
            [9, 9],
            [6, 9],
            [6, 3],
            [3, 3],
            [3, 9],
            [0, 9],
        ];
        let horseshoe: Vec<[f64; 2]> = horseshoe.map(|p| p.map(f64::from)).to_vec();
        let bay = rectangle([4.0, 5.0], [1.0, 2.0]);
        let across = rectangle([1.0, 5.0], [7.0, 1.0]);
        assert!(!Inside::new(&[vec![horseshoe.clone()]]).contains(bay[0]));
        let found = Nesting::of(&[horseshoe.clone(), bay]).unwrap();
        assert_eq!((found.around, found.overlap), (vec![vec![], vec![]], 0.0));
        // All corners of this one are within, but not all of it.
        let found = Nesting::of(&[horseshoe, across]).unwrap();
        assert_eq!((found.around, found.overlap), (vec![vec![], vec![]], 4.0));
    }

    #[test]
    fn rings_without_area_and_none_are_within_nothing() {
        assert!(Nesting::of(&[]).unwrap().around.is_empty());
        let line = vec![[1.0, 1.0], [2.0, 2.0], [1.0, 1.0]];
        let found = Nesting::of(&[rectangle([0.0; 2], [4.0; 2]), line, vec![]]).unwrap();
        assert_eq!(found.around, vec![Vec::<usize>::new(); 3]);
        assert!(Nesting::of(&[vec![[f64::NAN; 2]], vec![]]).is_err());
    }
}

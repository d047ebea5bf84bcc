//! Point in polygon tests.

use super::linear::turn;
use crate::triangulation::num::Sign;

type Edge = [[f64; 2]; 2];

/// Polygons in plan, prepared for queries whether a point lies in any of them.
///
/// Each polygon is a list of closed rings; the even-odd rule applies. A point on a ring is inside.
/// Exact for all finite coordinates.
#[derive(Debug, Clone)]
pub struct Inside {
    /// For each of some bands of equal height, its edges with the numbers of their polygons, in
    /// order.
    bands: Vec<Vec<(usize, Edge)>>,
    low: f64,
    height: f64,
}

/// The largest number of bands.
const MOST: f64 = 65_536.0;

impl Inside {
    /// Prepares polygons. Rings that do not end where they begin are closed.
    ///
    /// # Complexity
    /// Linear in the number of edges, in time and memory.
    pub fn new(polygons: &[Vec<Vec<[f64; 2]>>]) -> Self {
        let mut edges: Vec<(usize, Edge)> = Vec::new();
        for (number, ring) in polygons
            .iter()
            .enumerate()
            .flat_map(|(i, rings)| rings.iter().map(move |ring| (i, ring)))
        {
            edges.extend(sides(ring).map(|side| (number, side)));
        }
        let ys = || edges.iter().flat_map(|(_, edge)| edge.map(|p| p[1]));
        let (low, high) = (
            ys().fold(f64::INFINITY, f64::min),
            ys().fold(f64::NEG_INFINITY, f64::max),
        );
        // As high as the average edge: then an edge is in two or three bands on average.
        let average = edges
            .iter()
            .map(|(_, [a, b])| (a[1] - b[1]).abs() / edges.len() as f64)
            .sum::<f64>();
        let height = average.max((high - low) / MOST);
        let mut inside = Inside {
            bands: Vec::new(),
            low,
            height,
        };
        inside.bands.resize_with(
            if edges.is_empty() {
                0
            } else {
                inside.band(high) + 1
            },
            Vec::new,
        );
        for (number, edge) in edges {
            let [a, b] = edge.map(|p| inside.band(p[1]));
            inside.bands[a.min(b)..=a.max(b)]
                .iter_mut()
                .for_each(|band| band.push((number, edge)));
        }
        inside
    }

    /// The band of a height; monotone in the height.
    fn band(&self, y: f64) -> usize {
        if self.height > 0.0 {
            ((y - self.low) / self.height).clamp(0.0, 2.0 * MOST) as usize
        } else {
            0
        }
    }

    /// Returns true if a point lies in a polygon or on one of its rings.
    pub fn contains(&self, p: [f64; 2]) -> bool {
        self.first_around(p).is_some()
    }

    /// Returns the position of the first polygon that contains a point, within or on one of its
    /// rings.
    pub fn first_around(&self, p: [f64; 2]) -> Option<usize> {
        if p[1] < self.low || !p.iter().all(|c| c.is_finite()) {
            return None;
        }
        let band = self.bands.get(self.band(p[1]))?;
        let mut number = usize::MAX;
        let mut is_odd = false;
        for &(polygon, [a, b]) in band {
            if polygon != number {
                if is_odd {
                    return Some(number);
                }
                number = polygon;
            }
            let [low, high] = if a[1] <= b[1] { [a, b] } else { [b, a] };
            if p[1] < low[1] || p[1] > high[1] {
                continue;
            }
            if p[0] < a[0].min(b[0]) {
                // The edge is to the right: a ray to the right crosses it, unless the edge ends on
                // the ray from below.
                is_odd ^= p[1] < high[1];
                continue;
            }
            if p[0] > a[0].max(b[0]) {
                continue;
            }
            match turn(low, high, p) {
                Sign::Zero => return Some(polygon),
                // The point is to the left of an ascending edge.
                Sign::Positive => is_odd ^= p[1] < high[1],
                Sign::Negative => {}
            }
        }
        is_odd.then_some(number)
    }
}

/// Returns the sides of a ring. One that does not end where it begins is closed.
pub(super) fn sides(ring: &[[f64; 2]]) -> impl Iterator<Item = Edge> + '_ {
    ring.iter()
        .zip(ring.iter().skip(1).chain(ring.first()))
        .map(|(&a, &b)| [a, b])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All edges, one after the other, in whole numbers.
    fn naive(polygons: &[Vec<Vec<[i64; 2]>>], [x, y]: [i64; 2]) -> bool {
        polygons.iter().any(|rings| {
            let mut is_odd = false;
            for ring in rings {
                for i in 0..ring.len() {
                    let ([ax, ay], [bx, by]) = (ring[i], ring[(i + 1) % ring.len()]);
                    let turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
                    let within = |a: i64, b: i64, c: i64| a.min(b) <= c && c <= a.max(b);
                    if turn == 0 && within(ax, bx, x) && within(ay, by, y) {
                        return true;
                    }
                    if (ay > y) != (by > y) && (turn > 0) == (by > ay) {
                        is_odd = !is_odd;
                    }
                }
            }
            is_odd
        })
    }

    #[test]
    fn random_polygons_agree_with_all_edges_one_after_the_other() {
        let mut state = 1_u64;
        let mut next = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as i64
        };
        for _ in 0..300 {
            let mut polygons = Vec::new();
            for _ in 0..next(4) {
                let mut rings: Vec<Vec<[i64; 2]>> = Vec::new();
                for _ in 0..next(4) {
                    rings.push((0..next(7)).map(|_| [next(7), next(7)]).collect());
                }
                polygons.push(rings);
            }
            let floats: Vec<Vec<Vec<[f64; 2]>>> = polygons
                .iter()
                .map(|rings| {
                    rings
                        .iter()
                        .map(|ring| ring.iter().map(|p| p.map(|c| c as f64)).collect())
                        .collect()
                })
                .collect();
            let inside = Inside::new(&floats);
            for x in -1..8 {
                for y in -1..8 {
                    assert_eq!(
                        inside.contains([x as f64, y as f64]),
                        naive(&polygons, [x, y]),
                        "{polygons:?} {x} {y}"
                    );
                }
            }
        }
    }

    #[test]
    fn points_off_any_polygon_are_outside() {
        let inside = Inside::new(&[]);
        assert!(!inside.contains([0.0, 0.0]));
        let ring = vec![[0.0, 0.0], [1e300, 0.0], [0.0, 1e300], [0.0, 0.0]];
        let inside = Inside::new(&[vec![ring]]);
        assert!(inside.contains([1e299, 1e299]) && inside.contains([5e299, 0.0]));
        for odd in [
            [f64::NAN, 0.0],
            [0.0, f64::NAN],
            [f64::INFINITY, 1.0],
            [1.0, f64::INFINITY],
            [-1.0, 1.0],
            [1.0, -1.0],
        ] {
            assert!(!inside.contains(odd), "{odd:?}");
        }
    }
}

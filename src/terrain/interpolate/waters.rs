//! Level water, for methods that know only vertices.

use super::base::holds;
use crate::data::{BaseFace, EdgeKind, Surface, faces_under};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::linear::linear;

/// The triangles in water, in a tree.
#[derive(Debug)]
pub(super) struct Waters(Boxes<WaterFace>);

/// A triangle in water; its first corner is the smallest by x, then y.
#[derive(Debug, Clone, Copy)]
struct WaterFace([[f64; 3]; 3]);

impl Boxed for WaterFace {
    fn extent(&self) -> Extent {
        Extent::of(self.0)
    }
}

/// Returns true for the edges around lakes and rivers.
fn bounds_water(kind: EdgeKind) -> bool {
    matches!(kind, EdgeKind::Shore | EdgeKind::Bank)
}

impl Waters {
    /// Collects the triangles that shores and banks alone enclose, if all of their vertices are on
    /// lines: no point is left in water, but on an island of any size there are some.
    ///
    /// # Complexity
    /// Linear; about 24 bytes for each triangle if there is water.
    pub(super) fn new<S: Surface + ?Sized>(surface: &S) -> Self {
        let mut faces = Vec::new();
        if faces_under(surface).any(|face| face.edges.into_iter().any(bounds_water)) {
            let links = Links::new(surface);
            for face in links.in_water() {
                let mut corners = links.corners[face as usize].map(|v| surface.position(v));
                let smallest = (0..3).min_by(|&i, &j| {
                    let [p, q] = [i, j].map(|k: usize| corners[k]);
                    p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
                });
                corners.rotate_left(smallest.unwrap_or_default());
                faces.push(WaterFace(corners));
            }
        }
        Waters(Boxes::new(faces))
    }

    /// Returns the height of the water at a position; `None` outside of it.
    pub(super) fn height(&self, q: [f64; 2]) -> Option<f64> {
        let mut found: Option<[[f64; 3]; 3]> = None;
        self.0.find(q, |&WaterFace(corners)| {
            // Of several triangles around a position always the same.
            if holds(corners, q) && found.is_none_or(|other| corners < other) {
                found = Some(corners);
            }
            None::<()>
        });
        let corners = found?;
        let at_corner = corners.iter().find(|p| p[0] == q[0] && p[1] == q[1]);
        Some(at_corner.map_or_else(|| linear(corners, q), |p| p[2]))
    }
}

/// No triangle across an edge.
const NONE: u32 = u32::MAX;

/// An edge that bounds water.
const CLOSED: u32 = NONE - 1;

/// The triangles under a surface, as far as shores and banks divide them.
struct Links {
    corners: Vec<[u32; 3]>,
    /// For each triangle, what is across each edge.
    across: Vec<[u32; 3]>,
    /// For each vertex, true if a line runs through it.
    is_on_line: Vec<bool>,
}

impl Links {
    fn new<S: Surface + ?Sized>(surface: &S) -> Self {
        let count = surface.base_count();
        let mut links = Links {
            corners: vec![[NONE; 3]; count],
            across: vec![[NONE; 3]; count],
            is_on_line: vec![false; surface.vertex_count()],
        };
        for BaseFace {
            number,
            corners,
            neighbors,
            edges,
        } in faces_under(surface)
        {
            links.corners[number as usize] = corners;
            for i in 0..3 {
                // Of a damaged file, any number.
                let beyond = neighbors[i].filter(|&beyond| (beyond as usize) < count);
                links.across[number as usize][i] = if bounds_water(edges[i]) {
                    CLOSED
                } else {
                    beyond.unwrap_or(NONE)
                };
                if edges[i].is_constrained() {
                    for k in [(i + 1) % 3, (i + 2) % 3] {
                        links.is_on_line[corners[k] as usize] = true;
                    }
                }
            }
        }
        links
    }

    /// Returns the triangles in water.
    fn in_water(&self) -> Vec<u32> {
        let mut is_seen: Vec<bool> = self.corners.iter().map(|face| face[0] == NONE).collect();
        let mut in_water = Vec::new();
        let (mut ahead, mut region) = (Vec::new(), Vec::new());
        for start in 0..self.corners.len() as u32 {
            ahead.push(start);
            let mut is_water = true;
            while let Some(face) = ahead.pop() {
                if std::mem::replace(&mut is_seen[face as usize], true) {
                    continue;
                }
                region.push(face);
                let corners = self.corners[face as usize];
                is_water &= corners
                    .iter()
                    .all(|&vertex| self.is_on_line[vertex as usize]);
                for beyond in self.across[face as usize] {
                    match beyond {
                        CLOSED => {}
                        NONE => is_water = false,
                        beyond => ahead.push(beyond),
                    }
                }
            }
            if is_water {
                in_water.append(&mut region);
            }
            region.clear();
        }
        in_water
    }
}

#[cfg(test)]
mod tests {
    use crate::terrain::{Flat, FlatHeight, Interpolant, Method, River, TinBuilder};

    #[test]
    fn water_is_level_by_the_methods_of_vertices() {
        let mut builder = TinBuilder::default();
        for (x, y) in (0..41).flat_map(|x| (0..41).map(move |y| (f64::from(x), f64::from(y)))) {
            builder.add_points(&[x], &[y], &[20.0 + (x * 0.7).sin() + y / 5.0]);
        }
        let ring = |[x, y]: [f64; 2], size: f64| -> Vec<[f64; 3]> {
            let corners = [[0.0, 0.0], [1.0, 0.1], [0.9, 1.0], [0.1, 0.8], [0.0, 0.0]];
            corners
                .iter()
                .map(|[dx, dy]| [x + size * dx, y + size * dy, 17.5])
                .collect()
        };
        let rings = [ring([3.5, 3.5], 15.0), ring([8.5, 8.5], 4.0)];
        builder.add_flat(Flat::new(&rings, FlatHeight::Lowest).unwrap());
        let bank = |y: f64| [[-5.0, y, 19.0], [20.0, y, 16.0], [50.0, y, 15.0]];
        builder.add_river(River::between(&bank(30.25), &bank(27.75)).unwrap());
        builder.add_breakline(&[[20.3, 20.0, 30.0], [20.3, 29.0, 30.0], [20.3, 38.0, 30.0]]);
        let tin = builder.build().unwrap();
        for method in [Method::Nearest, Method::Idw] {
            let heights = Interpolant::new(&tin, method).unwrap();
            let at = |x: f64, y: f64| heights.height(x, y).unwrap();
            for (x, y) in [(4.5, 4.5), (7.0, 10.0), (12.0, 7.7), (16.0, 8.0)] {
                assert_eq!(at(x, y), 17.5, "{method:?} at {x} {y}");
            }
            // On the island, and beside the lake.
            assert!(at(10.5, 10.5) > 19.0 && at(2.0, 20.0) > 19.0);
            for k in 0..80 {
                let x = 0.25 + f64::from(k) / 2.0;
                let expected = tin.elevation(x, 29.0).unwrap();
                for y in [27.75, 28.3, 29.0, 30.1] {
                    let z = at(x, y);
                    assert!((z - expected).abs() < 1e-9, "{method:?}: {z} at {x} {y}");
                }
            }
        }
    }
}

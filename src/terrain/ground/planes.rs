//! Planes through points, by their neighbors in a graph.

use super::lowest::Cells;
use super::nodes::{Neighbors, Nodes};

/// Added to the sums of squares of distances, in cells: without neighbors, a plane is level.
const LEVEL: f32 = 0.1;

/// For each node the sums of a plane through its point, by least squares: of xx, xy, yy, xz, yz.
pub(super) struct Planes<'a> {
    heights: &'a [f32],
    /// In cells: the whole part, and the rest.
    positions: Vec<([i32; 2], [f32; 2])>,
    sums: Vec<[f32; 5]>,
}

impl<'a> Planes<'a> {
    /// Takes the sums where it is steep; others are not asked for.
    pub(super) fn of(neighbors: &[Neighbors], nodes: &Nodes<'a>, cells: &Cells) -> Planes<'a> {
        let mut planes = Planes {
            heights: nodes.heights,
            positions: Vec::new(),
            sums: Vec::new(),
        };
        if nodes.steep.iter().all(|&steep| steep == 0.0) {
            return planes;
        }
        planes.positions = nodes
            .points
            .iter()
            .map(|&point| {
                let position = cells.position(point);
                let whole = position.map(|at| at as i32);
                let rest = [0, 1].map(|axis| (position[axis] - f64::from(whole[axis])) as f32);
                (whole, rest)
            })
            .collect();
        planes.sums = vec![[0.0; 5]; nodes.heights.len()];
        for &Neighbors { nodes, .. } in neighbors {
            let [a, b] = nodes.map(|node| node as usize);
            let terms = planes.terms(a, b);
            for node in [a, b] {
                for (sum, term) in planes.sums[node].iter_mut().zip(terms) {
                    *sum += term;
                }
            }
        }
        planes
    }

    /// Returns how far apart the surfaces around two neighbors are: the geometric mean of the
    /// distances in height of each from the plane of the other's remaining neighbors.
    pub(super) fn step(&self, a: usize, b: usize) -> f32 {
        (self.off_plane(a, b) * self.off_plane(b, a)).abs().sqrt()
    }

    /// Returns the height of `b` above the plane through `a` and its neighbors other than `b`.
    fn off_plane(&self, a: usize, b: usize) -> f32 {
        let terms = self.terms(a, b);
        let [xx, xy, yy, xz, yz]: [f32; 5] = std::array::from_fn(|at| self.sums[a][at] - terms[at]);
        let (xx, yy) = (xx + LEVEL, yy + LEVEL);
        let scale = 1.0 / (xx * yy - xy * xy).max(LEVEL * LEVEL);
        let [dx, dy] = [(xz * yy - yz * xy) * scale, (yz * xx - xz * xy) * scale];
        let [x, y, z] = self.between(a, b);
        z - dx * x - dy * y
    }

    /// Returns what a pair adds to the sums of both its nodes.
    fn terms(&self, a: usize, b: usize) -> [f32; 5] {
        let [x, y, z] = self.between(a, b);
        [x * x, x * y, y * y, x * z, y * z]
    }

    /// Returns the vector from `a` to `b`: in cells, and in height.
    fn between(&self, a: usize, b: usize) -> [f32; 3] {
        let ((whole_a, rest_a), (whole_b, rest_b)) = (self.positions[a], self.positions[b]);
        let along =
            |axis: usize| (whole_b[axis] - whole_a[axis]) as f32 + (rest_b[axis] - rest_a[axis]);
        [along(0), along(1), self.heights[b] - self.heights[a]]
    }
}

//! Cells with data as the nodes of a graph, and the cheapest division of it.

use super::cut::{MOST, source_side};
use super::lowest::Cells;
use super::nearest::nearest;
use super::nodes::{Neighbors, Nodes};
use super::planes::Planes;
use super::raster::Raster;
use super::recipe::Recipe;

/// Costs are whole multiples of this part of a unit of evidence.
const UNIT: f32 = 4096.0;

/// Cells with data, and those whose surroundings share a border.
#[derive(Debug, Default)]
pub(super) struct Graph {
    /// The cell of each node.
    pub(super) cells: Vec<u32>,
    pub(super) neighbors: Vec<Neighbors>,
    /// The sides of cells that surroundings have at the rim of the raster.
    pub(super) rims: Vec<u32>,
}

impl Graph {
    /// Returns the graph of the cells that have a value.
    pub(super) fn of(raster: &Raster) -> Graph {
        let has: Vec<bool> = raster.values.iter().map(|value| !value.is_nan()).collect();
        let Some(mut owners) = nearest(&has, raster.width) else {
            return Graph::default();
        };
        let mut numbers = vec![0u32; has.len()];
        let mut cells = Vec::new();
        for at in (0..has.len()).filter(|&at| has[at]) {
            numbers[at] = cells.len() as u32;
            cells.push(at as u32);
        }
        for owner in &mut owners {
            *owner = numbers[*owner as usize];
        }
        let neighbors = neighbors(&owners, raster.width, cells.len());
        let rims = rims(&owners, raster.width, cells.len());
        Graph {
            cells,
            neighbors,
            rims,
        }
    }

    /// Returns which nodes are objects, by a minimum cut; where two divisions cost the same, as few
    /// as possible.
    ///
    /// A border between a low ground and a high object is cheap if the step is high. One between a
    /// low object and a high ground is so only as far as the terrain is steep. There a step also
    /// counts only as far as both points are off the planes of each other's neighbors, so that an
    /// even slope is not taken for a step.
    pub(super) fn objects(&self, nodes: &Nodes, cells: &Cells, recipe: &Recipe) -> Vec<bool> {
        let whole = (recipe.weight / cells.side) as f32 * UNIT;
        let bell = |step: f32, scale: f64| (-(step / scale as f32).powi(2)).exp();
        let planes = Planes::of(&self.neighbors, nodes, cells);
        let capacities = |&Neighbors { nodes: ends, faces }: &Neighbors| {
            let [a, b] = ends.map(|end| end as usize);
            let rise = nodes.heights[b] - nodes.heights[a];
            let steep = 0.5 * (nodes.steep[a] + nodes.steep[b]);
            let step = match steep > 0.0 {
                true => rise.abs() + steep * (planes.step(a, b).min(rise.abs()) - rise.abs()),
                false => rise.abs(),
            };
            let full = whole * faces as f32;
            let uphill = full * bell(step, recipe.step);
            let downhill = full * (1.0 - steep * (1.0 - bell(step, recipe.steep_step)));
            // From an object to the ground.
            let [uphill, downhill] = [uphill, downhill].map(|cost| cost.min(MOST as f32) as i32);
            match rise > 0.0 {
                true => [downhill, uphill],
                false => [uphill, downhill],
            }
        };
        let terminals: Vec<i32> = nodes
            .evidence
            .iter()
            .map(|evidence| (evidence * UNIT) as i32)
            .collect();
        source_side(
            &terminals,
            self.neighbors.iter().map(|pair| pair.nodes),
            self.neighbors.iter().map(capacities),
        )
    }
}

/// Counts the faces between each two areas of owners.
fn neighbors(owners: &[u32], width: usize, count: usize) -> Vec<Neighbors> {
    let mut first = vec![0u32; count + 1];
    for_each_face(owners, width, |low, _| first[low as usize + 1] += 1);
    for node in 0..count {
        first[node + 1] += first[node];
    }
    let mut next = first.clone();
    let mut others = vec![0u32; first[count] as usize];
    for_each_face(owners, width, |low, high| {
        others[next[low as usize] as usize] = high;
        next[low as usize] += 1;
    });
    let mut neighbors = Vec::with_capacity(3 * count);
    for node in 0..count {
        let others = &mut others[first[node] as usize..first[node + 1] as usize];
        others.sort_unstable();
        neighbors.extend(others.chunk_by(|a, b| a == b).map(|same| Neighbors {
            nodes: [node as u32, same[0]],
            faces: same.len() as u32,
        }));
    }
    neighbors
}

/// Counts the faces of areas of owners at the rim of the raster.
fn rims(owners: &[u32], width: usize, count: usize) -> Vec<u32> {
    let mut rims = vec![0; count];
    for row in owners.chunks(width) {
        rims[row[0] as usize] += 1;
        rims[row[width - 1] as usize] += 1;
    }
    for owner in owners[..width]
        .iter()
        .chain(&owners[owners.len() - width..])
    {
        rims[*owner as usize] += 1;
    }
    rims
}

/// Calls with the owners of each two cells that share a face, the lower first, unless they are one.
fn for_each_face(owners: &[u32], width: usize, mut call: impl FnMut(u32, u32)) {
    let mut face = |a: u32, b: u32| {
        if a != b {
            call(a.min(b), a.max(b));
        }
    };
    for (number, row) in owners.chunks(width).enumerate() {
        for pair in row.windows(2) {
            face(pair[0], pair[1]);
        }
        let below = &owners[((number + 1) * width).min(owners.len())..];
        for (&owner, &below) in row.iter().zip(below) {
            face(owner, below);
        }
    }
}

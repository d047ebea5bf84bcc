//! Bridges: strips of ground that end in the air on both sides.

use rayon::prelude::*;

use super::graph::Graph;
use super::lowest::Cells;
use super::nodes::Nodes;
use super::options::Bridges;
use super::parts::Parts;
use super::raster::Raster;
use super::recipe::Recipe;

/// The directions in which a strip is crossed, in cells, each with one along the strip.
const DIRECTIONS: [[isize; 2]; 4] = [[1, 0], [1, 1], [0, 1], [-1, 1]];

/// Cells within which a side drops.
const SIDE: usize = 2;

/// Calls bridges objects or ground, as is asked.
///
/// A bridge is a strip, at most as wide as [`Recipe::deck`] says, whose sides both drop by
/// [`Recipe::clearance`] or more within two cells, and which goes on without a drop, in both
/// directions along it, until it is on the ground. Walled embankments look the same from above.
pub(super) fn decide(
    bridges: Bridges,
    objects: &mut [bool],
    graph: &Graph,
    nodes: &Nodes,
    surface: &Raster,
    cells: &Cells,
    recipe: &Recipe,
) {
    let mut is_ground = vec![false; surface.values.len()];
    for (&cell, &is_object) in graph.cells.iter().zip(&*objects) {
        is_ground[cell as usize] = !is_object;
    }
    let strips = Strips {
        surface,
        is_ground: &is_ground,
        drop: recipe.clearance.max(SIDE as f64 * cells.side) as f32,
        deck: (recipe.deck / cells.side) as usize,
        length: (recipe.span / cells.side) as usize,
    };
    let is_wanted = |is_object: bool| match bridges {
        Bridges::OffGround => !is_object,
        Bridges::Ground => is_object,
    };
    // What no window has found to be high is not looked at.
    let flat = recipe.evidence[0] as f32;
    let strips: Vec<Strip> = graph
        .cells
        .par_iter()
        .zip(&*objects)
        .zip(nodes.evidence)
        .map(
            |((&cell, &is_object), &evidence)| match is_wanted(is_object) && evidence > flat {
                true => strips.strip(cell as usize),
                false => Strip::No,
            },
        )
        .collect();
    // Near the sides, cells of the surface lie in between: what hangs together decides.
    let mut parts = Parts::of(objects.len());
    for neighbors in &graph.neighbors {
        let [a, b] = neighbors.nodes.map(|node| node as usize);
        if strips[a] != Strip::No
            && strips[b] != Strip::No
            && (nodes.heights[a] - nodes.heights[b]).abs() < 0.5 * recipe.clearance as f32
        {
            parts.join(neighbors.nodes);
        }
    }
    let mut landing = vec![0i32; objects.len()];
    for (node, strip) in strips.iter().enumerate() {
        landing[parts.root(node as u32) as usize] += match strip {
            Strip::Lands => 1,
            Strip::Ends => -1,
            Strip::No => 0,
        };
    }
    for (node, strip) in strips.iter().enumerate() {
        if *strip != Strip::No && landing[parts.root(node as u32) as usize] > 0 {
            objects[node] = !objects[node];
        }
    }
}

/// What a cell is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Strip {
    No,
    /// A strip that does not reach the ground from this cell.
    Ends,
    /// One that goes on until it is on the ground.
    Lands,
}

struct Strips<'a> {
    surface: &'a Raster,
    is_ground: &'a [bool],
    drop: f32,
    /// The greatest width and length, in cells.
    deck: usize,
    length: usize,
}

impl Strips<'_> {
    fn strip(&self, cell: usize) -> Strip {
        let mut result = Strip::No;
        for (across, along) in (0..4).map(|at| (DIRECTIONS[at], DIRECTIONS[(at + 2) % 4])) {
            let back = |step: [isize; 2]| step.map(|step| -step);
            let Some(one) = self.side(cell, across) else {
                continue;
            };
            if self
                .side(cell, back(across))
                .is_none_or(|other| one + other > self.deck)
            {
                continue;
            }
            if self.lands(cell, along) && self.lands(cell, back(along)) {
                return Strip::Lands;
            }
            result = Strip::Ends;
        }
        result
    }

    /// Returns after how many cells the strip ends in the air, if it does.
    fn side(&self, cell: usize, step: [isize; 2]) -> Option<usize> {
        let mut at = cell;
        for count in 0..self.deck {
            let mut beyond = at;
            for _ in 0..SIDE {
                beyond = self.next(beyond, step)?;
                if self.rise(at, beyond) < -self.drop {
                    return Some(count);
                }
            }
            at = self.next(at, step)?;
            if self.rise(cell, at).abs() > self.drop {
                return None;
            }
        }
        None
    }

    /// Returns whether the strip goes on to cells that are ground and have ground at their sides.
    fn lands(&self, cell: usize, step: [isize; 2]) -> bool {
        let across = [-step[1], step[0]];
        let mut at = cell;
        for _ in 0..self.length {
            let Some(next) = self.next(at, step) else {
                return false;
            };
            if self.rise(at, next).abs() > 0.5 * self.drop {
                return false;
            }
            at = next;
            if self.is_ground[at]
                && self.side(at, across).is_none()
                && self.side(at, across.map(|step| -step)).is_none()
            {
                return true;
            }
        }
        false
    }

    fn rise(&self, from: usize, to: usize) -> f32 {
        self.surface.values[to] - self.surface.values[from]
    }

    fn next(&self, cell: usize, step: [isize; 2]) -> Option<usize> {
        let (column, row) = (cell % self.surface.width, cell / self.surface.width);
        let column = column.checked_add_signed(step[0])?;
        let row = row.checked_add_signed(step[1])?;
        (column < self.surface.width && row < self.surface.height)
            .then(|| row * self.surface.width + column)
    }
}

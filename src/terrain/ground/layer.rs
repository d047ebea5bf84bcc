//! The terrain by one grid.

use std::sync::atomic::AtomicBool;

use super::super::cancel::go_on;
use super::bridges;
use super::evidence::evidence;
use super::graph::Graph;
use super::islands;
use super::lowest::{Cells, heights, lowest};
use super::nodes::Nodes;
use super::options::Bridges;
use super::pits::remove_pits;
use super::raster::Raster;
use super::recipe::Recipe;
use super::surface::{slopes, smoothed, terrain};
use crate::error::Result;

/// The terrain at the centers of cells, and its slope there.
pub(super) struct Layer {
    pub(super) surface: Raster,
    pub(super) slopes: Raster,
}

impl Layer {
    /// Finds the terrain; heights are above the datum of the cells.
    ///
    /// The ground is found twice. The second time it is known where the terrain is steep, and less
    /// is taken for an object there.
    pub(super) fn of(
        points: &[[f64; 3]],
        cells: &Cells,
        bridges: Bridges,
        recipe: &Recipe,
        cancel: &AtomicBool,
    ) -> Result<Layer> {
        let lowest = lowest(points, cells);
        let mut raster = heights(points, &lowest, cells);
        let canopy = remove_pits(&mut raster, cells.side, recipe);
        go_on(cancel)?;
        let evidence = evidence(&canopy, cells.side, recipe, cancel)?;
        go_on(cancel)?;
        let graph = Graph::of(&raster);
        let points: Vec<[f64; 3]> = graph
            .cells
            .iter()
            .map(|&cell| points[lowest[cell as usize] as usize])
            .collect();
        drop(lowest);
        let of_nodes = |values: &[f32]| -> Vec<f32> {
            graph
                .cells
                .iter()
                .map(|&cell| values[cell as usize])
                .collect()
        };
        let (heights, evidence) = (of_nodes(&raster.values), of_nodes(&evidence));
        let nodes = Nodes {
            points: &points,
            heights: &heights,
            evidence: &evidence,
            steep: &vec![0.0; heights.len()],
        };
        let mut objects = graph.objects(&nodes, cells, recipe);
        go_on(cancel)?;
        let first = terrain(&graph, &nodes, &objects, cells);
        let steep = of_nodes(&steepness(&first, cells.side, recipe));
        drop(first);
        if steep.iter().any(|&steep| steep > 0.0) {
            let less = recipe.steep_evidence as f32;
            let evidence: Vec<f32> = evidence
                .iter()
                .zip(&steep)
                .map(|(evidence, steep)| evidence - less * steep)
                .collect();
            let nodes = Nodes {
                evidence: &evidence,
                steep: &steep,
                ..nodes
            };
            objects = graph.objects(&nodes, cells, recipe);
        }
        go_on(cancel)?;
        islands::remove(&mut objects, &graph, &heights, recipe);
        bridges::decide(
            bridges,
            &mut objects,
            &graph,
            &nodes,
            &canopy,
            cells,
            recipe,
        );
        let surface = terrain(&graph, &nodes, &objects, cells);
        let slopes = slopes(&surface, cells.side);
        Ok(Layer { surface, slopes })
    }
}

/// Returns how far the terrain counts as steep, from 0 to 1.
fn steepness(surface: &Raster, side: f64, recipe: &Recipe) -> Vec<f32> {
    let [from, to] = recipe.steep.map(|bound| bound as f32);
    let mut slopes = slopes(&smoothed(surface, recipe.smoothing / side), side).values;
    for slope in &mut slopes {
        let share = ((*slope * side as f32 - from) / (to - from)).clamp(0.0, 1.0);
        *slope = share * share * (3.0 - 2.0 * share);
    }
    slopes
}

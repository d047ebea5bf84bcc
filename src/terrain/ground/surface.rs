//! The terrain, from the cells that are ground.

use rayon::prelude::*;

use super::fill::filled;
use super::graph::Graph;
use super::lowest::Cells;
use super::nodes::Nodes;
use super::raster::Raster;

/// Slopes up to this one are followed when a height is moved to the center of its cell.
const STEEPEST: f32 = 2.0;

/// Returns the terrain at the centers of cells.
///
/// The lowest points are not at the centers: their heights are moved there along the surface that
/// they make, and the surface is made anew.
pub(super) fn terrain(graph: &Graph, nodes: &Nodes, objects: &[bool], cells: &Cells) -> Raster {
    let surface_of = |height: &dyn Fn(usize, usize) -> f32| {
        let mut raster = Raster::of(cells.width, cells.height, f32::NAN);
        for (node, &cell) in graph.cells.iter().enumerate() {
            if !objects[node] {
                raster.values[cell as usize] = height(node, cell as usize);
            }
        }
        filled(&raster)
    };
    let first = surface_of(&|node, _| nodes.heights[node]);
    let most = STEEPEST * cells.side as f32;
    surface_of(&|node, cell| {
        let (column, row) = (cell % cells.width, cell / cells.width);
        let [x, y] = cells.position(nodes.points[node]);
        let [dx, dy] = first
            .gradient(column, row)
            .map(|slope| slope.clamp(-most, most));
        nodes.heights[node] + dx * (column as f64 - x) as f32 + dy * (row as f64 - y) as f32
    })
}

/// Returns the slope at the centers of cells: height by length.
pub(super) fn slopes(surface: &Raster, side: f64) -> Raster {
    let mut result = Raster::of(surface.width, surface.height, 0.0);
    let scale = 1.0 / side as f32;
    result
        .values
        .par_chunks_mut(surface.width)
        .enumerate()
        .for_each(|(row, values)| {
            for (column, value) in values.iter_mut().enumerate() {
                let [dx, dy] = surface.gradient(column, row);
                *value = (dx * dx + dy * dy).sqrt() * scale;
            }
        });
    result
}

/// Returns the surface smoothed by a bell whose deviation is in cells; beyond the rim, its values
/// are repeated.
pub(super) fn smoothed(surface: &Raster, deviation: f64) -> Raster {
    let reach = (4.0 * deviation + 0.5) as usize;
    let weights: Vec<f64> = (0..=reach)
        .map(|at| (-0.5 * (at as f64 / deviation).powi(2)).exp())
        .collect();
    let total = 2.0 * weights.iter().sum::<f64>() - weights[0];
    let weights: Vec<f32> = weights
        .iter()
        .map(|weight| (weight / total) as f32)
        .collect();
    transposed(&along_rows(
        &transposed(&along_rows(surface, &weights)),
        &weights,
    ))
}

fn along_rows(surface: &Raster, weights: &[f32]) -> Raster {
    let mut result = Raster::of(surface.width, surface.height, 0.0);
    let reach = weights.len() - 1;
    result
        .values
        .par_chunks_mut(surface.width)
        .zip(surface.values.par_chunks(surface.width))
        .for_each_init(Vec::new, |padded, (target, source)| {
            padded.clear();
            padded.extend(
                (0..source.len() + 2 * reach)
                    .map(|at| source[at.saturating_sub(reach).min(source.len() - 1)]),
            );
            for (distance, &weight) in weights.iter().enumerate() {
                let (left, right) = (&padded[reach - distance..], &padded[reach + distance..]);
                let weight = if distance == 0 { 0.5 * weight } else { weight };
                for ((target, left), right) in target.iter_mut().zip(left).zip(right) {
                    *target += weight * (left + right);
                }
            }
        });
    result
}

fn transposed(surface: &Raster) -> Raster {
    let (width, height) = (surface.height, surface.width);
    let values = (0..width * height).map(|at| surface.at(at / width, at % width));
    Raster {
        width,
        height,
        values: values.collect(),
    }
}

//! The filter as a whole: the terrain by several grids, and what is near it.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::layer::Layer;
use super::lowest::Cells;
use super::noise::{Company, is_low};
use super::recipe::Recipe;
use super::{GroundGrid, GroundOptions, PointClass};
use crate::error::Result;

/// What is known of a point, as the mean of all grids.
#[derive(Debug, Clone, Copy, Default)]
struct Finding {
    /// The height above the terrain.
    above: f32,
    slope: f32,
}

/// Classifies points that are finite.
pub(super) fn classified(
    points: &[[f64; 3]],
    grid: &GroundGrid,
    options: &GroundOptions,
    recipe: &Recipe,
    cancel: &AtomicBool,
) -> Result<Vec<PointClass>> {
    let spacing = grid.spacing.clamp(recipe.spacings[0], recipe.spacings[1]);
    let share = 1.0 / recipe.scales.len() as f32;
    let mut findings = vec![Finding::default(); points.len()];
    for scale in &recipe.scales {
        let cells = Cells::around(points, grid.origin, scale * spacing)?;
        let layer = Layer::of(points, &cells, options.bridges, recipe, cancel)?;
        findings
            .par_iter_mut()
            .zip(points)
            .for_each(|(finding, point)| {
                let [x, y] = cells.position(*point);
                let above = cells.above_datum(*point) - layer.surface.bilinear(x, y);
                finding.above += share * above;
                finding.slope += share * layer.slopes.bilinear(x, y);
            });
    }
    let tolerance = |slope: f32| recipe.tolerance as f32 + recipe.tolerance_slope as f32 * slope;
    let is_ground = |finding: &Finding| {
        let tolerance = tolerance(finding.slope);
        finding.above <= tolerance && finding.above >= -(recipe.below as f32) * tolerance
    };
    let company = options.noise.then(|| {
        let above = points.iter().zip(&findings);
        let above = above.filter(|(_, finding)| finding.above > tolerance(finding.slope));
        Company::of(above.map(|(point, _)| *point), spacing)
    });
    let class = |(finding, point): (&Finding, &[f64; 3])| match &company {
        _ if is_ground(finding) => PointClass::Ground,
        Some(_) if is_low(finding.above, tolerance(finding.slope)) => PointClass::LowNoise,
        Some(company) if company.is_alone(*point, finding.above) => PointClass::HighNoise,
        _ => PointClass::Object,
    };
    Ok(findings.par_iter().zip(points).map(class).collect())
}

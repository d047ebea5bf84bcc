//! What openings say for and against an object at each cell.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use super::super::cancel::go_on;
use super::openings::opened;
use super::raster::Raster;
use super::recipe::Recipe;
use crate::error::Result;

/// Returns the evidence that each cell is an object: the mean over the windows of the logarithm of
/// the steepest drop, which is 0 where the terrain would be just as steep as it is allowed to be.
///
/// The drop of a disk is what its opening takes from that of the disk before. It is compared with
/// the height that the allowed slope gains within the radius. All windows use one sequence.
///
/// # Errors
/// [`Error::canceled`](crate::Error::canceled), if `cancel` becomes true.
pub(super) fn evidence(
    surface: &Raster,
    side: f64,
    recipe: &Recipe,
    cancel: &AtomicBool,
) -> Result<Vec<f32>> {
    let count = surface.values.len();
    let widest = recipe.windows.iter().copied().fold(0.0, f64::max);
    let mut last = surface.clone();
    let mut steepest = vec![0f32; count];
    let mut sum = vec![0f32; count];
    let mut windows = recipe.windows.iter().peekable();
    let [low, high] = recipe.evidence.map(|bound| bound as f32);
    let mut add = |steepest: &[f32]| {
        sum.par_iter_mut().zip(steepest).for_each(|(sum, drop)| {
            *sum += drop.max(1e-3).ln().clamp(low, high);
        });
    };
    for &radius in &recipe.radii {
        let reach = radius as f64 * side;
        if reach > widest + 1e-6 {
            break;
        }
        while windows.next_if(|window| reach > **window + 1e-6).is_some() {
            add(&steepest);
        }
        go_on(cancel)?;
        let allowed = (1.0 / (recipe.slope * reach).min(recipe.cap)) as f32;
        let next = opened(&last, radius);
        steepest
            .par_iter_mut()
            .zip(&last.values)
            .zip(&next.values)
            .for_each(|((steepest, last), next)| *steepest = steepest.max((last - next) * allowed));
        last = next;
    }
    for _ in windows {
        add(&steepest);
    }
    let share = 1.0 / recipe.windows.len() as f32;
    sum.iter_mut().for_each(|sum| *sum *= share);
    Ok(sum)
}

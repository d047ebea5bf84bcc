//! Contours, from part to part.

use rayon::prelude::*;

use super::TinParts;
use crate::data::{ContourLine, Surface};
use crate::error::Result;
use crate::run::context::Context;
use crate::terrain::Levels;
use crate::terrain::contour::parts::{BendFinder, ContourCollector, ContourParts, join_level};

/// Returns all contours, sorted by level and then by their points.
///
/// # Errors
/// If there are too many levels, a part is damaged, or the run is canceled.
///
/// # Complexity
/// n log n for n triangles that meet a level. Memory is needed for the contours and some parts.
pub(crate) fn contours(
    parts: &TinParts,
    levels: &Levels,
    context: &Context,
) -> Result<Vec<ContourLine>> {
    let of_part = |number: usize| -> Result<ContourParts> {
        context.check()?;
        let part = parts.part(number)?;
        let mut collector = ContourCollector::new(levels);
        part.tile_triangles()
            .for_each(|triangle| collector.add(&triangle));
        part.ensure_intact()?;
        collector.finish()
    };
    let of_parts = (0..parts.index().parts.len())
        .into_par_iter()
        .map(of_part)
        .collect::<Result<_>>()?;
    let merged = ContourParts::merged(of_parts)?;
    let [low, high] = merged.heights();
    levels.within(low, high)?;
    let mut finder = BendFinder::default();
    for level in merged.levels().iter().filter(|level| level.may_bend()) {
        context.check()?;
        finder.add(level.level(), vec![level.clone()])?;
    }
    let bends = finder.finish();
    let mut lines = Vec::new();
    for level in merged.levels() {
        context.check()?;
        lines.append(&mut join_level(level.level(), vec![level.clone()], &bends)?);
    }
    Ok(lines)
}

//! Heights at positions, from part to part.

use rayon::prelude::*;

use super::TinParts;
use crate::data::Surface;
use crate::error::Result;
use crate::terrain::{Interpolant, Method};

/// Returns the linear height at each position in plan; NaN outside of the surface. `done` is called
/// after each part, with the number of heights that were found there.
///
/// # Complexity
/// A comparison for each part and position, and a walk in those parts whose extent has it.
pub(crate) fn elevations(
    parts: &TinParts,
    positions: &[[f64; 2]],
    done: &(dyn Fn(u64) -> Result<()> + Sync),
) -> Result<Vec<f64>> {
    let of_part = |number: usize| -> Result<Vec<(usize, f64)>> {
        let extent = &parts.index().parts[number].extent;
        let mut own = positions
            .iter()
            .enumerate()
            .filter(|(_, q)| extent.holds(q[0], q[1]))
            .peekable();
        if own.peek().is_none() {
            return Ok(Vec::new());
        }
        let (part, mut near) = (parts.part(number)?, None);
        // What is in no whole triangle may be in a fragment.
        let in_fragments = part
            .has_fragments()
            .then(|| Interpolant::new(&part, Method::Linear))
            .transpose()?;
        let mut height = |q: [f64; 2]| {
            let in_whole = part.elevation_in_whole(q, &mut near);
            in_whole.or_else(|| in_fragments.as_ref()?.height(q[0], q[1]))
        };
        let found = own
            .filter_map(|(at, &q)| Some((at, height(q)?)))
            .collect::<Vec<_>>();
        part.ensure_intact()?;
        done(found.len() as u64)?;
        Ok(found)
    };
    let found: Vec<_> = (0..parts.index().parts.len())
        .into_par_iter()
        .map(of_part)
        .collect::<Result<_>>()?;
    let mut heights = vec![f64::NAN; positions.len()];
    // On an edge between parts both have a height: that of the first one.
    for (at, height) in found.into_iter().rev().flatten() {
        heights[at] = height;
    }
    Ok(heights)
}

//! Banks and shores that lie on each other, but for rounding.

use super::band::border_sides;
use super::scene::Scene;
use super::strand::Strand;
use crate::terrain::boxes::{Boxes, Extent};
use crate::terrain::nearest::squared_distance;

/// Asks for the vertices of each border on those of other waters that pass them within rounding, so
/// that both have the same edges.
pub(super) fn add(scene: &Scene, strands: &mut [Strand]) {
    let sides = border_sides(strands);
    let borders = Boxes::new(sides.clone());
    for own in &sides {
        for [x, y, _] in own.ends {
            borders.find_in(Extent::of_plan([[x, y]]).grown(scene.rounding), |side| {
                let ends = side.ends.map(|[x, y, _]| [x, y]);
                let is_pair = |pair| scene.meetings.pairs.contains(&pair);
                let is_met = is_pair([own.water, side.water]) || is_pair([side.water, own.water]);
                if is_met
                    && !ends.contains(&[x, y])
                    && squared_distance(ends, [x, y]) <= scene.rounding.powi(2)
                {
                    strands[side.strand].want(side.segment, [x, y]);
                }
                None::<()>
            });
        }
    }
}

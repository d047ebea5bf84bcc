//! Notices about files and lines that are far apart.

use std::path::Path;

use crate::data::Bounds;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;

/// Files are far apart if the gap is this many times as wide as the widest file.
const FAR: f64 = 100.0;

/// Adds a notice if files are far apart, for example on two continents: one of them may be in a
/// different coordinate system.
pub(crate) fn compare_files(files: &[&Path], extents: &[Bounds], units: &Units, journal: &Journal) {
    let width =
        |bounds: &Bounds| (bounds.max[0] - bounds.min[0]).hypot(bounds.max[1] - bounds.min[1]);
    let mut known: Vec<(&Path, &Bounds)> = files
        .iter()
        .copied()
        .zip(extents)
        .filter(|(_, extent)| !extent.is_empty())
        .collect();
    let widest = known
        .iter()
        .map(|(_, extent)| width(extent))
        .fold(0.0, f64::max);
    for axis in 0..2 {
        known.sort_by(|(_, a), (_, b)| a.min[axis].total_cmp(&b.min[axis]));
        let mut last: Option<(&Path, f64)> = None;
        for &(file, extent) in &known {
            if let Some((before, end)) =
                last.filter(|(_, end)| extent.min[axis] - end > FAR * widest)
            {
                let gap = units.length(extent.min[axis] - end);
                return journal.add(Notice::FarApart(
                    before.to_path_buf(),
                    file.to_path_buf(),
                    gap,
                ));
            }
            if last.is_none_or(|(_, end)| end < extent.max[axis]) {
                last = Some((file, extent.max[axis]));
            }
        }
    }
}

/// The boxes around lines.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LineExtents {
    /// The box around the lines that are part of the surface wherever they are.
    pub(crate) with_heights: Bounds,
    /// The box around lakes and rivers, which end at the rim of the others.
    pub(crate) waters: Bounds,
}

impl LineExtents {
    /// Returns the box around all lines.
    pub(crate) fn all(&self) -> Bounds {
        let mut all = self.with_heights;
        all.merge(&self.waters);
        all
    }
}

/// Returns a notice if lines are farther than `buffer` from the points, or extend the surface more
/// than `usual` beyond them, as the lines of a whole district do with the points of one tile.
pub(crate) fn compare_lines(
    points: &Bounds,
    lines: &LineExtents,
    buffer: f64,
    usual: f64,
    units: &Units,
) -> Option<Notice> {
    let all = lines.all();
    if points.is_empty() || all.is_empty() {
        return None;
    }
    let gap = (0..2)
        .map(|i| (points.min[i] - all.max[i]).max(all.min[i] - points.max[i]))
        .fold(0.0, f64::max);
    if gap > buffer {
        return Some(Notice::BreaklinesApart(units.length(gap)));
    }
    let lines = lines.with_heights;
    let reach = (0..2).flat_map(|i| [points.min[i] - lines.min[i], lines.max[i] - points.max[i]]);
    let furthest = reach.fold(0.0, f64::max);
    (furthest > usual).then(|| Notice::BreaklinesBeyond(units.length(furthest)))
}

//! Whether what was read lies together.

use std::path::PathBuf;

use super::talk::Talk;
use crate::data::Bounds;
use crate::run::units::Units;

/// Files are far apart if the gap is so many times as wide as the widest file.
const FAR: f64 = 100.0;

/// Files that lie on two continents, say: one of them is perhaps in another coordinate system.
pub(super) fn tell_apart(files: &[PathBuf], extents: &[Bounds], units: &Units, talk: &Talk) {
    let width = |bounds: &Bounds| (bounds.max[0] - bounds.min[0]).hypot(bounds.max[1] - bounds.min[1]);
    let mut known: Vec<(&PathBuf, &Bounds)> =
        files.iter().zip(extents).filter(|(_, extent)| !extent.is_empty()).collect();
    let widest = known.iter().map(|(_, extent)| width(extent)).fold(0.0, f64::max);
    for axis in 0..2 {
        known.sort_by(|(_, a), (_, b)| a.min[axis].total_cmp(&b.min[axis]));
        let mut last: Option<(&PathBuf, f64)> = None;
        for &(file, extent) in &known {
            if let Some((before, end)) = last.filter(|(_, end)| extent.min[axis] - end > FAR * widest) {
                return talk.warning(format_args!(
                    "{} and {} are {} apart, with nothing between them: are their coordinates in one system?",
                    before.display(),
                    file.display(),
                    units.length(extent.min[axis] - end)
                ));
            }
            if last.is_none_or(|(_, end)| end < extent.max[axis]) {
                last = Some((file, extent.max[axis]));
            }
        }
    }
}

/// Lines of another place than the points, or those of a whole district over the points of one tile: the extent is then
/// not what one expects. How far lines may reach beyond the points is given by `buffer`.
pub(super) fn tell_beyond(points: &[[f64; 3]], lines: Bounds, buffer: f64, units: &Units, talk: &Talk) {
    let mut extent = Bounds::default();
    points.iter().for_each(|&point| extent.add(point));
    if extent.is_empty() || lines.is_empty() {
        return;
    }
    let gap = (0..2).map(|i| (extent.min[i] - lines.max[i]).max(lines.min[i] - extent.max[i])).fold(0.0, f64::max);
    if gap > buffer {
        return talk.warning(format_args!(
            "the breaklines lie {} away from the points: are they in the same coordinate system?",
            units.length(gap)
        ));
    }
    let reach = (0..2).flat_map(|i| [extent.min[i] - lines.min[i], lines.max[i] - extent.max[i]]);
    let furthest = reach.fold(0.0, f64::max);
    if furthest > buffer {
        talk.note(format_args!(
            "breaklines reach {} beyond the points: the surface there rests on them alone (--bounds clips it)",
            units.length(furthest)
        ));
    }
}

//! How many points a file has and where, before and after it is read.

use crate::data::{Bounds, PointInfo};

/// The rounding of the coordinates that headers state, in units of the last place.
const HEADER_ROUNDING: f64 = 8.0;

/// What is known of the points of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FileExtent {
    /// Their number.
    pub(crate) points: Option<u64>,
    /// A box around them.
    pub(crate) bounds: Option<Bounds>,
}

impl FileExtent {
    /// Returns false if no point of the file can lie in a window, in plan.
    pub(crate) fn meets(&self, window: &Bounds) -> bool {
        self.bounds.is_none_or(|bounds| {
            (0..2).all(|k| bounds.min[k] <= window.max[k] && window.min[k] <= bounds.max[k])
        })
    }

    /// Returns true if all points of the file can lie in a box that a header states, in plan.
    fn is_within(&self, stated: &Bounds) -> bool {
        let [low, high] = with_rounding([stated.min, stated.max].map(|[x, y, _]| [x, y]));
        self.bounds.is_none_or(|bounds| {
            bounds.is_empty() || (0..2).all(|k| low[k] <= bounds.min[k] && bounds.max[k] <= high[k])
        })
    }

    /// Returns the share of the box that lies in a window, in plan; all of it if the box is not
    /// known.
    pub(crate) fn share(&self, window: &Bounds) -> f64 {
        let Some(Bounds { min, max }) = self.bounds else {
            return 1.0;
        };
        let along = |k: usize| match max[k] - min[k] {
            length if length > 0.0 => {
                ((max[k].min(window.max[k]) - min[k].max(window.min[k])) / length).clamp(0.0, 1.0)
            }
            _ => 1.0,
        };
        if self.meets(window) {
            along(0) * along(1)
        } else {
            0.0
        }
    }
}

/// Returns the corners of a box that a header states, enlarged in plan by what rounding may add.
pub(crate) fn with_rounding([min, max]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let rounding =
        [0, 1].map(|k: usize| HEADER_ROUNDING * f64::EPSILON * min[k].abs().max(max[k].abs()));
    [
        [0, 1].map(|k| min[k] - rounding[k]),
        [0, 1].map(|k| max[k] + rounding[k]),
    ]
}

/// Returns the number of points of a file, and the box around them, by which their mean distance is
/// computed: as the file states them, so that the distance is known before anything is read. If it
/// does not state both, or a box that does not contain the points, it is what was read. Both boxes
/// are in the coordinates of the result.
pub(crate) fn counted(
    stated: (Option<u64>, Option<Bounds>),
    read: Option<FileExtent>,
) -> Option<FileExtent> {
    let (Some(points), Some(bounds)) = stated else {
        return read;
    };
    let is_finite = (0..2).all(|k| bounds.min[k].is_finite() && bounds.max[k].is_finite());
    let is_true = points > 0 && is_finite && read.is_none_or(|read| read.is_within(&bounds));
    if !is_true {
        return read;
    }
    Some(FileExtent {
        points: Some(points),
        bounds: Some(bounds),
    })
}

/// Returns what a file states of its points. The box is enlarged by what headers are rounded by.
///
/// A box is not taken without area, as of a header that was not filled in, or if the coordinates
/// that the file stores cannot reach it.
pub(crate) fn stated_extent(info: &PointInfo) -> FileExtent {
    let is_taken = |bounds: &Bounds| {
        info.count != Some(0)
            && (0..2).all(|k| bounds.min[k] < bounds.max[k])
            && info.lattice.is_none_or(|lattice| {
                [bounds.min, bounds.max]
                    .iter()
                    .all(|&corner| lattice.nearest(corner).is_some())
            })
    };
    let slack = info.lattice.map_or([0.0; 3], |lattice| lattice.scale);
    let enlarged = |bounds: Bounds| Bounds {
        min: [0, 1, 2].map(|k| bounds.min[k] - slack[k].abs()),
        max: [0, 1, 2].map(|k| bounds.max[k] + slack[k].abs()),
    };
    FileExtent {
        points: info.count,
        bounds: info.bounds.filter(is_taken).map(enlarged),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Lattice;

    fn square(min: f64, max: f64) -> Bounds {
        Bounds {
            min: [min, min, 0.0],
            max: [max, max, 0.0],
        }
    }

    fn stated(min: f64, max: f64) -> FileExtent {
        stated_extent(&PointInfo {
            count: Some(10),
            bounds: Some(square(min, max)),
            lattice: Some(Lattice {
                scale: [0.01; 3],
                offset: [0.0; 3],
            }),
            ..PointInfo::default()
        })
    }

    #[test]
    fn a_file_is_outside_only_by_a_box_that_can_be_true() {
        let outside = |min, max| !stated(min, max).meets(&square(-20.0, -10.0));
        assert!(outside(0.0, 10.0));
        // Rounded by less than a step.
        assert!(!outside(-9.995, 10.0));
        // Without area, as in a header that was not filled in, and out of reach.
        assert!(!outside(0.0, 0.0));
        assert!(!outside(0.0, 1e9));
        assert!(!outside(f64::NAN, 10.0));
        let unknown = FileExtent {
            points: None,
            bounds: None,
        };
        assert!(unknown.meets(&square(0.0, 1.0)) && unknown.share(&square(0.0, 1.0)) == 1.0);
    }

    #[test]
    fn what_is_counted_is_what_is_stated_unless_that_is_wrong() {
        let of = |points, min, max| FileExtent {
            points: Some(points),
            bounds: Some(square(min, max)),
        };
        let stated = |points, min, max| (Some(points), Some(square(min, max)));
        let read = of(9, 1.0, 10.0 + 1e-15);
        assert_eq!(
            counted(stated(10, 0.0, 10.0), None),
            Some(of(10, 0.0, 10.0))
        );
        assert_eq!(
            counted(stated(10, 0.0, 10.0), Some(read)),
            Some(of(10, 0.0, 10.0))
        );
        for wrong in [
            stated(10, 0.0, 9.0),
            stated(10, 0.0, f64::INFINITY),
            stated(0, 0.0, 10.0),
            (None, Some(square(0.0, 10.0))),
            (Some(10), None),
        ] {
            assert_eq!(counted(wrong, Some(read)), Some(read), "{wrong:?}");
            assert!(counted(wrong, None).is_none() || wrong == stated(10, 0.0, 9.0));
        }
    }

    #[test]
    fn the_share_is_that_of_the_area() {
        let share = |bounds, window| {
            let points = Some(1);
            FileExtent {
                points,
                bounds: Some(bounds),
            }
            .share(&window)
        };
        let infinite = square(f64::NEG_INFINITY, f64::INFINITY);
        assert_eq!(share(square(0.0, 10.0), square(5.0, 20.0)), 0.25);
        assert_eq!(share(square(0.0, 10.0), infinite), 1.0);
        assert_eq!(share(square(0.0, 10.0), square(11.0, 20.0)), 0.0);
        assert_eq!(share(square(5.0, 5.0), square(0.0, 10.0)), 1.0);
    }
}

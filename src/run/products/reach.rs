//! How far outside of bounds points are used.
//!
//! The surface inside of the bounds must be the same as with all points. How far out points matter
//! is known only after the triangulation, so that it may have to be repeated with more of them. All
//! attempts together cost at most as much as one with all points, which is the last resort: so
//! bounds never cost more than twice what the whole does.

use crate::data::Bounds;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::sources::file_extent::FileExtent;
use crate::run::sources::point_files::LeftOutFiles;
use crate::terrain::SelectionReport;

/// The buffer outside of the bounds in which points are used.
pub(super) struct Reach {
    bounds: Option<Bounds>,
    /// Infinite if all points are used.
    buffer: f64,
    /// The work of the attempts so far.
    spent: f64,
}

/// The work of a triangulation, in points.
struct Work {
    /// Points that are read.
    read: f64,
    /// Points that are triangulated.
    used: f64,
}

impl Work {
    /// The work with the points in a window.
    fn within(window: &Bounds, files: &[FileExtent]) -> Self {
        let mut work = Work {
            read: 0.0,
            used: 0.0,
        };
        for file in files.iter().filter(|file| file.meets(window)) {
            let points = file.points.unwrap_or(0) as f64;
            work.read += points;
            work.used += points * file.share(window);
        }
        work
    }

    fn total(&self) -> f64 {
        self.read + self.used
    }
}

impl Reach {
    /// Starts with a buffer; with all points, if most of those that are known lie within it.
    pub(super) fn new(bounds: Option<Bounds>, buffer: f64, files: &[FileExtent]) -> Self {
        let mut reach = Reach {
            bounds,
            buffer,
            spent: 0.0,
        };
        if let Some(bounds) = bounds {
            let used = |buffer| Work::within(&grown(bounds, buffer), files).used;
            if 2.0 * used(buffer) > used(f64::INFINITY) {
                reach.buffer = f64::INFINITY;
            }
        }
        reach
    }

    /// Returns the box in which points are used.
    pub(super) fn window(&self) -> Option<Bounds> {
        self.bounds.map(|bounds| grown(bounds, self.buffer))
    }

    /// Returns about how many points of files are used.
    pub(super) fn points_of(&self, files: &[FileExtent]) -> u64 {
        let all = || files.iter().filter_map(|file| file.points).sum();
        self.window()
            .map_or_else(all, |window| Work::within(&window, files).used as u64)
    }

    /// Returns the width of the buffer.
    pub(super) fn buffer(&self) -> f64 {
        self.buffer
    }

    /// Returns true if a wider buffer may contain more points: not all are used, and the bounds
    /// overlap the box around these files.
    pub(super) fn may_grow_into(&self, extents: &[Bounds]) -> bool {
        let mut all = Bounds::default();
        extents.iter().for_each(|extent| all.merge(extent));
        self.bounds.is_some_and(|bounds| {
            let is_apart = |k: usize| bounds.min[k] > all.max[k] || bounds.max[k] < all.min[k];
            self.buffer.is_finite() && !is_apart(0) && !is_apart(1)
        })
    }

    /// Makes the buffer wider: so wide that the work is at least twice that of the last attempt, or
    /// infinite if that and all attempts would be more work than all points.
    pub(super) fn grow(&mut self, files: &[FileExtent]) {
        let Some(bounds) = self.bounds else { return };
        let within = |buffer| Work::within(&grown(bounds, buffer), files);
        let (last, whole) = (within(self.buffer).total(), within(f64::INFINITY));
        self.spent += last;
        while self.buffer.is_finite() {
            self.buffer *= 2.0;
            let next = within(self.buffer);
            if 2.0 * next.used >= whole.used || self.spent + next.total() > whole.total() {
                self.buffer = f64::INFINITY;
            } else if next.total() > last && next.total() >= 2.0 * last {
                return;
            }
        }
    }

    /// Returns true if points outside of the bounds are not used.
    pub(super) fn leaves_out(&self, points: &SelectionReport, left_out: LeftOutFiles) -> bool {
        self.bounds.is_some()
            && self.buffer.is_finite()
            && (points.outside > 0 || left_out.unread() > 0)
    }

    /// Adds notices about the buffer, and about files that were left out.
    pub(super) fn note(
        &self,
        points: &SelectionReport,
        left_out: LeftOutFiles,
        files: usize,
        units: &Units,
        journal: &Journal,
    ) {
        if self.bounds.is_none() {
            return;
        }
        let buffer = self
            .leaves_out(points, left_out)
            .then(|| units.length(self.buffer));
        if left_out.count > 0 {
            journal.add(Notice::FilesOutside {
                left_out: left_out.count,
                files,
                are_searched: left_out.are_searched,
                buffer: buffer.clone(),
            });
        }
        journal.add(Notice::BoundsBuffer(buffer));
    }
}

/// Returns a box enlarged by a length on all sides in plan, and unbounded in z.
pub(super) fn grown(Bounds { min, max }: Bounds, by: f64) -> Bounds {
    Bounds {
        min: [min[0] - by, min[1] - by, f64::NEG_INFINITY],
        max: [max[0] + by, max[1] + by, f64::INFINITY],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square file, by its lower left corner.
    fn file(x: f64, y: f64, size: f64, points: u64) -> FileExtent {
        FileExtent {
            points: Some(points),
            bounds: Some(Bounds {
                min: [x, y, 0.0],
                max: [x + size, y + size, 0.0],
            }),
        }
    }

    fn bounds(min: f64, max: f64) -> Option<Bounds> {
        Some(Bounds {
            min: [min, min, 0.0],
            max: [max, max, 0.0],
        })
    }

    /// The work of all attempts, as long as none is enough.
    fn attempts(bounds: Option<Bounds>, buffer: f64, files: &[FileExtent]) -> Vec<f64> {
        let mut reach = Reach::new(bounds, buffer, files);
        let mut work = Vec::new();
        while work.len() < 100 {
            work.push(Work::within(&reach.window().unwrap(), files).total());
            if reach.buffer().is_infinite() {
                break;
            }
            reach.grow(files);
        }
        work
    }

    #[test]
    fn no_bounds_cost_more_than_twice_the_whole() {
        let mut delivery: Vec<FileExtent> = (0..8)
            .flat_map(|x| (0..8).map(move |y| file(f64::from(x), f64::from(y), 1.0, 1000)))
            .collect();
        let one = [file(0.0, 0.0, 1000.0, 1_000_000)];
        let outlier = [file(0.0, 0.0, 1.0, 1000), file(1e7, 1e7, 1.0, 3)];
        let nothing = [file(0.0, 0.0, 0.0, 0)];
        delivery.push(file(1e9, 1e9, 1e9, 10));
        for files in [&delivery[..], &one, &outlier, &nothing, &[]] {
            let whole = Work::within(&grown(bounds(0.0, 0.0).unwrap(), f64::INFINITY), files);
            for (min, max, buffer) in [
                (0.2, 0.8, 0.001),
                (0.2, 0.8, 1.0),
                (3.5, 4.5, 0.1),
                (-5.0, -4.0, 0.1),
                (0.0, 1e12, 1.0),
                (400.0, 500.0, 1e-300),
            ] {
                let work = attempts(bounds(min, max), buffer, files);
                let sum: f64 = work.iter().sum();
                assert!(work.len() < 20, "{work:?}");
                assert!(sum <= 2.0 * whole.total(), "{work:?}");
                assert_eq!(work.last(), Some(&whole.total()));
            }
        }
    }

    #[test]
    fn a_delivery_is_read_in_steps() {
        let files: Vec<FileExtent> = (0..16)
            .flat_map(|x| (0..16).map(move |y| file(f64::from(x), f64::from(y), 0.999, 1000)))
            .collect();
        let work = attempts(bounds(0.2, 0.4), 0.1, &files);
        assert!(work.len() > 3, "{work:?}");
        assert!(work.windows(2).all(|pair| pair[1] >= 2.0 * pair[0]));
        // What covers most of the points is tried with all of them.
        assert_eq!(attempts(bounds(0.2, 15.0), 0.1, &files).len(), 1);
    }
}

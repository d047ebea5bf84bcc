use std::collections::BTreeMap;
use std::ops::Range;

use crate::data::{Bounds, PointBatch, PointSource, Return};
use crate::error::{Error, Result};
use crate::triangulation::geometry::{Geometry, Terrain};

use super::admitted::refused;

/// The class of ground points in LAS.
const GROUND: u8 = 2;

/// Which classes of points are used. Points of formats without classes are always used.
#[derive(Debug, Clone, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Classes {
    /// Class 2 (ground) if any point has it, otherwise all classes.
    #[default]
    GroundOrAll,
    /// Only these classes.
    Only(Vec<u8>),
    /// All classes.
    All,
    /// All classes except low and high noise (7 and 18): what surface models are made of.
    AllButNoise,
}

impl Classes {
    /// Returns what a list of classes means, together with the returns that are used. Without a
    /// list it is ground, if there is any; for a choice of returns, everything but noise, because
    /// ground is rarely a first return where it matters.
    pub fn of(listed: &[u8], returns: &[Return]) -> Self {
        let is_listed = |class: u8| listed.contains(&class);
        if listed.is_empty() {
            if returns.is_empty() {
                Classes::GroundOrAll
            } else {
                Classes::AllButNoise
            }
        } else if (0..=u8::MAX).all(is_listed) {
            Classes::All
        } else {
            Classes::Only(listed.to_vec())
        }
    }

    /// Returns the classes that are used; `None` if that depends on the points.
    pub fn listed(&self) -> Option<Vec<u8>> {
        match self {
            Classes::GroundOrAll => None,
            Classes::Only(classes) => Some(classes.clone()),
            Classes::All => Some((0..=u8::MAX).collect()),
            Classes::AllButNoise => Some((0..=u8::MAX).filter(|&class| !is_noise(class)).collect()),
        }
    }
}

/// Returns true for low and high noise.
fn is_noise(class: u8) -> bool {
    matches!(class, 7 | 18)
}

/// Counts of the points that a [`Selection`] read and kept.
///
/// They do not depend on the order of the points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SelectionReport {
    /// Points read.
    pub read: u64,
    /// Points kept.
    pub used: u64,
    /// Points dropped because their file marks them as deleted.
    pub withheld: u64,
    /// Points dropped because their return is not used.
    pub other_return: u64,
    /// Points dropped because their class is not used.
    pub other_class: u64,
    /// These points, by class.
    pub other_classes: BTreeMap<u8, u64>,
    /// Points of a used class dropped because they lie outside of the window.
    pub outside: u64,
    /// Points that are not withheld and of a return that is used, by class.
    pub by_class: BTreeMap<u8, u64>,
    /// Such points from formats without classes.
    pub without_class: u64,
    /// Points from formats without returns, if only some returns are used.
    pub without_return: u64,
    /// The classes that are used; `None` if all are, or all but noise.
    pub classes: Option<Vec<u8>>,
}

/// Selects points for a surface by class, return and position, and keeps their coordinates.
///
/// Withheld points are dropped; coordinates that are not finite are an error. With
/// [`Classes::GroundOrAll`], points of other classes are kept until the first ground point is read,
/// and dropped then. The result is in the order of the input; as a set it does not depend on the
/// order.
#[derive(Debug)]
pub struct Selection {
    classes: Classes,
    /// Those that are used; all if empty.
    returns: Vec<Return>,
    window: Option<Bounds>,
    kept: Vec<[f64; 3]>,
    /// The ranges of `kept` that are dropped when the first ground point is read.
    spare: Vec<Range<usize>>,
    has_ground: bool,
    read: u64,
    read_before_source: u64,
    /// The number of points of each class, and without one, before the current source.
    before_source: Option<Box<[u64; 257]>>,
    /// The classes of the points of each source before the current one.
    sources: Vec<Vec<Option<u8>>>,
    withheld: u64,
    other_return: u64,
    without_return: u64,
    /// For each class.
    by_class: [Tally; 256],
    without_class: Tally,
}

/// The points of one class, inside and outside of the window.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    inside: u64,
    outside: u64,
}

/// What to do with the points of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    Yes,
    No,
    /// Keep them until the first ground point is read.
    Maybe,
}

impl Tally {
    fn all(self) -> u64 {
        self.inside + self.outside
    }
}

impl Default for Selection {
    /// Selects the ground points, or all points if there are none, at any position.
    fn default() -> Self {
        Self::new(Classes::default(), None)
    }
}

impl Selection {
    /// Creates a selection by class and, if a window is given, by position in plan. The border of
    /// the window is part of it.
    pub fn new(classes: Classes, window: Option<Bounds>) -> Self {
        Selection {
            classes,
            returns: Vec::new(),
            window,
            kept: Vec::new(),
            spare: Vec::new(),
            has_ground: false,
            read: 0,
            read_before_source: 0,
            before_source: None,
            sources: Vec::new(),
            withheld: 0,
            other_return: 0,
            without_return: 0,
            by_class: [Tally::default(); 256],
            without_class: Tally::default(),
        }
    }

    /// Restricts the selection to these returns; all are used if there are none. Points of formats
    /// without returns are always used.
    pub fn with_returns(self, returns: Vec<Return>) -> Self {
        Selection { returns, ..self }
    }

    /// Returns the window in which points are kept.
    pub fn window(&self) -> Option<&Bounds> {
        self.window.as_ref()
    }

    /// Returns true if all points are used so far, and a ground point would change that.
    pub fn waits_for_ground(&self) -> bool {
        self.classes == Classes::GroundOrAll && !self.has_ground
    }

    /// Takes into account that there is a ground point among points that are not added, because
    /// they are outside of the window: points of other classes are dropped.
    pub fn note_ground(&mut self) {
        if self.waits_for_ground() {
            self.drop_spare();
        }
        self.has_ground = true;
    }

    /// Starts another source: errors count points from here.
    pub fn next_source(&mut self) {
        let classes = self.classes_of_source();
        self.sources.extend(classes);
        self.before_source = Some(Box::new(self.tallies()));
        self.read_before_source = self.read;
    }

    /// The number of points read so far of each class, and without one.
    fn tallies(&self) -> [u64; 257] {
        std::array::from_fn(|i| self.by_class.get(i).unwrap_or(&self.without_class).all())
    }

    /// The classes of the points of the current source, if one was announced.
    fn classes_of_source(&self) -> Option<Vec<Option<u8>>> {
        let before = self.before_source.as_deref()?;
        let now = self.tallies();
        Some(
            (0..now.len())
                .filter(|&i| now[i] > before[i])
                .map(|i| u8::try_from(i).ok())
                .collect(),
        )
    }

    /// Returns the sources without points of a class that is used, numbered in the order of
    /// [`next_source`](Self::next_source).
    ///
    /// It does not matter whether their points lie in the window.
    pub fn unused_sources(&self) -> Vec<usize> {
        let current = self.classes_of_source();
        let is_unused =
            |classes: &[Option<u8>]| classes.iter().all(|&class| self.fate(class) == Use::No);
        let sources = self.sources.iter().chain(&current).enumerate();
        sources
            .filter(|(_, classes)| is_unused(classes))
            .map(|(source, _)| source)
            .collect()
    }

    /// Removes and returns the points kept so far, which must be [certain](Self::certain), so that
    /// more can be read than fit into memory.
    pub(crate) fn take_points(&mut self) -> Vec<[f64; 3]> {
        debug_assert!(self.spare.is_empty(), "a ground point may still drop these");
        std::mem::take(&mut self.kept)
    }

    /// Returns the number of points that later ones cannot drop: all that are kept, without those
    /// of other classes while there is no ground point.
    pub fn certain(&self) -> usize {
        self.kept.len() - self.spare.iter().map(Range::len).sum::<usize>()
    }

    /// Adds the selected points of a whole source.
    ///
    /// # Errors
    /// If the source cannot be read, and those of [`add`](Self::add).
    pub fn add_source(&mut self, source: &mut dyn PointSource) -> Result<()> {
        self.next_source();
        let mut batch = PointBatch::default();
        loop {
            source.read(&mut batch)?;
            if batch.is_empty() {
                return Ok(());
            }
            self.add(&batch)?;
        }
    }

    /// Adds the selected points of a batch.
    ///
    /// # Errors
    /// If a point that is not withheld has a coordinate that is not finite, or one that is selected
    /// cannot be triangulated; the error names its number in its file, counted from 1. If memory
    /// runs out.
    pub fn add(&mut self, batch: &PointBatch) -> Result<()> {
        if self.kept.try_reserve(batch.len()).is_err() {
            let count = self.kept.len() + batch.len();
            return Err(
                Error::limit(format!("not enough memory for {count} points"))
                    .cure("use fewer points: a part of the area, one class, or one tile at a time"),
            );
        }
        for i in 0..batch.len() {
            self.read += 1;
            if batch.flags.get(i).is_some_and(|flags| flags.is_withheld()) {
                self.withheld += 1;
                continue;
            }
            if !self.returns.is_empty() {
                match batch.return_of(i) {
                    None => self.without_return += 1,
                    Some((number, count)) => {
                        if !self.returns.iter().any(|wanted| wanted.is(number, count)) {
                            self.other_return += 1;
                            continue;
                        }
                    }
                }
            }
            let p = [batch.x[i], batch.y[i], batch.z[i]];
            if !p.iter().all(|value| value.is_finite()) {
                return Err(self.not_finite(p));
            }
            self.take(p, batch.class.get(i).copied())?;
        }
        Ok(())
    }

    fn take(&mut self, point: [f64; 3], class: Option<u8>) -> Result<()> {
        if class == Some(GROUND) && !self.has_ground {
            self.note_ground();
        }
        let tally = match class {
            Some(class) => &mut self.by_class[usize::from(class)],
            None => &mut self.without_class,
        };
        if self
            .window
            .is_some_and(|window| !window.holds(point[0], point[1]))
        {
            tally.outside += 1;
            return Ok(());
        }
        tally.inside += 1;
        let fate = self.fate(class);
        if fate == Use::No {
            return Ok(());
        }
        let geometry: Terrain = Terrain::default();
        if !geometry.admits(&point) {
            return Err(refused(point).at(self.last_read()));
        }
        let at = self.kept.len();
        self.kept.push(point);
        if fate == Use::Maybe {
            match self.spare.last_mut() {
                Some(last) if last.end == at => last.end += 1,
                _ => self.spare.push(at..at + 1),
            }
        }
        Ok(())
    }

    /// Returns what errors call the point that was read last.
    fn last_read(&self) -> String {
        format!("point {}", self.read - self.read_before_source)
    }

    fn fate(&self, class: Option<u8>) -> Use {
        match (class, &self.classes) {
            (None, _) | (_, Classes::All) => Use::Yes,
            (Some(class), Classes::AllButNoise) if is_noise(class) => Use::No,
            (Some(_), Classes::AllButNoise) => Use::Yes,
            (Some(class), Classes::Only(classes)) if classes.contains(&class) => Use::Yes,
            (Some(_), Classes::Only(_)) => Use::No,
            (Some(GROUND), Classes::GroundOrAll) => Use::Yes,
            (Some(_), Classes::GroundOrAll) if self.has_ground => Use::No,
            (Some(_), Classes::GroundOrAll) => Use::Maybe,
        }
    }

    /// Drops the points that were kept in case there is no ground point.
    fn drop_spare(&mut self) {
        let (mut end, mut from) = (0, 0);
        for range in std::mem::take(&mut self.spare) {
            self.kept.copy_within(from..range.start, end);
            end += range.start - from;
            from = range.end;
        }
        let length = self.kept.len();
        self.kept.copy_within(from..length, end);
        self.kept.truncate(end + length - from);
        self.kept.shrink_to_fit();
    }

    #[cold]
    fn not_finite(&self, p: [f64; 3]) -> Error {
        let error = if p[2].is_nan() && p[0].is_finite() && p[1].is_finite() {
            Error::format("the point has no height")
                .cure("name the attribute that holds the height: FILE:FIELD")
        } else {
            Error::format(format!(
                "the coordinates {} {} {} are not all finite",
                p[0], p[1], p[2]
            ))
        };
        error.at(self.last_read())
    }

    /// Returns the counts of points read and kept so far.
    pub fn report(&self) -> SelectionReport {
        let mut report = SelectionReport {
            read: self.read,
            withheld: self.withheld,
            other_return: self.other_return,
            without_return: self.without_return,
            without_class: self.without_class.all(),
            used: self.without_class.inside,
            outside: self.without_class.outside,
            classes: match &self.classes {
                Classes::Only(classes) => Some(classes.clone()),
                Classes::GroundOrAll if self.has_ground => Some(vec![GROUND]),
                Classes::GroundOrAll | Classes::All | Classes::AllButNoise => None,
            },
            ..SelectionReport::default()
        };
        for (class, tally) in (0u8..=255)
            .zip(self.by_class)
            .filter(|(_, tally)| tally.all() > 0)
        {
            report.by_class.insert(class, tally.all());
            if self.fate(Some(class)) == Use::No {
                report.other_class += tally.all();
                report.other_classes.insert(class, tally.all());
            } else {
                report.used += tally.inside;
                report.outside += tally.outside;
            }
        }
        report
    }

    /// Returns the selected points, in the order of the input (24 bytes each), and the report.
    pub fn finish(self) -> (Vec<[f64; 3]>, SelectionReport) {
        let report = self.report();
        (self.kept, report)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::PointFlags;

    /// `(class, x)`; y is 0 and z is x.
    fn batch(points: &[(u8, f64)]) -> PointBatch {
        PointBatch {
            x: points.iter().map(|p| p.1).collect(),
            y: vec![0.0; points.len()],
            z: points.iter().map(|p| p.1).collect(),
            class: points.iter().map(|p| p.0).collect(),
            ..PointBatch::default()
        }
    }

    fn classless(xs: &[f64]) -> PointBatch {
        PointBatch {
            x: xs.to_vec(),
            y: vec![0.0; xs.len()],
            z: xs.to_vec(),
            ..PointBatch::default()
        }
    }

    fn select(
        classes: Classes,
        window: Option<Bounds>,
        batches: &[PointBatch],
    ) -> (Vec<f64>, SelectionReport) {
        let mut selection = Selection::new(classes, window);
        for batch in batches {
            selection.next_source();
            selection.add(batch).unwrap();
        }
        let (points, report) = selection.finish();
        assert!(points.iter().all(|p| p[0] == p[2]));
        assert_eq!(points.len() as u64, report.used);
        assert_eq!(
            report.read,
            report.used
                + report.withheld
                + report.other_return
                + report.other_class
                + report.outside
        );
        (points.iter().map(|p| p[0]).collect(), report)
    }

    #[test]
    fn ground_displaces_what_came_before_it() {
        let batches = [
            batch(&[(1, 1.0), (1, 2.0)]),
            classless(&[3.0]),
            batch(&[(5, 4.0), (2, 5.0), (1, 6.0)]),
        ];
        let (kept, report) = select(Classes::GroundOrAll, None, &batches);
        assert_eq!(kept, [3.0, 5.0]);
        assert_eq!(report.classes, Some(vec![2]));
        assert_eq!(report.other_class, 4);
        assert_eq!(report.by_class, BTreeMap::from([(1, 3), (2, 1), (5, 1)]));
    }

    #[test]
    fn sources_of_which_no_point_is_used_are_known() {
        let batches = [
            batch(&[(1, 1.0)]),
            classless(&[3.0]),
            batch(&[]),
            batch(&[(5, 4.0), (2, 99.0)]),
            batch(&[(7, 5.0)]),
        ];
        let mut window = Bounds::default();
        window.add([0.0, 0.0, 0.0]);
        window.add([10.0, 10.0, 0.0]);
        let unused = |classes: Classes, batches: &[PointBatch]| {
            let mut selection = Selection::new(classes, Some(window));
            for batch in batches {
                selection.next_source();
                selection.add(batch).unwrap();
            }
            selection.unused_sources()
        };
        assert_eq!(unused(Classes::GroundOrAll, &batches), [0, 2, 4]);
        assert_eq!(unused(Classes::GroundOrAll, &batches[..3]), [2]);
        assert_eq!(unused(Classes::Only(vec![1]), &batches), [2, 3, 4]);
        assert!(unused(Classes::GroundOrAll, &[]).is_empty());
    }

    #[test]
    fn returns_are_selected_and_noise_is_no_surface() {
        let points = [(2, 1.0), (5, 2.0), (2, 3.0), (7, 4.0), (6, 5.0)];
        let lidar = PointBatch {
            return_number: vec![1, 1, 2, 1, 2],
            return_count: vec![1, 2, 2, 1, 3],
            ..batch(&points)
        };
        let select = |returns: &[Return], listed: &[u8]| {
            let classes = Classes::of(listed, returns);
            let mut selection = Selection::new(classes, None).with_returns(returns.to_vec());
            selection.next_source();
            selection.add(&lidar).unwrap();
            selection.next_source();
            selection.add(&classless(&[9.0])).unwrap();
            let (points, report) = selection.finish();
            let xs: Vec<f64> = points.iter().map(|p| p[0]).collect();
            assert_eq!(report.without_return, u64::from(!returns.is_empty()));
            (xs, [report.other_return, report.other_class])
        };
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(select(&[], &[]), (vec![1.0, 3.0, 9.0], [0, 3]));
        assert_eq!(select(&[Return::FIRST], &[]), (vec![1.0, 2.0, 9.0], [2, 1]));
        assert_eq!(
            select(&[Return::FIRST], &all),
            (vec![1.0, 2.0, 4.0, 9.0], [2, 0])
        );
        assert_eq!(select(&[Return::FIRST], &[2]), (vec![1.0, 9.0], [2, 2]));
        assert_eq!(select(&[Return::Last], &[]), (vec![1.0, 3.0, 9.0], [2, 1]));
        assert_eq!(
            select(&[Return::Single, Return::Number(2)], &all).0,
            [1.0, 3.0, 4.0, 5.0, 9.0]
        );
    }

    #[test]
    fn without_ground_all_are_kept_in_order() {
        let batches = [
            batch(&[(1, 1.0)]),
            classless(&[2.0]),
            batch(&[(5, 3.0), (7, 4.0)]),
        ];
        let (kept, report) = select(Classes::GroundOrAll, None, &batches);
        assert_eq!(kept, [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(report.classes, None);
    }

    #[test]
    fn named_classes_are_used_and_no_others() {
        let (kept, report) = select(
            Classes::Only(vec![2, 8]),
            None,
            &[
                batch(&[(8, 1.0), (2, 2.0), (1, 3.0)]),
                batch(&[(1, 4.0), (8, 5.0)]),
            ],
        );
        assert_eq!(kept, [1.0, 2.0, 5.0]);
        assert_eq!(report.other_class, 2);
    }

    #[test]
    fn ground_outside_of_the_window_still_means_that_there_is_ground() {
        let mut window = Bounds::default();
        window.add([0.0, 0.0, 0.0]);
        window.add([10.0, 10.0, 0.0]);
        let (kept, report) = select(
            Classes::GroundOrAll,
            Some(window),
            &[batch(&[(1, 5.0), (2, 20.0), (2, 10.0), (1, 30.0)])],
        );
        assert_eq!(kept, [10.0]);
        assert_eq!((report.outside, report.other_class), (1, 2));
    }

    #[test]
    fn every_order_of_the_files_gives_the_same_set_and_report() {
        let files = [
            batch(&[(1, 1.0), (1, 20.0)]),
            classless(&[2.0, 30.0]),
            batch(&[(2, 4.0)]),
            batch(&[(9, 5.0)]),
        ];
        let mut window = Bounds::default();
        window.add([0.0, 0.0, 0.0]);
        window.add([10.0, 10.0, 0.0]);
        let expected = select(Classes::GroundOrAll, Some(window), &files).1;
        for shift in 0..files.len() {
            for swap in 0..files.len() {
                let mut order: Vec<_> = files.to_vec();
                order.rotate_left(shift);
                order.swap(0, swap);
                let (mut kept, report) = select(Classes::GroundOrAll, Some(window), &order);
                kept.sort_by(f64::total_cmp);
                assert_eq!(kept, [2.0, 4.0]);
                assert_eq!(report, expected);
            }
        }
    }

    #[test]
    fn withheld_points_are_dropped_before_anything_else_is_asked() {
        let mut points = batch(&[(2, 1.0), (1, 2.0)]);
        points.x[0] = f64::NAN;
        points.flags = vec![
            PointFlags(PointFlags::WITHHELD),
            PointFlags(PointFlags::OVERLAP),
        ];
        let (kept, report) = select(Classes::GroundOrAll, None, &[points]);
        assert_eq!(kept, [2.0]);
        assert_eq!((report.withheld, report.classes), (1, None));
    }

    #[test]
    fn a_coordinate_that_is_not_finite_is_refused_by_its_number_in_its_file() {
        let mut selection = Selection::new(Classes::default(), None);
        selection.add(&classless(&[1.0, 2.0])).unwrap();
        selection.next_source();
        let error = selection
            .add(&classless(&[1.0, f64::INFINITY]))
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            "point 2: the coordinates inf 0 inf are not all finite"
        );
        let mut flat = classless(&[1.0]);
        flat.z[0] = f64::NAN;
        selection.next_source();
        assert_eq!(
            selection.add(&flat).unwrap_err().to_string(),
            "point 1: the point has no height"
        );
    }

    /// Only one that is selected counts; its number is that of all points.
    #[test]
    fn a_coordinate_beyond_the_range_is_refused_by_its_number_in_its_file() {
        let mut selection = Selection::new(Classes::Only(vec![2]), None);
        selection.add(&batch(&[(2, 1.0), (2, 2.0)])).unwrap();
        selection.next_source();
        let points = [(3, 1e200), (3, 2.0), (2, 1.0), (2, 1e200)];
        let error = selection.add(&batch(&points)).unwrap_err();
        assert_eq!(error.kind(), crate::error::Kind::Limit);
        assert!(error.to_string().starts_with("point 4: [1e200"), "{error}");
    }
}

//! Files of points: opened, then asked for their coordinate systems, then read.

use std::path::Path;

use super::file_extent::{FileExtent, counted, stated_extent};
use super::narrowed::{Share, narrow};
use super::open;
use super::systems::Stated;
use super::transforms::{FileTransform, Transforms};
use crate::data::{Bounds, Columns, PointBatch, PointSource};
use crate::error::{Error, Kind, Result, Setting, wording};
use crate::io::points::Options;
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage, Work};
use crate::run::request::input::{Input, MemoryPoints};
use crate::terrain::{Classes, Selection};

/// The class of ground points in LAS.
pub(crate) const GROUND: u8 = 2;

/// If there are more files than this, they are not kept open but opened a second time.
pub(crate) const FILES_KEPT_OPEN: usize = 100;

/// The free memory is checked each time that this many further points are to be used.
pub(crate) const ASK_EVERY: usize = 1 << 20;

/// What becomes of files that cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum BadFiles {
    /// They are an error.
    #[default]
    Refuse,
    /// They leave a hole, and are reported.
    Skip,
}

impl BadFiles {
    /// Returns true if a file is skipped that cannot be read for this reason. What the caller asks
    /// for is never skipped, nor is a file that has changed meanwhile.
    pub(crate) fn skips(self, error: &Error) -> bool {
        let is_of_file = matches!(
            error.kind(),
            Kind::Format | Kind::Unsupported | Kind::Limit | Kind::Io
        );
        self == BadFiles::Skip && is_of_file
    }
}

/// A file of points.
struct PointFile {
    input: Input<MemoryPoints>,
    stated: Stated,
    source: Option<Box<dyn PointSource + Send>>,
    count: Option<u64>,
    bounds: Option<Bounds>,
    /// What is known of its points, in the coordinates of the file until they are read, and then
    /// in those of the result.
    extent: FileExtent,
    /// True if the points were read.
    is_read: bool,
    has_classes: bool,
    columns: Option<Columns>,
}

impl PointFile {
    /// What is known of the points in the coordinates of the result, to which this transform leads.
    fn extent(&self, transform: Option<usize>) -> FileExtent {
        if self.is_read || transform.is_none() {
            self.extent
        } else {
            FileExtent {
                bounds: None,
                ..self.extent
            }
        }
    }

    /// The points by which their mean distance is computed, in the coordinates to which a transform
    /// leads; `None` if that is not known yet.
    fn counted(&self, transform: FileTransform) -> Option<FileExtent> {
        let read = self.is_read.then_some(self.extent);
        let stated = self.bounds.and_then(|bounds| transform.around(bounds));
        counted((self.count, stated), read)
    }

    /// Returns true if the file has a point of these classes. Reads until one is found.
    fn has_any(&self, options: Options, classes: &Classes, journal: &Journal) -> Result<bool> {
        let path = self.input.path();
        let mut source = self.reopen(options, &journal.context)?;
        let mut selection = Selection::new(classes.clone(), None);
        let mut batch = PointBatch::default();
        loop {
            journal.context.check()?;
            source.read(&mut batch).map_err(|e| e.in_file(path))?;
            selection.add(&batch).map_err(|e| e.in_file(path))?;
            if batch.is_empty() || selection.report().used > 0 {
                return Ok(!batch.is_empty());
            }
        }
    }

    fn reopen(&self, options: Options, context: &Context) -> Result<Box<dyn PointSource + Send>> {
        open::points(&self.input, options, context).map_err(|e| e.in_file(self.input.path()))
    }
}

/// What reading files of points found.
pub(crate) struct FilesRead {
    /// The extent of each file: that of its points, or for a file that was left out, what it
    /// states.
    pub(crate) extents: Vec<Bounds>,
    /// The points of each file by which their mean distance is computed.
    pub(crate) counted: Vec<FileExtent>,
    pub(crate) left_out: LeftOutFiles,
}

/// Files that are left out, in whole or in part, because they state that their points lie outside
/// of the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LeftOutFiles {
    pub(crate) count: usize,
    /// How many more are read only in part, by their index.
    pub(crate) in_part: usize,
    /// True if they were read until one had a ground point.
    pub(crate) are_searched: bool,
}

impl LeftOutFiles {
    /// Returns how many were not read to their end.
    pub(crate) fn unread(self) -> usize {
        self.count + self.in_part
    }
}

/// The files of points of a run.
pub(crate) struct PointFiles {
    files: Vec<PointFile>,
    options: Options,
    bad: BadFiles,
}

impl PointFiles {
    /// Opens all files and adds a notice about the format of each.
    pub(crate) fn open(
        inputs: &[Input<MemoryPoints>],
        options: Options,
        journal: &Journal,
    ) -> Result<Self> {
        let mut files = Vec::with_capacity(inputs.len());
        for input in inputs {
            let path = input.path();
            let source =
                open::points(input, options, &journal.context).map_err(|e| e.in_file(path))?;
            let info = source.info();
            journal.add(Notice::Opened(path.to_path_buf(), info.format.clone()));
            journal.add_warnings(path, &info.warnings);
            if !info.has_classes && inputs.len() > 1 {
                journal.add(Notice::WithoutClasses(path.to_path_buf()));
            }
            let stated = Stated::by_points(path, info);
            let (count, bounds, columns) = (info.count, info.bounds, info.columns);
            let extent = stated_extent(info);
            let keep = inputs.len() <= FILES_KEPT_OPEN || input.is_read_once();
            let has_classes = info.has_classes;
            let (input, source) = (input.clone(), Some(source).filter(|_| keep));
            files.push(PointFile {
                input,
                stated,
                count,
                bounds,
                extent,
                is_read: false,
                has_classes,
                columns,
                source,
            });
        }
        if options.columns.is_some() && files.iter().all(|file| file.columns.is_none()) {
            return Err(Error::usage(wording![
                Setting::Columns,
                " and ",
                Setting::Parse,
                " name columns of text, but no input is text"
            ]));
        }
        Ok(PointFiles {
            files,
            options,
            bad: BadFiles::Refuse,
        })
    }

    /// Decides what becomes of files whose points turn out to be damaged while something is looked
    /// for in them.
    pub(crate) fn with_bad(self, bad: BadFiles) -> Self {
        PointFiles { bad, ..self }
    }

    pub(crate) fn len(&self) -> usize {
        self.files.len()
    }

    /// Returns true if the points of any file have classes.
    pub(crate) fn have_classes(&self) -> bool {
        self.files.iter().any(|file| file.has_classes)
    }

    /// Returns the coordinate system of each file; `None` for one of several files that has no
    /// point to use.
    ///
    /// To find out, files that state different systems are read until a point is found that is
    /// used.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub(crate) fn stated(
        &self,
        classes: &Classes,
        journal: &Journal,
    ) -> Result<Vec<Option<Stated>>> {
        let mut stated: Vec<Option<Stated>> = self
            .files
            .iter()
            .map(|file| Some(file.stated.clone()))
            .collect();
        let is_one = self
            .files
            .iter()
            .all(|file| file.stated.agrees_with(&self.files[0].stated));
        // A pipe can be read only once.
        if is_one || self.files.iter().any(|file| file.input.is_read_once()) {
            return Ok(stated);
        }
        let (wanted, or_all) = match classes {
            Classes::GroundOrAll => (Classes::Only(vec![GROUND]), true),
            only => (only.clone(), false),
        };
        let mut has_wanted = false;
        for (file, stated) in self.files.iter().zip(&mut stated) {
            match file.has_any(self.options, &wanted, journal) {
                Ok(true) => has_wanted |= file.has_classes,
                Ok(false) => *stated = None,
                // Once it is repaired its points are used: its system counts.
                Err(error) if self.bad.skips(&error) => {}
                Err(error) => return Err(error),
            }
        }
        if or_all && !has_wanted {
            stated = self
                .files
                .iter()
                .map(|file| Some(file.stated.clone()))
                .collect();
        }
        Ok(stated)
    }

    /// Returns the number of points and the box around them that each file states, as far as it
    /// does.
    pub(crate) fn stated_extents(
        &self,
    ) -> impl Iterator<Item = (Option<u64>, Option<Bounds>)> + '_ {
        self.files.iter().map(|file| (file.count, file.bounds))
    }

    /// Returns the classes that are used, without a default that depends on the points: for
    /// [`Classes::GroundOrAll`], files that may have a ground point are read until one is found.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub(crate) fn used_classes(
        &self,
        classes: &Classes,
        may_have_ground: impl Fn(&Path) -> bool,
        journal: &Journal,
    ) -> Result<Vec<u8>> {
        if let Some(classes) = classes.listed() {
            return Ok(classes);
        }
        let may_have_ground = |&i: &usize| may_have_ground(self.files[i].input.path());
        let files: Vec<usize> = (0..self.files.len()).filter(may_have_ground).collect();
        if self.any_has_ground(&files, journal)? {
            Ok(vec![GROUND])
        } else {
            Ok((0..=u8::MAX).collect())
        }
    }

    /// Returns the columns used of text files, each with the number of files.
    pub(crate) fn columns(&self) -> Vec<(Columns, u64)> {
        let mut counts: Vec<(Columns, u64)> = Vec::new();
        for columns in self.files.iter().filter_map(|file| file.columns) {
            match counts.iter_mut().find(|(known, _)| *known == columns) {
                Some((_, count)) => *count += 1,
                None => counts.push((columns, 1)),
            }
        }
        counts
    }

    /// Returns what is known of the points of each file, in the coordinates of the result.
    pub(crate) fn extents(&self, by_file: &[Option<usize>]) -> Vec<FileExtent> {
        let files = self.files.iter().zip(by_file);
        files
            .map(|(file, transform)| file.extent(*transform))
            .collect()
    }

    /// Reads files and adds their points, in the coordinate system of the result, to the selection.
    /// Files that state that all of their points lie outside of its window are left out.
    pub(crate) fn read(
        &mut self,
        by_file: &[Option<usize>],
        transforms: &Transforms,
        selection: &mut Selection,
        journal: &Journal,
    ) -> Result<FilesRead> {
        let extents = self.extents(by_file);
        let window = selection.window().copied();
        let is_within = |i: &usize| window.is_none_or(|window| extents[*i].meets(&window));
        let (within, left_out): (Vec<usize>, Vec<usize>) =
            (0..self.files.len()).partition(is_within);
        let length = within
            .iter()
            .map(|&i| self.files[i].count)
            .sum::<Option<u64>>();
        if let Some(excess) = length.and_then(memory::excess_of) {
            journal.add(excess);
        }
        let progress = journal.start(
            Stage::ReadingPoints,
            length.map_or(Size::Unknown, Size::Items),
        )?;
        let mut reading = Reading {
            transforms,
            selection,
            journal,
            batch: PointBatch::default(),
            asked: 0,
        };
        let mut in_part = Vec::new();
        for &i in &within {
            let file = &mut self.files[i];
            let source = file.source.take();
            let mut source =
                source.map_or_else(|| file.reopen(self.options, &journal.context), Ok)?;
            let path = file.input.path();
            // Of a file that is reprojected, the window is not known in its own coordinates.
            let share = match (&window, by_file[i]) {
                (Some(window), None) => narrow(&mut *source, window, path, journal)?,
                _ => Share::Whole,
            };
            let extent = reading.read(path, source, by_file[i], &progress);
            let extent = extent.map_err(|e| e.in_file(path))?;
            if share == Share::Whole {
                file.extent = extent;
                file.is_read = true;
            } else {
                in_part.push(i);
            }
        }
        progress.end()?;
        let has_classes = |&i: &usize| self.files[i].has_classes;
        let unread: Vec<usize> = left_out.iter().chain(&in_part).copied().collect();
        let are_searched = selection.waits_for_ground() && unread.iter().any(has_classes);
        if are_searched && self.any_has_ground(&unread, journal)? {
            selection.note_ground();
        }
        if self.files.len() > 1 {
            let classes = selection.report().classes;
            for i in selection.unused_sources() {
                journal.add(Notice::NoPointUsed(
                    self.files[within[i]].stated.path.clone(),
                    classes.clone(),
                ));
            }
        }
        let extents = self.extents(by_file);
        Ok(FilesRead {
            counted: self
                .files
                .iter()
                .zip(by_file)
                .filter_map(|(file, number)| file.counted(transforms.numbered(*number)))
                .collect(),
            extents: extents
                .into_iter()
                .map(|extent| extent.bounds.unwrap_or_default())
                .collect(),
            left_out: LeftOutFiles {
                count: left_out.len(),
                in_part: in_part.len(),
                are_searched,
            },
        })
    }

    /// Returns true if one of these files has a ground point. They are read until one is found.
    fn any_has_ground(&self, files: &[usize], journal: &Journal) -> Result<bool> {
        let ground = Classes::Only(vec![GROUND]);
        let files = files.iter().map(|&i| &self.files[i]);
        for file in files.filter(|file| file.has_classes) {
            match file.has_any(self.options, &ground, journal) {
                Ok(true) => return Ok(true),
                Ok(false) => {}
                Err(error) if self.bad.skips(&error) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(false)
    }
}

/// Points of files on their way to a selection.
struct Reading<'a, 'b> {
    transforms: &'a Transforms,
    selection: &'a mut Selection,
    journal: &'a Journal<'b>,
    batch: PointBatch,
    /// The number of points for which memory was asked for.
    asked: usize,
}

impl Reading<'_, '_> {
    /// Reads a file. Returns the number of its points and the box around them.
    fn read(
        &mut self,
        path: &Path,
        mut source: Box<dyn PointSource + Send>,
        transform: Option<usize>,
        progress: &Work,
    ) -> Result<FileExtent> {
        let Reading {
            selection, batch, ..
        } = self;
        selection.next_source();
        let (mut count, mut bounds) = (0, Bounds::default());
        loop {
            source.read(batch)?;
            if batch.is_empty() {
                break;
            }
            self.transforms.apply_to_batch(transform, batch)?;
            selection.add(batch)?;
            if selection.certain() >= self.asked + ASK_EVERY {
                self.asked = selection.certain();
                memory::require_for_points(self.asked)?;
            }
            count += batch.len() as u64;
            progress.add(batch.len() as u64)?;
            (0..batch.len()).for_each(|i| bounds.add([batch.x[i], batch.y[i], batch.z[i]]));
        }
        self.journal
            .add(Notice::PointsRead(path.to_path_buf(), count));
        self.journal.add_warnings(path, source.warnings());
        Ok(FileExtent {
            points: Some(count),
            bounds: Some(bounds),
        })
    }
}

//! Files of points: opened, asked for their systems, then read.

use std::path::{Path, PathBuf};

use super::inputs::is_read_once;
use super::open;
use super::progress::Size;
use super::roads::Roads;
use super::systems::{Role, Stated};
use super::talk::Talk;
use crate::crs::Crs;
use crate::data::{Bounds, Columns, PointBatch, PointSource};
use crate::error::{Error, Result};
use crate::io::points::Options;
use crate::run::memory;
use crate::run::units::counted;
use crate::terrain::{Classes, Selection};

/// The class of ground points in LAS.
const GROUND: u8 = 2;

/// More files than this are opened a second time rather than kept open.
const FILES_KEPT_OPEN: usize = 100;

/// Memory is asked about whenever so many points more are to be used.
const ASK_EVERY: usize = 1 << 20;

/// A file of points.
struct PointFile {
    stated: Stated,
    source: Option<Box<dyn PointSource + Send>>,
    count: Option<u64>,
    has_classes: bool,
    columns: Option<Columns>,
}

/// The files of points of a run.
pub(super) struct PointFiles {
    files: Vec<PointFile>,
    options: Options,
}

impl PointFiles {
    /// Opens them all, and says what is to be said of them.
    pub(super) fn open(paths: &[PathBuf], options: Options, talk: &Talk) -> Result<Self> {
        let mut files = Vec::with_capacity(paths.len());
        for path in paths {
            let source = open::points(path, options).map_err(|e| e.in_file(path))?;
            let info = source.info();
            talk.detail(format_args!("{}: {}", path.display(), info.format));
            info.warnings.iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
            if !info.has_classes && paths.len() > 1 {
                talk.detail(format_args!("{}: no classes, all points are used", path.display()));
            }
            let stated = Stated { path: path.clone(), crs: info.crs.clone(), role: Role::Ground };
            let (count, columns) = (info.count, info.columns);
            let keep = paths.len() <= FILES_KEPT_OPEN || is_read_once(path);
            let has_classes = info.has_classes;
            files.push(PointFile { stated, count, has_classes, columns, source: Some(source).filter(|_| keep) });
        }
        if options.columns.is_some() && files.iter().all(|file| file.columns.is_none()) {
            return Err(Error::usage("--columns and --parse name columns of text, but no input is text"));
        }
        Ok(PointFiles { files, options })
    }

    pub(super) fn len(&self) -> usize {
        self.files.len()
    }

    /// The system of each file. A file of several that gives no points states none: it is not asked.
    ///
    /// # Errors
    /// If a file cannot be read; all are read on until a point of it is used, if they state different systems.
    pub(super) fn stated(&self, classes: &Classes) -> Result<Vec<Option<Stated>>> {
        let mut stated: Vec<Option<Stated>> = self.files.iter().map(|file| Some(file.stated.clone())).collect();
        let is_same = |a: &Option<Crs>, b: &Option<Crs>| match (a, b) {
            (Some(a), Some(b)) => a.is_same(b),
            (None, None) => true,
            _ => false,
        };
        let is_one = self.files.iter().all(|file| is_same(&file.stated.crs, &self.files[0].stated.crs));
        // What comes through a pipe is read once.
        if is_one || self.files.iter().any(|file| is_read_once(&file.stated.path)) {
            return Ok(stated);
        }
        let (wanted, or_all) = match classes {
            Classes::GroundOrAll => (Classes::Only(vec![GROUND]), true),
            only => (only.clone(), false),
        };
        let mut has_wanted = false;
        for (file, stated) in self.files.iter().zip(&mut stated) {
            if self.has_any(&file.stated.path, &wanted)? {
                has_wanted |= file.has_classes;
            } else {
                *stated = None;
            }
        }
        if or_all && !has_wanted {
            stated = self.files.iter().map(|file| Some(file.stated.clone())).collect();
        }
        Ok(stated)
    }

    /// Whether a file has points of these classes; read until one is found.
    fn has_any(&self, path: &Path, classes: &Classes) -> Result<bool> {
        let mut source = self.reopen(path)?;
        let mut selection = Selection::new(classes.clone(), None);
        let mut batch = PointBatch::default();
        loop {
            source.read(&mut batch).map_err(|e| e.in_file(path))?;
            selection.add(&batch).map_err(|e| e.in_file(path))?;
            if batch.is_empty() || selection.report().used > 0 {
                return Ok(!batch.is_empty());
            }
        }
    }

    fn reopen(&self, path: &Path) -> Result<Box<dyn PointSource + Send>> {
        open::points(path, self.options).map_err(|e| e.in_file(path))
    }

    /// Which columns of text were taken, and of how many files: "x 3, y 2, z 4 (2 files)".
    pub(super) fn columns_line(&self) -> Option<String> {
        let mut counts: Vec<(Columns, u64)> = Vec::new();
        for columns in self.files.iter().filter_map(|file| file.columns) {
            match counts.iter_mut().find(|(known, _)| *known == columns) {
                Some((_, count)) => *count += 1,
                None => counts.push((columns, 1)),
            }
        }
        match counts.as_slice() {
            [] => None,
            [(columns, _)] => Some(columns.to_string()),
            several => {
                let texts = several.iter().map(|(columns, count)| format!("{columns} ({})", counted(*count, "file")));
                Some(texts.collect::<Vec<_>>().join("; "))
            }
        }
    }

    /// Reads them all; their points in the system of the result go to the selection. Returns the extents of the files, if
    /// they are several.
    pub(super) fn read(
        &mut self,
        by_file: &[Option<usize>],
        roads: &Roads,
        selection: &mut Selection,
        talk: &Talk,
    ) -> Result<Vec<Bounds>> {
        let length = self.files.iter().map(|file| file.count).sum::<Option<u64>>();
        if let Some(excess) = length.and_then(memory::excess_of) {
            talk.warning(format_args!("memory may not suffice: if all points are used they take {excess}"));
        }
        let mut asked = 0;
        let progress = talk.progress("reading points", length.map_or(Size::Unknown, Size::Items));
        let mut batch = PointBatch::default();
        let mut extents = Vec::new();
        for (i, road) in (0..self.files.len()).zip(by_file) {
            let source = self.files[i].source.take();
            let path = &self.files[i].stated.path;
            let mut source = source.map_or_else(|| self.reopen(path), Ok)?;
            selection.next_source();
            let mut count = 0;
            let mut extent = Bounds::default();
            loop {
                source.read(&mut batch).map_err(|e| e.in_file(path))?;
                if batch.is_empty() {
                    break;
                }
                roads.take_batch(*road, &mut batch).map_err(|e| e.in_file(path))?;
                selection.add(&batch).map_err(|e| e.in_file(path))?;
                if selection.certain() >= asked + ASK_EVERY {
                    asked = selection.certain();
                    memory::require_for_points(asked)?;
                }
                count += batch.len() as u64;
                progress.add(batch.len() as u64);
                if self.files.len() > 1 {
                    (0..batch.len()).for_each(|i| extent.add([batch.x[i], batch.y[i], batch.z[i]]));
                }
            }
            extents.push(extent);
            talk.detail(format_args!("{}: {count} points read", path.display()));
            source.warnings().iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
        }
        drop(progress);
        if self.files.len() > 1 {
            let why = match selection.report().classes {
                Some(classes) => {
                    let classes: Vec<String> = classes.iter().map(u8::to_string).collect();
                    format!("it has none of class {}", classes.join(" or "))
                }
                None => "it has none".to_owned(),
            };
            for i in selection.unused_sources() {
                let path = self.files[i].stated.path.display();
                talk.warning(format_args!("{path}: no point of it is used: {why}"));
            }
        }
        Ok(extents)
    }
}

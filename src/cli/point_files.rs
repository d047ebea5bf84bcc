//! Files of points: opened, asked for their systems, then read.

use std::path::PathBuf;

use super::open;
use super::roads::Roads;
use super::systems::{Role, Stated};
use super::talk::Talk;
use super::units::counted;
use crate::data::{Columns, PointBatch, PointSource};
use crate::error::{Error, Result};
use crate::io::points::Options;
use crate::terrain::Selection;

/// More files than this are opened a second time rather than kept open.
const FILES_KEPT_OPEN: usize = 100;

/// A file of points.
pub(super) struct PointFile {
    pub(super) stated: Stated,
    source: Option<Box<dyn PointSource + Send>>,
    count: Option<u64>,
    columns: Option<Columns>,
}

/// Opens them all, and says what is to be said of them.
pub(super) fn open_all(paths: &[PathBuf], options: Options, talk: &Talk) -> Result<Vec<PointFile>> {
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
        let keep = paths.len() <= FILES_KEPT_OPEN || path.as_os_str() == super::inputs::STDIN;
        files.push(PointFile { stated, count, columns, source: Some(source).filter(|_| keep) });
    }
    if options.columns.is_some() && files.iter().all(|file| file.columns.is_none()) {
        return Err(Error::usage("--columns and --parse name columns of text, but no input is text"));
    }
    Ok(files)
}

/// Which columns of text were taken, and of how many files: "x 3, y 2, z 4 (2 files)".
pub(super) fn columns_line(files: &[PointFile]) -> Option<String> {
    let mut counts: Vec<(Columns, usize)> = Vec::new();
    for columns in files.iter().filter_map(|file| file.columns) {
        match counts.iter_mut().find(|(known, _)| *known == columns) {
            Some((_, count)) => *count += 1,
            None => counts.push((columns, 1)),
        }
    }
    let texts: Vec<String> = match counts.as_slice() {
        [] => return None,
        [(columns, _)] => vec![columns.to_string()],
        several => {
            several.iter().map(|(columns, count)| format!("{columns} ({})", counted(*count as u64, "file"))).collect()
        }
    };
    Some(texts.join("; "))
}

/// Reads them all; their points in the system of the result go to the selection.
pub(super) fn read_all(
    files: &mut [PointFile],
    by_file: &[Option<usize>],
    options: Options,
    roads: &Roads,
    selection: &mut Selection,
    talk: &Talk,
) -> Result<()> {
    let length = files.iter().map(|file| file.count).sum::<Option<u64>>();
    let bar = talk.bar("reading points", length);
    let mut batch = PointBatch::default();
    for (file, road) in files.iter_mut().zip(by_file) {
        let path = &file.stated.path;
        let mut source = match file.source.take() {
            Some(source) => source,
            None => open::points(path, options).map_err(|e| e.in_file(path))?,
        };
        selection.next_source();
        let mut count = 0;
        loop {
            source.read(&mut batch).map_err(|e| e.in_file(path))?;
            if batch.is_empty() {
                break;
            }
            roads.take_batch(*road, &mut batch).map_err(|e| e.in_file(path))?;
            selection.add(&batch).map_err(|e| e.in_file(path))?;
            count += batch.len() as u64;
            bar.inc(batch.len() as u64);
        }
        talk.detail(format_args!("{}: {count} points read", path.display()));
        source.warnings().iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
    }
    bar.finish_and_clear();
    Ok(())
}

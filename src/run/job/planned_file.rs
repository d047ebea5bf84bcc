//! Files of points as a plan knows them, and the states of files.

use std::collections::BTreeMap;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};

use crate::crs::Crs;
use crate::data::{Bounds, PointBatch};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::{formats, gdal, layer};
use crate::run::context::units::neat;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::products::tin::TinRequest;
use crate::run::request::input::{Input, MemoryPoints};
use crate::run::sources::checksum::checksum;
use crate::run::sources::file_extent::{FileExtent, with_rounding};
use crate::run::sources::open;
use crate::run::sources::transforms::{FileTransform, TargetSystem, Transforms};
use crate::terrain::tiles::Spread;

/// The state of a file and of those that are read along with it, which differs once one of them has
/// changed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileState {
    /// The length in bytes.
    pub size: u64,
    /// The time of the last change, in nanoseconds since 1970.
    pub modified: u64,
    /// A checksum of the names, lengths and times of the files that are read along with it, such as
    /// `roads.dbf` with `roads.shp`, or that are in it, if it is a folder; 0 if there are none.
    #[serde(default)]
    pub beside: u32,
}

/// A file of points as the plan knows it. A plan has its position in the request only: so it may be
/// read under another name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PlannedFile {
    /// The position of the file in the request.
    pub(super) input: usize,
    #[serde(skip)]
    pub(super) path: PathBuf,
    /// The checksum of the whole name that it was planned under.
    pub(super) name: u32,
    /// The tile that the file is; `None` if it is divided among tiles.
    pub(super) tile: Option<u32>,
    /// As it was planned with.
    pub(super) state: FileState,
    /// The number of its points.
    pub(super) count: u64,
    /// The system that its points are reprojected from, if they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) from: Option<Crs>,
    /// The box around its points in plan, as its header states it; if they are reprojected, one
    /// that contains it in the system of the result.
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
    /// True if its coordinate system was not known, because it was damaged. Else it agrees with the
    /// others.
    pub(super) is_of_any_system: bool,
}

impl PlannedFile {
    /// Returns the transforms to the system of the result of one file, which is this one.
    pub(super) fn transforms(&self, to: TargetSystem, context: &Context) -> Result<Transforms> {
        let journal = Journal::new(&context.quiet());
        Transforms::new(std::slice::from_ref(&self.from), to, &journal)
    }

    /// Returns the box around its points in plan, as its header states it.
    pub(super) fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::default();
        [self.min, self.max]
            .into_iter()
            .for_each(|[x, y]| bounds.add([x, y, 0.0]));
        bounds
    }

    /// Returns the number of its points and the box around them, as its header states them.
    pub(super) fn extent(&self) -> FileExtent {
        FileExtent {
            points: Some(self.count),
            bounds: Some(self.bounds()),
        }
    }

    /// Returns the box around its points, with what rounding may add to a header.
    pub(super) fn spread(&self) -> Spread {
        let [min, max] = with_rounding([self.min, self.max]);
        Spread {
            min,
            max,
            count: self.count as f64,
        }
    }

    /// Returns an error unless points that were read are where the plan expects them: elsewhere
    /// they could be in tiles that do not read this file.
    pub(super) fn require_within(&self, points: &[[f64; 3]]) -> Result<()> {
        let spread = self.spread();
        let Some(&[x, y, _]) = points
            .iter()
            .find(|point| !spread.holds([point[0], point[1]]))
        else {
            return Ok(());
        };
        let ([x0, y0], [x1, y1]) = (self.min.map(neat), self.max.map(neat));
        let [x, y] = [x, y].map(neat);
        let reprojected = match &self.from {
            Some(from) => format!(", reprojected from {from}"),
            None => String::new(),
        };
        Err(Error::format(format!(
            "there is a point at {x} {y}, but the header states an extent from {x0} {y0} to {x1} {y1}{reprojected}"
        ))
        .cure(wording![Command::Points, " writes a file with a true header"]))
    }
}

/// Returns the length of a file in bytes; 0 if it cannot be asked for.
pub(super) fn length_of(path: &Path) -> u64 {
    found(path).map_or(0, |(_, about)| about.len())
}

/// The bytes of a point in a text, at least.
const BYTES_A_POINT_OF_TEXT: u64 = 24;

/// Returns about how many points a file has that does not state it.
pub(super) fn points_of_text(path: &Path) -> u64 {
    length_of(path) / BYTES_A_POINT_OF_TEXT
}

/// The files of points of an earlier plan, so that they are not read again only to learn the same.
#[derive(Default)]
pub(super) struct KnownFiles<'a> {
    /// By the checksums of their names.
    files: BTreeMap<u32, &'a PlannedFile>,
    /// True if none of them has a ground point, for a request that depends on that.
    have_no_ground: bool,
}

impl<'a> KnownFiles<'a> {
    /// Returns the files of a plan that uses these classes.
    pub(super) fn of(files: &'a [PlannedFile], classes: &[u8]) -> Self {
        KnownFiles {
            files: files.iter().map(|file| (file.name, file)).collect(),
            have_no_ground: classes.len() > 1,
        }
    }

    /// Returns a file as it was planned with, if it has not changed since.
    fn unchanged(&self, path: &Path) -> Option<&'a PlannedFile> {
        let file = self.files.get(&name_of(path).ok()?)?;
        (state_of(path).ok()? == file.state).then_some(*file)
    }

    /// Returns true unless a file is known to have no ground point.
    pub(super) fn may_have_ground(&self, path: &Path) -> bool {
        !self.have_no_ground || self.unchanged(path).is_none()
    }
}

/// Returns the checksum of the whole name of a file.
fn name_of(path: &Path) -> Result<u32> {
    let whole = std::path::absolute(path).map_err(|e| Error::from(e).in_file(path))?;
    Ok(checksum(whole.as_os_str().as_encoded_bytes()))
}

/// Returns what the plan has to know of a file, whose points a transform reprojects; `None` if it
/// has no points.
pub(super) fn planned(
    number: usize,
    request: &TinRequest,
    stated: (Option<u64>, Option<Bounds>),
    transform: FileTransform,
    known: &KnownFiles,
    context: &Context,
) -> Result<Option<PlannedFile>> {
    let input = &request.points[number];
    let path = input.path();
    let state = state_of(path)?;
    let stated = match stated {
        (Some(0), _) => return Ok(None),
        (Some(count), Some(bounds)) => transform.around(bounds).map(|around| (count, around)),
        _ => None,
    };
    let (count, bounds) = match stated {
        Some(stated) => stated,
        // Of one that is reprojected, the extent depends on the system of the result, too.
        None => match known.unchanged(path).filter(|_| transform.from().is_none()) {
            Some(file) if file.from.is_none() => (file.count, file.bounds()),
            _ => measured(input, request, transform, context).map_err(|e| e.in_file(path))?,
        },
    };
    if count == 0 {
        return Ok(None);
    }
    let is_finite = (0..2).all(|k| bounds.min[k].is_finite() && bounds.max[k].is_finite());
    if !is_finite {
        return Err(
            Error::format("the header states an extent that is not finite")
                .in_file(path)
                .cure(wording![
                    Command::Points,
                    " writes a file with a true header"
                ]),
        );
    }
    let [min, max] = [bounds.min, bounds.max].map(|[x, y, _]| [x, y]);
    Ok(Some(PlannedFile {
        input: number,
        path: path.to_path_buf(),
        name: name_of(path)?,
        tile: None,
        state,
        count,
        from: transform.from().cloned(),
        min,
        max,
        is_of_any_system: false,
    }))
}

/// Opens a file of points and returns what the plan has to know of it; `None` if it has no points.
pub(super) fn looked_at(
    number: usize,
    request: &TinRequest,
    transform: FileTransform,
    context: &Context,
) -> Result<Option<PlannedFile>> {
    let input = &request.points[number];
    let look = || {
        let source = open::points(input, request.read, context)?;
        let info = source.info();
        let stated = (info.count, info.bounds);
        let known = KnownFiles::default();
        planned(number, request, stated, transform, &known, context)
    };
    look().map_err(|e| e.in_file(input.path()))
}

/// Counts the points of a file that does not state their number or extent, or not in a system from
/// which a box can be reprojected.
fn measured(
    input: &Input<MemoryPoints>,
    request: &TinRequest,
    transform: FileTransform,
    context: &Context,
) -> Result<(u64, Bounds)> {
    let mut source = open::points(input, request.read, context)?;
    let work = context.start(Stage::ReadingPoints, Size::Unknown)?;
    let (mut count, mut bounds) = (0, Bounds::default());
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            return Ok((count, bounds));
        }
        count += batch.len() as u64;
        transform.apply_to_batch(&mut batch)?;
        (0..batch.len()).for_each(|i| bounds.add([batch.x[i], batch.y[i], batch.z[i]]));
        work.add(batch.len() as u64)?;
    }
}

/// Returns an error unless a file is as it was planned with, or read; the job is in `folder`.
pub(super) fn require_state(path: &Path, planned: FileState, folder: &Path) -> Result<()> {
    if state_of(path)? == planned {
        return Ok(());
    }
    Err(
        Error::usage("the file has changed since the job was planned")
            .in_file(path)
            .cure(wording![
                "plan the job again: ",
                Command::JobClean.on(folder.display().to_string()),
                " removes this one"
            ]),
    )
}

/// Returns an error if a file of points that cannot be read is missing, together with all others of
/// its folder: rather than damaged files, that is a file system which is not mounted, or a folder
/// that was moved.
///
/// # Errors
/// Names the file.
pub(super) fn require_folder(path: &Path, request: &TinRequest) -> Result<()> {
    if state_of(path).is_ok() {
        return Ok(());
    }
    let Some(folder) = path.parent() else {
        return Ok(());
    };
    let mut others = request.points.iter().map(Input::path);
    if others.any(|other| other.parent() == Some(folder) && state_of(other).is_ok()) {
        return Ok(());
    }
    let what = match folder == Path::new("") || folder.is_dir() {
        true => "the file is missing, and so are all others of its folder",
        false => "the file is missing, and so is its folder",
    };
    Err(Error::usage(what).in_file(path).cure(wording![
        "make sure that the file system is mounted; ",
        Setting::SkipBad,
        " skips a file only while another one of its folder is there"
    ]))
}

/// Returns the name of a file without that of a layer, which may follow, and what the system knows
/// of the file.
fn found(path: &Path) -> Result<(&Path, Metadata)> {
    if gdal::is_name(path) {
        return Err(
            Error::usage("a job notices when its inputs change, and this one is no file")
                .in_file(path)
                .cure("copy it to a file"),
        );
    }
    match std::fs::metadata(path) {
        Ok(about) => Ok((path, about)),
        Err(error) => {
            let named = path.to_str().map(|text| Path::new(layer::file_of(text)));
            let found = named.and_then(|file| Some((file, std::fs::metadata(file).ok()?)));
            match found {
                Some(found) if error.kind() == std::io::ErrorKind::NotFound => Ok(found),
                _ => Err(Error::from(error).in_file(path)),
            }
        }
    }
}

/// Returns the state of a file, which may be named together with a layer.
pub(super) fn state_of(path: &Path) -> Result<FileState> {
    let (path, about) = found(path)?;
    let beside = match about.is_dir() {
        true => files_in(path).map_err(|e| Error::from(e).in_file(path))?,
        false => formats::found_along_with(path),
    };
    Ok(FileState {
        size: about.len(),
        modified: modified(&about),
        beside: sum_of_states(&beside),
    })
}

/// Returns when a file was changed, in nanoseconds since 1970.
fn modified(about: &Metadata) -> u64 {
    let modified = about
        .modified()
        .ok()
        .and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    modified.map_or(0, |time| time.as_nanos() as u64)
}

/// Returns what is in a folder, in an order that does not depend on the file system.
fn files_in(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::io::Result<Vec<_>>>()?;
    files.sort_unstable();
    Ok(files)
}

/// Returns a checksum of the names and states of files; 0 if there are none. Empty ones do not
/// count: readers of databases create such files while they read.
fn sum_of_states(files: &[PathBuf]) -> u32 {
    let state = |path: &PathBuf| {
        let about = std::fs::metadata(path)
            .ok()
            .filter(|about| about.len() > 0)?;
        let name = path.file_name().unwrap_or_default();
        Some((name.to_owned(), about.len(), modified(&about)))
    };
    let states: Vec<_> = files.iter().filter_map(state).collect();
    match states.is_empty() {
        true => 0,
        false => checksum(format!("{states:?}").as_bytes()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The heights of a field are in the table, not in the file that is named.
    #[test]
    fn the_state_of_a_file_covers_what_is_read_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        for (file, beside) in [
            ("a.shp", "a.dbf"),
            ("b.shp:ELEV", "b.DBF"),
            ("c.gpkg:lines", "c.gpkg-wal"),
            ("d.gdb", "d.gdb/a00000001.gdbtable"),
        ] {
            let (main, _) = file.split_once(':').unwrap_or((file, ""));
            match main.ends_with(".gdb") {
                true => write(&format!("{main}/gdb"), "4"),
                false => write(main, "points"),
            }
            let state = || state_of(&folder.path().join(file)).unwrap();
            write(&format!("{main}.other"), "not read");
            let alone = state();
            write(beside, "");
            assert_eq!(state().beside, alone.beside, "{file}");
            write(beside, "heights");
            let first = state();
            assert_ne!(first.beside, alone.beside, "{file}");
            write(beside, "other heights");
            assert_ne!(state().beside, first.beside, "{file}");
        }
        assert!(state_of(&folder.path().join("e.shp:ELEV")).is_err());
    }
}

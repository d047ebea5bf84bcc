//! The plan of a job: which tiles there are, and what all tasks must agree on.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::not_in_tiles::NotInTiles;
use super::planned_file::{FileState, PlannedFile, looked_at, require_state, state_of};
use super::request::Options;
use crate::crs::Crs;
use crate::data::{Bounds, Frame};
use crate::error::{Command, Error, Result, wording};
use crate::run::context::Context;
use crate::run::products::tin::TinRequest;
use crate::run::request::input::Input;
use crate::run::request::serialized;
use crate::run::sources::point_files::GROUND;
use crate::run::sources::proj::TransformOptions;
use crate::run::sources::transforms::TargetSystem;
use crate::run::verbs::Verb;
use crate::terrain::tiles::{Spread, TileLayout, Work};
use crate::terrain::{Classes, SelectionReport};

/// Bytes per point of a tile while it is triangulated and drawn; measured.
pub(super) const BYTES_A_POINT: u64 = 220;

/// A file that is read beside the points, as it was planned with. A plan does not name it: it has
/// those of the request in their order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct OtherFile {
    #[serde(skip)]
    path: PathBuf,
    pub(super) state: FileState,
}

impl OtherFile {
    /// Returns a file with its present state.
    pub(super) fn of(path: &Path) -> Result<Self> {
        Ok(OtherFile {
            path: path.to_path_buf(),
            state: state_of(path)?,
        })
    }
}

/// What all tasks of a job must agree on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Plan {
    /// The options of the request, so that another one does not go on with this job.
    pub(super) request: Options,
    /// The files that have points.
    pub(super) files: Vec<PlannedFile>,
    /// The other files that are read: layers of lines, a raster to align to.
    pub(super) others: Vec<OtherFile>,
    /// The files that are skipped because they cannot be opened: their positions in the request,
    /// and why.
    pub(super) skipped: Vec<(usize, String)>,
    /// True if files whose points turn out to be damaged are skipped, too.
    pub(super) skips_bad: bool,
    /// True if there are lines, which one task arranges.
    pub(super) has_lines: bool,
    /// True if the surface is cut along lines, which one task does.
    pub(super) has_clip: bool,
    pub(super) layout: TileLayout,
    /// The coordinate system of the result.
    pub(super) crs: Option<Crs>,
    /// The systems that the layers of lines are reprojected from, if they are.
    pub(super) layers_from: Vec<Option<Crs>>,
    /// How coordinates are reprojected.
    #[serde(default)]
    pub(super) transform: TransformOptions,
    /// The classes that are used.
    pub(super) classes: Vec<u8>,
    /// The longest edge at the rim.
    pub(super) max_edge: Option<f64>,
    /// The frame that triangles are drawn in, for a raster: it covers all points, or is that of the
    /// result.
    #[serde(with = "serialized::frame")]
    pub(super) frame: Option<Frame>,
    /// The blocks of cells that the frame was enlarged by on the left and above, since the job
    /// began: tasks count blocks from where it began.
    pub(super) blocks_before: [u64; 2],
    /// The memory of one task.
    pub(super) task_memory: u64,
    /// About how many points the fullest tile had when the tiles were chosen.
    pub(super) fullest: u64,
}

/// Returns an error if the request has something that tiles do not have yet.
pub(super) fn require_tiled(request: &TinRequest) -> Result<()> {
    if let Some(what) = NotInTiles::of(request) {
        return Err(what.into());
    }
    request.check_bounds()?;
    request.check_layers()?;
    require_readable_again(request)
}

/// Returns an error if points are in memory, or come from what can be read only once.
pub(super) fn require_readable_again(request: &TinRequest) -> Result<()> {
    if let Some(input) = request
        .points
        .iter()
        .find(|input| !matches!(input, Input::File(_)) || input.is_read_once())
    {
        return Err(Error::usage(
            "tiles are made of files, which can be read again after an interruption",
        )
        .in_file(input.path())
        .cure("write the points to a file first"));
    }
    Ok(())
}

impl Plan {
    /// Returns where coordinates are reprojected to, and how.
    pub(super) fn target_system(&self) -> TargetSystem<'_> {
        TargetSystem {
            crs: self.crs.as_ref(),
            options: &self.transform,
        }
    }

    /// Returns true if some files are divided among tiles first: they are not tiles themselves, or
    /// there are lines.
    pub(super) fn divides(&self) -> bool {
        self.files.iter().any(|file| file.tile.is_none())
    }

    /// Returns the box in plan around all points, as the files state it.
    pub(super) fn extent(&self) -> Bounds {
        extent_of(&self.files)
    }

    /// Returns the box in plan around all points, to the digit that the files state.
    pub(super) fn stated_extent(&self) -> Bounds {
        let mut extent = Bounds::default();
        self.files
            .iter()
            .for_each(|file| extent.merge(&file.bounds()));
        extent
    }

    /// Returns the number of points that the files state.
    pub(super) fn point_count(&self) -> u64 {
        self.files.iter().map(|file| file.count).sum()
    }

    /// Returns the number of points that are divided among tiles.
    pub(super) fn divided_points(&self) -> u64 {
        let divided = self.files.iter().filter(|file| file.tile.is_none());
        divided.map(|file| file.count).sum()
    }

    /// Returns about how many cells of the frame are drawn: those within the extents of the files,
    /// or around all of them if triangles may be between them; with lines, all.
    pub(super) fn cells(&self) -> u64 {
        let Some(frame) = &self.frame else { return 0 };
        let all = frame.width as f64 * frame.height as f64;
        if self.has_lines {
            return all as u64;
        }
        let [min, max] = [frame.extent().min, frame.extent().max];
        let drawn = match self.max_edge {
            Some(_) => self.files.iter().map(PlannedFile::bounds).collect(),
            None => vec![self.stated_extent()],
        };
        let side = |drawn: &Bounds, k: usize| {
            (drawn.max[k].min(max[k]) - drawn.min[k].max(min[k])).max(0.0)
        };
        let covered: f64 = drawn
            .iter()
            .map(|drawn| side(drawn, 0) * side(drawn, 1))
            .sum();
        (all * (covered / ((max[0] - min[0]) * (max[1] - min[1]))).min(1.0)) as u64
    }

    /// Returns the number of merges.
    pub(super) fn merge_count(&self) -> usize {
        self.layout
            .steps()
            .iter()
            .filter(|step| matches!(step.work, Work::Merge(_)))
            .count()
    }

    /// Returns an error if a file states another coordinate system than the others, which was not
    /// known when the job was planned.
    pub(super) fn require_system(
        &self,
        number: usize,
        stated: Option<&Crs>,
        folder: &Path,
    ) -> Result<()> {
        let is_same = |own: &Crs| self.crs.as_ref().is_some_and(|crs| crs.is_same(own));
        match stated.filter(|own| self.files[number].is_of_any_system && !is_same(own)) {
            Some(own) => Err(does_not_fit(
                format!("the file states {own}, which was not known when the job was planned"),
                folder,
            )),
            None => Ok(()),
        }
    }

    /// Returns an error if ground points are found after all were planned with, since there was
    /// none.
    pub(super) fn require_classes(
        &self,
        report: &SelectionReport,
        request: &TinRequest,
        folder: &Path,
    ) -> Result<()> {
        let all_are_used = request.classes == Classes::GroundOrAll && self.classes.len() > 1;
        if all_are_used && report.by_class.contains_key(&GROUND) {
            return Err(does_not_fit(
                "there are points of class 2 (ground), but the job was planned without".to_owned(),
                folder,
            ));
        }
        Ok(())
    }

    /// Returns an error if any file but those of points has changed since the plan was made.
    pub(super) fn require_others_unchanged(&self, folder: &Path) -> Result<()> {
        self.others
            .iter()
            .try_for_each(|OtherFile { path, state }| require_state(path, *state, folder))
    }

    /// Returns the plan with the names that a request has for its files; `None` if it is not that
    /// of this request.
    pub(super) fn named(mut self, request: &TinRequest, verb: &dyn Verb) -> Option<Self> {
        for file in &mut self.files {
            file.path = request.points.get(file.input)?.path().to_path_buf();
        }
        let is_known = |(input, _): &(usize, String)| *input < request.points.len();
        let others: Vec<&PathBuf> = others(request, verb).collect();
        if others.len() != self.others.len() || !self.skipped.iter().all(is_known) {
            return None;
        }
        self.others
            .iter_mut()
            .zip(others)
            .for_each(|(file, path)| file.path.clone_from(path));
        Some(self)
    }

    /// Returns an error if a file is not the one that was planned with. One that was changed
    /// afterwards counts as repaired if it has as many points, and the same extent.
    pub(super) fn require_same_points(
        &self,
        number: usize,
        request: &TinRequest,
        folder: &Path,
    ) -> Result<()> {
        let file = &self.files[number];
        if state_of(&file.path)? == file.state {
            return Ok(());
        }
        let context = Context::default();
        let transforms = file.transforms(self.target_system(), &context)?;
        let found = looked_at(file.input, request, transforms.of_file(0), &context)?;
        match found {
            Some(found)
                if (found.count, found.min, found.max) == (file.count, file.min, file.max) =>
            {
                Ok(())
            }
            _ => Err(does_not_fit(
                "the file was replaced by one of another extent or number of points".to_owned(),
                folder,
            )
            .in_file(&file.path)),
        }
    }
}

/// Returns the error for a file that was damaged when the job was planned, and does not fit it now.
#[cold]
fn does_not_fit(what: String, folder: &Path) -> Error {
    Error::usage(what).cure(wording![
        "plan the job again: ",
        Command::JobClean.on(folder.display().to_string()),
        " removes this one"
    ])
}

/// Returns the box in plan around the points of files.
pub(super) fn extent_of(files: &[PlannedFile]) -> Bounds {
    let mut extent = Bounds::default();
    for Spread { min, max, .. } in files.iter().map(PlannedFile::spread) {
        [min, max]
            .into_iter()
            .for_each(|[x, y]| extent.add([x, y, 0.0]));
    }
    extent
}

/// Returns the files that are read beside the points: layers of lines, a raster to align to.
pub(super) fn others<'a>(
    request: &'a TinRequest,
    verb: &'a dyn Verb,
) -> impl Iterator<Item = &'a PathBuf> {
    let layers = request
        .lines
        .inputs()
        .into_iter()
        .flat_map(|(_, inputs)| inputs);
    let layers = layers.chain(&request.breaklines).chain(&request.boundary);
    let layers = layers.filter_map(|input| match input {
        Input::File(path) => Some(path),
        Input::Memory(_) => None,
    });
    layers.chain(verb.also_reads())
}

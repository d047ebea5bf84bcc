//! The plan of a job: which tiles there are, and what all tasks must agree on.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::division::Division;
use super::lines::{self, Known};
use super::not_in_tiles::NotInTiles;
use super::planned_file::{
    FileState, PlannedFile, looked_at, planned, require_folder, require_state, state_of,
};
use super::request::{Options, options_of};
use super::sampled;
use super::tile_options::{Look, TileOptions};
use crate::crs::Crs;
use crate::data::{Bounds, Frame, PointInfo};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal};
use crate::run::products::frame::{self, FrameOptions};
use crate::run::products::tin::TinRequest;
use crate::run::request::input::{Input, MemoryPoints};
use crate::run::request::serialized;
use crate::run::sources::open;
use crate::run::sources::point_files::{BadFiles, GROUND, PointFiles};
use crate::run::sources::systems::{self, Stated, SystemOptions, Systems};
use crate::run::verbs::{Keeps, Verb};
use crate::terrain::tiles::{Spread, TileLayout, Work};
use crate::terrain::{Classes, SelectionReport};

/// Bytes per point of a tile while it is triangulated and drawn; measured.
pub(super) const BYTES_A_POINT: u64 = 220;

/// Tiles with more points than this gain nothing.
const MOST_POINTS: u64 = 1_000_000;

/// Tiles with fewer points than this hand up much of what they have.
const LEAST_POINTS: u64 = 10_000;

/// The share of the most points that a tile has on average: files may be denser in one place.
const AVERAGE: f64 = 0.5;

/// A file that is read beside the points, as it was planned with. A plan does not name it: it has
/// those of the request in their order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct OtherFile {
    #[serde(skip)]
    path: PathBuf,
    state: FileState,
}

impl OtherFile {
    /// Returns a file with its present state.
    fn of(path: &Path) -> Result<Self> {
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
    /// True if the files are divided among tiles first: they are not tiles themselves, or there are
    /// lines.
    pub(super) divides: bool,
    /// True if there are lines, which one task arranges.
    pub(super) has_lines: bool,
    /// True if the surface is cut along lines, which one task does.
    pub(super) has_clip: bool,
    pub(super) layout: TileLayout,
    /// The coordinate system of the result.
    pub(super) crs: Option<Crs>,
    /// The classes that are used.
    pub(super) classes: Vec<u8>,
    /// The longest edge at the rim.
    pub(super) max_edge: Option<f64>,
    /// The frame that triangles are drawn in, for a raster: it covers all points, or is that of the
    /// result.
    #[serde(with = "serialized::frame")]
    pub(super) frame: Option<Frame>,
    /// The memory of one task.
    pub(super) task_memory: u64,
}

/// Returns an error if the request has something that tiles do not have yet.
pub(super) fn require_tiled(request: &TinRequest, systems: &SystemOptions) -> Result<()> {
    if let Some(what) = NotInTiles::of(request, systems) {
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
    /// Chooses the tiles for the files of a request, by what their headers state; files that do not
    /// state it are read once. Also returns what was found out on the way.
    pub(super) fn new(
        request: &TinRequest,
        systems: &SystemOptions,
        verb: &dyn Verb,
        options: &TileOptions,
        journal: &Journal,
    ) -> Result<(Self, Known)> {
        require_tiled(request, systems)?;
        let FilesOfPoints {
            points,
            closed,
            classes,
            files,
            skipped,
        } = FilesOfPoints::of(request, systems, options, journal)?;
        let extent = extent_of(&files);
        let layers = lines::layers_of(request, journal)?;
        let mut stated = points.stated(&request.classes, journal)?;
        drop(points);
        stated.extend(
            closed
                .iter()
                .filter_map(|file| file.stated(request))
                .map(Some),
        );
        stated.extend(layers.stated());
        let Systems { crs, .. } = systems::reconcile_some(&stated, systems, journal)?;
        let known = Known::of_layers(&layers, request, crs.as_ref(), &extent, journal)?;
        if files.is_empty() {
            return Err(
                Error::format("no points in the input").cure("pass files that contain points")
            );
        }
        let task_memory = task_memory(options);
        let most = (task_memory / BYTES_A_POINT).clamp(LEAST_POINTS, MOST_POINTS);
        let (layout, divides) = layout_of(
            &files,
            &classes,
            &known,
            most,
            request,
            options,
            &journal.context,
        )?;
        let frame = match verb.keeps() {
            Keeps::Heights(options) => Some(frame_of(
                options,
                drawn_extent(extent, &known, request),
                crs.as_ref(),
                journal,
            )?),
            Keeps::Contours(_) | Keeps::Triangles => None,
        };
        let max_edge = request.max_edge.length(&Units::of(crs.as_ref()));
        let (has_lines, has_clip) = (known.lines.is_some(), known.clip.is_some());
        let others = others(request, verb)
            .map(|path| OtherFile::of(path))
            .collect::<Result<_>>()?;
        let plan = Plan {
            request: options_of(request, systems, verb, options),
            files,
            others,
            skipped,
            skips_bad: options.bad == BadFiles::Skip,
            divides,
            has_lines,
            has_clip,
            layout,
            crs,
            classes,
            max_edge,
            frame,
            task_memory,
        };
        plan.note(request, verb, &known, journal);
        Ok((plan, known))
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

    /// Returns about how many cells of the frame are drawn: those within the extents of the files,
    /// unless triangles may be anywhere.
    pub(super) fn cells(&self) -> u64 {
        let Some(frame) = &self.frame else { return 0 };
        let all = frame.width as f64 * frame.height as f64;
        if self.max_edge.is_none() || self.has_lines {
            return all as u64;
        }
        let [min, max] = [frame.extent().min, frame.extent().max];
        let side = |file: &PlannedFile, k: usize| {
            (file.max[k].min(max[k]) - file.min[k].max(min[k])).max(0.0)
        };
        let covered: f64 = self
            .files
            .iter()
            .map(|file| side(file, 0) * side(file, 1))
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
        let found = looked_at(file.input, request, &Context::default())?;
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

/// The files of points of a request, by what their headers state.
struct FilesOfPoints {
    /// Those that can be opened.
    points: PointFiles,
    /// Those that cannot, if such files are skipped.
    closed: Vec<Closed>,
    /// The classes that are used.
    classes: Vec<u8>,
    /// Those that have points, in the order of the request.
    files: Vec<PlannedFile>,
    /// Those of which not even the extent is known, by their positions in the request, and why.
    skipped: Vec<(usize, String)>,
}

impl FilesOfPoints {
    fn of(
        request: &TinRequest,
        systems: &SystemOptions,
        options: &TileOptions,
        journal: &Journal,
    ) -> Result<Self> {
        let closed = match options.bad {
            BadFiles::Skip => closed(request, &journal.context)?,
            BadFiles::Refuse => Vec::new(),
        };
        let (numbers, inputs) = opened(request, &closed);
        let points = PointFiles::open(&inputs, request.read, journal)?.with_bad(options.bad);
        let classes = classes_of(&points, request, options, journal)?;
        let mut files = Vec::new();
        for ((number, input), stated) in numbers
            .into_iter()
            .zip(&inputs)
            .zip(points.stated_extents())
        {
            files.extend(planned(number, input, request, stated, &journal.context)?);
        }
        let mut skipped = Vec::new();
        for file in &closed {
            match file.extent() {
                Some(extent) => {
                    files.extend(file.planned(extent, request, systems, &journal.context)?)
                }
                None => skipped.push((file.number, file.why.clone())),
            }
        }
        files.sort_by_key(|file| file.input);
        Ok(FilesOfPoints {
            points,
            closed,
            classes,
            files,
            skipped,
        })
    }
}

/// Returns the classes that are used, and adds a notice if the request leaves that open.
///
/// # Errors
/// If the points would have to be read for that, but only headers may be.
fn classes_of(
    points: &PointFiles,
    request: &TinRequest,
    options: &TileOptions,
    journal: &Journal,
) -> Result<Vec<u8>> {
    let are_open = request.classes == Classes::GroundOrAll;
    if options.look == Look::Headers && are_open && points.have_classes() {
        return Err(
            Error::usage("which classes are used is not known from headers alone").cure(wording![
                "state them, such as ",
                Setting::Class.number("2"),
                " for ground"
            ]),
        );
    }
    let classes = points.used_classes(&request.classes, journal)?;
    if request.classes == Classes::AllButNoise && points.have_classes() {
        journal.add(Notice::NoiseUnused);
    }
    if are_open {
        match classes.len() {
            1 => journal.add(Notice::GroundUsed),
            _ if points.have_classes() => journal.add(Notice::AllClassesUsed),
            // Nobody expects ground in a text.
            _ => {}
        }
    }
    Ok(classes)
}

/// Returns the memory of one task.
fn task_memory(options: &TileOptions) -> u64 {
    options.task_memory.unwrap_or_else(|| {
        let workers = rayon::current_num_threads() as u64;
        options.memory.unwrap_or_else(memory::half_of_free) / workers
    })
}

/// Returns the tiles, of at most so many points each, and true if the files are divided among them
/// first.
fn layout_of(
    files: &[PlannedFile],
    classes: &[u8],
    known: &Known,
    most: u64,
    request: &TinRequest,
    options: &TileOptions,
    context: &Context,
) -> Result<(TileLayout, bool)> {
    if let Division::Grid(counts) = options.division {
        let Bounds { min, max } = extent_of(files);
        let [min, max] = [min, max].map(|[x, y, _]| [x, y]);
        return Ok((TileLayout::grid(min, max, counts), true));
    }
    let spreads: Vec<Spread> = files.iter().map(PlannedFile::spread).collect();
    let are_small = files.iter().all(|file| file.count <= most);
    if let Some(layout) =
        TileLayout::of_boxes(&spreads).filter(|_| are_small && known.lines.is_none())
    {
        return Ok((layout, false));
    }
    let average = most as f64 * AVERAGE;
    let spreads = match options.look {
        Look::Points => sampled::spreads(files, request, classes, average, context)?,
        Look::Headers => spreads,
    };
    Ok((TileLayout::balanced(&spreads, average), true))
}

/// Returns the box around all points and lines, within the bounds of the request if they have an
/// area in common.
fn drawn_extent(points: Bounds, known: &Known, request: &TinRequest) -> Bounds {
    let mut extent = points;
    if let Some(lines) = &known.lines {
        [lines.extent.min, lines.extent.max]
            .into_iter()
            .for_each(|corner| extent.add(corner));
    }
    let within = request
        .bounds
        .map(|bounds| common(&bounds, &extent))
        .filter(|within| !within.is_empty());
    within.unwrap_or(extent)
}

/// Returns the frame of a raster that is drawn tile by tile.
///
/// # Errors
/// If tiles could not agree on its cells, or the frame is refused.
fn frame_of(
    options: &FrameOptions,
    extent: Bounds,
    crs: Option<&Crs>,
    journal: &Journal,
) -> Result<Frame> {
    let frame = frame::over_extent(options, extent, crs, journal)?;
    if options.extent.is_none() && !frame.has_shared_centers() {
        return Err(Error::unsupported(
            "the raster's grid lines are not multiples of the size of its cells",
        )
        .cure(wording![
            "state the extent of the result with ",
            Setting::Extent
        ]));
    }
    Ok(frame)
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
fn extent_of(files: &[PlannedFile]) -> Bounds {
    let mut extent = Bounds::default();
    for Spread { min, max, .. } in files.iter().map(PlannedFile::spread) {
        [min, max]
            .into_iter()
            .for_each(|[x, y]| extent.add([x, y, 0.0]));
    }
    extent
}

/// Returns what two boxes have in common in plan.
fn common(a: &Bounds, b: &Bounds) -> Bounds {
    let (mut min, mut max) = (b.min, b.max);
    for k in 0..2 {
        (min[k], max[k]) = (min[k].max(a.min[k]), max[k].min(a.max[k]));
    }
    Bounds { min, max }
}

/// A file that cannot be opened.
struct Closed {
    /// Its position in the request.
    number: usize,
    why: String,
    /// What its header states, if that can be read.
    stated: Option<PointInfo>,
}

impl Closed {
    /// Returns the coordinate system that its header states, if it does.
    fn stated(&self, request: &TinRequest) -> Option<Stated> {
        let stated = Stated::by_points(request.points[self.number].path(), self.stated.as_ref()?);
        (stated.crs.is_some() || stated.unread.is_some()).then_some(stated)
    }

    /// Returns the number of points and the box around them that its header states, if it states
    /// both.
    fn extent(&self) -> Option<(Option<u64>, Option<Bounds>)> {
        let info = self
            .stated
            .as_ref()
            .filter(|info| info.count.is_some() && info.bounds.is_some())?;
        Some((info.count, info.bounds))
    }

    /// Returns what the plan knows of it; `None` if it has no points.
    fn planned(
        &self,
        extent: (Option<u64>, Option<Bounds>),
        request: &TinRequest,
        systems: &SystemOptions,
        context: &Context,
    ) -> Result<Option<PlannedFile>> {
        let file = planned(
            self.number,
            &request.points[self.number],
            request,
            extent,
            context,
        )?;
        let states_system = self.stated.as_ref().is_some_and(|info| info.crs.is_some());
        let is_of_any_system = !states_system && systems.assign.is_none();
        Ok(file.map(|file| PlannedFile {
            is_of_any_system,
            ..file
        }))
    }
}

/// Returns the files that cannot be opened.
fn closed(request: &TinRequest, context: &Context) -> Result<Vec<Closed>> {
    let mut closed = Vec::new();
    for (number, input) in request.points.iter().enumerate() {
        match looked_at(number, request, context) {
            Ok(_) => {}
            Err(error) if BadFiles::Skip.skips(&error) => {
                require_folder(input.path(), request)?;
                closed.push(Closed {
                    number,
                    why: error.to_string(),
                    stated: open::stated(input.path()),
                });
            }
            Err(error) => return Err(error),
        }
    }
    Ok(closed)
}

/// Returns the other files, and their positions in the request.
fn opened(request: &TinRequest, closed: &[Closed]) -> (Vec<usize>, Vec<Input<MemoryPoints>>) {
    let is_closed = |number: &usize| closed.iter().any(|file| file.number == *number);
    let inputs = request.points.iter().cloned().enumerate();
    inputs.filter(|(number, _)| !is_closed(number)).unzip()
}

/// Returns the files that are read beside the points: layers of lines, a raster to align to.
fn others<'a>(request: &'a TinRequest, verb: &'a dyn Verb) -> impl Iterator<Item = &'a PathBuf> {
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

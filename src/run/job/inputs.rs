//! What a job is planned from: the inputs of a request, by what their headers state.

use std::path::Path;

use super::division::Division;
use super::fullest::fullest;
use super::lines::{self, Known};
use super::plan::{BYTES_A_POINT, OtherFile, Plan, extent_of, others, require_tiled};
use super::planned_file::{KnownFiles, PlannedFile, looked_at, planned, require_folder};
use super::request::options_of;
use super::sampled;
use super::tile_options::{Look, TileOptions};
use crate::crs::Crs;
use crate::data::{Bounds, Frame, PointInfo};
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal};
use crate::run::products::edge_limit::mean_distance;
use crate::run::products::frame::{self, FrameOptions};
use crate::run::products::tin::TinRequest;
use crate::run::request::input::{Input, MemoryPoints};
use crate::run::sources::open;
use crate::run::sources::point_files::{BadFiles, PointFiles};
use crate::run::sources::systems::{self, Stated, SystemOptions, Systems};
use crate::run::sources::transforms::{FileTransform, TargetSystem, Transforms};
use crate::run::verbs::{Keeps, Verb};
use crate::terrain::Canvas;
use crate::terrain::Classes;
use crate::terrain::tiles::{Spread, TileLayout};

/// Tiles with more points than this gain nothing.
const MOST_POINTS: u64 = 1_000_000;

/// Tiles with fewer points than this hand up much of what they have.
const LEAST_POINTS: u64 = 10_000;

/// The share of the most points that a tile has on average: files may be denser in one place.
const AVERAGE: f64 = 0.5;

/// The inputs of a request.
pub(super) struct Inputs<'a> {
    request: &'a TinRequest,
    systems: &'a SystemOptions,
    verb: &'a dyn Verb,
    options: &'a TileOptions,
    /// The files of points that have some.
    pub(super) files: Vec<PlannedFile>,
    /// The other files, as they were before they were read: one that changes meanwhile has another
    /// state than the plan, and so is found out.
    others: Vec<OtherFile>,
    skipped: Vec<(usize, String)>,
    pub(super) classes: Vec<u8>,
    pub(super) crs: Option<Crs>,
    layers_from: Vec<Option<Crs>>,
    pub(super) max_edge: Option<f64>,
    pub(super) known: Known,
    /// The frame over all points and lines, for a raster.
    pub(super) frame: Option<Frame>,
}

/// How a plan divides the plane.
pub(super) struct Tiling {
    pub(super) layout: TileLayout,
    /// For each file of points, the tile that it is; `None` for one that is divided.
    pub(super) tiles: Vec<Option<u32>>,
    /// The frame that is drawn in, and by how many blocks it was enlarged on the left and above.
    pub(super) frame: Option<Frame>,
    pub(super) blocks_before: [u64; 2],
    pub(super) task_memory: u64,
    /// About how many points the fullest tile had when the tiles were chosen.
    pub(super) fullest: u64,
}

impl<'a> Inputs<'a> {
    /// Looks at the inputs: at headers, and at whole files that do not state what has to be known,
    /// unless an earlier plan knows it.
    ///
    /// # Errors
    /// If the request has something that tiles do not have yet, or an input cannot be read; if
    /// no file has a point, or the frame of the raster is refused.
    pub(super) fn read(
        request: &'a TinRequest,
        systems: &'a SystemOptions,
        verb: &'a dyn Verb,
        options: &'a TileOptions,
        known_files: &KnownFiles,
        journal: &Journal,
    ) -> Result<Self> {
        require_tiled(request)?;
        let others = others(request, verb)
            .map(|path| OtherFile::of(path))
            .collect::<Result<_>>()?;
        let opened = Opened::of(request, options, known_files, journal)?;
        let layers = lines::layers_of(request, journal)?;
        let mut stated = opened.stated(request, systems, journal)?;
        let of_points = stated.len();
        stated.extend(layers.stated());
        let Systems { mut from, crs } = systems::reconcile_some(&stated, systems, journal)?;
        let to = TargetSystem {
            crs: crs.as_ref(),
            options: &systems.transform,
        };
        let transforms = Transforms::new(&from, to, journal)?;
        let layers_from = from.split_off(of_points);
        let Found {
            classes,
            files,
            skipped,
        } = opened.looked_at(request, systems, &transforms, known_files, &journal.context)?;
        let extent = extent_of(&files);
        let of_layers = (layers_from.as_slice(), to);
        let known = Known::of_layers(&layers, request, of_layers, &extent, journal)?;
        if files.is_empty() {
            return Err(
                Error::format("no points in the input").cure("pass files that contain points")
            );
        }
        let spacing = mean_distance(files.iter().map(PlannedFile::extent));
        let max_edge = request.max_edge.length(spacing, &Units::of(crs.as_ref()));
        let frame = match verb.keeps() {
            Keeps::Heights(options) | Keeps::Gradients(options) => Some(frame_of(
                options,
                drawn_extent(extent, &known, request),
                crs.as_ref(),
                journal,
            )?),
            Keeps::Contours(_) | Keeps::Triangles => None,
        };
        Ok(Inputs {
            request,
            systems,
            verb,
            options,
            files,
            others,
            skipped,
            classes,
            crs,
            layers_from,
            max_edge,
            known,
            frame,
        })
    }

    /// Chooses tiles.
    ///
    /// # Errors
    /// If files that are sampled cannot be read.
    pub(super) fn tiled(&self, context: &Context) -> Result<Tiling> {
        let task_memory = task_memory(self.options);
        let (layout, are_tiles) = self.layout(most_points(task_memory), context)?;
        // So that it can be enlarged by blocks without one that was drawn in part.
        let side = |cells: usize| cells.next_multiple_of(Canvas::SIDE) as i64;
        let frame = self.frame.map(|frame| {
            let whole = frame.on_its_lines([0, 0], [side(frame.width), side(frame.height)]);
            whole.unwrap_or(frame)
        });
        let tiles: Vec<Option<u32>> = (0..self.files.len() as u32)
            .map(|tile| are_tiles.then_some(tile))
            .collect();
        Ok(Tiling {
            fullest: fullest(&layout, &self.files, &tiles),
            layout,
            tiles,
            frame,
            blocks_before: [0; 2],
            task_memory,
        })
    }

    /// Returns the plan with these tiles, and what was found out on the way.
    pub(super) fn planned(mut self, tiling: Tiling, journal: &Journal) -> (Plan, Known) {
        for (file, tile) in self.files.iter_mut().zip(tiling.tiles) {
            file.tile = tile;
        }
        let plan = Plan {
            request: options_of(self.request, self.systems, self.verb, self.options),
            files: self.files,
            others: self.others,
            skipped: self.skipped,
            skips_bad: self.options.bad == BadFiles::Skip,
            has_lines: self.known.lines.is_some(),
            has_clip: self.known.clip.is_some(),
            layout: tiling.layout,
            crs: self.crs,
            layers_from: self.layers_from,
            transform: self.systems.transform,
            classes: self.classes,
            max_edge: self.max_edge,
            frame: tiling.frame,
            blocks_before: tiling.blocks_before,
            task_memory: tiling.task_memory,
            fullest: tiling.fullest,
        };
        plan.note(self.request, self.verb, &self.known, journal);
        (plan, self.known)
    }

    /// Returns the tiles, of at most so many points each, and true if the files are these tiles; if
    /// not, they are divided among them.
    fn layout(&self, most: u64, context: &Context) -> Result<(TileLayout, bool)> {
        let Inputs {
            request,
            options,
            files,
            classes,
            known,
            ..
        } = self;
        if let Division::Grid(counts) = options.division {
            let Bounds { min, max } = extent_of(files);
            let [min, max] = [min, max].map(|[x, y, _]| [x, y]);
            return Ok((TileLayout::grid(min, max, counts), false));
        }
        let spreads: Vec<Spread> = files.iter().map(PlannedFile::spread).collect();
        let are_small = files.iter().all(|file| file.count <= most);
        if let Some(layout) =
            TileLayout::of_boxes(&spreads).filter(|_| are_small && known.lines.is_none())
        {
            return Ok((layout, true));
        }
        let average = most as f64 * AVERAGE;
        let spreads = match options.look {
            Look::Points => {
                let to = TargetSystem {
                    crs: self.crs.as_ref(),
                    options: &self.systems.transform,
                };
                let used = (classes.as_slice(), to);
                sampled::spreads(files, request, used, average, context)?
            }
            Look::Headers => spreads,
        };
        Ok((TileLayout::balanced(&spreads, average), false))
    }
}

/// Returns the largest number of points that a tile may have, if a task has so much memory.
pub(super) fn most_points(task_memory: u64) -> u64 {
    (task_memory / BYTES_A_POINT).clamp(LEAST_POINTS, MOST_POINTS)
}

/// The files of points of a request, opened.
struct Opened {
    /// Those that can be opened, and their positions in the request.
    points: PointFiles,
    numbers: Vec<usize>,
    /// Those that cannot, if such files are skipped.
    closed: Vec<Closed>,
    /// The classes that are used.
    classes: Vec<u8>,
}

/// The files of points of a request, by what their headers state.
struct Found {
    /// The classes that are used.
    classes: Vec<u8>,
    /// Those that have points, in the order of the request.
    files: Vec<PlannedFile>,
    /// Those of which not even the extent is known, by their positions in the request, and why.
    skipped: Vec<(usize, String)>,
}

impl Opened {
    fn of(
        request: &TinRequest,
        options: &TileOptions,
        known: &KnownFiles,
        journal: &Journal,
    ) -> Result<Self> {
        let closed = match options.bad {
            BadFiles::Skip => closed(request, &journal.context)?,
            BadFiles::Refuse => Vec::new(),
        };
        let (numbers, inputs) = opened(request, &closed);
        let points = PointFiles::open(&inputs, request.read, journal)?.with_bad(options.bad);
        let classes = classes_of(&points, request, options, known, journal)?;
        Ok(Opened {
            points,
            numbers,
            closed,
            classes,
        })
    }

    /// Returns the coordinate systems that the files state, as far as they matter: of those that
    /// can be opened, then of the others.
    fn stated(
        &self,
        request: &TinRequest,
        systems: &SystemOptions,
        journal: &Journal,
    ) -> Result<Vec<Option<Stated>>> {
        let mut stated = self.points.stated(&request.classes, journal)?;
        let closed = self.closed.iter();
        stated.extend(closed.map(|file| file.stated(request, systems)));
        Ok(stated)
    }

    /// Returns what the plan knows of the files, each of which has its transform, in the order of
    /// [`stated`](Self::stated).
    fn looked_at(
        self,
        request: &TinRequest,
        systems: &SystemOptions,
        transforms: &Transforms,
        known: &KnownFiles,
        context: &Context,
    ) -> Result<Found> {
        let mut of_files = transforms.by_file.iter();
        let mut transform = || transforms.numbered(of_files.next().copied().flatten());
        let (mut files, mut skipped) = (Vec::new(), Vec::new());
        for (number, stated) in self.numbers.iter().zip(self.points.stated_extents()) {
            files.extend(planned(
                *number,
                request,
                stated,
                transform(),
                known,
                context,
            )?);
        }
        for file in &self.closed {
            let transform = transform();
            match file.extent(systems, transform) {
                Some(extent) => {
                    files.extend(file.planned(extent, request, systems, transform, context)?);
                }
                None => skipped.push((file.number, file.why.clone())),
            }
        }
        files.sort_by_key(|file| file.input);
        Ok(Found {
            classes: self.classes,
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
    known: &KnownFiles,
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
    let may_have_ground = |path: &Path| known.may_have_ground(path);
    let classes = points.used_classes(&request.classes, may_have_ground, journal)?;
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
    /// Returns the coordinate system that its header states, if it does, or if one is assigned.
    fn stated(&self, request: &TinRequest, systems: &SystemOptions) -> Option<Stated> {
        let stated = Stated::by_points(request.points[self.number].path(), self.stated.as_ref()?);
        let has_system = stated.crs.is_some() || stated.unread.is_some();
        (has_system || systems.assign.is_some()).then_some(stated)
    }

    /// Returns the number of points and the box around them that its header states, if it states
    /// both, and if the box has a position in the system of the result.
    fn extent(
        &self,
        systems: &SystemOptions,
        transform: FileTransform,
    ) -> Option<(Option<u64>, Option<Bounds>)> {
        let info = self.stated.as_ref()?;
        let (count, bounds) = (info.count?, info.bounds?);
        let has_system = info.crs.is_some() || systems.assign.is_some();
        let is_known = systems.target.is_none() || has_system;
        (is_known && transform.around(bounds).is_some()).then_some((Some(count), Some(bounds)))
    }

    /// Returns what the plan knows of it; `None` if it has no points.
    fn planned(
        &self,
        extent: (Option<u64>, Option<Bounds>),
        request: &TinRequest,
        systems: &SystemOptions,
        transform: FileTransform,
        context: &Context,
    ) -> Result<Option<PlannedFile>> {
        let known = KnownFiles::default();
        let file = planned(self.number, request, extent, transform, &known, context)?;
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
        match looked_at(number, request, FileTransform::default(), context) {
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

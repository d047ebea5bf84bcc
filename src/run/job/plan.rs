//! The plan of a job: which tiles there are, and what all tasks must agree on.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde_json::{Value, json};

use super::lines::{self, JobLines};
use super::{BadFiles, Division, TileOptions, TiledProduct};
use crate::crs::Crs;
use crate::data::{Bounds, Frame, PointBatch};
use crate::error::{Error, Kind, Result};
use crate::io::layer;
use crate::run::checksum::checksum;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::frame::{self, FrameOptions};
use crate::run::input::{Input, MemoryPoints};
use crate::run::line_inputs::LineLayers;
use crate::run::memory;
use crate::run::notice::Notice;
use crate::run::open;
use crate::run::point_files::PointFiles;
use crate::run::systems::{self, SystemOptions, Systems};
use crate::run::tin::{EdgeLimit, TinRequest};
use crate::run::units::Units;
use crate::terrain::Classes;
use crate::terrain::tiles::{Layout, Node, Spread, TileClip, Work};

/// Bytes per point of a tile while it is triangulated and drawn; measured.
pub(super) const BYTES_A_POINT: u64 = 220;

/// Tiles with more points than this gain nothing.
const MOST_POINTS: u64 = 1_000_000;

/// Tiles with fewer points than this hand up much of what they have.
const LEAST_POINTS: u64 = 10_000;

/// The share of the most points that a tile has on average: files may be denser in one place.
const AVERAGE: f64 = 0.5;

/// The rounding of the coordinates that headers state, in units of the last place.
const HEADER_ROUNDING: f64 = 8.0;

/// A file of points as the plan knows it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlannedFile {
    /// The position of the file in the request.
    pub(super) input: usize,
    pub(super) path: PathBuf,
    /// Length in bytes and time of the last change in nanoseconds: a file that changes later is
    /// refused.
    pub(super) size: u64,
    pub(super) modified: u64,
    /// The number of its points.
    pub(super) count: u64,
    /// The box around its points in plan, as its header states it.
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
}

/// The path of a file, its length in bytes, and the time of its last change in nanoseconds.
type OtherFile = (PathBuf, u64, u64);

/// What all tasks of a job must agree on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plan {
    /// A description of the request, so that another one does not go on with this job.
    pub(super) request: String,
    /// The files that have points.
    pub(super) files: Vec<PlannedFile>,
    /// The other files that are read: layers of lines, a raster to align to.
    pub(super) others: Vec<OtherFile>,
    /// The files that are skipped because they cannot be opened: their positions in the request,
    /// and why.
    pub(super) skipped: Vec<(usize, String)>,
    /// True if the files are divided among tiles first: they are not tiles themselves, or there are
    /// lines.
    pub(super) divides: bool,
    /// True if there are lines, which one task arranges.
    pub(super) has_lines: bool,
    /// True if the surface is cut along lines, which one task does.
    pub(super) has_clip: bool,
    pub(super) layout: Layout,
    /// The classes that are used.
    pub(super) classes: Vec<u8>,
    /// The longest edge at the rim.
    pub(super) max_edge: Option<f64>,
    /// The frame that triangles are drawn in, for a raster: it covers all points, or is that of the
    /// result.
    pub(super) frame: Option<Frame>,
    /// The memory of one task.
    pub(super) task_memory: u64,
}

/// Returns the length of a file in bytes; 0 if it cannot be asked for.
pub(super) fn length_of(path: &Path) -> u64 {
    state_of(path).map_or(0, |(size, _)| size)
}

/// The bytes of a point in a text, at least.
const BYTES_A_POINT_OF_TEXT: u64 = 24;

/// Returns about how many points a file has that does not state it.
pub(super) fn points_of_text(path: &Path) -> u64 {
    length_of(path) / BYTES_A_POINT_OF_TEXT
}

/// Returns the error for an option that tiles do not have yet.
#[cold]
pub(crate) fn not_in_tiles(option: &str) -> Error {
    Error::unsupported(format!("{option} does not work with tiles yet"))
        .cure("leave one of them out: without --tiles the whole surface is built in memory")
}

/// Returns an error if the request has something that tiles do not have yet.
pub(super) fn require_tiled(request: &TinRequest, systems: &SystemOptions) -> Result<()> {
    let refused = [
        (request.max_edge == EdgeLimit::Auto, "--max-edge auto"),
        (systems.target.is_some(), "--t-srs"),
        (
            request.max_edge_inside.is_some() && !(request.lines.flats.is_empty() && request.lines.rivers.is_empty()),
            "--max-edge-inside together with --flat or --rivers",
        ),
    ];
    if let Some((_, option)) = refused.iter().find(|(is_given, _)| *is_given) {
        return Err(not_in_tiles(option));
    }
    request.check_bounds()?;
    request.check_layers()?;
    if let Some(input) = request.points.iter().find(|input| !matches!(input, Input::File(_)) || input.is_read_once()) {
        return Err(Error::usage("tiles are made of files, which can be read again after an interruption")
            .in_file(input.path())
            .cure("write the points to a file first"));
    }
    Ok(())
}

/// What the tasks get from the headers of all files and from the layers of lines.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) crs: Option<Crs>,
    pub(super) lines: Option<JobLines>,
    pub(super) clip: Option<TileClip>,
}

impl Known {
    /// Opens all files but those that the plan skips. `extent` is that of their points.
    pub(super) fn read(
        request: &TinRequest,
        systems: &SystemOptions,
        skipped: &[(usize, String)],
        extent: &Bounds,
        journal: &Journal,
    ) -> Result<Self> {
        let (_, inputs) = opened(request, skipped);
        Self::of(&PointFiles::open(&inputs, request.read, journal)?, request, systems, extent, journal)
    }

    fn of(
        points: &PointFiles,
        request: &TinRequest,
        systems: &SystemOptions,
        extent: &Bounds,
        journal: &Journal,
    ) -> Result<Self> {
        let layers = LineLayers::read(&request.lines, &request.breaklines, &request.boundary, journal)?;
        let mut stated = points.stated(&request.classes, journal)?;
        stated.extend(layers.stated());
        let Systems { crs, .. } = systems::reconcile_some(&stated, systems, journal)?;
        let (lines, clip) = lines::of_layers(&layers, request, crs.as_ref(), extent, journal)?;
        Ok(Known { crs, lines, clip })
    }
}

impl Plan {
    /// Chooses the tiles for the files of a request, by what their headers state; files that do not
    /// state it are read once. Also returns what was found out on the way.
    pub(super) fn new(
        request: &TinRequest,
        systems: &SystemOptions,
        product: &TiledProduct,
        options: &TileOptions,
        journal: &Journal,
    ) -> Result<(Self, Known)> {
        require_tiled(request, systems)?;
        let skipped = match options.bad {
            BadFiles::Skip => closed(request, &journal.context)?,
            BadFiles::Refuse => Vec::new(),
        };
        let (numbers, inputs) = opened(request, &skipped);
        let points = PointFiles::open(&inputs, request.read, journal)?;
        let classes = points.used_classes(&request.classes, journal)?;
        if request.classes == Classes::GroundOrAll {
            journal.add(if classes.len() == 1 { Notice::GroundUsed } else { Notice::AllClassesUsed });
        }
        let mut files = Vec::new();
        for ((number, input), stated) in numbers.into_iter().zip(&inputs).zip(points.stated_extents()) {
            files.extend(planned(number, input, request, stated, &journal.context)?);
        }
        let extent = extent_of(&files);
        let known = Known::of(&points, request, systems, &extent, journal)?;
        let Known { crs, lines, clip } = &known;
        drop(points);

        let spreads: Vec<Spread> = files.iter().map(PlannedFile::spread).collect();
        if spreads.is_empty() {
            return Err(Error::format("no points in the input").cure("pass files that contain points"));
        }
        let mut drawn_extent = extent;
        if let Some(lines) = lines {
            [lines.extent.min, lines.extent.max].into_iter().for_each(|corner| drawn_extent.add(corner));
        }
        if let Some(bounds) = request.bounds.map(|bounds| common(&bounds, &drawn_extent)).filter(|b| !b.is_empty()) {
            drawn_extent = bounds;
        }
        let workers = rayon::current_num_threads() as u64;
        let task_memory = options.memory.unwrap_or_else(memory::half_of_free) / workers;
        let most = (task_memory / BYTES_A_POINT).clamp(LEAST_POINTS, MOST_POINTS);
        let are_small = files.iter().all(|file| file.count <= most);
        let (layout, divides) = match options.division {
            Division::Grid(counts) => {
                let [min, max] = [extent.min, extent.max].map(|[x, y, _]| [x, y]);
                (Layout::grid(min, max, counts), true)
            }
            Division::Auto => match Layout::of_boxes(&spreads).filter(|_| are_small && lines.is_none()) {
                Some(layout) => (layout, false),
                None => (Layout::balanced(&spreads, most as f64 * AVERAGE), true),
            },
        };
        let placed = |options: &FrameOptions| {
            let frame = frame::placed(options, drawn_extent, crs.as_ref(), journal)?;
            if options.extent.is_none() && !frame.has_shared_centers() {
                return Err(Error::unsupported("the raster's grid lines are not multiples of the size of its cells")
                    .cure("state the extent of the result with --te"));
            }
            Ok(frame)
        };
        let frame = product.frame().map(placed).transpose()?;
        let units = Units::of(crs.as_ref());
        let max_edge = request.max_edge.length(&units);
        journal.add(request.max_edge.notice(&units));
        let (has_lines, has_clip) = (lines.is_some(), clip.is_some());
        let others = others(request, product)?;
        if let Some(path) = files.iter().map(|file| &file.path).find(|path| path.to_str().is_none()) {
            return Err(Error::unsupported("the name is not valid Unicode, which a plan needs").in_file(path));
        }
        let request = fingerprint(request, systems, product, options);
        let plan = Plan {
            request,
            files,
            others,
            skipped,
            divides,
            has_lines,
            has_clip,
            layout,
            classes,
            max_edge,
            frame,
            task_memory,
        };
        Ok((plan, known))
    }

    /// Returns the box in plan around all points, as the files state it.
    pub(super) fn extent(&self) -> Bounds {
        extent_of(&self.files)
    }

    /// Returns the number of points that the files state.
    pub(super) fn point_count(&self) -> u64 {
        self.files.iter().map(|file| file.count).sum()
    }

    /// Returns the number of merges.
    pub(super) fn merge_count(&self) -> usize {
        self.layout.steps().iter().filter(|step| matches!(step.work, Work::Merge(_))).count()
    }

    /// Returns an error if any file has changed since the plan was made.
    pub(super) fn require_all_unchanged(&self) -> Result<()> {
        (0..self.files.len()).try_for_each(|number| self.require_unchanged(number))?;
        self.others.iter().try_for_each(|(path, size, modified)| require_state(path, (*size, *modified)))
    }

    /// Returns an error if a file of points has changed since the plan was made.
    pub(super) fn require_unchanged(&self, number: usize) -> Result<()> {
        let file = &self.files[number];
        require_state(&file.path, (file.size, file.modified))
    }

    /// Takes a file as it is now.
    ///
    /// # Errors
    /// If it does not have the points that the plan expects, by their number and extent.
    pub(super) fn replace_file(&mut self, number: usize, request: &TinRequest) -> Result<()> {
        let file = &self.files[number];
        let (input, context) = (&request.points[file.input], Context::default());
        let source = open::points(input, request.read, &context)?;
        let info = source.info();
        let found = planned(file.input, input, request, (info.count, info.bounds), &context)?;
        match found {
            Some(found) if (found.count, found.min, found.max) == (file.count, file.min, file.max) => {
                self.files[number] = found;
                Ok(())
            }
            _ => Err(Error::usage("the file was replaced by one of another extent or number of points")
                .in_file(&file.path)
                .cure("plan the job again: `breakline job clean` removes this one")),
        }
    }

    pub(super) fn to_json(&self) -> Value {
        let file = |file: &PlannedFile| {
            json!({
                "path": file.path, "input": file.input, "size": file.size, "modified": file.modified,
                "count": file.count, "min": file.min, "max": file.max,
            })
        };
        let node = |node: &Node| match node {
            Node::Tile(number) => json!(number),
            Node::Cut { axis, at, parts } => json!([axis, at, parts[0], parts[1]]),
        };
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "request": self.request,
            "files": self.files.iter().map(file).collect::<Vec<_>>(),
            "others": self.others,
            "skipped": self.skipped,
            "divides": self.divides,
            "has_lines": self.has_lines,
            "has_clip": self.has_clip,
            "layout": self.layout.nodes().iter().map(node).collect::<Vec<_>>(),
            "classes": self.classes,
            "max_edge": self.max_edge,
            "frame": self.frame.map(|frame| json!([frame.width, frame.height, frame.transform])),
            "task_memory": self.task_memory,
        })
    }

    /// Returns the plan that a value states; `None` if it does not, or is that of another version.
    pub(super) fn from_json(value: &Value) -> Option<Self> {
        if value["version"] != env!("CARGO_PKG_VERSION") {
            return None;
        }
        let whole = |value: &Value| usize::try_from(value.as_u64()?).ok();
        let number = |value: &Value| u32::try_from(value.as_u64()?).ok();
        let file = |value: &Value| {
            Some(PlannedFile {
                path: serde_json::from_value(value["path"].clone()).ok()?,
                input: whole(&value["input"])?,
                size: value["size"].as_u64()?,
                modified: value["modified"].as_u64()?,
                count: value["count"].as_u64()?,
                min: serde_json::from_value(value["min"].clone()).ok()?,
                max: serde_json::from_value(value["max"].clone()).ok()?,
            })
        };
        let node = |value: &Value| match value {
            Value::Array(parts) if parts.len() == 4 => Some(Node::Cut {
                axis: whole(&parts[0])?,
                at: parts[1].as_f64()?,
                parts: [number(&parts[2])?, number(&parts[3])?],
            }),
            value => number(value).map(Node::Tile),
        };
        let nodes = value["layout"].as_array()?.iter().map(node).collect::<Option<_>>()?;
        let class = |value: &Value| u8::try_from(value.as_u64()?).ok();
        let frame = |value: &Value| {
            let transform = serde_json::from_value(value[2].clone()).ok()?;
            Frame { width: whole(&value[0])?, height: whole(&value[1])?, transform }.checked().ok()
        };
        Some(Plan {
            request: value["request"].as_str()?.to_owned(),
            files: value["files"].as_array()?.iter().map(file).collect::<Option<_>>()?,
            others: serde_json::from_value(value["others"].clone()).ok()?,
            skipped: serde_json::from_value(value["skipped"].clone()).ok()?,
            divides: value["divides"].as_bool()?,
            has_lines: value["has_lines"].as_bool()?,
            has_clip: value["has_clip"].as_bool()?,
            layout: Layout::from_nodes(nodes)?,
            classes: value["classes"].as_array()?.iter().map(class).collect::<Option<_>>()?,
            max_edge: value["max_edge"].as_f64(),
            frame: match &value["frame"] {
                Value::Null => None,
                value => Some(frame(value)?),
            },
            task_memory: value["task_memory"].as_u64()?,
        })
        .filter(|plan| plan.divides || plan.files.len() == plan.layout.tile_count())
    }
}

impl PlannedFile {
    /// Returns the box around its points, with what rounding may add to a header.
    pub(super) fn spread(&self) -> Spread {
        let PlannedFile { min, max, .. } = *self;
        let rounding = [0, 1].map(|k: usize| HEADER_ROUNDING * f64::EPSILON * min[k].abs().max(max[k].abs()));
        let (low, high) = ([0, 1].map(|k| min[k] - rounding[k]), [0, 1].map(|k| max[k] + rounding[k]));
        Spread { min: low, max: high, count: self.count as f64 }
    }
}

/// Returns the box in plan around the points of files.
fn extent_of(files: &[PlannedFile]) -> Bounds {
    let mut extent = Bounds::default();
    for Spread { min, max, .. } in files.iter().map(PlannedFile::spread) {
        [min, max].into_iter().for_each(|[x, y]| extent.add([x, y, 0.0]));
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

/// Returns a description of everything that the files of the tasks depend on.
pub(super) fn fingerprint(
    request: &TinRequest,
    systems: &SystemOptions,
    product: &TiledProduct,
    options: &TileOptions,
) -> String {
    let all = format!("{request:?} {systems:?} {product:?} {:?} {:?}", options.division, options.memory);
    format!("{} {:08x}", product.name(), checksum(all.as_bytes()))
}

/// Returns the files that cannot be planned with, and why.
fn closed(request: &TinRequest, context: &Context) -> Result<Vec<(usize, String)>> {
    let mut closed = Vec::new();
    for (number, input) in request.points.iter().enumerate() {
        let opened = open::points(input, request.read, context).and_then(|source| {
            let info = source.info();
            planned(number, input, request, (info.count, info.bounds), context)
        });
        match opened {
            Ok(_) => {}
            Err(error) if error.kind() == Kind::Canceled => return Err(error),
            Err(error) => {
                let error = error.in_file(input.path());
                closed.push((number, format!("{error} (its extent is not known: triangles may span it)")));
            }
        }
    }
    Ok(closed)
}

/// Returns the files that are not skipped, and their positions in the request.
fn opened(request: &TinRequest, skipped: &[(usize, String)]) -> (Vec<usize>, Vec<Input<MemoryPoints>>) {
    let is_skipped = |number: &usize| skipped.iter().any(|(skipped, _)| skipped == number);
    let inputs = request.points.iter().cloned().enumerate();
    inputs.filter(|(number, _)| !is_skipped(number)).unzip()
}

/// Returns what the plan has to know of a file; `None` if it has no points.
fn planned(
    number: usize,
    input: &Input<MemoryPoints>,
    request: &TinRequest,
    stated: (Option<u64>, Option<Bounds>),
    context: &Context,
) -> Result<Option<PlannedFile>> {
    let path = input.path();
    let (size, modified) = state_of(path)?;
    let (count, bounds) = match stated {
        (Some(count), Some(bounds)) => (count, bounds),
        (Some(0), None) => (0, Bounds::default()),
        _ => measured(input, request, context).map_err(|e| e.in_file(path))?,
    };
    if count == 0 {
        return Ok(None);
    }
    let is_finite = (0..2).all(|k| bounds.min[k].is_finite() && bounds.max[k].is_finite());
    if !is_finite {
        return Err(Error::format("the header states an extent that is not finite")
            .in_file(path)
            .cure("`breakline points` writes a file with a true header"));
    }
    let [min, max] = [bounds.min, bounds.max].map(|[x, y, _]| [x, y]);
    Ok(Some(PlannedFile { input: number, path: path.to_path_buf(), size, modified, count, min, max }))
}

/// Counts the points of a file that does not state their number or extent.
fn measured(input: &Input<MemoryPoints>, request: &TinRequest, context: &Context) -> Result<(u64, Bounds)> {
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
        (0..batch.len()).for_each(|i| bounds.add([batch.x[i], batch.y[i], batch.z[i]]));
        work.add(batch.len() as u64)?;
    }
}

/// Returns an error unless a file has this length and this time of its last change.
fn require_state(path: &Path, planned: (u64, u64)) -> Result<()> {
    if state_of(path)? == planned {
        return Ok(());
    }
    Err(Error::usage("the file has changed since the job was planned")
        .in_file(path)
        .cure("plan the job again: `breakline job clean` removes this one"))
}

/// Returns the states of the files that are read beside the points.
fn others(request: &TinRequest, product: &TiledProduct) -> Result<Vec<OtherFile>> {
    let layers = request.lines.inputs().into_iter().flat_map(|(_, inputs)| inputs);
    let layers = layers.chain(&request.breaklines).chain(&request.boundary);
    let layers = layers.filter_map(|input| match input {
        Input::File(path) => Some(path),
        Input::Memory(_) => None,
    });
    let raster = product.frame().and_then(|frame| frame.align_to.as_ref());
    let state = |path: &PathBuf| {
        let (size, modified) = state_of(path)?;
        Ok((path.clone(), size, modified))
    };
    layers.chain(raster).map(state).collect()
}

/// Returns the length of a file, which may be named together with a layer, and the time of its last
/// change.
fn state_of(path: &Path) -> Result<(u64, u64)> {
    let about = match std::fs::metadata(path) {
        Ok(about) => about,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let spec = path.to_str().and_then(|text| layer::Spec::parse(text).ok());
            match spec.map(|spec| std::fs::metadata(spec.path)) {
                Some(Ok(about)) => about,
                _ => return Err(Error::from(error).in_file(path)),
            }
        }
        Err(error) => return Err(Error::from(error).in_file(path)),
    };
    let modified = about.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    Ok((about.len(), modified.map_or(0, |time| time.as_nanos() as u64)))
}

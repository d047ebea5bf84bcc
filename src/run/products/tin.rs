//! From the points and lines of a request to a TIN: what is read, in which coordinate system, with
//! which defaults.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::edge_limit::{EdgeLimit, mean_distance};
use super::ground::keep_ground;
use super::reach::{Reach, grown};
use crate::crs::Crs;
use crate::data::{Bounds, Columns, Layer, Return};
use crate::error::{Command, Error, Result, Setting, Wording, wording};
use crate::io::points;
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Journal, Size, Stage};
use crate::run::lines::crossings::{self, LineNames};
use crate::run::lines::inputs::{Added, LineLayers, WALL_WIDTH_METRES};
use crate::run::lines::notes::{self, LevelRing, LevelRings, LineInput};
use crate::run::request::input::{Input, MemoryPoints, named};
use crate::run::request::lines::{LineRequest, LineRole};
use crate::run::request::serialized;
use crate::run::sources::extents::{self, LineExtents};
use crate::run::sources::file_extent::FileExtent;
use crate::run::sources::open::{self, Content, content};
use crate::run::sources::point_files::{FilesRead, LeftOutFiles, PointFiles};
use crate::run::sources::systems::{self, SystemOptions, Systems};
use crate::run::sources::transforms::{TargetSystem, Transforms};
use crate::terrain::ground::GroundOptions;
use crate::terrain::{
    Classes, CrossingRule, DuplicateRule, Method, ReadWindow, Selection, SelectionReport, Tin,
    TinBuilder, TinReport,
};
use crate::triangulation::OnCrossing;

/// The default tolerance of heights where breaklines meet: the accuracy of a survey of edges.
const DEFAULT_CROSSING_TOLERANCE_METRES: f64 = 0.01;

/// The points and lines that a TIN is built from, and the options of building it. Lengths are in
/// the units of the coordinate system of the result, heights in its units of heights.
///
/// The default has no input, and these options: ground points are used (class 2; all points if no
/// point has it), caps and triangles with edges over 100 metres are left out at the rim
/// ([`EdgeLimit::Standard`]), the lowest of several heights is used, and breaklines are split where
/// they cross.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct TinRequest {
    /// The points. Their order makes no difference, except for [`DuplicateRule::First`] and `Last`.
    pub points: Vec<Input<MemoryPoints>>,
    /// Options of reading files of points.
    pub read: points::Options,
    /// The classes to use; with [`ground`](Self::ground), the default is all but noise. Points that
    /// are flagged as withheld are never used.
    pub classes: Classes,
    /// The returns to use; all if empty.
    #[serde(default)]
    pub returns: Vec<Return>,
    /// Uses only those of these points that a filter finds to be ground; all if `None`. It sees all
    /// of them, also with bounds. Tiles have no filter.
    #[serde(default)]
    pub ground: Option<GroundOptions>,
    /// Lines with heights that the surface must follow; of polygons, the rings are used. At the
    /// vertices of a breakline its heights are used, not those of points.
    pub breaklines: Vec<Input<Layer>>,
    /// Polygons that the finished surface is cut to; what is inside any of them is kept. The lines
    /// of a layer count as one polygon if they close to rings.
    pub boundary: Vec<Input<Layer>>,
    /// Lines and areas of other kinds.
    pub lines: LineRequest,
    /// A box that the finished surface is cut to; its heights are ignored. Points around it are
    /// used, too, so far out that the surface inside is the same as with all points.
    #[serde(with = "serialized::in_plan")]
    pub bounds: Option<Bounds>,
    /// Triangles at the rim with longer edges are left out.
    pub max_edge: EdgeLimit,
    /// Triangles with an unconstrained edge longer than this are left out wherever they are, except
    /// in water.
    pub max_edge_inside: Option<f64>,
    /// What becomes of the points that water and walls replace.
    pub replaced: ReplacedPoints,
    /// Which height is used where points have the same position.
    pub duplicates: DuplicateRule,
    /// What to do where breaklines cross between their vertices.
    #[serde(with = "serialized::Crossing")]
    pub on_crossing: OnCrossing,
    /// Which height is used where breaklines cross between their vertices.
    pub crossing_heights: CrossingRule,
    /// The largest difference of heights at which no notice is given where breaklines meet. `None`
    /// is 0.01 metres, or 0.01 units if the unit is not known.
    pub crossing_tolerance: Option<f64>,
}

/// What becomes of the points that water and walls replace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum ReplacedPoints {
    /// They are only counted.
    #[default]
    Drop,
    /// They are part of the report.
    Keep,
}

impl TinRequest {
    /// Calls a function with the name of each file of points, lines and areas.
    pub(crate) fn each_file(&mut self, visit: &mut dyn FnMut(&mut PathBuf)) {
        Input::each_file(&mut self.points, visit);
        Input::each_file(&mut self.breaklines, visit);
        self.lines.each_file(visit);
        Input::each_file(&mut self.boundary, visit);
    }

    /// Returns the classes to use: the ground is searched among points of all classes but noise, if
    /// none are chosen.
    fn used_classes(&self) -> Classes {
        match (&self.ground, &self.classes) {
            (Some(_), Classes::GroundOrAll) => Classes::AllButNoise,
            (_, classes) => classes.clone(),
        }
    }

    /// Returns an error unless the bounds contain an area.
    ///
    /// # Errors
    /// Names the bounds.
    pub(crate) fn check_bounds(&self) -> Result<()> {
        match self.bounds {
            Some(Bounds { min, max })
                if !(0..2).all(|i| min[i] < max[i] && min[i].is_finite() && max[i].is_finite()) =>
            {
                Err(Error::usage(format!(
                    "the bounds go from {} {} to {} {}",
                    min[0], min[1], max[0], max[1]
                )))
            }
            _ => Ok(()),
        }
    }

    /// Returns where triangles are that clipping leaves out, for a sentence.
    pub(crate) fn what_is_clipped(&self) -> String {
        let of_files = |what, layers: &[Input<Layer>]| named(what, layers.iter().map(Input::path));
        let parts = [
            of_files("outside of the boundary", &self.boundary),
            self.bounds.map(|_| "outside of the bounds".to_owned()),
            of_files("in the holes of", &self.lines.holes),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        parts.join(" or ")
    }

    /// Returns those of the replaced points that the report has.
    fn replaced_to_report(&self, replaced: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
        match self.replaced {
            ReplacedPoints::Keep => {
                let is_within = |p: &[f64; 3]| {
                    self.bounds
                        .as_ref()
                        .is_none_or(|bounds| bounds.holds(p[0], p[1]))
                };
                replaced.into_iter().filter(is_within).collect()
            }
            ReplacedPoints::Drop => Vec::new(),
        }
    }

    /// Returns an error if a file that is given as a layer is known to be of a kind without lines
    /// or polygons, such as a raster.
    ///
    /// # Errors
    /// Names the file and its kind.
    pub fn check_layers(&self) -> Result<()> {
        let takes = |role: LineRole, what: &str| wording![role.setting(), format!(" takes {what}")];
        refuse_other_kinds(
            takes(LineRole::Breaklines, "lines or polygons"),
            &self.breaklines,
        )?;
        for (role, inputs) in self.lines.inputs() {
            let what = if role == LineRole::Holes {
                "polygons or closed lines"
            } else {
                "lines or polygons"
            };
            refuse_other_kinds(takes(role, what), inputs)?;
        }
        refuse_other_kinds(
            takes(LineRole::Boundary, "polygons or closed lines"),
            &self.boundary,
        )
    }
}

fn refuse_other_kinds(wanted: Wording, layers: &[Input<Layer>]) -> Result<()> {
    for layer in layers {
        let Input::File(path) = layer else { continue };
        let what = match content(path) {
            Content::Raster => "a raster",
            Content::Mesh => "a mesh",
            Content::Picture => "a picture",
            Content::Plane => "a file of Triangle's",
            Content::Points if open::is_lidar(path) => "lidar points",
            Content::Points | Content::Layer => continue,
        };
        return Err(Error::usage(wording![wanted, format!(", this is {what}")]).in_file(path));
    }
    Ok(())
}

/// The report of a TIN that was built: its input and what was done with it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BuildReport {
    /// The number of sources of points.
    pub sources: usize,
    /// How many points were used, and why others were not.
    pub points: SelectionReport,
    /// The columns used of text files, each with the number of files.
    pub columns: Vec<(Columns, u64)>,
    /// The inputs of lines and areas, with what became of them.
    pub lines: Vec<LineInput>,
    /// The points that water and walls replaced, if they were to be kept.
    pub replaced: Vec<[f64; 3]>,
    /// Counts of the TIN and of what was left out of it.
    pub tin: TinReport,
    /// The rule for points with the same position.
    pub duplicates: DuplicateRule,
    /// Names of the breaklines, by their positions in [`TinReport::crossing_heights`].
    pub line_names: LineNames,
    /// True if points far outside of the bounds are not used: linear heights do not depend on them.
    pub is_part: bool,
}

impl BuildReport {
    /// Writes a comma separated table of the points that water and walls replaced. Numbers are
    /// written such that reading them gives the same doubles.
    ///
    /// # Errors
    /// If `out` cannot be written to.
    pub fn write_replaced(&self, out: &mut impl Write) -> std::io::Result<()> {
        writeln!(out, "x,y,z")?;
        self.replaced
            .iter()
            .try_for_each(|[x, y, z]| writeln!(out, "{x},{y},{z}"))
    }
}

/// Reads the points and lines of a request and builds the TIN, for heights by a method.
pub(crate) fn build(
    request: &TinRequest,
    options: &SystemOptions,
    method: Method,
    journal: &Journal,
) -> Result<(Tin, BuildReport)> {
    request.check_bounds()?;
    request.check_layers()?;
    let mut files = PointFiles::open(&request.points, request.read, journal)?;
    let layers = LineLayers::read(
        &request.lines,
        &request.breaklines,
        &request.boundary,
        request.read.cut,
        journal,
    )?;

    let mut stated = files.stated(&request.used_classes(), journal)?;
    stated.extend(layers.stated());
    let Systems { from, crs } = systems::reconcile_some(&stated, options, journal)?;
    let to = TargetSystem {
        crs: crs.as_ref(),
        options: &options.transform,
    };
    let transforms = Transforms::new(&from, to, journal)?;
    let (of_points, of_layers) = transforms.by_file.split_at(files.len());

    let units = Units::of(crs.as_ref());
    let mut builder = builder_of(request, &units, crs);
    let mut rim = Rim::new(request, &units, journal);

    // Lines first: they are few, and their errors are known before the points are read.
    let Added {
        names,
        mut inputs,
        extents: line_extents,
        level_rings,
        uneven_shores,
        uneven,
        lowered,
        overlaps,
    } = layers.add_to(&mut builder, of_layers, &transforms, &units)?;
    notes::note_uneven_shores(&uneven_shores, &units, journal);
    notes::note_uneven(&uneven, &units, journal);
    notes::note_lowered(lowered, journal);
    notes::note_overlaps(&overlaps, journal);
    builder.mark_overlaps();

    let building = Building {
        request,
        layers: &layers,
        builder,
        names: &names,
        line_extents,
        transforms: &transforms,
        by_file: of_points,
        units: &units,
        journal,
        paths: request.points.iter().map(Input::path).collect(),
    };
    let buffer = first_buffer(request, method, &units);
    let mut reach = Reach::new(request.bounds, buffer, &files.extents(of_points));
    let Built {
        tin,
        points,
        left_out,
        replaced,
    } = building.surface(&mut files, level_rings, &mut rim, &mut reach)?;
    notes::count_edges(&mut inputs, &tin);
    building.note_lines(&inputs, tin.report());
    rim.note(tin.report(), &units, journal);
    reach.note(&points, left_out, files.len(), &units, journal);
    crossings::note(tin.report(), &names, &units, journal);
    if tin.report().triangles == 0 {
        return Err(no_triangle(tin.report(), request, &rim, &units));
    }
    let report = BuildReport {
        sources: request.points.len(),
        is_part: reach.leaves_out(&points, left_out),
        points,
        columns: files.columns(),
        lines: inputs,
        replaced: request.replaced_to_report(replaced),
        tin: tin.report().clone(),
        duplicates: request.duplicates,
        line_names: names,
    };
    Ok((tin, report))
}

/// Returns true if the surface depends on points that no triangle shows: where waters end, how high
/// ridges are, which points are ground, and what a method makes of the vertices.
fn reaches_far(request: &TinRequest, method: Method) -> bool {
    request.lines.has_water()
        || request.lines.add_ridges
        || request.ground.is_some()
        || method != Method::Linear
}

/// Returns how far outside of bounds points are used at first.
fn first_buffer(request: &TinRequest, method: Method, units: &Units) -> f64 {
    let is_read_once = request.points.iter().any(Input::is_read_once);
    if is_read_once || reaches_far(request, method) {
        f64::INFINITY
    } else {
        request.max_edge.buffer(units)
    }
}

/// Returns about how many points of files are used: those not too far from the bounds, if there are
/// bounds. Lengths are taken to be in metres.
pub(crate) fn used_at_first(request: &TinRequest, method: Method, files: &[FileExtent]) -> u64 {
    let buffer = first_buffer(request, method, &Units::of(None));
    Reach::new(request.bounds, buffer, files).points_of(files)
}

/// What stays the same where points are read and triangulated several times.
struct Building<'a> {
    request: &'a TinRequest,
    layers: &'a LineLayers<'a>,
    /// All options and lines, without points.
    builder: TinBuilder,
    names: &'a LineNames,
    line_extents: LineExtents,
    transforms: &'a Transforms,
    /// The transform of each file of points.
    by_file: &'a [Option<usize>],
    units: &'a Units,
    journal: &'a Journal<'a>,
    /// The files of points.
    paths: Vec<&'a Path>,
}

/// The points that were read within reach.
struct Read {
    points: Vec<[f64; 3]>,
    report: SelectionReport,
    files: FilesRead,
}

/// A TIN, and what was done with its points.
struct Built {
    tin: Tin,
    points: SelectionReport,
    /// The files that were not read.
    left_out: LeftOutFiles,
    /// The points that water and walls replaced.
    replaced: Vec<[f64; 3]>,
}

impl Building<'_> {
    /// Reads and triangulates points, with a wider and wider reach, until no triangle within the
    /// bounds can depend on further ones.
    ///
    /// # Errors
    /// If a file cannot be read, too few points are left, or the run is canceled.
    fn surface(
        &self,
        files: &mut PointFiles,
        mut level_rings: Vec<LevelRing>,
        rim: &mut Rim,
        reach: &mut Reach,
    ) -> Result<Built> {
        loop {
            let Read {
                points,
                report,
                files: read,
            } = self.read(files, reach)?;
            memory::require_for_points(points.len())?;
            rim.find_limit(&read, self.units);
            self.compare_lines(&points, rim);
            // Once, also if more points are read.
            self.note_level_rings(std::mem::take(&mut level_rings), &points);
            let (tin, replaced) = self.triangulate(points, &read, rim, reach)?;
            match tin {
                Ok(tin) if tin.report().uncertain == 0 => {
                    return Ok(Built {
                        tin,
                        points: report,
                        left_out: read.left_out,
                        replaced,
                    });
                }
                Ok(tin) => {
                    let buffer = self.units.length(reach.buffer());
                    self.journal
                        .add(Notice::Uncertain(tin.report().uncertain, buffer));
                }
                // Too few points are an error only if there are no more to add.
                Err(_) if reach.may_grow_into(&read.extents) => (),
                Err(error) => return Err(self.in_file(error)),
            }
            reach.grow(&files.extents(self.by_file));
        }
    }

    /// Reads the points within reach.
    ///
    /// # Errors
    /// If a file cannot be read, or no input is left, even with a wider reach.
    fn read(&self, files: &mut PointFiles, reach: &Reach) -> Result<Read> {
        let classes = &self.request.used_classes();
        let mut selection = Selection::new(classes.clone(), reach.window())
            .with_returns(self.request.returns.clone());
        let files = files.read(self.by_file, self.transforms, &mut selection, self.journal)?;
        extents::compare_files(&self.paths, &files.extents, self.units, self.journal);
        let (points, report) = selection.finish();
        self.transforms.warn(self.journal);
        note_classes(&report, classes, files.left_out, self.journal);
        if points.is_empty()
            && !self.layers.has_lines_with_heights()
            && !reach.may_grow_into(&files.extents)
        {
            return Err(nothing_left(&report, files.left_out.count, &self.paths));
        }
        let points = match &self.request.ground {
            Some(options) => keep_ground(points, self.units, options, self.journal)
                .map_err(|error| self.in_file(error))?,
            None => points,
        };
        Ok(Read {
            points,
            report,
            files,
        })
    }

    /// Adds a notice if the lines are far from all points, or extend the surface beyond them.
    fn compare_lines(&self, points: &[[f64; 3]], rim: &Rim) {
        if self.is_clipped() || self.line_extents.all().is_empty() {
            return;
        }
        let notice = extents::compare_lines(
            &Bounds::around(points),
            &self.line_extents,
            rim.buffer,
            rim.limit.usual_reach(rim.spacing, self.units),
            self.units,
        );
        notice
            .into_iter()
            .for_each(|notice| self.journal.add(notice));
    }

    /// Adds a notice if points inside of closed lines of one height have other heights.
    fn note_level_rings(&self, rings: Vec<LevelRing>, points: &[[f64; 3]]) {
        let tolerance = default_tolerance(self.units);
        if let Some(rings) = LevelRings::of(rings, &self.request.lines, tolerance) {
            let mut found = rings.none_found();
            rings.count(points, &mut found);
            let notice = rings.notice(&found, self.names, self.units);
            notice
                .into_iter()
                .for_each(|notice| self.journal.add(notice));
        }
    }

    /// Triangulates points with the lines. Returns the TIN, or why there is none, and the points
    /// that water and walls replaced.
    ///
    /// # Errors
    /// If the run is canceled.
    fn triangulate(
        &self,
        points: Vec<[f64; 3]>,
        files: &FilesRead,
        rim: &Rim,
        reach: &Reach,
    ) -> Result<(Result<Tin>, Vec<[f64; 3]>)> {
        let mut builder = self.builder.clone();
        builder.max_edge = rim.max_edge;
        builder.leave_out_caps = rim.limit.leaves_out_caps();
        builder.window = reach.window().map(|read| ReadWindow {
            read,
            all: files.extents.clone(),
        });
        builder.add_owned_points(points);
        let replaced = builder.take_replaced_points();
        let work = self.journal.start(Stage::Triangulating, Size::Uncounted)?;
        let start = Instant::now();
        let tin = builder.build_named(&|line| self.names.name(line), self.journal.context.cancel);
        work.end()?;
        self.journal.add(Notice::Triangulated(start.elapsed()));
        Ok((tin, replaced))
    }

    /// Adds notices about lines in a finished TIN.
    fn note_lines(&self, inputs: &[LineInput], report: &TinReport) {
        notes::note_water_overlaps(report, self.names, self.units, self.journal);
        notes::note_walls_in_water(report, self.names, self.journal);
        notes::note_lakes_joined(report, self.names, self.units, self.journal);
        notes::note_waters_ended(report, self.names, self.journal);
        notes::note_flat_triangles(report, self.journal);
        if !self.is_clipped() {
            notes::note_apart(inputs, report, self.journal);
        }
    }

    /// Returns true if the surface is cut to bounds or a boundary, so that inputs may be elsewhere.
    fn is_clipped(&self) -> bool {
        self.request.bounds.is_some() || self.layers.has_boundary()
    }

    /// Adds the file to an error that can only concern that one.
    #[cold]
    fn in_file(&self, error: Error) -> Error {
        match self.paths.as_slice() {
            [file] if !self.layers.has_lines_with_heights() => error.in_file(file),
            _ => error,
        }
    }
}

/// Returns a builder with the options of a request, without points and lines.
pub(crate) fn builder_of(request: &TinRequest, units: &Units, crs: Option<Crs>) -> TinBuilder {
    let mut builder = TinBuilder::default();
    builder.duplicates = request.duplicates;
    builder.on_crossing = request.on_crossing;
    builder.crossing_heights = request.crossing_heights;
    builder.crossing_tolerance = request
        .crossing_tolerance
        .unwrap_or_else(|| default_tolerance(units));
    builder.step_width = Some(units.of_metres(WALL_WIDTH_METRES));
    builder.max_edge_inside = request.max_edge_inside;
    builder.add_ridges = request.lines.add_ridges;
    builder.bounds = request.bounds.map(|bounds| grown(bounds, 0.0));
    builder.crs = crs;
    builder
}

pub(crate) fn default_tolerance(units: &Units) -> f64 {
    units.height_of_metres(DEFAULT_CROSSING_TOLERANCE_METRES)
}

/// The limits of the surface where nothing was measured.
struct Rim {
    limit: EdgeLimit,
    max_edge: Option<f64>,
    buffer: f64,
    /// The mean distance between points, if there are any.
    spacing: Option<f64>,
}

impl Rim {
    fn new(request: &TinRequest, units: &Units, journal: &Journal) -> Self {
        let limit = request.max_edge;
        let rim = Rim {
            limit,
            max_edge: limit.length(None, units),
            buffer: limit.buffer(units),
            spacing: None,
        };
        if rim.limit != EdgeLimit::Auto {
            rim.note_limit(units, journal);
        }
        rim
    }

    fn note_limit(&self, units: &Units, journal: &Journal) {
        journal.add(self.limit.notice(self.max_edge, units));
    }

    /// Finds the mean distance between points, and the limit that follows from it.
    fn find_limit(&mut self, files: &FilesRead, units: &Units) {
        self.spacing = mean_distance(files.counted.iter().copied());
        self.max_edge = self.limit.length(self.spacing, units);
    }

    /// Adds a notice about a limit that was found, and about a default that looks wrong, also by
    /// what it leaves out.
    fn note(&self, report: &TinReport, units: &Units, journal: &Journal) {
        if self.limit == EdgeLimit::Auto {
            self.note_limit(units, journal);
        }
        self.limit
            .unusual(self.spacing, units)
            .into_iter()
            .for_each(|notice| journal.add(notice));
        let sites = report.points.saturating_sub(report.duplicates);
        self.limit
            .note_lost(&report.lost_at_rim, sites as u64, journal);
    }
}

fn note_classes(
    report: &SelectionReport,
    wanted: &Classes,
    left_out: LeftOutFiles,
    journal: &Journal,
) {
    if report.without_return > 0 {
        journal.add(Notice::PointsWithoutReturnUsed(report.without_return));
    }
    match wanted {
        Classes::Only(classes) => {
            let is_missing = |class: &u8| !report.by_class.contains_key(class);
            let missing = classes.iter().copied().filter(is_missing);
            journal.add_missing_classes(missing, left_out.unread());
        }
        Classes::GroundOrAll if report.classes.is_some() => {
            journal.add(Notice::GroundUsed);
            if report.without_class > 0 {
                journal.add(Notice::PointsWithoutClassUsed(report.without_class));
            }
        }
        Classes::GroundOrAll if !report.by_class.is_empty() => journal.add(Notice::AllClassesUsed),
        Classes::AllButNoise if !report.by_class.is_empty() => journal.add(Notice::NoiseUnused),
        Classes::GroundOrAll | Classes::All | Classes::AllButNoise => {}
    }
}

#[cold]
fn no_triangle(report: &TinReport, request: &TinRequest, rim: &Rim, units: &Units) -> Error {
    let TinReport {
        faces_beyond_max_edge: long,
        faces_clipped: clipped,
        ..
    } = report;
    match rim.max_edge {
        Some(length) if *long > 0 => {
            let length = units.length(length);
            let or_caps = match request.max_edge.leaves_out_caps() {
                true => " or are flat",
                false => "",
            };
            Error::format(format!(
                "no triangle is left: {long} have edges over {length}{or_caps} at the rim, {clipped} are clipped"
            ))
            .cure(wording![
                "allow them with ",
                Setting::MaxEdge.number("LENGTH"),
                " or ",
                Setting::MaxEdge.text("none")
            ])
        }
        _ => Error::format(format!(
            "no triangle is left: {clipped} lie {}",
            request.what_is_clipped()
        ))
        .cure(wording![Command::Info, " shows the extent of each file"]),
    }
}

#[cold]
fn nothing_left(report: &SelectionReport, left_out: usize, files: &[&Path]) -> Error {
    let SelectionReport {
        read,
        withheld,
        other_return,
        other_class,
        outside,
        ..
    } = report;
    let named = |error: Error| match files {
        [file] => error.in_file(file),
        _ => error,
    };
    if *read == 0 && left_out == 0 {
        return named(
            Error::format("no points in the input").cure("pass files that contain points"),
        );
    }
    let of_returns = match other_return {
        0 => String::new(),
        count => format!(", {count} of other returns"),
    };
    let unread = match left_out {
        0 => String::new(),
        1 => "; 1 file is not read, because by its header it is further out".to_owned(),
        files => {
            format!("; {files} files are not read, because by their headers they are further out")
        }
    };
    let error = named(Error::format(format!(
        "no point is left of {read} read: {withheld} withheld{of_returns}, {other_class} of other classes, {outside} outside of the bounds{unread}"
    )));
    if *outside > 0 || left_out > 0 {
        return error.cure(wording![
            "compare ",
            Setting::Bounds,
            " with the extent that ",
            Command::Info,
            " shows"
        ]);
    }
    if *other_class > 0 {
        let classes: Vec<String> = report.by_class.keys().map(u8::to_string).collect();
        return error.cure(wording![
            format!("the points have class {}: choose with ", classes.join(", ")),
            Setting::Class
        ]);
    }
    if *other_return > 0 {
        return error.cure(wording![
            Command::Info,
            " counts the points of each return: choose with ",
            Setting::Return
        ]);
    }
    error.cure(
        "withheld points are never used: clear the withheld flag on points that should be used",
    )
}

//! From the points and lines of a request to a TIN: what is read, in which coordinate system, with
//! which defaults.

use std::path::Path;
use std::time::Instant;

use super::context::{Journal, Size, Stage};
use super::crossings::{self, LineNames};
use super::extents;
use super::input::{Input, MemoryPoints};
use super::layers;
use super::lines;
use super::memory;
use super::notice::Notice;
use super::open::{self, Content, content};
use super::point_files::PointFiles;
use super::systems::{self, Role, Stated, SystemOptions, Systems};
use super::transforms::Transforms;
use super::units::Units;
use crate::data::{Bounds, Columns, Layer};
use crate::error::{Error, Result};
use crate::io::points;
use crate::terrain::{
    Classes, CrossingRule, DuplicateRule, Selection, SelectionReport, Tin, TinBuilder, TinReport, Window,
};
use crate::triangulation::OnCrossing;

/// The default longest edge at the rim, and width of the buffer around bounds.
const DEFAULT_MAX_EDGE_METRES: f64 = 100.0;

/// The default tolerance of heights where breaklines meet: the accuracy of a survey of edges.
const DEFAULT_CROSSING_TOLERANCE_METRES: f64 = 0.01;

/// The points and lines that a TIN is built from, and the options of building it. Lengths are in
/// the units of the coordinate system of the result, heights in its units of heights.
///
/// The default has no input, and these options: ground points are used (class 2; all points if no
/// point has it), triangles at the rim with edges over 100 metres are left out, the lowest of
/// several heights is used, and breaklines are split where they cross.
#[derive(Debug, Clone, Default)]
pub struct TinRequest {
    /// The points. Their order makes no difference, except for [`DuplicateRule::First`] and `Last`.
    pub points: Vec<Input<MemoryPoints>>,
    /// Options of reading files of points.
    pub read: points::Options,
    /// The classes to use. Points that are flagged as withheld are never used.
    pub classes: Classes,
    /// Lines with heights that the surface must follow; of polygons, the rings are used. At the
    /// vertices of a breakline its heights are used, not those of points.
    pub breaklines: Vec<Input<Layer>>,
    /// Polygons that the finished surface is cut to; what is inside any of them is kept. The lines
    /// of a layer count as one polygon if they close to rings.
    pub boundary: Vec<Input<Layer>>,
    /// A box that the finished surface is cut to; its heights are ignored. Points around it are
    /// used, too, so far out that the surface inside is the same as with all points.
    pub bounds: Option<Bounds>,
    /// Triangles at the rim with longer edges are left out.
    pub max_edge: EdgeLimit,
    /// Which height is used where points have the same position.
    pub duplicates: DuplicateRule,
    /// What to do where breaklines cross between their vertices.
    pub on_crossing: OnCrossing,
    /// Which height is used where breaklines cross between their vertices.
    pub crossing_heights: CrossingRule,
    /// The largest difference of heights at which no notice is given where breaklines meet. `None`
    /// is 0.01 metres, or 0.01 units if the unit is not known.
    pub crossing_tolerance: Option<f64>,
}

impl TinRequest {
    /// Returns an error if a file that is given as a layer is known to be of a kind without lines
    /// or polygons, such as a raster.
    ///
    /// # Errors
    /// Names the file and its kind.
    pub fn check_layers(&self) -> Result<()> {
        refuse_other_kinds("--breaklines takes lines or polygons", &self.breaklines)?;
        refuse_other_kinds("--boundary takes polygons or closed lines", &self.boundary)
    }
}

fn refuse_other_kinds(wanted: &str, layers: &[Input<Layer>]) -> Result<()> {
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
        return Err(Error::usage(format!("{wanted}, this is {what}")).in_file(path));
    }
    Ok(())
}

/// The longest edge that a triangle at the rim may have in plan. Triangles that can be reached from
/// outside across longer edges are left out; breaklines are not crossed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum EdgeLimit {
    /// 100 metres, in units of the coordinate system; 100 units if none is known.
    #[default]
    Standard,
    /// No limit: the whole convex hull is kept.
    Unlimited,
    /// This length, in the units of the coordinate system.
    Length(f64),
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
    /// The number of breaklines read; each part and each ring counts.
    pub breaklines: usize,
    /// Counts of the TIN and of what was left out of it.
    pub tin: TinReport,
    /// The rule for points with the same position.
    pub duplicates: DuplicateRule,
    /// Names of the breaklines, by their positions in [`TinReport::crossing_heights`].
    pub line_names: LineNames,
}

/// Reads the points and lines of a request and builds the TIN.
pub(super) fn build(request: &TinRequest, options: &SystemOptions, journal: &Journal) -> Result<(Tin, BuildReport)> {
    if let Some(Bounds { min, max }) = request.bounds
        && !(0..2).all(|i| min[i] < max[i] && min[i].is_finite() && max[i].is_finite())
    {
        return Err(Error::usage(format!("the bounds go from {} {} to {} {}", min[0], min[1], max[0], max[1])));
    }
    request.check_layers()?;
    let mut files = PointFiles::open(&request.points, request.read, journal)?;
    let breaklines = layers::read(&request.breaklines, &[], journal)?;
    let boundary = layers::read(&request.boundary, &[], journal)?;

    let mut stated = files.stated(&request.classes, journal)?;
    stated.extend(
        breaklines
            .iter()
            .chain(&boundary)
            .map(|(path, layer)| Some(Stated { path: path.to_path_buf(), crs: layer.crs.clone(), role: Role::Lines })),
    );
    let Systems { from, crs } = systems::reconcile_some(&stated, options, journal)?;
    let transforms = Transforms::new(&from, crs.as_ref(), journal)?;
    let (of_points, of_layers) = transforms.by_file.split_at(files.len());
    let (of_lines, of_boundary) = of_layers.split_at(breaklines.len());

    let units = Units::of(crs.as_ref());
    let mut builder = TinBuilder::default();
    let rim = Rim::new(request, &units, journal);
    let default_tolerance = units.height_of_metres(DEFAULT_CROSSING_TOLERANCE_METRES);
    builder.duplicates = request.duplicates;
    builder.on_crossing = request.on_crossing;
    builder.crossing_heights = request.crossing_heights;
    builder.crossing_tolerance = request.crossing_tolerance.unwrap_or(default_tolerance);
    builder.max_edge = rim.max_edge;
    builder.bounds = request.bounds.map(|bounds| grown(bounds, 0.0));
    builder.crs = crs;

    // Lines first: they are few, and their errors are known before the points are read.
    let mut line_count = 0;
    let mut line_extent = Bounds::default();
    let mut names = LineNames::new(breaklines.iter().map(|(path, _)| path.to_path_buf()).collect());
    for (file, ((path, layer), transform)) in breaklines.iter().zip(of_lines).enumerate() {
        for mut line in lines::breaklines(layer, path)? {
            transforms.apply(*transform, &mut line.points).map_err(|e| e.in_file(path))?;
            line_count += 1;
            line.points.iter().for_each(|&vertex| line_extent.add(vertex));
            builder.add_breakline(&line.points);
            names.add(file, &line);
        }
    }
    for rings in layers::polygons(&boundary, of_boundary, &transforms)? {
        builder.add_boundary(&rings);
    }

    let paths: Vec<&Path> = request.points.iter().map(Input::path).collect();
    let mut reach = Reach::new(request, &rim);
    let (tin, points) = loop {
        let mut selection = Selection::new(request.classes.clone(), reach.window());
        let extents = files.read(of_points, &transforms, &mut selection, journal)?;
        extents::compare_files(&paths, &extents, &units, journal);
        let (points, report) = selection.finish();
        transforms.warn(journal);
        note_classes(&report, &request.classes, journal);
        if points.is_empty() && line_count == 0 && !reach.may_grow_into(&report) {
            return Err(nothing_left(&report, &paths));
        }
        if request.bounds.is_none() && boundary.is_empty() {
            extents::compare_lines(&points, line_extent, rim.buffer, &units, journal);
        }
        memory::require_for_points(points.len())?;
        let mut builder = builder.clone();
        builder.window = reach.window().map(|read| Window { read, all: report.extent });
        builder.add_owned_points(points);
        let work = journal.start(Stage::Triangulating, Size::Uncounted)?;
        let start = Instant::now();
        let tin = builder.build_named(&|line| names.name(line), journal.context.cancel);
        work.end()?;
        journal.add(Notice::Triangulated(start.elapsed()));
        match tin {
            Ok(tin) if tin.report().uncertain == 0 => break (tin, report),
            Ok(tin) => journal.add(Notice::Uncertain(tin.report().uncertain, units.length(reach.buffer))),
            // Too few points are an error only if there are no more to add.
            Err(_) if reach.may_grow_into(&report) => (),
            Err(error) => {
                return Err(match paths.as_slice() {
                    [file] if request.breaklines.is_empty() => error.in_file(file),
                    _ => error,
                });
            }
        }
        reach.grow();
    };
    reach.note(&points, &units, journal);
    crossings::note(tin.report(), &names, &units, journal);
    if tin.report().triangles == 0 {
        return Err(no_triangle(tin.report(), &rim, &units));
    }
    let report = BuildReport {
        sources: request.points.len(),
        points,
        columns: files.columns(),
        breaklines: line_count,
        tin: tin.report().clone(),
        duplicates: request.duplicates,
        line_names: names,
    };
    Ok((tin, report))
}

/// Returns a box enlarged by a length on all sides in plan, and unbounded in z.
fn grown(Bounds { min, max }: Bounds, by: f64) -> Bounds {
    Bounds { min: [min[0] - by, min[1] - by, f64::NEG_INFINITY], max: [max[0] + by, max[1] + by, f64::INFINITY] }
}

/// The limits of the surface where nothing was measured.
struct Rim {
    max_edge: Option<f64>,
    buffer: f64,
}

impl Rim {
    fn new(request: &TinRequest, units: &Units, journal: &Journal) -> Self {
        let default = units.of_metres(DEFAULT_MAX_EDGE_METRES);
        let max_edge = match request.max_edge {
            EdgeLimit::Unlimited => None,
            EdgeLimit::Length(length) => Some(length),
            EdgeLimit::Standard => Some(default),
        };
        journal.add(max_edge.map_or(Notice::NoEdgeLimit, |length| Notice::EdgeLimit(units.length(length))));
        Rim { max_edge, buffer: max_edge.unwrap_or(default) }
    }
}

/// The buffer outside of the bounds in which points are used, so wide that the surface inside the
/// bounds is the same as with all points.
struct Reach {
    bounds: Option<Bounds>,
    buffer: f64,
}

impl Reach {
    fn new(request: &TinRequest, rim: &Rim) -> Self {
        let is_read_once = request.points.iter().any(Input::is_read_once);
        Reach { bounds: request.bounds, buffer: if is_read_once { f64::INFINITY } else { rim.buffer } }
    }

    /// Returns the box in which points are used.
    fn window(&self) -> Option<Bounds> {
        self.bounds.map(|bounds| grown(bounds, self.buffer))
    }

    /// Returns true if some points were not used and the bounds overlap the extent of all points: a
    /// wider buffer may then contain more.
    fn may_grow_into(&self, report: &SelectionReport) -> bool {
        let all = &report.extent;
        self.bounds.is_some_and(|bounds| {
            let is_apart = |k: usize| bounds.min[k] > all.max[k] || bounds.max[k] < all.min[k];
            report.outside > 0 && !is_apart(0) && !is_apart(1)
        })
    }

    fn grow(&mut self) {
        self.buffer *= 2.0;
    }

    fn note(&self, report: &SelectionReport, units: &Units, journal: &Journal) {
        if self.bounds.is_some() {
            let buffer = Some(units.length(self.buffer)).filter(|_| report.outside > 0);
            journal.add(Notice::BoundsBuffer(buffer));
        }
    }
}

fn note_classes(report: &SelectionReport, wanted: &Classes, journal: &Journal) {
    if let Classes::Only(classes) = wanted {
        for class in classes.iter().filter(|class| !report.by_class.contains_key(class)) {
            journal.add(Notice::NoPointOfClass(*class));
        }
    } else if report.classes.is_some() {
        journal.add(Notice::GroundUsed);
        if report.without_class > 0 {
            journal.add(Notice::PointsWithoutClassUsed(report.without_class));
        }
    } else if !report.by_class.is_empty() {
        journal.add(Notice::AllClassesUsed);
    }
}

#[cold]
fn no_triangle(report: &TinReport, rim: &Rim, units: &Units) -> Error {
    let TinReport { faces_beyond_max_edge: long, faces_clipped: clipped, .. } = report;
    match rim.max_edge {
        Some(length) if *long > 0 => {
            let length = units.length(length);
            Error::format(format!(
                "no triangle is left: {long} have edges over {length} at the rim, {clipped} are clipped"
            ))
            .cure("allow longer edges with --max-edge LENGTH or --max-edge none")
        }
        _ => Error::format(format!("no triangle is left: {clipped} lie outside of the boundary or the bounds"))
            .cure("`breakline info` shows the extent of each file"),
    }
}

#[cold]
fn nothing_left(report: &SelectionReport, files: &[&Path]) -> Error {
    let SelectionReport { read, withheld, other_class, outside, .. } = report;
    let named = |error: Error| match files {
        [file] => error.in_file(file),
        _ => error,
    };
    if *read == 0 {
        return named(Error::format("no points in the input").cure("pass files that contain points"));
    }
    let error = named(Error::format(format!(
        "no point is left of {read} read: {withheld} withheld, {other_class} of other classes, {outside} outside of the bounds"
    )));
    if *outside > 0 {
        return error.cure("compare --bounds with the extent that `breakline info` shows");
    }
    if *other_class > 0 {
        let classes: Vec<String> = report.by_class.keys().map(u8::to_string).collect();
        return error.cure(format!("the points have class {}: choose with --class", classes.join(", ")));
    }
    error.cure("withheld points are never used: clear the withheld flag on points that should be used")
}

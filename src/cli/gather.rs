//! From files to a surface.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::args::{Corners, EdgeLength};
use super::crossings::{self, LineNames};
use super::extents;
use super::inputs;
use super::open;
use super::plan::{From, PointPlan, SurfacePlan};
use super::point_files::PointFiles;
use super::progress::Size;
use super::relabeled::Relabeled;
use super::roads::Roads;
use super::summary::{Made, seconds};
use super::systems::{self, Role, Stated, Systems, Wish};
use super::talk::Talk;
use crate::crs::Crs;
use crate::data::{Bounds, Grid, Layer, Surface};
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::lines::{self, Rings};
use crate::run::memory;
use crate::run::units::Units;
use crate::terrain::{Classes, Selection, SelectionReport, TinBuilder, TinReport, Window};

/// Longest edge at the rim, and width of the buffer around bounds, unless something else is said.
const DEFAULT_MAX_EDGE_METRES: f64 = 100.0;

/// What heights of breaklines that meet may differ by, unless something else is said: what a survey of edges is good
/// for.
const DEFAULT_CROSSING_TOLERANCE_METRES: f64 = 0.01;

/// What the verbs work on.
pub(super) enum Ground {
    Surface(Box<Gathered>),
    Raster(Box<Grid>),
}

impl Ground {
    pub(super) fn crs(&self) -> Option<&Crs> {
        match self {
            Ground::Surface(gathered) => gathered.surface.crs(),
            Ground::Raster(grid) => grid.crs.as_ref(),
        }
    }
}

/// A surface, and what is to be told of how it was made.
pub(super) struct Gathered {
    pub(super) surface: Box<dyn Surface>,
    pub(super) made: Made,
}

/// Reads what the plan names; builds the TIN where there is none yet. The report of crossings, where one is wanted,
/// is added to the outputs.
///
/// # Errors
/// If anything cannot be read or is refused.
pub(super) fn ground(plan: &mut SurfacePlan, outputs: &OutputSet, talk: &Talk) -> Result<Ground> {
    match &mut plan.from {
        From::Points(points) => {
            build(points, &plan.wish, outputs, talk).map(|gathered| Ground::Surface(Box::new(gathered)))
        }
        From::Mesh(path) => {
            let mesh = open::mesh(path, talk)?;
            let crs = one_system(path, mesh.crs(), &plan.wish, talk)?;
            let surface = Box::new(Relabeled { surface: mesh, crs });
            Ok(Ground::Surface(Box::new(Gathered { surface, made: Made::default() })))
        }
        From::Raster(path) => {
            let (mut grid, warnings) = open::raster(path, talk)?;
            warnings.iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
            grid.crs = one_system(path, grid.crs.as_ref(), &plan.wish, talk)?;
            Ok(Ground::Raster(Box::new(grid)))
        }
    }
}

/// The triangles of a mesh whatever is wrong with them, and what that is.
///
/// # Errors
/// If it cannot be read.
pub(super) fn mesh_with_flaws(path: &Path, wish: &Wish, talk: &Talk) -> Result<(Gathered, Vec<String>)> {
    let (mesh, flaws) = open::mesh_with_flaws(path, talk)?;
    let crs = one_system(path, mesh.crs(), wish, talk)?;
    Ok((Gathered { surface: Box::new(Relabeled { surface: mesh, crs }), made: Made::default() }, flaws))
}

/// The same for verbs that need triangles.
///
/// # Errors
/// Also if the input is a raster.
pub(super) fn surface(plan: &mut SurfacePlan, outputs: &OutputSet, talk: &Talk) -> Result<Gathered> {
    if let From::Raster(path) = &plan.from {
        return Err(Error::usage("the input is a raster; points or a .ply are needed")
            .in_file(path)
            .cure("`contour` and `hillshade` take rasters"));
    }
    match ground(plan, outputs, talk)? {
        Ground::Surface(gathered) => Ok(*gathered),
        Ground::Raster(_) => Err(Error::usage("points or a .ply are needed")),
    }
}

fn one_system(path: &Path, crs: Option<&Crs>, wish: &Wish, talk: &Talk) -> Result<Option<Crs>> {
    let stated = [Stated { path: path.to_path_buf(), crs: crs.cloned(), role: Role::Whole }];
    Ok(systems::reconcile(&stated, wish, talk)?.crs)
}

fn build(plan: &mut PointPlan, wish: &Wish, outputs: &OutputSet, talk: &Talk) -> Result<Gathered> {
    let mut files = PointFiles::open(&plan.files, plan.read, talk)?;
    let breaklines = layers(&plan.breaklines, talk)?;
    let boundary = layers(&plan.boundary, talk)?;

    let mut stated = files.stated(&plan.classes)?;
    stated.extend(
        breaklines
            .iter()
            .chain(&boundary)
            .map(|(path, layer)| Some(Stated { path: path.clone(), crs: layer.crs.clone(), role: Role::Lines })),
    );
    let Systems { from, crs } = systems::reconcile_some(&stated, wish, talk)?;
    let roads = Roads::new(&from, crs.as_ref(), talk)?;
    let (point_roads, layer_roads) = roads.by_file.split_at(files.len());
    let (line_roads, boundary_roads) = layer_roads.split_at(breaklines.len());

    let units = Units::of(crs.as_ref());
    let mut builder = TinBuilder::default();
    let rim = Rim::new(plan, &units, talk);
    let default_tolerance = units.height_of_metres(DEFAULT_CROSSING_TOLERANCE_METRES);
    builder.duplicates = plan.duplicates;
    builder.on_crossing = plan.on_crossing;
    builder.crossing_heights = plan.crossing_heights;
    builder.crossing_tolerance = plan.crossing_tolerance.unwrap_or(default_tolerance);
    builder.max_edge = rim.max_edge;
    builder.bounds = plan.bounds.map(|bounds| bounds.grown(0.0));
    builder.crs = crs;

    // Lines first: they are few, and what is wrong with them is known before the points are read.
    let mut made = Made::default();
    let mut line_extent = Bounds::default();
    let mut names = LineNames::new(&plan.breaklines);
    for (file, ((path, layer), road)) in breaklines.iter().zip(line_roads).enumerate() {
        for mut line in lines::breaklines(layer, path)? {
            roads.take(*road, &mut line.points).map_err(|e| e.in_file(path))?;
            made.breaklines += 1;
            line.points.iter().for_each(|&vertex| line_extent.add(vertex));
            builder.add_breakline(&line.points);
            names.add(file, &line);
        }
    }
    for rings in clip_polygons(&boundary, boundary_roads, &roads)? {
        builder.add_boundary(&rings);
    }

    let mut reach = Reach::new(plan, &rim);
    let (tin, report) = loop {
        let mut selection = Selection::new(plan.classes.clone(), reach.window());
        let extents = files.read(point_roads, &roads, &mut selection, talk)?;
        extents::tell_apart(&plan.files, &extents, &units, talk);
        let (points, report) = selection.finish();
        roads.warn(talk);
        tell_classes(&report, &plan.classes, talk);
        if points.is_empty() && made.breaklines == 0 && !reach.may_grow_into(&report) {
            return Err(nothing_left(&report, &plan.files));
        }
        if plan.bounds.is_none() && boundary.is_empty() {
            extents::tell_beyond(&points, line_extent, rim.buffer, &units, talk);
        }
        memory::require_for_points(points.len())?;
        let mut builder = builder.clone();
        builder.window = reach.window().map(|read| Window { read, all: report.extent });
        builder.add_owned_points(points);
        let progress = talk.progress("triangulating", Size::Uncounted);
        let start = Instant::now();
        let tin = builder.build_named(&|line| names.tell(line));
        drop(progress);
        talk.detail(format_args!("triangulated in {}", seconds(start.elapsed())));
        match tin {
            Ok(tin) if tin.report().uncertain == 0 => break (tin, report),
            Ok(tin) => talk.detail(format_args!(
                "{} triangles within the bounds may change with points further out than {}",
                tin.report().uncertain,
                units.length(reach.buffer)
            )),
            // Too few points are an error only if there are no others.
            Err(_) if reach.may_grow_into(&report) => (),
            Err(error) => {
                return Err(match plan.files.as_slice() {
                    [file] if plan.breaklines.is_empty() => error.in_file(file),
                    _ => error,
                });
            }
        }
        reach.grow();
    };
    reach.tell(&report, &units, talk);
    crossings::tell(tin.report(), &names, &units, talk);
    if let Some(report) = &plan.crossing_report {
        crossings::write(outputs, report, &tin.report().crossing_heights, &names)?;
    }
    if tin.report().triangles == 0 {
        return Err(no_triangle(tin.report(), &rim, &units));
    }
    made.files = plan.files.len();
    made.columns = files.columns_line();
    made.points = Some(report);
    made.tin = Some(tin.report().clone());
    made.duplicates = plan.duplicates;
    Ok(Gathered { surface: Box::new(tin), made })
}

/// How far the surface may reach where nothing was measured.
struct Rim {
    max_edge: Option<f64>,
    buffer: f64,
}

impl Rim {
    fn new(plan: &PointPlan, units: &Units, talk: &Talk) -> Self {
        let default = units.of_metres(DEFAULT_MAX_EDGE_METRES);
        let max_edge = match plan.max_edge {
            Some(EdgeLength::None) => None,
            Some(EdgeLength::Length(length)) => Some(length),
            None => Some(default),
        };
        match max_edge {
            Some(length) => talk.note(format_args!(
                "triangles at the rim with edges over {} are left out (--max-edge)",
                units.length(length)
            )),
            None => talk.note("the whole convex hull is kept (--max-edge none)"),
        }
        let buffer = max_edge.unwrap_or(default);
        Rim { max_edge, buffer }
    }
}

/// How far outside of the bounds points are used: as far as it takes for the surface within to be that of all points.
struct Reach {
    bounds: Option<Corners>,
    buffer: f64,
}

impl Reach {
    fn new(plan: &PointPlan, rim: &Rim) -> Self {
        let is_read_once = plan.files.iter().any(|file| inputs::is_read_once(file));
        Reach { bounds: plan.bounds, buffer: if is_read_once { f64::INFINITY } else { rim.buffer } }
    }

    /// Where points are used.
    fn window(&self) -> Option<Bounds> {
        self.bounds.map(|bounds| bounds.grown(self.buffer))
    }

    /// Whether there are points that were not used, and that bounds within the extent of all points do not rule out.
    fn may_grow_into(&self, report: &SelectionReport) -> bool {
        let all = &report.extent;
        self.bounds.map(|bounds| bounds.grown(0.0)).is_some_and(|bounds| {
            let is_apart = |k: usize| bounds.min[k] > all.max[k] || bounds.max[k] < all.min[k];
            report.outside > 0 && !is_apart(0) && !is_apart(1)
        })
    }

    fn grow(&mut self) {
        self.buffer *= 2.0;
    }

    fn tell(&self, report: &SelectionReport, units: &Units, talk: &Talk) {
        if self.bounds.is_some() {
            let how_far = match report.outside {
                0 => "all points are used".to_owned(),
                _ => format!("points up to {} outside of the bounds are used", units.length(self.buffer)),
            };
            talk.note(format_args!("{how_far}, so that the surface within is that of all points"));
        }
    }
}

fn layers(paths: &[PathBuf], talk: &Talk) -> Result<Vec<(PathBuf, Layer)>> {
    let mut layers = Vec::with_capacity(paths.len());
    for path in paths {
        let layer = open::layer(path).map_err(|e| e.in_file(path))?;
        talk.detail(format_args!("{}: {}, {} records", path.display(), layer.format, layer.shapes.len()));
        layer.warnings.iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
        layers.push((path.clone(), layer));
    }
    Ok(layers)
}

fn tell_classes(report: &SelectionReport, wanted: &Classes, talk: &Talk) {
    if let Classes::Only(classes) = wanted {
        for class in classes.iter().filter(|class| !report.by_class.contains_key(class)) {
            talk.warning(format_args!("no point is of class {class}"));
        }
    } else if report.classes.is_some() {
        talk.note("class 2 (ground) is used");
        if report.without_class > 0 {
            talk.note(format_args!("{} points of files without classes are used too", report.without_class));
        }
    } else if !report.by_class.is_empty() {
        talk.warning("no point is of class 2 (ground): all classes are used (--class chooses)");
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
            .cure("`breakline info` tells the extent of each file"),
    }
}

#[cold]
fn nothing_left(report: &SelectionReport, files: &[PathBuf]) -> Error {
    let SelectionReport { read, withheld, other_class, outside, .. } = report;
    let named = |error: Error| match files {
        [file] => error.in_file(file),
        _ => error,
    };
    if *read == 0 {
        return named(Error::format("there is no point").cure("give files that hold points"));
    }
    let error = named(Error::format(format!(
        "no point is left of {read} read: {withheld} withheld, {other_class} of other classes, {outside} outside of the bounds"
    )));
    if *outside > 0 {
        return error.cure("compare --bounds with the extent that `breakline info` tells");
    }
    if *other_class > 0 {
        let classes: Vec<String> = report.by_class.keys().map(u8::to_string).collect();
        return error.cure(format!("the points are of class {}: choose with --class", classes.join(", ")));
    }
    error.cure("withheld points are never used: take the mark off those that are good")
}

/// The polygons that the surface is clipped to.
fn clip_polygons(boundary: &[(PathBuf, Layer)], by_file: &[Option<usize>], roads: &Roads) -> Result<Vec<Rings>> {
    let mut polygons = Vec::new();
    for ((path, layer), road) in boundary.iter().zip(by_file) {
        for mut rings in lines::polygons(layer, path)? {
            for ring in &mut rings {
                let mut points: Vec<[f64; 3]> = ring.iter().map(|p| [p[0], p[1], 0.0]).collect();
                roads.take(*road, &mut points).map_err(|e| e.in_file(path))?;
                *ring = points.into_iter().map(|p| [p[0], p[1]]).collect();
            }
            polygons.push(rings);
        }
    }
    Ok(polygons)
}

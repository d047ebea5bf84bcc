//! Selecting, clipping and merging points from files, to a file or to memory.

use std::path::{Path, PathBuf};

use super::lattice;
use super::thinned::Thinned;
use crate::crs::Crs;
use crate::data::{
    Bounds, Layer, PointBatch, PointFlags, PointInfo, PointSink, PointSource, PointSummary, Return,
};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::Destination;
use crate::io::las::{self, Detail, Rounding};
use crate::io::points::{self, Options};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::lines::layers::{self, Layers};
use crate::run::request::input::{Input, is_read_once, named};
use crate::run::sources::file_extent::stated_extent;
use crate::run::sources::narrowed::{Share, narrow};
use crate::run::sources::open;
use crate::run::sources::point_files::{ASK_EVERY, FILES_KEPT_OPEN};
use crate::run::sources::systems::{self, Stated, SystemOptions, Systems};
use crate::run::sources::transforms::{TargetSystem, Transforms};
use crate::terrain::{Inside, Thinning};

/// The files to read and the points to write. By default all points are written.
#[derive(Debug, Clone, Default)]
pub struct PointsRequest {
    /// Files of points, in the order of the output.
    pub files: Vec<PathBuf>,
    /// Options of reading them.
    pub read: Options,
    /// Classes to write; all if empty. Points of formats without classes are always written.
    pub classes: Vec<u8>,
    /// Returns to write; all if empty. Points of formats without returns are always written.
    pub returns: Vec<Return>,
    /// What to do with points that are flagged as withheld.
    pub withheld: Withheld,
    /// The box in plan to clip to, including its border.
    pub bounds: Option<Bounds>,
    /// Layers with polygons to clip to, including their borders.
    pub boundary: Vec<PathBuf>,
    /// Which of the selected points to write; all by default. Lengths are in the units of the
    /// output's coordinates.
    pub thinning: Option<Thinning>,
    /// What to do with coordinates that are not on the lattice of a LAS output.
    pub rounding: Rounding,
    /// Options of coordinate systems. Points in degrees are written whatever these say. An output
    /// in LAS states the system that is assigned or reprojected to; points that are reprojected get
    /// a new scale and offset.
    pub systems: SystemOptions,
}

/// What to do with points that are flagged as withheld.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Withheld {
    /// They are written, with their flag.
    #[default]
    Keep,
    /// They are left out.
    Drop,
}

/// Counts of the points that were written and of those that were left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointsReport {
    /// Points read. Files, and nodes of octrees, are not read that state, in the coordinates of the
    /// bounds, that all of their points lie outside of these.
    pub read: u64,
    /// The number of files that were not read.
    pub left_out: usize,
    /// The points written: their number and the box around them.
    pub written: PointSummary,
    /// Points left out because they are withheld.
    pub withheld: u64,
    /// Points left out because of their class.
    pub other_class: u64,
    /// Points left out because of their return.
    pub other_return: u64,
    /// Points left out because they are outside of the bounds or the boundary.
    pub outside: u64,
    /// Points that were selected, but left out by the thinning.
    pub thinned: u64,
    /// The coordinate system of all files.
    pub crs: Option<Crs>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Reads points file after file, and writes the selected ones in the same order.
///
/// Needs memory for some chunks of points only, however large the files are, and for what a
/// [`Thinning`] holds. By a smallest distance, large files are read several times.
///
/// # Errors
/// If a file cannot be read, the files are in different coordinate systems and no target is
/// requested, reprojection is not possible, points cannot be written together without a loss (see
/// [`las::create`](crate::io::las::create)), no point is left, or the run is canceled. Nothing is
/// written then.
pub fn write_points(
    request: &PointsRequest,
    target: Destination,
    context: &Context,
) -> Result<PointsReport> {
    let detail = points::detail_for(target)?;
    transfer(request, detail, Stage::WritingPoints, context, |infos| {
        points::create(target, infos, request.rounding)
    })
}

/// Points in memory, and the report of reading them.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct PointsProduct {
    /// The points, in columns. If any file has classes and flags, or return numbers, these are 0
    /// for the points of files without them.
    pub points: PointBatch,
    /// Counts of the points.
    pub report: PointsReport,
}

/// Reads points file after file, and returns the selected ones in the same order.
///
/// # Errors
/// Those of [`write_points`], except those of writing; and if there is not enough memory.
pub fn read_points(request: &PointsRequest, context: &Context) -> Result<PointsProduct> {
    let mut points = PointBatch::default();
    let report = transfer(
        request,
        Detail::Columns,
        Stage::ReadingPoints,
        context,
        |_| Ok(Box::new(Collected(&mut points)) as Box<dyn PointSink>),
    )?;
    Ok(PointsProduct { points, report })
}

/// Takes the selected points of all files to a sink.
pub(crate) fn transfer<'s>(
    request: &PointsRequest,
    detail: Detail,
    stage: Stage,
    context: &Context,
    create: impl FnOnce(&[&PointInfo]) -> Result<Box<dyn PointSink + 's>>,
) -> Result<PointsReport> {
    let journal = Journal::new(context);
    let options = Options {
        detail,
        ..request.read
    };
    let open =
        |path: &Path| open::points_of_file(path, options, context).map_err(|e| e.in_file(path));
    let mut sources: Vec<Option<Box<dyn PointSource + Send>>> = Vec::new();
    let mut infos: Vec<PointInfo> = Vec::new();
    for path in &request.files {
        let source = open(path)?;
        let info = source.info().clone();
        journal.add_warnings(path, &info.warnings);
        infos.push(info);
        let keep = request.files.len() <= FILES_KEPT_OPEN || is_read_once(path);
        sources.push(Some(source).filter(|_| keep));
    }
    let boundary: Vec<Input<Layer>> = request.boundary.iter().cloned().map(Input::File).collect();
    let boundary = layers::read(&boundary, &[], request.read.cut, &journal)?;
    let plan = Plan::new(request, &infos, &boundary, &journal)?;
    let (of_points, of_boundary) = plan.transforms.by_file.split_at(infos.len());
    let polygons = layers::boundaries(&boundary, of_boundary, &plan.transforms)?;
    let inside = (!polygons.is_empty()).then(|| Inside::new(&polygons));
    let restated = |((info, &number), path): ((PointInfo, &Option<usize>), &PathBuf)| {
        restated(info, &plan, number).map_err(|e| e.in_file(path))
    };
    let mut infos: Vec<PointInfo> = infos
        .into_iter()
        .zip(of_points)
        .zip(&request.files)
        .map(restated)
        .collect::<Result<_>>()?;
    share_lattice(&mut infos, of_points);
    let mut thinned = match request.thinning {
        Some(thinning) => Some(Thinned::new(thinning, &request.files)?),
        None => None,
    };
    let all: Vec<&PointInfo> = infos.iter().collect();
    let mut sink = create(&all)?;
    let pass = Pass {
        request,
        infos: &infos,
        numbers: of_points,
        plan: &plan,
        inside: inside.as_ref(),
        journal: &journal,
        stage,
    };
    let mut report = pass.run(&mut sources, &open, &mut *sink, thinned.as_mut())?;
    if let Some(thinned) = &mut thinned {
        while !thinned.end_pass() {
            // What is read again was reported already.
            let silent = Journal::new(context);
            let again = Pass {
                journal: &silent,
                ..pass
            };
            report = again.run(&mut sources, &open, &mut *sink, Some(&mut *thinned))?;
        }
        for (file, batch) in thinned.held() {
            let path = &request.files[file];
            sink.next_source(&infos[file])
                .map_err(|e| e.in_file(path))?;
            sink.write(&batch).map_err(|e| e.in_file(path))?;
            report.written.count += batch.len() as u64;
        }
    }
    if report.left_out > 0 {
        journal.add(Notice::FilesOutside {
            left_out: report.left_out,
            files: request.files.len(),
            are_searched: false,
            buffer: None,
        });
    }
    let left_out = report.withheld + report.other_class + report.other_return + report.outside;
    report.thinned = report.read - left_out - report.written.count;
    if report.written.count == 0 {
        return Err(nothing_left(&report, request));
    }
    report.written = sink.finish()?;
    plan.transforms.warn(&journal);
    report.crs.clone_from(&plan.crs);
    report.notices = journal.take();
    Ok(report)
}

/// What is needed to read all points once.
#[derive(Clone, Copy)]
struct Pass<'a> {
    request: &'a PointsRequest,
    infos: &'a [PointInfo],
    /// The transform of each file.
    numbers: &'a [Option<usize>],
    plan: &'a Plan,
    inside: Option<&'a Inside>,
    journal: &'a Journal<'a>,
    stage: Stage,
}

impl Pass<'_> {
    /// Reads the points of all files, and writes those that are selected and not held back by a
    /// thinning. Files that are not open are opened.
    fn run(
        &self,
        sources: &mut [Option<Box<dyn PointSource + Send>>],
        open: &dyn Fn(&Path) -> Result<Box<dyn PointSource + Send>>,
        sink: &mut dyn PointSink,
        mut thinned: Option<&mut Thinned>,
    ) -> Result<PointsReport> {
        let mut report = PointsReport::default();
        let count = self
            .infos
            .iter()
            .map(|info| info.count)
            .sum::<Option<u64>>();
        let work = self
            .journal
            .start(self.stage, count.map_or(Size::Unknown, Size::Items))?;
        let mut batch = PointBatch::default();
        for (file, (path, info)) in self.request.files.iter().zip(self.infos).enumerate() {
            let mut source = sources[file].take().map_or_else(|| open(path), Ok)?;
            sink.next_source(info).map_err(|e| e.in_file(path))?;
            let number = self.numbers[file];
            if self.narrow(info, number, &mut *source, path)? == Share::Nothing {
                report.left_out += 1;
                continue;
            }
            loop {
                source.read(&mut batch).map_err(|e| e.in_file(path))?;
                if batch.is_empty() {
                    break;
                }
                let count = batch.len() as u64;
                report.read += count;
                self.plan
                    .transforms
                    .apply_to_batch(number, &mut batch)
                    .map_err(|e| e.in_file(path))?;
                if let (Some(_), Some(_), Some(lattice)) = (number, &info.head, &info.lattice) {
                    las::put_coordinates(&mut batch, lattice).map_err(|e| e.in_file(path))?;
                }
                select(&mut batch, self.request, self.inside, &mut report);
                if let Some(thinned) = &mut thinned {
                    thinned
                        .choose(file, &mut batch)
                        .map_err(|e| e.in_file(path))?;
                }
                report.written.count += batch.len() as u64;
                sink.write(&batch).map_err(|e| e.in_file(path))?;
                work.add(count)?;
            }
            self.journal.add_warnings(path, source.warnings());
        }
        work.end()?;
        Ok(report)
    }

    /// Restricts the source of a file to the bounds, as far as the file states where its points
    /// are, and returns how much of it is left: all of a file that is reprojected.
    fn narrow(
        &self,
        info: &PointInfo,
        transform: Option<usize>,
        source: &mut (dyn PointSource + Send),
        path: &Path,
    ) -> Result<Share> {
        match (&self.request.bounds, transform) {
            (Some(bounds), None) if !stated_extent(info).meets(bounds) => Ok(Share::Nothing),
            (Some(bounds), None) => narrow(source, bounds, path, self.journal),
            _ => Ok(Share::Whole),
        }
    }
}

/// A sink that keeps points in memory.
struct Collected<'a>(&'a mut PointBatch);

impl PointSink for Collected<'_> {
    fn next_source(&mut self, _: &PointInfo) -> Result<()> {
        Ok(())
    }

    fn write(&mut self, batch: &PointBatch) -> Result<()> {
        let all = &mut *self.0;
        let (before, after) = (all.len(), all.len() + batch.len());
        if before / ASK_EVERY != after / ASK_EVERY {
            memory::require_for_columns(after)?;
        }
        all.x.extend_from_slice(&batch.x);
        all.y.extend_from_slice(&batch.y);
        all.z.extend_from_slice(&batch.z);
        extend(&mut all.class, &batch.class, before, after);
        extend(&mut all.flags, &batch.flags, before, after);
        extend(&mut all.return_number, &batch.return_number, before, after);
        extend(&mut all.return_count, &batch.return_count, before, after);
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<PointSummary> {
        let all = self.0;
        let mut bounds = Bounds::default();
        (0..all.len()).for_each(|i| bounds.add([all.x[i], all.y[i], all.z[i]]));
        Ok(PointSummary {
            count: all.len() as u64,
            bounds,
        })
    }
}

/// Appends values to a column that some sources do not have: it is empty as long as none has it.
fn extend<T: Clone + Default>(column: &mut Vec<T>, values: &[T], before: usize, after: usize) {
    if !values.is_empty() {
        column.resize(before, T::default());
        column.extend_from_slice(values);
    } else if !column.is_empty() {
        column.resize(after, T::default());
    }
}

/// The coordinate system of the result, and how points get there.
struct Plan {
    crs: Option<Crs>,
    /// True if the system was requested, not stated by the files.
    is_new: bool,
    /// The transform of each file of points, then of each layer of the boundary.
    transforms: Transforms,
}

impl Plan {
    fn new(
        request: &PointsRequest,
        infos: &[PointInfo],
        boundary: &Layers,
        journal: &Journal,
    ) -> Result<Self> {
        let points = request
            .files
            .iter()
            .zip(infos)
            .map(|(path, info)| Stated::by_points(path, info));
        let lines = boundary
            .iter()
            .map(|(path, layer)| Stated::by_layer(path, layer));
        let stated: Vec<Stated> = points.chain(lines).collect();
        let SystemOptions { assign, target, .. } = &request.systems;
        let Systems { from, crs } = systems::unify(&stated, &request.systems, journal)?;
        let to = TargetSystem {
            crs: crs.as_ref(),
            options: &request.systems.transform,
        };
        let transforms = Transforms::new(&from, to, journal)?;
        Ok(Plan {
            crs,
            is_new: assign.is_some() || target.is_some(),
            transforms,
        })
    }
}

/// Removes the points that are not selected from a batch, and counts them.
fn select(
    batch: &mut PointBatch,
    request: &PointsRequest,
    inside: Option<&Inside>,
    report: &mut PointsReport,
) {
    let is_listed = |list: &[u8], column: &[u8], i: usize| {
        list.is_empty() || column.get(i).is_none_or(|value| list.contains(value))
    };
    let is_of_returns = |found: Option<(u8, u8)>| {
        let is_wanted = |(number, count)| {
            request
                .returns
                .iter()
                .any(|wanted| wanted.is(number, count))
        };
        request.returns.is_empty() || found.is_none_or(is_wanted)
    };
    let is_withheld = |flags: Option<&PointFlags>| flags.is_some_and(|flags| flags.is_withheld());
    let mut keep = Vec::with_capacity(batch.len());
    for i in 0..batch.len() {
        let p = [batch.x[i], batch.y[i]];
        let left_out = if request.withheld == Withheld::Drop && is_withheld(batch.flags.get(i)) {
            Some(&mut report.withheld)
        } else if !is_listed(&request.classes, &batch.class, i) {
            Some(&mut report.other_class)
        } else if !is_of_returns(batch.return_of(i)) {
            Some(&mut report.other_return)
        } else if request.bounds.is_some_and(|bounds| !is_within(&bounds, p))
            || inside.is_some_and(|inside| !inside.contains(p))
        {
            Some(&mut report.outside)
        } else {
            None
        };
        keep.push(left_out.is_none());
        if let Some(count) = left_out {
            *count += 1;
        }
    }
    if keep.contains(&false) {
        batch.retain(&keep);
    }
}

fn is_within(bounds: &Bounds, p: [f64; 2]) -> bool {
    (0..2).all(|k| bounds.min[k] <= p[k] && p[k] <= bounds.max[k])
}

/// Returns what a sink is to be given of a source: the coordinate system of the result and, if the
/// points are reprojected, a lattice for them. A source without points keeps its lattice, because
/// the extent in its header means nothing.
fn restated(mut info: PointInfo, plan: &Plan, number: Option<usize>) -> Result<PointInfo> {
    info.crs.clone_from(&plan.crs);
    let Some(head) = &mut info.head else {
        return Ok(info);
    };
    if let Some(crs) = plan.crs.as_ref().filter(|_| plan.is_new) {
        las::state_system(head, crs)?;
    }
    if number.is_some()
        && info.count != Some(0)
        && let Some(lattice) = &mut info.lattice
    {
        let bounds = info.bounds.ok_or_else(|| {
            Error::format("the header states no extent, which scale and offset would be chosen by")
                .cure(wording![
                    "write the file without ",
                    Setting::TargetCrs,
                    " first: that counts its extent"
                ])
        })?;
        *lattice = lattice::reprojected(lattice, &bounds, |points| {
            plan.transforms.apply(number, points)
        })?;
    }
    Ok(info)
}

/// Gives reprojected sources without points the lattice of the first source that has points: their
/// own belongs to another coordinate system, and must not restrict that of the output.
fn share_lattice(infos: &mut [PointInfo], numbers: &[Option<usize>]) {
    let Some(lattice) = infos
        .iter()
        .find(|info| info.count != Some(0))
        .map(|info| info.lattice)
    else {
        return;
    };
    for (info, number) in infos.iter_mut().zip(numbers) {
        if info.head.is_some() && info.count == Some(0) && number.is_some() {
            info.lattice = lattice;
        }
    }
}

#[cold]
fn nothing_left(report: &PointsReport, request: &PointsRequest) -> Error {
    let PointsReport {
        read,
        withheld,
        other_class,
        other_return,
        outside,
        left_out,
        thinned,
        ..
    } = report;
    let boundary = named(
        "the boundary",
        request.boundary.iter().map(PathBuf::as_path),
    );
    let area = match (request.bounds, boundary) {
        (None, Some(boundary)) => boundary,
        (Some(_), Some(boundary)) => format!("the bounds or {boundary}"),
        (_, None) => "the bounds".to_owned(),
    };
    let error = match read {
        0 if *left_out > 0 => Error::usage(
            "no point is left: by their headers, the files lie outside of the bounds",
        )
        .cure(wording![Command::Info, " shows the extent of each file"]),
        0 => Error::format("no points in the input").cure("pass files that contain points"),
        _ if *thinned > 0 => Error::usage(format!(
            "no point is left: the thinning leaves out all {thinned} that were selected"
        ))
        .cure(wording!["state a larger share for ", Setting::Thin]),
        _ => Error::usage(format!(
            "no point is left of {read} read: {withheld} withheld, {other_class} of other classes, {other_return} of \
             other returns, {outside} outside of {area}"
        ))
        .cure(wording![Command::Info, " shows classes, returns and extent of each file"]),
    };
    match request.files.as_slice() {
        [file] => error.in_file(file),
        _ => error,
    }
}

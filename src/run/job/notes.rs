//! What a surface in one piece reports: for a job, from what the plan and the tasks find.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::lines::{JobLines, Known};
use super::plan::Plan;
use super::task_file::{SKIPPED, TaskFile};
use super::{Job, TiledProduct};
use crate::data::Bounds;
use crate::error::{Result, Wording};
use crate::run::context::{Context, Journal};
use crate::run::extents;
use crate::run::line_notes::OtherHeights;
use crate::run::line_request::LineRole;
use crate::run::notice::{Notice, Severity};
use crate::run::tin::{TinRequest, mean_distance};
use crate::run::units::Units;
use crate::terrain::{Classes, SelectionReport};

/// The names of facts.
const NOTICES: &str = "notices";
const CLASSES: &str = "classes";
const WITHOUT_CLASS: &str = "without_class";
const EXTENT_USED: &str = "extent_used";
const RINGS: &str = "rings";
pub(super) const MET: &str = "met";
pub(super) const DRAPED: &str = "draped";

/// The levels of notices by their numbers in the file of a task.
const SEVERITIES: [Severity; 3] = [Severity::Detail, Severity::Note, Severity::Warning];

/// Adds the notices of a task to its facts.
pub(super) fn put_notices(facts: &mut Map<String, Value>, notices: &[Notice]) {
    let of = |notice: &Notice| {
        let level = SEVERITIES.iter().position(|severity| *severity == notice.severity());
        let details: Vec<Value> = notice.details().iter().map(Wording::to_json).collect();
        json!([level, notice.text().to_json(), details])
    };
    if !notices.is_empty() {
        facts.insert(NOTICES.to_owned(), notices.iter().map(of).collect());
    }
}

fn to_notice(value: &Value) -> Option<Notice> {
    Some(Notice::OfTask {
        severity: *SEVERITIES.get(usize::try_from(value[0].as_u64()?).ok()?)?,
        text: Wording::from_json(&value[1])?,
        details: value[2].as_array()?.iter().map(Wording::from_json).collect::<Option<_>>()?,
    })
}

/// Adds to the facts of a task what its points say about the whole. `extent` is that of those that
/// are used.
pub(super) fn put_points(facts: &mut Map<String, Value>, report: &SelectionReport, extent: &Bounds) {
    let classes: Vec<u8> = report.by_class.keys().copied().collect();
    facts.insert(CLASSES.to_owned(), json!(classes));
    facts.insert(WITHOUT_CLASS.to_owned(), json!(report.without_class));
    if !extent.is_empty() {
        facts.insert(EXTENT_USED.to_owned(), json!([extent.min, extent.max]));
    }
}

/// Adds to the facts of a task what its points say about lines that may be shores.
pub(super) fn put_rings(facts: &mut Map<String, Value>, found: &[OtherHeights]) {
    let some = (0..found.len()).filter(|&ring| found[ring].0 > 0);
    let some: Vec<(usize, u64, f64)> = some.map(|ring| (ring, found[ring].0, found[ring].1)).collect();
    if !some.is_empty() {
        facts.insert(RINGS.to_owned(), json!(some));
    }
}

impl Plan {
    /// Reports what is known of the points from what their files state.
    pub(super) fn note(&self, request: &TinRequest, product: &TiledProduct, known: &Known, journal: &Journal) {
        let units = Units::of(self.crs.as_ref());
        let paths: Vec<_> = self.files.iter().map(|file| file.path.as_path()).collect();
        let extents: Vec<Bounds> = self.files.iter().map(|file| file.bounds()).collect();
        extents::compare_files(&paths, &extents, &units, journal);
        journal.add(request.max_edge.notice(&units));
        let unusual = request.max_edge.unusual(mean_distance(self.point_count(), extents), &units);
        unusual.into_iter().for_each(|notice| journal.add(notice));
        if request.bounds.is_some() {
            journal.add(Notice::BoundsBuffer(None));
        }
        if let Some(lines) = &known.lines {
            note_of_lines(lines, &self.stated_extent(), request, &units).into_iter().for_each(|n| journal.add(n));
        }
        if let TiledProduct::Contours(options) = product {
            options.notice(self.crs.as_ref()).into_iter().for_each(|notice| journal.add(notice));
        }
    }
}

/// Returns true if the surface is cut to bounds or a boundary, so that lines beyond it are usual.
fn is_cut(request: &TinRequest) -> bool {
    request.bounds.is_some() || !request.boundary.is_empty()
}

/// Returns the notice about lines that are far from the points, or reach far beyond them.
fn note_of_lines(lines: &JobLines, points: &Bounds, request: &TinRequest, units: &Units) -> Option<Notice> {
    let compare = || extents::compare_lines(points, &lines.extent_of_heights, request.max_edge.buffer(units), units);
    if is_cut(request) { None } else { compare() }
}

/// What the tasks found.
#[derive(Default)]
pub(super) struct Found {
    notices: Vec<Notice>,
    /// The numbers of the files that were skipped, and why.
    skipped: Vec<(usize, String)>,
    /// The numbers of the files without a point that is used.
    unused: Vec<usize>,
    classes: BTreeSet<u8>,
    without_class: u64,
    extent_used: Bounds,
    rings: Vec<(usize, u64, f64)>,
    /// Triangles that holes and other clip lines cut, or leave out.
    met: u64,
    draped: u64,
}

impl Found {
    /// Adds what a task found, which has read the file of points with this number, if any.
    pub(super) fn add(&mut self, task: &TaskFile, file: Option<usize>) {
        let facts = &task.facts;
        let all = |name: &str| facts.get(name).and_then(Value::as_array).into_iter().flatten();
        self.notices.extend(all(NOTICES).filter_map(to_notice));
        self.classes.extend(all(CLASSES).filter_map(|class| u8::try_from(class.as_u64()?).ok()));
        self.without_class += task.count(WITHOUT_CLASS);
        self.met += task.count(MET) + task.count("clipped");
        self.draped += task.count(DRAPED);
        self.rings.extend(all(RINGS).filter_map(|ring| serde_json::from_value::<(usize, u64, f64)>(ring.clone()).ok()));
        for corner in all(EXTENT_USED).filter_map(|corner| serde_json::from_value::<[f64; 3]>(corner.clone()).ok()) {
            self.extent_used.add(corner);
        }
        match (file, facts.get(SKIPPED)) {
            (Some(file), Some(why)) => self.skipped.push((file, why.as_str().unwrap_or_default().to_owned())),
            (Some(file), None) if task.count("used") == 0 => self.unused.push(file),
            _ => {}
        }
    }

    /// Reports what the tasks found, and what follows from all of it.
    ///
    /// # Errors
    /// If the layers of lines cannot be read again.
    pub(super) fn note(self, job: &Job, context: &Context, journal: &Journal) -> Result<()> {
        self.notices.iter().for_each(|notice| journal.add(notice.clone()));
        self.note_skipped(&job.plan, journal);
        self.note_points(job, journal);
        let units = Units::of(job.plan.crs.as_ref());
        let request = job.request;
        if job.plan.has_lines
            && let Some(lines) = &job.known(context)?.lines
        {
            // A notice that came with the plan is not repeated for the points that are used.
            if note_of_lines(lines, &job.plan.stated_extent(), request, &units).is_none() {
                note_of_lines(lines, &self.extent_used, request, &units).into_iter().for_each(|n| journal.add(n));
            }
            let mut found = lines.rings.as_ref().map(|rings| rings.none_found()).unwrap_or_default();
            for (ring, count, largest) in &self.rings {
                if let Some(all) = found.get_mut(*ring) {
                    *all = (all.0 + count, all.1.max(*largest));
                }
            }
            lines.notice_of_rings(&found, &units).into_iter().for_each(|notice| journal.add(notice));
        }
        let apart = [
            (LineRole::Draped, !request.lines.draped.is_empty() && self.draped == 0),
            (LineRole::Holes, !request.lines.holes.is_empty() && self.met == 0),
        ];
        let apart = apart.into_iter().filter(|(_, is_apart)| *is_apart && !is_cut(request));
        apart.for_each(|(role, _)| journal.add(Notice::LinesApart(role)));
        Ok(())
    }

    /// Reports which files are skipped, and the holes that they leave.
    fn note_skipped(&self, plan: &Plan, journal: &Journal) {
        for (_, why) in &plan.skipped {
            journal.add(Notice::Skipped { why: why.clone(), hole: None, others: Vec::new() });
        }
        for (number, why) in &self.skipped {
            let hole = plan.files[*number].bounds();
            let overlaps = |other: &Bounds| (0..2).all(|k| other.min[k] < hole.max[k] && hole.min[k] < other.max[k]);
            let others = plan.files.iter().enumerate().filter(|(at, file)| at != number && overlaps(&file.bounds()));
            let others = others.map(|(_, file)| file.path.clone()).collect();
            journal.add(Notice::Skipped { why: why.clone(), hole: Some(hole), others });
        }
    }

    /// Returns the number of files that are skipped.
    pub(super) fn skipped(&self, plan: &Plan) -> usize {
        plan.skipped.len() + self.skipped.len()
    }

    /// Reports which points are used.
    fn note_points(&self, job: &Job, journal: &Journal) {
        let Job { request, plan, .. } = job;
        let classes = Some(plan.classes.clone()).filter(|classes| classes.len() <= usize::from(u8::MAX));
        let is_known: BTreeSet<usize> =
            plan.files.iter().map(|file| file.input).chain(plan.skipped.iter().map(|(input, _)| *input)).collect();
        let path = |input: usize| request.points[input].path().to_path_buf();
        let empty = || (0..request.points.len()).filter(|input| !is_known.contains(input));
        empty().for_each(|input| journal.add(Notice::PointsRead(path(input), 0)));
        if request.points.len() > 1 {
            let unused = self.unused.iter().map(|&file| plan.files[file].input).chain(empty());
            unused.for_each(|input| journal.add(Notice::NoPointUsed(path(input), classes.clone())));
        }
        match &request.classes {
            Classes::Only(wanted) => {
                let missing = wanted.iter().filter(|class| !self.classes.contains(class));
                missing.for_each(|class| journal.add(Notice::NoPointOfClass(*class)));
            }
            Classes::GroundOrAll if classes.is_some() && self.without_class > 0 => {
                journal.add(Notice::PointsWithoutClassUsed(self.without_class));
            }
            Classes::GroundOrAll => {}
        }
    }
}

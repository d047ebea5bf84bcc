//! What a surface in one piece reports: for a job, from what the plan and the tasks find.

use std::collections::BTreeSet;

use super::Job;
use super::lines::{JobLines, Known};
use super::plan::Plan;
use super::planned_file::PlannedFile;
use super::task_facts::{FileFacts, TaskFacts, TaskNotice};
use crate::data::Bounds;
use crate::error::Result;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal};
use crate::run::lines::notes::OtherHeights;
use crate::run::products::edge_limit::mean_distance;
use crate::run::products::tin::TinRequest;
use crate::run::request::lines::LineRole;
use crate::run::sources::extents;
use crate::run::verbs::{Keeps, Verb};
use crate::terrain::{Classes, LostAtRim};

/// Returns the lines that may be shores and have points of other heights within, as a task keeps
/// them.
pub(super) fn rings_found(found: &[OtherHeights]) -> Vec<(usize, u64, f64)> {
    let some = (0..found.len()).filter(|&ring| found[ring].0 > 0);
    some.map(|ring| (ring, found[ring].0, found[ring].1))
        .collect()
}

impl Plan {
    /// Reports what is known of the points from what their files state.
    pub(super) fn note(
        &self,
        request: &TinRequest,
        verb: &dyn Verb,
        known: &Known,
        journal: &Journal,
    ) {
        let units = Units::of(self.crs.as_ref());
        let paths: Vec<_> = self.files.iter().map(|file| file.path.as_path()).collect();
        let extents: Vec<Bounds> = self.files.iter().map(|file| file.bounds()).collect();
        extents::compare_files(&paths, &extents, &units, journal);
        journal.add(request.max_edge.notice(self.max_edge, &units));
        let unusual = request.max_edge.unusual(self.spacing(), &units);
        unusual.into_iter().for_each(|notice| journal.add(notice));
        if request.bounds.is_some() {
            journal.add(Notice::BoundsBuffer(None));
        }
        if let Some(lines) = &known.lines {
            self.note_of_lines(lines, &self.stated_extent(), request)
                .into_iter()
                .for_each(|n| journal.add(n));
        }
        if let Keeps::Contours(options) = verb.keeps() {
            options
                .notice(self.crs.as_ref())
                .into_iter()
                .for_each(|notice| journal.add(notice));
        }
    }
}

impl Plan {
    /// Returns the mean distance between all points.
    fn spacing(&self) -> Option<f64> {
        mean_distance(self.files.iter().map(PlannedFile::extent))
    }

    /// Returns the notice about lines that are far from points in a box, or reach beyond them.
    fn note_of_lines(
        &self,
        lines: &JobLines,
        points: &Bounds,
        request: &TinRequest,
    ) -> Option<Notice> {
        if is_cut(request) {
            return None;
        }
        let units = Units::of(self.crs.as_ref());
        let limit = request.max_edge;
        let (buffer, usual) = (
            limit.buffer(&units),
            limit.usual_reach(self.spacing(), &units),
        );
        extents::compare_lines(points, &lines.extents, buffer, usual, &units)
    }
}

/// Returns true if the surface is cut to bounds or a boundary, so that lines beyond it are usual.
fn is_cut(request: &TinRequest) -> bool {
    request.bounds.is_some() || !request.boundary.is_empty()
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
    without_return: u64,
    /// The warnings of the transforms of points.
    of_transforms: BTreeSet<String>,
    extent_used: Bounds,
    rings: Vec<(usize, u64, f64)>,
    /// Triangles that holes and other clip lines cut, or leave out.
    met: u64,
    draped: u64,
    lost_at_rim: LostAtRim,
    /// Points that are used and not merged into others.
    sites: u64,
}

impl Found {
    /// Adds what a task found, which has read the file of points with this number, if any.
    pub(super) fn add(&mut self, facts: &TaskFacts, file: Option<usize>) {
        self.notices
            .extend(facts.notices.iter().filter_map(TaskNotice::notice));
        self.met += facts.met + facts.kept.clipped;
        self.lost_at_rim = facts.lost_at_rim.map_or(self.lost_at_rim, LostAtRim::from);
        self.draped += facts.draped;
        if let Some(points) = facts.read() {
            self.sites += points.used.saturating_sub(points.replaced);
            self.classes.extend(&points.classes);
            self.without_class += points.without_class;
            self.without_return += points.without_return;
            self.rings.extend(&points.rings);
            self.of_transforms
                .extend(points.of_transform.iter().cloned());
            points.extent.add_to(&mut self.extent_used);
        }
        self.sites = self.sites.saturating_sub(facts.duplicates);
        match (file, &facts.file) {
            (Some(file), Some(FileFacts::Skipped(why))) => self.skipped.push((file, why.clone())),
            (Some(file), Some(FileFacts::Read(points))) if points.used == 0 => {
                self.unused.push(file)
            }
            _ => {}
        }
    }

    /// Reports what the tasks found, and what follows from all of it.
    ///
    /// # Errors
    /// If the layers of lines cannot be read again.
    pub(super) fn note(self, job: &Job, context: &Context, journal: &Journal) -> Result<()> {
        self.notices
            .iter()
            .for_each(|notice| journal.add(notice.clone()));
        self.note_transforms(job, context, journal)?;
        self.note_skipped(&job.plan, journal);
        self.note_points(job, journal);
        let units = Units::of(job.plan.crs.as_ref());
        let request = &job.request;
        request
            .max_edge
            .note_lost(&self.lost_at_rim, self.sites, journal);
        if job.plan.has_lines
            && let Some(lines) = &job.known(context)?.lines
        {
            // A notice that came with the plan is not repeated for the points that are used.
            let plan = &job.plan;
            if (plan.note_of_lines(lines, &plan.stated_extent(), request)).is_none() {
                plan.note_of_lines(lines, &self.extent_used, request)
                    .into_iter()
                    .for_each(|n| journal.add(n));
            }
            let mut found = lines
                .rings
                .as_ref()
                .map(|rings| rings.none_found())
                .unwrap_or_default();
            for (ring, count, largest) in &self.rings {
                if let Some(all) = found.get_mut(*ring) {
                    *all = (all.0 + count, all.1.max(*largest));
                }
            }
            lines
                .notice_of_rings(&found, &units)
                .into_iter()
                .for_each(|notice| journal.add(notice));
        }
        let apart = [
            (
                LineRole::Draped,
                !request.lines.draped.is_empty() && self.draped == 0,
            ),
            (
                LineRole::Holes,
                !request.lines.holes.is_empty() && self.met == 0,
            ),
        ];
        let apart = apart
            .into_iter()
            .filter(|(_, is_apart)| *is_apart && !is_cut(request));
        apart.for_each(|(role, _)| journal.add(Notice::LinesApart(role)));
        Ok(())
    }

    /// Reports what the transforms of points and of layers have to say, once.
    fn note_transforms(&self, job: &Job, context: &Context, journal: &Journal) -> Result<()> {
        let mut all = self.of_transforms.clone();
        if job.plan.layers_from.iter().any(Option::is_some) {
            all.extend(job.known(context)?.of_transforms.iter().cloned());
        }
        all.into_iter()
            .for_each(|text| journal.add(Notice::Transform(text)));
        Ok(())
    }

    /// Reports which files are skipped, and the holes that they leave.
    fn note_skipped(&self, plan: &Plan, journal: &Journal) {
        for (_, why) in &plan.skipped {
            journal.add(Notice::Skipped {
                why: why.clone(),
                hole: None,
                others: Vec::new(),
            });
        }
        for (number, why) in &self.skipped {
            let hole = plan.files[*number].bounds();
            let overlaps = |other: &Bounds| {
                (0..2).all(|k| other.min[k] < hole.max[k] && hole.min[k] < other.max[k])
            };
            let others = plan
                .files
                .iter()
                .enumerate()
                .filter(|(at, file)| at != number && overlaps(&file.bounds()));
            let others = others.map(|(_, file)| file.path.clone()).collect();
            journal.add(Notice::Skipped {
                why: why.clone(),
                hole: Some(hole),
                others,
            });
        }
    }

    /// Returns the number of files that are skipped.
    pub(super) fn skipped(&self, plan: &Plan) -> usize {
        plan.skipped.len() + self.skipped.len()
    }

    /// Reports which points are used.
    fn note_points(&self, job: &Job, journal: &Journal) {
        let Job { request, plan, .. } = job;
        let classes = match request.classes {
            Classes::AllButNoise => None,
            _ => Some(plan.classes.clone()).filter(|classes| classes.len() <= usize::from(u8::MAX)),
        };
        let is_known: BTreeSet<usize> = plan
            .files
            .iter()
            .map(|file| file.input)
            .chain(plan.skipped.iter().map(|(input, _)| *input))
            .collect();
        let path = |input: usize| request.points[input].path().to_path_buf();
        let empty = || (0..request.points.len()).filter(|input| !is_known.contains(input));
        empty().for_each(|input| journal.add(Notice::PointsRead(path(input), 0)));
        if request.points.len() > 1 {
            let unused = self
                .unused
                .iter()
                .map(|&file| plan.files[file].input)
                .chain(empty());
            unused.for_each(|input| journal.add(Notice::NoPointUsed(path(input), classes.clone())));
        }
        if self.without_return > 0 {
            journal.add(Notice::PointsWithoutReturnUsed(self.without_return));
        }
        match &request.classes {
            Classes::Only(wanted) => {
                let is_missing = |class: &u8| !self.classes.contains(class);
                journal.add_missing_classes(wanted.iter().copied().filter(is_missing), 0);
            }
            Classes::GroundOrAll if classes.is_some() && self.without_class > 0 => {
                journal.add(Notice::PointsWithoutClassUsed(self.without_class));
            }
            Classes::GroundOrAll | Classes::All | Classes::AllButNoise => {}
        }
    }
}

//! Surfaces larger than memory: a job of tasks, each of which reads files and writes one.
//!
//! A job lives in a folder: the plan, and a file for each task that is done. So it can be
//! interrupted at any moment and go on, and its tasks can run anywhere that sees the folder.
//!
//! 1. Unless each file is a tile, and always with lines, files are *divided* among the tiles.
//! 2. If there are *lines*, one task arranges them, with the points next to them.
//! 3. Each *step* triangulates a tile, or merges what tiles hand up, and draws the triangles that
//!    are final; see [`tiles`](crate::terrain::tiles).
//! 4. The *rim* is decided: triangles with edges over the limit, and caps, wait until all others
//!    are known.
//! 5. Triangles that clip lines come near are *cut*, all of them together.
//! 6. The product is composed of the cells that the tasks have drawn, joined from their contours,
//!    or consists of their triangulations.

mod awaited;
mod bytes;
mod command;
mod contours;
mod division;
mod done;
mod folder;
mod fullest;
mod holes;
mod inputs;
mod keys;
mod lease;
mod lines;
mod listed;
mod lock;
mod not_in_tiles;
mod notes;
mod output;
mod paths;
mod pause;
mod plan;
mod plan_json;
mod planned_file;
mod raster;
mod readers;
mod request;
mod sampled;
mod schedule;
mod skipped;
mod stored_job;
mod surface;
mod task_facts;
mod task_file;
mod tasks;
mod tile_options;
mod update;
mod work;
mod written;

use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use serde_json::{Value, json};

pub use self::command::JobCommand;
pub use self::division::Division;
pub use self::folder::remove_job;
pub(crate) use self::folder::require_no_job;
use self::folder::{COMMAND, StoredPlan};
use self::inputs::Inputs;
use self::keys::Keys;
pub use self::lease::{TaskLease, Worker};
use self::lines::Known;
pub use self::listed::JobTask;
pub use self::lock::JobLock;
use self::lock::SharedLock;
pub use self::not_in_tiles::NotInTiles;
use self::not_in_tiles::tiled;
pub use self::output::JobReport;
use self::paths::tasks_in;
use self::plan::Plan;
pub use self::planned_file::FileState;
use self::planned_file::KnownFiles;
use self::readers::Readers;
pub use self::stored_job::{FoundJob, StoredJob};
use self::task_file::TaskName;
pub use self::tile_options::{Look, TileOptions};
pub use self::update::JobUpdate;
pub(crate) use self::work::LastTask;
pub use self::work::WorkOptions;
pub(crate) use self::written::OwnFiles;
use super::verbs::{Keeps, Verb, WriteRequest};
use crate::error::{Command, Error, Kind, Result, Setting, wording};
use crate::run::context::event::JobSize;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal};
use crate::run::products::surface::{Source, SurfaceRequest};
use crate::run::products::tin::{self, TinRequest};
use crate::run::sources::checksum::checksum;
use crate::run::sources::point_files::{BadFiles, PointFiles};
use crate::run::sources::systems::SystemOptions;
use crate::terrain::CellValue;
use crate::terrain::tiles::{TileStep, Work};

/// Bytes per point of a triangulation in its file; measured.
const BYTES_A_POINT_OF_PART: u64 = 85;

/// A task of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Task {
    /// Divides a file among the tiles.
    Divide(usize),
    /// Arranges all lines.
    Lines,
    /// A step of the triangulation.
    Triangulate(usize),
    /// Decides about the triangles at the rim.
    Rim,
    /// Cuts the triangles that clip lines come near.
    Cut,
}

/// A surface in tiles, and what is made of it.
#[derive(Debug)]
pub struct Job {
    request: TinRequest,
    systems: SystemOptions,
    verb: Arc<dyn Verb>,
    bad: BadFiles,
    folder: PathBuf,
    /// What the files of its tasks name it by; 0 until it is there.
    id: u64,
    /// What the record of its outputs names it by; 0 until it is there.
    name: u64,
    /// The checksum of the plan in the folder; 0 until it is there.
    sum: u32,
    plan: Plan,
    steps: Vec<TileStep>,
    readers: Readers,
    keys: Keys,
    /// Read by the first task that needs it, unless the plan was made by this process.
    known: OnceLock<Known>,
    /// For each tile the files that may have points of it, once somebody has asked.
    files_of_tiles: OnceLock<Vec<Vec<usize>>>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

impl Job {
    /// Plans a job that will have a folder. Nothing is written. Of the options, the folder does not
    /// count.
    ///
    /// # Errors
    /// If the request has something that tiles do not have yet, or a file cannot be opened; and
    /// those of building a surface.
    ///
    /// # Complexity
    /// Linear in the files, of which the headers are read; those that state no number or extent are
    /// read to their end.
    pub fn plan(
        wanted: &WriteRequest,
        folder: &Path,
        options: &TileOptions,
        context: &Context,
    ) -> Result<Self> {
        let (request, systems) = tiled(wanted)?;
        let verb = wanted.verb.as_ref();
        let journal = Journal::new(context);
        let known = KnownFiles::default();
        let inputs = Inputs::read(request, systems, verb, options, &known, &journal)?;
        let tiling = inputs.tiled(&journal.context)?;
        let (plan, known) = inputs.planned(tiling, &journal);
        let known = OnceLock::from(known);
        Ok(Job {
            known,
            notices: journal.take(),
            ..Self::of_plan(wanted, (request, systems), folder, options, plan)
        })
    }

    fn of_plan(
        wanted: &WriteRequest,
        (request, systems): (&TinRequest, &SystemOptions),
        folder: &Path,
        options: &TileOptions,
        plan: Plan,
    ) -> Self {
        let steps = plan.layout.steps();
        Job {
            request: request.clone(),
            systems: systems.clone(),
            verb: Arc::clone(&wanted.verb),
            bad: if plan.skips_bad {
                BadFiles::Skip
            } else {
                options.bad
            },
            folder: folder.to_path_buf(),
            id: 0,
            name: 0,
            sum: 0,
            steps,
            readers: Readers::of(&plan),
            keys: Keys::of(&plan),
            plan,
            known: OnceLock::new(),
            files_of_tiles: OnceLock::new(),
            notices: Vec::new(),
        }
    }

    /// Returns the request that the job is for.
    pub fn request(&self) -> WriteRequest {
        let source = Source::Points(Box::new(self.request.clone()));
        let surface = SurfaceRequest {
            source,
            systems: self.systems.clone(),
        };
        WriteRequest {
            surface,
            verb: Arc::clone(&self.verb),
        }
    }

    /// Returns what is kept with the job for others, if that is.
    pub(super) fn command(&self) -> Result<Option<JobCommand>> {
        JobCommand::read(&self.folder, &StoredPlan::read_of(self.sum, &self.folder)?)
    }

    /// Returns the folder of the job.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Creates the folder of the job, with the plan; `command` is kept with it, so that others can
    /// do tasks of the job. The whole job is taken for this process, as long as the result lives.
    ///
    /// # Errors
    /// If the folder has a job already, or files of something else that have the same names, or
    /// cannot be written; or if another process works on it.
    pub fn create(&mut self, command: Option<&JobCommand>, context: &Context) -> Result<JobLock> {
        let command = command
            .map(|command| command.to_text(&self.plan.request))
            .transpose()?;
        folder::require_no_job(&self.folder)?;
        let named = |e: std::io::Error| Error::from(e).in_file(&self.folder);
        std::fs::create_dir_all(&self.folder).map_err(named)?;
        let lock = JobLock::whole(&self.folder, self.task_count(), context)?;
        // Another process may have created one meanwhile.
        folder::require_no_job(&self.folder)?;
        std::fs::create_dir_all(tasks_in(&self.folder)).map_err(named)?;
        if let Some(command) = &command {
            std::fs::write(self.folder.join(COMMAND), command).map_err(named)?;
        }
        // Last, because a folder is a job from here on.
        self.id = new_id();
        self.name = self.id;
        let command = command.map(|command| checksum(command.as_bytes()).into());
        let plan = self.stored_plan(0, command);
        self.sum = folder::write_plan(&self.folder, &plan.to_string())?;
        Ok(lock)
    }

    /// Returns the plan as it is stored. The files of earlier plans have numbers below `numbers`,
    /// and `command` is the checksum of what is kept with the job.
    fn stored_plan(&self, numbers: u64, command: Option<u64>) -> Value {
        let tasks = self.task_count() as u64;
        let mut plan = self.plan.to_json();
        plan["tasks"] = json!(tasks);
        // While an update renames files, they have numbers beyond the last.
        plan["numbers"] = json!(numbers.max(2 * tasks));
        plan["command"] = json!(command);
        plan["id"] = json!(self.id);
        plan["name"] = json!(self.name);
        plan
    }

    /// Checks that the file of points that a task reads, if any, is as the task has read it or as
    /// the plan expects it.
    fn check_input(&self, task: usize) -> Result<()> {
        let Some(number) = self.file_of(task) else {
            return Ok(());
        };
        let path = &self.plan.files[number].path;
        match self.state_of_input(task) {
            None => match self
                .plan
                .require_same_points(number, &self.request, &self.folder)
            {
                Err(error) if self.bad.skips(&error) => Ok(()),
                // It is tried again, and the job may be planned again.
                Err(_) if self.skips(task) => Ok(()),
                other => other,
            },
            Some(state) if path.exists() => planned_file::require_state(path, state, &self.folder),
            // What a task has read is not needed any more.
            Some(_) => Ok(()),
        }
    }

    /// Opens the job of a request in its folder; `None` if there is none. No input is looked at.
    /// The names in the request may be relative, although those that the job was planned with are
    /// whole.
    ///
    /// # Errors
    /// If the job is that of another request, or damaged.
    pub fn stored(
        wanted: &WriteRequest,
        folder: &Path,
        options: &TileOptions,
    ) -> Result<Option<Self>> {
        let Some(stored) = StoredPlan::read(folder)? else {
            return Ok(None);
        };
        match Self::of_stored(&stored, wanted, folder, options) {
            Err(error) if error.kind() == Kind::OtherJob => {
                let whole = command::whole(wanted);
                let opened =
                    whole.and_then(|whole| Self::of_stored(&stored, &whole, folder, options));
                opened.map_err(|_| error).map(Some)
            }
            opened => opened.map(Some),
        }
    }

    fn of_stored(
        stored: &StoredPlan,
        wanted: &WriteRequest,
        folder: &Path,
        options: &TileOptions,
    ) -> Result<Self> {
        let (request, systems) = tiled(wanted)?;
        let plan = Plan::from_json(&stored.plan).ok_or_else(|| other_version(folder))?;
        let asked = request::asked(wanted, options)?;
        if plan.request != asked {
            return Err(request::other_command(&plan.request, &asked, folder));
        }
        let plan = plan
            .named(request, wanted.verb.as_ref())
            .ok_or_else(|| other_version(folder))?;
        Ok(Job {
            id: stored.id,
            name: stored.name,
            sum: stored.sum,
            ..Self::of_plan(wanted, (request, systems), folder, options, plan)
        })
    }

    /// Checks all inputs, before what is left is done.
    ///
    /// A file that has changed since the job was planned is accepted if no task has read it, and if
    /// its header states as many points and the same extent as before: it was damaged, and was
    /// replaced. A file that a task has read may be missing.
    ///
    /// # Errors
    /// If a file has changed otherwise, or the run is canceled.
    pub(super) fn check_inputs(&self, context: &Context) -> Result<()> {
        self.check_inputs_of(0..self.task_count(), context)
    }

    /// Checks that what some tasks read is as it was when the job was planned: of the files of
    /// points, only those that they read are looked at.
    ///
    /// # Errors
    /// If a file has changed, if there is no task with one of these numbers, or if the run is
    /// canceled.
    pub fn check_inputs_of(
        &self,
        tasks: impl IntoIterator<Item = usize>,
        context: &Context,
    ) -> Result<()> {
        for task in tasks {
            context.check()?;
            if task > self.task_count() {
                return Err(self.no_task(task));
            }
            self.check_input(task)?;
        }
        self.plan.require_others_unchanged(&self.folder)
    }

    /// Returns the file of points that a task reads, if it reads one.
    pub(super) fn input(&self, task: usize) -> Option<&Path> {
        self.file_of(task)
            .map(|number| self.plan.files[number].path.as_path())
    }

    /// The number of the file of points that a task reads.
    fn file_of(&self, task: usize) -> Option<usize> {
        match self.task(task) {
            Task::Divide(file) => Some(file),
            Task::Triangulate(step) => match self.steps[step].work {
                Work::Leaf(tile) => self.readers.whole(tile),
                Work::Merge(_) => None,
            },
            Task::Lines | Task::Rim | Task::Cut => None,
        }
    }

    /// Returns the numbers of the plan.
    pub fn size(&self) -> JobSize {
        let plan = &self.plan;
        // Blocks at borders are written by each tile that they meet: twice the cells, as measured.
        let cells_of = |bytes: usize| plan.cells().saturating_mul(2 * bytes as u64);
        let points = plan.point_count();
        let drawn = match self.verb.keeps() {
            Keeps::Triangles => points.saturating_mul(BYTES_A_POINT_OF_PART),
            Keeps::Gradients(_) => cells_of(<[f64; 2]>::BYTES),
            Keeps::Heights(_) | Keeps::Contours(_) => cells_of(f32::BYTES),
        };
        JobSize {
            files: plan.files.len(),
            points,
            tiles: plan.layout.tile_count(),
            divides: plan.divides(),
            merges: plan.merge_count(),
            tasks: self.task_count(),
            bytes_on_disk: drawn.saturating_add(plan.divided_points().saturating_mul(24)),
            task_memory: plan.task_memory,
        }
    }

    /// Returns how many bytes the files of the tasks have that are there.
    pub fn bytes_there(&self) -> u64 {
        let length = |task| {
            let path = paths::task_path(&self.folder, task);
            std::fs::metadata(path).map_or(0, |about| about.len())
        };
        (0..self.task_count()).map(length).sum()
    }

    /// Returns the number of tasks.
    pub fn task_count(&self) -> usize {
        self.after_steps()
            + usize::from(self.plan.max_edge.is_some())
            + usize::from(self.plan.has_clip)
    }

    /// The number of the task after the last step.
    fn after_steps(&self) -> usize {
        self.first_step() + self.steps.len()
    }

    /// The task that decides about the rim, if there is a longest edge.
    fn rim_task(&self) -> Option<usize> {
        self.plan.max_edge.map(|_| self.after_steps())
    }

    /// The number of the task of the first step.
    fn first_step(&self) -> usize {
        self.divided() + usize::from(self.plan.has_lines)
    }

    /// The number of files that are divided.
    fn divided(&self) -> usize {
        self.readers.divided.len()
    }

    fn task(&self, number: usize) -> Task {
        match number.checked_sub(self.first_step()) {
            None => match self.readers.divided.get(number) {
                Some(&file) => Task::Divide(file),
                None => Task::Lines,
            },
            Some(step) if step < self.steps.len() => Task::Triangulate(step),
            Some(_) if Some(number) == self.rim_task() => Task::Rim,
            Some(_) => Task::Cut,
        }
    }

    fn task_of_step(&self, step: usize) -> usize {
        self.first_step() + step
    }

    /// The task that arranges the lines, if there are any.
    fn lines_task(&self) -> Option<usize> {
        self.plan.has_lines.then_some(self.divided())
    }

    /// Returns what all tasks have to know; two that ask at once may both read it.
    fn known(&self, context: &Context) -> Result<&Known> {
        if let Some(known) = self.known.get() {
            return Ok(known);
        }
        // What there is to say about the layers was said with the plan.
        let systems = (self.plan.layers_from.as_slice(), self.plan.target_system());
        let extent = self.plan.extent();
        let known = Known::read(
            &self.request,
            systems,
            &extent,
            &Journal::new(&context.quiet()),
        )?;
        // They may have changed since they were compared with the plan.
        self.plan.require_others_unchanged(&self.folder)?;
        Ok(self.known.get_or_init(|| known))
    }

    /// Returns the tasks that must be done before a task.
    pub(super) fn needs(&self, task: usize) -> Vec<usize> {
        match self.task(task) {
            Task::Divide(_) => Vec::new(),
            Task::Lines => (0..self.divided()).collect(),
            Task::Triangulate(step) => match &self.steps[step].work {
                Work::Leaf(tile) => {
                    let files = self.files_of(*tile).iter();
                    let divided = files.filter_map(|&file| self.readers.task_of(file));
                    divided.chain(self.lines_task()).collect()
                }
                Work::Merge(parts) => parts.iter().map(|&part| self.task_of_step(part)).collect(),
            },
            Task::Rim => (self.first_step()..self.after_steps()).collect(),
            Task::Cut => (self.first_step()..task).collect(),
        }
    }

    /// Returns the stage of each task, from 0: a task needs only those of earlier stages, so that
    /// all of one stage can be done at the same time.
    pub(super) fn stages(&self) -> Vec<usize> {
        let mut stages: Vec<usize> = Vec::with_capacity(self.task_count());
        for task in 0..self.task_count() {
            let before = self
                .needs(task)
                .into_iter()
                .map(|needed| stages[needed] + 1)
                .max();
            stages.push(before.unwrap_or(0));
        }
        stages
    }

    /// Returns the tasks that must be done before the output is written.
    pub(super) fn last_needs(&self) -> Vec<usize> {
        (self.first_step()..self.task_count()).collect()
    }

    /// Returns the files that may have points of a tile, in ascending order.
    fn files_of(&self, tile: u32) -> &[usize] {
        let all = self
            .files_of_tiles
            .get_or_init(|| Readers::files_of_tiles(&self.plan));
        &all[tile as usize]
    }

    /// Returns what a task does, such as "tile 17".
    pub fn task_name(&self, task: usize) -> String {
        match self.task(task) {
            Task::Divide(file) => format!("divide {}", self.plan.files[file].path.display()),
            Task::Lines => "lines".to_owned(),
            Task::Triangulate(step) => match &self.steps[step].work {
                Work::Leaf(tile) => match self.readers.whole(*tile) {
                    Some(file) => {
                        format!("tile {tile}, {}", self.plan.files[file].path.display())
                    }
                    None => format!("tile {tile}"),
                },
                Work::Merge(parts) => format!("merge of {}", parts.len()),
            },
            Task::Rim => "rim".to_owned(),
            Task::Cut => "cut".to_owned(),
        }
    }

    /// Returns the key of a task.
    fn key(&self, task: usize) -> String {
        let Job {
            keys, plan, steps, ..
        } = self;
        let key = match self.task(task) {
            Task::Divide(file) => keys.of_division(&plan.files[file]),
            Task::Lines => keys.of_lines(plan),
            Task::Triangulate(step) => {
                let TileStep { tile: covers, work } = &steps[step];
                match work {
                    Work::Leaf(tile) => {
                        let files = self.files_of(*tile).iter();
                        keys.of_leaf(*tile, covers, files.map(|&number| &plan.files[number]))
                    }
                    Work::Merge(parts) => keys.of_merge(covers, parts.len()),
                }
            }
            Task::Rim => keys.of_last("rim"),
            Task::Cut => keys.of_last("cut"),
        };
        key.to_string()
    }

    /// Returns what the file of a task is called.
    fn task_file(&self, task: usize) -> TaskName {
        TaskName {
            path: paths::task_path(&self.folder, task),
            job: self.id,
            task: self.key(task),
        }
    }

    /// Takes the whole job for this process, as long as the result lives. A task that still runs is
    /// waited for, for some seconds.
    ///
    /// # Errors
    /// If another process works on it, or has removed it, or put another job in its place; or if
    /// the run is canceled.
    pub fn lock(&self, context: &Context) -> Result<JobLock> {
        let lock = self.require_there(JobLock::whole(&self.folder, self.task_count(), context))?;
        self.note_expired(self.task_count(), lock.lease(), context);
        Ok(lock)
    }

    /// Takes part in the job, together with other processes that do single tasks.
    fn lock_shared(&self, context: &Context) -> Result<SharedLock> {
        self.require_there(SharedLock::wait(&self.folder, self.task_count(), context))
    }

    /// Returns what became of a lock, unless the folder has not this job any more: what was read of
    /// it before may be that of another one, whose end was waited for.
    fn require_there<T>(&self, taken: Result<T>) -> Result<T> {
        StoredPlan::read_of(self.sum, &self.folder)?;
        taken
    }

    /// Removes the folder of the job, which must be [locked](Self::lock).
    ///
    /// # Errors
    /// If it cannot be removed.
    pub fn remove(&self, lock: &JobLock) -> Result<()> {
        match StoredPlan::read(&self.folder)? {
            Some(stored) => folder::remove_files(&self.folder, &stored, lock),
            None => Ok(()),
        }
    }
}

/// Returns a number by which no other job is named: jobs whose plans are equal are not taken for
/// one another.
fn new_id() -> u64 {
    RandomState::new().hash_one(std::process::id())
}

#[cold]
fn other_version(folder: &Path) -> Error {
    Error::format("the job was planned by another version of this program")
        .in_file(folder)
        .cure(wording![
            "remove it (",
            Command::JobClean.on(folder.display().to_string()),
            "), or name another folder (",
            Setting::Job,
            ")"
        ])
}

/// Returns true if a request would need more memory than there is. With bounds, what is far from
/// them does not count, because it is not read in one piece.
///
/// # Errors
/// If it cannot be done in tiles, or a file cannot be opened.
pub fn needs_tiles(wanted: &WriteRequest, memory: Option<u64>, context: &Context) -> Result<bool> {
    let (points, _) = tiled(wanted)?;
    plan::require_tiled(points)?;
    let memory = memory.unwrap_or_else(crate::run::context::memory::half_of_free);
    // Opening a layer reads it. A point takes a byte at least, so the lengths nearly always
    // suffice.
    let bytes: u64 = points
        .points
        .iter()
        .map(|input| planned_file::length_of(input.path()))
        .sum();
    if crate::run::context::memory::need_of(bytes) <= memory {
        return Ok(false);
    }
    let count = points_used(wanted, context)?;
    Ok(crate::run::context::memory::need_of(count) > memory)
}

/// Returns about how many points a request uses, as far as headers say. With bounds, what is far
/// from them does not count.
///
/// # Errors
/// If it is not of points, or a file cannot be opened.
pub(super) fn points_used(wanted: &WriteRequest, context: &Context) -> Result<u64> {
    let (points, systems) = tiled(wanted)?;
    let files = PointFiles::open(&points.points, points.read, &Journal::new(&context.quiet()))?;
    // Where reprojected files are is not known from headers alone.
    let by_file = vec![systems.target.as_ref().map(|_| 0); points.points.len()];
    let mut extents = files.extents(&by_file);
    for (extent, input) in extents.iter_mut().zip(&points.points) {
        let of_text = || planned_file::points_of_text(input.path());
        extent.points = Some(extent.points.unwrap_or_else(of_text));
    }
    Ok(tin::used_at_first(points, wanted.verb.method(), &extents))
}

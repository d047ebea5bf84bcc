//! A job whose inputs have changed: it is planned again for what they are now, and of its tasks
//! only those are done again that the changes reach.
//!
//! The tiles stay, because products do not depend on them: a file that came new is divided among
//! them, unless it is alone in one. So nearly all tasks have the keys that they had, and find their
//! files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::folder::{self, COMMAND, NEXT_COMMAND, StoredPlan};
use super::fullest::fullest;
use super::inputs::{Inputs, Tiling, most_points};
use super::lock::JobLock;
use super::paths::{task_of, task_path, tasks_in};
use super::plan::Plan;
use super::planned_file::{KnownFiles, PlannedFile};
use super::task_file::{TaskFile, TaskName, name_in};
use super::tile_options::TileOptions;
use super::{Job, JobCommand, command, new_id, other_version, request, tiled};
use crate::data::Frame;
use crate::error::{Error, Result};
use crate::run::context::{Context, Journal};
use crate::run::sources::checksum::checksum;
use crate::run::sources::point_files::BadFiles;
use crate::run::verbs::WriteRequest;
use crate::terrain::Canvas;
use crate::terrain::tiles::Spread;

/// Tiles are chosen again once one of them has more points than this times the most that any had
/// when they were chosen, and than this times the most that a tile may have.
const GROWTH: u64 = 2;

/// A job that was planned again, because its inputs may have changed. It is not in its folder yet.
#[derive(Debug)]
pub struct JobUpdate {
    job: Job,
    before: StoredPlan,
    /// What is kept with the job for others, if that changes with the inputs.
    command: Option<String>,
    /// True if the tiles are those of before, and so most tasks may be.
    keeps_tiles: bool,
}

impl Job {
    /// Plans the job in a folder again, for the inputs that a request has now; `None` if there is
    /// no job. Its other options must be those of the job. Nothing is written.
    ///
    /// # Errors
    /// If the job is that of another request, or damaged; and those of [`plan`](Self::plan).
    pub fn updated(
        wanted: &WriteRequest,
        folder: &Path,
        options: &TileOptions,
        context: &Context,
    ) -> Result<Option<JobUpdate>> {
        let Some(stored) = StoredPlan::read(folder)? else {
            return Ok(None);
        };
        let old = Plan::from_json(&stored.plan).ok_or_else(|| other_version(folder))?;
        // Names may be relative, although those that the job was planned with are whole.
        let asked = match stored.command {
            Some(_) => command::whole(wanted)?,
            None => wanted.clone(),
        };
        require_same_options(&asked, &old, folder, options)?;
        let (points, systems) = tiled(&asked)?;
        let options = TileOptions {
            bad: match old.skips_bad {
                true => BadFiles::Skip,
                false => options.bad,
            },
            ..options.clone()
        };
        let journal = Journal::new(context);
        let known = KnownFiles::of(&old.files, &old.classes);
        let verb = asked.verb.as_ref();
        let inputs = Inputs::read(points, systems, verb, &options, &known, &journal)?;
        let kept = inputs.tiled_like(&old);
        let keeps_tiles = kept.is_some();
        let tiling = kept.map_or_else(|| inputs.tiled(&journal.context), Ok)?;
        let (plan, known) = inputs.planned(tiling, &journal);
        let command = match JobCommand::read(folder, &stored)? {
            Some(command) if old.request != plan.request => {
                let request = asked.clone();
                Some(JobCommand { request, ..command }.to_text(&plan.request)?)
            }
            _ => None,
        };
        let job = Job {
            name: stored.name,
            id: if keeps_tiles { stored.id } else { new_id() },
            known: known.into(),
            notices: journal.take(),
            ..Job::of_plan(&asked, (points, systems), folder, &options, plan)
        };
        Ok(Some(JobUpdate {
            job,
            before: stored,
            command,
            keeps_tiles,
        }))
    }

    /// Gives the files of tasks the names that they have in this plan, and removes those of tasks
    /// that are not in it. `before` is the plan before.
    ///
    /// An error or an interruption loses nothing: every file has the key of its task, and those on
    /// their way have numbers beyond the last.
    fn rename_files(&self, before: &StoredPlan) -> Result<()> {
        let tasks = tasks_in(&self.folder);
        let named = |e: std::io::Error| Error::from(e).in_file(&tasks);
        let mut free: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
        for task in 0..self.task_count() {
            free.entry(self.key(task)).or_default().insert(task);
        }
        let mut elsewhere = Vec::new();
        for (number, path) in task_files(&tasks).map_err(named)? {
            match name_in(&path) {
                Some((job, key)) if job == self.id => {
                    let is_there = free.get_mut(&key).is_some_and(|free| free.remove(&number));
                    if !is_there {
                        elsewhere.push((number, path, key));
                    } else if !self.has_read_planned(number, &path) {
                        std::fs::remove_file(&path).map_err(named)?;
                    }
                }
                Some((job, _)) if job == before.id => {
                    std::fs::remove_file(&path).map_err(named)?;
                }
                // Damaged, or somebody else's.
                _ => {}
            }
        }
        let mut moved = Vec::new();
        for (number, path, key) in elsewhere {
            match free.get_mut(&key).and_then(BTreeSet::pop_first) {
                Some(now) if self.has_read_planned(now, &path) => moved.push((number, path, now)),
                _ => std::fs::remove_file(&path).map_err(named)?,
            }
        }
        let beyond = self.task_count().max(before.tasks as usize);
        let mut next = beyond;
        for (number, path, _) in &mut moved {
            // The others have been there since an update was interrupted.
            if *number < beyond {
                while task_path(&self.folder, next).exists() {
                    next += 1;
                }
                let aside = task_path(&self.folder, next);
                std::fs::rename(&path, &aside).map_err(named)?;
                *path = aside;
            }
        }
        moved.into_iter().try_for_each(|(_, path, now)| {
            std::fs::rename(path, task_path(&self.folder, now)).map_err(named)
        })
    }
}

/// Returns the files of tasks in a folder, with their numbers, in ascending order.
fn task_files(tasks: &Path) -> std::io::Result<Vec<(usize, PathBuf)>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(tasks)? {
        let path = entry?.path();
        found.extend(task_of(&path).map(|number| (number, path)));
    }
    found.sort_unstable();
    Ok(found)
}

impl Job {
    /// Returns true unless the task of a file has read another file of points than the one that is
    /// planned now: one that was there in between, and was accepted for the same extent.
    fn has_read_planned(&self, task: usize, path: &Path) -> bool {
        let name = TaskName {
            path: path.to_path_buf(),
            ..self.task_file(task)
        };
        let file = TaskFile::open(&name).ok().flatten();
        let read = file.and_then(|file| file.state_of_input());
        let planned = self
            .file_of(task)
            .map(|number| self.plan.files[number].state);
        read.is_none() || read == planned
    }
}

impl JobUpdate {
    /// Returns the job as it will be.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Returns true if the tiles are those of before. If not, all tasks are done again: the files
    /// are no longer like those that the tiles were chosen for.
    pub fn keeps_tiles(&self) -> bool {
        self.keeps_tiles
    }

    /// Puts the job into its folder, in the place of the one before, and takes it whole.
    ///
    /// # Errors
    /// If another process works on the job, or has removed or replaced it; if the folder cannot be
    /// written, or the run is canceled.
    pub fn put(self, context: &Context) -> Result<(Job, JobLock)> {
        let JobUpdate {
            mut job,
            before,
            command,
            ..
        } = self;
        let last = before.tasks as usize;
        let lock = JobLock::whole(&job.folder, last, context)?;
        StoredPlan::read_of(before.sum, &job.folder)?;
        // The output is the last task, so its lease is renamed if the number of tasks changes. The
        // new one has to be there before others see the new plan.
        let next_lease = match job.task_count() {
            count if count == last => None,
            count => Some(lock.take_next(count, &job.folder)?),
        };
        // Whichever plan is there finds the command that goes with it.
        let next = job.folder.join(NEXT_COMMAND);
        let mut sum_of_command = before.command;
        if let Some(command) = &command {
            folder::replace(&next, command)?;
            sum_of_command = Some(checksum(command.as_bytes()).into());
        }
        let plan = job.stored_plan(before.numbers, sum_of_command);
        let unchanged = |name: &str| plan[name] == before.plan[name];
        let is_same = plan
            .as_object()
            .is_some_and(|plan| plan.keys().all(|name| unchanged(name)));
        lock.confirm()?;
        job.sum = match is_same {
            true => before.sum,
            false => folder::replace_plan(&job.folder, &plan.to_string())?,
        };
        if command.is_some() {
            let named = |e: std::io::Error| Error::from(e).in_file(&next);
            std::fs::rename(&next, job.folder.join(COMMAND)).map_err(named)?;
        }
        job.rename_files(&before)?;
        let lock = match next_lease {
            Some(lease) => lock.moved_to(lease),
            None => lock,
        };
        Ok((job, lock))
    }
}

/// Returns an error if options of a request other than its inputs are not those of a plan.
fn require_same_options(
    wanted: &WriteRequest,
    old: &Plan,
    folder: &Path,
    options: &TileOptions,
) -> Result<()> {
    let mut asked = request::asked(wanted, options)?;
    let mut planned = old.request.clone();
    [&mut asked, &mut planned]
        .into_iter()
        .for_each(request::leave_out_inputs);
    if asked == planned {
        Ok(())
    } else {
        Err(request::other_command(&planned, &asked, folder))
    }
}

impl Inputs<'_> {
    /// Returns the tiles of an earlier plan for these inputs; `None` if they do not fit.
    fn tiled_like(&self, old: &Plan) -> Option<Tiling> {
        let is_same = self.crs == old.crs
            && self.classes == old.classes
            && self.max_edge == old.max_edge
            && self.known.lines.is_some() == old.has_lines
            && self.known.clip.is_some() == old.has_clip;
        if !is_same {
            return None;
        }
        let most = most_points(old.task_memory);
        let tiles = tiles_of(&self.files, old, most);
        let now = fullest(&old.layout, &self.files, &tiles);
        // Compared with when the tiles were chosen: else they could double with each update.
        if now > GROWTH.saturating_mul(old.fullest.max(most)) {
            return None;
        }
        let (frame, blocks_before) = match (self.frame, old.frame) {
            (Some(now), Some(drawn)) => {
                let (frame, before) = enlarged(&drawn, old.blocks_before, &now)?;
                (Some(frame), before)
            }
            (None, None) => (None, old.blocks_before),
            _ => return None,
        };
        Some(Tiling {
            layout: old.layout.clone(),
            tiles,
            frame,
            blocks_before,
            task_memory: old.task_memory,
            fullest: old.fullest,
        })
    }
}

/// Returns for each file the tile that it is, `None` if it is divided: in a plan whose files were
/// tiles, a file is one that is alone in a tile, and not too large.
fn tiles_of(files: &[PlannedFile], old: &Plan, most: u64) -> Vec<Option<u32>> {
    let mut tiles = vec![None; files.len()];
    let were: BTreeMap<u32, u32> = old
        .files
        .iter()
        .filter_map(|file| Some((file.name, file.tile?)))
        .collect();
    if were.is_empty() {
        return tiles;
    }
    let within = |file: &PlannedFile| {
        let Spread { min, max, .. } = file.spread();
        let mut met = Vec::new();
        old.layout.tiles_in(min, max, &mut |tile| met.push(tile));
        match met[..] {
            [tile] if file.count <= most => Some(tile),
            _ => None,
        }
    };
    let mut is_taken = vec![false; old.layout.tile_count()];
    // Those that were tiles come first.
    let is_as_before = |file: &PlannedFile, tile: u32| were.get(&file.name) == Some(&tile);
    for comes_first in [true, false] {
        for (number, file) in files.iter().enumerate() {
            if let Some(tile) = within(file)
                && tiles[number].is_none()
                && !is_taken[tile as usize]
                && (is_as_before(file, tile) || !comes_first)
            {
                is_taken[tile as usize] = true;
                tiles[number] = Some(tile);
            }
        }
    }
    tiles
}

/// Returns the frame that was drawn in, enlarged by whole blocks so that it covers another one, and
/// by how many on the left and above since the job began; `None` if they do not have the same grid
/// lines.
fn enlarged(drawn: &Frame, before: [u64; 2], now: &Frame) -> Option<(Frame, [u64; 2])> {
    let [column, row] = drawn
        .inverse()
        .apply(now.transform[0], now.transform[3])
        .map(|at| at.round() as i64);
    let from = [column, row];
    let to = [column + now.width as i64, row + now.height as i64];
    let is_same = drawn == now;
    if !is_same && drawn.on_its_lines(from, to).as_ref() != Some(now) {
        return None;
    }
    let side = Canvas::SIDE as u64;
    let size = [drawn.width as i64, drawn.height as i64];
    let blocks = |cells: i64| u64::try_from(cells).unwrap_or(0).div_ceil(side);
    let added = [0, 1].map(|k| [blocks(-from[k]), blocks(to[k] - size[k])]);
    if added == [[0; 2]; 2] {
        return Some((*drawn, before));
    }
    let cells = |blocks: u64| (blocks * side) as i64;
    let frame = drawn.on_its_lines(
        [0, 1].map(|k: usize| -cells(added[k][0])),
        [0, 1].map(|k: usize| size[k] + cells(added[k][1])),
    )?;
    Some((frame, [0, 1].map(|k: usize| before[k] + added[k][0])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_grow_by_whole_blocks_and_keep_their_cells() {
        let frame = |left: f64, top: f64, width: usize, height: usize| Frame {
            width,
            height,
            transform: [left, 0.5, 0.0, top, 0.0, -0.5],
        };
        let drawn = frame(100.0, 900.0, 128, 64);
        let grown = |now: &Frame| enlarged(&drawn, [3, 0], now);
        assert_eq!(grown(&frame(101.5, 899.0, 120, 62)), Some((drawn, [3, 0])));
        let larger = frame(68.0, 932.0, 192, 128);
        assert_eq!(grown(&frame(99.5, 900.5, 10, 10)), Some((larger, [4, 1])));
        let to_the_right = frame(100.0, 900.0, 192, 128);
        assert_eq!(
            grown(&frame(150.0, 899.0, 32, 64)),
            Some((to_the_right, [3, 0]))
        );
        assert_eq!(grown(&frame(100.25, 900.0, 10, 10)), None);
        let coarser = Frame {
            transform: [100.0, 1.0, 0.0, 900.0, 0.0, -1.0],
            ..drawn
        };
        assert_eq!(grown(&coarser), None);
    }
}

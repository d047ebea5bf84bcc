//! The keys of tasks, which identify them in a job whose inputs may change: a key says what a task
//! is made from, apart from the files of other tasks.
//!
//! A task with the same key, made from files of the same contents, writes the same file: also in a
//! later plan of the job, where it may have another number. The options of the request are in no
//! key: those of a job do not change.

use serde_json::{Value, json};

use super::plan::{Plan, extent_of};
use super::planned_file::PlannedFile;
use crate::run::sources::checksum::checksum;
use crate::terrain::tiles::Tile;

/// The keys of the tasks of a plan.
#[derive(Debug)]
pub(super) struct Keys {
    /// A checksum of the states of all files but those of points, if there are lines: points are
    /// divided with regard to them.
    lines: Option<u32>,
    /// A checksum of the same and of the extent of all points, if the surface is cut: the distance
    /// at which a triangle counts as near a clip line depends on that extent.
    clip: Option<u32>,
}

impl Keys {
    pub(super) fn of(plan: &Plan) -> Self {
        let others = json!([plan.others, plan.layers_from]);
        let sum = |key: &Value| checksum(key.to_string().as_bytes());
        let with_extent = || sum(&json!([others, corners(&plan.files)]));
        Keys {
            lines: plan.has_lines.then(|| sum(&others)),
            clip: plan.has_clip.then(with_extent),
        }
    }

    /// Returns the key of the task that divides a file.
    pub(super) fn of_division(&self, file: &PlannedFile) -> Value {
        json!(["divide", of_file(file), self.lines])
    }

    /// Returns the key of the task that arranges the lines.
    pub(super) fn of_lines(&self, plan: &Plan) -> Value {
        json!(["lines", self.lines, corners(&plan.files)])
    }

    /// Returns the key of a tile that has points of some files; one of them may be the tile. The
    /// key has them in their order, which decides between points at one site.
    pub(super) fn of_leaf<'f>(
        &self,
        tile: u32,
        covers: &Tile,
        files: impl Iterator<Item = &'f PlannedFile>,
    ) -> Value {
        let files: Vec<Value> = files
            .map(|file| match file.tile {
                Some(_) => of_file(file),
                // If the file is skipped, its extent is a hole.
                None => corners(std::slice::from_ref(file)),
            })
            .collect();
        json!(["tile", tile, rectangle(covers), files, self.clip])
    }

    /// Returns the key of a merge of so many parts.
    pub(super) fn of_merge(&self, covers: &Tile, parts: usize) -> Value {
        json!(["merge", rectangle(covers), parts, self.clip])
    }

    /// Returns the key of a task that reads those of all steps.
    pub(super) fn of_last(&self, name: &str) -> Value {
        json!([name, self.clip])
    }
}

/// A file, as it is read.
fn of_file(file: &PlannedFile) -> Value {
    let PlannedFile {
        name,
        state,
        count,
        from,
        ..
    } = file;
    json!([
        name,
        state,
        count,
        from,
        corners(std::slice::from_ref(file))
    ])
}

/// The box in plan around some files, as they state it.
fn corners(files: &[PlannedFile]) -> Value {
    let bounds = extent_of(files);
    json!([&bounds.min[..2], &bounds.max[..2]])
}

/// The corners of a tile; coordinates that are infinite become `null`.
fn rectangle(tile: &Tile) -> Value {
    json!([tile.min, tile.max])
}

//! Which tasks read which files of points.

use super::plan::Plan;
use super::planned_file::PlannedFile;
use crate::terrain::tiles::Spread;

/// Which tasks read which files of points: the first tasks divide files among tiles; other files
/// are tiles.
#[derive(Debug)]
pub(super) struct Readers {
    /// The files that are divided; the task of each has its position here as its number.
    pub(super) divided: Vec<usize>,
    /// For each file the task that divides it.
    tasks: Vec<Option<usize>>,
    /// For each tile the file that it is.
    whole: Vec<Option<usize>>,
}

impl Readers {
    pub(super) fn of(plan: &Plan) -> Self {
        let mut readers = Readers {
            divided: Vec::new(),
            tasks: Vec::with_capacity(plan.files.len()),
            whole: vec![None; plan.layout.tile_count()],
        };
        for (number, file) in plan.files.iter().enumerate() {
            readers
                .tasks
                .push(file.tile.is_none().then_some(readers.divided.len()));
            match file.tile {
                Some(tile) => readers.whole[tile as usize] = Some(number),
                None => readers.divided.push(number),
            }
        }
        readers
    }

    /// Returns the task that divides a file; `None` if it is a tile.
    pub(super) fn task_of(&self, file: usize) -> Option<usize> {
        self.tasks[file]
    }

    /// Returns the file that a tile is; `None` if all of its points come from files that are
    /// divided.
    pub(super) fn whole(&self, tile: u32) -> Option<usize> {
        self.whole[tile as usize]
    }

    /// Returns for each tile the files that may have points of it, in their order.
    pub(super) fn files_of_tiles(plan: &Plan) -> Vec<Vec<usize>> {
        let mut all = vec![Vec::new(); plan.layout.tile_count()];
        for (number, file) in plan.files.iter().enumerate() {
            match file.tile {
                Some(tile) => all[tile as usize].push(number),
                None => {
                    let Spread { min, max, .. } = PlannedFile::spread(file);
                    plan.layout
                        .tiles_in(min, max, &mut |tile| all[tile as usize].push(number));
                }
            }
        }
        all
    }
}

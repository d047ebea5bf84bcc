//! Lines smoothed and simplified, cell by cell.

use rayon::prelude::*;

use super::corridor::Corridor;
use super::lattice::{Lattice, Tracked};
use super::relax::{Relaxing, has_inner, relax};
use super::room::Room;
use super::strand::Strand;
use super::thin::thin;
use crate::error::Result;
use crate::terrain::walk::Locator;

/// What a pass does with lines.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pass {
    pub(super) lattice: Lattice,
    /// How far lines are smoothed, if they are.
    pub(super) relaxing: Option<Relaxing>,
    /// How far points that are removed may be from the line, if any are.
    pub(super) tolerance: Option<f64>,
}

impl Pass {
    /// Smooths and simplifies lines. Each cell of the lattice is worked on alone, and each of the
    /// levels in it: lines of two levels stay in corridors that have nothing in common, and cells
    /// are convex.
    ///
    /// # Errors
    /// If the work is stopped; each vertex of the surface counts once at most.
    ///
    /// # Complexity
    /// Linear in the points of lines, times those of a level in a cell; on all threads.
    pub(super) fn run(
        &self,
        lines: Vec<Tracked>,
        levels: &[f64],
        corridor: &Corridor<'_>,
        locator: &Locator<'_>,
    ) -> Result<Vec<Tracked>> {
        let cut = |(number, line): (usize, &Tracked)| {
            // Lines that are not cut any more are not needed: the work is stopped below.
            if corridor.count(0).is_err() {
                return Vec::new();
            }
            let strands = self.lattice.cut(number as u32, line, corridor, locator);
            let keyed = strands.into_iter().map(|strand| {
                let cell = self.lattice.cell_of(&strand);
                ((line.level, cell), strand)
            });
            keyed.collect::<Vec<_>>()
        };
        let mut strands: Vec<((usize, [i64; 2]), Strand)> =
            lines.par_iter().enumerate().flat_map_iter(cut).collect();
        strands.par_sort_by_key(|(key, _)| *key);
        let all: usize = strands.iter().map(|(_, strand)| strand.points.len()).sum();
        let vertices = corridor.vertex_count() as f64 / all as f64;
        let rooms: Vec<_> = strands.chunk_by(|(a, _), (b, _)| a == b).collect();
        let done = |room: &&[((usize, [i64; 2]), Strand)]| {
            let (level, cell) = room[0].0;
            let strands: Vec<Strand> = room.iter().map(|(_, strand)| strand.clone()).collect();
            let points: usize = strands.iter().map(|strand| strand.points.len()).sum();
            corridor.count((points as f64 * vertices) as u64)?;
            if !strands.iter().any(has_inner) {
                return Ok(strands);
            }
            let (cell, level) = (self.lattice.cell(cell), levels[level]);
            let mut room = Room::new(strands);
            if let Some(relaxing) = self.relaxing {
                relax(&mut room, &cell, level, corridor, relaxing);
            }
            if let Some(tolerance) = self.tolerance {
                thin(&mut room, level, corridor, tolerance);
            }
            Ok(room.finish())
        };
        let done: Vec<Vec<Strand>> = rooms.par_iter().map(done).collect::<Result<_>>()?;
        corridor.count(0)?;
        let mut strands: Vec<Strand> = done.into_iter().flatten().collect();
        strands.par_sort_by_key(|strand| (strand.line, strand.number));
        let of_lines = strands.chunk_by(|a, b| a.line == b.line);
        let joined =
            of_lines.map(|strands| Tracked::joined(lines[strands[0].line as usize].level, strands));
        Ok(joined.collect())
    }
}

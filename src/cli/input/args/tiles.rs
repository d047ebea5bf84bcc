use std::path::PathBuf;

use clap::Args;

use crate::run::{Division, memory_of};

/// The memory of verbs that ask a surface.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Surface")]
pub(crate) struct MemoryArgs {
    /// Memory for surfaces of points, such as `2GB` [default: half of what is free]
    ///
    /// Points that need more become a TIN in parts first, which is used in its files: with linear
    /// heights, the result is the same, byte for byte. The files take about 200 bytes a point, in a
    /// folder in TMPDIR (else in /var/tmp) that is removed at the end. For a surface that is asked
    /// again, write the parts once with `breakline tin -o OUT.tins`.
    #[arg(long, value_name = "SIZE", value_parser = memory_of)]
    pub(crate) memory: Option<u64>,
}

/// Options of surfaces that do not fit into memory.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Tiles")]
pub(crate) struct TileArgs {
    /// Work in tiles: `auto`, or columns and rows such as `8x8` [default: if memory is short]
    ///
    /// The result is the same, byte for byte. `auto` takes the files as tiles if they are separate
    /// and small; else their points are divided among tiles first. With linear heights. All files
    /// are read, also those far from --bounds.
    #[arg(long, value_name = "auto|COLUMNSxROWS")]
    pub(crate) tiles: Option<Division>,

    /// Memory to use, such as `2GB` [default: half of what is free]
    ///
    /// Points that need more are worked on in tiles, which are chosen to fit.
    #[arg(long, value_name = "SIZE", value_parser = memory_of)]
    pub(crate) memory: Option<u64>,

    /// Folder for the files of the tasks [default: the output's name with .job]
    ///
    /// It is removed when the output is written, unless it was named, or files were skipped.
    #[arg(long, value_name = "FOLDER")]
    pub(crate) job: Option<PathBuf>,

    /// Go on with a job that was interrupted
    ///
    /// Tasks that are done are verified by their checksums and not done again.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Do again what changed inputs reach, and keep the job for the next time
    ///
    /// Repeat the command that began the job. Files that were changed, added or removed since are
    /// found, and only the tasks that they affect are done again. The output is replaced if it is
    /// still as the job wrote it. If there is no job yet, one is planned.
    #[arg(long, conflicts_with_all = ["resume", "dry_run"])]
    pub(crate) update: bool,

    /// Print the plan and end; with --resume, that of the job that would go on
    #[arg(long)]
    pub(crate) dry_run: bool,

    /// Leave a hole where a file cannot be read, and report it
    ///
    /// The hole is the extent that its header states, also where other files have points. The exit
    /// code is 3, and the folder of the job is kept: with --resume, files are tried again that may
    /// have been repaired.
    #[arg(long)]
    pub(crate) skip_bad: bool,
}

impl TileArgs {
    /// Returns true if any option asks for tiles.
    pub(crate) fn are_asked_for(&self) -> bool {
        let switches = [self.resume, self.update, self.dry_run, self.skip_bad];
        self.tiles.is_some() || self.job.is_some() || switches.contains(&true)
    }
}

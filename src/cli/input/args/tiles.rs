use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use crate::run::Division;

/// Options of surfaces that do not fit into memory.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Tiles")]
pub(in crate::cli) struct TileArgs {
    /// Work in tiles: `auto`, or columns and rows such as `8x8` [default: if memory is short]
    ///
    /// The result is the same, byte for byte. `auto` takes the files as tiles if they are separate
    /// and small; else their points are divided among tiles first. With linear heights.
    #[arg(long, value_name = "auto|COLUMNSxROWS")]
    pub(in crate::cli) tiles: Option<TilesArg>,

    /// Memory to use, such as `2GB` [default: half of what is free]
    ///
    /// Points that need more are worked on in tiles, which are chosen to fit.
    #[arg(long, value_name = "SIZE", value_parser = size)]
    pub(in crate::cli) memory: Option<u64>,

    /// Folder for the files of the tasks [default: the output's name with .job]
    ///
    /// It is removed when the output is written, unless it was named, or files were skipped.
    #[arg(long, value_name = "FOLDER")]
    pub(in crate::cli) job: Option<PathBuf>,

    /// Go on with a job that was interrupted
    ///
    /// Tasks that are done are verified by their checksums and not done again.
    #[arg(long)]
    pub(in crate::cli) resume: bool,

    /// Print the plan and end
    #[arg(long)]
    pub(in crate::cli) dry_run: bool,

    /// Leave a hole where a file cannot be read, and report it
    ///
    /// The hole is the extent that its header states, also where other files have points. The exit
    /// code is 3, and the folder of the job is kept: with --resume, files are tried again that may
    /// have been repaired.
    #[arg(long)]
    pub(in crate::cli) skip_bad: bool,

    /// The caller of the run.
    #[arg(skip)]
    pub(in crate::cli) caller: Caller,
}

/// What calls a run in tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(in crate::cli) enum Caller {
    /// The verb of the product.
    #[default]
    Verb,
    /// `breakline job`, for all tasks that are left.
    Job,
    /// `breakline job`, for the last task, which has this number. It writes the output, and looks
    /// at no input.
    LastTask(usize),
}

impl TileArgs {
    /// Returns true if any option asks for tiles.
    pub(in crate::cli) fn are_asked_for(&self) -> bool {
        self.tiles.is_some() || self.job.is_some() || self.resume || self.dry_run || self.skip_bad
    }
}

/// Which tiles there are, as typed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cli) struct TilesArg(pub(in crate::cli) Division);

impl FromStr for TilesArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("auto") {
            return Ok(TilesArg(Division::Auto));
        }
        let count = |text: &str| text.trim().parse().ok().filter(|count| (1..=MOST_TILES).contains(count));
        let counts = text.split_once(['x', 'X']).and_then(|(columns, rows)| Some([count(columns)?, count(rows)?]));
        let division = counts.filter(|[columns, rows]| columns * rows <= MOST_TILES);
        let division = division.map(|counts| TilesArg(Division::Grid(counts)));
        division.ok_or_else(|| format!("expected `auto`, or columns and rows, such as `8x8`: up to {MOST_TILES} tiles"))
    }
}

/// The most tiles: each takes some hundred bytes of the plan.
const MOST_TILES: usize = 1_000_000;

/// Parses a number of bytes, such as `500MB` or `1.5GiB`.
fn size(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let factor = match unit.trim().to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kb" => 1e3,
        "m" | "mb" => 1e6,
        "g" | "gb" => 1e9,
        "t" | "tb" => 1e12,
        "kib" => 1024.0,
        "mib" => 1024.0 * 1024.0,
        "gib" => 1024.0 * 1024.0 * 1024.0,
        _ => return Err(format!("`{unit}` is not a unit of memory; expected a size such as 500MB, 2GB or 2GiB")),
    };
    match number.parse::<f64>() {
        Ok(count) if count * factor >= LEAST_MEMORY && count * factor < 1e18 => Ok((count * factor) as u64),
        Ok(_) => Err("expected at least 16MB".to_owned()),
        Err(_) => Err(format!("`{text}` is not a size; expected one such as 500MB, 2GB or 2GiB")),
    }
}

/// Less does not suffice for the program itself.
const LEAST_MEMORY: f64 = 16e6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_counts_are_understood() {
        assert_eq!(size("64MB"), Ok(64_000_000));
        assert_eq!(size("1.5 GiB"), Ok(1_610_612_736));
        assert_eq!(size("16000000"), Ok(16_000_000));
        for wrong in ["2XB", "GB", "1MB", "-5GB", "1e3MB"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert_eq!("8x3".parse(), Ok(TilesArg(Division::Grid([8, 3]))));
        assert_eq!("AUTO".parse(), Ok(TilesArg(Division::Auto)));
        for wrong in ["8", "0x3", "3x", "axb", "2000000x1", "2000x2000"] {
            assert!(wrong.parse::<TilesArg>().is_err(), "{wrong}");
        }
    }
}

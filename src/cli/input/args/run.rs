use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::MemoryArgs;

/// Make several products of one surface, which is built once
///
/// A run file (TOML) has a table [input] with the options of the surface, and a [[product]] for
/// each verb. Keys are the options of the command line without dashes; `files` are the inputs.
/// Paths are relative to the run file. The results are those of the single commands, byte for byte;
/// all files appear together at the end, or none.
///
///   [input]
///   files = "tiles/*.laz"
///   breaklines = ["edges.shp:Z"]
///
///   [[product]]
///   verb = "dem"
///   resolution = 0.5
///   output = "dem.tif"
///
///   [[product]]
///   verb = "volume"
///   plane = 104.5
///   output = "volumes.csv"
///
/// Products are those of `tin`, `simplify`, `dem`, `contour`, `hillshade`, `color-relief`, `slope`,
/// `aspect`, `curvature`, `roughness`, `tri`, `tpi`, `volume`, `compare`, `profile`, `drape`,
/// `sample` and `accuracy`. With `volume`, `compare` and `profile`, `files` of the product are the
/// other surfaces. Points that need more memory than there is become a TIN in parts first, once.
#[derive(Debug, Clone, Args)]
#[command(
    verbatim_doc_comment,
    after_long_help = "\
Example:
  breakline run site.toml --dry-run
  breakline run site.toml --overwrite"
)]
pub(crate) struct RunArgs {
    /// The run file
    #[arg(value_name = "FILE.toml", value_hint = ValueHint::FilePath)]
    pub(crate) input: PathBuf,

    /// Print what would be made, with the single commands, and write nothing
    #[arg(long)]
    pub(crate) dry_run: bool,

    /// Replace files that exist
    #[arg(long)]
    pub(crate) overwrite: bool,

    /// Print a JSON object with the report of each product
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
}

/// Print completions of verbs, options and values for a shell
///
/// For bash: `source <(breakline completions bash)` in `~/.bashrc`.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline completions bash > ~/.local/share/bash-completion/completions/breakline
  breakline completions fish > ~/.config/fish/completions/breakline.fish")]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum, value_name = "SHELL")]
    pub(crate) shell: clap_complete::Shell,
}

/// Write man pages: one for the program, one for each verb
///
/// Without a folder, the page of the program is printed.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline man | man -l -
  breakline man -o ~/.local/share/man/man1")]
pub(crate) struct ManArgs {
    /// Folder for all pages, which is created if it is missing
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: Option<PathBuf>,

    /// Replace files that exist
    #[arg(long)]
    pub(crate) overwrite: bool,
}

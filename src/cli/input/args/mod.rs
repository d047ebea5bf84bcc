//! The command line as it is typed. What it means is worked out elsewhere (`super::plan`,
//! `super::outputs`, ...).

mod accuracy;
mod compare;
mod contour;
mod crs;
mod drape;
mod driver;
mod ground;
mod job;
mod lines;
mod parse;
mod profile;
mod quantity;
mod reading;
mod relief;
mod run;
mod sample;
mod surface;
mod switches;
mod systems;
mod terrain_tiles;
mod tiles;
mod verbs;
mod volume;

use std::num::NonZeroUsize;

use clap::{Args, Parser, Subcommand};

use crate::cli::Exit;
use crate::cli::report::console::Verbosity;
use crate::io::formats;

pub(crate) use accuracy::AccuracyArgs;
pub(crate) use compare::CompareArgs;
pub(crate) use contour::ContourArgs;
pub(crate) use crs::CrsArgs;
pub(crate) use drape::DrapeArgs;
pub(crate) use driver::DriverArgs;
pub(crate) use ground::GroundArgs;
pub(crate) use job::{JobAction, JobArgs};
pub(crate) use lines::LineArgs;
pub(crate) use parse::{ClassRange, EdgeLength, ReturnRange, finite};
pub(crate) use profile::ProfileArgs;
pub(crate) use quantity::{
    AspectArgs, CurvatureArg, CurvatureArgs, QuantityArgs, RoughnessArgs, SlopeArgs, TpiArgs,
    TriArgs,
};
pub(crate) use relief::ColorReliefArgs;
pub(crate) use run::{CompletionsArgs, ManArgs, RunArgs};
pub(crate) use sample::SampleArgs;
pub(crate) use surface::{CrossingZArg, DuplicatesArg, OnCrossingArg, SurfaceArgs};
pub(crate) use switches::expand_switches;
pub(crate) use systems::SystemArgs;
pub(crate) use terrain_tiles::{TerrainFormatArg, TerrainTilesArgs, TilingArg};
pub(crate) use tiles::{MemoryArgs, TileArgs};
pub(crate) use verbs::{
    CheckArgs, DemArgs, DemoArgs, DescribeArgs, FrameArgs, HillshadeArgs, InfoArgs, LimitArgs,
    OutputArgs, PointsArgs, SimplifyArgs, TinArgs, TriangulateArgs,
};
pub(crate) use volume::VolumeArgs;

/// Lidar and breaklines to TIN, DEM, contours and mesh
///
/// Reads points (LAS, LAZ, COPC, text, shapefiles), builds a TIN that follows every breakline, and
/// writes meshes, rasters and contours. Lengths are in the units of the coordinate system and are
/// printed with their unit. Data goes to files (`info`: to stdout), messages to stderr.
#[derive(Debug, Parser)]
#[command(name = "breakline", version, max_term_width = 100, after_long_help = examples())]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) console: ConsoleArgs,
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

const EXAMPLES: &str = "
Examples:
  breakline info tile.laz
  breakline tin tiles/*.laz --breaklines edges.shp -o ground.ply
  breakline points tiles/*.laz --class ground --bounds 500,200,700,400 -o part.laz
  breakline dem ground.ply --resolution 0.5 -o dem.tif
  breakline contour ground.ply --interval 1 -o contours.shp
  breakline volume ground.ply --plane 104.5
  breakline profile ground.ply design.ply --along axis.shp -o profile.svg
  breakline drape ground.ply --lines roads.shp -o roads3d.shp
  breakline terrain-tiles ground.ply --vertical-offset 47.3 -o tiles
  breakline demo

`breakline VERB --help` lists the options of a verb, with defaults and an example.";

/// Returns the end of the long help: the tables of formats and of exit codes, then examples.
fn examples() -> String {
    let exits: String = Exit::ALL
        .iter()
        .map(|(exit, meaning)| format!("  {}  {meaning}\n", *exit as u8))
        .collect();
    format!("{}\nExit codes:\n{exits}{EXAMPLES}", formats::help())
}

/// How much is printed, and how many threads are used.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "General")]
pub(crate) struct ConsoleArgs {
    /// Print warnings and errors only
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Print details of what is read and done
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// Number of threads [default: one per core]
    ///
    /// The results do not depend on it.
    #[arg(long, global = true, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

impl ConsoleArgs {
    /// Returns how much is printed.
    pub(crate) fn level(&self) -> Verbosity {
        match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        }
    }
}

/// The verb, with its options.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    Info(InfoArgs),
    Points(PointsArgs),
    Ground(GroundArgs),
    Tin(TinArgs),
    Simplify(SimplifyArgs),
    Triangulate(TriangulateArgs),
    Dem(DemArgs),
    Contour(ContourArgs),
    Hillshade(HillshadeArgs),
    ColorRelief(ColorReliefArgs),
    Slope(SlopeArgs),
    Aspect(AspectArgs),
    Curvature(CurvatureArgs),
    Roughness(RoughnessArgs),
    Tri(TriArgs),
    Tpi(TpiArgs),
    Volume(VolumeArgs),
    Compare(CompareArgs),
    Profile(ProfileArgs),
    Drape(DrapeArgs),
    TerrainTiles(TerrainTilesArgs),
    Sample(SampleArgs),
    Accuracy(AccuracyArgs),
    Check(CheckArgs),
    Run(RunArgs),
    Crs(CrsArgs),
    Job(JobArgs),
    Demo(DemoArgs),
    Describe(DescribeArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_definition_holds_together() {
        super::Cli::command().debug_assert();
    }
}

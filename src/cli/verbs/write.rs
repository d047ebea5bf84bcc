//! Verbs that write what they make of a surface, in one piece or in tiles.

use super::asked::Asked;
use super::{contour, dem, hillshade, quantity, relief, tin};
use crate::cli::Exit;
use crate::cli::input::args::{TileArgs, Verb};
use crate::cli::report::console::Console;
use crate::cli::report::written::Shown;
use crate::error::{Error, Result};
use crate::run::{self, BadFiles, Execution, TileOptions};

/// Returns what a verb asks for.
///
/// # Errors
/// If it is not one of those that write what they make of a surface.
pub(super) fn asked(verb: &Verb, console: &Console) -> Result<Asked> {
    match verb {
        Verb::Dem(args) => dem::asked(args, console),
        Verb::Contour(args) => contour::asked(args, console),
        Verb::Hillshade(args) => hillshade::asked(args, console),
        Verb::ColorRelief(args) => relief::asked(args, console),
        Verb::Slope(args) => quantity::slope(args, console),
        Verb::Aspect(args) => quantity::aspect(args, console),
        Verb::Curvature(args) => quantity::curvature(args, console),
        Verb::Roughness(args) => quantity::roughness(args, console),
        Verb::Tri(args) => quantity::tri(args, console),
        Verb::Tpi(args) => quantity::tpi(args, console),
        Verb::Tin(args) => tin::asked(args, console),
        Verb::Simplify(args) => tin::simplified(args, console),
        _ => Err(
            Error::usage("a job makes a DEM, contours, a hillshade, a color relief, a TIN in parts, or slopes and the like")
                .cure("begin the command with `dem`, `contour`, `hillshade`, `color-relief`, `tin`, `slope`, `aspect`, `curvature`, `roughness`, `tri` or `tpi`"),
        ),
    }
}

/// Writes what a verb asks for.
pub(crate) fn run(verb: &Verb, console: &Console) -> Result<Exit> {
    let Asked {
        request,
        targets,
        tiles,
    } = asked(verb, console)?;
    let again = if tiles.update { "--update" } else { "--resume" };
    let shown = Shown::new(console, Some(again.to_owned()));
    let report = run::write(&request, &targets, &execution(&tiles), &shown.context())?;
    Ok(shown.print(&report))
}

/// Returns how a request is worked on.
fn execution(args: &TileArgs) -> Execution {
    let options = options(args);
    if args.dry_run && args.resume {
        Execution::PlanResume(options)
    } else if args.dry_run {
        Execution::Plan(options)
    } else if args.resume {
        Execution::Resume(options)
    } else if args.update {
        Execution::Update(options)
    } else if args.are_asked_for() {
        Execution::Tiles(options)
    } else {
        Execution::Auto {
            memory: args.memory,
        }
    }
}

/// Returns the options of a job.
pub(super) fn options(args: &TileArgs) -> TileOptions {
    TileOptions {
        division: args.tiles.unwrap_or_default(),
        memory: args.memory,
        folder: args.job.clone(),
        bad: if args.skip_bad {
            BadFiles::Skip
        } else {
            BadFiles::Refuse
        },
        ..TileOptions::default()
    }
}

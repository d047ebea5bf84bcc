use std::io::Write;
use std::path::PathBuf;

use super::pair;
use crate::cli::Exit;
use crate::cli::input::args::VolumeArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::input::{inputs, outputs};
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::volumes;
use crate::cli::report::written::commit;
use crate::error::{Error, Result};
use crate::run::targets::{TABLES, add_table};
use crate::run::{self, Bulking, Input, VolumeBase, VolumeOptions};
use crate::terrain::Method;

/// Computes cut and fill between two surfaces, or above levels.
pub(crate) fn run(args: &VolumeArgs, console: &Console) -> Result<Exit> {
    let levels = levels(args)?;
    inputs::require(&args.within)?;
    let plans = SurfacePlan::resolve_each(&args.surface, console)?;
    let read: Vec<PathBuf> = pair::files(&plans).chain(args.within.clone()).collect();
    let output = pair::output(&args.output, args.overwrite);
    let outputs = outputs::resolve(&output, TABLES, &read)?;
    let surfaces = pair::read(
        &plans,
        ["surface", "base"],
        &args.surface,
        Method::Linear,
        &args.memory,
        console,
    )?;
    let base = match &surfaces[..] {
        [_, base] => VolumeBase::Surface(base),
        _ if args.base.is_some() => VolumeBase::Rim,
        _ => VolumeBase::Levels(&levels),
    };
    let named = |i: usize| args.surface.inputs.get(i).cloned().unwrap_or_default();
    let options = VolumeOptions {
        within: args.within.clone().map(Input::File),
        name_by: args.name_by.clone(),
        assign: plans.first().and_then(pair::assigned),
        unit: args.unit.map(Into::into),
        bulking: (args.swell.is_some() || args.shrink.is_some()).then(|| Bulking {
            swell: args.swell.unwrap_or(1.0),
            shrink: args.shrink.unwrap_or(1.0),
        }),
        names: [named(0), named(1)],
    };
    let Some(surface) = surfaces.first() else {
        return Err(pair::no_surface());
    };
    let product = run::volume(surface, base, &options, &console.context())?;
    for target in &outputs.targets {
        add_table(&target.path, &outputs.set, |out| {
            out.write_all(volumes::csv(&product).as_bytes())
        })?;
    }
    commit(outputs, console)?;
    print(&match args.json {
        true => volumes::json(&product),
        false => volumes::text(&product),
    })?;
    Ok(Exit::Done)
}

/// Returns the levels that are the bases; none if the base is not level.
///
/// # Errors
/// If there is not one surface with one base, or an option has no meaning here.
fn levels(args: &VolumeArgs) -> Result<Vec<f64>> {
    let level = args.plane.map(|level| vec![level]);
    let levels = level.or_else(|| args.levels.as_ref().map(|steps| steps.0.clone()));
    let of_levels = levels.is_some() || args.base.is_some();
    let error = match (&args.surface.inputs[..], of_levels) {
        ([], _) => pair::no_surface(),
        ([_], false) => Error::usage("the base of the volumes is missing")
            .cure("name a second surface, or use --plane Z, --levels FROM:TO:STEP or --base rim"),
        ([_, base], true) => Error::usage("two bases: a surface and an option")
            .in_file(base)
            .cure("leave out the second surface, or --plane, --levels and --base"),
        ([_, _, more, ..], _) => pair::third(more, "a surface and its base"),
        _ if args.base.is_some() && args.within.is_none() => {
            Error::usage("--base rim: no outlines are named").cure("name them with --within FILE")
        }
        _ => {
            pair::refuse_tables(&args.surface, "volume")?;
            return Ok(levels.unwrap_or_default());
        }
    };
    Err(error)
}

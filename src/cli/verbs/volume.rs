use std::io::Write;
use std::path::PathBuf;

use super::pair;
use super::product::{self, Answer, Outcome, Product};
use crate::cli::Exit;
use crate::cli::input::args::VolumeArgs;
use crate::cli::input::inputs;
use crate::cli::input::outputs::{self, Outputs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::volumes;
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::targets::{TABLES, add_table};
use crate::run::{self, Bulking, Context, Input, SurfaceProduct, VolumeBase, VolumeOptions};
use crate::terrain::Method;

/// Computes cut and fill between two surfaces, or above levels.
pub(crate) fn run(args: &VolumeArgs, console: &Console) -> Result<Exit> {
    let volume = Volume::of(args, None, console)?;
    let surfaces = pair::read(
        &volume.plans,
        ["surface", "base"],
        &args.surface,
        Method::Linear,
        &args.memory,
        console,
    )?;
    let json = args.json.then_some(product::in_lines as _);
    product::finish(&volume, &surfaces, json, console)
}

/// Volumes that are asked for.
pub(super) struct Volume<'a> {
    args: &'a VolumeArgs,
    plans: Vec<SurfacePlan>,
    levels: Vec<f64>,
    outputs: Outputs<()>,
    reads: Vec<PathBuf>,
}

impl<'a> Volume<'a> {
    /// Returns what is asked for; of the surface `given`, if that is known already.
    ///
    /// # Errors
    /// If files are missing, options do not go together or the table cannot be written.
    pub(super) fn of(
        args: &'a VolumeArgs,
        given: Option<&SurfacePlan>,
        console: &Console,
    ) -> Result<Self> {
        let levels = levels(args)?;
        inputs::require(&args.within)?;
        let plans = SurfacePlan::resolve_each(&args.surface, given, console)?;
        let reads: Vec<PathBuf> = pair::files(&plans).chain(args.within.clone()).collect();
        let output = pair::output(&args.output, args.overwrite);
        let outputs = outputs::resolve(&output, TABLES, &reads)?;
        Ok(Volume {
            args,
            plans,
            levels,
            outputs,
            reads,
        })
    }
}

impl Product for Volume<'_> {
    fn surfaces(&self) -> &[SurfacePlan] {
        &self.plans
    }

    fn reads(&self) -> Vec<PathBuf> {
        self.reads.clone()
    }

    fn writes(&self) -> Vec<PathBuf> {
        self.outputs.files()
    }

    fn make(
        &self,
        surfaces: &[&SurfaceProduct],
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Outcome> {
        let args = self.args;
        let base = match surfaces {
            [_, base] => VolumeBase::Surface(base),
            _ if args.base.is_some() => VolumeBase::Rim,
            _ => VolumeBase::Levels(&self.levels),
        };
        let named = |i: usize| args.surface.inputs.get(i).cloned().unwrap_or_default();
        let options = VolumeOptions {
            within: args.within.clone().map(Input::File),
            name_by: args.name_by.clone(),
            assign: self.plans.first().and_then(pair::assigned),
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
        let product = run::volume(surface, base, &options, context)?;
        for target in &self.outputs.targets {
            add_table(&target.path, set, |out| {
                out.write_all(volumes::csv(&product).as_bytes())
            })?;
        }
        Ok(Outcome::Answer(Answer {
            text: volumes::text(&product),
            json: volumes::json(&product),
            ..Answer::default()
        }))
    }
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

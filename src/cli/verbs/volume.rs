use std::io::Write;

use super::pair;
use super::product::{self, Answer, Outcome, Product, ProductPlan};
use crate::cli::Exit;
use crate::cli::input::args::VolumeArgs;
use crate::cli::input::inputs;
use crate::cli::input::outputs::Target;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::volumes;
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::targets::{TABLES, add_table};
use crate::run::{self, Bulking, Context, Input, SurfaceProduct, VolumeBase, VolumeOptions};

/// Computes cut and fill between two surfaces, or above levels.
pub(crate) fn run(args: &VolumeArgs, console: &Console) -> Result<Exit> {
    let volume = Volume::of(args, None, console)?;
    let surfaces = pair::read(
        &volume,
        ["surface", "base"],
        &args.surface,
        &args.memory,
        console,
    )?;
    let json = args.json.then_some(product::in_lines as _);
    product::finish(&volume, &surfaces, json, console)
}

/// Volumes that are asked for.
pub(super) struct Volume<'a> {
    args: &'a VolumeArgs,
    levels: Vec<f64>,
    plan: ProductPlan,
    targets: Vec<Target<()>>,
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
        let surfaces = SurfacePlan::resolve_each(&args.surface, given, console)?;
        let output = pair::output(&args.output, args.overwrite);
        let (plan, targets) = ProductPlan::resolve(surfaces, args.within.clone(), &output, TABLES)?;
        Ok(Volume {
            args,
            levels,
            plan,
            targets,
        })
    }
}

impl Product for Volume<'_> {
    fn plan(&self) -> &ProductPlan {
        &self.plan
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
            assign: self.plan.assigned(),
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
        for target in &self.targets {
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

use std::path::PathBuf;

use super::pair;
use super::product::{self, Answer, Outcome, Product, ProductPlan};
use crate::cli::Exit;
use crate::cli::input::args::ProfileArgs;
use crate::cli::input::inputs;
use crate::cli::input::outputs::Target;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::profiles;
use crate::error::{Error, Result};
use crate::io::profiles::PlotOptions;
use crate::io::{OutputSet, is_standard_output};
use crate::run::targets::PROFILES;
use crate::run::{
    self, Context, Input, ProfileOptions, SectionOptions, SectionStations, SurfaceProduct,
};

/// Computes heights along lines, or along sections across them.
pub(crate) fn run(args: &ProfileArgs, console: &Console) -> Result<Exit> {
    let asked = ProfileAsked::of(args, None, console)?;
    let surfaces = pair::read(
        &asked,
        std::iter::repeat("surface"),
        &args.surface,
        &args.memory,
        console,
    )?;
    let json = args.json.then_some(product::in_one_line as _);
    product::finish(&asked, &surfaces, json, console)
}

/// Profiles that are asked for.
pub(super) struct ProfileAsked<'a> {
    args: &'a ProfileArgs,
    sections: Option<SectionOptions>,
    plan: ProductPlan,
    targets: Vec<Target<()>>,
}

impl<'a> ProfileAsked<'a> {
    /// Returns what is asked for; of the surface `given` first, if that is known already.
    ///
    /// # Errors
    /// If files are missing, options do not go together or an output cannot be written.
    pub(super) fn of(
        args: &'a ProfileArgs,
        given: Option<&SurfacePlan>,
        console: &Console,
    ) -> Result<Self> {
        let sections = sections(args)?;
        require_plots(args)?;
        inputs::require([&args.along])?;
        let surfaces = SurfacePlan::resolve_each(&args.surface, given, console)?;
        let output = pair::output(&args.output, args.overwrite);
        let (plan, targets) =
            ProductPlan::resolve(surfaces, [args.along.clone()], &output, PROFILES)?;
        if args.json && is_stdout_taken(args) {
            return Err(
                Error::usage("a file and the object of --json cannot both be on stdout")
                    .cure("leave one of them out"),
            );
        }
        Ok(ProfileAsked {
            args,
            sections,
            plan,
            targets,
        })
    }
}

impl Product for ProfileAsked<'_> {
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
        let options = ProfileOptions {
            along: Input::File(args.along.clone()),
            assign: self.plan.assigned(),
            step: args.step,
            sections: self.sections.clone(),
            names: args.surface.inputs.clone(),
        };
        let product = run::profile(surfaces, &options, context)?;
        let plot = PlotOptions {
            exaggeration: args.exaggeration,
            datum: args.datum,
            title: args.title.clone(),
        };
        for target in &self.targets {
            product.write(target.within(set), &plot)?;
        }
        let text = match is_stdout_taken(args) {
            true => String::new(),
            false => profiles::text(&product.profiles),
        };
        Ok(Outcome::Answer(Answer {
            text,
            json: profiles::json(&product.profiles),
            ..Answer::default()
        }))
    }
}

fn is_stdout_taken(args: &ProfileArgs) -> bool {
    args.output.iter().any(|path| is_standard_output(path))
}

/// Returns an error if there is an option of plots, but no plot.
fn require_plots(args: &ProfileArgs) -> Result<()> {
    let given = [
        ("--exaggeration", args.exaggeration.is_some()),
        ("--datum", args.datum.is_some()),
        ("--title", args.title.is_some()),
    ];
    let extension = |path: &PathBuf| path.extension().map(|e| e.to_ascii_lowercase());
    let is_plot = |path: &PathBuf| extension(path).is_some_and(|e| e == "svg" || e == "dxf");
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) if !args.output.iter().any(is_plot) => {
            Err(Error::usage(format!("{option} is for plots"))
                .cure("write one with -o FILE.svg or -o FILE.dxf"))
        }
        _ => Ok(()),
    }
}

/// Returns the sections that are asked for, if any.
///
/// # Errors
/// If options do not go together.
fn sections(args: &ProfileArgs) -> Result<Option<SectionOptions>> {
    let at = match (args.interval, &args.stations[..]) {
        (Some(interval), _) => Some(SectionStations::Every(interval)),
        (None, []) => None,
        (None, stations) => Some(SectionStations::At(stations.to_vec())),
    };
    let has_widths = args.left.is_some() || args.right.is_some();
    let of_sections = [
        ("--start", args.start.is_some()),
        ("--angle", args.angle.is_some()),
        ("--station-format", args.station_format.is_some()),
    ];
    let given = of_sections.iter().find(|(_, is_given)| *is_given);
    let error = match &at {
        _ if args.surface.inputs.is_empty() => pair::no_surface(),
        None if has_widths => Error::usage("--left and --right are for cross-sections")
            .cure("choose where they are with --interval or --stations"),
        None if let Some((option, _)) = given => {
            Error::usage(format!("{option} is for cross-sections"))
                .cure("choose where they are with --interval or --stations")
        }
        Some(_) if !has_widths => Error::usage("the lengths of the cross-sections are missing")
            .cure("give them with --left and --right"),
        _ => {
            pair::refuse_tables(&args.surface, "profile")?;
            return Ok(at.map(|at| SectionOptions {
                at,
                start: args.start.unwrap_or(0.0),
                widths: [args.left, args.right].map(Option::unwrap_or_default),
                angle: args.angle.unwrap_or(90.0),
                format: args.station_format.unwrap_or_default(),
            }));
        }
    };
    Err(error)
}

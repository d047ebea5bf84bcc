use std::io::Write;

use super::pair;
use super::product::{self, Answer, Outcome, Product, ProductPlan};
use super::sample::surface_beside;
use crate::cli::Exit;
use crate::cli::input::args::AccuracyArgs;
use crate::cli::input::outputs::Target;
use crate::cli::report::accuracy;
use crate::cli::report::console::Console;
use crate::cli::report::summary::of_columns;
use crate::error::Result;
use crate::io::OutputSet;
use crate::run::targets::{TABLES, add_table, is_same};
use crate::run::{self, AccuracyOptions, Context, Input, SurfaceProduct};
use crate::terrain::Method;

/// Compares a surface with checkpoints.
pub(crate) fn run(args: &AccuracyArgs, console: &Console) -> Result<Exit> {
    let asked = Accuracy::of(args, console)?;
    let surface = pair::read_one(&asked, &args.memory, console)?;
    let json = args.json.then_some(product::in_lines as _);
    product::finish(&asked, &[surface], json, console)
}

/// A comparison with checkpoints that is asked for.
pub(super) struct Accuracy<'a> {
    args: &'a AccuracyArgs,
    plan: ProductPlan,
    targets: Vec<Target<()>>,
}

impl<'a> Accuracy<'a> {
    /// Returns what is asked for.
    ///
    /// # Errors
    /// If files are missing, options do not go together or a table cannot be written.
    pub(super) fn of(args: &'a AccuracyArgs, console: &Console) -> Result<Self> {
        let surface = surface_beside(&args.surface, &args.checkpoints, console)?;
        let output = pair::output(args.output.iter().chain(&args.histogram), args.overwrite);
        let checkpoints = args.checkpoints.clone();
        let (plan, targets) = ProductPlan::resolve(vec![surface], [checkpoints], &output, TABLES)?;
        Ok(Accuracy {
            args,
            plan,
            targets,
        })
    }
}

impl Product for Accuracy<'_> {
    fn plan(&self) -> &ProductPlan {
        &self.plan
    }

    fn method(&self) -> Method {
        self.args.method.into()
    }

    fn make(
        &self,
        surfaces: &[&SurfaceProduct],
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Outcome> {
        let args = self.args;
        let [surface] = surfaces else {
            return Err(pair::no_surface());
        };
        let options = AccuracyOptions {
            read: args.surface.read.options(),
            assign: self.plan.assigned(),
            group_by: args.group_by.clone(),
            vegetated: args.vegetated.clone(),
            groups: Vec::new(),
            class: args.accuracy_class,
            checkpoint_error: args.checkpoint_error,
            method: self.method(),
            surface: args.surface.inputs.first().cloned().unwrap_or_default(),
        };
        let checkpoints = Input::File(args.checkpoints.clone());
        let product = run::accuracy(surface, &checkpoints, &options, context)?;
        for target in &self.targets {
            let is_of_bins = args
                .histogram
                .as_ref()
                .is_some_and(|path| is_same(path, &target.path));
            let text = match is_of_bins {
                true => accuracy::bins_csv(&product),
                false => accuracy::rows_csv(&product),
            };
            add_table(&target.path, set, |out| out.write_all(text.as_bytes()))?;
        }
        let decision = product.decision.as_ref();
        Ok(Outcome::Answer(Answer {
            lines: of_columns(product.columns).into_iter().collect(),
            text: accuracy::text(&product),
            json: accuracy::json(&product),
            is_failure: decision.is_some_and(|decision| !decision.is_met()),
        }))
    }
}

use std::io::Write;

use super::pair;
use super::sample::plan;
use crate::cli::Exit;
use crate::cli::input::args::AccuracyArgs;
use crate::cli::input::outputs;
use crate::cli::report::accuracy;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::summary::{print_columns, print_surface};
use crate::cli::report::written::commit;
use crate::error::Result;
use crate::run::targets::{TABLES, add_table, is_same};
use crate::run::{self, AccuracyOptions, Input, SurfaceReport};

/// Compares a surface with checkpoints.
pub(crate) fn run(args: &AccuracyArgs, console: &Console) -> Result<Exit> {
    let (plan, read) = plan(&args.surface, &args.checkpoints, console)?;
    let output = pair::output(args.output.iter().chain(&args.histogram), args.overwrite);
    let outputs = outputs::resolve(&output, TABLES, &read)?;
    let context = console.context();
    let mut surface = run::open_surface(
        &plan.request,
        args.method.into(),
        args.memory.memory,
        &context,
    )?;
    print_surface(&SurfaceReport::take(&mut surface)?, console);
    let options = AccuracyOptions {
        read: args.surface.read.options(),
        assign: pair::assigned(&plan),
        group_by: args.group_by.clone(),
        vegetated: args.vegetated.clone(),
        groups: Vec::new(),
        class: args.accuracy_class,
        checkpoint_error: args.checkpoint_error,
        method: args.method.into(),
        surface: args.surface.inputs.first().cloned().unwrap_or_default(),
    };
    let checkpoints = Input::File(args.checkpoints.clone());
    let product = run::accuracy(&surface, &checkpoints, &options, &context)?;
    print_columns(product.columns, console);
    for target in &outputs.targets {
        let is_of_bins = args
            .histogram
            .as_ref()
            .is_some_and(|path| is_same(path, &target.path));
        let text = match is_of_bins {
            true => accuracy::bins_csv(&product),
            false => accuracy::rows_csv(&product),
        };
        add_table(&target.path, &outputs.set, |out| {
            out.write_all(text.as_bytes())
        })?;
    }
    commit(outputs, console)?;
    print(&match args.json {
        true => accuracy::json(&product),
        false => accuracy::text(&product),
    })?;
    Ok(match &product.decision {
        Some(decision) if !decision.is_met() => Exit::Failed,
        _ => Exit::Done,
    })
}

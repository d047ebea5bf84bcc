use std::path::PathBuf;

use super::pair;
use crate::cli::Exit;
use crate::cli::input::args::CompareArgs;
use crate::cli::input::outputs::{self, formats_of};
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::comparison;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::written::commit;
use crate::error::{Error, Result};
use crate::io::formats::Product;
use crate::run::{self, CompareOptions};

/// Compares two surfaces.
pub(crate) fn run(args: &CompareArgs, console: &Console) -> Result<Exit> {
    match &args.surface.inputs[..] {
        [] => return Err(pair::no_surface()),
        [one] => {
            return Err(Error::usage("there is nothing to compare it with")
                .in_file(one)
                .cure("name a second surface"));
        }
        [_, _] => pair::refuse_tables(&args.surface, "compare")?,
        [_, _, more, ..] => return Err(pair::third(more, "two surfaces")),
    }
    let plans = SurfacePlan::resolve_each(&args.surface, console)?;
    let read: Vec<PathBuf> = pair::files(&plans)
        .chain(args.frame.align_to.clone())
        .collect();
    let output = pair::output(&args.output, args.overwrite);
    let outputs = outputs::resolve(&output, &formats_of(Product::Heights, |_| ()), &read)?;
    let named = |i: usize| args.surface.inputs.get(i).cloned().unwrap_or_default();
    let options = CompareOptions {
        frame: frame(&args.frame)?,
        method: args.method.into(),
        worst: args.worst,
        names: [named(0), named(1)],
    };
    let context = console.context();
    let surfaces = pair::read(
        &plans,
        ["surface", "minus"],
        &args.surface,
        console,
        &context,
    )?;
    let [first, second] = &surfaces[..] else {
        return Err(pair::no_surface());
    };
    let product = run::compare([first, second], &options, &context)?;
    for target in &outputs.targets {
        product
            .cells()
            .write(target.within(&outputs.set), &context)?;
    }
    commit(outputs, console)?;
    print(&match args.json {
        true => comparison::json(&product, args.changed),
        false => comparison::text(&product, args.changed),
    })?;
    Ok(Exit::Done)
}

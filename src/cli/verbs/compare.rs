use std::path::PathBuf;

use super::pair;
use crate::cli::Exit;
use crate::cli::input::args::CompareArgs;
use crate::cli::input::outputs::{self, Format, Outputs, formats_of};
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::comparison;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::written::commit;
use crate::error::{Error, Result};
use crate::io::formats::Product;
use crate::run::{self, AreaOptions, CompareOptions};

/// What is written to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Written {
    Cells,
    Areas,
}

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
    let outputs = outputs::resolve(&output, &formats(), &read)?;
    let named = |i: usize| args.surface.inputs.get(i).cloned().unwrap_or_default();
    let options = CompareOptions {
        frame: args.overviews.of(frame(&args.frame)?),
        method: args.method.into(),
        worst: args.worst,
        areas: areas(args, &outputs)?,
        names: [named(0), named(1)],
    };
    let surfaces = pair::read(
        &plans,
        ["surface", "minus"],
        &args.surface,
        options.method,
        &args.memory,
        console,
    )?;
    let [first, second] = &surfaces[..] else {
        return Err(pair::no_surface());
    };
    let context = console.context();
    let product = run::compare([first, second], &options, &context)?;
    for target in &outputs.targets {
        let file = target.within(&outputs.set);
        match (target.kind, &product.areas) {
            (Written::Areas, Some(areas)) => areas.write(file, &context)?,
            _ => {
                let cells = product.cells().with_overviews(options.frame.overviews);
                cells.write(file, &context)?;
            }
        }
    }
    commit(outputs, console)?;
    print(&match args.json {
        true => comparison::json(&product, args.changed),
        false => comparison::text(&product, args.changed),
    })?;
    Ok(Exit::Done)
}

/// Returns the formats of rasters and of polygons.
fn formats() -> Vec<Format<Written>> {
    let mut formats = formats_of(Product::Heights, |_| Written::Cells);
    formats.extend(formats_of(Product::Lines, |_| Written::Areas));
    formats
}

/// Returns which areas are found; `None` if they are not asked for.
///
/// # Errors
/// If a file of areas is named, but no height.
fn areas(args: &CompareArgs, outputs: &Outputs<Written>) -> Result<Option<AreaOptions>> {
    let mut targets = outputs.targets.iter();
    let file = targets.find(|target| target.kind == Written::Areas);
    match (args.changed, file) {
        (None, Some(target)) => Err(Error::usage("polygons of what differs by which height?")
            .in_file(&target.path)
            .cure("add --changed HEIGHT")),
        (Some(height), file) if file.is_some() || args.min_area.is_some() => {
            Ok(Some(AreaOptions {
                height,
                min_area: args.min_area.unwrap_or(0.0),
            }))
        }
        _ => Ok(None),
    }
}

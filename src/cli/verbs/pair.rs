//! What verbs of several surfaces, each an input of its own, have in common.

use std::path::PathBuf;

use super::product::Product;
use crate::cli::input::args::{MemoryArgs, OutputArgs, SurfaceArgs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_surface;
use crate::error::{Error, Result};
use crate::run::{self, Source, SurfaceProduct, SurfaceReport};
use crate::terrain::Method;

/// Returns the options of outputs for these files, of which there may be none.
pub(super) fn output<'a>(
    files: impl IntoIterator<Item = &'a PathBuf>,
    overwrite: bool,
) -> OutputArgs {
    OutputArgs {
        output: files.into_iter().cloned().collect(),
        overwrite,
    }
}

/// Builds or reads each surface of a product, and prints its role and what it is. The memory is
/// shared by those that are built.
///
/// # Errors
/// Those of [`run::open_surface`].
pub(super) fn read(
    product: &dyn Product,
    roles: impl IntoIterator<Item = &'static str>,
    args: &SurfaceArgs,
    memory: &MemoryArgs,
    console: &Console,
) -> Result<Vec<SurfaceProduct>> {
    let context = console.context();
    let (plans, method) = (&product.plan().surfaces, product.method());
    let is_built = |plan: &SurfacePlan| matches!(plan.request.source, Source::Points(_));
    let built = plans.iter().filter(|plan| is_built(plan)).count() as u64;
    let memory_of = |plan: &SurfacePlan| {
        let given = memory.memory.filter(|_| built == 0 || is_built(plan));
        given.map(|all| all / built.max(1))
    };
    let named = roles.into_iter().zip(&args.inputs);
    let each = plans.iter().zip(named).map(|(plan, (role, input))| {
        let mut surface = run::open_surface(&plan.request, method, memory_of(plan), &context)?;
        console.line(format_args!("{role:<11} {}", input.display()));
        print_surface(&SurfaceReport::take(&mut surface)?, console);
        Ok(surface)
    });
    each.collect()
}

/// Builds or reads the only surface of a product, and prints what it is.
///
/// # Errors
/// Those of [`run::open_surface`].
pub(super) fn read_one(
    product: &dyn Product,
    memory: &MemoryArgs,
    console: &Console,
) -> Result<SurfaceProduct> {
    match product.plan().surfaces.first() {
        Some(plan) => open(plan, product.method(), memory, console),
        None => Err(no_surface()),
    }
}

/// Builds or reads a surface for heights by a method, and prints what it is.
///
/// # Errors
/// Those of [`run::open_surface`].
pub(super) fn open(
    plan: &SurfacePlan,
    method: Method,
    memory: &MemoryArgs,
    console: &Console,
) -> Result<SurfaceProduct> {
    let context = console.context();
    let mut surface = run::open_surface(&plan.request, method, memory.memory, &context)?;
    print_surface(&SurfaceReport::take(&mut surface)?, console);
    Ok(surface)
}

/// Returns an error if tables are asked for that belong to one surface.
pub(super) fn refuse_tables(args: &SurfaceArgs, verb: &str) -> Result<()> {
    match args.crossing_report.is_some() || args.lines.flat_points.is_some() {
        true => Err(Error::usage(format!(
            "`{verb}` writes no tables of crossings or replaced points"
        ))
        .cure("leave out --crossing-report and --flat-points; `breakline tin` has them")),
        false => Ok(()),
    }
}

#[cold]
pub(super) fn no_surface() -> Error {
    Error::usage("the surface is missing").cure("name a file of points, a TIN or a DEM")
}

#[cold]
pub(super) fn third(more: &PathBuf, expected: &str) -> Error {
    Error::usage(format!("a third surface: expected {expected}"))
        .in_file(more)
        .cure("quote a glob (\"tiles/*.laz\"), or use a list (@list.txt), for a surface of several files")
}

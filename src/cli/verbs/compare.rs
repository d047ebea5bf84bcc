use std::path::{Path, PathBuf};

use super::pair;
use super::product::{self, Answer, Outcome, Product, ProductPlan};
use crate::cli::Exit;
use crate::cli::input::args::CompareArgs;
use crate::cli::input::outputs::{Format, Formats, Target, formats_of};
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::{class_comparison, comparison};
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::io::formats::Product as Contents;
use crate::io::gdal::DriverContent;
use crate::run::{self, AreaOptions, CompareOptions, Context, SurfaceProduct};
use crate::terrain::Method;

/// What is written to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Written {
    Cells,
    Areas,
}

/// Compares two surfaces, or the classes of points.
pub(crate) fn run(args: &CompareArgs, console: &Console) -> Result<Exit> {
    if args.classes {
        return classes(args, console);
    }
    let asked = Comparison::of(args, None, console)?;
    let surfaces = pair::read(
        &asked,
        ["surface", "minus"],
        &args.surface,
        &args.memory,
        console,
    )?;
    let json = args.json.then_some(product::in_lines as _);
    product::finish(&asked, &surfaces, json, console)
}

/// Counts the points of two files by both of their classes.
fn classes(args: &CompareArgs, console: &Console) -> Result<Exit> {
    let files = match &args.surface.inputs[..] {
        [] => return Err(pair::no_surface()),
        [one] => return Err(alone(one, "file")),
        [first, second] => [first, second],
        [_, _, more, ..] => {
            return Err(Error::usage("a third file: expected two")
                .in_file(more)
                .cure("compare two at a time"));
        }
    };
    let found = run::compare_classes(files.map(PathBuf::as_path), &console.context())?;
    print(&match args.json {
        true => product::in_lines(&class_comparison::json(&found)),
        false => class_comparison::text(&found),
    })?;
    Ok(Exit::Done)
}

fn alone(one: &Path, missing: &str) -> Error {
    Error::usage("there is nothing to compare it with")
        .in_file(one)
        .cure(format!("name a second {missing}"))
}

/// A comparison that is asked for.
pub(super) struct Comparison<'a> {
    args: &'a CompareArgs,
    options: CompareOptions,
    plan: ProductPlan,
    targets: Vec<Target<Written>>,
}

impl<'a> Comparison<'a> {
    /// Returns what is asked for; of the surface `given`, if that is known already.
    ///
    /// # Errors
    /// If files are missing, options do not go together or an output cannot be written.
    pub(super) fn of(
        args: &'a CompareArgs,
        given: Option<&SurfacePlan>,
        console: &Console,
    ) -> Result<Self> {
        if args.classes {
            return Err(
                Error::usage("classes are of files of points, and this compares surfaces")
                    .cure("compare classes by a command of its own"),
            );
        }
        match &args.surface.inputs[..] {
            [] => return Err(pair::no_surface()),
            [one] => return Err(alone(one, "surface")),
            [_, _] => pair::refuse_tables(&args.surface, "compare")?,
            [_, _, more, ..] => return Err(pair::third(more, "two surfaces")),
        }
        let surfaces = SurfacePlan::resolve_each(&args.surface, given, console)?;
        let output = pair::output(&args.output, args.overwrite);
        let driver = args.driver.options();
        let formats = Formats {
            all: formats().into(),
            driver: Some(&driver),
            of_gdal: Some((DriverContent::Heights, Written::Cells)),
        };
        let aligned_to = args.frame.align_to.clone();
        let (plan, targets) = ProductPlan::resolve(surfaces, aligned_to, &output, formats)?;
        let named = |i: usize| args.surface.inputs.get(i).cloned().unwrap_or_default();
        let options = CompareOptions {
            frame: args.overviews.of(frame(&args.frame)?),
            method: args.method.into(),
            worst: args.worst,
            areas: areas(args, &targets)?,
            names: [named(0), named(1)],
        };
        Ok(Comparison {
            args,
            options,
            plan,
            targets,
        })
    }
}

impl Product for Comparison<'_> {
    fn plan(&self) -> &ProductPlan {
        &self.plan
    }

    fn method(&self) -> Method {
        self.options.method
    }

    fn make(
        &self,
        surfaces: &[&SurfaceProduct],
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Outcome> {
        let [first, second] = surfaces else {
            return Err(pair::no_surface());
        };
        let product = run::compare([first, second], &self.options, context)?;
        for target in &self.targets {
            let file = target.within(set);
            match (target.kind, &product.areas) {
                (Written::Areas, Some(areas)) => areas.write(file, context)?,
                _ => {
                    let overviews = self.options.frame.overviews;
                    let cells = product.cells().with_overviews(overviews);
                    cells.write(file, context)?;
                }
            }
        }
        Ok(Outcome::Answer(Answer {
            text: comparison::text(&product, self.args.changed),
            json: comparison::json(&product, self.args.changed),
            ..Answer::default()
        }))
    }
}

/// Returns the formats of rasters and of polygons.
fn formats() -> Vec<Format<Written>> {
    let mut formats = formats_of(Contents::Heights, |_| Written::Cells);
    formats.extend(formats_of(Contents::Lines, |_| Written::Areas));
    formats
}

/// Returns which areas are found; `None` if they are not asked for.
///
/// # Errors
/// If a file of areas is named, but no height.
fn areas(args: &CompareArgs, targets: &[Target<Written>]) -> Result<Option<AreaOptions>> {
    let file = targets.iter().find(|target| target.kind == Written::Areas);
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

//! What verbs make of surfaces, whoever built these: one run, or one that several products share.

use std::path::PathBuf;

use serde_json::Value;

use crate::cli::Exit;
use crate::cli::input::args::OutputArgs;
use crate::cli::input::outputs::{self, Formats, Target};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::escape;
use crate::cli::report::stdout::print;
use crate::cli::report::written::print_file;
use crate::crs::Crs;
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::targets::ProductFiles;
use crate::run::{Context, Summary, SurfaceProduct};
use crate::terrain::Method;

/// A verb whose options are understood and whose outputs are checked.
pub(super) trait Product {
    /// Returns its surfaces and its files.
    fn plan(&self) -> &ProductPlan;

    /// Returns how heights between vertices are computed.
    fn method(&self) -> Method {
        Method::Linear
    }

    /// Returns why the surface has to be built in one piece, if it has to.
    fn needs_whole(&self) -> Option<Error> {
        None
    }

    /// Makes it of the surfaces, and adds its files to a set.
    ///
    /// # Errors
    /// If it cannot be made or written, or the run is canceled.
    fn make(
        &self,
        surfaces: &[&SurfaceProduct],
        set: &mut OutputSet,
        context: &Context,
    ) -> Result<Outcome>;
}

/// The surfaces and the files of a product.
#[derive(Debug)]
pub(super) struct ProductPlan {
    /// What it is made of, the surface to which most options belong first.
    pub(super) surfaces: Vec<SurfacePlan>,
    /// All files that are read and written.
    pub(super) files: ProductFiles,
}

impl ProductPlan {
    /// Returns the plan of a product that reads its surfaces and `others`, and its outputs.
    ///
    /// # Errors
    /// Those of [`outputs::resolve`].
    pub(super) fn resolve<'f, F: Copy + 'static>(
        surfaces: Vec<SurfacePlan>,
        others: impl IntoIterator<Item = PathBuf>,
        output: &OutputArgs,
        formats: impl Into<Formats<'f, F>>,
    ) -> Result<(Self, Vec<Target<F>>)> {
        let of_surfaces = surfaces
            .iter()
            .flat_map(|plan| plan.targets.with_lists(plan.request.files()));
        let reads: Vec<PathBuf> = of_surfaces.chain(others).collect();
        let outputs = outputs::resolve(output, formats, &reads)?;
        let files = ProductFiles {
            writes: outputs.files(),
            reads,
        };
        Ok((ProductPlan { surfaces, files }, outputs.targets))
    }

    /// Returns the coordinate system of lines or points that are read with the first surface: the
    /// assigned one. With another system as the target, that is of the points of the surface alone.
    pub(super) fn assigned(&self) -> Option<Crs> {
        let systems = &self.surfaces.first()?.request.systems;
        match systems.target {
            None => systems.assign.clone(),
            Some(_) => None,
        }
    }
}

/// What is reported of a product.
pub(super) enum Outcome {
    /// Counts of what was written.
    Written(Summary),
    /// An answer.
    Answer(Answer),
}

/// What is reported of a product that is asked for its result, and not only for files.
#[derive(Default)]
pub(super) struct Answer {
    /// Lines of the summary.
    pub(super) lines: Vec<String>,
    /// What stdout has for people.
    pub(super) text: String,
    /// What it has for programs.
    pub(super) json: Value,
    /// True if a limit that was asked for is not met.
    pub(super) is_failure: bool,
}

/// Makes a product of its surfaces, which are built, and reports it; as an object in the form that
/// `json` returns, if there is one.
///
/// # Errors
/// Those of [`Product::make`], and if the files cannot appear.
pub(super) fn finish(
    product: &dyn Product,
    surfaces: &[SurfaceProduct],
    json: Option<fn(&Value) -> String>,
    console: &Console,
) -> Result<Exit> {
    let surfaces: Vec<&SurfaceProduct> = surfaces.iter().collect();
    let mut set = OutputSet::default();
    let outcome = product.make(&surfaces, &mut set, &console.context())?;
    let files = set.commit()?;
    files.iter().for_each(|path| print_file(path, console));
    let Outcome::Answer(answer) = outcome else {
        return Ok(Exit::Done);
    };
    answer
        .lines
        .iter()
        .for_each(|line| console.line(format_args!("{line}")));
    match json {
        Some(json) => print(&json(&answer.json))?,
        None => print(&answer.text)?,
    }
    Ok(match answer.is_failure {
        true => Exit::Failed,
        false => Exit::Done,
    })
}

/// Returns an object as it is printed, a line for each value.
pub(super) fn in_lines(object: &Value) -> String {
    escape::json(&format!("{object:#}\n"))
}

/// Returns an object as it is printed, in one line: it has lists of many numbers.
pub(super) fn in_one_line(object: &Value) -> String {
    escape::json(&format!("{object}\n"))
}

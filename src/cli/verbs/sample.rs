use std::io::Write;
use std::path::Path;

use serde_json::{Value, json};

use super::pair;
use super::product::{self, Answer, Outcome, Product, ProductPlan};
use crate::cli::Exit;
use crate::cli::input::args::{SampleArgs, SurfaceArgs};
use crate::cli::input::inputs;
use crate::cli::input::outputs::{Format, Target};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::Stdout;
use crate::cli::report::summary::{counted, of_columns};
use crate::error::{Error, Result};
use crate::io::OutputSet;
use crate::run::{
    self, Context, STDIN, SampleOptions, SampleReport, SampleTarget, SampledField, Source,
    SurfaceProduct,
};
use crate::terrain::Method;

/// The formats of points that values are added to.
const FORMATS: &[Format<()>] = &[
    Format::named("csv", &[]),
    Format::named("txt", &[]),
    Format::named("xyz", &[]),
    Format::named("las", &[]),
    Format::named("laz", &[]),
    Format::named("shp", &["shx", "dbf", "prj", "cpg"]),
    Format::named("geojson", &[]),
    Format::named("json", &[]),
];

/// Adds heights and slopes of a surface to points.
pub(crate) fn run(args: &SampleArgs, console: &Console) -> Result<Exit> {
    let asked = Sample::of(args, console)?;
    let surface = pair::read_one(&asked, &args.memory, console)?;
    if !asked.targets.is_empty() {
        let json = args.json.then_some(product::in_lines as _);
        return product::finish(&asked, &[surface], json, console);
    }
    let mut out = Stdout::new();
    let done = asked.sample(&surface, SampleTarget::Stream(&mut out), &console.context());
    match done.and_then(|report| Ok((report, out.flush()?))) {
        Ok((report, ())) => {
            lines_of(&report).iter().for_each(|line| console.line(line));
            Ok(Exit::Done)
        }
        Err(_) if out.is_closed() => Ok(Exit::Done),
        Err(error) => Err(error),
    }
}

/// Points that values are to be added to.
pub(super) struct Sample<'a> {
    args: &'a SampleArgs,
    add: Vec<SampledField>,
    plan: ProductPlan,
    targets: Vec<Target<()>>,
}

impl<'a> Sample<'a> {
    /// Returns what is asked for.
    ///
    /// # Errors
    /// If files are missing, options do not go together or the output cannot be written.
    pub(super) fn of(args: &'a SampleArgs, console: &Console) -> Result<Self> {
        let surface = surface_beside(&args.surface, &args.at, console)?;
        let output = pair::output(&args.output, args.overwrite);
        let (plan, targets) =
            ProductPlan::resolve(vec![surface], [args.at.clone()], &output, FORMATS)?;
        Ok(Sample {
            args,
            add: added(args)?,
            plan,
            targets,
        })
    }

    fn sample(
        &self,
        surface: &SurfaceProduct,
        target: SampleTarget,
        context: &Context,
    ) -> Result<SampleReport> {
        let args = self.args;
        let options = SampleOptions {
            add: self.add.clone(),
            prefix: args.prefix.clone(),
            method: self.method(),
            read: args.surface.read.options(),
            assign: self.plan.assigned(),
            surface: args.surface.inputs.first().cloned().unwrap_or_default(),
        };
        run::sample(surface, &args.at, &options, target, context)
    }
}

impl Product for Sample<'_> {
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
        let ([surface], [target]) = (surfaces, &self.targets[..]) else {
            return Err(Error::usage("no output is named").cure("name it with --output"));
        };
        let report = self.sample(surface, SampleTarget::File(target.within(set)), context)?;
        Ok(Outcome::Answer(Answer {
            lines: lines_of(&report),
            json: json_of(&report),
            ..Answer::default()
        }))
    }
}

/// Returns the lines of the summary.
fn lines_of(report: &SampleReport) -> Vec<String> {
    let outside = match report.outside {
        0 => String::new(),
        outside => format!(", {outside} outside"),
    };
    let sampled = format!("sampled     {}{outside}", counted(report.points, "point"));
    of_columns(report.read)
        .into_iter()
        .chain([sampled])
        .collect()
}

/// Returns the request for a surface that is compared with the points of a file. `--columns` is for
/// all inputs of text, `--partial` for all inputs.
///
/// # Errors
/// If a file does not exist, or the options do not go together.
pub(super) fn surface_beside(
    args: &SurfaceArgs,
    points: &Path,
    console: &Console,
) -> Result<SurfacePlan> {
    let is_stdin = |path: &Path| path.as_os_str() == STDIN;
    if !is_stdin(points) {
        inputs::require([&points.to_path_buf()])?;
    } else if args.inputs.iter().any(|input| is_stdin(input)) {
        return Err(
            Error::usage("the surface and the points cannot both be stdin")
                .cure("name a file for one of them"),
        );
    }
    if args.crossing_report.is_some() || args.lines.flat_points.is_some() {
        return Err(
            Error::usage("no tables of crossings or replaced points are written here")
                .cure("leave out --crossing-report and --flat-points; `breakline tin` has them"),
        );
    }
    let mut args = args.clone();
    let is_built = match &args.inputs[..] {
        [] => true,
        inputs => matches!(
            Source::of_files(&inputs::expand(inputs, console)?)?,
            Source::Points(_)
        ),
    };
    if !is_built {
        // They are for the points.
        args.read.columns = None;
        args.read.parse = None;
        args.read.partial = false;
    }
    SurfacePlan::resolve(&args, console)
}

/// Returns what is added, each field once.
///
/// # Errors
/// If a field is named twice.
fn added(args: &SampleArgs) -> Result<Vec<SampledField>> {
    let fields: Vec<SampledField> = args.add.iter().map(|&field| field.into()).collect();
    let is_again = |i: &usize| fields[..*i].contains(&fields[*i]);
    match (0..fields.len()).find(is_again) {
        Some(_) => Err(Error::usage("--add: a field is named twice").cure("name each field once")),
        None => Ok(fields),
    }
}

fn json_of(report: &SampleReport) -> Value {
    json!({
        "points": report.points,
        "outside": report.outside,
        "columns": report.columns,
    })
}

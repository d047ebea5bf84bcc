use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::pair;
use crate::cli::Exit;
use crate::cli::input::args::{SampleArgs, SurfaceArgs};
use crate::cli::input::inputs;
use crate::cli::input::outputs::{self, Format};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::{Stdout, print};
use crate::cli::report::summary::{counted, print_columns, print_surface};
use crate::cli::report::written::commit;
use crate::error::{Error, Result};
use crate::run::{
    self, STDIN, SampleOptions, SampleReport, SampleTarget, SampledField, Source, SurfaceReport,
};

/// The formats of points that values are added to.
const FORMATS: &[Format<()>] = &[
    format("csv", &[]),
    format("txt", &[]),
    format("xyz", &[]),
    format("las", &[]),
    format("laz", &[]),
    format("shp", &["shx", "dbf", "prj", "cpg"]),
    format("geojson", &[]),
    format("json", &[]),
];

const fn format(extension: &'static str, companions: &'static [&'static str]) -> Format<()> {
    Format {
        extension,
        kind: (),
        companions,
    }
}

/// Adds heights and slopes of a surface to points.
pub(crate) fn run(args: &SampleArgs, console: &Console) -> Result<Exit> {
    let (plan, read) = plan(&args.surface, &args.at, console)?;
    let output = pair::output(&args.output, args.overwrite);
    let outputs = outputs::resolve(&output, FORMATS, &read)?;
    let context = console.context();
    let mut surface = run::open_surface(
        &plan.request,
        args.method.into(),
        args.memory.memory,
        &context,
    )?;
    print_surface(&SurfaceReport::take(&mut surface)?, console);
    let options = SampleOptions {
        add: added(args)?,
        prefix: args.prefix.clone(),
        method: args.method.into(),
        read: args.surface.read.options(),
        assign: pair::assigned(&plan),
        surface: args.surface.inputs.first().cloned().unwrap_or_default(),
    };
    let sample = |target: SampleTarget| run::sample(&surface, &args.at, &options, target, &context);
    let report = match &outputs.targets[..] {
        [target, ..] => sample(SampleTarget::File(target.within(&outputs.set)))?,
        [] => {
            let mut out = Stdout::new();
            let done = sample(SampleTarget::Stream(&mut out));
            match done.and_then(|report| Ok((report, out.flush()?))) {
                Ok((report, ())) => report,
                Err(_) if out.is_closed() => return Ok(Exit::Done),
                Err(error) => return Err(error),
            }
        }
    };
    let outside = match report.outside {
        0 => String::new(),
        outside => format!(", {outside} outside"),
    };
    print_columns(report.read, console);
    console.line(format_args!(
        "sampled     {}{outside}",
        counted(report.points, "point")
    ));
    commit(outputs, console)?;
    if args.json {
        print(&json_of(&report))?;
    }
    Ok(Exit::Done)
}

/// Returns the request for a surface that is compared with the points of a file, and all files that
/// are read. `--columns` is for all inputs of text, `--partial` for all inputs.
///
/// # Errors
/// If a file does not exist, or the options do not go together.
pub(super) fn plan(
    args: &SurfaceArgs,
    points: &Path,
    console: &Console,
) -> Result<(SurfacePlan, Vec<PathBuf>)> {
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
    let plan = SurfacePlan::resolve(&args, console)?;
    let mut read = plan.targets.with_lists(plan.request.files());
    read.push(points.to_path_buf());
    Ok((plan, read))
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

fn json_of(report: &SampleReport) -> String {
    let all = json!({
        "points": report.points,
        "outside": report.outside,
        "columns": report.columns,
    });
    format!("{all:#}\n")
}

use crate::cli::Exit;
use crate::cli::input::args::{ClassRange, PointsArgs, ReturnRange};
use crate::cli::input::plan::systems;
use crate::cli::input::{inputs, outputs};
use crate::cli::report::console::Console;
use crate::cli::report::summary::{counted, print_extent};
use crate::cli::report::written::commit;
use crate::error::{Error, Result};
use crate::io::formats::Product;
use crate::io::las::Rounding;
use crate::run::{
    Existing, PlanLength, PointTiles, PointsReport, PointsRequest, Withheld, write_point_tiles,
    write_points,
};
use crate::terrain::{CellPoint, Thinning};

/// Selects, clips and merges points.
pub(crate) fn run(args: &PointsArgs, console: &Console) -> Result<Exit> {
    let files = inputs::expand(&args.inputs, console)?;
    let boundary = inputs::expand_layers(&args.boundary)?;
    let all: Vec<_> = files
        .iter()
        .chain(&boundary)
        .cloned()
        .chain(inputs::lists(&args.inputs))
        .collect();
    let several = || {
        Error::usage("several outputs are given, but points are read once")
            .cure("run it once for each output")
    };
    let request = PointsRequest {
        files,
        read: args.levels.of(args.read.options()),
        classes: ClassRange::all(&args.class),
        returns: ReturnRange::all(&args.returns),
        withheld: if args.drop_withheld {
            Withheld::Drop
        } else {
            Withheld::Keep
        },
        bounds: args.bounds.map(|corners| corners.bounds()),
        boundary,
        thinning: thinning(args)?,
        rounding: if args.round {
            Rounding::Nearest
        } else {
            Rounding::Refuse
        },
        systems: systems(&args.systems)?,
    };
    if let Some(size) = args.tile {
        let [folder] = args.output.output.as_slice() else {
            return Err(several());
        };
        let tiles = PointTiles {
            folder: folder.clone(),
            size,
            buffer: args.buffer.unwrap_or(PlanLength::Units(0.0)),
            flags_buffer: args.flag_buffer,
            existing: Existing::of(args.output.overwrite),
        };
        let (report, count) = write_point_tiles(&request, &tiles, &console.context())?;
        print(&report, console);
        console.line(format_args!(
            "tiles       {} in {}",
            counted(count as u64, "file"),
            folder.display()
        ));
        return Ok(Exit::Done);
    }
    let outputs = outputs::resolve(
        &args.output,
        &outputs::formats_of(Product::Points, |_| ())[..],
        &all,
    )?;
    let [target] = outputs.targets.as_slice() else {
        return Err(several());
    };
    let report = write_points(&request, target.within(&outputs.set), &console.context())?;
    print(&report, console);
    commit(outputs, console)?;
    Ok(Exit::Done)
}

/// Prints how many points were written, and why others were not.
fn print(report: &PointsReport, console: &Console) {
    let left_out = [
        (report.withheld, "withheld"),
        (report.other_class, "of other classes"),
        (report.other_return, "of other returns"),
        (report.outside, "outside"),
        (report.thinned, "thinned"),
    ];
    let left_out = left_out
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, why)| format!(", {count} {why}"));
    let left_out: String = left_out.collect();
    let count = counted(report.written.count, "point");
    console.line(format_args!(
        "points      {count} of {}{left_out}",
        report.read
    ));
    print_extent(report.written.bounds, report.crs.as_ref(), console);
}

fn thinning(args: &PointsArgs) -> Result<Option<Thinning>> {
    let Some(rule) = args.thin else {
        return Ok(None);
    };
    rule.0
        .with(args.thin_keep.map(CellPoint::from), args.seed)
        .map(Some)
}

use std::collections::BTreeMap;
use std::time::Instant;

use serde_json::{Map, Value, json};

use super::product::in_lines;
use crate::cli::Exit;
use crate::cli::input::args::{ClassRange, GroundArgs, ReturnRange};
use crate::cli::input::inputs;
use crate::cli::input::plan::system;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::summary::counted;
use crate::cli::report::written::print_file;
use crate::data::classes;
use crate::error::Result;
use crate::run::{self, Existing, GroundFile, GroundReport, GroundRequest};
use crate::terrain::ground::GroundOptions;

/// Writes files of points with the classes of a filter of the ground.
pub(crate) fn run(args: &GroundArgs, console: &Console) -> Result<Exit> {
    let start = Instant::now();
    let request = GroundRequest {
        files: inputs::expand(&args.inputs, console)?,
        from_classes: ClassRange::all(&args.from_class),
        returns: ReturnRange::all(&args.returns),
        options: GroundOptions {
            bridges: args.bridges.into(),
            noise: args.noise,
            ..GroundOptions::default()
        },
        memory: args.memory,
        crs: system("--a-srs", args.a_srs.as_deref())?,
    };
    let existing = Existing::of(args.overwrite);
    let report = run::write_ground(&request, &args.output, existing, &console.context())?;
    for line in lines_of(&report.files) {
        console.line(line);
    }
    for file in &report.files {
        print_file(&file.output, console);
    }
    if args.json {
        print(&in_lines(&json_of(&report, start)))?;
    }
    Ok(Exit::Done)
}

/// Returns a line for the points, and one for each class that points have, before or after.
fn lines_of(files: &[GroundFile]) -> Vec<String> {
    let sum = |of: fn(&GroundFile) -> &BTreeMap<u8, u64>| {
        let mut sums = BTreeMap::<u8, u64>::new();
        for (class, count) in files.iter().flat_map(of) {
            *sums.entry(*class).or_default() += count;
        }
        sums
    };
    let (before, after) = (sum(|file| &file.before), sum(|file| &file.after));
    let points: u64 = before.values().sum();
    let filtered: u64 = files.iter().map(|file| file.filtered).sum();
    let first = format!(
        "points      {} in {}, {filtered} filtered",
        counted(points, "point"),
        counted(files.len() as u64, "file")
    );
    let known: std::collections::BTreeSet<u8> =
        before.keys().chain(after.keys()).copied().collect();
    let of_class = known.into_iter().map(|class| {
        let count = |of: &BTreeMap<u8, u64>| of.get(&class).copied().unwrap_or_default();
        let name = classes::name(class.into());
        format!(
            "class {class:<5} {} ({name}), before {}",
            count(&after),
            count(&before)
        )
    });
    std::iter::once(first).chain(of_class).collect()
}

fn json_of(report: &GroundReport, start: Instant) -> Value {
    let by_class = |counts: &BTreeMap<u8, u64>| -> Map<String, Value> {
        let rows = counts.iter();
        rows.map(|(class, count)| (class.to_string(), (*count).into()))
            .collect()
    };
    let of_file = |file: &GroundFile| {
        json!({
            "path": file.path.display().to_string(),
            "output": file.output.display().to_string(),
            "points": file.points(),
            "filtered": file.filtered,
            "before": by_class(&file.before),
            "after": by_class(&file.after),
        })
    };
    json!({
        "files": report.files.iter().map(of_file).collect::<Vec<_>>(),
        "seconds": start.elapsed().as_secs_f64(),
    })
}

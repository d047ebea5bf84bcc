//! The facts about files, as text or as JSON.

mod layer;
mod mesh;
mod picture;
mod plane;
mod points;
mod raster;
mod sheet;

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use self::sheet::Sheet;
use crate::cli::Exit;
use crate::cli::input::args::InfoArgs;
use crate::cli::input::inputs;
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::{escape, names};
use crate::error::Result;
use crate::io::formats;
use crate::run::{self, Facts};

/// Prints what is in files. A file that cannot be read does not stop the others from being printed.
pub(crate) fn run(args: &InfoArgs, console: &Console) -> Result<Exit> {
    let mut files = inputs::expand(&args.files, console)?;
    drop_parts(&mut files, console);
    let options = args.levels.of(args.read.options());
    let mut exit = Exit::Done;
    let mut objects = Vec::new();
    for (i, path) in files.iter().enumerate() {
        let name = path.display().to_string();
        let sheet = match run::facts(path, options, &console.context()) {
            Ok(facts) => sheet(path, &facts),
            Err(error) => {
                console.error(&error.in_file(path));
                exit = Exit::Failed;
                continue;
            }
        };
        sheet.warnings.iter().for_each(|text| {
            console.warning(format_args!("{name}: {}", text.render(&names::name)))
        });
        if args.json {
            objects.push(sheet.to_json(&name));
        } else {
            let gap = if i > 0 { "\n" } else { "" };
            print(&format!("{gap}{}", sheet.to_text(&name)))?;
        }
    }
    if args.json {
        print(&escape::json(&format!(
            "{:#}\n",
            serde_json::Value::Array(objects)
        )))?;
    }
    Ok(exit)
}

/// Returns the facts about a file, and the warnings, as JSON.
pub(crate) fn as_json(path: &Path, facts: &Facts) -> serde_json::Value {
    sheet(path, facts).to_json(&path.display().to_string())
}

/// Removes files that belong to another of the files, such as the parts of shapefiles that
/// `FOLDER/*` matches; they are read with the `.shp`.
fn drop_parts(files: &mut Vec<PathBuf>, console: &Console) {
    // Names are compared in lower case: `A.SHP` has `A.DBF`.
    let lower = |path: &Path| path.to_string_lossy().to_lowercase();
    let mut parts: HashSet<String> = HashSet::new();
    for path in files.iter() {
        let extensions = formats::of_name(path).map_or(&[][..], |format| format.parts);
        parts.extend(
            extensions
                .iter()
                .map(|extension| lower(&path.with_extension(extension))),
        );
    }
    files.retain(|path| {
        let is_part = parts.contains(&lower(path));
        if is_part {
            console.detail(format_args!("{} is part of another file", path.display()));
        }
        !is_part
    });
}

fn sheet(path: &Path, facts: &Facts) -> Sheet {
    match facts {
        Facts::Points(facts) => points::sheet(facts),
        Facts::Layer(facts) => layer::sheet(facts),
        Facts::Raster(facts) => raster::sheet(facts),
        Facts::Mesh(facts) => mesh::sheet(path, facts),
        Facts::Solid(solid) => mesh::of_solid(solid),
        Facts::Picture(picture) => picture::sheet(picture),
        Facts::Plane(facts) => plane::sheet(path, facts),
    }
}

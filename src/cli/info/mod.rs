//! What is in files, told to people or to programs.

mod layer;
mod mesh;
mod points;
mod raster;
mod sheet;

use std::path::Path;

use self::sheet::Sheet;
use super::args::InfoArgs;
use super::open::{self, Content};
use super::talk::Talk;
use super::{Exit, inputs, print};
use crate::error::Result;

/// Tells what is in files. A file that cannot be read does not keep the others from being told.
pub(super) fn run(args: &InfoArgs, talk: &Talk) -> Result<Exit> {
    let files = inputs::expand(&args.files, talk)?;
    let mut exit = Exit::Done;
    let mut objects = Vec::new();
    for (i, path) in files.iter().enumerate() {
        let name = path.display().to_string();
        let sheet = match sheet(path, talk) {
            Ok(sheet) => sheet,
            Err(error) => {
                talk.error(&error.in_file(path));
                exit = Exit::Failed;
                continue;
            }
        };
        sheet.warnings.iter().for_each(|text| talk.warning(format_args!("{name}: {text}")));
        if args.json {
            objects.push(sheet.to_json(&name));
        } else {
            let gap = if i > 0 { "\n" } else { "" };
            print(&format!("{gap}{}", sheet.to_text(&name)))?;
        }
    }
    if args.json {
        print(&format!("{:#}\n", serde_json::Value::Array(objects)))?;
    }
    Ok(exit)
}

fn sheet(path: &Path, talk: &Talk) -> Result<Sheet> {
    match open::content(path) {
        Content::Points => points::sheet(path, talk),
        Content::Layer => layer::sheet(path),
        Content::Raster => raster::sheet(path),
        Content::Mesh => mesh::sheet(path),
    }
}

//! What is in files, told to people or to programs.

mod layer;
mod mesh;
mod points;
mod raster;
mod sheet;

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use self::sheet::Sheet;
use super::args::InfoArgs;
use super::open::{self, Content};
use super::talk::Talk;
use super::{Exit, escape, inputs, print};
use crate::error::Result;
use crate::io::points::Options;

/// Tells what is in files. A file that cannot be read does not keep the others from being told.
pub(super) fn run(args: &InfoArgs, talk: &Talk) -> Result<Exit> {
    let mut files = inputs::expand(&args.files, talk)?;
    drop_parts(&mut files, talk);
    let options = args.read.options();
    let mut exit = Exit::Done;
    let mut objects = Vec::new();
    for (i, path) in files.iter().enumerate() {
        let name = path.display().to_string();
        let sheet = match sheet(path, options, talk) {
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
        print(&escape::json(&format!("{:#}\n", serde_json::Value::Array(objects))))?;
    }
    Ok(exit)
}

/// `FOLDER/*` names the parts of shapefiles too; they are told with the `.shp`.
fn drop_parts(files: &mut Vec<PathBuf>, talk: &Talk) {
    const PARTS: [&str; 8] = ["shx", "dbf", "prj", "cpg", "qpj", "qix", "sbn", "sbx"];
    let shapefiles: HashSet<PathBuf> =
        files.iter().filter(|path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("shp"))).cloned().collect();
    files.retain(|path| {
        let is_part = path.extension().is_some_and(|e| PARTS.iter().any(|part| e.eq_ignore_ascii_case(part)))
            && ["shp", "SHP"].iter().any(|e| shapefiles.contains(&path.with_extension(e)));
        if is_part {
            talk.detail(format_args!("{} is part of a shapefile", path.display()));
        }
        !is_part
    });
}

fn sheet(path: &Path, options: Options, talk: &Talk) -> Result<Sheet> {
    match open::content(path) {
        Content::Points => points::sheet(path, options, talk),
        Content::Layer => layer::sheet(path),
        Content::Raster => raster::sheet(path),
        Content::Mesh => mesh::sheet(path),
    }
}

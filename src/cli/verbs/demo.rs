use std::ffi::OsString;
use std::io::Write;
use std::path::Path;

use crate::cli::Exit;
use crate::cli::input::args::{ConsoleArgs, DemoArgs};
use crate::cli::report::commands::quoted;
use crate::cli::report::console::Console;
use crate::error::{Error, Result};
use crate::io::Output;

/// The data that is part of the program, described in `fixtures/README.md`.
const FIXTURES: &[(&str, &[u8])] = &[
    ("valley.laz", include_bytes!("../../../fixtures/valley.laz")),
    (
        "breaklines.shp",
        include_bytes!("../../../fixtures/breaklines.shp"),
    ),
    (
        "breaklines.shx",
        include_bytes!("../../../fixtures/breaklines.shx"),
    ),
    (
        "breaklines.dbf",
        include_bytes!("../../../fixtures/breaklines.dbf"),
    ),
    (
        "breaklines.prj",
        include_bytes!("../../../fixtures/breaklines.prj"),
    ),
    (
        "breaklines.cpg",
        include_bytes!("../../../fixtures/breaklines.cpg"),
    ),
    (
        "boundary.shp",
        include_bytes!("../../../fixtures/boundary.shp"),
    ),
    (
        "boundary.shx",
        include_bytes!("../../../fixtures/boundary.shx"),
    ),
    (
        "boundary.dbf",
        include_bytes!("../../../fixtures/boundary.dbf"),
    ),
    (
        "boundary.prj",
        include_bytes!("../../../fixtures/boundary.prj"),
    ),
    (
        "boundary.cpg",
        include_bytes!("../../../fixtures/boundary.cpg"),
    ),
    ("dem.tif", include_bytes!("../../../fixtures/dem.tif")),
];

/// The commands of the demo; `@` stands for the folder.
const COMMANDS: &[&[&str]] = &[
    &[
        "info",
        "@valley.laz",
        "@breaklines.shp",
        "@boundary.shp",
        "@dem.tif",
    ],
    &[
        "tin",
        "@valley.laz",
        "--breaklines",
        "@breaklines.shp",
        "--boundary",
        "@boundary.shp",
        "-o",
        "@ground.ply",
        "-o",
        "@ground.obj",
        "--overwrite",
    ],
    &["check", "@ground.ply"],
    &[
        "dem",
        "@ground.ply",
        "--resolution",
        "0.5",
        "-o",
        "@ground.tif",
        "--overwrite",
    ],
    &[
        "hillshade",
        "@ground.ply",
        "--resolution",
        "0.5",
        "-o",
        "@hillshade.png",
        "--overwrite",
    ],
    &[
        "contour",
        "@ground.ply",
        "--interval",
        "2",
        "-o",
        "@contours.shp",
        "-o",
        "@contours.geojson",
        "--overwrite",
    ],
];

/// Writes the data and calls `run` with each command on it, as if it were typed.
pub(crate) fn run(
    args: &DemoArgs,
    how: &ConsoleArgs,
    console: &Console,
    run: &dyn Fn(Vec<OsString>) -> Exit,
) -> Result<Exit> {
    let folder = &args.folder;
    std::fs::create_dir_all(folder).map_err(|e| Error::from(e).in_file(folder))?;
    for (name, bytes) in FIXTURES {
        let path = folder.join(name);
        let mut output = Output::create(&path)?;
        output
            .write_all(bytes)
            .map_err(|e| Error::from(e).in_file(&path))?;
        output.commit()?;
    }
    console.line(format_args!(
        "The data of a small fictitious valley is in {}.",
        folder.display()
    ));
    for command in COMMANDS {
        let words: Vec<OsString> = command.iter().map(|word| in_folder(word, folder)).collect();
        let typed: Vec<String> = words
            .iter()
            .map(|word| quoted(&word.to_string_lossy()))
            .collect();
        console.line("");
        console.line(format_args!("$ breakline {}", typed.join(" ")));
        let exit = run([OsString::from("breakline")]
            .into_iter()
            .chain(words)
            .chain(flags(how))
            .collect());
        if exit != Exit::Done {
            return Ok(exit);
        }
    }
    console.line("");
    console.line(format_args!("All results are in {}.", folder.display()));
    Ok(Exit::Done)
}

fn in_folder(word: &str, folder: &Path) -> OsString {
    match word.strip_prefix('@') {
        Some(name) => folder.join(name).into_os_string(),
        None => word.into(),
    }
}

fn flags(how: &ConsoleArgs) -> Vec<OsString> {
    let mut flags: Vec<OsString> = Vec::new();
    if how.quiet {
        flags.push("--quiet".into());
    }
    if how.verbose {
        flags.push("--verbose".into());
    }
    flags
}

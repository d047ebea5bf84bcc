//! What shells and `man` know of the program: completions and pages.

use std::io::Write;
use std::path::Path;

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use crate::cli::Exit;
use crate::cli::input::args::{Cli, CompletionsArgs, ManArgs};
use crate::cli::report::console::Console;
use crate::cli::report::stdout::{Stdout, print};
use crate::cli::report::summary::counted;
use crate::error::{Error, Result};
use crate::io::{self, Output, OutputSet};

/// Prints completions for a shell.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<Exit> {
    let mut script = Vec::new();
    let mut program = Cli::command();
    clap_complete::generate(args.shell, &mut program, "breakline", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Done)
}

/// Writes the man pages, or prints that of the program.
pub(crate) fn man(args: &ManArgs, console: &Console) -> Result<Exit> {
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    let Some(folder) = &args.output else {
        let mut out = Stdout::new();
        let page = text_of(&page_of(&program))?;
        return match out.write_all(page.as_bytes()).and_then(|()| out.flush()) {
            Err(error) if !out.is_closed() => Err(error.into()),
            _ => Ok(Exit::Done),
        };
    };
    if folder.exists() && !folder.is_dir() {
        return Err(Error::usage("this is a file, and not a folder")
            .in_file(folder)
            .cure("name a folder for the pages"));
    }
    std::fs::create_dir_all(folder).map_err(|e| Error::from(e).in_file(folder))?;
    let mut pages = vec![page_of(&program)];
    add_pages(&program, &mut pages);
    let set = OutputSet::default();
    for page in &pages {
        write_page(
            page,
            &folder.join(page.get_filename()),
            args.overwrite,
            &set,
        )?;
    }
    let count = set.commit()?.len() as u64;
    console.line(format_args!(
        "written     {} in {}",
        counted(count, "page"),
        folder.display()
    ));
    Ok(Exit::Done)
}

fn page_of(command: &Command) -> Man {
    Man::new(command.clone())
        .source(concat!("breakline ", env!("CARGO_PKG_VERSION")))
        .manual("Terrain and GIS")
}

/// Returns the text of a page. Lines of examples and tables stay apart, as they are in the help.
fn text_of(page: &Man) -> std::io::Result<String> {
    let mut text = Vec::new();
    page.render(&mut text)?;
    let text = String::from_utf8_lossy(&text).into_owned();
    let Some((before, more)) = text.split_once("\n.SH EXTRA\n") else {
        return Ok(text);
    };
    let end = more.find("\n.SH ").unwrap_or(more.len());
    let (extra, after) = more.split_at(end);
    let extra = extra.trim_end();
    Ok(format!(
        "{before}\n.SH EXTRA\n.nf\n{extra}\n.fi\n{}",
        after.trim_start()
    ))
}

/// Adds a page for each verb, and for what is done with the object of a verb.
fn add_pages(command: &Command, pages: &mut Vec<Man>) {
    for verb in command.get_subcommands().filter(|verb| !verb.is_hide_set()) {
        pages.push(page_of(verb));
        add_pages(verb, pages);
    }
}

fn write_page(page: &Man, path: &Path, overwrite: bool, set: &OutputSet) -> Result<()> {
    if !overwrite {
        io::require_absent(path)?;
    }
    let mut output = Output::create(path)?;
    let written = text_of(page).and_then(|text| output.write_all(text.as_bytes()));
    written.map_err(|e| Error::from(e).in_file(path))?;
    set.add(output);
    Ok(())
}

//! Expansion of the inputs as typed to a list of files.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::cli::report::console::Console;
use crate::error::{Error, Result};
use crate::io::gdal;
use crate::io::layer::{self, Spec};
use crate::run::STDIN;
use crate::run::targets::{file_of, identity};

/// Returns the files that globs, lists and names stand for, in order. A file that is named twice is
/// used once, and a note says so.
///
/// # Errors
/// If a glob matches nothing, a list cannot be read or a file does not exist.
pub(crate) fn expand(typed: &[PathBuf], console: &Console) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for path in typed {
        match list_of(path) {
            Some(list) => read_list(list, &mut found)?,
            None => expand_one(path, &mut found)?,
        }
    }
    let mut seen = HashSet::new();
    found.retain(|path| {
        // The layers of a file are inputs of their own, and so are records that differ.
        let spec = path.to_str().and_then(|text| Spec::parse(text).ok());
        let part = spec.map(|spec| {
            let layer = spec.layer_of_several().map(str::to_owned);
            (layer, spec.condition.map(|chosen| chosen.text().to_owned()))
        });
        let is_new = seen.insert((identity(path), part));
        if !is_new {
            console.note(format_args!(
                "{} is named twice and used once",
                path.display()
            ));
        }
        is_new
    });
    if found.is_empty() {
        return Err(Error::usage("the input names no file"));
    }
    Ok(found)
}

/// Returns the lists of files among the inputs as typed; they are read, too.
pub(crate) fn lists(typed: &[PathBuf]) -> impl Iterator<Item = PathBuf> {
    typed
        .iter()
        .filter_map(|path| list_of(path))
        .map(Path::to_path_buf)
}

/// Returns the list that `@LIST` names, unless a file has that name.
fn list_of(path: &Path) -> Option<&Path> {
    let list = path.to_str()?.strip_prefix('@')?;
    (!path.exists()).then_some(Path::new(list))
}

/// Returns the files of lines and areas that globs and names stand for, in order; names of layers
/// and attributes may follow, as in `lines/*.shp:HEIGHT`.
///
/// # Errors
/// If a glob matches nothing, or a file does not exist.
pub(crate) fn expand_layers(typed: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    typed
        .iter()
        .try_for_each(|path| match (named_file(path), glob_of(path)) {
            (None, Some((pattern, names))) => expand_glob(pattern, names, &mut found),
            (None, None) => Err(no_such_file(path)),
            (Some(_), _) => {
                found.push(path.clone());
                Ok(())
            }
        })?;
    Ok(found)
}

/// Makes sure, before the work starts, that the file that an option names exists.
///
/// # Errors
/// If it does not.
pub(crate) fn require<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<()> {
    match paths.into_iter().find(|path| named_file(path).is_none()) {
        Some(path) => Err(no_such_file(path)),
        None => Ok(()),
    }
}

/// Returns the file that an input names, or the data set that only GDAL can open: whether that is
/// there is known once it is opened.
fn named_file(path: &Path) -> Option<&Path> {
    file_of(path).or_else(|| gdal::is_name(path).then_some(path))
}

#[cold]
fn no_such_file(path: &Path) -> Error {
    let error = Error::from(std::io::Error::new(
        std::io::ErrorKind::NotFound,
        "no such file",
    ))
    .in_file(path);
    match path
        .to_str()
        .is_some_and(|text| text.parse::<f64>().is_ok())
    {
        true => error.cure("separate several values of one option by commas, as in --class 2,8"),
        false => error,
    }
}

#[cold]
fn folder(path: &Path) -> Error {
    Error::from(std::io::Error::new(
        std::io::ErrorKind::IsADirectory,
        "this is a folder",
    ))
    .in_file(path)
    .cure(format!(
        "name the files in it, as in {}",
        path.join("*.laz").display()
    ))
}

fn read_list(list: &Path, found: &mut Vec<PathBuf>) -> Result<()> {
    let text = std::fs::read_to_string(list).map_err(|e| Error::from(e).in_file(list))?;
    let folder = list.parent().unwrap_or(Path::new(""));
    for (number, line) in (1..).zip(text.lines()) {
        let entry = line.split(" #").next().unwrap_or_default().trim();
        if entry.is_empty() || entry.starts_with('#') {
            continue;
        }
        expand_one(&in_folder(folder, entry), found).map_err(|e| match e.path() {
            // The missing file says more than the list that names it.
            Some(_) => e,
            None => e.in_file(list).at(format!("line {number}")),
        })?;
    }
    Ok(())
}

/// Returns the input that a file names which is in a folder. In the name of the folder, nothing
/// stands for other names.
pub(crate) fn in_folder(folder: &Path, input: &str) -> PathBuf {
    if gdal::is_name(input) {
        return gdal::without_secrets(input).into_owned().into();
    }
    let path = folder.join(input);
    match folder.to_str() {
        Some(text) if glob_of(folder).is_some() && file_of(&path).is_none() => {
            Path::new(&glob::Pattern::escape(text)).join(input)
        }
        _ => path,
    }
}

fn expand_one(path: &Path, found: &mut Vec<PathBuf>) -> Result<()> {
    if path.as_os_str() == STDIN || named_file(path).is_some() {
        // A folder with an extension may be a data set of GDAL, such as `.gdb`.
        if path.is_dir() && path.extension().is_none() {
            return Err(folder(path));
        }
        found.push(path.to_path_buf());
        return Ok(());
    }
    match glob_of(path) {
        Some((pattern, names)) => expand_glob(pattern, names, found),
        None => Err(no_such_file(path)),
    }
}

/// Splits an input that is not a file into a glob and the names that follow it, with their colons;
/// `None` if it is not a glob.
fn glob_of(path: &Path) -> Option<(&str, &str)> {
    let text = path.to_str()?;
    let pattern = layer::file_of(text).to_str()?;
    pattern
        .contains(['*', '?', '['])
        .then(|| (pattern, &text[pattern.len()..]))
}

/// Adds the files that a glob matches, each followed by these names.
fn expand_glob(pattern: &str, names: &str, found: &mut Vec<PathBuf>) -> Result<()> {
    let matches = glob::glob(pattern)
        .map_err(|e| Error::usage(format!("`{pattern}` is not a valid glob: {}", e.msg)))?;
    let before = found.len();
    for path in matches {
        let path = path.map_err(|e| {
            let path = e.path().to_path_buf();
            Error::from(std::io::Error::from(e)).in_file(path)
        })?;
        if path.is_file() {
            let mut named = path.into_os_string();
            named.push(names);
            found.push(named.into());
        }
    }
    if found.len() == before {
        let missing = std::io::Error::new(
            std::io::ErrorKind::NotFound,
            format!("no file matches `{pattern}`"),
        );
        return Err(Error::from(missing));
    }
    Ok(())
}

//! Where results go, checked before the work starts.

use std::path::{Path, PathBuf};

use super::args::OutputArgs;
use super::inputs::identity;
use super::plan::SurfacePlan;
use super::talk::Talk;
use crate::error::{Error, Result};

/// A file format that a verb can write.
#[derive(Debug)]
pub(super) struct Format<F: 'static> {
    pub(super) extension: &'static str,
    pub(super) kind: F,
    /// Extensions of the files that are written beside it.
    pub(super) companions: &'static [&'static str],
}

/// A file to write.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Target<F> {
    pub(super) path: PathBuf,
    pub(super) kind: F,
}

/// What becomes of a file that is in the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Existing {
    Keep,
    Replace,
}

impl Existing {
    pub(super) fn of(overwrite: bool) -> Self {
        if overwrite { Existing::Replace } else { Existing::Keep }
    }
}

const REPORTS: &[Format<()>] = &[Format { extension: "csv", kind: (), companions: &[] }];

/// Sorts the outputs by format and makes sure that nothing is lost that should stay.
///
/// # Errors
/// If an extension is not among the formats, an output is an input or named twice, its folder does
/// not exist, or it exists and may not be replaced.
pub(super) fn resolve<F: Copy>(
    args: &OutputArgs,
    formats: &'static [Format<F>],
    inputs: &[PathBuf],
) -> Result<Vec<Target<F>>> {
    let existing = Existing::of(args.overwrite);
    let mut targets: Vec<Target<F>> = Vec::new();
    for path in &args.output {
        let format = find(path, formats)?;
        if targets.iter().any(|target| target.path == *path) {
            return Err(Error::usage("the output is named twice").in_file(path));
        }
        require_free(path, format, existing, inputs)?;
        targets.push(Target { path: path.clone(), kind: format.kind });
    }
    Ok(targets)
}

/// The same for a verb that makes a surface, and reports its crossings where that is wished.
///
/// # Errors
/// As [`resolve`].
pub(super) fn resolve_with_report<F: Copy>(
    args: &OutputArgs,
    formats: &'static [Format<F>],
    plan: &SurfacePlan,
) -> Result<Vec<Target<F>>> {
    let targets = resolve(args, formats, &plan.inputs)?;
    if let Some(report) = plan.crossing_report().filter(|report| targets.iter().any(|target| target.path == **report)) {
        return Err(Error::usage("the output is named twice").in_file(report));
    }
    resolve_report(Existing::of(args.overwrite), plan)?;
    Ok(targets)
}

/// The same for the report of crossings alone.
///
/// # Errors
/// As [`resolve`].
pub(super) fn resolve_report(existing: Existing, plan: &SurfacePlan) -> Result<()> {
    match plan.crossing_report() {
        Some(report) => require_free(report, find(report, REPORTS)?, existing, &plan.inputs),
        None => Ok(()),
    }
}

/// Makes sure that a file and what is written beside it can be written without a loss.
fn require_free<F>(path: &Path, format: &Format<F>, existing: Existing, inputs: &[PathBuf]) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let missing = std::io::Error::new(std::io::ErrorKind::NotFound, "the folder does not exist");
        return Err(Error::from(missing).in_file(path).cure(format!("mkdir -p {}", folder.display())));
    }
    for file in with_companions(path, format) {
        if inputs.iter().any(|input| identity(input) == identity(&file)) {
            return Err(Error::usage("the output is one of the inputs").in_file(&file).cure("give it another name"));
        }
        if file.exists() && existing == Existing::Keep {
            let exists = std::io::Error::new(std::io::ErrorKind::AlreadyExists, "the file exists");
            return Err(Error::from(exists).in_file(&file).cure("give it another name, or add --overwrite"));
        }
    }
    Ok(())
}

/// The file that is written to a target, and those that come with it.
pub(super) fn files_of<F>(path: &Path, formats: &[Format<F>]) -> Vec<PathBuf> {
    find(path, formats).map_or_else(|_| vec![path.to_path_buf()], |format| with_companions(path, format))
}

fn with_companions<F>(path: &Path, format: &Format<F>) -> Vec<PathBuf> {
    let beside = format.companions.iter().map(|extension| path.with_extension(extension));
    std::iter::once(path.to_path_buf()).chain(beside).collect()
}

fn find<'a, F>(path: &Path, formats: &'a [Format<F>]) -> Result<&'a Format<F>> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    formats.iter().find(|format| format.extension.eq_ignore_ascii_case(extension)).ok_or_else(|| {
        let known: Vec<String> = formats.iter().map(|format| format!(".{}", format.extension)).collect();
        let found = match extension {
            "" => "the output has no extension to tell its format by".to_owned(),
            _ => format!("`.{extension}` is no format that can be written here"),
        };
        Error::usage(found).in_file(path).cure(format!("use one of {}", known.join(", ")))
    })
}

/// Says what was written.
pub(super) fn tell<F>(targets: &[Target<F>], talk: &Talk) {
    targets.iter().for_each(|target| tell_file(&target.path, talk));
}

/// The same of one file.
pub(super) fn tell_file(file: &Path, talk: &Talk) {
    let path = file.display();
    match std::fs::metadata(file) {
        Ok(data) => talk.line(format_args!("written     {path} ({} kB)", data.len().div_ceil(1000))),
        Err(_) => talk.line(format_args!("written     {path}")),
    }
}

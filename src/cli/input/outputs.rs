//! The files of results, checked before the work starts.

use std::path::{Path, PathBuf};

use super::args::OutputArgs;
use crate::error::Result;
use crate::io::formats::with_companions;
use crate::run::targets;
pub(crate) use crate::run::targets::{Format, Formats, formats_of};
pub(crate) use crate::run::{Existing, Outputs, Target};

/// Finds the format of each output and makes sure that no file is lost that should be kept.
///
/// # Errors
/// If an extension is not among the formats, an output is an input or named twice, its folder does
/// not exist, or it exists and may not be replaced.
pub(crate) fn resolve<'f, F: Copy + 'static>(
    args: &OutputArgs,
    formats: impl Into<Formats<'f, F>>,
    inputs: &[PathBuf],
) -> Result<Outputs<F>> {
    let existing = Existing::of(args.overwrite);
    let may_replace = |_: &Path| existing == Existing::Replace;
    targets::resolve(&args.output, &may_replace, &formats.into(), inputs)
}

/// Returns the companions of a target, then the target itself.
pub(crate) fn files_of<F: Copy>(target: &Target<F>) -> Vec<Target<F>> {
    let mut files = with_companions(&target.path, target.extension, target.companions);
    files.rotate_left(1);
    files
        .into_iter()
        .map(|(path, extension)| Target {
            path,
            kind: target.kind,
            extension,
            companions: &[],
            driver: None,
        })
        .collect()
}

//! Captures the messages of GDAL, per thread, because GDAL prints details to stderr and returns
//! little.

use std::cell::RefCell;
use std::path::Path;
use std::sync::Once;

use gdal::errors::{CplErrType, GdalError};

use super::names::{hidden, is_name};
use crate::error::{Error, Kind, Wording};

thread_local! {
    static CAUGHT: RefCell<Vec<(bool, String)>> = const { RefCell::new(Vec::new()) };
}

/// Limit for the captured messages; more of the same do not help.
const KEPT: usize = 16;

/// Starts to capture, and discards what this thread has captured before.
pub(super) fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Nothing is written beside inputs.
        let _ = gdal::config::set_config_option("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO");
        gdal::config::set_error_handler(|class, _, text| {
            let is_error = matches!(class, CplErrType::Failure | CplErrType::Fatal);
            if matches!(class, CplErrType::None | CplErrType::Debug) {
                return;
            }
            CAUGHT.with_borrow_mut(|caught| {
                // Some have several lines.
                let text: Vec<&str> = text.split_whitespace().collect();
                let message = (is_error, hidden(&text.join(" ")).into_owned());
                if caught.len() < KEPT && !caught.contains(&message) {
                    caught.push(message);
                }
            });
        });
    });
    CAUGHT.with_borrow_mut(Vec::clear);
}

/// Returns the first error captured since [`listen`].
pub(super) fn failure(path: &Path) -> Option<Error> {
    let text = CAUGHT.with_borrow(|caught| {
        caught
            .iter()
            .find(|message| message.0)
            .map(|message| message.1.clone())
    })?;
    Some(Error::format(format!("GDAL: {text}")).in_file(path))
}

/// Returns the warnings captured since [`listen`].
pub(super) fn warnings() -> Vec<Wording> {
    CAUGHT.with_borrow(|caught| {
        caught
            .iter()
            .filter(|message| !message.0)
            .map(|message| format!("GDAL: {}", message.1).into())
            .collect()
    })
}

/// Returns the error of a driver that could not write, if one was captured since [`listen`].
/// `hidden` is the path that GDAL knows, `target` where the output will appear.
pub(super) fn refusal(hidden: &Path, target: &Path) -> Option<Error> {
    let text = CAUGHT.with_borrow(|caught| {
        let error = caught.iter().find(|message| message.0)?;
        Some(shown(&error.1, hidden, target))
    })?;
    Some(Error::unsupported(format!("GDAL: {text}")).in_file(target))
}

/// Returns the texts of the warnings captured since [`listen`], while a driver wrote.
pub(super) fn warning_texts(hidden: &Path, target: &Path) -> Vec<String> {
    CAUGHT.with_borrow(|caught| {
        let warnings = caught.iter().filter(|message| !message.0);
        warnings
            .map(|message| format!("GDAL: {}", shown(&message.1, hidden, target)))
            .collect()
    })
}

/// Returns a message in which the path of an output is the one that it will have.
fn shown(text: &str, hidden: &Path, target: &Path) -> String {
    let hidden = hidden.to_string_lossy();
    match hidden.is_empty() {
        true => text.to_owned(),
        false => text.replace(&*hidden, &target.to_string_lossy()),
    }
}

/// Returns the error for one returned by GDAL, preferring the captured message, which says more.
pub(super) fn error(path: &Path, error: GdalError) -> Error {
    failure(path).unwrap_or_else(|| Error::caused_by(Kind::Format, error).in_file(path))
}

/// Returns the error for a file that cannot be opened, usually because it does not exist or GDAL
/// has no driver for it.
pub(super) fn cannot_open(path: &Path, what: &str, returned: GdalError) -> Error {
    if let Err(reason) = std::fs::metadata(path)
        && !is_name(path)
    {
        return Error::from(reason).in_file(path);
    }
    match failure(path) {
        Some(error) if is_name(path) => error.cure(
            "`gdalinfo` or `ogrinfo` shows what GDAL finds there; only rasters and layers have \
             such names",
        ),
        Some(error) => error,
        None => match returned {
            GdalError::NullPointer { .. } => {
                Error::unsupported(format!("not a {what} format that GDAL reads here"))
                    .in_file(path)
            }
            other => Error::caused_by(Kind::Format, other).in_file(path),
        },
    }
}

//! GDAL prints to stderr and returns little: its messages are caught here, thread by thread.

use std::cell::RefCell;
use std::path::Path;
use std::sync::Once;

use gdal::errors::{CplErrType, GdalError};

use crate::error::{Error, Kind};

thread_local! {
    static CAUGHT: RefCell<Vec<(bool, String)>> = const { RefCell::new(Vec::new()) };
}

/// More of the same helps nobody.
const KEPT: usize = 16;

/// Starts to listen, and forgets what this thread has caught.
pub(super) fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        gdal::config::set_error_handler(|class, _, text| {
            let is_error = matches!(class, CplErrType::Failure | CplErrType::Fatal);
            if matches!(class, CplErrType::None | CplErrType::Debug) {
                return;
            }
            CAUGHT.with_borrow_mut(|caught| {
                let message = (is_error, text.trim().to_owned());
                if caught.len() < KEPT && !caught.contains(&message) {
                    caught.push(message);
                }
            });
        });
    });
    CAUGHT.with_borrow_mut(Vec::clear);
}

/// The first error caught since [`listen`], as ours.
pub(super) fn failure(path: &Path) -> Option<Error> {
    let text = CAUGHT.with_borrow(|caught| caught.iter().find(|message| message.0).map(|message| message.1.clone()))?;
    Some(Error::format(format!("GDAL: {text}")).in_file(path))
}

/// The warnings caught since [`listen`].
pub(super) fn warnings() -> Vec<String> {
    CAUGHT.with_borrow(|caught| {
        caught.iter().filter(|message| !message.0).map(|message| format!("GDAL: {}", message.1)).collect()
    })
}

/// An error that GDAL returned; what it said of it before is more telling.
pub(super) fn error(path: &Path, error: GdalError) -> Error {
    failure(path).unwrap_or_else(|| Error::caused_by(Kind::Format, error).in_file(path))
}

/// An error while opening: most often GDAL has no driver for the file, or there is none.
pub(super) fn cannot_open(path: &Path, what: &str, returned: GdalError) -> Error {
    // What is no file may still be a subdataset ("NETCDF:file.nc:z") or a connection.
    if let Err(reason) = std::fs::metadata(path)
        && !path.to_string_lossy().contains(':')
    {
        return Error::from(reason).in_file(path);
    }
    match failure(path) {
        Some(error) => error,
        None => match returned {
            GdalError::NullPointer { .. } => {
                Error::unsupported(format!("not a {what} format that GDAL reads here")).in_file(path)
            }
            other => Error::caused_by(Kind::Format, other).in_file(path),
        },
    }
}

//! Whether work was canceled.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::{Error, Result};

/// Returns an error if the work was canceled.
///
/// # Errors
/// [`Error::canceled`], if `cancel` is true.
pub(super) fn go_on(cancel: &AtomicBool) -> Result<()> {
    match cancel.load(Ordering::Relaxed) {
        true => Err(Error::canceled()),
        false => Ok(()),
    }
}

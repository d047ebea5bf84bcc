//! What the integration tests share.
#![allow(dead_code, unreachable_pub)]

pub(crate) mod case;
pub(crate) mod cells;
pub(crate) mod judge;
pub(crate) mod picture;
pub(crate) mod random;
pub(crate) mod subject;

use std::path::{Path, PathBuf};

/// A file of the shared data folder, beside the repository; `None`, said plainly, when it is absent.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let full = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(path);
    if full.exists() {
        return Some(full);
    }
    eprintln!("skipped: {path} is not here (the shared data folder is absent)");
    None
}

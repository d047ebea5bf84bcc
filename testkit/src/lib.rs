//! What the integration tests share.

pub mod case;
pub mod cells;
pub mod judge;
pub mod picture;
pub mod random;
pub mod subject;

use std::path::{Path, PathBuf};

/// A file of the shared data folder, beside the repository.
///
/// Tests that ask for one are marked, so that they are counted as ignored where the folder is absent (`build.rs` looks):
/// `#[cfg_attr(not(has_shared), ignore = "needs ../shared")]`.
#[track_caller]
pub fn shared(path: &str) -> PathBuf {
    let full = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(path);
    assert!(full.exists(), "../shared/data has no {path}; tests that need it are to be marked, see `shared`");
    full
}

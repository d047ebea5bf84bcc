//! What the integration tests share.

pub mod boxes;
pub mod case;
pub mod cells;
pub mod copc;
pub mod judge;
pub mod lidar;
pub mod picture;
pub mod random;
pub mod subject;

use std::path::{Path, PathBuf};

/// Returns the path of a file in the shared data folder, next to the repository.
///
/// Tests that need one are marked, so that they are counted as ignored where the folder is absent
/// (`build.rs` checks): `#[cfg_attr(not(has_shared), ignore = "needs ../shared")]`.
#[track_caller]
pub fn shared(path: &str) -> PathBuf {
    let full = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared/data")
        .join(path);
    assert!(
        full.exists(),
        "../shared/data has no {path}; tests that need it are to be marked, see `shared`"
    );
    full
}

//! Makes the fixtures: `cargo run --release --example make_fixtures -- fixtures`.
//!
//! A little valley with a stream, a road with kerbs, a lake and a cliff, as lidar, breaklines, a
//! boundary and a raster. The same bytes every time. They are written by the crates that everybody
//! uses and by nothing of breakline, so that a mistake in a writer here cannot hide a mistake in
//! the reader for the same format.

mod fixtures;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(
        std::env::args_os()
            .nth(1)
            .ok_or("usage: make_fixtures FOLDER")?,
    );
    std::fs::create_dir_all(&folder)?;
    for (name, bytes) in fixtures::files()? {
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}

//! Makes lidar of any size, in tiles: `cargo run --release --features bench --example make_lidar --
//! FOLDER POINTS SIDE` writes SIDE by SIDE files of LAZ. For measurements of what does not fit into
//! memory, see `docs/scale.md`.

mod landscape;

use std::path::PathBuf;

fn main() -> Result<(), landscape::Failure> {
    const USAGE: &str = "usage: make_lidar FOLDER POINTS SIDE";
    let mut args = std::env::args_os().skip(1);
    let folder = PathBuf::from(args.next().ok_or(USAGE)?);
    let mut number = || {
        args.next()
            .and_then(|text| text.to_str()?.replace('_', "").parse::<u64>().ok())
    };
    let (points, side) = (number().ok_or(USAGE)?, number().ok_or(USAGE)?);
    if side == 0 || side > 1000 || points < side * side {
        return Err(USAGE.into());
    }
    landscape::write(&folder, points, side)
}

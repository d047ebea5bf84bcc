use crate::cli::input::args::TileArgs;
use crate::run::{Targets, WriteRequest};

/// What a verb asks for that writes what it makes of a surface.
#[derive(Debug)]
pub(super) struct Asked {
    pub(super) request: WriteRequest,
    pub(super) targets: Targets,
    pub(super) tiles: TileArgs,
}

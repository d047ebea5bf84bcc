//! Points that are thinned while they are read.

use std::path::PathBuf;

use crate::data::PointBatch;
use crate::error::Result;
use crate::run::context::memory;
use crate::run::request::input::is_read_once;
use crate::terrain::{Passes, Thinner, Thinning};

/// The free memory is checked each time that so many further bytes are held.
const ASK_EVERY: usize = 1 << 26;

/// A thinner that is watched for the memory that it uses.
pub(super) struct Thinned {
    thinner: Thinner,
    asked_at: usize,
}

impl Thinned {
    /// Creates a thinner for the points of files, some of which may be readable only once.
    pub(super) fn new(thinning: Thinning, files: &[PathBuf]) -> Result<Self> {
        let passes = if files.iter().any(|path| is_read_once(path)) {
            Passes::One
        } else {
            Passes::Several
        };
        Ok(Thinned {
            thinner: Thinner::new(thinning, passes)?,
            asked_at: 0,
        })
    }

    /// See [`Thinner::choose`].
    pub(super) fn choose(&mut self, file: usize, batch: &mut PointBatch) -> Result<()> {
        self.thinner.choose(file, batch)?;
        let bytes = self.thinner.bytes();
        if bytes >= self.asked_at + ASK_EVERY {
            // A list that grows may double.
            memory::require_for_held(bytes)?;
            self.asked_at = bytes;
        }
        Ok(())
    }

    /// See [`Thinner::end_pass`].
    pub(super) fn end_pass(&mut self) -> bool {
        self.thinner.end_pass()
    }

    /// See [`Thinner::held`].
    pub(super) fn held(&mut self) -> impl Iterator<Item = (usize, PointBatch)> {
        self.thinner.held()
    }
}

use super::las::{Cut, Detail, ReadOptions};
use crate::data::Columns;

/// How points are read, where a file leaves that open.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// The columns of text; without them a header or the first three are taken.
    pub columns: Option<Columns>,
    /// What becomes of LAS and LAZ files that were cut.
    pub cut: Cut,
    /// What is read of points of LAS and LAZ.
    pub detail: Detail,
}

impl Options {
    /// The part that is for LAS and LAZ.
    pub(super) fn las(self) -> ReadOptions {
        ReadOptions { cut: self.cut, detail: self.detail }
    }
}

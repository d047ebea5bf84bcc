use super::las::Cut;
use crate::data::Columns;

/// How points are read, where a file leaves that open.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// The columns of text; without them a header or the first three are taken.
    pub columns: Option<Columns>,
    /// What becomes of LAS and LAZ files that were cut.
    pub cut: Cut,
}

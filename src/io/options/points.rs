use super::cut::OnDamage;
use super::las::{Detail, ReadOptions};
use crate::data::Columns;

/// How points are read where a file leaves that open.
#[derive(Debug, Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
pub struct Options {
    /// The columns of text; if `None`, a header or the first three columns are used.
    pub columns: Option<Columns>,
    /// What to do with files of which a part is missing or damaged.
    pub cut: OnDamage,
    /// How much is read of each point of LAS and LAZ.
    pub detail: Detail,
    /// Of files with an octree (COPC), only the coarse levels are read: to the first one on which
    /// points are at most so far apart, and those above it. It is an error if a file has none.
    pub resolution: Option<f64>,
}

impl Options {
    /// Returns the options for LAS and LAZ.
    pub(crate) fn las(self) -> ReadOptions {
        ReadOptions {
            cut: self.cut,
            detail: self.detail,
        }
    }
}

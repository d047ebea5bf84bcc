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
    /// The largest distance between points on the finest level of an octree (COPC) that is read, in
    /// the unit of the file; coarser levels are read as well. `None` reads all levels. A file
    /// without an octree is then an error.
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

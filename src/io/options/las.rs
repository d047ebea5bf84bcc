use super::cut::OnDamage;

/// How a LAS or LAZ file is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReadOptions {
    /// What to do with a file that was cut short.
    pub cut: OnDamage,
    /// How much is read of each point.
    pub detail: Detail,
}

impl From<OnDamage> for ReadOptions {
    fn from(cut: OnDamage) -> Self {
        ReadOptions {
            cut,
            ..Self::default()
        }
    }
}

/// How much is read of each point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Detail {
    /// Coordinates, class, flags, and which return of its pulse each point is. Compressed points of
    /// formats 6 to 10 are then only partly decoded.
    #[default]
    Columns,
    /// The columns, and also the whole [record](crate::data::PointBatch::records) of each point,
    /// with the [head](crate::data::PointInfo::head) of the file.
    Records,
}

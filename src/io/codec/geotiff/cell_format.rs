//! How cells are stored in a written raster.

/// The stored value for a missing height.
pub(super) const NO_HEIGHT: f32 = -9999.0;

/// What the cells of a raster contain, and how they are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CellFormat {
    /// Heights: Float32, predictor 3; nodata is -9999, so a height of exactly -9999 reads back as
    /// nodata.
    #[default]
    Heights,
    /// Shades: one byte, 1 to 255, predictor 2; nodata is 0. Values are rounded and clamped.
    Shades,
}

impl CellFormat {
    /// Returns the bits of a cell.
    pub(super) fn bits(self) -> u16 {
        match self {
            CellFormat::Heights => 32,
            CellFormat::Shades => 8,
        }
    }

    /// Returns the value that a cell will have when read back; NaN if that is nodata.
    pub(super) fn written(self, cell: f32) -> f32 {
        match self {
            _ if !cell.is_finite() => f32::NAN,
            CellFormat::Heights if cell == NO_HEIGHT => f32::NAN,
            CellFormat::Heights => cell,
            CellFormat::Shades => cell.round().clamp(1.0, 255.0),
        }
    }
}

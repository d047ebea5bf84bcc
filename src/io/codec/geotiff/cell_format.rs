//! How cells are stored in a written raster.

use super::directory::Values;
use super::tags;
use crate::data::Colors;

/// The stored value for a missing height.
pub(super) const NO_HEIGHT: f32 = -9999.0;

/// What the cells of a raster contain, and how they are stored.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum CellFormat<'a> {
    /// Heights: Float32, predictor 3; nodata is -9999, so a height of exactly -9999 reads back as
    /// nodata.
    #[default]
    Heights,
    /// Shades: one byte, 1 to 255, predictor 2; nodata is 0. Values are rounded and clamped.
    Shades,
    /// The colors of heights: red, green, blue and opacity, a byte each, predictor 2. There are no
    /// overviews: the mean of several cells may have no color of the ramp.
    Colors(&'a Colors),
}

impl CellFormat<'_> {
    /// Returns the samples of a cell, which are stored together.
    pub(super) fn samples(self) -> usize {
        match self {
            CellFormat::Heights | CellFormat::Shades => 1,
            CellFormat::Colors(_) => 4,
        }
    }

    /// Returns the bits of a sample.
    fn sample_bits(self) -> u16 {
        match self {
            CellFormat::Heights => 32,
            CellFormat::Shades | CellFormat::Colors(_) => 8,
        }
    }

    /// Returns the bytes of a cell.
    pub(super) fn cell_bytes(self) -> usize {
        self.samples() * usize::from(self.sample_bits() / 8)
    }

    /// Returns true if a large raster has overviews.
    pub(super) fn has_overviews(self) -> bool {
        !matches!(self, CellFormat::Colors(_))
    }

    /// Returns true if cells without a value are stored: a ramp may have a color for them.
    pub(super) fn stores_missing(self) -> bool {
        match self {
            CellFormat::Heights | CellFormat::Shades => false,
            CellFormat::Colors(colors) => colors.of(f32::NAN) != [0; 4],
        }
    }

    /// Returns the value that a cell will have when read back, or the height that it has a color
    /// of; NaN if that is nodata.
    pub(super) fn written(self, cell: f32) -> f32 {
        match self {
            _ if !cell.is_finite() => f32::NAN,
            CellFormat::Heights if cell == NO_HEIGHT => f32::NAN,
            CellFormat::Heights | CellFormat::Colors(_) => cell,
            CellFormat::Shades => cell.round().clamp(1.0, 255.0),
        }
    }

    /// Returns the tags that say how cells are stored, by their numbers.
    pub(super) fn tags(self) -> Vec<(u16, Values)> {
        let each = |value: u16| Values::Short(vec![value; self.samples()]);
        let one = |value: u16| Values::Short(vec![value]);
        // BlackIsZero, RGB; unsigned integers, floating point.
        let (photometric, predictor, sample_format) = match self {
            CellFormat::Heights => (1, 3, 3),
            CellFormat::Shades => (1, 2, 1),
            CellFormat::Colors(_) => (2, 2, 1),
        };
        let mut all = vec![
            (tags::BITS_PER_SAMPLE, each(self.sample_bits())),
            (tags::PHOTOMETRIC, one(photometric)),
            (tags::SAMPLES_PER_PIXEL, one(self.samples() as u16)),
            (tags::PLANAR_CONFIGURATION, one(1)),
            (tags::PREDICTOR, one(predictor)),
            (tags::SAMPLE_FORMAT, each(sample_format)),
        ];
        match self {
            CellFormat::Heights => {
                all.push((tags::GDAL_NODATA, Values::Text(format!("{NO_HEIGHT}"))));
            }
            CellFormat::Shades => all.push((tags::GDAL_NODATA, Values::Text("0".to_owned()))),
            // Opacity, by which colors are not multiplied.
            CellFormat::Colors(_) => all.push((tags::EXTRA_SAMPLES, one(2))),
        }
        all
    }
}

//! Numbers in the cells of a table.

use crate::triangulation::num::unsigned_zero;

/// Width of a field for lengths and heights. The text in it is the shortest that reads back as the
/// same number, which always fits.
pub(super) const NUMBER_WIDTH: u8 = 24;

/// The decimals that the header of the field states and programs display, at least. Readers use the
/// text as it is, so a number that needs more decimals has them.
pub(super) const NUMBER_DECIMALS: u8 = 6;

/// The decimals that a header states, at most: what GDAL gives fields of this width.
const MOST_DECIMALS: usize = 15;

/// Returns the decimals to state for a field with these numbers.
pub(super) fn decimals(values: impl Iterator<Item = f64>) -> u8 {
    let of = |value: f64| {
        let text = value.to_string();
        text.split_once('.').map_or(0, |(_, digits)| digits.len())
    };
    let most = values.map(of).max().unwrap_or(0).min(MOST_DECIMALS);
    NUMBER_DECIMALS.max(most as u8)
}

/// Returns the shortest text that reads back as the same number; blank for NaN.
pub(super) fn real(value: f64) -> String {
    let width = usize::from(NUMBER_WIDTH);
    if !value.is_finite() {
        return " ".repeat(width);
    }
    let mut text = unsigned_zero(value).to_string();
    if text.len() > width {
        // At most 24 characters: 17 digits with their point, two signs, the e and three digits.
        text = format!("{value:e}");
    }
    format!("{text:>width$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_and_fit() {
        for value in [
            0.0,
            12.3,
            -0.1,
            678.3,
            1e-300,
            -1.234_567_890_123_456_7e-308,
            1e22,
            1e23,
            f64::MAX,
            f64::MIN,
            1.0 / 3.0,
        ] {
            let text = real(value);
            assert_eq!((text.len(), text.trim().parse()), (24, Ok(value)), "{text}");
        }
        assert_eq!(decimals([1.5, 0.0].into_iter()), NUMBER_DECIMALS);
        assert_eq!(decimals([1.5, 1.234_567_8].into_iter()), 7);
        assert_eq!(decimals([1.0 / 3.0, 1e-300].into_iter()), 15);
        assert_eq!(real(-0.0).trim(), "0");
        assert_eq!(real(f64::NAN), " ".repeat(24));
    }
}

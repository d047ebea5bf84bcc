//! Numbers in the cells of a table.

use crate::triangulation::num::unsigned_zero;

/// Width of a field for lengths and heights. The text in it is the shortest that reads back as the
/// same number, which always fits.
pub(super) const NUMBER_WIDTH: u8 = 24;

/// The decimals that the header of the field states and programs display. Readers use the text as
/// it is, so a number that needs more decimals has them.
pub(super) const NUMBER_DECIMALS: u8 = 6;

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
        assert_eq!(real(-0.0).trim(), "0");
        assert_eq!(real(f64::NAN), " ".repeat(24));
    }
}

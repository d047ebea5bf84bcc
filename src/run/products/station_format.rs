//! How stations are written.

use std::fmt;
use std::str::FromStr;

/// How a distance along an axis is written.
///
/// Parsed from an example of zeros: `0+000` writes 1250 as `1+250`, `0+00.0` as `12+50.0`, `0.00`
/// as `1250.00`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StationFormat {
    /// The digits between the plus and the decimal point; without a plus, 0.
    digits: u32,
    /// The decimals; `None` for as many as needed, at most three.
    decimals: Option<usize>,
}

/// Thousands, as along roads: `1+250`.
impl Default for StationFormat {
    fn default() -> Self {
        StationFormat {
            digits: 3,
            decimals: None,
        }
    }
}

/// The digits after the plus and the decimals, at most.
const MOST: usize = 9;

impl FromStr for StationFormat {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("`{text}` is not an example of a station, such as 0+000, 0+00.00 or 0.0");
        let zeros = |part: &str| {
            let is_zeros = part.len() <= MOST && part.chars().all(|c| c == '0');
            is_zeros.then_some(part.len())
        };
        let (whole, decimals) = match text.trim().split_once('.') {
            Some((whole, decimals)) => (whole, Some(decimals)),
            None => (text.trim(), None),
        };
        let decimals = match decimals {
            Some(part) => Some(zeros(part).filter(|count| *count > 0).ok_or_else(wrong)?),
            None => None,
        };
        let (before, digits) = match whole.split_once('+') {
            Some((before, after)) => {
                let digits = zeros(after).filter(|count| *count > 0);
                (before, digits.ok_or_else(wrong)? as u32)
            }
            None => (whole, 0),
        };
        match before {
            "0" => Ok(StationFormat { digits, decimals }),
            _ => Err(wrong()),
        }
    }
}

/// Formats as the example from which it is parsed; the default is `0+000`.
impl fmt::Display for StationFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("0")?;
        if self.digits > 0 {
            write!(f, "+{}", "0".repeat(self.digits as usize))?;
        }
        match self.decimals {
            Some(decimals) => write!(f, ".{}", "0".repeat(decimals)),
            None => Ok(()),
        }
    }
}

impl StationFormat {
    /// Returns the distance that a text with a plus states, in whatever format: 1250 for `1+250`
    /// and for `12+50`. `None` for any other text.
    pub fn distance(text: &str) -> Option<f64> {
        let (sign, digits) = match text.strip_prefix('-') {
            Some(digits) => (-1.0, digits),
            None => (1.0, text),
        };
        let (before, after) = digits.split_once('+')?;
        let (whole, fraction) = after.split_once('.').unwrap_or((after, "0"));
        let are_digits = |part: &&str| {
            !part.is_empty() && part.len() <= MOST && part.bytes().all(|c| c.is_ascii_digit())
        };
        let is_station = [before, whole, fraction].iter().all(are_digits);
        let number = format!("{before}{whole}.{fraction}");
        is_station
            .then(|| number.parse().ok())?
            .map(|at: f64| sign * at)
    }

    /// Returns a distance as text.
    pub fn text(&self, distance: f64) -> String {
        let decimals = self.decimals.unwrap_or(3);
        let rounded = format!("{:.decimals$}", distance.abs());
        let (whole, fraction) = rounded.split_once('.').unwrap_or((&rounded, ""));
        let fraction = match self.decimals {
            Some(_) => fraction,
            None => fraction.trim_end_matches('0'),
        };
        let is_zero = !rounded.chars().any(|c| c.is_ascii_digit() && c != '0');
        let sign = if distance < 0.0 && !is_zero { "-" } else { "" };
        let digits = self.digits as usize;
        let whole = if digits > 0 {
            let padded = format!("{whole:0>width$}", width = digits + 1);
            let (before, after) = padded.split_at(padded.len() - digits);
            format!("{before}+{after}")
        } else {
            whole.to_owned()
        };
        match fraction {
            "" => format!("{sign}{whole}"),
            _ => format!("{sign}{whole}.{fraction}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stations_are_written_like_their_example() {
        for (example, distance, text) in [
            ("0+000", 0.0, "0+000"),
            ("0+000", 1250.0, "1+250"),
            ("0+000", 12.5, "0+012.5"),
            ("0+000", 1e6 + 0.1 + 0.2, "1000+000.3"),
            ("0+000", -50.0, "-0+050"),
            ("0+000", -0.0, "0+000"),
            ("0+000", -1e-9, "0+000"),
            ("0+000.00", 999.999, "1+000.00"),
            ("0+00", 1250.0, "12+50"),
            ("0.0", 1250.04, "1250.0"),
            ("0", 7.25, "7.25"),
        ] {
            let format: StationFormat = example.parse().unwrap();
            assert_eq!(format.text(distance), text, "{example}");
            if example.contains('+') {
                let read = StationFormat::distance(text).unwrap();
                assert_eq!(format.text(read), text, "{example}");
            }
            assert_eq!(format.to_string(), example);
        }
        assert_eq!(StationFormat::default(), "0+000".parse().unwrap());
        for (text, distance) in [
            ("1+250", 1250.0),
            ("12+50", 1250.0),
            ("0+005", 5.0),
            ("-0+050", -50.0),
            ("1+012.5", 1012.5),
        ] {
            assert_eq!(StationFormat::distance(text), Some(distance), "{text}");
        }
        for text in [
            "", "1250", "+5", "5+", "1e+3", "1+-2", "1+2+3", "1.5+2", "1+2.", "-+1",
        ] {
            assert_eq!(StationFormat::distance(text), None, "{text}");
        }
        for wrong in [
            "",
            "+",
            "0+",
            "0+1",
            "1+000",
            "0.",
            "0+000.0x",
            "00+000",
            "0+0000000000",
        ] {
            assert!(wrong.parse::<StationFormat>().is_err(), "{wrong}");
        }
    }
}

//! Parsers for the values of options.

use std::str::FromStr;

use crate::data::{Bounds, Return, classes, returns};
use crate::run::StationFormat;
use crate::terrain::Thinning;

/// A rectangle typed as `xmin,ymin,xmax,ymax`, with commas or blanks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corners {
    pub(crate) min: [f64; 2],
    pub(crate) max: [f64; 2],
}

impl FromStr for Corners {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = if text.contains(',') {
            text.split(',').collect()
        } else {
            text.split_whitespace().collect()
        };
        let values: Vec<f64> = parts
            .into_iter()
            .map(|part| finite(part).map_err(|e| format!("{e}; expected xmin,ymin,xmax,ymax")))
            .collect::<Result<_, _>>()?;
        let &[x0, y0, x1, y1] = values.as_slice() else {
            return Err(format!(
                "expected four numbers xmin,ymin,xmax,ymax, found {}",
                values.len()
            ));
        };
        if x0 < x1 && y0 < y1 {
            Ok(Corners {
                min: [x0, y0],
                max: [x1, y1],
            })
        } else {
            Err("expected xmin < xmax and ymin < ymax".to_owned())
        }
    }
}

impl Corners {
    /// Returns the box of this rectangle, unbounded in z.
    pub(crate) fn bounds(self) -> Bounds {
        Bounds {
            min: [self.min[0], self.min[1], f64::NEG_INFINITY],
            max: [self.max[0], self.max[1], f64::INFINITY],
        }
    }
}

/// One or several classes of points, typed as one word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ClassRange(pub(crate) Vec<u8>);

impl FromStr for ClassRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        classes::parse(text).map(ClassRange)
    }
}

impl ClassRange {
    /// Returns all classes of several words.
    pub(crate) fn all(ranges: &[Self]) -> Vec<u8> {
        ranges.iter().flat_map(|range| range.0.clone()).collect()
    }
}

/// One or several returns of pulses, typed as one word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReturnRange(pub(crate) Vec<Return>);

impl FromStr for ReturnRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        returns::parse(text).map(ReturnRange)
    }
}

impl ReturnRange {
    /// Returns the returns of several words; none, which means all, if one of them is `all`.
    pub(crate) fn all(ranges: &[Self]) -> Vec<Return> {
        if ranges.iter().any(|range| range.0.is_empty()) {
            Vec::new()
        } else {
            ranges.iter().flat_map(|range| range.0.clone()).collect()
        }
    }
}

/// A rule to thin points by, with the number after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ThinRule(pub(crate) Thinning);

impl FromStr for ThinRule {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Thinning::parse(text).map(ThinRule)
    }
}

/// A length, `auto` or `none`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum EdgeLength {
    Length(f64),
    Auto,
    None,
}

impl FromStr for EdgeLength {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("none") {
            return Ok(EdgeLength::None);
        }
        if text.eq_ignore_ascii_case("auto") {
            return Ok(EdgeLength::Auto);
        }
        positive(text)
            .map(EdgeLength::Length)
            .map_err(|e| format!("{e}; expected a length, `auto` or `none`"))
    }
}

/// Levels typed as `from:to:step`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LevelSteps(pub(crate) Vec<f64>);

/// The most levels of one table.
const MOST_LEVELS: f64 = 100_000.0;

impl FromStr for LevelSteps {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let values: Vec<f64> = text.split(':').map(finite).collect::<Result<_, _>>()?;
        let &[from, to, step] = values.as_slice() else {
            return Err(format!(
                "expected three numbers FROM:TO:STEP, found {}",
                values.len()
            ));
        };
        if from > to || step <= 0.0 {
            return Err("expected FROM <= TO and a STEP above zero".to_owned());
        }
        // A step that is no binary number, such as 0.1, reaches the last level all the same.
        let count = ((to - from) / step + 1e-9).floor();
        if count >= MOST_LEVELS {
            return Err(format!(
                "{count:e} levels: at most {MOST_LEVELS} are computed"
            ));
        }
        let digits = text.split(':').map(decimals).max().unwrap_or_default();
        let level = |i: u32| rounded(from + f64::from(i) * step, digits);
        Ok(LevelSteps((0..=count as u32).map(level).collect()))
    }
}

/// Returns the number of decimals of a typed number; 15 if it has an exponent.
fn decimals(text: &str) -> usize {
    match text.trim().split_once('.') {
        _ if text.contains(['e', 'E']) => 15,
        Some((_, decimals)) => decimals.len(),
        None => 0,
    }
}

/// Rounds to decimals: 3 times 0.1 becomes 0.3.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.digits$}").parse().unwrap_or(value)
}

/// Parses a finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{}` is not a finite number", text.trim())),
    }
}

/// Parses a station: a finite number, or one as outputs write it, such as `1+250`.
pub(super) fn station(text: &str) -> Result<f64, String> {
    let expected = |e| format!("{e}; expected a station such as 1+250 or 1250");
    StationFormat::distance(text.trim()).map_or_else(|| finite(text).map_err(expected), Ok)
}

/// Parses the smallest angle that a triangle may have, in degrees: above 0, below 60.
pub(super) fn smallest_angle(text: &str) -> Result<f64, String> {
    match positive(text)? {
        value if value < 60.0 => Ok(value),
        value => Err(format!(
            "{value} degrees: no triangle has three angles above 60"
        )),
    }
}

/// Parses a finite number above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value > 0.0 => Ok(value),
        value => Err(format!("{value} is not above zero")),
    }
}

/// Parses the value of `--smooth`, which may be left out: then the next word is taken for it.
pub(super) fn smoothing(text: &str) -> Result<f64, String> {
    let of_others = |cause: String| match finite(text) {
        Ok(_) => cause,
        Err(_) => format!(
            "{cause}; without a tolerance, another option has to follow: \
             `{text} --smooth -o ...`; with one: `--smooth 0.25 {text}`"
        ),
    };
    positive(text).map_err(of_others)
}

/// Parses a finite number that is not negative.
pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= 0.0 => Ok(value),
        value => Err(format!("{value} is below zero")),
    }
}

/// Parses an angle from the horizon (0) to the zenith (90), in degrees.
pub(super) fn altitude(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if (0.0..=90.0).contains(&value) => Ok(value),
        value => Err(format!(
            "{value} is not between 0 (the horizon) and 90 (overhead)"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_four_numbers_in_order() {
        assert_eq!(
            "-1, 2,3,4.5".parse(),
            Ok(Corners {
                min: [-1.0, 2.0],
                max: [3.0, 4.5]
            })
        );
        assert_eq!(
            " 1  2 3.5\t4".parse(),
            Ok(Corners {
                min: [1.0, 2.0],
                max: [3.5, 4.0]
            })
        );
        for wrong in [
            "",
            "1,2,3",
            "1,,2,3,4",
            "1,2,3,4,5",
            "3,2,1,4",
            "1,2,1,4",
            "1,2,inf,4",
            "1,2,nan,4",
            "a,b,c,d",
        ] {
            assert!(wrong.parse::<Corners>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn levels_are_as_they_are_written() {
        let levels = |text: &str| text.parse::<LevelSteps>().map(|steps| steps.0);
        assert_eq!(levels("0:0.3:0.1"), Ok(vec![0.0, 0.1, 0.2, 0.3]));
        assert_eq!(levels("-1:1.2:0.5"), Ok(vec![-1.0, -0.5, 0.0, 0.5, 1.0]));
        assert_eq!(levels("7.123:8:2"), Ok(vec![7.123]));
        assert_eq!(levels("100.7:100.9:0.1"), Ok(vec![100.7, 100.8, 100.9]));
        for wrong in [
            "", "1", "1:2", "1:2:3:4", "2:1:1", "1:2:0", "1:2:-1", "0:nan:1", "0:1:1e-9", "0:inf:1",
        ] {
            assert!(levels(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn an_edge_length_is_positive_or_none() {
        assert_eq!("12.5".parse(), Ok(EdgeLength::Length(12.5)));
        assert_eq!("None".parse(), Ok(EdgeLength::None));
        assert_eq!("auto".parse(), Ok(EdgeLength::Auto));
        for wrong in ["0", "-1", "inf", "nan", "all", ""] {
            assert!(wrong.parse::<EdgeLength>().is_err(), "{wrong}");
        }
    }
}

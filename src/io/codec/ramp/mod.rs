//! Color ramps as `gdaldem color-relief` reads them: text with a height and its color on each line.
//!
//! ```text
//! # comment
//! nv     0 0 0 0        cells without a height
//! 0%     blue           lowest of all cells, color by name
//! 104.5  255 255 0      red, green, blue
//! 100%   255,0,0,128    with opacity
//! ```
//!
//! Fields are separated by blanks, tabs, commas or colons. `#` begins a comment, and so does `/` at
//! the beginning of a line. The names of colors are those of GDAL, which has them from GRASS.
//!
//! The ramps that are [built in](built_in) are such files, too.

use std::path::Path;

use crate::data::{ColorRamp, ColorStop, Rgba, StopAt};
use crate::error::{Error, Result};

/// The most bytes of a ramp file.
const MAX_BYTES: u64 = 1 << 20;

/// The ramps that are built in, by name.
const BUILT_IN: &[(&str, &str)] = &[
    ("elevation", include_str!("elevation.txt")),
    ("gray", include_str!("gray.txt")),
    ("viridis", include_str!("viridis.txt")),
];

/// Colors by name, as GDAL has them.
const NAMED: &[(&str, [u8; 3])] = &[
    ("white", [255, 255, 255]),
    ("black", [0, 0, 0]),
    ("red", [255, 0, 0]),
    ("green", [0, 255, 0]),
    ("blue", [0, 0, 255]),
    ("yellow", [255, 255, 0]),
    ("magenta", [255, 0, 255]),
    ("cyan", [0, 255, 255]),
    ("aqua", [0, 191, 191]),
    ("grey", [191, 191, 191]),
    ("gray", [191, 191, 191]),
    ("orange", [255, 127, 0]),
    ("brown", [191, 127, 63]),
    ("purple", [127, 0, 255]),
    ("violet", [127, 0, 255]),
    ("indigo", [0, 127, 255]),
];

/// Returns the names of the ramps that are built in, each from the lowest to the highest of all
/// cells.
pub fn names() -> impl Iterator<Item = &'static str> {
    BUILT_IN.iter().map(|(name, _)| *name)
}

/// Returns the ramp that is built in under a name; `None` if there is none.
pub fn built_in(name: &str) -> Option<ColorRamp> {
    let (_, text) = BUILT_IN.iter().find(|(known, _)| *known == name)?;
    parse(text).ok()
}

/// Reads a ramp file.
///
/// # Errors
/// If the file cannot be read or is larger than 1 MiB, no line has a height, or a line lacks a
/// height or a color; the error names the line.
pub fn read(path: &Path) -> Result<ColorRamp> {
    let read = || {
        if std::fs::metadata(path)?.len() > MAX_BYTES {
            return Err(Error::limit("a color ramp of more than 1 MiB"));
        }
        let bytes = std::fs::read(path)?;
        let text = std::str::from_utf8(&bytes)
            .map_err(|_| Error::format("this is not text; expected a color ramp").cure(EXAMPLE))?;
        parse(text)
    };
    read().map_err(|e: Error| e.in_file(path))
}

/// What a line looks like.
const EXAMPLE: &str =
    "write a height and its color on each line, such as `100 255 128 0` or `50% red`";

fn parse(text: &str) -> Result<ColorRamp> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut ramp = ColorRamp::default();
    for (i, line) in text.lines().enumerate() {
        let stop = stop(line).map_err(|e| e.at(format!("line {}", i + 1)).cure(EXAMPLE))?;
        ramp.stops.extend(stop);
    }
    if ramp.stops.iter().all(|stop| stop.at == StopAt::NoHeight) {
        return Err(Error::format("no height has a color").cure(EXAMPLE));
    }
    Ok(ramp)
}

/// Returns the color of a line; `None` for a comment or an empty line.
fn stop(line: &str) -> Result<Option<ColorStop>> {
    let is_between = |c: char| c.is_ascii_whitespace() || matches!(c, ',' | ':');
    let before_comment = line.split('#').next().unwrap_or_default();
    let fields: Vec<&str> = before_comment
        .split(is_between)
        .filter(|field| !field.is_empty())
        .collect();
    let [at, color @ ..] = &fields[..] else {
        return Ok(None);
    };
    if at.starts_with('/') {
        return Ok(None);
    }
    Ok(Some(ColorStop {
        at: stop_at(at)?,
        color: rgba(color)?,
    }))
}

fn stop_at(field: &str) -> Result<StopAt> {
    if field.eq_ignore_ascii_case("nv") {
        return Ok(StopAt::NoHeight);
    }
    let number = |text: &str| text.parse::<f64>().ok().filter(|value| value.is_finite());
    match field.strip_suffix('%') {
        Some(percent) => match number(percent) {
            Some(percent) if (0.0..=100.0).contains(&percent) => Ok(StopAt::Percent(percent)),
            _ => Err(Error::format(format!("`{field}`, expected 0% to 100%"))),
        },
        None => number(field).map(StopAt::Height).ok_or_else(|| {
            Error::format(format!(
                "`{field}`, expected a height, a percentage or `nv`"
            ))
        }),
    }
}

fn rgba(fields: &[&str]) -> Result<Rgba> {
    match fields {
        [name] => Ok(opaque(named(name)?)),
        [name, opacity] => {
            let [red, green, blue] = named(name)?;
            Ok([red, green, blue, channel(opacity)?])
        }
        [red, green, blue] => Ok(opaque([channel(red)?, channel(green)?, channel(blue)?])),
        [red, green, blue, opacity] => Ok([
            channel(red)?,
            channel(green)?,
            channel(blue)?,
            channel(opacity)?,
        ]),
        _ => Err(Error::format(format!(
            "{} fields behind the height, expected red, green, blue and opacity, or the name of a color",
            fields.len()
        ))),
    }
}

fn opaque([red, green, blue]: [u8; 3]) -> Rgba {
    [red, green, blue, 255]
}

fn channel(field: &str) -> Result<u8> {
    field.parse().map_err(|_| {
        Error::format(format!(
            "`{field}` in a color, expected a whole number from 0 to 255"
        ))
    })
}

fn named(field: &str) -> Result<[u8; 3]> {
    let known = NAMED
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(field));
    known.map(|(_, color)| *color).ok_or_else(|| {
        let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
        Error::format(format!(
            "`{field}`, expected the name of a color: {}",
            names.join(", ")
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_forms_of_a_line_are_read() {
        let text = "\u{feff}# comment\r\n/ also\n\nnv 0 0 0 0\n-1.5e1,10:20\t30\n50%  Red\n 7 gray 128 # here, too\n100% 1 2 3 4\n";
        let found: Vec<(StopAt, Rgba)> = parse(text)
            .unwrap()
            .stops
            .iter()
            .map(|stop| (stop.at, stop.color))
            .collect();
        assert_eq!(
            found,
            [
                (StopAt::NoHeight, [0, 0, 0, 0]),
                (StopAt::Height(-15.0), [10, 20, 30, 255]),
                (StopAt::Percent(50.0), [255, 0, 0, 255]),
                (StopAt::Height(7.0), [191, 191, 191, 128]),
                (StopAt::Percent(100.0), [1, 2, 3, 4]),
            ]
        );
    }

    #[test]
    fn what_is_no_ramp_is_refused_by_line_and_value() {
        for (text, said) in [
            ("", "no height has a color"),
            ("nv 0 0 0\n", "no height has a color"),
            ("0 0 0 0\n1 300 0 0", "line 2: `300` in a color"),
            ("0 -1 0 0", "`-1` in a color"),
            ("0 1.5 0 0", "`1.5` in a color"),
            ("0 mauve", "`mauve`, expected the name of a color: white"),
            ("0 0 0", "`0`, expected the name"),
            ("0", "0 fields behind the height"),
            ("0 0 0 0 0 0", "5 fields behind the height"),
            ("101% red", "`101%`, expected 0% to 100%"),
            ("% red", "`%`, expected 0%"),
            ("-1% red", "`-1%`"),
            ("nan red", "`nan`, expected a height"),
            ("inf red", "`inf`, expected a height"),
            ("high red", "`high`, expected a height"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.to_string().contains(said), "{text:?}: {error}");
            assert!(error.cure_text().is_some(), "{text:?}");
        }
    }

    #[test]
    fn ramps_that_are_built_in_go_from_the_lowest_to_the_highest() {
        for name in names() {
            let ramp = built_in(name).unwrap();
            assert!(ramp.has_percents(), "{name}");
            let ends = [0, ramp.stops.len() - 1].map(|i| ramp.stops[i].at);
            assert_eq!(
                ends,
                [StopAt::Percent(0.0), StopAt::Percent(100.0)],
                "{name}"
            );
        }
        assert!(built_in("rainbow").is_none());
    }
}

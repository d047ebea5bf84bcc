//! World files: six numbers in a file next to a picture that give its position.

use std::path::Path;

#[cfg(feature = "png")]
use crate::data::Frame;
use crate::error::{Error, Result};

/// Returns the text of a world file: the steps from column to column and from row to row, and the
/// center of the first cell.
#[cfg(feature = "png")]
pub(crate) fn text(frame: &Frame) -> String {
    let t = &frame.transform;
    let [x, y] = frame.center(0, 0);
    [t[1], t[4], t[2], t[5], x, y]
        .iter()
        .map(|value| format!("{value}\n"))
        .collect()
}

/// Parses the text of a world file to a transform of cell corners.
fn parse(text: &str) -> Option<[f64; 6]> {
    let mut numbers = text
        .split_ascii_whitespace()
        .map(|word| word.parse::<f64>().ok().filter(|v| v.is_finite()));
    let mut next = || numbers.next().flatten();
    let (x_column, y_column, x_row, y_row, x, y) =
        (next()?, next()?, next()?, next()?, next()?, next()?);
    if x_column * y_row - x_row * y_column == 0.0 {
        return None;
    }
    Some([
        x - (x_column + x_row) / 2.0,
        x_column,
        x_row,
        y - (y_column + y_row) / 2.0,
        y_column,
        y_row,
    ])
}

/// Reads the transform from the world file next to a TIFF file or a picture; `None` if there is no
/// world file.
pub(crate) fn read_beside(path: &Path) -> Option<Result<[f64; 6]>> {
    let is_png = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    let own: &[&str] = if is_png {
        &["pgw", "pngw", "PGW"]
    } else {
        &["tfw", "tifw", "tiffw", "TFW"]
    };
    let names = own
        .iter()
        .chain(&["wld", "WLD"])
        .map(|extension| path.with_extension(extension));
    let beside = { names }.find(|name| name.is_file())?;
    // A world file has six lines; a larger file is something else.
    let is_small = beside
        .metadata()
        .is_ok_and(|metadata| metadata.len() < 4096);
    let text = if is_small {
        std::fs::read_to_string(&beside)
    } else {
        Ok(String::new())
    };
    Some(match text {
        Ok(text) => parse(&text).ok_or_else(|| {
            Error::format("expected the six numbers of a world file").in_file(&beside)
        }),
        Err(error) => Err(Error::from(error).in_file(&beside)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(feature = "png")]
    fn what_is_written_is_read_back() {
        let frame = Frame {
            width: 3,
            height: 2,
            transform: [100.0, 2.0, 0.5, 50.0, 0.25, -2.0],
        };
        assert_eq!(text(&frame), "2\n0.25\n0.5\n-2\n101.25\n49.125\n");
        assert_eq!(parse(&text(&frame)), Some(frame.transform));
    }

    #[test]
    fn what_is_not_a_world_file_is_refused() {
        for text in [
            "",
            "1 0 0 -1 5",
            "1 0 0 x 5 5",
            "0 0 0 0 5 5",
            "1 0 0 nan 5 5",
        ] {
            assert_eq!(parse(text), None, "{text:?}");
        }
    }
}

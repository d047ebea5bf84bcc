//! Options of reading points, for what the files themselves leave open.

use clap::Args;

use crate::data::Columns;
use crate::io::las::Cut;
use crate::io::points::Options;

/// Options of reading points.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Points")]
pub(in crate::cli) struct ReadArgs {
    /// Columns of text files, such as `PNEZD`, `XYZ` or `2,1,3` [default: from the header, else the
    /// first three]
    ///
    /// Either one letter per column: E or X is the easting, N or Y the northing, Z the height; P
    /// (point number), D (description) and S (anything else) are skipped. Or the numbers of the
    /// columns of x, y and z, counted from 1. With this option a header line is skipped. `info` and
    /// the summary show which columns were used.
    #[arg(long, value_name = "PNEZD|XYZ|2,1,3", value_parser = columns, conflicts_with = "parse")]
    pub(in crate::cli) columns: Option<Columns>,

    /// Columns of text files in the letters of LAStools, such as `sxyz`
    ///
    /// x, y, z and c (class) are used; s and the letters of all other fields are skipped.
    #[arg(long, value_name = "sxyz", value_parser = las_tools)]
    pub(in crate::cli) parse: Option<Columns>,

    /// Use the remaining points of truncated LAS and LAZ files
    ///
    /// A warning says how many points there are. Without this option it is an error if a file has
    /// fewer points than its header states.
    #[arg(long)]
    pub(in crate::cli) partial: bool,
}

impl ReadArgs {
    /// Returns the options for readers of points.
    pub(in crate::cli) fn options(&self) -> Options {
        let cut = if self.partial { Cut::Accept } else { Cut::Refuse };
        Options { columns: self.columns.or(self.parse), cut, ..Options::default() }
    }
}

/// Parses `PNEZD` or `2,1,3`.
fn columns(text: &str) -> Result<Columns, String> {
    if text.contains(|c: char| c.is_ascii_digit()) {
        return numbered(text);
    }
    let find = |axis: &str, letters: [char; 2]| find(text, axis, |c| letters.contains(&c.to_ascii_uppercase()));
    if let Some(unknown) = text.chars().find(|c| !"XYZENPDS".contains(c.to_ascii_uppercase())) {
        return Err(format!("`{unknown}` is none of the letters P N E Z D, X Y and S"));
    }
    Ok(Columns { x: find("x", ['E', 'X'])?, y: find("y", ['N', 'Y'])?, z: find("z", ['Z', 'Z'])?, class: None })
}

fn numbered(text: &str) -> Result<Columns, String> {
    let numbers: Vec<usize> = text.split(',').map_while(|part| part.trim().parse().ok()).collect();
    match *numbers.as_slice() {
        [x, y, z] if text.split(',').count() == 3 && x.min(y).min(z) > 0 && x != y && y != z && x != z => {
            Ok(Columns { x, y, z, class: None })
        }
        _ => Err("expected the numbers of three columns, from 1 on, for x, y and z".to_owned()),
    }
}

/// Parses `sxyz`.
fn las_tools(text: &str) -> Result<Columns, String> {
    const SKIPPED: &str = "saitrnRGBHIhgukwpedloSC0123456789";
    if let Some(unknown) = text.chars().find(|&c| !"xyzc".contains(c) && !SKIPPED.contains(c)) {
        return Err(format!("`{unknown}` is no letter for a field: x, y, z, c (class), s (skip), as in sxyz"));
    }
    let one = |axis: &str, letter: char| find(text, axis, |c| c == letter);
    let class = if text.contains('c') { Some(one("the class", 'c')?) } else { None };
    Ok(Columns { x: one("x", 'x')?, y: one("y", 'y')?, z: one("z", 'z')?, class })
}

/// Returns the number of the only column whose letter satisfies `is_it`; an error if there is none
/// or more than one.
fn find(text: &str, axis: &str, is_it: impl Fn(char) -> bool) -> Result<usize, String> {
    let mut numbers = (1..).zip(text.chars()).filter(|&(_, c)| is_it(c)).map(|(number, _)| number);
    match (numbers.next(), numbers.next()) {
        (Some(number), None) => Ok(number),
        (None, _) => Err(format!("no letter is for {axis}")),
        (Some(_), Some(_)) => Err(format!("two letters are for {axis}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_letters_or_numbers() {
        let shown = |parsed: Result<Columns, String>| parsed.map(|columns| columns.to_string());
        for (typed, meant) in [
            ("PNEZD", "x 3, y 2, z 4"),
            ("penz", "x 2, y 3, z 4"),
            ("XYZ", "x 1, y 2, z 3"),
            ("ssENSZ", "x 3, y 4, z 6"),
            ("2,1,3", "x 2, y 1, z 3"),
            ("1, 2 ,10", "x 1, y 2, z 10"),
        ] {
            assert_eq!(shown(columns(typed)).as_deref(), Ok(meant), "{typed}");
        }
        for typed in ["", "XY", "XYZZ", "XEZ", "XYH", "0,1,2", "1,2", "1,2,3,4", "1,1,2", "1,x,2", "-1,2,3"] {
            assert!(columns(typed).is_err(), "{typed}");
        }
        for (typed, meant) in
            [("sxyz", "x 2, y 3, z 4"), ("txyzicRGB", "x 2, y 3, z 4, class 6"), ("sszyx", "x 5, y 4, z 3")]
        {
            assert_eq!(shown(las_tools(typed)).as_deref(), Ok(meant), "{typed}");
        }
        for typed in ["", "xy", "xyzz", "XYZ", "xyz c", "xyzcc", "x,y,z"] {
            assert!(las_tools(typed).is_err(), "{typed}");
        }
    }
}

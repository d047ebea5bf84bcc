use std::fmt;
use std::str::FromStr;

/// The columns of a table that contain the coordinates, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Columns {
    /// Eastings, or longitudes.
    pub x: usize,
    /// Northings, or latitudes.
    pub y: usize,
    /// Heights.
    pub z: usize,
    /// Classification codes, if there are any.
    pub class: Option<usize>,
}

/// Formats the columns as "x 3, y 2, z 4".
impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "x {}, y {}, z {}", self.x, self.y, self.z)?;
        self.class
            .map_or(Ok(()), |class| write!(f, ", class {class}"))
    }
}

/// Parses one letter per column, `PNEZD` or `XYZ`, or the numbers of x, y and z, `2,1,3`.
impl FromStr for Columns {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.contains(|c: char| c.is_ascii_digit()) {
            return numbered(text);
        }
        let find = |axis: &str, letters: [char; 2]| {
            find(text, axis, |c| letters.contains(&c.to_ascii_uppercase()))
        };
        if let Some(unknown) = text
            .chars()
            .find(|c| !"XYZENPDS".contains(c.to_ascii_uppercase()))
        {
            return Err(format!(
                "`{unknown}` is none of the letters P N E Z D, X Y and S"
            ));
        }
        Ok(Columns {
            x: find("x", ['E', 'X'])?,
            y: find("y", ['N', 'Y'])?,
            z: find("z", ['Z', 'Z'])?,
            class: None,
        })
    }
}

fn numbered(text: &str) -> Result<Columns, String> {
    let numbers: Vec<usize> = text
        .split(',')
        .map_while(|part| part.trim().parse().ok())
        .collect();
    match *numbers.as_slice() {
        [x, y, z]
            if text.split(',').count() == 3
                && x.min(y).min(z) > 0
                && x != y
                && y != z
                && x != z =>
        {
            Ok(Columns {
                x,
                y,
                z,
                class: None,
            })
        }
        _ => Err("expected the numbers of three columns, from 1 on, for x, y and z".to_owned()),
    }
}

impl Columns {
    /// Parses the letters of LAStools: `sxyz`.
    ///
    /// # Errors
    /// If a letter is unknown, or x, y or z is missing or there twice.
    pub fn of_las_tools(text: &str) -> Result<Self, String> {
        const SKIPPED: &str = "saitrnRGBHIhgukwpedloSC0123456789";
        if let Some(unknown) = text
            .chars()
            .find(|&c| !"xyzc".contains(c) && !SKIPPED.contains(c))
        {
            return Err(format!(
                "`{unknown}` is no letter for a field: x, y, z, c (class), s (skip), as in sxyz"
            ));
        }
        let one = |axis: &str, letter: char| find(text, axis, |c| c == letter);
        let class = if text.contains('c') {
            Some(one("the class", 'c')?)
        } else {
            None
        };
        Ok(Columns {
            x: one("x", 'x')?,
            y: one("y", 'y')?,
            z: one("z", 'z')?,
            class,
        })
    }
}

/// Returns the number of the only column whose letter satisfies `is_it`; an error if there is none
/// or more than one.
fn find(text: &str, axis: &str, is_it: impl Fn(char) -> bool) -> Result<usize, String> {
    let mut numbers = (1..)
        .zip(text.chars())
        .filter(|&(_, c)| is_it(c))
        .map(|(number, _)| number);
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
            assert_eq!(shown(typed.parse()).as_deref(), Ok(meant), "{typed}");
        }
        for typed in [
            "", "XY", "XYZZ", "XEZ", "XYH", "0,1,2", "1,2", "1,2,3,4", "1,1,2", "1,x,2", "-1,2,3",
        ] {
            assert!(typed.parse::<Columns>().is_err(), "{typed}");
        }
        for (typed, meant) in [
            ("sxyz", "x 2, y 3, z 4"),
            ("txyzicRGB", "x 2, y 3, z 4, class 6"),
            ("sszyx", "x 5, y 4, z 3"),
        ] {
            assert_eq!(
                shown(Columns::of_las_tools(typed)).as_deref(),
                Ok(meant),
                "{typed}"
            );
        }
        for typed in ["", "xy", "xyzz", "XYZ", "xyz c", "xyzcc", "x,y,z"] {
            assert!(Columns::of_las_tools(typed).is_err(), "{typed}");
        }
    }
}

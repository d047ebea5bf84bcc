use std::fmt;
use std::str::FromStr;

/// The columns of a table that contain the coordinates, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Columns {
    /// Eastings, or longitudes.
    pub x: usize,
    /// Northings, or latitudes.
    pub y: usize,
    /// Heights; `None` of points in plan.
    pub z: Option<usize>,
    /// Classification codes, if there are any.
    pub class: Option<usize>,
}

/// Formats the columns as "x 3, y 2, z 4".
impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "x {}, y {}", self.x, self.y)?;
        self.z.map_or(Ok(()), |z| write!(f, ", z {z}"))?;
        self.class
            .map_or(Ok(()), |class| write!(f, ", class {class}"))
    }
}

/// Parses one letter per column, `PNEZD` or `XYZ`, or the numbers of x, y and z, `2,1,3`. Points in
/// plan have no z: `PNE`, `2,1`.
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
            z: find_any(text, "z", |c| c.eq_ignore_ascii_case(&'z'))?,
            class: None,
        })
    }
}

fn numbered(text: &str) -> Result<Columns, String> {
    let numbers: Vec<usize> = text
        .split(',')
        .map_while(|part| part.trim().parse().ok())
        .collect();
    let are_all = text.split(',').count() == numbers.len() && !numbers.contains(&0);
    let is_first = |at: usize| !numbers[..at].contains(&numbers[at]);
    let are_distinct = (0..numbers.len()).all(is_first);
    match *numbers.as_slice() {
        [x, y, ref z @ ..] if are_all && are_distinct && z.len() < 2 => Ok(Columns {
            x,
            y,
            z: z.first().copied(),
            class: None,
        }),
        _ => Err(
            "expected the numbers of three columns, from 1 on, for x, y and z; two for points in plan"
                .to_owned(),
        ),
    }
}

impl Columns {
    /// Parses the letters of LAStools: `sxyz`.
    ///
    /// # Errors
    /// If a letter is unknown, x or y is missing, or one is there twice.
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
        Ok(Columns {
            x: one("x", 'x')?,
            y: one("y", 'y')?,
            z: find_any(text, "z", |c| c == 'z')?,
            class: find_any(text, "the class", |c| c == 'c')?,
        })
    }
}

/// Returns the number of the only column whose letter satisfies `is_it`; `None` if there is none,
/// an error if there is more than one.
fn find_any(text: &str, axis: &str, is_it: impl Fn(char) -> bool) -> Result<Option<usize>, String> {
    match text.contains(&is_it) {
        true => find(text, axis, is_it).map(Some),
        false => Ok(None),
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
            ("2,3", "x 2, y 3"),
            ("NE", "x 2, y 1"),
            ("PXYD", "x 2, y 3"),
        ] {
            assert_eq!(shown(typed.parse()).as_deref(), Ok(meant), "{typed}");
        }
        for typed in [
            "", "XZ", "XYZZ", "XEZ", "XYH", "0,1,2", "1", "1,1", "0,1", "1,2,", "1,2,x", "1,2,3,4",
            "1,1,2", "1,x,2", "-1,2,3",
        ] {
            assert!(typed.parse::<Columns>().is_err(), "{typed}");
        }
        for (typed, meant) in [
            ("sxyz", "x 2, y 3, z 4"),
            ("txyzicRGB", "x 2, y 3, z 4, class 6"),
            ("sszyx", "x 5, y 4, z 3"),
            ("sxy", "x 2, y 3"),
        ] {
            assert_eq!(
                shown(Columns::of_las_tools(typed)).as_deref(),
                Ok(meant),
                "{typed}"
            );
        }
        for typed in ["", "xz", "xyzz", "XYZ", "xyz c", "xyzcc", "x,y,z"] {
            assert!(Columns::of_las_tools(typed).is_err(), "{typed}");
        }
    }
}

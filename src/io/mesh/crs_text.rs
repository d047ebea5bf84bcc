//! Coordinate systems as comment lines.

use crate::crs::Crs;
use crate::error::{Error, Result};

/// Bytes in a line: rply, which CloudCompare reads with, takes 1024 with the keyword.
const LINE: usize = 200;

/// What to write of a coordinate system, cut into short lines without line breaks.
pub(super) fn lines(crs: Option<&Crs>) -> Vec<String> {
    // WKT may be laid out in lines; the breaks and indents between its parts mean nothing.
    let text: String = crs.map(Crs::to_wkt).unwrap_or_default().lines().map(str::trim).collect();
    let mut lines = Vec::new();
    let mut line = String::new();
    for c in text.chars() {
        // A blank at the end of a line may get lost.
        if line.len() + c.len_utf8() > LINE && !line.ends_with(' ') && c != ' ' {
            lines.push(std::mem::take(&mut line));
        }
        line.push(c);
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// The coordinate system that the joined lines hold; `None` if there are none.
pub(super) fn parse(joined: &str) -> Result<Option<Crs>> {
    if joined.is_empty() {
        return Ok(None);
    }
    let cure = "correct or remove the comment lines that begin with 'crs'";
    Crs::from_user(joined).map(Some).map_err(|e: Error| e.at("coordinate system in the comments").cure(cure))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::{CrsKind, Unit};

    #[test]
    fn long_texts_become_short_lines() {
        let wkt = format!("LOCAL_CS[\"{} x\",\r\n    UNIT[\"metre\",1]]\n", "é".repeat(300));
        let unit = Unit { name: "metre".into(), factor: 1.0 };
        let name = "x".into();
        let kind = CrsKind::Local;
        let crs = Crs { name, epsg: None, vertical_epsg: None, kind, unit, vertical_unit: None, wkt: Some(wkt) };
        let lines = lines(Some(&crs));
        assert_eq!(lines.len(), 4);
        assert!(lines.iter().all(|line| line.len() <= LINE && !line.contains(['\r', '\n'])));
        assert_eq!(lines.concat(), format!("LOCAL_CS[\"{} x\",UNIT[\"metre\",1]]", "é".repeat(300)));
        assert!(super::lines(None).is_empty());
    }
}

//! Coordinate systems as comment lines.

use crate::crs::Crs;
use crate::error::{Error, Result};

/// Bytes in a line: rply, which CloudCompare reads with, takes 1024 with the keyword.
const LINE: usize = 200;

/// What to write of a coordinate system, cut into short lines without line breaks.
pub(super) fn lines(crs: Option<&Crs>) -> Vec<String> {
    let Some(text) = crs.and_then(text) else { return Vec::new() };
    let mut lines = vec![String::new()];
    // WKT may be laid out in lines; the breaks and indents between its parts mean nothing.
    for c in text.lines().map(str::trim).collect::<String>().chars() {
        if lines[lines.len() - 1].len() + c.len_utf8() > LINE {
            lines.push(String::new());
        }
        let last = lines.len() - 1;
        lines[last].push(c);
    }
    lines
}

fn text(crs: &Crs) -> Option<String> {
    crs.wkt.clone().or_else(|| {
        let code = crs.epsg?;
        Some(crs.vertical_epsg.map_or_else(|| format!("EPSG:{code}"), |vertical| format!("EPSG:{code}+{vertical}")))
    })
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

    fn crs(wkt: Option<&str>, epsg: Option<u32>, vertical_epsg: Option<u32>) -> Crs {
        let unit = Unit { name: "metre".into(), factor: 1.0 };
        let wkt = wkt.map(str::to_owned);
        Crs { name: "x".into(), epsg, vertical_epsg, kind: CrsKind::Projected, unit, vertical_unit: None, wkt }
    }

    #[test]
    fn long_texts_become_short_lines() {
        let wkt = format!("LOCAL_CS[\"{}\",\r\n    UNIT[\"metre\",1]]\n", "é".repeat(300));
        let lines = lines(Some(&crs(Some(&wkt), Some(25832), None)));
        assert_eq!(lines.len(), 4);
        assert!(lines.iter().all(|line| line.len() <= LINE && !line.contains(['\r', '\n'])));
        assert_eq!(lines.concat(), format!("LOCAL_CS[\"{}\",UNIT[\"metre\",1]]", "é".repeat(300)));
    }

    #[test]
    fn codes_stand_in_for_a_missing_definition() {
        assert_eq!(lines(Some(&crs(None, Some(25832), None))), ["EPSG:25832"]);
        assert_eq!(lines(Some(&crs(None, Some(25832), Some(7837)))), ["EPSG:25832+7837"]);
        assert!(lines(Some(&crs(None, None, None))).is_empty());
        assert!(lines(None).is_empty());
    }
}

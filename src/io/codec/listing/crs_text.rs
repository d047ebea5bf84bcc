//! Coordinate systems as comment lines.

use crate::crs::Crs;
use crate::error::{Error, Result};

/// Definitions of fewer bytes are written in one line: the limit of rply, with which CloudCompare
/// reads, is 1024 bytes including the keyword.
const WHOLE: usize = 1000;

/// Bytes per line of a longer definition.
const PART: usize = 200;

/// Returns the comments that state a coordinate system: `crs: EPSG:25832` or `crs: WKT`, as QGIS
/// reads them. A long definition is split into comments `crs PART`.
pub(crate) fn comments(crs: Option<&Crs>) -> Vec<String> {
    let Some(crs) = crs else { return Vec::new() };
    if let Some(code) = code(crs) {
        return vec![format!("crs: {code}")];
    }
    let text = wkt(crs);
    match text.len() {
        0 => Vec::new(),
        length if length < WHOLE => vec![format!("crs: {text}")],
        _ => parts(&text)
            .iter()
            .map(|part| format!("crs {part}"))
            .collect(),
    }
}

/// Returns the WKT of a coordinate system in one line: breaks and indentation have no meaning.
pub(crate) fn wkt(crs: &Crs) -> String {
    crs.to_wkt().lines().map(str::trim).collect()
}

/// Returns what a user should know of a format without coordinate systems.
pub(crate) fn left_out(crs: Option<&Crs>) -> Option<String> {
    crs.map(|crs| format!("the format has no coordinate system, which is left out: {crs}"))
}

/// Returns `EPSG:25832`, if that is the complete definition. QGIS does not read two codes, as in
/// `EPSG:25832+7837`.
fn code(crs: &Crs) -> Option<String> {
    let code = crs.epsg?;
    let named = Crs::from_epsg(code).ok()?;
    let facts = |crs: &Crs| (crs.kind, crs.vertical_epsg, crs.vertical_unit.is_some());
    (facts(&named) == facts(crs) && named.unit.is_same(&crs.unit)).then(|| format!("EPSG:{code}"))
}

/// Splits a text into short parts.
fn parts(text: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    for c in text.chars() {
        let last = &parts[parts.len() - 1];
        // A blank at the end of a line might get lost.
        if last.len() + c.len_utf8() > PART && !last.ends_with(' ') && c != ' ' {
            parts.push(String::new());
        }
        parts.last_mut().into_iter().for_each(|last| last.push(c));
    }
    parts
}

/// Returns what a comment states of the coordinate system, in whole or in part; `None` for other
/// comments.
pub(crate) fn crs_comment(comment: &str) -> Option<&str> {
    comment
        .strip_prefix("crs:")
        .or_else(|| comment.strip_prefix("crs "))
}

/// Parses the joined statements of all comments; `None` if there are none.
pub(crate) fn parse(joined: &str) -> Result<Option<Crs>> {
    if joined.is_empty() {
        return Ok(None);
    }
    let cure = "correct or remove the comment lines that begin with 'crs'";
    Crs::from_user(joined)
        .map(Some)
        .map_err(|e: Error| e.at("coordinate system in the comments").cure(cure))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::{CrsKind, Unit};

    fn local(name: &str) -> Crs {
        let wkt = Some(format!(
            "LOCAL_CS[\"{name} x\",\r\n    UNIT[\"metre\",1]]\n"
        ));
        let unit = Unit {
            name: "metre".into(),
            factor: 1.0,
        };
        let name = "x".into();
        Crs {
            name,
            epsg: None,
            vertical_epsg: None,
            kind: CrsKind::Local,
            unit,
            vertical_unit: None,
            wkt,
        }
    }

    #[test]
    fn long_texts_become_short_lines() {
        let text = |name: &str| format!("LOCAL_CS[\"{name} x\",UNIT[\"metre\",1]]");
        let whole = "é".repeat(480);
        assert_eq!(
            comments(Some(&local(&whole))),
            [format!("crs: {}", text(&whole))]
        );
        let long = "é".repeat(490);
        let lines = comments(Some(&local(&long)));
        assert_eq!(lines.len(), 6);
        assert!(
            lines
                .iter()
                .all(|line| line.len() <= PART + 4 && !line.contains(['\r', '\n']))
        );
        assert_eq!(
            lines
                .iter()
                .map(|line| crs_comment(line).unwrap())
                .collect::<String>(),
            text(&long)
        );
        assert!(comments(None).is_empty());
    }

    #[test]
    fn a_code_stands_for_what_it_says_in_full() {
        for text in ["EPSG:25832", "EPSG:4326", "EPSG:2994"] {
            let crs = Crs::from_user(text).unwrap();
            let [line] = &comments(Some(&crs))[..] else {
                panic!("{text}")
            };
            assert_eq!(
                parse(crs_comment(line).unwrap()).unwrap().as_ref(),
                Some(&crs)
            );
        }
        let with_heights = Crs::from_user("EPSG:25832+7837").unwrap();
        assert!(comments(Some(&with_heights))[0].starts_with("crs: COMPD_CS["));
        let mut crs = Crs::from_epsg(25832).unwrap();
        crs.vertical_unit = Some(Unit {
            name: "metre".into(),
            factor: 1.0,
        });
        assert!(comments(Some(&crs))[0].starts_with("crs: PROJCS["));
    }
}

//! Wavefront OBJ: vertices and faces as text.

use std::io::Write;

use super::listing::polygon::POLYGONS_AT_ONCE;
use super::listing::{Listing, crs_text, polygon};
use crate::crs::Crs;
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::bytes::lines::write_lines;
use crate::io::bytes::watch::Meter;
use crate::io::options::cut::open_line;
use crate::io::{Destination, Watch};

/// Writes `v x y z` and `f a b c`, numbered from 1. Decimals are the shortest that read back as the
/// same double.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<()> {
    let mut output = target.create()?;
    writeln!(output, "# breakline")?;
    for line in crs_text::comments(crs) {
        writeln!(output, "# {line}")?;
    }
    write_lines(&mut output, mesh.vertices(), |text, [x, y, z]| {
        writeln!(text, "v {x} {y} {z}")
    })?;
    write_lines(&mut output, mesh.faces(), |text, face| {
        // 64 bits, because the largest number plus one may not fit into 32.
        let [a, b, c] = face.map(|v| u64::from(v) + 1);
        writeln!(text, "f {a} {b} {c}")
    })?;
    target.put(output)
}

/// Reads `v` and `f` lines (with texture and normal numbers, and numbers counted from the end), and
/// comments that begin with `crs`. Other statements of the format are skipped; a line that begins
/// with anything else is an error, since it may be a damaged vertex.
pub(crate) fn read(bytes: &[u8], watch: Watch) -> Result<Triangles> {
    let mut vertices = Vec::new();
    // Faces may precede their vertices, so they are assembled at the end.
    let mut corners = Vec::new();
    let mut polygons = Vec::new();
    let mut crs = String::new();
    let (mut meter, mut left) = (Meter::new(watch, bytes.len()), bytes.len());
    for (number, line) in logical_lines(bytes) {
        left = left.saturating_sub(line.len() + 1);
        meter.left(left)?;
        let at_line = |e: Error| e.at(format!("line {number}"));
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => vertices.push(vertex(words).map_err(at_line)?),
            Some("f") => {
                let first = corners.len();
                for word in words {
                    corners.push(corner(word, vertices.len()).map_err(at_line)?);
                }
                polygons.push((number, first..corners.len()));
            }
            Some("#") => crs.push_str(
                line.strip_prefix("# ")
                    .and_then(crs_text::crs_comment)
                    .unwrap_or_default(),
            ),
            Some(word) if !word.starts_with('#') && !STATEMENTS.contains(&word) => {
                let error =
                    Error::format(format!("'{}' is not a statement of OBJ", shortened(word)));
                return Err(at_line(error.cure(
                    "correct the line, or make it a comment with # at its beginning",
                )));
            }
            _ => (),
        }
    }
    let mut faces = Vec::with_capacity(polygons.len());
    for (i, (number, range)) in polygons.into_iter().enumerate() {
        if i % POLYGONS_AT_ONCE == 0 {
            watch(0)?;
        }
        let at_line = |e: Error| e.at(format!("line {number}"));
        polygon::add_polygon(&vertices, &corners[range], &mut faces).map_err(at_line)?;
    }
    let warnings = open_line(bytes).into_iter().collect();
    Ok(Triangles {
        vertices,
        faces,
        crs: crs_text::parse(&crs)?,
        warnings,
        ..Default::default()
    })
}

/// The statements that are skipped (Wavefront, Appendix B1, and what later programs write).
const STATEMENTS: &[&str] = &[
    "vt",
    "vn",
    "vp",
    "p",
    "l",
    "o",
    "g",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "call",
    "csh",
    "fo",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
    "res",
    "refl",
];

/// Returns the lines, numbered from 1. Lines that end in a backslash are joined with the next and
/// have the number of the first.
fn logical_lines(bytes: &[u8]) -> impl Iterator<Item = (usize, String)> {
    let mut lines = bytes.split(|&b| b == b'\n').enumerate();
    std::iter::from_fn(move || {
        let (first, line) = lines.next()?;
        let mut text = String::from_utf8_lossy(line)
            .trim_end_matches('\r')
            .to_owned();
        while text.ends_with('\\') {
            text.pop();
            text.push(' ');
            match lines.next() {
                Some((_, line)) => {
                    text.push_str(String::from_utf8_lossy(line).trim_end_matches('\r'))
                }
                None => break,
            }
        }
        Some((first + 1, text))
    })
}

fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3]> {
    let mut p = [0.0; 3];
    for (value, axis) in p.iter_mut().zip(["x", "y", "z"]) {
        let word = words
            .next()
            .ok_or_else(|| Error::format(format!("a vertex without {axis}")))?;
        *value = word.parse().map_err(|_| {
            Error::format(format!("'{}' is not a number for {axis}", shortened(word)))
        })?;
    }
    Ok(p)
}

/// Parses a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers count back from the last
/// vertex.
fn corner(word: &str, vertices_so_far: usize) -> Result<u32> {
    let number: Option<i64> = word
        .split('/')
        .next()
        .and_then(|number| number.parse().ok());
    number
        .and_then(|n| {
            if n < 0 {
                n.checked_add(vertices_so_far as i64)
            } else {
                n.checked_sub(1)
            }
        })
        .and_then(|index| u32::try_from(index).ok())
        .ok_or_else(|| {
            Error::format(format!(
                "'{}' names no vertex (the first is 1)",
                shortened(word)
            ))
        })
}

fn shortened(word: &str) -> String {
    word.chars().take(40).collect()
}

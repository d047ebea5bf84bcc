//! DXF drawings of release 12 (AC1009), as text: triangles, lines, polylines and texts on layers.
//! Every CAD program reads them.

mod contours;
mod read;

use std::collections::BTreeSet;
use std::io::{Result, Write};

pub(crate) use contours::{write_contours, write_map};
pub(crate) use read::read;

use crate::crs::Crs;
use crate::data::{Bounds, EdgeKind, Layer, Shape};
use crate::error;
use crate::io::bytes::output::Destination;
use crate::io::codec::listing::{Listing, Remarks, crs_text, lines};

/// The bytes of the name of a layer, at most.
const NAME: usize = 31;

/// The bytes of a text, at most.
const LONGEST: usize = 250;

/// Writes the lines of a layer as polylines in space, and returns warnings. Vertices without a
/// height are at 0.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_lines(target: Destination, layer: &Layer) -> error::Result<Vec<String>> {
    let mut bounds = Bounds::default();
    let at_height = |&[x, y, z]: &[f64; 3]| [x, y, if z.is_finite() { z } else { 0.0 }];
    let vertices = layer.shapes.iter().flat_map(Shape::vertices);
    vertices.for_each(|p| bounds.add(at_height(p)));
    let layers = vec![DxfLayer::new("LINES", 7, &mut BTreeSet::new())];
    target.write_with(|out| {
        let mut drawing = Dxf::begin(out, layers, &bounds)?;
        for line in layer.lines() {
            drawing.polyline(0, line.iter().map(at_height))?;
        }
        drawing.end()
    })?;
    let has_attributes = layer
        .attributes
        .as_ref()
        .is_some_and(|of| !of.names.is_empty());
    let left_out = "a DXF drawing has no attributes: they are left out";
    Ok(has_attributes
        .then(|| left_out.to_owned())
        .into_iter()
        .collect())
}

/// Writes a surface: its triangles as 3DFACE on the layer `SURFACE`, its rim and those of its holes
/// as closed polylines on `BOUNDARY`, and its lines as polylines on a layer for each kind. All are
/// in space.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_surface(
    target: Destination,
    mesh: &Listing,
    crs: Option<&Crs>,
) -> error::Result<Remarks> {
    let mut bounds = Bounds::default();
    mesh.vertices().for_each(|p| bounds.add(p));
    let all = lines::lines(mesh.surface);
    let mut taken = BTreeSet::new();
    let mut layers = vec![
        DxfLayer::new("SURFACE", 8, &mut taken),
        DxfLayer::new("BOUNDARY", 7, &mut taken),
    ];
    let kinds = all.iter().map(|of| of.kind);
    layers.extend(kinds.map(|kind| DxfLayer::new(kind.noun(), color(kind), &mut taken)));
    let at = |&v: &u32| mesh.surface.position(v);
    target.write_with(|out| {
        for line in crs_text::comments(crs) {
            // This release has no longer texts.
            if line.len() < LONGEST {
                writeln!(out, "999\n{line}")?;
            }
        }
        let mut drawing = Dxf::begin(out, layers, &bounds)?;
        for corners in mesh.triangles() {
            drawing.face(0, corners)?;
        }
        for ring in lines::rings(mesh.surface) {
            drawing.polyline(1, ring.iter().chain(ring.first()).map(at))?;
        }
        for (number, of) in all.iter().enumerate() {
            for line in &of.lines {
                drawing.polyline(2 + number, line.iter().map(at))?;
            }
        }
        drawing.end()
    })?;
    let notes = crs.map(|crs| {
        format!("a drawing has no coordinate system, which is a comment at most: {crs}")
    });
    Ok(Remarks {
        notes: notes.into_iter().collect(),
        ..Remarks::default()
    })
}

/// Returns the color of lines of a kind.
fn color(kind: EdgeKind) -> u8 {
    match kind {
        EdgeKind::Wall => 1,
        EdgeKind::Shore => 5,
        EdgeKind::Bank => 4,
        EdgeKind::Soft => 2,
        EdgeKind::Draped => 3,
        _ => 6,
    }
}

/// A layer of a drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DxfLayer {
    name: String,
    color: u8,
}

/// How a text lies at its position: above it, but for `Middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Align {
    Left,
    Center,
    Right,
    /// Around it, in a direction in degrees counter-clockwise from x.
    Middle {
        direction: f64,
    },
}

impl DxfLayer {
    /// Returns a layer of one of the numbered colors: 1 red, 2 yellow, 3 green, 4 cyan, 5 blue, 6
    /// magenta, 7 black or white, 8 gray.
    ///
    /// Names of this release have capital letters, digits, `$`, `-` and `_`; others become `_`.
    /// One that is `taken` is numbered.
    pub(crate) fn new(name: &str, color: u8, taken: &mut BTreeSet<String>) -> Self {
        let plain = |c: char| match c.to_ascii_uppercase() {
            c if c.is_ascii_alphanumeric() || "$-_".contains(c) => c,
            _ => '_',
        };
        let whole: String = name.chars().map(plain).take(NAME).collect();
        let whole = if whole.is_empty() {
            "_".to_owned()
        } else {
            whole
        };
        let numbered = (2..).map(|number| {
            let end = format!("_{number}");
            let start: String = whole.chars().take(NAME - end.len().min(NAME)).collect();
            start + &end
        });
        let name = std::iter::once(whole.clone())
            .chain(numbered)
            .find(|name| !taken.contains(name))
            .unwrap_or_default();
        taken.insert(name.clone());
        DxfLayer { name, color }
    }
}

/// A drawing while it is written.
pub(crate) struct Dxf<'a> {
    out: &'a mut dyn Write,
    layers: Vec<DxfLayer>,
}

impl<'a> Dxf<'a> {
    /// Begins a drawing with these layers, which later calls name by their positions. Its extent is
    /// not stated unless the bounds are finite.
    pub(crate) fn begin(
        out: &'a mut dyn Write,
        layers: Vec<DxfLayer>,
        bounds: &Bounds,
    ) -> Result<Self> {
        let mut drawing = Dxf { out, layers };
        drawing.header(bounds)?;
        Ok(drawing)
    }

    fn header(&mut self, Bounds { min, max }: &Bounds) -> Result<()> {
        self.words(&[
            (0, "SECTION"),
            (2, "HEADER"),
            (9, "$ACADVER"),
            (1, "AC1009"),
        ])?;
        // Where they are left out, programs compute them.
        let is_known = min.iter().chain(max).all(|c| c.is_finite());
        if is_known {
            for (name, corner) in [("$EXTMIN", min), ("$EXTMAX", max)] {
                self.word(9, name)?;
                self.point(0, *corner)?;
            }
        }
        self.words(&[(0, "ENDSEC"), (0, "SECTION"), (2, "TABLES")])?;
        self.words(&[
            (0, "TABLE"),
            (2, "LTYPE"),
            (70, "1"),
            (0, "LTYPE"),
            (2, "CONTINUOUS"),
        ])?;
        self.words(&[
            (70, "0"),
            (3, "Solid line"),
            (72, "65"),
            (73, "0"),
            (40, "0.0"),
        ])?;
        self.words(&[(0, "ENDTAB"), (0, "TABLE"), (2, "LAYER")])?;
        let layers = self.layers.clone();
        self.word(70, &layers.len().to_string())?;
        for DxfLayer { name, color } in &layers {
            let color = color.to_string();
            self.words(&[
                (0, "LAYER"),
                (2, name),
                (70, "0"),
                (62, &color),
                (6, "CONTINUOUS"),
            ])?;
        }
        self.words(&[
            (0, "ENDTAB"),
            (0, "TABLE"),
            (2, "STYLE"),
            (70, "1"),
            (0, "STYLE"),
        ])?;
        self.words(&[
            (2, "STANDARD"),
            (70, "0"),
            (40, "0.0"),
            (41, "1.0"),
            (50, "0.0"),
        ])?;
        self.words(&[
            (71, "0"),
            (42, "1.0"),
            (3, "txt"),
            (4, ""),
            (0, "ENDTAB"),
            (0, "ENDSEC"),
        ])?;
        self.words(&[(0, "SECTION"), (2, "ENTITIES")])
    }

    /// Draws a line between two points.
    pub(crate) fn line(&mut self, layer: usize, [from, to]: [[f64; 3]; 2]) -> Result<()> {
        self.entity("LINE", layer)?;
        self.point(0, from)?;
        self.point(1, to)
    }

    /// Draws a triangle in space.
    pub(crate) fn face(&mut self, layer: usize, [a, b, c]: [[f64; 3]; 3]) -> Result<()> {
        self.entity("3DFACE", layer)?;
        // The last of four corners is the third again.
        (0..)
            .zip([a, b, c, c])
            .try_for_each(|(which, corner)| self.point(which, corner))
    }

    /// Draws a polyline in space.
    pub(crate) fn polyline(
        &mut self,
        layer: usize,
        points: impl IntoIterator<Item = [f64; 3]>,
    ) -> Result<()> {
        self.entity("POLYLINE", layer)?;
        self.words(&[(66, "1")])?;
        self.point(0, [0.0; 3])?;
        self.word(70, "8")?;
        for at in points {
            self.entity("VERTEX", layer)?;
            self.point(0, at)?;
            self.word(70, "32")?;
        }
        self.entity("SEQEND", layer)
    }

    /// Draws a polyline in the plane at a height. One that ends where it begins is closed.
    fn contour(&mut self, layer: usize, height: f64, points: &[[f64; 2]]) -> Result<()> {
        let is_closed = points.len() > 2 && points.first() == points.last();
        let height = if height.is_finite() { height } else { 0.0 };
        self.entity("POLYLINE", layer)?;
        self.words(&[(66, "1")])?;
        self.point(0, [0.0, 0.0, height])?;
        self.word(70, if is_closed { "1" } else { "0" })?;
        let count = points.len() - usize::from(is_closed);
        for &[x, y] in &points[..count] {
            self.entity("VERTEX", layer)?;
            self.point(0, [x, y, height])?;
        }
        self.entity("SEQEND", layer)
    }

    /// Writes a text at a position.
    pub(crate) fn text(
        &mut self,
        layer: usize,
        at: [f64; 3],
        height: f64,
        align: Align,
        text: &str,
    ) -> Result<()> {
        self.entity("TEXT", layer)?;
        self.point(0, at)?;
        self.number(40, height)?;
        self.word(1, &encoded(text))?;
        match align {
            Align::Left => return Ok(()),
            Align::Center => self.word(72, "1")?,
            Align::Right => self.word(72, "2")?,
            Align::Middle { direction } => {
                self.number(50, direction)?;
                self.words(&[(72, "1"), (73, "2")])?;
            }
        }
        self.point(1, at)
    }

    /// Ends the drawing.
    pub(crate) fn end(mut self) -> Result<()> {
        self.words(&[(0, "ENDSEC"), (0, "EOF")])
    }

    fn entity(&mut self, kind: &str, layer: usize) -> Result<()> {
        self.word(0, kind)?;
        let name = self
            .layers
            .get(layer)
            .map_or("0", |layer| layer.name.as_str());
        writeln!(self.out, "8\n{name}")
    }

    fn word(&mut self, code: u8, value: &str) -> Result<()> {
        writeln!(self.out, "{code}\n{value}")
    }

    fn words(&mut self, pairs: &[(u8, &str)]) -> Result<()> {
        pairs
            .iter()
            .try_for_each(|(code, value)| self.word(*code, value))
    }

    fn number(&mut self, code: u8, value: f64) -> Result<()> {
        writeln!(self.out, "{code}\n{value:?}")
    }

    fn point(&mut self, which: u8, at: [f64; 3]) -> Result<()> {
        (1..)
            .zip(at)
            .try_for_each(|(axis, c)| self.number(10 * axis + which, c))
    }
}

/// Returns a text of one line, with characters beyond ASCII as CAD programs write them.
fn encoded(text: &str) -> String {
    let mut found = String::new();
    for c in text.chars() {
        match c {
            // A caret stands for a control character with the one behind it; before a blank, for
            // itself.
            '^' => found += "^ ",
            ' '..='~' => found.push(c),
            c if c.is_control() => found.push(' '),
            c if (c as u32) < 0x1_0000 => found += &format!("\\U+{:04X}", c as u32),
            _ => found.push('?'),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_is_pairs_of_codes_and_values() {
        let mut taken = BTreeSet::new();
        let long = "a name of more than thirty-one bytes";
        let layers: Vec<DxfLayer> = ["Höhe.tif", "H_he tif", "", long, long]
            .iter()
            .map(|name| DxfLayer::new(name, 3, &mut taken))
            .collect();
        let names: Vec<&str> = layers.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(
            names,
            [
                "H_HE_TIF",
                "H_HE_TIF_2",
                "_",
                "A_NAME_OF_MORE_THAN_THIRTY-ONE_",
                "A_NAME_OF_MORE_THAN_THIRTY-ON_2"
            ]
        );
        let mut bytes = Vec::new();
        let bounds = Bounds {
            min: [0.0; 3],
            max: [4.0, 3.0, 0.0],
        };
        let mut drawing = Dxf::begin(&mut bytes, layers, &bounds).unwrap();
        drawing.line(0, [[0.0; 3], [4.0, 3.0, 0.5]]).unwrap();
        drawing.polyline(1, [[0.0; 3], [1e-7, 1e22, -0.5]]).unwrap();
        drawing
            .text(2, [1.0; 3], 2.5, Align::Right, "Höhe\n^J 100 %")
            .unwrap();
        drawing.end().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len() % 2, 0);
        let pairs: Vec<(u8, &str)> = lines
            .chunks(2)
            .map(|pair| (pair[0].parse().unwrap(), pair[1]))
            .collect();
        assert_eq!(
            (pairs[0], pairs[pairs.len() - 1]),
            ((0, "SECTION"), (0, "EOF"))
        );
        assert!(pairs.contains(&(1, "H\\U+00F6he ^ J 100 %")));
        assert!(pairs.contains(&(20, "1e22")) && pairs.contains(&(10, "1e-7")));
        let count = |kind: &str| pairs.iter().filter(|pair| **pair == (0, kind)).count();
        assert_eq!(
            ["LINE", "POLYLINE", "VERTEX", "SEQEND", "TEXT", "LAYER"].map(count),
            [1, 1, 2, 1, 1, 5]
        );
    }
}

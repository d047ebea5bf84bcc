//! The polygon file format (Turk 1994, "The PLY Polygon File Format").
//!
//! The header names elements and their properties; the body contains their values in that order.
//! Readers take what they know and skip the rest, so that a file can contain more. The parent
//! module describes the content of our files.

mod body;
mod header;

use std::io::Write;

use body::Body;
use header::{Element, Encoding, Header, Property, Scalar};

use super::listing::polygon::POLYGONS_AT_ONCE;
use super::listing::{Listing, crs_text, polygon};
use crate::crs::Crs;
use crate::data::{self, EdgeKind, Face, Triangles};
use crate::error::{Error, Result};
use crate::io::options::cut::open_line;
use crate::io::{Destination, Watch};

/// The properties for the kinds of a face's edges. The first edge goes from the first corner to the
/// second, and so on.
const EDGES: [&str; 3] = ["edge1", "edge2", "edge3"];
const FRAGMENT: &str = "piece";

/// Writes vertices, faces, the kinds of their edges if there are lines, and the coordinate system.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<()> {
    let vertex_count = mesh.vertex_count;
    if i32::try_from(vertex_count).is_err() {
        return Err(Error::limit(format!(
            "{vertex_count} vertices; a PLY file with int numbers has {}",
            i32::MAX
        )));
    }
    let mut output = target.create()?;
    write!(
        output,
        "ply\nformat binary_little_endian 1.0\ncomment breakline\n"
    )?;
    for line in crs_text::comments(crs) {
        writeln!(output, "comment {line}")?;
    }
    write!(
        output,
        "element vertex {vertex_count}\nproperty double x\nproperty double y\nproperty double z\n"
    )?;
    write!(
        output,
        "element face {}\nproperty list uchar int vertex_indices\n",
        mesh.face_count
    )?;
    let has_lines = mesh.constrained_edges > 0;
    if has_lines {
        EDGES
            .iter()
            .chain([&FRAGMENT])
            .try_for_each(|name| writeln!(output, "property uchar {name}"))?;
    }
    output.write_all(b"end_header\n")?;
    let row = |p: &[f64; 3]| p.map(f64::to_le_bytes);
    let rows = |points: &[[f64; 3]]| points.iter().map(row).collect::<Vec<_>>();
    let ask = |numbers, points: &mut _| mesh.vertices_in(numbers, points);
    data::map_batches(mesh.surface.vertex_count(), ask, rows, |rows| {
        output.write_all(rows.as_flattened().as_flattened())
    })?;
    let list = |corners: [u32; 3]| {
        let mut list = [3; 13];
        for (bytes, v) in list[1..].chunks_exact_mut(4).zip(mesh.numbers(corners)) {
            bytes.copy_from_slice(&v.to_le_bytes());
        }
        list
    };
    let surface = mesh.surface;
    let faces = surface.face_count();
    if has_lines {
        let row = |face: &Face| {
            let mut row = [0; 17];
            row[..13].copy_from_slice(&list(face.corners));
            let [b, c, a] = face.edges.map(EdgeKind::number);
            row[13..].copy_from_slice(&[a, b, c, u8::from(surface.is_fragment(face.number))]);
            row
        };
        let ask = |numbers, faces: &mut _| surface.faces_in(numbers, faces);
        let rows = |faces: &[Face]| faces.iter().map(row).collect::<Vec<_>>();
        data::map_batches(faces, ask, rows, |rows| {
            output.write_all(rows.as_flattened())
        })?;
    } else {
        let ask = |numbers, faces: &mut _| surface.corners_in(numbers, faces);
        let row = |(_, corners): &(u32, [u32; 3])| list(*corners);
        let rows = |faces: &[(u32, [u32; 3])]| faces.iter().map(row).collect::<Vec<_>>();
        data::map_batches(faces, ask, rows, |rows| {
            output.write_all(rows.as_flattened())
        })?;
    }
    target.put(output)
}

/// Reads the elements `vertex`, `face` and, in files of earlier versions, `constrained_edge`, in
/// any order and with any types.
pub(crate) fn read(bytes: &[u8], watch: Watch) -> Result<Triangles> {
    let header = Header::read(bytes)?;
    let has = |name: &str| {
        header
            .elements
            .iter()
            .any(|e| e.name == name && e.count > 0)
    };
    if !has("face") && has("tristrips") {
        return Err(
            Error::unsupported("the faces are triangle strips ('tristrips')")
                .cure("save them as triangles"),
        );
    }
    let mut body = Body::new(&bytes[header.length..], header.encoding, watch);
    let mut vertices = Vec::new();
    let mut polygons = Polygons::default();
    let mut listed = Vec::new();
    for element in &header.elements {
        body.check_room(element)?;
        match element.name.as_str() {
            "vertex" => vertices = read_vertices(&mut body, element)?,
            "face" => polygons = read_faces(&mut body, element)?,
            "constrained_edge" => listed = read_edges(&mut body, element)?,
            _ => body.rows(element, |_, _| Ok(()))?,
        }
    }
    let open = if header.encoding == Encoding::Ascii {
        open_line(bytes)
    } else {
        None
    };
    let crs = crs_text::parse(&header.crs)?;
    let mut lines = std::mem::take(&mut polygons.lines);
    lines.extend(listed.into_iter().map(|edge| (edge, EdgeKind::Breakline)));
    let sides = polygons.take_sides();
    let warnings = open.into_iter().collect();
    let mut triangles = Triangles {
        vertices,
        lines,
        sides,
        crs,
        warnings,
        ..Triangles::default()
    };
    triangles.faces.reserve_exact(polygons.ends.len());
    let mut start = 0;
    let mut fragments = polygons.fragments.into_iter().peekable();
    for (i, end) in polygons.ends.into_iter().enumerate() {
        if i % POLYGONS_AT_ONCE == 0 {
            watch(0)?;
        }
        let corners = &polygons.corners[start..end];
        let first = triangles.faces.len() as u32;
        polygon::add_polygon(&triangles.vertices, corners, &mut triangles.faces)
            .map_err(|e| e.at(format!("face {i}")))?;
        if fragments.next_if_eq(&i).is_some() {
            triangles
                .fragments
                .extend(first..triangles.faces.len() as u32);
        }
        start = end;
    }
    // What a face says is wrong names the place better than this.
    body.end()?;
    Ok(triangles)
}

fn read_vertices(body: &mut Body, element: &Element) -> Result<Vec<[f64; 3]>> {
    let axes = [
        scalar(element, "x")?,
        scalar(element, "y")?,
        scalar(element, "z")?,
    ];
    let mut vertices = Vec::with_capacity(element.count);
    body.rows(element, |_, row| {
        vertices.push(axes.map(|i| row[i][0]));
        Ok(())
    })?;
    Ok(vertices)
}

/// Faces as stored in the file.
#[derive(Default)]
struct Polygons {
    /// The corners of all faces, one face after the other.
    corners: Vec<u32>,
    /// For each face, the end of its corners.
    ends: Vec<usize>,
    /// Edges on lines, with their kinds.
    lines: Vec<([u32; 2], EdgeKind)>,
    /// For each face, the kinds of its first three edges, if the file states them.
    kinds: Vec<[EdgeKind; 3]>,
    /// Indices of the faces that are fragments of cut triangles.
    fragments: Vec<usize>,
}

impl Polygons {
    /// Returns the kind of the edge opposite each corner of each face, if the file states the kinds
    /// and all faces are triangles.
    fn take_sides(&mut self) -> Option<Vec<[EdgeKind; 3]>> {
        if self.kinds.is_empty() || self.corners.len() != 3 * self.ends.len() {
            return None;
        }
        let mut sides = std::mem::take(&mut self.kinds);
        // The first edge, from corner 0 to corner 1, is opposite corner 2.
        sides.iter_mut().for_each(|kinds| kinds.rotate_left(1));
        Some(sides)
    }
}

fn read_faces(body: &mut Body, element: &Element) -> Result<Polygons> {
    let names = ["vertex_indices", "vertex_index"];
    let list = element
        .properties
        .iter()
        .position(|p| names.contains(&p.name.as_str()) && p.length.is_some());
    let list =
        list.ok_or_else(|| Error::format("the faces have no list 'vertex_indices'").at("header"))?;
    let lines = line_properties(element);
    let mut polygons = Polygons::default();
    polygons.corners.reserve_exact(element.count);
    polygons.ends.reserve_exact(element.count);
    body.rows(element, |number, row| {
        let first = polygons.corners.len();
        for &number in &row[list] {
            polygons.corners.push(vertex_number(number)?);
        }
        polygons.ends.push(polygons.corners.len());
        let corners = &polygons.corners[first..];
        let Some((properties, fragment)) = lines else {
            return Ok(());
        };
        let mut kinds = [EdgeKind::Plain; 3];
        for (i, property) in properties.into_iter().enumerate() {
            let kind = edge_kind(EDGES[i], row[property][0])?;
            kinds[i] = kind;
            if !kind.is_constrained() {
                continue;
            }
            if let (Some(&a), Some(&b)) = (corners.get(i), corners.iter().cycle().nth(i + 1)) {
                polygons.lines.push(([a.min(b), a.max(b)], kind));
            }
        }
        polygons.kinds.push(kinds);
        if row[fragment][0] != 0.0 {
            polygons.fragments.push(number);
        }
        Ok(())
    })?;
    // Interior edges are seen from both sides.
    polygons.lines.sort_unstable();
    polygons.lines.dedup();
    Ok(polygons)
}

/// Returns the positions of the properties for the kinds of a face's edges, and of the property
/// that marks fragments, if all have the types that breakline writes. In files of other programs,
/// properties with these names have another meaning.
fn line_properties(element: &Element) -> Option<([usize; 3], usize)> {
    let position = |name: &str| {
        let at = scalar(element, name).ok()?;
        (element.properties[at].kind == Scalar::U8).then_some(at)
    };
    let [a, b, c] = EDGES.map(position);
    Some(([a?, b?, c?], position(FRAGMENT)?))
}

fn edge_kind(name: &str, number: f64) -> Result<EdgeKind> {
    let kind = EdgeKind::ALL
        .into_iter()
        .find(|kind| f64::from(kind.number()) == number);
    kind.ok_or_else(|| {
        Error::format(format!(
            "{name} is {number}, expected the number of a kind of edges, 0 to 8"
        ))
    })
}

fn read_edges(body: &mut Body, element: &Element) -> Result<Vec<[u32; 2]>> {
    let ends = [scalar(element, "vertex1")?, scalar(element, "vertex2")?];
    let mut edges = Vec::with_capacity(element.count);
    body.rows(element, |_, row| {
        edges.push([
            vertex_number(row[ends[0]][0])?,
            vertex_number(row[ends[1]][0])?,
        ]);
        Ok(())
    })?;
    Ok(edges)
}

/// Returns the position of a property with a single value among the properties of its element.
fn scalar(element: &Element, name: &str) -> Result<usize> {
    let is_it = |p: &Property| p.name == name && p.length.is_none();
    element.properties.iter().position(is_it).ok_or_else(|| {
        Error::format(format!(
            "the element '{}' has no property '{name}'",
            element.name
        ))
        .at("header")
    })
}

fn vertex_number(number: f64) -> Result<u32> {
    if number >= 0.0 && number < f64::from(u32::MAX) && number.fract() == 0.0 {
        return Ok(number as u32);
    }
    Err(Error::format(format!(
        "{number} is not the number of a vertex"
    )))
}

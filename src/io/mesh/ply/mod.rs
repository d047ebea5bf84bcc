//! The polygon file format (Turk 1994, "The PLY Polygon File Format").
//!
//! The header names elements and their properties; the body has their values in that order. Readers
//! take what they know and pass over the rest, so that a file can carry more. What our files carry
//! is told in the parent module.

mod body;
mod header;

use std::io::Write;
use std::path::Path;

use body::Body;
use header::{Element, Header, Property};

use super::listing::Listing;
use super::{crs_text, polygon};
use crate::crs::Crs;
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::Output;

/// Writes vertices, faces, constrained edges and the coordinate system.
pub(super) fn write(target: &Path, mesh: &Listing, crs: Option<&Crs>) -> Result<()> {
    let vertex_count = mesh.vertex_count;
    if i32::try_from(vertex_count).is_err() {
        return Err(Error::limit(format!("{vertex_count} vertices; a PLY file with int numbers has {}", i32::MAX)));
    }
    let mut output = Output::create(target)?;
    write!(output, "ply\nformat binary_little_endian 1.0\ncomment breakline\n")?;
    for line in crs_text::lines(crs) {
        writeln!(output, "comment crs {line}")?;
    }
    write!(output, "element vertex {vertex_count}\nproperty double x\nproperty double y\nproperty double z\n")?;
    write!(output, "element face {}\nproperty list uchar int vertex_indices\n", mesh.face_count)?;
    if !mesh.constrained_edges.is_empty() {
        let count = mesh.constrained_edges.len();
        write!(output, "element constrained_edge {count}\nproperty int vertex1\nproperty int vertex2\n")?;
    }
    output.write_all(b"end_header\n")?;
    mesh.vertices().try_for_each(|p| {
        let mut row = [0; 24];
        for (bytes, value) in row.chunks_exact_mut(8).zip(p) {
            bytes.copy_from_slice(&value.to_le_bytes());
        }
        output.write_all(&row)
    })?;
    mesh.faces().try_for_each(|face| {
        let mut row = [3; 13];
        for (bytes, v) in row[1..].chunks_exact_mut(4).zip(face) {
            bytes.copy_from_slice(&v.to_le_bytes());
        }
        output.write_all(&row)
    })?;
    for [a, b] in &mesh.constrained_edges {
        output.write_all(&a.to_le_bytes())?;
        output.write_all(&b.to_le_bytes())?;
    }
    output.commit()
}

/// Reads the elements `vertex`, `face` and `constrained_edge`, whatever their order and types.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles> {
    let header = Header::read(bytes)?;
    let has = |name: &str| header.elements.iter().any(|e| e.name == name && e.count > 0);
    if !has("face") {
        return Err(match has("tristrips") {
            true => Error::unsupported("the faces are triangle strips ('tristrips')").cure("save them as triangles"),
            false => Error::format("there are no faces: the file is a point cloud"),
        });
    }
    let mut body = Body::new(&bytes[header.length..], header.encoding);
    let mut vertices = Vec::new();
    let mut polygons = Polygons::default();
    let mut edges = Vec::new();
    for element in &header.elements {
        body.check_room(element)?;
        match element.name.as_str() {
            "vertex" => vertices = read_vertices(&mut body, element)?,
            "face" => polygons = read_faces(&mut body, element)?,
            "constrained_edge" => edges = read_edges(&mut body, element)?,
            _ => body.rows(element, |_, _| Ok(()))?,
        }
    }
    let mut faces = Vec::with_capacity(polygons.ends.len());
    let mut start = 0;
    for (i, end) in polygons.ends.into_iter().enumerate() {
        let corners = &polygons.corners[start..end];
        polygon::add_polygon(&vertices, corners, &mut faces).map_err(|e| e.at(format!("face {i}")))?;
        start = end;
    }
    let crs = crs_text::parse(&header.crs)?;
    Ok(Triangles { vertices, faces, constrained_edges: edges, crs, ..Triangles::default() })
}

fn read_vertices(body: &mut Body, element: &Element) -> Result<Vec<[f64; 3]>> {
    let axes = [scalar(element, "x")?, scalar(element, "y")?, scalar(element, "z")?];
    let mut vertices = Vec::with_capacity(element.count);
    body.rows(element, |_, row| {
        vertices.push(axes.map(|i| row[i][0]));
        Ok(())
    })?;
    Ok(vertices)
}

/// Corners of faces, one after the other, and where each face ends.
#[derive(Default)]
struct Polygons {
    corners: Vec<u32>,
    ends: Vec<usize>,
}

fn read_faces(body: &mut Body, element: &Element) -> Result<Polygons> {
    let names = ["vertex_indices", "vertex_index"];
    let list = element.properties.iter().position(|p| names.contains(&p.name.as_str()) && p.length.is_some());
    let list = list.ok_or_else(|| Error::format("the faces have no list 'vertex_indices'").at("header"))?;
    let mut polygons = Polygons { corners: Vec::with_capacity(element.count), ends: Vec::with_capacity(element.count) };
    body.rows(element, |_, row| {
        for &number in &row[list] {
            polygons.corners.push(vertex_number(number)?);
        }
        polygons.ends.push(polygons.corners.len());
        Ok(())
    })?;
    Ok(polygons)
}

fn read_edges(body: &mut Body, element: &Element) -> Result<Vec<[u32; 2]>> {
    let ends = [scalar(element, "vertex1")?, scalar(element, "vertex2")?];
    let mut edges = Vec::with_capacity(element.count);
    body.rows(element, |_, row| {
        edges.push([vertex_number(row[ends[0]][0])?, vertex_number(row[ends[1]][0])?]);
        Ok(())
    })?;
    Ok(edges)
}

/// Where a property with one value stands among the properties of its element.
fn scalar(element: &Element, name: &str) -> Result<usize> {
    let is_it = |p: &Property| p.name == name && p.length.is_none();
    element
        .properties
        .iter()
        .position(is_it)
        .ok_or_else(|| Error::format(format!("the element '{}' has no property '{name}'", element.name)).at("header"))
}

fn vertex_number(number: f64) -> Result<u32> {
    if number >= 0.0 && number < f64::from(u32::MAX) && number.fract() == 0.0 {
        return Ok(number as u32);
    }
    Err(Error::format(format!("{number} is no number of a vertex")))
}

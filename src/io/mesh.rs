//! Triangle meshes: PLY, OBJ, OFF and STL; to read, Triangle's `.ele` too.
//!
//! | format | coordinates | lines, coordinate system | read |
//! |---|---|---|---|
//! | PLY | doubles | yes | yes |
//! | OBJ | decimals that give the same doubles back | coordinate system, as a comment | yes |
//! | OFF | the same | the same | yes |
//! | STL | 32-bit floats from a local origin | no | no |
//! | `.ele` with its `.node` | the same as OBJ; heights are 0 | breaklines | yes; to write, see [`super::triangle`] |
//!
//! Vertices and faces come in the order of the surface, which for a TIN is a function of its points and
//! lines: along a curve, so that neighbors stand near each other. Vertices without a face are not written.
//!
//! # What PLY files hold
//! `format binary_little_endian 1.0`, then the elements
//! - `vertex`: `double x`, `double y`, `double z`;
//! - `face`: `list uchar int vertex_indices`, three each, counter-clockwise in plan; where the surface has lines,
//!   then `uchar edge1`, `uchar edge2`, `uchar edge3`, what the edges from the first corner to the second and so on around
//!   are (0 plain, 1 on a breakline, 2 on a clip line, 3 at the rim), and `uchar piece`, 1 for a piece of a triangle
//!   that was cut. QGIS shows these as values of the faces; of files with the element `edge` it would show the lines
//!   only, and it opens none with an element that it does not know.
//!
//! Files of earlier versions have breaklines as an element `constrained_edge` instead, with `vertex1` and `vertex2`.
//!
//! The coordinate system stands in the header as `comment crs: EPSG:25832`, or as WKT in the place of the code. Some
//! readers take no line over 1024 bytes, so that WKT of 1000 bytes and more is cut into lines `comment crs PART`, to be
//! joined. The comments of OBJ and OFF are alike, with `#`.

use std::path::{Path, PathBuf};

use super::formats::{self, Content, Holding, Product, Reader};
use super::listing::Listing;
use super::output::Destination;
pub use super::stl::Solid;
use crate::data::{Mesh, Surface, Triangles};
use crate::error::{Error, Result};

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSummary {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub faces: usize,
    /// Edges on breaklines and clip lines.
    pub constrained_edges: usize,
    /// How many of these cannot be told from others in the file: all, unless the format has
    /// [edges](Holding::Edges).
    pub lost_edges: usize,
    /// What was subtracted from all coordinates, and the file beside the mesh that says so.
    pub origin: Option<([f64; 3], PathBuf)>,
}

/// Writes a surface, in the format that the extension of `target` names.
///
/// # Errors
/// If the extension names no mesh format, the surface is too large for the format, or the file cannot
/// be written.
pub fn write<'a>(target: impl Into<Destination<'a>>, surface: &dyn Surface) -> Result<MeshSummary> {
    let target = target.into();
    let format = formats::of_name(&target.format_path()).filter(|format| format.content == Content::Mesh);
    let format = format.ok_or_else(|| unknown(target.path()))?;
    let Some(write) = format.writers.surface else {
        return Err(Error::unsupported(format!(
            "a surface is not written as .{}, which has no heights",
            format.extensions[0]
        ))
        .in_file(target.path())
        .cure(format!("use {}", formats::extensions_or(Product::Surface))));
    };
    let mesh = Listing::new(surface);
    let origin = write(target, &mesh, surface.crs());
    Ok(MeshSummary {
        vertices: mesh.vertex_count,
        faces: mesh.face_count,
        constrained_edges: mesh.constrained_edges,
        lost_edges: if format.can_hold(Holding::Edges) { 0 } else { mesh.constrained_edges },
        origin: origin.map_err(|e| e.in_file(target.path()))?,
    })
}

/// Reads what a file of single triangles without exact coordinates holds (STL), which is not read as a surface. `None`
/// for a file of another format.
///
/// # Errors
/// If it is damaged or text, or the file with its origin is.
pub fn describe_solid(path: &Path) -> Option<Result<Solid>> {
    match formats::of_name(path)?.reader {
        Reader::Solid(describe) => Some(describe(path).map_err(|e| e.in_file(path))),
        _ => None,
    }
}

/// Returns true if a file of this name tells which edges lie on breaklines. Without that, the Delaunay law cannot be
/// asked of it.
pub fn keeps_lines(path: &Path) -> bool {
    formats::of_name(path).is_some_and(|format| format.can_hold(Holding::Edges))
}

/// Reads a mesh that is a surface, own or foreign, of any format but STL. Polygons are divided into triangles.
///
/// The file is held in memory while it is read.
///
/// # Errors
/// If the file is damaged, is no surface ([`Mesh::new`] says what is none), has no faces or polygons
/// that are far from convex, or the format is not one that is read.
pub fn read(path: &Path) -> Result<Mesh> {
    Mesh::of(read_triangles(path)?).map_err(|e| e.in_file(path))
}

/// Reads the triangles of a mesh, whether they are a surface or not: for a check, say.
///
/// # Errors
/// As [`read`], but for what is no surface.
pub fn read_triangles(path: &Path) -> Result<Triangles> {
    let read = match formats::of_name(path).map(|format| (format, format.reader)) {
        Some((_, Reader::Mesh(read))) => read,
        Some((format, Reader::Solid(_))) => {
            let name = format.name;
            return Err(Error::unsupported(format!("{name} meshes are not read: they have no exact coordinates"))
                .in_file(path)
                .cure("use PLY, which keeps coordinates, breaklines and the coordinate system"));
        }
        _ => return Err(unknown(path)),
    };
    read(path).map_err(|e| e.in_file(path))
}

#[cold]
fn unknown(path: &Path) -> Error {
    let known = formats::extensions_or(Product::Surface);
    Error::usage("the file's extension names no mesh format").in_file(path).cure(format!("use {known}"))
}

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

use std::io::Read;
use std::path::{Path, PathBuf};

use super::listing::Listing;
pub use super::stl::Solid;
use super::{obj, off, ply, stl};
use crate::data::{Mesh, Surface, Triangles};
use crate::error::{Error, Result};
use crate::io::{Destination, triangle};

/// A mesh format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Polygon file format, `.ply`.
    Ply,
    /// Wavefront, `.obj`.
    Obj,
    /// Object file format, `.off`.
    Off,
    /// Stereolithography, `.stl`.
    Stl,
    /// Elements of Triangle, `.ele`.
    Ele,
}

impl Format {
    /// The format that a file's extension names.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "ply" => Some(Format::Ply),
            "obj" => Some(Format::Obj),
            "off" => Some(Format::Off),
            "stl" => Some(Format::Stl),
            "ele" => Some(Format::Ele),
            _ => None,
        }
    }

    /// Whether a file tells which edges lie on lines. Without that, the Delaunay law cannot be asked of it.
    pub fn keeps_lines(self) -> bool {
        matches!(self, Format::Ply | Format::Ele)
    }
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSummary {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub faces: usize,
    /// Edges on breaklines and clip lines.
    pub constrained_edges: usize,
    /// How many of these cannot be told from others in the file: all, unless the format [keeps
    /// lines](Format::keeps_lines).
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
    let format = Format::of(&target.format_path()).ok_or_else(|| unknown(target.path()))?;
    let mesh = Listing::new(surface);
    let origin = match format {
        Format::Ply => ply::write(target, &mesh, surface.crs()).map(|()| None),
        Format::Obj => obj::write(target, &mesh, surface.crs()).map(|()| None),
        Format::Off => off::write(target, &mesh, surface.crs()).map(|()| None),
        Format::Stl => stl::write(target, &mesh).map(Some),
        Format::Ele => Err(Error::unsupported("a surface is not written as .ele, which has no heights")
            .cure("use .ply, .obj, .off or .stl")),
    };
    Ok(MeshSummary {
        vertices: mesh.vertex_count,
        faces: mesh.face_count,
        constrained_edges: mesh.constrained_edges,
        lost_edges: if format.keeps_lines() { 0 } else { mesh.constrained_edges },
        origin: origin.map_err(|e| e.in_file(target.path()))?,
    })
}

/// Reads what a binary STL file holds: it has no exact coordinates, and is not read as a surface.
///
/// # Errors
/// If it is damaged or text, or the file with its origin is.
pub fn describe_stl(path: &Path) -> Result<Solid> {
    stl::describe(path).map_err(|e| e.in_file(path))
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
    let read = || {
        let format = Format::of(path).ok_or_else(|| unknown(path))?;
        if format == Format::Stl {
            return Err(Error::unsupported("STL meshes are not read: they have no exact coordinates")
                .cure("use PLY, which keeps coordinates, breaklines and the coordinate system"));
        }
        if format == Format::Ele {
            return triangle::read_triangles(path);
        }
        let mut bytes = Vec::new();
        std::fs::File::open(path)?.read_to_end(&mut bytes)?;
        match format {
            Format::Ply => ply::read(&bytes),
            Format::Off => off::read(&bytes),
            _ => obj::read(&bytes),
        }
    };
    read().map_err(|e: Error| e.in_file(path))
}

#[cold]
fn unknown(path: &Path) -> Error {
    Error::usage("the file's extension names no mesh format").in_file(path).cure("use .ply, .obj, .off or .stl")
}

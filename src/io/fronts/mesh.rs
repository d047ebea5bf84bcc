//! Triangle meshes: PLY, OBJ, OFF, STL, LandXML, DXF, GLB, 2DM, UGRID and CityJSON; Triangle's
//! `.ele` is read as well.
//!
//! | format | coordinates | lines, coordinate system | read |
//! |---|---|---|---|
//! | PLY | doubles | yes | yes |
//! | OBJ | decimals that read back as the same doubles | coordinate system, as a comment | yes |
//! | OFF | as OBJ | as OBJ | yes |
//! | LandXML | as OBJ | yes | yes |
//! | DXF | as OBJ | lines | no |
//! | GLB | 32-bit floats from a local origin | coordinate system | yes |
//! | 2DM | as OBJ | no | yes |
//! | UGRID | doubles | coordinate system | yes |
//! | CityJSON | whole numbers from a local origin | the code of the coordinate system | no |
//! | STL | 32-bit floats from a local origin | no | no |
//! | `.ele` with its `.node` | as OBJ; heights are 0 | breaklines | yes; to write it, see [`crate::io::codec::triangle`] |
//!
//! Vertices and faces are written in the order of the surface. For a TIN this order depends only on
//! its points and lines and follows a space-filling curve, so that neighbors are close to each
//! other in the file. Vertices without a face are not written.
//!
//! # What PLY files contain
//! `format binary_little_endian 1.0`, then the elements
//! - `vertex`: `double x`, `double y`, `double z`;
//! - `face`: `list uchar int vertex_indices`, three per face, counter-clockwise in plan. If the
//!   surface has lines, then `uchar edge1`, `uchar edge2`, `uchar edge3` give the kinds of the
//!   edges, starting with the edge from the first corner to the second (0 plain, 1 on a breakline,
//!   2 on a clip line, 3 at the rim), and `uchar piece` is 1 for a fragment of a triangle that was
//!   cut.
//!
//! QGIS shows these as values of the faces. If a file has the element `edge`, QGIS shows only the
//! lines; if it has an element that QGIS does not know, it does not open the file.
//!
//! Files of earlier versions store breaklines in an element `constrained_edge` instead, with
//! `vertex1` and `vertex2`.
//!
//! The header states the coordinate system as `comment crs: EPSG:25832`, or with WKT instead of the
//! code. Some readers refuse lines over 1024 bytes, so WKT of 1000 bytes or more is split into
//! lines `comment crs PART`, to be joined. OBJ and OFF have the same comments, with `#`.

use std::path::{Path, PathBuf};

use crate::data::{EdgeKind, Mesh, Surface, Triangles};
use crate::error::{Command, Error, Result, Wording, wording};
#[cfg(doc)]
use crate::io::bytes::mapped;
use crate::io::bytes::mapped::Mapped;
use crate::io::bytes::output::Destination;
use crate::io::bytes::watch::{Watch, unwatched};
use crate::io::codec::listing::{Listing, Remarks};
pub use crate::io::codec::stl::Solid;
use crate::io::formats::{self, Content, FormatReader, Holding, Product};
use crate::io::fronts::layer;

/// What a mesh file contains, counted.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSummary {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub faces: usize,
    /// Number of edges on breaklines and clip lines.
    pub constrained_edges: usize,
    /// How many of the constrained edges cannot be distinguished from others in the file: all of
    /// them, unless the format stores [edges](Holding::Edges).
    pub lost_edges: usize,
    /// What was subtracted from all coordinates, and the file next to the mesh that states it.
    pub origin: Option<([f64; 3], PathBuf)>,
    /// What else the format cannot store.
    pub notes: Vec<String>,
}

/// Writes a surface in the format that the extension of `target` names.
///
/// # Errors
/// If the extension names no mesh format, the surface is too large for the format or was found
/// damaged, or the file cannot be written.
pub fn write<'a>(target: impl Into<Destination<'a>>, surface: &dyn Surface) -> Result<MeshSummary> {
    let target = target.into();
    let path = target.format_path();
    let found = formats::for_output(&path, Product::Surface)
        .and_then(|format| Some((format, format.writers.surface?)));
    let Some((format, write)) = found else {
        let mesh = formats::of_name(&path).filter(|format| format.content == Content::Mesh);
        return Err(match mesh {
            Some(format) => Error::unsupported(format!(
                "a surface is not written as .{}, which has no heights",
                format.extensions[0]
            ))
            .in_file(target.path())
            .cure(format!("use {}", formats::extensions_or(Product::Surface))),
            None => unknown(target.path()),
        });
    };
    let mesh = Listing::new(surface);
    let remarks = target.put_whole(|target| {
        let remarks = write(target, &mesh, surface.crs())?;
        surface.ensure_intact()?;
        Ok(remarks)
    });
    let Remarks { origin, notes } = remarks.map_err(|e| e.in_file(target.path()))?;
    Ok(MeshSummary {
        vertices: mesh.vertex_count,
        faces: mesh.face_count,
        constrained_edges: mesh.constrained_edges,
        lost_edges: if format.can_hold(Holding::Edges) {
            0
        } else {
            mesh.constrained_edges
        },
        origin,
        notes,
    })
}

/// Returns the vertices, faces and edges on lines of a surface in memory, in the order and with the
/// numbers that [`write()`] gives them in a file.
///
/// # Errors
/// If something in the surface was found damaged.
///
/// # Complexity
/// Linear.
pub fn list(surface: &dyn Surface) -> Result<Triangles> {
    let listing = Listing::new(surface);
    let mut listed = Triangles {
        vertices: Vec::with_capacity(listing.vertex_count),
        faces: Vec::with_capacity(listing.face_count),
        crs: surface.crs().cloned(),
        ..Triangles::default()
    };
    listed.vertices.extend(listing.vertices());
    listed.faces.extend(listing.faces());
    if surface.has_lines() {
        listed
            .lines
            .extend(listing.edges().filter(|(_, kind)| kind.is_constrained()));
        listed.fragments.extend(listing.fragments());
    }
    surface.ensure_intact()?;
    Ok(listed)
}

/// Returns all edges of a surface, each once with its kind; vertices have the numbers of [`list`].
///
/// # Errors
/// If something in the surface was found damaged.
///
/// # Complexity
/// Linear.
pub fn edges(surface: &dyn Surface) -> Result<Vec<([u32; 2], EdgeKind)>> {
    let edges = Listing::new(surface).edges().collect();
    surface.ensure_intact()?;
    Ok(edges)
}

/// Returns true if a file is a TIN, or the index of one in parts, by its first bytes and its
/// extension.
pub fn is_tin(path: &Path) -> bool {
    let format = formats::detect_file(path).ok().flatten();
    format.is_some_and(|format| {
        matches!(format.reader, FormatReader::Tin(_) | FormatReader::Parts(_))
    })
}

/// Maps a TIN to memory; `None` for a file of another format, by its first bytes and its extension.
///
/// # Errors
/// Those of [`mapped::open`].
pub fn map_tin(path: &Path) -> Option<Result<Mapped>> {
    match formats::detect_file(path).ok()??.reader {
        FormatReader::Tin(map) => Some(map(path)),
        _ => None,
    }
}

/// Reads the index of a TIN in parts; `None` for a file of another format.
///
/// # Errors
/// If the file cannot be read.
pub fn read_tin_index(path: &Path) -> Option<Result<Vec<u8>>> {
    match formats::detect_file(path).ok()??.reader {
        FormatReader::Parts(read) => Some(read(path)),
        _ => None,
    }
}

/// Describes a file of unconnected triangles without exact coordinates (STL), which is not read as
/// a surface. Returns `None` for a file of another format.
///
/// # Errors
/// If the file is text or damaged, or the file that states its origin is damaged.
pub fn describe_solid(path: &Path) -> Option<Result<Solid>> {
    match formats::of_name(path)?.reader {
        FormatReader::Solid(describe) => Some(describe(path).map_err(|e| e.in_file(path))),
        _ => None,
    }
}

/// Returns true if files with this name mark the edges that lie on breaklines. Without these marks,
/// the Delaunay law cannot be checked.
pub fn keeps_lines(path: &Path) -> bool {
    formats::of_name(file_and_surface(path).0).is_some_and(|format| format.can_hold(Holding::Edges))
}

/// Reads a mesh that forms a surface, written by any program, in any format but STL.
///
/// Polygons are divided into triangles. The file is kept in memory while it is read.
///
/// # Errors
/// If the file is damaged, is not a surface (see [`Mesh::new`]), has no faces, has polygons that
/// are far from convex, or its format cannot be read.
pub fn read(path: &Path) -> Result<Mesh> {
    read_with(path, &unwatched)
}

/// Like [`read`], but watched: the bytes that were parsed are counted.
///
/// # Errors
/// Those of [`read`], and that of the watch.
pub fn read_with(path: &Path, watch: Watch) -> Result<Mesh> {
    let triangles = read_triangles_with(path, watch)?;
    watch(0)?;
    Mesh::of(triangles).map_err(|e| e.in_file(path))
}

/// Reads the triangles of a mesh even if they do not form a surface, for example to check them.
///
/// # Errors
/// As [`read`], except that the triangles need not form a surface.
pub fn read_triangles(path: &Path) -> Result<Triangles> {
    read_triangles_with(path, &unwatched)
}

/// Like [`read_triangles`], but watched: the bytes that were parsed are counted.
///
/// # Errors
/// Those of [`read_triangles`], and that of the watch.
pub fn read_triangles_with(path: &Path, watch: Watch) -> Result<Triangles> {
    let triangles = parse(path, watch)?;
    // The triangulation of an .ele, whose vertices are in another file, may be empty.
    let may_be_empty = formats::of_name(path).is_some_and(|format| format.beside.contains(&"node"));
    if triangles.faces.is_empty() && !may_be_empty {
        let error = Error::format("there are no faces: the file is a point cloud").in_file(path);
        return Err(error.cure(wording![
            "its points can be read in space only, by ",
            Command::TriangulateInSpace
        ]));
    }
    Ok(triangles)
}

/// Reads the vertices of a mesh, or the points of a cloud in the format of a mesh; returns them
/// with warnings.
///
/// # Errors
/// As [`read_triangles_with`], except that there need not be any faces.
pub fn read_vertices(path: &Path, watch: Watch) -> Result<(Vec<[f64; 3]>, Vec<Wording>)> {
    parse(path, watch).map(|triangles| (triangles.vertices, triangles.warnings))
}

/// Reads a mesh, which may have no faces.
fn parse(path: &Path, watch: Watch) -> Result<Triangles> {
    let (file, name) = file_and_surface(path);
    // Some share their extension with rasters.
    let by_bytes = || formats::detect_file(file).ok().flatten();
    let format = formats::of_name(file)
        .or_else(by_bytes)
        .or_else(|| formats::for_output(file, Product::Surface));
    let read = match format.map(|format| (format, format.reader)) {
        Some((_, FormatReader::Surfaces(read))) => {
            return read(file, name, watch).map_err(|e| e.in_input(file));
        }
        Some((_, FormatReader::Mesh(read))) if name.is_none() => read,
        Some((format, FormatReader::Mesh(_))) => {
            return Err(Error::usage(format!("{} has one surface", format.noun))
                .in_file(path)
                .cure(format!("name the file alone: {}", file.display())));
        }
        Some((format, FormatReader::Solid(_))) => {
            let name = format.name;
            return Err(Error::unsupported(format!(
                "{name} meshes are not read: they have no exact coordinates"
            ))
            .in_file(path)
            .cure("use PLY, which keeps coordinates, breaklines and the coordinate system"));
        }
        Some((_, FormatReader::Tin(_) | FormatReader::Parts(_))) => {
            return Err(Error::unsupported("a TIN is not read triangle by triangle")
                .in_file(path)
                .cure("write it as .ply first: breakline tin IN -o OUT.ply"));
        }
        _ => return Err(unknown(path)),
    };
    read(path, watch).map_err(|e| e.in_input(path))
}

/// Splits `FILE:NAME`, which names a surface of a file with several.
fn file_and_surface(path: &Path) -> (&Path, Option<&str>) {
    path.to_str().map_or((path, None), layer::split)
}

#[cold]
fn unknown(path: &Path) -> Error {
    let known = formats::extensions_or(Product::Surface);
    Error::usage("the file's extension names no mesh format")
        .in_file(path)
        .cure(format!("use {known}"))
}

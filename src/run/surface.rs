//! Surfaces, built from points or read from a file.

use std::path::{Path, PathBuf};

use super::context::{Context, Journal, Stage};
use super::input::{Input, MemoryPoints};
use super::notice::Notice;
use super::open::{self, Content, content};
use super::systems::{self, Role, Stated, SystemOptions};
use super::tin::{self, BuildReport, TinRequest};
use super::watched::Watched;
use crate::crs::Crs;
use crate::data::{self, Bounds, Grid, LineEdges, Mesh, Surface};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::mesh::{self, MeshSummary};
use crate::terrain::Tin;

/// The surface that a verb works on, and its coordinate system.
#[derive(Debug, Clone, Default)]
pub struct SurfaceRequest {
    /// What the surface is built or read from.
    pub source: Source,
    /// Options of coordinate systems.
    pub systems: SystemOptions,
}

/// What a surface is built or read from.
#[derive(Debug, Clone)]
pub enum Source {
    /// Points and lines, which it is built from.
    Points(Box<TinRequest>),
    /// A file of triangles, which is read.
    Mesh(PathBuf),
    /// A raster of heights, which is read.
    Raster(PathBuf),
}

impl Default for Source {
    /// No points.
    fn default() -> Self {
        Source::Points(Box::default())
    }
}

impl Source {
    /// Returns the source for files of points, or for one file that is a mesh or a raster. Their
    /// kind follows from the first bytes and the extension.
    ///
    /// # Errors
    /// If a mesh or a raster is given together with other files.
    pub fn of_files(files: &[PathBuf]) -> Result<Self> {
        let ready = files.iter().find(|path| matches!(content(path), Content::Mesh | Content::Raster));
        match ready {
            None => {
                let points = files.iter().cloned().map(Input::<MemoryPoints>::File).collect();
                Ok(Source::Points(Box::new(TinRequest { points, ..TinRequest::default() })))
            }
            Some(path) if files.len() > 1 => {
                Err(Error::usage("the file is a surface, and cannot be combined with other files")
                    .in_file(path)
                    .cure("pass one .ply or one raster alone, or points only"))
            }
            Some(path) if content(path) == Content::Mesh => Ok(Source::Mesh(path.clone())),
            Some(path) => Ok(Source::Raster(path.clone())),
        }
    }
}

/// A surface, with the report of how it was built.
#[derive(Debug)]
#[non_exhaustive]
pub struct SurfaceProduct {
    /// The surface.
    pub model: Model,
    /// The report of building it; `None` if it was read from a file.
    pub built: Option<Box<BuildReport>>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// A surface of one of three kinds.
#[derive(Debug)]
pub enum Model {
    /// Built from points and lines.
    Tin(Box<Tin>),
    /// Triangles from a file.
    Mesh(Box<Mesh>),
    /// Cells from a raster.
    Raster(Box<Grid>),
}

impl SurfaceProduct {
    /// Returns the triangles.
    ///
    /// # Errors
    /// If the surface is a raster.
    pub fn triangles(&self) -> Result<&dyn Surface> {
        match &self.model {
            Model::Tin(tin) => Ok(tin.as_ref()),
            Model::Mesh(mesh) => Ok(mesh.as_ref()),
            Model::Raster(_) => Err(Error::usage("the surface is a raster; points or a .ply are needed")),
        }
    }

    /// Returns the coordinate system, if it is known.
    pub fn crs(&self) -> Option<&Crs> {
        match &self.model {
            Model::Tin(tin) => tin.crs(),
            Model::Mesh(mesh) => mesh.crs(),
            Model::Raster(grid) => grid.crs.as_ref(),
        }
    }

    /// Returns the box around the surface; for a raster, around all cells, with the range of their
    /// heights.
    ///
    /// # Complexity
    /// Linear, unless the surface is a TIN.
    pub fn extent(&self) -> Bounds {
        match &self.model {
            Model::Tin(tin) => tin.report().extent,
            Model::Mesh(mesh) => SurfaceFacts::of(mesh.as_ref()).extent,
            Model::Raster(grid) => grid.extent(),
        }
    }
}

/// Writes a mesh, in the format that the extension of `target` names: `.ply`, `.obj`, `.off` or
/// `.stl`.
///
/// # Errors
/// If the extension names no such format, the surface is too large for it, the file cannot be
/// written, or the run is canceled.
pub fn write_mesh(surface: &dyn Surface, target: Destination, context: &Context) -> Result<MeshSummary> {
    target.put_whole(|target| {
        // Once to number the vertices, once to list the faces.
        let watched = Watched::faces(surface, 2, Stage::WritingFaces, context)?;
        let written = mesh::write(target, &watched);
        watched.end()?;
        written
    })
}

/// Reads the input of a request, and builds the TIN if the input is points.
///
/// # Errors
/// If something cannot be read or is refused, or the run is canceled.
pub fn surface(request: &SurfaceRequest, context: &Context) -> Result<SurfaceProduct> {
    let journal = Journal::new(context);
    let (model, built) = match &request.source {
        Source::Points(points) => {
            let (tin, report) = tin::build(points, &request.systems, &journal)?;
            (Model::Tin(Box::new(tin)), Some(Box::new(report)))
        }
        Source::Mesh(path) => {
            let mesh = open::mesh(path, &journal)?;
            (mesh_model(path, mesh, &request.systems, &journal)?, None)
        }
        Source::Raster(path) => {
            let (mut grid, warnings) = open::raster(path, &journal)?;
            warnings.into_iter().for_each(|text| journal.add(Notice::Reader(path.clone(), text)));
            grid.crs = one_system(path, grid.crs.as_ref(), &request.systems, &journal)?;
            (Model::Raster(Box::new(grid)), None)
        }
    };
    Ok(SurfaceProduct { model, built, notices: journal.take() })
}

/// Like [`surface`], for verbs that need triangles.
///
/// # Errors
/// Those of [`surface`], and if the input is a raster, which is not read then.
pub fn triangles(request: &SurfaceRequest, context: &Context) -> Result<SurfaceProduct> {
    if let Source::Raster(path) = &request.source {
        return Err(Error::usage("the input is a raster; points or a .ply are needed")
            .in_file(path)
            .cure("`contour` and `hillshade` take rasters"));
    }
    surface(request, context)
}

/// Returns a mesh as a model, in the coordinate system that it states or that is assigned.
pub(super) fn mesh_model(path: &Path, mut mesh: Mesh, options: &SystemOptions, journal: &Journal) -> Result<Model> {
    mesh.set_crs(one_system(path, mesh.crs(), options, journal)?);
    Ok(Model::Mesh(Box::new(mesh)))
}

fn one_system(path: &Path, crs: Option<&Crs>, options: &SystemOptions, journal: &Journal) -> Result<Option<Crs>> {
    let stated = [Stated { path: path.to_path_buf(), crs: crs.cloned(), role: Role::Whole }];
    Ok(systems::reconcile(&stated, options, journal)?.crs)
}

/// Counts and extent of a surface. Vertices that no face uses do not count.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFacts {
    /// Vertices that some face uses.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Edges on breaklines.
    pub breaklines: usize,
    /// Edges on clip lines.
    pub clips: usize,
    /// The box around these vertices.
    pub extent: Bounds,
}

impl SurfaceFacts {
    /// Returns the counts over all faces of a surface.
    ///
    /// # Complexity
    /// Linear.
    pub fn of(surface: &dyn Surface) -> Self {
        let mut is_used = vec![false; surface.vertex_count()];
        let mut lines = LineEdges::default();
        let (mut vertices, mut triangles, mut extent) = (0, 0, Bounds::default());
        data::faces(surface).for_each(|face| {
            triangles += 1;
            lines.add(surface, face.number, face.edges);
            for vertex in face.corners {
                if !std::mem::replace(&mut is_used[vertex as usize], true) {
                    vertices += 1;
                    extent.add(surface.position(vertex));
                }
            }
        });
        let LineEdges { breaklines, clips } = lines;
        SurfaceFacts { vertices, triangles, breaklines, clips, extent }
    }
}

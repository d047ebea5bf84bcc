//! Surfaces, built from points or read from a file.

use std::path::{Path, PathBuf};

use super::tin::{self, BuildReport, TinRequest};
use crate::crs::Crs;
use crate::data::{Bounds, Grid, Mesh, Surface, SurfaceFacts};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::mapped::Mapped;
use crate::io::mesh::{self, MeshSummary};
use crate::run::context::notice::Notice;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Stage};
use crate::run::request::input::{Input, MemoryPoints};
use crate::run::sources::open::{self, Content, content};
use crate::run::sources::raster_file::RasterFile;
use crate::run::sources::systems::{self, Degrees, Role, Stated, SystemOptions};
use crate::run::sources::tin_parts::TinParts;
use crate::terrain::{CompactTin, GridSurface, Method, Tin};

/// The surface that a verb works on, and its coordinate system.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct SurfaceRequest {
    /// What the surface is built or read from.
    pub source: Source,
    /// Options of coordinate systems.
    pub systems: SystemOptions,
}

impl SurfaceRequest {
    /// Returns the files that the surface is built or read from.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = Vec::new();
        self.clone().each_file(&mut |file| files.push(file.clone()));
        files
    }

    /// Calls a function with the name of each file that the surface is built or read from.
    pub(crate) fn each_file(&mut self, visit: &mut dyn FnMut(&mut PathBuf)) {
        match &mut self.source {
            Source::Points(points) => points.each_file(visit),
            Source::Mesh(path) | Source::Raster(path) => visit(path),
        }
    }
}

/// What a surface is built or read from.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub enum Source {
    /// Points and lines, which it is built from.
    Points(Box<TinRequest>),
    /// A file of triangles, which is read, or of a TIN, also in parts, which is used where it is.
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
        let ready = files
            .iter()
            .find(|path| matches!(content(path), Content::Mesh | Content::Raster));
        match ready {
            None => Ok(Self::of_points(files)),
            Some(path) if files.len() > 1 => Err(Error::usage(
                "the file is a surface, and cannot be combined with other files",
            )
            .in_file(path)
            .cure("pass one .tin, .ply or raster alone, or points only")),
            Some(path) if content(path) == Content::Mesh => Ok(Source::Mesh(path.clone())),
            Some(path) => Ok(Source::Raster(path.clone())),
        }
    }

    /// Returns files of points as a source. They are not looked at.
    pub fn of_points(files: &[PathBuf]) -> Self {
        let points = files
            .iter()
            .cloned()
            .map(Input::<MemoryPoints>::File)
            .collect();
        Source::Points(Box::new(TinRequest {
            points,
            ..TinRequest::default()
        }))
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

/// A surface of one of six kinds.
#[derive(Debug)]
pub enum Model {
    /// Built from points and lines.
    Tin(Box<Tin>),
    /// Triangles from a file.
    Mesh(Box<Mesh>),
    /// A TIN in a file, used where its bytes are.
    Compact(Box<CompactTin<Mapped>>),
    /// A TIN in parts, each in a file.
    Parts(Box<TinParts>),
    /// Cells of a raster, in memory.
    Raster(Box<Grid>),
    /// Cells of a large raster, in their file.
    RasterFile(Box<RasterFile>),
}

impl From<Model> for SurfaceProduct {
    /// A surface that was made elsewhere, without a report.
    fn from(model: Model) -> Self {
        SurfaceProduct {
            model,
            built: None,
            notices: Vec::new(),
        }
    }
}

impl SurfaceProduct {
    /// Returns the triangles. Those of a TIN in parts are joined.
    ///
    /// # Errors
    /// If the surface is a raster, or its parts are damaged or too many for one mesh.
    pub fn triangles(&self) -> Result<&dyn Surface> {
        match &self.model {
            Model::Tin(tin) => Ok(tin.as_ref()),
            Model::Mesh(mesh) => Ok(mesh.as_ref()),
            Model::Compact(tin) => Ok(tin.as_ref()),
            Model::Parts(parts) => Ok(parts.joined()?),
            Model::Raster(_) | Model::RasterFile(_) => Err(Error::usage(
                "the surface is a raster; points, a .tin or a .ply are needed",
            )),
        }
    }

    /// Calls a function with the triangles of the surface; those of a raster lie between the
    /// centers of its cells.
    pub(super) fn with_faces<T>(
        &self,
        context: &Context,
        take: impl FnOnce(&dyn Surface) -> Result<T>,
    ) -> Result<T> {
        match &self.model {
            Model::Raster(grid) => take(&GridSurface::new(grid)?),
            Model::RasterFile(raster) => {
                let cells = raster.cells();
                let grid = Grid::collect(&Watched::cells(&cells, Stage::ReadingCells, context)?)?;
                take(&GridSurface::new(&grid)?)
            }
            Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) | Model::Parts(_) => {
                take(self.triangles()?)
            }
        }
    }

    /// Like [`with_faces`](Self::with_faces), but a surface in parts stays in its files: faces of
    /// different parts are not linked.
    pub(super) fn with_unlinked_faces<T>(
        &self,
        context: &Context,
        take: impl FnOnce(&dyn Surface) -> Result<T>,
    ) -> Result<T> {
        match &self.model {
            Model::Parts(parts) => take(&parts.unjoined()?),
            _ => self.with_faces(context, take),
        }
    }

    /// Like [`with_faces`](Self::with_faces), but a surface in parts stays in its files: a vertex
    /// that parts share has a number in each of them.
    pub(super) fn with_linked_faces<T>(
        &self,
        context: &Context,
        take: impl FnOnce(&dyn Surface) -> Result<T>,
    ) -> Result<T> {
        match &self.model {
            Model::Parts(parts) => take(&parts.linked(context)?),
            _ => self.with_faces(context, take),
        }
    }

    /// Returns true if an edge of the surface may be on a line.
    pub(super) fn has_lines(&self) -> Result<bool> {
        match &self.model {
            Model::Raster(_) | Model::RasterFile(_) => Ok(false),
            Model::Parts(parts) => Ok(parts.unjoined()?.has_lines()),
            Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) => Ok(self.triangles()?.has_lines()),
        }
    }

    /// Calls a function with each part of the surface, one after the other: a surface in parts
    /// stays in its files, of which one is open at a time.
    pub(super) fn with_each_part(
        &self,
        context: &Context,
        take: &mut dyn FnMut(&dyn Surface) -> Result<()>,
    ) -> Result<()> {
        let mut polled = |faces: &dyn Surface| {
            let polled = Watched::polled(faces, context)?;
            take(&polled)?;
            polled.end()
        };
        match &self.model {
            Model::Parts(parts) => {
                (0..parts.index().parts.len()).try_for_each(|part| polled(&parts.part(part)?))
            }
            _ => self.with_faces(context, polled),
        }
    }

    /// Calls a function with the faces by which heights of a method are computed at positions:
    /// linear ones need no links.
    pub(super) fn with_faces_for<T>(
        &self,
        method: Method,
        context: &Context,
        take: impl FnOnce(&dyn Surface) -> Result<T>,
    ) -> Result<T> {
        match method {
            Method::Linear => self.with_unlinked_faces(context, take),
            _ => self.with_faces(context, take),
        }
    }

    /// Returns an error if something in the triangles was found damaged while they were used.
    /// Parts are asked where they are used.
    pub(super) fn ensure_intact(&self) -> Result<()> {
        match &self.model {
            Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) => self.triangles()?.ensure_intact(),
            Model::Parts(_) | Model::Raster(_) | Model::RasterFile(_) => Ok(()),
        }
    }

    /// Returns the coordinate system that a surface states, by what messages call it.
    pub(super) fn stated(&self, name: &Path) -> Stated {
        Stated {
            path: name.to_path_buf(),
            crs: self.crs().cloned(),
            unread: None,
            role: Role::Whole,
        }
    }

    /// Returns a notice if a method reads vertices outside of the bounds that were left out. Linear
    /// heights do not depend on these.
    pub(super) fn unread_by(&self, method: Method) -> Option<Notice> {
        let is_part = self.built.as_ref().is_some_and(|built| built.is_part);
        (is_part && method != Method::Linear).then_some(Notice::PartForLinear)
    }

    /// Returns the coordinate system, if it is known.
    pub fn crs(&self) -> Option<&Crs> {
        match &self.model {
            Model::Tin(tin) => tin.crs(),
            Model::Mesh(mesh) => mesh.crs(),
            Model::Compact(tin) => tin.crs(),
            Model::Parts(parts) => parts.crs(),
            Model::Raster(grid) => grid.crs.as_ref(),
            Model::RasterFile(raster) => raster.crs(),
        }
    }

    /// Returns the counts and the extent of the triangles; for a TIN in a file, those that it
    /// states.
    ///
    /// # Errors
    /// If the surface is a raster.
    ///
    /// # Complexity
    /// Linear, unless the TIN is in a file.
    pub fn facts(&self) -> Result<SurfaceFacts> {
        match &self.model {
            Model::Compact(tin) => Ok(tin.facts().clone()),
            Model::Parts(parts) => Ok(parts.facts().clone()),
            Model::Tin(_) | Model::Mesh(_) | Model::Raster(_) | Model::RasterFile(_) => {
                self.triangles().map(SurfaceFacts::of)
            }
        }
    }

    /// Returns the box around the surface; for a raster, around all cells, with the range of their
    /// heights.
    ///
    /// # Complexity
    /// Linear for a mesh and a raster, else constant.
    pub fn extent(&self) -> Bounds {
        match &self.model {
            Model::Tin(tin) => tin.report().extent,
            Model::Mesh(mesh) => SurfaceFacts::of(mesh.as_ref()).extent,
            Model::Compact(tin) => tin.facts().extent,
            Model::Parts(parts) => parts.facts().extent,
            Model::Raster(grid) => grid.extent(),
            Model::RasterFile(raster) => raster.extent(),
        }
    }
}

/// Writes a surface, in the format that the extension of `target` names: see
/// [`FORMATS`](crate::io::formats::FORMATS).
///
/// # Errors
/// If the extension names no such format, the surface is too large for it, the file cannot be
/// written, or the run is canceled.
pub fn write_mesh(
    surface: &dyn Surface,
    target: Destination,
    context: &Context,
) -> Result<MeshSummary> {
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
    surface_for(Method::Linear, request, context)
}

/// Like [`surface`], for heights by a method: within bounds they are those of all points. Other
/// methods than [`Method::Linear`] read vertices that no triangle within the bounds shows, so that
/// all points are used.
///
/// # Errors
/// Those of [`surface`].
pub fn surface_for(
    method: Method,
    request: &SurfaceRequest,
    context: &Context,
) -> Result<SurfaceProduct> {
    let journal = Journal::new(context);
    let (model, built) = match &request.source {
        Source::Points(points) => {
            let (tin, report) = tin::build(points, &request.systems, method, &journal)?;
            (Model::Tin(Box::new(tin)), Some(Box::new(report)))
        }
        Source::Mesh(path) => {
            let model = if let Some(tin) = open::tin(path) {
                tin_model(path, tin?, &request.systems, &journal)?
            } else if let Some(parts) = open::tin_parts(path) {
                parts_model(path, parts?, &request.systems, &journal)?
            } else {
                mesh_model(
                    path,
                    open::mesh(path, &journal)?,
                    &request.systems,
                    &journal,
                )?
            };
            (model, None)
        }
        Source::Raster(path) => (raster_model(path, &request.systems, &journal)?, None),
    };
    Ok(SurfaceProduct {
        model,
        built,
        notices: journal.take(),
    })
}

/// Like [`surface`], for verbs that need triangles.
///
/// # Errors
/// Those of [`surface`], and if the input is a raster, which is not read then.
pub fn triangles(request: &SurfaceRequest, context: &Context) -> Result<SurfaceProduct> {
    triangles_for(Method::Linear, request, context)
}

/// Like [`surface_for`], for verbs that need triangles.
///
/// # Errors
/// Those of [`triangles`].
pub fn triangles_for(
    method: Method,
    request: &SurfaceRequest,
    context: &Context,
) -> Result<SurfaceProduct> {
    require_triangles(&request.source)?;
    surface_for(method, request, context)
}

/// Returns an error if the source of a surface is a raster.
pub(crate) fn require_triangles(source: &Source) -> Result<()> {
    match source {
        Source::Raster(path) => Err(Error::usage(
            "the input is a raster; points, a .tin or a .ply are needed",
        )
        .in_file(path)
        .cure("`contour` and `hillshade` take rasters")),
        Source::Points(_) | Source::Mesh(_) => Ok(()),
    }
}

/// Reads a raster, in the coordinate system that it states or that is assigned. A large one stays
/// in its file.
fn raster_model(path: &Path, options: &SystemOptions, journal: &Journal) -> Result<Model> {
    // Contours and shades of a raster need no lengths, or state their scale.
    let options = SystemOptions {
        degrees: Degrees::Allow,
        ..options.clone()
    };
    let system = |crs: Option<&Crs>| one_system(path, crs, &options, journal);
    Ok(match open::raster(path, journal)? {
        open::OpenRaster::Memory(mut grid) => {
            grid.crs = system(grid.crs.as_ref())?;
            Model::Raster(grid)
        }
        open::OpenRaster::File(mut raster) => {
            raster.set_crs(system(raster.crs())?);
            Model::RasterFile(raster)
        }
    })
}

/// Returns a mesh as a model, in the coordinate system that it states or that is assigned.
pub(crate) fn mesh_model(
    path: &Path,
    mut mesh: Mesh,
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Model> {
    mesh.set_crs(one_system(path, mesh.crs(), options, journal)?);
    Ok(Model::Mesh(Box::new(mesh)))
}

/// Returns a TIN in a file as a model, in the coordinate system that it states or that is assigned.
pub(crate) fn tin_model(
    path: &Path,
    mut tin: CompactTin<Mapped>,
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Model> {
    tin.set_crs(one_system(path, tin.crs(), options, journal)?);
    Ok(Model::Compact(Box::new(tin)))
}

/// Returns a TIN in parts as a model, in the coordinate system that it states or that is assigned.
fn parts_model(
    path: &Path,
    mut parts: TinParts,
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Model> {
    parts.set_crs(one_system(path, parts.crs(), options, journal)?);
    Ok(Model::Parts(Box::new(parts)))
}

fn one_system(
    path: &Path,
    crs: Option<&Crs>,
    options: &SystemOptions,
    journal: &Journal,
) -> Result<Option<Crs>> {
    let stated = [Stated {
        path: path.to_path_buf(),
        crs: crs.cloned(),
        unread: None,
        role: Role::Whole,
    }];
    Ok(systems::reconcile(&stated, options, journal)?.crs)
}

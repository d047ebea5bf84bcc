//! Verbs that write files: of a surface in memory, or of tiles.
//!
//! A verb is its options. [`Verb`] is all that it has to have, so that every caller can write it,
//! in one piece or in tiles, and that a job can go on with it.

mod contour;
mod dem;
pub(crate) mod ground;
mod hillshade;
mod new_folder;
mod output_formats;
pub(crate) mod point_tiles;
mod quantity;
mod raster;
mod relief;
mod stored;
pub(crate) mod targets;
mod tin;

use std::any::Any;
use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::Arc;

pub(super) use self::stored::{from_json, to_json};
use self::targets::{Outputs, Target};
pub use self::tin::{SurfaceOptions, WrittenEdges};
use crate::data::BlockSource;
use crate::error::{Error, Result, Setting};
use crate::io::Destination;
use crate::io::contours::ContourSummary;
use crate::io::formats::Product;
use crate::io::geotiff::RasterSummary;
use crate::io::mesh::MeshSummary;
use crate::run::context::Context;
use crate::run::products::contour::ContourOptions;
use crate::run::products::contour_map::MapSummary;
use crate::run::products::frame::FrameOptions;
use crate::run::products::surface::{self, Source, SurfaceProduct, SurfaceRequest};
use crate::run::sources::tin_parts::WrittenParts;
use crate::terrain::{GradientSource, Method, Quantity};

/// A surface, and what is written of it.
#[derive(Debug, Clone)]
pub struct WriteRequest {
    /// The surface.
    pub surface: SurfaceRequest,
    /// What is made of it.
    pub verb: Arc<dyn Verb>,
}

impl WriteRequest {
    /// Returns the request for a product of a surface.
    pub fn new(surface: SurfaceRequest, verb: impl Verb + 'static) -> Self {
        WriteRequest {
            surface,
            verb: Arc::new(verb),
        }
    }

    /// Returns all files that are read.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = self.surface.files();
        files.extend(self.verb.also_reads().cloned());
        files
    }

    /// Builds or reads the surface that is written.
    pub(super) fn open(&self, context: &Context) -> Result<SurfaceProduct> {
        self.verb.takes(&self.surface.source)?;
        let given = surface::surface_for(self.verb.method(), &self.surface, context)?;
        let other = self.instead_of(&given, context)?;
        Ok(other.unwrap_or(given))
    }

    /// Returns the surface that the verb writes in place of one that was built or read, if it does.
    pub(super) fn instead_of(
        &self,
        given: &SurfaceProduct,
        context: &Context,
    ) -> Result<Option<SurfaceProduct>> {
        let other = self.verb.instead_of(given, context);
        other.map_err(|error| match &self.surface.files()[..] {
            [file] => error.in_file(file),
            _ => error,
        })
    }
}

/// What is made of a surface and written to files.
pub trait Verb: Any + Debug + Send + Sync {
    /// Returns the name of the verb, as on the command line.
    fn name(&self) -> &'static str;

    /// Returns the product, which has the formats that it can be written in.
    fn product(&self) -> Product;

    /// Returns an error if the options make no sense, whatever the surface is.
    ///
    /// # Errors
    /// Names the option.
    fn check(&self) -> Result<()> {
        Ok(())
    }

    /// Calls a function with the name and the value of each option, by which a job knows the
    /// request that it was planned for.
    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug));

    /// Returns how heights between vertices are computed. Tiles have linear ones.
    fn method(&self) -> Method {
        Method::Linear
    }

    /// Returns the file that is read besides those of the surface, if there is one.
    fn also_reads(&self) -> Option<&PathBuf> {
        None
    }

    /// Returns the verb with another name of the file that it [also reads](Self::also_reads);
    /// `None` if it reads none.
    fn reading(&self, _file: PathBuf) -> Option<Arc<dyn Verb>> {
        None
    }

    /// Returns when tiles are used, for these outputs.
    ///
    /// # Errors
    /// If the outputs do not go together.
    fn use_of_tiles(&self, _targets: &[Target]) -> Result<TileUse> {
        Ok(TileUse::Optional)
    }

    /// Returns an error if the verb makes nothing of such a source. By default, it makes something
    /// of all but rasters.
    ///
    /// # Errors
    /// Names the file.
    fn takes(&self, source: &Source) -> Result<()> {
        surface::require_triangles(source)
    }

    /// Returns the surface that is written in place of the one that was built or read; `None` if
    /// that one is.
    ///
    /// # Errors
    /// If it cannot be made, or the run is canceled.
    fn instead_of(
        &self,
        _given: &SurfaceProduct,
        _context: &Context,
    ) -> Result<Option<SurfaceProduct>> {
        Ok(None)
    }

    /// Writes what is made of a surface in memory.
    ///
    /// # Errors
    /// If it cannot be made or written, or the run is canceled.
    fn write(
        &self,
        surface: &SurfaceProduct,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary>;

    /// Returns what the tasks of a job keep of the triangles that they find.
    fn keeps(&self) -> Keeps<'_>;

    /// Writes what is made of what the tasks have kept.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary>;
}

/// When a product is made in tiles.
#[derive(Debug)]
pub enum TileUse {
    /// As memory requires: the result is the same without.
    Optional,
    /// Never; the error says why.
    Never(Error),
    /// Always.
    Always,
}

/// What the tasks of a job keep of triangles.
#[derive(Debug, Clone, Copy)]
pub enum Keeps<'a> {
    /// The heights at the centers of cells.
    Heights(&'a FrameOptions),
    /// The gradients of the faces at the centers of cells.
    Gradients(&'a FrameOptions),
    /// Parts of contours.
    Contours(&'a ContourOptions),
    /// The triangles, in the triangulation of the task.
    Triangles,
}

/// What the tasks of a job have kept, once all are done.
pub trait Tiles {
    /// Returns the heights at the centers of cells.
    ///
    /// # Errors
    /// If no triangle is left, if tasks have kept something else or their files are damaged; and
    /// those of choosing the frame.
    fn heights(&self, frame: &FrameOptions, context: &Context) -> Result<Box<dyn BlockSource>>;

    /// Returns the gradients of the faces at the centers of cells.
    ///
    /// # Errors
    /// Those of [`heights`](Self::heights).
    fn gradients(&self, frame: &FrameOptions, context: &Context)
    -> Result<Box<dyn GradientSource>>;

    /// Joins the parts of contours, level by level, and writes them.
    ///
    /// # Errors
    /// If no triangle is left, if tasks have kept something else or their files are damaged, or if
    /// the lines cannot be written.
    fn write_contours(
        &self,
        contours: &ContourOptions,
        target: Destination,
        context: &Context,
    ) -> Result<ContourSummary>;

    /// Returns the surface in parts, whose files are removed with it.
    ///
    /// # Errors
    /// Those of [`write_parts`](Self::write_parts).
    fn surface(&self, context: &Context) -> Result<SurfaceProduct>;

    /// Writes the triangulations of the tasks as a TIN in parts.
    ///
    /// # Errors
    /// If no triangle is left, if tasks have kept something else or their files are damaged, or if
    /// a file cannot be written.
    fn write_parts(&self, target: Destination, context: &Context) -> Result<WrittenParts>;
}

/// What was written, counted.
#[derive(Debug)]
#[non_exhaustive]
pub enum Summary {
    /// Heights in cells.
    Heights(RasterSummary),
    /// A quantity in cells.
    Quantity(Quantity, RasterSummary),
    /// Shades or colors in cells.
    Shades,
    /// Contours.
    Contours(ContourSummary),
    /// Contours for a map.
    Map(MapSummary),
    /// Meshes, in the order of the outputs.
    Meshes(Vec<(PathBuf, MeshSummary)>),
    /// A TIN in parts.
    Parts(Box<WrittenParts>),
}

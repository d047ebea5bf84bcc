//! What writing files reports.

use std::path::PathBuf;

use crate::crs::Crs;
use crate::data::{Bounds, Frame, SurfaceFacts};
use crate::error::Result;
use crate::run::context::event::JobSize;
use crate::run::job::JobReport;
use crate::run::products::surface::{Model, SurfaceProduct};
use crate::run::products::tin::BuildReport;
use crate::run::verbs::Summary;

/// What became of a request.
#[derive(Debug)]
#[non_exhaustive]
pub enum WriteReport {
    /// A job was planned, and nothing written.
    Planned {
        /// What it would consist of.
        size: JobSize,
        /// The folder that it would have.
        folder: PathBuf,
    },
    /// The outputs are there as they were written of the same tasks.
    Kept {
        /// The first of them.
        output: PathBuf,
        /// True if files were skipped.
        has_holes: bool,
    },
    /// The outputs are written.
    Written(Box<Written>),
}

/// What was written, and of what.
#[derive(Debug)]
#[non_exhaustive]
pub struct Written {
    /// The surface.
    pub surface: WrittenOf,
    /// What was made of it.
    pub summary: Summary,
    /// The files that have appeared.
    pub files: Vec<PathBuf>,
}

/// The surface that something was made of.
#[derive(Debug)]
pub enum WrittenOf {
    /// One in memory.
    Whole(Box<SurfaceReport>),
    /// One in tiles.
    Tiles {
        /// Counts of the tasks.
        report: Box<JobReport>,
        /// The folder of the job, which is kept if files were skipped: the result has holes.
        folder: PathBuf,
    },
}

/// A surface in memory, counted.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurfaceReport {
    /// What it is.
    pub origin: Origin,
    /// The box around it.
    pub extent: Bounds,
    /// Its coordinate system, if it is known.
    pub crs: Option<Crs>,
}

/// What a surface is, and how it came to be.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// It was built.
    Built(Box<BuildReport>),
    /// Triangles of a file.
    Triangles(SurfaceFacts),
    /// Cells of a raster.
    Cells(Frame),
}

impl SurfaceReport {
    /// Returns the counts of a surface, with the report of building it, which is taken out.
    ///
    /// # Errors
    /// If its parts are damaged.
    ///
    /// # Complexity
    /// Linear for a mesh and a raster, else constant.
    pub fn take(product: &mut SurfaceProduct) -> Result<Self> {
        let (origin, extent) = match (product.built.take(), &product.model) {
            (Some(built), _) => {
                let extent = built.tin.extent;
                (Origin::Built(built), extent)
            }
            (None, Model::Raster(grid)) => (Origin::Cells(grid.frame), grid.extent()),
            (None, Model::RasterFile(raster)) => (Origin::Cells(raster.frame()), raster.extent()),
            (None, Model::Mesh(_) | Model::Tin(_) | Model::Compact(_) | Model::Parts(_)) => {
                let facts = product.facts()?;
                let extent = facts.extent;
                (Origin::Triangles(facts), extent)
            }
        };
        Ok(SurfaceReport {
            origin,
            extent,
            crs: product.crs().cloned(),
        })
    }
}

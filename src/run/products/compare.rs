//! The difference of two surfaces: in cells, in numbers, and where it is largest.

use std::path::PathBuf;

use super::cells::{CellProduct, frame_over, refuse_options};
use super::changed::{AreaOptions, ChangedAreas, changed_areas};
use super::frame::{self, FrameOptions};
use super::surface::{Model, SurfaceProduct};
use super::together::no_overlap;
use crate::data::{BlockSource, Frame, Grid};
use crate::error::{Error, Result, Setting, wording};
use crate::io::geotiff::CellFormat;
use crate::run::context::notice::Notice;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Stage};
use crate::run::sources::systems::{self, SystemOptions};
use crate::terrain::{
    Dem, Difference, ErrorStatistics, LargeDifference, Method, largest_differences,
};

/// How two surfaces are compared.
#[derive(Debug, Clone)]
pub struct CompareOptions {
    /// Size and position of the cells; those of a raster are kept.
    pub frame: FrameOptions,
    /// How heights between the vertices are computed; a raster has its heights.
    pub method: Method,
    /// How many of the worst places are listed.
    pub worst: usize,
    /// Also find the areas in which the surfaces differ, on their triangles.
    pub areas: Option<AreaOptions>,
    /// What messages call the surfaces, such as the names of their files.
    pub names: [PathBuf; 2],
}

impl CompareOptions {
    /// The number of places that are listed by default.
    pub const WORST: usize = 10;
}

impl Default for CompareOptions {
    fn default() -> Self {
        CompareOptions {
            frame: FrameOptions::default(),
            method: Method::default(),
            worst: Self::WORST,
            areas: None,
            names: Default::default(),
        }
    }
}

/// The difference of two surfaces.
#[derive(Debug)]
#[non_exhaustive]
pub struct CompareProduct {
    /// The heights of the first surface minus those of the second in cells; NaN where either has
    /// none.
    pub difference: Grid,
    /// Their statistics.
    pub statistics: ErrorStatistics,
    /// Where surfaces differ most, the worst first, at least 8 cells apart.
    pub worst: Vec<LargeDifference>,
    /// The areas in which the surfaces differ, if they were asked for.
    pub areas: Option<ChangedAreas>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Compares two surfaces: computes the difference of their heights in the cells of a raster.
///
/// Cells are those of the first surface if it is a raster; of the second one if that is a raster
/// and no cells are chosen; or they are chosen as for a DEM of the first one. A raster that has
/// other cells is a surface between the centers of its cells.
///
/// # Errors
/// If no cell is on both surfaces, or the coordinate systems differ; if the frame cannot be chosen,
/// or is chosen for a raster, which keeps its own, or a method is for two rasters; if areas are
/// asked for and the method is not linear or the system is in degrees; if a file is damaged, the
/// cells do not fit into memory, or the run is canceled.
///
/// # Complexity
/// Linear in the triangles, and O(n log n) for n cells, on all threads; about 40 bytes for each
/// cell. For areas, that of [`terrain::changed_areas`](crate::terrain::changed_areas) besides.
pub fn compare(
    surfaces: [&SurfaceProduct; 2],
    options: &CompareOptions,
    context: &Context,
) -> Result<CompareProduct> {
    let journal = Journal::new(context);
    context.check()?;
    let [first, second] = surfaces;
    if options.areas.is_some() && options.method != Method::Linear {
        return Err(Error::usage(
            "areas are those of triangles, on which heights are linear: another method has none",
        )
        .cure(wording!["leave out ", Setting::Method]));
    }
    let stated = [0, 1].map(|k| surfaces[k].stated(&options.names[k]));
    let crs = systems::unify(&stated, &SystemOptions::default(), &journal)?.crs;
    let frame = cells_of(surfaces, options, &journal)?;
    let method = options.method;
    let difference = with_heights(first, frame, method, context, |first| {
        with_heights(second, frame, method, context, |second| {
            let difference = Difference::new(first, second)?;
            Grid::collect(&Watched::cells(
                &difference,
                Stage::ComputingHeights,
                context,
            )?)
        })
    })?;
    first.ensure_intact()?;
    second.ensure_intact()?;
    let known = difference.values.iter().copied().filter(|d| !d.is_nan());
    let Some(statistics) = ErrorStatistics::of(&known.collect::<Vec<f64>>()) else {
        return Err(no_cell(surfaces, &options.names));
    };
    let areas = options
        .areas
        .map(|areas| changed_areas(surfaces, crs, &areas, context))
        .transpose()?;
    context.check()?;
    Ok(CompareProduct {
        areas,
        worst: largest_differences(&difference.frame, &difference.values, options.worst),
        difference,
        statistics,
        notices: journal.take(),
    })
}

impl CompareProduct {
    /// Returns how many cells differ by more than a height: those where the first surface is
    /// higher, and those where it is lower.
    pub fn changed(&self, height: f64) -> [usize; 2] {
        let count = |is_changed: &dyn Fn(f64) -> bool| {
            let cells = self.difference.values.iter();
            cells.filter(|&&d| is_changed(d)).count()
        };
        [count(&|d| d > height), count(&|d| d < -height)]
    }

    /// Returns the area of a cell, in squares of the unit of the plan.
    pub fn cell_area(&self) -> f64 {
        frame::cell_area(&self.difference.frame)
    }

    /// Returns the cells, to be written.
    pub fn cells(&self) -> CellProduct<'_> {
        CellProduct::of_grid(&self.difference, CellFormat::Heights)
    }
}

/// Returns the frame of the difference.
fn cells_of(
    [first, second]: [&SurfaceProduct; 2],
    options: &CompareOptions,
    journal: &Journal,
) -> Result<Frame> {
    if let Some(frame) = raster_frame(first) {
        let method = match raster_frame(second) {
            Some(_) => options.method,
            None => Method::default(),
        };
        refuse_options(&options.frame, method)?;
        return Ok(frame);
    }
    match raster_frame(second).filter(|_| !options.frame.is_chosen()) {
        Some(frame) => Ok(frame),
        None => frame_over(first, &options.frame, journal),
    }
}

/// Returns the error for surfaces of which no cell has two heights.
#[cold]
fn no_cell(surfaces: [&SurfaceProduct; 2], names: &[PathBuf; 2]) -> Error {
    let [first, second] = surfaces.map(SurfaceProduct::extent);
    let are_apart = (0..2).any(|k| first.max[k] < second.min[k] || second.max[k] < first.min[k]);
    if are_apart || raster_frame(surfaces[0]).is_some() {
        return no_overlap(names);
    }
    let [one, other] = names.each_ref().map(|name| name.display());
    Error::usage(format!("no center of a cell is on both {one} and {other}"))
        .cure(wording!["choose smaller cells with ", Setting::Resolution])
}

/// Returns the frame of a raster; `None` of another surface.
fn raster_frame(product: &SurfaceProduct) -> Option<Frame> {
    match &product.model {
        Model::Raster(grid) => Some(grid.frame),
        Model::RasterFile(raster) => Some(raster.cells().frame()),
        Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) | Model::Parts(_) => None,
    }
}

/// Calls a function with the heights of a surface in the cells of a frame.
fn with_heights<T>(
    product: &SurfaceProduct,
    frame: Frame,
    method: Method,
    context: &Context,
    take: impl FnOnce(&dyn BlockSource) -> Result<T>,
) -> Result<T> {
    let is_raster = raster_frame(product).is_some();
    match &product.model {
        Model::Raster(grid) if grid.frame == frame => take(grid.as_ref()),
        Model::RasterFile(raster) if raster.cells().frame() == frame => take(&raster.cells()),
        Model::Parts(parts) if method == Method::Linear => take(&parts.dem(frame)?),
        _ => product.with_faces(context, |faces| {
            let method = if is_raster { Method::Linear } else { method };
            let dem = Dem::new(faces, frame)?.with_method(method)?;
            context.check()?;
            take(&dem)
        }),
    }
}

//! Contours of a surface.

use std::io::Cursor;

use super::contour_rows::{self, Scratch};
use super::map_options::MapOptions;
use super::surface::{Model, SurfaceProduct};
use crate::crs::Crs;
use crate::data::{ContourLine, Surface};
use crate::error::Result;
use crate::io::Destination;
use crate::io::contours::{self, ContourSummary};
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::sources::tin_parts;
use crate::terrain::{self, GridSurface, Levels};

/// The default height between contours.
const DEFAULT_INTERVAL: f64 = 1.0;

/// The heights at which contours are drawn, in the units of the heights. By default, every whole
/// unit.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContourOptions {
    /// The height between contours; 1 if it is `None`.
    pub interval: Option<f64>,
    /// A height at which there is a contour; the others follow from the interval.
    pub base: f64,
    /// These heights instead of an interval, unless empty.
    pub levels: Vec<f64>,
    /// How lines become those of a map.
    #[serde(default)]
    pub map: MapOptions,
}

impl ContourOptions {
    /// Returns the heights as a rule for drawing.
    ///
    /// # Errors
    /// Those of [`Levels::every`] and [`Levels::listed`].
    pub fn to_levels(&self) -> Result<Levels> {
        match self.levels.as_slice() {
            [] => Levels::every(self.interval.unwrap_or(DEFAULT_INTERVAL), self.base),
            levels => Levels::listed(levels),
        }
    }

    /// Returns the notice about the default interval, if it is used.
    pub(crate) fn notice(&self, crs: Option<&Crs>) -> Option<Notice> {
        let is_default = self.interval.is_none() && self.levels.is_empty();
        is_default.then(|| Notice::DefaultInterval(Units::of(crs).height(DEFAULT_INTERVAL)))
    }
}

/// The contours of a surface. They are drawn on demand.
#[derive(Debug)]
pub struct ContourProduct<'a> {
    product: &'a SurfaceProduct,
    levels: Levels,
    /// What was assumed, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Prepares contours, exact on the triangles; for a raster, between the centers of its cells.
///
/// # Errors
/// If a level or the interval is not a valid height, or the run is canceled.
pub fn contour<'a>(
    product: &'a SurfaceProduct,
    options: &ContourOptions,
    context: &Context,
) -> Result<ContourProduct<'a>> {
    let journal = Journal::new(context);
    context.check()?;
    let levels = options.to_levels()?;
    options
        .notice(product.crs())
        .into_iter()
        .for_each(|notice| journal.add(notice));
    Ok(ContourProduct {
        product,
        levels,
        notices: journal.take(),
    })
}

/// Writes lines that are in memory, in the format that the extension of `target` names; see
/// [`ContourProduct::write`].
///
/// # Errors
/// If there are too many lines for the format, the file cannot be written, or the run is canceled.
pub fn write_contours(
    lines: &[ContourLine],
    crs: Option<&Crs>,
    target: Destination,
    context: &Context,
) -> Result<ContourSummary> {
    let count = lines.iter().map(ContourLine::edge_count).sum();
    target.put_whole(|target| {
        contours::check_size(target, count)?;
        let drawing = context.start(Stage::DrawingContours, Size::Items(count))?;
        let is_wanted = |line: &&ContourLine| drawing.add(line.edge_count()).is_ok();
        let written = contours::write(
            target,
            &mut lines.iter().take_while(is_wanted).cloned(),
            crs,
        );
        drawing.end()?;
        written
    })
}

impl ContourProduct<'_> {
    /// Returns all lines, sorted by level and then by their points. Higher ground is on the right.
    ///
    /// # Errors
    /// If there are too many levels (see [`Levels::within`]), or the run is canceled.
    pub fn collect(&self, context: &Context) -> Result<Vec<ContourLine>> {
        let scratch = || Ok(Box::new(Cursor::new(Vec::new())) as Box<dyn Scratch>);
        self.draw(context, scratch, |lines, _| Ok(lines.collect()))
    }

    /// Draws all lines and writes them one after another, in the format that the extension of
    /// `target` names: `.shp`, `.geojson` or `.json`.
    ///
    /// # Errors
    /// If there are too many levels or lines, the file cannot be written, or the run is canceled.
    pub fn write(&self, target: Destination, context: &Context) -> Result<ContourSummary> {
        target.put_whole(|target| {
            let scratch = || Ok(Box::new(target.scratch()?) as Box<dyn Scratch>);
            self.draw(context, scratch, |lines, count| {
                contours::check_size(target, count)?;
                contours::write(target, lines, self.product.crs())
            })
        })
    }

    fn draw<T>(
        &self,
        context: &Context,
        scratch: impl FnOnce() -> Result<Box<dyn Scratch>>,
        take: impl FnOnce(&mut dyn Iterator<Item = ContourLine>, u64) -> Result<T>,
    ) -> Result<T> {
        match &self.product.model {
            Model::Raster(grid) => draw(&GridSurface::new(grid)?, &self.levels, context, take),
            Model::RasterFile(raster) => {
                contour_rows::draw(raster, &self.levels, scratch()?, context, take)
            }
            Model::Parts(parts) => {
                let finding = context.start(Stage::FindingContours, Size::Uncounted)?;
                let lines = tin_parts::contours(parts, &self.levels, context)?;
                finding.end()?;
                let count = lines.iter().map(ContourLine::edge_count).sum();
                take(&mut lines.into_iter(), count)
            }
            Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) => {
                draw(self.product.triangles()?, &self.levels, context, take)
            }
        }
    }
}

/// Calls `take` for the lines, with the number of their edges.
fn draw<S: Surface + ?Sized, T>(
    surface: &S,
    levels: &Levels,
    context: &Context,
    take: impl FnOnce(&mut dyn Iterator<Item = ContourLine>, u64) -> Result<T>,
) -> Result<T> {
    let finding = context.start(Stage::FindingContours, Size::Uncounted)?;
    let polled = Watched::polled(surface, context)?;
    let lines = terrain::contours(&polled, levels)?;
    finding.end()?;
    let count = lines.arc_count() as u64;
    let drawing = context.start(Stage::DrawingContours, Size::Items(count))?;
    let is_wanted = |line: &ContourLine| drawing.add(line.edge_count()).is_ok();
    let taken = take(&mut lines.take_while(is_wanted), count);
    drawing.end()?;
    polled.end()?;
    taken
}

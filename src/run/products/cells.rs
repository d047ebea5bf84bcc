//! Rasters of a surface: heights, hillshades, and quantities such as the slope. Their colors are in
//! [`relief`](super::relief).

use super::frame::{self, FrameOptions};
use super::surface::{Model, SurfaceProduct};
use crate::crs::Crs;
use crate::data::{self, BlockSource, Colors, Frame, Grid, Rgba, Surface, Window};
use crate::error::{Error, Result, Setting, wording};
use crate::io::formats::{self, FormatReader, WriteHeights};
use crate::io::geotiff::{self, CellFormat, Overviews, RasterSummary, WriteOptions};
use crate::io::{Destination, OutputDriver, gdal, png};
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::lines::layers;
use crate::terrain::{
    Dem, FaceSlopes, Gradient, GradientMap, GradientSource, Hillshade, Light, Method, Quantity,
    QuantityMap, Shading,
};

/// The light of a hillshade. By default it comes from the northwest, 45 degrees above the horizon.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct LightOptions {
    /// How shades follow from slopes.
    #[serde(default)]
    pub shading: Shading,
    /// The direction that the light comes from, in degrees clockwise from north; if `None`, 315.
    pub azimuth: Option<f64>,
    /// The angle of the light above the horizon, in degrees; if `None`, 45.
    pub altitude: Option<f64>,
    /// The factor for heights; if `None`, what converts them to the units of the plane.
    pub z_factor: Option<f64>,
}

impl LightOptions {
    /// Returns an error if a direction is given that the shading has no use for.
    ///
    /// # Errors
    /// Names the option.
    pub fn check(&self) -> Result<()> {
        if self.azimuth.is_some() && !self.shading.has_azimuth() {
            return Err(Error::usage(wording![
                Setting::Azimuth,
                " is given, but multidirectional shades are those of four lights, from 225 to 360 degrees"
            ])
            .cure(wording!["leave it out, or choose another ", Setting::Shading]));
        }
        if self.altitude.is_some() && !self.shading.has_altitude() {
            return Err(Error::usage(wording![
                Setting::Altitude,
                " is given, but these shades follow from the direction of the light alone"
            ])
            .cure(wording![
                "leave it out, or choose another ",
                Setting::Shading
            ]));
        }
        Ok(())
    }
}

/// Options of a DEM.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct DemOptions {
    /// Size and position of the cells.
    pub frame: FrameOptions,
    /// How heights between the vertices are computed.
    pub method: Method,
}

/// Options of a hillshade.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct HillshadeOptions {
    /// Size and position of the cells; a raster keeps its own.
    pub frame: FrameOptions,
    /// How heights between the vertices are computed; a raster has its heights.
    pub method: Method,
    /// The light.
    pub light: LightOptions,
}

/// Options of a quantity in cells, such as the slope.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct QuantityOptions {
    /// The quantity.
    pub quantity: Quantity,
    /// Size and position of the cells; a raster keeps its own.
    pub frame: FrameOptions,
    /// How heights between the vertices are computed; a raster has its heights.
    pub method: Method,
    /// The factor for heights; if `None`, what converts them to the units of the plane.
    pub z_factor: Option<f64>,
}

impl QuantityOptions {
    /// Returns the usual options for a quantity.
    pub fn new(quantity: Quantity) -> Self {
        QuantityOptions {
            quantity,
            frame: FrameOptions::default(),
            method: Method::default(),
            z_factor: None,
        }
    }

    /// Returns true if the quantity is that of the face at the center of each cell.
    pub fn is_of_faces(&self) -> bool {
        self.quantity.gradient() == Some(Gradient::Faces)
    }

    /// Returns an error unless the slopes of faces go with linear heights.
    ///
    /// # Errors
    /// Names the options.
    pub fn check(&self) -> Result<()> {
        match self.is_of_faces() && self.method != Method::Linear {
            true => Err(Error::usage(wording![
                Setting::Formula,
                " is that of faces, which are plane, and heights by this ",
                Setting::Method,
                " are not"
            ])
            .cure(wording![
                "leave out ",
                Setting::Method,
                ", or choose another ",
                Setting::Formula
            ])),
            false => Ok(()),
        }
    }
}

/// The cells of a raster. For a surface they are computed on demand, so that the raster may be
/// larger than memory.
pub struct CellProduct<'a> {
    source: Box<dyn BlockSource + 'a>,
    /// The triangles that cells are computed from; `None` for those of a TIN in parts, and for
    /// cells of a raster.
    surface: Option<&'a dyn Surface>,
    content: Content,
    /// The overviews of a GeoTIFF.
    overviews: Overviews,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// What the cells of a raster are.
#[derive(Debug)]
enum Content {
    Heights,
    Shades,
    /// Heights that are drawn in these colors.
    Colors(Colors),
}

impl Content {
    fn format(&self) -> CellFormat<'_> {
        match self {
            Content::Heights => CellFormat::Heights,
            Content::Shades => CellFormat::Shades,
            Content::Colors(colors) => CellFormat::Colors(colors),
        }
    }
}

/// Prepares a DEM: the heights of a surface at the centers of cells, NaN where there is none.
///
/// # Errors
/// If the surface is a raster, the frame cannot be chosen (see [`FrameOptions`]), or the run is
/// canceled.
///
/// # Complexity
/// Linear in the triangles.
pub fn dem<'a>(
    product: &'a SurfaceProduct,
    options: &DemOptions,
    context: &Context,
) -> Result<CellProduct<'a>> {
    let journal = Journal::new(context);
    let (source, surface) = heights(product, &options.frame, options.method, &journal)?;
    let cells = CellProduct::new(source, Content::Heights, journal.take());
    Ok(cells.with_overviews(options.frame.overviews).over(surface))
}

/// Prepares a hillshade: whole numbers from 1 (dark) to 255 (bright), and NaN in cells without a
/// height.
///
/// # Errors
/// If the frame cannot be chosen, or is chosen for a raster, which keeps its own; if a number of
/// the light is not finite, or of no use for the shading; or the run is canceled.
///
/// # Complexity
/// Linear in the triangles.
pub fn hillshade<'a>(
    product: &'a SurfaceProduct,
    options: &HillshadeOptions,
    context: &Context,
) -> Result<CellProduct<'a>> {
    let journal = Journal::new(context);
    let (source, surface) = given_or_drawn(product, &options.frame, options.method, &journal)?;
    let shades = CellProduct::shades_of(source, &options.light, product.crs(), &journal)?;
    Ok(shades.with_overviews(options.frame.overviews).over(surface))
}

/// Prepares a quantity in cells, such as the slope; NaN where there is none.
///
/// # Errors
/// Those of [`QuantityOptions::check`]; if the frame cannot be chosen, or is chosen for a raster,
/// which keeps its own; if the slopes of faces are asked of a raster; or if the run is canceled.
///
/// # Complexity
/// Linear in the triangles.
pub fn quantity<'a>(
    product: &'a SurfaceProduct,
    options: &QuantityOptions,
    context: &Context,
) -> Result<CellProduct<'a>> {
    options.check()?;
    let journal = Journal::new(context);
    let is_raster = matches!(product.model, Model::Raster(_) | Model::RasterFile(_));
    if options.is_of_faces() && !is_raster {
        let (source, surface) = gradients(product, &options.frame, &journal)?;
        let cells = CellProduct::face_slopes_of(source, options, product.crs(), &journal)?;
        return Ok(cells.over(surface));
    }
    let (source, surface) = given_or_drawn(product, &options.frame, options.method, &journal)?;
    let cells = CellProduct::quantity_of(source, options, product.crs(), &journal)?;
    Ok(cells.over(surface))
}

/// Returns the cells of a raster, or the heights of another surface in cells.
pub(super) fn given_or_drawn<'a>(
    product: &'a SurfaceProduct,
    frame: &FrameOptions,
    method: Method,
    journal: &Journal,
) -> Result<HeightSource<'a>> {
    match &product.model {
        Model::Raster(grid) => {
            refuse_options(frame, method)?;
            Ok((Box::new(grid.as_ref()), None))
        }
        Model::RasterFile(raster) => {
            refuse_options(frame, method)?;
            Ok((Box::new(raster.cells()), None))
        }
        Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) | Model::Parts(_) => {
            heights(product, frame, method, journal)
        }
    }
}

/// Heights, and the triangles that they are computed from unless these are in parts.
pub(super) type HeightSource<'a> = (Box<dyn BlockSource + 'a>, Option<&'a dyn Surface>);

/// Returns the heights of a surface.
fn heights<'a>(
    product: &'a SurfaceProduct,
    frame: &FrameOptions,
    method: Method,
    journal: &Journal,
) -> Result<HeightSource<'a>> {
    journal.context.check()?;
    if let Some(notice) = product.unread_by(method) {
        journal.add(notice);
    }
    let frame = frame_over(product, frame, journal)?;
    if let Model::Parts(parts) = &product.model
        && method == Method::Linear
    {
        return Ok((Box::new(parts.dem(frame)?), None));
    }
    let surface = product.triangles()?;
    let dem = Dem::new(surface, frame)?;
    journal.context.check()?;
    Ok((Box::new(dem.with_method(method)?), Some(surface)))
}

/// Gradients of faces, and the surface that they are of, if it is in one piece.
type Gradients<'a> = (Box<dyn GradientSource + 'a>, Option<&'a dyn Surface>);

/// Returns the gradients of the faces of a surface.
fn gradients<'a>(
    product: &'a SurfaceProduct,
    frame: &FrameOptions,
    journal: &Journal,
) -> Result<Gradients<'a>> {
    journal.context.check()?;
    let frame = frame_over(product, frame, journal)?;
    if let Model::Parts(parts) = &product.model {
        return Ok((Box::new(parts.dem(frame)?), None));
    }
    let surface = product.triangles()?;
    Ok((Box::new(GradientMap::new(surface, frame)?), Some(surface)))
}

/// Chooses the frame of a raster over triangles. Those of a TIN in parts are not joined.
///
/// # Errors
/// Those of [`frame::choose`], and if the surface is a raster.
pub(super) fn frame_over(
    product: &SurfaceProduct,
    options: &FrameOptions,
    journal: &Journal,
) -> Result<Frame> {
    let extent = product.extent();
    match &product.model {
        Model::Parts(parts) => {
            let frame = frame::over_extent(options, extent, product.crs(), journal)?;
            frame::require_filled(options, &frame, &extent, || parts.index().area)?;
            Ok(frame)
        }
        _ => frame::choose(options, product.triangles()?, extent, journal),
    }
}

/// Returns an error if options are given that only a TIN has a use for.
pub(super) fn refuse_options(frame: &FrameOptions, method: Method) -> Result<()> {
    if frame.is_chosen() {
        return Err(Error::usage(wording![
            Setting::Resolution,
            ", ",
            Setting::Extent,
            " and ",
            Setting::AlignTo,
            " are for a TIN; a DEM keeps its own cells"
        ]));
    }
    if method != Method::default() {
        return Err(Error::usage(wording![
            Setting::Method,
            " is for a TIN; a DEM has a height in each of its cells already"
        ])
        .cure("leave it out, or pass points, a .tin or a .ply"));
    }
    Ok(())
}

/// Heights over angles are exaggerated more by mistake only.
const MOST_EXAGGERATION: f64 = 1000.0;

/// Returns the units of y per unit of z, and those per unit of x, over a frame. Differences of
/// heights need no lengths.
fn scale_over(
    options: &QuantityOptions,
    crs: Option<&Crs>,
    frame: &Frame,
    journal: &Journal,
) -> [f64; 2] {
    let light = LightOptions {
        z_factor: options.z_factor,
        ..LightOptions::default()
    };
    let Light {
        z_factor, x_scale, ..
    } = match options.quantity.has_lengths() {
        true => light_over(&light, crs, frame, journal),
        false => Light::default(),
    };
    [z_factor, x_scale]
}

/// Returns the light over a frame. A given factor for heights is that of both axes.
fn light_over(
    options: &LightOptions,
    crs: Option<&Crs>,
    frame: &Frame,
    journal: &Journal,
) -> Light {
    let usual = Light::for_crs(crs, frame);
    let light = match options.z_factor {
        Some(z_factor) => Light {
            z_factor,
            ..Light::default()
        },
        None => usual,
    };
    if let Some(factor) = options.z_factor
        && Units::of(crs).is_angular()
        && factor > MOST_EXAGGERATION * usual.z_factor
    {
        journal.add(Notice::SteepAngles {
            factor,
            usual: usual.z_factor,
        });
    }
    if options.z_factor.is_none() && light.z_factor != 1.0 {
        journal.add(match Units::of(crs).is_angular() {
            true => Notice::AnglesAsLengths([light.x_scale, 1.0].map(|part| part / light.z_factor)),
            false => Notice::HeightFactor(light.z_factor),
        });
    }
    Light {
        shading: options.shading,
        azimuth: options.azimuth.unwrap_or(light.azimuth),
        altitude: options.altitude.unwrap_or(light.altitude),
        ..light
    }
}

impl<'a> CellProduct<'a> {
    fn new(source: Box<dyn BlockSource + 'a>, content: Content, notices: Vec<Notice>) -> Self {
        CellProduct {
            source,
            surface: None,
            content,
            overviews: Overviews::default(),
            notices,
        }
    }

    /// Heights that were drawn already.
    pub(crate) fn heights_of(source: Box<dyn BlockSource + 'a>) -> Self {
        CellProduct::new(source, Content::Heights, Vec::new())
    }

    /// Returns the hillshade of heights in cells.
    ///
    /// # Errors
    /// If a number of the light is not finite or of no use for the shading, or the frame has no
    /// inverse.
    pub(crate) fn shades_of(
        source: Box<dyn BlockSource + 'a>,
        options: &LightOptions,
        crs: Option<&Crs>,
        journal: &Journal,
    ) -> Result<Self> {
        options.check()?;
        let light = light_over(options, crs, &source.frame(), journal);
        let source = Box::new(Hillshade::new(source, light)?);
        Ok(CellProduct::new(source, Content::Shades, journal.take()))
    }

    /// Returns a quantity of heights in cells.
    ///
    /// # Errors
    /// If the frame has no inverse.
    pub(crate) fn quantity_of(
        source: Box<dyn BlockSource + 'a>,
        options: &QuantityOptions,
        crs: Option<&Crs>,
        journal: &Journal,
    ) -> Result<Self> {
        let [z_factor, x_scale] = scale_over(options, crs, &source.frame(), journal);
        let map = QuantityMap::of(source, options.quantity, z_factor, x_scale)?;
        Ok(CellProduct::numbers(Box::new(map), options, journal))
    }

    /// Returns the slope or the aspect of faces in cells.
    ///
    /// # Errors
    /// If the quantity is not one of faces.
    pub(crate) fn face_slopes_of(
        source: Box<dyn GradientSource + 'a>,
        options: &QuantityOptions,
        crs: Option<&Crs>,
        journal: &Journal,
    ) -> Result<Self> {
        let [z_factor, x_scale] = scale_over(options, crs, &source.frame(), journal);
        let map = FaceSlopes::of(source, options.quantity, z_factor, x_scale)?;
        Ok(CellProduct::numbers(Box::new(map), options, journal))
    }

    /// Returns the values of a quantity in cells.
    fn numbers(
        source: Box<dyn BlockSource + 'a>,
        options: &QuantityOptions,
        journal: &Journal,
    ) -> Self {
        CellProduct::new(source, Content::Heights, journal.take())
            .with_overviews(options.frame.overviews)
    }

    /// Returns the cells of a grid that is in memory, to be written as `cells`.
    pub fn of_grid(grid: &'a Grid, cells: CellFormat) -> Self {
        let content = match cells {
            CellFormat::Heights => Content::Heights,
            CellFormat::Shades => Content::Shades,
            CellFormat::Colors(colors) => Content::Colors(colors.clone()),
        };
        CellProduct::new(Box::new(grid), content, Vec::new())
    }

    /// Returns heights in cells, to be written in these colors. Colors have no overviews.
    pub(super) fn colors(
        source: Box<dyn BlockSource + 'a>,
        colors: Colors,
        journal: &Journal,
    ) -> Self {
        CellProduct::new(source, Content::Colors(colors), journal.take())
            .with_overviews(Overviews::None)
    }

    /// Returns the cells with these overviews where they are written to a GeoTIFF.
    pub fn with_overviews(self, overviews: Overviews) -> Self {
        CellProduct { overviews, ..self }
    }

    /// Returns the cells with the triangles that they are computed from.
    pub(super) fn over(self, surface: Option<&'a dyn Surface>) -> Self {
        CellProduct { surface, ..self }
    }
}

/// Returns the writer of heights in a format other than GeoTIFF, by the extension of a target.
fn text_writer(target: Destination) -> Option<WriteHeights> {
    let format = formats::for_output(&target.format_path(), formats::Product::Heights)?;
    let is_geotiff = matches!(format.reader, FormatReader::Raster(_));
    format.writers.heights.filter(|_| !is_geotiff)
}

impl CellProduct<'_> {
    /// Returns how many times the cells of a GeoTIFF are on the disk while it is written.
    pub(crate) fn copies_on_disk(&self) -> f64 {
        self.overviews.copies_on_disk()
    }

    /// Returns about how many cells have a value; for a raster, the number of all cells.
    ///
    /// # Complexity
    /// Linear in the triangles.
    pub fn covered(&self) -> f64 {
        let Frame { width, height, .. } = self.frame();
        let all = width as f64 * height as f64;
        self.surface.map_or(all, |surface| {
            all.min(frame::cells_on(surface, &self.frame()))
        })
    }

    /// Computes all cells, on all cores.
    ///
    /// # Errors
    /// If they do not fit into memory, or the run is canceled.
    pub fn collect(&self, context: &Context) -> Result<Grid> {
        Grid::collect(&self.watched(context)?)
    }

    /// Computes all cells, on all cores, as they are written: in half the memory of a [`Grid`].
    ///
    /// # Errors
    /// Those of [`collect`](Self::collect).
    pub fn collect_cells(&self, context: &Context) -> Result<(Frame, Vec<f32>)> {
        Ok((self.frame(), data::cells(&self.watched(context)?)?))
    }

    /// Computes all cells, on all cores, and writes them: heights as 32-bit floats, shades as
    /// bytes, colors as four bytes. The format is GeoTIFF, unless the extension of the target is
    /// that of another format of heights, or the target has a driver of GDAL.
    ///
    /// # Errors
    /// If the file cannot be written, or the run is canceled.
    pub fn write(&self, target: Destination, context: &Context) -> Result<RasterSummary> {
        if let Some(driver) = target.driver() {
            return self.write_by(driver, target, context);
        }
        if let (Content::Heights, Some(write)) = (&self.content, text_writer(target)) {
            return write(target, &self.watched(context)?);
        }
        let options = WriteOptions {
            overviews: self.overviews,
            ..self.content.format().into()
        };
        let cells = geotiff::cells_written(self.frame(), &options);
        let work = context.start(self.stage(), Size::Items(cells))?;
        let options = WriteOptions {
            watch: &|cells| work.add(cells),
            ..options
        };
        geotiff::write(target, self.source.as_ref(), options)
    }

    /// Writes the cells by a driver of GDAL, and reports its warnings.
    fn write_by(
        &self,
        driver: &OutputDriver,
        target: Destination,
        context: &Context,
    ) -> Result<RasterSummary> {
        let cells = self.content.format();
        let options = WriteOptions {
            overviews: Overviews::None,
            ..cells.into()
        };
        let count = geotiff::cells_written(self.frame(), &options);
        let work = context.start(self.stage(), Size::Items(count))?;
        let watch = |cells| work.add(cells);
        let source = self.source.as_ref();
        let (summary, warnings) = gdal::write_raster(target, driver, source, cells, &watch)?;
        layers::note_warnings(target.path(), warnings, context);
        Ok(summary)
    }

    /// Computes all cells, on all cores, and writes them as a PNG: in gray, 0 to 255, or in colors.
    ///
    /// # Errors
    /// If the file cannot be written, or the run is canceled.
    pub fn write_picture(&self, target: Destination, context: &Context) -> Result<()> {
        let cells = self.watched(context)?;
        match &self.content {
            Content::Heights | Content::Shades => png::write_gray(target, &cells),
            Content::Colors(colors) => png::write_colors(target, &cells, colors),
        }
    }

    /// Computes the colors of all cells, on all cores. Cells that are not drawn in colors are
    /// transparent.
    ///
    /// # Errors
    /// Those of [`collect`](Self::collect).
    pub fn collect_colors(&self, context: &Context) -> Result<(Frame, Vec<Rgba>)> {
        let (frame, cells) = self.collect_cells(context)?;
        let colors = match &self.content {
            Content::Colors(colors) => cells.into_iter().map(|cell| colors.of(cell)).collect(),
            Content::Heights | Content::Shades => vec![[0; 4]; cells.len()],
        };
        Ok((frame, colors))
    }

    fn watched<'b>(&'b self, context: &Context<'b>) -> Result<Watched<'b, dyn BlockSource + 'b>> {
        Watched::cells(self.source.as_ref(), self.stage(), context)
    }

    fn stage(&self) -> Stage {
        match self.content {
            Content::Heights | Content::Colors(_) => Stage::WritingCells,
            Content::Shades => Stage::ShadingCells,
        }
    }
}

/// Reports no progress, and is not stopped when the run is canceled.
impl BlockSource for CellProduct<'_> {
    fn frame(&self) -> Frame {
        self.source.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.source.fill(window, out)
    }
}

impl std::fmt::Debug for CellProduct<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CellProduct")
            .field("frame", &self.frame())
            .field("notices", &self.notices)
            .finish_non_exhaustive()
    }
}

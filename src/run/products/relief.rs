//! Color relief: heights in cells, drawn in the colors of a ramp.

use std::path::Path;

use super::cells::{CellProduct, given_or_drawn};
use super::frame::FrameOptions;
use super::surface::SurfaceProduct;
use crate::data::{self, BlockSource, ColorMatch, ColorRamp};
use crate::error::{Error, Result, Setting, wording};
use crate::io::ramp;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Stage};
use crate::terrain::Method;

/// Options of a color relief.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct ColorReliefOptions {
    /// The colors.
    pub ramp: ColorRamp,
    /// The colors of heights between those of the ramp.
    pub matching: ColorMatch,
    /// Size and position of the cells; a raster keeps its own.
    pub frame: FrameOptions,
    /// How heights between the vertices are computed; a raster has its heights.
    pub method: Method,
}

impl ColorReliefOptions {
    /// Returns the usual options for a ramp.
    pub fn new(ramp: ColorRamp) -> Self {
        ColorReliefOptions {
            ramp,
            matching: ColorMatch::default(),
            frame: FrameOptions::default(),
            method: Method::default(),
        }
    }
}

/// Returns the color ramp that is built in under a name, or the one in a file.
///
/// # Errors
/// If no ramp and no file has this name, or the file is not a ramp (see [`ramp::read`]).
pub fn color_ramp(name_or_file: &Path) -> Result<ColorRamp> {
    let built_in = name_or_file.to_str().and_then(ramp::built_in);
    match built_in {
        Some(ramp) => Ok(ramp),
        None if name_or_file.exists() => ramp::read(name_or_file),
        None => {
            let names: Vec<&str> = ramp::names().collect();
            Err(Error::usage(wording![
                Setting::Ramp,
                format!(
                    " {}: there is no such ramp, nor such a file",
                    name_or_file.display()
                )
            ])
            .cure(format!(
                "use {}, or a file with a height and its color on each line",
                names.join(", ")
            )))
        }
    }
}

/// Prepares a color relief: the heights of a surface in cells, with the colors that they have in a
/// ramp. Cells without a height are transparent, or have the color of the ramp for them.
///
/// # Errors
/// If the frame cannot be chosen, or is chosen for a raster, which keeps its own; or if the run is
/// canceled.
///
/// # Complexity
/// Linear in the triangles; if colors depend on the lowest and the highest cell, also linear in the
/// cells, which are then computed twice.
pub fn color_relief<'a>(
    product: &'a SurfaceProduct,
    options: &ColorReliefOptions,
    context: &Context,
) -> Result<CellProduct<'a>> {
    let journal = Journal::new(context);
    let (source, surface) = given_or_drawn(product, &options.frame, options.method, &journal)?;
    let cells = colors_of(source, options, &journal)?;
    Ok(cells.over(surface))
}

/// Returns heights in cells, to be written in the colors of a ramp.
///
/// # Errors
/// If the colors depend on the lowest and the highest cell, and a cell cannot be computed or the
/// run is canceled.
pub(crate) fn colors_of<'a>(
    source: Box<dyn BlockSource + 'a>,
    ColorReliefOptions { ramp, matching, .. }: &ColorReliefOptions,
    journal: &Journal,
) -> Result<CellProduct<'a>> {
    let range = match ramp.has_percents() {
        true => data::range_of(&Watched::cells(
            source.as_ref(),
            Stage::ComputingHeights,
            &journal.context,
        )?)?,
        false => None,
    };
    Ok(CellProduct::colors(
        source,
        ramp.over(range, *matching),
        journal,
    ))
}

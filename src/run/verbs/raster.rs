//! What verbs have in common that write rasters.

use std::fmt::Debug;

use super::Summary;
use super::targets::{Outputs, Target};
use crate::data::BlockSource;
use crate::error::{Error, Result, Setting, wording};
use crate::io::formats::{self, Content, Product};
use crate::io::geotiff::RasterSummary;
use crate::run::context::Context;
use crate::run::context::event::Event;
use crate::run::context::notice::Notice;
use crate::run::context::units::bytes;
use crate::run::products::cells::CellProduct;
use crate::run::products::frame::FrameOptions;
use crate::run::request::serialized::in_plan;

/// DEFLATE seldom makes heights smaller than by this factor.
const BEST_COMPRESSION: f64 = 10.0;

/// Calls a function with the options of a frame, by their names.
pub(super) fn list_frame(
    FrameOptions {
        resolution,
        extent,
        align_to,
        overviews,
    }: &FrameOptions,
    add: &mut dyn FnMut(Setting, &dyn Debug),
) {
    add(Setting::Resolution, resolution);
    add(Setting::Extent, &extent.map(in_plan::corners));
    add(Setting::AlignTo, align_to);
    add(Setting::Overviews, overviews);
}

/// Returns true if a target of shades or colors is a picture, and not a raster.
pub(super) fn is_picture(target: &Target) -> bool {
    target.driver.is_none()
        && formats::for_output(&target.path, Product::Shades)
            .is_some_and(|format| format.content == Content::Picture)
}

/// Writes shades or colors to all targets, as pictures or rasters. `cell_bytes` returns the bytes
/// of a cell of a target before compression.
///
/// # Errors
/// Those of [`announce`]; and if a file cannot be written, or the run is canceled.
pub(super) fn write_drawn(
    cells: &CellProduct,
    outputs: &Outputs,
    cell_bytes: impl Fn(&Target) -> u64,
    context: &Context,
) -> Result<Summary> {
    let copies = |target: &Target| match is_picture(target) {
        true => 1.0,
        false => cells.copies_on_disk(),
    };
    let on_disk = |target: &Target| (cell_bytes(target), copies(target));
    announce(cells, outputs, on_disk, context)?;
    for target in &outputs.targets {
        let destination = target.within(&outputs.set);
        if is_picture(target) {
            cells.write_picture(destination, context)?;
        } else {
            cells.write(destination, context)?;
        }
    }
    Ok(Summary::Shades)
}

/// Writes heights or a quantity to all targets, as rasters of 32-bit floats. Returns a summary of
/// the cells.
///
/// # Errors
/// Those of [`announce`]; and if a file cannot be written, or the run is canceled.
pub(super) fn write_numbers(
    cells: &CellProduct,
    outputs: &Outputs,
    context: &Context,
) -> Result<RasterSummary> {
    announce(cells, outputs, |_| (4, cells.copies_on_disk()), context)?;
    let mut written = RasterSummary {
        min: f64::NAN,
        max: f64::NAN,
        valid: 0,
    };
    for target in &outputs.targets {
        written = cells.write(target.within(&outputs.set), context)?;
    }
    Ok(written)
}

/// Reports the size of a raster, and makes sure that the disk has room for its cells. `cell_bytes`
/// returns the bytes of a cell before compression, and how many times they are on the disk. Of a
/// surface, only the cells that it covers count.
///
/// # Errors
/// If the cells cannot fit, however well they are compressed.
fn announce(
    cells: &CellProduct,
    outputs: &Outputs,
    cell_bytes: impl Fn(&Target) -> (u64, f64),
    context: &Context,
) -> Result<()> {
    let frame = cells.frame();
    let sizes: Vec<(u64, f64)> = outputs.targets.iter().map(cell_bytes).collect();
    let all = frame.width as f64 * frame.height as f64;
    let a_cell = sizes.iter().map(|&(bytes, _)| bytes as f64).sum::<f64>();
    let on_disk = sizes
        .iter()
        .map(|&(bytes, copies)| bytes as f64 * copies)
        .sum::<f64>();
    context.monitor.event(&Event::RasterBegins {
        frame,
        crs: cells.crs(),
        bytes: (all * a_cell) as u64,
    });
    let Some((free, target)) = outputs
        .free_space()
        .filter(|(free, _)| (*free as f64) < all * on_disk)
    else {
        return Ok(());
    };
    let covered = all.min(cells.covered());
    let need = (covered * a_cell) as u64;
    if covered * on_disk / BEST_COMPRESSION > free as f64 {
        let (need, free) = (bytes(need), bytes(free));
        return Err(Error::limit(format!(
            "the cells with a value take {need} before compression, {free} are free on the disk"
        ))
        .in_file(target)
        .cure(wording![
            "choose larger cells (",
            Setting::Resolution,
            "), a smaller extent (",
            Setting::Extent,
            "), or another disk"
        ]));
    }
    if covered * on_disk > free as f64 {
        context
            .monitor
            .notice(&Notice::OutputMayNotFit { need, free });
    }
    Ok(())
}

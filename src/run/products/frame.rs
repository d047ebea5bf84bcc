//! Size and position of a raster over a surface.

use std::path::PathBuf;

use crate::crs::Crs;
use crate::data::{self, Bounds, Frame, Surface};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::geotiff::Overviews;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;
use crate::run::context::units::{Units, neat, number};
use crate::run::request::serialized;
use crate::run::sources::open::{self, RasterFrame};
use crate::run::sources::systems::quoted;

/// The default size of a cell.
const DEFAULT_RESOLUTION: f64 = 1.0;

/// Rasters with fewer cells are never refused as mostly empty.
const MANY_CELLS: f64 = 1e8;

/// The share of cells with a value below which a large raster is refused as a mistake.
const MOSTLY_EMPTY: f64 = 0.01;

/// Size and position of a raster, and its overviews. By default cells are 1 unit wide, start at
/// multiples of that, so that neighboring rasters fit together, and cover the surface.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct FrameOptions {
    /// The width of a cell, in the units of the coordinate system; `None` is 1, or an error in
    /// degrees.
    pub resolution: Option<f64>,
    /// The extent, enlarged to whole cells; heights are ignored. `None` is the extent of the
    /// surface.
    #[serde(with = "serialized::in_plan")]
    pub extent: Option<Bounds>,
    /// A raster whose grid of cells is used, also beyond its edges. The resolution is then ignored.
    pub align_to: Option<PathBuf>,
    /// Whether a GeoTIFF has overviews.
    #[serde(default)]
    pub overviews: Overviews,
}

impl FrameOptions {
    /// Returns true if the size, the extent or the grid of the cells is chosen.
    pub(crate) fn is_chosen(&self) -> bool {
        self.resolution.is_some() || self.extent.is_some() || self.align_to.is_some()
    }

    /// Returns these options with a raster to align to.
    pub(crate) fn aligned_to(&self, raster: PathBuf) -> Self {
        FrameOptions {
            align_to: Some(raster),
            ..self.clone()
        }
    }
}

/// Chooses the frame of a raster over a surface.
///
/// # Errors
/// If the raster to align to cannot be read or is in a different coordinate system, if there would
/// be no cell, or if the raster would be large and nearly empty and no extent is given.
pub(crate) fn choose(
    options: &FrameOptions,
    surface: &dyn Surface,
    extent: Bounds,
    journal: &Journal,
) -> Result<Frame> {
    let frame = over_extent(options, extent, surface.crs(), journal)?;
    require_filled(options, &frame, &extent, || area(surface))?;
    Ok(frame)
}

/// Returns an error if the raster would be large and nearly empty and no extent is given.
pub(crate) fn require_filled(
    options: &FrameOptions,
    frame: &Frame,
    extent: &Bounds,
    area: impl FnOnce() -> f64,
) -> Result<()> {
    let cells = frame.width as f64 * frame.height as f64;
    if options.extent.is_none() && cells > MANY_CELLS {
        let share = area() / cell_area(frame) / cells;
        if share < MOSTLY_EMPTY {
            return Err(mostly_empty(frame, share, extent));
        }
    }
    Ok(())
}

#[cold]
fn mostly_empty(frame: &Frame, share: f64, extent: &Bounds) -> Error {
    let Frame { width, height, .. } = frame;
    let [x0, y0, x1, y1] = [extent.min[0], extent.min[1], extent.max[0], extent.max[1]].map(neat);
    Error::usage(format!(
        "the raster would have {width} x {height} cells, and {} % of them a value: the surface is scattered",
        number(100.0 * share)
    ))
    .cure(wording![
        "leave out files that are far away (",
        Command::Info,
        " shows the extent of each), or write a part with ",
        Setting::Extent,
        "; ",
        Setting::Extent,
        format!(" {x0},{y0},{x1},{y1} writes the whole raster")
    ])
}

/// Returns about how many cells the surface covers, including those outside of the frame.
pub(crate) fn cells_on(surface: &dyn Surface, frame: &Frame) -> f64 {
    area(surface) / cell_area(frame)
}

/// Returns the area of a surface in plan.
fn area(surface: &dyn Surface) -> f64 {
    data::corners(surface)
        .map(|(_, corners)| data::area_of(corners.map(|vertex| surface.position(vertex))))
        .sum()
}

pub(super) fn cell_area(frame: &Frame) -> f64 {
    let t = &frame.transform;
    (t[1] * t[5] - t[2] * t[4]).abs()
}

/// Returns an error if a raster states a system other than that of the surface, or one that is not
/// understood.
fn require_same(raster: &RasterFrame, ours: &Crs) -> Result<()> {
    match (&raster.crs, &raster.unread_crs) {
        (Some(theirs), _) if !theirs.is_same(ours) => {
            Err(Error::unsupported(format!("the raster is in {theirs}, the surface in {ours}"))
                .cure("build the surface of points in the raster's system, or match another raster"))
        }
        (None, Some(stated)) => Err(Error::unsupported(format!(
            "the raster states a coordinate system that is not understood, {}; the surface is in {ours}",
            quoted(stated)
        ))
        .cure(wording![
            "match another raster, or give the raster with ",
            Setting::Extent,
            " and ",
            Setting::Resolution
        ])),
        _ => Ok(()),
    }
}

/// Chooses the frame of a raster over an extent, whatever part of it has a value.
///
/// # Errors
/// Those of [`choose`], except for the last.
pub(crate) fn over_extent(
    options: &FrameOptions,
    extent: Bounds,
    crs: Option<&Crs>,
    journal: &Journal,
) -> Result<Frame> {
    let units = Units::of(crs);
    if extent.is_empty() {
        return Err(Error::format(
            "the surface has no triangle, so there is no raster of it",
        ));
    }
    let extent = match options.extent {
        Some(given) => {
            if (0..2).any(|i| given.max[i] <= extent.min[i] || given.min[i] >= extent.max[i]) {
                journal.add(Notice::ExtentApart);
            }
            given
        }
        None => extent,
    };
    if let Some(path) = &options.align_to {
        let theirs = open::raster_frame(path)?;
        if let Some(ours) = crs {
            require_same(&theirs, ours).map_err(|e| e.in_file(path))?;
        }
        return Frame::aligned_to(&theirs.frame, &extent);
    }
    let resolution = match options.resolution {
        Some(resolution) => resolution,
        None if units.is_angular() => {
            return Err(Error::usage("there is no default resolution in degrees")
                .cure(wording!["add ", Setting::Resolution]));
        }
        None => {
            journal.add(Notice::DefaultResolution(units.length(DEFAULT_RESOLUTION)));
            DEFAULT_RESOLUTION
        }
    };
    Frame::snapped(&extent, resolution)
}

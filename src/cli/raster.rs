//! Size and place of a raster, and the bar that shows how much of it is done.

use indicatif::ProgressBar;

use super::args::FrameArgs;
use super::open;
use super::talk::Talk;
use super::units::Units;
use crate::crs::Crs;
use crate::data::{BlockSource, Bounds, Frame, Grid, Window};
use crate::error::{Error, Result};

/// Cells are this large unless something else is said.
const DEFAULT_RESOLUTION: f64 = 1.0;

/// Works out the frame of a raster over a surface.
///
/// # Errors
/// If the raster to align to cannot be read or is in another system, or no cell would be there.
pub(super) fn frame(args: &FrameArgs, extent: Bounds, crs: Option<&Crs>, talk: &Talk) -> Result<Frame> {
    let units = Units::of(crs);
    if extent.is_empty() {
        return Err(Error::format("the surface has no triangle, so there is no raster of it"));
    }
    let extent = match args.te {
        Some(corners) => {
            let te = corners.grown(0.0);
            if (0..2).any(|i| te.max[i] <= extent.min[i] || te.min[i] >= extent.max[i]) {
                talk.warning("the rectangle of --te does not touch the surface");
            }
            te
        }
        None => extent,
    };
    if let Some(path) = &args.align_to {
        let (frame, theirs) = open::raster_place(path)?;
        if let (Some(theirs), Some(ours)) = (theirs, crs)
            && !theirs.is_same(ours)
        {
            return Err(Error::unsupported(format!("the raster is in {theirs}, the surface in {ours}"))
                .in_file(path)
                .cure("build the surface of points with --t-srs and the raster's system"));
        }
        return Frame::aligned_to(&frame, &extent);
    }
    let resolution = match args.resolution {
        Some(resolution) => resolution,
        None if units.is_angular() => {
            return Err(Error::usage("there is no default resolution in degrees").cure("add --resolution"));
        }
        None => {
            talk.note(format_args!("cells are {} wide (--resolution)", units.length(DEFAULT_RESOLUTION)));
            DEFAULT_RESOLUTION
        }
    };
    Frame::snapped(&extent, resolution)
}

/// The box of all cells, corners included; without heights.
pub(super) fn extent(frame: &Frame) -> Bounds {
    let mut bounds = Bounds::default();
    let (width, height) = (frame.width as f64, frame.height as f64);
    for (column, row) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
        let [x, y] = frame.to_map(column, row);
        bounds.add([x, y, f64::NAN]);
    }
    bounds
}

/// The same with the lowest and the highest height, where there is any.
pub(super) fn extent_of(grid: &Grid) -> Bounds {
    let mut bounds = extent(&grid.frame);
    let [x, y, _] = bounds.min;
    grid.values.iter().filter(|z| !z.is_nan()).for_each(|&z| bounds.add([x, y, z]));
    bounds
}

/// A source of blocks that tells a progress bar what it has filled.
pub(super) struct Watched<'a> {
    pub(super) source: &'a dyn BlockSource,
    pub(super) bar: ProgressBar,
}

impl<'a> Watched<'a> {
    pub(super) fn new(source: &'a dyn BlockSource, what: &'static str, talk: &Talk) -> Self {
        let frame = source.frame();
        let cells = frame.width as u64 * frame.height as u64;
        Watched { source, bar: talk.bar(what, Some(cells)) }
    }
}

impl Drop for Watched<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl BlockSource for Watched<'_> {
    fn frame(&self) -> Frame {
        self.source.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.source.fill(window, out)?;
        self.bar.inc(window.width as u64 * window.height as u64);
        Ok(())
    }
}

/// `400 x 300 cells of 1 m`
pub(super) fn describe(frame: &Frame, crs: Option<&Crs>) -> String {
    let t = frame.transform;
    let (across, down) = (t[1].hypot(t[4]), t[2].hypot(t[5]));
    let units = Units::of(crs);
    let size = if across == down {
        units.length(across)
    } else {
        format!("{} by {}", super::units::number(across), units.length(down))
    };
    format!("{} x {} cells of {size}", frame.width, frame.height)
}

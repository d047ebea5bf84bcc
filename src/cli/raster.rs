//! Size and place of a raster, and the room for it.

use super::args::FrameArgs;
use super::gather::Gathered;
use super::open;
use super::outputs::Outputs;
use super::talk::Talk;
use crate::crs::Crs;
use crate::data::{self, Bounds, Frame, Grid, Surface};
use crate::error::{Error, Result};
use crate::run::units::{Units, bytes, neat, number};

/// Cells are this large unless something else is said.
const DEFAULT_RESOLUTION: f64 = 1.0;

/// Rasters of fewer cells may be as empty as they like.
const MANY_CELLS: f64 = 1e8;

/// The share of cells on the surface below which a large raster is taken for a mistake.
const MOSTLY_EMPTY: f64 = 0.01;

/// DEFLATE seldom makes heights smaller than by this factor.
const BEST_COMPRESSION: f64 = 10.0;

/// Works out the frame of a raster over a surface.
///
/// # Errors
/// If the raster to align to cannot be read or is in another system, no cell would be there, or nearly all of very many
/// would be empty without [`FrameArgs::te`].
pub(super) fn frame(args: &FrameArgs, gathered: &Gathered, talk: &Talk) -> Result<Frame> {
    let surface = gathered.surface.as_ref();
    let extent = gathered.made.extent(surface);
    let frame = placed(args, extent, surface.crs(), talk)?;
    let cells = cell_count(&frame);
    if args.te.is_none() && cells > MANY_CELLS {
        let share = cells_on(surface, &frame) / cells;
        if share < MOSTLY_EMPTY {
            return Err(mostly_empty(&frame, share, &extent));
        }
    }
    Ok(frame)
}

#[cold]
fn mostly_empty(frame: &Frame, share: f64, extent: &Bounds) -> Error {
    let Frame { width, height, .. } = frame;
    let [x0, y0, x1, y1] = [extent.min[0], extent.min[1], extent.max[0], extent.max[1]].map(neat);
    Error::usage(format!(
        "the raster would have {width} x {height} cells, and {} % of them a value: the surface is scattered",
        number(100.0 * share)
    ))
    .cure(format!(
        "leave out files that lie far away (`breakline info` tells the extent of each), or write a part with --te; \
         --te {x0},{y0},{x1},{y1} writes it all the same"
    ))
}

fn cell_count(frame: &Frame) -> f64 {
    frame.width as f64 * frame.height as f64
}

/// How many cells the surface covers, about; those outside of the frame count, too.
fn cells_on(surface: &dyn Surface, frame: &Frame) -> f64 {
    let doubled = data::corners(surface).map(|(_, corners)| {
        let [[ax, ay, _], [bx, by, _], [cx, cy, _]] = corners.map(|vertex| surface.position(vertex));
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    });
    let t = &frame.transform;
    doubled.sum::<f64>() / 2.0 / (t[1] * t[5] - t[2] * t[4]).abs()
}

/// Says how large the outputs will be that hold a raster, and makes sure that the disk has room. `cell_bytes` tells what
/// a cell takes before compression. Of a surface, only what it covers counts.
///
/// # Errors
/// If they cannot fit, however well they are compressed.
pub(super) fn announce<F>(
    outputs: &Outputs<F>,
    cell_bytes: impl Fn(&F) -> u64,
    frame: &Frame,
    (crs, surface): (Option<&Crs>, Option<&dyn Surface>),
    talk: &Talk,
) -> Result<()> {
    let a_cell: u64 = outputs.targets.iter().map(|target| cell_bytes(&target.kind)).sum();
    let of = |cells: f64| (cells * a_cell as f64) as u64;
    let most = of(cell_count(frame));
    talk.line(format_args!("raster      {}, {} before compression", describe(frame, crs), bytes(most)));
    let Some((free, target)) = outputs.free_space().filter(|(free, _)| *free < most) else { return Ok(()) };
    let likely = surface.map_or(most, |surface| most.min(of(cells_on(surface, frame))));
    let room = format!("{} are free on the disk", bytes(free));
    if likely as f64 / BEST_COMPRESSION > free as f64 {
        return Err(Error::limit(format!("the cells with a value take {} before compression, {room}", bytes(likely)))
            .in_file(target)
            .cure("choose larger cells (--resolution), a part (--te), or another disk"));
    }
    if likely > free {
        talk.warning(format_args!("it may not fit: {} before compression, {room}", bytes(likely)));
    }
    Ok(())
}

fn placed(args: &FrameArgs, extent: Bounds, crs: Option<&Crs>, talk: &Talk) -> Result<Frame> {
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
                .cure("build the surface of points in the raster's system, or match another raster"));
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

/// `400 x 300 cells of 1 m`
pub(super) fn describe(frame: &Frame, crs: Option<&Crs>) -> String {
    let t = frame.transform;
    let (across, down) = (t[1].hypot(t[4]), t[2].hypot(t[5]));
    let units = Units::of(crs);
    let size =
        if across == down { units.length(across) } else { format!("{} by {}", number(across), units.length(down)) };
    format!("{} x {} cells of {size}", frame.width, frame.height)
}

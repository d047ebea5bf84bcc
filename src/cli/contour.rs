use super::args::ContourArgs;
use super::gather::Ground;
use super::open::{self, Heights};
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::summary::tell_place;
use super::talk::Talk;
use super::units::Units;
use super::{Exit, gather, raster};
use crate::crs::Crs;
use crate::data::{Bounds, ContourLine};
use crate::error::Result;

const FORMATS: &[Format<()>] = &[
    Format { extension: "shp", kind: (), companions: &["shx", "dbf", "prj", "cpg"] },
    Format { extension: "geojson", kind: (), companions: &[] },
    Format { extension: "json", kind: (), companions: &[] },
];

/// Height between contours unless something else is said.
const DEFAULT_INTERVAL: f64 = 1.0;

/// Draws contours of a TIN or of a DEM.
pub(super) fn run(args: &ContourArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let targets = outputs::resolve(&args.output, FORMATS, &plan.inputs)?;
    let heights = heights(args);
    let ground = gather::ground(&mut plan, talk)?;
    let crs = match &ground {
        Ground::Surface(gathered) => gathered.surface.crs().cloned(),
        Ground::Raster(grid) => grid.crs.clone(),
    };
    if args.interval.is_none() && args.levels.is_empty() {
        let height = Units::of(crs.as_ref()).height(DEFAULT_INTERVAL);
        talk.note(format_args!("contours are {height} apart (--interval)"));
    }
    let lines = match &ground {
        Ground::Surface(gathered) => open::contours_of_surface(gathered.surface.as_ref(), &heights)?,
        Ground::Raster(grid) => open::contours_of_grid(grid, &heights)?,
    };
    for target in &targets {
        open::write_contours(&target.path, &lines, crs.as_ref()).map_err(|e| e.in_file(&target.path))?;
    }
    match &ground {
        Ground::Surface(gathered) => gathered.made.tell(gathered.surface.as_ref(), talk),
        Ground::Raster(grid) => {
            talk.line(format_args!("raster      {}", raster::describe(&grid.frame, crs.as_ref())));
            tell_place(Bounds::default(), crs.as_ref(), talk);
        }
    }
    tell_lines(&lines, crs.as_ref(), talk);
    outputs::tell(&targets, talk);
    Ok(Exit::Done)
}

fn heights(args: &ContourArgs) -> Heights {
    if args.levels.is_empty() {
        return Heights::Every { interval: args.interval.unwrap_or(DEFAULT_INTERVAL), base: args.base };
    }
    let mut levels = args.levels.clone();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    Heights::These(levels)
}

fn tell_lines(lines: &[ContourLine], crs: Option<&Crs>, talk: &Talk) {
    let (Some(low), Some(high)) =
        (lines.iter().map(|line| line.level).reduce(f64::min), lines.iter().map(|line| line.level).reduce(f64::max))
    else {
        talk.warning("no contour crosses the surface at these levels");
        return;
    };
    let units = Units::of(crs);
    let closed = lines.iter().filter(|line| line.is_closed()).count();
    talk.line(format_args!(
        "contours    {} lines ({closed} closed) from {} to {}",
        lines.len(),
        units.height(low),
        units.height(high)
    ));
}

use super::args::ContourArgs;
use super::gather::Ground;
use super::open;
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::summary::tell_place;
use super::talk::Talk;
use super::{Exit, gather, raster};
use crate::crs::Crs;
use crate::error::Result;
use crate::io::contours::ContourSummary;
use crate::run::units::Units;
use crate::terrain::Levels;

pub(super) const FORMATS: &[Format<()>] = &[
    Format { extension: "shp", kind: (), companions: &["shx", "dbf", "prj", "cpg"] },
    Format { extension: "geojson", kind: (), companions: &[] },
    Format { extension: "json", kind: (), companions: &[] },
];

/// Height between contours unless something else is said.
const DEFAULT_INTERVAL: f64 = 1.0;

/// Draws contours of a TIN or of a DEM.
pub(super) fn run(args: &ContourArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let outputs = outputs::resolve_with_report(&args.output, FORMATS, &plan)?;
    let levels = levels(args)?;
    let ground = gather::ground(&mut plan, &outputs.set, talk)?;
    let crs = ground.crs();
    if args.interval.is_none() && args.levels.is_empty() {
        let height = Units::of(crs).height(DEFAULT_INTERVAL);
        talk.note(format_args!("contours are {height} apart (--interval)"));
    }
    let mut drawn = ContourSummary::default();
    for target in &outputs.targets {
        let (path, target) = (&target.path, target.within(&outputs.set));
        let written = match &ground {
            Ground::Surface(gathered) => open::contours_of_surface(target, gathered.surface.as_ref(), &levels, talk),
            Ground::Raster(grid) => open::contours_of_grid(target, grid, &levels, talk),
        };
        drawn = written?;
        drawn.warnings.iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
    }
    match &ground {
        Ground::Surface(gathered) => gathered.made.tell(gathered.surface.as_ref(), talk),
        Ground::Raster(grid) => {
            talk.line(format_args!("raster      {}", raster::describe(&grid.frame, crs)));
            tell_place(raster::extent_of(grid), crs, talk);
        }
    }
    tell_lines(&drawn, crs, talk);
    outputs.commit(talk)?;
    Ok(Exit::Done)
}

fn levels(args: &ContourArgs) -> Result<Levels> {
    match args.levels.as_slice() {
        [] => Levels::every(args.interval.unwrap_or(DEFAULT_INTERVAL), args.base),
        levels => Levels::listed(levels),
    }
}

fn tell_lines(drawn: &ContourSummary, crs: Option<&Crs>, talk: &Talk) {
    if drawn.lines == 0 {
        return talk.warning("no contour crosses the surface at these levels");
    }
    let units = Units::of(crs);
    let (low, high) = (units.height(drawn.bounds.min[2]), units.height(drawn.bounds.max[2]));
    let noun = if drawn.lines == 1 { "line" } else { "lines" };
    talk.line(format_args!("contours    {} {noun} ({} closed) from {low} to {high}", drawn.lines, drawn.closed));
}

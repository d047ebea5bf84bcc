use super::asked::Asked;
use crate::cli::input::args::ContourArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{ContourOptions, MapOptions, Smoothing, Targets, WriteRequest};

/// Returns what is asked for: the contours of a TIN or of a DEM.
pub(super) fn asked(args: &ContourArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let map = &args.map;
    let options = ContourOptions {
        interval: args.interval,
        base: args.base,
        levels: args.levels.clone(),
        map: MapOptions {
            preset: map.preset.map(Into::into),
            smooth: map
                .smooth
                .map(|given| given.map_or(Smoothing::HalfInterval, Smoothing::Within)),
            simplify: map.simplify,
            min_length: map.min_length,
            min_area: map.min_area,
            keep_depressions: map.keep_depressions,
            index_every: map.index_every,
            bands: map.bands,
            without_heights: map.two_dimensions,
            labels: map.labels_output.as_ref().map(|_| map.labels.into()),
            label_height: map.label_height,
        },
    };
    let targets = Targets {
        labels: map.labels_output.clone(),
        ..plan.driven_targets(&args.output, &args.driver)
    };
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles: args.tiles.clone(),
    })
}

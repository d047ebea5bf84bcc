//! The contours of a surface.

use std::fmt::Debug;

use super::targets::{Outputs, Target};
use super::{Keeps, Summary, TileUse, Tiles, Verb};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::Destination;
use crate::io::contours::ContourSummary;
use crate::io::formats::Product;
use crate::run::context::Context;
use crate::run::context::notice::Notice;
use crate::run::products::contour::{self, ContourOptions};
use crate::run::products::contour_map::contour_map;
use crate::run::products::surface::{Source, SurfaceProduct};

impl Verb for ContourOptions {
    fn name(&self) -> &'static str {
        "contour"
    }

    fn product(&self) -> Product {
        Product::Contours
    }

    fn check(&self) -> Result<()> {
        let levels = self.to_levels()?;
        self.map.check()?;
        self.map.to_rules(&levels).check(&levels)
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let ContourOptions {
            interval,
            base,
            levels,
            map,
        } = self;
        add(Setting::Interval, interval);
        add(Setting::Base, base);
        add(Setting::Levels, levels);
        // Only exact lines are drawn in jobs: the lists of those that began without maps stay.
        if map.is_asked_for() {
            add(Setting::Preset, map);
        }
    }

    fn use_of_tiles(&self, targets: &[Target]) -> Result<TileUse> {
        if !self.map.is_asked_for() {
            return Ok(TileUse::Optional);
        }
        let error = Error::usage("contours for maps are drawn in one piece").cure(wording![
            "without ",
            Setting::Tiles,
            ", the whole surface is in memory; for more points, draw exact contours, or those of a surface in parts that ",
            Command::Tin,
            " writes (.tins) or of a simplified one"
        ]);
        Ok(TileUse::Never(match targets {
            [target, ..] => error.in_file(&target.path),
            [] => error,
        }))
    }

    fn takes(&self, _source: &Source) -> Result<()> {
        Ok(())
    }

    fn write(
        &self,
        surface: &SurfaceProduct,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        if self.map.is_asked_for() {
            return write_map(surface, self, outputs, context);
        }
        let contours = contour::contour(surface, self, context)?;
        write_all(outputs, context, |target| contours.write(target, context))
    }

    fn keeps(&self) -> Keeps<'_> {
        Keeps::Contours(self)
    }

    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        write_all(outputs, context, |target| {
            tiles.write_contours(self, target, context)
        })
    }
}

fn write_map(
    surface: &SurfaceProduct,
    options: &ContourOptions,
    outputs: &Outputs,
    context: &Context,
) -> Result<Summary> {
    let map = contour_map(surface, options, context)?;
    for target in &outputs.targets {
        map.write(target.within(&outputs.set), context)?;
    }
    if let Some(target) = &outputs.labels {
        map.write_labels(target.within(&outputs.set), context)?;
    }
    Ok(Summary::Map(map.summary()))
}

fn write_all(
    outputs: &Outputs,
    context: &Context,
    write: impl Fn(Destination) -> Result<ContourSummary>,
) -> Result<Summary> {
    let mut drawn = ContourSummary::default();
    for target in &outputs.targets {
        drawn = write(target.within(&outputs.set))?;
        let warning = |text: &String| Notice::Reader(target.path.clone(), text.as_str().into());
        drawn
            .warnings
            .iter()
            .for_each(|text| context.monitor.notice(&warning(text)));
    }
    Ok(Summary::Contours(drawn))
}

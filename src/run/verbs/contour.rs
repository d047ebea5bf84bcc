//! The contours of a surface.

use std::fmt::Debug;

use super::targets::{Outputs, Target};
use super::{Keeps, Summary, TileUse, Tiles, Verb};
use crate::error::{Error, Result, Setting, wording};
use crate::io::contours::{self, ContourSummary};
use crate::io::formats::Product;
use crate::io::{Destination, gdal};
use crate::run::context::Context;
use crate::run::context::notice::Notice;
use crate::run::products::contour::{ContourOptions, contour};
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
        // Only what is given, so that jobs that began before there were maps keep their lists.
        map.list(add);
    }

    fn use_of_tiles(&self, targets: &[Target]) -> Result<TileUse> {
        if let Some(table) = targets.iter().find(|of| gdal::is_connection(&of.path)) {
            let error = "a job keeps track of its files, and a table of a database is not a file";
            let error = Error::usage(error).in_file(&table.path);
            return Ok(TileUse::Never(
                error.cure(wording!["write a file, or leave out ", Setting::Tiles]),
            ));
        }
        if self.map.bands {
            targets.iter().try_for_each(|of| {
                let target = Destination::from(&of.path).in_format(of.extension);
                contours::require_areas(target.by_driver(of.driver.as_ref()))
            })?;
        }
        Ok(TileUse::Optional)
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
        let contours = contour(surface, self, context)?;
        write_all(outputs, context, |target| contours.write(target, context))
    }

    fn keeps(&self) -> Keeps<'_> {
        match self.map.is_asked_for() {
            true => Keeps::Triangles,
            false => Keeps::Contours(self),
        }
    }

    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        if self.map.is_asked_for() {
            return write_map(&tiles.surface(context)?, self, outputs, context);
        }
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
    let labels = outputs.labels.as_ref();
    let has_labels = |target: &Target| labels.is_some_and(|labels| labels.path == target.path);
    for target in &outputs.targets {
        let within = target.within(&outputs.set);
        match has_labels(target) {
            true => map.write_with_labels(within, context)?,
            false => map.write(within, context)?,
        }
    }
    if let Some(target) = labels.filter(|_| !outputs.targets.iter().any(has_labels)) {
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

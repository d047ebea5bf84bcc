//! The contours of a surface.

use std::fmt::Debug;

use super::targets::Outputs;
use super::{Keeps, Summary, Tiles, Verb};
use crate::error::{Result, Setting};
use crate::io::Destination;
use crate::io::contours::ContourSummary;
use crate::io::formats::Product;
use crate::run::context::Context;
use crate::run::context::notice::Notice;
use crate::run::products::contour::{self, ContourOptions};
use crate::run::products::surface::{self, SurfaceProduct, SurfaceRequest};

impl Verb for ContourOptions {
    fn name(&self) -> &'static str {
        "contour"
    }

    fn product(&self) -> Product {
        Product::Contours
    }

    fn check(&self) -> Result<()> {
        self.to_levels().map(drop)
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let ContourOptions {
            interval,
            base,
            levels,
        } = self;
        add(Setting::Interval, interval);
        add(Setting::Base, base);
        add(Setting::Levels, levels);
    }

    fn surface(&self, request: &SurfaceRequest, context: &Context) -> Result<SurfaceProduct> {
        surface::surface(request, context)
    }

    fn write(
        &self,
        surface: &SurfaceProduct,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
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

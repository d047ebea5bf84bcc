//! The shades of a surface in the cells of a raster or a picture.

use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::Arc;

use super::raster::{is_picture, list_frame, write_drawn};
use super::targets::{Outputs, Target};
use super::{Keeps, Summary, Tiles, Verb};
use crate::error::{Result, Setting};
use crate::io::formats::Product;
use crate::run::context::{Context, Journal};
use crate::run::products::cells::{self, CellProduct, HillshadeOptions, LightOptions};
use crate::run::products::surface::{Source, SurfaceProduct};
use crate::terrain::Method;

impl Verb for HillshadeOptions {
    fn name(&self) -> &'static str {
        "hillshade"
    }

    fn product(&self) -> Product {
        Product::Shades
    }

    fn check(&self) -> Result<()> {
        self.light.check()
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let HillshadeOptions {
            frame,
            method,
            light:
                LightOptions {
                    shading,
                    azimuth,
                    altitude,
                    z_factor,
                },
        } = self;
        list_frame(frame, add);
        add(Setting::Method, method);
        add(Setting::Shading, shading);
        add(Setting::Azimuth, azimuth);
        add(Setting::Altitude, altitude);
        add(Setting::ZFactor, z_factor);
    }

    fn method(&self) -> Method {
        self.method
    }

    fn also_reads(&self) -> Option<&PathBuf> {
        self.frame.align_to.as_ref()
    }

    fn reading(&self, file: PathBuf) -> Option<Arc<dyn Verb>> {
        Some(Arc::new(HillshadeOptions {
            frame: self.frame.aligned_to(file),
            ..self.clone()
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
        let cells = cells::hillshade(surface, self, context)?;
        write_drawn(&cells, outputs, cell_bytes, context)
    }

    fn keeps(&self) -> Keeps<'_> {
        Keeps::Heights(&self.frame)
    }

    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        let heights = tiles.heights(&self.frame, context)?;
        let crs = heights.crs().cloned();
        let journal = Journal::new(context);
        let cells = CellProduct::shades_of(heights, &self.light, crs.as_ref(), &journal)?
            .with_overviews(self.frame.overviews);
        write_drawn(&cells, outputs, cell_bytes, context)
    }
}

/// Returns the bytes of a cell before compression.
fn cell_bytes(target: &Target) -> u64 {
    // A picture has gray and alpha.
    if is_picture(target) { 2 } else { 1 }
}

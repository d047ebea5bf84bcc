//! The heights of a surface in colors.

use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::Arc;

use super::raster::{list_frame, write_drawn};
use super::targets::{Outputs, Target};
use super::{Keeps, Summary, Tiles, Verb};
use crate::error::{Result, Setting};
use crate::io::formats::Product;
use crate::run::context::{Context, Journal};
use crate::run::products::relief::{self, ColorReliefOptions};
use crate::run::products::surface::{Source, SurfaceProduct};
use crate::terrain::Method;

impl Verb for ColorReliefOptions {
    fn name(&self) -> &'static str {
        "color-relief"
    }

    fn product(&self) -> Product {
        Product::Colors
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let ColorReliefOptions {
            ramp,
            matching,
            frame,
            method,
        } = self;
        list_frame(frame, add);
        add(Setting::Method, method);
        add(Setting::Ramp, &ramp.stops);
        add(Setting::Match, matching);
    }

    fn method(&self) -> Method {
        self.method
    }

    fn also_reads(&self) -> Option<&PathBuf> {
        self.frame.align_to.as_ref()
    }

    fn reading(&self, file: PathBuf) -> Option<Arc<dyn Verb>> {
        Some(Arc::new(ColorReliefOptions {
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
        let cells = relief::color_relief(surface, self, context)?;
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
        let cells = relief::colors_of(heights, self, &Journal::new(context))?;
        write_drawn(&cells, outputs, cell_bytes, context)
    }
}

/// Returns the bytes of a cell before compression.
fn cell_bytes(_target: &Target) -> u64 {
    4
}

//! The heights of a surface in the cells of a raster.

use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::Arc;

use super::raster::{list_frame, write_numbers};
use super::targets::Outputs;
use super::{Keeps, Summary, Tiles, Verb};
use crate::error::{Result, Setting};
use crate::io::formats::Product;
use crate::run::context::Context;
use crate::run::products::cells::{self, CellProduct, DemOptions};
use crate::run::products::surface::SurfaceProduct;
use crate::terrain::Method;

impl Verb for DemOptions {
    fn name(&self) -> &'static str {
        "dem"
    }

    fn product(&self) -> Product {
        Product::Heights
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let DemOptions { frame, method } = self;
        list_frame(frame, add);
        add(Setting::Method, method);
    }

    fn method(&self) -> Method {
        self.method
    }

    fn also_reads(&self) -> Option<&PathBuf> {
        self.frame.align_to.as_ref()
    }

    fn reading(&self, file: PathBuf) -> Option<Arc<dyn Verb>> {
        Some(Arc::new(DemOptions {
            frame: self.frame.aligned_to(file),
            ..self.clone()
        }))
    }

    fn write(
        &self,
        surface: &SurfaceProduct,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        let cells = cells::dem(surface, self, context)?;
        Ok(Summary::Heights(write_numbers(&cells, outputs, context)?))
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
        let cells = CellProduct::heights_of(heights).with_overviews(self.frame.overviews);
        Ok(Summary::Heights(write_numbers(&cells, outputs, context)?))
    }
}

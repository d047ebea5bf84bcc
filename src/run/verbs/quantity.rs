//! Quantities in cells: slope, aspect, curvature, roughness.

use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::Arc;

use super::raster::{list_frame, write_numbers};
use super::targets::Outputs;
use super::{Keeps, Summary, Tiles, Verb};
use crate::error::{Result, Setting};
use crate::io::formats::Product;
use crate::run::context::{Context, Journal};
use crate::run::products::cells::{self, CellProduct, QuantityOptions};
use crate::run::products::surface::{Source, SurfaceProduct};
use crate::terrain::{Method, Quantity};

impl Verb for QuantityOptions {
    fn name(&self) -> &'static str {
        self.quantity.name()
    }

    fn product(&self) -> Product {
        Product::Heights
    }

    fn check(&self) -> Result<()> {
        QuantityOptions::check(self)
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let QuantityOptions {
            quantity,
            frame,
            method,
            z_factor,
        } = self;
        list_frame(frame, add);
        add(Setting::Method, method);
        add(
            Setting::Percent,
            &matches!(quantity, Quantity::SlopePercent(_)),
        );
        add(Setting::Formula, quantity);
        add(Setting::ZFactor, z_factor);
    }

    fn method(&self) -> Method {
        self.method
    }

    fn also_reads(&self) -> Option<&PathBuf> {
        self.frame.align_to.as_ref()
    }

    fn reading(&self, file: PathBuf) -> Option<Arc<dyn Verb>> {
        Some(Arc::new(QuantityOptions {
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
        let cells = cells::quantity(surface, self, context)?;
        let written = write_numbers(&cells, outputs, context)?;
        Ok(Summary::Quantity(self.quantity, written))
    }

    fn keeps(&self) -> Keeps<'_> {
        match self.is_of_faces() {
            true => Keeps::Gradients(&self.frame),
            false => Keeps::Heights(&self.frame),
        }
    }

    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        let journal = Journal::new(context);
        let cells = if self.is_of_faces() {
            let gradients = tiles.gradients(&self.frame, context)?;
            let crs = gradients.crs().cloned();
            CellProduct::face_slopes_of(gradients, self, crs.as_ref(), &journal)?
        } else {
            let heights = tiles.heights(&self.frame, context)?;
            let crs = heights.crs().cloned();
            CellProduct::quantity_of(heights, self, crs.as_ref(), &journal)?
        };
        let written = write_numbers(&cells, outputs, context)?;
        Ok(Summary::Quantity(self.quantity, written))
    }
}

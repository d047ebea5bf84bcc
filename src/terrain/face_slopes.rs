//! Slope and aspect of faces, in cells.

use super::face_gradient::slope_and_aspect;
use super::focal::{Gradient, Quantity};
use super::rasterize::GradientSource;
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Window};
use crate::error::{Error, Result};

/// The slope or the aspect of the faces of a surface, in cells: that of a
/// [`Sample`](super::Sample) at the center of each.
#[derive(Debug)]
pub struct FaceSlopes<S> {
    source: S,
    quantity: Quantity,
    z_factor: f64,
    x_scale: f64,
}

impl<S: GradientSource> FaceSlopes<S> {
    /// Creates the raster of a quantity by [`Gradient::Faces`]. `z_factor` are the units of y per
    /// unit of z, `x_scale` those per unit of x.
    ///
    /// # Errors
    /// If the quantity is not one of faces.
    pub fn of(source: S, quantity: Quantity, z_factor: f64, x_scale: f64) -> Result<Self> {
        if quantity.gradient() != Some(Gradient::Faces) {
            let name = quantity.name();
            return Err(Error::usage(format!(
                "{name} is computed from cells here, not from faces"
            )));
        }
        Ok(FaceSlopes {
            source,
            quantity,
            z_factor,
            x_scale,
        })
    }

    fn value(&self, gradient: [f64; 2]) -> f32 {
        // A triangle without area has no slope.
        if !gradient.iter().all(|rise| rise.is_finite()) {
            return f32::NAN;
        }
        let [slope, aspect] = slope_and_aspect(gradient, self.z_factor, self.x_scale);
        let value = match self.quantity {
            Quantity::SlopePercent(_) => 100.0 * slope,
            Quantity::Aspect(_) => aspect,
            _ => slope.atan().to_degrees(),
        };
        value as f32
    }
}

impl<S: GradientSource> BlockSource for FaceSlopes<S> {
    fn frame(&self) -> Frame {
        self.source.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        let mut gradients = vec![[f64::NAN; 2]; out.len()];
        self.source.gradients(window, &mut gradients)?;
        for (cell, gradient) in out.iter_mut().zip(gradients) {
            *cell = self.value(gradient);
        }
        Ok(())
    }
}

//! Surfaces together with a layer.

use std::path::Path;

use super::surface::SurfaceProduct;
use crate::crs::Crs;
use crate::data::Layer;
use crate::error::Result;
use crate::run::context::Journal;
use crate::run::sources::systems::{self, Stated, SystemOptions};

/// Returns the coordinate system of surfaces and a layer, if any states one. `assign` is that of
/// the layer, whatever it states.
///
/// # Errors
/// If they differ.
pub(crate) fn common_system<'a>(
    surfaces: impl Iterator<Item = (&'a Path, &'a SurfaceProduct)>,
    (path, layer): (&Path, &Layer),
    assign: Option<&Crs>,
    journal: &Journal,
) -> Result<Option<Crs>> {
    let of_layer = Stated::by_layer(path, layer).assigned(assign, journal);
    let of_surfaces = surfaces.map(|(name, product)| product.stated(name));
    let stated: Vec<Stated> = of_surfaces.chain([of_layer]).collect();
    Ok(systems::unify(&stated, &SystemOptions::default(), journal)?.crs)
}

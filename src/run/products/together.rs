//! Surfaces together with a layer.

use std::path::{Path, PathBuf};

use super::surface::SurfaceProduct;
use crate::crs::Crs;
use crate::data::Layer;
use crate::error::{Error, Result};
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

/// What helps if two inputs have nothing in common.
pub(super) const COMPARE_EXTENTS: &str =
    "both have to be in one coordinate system and in one area: compare their extents";

/// Returns the error for two surfaces without a common position.
#[cold]
pub(super) fn no_overlap(names: &[PathBuf; 2]) -> Error {
    let [one, other] = names.each_ref().map(|name| name.display());
    Error::usage(format!("{one} and {other} do not overlap")).cure(COMPARE_EXTENTS)
}

//! The surface itself: as a mesh, or as a TIN in parts.

use std::fmt::Debug;
use std::path::Path;

use super::targets::{Outputs, Target};
use super::{Keeps, Summary, TileUse, Tiles, Verb};
use crate::error::{Error, Result, Setting};
use crate::io::formats::{self, Product};
use crate::run::context::Context;
use crate::run::products::surface::{self, SurfaceProduct};

/// Options of writing a surface: there are none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct SurfaceOptions;

impl Verb for SurfaceOptions {
    fn name(&self) -> &'static str {
        "tin"
    }

    fn product(&self) -> Product {
        Product::Surface
    }

    fn list(&self, _add: &mut dyn FnMut(Setting, &dyn Debug)) {}

    fn use_of_tiles(&self, targets: &[Target]) -> Result<TileUse> {
        let in_parts = targets.iter().find(|target| is_in_parts(&target.path));
        match (in_parts, targets) {
            (Some(target), [_, _, ..]) => Err(Error::usage("a TIN in parts is written alone")
                .in_file(&target.path)
                .cure("write the others from it afterwards")),
            // Parts are those of tiles, even if all would fit into memory.
            (Some(_), _) => Ok(TileUse::Always),
            (None, targets) => {
                let error = Error::usage("tiles make a TIN in parts").cure("name the output .tins");
                Ok(TileUse::Never(match targets {
                    [target, ..] => error.in_file(&target.path),
                    [] => error,
                }))
            }
        }
    }

    fn write(
        &self,
        surface: &SurfaceProduct,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        let triangles = surface.triangles()?;
        let write = |target: &Target| {
            let written = surface::write_mesh(triangles, target.within(&outputs.set), context)?;
            Ok((target.path.clone(), written))
        };
        outputs
            .targets
            .iter()
            .map(write)
            .collect::<Result<_>>()
            .map(Summary::Meshes)
    }

    fn keeps(&self) -> Keeps<'_> {
        Keeps::Triangles
    }

    fn write_tiles(
        &self,
        tiles: &dyn Tiles,
        outputs: &Outputs,
        context: &Context,
    ) -> Result<Summary> {
        let [target] = &outputs.targets[..] else {
            return Err(Error::usage("a TIN in parts is written alone"));
        };
        tiles
            .write_parts(target.within(&outputs.set), context)
            .map(|parts| Summary::Parts(Box::new(parts)))
    }
}

fn is_in_parts(path: &Path) -> bool {
    formats::of_name(path).is_some_and(|format| format.extensions.contains(&"tins"))
}

//! The surface itself: as a mesh, or as a TIN in parts.

use std::fmt::Debug;
use std::path::Path;

use super::targets::{Outputs, Target};
use super::{Keeps, Summary, TileUse, Tiles, Verb};
use crate::data::{Surface, WithoutLines};
use crate::error::{Error, Result, Setting, wording};
use crate::io::Destination;
use crate::io::formats::{self, Product};
use crate::io::mesh::MeshSummary;
use crate::run::context::Context;
use crate::run::products::simplified::simplify;
use crate::run::products::surface::{self, Source, SurfaceProduct};
use crate::terrain::SimplifyRule;

/// Options of writing a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SurfaceOptions {
    /// What files say of the edges.
    pub edges: WrittenEdges,
    /// How far the surface is simplified before; not at all if it is `None`. A raster has to be.
    #[serde(default)]
    pub simplify: Option<SimplifyRule>,
}

/// What a file says of the edges of a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum WrittenEdges {
    /// Which of them are on lines, if its format can say so.
    #[default]
    WithLines,
    /// Nothing: some programs do not read a PLY that has more than vertices and triangles.
    Plain,
}

impl WrittenEdges {
    /// Writes a surface as a mesh.
    ///
    /// # Errors
    /// Those of [`write_mesh`](surface::write_mesh), and if the format cannot leave lines out.
    pub fn write(
        self,
        surface: &dyn Surface,
        target: Destination,
        context: &Context,
    ) -> Result<MeshSummary> {
        match self {
            WrittenEdges::WithLines => surface::write_mesh(surface, target, context),
            WrittenEdges::Plain => surface::write_mesh(&WithoutLines(surface), target, context),
        }
    }
}

impl Verb for SurfaceOptions {
    fn name(&self) -> &'static str {
        "tin"
    }

    fn product(&self) -> Product {
        Product::Surface
    }

    fn check(&self) -> Result<()> {
        self.simplify.as_ref().map_or(Ok(()), SimplifyRule::check)
    }

    fn list(&self, add: &mut dyn FnMut(Setting, &dyn Debug)) {
        let SurfaceOptions { edges, simplify } = self;
        add(Setting::Plain, edges);
        // Jobs do not simplify: those of today have the same list as those before.
        if let Some(SimplifyRule {
            limit,
            line_tolerance,
        }) = simplify
        {
            add(Setting::MaxError, limit);
            add(Setting::LineTolerance, line_tolerance);
        }
    }

    fn takes(&self, source: &Source) -> Result<()> {
        match source {
            Source::Raster(path) if self.simplify.is_none() => Err(Error::usage(
                "a raster is simplified when it becomes a TIN, and no limit is given",
            )
            .in_file(path)
            .cure(wording![
                "pass ",
                Setting::MaxError.number("HEIGHT"),
                " or ",
                Setting::Target.number("N")
            ])),
            _ => Ok(()),
        }
    }

    fn instead_of(
        &self,
        given: &SurfaceProduct,
        context: &Context,
    ) -> Result<Option<SurfaceProduct>> {
        let simplified = |rule| simplify(given, rule, context);
        self.simplify.as_ref().map(simplified).transpose()
    }

    fn use_of_tiles(&self, targets: &[Target]) -> Result<TileUse> {
        if self.simplify.is_some() {
            let error = Error::usage("a surface is simplified in one piece")
                .cure(wording!["write part by part, with ", Setting::Bounds]);
            return match targets.iter().find(|target| is_in_parts(&target.path)) {
                Some(target) => Err(error.in_file(&target.path)),
                None => Ok(TileUse::Never(error)),
            };
        }
        let in_parts = targets.iter().find(|target| is_in_parts(&target.path));
        match (in_parts, targets) {
            (Some(target), [_, _, ..]) => Err(Error::usage("a TIN in parts is written alone")
                .in_file(&target.path)
                .cure("write the others from it afterwards")),
            // Parts are those of tiles, even if all would fit into memory.
            (Some(target), _) => match self.edges {
                WrittenEdges::WithLines => Ok(TileUse::Always),
                WrittenEdges::Plain => Err(Error::usage("a TIN in parts keeps its lines")
                    .in_file(&target.path)
                    .cure(wording!["leave ", Setting::Plain, " out"])),
            },
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
            let written = self
                .edges
                .write(triangles, target.within(&outputs.set), context)?;
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

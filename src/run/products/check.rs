//! Flaws of a surface and their positions.

use std::fmt;
use std::path::Path;

use super::overlaps::{Overlap, overlaps};
use super::surface::{self, Model, Source, SurfaceProduct, SurfaceRequest};
use crate::data::{LinkFlaw, Mesh, Surface, Triangles};
use crate::error::Result;
use crate::run::context::notice::Notice;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Stage};
use crate::run::sources::open;
use crate::run::sources::systems::{Degrees, SystemOptions};
use crate::terrain::{self, SurfaceFlaw};

/// A flaw of a surface and its position.
#[derive(Debug, Clone, PartialEq)]
pub struct LocatedFlaw {
    /// What is wrong.
    pub flaw: FlawKind,
    /// The vertices concerned, in plan; may be empty.
    pub at: Vec<[f64; 2]>,
}

/// What is wrong with a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FlawKind {
    /// Faces and edges that cannot be linked.
    Link(LinkFlaw),
    /// A law that faces break.
    Surface(SurfaceFlaw),
    /// Faces that overlap.
    Overlap(Overlap),
}

impl fmt::Display for FlawKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FlawKind::Link(flaw) => flaw.fmt(f),
            FlawKind::Surface(flaw) => flaw.fmt(f),
            FlawKind::Overlap(flaw) => flaw.fmt(f),
        }
    }
}

/// Formats the flaw as `face 3: clockwise, at (0 0) (1 0) (0 1)`.
impl fmt::Display for LocatedFlaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.flaw.fmt(f)?;
        for (i, [x, y]) in self.at.iter().enumerate() {
            let before = if i == 0 { ", at " } else { " " };
            write!(f, "{before}({x} {y})")?;
        }
        Ok(())
    }
}

/// A surface, and all its flaws.
#[derive(Debug)]
#[non_exhaustive]
pub struct CheckProduct {
    /// The surface; a mesh is linked where possible.
    pub product: SurfaceProduct,
    /// Its flaws; empty if it is correct.
    pub flaws: Vec<LocatedFlaw>,
}

/// Checks a surface: links between faces, orientation, overlaps, and the Delaunay law between
/// lines. Coordinates in degrees are allowed, since no lengths are checked.
///
/// # Errors
/// Those of [`triangles`](surface::triangles), except for a mesh that is not a surface; and if the
/// file of a TIN is damaged.
pub fn check(request: &SurfaceRequest, context: &Context) -> Result<CheckProduct> {
    let systems = SystemOptions {
        degrees: Degrees::Allow,
        ..request.systems.clone()
    };
    if let Source::Mesh(path) = &request.source
        && !open::is_tin(path)
    {
        return check_mesh(path, &systems, context);
    }
    let product = surface::triangles(
        &SurfaceRequest {
            source: request.source.clone(),
            systems,
        },
        context,
    )?;
    let flaws = surface_flaws(&product, context)?;
    Ok(CheckProduct { product, flaws })
}

/// Returns the flaws of a surface that is built or read already, as [`check`] finds them. Of a mesh
/// without lines, edges that are not Delaunay are among them.
///
/// # Errors
/// If the surface is a raster, the file of a TIN is damaged, or the run is canceled.
pub fn surface_flaws(product: &SurfaceProduct, context: &Context) -> Result<Vec<LocatedFlaw>> {
    match &product.model {
        Model::Compact(tin) => tin.check()?,
        Model::Parts(parts) => parts.check()?,
        Model::Tin(_) | Model::Mesh(_) | Model::Raster(_) | Model::RasterFile(_) => {}
    }
    let watched = checked(product.triangles()?, context)?;
    let flaws = flaws_beside(&[], &terrain::surface_flaws(&watched), &watched);
    watched.end()?;
    Ok(flaws)
}

fn check_mesh(path: &Path, systems: &SystemOptions, context: &Context) -> Result<CheckProduct> {
    let journal = Journal::new(context);
    let keeps_lines = open::keeps_lines(path);
    if !keeps_lines {
        journal.add(Notice::DelaunayUnchecked(path.to_path_buf()));
    }
    // The Delaunay law cannot be checked without the lines.
    let find = if keeps_lines {
        terrain::surface_flaws
    } else {
        terrain::shape_flaws
    };
    let triangles = open::mesh_triangles(path, &journal)?;
    let (mesh, flaws) = flaws_by(find, triangles, context).map_err(|e| e.in_file(path))?;
    let model = surface::mesh_model(path, mesh, systems, &journal)?;
    Ok(CheckProduct {
        product: SurfaceProduct {
            model,
            built: None,
            notices: journal.take(),
        },
        flaws,
    })
}

/// Returns the first flaw of triangles in memory.
pub(crate) fn first_flaw(triangles: Triangles, context: &Context) -> Result<Option<LocatedFlaw>> {
    Ok(flaws_by(terrain::surface_flaws, triangles, context)?
        .1
        .into_iter()
        .next())
}

fn flaws_by(
    find: fn(&dyn Surface) -> Vec<SurfaceFlaw>,
    triangles: Triangles,
    context: &Context,
) -> Result<(Mesh, Vec<LocatedFlaw>)> {
    let (mesh, links) = Mesh::link(triangles)?;
    let of_link = |flaw: &LinkFlaw| located(FlawKind::Link(*flaw), &flaw.vertices(&mesh), &mesh);
    let mut flaws: Vec<LocatedFlaw> = links.iter().map(of_link).collect();
    let watched = checked(&mesh as &dyn Surface, context)?;
    flaws.extend(flaws_beside(&links, &find(&watched), &watched));
    watched.end()?;
    Ok((mesh, flaws))
}

/// Returns the surface with progress, for a check that visits its faces once for each of seven laws
/// and once for overlaps.
fn checked<'a>(
    surface: &'a dyn Surface,
    context: &Context<'a>,
) -> Result<Watched<'a, dyn Surface + 'a>> {
    Watched::faces(surface, 8, Stage::CheckingFaces, context)
}

/// Returns the flaws that were found, and overlaps if these are defined: if faces are linked and
/// counter-clockwise.
fn flaws_beside(
    links: &[LinkFlaw],
    found: &[SurfaceFlaw],
    surface: &dyn Surface,
) -> Vec<LocatedFlaw> {
    let of_surface =
        |flaw: &SurfaceFlaw| located(FlawKind::Surface(*flaw), &flaw.vertices(surface), surface);
    let mut flaws: Vec<LocatedFlaw> = found.iter().map(of_surface).collect();
    let is_folded = links
        .iter()
        .any(|flaw| matches!(flaw, LinkFlaw::Folded { .. }));
    let is_harmless = |flaw: &SurfaceFlaw| {
        use SurfaceFlaw::{Crack, Kinds, NotDelaunay, TwoHeights};
        matches!(
            flaw,
            TwoHeights(_) | Crack { .. } | Kinds(..) | NotDelaunay(..)
        )
    };
    if !is_folded && found.iter().all(is_harmless) {
        let of_overlap =
            |flaw: &Overlap| located(FlawKind::Overlap(*flaw), &flaw.vertices(surface), surface);
        flaws.extend(overlaps(surface).iter().map(of_overlap));
    }
    flaws
}

fn located(flaw: FlawKind, vertices: &[u32], surface: &dyn Surface) -> LocatedFlaw {
    let there = vertices
        .iter()
        .filter(|&&v| (v as usize) < surface.vertex_count());
    let at = there
        .map(|&v| surface.position(v))
        .map(|[x, y, _]| [x, y])
        .collect();
    LocatedFlaw { flaw, at }
}

//! Surfaces of fewer vertices, from points, triangles or a raster.

use std::borrow::Cow;

use super::surface::{Model, SurfaceProduct};
use super::tin::BuildReport;
use crate::crs::Crs;
use crate::data::{Grid, Surface};
use crate::error::{Command, Error, Kind, Result, Setting, wording};
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::terrain::{SimplifyReport, SimplifyRule, Tin, TinReport, simplify_cells};

/// Simplifies a surface, also that of a raster. The report of building it has the counts of the
/// simplified surface, and there is a [`Notice::Simplified`].
///
/// # Errors
/// Those of [`simplify`](crate::terrain::simplify()) and [`simplify_cells`], and if a raster in its
/// file is damaged.
///
/// # Complexity
/// That of [`simplify`](crate::terrain::simplify()).
pub fn simplify(
    product: &SurfaceProduct,
    rule: &SimplifyRule,
    context: &Context,
) -> Result<SurfaceProduct> {
    let journal = Journal::new(context);
    let work = journal.start(Stage::Simplifying, Size::Uncounted)?;
    let (tin, report) = of_model(product, rule, context)?;
    work.end()?;
    journal.add(notice(&report, Surface::crs(&tin)));
    let built = product.built.as_deref().map(|built| {
        let TinReport {
            edges,
            vertices,
            triangles,
            extent,
            ..
        } = tin.report().clone();
        Box::new(BuildReport {
            tin: TinReport {
                edges,
                vertices,
                triangles,
                extent,
                ..built.tin.clone()
            },
            ..built.clone()
        })
    });
    let mut notices = product.notices.clone();
    notices.extend(journal.take());
    Ok(SurfaceProduct {
        model: Model::Tin(Box::new(tin)),
        built,
        notices,
    })
}

fn of_model(
    product: &SurfaceProduct,
    rule: &SimplifyRule,
    context: &Context,
) -> Result<(Tin, SimplifyReport)> {
    let grid = match &product.model {
        Model::Raster(grid) => Cow::Borrowed(grid.as_ref()),
        Model::RasterFile(file) => Cow::Owned(Grid::collect(&file.cells())?),
        Model::Parts(_) => {
            let joined = product.triangles().map_err(in_memory_only)?;
            return crate::terrain::simplify(joined, rule, context.cancel);
        }
        _ => return crate::terrain::simplify(product.triangles()?, rule, context.cancel),
    };
    simplify_cells(&grid, rule, context.cancel)
}

/// Adds a cure if the parts of a surface do not fit into memory together.
#[cold]
fn in_memory_only(error: Error) -> Error {
    match error.kind() {
        Kind::Limit => error.cure(wording![
            "a surface is simplified in one piece: build it of fewer points (",
            Setting::Bounds,
            "), which ",
            Command::Points,
            " can also thin"
        ]),
        _ => error,
    }
}

fn notice(report: &SimplifyReport, crs: Option<&Crs>) -> Notice {
    let units = Units::of(crs);
    Notice::Simplified {
        vertices: report.vertices,
        heights: report.sites,
        bound: units.height(report.bound),
        largest: units.height(report.largest),
        root_mean_square: units.height(report.root_mean_square),
        line_vertices: report.line_vertices,
    }
}

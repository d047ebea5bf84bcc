//! Surfaces that verbs ask: in memory, or in files if they would not fit.

use super::context::large_files::folder_of_large_files;
use super::context::memory;
use super::context::notice::Notice;
use super::context::{Context, Journal};
use super::job::{NotInTiles, TileOptions};
use super::products::surface::{Model, SurfaceProduct, SurfaceRequest, surface_for};
use super::sources::open;
use super::verbs::targets::Targets;
use super::verbs::{SurfaceOptions, WriteRequest};
use super::write::{self, WriteReport, Written, WrittenOf};
use crate::error::{Error, Kind, Result};
use crate::io::Temporary;
use crate::terrain::Method;

/// Builds or reads a surface, for heights by a method. Points that would need more than `memory`
/// bytes, half of the free memory if it is `None`, become a TIN in parts first, in tiles. It is
/// used in its files, in a folder that is removed with the surface. What verbs make of it is the
/// same as of a surface in memory, byte for byte.
///
/// The folder is created in the one that the environment names as `TMPDIR`, else in `/var/tmp`.
/// It takes about 200 bytes for each point.
///
/// # Errors
/// Those of [`surface_for`] and [`write()`](super::write()), and if the folder cannot be created.
///
/// ```
/// use breakline::run::{self, Context, Model, Source, SurfaceRequest};
/// use breakline::terrain::Method;
///
/// let source = Source::of_files(&["fixtures/valley.laz".into()])?;
/// let request = SurfaceRequest { source, ..SurfaceRequest::default() };
/// let surface = run::open_surface(&request, Method::Linear, Some(1_000_000), &Context::default())?;
/// assert!(matches!(surface.model, Model::Parts(_)));
/// # Ok::<(), breakline::Error>(())
/// ```
pub fn open_surface(
    request: &SurfaceRequest,
    method: Method,
    memory: Option<u64>,
    context: &Context,
) -> Result<SurfaceProduct> {
    let in_parts = WriteRequest::new(request.clone(), SurfaceOptions::default());
    let is_larger = match method {
        Method::Linear => write::is_larger(&in_parts, memory, context),
        _ => write::without_tiles(memory, &NotInTiles::Method.into(), context),
    };
    match is_larger {
        true => in_files(&in_parts, memory, context),
        false => surface_for(method, request, context),
    }
}

/// Writes points as a TIN in parts that is there as long as the result.
fn in_files(
    request: &WriteRequest,
    memory: Option<u64>,
    context: &Context,
) -> Result<SurfaceProduct> {
    let journal = Journal::new(context);
    let parent = folder_of_large_files();
    let elsewhere = "name a folder for large files with the environment variable TMPDIR";
    let folder = Temporary::folder_in(&parent)
        .map_err(|e| Error::from(e).in_file(&parent).cure(elsewhere))?;
    journal.add(Notice::BuiltInFiles {
        memory: memory.unwrap_or_else(memory::half_of_free),
        folder: folder.path().to_path_buf(),
    });
    let index = folder.path().join("surface.tins");
    let options = TileOptions {
        memory,
        ..TileOptions::default()
    };
    let report = write::for_a_while(request, &Targets::of(&index), &options, context);
    // The cures of a job name options that choose its folder and its cells.
    let report = report.map_err(|e| {
        let is_of_folder = e.path().is_some_and(|path| path.starts_with(&parent));
        let is_full = matches!(e.kind(), Kind::Limit | Kind::Io);
        if is_of_folder && is_full {
            e.cure(elsewhere)
        } else {
            e
        }
    })?;
    let parts = open::owned_parts(&index, folder)?;
    let mut notices = journal.take();
    if let WriteReport::Written(written) = report
        && let Written {
            surface: WrittenOf::Tiles { report, .. },
            ..
        } = *written
    {
        notices.extend(report.notices);
    }
    Ok(SurfaceProduct {
        model: Model::Parts(Box::new(parts)),
        built: None,
        notices,
    })
}

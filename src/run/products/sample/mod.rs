//! Heights, slopes and gradients of a surface at points, added to these.

mod options;
mod source;
mod values;

use std::path::Path;

pub use self::options::{SampleOptions, SampleTarget, SampledField};
use self::source::Source;
pub(super) use self::values::none_inside;
use self::values::{Sampling, Values};
use super::surface::SurfaceProduct;
use crate::crs::Crs;
use crate::data::Columns;
use crate::error::Result;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::sources::systems::{self, SystemOptions};

/// Positions that are sampled before the run may be canceled.
const AT_ONCE: usize = 1 << 20;

/// Counts of sampled points.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct SampleReport {
    /// The points that were read.
    pub points: u64,
    /// Those of them that are not on the surface: what is added to them is empty.
    pub outside: u64,
    /// The columns of x and y, if the points are text.
    pub read: Option<Columns>,
    /// The names of the columns that were added.
    pub columns: Vec<String>,
    /// The coordinate system.
    pub crs: Option<Crs>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Adds the heights and slopes of a surface to points, as columns of text, extra bytes of LAS,
/// fields of a shapefile or properties of GeoJSON, and keeps all that was there byte by byte. `-`
/// is text from the standard input.
///
/// Heights are those of the cells of a DEM. Points outside of the surface are kept, with empty
/// fields (NaN in LAS, null in GeoJSON). For text and LAS, memory is needed for some thousand
/// points, however many there are.
///
/// # Errors
/// If the points cannot be read, a line or a record is not a point, a line has not as many fields
/// as the header or the first point, there is a column of that name or it is not one field of text,
/// the output is not of the format of the points, the coordinate systems differ, slopes are asked
/// for from degrees or by a method other than [`Linear`](crate::terrain::Method), none of the
/// points is on the surface or the file has none, the output cannot be written, a file is damaged,
/// or the run is canceled.
///
/// # Complexity
/// That of [`Sampler::samples`](crate::terrain::Sampler::samples).
pub fn sample(
    surface: &SurfaceProduct,
    points: &Path,
    options: &SampleOptions,
    target: SampleTarget,
    context: &Context,
) -> Result<SampleReport> {
    let journal = Journal::new(context);
    context.check()?;
    let names = options.column_names();
    let source = Source::open(points, options, &names, &journal)?;
    let read = source.columns();
    let of_points = source
        .stated(points)
        .assigned(options.assign.as_ref(), &journal);
    let stated = [surface.stated(&options.surface), of_points];
    let crs = systems::unify(&stated, &SystemOptions::default(), &journal)?.crs;
    if let Some(notice) = surface.unread_by(options.method) {
        journal.add(notice);
    }
    let mut report = surface.with_faces_for(options.method, context, |faces| {
        let mut values = Values {
            sampling: Sampling::new(faces, options, crs.as_ref(), &journal)?,
            work: journal.start(Stage::ComputingHeights, Size::Unknown)?,
            points: 0,
            outside: 0,
            file: points,
            journal: &journal,
            surface: &options.surface,
        };
        source.write(&names, &mut values, target)?;
        let Values {
            work,
            points,
            outside,
            ..
        } = values;
        work.end()?;
        Ok(SampleReport {
            points,
            outside,
            ..SampleReport::default()
        })
    })?;
    if report.outside > 0 {
        journal.add(Notice::PointsOutside {
            path: points.to_path_buf(),
            outside: report.outside,
            points: report.points,
        });
    }
    report.read = read;
    report.columns = names;
    report.crs = crs;
    report.notices = journal.take();
    Ok(report)
}

/// Returns what [`sample`] adds for positions in plan: a value for each
/// [column](SampleOptions::column_names), position by position; NaN if it is missing.
///
/// # Errors
/// Those of [`sample`], except those of the points: positions may all be outside, and what is not
/// finite is outside.
///
/// # Complexity
/// That of [`Sampler::samples`](crate::terrain::Sampler::samples).
pub fn sample_positions(
    surface: &SurfaceProduct,
    positions: &[[f64; 2]],
    options: &SampleOptions,
    context: &Context,
) -> Result<Vec<f64>> {
    let journal = Journal::new(context);
    options.require_no_heights()?;
    if let Some(notice) = surface.unread_by(options.method) {
        journal.add(notice);
    }
    let mut values = Vec::with_capacity(positions.len() * options.column_names().len());
    surface.with_faces_for(options.method, context, |faces| {
        let sampling = Sampling::new(faces, options, surface.crs(), &journal)?;
        let size = Size::Items(positions.len() as u64);
        let work = journal.start(Stage::ComputingHeights, size)?;
        for some in positions.chunks(AT_ONCE) {
            for sample in sampling.samples(some)? {
                sampling.each_value(&sample, f64::NAN, |value| values.push(value));
            }
            work.add(some.len() as u64)?;
        }
        work.end()
    })?;
    Ok(values)
}

//! Lines with the heights of a surface.

use std::path::PathBuf;

use super::followed::{
    Coverage, Vertices, check_lengths, check_step, coverage, follow, in_plan, lines_of, no_line,
};
use super::surface::SurfaceProduct;
use super::together::common_system;
use crate::crs::Crs;
use crate::data::{Layer, Shape};
use crate::error::{Result, Setting};
use crate::io::Destination;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal};
use crate::run::lines::layers;
use crate::run::request::input::Input;

/// Which lines are draped over a surface, and how.
#[derive(Debug, Clone)]
pub struct DrapeOptions {
    /// The lines, or polygons, whose rings are lines.
    pub lines: Input<Layer>,
    /// The coordinate system of the lines, whatever their file states.
    pub assign: Option<Crs>,
    /// The distance of heights along a line. Without one, there is a height at each edge of a
    /// triangle that the line crosses, so that the line is on the surface everywhere.
    pub step: Option<f64>,
    /// What messages call the surface, such as the name of its file.
    pub name: PathBuf,
}

/// Lines with the heights of a surface.
#[derive(Debug)]
#[non_exhaustive]
pub struct DrapeProduct {
    /// A line for each record that was read, with its attributes: its parts are those that are on
    /// the surface. Records of which nothing is on the surface have no geometry.
    pub layer: Layer,
    /// The records with lines that are not on the surface, counted from 1.
    pub off: Vec<usize>,
    /// The records with lines that are on the surface only in part, counted from 1.
    pub partly_off: Vec<usize>,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Drapes lines over a surface. Their own heights are not used.
///
/// # Errors
/// If there are no lines or none is on the surface, a coordinate is not finite, the step is not
/// above zero, the coordinate systems differ, a file is damaged, and if the run is canceled.
///
/// # Complexity
/// That of [`Locator::new`](crate::terrain::Locator::new) for the surface, and of
/// [`Locator::along`](crate::terrain::Locator::along) for each line, on all threads.
pub fn drape(
    surface: &SurfaceProduct,
    options: &DrapeOptions,
    context: &Context,
) -> Result<DrapeProduct> {
    let journal = Journal::new(context);
    context.check()?;
    let (path, read) = layers::read_whole(&options.lines, &journal)?;
    let crs = common_system(
        std::iter::once((options.name.as_path(), surface)),
        (path, &*read),
        options.assign.as_ref(),
        &journal,
    )?;
    let lines = lines_of(&read, path, Setting::Lines)?;
    let plan = in_plan(&lines);
    check_step(options.step, &plan)?;
    let step = options.step.map(|step| (step, Vertices::Kept));
    let title = |record: usize| format!("record {record}");
    check_lengths(&plan, path, |line| title(lines[line].record), &journal)?;
    let found = follow(surface, &plan, |_, _| (), step, context)?;
    let records = |wanted: Coverage| {
        let each = lines.iter().zip(plan.iter().zip(&found));
        let of = each.filter(|(_, (line, stretches))| coverage(line, stretches) == wanted);
        let mut records: Vec<usize> = of.map(|(line, _)| line.record).collect();
        records.dedup();
        records
    };
    let (off, partly_off) = (records(Coverage::Nothing), records(Coverage::Part));
    if found.iter().all(Vec::is_empty) {
        return Err(no_line(path, std::slice::from_ref(&options.name)));
    }
    let titles = |records: &[usize]| records.iter().map(|&record| title(record)).collect();
    let name = || options.name.display().to_string();
    if !off.is_empty() {
        journal.add(Notice::LinesOff(path.to_path_buf(), name(), titles(&off)));
    }
    if !partly_off.is_empty() {
        journal.add(Notice::LinesPartlyOff(
            path.to_path_buf(),
            name(),
            titles(&partly_off),
        ));
    }

    let mut parts: Vec<Vec<Vec<[f64; 3]>>> = vec![Vec::new(); read.shapes.len()];
    for (line, stretches) in lines.iter().zip(found) {
        let points = stretches
            .into_iter()
            .map(|stretch| stretch.into_iter().map(|p| p.at).collect());
        parts[line.at].extend(points);
    }
    let shape = |parts: Vec<_>| match parts.is_empty() {
        true => Shape::Null,
        false => Shape::Lines(parts),
    };
    let layer = Layer {
        format: read.format.clone(),
        shapes: parts.into_iter().map(shape).collect(),
        crs,
        fields: read.fields.clone(),
        columns: read.columns.clone(),
        attributes: read.attributes.clone(),
        ..Layer::default()
    };
    Ok(DrapeProduct {
        layer,
        off,
        partly_off,
        notices: journal.take(),
    })
}

impl DrapeProduct {
    /// Writes the lines in the format that the extension of `target` names. What the format cannot
    /// keep is a notice.
    ///
    /// # Errors
    /// If the format cannot be written, has no room for the lines or their attributes, or the file
    /// cannot be written.
    pub fn write(&self, target: Destination, context: &Context) -> Result<()> {
        layers::write(&self.layer, target, context)
    }
}

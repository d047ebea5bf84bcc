//! Lines that are followed over surfaces.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::surface::SurfaceProduct;
use super::together::COMPARE_EXTENTS;
use crate::data::{Layer, Stretch};
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::notice::Notice;
use crate::run::context::watched::Watched;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::lines::shapes::{self, Drawn};
use crate::terrain::{Locator, stepped, vertices_along};

/// Lines that one thread follows before the run may be canceled, at most.
const LINES_AT_ONCE: usize = 64;

/// The points of all lines by a step, at most.
const MOST_POINTS: f64 = 1e8;

/// A line in plan.
pub(crate) type PlanLine = Vec<[f64; 2]>;

/// Returns the lines of a layer and the rings of its polygons.
///
/// # Errors
/// If there are none, or a coordinate in plan is not finite.
pub(super) fn lines_of(layer: &Layer, path: &Path, setting: Setting) -> Result<Vec<Drawn>> {
    let lines = shapes::in_plan(layer, path, setting)?;
    match lines.is_empty() {
        true => Err(shapes::no_lines(layer, path, setting)),
        false => Ok(lines),
    }
}

/// Returns lines without their heights.
pub(crate) fn in_plan(lines: &[Drawn]) -> Vec<PlanLine> {
    let plan = |line: &Drawn| line.points.iter().map(|p| [p[0], p[1]]).collect();
    lines.iter().map(plan).collect()
}

/// Returns an error unless a step is above zero, and not so small that points along lines would not
/// fit into memory.
pub(crate) fn check_step(step: Option<f64>, lines: &[PlanLine]) -> Result<()> {
    let Some(step) = step else { return Ok(()) };
    if !(step > 0.0 && step.is_finite()) {
        return Err(
            Error::usage(format!("a step of {step}: expected a length above zero")).cure(wording![
                "give a length with ",
                Setting::Step.number("LENGTH"),
                ", or leave it out for all edges of triangles"
            ]),
        );
    }
    let length: f64 = lines.iter().map(|line| length(line)).sum();
    if length / step > MOST_POINTS {
        return Err(Error::limit(format!(
            "{:.0} points by a step of {step} along lines of {length} in all, at most {MOST_POINTS} are computed",
            length / step
        ))
        .cure(wording!["choose a longer ", Setting::Step]));
    }
    Ok(())
}

/// Returns the length of a line in plan.
pub(crate) fn length(line: &[[f64; 2]]) -> f64 {
    vertices_along(line).last().copied().unwrap_or(0.0)
}

/// Returns an error if no line has a length, and adds a notice about those without one. `title` is
/// what a line is called, by its number.
pub(crate) fn check_lengths(
    lines: &[PlanLine],
    path: &Path,
    title: impl Fn(usize) -> String,
    journal: &Journal,
) -> Result<()> {
    let has_none = |number: &usize| length(&lines[*number]) == 0.0;
    let without: Vec<usize> = (0..lines.len()).filter(has_none).collect();
    if without.len() == lines.len() && !lines.is_empty() {
        return Err(Error::usage("no line has a length")
            .in_file(path)
            .cure("a line needs two vertices at different positions"));
    }
    let mut titles: Vec<String> = without.into_iter().map(title).collect();
    titles.dedup();
    if !titles.is_empty() {
        journal.add(Notice::LinesWithoutLength(path.to_path_buf(), titles));
    }
    Ok(())
}

/// Returns the parts of each line that are on a surface. `count` gives the points of a line, by its
/// number, other distances, still in order. With a step, points are at multiples of it instead of
/// at edges; besides, the vertices of lines stay, or none.
///
/// # Errors
/// If the surface is damaged or its faces overlap, or the run is canceled.
pub(crate) fn follow(
    product: &SurfaceProduct,
    lines: &[PlanLine],
    count: impl Fn(usize, &mut Stretch) + Sync,
    step: Option<(f64, Vertices)>,
    context: &Context,
) -> Result<Vec<Vec<Stretch>>> {
    product.with_linked_faces(context, |faces| {
        let work = context.start(Stage::FollowingLines, Size::Items(lines.len() as u64))?;
        let polled = Watched::polled(faces, context)?;
        let locator = Locator::prepared(faces, &polled)?;
        polled.end()?;
        let one = |number: usize, mut found: Vec<Stretch>| {
            let line = &lines[number];
            found.iter_mut().for_each(|stretch| count(number, stretch));
            let Some((step, vertices)) = step else {
                return found;
            };
            let kept = match vertices {
                Vertices::Kept => vertices_along(line),
                Vertices::LeftOut => Vec::new(),
            };
            let stepped = found.iter().map(|stretch| stepped(stretch, step, &kept));
            stepped.collect()
        };
        let shares = 8 * rayon::current_num_threads();
        let size = lines.len().div_ceil(shares).clamp(1, LINES_AT_ONCE);
        let some = |(share, lines): (usize, &[PlanLine])| -> Result<Vec<Vec<Stretch>>> {
            let found = locator.along_each(lines)?;
            work.add(lines.len() as u64)?;
            let numbered = (share * size..).zip(found);
            Ok(numbered.map(|(number, found)| one(number, found)).collect())
        };
        let found: Result<Vec<_>> = lines.par_chunks(size).enumerate().map(some).collect();
        let found = found?.into_iter().flatten().collect();
        work.end()?;
        Ok(found)
    })
}

/// What becomes of the vertices of lines that are followed by a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Vertices {
    Kept,
    LeftOut,
}

/// How much of a line is on a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Coverage {
    /// There is nothing that could be on it.
    NoLength,
    Nothing,
    Part,
    Whole,
}

/// Returns how much of a line is on a surface, given its parts there.
pub(crate) fn coverage(line: &PlanLine, stretches: &[Stretch]) -> Coverage {
    match stretches {
        [] if length(line) == 0.0 => Coverage::NoLength,
        [] => Coverage::Nothing,
        [one] => {
            let plan = |at: [f64; 3]| [at[0], at[1]];
            let ends = [one.first(), one.last()].map(|p| p.map(|p| plan(p.at)));
            if ends == [line.first().copied(), line.last().copied()] {
                Coverage::Whole
            } else {
                Coverage::Part
            }
        }
        _ => Coverage::Part,
    }
}

/// Returns the error if no line is on any of some surfaces.
#[cold]
pub(crate) fn no_line(path: &Path, names: &[PathBuf]) -> Error {
    let names: Vec<String> = names
        .iter()
        .map(|name| name.display().to_string())
        .collect();
    Error::usage(format!("no line is on {}", names.join(" or ")))
        .in_file(path)
        .cure(COMPARE_EXTENTS)
}

//! What is printed of files that are written: while they are, and at the end.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use serde_json::{Value, json};

use super::console::Console;
use super::last_words::LastWords;
use super::summary::{counted, describe, print_extent, print_surface};
use crate::cli::Exit;
use crate::crs::Crs;
use crate::error::Result;
use crate::io::contours::ContourSummary;
use crate::io::geotiff::RasterSummary;
use crate::io::mesh::MeshSummary;
use crate::run::listed;
use crate::run::units::{Units, bytes};
use crate::run::{
    Context, Event, JobReport, JobSize, MapSummary, Monitor, Notice, Origin, Outputs, Progress,
    Size, Stage, Summary, WriteReport, Written, WrittenOf,
};
use crate::terrain::Quantity;

/// Shows what happens while files are written.
#[derive(Debug)]
pub(crate) struct Shown<'a> {
    console: &'a Console,
    /// What the user types to go on with a job; `None` if its folder is removed at the end.
    how_to_go_on: Option<String>,
    /// Prints how to go on if a signal ends the program.
    words: Mutex<Option<LastWords>>,
}

impl<'a> Shown<'a> {
    pub(crate) fn new(console: &'a Console, how_to_go_on: Option<String>) -> Self {
        Shown {
            console,
            how_to_go_on,
            words: Mutex::default(),
        }
    }

    /// Returns the context of a run that is shown.
    pub(crate) fn context(&self) -> Context<'_> {
        Context {
            monitor: self,
            ..Context::default()
        }
    }

    /// Returns what is said of finished tasks, with what is to be done before; nothing if they are
    /// not kept.
    fn kept(&self, folder: &Path, first: &str) -> Option<String> {
        let command = self.how_to_go_on.as_ref()?;
        Some(format!(
            "finished tasks are kept in {}: {first}go on with {command}",
            folder.display(),
        ))
    }

    fn set_words(&self, words: impl FnOnce() -> Option<LastWords>) {
        let mut own = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        // What was there goes first: there is one place for all.
        drop(own.take());
        *own = words();
    }

    /// Prints what was written, and returns how the run ended.
    pub(crate) fn print(&self, report: &WriteReport) -> Exit {
        match report {
            WriteReport::Planned { folder, .. } => {
                self.console
                    .line(format_args!("folder      {}", folder.display()));
                Exit::Done
            }
            WriteReport::Kept { output, has_holes } => {
                self.console
                    .line(format_args!("output      {} is written", output.display()));
                if *has_holes { Exit::Holes } else { Exit::Done }
            }
            WriteReport::Written(written) => self.print_written(written),
        }
    }

    fn print_written(
        &self,
        Written {
            surface,
            summary,
            files,
            ..
        }: &Written,
    ) -> Exit {
        let console = self.console;
        note_meshes(summary, console);
        let crs = match surface {
            WrittenOf::Whole(report) => {
                match (&report.origin, summary) {
                    // The size of the raster is printed already.
                    (Origin::Cells(_), Summary::Shades | Summary::Quantity(..)) => {
                        print_extent(report.extent, report.crs.as_ref(), console)
                    }
                    _ => print_surface(report, console),
                }
                report.crs.as_ref()
            }
            WrittenOf::Tiles { report, .. } => {
                print_tiles(report, console);
                report.crs.as_ref()
            }
        };
        print_summary(summary, crs, console);
        if let Summary::Parts(parts) = summary {
            let folder = files
                .first()
                .map(|index| index.with_file_name(&parts.index.folder))
                .unwrap_or_default();
            console.line(format_args!(
                "parts       {}, in {}",
                parts.index.parts.len(),
                folder.display()
            ));
        }
        files.iter().for_each(|path| print_file(path, console));
        match surface {
            WrittenOf::Tiles { report, folder } if report.skipped > 0 => {
                let skipped = counted(report.skipped as u64, "file");
                let kept = self.kept(folder, "repair what can be repaired, then ");
                let kept = kept.map(|kept| format!("; {kept}")).unwrap_or_default();
                console.note(format_args!(
                    "the result has holes: {skipped} skipped{kept}"
                ));
                Exit::Holes
            }
            WrittenOf::Tiles { .. } | WrittenOf::Whole(_) => Exit::Done,
        }
    }
}

impl Monitor for Shown<'_> {
    fn start(&self, stage: Stage, size: Size) -> Box<dyn Progress> {
        self.console.start(stage, size)
    }

    fn notice(&self, notice: &Notice) {
        self.console.notice(notice);
    }

    fn event(&self, event: &Event) {
        let console = self.console;
        if let Some(note) = event.note() {
            console.note(note);
        }
        match event {
            Event::Planned(size) => print_size(size, console),
            Event::Resumed { done, tasks } => {
                console.line(format_args!("resumed     {done} of {tasks} tasks are done"));
            }
            Event::TasksBegin(folder) => {
                self.set_words(|| console.note_if_ended(self.kept(folder, "")?))
            }
            Event::Waits { tasks, on } => console.note(format_args!(
                "waits for {} of other processes{}",
                counted(*tasks as u64, "task"),
                listed(on)
            )),
            Event::TasksEnd { done_here, tasks } => {
                console.line(format_args!("tasks       {done_here} of {tasks} done here"));
            }
            Event::RasterBegins {
                frame,
                crs,
                bytes: size,
            } => {
                let (cells, size) = (describe(frame, *crs), bytes(*size));
                console.line(format_args!(
                    "raster      {cells}, {size} before compression"
                ));
            }
            Event::Written => self.set_words(|| None),
            Event::PlannedAgain(_)
            | Event::TilesChosenAgain
            | Event::TakenOver { .. }
            | Event::WaitsForJob { .. }
            | Event::GoesOnWithout { .. } => {}
        }
    }
}

/// Prints notes about what the formats of meshes do not keep.
pub(crate) fn note_meshes(summary: &Summary, console: &Console) {
    if let Summary::Meshes(meshes) = summary {
        meshes
            .iter()
            .for_each(|(path, mesh)| note_mesh(path, mesh, ".ply keeps them", console));
    }
}

/// Prints what was made of a surface.
pub(crate) fn print_summary(summary: &Summary, crs: Option<&Crs>, console: &Console) {
    match summary {
        Summary::Heights(cells) => print_heights(cells, crs, console),
        Summary::Quantity(quantity, cells) => print_quantity(*quantity, cells, crs, console),
        Summary::Contours(drawn) => print_contours(drawn, crs, console),
        Summary::Map(map) => print_map(map, crs, console),
        Summary::Parts(_) | Summary::Shades | Summary::Meshes(_) => {}
    }
}

/// Returns what was made of a surface as a JSON object.
pub(crate) fn summary_json(summary: &Summary) -> Value {
    let of_cells = |cells: &RasterSummary| {
        let has_any = cells.valid > 0;
        json!({
            "cells": cells.valid,
            "lowest": has_any.then_some(cells.min),
            "highest": has_any.then_some(cells.max),
        })
    };
    match summary {
        Summary::Heights(cells) | Summary::Quantity(_, cells) => of_cells(cells),
        Summary::Contours(drawn) => json!({ "lines": drawn.lines, "closed": drawn.closed }),
        Summary::Map(map) => json!({
            "lines": map.drawn.lines,
            "closed": map.drawn.closed,
            "left_out": map.left_out,
            "deviation": map.deviation,
            "bands": map.bands,
            "labels": map.labels,
        }),
        Summary::Parts(parts) => json!({ "parts": parts.index.parts.len() }),
        Summary::Shades | Summary::Meshes(_) => json!({}),
    }
}

/// Prints what was written of contours for a map, and what is promised of them.
fn print_map(map: &MapSummary, crs: Option<&Crs>, console: &Console) {
    // If all lines were left out, contours do cross the surface.
    let is_drawn = map.drawn.lines > 0 || map.left_out == 0;
    if is_drawn && map.bands.is_none() {
        print_contours(&map.drawn, crs, console);
    }
    if map.left_out > 0 {
        let left_out = counted(map.left_out as u64, "line");
        console.line(format_args!(
            "left out    {left_out}, too small or too short"
        ));
    }
    if let Some(deviation) = map.deviation {
        let deviation = Units::of(crs).height(deviation);
        console.line(format_args!(
            "deviation   {deviation} off the surface at most, measured along all lines"
        ));
    }
    if let Some(bands) = map.bands {
        console.line(format_args!(
            "bands       {}",
            counted(bands as u64, "area")
        ));
    }
    if let Some(labels) = map.labels {
        console.line(format_args!(
            "labels      {}",
            counted(labels as u64, "label")
        ));
    }
}

/// Prints what a plan consists of.
pub(crate) fn print_size(size: &JobSize, console: &Console) {
    let files = if size.divides {
        format!("of {} files, divided first", size.files)
    } else {
        "the files".to_owned()
    };
    console.line(format_args!(
        "tiles       {} ({files}), {} merges, {} tasks",
        size.tiles, size.merges, size.tasks
    ));
    let disk = match size.bytes_on_disk {
        0 => String::new(),
        disk => format!(", about {} on the disk", bytes(disk)),
    };
    console.line(format_args!(
        "            {} points, {} of memory a task{disk}",
        size.points,
        bytes(size.task_memory)
    ));
}

/// Prints what a surface in tiles was built of, and its size and extent.
fn print_tiles(report: &JobReport, console: &Console) {
    let dropped = [
        (report.other_class, "of other classes"),
        (report.other_return, "of other returns"),
        (report.withheld, "withheld"),
    ];
    let dropped: Vec<String> = dropped
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, why)| format!("{count} {why}"))
        .collect();
    let dropped = if dropped.is_empty() {
        String::new()
    } else {
        format!("; dropped: {}", dropped.join(", "))
    };
    console.line(format_args!(
        "points      {} read, {} used{dropped}",
        report.read, report.used
    ));
    if report.duplicates > 0 {
        console.line(format_args!(
            "            {} at the position of another point",
            report.duplicates
        ));
    }
    if report.points_on_breaklines > 0 {
        let count = report.points_on_breaklines;
        console.line(format_args!(
            "            {count} at a breakline's vertex (whose height is used)"
        ));
    }
    if report.points_replaced > 0 {
        let count = report.points_replaced;
        console.line(format_args!(
            "            {count} in water or walls (left out)"
        ));
    }
    if report.line_edges > 0 {
        console.line(format_args!("lines       {} edges", report.line_edges));
    }
    let mut left_out = Vec::new();
    if report.beyond_max_edge > 0 {
        left_out.push(format!(
            "{} left out at the rim; {} waited for that",
            report.beyond_max_edge, report.waited
        ));
    }
    if report.over_skipped > 0 {
        left_out.push(format!(
            "{} left out over skipped files",
            report.over_skipped
        ));
    }
    if report.clipped > 0 {
        left_out.push(format!("{} clipped", report.clipped));
    }
    let left_out = if left_out.is_empty() {
        String::new()
    } else {
        format!(" ({})", left_out.join(", "))
    };
    console.line(format_args!("triangles   {}{left_out}", report.triangles));
    console.line(format_args!("handed up   {} vertices", report.handed_up));
    print_extent(report.extent, report.crs.as_ref(), console);
}

fn print_heights(cells: &RasterSummary, crs: Option<&Crs>, console: &Console) {
    if cells.valid == 0 {
        return console.warning("no cell has a height");
    }
    let units = Units::of(crs);
    let (low, high) = (units.height(cells.min), units.height(cells.max));
    console.line(format_args!(
        "            {} with a height, from {low} to {high}",
        cells.valid
    ));
}

fn print_quantity(quantity: Quantity, cells: &RasterSummary, crs: Option<&Crs>, console: &Console) {
    if cells.valid == 0 {
        return console.warning("no cell has a value");
    }
    let units = Units::of(crs);
    let shown = |value: f64| match quantity {
        Quantity::SlopeDegrees(_) | Quantity::Aspect(_) => format!("{value:.1} degrees"),
        Quantity::SlopePercent(_) => format!("{value:.1} %"),
        Quantity::ProfileCurvature | Quantity::PlanCurvature => format!("{value:.4}"),
        Quantity::Roughness | Quantity::Ruggedness(_) | Quantity::Position => {
            units.height(value).to_string()
        }
    };
    console.line(format_args!(
        "            {} with a value, from {} to {}",
        cells.valid,
        shown(cells.min),
        shown(cells.max)
    ));
}

fn print_contours(drawn: &ContourSummary, crs: Option<&Crs>, console: &Console) {
    if drawn.lines == 0 {
        return console.warning("no contour crosses the surface at these levels");
    }
    let units = Units::of(crs);
    let (low, high) = (
        units.height(drawn.bounds.min[2]),
        units.height(drawn.bounds.max[2]),
    );
    let lines = counted(drawn.lines as u64, "line");
    console.line(format_args!(
        "contours    {lines} ({} closed) from {low} to {high}",
        drawn.closed
    ));
}

/// Makes all files appear, and prints their names.
///
/// # Errors
/// If one cannot appear; then none does.
pub(crate) fn commit<F>(outputs: Outputs<F>, console: &Console) -> Result<()> {
    outputs
        .set
        .commit()?
        .iter()
        .for_each(|path| print_file(path, console));
    Ok(())
}

/// Prints a note if the format of a mesh does not store which edges are on lines, and there are
/// any; and a note if its coordinates are relative to an origin.
pub(crate) fn note_mesh(file: &Path, written: &MeshSummary, cure: &str, console: &Console) {
    let path = file.display();
    let edges = written.lost_edges;
    if edges > 0 {
        console.note(format_args!(
            "{path}: {edges} edges on breaklines or clip lines are not marked in this format; {cure}"
        ));
    }
    if let Some(([x, y, z], beside)) = &written.origin {
        let beside = beside.display();
        console.note(format_args!(
            "{path}: coordinates are relative to {x} {y} {z}, see {beside}"
        ));
    }
    for note in &written.notes {
        console.note(format_args!("{path}: {note}"));
    }
}

/// Prints the name and size of a file that was written.
pub(crate) fn print_file(file: &Path, console: &Console) {
    let path = file.display();
    match std::fs::metadata(file) {
        Ok(data) if data.is_file() => console.line(format_args!(
            "written     {path} ({} kB)",
            data.len().div_ceil(1000)
        )),
        _ => console.line(format_args!("written     {path}")),
    }
}

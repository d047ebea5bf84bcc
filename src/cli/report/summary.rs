//! The summary at the end of a run.

use std::time::Instant;

use super::console::Console;
use crate::crs::Crs;
use crate::data::{Bounds, Columns, EdgeKind, Frame};
use crate::run::units::{Units, neat, number};
use crate::run::{BuildReport, LineInput, LineRole, Origin, SurfaceReport};
use crate::terrain::{DuplicateRule, SelectionReport, TinReport};

/// Prints what a surface was built of, what was left out, and its size and extent.
pub(crate) fn print_surface(report: &SurfaceReport, console: &Console) {
    match &report.origin {
        Origin::Built(built) => {
            console.line(format_args!(
                "points      {}",
                points_line(&built.points, built.sources)
            ));
            if !built.columns.is_empty() {
                console.line(columns_are(&columns_line(&built.columns)));
            }
            print_tin(built, console);
            console.line(format_args!(
                "triangles   {}{}",
                built.tin.triangles,
                left_out(&built.tin)
            ));
        }
        Origin::Cells(frame) => {
            console.line(format_args!(
                "raster      {}",
                describe(frame, report.crs.as_ref())
            ));
        }
        Origin::Triangles(facts) => {
            for (kind, edges) in facts.edges.kinds() {
                console.line(format_args!("{:<11} {edges} edges", kind.noun()));
            }
            console.line(format_args!("vertices    {}", facts.vertices));
            console.line(format_args!("triangles   {}", facts.triangles));
        }
    }
    print_extent(report.extent, report.crs.as_ref(), console);
}

fn print_tin(built: &BuildReport, console: &Console) {
    let tin = &built.tin;
    if tin.duplicates > 0 {
        let rule = match built.duplicates {
            DuplicateRule::Lowest => "the lowest is kept",
            DuplicateRule::Highest => "the highest is kept",
            DuplicateRule::Mean => "their mean is used",
            DuplicateRule::First => "the first is kept",
            DuplicateRule::Last => "the last is kept",
        };
        console.line(format_args!(
            "            {} at the position of another point ({rule})",
            tin.duplicates
        ));
    }
    if tin.points_on_breaklines > 0 {
        let count = tin.points_on_breaklines;
        console.line(format_args!(
            "            {count} at a breakline's vertex (whose height is used)"
        ));
    }
    if tin.points_replaced > 0 {
        console.line(format_args!(
            "            {} in water or walls (left out)",
            tin.points_replaced
        ));
    }
    print_lines(built, console);
    let parts = [
        (
            tin.vertices_beyond_max_edge,
            if tin.faces_with_long_edges > 0 {
                "left out with long edges"
            } else {
                "left out with triangles at the rim"
            },
        ),
        (tin.vertices_clipped, "clipped"),
        (
            tin.vertices_cut,
            if tin.edges.of(EdgeKind::Draped) > 0 {
                "added by cuts"
            } else {
                "added by the clip"
            },
        ),
    ];
    console.line(format_args!(
        "vertices    {}{}",
        tin.vertices,
        listed(&parts)
    ));
    let clips = tin.edges.of(EdgeKind::Clip);
    if clips > 0 {
        console.line(format_args!("clip lines  {clips} edges"));
    }
}

/// Prints how many lines became how many edges, for each input.
fn print_lines(built: &BuildReport, console: &Console) {
    let tin = &built.tin;
    let of_breaklines: Vec<&LineInput> = built
        .lines
        .iter()
        .filter(|input| input.role == LineRole::Breaklines)
        .collect();
    let breaklines: usize = of_breaklines.iter().map(|input| input.lines).sum();
    if breaklines > 0 {
        let crossings = match tin.crossings {
            0 => String::new(),
            n => format!(", {n} crossings between vertices"),
        };
        let (edges, vertices) = (tin.edges.of(EdgeKind::Breakline), tin.breakline_vertices);
        console.line(format_args!(
            "breaklines  {breaklines} in, {edges} edges out, {vertices} vertices{crossings}"
        ));
        if of_breaklines.len() > 1 {
            for LineInput {
                path, lines, edges, ..
            } in of_breaklines
            {
                console.line(format_args!(
                    "            {lines} in, {edges} edges of {}",
                    path.display()
                ));
            }
        }
    }
    for LineInput {
        role,
        path,
        lines,
        edges,
        ..
    } in &built.lines
    {
        let path = path.display();
        let (name, edges) = match role {
            LineRole::Breaklines | LineRole::Boundary => continue,
            LineRole::Soft => ("soft lines", *edges),
            LineRole::Walls => ("walls", *edges),
            LineRole::Flats => ("lakes", *edges),
            LineRole::Rivers => ("rivers", *edges),
            LineRole::Draped => {
                let all = tin.edges.of(EdgeKind::Draped);
                console.line(format_args!(
                    "draped      {lines} in, of {path} ({all} edges of all draped lines)"
                ));
                continue;
            }
            LineRole::Holes => {
                console.line(format_args!("holes       {lines} of {path}"));
                continue;
            }
        };
        console.line(format_args!(
            "{name:<11} {lines} in, {edges} edges out, of {path}"
        ));
    }
}

fn left_out(tin: &TinReport) -> String {
    listed(&[
        (tin.faces_beyond_max_edge, "at the rim left out"),
        (tin.faces_with_long_edges, "with long edges left out"),
        (tin.faces_clipped, "clipped"),
        (tin.faces_cut, "cut"),
    ])
}

/// Returns the line about the columns of a file of text, if it is one.
pub(crate) fn of_columns(columns: Option<Columns>) -> Option<String> {
    columns.map(|columns| columns_are(&columns.to_string()))
}

fn columns_are(columns: &str) -> String {
    format!("columns     {columns}")
}

/// Returns the columns of text files, such as "x 3, y 2, z 4"; with the number of files of each if
/// they differ.
fn columns_line(columns: &[(Columns, u64)]) -> String {
    match columns {
        [(columns, _)] => columns.to_string(),
        several => {
            let texts = several
                .iter()
                .map(|(columns, count)| format!("{columns} ({})", counted(*count, "file")));
            texts.collect::<Vec<_>>().join("; ")
        }
    }
}

/// Formats counts as ` (5 clipped, 2 added)`, without those that are zero.
fn listed(parts: &[(usize, &str)]) -> String {
    let parts: Vec<String> = parts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    if parts.is_empty() {
        String::new()
    } else {
        format!(" ({})", parts.join(", "))
    }
}

/// Prints an extent and its coordinate system.
pub(crate) fn print_extent(extent: Bounds, crs: Option<&Crs>, console: &Console) {
    if !extent.is_empty() {
        // Three decimals are enough for metres; small extents, as in degrees, get all.
        let is_wide = (0..2).any(|i| extent.max[i] - extent.min[i] > 10.0);
        let shown = if is_wide { thousandths } else { neat };
        let axis = |i: usize| format!("{} .. {}", shown(extent.min[i]), shown(extent.max[i]));
        let heights = if extent.min[2] <= extent.max[2] {
            format!(", z {}", axis(2))
        } else {
            String::new()
        };
        console.line(format_args!(
            "extent      x {}, y {}{heights}",
            axis(0),
            axis(1)
        ));
    }
    match crs {
        Some(crs) => console.line(format_args!("CRS         {}", crs.describe())),
        None => console.line("CRS         not known"),
    }
}

fn points_line(report: &SelectionReport, files: usize) -> String {
    let mut text = format!("{} read", report.read);
    if files > 1 {
        text += &format!(" from {files} files");
    }
    text += &format!(", {} used", report.used);
    let mut dropped = Vec::new();
    if report.other_class > 0 {
        let classes: Vec<String> = report
            .other_classes
            .iter()
            .map(|(class, count)| format!("{class}: {count}"))
            .collect();
        dropped.push(format!(
            "{} of other classes ({})",
            report.other_class,
            classes.join(", ")
        ));
    }
    if report.other_return > 0 {
        dropped.push(format!("{} of other returns", report.other_return));
    }
    if report.withheld > 0 {
        dropped.push(format!("{} withheld", report.withheld));
    }
    if report.outside > 0 {
        dropped.push(format!(
            "{} outside of the bounds and their buffer",
            report.outside
        ));
    }
    if !dropped.is_empty() {
        text += &format!("; dropped: {}", dropped.join(", "));
    }
    text
}

/// Formats the size of a raster as `400 x 300 cells of 1 m`.
pub(crate) fn describe(frame: &Frame, crs: Option<&Crs>) -> String {
    let t = frame.transform;
    let (across, down) = (t[1].hypot(t[4]), t[2].hypot(t[5]));
    let units = Units::of(crs);
    let size = if across == down {
        units.length(across).to_string()
    } else {
        format!("{} by {}", number(across), units.length(down))
    };
    format!("{} x {} cells of {size}", frame.width, frame.height)
}

/// Formats a count as `1 point`, `2 points`.
pub(crate) fn counted(count: u64, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}

/// Formats a number with at most three decimals.
fn thousandths(value: f64) -> String {
    neat((value * 1e3).round() / 1e3)
}

/// Prints the time and the peak memory of the run.
pub(crate) fn print_cost(start: Instant, console: &Console) {
    let time = format!("{:.2} s", start.elapsed().as_secs_f64());
    match peak_memory() {
        Some(bytes) => console.line(format_args!(
            "done in {time}, peak memory {} MB",
            number(bytes as f64 / 1e6)
        )),
        None => console.line(format_args!("done in {time}")),
    }
}

/// Returns the peak memory of this process in bytes; `None` if the system does not report it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

//! The summary that a run ends with.

use std::time::{Duration, Instant};

use super::talk::Talk;
use crate::crs::Crs;
use crate::data::{self, Bounds, EdgeKind, Surface};
use crate::run::units::{neat, number, thousandths};
use crate::terrain::{DuplicateRule, SelectionReport, TinReport};

/// How a surface was made.
#[derive(Debug, Clone, Default)]
pub(super) struct Made {
    pub(super) files: usize,
    pub(super) points: Option<SelectionReport>,
    /// The columns that were taken of text.
    pub(super) columns: Option<String>,
    /// Lines read (parts and rings count one each).
    pub(super) breaklines: usize,
    pub(super) tin: Option<TinReport>,
    pub(super) duplicates: DuplicateRule,
}

impl Made {
    /// Says what went in, what was dropped and what came out.
    pub(super) fn tell(&self, surface: &dyn Surface, talk: &Talk) {
        if let Some(points) = &self.points {
            talk.line(format_args!("points      {}", points_line(points, self.files)));
        }
        if let Some(columns) = &self.columns {
            talk.line(format_args!("columns     {columns}"));
        }
        if let Some(tin) = &self.tin {
            self.tell_tin(tin, talk);
        }
        let (triangles, extent) = match &self.tin {
            Some(tin) => (tin.triangles, tin.extent),
            None => {
                let facts = SurfaceFacts::of(surface);
                for (name, edges) in [("breaklines", facts.breaklines), ("clip lines", facts.clips)] {
                    if edges > 0 {
                        talk.line(format_args!("{name}  {edges} edges"));
                    }
                }
                talk.line(format_args!("vertices    {}", facts.vertices));
                (facts.triangles, facts.extent)
            }
        };
        talk.line(format_args!("triangles   {triangles}{}", self.left_out()));
        tell_place(extent, surface.crs(), talk);
    }

    /// The box around the surface that was made.
    pub(super) fn extent(&self, surface: &dyn Surface) -> Bounds {
        self.tin.as_ref().map_or_else(|| SurfaceFacts::of(surface).extent, |tin| tin.extent)
    }

    fn tell_tin(&self, tin: &TinReport, talk: &Talk) {
        if tin.duplicates > 0 {
            let rule = match self.duplicates {
                DuplicateRule::Lowest => "the lowest is kept",
                DuplicateRule::Highest => "the highest is kept",
                DuplicateRule::Mean => "their mean is taken",
                DuplicateRule::First => "the first is kept",
                DuplicateRule::Last => "the last is kept",
            };
            talk.line(format_args!("            {} at the place of another point ({rule})", tin.duplicates));
        }
        if tin.points_on_breaklines > 0 {
            let count = tin.points_on_breaklines;
            talk.line(format_args!("            {count} at a breakline's vertex (whose height is taken)"));
        }
        if self.breaklines > 0 {
            let crossings = match tin.crossings {
                0 => String::new(),
                n => format!(", {n} crossings between vertices"),
            };
            let (lines, edges, vertices) = (self.breaklines, tin.constrained_edges, tin.breakline_vertices);
            talk.line(format_args!("breaklines  {lines} in, {edges} edges out, {vertices} vertices{crossings}"));
        }
        let parts = [
            (tin.vertices_beyond_max_edge, "left out with triangles at the rim"),
            (tin.vertices_clipped, "clipped"),
            (tin.vertices_cut, "added by the clip"),
        ];
        talk.line(format_args!("vertices    {}{}", tin.vertices, listed(&parts)));
        if tin.clip_edges > 0 {
            talk.line(format_args!("clip lines  {} edges", tin.clip_edges));
        }
    }

    fn left_out(&self) -> String {
        let Some(tin) = &self.tin else { return String::new() };
        listed(&[
            (tin.faces_beyond_max_edge, "with long edges at the rim left out"),
            (tin.faces_clipped, "clipped"),
            (tin.faces_cut, "cut"),
        ])
    }
}

/// ` (5 clipped, 2 added)`, without what there is none of.
fn listed(parts: &[(usize, &str)]) -> String {
    let parts: Vec<String> =
        parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    if parts.is_empty() { String::new() } else { format!(" ({})", parts.join(", ")) }
}

/// Where something is, and in which coordinate system.
pub(super) fn tell_place(extent: Bounds, crs: Option<&Crs>, talk: &Talk) {
    if !extent.is_empty() {
        // Millimetres will do where there are metres; degrees are small.
        let is_wide = (0..2).any(|i| extent.max[i] - extent.min[i] > 10.0);
        let tell = if is_wide { thousandths } else { neat };
        let axis = |i: usize| format!("{} .. {}", tell(extent.min[i]), tell(extent.max[i]));
        let heights = if extent.min[2] <= extent.max[2] { format!(", z {}", axis(2)) } else { String::new() };
        talk.line(format_args!("extent      x {}, y {}{heights}", axis(0), axis(1)));
    }
    match crs {
        Some(crs) => talk.line(format_args!("CRS         {}", crs.describe())),
        None => talk.line("CRS         not known"),
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
        let is_used = |class| report.classes.as_ref().is_none_or(|used| used.contains(class));
        let classes: Vec<String> = report
            .by_class
            .iter()
            .filter(|(class, _)| !is_used(class))
            .map(|(class, count)| format!("{class}: {count}"))
            .collect();
        dropped.push(format!("{} of other classes ({})", report.other_class, classes.join(", ")));
    }
    if report.withheld > 0 {
        dropped.push(format!("{} withheld", report.withheld));
    }
    if report.outside > 0 {
        dropped.push(format!("{} outside of the bounds and their buffer", report.outside));
    }
    if !dropped.is_empty() {
        text += &format!("; dropped: {}", dropped.join(", "));
    }
    text
}

/// Counts and extent of what is really part of a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SurfaceFacts {
    /// Vertices that a face uses.
    pub(super) vertices: usize,
    pub(super) triangles: usize,
    /// Edges on breaklines.
    pub(super) breaklines: usize,
    /// Edges on clip lines.
    pub(super) clips: usize,
    pub(super) extent: Bounds,
}

impl SurfaceFacts {
    /// Goes over all faces once.
    pub(super) fn of(surface: &dyn Surface) -> Self {
        let mut is_used = vec![false; surface.vertex_count()];
        let mut facts = SurfaceFacts { vertices: 0, triangles: 0, breaklines: 0, clips: 0, extent: Bounds::default() };
        data::faces(surface).for_each(|face| {
            facts.triangles += 1;
            for (i, kind) in face.edges.into_iter().enumerate() {
                let count = match kind {
                    EdgeKind::Breakline => &mut facts.breaklines,
                    EdgeKind::Clip => &mut facts.clips,
                    EdgeKind::Plain | EdgeKind::Rim => continue,
                };
                // An edge inside is met from both sides.
                *count += usize::from(surface.neighbor(face.number, i).is_none_or(|other| face.number < other));
            }
            for vertex in face.corners {
                if !std::mem::replace(&mut is_used[vertex as usize], true) {
                    facts.vertices += 1;
                    facts.extent.add(surface.position(vertex));
                }
            }
        });
        facts
    }
}

/// Says how long it took and how much memory it took.
pub(super) fn tell_cost(start: Instant, talk: &Talk) {
    let time = seconds(start.elapsed());
    match peak_memory() {
        Some(bytes) => talk.line(format_args!("done in {time}, peak memory {} MB", number(bytes as f64 / 1e6))),
        None => talk.line(format_args!("done in {time}")),
    }
}

pub(super) fn seconds(time: Duration) -> String {
    format!("{:.2} s", time.as_secs_f64())
}

/// The most memory that this process held, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

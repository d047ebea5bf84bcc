//! The texts of notices.

use std::fmt;
use std::path::PathBuf;

use super::notice::{CrossingNote, LoweredRiver, Notice, Seed, SeedFlaw, WaterStep};
use super::units::{Quantity, bytes, neat, number};
use crate::data::Bounds;
use crate::error::{Setting, Wording, wording};

/// Formats the text of the notice with plain names of settings, without its
/// [details](Notice::details).
impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().plain())
    }
}

impl Notice {
    /// Returns the text of the notice.
    pub fn text(&self) -> Wording {
        text(self)
    }

    /// Returns the lines that explain the notice further, if any.
    pub fn details(&self) -> Vec<Wording> {
        let (count, first) = match self {
            Notice::CrossingHeights { count, first, .. } => (count, first),
            Notice::WaterOverlaps { count, first } if *count > 1 => return steps(*count, first),
            Notice::RiversLowered { count, first } if *count > 1 => return lowerings(*count, first),
            Notice::OfTask { details, .. } => return details.clone(),
            _ => return Vec::new(),
        };
        let each = first.iter().map(|CrossingNote { at, low, high, chosen }| {
            let [x, y] = at.map(neat);
            let [low, high] = [low, high].map(|(z, line)| format!("{} of {line}", neat(*z)));
            format!("{x} {y}: {low}, {high}; {} is used", neat(*chosen)).into()
        });
        let mut lines: Vec<Wording> = each.collect();
        if *count > first.len() {
            let more = format!("and {} more (", count - first.len());
            lines.push(wording![more, Setting::CrossingReport.text("FILE.csv"), ")"]);
        }
        lines
    }
}

/// The lines that list steps between waters that overlap or touch.
fn steps(count: usize, first: &[WaterStep]) -> Vec<Wording> {
    let mut lines: Vec<Wording> = first.iter().map(|one| step(one).into()).collect();
    if count > first.len() {
        lines.push(format!("and {} more pairs", count - first.len()).into());
    }
    lines
}

/// The lines that list rivers that are lowered to others.
fn lowerings(count: usize, first: &[LoweredRiver]) -> Vec<Wording> {
    let mut lines: Vec<Wording> = first.iter().map(|one| lowering(one).into()).collect();
    if count > first.len() {
        lines.push(format!("and {} more rivers", count - first.len()).into());
    }
    lines
}

fn lowering(LoweredRiver { name, to, by, from }: &LoweredRiver) -> String {
    let [x, y] = from.map(neat);
    format!("the river {name} is lowered by up to {by} from {x} {y} on, to the river {to}, which joins it there")
}

fn step(WaterStep { inner, outer, step, at }: &WaterStep) -> String {
    let [x, y] = at.map(neat);
    format!("a step of {step} at {x} {y}, from {outer} to {inner}")
}

fn text(notice: &Notice) -> Wording {
    match notice {
        Notice::Opened(path, format) => format!("{}: {format}", path.display()).into(),
        Notice::WithoutClasses(path) => format!("{}: no classes, all points are used", path.display()).into(),
        Notice::LayerRead { path, format, records } => {
            format!("{}: {format}, {records} records", path.display()).into()
        }
        Notice::PointsRead(path, count) => format!("{}: {count} points read", path.display()).into(),
        Notice::OfTask { text, .. } => text.clone(),
        Notice::Reader(path, text) => wording![format!("{}: ", path.display()), text.clone()],
        Notice::Skipped { why, hole, others } => skipped(why, hole.as_ref(), others).into(),
        Notice::LittleMemory { need, left, limit } => format!(
            "memory may not suffice: if all points are used they take about {}, and {} are left {limit}",
            bytes(*need),
            bytes(*left)
        )
        .into(),
        Notice::MemoryUnused(why) => wording![Setting::Memory, " has no effect: ", why.clone()],
        Notice::OutputMayNotFit { need, free } => format!(
            "the output may not fit: {} before compression, {} are free on the disk",
            bytes(*need),
            bytes(*free)
        )
        .into(),
        Notice::TasksMayNotFit { need, free } => format!(
            "the files of the tasks may not fit: the files of the tasks take about {}, {} are free on the disk",
            bytes(*need),
            bytes(*free)
        )
        .into(),
        Notice::NoPointUsed(path, classes) => {
            let why = match classes {
                Some(classes) => {
                    let classes: Vec<String> = classes.iter().map(u8::to_string).collect();
                    format!("it has none of class {}", classes.join(" or "))
                }
                None => "it has none".to_owned(),
            };
            format!("{}: none of its points is used: {why}", path.display()).into()
        }
        Notice::NoPointOfClass(class) => format!("no point has class {class}").into(),
        Notice::GroundUsed => "points of class 2 (ground) are used".into(),
        Notice::PointsWithoutClassUsed(count) => {
            format!("{count} points from files without classes are used, too").into()
        }
        Notice::AllClassesUsed => {
            wording!["no point has class 2 (ground): all classes are used (choose with ", Setting::Class, ")"]
        }
        Notice::Reassigned { path, stated, assigned } => {
            wording![format!("{} states {stated}; {assigned} is used, as given by ", path.display()), Setting::Crs]
        }
        Notice::SystemOfOthers(path, crs) => {
            format!("{} states no coordinate system; {crs} is used, as in the other files", path.display()).into()
        }
        Notice::NoSystem => "no coordinate system is stated: lengths are in the units of the data".into(),
        Notice::DifferentUnits(plan, height) => {
            format!("x and y are in units of the {plan}, heights in units of the {height}").into()
        }
        Notice::Reprojecting(from, to) => format!("reprojecting from {from} to {to}").into(),
        Notice::Transform(text) => text.clone().into(),
        Notice::FarApart(before, after, gap) => format!(
            "{} and {} are {gap} apart, with nothing between them: are they in the same coordinate system?",
            before.display(),
            after.display()
        )
        .into(),
        Notice::BreaklinesApart(gap) => {
            format!("the breaklines lie {gap} away from the points: are they in the same coordinate system?").into()
        }
        Notice::BreaklinesBeyond(reach) => wording![
            format!("breaklines reach {reach} beyond the points: the surface there depends on them alone (clip with "),
            Setting::Bounds,
            ")"
        ],
        Notice::EdgeLimit(length) => {
            wording![format!("triangles at the rim with edges over {length} are left out ("), Setting::MaxEdge, ")"]
        }
        Notice::NoEdgeLimit => wording!["the whole convex hull is kept (", Setting::MaxEdge.text("none"), ")"],
        Notice::BoundsBuffer(buffer) => {
            let how_far = match buffer {
                None => "all points are used".to_owned(),
                Some(buffer) => format!("points up to {buffer} outside of the bounds are used"),
            };
            format!("{how_far}, so that the surface inside is the same as with all points").into()
        }
        Notice::Triangulated(time) => format!("triangulated in {:.2} s", time.as_secs_f64()).into(),
        Notice::Uncertain(count, buffer) => {
            format!("{count} triangles within the bounds may depend on points further out than {buffer}").into()
        }
        Notice::CrossingsRounded { unit, on_grid } => rounded(unit, *on_grid).into(),
        Notice::EdgeLimitUnusual { limit, spacing } => wording![
            format!(
                "the longest edge at the rim is {limit}, but points are {spacing} apart on average: choose it with "
            ),
            Setting::MaxEdge.number("LENGTH"),
            " or ",
            Setting::MaxEdge.text("auto")
        ],
        Notice::LevelRings { rings, points, name, largest } => {
            let lines = if *rings == 1 {
                "a closed line of one height has"
            } else {
                &format!("{rings} closed lines of one height have")
            };
            let inside = if *points == 1 { "1 point" } else { &format!("{points} points") };
            wording![
                format!("{lines} {inside} of other heights inside, by up to {largest} ({name}): for lakes, use "),
                Setting::Flat
            ]
        }
        Notice::RiverHeights { rivers, name, rising, largest_rise, rise_at, largest_difference, difference_at } => {
            let [[x, y], [u, v]] = [rise_at, difference_at].map(|at| at.map(neat));
            let others = if *rivers > 1 { &format!(" ({} others are not, either)", rivers - 1) } else { "" };
            let mut text = format!("the banks of the river {name} are not level{others}");
            if *rising > 0 {
                text += &format!(": they rise downstream at {rising} vertices, by up to {largest_rise} (at {x} {y})");
            }
            if largest_difference.value > 0.0 {
                text += &format!("; they differ by up to {largest_difference} across (at {u} {v})");
            }
            text.into()
        }
        Notice::RiversLowered { count: 1, first } => {
            let lowerings: Vec<String> = first.iter().map(lowering).collect();
            format!("{}: if it should not be, correct the heights of either", lowerings.join(", ")).into()
        }
        Notice::RiversLowered { count, .. } => {
            format!("{count} rivers are lowered to others that join them: correct the heights of those that are wrong")
                .into()
        }
        Notice::RiverOverlap { rivers, name, at } => {
            let [x, y] = at.map(neat);
            let others = if *rivers > 1 { &format!(" (and {} others)", rivers - 1) } else { "" };
            format!(
                "the banks of the river {name} meet near {x} {y}{others}: what they enclose twice is not water; divide \
                 the line, or make it narrower"
            )
            .into()
        }
        Notice::WallsInWater { vertices, name, at } => {
            let [x, y] = at.map(neat);
            let count = if *vertices == 1 { "1 vertex" } else { &format!("{vertices} vertices") };
            format!(
                "{count} of walls have the height of water, which counts first (at {x} {y} of {name}): draw walls behind \
                 the shore, by more than their width"
            ).into()
        }
        Notice::WaterOverlaps { count: 1, first } => {
            let steps: Vec<String> = first.iter().map(step).collect();
            format!(
                "two waters overlap or touch, and the lower height, or that of the lake, counts: {}",
                steps.join(", ")
            )
            .into()
        }
        Notice::WaterOverlaps { count, .. } => {
            format!("{count} pairs of waters overlap or touch, and the lower height, or that of the lake, counts")
                .into()
        }
        Notice::LinesApart(role) => wording!["nothing of ", role.setting(), " lies on the surface"],
        Notice::CrossingHeights { count, largest, at, .. } => {
            let points = if *count == 1 { "1 point" } else { &format!("{count} points") };
            let [x, y] = at.map(neat);
            format!("breaklines meet with different heights at {points}, by up to {largest} (at {x} {y})").into()
        }
        Notice::ExtentApart => wording!["the rectangle of ", Setting::Extent, " does not touch the surface"],
        Notice::DefaultResolution(width) => wording![format!("cells are {width} wide ("), Setting::Resolution, ")"],
        Notice::DefaultInterval(height) => wording![format!("contours are {height} apart ("), Setting::Interval, ")"],
        Notice::HeightFactor(factor) => {
            wording![
                format!("heights are multiplied by {} to match the units of x and y (", number(*factor)),
                Setting::ZFactor,
                ")"
            ]
        }
        Notice::DelaunayUnchecked(path) => {
            format!("{}: the format does not store breaklines: the Delaunay law is not checked", path.display()).into()
        }
        Notice::RegionAreasUnused(path) => {
            wording![
                format!("{}: the largest areas of its regions are ignored: add ", path.display()),
                Setting::RegionAreas.on(),
                " to use them"
            ]
        }
        Notice::SeedUnused { path, line, seed, why } => {
            let what = match seed {
                Seed::Hole => "hole",
                Seed::Region => "region",
            };
            let why = match why {
                SeedFlaw::OnSegment => "lies on a segment, so that its side is ambiguous",
                SeedFlaw::OutsideHull => "lies outside of the convex hull",
            };
            format!("{}: line {line}: the {what} {why}; it is not used", path.display()).into()
        }
    }
}

fn skipped(why: &str, hole: Option<&Bounds>, others: &[PathBuf]) -> String {
    let Some(Bounds { min, max }) = hole else {
        return format!("skipped: {why}; its extent is not known: triangles may span it");
    };
    let [x0, y0, x1, y1] = [min[0], min[1], max[0], max[1]].map(neat);
    let others = match others {
        [] => String::new(),
        [one] => format!(", also where {} has points", one.display()),
        [one, more @ ..] => format!(", also where {} and {} other files have points", one.display(), more.len()),
    };
    format!("skipped: {why}; its extent is left empty, from {x0} {y0} to {x1} {y1}{others}")
}

fn rounded([x, y]: &[Quantity; 2], on_grid: bool) -> String {
    let unit = if x == y { x.to_string() } else { format!("{x} in x and {y} in y") };
    let bound = match on_grid {
        true => "no line moves by more than half of that on each axis",
        false => "some vertices are not on this grid, so that no bound is proven for lines that cross near them",
    };
    format!("crossings of breaklines are rounded to {unit}; {bound}")
}

//! The texts of notices.

use std::fmt;
use std::path::{Path, PathBuf};

use super::notice::{CrossingNote, LoweredRiver, Notice, Seed, SeedFlaw, WaterStep};
use super::notice_lists::{
    ground_in_doubt, named, of_file, of_listed, polygons_outside, polygons_partly_outside,
    rings_overlap, sections_cross,
};
use super::notice_systems::{
    above_ellipsoid, beyond_bound, different_units, first_of_bands, heights_of_others, no_system,
    reassigned, system_of_others,
};
use super::units::{Quantity, bytes, neat, number};
use crate::data::Bounds;
use crate::error::{Command, Setting, Wording, wording};
use crate::run::request::lines::LineRole;

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
            Notice::RiversLowered { count, first } if *count > 1 => {
                return lowerings(*count, first);
            }
            Notice::OfTask { details, .. } => return details.clone(),
            _ => return Vec::new(),
        };
        let each = first.iter().map(
            |CrossingNote {
                 at,
                 low,
                 high,
                 chosen,
             }| {
                let [x, y] = at.map(neat);
                let [low, high] = [low, high].map(|(z, line)| format!("{} of {line}", neat(*z)));
                format!("{x} {y}: {low}, {high}; {} is used", neat(*chosen)).into()
            },
        );
        let mut lines: Vec<Wording> = each.collect();
        if *count > first.len() {
            let more = format!("and {} more (", count - first.len());
            lines.push(wording![
                more,
                Setting::CrossingReport.text("FILE.csv"),
                ")"
            ]);
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
    format!(
        "the river {name} is lowered by up to {by} from {x} {y} on, to the river {to}, which joins it there"
    )
}

fn step(
    WaterStep {
        inner,
        outer,
        step,
        at,
    }: &WaterStep,
) -> String {
    let [x, y] = at.map(neat);
    format!("a step of {step} at {x} {y}, from {outer} to {inner}")
}

fn simplified(
    [vertices, heights]: [usize; 2],
    [bound, largest, root_mean_square]: [&Quantity; 3],
    [before, after]: [usize; 2],
) -> String {
    let of_lines = match before {
        0 => String::new(),
        _ => format!(", {after} of {before} on lines"),
    };
    format!(
        "simplified to {vertices} of {heights} vertices{of_lines}: all heights are within {bound}, the largest error is {largest}, the root mean square {root_mean_square}"
    )
}

/// Returns the text of each notice; where it takes more than a line, a function below has it.
#[rustfmt::skip]
fn text(notice: &Notice) -> Wording {
    match notice {
        Notice::Opened(path, format) => of_file(path, format),
        Notice::WithoutClasses(path) => of_file(path, "no classes, all points are used"),
        Notice::LayerRead { path, format, records } => layer_read(path, format, *records),
        Notice::PointsRead(path, count) => of_file(path, &format!("{count} points read")),
        Notice::NodesRead { path, read, nodes } => {
            of_file(path, &format!("{read} of {nodes} nodes of the octree are read"))
        }
        Notice::OfTask { text, .. } => text.clone(),
        Notice::Reader(path, text) => wording![format!("{}: ", path.display()), text.clone()],
        Notice::Skipped { why, hole, others } => skipped(why, hole.as_ref(), others).into(),
        Notice::LittleMemory { need, left, limit } => little_memory(*need, *left, limit).into(),
        Notice::MemoryUnused(why) => wording![Setting::Memory, " has no effect: ", why.clone()],
        Notice::BuiltInFiles { memory, folder } => built_in_files(*memory, folder).into(),
        Notice::OutputMayNotFit { need, free } => output_may_not_fit(*need, *free).into(),
        Notice::TasksMayNotFit { need, free } => tasks_may_not_fit(*need, *free).into(),
        Notice::NoPointUsed(path, classes) => no_point_used(path, classes.as_deref()),
        Notice::NoPointOfClass { classes, unread } => no_point_of_class(classes, *unread).into(),
        Notice::NoiseUnused => "points of all classes are used, except noise (7 and 18)".into(),
        Notice::PointsWithoutReturnUsed(count) => points_without_return(*count).into(),
        Notice::GroundUsed => "points of class 2 (ground) are used".into(),
        Notice::GroundFound { ground, of } => {
            format!("{ground} of {of} points are on the ground, and are used").into()
        }
        Notice::GroundInDoubt { tiles, of, middle } => ground_in_doubt(*tiles, *of, *middle),
        Notice::OctreeLeftOut(path) => of_file(
            path,
            "LAZ in the order of the input; the octree of COPC is left out",
        ),
        Notice::PointsWithoutClassUsed(count) => points_without_class(*count).into(),
        Notice::AllClassesUsed => all_classes_used(),
        Notice::Reassigned { path, stated, assigned } => reassigned(path, stated, assigned),
        Notice::FirstOfBands(path, bands) => first_of_bands(path, *bands).into(),
        Notice::SystemOfOthers(path, crs) => system_of_others(path, crs),
        Notice::HeightsOfOthers(path, unit) => heights_of_others(path, unit).into(),
        Notice::NoSystem => no_system().into(),
        Notice::DifferentUnits(plan, height) => different_units(plan, height).into(),
        Notice::Reprojecting(from, to) => format!("reprojecting from {from} to {to}").into(),
        Notice::Transform(text) => text.clone().into(),
        Notice::PolygonsOutside(path, records) => polygons_outside(path, records),
        Notice::FacesOverlap(path, first) => faces_overlap(path, first),
        Notice::RingsOverlap(path, records) => rings_overlap(path, records),
        Notice::PolygonsPartlyOutside { path, partly, unit } => {
            polygons_partly_outside(path, partly, unit)
        }
        Notice::LinesOff(path, surface, lines) => {
            of_listed(path, lines, &format!("not on {surface}"))
        }
        Notice::LinesPartlyOff(path, surface, lines) => {
            of_listed(path, lines, &format!("only in part on {surface}"))
        }
        Notice::LinesWithoutLength(path, lines) => of_listed(path, lines, "no length"),
        Notice::SectionsCross { path, record, first, more, are_all } => {
            sections_cross(path, *record, first, *more, *are_all)
        }
        Notice::AttributesLeftOut(path) => {
            of_file(path, "attributes are kept of shapefiles and GeoJSON only")
        }
        Notice::PointsOutside {
            path,
            outside,
            points,
        } => of_file(
            path,
            &format!("{outside} of {points} points are outside of the surface"),
        ),
        Notice::CheckpointsOutside {
            path,
            counted_by,
            numbers,
        } => of_file(
            path,
            &format!(
                "{}: outside of the surface, and not counted",
                named(counted_by, numbers)
            ),
        ),
        Notice::FewCheckpoints(count) => {
            let decide = match count {
                1 => "1 checkpoint decides".to_owned(),
                count => format!("{count} checkpoints decide"),
            };
            format!("{decide}: the standard of ASPRS (2023) asks for at least 30").into()
        }
        Notice::HeightsInMeters => {
            "no coordinate system states the unit of heights: they are taken to be in meters".into()
        }
        Notice::FarApart(before, after, gap) => far_apart(before, after, gap).into(),
        Notice::BreaklinesApart(gap) => breaklines_apart(gap).into(),
        Notice::BreaklinesBeyond(reach) => breaklines_beyond(reach),
        Notice::FlatTriangles { count, share, has_ridges } => {
            flat_triangles(*count, *share, *has_ridges)
        }
        Notice::HeightsAboveEllipsoid(heights) => above_ellipsoid(*heights),
        Notice::BeyondBound { level, count, within, bound } => {
            beyond_bound(*level, *count, [*within, *bound])
        }
        Notice::Simplified { vertices, heights, bound, largest, root_mean_square, line_vertices } => {
            simplified([*vertices, *heights], [bound, largest, root_mean_square], *line_vertices).into()
        }
        Notice::RidgesAdded(count) => {
            format!("{count} vertices were added on ridges and valleys, with heights by the lines around them").into()
        }
        Notice::UnevenShores { lakes, name, height, largest } => {
            uneven_shores(*lakes, name, height, largest)
        }
        Notice::LakesJoined { lakes, name, to, by } => lakes_joined(*lakes, name, to, by).into(),
        Notice::WatersEnded { waters, name } => waters_ended(*waters, name),
        Notice::EdgeLimit(length) => edge_limit(length, ""),
        Notice::StandardEdgeLimit(length) => {
            edge_limit(length, ", and those with an angle over 165 degrees")
        }
        Notice::NoEdgeLimit => no_edge_limit(),
        Notice::BoundsBuffer(buffer) => bounds_buffer(buffer.as_ref()).into(),
        Notice::FilesOutside { left_out, files, are_searched, buffer } => {
            files_outside([*left_out, *files], *are_searched, buffer.as_ref()).into()
        }
        Notice::Triangulated(time) => format!("triangulated in {:.2} s", time.as_secs_f64()).into(),
        Notice::PartForLinear => part_for_linear(),
        Notice::Uncertain(count, buffer) => uncertain(*count, buffer).into(),
        Notice::CrossingsRounded { unit, on_grid } => rounded(unit, *on_grid).into(),
        Notice::EdgeLimitUnusual { limit, spacing } => unusual_edge_limit(limit, spacing),
        Notice::CapsLost { faces, share, points } => caps_lost(*faces, *share, *points),
        Notice::HullLost(share) => hull_lost(*share),
        Notice::LevelRings { rings, points, name, largest } => {
            level_rings(*rings, *points, name, largest)
        }
        Notice::RiverHeights {
            rivers, name, rising, largest_rise, rise_at, largest_difference, difference_at
        } => {
            let rise = banks_rise(*rising, largest_rise, *rise_at);
            let difference = banks_differ(largest_difference, *difference_at);
            format!("{}{rise}{difference}", banks(*rivers, name)).into()
        }
        Notice::RiversLowered { count, first } => rivers_lowered(*count, first).into(),
        Notice::RiverOverlap { rivers, name, at } => river_overlap(*rivers, name, *at).into(),
        Notice::WallsInWater { vertices, name, at } => walls_in_water(*vertices, name, *at).into(),
        Notice::WaterOverlaps { count, first } => water_overlaps(*count, first).into(),
        Notice::LinesApart(role) => lines_apart(*role),
        Notice::CrossingHeights { count, largest, at, .. } => {
            crossing_heights(*count, largest, *at).into()
        }
        Notice::ExtentApart => extent_apart(),
        Notice::DefaultResolution(width) => default_resolution(width),
        Notice::DefaultInterval(height) => default_interval(height),
        Notice::CoarseCoordinates { largest, tolerance } => coarse_coordinates(*largest, tolerance).into(),
        Notice::BeyondTolerance { deviation, tolerance } => beyond_tolerance(deviation, tolerance).into(),
        Notice::HeightFactor(factor) => height_factor(*factor),
        Notice::SteepAngles { factor, usual } => steep_angles(*factor, *usual),
        Notice::AnglesAsLengths(lengths) => angles_as_lengths(*lengths),
        Notice::DelaunayUnchecked(path) => delaunay_unchecked(path),
        Notice::RegionAreasUnused(path) => region_areas_unused(path),
        Notice::SeedUnused { path, line, seed, why } => seed_unused(path, *line, *seed, *why),
    }
}

fn layer_read(path: &Path, format: &str, records: usize) -> Wording {
    of_file(path, &format!("{format}, {records} records"))
}

fn little_memory(need: u64, left: u64, limit: &str) -> String {
    let [need, left] = [need, left].map(bytes);
    format!(
        "memory may not suffice: if all points are used they take about {need}, and {left} are left {limit}"
    )
}

fn built_in_files(memory: u64, folder: &Path) -> String {
    let (memory, folder) = (bytes(memory), folder.display());
    format!(
        "the points need more than {memory} of memory: their TIN is built in files first, in {folder}"
    )
}

fn output_may_not_fit(need: u64, free: u64) -> String {
    let [need, free] = [need, free].map(bytes);
    format!("the output may not fit: {need} before compression, {free} are free on the disk")
}

fn tasks_may_not_fit(need: u64, free: u64) -> String {
    let [need, free] = [need, free].map(bytes);
    format!(
        "the files of the tasks may not fit: the files of the tasks take about {need}, {free} are free on the disk"
    )
}

fn no_point_used(path: &Path, classes: Option<&[u8]>) -> Wording {
    let why = match classes {
        Some(classes) => {
            let classes: Vec<String> = classes.iter().map(u8::to_string).collect();
            format!("it has none of class {}", classes.join(" or "))
        }
        None => "it has none".to_owned(),
    };
    of_file(path, &format!("none of its points is used: {why}"))
}

fn no_point_of_class(classes: &[u8], unread: usize) -> String {
    let classes = listed(classes);
    match unread {
        0 => format!("no point has class {classes}"),
        1 => format!(
            "no point that was read has class {classes}; outside of the bounds, 1 file was not read"
        ),
        files => format!(
            "no point that was read has class {classes}; outside of the bounds, {files} files were not read"
        ),
    }
}

fn points_without_class(count: u64) -> String {
    format!("{count} points from files without classes are used, too")
}

fn points_without_return(count: u64) -> String {
    format!("{count} points do not say which return they are, and are used, too")
}

/// Lists numbers in ascending order; three and more in a row as a range.
fn listed(numbers: &[u8]) -> String {
    let runs = numbers.chunk_by(|a, b| a.checked_add(1) == Some(*b));
    let texts: Vec<String> = runs
        .flat_map(|run| match run {
            [first, _, .., last] => vec![format!("{first} to {last}")],
            few => few.iter().map(u8::to_string).collect(),
        })
        .collect();
    texts.join(", ")
}

fn all_classes_used() -> Wording {
    wording![
        "no point has class 2 (ground): all classes are used (choose with ",
        Setting::Class,
        ")"
    ]
}

fn far_apart(before: &Path, after: &Path, gap: &Quantity) -> String {
    format!(
        "{} and {} are {gap} apart, with nothing between them: are they in the same coordinate system?",
        before.display(),
        after.display()
    )
}

fn breaklines_apart(gap: &Quantity) -> String {
    format!(
        "the breaklines lie {gap} away from the points: are they in the same coordinate system?"
    )
}

fn breaklines_beyond(reach: &Quantity) -> Wording {
    wording![
        format!(
            "breaklines reach {reach} beyond the points: the surface there depends on them alone (clip with "
        ),
        Setting::Bounds,
        ")"
    ]
}

fn flat_triangles(count: usize, share: f64, has_ridges: bool) -> Wording {
    let flat = format!(
        "{count} triangles, {:.1} % of the area, are flat: all of their corners are on lines of one height",
        100.0 * share
    );
    if has_ridges {
        wording![
            flat,
            ", and no line beside them says whether the ground rises or falls"
        ]
    } else {
        wording![
            flat,
            " (",
            Setting::AddRidges,
            " adds vertices on ridges and valleys)"
        ]
    }
}

fn uneven_shores(lakes: usize, name: &str, height: &Quantity, largest: &Quantity) -> Wording {
    let shores = match lakes {
        1 => format!("the shore of {name} is not level: the lake has its lowest height, {height};"),
        count => format!(
            "the shores of {count} lakes are not level: each lake has the lowest height of its shore, such as {height} of {name};"
        ),
    };
    wording![
        format!("{shores} the shore rises up to {largest} above it ("),
        Setting::FlatHeight,
        ")"
    ]
}

fn lakes_joined(lakes: usize, name: &str, to: &str, by: &Quantity) -> String {
    match lakes {
        1 => format!(
            "{name} meets a larger lake, {to}, and has its height, which is {by} from its own"
        ),
        count => format!(
            "{count} lakes meet larger ones and have their heights: {name} that of {to}, which is {by} from its own"
        ),
    }
}

fn waters_ended(waters: usize, name: &str) -> Wording {
    let subject = match waters {
        1 => format!("{name} reaches beyond the points and ends"),
        count => format!("{count} lakes and rivers reach beyond the points and end"),
    };
    let which = match waters {
        1 => String::new(),
        _ => format!("; the first is {name}"),
    };
    wording![
        format!("{subject} at the rim that the surface has without water ("),
        Setting::MaxEdge,
        format!("){which}")
    ]
}

fn edge_limit(length: &Quantity, others: &str) -> Wording {
    wording![
        format!("triangles at the rim with edges over {length} are left out{others} ("),
        Setting::MaxEdge,
        ")"
    ]
}

fn no_edge_limit() -> Wording {
    wording![
        "the whole convex hull is kept (",
        Setting::MaxEdge.text("none"),
        ")"
    ]
}

fn unusual_edge_limit(limit: &Quantity, spacing: &Quantity) -> Wording {
    wording![
        format!(
            "the longest edge at the rim is {limit}, but points are {spacing} apart on average: choose it with "
        ),
        Setting::MaxEdge.number("LENGTH"),
        " or ",
        Setting::MaxEdge.text("auto"),
        ", which keep triangles with an angle over 165 degrees"
    ]
}

fn caps_lost(faces: u64, share: f64, points: u64) -> Wording {
    let of_points = match points {
        0 => String::new(),
        points => format!(", and all triangles of {points} points"),
    };
    wording![
        format!(
            "{faces} triangles with an angle over 165 degrees are left out at the rim, {:.1} % of the area{of_points} \
             (keep them with ",
            100.0 * share
        ),
        Setting::MaxEdge.number("LENGTH"),
        " or ",
        Setting::MaxEdge.text("none"),
        ")"
    ]
}

fn faces_overlap(path: &Path, first: &str) -> Wording {
    let path = path.display();
    wording![
        format!(
            "{path}: faces may overlap in plan ({first}): where several are, all of them count; "
        ),
        Command::Check.on(path.to_string()),
        " names all such places"
    ]
}

fn hull_lost(share: f64) -> Wording {
    wording![
        format!(
            "{:.1} % of the area of the convex hull is left out at the rim (keep it with ",
            100.0 * share
        ),
        Setting::MaxEdge.number("LENGTH"),
        " or ",
        Setting::MaxEdge.text("none"),
        ")"
    ]
}

fn bounds_buffer(buffer: Option<&Quantity>) -> String {
    let how_far = match buffer {
        None => "all points are used".to_owned(),
        Some(buffer) => format!("points up to {buffer} outside of the bounds are used"),
    };
    format!("{how_far}, so that the surface inside is the same as with all points")
}

fn part_for_linear() -> Wording {
    wording![
        "points far outside of the bounds were left out, because linear heights do not depend on them; near the bounds, heights by this method (",
        Setting::Method,
        ") can differ from those of all points: build the surface for it, or without ",
        Setting::Bounds
    ]
}

fn files_outside(
    [left_out, files]: [usize; 2],
    are_searched: bool,
    buffer: Option<&Quantity>,
) -> String {
    let how_far = buffer.map_or(String::new(), |buffer| format!("more than {buffer} "));
    let read = match are_searched {
        true => "are read only until one has a ground point, as no other file has",
        false => "are not read",
    };
    format!(
        "{left_out} of {files} files {read}: by their headers they lie {how_far}outside of the bounds"
    )
}

fn uncertain(count: usize, buffer: &Quantity) -> String {
    format!("{count} triangles within the bounds may depend on points further out than {buffer}")
}

fn level_rings(rings: usize, points: usize, name: &str, largest: &Quantity) -> Wording {
    let lines = if rings == 1 {
        "a closed line of one height has"
    } else {
        &format!("{rings} closed lines of one height have")
    };
    let inside = if points == 1 {
        "1 point"
    } else {
        &format!("{points} points")
    };
    wording![
        format!(
            "{lines} {inside} of other heights inside, by up to {largest} ({name}): for lakes, use "
        ),
        Setting::Flat
    ]
}

fn banks(rivers: usize, name: &str) -> String {
    let others = if rivers > 1 {
        &format!(" ({} others are not, either)", rivers - 1)
    } else {
        ""
    };
    format!("the banks of the river {name} are not level{others}")
}

fn banks_rise(vertices: usize, largest: &Quantity, at: [f64; 2]) -> String {
    let [x, y] = at.map(neat);
    match vertices {
        0 => String::new(),
        _ => format!(
            ": they rise downstream at {vertices} vertices, by up to {largest} (at {x} {y})"
        ),
    }
}

fn banks_differ(largest: &Quantity, at: [f64; 2]) -> String {
    let [x, y] = at.map(neat);
    match largest.value > 0.0 {
        true => format!("; they differ by up to {largest} across (at {x} {y})"),
        false => String::new(),
    }
}

fn rivers_lowered(count: usize, first: &[LoweredRiver]) -> String {
    if count == 1 {
        let lowerings: Vec<String> = first.iter().map(lowering).collect();
        return format!(
            "{}: if it should not be, correct the heights of either",
            lowerings.join(", ")
        );
    }
    format!(
        "{count} rivers are lowered to others that join them: correct the heights of those that are wrong"
    )
}

fn river_overlap(rivers: usize, name: &str, at: [f64; 2]) -> String {
    let [x, y] = at.map(neat);
    let others = if rivers > 1 {
        &format!(" (and {} others)", rivers - 1)
    } else {
        ""
    };
    format!(
        "the banks of the river {name} meet near {x} {y}{others}: what they enclose twice is not water; divide the \
         line, or make it narrower"
    )
}

fn walls_in_water(vertices: usize, name: &str, at: [f64; 2]) -> String {
    let [x, y] = at.map(neat);
    let count = if vertices == 1 {
        "1 vertex"
    } else {
        &format!("{vertices} vertices")
    };
    format!(
        "{count} of walls have the height of water, which counts first (at {x} {y} of {name}): draw walls behind the \
         shore, by more than their width"
    )
}

fn water_overlaps(count: usize, first: &[WaterStep]) -> String {
    if count == 1 {
        let steps: Vec<String> = first.iter().map(step).collect();
        return format!(
            "two waters overlap or touch, and the lower height, or that of the lake, counts: {}",
            steps.join(", ")
        );
    }
    format!(
        "{count} pairs of waters overlap or touch, and the lower height, or that of the lake, counts"
    )
}

fn crossing_heights(count: usize, largest: &Quantity, at: [f64; 2]) -> String {
    let points = if count == 1 {
        "1 point"
    } else {
        &format!("{count} points")
    };
    let [x, y] = at.map(neat);
    format!("breaklines meet with different heights at {points}, by up to {largest} (at {x} {y})")
}

fn lines_apart(role: LineRole) -> Wording {
    wording!["nothing of ", role.setting(), " lies on the surface"]
}

fn extent_apart() -> Wording {
    wording![
        "the rectangle of ",
        Setting::Extent,
        " does not touch the surface"
    ]
}

fn default_resolution(width: &Quantity) -> Wording {
    wording![
        format!("cells are {width} wide ("),
        Setting::Resolution,
        ")"
    ]
}

fn default_interval(height: &Quantity) -> Wording {
    wording![
        format!("contours are {height} apart ("),
        Setting::Interval,
        ")"
    ]
}

fn coarse_coordinates(largest: f64, tolerance: &Quantity) -> String {
    format!(
        "coordinates up to {largest:.1e} have too few digits for contours within {tolerance}: lines may meet; shift the input toward 0"
    )
}

fn beyond_tolerance(deviation: &Quantity, tolerance: &Quantity) -> String {
    format!(
        "lines are up to {deviation} off the surface, more than {tolerance}: coordinates have too few digits"
    )
}

fn height_factor(factor: f64) -> Wording {
    wording![
        format!(
            "heights are multiplied by {} to match the units of x and y (",
            number(factor)
        ),
        Setting::ZFactor,
        ")"
    ]
}

fn steep_angles(factor: f64, usual: f64) -> Wording {
    wording![
        format!(
            "coordinates are angles: with a factor of {}, slopes are {:.0} times too steep; twice the heights are ",
            number(factor),
            factor / usual
        ),
        Setting::ZFactor.number(format!("{:.2e}", 2.0 * usual)),
        "; without it, heights fit the angles"
    ]
}

fn angles_as_lengths([x, y]: [f64; 2]) -> Wording {
    wording![
        format!(
            "coordinates are angles: one unit of x is taken as {x:.0} units of the heights, one of y as \
             {y:.0}, as in the middle of the raster ("
        ),
        Setting::ZFactor,
        " sets a factor for both)"
    ]
}

fn delaunay_unchecked(path: &Path) -> Wording {
    of_file(
        path,
        "the format does not store breaklines: the Delaunay law is not checked",
    )
}

fn region_areas_unused(path: &Path) -> Wording {
    wording![
        format!(
            "{}: the largest areas of its regions are ignored: add ",
            path.display()
        ),
        Setting::RegionAreas.on(),
        " to use them"
    ]
}

fn seed_unused(path: &Path, line: usize, seed: Seed, why: SeedFlaw) -> Wording {
    let what = match seed {
        Seed::Hole => "hole",
        Seed::Region => "region",
    };
    let why = match why {
        SeedFlaw::OnSegment => "lies on a segment, so that its side is ambiguous",
        SeedFlaw::OutsideHull => "lies outside of the convex hull",
    };
    of_file(
        path,
        &format!("line {line}: the {what} {why}; it is not used"),
    )
}

fn skipped(why: &str, hole: Option<&Bounds>, others: &[PathBuf]) -> String {
    let Some(Bounds { min, max }) = hole else {
        return format!("skipped: {why}; its extent is not known: triangles may span it");
    };
    let [x0, y0, x1, y1] = [min[0], min[1], max[0], max[1]].map(neat);
    let others = match others {
        [] => String::new(),
        [one] => format!(", also where {} has points", one.display()),
        [one, more @ ..] => format!(
            ", also where {} and {} other files have points",
            one.display(),
            more.len()
        ),
    };
    format!("skipped: {why}; its extent is left empty, from {x0} {y0} to {x1} {y1}{others}")
}

fn rounded([x, y]: &[Quantity; 2], on_grid: bool) -> String {
    let unit = if x == y {
        x.to_string()
    } else {
        format!("{x} in x and {y} in y")
    };
    let bound = match on_grid {
        true => "no line moves by more than half of that on each axis",
        false => {
            "some vertices are not on this grid, so that no bound is proven for lines that cross near them"
        }
    };
    format!("crossings of breaklines are rounded to {unit}; {bound}")
}

//! Contours that a map can use.
//!
//! Exact contours of lidar are no map: most are shorter than ten meters, and jagged. Here the
//! surface is smoothed inside a tube, its contours are traced by [the rule](super), those that
//! enclose too little are left out, and the others are smoothed and simplified in a corridor:
//!
//! ```text
//! heights ──tube, nudge──▶ heights g on the same triangles ──▶ lines ──nests──▶ fewer lines
//!                                                                                   │
//!        lines ◀──pass B: the lattice shifted by half a cell──◀──pass A, cell by cell
//! ```
//!
//! # What is promised
//!
//! - **No line is off the surface by more than the tolerance.** Both surfaces are linear on the
//!   same triangles, so they differ most at vertices, by the tube at most. Lines differ from the
//!   smoothed surface by the corridor at most: each new segment is followed through the triangles,
//!   after rounding. The sum of both is the tolerance.
//! - **Lines of two levels do not meet**, as their corridors have nothing in common.
//! - **Lines of one level do not meet.** A vertex is removed, or moved, only if no vertex of the
//!   level lies in the triangle that is swept. A segment that enters an empty triangle leaves it
//!   through an old segment, which is excluded, or through the path of the vertex, which is tested.
//! - **Held edges are met where the smoothed surface says.** These points stay, and no new segment
//!   meets a held edge elsewhere: hard breaklines, walls, shores and banks.
//! - **The result is a function of the surface.** Cells of a lattice from coordinate 0 are worked
//!   on one by one, in the order of coordinates; chords and means stay inside a cell.

mod bands;
mod corridor;
mod fit;
mod labels;
mod lattice;
mod nests;
mod passes;
mod placing;
mod regions;
mod relax;
mod reshaped;
mod room;
mod rules;
mod strand;
mod thin;
mod tube;
mod work;

use rayon::prelude::*;

pub use self::bands::{Band, contour_bands};
use self::bands::{Named, bands_between, polygons, rim_arcs};
use self::corridor::Corridor;
pub use self::labels::{ContourLabel, LabelRules, LabelTops, contour_labels};
use self::lattice::{Lattice, RingStart, Tracked};
use self::nests::{Nests, SmallSide, small_side};
use self::passes::Pass;
use self::regions::Regions;
use self::reshaped::Reshaped;
pub use self::rules::MapRules;
use self::rules::Scale;
use self::tube::{nudge, smoothed};
pub use self::work::GoOn;
use super::contours;
use super::index::LevelIndex;
use super::line::start_at_smallest;
use crate::data::{ContourLine, Surface, bounds_of_faces, doubled_area};
use crate::error::{Error, Result};
use crate::terrain::in_order::in_order;
use crate::terrain::walk::{At, Locator};
use crate::terrain::{Levels, vertices_along};

/// The contours of a surface for a map.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MapContours {
    /// The lines, sorted by level and then by their points. Higher ground is on the right; a ring
    /// starts at its smallest point.
    pub lines: Vec<MapLine>,
    /// The number of lines before some were left out.
    pub traced: usize,
    /// The largest difference between the height of a line and the surface along it, in the unit
    /// of the heights.
    pub deviation: f64,
    /// The areas between the lines, if they were [asked for](MapRules::with_bands), from the lowest
    /// to the highest; see [`contour_bands`].
    pub bands: Vec<Band>,
}

/// A contour of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapLine {
    /// The line.
    pub line: ContourLine,
    /// How many intervals its level is above the base; of listed levels, the position in the list.
    pub number: i64,
    /// True for a ring with lower ground inside.
    pub is_depression: bool,
}

/// Returns the contours of a surface for a map; those of [`contours`] if the rules ask for nothing.
///
/// Plan and heights are in one unit. Heights are smoothed by quadrics fitted around each vertex,
/// never across breaklines, walls, shores and banks; small lines are bridges in the graph of
/// regions (Tarjan 1974); lines are simplified by the areas of triangles (Visvalingam and Whyatt
/// 1993). No line is off the surface by more than the rules say, and no two meet.
///
/// # Errors
/// Those of [`MapRules::check`] and [`contours`]; with bands, those of [`contour_bands`]; and if
/// the surface was found damaged.
///
/// # Complexity
/// Linear in the vertices, times those within eight intervals of each, or within ten mean distances
/// of vertices if these are less; and in the points of the lines, times those of a level in a cell
/// of 64 intervals. On all threads, but for the graph of regions and the edges between vertices.
/// About 100 bytes for each vertex, 10 for each face, and 80 for each point of the lines before
/// they are simplified.
pub fn map_contours(
    surface: &dyn Surface,
    levels: &Levels,
    rules: &MapRules,
) -> Result<MapContours> {
    map_contours_while(surface, levels, rules, &|_| Ok(()))
}

/// Returns the most work that [`map_contours_while`] counts, in vertices, each of which counts up
/// to six times; 0 if lines are not moved.
pub fn map_work(surface: &dyn Surface, rules: &MapRules) -> u64 {
    let times = match (rules.smooth, rules.simplify) {
        (Some(_), _) => tube::PASSES as u64 + 2,
        (None, Some(_)) => 2,
        (None, None) => 0,
    };
    times * surface.vertex_count() as u64
}

/// Like [`map_contours`], but work is counted and can be stopped by `go_on`. It is called while
/// heights are smoothed and lines are worked on, but not while the surface is indexed, traced or
/// divided into regions.
///
/// # Errors
/// Those of [`map_contours`], and that of `go_on`.
///
/// # Complexity
/// That of [`map_contours`].
pub fn map_contours_while(
    surface: &dyn Surface,
    levels: &Levels,
    rules: &MapRules,
    go_on: GoOn,
) -> Result<MapContours> {
    rules.check(levels)?;
    if rules.keeps_exact() {
        let lines = contours(surface, levels)?.collect();
        return map_of_contours(surface, lines, levels, rules);
    }
    let bounds = bounds_of_faces(surface);
    let [lowest, highest] = [bounds.min[2], bounds.max[2]];
    let scale = Scale::of(rules, levels, &bounds);
    let margin = scale.interval;
    let index = LevelIndex::new(levels.within(lowest - margin, highest + margin)?);
    let mut heights = match rules.smooth {
        Some(_) => smoothed(surface, scale.tube, go_on)?,
        None => (0..surface.vertex_count() as u32)
            .map(|vertex| surface.position(vertex)[2])
            .collect(),
    };
    nudge(&mut heights, index.levels(), scale.delta);
    let smooth = Reshaped { surface, heights };
    let lines: Vec<ContourLine> = contours(&smooth as &dyn Surface, levels)?.collect();
    let traced: Vec<Traced> = lines.par_iter().map(Traced::of).collect();
    let corridor = Corridor::new(&smooth, &index, scale.corridor, go_on);
    let locator = Locator::new(&smooth)?;
    let regions = Regions::of(&smooth, &index);
    let lines: Vec<Tracked> = lines
        .into_par_iter()
        .map(|line| {
            go_on(0)?;
            Ok(Tracked {
                level: index.first_from(line.level),
                at: corridor.spots(&locator, &line.points),
                points: line.points,
            })
        })
        .collect::<Result<_>>()?;
    let sides = lines
        .par_iter()
        .map(|line| sides_of(line, &smooth, &locator, &regions));
    let mut nests = Nests::new(sides.collect(), regions.count);
    let extents = regions.extents(scale.interval);
    let small: Vec<Option<SmallSide>> = nests
        .sides(&extents)
        .into_iter()
        .zip(&traced)
        .map(|(sides, line)| Some(small_side(sides?, line.turns_left)))
        .collect();
    let is_small = |line: usize, side: &SmallSide| {
        let area = side.extent.area_in(scale.interval);
        let Traced { level, turns_left } = traced[line];
        let relief = side.extent.highest.max(level) - side.extent.lowest.min(level);
        let is_kept = rules.keeps(area, relief / scale.interval)
            || (rules.keep_depressions && turns_left == Some(true));
        !is_kept
    };
    remove_where(&mut nests, &small, is_small);
    let kept: Vec<usize> = (0..traced.len())
        .filter(|&line| !nests.is_removed(line))
        .collect();
    let mut lines: Vec<Option<Tracked>> = lines.into_iter().map(Some).collect();
    let mut drawn: Vec<Tracked> = kept.iter().filter_map(|&line| lines[line].take()).collect();
    drop(lines);
    if rules.smooth.is_some() || rules.simplify.is_some() {
        for pass in passes(rules, &scale) {
            drawn = pass.run(drawn, index.levels(), &corridor, &locator)?;
        }
    }
    let mut lengths = vec![f64::INFINITY; traced.len()];
    for (&line, drawn) in kept.iter().zip(&drawn) {
        lengths[line] = length(&drawn.points);
    }
    if rules.min_length > 0.0 {
        let has_longer = nests.sides_with(|line| lengths[line] >= rules.min_length);
        remove_where(&mut nests, &small, |line, side| {
            // A short line across a neck has half of the surface on its small side.
            let is_alone = has_longer[line].is_some_and(|longer| !longer[side.side]);
            lengths[line] < rules.min_length && is_alone
        });
    }
    let mut found: Vec<MapLine> = kept
        .iter()
        .zip(drawn)
        .filter(|&(&line, _)| !nests.is_removed(line))
        .map(|(&line, drawn)| finished(&traced[line], levels, drawn.points))
        .collect();
    found.sort_by(|a, b| {
        let by_level = a.line.level.total_cmp(&b.line.level);
        by_level.then_with(|| in_order(&a.line.points, &b.line.points))
    });
    let bands = if rules.with_bands {
        let of_lines: Vec<usize> = traced.iter().map(|l| index.first_from(l.level)).collect();
        let bands = nests.bands(&of_lines, &regions.bands(), &extents);
        let rim = rim_arcs(&smooth, &index, &regions, &bands);
        let named = Named {
            levels,
            index: &index,
            heights: [lowest, highest],
        };
        polygons(&named, found.iter().map(|line| &line.line), rim)?
    } else {
        Vec::new()
    };
    Ok(MapContours {
        traced: traced.len(),
        deviation: deviation(surface, &found, go_on)?,
        lines: found,
        bands,
    })
}

/// Returns exact contours of a surface as those of a map, in their order. The lines are all that
/// [`contours`] finds at the levels, and the rules [keep](MapRules::keeps_exact) them.
///
/// # Errors
/// If the rules do not keep contours exact; and those of [`contour_bands`], if bands are asked for.
///
/// # Complexity
/// Linear, besides that of [`contour_bands`].
pub fn map_of_contours(
    surface: &dyn Surface,
    lines: Vec<ContourLine>,
    levels: &Levels,
    rules: &MapRules,
) -> Result<MapContours> {
    if !rules.keeps_exact() {
        return Err(Error::usage(
            "contours that are traced already cannot be smoothed, simplified or left out",
        )
        .cure("pass rules that keep contours exact"));
    }
    let finish = |line: ContourLine| finished(&Traced::of(&line), levels, line.points);
    let lines: Vec<MapLine> = lines.into_iter().map(finish).collect();
    let bands = match rules.with_bands {
        true => bands_between(surface, levels, lines.iter().map(|line| &line.line))?,
        false => Vec::new(),
    };
    Ok(MapContours {
        traced: lines.len(),
        deviation: 0.0,
        lines,
        bands,
    })
}

/// Removes the lines whose small side is not wanted, with what is in it; those with the largest
/// sides first, because the others are often inside.
fn remove_where(
    nests: &mut Nests,
    small: &[Option<SmallSide>],
    is_small: impl Fn(usize, &SmallSide) -> bool,
) {
    let of_line = |(line, side): (usize, &Option<SmallSide>)| {
        let side = (*side)?;
        (!nests.is_removed(line) && is_small(line, &side)).then_some((line, side))
    };
    let mut removed: Vec<(usize, SmallSide)> =
        small.iter().enumerate().filter_map(of_line).collect();
    removed.sort_by_key(|(_, side)| std::cmp::Reverse(side.extent.area));
    for (line, side) in removed {
        nests.remove(line, side.side);
    }
}

/// Returns both passes: the lattice of the second one is shifted by half a cell, so that it rounds
/// what the first one has fixed.
fn passes(rules: &MapRules, scale: &Scale) -> [Pass; 2] {
    let size = scale.cell;
    let relaxing = rules.smooth.map(|_| scale.relaxing);
    let pass = |origin, start, tolerance| Pass {
        lattice: Lattice {
            size,
            origin,
            start,
        },
        relaxing,
        tolerance,
    };
    [
        pass(0.0, RingStart::Least, rules.simplify.map(|d| d / 3.0)),
        pass(size / 2.0, RingStart::Greatest, rules.simplify),
    ]
}

/// Returns the regions on the left and on the right of a line, by the first of its segments that
/// lies inside of a face.
fn sides_of(
    line: &Tracked,
    surface: &Reshaped<'_>,
    locator: &Locator<'_>,
    regions: &Regions<'_>,
) -> Option<[u32; 2]> {
    line.points.windows(2).find_map(|ends| {
        let middle = [0, 1].map(|axis| 0.5 * ends[0][axis] + 0.5 * ends[1][axis]);
        let At::Inside { face } = locator.at(middle) else {
            return None;
        };
        surface.face(face)?;
        let [below, above] = [line.level, line.level + 1].map(|band| regions.region(face, band));
        Some([below?, above?])
    })
}

/// What stays of a line while its points change.
#[derive(Debug, Clone, Copy)]
struct Traced {
    level: f64,
    /// True if it is a counter-clockwise ring; `None` for an open line.
    turns_left: Option<bool>,
}

impl Traced {
    fn of(line: &ContourLine) -> Self {
        Traced {
            level: line.level,
            turns_left: line.is_closed().then(|| doubled_area(&line.points) > 0.0),
        }
    }
}

fn length(points: &[[f64; 2]]) -> f64 {
    vertices_along(points).last().copied().unwrap_or(0.0)
}

/// Returns a line as it is drawn; a ring starts at its smallest point.
fn finished(traced: &Traced, levels: &Levels, mut points: Vec<[f64; 2]>) -> MapLine {
    if traced.turns_left.is_some() {
        points.pop();
        start_at_smallest(&mut points);
        points.extend_from_within(..1);
    }
    MapLine {
        is_depression: traced.turns_left == Some(true),
        number: levels.number_of(traced.level),
        line: ContourLine {
            level: traced.level,
            points,
        },
    }
}

/// Returns the largest difference between the heights of lines and a surface along them. Parts that
/// rounding moves beyond the rim do not count.
fn deviation(surface: &dyn Surface, lines: &[MapLine], go_on: GoOn) -> Result<f64> {
    let locator = Locator::new(surface)?;
    let of_line = |MapLine { line, .. }: &MapLine| {
        go_on(0)?;
        let stretches = locator.along(&line.points)?;
        let points = stretches.iter().flat_map(|stretch| stretch.iter());
        Ok(points.fold(0.0, |most: f64, p| most.max((p.at[2] - line.level).abs())))
    };
    lines
        .par_iter()
        .map(of_line)
        .try_reduce(|| 0.0, |a, b| Ok(a.max(b)))
}

//! The areas between contours, as polygons.

use rayon::prelude::*;

use super::regions::Regions;
use crate::data::{ContourLine, Surface, bounds_of_faces, corners};
use crate::error::Result;
use crate::terrain::Levels;
use crate::terrain::contour::index::LevelIndex;
use crate::terrain::contour::{Polygons, contours, crossing};
use crate::terrain::in_order::in_order;
use crate::terrain::linear::plan;

/// An area of a surface between two levels next to each other, in the units of the data.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Band {
    /// The level below; the lowest height of the surface if there is none.
    pub low: f64,
    /// The level above; the largest height of the surface if there is none.
    pub high: f64,
    /// The rings, each with its first vertex repeated at the end: the outer one is clockwise and
    /// first, those of holes are counter-clockwise.
    pub rings: Vec<Vec<[f64; 2]>>,
}

/// An arc that has its band on its right.
type Arc = (usize, [[f64; 2]; 2]);

/// Returns the areas between the exact contours of a surface, from the lowest to the highest: see
/// [`contours`]. A level belongs to the band above it.
///
/// The polygons cover the surface. Each is valid by the rules of the OGC: rings are simple, touch
/// in points at most, and what they bound is connected.
///
/// # Errors
/// Those of [`contours`], and if a coordinate is not covered by the arithmetic.
///
/// # Complexity
/// Linear in the faces, and expected O(n log n) in the n arcs of lines and the rim, with about 300
/// bytes for each; bands are made on all threads.
pub fn contour_bands(surface: &dyn Surface, levels: &Levels) -> Result<Vec<Band>> {
    let lines: Vec<ContourLine> = contours(surface, levels)?.collect();
    bands_between(surface, levels, lines.iter())
}

/// Returns the areas between lines, which are all the contours of a surface.
pub(super) fn bands_between<'a>(
    surface: &dyn Surface,
    levels: &Levels,
    lines: impl Iterator<Item = &'a ContourLine>,
) -> Result<Vec<Band>> {
    let bounds = bounds_of_faces(surface);
    let heights = [bounds.min[2], bounds.max[2]];
    let index = LevelIndex::new(levels.within(heights[0], heights[1])?);
    let regions = Regions::of(surface, &index);
    let own = regions.bands();
    let named = Named {
        levels,
        index: &index,
        heights,
    };
    polygons(&named, lines, rim_arcs(surface, &index, &regions, &own))
}

/// The heights by which bands are named: levels, and the lowest and the highest of the surface.
pub(super) struct Named<'a> {
    pub(super) levels: &'a Levels,
    pub(super) index: &'a LevelIndex,
    /// The lowest and the highest height of the surface.
    pub(super) heights: [f64; 2],
}

impl Named<'_> {
    /// Returns the heights between which a band is.
    fn range(&self, band: usize) -> [f64; 2] {
        let found = self.index.levels();
        let [low, high] = self.heights;
        let below = band.checked_sub(1).and_then(|k| found.get(k)).copied();
        let above = found.get(band).copied();
        [
            below.unwrap_or_else(|| self.levels.around(low)[0].unwrap_or(low)),
            above.unwrap_or_else(|| self.levels.around(high)[1].unwrap_or(high)),
        ]
    }
}

/// Returns the polygons that lines and a rim bound, by bands and then by their rings.
pub(super) fn polygons<'a>(
    named: &Named<'_>,
    lines: impl Iterator<Item = &'a ContourLine>,
    mut arcs: Vec<Arc>,
) -> Result<Vec<Band>> {
    for line in lines {
        let level = named.index.first_from(line.level);
        for ends in line.points.windows(2) {
            arcs.push((level + 1, [ends[0], ends[1]]));
            arcs.push((level, [ends[1], ends[0]]));
        }
    }
    arcs.par_sort_unstable_by(in_order);
    let of_bands: Vec<&[Arc]> = arcs.chunk_by(|a, b| a.0 == b.0).collect();
    let polygons_of = |arcs: &&[Arc]| {
        let [low, high] = named.range(arcs[0].0);
        let bare: Vec<[[f64; 2]; 2]> = arcs.iter().map(|arc| arc.1).collect();
        let mut polygons = Polygons::new(&bare)?.rings;
        polygons.retain(|rings| !rings.is_empty());
        polygons.sort_by(in_order);
        let band = |rings| Band { low, high, rings };
        Ok(polygons.into_iter().map(band).collect::<Vec<Band>>())
    };
    let found: Vec<Vec<Band>> = of_bands
        .par_iter()
        .map(polygons_of)
        .collect::<Result<_>>()?;
    Ok(found.into_iter().flatten().collect())
}

/// Returns the rim of a surface, cut where bands change.
pub(super) fn rim_arcs(
    surface: &dyn Surface,
    index: &LevelIndex,
    regions: &Regions<'_>,
    bands: &[usize],
) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for (face, vertices) in corners(surface) {
        for i in (0..3).filter(|&i| surface.neighbor(face, i).is_none()) {
            let ends = [1, 2].map(|k| surface.position(vertices[(i + k) % 3]));
            let Some(beside) = regions.beside(face, i) else {
                continue;
            };
            let is_rising = ends[0][2] <= ends[1][2];
            let [low, high] = if is_rising { ends } else { [ends[1], ends[0]] };
            let mut add = |band: usize, from: [f64; 2], to: [f64; 2]| {
                if from != to {
                    // The face is on the left of its edges.
                    arcs.push((band, if is_rising { [to, from] } else { [from, to] }));
                }
            };
            let mut from = plan(low);
            let mut current = None;
            for part in beside {
                let band = regions
                    .region(face, part)
                    .map(|region| bands[region as usize]);
                if let (Some(before), true) = (current, band != current) {
                    let level = index.levels()[part - 1];
                    let at = crossing(low, high, level);
                    add(before, from, at);
                    from = at;
                }
                current = band.or(current);
            }
            if let Some(band) = current {
                add(band, from, plan(high));
            }
        }
    }
    arcs
}

//! The regions that the contours of a surface divide it into.
//!
//! Between two levels next to each other is a band. A face has a part in each band that its heights
//! reach; parts of one band that share a length of an edge belong to one region:
//!
//! ```text
//!           +
//!          / \      band 2
//!     ----x---x---- level 2
//!        /     \    band 1: three faces have parts in this region
//!     --x-------x-- level 1
//!      /         \  band 0
//!     -           -
//! ```
//!
//! As in [the rule](crate::terrain::contour), a level belongs to the band above it: a face that is
//! level itself, too, and ground that reaches a level at a vertex or an edge only does not.

use std::cmp::Ordering;
use std::ops::Range;

use crate::data::{Surface, corners};
use crate::terrain::contour::index::LevelIndex;

/// How many units of areas there are in the square of the scale.
const UNITS: f64 = (1_u64 << 40) as f64;

/// Parts of faces, each with the region that it is in.
pub(super) struct Regions<'a> {
    surface: &'a dyn Surface,
    index: &'a LevelIndex,
    /// The number of the first part of each face, and that after the last of all.
    starts: Vec<u32>,
    /// The region of each part.
    of_parts: Vec<u32>,
    /// The number of regions.
    pub(super) count: usize,
}

/// What is known of a region, or of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    /// The area in plan, in units that do not round when they are added.
    pub(super) area: i128,
    pub(super) lowest: f64,
    pub(super) highest: f64,
}

impl Extent {
    pub(super) const NOTHING: Extent = Extent {
        area: 0,
        lowest: f64::INFINITY,
        highest: f64::NEG_INFINITY,
    };

    pub(super) fn and(self, other: Extent) -> Extent {
        Extent {
            area: self.area + other.area,
            lowest: self.lowest.min(other.lowest),
            highest: self.highest.max(other.highest),
        }
    }

    /// Returns the area in squares of the plan.
    pub(super) fn area_in(self, scale: f64) -> f64 {
        self.area as f64 / UNITS * scale * scale
    }
}

impl<'a> Regions<'a> {
    /// Finds the regions between the levels.
    ///
    /// # Complexity
    /// Near linear in the faces and the arcs of contours, on one thread; 4 bytes for each face and
    /// 4 for each of its parts.
    pub(super) fn of(surface: &'a dyn Surface, index: &'a LevelIndex) -> Self {
        let mut starts = vec![0; surface.face_count() + 1];
        for (face, vertices) in corners(surface) {
            let heights = vertices.map(|v| surface.position(v)[2]);
            starts[face as usize + 1] = bands_of(index, heights).len() as u32;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let parts = starts.last().copied().unwrap_or(0);
        let mut regions = Regions {
            surface,
            index,
            starts,
            of_parts: (0..parts).collect(),
            count: 0,
        };
        regions.join_neighbors();
        regions.number();
        regions
    }

    fn join_neighbors(&mut self) {
        let surface = self.surface;
        for (face, vertices) in corners(surface) {
            for i in 0..3 {
                let other = surface.neighbor(face, i).filter(|&other| other > face);
                // By corners: a vertex that two parts share has a number in each of them.
                let Some(across) = other.and_then(|_| surface.across(face, i)) else {
                    continue;
                };
                let other = across.number;
                let [ends @ .., own] =
                    [1, 2, 0].map(|k| surface.position(vertices[(i + k) % 3])[2]);
                let [own, its] = [own, across.apex[2]].map(|apex| beside(self.index, ends, apex));
                for band in own.start.max(its.start)..own.end.min(its.end) {
                    if let (Some(a), Some(b)) = (self.part(face, band), self.part(other, band)) {
                        self.join(a, b);
                    }
                }
            }
        }
    }

    /// Returns the number of the part of a face in a band.
    fn part(&self, face: u32, band: usize) -> Option<u32> {
        let heights = self.surface.triangle(face)?.map(|p| p[2]);
        let bands = bands_of(self.index, heights);
        let start = *self.starts.get(face as usize)?;
        bands
            .contains(&band)
            .then(|| start + (band - bands.start) as u32)
    }

    /// Returns the region of a face in a band; `None` if the face has no part in it.
    pub(super) fn region(&self, face: u32, band: usize) -> Option<u32> {
        self.of_parts.get(self.part(face, band)? as usize).copied()
    }

    /// Returns the bands beside an edge, on the side of a face, from the first end of the edge to
    /// the second one: ascending or descending.
    pub(super) fn beside(&self, face: u32, i: usize) -> Option<Range<usize>> {
        let heights = self.surface.triangle(face)?.map(|p| p[2]);
        Some(beside(
            self.index,
            [heights[(i + 1) % 3], heights[(i + 2) % 3]],
            heights[i],
        ))
    }

    fn root(&mut self, mut part: u32) -> u32 {
        while self.of_parts[part as usize] != part {
            let above = self.of_parts[part as usize];
            self.of_parts[part as usize] = self.of_parts[above as usize];
            part = above;
        }
        part
    }

    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [a, b].map(|part| self.root(part));
        self.of_parts[a.max(b) as usize] = a.min(b);
    }

    /// Replaces roots by numbers from 0.
    fn number(&mut self) {
        let mut count = 0;
        for part in 0..self.of_parts.len() {
            let above = self.of_parts[part] as usize;
            // Those above have smaller numbers, and have their regions already.
            self.of_parts[part] = if above == part {
                count += 1;
                count - 1
            } else {
                self.of_parts[above]
            };
        }
        self.count = count as usize;
    }

    /// Returns the band of each region.
    pub(super) fn bands(&self) -> Vec<usize> {
        let mut bands = vec![0; self.count];
        for (face, vertices) in corners(self.surface) {
            let of_face = bands_of(self.index, vertices.map(|v| self.surface.position(v)[2]));
            let start = self.starts[face as usize] as usize;
            for (band, &region) in of_face.zip(&self.of_parts[start..]) {
                bands[region as usize] = band;
            }
        }
        bands
    }

    /// Returns the extent of each region, in units of a scale.
    ///
    /// # Complexity
    /// Linear; 48 bytes for each region.
    pub(super) fn extents(&self, scale: f64) -> Vec<Extent> {
        let mut extents = vec![Extent::NOTHING; self.count];
        for (face, vertices) in corners(self.surface) {
            let triangle = vertices.map(|v| self.surface.position(v));
            let bands = bands_of(self.index, triangle.map(|p| p[2]));
            let mut below = 0;
            let mut from = f64::NEG_INFINITY;
            let start = self.starts[face as usize] as usize;
            for (band, &region) in bands.zip(&self.of_parts[start..]) {
                let to = self.index.levels().get(band).copied();
                let upto =
                    units(area_below(triangle, to.unwrap_or(f64::INFINITY)) / (scale * scale));
                let heights = triangle.map(|p| p[2].max(from).min(to.unwrap_or(f64::INFINITY)));
                let part = Extent {
                    area: upto - below,
                    lowest: heights[0].min(heights[1]).min(heights[2]),
                    highest: heights[0].max(heights[1]).max(heights[2]),
                };
                let extent = &mut extents[region as usize];
                *extent = extent.and(part);
                (below, from) = (upto, to.unwrap_or(from));
            }
        }
        extents
    }
}

fn units(area: f64) -> i128 {
    (area * UNITS).round() as i128
}

/// Returns the bands in which a face has a part with an inside.
fn bands_of(index: &LevelIndex, [a, b, c]: [f64; 3]) -> Range<usize> {
    between(index, a.min(b).min(c), a.max(b).max(c))
}

/// Returns the bands of the heights between two, or that of one height.
fn between(index: &LevelIndex, low: f64, high: f64) -> Range<usize> {
    let at_or_below = |height: f64| {
        let first = index.first_from(height);
        first + usize::from(index.levels().get(first) == Some(&height))
    };
    let first = at_or_below(low);
    first..if low < high {
        index.first_from(high) + 1
    } else {
        first + 1
    }
}

/// Returns the bands along an edge, on the side of a third corner.
fn beside(index: &LevelIndex, [a, b]: [f64; 2], apex: f64) -> Range<usize> {
    let all = between(index, a.min(b), a.max(b));
    match apex.partial_cmp(&a) {
        // The side of an edge on a level that is below it.
        Some(Ordering::Less) if a == b => {
            let first = index.first_from(a);
            first..first + 1
        }
        _ => all,
    }
}

/// Returns the area of the part of a triangle that is below a height.
fn area_below(triangle: [[f64; 3]; 3], height: f64) -> f64 {
    let [[ax, ay, _], [bx, by, _], [cx, cy, _]] = triangle;
    let whole = 0.5 * ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)).abs();
    let mut heights = triangle.map(|p| p[2]);
    heights.sort_by(f64::total_cmp);
    let [low, middle, high] = heights;
    if height >= high {
        whole
    } else if height <= low {
        0.0
    } else if height <= middle {
        let share = (height - low) / (high - low) * ((height - low) / (middle - low));
        whole * share
    } else {
        let share = (high - height) / (high - low) * ((high - height) / (high - middle));
        whole * (1.0 - share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_triangle_have_its_area() {
        let triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [0.0, 4.0, 8.0]];
        assert_eq!(area_below(triangle, -1.0), 0.0);
        assert_eq!(area_below(triangle, 4.0), 4.0);
        assert_eq!(area_below(triangle, 6.0), 7.0);
        assert_eq!(area_below(triangle, 8.0), 8.0);
    }

    #[test]
    fn a_level_belongs_to_the_band_above() {
        let index = LevelIndex::new(vec![1.0, 2.0]);
        for (heights, expected) in [
            ([0.0, 0.5, 0.9], 0..1),
            ([0.0, 0.5, 1.0], 0..1),
            ([1.0, 1.0, 1.0], 1..2),
            ([1.0, 1.0, 0.0], 0..1),
            ([1.0, 1.5, 2.0], 1..2),
            ([0.0, 1.5, 3.0], 0..3),
            ([2.0, 2.0, 2.0], 2..3),
        ] {
            assert_eq!(bands_of(&index, heights), expected, "{heights:?}");
        }
        assert_eq!(beside(&index, [1.0, 1.0], 0.0), 0..1);
        assert_eq!(beside(&index, [1.0, 1.0], 1.0), 1..2);
        assert_eq!(beside(&index, [1.0, 1.0], 3.0), 1..2);
        assert_eq!(beside(&index, [3.0, 1.0], 0.0), 1..3);
    }
}

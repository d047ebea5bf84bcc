//! Volumes between a surface and another one, or a level.

mod integral;
mod sum;
mod zones;

use std::convert::Infallible;
use std::ops::RangeInclusive;

pub(super) use self::integral::integral;
pub(super) use self::sum::Sum;
use self::sum::Unit;
pub use self::zones::Zones;
use super::overlay::{Corner, Number, Overlap, from_least, overlay};
use crate::data::{Bounds, Surface, bounds_of_faces, map_batches};
use crate::error::{Error, Result};

/// The sizes of surfaces, along each axis, whose volumes are numbers.
const SIZES: RangeInclusive<f64> = 1e-80..=1e80;

/// A bound on the errors of areas, relative to all.
const ROUNDING: f64 = 1e-12;

/// The rounding errors of heights on a surface, relative to the largest of these.
const HEIGHT_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// What a surface is compared with.
#[derive(Clone, Copy)]
pub enum VolumeBase<'a> {
    /// Another surface.
    Surface(&'a dyn Surface),
    /// A level plane at this height.
    Level(f64),
}

/// Volumes and areas between a surface and its base, in an area of the plan. Where only one of them
/// is, nothing counts but its area.
///
/// Lengths and heights are in the units of the data: an area is in squares of the unit of the plan,
/// a volume is such an area times the unit of the heights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Volume {
    /// The volume of the surface above its base: what is to be removed to get to the base.
    pub cut: f64,
    /// The volume of the base above the surface: what is to be added to get to the base.
    pub fill: f64,
    /// The area in plan where the surface is above its base.
    pub cut_area: f64,
    /// The area in plan where the base is above the surface.
    pub fill_area: f64,
    /// The area in plan where both are; [`level_area`](Self::level_area) is what is neither cut nor
    /// fill.
    pub common_area: f64,
    /// The area in plan where only the surface is.
    pub surface_only_area: f64,
    /// The area in plan where only the base is; 0 if that is a level plane.
    pub base_only_area: f64,
    /// The area of the surface itself, along its slopes, wherever it is.
    pub slope_area: f64,
}

impl Volume {
    /// Returns the cut minus the fill: the integral of the surface minus its base.
    pub fn net(&self) -> f64 {
        self.cut - self.fill
    }

    /// Returns the area in plan where both are equally high; 0 if it is no more than the rounding
    /// errors of the others.
    pub fn level_area(&self) -> f64 {
        let level = self.common_area - self.cut_area - self.fill_area;
        if level > ROUNDING * self.common_area {
            level
        } else {
            0.0
        }
    }

    /// Returns the volumes, but with a cut or a fill of 0 if it is no larger than what rounding the
    /// heights of the base can cause. The corners of a base that is taken from the surface are
    /// rounded: without this, a plane would have a cut.
    ///
    /// # Complexity
    /// Linear in the faces of the base.
    pub(crate) fn level_within_rounding(mut self, base: &dyn Surface) -> Self {
        let most = HEIGHT_ROUNDING * bounds_of_faces(base).largest(2) * self.common_area;
        for (volume, area) in [
            (&mut self.cut, &mut self.cut_area),
            (&mut self.fill, &mut self.fill_area),
        ] {
            if *volume <= most {
                (*volume, *area) = (0.0, 0.0);
            }
        }
        self
    }
}

/// Returns the volumes between a surface and its base: in each zone, or of the whole if there are
/// none. `height_unit` is the unit of the heights in units of the plan, on which areas along slopes
/// depend: 1 if they are the same.
///
/// Sums are exact: results depend on the faces alone, not on their order or on the number of
/// threads, and with the surfaces exchanged cut and fill are exchanged, bit for bit. What is added,
/// the volume over what a face of each has in common, is known up to a few rounding errors of its
/// own size. So the result has 12 digits and more, relative to cut plus fill; where surfaces are
/// about equal, relative to the area times the range of heights.
///
/// # Errors
/// If the level is not finite, the surfaces extend so far that products of their sizes are no
/// numbers, or a surface was found damaged.
///
/// # Complexity
/// O((n + k) log n) for n faces and k pairs of faces that overlap, on all threads; each zone adds
/// the time for the pairs in it. About 40 bytes for each face of the surface that has fewer.
pub fn volumes(
    surface: &dyn Surface,
    base: VolumeBase<'_>,
    zones: Option<&Zones>,
    height_unit: f64,
) -> Result<Vec<Volume>> {
    let mut around = bounds_of_faces(surface);
    match base {
        VolumeBase::Surface(other) => around.merge(&bounds_of_faces(other)),
        VolumeBase::Level(height) if !height.is_finite() => {
            return Err(Error::usage(format!("{height} is not a height"))
                .cure("give the level as a finite number"));
        }
        VolumeBase::Level(height) => {
            around.min[2] = around.min[2].min(height);
            around.max[2] = around.max[2].max(height);
        }
    }
    let units = Units::within(&around, height_unit)?;
    let rows = Rows {
        units,
        zones,
        height_unit,
    };
    let area_of = |surface| rows.of_faces(surface, |_| [0.0; 2]);
    let (common, base_area) = match base {
        VolumeBase::Surface(other) => {
            let mut common = TotalsByRow::default();
            let add = |sums: &mut RowBuffer, overlap: Overlap<'_>| {
                match (zones, overlap.fine) {
                    (None, Some(fine)) => rows.add_to(sums.rows.of_row(0), fine, None),
                    // A sliver that rounding moves out of a zone is none of it.
                    _ => rows.add(sums, overlap.origin, overlap.corners, None),
                }
            };
            overlay([surface, other], add, |sums| common.add(&sums.rows));
            (common, area_of(other))
        }
        VolumeBase::Level(height) => {
            let common = rows.of_faces(surface, |z| [z, height]);
            (common, TotalsByRow::default())
        }
    };
    // A level is wherever the surface is.
    let surface_area = match base {
        VolumeBase::Surface(_) => &area_of(surface),
        VolumeBase::Level(_) => &common,
    };
    surface.ensure_intact()?;
    if let VolumeBase::Surface(other) = base {
        other.ensure_intact()?;
    }
    let count = zones.map_or(1, Zones::count);
    Ok((0..count)
        .map(|row| {
            let of_both = common.row(row);
            let only = |areas: &TotalsByRow| units.area.value(areas.row(row).area - of_both.area);
            let volume = |of: usize| units.volume.value(of_both.volumes[of]);
            let area = |of: usize| units.area.value(of_both.areas[of]);
            Volume {
                cut: volume(0),
                fill: volume(1),
                cut_area: area(0),
                fill_area: area(1),
                common_area: units.area.value(of_both.area),
                surface_only_area: only(surface_area).max(0.0),
                base_only_area: only(&base_area).max(0.0),
                slope_area: units.slope_area.value(surface_area.row(row).slope_area),
            }
        })
        .collect())
}

/// The units of sums.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub(super) volume: Unit,
    pub(super) area: Unit,
    slope_area: Unit,
}

impl Units {
    /// Returns the units for sums over faces within a box.
    ///
    /// # Errors
    /// If a size is so large or so small that products of sizes are no numbers, or 0.
    pub(super) fn within(bounds: &Bounds, height_unit: f64) -> Result<Self> {
        let sizes = [0, 1, 2].map(|k| (bounds.max[k] - bounds.min[k]).max(0.0));
        if let Some(size) = sizes
            .iter()
            .find(|&&size| size != 0.0 && !SIZES.contains(&size))
        {
            return Err(Error::limit(format!(
                "the surfaces extend over {size:e}: expected 0, or between {:e} and {:e}",
                SIZES.start(),
                SIZES.end()
            ))
            .cure("give coordinates in other units"));
        }
        let [width, depth, relief] = sizes;
        let area = width * depth;
        Ok(Units {
            volume: Unit::for_up_to(area * relief),
            area: Unit::for_up_to(area),
            // Of a surface that rises once over its size; there is room for a hundred million times
            // as much.
            slope_area: Unit::for_up_to(area + relief * height_unit * (width + depth)),
        })
    }
}

/// Sums of one row of the result.
#[derive(Debug, Clone, Copy, Default)]
struct Totals {
    volumes: [Sum; 2],
    areas: [Sum; 2],
    area: Sum,
    slope_area: Sum,
}

/// Sums of all rows; those at the end that are 0 may be missing.
#[derive(Debug, Default)]
struct TotalsByRow(Vec<Totals>);

impl TotalsByRow {
    fn row(&self, row: usize) -> Totals {
        self.0.get(row).copied().unwrap_or_default()
    }

    fn of_row(&mut self, row: usize) -> &mut Totals {
        if self.0.len() <= row {
            self.0.resize_with(row + 1, Totals::default);
        }
        &mut self.0[row]
    }

    fn add(&mut self, other: &TotalsByRow) {
        for (row, more) in other.0.iter().enumerate() {
            let sums = self.of_row(row);
            for k in 0..2 {
                sums.volumes[k] += more.volumes[k];
                sums.areas[k] += more.areas[k];
            }
            sums.area += more.area;
            sums.slope_area += more.slope_area;
        }
    }
}

/// Sums of one batch of faces, and memory for parts of polygons.
#[derive(Debug, Default)]
struct RowBuffer {
    rows: TotalsByRow,
    part: Vec<Corner>,
}

/// How polygons are added to rows.
#[derive(Debug, Clone, Copy)]
struct Rows<'a> {
    units: Units,
    zones: Option<&'a Zones>,
    height_unit: f64,
}

impl Rows<'_> {
    /// Adds a polygon, relative to an origin, to the row of each zone that it is in; its area along
    /// the slope if the stretch of that is given.
    fn add(
        &self,
        sums: &mut RowBuffer,
        origin: [f64; 3],
        corners: &[Corner],
        stretch: Option<f64>,
    ) {
        let RowBuffer { rows, part } = sums;
        match self.zones {
            None => self.add_to(rows.of_row(0), corners, stretch),
            Some(zones) => zones.parts(origin, corners, part, |zone, corners| {
                self.add_to(rows.of_row(zone), corners, stretch);
            }),
        }
    }

    fn add_to<T: Number>(&self, totals: &mut Totals, corners: &[Corner<T>], stretch: Option<f64>) {
        let part = integral(corners);
        for k in 0..2 {
            totals.volumes[k] += self.units.volume.of(part.volumes[k]);
            totals.areas[k] += self.units.area.of(part.areas[k]);
        }
        totals.area += self.units.area.of(part.area);
        if let Some(stretch) = stretch {
            totals.slope_area += self.units.slope_area.of(part.area * stretch);
        }
    }

    /// Returns the sums over the faces of a surface; `heights` returns both heights at a corner
    /// from that of the surface.
    fn of_faces(
        &self,
        surface: &dyn Surface,
        heights: impl Fn(f64) -> [f64; 2] + Sync,
    ) -> TotalsByRow {
        let mut all = TotalsByRow::default();
        let ask = |numbers, triangles: &mut _| surface.triangles_in(numbers, triangles);
        let add = |triangles: &[(u32, [[f64; 3]; 3])]| {
            let mut sums = RowBuffer::default();
            for &(_, triangle) in triangles {
                let triangle = from_least(triangle);
                let origin = triangle[0];
                let corners = triangle.map(|[x, y, z]| Corner {
                    at: [x - origin[0], y - origin[1]],
                    heights: heights(z),
                });
                let stretch = stretch(triangle, self.height_unit);
                self.add(&mut sums, origin, &corners, Some(stretch));
            }
            sums.rows
        };
        let Ok(()) = map_batches(surface.face_count(), ask, add, |sums| {
            all.add(&sums);
            Ok::<(), Infallible>(())
        });
        all
    }
}

/// Returns the area of a triangle divided by its area in plan: 1 if it is level, or if its area in
/// plan is 0.
fn stretch([a, b, c]: [[f64; 3]; 3], height_unit: f64) -> f64 {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
    let cross = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
    let [x, y] = [cross(1, 2), cross(2, 0)].map(|area| area * height_unit);
    let stretch = x.hypot(y).hypot(cross(0, 1)) / cross(0, 1);
    if stretch.is_finite() { stretch } else { 1.0 }
}

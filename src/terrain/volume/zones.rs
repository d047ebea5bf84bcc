//! Areas within which volumes are computed.

use crate::data::area_of;
use crate::error::{Error, Result};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::nesting::triangulated;
use crate::terrain::overlay::{Corner, clipped};

/// Polygons in plan, divided into triangles. Those of different polygons may overlap.
#[derive(Debug)]
pub struct Zones {
    triangles: Boxes<ZoneTriangle>,
    /// The number of triangles of each polygon.
    counts: Vec<usize>,
    areas: Vec<f64>,
}

#[derive(Debug, Clone, Copy)]
struct ZoneTriangle {
    zone: usize,
    corners: [[f64; 2]; 3],
}

impl Boxed for ZoneTriangle {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.corners)
    }
}

impl Zones {
    /// Divides polygons into triangles. Each polygon is a list of rings; the even-odd rule applies,
    /// so holes need not be marked. Rings that do not end where they begin are closed.
    ///
    /// # Errors
    /// If a coordinate is not finite, or so large or small that the arithmetic does not cover it.
    ///
    /// # Complexity
    /// O(n log n) for n vertices.
    pub fn new(polygons: &[Vec<Vec<[f64; 2]>>]) -> Result<Self> {
        let mut triangles = Vec::new();
        let mut counts = Vec::with_capacity(polygons.len());
        let mut areas = Vec::with_capacity(polygons.len());
        for (zone, rings) in polygons.iter().enumerate() {
            let found = triangles_of(rings)?;
            counts.push(found.len());
            areas.push(found.iter().map(|corners| area(*corners)).sum());
            triangles.extend(
                found
                    .into_iter()
                    .map(|corners| ZoneTriangle { zone, corners }),
            );
        }
        Ok(Zones {
            triangles: Boxes::new(triangles),
            counts,
            areas,
        })
    }

    /// Returns the number of polygons.
    pub fn count(&self) -> usize {
        self.counts.len()
    }

    /// Returns true if a polygon has no area.
    pub fn is_empty(&self, zone: usize) -> bool {
        self.counts.get(zone).is_none_or(|&count| count == 0)
    }

    /// Returns the area of a polygon, in squares of the unit of the plan; 0 if there is no such
    /// polygon.
    pub fn area(&self, zone: usize) -> f64 {
        self.areas.get(zone).copied().unwrap_or(0.0)
    }

    /// Returns the triangles of all polygons, counter-clockwise.
    pub fn triangles(&self) -> impl Iterator<Item = [[f64; 2]; 3]> + '_ {
        self.triangles
            .items()
            .iter()
            .map(|triangle| triangle.corners)
    }

    /// Calls `each` with the number of a zone and a part of a polygon that lies in it, for all
    /// parts. Corners are relative to an origin; `part` is memory that is kept between calls.
    pub(super) fn parts(
        &self,
        origin: [f64; 3],
        corners: &[Corner],
        part: &mut Vec<Corner>,
        mut each: impl FnMut(usize, &[Corner]),
    ) {
        let around = Extent::of_plan(
            corners
                .iter()
                .map(|corner| [0, 1].map(|k| corner.at[k] + origin[k])),
        );
        self.triangles.find_in(around, |triangle| {
            let local = triangle.corners.map(|p| [0, 1].map(|k| p[k] - origin[k]));
            part.clear();
            clipped(corners, local, part);
            if part.len() > 2 {
                each(triangle.zone, part);
            }
            None::<()>
        });
    }
}

/// Returns the area of a triangle.
fn area(corners: [[f64; 2]; 3]) -> f64 {
    area_of(corners.map(|[x, y]| [x, y, 0.0]))
}

/// Returns the triangles inside of a polygon, counter-clockwise.
fn triangles_of(rings: &[Vec<[f64; 2]>]) -> Result<Vec<[[f64; 2]; 3]>> {
    let triangulation = triangulated(rings)?;
    let nesting = triangulation
        .nesting_of(triangulation.lines())
        .map_err(|e| Error::format(e.to_string()))?;
    Ok(triangulation
        .finite_cells()
        .filter(|cell| nesting[cell.index()] % 2 == 1)
        .filter_map(|cell| triangulation.cell_points(cell))
        .map(|corners| corners.map(|&[x, y, _]| [x, y]))
        .collect())
}

use std::f64::consts::PI;

use crate::crs::SEMI_AXES;
use crate::error::{Error, Result};

/// The semi-major axis of WGS 84, in meters.
const RADIUS: f64 = SEMI_AXES[0];

/// The number of heights along a side of a tile that CesiumJS assumes for geometric errors.
const SAMPLES: f64 = 65.0;

/// The division of the earth into squares, four times as many with each level.
///
/// Coordinates are degrees of longitude and latitude, also where tiles are squares of Web Mercator:
/// viewers take a position within a tile as linear in both.
///
/// Tiles are counted from the west and from the south, as in the Tile Map Service.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
pub enum Tiling {
    /// Degrees of longitude and latitude on WGS 84 (EPSG:4326), from two tiles.
    #[default]
    Geographic,
    /// Squares of Web Mercator (EPSG:3857), from one tile, up to 85 degrees of latitude.
    WebMercator,
}

/// The number of rows of a level.
fn rows(level: u8) -> u32 {
    1 << level.min(Tiling::MAX_LEVEL)
}

/// The position of a tile: its level, and its column and row at this level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TilePosition {
    /// 0 for the largest tiles.
    pub level: u8,
    /// Counted from the west.
    pub column: u32,
    /// Counted from the south.
    pub row: u32,
}

impl TilePosition {
    /// Returns the four tiles of the next finer level in a tile.
    pub(crate) fn quarters(self) -> [TilePosition; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[east, north]| TilePosition {
            level: self.level.saturating_add(1),
            column: 2 * self.column + east,
            row: 2 * self.row + north,
        })
    }
}

impl Tiling {
    /// The finest level of any tiling: a few centimeters.
    pub const MAX_LEVEL: u8 = 28;

    /// The EPSG code of the coordinates.
    pub const COORDINATES: u32 = 4326;

    /// Returns the EPSG code of the system in which tiles are squares.
    pub fn epsg(self) -> u32 {
        match self {
            Tiling::Geographic => 4326,
            Tiling::WebMercator => 3857,
        }
    }

    /// Returns the numbers of columns and rows at a level. A level beyond the finest one counts as
    /// that, here and in all that follows.
    pub fn size(self, level: u8) -> [u32; 2] {
        let rows = rows(level);
        match self {
            Tiling::Geographic => [2 * rows, rows],
            Tiling::WebMercator => [rows, rows],
        }
    }

    /// Returns the angle that a tile spans at the equator, in radians.
    pub fn angle(self, level: u8) -> f64 {
        let whole = match self {
            Tiling::Geographic => PI,
            Tiling::WebMercator => 2.0 * PI,
        };
        whole / f64::from(rows(level))
    }

    /// Returns the longitude (axis 0) or the latitude (axis 1) of a line between tiles, in degrees:
    /// the same to the last bit at each level that has the line. Line 0 is the first one.
    pub fn line(self, axis: usize, level: u8, number: u32) -> f64 {
        let along = f64::from(number) / f64::from(rows(level));
        match (self, axis) {
            (Tiling::Geographic, 0) => along * 180.0 - 180.0,
            (Tiling::Geographic, _) => along * 180.0 - 90.0,
            (Tiling::WebMercator, 0) => along * 360.0 - 180.0,
            (Tiling::WebMercator, _) => (PI * (2.0 * along - 1.0)).sinh().atan().to_degrees(),
        }
    }

    /// Returns how far a longitude or a latitude in degrees is from the first line, in sides of a
    /// tile.
    pub fn in_sides(self, axis: usize, level: u8, value: f64) -> f64 {
        let along = match (self, axis) {
            (Tiling::Geographic, 0) => (value + 180.0) / 180.0,
            (Tiling::Geographic, _) => (value + 90.0) / 180.0,
            (Tiling::WebMercator, 0) => (value + 180.0) / 360.0,
            (Tiling::WebMercator, _) => (value.to_radians().tan().asinh() / PI + 1.0) / 2.0,
        };
        along * f64::from(rows(level))
    }

    /// Returns how far along the side of a tile a line of a grid is, from 0 to 1, if the grid has
    /// `cells` squares along the side: a power of two.
    ///
    /// In Web Mercator, squares of a tile have different heights in degrees of latitude.
    pub fn along_side(self, axis: usize, at: TilePosition, cells: u32, number: u32) -> f64 {
        if (self, axis) != (Tiling::WebMercator, 1) {
            return f64::from(number) / f64::from(cells);
        }
        let finer = at.level.saturating_add(cells.trailing_zeros() as u8);
        let line = at.row.saturating_mul(cells).saturating_add(number);
        let [[_, south], [_, north]] = self.bounds(at);
        (self.line(axis, finer, line) - south) / (north - south)
    }

    /// Returns the smallest longitude and latitude of a tile, and its largest, in degrees.
    pub fn bounds(self, at: TilePosition) -> [[f64; 2]; 2] {
        let corner = |more: u32| {
            [
                self.line(0, at.level, at.column.saturating_add(more)),
                self.line(1, at.level, at.row.saturating_add(more)),
            ]
        };
        [corner(0), corner(1)]
    }

    /// Returns the error that viewers expect of a level, in meters: a quarter of the distance of 65
    /// heights along a side at the equator, as in CesiumJS (`TerrainProvider`,
    /// `getEstimatedLevelZeroGeometricErrorForAHeightmap`).
    pub fn geometric_error(self, level: u8) -> f64 {
        self.angle(level) * RADIUS / SAMPLES / 4.0
    }

    /// Returns the meters in a degree of longitude and of latitude at a latitude, on a sphere.
    pub fn meters_per_degree(latitude: f64) -> [f64; 2] {
        let cos = latitude.to_radians().cos();
        [cos, 1.0].map(|share| share * RADIUS * PI / 180.0)
    }
}

/// Triangles of one level over one square, with all coordinates in whole steps.
///
/// A vertex is so many steps from the west and the south of the tile, of which there are
/// [`STEPS`](Self::STEPS), and so many steps above its lowest height. Steps are powers of two, and
/// all heights of a level are multiples of the largest one: equal heights in two tiles are equal to
/// the last bit.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainTile {
    /// Which tile it is.
    pub at: TilePosition,
    /// A step of height in meters, a power of two.
    pub step: f64,
    /// The height that vertices are counted from, in steps.
    pub lowest: i32,
    /// The vertices: steps from the west, from the south, and above the lowest height.
    pub vertices: Vec<[u16; 3]>,
    /// The corners of the triangles, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The normal of each vertex, along X, Y and Z from the center of the earth. Tiles that share a
    /// border have the same normals there.
    pub normals: Vec<[f64; 3]>,
}

impl TerrainTile {
    /// The number of steps along a side, and of steps of height.
    pub const STEPS: u16 = 32_767;

    /// Returns a height in meters, exactly, from steps above the lowest height.
    pub fn height(&self, steps: u16) -> f64 {
        (f64::from(self.lowest) + f64::from(steps)) * self.step
    }

    /// Returns the lowest height that a vertex can have, and the highest.
    pub fn range(&self) -> [f64; 2] {
        [self.height(0), self.height(Self::STEPS)]
    }

    /// Returns an error if a triangle names a vertex that does not exist.
    ///
    /// # Errors
    /// Names the vertex.
    pub fn check(&self) -> Result<()> {
        let count = self.vertices.len();
        let mut corners = self.triangles.iter().flatten();
        match corners.find(|&&v| v as usize >= count) {
            None => Ok(()),
            Some(v) => Err(Error::format(format!(
                "vertex {v} of a tile does not exist: there are {count}, counted from 0"
            ))),
        }
    }

    /// Returns longitude and latitude in degrees, and the height in meters.
    pub fn position(&self, tiling: Tiling, [u, v, steps]: [u16; 3]) -> [f64; 3] {
        let [min, max] = tiling.bounds(self.at);
        let along = |axis: usize, steps: u16| {
            let t = f64::from(steps) / f64::from(Self::STEPS);
            min[axis] + t * (max[axis] - min[axis])
        };
        [along(0, u), along(1, v), self.height(steps)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Latitudes of EPSG:3857, by its formula for the other direction.
    #[test]
    fn lines_of_mercator_are_equally_far_apart_on_its_map() {
        let tiling = Tiling::WebMercator;
        for level in [0, 1, 5, 12] {
            let rows = tiling.size(level)[1];
            for number in (0..=rows).step_by(1 + rows as usize / 40) {
                let latitude = tiling.line(1, level, number).to_radians();
                let y = (PI / 4.0 + latitude / 2.0).tan().ln();
                let expected = PI * (2.0 * f64::from(number) / f64::from(rows) - 1.0);
                assert!((y - expected).abs() < 1e-12, "{level} {number} {y}");
                let back = tiling.in_sides(1, level, latitude.to_degrees());
                assert!((back - f64::from(number)).abs() < 1e-9 * f64::from(rows));
                assert_eq!(
                    tiling.line(1, level, number),
                    tiling.line(1, level + 1, 2 * number)
                );
            }
        }
        assert!((tiling.line(1, 0, 1) - 85.051_128_779_806_6).abs() < 1e-9);
        assert_eq!(tiling.line(0, 1, 1), 0.0);
    }

    /// A vertex is linear between the latitudes of the edges of its tile, as in the specification.
    #[test]
    fn positions_within_a_tile_are_linear_in_degrees() {
        let tile = TerrainTile {
            at: TilePosition {
                level: 1,
                column: 1,
                row: 1,
            },
            step: 1.0,
            lowest: 0,
            vertices: Vec::new(),
            triangles: Vec::new(),
            normals: Vec::new(),
        };
        let north = Tiling::WebMercator.line(1, 1, 2);
        let [x, y, z] = tile.position(Tiling::WebMercator, [16_383, 16_383, 7]);
        let share = 16_383.0 / 32_767.0;
        assert!((x - 180.0 * share).abs() < 1e-9 && (y - north * share).abs() < 1e-9);
        assert_eq!(z, 7.0);
        let half = Tiling::WebMercator.along_side(1, tile.at, 2, 1);
        assert!((half * north - 66.513_260_443_111_9).abs() < 1e-9, "{half}");
    }
}

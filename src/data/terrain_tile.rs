use std::f64::consts::PI;

use crate::crs::SEMI_AXES;
use crate::error::{Error, Result};

/// The semi-major axis of WGS 84, in meters.
const RADIUS: f64 = SEMI_AXES[0];

/// Half the width of the world in Web Mercator, in meters.
const MERCATOR: f64 = PI * RADIUS;

/// How many samples a tile of heights has along a side by the convention for geometric errors.
const SAMPLES: f64 = 65.0;

/// The division of the earth into squares, four times as many with each level.
///
/// Tiles are counted from the west and from the south, as in the Tile Map Service.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
pub enum Tiling {
    /// Degrees of longitude and latitude on WGS 84 (EPSG:4326), from two tiles.
    #[default]
    Geographic,
    /// Web Mercator (EPSG:3857), from one tile.
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

impl Tiling {
    /// The finest level of any tiling: a few centimeters.
    pub const MAX_LEVEL: u8 = 28;

    /// Returns the EPSG code of the coordinates.
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

    /// Returns the smallest x, or the smallest y, of all tiles.
    fn origin(self, axis: usize) -> f64 {
        match self {
            Tiling::Geographic => [-180.0, -90.0][axis],
            Tiling::WebMercator => -MERCATOR,
        }
    }

    /// Returns the side of a tile, in the units of the coordinates.
    pub fn side(self, level: u8) -> f64 {
        let whole = match self {
            Tiling::Geographic => 180.0,
            Tiling::WebMercator => 2.0 * MERCATOR,
        };
        whole / f64::from(rows(level))
    }

    /// Returns the angle that a tile spans at the equator, in radians.
    pub fn angle(self, level: u8) -> f64 {
        let whole = match self {
            Tiling::Geographic => PI,
            Tiling::WebMercator => 2.0 * PI,
        };
        whole / f64::from(rows(level))
    }

    /// Returns the x (axis 0) or y (axis 1) of a line between tiles, the first of which is 0: the
    /// same number at each level that has the line.
    pub fn line(self, axis: usize, level: u8, number: u32) -> f64 {
        f64::from(number) * self.side(level) + self.origin(axis)
    }

    /// Returns a coordinate in sides of a tile from the first line.
    pub fn in_sides(self, axis: usize, level: u8, value: f64) -> f64 {
        (value - self.origin(axis)) / self.side(level)
    }

    /// Returns the smallest x and y of a tile, and its largest.
    pub fn bounds(self, at: TilePosition) -> [[f64; 2]; 2] {
        let corner = |more: u32| {
            [
                self.line(0, at.level, at.column + more),
                self.line(1, at.level, at.row + more),
            ]
        };
        [corner(0), corner(1)]
    }

    /// Returns the error that viewers expect of a level, in meters: a quarter of the distance of 65
    /// heights along a side at the equator.
    pub fn geometric_error(self, level: u8) -> f64 {
        self.angle(level) * RADIUS / SAMPLES / 4.0
    }

    /// Returns the meters in a unit of x and of y at a latitude in degrees, on a sphere.
    pub fn meters_per_unit(self, latitude: f64) -> [f64; 2] {
        let cos = latitude.to_radians().cos();
        match self {
            Tiling::Geographic => [cos, 1.0].map(|share| share * RADIUS * PI / 180.0),
            Tiling::WebMercator => [cos; 2],
        }
    }

    /// Returns longitude and latitude of a position, in degrees.
    pub fn degrees(self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self {
            Tiling::Geographic => [x, y],
            Tiling::WebMercator => [x / RADIUS, (y / RADIUS).sinh().atan()].map(f64::to_degrees),
        }
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

    /// Returns x and y in the coordinates of a tiling, and the height in meters.
    pub fn position(&self, tiling: Tiling, [u, v, steps]: [u16; 3]) -> [f64; 3] {
        let [min, max] = tiling.bounds(self.at);
        let along = |axis: usize, steps: u16| {
            let t = f64::from(steps) / f64::from(Self::STEPS);
            min[axis] + t * (max[axis] - min[axis])
        };
        [along(0, u), along(1, v), self.height(steps)]
    }
}

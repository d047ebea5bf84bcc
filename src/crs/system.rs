//! What is known of a coordinate system.

use super::unit::Unit;

/// The kind of the coordinates of a [`Crs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum CrsKind {
    /// Lengths on a map.
    Projected,
    /// Longitude and latitude in angles.
    Geographic,
    /// X, Y and Z from the center of the earth.
    Geocentric,
    /// Engineering and other local systems, and systems of unknown kind.
    Local,
}

/// A coordinate system that can be compared, printed and written into files.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Crs {
    /// The name in its definition: "ETRS89 / UTM zone 32N".
    pub name: String,
    /// The EPSG code of the horizontal (or the whole) system.
    pub epsg: Option<u32>,
    /// The EPSG code of the vertical part.
    pub vertical_epsg: Option<u32>,
    /// The kind of the coordinates.
    pub kind: CrsKind,
    /// The unit of x and y.
    pub unit: Unit,
    /// The unit of z, if the definition states one.
    pub vertical_unit: Option<Unit>,
    /// The WKT from which the system was read, if any.
    pub wkt: Option<String>,
}

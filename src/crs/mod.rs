//! Coordinate systems: what they are called, which units they have, how formats write them down.
//!
//! Nothing here reprojects; that is PROJ's task, behind [`Transform`].

mod geokeys;

pub use geokeys::GeoKeys;

use crate::error::{Error, Result};

/// What the coordinates of a [`Crs`] are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrsKind {
    /// Lengths on a map.
    Projected,
    /// Longitude and latitude in angles.
    Geographic,
    /// X, Y and Z from the centre of the earth.
    Geocentric,
    /// Engineering and other local systems, and what could not be told.
    Local,
}

/// A unit of length or angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// "metre", "US survey foot", "degree"
    pub name: String,
    /// Metres (or radians) in one unit.
    pub factor: f64,
}

/// A coordinate system, identified well enough to compare it, to print it and to write it into a
/// file.
#[derive(Debug, Clone, PartialEq)]
pub struct Crs {
    /// As its definition calls it: "ETRS89 / UTM zone 32N".
    pub name: String,
    /// Code in the EPSG registry of the horizontal (or the whole) system.
    pub epsg: Option<u32>,
    /// Code of the vertical part.
    pub vertical_epsg: Option<u32>,
    /// What the coordinates are.
    pub kind: CrsKind,
    /// Unit of x and y.
    pub unit: Unit,
    /// Unit of z, if the definition gives one.
    pub vertical_unit: Option<Unit>,
    /// The definition as found, in WKT, if there was one.
    pub wkt: Option<String>,
}

impl Crs {
    /// The system with this code: a horizontal, compound or geocentric one.
    ///
    /// # Errors
    /// If the registry has no such code.
    pub fn from_epsg(code: u32) -> Result<Self> {
        Err(Error::unsupported(format!("EPSG:{code}")))
    }

    /// Reads WKT, version 1 (OGC or ESRI) or 2.
    ///
    /// # Errors
    /// If the text is not WKT of a coordinate system.
    pub fn from_wkt(text: &str) -> Result<Self> {
        Err(Error::unsupported(text.to_owned()))
    }

    /// Reads what a user types: `EPSG:25832`, `EPSG:25832+7837`, `25832`, or WKT.
    ///
    /// # Errors
    /// With the forms that are understood.
    pub fn from_user(text: &str) -> Result<Self> {
        Self::from_wkt(text)
    }

    /// The definition as WKT 1 for a `.prj` file.
    pub fn to_prj(&self) -> String {
        self.wkt.clone().unwrap_or_default()
    }

    /// Whether both mean the same horizontal system (and the same vertical one where both state
    /// one), by code where both have one, else by definition.
    pub fn is_same(&self, other: &Crs) -> bool {
        self == other
    }
}

impl std::fmt::Display for Crs {
    /// `EPSG:25832 (ETRS89 / UTM zone 32N)`, or the name alone.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.epsg {
            Some(code) => write!(f, "EPSG:{code} ({})", self.name),
            None => f.write_str(&self.name),
        }
    }
}

/// Takes coordinates from one system to another.
pub trait Transform: Send + Sync {
    /// Transforms in place.
    ///
    /// # Errors
    /// If a point lies outside of what the operation covers; the message names it.
    fn transform(&self, points: &mut [[f64; 3]]) -> Result<()>;

    /// What a user should be told of the operation: unknown accuracy, heights left as they are.
    fn warnings(&self) -> Vec<String>;
}

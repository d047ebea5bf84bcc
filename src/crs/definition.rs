use super::projection::{Projection, normalized};
use super::{CrsKind, Unit};

/// The components of a coordinate system, independent of the format that it was read from.
#[derive(Debug, Clone)]
pub(super) struct Definition {
    pub(super) kind: CrsKind,
    pub(super) datum: Datum,
    /// Name and EPSG code of the base system of a projected system, or of the system itself.
    pub(super) geographic: (String, Option<u32>),
    /// The unit of longitudes and latitudes.
    pub(super) angle: Unit,
    pub(super) projection: Option<Projection>,
    /// The unit of the coordinates.
    pub(super) unit: Unit,
}

/// The reference of longitudes and latitudes.
#[derive(Debug, Clone)]
pub(super) struct Datum {
    pub(super) name: String,
    pub(super) code: Option<u32>,
    pub(super) ellipsoid: Ellipsoid,
    /// The prime meridian, in degrees east of Greenwich.
    pub(super) meridian: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Ellipsoid {
    pub(super) name: String,
    pub(super) code: Option<u32>,
    /// Semi-major axis in meters.
    pub(super) a: f64,
    /// Inverse flattening; 0 for a sphere.
    pub(super) rf: f64,
}

impl Definition {
    /// Returns true if a pair of coordinates means the same position in both.
    pub(super) fn is_same(&self, other: &Definition) -> bool {
        let projection = match (&self.projection, &other.projection) {
            (Some(a), Some(b)) => a.is_same(b),
            (None, None) => true,
            _ => false,
        };
        self.kind == other.kind
            && self.unit.is_same(&other.unit)
            && projection
            && self.datum.is_same(&other.datum)
    }
}

impl Datum {
    pub(super) fn is_same(&self, other: &Datum) -> bool {
        let same = match (self.code, other.code) {
            (Some(a), Some(b)) => a == b,
            _ => {
                normalized(&self.name) == normalized(&other.name)
                    && self.ellipsoid.is_same(&other.ellipsoid)
            }
        };
        same && (self.meridian - other.meridian).abs() < 1e-7
    }
}

impl Ellipsoid {
    /// Returns true if two ellipsoids differ by no more than the truncation of digits in
    /// definitions.
    ///
    /// (GRS 1980 and WGS 84 are the same by this test; the datum's name distinguishes them.)
    pub(super) fn is_same(&self, other: &Ellipsoid) -> bool {
        (self.a - other.a).abs() < 0.01 && (self.rf - other.rf).abs() < 1e-4
    }
}

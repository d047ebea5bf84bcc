//! Projection methods and their parameters: one table for reading and writing WKT 1 (OGC and Esri),
//! WKT 2 and GeoKeys.

use proj_core::ProjectionMethod;

/// The meaning of a parameter, independent of its name in a format.
///
/// Angles are in degrees from the prime meridian of the datum, lengths in meters.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Param {
    Lat0,
    Lon0,
    Lat1,
    Lat2,
    K0,
    Azimuth,
    Angle,
    PseudoParallel,
    FalseEasting,
    FalseNorthing,
    /// A parameter of a method that is not in the table: its name, in lower case letters and
    /// digits.
    Other(String),
}

/// What a parameter measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measure {
    Angle,
    Length,
    Ratio,
}

impl Param {
    pub(super) fn measure(&self) -> Measure {
        match self {
            Param::FalseEasting | Param::FalseNorthing => Measure::Length,
            Param::K0 | Param::Other(_) => Measure::Ratio,
            _ => Measure::Angle,
        }
    }

    /// The parameter with a name in WKT of any version.
    pub(super) fn from_name(name: &str) -> Self {
        let name = normalized(name);
        match name.as_str() {
            "latitudeoforigin"
            | "latitudeofcenter"
            | "latitudeofcentre"
            | "latitudeofnaturalorigin"
            | "latitudeoffalseorigin"
            | "latitudeofprojectioncenter"
            | "latitudeofprojectioncentre"
            | "centralparallel" => Param::Lat0,
            "centralmeridian"
            | "longitudeoforigin"
            | "longitudeofcenter"
            | "longitudeofcentre"
            | "longitudeofnaturalorigin"
            | "longitudeoffalseorigin"
            | "longitudeofprojectioncenter"
            | "longitudeofprojectioncentre" => Param::Lon0,
            "standardparallel1"
            | "latitudeof1ststandardparallel"
            | "latitudeofstandardparallel"
            | "standardparallel" => Param::Lat1,
            "standardparallel2" | "latitudeof2ndstandardparallel" => Param::Lat2,
            "scalefactor"
            | "scalefactoratnaturalorigin"
            | "scalefactoratprojectioncenter"
            | "scalefactoratprojectioncentre"
            | "scalefactoroninitialline"
            | "scalefactoronpseudostandardparallel" => Param::K0,
            "azimuth"
            | "azimuthofinitialline"
            | "azimuthatprojectioncenter"
            | "azimuthatprojectioncentre"
            | "colatitudeofconeaxis" => Param::Azimuth,
            "rectifiedgridangle" | "anglefromrectifiedtoskewgrid" | "xyplanerotation" => Param::Angle,
            "pseudostandardparallel1" | "latitudeofpseudostandardparallel" => Param::PseudoParallel,
            "falseeasting" | "eastingatfalseorigin" | "eastingatprojectioncenter" | "eastingatprojectioncentre" => {
                Param::FalseEasting
            }
            "falsenorthing" | "northingatfalseorigin" | "northingatprojectioncenter" | "northingatprojectioncentre" => {
                Param::FalseNorthing
            }
            _ => Param::Other(name),
        }
    }

    fn default(&self) -> f64 {
        match self {
            Param::K0 => 1.0,
            _ => 0.0,
        }
    }
}

/// A method that all formats here can write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    TransverseMercator,
    Lambert1,
    Lambert2,
    Albers,
    LambertAzimuthal,
    ObliqueStereographic,
    PolarStereographic,
    Mercator,
    WebMercator,
    HotineNatural,
    HotineCenter,
    Cassini,
    Krovak,
    Polyconic,
    AzimuthalEquidistant,
    Equirectangular,
    EqualEarth,
}

/// The names of a method in formats.
pub(super) struct Row {
    pub(super) method: Method,
    /// The name in GDAL's WKT 1.
    pub(super) ogc: &'static str,
    /// The name in Esri's WKT 1.
    pub(super) esri: &'static str,
    /// Further names, normalized: those of WKT 2, and older ones.
    others: &'static [&'static str],
    /// The value of ProjCoordTransGeoKey.
    pub(super) geokey: Option<u16>,
    /// The parameters, with the names in GDAL's and Esri's WKT 1 and the GeoKey.
    pub(super) params: &'static [(Param, &'static str, &'static str, u16)],
}

use Param::{Angle, Azimuth, FalseEasting, FalseNorthing, K0, Lat0, Lat1, Lat2, Lon0, PseudoParallel};

const LAT0: (Param, &str, &str, u16) = (Lat0, "latitude_of_origin", "Latitude_Of_Origin", 3081);
const LON0: (Param, &str, &str, u16) = (Lon0, "central_meridian", "Central_Meridian", 3080);
const LAT1: (Param, &str, &str, u16) = (Lat1, "standard_parallel_1", "Standard_Parallel_1", 3078);
const LAT2: (Param, &str, &str, u16) = (Lat2, "standard_parallel_2", "Standard_Parallel_2", 3079);
const SCALE: (Param, &str, &str, u16) = (K0, "scale_factor", "Scale_Factor", 3092);
const EAST: (Param, &str, &str, u16) = (FalseEasting, "false_easting", "False_Easting", 3082);
const NORTH: (Param, &str, &str, u16) = (FalseNorthing, "false_northing", "False_Northing", 3083);
const CENTER_LAT: (Param, &str, &str, u16) = (Lat0, "latitude_of_center", "Latitude_Of_Center", 3089);
const CENTER_LON: (Param, &str, &str, u16) = (Lon0, "longitude_of_center", "Longitude_Of_Center", 3088);
const OBLIQUE: &[(Param, &str, &str, u16)] = &[
    CENTER_LAT,
    CENTER_LON,
    (Azimuth, "azimuth", "Azimuth", 3094),
    (Angle, "rectified_grid_angle", "XY_Plane_Rotation", 3096),
    (K0, "scale_factor", "Scale_Factor", 3093),
    EAST,
    NORTH,
];

pub(super) const ROWS: &[Row] = &[
    Row {
        method: Method::TransverseMercator,
        ogc: "Transverse_Mercator",
        esri: "Transverse_Mercator",
        others: &["gausskruger", "transversemercatorcomplex"],
        geokey: Some(1),
        params: &[LAT0, LON0, SCALE, EAST, NORTH],
    },
    Row {
        method: Method::Lambert1,
        ogc: "Lambert_Conformal_Conic_1SP",
        esri: "Lambert_Conformal_Conic",
        others: &["lambertconicconformal1sp"],
        geokey: Some(9),
        params: &[LAT0, LON0, SCALE, EAST, NORTH],
    },
    Row {
        method: Method::Lambert2,
        ogc: "Lambert_Conformal_Conic_2SP",
        esri: "Lambert_Conformal_Conic",
        others: &["lambertconicconformal2sp"],
        geokey: Some(8),
        params: &[
            (Lat0, "latitude_of_origin", "Latitude_Of_Origin", 3085),
            (Lon0, "central_meridian", "Central_Meridian", 3084),
            LAT1,
            LAT2,
            (FalseEasting, "false_easting", "False_Easting", 3086),
            (FalseNorthing, "false_northing", "False_Northing", 3087),
        ],
    },
    Row {
        method: Method::Albers,
        ogc: "Albers_Conic_Equal_Area",
        esri: "Albers",
        others: &["albersequalarea", "albersequalareaconic"],
        geokey: Some(11),
        params: &[
            (Lat0, "latitude_of_center", "Latitude_Of_Origin", 3081),
            (Lon0, "longitude_of_center", "Central_Meridian", 3080),
            LAT1,
            LAT2,
            EAST,
            NORTH,
        ],
    },
    Row {
        method: Method::LambertAzimuthal,
        ogc: "Lambert_Azimuthal_Equal_Area",
        esri: "Lambert_Azimuthal_Equal_Area",
        others: &[],
        geokey: Some(10),
        params: &[
            (Lat0, "latitude_of_center", "Latitude_Of_Origin", 3089),
            (Lon0, "longitude_of_center", "Central_Meridian", 3088),
            EAST,
            NORTH,
        ],
    },
    Row {
        method: Method::ObliqueStereographic,
        ogc: "Oblique_Stereographic",
        esri: "Double_Stereographic",
        others: &[],
        geokey: Some(16),
        params: &[LAT0, LON0, SCALE, EAST, NORTH],
    },
    Row {
        method: Method::PolarStereographic,
        ogc: "Polar_Stereographic",
        esri: "Polar_Stereographic",
        others: &[
            "stereographicnorthpole",
            "stereographicsouthpole",
            "polarstereographicvarianta",
            "polarstereographicvariantb",
        ],
        geokey: Some(15),
        params: &[
            (Lat1, "latitude_of_origin", "Standard_Parallel_1", 3081),
            (Lon0, "central_meridian", "Central_Meridian", 3095),
            SCALE,
            EAST,
            NORTH,
        ],
    },
    Row {
        method: Method::Mercator,
        ogc: "Mercator_1SP",
        esri: "Mercator",
        others: &["mercator2sp", "mercatorvarianta", "mercatorvariantb"],
        geokey: Some(7),
        params: &[LON0, LAT1, SCALE, EAST, NORTH],
    },
    Row {
        method: Method::WebMercator,
        ogc: "Mercator_1SP",
        esri: "Mercator_Auxiliary_Sphere",
        others: &["popularvisualisationpseudomercator", "popularvisualizationpseudomercator"],
        geokey: None,
        params: &[LON0, LAT1, EAST, NORTH],
    },
    Row {
        method: Method::HotineNatural,
        ogc: "Hotine_Oblique_Mercator",
        esri: "Hotine_Oblique_Mercator_Azimuth_Natural_Origin",
        others: &["hotineobliquemercatorvarianta", "rectifiedskeworthomorphicnaturalorigin"],
        geokey: Some(3),
        params: OBLIQUE,
    },
    Row {
        method: Method::HotineCenter,
        ogc: "Hotine_Oblique_Mercator_Azimuth_Center",
        esri: "Hotine_Oblique_Mercator_Azimuth_Center",
        others: &["hotineobliquemercatorvariantb", "rectifiedskeworthomorphiccenter", "obliquemercator"],
        geokey: Some(9815),
        params: OBLIQUE,
    },
    Row {
        method: Method::Cassini,
        ogc: "Cassini_Soldner",
        esri: "Cassini",
        others: &[],
        geokey: Some(18),
        params: &[LAT0, LON0, EAST, NORTH],
    },
    Row {
        method: Method::Krovak,
        ogc: "Krovak",
        esri: "Krovak",
        others: &["krovaknorthorientated"],
        geokey: None,
        params: &[
            CENTER_LAT,
            CENTER_LON,
            (Azimuth, "azimuth", "Azimuth", 3094),
            (PseudoParallel, "pseudo_standard_parallel_1", "Pseudo_Standard_Parallel_1", 3078),
            SCALE,
            EAST,
            NORTH,
        ],
    },
    Row {
        method: Method::Polyconic,
        ogc: "Polyconic",
        esri: "Polyconic",
        others: &["americanpolyconic"],
        geokey: Some(22),
        params: &[LAT0, LON0, EAST, NORTH],
    },
    Row {
        method: Method::AzimuthalEquidistant,
        ogc: "Azimuthal_Equidistant",
        esri: "Azimuthal_Equidistant",
        others: &["modifiedazimuthalequidistant"],
        geokey: Some(12),
        params: &[
            (Lat0, "latitude_of_center", "Latitude_Of_Origin", 3089),
            (Lon0, "longitude_of_center", "Central_Meridian", 3088),
            EAST,
            NORTH,
        ],
    },
    Row {
        method: Method::Equirectangular,
        ogc: "Equirectangular",
        esri: "Equidistant_Cylindrical",
        others: &["platecarree"],
        geokey: Some(17),
        params: &[LON0, LAT1, EAST, NORTH],
    },
    Row {
        method: Method::EqualEarth,
        ogc: "Equal_Earth",
        esri: "Equal_Earth",
        others: &[],
        geokey: None,
        params: &[LON0, EAST, NORTH],
    },
];

impl Method {
    pub(super) fn row(self) -> &'static Row {
        ROWS.iter().find(|row| row.method == self).unwrap_or(&ROWS[0])
    }
}

/// A method with a value for each of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Projection {
    /// A method of the table, with values in the order of [`Row::params`].
    Known(Method, Vec<f64>),
    /// A method of which only the name is known, with the stated parameters.
    Other(String, Vec<(Param, f64)>),
}

/// 1e-8 degrees are a millimeter; definitions are printed with 12 to 15 digits.
const SAME_ANGLE: f64 = 1e-8;
/// Esri's false origins in feet differ from EPSG's by a millimeter.
const SAME_LENGTH: f64 = 2e-3;
/// A millimeter in a thousand kilometers.
const SAME_RATIO: f64 = 1e-9;

impl Projection {
    /// The projection with the name of a method in WKT and its parameters.
    pub(super) fn new(name: &str, stated: &[(Param, f64)]) -> Self {
        let name = normalized(name);
        let get = |param: Param| stated.iter().find(|entry| entry.0 == param).map(|entry| entry.1);
        let method = match name.as_str() {
            "lambertconformalconic" | "lambertconicconformal" => match (get(Lat1), get(Lat2), get(Lat0)) {
                (Some(_), Some(_), _) => Some(Method::Lambert2),
                (Some(lat1), None, Some(lat0)) if (lat1 - lat0).abs() > SAME_ANGLE => Some(Method::Lambert2),
                _ => Some(Method::Lambert1),
            },
            "stereographic" if get(Lat0).is_some_and(|lat| (lat.abs() - 90.0).abs() < SAME_ANGLE) => {
                Some(Method::PolarStereographic)
            }
            _ => ROWS
                .iter()
                .find(|row| {
                    normalized(row.ogc) == name || normalized(row.esri) == name || row.others.contains(&name.as_str())
                })
                .map(|row| row.method),
        };
        match method {
            Some(method) => Self::known(method, get),
            None => Projection::Other(name, stated.to_vec()),
        }
    }

    /// The projection of a method with the stated parameters, and defaults for the others.
    pub(super) fn known(method: Method, get: impl Fn(Param) -> Option<f64>) -> Self {
        let value = |param: &Param| {
            get(param.clone()).or_else(|| match (method, param) {
                // Some formats state a standard parallel, others the latitude of the origin.
                (Method::PolarStereographic, Lat1) => get(Lat0),
                (Method::Lambert1, Lat0) => get(Lat1),
                (Method::Lambert2, Lat2) => get(Lat1),
                (Method::HotineNatural | Method::HotineCenter, Angle) => get(Azimuth),
                (Method::Krovak, Azimuth) => Some(30.288_139_752_777_78),
                (Method::Krovak, PseudoParallel) => Some(78.5),
                _ => None,
            })
        };
        let all = |param: &Param| value(param).unwrap_or(param.default());
        // The table has no scale together with two parallels, and no Mercator with a latitude of
        // origin off the equator.
        if method == Method::Lambert2 && (all(&K0) - 1.0).abs() > SAME_RATIO {
            let stated = [Lat0, Lon0, Lat1, Lat2, K0, FalseEasting, FalseNorthing].map(|p| (p.clone(), all(&p)));
            return Projection::Other("lambertconformalconic2spscaled".into(), stated.to_vec());
        }
        Projection::Known(method, method.row().params.iter().map(|(param, ..)| all(param)).collect())
    }

    pub(super) fn get(&self, wanted: &Param) -> Option<f64> {
        match self {
            Projection::Known(method, values) => {
                method.row().params.iter().zip(values).find(|((param, ..), _)| param == wanted).map(|(_, value)| *value)
            }
            Projection::Other(_, stated) => stated.iter().find(|entry| entry.0 == *wanted).map(|entry| entry.1),
        }
    }

    /// Returns true if both map a position to the same coordinates, to about a millimeter.
    pub(super) fn is_same(&self, other: &Projection) -> bool {
        match (self, other) {
            (Projection::Known(a, values), Projection::Known(b, others)) => {
                let same = |(param, x, y): (&Param, f64, f64)| is_near(param, x, y);
                let params = || a.row().params.iter().map(|entry| &entry.0);
                let straight = || params().zip(values).zip(others).all(|((p, x), y)| same((p, *x, *y)));
                // The order of two standard parallels does not matter.
                let swapped = || {
                    let swap = |param: &Param| match param {
                        Param::Lat1 => Param::Lat2,
                        Param::Lat2 => Param::Lat1,
                        other => other.clone(),
                    };
                    params().zip(values).all(|(p, x)| other.get(&swap(p)).is_some_and(|y| same((p, *x, y))))
                };
                a == b && (straight() || (matches!(a, Method::Lambert2 | Method::Albers) && swapped()))
            }
            (Projection::Other(a, values), Projection::Other(b, others)) => {
                a == b
                    && values.len() == others.len()
                    && values.iter().all(|(p, x)| other.get(p).is_some_and(|y| is_near(p, *x, y)))
            }
            _ => false,
        }
    }

    /// The projection of a definition in the registry.
    pub(super) fn from_registry(method: ProjectionMethod) -> Self {
        use ProjectionMethod as P;
        let make = |method: Method, stated: &[(Param, f64)]| {
            Self::known(method, |param| stated.iter().find(|entry| entry.0 == param).map(|entry| entry.1))
        };
        let other = |name: &str, stated: &[(Param, f64)]| Projection::Other(name.into(), stated.to_vec());
        match method {
            P::WebMercator => make(Method::WebMercator, &[]),
            P::TransverseMercator { lon0, lat0, k0, false_easting, false_northing } => make(
                Method::TransverseMercator,
                &[(Lat0, lat0), (Lon0, lon0), (K0, k0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::PolarStereographic { lon0, lat_ts, k0, false_easting, false_northing } => make(
                Method::PolarStereographic,
                &[
                    (Lat1, lat_ts),
                    (Lon0, lon0),
                    (K0, k0),
                    (FalseEasting, false_easting),
                    (FalseNorthing, false_northing),
                ],
            ),
            P::LambertConformalConic { lon0, lat0, lat1, lat2, k0, false_easting, false_northing } => {
                let one = (lat1 - lat2).abs() < SAME_ANGLE && (lat1 - lat0).abs() < SAME_ANGLE;
                make(
                    if one { Method::Lambert1 } else { Method::Lambert2 },
                    &[
                        (Lat0, lat0),
                        (Lon0, lon0),
                        (Lat1, lat1),
                        (Lat2, lat2),
                        (K0, k0),
                        (FalseEasting, false_easting),
                        (FalseNorthing, false_northing),
                    ],
                )
            }
            P::AlbersEqualArea { lon0, lat0, lat1, lat2, false_easting, false_northing } => make(
                Method::Albers,
                &[
                    (Lat0, lat0),
                    (Lon0, lon0),
                    (Lat1, lat1),
                    (Lat2, lat2),
                    (FalseEasting, false_easting),
                    (FalseNorthing, false_northing),
                ],
            ),
            P::LambertAzimuthalEqualArea { lon0, lat0, false_easting, false_northing } => make(
                Method::LambertAzimuthal,
                &[(Lat0, lat0), (Lon0, lon0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::ObliqueStereographic { lon0, lat0, k0, false_easting, false_northing } => make(
                Method::ObliqueStereographic,
                &[(Lat0, lat0), (Lon0, lon0), (K0, k0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::HotineObliqueMercator {
                latc,
                lonc,
                azimuth,
                rectified_grid_angle,
                k0,
                false_easting,
                false_northing,
                variant_b,
            } => make(
                if variant_b { Method::HotineCenter } else { Method::HotineNatural },
                &[
                    (Lat0, latc),
                    (Lon0, lonc),
                    (Azimuth, azimuth),
                    (Angle, rectified_grid_angle),
                    (K0, k0),
                    (FalseEasting, false_easting),
                    (FalseNorthing, false_northing),
                ],
            ),
            P::CassiniSoldner { lon0, lat0, false_easting, false_northing } => make(
                Method::Cassini,
                &[(Lat0, lat0), (Lon0, lon0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::Mercator { lon0, lat_ts, k0, false_easting, false_northing } => make(
                Method::Mercator,
                &[
                    (Lon0, lon0),
                    (Lat1, lat_ts),
                    (K0, k0),
                    (FalseEasting, false_easting),
                    (FalseNorthing, false_northing),
                ],
            ),
            P::EquidistantCylindrical { lon0, lat_ts, false_easting, false_northing } => make(
                Method::Equirectangular,
                &[(Lon0, lon0), (Lat1, lat_ts), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::KrovakNorthOrientated {
                lon0,
                lat0,
                co_latitude_cone_axis,
                lat_pseudo_standard_parallel,
                k0,
                false_easting,
                false_northing,
            } => make(
                Method::Krovak,
                &[
                    (Lat0, lat0),
                    (Lon0, lon0),
                    (Azimuth, co_latitude_cone_axis),
                    (PseudoParallel, lat_pseudo_standard_parallel),
                    (K0, k0),
                    (FalseEasting, false_easting),
                    (FalseNorthing, false_northing),
                ],
            ),
            P::EqualEarth { lon0, false_easting, false_northing } => make(
                Method::EqualEarth,
                &[(Lon0, lon0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::AmericanPolyconic { lon0, lat0, false_easting, false_northing } => make(
                Method::Polyconic,
                &[(Lat0, lat0), (Lon0, lon0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::AzimuthalEquidistant { lon0, lat0, false_easting, false_northing } => make(
                Method::AzimuthalEquidistant,
                &[(Lat0, lat0), (Lon0, lon0), (FalseEasting, false_easting), (FalseNorthing, false_northing)],
            ),
            P::LambertConformalConicMichigan {
                lon0,
                lat0,
                lat1,
                lat2,
                ellipsoid_scaling_factor,
                false_easting,
                false_northing,
            } => other(
                "lambertconicconformal2spmichigan",
                &[
                    (Lat0, lat0),
                    (Lon0, lon0),
                    (Lat1, lat1),
                    (Lat2, lat2),
                    (Param::Other("ellipsoidscalingfactor".into()), ellipsoid_scaling_factor),
                    (FalseEasting, false_easting),
                    (FalseNorthing, false_northing),
                ],
            ),
            // Rare methods are known by their codes alone.
            rare => Projection::Other(format!("{rare:?}"), Vec::new()),
        }
    }
}

fn is_near(param: &Param, a: f64, b: f64) -> bool {
    let off = (a - b).abs();
    match param.measure() {
        Measure::Angle => off < SAME_ANGLE || (off - 360.0).abs() < SAME_ANGLE,
        Measure::Length => off < SAME_LENGTH,
        Measure::Ratio => off < SAME_RATIO,
    }
}

/// A name reduced to lower case letters and digits: formats differ in blanks, underscores and
/// brackets.
pub(super) fn normalized(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use super::{Method, Param, Projection, ROWS};

    #[test]
    fn one_lambert_name_is_two_methods() {
        let one = Projection::new(
            "Lambert_Conformal_Conic",
            &[(Param::Lat1, 52.0), (Param::Lat0, 52.0), (Param::K0, 0.9999)],
        );
        assert!(matches!(one, Projection::Known(Method::Lambert1, _)));
        let two = Projection::new("Lambert_Conformal_Conic", &[(Param::Lat1, 40.0), (Param::Lat2, 43.0)]);
        let swapped = Projection::new("Lambert Conic Conformal (2SP)", &[(Param::Lat1, 43.0), (Param::Lat2, 40.0)]);
        assert!(two.is_same(&swapped));
        assert!(!two.is_same(&Projection::new("Albers", &[(Param::Lat1, 43.0), (Param::Lat2, 40.0)])));
    }

    #[test]
    fn parameters_of_the_table_have_the_meaning_that_their_names_say() {
        for row in ROWS {
            for (param, ogc, esri, _) in row.params {
                if row.method != Method::PolarStereographic {
                    assert_eq!(Param::from_name(ogc), *param, "{}", row.ogc);
                }
                assert_eq!(Param::from_name(esri), *param, "{}", row.esri);
            }
        }
    }
}

//! The table of projection methods and their parameters, for reading and writing WKT 1 (OGC and
//! Esri), WKT 2 and GeoKeys.

/// The meaning of a parameter, independent of its name in a format.
///
/// Angles are in degrees from the prime meridian of the datum, lengths in meters.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Param {
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
pub(crate) enum Measure {
    Angle,
    Length,
    Ratio,
}

impl Param {
    pub(crate) fn measure(&self) -> Measure {
        match self {
            Param::FalseEasting | Param::FalseNorthing => Measure::Length,
            Param::K0 | Param::Other(_) => Measure::Ratio,
            _ => Measure::Angle,
        }
    }

    /// The parameter with a name in WKT of any version.
    pub(crate) fn from_name(name: &str) -> Self {
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
            "rectifiedgridangle" | "anglefromrectifiedtoskewgrid" | "xyplanerotation" => {
                Param::Angle
            }
            "pseudostandardparallel1" | "latitudeofpseudostandardparallel" => Param::PseudoParallel,
            "falseeasting"
            | "eastingatfalseorigin"
            | "eastingatprojectioncenter"
            | "eastingatprojectioncentre" => Param::FalseEasting,
            "falsenorthing"
            | "northingatfalseorigin"
            | "northingatprojectioncenter"
            | "northingatprojectioncentre" => Param::FalseNorthing,
            _ => Param::Other(name),
        }
    }

    /// The value of a parameter that is not stated.
    pub(super) fn default(&self) -> f64 {
        match self {
            Param::K0 => 1.0,
            _ => 0.0,
        }
    }
}

/// A method that all formats here can write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
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
pub(crate) struct Row {
    pub(crate) method: Method,
    /// The name in GDAL's WKT 1.
    pub(crate) ogc: &'static str,
    /// The name in Esri's WKT 1.
    pub(crate) esri: &'static str,
    /// Further names, normalized: those of WKT 2, and older ones.
    pub(super) others: &'static [&'static str],
    /// The value of ProjCoordTransGeoKey.
    pub(crate) geokey: Option<u16>,
    /// The parameters, with the names in GDAL's and Esri's WKT 1 and the GeoKey.
    pub(crate) params: &'static [(Param, &'static str, &'static str, u16)],
}

use Param::{
    Angle, Azimuth, FalseEasting, FalseNorthing, K0, Lat0, Lat1, Lat2, Lon0, PseudoParallel,
};

const LAT0: (Param, &str, &str, u16) = (Lat0, "latitude_of_origin", "Latitude_Of_Origin", 3081);
const LON0: (Param, &str, &str, u16) = (Lon0, "central_meridian", "Central_Meridian", 3080);
const LAT1: (Param, &str, &str, u16) = (Lat1, "standard_parallel_1", "Standard_Parallel_1", 3078);
const LAT2: (Param, &str, &str, u16) = (Lat2, "standard_parallel_2", "Standard_Parallel_2", 3079);
const SCALE: (Param, &str, &str, u16) = (K0, "scale_factor", "Scale_Factor", 3092);
const EAST: (Param, &str, &str, u16) = (FalseEasting, "false_easting", "False_Easting", 3082);
const NORTH: (Param, &str, &str, u16) = (FalseNorthing, "false_northing", "False_Northing", 3083);
/// Esri names the center of azimuthal methods like an origin.
const AZIMUTHAL_LAT: (Param, &str, &str, u16) =
    (Lat0, "latitude_of_center", "Latitude_Of_Origin", 3089);
const AZIMUTHAL_LON: (Param, &str, &str, u16) =
    (Lon0, "longitude_of_center", "Central_Meridian", 3088);
const CENTER_LAT: (Param, &str, &str, u16) =
    (Lat0, "latitude_of_center", "Latitude_Of_Center", 3089);
const CENTER_LON: (Param, &str, &str, u16) =
    (Lon0, "longitude_of_center", "Longitude_Of_Center", 3088);
const OBLIQUE: &[(Param, &str, &str, u16)] = &[
    CENTER_LAT,
    CENTER_LON,
    (Azimuth, "azimuth", "Azimuth", 3094),
    (Angle, "rectified_grid_angle", "XY_Plane_Rotation", 3096),
    (K0, "scale_factor", "Scale_Factor", 3093),
    EAST,
    NORTH,
];

pub(crate) const ROWS: &[Row] = &[
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
        params: &[AZIMUTHAL_LAT, AZIMUTHAL_LON, EAST, NORTH],
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
        others: &[
            "popularvisualisationpseudomercator",
            "popularvisualizationpseudomercator",
        ],
        geokey: None,
        params: &[LON0, LAT1, EAST, NORTH],
    },
    Row {
        method: Method::HotineNatural,
        ogc: "Hotine_Oblique_Mercator",
        esri: "Hotine_Oblique_Mercator_Azimuth_Natural_Origin",
        others: &[
            "hotineobliquemercatorvarianta",
            "rectifiedskeworthomorphicnaturalorigin",
        ],
        geokey: Some(3),
        params: OBLIQUE,
    },
    Row {
        method: Method::HotineCenter,
        ogc: "Hotine_Oblique_Mercator_Azimuth_Center",
        esri: "Hotine_Oblique_Mercator_Azimuth_Center",
        others: &[
            "hotineobliquemercatorvariantb",
            "rectifiedskeworthomorphiccenter",
            "obliquemercator",
        ],
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
            (
                PseudoParallel,
                "pseudo_standard_parallel_1",
                "Pseudo_Standard_Parallel_1",
                3078,
            ),
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
        params: &[AZIMUTHAL_LAT, AZIMUTHAL_LON, EAST, NORTH],
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
    pub(crate) fn row(self) -> &'static Row {
        ROWS.iter()
            .find(|row| row.method == self)
            .unwrap_or(&ROWS[0])
    }
}

/// A name reduced to lower case letters and digits: formats differ in blanks, underscores and
/// brackets.
pub(crate) fn normalized(name: &str) -> String {
    name.chars()
        .filter(char::is_ascii_alphanumeric)
        .map(|c| c.to_ascii_lowercase())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{Method, Param, ROWS};

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

//! Projections of definitions in the registry.

use proj_core::ProjectionMethod;

use super::{Method, Param, Projection, SAME_ANGLE, stated_value};

/// Writes a function that maps the methods of the registry to those of the table. Each row has a
/// method of the registry, the method of the table, and the parameter that each field of the former
/// is.
macro_rules! methods_of_the_registry {
    ($($registered:ident => $method:ident { $($field:ident: $param:ident),* })*) => {
        /// The method of the table that is the same as a method of the registry, with its
        /// parameters; `None` if there is none, or if it depends on the parameters.
        fn same_method(method: ProjectionMethod) -> Option<(Method, Vec<(Param, f64)>)> {
            Some(match method {
                $(ProjectionMethod::$registered { $($field),* } => {
                    (Method::$method, vec![$((Param::$param, $field)),*])
                })*
                _ => return None,
            })
        }
    };
}

methods_of_the_registry! {
    WebMercator => WebMercator {}
    TransverseMercator => TransverseMercator {
        lat0: Lat0, lon0: Lon0, k0: K0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    PolarStereographic => PolarStereographic {
        lat_ts: Lat1, lon0: Lon0, k0: K0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    AlbersEqualArea => Albers {
        lat0: Lat0, lon0: Lon0, lat1: Lat1, lat2: Lat2,
        false_easting: FalseEasting, false_northing: FalseNorthing
    }
    LambertAzimuthalEqualArea => LambertAzimuthal {
        lat0: Lat0, lon0: Lon0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    ObliqueStereographic => ObliqueStereographic {
        lat0: Lat0, lon0: Lon0, k0: K0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    CassiniSoldner => Cassini {
        lat0: Lat0, lon0: Lon0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    Mercator => Mercator {
        lon0: Lon0, lat_ts: Lat1, k0: K0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    EquidistantCylindrical => Equirectangular {
        lon0: Lon0, lat_ts: Lat1, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    KrovakNorthOrientated => Krovak {
        lat0: Lat0, lon0: Lon0, co_latitude_cone_axis: Azimuth,
        lat_pseudo_standard_parallel: PseudoParallel, k0: K0,
        false_easting: FalseEasting, false_northing: FalseNorthing
    }
    EqualEarth => EqualEarth {
        lon0: Lon0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    AmericanPolyconic => Polyconic {
        lat0: Lat0, lon0: Lon0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
    AzimuthalEquidistant => AzimuthalEquidistant {
        lat0: Lat0, lon0: Lon0, false_easting: FalseEasting, false_northing: FalseNorthing
    }
}

impl Projection {
    /// The projection of a definition in the registry.
    pub(crate) fn from_registry(registered: ProjectionMethod) -> Self {
        use Param::{Angle, Azimuth, FalseEasting, FalseNorthing, K0, Lat0, Lat1, Lat2, Lon0};
        use ProjectionMethod as P;
        let origin = |lat: f64, lon: f64| [(Lat0, lat), (Lon0, lon)];
        let parallels = |first: f64, second: f64| [(Lat1, first), (Lat2, second)];
        let false_origin = |east: f64, north: f64| [(FalseEasting, east), (FalseNorthing, north)];
        match registered {
            P::LambertConformalConic {
                lon0,
                lat0,
                lat1,
                lat2,
                k0,
                false_easting,
                false_northing,
            } => {
                let one = (lat1 - lat2).abs() < SAME_ANGLE && (lat1 - lat0).abs() < SAME_ANGLE;
                let stated = [
                    &origin(lat0, lon0)[..],
                    &parallels(lat1, lat2),
                    &[(K0, k0)],
                    &false_origin(false_easting, false_northing),
                ];
                Self::stated(
                    if one {
                        Method::Lambert1
                    } else {
                        Method::Lambert2
                    },
                    &stated.concat(),
                )
            }
            P::HotineObliqueMercator {
                latc,
                lonc,
                azimuth,
                rectified_grid_angle,
                k0,
                false_easting,
                false_northing,
                variant_b,
            } => {
                let stated = [
                    &origin(latc, lonc)[..],
                    &[(Azimuth, azimuth), (Angle, rectified_grid_angle), (K0, k0)],
                    &false_origin(false_easting, false_northing),
                ];
                let method = if variant_b {
                    Method::HotineCenter
                } else {
                    Method::HotineNatural
                };
                Self::stated(method, &stated.concat())
            }
            P::LambertConformalConicMichigan {
                lon0,
                lat0,
                lat1,
                lat2,
                ellipsoid_scaling_factor,
                false_easting,
                false_northing,
            } => {
                let scaling = Param::Other("ellipsoidscalingfactor".into());
                let stated = [
                    &origin(lat0, lon0)[..],
                    &parallels(lat1, lat2),
                    &[(scaling, ellipsoid_scaling_factor)],
                    &false_origin(false_easting, false_northing),
                ];
                Projection::Other("lambertconicconformal2spmichigan".into(), stated.concat())
            }
            // Rare methods are known by their codes alone.
            registered => same_method(registered)
                .map(|(method, stated)| Self::stated(method, &stated))
                .unwrap_or_else(|| Projection::Other(format!("{registered:?}"), Vec::new())),
        }
    }

    /// The projection of a method of the table with the stated parameters.
    fn stated(method: Method, stated: &[(Param, f64)]) -> Self {
        Self::known(method, |param| stated_value(stated, &param))
    }
}

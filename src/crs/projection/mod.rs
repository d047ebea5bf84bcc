//! Projections: a method with values for its parameters, whatever the format says about them.

mod from_registry;
mod methods;

use methods::Param::{
    Angle, Azimuth, FalseEasting, FalseNorthing, K0, Lat0, Lat1, Lat2, Lon0, PseudoParallel,
};

pub(super) use methods::{Measure, Method, Param, ROWS, normalized};

/// A method with a value for each of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Projection {
    /// A method of the table, with values in the order of [`Row::params`](methods::Row::params).
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

/// The value that is stated for a parameter.
fn stated_value(stated: &[(Param, f64)], wanted: &Param) -> Option<f64> {
    stated
        .iter()
        .find(|(param, _)| param == wanted)
        .map(|(_, value)| *value)
}

impl Projection {
    /// The projection with the name of a method in WKT and its parameters.
    pub(super) fn new(name: &str, stated: &[(Param, f64)]) -> Self {
        let name = normalized(name);
        let get = |param: Param| stated_value(stated, &param);
        let method = match name.as_str() {
            "lambertconformalconic" | "lambertconicconformal" => {
                match (get(Lat1), get(Lat2), get(Lat0)) {
                    (Some(_), Some(_), _) => Some(Method::Lambert2),
                    (Some(lat1), None, Some(lat0)) if (lat1 - lat0).abs() > SAME_ANGLE => {
                        Some(Method::Lambert2)
                    }
                    _ => Some(Method::Lambert1),
                }
            }
            "stereographic"
                if get(Lat0).is_some_and(|lat| (lat.abs() - 90.0).abs() < SAME_ANGLE) =>
            {
                Some(Method::PolarStereographic)
            }
            _ => ROWS
                .iter()
                .find(|row| {
                    normalized(row.ogc) == name
                        || normalized(row.esri) == name
                        || row.others.contains(&name.as_str())
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
            let stated = [Lat0, Lon0, Lat1, Lat2, K0, FalseEasting, FalseNorthing]
                .map(|p| (p.clone(), all(&p)));
            return Projection::Other("lambertconformalconic2spscaled".into(), stated.to_vec());
        }
        Projection::Known(
            method,
            method
                .row()
                .params
                .iter()
                .map(|(param, ..)| all(param))
                .collect(),
        )
    }

    pub(super) fn get(&self, wanted: &Param) -> Option<f64> {
        match self {
            Projection::Known(method, values) => method
                .row()
                .params
                .iter()
                .zip(values)
                .find(|((param, ..), _)| param == wanted)
                .map(|(_, value)| *value),
            Projection::Other(_, stated) => stated_value(stated, wanted),
        }
    }

    /// Returns true if both map a position to the same coordinates, to about a millimeter.
    pub(super) fn is_same(&self, other: &Projection) -> bool {
        match (self, other) {
            (Projection::Known(a, values), Projection::Known(b, others)) => {
                let same = |(param, x, y): (&Param, f64, f64)| is_near(param, x, y);
                let params = || a.row().params.iter().map(|entry| &entry.0);
                let straight = || {
                    params()
                        .zip(values)
                        .zip(others)
                        .all(|((p, x), y)| same((p, *x, *y)))
                };
                // The order of two standard parallels does not matter.
                let swapped = || {
                    let swap = |param: &Param| match param {
                        Param::Lat1 => Param::Lat2,
                        Param::Lat2 => Param::Lat1,
                        other => other.clone(),
                    };
                    params()
                        .zip(values)
                        .all(|(p, x)| other.get(&swap(p)).is_some_and(|y| same((p, *x, y))))
                };
                a == b
                    && (straight() || (matches!(a, Method::Lambert2 | Method::Albers) && swapped()))
            }
            (Projection::Other(a, values), Projection::Other(b, others)) => {
                a == b
                    && values.len() == others.len()
                    && values
                        .iter()
                        .all(|(p, x)| other.get(p).is_some_and(|y| is_near(p, *x, y)))
            }
            _ => false,
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

#[cfg(test)]
mod tests {
    use super::{Method, Param, Projection};

    #[test]
    fn one_lambert_name_is_two_methods() {
        let one = Projection::new(
            "Lambert_Conformal_Conic",
            &[
                (Param::Lat1, 52.0),
                (Param::Lat0, 52.0),
                (Param::K0, 0.9999),
            ],
        );
        assert!(matches!(one, Projection::Known(Method::Lambert1, _)));
        let two = Projection::new(
            "Lambert_Conformal_Conic",
            &[(Param::Lat1, 40.0), (Param::Lat2, 43.0)],
        );
        let swapped = Projection::new(
            "Lambert Conic Conformal (2SP)",
            &[(Param::Lat1, 43.0), (Param::Lat2, 40.0)],
        );
        assert!(two.is_same(&swapped));
        assert!(!two.is_same(&Projection::new(
            "Albers",
            &[(Param::Lat1, 43.0), (Param::Lat2, 40.0)]
        )));
    }
}

//! Names that `proj-core` lacks, from the WKT definitions of `crs-definitions` (which are those of
//! PostGIS).

use std::collections::HashMap;
use std::sync::OnceLock;

use super::Unit;
use super::wkt_tree::Node;

/// The names of a datum in a definition.
pub(super) struct DatumNames {
    /// The name of the datum, with underscores for blanks, as in WKT 1.
    pub(super) name: String,
    /// Code of the prime meridian.
    pub(super) meridian: Option<u32>,
}

#[derive(Default)]
struct Geodetic {
    datums: HashMap<u32, DatumNames>,
    ellipsoids: HashMap<u32, String>,
}

/// Name and unit of the projected system with a code.
pub(super) fn projected(code: u32) -> Option<(String, Unit)> {
    let root = parse(u16::try_from(code).ok()?, "PROJCS")?;
    let name = root.name().trim_end_matches(" (deprecated)");
    Some((
        name.to_owned(),
        Unit::length(root.find(&["UNIT"])?.number(0)?),
    ))
}

/// The geodetic datum with a code.
pub(super) fn datum(code: u32) -> Option<&'static DatumNames> {
    geodetic().datums.get(&code)
}

/// The name of the ellipsoid with a code.
pub(super) fn ellipsoid(code: u32) -> Option<&'static str> {
    geodetic().ellipsoids.get(&code).map(String::as_str)
}

/// The name of the vertical datum with a code; some have underscores for blanks.
pub(super) fn vertical_datum(code: u32) -> Option<&'static str> {
    static IN_COMPOUNDS: OnceLock<HashMap<u32, String>> = OnceLock::new();
    if let Some((_, name)) = VERTICAL_DATUMS.iter().find(|row| row.0 == code) {
        return Some(name);
    }
    let found = IN_COMPOUNDS.get_or_init(|| {
        let datums = all("COMPD_CS").filter_map(|root| {
            let datum = root.find(&["VERT_CS"])?.find(&["VERT_DATUM"])?;
            Some((datum.epsg()?, datum.name().to_owned()))
        });
        datums.collect()
    });
    found.get(&code).map(String::as_str)
}

/// Common vertical datums that no compound definition of the crate contains, and whose systems have
/// different names (names of the EPSG registry).
const VERTICAL_DATUMS: &[(u32, &str)] = &[
    (1039, "New Zealand Vertical Datum 2009"),
    (1089, "Mean Lower Low Water"),
    (1161, "Deutsches Haupthoehennetz 1912"),
    (1169, "New Zealand Vertical Datum 2016"),
    (1170, "Deutsches Haupthoehennetz 2016"),
    (1274, "European Vertical Reference Frame 2019"),
    (5100, "Mean Sea Level"),
    (5111, "Australian Height Datum"),
    (5114, "Canadian Geodetic Vertical Datum of 1928"),
    (5127, "Landesnivellement 1902"),
    (5128, "Landeshohennetz 1995"),
    (5171, "EGM96 geoid"),
    (5176, "Gebrauchshohen ADRIA"),
    (5182, "Deutsches Haupthoehennetz 1985"),
    (5203, "EGM84 geoid"),
];

fn geodetic() -> &'static Geodetic {
    static ALL: OnceLock<Geodetic> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut all_names = Geodetic::default();
        for root in all("GEOGCS") {
            let Some(datum) = root.find(&["DATUM"]) else {
                continue;
            };
            if let Some(code) = datum.epsg() {
                let meridian = root.find(&["PRIMEM"]).and_then(Node::epsg);
                let names = || DatumNames {
                    name: datum.name().to_owned(),
                    meridian,
                };
                all_names.datums.entry(code).or_insert_with(names);
            }
            if let Some((ellipsoid, code)) = datum
                .find(&["SPHEROID"])
                .and_then(|node| Some((node, node.epsg()?)))
            {
                all_names
                    .ellipsoids
                    .entry(code)
                    .or_insert_with(|| ellipsoid.name().to_owned());
            }
        }
        all_names
    })
}

/// The definitions that begin with a keyword, by code.
fn all(keyword: &'static str) -> impl Iterator<Item = Node> {
    (0..=u16::MAX).filter_map(move |code| parse(code, keyword))
}

fn parse(code: u16, keyword: &str) -> Option<Node> {
    let wkt = crs_definitions::from_code(code)?.wkt;
    // The keyword is checked first, because most definitions are not wanted.
    let nodes = wkt
        .strip_prefix(keyword)
        .filter(|rest| rest.starts_with('['))
        .and_then(|_| Node::parse_all(wkt).ok());
    nodes?.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::{all, datum, ellipsoid, projected, vertical_datum};

    #[test]
    fn names_are_those_of_the_definitions() {
        assert_eq!(datum(6314).unwrap().name, "Deutsches_Hauptdreiecksnetz");
        assert_eq!(datum(6807).unwrap().meridian, Some(8903));
        assert_eq!(ellipsoid(7004), Some("Bessel 1841"));
        assert_eq!(projected(2053).unwrap().0, "Hartebeesthoek94 / Lo29");
        assert_eq!(projected(2037).unwrap().0, "NAD83(CSRS98) / UTM zone 19N");
        assert_eq!(
            vertical_datum(5103),
            Some("North American Vertical Datum 1988")
        );
        assert!(projected(4326).is_none() && projected(70_000).is_none() && datum(1).is_none());
    }

    #[test]
    fn every_definition_is_read() {
        // A change of form in a later version would be silent otherwise.
        assert_eq!(
            all("GEOGCS")
                .filter(|root| root.find(&["DATUM"]).is_some_and(|d| d.epsg().is_some()))
                .count(),
            545
        );
        assert_eq!(
            all("PROJCS")
                .filter(|root| root.find(&["UNIT"]).is_some_and(|u| u.number(0).is_some()))
                .count(),
            4963
        );
    }
}

//! Esri's names in a `.prj`: EPSG's names by Esri's rule, and the well-known exceptions.
//!
//! The rule: everything except letters, digits, `+` and `-` becomes an underscore, a geographic
//! system begins with `GCS_`, a datum with `D_`, and years have four digits (`ETRS89`,
//! `ETRS_1989`). Many of Esri's names follow no rule: the zones of the State Plane system, for
//! example, contain their FIPS numbers. They get EPSG's names here, because readers identify a
//! system by its parameters.

use super::definition::Datum;

/// EPSG's name of a geographic system, the code of its datum, and Esri's names: after `GCS_`, at
/// the beginning of projected systems, after `D_`. From `.prj` files written by ArcGIS; not checked
/// against a list from Esri.
const WELL_KNOWN: &[(&str, u32, &str, &str, &str)] = &[
    ("WGS 84", 6326, "WGS_1984", "WGS_1984", "WGS_1984"),
    ("WGS 72", 6322, "WGS_1972", "WGS_1972", "WGS_1972"),
    (
        "WGS 72BE",
        6324,
        "WGS_1972_BE",
        "WGS_1972_BE",
        "WGS_1972_BE",
    ),
    ("ETRS89", 6258, "ETRS_1989", "ETRS_1989", "ETRS_1989"),
    ("ED50", 6230, "European_1950", "ED_1950", "European_1950"),
    (
        "NAD27",
        6267,
        "North_American_1927",
        "NAD_1927",
        "North_American_1927",
    ),
    (
        "NAD83",
        6269,
        "North_American_1983",
        "NAD_1983",
        "North_American_1983",
    ),
    (
        "NAD83(HARN)",
        6152,
        "North_American_1983_HARN",
        "NAD_1983_HARN",
        "North_American_1983_HARN",
    ),
    (
        "NAD83(CSRS)",
        6140,
        "North_American_1983_CSRS",
        "NAD_1983_CSRS",
        "North_American_1983_CSRS",
    ),
    (
        "NAD83(NSRS2007)",
        6759,
        "NAD_1983_NSRS2007",
        "NAD_1983_NSRS2007",
        "NAD_1983_NSRS2007",
    ),
    (
        "NAD83(CORS96)",
        1133,
        "NAD_1983_CORS96",
        "NAD_1983_CORS96",
        "NAD_1983_CORS96",
    ),
    (
        "NAD83(2011)",
        1116,
        "NAD_1983_2011",
        "NAD_1983_2011",
        "NAD_1983_2011",
    ),
    (
        "NAD83(PA11)",
        1117,
        "NAD_1983_PA11",
        "NAD_1983_PA11",
        "NAD_1983_PA11",
    ),
    (
        "NAD83(MA11)",
        1118,
        "NAD_1983_MA11",
        "NAD_1983_MA11",
        "NAD_1983_MA11",
    ),
    ("RGF93 v1", 6171, "RGF_1993", "RGF_1993", "RGF_1993"),
    ("NTF", 6275, "NTF", "NTF", "NTF"),
    (
        "DHDN",
        6314,
        "Deutsches_Hauptdreiecksnetz",
        "DHDN",
        "Deutsches_Hauptdreiecksnetz",
    ),
    ("MGI", 6312, "MGI", "MGI", "MGI"),
    ("S-JTSK", 6156, "S_JTSK", "S-JTSK", "S_JTSK"),
    ("OSGB36", 6277, "OSGB_1936", "OSGB_1936", "OSGB_1936"),
    ("BD72", 6313, "Belge_1972", "Belge_1972", "Belge_1972"),
    (
        "HD72",
        6237,
        "Hungarian_1972",
        "Hungarian_1972",
        "Hungarian_1972",
    ),
    (
        "AGD66",
        6202,
        "Australian_1966",
        "AGD_1966",
        "Australian_1966",
    ),
    (
        "AGD84",
        6203,
        "Australian_1984",
        "AGD_1984",
        "Australian_1984",
    ),
    ("GDA94", 6283, "GDA_1994", "GDA_1994", "GDA_1994"),
    (
        "NZGD49",
        6272,
        "New_Zealand_1949",
        "NZGD_1949",
        "New_Zealand_1949",
    ),
    ("NZGD2000", 6167, "NZGD_2000", "NZGD_2000", "NZGD_2000"),
    ("JGD2000", 6612, "JGD_2000", "JGD_2000", "JGD_2000"),
    ("JGD2011", 1128, "JGD_2011", "JGD_2011", "JGD_2011"),
    (
        "SAD69",
        6618,
        "South_American_1969",
        "SAD_1969",
        "South_American_1969",
    ),
    (
        "PSAD56",
        6248,
        "Provisional_S_American_1956",
        "PSAD_1956",
        "Provisional_S_American_1956",
    ),
    (
        "SIRGAS 2000",
        6674,
        "SIRGAS_2000",
        "SIRGAS_2000",
        "SIRGAS_2000",
    ),
    (
        "Pulkovo 1942(58)",
        6179,
        "Pulkovo_1942_Adj_1958",
        "Pulkovo_1942_Adj_1958",
        "Pulkovo_1942_Adj_1958",
    ),
    (
        "Pulkovo 1942(83)",
        6178,
        "Pulkovo_1942_Adj_1983",
        "Pulkovo_1942_Adj_1983",
        "Pulkovo_1942_Adj_1983",
    ),
];

/// Ellipsoids with different names at Esri, from the same pages.
const ELLIPSOIDS: &[(&str, &str)] = &[
    ("WGS 84", "WGS_1984"),
    ("WGS 72", "WGS_1972"),
    ("Krassowsky 1940", "Krasovsky_1940"),
    ("Australian National Spheroid", "Australian"),
    ("Indonesian National Spheroid", "Indonesian"),
    ("GRS 1967 Modified", "GRS_1967_Truncated"),
    ("Airy Modified 1849", "Airy_Modified"),
];

/// Projected systems with a name of their own (ArcGIS REST documentation, "Projected coordinate
/// systems").
const PROJECTED: &[(u32, &str)] = &[
    (2154, "RGF_1993_Lambert_93"),
    (2193, "NZGD_2000_New_Zealand_Transverse_Mercator"),
    (3005, "NAD_1983_BC_Environment_Albers"),
    (3035, "ETRS_1989_LAEA"),
    (3857, "WGS_1984_Web_Mercator_Auxiliary_Sphere"),
    (5070, "NAD_1983_Contiguous_USA_Albers"),
    (27700, "British_National_Grid"),
    (28992, "RD_New"),
    (5520, "DHDN_3_Degree_Gauss_Zone_1"),
    (31466, "DHDN_3_Degree_Gauss_Zone_2"),
    (31467, "DHDN_3_Degree_Gauss_Zone_3"),
    (31468, "DHDN_3_Degree_Gauss_Zone_4"),
    (31469, "DHDN_3_Degree_Gauss_Zone_5"),
    (32661, "UPS_North"),
    (32761, "UPS_South"),
];

/// Words within the names of projected systems.
const WORDS: &[(&str, &str)] = &[
    ("3-degree Gauss-Kruger", "3_Degree_GK"),
    ("Gauss-Kruger zone", "GK_Zone"),
    ("zone", "Zone"),
];

/// Esri's name of a datum.
pub(super) fn datum(datum: &Datum) -> String {
    let known = WELL_KNOWN.iter().find(|row| Some(row.1) == datum.code);
    known.map_or_else(|| prefixed("D_", &datum.name), |row| format!("D_{}", row.4))
}

/// Esri's name of an ellipsoid.
pub(super) fn ellipsoid(name: &str) -> String {
    let known = ELLIPSOIDS.iter().find(|row| row.0 == name);
    known.map_or_else(|| underscored(name), |row| row.1.to_owned())
}

/// Esri's name of a geographic system.
pub(super) fn geographic(name: &str) -> String {
    let known = WELL_KNOWN.iter().find(|row| row.0 == name);
    known.map_or_else(|| prefixed("GCS_", name), |row| format!("GCS_{}", row.2))
}

/// Esri's name of a projected system.
pub(super) fn projected(name: &str, code: Option<u32>) -> String {
    if let Some(row) = PROJECTED.iter().find(|row| Some(row.0) == code) {
        return row.1.to_owned();
    }
    // "ETRS89 / UTM zone 32N"
    let Some((geographic, rest)) = name.split_once(" / ") else {
        return underscored(name);
    };
    let geographic = WELL_KNOWN
        .iter()
        .find(|row| row.0 == geographic)
        .map_or(geographic, |row| row.3);
    let rest = WORDS.iter().fold(rest.to_owned(), |text, (epsg, esri)| {
        text.replace(epsg, esri)
    });
    underscored(&format!("{geographic}_{rest}"))
}

fn prefixed(prefix: &str, name: &str) -> String {
    let name = underscored(name);
    if name.starts_with(prefix) {
        name
    } else {
        format!("{prefix}{name}")
    }
}

/// Replaces signs by underscores: "ETRS89 / UTM zone 32N" becomes "ETRS89_UTM_zone_32N". Signs that
/// have a meaning ("CH1903+") stay.
pub(super) fn underscored(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_alphanumeric() || "+-".contains(c) {
            text.push(c);
        } else if !text.is_empty() && !text.ends_with('_') {
            text.push('_');
        }
    }
    text.trim_end_matches('_').to_owned()
}

#[cfg(test)]
mod tests {
    use super::{geographic, projected, underscored};
    use crate::crs::registry;

    #[test]
    fn the_rule_and_its_exceptions() {
        assert_eq!(geographic("CH1903+"), "GCS_CH1903+");
        assert_eq!(geographic("NTF (Paris)"), "GCS_NTF_Paris");
        assert_eq!(geographic("NAD83"), "GCS_North_American_1983");
        assert_eq!(
            projected("ETRS89 / UTM zone 32N", Some(25832)),
            "ETRS_1989_UTM_Zone_32N"
        );
        assert_eq!(
            projected("NAD83 / UTM zone 15N", None),
            "NAD_1983_UTM_Zone_15N"
        );
        assert_eq!(projected("CH1903+ / LV95", None), "CH1903+_LV95");
        assert_eq!(
            projected("Pulkovo 1942 / 3-degree Gauss-Kruger zone 46", None),
            "Pulkovo_1942_3_Degree_GK_Zone_46"
        );
        assert_eq!(
            projected("WGS 84 / Pseudo-Mercator", Some(3857)),
            "WGS_1984_Web_Mercator_Auxiliary_Sphere"
        );
        // Esri: NAD_1983_StatePlane_North_Carolina_FIPS_3200_Feet, which nothing in EPSG's name
        // says.
        assert_eq!(
            projected("NAD83 / North Carolina (ftUS)", Some(2264)),
            "NAD_1983_North_Carolina_ftUS"
        );
        assert_eq!(underscored(" a (b)/c "), "a_b_c");
    }

    #[test]
    fn the_exceptions_are_of_the_registry() {
        for (name, datum, ..) in super::WELL_KNOWN {
            let found = registry::datum_code("", name);
            assert_eq!(found, Some(*datum), "{name}");
        }
        for (code, name) in super::PROJECTED {
            assert!(registry::find(*code).is_some(), "{code} {name}");
        }
    }
}

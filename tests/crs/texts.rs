//! Identifiers and well-known text.

use super::{CODES, custom, last_epsg, output};
use breakline::crs::{Crs, CrsKind, GeoKeys, Unit};

#[test]
fn prj_texts_come_back_as_the_same_system() {
    for &code in CODES {
        let crs = Crs::from_epsg(code).unwrap();
        let prj = crs.to_prj();
        assert!(!prj.contains("AUTHORITY"), "{prj}");
        let back = Crs::from_wkt(&prj).unwrap();
        assert_eq!(back.epsg, Some(code), "{prj}");
        assert!(back.is_same(&crs) && crs.is_same(&back), "{prj}");
        let wkt = Crs::from_wkt(&crs.to_wkt()).unwrap();
        assert!(wkt.is_same(&crs), "{}", crs.to_wkt());
        // And without the codes, from GDAL's names.
        let bare = regex_free_of_authority(&crs.to_wkt());
        assert_eq!(Crs::from_wkt(&bare).unwrap().epsg, Some(code), "{bare}");
    }
}

fn regex_free_of_authority(wkt: &str) -> String {
    let mut text = wkt.to_owned();
    while let Some(start) = text.find(",AUTHORITY[") {
        let end = start + text[start..].find(']').unwrap() + 1;
        text.replace_range(start..end, "");
    }
    text
}

#[test]
fn gdal_identifies_our_prj_texts() {
    let folder = tempfile::tempdir().unwrap();
    for &code in CODES {
        let path = folder.path().join(format!("{code}.prj"));
        std::fs::write(&path, Crs::from_epsg(code).unwrap().to_prj()).unwrap();
        let path = format!("ESRI::{}", path.display());
        let Some(found) = output("gdalsrsinfo", &["-e", "--single-line", "-o", "wkt2", &path])
        else {
            return;
        };
        // Two codes of one system, that differ in the order of its axes only.
        let wanted = if code == 32661 { 5041 } else { code };
        assert_eq!(last_epsg(&found), Some(wanted), "{found}");
    }
}

#[test]
fn gdal_reads_our_wkt_as_the_code() {
    for &code in CODES {
        let wkt = Crs::from_epsg(code).unwrap().to_wkt();
        let Some(found) = output("gdalsrsinfo", &["--single-line", "-o", "epsg", &wkt]) else {
            return;
        };
        assert!(found.contains(&format!("EPSG:{code}")), "{found} {wkt}");
    }
}

#[test]
fn feet_are_known_from_codes_alone() {
    for (code, name) in [
        (6880, "US survey foot"),
        (2264, "US survey foot"),
        (2994, "foot"),
        (25832, "metre"),
    ] {
        let crs = Crs::from_epsg(code).unwrap();
        assert_eq!(crs.unit.name, name);
        assert_eq!(crs.is_foot(), name != "metre");
    }
    assert_eq!(Crs::from_epsg(6880).unwrap().unit.factor, 12.0 / 39.37);
    assert_eq!(Crs::from_epsg(4326).unwrap().length_unit(), None);
    assert_eq!(Crs::from_epsg(4978).unwrap().kind, CrsKind::Geocentric);
    // No formula in the registry, yet a name and a unit.
    assert_eq!(
        Crs::from_epsg(2053).unwrap().name,
        "Hartebeesthoek94 / Lo29"
    );
}

#[test]
fn what_users_type() {
    for text in [
        "EPSG:25832",
        "epsg:25832",
        " 25832 ",
        "urn:ogc:def:crs:EPSG::25832",
        "urn:ogc:def:crs:EPSG:9.8:25832",
        "urn:x-ogc:def:crs:EPSG:25832",
        "http://www.opengis.net/def/crs/EPSG/0/25832",
        "https://www.opengis.net/def/crs/EPSG/9.8/25832/",
        "http://www.opengis.net/def/crs?authority=EPSG&version=0&code=25832",
        "http://www.opengis.net/gml/srs/epsg.xml#25832",
    ] {
        assert_eq!(Crs::from_user(text).unwrap().epsg, Some(25832), "{text}");
    }
    for text in [
        "OGC:CRS84",
        "CRS84",
        "urn:ogc:def:crs:OGC:1.3:CRS84",
        "urn:ogc:def:crs:OGC::CRS84",
        "http://www.opengis.net/def/crs/OGC/1.3/CRS84",
    ] {
        assert_eq!(Crs::from_user(text).unwrap().epsg, Some(4326), "{text}");
    }
    assert_eq!(
        Crs::from_user("urn:ogc:def:crs:OGC:1.3:CRS83")
            .unwrap()
            .epsg,
        Some(4269)
    );
    assert_eq!(
        Crs::from_user("urn:ogc:def:crs:OGC:1.3:CRS27")
            .unwrap()
            .epsg,
        Some(4267)
    );
    let both = Crs::from_user("EPSG:25832+7837").unwrap();
    assert_eq!((both.epsg, both.vertical_epsg), (Some(25832), Some(7837)));
    for text in [
        "epsg:25832+epsg:7837",
        "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837",
        "urn:ogc:def:crs,crs:EPSG:9.8:25832,crs:EPSG:9.8:7837",
        "URN:OGC:DEF:CRS,CRS:EPSG::25832, CRS:EPSG::7837",
        "urn:x-ogc:def:crs,crs:EPSG:25832,crs:EPSG:7837",
        "http://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/crs/EPSG/0/25832&2=http://www.opengis.net/def/crs/EPSG/0/7837",
        "https://www.opengis.net/def/crs-compound?2=https%3A%2F%2Fwww.opengis.net%2Fdef%2Fcrs%2FEPSG%2F0%2F7837&1=http://opengis.net/def/crs/EPSG/0/25832",
    ] {
        assert_eq!(Crs::from_user(text).unwrap(), both, "{text}");
    }
    assert_eq!(both.vertical_unit, Some(Unit::metre()));
    assert_eq!(both.name, "ETRS89 / UTM zone 32N + DHHN2016 height");
    assert!(both.is_same(&Crs::from_epsg(25832).unwrap()));
    assert!(!both.is_same(&Crs::from_user("EPSG:25832+5783").unwrap()));
    let dutch = Crs::from_epsg(7415).unwrap();
    assert_eq!((dutch.epsg, dutch.vertical_epsg), (Some(28992), Some(5709)));
    for text in [
        "",
        "EPSG:",
        "EPSG:999999",
        "EPSG:1",
        "UTM 32",
        "EPSG:25832+",
        "EPSG:25832+25832",
        "EPSG:5703",
        "PROJCS[",
    ] {
        let error = Crs::from_user(text).unwrap_err().to_string();
        assert!(!error.is_empty(), "{text}");
    }
}

#[test]
fn identifiers_that_are_not_understood_say_why() {
    for (text, why) in [
        (
            "urn:ogc:def:crs:IGNF::LAMB93",
            "the codes of IGNF are not known",
        ),
        (
            "urn:ogc:def:crs:OGC:1.3:AUTO42001",
            "OGC's AUTO42001 is not a system in plan",
        ),
        (
            "urn:ogc:def:crs:OGC:1.3:AUTO42001:99:8888",
            "is not a coordinate system",
        ),
        (
            "urn:ogc:def:crs:OGC:1.3:CRS88",
            "OGC's CRS88 is not a system in plan",
        ),
        (
            "urn:ogc:def:crs,crs:EPSG::4979,cs:PROJ::ENh,coordinateOperation:EPSG::16031",
            "together from a cs",
        ),
        (
            "urn:ogc:def:crs,datum:EPSG::6326,cs:EPSG::6422",
            "together from a datum",
        ),
        (
            "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837,crs:EPSG::5783",
            "has 3 parts",
        ),
        (
            "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::25833",
            "EPSG:25833 is not the code of a vertical",
        ),
        (
            "urn:ogc:def:crs,crs:EPSG::7415,crs:EPSG::7837",
            "has heights of its own",
        ),
        ("urn:ogc:def:crs,crs:EPSG::5783", "EPSG:5783"),
        ("urn:ogc:def:datum:EPSG::6326", "together from a datum"),
        ("urn:adv:crs:ETRS89_UTM32", "is not a coordinate system"),
        (
            "http://www.opengis.net/def/crs/EPSG",
            "is not a coordinate system",
        ),
        (
            "http://www.opengis.net/def/crs-compound?EPSG:25832",
            "is not a coordinate system",
        ),
        (
            "http://spatialreference.org/ref/epsg/25832/",
            "is not a coordinate system",
        ),
        ("urn:ogc:def:crs", "is not a coordinate system"),
        ("urn:ogc:def:crs,", "is not a coordinate system"),
    ] {
        let error = Crs::from_user(text).unwrap_err();
        assert!(error.to_string().contains(why), "{text}: {error}");
        assert!(error.cure_text().is_some(), "{text}");
    }
}

#[test]
fn other_datums_zones_and_units_are_other_systems_whatever_their_names() {
    let utm32 = Crs::from_epsg(25832).unwrap();
    for other in [32632, 25833, 23032] {
        assert!(!utm32.is_same(&Crs::from_epsg(other).unwrap()), "{other}");
    }
    let renamed = utm32.to_prj().replace("ETRS_1989_UTM_Zone_32N", "Projet 7");
    assert!(Crs::from_wkt(&renamed).unwrap().is_same(&utm32));
    let moved = utm32.to_prj().replace("500000.0", "500001.0");
    let moved = Crs::from_wkt(&moved).unwrap();
    assert_eq!(moved.epsg, None);
    assert!(!moved.is_same(&utm32));
    let feet = utm32.to_wkt().replace(
        "UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]]",
        "UNIT[\"foot\",0.3048]",
    );
    let feet = Crs::from_wkt(&feet).unwrap();
    assert_eq!((feet.epsg, feet.unit.name.as_str()), (None, "foot"));
    assert!(!feet.is_same(&utm32));
}

#[test]
fn compound_bound_local_and_vertical_wkt() {
    let wkt = Crs::from_user("EPSG:2994+6360").unwrap().to_wkt();
    let crs = Crs::from_wkt(&wkt).unwrap();
    assert_eq!((crs.epsg, crs.vertical_epsg), (Some(2994), Some(6360)));
    assert_eq!(crs.vertical_unit.as_ref().unwrap().name, "US survey foot");
    assert_eq!(crs.unit.name, "foot");
    let esri = Crs::from_epsg(2994).unwrap().to_prj()
        + ",VERTCS[\"NAVD_1988\",VDATUM[\"North_American_Vertical_Datum_1988\"],PARAMETER[\"Vertical_Shift\",0.0],\
           PARAMETER[\"Direction\",1.0],UNIT[\"Meter\",1.0]]";
    let crs = Crs::from_wkt(&esri).unwrap();
    assert_eq!((crs.epsg, crs.vertical_epsg), (Some(2994), Some(5703)));
    let bound = format!(
        "BOUNDCRS[SOURCECRS[{}],TARGETCRS[{}],ABRIDGEDTRANSFORMATION[\"x\"]]",
        Crs::from_epsg(31287).unwrap().to_wkt(),
        Crs::from_epsg(4326).unwrap().to_wkt()
    );
    assert_eq!(Crs::from_wkt(&bound).unwrap().epsg, Some(31287));
    let local = Crs::from_wkt("LOCAL_CS[\"mine\",UNIT[\"foot\",0.3048]]").unwrap();
    assert_eq!(
        (local.kind, local.unit.name.as_str()),
        (CrsKind::Local, "foot")
    );
    assert!(
        local.is_same(&Crs::from_wkt(&local.to_prj()).unwrap()) || local.to_prj().contains("mine")
    );
    assert!(Crs::from_wkt("VERT_CS[\"x\",UNIT[\"metre\",1]]").is_err());
    assert!(Crs::from_wkt("PROJCS[\"x\"]").is_err());
}

#[test]
fn damaged_wkt_never_panics() {
    let mut state = 99u32;
    let mut next = |below: usize| {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        (state >> 8) as usize % below
    };
    let texts: Vec<String> = [25832, 2056, 3857, 4978, 27572, 5514, 32661]
        .iter()
        .map(|&code| Crs::from_epsg(code).unwrap())
        .flat_map(|crs| [crs.to_prj(), crs.to_wkt()])
        .chain(custom())
        .chain([Crs::from_user("EPSG:2994+6360").unwrap().to_wkt()])
        .collect();
    let parts = [
        "[",
        "]",
        "\"",
        ",",
        "0",
        "-1",
        "1e308",
        "1e-320",
        "nan",
        "AXIS[\"x\",UNIT[\"foot\",0]]",
        "PARAMETER[\"azimuth\",1e300]",
        "é",
        "(",
    ];
    let mut read = 0;
    for round in 0..20_000 {
        let mut text = texts[round % texts.len()].clone();
        for _ in 0..=next(3) {
            let at = (0..=next(text.len() + 1))
                .rev()
                .find(|&at| text.is_char_boundary(at))
                .unwrap();
            let end = (at + next(12)).min(text.len());
            let end = (end..=text.len())
                .find(|&end| text.is_char_boundary(end))
                .unwrap();
            text.replace_range(at..end, parts[next(parts.len())]);
        }
        if let Ok(crs) = Crs::from_wkt(&text) {
            read += 1;
            let _ = (crs.to_prj(), crs.describe(), GeoKeys::from_crs(&crs).crs());
            assert!(crs.is_same(&crs.clone()));
        }
    }
    assert!(read > 1000, "{read}");
}

#[test]
fn projinfo_wkt_of_every_version_is_read_back_as_the_code() {
    for &code in CODES {
        for version in ["WKT1_GDAL", "WKT1_ESRI", "WKT2:2019", "WKT2:2015"] {
            let Some(wkt) = output("projinfo", &["-q", "-o", version, &format!("EPSG:{code}")])
            else {
                return;
            };
            let crs = Crs::from_wkt(&wkt)
                .unwrap_or_else(|error| panic!("EPSG:{code} {version}: {error}\n{wkt}"));
            assert_eq!(crs.epsg, Some(code), "{version}\n{wkt}");
            let bare = wkt
                .replace("ID[\"EPSG\"", "ID[\"NONE\"")
                .replace("AUTHORITY[\"EPSG\"", "AUTHORITY[\"NONE\"");
            let crs = Crs::from_wkt(&bare).unwrap();
            assert_eq!(crs.epsg, Some(code), "{version}\n{bare}");
        }
    }
}

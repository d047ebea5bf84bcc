//! Coordinate systems against real files, and against GDAL's reading of our text and keys (if its
//! tools are installed).

use std::path::Path;
use std::process::Command;

use breakline::crs::{Crs, CrsKind, GeoKeys, RasterType, Unit};
use testkit::shared;

/// The systems that a `.prj` must carry through other programs.
const CODES: &[u32] = &[
    25832, 32633, 26915, 3005, 2154, 27700, 2056, 31287, 3857, 4326, 2264, 2994, 6880, 28992, 3031, 32661, 3035, 5070,
    27572, 5514, 2953, 3395, 2193, 31467, 28356, 4258, 4269, 2949, 32128,
];

/// The output of a program; `None`, with a note, if it is not installed.
fn output(program: &str, args: &[&str]) -> Option<String> {
    match Command::new(program).args(args).output() {
        Ok(done) => Some(String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr)),
        Err(_) => {
            eprintln!("skipped: {program} is not installed");
            None
        }
    }
}

/// The code that a text of GDAL's ends with.
fn last_epsg(text: &str) -> Option<u32> {
    let at = text.rfind("\"EPSG\",")? + 7;
    text[at..].trim_start_matches('"').split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

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
        let Some(found) = output("gdalsrsinfo", &["-e", "--single-line", "-o", "wkt2", &path]) else { return };
        // Two codes of one system, that differ in the order of its axes only.
        let wanted = if code == 32661 { 5041 } else { code };
        assert_eq!(last_epsg(&found), Some(wanted), "{found}");
    }
}

#[test]
fn gdal_reads_our_wkt_as_the_code() {
    for &code in CODES {
        let wkt = Crs::from_epsg(code).unwrap().to_wkt();
        let Some(found) = output("gdalsrsinfo", &["--single-line", "-o", "epsg", &wkt]) else { return };
        assert!(found.contains(&format!("EPSG:{code}")), "{found} {wkt}");
    }
}

/// A minimal TIFF of one pixel with these keys.
fn tiff(keys: &GeoKeys) -> Vec<u8> {
    let ascii: Vec<u8> = keys.ascii.bytes().chain([0]).collect();
    let directory: Vec<u8> = keys.directory.iter().flat_map(|v| v.to_le_bytes()).collect();
    let doubles: Vec<u8> = keys.doubles.iter().flat_map(|v| v.to_le_bytes()).collect();
    let scale: Vec<u8> = [1.0f64, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let tie: Vec<u8> = [0.0f64, 0.0, 0.0, 10.0, 20.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut tags: Vec<(u16, u16, u32, Vec<u8>)> = vec![
        (256, 3, 1, vec![1, 0, 0, 0]),
        (257, 3, 1, vec![1, 0, 0, 0]),
        (258, 3, 1, vec![8, 0, 0, 0]),
        (259, 3, 1, vec![1, 0, 0, 0]),
        (262, 3, 1, vec![1, 0, 0, 0]),
        (273, 4, 1, vec![8, 0, 0, 0]),
        (277, 3, 1, vec![1, 0, 0, 0]),
        (278, 3, 1, vec![1, 0, 0, 0]),
        (279, 4, 1, vec![1, 0, 0, 0]),
        (33550, 12, 3, scale),
        (33922, 12, 6, tie),
        (34735, 3, keys.directory.len() as u32, directory),
    ];
    if !keys.doubles.is_empty() {
        tags.push((34736, 12, keys.doubles.len() as u32, doubles));
    }
    tags.push((34737, 2, ascii.len() as u32, ascii));
    let mut bytes = b"II*\0\x0c\0\0\0\x07\0\0\0".to_vec();
    let mut values = Vec::new();
    let start = 12 + 2 + tags.len() * 12 + 4;
    bytes.extend((tags.len() as u16).to_le_bytes());
    for (tag, kind, count, value) in tags {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(count.to_le_bytes());
        if value.len() <= 4 {
            let mut short = value;
            short.resize(4, 0);
            bytes.extend(short);
        } else {
            bytes.extend(((start + values.len()) as u32).to_le_bytes());
            values.extend(value);
            values.resize(values.len().next_multiple_of(8), 0);
        }
    }
    bytes.extend([0; 4]);
    bytes.extend(values);
    bytes
}

#[test]
fn gdal_reads_our_geokeys_as_the_same_system() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("keys.tif");
    let path_text = path.display().to_string();
    for &code in CODES {
        let crs = Crs::from_epsg(code).unwrap();
        let keys = GeoKeys::from_crs(&crs);
        assert_eq!(keys.raster_type(), RasterType::PixelIsArea);
        assert!(keys.crs().unwrap().unwrap().is_same(&crs), "{code}");
        std::fs::write(&path, tiff(&keys)).unwrap();
        let Some(found) = output("gdalsrsinfo", &["--single-line", "-o", "wkt2", &path_text]) else { return };
        assert_eq!(last_epsg(&found), Some(code), "{found}");
    }
    let crs = Crs::from_user("EPSG:25832+7837").unwrap();
    let keys = GeoKeys::from_crs(&crs);
    assert!(keys.crs().unwrap().unwrap().is_same(&crs));
    assert_eq!(keys.crs().unwrap().unwrap().vertical_epsg, Some(7837));
    std::fs::write(&path, tiff(&keys)).unwrap();
    let found = output("gdalsrsinfo", &["--single-line", "-o", "wkt2", &path_text]).unwrap();
    assert!(found.contains("ID[\"EPSG\",25832]") && found.contains("ID[\"EPSG\",7837]"), "{found}");
}

/// Invented systems, one for every method that GeoKeys can represent, as GDAL writes them.
fn custom() -> Vec<String> {
    let projected = |method: &str, parameters: &str, unit: &str| {
        format!(
            "PROJCS[\"of nobody\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],\
             PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"{method}\"],{parameters},\
             PARAMETER[\"false_easting\",1234.5],PARAMETER[\"false_northing\",-77],{unit}]"
        )
    };
    let metre = "UNIT[\"metre\",1]";
    let foot = "UNIT[\"US survey foot\",0.304800609601219]";
    let plain = "PARAMETER[\"latitude_of_origin\",47.25],PARAMETER[\"central_meridian\",13.5]";
    let scaled = format!("{plain},PARAMETER[\"scale_factor\",0.9997]");
    let conic = "PARAMETER[\"standard_parallel_1\",46],PARAMETER[\"standard_parallel_2\",48.75]";
    let center = "PARAMETER[\"latitude_of_center\",47.25],PARAMETER[\"longitude_of_center\",13.5]";
    let pole = "PARAMETER[\"latitude_of_origin\",-70],PARAMETER[\"central_meridian\",13.5]";
    vec![
        projected("Transverse_Mercator", &scaled, metre),
        projected("Transverse_Mercator", &scaled, foot),
        projected("Lambert_Conformal_Conic_1SP", &scaled, metre),
        projected("Lambert_Conformal_Conic_2SP", &format!("{plain},{conic}"), foot),
        projected("Albers_Conic_Equal_Area", &format!("{center},{conic}"), metre),
        projected("Oblique_Stereographic", &scaled, metre),
        projected("Polar_Stereographic", &format!("{pole},PARAMETER[\"scale_factor\",1]"), metre),
        projected("Mercator_1SP", "PARAMETER[\"central_meridian\",13.5],PARAMETER[\"scale_factor\",0.97]", metre),
        projected("Mercator_2SP", "PARAMETER[\"central_meridian\",13.5],PARAMETER[\"standard_parallel_1\",42]", metre),
        projected("Lambert_Azimuthal_Equal_Area", center, metre),
        projected("Cassini_Soldner", plain, metre),
        projected("Polyconic", plain, metre),
        projected(
            "Hotine_Oblique_Mercator_Azimuth_Center",
            &format!(
                "{center},PARAMETER[\"azimuth\",50],PARAMETER[\"rectified_grid_angle\",50],PARAMETER[\"scale_factor\",0.9999]"
            ),
            metre,
        ),
        projected("Bonne", "PARAMETER[\"standard_parallel_1\",44],PARAMETER[\"central_meridian\",3]", metre),
    ]
}

/// The position that GDAL computes for a point, as a judge independent of names.
fn position(system: &str, point: &[u8]) -> Option<Vec<f64>> {
    use std::io::Write;
    let mut child = Command::new("gdaltransform")
        .args(["-s_srs", "EPSG:4326", "-t_srs", system, "-output_xy"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .ok()?;
    child.stdin.take()?.write_all(point).ok()?;
    let done = child.wait_with_output().ok()?;
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    Some(text.split_whitespace().map(|number| number.parse().unwrap()).collect())
}

#[test]
fn systems_without_a_code_keep_their_coordinates_in_geokeys_and_prj() {
    let folder = tempfile::tempdir().unwrap();
    for wkt in custom() {
        let crs = Crs::from_wkt(&wkt).unwrap();
        assert_eq!(crs.epsg, None, "{wkt}");
        let prj = Crs::from_wkt(&crs.to_prj()).unwrap();
        assert!(prj.is_same(&crs), "{wkt}\n{}", crs.to_prj());
        let keys = GeoKeys::from_crs(&crs);
        let back = keys.crs().unwrap().unwrap();
        assert!(back.is_same(&crs), "{wkt}\n{:?}", back.wkt);
        assert_eq!((back.epsg, &back.unit), (None, &crs.unit));

        let point: &[u8] = if wkt.contains("-70") { b"15 -68\n" } else { b"15 47.5\n" };
        let Some(wanted) = position(&wkt, point) else {
            eprintln!("skipped: gdaltransform is not installed");
            return;
        };
        assert_eq!(wanted.len(), 2, "{wkt}");
        let tif = folder.path().join("keys.tif");
        std::fs::write(&tif, tiff(&keys)).unwrap();
        let from_keys = output("gdalsrsinfo", &["--single-line", "-o", "wkt2", &tif.display().to_string()]).unwrap();
        let from_keys = from_keys.trim().to_owned();
        let path = folder.path().join("our.prj");
        std::fs::write(&path, crs.to_prj()).unwrap();
        let from_prj = format!("ESRI::{}", path.display());
        for (ours, text) in [(&from_keys, &from_keys), (&from_prj, &crs.to_prj())] {
            let found = position(ours, point).unwrap();
            assert!(
                found.len() == 2 && found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-3),
                "{found:?} instead of {wanted:?}\n{wkt}\n{text}"
            );
        }
    }
}

#[test]
fn feet_are_known_from_codes_alone() {
    for (code, name) in [(6880, "US survey foot"), (2264, "US survey foot"), (2994, "foot"), (25832, "metre")] {
        let crs = Crs::from_epsg(code).unwrap();
        assert_eq!(crs.unit.name, name);
        assert_eq!(crs.is_foot(), name != "metre");
    }
    assert_eq!(Crs::from_epsg(6880).unwrap().unit.factor, 12.0 / 39.37);
    assert_eq!(Crs::from_epsg(4326).unwrap().length_unit(), None);
    assert_eq!(Crs::from_epsg(4978).unwrap().kind, CrsKind::Geocentric);
    // No formula in the registry, yet a name and a unit.
    assert_eq!(Crs::from_epsg(2053).unwrap().name, "Hartebeesthoek94 / Lo29");
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
    assert_eq!(Crs::from_user("urn:ogc:def:crs:OGC:1.3:CRS83").unwrap().epsg, Some(4269));
    assert_eq!(Crs::from_user("urn:ogc:def:crs:OGC:1.3:CRS27").unwrap().epsg, Some(4267));
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
    for text in
        ["", "EPSG:", "EPSG:999999", "EPSG:1", "UTM 32", "EPSG:25832+", "EPSG:25832+25832", "EPSG:5703", "PROJCS["]
    {
        let error = Crs::from_user(text).unwrap_err().to_string();
        assert!(!error.is_empty(), "{text}");
    }
}

#[test]
fn identifiers_that_are_not_understood_say_why() {
    for (text, why) in [
        ("urn:ogc:def:crs:IGNF::LAMB93", "the codes of IGNF are not known"),
        ("urn:ogc:def:crs:OGC:1.3:AUTO42001", "OGC's AUTO42001 is not a system in plan"),
        ("urn:ogc:def:crs:OGC:1.3:AUTO42001:99:8888", "is not a coordinate system"),
        ("urn:ogc:def:crs:OGC:1.3:CRS88", "OGC's CRS88 is not a system in plan"),
        ("urn:ogc:def:crs,crs:EPSG::4979,cs:PROJ::ENh,coordinateOperation:EPSG::16031", "together from a cs"),
        ("urn:ogc:def:crs,datum:EPSG::6326,cs:EPSG::6422", "together from a datum"),
        ("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837,crs:EPSG::5783", "has 3 parts"),
        ("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::25833", "EPSG:25833 is not the code of a vertical"),
        ("urn:ogc:def:crs,crs:EPSG::7415,crs:EPSG::7837", "has heights of its own"),
        ("urn:ogc:def:crs,crs:EPSG::5783", "EPSG:5783"),
        ("urn:ogc:def:datum:EPSG::6326", "together from a datum"),
        ("urn:adv:crs:ETRS89_UTM32", "is not a coordinate system"),
        ("http://www.opengis.net/def/crs/EPSG", "is not a coordinate system"),
        ("http://www.opengis.net/def/crs-compound?EPSG:25832", "is not a coordinate system"),
        ("http://spatialreference.org/ref/epsg/25832/", "is not a coordinate system"),
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
    let feet = utm32.to_wkt().replace("UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]]", "UNIT[\"foot\",0.3048]");
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
    assert_eq!((local.kind, local.unit.name.as_str()), (CrsKind::Local, "foot"));
    assert!(local.is_same(&Crs::from_wkt(&local.to_prj()).unwrap()) || local.to_prj().contains("mine"));
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
            let at = (0..=next(text.len() + 1)).rev().find(|&at| text.is_char_boundary(at)).unwrap();
            let end = (at + next(12)).min(text.len());
            let end = (end..=text.len()).find(|&end| text.is_char_boundary(end)).unwrap();
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
            let Some(wkt) = output("projinfo", &["-q", "-o", version, &format!("EPSG:{code}")]) else { return };
            let crs = Crs::from_wkt(&wkt).unwrap_or_else(|error| panic!("EPSG:{code} {version}: {error}\n{wkt}"));
            assert_eq!(crs.epsg, Some(code), "{version}\n{wkt}");
            let bare = wkt.replace("ID[\"EPSG\"", "ID[\"NONE\"").replace("AUTHORITY[\"EPSG\"", "AUTHORITY[\"NONE\"");
            let crs = Crs::from_wkt(&bare).unwrap();
            assert_eq!(crs.epsg, Some(code), "{version}\n{bare}");
        }
    }
}

#[test]
fn damaged_keys_are_errors_and_absent_ones_are_none() {
    let keys = |directory: &[u16]| GeoKeys { directory: directory.to_vec(), ..GeoKeys::default() };
    for none in [
        &[][..],
        &[0, 0],
        &[0; 8],
        &[1, 1, 0, 0],
        &[1, 1, 0, 1, 0, 0, 0, 0],
        &[1, 1, 0, 1, 1025, 0, 1, 1],
        &[1, 1, 0, 1, 1024, 0, 1, 1],
        &[1, 1, 0, 1, 1024, 0, 1, 32767],
    ] {
        assert_eq!(keys(none).crs().unwrap(), None, "{none:?}");
    }
    for bad in [
        &[1, 1][..],
        &[1, 1, 0, 1],
        &[1, 1, 0, 2, 3072, 0, 1, 25832],
        &[1, 1, 0, 1, 3077, 34736, 1, 0],
        &[1, 1, 0, 1, 3072, 99, 1, 0],
        &[1, 1, 0, 1, 3072, 34735, 1, 9],
    ] {
        assert!(keys(bad).crs().is_err(), "{bad:?}");
    }
    // Any shorts are read without a panic.
    let mut state = 7u32;
    for _ in 0..20_000 {
        let mut next = || {
            state = state.wrapping_mul(1664525).wrapping_add(1013904223);
            state >> 16
        };
        const LIKELY: [u16; 24] = [
            0, 1, 2, 3, 1024, 1026, 2048, 2050, 2057, 2059, 3072, 3074, 3075, 3076, 3077, 3080, 4096, 4099, 8, 15,
            32767, 34735, 34736, 34737,
        ];
        let mut directory = vec![1, 1, 0, (next() % 6) as u16];
        for _ in 0..next() % 28 {
            let pick = next();
            directory.push(if pick % 9 == 0 { next() as u16 } else { LIKELY[pick as usize % LIKELY.len()] });
        }
        let keys = GeoKeys { directory, doubles: vec![0.0, f64::NAN, -1.0, 1e300], ascii: "é|PCS Name = |".into() };
        if let Ok(Some(crs)) = keys.crs() {
            let _ = (crs.to_prj(), crs.to_wkt(), GeoKeys::from_crs(&crs), crs.describe(), crs.is_same(&crs.clone()));
        }
    }
}

#[test]
fn a_unit_beside_a_code_is_the_unit_of_the_coordinates() {
    // A file of Nebraska: the code is in meters, the coordinates in US survey feet, and the datum
    // is newer.
    let keys = GeoKeys {
        directory: vec![
            1, 1, 0, 5, 1024, 0, 1, 1, 2048, 0, 1, 6318, 3072, 0, 1, 32104, 3076, 0, 1, 9003, 4099, 0, 1, 9003,
        ],
        ..GeoKeys::default()
    };
    let crs = keys.crs().unwrap().unwrap();
    assert_eq!((crs.epsg, crs.unit.name.as_str()), (Some(6880), "US survey foot"));
    assert_eq!(crs.vertical_unit.unwrap().name, "US survey foot");
}

struct Found {
    keys: GeoKeys,
    wkt: Option<String>,
}

/// The coordinate system records of a LAS file, read by hand.
fn las(path: &Path) -> Found {
    let bytes = std::fs::read(path).unwrap();
    let u16_at = |at: usize| bytes.get(at..at + 2).map_or(0, |b| u16::from_le_bytes([b[0], b[1]]));
    let u32_at = |at: usize| u32::from(u16_at(at)) | u32::from(u16_at(at + 2)) << 16;
    let mut found = Found { keys: GeoKeys::default(), wkt: None };
    let mut at = usize::from(u16_at(94));
    for _ in 0..u32_at(100).min(300) {
        let length = usize::from(u16_at(at + 20));
        let Some(body) = bytes.get(at + 54..at + 54 + length) else { break };
        if bytes[at + 2..].starts_with(b"LASF_Projection") {
            match u16_at(at + 18) {
                34735 => {
                    found.keys.directory = body.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
                }
                34736 => {
                    found.keys.doubles =
                        body.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
                }
                34737 => found.keys.ascii = body.iter().map(|&b| char::from(b)).collect(),
                2112 => found.wkt = Some(String::from_utf8_lossy(body).into_owned()),
                _ => {}
            }
        }
        at += 54 + length;
    }
    found
}

/// The GeoKeys of a TIFF file's first directory, read by hand; `None` for BigTIFF.
fn tiff_keys(path: &Path) -> Option<GeoKeys> {
    let bytes = std::fs::read(path).unwrap();
    let big_endian = bytes.starts_with(b"MM");
    let number = |at: usize, size: usize| -> Option<u64> {
        let slice = bytes.get(at..at.checked_add(size)?)?;
        let fold = |a: u64, b: &u8| a << 8 | u64::from(*b);
        Some(if big_endian { slice.iter().fold(0, fold) } else { slice.iter().rev().fold(0, fold) })
    };
    if number(2, 2)? != 42 {
        return None;
    }
    let ifd = number(4, 4)? as usize;
    let mut keys = GeoKeys::default();
    for i in 0..number(ifd, 2)? as usize {
        let at = ifd + 2 + 12 * i;
        let (tag, count) = (number(at, 2)?, number(at + 4, 4)? as usize);
        let size = match tag {
            34735 => 2,
            34736 => 8,
            34737 => 1,
            _ => continue,
        };
        let start = if size * count <= 4 { at + 8 } else { number(at + 8, 4)? as usize };
        let values = (0..count).map_while(|k| number(start + size * k, size));
        match tag {
            34735 => keys.directory = values.map(|v| v as u16).collect(),
            34736 => keys.doubles = values.map(f64::from_bits).collect(),
            _ => keys.ascii = values.map(|v| char::from(v as u8)).collect(),
        }
    }
    Some(keys)
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn real_files_have_the_systems_that_the_facts_state() {
    // Python wrote it.
    let facts =
        std::fs::read_to_string(shared("FACTS.json")).unwrap().replace("NaN", "null").replace("-Infinity", "null");
    let facts: serde_json::Value = serde_json::from_str(&facts.replace("Infinity", "null")).unwrap();
    let (mut coded, mut none, mut named) = (0, 0, 0);
    for (file, fact) in facts.as_object().unwrap() {
        let Some(wanted) = fact.get("crs") else { continue };
        let path = shared(file);
        let found = if file.ends_with(".las") || file.ends_with(".laz") {
            las(&path)
        } else if file.ends_with(".tif") || file.ends_with(".tiff") {
            match tiff_keys(&path) {
                Some(keys) => Found { keys, wkt: None },
                None => continue,
            }
        } else {
            continue;
        };
        let from_keys = found.keys.crs().unwrap_or_else(|error| panic!("{file}: {error}"));
        let wkt = found.wkt.filter(|wkt| !wkt.trim_matches('\0').is_empty());
        let from_wkt = wkt.map(|wkt| Crs::from_wkt(&wkt).unwrap_or_else(|error| panic!("{file}: {error}")));
        let crs = from_wkt.or(from_keys);
        let epsg = crs.as_ref().and_then(|crs| crs.epsg);
        match wanted {
            serde_json::Value::Number(code) => {
                // The facts repeat the key. Its code is in meters, the unit key and the coordinates
                // are in feet.
                let wanted = if file.contains("point-version-1-point-wise") { Some(2271) } else { code.as_u64() };
                assert_eq!(epsg.map(u64::from), wanted, "{file}: {crs:?}");
                coded += 1;
            }
            serde_json::Value::Null => {
                eprintln!("{file}: {crs:?}");
                none += 1;
            }
            other => {
                eprintln!("{file}: {other} is {crs:?}");
                named += 1;
            }
        }
    }
    eprintln!("{coded} with code, {none} without, {named} with a name");
    assert!(coded > 60, "{coded}");
}

#[cfg(not(feature = "proj"))]
#[test]
fn without_proj_the_error_says_how_to_get_it() {
    let crs = |code| Crs::from_epsg(code).unwrap();
    let error = breakline::run::proj::transform(&crs(4326), &crs(32633)).err().unwrap();
    assert!(error.to_string().contains("EPSG:4326 (WGS 84) to EPSG:32633"), "{error}");
    assert!(error.cure_text().unwrap().plain().contains("feature `proj`"));
}

#[cfg(feature = "proj")]
mod with_proj {
    use breakline::crs::Crs;
    use breakline::run::proj::transform;

    fn crs(text: &str) -> Crs {
        Crs::from_user(text).unwrap()
    }

    fn check(from: &str, to: &str, point: [f64; 3], wanted: [f64; 3], within: f64) -> Vec<String> {
        let operation = transform(&crs(from), &crs(to)).unwrap();
        let mut points = [point];
        operation.transform(&mut points).unwrap();
        let off = points[0].iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < within, "{from} to {to}: {:?} instead of {wanted:?}", points[0]);
        let warnings = operation.warnings();
        eprintln!("{from} to {to}: {warnings:?}");
        warnings
    }

    #[test]
    fn places_are_where_proj_says() {
        // cs2cs of PROJ 9.6 (Debian's 9.1 agrees to the last digit).
        let none = check("EPSG:4326", "EPSG:32633", [15.5, 47.0, 9.0], [538012.75499, 5205285.41538, 9.0], 1e-4);
        assert!(none.is_empty(), "{none:?}");
        check("EPSG:32633", "EPSG:4326", [538012.75499, 5205285.41538, 9.0], [15.5, 47.0, 9.0], 1e-9);
        // Feet to metres, heights too.
        let feet = check(
            "EPSG:2264+6360",
            "EPSG:32119+5703",
            [2_000_000.0, 0.0, 3937.0],
            [609_601.219_202_4, 0.0, 1200.0],
            1e-3,
        );
        assert!(feet.is_empty(), "{feet:?}");
    }

    #[test]
    fn helmert_paths_are_taken_and_their_accuracy_is_reported() {
        // cs2cs of PROJ 9.1 without grids (which prints the Austrian northing first).
        for (code, position, wanted) in [
            ("EPSG:27700", [-1.5, 52.5], [434_039.457_29, 289_239.281_09]),
            ("EPSG:2056", [7.5, 47.0], [2_604_667.476_42, 1_205_439.960_18]),
            ("EPSG:31287", [13.5, 47.5], [412_608.702_49, 400_070.560_75]),
        ] {
            let [x, y] = position;
            let warnings = check("EPSG:4326", code, [x, y, 100.0], [wanted[0], wanted[1], 100.0], 1e-4);
            assert!(warnings.iter().any(|text| text.contains("accura")), "{code}: {warnings:?}");
            // Two millimetres: in plan, PROJ drops the height between the ellipsoids on both ways.
            check(code, "EPSG:4326", [wanted[0], wanted[1], 100.0], [x, y, 100.0], 2e-8);
        }
    }

    #[test]
    fn heights_that_stay_are_reported() {
        let warnings = check("EPSG:4326+5773", "EPSG:4979", [15.5, 47.0, 300.0], [15.5, 47.0, 300.0], 1e-9);
        assert!(warnings.iter().any(|text| text.contains("heights keep their datum")), "{warnings:?}");
        let warnings = check(
            "EPSG:25832+7837",
            "EPSG:25833",
            [700_000.0, 5_300_000.0, 300.0],
            [250_912.281_132, 5_301_906.474_428, 300.0],
            1e-5,
        );
        assert!(warnings.iter().any(|text| text.contains("heights are left as they are")), "{warnings:?}");
    }

    #[test]
    fn geocentric_files_become_maps() {
        // cs2cs EPSG:4978 EPSG:4979
        let warnings = check(
            "EPSG:4978",
            "EPSG:4326",
            [4_194_423.0, 1_162_702.0, 4_647_245.0],
            [15.493_474_331_5, 47.067_133_849, 537.325_021_646_9],
            1e-6,
        );
        assert!(warnings.iter().any(|text| text.contains("ellipsoid")), "{warnings:?}");
        assert!(transform(&crs("EPSG:4326"), &crs("EPSG:4978")).is_err());
    }

    #[test]
    fn definitions_without_a_code_are_reprojected() {
        let own = Crs::from_wkt(&crs("EPSG:25832").to_prj().replace("500000.0", "500010.0")).unwrap();
        assert_eq!(own.epsg, None);
        let operation = transform(&own, &crs("EPSG:25832")).unwrap();
        let mut points = [[600_010.0, 5_300_000.0, 1.0]];
        operation.transform(&mut points).unwrap();
        assert!((points[0][0] - 600_000.0).abs() < 1e-6, "{points:?}");
    }

    #[test]
    fn a_point_that_fails_is_named_with_both_systems() {
        let operation = transform(&crs("EPSG:4326"), &crs("EPSG:32633")).unwrap();
        let error = operation.transform(&mut [[15.0, 47.0, 0.0], [15.0, 4700.0, 0.0]]).unwrap_err().to_string();
        assert!(error.contains("(15, 4700)") && error.contains("EPSG:4326") && error.contains("EPSG:32633"), "{error}");
        let local = Crs::from_wkt("LOCAL_CS[\"site\",UNIT[\"metre\",1]]").unwrap();
        assert!(transform(&local, &crs("EPSG:32633")).err().unwrap().to_string().contains("local"));
    }

    #[test]
    fn threads_agree() {
        let operation = transform(&crs("EPSG:31287"), &crs("EPSG:25833")).unwrap();
        let run = || {
            let mut points: Vec<[f64; 3]> = (0..1000).map(|i| [400_000.0 + f64::from(i), 400_000.0, 0.0]).collect();
            operation.transform(&mut points).unwrap();
            points
        };
        let here = run();
        std::thread::scope(|scope| {
            for thread in (0..4).map(|_| scope.spawn(run)).collect::<Vec<_>>() {
                assert_eq!(thread.join().unwrap(), here);
            }
        });
    }
}

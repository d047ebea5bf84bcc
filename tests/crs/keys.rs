//! GeoKeys.

use std::process::Command;

use super::{CODES, custom, last_epsg, output};
use breakline::crs::{Crs, GeoKeys, RasterType};

/// A minimal TIFF of one pixel with these keys.
fn tiff(keys: &GeoKeys) -> Vec<u8> {
    let ascii: Vec<u8> = keys.ascii.bytes().chain([0]).collect();
    let directory: Vec<u8> = keys
        .directory
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let doubles: Vec<u8> = keys.doubles.iter().flat_map(|v| v.to_le_bytes()).collect();
    let scale: Vec<u8> = [1.0f64, 1.0, 0.0]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let tie: Vec<u8> = [0.0f64, 0.0, 0.0, 10.0, 20.0, 0.0]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
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
        let Some(found) = output("gdalsrsinfo", &["--single-line", "-o", "wkt2", &path_text])
        else {
            return;
        };
        assert_eq!(last_epsg(&found), Some(code), "{found}");
    }
    let crs = Crs::from_user("EPSG:25832+7837").unwrap();
    let keys = GeoKeys::from_crs(&crs);
    assert!(keys.crs().unwrap().unwrap().is_same(&crs));
    assert_eq!(keys.crs().unwrap().unwrap().vertical_epsg, Some(7837));
    std::fs::write(&path, tiff(&keys)).unwrap();
    let found = output("gdalsrsinfo", &["--single-line", "-o", "wkt2", &path_text]).unwrap();
    assert!(
        found.contains("ID[\"EPSG\",25832]") && found.contains("ID[\"EPSG\",7837]"),
        "{found}"
    );
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
    Some(
        text.split_whitespace()
            .map(|number| number.parse().unwrap())
            .collect(),
    )
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

        let point: &[u8] = if wkt.contains("-70") {
            b"15 -68\n"
        } else {
            b"15 47.5\n"
        };
        let Some(wanted) = position(&wkt, point) else {
            eprintln!("skipped: gdaltransform is not installed");
            return;
        };
        assert_eq!(wanted.len(), 2, "{wkt}");
        let tif = folder.path().join("keys.tif");
        std::fs::write(&tif, tiff(&keys)).unwrap();
        let from_keys = output(
            "gdalsrsinfo",
            &["--single-line", "-o", "wkt2", &tif.display().to_string()],
        )
        .unwrap();
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
fn damaged_keys_are_errors_and_absent_ones_are_none() {
    let keys = |directory: &[u16]| GeoKeys {
        directory: directory.to_vec(),
        ..GeoKeys::default()
    };
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
            0, 1, 2, 3, 1024, 1026, 2048, 2050, 2057, 2059, 3072, 3074, 3075, 3076, 3077, 3080,
            4096, 4099, 8, 15, 32767, 34735, 34736, 34737,
        ];
        let mut directory = vec![1, 1, 0, (next() % 6) as u16];
        for _ in 0..next() % 28 {
            let pick = next();
            directory.push(if pick % 9 == 0 {
                next() as u16
            } else {
                LIKELY[pick as usize % LIKELY.len()]
            });
        }
        let keys = GeoKeys {
            directory,
            doubles: vec![0.0, f64::NAN, -1.0, 1e300],
            ascii: "é|PCS Name = |".into(),
        };
        if let Ok(Some(crs)) = keys.crs() {
            let _ = (
                crs.to_prj(),
                crs.to_wkt(),
                GeoKeys::from_crs(&crs),
                crs.describe(),
                crs.is_same(&crs.clone()),
            );
        }
    }
}

#[test]
fn a_unit_beside_a_code_is_the_unit_of_the_coordinates() {
    // A file of Nebraska: the code is in meters, the coordinates in US survey feet, and the datum
    // is newer.
    let keys = GeoKeys {
        directory: vec![
            1, 1, 0, 5, 1024, 0, 1, 1, 2048, 0, 1, 6318, 3072, 0, 1, 32104, 3076, 0, 1, 9003, 4099,
            0, 1, 9003,
        ],
        ..GeoKeys::default()
    };
    let crs = keys.crs().unwrap().unwrap();
    assert_eq!(
        (crs.epsg, crs.unit.name.as_str()),
        (Some(6880), "US survey foot")
    );
    assert_eq!(crs.vertical_unit.unwrap().name, "US survey foot");
}

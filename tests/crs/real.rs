//! Real files against their facts.

use std::path::Path;

use breakline::crs::{Crs, GeoKeys};
use testkit::shared;

struct Found {
    keys: GeoKeys,
    wkt: Option<String>,
}

/// The coordinate system records of a LAS file, read by hand.
fn las(path: &Path) -> Found {
    let bytes = std::fs::read(path).unwrap();
    let u16_at = |at: usize| {
        bytes
            .get(at..at + 2)
            .map_or(0, |b| u16::from_le_bytes([b[0], b[1]]))
    };
    let u32_at = |at: usize| u32::from(u16_at(at)) | u32::from(u16_at(at + 2)) << 16;
    let mut found = Found {
        keys: GeoKeys::default(),
        wkt: None,
    };
    let mut at = usize::from(u16_at(94));
    for _ in 0..u32_at(100).min(300) {
        let length = usize::from(u16_at(at + 20));
        let Some(body) = bytes.get(at + 54..at + 54 + length) else {
            break;
        };
        if bytes[at + 2..].starts_with(b"LASF_Projection") {
            match u16_at(at + 18) {
                34735 => {
                    found.keys.directory = body
                        .chunks_exact(2)
                        .map(|b| u16::from_le_bytes([b[0], b[1]]))
                        .collect()
                }
                34736 => {
                    found.keys.doubles = body
                        .chunks_exact(8)
                        .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
                        .collect()
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
        Some(if big_endian {
            slice.iter().fold(0, fold)
        } else {
            slice.iter().rev().fold(0, fold)
        })
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
        let start = if size * count <= 4 {
            at + 8
        } else {
            number(at + 8, 4)? as usize
        };
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
    let facts = std::fs::read_to_string(shared("FACTS.json"))
        .unwrap()
        .replace("NaN", "null")
        .replace("-Infinity", "null");
    let facts: serde_json::Value =
        serde_json::from_str(&facts.replace("Infinity", "null")).unwrap();
    let (mut coded, mut none, mut named) = (0, 0, 0);
    for (file, fact) in facts.as_object().unwrap() {
        let Some(wanted) = fact.get("crs") else {
            continue;
        };
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
        let from_keys = found
            .keys
            .crs()
            .unwrap_or_else(|error| panic!("{file}: {error}"));
        let wkt = found.wkt.filter(|wkt| !wkt.trim_matches('\0').is_empty());
        let from_wkt =
            wkt.map(|wkt| Crs::from_wkt(&wkt).unwrap_or_else(|error| panic!("{file}: {error}")));
        let crs = from_wkt.or(from_keys);
        let epsg = crs.as_ref().and_then(|crs| crs.epsg);
        match wanted {
            serde_json::Value::Number(code) => {
                // The facts repeat the key. Its code is in meters, the unit key and the coordinates
                // are in feet.
                let wanted = if file.contains("point-version-1-point-wise") {
                    Some(2271)
                } else {
                    code.as_u64()
                };
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

//! Real files against their facts.

use std::path::Path;

use breakline::data::{BlockSource, Window};
use breakline::error::Kind;
use breakline::io::{geotiff, raster};
use serde_json::Value;
use testkit::shared;

fn facts() -> Value {
    let text = std::fs::read_to_string(shared("FACTS.json")).expect("FACTS.json can be read");
    // A few numbers elsewhere in the file are NaN or Infinity, which JSON does not have.
    let text = text
        .replace(" NaN", " null")
        .replace("-Infinity", "null")
        .replace(" Infinity", " null");
    serde_json::from_str(&text).expect("FACTS.json is JSON")
}

fn number(value: &Value) -> f64 {
    match value.as_str() {
        Some(text) => text.parse().expect("a number"),
        None => value.as_f64().expect("a number"),
    }
}

/// TIFF files under `data/dem`, sorted, as paths relative to `data`.
fn tiffs(folder: &Path, prefix: &str) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let name = format!(
            "{prefix}/{}",
            entry.file_name().to_str().expect("a plain name")
        );
        if entry.path().is_dir() {
            names.extend(tiffs(&entry.path(), &name));
        } else if name.ends_with(".tif") || name.ends_with(".tiff") {
            names.push(name);
        }
    }
    names.sort();
    names
}

/// Files that are refused, and the words that say why.
const REFUSED: &[(&str, &str)] = &[
    ("dem/gdal/byte_LZMA.tif", "compression LZMA (34925)"),
    ("dem/gdal/byte_lerc.tif", "compression LERC (34887)"),
    ("dem/gdal/float24.tif", "24-bit samples (float24)"),
];

/// Files whose tiepoints lie on one affine transform: FACTS calls them control points.
const OF_TIEPOINTS: &[&str] = &[
    "dem/pointarea/austrian_capitals_model_tie_points_pixel_is_area.tif",
    "dem/pointarea/austrian_capitals_model_tie_points_pixel_is_point.tif",
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn real_files_are_what_the_facts_say() {
    let (facts, folder) = (facts(), shared("dem"));
    let mut read = 0;
    for name in tiffs(&folder, "dem") {
        if name.starts_with("dem/broken") {
            continue;
        }
        let path = shared(&name);
        if let Some((_, words)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            let error = geotiff::open(&path).expect_err(&name);
            assert_eq!(error.kind(), Kind::Unsupported, "{name}");
            assert!(error.to_string().contains(words), "{name}: {error}");
            assert!(
                error.cure_text().expect("a cure").plain().contains("gdal"),
                "{name}"
            );
            continue;
        }
        check_facts(&name, &path, &facts[&name]);
        read += 1;
    }
    assert_eq!(read, 83);
    let name = "lidar/bcts/bcts_dsm_5m.tif";
    check_facts(name, &shared(name), &facts[name]);
}

fn check_facts(name: &str, path: &Path, facts: &Value) {
    let reader = raster::open(path).unwrap_or_else(|e| panic!("{name}: {e}"));
    let info = reader.info();
    assert_eq!(
        info.width as u64,
        facts["size"][0].as_u64().unwrap(),
        "{name}"
    );
    assert_eq!(
        info.height as u64,
        facts["size"][1].as_u64().unwrap(),
        "{name}"
    );
    assert_eq!(
        u64::from(info.bands),
        facts["bands"].as_u64().unwrap(),
        "{name}"
    );
    assert_eq!(
        info.is_big_tiff,
        facts["bigtiff"].as_bool().unwrap(),
        "{name}"
    );
    assert_eq!(
        info.byte_order == geotiff::ByteOrder::Big,
        facts["byte_order"] == "MM",
        "{name}"
    );
    assert_eq!(info.is_tiled, facts["tiled"].as_bool().unwrap(), "{name}");
    // GDAL cuts a raster that is one uncompressed strip into rows of its own choice.
    if info.is_tiled || info.block[1] < info.height {
        assert_eq!(
            info.block[1] as u64,
            facts["block"][0].as_u64().unwrap(),
            "{name}"
        );
    }
    assert_eq!(
        info.block[0] as u64,
        facts["block"][1].as_u64().unwrap(),
        "{name}"
    );
    let compression = facts["compress"].as_str().unwrap_or("none");
    assert_eq!(info.compression.to_lowercase(), compression, "{name}");
    // GDAL has no half precision and reads it as float32.
    let sample = if name.ends_with("float16.tif") {
        "float32".into()
    } else {
        info.sample.to_string()
    };
    let sample = if info.sample.bits < 8 {
        "uint8".into()
    } else {
        sample
    };
    assert_eq!(sample, facts["dtype"].as_str().unwrap(), "{name}");
    assert_eq!(info.scale, facts["scale"].as_f64().unwrap(), "{name}");
    assert_eq!(info.offset, facts["offset"].as_f64().unwrap(), "{name}");
    assert_eq!(info.is_point, facts["area_or_point"] == "Point", "{name}");
    let factors: Vec<u64> = facts["overviews"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f.as_u64().unwrap())
        .collect();
    let found: Vec<u64> = info
        .overviews
        .iter()
        .map(|o| (info.width as f64 / o[0] as f64).round() as u64)
        .collect();
    assert_eq!(found, factors, "{name}");

    // FACTS has a number where one EPSG code says it all, else WKT, and nothing for control points.
    let crs = &facts["crs"];
    if let Some(code) = crs.as_u64() {
        assert_eq!(
            info.crs.as_ref().and_then(|crs| crs.epsg).map(u64::from),
            Some(code),
            "{name}"
        );
    } else if let Some(wkt) = crs
        .as_str()
        .filter(|wkt| !wkt.starts_with("LOCAL_CS[\"unnamed\""))
    {
        assert!(info.crs.is_some(), "{name}: {wkt}");
    } else if facts["gcps"].is_null() {
        assert_eq!(info.crs, None, "{name}");
    }

    let nodata = &facts["nodata"];
    match info.nodata {
        None => assert!(nodata.is_null(), "{name}"),
        Some(found) => {
            let wanted = number(nodata);
            assert!(
                found == wanted
                    || found as f32 == wanted as f32
                    || found.is_nan() && wanted.is_nan(),
                "{name}"
            );
        }
    }

    let transform = reader.frame().transform;
    if !OF_TIEPOINTS.contains(&name) {
        for (found, wanted) in transform
            .iter()
            .zip(facts["geotransform"].as_array().unwrap())
        {
            let wanted = wanted.as_f64().unwrap();
            assert!(
                (found - wanted).abs() <= 1e-12 * wanted.abs(),
                "{name}: {found} is not {wanted}"
            );
        }
    }

    let all = Window {
        column: 0,
        row: 0,
        width: info.width,
        height: info.height,
    };
    let stored = reader
        .read_stored(all)
        .unwrap_or_else(|e| panic!("{name}: {e}"));
    let values: Vec<f64> = stored.into_iter().filter(|v| !v.is_nan()).collect();
    // FACTS counts a NaN that is not the nodata value as valid.
    let valid = facts["valid"].as_u64().unwrap() - facts["nan"].as_u64().unwrap_or(0);
    assert_eq!(values.len() as u64, valid, "{name}");
    let extremes = reader.extremes().unwrap();
    assert_eq!(extremes.valid, valid, "{name}");
    let Some([min, max]) = extremes.stored_range else {
        assert!(facts["min"].is_null(), "{name}");
        return;
    };
    // serde_json reads decimal text to within one unit in the last place.
    for (found, wanted) in [(min, number(&facts["min"])), (max, number(&facts["max"]))] {
        assert!(
            (found - wanted).abs() <= f64::EPSILON * wanted.abs(),
            "{name}: {found} is not {wanted}"
        );
    }
    let wanted = number(&facts["sum"]);
    let sum: f64 = values.iter().sum();
    assert!(
        (sum - wanted).abs() <= 1e-9 * wanted.abs(),
        "{name}: sum {sum} is not {wanted}"
    );
    let scaled = extremes.range.unwrap();
    assert_eq!(
        scaled,
        [
            min * info.scale + info.offset,
            max * info.scale + info.offset
        ],
        "{name}"
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_raster_is_in_the_same_place_however_its_georeferencing_is_written() {
    let encoding = |kind: &str, cells: &str| {
        let path = shared(&format!(
            "dem/pointarea/austrian_capitals_{kind}_pixel_is_{cells}.tif"
        ));
        let reader = geotiff::open(path).unwrap();
        assert_eq!(reader.info().is_point, cells == "point");
        reader.read_grid().unwrap()
    };
    for cells in ["area", "point"] {
        let first = encoding("model_tie_point_and_pixel_scale", cells);
        for kind in ["model_tie_points", "model_transformation"] {
            let other = encoding(kind, cells);
            for (a, b) in first.frame.transform.iter().zip(other.frame.transform) {
                assert!((a - b).abs() < 1e-6, "{kind} {cells}: {a} is not {b}");
            }
            assert!(
                first
                    .values
                    .iter()
                    .map(|v| v.to_bits())
                    .eq(other.values.iter().map(|v| v.to_bits())),
                "{kind}"
            );
        }
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_window_is_the_same_part_of_the_whole() {
    let folder = shared("dem");
    for name in [
        "gdal/byte_LZW_tiled.tif",
        "gdal/utm.tif",
        "bigtujunga.tif",
        "gdal/separate_tiled.tif",
        "dem-hills.tiff",
    ] {
        let reader = geotiff::open(folder.join(name)).unwrap();
        let grid = reader.read_grid().unwrap();
        let (width, height) = (grid.frame.width, grid.frame.height);
        let windows = [
            (0, 0, 1, 1),
            (width / 3, height / 4, width / 2, height / 3),
            (width - 1, 0, 1, height),
            (3, 5, 14, 15),
        ];
        for (column, row, w, h) in windows {
            let part = reader
                .read_window(Window {
                    column,
                    row,
                    width: w,
                    height: h,
                })
                .unwrap();
            for (i, value) in part.iter().enumerate() {
                let whole = grid.value(column + i % w, row + i / w);
                assert!(
                    *value == whole || value.is_nan() && whole.is_nan(),
                    "{name}"
                );
            }
        }
        let outside = Window {
            column: 1,
            row: 0,
            width,
            height,
        };
        assert_eq!(reader.read_window(outside).unwrap_err().kind(), Kind::Usage);
    }
}

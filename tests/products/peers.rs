//! What GDAL's tools say of every product that they can read.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use crate::{breakline, fixture, folder};

/// What a tool of GDAL prints; `None`, said plainly, where it is absent.
fn output_of(work: &Path, tool: &str, args: &[&str]) -> Option<String> {
    let output = match Command::new(tool).current_dir(work).args(args).output() {
        Ok(output) => output,
        Err(_) => {
            eprintln!("skipped: {tool} is not here (apt-get install gdal-bin)");
            return None;
        }
    };
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(String::from_utf8(output.stdout).unwrap())
}

fn raster(work: &Path, name: &str) -> Option<Value> {
    output_of(work, "gdalinfo", &["-json", "-mm", name])
        .map(|text| serde_json::from_str(&text).unwrap())
}

/// The products of the fixtures, 2 m and 5 m apart.
fn products(work: &Path) -> String {
    let (points, lines) = (fixture("valley.laz"), fixture("breaklines.shp"));
    breakline(
        work,
        &["tin", &points, "--breaklines", &lines, "-q", "-o", "t.ply"],
    );
    breakline(
        work,
        &["dem", "t.ply", "-q", "--resolution", "0.5", "-o", "d.tif"],
    );
    breakline(
        work,
        &[
            "hillshade",
            "t.ply",
            "-q",
            "--resolution",
            "0.5",
            "-o",
            "h.tif",
            "-o",
            "h.png",
        ],
    );
    breakline(
        work,
        &[
            "contour",
            "t.ply",
            "--interval",
            "5",
            "-o",
            "c.shp",
            "-o",
            "c.geojson",
        ],
    )
}

#[test]
fn gdalinfo_reads_the_rasters() {
    let work = folder();
    products(work.path());
    let Some(dem) = raster(work.path(), "d.tif") else {
        return;
    };
    let frame = |info: &Value| (info["size"].clone(), info["geoTransform"].clone());
    let expected = (
        json!([800, 599]),
        json!([688_000.0, 0.5, 0.0, 5_261_299.5, 0.0, -0.5]),
    );
    assert_eq!(frame(&dem), expected);
    let is_utm = |info: &Value| {
        info["coordinateSystem"]["wkt"]
            .as_str()
            .unwrap()
            .ends_with("ID[\"EPSG\",25832]]")
    };
    assert!(is_utm(&dem), "{dem}");
    assert_eq!(dem["metadata"]["IMAGE_STRUCTURE"]["COMPRESSION"], "DEFLATE");
    assert_eq!(dem["metadata"]["IMAGE_STRUCTURE"]["PREDICTOR"], "3");
    assert_eq!(dem["metadata"][""]["AREA_OR_POINT"], "Area");
    let band = &dem["bands"][0];
    assert_eq!(dem["bands"].as_array().unwrap().len(), 1);
    assert_eq!(
        (&band["type"], &band["block"]),
        (&json!("Float32"), &json!([256, 256]))
    );
    assert_eq!(band["noDataValue"], json!(-9999.0));
    // The ground of the fixtures, see there.
    let (low, high) = (
        band["computedMin"].as_f64().unwrap(),
        band["computedMax"].as_f64().unwrap(),
    );
    assert!(
        (796.0..797.0).contains(&low) && (886.0..887.5).contains(&high),
        "{low} {high}"
    );

    let shade = raster(work.path(), "h.tif").unwrap();
    assert_eq!(frame(&shade), expected);
    assert!(is_utm(&shade), "{shade}");
    let band = &shade["bands"][0];
    assert_eq!(
        (&band["type"], &band["block"], &band["noDataValue"]),
        (&json!("Byte"), &json!([256, 256]), &json!(0.0))
    );
    assert_eq!(
        shade["metadata"]["IMAGE_STRUCTURE"]["COMPRESSION"],
        "DEFLATE"
    );

    let picture = raster(work.path(), "h.png").unwrap();
    assert_eq!(frame(&picture), expected, "from the world file");
    let kinds: Vec<&Value> = picture["bands"]
        .as_array()
        .unwrap()
        .iter()
        .map(|b| &b["colorInterpretation"])
        .collect();
    assert_eq!(kinds, ["Gray", "Alpha"]);
    assert_eq!(picture["bands"][0]["type"], "Byte");
}

#[test]
fn ogrinfo_reads_the_contours() {
    let work = folder();
    let summary = products(work.path());
    let count = summary
        .lines()
        .find_map(|line| line.strip_prefix("contours    ")?.split(' ').next());
    let count = count.unwrap_or_else(|| panic!("{summary}"));
    for name in ["c.shp", "c.geojson"] {
        let Some(text) = output_of(work.path(), "ogrinfo", &["-so", "-al", "-ro", name]) else {
            return;
        };
        for wanted in [
            "Geometry: 3D Line String\n",
            "    ID[\"EPSG\",25832]]\n",
            "\nELEV: Real (",
            "\nID: Integer",
        ] {
            assert!(
                text.contains(wanted),
                "{name}: {wanted:?} is not in\n{text}"
            );
        }
        assert!(
            text.contains(&format!("\nFeature Count: {count}\n")),
            "{name}: not {count}\n{text}"
        );
        // Every fifth metre, and nothing else.
        let all = output_of(work.path(), "ogrinfo", &["-al", "-ro", "-geom=NO", name]).unwrap();
        let levels = all
            .lines()
            .filter_map(|line| line.trim().strip_prefix("ELEV (Real) = "));
        let levels: Vec<f64> = levels.map(|level| level.parse().unwrap()).collect();
        assert_eq!(levels.len().to_string(), count, "{name}");
        assert!(
            levels
                .iter()
                .all(|z| z % 5.0 == 0.0 && (800.0..=885.0).contains(z)),
            "{name}: {levels:?}"
        );
    }
    // Neither tool has anything to say against the index or the table.
    let shapes = std::fs::metadata(work.path().join("c.shx")).unwrap().len();
    assert_eq!(shapes, 100 + 8 * count.parse::<u64>().unwrap());
}

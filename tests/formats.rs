//! The table of formats: what it says is what the documentation and the program say, and rows do
//! not hide each other.

use std::path::Path;

use breakline::io::formats::{self, Content, FORMATS, Holding, Product};

#[test]
fn the_page_of_formats_has_the_table() {
    let page = include_str!("../docs/formats.md");
    let table = formats::markdown();
    assert!(
        page.contains(&table),
        "docs/formats.md must have this table:\n{table}"
    );
}

#[test]
fn the_help_of_the_program_has_each_format_that_is_read() {
    let help = assert_cmd::Command::cargo_bin("breakline")
        .unwrap()
        .arg("--help")
        .output()
        .unwrap();
    let help = String::from_utf8(help.stdout).unwrap();
    for format in FORMATS.iter().filter(|format| format.is_read()) {
        for extension in format.extensions {
            assert!(
                help.contains(&format!(".{extension}")),
                "{extension} is not in:\n{help}"
            );
        }
    }
}

#[test]
fn rows_are_whole() {
    for format in FORMATS {
        assert!(
            !format.name.is_empty() && format.noun.starts_with('a'),
            "{format:?}"
        );
        assert_eq!(format.help.is_empty(), !format.is_read(), "{}", format.name);
        for extension in format.extensions {
            assert!(
                extension
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '.'),
                "{extension}"
            );
        }
        assert!(
            !format.can_hold(Holding::Edges) || format.can_hold(Holding::Mesh),
            "{}",
            format.name
        );
        if format.writes(Product::Surface) {
            // A drawing is read as lines.
            let is_drawing = format.content == Content::Layer && format.can_hold(Holding::Lines);
            assert!(
                format.content == Content::Mesh || is_drawing,
                "{}",
                format.name
            );
        }
        assert!(
            !format.writes(Product::Heights) || format.can_hold(Holding::Raster),
            "{}",
            format.name
        );
        assert!(
            !format.writes(Product::Contours) || format.can_hold(Holding::Lines),
            "{}",
            format.name
        );
    }
}

#[test]
fn no_row_hides_another() {
    for format in FORMATS {
        for extension in format.extensions {
            let name = format!("a.{}", extension.to_uppercase());
            let shared = FORMATS
                .iter()
                .filter(|other| other.extensions.contains(extension))
                .count()
                > 1;
            let found = formats::of_name(Path::new(&name)).map(|found| found.name);
            // Text has any name, and shares `.asc` with a grid.
            let expected = Some(format.name).filter(|name| !name.starts_with("text") && !shared);
            assert_eq!(found, expected, "{name}");
        }
    }
}

#[test]
fn files_are_known_by_bytes_and_name() {
    let name =
        |head: &[u8], path: &str| formats::detect(head, Path::new(path)).map(|format| format.name);
    for (head, path, expected) in [
        (&b"LASF"[..], "a.las", Some("LAS")),
        (b"LASF", "a.ply", Some("LAS")),
        (b"hello", "a.laz", Some("LAZ")),
        (b"hello", "a.COPC.laz", Some("COPC")),
        (b"hello", ".copc.laz", Some("LAZ")),
        (b"hello", "copc.laz", Some("LAZ")),
        (b"II*\0rest", "a.xyz", Some("GeoTIFF")),
        (b"MM\0+rest", "a", Some("GeoTIFF")),
        (b"hello", "a.tif", Some("GeoTIFF")),
        (b"\0\0\x27\x0a", "a.dat", Some("shapefile")),
        (b"hello", "a.SHP", Some("shapefile")),
        (b"{", "a.geojson", Some("GeoJSON")),
        // Other files begin like this, too: named in messages, but not read as GeoJSON.
        (b"{", "a.txt", None),
        (b"1 2 3", "a.asc", Some("text")),
        (b"ncols 4", "a.asc", Some("ESRI ASCII grid")),
        (b"CDF\x02", "a.nc", Some("UGRID")),
        (b"\x89HDF", "a.nc", Some("NetCDF 4 or HDF")),
        (b"NCols 4", "a.txt", None),
        (b"1 2 3", "a.unknown", Some("text")),
        (b"", "", Some("text")),
        (b"\xff\xfe1\0", "a.txt", Some("text")),
        (b"\x7fELF\0", "a.bin", None),
        (b"SQLite format 3\0", "a.gpkg", Some("GeoPackage")),
        (b"SQLite format 3\0", "a.db", Some("GeoPackage")),
        (b"", "a.vrt", Some("GDAL virtual raster")),
    ] {
        assert_eq!(
            name(head, path),
            expected,
            "{:?} {path}",
            head.escape_ascii().to_string()
        );
    }
}

#[test]
fn products_have_the_extensions_that_they_had() {
    for (product, extensions) in [
        (
            Product::Points,
            &["las", "copc.laz", "laz", "xyz", "txt", "csv"][..],
        ),
        (
            Product::Surface,
            &[
                "ply", "obj", "off", "xml", "landxml", "glb", "2dm", "nc", "cityjson", "stl",
                "tin", "tins", "dxf",
            ],
        ),
        (
            Product::Contours,
            &[
                "shp", "geojson", "json", "geojsonl", "geojsons", "gpkg", "fgb", "dxf",
            ],
        ),
        (Product::Heights, &["tif", "tiff", "asc", "xyz"]),
        (Product::Shades, &["tif", "tiff", "png"]),
        (Product::Colors, &["tif", "tiff", "png"]),
        (Product::Plane, &["ele", "node", "poly", "edge", "neigh"]),
    ] {
        assert_eq!(formats::extensions(product), extensions, "{product:?}");
    }
}

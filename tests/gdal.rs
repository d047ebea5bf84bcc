//! Vector layers and rasters through GDAL, from files that GDAL has written.

use std::path::Path;

use breakline::io::gdal::{IS_AVAILABLE, open_raster, read_layer};

#[test]
fn a_build_without_gdal_says_how_to_get_it() {
    if IS_AVAILABLE {
        return;
    }
    for error in [
        read_layer(Path::new("a.gpkg"), Some("roads")).unwrap_err(),
        open_raster("a.asc").unwrap_err(),
    ] {
        assert!(error.to_string().starts_with("a."), "{error}");
        assert!(
            error
                .cure_text()
                .unwrap()
                .plain()
                .contains("feature `gdal`")
        );
    }
}

#[cfg(feature = "gdal")]
mod with_gdal {
    use super::*;
    use breakline::crs::CrsKind;
    use breakline::data::{BlockSource, Shape, Window};
    use breakline::io::gdal::read_layer_with;
    use breakline::io::layer;
    use gdal::DriverManager;
    use gdal::raster::{Buffer, RasterCreationOptions};
    use gdal::spatial_ref::{AxisMappingStrategy, SpatialRef};
    use gdal::vector::{
        Feature, Geometry, LayerAccess, LayerOptions, OGRFieldType, OGRwkbGeometryType,
    };
    use tempfile::TempDir;

    fn epsg(code: u32) -> SpatialRef {
        let mut reference = SpatialRef::from_epsg(code).unwrap();
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        reference
    }

    type Record<'a> = (&'a str, Option<f64>, &'a str);

    /// Writes layers of WKT geometries with a real field H and a text field T.
    fn write(path: &Path, driver: &str, code: Option<u32>, layers: &[(&str, &[Record<'_>])]) {
        let driver = DriverManager::get_driver_by_name(driver).unwrap();
        let mut dataset = driver.create_vector_only(path).unwrap();
        for (name, records) in layers {
            let reference = code.map(epsg);
            let mut layer = dataset
                .create_layer(LayerOptions {
                    name,
                    srs: reference.as_ref(),
                    ty: OGRwkbGeometryType::wkbUnknown,
                    options: None,
                })
                .unwrap();
            let has_fields = driver.short_name() != "DXF";
            if has_fields {
                layer
                    .create_defn_fields(&[
                        ("H", OGRFieldType::OFTReal),
                        ("T", OGRFieldType::OFTString),
                    ])
                    .unwrap();
            }
            for (wkt, height, text) in *records {
                let geometry = Geometry::from_wkt(wkt).unwrap();
                match height {
                    Some(height) if has_fields => {
                        let mut feature = Feature::new(layer.defn()).unwrap();
                        feature.set_geometry(geometry).unwrap();
                        feature.set_field_double(0, *height).unwrap();
                        feature.set_field_string(1, text).unwrap();
                        feature.create(&layer).unwrap();
                    }
                    _ if *text == "absent" => {
                        Feature::new(layer.defn()).unwrap().create(&layer).unwrap()
                    }
                    _ => layer.create_feature(geometry).unwrap(),
                }
            }
        }
        dataset.flush_cache().unwrap();
    }

    fn folder() -> TempDir {
        tempfile::tempdir().unwrap()
    }

    #[test]
    fn geopackage_lines_keep_their_heights_and_system() {
        let folder = folder();
        let path = folder.path().join("a.gpkg");
        let records: &[Record<'_>] = &[
            (
                "LINESTRING Z (600000 5300000 1,600010 5300000 2,600010 5300010 3.5)",
                Some(7.25),
                "8,5",
            ),
            ("MULTILINESTRING Z ((0 0 1,1 1 2),(2 2 3,3 3 4))", None, ""),
            ("LINESTRING (5 6,7 8)", Some(-1.0), "none"),
        ];
        write(
            &path,
            "GPKG",
            Some(25832),
            &[("roads", records), ("empty", &[])],
        );

        let layer = read_layer(&path, Some("roads")).unwrap();
        assert_eq!(layer.crs.as_ref().unwrap().epsg, Some(25832));
        assert!(layer.format.starts_with("GDAL GPKG"), "{}", layer.format);
        assert_eq!(layer.fields, ["H", "T"]);
        assert_eq!(layer.shapes.len(), 3);
        let first = vec![
            [600000.0, 5300000.0, 1.0],
            [600010.0, 5300000.0, 2.0],
            [600010.0, 5300010.0, 3.5],
        ];
        assert_eq!(layer.shapes[0], Shape::Lines(vec![first]));
        let second = vec![
            vec![[0.0, 0.0, 1.0], [1.0, 1.0, 2.0]],
            vec![[2.0, 2.0, 3.0], [3.0, 3.0, 4.0]],
        ];
        assert_eq!(layer.shapes[1], Shape::Lines(second));
        assert!(layer.shapes[2].vertices().all(|vertex| vertex[2].is_nan()));

        // Heights from an attribute, of either type.
        let read = |layer: Option<&str>, field: Option<&str>, columns: &[&str]| {
            let options = layer::Options {
                layer,
                height_field: field,
                columns,
                ..layer::Options::default()
            };
            read_layer_with(&path, &options, &|_| Ok(()))
        };
        let heights = |field: &str| -> Vec<f64> {
            let layer = read(Some("roads"), Some(field), &[]).unwrap();
            assert!(
                field != "T"
                    || layer
                        .warnings
                        .iter()
                        .any(|text| text.plain().starts_with("2 records")),
                "{:?}",
                layer.warnings
            );
            layer
                .shapes
                .iter()
                .map(|shape| shape.vertices().next().unwrap()[2])
                .collect()
        };
        assert_eq!(heights("H")[..1], [7.25]);
        assert!(heights("H")[1].is_nan());
        assert_eq!(heights("T")[0], 8.5);
        assert!(heights("T")[2].is_nan(), "a text is no height of 0");

        let several = read_layer(&path, None).unwrap_err();
        assert!(several.to_string().contains("2 layers"), "{several}");
        assert!(several.cure_text().unwrap().plain().contains("roads"));
        let wrong = read_layer(&path, Some("rivers")).unwrap_err();
        assert!(
            wrong.to_string().contains("rivers") && wrong.path() == Some(&path),
            "{wrong}"
        );
        let wrong = read(Some("roads"), Some("Z"), &[]).unwrap_err();
        assert!(
            wrong.to_string().contains("field Z")
                && wrong.cure_text().unwrap().plain().contains("H, T"),
            "{wrong}"
        );

        // The numbers of attributes.
        let layer = read(Some("Roads"), None, &["h"]).unwrap();
        let values = &layer.column("H").unwrap().values;
        assert!(
            values[0] == 7.25 && values[1].is_nan() && values[2] == -1.0,
            "{values:?}"
        );
        let wrong = read(Some("roads"), None, &["H", "T"]).unwrap_err();
        let text = "a.gpkg: record 3: field T: expected a number, found 'none'";
        assert!(wrong.to_string().ends_with(text), "{wrong}");
        let wrong = read(Some("roads"), None, &["Z"]).unwrap_err();
        assert!(
            wrong.to_string().contains("field Z")
                && wrong.cure_text().unwrap().plain().contains("H, T"),
            "{wrong}"
        );
    }

    #[test]
    #[cfg(feature = "cli")]
    fn the_program_reads_a_layer_and_a_field() {
        let folder = folder();
        let lines: &[Record<'_>] = &[("LINESTRING (1 1,2 2)", Some(7.5), "")];
        let points: &[Record<'_>] = &[("MULTIPOINT (0 0,5 0,0 5,5 5)", Some(3.0), "4")];
        let site: &[Record<'_>] = &[("POLYGON ((0 0,3 0,3 3,0 3,0 0))", None, "")];
        let layers = [
            ("lines", lines),
            ("a:b", lines),
            ("points", points),
            ("site", site),
        ];
        write(&folder.path().join("a.gpkg"), "GPKG", Some(25832), &layers);
        write(
            &folder.path().join("one.gpkg"),
            "GPKG",
            Some(25832),
            &[("lines", lines)],
        );
        let tin = |args: &[&str]| {
            let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_breakline"));
            program
                .current_dir(&folder)
                .args(["tin", "-o", "t.ply", "--overwrite"])
                .args(args);
            let output = program.output().unwrap();
            (
                output.status.code(),
                String::from_utf8(output.stderr).unwrap(),
            )
        };
        let lines = |spec: &str| tin(&["a.gpkg:points:H", "--breaklines", spec]);
        let works = |(code, text): (Option<i32>, String), what: &str| {
            assert!(code == Some(0) && text.contains(what), "{text}");
        };
        let fails = |(code, text): (Option<i32>, String), what: &[&str]| {
            assert!(
                matches!(code, Some(1 | 2)) && what.iter().all(|what| text.contains(what)),
                "{text}"
            );
        };
        for spec in [
            "a.gpkg:lines:H",
            "a.gpkg:a:b:H",
            "one.gpkg:lines:H",
            "one.gpkg::H",
        ] {
            works(lines(spec), "breaklines  1 in");
        }
        works(
            tin(&["a.gpkg:points:H", "a.gpkg:points:T"]),
            "is named twice",
        );
        works(
            tin(&["a.gpkg:points:H", "--boundary", "a.gpkg:site"]),
            "added by the clip",
        );
        fails(
            tin(&["a.gpkg:points:H", "a.gpkg:lines"]),
            &["lines are breaklines", "the line has no heights"],
        );
        fails(
            lines("a.gpkg:lines"),
            &["the line has no heights", "FILE:LAYER:FIELD"],
        );
        fails(
            lines("a.gpkg::H"),
            &["there are 4 layers", "lines, a:b, points, site"],
        );
        fails(
            lines("a.gpkg:rivers:H"),
            &["there is no layer \"rivers\"", "lines, a:b, points, site"],
        );
        fails(lines("one.gpkg:H"), &["there is no layer \"H\"", "FILE::H"]);
        fails(lines("one.gpkg::Z"), &["there is no field Z", "H, T"]);
    }

    #[test]
    fn every_kind_of_geometry_has_its_shape() {
        let folder = folder();
        let path = folder.path().join("kinds.gpkg");
        let records: &[Record<'_>] = &[
            ("POINT Z (1 2 3)", None, ""),
            ("MULTIPOINT Z ((1 2 3),(4 5 6))", None, ""),
            (
                "POLYGON Z ((0 0 1,4 0 1,4 4 1,0 4 1,0 0 1),(1 1 2,1 2 2,2 2 2,1 1 2))",
                None,
                "",
            ),
            (
                "TIN Z (((0 0 0,1 0 1,0 1 2,0 0 0)),((1 0 1,1 1 3,0 1 2,1 0 1)))",
                None,
                "",
            ),
            (
                "GEOMETRYCOLLECTION (POINT (1 2),LINESTRING (0 0,1 1))",
                None,
                "",
            ),
            ("CIRCULARSTRING Z (0 0 10,1 1 15,2 0 20)", None, ""),
            ("CURVEPOLYGON (CIRCULARSTRING (0 0,2 0,0 0))", None, ""),
            ("LINESTRING EMPTY", None, ""),
            ("LINESTRING EMPTY", None, "absent"),
            ("POINT (7 8)", None, ""),
        ];
        write(&path, "GPKG", None, &[("kinds", records)]);
        let layer = read_layer(&path, None).unwrap();
        let shapes = &layer.shapes;
        assert_eq!(shapes[0], Shape::Points(vec![[1.0, 2.0, 3.0]]));
        assert_eq!(
            shapes[1],
            Shape::Points(vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
        );
        let Shape::Polygon(rings) = &shapes[2] else {
            panic!("{:?}", shapes[2])
        };
        assert_eq!(
            rings[0],
            [
                [0.0, 0.0, 1.0],
                [0.0, 4.0, 1.0],
                [4.0, 4.0, 1.0],
                [4.0, 0.0, 1.0],
                [0.0, 0.0, 1.0]
            ]
        );
        assert_eq!(rings[1][1], [2.0, 2.0, 2.0], "a hole runs the other way");
        let Shape::Faces(triangles) = &shapes[3] else {
            panic!("{:?}", shapes[3])
        };
        assert_eq!(
            triangles[1][0][..3],
            [[1.0, 0.0, 1.0], [1.0, 1.0, 3.0], [0.0, 1.0, 2.0]]
        );
        assert!(
            matches!(
                (&shapes[4], &shapes[5]),
                (Shape::Points(_), Shape::Lines(_))
            ),
            "a collection is its parts"
        );
        let Shape::Lines(arc) = &shapes[6] else {
            panic!("{:?}", shapes[6])
        };
        assert!(
            arc[0].len() > 20
                && arc[0]
                    .iter()
                    .all(|v| ((v[0] - 1.0).hypot(v[1]) - 1.0).abs() < 1e-9),
            "{arc:?}"
        );
        assert!(
            arc[0].iter().any(|v| v[2] > 10.1 && v[2] < 14.9),
            "heights run along the arc: {arc:?}"
        );
        assert!(
            matches!(&shapes[7], Shape::Polygon(rings) if rings[0].len() > 40),
            "{:?}",
            shapes[7]
        );
        assert_eq!(shapes[8].vertices().count(), 0);
        assert_eq!(shapes[9], Shape::Null);
        assert!(matches!(shapes[10], Shape::Points(_)));
        assert_eq!(shapes.len(), 11);
    }

    #[test]
    fn geojson_and_dxf() {
        let folder = folder();
        let path = folder.path().join("a.geojson");
        let record: &[Record<'_>] = &[("LINESTRING Z (15.5 47 400,15.6 47.1 500)", None, "")];
        write(&path, "GeoJSON", Some(4326), &[("a", record)]);
        let layer = read_layer(&path, None).unwrap();
        let crs = layer.crs.unwrap();
        assert_eq!((crs.epsg, crs.kind), (Some(4326), CrsKind::Geographic));
        assert_eq!(
            layer.shapes,
            [Shape::Lines(vec![vec![
                [15.5, 47.0, 400.0],
                [15.6, 47.1, 500.0]
            ]])],
            "longitude first"
        );

        let path = folder.path().join("a.dxf");
        let record: &[Record<'_>] = &[("LINESTRING Z (10 20 1,30 40 2,50 60 3)", None, "")];
        write(&path, "DXF", None, &[("entities", record)]);
        let layer = read_layer(&path, None).unwrap();
        assert_eq!(layer.crs, None);
        assert_eq!(
            layer.shapes,
            [Shape::Lines(vec![vec![
                [10.0, 20.0, 1.0],
                [30.0, 40.0, 2.0],
                [50.0, 60.0, 3.0]
            ]])]
        );
    }

    #[test]
    fn what_cannot_be_read_is_an_error_with_the_file() {
        let folder = folder();
        let text = folder.path().join("a.txt");
        std::fs::write(&text, "no geometry here").unwrap();
        let broken = folder.path().join("a.gpkg");
        std::fs::write(&broken, b"SQLite format 3\0 and no more").unwrap();
        for path in [&text, &broken, &folder.path().join("nowhere.gpkg")] {
            for error in [
                read_layer(path, None).unwrap_err(),
                open_raster(path).unwrap_err(),
            ] {
                assert_eq!(error.path(), Some(path.as_path()), "{error}");
            }
        }
        let error = read_layer(&folder.path().join("nowhere.gpkg"), None).unwrap_err();
        assert_eq!(error.kind(), breakline::error::Kind::Io, "{error}");
    }

    /// A raster of 4 x 3 cells in a file of this driver.
    fn write_raster(path: &Path, driver: &str, values: &[f32], nodata: f64) {
        let memory = DriverManager::get_driver_by_name("MEM").unwrap();
        let mut dataset = memory.create_with_band_type::<f32, _>("", 4, 3, 1).unwrap();
        dataset
            .set_geo_transform(&[600000.0, 10.0, 0.0, 5300000.0, 0.0, -10.0])
            .unwrap();
        dataset.set_spatial_ref(&epsg(32633)).unwrap();
        let mut band = dataset.rasterband(1).unwrap();
        band.set_no_data_value(Some(nodata)).unwrap();
        band.write((0, 0), (4, 3), &mut Buffer::new((4, 3), values.to_vec()))
            .unwrap();
        let driver = DriverManager::get_driver_by_name(driver).unwrap();
        dataset
            .create_copy(&driver, path, &RasterCreationOptions::default())
            .unwrap()
            .flush_cache()
            .unwrap();
    }

    #[test]
    fn ascii_grid_whole_and_by_windows() {
        let folder = folder();
        let path = folder.path().join("a.asc");
        let values: Vec<f32> = (0..12)
            .map(|i| if i == 5 { -9999.0 } else { i as f32 * 1.5 })
            .collect();
        write_raster(&path, "AAIGrid", &values, -9999.0);
        let raster = open_raster(&path).unwrap();
        assert!(
            raster
                .description()
                .starts_with("GDAL AAIGrid, Float32, 1 band"),
            "{}",
            raster.description()
        );
        assert_eq!(Raster::crs(&raster).unwrap().epsg, Some(32633));
        let grid = raster.read_grid().unwrap();
        assert_eq!((grid.frame.width, grid.frame.height), (4, 3));
        assert_eq!(
            grid.frame.transform,
            [600000.0, 10.0, 0.0, 5300000.0, 0.0, -10.0]
        );
        for (i, (found, wanted)) in grid.values.iter().zip(&values).enumerate() {
            assert!(
                if i == 5 {
                    found.is_nan()
                } else {
                    *found == f64::from(*wanted)
                },
                "{i}: {found}"
            );
        }
        let window = Window {
            column: 1,
            row: 1,
            width: 2,
            height: 2,
        };
        let part = raster.read_window(window).unwrap();
        assert!(part[0].is_nan());
        assert_eq!(part[1..], [9.0, 13.5, 15.0]);
        let mut filled = [0.0; 4];
        raster.fill(window, &mut filled).unwrap();
        assert_eq!(filled[1..], [9.0, 13.5, 15.0]);
        for (column, width) in [(3, 2), (usize::MAX, 1), (0, usize::MAX)] {
            let error = raster
                .read_window(Window {
                    column,
                    row: 0,
                    width,
                    height: 1,
                })
                .unwrap_err();
            assert!(error.to_string().contains("4 x 3"), "{error}");
        }
    }

    use breakline::io::gdal::Raster;

    #[test]
    fn float_nodata_scale_and_offset_are_honoured() {
        let folder = folder();
        let path = folder.path().join("a.tif");
        let mut values = vec![2.0f32; 12];
        values[3] = f32::MIN;
        write_raster(&path, "GTiff", &values, -3.402_823_466_385_288_6e38);
        {
            let options = gdal::DatasetOptions {
                open_flags: gdal::GdalOpenFlags::GDAL_OF_UPDATE,
                ..gdal::DatasetOptions::default()
            };
            let dataset = gdal::Dataset::open_ex(&path, options).unwrap();
            let mut band = dataset.rasterband(1).unwrap();
            band.set_scale(0.5).unwrap();
            band.set_offset(100.0).unwrap();
        }
        let values = open_raster(&path).unwrap().read_grid().unwrap().values;
        assert!(values[3].is_nan());
        assert_eq!(values[0], 101.0);
    }

    #[test]
    #[cfg_attr(not(has_shared), ignore = "needs ../shared")]
    fn real_rasters_are_as_the_facts_say() {
        let raster = open_raster(testkit::shared("dem/gdal/n43.dt0")).unwrap();
        let grid = raster.read_grid().unwrap();
        assert_eq!((grid.frame.width, grid.frame.height), (121, 121));
        let range = grid
            .values
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
        assert_eq!(range, (75.0, 460.0));
        assert_eq!(grid.crs.unwrap().epsg, Some(4326));
        let layer = read_layer(&testkit::shared("shp/shapelib_eg/brklinz.shp"), None).unwrap();
        assert_eq!(layer.shapes.len(), 122);
        assert_eq!(
            layer
                .shapes
                .iter()
                .map(|shape| shape.vertices().count())
                .sum::<usize>(),
            1736
        );
    }
}

use super::read::{parse, parse_lines};
use super::write::write;
use super::*;
use crate::crs::Crs;
use crate::data::{ContourLine, Layer, Shape, doubled_area};
use crate::error::Result;
use crate::io::bytes::watch::unwatched;
use crate::io::options::layer::Options;

fn read(text: &str) -> Result<Layer> {
    parse(text.as_bytes(), "a", &Options::default(), &unwatched)
}

fn read_heights(text: &str, field: &str) -> Result<Layer> {
    parse(
        text.as_bytes(),
        "a",
        &Options {
            height_field: Some(field),
            ..Options::default()
        },
        &unwatched,
    )
}

#[test]
fn the_layer_has_the_name_of_the_file_or_that_within() {
    let text = r#"{"type":"FeatureCollection","name":"roads","features":[]}"#;
    let read = |layer| {
        parse(
            text.as_bytes(),
            "a",
            &Options {
                layer: Some(layer),
                ..Options::default()
            },
            &unwatched,
        )
    };
    assert!(read("a").is_ok() && read("Roads").is_ok());
    let error = read("rivers").unwrap_err();
    assert_eq!(error.to_string(), "there is no layer \"rivers\"");
    let cure = error.cure_text().unwrap();
    assert_eq!(
        *cure,
        "its only layer is \"roads\" or \"a\": name that, or write FILE::FIELD"
    );
}

fn read_columns(text: &str, columns: &[&str]) -> Result<Layer> {
    parse(
        text.as_bytes(),
        "a",
        &Options {
            columns,
            ..Options::default()
        },
        &unwatched,
    )
}

fn features(list: &[&str]) -> String {
    let list: Vec<String> = list
        .iter()
        .enumerate()
        .map(|(i, geometry)| {
            format!(r#"{{"type":"Feature","properties":{{"Z":{i}.5,"name":"n"}},"geometry":{geometry}}}"#)
        })
        .collect();
    format!(
        r#"{{"type":"FeatureCollection","features":[{}]}}"#,
        list.join(",")
    )
}

const LINE: &str = r#"{"type":"LineString","coordinates":[[0,0,1],[2,2,2]]}"#;

#[test]
fn every_geometry() {
    let text = features(&[
        r#"{"type":"Point","coordinates":[1,2,3]}"#,
        r#"{"type":"MultiPoint","coordinates":[[1,2,3],[4,5,6,7]]}"#,
        LINE,
        r#"{"type":"MultiLineString","coordinates":[[[0,0,1],[2,2,2]],[]]}"#,
        "null",
        r#"{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[]},{"type":"Point","coordinates":[1,2,3]}]}"#,
    ]);
    let layer = read(&text).unwrap();
    let line = vec![[0., 0., 1.], [2., 2., 2.]];
    let point = Shape::Points(vec![[1., 2., 3.]]);
    assert_eq!(
        layer.shapes,
        [
            point.clone(),
            Shape::Points(vec![[1., 2., 3.], [4., 5., 6.]]),
            Shape::Lines(vec![line.clone()]),
            Shape::Lines(vec![line, vec![]]),
            Shape::Null,
            Shape::Null,
            point,
        ]
    );
    assert_eq!(layer.fields, ["Z", "name"]);
    let flat = read(r#"{"type":"Point","coordinates":[1,2]}"#).unwrap();
    assert!(flat.shapes[0].vertices().next().unwrap()[2].is_nan());
}

#[test]
fn rings_get_the_order_of_shapefiles() {
    let [ccw, cw] = [
        "[[0,0,0],[9,0,0],[9,9,0],[0,0,0]]",
        "[[1,1,0],[9,9,0],[9,1,0]]",
    ];
    for [outer, inner] in [[ccw, cw], [cw, ccw], [ccw, ccw], [cw, cw]] {
        let text =
            format!(r#"{{"type":"MultiPolygon","coordinates":[[{outer},{inner}],[{outer}]]}}"#);
        let Shape::Polygon(rings) = read(&text).unwrap().shapes.remove(0) else {
            panic!()
        };
        let signs: Vec<bool> = rings.iter().map(|ring| doubled_area(ring) < 0.0).collect();
        assert_eq!(signs, [true, false, true]);
        assert!(
            rings
                .iter()
                .all(|ring| ring.len() == 4 && ring[0] == ring[3])
        );
    }
}

#[test]
fn heights_from_a_property() {
    let text = features(&[LINE, "null", LINE]).replace("2.5", "\"12,5\"");
    let layer = read_heights(&text, "z").unwrap();
    let heights: Vec<f64> = layer
        .shapes
        .iter()
        .flat_map(Shape::vertices)
        .map(|v| v[2])
        .collect();
    assert_eq!(heights, [0.5, 0.5, 12.5, 12.5]);
    let error = read_heights(&text, "ELEV").unwrap_err();
    assert_eq!(
        (
            error.to_string().as_str(),
            error.cure_text().map(|cure| cure.plain())
        ),
        (
            "there is no field ELEV",
            Some("name one of Z, name".to_owned())
        )
    );
    let error = read_heights(&text, "name").unwrap_err();
    assert_eq!(
        error.to_string(),
        "property name holds no numbers; the first value is n"
    );
    let text = features(&[LINE, LINE]).replace("1.5", "\"high\"");
    let layer = read_heights(&text, "Z").unwrap();
    assert!(
        layer.warnings[0]
            .plain()
            .contains("no number in 1 features (the first: high)")
    );
    let text = features(&[LINE, LINE]).replace("1.5", "null");
    let layer = read_heights(&text, "Z").unwrap();
    assert!(layer.shapes[1].vertices().all(|v| v[2].is_nan()));
}

#[test]
fn columns_have_a_number_for_each_shape() {
    let both = format!(r#"{{"type":"GeometryCollection","geometries":[{LINE},{LINE}]}}"#);
    let text = features(&[&both, "null", LINE, LINE])
        .replace("2.5", "null")
        .replace(r#""Z":3.5"#, r#""z":"3,5""#);
    let layer = read_columns(&text, &["z"]).unwrap();
    assert_eq!((layer.shapes.len(), layer.columns.len()), (5, 1));
    let values = &layer.column("Z").unwrap().values;
    assert_eq!(
        (&values[..3], values[3].is_nan(), values[4]),
        (&[0.5, 0.5, 1.5][..], true, 3.5)
    );
    let error = read_columns(&text, &["Z", "WIDTH"]).unwrap_err();
    assert_eq!(error.to_string(), "there is no field WIDTH");
    assert_eq!(*error.cure_text().unwrap(), "name one of Z, name, z");
    let error = read_columns(&text.replace("1.5", "true"), &["Z"]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "feature 2: field Z: expected a number, found 'true'"
    );
    assert!(
        read_columns(LINE, &["Z"])
            .unwrap_err()
            .to_string()
            .contains("no field Z")
    );
    assert_eq!(
        read_columns(&features(&[]), &["Z"]).unwrap().columns[0].values,
        [0.0; 0]
    );
}

#[test]
fn errors_name_the_position() {
    for (text, message) in [
        ("", "not JSON: EOF while parsing a value at line 1 column 0"),
        ("[]", "not GeoJSON: no object with a type"),
        ("{}", "not GeoJSON: an object without a type"),
        (
            r#"{"type":"Topology"}"#,
            "type Topology is not a GeoJSON type",
        ),
        (r#"{"type":"FeatureCollection"}"#, "no array features"),
        (
            &features(&[LINE, r#"{"type":"Point","coordinates":[1]}"#]),
            "feature 2: a position of 1 numbers",
        ),
        (
            &features(&[r#"{"type":"Point","coordinates":[1,"a"]}"#]),
            "feature 1: coordinate \"a\"",
        ),
        (
            &features(&[r#"{"type":"LineString","coordinates":[1,2]}"#]),
            "feature 1: 1 instead of an array",
        ),
        (
            &features(&["7"]),
            "feature 1: its geometry is not an object",
        ),
    ] {
        assert_eq!(read(text).unwrap_err().to_string(), message);
    }
    assert!(read(&"[".repeat(100_000)).is_err());
    let good = features(&[LINE]);
    assert!((0..good.len()).all(|cut| read(&good[..cut]).is_err()));
}

#[test]
fn systems_that_are_not_stated() {
    let far = read(r#"{"type":"Point","coordinates":[500000,2]}"#).unwrap();
    assert!(
        far.crs.is_none()
            && far.warnings[0]
                .plain()
                .contains("not longitude and latitude")
    );
    let unknown = read(r#"{"type":"Point","coordinates":[1,2],"crs":null}"#).unwrap();
    assert!(unknown.crs.is_none() && unknown.warnings.is_empty());
    let linked = read(r#"{"type":"Point","coordinates":[1,2],"crs":{"type":"link"}}"#).unwrap();
    assert!(linked.warnings[0].plain().contains("not given by name"));
    assert_eq!(linked.unread_crs.as_deref(), Some(r#"{"type":"link"}"#));
}

#[test]
fn systems_that_are_stated() {
    let system = |name: &str| {
        let crs = format!(r#"{{"type":"name","properties":{{"name":"{name}"}}}}"#);
        read(&format!(
            r#"{{"type":"Point","coordinates":[500000,2],"crs":{crs}}}"#
        ))
        .unwrap()
    };
    for (name, codes) in [
        ("urn:ogc:def:crs:EPSG::32633", (Some(32633), None)),
        ("EPSG:32633", (Some(32633), None)),
        (
            "urn:ogc:def:crs,crs:EPSG::32633,crs:EPSG::5783",
            (Some(32633), Some(5783)),
        ),
        ("urn:ogc:def:crs:OGC:1.3:CRS84", (Some(4326), None)),
    ] {
        let Layer {
            crs,
            unread_crs,
            warnings,
            ..
        } = system(name);
        let crs = crs.unwrap_or_else(|| panic!("{name}: {warnings:?}"));
        assert_eq!((crs.epsg, crs.vertical_epsg), codes, "{name}");
        assert!(unread_crs.is_none() && warnings.is_empty());
    }
    let unknown = system("urn:ogc:def:crs:IGNF::LAMB93");
    assert_eq!(
        (unknown.crs, unknown.unread_crs.as_deref()),
        (None, Some("urn:ogc:def:crs:IGNF::LAMB93"))
    );
    assert!(
        unknown.warnings[0]
            .plain()
            .contains("the codes of IGNF are not known"),
        "{:?}",
        unknown.warnings
    );
}

#[test]
fn texts_with_different_decimal_marks_are_refused() {
    let feature = |z: &str| {
        format!(
            r#"{{"type":"Feature","geometry":{{"type":"Point","coordinates":[1,2]}},"properties":{{"z":"{z}"}}}}"#
        )
    };
    let collection = |z: &[&str]| {
        let list: Vec<String> = z.iter().map(|z| feature(z)).collect();
        format!(
            r#"{{"type":"FeatureCollection","features":[{}]}}"#,
            list.join(",")
        )
    };
    for read in [
        read_heights as fn(&str, &str) -> Result<Layer>,
        |text, name| read_columns(text, &[name]),
    ] {
        assert!(read(&collection(&["1,5", "500,000", "", "7"]), "z").is_ok());
        let error = read(&collection(&["500,000", "3.5"]), "z")
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("feature 2: ") || error.contains("property z"),
            "{error}"
        );
        assert!(error.contains("3.5 has a point and 500,000"), "{error}");
    }
}

#[test]
fn contours_come_back() {
    let lines = vec![
        ContourLine {
            level: 0.1 + 0.2,
            points: vec![[1e-9, -0.1], [500_000.123_456_789, 5e6]],
        },
        ContourLine {
            level: -0.0,
            points: vec![[0., 0.]],
        },
        ContourLine {
            level: -0.0,
            points: vec![[0., 0.], [1., 0.], [1., 1.], [0., 0.]],
        },
    ];
    let mut bytes = Vec::new();
    let summary = write(&mut bytes, &mut lines.clone().into_iter(), None).unwrap();
    assert_eq!((summary.lines, summary.vertices, summary.closed), (2, 6, 1));
    let layer = read_heights(std::str::from_utf8(&bytes).unwrap(), "ELEV").unwrap();
    assert_eq!(layer.fields, ["ELEV", "ID"]);
    for (shape, line) in layer.shapes.iter().zip([&lines[0], &lines[2]]) {
        let vertices: Vec<[f64; 3]> = line
            .points
            .iter()
            .map(|p| [p[0], p[1], line.level])
            .collect();
        assert_eq!(*shape, Shape::Lines(vec![vertices]));
    }
    assert_eq!(
        read(std::str::from_utf8(&bytes).unwrap()).unwrap().shapes,
        layer.shapes
    );
    let mut bytes = Vec::new();
    write(&mut bytes, &mut std::iter::empty(), None).unwrap();
    assert!(
        read(std::str::from_utf8(&bytes).unwrap())
            .unwrap()
            .shapes
            .is_empty()
    );
}

#[test]
fn lines_are_read_one_by_one() {
    let read = |text: &str| parse_lines(text.as_bytes(), &Options::default(), &unwatched);
    let feature = format!(r#"{{"type":"Feature","properties":{{"Z":1}},"geometry":{LINE}}}"#);
    let spread = feature.replace(',', ",\n");
    for text in [
        format!("\u{feff}{feature}\r\n\n{feature}\n{LINE}"),
        format!("\u{feff}\n\x1e{spread}\n\x1e{feature}\x1e\x1e{LINE}"),
    ] {
        let layer = read(&text).unwrap();
        assert_eq!(
            (layer.format.as_str(), layer.shapes.len()),
            ("GeoJSON lines", 3)
        );
        assert!(layer.crs.is_some() && layer.shapes.iter().all(|shape| *shape == layer.shapes[0]));
    }
    // A geometry alone has no properties, also not those of the feature behind it.
    let options = Options {
        columns: &["Z"],
        height_field: Some("z"),
        ..Options::default()
    };
    let layer = parse_lines(
        format!("{LINE}\n{feature}").as_bytes(),
        &options,
        &unwatched,
    )
    .unwrap();
    assert!(layer.columns[0].values[0].is_nan() && layer.columns[0].values[1] == 1.0);
    assert!(layer.shapes[0].vertices().all(|v| v[2].is_nan()));
    let with_z = Options {
        height_field: Some("z"),
        ..Options::default()
    };
    let layer = parse_lines(feature.as_bytes(), &with_z, &unwatched).unwrap();
    assert!(layer.shapes[0].vertices().all(|v| v[2] == 1.0));
    for (second, message) in [
        (
            "{",
            "line 2: not JSON: EOF while parsing an object at line 1 column 1",
        ),
        ("7", "line 2: not an object"),
        ("{}", "line 2: not GeoJSON: an object without a type"),
        (
            r#"{"type":"Point","coordinates":[1]}"#,
            "line 2: a position of 1 numbers",
        ),
        (
            &features(&[LINE]).replace('\n', ""),
            "line 2: a FeatureCollection, where each line is one feature",
        ),
    ] {
        assert_eq!(
            read(&format!("{LINE}\n{second}")).unwrap_err().to_string(),
            message
        );
    }
    let error = read(&format!("\x1e{LINE}\n\x1e7")).unwrap_err();
    assert_eq!(error.to_string(), "record 2: not an object");
    assert!(read("").unwrap().shapes.is_empty());
}

#[test]
fn contours_come_back_from_lines() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("a.geojsonl");
    let line = |level| ContourLine {
        level,
        points: vec![[0.5, 1.0], [2.0, 3.0]],
    };
    let short = ContourLine {
        level: 1.0,
        points: vec![[0.0, 0.0]],
    };
    let mut lines = vec![line(1.0), short, line(2.5)].into_iter();
    let summary = write_contour_lines(&target, &mut lines, None).unwrap();
    assert_eq!(
        (summary.lines, summary.vertices, summary.warnings.len()),
        (2, 4, 1)
    );
    let text = std::fs::read_to_string(&target).unwrap();
    assert_eq!(text.lines().count(), 2);
    assert!(
        text.lines()
            .all(|line| line.starts_with(r#"{"type":"Feature""#) && line.ends_with("]}}"))
    );
    let with_level = Options {
        height_field: Some("ELEV"),
        ..Options::default()
    };
    let layer = read_lines_with(&target, &with_level, &unwatched).unwrap();
    let expected = [1.0, 2.5].map(|z| Shape::Lines(vec![vec![[0.5, 1.0, z], [2.0, 3.0, z]]]));
    assert_eq!(layer.shapes, expected);
    let sequence = target.with_extension("geojsons");
    write_contour_lines(&sequence, &mut vec![line(1.0), line(2.5)].into_iter(), None).unwrap();
    assert!(
        std::fs::read_to_string(&sequence)
            .unwrap()
            .lines()
            .all(|line| line.starts_with("\x1e{"))
    );
    assert_eq!(
        read_lines_with(&sequence, &with_level, &unwatched)
            .unwrap()
            .shapes,
        layer.shapes
    );
    let degrees = Crs::from_epsg(WGS_84).unwrap();
    assert!(
        write_contour_lines(&target, &mut std::iter::empty(), Some(&degrees))
            .unwrap()
            .warnings
            .is_empty()
    );
}

#[test]
fn a_table_that_is_nearly_empty_is_refused() {
    let read = |features: usize, properties: &dyn Fn(usize) -> String| {
        let feature = |i| {
            let properties = properties(i);
            format!(r#"{{"type":"Feature","geometry":null,"properties":{{{properties}}}}}"#)
        };
        let features: Vec<String> = (0..features).map(feature).collect();
        let features = features.join(",");
        let text = format!(r#"{{"type":"FeatureCollection","features":[{features}]}}"#);
        let options = Options {
            keeps_attributes: true,
            ..Options::default()
        };
        parse(text.as_bytes(), "a", &options, &unwatched)
    };
    let error = read(3200, &|i| format!(r#""k{i}":{i}"#)).unwrap_err();
    let text = "3200 different properties of 3200 features, which have 3200 in all";
    assert!(error.to_string().contains(text), "{error}");
    let few = read(100, &|i| format!(r#""k{i}":{i}"#)).unwrap();
    let table = few.attributes.unwrap();
    assert_eq!((table.names.len(), table.rows.len()), (100, 100));
    // Many features with the same properties are none.
    let same = read(5000, &|i| format!(r#""a":{i},"b":null"#)).unwrap();
    assert_eq!(same.attributes.unwrap().rows.len(), 5000);
}

#[test]
fn polygons_are_written_with_their_holes() {
    let ring = |low: f64, high: f64, is_clockwise: bool| -> Vec<[f64; 3]> {
        let mut ring: Vec<[f64; 3]> = [
            [low, low],
            [low, high],
            [high, high],
            [high, low],
            [low, low],
        ]
        .map(|[x, y]| [x, y, f64::NAN])
        .to_vec();
        if !is_clockwise {
            ring.reverse();
        }
        ring
    };
    let around = vec![
        ring(0.0, 9.0, true),
        ring(1.0, 2.0, false),
        ring(3.0, 4.0, false),
    ];
    let island = vec![ring(1.25, 1.75, true)];
    let layer = Layer {
        shapes: vec![
            Shape::Polygon(around.clone()),
            Shape::Polygon([around, island].concat()),
            Shape::Polygon(Vec::new()),
        ],
        ..Layer::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("x.geojson");
    super::write_lines(&target, &layer).unwrap();
    let text = std::fs::read_to_string(&target).unwrap();
    let written: serde_json::Value = serde_json::from_str(&text).unwrap();
    let geometry = |i: usize| &written["features"][i]["geometry"];
    assert_eq!(geometry(0)["type"], "Polygon");
    assert_eq!(geometry(0)["coordinates"].as_array().unwrap().len(), 3);
    // Outer rings are counter-clockwise.
    let outer = serde_json::json!([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]]);
    let as_numbers = |ring: &serde_json::Value| -> Vec<f64> {
        let points = ring.as_array().unwrap().iter();
        points
            .flat_map(|p| [p[0].as_f64().unwrap(), p[1].as_f64().unwrap()])
            .collect()
    };
    assert_eq!(
        as_numbers(&geometry(0)["coordinates"][0]),
        as_numbers(&outer)
    );
    assert_eq!(geometry(1)["type"], "MultiPolygon");
    let sizes = geometry(1)["coordinates"].as_array().unwrap().iter();
    let sizes: Vec<usize> = sizes
        .map(|polygon| polygon.as_array().unwrap().len())
        .collect();
    assert_eq!(sizes, [3, 1]);
    assert!(geometry(2).is_null());
}

#[test]
fn points_come_back() {
    let shapes = vec![
        Shape::Points(vec![[1.0, 2.0, 3.0]]),
        Shape::Points(vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
        Shape::Null,
    ];
    let layer = Layer {
        shapes: shapes.clone(),
        ..Layer::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("x.geojson");
    super::write_lines(&target, &layer).unwrap();
    let text = std::fs::read_to_string(&target).unwrap();
    assert_eq!(read(&text).unwrap().shapes, shapes);
}

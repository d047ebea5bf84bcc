//! Sound files: what the facts state, and heights of attributes.

use super::{facts, read};
use breakline::data::{Bounds, Layer, Shape};
use breakline::io::layer;

fn parts(layer: &Layer) -> usize {
    let parts = layer.shapes.iter().map(|shape| match shape {
        Shape::Lines(parts) | Shape::Polygon(parts) => parts.len(),
        _ => 0,
    });
    parts.sum()
}

fn bounds(layer: &Layer) -> Bounds {
    let mut bounds = Bounds::default();
    layer
        .shapes
        .iter()
        .flat_map(Shape::vertices)
        .for_each(|&v| bounds.add(v));
    bounds
}

/// Names of the types of a file, as in its facts.
fn format_name(code: u64) -> &'static str {
    match code {
        1 => "Point",
        3 => "PolyLine",
        5 => "Polygon",
        8 => "MultiPoint",
        11 => "PointZ",
        13 => "PolyLineZ",
        15 => "PolygonZ",
        18 => "MultiPointZ",
        21 => "PointM",
        23 => "PolyLineM",
        25 => "PolygonM",
        31 => "MultiPatch",
        other => panic!("type {other}"),
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_sound_shapefile_has_the_facts() {
    let facts = facts();
    let mut seen = 0;
    for (name, fact) in facts
        .iter()
        .filter(|(name, _)| name.ends_with(".shp") && !name.contains("/broken"))
    {
        let layer = read(&testkit::shared(name)).unwrap_or_else(|e| panic!("{e}"));
        let number = |key: &str| {
            fact[key]
                .as_u64()
                .unwrap_or_else(|| panic!("{name}: no {key}")) as usize
        };
        seen += 1;
        assert_eq!(
            layer.format,
            format!("shapefile {}", format_name(number("hdr_type") as u64)),
            "{name}"
        );
        assert_eq!(layer.shapes.len(), number("records"), "{name}: records");
        let nulls = layer
            .shapes
            .iter()
            .filter(|shape| matches!(shape, Shape::Null))
            .count();
        assert_eq!(nulls, number("nulls"), "{name}: nulls");
        // Parts of a multipatch become faces; the test below looks at them.
        if number("hdr_type") != 31 {
            assert_eq!(parts(&layer), number("parts"), "{name}: parts");
            let vertices = layer.shapes.iter().flat_map(Shape::vertices).count();
            // Its three rings lack their last vertex.
            let closed = if name == "shp/types/polygon.shp" {
                3
            } else {
                0
            };
            assert_eq!(vertices, number("points") + closed, "{name}: points");
        }
        let found = bounds(&layer);
        let bbox: Vec<f64> = fact["hdr_bbox"]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_f64().unwrap())
            .collect();
        // The header of this one was written before its points were moved.
        if name != "shp/shapelib_eg/3dpoints.shp" {
            assert_eq!(
                [found.min[0], found.min[1], found.max[0], found.max[1]],
                bbox[..],
                "{name}: bbox"
            );
        }
        match fact["z"].as_array() {
            Some(z) => {
                assert_eq!(
                    [found.min[2], found.max[2]],
                    [z[0].as_f64().unwrap(), z[1].as_f64().unwrap()],
                    "{name}: z"
                )
            }
            None => assert!(found.min[2] > found.max[2], "{name}: no heights"),
        }
    }
    assert_eq!(seen, 65);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn multipatches_become_faces() {
    // A fan and a strip of n vertices give n - 2 triangles; a file has a ring with two holes.
    let holes: &[usize] = &[9, 5, 5];
    for (name, triangles, last) in [
        ("shp/gdal/multipatch.shp", 4 + 6, holes),
        ("shp/types/multipatch.shp", 8 + 4, &[4]),
    ] {
        let layer = read(&testkit::shared(name)).unwrap();
        let [Shape::Faces(faces)] = &layer.shapes[..] else {
            panic!("{name}: {:?}", layer.shapes)
        };
        let lengths: Vec<Vec<usize>> = faces
            .iter()
            .map(|face| face.iter().map(Vec::len).collect())
            .collect();
        assert_eq!(
            lengths.iter().filter(|rings| **rings == [4]).count(),
            triangles,
            "{name}"
        );
        assert_eq!(lengths.last().unwrap(), last, "{name}");
        assert_eq!(layer.warnings, [] as [&str; 0], "{name}");
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn heights_come_from_an_attribute() {
    let path = testkit::shared("lidar/ign_0292_6833/Lignes_3d_0292_6833.shp");
    let spec = |field: &str| format!("{}:{field}", path.display());
    let layer = layer::read(&spec("recupz")).unwrap();
    assert_eq!(layer.shapes.len(), 1189);
    let heights = bounds(&layer);
    assert!(
        layer
            .shapes
            .iter()
            .flat_map(Shape::vertices)
            .all(|v| v[2].is_finite())
    );

    // The same lines as GeoJSON, for the lines in the tile: the heights agree line by line.
    let twin = testkit::shared("lidar/ign_0292_6833/Lignes_2d_0292_6833.geojson");
    let twin = layer::read(&format!("{}:RecupZ", twin.display())).unwrap();
    assert_eq!(twin.shapes.len(), 48);
    let find = |v: &[f64; 3]| {
        let all = layer.shapes.iter().flat_map(Shape::vertices);
        let same = |w: &&[f64; 3]| (v[0] - w[0]).abs() < 1e-6 && (v[1] - w[1]).abs() < 1e-6;
        all.filter(same).map(|w| w[2]).collect::<Vec<f64>>()
    };
    for v in twin.shapes.iter().flat_map(Shape::vertices) {
        assert!(find(v).contains(&v[2]), "{v:?}: {:?}", find(v));
        assert!(heights.min[2] <= v[2] && v[2] <= heights.max[2]);
    }

    let error = layer::read(&spec("ELEV")).unwrap_err();
    assert_eq!(
        *error.cure_text().unwrap(),
        "name one of FID, ID_seg, RecupZ"
    );
    assert!(
        error
            .to_string()
            .ends_with("Lignes_3d_0292_6833.dbf: there is no field ELEV"),
        "{error}"
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn geojson_has_heights_of_its_own() {
    let layer = read(&testkit::shared(
        "lidar/ign_0292_6833/Points_virtuels_0292_6833.geojson",
    ))
    .unwrap();
    assert_eq!(
        (layer.shapes.len(), layer.format.as_str()),
        (2423, "GeoJSON")
    );
    assert!(
        layer
            .shapes
            .iter()
            .all(|s| matches!(s, Shape::Points(p) if p.len() == 1 && p[0][2].is_finite()))
    );
}

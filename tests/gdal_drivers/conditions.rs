//! Conditions for records: ours, and those of GDAL's SQL.

use std::path::Path;

use breakline::data::Shape;
use breakline::io::gdal::read_layer_with;
use breakline::io::layer::{Condition, Options};
use gdal::Dataset;
use gdal::vector::LayerAccess;

/// Records with numbers and texts, some missing.
const RECORDS: &str = "\
WKT,kind,height,count
POINT (0 0),toe,1.5,3
POINT (1 0),top,2.5,
POINT (2 0),,-1,4
POINT (3 0),Toe,,5
POINT (4 0),o'clock,7e2,-6
POINT (5 0),to%e,0,0
POINT (6 0),50 %,3.25,3
";

const TYPES: &str = "\"String\",\"String\",\"Real\",\"Integer\"\n";

/// Conditions that both understand.
const CONDITIONS: &[&str] = &[
    "height > 2",
    "height >= 2.5 AND count = 3",
    "height < 2 OR count > 4",
    "count IN (3, 5)",
    "height BETWEEN 0 AND 2.5",
    "height IS NULL",
    "height IS NOT NULL AND NOT (height > 2)",
    "count IS NOT NULL AND count NOT IN (3, 5)",
    "height IS NOT NULL",
    "count <> 3",
    "kind = 'o''clock'",
    "kind = 'top'",
    "kind <> 'top'",
    "kind IN ('top', 'to%e')",
    "count = 3 AND (kind = '50 %' OR height = 1.5)",
    "NOT height IS NULL AND (count IS NULL OR NOT count = 0)",
];

/// Conditions that ours answer as SQL does: what is compared with a missing value is unknown, and
/// so is its opposite, by which nothing is chosen. GDAL 3.6 takes it for false, and its opposite
/// for true.
const OF_MISSING: &[&str] = &["NOT (height > 2)", "NOT (count IN (3, 5))"];

fn ours(path: &Path, text: &str) -> Vec<f64> {
    let condition = Condition::parse(text).unwrap();
    let options = Options {
        condition: Some(&condition),
        ..Options::default()
    };
    let layer = read_layer_with(path, &options, &|_| Ok(()));
    let layer = layer.unwrap_or_else(|error| panic!("{text}: {error}"));
    let x = layer.shapes.iter().map(|shape| match shape {
        Shape::Points(points) => points[0][0],
        other => panic!("{other:?}"),
    });
    x.collect()
}

fn theirs(path: &Path, text: &str) -> Vec<f64> {
    let dataset = Dataset::open(path).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    layer
        .set_attribute_filter(text)
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    let x = layer
        .features()
        .map(|feature| feature.geometry().unwrap().get_point(0).0);
    x.collect()
}

#[test]
fn conditions_choose_the_same_records_as_gdals_filters() {
    let folder = super::folder_with(&[("a.csv", RECORDS), ("a.csvt", TYPES)]);
    let path = folder.path().join("a.csv");
    for text in CONDITIONS {
        assert_eq!(ours(&path, text), theirs(&path, text), "{text}");
    }
    // Records 1 and 3 miss a number.
    for (text, missing) in OF_MISSING.iter().zip([3.0, 1.0]) {
        let mut with_missing = ours(&path, text);
        assert!(!with_missing.contains(&missing), "{text}");
        with_missing.push(missing);
        with_missing.sort_by(f64::total_cmp);
        assert_eq!(with_missing, theirs(&path, text), "{text}");
    }
}

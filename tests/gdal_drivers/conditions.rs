//! Conditions for records: ours, and those of GDAL's SQL.

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
    "NOT (height > 2)",
    "count IN (3, 5)",
    "count NOT IN (3, 5)",
    "height BETWEEN 0 AND 2.5",
    "height IS NULL",
    "height IS NOT NULL",
    "count <> 3",
    "kind = 'o''clock'",
    "kind = 'top'",
    "kind <> 'top'",
    "kind IN ('top', 'to%e')",
    "height * 1 > 2",
    "count = 3 AND (kind = '50 %' OR height = 1.5)",
    "NOT height IS NULL AND NOT count = 0",
];

#[test]
fn conditions_choose_the_same_records_as_gdals_filters() {
    let folder = super::folder_with(&[("a.csv", RECORDS), ("a.csvt", TYPES)]);
    let path = folder.path().join("a.csv");
    let mut compared = 0;
    for text in CONDITIONS {
        let Ok(condition) = Condition::parse(text) else {
            continue;
        };
        let options = Options {
            condition: Some(&condition),
            ..Options::default()
        };
        let ours: Vec<f64> = read_layer_with(&path, &options, &|_| Ok(()))
            .unwrap_or_else(|error| panic!("{text}: {error}"))
            .shapes
            .iter()
            .map(|shape| match shape {
                Shape::Points(points) => points[0][0],
                other => panic!("{other:?}"),
            })
            .collect();
        let dataset = Dataset::open(&path).unwrap();
        let mut layer = dataset.layer(0).unwrap();
        layer
            .set_attribute_filter(text)
            .unwrap_or_else(|error| panic!("{text}: {error}"));
        let theirs: Vec<f64> = layer
            .features()
            .map(|feature| feature.geometry().unwrap().get_point(0).0)
            .collect();
        assert_eq!(ours, theirs, "{text}");
        compared += 1;
    }
    assert!(compared >= CONDITIONS.len() - 1, "{compared}");
}

//! Tiles agree with the whole.

use std::sync::atomic::AtomicBool;

use super::super::{GroundOptions, GroundTiles, PointClass, Take, classify_in_tiles};
use super::{Numbers, classes};
use crate::error::Result;

/// Hills with boxes on them, one point for each 2 square meters.
fn town(side: f64) -> Vec<[f64; 3]> {
    let mut numbers = Numbers(11);
    let count = (0.5 * side * side) as usize;
    let point = |_| {
        let [x, y] = [numbers.unit() * side, numbers.unit() * side];
        let hill = 8.0 * (x / 60.0).sin() * (y / 45.0).cos() + 0.05 * numbers.unit();
        let is_box = x % 40.0 < 14.0 && y % 37.0 < 11.0;
        let tree = if numbers.below(20) == 0 {
            6.0 * numbers.unit()
        } else {
            0.0
        };
        [
            x + 500_000.0,
            y + 4_000_000.0,
            hill + if is_box { 7.0 } else { tree },
        ]
    };
    (0..count).map(point).collect()
}

fn in_tiles(points: &[[f64; 3]], at_once: usize) -> super::super::TiledClasses {
    let folder = tempfile::tempdir().unwrap();
    let pass = |take: &mut Take| -> Result<()> { points.chunks(1000).try_for_each(take) };
    let limits = GroundTiles {
        at_once,
        folder: folder.path(),
    };
    let options = GroundOptions {
        noise: true,
        ..GroundOptions::default()
    };
    let cancel = AtomicBool::new(false);
    let mut decided = 0;
    let found = classify_in_tiles(&pass, &options, &limits, &cancel, &mut |count| {
        decided += count;
        Ok(())
    });
    let found = found.unwrap();
    let finite = points
        .iter()
        .filter(|point| point.iter().all(|value| value.is_finite()));
    assert_eq!(decided, finite.count());
    found
}

#[test]
fn tiles_find_the_ground_of_the_whole() {
    let mut points = town(500.0);
    points.insert(5, [f64::NAN, 1.0, 2.0]);
    let options = GroundOptions {
        noise: true,
        ..GroundOptions::default()
    };
    let whole = classes(&points, &options);
    assert!(
        whole
            .iter()
            .filter(|&&class| class == PointClass::Ground)
            .count()
            > 60_000
    );
    for at_once in [1 << 30, 60_000] {
        let tiled = in_tiles(&points, at_once);
        assert_eq!(tiled.tiles > 1, at_once < points.len(), "{}", tiled.tiles);
        let differ = whole.iter().zip(&tiled.classes).filter(|(a, b)| a != b);
        assert_eq!(differ.count(), 0, "{} tiles", tiled.tiles);
        assert_eq!(tiled.doubts, []);
    }
}

#[test]
fn the_order_of_points_does_not_matter_to_tiles() {
    let points = town(300.0);
    let mut backwards = points.clone();
    backwards.reverse();
    let mut classes = in_tiles(&backwards, 35_000).classes;
    classes.reverse();
    assert_eq!(in_tiles(&points, 35_000).classes, classes);
}

#[test]
fn too_many_points_for_memory_are_refused_with_their_number() {
    let points = town(60.0);
    let folder = tempfile::tempdir().unwrap();
    let pass = |take: &mut Take| -> Result<()> { take(&points) };
    let limits = GroundTiles {
        at_once: 1000,
        folder: folder.path(),
    };
    let cancel = AtomicBool::new(false);
    let options = GroundOptions::default();
    let found = classify_in_tiles(&pass, &options, &limits, &cancel, &mut |_| Ok(()));
    let said = found.unwrap_err().to_string();
    assert!(said.contains("1800 points are within 100 m"), "{said}");
}

#[test]
fn no_points_have_no_classes() {
    assert_eq!(in_tiles(&[], 10).classes, []);
    let nowhere = [[f64::INFINITY, 0.0, 0.0]];
    assert_eq!(in_tiles(&nowhere, 10).classes, [PointClass::Object]);
}

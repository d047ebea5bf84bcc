//! Where waters end.

use crate::data::{EdgeKind, Surface, corners};
use crate::terrain::{Flat, FlatHeight, River, Tin, TinBuilder};

/// Points on a grid of unit steps, at height 5, where `is_measured` is true.
fn points(side: u32, is_measured: impl Fn([f64; 2]) -> bool) -> TinBuilder {
    let mut builder = TinBuilder {
        max_edge: Some(3.0),
        ..TinBuilder::default()
    };
    for site in (0..side * side).map(|k| [f64::from(k % side), f64::from(k / side)]) {
        if is_measured(site) {
            builder.add_points(&[site[0]], &[site[1]], &[5.0]);
        }
    }
    builder
}

fn ring(corners: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let closed = corners.iter().chain(corners.first());
    closed.map(|&[x, y]| [x, y, 1.0]).collect()
}

fn lake(rings: &[Vec<[f64; 3]>]) -> Flat {
    Flat::new(rings, FlatHeight::Given(1.0)).unwrap()
}

/// A canal from far west to far east.
fn canal() -> Flat {
    lake(&[ring(&[
        [-30.0, 8.25],
        [50.0, 8.5],
        [50.0, 10.75],
        [-30.0, 10.5],
    ])])
}

/// The area of the faces of a surface in plan, and of those at the height of the water.
fn areas(tin: &Tin) -> [f64; 2] {
    let mut areas = [0.0; 2];
    for (_, face) in corners(tin) {
        let [a, b, c] = face.map(|vertex| tin.position(vertex));
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
        areas[0] += area;
        if [a, b, c].iter().all(|p| p[2] == 1.0) {
            areas[1] += area;
        }
    }
    areas
}

fn assert_near(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-9,
        "{found}, expected {expected}"
    );
}

#[test]
fn a_canal_ends_where_points_end() {
    let mut builder = points(20, |_| true);
    builder.add_flat(canal());
    let tin = builder.build().unwrap();
    let [all, water] = areas(&tin);
    assert_near(all, 19.0 * 19.0);
    assert_near(water, 19.0 * 2.25);
    assert_eq!(tin.report().waters_ended, [0]);
    for (x, y) in [(0.0, 9.0), (19.0, 9.0), (5.5, 9.5)] {
        assert_eq!(tin.elevation(x, y), Some(1.0), "at {x} {y}");
    }
    for (x, y) in [(-0.5, 9.0), (19.5, 9.0)] {
        assert_eq!(tin.elevation(x, y), None);
    }
    assert_eq!(tin.elevation(0.0, 12.0), Some(5.0));
    assert!(tin.check(crate::triangulation::Level::Law).is_empty());
    assert!(tin.report().edges.of(EdgeKind::Shore) > 4);
}

/// Points in a canal count where the surface ends, also if they were taken before.
#[test]
fn points_that_are_taken_count() {
    let mut builder = points(20, |_| true);
    builder.add_flat(canal());
    let mut taken = builder.clone();
    assert!(taken.take_replaced_points().len() > 30);
    let [whole, taken] = [builder, taken].map(|builder| areas(&builder.build().unwrap()));
    assert_eq!(whole, taken);
}

/// A gap between points that is open to the outside stays out of the surface, also where there is
/// water.
#[test]
fn a_lake_ends_at_a_gap_between_points() {
    let is_measured = |[x, y]: [f64; 2]| x < 8.0 || y < 8.0;
    let bare = points(20, is_measured).build().unwrap();
    let mut builder = points(20, is_measured);
    builder.add_flat(lake(&[ring(&[
        [2.5, 2.5],
        [17.0, 3.5],
        [16.0, 17.0],
        [3.0, 16.5],
    ])]));
    let tin = builder.build().unwrap();
    assert_near(areas(&tin)[0], areas(&bare)[0]);
    assert!(areas(&tin)[1] > 80.0);
    assert_eq!(tin.elevation(12.0, 12.0), None);
    assert_eq!(tin.elevation(12.0, 5.0), Some(1.0));
    assert_eq!(tin.report().waters_ended, [0]);
}

#[test]
fn a_lake_within_the_points_stays_as_it_is() {
    // No point is in the lake, and so no edge across it is short.
    let is_measured = |[x, y]: [f64; 2]| (x - 10.0).hypot(y - 10.0) > 7.0;
    let mut builder = points(20, is_measured);
    let shore: Vec<[f64; 2]> = (0..40)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 40.0)
        .map(|angle| [10.0 + 6.5 * angle.cos(), 10.0 + 6.5 * angle.sin()])
        .collect();
    builder.add_flat(lake(&[ring(&shore)]));
    let tin = builder.build().unwrap();
    assert!(tin.report().waters_ended.is_empty());
    assert_near(areas(&tin)[0], 19.0 * 19.0);
    assert_eq!(tin.report().edges.of(EdgeKind::Shore), 40);
}

#[test]
fn islands_stay_and_lakes_elsewhere_vanish() {
    let mut builder = points(20, |_| true);
    let shore = ring(&[[-9.0, 4.5], [12.5, 4.5], [12.5, 15.5], [-9.0, 15.5]]);
    let island = ring(&[[-3.0, 7.5], [6.5, 7.5], [6.5, 12.5], [-3.0, 12.5]]);
    builder.add_flat(lake(&[shore, island]));
    builder.add_flat(lake(&[ring(&[[60.0, 60.0], [70.0, 60.0], [60.0, 70.0]])]));
    let tin = builder.build().unwrap();
    let [all, water] = areas(&tin);
    assert_near(all, 19.0 * 19.0);
    assert_near(water, 12.5 * 11.0 - 6.5 * 5.0);
    assert_eq!(tin.elevation(3.0, 10.0), Some(5.0));
    assert_eq!(tin.report().waters_ended.len(), 2);
}

#[test]
fn a_river_keeps_its_slope_up_to_the_rim() {
    let mut builder = points(20, |_| true);
    let bank = |y: f64| {
        [
            [-20.0, y, 4.0],
            [0.0, y, 3.0],
            [20.0, y, 2.0],
            [40.0, y, 1.0],
        ]
    };
    builder.add_river(River::between(&bank(10.5), &bank(8.5)).unwrap());
    let tin = builder.build().unwrap();
    assert_near(areas(&tin)[0], 19.0 * 19.0);
    for (x, z) in [(0.0, 3.0), (10.0, 2.5), (19.0, 2.05)] {
        for y in [8.5, 9.0, 10.5] {
            assert_near(tin.elevation(x, y).unwrap(), z);
        }
    }
    assert_eq!(tin.elevation(-1.0, 9.0), None);
    assert_eq!(tin.report().waters_ended, [0]);
}

/// A line with heights is ground: water goes as far as it does, but no farther.
#[test]
fn lines_with_heights_extend_the_surface() {
    let mut builder = points(20, |_| true);
    builder.add_breakline(&[
        [19.0, 4.0, 5.0],
        [30.0, 4.0, 6.0],
        [30.0, 15.0, 6.0],
        [19.0, 15.0, 5.0],
    ]);
    let without = builder.clone();
    builder.add_flat(canal());
    builder.max_edge = None;
    let tin = builder.build().unwrap();
    let bare = TinBuilder {
        max_edge: None,
        ..without
    }
    .build()
    .unwrap();
    assert_near(areas(&tin)[0], areas(&bare)[0]);
    assert_eq!(tin.elevation(29.0, 9.0), Some(1.0));
    assert_eq!(tin.elevation(31.0, 9.0), None);
}

#[test]
fn without_points_nothing_is_cut() {
    let mut builder = TinBuilder::default();
    builder.add_flat(canal());
    let tin = builder.build().unwrap();
    assert!(tin.report().waters_ended.is_empty());
    assert_near(areas(&tin)[0], 80.0 * 2.25);
}

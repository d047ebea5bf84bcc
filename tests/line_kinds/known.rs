//! Each kind of line with a known answer, and pairs of kinds that cross.

use breakline::data::{EdgeKind, Surface};
use breakline::terrain::{Flat, FlatHeight, HighSide, River, TinBuilder, Wall};

/// A plateau at 10 with points 1 apart, 20 wide, centered at the origin.
fn plateau() -> TinBuilder {
    let mut builder = TinBuilder::default();
    let [mut x, mut y] = [Vec::new(), Vec::new()];
    for i in -10..=10 {
        for j in -10..=10 {
            x.push(f64::from(i) + 0.01 * f64::from(j));
            y.push(f64::from(j));
        }
    }
    let z = vec![10.0; x.len()];
    builder.add_points(&x, &y, &z);
    builder
}

fn ring(corners: &[[f64; 2]], z: f64) -> Vec<[f64; 3]> {
    corners
        .iter()
        .chain(&corners[..1])
        .map(|p| [p[0], p[1], z])
        .collect()
}

fn lake(half: f64, z: f64) -> Flat {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    Flat::new(&[ring(&corners, z)], FlatHeight::OfShore { tolerance: 0.0 }).unwrap()
}

#[test]
fn a_lake_is_level_and_its_points_are_gone() {
    let mut builder = plateau();
    builder.add_flat(lake(4.5, 7.0));
    let tin = builder.build().unwrap();
    assert_eq!(tin.report().points_replaced, 81);
    for (x, y) in [
        (0.0, 0.0),
        (4.5, 0.0),
        (-4.5, -4.5),
        (3.3, -2.1),
        (0.0, 4.49),
    ] {
        assert_eq!(tin.elevation(x, y), Some(7.0), "{x} {y}");
    }
    assert_eq!(tin.elevation(9.0, 9.0), Some(10.0));
    assert_eq!(tin.report().edges.of(EdgeKind::Shore), 4);
    let mut builder = plateau();
    builder.add_flat(lake(4.5, 7.0).with_buffer(1.0));
    assert_eq!(builder.build().unwrap().report().points_replaced, 81 + 40);
}

#[test]
fn an_island_keeps_its_points() {
    let mut builder = plateau();
    let square = |half: f64| {
        ring(
            &[[-half, -half], [half, -half], [half, half], [-half, half]],
            7.0,
        )
    };
    builder.add_flat(Flat::new(&[square(6.5), square(2.5)], FlatHeight::Lowest).unwrap());
    let tin = builder.build().unwrap();
    assert_eq!(
        (tin.elevation(0.0, 0.0), tin.elevation(4.0, 0.0)),
        (Some(10.0), Some(7.0))
    );
}

#[test]
fn a_breakline_across_a_lake_stays_and_is_level_there() {
    let mut builder = plateau();
    builder.add_flat(lake(4.5, 7.0));
    builder.add_breakline(&[[-9.5, 0.5, 12.0], [0.0, 0.5, 12.0], [9.5, 0.5, 12.0]]);
    let tin = builder.build().unwrap();
    for x in [-4.5, -2.0, 0.0, 4.0, 4.5] {
        assert_eq!(tin.elevation(x, 0.5), Some(7.0), "{x}");
    }
    assert_eq!(
        tin.elevation(-9.0, 0.5).map(|z| (z - 11.5).abs() < 1e-9),
        Some(true)
    );
    assert_eq!(tin.report().edges.of(EdgeKind::Breakline), 4);
    // The lake decides at the shore, so nothing is reported.
    assert_eq!(tin.report().crossing_heights, []);
}

#[test]
fn lakes_of_different_heights_may_not_meet() {
    for (x, is_right) in [(4.0, false), (9.0, false), (9.25, true)] {
        let mut builder = plateau();
        builder.add_flat(lake(4.5, 7.0));
        let corners = [
            [x - 4.5, -1.0],
            [x - 3.5, -1.0],
            [x - 3.5, 1.0],
            [x - 4.5, 1.0],
        ];
        builder.add_flat(Flat::new(&[ring(&corners, 8.0)], FlatHeight::Lowest).unwrap());
        match builder.build() {
            Ok(_) => assert!(is_right, "{x}"),
            Err(error) => {
                assert!(!is_right, "{x}: {error}");
                let text = error.to_string();
                assert!(
                    text.starts_with("two lakes meet at ") && text.contains("7 of breakline 0"),
                    "{text}"
                );
            }
        }
    }
}

#[test]
fn a_wall_is_steep_and_its_sides_are_as_high_as_the_ground() {
    let mut builder = plateau();
    let upper = [[-8.5, 0.5, 14.0], [8.5, 0.5, 14.0]];
    builder.add_wall(&Wall::new(&upper, &[10.0; 2], 0.01, HighSide::Left).unwrap());
    builder.add_points(&[0.0], &[0.495], &[99.0]); // between the edges
    let tin = builder.build().unwrap();
    assert_eq!(tin.report().points_replaced, 1);
    assert_eq!(
        (tin.elevation(0.0, 0.5), tin.elevation(0.0, 0.49)),
        (Some(14.0), Some(10.0))
    );
    assert_eq!(tin.report().edges.of(EdgeKind::Wall), 2);
}

#[test]
fn a_river_falls_evenly_and_is_level_across() {
    let mut builder = plateau();
    let (left, right) = (
        [[-8.5, 2.5, 9.0], [8.5, 2.5, 5.0]],
        [[8.5, -2.5, 5.0], [-8.5, -2.5, 9.5]],
    );
    builder.add_river(River::between(&left, &right).unwrap());
    builder.add_breakline(&[[0.0, -9.0, 20.0], [0.0, 9.0, 20.0]]); // a bridge
    let tin = builder.build().unwrap();
    for x in [-8.5, -4.0, 0.0, 1.5, 8.5] {
        let expected = 7.0 - 4.0 / 17.0 * x;
        for y in [-2.5, -1.0, 0.0, 2.5] {
            let found = tin.elevation(x, y).unwrap();
            assert!(
                (found - expected).abs() < 1e-9,
                "{x} {y}: {found}, expected {expected}"
            );
        }
    }
    assert_eq!(tin.elevation(0.0, 9.0), Some(20.0));
    assert_eq!(tin.report().points_replaced, 5 * 17);
}

/// Where a line crosses a bank at a slant, rounding puts the vertex beside the water; its height is
/// that of the bank there.
#[test]
fn lines_that_cross_a_river_have_the_height_of_its_banks_there() {
    let mut builder = TinBuilder::default();
    builder.add_points(&[0.0, 60.0, 0.0, 60.0], &[0.0, 0.0, 60.0, 60.0], &[25.0; 4]);
    let banks = [
        [[5.0, 30.0, 20.0], [55.0, 35.0, 10.0]],
        [[5.0, 26.0, 20.0], [55.0, 31.0, 10.0]],
    ];
    builder.add_river(River::between(&banks[0], &banks[1]).unwrap());
    builder.add_breakline(&[[28.0, 20.0, 30.0], [35.0, 40.0, 30.0]]);
    let tin = builder.build().unwrap();
    let crossings: Vec<[f64; 3]> = (0..tin.vertex_count() as u32)
        .map(|vertex| tin.position(vertex))
        .filter(|[x, _, _]| *x > 28.0 && *x < 35.0)
        .collect();
    assert_eq!(crossings.len(), 2);
    for [x, y, z] in crossings {
        let expected = 20.0 - (x - 5.0) / 5.0;
        assert!(
            (z - expected).abs() < 1e-9,
            "the vertex at {x} {y} is at {z}, expected {expected}"
        );
    }
}

#[test]
fn holes_are_left_out_with_their_islands_kept() {
    let mut builder = plateau();
    let square = |half: f64| {
        vec![
            [-half, -half],
            [half, -half],
            [half, half],
            [-half, half],
            [-half, -half],
        ]
    };
    builder.add_hole(&[square(4.25), square(1.25)]);
    let tin = builder.build().unwrap();
    assert_eq!(
        (tin.elevation(0.0, 0.0), tin.elevation(2.0, 0.0)),
        (Some(10.0), None)
    );
    assert_eq!(
        (tin.elevation(6.0, 0.0), tin.elevation(4.25, 0.0)),
        (Some(10.0), Some(10.0))
    );
}

#[test]
fn a_draped_line_has_a_vertex_wherever_it_crosses_an_edge() {
    let mut builder = TinBuilder::default();
    builder.add_points(
        &[0.0, 4.0, 4.0, 0.0, 2.0],
        &[0.0, 0.0, 4.0, 4.0, 2.0],
        &[0.0, 0.0, 0.0, 0.0, 6.0],
    );
    let plain = builder.clone().build().unwrap();
    builder.add_draped_line(&[[0.5, 1.0], [3.5, 1.0]]);
    let tin = builder.build().unwrap();
    // It crosses two edges between its ends.
    assert_eq!(tin.report().edges.of(EdgeKind::Draped), 3);
    assert_eq!(
        (tin.report().vertices_cut, tin.report().faces_clipped),
        (4, 0)
    );
    for k in 0..=40 {
        for j in 0..=40 {
            let [x, y] = [f64::from(k) / 10.0, f64::from(j) / 10.0];
            let [before, after] = [&plain, &tin].map(|tin| tin.elevation(x, y).unwrap());
            assert!((before - after).abs() < 1e-12, "{x} {y}: {before} {after}");
        }
    }
}

#[test]
fn long_edges_leave_holes_but_not_in_water() {
    let mut builder = plateau();
    builder.add_flat(lake(4.5, 7.0));
    builder.add_points(&[60.0], &[0.0], &[0.0]);
    builder.max_edge_inside = Some(2.0);
    let tin = builder.build().unwrap();
    assert_eq!(
        (tin.elevation(0.0, 0.0), tin.elevation(30.0, 0.0)),
        (Some(7.0), None)
    );
    assert!(tin.report().faces_with_long_edges > 0);
}

/// Where two kinds cross, the first of them has its height at the crossing.
#[test]
fn the_kind_that_comes_first_decides_where_two_cross() {
    let [west, east, south, north] = [[-6.5, 0.5], [6.5, 0.5], [0.5, -6.5], [0.5, 6.5]];
    let at = |p: [f64; 2], z: f64| [p[0], p[1], z];
    // Hard over soft.
    let mut builder = plateau();
    builder.add_soft_line(&[at(west, 1.0), at(east, 1.0)]);
    builder.add_breakline(&[at(south, 30.0), at(north, 30.0)]);
    assert_eq!(builder.build().unwrap().elevation(0.5, 0.5), Some(30.0));
    // The same where the soft line has a vertex.
    let mut builder = plateau();
    builder.add_soft_line(&[at(west, 1.0), [0.5, 0.5, 1.0], at(east, 1.0)]);
    builder.add_breakline(&[at(south, 30.0), at(north, 30.0)]);
    assert_eq!(builder.build().unwrap().elevation(0.5, 0.5), Some(30.0));
    // A wall over a breakline.
    let mut builder = plateau();
    builder.add_breakline(&[at(south, 1.0), at(north, 1.0)]);
    builder.add_wall(
        &Wall::new(
            &[at(west, 14.0), at(east, 14.0)],
            &[11.0; 2],
            0.01,
            HighSide::Left,
        )
        .unwrap(),
    );
    assert_eq!(builder.build().unwrap().elevation(0.5, 0.5), Some(14.0));
    // A river over a wall.
    let mut builder = plateau();
    builder.add_river(River::along(&[at(south, 5.0), at(north, 5.0)], 2.0).unwrap());
    builder.add_wall(
        &Wall::new(
            &[at(west, 14.0), at(east, 14.0)],
            &[11.0; 2],
            0.01,
            HighSide::Left,
        )
        .unwrap(),
    );
    assert_eq!(builder.build().unwrap().elevation(0.5, 0.5), Some(5.0));
    // A lake over a river.
    let mut builder = plateau();
    builder.add_river(River::along(&[at(south, 5.0), at(north, 5.0)], 2.0).unwrap());
    builder.add_flat(lake(3.5, 4.0));
    let tin = builder.build().unwrap();
    assert_eq!(
        (tin.elevation(0.5, 0.5), tin.elevation(0.5, 5.0)),
        (Some(4.0), Some(5.0)),
        "it is level up to the step at the shore"
    );
    // A hole over a lake.
    let mut builder = plateau();
    builder.add_flat(lake(3.5, 4.0));
    builder.add_hole(&[vec![
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 2.0],
        [0.0, 2.0],
        [0.0, 0.0],
    ]]);
    let tin = builder.build().unwrap();
    assert_eq!(
        (tin.elevation(0.5, 0.5), tin.elevation(-1.0, 0.5)),
        (None, Some(4.0))
    );
}

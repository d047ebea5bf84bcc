use super::*;
use crate::terrain::lines::river::RiverLowering;
use crate::terrain::{Tin, TinBuilder};
use testkit::random::Random;

/// Flows from west to east, at 10 - x / 5.
fn main_river() -> River {
    River::between(
        &[[0.0, 4.0, 10.0], [20.0, 4.0, 6.0]],
        &[[0.0, 0.0, 10.0], [20.0, 0.0, 6.0]],
    )
    .unwrap()
}

/// From or to the north, between heights at its north and its south, which is at the main river.
fn northern(north: f64, south: f64, y: f64) -> River {
    let bank = |x: f64| [[x, 14.0, north], [x, y, south]];
    River::between(&bank(11.0), &bank(9.0)).unwrap()
}

fn built(rivers: &[River]) -> Tin {
    let mut builder = TinBuilder::default();
    builder.add_points(
        &[-20.0, 60.0, -20.0, 60.0],
        &[-20.0, -20.0, 60.0, 60.0],
        &[40.0; 4],
    );
    for river in rivers {
        builder.add_river(river.clone());
    }
    let tin = builder.build().unwrap();
    assert_eq!(tin.report().water_overlaps, []);
    tin
}

fn are_at(tin: &Tin, expected: &[([f64; 2], f64)]) {
    for ([x, y], z) in expected {
        let found = tin.elevation(*x, *y).unwrap();
        assert!(
            (found - z).abs() < 1e-9,
            "{x} {y} is at {found}, expected {z}"
        );
    }
}

#[test]
fn a_higher_tributary_falls_to_the_main_river() {
    let mut rivers = [main_river(), northern(12.0, 9.0, 4.0)];
    assert_eq!(River::join(&mut rivers, 0.01), []);
    assert_eq!((rivers[0].stations.len(), rivers[1].stations.len()), (4, 2));
    let tin = built(&rivers);
    let main = [
        [9.0, 4.0],
        [10.0, 4.0],
        [11.0, 4.0],
        [9.0, 0.0],
        [4.0, 3.0],
        [15.0, 1.0],
    ];
    are_at(&tin, &main.map(|[x, y]| ([x, y], 10.0 - x / 5.0)));
    are_at(
        &tin,
        &[
            ([9.0, 14.0], 12.0),
            ([10.0, 14.0], 12.0),
            ([9.0, 9.0], (12.0 + 8.2) / 2.0),
        ],
    );
}

#[test]
fn a_lower_tributary_lowers_the_main_river_from_there_on() {
    let mut rivers = [northern(12.0, 7.0, 4.0), main_river()];
    let lowered = River::join(&mut rivers, 0.01);
    assert!(
        matches!(lowered[..], [RiverLowering { river: 1, to: 0, by, from: [9.0, 2.0] }] if (by - 1.2).abs() < 1e-9)
    );
    assert_eq!(rivers[1].heights().rising, 0);
    let tin = built(&rivers);
    are_at(
        &tin,
        &[
            ([0.0, 2.0], 10.0),
            ([4.5, 4.0], 8.5),
            ([9.0, 0.0], 7.0),
            ([10.0, 4.0], 7.0),
            ([11.0, 1.0], 7.0),
        ],
    );
    are_at(
        &tin,
        &[([20.0, 3.0], 6.0), ([10.0, 14.0], 12.0), ([9.0, 9.0], 9.5)],
    );
}

#[test]
fn a_branch_begins_at_the_height_of_the_main_river() {
    // Higher than the main river: lowered. Lower: it falls from there.
    for (own, lowered) in [(9.0, Some(1.2)), (7.0, None)] {
        let mut rivers = [main_river(), northern(5.0, own, 4.0)];
        let found = River::join(&mut rivers, 0.01);
        match lowered {
            Some(by) => {
                assert!(found.len() == 1 && found[0].river == 1 && (found[0].by - by).abs() < 1e-9)
            }
            None => assert_eq!(found, []),
        }
        let tin = built(&rivers);
        are_at(
            &tin,
            &[
                ([9.0, 4.0], 8.2),
                ([10.0, 4.0], 8.0),
                ([11.0, 4.0], 7.8),
                ([10.0, 14.0], 5.0),
                ([9.0, 9.0], 6.6),
            ],
        );
    }
}

#[test]
fn a_shared_vertex_joins_two_rivers() {
    let left = [[0.0, 4.0, 10.0], [10.0, 4.0, 8.0], [20.0, 4.0, 6.0]];
    let main = River::between(&left, &[[0.0, 0.0, 10.0], [20.0, 0.0, 6.0]]).unwrap();
    let tributary = River::between(
        &[[10.0, 14.0, 12.0], [10.0, 4.0, 9.0]],
        &[[7.0, 14.0, 12.0], [7.0, 5.0, 9.0]],
    )
    .unwrap();
    let mut rivers = [tributary, main];
    assert_eq!(River::join(&mut rivers, 0.01), []);
    let tin = built(&rivers);
    are_at(
        &tin,
        &[
            ([10.0, 4.0], 8.0),
            ([7.0, 5.0], 8.0),
            ([8.5, 4.5], 8.0),
            ([10.0, 0.0], 8.0),
            ([8.0, 14.0], 12.0),
        ],
    );
}

/// Coordinates in files are rounded, and banks bend between the ends of a tributary.
#[test]
fn ends_near_a_bent_bank_follow_it() {
    for (bend, y) in [(4.0, 4.004), (4.0, 3.996), (4.5, 4.0), (3.5, 4.0)] {
        let left = [
            [0.0, 4.0, 10.0],
            [9.5, 4.0, 8.1],
            [10.0, bend, 8.0],
            [10.5, 4.0, 7.9],
            [20.0, 4.0, 6.0],
        ];
        let main = River::between(&left, &[[0.0, 0.0, 10.0], [20.0, 0.0, 6.0]]).unwrap();
        let mut rivers = [main, northern(12.0, 9.0, y)];
        River::join(&mut rivers, 0.01);
        assert!(rivers.iter().all(|river| river.overlap().is_none()));
        let tin = built(&rivers);
        for at in [[9.0, y], [9.5, 4.0], [10.0, bend], [10.5, 4.0], [11.0, y]] {
            let station = rivers[0]
                .stations
                .iter()
                .find(|ends| flat(ends[0]) == at)
                .unwrap();
            let found = tin.elevation(at[0], at[1]).unwrap();
            assert!(
                (found - station[0][2]).abs() < 1e-9,
                "{at:?}: {found}, expected {station:?}"
            );
        }
        are_at(&tin, &[([9.0, 14.0], 12.0), ([10.0, 14.0], 12.0)]);
    }
    let mut apart = [main_river(), northern(12.0, 9.0, 4.02)];
    let before = apart.clone();
    River::join(&mut apart, 0.01);
    assert_eq!(apart, before);
}

/// A river ends between the tips of a peninsula that the main river flows around: the peninsula
/// stays land.
#[test]
fn an_end_does_not_follow_the_bank_around_a_meander() {
    let line = |sites: [[f64; 2]; 6]| {
        let heights = [5.5, 5.0, 4.9, 4.8, 4.7, 4.5];
        sites
            .iter()
            .zip(heights)
            .map(|([x, y], z)| [*x, *y, z])
            .collect::<Vec<[f64; 3]>>()
    };
    let inner = line([
        [10.0, 50.0],
        [20.0, 40.0],
        [20.0, 10.0],
        [30.0, 10.0],
        [30.0, 40.0],
        [40.0, 50.0],
    ]);
    let outer = line([
        [5.0, 50.0],
        [15.0, 40.0],
        [15.0, 5.0],
        [35.0, 5.0],
        [35.0, 40.0],
        [45.0, 50.0],
    ]);
    let side = |x: f64| [[x, 55.0, 9.0], [x, 40.0, 8.0]];
    let mut rivers = [
        River::between(&inner, &outer).unwrap(),
        River::between(&side(20.0), &side(30.0)).unwrap(),
    ];
    River::join(&mut rivers, 0.01);
    let mut builder = TinBuilder::default();
    for k in 0..144 {
        builder.add_points(
            &[f64::from(k % 12) * 5.0],
            &[f64::from(k / 12) * 5.0],
            &[25.0],
        );
    }
    for river in &rivers {
        builder.add_river(river.clone());
    }
    let tin = builder.build().unwrap();
    assert_eq!(tin.report().water_overlaps, []);
    are_at(
        &tin,
        &[
            ([25.0, 15.0], 25.0),
            ([25.0, 25.0], 25.0),
            ([25.0, 35.0], 25.0),
        ],
    );
    let corners = rivers[1].stations[1].map(|[x, y, z]| ([x, y], z));
    assert!(
        corners[0].1 > corners[1].1
            && rivers[0]
                .stations
                .iter()
                .any(|ends| ends[0] == rivers[1].stations[1][0])
    );
    are_at(&tin, &[corners[0], corners[1], ([25.0, 55.0], 9.0)]);
}

/// A bank that bulges through the last stretch of a river that ends on both sides of the bulge:
/// both overlap there, and the higher one keeps its heights beside it.
#[test]
fn an_end_does_not_follow_a_bank_through_its_own_stretch() {
    let bank = [
        [5.0, 20.0, 5.0],
        [20.0, 20.0, 5.0],
        [25.0, 28.0, 5.0],
        [30.0, 20.0, 5.0],
        [55.0, 20.0, 5.0],
    ];
    let main = River::between(&bank, &[[5.0, 15.0, 5.0], [55.0, 15.0, 5.0]]).unwrap();
    let northern = River::between(
        &[[22.0, 26.0, 9.0], [20.0, 20.0, 8.0]],
        &[[28.0, 26.0, 9.0], [30.0, 20.0, 8.0]],
    );
    let mut rivers = [main, northern.unwrap()];
    River::join(&mut rivers, 0.01);
    assert!(rivers.iter().all(|river| river.overlap().is_none()));
    let mut builder = TinBuilder::default();
    builder.add_points(&[0.0, 60.0, 0.0, 60.0], &[0.0, 0.0, 60.0, 60.0], &[25.0; 4]);
    for river in &rivers {
        builder.add_river(river.clone());
    }
    let tin = builder.build().unwrap();
    assert_eq!(tin.report().water_overlaps.len(), 1);
    are_at(
        &tin,
        &[
            ([25.0, 25.0], 5.0),
            ([25.0, 27.0], 5.0),
            ([25.5, 20.0], 5.0),
            ([22.0, 26.0], 9.0),
        ],
    );
    are_at(
        &tin,
        &[
            ([22.0, 25.0], 9.0 - 4.0 / 6.0),
            ([29.0, 22.0], 9.0 - 16.0 / 6.0),
        ],
    );
}

/// Ends side by side share corners, but neither river flows into the other.
#[test]
fn ends_side_by_side_are_not_tributaries_of_each_other() {
    let between =
        |left: [[f64; 3]; 2], right: [[f64; 3]; 2]| River::between(&left, &right).unwrap();
    let bank = |x: f64, ends: [f64; 2]| [[x, 14.0, ends[0]], [x, 4.0, ends[1]]];
    let at_the_main_river = |ends: [f64; 2], x: f64| between(bank(x, ends), bank(x + 2.0, ends));
    let mouths = [
        main_river(),
        at_the_main_river([12.0, 4.0], 8.0),
        at_the_main_river([12.0, 9.9], 10.0),
    ];
    let springs = [
        at_the_main_river([12.0, 9.0], 8.0),
        at_the_main_river([6.0, 5.0], 10.0),
    ];
    let beside = |side: f64, level: f64| [[0.0, side, level], [10.0, side, level]];
    let canal = [
        between(beside(4.0, 10.0), beside(2.0, 10.0)),
        between(
            [[0.0, 2.0, 8.0], [10.0, 2.0, 5.0]],
            [[0.0, 0.0, 8.0], [10.0, 0.0, 5.0]],
        ),
    ];
    for (name, expected, mut rivers) in [
        ("mouths", vec![[0, 1]], mouths.to_vec()),
        ("springs", vec![], springs.to_vec()),
        ("canal", vec![], canal.to_vec()),
    ] {
        let before: Vec<f64> = rivers.iter().map(|river| river.levels()[0]).collect();
        let lowered = River::join(&mut rivers, 0.01);
        assert_eq!(
            lowered
                .iter()
                .map(|lowering| [lowering.river, lowering.to])
                .collect::<Vec<_>>(),
            expected,
            "{name}"
        );
        assert_eq!(
            rivers
                .iter()
                .map(|river| river.levels()[0])
                .collect::<Vec<f64>>(),
            before,
            "{name}"
        );
    }
}

/// A river that ends with one corner on each of two rivers: both have its height there.
#[test]
fn an_end_between_two_rivers_is_level() {
    let bent = |xs: [f64; 2], zs: [f64; 3]| {
        let bank = |x: [f64; 2]| [[x[0], 40.0, zs[0]], [x[1], 20.0, zs[1]], [x[0], 0.0, zs[2]]];
        let beyond = |x: f64| if xs[0] < xs[1] { x - 5.0 } else { x + 5.0 };
        River::between(&bank(xs), &bank(xs.map(beyond))).unwrap()
    };
    let side = |x: f64| [[x, 50.0, 12.0], [x, 20.0, 9.0]];
    let northern = River::between(&side(20.0), &side(32.0)).unwrap();
    let [west, east] = [
        bent([10.0, 20.0], [3.5, 3.0, 2.5]),
        bent([42.0, 32.0], [8.0, 7.0, 6.0]),
    ];
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let all = [&northern, &west, &east];
        let mut rivers: Vec<River> = order.map(|k| all[k].clone()).to_vec();
        let [to, river] = [0, 2].map(|k| order.iter().position(|other| *other == k).unwrap());
        let lowered = River::join(&mut rivers, 0.01);
        assert_eq!(
            lowered,
            [RiverLowering {
                river,
                to,
                by: 4.0,
                from: [34.5, 20.0]
            }]
        );
        let tin = built(&rivers);
        are_at(
            &tin,
            &[
                ([20.0, 20.0], 3.0),
                ([26.0, 20.0], 3.0),
                ([32.0, 20.0], 3.0),
                ([37.0, 20.0], 3.0),
            ],
        );
        are_at(
            &tin,
            &[
                ([15.0, 20.0], 3.0),
                ([44.0, 0.0], 3.0),
                ([44.0, 40.0], 8.0),
                ([39.5, 30.0], 5.5),
            ],
        );
        are_at(
            &tin,
            &[
                ([10.0, 40.0], 3.5),
                ([10.0, 0.0], 2.5),
                ([26.0, 50.0], 12.0),
                ([26.0, 35.0], 7.5),
            ],
        );
    }
}

/// Level lines that meet at the last corner: the end is level, and so are they.
#[test]
fn level_lines_that_meet_at_an_end_have_its_height() {
    let line = |left: [f64; 2], right: [f64; 2], z: f64| [left, right].map(|[x, y]| [x, y, z]);
    let stations = vec![
        line([11.0, 14.0], [9.0, 14.0], 12.0),
        line([11.0, 4.0], [8.0, 9.0], 10.0),
        line([11.0, 4.0], [9.0, 4.0], 10.0),
    ];
    let pointed = River::leveled(stations, Vec::new(), [[10.0, 14.0], [10.0, 4.0]]);
    let mut rivers = [main_river(), pointed];
    let lowered = River::join(&mut rivers, 0.01);
    assert!(
        matches!(lowered[..], [RiverLowering { river: 0, to: 1, by, .. }] if (by - 0.4).abs() < 1e-9),
        "{lowered:?}"
    );
    let heights: Vec<[f64; 2]> = rivers[1]
        .stations
        .iter()
        .map(|ends| ends.map(|end| end[2]))
        .collect();
    assert_eq!(heights[1..], [[rivers[0].stations[2][0][2]; 2]; 2]);
    let tin = built(&rivers);
    let low = [
        [11.0, 4.0],
        [10.0, 4.0],
        [9.0, 4.0],
        [9.5, 5.0],
        [8.0, 9.0],
        [9.5, 6.5],
        [9.0, 0.0],
    ];
    are_at(&tin, &low.map(|at| (at, 7.8)));
    are_at(&tin, &[([9.0, 14.0], 12.0), ([0.0, 4.0], 10.0)]);
}

/// Rivers that continue each other have one height where they do.
#[test]
fn a_river_falls_to_the_one_that_continues_it() {
    let reach = |xs: [f64; 2], zs: [f64; 2]| {
        River::along(&[[xs[0], 0.0, zs[0]], [xs[1], 0.0, zs[1]]], 2.0).unwrap()
    };
    let mut rivers = [
        reach([0.0, 10.0], [9.0, 6.0]),
        reach([10.0, 20.0], [4.0, 3.0]),
    ];
    assert_eq!(River::join(&mut rivers, 0.01), []);
    assert_eq!(
        rivers.each_ref().map(River::levels),
        [[9.0, 4.0], [4.0, 3.0]]
    );
}

#[test]
fn level_rivers_are_turned_to_fit() {
    for (level, expected) in [(9.0, [9.0, 8.2]), (6.0, [8.2, 6.0])] {
        for is_drawn_south in [true, false] {
            let mut river = northern(level, level, 4.0);
            if is_drawn_south {
                river.reverse();
            }
            let mut rivers = [river, main_river()];
            assert_eq!(River::join(&mut rivers, 0.01), []);
            let ends = [rivers[0].stations[0], rivers[0].stations[1]]
                .map(|ends| ends.iter().map(|p| p[2]).fold(0.0, f64::max));
            assert_eq!(ends, expected, "{level}");
        }
    }
}

/// A network of random rivers on a grid: any order gives the same, and no water rises.
#[test]
fn the_order_of_rivers_changes_nothing() {
    for seed in 0..200 {
        let mut random = Random(seed);
        let mut rivers = vec![main_river()];
        for _ in 0..4 {
            let x = 1.0 + random.index(17) as f64;
            let mut z = || random.index(12) as f64;
            let bank = |x: f64, ends: [f64; 2]| [[x, 14.0, ends[0]], [x, 4.0, ends[1]]];
            let ends = [z(), z()];
            rivers.push(River::between(&bank(x, ends), &bank(x + 1.0, ends)).unwrap());
        }
        let joined = |order: &[usize]| {
            let mut shuffled: Vec<River> = order.iter().map(|&k| rivers[k].clone()).collect();
            River::join(&mut shuffled, 0.01);
            let mut texts: Vec<String> =
                shuffled.iter().map(|river| format!("{river:?}")).collect();
            texts.sort();
            (texts, shuffled)
        };
        let (expected, found) = joined(&[0, 1, 2, 3, 4]);
        for order in [[4, 3, 2, 1, 0], [2, 4, 0, 1, 3], [1, 0, 3, 4, 2]] {
            assert_eq!(joined(&order).0, expected, "seed {seed}");
        }
        for river in found {
            let heights: Vec<[f64; 2]> = river
                .stations
                .iter()
                .map(|ends| ends.map(|end| end[2]))
                .collect();
            let is_falling =
                |pair: &[[f64; 2]]| pair[0][0].min(pair[0][1]) >= pair[1][0].max(pair[1][1]);
            assert!(
                heights.windows(2).all(is_falling),
                "seed {seed}: {heights:?}"
            );
        }
    }
}

/// A river along a row or a column of a grid, with vertices at some of its nodes, or one with bends
/// that may be so tight that level lines meet.
fn on_grid(random: &mut Random) -> River {
    let size = 6;
    if random.index(3) == 0 {
        let width = 1.0 + random.index(2) as f64;
        let count = 2 + random.index(3);
        let middle: Vec<[f64; 3]> = (0..count)
            .map(|_| [0, 0, 0].map(|_: u8| random.index(size) as f64))
            .collect();
        let river = River::along(&middle, width)
            .ok()
            .filter(|river| river.overlap().is_none());
        return river.unwrap_or_else(|| on_grid(random));
    }
    let start = random.index(size - 1);
    let end = start + 1 + random.index(size - 1 - start);
    let [row, width] = [random.index(size - 1), 1 + random.index(2)];
    let heights = [random.index(4), random.index(4)].map(|z| z as f64);
    let is_column = random.index(2) == 0;
    let mut bank = |across: usize| -> Vec<[f64; 3]> {
        let nodes = (start..=end).filter(|&at| at == start || at == end || random.index(2) == 0);
        let height = |at: usize| {
            heights[0] + (heights[1] - heights[0]) * (at - start) as f64 / (end - start) as f64
        };
        let [x, y] = if is_column { [0, 1] } else { [1, 0] };
        let vertex = |at: usize| {
            let site = [across as f64, at as f64];
            [site[x], site[y], height(at)]
        };
        nodes.map(vertex).collect()
    };
    let banks = [bank(row), bank(row + width)];
    River::between(&banks[0], &banks[1]).unwrap()
}

/// What holds of rivers that were joined.
fn assert_joined(rivers: &[River], name: &str) {
    for (number, river) in rivers.iter().enumerate() {
        let heights: Vec<[f64; 2]> = river
            .stations
            .iter()
            .map(|ends| ends.map(|end| end[2]))
            .collect();
        let is_falling =
            |pair: &[[f64; 2]]| pair[0][0].min(pair[0][1]) >= pair[1][0].max(pair[1][1]);
        assert!(
            heights.windows(2).all(is_falling),
            "{name}: river {number} rises: {heights:?}"
        );
        let inner = &heights[1..heights.len() - 1];
        assert!(
            inner.iter().all(|[left, right]| left == right),
            "{name}: river {number} is not level: {heights:?}"
        );
        for station in 1..river.stations.len() {
            let common = river.meeting_side(station - 1, station);
            let is_one =
                common.is_none_or(|side| heights[station - 1][side] == heights[station][side]);
            assert!(
                is_one,
                "{name}: level lines of river {number} meet at two heights: {heights:?}"
            );
        }
        for end in 0..2 {
            for corner in river.stations[river.station_of_end(end)] {
                for (other, main) in rivers
                    .iter()
                    .enumerate()
                    .filter(|(other, _)| *other != number)
                {
                    let is_corner = |end: usize| {
                        main.stations[main.station_of_end(end)]
                            .iter()
                            .any(|p| flat(*p) == flat(corner))
                    };
                    let is_beside = is_corner(end) && !is_corner(1 - end);
                    for at in main
                        .stations
                        .iter()
                        .flatten()
                        .filter(|at| flat(**at) == flat(corner))
                    {
                        let is_same = is_beside || at[2] == corner[2];
                        assert!(
                            is_same,
                            "{name}: {corner:?} of river {number} is {at:?} of river {other}"
                        );
                    }
                }
            }
        }
    }
}

/// Returns true if banks of a river share a vertex: it overlaps itself there, or nearly.
fn meets_itself(river: &River) -> bool {
    let mut sites: Vec<Key> = river
        .banks()
        .concat()
        .iter()
        .map(|p| key(flat(*p)))
        .collect();
    sites.sort_unstable();
    river.overlap().is_some() || sites.windows(2).any(|pair| pair[0] == pair[1])
}

/// The number of random networks.
fn count() -> u64 {
    std::env::var("BREAKLINE_NETWORKS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(600)
}

/// Rivers on the nodes of a grid share banks, ends and corners in all ways, with equal heights.
#[test]
fn shared_vertices_of_random_networks_have_one_height() {
    let (mut judged, mut lowered) = (0, 0);
    for seed in 0..count() {
        let mut random = Random(seed);
        let rivers: Vec<River> = (0..3 + seed as usize % 4)
            .map(|_| on_grid(&mut random))
            .collect();
        let joined = |order: &mut dyn Iterator<Item = usize>| {
            let mut shuffled: Vec<River> = order.map(|k| rivers[k].clone()).collect();
            let lowered = River::join(&mut shuffled, 0.01).len();
            let mut texts: Vec<String> =
                shuffled.iter().map(|river| format!("{river:?}")).collect();
            texts.sort();
            (texts, lowered, shuffled)
        };
        let (expected, count, found) = joined(&mut (0..rivers.len()));
        lowered += count as u64;
        if found.iter().any(meets_itself) {
            continue;
        }
        assert_joined(&found, &format!("seed {seed}"));
        judged += 1;
        let turned = rivers.len() / 2;
        let orders: [&mut dyn Iterator<Item = usize>; 2] = [
            &mut (0..rivers.len()).rev(),
            &mut (turned..rivers.len()).chain(0..turned),
        ];
        for order in orders {
            let (texts, other, _) = joined(order);
            assert_eq!((texts, other), (expected.clone(), count), "seed {seed}");
        }
    }
    assert!(
        judged * 10 > count() * 9 && lowered * 10 > count(),
        "{judged} {lowered}"
    );
}

/// Tributaries and branches on both sides of a winding river, with ends rounded to millimeters: the
/// surface has the heights of all stations, and no step.
#[test]
fn random_networks_have_no_step() {
    for seed in 0..100 {
        let mut random = Random(seed);
        let mut bend = |y: f64| -> Vec<[f64; 3]> {
            (0..=40)
                .map(|x| {
                    [
                        f64::from(x),
                        y + random.index(100) as f64 / 100.0,
                        20.0 - f64::from(x) / 4.0,
                    ]
                })
                .collect()
        };
        let banks = [bend(10.0), bend(4.0)];
        let mut rivers = vec![River::between(&banks[0], &banks[1]).unwrap()];
        for k in 0..6 {
            let (bank, far) = (&banks[k % 2], [25.0, -11.0][k % 2]);
            let on_bank = |x: f64| {
                let [p, q] = [bank[x as usize], bank[x as usize + 1]];
                let y = p[1] + (x - p[0]) * (q[1] - p[1]);
                if x.fract() == 0.0 {
                    p[1]
                } else {
                    (y * 1000.0).round() / 1000.0
                }
            };
            let west = 1.0 + 6.0 * k as f64 + random.index(8) as f64 / 4.0;
            let east = west + 1.0 + random.index(8) as f64 / 4.0;
            let [north, south] = [0, 0].map(|_: u8| random.index(30) as f64);
            let side = |x: f64| [[x, far, north], [x, on_bank(x), south]];
            rivers.push(River::between(&side(west), &side(east)).unwrap());
        }
        River::join(&mut rivers, 0.01);
        let tin = built(&rivers);
        for (number, river) in rivers.iter().enumerate() {
            assert_eq!(river.overlap(), None, "seed {seed}");
            for [x, y, z] in river.stations.iter().flatten() {
                let found = tin.elevation(*x, *y).unwrap();
                assert!(
                    (found - z).abs() < 1e-9,
                    "seed {seed}: {x} {y} of {number} is at {found}, expected {z}"
                );
            }
            let lines = river.level_lines();
            for line in &lines[usize::from(number > 0)..lines.len() - usize::from(number > 0)] {
                let middle = [0, 1].map(|axis| (line[0][axis] + line[1][axis]) / 2.0);
                let found = tin.elevation(middle[0], middle[1]).unwrap();
                assert!(
                    (found - line[0][2]).abs() < 1e-9,
                    "seed {seed}: {middle:?} of {number} is at {found}"
                );
            }
        }
    }
}

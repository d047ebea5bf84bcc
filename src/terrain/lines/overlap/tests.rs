//! Known answers and a random law: the lower height in overlaps, own heights outside.

use crate::data::{Bounds, Surface, orientation};
use crate::terrain::linear::linear;
use crate::terrain::lines::RiverWater;
use crate::terrain::nearest::squared_distance;
use crate::terrain::{Flat, FlatHeight, River, Tin, TinBuilder};
use crate::triangulation::num::Sign;
use testkit::random::Random;

const STEP: f64 = 1.0 / 1024.0;

fn over_ground(rivers: &[River], side: f64) -> TinBuilder {
    let mut builder = TinBuilder::default();
    builder.step_width = Some(STEP);
    builder.add_points(
        &[-1.0, side, -1.0, side],
        &[-1.0, -1.0, side, side],
        &[30.0; 4],
    );
    for river in rivers {
        builder.add_river(river.clone());
    }
    builder
}

fn along(line: &[[f64; 3]], width: f64) -> River {
    River::along(line, width).unwrap()
}

fn is_at(tin: &Tin, at: [f64; 2], expected: f64) {
    let found = tin.elevation(at[0], at[1]).unwrap();
    assert!(
        (found - expected).abs() < 1e-9,
        "{at:?} is at {found}, expected {expected}"
    );
}

#[test]
fn a_river_over_a_lower_one_has_a_step_at_both_of_its_banks() {
    let rivers = [
        along(&[[0.0, 10.0, 8.0], [20.0, 10.0, 8.0]], 4.0), // higher, from west to east
        along(&[[10.0, 20.0, 6.0], [10.0, 0.0, 4.0]], 2.0),
    ];
    let tin = over_ground(&rivers, 21.0).build().unwrap();
    for (x, y) in [
        (9.0, 10.0),
        (11.0, 10.0),
        (10.0, 12.0),
        (10.0, 8.0),
        (9.5, 11.5),
        (10.0, 15.0),
        (10.25, 10.3),
    ] {
        is_at(&tin, [x, y], 4.0 + y / 10.0);
    }
    for x in [9.0 - STEP, 11.0 + STEP] {
        for y in [8.0, 8.3, 10.0, 12.0] {
            is_at(&tin, [x, y], 8.0);
            is_at(&tin, [20.0 - 1.5 * x, y], 8.0);
        }
    }
    let [overlap] = tin.report().water_overlaps.as_slice() else {
        panic!()
    };
    assert_eq!(overlap.lines, [4, 0]);
    assert!(
        (overlap.step - 3.2).abs() < 1e-9 && overlap.at[1] == 8.0,
        "{overlap:?}"
    );
    assert!([9.0, 11.0].contains(&overlap.at[0]));
}

/// A river that rises so fast from the bank of another one that the step at its own bank is shorter
/// than the line beside that bank is away.
#[test]
fn a_short_step_at_a_bank_leaves_the_bank_level() {
    let length = 800_f64.sqrt();
    // Its eastern bank meets the southern one of the other river there.
    let low = 7.8 - (128_f64.sqrt() + 1.0);
    let rivers = [
        along(&[[0.0, 10.0, 8.0], [20.0, 10.0, 8.0]], 4.0),
        along(&[[20.0, 20.0, low + length], [0.0, 0.0, low]], 2.0),
    ];
    let mut builder = over_ground(&rivers, 21.0);
    builder.step_width = Some(0.5);
    let tin = builder.build().unwrap();
    is_at(&tin, [8.0 + 2_f64.sqrt(), 8.0], 7.8);
    for x in [10.2, 12.0, 15.0, 20.0] {
        is_at(&tin, [x, 8.0], 8.0);
    }
}

/// What a lake covers, or the bounds leave out, is not reported.
#[test]
fn steps_are_reported_where_the_surface_has_them() {
    let rivers = [
        along(&[[0.0, 10.0, 8.0], [20.0, 10.0, 8.0]], 4.0),
        along(&[[10.0, 20.0, 6.0], [10.0, 0.0, 4.0]], 2.0),
    ];
    let step = |builder: TinBuilder| {
        let tin = builder.build().unwrap();
        tin.report()
            .water_overlaps
            .iter()
            .find(|overlap| overlap.lines == [4, 0])
            .map(|overlap| overlap.step)
    };
    let is_about = |step: Option<f64>, expected: f64| {
        assert!((step.unwrap() - expected).abs() < 1e-9, "{step:?}")
    };
    let within = |min: [f64; 2], max: [f64; 2]| {
        let mut builder = over_ground(&rivers, 21.0);
        builder.bounds = Some(Bounds {
            min: [min[0], min[1], -99.0],
            max: [max[0], max[1], 99.0],
        });
        step(builder)
    };
    is_about(within([-1.0, -1.0], [21.0, 21.0]), 3.2);
    is_about(within([5.0, 9.0], [10.0, 20.0]), 3.1);
    assert_eq!(within([0.0, 0.0], [8.0, 20.0]), None);
    let under_lake = |north: f64| {
        let mut builder = over_ground(&rivers, 21.0);
        let shore = [
            [5.0, 5.0],
            [15.0, 5.0],
            [15.0, north],
            [5.0, north],
            [5.0, 5.0],
        ]
        .map(|[x, y]| [x, y, 9.0]);
        builder.add_flat(Flat::new(&[shore.to_vec()], FlatHeight::Lowest).unwrap());
        step(builder)
    };
    is_about(under_lake(10.0), 3.0);
    assert_eq!(under_lake(15.0), None);
}

#[test]
fn where_two_rivers_have_the_same_height_there_is_a_crease() {
    // Both fall across the overlap, and are equal on its diagonal.
    let rivers = [
        along(&[[0.0, 10.0, 20.0], [20.0, 10.0, 0.0]], 4.0),
        along(&[[10.0, 0.0, 20.0], [10.0, 20.0, 0.0]], 4.0),
    ];
    let tin = over_ground(&rivers, 21.0).build().unwrap();
    for i in 0..=16 {
        for j in 0..=16 {
            let [x, y] = [i, j].map(|k| 8.0 + f64::from(k) / 4.0);
            is_at(&tin, [x, y], (20.0 - x).min(20.0 - y));
        }
    }
    for along in [8.0, 9.0, 10.0, 12.0] {
        is_at(&tin, [8.0 - STEP, along], 12.0 + STEP);
        is_at(&tin, [12.0 + STEP, along], 8.0 - STEP);
        is_at(&tin, [along, 8.0 - STEP], 12.0 + STEP);
    }
    // The step grows from nothing at one corner to 4 at the next.
    let [overlap] = tin.report().water_overlaps.as_slice() else {
        panic!()
    };
    assert!((overlap.step - 4.0).abs() < 1e-9, "{overlap:?}");
}

#[test]
fn a_river_given_twice_is_one_river() {
    let river = along(
        &[[0.0, 10.0, 20.0], [10.0, 10.0, 5.0], [20.0, 13.0, 0.0]],
        4.0,
    );
    let once = over_ground(std::slice::from_ref(&river), 21.0)
        .build()
        .unwrap();
    let twice = over_ground(&[river.clone(), river.clone()], 21.0)
        .build()
        .unwrap();
    assert_eq!(twice.report().water_overlaps, []);
    assert_eq!(once.vertex_count(), twice.vertex_count());
    let water = RiverWater::new(&river);
    for k in 0..200 {
        let q = [f64::from(k) / 10.0, 8.5 + f64::from(k % 7) / 3.0];
        if let Some(height) = water.height_within(q) {
            is_at(&twice, q, height);
        }
    }
}

#[test]
fn a_river_through_a_lake_is_level_up_to_its_shore() {
    for height in [3.0, 5.0, 9.0] {
        let mut builder = over_ground(&[along(&[[0.0, 10.0, 5.0], [20.0, 10.0, 5.0]], 4.0)], 21.0);
        let corners = [
            [8.0, 6.0],
            [12.0, 6.0],
            [13.0, 14.0],
            [8.0, 14.0],
            [8.0, 6.0],
        ];
        let shore: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, height]).collect();
        builder.add_flat(Flat::new(&[shore], FlatHeight::Lowest).unwrap());
        let tin = builder.build().unwrap();
        for (x, y) in [(8.0, 10.0), (10.0, 9.0), (12.25, 8.0), (12.75, 12.0)] {
            is_at(&tin, [x, y], height);
        }
        for (x, y) in [
            (8.0 - STEP, 8.0),
            (8.0 - STEP, 12.0),
            (7.5, 9.0),
            (12.26, 8.0),
            (12.76, 12.0),
            (19.0, 10.0),
        ] {
            is_at(&tin, [x, y], 5.0);
        }
        let steps: Vec<f64> = tin
            .report()
            .water_overlaps
            .iter()
            .map(|overlap| overlap.step)
            .collect();
        assert_eq!(
            steps,
            if height == 5.0 {
                vec![]
            } else {
                vec![(height - 5.0_f64).abs()]
            }
        );
    }
}

/// One common vertex: the higher river is level but for the step around it.
#[test]
fn rivers_that_share_a_vertex_keep_their_heights() {
    let level = |bank: &[[f64; 2]], z: f64| {
        bank.iter()
            .map(|[x, y]| [*x, *y, z])
            .collect::<Vec<[f64; 3]>>()
    };
    let between = |left: &[[f64; 2]], right: &[[f64; 2]], z| {
        River::between(&level(left, z), &level(right, z)).unwrap()
    };
    let rivers = [
        between(
            &[[0.0, 14.0], [20.0, 14.0]],
            &[[0.0, 10.0], [10.0, 10.0], [20.0, 10.0]],
            10.0,
        ),
        between(
            &[[0.0, 5.0], [10.0, 10.0], [20.0, 5.0]],
            &[[0.0, 1.0], [10.0, 6.0], [20.0, 1.0]],
            5.0,
        ),
    ];
    for order in [[0, 1], [1, 0]] {
        let tin = over_ground(&order.map(|k| rivers[k].clone()), 21.0)
            .build()
            .unwrap();
        is_at(&tin, [10.0, 10.0], 5.0);
        for x in [0.0, 2.0, 8.0, 9.99, 10.01, 14.0, 20.0] {
            is_at(&tin, [x, 10.0], 10.0);
            is_at(&tin, [x, 12.0], 10.0);
        }
        for (x, y) in [(10.0, 10.0 + STEP), (10.0, 11.0), (10.0, 14.0)] {
            is_at(&tin, [x, y], 10.0);
        }
        for (x, y) in [(10.0, 8.0), (5.0, 5.5), (20.0, 3.0)] {
            is_at(&tin, [x, y], 5.0);
        }
        let [overlap] = tin.report().water_overlaps.as_slice() else {
            panic!()
        };
        assert!(
            overlap.step == 5.0 && overlap.at.iter().all(|c| (c - 10.0).abs() < 4.0 * STEP),
            "{overlap:?}"
        );
    }
}

/// A canal beside a river that falls: they share a bank, and are equally high in its middle.
#[test]
fn rivers_that_share_a_bank_keep_their_heights() {
    let bank = |y: f64, ends: [f64; 2]| [[0.0, y, ends[0]], [20.0, y, ends[1]]];
    let canal = River::between(
        &[[4.0, 12.0, 5.0], [16.0, 12.0, 5.0]],
        &[[4.0, 10.0, 5.0], [16.0, 10.0, 5.0]],
    )
    .unwrap();
    let river = River::between(&bank(10.0, [10.0, 0.0]), &bank(6.0, [10.0, 0.0])).unwrap();
    for rivers in [[canal.clone(), river.clone()], [river, canal]] {
        let tin = over_ground(&rivers, 21.0).build().unwrap();
        for k in 0..=20 {
            let x = f64::from(k);
            let own = 10.0 - x / 2.0;
            is_at(&tin, [x, 6.0], own);
            is_at(&tin, [x, 10.0 - STEP], own);
            is_at(&tin, [x, 8.0], own);
            if (4..=16).contains(&k) {
                is_at(&tin, [x, 10.0], own.min(5.0));
                is_at(&tin, [x, 10.0 + STEP], 5.0);
                is_at(&tin, [x, 11.0], 5.0);
            }
        }
        let [overlap] = tin.report().water_overlaps.as_slice() else {
            panic!()
        };
        assert!((overlap.step - 3.0).abs() < 1e-9, "{overlap:?}");
    }
}

/// A river falls to a lower one that continues it within its last stretch, without a step.
#[test]
fn a_river_falls_to_the_one_that_continues_it() {
    let rivers = [([0.0, 10.0], 10.0), ([10.0, 20.0], 5.0)].map(|([from, to], z)| {
        let bank = |y: f64| [[from, y, z], [to, y, z]];
        River::between(&bank(12.0), &bank(8.0)).unwrap()
    });
    let tin = over_ground(&rivers, 21.0).build().unwrap();
    for (x, z) in [(0.0, 10.0), (5.0, 7.5), (10.0, 5.0), (15.0, 5.0)] {
        is_at(&tin, [x, 8.0], z);
        is_at(&tin, [x, 12.0], z);
    }
    assert_eq!(tin.report().water_overlaps, []);
}

/// A lake that touches a bank, in a vertex or along it.
#[test]
fn a_river_beside_a_lake_is_level() {
    for top in [vec![[10.0, 10.0]], vec![[8.0, 10.0], [12.0, 10.0]]] {
        for height in [3.0, 9.0] {
            let mut builder =
                over_ground(&[along(&[[0.0, 12.0, 5.0], [20.0, 12.0, 5.0]], 4.0)], 21.0);
            let ring = [[8.0, 6.0]]
                .into_iter()
                .chain(top.iter().copied())
                .chain([[12.0, 6.0], [8.0, 6.0]]);
            let shore: Vec<[f64; 3]> = ring.map(|[x, y]| [x, y, height]).collect();
            builder.add_flat(Flat::new(&[shore], FlatHeight::Lowest).unwrap());
            let tin = builder.build().unwrap();
            top.iter().for_each(|at| is_at(&tin, *at, height));
            is_at(&tin, [10.0, 8.0], height);
            for x in [0.0, 4.0, 7.9, 12.1, 16.0, 20.0] {
                is_at(&tin, [x, 10.0], 5.0);
            }
            for (x, y) in [
                (10.0, 10.0 + STEP),
                (8.0, 10.0 + STEP),
                (10.0, 12.0),
                (5.0, 13.0),
            ] {
                is_at(&tin, [x, y], 5.0);
            }
            let [overlap] = tin.report().water_overlaps.as_slice() else {
                panic!()
            };
            assert_eq!(overlap.step, (height - 5.0_f64).abs());
        }
    }
}

#[test]
fn coordinates_of_a_country_are_as_good_as_small_ones() {
    let [east, north] = [4_649_000.123, 5_400_000.457];
    let at = |x: f64, y: f64, z: f64| [east + x, north + y, z];
    let rivers = [
        along(&[at(0.0, 10.0, 8.0), at(20.0, 11.0, 8.0)], 4.0),
        along(&[at(10.0, 20.0, 6.0), at(9.0, 0.0, 4.0)], 2.0),
    ];
    let mut builder = TinBuilder::default();
    builder.add_points(
        &[-1.0, 21.0, -1.0, 21.0].map(|x| east + x),
        &[-1.0, -1.0, 21.0, 21.0].map(|y| north + y),
        &[30.0; 4],
    );
    for river in &rivers {
        builder.add_river(river.clone());
    }
    let tin = builder.build().unwrap();
    let waters = [RiverWater::new(&rivers[0]), RiverWater::new(&rivers[1])];
    let mut judged = 0;
    for k in 0..4000 {
        let q = [
            east + f64::from(k % 61) / 3.0,
            north + f64::from(k / 61) / 3.1,
        ];
        let found = tin.elevation(q[0], q[1]).unwrap();
        let heights = waters.each_ref().map(|water| water.height_within(q));
        let expected = match heights {
            [Some(p), Some(q)] => p.min(q),
            [Some(_), None] if (q[0] - east - 9.5).abs() < 2.0 => continue,
            [Some(p), None] | [None, Some(p)] => p,
            [None, None] => continue,
        };
        judged += 1;
        assert!(
            (found - expected).abs() < 1e-6,
            "{q:?}: {found}, expected {expected}"
        );
    }
    assert!(judged > 500);
}

/// The height in a stretch if it is divided along its other diagonal.
fn other_height(river: &River, q: [f64; 2]) -> Option<f64> {
    let holds = |[a, b, c]: [[f64; 3]; 3]| {
        let q = [q[0], q[1], 0.0];
        let turn = orientation([a, b, c]);
        turn != Sign::Zero
            && [[a, b], [b, c], [c, a]]
                .iter()
                .all(|[p, r]| turn * orientation([*p, *r, q]) != Sign::Negative)
    };
    (0..river.stretch_count()).find_map(|k| {
        let [a, b, c, d] = river.corners(k);
        [[a, b, d], [a, d, c]]
            .into_iter()
            .find(|corners| holds(*corners))
            .map(|corners| linear(corners, q))
    })
}

/// What is wrong with a surface of rivers at a position.
fn flaw(
    tin: &Tin,
    rivers: &[River],
    waters: &[RiverWater],
    q: [f64; 2],
    reach: f64,
) -> Option<String> {
    let inside: Vec<usize> = (0..rivers.len())
        .filter(|&k| waters[k].height_within(q).is_some())
        .collect();
    let [first, ..] = inside.as_slice() else {
        return None;
    };
    let is_beside = |k: &usize| {
        let ring = rivers[*k].ring();
        let sides = ring
            .iter()
            .zip(ring.iter().cycle().skip(1))
            .map(|(p, r)| [*p, *r]);
        sides
            .map(|side| squared_distance(side, q).sqrt())
            .fold(f64::INFINITY, f64::min)
            < reach
    };
    if (0..rivers.len())
        .filter(|k| !inside.contains(k))
        .any(|k| is_beside(&k))
    {
        return None;
    }
    let found = tin.elevation(q[0], q[1])?;
    let own = inside
        .iter()
        .filter_map(|&k| waters[k].height_within(q))
        .fold(f64::INFINITY, f64::min);
    let other = if inside.len() == 1 {
        other_height(&rivers[*first], q).unwrap_or(own)
    } else {
        own
    };
    let is_right = own.min(other) - 1e-6 <= found && found <= own.max(other) + 1e-6;
    (!is_right).then(|| format!("{q:?} in {inside:?} is at {found}, expected {own} to {other}"))
}

/// Returns true if two rivers continue each other, or a stretch is not convex.
fn is_special(rivers: &[River]) -> bool {
    let is_concave = |[a, b, c, d]: [[f64; 3]; 4]| {
        [[a, b, c], [b, d, c], [a, b, d], [a, d, c]]
            .map(orientation)
            .windows(2)
            .any(|pair| pair[0] != pair[1])
    };
    let corners = |river: &River| {
        (0..river.stretch_count())
            .flat_map(|k| river.corners(k))
            .collect::<Vec<_>>()
    };
    let goes_on = |p: &River, q: &River| {
        corners(p)
            .into_iter()
            .any(|[x, y, _]| p.goes_on_at(q, [x, y], 1e-9))
    };
    (0..rivers.len()).any(|i| (0..rivers.len()).any(|j| i != j && goes_on(&rivers[i], &rivers[j])))
        || rivers
            .iter()
            .any(|river| (0..river.stretch_count()).any(|k| is_concave(river.corners(k))))
}

/// The number of random sets of rivers.
fn count() -> u64 {
    std::env::var("BREAKLINE_OVERLAPS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(150)
}

#[test]
fn random_rivers_keep_their_heights() {
    let mut judged = 0;
    let mut wrong: Vec<String> = Vec::new();
    for seed in 0..count() {
        let mut random = Random(seed);
        let mut line = |count: usize| -> Vec<[f64; 3]> {
            (0..count)
                .map(|_| {
                    [
                        random.index(13) as f64,
                        random.index(13) as f64,
                        random.index(9) as f64,
                    ]
                })
                .collect()
        };
        let lines: Vec<Vec<[f64; 3]>> = (0..2 + seed as usize % 3)
            .map(|k| line(2 + k % 2))
            .collect();
        let rivers: Vec<River> = lines
            .iter()
            .filter_map(|line| River::along(line, 1.0 + (seed % 2) as f64).ok())
            .collect();
        if rivers.len() < 2
            || rivers.iter().any(|river| river.overlap().is_some())
            || is_special(&rivers)
        {
            continue;
        }
        let tin = over_ground(&rivers, 14.0).build().unwrap();
        let waters: Vec<RiverWater> = rivers.iter().map(RiverWater::new).collect();
        let vertices = (0..tin.vertex_count() as u32)
            .map(|vertex| tin.position(vertex))
            .map(|[x, y, _]| [x, y]);
        let cells =
            (0..50 * 50).map(|k| [f64::from(k % 50), f64::from(k / 50)].map(|c| c / 4.0 + 0.0625));
        let flaws = vertices
            .chain(cells)
            .filter_map(|q| flaw(&tin, &rivers, &waters, q, STEP * 1.001));
        judged += 1;
        if let Some(first) = flaws.into_iter().next() {
            wrong.push(format!("seed {seed}: {first}\n{lines:?}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "{} of {judged} are wrong:\n{}",
        wrong.len(),
        wrong[..wrong.len().min(5)].join("\n")
    );
    assert!(judged * 3 > count(), "{judged}");
}

/// The end of one river lies on the bank of another one, but for rounding.
#[test]
fn banks_that_lie_on_each_other_but_for_rounding() {
    let first = River::between(
        &[
            [
                500_050.511_889_232_56,
                4_649_047.030_852_309,
                1.981_398_213_408_643_2,
            ],
            [
                500_059.125_222_565_84,
                4_649_040.570_852_309,
                6.443_756_487_245_595,
            ],
            [
                500_067.738_555_899_2,
                4_649_034.110_852_309_3,
                8.313_709_754_423_392,
            ],
            [
                500_076.351_889_232_5,
                4_649_027.650_852_31,
                10.598_349_427_720_986,
            ],
        ],
        &[
            [
                500_055.120_110_767_5,
                4_649_053.175_147_69,
                1.981_398_213_408_643_2,
            ],
            [
                500_063.733_444_100_8,
                4_649_046.715_147_69,
                7.223_009_567_088_99,
            ],
            [
                500_072.346_777_434_17,
                4_649_040.255_147_69,
                9.198_332_581_431_226,
            ],
            [
                500_080.960_110_767_5,
                4_649_033.795_147_69,
                11.466_015_909_989_542,
            ],
        ],
    );
    let second = River::between(
        &[
            [
                500_035.448_302_512_4,
                4_649_067.929_003_881,
                4.951_677_551_326_881,
            ],
            [
                500_046.755_858_328_37,
                4_649_059.448_337_019,
                10.239_129_848_144_394,
            ],
            [
                500_059.331_597_902_06,
                4_649_050.016_532_339,
                11.954_496_005_740_031,
            ],
            [
                500_059.928_302_512_45,
                4_649_049.569_003_881,
                12.828_282_524_565_427,
            ],
        ],
        &[
            [
                500_030.840_080_977_5,
                4_649_061.784_708_501,
                4.951_677_551_326_881,
            ],
            [
                500_042.147_636_793_44,
                4_649_053.304_041_639,
                10.037_637_382_773_653,
            ],
            [
                500_054.723_376_367_1,
                4_649_043.872_236_959,
                11.734_034_139_207_354,
            ],
            [
                500_055.320_080_977_46,
                4_649_043.424_708_501,
                12.765_317_731_300_657,
            ],
        ],
    );
    let mut builder = TinBuilder::default();
    let corner = |x: f64, y: f64| [500_000.0 + x, 4_649_000.0 + y];
    for [x, y] in [
        corner(0.0, 0.0),
        corner(120.0, 0.0),
        corner(0.0, 120.0),
        corner(120.0, 120.0),
    ] {
        builder.add_points(&[x], &[y], &[30.0]);
    }
    builder.add_river(first.unwrap());
    builder.add_river(second.unwrap());
    let tin = builder.build().unwrap();
    is_at(
        &tin,
        [500_050.511_889_232_56, 4_649_047.030_852_309],
        1.981_398_213_408_643_2,
    );
}

use std::collections::BTreeMap;

use testkit::random::Random;

use super::*;
use crate::data::PointFlags;

/// A cloud of whole coordinates, many of which are equal, with all columns and records.
fn cloud(count: usize, side: u64, seed: u64) -> PointBatch {
    let mut random = Random(seed);
    let mut batch = PointBatch::default();
    for i in 0..count {
        let mut coordinate = || random.below(side) as f64 - side as f64 / 2.0;
        batch.x.push(coordinate());
        batch.y.push(coordinate());
        batch.z.push((random.below(5)) as f64);
        batch.class.push(i as u8);
        batch.flags.push(PointFlags(i as u8 / 2));
        batch.return_number.push(i as u8 / 3);
        batch.return_count.push(i as u8 / 5);
        batch.records.extend((i as u64).to_le_bytes());
    }
    batch
}

fn part(batch: &PointBatch, keep: impl Fn(usize) -> bool) -> PointBatch {
    let mut part = batch.clone();
    part.retain(&(0..batch.len()).map(keep).collect::<Vec<_>>());
    part
}

/// The points of a range.
fn stretch(batch: &PointBatch, range: std::ops::Range<usize>) -> PointBatch {
    PointBatch {
        x: batch.x[range.clone()].to_vec(),
        y: batch.y[range.clone()].to_vec(),
        z: batch.z[range.clone()].to_vec(),
        class: batch.class[range.clone()].to_vec(),
        flags: batch.flags[range.clone()].to_vec(),
        return_number: batch.return_number[range.clone()].to_vec(),
        return_count: batch.return_count[range.clone()].to_vec(),
        records: batch.records[range.start * 8..range.end * 8].to_vec(),
    }
}

/// The numbers of the points that are kept, by their records, of a cloud in batches of two sources.
fn kept_by(mut thinner: Thinner, all: &PointBatch) -> Vec<usize> {
    let half = all.len() / 2;
    let number = |record: &[u8]| u64::from_le_bytes(record.try_into().unwrap()) as usize;
    let numbers =
        |batch: &PointBatch| -> Vec<usize> { batch.records.chunks_exact(8).map(number).collect() };
    let mut kept = Vec::new();
    let mut passes = 0;
    loop {
        for (source, whole) in [0..half, half..all.len()].into_iter().enumerate() {
            for start in whole.clone().step_by(7) {
                let mut batch = stretch(all, start..whole.end.min(start + 7));
                thinner.choose(source, &mut batch).unwrap();
                kept.extend(numbers(&batch));
            }
        }
        passes += 1;
        if thinner.end_pass() {
            break;
        }
        assert!(passes < 1000);
    }
    for (source, batch) in thinner.held() {
        let found = numbers(&batch);
        assert!(found.iter().all(|&i| (i >= half) == (source == 1)));
        let again = part(all, |i| found.contains(&i));
        assert_eq!((&batch.x, &batch.class), (&again.x, &again.class));
        assert_eq!((&batch.z, &batch.flags), (&again.z, &again.flags));
        assert_eq!(batch.return_number, again.return_number);
        assert_eq!(batch.return_count, again.return_count);
        kept.extend(found);
    }
    assert!(kept.is_sorted(), "not in order: {kept:?}");
    kept
}

fn kept(thinning: Thinning, all: &PointBatch) -> Vec<usize> {
    kept_by(Thinner::new(thinning, Passes::One).unwrap(), all)
}

fn with_limit(distance: f64, seed: u64, limit: Option<usize>) -> Thinner {
    Thinner(Chooser::Spaced(Spaced::new(distance, seed, limit)))
}

/// Positions and heights of some points, in an order of their own.
fn as_set(all: &PointBatch, some: &[usize]) -> Vec<[i64; 3]> {
    let whole = |&i: &usize| point(all, i).map(|coordinate| coordinate as i64);
    let mut set: Vec<_> = some.iter().map(whole).collect();
    set.sort_unstable();
    set
}

/// The same cloud in another order.
fn shuffled(all: &PointBatch, seed: u64) -> PointBatch {
    let mut order: Vec<usize> = (0..all.len()).collect();
    Random(seed).shuffle(&mut order);
    let pick = |column: &[f64]| order.iter().map(|&i| column[i]).collect();
    let mut other = all.clone();
    (other.x, other.y, other.z) = (pick(&all.x), pick(&all.y), pick(&all.z));
    other
}

#[test]
fn a_cell_keeps_its_best_point() {
    for seed in 0..40 {
        let all = cloud(300, 24, seed);
        for (keep, size) in [
            (CellPoint::Center, 4.0),
            (CellPoint::Lowest, 5.0),
            (CellPoint::Highest, 3.0),
            (CellPoint::Center, 0.5),
            (CellPoint::Lowest, 1e6),
        ] {
            let mut best: BTreeMap<[i64; 2], (i64, [i64; 3], usize)> = BTreeMap::new();
            for i in 0..all.len() {
                let [x, y, z] = point(&all, i);
                let cell = [x, y].map(|axis| (axis / size).floor() as i64);
                // Distances in quarters are whole.
                let off =
                    [0, 1].map(|k| (4.0 * ([x, y][k] - (cell[k] as f64 + 0.5) * size)) as i64);
                let first = match keep {
                    CellPoint::Lowest => z as i64,
                    CellPoint::Highest => -z as i64,
                    CellPoint::Center => off[0] * off[0] + off[1] * off[1],
                };
                let key = (first, [x, y, z].map(|axis| axis as i64), i);
                let slot = best.entry(cell).or_insert(key);
                *slot = (*slot).min(key);
            }
            let mut expected: Vec<usize> = best.values().map(|best| best.2).collect();
            expected.sort_unstable();
            let thinning = Thinning::Grid { size, keep };
            assert_eq!(kept(thinning, &all), expected, "{seed} {thinning:?}");
        }
    }
}

#[test]
fn points_with_a_distance_keep_it_and_cover_all_others() {
    for seed in 0..60 {
        let all = cloud(250, 30, seed);
        let distance = [1.0, 2.0, 3.5, 5.0, 100.0][seed as usize % 5];
        let kept_points = kept(Thinning::Poisson { distance, seed }, &all);
        let apart = |i: usize, j: usize| {
            let [x, y] = [all.x[i] - all.x[j], all.y[i] - all.y[j]];
            x * x + y * y >= distance * distance
        };
        for (n, &i) in kept_points.iter().enumerate() {
            assert!(kept_points[..n].iter().all(|&j| apart(i, j)), "{seed}");
        }
        for i in (0..all.len()).filter(|i| !kept_points.contains(i)) {
            assert!(!kept_points.iter().all(|&j| apart(i, j)), "{seed} {i}");
        }
        // The greedy choice, without cells.
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by_key(|&i| (hash(point(&all, i), seed), i));
        let mut greedy: Vec<usize> = Vec::new();
        for i in order {
            if greedy.iter().all(|&j| apart(i, j)) {
                greedy.push(i);
            }
        }
        greedy.sort_unstable();
        assert_eq!(kept_points, greedy);
        // In several passes, with few candidates at once.
        for limit in [1, 3, 20] {
            let limited = kept_by(with_limit(distance, seed, Some(limit)), &all);
            assert_eq!(limited, kept_points, "{seed} {limit}");
        }
    }
}

#[test]
fn many_points_of_one_position_do_not_end_the_search() {
    let mut all = cloud(400, 30, 1);
    for i in 0..300 {
        (all.x[i], all.y[i], all.z[i]) = (3.0, 4.0, 5.0);
    }
    let expected = kept_by(with_limit(2.0, 0, None), &all);
    assert_eq!(kept_by(with_limit(2.0, 0, Some(2)), &all), expected);
    let zeros = |x: f64| PointBatch {
        x: vec![x, 0.0],
        y: vec![0.0, x],
        z: vec![x, x],
        ..PointBatch::default()
    };
    let of = |batch: &PointBatch| [0, 1].map(|i| hash(point(batch, i), 7));
    assert_eq!(of(&zeros(0.0)), of(&zeros(-0.0)));
}

#[test]
fn the_order_of_points_does_not_show() {
    for seed in 0..20 {
        let all = cloud(300, 40, seed);
        let other = shuffled(&all, seed + 1);
        for thinning in [
            Thinning::Grid {
                size: 4.0,
                keep: CellPoint::Center,
            },
            Thinning::Grid {
                size: 4.0,
                keep: CellPoint::Highest,
            },
            Thinning::Poisson {
                distance: 3.0,
                seed,
            },
            Thinning::Random { share: 0.4, seed },
        ] {
            let [one, two] = [&all, &other].map(|cloud| as_set(cloud, &kept(thinning, cloud)));
            assert_eq!(one, two, "{thinning:?}");
        }
    }
}

#[test]
fn seeds_choose_differently() {
    let all = cloud(300, 1000, 5);
    for rule in ["poisson:90", "random:0.5"] {
        let rule = Thinning::parse(rule).unwrap();
        let [zero, same, other] =
            [None, Some(0), Some(1)].map(|seed| kept(rule.with(None, seed).unwrap(), &all));
        assert_eq!(zero, same);
        assert_ne!(zero, other);
    }
}

#[test]
fn a_share_is_part_of_a_larger_one() {
    let all = cloud(20_000, 1 << 40, 3);
    let kept = |share| kept(Thinning::Random { share, seed: 11 }, &all);
    let shares = [0.001, 0.1, 0.2, 0.7];
    let found = shares.map(kept);
    for (some, more) in found.iter().zip(&found[1..]) {
        assert!(some.iter().all(|i| more.binary_search(i).is_ok()));
    }
    for (share, some) in shares.iter().zip(&found) {
        let expected = share * all.len() as f64;
        // Five standard deviations.
        let most = 5.0 * (expected * (1.0 - share)).sqrt();
        assert!(
            (some.len() as f64 - expected).abs() < most,
            "{share} {}",
            some.len()
        );
    }
    assert_eq!(kept(1.0).len(), all.len());
}

#[test]
fn every_nth_is_counted_over_batches_and_sources() {
    let all = cloud(100, 30, 2);
    for step in [1, 2, 7, 13, 100, u64::MAX] {
        let expected: Vec<usize> = (0..100)
            .filter(|&i| (i as u64).is_multiple_of(step))
            .collect();
        assert_eq!(kept(Thinning::Nth(step), &all), expected);
    }
}

#[test]
fn numbers_that_make_no_sense_are_refused() {
    for (text, part) in [
        ("", "is no thinning"),
        ("grid", "is no thinning"),
        ("grid:", "`` is not a number"),
        ("grid:0", "the size of a cell is 0"),
        ("grid:-1", "the size of a cell is -1"),
        ("grid:nan", "the size of a cell is NaN"),
        ("grid:inf", "the size of a cell is inf"),
        ("poisson:0", "the distance is 0"),
        ("poisson:1m", "`1m` is not a number"),
        ("nth:0", "every 0th point"),
        ("nth:-3", "`-3` is not a whole number above zero"),
        ("nth:1.5", "`1.5` is not a whole number above zero"),
        ("random:0", "0 is not a share"),
        ("random:1.01", "1.01 is not a share"),
        ("random:-0.5", "-0.5 is not a share"),
        ("random:nan", "NaN is not a share"),
        ("voxel:1", "`voxel:1` is no thinning"),
    ] {
        let error = Thinning::parse(text).unwrap_err();
        assert!(error.contains(part), "{text}: {error}");
    }
    for rule in [
        Thinning::Grid {
            size: f64::NAN,
            keep: CellPoint::Center,
        },
        Thinning::Poisson {
            distance: -1.0,
            seed: 0,
        },
        Thinning::Nth(0),
        Thinning::Random {
            share: 2.0,
            seed: 0,
        },
    ] {
        assert!(Thinner::new(rule, Passes::One).is_err(), "{rule:?}");
    }
    let nth = Thinning::parse(" NTH: 3 ").unwrap();
    assert_eq!(nth, Thinning::Nth(3));
    assert!(nth.with(None, Some(1)).is_err() && nth.with(Some(CellPoint::Lowest), None).is_err());
    assert!(
        Thinning::parse("grid:1")
            .unwrap()
            .with(None, Some(1))
            .is_err()
    );
}

#[test]
fn cells_that_are_too_small_for_the_coordinates_are_an_error() {
    let far = PointBatch {
        x: vec![5e6],
        y: vec![f64::INFINITY],
        z: vec![0.0],
        ..PointBatch::default()
    };
    for (rule, mut batch) in [
        (
            "grid:1e-7",
            PointBatch {
                y: vec![1.0],
                ..far.clone()
            },
        ),
        ("grid:1", far.clone()),
        (
            "poisson:1e-7",
            PointBatch {
                y: vec![1.0],
                ..far.clone()
            },
        ),
    ] {
        let mut thinner = Thinner::new(Thinning::parse(rule).unwrap(), Passes::One).unwrap();
        let error = thinner.choose(0, &mut batch).unwrap_err().to_string();
        assert!(error.contains("is more than 2^40 times"), "{error}");
    }
}

//! Each part against a judge that looks at everything.

use super::super::cut::source_side;
use super::super::fill::filled;
use super::super::graph::Graph;
use super::super::nearest::nearest;
use super::super::openings::{closed, opened};
use super::super::raster::Raster;
use super::Numbers;

fn random_raster(numbers: &mut Numbers, width: usize, height: usize) -> Raster {
    let mut raster = Raster::of(width, height, 0.0);
    for value in &mut raster.values {
        *value = numbers.below(20) as f32;
    }
    raster
}

/// The extreme over a disk, in a raster that goes on beyond its rim as in its outermost cells.
fn naive(
    value: &dyn Fn(isize, isize) -> f32,
    radius: isize,
    column: isize,
    row: isize,
    choose: fn(f32, f32) -> f32,
) -> f32 {
    let around = (-radius..=radius).flat_map(|y| (-radius..=radius).map(move |x| (x, y)));
    around
        .filter(|(x, y)| x * x + y * y <= radius * radius)
        .map(|(x, y)| value(column + x, row + y))
        .reduce(choose)
        .unwrap()
}

#[test]
fn an_opening_is_the_greatest_of_the_least() {
    let mut numbers = Numbers(1);
    for (width, height, radius) in [(1, 1, 1), (7, 5, 1), (9, 30, 3), (150, 70, 2), (20, 20, 6)] {
        let raster = random_raster(&mut numbers, width, height);
        let inside = |column: isize, row: isize| {
            raster.at(
                column.clamp(0, width as isize - 1) as usize,
                row.clamp(0, height as isize - 1) as usize,
            )
        };
        let radius = radius as isize;
        let (opening, closing) = (
            opened(&raster, radius as usize),
            closed(&raster, radius as usize),
        );
        for _ in 0..30 {
            let (column, row) = (numbers.below(width as u32), numbers.below(height as u32));
            let (x, y) = (column as isize, row as isize);
            let eroded = |x, y| naive(&inside, radius, x, y, f32::min);
            let dilated = |x, y| naive(&inside, radius, x, y, f32::max);
            let at = |raster: &Raster| raster.at(column as usize, row as usize);
            assert_eq!(at(&opening), naive(&eroded, radius, x, y, f32::max));
            assert_eq!(at(&closing), naive(&dilated, radius, x, y, f32::min));
        }
    }
}

#[test]
fn filling_keeps_what_is_known_and_stays_between_its_bounds() {
    let mut numbers = Numbers(2);
    for (width, height) in [(1, 1), (2, 9), (3, 3), (40, 31), (64, 64)] {
        let mut raster = random_raster(&mut numbers, width, height);
        for value in &mut raster.values {
            if numbers.below(3) > 0 {
                *value = f32::NAN;
            }
        }
        raster.values[0] = 7.0;
        let surface = filled(&raster);
        let known = raster.values.iter().filter(|value| !value.is_nan());
        let low = known.clone().copied().fold(f32::INFINITY, f32::min);
        let high = known.copied().fold(f32::NEG_INFINITY, f32::max);
        for (&value, &given) in surface.values.iter().zip(&raster.values) {
            assert!(value >= low && value <= high);
            assert!(given.is_nan() || value == given);
        }
    }
    let empty = Raster::of(5, 4, f32::NAN);
    assert!(filled(&empty).values.iter().all(|&value| value == 0.0));
}

#[test]
fn a_gap_in_a_slope_is_filled_with_the_slope() {
    let mut raster = Raster::of(40, 40, 0.0);
    for row in 0..40 {
        for column in 0..40 {
            let is_gap = (14..26).contains(&row) && (10..22).contains(&column);
            raster.values[row * 40 + column] = match is_gap {
                true => f32::NAN,
                false => column as f32 + 2.0 * row as f32,
            };
        }
    }
    let surface = filled(&raster);
    for row in 14..26 {
        for column in 10..22 {
            let expected = column as f32 + 2.0 * row as f32;
            assert!((surface.at(column, row) - expected).abs() < 0.5);
        }
    }
}

#[test]
fn the_nearest_cell_is_as_near_as_any() {
    let mut numbers = Numbers(3);
    for (width, height) in [(1usize, 1usize), (5, 1), (1, 6), (17, 13), (30, 30)] {
        for share in [2, 5, 40] {
            let mut has: Vec<bool> = (0..width * height)
                .map(|_| numbers.below(share) == 0)
                .collect();
            has[numbers.below((width * height) as u32) as usize] = true;
            let found = nearest(&has, width).unwrap();
            let apart = |a: usize, b: usize| {
                (a % width).abs_diff(b % width).pow(2) + (a / width).abs_diff(b / width).pow(2)
            };
            for (cell, &owner) in found.iter().enumerate() {
                assert!(has[owner as usize]);
                let least = (0..has.len()).filter(|&other| has[other]);
                let least = least.map(|other| apart(cell, other)).min().unwrap();
                assert_eq!(apart(cell, owner as usize), least);
            }
        }
    }
    assert_eq!(nearest(&[false, false], 2), None);
}

#[test]
fn neighbors_share_the_faces_that_are_counted() {
    let mut raster = Raster::of(3, 2, f32::NAN);
    // The first and the last column are the nearest to the middle one in turn.
    raster.values[0] = 1.0;
    raster.values[2] = 2.0;
    let graph = Graph::of(&raster);
    assert_eq!(graph.cells, [0, 2]);
    let [only] = graph.neighbors[..] else {
        panic!("{:?}", graph.neighbors);
    };
    assert_eq!((only.nodes, only.faces), ([0, 1], 2));
}

/// Two nodes, and the capacities each way.
type Link = ([u32; 2], [i32; 2]);

/// The capacity of the arcs from one side to the other.
fn capacity(side: u32, terminals: &[i32], links: &[Link]) -> i64 {
    let is_in = |node: usize| side >> node & 1 == 1;
    let at_terminals =
        terminals
            .iter()
            .enumerate()
            .map(|(node, &capacity)| match (capacity > 0, is_in(node)) {
                (true, false) => i64::from(capacity),
                (false, true) => -i64::from(capacity),
                _ => 0,
            });
    let between = links.iter().map(|(ends, capacities)| {
        let [a, b] = ends.map(|end| is_in(end as usize));
        match (a, b) {
            (true, false) => i64::from(capacities[0]),
            (false, true) => i64::from(capacities[1]),
            _ => 0,
        }
    });
    at_terminals.chain(between).sum()
}

#[test]
fn a_cut_is_the_smallest_of_the_cheapest() {
    let mut numbers = Numbers(4);
    for _ in 0..3000 {
        let count = 1 + numbers.below(8);
        let limit = 1 + numbers.below(6);
        let terminals: Vec<i32> = (0..count)
            .map(|_| numbers.below(2 * limit + 1) as i32 - limit as i32)
            .collect();
        let links: Vec<Link> = (0..numbers.below(3 * count))
            .map(|_| {
                let ends = [numbers.below(count), numbers.below(count)];
                (ends, [0; 2].map(|_| numbers.below(limit) as i32))
            })
            .filter(|([a, b], _)| a != b)
            .collect();
        let all = || (0..1u32 << count).map(|side| (capacity(side, &terminals, &links), side));
        let least = all().map(|(capacity, _)| capacity).min().unwrap();
        // The sides of cheapest cuts are closed under intersection.
        let expected = all()
            .filter(|(capacity, _)| *capacity == least)
            .fold(u32::MAX, |both, (_, side)| both & side);
        let side = |links: &[Link]| {
            let ends = links.iter().map(|(ends, _)| *ends);
            let capacities = links.iter().map(|(_, capacities)| *capacities);
            source_side(&terminals, ends, capacities)
        };
        let found = side(&links);
        let bits = (0..count).map(|node| u32::from(found[node as usize]) << node);
        assert_eq!(bits.sum::<u32>(), expected, "{terminals:?} {links:?}");
        let backwards: Vec<Link> = links.iter().rev().copied().collect();
        assert_eq!(side(&backwards), found);
    }
}

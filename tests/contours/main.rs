//! The laws of contours, on surfaces where levels often meet vertices, edges and faces.

mod judge;
mod map;
mod map_judge;
mod raster;
mod real;
mod real_maps;
mod several_levels;
mod surface;

use breakline::data::{ContourLine, Surface};
use breakline::terrain::{Levels, contours};
use proptest::prelude::*;
use surface::{Faces, any_grid, grid, wheel};

fn draw(surface: &(impl Surface + ?Sized), levels: &[f64]) -> Vec<ContourLine> {
    contours(surface, &Levels::listed(levels).unwrap())
        .unwrap()
        .collect()
}

/// Draws one level and compares it to the judge's.
fn check(surface: &Faces, half_level: i64) -> Vec<ContourLine> {
    let lines = draw(surface, &[half_level as f64 / 2.0]);
    assert_eq!(judge::arcs_of(&lines), judge::arcs(surface, half_level));
    judge::check_lines(surface, half_level, &lines);
    lines
}

/// Digits of `number` to the base 3, as heights -1, 0 and 1.
fn heights<const N: usize>(mut number: u32) -> [i32; N] {
    std::array::from_fn(|_| {
        let digit = number % 3;
        number /= 3;
        digit as i32 - 1
    })
}

#[test]
fn all_small_grids() {
    for number in 0..3_u32.pow(8) {
        for diagonals in 0..8 {
            check(
                &grid(4, &heights::<8>(number), |quad| diagonals >> quad & 1 == 1),
                0,
            );
        }
    }
    for number in 0..3_u32.pow(9) {
        for diagonals in [0, 5, 6, 14] {
            check(
                &grid(3, &heights::<9>(number), |quad| diagonals >> quad & 1 == 1),
                0,
            );
        }
    }
}

/// Every saddle around a vertex on the level, whole and with gaps: one, two, three or four fans.
#[test]
fn all_wheels() {
    for number in 0..3_u32.pow(8) {
        for keep in [0xff, 0x7f, 0x3f, 0x77, 0x5f, 0xdb, 0x55, 0x2d, 0x95] {
            check(&wheel(0, heights::<8>(number), keep), 0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn whole_and_partial_grids((whole, keep) in any_grid()) {
        let part = whole.subset(|face| keep[face]);
        for half_level in -1..8 {
            let all = judge::arcs_of(&check(&whole, half_level));
            let some = judge::arcs_of(&check(&part, half_level));
            // Contours of some faces are those of all, inside these faces and between two of them.
            let expected: Vec<_> = all
                .into_iter()
                .filter(|&arc| judge::faces_at(&whole, arc).iter().all(|&face| keep[face]))
                .collect();
            prop_assert_eq!(some, expected);
        }
    }

    #[test]
    fn numbers_do_not_matter((whole, keep) in any_grid(), order in prop::collection::vec(any::<u32>(), 7..50)) {
        let levels: Vec<f64> = (0..7).map(|i| f64::from(i) / 2.0).collect();
        for surface in [whole.subset(|face| keep[face]), whole] {
            prop_assert_eq!(bits(&draw(&surface, &levels)), bits(&draw(&surface.renumbered(&order), &levels)));
        }
    }

    /// Heights that exceed the level by the last bit give the contours of heights on the level,
    /// except along the edge of the data.
    #[test]
    fn noise_in_the_last_bit_does_not_matter((whole, keep) in any_grid()) {
        let exact = whole.subset(|face| keep[face]);
        for level in 1..4 {
            let mut noisy = exact.clone();
            for p in &mut noisy.vertices {
                let z = if p[2] == f64::from(level) { p[2].next_up() } else { p[2] };
                *p = [p[0] + 512_000.0, p[1] + 5_403_000.0, z];
            }
            let mut lines = draw(&noisy, &[level.into()]);
            for p in lines.iter_mut().flat_map(|line| &mut line.points) {
                // Thirds have lost some of their bits out there.
                *p = [p[0] - 512_000.0, p[1] - 5_403_000.0].map(judge::to_lattice);
            }
            judge::check_lines(&exact, 2 * i64::from(level), &lines);
            let arcs: Vec<_> = judge::arcs_of(&lines)
                .into_iter()
                .filter(|&arc| !judge::is_on_edge_of_data(&exact, arc))
                .collect();
            prop_assert_eq!(arcs, judge::arcs(&exact, 2 * i64::from(level)));
        }
    }

    /// Coordinates and heights off any lattice: points are rounded, and the laws still hold.
    #[test]
    fn numbers_do_not_matter_for_rounded_points(
        (mut surface, _) in any_grid(),
        noise in prop::collection::vec((-0.2..0.2, -0.2..0.2, -0.9..0.9), 36),
        order in prop::collection::vec(any::<u32>(), 7..50),
    ) {
        for (p, (x, y, z)) in surface.vertices.iter_mut().zip(noise) {
            *p = [p[0] + x, p[1] + y + 5_403_000.0, p[2] + z];
        }
        let levels: Vec<f64> = (-10..40).map(|i| f64::from(i) / 10.0).collect();
        let lines = draw(&surface, &levels);
        prop_assert_eq!(bits(&lines), bits(&draw(&surface.renumbered(&order), &levels)));
        prop_assert!(lines.is_sorted_by(|a, b| (a.level, &a.points) < (b.level, &b.points)));
    }
}

fn bits(lines: &[ContourLine]) -> Vec<(u64, Vec<[u64; 2]>)> {
    let bits = |p: &[f64; 2]| p.map(f64::to_bits);
    lines
        .iter()
        .map(|line| (line.level.to_bits(), line.points.iter().map(bits).collect()))
        .collect()
}

/// A cone with its top in the middle; heights fall by one from ring to ring.
fn cone(rings: u32, spokes: u32) -> Faces {
    let mut vertices = vec![[0.0, 0.0, f64::from(rings)]];
    let mut faces = Vec::new();
    let number = |ring: u32, spoke: u32| {
        if ring == 0 {
            0
        } else {
            1 + (ring - 1) * spokes + spoke % spokes
        }
    };
    for ring in 1..=rings {
        for spoke in 0..spokes {
            let angle = std::f64::consts::TAU * f64::from(spoke) / f64::from(spokes);
            let radius = f64::from(ring);
            vertices.push([
                radius * angle.cos(),
                radius * angle.sin(),
                f64::from(rings - ring),
            ]);
            let [a, b] = [number(ring - 1, spoke), number(ring - 1, spoke + 1)];
            let [c, d] = [number(ring, spoke), number(ring, spoke + 1)];
            faces.push([a, c, d]);
            if ring > 1 {
                faces.push([a, d, b]);
            }
        }
    }
    Faces::new(vertices, faces)
}

fn signed_area(line: &ContourLine) -> f64 {
    0.5 * line
        .points
        .windows(2)
        .map(|p| p[0][0] * p[1][1] - p[0][1] * p[1][0])
        .sum::<f64>()
}

#[test]
fn contours_of_a_cone_are_circles() {
    let (rings, spokes) = (10_u32, 360_u32);
    let surface = cone(rings, spokes);
    let lines: Vec<_> = contours(&surface, &Levels::every(0.25, 0.0).unwrap())
        .unwrap()
        .collect();
    // The outer ring is the edge of the data and the top is a point.
    assert_eq!(lines.len(), 4 * rings as usize - 1);
    for (i, line) in lines.iter().enumerate() {
        assert_eq!(line.level, 0.25 * (i + 1) as f64);
        assert!(line.is_closed());
        let radius = f64::from(rings) - line.level;
        let flat = radius * (std::f64::consts::PI / f64::from(spokes)).cos();
        let on_ring = radius.fract() == 0.0;
        assert_eq!(
            line.points.len(),
            if on_ring || radius < 1.0 {
                spokes
            } else {
                2 * spokes
            } as usize
                + 1
        );
        for p in &line.points {
            let r = p[0].hypot(p[1]);
            assert!(
                r < radius + 1e-12 && r > if on_ring { radius } else { flat } - 1e-12,
                "{r} for {radius}"
            );
        }
        // High ground, the middle, is on the right: clockwise.
        let circle = -std::f64::consts::PI * radius * radius;
        assert!(
            (signed_area(line) / circle - 1.0).abs() < 1e-4,
            "{} for {circle}",
            signed_area(line)
        );
    }
}

/// Along the edge of the data there is ground on one side only: no contour, even where the edge
/// lies exactly on the level. The same edge inside of the data is one if ground falls there.
#[test]
fn no_contour_runs_along_the_edge_of_the_data() {
    let whole = grid(3, &[1, 1, 1, 2, 2, 2, 3, 3, 3], |_| true);
    assert!(draw(&whole, &[1.0, 3.0]).is_empty());
    assert_eq!(draw(&whole, &[2.0]).len(), 1);
    // The upper half: what was the middle is the edge of the data now.
    let upper = grid(3, &[2, 2, 2, 3, 3, 3], |_| true);
    assert!(draw(&upper, &[1.0, 2.0, 3.0]).is_empty());
    assert_eq!(draw(&upper, &[2.5]).len(), 1);
    for surface in [whole, upper] {
        (2..7).for_each(|half_level| drop(check(&surface, half_level)));
    }
}

#[test]
fn a_flat_surface_has_no_contour() {
    assert!(draw(&grid(4, &[2; 16], |_| true), &[1.0, 2.0, 3.0]).is_empty());
    assert!(draw(&Faces::new(vec![], vec![]), &[1.0]).is_empty());
}

#[test]
fn a_lake_on_the_level_gives_its_shore() {
    #[rustfmt::skip]
    let bowl = [
        3, 3, 3, 3, 3,
        3, 1, 1, 1, 3,
        3, 1, 1, 1, 3,
        3, 1, 1, 1, 3,
        3, 3, 3, 3, 3,
    ];
    // The water is at the level, the shore is above: all of it is {height >= level}.
    assert!(draw(&grid(5, &bowl, |_| true), &[1.0]).is_empty());
    let plateau = bowl.map(|h| 4 - h);
    let lines = draw(&grid(5, &plateau, |_| true), &[3.0]);
    let shore = [
        [1.0, 1.0],
        [1.0, 2.0],
        [1.0, 3.0],
        [2.0, 3.0],
        [3.0, 3.0],
        [3.0, 2.0],
        [3.0, 1.0],
        [2.0, 1.0],
        [1.0, 1.0],
    ];
    assert_eq!(
        lines,
        [ContourLine {
            level: 3.0,
            points: shore.to_vec()
        }]
    );
}

/// The pass of a saddle on the level: the high ground on both sides stays separate.
#[test]
fn a_saddle_on_the_level_parts_the_high_ground() {
    let lines = draw(&wheel(0, [1, 1, -1, -1, 1, 1, -1, -1], 0xff), &[0.0]);
    assert_eq!(lines.len(), 2);
    for line in &lines {
        assert_eq!(line.points[1], [0.0, 0.0]);
        assert!(
            line.points[0][0] * line.points[2][0] > 0.0,
            "both ends are on one side: {line:?}"
        );
    }
}

/// High ground around a hollow, closed by the pass at the level: its outer and its inner border are
/// two rings, which touch in the pass.
#[test]
fn high_ground_that_meets_itself_has_two_rings() {
    #[rustfmt::skip]
    let pass = [
        0, 0, 0, 0, 0,
        0, 2, 1, 2, 0,
        0, 2, 0, 2, 0,
        0, 2, 2, 2, 0,
        0, 0, 0, 0, 0,
    ];
    let lines = check(&grid(5, &pass, |_| true), 2);
    assert_eq!(lines.len(), 2);
    assert!(
        lines
            .iter()
            .all(|line| line.is_closed() && line.points.contains(&[2.0, 1.0]))
    );
    let mut areas: Vec<f64> = lines.iter().map(signed_area).collect();
    areas.sort_by(f64::total_cmp);
    // High ground is on the right of both: within the outer one, outside of the inner one.
    assert!(areas[0] < -4.0 && areas[1] > 0.0, "{areas:?}");
}

/// A ridge that exceeds the level by the last bit has no width in `f64`, and no contour.
#[test]
fn what_is_narrower_than_a_bit_vanishes() {
    let mut surface = grid(5, &[0; 25], |_| false);
    for v in [6, 7, 8, 13, 18] {
        surface.vertices[v][2] = 0.3_f64.next_up();
    }
    for p in &mut surface.vertices {
        *p = [p[0] + 512_000.0, p[1] + 5_403_000.0, p[2]];
    }
    assert!(draw(&surface, &[0.3]).is_empty());
}

#[test]
fn threads_do_not_matter() {
    let heights: Vec<i32> = (0..60 * 60).map(|i| i * 7919 % 101 % 17).collect();
    let surface = grid(60, &heights, |quad| quad % 3 == 0);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            contours(&surface, &Levels::every(0.5, 0.0).unwrap())
                .unwrap()
                .collect::<Vec<_>>()
        })
    };
    assert!(with(1).len() > 1000);
    assert_eq!(bits(&with(1)), bits(&with(3)));
}

#[test]
fn too_many_levels_are_refused() {
    let error = contours(&cone(3, 8), &Levels::every(1e-6, 0.0).unwrap())
        .err()
        .unwrap();
    assert!(
        error.to_string().contains("0.000001") || error.to_string().contains("1e-6"),
        "{error}"
    );
}

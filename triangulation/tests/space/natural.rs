//! Natural neighbor coordinates in space: their laws, and Sibson's compared with insertion.

use std::collections::BTreeMap;

use breakline_triangulation::geometry::Space;
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Location};
use testkit::random::Random;

type Point = [f64; 3];
type Triangulation = Delaunay<Space, 4>;
type Weights = Vec<(VertexId, f64)>;

fn build(points: &[Point]) -> Triangulation {
    Delaunay::from_points(Space::new(), points).unwrap().0
}

/// Returns points on a tiny grid, or anywhere.
fn points(random: &mut Random, round: usize) -> Vec<Point> {
    let side = 2 + random.below(3);
    let site = |random: &mut Random| match round % 4 {
        0 => [0; 3].map(|_| random.unit() * 6.0),
        1 => [0; 3].map(|_| 2.0 * random.below(side) as f64),
        2 => [random.below(side) as f64, random.below(side) as f64, 1.0], // in one plane
        _ => [0; 3].map(|_| 2.0 * random.below(side) as f64 + random.unit() / 1e4), // nearly on spheres
    };
    (0..1 + random.index(30)).map(|_| site(random)).collect()
}

fn site(random: &mut Random, round: usize) -> Point {
    match round % 2 {
        0 => [0; 3].map(|_| random.unit() * 6.0),
        _ => [
            random.below(7) as f64,
            random.below(7) as f64,
            1.0 + random.below(3) as f64,
        ],
    }
}

fn mean(t: &Triangulation, weights: &Weights) -> Point {
    [0, 1, 2].map(|k| {
        weights
            .iter()
            .map(|&(v, weight)| weight * t.point(v)[k])
            .sum()
    })
}

fn distance(p: &Point, q: &Point) -> f64 {
    (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
}

fn is_within(t: &Triangulation, q: &Point) -> bool {
    matches!(
        t.locate(q, None),
        Location::Vertex(_) | Location::Cell { .. }
    )
}

fn both(t: &Triangulation, q: &Point) -> [Option<Weights>; 2] {
    [t.sibson(q, None), t.laplace(q, None)]
}

#[test]
fn weights_are_positive_sum_to_one_and_reproduce_the_site() {
    let mut random = Random(1);
    let mut answers = [0; 4];
    for round in 0..4000 {
        let (t, q) = (
            build(&points(&mut random, round)),
            site(&mut random, round / 2),
        );
        for weights in both(&t, &q) {
            assert_eq!(
                weights.is_some(),
                is_within(&t, &q),
                "{:?} {q:?}",
                t.points()
            );
            let Some(weights) = weights else { continue };
            answers[t.dimension() as usize] += 1;
            assert!(weights.iter().all(|&(_, weight)| weight >= 0.0));
            assert!((weights.iter().map(|&(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(
                distance(&mean(&t, &weights), &q) < 1e-9,
                "{:?} {q:?} {weights:?}",
                t.points()
            );
            assert!(
                weights.is_sorted_by_key(|&(v, _)| v)
                    && weights.windows(2).all(|pair| pair[0].0 != pair[1].0)
            );
        }
    }
    assert!(answers[2] > 100 && answers[3] > 1000, "{answers:?}");
}

#[test]
fn sibsons_weights_are_what_cells_lose() {
    let mut random = Random(2);
    let mut judged = 0;
    for round in 0..800 {
        let (t, q) = (
            build(&points(&mut random, round)),
            site(&mut random, round / 4),
        );
        let within = [[-300.0; 3], [300.0; 3]];
        if t.dimension() < 3 || !matches!(t.locate(&q, None), Location::Cell { .. }) {
            continue;
        }
        let mut after = t.clone();
        let new = after.insert(q).unwrap();
        let cell = after.voronoi_cell(new, within);
        let corners = cell.facets.iter().flat_map(|facet| &facet.corners);
        if corners.flatten().any(|x| x.abs() > 30.0) {
            continue; // on the hull or close to it: the judge gets imprecise
        }
        judged += 1;
        let lost = |v| {
            (t.voronoi_cell(v, within).volume - after.voronoi_cell(v, within).volume) / cell.volume
        };
        let mut lost: BTreeMap<VertexId, f64> = t.tds().vertices().map(|v| (v, lost(v))).collect();
        for (v, weight) in t.sibson(&q, None).unwrap() {
            let lost = lost.remove(&v).unwrap();
            assert!(
                (weight - lost).abs() < 1e-5,
                "{:?} {q:?} {v:?} {weight} {lost}",
                t.points()
            );
        }
        assert!(
            lost.values().all(|lost| lost.abs() < 1e-5),
            "{:?} {q:?} {lost:?}",
            t.points()
        );
    }
    assert!(judged > 100, "{judged}");
}

/// By symmetry all weights in the middle of a cube are equal; on its axis those of the ends of the
/// same side are.
#[test]
fn known_weights() {
    let corners: Vec<Point> = (0..8)
        .map(|k| [k % 2, k / 2 % 2, k / 4].map(|x| f64::from(2 * x)))
        .collect();
    let t = build(&corners);
    for weights in both(&t, &[1.0; 3]) {
        let weights = weights.unwrap();
        assert!(
            weights.len() == 8
                && weights
                    .iter()
                    .all(|(_, weight)| (weight - 0.125).abs() < 1e-12),
            "{weights:?}"
        );
    }
    for weights in both(&t, &[1.0, 1.0, 0.5]) {
        for (v, weight) in weights.unwrap() {
            let expected = if t.point(v)[2] == 0.0 { 0.1875 } else { 0.0625 };
            assert!((weight - expected).abs() < 1e-12, "{weight}");
        }
    }
}

#[test]
fn vertices_the_hull_and_outside() {
    let points = [
        [0.0; 3],
        [4.0, 0.0, 0.0],
        [8.0, 0.0, 0.0],
        [0.0, 8.0, 0.0],
        [0.0, 0.0, 8.0],
        [1.0, 2.0, 1.0],
    ];
    let t = build(&points);
    let at = |p: Point| t.tds().vertices().find(|&v| *t.point(v) == p).unwrap();
    for p in points {
        assert!(
            both(&t, &p)
                .into_iter()
                .all(|weights| weights == Some(vec![(at(p), 1.0)]))
        );
    }
    let expect = |q: Point, expected: &[(Point, f64)]| {
        let mut expected: Weights = expected
            .iter()
            .map(|&(p, weight)| (at(p), weight))
            .collect();
        expected.sort_by_key(|&(v, _)| v);
        for weights in both(&t, &q) {
            let weights = weights.unwrap();
            assert!(
                weights.iter().map(|p| p.0).eq(expected.iter().map(|p| p.0)),
                "{weights:?}"
            );
            assert!(
                weights
                    .iter()
                    .zip(&expected)
                    .all(|(p, q)| (p.1 - q.1).abs() < 1e-12),
                "{weights:?}"
            );
        }
    };
    expect([5.0, 0.0, 0.0], &[(points[1], 0.75), (points[2], 0.25)]);
    expect(
        [0.0, 2.0, 4.0],
        &[(points[0], 0.25), (points[3], 0.25), (points[4], 0.5)],
    );
    assert_eq!(both(&t, &[5.0, -0.1, 0.0]), [None, None]);
    assert_eq!(both(&t, &[f64::NAN, 0.0, 0.0]), [None, None]);

    let line = build(&[[0.0; 3], [4.0; 3], [8.0; 3]]);
    for weights in both(&line, &[5.0; 3]) {
        assert!(distance(&mean(&line, &weights.unwrap()), &[5.0; 3]) < 1e-12);
    }
    assert_eq!(both(&line, &[5.0, 4.0, 5.0]), [None, None]);
    let one = build(&[[1.0; 3]]);
    assert_eq!(
        both(&one, &[1.0; 3]).map(|weights| weights.unwrap()[0].1),
        [1.0, 1.0]
    );
    assert_eq!(both(&one, &[1.0, 2.0, 1.0]), [None, None]);
    assert_eq!(both(&build(&[]), &[1.0; 3]), [None, None]);
}

/// Near a vertex its weight is nearly 1; near a facet of the hull the weights are nearly those on
/// it, if no other vertex lies in its plane.
#[test]
fn weights_are_continuous_at_vertices_and_the_hull() {
    let mut random = Random(3);
    let mut judged = 0;
    for _ in 0..200 {
        let points: Vec<Point> = (0..12)
            .map(|_| [0; 3].map(|_| random.unit() * 6.0))
            .collect();
        let t = build(&points);
        for v in t.tds().vertices() {
            let q = [0, 1, 2].map(|k| t.point(v)[k] + (random.unit() - 0.5) * 1e-9);
            for weights in both(&t, &q).into_iter().flatten() {
                let near: f64 = weights
                    .iter()
                    .filter(|(u, _)| *u == v)
                    .map(|&(_, weight)| weight)
                    .sum();
                assert!(near > 1.0 - 1e-5, "{points:?} {q:?} {near}");
            }
        }
        let middle = [0, 1, 2].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / 12.0);
        for (outside, _) in t.tds().hull_facets() {
            let corners: Vec<VertexId> = t
                .tds()
                .cell_vertices(outside)
                .iter()
                .copied()
                .filter(|&v| v != VertexId::INFINITE)
                .collect();
            let parts = [0.5, 0.3, 0.2];
            let on = [0, 1, 2].map(|k| {
                (0..3)
                    .map(|i| parts[i] * t.point(corners[i])[k])
                    .sum::<f64>()
            });
            let q = [0, 1, 2].map(|k| on[k] + 1e-7 * (middle[k] - on[k]));
            for weights in both(&t, &q).into_iter().flatten() {
                judged += 1;
                for v in t.tds().vertices() {
                    let found = weights.iter().find(|(u, _)| *u == v).map_or(0.0, |p| p.1);
                    let expected = corners
                        .iter()
                        .position(|&u| u == v)
                        .map_or(0.0, |i| parts[i]);
                    assert!(
                        (found - expected).abs() < 1e-3,
                        "{points:?} {q:?} {found} {expected}"
                    );
                }
            }
        }
    }
    assert!(judged > 1000, "{judged}");
}

/// Where powers of distances overflow or underflow, there are no weights, or right ones.
#[test]
fn beyond_fourth_powers_there_are_none() {
    for scale in [1e160, 1e-170] {
        let cube: Vec<Point> = (0..8)
            .map(|k| [k % 2, k / 2 % 2, k / 4].map(|x| f64::from(4 * x) * scale))
            .collect();
        let (t, _) = Delaunay::from_points(Space::<Wide>::default(), &cube).unwrap();
        let q = [scale, 2.0 * scale, scale];
        for weights in [t.sibson(&q, None), t.laplace(&q, None)]
            .into_iter()
            .flatten()
        {
            assert!(
                weights
                    .iter()
                    .all(|(_, weight)| (0.0..=1.0).contains(weight)),
                "{weights:?}"
            );
        }
    }
}

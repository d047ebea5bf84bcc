//! Natural neighbor coordinates: their laws, and Sibson's compared with insertion.

use std::collections::BTreeMap;

use crate::grid::{Free, Point, build};
use breakline_triangulation::geometry::Plane;
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Location};
use testkit::random::Random;

type Weights = Vec<(VertexId, f64)>;

/// Returns points on a tiny grid, or anywhere.
fn points(dice: &mut Random, round: usize) -> Vec<Point> {
    let side = 2 + dice.below(5);
    let count = 1 + dice.below(25);
    let site = |dice: &mut Random| match round % 3 {
        0 => [0, 1].map(|_| dice.unit() * 8.0),
        1 => [0, 1].map(|_| 2.0 * dice.below(side) as f64),
        _ => [0, 1].map(|_| dice.below(side) as f64 + dice.unit() / 1e5), // nearly on circles and lines
    };
    (0..count).map(|_| site(dice)).collect()
}

fn site(dice: &mut Random, round: usize) -> Point {
    match round % 2 {
        0 => [0, 1].map(|_| dice.unit() * 8.0),
        _ => [0, 1].map(|_| dice.below(9) as f64),
    }
}

fn mean(t: &Free, weights: &Weights) -> Point {
    [0, 1].map(|k| {
        weights
            .iter()
            .map(|&(v, weight)| weight * t.point(v)[k])
            .sum()
    })
}

fn is_within(t: &Free, q: &Point) -> bool {
    matches!(
        t.locate(q, None),
        Location::Vertex(_) | Location::Cell { .. }
    )
}

fn both(t: &Free, q: &Point) -> [Option<Weights>; 2] {
    [t.sibson(q, None), t.laplace(q, None)]
}

#[test]
fn weights_are_positive_sum_to_one_and_reproduce_the_site() {
    let mut dice = Random(1);
    let mut answers = 0;
    for round in 0..6000 {
        let (t, q) = (build(&points(&mut dice, round)), site(&mut dice, round));
        for weights in both(&t, &q) {
            assert_eq!(
                weights.is_some(),
                is_within(&t, &q),
                "{:?} {q:?}",
                t.points()
            );
            let Some(weights) = weights else { continue };
            answers += 1;
            assert!(weights.iter().all(|&(_, weight)| weight >= 0.0));
            assert!((weights.iter().map(|&(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-14);
            let [x, y] = mean(&t, &weights);
            assert!(
                (x - q[0]).hypot(y - q[1]) < 1e-11,
                "{:?} {q:?} {x} {y}",
                t.points()
            );
            let mut vertices: Vec<VertexId> = weights.iter().map(|&(v, _)| v).collect();
            vertices.sort();
            vertices.dedup();
            assert_eq!(vertices.len(), weights.len(), "each neighbor once");
        }
    }
    assert!(answers > 3000, "{answers}");
}

/// Returns the areas that cells lose to that of a new vertex.
#[test]
fn sibsons_weights_are_what_cells_lose() {
    let mut dice = Random(2);
    let mut judged = 0;
    for round in 0..3000 {
        let (t, q) = (build(&points(&mut dice, round)), site(&mut dice, round));
        let window = [[-1e3, -1e3], [1e3, -1e3], [1e3, 1e3], [-1e3, 1e3]];
        let mut after = t.clone();
        let new = after.insert(q).unwrap();
        if after.vertex_count() == t.vertex_count() || !is_within(&t, &q) || t.dimension() < 2 {
            continue;
        }
        let cell = after.voronoi_cell(new, &window);
        if cell
            .corners
            .iter()
            .any(|p| p[0].abs() > 100.0 || p[1].abs() > 100.0)
        {
            continue; // on the hull or close to it: the judge gets imprecise
        }
        judged += 1;
        let mut lost: BTreeMap<VertexId, f64> = BTreeMap::new();
        for v in t.tds().vertices() {
            lost.insert(
                v,
                (t.voronoi_cell(v, &window).area - after.voronoi_cell(v, &window).area) / cell.area,
            );
        }
        for (v, weight) in t.sibson(&q, None).unwrap() {
            let lost = lost.remove(&v).unwrap();
            assert!(
                (weight - lost).abs() < 1e-6,
                "{:?} {q:?} {v:?} {weight} {lost}",
                t.points()
            );
        }
        assert!(
            lost.values().all(|lost| lost.abs() < 1e-6),
            "{:?} {q:?} {lost:?}",
            t.points()
        );
    }
    assert!(judged > 500, "{judged}");
}

#[test]
fn vertices_edges_of_the_hull_and_outside() {
    let points = [
        [0.0, 0.0],
        [4.0, 0.0],
        [8.0, 0.0],
        [8.0, 8.0],
        [0.0, 8.0],
        [3.0, 3.0],
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
    for weights in both(&t, &[5.0, 0.0]) {
        let mut weights = weights.unwrap();
        weights.sort_by_key(|&(v, _)| v);
        let mut expected = [(at([4.0, 0.0]), 0.75), (at([8.0, 0.0]), 0.25)];
        expected.sort_by_key(|&(v, _)| v);
        assert_eq!(weights, expected);
    }
    assert_eq!(both(&t, &[5.0, -0.1]), [None, None]);
    let line = build(&[[0.0, 0.0], [4.0, 4.0], [8.0, 8.0]]);
    for weights in both(&line, &[5.0, 5.0]) {
        assert_eq!(mean(&line, &weights.unwrap()), [5.0, 5.0]);
    }
    for outside in [[5.0, 4.0], [9.0, 9.0]] {
        assert_eq!(both(&line, &outside), [None, None]);
    }
    let one = build(&[[1.0, 1.0]]);
    assert_eq!(
        both(&one, &[1.0, 1.0]).map(|weights| weights.unwrap()[0].1),
        [1.0, 1.0]
    );
    assert_eq!(both(&one, &[1.0, 2.0]), [None, None]);
    assert_eq!(both(&build(&[]), &[1.0, 2.0]), [None, None]);
}

/// Near a vertex its weight is nearly 1; near an edge of the hull the weights are nearly those on
/// it.
#[test]
fn weights_are_continuous_at_vertices_and_the_hull() {
    let mut dice = Random(3);
    for _ in 0..300 {
        let points: Vec<Point> = (0..12)
            .map(|_| [0, 1].map(|_| dice.below(6) as f64))
            .collect();
        let t = build(&points);
        for v in t.tds().vertices().filter(|_| t.dimension() == 2) {
            let q = [0, 1].map(|k| t.point(v)[k] + (dice.unit() - 0.5) * 1e-7);
            for weights in both(&t, &q).into_iter().flatten() {
                let near: f64 = weights
                    .iter()
                    .filter(|(u, _)| *u == v)
                    .map(|&(_, weight)| weight)
                    .sum();
                assert!(near > 1.0 - 1e-5, "{points:?} {q:?} {near}");
            }
        }
        for (cell, i) in t.tds().finite_edges().filter(|_| t.dimension() == 2) {
            if !t.tds().is_infinite(cell) && !t.tds().is_infinite(t.tds().neighbor(cell, i)) {
                continue;
            }
            let [a, b] = t.tds().edge_ends(cell, i).map(|v| *t.point(v));
            let on = [0, 1].map(|k| 0.75 * a[k] + 0.25 * b[k]);
            for inwards in [1e-12, 1e-9, 1e-7] {
                let q = [0, 1].map(|k| on[k] + inwards * (3.0 - on[k]));
                for (weights, limit) in both(&t, &q).into_iter().zip(both(&t, &on)) {
                    let (Some(weights), Some(limit)) = (weights, limit) else {
                        continue;
                    };
                    let weight = |weights: &Weights, v| {
                        weights
                            .iter()
                            .filter(|(u, _)| *u == v)
                            .map(|&(_, w)| w)
                            .sum::<f64>()
                    };
                    for v in t.tds().vertices() {
                        assert!(
                            (weight(&weights, v) - weight(&limit, v)).abs() < 1e-3,
                            "{points:?} {q:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Where squares of distances overflow or underflow, there are no weights.
#[test]
fn beyond_squares_there_are_none() {
    for scale in [1e160, 1e-170] {
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(|p| p.map(|x| x * scale));
        let (t, _) = Delaunay::from_points(Plane::<Wide>::default(), &square).unwrap();
        let q = [scale, 2.0 * scale];
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

//! Power diagrams: compared with clipping by all bisectors, and tested for tiling; nearest points
//! by power compared with all points.

use crate::center;
use crate::polygon::{area, part};
use breakline_triangulation::geometry::{Geometry, Weighted, distance_to_segment};
use breakline_triangulation::kernel::{Adaptive, power_center};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Regular, VoronoiEdge};
use testkit::random::{Random, ulps};

type Point = [f64; 3];
type Weights = Regular<Weighted, 3>;

fn build(dice: &mut Random, round: usize) -> Weights {
    let (side, weights) = (1 + dice.below(6), 1 + dice.below(9));
    let site = |dice: &mut Random| match round % 3 {
        0 => [dice.unit() * 5.0, dice.unit() * 5.0, dice.unit() * 4.0],
        1 => [
            dice.below(side) as f64,
            dice.below(side) as f64,
            dice.below(weights) as f64,
        ],
        _ => [dice.below(side) as f64, 2.0, dice.below(weights) as f64], // on one line
    };
    let points: Vec<Point> = (0..1 + dice.below(20)).map(|_| site(dice)).collect();
    Regular::from_points(Weighted::<Adaptive>::default(), &points)
        .unwrap()
        .0
}

fn power(p: &Point, x: [f64; 2]) -> f64 {
    (x[0] - p[0]).powi(2) + (x[1] - p[1]).powi(2) - p[2]
}

#[test]
fn cells_tile_and_are_cut_by_all_bisectors() {
    let mut dice = Random(1);
    let window = [[-1.0, -1.5], [7.0, -1.0], [6.5, 6.0], [-2.0, 7.0]];
    let whole = area(&window);
    for round in 0..1500 {
        let t = build(&mut dice, round);
        let mut sum = 0.0;
        for v in t.tds().vertices() {
            let cell = t.power_cell(v, &window);
            let others = t.tds().vertices().filter(|&u| u != v);
            let naive = others.fold(window.to_vec(), |left, u| {
                part(&left, |x| power(t.point(v), x) - power(t.point(u), x))
            });
            assert!(
                (cell.area - area(&naive)).abs() < 1e-9 * whole,
                "{:?}",
                t.points()
            );
            sum += cell.area;
        }
        assert!((sum - whole).abs() < 1e-9 * whole, "{:?}", t.points());
        assert!(
            t.hidden()
                .all(|v| t.power_cell(v, &window).corners.is_empty())
        );
    }
}

#[test]
fn the_nearest_by_power() {
    let mut dice = Random(2);
    for round in 0..1500 {
        let t = build(&mut dice, 1 + round % 2);
        for _ in 0..20 {
            // Halves: all sums below are exact.
            let q = [
                dice.below(14) as f64 / 2.0 - 1.0,
                dice.below(14) as f64 / 2.0 - 1.0,
            ];
            let far = |v: &VertexId| power(t.point(*v), q);
            let order = |a: &VertexId, b: &VertexId| t.geometry().compare(t.point(*a), t.point(*b));
            let seen = t
                .tds()
                .vertices()
                .min_by(|a, b| far(a).total_cmp(&far(b)).then(order(a, b)));
            assert_eq!(
                t.nearest(&[q[0], q[1], 77.0]),
                seen,
                "{q:?} {:?}",
                t.points()
            );
            let least = far(&seen.unwrap());
            assert!(
                t.hidden().all(|v| far(&v) >= least),
                "{q:?} {:?}",
                t.points()
            );
        }
    }
}

#[test]
fn centers_are_right_however_flat_the_triangle() {
    let mut dice = Random(3);
    for round in 0..3000 {
        let weight = |dice: &mut Random| dice.around(9) as f64 * [1.0, 1e-9, 1e9][round % 3];
        let mut corners = [0; 3].map(|_| {
            [
                dice.unit() * 100.0 + 5e5,
                dice.unit() * 100.0 + 4e6,
                weight(&mut dice),
            ]
        });
        if round % 2 == 0 {
            // On a line, except for some last bits.
            let along = dice.unit() * 3.0 - 1.0;
            let at = |k: usize| corners[0][k] + along * (corners[1][k] - corners[0][k]);
            corners[2] = [
                ulps(at(0), dice.around(3)),
                ulps(at(1), dice.around(3)),
                corners[2][2],
            ];
        }
        if round % 5 == 0 {
            corners = corners.map(|p| p.map(|x| x * 2f64.powi(150)));
        }
        center::judge(corners, power_center(corners));
    }
    // The site is the first corner.
    assert_eq!(
        power_center([[1.0, 1.0, 0.0], [3.0, 1.0, 4.0], [1.0, 4.0, 9.0]]),
        [0.0, 0.0]
    );
}

#[test]
fn centers_have_the_least_power_with_their_corners() {
    let mut dice = Random(4);
    let mut weighted = 0;
    for round in 0..1500 {
        let t = build(&mut dice, round);
        for cell in t.tds().cells() {
            let corners = t.tds().cell_vertices(cell);
            let Some(center) = t.power_center(cell) else {
                assert!(t.dimension() < 2 || t.tds().is_infinite(cell));
                continue;
            };
            let size = 1e-9 * (1.0 + center[0].powi(2) + center[1].powi(2));
            let least = power(t.point(corners[0]), center);
            assert!(
                corners
                    .iter()
                    .all(|&v| (power(t.point(v), center) - least).abs() < size),
                "{:?}",
                t.points()
            );
            assert!(
                t.points().iter().all(|p| power(p, center) > least - size),
                "{:?}",
                t.points()
            );
            weighted += usize::from(t.circumcenter(cell) != Some(center));
        }
    }
    assert!(weighted > 1000, "{weighted}");
}

/// Returns the ends of an edge of the diagram; where it has none, a point far along it.
fn ends(edge: VoronoiEdge) -> [[f64; 2]; 2] {
    let along = |[x, y]: [f64; 2], [dx, dy]: [f64; 2], s: f64| [x + s * dx, y + s * dy];
    match edge {
        VoronoiEdge::Segment(ends) => ends,
        VoronoiEdge::Ray { from, direction } => [from, along(from, direction, 1e3)],
        VoronoiEdge::Line { through, direction } => {
            [-1e3, 1e3].map(|s| along(through, direction, s))
        }
    }
}

#[test]
fn edges_bound_the_cells() {
    let mut dice = Random(5);
    let window = [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]];
    let is_within = |p: [f64; 2]| p.iter().all(|x| x.abs() < 49.9);
    let mut kinds = [0; 3];
    for round in 0..1500 {
        let t = build(&mut dice, 1 + round % 2);
        let mut edges = vec![Vec::new(); t.points().len()];
        for (cell, i) in t.tds().edges() {
            let beside = t.tds().edge_ends(cell, i);
            let Some(edge) = t.power_edge(cell, i) else {
                assert!(beside.contains(&VertexId::INFINITE));
                continue;
            };
            kinds[match edge {
                VoronoiEdge::Segment(_) => 0,
                VoronoiEdge::Ray { .. } => 1,
                VoronoiEdge::Line { .. } => 2,
            }] += 1;
            for v in beside {
                edges[v.index()].push(ends(edge));
            }
        }
        for v in t.tds().vertices() {
            let cell = t.power_cell(v, &window).corners;
            let edges = &edges[v.index()];
            let sides = (0..cell.len()).map(|k| [cell[k], cell[(k + 1) % cell.len()]]);
            // Every side that is not one of the window's lies on an edge, ...
            for [p, q] in sides.clone() {
                let middle = [0, 1].map(|k| (p[k] + q[k]) / 2.0);
                let is_on = |edge: &[[f64; 2]; 2]| distance_to_segment(middle, *edge) < 1e-7;
                assert!(
                    !is_within(middle) || edges.iter().any(is_on),
                    "{:?}",
                    t.points()
                );
            }
            // ... and every end of an edge lies on a side.
            for &end in edges
                .iter()
                .flatten()
                .filter(|&&end| is_within(end) && cell.len() > 2)
            {
                let is_on = |side: [[f64; 2]; 2]| distance_to_segment(end, side) < 1e-7;
                assert!(sides.clone().any(is_on), "{end:?} {:?}", t.points());
            }
        }
    }
    assert!(kinds.iter().all(|&count| count > 1000), "{kinds:?}");
}

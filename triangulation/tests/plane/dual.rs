//! Voronoi diagrams: compared with exact centers and with clipping by all bisectors, and tested for
//! tiling.

use crate::center;
use crate::grid::{Free, Point, build};
use crate::polygon::{area, part};
use breakline_triangulation::geometry::Plane;
use breakline_triangulation::kernel::{Exact, circumcenter};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, VoronoiEdge};
use testkit::random::{Random, ulps};

fn points(dice: &mut Random, round: usize) -> Vec<Point> {
    let side = 1 + dice.below(6);
    let count = 1 + dice.below(20);
    let site = |dice: &mut Random| match round % 3 {
        0 => [0, 1].map(|_| dice.unit() * 5.0),
        1 => [dice.below(side) as f64, dice.below(side) as f64],
        _ => [dice.below(side) as f64, 2.0], // on one line
    };
    (0..count).map(|_| site(dice)).collect()
}

/// Asserts that the center is correct.
fn judge_center(corners: [Point; 3]) {
    center::judge(corners.map(|[x, y]| [x, y, 0.0]), circumcenter(corners));
}

#[test]
fn centers_are_right_however_flat_the_triangle() {
    let mut dice = Random(1);
    for round in 0..3000 {
        let mut corners: [Point; 3] = [0; 3].map(|_| [0, 1].map(|_| dice.unit() * 100.0 + 5e5));
        if round % 2 == 0 {
            // On a line, except for some last bits.
            let along = dice.unit() * 3.0 - 1.0;
            corners[2] = [0, 1].map(|k| {
                ulps(
                    corners[0][k] + along * (corners[1][k] - corners[0][k]),
                    dice.around(3),
                )
            });
        }
        if round % 5 == 0 {
            corners = corners.map(|p| p.map(|x| x * 2f64.powi(150)));
        }
        judge_center(corners);
    }
    judge_center([[0.0, 0.0], [1.0, 0.0], [0.0, 2f64.powi(-160)]]);
    judge_center([[1.0, 0.0], [2.0, 0.0], [0.0, 1e-290]]);
}

/// Returns a convex polygon around nearly all, some or none of the points.
fn window(dice: &mut Random) -> Vec<Point> {
    let [x, y] = [0, 1].map(|_| dice.around(3) as f64);
    let [w, h] = [0, 1].map(|_| 1.0 + dice.below(9) as f64);
    match dice.below(3) {
        0 => vec![[x, y], [x + w, y], [x, y + h]],
        1 => vec![
            [x, y],
            [x + w, y],
            [x + w + 1.0, y + 0.5],
            [x + w, y + h],
            [x + 0.1, y + h],
        ],
        _ => vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]],
    }
}

fn squared(p: Point, q: Point) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1]).powi(2)
}

#[test]
fn cells_tile_and_are_cut_by_all_bisectors() {
    let mut dice = Random(2);
    for round in 0..1500 {
        let t = build(&points(&mut dice, round));
        let window = window(&mut dice);
        let whole = area(&window);
        let mut sum = 0.0;
        for v in t.tds().vertices() {
            let cell = t.voronoi_cell(v, &window);
            sum += cell.area;
            assert!((cell.area - area(&cell.corners)).abs() < 1e-9 * whole);
            assert!(cell.area >= 0.0);
            let others = t.tds().vertices().filter(|&u| u != v);
            let naive = others.fold(window.clone(), |left, u| {
                part(&left, |x| squared(x, *t.point(v)) - squared(x, *t.point(u)))
            });
            assert!(
                (cell.area - area(&naive)).abs() < 1e-9 * whole,
                "{:?} {window:?}",
                t.points()
            );
        }
        assert!(
            (sum - whole).abs() < 1e-9 * whole,
            "{:?} {window:?}",
            t.points()
        );
    }
}

#[test]
fn edges_are_nearest_to_both_ends() {
    let mut dice = Random(3);
    let mut kinds = [0; 3];
    for round in 0..1500 {
        let t = build(&points(&mut dice, round));
        for (cell, i) in t.tds().edges() {
            let ends = t.tds().edge_ends(cell, i);
            let Some(edge) = t.voronoi_edge(cell, i) else {
                assert!(ends.contains(&VertexId::INFINITE));
                continue;
            };
            let along = |p: Point, d: Point, s: f64| [p[0] + s * d[0], p[1] + s * d[1]];
            let (kind, sites) = match edge {
                VoronoiEdge::Segment([p, q]) => (
                    0,
                    [0.0, 0.3, 1.0].map(|s| along(p, [q[0] - p[0], q[1] - p[1]], s)),
                ),
                VoronoiEdge::Ray { from, direction } => {
                    (1, [0.0, 0.7, 9.0].map(|s| along(from, direction, s)))
                }
                VoronoiEdge::Line { through, direction } => {
                    (2, [-7.0, 0.0, 9.0].map(|s| along(through, direction, s)))
                }
            };
            kinds[kind] += 1;
            for p in sites {
                let far = |v: VertexId| (t.point(v)[0] - p[0]).hypot(t.point(v)[1] - p[1]);
                let [a, b] = ends.map(far);
                assert!((a - b).abs() < 1e-8 * (1.0 + a), "{edge:?}");
                assert!(
                    t.tds().vertices().all(|v| far(v) > a - 1e-8 * (1.0 + a)),
                    "{edge:?}"
                );
            }
            assert_eq!(kind == 2, t.dimension() == 1);
        }
    }
    assert!(kinds.iter().all(|&count| count > 1000), "{kinds:?}");
}

#[test]
fn infinite_faces_have_no_center() {
    let t = build(&[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]);
    let centers: Vec<_> = t
        .tds()
        .cells()
        .filter_map(|cell| t.circumcenter(cell))
        .collect();
    assert_eq!(centers, [[1.0, 1.0]]);
    let line = build(&[[0.0, 0.0], [2.0, 0.0]]);
    assert!(
        line.tds()
            .cells()
            .all(|cell| line.circumcenter(cell).is_none())
    );
}

#[test]
fn magnitudes_without_room_do_no_harm() {
    let points = [[1e300, 0.0], [-1e300, 1.0], [0.0, 1e300], [1e-300, 0.0]];
    let (t, vertices) = Delaunay::from_points(Plane::<Exact>::default(), &points).unwrap();
    for v in vertices {
        t.voronoi_cell(v, &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    }
    assert_eq!(
        t.tds()
            .edges()
            .filter_map(|(cell, i)| t.voronoi_edge(cell, i))
            .count(),
        t.tds().finite_edges().count()
    );
}

/// Numbers of no vertex have no cell.
#[test]
fn no_vertex_no_cell() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let (mut t, v): (Free, _) =
        Delaunay::from_points(Plane::default(), &[square[0], square[2], [0.0, 3.0]]).unwrap();
    let _ = t.remove(v[2]);
    for gone in [v[2], VertexId::INFINITE, VertexId::new(99)] {
        assert!(t.voronoi_cell(gone, &square).corners.is_empty());
    }
    assert_eq!(t.voronoi_cell(v[0], &square).area, 8.0);
}

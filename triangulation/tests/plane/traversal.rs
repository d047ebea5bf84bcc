//! Traversal of faces without marking them: each is returned exactly once, from whichever vertex.

use breakline_triangulation::geometry::{Coordinates, Mapped, Plane, Steps, Terrain};
use breakline_triangulation::kernel::{DotProduct, Exact, Kernel, Wide};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{Basic, ConstrainedDelaunay, Delaunay, OnCrossing, Triangulation};
use testkit::random::Random;

type Point = [f64; 2];

fn judge<G: Coordinates<3>, V, C: Copy + Default>(t: &Triangulation<G, 3, V, C>, start: VertexId) {
    let mut faces: Vec<CellId> = t.faces_from(start).collect();
    let around: Vec<CellId> = t
        .tds()
        .around(start)
        .filter(|&cell| !t.tds().is_infinite(cell))
        .collect();
    assert!(
        faces
            .iter()
            .filter(|cell| around.contains(cell))
            .eq(&around),
        "those around it come in order"
    );
    faces.sort();
    let expected: Vec<CellId> = t.finite_cells().filter(|_| t.dimension() == 2).collect();
    assert_eq!(faces, expected, "from {start:?}");
}

fn judge_all<G: Coordinates<3>, V, C: Copy + Default>(t: &Triangulation<G, 3, V, C>) {
    t.tds().vertices().for_each(|start| judge(t, start));
}

fn judge_some<G: Coordinates<3>>(geometry: G, points: &[G::Point]) {
    let (t, vertices) = Delaunay::from_points(geometry, points).unwrap();
    vertices
        .iter()
        .step_by(points.len().div_ceil(12))
        .for_each(|&start| judge(&t, start));
}

#[test]
fn tiny_grids_from_each_vertex() {
    let mut dice = Random(1);
    for _ in 0..1500 {
        let side = 1 + dice.below(6);
        let points: Vec<Point> = (0..dice.below(24))
            .map(|_| [0; 2].map(|_| dice.below(side) as f64))
            .collect();
        judge_all(
            &Delaunay::<Plane, 3>::from_points(Plane::default(), &points)
                .unwrap()
                .0,
        );
    }
}

/// Triangles of any shape: the order in which they hide each other, seen from a vertex, may be
/// cyclic.
#[test]
fn without_a_law() {
    let mut dice = Random(2);
    for _ in 0..600 {
        let mut basic: Basic<Plane, 3> = Basic::new(Plane::default());
        for _ in 0..dice.below(40) {
            basic.insert([0; 2].map(|_| dice.below(12) as f64)).unwrap();
        }
        // Flip pseudo-random edges, which makes pinwheels.
        for _ in 0..60 * usize::from(basic.dimension() == 2) {
            let cell = CellId::new(dice.index(basic.tds().cell_slots()));
            basic.flip(cell, dice.index(3));
        }
        judge_all(&basic);
    }
}

/// A face between three others, each of which hides the next one from the middle: no order from
/// front to back.
#[test]
fn a_pinwheel() {
    let turned = |radius: f64, turn: f64| {
        move |k: usize| {
            let angle = (k as f64 / 3.0 + turn) * std::f64::consts::TAU;
            [radius * angle.cos(), radius * angle.sin()]
        }
    };
    for turn in 0..24 {
        let rings = [turned(3.0, 0.0), turned(9.0, f64::from(turn) / 24.0)];
        let points: Vec<Point> = rings
            .iter()
            .flat_map(|ring| (0..3).map(ring))
            .chain([[0.0, 0.0]])
            .collect();
        let lines: Vec<Vec<u32>> = (0..3).map(|k| vec![k, 3 + (k + 1) % 3]).collect();
        let geometry: Plane = Plane::default();
        let t =
            ConstrainedDelaunay::<_, ()>::from_lines(geometry, &points, &lines, OnCrossing::Split)
                .unwrap()
                .0;
        judge_all(&t);
    }
}

#[test]
fn constraints_that_make_slivers() {
    let mut dice = Random(3);
    for _ in 0..300 {
        let points: Vec<Point> = (0..30)
            .map(|_| [0; 2].map(|_| dice.below(20) as f64))
            .collect();
        let lines: Vec<Vec<u32>> = (0..6)
            .map(|_| {
                vec![
                    dice.index(points.len()) as u32,
                    dice.index(points.len()) as u32,
                ]
            })
            .collect();
        let geometry: Plane = Plane::default();
        judge_all(
            &ConstrainedDelaunay::<_, ()>::from_lines(geometry, &points, &lines, OnCrossing::Split)
                .unwrap()
                .0,
        );
    }
}

#[test]
fn grids_circles_clusters_and_scans() {
    let mut dice = Random(4);
    let plane: Plane = Plane::default();
    judge_some(
        plane,
        &(0..2500)
            .map(|k| [f64::from(k % 50), f64::from(k / 50)])
            .collect::<Vec<Point>>(),
    );
    let circle: Vec<Point> = (0..1000)
        .map(|k| f64::from(k) / 159.0)
        .map(|a| [a.cos(), a.sin()])
        .collect();
    judge_some(plane, &circle);
    let cluster = |dice: &mut Random| {
        let center = [0; 2].map(|_| dice.below(4) as f64);
        let size = 10f64.powi(-(dice.below(14) as i32));
        center.map(|x| x + size * dice.unit())
    };
    judge_some(
        plane,
        &(0..5000)
            .map(|_| cluster(&mut dice))
            .collect::<Vec<Point>>(),
    );
    // Scan lines in centimeters, some of which stand on others.
    let scan = |dice: &mut Random, k: i32| {
        [
            k % 200 * 25 + dice.below(5) as i32,
            k / 200 * 70,
            dice.below(3000) as i32,
        ]
    };
    let steps: Vec<[i32; 3]> = (0..20_000).map(|k| scan(&mut dice, k)).collect();
    judge_some(
        Steps::<breakline_triangulation::kernel::Lattice>::default(),
        &steps,
    );
    let heights: Vec<[f64; 3]> = steps
        .iter()
        .map(|p| p.map(|x| f64::from(x) * 0.01))
        .collect();
    judge_some(
        Terrain::<breakline_triangulation::kernel::Adaptive>::default(),
        &heights,
    );
    judge_some(Mapped::new(|p: &[f64; 3]| [p[1], 3.0 * p[0]]), &heights);
}

#[test]
fn nothing_from_nowhere() {
    let geometry: Plane = Plane::default();
    let line = Delaunay::<_, 3>::from_points(geometry, &[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]])
        .unwrap()
        .0;
    assert_eq!(line.faces_from(VertexId::new(0)).count(), 0);
    assert_eq!(
        line.faces_from(VertexId::INFINITE).count() + line.faces_from(VertexId::new(7)).count(),
        0
    );
}

#[test]
fn angles() {
    let mut dice = Random(5);
    for _ in 0..10_000 {
        let corners: [[i64; 2]; 3] = [0; 3].map(|_| [dice.around(3), dice.around(3)]);
        let [p, v, q] = corners;
        let expected = ((p[0] - v[0]) * (q[0] - v[0]) + (p[1] - v[1]) * (q[1] - v[1])).signum();
        let angle = DotProduct(corners.map(|p| p.map(|x| x as f64)));
        assert_eq!(Wide::sign(&angle) as i64, expected);
        let nearly = DotProduct(angle.0.map(|p| p.map(|x| x * 0.1 + 1e-17 * dice.unit())));
        assert_eq!(Wide::sign(&nearly), Exact::sign(&nearly));
    }
}

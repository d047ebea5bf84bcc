//! Removal of vertices: what remains is the triangulation of the other points, cell for cell.

use std::collections::{BTreeMap, BTreeSet};

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::kernel::Adaptive;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Level, MoveError, PointError, RemovalError};
use testkit::random::{Random, ulps};

type Point = [f64; 2];
type Free = Delaunay<Plane, 3>;

/// The finite cells as sorted points.
fn cells(t: &Free) -> BTreeSet<Vec<[u64; 2]>> {
    // Bits order negative numbers wrongly, which is harmless here.
    testkit::cells::cells(t, |p| p.map(f64::to_bits))
}

fn fresh(points: &[Point]) -> Free {
    Delaunay::from_points(Plane::default(), points).unwrap().0
}

/// Numbers, holes and counts match each other and the remaining points.
fn same_as_fresh(t: &Free, left: &[Point]) {
    assert_eq!(t.check(Level::Law), [], "{left:?}");
    let expected = fresh(left);
    assert_eq!(
        (t.dimension(), t.vertex_count()),
        (expected.dimension(), expected.vertex_count()),
        "{left:?}"
    );
    assert_eq!(t.tds().vertices().count(), t.vertex_count());
    assert_eq!(cells(t), cells(&expected), "{left:?}");
}

/// Removes the points in this order, down to nothing, and inserts them again; each state is
/// compared.
fn empties_and_fills(points: &[Point], order: &[usize]) {
    let (mut t, vertices): (Free, _) = Delaunay::from_points(Plane::default(), points).unwrap();
    let slots = t.tds().vertex_slots();
    let mut left = points.to_vec();
    for &at in order {
        let was_there = left.contains(&points[at]);
        left.retain(|p| *p != points[at]);
        assert_eq!(t.remove(vertices[at]).ok(), was_there.then_some(points[at]));
        assert!(!t.tds().is_vertex(vertices[at]));
        same_as_fresh(&t, &left);
    }
    assert_eq!(
        (t.dimension(), t.vertex_count(), t.tds().cell_count()),
        (-1, 0, 0)
    );
    for &at in order {
        t.insert(points[at]).unwrap();
        left.push(points[at]);
        same_as_fresh(&t, &left);
    }
    assert_eq!(t.tds().vertex_slots(), slots, "holes are filled first");
}

#[test]
fn every_vertex_of_every_subset_of_a_tiny_grid() {
    for subset in 1u32..1 << 9 {
        let points: Vec<Point> = (0..9)
            .filter(|k| subset >> k & 1 == 1)
            .map(|k| [f64::from(k % 3), f64::from(k / 3)])
            .collect();
        for at in 0..points.len() {
            let (mut t, vertices): (Free, _) =
                Delaunay::from_points(Plane::default(), &points).unwrap();
            assert_eq!(t.remove(vertices[at]), Ok(points[at]));
            let mut left = points.clone();
            left.remove(at);
            same_as_fresh(&t, &left);
            t.insert(points[at]).unwrap();
            same_as_fresh(&t, &points);
        }
    }
}

/// Removes the points of a 3 x 3 grid in all orders. Each state is a subset, which the test above
/// has compared with a new construction after one step; here it is what remains after a long
/// history.
#[test]
fn a_tiny_grid_in_all_orders() {
    fn descend(t: &Free, expected: &[BTreeSet<Vec<[u64; 2]>>], subset: usize) -> usize {
        let mut states = 1;
        for v in t.tds().vertices() {
            let mut next = t.clone();
            let [x, y] = next.remove(v).unwrap();
            let rest = subset & !(1 << (x as usize + 3 * y as usize));
            assert!(
                cells(&next) == expected[rest],
                "{subset:b} without {:?}",
                [x, y]
            );
            // Links and orientation follow from those of larger sets, which are fewer.
            if rest.count_ones() > 4 {
                assert_eq!(next.check(Level::Law), []);
            }
            states += descend(&next, expected, rest);
        }
        states
    }
    let grid = |subset: usize| -> Vec<Point> {
        (0..9)
            .filter(|k| subset >> k & 1 == 1)
            .map(|k| [(k % 3) as f64, (k / 3) as f64])
            .collect()
    };
    let expected: Vec<_> = (0..1 << 9)
        .map(|subset| cells(&fresh(&grid(subset))))
        .collect();
    // 9! / k! paths for each k: 986 410 in all.
    assert_eq!(descend(&fresh(&grid(511)), &expected, 511), 986_410);
}

#[test]
fn grids_down_to_nothing_and_up_again() {
    let mut random = Random(1);
    for _ in 0..1500 {
        let side = 1 + random.below(6);
        let scale = random.pick(&[1.0, 0.37, 1e-3]);
        let points: Vec<Point> = (0..1 + random.below(24))
            .map(|_| [(); 2].map(|()| random.below(side) as f64 * scale))
            .collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        empties_and_fills_once_each(&points, &order);
    }
}

/// Points that are given twice share a vertex: its number is free after the first removal.
fn empties_and_fills_once_each(points: &[Point], order: &[usize]) {
    let mut seen: Vec<Point> = Vec::new();
    let mut once = Vec::new();
    for &at in order {
        if !seen.contains(&points[at]) {
            seen.push(points[at]);
            once.push(at);
        }
    }
    empties_and_fills(points, &once);
}

#[test]
fn scattered_points() {
    let mut random = Random(2);
    for round in 0..150 {
        let count = 3 + random.below(40);
        let points: Vec<Point> = (0..count)
            .map(|_| match round % 3 {
                0 => [random.unit(), random.unit()],
                1 => [
                    500_000.0 + random.unit(),
                    4_649_000.0 + 1e-7 * random.unit(),
                ],
                _ => [ulps(1.0, random.around(3)), ulps(2.0, random.around(3))],
            })
            .collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        empties_and_fills_once_each(&points, &order);
    }
}

#[test]
fn collinear_points_and_one_beside() {
    let mut random = Random(3);
    for round in 0..200 {
        let [dx, dy] = random.pick(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, -1.0], [-3.0, 1.0]]);
        let count = 1 + random.below(8);
        let mut points: Vec<Point> = (0..count).map(|k| [dx * k as f64, dy * k as f64]).collect();
        if round % 2 == 0 {
            points.push([2.0, 7.0]);
        }
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        empties_and_fills(&points, &order);
    }
}

/// Vertices with hundreds of neighbors: inside of a circle or at a line's ends, and on the hull.
#[test]
fn fans() {
    let circle = |k: i32| {
        let angle = f64::from(k) * 0.01;
        [100.0 * angle.cos(), 100.0 * angle.sin()]
    };
    let chords: Vec<Point> = (0..628).map(circle).collect();
    let line: Vec<Point> = (0..500).map(|k| [f64::from(k), 0.0]).collect();
    let parabola: Vec<Point> = (-250..250)
        .map(|k| [f64::from(k), f64::from(k * k) / 512.0])
        .collect();
    let cap: Vec<Point> = parabola.iter().map(|&[x, y]| [x, -y]).collect();
    let lattice_circle: Vec<Point> = (-325..=325)
        .flat_map(|x: i32| {
            let y = f64::from(325 * 325 - x * x).sqrt();
            [[f64::from(x), y], [f64::from(x), -y]]
                .into_iter()
                .filter(move |_| y.fract() == 0.0)
        })
        .collect();
    let cases = [
        (chords.clone(), [0.0, 0.0]),
        (chords, [3.0, 99.0]),
        (line.clone(), [250.0, 1000.0]),
        (line, [-1.0, 0.0]),
        (parabola.clone(), [0.0, -1e5]),
        (parabola, [0.0, 1e5]),
        (cap, [0.0, 1e4]),
        (lattice_circle, [0.0, 0.0]),
    ];
    for (points, p) in cases {
        let mut t = fresh(&points);
        let v = t.insert(p).unwrap();
        assert_eq!(t.remove(v), Ok(p));
        same_as_fresh(&t, &points);
    }
}

#[test]
fn what_is_not_there_cannot_be_removed() {
    let mut t = fresh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let v = t.tds().vertices().next().unwrap();
    assert_eq!(t.remove(VertexId::INFINITE), Err(RemovalError::NoVertex));
    assert_eq!(t.remove(VertexId::new(3)), Err(RemovalError::NoVertex));
    assert!(t.remove(v).is_ok());
    assert_eq!(t.remove(v), Err(RemovalError::NoVertex));
    assert_eq!(
        (
            t.vertex_count(),
            t.tds().vertex_slots(),
            t.tds().vertices().count()
        ),
        (2, 3, 2)
    );
}

/// Vertices that move: each state is that of their current sites, and numbers and payloads move
/// with them.
#[test]
fn vertices_move() {
    let mut random = Random(17);
    for _ in 0..400 {
        let side = 1 + random.below(5);
        let mut site = || [0, 1].map(|_| random.below(side) as f64);
        let points: Vec<Point> = (0..9).map(|_| site()).collect();
        let (mut t, vertices) =
            Delaunay::from_points_with(Plane::<Adaptive>::default(), &points, |i| i).unwrap();
        let mut sites: BTreeMap<VertexId, Point> =
            vertices.iter().map(|&v| (v, *t.point(v))).collect();
        let mut payloads: BTreeMap<VertexId, usize> = vertices
            .iter()
            .map(|&v| (v, *t.tds().vertex_data(v)))
            .collect();
        for &v in &vertices {
            let first = points.iter().position(|p| p == t.point(v));
            assert_eq!(first, Some(payloads[&v]));
        }
        for at in 0..20 {
            let (v, p) = (vertices[at % 9], site());
            let there = sites.iter().find(|(_, q)| **q == p).map(|(&w, _)| w);
            let moved = t.move_to(v, p);
            if sites.contains_key(&v) {
                assert_eq!(moved, Ok(there.unwrap_or(v)));
                sites.remove(&v);
                if there.is_some_and(|w| w != v) {
                    payloads.remove(&v);
                }
                sites.entry(moved.unwrap()).or_insert(p);
            } else {
                assert_eq!(moved, Err(MoveError::Vertex(RemovalError::NoVertex)));
            }
            assert_eq!(t.check(Level::Law), []);
            assert_eq!(
                t.tds()
                    .vertices()
                    .map(|v| (v, *t.point(v)))
                    .collect::<BTreeMap<_, _>>(),
                sites
            );
            assert_eq!(
                t.tds()
                    .vertices()
                    .map(|v| (v, *t.tds().vertex_data(v)))
                    .collect::<BTreeMap<_, _>>(),
                payloads
            );
            let left: Vec<Point> = sites.values().copied().collect();
            let key = |p: Point| p.map(f64::to_bits);
            assert_eq!(
                testkit::cells::cells(&t, key),
                testkit::cells::cells(&fresh(&left), key)
            );
        }
        assert_eq!(
            t.move_to(vertices[0], [f64::NAN, 0.0]),
            Err(MoveError::Point(PointError::NotFinite))
        );
    }
}

//! Location and nearest vertices in space, against searches through all vertices, on small grids
//! where distances tie.

use std::cmp::Ordering;

use breakline_triangulation::geometry::{Geometry, Metric, Space, WeightedSpace};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Hierarchy, JumpAndWalk, Locate, Location, Regular};
use testkit::random::Random;

type Point = [f64; 3];

fn on_grid(random: &mut Random, sizes: [u64; 3]) -> Point {
    sizes.map(|size| random.below(size) as f64 / 2.0)
}

/// Whole squared distances of points on the grid, times four.
fn distance(p: &Point, q: &Point) -> i64 {
    (0..3)
        .map(|k| ((p[k] - q[k]) * 2.0) as i64)
        .map(|d| d * d)
        .sum()
}

/// Compares with the location that a walk from anywhere finds: cells may differ on a border only.
fn agree(t: &Delaunay<Space, 4>, q: &Point, found: Location, expected: Location) {
    match (found, expected) {
        (Location::Cell { .. }, Location::Cell { .. }) => {
            let cells = |location: Location| {
                let Ok(cells) = location.cells(t.tds());
                let mut cells = cells.to_vec();
                cells.sort_unstable();
                cells
            };
            assert_eq!(cells(found), cells(expected), "{q:?}");
        }
        (Location::OutsideHull { .. }, Location::OutsideHull { .. }) => {}
        _ => assert_eq!(found, expected, "{q:?}"),
    }
}

#[test]
fn nearest_vertices_are_those_of_a_search_through_all() {
    let mut random = Random(41);
    for round in 0..200 {
        let sizes = [[5, 5, 5], [9, 9, 1], [9, 1, 1], [3, 4, 6]][round % 4];
        let points: Vec<Point> = (0..random.index(40))
            .map(|_| on_grid(&mut random, sizes))
            .collect();
        let (mut t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
        let vertices: Vec<VertexId> = t.tds().vertices().collect();
        for &vertex in vertices.iter().filter(|v| v.index() % 3 == 2) {
            t.remove(vertex).unwrap();
        }
        for _ in 0..10 {
            let q = on_grid(&mut random, [6, 6, 6]);
            let order = |&a: &VertexId, &b: &VertexId| {
                let by_distance = distance(t.point(a), &q).cmp(&distance(t.point(b), &q));
                by_distance.then_with(|| t.geometry().compare(t.point(a), t.point(b)))
            };
            let mut expected: Vec<VertexId> = t.tds().vertices().collect();
            expected.sort_by(order);
            assert_eq!(
                t.nearest(&q, None),
                expected.first().copied(),
                "{points:?} {q:?}"
            );
            assert_eq!(
                t.nearest_first(&q, None).collect::<Vec<_>>(),
                expected,
                "{points:?} {q:?}"
            );
            let rim = on_grid(&mut random, [6, 6, 6]);
            expected.retain(|&v| distance(t.point(v), &q) <= distance(&rim, &q));
            assert_eq!(
                t.within(&q, &rim).collect::<Vec<_>>(),
                expected,
                "{points:?} {q:?} {rim:?}"
            );
        }
    }
}

#[test]
fn the_least_power_is_found_by_a_search_through_all() {
    let mut random = Random(42);
    for round in 0..200 {
        let sizes = [[5, 5, 5], [9, 9, 1], [9, 1, 1]][round % 3];
        let mut t = Regular::new(WeightedSpace::new());
        for _ in 0..random.index(30) {
            let [x, y, z] = on_grid(&mut random, sizes);
            t.insert([x, y, z, random.below(6) as f64]).unwrap();
        }
        for _ in 0..10 {
            let [x, y, z] = on_grid(&mut random, [6, 6, 6]);
            let q = [x, y, z, 0.0];
            let order = |&a: &VertexId, &b: &VertexId| {
                let (a, b) = (t.point(a), t.point(b));
                t.geometry()
                    .compare_distance(&q, a, b)
                    .then_with(|| t.geometry().compare(a, b))
            };
            let power = |v: VertexId| {
                let &[px, py, pz, w] = t.point(v);
                distance(&[px, py, pz], &[x, y, z]) as f64 - 4.0 * w
            };
            let expected = t.tds().vertices().min_by(order);
            let least = t.tds().vertices().map(power).reduce(f64::min);
            assert_eq!(t.nearest(&q), expected);
            assert_eq!(expected.map(power), least);
        }
    }
}

#[test]
fn all_strategies_find_the_same_location() {
    let mut random = Random(43);
    for round in 0..60 {
        let sizes = [[5, 5, 5], [9, 9, 1], [9, 1, 1]][round % 3];
        let mut t = Delaunay::<Space, 4>::new(Space::new());
        let mut hierarchy = Hierarchy::new(Space::new());
        for _ in 0..300 {
            if random.below(4) == 0 && t.vertex_count() > 0 {
                let vertices: Vec<VertexId> = t.tds().vertices().collect();
                t.remove_by(&mut hierarchy, random.pick(&vertices)).unwrap();
            } else {
                t.insert_by(&mut hierarchy, on_grid(&mut random, sizes), ())
                    .unwrap();
            }
        }
        assert_eq!(t.check(breakline_triangulation::Level::Law), []);
        let of_all = Hierarchy::of(Space::new(), &t);
        for _ in 0..20 {
            let q = on_grid(&mut random, [11, 11, 11]);
            let expected = t.locate(&q, None);
            for found in [
                hierarchy.locate(&t, &q),
                of_all.locate(&t, &q),
                JumpAndWalk.locate(&t, &q),
                t.locate(&q, t.finite_cells().next()),
            ] {
                agree(&t, &q, found, expected);
            }
        }
    }
}

#[test]
fn distances_are_exact() {
    let space = <Space>::new();
    let [q, a, b] = [[0.0; 3], [1.0, 1e-60, 0.0], [1.0, 0.0, 0.0]];
    assert_eq!(space.compare_distance(&q, &a, &b), Ordering::Greater);
    assert_eq!(space.compare_distance(&q, &b, &a), Ordering::Less);
    assert_eq!(space.compare_distance(&q, &a, &a), Ordering::Equal);
}

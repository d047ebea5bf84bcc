//! Laws of the triangulations, on small integer grids where ties are the rule.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Coordinates, Geometry, Plane, Space, Terrain};
use breakline_triangulation::kernel::{Adaptive, Exact, Expansions, Kernel};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    ConstrainedDelaunay, Delaunay, InputError, Level, PointError, Triangulation,
};
use testkit::random::Random;

/// The finite cells as sorted points, in whole steps of 1/1024.
fn cells<G, const N: usize, V, C>(t: &Triangulation<G, N, V, C>) -> BTreeSet<Vec<Vec<i64>>>
where
    G: Coordinates<N>,
    C: Copy + Default,
{
    testkit::cells::cells(t, |p| {
        p.as_ref().iter().map(|x| (x * 1024.0) as i64).collect()
    })
}

fn grid_points<const D: usize>(
    random: &mut Random,
    count: u64,
    side: u64,
    scale: f64,
) -> Vec<[f64; D]> {
    (0..count)
        .map(|_| std::array::from_fn(|_| random.below(side) as f64 * scale))
        .collect()
}

/// Builds in several orders; every build must be flawless and have the same cells.
fn same_in_any_order<G, const N: usize>(geometry: G, mut points: Vec<G::Point>, random: &mut Random)
where
    G: Coordinates<N> + Clone,
{
    let (bulk, _) = Delaunay::from_points(geometry.clone(), &points).unwrap();
    assert_eq!(bulk.check(Level::Law), []);
    let expected = cells(&bulk);
    for _ in 0..3 {
        random.shuffle(&mut points);
        let mut one_by_one = Delaunay::new(geometry.clone());
        for &p in &points {
            one_by_one.insert(p).unwrap();
        }
        assert_eq!(one_by_one.check(Level::Law), [], "{points:?}");
        assert_eq!(cells(&one_by_one), expected, "{points:?}");
    }
    let mut at_twice: Delaunay<G, N> = Delaunay::new(geometry);
    let (first, second) = points.split_at(points.len() / 3);
    for part in [first, second] {
        let vertices = at_twice.insert_all(part).unwrap();
        assert!(
            vertices
                .iter()
                .zip(part)
                .all(|(&v, p)| at_twice.geometry().compare(at_twice.point(v), p).is_eq())
        );
    }
    assert_eq!(cells(&at_twice), expected, "{points:?}");
}

#[test]
fn planar_delaunay_is_a_function_of_the_set() {
    let mut random = Random(1);
    for round in 0..4000 {
        let (count, side) = (1 + random.below(24), 1 + random.below(7));
        let scale = if round % 2 == 0 { 1.0 } else { 0.37 };
        let points = grid_points::<2>(&mut random, count, side, scale);
        same_in_any_order(Plane::<Adaptive>::default(), points, &mut random);
    }
}

#[test]
fn spatial_delaunay_is_a_function_of_the_set() {
    let mut random = Random(2);
    for round in 0..1500 {
        let (count, side) = (1 + random.below(22), 1 + random.below(4));
        let scale = if round % 2 == 0 { 1.0 } else { 0.37 };
        let points = grid_points::<3>(&mut random, count, side, scale);
        same_in_any_order(Space::<Adaptive>::default(), points, &mut random);
    }
}

#[test]
fn kernels_agree() {
    fn build<K: Kernel>(points: &[[f64; 2]]) -> BTreeSet<Vec<Vec<i64>>> {
        cells(
            &Delaunay::from_points(Plane::<K>::default(), points)
                .unwrap()
                .0,
        )
    }
    let mut random = Random(3);
    for _ in 0..200 {
        let points = grid_points::<2>(&mut random, 30, 9, 0.01);
        let exact = build::<Exact>(&points);
        assert_eq!(build::<Adaptive>(&points), exact);
        assert_eq!(build::<Expansions>(&points), exact);
    }
}

#[test]
fn dimensions_grow_one_by_one() {
    let mut t = Delaunay::new(Space::<Adaptive>::default());
    assert_eq!(t.dimension(), -1);
    let points = [
        ([0.0, 0.0, 0.0], 0, 1),
        ([2.0, 0.0, 0.0], 1, 1),
        ([1.0, 0.0, 0.0], 1, 2),
        ([5.0, 0.0, 0.0], 1, 3),
        ([1.0, 1.0, 0.0], 2, 3),
        ([1.0, -1.0, 0.0], 2, 6),
        ([1.0, 0.0, 3.0], 3, 6),
        ([1.0, 0.0, -3.0], 3, 12),
    ];
    for (p, dimension, finite_cells) in points {
        t.insert(p).unwrap();
        assert_eq!(t.check(Level::Law), []);
        assert_eq!(
            (t.dimension(), t.finite_cells().count()),
            (dimension, finite_cells),
            "{p:?}"
        );
    }
    t.insert([1.0, 0.0, 0.0]).unwrap();
    assert_eq!(t.vertex_count(), points.len());
}

#[test]
fn refused_points_are_named() {
    for (x, expected) in [
        (f64::NAN, InputError::NotFinite(1)),
        (f64::INFINITY, InputError::NotFinite(1)),
        (1e300, InputError::Coordinate(1)),
    ] {
        let refused = Delaunay::from_points(Plane::<Adaptive>::default(), &[[0.0, 0.0], [1.0, x]]);
        assert_eq!(refused.err(), Some(expected));
        let mut t = Delaunay::new(Plane::<Adaptive>::default());
        assert_eq!(t.insert_all(&[[0.0, 0.0], [1.0, x]]), Err(expected));
    }
    let mut t = Delaunay::new(Plane::<Adaptive>::default());
    assert_eq!(t.insert([f64::INFINITY, 0.0]), Err(PointError::NotFinite));
    assert!(PointError::Coordinate.to_string().contains("Wide"));
    assert_eq!(t.insert([1e300, 0.0]), Err(PointError::Coordinate));
    let mut t = Delaunay::new(Plane::<Exact>::default());
    for p in [[1e300, 0.0], [1e-310, 1e-310], [-1e300, 5.0], [0.0, -1e300]] {
        t.insert(p).unwrap();
    }
    assert_eq!(t.check(Level::Law), []);
}

/// Every part of each segment between vertices that lie on it must be a constrained edge.
fn covers(t: &ConstrainedDelaunay<Plane>, a: [f64; 2], b: [f64; 2]) -> bool {
    let g = Plane::<Exact>::default();
    let between = |p: &[f64; 2]| {
        let (low, high) = if g.compare(&a, &b).is_lt() {
            (a, b)
        } else {
            (b, a)
        };
        g.compare(p, &low).is_ge() && g.compare(p, &high).is_le()
    };
    let mut on: Vec<VertexId> = t
        .tds()
        .vertices()
        .filter(|&v| {
            g.orientation([&a, &b, t.point(v)]) == breakline_triangulation::num::Sign::Zero
                && between(t.point(v))
        })
        .collect();
    on.sort_by(|&u, &v| g.compare(t.point(u), t.point(v)));
    on.windows(2).all(|pair| {
        t.tds()
            .edge(pair[0], pair[1])
            .is_some_and(|(cell, i)| t.is_constrained(cell, i))
    })
}

#[test]
fn constraints_hold_and_do_not_depend_on_their_order() {
    let mut random = Random(4);
    let mut crossings = 0;
    for _ in 0..3000 {
        let side = 2 + random.below(7);
        let count = 3 + random.below(14);
        // Even coordinates, and segments that cross at grid points only or not at all: exact.
        let points = grid_points::<2>(&mut random, count, side, 4.0);
        let mut segments = Vec::new();
        for _ in 0..random.below(8) {
            let pair: [[f64; 2]; 2] = std::array::from_fn(|_| points[random.below(count) as usize]);
            let crosses_off_grid = segments.iter().any(|&s| crossing_is_rounded(s, pair));
            if !crosses_off_grid {
                segments.push(pair);
            }
        }
        let build = |points: &[[f64; 2]], segments: &[[[f64; 2]; 2]]| {
            let (mut t, _) = ConstrainedDelaunay::from_points(Plane::default(), points).unwrap();
            t.insert_lines(segments).unwrap();
            t
        };
        let first: ConstrainedDelaunay<Plane> = build(&points, &segments);
        crossings += first.crossings().len();
        if first.dimension() < 2 {
            continue;
        }
        let expected = cells(&first);
        let mut shuffled = (points.clone(), segments.clone());
        for _ in 0..3 {
            random.shuffle(&mut shuffled.0);
            random.shuffle(&mut shuffled.1);
            let t = build(&shuffled.0, &shuffled.1);
            assert_eq!(t.check(Level::Law), [], "{shuffled:?}");
            assert!(
                segments.iter().all(|&[a, b]| covers(&t, a, b)),
                "{shuffled:?}"
            );
            assert_eq!(cells(&t), expected, "{shuffled:?}");
        }
    }
    assert!(crossings > 100, "only {crossings} crossings were tried");
}

/// Returns true if two segments cross at a site that has no exact coordinates in steps of 1/1024.
fn crossing_is_rounded([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let minus = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let (ab, cd) = (minus(b, a), minus(d, c));
    let area = cross(ab, cd);
    if area == 0.0 {
        return false;
    }
    let t = cross(minus(c, a), cd) / area;
    let s = cross(minus(c, a), ab) / area;
    if !(0.0..=1.0).contains(&t) || !(0.0..=1.0).contains(&s) {
        return false;
    }
    // Exact only if the site is a dyadic fraction: multiply up and compare.
    (0..2).any(|axis| {
        let numerator = cross(minus(c, a), cd) * ab[axis] * 1024.0;
        numerator % area != 0.0
    })
}

#[test]
fn wild_crossings_leave_a_valid_triangulation() {
    let mut random = Random(5);
    for round in 0..1500 {
        let offset = if round % 2 == 0 {
            [0.0, 0.0]
        } else {
            [500_000.0, 4_649_000.0]
        };
        let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
        let mut segments = Vec::new();
        for _ in 0..2 + random.below(12) {
            let point = |random: &mut Random| -> [f64; 2] {
                std::array::from_fn(|axis| offset[axis] + random.below(40) as f64 * 0.01)
            };
            let pair = [point(&mut random), point(&mut random)];
            segments.push(pair);
            t.insert_lines(&[pair]).unwrap();
            assert_eq!(t.check(Level::Law), [], "{segments:?}");
        }
    }
}

/// Compares bulk construction with insertion one by one, on grids, lines, circles and nearly so.
#[test]
fn bulk_and_one_by_one_agree() {
    let mut random = Random(6);
    for round in 0..6000 {
        let count = 1 + random.below(if round % 50 == 0 { 400 } else { 40 });
        let points: Vec<[f64; 2]> = match round % 5 {
            0 => {
                let side = 1 + random.below(9);
                grid_points(&mut random, count, side, 1.0)
            }
            1 => grid_points::<2>(&mut random, count, 300, 0.01)
                .iter()
                .map(|p| [p[0] + 5e5, p[1] + 4_649_000.0])
                .collect(),
            2 => (0..count).map(|i| [i as f64, (i * i) as f64]).collect(),
            3 => (0..count)
                .map(|_| [random.below(3) as f64 * 1e-9, random.below(1000) as f64])
                .collect(),
            _ => grid_points::<2>(&mut random, count, 1 << 40, 1.0),
        };
        let (bulk, vertices): (ConstrainedDelaunay<Plane>, _) =
            ConstrainedDelaunay::from_points(Plane::default(), &points).unwrap();
        assert_eq!(bulk.check(Level::Law), [], "{points:?}");
        let mut one_by_one: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
        for &p in &points {
            one_by_one.insert(p).unwrap();
        }
        assert_eq!(cells(&bulk), cells(&one_by_one), "{points:?}");
        assert!(
            points
                .iter()
                .zip(&vertices)
                .all(|(p, &v)| bulk.point(v) == p)
        );
    }
}

#[test]
fn points_fall_on_constraints() {
    let mut t: ConstrainedDelaunay<Terrain> = ConstrainedDelaunay::new(Terrain::default());
    t.insert_lines(&[[
        [0.0, 0.0, 1.0],
        [8.0, 0.0, 1.0],
        [8.0, 8.0, 1.0],
        [0.0, 8.0, 1.0],
        [0.0, 0.0, 1.0],
    ]])
    .unwrap();
    t.insert_lines(&[[[0.0, 0.0, 1.0], [8.0, 8.0, 9.0]]])
        .unwrap();
    for p in [
        [4.0, 4.0, 0.0],
        [4.0, 0.0, 0.0],
        [2.0, 2.0, 0.0],
        [1.0, 7.0, 0.0],
    ] {
        t.insert(p).unwrap();
        assert_eq!(t.check(Level::Law), []);
    }
    assert_eq!(t.constrained_edges().count(), 5 + 3);
    // A line at 3 crosses the diagonal, whose own ends are at 1 on the ring, whatever points lie on
    // it.
    t.insert_lines(&[[[5.0, 1.0, 3.0], [5.0, 7.0, 3.0]]])
        .unwrap();
    let crossing = t.crossings();
    assert_eq!(crossing.len(), 1);
    assert_eq!(t.point(crossing[0])[..2], [5.0, 5.0]);
    assert_eq!(t.point(crossing[0])[2], 1.0);
    assert_eq!(t.check(Level::Law), []);
}

#[test]
fn a_segment_crosses_the_edges_that_it_crosses() {
    let mut random = Random(7);
    let mut crossed = 0;
    for _ in 0..3000 {
        let count = 3 + random.below(20);
        let points = grid_points::<2>(&mut random, count, 7, 1.0);
        let (t, _): (ConstrainedDelaunay<Plane>, _) =
            ConstrainedDelaunay::from_points(Plane::default(), &points).unwrap();
        let [a, b]: [[f64; 2]; 2] =
            std::array::from_fn(|_| std::array::from_fn(|_| random.below(11) as f64 - 2.0));
        let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            ((p[0] - r[0]) * (q[1] - r[1]) - (p[1] - r[1]) * (q[0] - r[0]))
                .partial_cmp(&0.0)
                .unwrap() as i32
        };
        if t.dimension() < 2 {
            continue;
        }
        let mut expected = Vec::new();
        for cell in t.finite_cells() {
            let corners = t.tds().cell_vertices(cell);
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let (c, d) = (*t.point(corners[i]), *t.point(corners[j]));
                if turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0 {
                    expected.push([corners[i].min(corners[j]), corners[i].max(corners[j])]);
                }
            }
        }
        expected.sort();
        expected.dedup();
        assert_eq!(t.edges_crossed(&a, &b), expected, "{points:?} {a:?} {b:?}");
        crossed += expected.len();
    }
    assert!(crossed > 1000);
}

/// Where coordinates are a few units in the last place apart, every crossing is rounded to a site
/// that may lie on, beyond or at the end of other lines: segments cross anew, and it terminates
/// nevertheless.
#[test]
fn crossings_in_the_last_bits_come_to_an_end() {
    let mut random = Random(5);
    for (steps, lines) in [(4, 20), (8, 40), (64, 60), (1024, 60)] {
        for _ in 0..10 {
            let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
            for _ in 0..lines {
                let ends =
                    [0, 1].map(|_| [0, 1].map(|_| 1.0 + random.below(steps) as f64 * f64::EPSILON));
                t.insert_lines(&[ends]).unwrap();
            }
            assert_eq!(t.check(Level::Law), []);
        }
    }
}

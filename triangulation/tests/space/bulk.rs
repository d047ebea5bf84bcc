//! Many points at once give the cells that insertion one by one gives.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::Space;
use breakline_triangulation::kernel::{Adaptive, Exact, Interval, Kernel, Wide};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Level};
use testkit::random::{Random, ulps};

type Point = [f64; 3];

fn cells<K: Kernel>(t: &Delaunay<Space<K>, 4>) -> BTreeSet<Vec<Option<[u64; 3]>>> {
    let bits =
        |&v: &VertexId| (v != VertexId::INFINITE).then(|| t.point(v).map(|x| (x + 0.0).to_bits()));
    let corners = |cell| {
        let mut corners: Vec<_> = t.tds().cell_vertices(cell).iter().map(bits).collect();
        corners.sort_unstable();
        corners
    };
    t.tds().cells().map(corners).collect()
}

fn judge<K: Kernel>(points: &[Point]) {
    let (bulk, vertices) = Delaunay::<Space<K>, 4>::from_points(Space::default(), points).unwrap();
    assert_eq!(bulk.check(Level::Law), [], "{points:?}");
    for (p, v) in points.iter().zip(vertices) {
        assert_eq!(bulk.point(v), p);
    }
    let mut one_by_one = Delaunay::<Space<K>, 4>::new(Space::default());
    for &p in points {
        one_by_one.insert(p).unwrap();
    }
    assert_eq!(bulk.dimension(), one_by_one.dimension());
    assert_eq!(cells(&bulk), cells(&one_by_one), "{points:?}");
}

fn sets(random: &mut Random, point: impl Fn(&mut Random) -> Point, rounds: usize, most: usize) {
    for round in 0..rounds {
        let count = random.index(most);
        let points: Vec<Point> = (0..count).map(|_| point(random)).collect();
        match round % 8 {
            0 => judge::<Exact>(&points),
            1 => judge::<Interval>(&points),
            2 => judge::<Wide>(&points),
            _ => judge::<Adaptive>(&points),
        }
    }
}

#[test]
fn random_points() {
    sets(&mut Random(1), |r| [r.unit(), r.unit(), r.unit()], 200, 200);
}

#[test]
fn grids_on_which_ties_are_the_rule() {
    for side in [2, 3, 4, 6] {
        sets(
            &mut Random(side),
            |r| [0; 3].map(|_| r.below(side) as f64),
            400,
            120,
        );
    }
}

#[test]
fn integer_points_of_one_sphere() {
    // All signs and orders of 3 4 12 and of others with the sum of squares 169, around 100.
    let triples = [[0, 0, 13], [3, 4, 12], [0, 5, 12]];
    let mut all = BTreeSet::new();
    for [x, y, z] in triples {
        for [a, b, c] in [
            [x, y, z],
            [y, x, z],
            [x, z, y],
            [z, y, x],
            [y, z, x],
            [z, x, y],
        ] {
            for signs in 0..8 {
                let sign = |bit: i32| if signs >> bit & 1 == 1 { -1 } else { 1 };
                all.insert([100 + a * sign(0), 100 + b * sign(1), 100 + c * sign(2)]);
            }
        }
    }
    let all: Vec<Point> = all.into_iter().map(|p| p.map(f64::from)).collect();
    judge::<Adaptive>(&all);
    sets(&mut Random(5), |r| r.pick(&all), 100, 60);
}

#[test]
fn points_in_few_planes_and_on_few_lines() {
    sets(
        &mut Random(6),
        |r| [r.unit(), r.unit(), r.below(2) as f64],
        100,
        120,
    );
    sets(
        &mut Random(7),
        |r| [r.below(2) as f64, r.below(2) as f64, r.unit()],
        100,
        120,
    );
    sets(&mut Random(8), |r| [r.unit(), r.unit(), 1.0], 30, 60);
}

#[test]
fn neighboring_floating_point_numbers() {
    sets(
        &mut Random(9),
        |r| [0; 3].map(|_| ulps(1.0, r.around(2))),
        200,
        80,
    );
    sets(
        &mut Random(10),
        |r| [0; 3].map(|_| ulps(0.1 + r.below(2) as f64, r.around(40))),
        100,
        80,
    );
}

#[test]
fn coordinates_of_all_magnitudes() {
    let any = |r: &mut Random| {
        2f64.powi(r.around(100) as i32) * r.unit() * if r.below(2) == 0 { 1.0 } else { -1.0 }
    };
    sets(&mut Random(11), |r| [0; 3].map(|_| any(r)), 100, 80);
    sets(&mut Random(12), |r| [any(r), r.unit(), r.unit()], 100, 80);
}

/// Every two points are joined by an edge, and stars have hundreds of vertices.
#[test]
fn the_moment_curve() {
    let points: Vec<Point> = (0..150)
        .map(|k| f64::from(k) / 64.0)
        .map(|t| [t, t * t, t * t * t])
        .collect();
    judge::<Adaptive>(&points);
    let (t, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
    assert_eq!(t.tds().finite_edges().count(), 150 * 149 / 2);
}

#[test]
fn more_points_than_one_round() {
    let mut random = Random(13);
    let points: Vec<Point> = (0..20_000).map(|_| [0; 3].map(|_| random.unit())).collect();
    judge::<Adaptive>(&points);
    let points: Vec<Point> = (0..8_000)
        .map(|_| [0; 3].map(|_| random.below(20) as f64))
        .collect();
    judge::<Adaptive>(&points);
}

#[test]
fn the_result_is_a_function_of_the_points() {
    let mut random = Random(14);
    let mut points: Vec<Point> = (0..3_000)
        .map(|_| [0; 3].map(|_| random.below(12) as f64))
        .collect();
    let built = |points: &[Point]| {
        Delaunay::<Space, 4>::from_points(Space::new(), points)
            .unwrap()
            .0
    };
    let first = built(&points);
    for _ in 0..20 {
        random.shuffle(&mut points);
        let again = built(&points);
        assert_eq!(again.points(), first.points());
        assert!(first.tds().cells().eq(again.tds().cells()));
        for cell in first.tds().cells() {
            assert_eq!(first.tds().corners(cell), again.tds().corners(cell));
        }
    }
}

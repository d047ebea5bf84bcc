//! Many weighted points at once give the cells and the hidden points that insertion one by one
//! gives.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::kernel::{Adaptive, Exact, Fast, Interval, Kernel, Wide};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Level, Regular};
use testkit::random::{Random, ulps};

type Point = [f64; 4];
type Weights<K> = Regular<WeightedSpace<K>, 4>;

fn bits(p: Point) -> [u64; 4] {
    p.map(|x| (x + 0.0).to_bits())
}

fn cells<K: Kernel>(t: &Weights<K>) -> BTreeSet<Vec<Option<[u64; 4]>>> {
    let corners = |cell| {
        let corner = |&v: &VertexId| (v != VertexId::INFINITE).then(|| bits(*t.point(v)));
        let mut corners: Vec<_> = t.tds().cell_vertices(cell).iter().map(corner).collect();
        corners.sort_unstable();
        corners
    };
    t.tds().cells().map(corners).collect()
}

fn hidden<K: Kernel>(t: &Weights<K>) -> BTreeSet<[u64; 4]> {
    t.hidden().map(|v| bits(*t.point(v))).collect()
}

/// Returns the share of hidden points.
fn judge<K: Kernel>(points: &[Point]) -> f64 {
    let (bulk, vertices) = Weights::<K>::from_points(WeightedSpace::default(), points).unwrap();
    assert_eq!(bulk.check(Level::Law), [], "{points:?}");
    for (p, v) in points.iter().zip(&vertices) {
        assert_eq!(bits(*bulk.point(*v)), bits(*p));
    }
    let different: BTreeSet<_> = points.iter().map(|&p| bits(p)).collect();
    assert_eq!(
        vertices.iter().collect::<BTreeSet<_>>().len(),
        different.len(),
        "{points:?}"
    );
    let mut one_by_one = Weights::<K>::new(WeightedSpace::default());
    for &p in points {
        one_by_one.insert(p).unwrap();
    }
    assert_eq!(bulk.dimension(), one_by_one.dimension());
    assert_eq!(hidden(&bulk), hidden(&one_by_one), "{points:?}");
    assert_eq!(cells(&bulk), cells(&one_by_one), "{points:?}");
    bulk.hidden().len() as f64 / different.len().max(1) as f64
}

/// Returns the greatest share of hidden points in a set of more than 20.
fn sets(
    random: &mut Random,
    point: impl Fn(&mut Random) -> Point,
    rounds: usize,
    most: usize,
) -> f64 {
    let mut greatest: f64 = 0.0;
    for round in 0..rounds {
        let count = random.index(most);
        let points: Vec<Point> = (0..count).map(|_| point(random)).collect();
        let share = match round % 8 {
            0 => judge::<Exact>(&points),
            1 => judge::<Interval>(&points),
            2 => judge::<Wide>(&points),
            _ => judge::<Adaptive>(&points),
        };
        if count > 20 {
            greatest = greatest.max(share);
        }
    }
    greatest
}

#[test]
fn random_points() {
    for (seed, weight) in [(1, 0.01), (2, 0.1), (3, 1.0), (4, 100.0)] {
        let share = sets(
            &mut Random(seed),
            |r| [r.unit(), r.unit(), r.unit(), weight * r.unit()],
            60,
            160,
        );
        assert!(weight < 0.1 || share > 0.1, "{share}");
    }
}

#[test]
fn grids_on_which_ties_are_the_rule() {
    for side in [2, 3, 4, 6] {
        for weights in [1, 2, 4, 9] {
            let point = |r: &mut Random| {
                let [x, y, z] = [0; 3].map(|_| r.below(side) as f64);
                [x, y, z, r.below(weights) as f64 - 2.0]
            };
            let share = sets(&mut Random(side + 100 * weights), point, 80, 120);
            assert!(weights == 1 || share > 0.1);
        }
    }
}

/// Points of one paraboloid in one dimension more: each is in a tie with all the others.
#[test]
fn weights_that_make_all_powers_equal() {
    let point = |r: &mut Random| {
        let [x, y, z] = [0; 3].map(|_| r.below(7) as f64);
        let light = if r.below(20) == 0 { 1.0 } else { 0.0 };
        [x, y, z, x * x + y * y + z * z - light]
    };
    sets(&mut Random(30), point, 200, 60);
}

#[test]
fn one_weight_far_from_the_others() {
    for (seed, outlier) in [(40, 1e3), (41, -1e3), (42, 1e12), (43, -1e12)] {
        let point = |r: &mut Random| {
            let weight = if r.below(50) == 0 {
                outlier
            } else {
                0.01 * r.unit()
            };
            [r.unit(), r.unit(), r.unit(), weight]
        };
        sets(&mut Random(seed), point, 40, 120);
    }
}

#[test]
fn points_in_few_planes_and_few_sites() {
    sets(
        &mut Random(50),
        |r| [r.unit(), r.unit(), r.below(2) as f64, 0.1 * r.unit()],
        60,
        120,
    );
    sets(
        &mut Random(51),
        |r| {
            [
                r.below(2) as f64,
                r.below(2) as f64,
                r.unit(),
                0.1 * r.unit(),
            ]
        },
        60,
        120,
    );
    sets(
        &mut Random(52),
        |r| [r.unit(), r.unit(), 1.0, 0.1 * r.unit()],
        20,
        60,
    );
    sets(
        &mut Random(53),
        |r| {
            [
                r.below(2) as f64,
                r.below(2) as f64,
                r.below(2) as f64,
                r.unit(),
            ]
        },
        60,
        120,
    );
}

#[test]
fn numbers_of_all_magnitudes() {
    let any = |r: &mut Random| {
        2f64.powi(r.around(60) as i32) * r.unit() * if r.below(2) == 0 { 1.0 } else { -1.0 }
    };
    sets(&mut Random(60), |r| [0; 4].map(|_| any(r)), 60, 80);
    sets(
        &mut Random(61),
        |r| [r.unit(), r.unit(), r.unit(), any(r)],
        60,
        80,
    );
    sets(
        &mut Random(62),
        |r| [0; 4].map(|_| ulps(1.0, r.around(2))),
        100,
        80,
    );
}

#[test]
fn equal_weights_give_the_delaunay_triangulation() {
    let mut random = Random(70);
    let sites: Vec<[f64; 3]> = (0..3_000)
        .map(|_| [0; 3].map(|_| random.below(12) as f64))
        .collect();
    let (delaunay, _) = Delaunay::<Space, 4>::from_points(Space::new(), &sites).unwrap();
    for weight in [0.0, -3.0, 1e9] {
        let points: Vec<Point> = sites.iter().map(|&[x, y, z]| [x, y, z, weight]).collect();
        let (regular, _) = Weights::<Adaptive>::from_points(WeightedSpace::new(), &points).unwrap();
        assert_eq!(regular.hidden().len(), 0);
        assert!(delaunay.tds().cells().eq(regular.tds().cells()));
        for cell in delaunay.tds().cells() {
            assert_eq!(delaunay.tds().corners(cell), regular.tds().corners(cell));
        }
    }
}

#[test]
fn more_points_than_one_round() {
    let mut random = Random(71);
    let points: Vec<Point> = (0..10_000)
        .map(|_| [0; 4].map(|axis: i32| if axis == 3 { 0.0 } else { random.unit() }))
        .collect();
    let weighted = |random: &mut Random, most: f64| -> Vec<Point> {
        points
            .iter()
            .map(|&[x, y, z, _]| [x, y, z, most * random.unit()])
            .collect()
    };
    let few = judge::<Adaptive>(&weighted(&mut random, 0.002));
    let many = judge::<Adaptive>(&weighted(&mut random, 0.02));
    assert!(few > 0.05 && few < many, "{few} {many}");
    let points: Vec<Point> = (0..6_000)
        .map(|_| [20, 20, 20, 3].map(|side| random.below(side) as f64))
        .collect();
    judge::<Adaptive>(&points);
}

/// Bare floating point may contradict itself: the triangulation may be wrong, but there is one.
#[test]
fn bare_floating_point_ends() {
    let mut random = Random(72);
    for _ in 0..200 {
        let count = 5 + random.index(60);
        let points: Vec<Point> = (0..count)
            .map(|_| [0; 4].map(|_| ulps(0.1, random.around(3))))
            .collect();
        let (t, vertices) =
            Weights::<Fast>::from_points(WeightedSpace::default(), &points).unwrap();
        assert!(vertices.len() == points.len() && t.vertex_count() <= points.len());
    }
}

#[test]
fn the_result_is_a_function_of_the_points() {
    let mut random = Random(73);
    let mut points: Vec<Point> = (0..3_000)
        .map(|_| [10, 10, 10, 4].map(|side| random.below(side) as f64))
        .collect();
    let built = |points: &[Point]| {
        Weights::<Adaptive>::from_points(WeightedSpace::new(), points)
            .unwrap()
            .0
    };
    let first = built(&points);
    for _ in 0..20 {
        random.shuffle(&mut points);
        let again = built(&points);
        assert_eq!(again.points(), first.points());
        assert!(again.hidden().eq(first.hidden()));
        assert!(first.tds().cells().eq(again.tds().cells()));
        for cell in first.tds().cells() {
            assert_eq!(first.tds().corners(cell), again.tds().corners(cell));
            assert_eq!(
                first.hidden_under(cell).len(),
                again.hidden_under(cell).len()
            );
        }
    }
}

/// Payloads and later edits find hidden points as after insertion one by one.
#[test]
fn hidden_points_come_back() {
    let mut random = Random(74);
    let mut points: Vec<Point> = (0..400)
        .map(|_| [0; 4].map(|_| random.below(6) as f64))
        .collect();
    points.sort_by(|p, q| p.partial_cmp(q).unwrap());
    points.dedup();
    random.shuffle(&mut points);
    let (mut t, vertices) =
        Regular::<WeightedSpace, 4>::from_points_with(WeightedSpace::new(), &points, |i| i)
            .unwrap();
    for (i, &v) in vertices.iter().enumerate() {
        assert_eq!(*t.tds().vertex_data(v), i);
    }
    assert!(t.hidden().len() > 50);
    let (gone, rest) = points.split_at(200);
    for v in &vertices[..gone.len()] {
        t.remove(*v).unwrap();
    }
    assert_eq!(t.check(Level::Law), []);
    let (anew, _) = Weights::<Adaptive>::from_points(WeightedSpace::new(), rest).unwrap();
    let t = t.with_vertex_data(|_| ());
    assert_eq!(cells(&t), cells(&anew));
    assert_eq!(hidden(&t), hidden(&anew));
}

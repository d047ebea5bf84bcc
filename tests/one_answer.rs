//! The triangulation is a function of the set of points: whatever their order, the number of
//! threads, and whether they came at once or one by one.

use breakline::data::PointBatch;
use breakline::triangulation::geometry::Plane;
use breakline::triangulation::tds::VertexId;
use breakline::triangulation::{Delaunay, Level, spatial_order};
use testkit::random::Random;

type Point = [f64; 2];

/// The triangles by their points, in order.
fn triangles(t: &Delaunay<Plane, 3>) -> Vec<[[u64; 2]; 3]> {
    let bits = |v: VertexId| t.point(v).map(|x| (x + 0.0).to_bits());
    let of_cell = |cell| {
        let [a, b, c] = t
            .tds()
            .cell_vertices(cell)
            .to_vec()
            .try_into()
            .map(|v: [VertexId; 3]| v.map(bits))
            .unwrap();
        [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()
    };
    let mut triangles: Vec<_> = t.finite_cells().map(of_cell).collect();
    triangles.sort_unstable();
    triangles
}

fn in_bulk(points: &[Point]) -> Delaunay<Plane, 3> {
    let (t, vertices) = Delaunay::from_points(Plane::default(), points).unwrap();
    for (p, v) in points.iter().zip(vertices) {
        assert_eq!(t.point(v), p);
    }
    t
}

fn check(name: &str, mut points: Vec<Point>) {
    let first = in_bulk(&points);
    assert_eq!(first.check(Level::Law), [], "{name}");
    let expected = triangles(&first);

    let mut one_by_one = Delaunay::<Plane, 3>::new(Plane::default());
    for i in spatial_order(points.len(), |i| points[i]).unwrap() {
        one_by_one.insert(points[i as usize]).unwrap();
    }
    assert!(triangles(&one_by_one) == expected, "{name}, one by one");

    for threads in [1, 2, 4, 8] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let t = pool.install(|| in_bulk(&points));
        // Vertices and cells have the same numbers, too.
        assert!(
            t.points() == first.points() && t.tds().cells().eq(first.tds().cells()),
            "{name}, {threads} threads"
        );
        let corners = |t: &Delaunay<Plane, 3>| {
            t.tds()
                .cells()
                .map(|c| t.tds().cell_vertices(c).to_vec())
                .collect::<Vec<_>>()
        };
        assert!(corners(&t) == corners(&first), "{name}, {threads} threads");
    }
    let mut random = Random(7);
    for _ in 0..20 {
        random.shuffle(&mut points);
        assert!(triangles(&in_bulk(&points)) == expected, "{name}, shuffled");
    }
}

#[test]
fn evenly_spread_points() {
    let mut random = Random(1);
    check(
        "uniform",
        (0..40_000)
            .map(|_| [random.unit(), random.unit()])
            .collect(),
    );
}

#[test]
fn a_grid() {
    check(
        "grid",
        (0..40_000)
            .map(|i| [f64::from(i % 200), f64::from(i / 200)])
            .collect(),
    );
}

#[test]
fn points_on_a_circle_and_in_heaps() {
    let circle = (-325i32..=325)
        .flat_map(|x| (-325i32..=325).map(move |y| [x, y]))
        .filter(|[x, y]| x * x + y * y == 325 * 325);
    let mut points: Vec<Point> = circle.map(|p| p.map(f64::from)).collect();
    assert_eq!(points.len(), 60);
    let mut random = Random(2);
    for _ in 0..200 {
        let heap = [random.unit() * 1e6, random.unit() * 1e6];
        points.extend((0..100).map(|_| heap.map(|x| x + random.unit() * 1e-3)));
    }
    check("circle and heaps", points);
}

/// Coordinates in centimeters: cocircular points, and some twice.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn lidar() {
    let mut source =
        breakline::io::points::open(testkit::shared("lidar/lake_breakline/lake.laz")).unwrap();
    let mut batch = PointBatch::default();
    let mut points: Vec<Point> = Vec::new();
    loop {
        source.read(&mut batch).unwrap();
        if batch.is_empty() {
            break;
        }
        points.extend(batch.x.iter().zip(&batch.y).map(|(&x, &y)| [x, y]));
    }
    check("lidar", points);
}

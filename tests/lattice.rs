//! Triangulations of points as LAS files hold them: whole numbers of steps, without a conversion.

use breakline::data::{Lattice, PointBatch};
use breakline::triangulation::geometry::{Plane, Steps};
use breakline::triangulation::kernel::{self, Exact, InCircle, Kernel, Orientation2};
use breakline::triangulation::tds::VertexId;
use breakline::triangulation::{ConstrainedDelaunay, Delaunay, Level, OnCrossing};
use testkit::random::Random;

/// The triangles as the positions of their points, from the smallest on, in order.
fn triangles<G: breakline::triangulation::geometry::Geometry<3>>(
    t: &Delaunay<G, 3>,
    vertices: &[VertexId],
) -> Vec<[usize; 3]> {
    let mut first = vec![usize::MAX; t.vertex_count()];
    for (i, v) in vertices.iter().enumerate().rev() {
        first[v.index()] = i;
    }
    let of_cell = |cell| {
        let mut corners = t
            .tds()
            .cell_vertices(cell)
            .iter()
            .map(|v| first[v.index()])
            .collect::<Vec<_>>();
        let smallest = (0..corners.len()).min_by_key(|&i| corners[i]).unwrap();
        corners.rotate_left(smallest);
        corners.try_into().unwrap()
    };
    let mut triangles: Vec<[usize; 3]> = t.finite_cells().map(of_cell).collect();
    triangles.sort_unstable();
    triangles
}

/// As steps and as coordinates of the plane the points have one triangulation.
fn same(points: &[[i32; 3]]) {
    let (steps, vertices) = Delaunay::from_points(<Steps>::default(), points).unwrap();
    assert_eq!(steps.check(Level::Law), []);
    let sites: Vec<[f64; 2]> = points.iter().map(|p| [p[0].into(), p[1].into()]).collect();
    let (plane, of_plane) = Delaunay::from_points(<Plane>::default(), &sites).unwrap();
    assert_eq!(vertices, of_plane);
    if steps.dimension() == 2 {
        assert_eq!(triangles(&steps, &vertices), triangles(&plane, &of_plane));
    }
}

#[test]
fn steps_of_every_size() {
    let mut random = Random(1);
    for round in 0..300 {
        let size = random.pick(&[1i64, 3, 1000, 1 << 20, i64::from(i32::MAX)]);
        let count = 1 + random.index(60);
        let points: Vec<[i32; 3]> = (0..count)
            .map(|_| [(); 3].map(|()| random.around(size) as i32))
            .collect();
        same(&points);
        let ends = [i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX - 1, i32::MAX];
        if round % 10 == 0 {
            let points: Vec<[i32; 3]> = (0..count)
                .map(|_| [(); 3].map(|()| random.pick(&ends)))
                .collect();
            same(&points);
        }
    }
}

/// Cocircular to the last step, at the ends of 32 bits, where 128 do not hold an in-circle test.
#[test]
fn the_kernel_is_exact_on_whole_numbers() {
    let mut random = Random(2);
    let mut ties = 0;
    for round in 0..4000 {
        let size = random.pick(&[2i64, 1 << 15, 1 << 30, 1 << 31, 1 << 52]);
        let mut points = [(); 4].map(|()| [(); 2].map(|()| random.around(size) as f64));
        if round % 2 == 0 {
            // A rectangle, one corner of which is a step away in half of the rounds.
            let [[x0, y0], [x1, y1], ..] = points;
            points = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
            points[3][round / 2 % 2] += (round / 4 % 2) as f64;
        }
        let [a, b, c, _] = points;
        let (in_circle, orientation) = (InCircle(points), Orientation2([a, b, c]));
        assert_eq!(
            kernel::Lattice::sign(&in_circle),
            Exact::sign(&in_circle),
            "{points:?}"
        );
        assert_eq!(
            kernel::Lattice::sign(&orientation),
            Exact::sign(&orientation),
            "{points:?}"
        );
        ties += usize::from(Exact::sign(&in_circle) == breakline::triangulation::num::Sign::Zero);
    }
    assert!(ties > 500, "{ties}");
}

#[test]
fn fractions_are_refused() {
    let refused = |p: [f64; 2]| {
        Delaunay::from_points(Plane::<kernel::Lattice>::default(), &[[0.0, 0.0], p]).is_err()
    };
    assert!(refused([0.5, 1.0]) && refused([1.0, 1e300]) && refused([f64::NAN, 1.0]));
    assert!(!refused([2f64.powi(53), -3.0]));
}

#[test]
fn one_lattice_within_another() {
    let lattice = |scale: f64, offset: f64| Lattice {
        scale: [scale, scale, 0.001],
        offset: [offset, 2.0 * offset, 0.0],
    };
    let (coarse, fine) = (lattice(0.01, 500_000.0), lattice(0.001, 499_999.98));
    let embedding = coarse.embed(&fine).unwrap();
    let there = embedding.steps([7, -3, 5]).unwrap();
    assert_eq!(there, [90, 10, 5]);
    for (p, q) in coarse.point([7, -3, 5]).into_iter().zip(fine.point(there)) {
        assert!((p - q).abs() < 1e-9, "{p} {q}");
    }
    assert_eq!(fine.embed(&coarse), None, "finer steps");
    assert_eq!(
        coarse.embed(&lattice(0.003, 500_000.0)),
        None,
        "steps that are no multiples"
    );
    assert_eq!(
        coarse.embed(&lattice(0.01, 0.005)),
        None,
        "half a step between"
    );
    assert_eq!(coarse.embed(&lattice(0.01, -1e9)), None, "too far");
    assert_eq!(embedding.steps([i32::MAX, 0, 0]), None);
    assert_eq!(
        coarse
            .embed(&coarse)
            .unwrap()
            .steps([i32::MAX, i32::MIN, 0]),
        Some([i32::MAX, i32::MIN, 0])
    );
}

/// Lines that cross have their vertex on the lattice, too.
#[test]
fn crossings_are_whole_numbers() {
    let mut random = Random(3);
    for _ in 0..200 {
        let points: Vec<[f64; 2]> = (0..16)
            .map(|_| [(); 2].map(|()| random.around(20) as f64))
            .collect();
        let lines: Vec<[u32; 2]> = (0..8).map(|i| [2 * i, 2 * i + 1]).collect();
        let plane = Plane::<kernel::Lattice>::default();
        let (mut t, _) =
            ConstrainedDelaunay::<_>::from_lines(plane, &points, &lines, OnCrossing::Split)
                .unwrap();
        assert_eq!(t.check(Level::Law), [], "{points:?}");
        t.insert_lines(&[[[-21.0, -3.0], [21.0, 4.0]]]).unwrap();
        assert_eq!(t.check(Level::Law), [], "{points:?}");
        assert!(
            t.points().as_flattened().iter().all(|x| x.fract() == 0.0),
            "{points:?}"
        );
    }
}

/// All coordinates read from a tile are points of its lattice, and its steps can be triangulated.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_tile() {
    let tiles = [
        "lidar/lake_breakline/lake.laz",
        "lidar/formats/1.2-with-color.las",
        "lidar/formats/pdrf10-1.4.las",
    ];
    for tile in tiles {
        let mut source = breakline::io::points::open(testkit::shared(tile)).unwrap();
        let lattice = source.info().lattice.unwrap();
        let mut points = Vec::new();
        let mut batch = PointBatch::default();
        loop {
            source.read(&mut batch).unwrap();
            if batch.is_empty() {
                break;
            }
            let positions = (0..batch.len()).map(|i| [batch.x[i], batch.y[i], batch.z[i]]);
            points.extend(positions.map(|p| lattice.steps(p).expect("a point of the lattice")));
        }
        same(&points);
    }
}

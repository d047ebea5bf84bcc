//! Triangulations of points at the ends of floating point, and across all of it.

use breakline_triangulation::geometry::{Plane, Space};
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::{ConstrainedDelaunay, Delaunay, Level, OnCrossing, spatial_order};
use testkit::random::Random;

type Constrained = ConstrainedDelaunay<Plane<Wide>>;

fn bulk(points: &[[f64; 2]]) -> Constrained {
    let (t, _) = Constrained::from_points(Plane::default(), points).unwrap();
    assert_eq!(t.check(Level::Law), []);
    t
}

fn scaled<const D: usize>(points: &[[f64; D]], unit: f64) -> Vec<[f64; D]> {
    points.iter().map(|p| p.map(|x| x * unit)).collect()
}

/// Scaling by a power of two changes neither the order along the curve nor any cell.
#[test]
fn thousands_of_points_of_one_size() {
    let mut random = Random(1);
    // Whole numbers, so that subnormal numbers can represent them, too.
    for side in [1 << 36, 40] {
        let points: Vec<[f64; 2]> = (0..2000)
            .map(|_| [(); 2].map(|()| random.around(side) as f64))
            .collect();
        let expected = bulk(&points);
        let order = spatial_order(points.len(), |i| points[i]).unwrap();
        for unit in [
            2f64.powi(980),
            f64::from_bits(1),
            2f64.powi(-1000),
            2f64.powi(-300),
        ] {
            let points = scaled(&points, unit);
            assert_eq!(
                spatial_order(points.len(), |i| points[i]).unwrap(),
                order,
                "{unit:e}"
            );
            let t = bulk(&points);
            assert!(
                t.tds()
                    .cells()
                    .map(|c| t.tds().corners(c))
                    .eq(expected.tds().cells().map(|c| expected.tds().corners(c)))
            );
            let (one_by_one, _) = Delaunay::from_points(Plane::<Wide>::default(), &points).unwrap();
            assert_eq!(one_by_one.check(Level::Law), []);
            assert_eq!(one_by_one.finite_cells().count(), t.finite_cells().count());
        }
    }
}

#[test]
fn points_of_every_size_at_once() {
    let mut random = Random(2);
    let mut any = || loop {
        let x = f64::from_bits(random.bits());
        if x.is_finite() {
            return x;
        }
    };
    let points: Vec<[f64; 2]> = (0..300).map(|_| [any(), any()]).collect();
    let t = bulk(&points);
    let (one_by_one, _) = Delaunay::from_points(Plane::<Wide>::default(), &points).unwrap();
    assert_eq!(one_by_one.check(Level::Law), []);
    assert_eq!(one_by_one.finite_cells().count(), t.finite_cells().count());
}

#[test]
fn the_largest_box_there_is() {
    let ends = [-f64::MAX, -1e300, 0.0, 5e-324, f64::MAX];
    let points: Vec<[f64; 2]> = ends.iter().flat_map(|&x| ends.map(|y| [x, y])).collect();
    assert_eq!(bulk(&points).vertex_count(), 25);
}

#[test]
fn in_space() {
    let mut random = Random(3);
    let points: Vec<[f64; 3]> = (0..150)
        .map(|_| [(); 3].map(|()| random.around(1 << 30) as f64))
        .collect();
    for unit in [2f64.powi(990), f64::from_bits(1)] {
        let (t, _) =
            Delaunay::from_points(Space::<Wide>::default(), &scaled(&points, unit)).unwrap();
        assert_eq!(t.check(Level::Law), []);
    }
}

/// Near zero the default kernel has a smallest step: where lines cross between two steps, the
/// crossing is one of these.
#[test]
fn crossings_near_the_smallest_numbers_that_are_admitted() {
    let mut random = Random(5);
    let smallest = 2f64.powi(-160);
    let mut crossings = 0;
    for round in 0..400 {
        let ulp = [0.0, f64::EPSILON, 0.125][round % 3];
        let mut coordinate = || {
            let x = random.around(3) as f64;
            x * smallest * (1.0 + ulp * random.below(4) as f64)
        };
        let points: Vec<[f64; 2]> = (0..12).map(|_| [coordinate(), coordinate()]).collect();
        let lines: Vec<[u32; 2]> = (0..6).map(|i| [2 * i, 2 * i + 1]).collect();
        let plane: Plane = Plane::default();
        let (t, _) =
            ConstrainedDelaunay::<_>::from_lines(plane, &points, &lines, OnCrossing::Split)
                .unwrap();
        assert_eq!(t.check(Level::Law), [], "{points:?}");
        crossings += t.crossings().len();
    }
    assert!(crossings > 400, "{crossings}");
}

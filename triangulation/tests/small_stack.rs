//! Work on threads with little stack: no recursion is as deep as the input is large.

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::{ConstrainedDelaunay, Delaunay};

/// The stack of a thread of rayon and of the standard library, in KiB.
const USUAL: usize = 2048;

/// An eighth of it.
const SMALL: usize = 256;

fn on_stack(kib: usize, work: impl FnOnce() + Send + 'static) {
    std::thread::Builder::new()
        .stack_size(kib << 10)
        .spawn(work)
        .unwrap()
        .join()
        .unwrap();
}

/// Points that come closer and closer to the origin, by a factor of two each time: a divide and
/// conquer that halves squares splits off one point at a time.
fn closer_and_closer(powers: std::ops::Range<i32>) -> Vec<[f64; 2]> {
    let powers = powers.map(|k| 2f64.powi(k));
    powers
        .flat_map(|r| [[r, 0.0], [-r, r / 2.0], [r, r], [0.0, -r]])
        .collect()
}

#[test]
fn bulk_construction_of_points_that_come_closer_and_closer() {
    on_stack(USUAL, || {
        for order in [1, 7] {
            let points = closer_and_closer(-160..199);
            let n = points.len();
            let points: Vec<_> = (0..n).map(|i| points[i * order % n]).collect();
            let (delaunay, _) = Delaunay::from_points(Plane::new(), &points).unwrap();
            assert_eq!(delaunay.vertex_count(), points.len());
            // Nearly all powers that there are.
            let points = closer_and_closer(-1000..1000);
            let (delaunay, _) = Delaunay::from_points(Plane::<Wide>::default(), &points).unwrap();
            assert_eq!(delaunay.vertex_count(), points.len());
        }
    });
}

#[test]
fn points_on_a_line_on_a_spiral_and_in_a_grid() {
    on_stack(SMALL, || {
        let line = (0..20_000).map(|i| [f64::from(i), 0.0]);
        let spiral = (0..20_000).map(|i| {
            let (r, angle) = (f64::from(i).sqrt(), f64::from(i) * 0.01);
            [r * angle.cos(), r * angle.sin()]
        });
        let grid = (0..20_000).map(|i| [f64::from(i % 141), f64::from(i / 141)]);
        for points in [line.collect::<Vec<_>>(), spiral.collect(), grid.collect()] {
            assert!(Delaunay::from_points(Plane::<Wide>::default(), &points).is_ok());
            let mut one_by_one = Delaunay::new(Plane::<Wide>::default());
            points[..2000]
                .iter()
                .for_each(|&p| assert!(one_by_one.insert(p).is_ok()));
        }
    });
}

#[test]
fn a_long_line_across_many_others() {
    on_stack(SMALL, || {
        let teeth = (0..3000).map(|i| vec![[f64::from(i), -1.0], [f64::from(i), 1.0]]);
        let lines: Vec<Vec<[f64; 2]>> = teeth.chain([vec![[-5.0, 0.0], [3005.0, 0.1]]]).collect();
        let mut triangulation = ConstrainedDelaunay::<_>::new(Plane::<Wide>::default());
        triangulation.insert_lines(&lines).unwrap();
        assert_eq!(triangulation.crossings().len(), 3000);
    });
}

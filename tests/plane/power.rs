//! Power diagrams: against all bisectors, and the law that cells tile; nearest points by power against all points.

use crate::common::random::Random;
use crate::polygon::{area, part};
use breakline::geometry::{Geometry, Weighted};
use breakline::kernel::Adaptive;
use breakline::tds::VertexId;
use breakline::triangulation::Regular;

type Point = [f64; 3];
type Weights = Regular<Weighted>;

fn build(dice: &mut Random, round: usize) -> Weights {
    let (side, weights) = (1 + dice.below(6), 1 + dice.below(9));
    let place = |dice: &mut Random| match round % 3 {
        0 => [dice.unit() * 5.0, dice.unit() * 5.0, dice.unit() * 4.0],
        1 => [dice.below(side) as f64, dice.below(side) as f64, dice.below(weights) as f64],
        _ => [dice.below(side) as f64, 2.0, dice.below(weights) as f64], // on one line
    };
    let points: Vec<Point> = (0..1 + dice.below(20)).map(|_| place(dice)).collect();
    Regular::from_points(Weighted::<Adaptive>::default(), &points).unwrap().0
}

fn power(p: &Point, x: [f64; 2]) -> f64 {
    (x[0] - p[0]).powi(2) + (x[1] - p[1]).powi(2) - p[2]
}

#[test]
fn cells_tile_and_are_cut_by_all_bisectors() {
    let mut dice = Random(1);
    let window = [[-1.0, -1.5], [7.0, -1.0], [6.5, 6.0], [-2.0, 7.0]];
    let whole = area(&window);
    for round in 0..1500 {
        let t = build(&mut dice, round);
        let mut sum = 0.0;
        for v in t.tds().vertices() {
            let cell = t.power_cell(v, &window);
            let others = t.tds().vertices().filter(|&u| u != v);
            let naive =
                others.fold(window.to_vec(), |left, u| part(&left, |x| power(t.point(v), x) - power(t.point(u), x)));
            assert!((cell.area - area(&naive)).abs() < 1e-9 * whole, "{:?}", t.points());
            sum += cell.area;
        }
        assert!((sum - whole).abs() < 1e-9 * whole, "{:?}", t.points());
        assert!(t.hidden().all(|v| t.power_cell(v, &window).corners.is_empty()));
    }
}

#[test]
fn the_nearest_by_power() {
    let mut dice = Random(2);
    for round in 0..1500 {
        let t = build(&mut dice, 1 + round % 2);
        for _ in 0..20 {
            // Halves: all sums below are exact.
            let q = [dice.below(14) as f64 / 2.0 - 1.0, dice.below(14) as f64 / 2.0 - 1.0];
            let far = |v: &VertexId| power(t.point(*v), q);
            let order = |a: &VertexId, b: &VertexId| t.geometry().compare(t.point(*a), t.point(*b));
            let seen = t.tds().vertices().min_by(|a, b| far(a).total_cmp(&far(b)).then(order(a, b)));
            assert_eq!(t.nearest(&[q[0], q[1], 77.0]), seen, "{q:?} {:?}", t.points());
            let least = far(&seen.unwrap());
            assert!(t.hidden().all(|v| far(&v) >= least), "{q:?} {:?}", t.points());
        }
    }
}

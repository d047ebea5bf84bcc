//! Delaunay triangulations of points on tiny grids, where ties are the rule.

use breakline_triangulation::Delaunay;
use breakline_triangulation::geometry::Plane;
use testkit::random::Random;

pub(crate) type Point = [f64; 2];
pub(crate) type Free = Delaunay<Plane, 3>;

pub(crate) fn build(points: &[Point]) -> Free {
    Delaunay::from_points(Plane::default(), points).unwrap().0
}

pub(crate) fn grid_point(dice: &mut Random, side: u64) -> Point {
    [0, 1].map(|_| dice.below(side) as f64)
}

/// Returns even sites of a grid, so that odd ones lie between; every fourth time on one line.
pub(crate) fn points(dice: &mut Random, round: usize) -> Vec<Point> {
    let side = 1 + dice.below(5);
    let count = dice.below(20);
    let mut points: Vec<Point> = (0..count)
        .map(|_| grid_point(dice, side).map(|x| 2.0 * x))
        .collect();
    if round.is_multiple_of(4) {
        points
            .iter_mut()
            .for_each(|p| p[1] = if round.is_multiple_of(8) { p[0] } else { 4.0 });
    }
    points
}

/// Returns a site on that grid or between, or a bit outside.
pub(crate) fn site(dice: &mut Random) -> Point {
    grid_point(dice, 13).map(|x| x - 2.0)
}

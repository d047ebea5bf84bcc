//! Holds the filter against exact arithmetic, and gives the builder predicates that contradict each
//! other.

use std::cmp::Ordering;

use testkit::random::Random;

use crate::geometry::{Coordinates, Geometry, Space};
use crate::kernel::{Adaptive, Fast, InSphere, Kernel, Orientation3, PowerTest3};
use crate::num::Sign;

use super::super::Grain;
use super::build;
use super::order::rounds;
use super::sphere::{self, Frame, Origin};

const FRAME: Frame = Frame { middle: [0.0; 3], scale: 1.0 };

/// Returns a number whose magnitude is spread over `2^-exponents..1`, of either sign.
fn spread(random: &mut Random, exponents: usize) -> f64 {
    let size = 2f64.powi(-(random.index(exponents) as i32)) * (0.5 + 0.5 * random.unit());
    if random.below(2) == 0 { size } else { -size }
}

/// Returns the exact side, and the sure side if there is one, of `q` and the sphere through four
/// points.
fn sides_of(points: [[f64; 3]; 4], q: [f64; 3]) -> (Sign, Option<Sign>) {
    let exact = Adaptive::sign(&InSphere([points[0], points[1], points[2], points[3], q]));
    let [points, [q, ..]] = [points, [q; 4]].map(|points| points.map(|[x, y, z]| [x, y, z, 0.0]));
    let (exact_by_power, sure) = powers_of(points, q, 0.0, 0.0);
    assert_eq!(exact_by_power, exact * Adaptive::sign(&Orientation3(points.map(site))));
    (exact_by_power, sure)
}

fn site([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// Returns the exact side, and the sure side if there is one, of `q` and the sphere orthogonal to
/// four points with weights between `greatest` and `greatest - range`.
fn powers_of(points: [[f64; 4]; 4], q: [f64; 4], greatest: f64, range: f64) -> (Sign, Option<Sign>) {
    let [a, b, c, d] = points;
    let arrows = [a, b, c].map(|p| {
        let [x, y, z, square] = sphere::arrow(site(d), site(p));
        [x, y, z, square - (p[3] - d[3])]
    });
    let lack = |p: [f64; 4]| (greatest - p[3]) * FRAME.scale * FRAME.scale;
    let origin = Origin { at: FRAME.of(site(d)), lack: lack(d), range };
    let row = sphere::through([arrows; 4], origin, FRAME.scale)[0];
    let query = sphere::query(FRAME.of(site(q)), lack(q));
    let sides = sphere::sides([row; 4], query);
    assert_eq!(sides.marked, 0);
    let exact = Adaptive::sign(&PowerTest3([a, b, c, d, q])) * Adaptive::sign(&Orientation3(points.map(site)));
    let sure = (sides.sure & 1 == 1).then_some(if sides.inside & 1 == 1 { Sign::Positive } else { Sign::Negative });
    assert_eq!(sphere::is_inside(row, query), sure == Some(Sign::Positive));
    (exact, sure)
}

/// Points close to the sphere, at any relative distance; spheres of all sizes; tetrahedra from
/// regular ones to slivers.
#[test]
fn what_is_sure_is_right() {
    let mut random = Random(3);
    let (mut sure, mut sure_inside, rounds) = (0, 0, 200_000);
    for _ in 0..rounds {
        let center = [0, 1, 2].map(|_| 0.5 * spread(&mut random, 12));
        let radius = spread(&mut random, 20).abs() * 0.5;
        let flat = spread(&mut random, 24);
        let mut on_sphere = |near: f64| {
            let v = [0, 1, 2].map(|_| random.unit() - 0.5);
            let v = [v[0], v[1], v[2] * near];
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt().max(1e-3);
            [0, 1, 2].map(|axis| center[axis] + radius * v[axis] / length)
        };
        let points = [0; 4].map(|_| on_sphere(flat));
        let at = on_sphere(1.0);
        let off = spread(&mut random, 30);
        let q = [0, 1, 2].map(|axis| (center[axis] + (at[axis] - center[axis]) * (1.0 + off)).clamp(-1.0, 1.0));
        let (exact, decided) = sides_of(points, q);
        if let Some(decided) = decided {
            assert_eq!(decided, exact, "{points:?} {q:?}");
            sure += 1;
            sure_inside += usize::from(decided == Sign::Positive);
        }
    }
    assert!(sure > rounds / 4 && sure_inside > rounds / 20, "{sure} and {sure_inside} of {rounds}: hardly a test");
}

/// Weights that differ by as much as the squared distances do, or by far more or less; positions of
/// all distances; some points close to the sphere, because their weights are chosen so.
#[test]
fn what_is_sure_of_weights_is_right() {
    let mut random = Random(5);
    let (mut sure, mut sure_inside, rounds) = (0, 0, 200_000);
    for _ in 0..rounds {
        let (size, flat, range) =
            (spread(&mut random, 12).abs(), spread(&mut random, 20).abs(), spread(&mut random, 30).abs());
        let middle = [0; 3].map(|_| (1.0 - size) * (2.0 * random.unit() - 1.0));
        let greatest = if random.below(2) == 0 { 0.0 } else { spread(&mut random, 6) };
        let lowest = if random.below(4) == 0 { 1e-3 } else { 1.0 };
        let mut point = |flat: f64| {
            let [x, y, z] = [1.0, 1.0, flat].map(|most| size * most * (2.0 * random.unit() - 1.0));
            [middle[0] + x, middle[1] + y, middle[2] + z, greatest - range * lowest * random.unit()]
        };
        let points = [0; 4].map(|_| point(flat));
        let mut q = point(1.0);
        // Moves the weight of q toward the sphere, as far as floating point can.
        let power = |w: f64| PowerTest3([points[0], points[1], points[2], points[3], [q[0], q[1], q[2], w]]);
        let (mut low, mut high) = (greatest - range, greatest);
        let sign = Adaptive::sign(&power(low));
        for _ in 0..random.below(40) {
            let mid = 0.5 * (low + high);
            if Adaptive::sign(&power(mid)) == sign { low = mid } else { high = mid }
        }
        q[3] = if random.below(2) == 0 { low } else { high };
        let (exact, decided) = powers_of(points, q, greatest, range);
        if let Some(decided) = decided {
            assert_eq!(decided, exact, "{points:?} {q:?}");
            sure += 1;
            sure_inside += usize::from(decided == Sign::Positive);
        }
    }
    assert!(sure > rounds / 8 && sure_inside > rounds / 50, "{sure} and {sure_inside} of {rounds}: hardly a test");
}

#[test]
fn nothing_is_sure_of_a_flat_cell_or_an_infinite_one() {
    let (a, b, c, d) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.25, 0.0]);
    assert_eq!(sides_of([a, b, c, d], [0.1, 0.2, 0.3]).1, None);
    let arrows = [a, b, [f64::NAN; 3]].map(|p| sphere::arrow(d, p));
    let row = sphere::through([arrows; 4], Origin { at: d, lack: 0.0, range: 0.0 }, 1.0)[0];
    assert!(row[3].is_nan() && !sphere::is_marked(row));
}

#[test]
fn an_order_has_each_rank_once() {
    for count in [0, 1, 2, 999, 1001, 8001, 100_000] {
        let mut order = rounds(count);
        // All rounds but the last have an eighth of the points, from all over the curve.
        let sampled = order.iter().take(count / 8).filter(|&&rank| (rank as usize) < count / 2).count();
        assert!(count < 100_000 || sampled.abs_diff(count / 16) < count / 200, "{sampled}");
        order.sort_unstable();
        assert!(order.into_iter().eq(0..count as u32));
    }
}

/// Predicates of points, and sites that are elsewhere.
struct Contradictory;

impl Geometry<4> for Contradictory {
    type Point = [f64; 3];

    fn admits(&self, _: &[f64; 3]) -> bool {
        true
    }

    fn compare(&self, p: &[f64; 3], q: &[f64; 3]) -> Ordering {
        Space::new().compare(p, q)
    }

    fn orientation(&self, simplex: [&[f64; 3]; 4]) -> Sign {
        Space::new().orientation(simplex)
    }

    fn side_of_sphere(&self, simplex: [&[f64; 3]; 4], q: &[f64; 3]) -> Sign {
        Space::new().side_of_sphere(simplex, q)
    }

    fn orientation_in_flat(&self, simplex: &[&[f64; 3]]) -> Sign {
        Space::new().orientation_in_flat(simplex)
    }

    fn side_of_sphere_in_flat(&self, simplex: &[&[f64; 3]], q: &[f64; 3]) -> Sign {
        Space::new().side_of_sphere_in_flat(simplex, q)
    }
}

impl Coordinates<4> for Contradictory {
    type Coordinates = [f64; 3];

    fn coordinates(&self, p: &[f64; 3]) -> [f64; 3] {
        *p
    }

    fn exact_site(&self, [x, y, z]: &[f64; 3]) -> Option<[f64; 4]> {
        Some([x + 0.3 * (7.0 * y).sin(), y - 0.4 * (5.0 * z + x).cos(), z * x, 0.0])
    }
}

#[test]
fn contradictions_end_construction_and_nothing_else() {
    let mut random = Random(4);
    let (mut built, rounds) = ([0, 0], 4_000);
    for round in 0..rounds {
        let count = 5 + random.index(if round % 8 == 0 { 300 } else { 40 });
        let side = if round % 2 == 0 { 4 } else { 1 << 20 };
        let points: Vec<[f64; 3]> = (0..count).map(|_| [0; 3].map(|_| random.below(side) as f64 * 0.1)).collect();
        let grain = Grain::default();
        let results = [build(&Contradictory, &points, grain), build(&Space::<Fast>::default(), &points, grain)];
        for (built, result) in built.iter_mut().zip(results) {
            *built += usize::from(result.is_some());
        }
    }
    assert!(built[0] < rounds, "hardly a test");
}

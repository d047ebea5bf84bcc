//! Compares predicates with exact rational numbers: every kernel returns the sign of the real
//! number, and a filter that is certain is right.
//!
//! The judge shares nothing with the crate: other numbers (`dashu-ratio`) and other formulas
//! (determinants of homogeneous coordinates by expansion, circumcenters).

mod weighted;

use breakline_triangulation::geometry::{Crossing, Geometry, Plane};
use breakline_triangulation::kernel::{
    Adaptive, CompareDistance, ErrorBound, Exact, Expansions, Filter, Fixed, FixedBound,
    FlooredErrorBound, InCircle, InCircleOfPlane, InSphere, Interval, IntervalBound, Kernel,
    Lattice, OnFineLattice, OnLattice, Orientation2, Orientation3, PairBound, Predicate, RANGE,
    Scaled, Wide, crossing, twice_area,
};
use breakline_triangulation::num::Sign;
use dashu_ratio::RBig;
use testkit::random::{Random, ulps};

fn rational(x: f64) -> RBig {
    RBig::try_from(x).unwrap()
}

fn sign(x: &RBig) -> Sign {
    x.cmp(&RBig::ZERO).into()
}

/// Coordinates as whole numbers of a common unit: fast to compute with, and no sign depends on the
/// unit.
fn whole<const D: usize, const N: usize>(points: [[f64; D]; N]) -> [[RBig; D]; N] {
    let exponent = |x: &f64| (x.to_bits() >> 52 & 0x7ff).max(1) as i32 - 1075;
    let lowest = points
        .iter()
        .flatten()
        .filter(|x| **x != 0.0)
        .map(exponent)
        .min()
        .unwrap_or(0);
    let unit = [lowest / 2, lowest - lowest / 2].map(|half| rational(2f64.powi(half)));
    points.map(|p| p.map(|x| rational(x) / &unit[0] / &unit[1]))
}

fn determinant(rows: &[Vec<RBig>]) -> RBig {
    let Some((first, rest)) = rows.split_first() else {
        return RBig::ONE;
    };
    let mut sum = RBig::ZERO;
    for (column, x) in first.iter().enumerate() {
        let minor: Vec<Vec<RBig>> = rest
            .iter()
            .map(|row| [&row[..column], &row[column + 1..]].concat())
            .collect();
        let term = x * determinant(&minor);
        sum = if column % 2 == 0 {
            sum + term
        } else {
            sum - term
        };
    }
    sum
}

fn length<const D: usize>(p: &[RBig; D]) -> RBig {
    p.iter().fold(RBig::ZERO, |sum, x| sum + x * x)
}

/// A predicate on `N` points in `D` dimensions, and its judge.
trait Question<const D: usize, const N: usize>: Predicate {
    fn of(points: [[f64; D]; N]) -> Self;
    fn judge(points: [[f64; D]; N]) -> Sign;
}

impl Question<2, 3> for Orientation2 {
    fn of(points: [[f64; 2]; 3]) -> Self {
        Orientation2(points)
    }

    fn judge(points: [[f64; 2]; 3]) -> Sign {
        sign(&determinant(
            &whole(points).map(|[x, y]| vec![x, y, RBig::ONE]),
        ))
    }
}

impl Question<2, 4> for InCircle {
    fn of(points: [[f64; 2]; 4]) -> Self {
        InCircle(points)
    }

    fn judge(points: [[f64; 2]; 4]) -> Sign {
        let row = |p: [RBig; 2]| {
            let lift = length(&p);
            let [x, y] = p;
            vec![x, y, lift, RBig::ONE]
        };
        sign(&determinant(&whole(points).map(row)))
    }
}

impl Question<3, 4> for Orientation3 {
    fn of(points: [[f64; 3]; 4]) -> Self {
        Orientation3(points)
    }

    fn judge(points: [[f64; 3]; 4]) -> Sign {
        sign(&determinant(
            &whole(points).map(|[x, y, z]| vec![RBig::ONE, x, y, z]),
        ))
    }
}

impl Question<3, 5> for InSphere {
    fn of(points: [[f64; 3]; 5]) -> Self {
        InSphere(points)
    }

    fn judge(points: [[f64; 3]; 5]) -> Sign {
        let row = |p: [RBig; 3]| {
            let lift = length(&p);
            let [x, y, z] = p;
            vec![RBig::ONE, lift, x, y, z]
        };
        sign(&determinant(&whole(points).map(row)))
    }
}

impl<const D: usize> Question<D, 3> for CompareDistance<D> {
    fn of(points: [[f64; D]; 3]) -> Self {
        CompareDistance(points)
    }

    fn judge(points: [[f64; D]; 3]) -> Sign {
        let [from, p, q] = whole(points);
        let to = |p: [RBig; D]| length::<D>(&std::array::from_fn(|k| &p[k] - &from[k]));
        to(p).cmp(&to(q)).into()
    }
}

/// Counts of what the filters returned.
#[derive(Debug, Default)]
struct Tally {
    asked: usize,
    ties: usize,
    by_error_bound: usize,
    on_lattice: usize,
    on_fine_lattice: usize,
    by_floored: usize,
    by_interval: usize,
    by_pairs: usize,
    not_by_pairs: usize,
    fixed: usize,
    by_fixed: usize,
    scaled: usize,
}

fn coordinates<P: Predicate>(predicate: &P) -> impl Iterator<Item = f64> {
    (0..P::AXES).flat_map(|axis| predicate.axis(axis))
}

/// Asserts that the result is right, if the kernel is proven for the coordinates.
fn right<K: Kernel, P: Predicate>(
    predicate: &P,
    expected: Sign,
    context: &impl std::fmt::Debug,
) -> usize {
    let is_admitted = coordinates(predicate).all(|x| K::RANGE.admits(x));
    assert!(
        !is_admitted || K::sign(predicate) == expected,
        "{context:?}: {:?} is wrong",
        K::default()
    );
    usize::from(is_admitted)
}

/// Asserts that the filter is certain and right, if it is proven for the coordinates.
fn certain<F: Filter, P: Predicate>(
    predicate: &P,
    expected: Sign,
    context: &impl std::fmt::Debug,
) -> usize {
    if !coordinates(predicate).all(|x| F::RANGE.admits(x)) {
        return 0;
    }
    let answer = F::try_sign(predicate);
    assert!(
        answer.is_none_or(|sign| sign == expected),
        "{context:?}: {answer:?} for {expected:?}"
    );
    usize::from(answer.is_some())
}

impl Tally {
    /// Evaluates every kernel and every filter.
    fn ask<P: Question<D, N>, const D: usize, const N: usize>(&mut self, points: [[f64; D]; N]) {
        self.compare(&P::of(points), P::judge(points), &points);
    }

    /// Compares every kernel and every filter with the expected sign.
    fn compare<P: Predicate>(
        &mut self,
        predicate: &P,
        expected: Sign,
        context: &impl std::fmt::Debug,
    ) {
        self.asked += 1;
        self.ties += usize::from(expected == Sign::Zero);
        assert_eq!(Exact::sign(predicate), expected, "{context:?}");
        assert_eq!(Wide::sign(predicate), expected, "{context:?}");
        right::<Adaptive, P>(predicate, expected, context);
        right::<Expansions, P>(predicate, expected, context);
        right::<Interval, P>(predicate, expected, context);
        right::<Lattice, P>(predicate, expected, context);
        right::<Fixed<31>, P>(predicate, expected, context);
        right::<Fixed<52>, P>(predicate, expected, context);
        self.fixed += right::<Fixed, P>(predicate, expected, context);
        self.by_error_bound += certain::<ErrorBound, P>(predicate, expected, context);
        self.by_floored += certain::<FlooredErrorBound, P>(predicate, expected, context);
        self.by_interval += certain::<IntervalBound, P>(predicate, expected, context);
        let by_pairs = certain::<PairBound, P>(predicate, expected, context);
        self.by_pairs += by_pairs;
        let is_tie = expected == Sign::Zero;
        self.not_by_pairs += usize::from(
            !is_tie && by_pairs == 0 && coordinates(predicate).all(|x| RANGE.admits(x)),
        );
        self.by_fixed += certain::<FixedBound<24>, P>(predicate, expected, context);
        self.scaled += certain::<Scaled<Adaptive>, P>(predicate, expected, context);
        self.on_lattice += certain::<OnLattice, P>(predicate, expected, context);
        self.on_fine_lattice += certain::<OnFineLattice, P>(predicate, expected, context);
    }
}

/// Evaluates all predicates, in two dimensions and three, for points from `coordinates`.
fn ask_all(rounds: usize, mut coordinate: impl FnMut() -> f64) -> [Tally; 5] {
    let mut tallies: [Tally; 5] = Default::default();
    for _ in 0..rounds {
        let [orientation, circle, orientation_in_space, sphere, distance] = &mut tallies;
        orientation.ask::<Orientation2, 2, 3>([(); 3].map(|()| [(); 2].map(|()| coordinate())));
        circle.ask::<InCircle, 2, 4>([(); 4].map(|()| [(); 2].map(|()| coordinate())));
        orientation_in_space
            .ask::<Orientation3, 3, 4>([(); 4].map(|()| [(); 3].map(|()| coordinate())));
        sphere.ask::<InSphere, 3, 5>([(); 5].map(|()| [(); 3].map(|()| coordinate())));
        distance.ask::<CompareDistance<2>, 2, 3>([(); 3].map(|()| [(); 2].map(|()| coordinate())));
    }
    tallies
}

#[test]
fn known_signs() {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let plan = |p: [f64; 3]| [p[0], p[1]];
    assert_eq!(Orientation2::judge([o, x, y].map(plan)), Sign::Positive);
    assert_eq!(
        InCircle::judge([o, x, y, [0.5; 3]].map(plan)),
        Sign::Positive
    );
    assert_eq!(InCircle::judge([o, x, y, [1.0; 3]].map(plan)), Sign::Zero);
    assert_eq!(Orientation3::judge([o, x, y, z]), Sign::Positive);
    assert_eq!(InSphere::judge([o, x, y, z, [0.5; 3]]), Sign::Positive);
    assert_eq!(InSphere::judge([o, x, y, z, [1.0; 3]]), Sign::Zero);
    assert_eq!(InSphere::judge([o, x, y, z, [1.1; 3]]), Sign::Negative);
    assert_eq!(
        CompareDistance::judge([o, [1.0; 3], x].map(plan)),
        Sign::Positive
    );
}

#[test]
fn ordinary_points_end_in_the_first_filter() {
    let mut random = Random(1);
    for tally in ask_all(1500, || random.unit()) {
        assert!(
            tally.by_error_bound * 1000 >= tally.asked * 999,
            "{tally:?}"
        );
        assert!(tally.by_floored >= tally.by_error_bound, "{tally:?}");
        assert!(tally.by_interval >= tally.by_error_bound, "{tally:?}");
    }
    let mut random = Random(2);
    for tally in ask_all(1500, || 500_000.0 + 0.001 * random.below(1_000_000) as f64) {
        assert!(
            tally.by_error_bound * 1000 >= tally.asked * 995,
            "{tally:?}"
        );
    }
}

#[test]
fn small_whole_numbers_are_decided_on_the_lattice() {
    for (seed, side, unit) in [
        (3, 3, 1.0),
        (4, 5, 1.0),
        (5, 4, 0.25),
        (6, 1000, 1.0 / 64.0),
    ] {
        let mut random = Random(seed);
        for tally in ask_all(1000, || unit * random.around(side) as f64) {
            assert_eq!(tally.on_lattice, tally.asked, "{tally:?}");
            assert_eq!(tally.on_fine_lattice, tally.asked, "{tally:?}");
            assert_eq!(tally.by_interval, tally.asked, "{tally:?}");
            assert!(side > 5 || tally.ties > 5, "{tally:?}");
        }
    }
}

/// At the ends of 24, 31 and 52 bits, and one step further: ties, near ties, and numbers that are
/// too large.
#[test]
fn whole_numbers_of_few_bits() {
    for bits in [24, 31, 52] {
        let mut random = Random(30 + bits);
        let end = 1i64 << bits;
        let mut tie_or_near =
            || random.pick(&[-end, end, 0, end / 2]) + random.pick(&[0, 0, 0, 0, 0, -1, 1]);
        let tallies = ask_all(3000, || tie_or_near().clamp(-end, end) as f64);
        assert!(
            tallies
                .iter()
                .all(|tally| tally.ties > 5 && (bits > 24 || tally.fixed == tally.asked)),
            "{tallies:?}"
        );
        let mut random = Random(40 + bits);
        for tally in ask_all(1500, || random.around(end) as f64) {
            assert!(
                bits > 24 || tally.by_fixed * 1000 >= tally.asked * 998,
                "{tally:?}"
            );
        }
    }
    let mut random = Random(34);
    let [orientation, .., distance] = ask_all(1000, || random.around(3) as f64);
    for tally in [orientation, distance] {
        assert_eq!(
            tally.by_fixed, tally.asked,
            "of degree 2 all is exact, ties included: {tally:?}"
        );
    }
    let range = <Fixed as Kernel>::RANGE;
    assert!(
        [0.0, -1.0, 1e7, 2f64.powi(24), -2f64.powi(24)]
            .into_iter()
            .all(|x| range.admits(x))
    );
    assert!(
        [0.5, -1e-300, 1e7 + 0.25, 2f64.powi(24) + 1.0, f64::NAN]
            .into_iter()
            .all(|x| !range.admits(x))
    );
}

#[test]
fn centimeters_far_from_the_origin() {
    for side in [3, 100] {
        let mut random = Random(7);
        ask_all(800, || {
            random.pick(&[500_000.37, 4_649_000.12]) + 0.01 * random.around(side) as f64
        });
        // Each axis near an offset of its own.
        let mut random = Random(8);
        let mut axis = 0;
        ask_all(800, || {
            axis += 1;
            [500_000.37, 4_649_000.12][axis % 2] + 0.01 * random.around(side) as f64
        });
    }
}

/// Steps of a coarse grid whose rounding makes them not quite equal: differences of 53 and 54 bits.
#[test]
fn grids_that_are_a_rounding_off() {
    let mut random = Random(9);
    ask_all(1500, || {
        random.pick(&[1.3, 2.7]) + 4.0 * random.below(4) as f64
    });
    ask_all(800, || 0.1 * random.around(4) as f64);
    // Found by a flat triangle: 13.3 and 5.3 are 2^53 + 1 units apart.
    let mut tally = Tally::default();
    tally.ask::<Orientation2, 2, 3>([[9.3, 10.7], [13.3, 14.7], [5.3, 6.7]]);
    tally.ask::<Orientation2, 2, 3>([[2f64.powi(53), 2f64.powi(53)], [0.0, 1.0], [-1.0, 0.0]]);
    assert_eq!(
        OnLattice::try_sign(&Orientation2([
            [0.0, 1.0],
            [2f64.powi(53), 1.0],
            [-1.0, 0.0]
        ])),
        None
    );
}

/// Points on a line, a circle, a plane or a sphere, each exact or off by one unit in the last
/// place.
#[test]
fn a_rounding_off_degenerate() {
    let mut random = Random(10);
    let mut tallies: [Tally; 4] = Default::default();
    for round in 0..3000 {
        let offset = [0.0, 1.0, 4_649_000.12][round % 3];
        let size = random.pick(&[0.01, 1.0, 1000.0]);
        let mut shaken = |x: f64| ulps(offset + size * x, random.around(1));
        let mut more = Random(round as u64);
        let angles: [f64; 4] = std::array::from_fn(|_| 7.0 * more.unit());
        let on_line: [[f64; 2]; 3] = {
            let [t0, t1, t2] = [(); 3].map(|()| more.unit());
            [t0, t1, t2].map(|t| [shaken(t), shaken(0.37 * t)])
        };
        let on_circle: [[f64; 2]; 4] =
            angles.map(|angle| [shaken(angle.cos()), shaken(angle.sin())]);
        let on_plane: [[f64; 3]; 4] = [(); 4].map(|()| {
            let (s, t) = (more.unit(), more.unit());
            [shaken(s), shaken(t), shaken(0.3 * s - 0.7 * t)]
        });
        let on_sphere: [[f64; 3]; 5] = [(); 5].map(|()| {
            let (angle, z) = (7.0 * more.unit(), 2.0 * more.unit() - 1.0);
            let radius = (1.0 - z * z).sqrt();
            [
                shaken(radius * angle.cos()),
                shaken(radius * angle.sin()),
                shaken(z),
            ]
        });
        let [line, circle, plane, sphere] = &mut tallies;
        line.ask::<Orientation2, 2, 3>(on_line);
        circle.ask::<InCircle, 2, 4>(on_circle);
        plane.ask::<Orientation3, 3, 4>(on_plane);
        sphere.ask::<InSphere, 3, 5>(on_sphere);
    }
    // Otherwise they were not near enough to be a test.
    assert!(
        tallies
            .iter()
            .all(|tally| 4 * tally.by_error_bound < 3 * tally.asked),
        "{tallies:?}"
    );
    // Three roundings off a tie: twice the digits can decide.
    assert!(
        tallies
            .iter()
            .all(|tally| 50 * tally.not_by_pairs <= tally.asked),
        "{tallies:?}"
    );
    assert!(
        tallies.iter().all(|tally| 2 * tally.by_pairs > tally.asked),
        "{tallies:?}"
    );
}

/// From one end of the range to the other, within one predicate.
#[test]
fn the_whole_range() {
    let mut random = Random(11);
    ask_all(400, || {
        let exponent = random.around(180) + 20;
        (random.unit() + 1.0)
            * 2f64.powi(exponent as i32).clamp(RANGE.min, RANGE.max / 2.0)
            * random.pick(&[-1.0, 1.0])
    });
    // Near the ends: products of the largest, differences of the smallest.
    let (min, max) = (RANGE.min, RANGE.max);
    let ends = [
        0.0,
        min,
        min.next_up(),
        2.0 * min,
        1.0,
        max.next_down(),
        max,
        -min,
        -min.next_up(),
        -max,
        -max.next_down(),
    ];
    ask_all(1500, || random.pick(&ends));
    ask_all(400, || {
        min * (1.0 + random.unit()) * random.pick(&[-1.0, 1.0])
    });
    ask_all(400, || {
        max * (1.0 - 0.5 * random.unit()) * random.pick(&[-1.0, 1.0])
    });
    ask_all(400, || {
        ulps(min, random.below(4) as i64) * random.pick(&[-1.0, 1.0])
    });
    ask_all(400, || {
        ulps(max, -(random.below(4) as i64)) * random.pick(&[-1.0, 1.0])
    });
    ask_all(400, || {
        random.pick(&[ulps(min, 1), ulps(min, 3), max, max / 2.0, -max])
    });
    let step = min * f64::EPSILON;
    ask_all(400, || step * random.around(3) as f64);
    ask_all(400, || step * random.around(1 << 40) as f64);
    ask_all(400, || {
        random.pick(&[step, -step, 3.0 * step, 0.0, min, 2.0 * min, max, -max])
    });
    assert!(
        RANGE.admits(step)
            && RANGE.admits(-3.0 * step)
            && !RANGE.admits(step / 2.0)
            && !RANGE.admits(1.5 * step)
    );
    assert!(!RANGE.admits(min.next_down()) && !RANGE.admits(max.next_up()));
    assert!(RANGE.admits(min) && RANGE.admits(-max) && RANGE.admits(-0.0));
}

/// Where only some kernels are proven.
#[test]
fn every_finite_number() {
    let mut random = Random(12);
    let pool = [
        0.0,
        5e-324,
        1.5e-323,
        1e-310,
        f64::MIN_POSITIVE,
        1e-300,
        1.0,
        3.0,
        1e300,
        f64::MAX,
        f64::MAX / 2.0,
    ];
    ask_all(250, || random.pick(&pool) * random.pick(&[-1.0, 1.0]));
    ask_all(250, || 5e-324 * random.around(3) as f64);
    ask_all(250, || f64::MAX / 4.0 * random.around(3) as f64);
    ask_all(250, || {
        Some(f64::from_bits(random.bits()))
            .filter(|x| x.is_finite())
            .unwrap_or(0.0)
    });
}

/// Exponents for which products underflow, overflow, or nearly do, alone and mixed.
#[test]
fn the_edges_of_floating_point() {
    let mut random = Random(16);
    let power = |exponent: i64| {
        2f64.powi((exponent / 2) as i32) * 2f64.powi((exponent - exponent / 2) as i32)
    };
    let edges = [
        -1074, -1000, -700, -540, -512, -358, -270, -215, -200, -161, -160, -107, 0, 200, 255, 340,
        511, 1000,
    ];
    for _ in 0..20 {
        let exponents = [
            random.pick(&edges),
            random.pick(&edges),
            random.pick(&edges),
        ];
        ask_all(12, || {
            let unit = power(random.pick(&exponents) + random.around(1));
            let fraction = random.unit();
            unit * (1.0 + random.pick(&[0.0, 0.5, fraction])) * random.pick(&[-1.0, 0.0, 1.0])
        });
    }
    // Steps of one size around an origin of another: differences smaller than any coordinate.
    for &exponent in &edges {
        let unit = power(exponent);
        let origin = random.pick(&[
            0.0,
            power((exponent + 50).min(1020)),
            power((exponent + 20).min(1020)),
        ]);
        ask_all(12, || origin + unit * random.around(4) as f64);
    }
}

/// All of one size, anywhere: a power of two scales them to where floating point is certain.
#[test]
fn one_size_is_scaled() {
    for scale in [1e300, f64::MAX / 2.0, 1e-300] {
        let mut random = Random(17);
        for tally in ask_all(200, || scale * (random.unit() - 0.5)) {
            assert_eq!(tally.scaled, tally.asked, "{tally:?}");
        }
    }
    let mut random = Random(18);
    for tally in ask_all(200, || 5e-324 * random.around(1 << 40) as f64) {
        assert_eq!(tally.scaled, tally.asked, "{tally:?}");
    }
}

#[test]
fn swapping_two_points_flips_the_sign() {
    fn flips<P: Question<D, N>, const D: usize, const N: usize>(
        points: [[f64; D]; N],
        swappable: usize,
    ) {
        fn signs<P: Predicate>(p: &P) -> [Sign; 3] {
            [Adaptive::sign(p), Exact::sign(p), Expansions::sign(p)]
        }
        let sign = signs(&P::of(points));
        for i in 0..swappable {
            for j in 0..i {
                let mut swapped = points;
                swapped.swap(i, j);
                assert_eq!(
                    signs(&P::of(swapped)),
                    sign.map(|sign| -sign),
                    "{points:?} {i} {j}"
                );
            }
        }
    }
    let mut random = Random(13);
    for round in 0..3000 {
        let mut coordinate = || match round % 3 {
            0 => random.around(2) as f64,
            1 => 4_649_000.12 + 0.01 * random.around(4) as f64,
            _ => ulps(1.0, random.around(2)),
        };
        flips::<Orientation2, 2, 3>([(); 3].map(|()| [(); 2].map(|()| coordinate())), 3);
        flips::<InCircle, 2, 4>([(); 4].map(|()| [(); 2].map(|()| coordinate())), 3);
        flips::<Orientation3, 3, 4>([(); 4].map(|()| [(); 3].map(|()| coordinate())), 4);
        flips::<InSphere, 3, 5>([(); 5].map(|()| [(); 3].map(|()| coordinate())), 4);
    }
}

/// Four points in a common plane in space, whose circle is judged by its center.
#[test]
fn circles_in_planes_in_space() {
    let judge = |points: [[f64; 3]; 4]| -> Sign {
        let [a, b, c, d] = whole(points);
        let minus =
            |p: &[RBig; 3], q: &[RBig; 3]| -> [RBig; 3] { std::array::from_fn(|k| &p[k] - &q[k]) };
        let [bc, ca, ab] = [(&b, &c), (&c, &a), (&a, &b)].map(|(p, q)| length(&minus(p, q)));
        let weights = [
            &bc * (&ca + &ab - &bc),
            &ca * (&ab + &bc - &ca),
            &ab * (&bc + &ca - &ab),
        ];
        let total = &weights[0] + &weights[1] + &weights[2];
        let center: [RBig; 3] = std::array::from_fn(|k| {
            (&weights[0] * &a[k] + &weights[1] * &b[k] + &weights[2] * &c[k]) / &total
        });
        length(&minus(&a, &center))
            .cmp(&length(&minus(&d, &center)))
            .into()
    };
    let mut random = Random(14);
    let mut tally = Tally::default();
    while tally.asked < 4000 {
        let side = random.pick(&[2, 3, 300]);
        let unit = random.pick(&[1.0, 0.25, 2f64.powi(150), 2f64.powi(-150)]);
        let mut vector = |side: i64| [(); 3].map(|()| random.around(side));
        let (origin, u, v) = (vector(1000), vector(2), vector(2));
        let points: [[f64; 3]; 4] = [(); 4].map(|()| {
            let [i, j, _] = vector(side);
            std::array::from_fn(|k| unit * (origin[k] + i * u[k] + j * v[k]) as f64)
        });
        let [a, b, c, _] = points;
        for axes in [[0, 1], [1, 2], [2, 0]] {
            let turn = Orientation2::judge([a, b, c].map(|p| axes.map(|axis| p[axis])));
            if turn == Sign::Zero {
                continue;
            }
            let predicate = InCircleOfPlane { points, axes };
            tally.compare(&predicate, turn * judge(points), &predicate);
        }
    }
    assert!(tally.ties > 100, "{tally:?}");
}

/// Pairs of segments that cross, mostly at angles of a few roundings.
fn crossing_pairs(count: usize) -> Vec<[[f64; 2]; 4]> {
    let mut random = Random(15);
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let [x, y] = random.pick(&[[0.5, 0.25], [500_000.37, 4_649_000.12], [-3e50, 7e-40]]);
        let (size, spread) = (
            random.pick(&[1e-3, 1.0, 1e4]) * f64::abs(y),
            random.pick(&[2, 1000, 1 << 40]),
        );
        let mut end = |far: f64| {
            let [u, v] = [x + far * size, y + 0.3 * far * size];
            [u, v].map(|x| f64::from_bits((x.to_bits() as i64 + random.around(spread)) as u64))
        };
        let [a, b, c, d] = [end(0.0), end(1.0), end(0.1), end(0.9)];
        let apart = |a, b, c, d| {
            Orientation2::judge([a, b, c]) * Orientation2::judge([a, b, d]) == Sign::Negative
        };
        if [a, b, c, d].iter().flatten().all(|&x| RANGE.admits(x))
            && apart(a, b, c, d)
            && apart(c, d, a, b)
        {
            pairs.push([a, b, c, d]);
        }
    }
    pairs
}

fn exact_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> RBig {
    let [a, b, c] = [a, b, c].map(|p| p.map(rational));
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

fn positive(x: RBig) -> RBig {
    if x < RBig::ZERO { -x } else { x }
}

/// At angles of any size: areas to within two units in the last place, their quotient to within
/// three.
#[test]
fn crossings_are_right_to_the_last_bits() {
    let unit = rational(f64::EPSILON / 2.0);
    for [a, b, c, d] in crossing_pairs(3000) {
        let area = exact_area(c, d, a);
        let off = positive(rational(twice_area(c, d, a)) - &area);
        assert!(
            off <= positive(area.clone()) * &unit * rational(2.0),
            "{:?}",
            [a, b, c, d]
        );
        let expected = &area / (&area - exact_area(c, d, b));
        let off = positive(rational(crossing(a, b, c, d)) - &expected);
        assert!(
            off <= expected * &unit * rational(6.0),
            "{:?}",
            [a, b, c, d]
        );
    }
    let scales = [
        1.0,
        2f64.powi(1000),
        2f64.powi(-1000),
        f64::from_bits(1 << 14),
    ];
    let quotients = scales.map(|s| crossing([0.0, s], [0.0, -2.0 * s], [-s, 0.0], [s, 0.0]));
    assert_eq!(quotients, [1.0 / 3.0; 4]);
    assert_eq!(
        crossing(
            [0.0, -f64::MAX],
            [0.0, f64::MAX],
            [-f64::MAX, 0.0],
            [f64::MAX, 0.0]
        ),
        0.5
    );
}

#[test]
fn crossings_lie_within_a_rounding_of_both_segments() {
    let plane = Plane::<Adaptive>::default();
    let mut at_an_end = 0;
    for pair in crossing_pairs(3000) {
        let [a, b, c, d] = pair;
        let site = plane.crossing([&a, &b], [&c, &d]);
        at_an_end += usize::from(pair.contains(&site));
        assert!(plane.admits(&site));
        for (other, why) in [
            (
                plane.crossing([&b, &a], [&c, &d]),
                "the first turned around",
            ),
            (plane.crossing([&c, &d], [&a, &b]), "exchanged"),
            (plane.crossing([&d, &c], [&b, &a]), "both"),
        ] {
            assert_eq!(other, site, "{pair:?} {why}");
        }
        // A box around the site, a few units in the last place of the largest coordinate wide,
        // touches both lines.
        let reach: [f64; 2] = std::array::from_fn(|k| {
            6.0 * f64::EPSILON * pair.iter().map(|p| p[k].abs()).fold(0.0, f64::max)
        });
        for [p, q] in [[a, b], [c, d]] {
            let [dx, dy] = [0, 1].map(|k| positive(rational(q[k]) - rational(p[k])));
            let touches = dx * rational(reach[1]) + dy * rational(reach[0]);
            assert!(
                positive(exact_area(p, q, site)) <= touches,
                "{pair:?} {site:?}"
            );
        }
    }
    assert!(
        at_an_end > 100 && at_an_end < 2500,
        "{at_an_end} of 3000 are at an end"
    );
    // An exact site is kept, however near the ends are.
    let (low, high) = (1.0 - f64::EPSILON, 1.0 + f64::EPSILON);
    assert_eq!(
        plane.crossing([&[low, low], &[high, high]], [&[low, high], &[high, low]]),
        [1.0, 1.0]
    );
}

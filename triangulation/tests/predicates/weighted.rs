//! Predicates of weighted points, in the plane and in space, against exact rational numbers.

use breakline_triangulation::geometry::{Geometry, Plane, Space, Weighted, WeightedSpace};
use breakline_triangulation::kernel::{
    ComparePower, PowerInPlane, PowerOnLine, PowerTest2, PowerTest3, RANGE,
};
use breakline_triangulation::num::Sign;
use dashu_ratio::RBig;
use testkit::random::{Random, ulps};

use super::{CompareDistance, Orientation2, Question, Tally, determinant, rational, sign};

/// Returns the height of a weighted point's lift; the last coordinate is the weight.
///
/// Weights are squares, so that a unit of the coordinates is not one of the weights.
fn lift<const D: usize>(p: &[RBig; D]) -> RBig {
    let (weight, site) = p.split_last().unwrap();
    site.iter().fold(-weight, |sum, x| sum + x * x)
}

impl Question<3, 4> for PowerTest2 {
    fn of(points: [[f64; 3]; 4]) -> Self {
        PowerTest2(points)
    }

    fn judge(points: [[f64; 3]; 4]) -> Sign {
        let row = |p: [RBig; 3]| {
            let lift = lift(&p);
            let [x, y, _] = p;
            vec![x, y, lift, RBig::ONE]
        };
        sign(&determinant(&points.map(|p| row(p.map(rational)))))
    }
}

impl Question<4, 5> for PowerTest3 {
    fn of(points: [[f64; 4]; 5]) -> Self {
        PowerTest3(points)
    }

    fn judge(points: [[f64; 4]; 5]) -> Sign {
        let row = |p: [RBig; 4]| {
            let lift = lift(&p);
            let [x, y, z, _] = p;
            vec![RBig::ONE, lift, x, y, z]
        };
        sign(&determinant(&points.map(|p| row(p.map(rational)))))
    }
}

/// Asks about points on a line, of which the first comes before the second on the first axis on
/// which they differ.
impl<const D: usize> Question<D, 3> for PowerOnLine<D> {
    fn of(points: [[f64; D]; 3]) -> Self {
        let along = (0..D - 1)
            .find(|&axis| points[0][axis] != points[1][axis])
            .unwrap_or(0);
        PowerOnLine { points, along }
    }

    /// Returns a positive sign if the lift of the third point is to the right of the line from the
    /// lift of the first to that of the second.
    fn judge(points: [[f64; D]; 3]) -> Sign {
        let PowerOnLine { along, .. } = Self::of(points);
        let row = |p: [RBig; D]| vec![p[along].clone(), lift(&p), RBig::ONE];
        -sign(&determinant(&points.map(|p| row(p.map(rational)))))
    }
}

impl<const D: usize> Question<D, 3> for ComparePower<D> {
    fn of(points: [[f64; D]; 3]) -> Self {
        ComparePower(points)
    }

    fn judge(points: [[f64; D]; 3]) -> Sign {
        let [q, a, b] = points.map(|p| p.map(rational));
        let weight = D - 1;
        let power = |p: &[RBig; D]| {
            let moved: [RBig; D] = std::array::from_fn(|k| {
                if k == weight {
                    p[k].clone()
                } else {
                    &p[k] - &q[k]
                }
            });
            lift(&moved)
        };
        power(&a).cmp(&power(&b)).into()
    }
}

/// Compares [`PowerInPlane`], in each projection in which the triangle has an area, with a
/// determinant of coordinates within the plane: these are affine functions of the points.
fn ask_in_plane(tally: &mut Tally, points: [[f64; 4]; 4], within: [[f64; 2]; 4]) {
    let rows: [Vec<RBig>; 4] = std::array::from_fn(|k| {
        let [s, t] = within[k].map(rational);
        vec![s, t, lift(&points[k].map(rational)), RBig::ONE]
    });
    let turn_of = |[a, b, c, _]: [[f64; 2]; 4]| Orientation2::judge([a, b, c]);
    let is_below = sign(&determinant(&rows)) * turn_of(within);
    for axes in [[0, 1], [1, 2], [2, 0]] {
        let turn = turn_of(points.map(|p| axes.map(|axis| p[axis])));
        if turn != Sign::Zero {
            let predicate = PowerInPlane { points, axes };
            tally.compare(&predicate, turn * is_below, &predicate);
        }
    }
}

/// Small grids, where ties are the rule, near zero and far from it, with weights of either sign.
#[test]
fn weighted_points() {
    let mut random = Random(20);
    let mut tallies: [Tally; 2] = Default::default();
    for round in 0..6000 {
        let side = random.pick(&[1, 2, 3, 300]);
        let unit = random.pick(&[1.0, 0.25, 2f64.powi(9), 2f64.powi(-60), 2f64.powi(60)]);
        let heaviest = random.pick(&[0, 1, 2, side * side]);
        let origin = random.pick(&[0.0, 0.0, 1000.0, 2f64.powi(22)]);
        let weight = |random: &mut Random| unit * unit * random.around(heaviest) as f64;
        let [plane, line] = &mut tallies;
        plane.ask::<PowerTest2, 3, 4>([(); 4].map(|()| {
            let [x, y] = [(); 2].map(|()| unit * (origin + random.around(side) as f64));
            [x, y, weight(&mut random)]
        }));
        // Along a line that is vertical, or is not.
        let direction = if round % 3 == 0 {
            [0, 1]
        } else {
            [1 + random.below(2) as i64, random.around(3)]
        };
        let mut steps = [(); 3].map(|()| random.around(side));
        (steps[0], steps[1]) = (steps[0].min(steps[1]), steps[0].max(steps[1]) + 1);
        line.ask::<PowerOnLine<3>, 3, 3>(steps.map(|step| {
            let [x, y] = direction.map(|w| unit * (origin + (step * w) as f64));
            [x, y, weight(&mut random)]
        }));
    }
    assert!(
        tallies
            .iter()
            .all(|tally| tally.ties > 300 && tally.fixed > 1000),
        "{tallies:?}"
    );
}

/// Small grids in space, and planes and lines of such grids.
#[test]
fn weighted_points_in_space() {
    let mut random = Random(24);
    let mut tallies: [Tally; 5] = Default::default();
    for round in 0..3000 {
        let side = random.pick(&[1, 2, 3, 300]);
        let unit = random.pick(&[1.0, 0.25, 2f64.powi(9), 2f64.powi(-60), 2f64.powi(60)]);
        let heaviest = random.pick(&[0, 1, 2, side * side]);
        let origin = random.pick(&[0, 0, 1000, 1 << 22]);
        let weighted = |random: &mut Random, [x, y, z]: [i64; 3]| -> [f64; 4] {
            let [x, y, z] = [x, y, z].map(|x| unit * (origin + x) as f64);
            [x, y, z, unit * unit * random.around(heaviest) as f64]
        };
        let mut any = || {
            let site = [(); 3].map(|()| random.around(side));
            weighted(&mut random, site)
        };
        let [space, plane, line, power, distance] = &mut tallies;
        space.ask::<PowerTest3, 4, 5>([(); 5].map(|()| any()));
        power.ask::<ComparePower<4>, 4, 3>([(); 3].map(|()| any()));
        distance
            .ask::<CompareDistance<3>, 3, 3>([(); 3].map(|()| any()).map(|[x, y, z, _]| [x, y, z]));

        let [u, v] = [(); 2].map(|()| [(); 3].map(|()| random.around(2)));
        let steps = [(); 4].map(|()| [(); 2].map(|()| random.around(side)));
        let in_plane =
            steps.map(|[s, t]| weighted(&mut random, std::array::from_fn(|k| s * u[k] + t * v[k])));
        ask_in_plane(plane, in_plane, steps.map(|st| st.map(|x| x as f64)));

        // Along a line that differs on all axes, or on the last ones only.
        let mut direction = [
            1 + random.below(2) as i64,
            random.around(2),
            random.around(2),
        ];
        direction.rotate_right(round % 3);
        direction[..round % 3].fill(0);
        let mut steps = [(); 3].map(|()| random.around(side));
        (steps[0], steps[1]) = (steps[0].min(steps[1]), steps[0].max(steps[1]) + 1);
        line.ask::<PowerOnLine<4>, 4, 3>(
            steps.map(|step| weighted(&mut random, direction.map(|x| step * x))),
        );
    }
    assert!(
        tallies
            .iter()
            .all(|tally| tally.ties > 100 && tally.fixed > 300),
        "{tallies:?}"
    );
}

/// Lifts on a common plane, or a rounding above or below it.
#[test]
fn weights_a_rounding_off() {
    let mut random = Random(21);
    let mut tally = Tally::default();
    for round in 0..3000 {
        let offset = [0.0, 1.0, 4_649_000.12][round % 3];
        let size = random.pick(&[0.01, 1.0, 1000.0]);
        let [s, t] = [random.unit(), random.unit()];
        tally.ask::<PowerTest2, 3, 4>([(); 4].map(|()| {
            let [x, y] = [(); 2].map(|()| offset + size * random.unit());
            let (u, v) = (x - offset, y - offset);
            [x, y, ulps(u * u + v * v - s * u - t * v, random.around(1))]
        }));
    }
    assert!(10 * tally.by_error_bound < 9 * tally.asked, "{tally:?}");
}

/// Lifts on a common hyperplane, or a rounding above or below it.
#[test]
fn weights_in_space_a_rounding_off() {
    let mut random = Random(25);
    let mut tally = Tally::default();
    for round in 0..1500 {
        let offset = [0.0, 1.0, 4_649_000.12][round % 3];
        let size = random.pick(&[0.01, 1.0, 1000.0]);
        let slope = [(); 3].map(|()| random.unit());
        tally.ask::<PowerTest3, 4, 5>([(); 5].map(|()| {
            let [x, y, z] = [(); 3].map(|()| offset + size * random.unit());
            let from_offset = [x, y, z].map(|x| x - offset);
            let weight: f64 = (0..3)
                .map(|k| from_offset[k] * from_offset[k] - slope[k] * from_offset[k])
                .sum();
            [x, y, z, ulps(weight, random.around(1))]
        }));
    }
    assert!(10 * tally.by_error_bound < 9 * tally.asked, "{tally:?}");
}

/// From one end of the range, and of all finite numbers, to the other.
#[test]
fn weights_of_every_size() {
    let (min, max) = (RANGE.min, RANGE.max);
    let step = min * f64::EPSILON;
    let within = [
        0.0,
        step,
        3.0 * step,
        min,
        min.next_up(),
        2.0 * min,
        1.0,
        max.next_down(),
        max,
    ];
    let finite = [
        0.0,
        5e-324,
        1e-310,
        f64::MIN_POSITIVE,
        1e-160,
        1.0,
        3.0,
        1e150,
        1e300,
        f64::MAX,
    ];
    let mut random = Random(22);
    let mut tallies: [Tally; 2] = Default::default();
    for round in 0..1500 {
        let pool = if round % 3 == 0 {
            &finite[..]
        } else {
            &within[..]
        };
        let mut any = || random.pick(pool) * random.pick(&[-1.0, 1.0]);
        let [plane, line] = &mut tallies;
        plane.ask::<PowerTest2, 3, 4>([(); 4].map(|()| [(); 3].map(|()| any())));
        // On the diagonal, and vertical.
        let [a, b, x] = [any(), any(), any()];
        for upright in [false, true] {
            line.ask::<PowerOnLine<3>, 3, 3>([a.min(b), a.max(b), any()].map(|t| {
                if upright {
                    [x, t, any()]
                } else {
                    [t, t, any()]
                }
            }));
        }
        let mut any_within = || {
            let exponent = random.around(180) + 20;
            (random.unit() + 1.0)
                * 2f64.powi(exponent as i32).clamp(min, max / 2.0)
                * random.pick(&[-1.0, 1.0])
        };
        plane.ask::<PowerTest2, 3, 4>([(); 4].map(|()| [(); 3].map(|()| any_within())));
    }
    assert!(
        tallies.iter().all(|tally| tally.by_interval > 100),
        "{tallies:?}"
    );
}

/// Like [`weights_of_every_size`], in space, with the whole range of exponents in each predicate.
#[test]
fn weights_in_space_of_every_size() {
    let (min, max) = (RANGE.min, RANGE.max);
    let step = min * f64::EPSILON;
    let within = [
        0.0,
        step,
        3.0 * step,
        min,
        min.next_up(),
        2.0 * min,
        1.0,
        max.next_down(),
        max,
    ];
    let finite = [
        0.0,
        5e-324,
        1e-310,
        f64::MIN_POSITIVE,
        1e-160,
        1.0,
        3.0,
        1e150,
        1e300,
        f64::MAX,
    ];
    let mut random = Random(26);
    let mut tallies: [Tally; 4] = Default::default();
    for round in 0..400 {
        let pool = if round % 3 == 0 {
            &finite[..]
        } else {
            &within[..]
        };
        let mut any = || random.pick(pool) * random.pick(&[-1.0, 1.0]);
        let [space, plane, line, power] = &mut tallies;
        space.ask::<PowerTest3, 4, 5>([(); 5].map(|()| [(); 4].map(|()| any())));
        power.ask::<ComparePower<4>, 4, 3>([(); 3].map(|()| [(); 4].map(|()| any())));
        // In a plane across an axis, and in a diagonal one.
        let level = any();
        for axis in 0..4 {
            let sites = [(); 4].map(|()| [any(), any()]);
            let in_plane = sites.map(|[s, t]| {
                let [x, y, z] = [[level, s, t], [s, level, t], [s, t, level], [s, t, s]][axis];
                [x, y, z, any()]
            });
            ask_in_plane(plane, in_plane, sites);
        }
        // On a diagonal, and along the last axis.
        let (a, b) = (any(), any());
        for upright in [false, true] {
            line.ask::<PowerOnLine<4>, 4, 3>([a.min(b), a.max(b), any()].map(|t| {
                if upright {
                    [level, level, t, any()]
                } else {
                    [t, t, t, any()]
                }
            }));
        }
        let mut any_within = || {
            let exponent = random.around(180) + 20;
            (random.unit() + 1.0)
                * 2f64.powi(exponent as i32).clamp(min, max / 2.0)
                * random.pick(&[-1.0, 1.0])
        };
        space.ask::<PowerTest3, 4, 5>([(); 5].map(|()| [(); 4].map(|()| any_within())));
    }
    assert!(
        tallies.iter().all(|tally| tally.by_interval > 100),
        "{tallies:?}"
    );
}

/// Without weights the power test is the in-circle test, and on a line it is betweenness.
#[test]
fn equal_weights_do_not_count() {
    let mut random = Random(23);
    let (plane, weighted) = (Plane::new(), Weighted::new());
    for _ in 0..3000 {
        let weight = random.around(100) as f64;
        let points = [(); 4].map(|()| [(); 2].map(|()| random.around(3) as f64));
        let heavy = points.map(|[x, y]| [x, y, weight]);
        let ([a, b, c, d], [p, q, r, s]) = (points.each_ref(), heavy.each_ref());
        assert_eq!(
            weighted.side_of_sphere([p, q, r], s),
            plane.side_of_sphere([a, b, c], d),
            "{points:?}"
        );
        if plane.orientation([a, b, c]) == Sign::Zero {
            let between = plane.side_of_sphere_in_flat(&[a, b], c);
            assert!(
                a == b || weighted.side_of_sphere_in_flat(&[p, q], r) == between,
                "{points:?}"
            );
        }
    }
    let [low, middle, high] = [[0.0, 0.0, 0.0], [1.0, 1.0, -3.0], [4.0, 4.0, 0.0]];
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&high, &low], &middle),
        Sign::Positive
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low, &high], &[1.0, 1.0, -6.0]),
        Sign::Zero
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low, &high], &[1.0, 1.0, -7.0]),
        Sign::Negative
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low, &high], &[-1.0, -1.0, 11.0]),
        Sign::Positive
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low], &[0.0, 0.0, 1.0]),
        Sign::Positive,
        "on one site"
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low], &[0.0, 0.0, -1.0]),
        Sign::Negative,
        "on one site"
    );
    assert!(
        weighted.compare_weights(&low, &middle).is_gt()
            && weighted.compare(&low, &[0.0, 0.0, 9.0]).is_eq()
    );
    assert!(!weighted.admits(&[0.0, 0.0, f64::NAN]) && !weighted.admits(&[0.0, 0.0, 1e300]));
}

/// Without weights the power tests in space are the in-sphere test, the in-circle test in a plane
/// and betweenness on a line.
#[test]
fn equal_weights_do_not_count_in_space() {
    let mut random = Random(27);
    let (space, weighted) = (Space::new(), WeightedSpace::new());
    for round in 0..3000 {
        let weight = random.around(100) as f64;
        let sizes = [[3, 3, 3], [3, 3, 0], [0, 3, 3], [0, 0, 3]][round % 4];
        let points = [(); 5].map(|()| sizes.map(|size| random.around(size) as f64));
        let heavy = points.map(|[x, y, z]| [x, y, z, weight]);
        let ([a, b, c, d, e], [p, q, r, s, t]) = (points.each_ref(), heavy.each_ref());
        assert_eq!(
            weighted.orientation([p, q, r, s]),
            space.orientation([a, b, c, d]),
            "{points:?}"
        );
        assert_eq!(
            weighted.side_of_sphere([p, q, r, s], t),
            space.side_of_sphere([a, b, c, d], e),
            "{points:?}"
        );
        let turn = space.orientation_in_flat(&[a, b, c]);
        assert_eq!(weighted.orientation_in_flat(&[p, q, r]), turn, "{points:?}");
        if turn == Sign::Zero {
            let between = space.side_of_sphere_in_flat(&[a, b], c);
            assert!(
                a == b || weighted.side_of_sphere_in_flat(&[p, q], r) == between,
                "{points:?}"
            );
        } else if space.orientation([a, b, c, d]) == Sign::Zero {
            let inside = space.side_of_sphere_in_flat(&[a, b, c], d);
            assert_eq!(
                weighted.side_of_sphere_in_flat(&[p, q, r], s),
                inside,
                "{points:?}"
            );
        }
    }
    let [low, middle, high] = [[0.0; 4], [1.0, 1.0, 1.0, -6.0], [3.0, 3.0, 3.0, 0.0]];
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&high, &low], &middle),
        Sign::Zero
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low, &high], &[1.0, 1.0, 1.0, -5.0]),
        Sign::Positive
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low, &high], &[1.0, 1.0, 1.0, -7.0]),
        Sign::Negative
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low], &[0.0, 0.0, 0.0, 1.0]),
        Sign::Positive,
        "on one site"
    );
    assert_eq!(
        weighted.side_of_sphere_in_flat(&[&low], &[0.0, 0.0, 0.0, -1.0]),
        Sign::Negative,
        "on one site"
    );
    assert!(
        weighted.compare_weights(&low, &middle).is_gt()
            && weighted.compare(&low, &[0.0, 0.0, 0.0, 9.0]).is_eq()
    );
    assert!(
        !weighted.admits(&[0.0, 0.0, 0.0, f64::NAN]) && !weighted.admits(&[0.0, 0.0, 0.0, 1e300])
    );
}

//! Compares bulk construction with insertion one by one, on small and degenerate inputs, in small
//! grains.

use std::collections::BTreeSet;

use crate::flaw::Level;
use crate::geometry::{Coordinates, Geometry, Plane};
use crate::kernel::{Adaptive, Exact, Fast, InCircle, Kernel, Orientation2, Wide};
use crate::kinds::Delaunay;
use crate::num::Sign;
use crate::parallel::on_threads;
use crate::tds::{Links, VertexId};

use super::faces::Range;
use super::filter::{Arrow, Circle, PlanePredicates};
use super::{Grain, Sites, Stop, build};

const TINY: Grain = Grain {
    points: 3,
    group: 2,
    range: 3,
    stop: None,
};

type Cells = BTreeSet<[[u64; 2]; 3]>;

/// A generator of pseudo-random numbers (SplitMix64, Steele and others 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.next() % limit
    }

    /// Returns a number from 0 to 1.
    fn unit(&mut self) -> f64 {
        self.next() as f64 / u64::MAX as f64
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i as u64 + 1) as usize);
        }
    }
}

fn site(p: [f64; 2]) -> [u64; 2] {
    p.map(|x| (x + 0.0).to_bits())
}

/// Returns the finite cells, each from its least corner on.
fn cells<G: Geometry<3, Point = [f64; 2]>>(t: &Delaunay<G, 3>) -> Cells {
    let cell = |cell| {
        let mut corners = t.tds().corners(cell).map(|v| site(*t.point(v)));
        let least = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
        corners.rotate_left(least);
        corners
    };
    if t.dimension() < 2 {
        Cells::new()
    } else {
        t.finite_cells().map(cell).collect()
    }
}

fn one_by_one<G: Geometry<3, Point = [f64; 2]>>(geometry: G, points: &[[f64; 2]]) -> Cells {
    let mut t = Delaunay::new(geometry);
    for &p in points {
        t.insert(p).unwrap();
    }
    cells(&t)
}

fn in_bulk<G: Coordinates<3, Point = [f64; 2]>>(
    geometry: G,
    points: &[[f64; 2]],
    grain: Grain,
) -> Cells {
    let (sites, vertices) = Sites::of(&geometry, points, grain).unwrap();
    assert_eq!(vertices.len(), points.len());
    for (&p, v) in points.iter().zip(vertices) {
        assert_eq!(site(sites.points[v.index()]), site(p));
    }
    let distinct: BTreeSet<_> = points.iter().map(|&p| site(p)).collect();
    assert_eq!(sites.points.len(), distinct.len());
    let mut t = Delaunay::new(geometry);
    let (points, tds) = build(&t.inner.geometry, sites, grain);
    t.inner.points = points;
    if let Some(tds) = tds {
        t.inner.tds = tds;
        assert_eq!(t.check(Level::Law), []);
    }
    cells(&t)
}

/// Makes a point.
type Draw = dyn Fn(&mut Random) -> [f64; 2];

/// Generates one of many kinds of small inputs.
fn points(random: &mut Random, round: u64) -> Vec<[f64; 2]> {
    let count = 1 + random.below(if round.is_multiple_of(50) { 400 } else { 40 });
    let point: Box<Draw> = match round % 10 {
        0 => Box::new(|r| [r.unit(), r.unit()]),
        1 => Box::new(|r| [0, 1].map(|_| r.below(6) as f64)),
        2 => Box::new(|r| [0, 1].map(|_| r.below(30) as f64 * 0.37)),
        // Collinear, with a few exceptions.
        3 => Box::new(|r| {
            let x = r.below(60) as f64;
            [x, 3.0 * x + f64::from(u8::from(r.below(20) == 0))]
        }),
        // On a circle of lattice points.
        4 => Box::new(|r| {
            let [x, y] = [[3.0, 4.0], [0.0, 5.0], [4.0, 3.0], [5.0, 0.0]][r.below(4) as usize];
            [
                x * [1.0, -1.0][r.below(2) as usize],
                y * [1.0, -1.0][r.below(2) as usize],
            ]
            .map(|x| x * 13.0)
        }),
        // Neighboring floating-point numbers.
        5 => Box::new(|r| [0, 1].map(|_| f64::from_bits(1f64.to_bits() + r.below(8)))),
        // Two columns.
        6 => Box::new(|r| [1e6 * r.below(2) as f64 + 1e-9 * r.unit(), r.unit()]),
        // Clusters within clusters: more magnitudes than a key has bits.
        7 => Box::new(|r| {
            let scale = 10f64.powi(-4 * r.below(9) as i32);
            [0, 1].map(|_| scale * r.below(12) as f64)
        }),
        // Less and less dense on a parabola.
        8 => Box::new(|r| {
            let x = r.unit() - 0.5;
            [x, x * x]
        }),
        // Centimeters far from the origin.
        _ => Box::new(|r| {
            [443_000.0, 5_212_000.0].map(|x| ((x + 20.0 * r.unit()) * 100.0).round() / 100.0)
        }),
    };
    let mut points: Vec<_> = (0..count).map(|_| point(random)).collect();
    for _ in 0..random.below(4) {
        points.push(points[random.below(points.len() as u64) as usize]);
    }
    points
}

/// Evaluates predicates itself: it has no exact plans.
#[derive(Clone, Copy, Default)]
struct Closed(Plane<Adaptive>);

impl Geometry<3> for Closed {
    type Point = [f64; 2];

    fn admits(&self, p: &[f64; 2]) -> bool {
        self.0.admits(p)
    }

    fn compare(&self, p: &[f64; 2], q: &[f64; 2]) -> std::cmp::Ordering {
        self.0.compare(p, q)
    }

    fn orientation(&self, simplex: [&[f64; 2]; 3]) -> Sign {
        self.0.orientation(simplex)
    }

    fn side_of_sphere(&self, simplex: [&[f64; 2]; 3], q: &[f64; 2]) -> Sign {
        self.0.side_of_sphere(simplex, q)
    }
}

impl Coordinates<3> for Closed {
    type Coordinates = [f64; 2];

    fn coordinates(&self, p: &[f64; 2]) -> [f64; 2] {
        *p
    }
}

#[test]
fn bulk_is_one_by_one() {
    let mut random = Random(7);
    for round in 0..4000 {
        let mut points = points(&mut random, round);
        let expected = one_by_one(Plane::<Adaptive>::default(), &points);
        for threads in [1, 2] {
            random.shuffle(&mut points);
            let found = on_threads(threads, || {
                in_bulk(Plane::<Adaptive>::default(), &points, TINY)
            });
            assert_eq!(found, expected, "{points:?}");
        }
        assert_eq!(
            in_bulk(Plane::<Adaptive>::default(), &points, Grain::default()),
            expected,
            "{points:?}"
        );
        assert_eq!(
            in_bulk(Closed::default(), &points, TINY),
            expected,
            "{points:?}"
        );
        in_bulk_fast(&points);
    }
}

/// Plain floating point may say of three nearly collinear points that each is below the others.
#[test]
fn ends_with_wrong_answers() {
    let [p, q, r] = [
        [0.1893980880966567, 0.2017665473458723],
        [0.042157786093438454, 0.09911152443006584],
        [0.8196851798815653, 0.6411987881823696],
    ];
    in_bulk_fast(&[q, p, r, [0.95, 0.9], [1.0, 0.2]]);
    let mut random = Random(12);
    for _ in 0..20_000 {
        let slope = random.unit();
        let mut points: Vec<_> = (0..6)
            .map(|_| random.unit())
            .map(|x| [x, 0.07 + slope * x])
            .collect();
        points.push([0, 1].map(|_| random.unit()));
        in_bulk_fast(&points);
    }
}

/// Plain floating point may be wrong, but terminates.
fn in_bulk_fast(points: &[[f64; 2]]) {
    let (sites, _) = Sites::of(&Plane::<Fast>::default(), points, TINY).unwrap();
    build::<_, 3, (), ()>(&Plane::<Fast>::default(), sites, TINY);
}

/// Returns true if points are triangulated along an arc, as a whole.
fn is_arc(points: &[[f64; 2]]) -> bool {
    let geometry = Plane::<Adaptive>::default();
    let Sites {
        points,
        keys,
        curve,
        ..
    } = Sites::of(&geometry, points, TINY).unwrap().0;
    let predicates =
        PlanePredicates::<_, 3, true>::new(&geometry, &points, &curve, Grain::default());
    let mut faces = vec![Links::UNUSED; 2 * points.len()];
    let mut range = Range {
        predicates: &predicates,
        keys: &keys,
        first: 0,
        faces: &mut faces,
        offset: 0,
        grain: TINY,
        nesting: 0,
    };
    range.arc(0, points.len()).is_some()
}

#[test]
fn arcs_from_their_sharp_ends() {
    let mut random = Random(11);
    let mut left = 0;
    for round in 0..160 {
        let count = 200 + random.below(200);
        // The curvature falls, or rises and falls, or all lattice points lie on one circle.
        let mut arc: Vec<[f64; 2]> = match round / 8 % 4 {
            0 => (0..count)
                .map(|_| random.unit())
                .map(|x| [x, x * x])
                .collect(),
            1 => (0..count)
                .map(|_| 1.57 * random.unit())
                .map(|t| [20.0 * t.sin(), 3.0 - 3.0 * t.cos()])
                .collect(),
            2 => (0..count)
                .map(|_| 9.0 * random.unit() + 0.1)
                .map(|x| [x, 9.1 - 1.0 / x])
                .collect(),
            _ => {
                const RADIUS: i64 = 5 * 13 * 17 * 29 * 37;
                let height = |x: i64| (x, ((RADIUS * RADIUS - x * x) as f64).sqrt().round() as i64);
                let quarter = (0..=RADIUS)
                    .map(height)
                    .filter(|(x, y)| x * x + y * y == RADIUS * RADIUS);
                quarter.map(|(x, y)| [x as f64, y as f64]).collect()
            }
        };
        // On every side, in every direction.
        for p in &mut arc {
            *p = [
                p[0] * [1.0, -1.0][round & 1],
                p[1] * [1.0, -1.0][round >> 1 & 1],
            ];
            if round & 4 == 4 {
                p.swap(0, 1);
            }
        }
        random.shuffle(&mut arc);
        // A hyperbola is sharp in its middle: flips take too long, or not.
        let taken = is_arc(&arc);
        assert!(taken || round / 8 % 4 == 2, "{arc:?}");
        left += usize::from(!taken);
        for elsewhere in [0, 1, 20] {
            arc.extend((0..elsewhere).map(|_| [0, 1].map(|_| 2.0 * random.unit() - 1.0)));
            let expected = one_by_one(Plane::<Adaptive>::default(), &arc);
            assert_eq!(
                in_bulk(Plane::<Adaptive>::default(), &arc, TINY),
                expected,
                "{arc:?}"
            );
            assert_eq!(
                in_bulk(Plane::<Adaptive>::default(), &arc, Grain::default()),
                expected,
                "{arc:?}"
            );
            in_bulk_fast(&arc);
        }
    }
    assert!(left > 0);
}

#[test]
fn every_finite_coordinate_will_do() {
    let mut random = Random(8);
    for round in 0..600 {
        let mut points = points(&mut random, round);
        for scale in [1.0, 1e-300, 1e290] {
            let points: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
            let expected = one_by_one(Plane::<Wide>::default(), &points);
            assert_eq!(
                in_bulk(Plane::<Wide>::default(), &points, TINY),
                expected,
                "{points:?}"
            );
        }
        // Some within the range of filters, some not.
        points.iter_mut().step_by(3).for_each(|p| p[0] *= 1e-200);
        let expected = one_by_one(Plane::<Wide>::default(), &points);
        assert_eq!(
            in_bulk(Plane::<Wide>::default(), &points, TINY),
            expected,
            "{points:?}"
        );
    }
}

#[test]
fn the_numbers_do_not_depend_on_threads() {
    let mut random = Random(9);
    for round in 0..40 {
        let points: Vec<_> = (0..20).flat_map(|_| points(&mut random, round)).collect();
        let of = |threads: usize| {
            on_threads(threads, || {
                let geometry = Plane::<Adaptive>::default();
                let (sites, vertices) = Sites::of(&geometry, &points, TINY).unwrap();
                let (points, tds) = build::<_, 3, (), ()>(&geometry, sites, TINY);
                let cells = |v: usize| tds.as_ref().and_then(|tds| tds.cell_of(VertexId::new(v)));
                let cells: Vec<_> = (0..points.len()).map(cells).collect();
                let corners = |tds: &crate::tds::Tds<3>| {
                    tds.cells().map(|c| *tds.corners(c)).collect::<Vec<_>>()
                };
                (vertices, cells, tds.as_ref().map(corners))
            })
        };
        assert_eq!(of(1), of(3), "{points:?}");
    }
}

#[test]
fn certain_answers_are_right() {
    let mut random = Random(10);
    let (mut certain, mut open) = (0, 0);
    for round in 0..60_000 {
        // Nearly on a circle, nearly collinear.
        let [x, y] = [random.unit() * 1e3, random.unit() * 1e3];
        let tiny = 2f64.powi(-(random.below(60) as i32));
        let angles = [0, 1, 2, 3].map(|_| {
            random.unit()
                * if round % 2 == 1 {
                    std::f64::consts::TAU
                } else {
                    tiny
                }
        });
        let radius = 10f64.powi(random.below(7) as i32 - 3);
        let mut p = angles.map(|t| [x + radius * t.cos(), y + radius * t.sin()]);
        p[3][0] += tiny * radius * (random.unit() - 0.5);
        let arrows = [1, 2, 3].map(|i| Arrow::between(p[0], p[i]));
        let circle = Circle::through(arrows[0], arrows[1]);
        for (estimate, sign) in [
            (
                arrows[0].turn(arrows[1]),
                Exact::sign(&Orientation2([p[0], p[1], p[2]])),
            ),
            (circle.side(arrows[2]), Exact::sign(&InCircle(p))),
        ] {
            if estimate.is_positive() || estimate.is_negative() {
                assert_eq!(estimate.is_positive(), sign == Sign::Positive, "{p:?}");
                assert_eq!(estimate.is_negative(), sign == Sign::Negative, "{p:?}");
                certain += 1;
            } else {
                open += 1;
            }
        }
    }
    assert!(certain > 10_000 && open > 10_000, "{certain} {open}");
}

/// A flag that is set before or while many ranges are built leaves nothing half built; one that is
/// never set changes nothing.
#[test]
fn canceled_work_ends_without_a_result() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let points: Vec<[f64; 2]> = (0..900)
        .map(|i| [f64::from(i % 30), f64::from(i / 30)])
        .collect();
    let geometry = Plane::<Adaptive>::default();
    let built = |flag: &AtomicBool| {
        let stop = Stop::new(flag);
        let grain = Grain {
            stop: Some(&stop),
            ..TINY
        };
        let (sites, _) = Sites::of(&geometry, &points, TINY).unwrap();
        let (points, tds) = build::<_, 3, (), ()>(&geometry, sites, grain);
        assert_eq!((points.len(), tds.is_none()), (900, grain.is_stopped()));
        tds.is_some()
    };
    assert!(built(&AtomicBool::new(false)));
    assert!(!built(&AtomicBool::new(true)));
    for spins in (0..20).map(|k| 1 << k) {
        let flag = AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                (0..spins).for_each(|_| std::hint::spin_loop());
                flag.store(true, Ordering::Relaxed);
                std::hint::spin_loop();
                flag.store(false, Ordering::Relaxed);
            });
            built(&flag);
        });
    }
}

//! With and without the features `parallel` and `simd`, on any number of threads, results have the
//! same bits.
//!
//! Each build compares digests of its results with those below, so that builds are compared with
//! each other. The digests include the numbers of cells and vertices. If a change reorders these
//! and both builds agree, record the new digests here.

use breakline_triangulation::geometry::{Plane, Space};
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::refine::Quality;
use breakline_triangulation::{ConstrainedDelaunay, Delaunay, Level, OnCrossing, spatial_order};
use testkit::random::Random;

type Point = [f64; 2];

/// FNV-1a (Fowler, Noll and Vo 1991), eight bytes at a time.
struct Digest(u64);

impl Digest {
    fn of(numbers: impl IntoIterator<Item = u64>) -> u64 {
        let mut digest = Digest(0xCBF2_9CE4_8422_2325);
        numbers.into_iter().for_each(|number| digest.add(number));
        digest.0
    }

    fn add(&mut self, number: u64) {
        self.0 = (self.0 ^ number).wrapping_mul(0x0100_0000_01B3);
        self.0 ^= self.0 >> 29;
    }
}

/// More points than one thread processes at a time, of several kinds.
fn point_sets() -> [(&'static str, Vec<Point>); 4] {
    let mut random = Random(17);
    let uniform = (0..70_000)
        .map(|_| [random.unit(), random.unit()])
        .collect();
    // Each site several times, and every four of them on a circle.
    let lattice = (0..120_000)
        .map(|_| [(); 2].map(|()| random.below(180) as f64))
        .collect();
    let clusters = (0..50_000).map(|_| {
        let scale = 10f64.powi(-3 * random.below(9) as i32);
        [(); 2].map(|()| scale * random.unit())
    });
    let clusters = clusters.collect();
    let arc = (0..40_000)
        .map(|i| f64::from(i) * 1e-4)
        .map(|x| [x, x * x])
        .collect();
    [
        ("uniform", uniform),
        ("lattice", lattice),
        ("clusters", clusters),
        ("arc", arc),
    ]
}

fn digest(t: &ConstrainedDelaunay<Plane>) -> u64 {
    let points = t.points().iter().flatten().map(|x| x.to_bits());
    let corners = t
        .tds()
        .cells()
        .flat_map(|cell| t.tds().corners(cell).map(|v| v.index() as u64));
    let kinds = t
        .tds()
        .cells()
        .flat_map(|cell| (0..3).map(move |i| u64::from(t.is_constrained(cell, i))));
    Digest::of(points.chain(corners).chain(kinds))
}

fn triangulated(points: &[Point], lines: &[[u32; 2]]) -> ConstrainedDelaunay<Plane> {
    ConstrainedDelaunay::from_lines(Plane::default(), points, lines, OnCrossing::Split)
        .unwrap()
        .0
}

#[test]
fn order_and_triangulations_of_points() {
    let recorded = [
        ("uniform", 15895640478201740119, 15497233127495097494),
        ("lattice", 14062330855548642251, 16083889395538859917),
        ("clusters", 8642865558459028364, 17733960395950907023),
        ("arc", 17744182980547220255, 11264863881568139005),
    ];
    let found = point_sets().map(|(name, points)| {
        let order = spatial_order(points.len(), |i| points[i]).unwrap();
        (
            name,
            Digest::of(order.into_iter().map(u64::from)),
            digest(&triangulated(&points, &[])),
        )
    });
    assert_eq!(found, recorded);
}

/// Segments whose boxes overlap little, and a fan whose boxes mostly overlap without a crossing;
/// these are swept.
#[test]
fn segments_that_cross() {
    let mut random = Random(18);
    let mut scattered: Vec<Point> = (0..20_000)
        .map(|_| [random.unit(), random.unit()])
        .collect();
    for i in 0..4_000 {
        scattered.push([0, 1].map(|axis| scattered[i][axis] + 0.03 * (random.unit() - 0.5)));
    }
    let short: Vec<[u32; 2]> = (0..4_000).map(|i| [i, 20_000 + i]).collect();
    let fan: Vec<Point> = (0..1_500)
        .flat_map(|i| {
            let x = 0.1 * f64::from(i);
            [
                [x, 0.0],
                [x + 1000.0 + f64::from(u8::from(i % 40 == 0)), 1000.0],
            ]
        })
        .collect();
    let bundle: Vec<[u32; 2]> = (0..1_500).map(|i| [2 * i, 2 * i + 1]).collect();
    let found = [
        triangulated(&scattered, &short),
        triangulated(&fan, &bundle),
    ]
    .map(|t| digest(&t));
    assert_eq!(found, [568871710230857583, 11297057009547932613]);
}

#[test]
fn a_mesh_that_is_refined() {
    let mut random = Random(19);
    let mut points: Vec<Point> = vec![[0.0, 0.0], [100.0, 0.0], [100.0, 80.0], [0.0, 80.0]];
    points.extend((0..400).map(|_| [100.0 * random.unit(), 80.0 * random.unit()]));
    let lines = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [6, 7], [8, 9]];
    let mesh = triangulated(&points, &lines).refined(&Quality {
        max_area: 0.5,
        ..Quality::default()
    });
    assert_eq!(digest(&mesh), 11957010385876691842);
}

/// Every cut of the set takes off one point, so that ranges are nested as deep as the exponents of
/// numbers allow, a few thousand calls. This needs less stack than a main thread has; optimized
/// builds need less than 2 MiB.
#[test]
fn nested_clusters_do_not_exhaust_the_stack() {
    let exponents = (-1074..1024).map(|e| {
        if e < -1022 {
            f64::from_bits(1 << (e + 1074))
        } else {
            2f64.powi(e)
        }
    });
    let points: Vec<Point> = exponents
        .flat_map(|x| [[x, 0.0], [0.0, x], [x, x]])
        .collect();
    let work = move || {
        let (t, _) = Delaunay::from_points(Plane::<Wide>::default(), &points).unwrap();
        assert_eq!(t.vertex_count(), 3 * 2098);
        assert_eq!(t.check(Level::Manifold), []);
    };
    std::thread::Builder::new()
        .stack_size(1 << 22)
        .spawn(work)
        .unwrap()
        .join()
        .unwrap();
}

#[test]
fn triangulations_in_space() {
    let mut random = Random(18);
    let uniform: Vec<[f64; 3]> = (0..20_000)
        .map(|_| [(); 3].map(|()| random.unit()))
        .collect();
    // Each site several times, and nearly all ties.
    let lattice: Vec<[f64; 3]> = (0..10_000)
        .map(|_| [(); 3].map(|()| random.below(15) as f64))
        .collect();
    for (name, points, recorded) in [
        ("uniform", uniform, 7634331805383617326),
        ("lattice", lattice, 2671457574273294758),
    ] {
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
        assert_eq!(t.check(Level::Law), []);
        let coordinates = t.points().iter().flatten().map(|x| x.to_bits());
        let corners = t
            .tds()
            .cells()
            .flat_map(|cell| t.tds().corners(cell).map(|v| v.index() as u64));
        assert_eq!(Digest::of(coordinates.chain(corners)), recorded, "{name}");
    }
}

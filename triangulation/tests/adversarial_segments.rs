//! Segments inserted by an adversary: bundles a rounding apart, stars, spikes, great numbers of
//! short constraints, repeated and reversed segments.

use std::collections::{HashMap, HashSet};

use breakline_triangulation::geometry::{Crossing, Geometry, Plane};
use breakline_triangulation::kernel::{Exact, Kernel};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{ConstrainedDelaunay, Level};
use testkit::random::{Random, ulps};

type Point = [f64; 2];
type Segment = [Point; 2];
type Constrained<K = breakline_triangulation::kernel::Adaptive> = ConstrainedDelaunay<Plane<K>>;

/// In UTM, as surveys are: a millionth of a millimeter is one unit in the last place of a northing.
const UTM: Point = [500_000.37, 4_649_000.12];
const NEAR: Point = [1.3, 2.7];

fn built(points: &[Point], segments: &[Segment]) -> Constrained {
    let (mut t, _) = Constrained::from_points(Plane::default(), points).unwrap();
    t.insert_lines(segments).unwrap();
    t
}

/// Returns true if constrained edges connect the ends of each segment, and none of their vertices
/// is further off the segment than `tolerance`.
fn covers<K: Kernel>(t: &Constrained<K>, segments: &[Segment], tolerance: f64) -> bool {
    let mut edges: HashMap<VertexId, Vec<VertexId>> = HashMap::new();
    for [a, b] in t.constrained_edges() {
        edges.entry(a).or_default().push(b);
        edges.entry(b).or_default().push(a);
    }
    let at = |p: Point| t.tds().vertices().find(|&v| *t.point(v) == p).unwrap();
    segments.iter().filter(|[a, b]| a != b).all(|&[a, b]| {
        let (start, end) = (at(a), at(b));
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let length = dx.hypot(dy);
        let is_beside = |v: VertexId| {
            let [x, y] = [0, 1].map(|axis| t.point(v)[axis] - a[axis]);
            let (off, along) = ((dx * y - dy * x).abs() / length, (dx * x + dy * y) / length);
            off <= tolerance && -tolerance <= along && along <= length + tolerance
        };
        let mut seen = HashSet::from([start]);
        let mut stack = vec![start];
        while let Some(v) = stack.pop() {
            let next = edges.get(&v).map_or(&[][..], |next| next);
            stack.extend(next.iter().filter(|&&w| is_beside(w) && seen.insert(w)));
        }
        seen.contains(&end)
    })
}

/// Returns true if each segment is the chain of constrained edges between the vertices that lie on
/// it exactly.
fn covers_exactly(t: &Constrained, segments: &[Segment]) -> bool {
    let exact = Plane::<Exact>::default();
    segments.iter().all(|[a, b]| {
        let (low, high) = if exact.compare(a, b).is_lt() {
            (a, b)
        } else {
            (b, a)
        };
        let lies_on = |p: &Point| {
            exact.orientation([a, b, p]) == Sign::Zero
                && exact.compare(p, low).is_ge()
                && exact.compare(p, high).is_le()
        };
        let mut on: Vec<VertexId> = t
            .tds()
            .vertices()
            .filter(|&v| lies_on(t.point(v)))
            .collect();
        on.sort_by(|&u, &v| exact.compare(t.point(u), t.point(v)));
        on.windows(2).all(|pair| {
            t.tds()
                .edge(pair[0], pair[1])
                .is_some_and(|(cell, i)| t.is_constrained(cell, i))
        })
    })
}

fn any_cross(segments: &[Segment]) -> bool {
    let exact = Plane::<Exact>::default();
    let apart = |[a, b]: &Segment, [c, d]: &Segment| {
        exact.orientation([a, b, c]) * exact.orientation([a, b, d]) == Sign::Negative
    };
    segments.iter().enumerate().any(|(i, s)| {
        segments[..i]
            .iter()
            .any(|other| apart(s, other) && apart(other, s))
    })
}

/// Builds in some order, perhaps with every segment repeated and reversed; all laws must hold.
fn survives(points: &[Point], segments: &[Segment], random: &mut Random) {
    let mut order = segments.to_vec();
    random.shuffle(&mut order);
    if random.below(3) == 0 {
        order.extend(segments.iter().map(|&[a, b]| [b, a]));
    }
    let t = built(points, &order);
    assert_eq!(t.check(Level::Law), [], "{points:?} {order:?}");
    if t.dimension() < 2 {
        return;
    }
    let largest = order
        .iter()
        .flatten()
        .flatten()
        .fold(0.0f64, |largest, x| largest.max(x.abs()));
    assert!(
        covers(&t, segments, 2000.0 * f64::EPSILON * largest),
        "{points:?} {order:?}"
    );
    if !any_cross(segments) {
        assert_eq!(t.crossings(), [], "{points:?} {order:?}");
        assert!(covers_exactly(&t, segments), "{points:?} {order:?}");
    }
    // Each pair once, and some once more because the sub-constraints lie off the line by a
    // rounding.
    let pairs = segments.len() * segments.len();
    assert!(
        t.crossings().len() <= pairs,
        "{} crossings of {order:?}",
        t.crossings().len()
    );
}

/// Each family of inputs, some hundred times. Longer runs use another seed and more rounds.
fn fuzz(
    seed: u64,
    rounds: usize,
    mut input: impl FnMut(&mut Random, Point) -> (Vec<Point>, Vec<Segment>),
) {
    let mut random = Random(seed);
    for round in 0..rounds {
        let (points, segments) = input(&mut random, [NEAR, UTM][round % 2]);
        survives(&points, &segments, &mut random);
    }
}

fn segments_among(random: &mut Random, points: &[Point], up_to: u64) -> Vec<Segment> {
    (0..random.below(up_to))
        .map(|_| [random.pick(points), random.pick(points)])
        .collect()
}

#[test]
fn on_tiny_grids() {
    fuzz(1, 1000, |random, [x, y]| {
        let side = 2 + random.below(6);
        let points: Vec<Point> = (0..3 + random.below(14))
            .map(|_| {
                [
                    x + 4.0 * random.below(side) as f64,
                    y + 4.0 * random.below(side) as f64,
                ]
            })
            .collect();
        let segments = segments_among(random, &points, 10);
        (points, segments)
    });
}

#[test]
fn one_unit_in_the_last_place_apart() {
    fuzz(2, 1000, |random, [x, y]| {
        let points: Vec<Point> = (0..3 + random.below(20))
            .map(|_| [ulps(x, random.around(2)), ulps(y, random.around(2))])
            .collect();
        let segments = segments_among(random, &points, 8);
        (points, segments)
    });
}

#[test]
fn nearly_parallel_in_centimeters() {
    fuzz(3, 600, |random, [x, y]| {
        let end = |random: &mut Random, far: f64| {
            [
                x + far + 0.01 * random.below(3) as f64,
                y + 0.01 * random.below(12) as f64,
            ]
        };
        (
            Vec::new(),
            (0..2 + random.below(12))
                .map(|_| [end(random, 0.0), end(random, 100.0)])
                .collect(),
        )
    });
}

/// The same border from several sources. Nine of these once produced 1.4 million vertices.
#[test]
fn bundles_a_rounding_apart() {
    for spread in [1, 3, 10, 1000] {
        fuzz(4, 150, |random, [x, y]| {
            let end = |random: &mut Random, [x, y]: Point| {
                [
                    ulps(x, random.around(spread)),
                    ulps(y, random.around(spread)),
                ]
            };
            let segment = |_| [end(random, [x, y]), end(random, [x + 10.0, y + 3.0])];
            (Vec::new(), (0..10).map(segment).collect())
        });
    }
}

#[test]
fn stars_through_a_point() {
    fuzz(5, 600, |random, [x, y]| {
        let center = [
            x + 0.1 * random.below(10) as f64,
            if random.below(4) == 0 { 0.0 } else { y },
        ];
        let count = 2 + random.below(9);
        let segment = |_| {
            let (angle, length) = (random.unit() * 6.3, 1.0 + 10.0 * random.unit());
            let [dx, dy] = [length * angle.cos(), length * angle.sin()];
            [
                [center[0] + dx, center[1] + dy],
                [center[0] - dx, center[1] - dy],
            ]
        };
        let segments = (0..count).map(segment).collect();
        (
            if random.below(2) == 0 {
                vec![center]
            } else {
                Vec::new()
            },
            segments,
        )
    });
}

/// A long line through dust, with short constraints that stick into its corridor.
#[test]
fn spikes_along_a_line() {
    fuzz(6, 500, |random, [x, y]| {
        let point = |random: &mut Random| {
            let width = random.pick(&[1e-9, 1e-3, 0.1, 1.0, 4.0]);
            [x + 10.0 * random.unit(), y + width * (random.unit() - 0.5)]
        };
        let points: Vec<Point> = (0..10 + random.below(60)).map(|_| point(random)).collect();
        let mut segments = segments_among(random, &points, 10);
        segments.retain(|[a, b]| (a[1] > y) == (b[1] > y));
        segments.push([[x - 1.0, y], [x + 11.0, y]]);
        (points, segments)
    });
}

#[test]
fn along_a_hull_that_is_nearly_straight() {
    fuzz(7, 600, |random, [x, y]| {
        let count = 3 + random.below(20);
        let point = |_| {
            let along = random.below(100) as f64;
            [x + along, ulps(y + 0.37 * along, random.around(1))]
        };
        let mut points: Vec<Point> = (0..count).map(point).collect();
        points.push([x + 50.0, y + random.pick(&[1e-6, 200.0])]);
        let segments = segments_among(random, &points, 10);
        (points, segments)
    });
}

/// Polylines that turn back on themselves. Twenty-four such segments once produced 1900 vertices.
#[test]
fn scribbles() {
    fuzz(8, 400, |random, [x, y]| {
        let side = 3 + random.below(30);
        let mut segments: Vec<Segment> = Vec::new();
        let mut last = [x, y];
        for _ in 0..2 + random.below(25) {
            let next = [
                x + 0.01 * random.below(side) as f64,
                y + 0.01 * random.below(side) as f64,
            ];
            segments.push([last, next]);
            last = next;
        }
        (Vec::new(), segments)
    });
}

#[test]
fn drawn_again_they_change_nothing() {
    let mut random = Random(9);
    for _ in 0..300 {
        let points: Vec<Point> = (0..10)
            .map(|_| [UTM[0] + 20.0 * random.unit(), UTM[1] + 20.0 * random.unit()])
            .collect();
        let segments: Vec<Segment> = (0..10)
            .map(|_| [random.pick(&points), random.pick(&points)])
            .collect();
        let mut t = built(&points, &segments);
        let before = t.vertex_count();
        for &[a, b] in &segments {
            t.insert_lines(&[[a, b], [b, a]]).unwrap();
        }
        assert_eq!(t.vertex_count(), before, "{segments:?}");
        assert_eq!(t.check(Level::Law), []);
    }
}

/// Beyond 256 crossings, the rest of a segment was once left out.
#[test]
fn one_segment_crosses_a_thousand() {
    let posts: Vec<Segment> = (1..=1000)
        .map(|i| [[f64::from(i), -1.0], [f64::from(i), 2.0]])
        .collect();
    let mut t = built(&[], &posts);
    let level = [[0.0, 0.0], [1001.0, 0.0]];
    t.insert_lines(&[level]).unwrap();
    assert_eq!(t.crossings().len(), 1000);
    assert!(covers_exactly(&t, &[level]));
    let slanted = [[1001.0, 0.3], [0.0, 1.4]];
    t.insert_lines(&[slanted]).unwrap();
    assert_eq!(t.crossings().len(), 2000);
    assert!(covers(&t, &[slanted], 1e-12));
    assert!(covers_exactly(&t, &[level]));
    assert_eq!(t.check(Level::Law), []);
}

#[test]
fn repeated_vertices_and_spikes_in_a_polyline() {
    let chain = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 0.0],
        [2.0, 0.0],
        [8.0, 0.0],
        [8.0, 4.0],
        [8.0, -4.0],
        [8.0, 4.0],
    ];
    let mut t = built(&[[5.0, 5.0], [0.0, 9.0]], &[]);
    t.insert_lines(&[chain]).unwrap();
    assert_eq!(t.check(Level::Law), []);
    assert_eq!(t.constrained_edges().count(), 5);
    assert_eq!(t.crossings(), []);
}

/// Kernels without a range accept crossings of any size, too.
#[test]
fn crossings_at_the_ends_of_floating_point() {
    let crossings = |scale: f64| -> Vec<Point> {
        let mut t: Constrained<Exact> = ConstrainedDelaunay::new(Plane::default());
        let segments = [
            [[-1.0, -0.5], [1.0, 0.5]],
            [[-1.0, 0.75], [0.5, -1.0]],
            [[-0.3, -1.0], [-0.3, 1.0]],
        ];
        for segment in segments {
            t.insert_lines(&[segment.map(|p| p.map(|x| x * scale))])
                .unwrap();
        }
        assert_eq!(t.check(Level::Law), []);
        t.crossings()
            .iter()
            .map(|&v| t.point(v).map(|x| x / scale))
            .collect()
    };
    let expected = crossings(1.0);
    assert_eq!(expected.len(), 3);
    for scale in [f64::MAX, 1e300, 1e-300, 1e-310] {
        let scaled = crossings(scale);
        let off = scaled
            .iter()
            .flatten()
            .zip(expected.iter().flatten())
            .map(|(x, y)| (x - y).abs());
        assert!(
            scaled.len() == 3 && off.fold(0.0, f64::max) < 1e-12,
            "{scale:e}: {scaled:?}"
        );
    }
}

/// A crossing may be nearer to zero than the arithmetic admits: then it is moved to zero.
#[test]
fn crossings_stay_in_the_range() {
    let tiny = 2f64.powi(-159);
    let geometry = Plane::<breakline_triangulation::kernel::Adaptive>::default();
    let mut random = Random(10);
    for _ in 0..2000 {
        let mut end = |sign: f64| {
            [
                sign * tiny * (1.0 + random.unit()),
                sign * tiny * (1.0 + random.unit()),
            ]
        };
        let (a, b) = (end(-1.0), end(1.0));
        let (mut c, mut d) = (end(-1.0), end(1.0));
        (c[0], d[0]) = (-c[0], -d[0]);
        let site = geometry.crossing([&a, &b], [&c, &d]);
        assert!(geometry.admits(&site), "{site:?}");
    }
}

//! Areas in which two surfaces differ by more than a height: against volumes, positions and laws.

use breakline::data::{Frame, Grid, Mesh, Surface};
use breakline::terrain::{ChangedArea, GridSurface, Method, Sampler, changed_areas};
use breakline::triangulation::kernel::{Exact, Kernel, Orientation2};
use breakline::triangulation::num::Sign;
use testkit::random::Random;

use super::{Ring, assert_near, between, points, surface};

fn lifted(surface: &dyn Surface, by: f64) -> Mesh {
    let vertices = (0..surface.vertex_count() as u32).map(|v| {
        let [x, y, z] = surface.position(v);
        // A missing cell has no height, and no face.
        [x, y, if z.is_finite() { z + by } else { 0.0 }]
    });
    let faces = (0..surface.face_count() as u32).filter_map(|face| surface.face(face));
    Mesh::new(vertices.collect(), faces.collect(), &[], None).unwrap()
}

/// Returns true if a triangle is so thin that its heights jump where positions are rounded.
fn has_sliver(surface: &dyn Surface) -> bool {
    let faces = (0..surface.face_count() as u32).filter_map(|face| surface.triangle(face));
    let mut thin = faces.filter(|corners| {
        let [a, b, c] = corners.map(|[x, y, _]| [x, y]);
        let side = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let longest = side(a, b).max(side(b, c)).max(side(c, a));
        doubled_area(&[a, b, c, a]) < 1e-6 * longest * longest
    });
    thin.next().is_some()
}

fn heights(surface: &dyn Surface, positions: &[[f64; 2]]) -> Vec<f64> {
    let sampler = Sampler::new(surface, Method::Linear).unwrap();
    let samples = sampler.samples(positions).unwrap();
    samples.iter().map(|sample| sample.height).collect()
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    Exact::sign(&Orientation2([a, b, c]))
}

/// Returns true if a position is in a polygon, by a ray to the east.
fn contains(rings: &[Ring], q: [f64; 2]) -> bool {
    let sides = rings.iter().flat_map(|ring| ring.windows(2));
    let crossed = sides.filter(|side| {
        let [a, b] = [side[0], side[1]];
        let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
        low[1] <= q[1] && q[1] < high[1] && turn(low, high, q) == Sign::Positive
    });
    crossed.count() % 2 == 1
}

fn doubled_area(ring: &[[f64; 2]]) -> f64 {
    let [x, y] = ring[0];
    let cross = |p: [f64; 2], q: [f64; 2]| (p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y);
    ring.windows(2).map(|side| cross(side[0], side[1])).sum()
}

/// Panics unless sides of the rings meet at their ends only, the first ring is clockwise and the
/// others are counter-clockwise in it.
fn assert_valid(rings: &[Ring], what: &str) {
    for (k, ring) in rings.iter().enumerate() {
        assert!(ring.len() > 3 && ring.first() == ring.last(), "{what}");
        let mut sites = ring[1..].to_vec();
        sites.sort_by(|a, b| a.partial_cmp(b).unwrap());
        sites.dedup();
        assert_eq!(sites.len(), ring.len() - 1, "{what}: ring {k} meets itself");
        let is_outer = k == 0;
        assert_eq!(doubled_area(ring) < 0.0, is_outer, "{what}: ring {k}");
        let outer = &rings[..1];
        assert!(
            is_outer
                || ring.iter().any(|&p| contains(outer, p))
                || ring.iter().all(|p| outer[0].contains(p)),
            "{what}: ring {k} is outside"
        );
    }
    let sides: Vec<[[f64; 2]; 2]> = rings
        .iter()
        .flat_map(|ring| ring.windows(2))
        .map(|side| [side[0], side[1]])
        .collect();
    for (i, &[a, b]) in sides.iter().enumerate() {
        for &[c, d] in &sides[..i] {
            let apart =
                (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]));
            if apart {
                continue;
            }
            let of_ends = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)];
            let touches = |p: [f64; 2], q: [f64; 2]| p == q;
            let shared = touches(a, c) || touches(a, d) || touches(b, c) || touches(b, d);
            if shared {
                // Of two sides with a common end, neither lies on the other.
                let zeros = of_ends.iter().filter(|&&sign| sign == Sign::Zero).count();
                let is_straight = zeros == 4 && !(b == c || a == d);
                assert!(!is_straight, "{what}: {a:?} {b:?} on {c:?} {d:?}");
                continue;
            }
            let meets = of_ends[0] != of_ends[1] && of_ends[2] != of_ends[3];
            assert!(!meets, "{what}: {a:?} {b:?} meets {c:?} {d:?}");
        }
    }
}

fn sum(areas: &[ChangedArea], is_raised: bool, of: fn(&ChangedArea) -> f64) -> f64 {
    let wanted = areas.iter().filter(|area| area.is_raised() == is_raised);
    wanted.map(of).sum()
}

/// Checks the areas of two surfaces, and returns them.
fn judged(a: &dyn Surface, b: &dyn Surface, height: f64, what: &str) -> Vec<ChangedArea> {
    let areas = changed_areas([a, b], height).unwrap();
    let common = between(a, b).common_area;
    for (is_raised, one, other) in [(true, a, b), (false, b, a)] {
        // Above the other one and the height.
        let beyond = between(one, &lifted(other, height));
        let what = format!("{what}, raised {is_raised}");
        // What is level but for rounding may be of any side.
        let within = 1e-9 * common + beyond.level_area();
        let area = sum(&areas, is_raised, |area| area.area);
        assert_near(area, beyond.cut_area, within, &format!("{what}, area"));
        let volume = sum(&areas, is_raised, |area| area.volume);
        let expected = beyond.cut + height * beyond.cut_area;
        assert_near(
            volume,
            expected,
            1e-9 * (expected + common) + height * within,
            &format!("{what}, volume"),
        );
    }
    let has_slivers = has_sliver(a) || has_sliver(b);
    let at: Vec<[f64; 2]> = areas.iter().map(|area| area.at).collect();
    let apart = heights(a, &at)
        .into_iter()
        .zip(heights(b, &at))
        .map(|(a, b)| a - b);
    for (area, apart) in areas.iter().zip(apart) {
        assert_valid(&area.rings, what);
        let by_rings: f64 = area
            .rings
            .iter()
            .map(|ring| -doubled_area(ring) / 2.0)
            .sum();
        // Vertices are rounded to the coordinates that there are.
        let sides = area.rings.iter().flat_map(|ring| ring.windows(2));
        let within: f64 = sides
            .map(|side| {
                let [a, b] = [side[0], side[1]];
                let largest = a[0].abs().max(a[1].abs());
                4.0 * f64::EPSILON * largest * (a[0] - b[0]).hypot(a[1] - b[1])
            })
            .sum();
        assert_near(
            area.area,
            by_rings,
            1e-9 * common + within,
            &format!("{what}, rings"),
        );
        assert!(area.largest.abs() > height, "{what}");
        // A rounded position at the rim may be off a surface.
        if !apart.is_nan() && !has_slivers {
            // Where it is steep, rounded positions have other heights.
            assert_near(apart, area.largest, 1e-5 * (1.0 + apart.abs()), what);
        }
    }
    let mut exchanged = changed_areas([b, a], height).unwrap();
    for area in &mut exchanged {
        area.largest = -area.largest;
    }
    let differs = areas.iter().zip(&exchanged).find(|(a, b)| a != b);
    assert!(differs.is_none(), "{what}: {differs:?}");
    assert_eq!(areas.len(), exchanged.len(), "{what}");
    areas
}

#[test]
fn areas_are_those_of_volumes_and_of_positions() {
    let count = std::env::var("BREAKLINE_CHANGES").map_or(300, |n| n.parse().unwrap());
    let (mut polygons, mut holes) = (0, 0);
    for seed in 0..count {
        let mut random = Random(seed);
        let shift = random.pick(&[[0.0; 3], [885_000.25, 6_297_000.5, 1200.0]]);
        let step = random.pick(&[1.0, 0.37, 125.0]);
        let height = random.pick(&[0.5, 1.0, 0.3, 0.01]);
        let counts = [3 + random.index(40), 3 + random.index(40)];
        let [a, b] = counts.map(|count| surface(points(&mut random, count, shift, step)));
        let (Some(a), Some(b)) = (a, b) else { continue };
        let what = format!("seed {seed}");
        let areas = judged(&a, &b, height, &what);
        polygons += areas.len();
        holes += areas.iter().filter(|area| area.rings.len() > 1).count();
        let positions: Vec<[f64; 2]> = (0..200)
            .map(|_| [0, 1].map(|k| shift[k] + step * 6.0 * (2.0 * random.unit() - 1.0)))
            .collect();
        let (of_a, of_b) = (heights(&a, &positions), heights(&b, &positions));
        for ((&q, a), b) in positions.iter().zip(of_a).zip(of_b) {
            let within = areas.iter().filter(|area| contains(&area.rings, q));
            let found: Vec<bool> = within.map(|area| area.is_raised()).collect();
            let expected: &[bool] = match a - b {
                d if d > height => &[true],
                d if d < -height => &[false],
                _ => &[],
            };
            if ((a - b).abs() - height).abs() > 1e-6 {
                assert_eq!(found, expected, "{what}: {q:?}, {a} and {b}");
            }
        }
    }
    assert!(
        polygons > count as usize && holes > 20,
        "{polygons} {holes}"
    );
}

/// A square of 2 by 2 steps around the origin: the corners are at 0, the others as given from the
/// west on, counter-clockwise, and the center.
fn star(west: f64, south: f64, east: f64, north: f64, center: f64) -> Mesh {
    let vertices = vec![
        [0.0, 0.0, center],
        [-1.0, 0.0, west],
        [-1.0, -1.0, 0.0],
        [0.0, -1.0, south],
        [1.0, -1.0, 0.0],
        [1.0, 0.0, east],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, north],
        [-1.0, 1.0, 0.0],
    ];
    let faces = (0..8).map(|i| [0, 1 + i, 1 + (i + 1) % 8]).collect();
    Mesh::new(vertices, faces, &[], None).unwrap()
}

fn level() -> Mesh {
    let corners = vec![
        [-9.0, -9.0, 0.0],
        [9.0, -9.0, 0.0],
        [9.0, 9.0, 0.0],
        [-9.0, 9.0, 0.0],
    ];
    Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]], &[], None).unwrap()
}

#[test]
fn an_area_around_another_one_has_a_hole() {
    // A pyramid that is 4 high at its foot and -4 at the center.
    let mut bowl = star(4.0, 4.0, 4.0, 4.0, -4.0);
    bowl = {
        let vertices = (0..9).map(|v| {
            let [x, y, z] = bowl.position(v);
            [x, y, if x != 0.0 && y != 0.0 { 4.0 } else { z }]
        });
        let faces = (0..8).map(|face| bowl.face(face).unwrap());
        Mesh::new(vertices.collect(), faces.collect(), &[], None).unwrap()
    };
    let areas = judged(&bowl, &level(), 2.0, "a bowl");
    // At a quarter of the way from the center it is at -2, at three quarters at 2.
    let expected = vec![
        vec![
            [-1.0, -1.0],
            [-1.0, 1.0],
            [1.0, 1.0],
            [1.0, -1.0],
            [-1.0, -1.0],
        ],
        vec![
            [-0.75, -0.75],
            [0.75, -0.75],
            [0.75, 0.75],
            [-0.75, 0.75],
            [-0.75, -0.75],
        ],
    ];
    assert_eq!(areas.len(), 2);
    // Without the vertices in the middle of straight sides.
    let corners: Vec<Ring> = areas[0]
        .rings
        .iter()
        .map(|ring| {
            ring.iter()
                .copied()
                .filter(|p| p[0] != 0.0 && p[1] != 0.0)
                .collect()
        })
        .collect();
    assert_eq!(corners, expected);
    assert_eq!(
        (areas[0].area, areas[0].largest, areas[0].at),
        (1.75, 4.0, [-1.0, -1.0])
    );
    assert_eq!(
        (areas[1].area, areas[1].largest, areas[1].at),
        (0.25, -4.0, [0.0, 0.0])
    );
    assert!(!areas[1].is_raised());
}

#[test]
fn areas_that_meet_in_a_vertex_are_separate_and_along_an_edge_one() {
    // Up to the height at the center, above it on both sides.
    let areas = judged(&star(3.0, 0.0, 3.0, 0.0, 1.0), &level(), 1.0, "a saddle");
    assert_eq!(areas.len(), 2);
    for area in &areas {
        assert!(area.rings[0].contains(&[0.0, 0.0]));
    }
    // Just the height along an edge through the middle.
    let valley = vec![
        [-1.0, -1.0, 3.0],
        [0.0, -1.0, 1.0],
        [1.0, -1.0, 3.0],
        [1.0, 1.0, 3.0],
        [0.0, 1.0, 1.0],
        [-1.0, 1.0, 3.0],
    ];
    let faces = vec![[0, 1, 5], [1, 4, 5], [1, 2, 3], [1, 3, 4]];
    let valley = Mesh::new(valley, faces, &[], None).unwrap();
    let areas = judged(&valley, &level(), 1.0, "a valley");
    assert_eq!(
        (areas.len(), areas[0].rings.len(), areas[0].area),
        (1, 1, 4.0)
    );
    // What differs just by the height is not more, also if the height is no binary number.
    let lowered = lifted(&valley, 100.3);
    assert!(judged(&lifted(&lowered, -0.7), &lowered, 0.7, "a plateau").is_empty());
}

#[test]
fn nothing_is_changed_where_nothing_differs_or_nothing_is() {
    let flat = level();
    assert_eq!(changed_areas([&flat, &flat], 0.1).unwrap(), []);
    let far = surface(vec![
        [90.0, 90.0, 9.0],
        [99.0, 90.0, 9.0],
        [90.0, 99.0, 9.0],
    ])
    .unwrap();
    assert_eq!(changed_areas([&flat, &far], 0.1).unwrap(), []);
    for height in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(changed_areas([&flat, &far], height).is_err());
    }
}

#[test]
fn rasters_are_surfaces_and_ragged_coordinates_stay_valid() {
    let mut random = Random(11);
    for (round, shift) in [[0.1, 0.7, 3.3], [600_000.123, 5_800_000.77, 87.9]]
        .into_iter()
        .enumerate()
    {
        let mut point = |_| {
            let [x, y] = [random.unit(), random.unit()].map(|u| (9000.0 * u).round() / 1000.0);
            [shift[0] + x, shift[1] + y, shift[2] + (2.0 * x).sin()]
        };
        let ground: Vec<[f64; 3]> = (0..600).map(&mut point).collect();
        let a = surface(ground.clone()).unwrap();
        // The same ground with other heights at some vertices, and points on edges.
        let mut changed = ground;
        for p in changed.iter_mut().step_by(7) {
            p[2] += 0.8;
        }
        for face in (0..a.face_count() as u32).step_by(3) {
            let Some([p, q, _]) = a.triangle(face) else {
                continue;
            };
            changed.push([0, 1, 2].map(|k| p[k] + (q[k] - p[k]) / 3.0));
        }
        let b = surface(changed).unwrap();
        let areas = judged(&a, &b, 0.25, &format!("round {round}"));
        assert!(areas.len() > 10);

        let frame = Frame::north_up(shift[0] - 0.5, shift[1] + 9.5, 0.37, 27, 27);
        let cells = (0..27 * 27).map(|cell| shift[2] + (cell % 5) as f64 * 0.3);
        let mut values: Vec<f64> = cells.collect();
        values[300] = f64::NAN;
        let grid = Grid {
            frame,
            crs: None,
            values,
        };
        let raster = GridSurface::new(&grid).unwrap();
        let areas = judged(&a, &raster, 0.4, &format!("a raster, round {round}"));
        assert!(areas.len() > 2);
        assert!(judged(&raster, &raster, 0.4, "itself").is_empty());
    }
}

//! Surfaces clipped to polygons, against the even-odd rule by rays.

use breakline::data::{EdgeKind, Surface};
use breakline::terrain::{Tin, TinBuilder};
use breakline::triangulation::Level;
use testkit::random::Random;

type Ring = Vec<[f64; 2]>;

/// Sides of the square that the data fills.
const SIDE: i32 = 8;

/// Within a cell of the grid, off all lines between its corners.
const OFF: [f64; 2] = [0.3719, 0.6143];

/// The ground: a plane.
fn height([x, y]: [f64; 2]) -> f64 {
    x + 2.0 * y + 1.0
}

/// Corners of the grid, multiplied.
struct Corners {
    random: Random,
    scale: f64,
}

impl Corners {
    /// One within the data or beyond.
    fn any(&mut self) -> [f64; 2] {
        [0, 1].map(|_| (self.random.below(SIDE as u64 + 4) as f64 - 2.0) * self.scale)
    }

    /// One within the data, on the ground.
    fn within(&mut self) -> [f64; 3] {
        let [x, y] = self
            .any()
            .map(|c| c.clamp(0.0, f64::from(SIDE) * self.scale));
        [x, y, height([x, y])]
    }

    fn ring(&mut self) -> Ring {
        (0..3 + self.random.below(4)).map(|_| self.any()).collect()
    }
}

/// Returns true if a ray to the left crosses the rings an odd number of times.
fn is_within(rings: &[Ring], [x, y]: [f64; 2]) -> bool {
    let sides = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()])));
    let crosses = |&([ax, ay], [bx, by]): &([f64; 2], [f64; 2])| {
        (ay <= y) != (by <= y) && ax + (y - ay) / (by - ay) * (bx - ax) < x
    };
    sides.filter(crosses).count() % 2 == 1
}

/// Rings and breaklines that cross themselves and each other, with many common edges: the surface
/// is exactly what lies inside any polygon.
#[test]
fn what_stays_is_what_lies_in_any_polygon() {
    let (mut inside, mut outside) = (0, 0);
    for round in 0..300 {
        let scale = [1.0, 0.37][round % 2];
        let mut corners = Corners {
            random: Random(round as u64),
            scale,
        };
        let mut builder = TinBuilder::default();
        let mut add = |[x, y, z]: [f64; 3]| builder.add_points(&[x], &[y], &[z]);
        for site in
            [[0, 0], [SIDE, 0], [SIDE, SIDE], [0, SIDE]].map(|p| p.map(|c| f64::from(c) * scale))
        {
            add([site[0], site[1], height(site)]);
        }
        (0..corners.random.below(30)).for_each(|_| add(corners.within()));
        let polygons: Vec<Vec<Ring>> = (0..1 + corners.random.below(3))
            .map(|_| {
                (0..1 + corners.random.below(2))
                    .map(|_| corners.ring())
                    .collect()
            })
            .collect();
        polygons
            .iter()
            .for_each(|rings| builder.add_boundary(rings));
        for _ in 0..corners.random.below(4) {
            builder.add_breakline(&[(); 3].map(|()| corners.within()));
        }
        // A side of a polygon that is also a breakline, where it is within the data.
        let [p, q] = [0, 1].map(|i| polygons[0][0][i]);
        if [p, q]
            .iter()
            .flatten()
            .all(|c| (0.0..=f64::from(SIDE) * scale).contains(c))
        {
            builder.add_breakline(&[p, q].map(|p| [p[0], p[1], height(p)]));
        }
        let tin = builder.build().unwrap();
        assert!(tin.check(Level::Law).is_empty(), "round {round}");
        for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
            let site = [
                (f64::from(i) + OFF[0]) * scale,
                (f64::from(j) + OFF[1]) * scale,
            ];
            let expected = polygons.iter().any(|rings| is_within(rings, site));
            let found = tin.elevation(site[0], site[1]);
            assert_eq!(
                found.is_some(),
                expected,
                "round {round} at {site:?}: {polygons:?}"
            );
            let is_on_ground = |z: f64| (z - height(site)).abs() < 1e-9;
            assert!(
                found.is_none_or(is_on_ground),
                "round {round} at {site:?}: {found:?}"
            );
            *(if expected { &mut inside } else { &mut outside }) += 1;
        }
    }
    assert!(inside > 2000 && outside > 2000, "{inside} {outside}");
}

/// Boxes around a single site, and boxes beyond the range of the arithmetic.
#[test]
fn bounds_may_be_endless() {
    use breakline::data::Bounds;
    let tin = |min: [f64; 2], max: [f64; 2]| {
        let mut builder = TinBuilder::default();
        builder.add_points(&[0.0, 8.0, 8.0, 0.0], &[0.0, 0.0, 8.0, 8.0], &[1.0; 4]);
        builder.bounds = Some(Bounds {
            min: [min[0], min[1], 0.0],
            max: [max[0], max[1], 9.0],
        });
        builder.build()
    };
    let half = tin([f64::NEG_INFINITY, 1e-300], [4.0, f64::INFINITY]).unwrap();
    assert_eq!(
        [half.elevation(3.0, 7.0), half.elevation(5.0, 7.0)],
        [Some(1.0), None]
    );
    let error = tin([0.0, f64::NAN], [4.0, 4.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "boundary: [0.0, NaN, 0.0] is not a finite point"
    );
}

/// A field of adjacent parcels, each a polygon of its own: none is left out, and no common side
/// cuts the surface.
#[test]
fn parcels_add_up() {
    let mut builder = TinBuilder::default();
    builder.add_points(&[0.0, 20.0, 20.0, 0.0], &[0.0, 0.0, 20.0, 20.0], &[1.0; 4]);
    for (x, y) in (1..19).flat_map(|x| (1..19).map(move |y| (f64::from(x), f64::from(y)))) {
        builder.add_boundary(&[vec![[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]]]);
    }
    let tin = builder.build().unwrap();
    assert_eq!(tin.report().triangles, 2 * 18 * 18);
    assert!(tin.elevation(0.5, 5.0).is_none() && tin.elevation(5.0, 5.0).is_some());
}

/// The vertices of a surface that faces use, sorted.
fn vertices(tin: &Tin) -> Vec<[f64; 3]> {
    let corners = (0..tin.face_count() as u32)
        .filter_map(|face| tin.face(face))
        .flatten();
    let mut vertices: Vec<[f64; 3]> = corners.map(|vertex| tin.position(vertex)).collect();
    vertices.sort_by(|p, q| p.partial_cmp(q).unwrap());
    vertices.dedup();
    vertices
}

/// A side of the clip polygon runs between two points of the ground and over a breakline that is 10
/// high.
#[test]
fn a_side_that_crosses_a_breakline_is_as_high_as_the_breakline_there() {
    let mut builder = TinBuilder::default();
    builder.add_points(
        &[0.0, 10.0, 10.0, 0.0, 5.0, 5.0],
        &[-10.0, -10.0, 10.0, 10.0, 1.0, -1.0],
        &[0.0, 0.0, 0.0, 0.0, 1.0, 1.0],
    );
    builder.add_breakline(&[[0.0, 0.0, 10.0], [10.0, 0.0, 10.0]]);
    builder.add_boundary(&[vec![[5.0, 1.0], [5.0, -1.0], [9.0, -1.0], [9.0, 1.0]]]);
    let tin = builder.build().unwrap();
    let on_breakline: Vec<[f64; 3]> = vertices(&tin).into_iter().filter(|p| p[1] == 0.0).collect();
    assert_eq!(on_breakline, [[5.0, 0.0, 10.0], [9.0, 0.0, 10.0]]);
    // The breakline and the sides of the polygon differ in kind, and there are no other lines.
    let sides = (0..tin.face_count() as u32).filter_map(|face| Some((face, tin.face(face)?)));
    let kinds = sides
        .flat_map(|(face, corners)| (0..3).map(move |i| (face, corners, i)))
        .map(|(face, corners, i)| {
            let [p, q] = [1, 2].map(|k| tin.position(corners[(i + k) % 3]));
            let is_on = |line: fn([f64; 3]) -> bool| line(p) && line(q);
            let is_side =
                is_on(|p| p[0] == 5.0) || is_on(|p| p[0] == 9.0) || is_on(|p| p[1].abs() == 1.0);
            let expected = match (is_on(|p| p[1] == 0.0), is_side) {
                (true, _) => EdgeKind::Breakline,
                (_, true) => EdgeKind::Clip,
                _ => EdgeKind::Plain,
            };
            assert_eq!(tin.edge_kind(face, i), expected, "{p:?} {q:?}");
            expected
        });
    assert!(kinds.filter(|kind| *kind == EdgeKind::Clip).count() >= 6);
}

/// Two polygons over wavy ground, one with a corner in the middle of the other's side: there is no
/// crack at which contours end, and no trace of the common side where both of its sides are kept.
#[test]
fn polygons_that_share_part_of_a_side_are_one_surface() {
    let ground = |round: u64| {
        let mut random = Random(round);
        let mut builder = TinBuilder::default();
        let origin = [500_000.0 + random.unit(), 4_649_000.0 + random.unit()];
        for (i, j) in (0..=16).flat_map(|i| (0..=16).map(move |j| (i, j))) {
            let [x, y] = [origin[0] + f64::from(i), origin[1] + f64::from(j)];
            builder.add_points(&[x], &[y], &[(x - y).sin() * 3.0]);
        }
        (builder, origin, random)
    };
    for round in 0..60 {
        let (mut builder, origin, mut random) = ground(round);
        let at = |x: f64, y: f64| [origin[0] + x, origin[1] + y];
        let (a, b) = (at(2.0, 3.0), at(14.0, 11.0));
        let part = random.unit();
        let middle = [0, 1].map(|k| a[k] + part * (b[k] - a[k]));
        builder.add_boundary(&[vec![a, b, at(14.0, 1.0)]]);
        builder.add_boundary(&[vec![middle, b, at(3.0, 14.0)]]);
        let tin = builder.build().unwrap();
        // The rim lies on the sides of the union, not between the corner and the common end.
        let rims = (0..tin.face_count() as u32).filter_map(|face| Some((face, tin.face(face)?)));
        for (face, corners) in rims {
            for i in (0..3).filter(|&i| tin.neighbor(face, i).is_none()) {
                let [p, q] = [1, 2].map(|k| tin.position(corners[(i + k) % 3]));
                let offset = [0, 1].map(|k| 0.5 * (p[k] + q[k]) - middle[k]);
                let along = [0, 1].map(|k| b[k] - middle[k]);
                let off = (along[0] * offset[1] - along[1] * offset[0]) / along[0].hypot(along[1]);
                let fraction = (along[0] * offset[0] + along[1] * offset[1])
                    / (along[0].powi(2) + along[1].powi(2));
                assert!(
                    off.abs() > 1e-8 || !(1e-6..1.0 - 1e-6).contains(&fraction),
                    "round {round}: a crack {part} {p:?} {q:?} {off} {fraction}"
                );
            }
        }
    }
}

/// A spike that runs back over itself, and polygons without area, leave nothing.
#[test]
fn what_has_no_area_leaves_nothing() {
    let clipped = |rings: &[Ring]| {
        let mut builder = TinBuilder::default();
        let [x, y] = [500_000.0, 4_649_000.0];
        builder.add_points(
            &[x, x + 90.0, x + 90.0, x],
            &[y, y, y + 90.0, y + 90.0],
            &[1.0, 2.0, 5.0, 3.0],
        );
        let ring = |ring: &Ring| ring.iter().map(|p| [x + p[0], y + p[1]]).collect();
        builder.add_boundary(&rings.iter().map(ring).collect::<Vec<Ring>>());
        builder.build().unwrap()
    };
    let square: Ring = vec![[10.0, 10.0], [30.0, 10.0], [30.0, 30.0], [10.0, 30.0]];
    // From a corner to 50.1 70.3, returning through a site at a tenth of the distance, rounded.
    let mut spike = square.clone();
    spike.splice(
        2..3,
        [
            [30.0, 30.0],
            [50.1, 70.3],
            [30.0 + 0.1 * 20.1, 30.0 + 0.1 * 40.3],
            [30.0, 30.0],
        ],
    );
    assert_eq!(
        vertices(&clipped(&[spike])).len(),
        vertices(&clipped(&[square])).len()
    );
    for flat in [
        vec![
            [10.0, 10.0],
            [50.1, 70.3],
            [10.0 + 0.3 * 40.1, 10.0 + 0.3 * 60.3],
        ],
        vec![[10.0, 10.0], [50.1, 70.3], [10.0, 10.0]],
        vec![[10.0, 10.0], [10.0, 10.0], [10.0, 10.0]],
    ] {
        assert_eq!(clipped(&[flat]).report().triangles, 0);
    }
}

/// Rings that cross in the middle of a flat triangle, and one through a vertex of the surface.
#[test]
fn rings_that_cross_each_other_find_the_height_of_the_ground() {
    let mut builder = TinBuilder::default();
    builder.add_points(
        &[0.0, 8.0, 8.0, 0.0, 3.0],
        &[0.0, 0.0, 8.0, 8.0, 3.0],
        &[0.5; 5],
    );
    builder.add_boundary(&[
        vec![[1.0, 1.0], [5.0, 5.0], [5.0, 2.0], [1.0, 6.0]],
        vec![[3.0, 3.0], [7.0, 4.0], [2.0, 7.3]],
    ]);
    let tin = builder.build().unwrap();
    assert!(tin.report().triangles > 4);
    assert!(vertices(&tin).iter().all(|p| p[2] == 0.5));
}

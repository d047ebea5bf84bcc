//! Surfaces clipped to polygons, against the even-odd rule by rays.

mod common;

use breakline::terrain::TinBuilder;
use breakline::triangulation::Level;
use common::random::Random;

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
        let [x, y] = self.any().map(|c| c.clamp(0.0, f64::from(SIDE) * self.scale));
        [x, y, height([x, y])]
    }

    fn ring(&mut self) -> Ring {
        (0..3 + self.random.below(4)).map(|_| self.any()).collect()
    }
}

/// Whether a ray to the left crosses the rings an odd number of times.
fn is_within(rings: &[Ring], [x, y]: [f64; 2]) -> bool {
    let sides = rings.iter().flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()])));
    let crosses = |&([ax, ay], [bx, by]): &([f64; 2], [f64; 2])| {
        (ay <= y) != (by <= y) && ax + (y - ay) / (by - ay) * (bx - ax) < x
    };
    sides.filter(crosses).count() % 2 == 1
}

/// Rings that cross themselves and each other, over breaklines that do so too, many edges in common: what is inside of any
/// polygon is there, and nothing else.
#[test]
fn what_stays_is_what_lies_in_any_polygon() {
    let (mut inside, mut outside) = (0, 0);
    for round in 0..300 {
        let scale = [1.0, 0.37][round % 2];
        let mut corners = Corners { random: Random(round as u64), scale };
        let mut builder = TinBuilder::default();
        let mut add = |[x, y, z]: [f64; 3]| builder.add_points(&[x], &[y], &[z]);
        for place in [[0, 0], [SIDE, 0], [SIDE, SIDE], [0, SIDE]].map(|p| p.map(|c| f64::from(c) * scale)) {
            add([place[0], place[1], height(place)]);
        }
        (0..corners.random.below(30)).for_each(|_| add(corners.within()));
        let polygons: Vec<Vec<Ring>> = (0..1 + corners.random.below(3))
            .map(|_| (0..1 + corners.random.below(2)).map(|_| corners.ring()).collect())
            .collect();
        polygons.iter().for_each(|rings| builder.add_boundary(rings));
        for _ in 0..corners.random.below(4) {
            builder.add_breakline(&[(); 3].map(|()| corners.within()));
        }
        // A side of a polygon that is a breakline, too, where it is within the data.
        let [p, q] = [0, 1].map(|i| polygons[0][0][i]);
        if [p, q].iter().flatten().all(|c| (0.0..=f64::from(SIDE) * scale).contains(c)) {
            builder.add_breakline(&[p, q].map(|p| [p[0], p[1], height(p)]));
        }
        let tin = builder.build().unwrap();
        assert!(tin.check(Level::Law).is_empty(), "round {round}");
        for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
            let place = [(f64::from(i) + OFF[0]) * scale, (f64::from(j) + OFF[1]) * scale];
            let expected = polygons.iter().any(|rings| is_within(rings, place));
            let found = tin.elevation(place[0], place[1]);
            assert_eq!(found.is_some(), expected, "round {round} at {place:?}: {polygons:?}");
            let is_on_ground = |z: f64| (z - height(place)).abs() < 1e-9;
            assert!(found.is_none_or(is_on_ground), "round {round} at {place:?}: {found:?}");
            *(if expected { &mut inside } else { &mut outside }) += 1;
        }
    }
    assert!(inside > 2000 && outside > 2000, "{inside} {outside}");
}

/// Boxes around nothing but a place, and wider than the numbers that can be computed with.
#[test]
fn bounds_may_be_endless() {
    use breakline::data::Bounds;
    let tin = |min: [f64; 2], max: [f64; 2]| {
        let mut builder = TinBuilder::default();
        builder.add_points(&[0.0, 8.0, 8.0, 0.0], &[0.0, 0.0, 8.0, 8.0], &[1.0; 4]);
        builder.bounds = Some(Bounds { min: [min[0], min[1], 0.0], max: [max[0], max[1], 9.0] });
        builder.build()
    };
    let half = tin([f64::NEG_INFINITY, 1e-300], [4.0, f64::INFINITY]).unwrap();
    assert_eq!([half.elevation(3.0, 7.0), half.elevation(5.0, 7.0)], [Some(1.0), None]);
    let error = tin([0.0, f64::NAN], [4.0, 4.0]).unwrap_err();
    assert_eq!(error.to_string(), "boundary: [0.0, NaN, 0.0] is not a finite point");
}

/// A field of many parcels beside each other, each a polygon of its own: none is left out, no side is in the way.
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

//! Terrain that was made, with what each point is.

use super::super::{Bridges, GroundGrid, GroundGridFinder, GroundOptions, PointClass};
use super::{Numbers, classes};

use PointClass::{Ground, HighNoise, LowNoise, Object};

/// Points of a terrain, one for each square meter, with things on it.
struct Scene {
    points: Vec<[f64; 3]>,
    expected: Vec<PointClass>,
}

impl Scene {
    /// A square of this side; `at` returns what is at a position, and its height.
    fn new(side: u32, at: impl Fn(f64, f64) -> (PointClass, f64)) -> Scene {
        let mut numbers = Numbers(5);
        let mut scene = Scene {
            points: Vec::new(),
            expected: Vec::new(),
        };
        for row in 0..side {
            for column in 0..side {
                let x = f64::from(column) + numbers.unit();
                let y = f64::from(row) + numbers.unit();
                let (class, z) = at(x, y);
                scene.add(class, [x, y, z + 0.05 * numbers.unit()]);
            }
        }
        scene
    }

    fn add(&mut self, class: PointClass, point: [f64; 3]) {
        self.points.push(point);
        self.expected.push(class);
    }

    /// The share of points that are classified differently.
    fn wrong(&self, options: &GroundOptions) -> f64 {
        let found = classes(&self.points, options);
        let wrong = found.iter().zip(&self.expected).filter(|(a, b)| a != b);
        wrong.count() as f64 / found.len() as f64
    }
}

fn is_in(x: f64, y: f64, low: [f64; 2], high: [f64; 2]) -> bool {
    x >= low[0] && x < high[0] && y >= low[1] && y < high[1]
}

/// Boxes of 10 m, 5 m high, one in each square of 30 m.
fn is_box(x: f64, y: f64) -> bool {
    is_in(x % 30.0, y % 30.0, [10.0; 2], [20.0; 2])
}

#[test]
fn a_plane_is_ground() {
    let scene = Scene::new(60, |_, _| (Ground, 100.0));
    assert_eq!(scene.wrong(&GroundOptions::default()), 0.0);
}

#[test]
fn boxes_on_a_plane_are_objects() {
    let scene = Scene::new(90, |x, y| match is_box(x, y) {
        true => (Object, 105.0),
        false => (Ground, 100.0),
    });
    assert_eq!(scene.wrong(&GroundOptions::default()), 0.0);
}

#[test]
fn boxes_on_a_slope_are_objects() {
    let scene = Scene::new(90, |x, y| match is_box(x, y) {
        true => (Object, 105.0 + 0.4 * x),
        false => (Ground, 100.0 + 0.4 * x),
    });
    assert!(scene.wrong(&GroundOptions::default()) < 0.01);
}

#[test]
fn a_terrace_is_ground() {
    // A wall of 3 m all along.
    let scene = Scene::new(90, |x, _| (Ground, if x < 45.0 { 100.0 } else { 103.0 }));
    assert!(scene.wrong(&GroundOptions::default()) < 0.01);
}

#[test]
fn a_large_hall_is_an_object() {
    let scene = Scene::new(150, |x, y| match is_in(x, y, [45.0; 2], [105.0; 2]) {
        true => (Object, 108.0),
        false => (Ground, 100.0),
    });
    assert!(scene.wrong(&GroundOptions::default()) < 0.01);
}

/// A valley of 30 m, 6 m deep, and a bridge of 8 m across it.
fn bridge(class: PointClass) -> Scene {
    Scene::new(120, |x, y| {
        let is_over = (45.0..75.0).contains(&x);
        match (is_over, (56.0..64.0).contains(&y)) {
            (true, true) => (class, 100.0),
            (true, false) => (Ground, 94.0),
            _ => (Ground, 100.0),
        }
    })
}

#[test]
fn a_bridge_is_what_was_asked_for() {
    for (class, bridges) in [(Object, Bridges::OffGround), (Ground, Bridges::Ground)] {
        let options = GroundOptions {
            bridges,
            ..GroundOptions::default()
        };
        assert!(bridge(class).wrong(&options) < 0.01, "{bridges:?}");
    }
}

#[test]
fn points_far_below_and_alone_in_the_air_are_noise_where_it_is_asked_for() {
    let with_noise = |low, high| {
        let mut scene = Scene::new(90, |x, y| match is_box(x, y) {
            true => (Object, 105.0),
            false => (Ground, 100.0),
        });
        scene.add(low, [25.5, 25.5, 80.0]);
        scene.add(low, [55.2, 25.1, -1e7]);
        scene.add(high, [40.0, 40.0, 180.0]);
        scene.add(high, [70.0, 40.0, 1e300]);
        scene
    };
    let options = GroundOptions {
        noise: true,
        ..GroundOptions::default()
    };
    assert_eq!(with_noise(LowNoise, HighNoise).wrong(&options), 0.0);
    let options = GroundOptions::default();
    assert_eq!(with_noise(Object, Object).wrong(&options), 0.0);
}

/// What has no answer that is better than others must not fail.
#[test]
fn degenerate_input_is_classified() {
    let options = GroundOptions {
        noise: true,
        ..GroundOptions::default()
    };
    assert_eq!(classes(&[], &options), []);
    for point in [[0.0; 3], [1e9, -1e9, 5.0], [1e300, 1e300, -1e300]] {
        assert_eq!(classes(&[point], &options), [Ground]);
        assert_eq!(classes(&[point; 5], &options), [Ground; 5]);
    }
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut point = [1.0; 3];
            point[axis] = broken;
            assert_eq!(classes(&[point], &options), [Object]);
            assert_eq!(classes(&[[0.0; 3], point, [1.0; 3]], &options)[1], Object);
        }
    }
    let line: Vec<[f64; 3]> = (0..500).map(|at| [f64::from(at), 0.0, 3.0]).collect();
    assert_eq!(classes(&line, &options), vec![Ground; 500]);
    let diagonal: Vec<[f64; 3]> = (0..500).map(|at| [f64::from(at); 3]).collect();
    assert_eq!(classes(&diagonal, &options).len(), 500);
}

#[test]
fn points_far_apart_are_refused_with_a_cure() {
    let error = super::classify(
        &[[0.0; 3], [1e9, 1e9, 0.0], [1e9, 0.0, 0.0]],
        &GroundOptions::default(),
        &std::sync::atomic::AtomicBool::new(false),
    )
    .unwrap_err();
    assert_eq!(error.kind(), crate::error::Kind::Limit);
    assert!(
        error
            .to_string()
            .contains("3 points over 1000000000 by 1000000000 m")
    );
    assert!(error.cure_text().is_some());
}

#[test]
fn canceled_work_ends() {
    let canceled = std::sync::atomic::AtomicBool::new(true);
    let error = super::classify(&[[0.0; 3]], &GroundOptions::default(), &canceled).unwrap_err();
    assert_eq!(error.kind(), crate::error::Kind::Canceled);
}

/// A hillside with boxes, points on a lattice so that many are equally low, and some twice.
fn ties() -> Vec<[f64; 3]> {
    let mut numbers = Numbers(6);
    (0..9000)
        .map(|_| {
            let [x, y] = [0, 1].map(|_| 0.5 * f64::from(numbers.below(180)));
            let up = 5.0 * f64::from(u8::from(is_box(x, y))) + f64::from(numbers.below(3)) / 4.0;
            [x, y, (0.8 * x).floor() + up]
        })
        .collect()
}

#[test]
fn neither_the_order_of_the_points_nor_the_threads_matter() {
    let options = GroundOptions {
        noise: true,
        ..GroundOptions::default()
    };
    let points = ties();
    let expected = classes(&points, &options);
    assert!(
        [Ground, Object]
            .iter()
            .all(|class| expected.contains(class))
    );
    let mut order: Vec<usize> = (0..points.len()).collect();
    let mut numbers = Numbers(7);
    for at in (1..order.len()).rev() {
        order.swap(at, numbers.below(at as u32 + 1) as usize);
    }
    let shuffled: Vec<[f64; 3]> = order.iter().map(|&at| points[at]).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(5).build();
    let found = pool.unwrap().install(|| classes(&shuffled, &options));
    for (&at, &class) in order.iter().zip(&found) {
        assert_eq!(class, expected[at]);
    }
}

#[test]
fn the_grid_of_the_points_is_the_default() {
    let points = ties();
    let options = GroundOptions {
        grid: GroundGrid::of(&points),
        ..GroundOptions::default()
    };
    assert_eq!(
        classes(&points, &options),
        classes(&points, &GroundOptions::default())
    );
    // Given in parts, in another order.
    let mut finders = [GroundGridFinder::default(), GroundGridFinder::default()];
    for (at, point) in points.iter().rev().enumerate() {
        finders[at % 2].add(&[*point]);
    }
    let [mut first, second] = finders;
    first.merge(&second);
    assert_eq!(first.grid(), options.grid);
    assert_eq!(GroundGridFinder::default().grid(), None);
}

/// A tile agrees with the whole, away from its border, if it has the grid of the whole.
#[test]
fn a_tile_agrees_with_the_whole() {
    let whole = Scene::new(290, |x, y| {
        let z = 100.0 + 0.2 * x + 4.0 * (y / 40.0).sin();
        match is_box(x, y) {
            true => (Object, z + 5.0),
            false => (Ground, z),
        }
    });
    let all = classes(&whole.points, &GroundOptions::default());
    let grid = GroundGrid::of(&whole.points).unwrap();
    let options = GroundOptions {
        grid: Some(grid),
        ..GroundOptions::default()
    };
    let reach = grid.reach();
    let tile = |margin: f64| {
        let (points, all): (Vec<[f64; 3]>, Vec<PointClass>) = whole
            .points
            .iter()
            .zip(&all)
            .filter(|(p, _)| is_in(p[0], p[1], [135.3 - margin; 2], [155.9 + margin; 2]))
            .unzip();
        (points, all)
    };
    let (points, expected) = tile(reach);
    let found = classes(&points, &options);
    for (point, (found, expected)) in points.iter().zip(found.iter().zip(&expected)) {
        if is_in(point[0], point[1], [135.3; 2], [155.9; 2]) {
            assert_eq!(found, expected, "{point:?}");
        }
    }
}

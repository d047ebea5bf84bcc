//! Bounds over points of which not all are read: if the report says that they suffice, the surface
//! is that of all points.
//!
//! The environment sets the number of scenes:
//!
//! ```text
//! BREAKLINE_WINDOWS=20000 cargo test --release --test bounds_of_what_is_read
//! ```

use std::collections::BTreeSet;

use breakline::data::{Bounds, Surface};
use breakline::terrain::{ReadWindow, Tin, TinBuilder};
use testkit::random::Random;

/// A scene: points, breaklines, and what is asked for.
struct Scene {
    points: Vec<[f64; 3]>,
    lines: Vec<Vec<[f64; 3]>>,
    bounds: Bounds,
    max_edge: Option<f64>,
    leave_out_caps: bool,
}

const SIDE: u64 = 64;

impl Scene {
    fn new(random: &mut Random) -> Self {
        let step = random.pick(&[1.0, 0.37]);
        let at = |random: &mut Random, side: u64| {
            let [x, y] = [0, 1].map(|_| random.below(side + 1) as f64 * step);
            [x, y, random.around(40) as f64 / 4.0]
        };
        // Many in some parts, few in others: large circles.
        let centers: Vec<[f64; 3]> = (0..3).map(|_| at(random, SIDE)).collect();
        let mut points: Vec<[f64; 3]> = (0..40).map(|_| at(random, SIDE)).collect();
        for _ in 0..300 {
            let [x, y, _] = random.pick(&centers);
            let near = at(random, 16);
            points.push([x + near[0] - 8.0 * step, y + near[1] - 8.0 * step, near[2]]);
        }
        let lines = (0..random.below(8))
            .map(|_| (0..2 + random.below(3)).map(|_| at(random, SIDE)).collect())
            .collect();
        let (p, size) = (at(random, SIDE - 16), (2 + random.below(14)) as f64 * step);
        let bounds = Bounds {
            min: [p[0], p[1], 0.0],
            max: [p[0] + size, p[1] + size, 0.0],
        };
        Scene {
            points,
            lines,
            bounds,
            max_edge: random.pick(&[None, Some(6.0 * step), Some(12.0 * step)]),
            leave_out_caps: random.below(2) == 0,
        }
    }

    fn builder(&self, read: impl Fn(&[f64; 3]) -> bool) -> TinBuilder {
        let mut builder = TinBuilder::default();
        builder.bounds = Some(self.bounds);
        builder.max_edge = self.max_edge;
        builder.leave_out_caps = self.leave_out_caps;
        builder.add_owned_points(self.points.iter().copied().filter(|p| read(p)).collect());
        self.lines
            .iter()
            .for_each(|line| builder.add_breakline(line));
        builder
    }

    /// Of the points no further than this from the bounds.
    fn read(&self, buffer: f64) -> Option<Tin> {
        let Bounds { min, max } = self.bounds;
        let read = Bounds {
            min: min.map(|c| c - buffer),
            max: max.map(|c| c + buffer),
        };
        let mut all = Bounds::default();
        self.points.iter().for_each(|&p| all.add(p));
        let mut builder = self.builder(|p| read.holds(p[0], p[1]));
        builder.window = Some(ReadWindow {
            read,
            all: vec![all],
        });
        builder.build().ok()
    }
}

fn seeds() -> u64 {
    std::env::var("BREAKLINE_WINDOWS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(200)
}

/// The triangles of a surface, wherever they are numbered.
fn triangles(surface: &dyn Surface) -> BTreeSet<[[u64; 3]; 3]> {
    let corners = (0..surface.face_count() as u32).filter_map(|face| surface.face(face));
    let positions = corners.map(|corners| corners.map(|v| surface.position(v).map(f64::to_bits)));
    let sorted = positions.map(|mut corners| {
        corners.sort_unstable();
        corners
    });
    sorted.collect()
}

#[test]
fn what_is_called_certain_is_what_all_points_make() {
    let (mut parts, mut steps) = (0, 0);
    for seed in 0..seeds() {
        let scene = Scene::new(&mut Random(seed));
        let Ok(whole) = scene.builder(|_| true).build() else {
            continue;
        };
        let mut buffer = 1.0;
        let tin = loop {
            match scene.read(buffer) {
                Some(tin) if tin.report().uncertain == 0 => break tin,
                _ => buffer *= 1.5,
            }
            steps += 1;
        };
        assert!(
            triangles(&tin) == triangles(&whole),
            "seed {seed}, {buffer} read"
        );
        parts += usize::from(tin.report().points < scene.points.len());
    }
    assert!(
        parts as u64 > seeds() / 4 && steps > seeds(),
        "{parts} parts, {steps} steps"
    );
}

/// Without the certificate the same windows give other surfaces: the test above can fail.
#[test]
fn a_window_that_is_too_small_gives_another_surface() {
    let differs = |seed: &u64| {
        let scene = Scene::new(&mut Random(*seed));
        let (Some(part), Ok(whole)) = (scene.read(1.0), scene.builder(|_| true).build()) else {
            return false;
        };
        let differs = triangles(&part) != triangles(&whole);
        assert!(!differs || part.report().uncertain > 0, "seed {seed}");
        differs
    };
    assert!((0..100).filter(differs).count() > 50);
}

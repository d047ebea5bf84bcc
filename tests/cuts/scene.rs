//! Adversarial surfaces and clip polygons.

use breakline::data::Bounds;
use breakline::terrain::TinBuilder;

use testkit::random::{Random, ulps};

pub(crate) type Site = [f64; 2];
pub(crate) type Ring = Vec<Site>;

/// The origin and the step of the grid on which scenes are drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    origin: Site,
    step: f64,
}

pub(crate) const UNITS: [Units; 3] = [
    Units {
        origin: [0.0, 0.0],
        step: 1.0,
    },
    Units {
        origin: [500_000.0, 4_649_000.0],
        step: 1.37,
    },
    // On both sides of powers of two, where the doubles are twice as dense below as above.
    Units {
        origin: [524_280.0, 4_194_296.0],
        step: 0.81,
    },
];

/// Cells of the grid on a side.
const SIDE: u64 = 16;

/// What is drawn.
#[derive(Debug, Default)]
pub(crate) struct Scene {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) breaklines: Vec<Vec<[f64; 3]>>,
    pub(crate) polygons: Vec<Vec<Ring>>,
    pub(crate) bounds: Option<Bounds>,
    pub(crate) max_edge: Option<f64>,
}

/// Adds what the surface is clipped to.
pub(crate) type Draw = fn(&mut Scene, &mut Random, Units);

pub(crate) const KINDS: [(&str, Draw); 10] = [
    ("anything", anything),
    ("adjacent polygons", adjacent),
    ("corners on sides", corners_on_sides),
    ("spikes", spikes),
    ("no area", no_area),
    ("holes that touch", holes),
    ("through vertices", through_vertices),
    ("across breaklines", across_breaklines),
    ("bounds", bounds),
    ("far corners", far_corners),
];

impl Units {
    fn at(&self, [i, j]: [f64; 2]) -> Site {
        [
            self.origin[0] + i * self.step,
            self.origin[1] + j * self.step,
        ]
    }

    /// A corner of the grid, within the data or a little beyond.
    fn corner(&self, random: &mut Random) -> Site {
        self.at([0, 1].map(|_| random.below(SIDE + 5) as f64 - 2.0))
    }

    fn ring(&self, random: &mut Random) -> Ring {
        (0..3 + random.below(5))
            .map(|_| self.corner(random))
            .collect()
    }
}

impl Scene {
    pub(crate) fn new(random: &mut Random, units: Units, draw: Draw) -> Self {
        let mut scene = Scene::default();
        let side = SIDE as f64;
        let height = |random: &mut Random| random.around(40) as f64 / 4.0;
        for [i, j] in [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]] {
            let [x, y] = units.at([i, j]);
            scene.points.push([x, y, height(random)]);
        }
        let within = |random: &mut Random| {
            let [x, y] = units.at([0, 1].map(|_| random.below(SIDE + 1) as f64));
            [x, y, random.around(40) as f64 / 4.0]
        };
        for _ in 0..random.below(25) {
            scene.points.push(within(random));
        }
        for _ in 0..random.below(3) {
            let length = 2 + random.below(2);
            scene
                .breaklines
                .push((0..length).map(|_| within(random)).collect());
        }
        scene.max_edge = (random.below(4) == 0).then_some(0.4 * side * units.step);
        draw(&mut scene, random, units);
        scene
    }

    /// With all that is to be built, clipped or not.
    pub(crate) fn builder(&self) -> TinBuilder {
        let mut builder = TinBuilder::default();
        for &[x, y, z] in &self.points {
            builder.add_points(&[x], &[y], &[z]);
        }
        self.breaklines
            .iter()
            .for_each(|line| builder.add_breakline(line));
        builder.max_edge = self.max_edge;
        builder
    }

    /// The closed curves with the domain that each bounds: 0 for the bounds, polygons count from 1.
    pub(crate) fn curves(&self) -> Vec<(usize, Ring)> {
        let polygons = self.polygons.iter().zip(1..);
        let mut curves: Vec<(usize, Ring)> = polygons
            .flat_map(|(rings, number)| rings.iter().map(move |ring| (number, ring.clone())))
            .collect();
        if let Some(Bounds { min, max }) = self.bounds {
            curves.push((
                0,
                vec![
                    [min[0], min[1]],
                    [max[0], min[1]],
                    [max[0], max[1]],
                    [min[0], max[1]],
                ],
            ));
        }
        curves
    }

    /// Returns true if the part of the surface in these domains is kept.
    pub(crate) fn is_kept(&self, within: impl Fn(usize) -> bool) -> bool {
        let in_polygon = self.polygons.is_empty() || (1..=self.polygons.len()).any(&within);
        in_polygon && (self.bounds.is_none() || within(0))
    }
}

fn anything(scene: &mut Scene, random: &mut Random, units: Units) {
    for _ in 0..1 + random.below(3) {
        scene.polygons.push(
            (0..1 + random.below(2))
                .map(|_| units.ring(random))
                .collect(),
        );
    }
}

/// Two polygons on both sides of a line of some corners.
fn adjacent(scene: &mut Scene, random: &mut Random, units: Units) {
    let (side, parts) = (SIDE as f64, 1 + random.below(5));
    let between: Ring = (0..=parts)
        .map(|k| {
            let x = k as f64 / parts as f64 * (side + 2.0) - 1.0;
            units.at([x, 4.0 + random.below(8) as f64])
        })
        .collect();
    let mut below = between.clone();
    below.extend([units.at([side + 1.0, -1.0]), units.at([-1.0, -1.0])]);
    let mut above = between;
    above.extend([
        units.at([side + 1.0, side - 1.0]),
        units.at([-1.0, side - 1.0]),
    ]);
    if random.below(2) == 0 {
        above.reverse();
    }
    scene.polygons.extend([vec![below], vec![above]]);
}

/// A polygon with a corner in the middle of a side of another one, exactly or up to rounding.
fn corners_on_sides(scene: &mut Scene, random: &mut Random, units: Units) {
    let (a, b, c) = (
        units.corner(random),
        units.corner(random),
        units.corner(random),
    );
    let part = random.pick(&[0.5, 0.25, 1.0 / 3.0, 0.7]);
    let middle = [0, 1].map(|k| a[k] + part * (b[k] - a[k]));
    scene.polygons.push(vec![vec![a, b, c]]);
    let [d, e] = [units.corner(random), units.corner(random)];
    scene.polygons.push(vec![match random.below(3) {
        0 => vec![middle, d, e],
        1 => vec![a, middle, d],
        _ => vec![a, middle, b, d],
    }]);
}

/// A ring that runs to a point and returns, past sites on its first half or through them, exactly
/// or nearly.
fn spikes(scene: &mut Scene, random: &mut Random, units: Units) {
    let mut ring = units.ring(random);
    let at = random.index(ring.len());
    let from = ring[at];
    let tip = units.corner(random);
    let part = random.unit();
    let between = [0, 1].map(|k| ulps(from[k] + part * (tip[k] - from[k]), random.around(1)));
    ring.splice(
        at + 1..at + 1,
        if random.below(2) == 0 {
            vec![tip, between]
        } else {
            vec![between, tip, from]
        },
    );
    scene.polygons.push(vec![ring]);
}

/// Polygons that enclose nothing beside one that does.
fn no_area(scene: &mut Scene, random: &mut Random, units: Units) {
    let [a, b] = [units.corner(random), units.corner(random)];
    let between = [0, 1].map(|k| a[k] + 0.5 * (b[k] - a[k]));
    scene.polygons.push(vec![
        random
            .pick(&[&[a, b, between][..], &[a, b, a], &[a, b], &[a, a, a]])
            .to_vec(),
    ]);
    if random.below(2) == 0 {
        scene.polygons.push(vec![units.ring(random)]);
    }
}

/// A hole with a corner on its polygon's side, an island in it, and another hole that shares a
/// corner.
fn holes(scene: &mut Scene, random: &mut Random, units: Units) {
    let side = SIDE as f64;
    let square = |low: [f64; 2], high: [f64; 2]| {
        [
            [low[0], low[1]],
            [high[0], low[1]],
            [high[0], high[1]],
            [low[0], high[1]],
        ]
        .map(|p| units.at(p))
        .to_vec()
    };
    let hole = vec![
        units.at([1.0, random.below(SIDE) as f64]),
        units.corner(random),
        units.corner(random),
    ];
    let shared = hole[random.index(3)];
    let island = vec![shared, units.corner(random), units.corner(random)];
    let mut rings = vec![square([1.0, 1.0], [side - 1.0, side - 2.0]), hole, island];
    random.shuffle(&mut rings);
    scene.polygons.push(rings);
}

/// Sides that pass exactly through the surface's vertices, or end there.
fn through_vertices(scene: &mut Scene, random: &mut Random, units: Units) {
    let vertex = |scene: &Scene, random: &mut Random| {
        let [x, y, _] = scene.points[random.index(scene.points.len())];
        [x, y]
    };
    for _ in 0..1 + random.below(2) {
        let (p, q) = (vertex(scene, random), vertex(scene, random));
        let beyond = [0, 1].map(|k| q[k] + (q[k] - p[k]));
        let third = if random.below(2) == 0 {
            vertex(scene, random)
        } else {
            units.corner(random)
        };
        scene.polygons.push(vec![vec![p, beyond, third]]);
    }
}

/// Sides that run between existing vertices, over a breakline that is higher than everything else.
fn across_breaklines(scene: &mut Scene, random: &mut Random, units: Units) {
    let (j, side) = (4 + random.below(8), SIDE as f64);
    let [[x, y], [u, v]] = [units.at([0.0, j as f64]), units.at([side, j as f64])];
    scene.breaklines = vec![vec![[x, y, 30.0], [u, v, 34.0]]];
    let ring: Ring = (0..4 + random.below(4))
        .map(|k| {
            let above = if k % 2 == 0 { 1.0 } else { -1.0 };
            units.at([
                random.below(SIDE) as f64,
                j as f64 + above * (1 + random.below(3)) as f64,
            ])
        })
        .collect();
    scene.points.extend(
        ring.iter()
            .filter(|_| random.below(2) == 0)
            .map(|&[x, y]| [x, y, 1.0]),
    );
    scene.polygons.push(vec![ring]);
}

fn bounds(scene: &mut Scene, random: &mut Random, units: Units) {
    let (a, b) = (units.corner(random), units.corner(random));
    let [min, max] = [
        [a[0].min(b[0]), a[1].min(b[1]), 0.0],
        [a[0].max(b[0]), a[1].max(b[1]), 0.0],
    ];
    scene.bounds = Some(Bounds { min, max });
    if random.below(2) == 0 {
        scene.polygons.push(vec![units.ring(random)]);
    }
}

/// A polygon and bounds of which some corners are as far away as "no limit" is.
fn far_corners(scene: &mut Scene, random: &mut Random, units: Units) {
    let far =
        |random: &mut Random| random.around(1) as f64 * 2.0_f64.powi(4 + random.below(57) as i32);
    let mut ring = units.ring(random);
    for _ in 0..1 + random.below(3) {
        let at = random.index(ring.len());
        ring[at] = ring[at].map(|x| x + far(random));
    }
    if random.below(3) > 0 {
        scene.polygons.push(vec![ring]);
    }
    if scene.polygons.is_empty() || random.below(2) == 0 {
        bounds(scene, random, units);
        if let Some(Bounds { min, max }) = &mut scene.bounds {
            (0..2).for_each(|k| {
                (min[k], max[k]) = (min[k] - far(random).abs(), max[k] + far(random).abs())
            });
        }
    }
}

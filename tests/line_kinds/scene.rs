//! Random sets of lines and areas of all kinds over points, on small integer grids.

use breakline::data::Bounds;
use breakline::terrain::{Flat, FlatHeight, HighSide, River, Tin, TinBuilder, Wall};
use testkit::random::Random;

/// Cells on each side of the grid.
pub(crate) const SIDE: i64 = 12;

pub(crate) type Ring = Vec<[i64; 2]>;
pub(crate) type Line = Vec<[i64; 3]>;

/// Lines and areas over points.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scene {
    pub(crate) points: Line,
    pub(crate) hard: Vec<Line>,
    pub(crate) soft: Vec<Line>,
    /// Upper edges, whose lower edges are 3 lower.
    pub(crate) walls: Vec<Line>,
    /// Rings with the height of the water.
    pub(crate) lakes: Vec<(Ring, i64)>,
    /// Lines along the middle of rivers.
    pub(crate) rivers: Vec<Line>,
    pub(crate) holes: Vec<Ring>,
    pub(crate) draped: Vec<Line>,
    /// The lower left and upper right corner of the box that the surface is clipped to.
    pub(crate) bounds: Option<[[i64; 2]; 2]>,
}

/// The width of walls in a scene.
pub(crate) const WALL: f64 = 1.0 / 1024.0;

/// The width of rivers in a scene.
pub(crate) const RIVER: f64 = 1.0;

impl Scene {
    /// A scene with up to a few of each kind, of which `kinds` selects some (a bit for each).
    pub(crate) fn random(random: &mut Random, kinds: u64) -> Self {
        let mut scene = Scene::default();
        for corner in [[0, 0], [SIDE, 0], [0, SIDE], [SIDE, SIDE]] {
            scene
                .points
                .push([corner[0], corner[1], random.below(9) as i64]);
        }
        for _ in 0..random.below(40) {
            let [x, y] = site(random, 0);
            scene.points.push([x, y, random.below(9) as i64]);
        }
        let count = |random: &mut Random, bit: u64| {
            if kinds >> bit & 1 == 1 {
                1 + random.below(2)
            } else {
                0
            }
        };
        scene.hard = (0..count(random, 0)).map(|_| line(random, 4)).collect();
        scene.soft = (0..count(random, 1)).map(|_| line(random, 3)).collect();
        scene.walls = (0..count(random, 2)).map(|_| line(random, 3)).collect();
        scene.lakes = (0..count(random, 3))
            .map(|_| (triangle(random), 20 + random.below(3) as i64))
            .collect();
        scene.rivers = (0..count(random, 4)).map(|_| line(random, 3)).collect();
        scene.holes = (0..count(random, 5)).map(|_| triangle(random)).collect();
        scene.draped = (0..count(random, 6)).map(|_| line(random, 3)).collect();
        if random.below(3) == 0 {
            let [[x0, x1], [y0, y1]] = [0, 1].map(|_: u8| {
                let low = random.below(SIDE as u64 / 2) as i64;
                [low, low + 1 + random.below((SIDE - low) as u64) as i64]
            });
            scene.bounds = Some([[x0, y0], [x1, y1]]);
        }
        scene
    }

    /// Builds the surface. `order` shuffles everything that is added.
    pub(crate) fn build(&self, order: u64) -> breakline::Result<Tin> {
        let mut random = Random(order);
        let mut scene = self.clone();
        if order > 0 {
            random.shuffle(&mut scene.points);
            random.shuffle(&mut scene.hard);
            random.shuffle(&mut scene.soft);
            random.shuffle(&mut scene.walls);
            random.shuffle(&mut scene.lakes);
            random.shuffle(&mut scene.rivers);
            random.shuffle(&mut scene.holes);
            random.shuffle(&mut scene.draped);
        }
        let mut kinds: Vec<u32> = (0..8).collect();
        if order > 0 {
            random.shuffle(&mut kinds);
        }
        let bounds = self.bounds.map(|[min, max]| {
            let corner = |[x, y]: [i64; 2], z: f64| [x as f64, y as f64, z];
            Bounds {
                min: corner(min, f64::NEG_INFINITY),
                max: corner(max, f64::INFINITY),
            }
        });
        let mut builder = TinBuilder::default();
        builder.bounds = bounds;
        for kind in kinds {
            scene.add(kind, &mut builder)?;
        }
        builder.build()
    }

    fn add(&self, kind: u32, builder: &mut TinBuilder) -> breakline::Result<()> {
        match kind {
            0 => {
                let axis = |k: usize| {
                    self.points
                        .iter()
                        .map(|p| p[k] as f64)
                        .collect::<Vec<f64>>()
                };
                builder.add_points(&axis(0), &axis(1), &axis(2));
            }
            1 => self
                .hard
                .iter()
                .for_each(|line| builder.add_breakline(&floats(line))),
            2 => self
                .soft
                .iter()
                .for_each(|line| builder.add_soft_line(&floats(line))),
            3 => {
                for upper in &self.walls {
                    builder.add_wall(&wall(upper)?);
                }
            }
            4 => {
                for (ring, height) in &self.lakes {
                    let ring = ring
                        .iter()
                        .map(|p| [p[0] as f64, p[1] as f64, f64::NAN])
                        .collect();
                    builder.add_flat(Flat::new(&[ring], FlatHeight::Given(*height as f64))?);
                }
            }
            5 => {
                for middle in &self.rivers {
                    builder.add_river(River::along(&floats(middle), RIVER)?);
                }
            }
            6 => self
                .holes
                .iter()
                .for_each(|ring| builder.add_hole(&[plan(ring)])),
            _ => self.draped.iter().for_each(|line| {
                builder.add_draped_line(
                    &line
                        .iter()
                        .map(|p| [p[0] as f64, p[1] as f64])
                        .collect::<Vec<_>>(),
                );
            }),
        }
        Ok(())
    }
}

pub(crate) fn wall(upper: &[[i64; 3]]) -> breakline::Result<Wall> {
    let lower: Vec<f64> = upper.iter().map(|p| (p[2] - 3) as f64).collect();
    Wall::new(&floats(upper), &lower, WALL, HighSide::Left)
}

pub(crate) fn floats(line: &[[i64; 3]]) -> Vec<[f64; 3]> {
    line.iter().map(|p| p.map(|c| c as f64)).collect()
}

pub(crate) fn plan(ring: &[[i64; 2]]) -> Vec<[f64; 2]> {
    ring.iter().map(|p| p.map(|c| c as f64)).collect()
}

fn site(random: &mut Random, margin: i64) -> [i64; 2] {
    [0, 0].map(|_: i64| margin + random.below((SIDE - 2 * margin) as u64 + 1) as i64)
}

/// A line of at least two vertices, consecutive ones distinct.
fn line(random: &mut Random, most: u64) -> Line {
    let count = 2 + random.below(most - 1);
    let mut line: Line = Vec::new();
    while (line.len() as u64) < count {
        let [x, y] = site(random, 1);
        if line.last().is_none_or(|last| last[..2] != [x, y]) {
            line.push([x, y, random.below(9) as i64]);
        }
    }
    line
}

/// A closed ring of three corners that are not on one line.
fn triangle(random: &mut Random) -> Ring {
    loop {
        let [a, b, c] = [0, 0, 0].map(|_: u8| site(random, 1));
        if (b[0] - a[0]) * (c[1] - a[1]) != (b[1] - a[1]) * (c[0] - a[0]) {
            return vec![a, b, c, a];
        }
    }
}

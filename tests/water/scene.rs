//! Random rivers, lakes, walls and lines over points. The banks of rivers have their vertices
//! opposite each other.

use std::sync::Arc;

use breakline::data::{Bounds, Layer, Shape};
use breakline::run::{
    Context, EdgeLimit, FlatOptions, FlatRule, Input, LineRequest, LowerEdge, PerRecord, Source,
    SurfaceProduct, SurfaceRequest, TinRequest, WallOptions, triangles,
};
use testkit::random::Random;

use super::plane::{Site, from_to};

/// The length of the sides of the area, in units of a scene.
pub(crate) const SIDE: f64 = 60.0;

/// The width of walls, and of steps.
pub(crate) const STEP: f64 = 0.01;

pub(crate) type Line = Vec<[f64; 3]>;

/// A river as it is drawn.
#[derive(Debug, Clone)]
pub(crate) struct Drawn {
    /// The banks, vertex by vertex opposite each other, in the same order.
    pub(crate) banks: [Line; 2],
    /// Draws the second bank in the other direction.
    turns: bool,
}

/// Closed rings at one height.
#[derive(Debug, Clone)]
pub(crate) struct Lake {
    pub(crate) rings: Vec<Vec<Site>>,
    pub(crate) level: f64,
}

#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// Units of a scene to coordinates: size and origin.
    scale: f64,
    origin: Site,
    pub(crate) points: Line,
    pub(crate) rivers: Vec<Drawn>,
    /// The lines along the middle of the rivers, and their width, if these are drawn.
    middles: Option<(Vec<Line>, f64)>,
    pub(crate) lakes: Vec<Lake>,
    pub(crate) hard: Vec<Line>,
    pub(crate) soft: Vec<Line>,
    /// Upper edges, whose lower edges are 3 lower.
    pub(crate) walls: Vec<Line>,
    pub(crate) draped: Vec<Line>,
    pub(crate) holes: Vec<Vec<Site>>,
    pub(crate) bounds: Option<[Site; 2]>,
}

/// How a river lies that begins within another one.
#[derive(Debug, Clone, Copy)]
enum Next {
    /// In its band: banks lie on each other.
    Same,
    /// Of another width, wider or narrower.
    Wider,
    Turned,
}

type Draw = fn(&mut Scene, &mut Random);

/// What is drawn, by name.
pub(crate) const FAMILIES: &[(&str, Draw)] = &[
    ("a river and lines", |scene, random| {
        scene.add_river(random);
        scene.add_lines(random, 3);
    }),
    ("rivers with bends and lines", |scene, random| {
        scene.add_bent(random, 1);
        scene.add_lines(random, 3);
    }),
    ("walls and lines", |scene, random| {
        for _ in 0..1 + random.below(2) {
            scene.walls.push(scene.line(random, 30.0, 5.0));
        }
        scene.add_lines(random, 4);
    }),
    ("rivers with bends that cross", |scene, random| {
        scene.add_bent(random, 2)
    }),
    ("rivers that cross", |scene, random| {
        for _ in 0..2 + random.below(2) {
            scene.add_river(random);
        }
    }),
    ("rivers that overlap at their ends", |scene, random| {
        scene.add_rivers_in_a_row(random, &[Next::Wider, Next::Turned])
    }),
    ("rivers in one band", |scene, random| {
        scene.add_rivers_in_a_row(random, &[Next::Same, Next::Same, Next::Wider, Next::Turned]);
    }),
    ("waters that touch", |scene, random| {
        scene.add_touching(random)
    }),
    ("confluences", |scene, random| scene.add_confluences(random)),
    ("confluences and lines", |scene, random| {
        scene.add_confluences(random);
        scene.add_lines(random, 3);
    }),
    ("rivers and lakes", |scene, random| {
        for _ in 0..1 + random.below(2) {
            scene.add_river(random);
        }
        scene.add_lake(random);
    }),
    ("lakes and lines", |scene, random| {
        scene.add_lake(random);
        scene.add_lines(random, 4);
    }),
    ("all of it", |scene, random| {
        for _ in 0..2 {
            scene.add_river(random);
        }
        scene.add_lake(random);
        scene.add_lines(random, 3);
    }),
];

/// Directions of length 1, the rational ones first.
fn direction(random: &mut Random) -> Site {
    let [a, b, c] = random.pick(&[
        [1.0, 0.0, 1.0],
        [3.0, 4.0, 5.0],
        [5.0, 12.0, 13.0],
        [8.0, 15.0, 17.0],
        [0.0; 3],
    ]);
    let [x, y] = if c == 0.0 {
        let angle = random.unit();
        [angle.cos(), angle.sin()]
    } else {
        [a / c, b / c]
    };
    let [x, y] = if random.below(2) == 0 { [x, y] } else { [y, x] };
    [x * random.pick(&[1.0, -1.0]), y * random.pick(&[1.0, -1.0])]
}

/// A line beside another, to its left, with miters at its corners.
fn beside(line: &[[f64; 3]], by: f64) -> Line {
    let normals: Vec<Site> = line
        .windows(2)
        .map(|pair| {
            let [x, y] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            [-y / x.hypot(y), x / x.hypot(y)]
        })
        .collect();
    let vertex = |(k, p): (usize, &[f64; 3])| {
        let [before, after] = [
            normals[k.saturating_sub(1)],
            normals[k.min(normals.len() - 1)],
        ];
        let sum = [before[0] + after[0], before[1] + after[1]];
        // The sum is twice the cosine of half the turn long, and the miter 1 / cosine.
        let factor = 2.0 * by / (sum[0] * sum[0] + sum[1] * sum[1]);
        [p[0] + factor * sum[0], p[1] + factor * sum[1], p[2]]
    };
    line.iter().enumerate().map(vertex).collect()
}

impl Scene {
    pub(crate) fn new(random: &mut Random, draw: Draw) -> Self {
        let (scale, origin) = random.pick(&[
            (1.0, [0.0, 0.0]),
            (0.25, [-7.0, 3.0]),
            (0.1, [0.3, 0.7]),
            (1.7, [500_000.456, 4_649_000.123]),
            (0.9, [3_000_000.000_001, -12_345.678]),
        ]);
        let mut scene = Scene {
            scale,
            origin,
            points: Vec::new(),
            rivers: Vec::new(),
            middles: None,
            lakes: Vec::new(),
            hard: Vec::new(),
            soft: Vec::new(),
            walls: Vec::new(),
            draped: Vec::new(),
            holes: Vec::new(),
            bounds: None,
        };
        for corner in [
            [-40.0, -40.0],
            [100.0, -40.0],
            [-40.0, 100.0],
            [100.0, 100.0],
        ] {
            let point = scene.at(corner, 20.0 + random.below(9) as f64);
            scene.points.push(point);
        }
        for _ in 0..random.below(60) {
            let point = scene.point(random, 15.0, 12.0);
            scene.points.push(point);
        }
        draw(&mut scene, random);
        scene
    }

    fn located(&self, [x, y]: Site) -> Site {
        [
            self.origin[0] + self.scale * x,
            self.origin[1] + self.scale * y,
        ]
    }

    fn at(&self, site: Site, z: f64) -> [f64; 3] {
        let [x, y] = self.located(site);
        [x, y, z]
    }

    /// A site of the area: on a grid of whole numbers, or any.
    fn site(random: &mut Random) -> Site {
        let is_whole = random.below(2) == 0;
        [0, 0].map(|_| {
            if is_whole {
                random.below(SIDE as u64 + 1) as f64
            } else {
                SIDE * random.unit()
            }
        })
    }

    fn point(&self, random: &mut Random, low: f64, by: f64) -> [f64; 3] {
        let z = low + by * random.unit();
        self.at(Self::site(random), z)
    }

    /// A line of two to four vertices.
    fn line(&self, random: &mut Random, low: f64, by: f64) -> Line {
        (0..2 + random.below(3))
            .map(|_| self.point(random, low, by))
            .collect()
    }

    fn triangle(&self, random: &mut Random) -> Vec<Site> {
        loop {
            let [a, b, c] = [0, 0, 0].map(|_| Self::site(random));
            let [u, v] = [from_to(a, b), from_to(a, c)];
            if (u[0] * v[1] - u[1] * v[0]).abs() > 60.0 {
                return [a, b, c, a].map(|corner| self.located(corner)).to_vec();
            }
        }
    }

    /// Adds lines of all kinds.
    fn add_lines(&mut self, random: &mut Random, most: u64) {
        for _ in 0..1 + random.below(most) {
            match random.below(7) {
                0 | 1 => self.hard.push(self.line(random, 10.0, 30.0)),
                2 => self.soft.push(self.line(random, 10.0, 30.0)),
                3 | 4 => self.walls.push(self.line(random, 30.0, 5.0)),
                5 => self.draped.push(self.line(random, 0.0, 1.0)),
                _ => self.holes.push(self.triangle(random)),
            }
        }
        if random.below(4) == 0 {
            let [x, y] = [0, 0].map(|_| 5.0 + random.below(20) as f64);
            self.bounds = Some([self.located([x, y]), self.located([x + 20.5, y + 25.25])]);
        }
    }

    /// Heights of the banks at stations: falling, now and then rising, and different across.
    fn heights(random: &mut Random, count: usize) -> Vec<[f64; 2]> {
        let mut z = 10.0 + 8.0 * random.unit();
        let is_clean = random.below(2) == 0;
        let heights = (0..count).map(|_| {
            z -= 3.0 * random.unit();
            if is_clean {
                [z, z]
            } else {
                [0, 0].map(|_| z + 1.5 * random.unit())
            }
        });
        let mut heights: Vec<[f64; 2]> = heights.collect();
        // The ends say where it falls to.
        if let Some(last) = heights.last_mut() {
            *last = [z - 2.0; 2];
        }
        heights
    }

    fn add_river(&mut self, random: &mut Random) {
        if random.below(3) == 0 {
            return self.add_wedge(random);
        }
        let [x, y] = [0, 0].map(|_| 20.0 + 20.0 * random.unit());
        let along = direction(random);
        let length = 12.0 + 40.0 * random.unit();
        let start = [x - length / 2.0 * along[0], y - length / 2.0 * along[1]];
        let count = 2 + random.index(5);
        let half = 0.5 + 3.0 * random.unit();
        self.add_straight(random, start, along, length, half, count);
    }

    /// Adds a straight river of one width.
    fn add_straight(
        &mut self,
        random: &mut Random,
        start: Site,
        along: Site,
        length: f64,
        half: f64,
        count: usize,
    ) {
        let mut parts: Vec<f64> = (1..count - 1).map(|_| random.unit()).collect();
        parts.extend([0.0, 1.0]);
        parts.sort_by(f64::total_cmp);
        // Stations are apart.
        let apart = |parts: &[f64]| parts.windows(2).all(|pair| pair[1] - pair[0] > 0.02);
        if !apart(&parts) {
            parts = (0..count).map(|k| k as f64 / (count - 1) as f64).collect();
        }
        let heights = Self::heights(random, parts.len());
        let bank = |side: f64, of: usize| {
            let vertex = |(part, heights): (&f64, &[f64; 2])| {
                let site = [
                    start[0] + length * part * along[0],
                    start[1] + length * part * along[1],
                ];
                self.at(
                    [
                        site[0] - side * half * along[1],
                        site[1] + side * half * along[0],
                    ],
                    heights[of],
                )
            };
            parts.iter().zip(&heights).map(vertex).collect::<Line>()
        };
        let banks = [bank(1.0, 0), bank(-1.0, 1)];
        self.draw(random, banks);
    }

    /// Adds a river of one stretch, which may become wider and has ends at any angle.
    fn add_wedge(&mut self, random: &mut Random) {
        let along = direction(random);
        let [x, y] = [0, 0].map(|_| 20.0 + 20.0 * random.unit());
        let half = 8.0 + 18.0 * random.unit();
        let mut end = |sign: f64| {
            let (reach, skew) = (0.5 + 3.0 * random.unit(), 2.0 * random.unit() - 1.0);
            [1.0, -1.0].map(|side| {
                let [u, v] = [sign * half + side * skew, side * reach];
                [
                    x + u * along[0] - v * along[1],
                    y + u * along[1] + v * along[0],
                ]
            })
        };
        let [from, to] = [end(-1.0), end(1.0)];
        let heights = Self::heights(random, 2);
        let bank = |of: usize| {
            vec![
                self.at(from[of], heights[0][of]),
                self.at(to[of], heights[1][of]),
            ]
        };
        let banks = [bank(0), bank(1)];
        self.draw(random, banks);
    }

    fn draw(&mut self, random: &mut Random, mut banks: [Line; 2]) {
        if random.below(2) == 0 {
            banks.iter_mut().for_each(|bank| bank.reverse());
        }
        if random.below(2) == 0 {
            banks.swap(0, 1);
        }
        self.rivers.push(Drawn {
            banks,
            turns: random.below(2) == 0,
        });
    }

    /// Adds rivers with bends, drawn along their middle.
    fn add_bent(&mut self, random: &mut Random, count: usize) {
        let half = 0.5 + 1.5 * random.unit();
        let mut middles: Vec<Line> = Vec::new();
        for _ in 0..count {
            let mut along = direction(random);
            let [x, y] = [0, 0].map(|_| 20.0 + 20.0 * random.unit());
            let mut site = [x - 20.0 * along[0], y - 20.0 * along[1]];
            let count = 3 + random.index(3);
            let heights = Self::heights(random, count);
            let mut sites = vec![site];
            while sites.len() < heights.len() {
                let length = 6.0 * half + 8.0 * random.unit();
                site = [site[0] + length * along[0], site[1] + length * along[1]];
                sites.push(site);
                let (sin, cos) = (0.8 * random.unit() - 0.4).sin_cos();
                along = [
                    cos * along[0] - sin * along[1],
                    sin * along[0] + cos * along[1],
                ];
            }
            let middle = sites
                .iter()
                .zip(&heights)
                .map(|(&site, z)| self.at(site, z[0]))
                .collect::<Line>();
            let banks = [1.0, -1.0].map(|side| beside(&middle, side * half * self.scale));
            self.rivers.push(Drawn {
                banks,
                turns: false,
            });
            middles.push(middle);
        }
        self.middles = Some((middles, 2.0 * half * self.scale));
    }

    /// Adds rivers of which each begins within the one before, nearly in its direction.
    fn add_rivers_in_a_row(&mut self, random: &mut Random, next: &[Next]) {
        let along = direction(random);
        let mut start = [30.0 - 20.0 * along[0], 30.0 - 20.0 * along[1]];
        let half = 0.5 + 2.0 * random.unit();
        for _ in 0..2 + random.below(2) {
            let length = 12.0 + random.below(8) as f64;
            let count = 2 + random.index(3);
            let (along, half) = match random.pick(next) {
                Next::Same => (along, half),
                Next::Wider => (along, half * (0.6 + random.unit())),
                Next::Turned => {
                    let [x, y] = [along[0] - 0.3 * along[1], along[1] + 0.3 * along[0]];
                    ([x, y].map(|c| c / x.hypot(y)), half * (0.6 + random.unit()))
                }
            };
            self.add_straight(random, start, along, length, half, count);
            let back = length - 1.0 - 5.0 * random.unit();
            start = [start[0] + back * along[0], start[1] + back * along[1]];
        }
    }

    /// Adds a river, and rivers that end or begin at its banks.
    fn add_confluences(&mut self, random: &mut Random) {
        let along = direction(random);
        let (length, half) = (30.0 + 10.0 * random.unit(), 1.0 + 2.0 * random.unit());
        let start = [
            30.0 - length / 2.0 * along[0],
            30.0 - length / 2.0 * along[1],
        ];
        let stretches = 1 + random.index(3);
        let heights = Self::heights(random, stretches + 1);
        let on_bank = |part: f64, side: f64| {
            let [u, v] = [part * length / stretches as f64, side * half];
            [
                start[0] + u * along[0] - v * along[1],
                start[1] + u * along[1] + v * along[0],
            ]
        };
        let bank = |side: f64, of: usize| {
            (0..=stretches)
                .map(|k| self.at(on_bank(k as f64, side), heights[k][of]))
                .collect::<Line>()
        };
        let mut rivers = vec![[bank(1.0, 0), bank(-1.0, 1)]];
        for (stretch, [level, _]) in heights[..stretches].iter().enumerate() {
            // On either bank, within one stretch; now and then from a vertex on that is no end.
            if random.below(3) == 0 && stretch > 0 {
                continue;
            }
            let side = random.pick(&[1.0, -1.0]);
            let first = if random.below(4) == 0 && stretch > 0 {
                0.0
            } else {
                0.1 + 0.3 * random.unit()
            };
            let parts = [
                stretch as f64 + first,
                stretch as f64 + 0.6 + 0.3 * random.unit(),
            ];
            let ends = parts.map(|part| on_bank(part, side));
            let (sin, cos) = (random.unit() - 0.5).sin_cos();
            let away = [
                -side * (along[1] * cos + along[0] * sin),
                side * (along[0] * cos - along[1] * sin),
            ];
            let far = 8.0 + 4.0 * random.unit();
            let reach = 0.5 + random.unit();
            let middle = [0, 1].map(|k| (ends[0][k] + ends[1][k]) / 2.0 + far * away[k]);
            let across = [side * away[1], -side * away[0]];
            let others =
                [-reach, reach].map(|by| [middle[0] + by * across[0], middle[1] + by * across[1]]);
            let near = level + 4.0 * random.unit() - 3.0;
            let there = if random.below(2) == 0 {
                near + 0.1 + 3.0 * random.unit()
            } else {
                near - 0.1 - 3.0 * random.unit()
            };
            rivers.push([0, 1].map(|k| vec![self.at(others[k], there), self.at(ends[k], near)]));
        }
        random.shuffle(&mut rivers);
        rivers
            .into_iter()
            .for_each(|banks| self.draw(random, banks));
    }

    /// Adds a river, and waters that have a vertex or a part of their border on its banks.
    fn add_touching(&mut self, random: &mut Random) {
        let along = direction(random);
        let (length, half) = (30.0 + 10.0 * random.unit(), 0.5 + 2.0 * random.unit());
        let stretches = 2 + random.index(4);
        let site = |part: f64, away: f64| {
            let u = (part / stretches as f64 - 0.5) * length;
            [
                30.0 + u * along[0] - away * along[1],
                30.0 + u * along[1] + away * along[0],
            ]
        };
        let heights = Self::heights(random, stretches + 1);
        let banks = [(1.0, 0), (-1.0, 1)].map(|(side, of): (f64, usize)| {
            (0..=stretches)
                .map(|k| self.at(site(k as f64, side * half), heights[k][of]))
                .collect::<Line>()
        });
        self.draw(random, banks);
        let mut sides = vec![1.0, -1.0];
        random.shuffle(&mut sides);
        sides.truncate(1 + random.index(2));
        for side in sides {
            // At its vertices, except for those of its ends, or between them.
            let first = 1 + random.index(stretches - 1);
            let last = first + random.index(stretches - first);
            let between = if random.below(2) == 0 {
                0.0
            } else {
                0.2 + 0.6 * random.unit()
            };
            let mut border: Vec<(f64, f64)> =
                (first..=last).map(|k| (k as f64 - between, 0.0)).collect();
            let away = 1.0 + 4.0 * random.unit();
            let (before, after) = (
                border[0].0 - 0.1 - random.unit(),
                border[border.len() - 1].0 + 0.1 + random.unit(),
            );
            if random.below(3) == 0 {
                border.extend([(after, away), (before, away)]);
                let mut ring: Vec<Site> = border
                    .iter()
                    .map(|(part, by)| self.located(site(*part, side * (half + by))))
                    .collect();
                ring.push(ring[0]);
                self.lakes.push(Lake {
                    rings: vec![ring],
                    level: 6.0 + 12.0 * random.unit(),
                });
                continue;
            }
            if random.below(2) == 0 {
                // A bend in one point; symmetric, so that vertices are opposite each other.
                let (at, by) = (border[0].0, 0.3 + random.unit());
                border = vec![(at - by, away), (at, 0.0), (at + by, away)];
            } else {
                border.insert(0, (before + 0.03, 0.0));
                border.push((after + 0.03, 0.0));
            }
            let heights = Self::heights(random, border.len());
            let width = 0.5 + 3.0 * random.unit();
            let banks = [(0.0, 0), (width, 1)].map(|(beyond, of): (f64, usize)| {
                let vertices = border.iter().zip(&heights);
                let vertex = |((part, by), heights): (&(f64, f64), &[f64; 2])| {
                    self.at(site(*part, side * (half + by + beyond)), heights[of])
                };
                vertices.map(vertex).collect::<Line>()
            });
            self.draw(random, banks);
        }
    }

    /// Adds a lake, with an island now and then.
    fn add_lake(&mut self, random: &mut Random) {
        let center = [0, 0].map(|_| 15.0 + random.below(31) as f64);
        let corners = 3 + random.below(5);
        let ring = |by: f64, random: &mut Random| {
            let mut ring: Vec<Site> = (0..corners)
                .map(|k| {
                    let angle =
                        (k as f64 + 0.6 * random.unit()) / corners as f64 * std::f64::consts::TAU;
                    let far = by * (0.8 + 0.2 * random.unit());
                    self.located([center[0] + far * angle.cos(), center[1] + far * angle.sin()])
                })
                .collect();
            ring.push(ring[0]);
            ring
        };
        let size = 6.0 + 8.0 * random.unit();
        let mut rings = vec![ring(size, random)];
        // Around its center there is room if no side is long.
        if corners > 4 && random.below(2) == 0 {
            rings.push(ring(size / 5.0, random));
        }
        self.lakes.push(Lake {
            rings,
            level: 6.0 + 12.0 * random.unit(),
        });
    }

    /// Builds the surface as the command line does, of layers in memory.
    pub(crate) fn build(&self) -> breakline::Result<SurfaceProduct> {
        let layer = |shapes: Vec<Shape>| match shapes.len() {
            0 => Vec::new(),
            _ => vec![Input::Memory(Arc::new(Layer {
                shapes,
                ..Layer::default()
            }))],
        };
        let lines = |lines: &[Line]| {
            layer(
                lines
                    .iter()
                    .map(|line| Shape::Lines(vec![line.clone()]))
                    .collect(),
            )
        };
        let ring =
            |ring: &Vec<Site>, z: f64| ring.iter().map(|&[x, y]| [x, y, z]).collect::<Line>();
        let banks = |river: &Drawn| {
            let [first, mut second] = river.banks.clone();
            if river.turns {
                second.reverse();
            }
            Shape::Lines(vec![first, second])
        };
        let lake = |lake: &Lake| {
            Shape::Polygon(lake.rings.iter().map(|one| ring(one, lake.level)).collect())
        };
        let request = LineRequest {
            soft: lines(&self.soft),
            draped: lines(&self.draped),
            walls: lines(&self.walls),
            wall: WallOptions {
                lower: Some(LowerEdge::Drop(PerRecord::Number(3.0))),
                width: Some(STEP),
                ..WallOptions::default()
            },
            holes: layer(
                self.holes
                    .iter()
                    .map(|hole| Shape::Polygon(vec![ring(hole, 0.0)]))
                    .collect(),
            ),
            flats: layer(self.lakes.iter().map(lake).collect()),
            flat: FlatOptions {
                height: FlatRule::OfShore,
                ..FlatOptions::default()
            },
            rivers: match &self.middles {
                Some((middles, _)) => lines(middles),
                None => layer(self.rivers.iter().map(banks).collect()),
            },
            river_width: self
                .middles
                .as_ref()
                .map(|(_, width)| PerRecord::Number(*width)),
            ..LineRequest::default()
        };
        let bounds = self.bounds.map(|[min, max]| Bounds {
            min: [min[0], min[1], f64::NEG_INFINITY],
            max: [max[0], max[1], f64::INFINITY],
        });
        let tin = TinRequest {
            points: vec![Input::of_points(&self.points, None)],
            breaklines: lines(&self.hard),
            lines: request,
            bounds,
            max_edge: EdgeLimit::Unlimited,
            ..TinRequest::default()
        };
        let request = SurfaceRequest {
            source: Source::Points(Box::new(tin)),
            ..SurfaceRequest::default()
        };
        triangles(&request, &Context::default())
    }

    /// The box around the area, and the width of cells that divide it.
    pub(crate) fn frame(&self) -> ([Site; 2], f64) {
        (
            [self.located([0.0; 2]), self.located([SIDE; 2])],
            self.scale * SIDE / 40.0,
        )
    }

    /// Far more than rounding moves vertices.
    pub(crate) fn rounding(&self) -> f64 {
        let largest = self
            .located([0.0; 2])
            .into_iter()
            .chain(self.located([SIDE; 2]))
            .fold(1.0, |a: f64, c| a.max(c.abs()));
        16.0 * f64::EPSILON * largest
    }
}

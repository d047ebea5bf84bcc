//! Points and lines as an adversary would draw them.

use testkit::case::{Case, Point};
use testkit::random::{Random, ulps};

/// In UTM, as surveys are: a billionth of a metre is one unit in the last place of a northing.
const UTM: Point = [500_000.0, 4_649_000.0];

pub(crate) struct Family {
    pub(crate) name: &'static str,
    draw: fn(&mut Random) -> Case,
}

impl Family {
    /// The set of a seed, the same on every machine.
    pub(crate) fn case(&self, seed: u64) -> Case {
        let name = self
            .name
            .bytes()
            .fold(0u64, |hash, byte| hash.wrapping_mul(31) + u64::from(byte));
        let mut random = Random(Random(seed ^ name << 32).bits());
        (self.draw)(&mut random)
    }
}

pub(crate) const FAMILIES: [Family; 6] = [
    Family {
        name: "grids",
        draw: grids,
    },
    Family {
        name: "bundles",
        draw: bundles,
    },
    Family {
        name: "ulps",
        draw: one_ulp_apart,
    },
    Family {
        name: "magnitudes",
        draw: magnitudes,
    },
    Family {
        name: "stars",
        draw: stars,
    },
    Family {
        name: "crossings",
        draw: crossings,
    },
];

/// From 3 to 60, small numbers far more often: they break things as well, and a million sets take
/// minutes.
fn count(random: &mut Random) -> usize {
    let most = random.pick(&[5, 5, 5, 5, 6, 6, 6, 8, 8, 10, 10, 12, 12, 20, 40, 60]);
    3 + random.index(most - 2)
}

/// Lines through given points: segments, polylines, spikes and rings, some of them again; `count`
/// segments.
fn connect(random: &mut Random, points: Vec<Point>, count: usize) -> Case {
    let mut case = Case {
        points,
        lines: Vec::new(),
    };
    let mut left = count;
    while left > 0 {
        let length = if random.below(3) == 0 {
            1 + random.index(left.min(9))
        } else {
            1
        };
        let mut line: Vec<u32> = (0..=length)
            .map(|_| random.index(case.points.len()) as u32)
            .collect();
        match random.below(12) {
            0 if length > 2 => *line.last_mut().unwrap() = line[0],
            1 if length > 1 => line[2] = line[0],
            2 if length == 1 && !case.lines.is_empty() => {
                let other = &case.lines[random.index(case.lines.len())];
                line = vec![other[1], other[0]];
            }
            _ => {}
        }
        left -= length;
        case.lines.push(line);
    }
    case
}

fn grids(random: &mut Random) -> Case {
    let count = count(random);
    let most = random.pick(&[3, 8, 20]);
    let side = [0, 1].map(|_| 2 + random.below(most));
    let (step, origin) = match random.below(4) {
        0 => (1.0, [0.0, 0.0]),
        1 => (4.0, UTM),
        2 => (0.25, [-1.0, 2.0]),
        _ => (0.01, [0.0, 0.0]), // no grid that a double has
    };
    let points = (0..3 + random.index(2 * count))
        .map(|_| [0, 1].map(|axis| origin[axis] + step * random.below(side[axis]) as f64))
        .collect();
    connect(random, points, count)
}

/// Nearly collinear, far from the origin, in steps of a centimetre.
fn bundles(random: &mut Random) -> Case {
    let count = count(random);
    let (dx, dy) = random.pick(&[
        (10_000, 0),
        (10_000, 37),
        (10_000, 9_999),
        (-300, 1_200),
        (0, 5_000),
    ]);
    let spread = random.pick(&[1, 3, 12, 40]);
    let point = |random: &mut Random| {
        let along = match random.below(3) {
            0 => 0.0,
            1 => 1.0,
            _ => random.unit(),
        };
        let [x, y] = [along * f64::from(dx), along * f64::from(dy)]
            .map(|x| x.round() as i64 + random.around(spread));
        [UTM[0] + x as f64 / 100.0, UTM[1] + y as f64 / 100.0]
    };
    let points = (0..2 * count).map(|_| point(random)).collect();
    if random.below(2) == 0 {
        return connect(random, points, count);
    }
    Case {
        points,
        lines: (0..count as u32).map(|i| vec![2 * i, 2 * i + 1]).collect(),
    }
}

fn one_ulp_apart(random: &mut Random) -> Case {
    let count = count(random);
    let [x, y] = random.pick(&[
        [1.3, 2.7],
        [500_000.37, 4_649_000.12],
        [1.0, 1.0],
        [0.5, 1e-3],
        [0.1, -7.0],
    ]);
    let spread = random.pick(&[1, 2, 5, 30]);
    let near = |random: &mut Random, [x, y]: Point| {
        [
            ulps(x, random.around(spread)),
            ulps(y, random.around(spread)),
        ]
    };
    let others = random.pick(&[
        [x, y],
        [x + 10.0, y + 3.0],
        [x + 0.001, y],
        [2.0 * x, 2.0 * y],
    ]);
    let points = (0..2 * count)
        .map(|i| {
            let middle = [0.5 * (x + others[0]), 0.5 * (y + others[1])];
            let center = if random.below(8) == 0 {
                middle
            } else if i % 2 == 0 {
                [x, y]
            } else {
                others
            };
            near(random, center)
        })
        .collect();
    if random.below(3) == 0 {
        return connect(random, points, count);
    }
    Case {
        points,
        lines: (0..count as u32).map(|i| vec![2 * i, 2 * i + 1]).collect(),
    }
}

fn magnitudes(random: &mut Random) -> Case {
    let count = count(random);
    let scales: &[f64] = match random.below(6) {
        0 => &[1e300],
        1 => &[f64::MAX],
        2 => &[1e-310],
        3 => &[f64::MIN_POSITIVE, 1e-320],
        4 => &[1e150, 1e-150],
        _ => &[1e300, 1e-310, 1.0, 1e100, 1e-100, 0.0],
    };
    let is_coarse = random.below(2) == 0;
    let coordinate = |random: &mut Random| {
        let x = if is_coarse {
            random.around(4) as f64 / 4.0
        } else {
            2.0 * random.unit() - 1.0
        };
        x * random.pick(scales)
    };
    let points = (0..2 * count)
        .map(|_| [coordinate(random), coordinate(random)])
        .collect();
    connect(random, points, count)
}

fn stars(random: &mut Random) -> Case {
    let count = count(random);
    let [x, y] = random.pick(&[[0.0, 0.0], UTM, [0.3, 0.7], [500_000.37, 4_649_000.12]]);
    let is_on_grid = random.below(2) == 0;
    let mut case = Case::default();
    for _ in 0..count {
        let ray = |random: &mut Random| {
            if is_on_grid {
                return [0, 1].map(|_| random.around(50) as f64 * 0.25);
            }
            let (angle, length) = (random.unit() * 6.3, 1.0 + 10.0 * random.unit());
            [length * angle.cos(), length * angle.sin()]
        };
        let [dx, dy] = ray(random);
        let far = random.pick(&[1.0, 1.0, 2.0, 0.5]);
        case.draw(&[[x + dx, y + dy], [x - far * dx, y - far * dy]]);
    }
    if random.below(2) == 0 {
        case.points.push([x, y]);
    }
    case
}

/// Chords across a square, nearly all of which cross; now and then thousands of them.
fn crossings(random: &mut Random) -> Case {
    let count = match random.below(64) {
        0 => 64 + random.index(40),
        _ => count(random),
    };
    let [x, y] = random.pick(&[[0.0, 0.0], UTM]);
    let side = random.pick(&[1.0, 100.0]);
    let steps = random.pick(&[16, 1 << 10, 1 << 52]);
    let mut case = Case::default();
    for _ in 0..count {
        let along = |random: &mut Random| side * (random.below(steps) as f64 / steps as f64);
        let (a, b) = (along(random), along(random));
        case.draw(&if random.below(2) == 0 {
            [[x + a, y], [x + b, y + side]]
        } else {
            [[x, y + a], [x + side, y + b]]
        });
    }
    case
}

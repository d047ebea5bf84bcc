//! The points of the table, and those of files.

use std::f64::consts::TAU;

use breakline::{io, terrain};

/// Points of the table's terrain.
const TERRAIN: usize = 120_658;

/// Points of the table's object.
const OBJECT: usize = 145_300;

/// The largest coordinate of the sets that are made of whole numbers: 24 bits, the range of
/// `Fixed`.
const WIDTH: f64 = (1u32 << 24) as f64;

/// splitmix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Returns a number from 0 to 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() % (i as u64 + 1)) as usize);
        }
    }
}

/// Points in an order that looks random.
pub(crate) struct PointSet<const D: usize> {
    pub(crate) name: String,
    pub(crate) points: Vec<[f64; D]>,
}

/// Returns whole numbers of 24 bits, anywhere.
fn spread<const D: usize>(name: &str, seed: u64) -> PointSet<D> {
    let mut random = Random(seed);
    let points = (0..100_000)
        .map(|_| [(); D].map(|()| (random.next() >> 40) as f64))
        .collect();
    PointSet {
        name: name.into(),
        points,
    }
}

pub(crate) fn square() -> PointSet<2> {
    spread("square", 1)
}

pub(crate) fn cube() -> PointSet<3> {
    spread("cube", 5)
}

/// Almost on a parabola: rounded.
pub(crate) fn parabola() -> PointSet<2> {
    let mut random = Random(2);
    let on_curve = |x: f64| [x, x * x].map(|x| (x * WIDTH).round());
    let points = (0..100_000)
        .map(|_| on_curve(2.0 * random.unit() - 1.0))
        .collect();
    PointSet {
        name: "parabola".into(),
        points,
    }
}

/// Almost on the curve `y = x^2`, `z = x^3`: rounded. Nearly any two are joined by an edge.
pub(crate) fn moment() -> PointSet<3> {
    let mut random = Random(6);
    let on_curve = |x: f64| [x, x * x, x * x * x].map(|x| (x * WIDTH).round());
    PointSet {
        name: "moment".into(),
        points: (0..5000).map(|_| on_curve(random.unit())).collect(),
    }
}

/// Ground under a swinging mirror: 300 points to a line, half a meter apart, in centimeters.
pub(crate) fn terrain() -> PointSet<2> {
    const LINE: usize = 300;
    let mut random = Random(4);
    let mut jitter = || (random.next() % 21) as f64 - 10.0;
    let mut points: Vec<[f64; 2]> = (0..TERRAIN)
        .map(|k| {
            let (line, along) = (k / LINE, k % LINE);
            let along = if line % 2 == 0 {
                along
            } else {
                LINE - 1 - along
            };
            [50 * along, 50 * line + 25 * along / LINE].map(|x| x as f64 + jitter())
        })
        .collect();
    random.shuffle(&mut points);
    PointSet {
        name: "terrain".into(),
        points,
    }
}

/// A closed surface with bumps, scanned with a noise of a ten thousandth of its size.
pub(crate) fn object() -> PointSet<3> {
    let mut random = Random(7);
    let points = (0..OBJECT)
        .map(|_| {
            let [turn, height] = [TAU * random.unit(), 2.0 * random.unit() - 1.0];
            let around = (1.0 - height * height).sqrt();
            let bumps = 0.1 * (5.0 * turn).sin() * around
                + 0.05 * (9.0 * height).cos()
                + 1e-4 * random.unit();
            let at = [around * turn.cos(), around * turn.sin(), 0.6 * height];
            at.map(|x| ((0.5 + 0.4 * (1.0 + bumps) * x) * WIDTH).round())
        })
        .collect();
    PointSet {
        name: "object".into(),
        points,
    }
}

/// Returns the ground of a lidar tile, thinned.
pub(crate) fn lidar(path: &str) -> breakline::Result<PointSet<2>> {
    let mut ground = terrain::Selection::default();
    ground.add_source(&mut *io::points::open(path)?)?;
    let (all, _) = ground.finish();
    let count = all.len().min(TERRAIN);
    let mut points: Vec<[f64; 2]> = (0..count)
        .map(|k| all[k * all.len() / count])
        .map(|[x, y, _]| [x, y])
        .collect();
    Random(3).shuffle(&mut points);
    Ok(PointSet {
        name: path.into(),
        points,
    })
}

/// Returns the points of a file of little-endian 64-bit floating point.
pub(crate) fn read<const D: usize>(path: &str) -> Result<PointSet<D>, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{path}: {error}"))?;
    let numbers: Vec<f64> = bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|number| f64::from_le_bytes(*number))
        .collect();
    let mut points = numbers.as_chunks::<D>().0.to_vec();
    Random(3).shuffle(&mut points);
    Ok(PointSet {
        name: path.into(),
        points,
    })
}

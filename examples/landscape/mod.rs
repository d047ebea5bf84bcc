//! A hilly landscape with terraces, as lidar: 4 points per square metre in lines as of a scanner,
//! every twentieth of them vegetation. The same points every time, and the same landscape for any
//! number of points.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use las::point::{Classification, Format};
use las::{Builder, LazParallelism, Point, Transform, Vector, Writer, WriterOptions};
use rayon::prelude::*;
use testkit::random::Random;

/// Points per square metre.
const DENSITY: f64 = 4.0;

/// The lower left corner of the landscape, in metres.
const CORNER: [f64; 2] = [600_000.0, 5_200_000.0];

/// Coordinates are multiples of this, in metres.
const STEP: f64 = 0.01;

pub(crate) type Failure = Box<dyn Error + Send + Sync>;

/// Writes `points` points into `side` by `side` files, which do not touch.
pub(crate) fn write(folder: &Path, points: u64, side: u64) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)?;
    let per_tile = points / (side * side);
    // In whole steps, so that tiles are separate.
    let size = ((per_tile as f64 / DENSITY).sqrt() / STEP).round() as i64;
    (0..side * side).into_par_iter().try_for_each(|tile| {
        let (column, row) = (tile % side, tile / side);
        let path = folder.join(format!("{column:03}_{row:03}.laz"));
        write_tile(
            &path,
            [column as i64 * size, row as i64 * size],
            size,
            per_tile,
        )
    })
}

/// Writes the points of a square, whose corner and size are given in steps.
fn write_tile(path: &Path, corner: [i64; 2], size: i64, count: u64) -> Result<(), Failure> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(6)?;
    builder.point_format.is_compressed = true;
    let axis = |offset: f64| Transform {
        scale: STEP,
        offset,
    };
    builder.transforms = Vector {
        x: axis(CORNER[0]),
        y: axis(CORNER[1]),
        z: axis(0.0),
    };
    let options = WriterOptions::default().with_laz_parallelism(LazParallelism::No);
    let mut writer = Writer::with_options(
        BufWriter::new(File::create(path)?),
        builder.into_header()?,
        options,
    )?;
    let mut random = Random(corner[0] as u64 ^ (corner[1] as u64).rotate_left(32));
    let lines = (count as f64).sqrt().ceil() as u64;
    for i in 0..count {
        // To and fro, as a mirror scans, a little uneven.
        let (line, along) = (i / lines, i % lines);
        let along = if line % 2 == 0 {
            along
        } else {
            lines - 1 - along
        };
        let mut spread =
            |at: u64| ((at as f64 + random.unit()) / lines as f64 * size as f64) as i64;
        // Away from the rim, because writers round the extent in the header.
        let steps = [
            corner[0] + spread(along).clamp(2, size - 3),
            corner[1] + spread(line).clamp(2, size - 3),
        ];
        let [x, y] = steps.map(|step| step as f64 * STEP);
        let is_ground = i % 20 != 7;
        let z = height(x, y)
            + 0.03 * random.unit()
            + if is_ground { 0.0 } else { 12.0 * random.unit() };
        writer.write_point(Point {
            x: CORNER[0] + x,
            y: CORNER[1] + y,
            z,
            classification: if is_ground {
                Classification::Ground
            } else {
                Classification::HighVegetation
            },
            return_number: 1,
            number_of_returns: 1,
            gps_time: Some(i as f64 * 1e-5),
            ..Point::default()
        })?;
    }
    writer.close()?;
    Ok(())
}

/// Returns the height of the landscape: hills of several sizes, with terraces on the highest.
fn height(x: f64, y: f64) -> f64 {
    let wave = |length: f64, turn: f64| ((x * turn.cos() + y * turn.sin()) / length).sin();
    let hills =
        60.0 * wave(900.0, 0.3) * wave(1300.0, 1.9) + 12.0 * wave(170.0, 0.9) * wave(210.0, 2.6);
    let ripples = 1.5 * wave(23.0, 1.2) * wave(31.0, 2.9);
    let terraced = if hills > 40.0 {
        (hills / 4.0).floor() * 4.0
    } else {
        hills
    };
    300.0 + terraced + ripples
}

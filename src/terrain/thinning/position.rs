//! Positions of points: their cells and their hashes.

use crate::data::PointBatch;
use crate::error::{Error, Result, Setting, wording};

/// Returns a point of a batch.
pub(super) fn point(batch: &PointBatch, i: usize) -> [f64; 3] {
    [batch.x[i], batch.y[i], batch.z[i]]
}

/// Returns the column and the row of a position among cells that begin at multiples of a size.
pub(super) fn cell_of([x, y, _]: [f64; 3], size: f64) -> Result<[i64; 2]> {
    /// Up to here, a position in a cell is known to 2^-13 of its size.
    const FARTHEST: f64 = (1_u64 << 40) as f64;
    let cell = [x / size, y / size];
    if cell.iter().all(|axis| axis.abs() <= FARTHEST) {
        return Ok(cell.map(|axis| axis.floor() as i64));
    }
    Err(Error::limit(format!(
        "the point at {x} {y} is more than 2^40 times {size} from the origin: thinning is too fine for the coordinates"
    ))
    .cure(wording!["state a larger length for ", Setting::Thin]))
}

/// Mixes the bits of a number: the end of splitmix64 (Steele, Lea and Flood 2014).
fn mixed(mut bits: u64) -> u64 {
    bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Returns a hash of a position, a height and a seed; zeros of both signs are one number.
pub(super) fn hash(point: [f64; 3], seed: u64) -> u64 {
    let bits = point.map(|coordinate| (coordinate + 0.0).to_bits());
    bits.into_iter()
        .fold(mixed(seed), |hash, bits| mixed(hash ^ bits))
}

/// Returns a hash as a number from 0 to 1, without 1.
pub(super) fn unit(hash: u64) -> f64 {
    const STEPS: f64 = (1_u64 << 53) as f64;
    (hash >> 11) as f64 / STEPS
}

//! Scale and offset of points that are reprojected.

use crate::data::{Bounds, Lattice};
use crate::error::{Error, Result, Setting, wording};

/// A step is measured over this many steps, since one may be less than a digit of a coordinate.
const LEAP: f64 = 1e3;

/// Samples on each side of a box in plan, because straight sides become curves.
const SAMPLES: u8 = 5;

/// Offsets are multiples of this many steps, so that they have few digits.
const OFFSET_STEPS: f64 = 1e5;

/// The steps from the offset to the ends of the box, at most: a quarter of what 32 bits can count,
/// for points beyond the stated box.
const REACH: f64 = i32::MAX as f64 / 4.0;

/// Returns the lattice for the points of a box after a transform, given their lattice before.
///
/// On each axis a step is the largest power of ten that is not longer than a step was, so that
/// rounding moves no point by more than half of what could be distinguished before. It is longer if
/// the box would not fit into 32 bits. Heights that the transform does not change keep their scale
/// and offset.
///
/// # Errors
/// If the box cannot be transformed, or is not finite afterwards.
pub(crate) fn reprojected(
    lattice: &Lattice,
    bounds: &Bounds,
    transform: impl Fn(&mut [[f64; 3]]) -> Result<()>,
) -> Result<Lattice> {
    let center = [0, 1, 2].map(|k| f64::midpoint(bounds.min[k], bounds.max[k]));
    let mut before = vec![center; 4];
    (0..3).for_each(|k| before[k + 1][k] += LEAP * lattice.scale[k]);
    before.extend(samples(bounds));
    let mut points = before.clone();
    transform(&mut points)?;
    let mut after = Bounds::default();
    points[4..].iter().for_each(|&point| after.add(point));
    let mut new = *lattice;
    let keeps_heights = before
        .iter()
        .zip(&points)
        .all(|(before, after)| before[2] == after[2]);
    let axes = if keeps_heights { 0..2 } else { 0..3 };
    for k in axes {
        let step = (1..4)
            .map(|i| (points[i][k] - points[0][k]).abs() / LEAP)
            .fold(0.0, f64::max);
        let half = (after.max[k] - after.min[k]) / 2.0;
        // A little is added, because a hundredth may come out as slightly less.
        let fine = (step * (1.0 + 1e-6)).log10().floor();
        let exponent = fine.max((half / REACH).log10().ceil());
        if !exponent.is_finite() {
            return Err(
                Error::limit("the extent that the header states cannot be reprojected").cure(
                    wording![
                        "write the file without ",
                        Setting::TargetCrs,
                        " first: that counts its extent anew"
                    ],
                ),
            );
        }
        let middle = f64::midpoint(after.min[k], after.max[k]);
        new.scale[k] = decimal(1.0, exponent);
        new.offset[k] = decimal(
            (middle / (new.scale[k] * OFFSET_STEPS)).round() * OFFSET_STEPS,
            exponent,
        );
    }
    Ok(new)
}

/// Returns `digits` times a power of ten, correctly rounded: large powers are exact, small ones are
/// not.
fn decimal(digits: f64, exponent: f64) -> f64 {
    let power = 10f64.powi(exponent.abs() as i32);
    if exponent < 0.0 {
        digits / power
    } else {
        digits * power
    }
}

/// Returns points of a box, its corners among them.
fn samples(bounds: &Bounds) -> impl Iterator<Item = [f64; 3]> {
    let Bounds { min, max } = *bounds;
    let at =
        move |k: usize, i: u8| min[k] + (max[k] - min[k]) * f64::from(i) / f64::from(SAMPLES - 1);
    (0..SAMPLES).flat_map(move |i| {
        (0..SAMPLES).flat_map(move |j| [min[2], max[2]].map(|z| [at(0, i), at(1, j), z]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIDAR: Lattice = Lattice {
        scale: [0.01, 0.01, 0.001],
        offset: [600_000.0, 5_000_000.0, 12.5],
    };
    const TILE: Bounds = Bounds {
        min: [688_000.0, 5_261_000.0, 500.0],
        max: [688_999.99, 5_261_999.99, 707.25],
    };

    fn scaled(factor: [f64; 3], shift: [f64; 3]) -> Result<Lattice> {
        reprojected(&LIDAR, &TILE, |points| {
            points
                .iter_mut()
                .for_each(|p| *p = [0, 1, 2].map(|k| p[k] * factor[k] + shift[k]));
            Ok(())
        })
    }

    #[test]
    fn steps_become_no_longer_and_offsets_are_short() {
        let moved = scaled([1.0; 3], [-500_000.0, 100.0, 0.0]).unwrap();
        assert_eq!(
            moved,
            Lattice {
                scale: [0.01, 0.01, 0.001],
                offset: [188_000.0, 5_262_000.0, 12.5]
            }
        );
        // Metres to degrees, and heights to feet.
        let degrees = scaled([1.0 / 111_000.0, 1.0 / 111_000.0, 1.0 / 0.3048], [0.0; 3]).unwrap();
        assert_eq!(degrees.scale, [1e-8, 1e-8, 0.001]);
        assert_eq!(degrees.offset, [6.203, 47.401, 2000.0]);
        // Steps of a millimetre would need more than 32 bits here.
        let tile = Bounds {
            min: [6.0, 47.0, 0.0],
            max: [6.4, 47.4, 1.0],
        };
        let fine = Lattice {
            scale: [1e-10, 1e-7, 0.25],
            offset: [0.0; 3],
        };
        let metres = reprojected(&fine, &tile, |points| {
            points
                .iter_mut()
                .for_each(|p| (p[0], p[1]) = (p[0] * 1e7, p[1] * 1e5));
            Ok(())
        });
        assert_eq!(metres.unwrap().scale, [0.01, 0.01, 0.25]);
    }

    #[test]
    fn what_cannot_be_transformed_is_an_error() {
        assert!(reprojected(&LIDAR, &TILE, |_| Err(Error::limit("outside"))).is_err());
        let error = scaled([f64::NAN, 1.0, 1.0], [0.0; 3]).unwrap_err();
        assert!(
            error
                .cure_text()
                .unwrap()
                .plain()
                .contains("without target-crs"),
            "{error}"
        );
    }
}

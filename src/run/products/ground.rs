//! The ground among points, found by their positions alone.

use std::borrow::Cow;
use std::path::Path;

use crate::crs::Crs;
use crate::data::Bounds;
use crate::error::{Error, Result};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::terrain::ground::{
    GroundOptions, GroundTiles, PointClass, Take, classify, classify_in_tiles,
};

/// The classes of LAS that points may get.
pub(crate) const UNCLASSIFIED: u8 = 1;
pub(crate) const GROUND: u8 = 2;
pub(crate) const LOW_NOISE: u8 = 7;
pub(crate) const HIGH_NOISE: u8 = 18;

/// Returns the class of LAS for what a point is, in point formats 6 to 10: 1, 2, 7 or 18.
pub fn class_number(class: PointClass) -> u8 {
    match class {
        PointClass::Object => UNCLASSIFIED,
        PointClass::Ground => GROUND,
        PointClass::LowNoise => LOW_NOISE,
        PointClass::HighNoise => HIGH_NOISE,
    }
}

/// Returns what each of these points is, in their order: ground, an object, or noise if that is
/// asked for. The result depends on the set of points only.
///
/// Positions and heights are in the units of the coordinate system; without one, in meters. Angles
/// have the lengths that they have in the middle of the points.
///
/// # Errors
/// If there is not enough memory, or the run is canceled.
///
/// # Complexity
/// That of [`classify`].
pub fn ground_classes(
    points: &[[f64; 3]],
    crs: Option<&Crs>,
    options: &GroundOptions,
    context: &Context,
) -> Result<Vec<PointClass>> {
    of_units(points, &Units::of(crs), options, context)
}

/// Keeps the points that are ground.
///
/// # Errors
/// Those of [`ground_classes`], and if no point is ground.
pub(super) fn keep_ground(
    points: Vec<[f64; 3]>,
    units: &Units,
    options: &GroundOptions,
    journal: &Journal,
) -> Result<Vec<[f64; 3]>> {
    let classes = of_units(&points, units, options, &journal.context)?;
    let of = points.len();
    let kept = points.into_iter().zip(classes);
    let kept: Vec<[f64; 3]> = kept
        .filter(|(_, class)| *class == PointClass::Ground)
        .map(|(point, _)| point)
        .collect();
    journal.add(Notice::GroundFound {
        ground: kept.len() as u64,
        of: of as u64,
    });
    match kept.is_empty() && of > 0 {
        true => Err(Error::format(format!("none of {of} points is ground"))),
        false => Ok(kept),
    }
}

fn of_units(
    points: &[[f64; 3]],
    units: &Units,
    options: &GroundOptions,
    context: &Context,
) -> Result<Vec<PointClass>> {
    memory::require_for_ground(points.len() as u64)?;
    let work = context.start(Stage::FindingGround, Size::Uncounted)?;
    let classes = classify(&in_metres(points, units), options, context.cancel)?;
    work.end()?;
    Ok(classes)
}

/// Returns what each point is, like [`ground_classes`], in tiles that fit into so many bytes.
/// `points` passes all of them on, in the same order each time.
///
/// # Errors
/// Those of [`classify_in_tiles`].
pub(crate) fn ground_in_tiles(
    points: &dyn Fn(&mut Take) -> Result<()>,
    crs: Option<&Crs>,
    options: &GroundOptions,
    memory: u64,
    folder: &Path,
    journal: &Journal,
) -> Result<Vec<PointClass>> {
    let units = Units::of(crs);
    let mut bounds = Bounds::default();
    if units.is_angular() {
        points(&mut |batch| {
            batch
                .iter()
                .filter(|point| is_finite(point))
                .for_each(|&point| bounds.add(point));
            Ok(())
        })?;
    }
    let factors = factors(&units, &bounds);
    let in_metres = |take: &mut Take| {
        points(&mut |batch| {
            let scaled: Vec<_> = batch.iter().map(|point| scaled(point, factors)).collect();
            take(&scaled)
        })
    };
    let limits = GroundTiles {
        at_once: memory::filtered_in(memory),
        folder,
    };
    let work = journal.start(Stage::FindingGround, Size::Uncounted)?;
    let cancel = journal.context.cancel;
    let mut decided = |count| work.add(count as u64);
    let found = classify_in_tiles(&in_metres, options, &limits, cancel, &mut decided)?;
    work.end()?;
    if let Some(doubt) = found.doubts.first() {
        journal.add(Notice::GroundInDoubt {
            tiles: found.doubts.len(),
            of: found.tiles,
            middle: std::array::from_fn(|k| {
                (0.5 * doubt.tile[0][k] + 0.5 * doubt.tile[1][k]) / factors[k]
            }),
        });
    }
    Ok(found.classes)
}

/// Returns points in meters; they are copied if they are in other units.
fn in_metres<'a>(points: &'a [[f64; 3]], units: &Units) -> Cow<'a, [[f64; 3]]> {
    let mut bounds = Bounds::default();
    if units.is_angular() {
        let finite = points.iter().filter(|point| is_finite(point));
        finite.for_each(|&point| bounds.add(point));
    }
    let factors = factors(units, &bounds);
    if factors == [1.0; 3] {
        return Cow::Borrowed(points);
    }
    Cow::Owned(points.iter().map(|point| scaled(point, factors)).collect())
}

/// Returns the length of each unit in meters; angles have the lengths in the middle of the bounds.
fn factors(units: &Units, bounds: &Bounds) -> [f64; 3] {
    let latitude = match units.is_angular() {
        true => 0.5 * bounds.min[1] + 0.5 * bounds.max[1],
        false => 0.0,
    };
    units.metres_at(latitude)
}

fn is_finite(point: &[f64; 3]) -> bool {
    point.iter().all(|value| value.is_finite())
}

fn scaled(point: &[f64; 3], factors: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| point[k] * factors[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crs::{CrsKind, Unit};

    #[test]
    fn positions_and_heights_are_scaled_to_meters() {
        let unit = |name: &str, factor: f64| Unit {
            name: name.to_owned(),
            factor,
        };
        let crs = |kind, plan, vertical_unit| Crs {
            name: "test".to_owned(),
            epsg: None,
            vertical_epsg: None,
            kind,
            unit: plan,
            vertical_unit,
            wkt: None,
        };
        let points = [[10.0, 59.0, 2.0], [20.0, 61.0, 4.0]];
        let of = |crs: Option<&Crs>| in_metres(&points, &Units::of(crs)).into_owned();
        assert_eq!(of(None), points);
        let metres = crs(CrsKind::Projected, unit("metre", 1.0), None);
        assert!(matches!(
            in_metres(&points, &Units::of(Some(&metres))),
            Cow::Borrowed(_)
        ));
        let feet = unit("foot", 0.5);
        let mixed = crs(CrsKind::Projected, unit("metre", 1.0), Some(feet.clone()));
        assert_eq!(of(Some(&mixed)), [[10.0, 59.0, 1.0], [20.0, 61.0, 2.0]]);
        let both = crs(CrsKind::Projected, feet, None);
        assert_eq!(of(Some(&both)), [[5.0, 29.5, 1.0], [10.0, 30.5, 2.0]]);
        let degrees = crs(
            CrsKind::Geographic,
            unit("degree", std::f64::consts::PI / 180.0),
            None,
        );
        let [first, second] = of(Some(&degrees))[..] else {
            panic!("two points")
        };
        // At 60 degrees, a degree of longitude is half as long as one of latitude.
        let east = (second[0] - first[0]) / 10.0;
        let north = (second[1] - first[1]) / 2.0;
        assert!((north - 111_320.0).abs() < 1.0 && (east / north - 0.5).abs() < 1e-9);
        assert_eq!([first[2], second[2]], [2.0, 4.0]);
    }
}

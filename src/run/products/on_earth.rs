//! Positions of a surface on the earth: degrees, and heights above the ellipsoid.

use crate::crs::{Crs, Heights, Transform};
use crate::data::Tiling;
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::Journal;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::sources::proj::{self, TransformOptions};

/// The system of the tiles with heights above its ellipsoid.
const WITH_HEIGHTS: u32 = 4979;

/// How positions of a surface become those of tiles.
pub(super) struct Placing {
    /// `None` if they are in the system of the tiles.
    transform: Option<Box<dyn Transform>>,
    /// Meters in a unit of height, after the transform.
    factor: f64,
    /// What is added to heights, in meters.
    offset: f64,
}

impl Placing {
    /// Chooses a transform of plan and heights, unless an offset in meters is added to heights or
    /// the system does not say what they are counted from. Then the plan alone is transformed, and
    /// without an offset a notice says what heights are used.
    ///
    /// # Errors
    /// If the system is not known, or cannot be transformed.
    pub(super) fn new(
        crs: Option<&Crs>,
        vertical_offset: Option<f64>,
        options: &TransformOptions,
        journal: &Journal,
    ) -> Result<Self> {
        let Some(crs) = crs else {
            return Err(Error::usage(
                "the coordinate system of the surface is not known, so its position on the earth \
                 is unknown",
            )
            .cure(wording!["state it with ", Setting::Crs.text("EPSG:CODE")]));
        };
        let heights = crs.heights();
        let states_datum = !matches!(heights, Heights::None | Heights::Unknown);
        if states_datum && vertical_offset.is_none() && cfg!(feature = "proj") {
            return Ok(Placing {
                transform: between(crs, WITH_HEIGHTS, options, journal)?,
                factor: 1.0,
                offset: 0.0,
            });
        }
        if vertical_offset.is_none() && heights != Heights::Ellipsoid {
            journal.add(Notice::HeightsAboveEllipsoid(heights));
        }
        // Heights get their unit and offset here, so PROJ transforms the plan alone.
        let plan = Crs {
            vertical_epsg: None,
            vertical_unit: None,
            ..crs.clone()
        };
        Ok(Placing {
            transform: between(&plan, Tiling::COORDINATES, options, journal)?,
            factor: 1.0 / Units::of(Some(crs)).height_of_metres(1.0),
            offset: vertical_offset.unwrap_or(0.0),
        })
    }

    /// Changes positions of the surface into longitudes and latitudes in degrees, and heights above
    /// the ellipsoid in meters.
    ///
    /// # Errors
    /// If a position cannot be transformed; the message names it.
    pub(super) fn apply(&self, points: &mut [[f64; 3]]) -> Result<()> {
        if let Some(transform) = &self.transform {
            transform.transform(points)?;
        }
        for [_, _, z] in points {
            *z = *z * self.factor + self.offset;
        }
        Ok(())
    }

    /// Adds the warnings of the transform, once all positions are transformed.
    pub(super) fn warn(&self, journal: &Journal) {
        let warnings = self
            .transform
            .iter()
            .flat_map(|transform| transform.warnings());
        warnings.for_each(|text| journal.add(Notice::Transform(text)));
    }
}

/// Returns the transform to a system; `None` if positions are in it.
fn between(
    from: &Crs,
    code: u32,
    options: &TransformOptions,
    journal: &Journal,
) -> Result<Option<Box<dyn Transform>>> {
    let to = Crs::from_epsg(code)?;
    if from.is_same(&to) {
        return Ok(None);
    }
    journal.add(Notice::Reprojecting(
        Box::new(from.clone()),
        Box::new(to.clone()),
    ));
    proj::transform(from, &to, options).map(Some)
}

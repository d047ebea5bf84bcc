//! The values that are added to points.

use std::cell::LazyCell;
use std::path::Path;

use super::options::{SampleOptions, SampledField};
use crate::crs::Crs;
use crate::data::Surface;
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::context::{Journal, Work};
use crate::run::sources::systems::reproject_first;
use crate::terrain::{Method, Sample, Sampler};

/// What is added to points, computed as they are read.
pub(super) struct Values<'a> {
    pub(super) sampling: Sampling<'a>,
    pub(super) work: Work<'a>,
    pub(super) points: u64,
    pub(super) outside: u64,
    pub(super) journal: &'a Journal<'a>,
    pub(super) file: &'a Path,
    pub(super) surface: &'a Path,
}

impl Values<'_> {
    /// Returns the values of some points, position by position. `heights` are empty if the points
    /// have none.
    pub(super) fn at(&mut self, positions: &[[f64; 2]], heights: &[f64]) -> Result<Vec<f64>> {
        let samples = self.sampling.samples(positions)?;
        let mut values = Vec::new();
        for (i, sample) in samples.iter().enumerate() {
            self.outside += u64::from(!sample.is_some());
            let height = heights.get(i).copied().unwrap_or(f64::NAN);
            self.sampling
                .each_value(sample, height, |value| values.push(value));
        }
        self.points += samples.len() as u64;
        self.work.add(samples.len() as u64)?;
        Ok(values)
    }

    /// Returns an error if there was no point, or none on the surface. Called before an output
    /// appears.
    pub(super) fn require_any(&self) -> Result<()> {
        match self.points {
            0 => Err(Error::format("the file has no points").in_file(self.file)),
            all if self.outside == all => Err(none_inside(all, self.file, self.surface)),
            _ => Ok(()),
        }
    }
}

/// Heights and slopes of a surface, as they are added to points.
pub(super) struct Sampling<'a> {
    sampler: Sampler<'a, dyn Surface + 'a>,
    add: &'a [SampledField],
    /// The units of plan in a unit of the heights.
    z_factor: f64,
}

impl<'a> Sampling<'a> {
    pub(super) fn new(
        faces: &'a dyn Surface,
        options: &'a SampleOptions,
        crs: Option<&Crs>,
        journal: &Journal,
    ) -> Result<Self> {
        let add = &options.add;
        let is_height =
            |field: &SampledField| matches!(field, SampledField::Height | SampledField::Above);
        if options.method != Method::Linear && !add.iter().all(is_height) {
            return Err(Error::usage(
                "slopes are those of the triangles, and heights of this method are not",
            )
            .cure(wording!["add heights only, or leave out ", Setting::Method]));
        }
        let units = Units::of(crs);
        let has_lengths = add.iter().any(|field| field.has_lengths());
        if units.is_angular() && has_lengths {
            return Err(
                Error::unsupported("the coordinates are in degrees: slopes need lengths")
                    .cure(reproject_first()),
            );
        }
        let in_meters = units.in_metres();
        let z_factor = in_meters.map_or(1.0, |[plan, height]| height / plan);
        if has_lengths && z_factor != 1.0 {
            journal.add(Notice::HeightFactor(z_factor));
        }
        Ok(Sampling {
            sampler: Sampler::new(faces, options.method)?,
            add,
            z_factor,
        })
    }

    pub(super) fn samples(&self, positions: &[[f64; 2]]) -> Result<Vec<Sample>> {
        self.sampler.samples(positions)
    }

    /// Calls a function with each value that is added to a point of this height; NaN if it is
    /// missing.
    pub(super) fn each_value(&self, sample: &Sample, height: f64, mut each: impl FnMut(f64)) {
        let slope_and_aspect = LazyCell::new(|| sample.slope_and_aspect(self.z_factor, 1.0));
        for field in self.add {
            match field {
                SampledField::Height => each(sample.height),
                SampledField::Above => each(height - sample.height),
                SampledField::Slope => each(slope_and_aspect[0].atan().to_degrees()),
                SampledField::SlopePercent => each(100.0 * slope_and_aspect[0]),
                SampledField::Aspect => each(slope_and_aspect[1]),
                SampledField::Gradient => sample.gradient.into_iter().for_each(&mut each),
            }
        }
    }
}

#[cold]
pub(in crate::run::products) fn none_inside(points: u64, path: &Path, surface: &Path) -> Error {
    let what = match points {
        1 => "the only point is".to_owned(),
        points => format!("all {points} points are"),
    };
    Error::usage(format!("{what} outside of {}", surface.display()))
        .in_file(path)
        .cure(wording![
            "are x and y in the coordinate system of the surface, and in this order? ",
            Setting::Columns,
            " says which columns they are in"
        ])
}

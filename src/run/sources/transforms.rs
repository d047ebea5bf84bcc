//! The transforms that reproject the files of the input.

use rayon::prelude::*;

use super::proj;
use crate::crs::{Crs, Transform};
use crate::data::PointBatch;
use crate::error::Result;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;

/// Points per task of reprojection: enough tasks to keep all cores busy.
const REPROJECTED_AT_ONCE: usize = 4096;

/// The transforms in use, and for each file the index of its transform.
pub(crate) struct Transforms {
    transforms: Vec<Box<dyn Transform>>,
    pub(crate) by_file: Vec<Option<usize>>,
}

impl Transforms {
    pub(crate) fn new(from: &[Option<Crs>], to: Option<&Crs>, journal: &Journal) -> Result<Self> {
        let mut known: Vec<&Crs> = Vec::new();
        let mut transforms = Transforms {
            transforms: Vec::new(),
            by_file: Vec::with_capacity(from.len()),
        };
        for from in from {
            let number = match (from, to) {
                (Some(from), Some(to)) => Some(match known.iter().position(|crs| *crs == from) {
                    Some(number) => number,
                    None => {
                        let transform = proj::transform(from, to)?;
                        journal.add(Notice::Reprojecting(
                            Box::new(from.clone()),
                            Box::new(to.clone()),
                        ));
                        known.push(from);
                        transforms.transforms.push(transform);
                        known.len() - 1
                    }
                }),
                _ => None,
            };
            transforms.by_file.push(number);
        }
        Ok(transforms)
    }

    /// Adds the notices of the transforms: their operations and accuracy. Complete only after all
    /// points are transformed.
    pub(crate) fn warn(&self, journal: &Journal) {
        self.transforms
            .iter()
            .flat_map(|transform| transform.warnings())
            .for_each(|text| journal.add(Notice::Transform(text)));
    }

    pub(crate) fn apply(&self, number: Option<usize>, points: &mut [[f64; 3]]) -> Result<()> {
        match number {
            Some(number) => {
                let transform = &self.transforms[number];
                points
                    .par_chunks_mut(REPROJECTED_AT_ONCE)
                    .try_for_each(|chunk| transform.transform(chunk))
            }
            None => Ok(()),
        }
    }

    pub(crate) fn apply_to_batch(
        &self,
        number: Option<usize>,
        batch: &mut PointBatch,
    ) -> Result<()> {
        if number.is_none() {
            return Ok(());
        }
        let mut points: Vec<[f64; 3]> = batch
            .x
            .iter()
            .zip(&batch.y)
            .zip(&batch.z)
            .map(|((&x, &y), &z)| [x, y, z])
            .collect();
        self.apply(number, &mut points)?;
        for (i, [x, y, z]) in points.into_iter().enumerate() {
            (batch.x[i], batch.y[i], batch.z[i]) = (x, y, z);
        }
        Ok(())
    }
}

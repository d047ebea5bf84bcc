//! Reprojection on the way in: which file takes which transform.

use rayon::prelude::*;

use super::open;
use super::talk::Talk;
use crate::crs::{Crs, Transform};
use crate::data::PointBatch;
use crate::error::Result;

/// Points that one core reprojects at a time: enough to keep all cores at it.
const REPROJECTED_AT_ONCE: usize = 4096;

/// The transforms in use, and which file takes which.
pub(super) struct Roads {
    transforms: Vec<Box<dyn Transform>>,
    pub(super) by_file: Vec<Option<usize>>,
}

impl Roads {
    pub(super) fn new(from: &[Option<Crs>], to: Option<&Crs>, talk: &Talk) -> Result<Self> {
        let mut known: Vec<&Crs> = Vec::new();
        let mut roads = Roads { transforms: Vec::new(), by_file: Vec::with_capacity(from.len()) };
        for from in from {
            let road = match (from, to) {
                (Some(from), Some(to)) => Some(match known.iter().position(|crs| *crs == from) {
                    Some(road) => road,
                    None => {
                        let transform = open::transform(from, to)?;
                        talk.note(format_args!("reprojecting from {from} to {to}"));
                        known.push(from);
                        roads.transforms.push(transform);
                        known.len() - 1
                    }
                }),
                _ => None,
            };
            roads.by_file.push(road);
        }
        Ok(roads)
    }

    /// Says what there is to say of the transforms: which operations, how good. Complete when they are
    /// done.
    pub(super) fn warn(&self, talk: &Talk) {
        self.transforms.iter().flat_map(|transform| transform.warnings()).for_each(|text| talk.warning(text));
    }

    pub(super) fn take(&self, road: Option<usize>, points: &mut [[f64; 3]]) -> Result<()> {
        match road {
            Some(road) => {
                let transform = &self.transforms[road];
                points.par_chunks_mut(REPROJECTED_AT_ONCE).try_for_each(|chunk| transform.transform(chunk))
            }
            None => Ok(()),
        }
    }

    pub(super) fn take_batch(&self, road: Option<usize>, batch: &mut PointBatch) -> Result<()> {
        if road.is_none() {
            return Ok(());
        }
        let mut points: Vec<[f64; 3]> =
            batch.x.iter().zip(&batch.y).zip(&batch.z).map(|((&x, &y), &z)| [x, y, z]).collect();
        self.take(road, &mut points)?;
        for (i, [x, y, z]) in points.into_iter().enumerate() {
            (batch.x[i], batch.y[i], batch.z[i]) = (x, y, z);
        }
        Ok(())
    }
}

//! The transforms that reproject the files of the input.

use rayon::prelude::*;

use super::proj::{self, TransformOptions};
use crate::crs::{Crs, CrsKind, Transform};
use crate::data::{Bounds, PointBatch};
use crate::error::Result;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;

/// Points per task of reprojection: enough tasks to keep all cores busy.
const REPROJECTED_AT_ONCE: usize = 4096;

/// The number of parts of each side of a box whose ends are transformed to find a box around it.
const STEPS_A_SIDE: usize = 32;

/// By how much of its size a box is enlarged after a transform: operations that change within it,
/// or that have a grid, move points by less.
const MARGIN: f64 = 0.01;

/// The system that coordinates are reprojected to, if they are, and how.
#[derive(Clone, Copy)]
pub(crate) struct TargetSystem<'a> {
    pub(crate) crs: Option<&'a Crs>,
    pub(crate) options: &'a TransformOptions,
}

/// The transforms in use, and for each file the index of its transform.
pub(crate) struct Transforms {
    /// Each with the system that it leads from.
    transforms: Vec<(Crs, Box<dyn Transform>)>,
    pub(crate) by_file: Vec<Option<usize>>,
}

/// The transform of a file, with the system that it leads from; by default none: the coordinates
/// are used as they are.
#[derive(Clone, Copy, Default)]
pub(crate) struct FileTransform<'a>(Option<&'a (Crs, Box<dyn Transform>)>);

impl Transforms {
    /// Finds the transforms from the systems of files, one for each system. Files without one stay
    /// as they are.
    ///
    /// # Errors
    /// If there is no transform between two systems, or no PROJ.
    pub(crate) fn new(from: &[Option<Crs>], to: TargetSystem, journal: &Journal) -> Result<Self> {
        let mut transforms = Transforms {
            transforms: Vec::new(),
            by_file: Vec::with_capacity(from.len()),
        };
        for from in from {
            let number = match (from, to.crs) {
                (Some(from), Some(crs)) => {
                    let known = &mut transforms.transforms;
                    Some(match known.iter().position(|(crs, _)| crs == from) {
                        Some(number) => number,
                        None => {
                            let transform = proj::transform(from, crs, to.options)?;
                            journal.add(Notice::Reprojecting(
                                Box::new(from.clone()),
                                Box::new(crs.clone()),
                            ));
                            known.push((from.clone(), transform));
                            known.len() - 1
                        }
                    })
                }
                _ => None,
            };
            transforms.by_file.push(number);
        }
        Ok(transforms)
    }

    /// Returns the transform that a number of [`by_file`](Self::by_file) stands for.
    pub(crate) fn numbered(&self, number: Option<usize>) -> FileTransform<'_> {
        FileTransform(number.map(|number| &self.transforms[number]))
    }

    /// Returns the transform of a file.
    pub(crate) fn of_file(&self, file: usize) -> FileTransform<'_> {
        self.numbered(self.by_file[file])
    }

    /// Returns the warnings of the transforms: their operations and accuracy. Complete only after
    /// all points are transformed.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        self.transforms
            .iter()
            .flat_map(|(_, transform)| transform.warnings())
    }

    /// Adds the [warnings](Self::warnings) as notices.
    pub(crate) fn warn(&self, journal: &Journal) {
        self.warnings()
            .for_each(|text| journal.add(Notice::Transform(text)));
    }

    pub(crate) fn apply(&self, number: Option<usize>, points: &mut [[f64; 3]]) -> Result<()> {
        self.numbered(number).apply(points)
    }

    pub(crate) fn apply_to_batch(
        &self,
        number: Option<usize>,
        batch: &mut PointBatch,
    ) -> Result<()> {
        self.numbered(number).apply_to_batch(batch)
    }
}

impl FileTransform<'_> {
    /// Returns the system that the file is reprojected from.
    pub(crate) fn from(&self) -> Option<&Crs> {
        self.0.map(|(from, _)| from)
    }

    fn apply(&self, points: &mut [[f64; 3]]) -> Result<()> {
        match self.0 {
            Some((_, transform)) => points
                .par_chunks_mut(REPROJECTED_AT_ONCE)
                .try_for_each(|chunk| transform.transform(chunk)),
            None => Ok(()),
        }
    }

    /// Reprojects points of the file.
    ///
    /// # Errors
    /// If one lies outside of the area of the operation.
    pub(crate) fn apply_to_batch(&self, batch: &mut PointBatch) -> Result<()> {
        if self.0.is_none() {
            return Ok(());
        }
        let mut points: Vec<[f64; 3]> = batch
            .x
            .iter()
            .zip(&batch.y)
            .zip(&batch.z)
            .map(|((&x, &y), &z)| [x, y, z])
            .collect();
        self.apply(&mut points)?;
        for (i, [x, y, z]) in points.into_iter().enumerate() {
            (batch.x[i], batch.y[i], batch.z[i]) = (x, y, z);
        }
        Ok(())
    }

    /// Returns a box that contains another one after the transform, with a margin; `None` if that
    /// is not known: a part of its outline cannot be transformed, or it has no position in plan.
    ///
    /// A transform has no folds, so the outline goes to the outline. Between two points on it, the
    /// outline is off their chord by less than the chords turn from one to the next.
    pub(crate) fn around(&self, bounds: Bounds) -> Option<Bounds> {
        let Some(from) = self.from() else {
            return Some(bounds);
        };
        if bounds.is_empty() || from.kind == CrsKind::Geocentric {
            return None;
        }
        let mut outline = outline_of(&bounds);
        self.apply(&mut outline).ok()?;
        let mut around = Bounds::around(&outline);
        let turn = |k: usize| {
            let turns = outline
                .windows(3)
                .map(|row| (row[0][k] - 2.0 * row[1][k] + row[2][k]).abs());
            // At a corner the outline turns by itself.
            (1..)
                .zip(turns)
                .filter(|(middle, _)| middle % STEPS_A_SIDE != 0)
                .fold(0.0, |most: f64, (_, turn)| most.max(turn))
        };
        for k in 0..2 {
            let margin = turn(k) + MARGIN * (around.max[k] - around.min[k]);
            around.min[k] -= margin;
            around.max[k] += margin;
        }
        let is_finite = (0..2).all(|k| around.min[k].is_finite() && around.max[k].is_finite());
        is_finite.then_some(around)
    }
}

/// Returns points on the outline of a box in plan, from one corner around to it.
fn outline_of(Bounds { min, max }: &Bounds) -> Vec<[f64; 3]> {
    let corners = [
        [min[0], min[1]],
        [max[0], min[1]],
        [max[0], max[1]],
        [min[0], max[1]],
    ];
    (0..=4 * STEPS_A_SIDE)
        .map(|i| {
            let (side, step) = (i / STEPS_A_SIDE, i % STEPS_A_SIDE);
            let [a, b] = [corners[side % 4], corners[(side + 1) % 4]];
            let t = step as f64 / STEPS_A_SIDE as f64;
            [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), min[2]]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    /// A turn, a scale and a bend, as projections have them; nothing to the left of a limit.
    struct Bent {
        bend: f64,
        from: f64,
    }

    impl Transform for Bent {
        fn transform(&self, points: &mut [[f64; 3]]) -> Result<()> {
            for [x, y, _] in points {
                if *x < self.from {
                    return Err(crate::error::Error::format("it is outside"));
                }
                let [u, v] = [0.6 * *x - 0.8 * *y, 0.8 * *x + 0.6 * *y];
                *x = 3.0 * u + self.bend * (u * u - v * v);
                *y = 3.0 * v + self.bend * 2.0 * u * v;
            }
            Ok(())
        }

        fn warnings(&self) -> Vec<String> {
            Vec::new()
        }
    }

    fn bent(bend: f64, from: f64, code: u32) -> Transforms {
        Transforms {
            transforms: vec![(Crs::from_epsg(code).unwrap(), Box::new(Bent { bend, from }))],
            by_file: vec![Some(0)],
        }
    }

    fn square(from: f64, to: f64) -> Bounds {
        Bounds {
            min: [from, from, 5.0],
            max: [to, to, 6.0],
        }
    }

    #[test]
    fn the_box_around_a_box_has_all_of_its_points() {
        let mut random = Random(5);
        for bend in [0.0, 1e-4, 1e-3, -2e-3] {
            let transforms = bent(bend, f64::NEG_INFINITY, 25832);
            let transform = transforms.of_file(0);
            let around = transform.around(square(100.0, 400.0)).unwrap();
            let mut points: Vec<[f64; 3]> = (0..10_000)
                .map(|_| [0, 1].map(|_| 100.0 + 300.0 * random.unit()))
                .map(|[x, y]| [x, y, 5.0])
                .collect();
            transform.apply(&mut points).unwrap();
            let exact = Bounds::around(&points);
            for k in 0..2 {
                let size = exact.max[k] - exact.min[k];
                let slack = [exact.min[k] - around.min[k], around.max[k] - exact.max[k]];
                assert!(
                    slack.iter().all(|slack| (0.0..0.06 * size).contains(slack)),
                    "{slack:?}"
                );
            }
        }
    }

    #[test]
    fn without_a_transform_a_box_stays_and_where_one_fails_there_is_none() {
        assert_eq!(
            FileTransform::default().around(square(1.0, 2.0)),
            Some(square(1.0, 2.0))
        );
        let box_of = |from, code| {
            let transforms = bent(0.0, from, code);
            transforms.of_file(0).around(square(100.0, 400.0))
        };
        assert!(box_of(50.0, 25832).is_some());
        assert!(box_of(150.0, 25832).is_none());
        // X, Y and Z from the center of the earth.
        assert!(box_of(50.0, 4978).is_none());
    }
}

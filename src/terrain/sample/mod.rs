//! Heights and gradients of a surface at any positions.

mod curve;

use std::sync::OnceLock;

use rayon::prelude::*;

pub(crate) use self::curve::{along_curve, on_curve};
use super::admitted::searched;
use super::boxes::{Boxes, LocatedFace};
use super::face_gradient;
use super::interpolate::{Interpolant, Method, QueryBuffers};
use super::rasterize::height_at;
use crate::data::Surface;
use crate::error::Result;

/// Positions that a thread takes at a time.
const BATCH: usize = 1 << 12;

/// The surface at a position: NaN where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The height.
    pub height: f64,
    /// The rise per unit of x and of y, on the triangle there; NaN unless heights are linear.
    ///
    /// On an edge or a vertex it is that of the steepest of the triangles around: of those that are
    /// equally steep, the one that rises least along x, then y.
    pub gradient: [f64; 2],
}

impl Sample {
    /// Outside of the surface.
    pub const NONE: Sample = Sample {
        height: f64::NAN,
        gradient: [f64::NAN; 2],
    };

    /// Returns true if the surface has a height there.
    pub fn is_some(&self) -> bool {
        !self.height.is_nan()
    }

    /// Returns the slope, as the tangent of the angle above the horizon, and the direction in which
    /// the surface falls, in degrees clockwise from north and below 360; NaN if it is level.
    ///
    /// `z_factor` are the units of y per unit of z, `x_scale` those per unit of x.
    pub fn slope_and_aspect(&self, z_factor: f64, x_scale: f64) -> [f64; 2] {
        face_gradient::slope_and_aspect(self.gradient, z_factor, x_scale)
    }
}

/// Heights and gradients of a surface at many positions.
///
/// A height is that of a cell of a north-up [`Dem`](super::Dem) whose center is there, bit for bit
/// before the cell is rounded to 32 bits. It does not depend on the order of the positions or on
/// the numbering of faces.
///
/// ```
/// use breakline::terrain::{Method, Sampler, TinBuilder};
///
/// let mut builder = TinBuilder::default();
/// builder.add_points(&[0.0, 4.0, 4.0, 0.0], &[0.0, 0.0, 4.0, 4.0], &[0.0, 2.0, 2.0, 0.0]);
/// let tin = builder.build()?;
/// let samples = Sampler::new(&tin, Method::Linear)?.samples(&[[1.0, 2.0], [9.0, 9.0]])?;
/// assert_eq!((samples[0].height, samples[0].gradient), (0.5, [0.5, 0.0]));
/// assert_eq!(samples[0].slope_and_aspect(1.0, 1.0), [0.5, 270.0]);
/// assert!(!samples[1].is_some());
/// # Ok::<(), breakline::Error>(())
/// ```
#[derive(Debug)]
pub struct Sampler<'a, S: ?Sized> {
    surface: &'a S,
    /// Unless heights are linear.
    interpolant: Option<Interpolant<'a, S>>,
    /// All faces, for a surface without another search.
    faces: OnceLock<Boxes<LocatedFace>>,
}

/// The memory of a thread.
#[derive(Default)]
struct Scratch {
    near: Option<u32>,
    faces: Vec<u32>,
    interpolation: QueryBuffers,
}

impl<'a, S: Surface + ?Sized> Sampler<'a, S> {
    /// Prepares heights by a method.
    ///
    /// # Errors
    /// Those of [`Interpolant::new`].
    ///
    /// # Complexity
    /// That of [`Interpolant::new`]: constant for [`Method::Linear`].
    pub fn new(surface: &'a S, method: Method) -> Result<Self> {
        let interpolant = match method {
            Method::Linear => None,
            _ => Some(Interpolant::new(surface, method)?),
        };
        Ok(Sampler {
            surface,
            interpolant,
            faces: OnceLock::new(),
        })
    }

    /// Returns the surface at each position; [`Sample::NONE`] outside of it, and where a coordinate
    /// is not finite.
    ///
    /// # Errors
    /// If the surface was found damaged.
    ///
    /// # Complexity
    /// O(n log n) for n positions, on all threads, with short walks between neighbors, for a
    /// [`Tin`](super::Tin), a [`CompactTin`](super::CompactTin) and a raster. For other surfaces
    /// the first call prepares a search for faces, in O(m log m) and about 50 bytes for each of m
    /// faces.
    pub fn samples(&self, positions: &[[f64; 2]]) -> Result<Vec<Sample>> {
        let order = along_curve(positions);
        let mut samples = vec![Sample::NONE; positions.len()];
        let unknown = self.fill(&order, positions, &mut samples, |q, scratch| {
            let Scratch { near, faces, .. } = scratch;
            self.surface.faces_at(q, near, faces)
        });
        if !unknown.is_empty() {
            let tree = self.tree();
            self.fill(&unknown, positions, &mut samples, |q, scratch| {
                let of_box = |face: &LocatedFace| {
                    scratch.faces.push(face.number);
                    None::<()>
                };
                tree.find(q, of_box);
                true
            });
        }
        self.surface.ensure_intact()?;
        Ok(samples)
    }

    /// Computes some samples, with the faces that `find` appends, and returns the numbers of those
    /// for which it returns false.
    fn fill(
        &self,
        numbers: &[u32],
        positions: &[[f64; 2]],
        samples: &mut [Sample],
        find: impl Fn([f64; 2], &mut Scratch) -> bool + Sync,
    ) -> Vec<u32> {
        let sample = |q: [f64; 2], scratch: &mut Scratch| {
            if !q.iter().all(|c| c.is_finite()) {
                return Some(Sample::NONE);
            }
            let q = searched(q);
            scratch.faces.clear();
            find(q, scratch).then(|| self.sample(q, scratch))
        };
        let batches: Vec<Vec<Option<Sample>>> = numbers
            .par_chunks(BATCH)
            .map(|batch| {
                let mut scratch = Scratch::default();
                // `PERF:` all are read before the first is used: memory answers several at a time.
                let at: Vec<[f64; 2]> = batch.iter().map(|&i| positions[i as usize]).collect();
                at.into_iter().map(|q| sample(q, &mut scratch)).collect()
            })
            .collect();
        let mut unknown = Vec::new();
        for (&number, found) in numbers.iter().zip(batches.into_iter().flatten()) {
            match found {
                Some(sample) => samples[number as usize] = sample,
                None => unknown.push(number),
            }
        }
        unknown
    }

    /// Returns the surface at a position, given all faces that may contain it.
    fn sample(&self, q: [f64; 2], scratch: &mut Scratch) -> Sample {
        let mut found: Option<(u32, Sample)> = None;
        for &face in &scratch.faces {
            let Some(corners) = self.surface.triangle(face) else {
                continue;
            };
            let Some(height) = height_at(corners, q) else {
                continue;
            };
            let gradient = face_gradient::of_face(corners);
            found = Some(match found {
                None => (face, Sample { height, gradient }),
                Some((other, sample)) => {
                    // Only faces that overlap have other heights; of these the last one counts, as
                    // in a raster.
                    let height = if other < face { height } else { sample.height };
                    let gradient = face_gradient::steeper(gradient, sample.gradient);
                    (other.max(face), Sample { height, gradient })
                }
            });
        }
        match (&self.interpolant, found) {
            (_, None) => Sample::NONE,
            (None, Some((_, sample))) => sample,
            (Some(interpolant), Some((face, _))) => Sample {
                height: interpolant.height_in(face, q, &mut scratch.interpolation),
                gradient: [f64::NAN; 2],
            },
        }
    }

    /// Returns a search for all faces.
    fn tree(&self) -> &Boxes<LocatedFace> {
        if let Some(tree) = self.faces.get() {
            return tree;
        }
        // No lock is held while all threads build it.
        let tree = Boxes::new(LocatedFace::all(self.surface).collect());
        self.faces.get_or_init(|| tree)
    }
}

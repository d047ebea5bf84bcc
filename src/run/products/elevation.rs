//! Heights of a surface at positions.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::surface::{Model, SurfaceProduct};
use crate::data::Surface;
use crate::error::Result;
use crate::run::context::{Context, Size, Stage};
use crate::run::sources::tin_parts;
use crate::terrain::{Interpolant, Method, Prepared, along_curve};
use crate::triangulation::tds::CellId;

/// Positions that a thread takes at a time.
const BATCH: usize = 1 << 12;

/// Fewer positions are taken in the order in which they are given.
const FEW: usize = 1 << 8;

/// Returns the height of a surface at each position in plan; NaN outside of the surface, and where
/// a coordinate is not finite. The result does not depend on the order of the positions.
///
/// # Errors
/// If the surface is a raster, a file that it is read from was found damaged, or the run is
/// canceled.
///
/// # Complexity
/// With [`Method::Linear`], O(n log n) for n positions, on all threads, for a TIN that was built or
/// opened. A mesh is searched by a tree of its faces, and other methods prepare the whole surface
/// ([`Interpolant::new`]), with each call: for many calls see [`Heights`].
pub fn elevations(
    product: &SurfaceProduct,
    positions: &[[f64; 2]],
    method: Method,
    context: &Context,
) -> Result<Vec<f64>> {
    context.check()?;
    if let Model::Parts(parts) = &product.model
        && method == Method::Linear
    {
        let work = context.start(Stage::ComputingHeights, Size::Unknown)?;
        let heights = tin_parts::elevations(parts, positions, &|count| work.add(count))?;
        work.end()?;
        return Ok(heights);
    }
    if let Some(notice) = product.unread_by(method) {
        context.monitor.notice(&notice);
    }
    let interpolant = Interpolant::new(product.triangles()?, method)?;
    heights(product, interpolant, positions, context)
}

/// Returns the height by a method at each position, see [`elevations`].
fn heights(
    product: &SurfaceProduct,
    interpolant: Interpolant<'_, dyn Surface + '_>,
    positions: &[[f64; 2]],
    context: &Context,
) -> Result<Vec<f64>> {
    context.check()?;
    let surface = product.triangles()?;
    let finder = Finder {
        product,
        interpolant,
    };
    let work = context.start(Stage::ComputingHeights, Size::Items(positions.len() as u64))?;
    let mut heights = vec![f64::NAN; positions.len()];
    if positions.len() <= FEW {
        let mut near = None;
        for (height, &q) in heights.iter_mut().zip(positions) {
            *height = finder.height(q, &mut near);
        }
    } else {
        // Neighbors on a curve through the plane are near each other, and walks between them short.
        let order = along_curve(positions);
        context.check()?;
        let batches: Vec<Vec<f64>> = order
            .par_chunks(BATCH)
            .map(|batch| {
                let mut near = None;
                let found = batch
                    .iter()
                    .map(|&i| finder.height(positions[i as usize], &mut near))
                    .collect();
                work.add(batch.len() as u64)?;
                Ok(found)
            })
            .collect::<Result<_>>()?;
        for (&i, height) in order.iter().zip(batches.into_iter().flatten()) {
            heights[i as usize] = height;
        }
    }
    work.end()?;
    surface.ensure_intact()?;
    Ok(heights)
}

/// Heights of a surface for many calls: what a method prepares is kept.
#[derive(Debug)]
pub struct Heights {
    product: Arc<SurfaceProduct>,
    prepared: Mutex<Vec<(Method, Arc<Prepared>)>>,
}

impl Heights {
    /// Returns the heights of a surface. Nothing is prepared yet.
    pub fn new(product: Arc<SurfaceProduct>) -> Self {
        Heights {
            product,
            prepared: Mutex::default(),
        }
    }

    /// Returns the surface.
    pub fn product(&self) -> &SurfaceProduct {
        &self.product
    }

    /// Returns true if the next call with this method takes time for its positions only.
    pub fn is_prepared(&self, method: Method) -> bool {
        let is_walked = match &self.product.model {
            Model::Tin(_) => true,
            Model::Compact(tin) => !tin.has_fragments(),
            Model::Parts(_) | Model::Mesh(_) | Model::Raster(_) | Model::RasterFile(_) => false,
        };
        (method == Method::Linear && is_walked) || self.known(method).is_some()
    }

    /// Returns the height at each position, like [`elevations`].
    ///
    /// # Errors
    /// Those of [`elevations`].
    ///
    /// # Complexity
    /// That of [`elevations`] for the first call with a method; after that, O(log n) for each
    /// position of an ordinary surface. 72 bytes are kept for each vertex and method, except for
    /// linear heights of a TIN.
    pub fn at(
        &self,
        positions: &[[f64; 2]],
        method: Method,
        context: &Context,
    ) -> Result<Vec<f64>> {
        let product = &self.product;
        if method == Method::Linear && matches!(product.model, Model::Parts(_)) {
            return elevations(product, positions, method, context);
        }
        context.check()?;
        let surface = product.triangles()?;
        let interpolant = match self.known(method) {
            Some(prepared) => Interpolant::of_prepared(surface, prepared),
            None => {
                if let Some(notice) = product.unread_by(method) {
                    context.monitor.notice(&notice);
                }
                let interpolant = Interpolant::new(surface, method)?;
                self.lock().push((method, interpolant.prepared()));
                interpolant
            }
        };
        heights(product, interpolant, positions, context)
    }

    fn known(&self, method: Method) -> Option<Arc<Prepared>> {
        let prepared = self.lock();
        let known = prepared.iter().find(|(known, _)| *known == method);
        known.map(|(_, prepared)| Arc::clone(prepared))
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(Method, Arc<Prepared>)>> {
        self.prepared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Finds heights of a surface by a method.
struct Finder<'a> {
    product: &'a SurfaceProduct,
    interpolant: Interpolant<'a, dyn Surface + 'a>,
}

impl Finder<'_> {
    fn height(&self, q: [f64; 2], near: &mut Option<CellId>) -> f64 {
        let interpolated = || self.interpolant.height(q[0], q[1]);
        let found = match &self.product.model {
            Model::Tin(tin) if self.is_linear() => tin.elevation_near(q, near),
            // What is in no whole triangle may be in a fragment.
            Model::Compact(tin) if self.is_linear() => {
                tin.elevation_in_whole(q, near).or_else(|| {
                    if tin.has_fragments() {
                        interpolated()
                    } else {
                        None
                    }
                })
            }
            Model::Tin(_)
            | Model::Compact(_)
            | Model::Parts(_)
            | Model::Mesh(_)
            | Model::Raster(_)
            | Model::RasterFile(_) => interpolated(),
        };
        found.unwrap_or(f64::NAN)
    }

    fn is_linear(&self) -> bool {
        self.interpolant.method() == Method::Linear
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Bounds;
    use crate::io::mapped;
    use crate::run::{self, Input, Source, SurfaceRequest, TinRequest};
    use crate::terrain::CompactTin;

    /// A hilly TIN of a few hundred points, cut to a box unless `bounds` is `None`.
    fn hills(bounds: Option<Bounds>) -> SurfaceProduct {
        let points: Vec<[f64; 3]> = (0..400u32)
            .map(|i| {
                [
                    f64::from(i * 37 % 101),
                    f64::from(i * 53 % 103),
                    f64::from(i * i % 17),
                ]
            })
            .collect();
        let tin = TinRequest {
            points: vec![Input::of_points(&points, None)],
            bounds,
            ..TinRequest::default()
        };
        let request = SurfaceRequest {
            source: Source::Points(Box::new(tin)),
            ..SurfaceRequest::default()
        };
        run::triangles(&request, &Context::default()).unwrap()
    }

    #[test]
    fn a_method_is_prepared_once() {
        let product = Arc::new(hills(None));
        let positions: Vec<[f64; 2]> = (0..500u32)
            .map(|i| [f64::from(i * 7 % 110), f64::from(i * 11 % 110)])
            .collect();
        let heights = Heights::new(Arc::clone(&product));
        for method in [Method::Natural, Method::Smooth, Method::Nearest] {
            assert!(!heights.is_prepared(method));
            let expected = elevations(&product, &positions, method, &Context::default()).unwrap();
            for _ in 0..2 {
                let found = heights.at(&positions, method, &Context::default()).unwrap();
                assert!(
                    found
                        .iter()
                        .zip(&expected)
                        .all(|(a, b)| a.to_bits() == b.to_bits())
                );
                assert!(heights.is_prepared(method));
            }
        }
        assert!(
            heights.is_prepared(Method::Linear),
            "nothing is to be prepared"
        );
    }

    #[test]
    fn many_positions_have_the_heights_of_each_alone_whatever_the_surface_is_kept_in() {
        let inner = Bounds {
            min: [10.0, 12.5, 0.0],
            max: [70.25, 60.0, 0.0],
        };
        for bounds in [None, Some(inner)] {
            let product = hills(bounds);
            let Model::Tin(tin) = &product.model else {
                unreachable!()
            };
            let mut positions: Vec<[f64; 2]> = (0..3000u32)
                .map(|i| {
                    [
                        f64::from(i * 7 % 1031) / 9.0,
                        f64::from(i * 11 % 1033) / 9.0,
                    ]
                })
                .collect();
            positions.extend([
                [f64::NAN, 1.0],
                [1e300, 5.0],
                [f64::INFINITY, 0.0],
                [-5.0, 3.0],
            ]);
            let context = Context::default();
            let found = elevations(&product, &positions, Method::Linear, &context).unwrap();
            let alone: Vec<f64> = positions
                .iter()
                .map(|&[x, y]| tin.elevation(x, y).unwrap_or(f64::NAN))
                .collect();
            let bits = |heights: &[f64]| heights.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
            assert!(bits(&found) == bits(&alone));
            assert!(found.iter().filter(|z| !z.is_nan()).count() > 500);

            let mut bytes = Vec::new();
            tin.write_tin(&mut bytes).unwrap();
            let opened = CompactTin::open(mapped::of_bytes(&bytes).unwrap(), "bytes").unwrap();
            let opened = SurfaceProduct {
                model: Model::Compact(Box::new(opened)),
                built: None,
                notices: Vec::new(),
            };
            let of_bytes = elevations(&opened, &positions, Method::Linear, &context).unwrap();
            for ((found, there), q) in found.iter().zip(&of_bytes).zip(&positions) {
                assert!(
                    found.is_nan() && there.is_nan() || (found - there).abs() < 1e-9,
                    "{found} {there} at {q:?}"
                );
            }
            // A mesh is searched by a tree.
            let smooth = elevations(&product, &positions, Method::Natural, &context).unwrap();
            assert!(
                smooth
                    .iter()
                    .zip(&found)
                    .all(|(a, b)| a.is_nan() == b.is_nan())
            );
        }
    }
}

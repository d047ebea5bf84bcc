//! The overlay of two surfaces: what each face of one has in common with each face of the other.

mod number;
mod polygon;

use std::convert::Infallible;

pub(super) use self::number::Number;
use self::polygon::{Clipper, Common};
pub(super) use self::polygon::{Corner, clipped, from_least, within};
use super::boxes::{Boxes, Extent, LocatedFace};
use crate::data::{Surface, map_batches};
use crate::triangulation::num::Pair;

/// What a face of one surface and a face of another have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overlap<'a> {
    /// Corners are relative to it.
    pub(super) origin: [f64; 3],
    /// The numbers of both faces.
    pub(super) faces: [u32; 2],
    /// The corners of a convex polygon, counter-clockwise: three or more.
    pub(super) corners: &'a [Corner],
    /// The same with twice the digits, of a sliver whose area those above do not give.
    pub(super) fine: Option<&'a [Corner<Pair>]>,
}

/// Calls `add` with all that faces of one surface have in common with faces of another one, on all
/// threads, each with a value of its own; then `take` with these values, in an order that does not
/// depend on the threads.
///
/// # Complexity
/// O((n + k) log n) for n faces and k pairs of faces that overlap; about 40 bytes for each face of
/// the surface that has fewer.
pub(super) fn overlay<R: Default + Send>(
    surfaces: [&dyn Surface; 2],
    add: impl Fn(&mut R, Overlap<'_>) + Sync,
    mut take: impl FnMut(R) + Send,
) {
    let [a, b] = surfaces;
    // The larger one is passed through, the smaller one searched.
    let is_swapped = a.face_count() < b.face_count();
    let [passed, searched] = if is_swapped { [b, a] } else { [a, b] };
    let faces = Boxes::new(LocatedFace::all(searched).collect());
    let make = |triangles: &[(u32, [[f64; 3]; 3])]| {
        let mut value = R::default();
        let mut clipper = Clipper::default();
        for &(number, triangle) in triangles {
            let extent = Extent::of(triangle);
            faces.find_in(extent, |face| {
                if !face.extent.overlaps(&extent) {
                    return None;
                }
                let other = searched.triangle(face.number)?;
                let (pair, numbers) = if is_swapped {
                    ([other, triangle], [face.number, number])
                } else {
                    ([triangle, other], [number, face.number])
                };
                let Common {
                    origin,
                    corners,
                    fine,
                } = clipper.common(pair);
                if corners.len() > 2 {
                    let overlap = Overlap {
                        origin,
                        faces: numbers,
                        corners,
                        fine,
                    };
                    add(&mut value, overlap);
                }
                None::<Infallible>
            });
        }
        value
    };
    let ask = |numbers, triangles: &mut _| passed.triangles_in(numbers, triangles);
    let Ok(()) = map_batches(passed.face_count(), ask, make, |value| {
        take(value);
        Ok::<(), Infallible>(())
    });
}

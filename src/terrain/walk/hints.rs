//! A face near any position, from which a walk to that position is short.

use std::convert::Infallible;
use std::sync::atomic::{AtomicU32, Ordering};

use super::rim::RimEdge;
use crate::data::{Surface, map_batches};
use crate::terrain::boxes::{Boxes, Extent};

/// The average number of faces for each hint.
const FACES_PER_HINT: usize = 16;

/// No face.
const NONE: u32 = u32::MAX;

/// Squares in plan, each with a face that has its first corner there, if there is any.
#[derive(Debug)]
pub(super) struct Hints {
    min: [f64; 2],
    /// Squares per unit of the plan.
    scale: f64,
    sides: [usize; 2],
    faces: Vec<u32>,
}

impl Hints {
    /// Returns hints on a surface, and the edges of its rim.
    ///
    /// # Complexity
    /// Linear, on all threads; O(r log r) for r edges at the rim. A quarter of a byte for each
    /// face, and about 56 bytes for each edge at the rim.
    pub(super) fn new(surface: &dyn Surface) -> (Self, Boxes<RimEdge>) {
        let (mut count, mut edges) = (0, Vec::new());
        let mut extent: Option<Extent> = None;
        let ask = |numbers, faces: &mut _| surface.corners_in(numbers, faces);
        let make = |faces: &[(u32, [u32; 3])]| {
            let points = faces.iter().flat_map(|(_, corners)| corners);
            let extent = Extent::of(points.map(|&v| surface.position(v)));
            let mut edges = Vec::new();
            for &(face, corners) in faces {
                let is_rim = |&i: &usize| surface.neighbor(face, i).is_none();
                edges.extend(
                    (0..3)
                        .filter(is_rim)
                        .map(|i| RimEdge::new(surface, face, corners, i)),
                );
            }
            (faces.len(), extent, edges)
        };
        let Ok(()) = map_batches(surface.face_count(), ask, make, |(faces, of_batch, rim)| {
            count += faces;
            if faces > 0 {
                extent = Some(extent.map_or(of_batch, |known| known.with(of_batch)));
            }
            edges.extend(rim);
            Ok::<(), Infallible>(())
        });
        let hints = match extent {
            Some(extent) => Self::over(surface, extent, count),
            None => Hints {
                min: [0.0; 2],
                scale: 0.0,
                sides: [0; 2],
                faces: Vec::new(),
            },
        };
        (hints, Boxes::new(edges))
    }

    fn over(surface: &dyn Surface, Extent { min, max }: Extent, count: usize) -> Self {
        let [width, height] = [0, 1].map(|k| max[k] / 2.0 - min[k] / 2.0);
        let squares = (count / FACES_PER_HINT).max(1) as f64;
        // At most as many squares along the longer side as there are in all.
        // Roots first: the product of tiny lengths would be zero.
        let of_square = width.sqrt() * height.sqrt() / squares.sqrt();
        let side = (width.max(height) / squares).max(of_square);
        let scale = if side > 0.0 { 0.5 / side } else { 0.0 };
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let sides = [width, height]
            .map(|length| ((2.0 * length * scale).clamp(0.0, 2.0 * squares) as usize) + 1);
        let hints = Hints {
            min,
            scale,
            sides,
            faces: Vec::new(),
        };
        let squares: Vec<AtomicU32> = (0..sides[0] * sides[1])
            .map(|_| AtomicU32::new(NONE))
            .collect();
        let ask = |numbers, faces: &mut _| surface.corners_in(numbers, faces);
        let add = |faces: &[(u32, [u32; 3])]| {
            for &(face, corners) in faces {
                let [x, y, _] = surface.position(corners[0]);
                let [column, row] = hints.square([x, y]);
                squares[row * sides[0] + column].fetch_min(face, Ordering::Relaxed);
            }
        };
        let Ok(()) = map_batches(
            surface.face_count(),
            ask,
            add,
            |()| Ok::<(), Infallible>(()),
        );
        Hints {
            faces: squares.into_iter().map(AtomicU32::into_inner).collect(),
            ..hints
        }
    }

    /// Returns the square of a position; the nearest one if it is beyond all.
    fn square(&self, q: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|k| {
            let along = ((q[k] - self.min[k]) * self.scale).max(0.0) as usize;
            along.min(self.sides[k].saturating_sub(1))
        })
    }

    /// Returns a face near a position; `None` if the surface has none.
    ///
    /// # Complexity
    /// Constant where there are faces.
    pub(super) fn near(&self, q: [f64; 2]) -> Option<u32> {
        let [column, row] = self.square(q);
        let [columns, rows] = self.sides;
        let face = |column: usize, row: usize| {
            let face = self.faces.get(row * columns + column).copied();
            face.filter(|&face| face != NONE)
        };
        (0..columns.max(rows)).find_map(|far| {
            let range = |center: usize, count: usize| {
                center.saturating_sub(far)..(center + far + 1).min(count)
            };
            range(row, rows).find_map(|r| {
                if r.abs_diff(row) == far {
                    return range(column, columns).find_map(|c| face(c, r));
                }
                let [west, east] = [column.checked_sub(far), column.checked_add(far)];
                let mut ends = [west, east].into_iter().flatten().filter(|&c| c < columns);
                ends.find_map(|c| face(c, r))
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Mesh;

    #[test]
    fn hints_do_not_depend_on_the_unit() {
        let sides = |unit: f64| {
            let corner = |number: u32| {
                let [x, y] = [number % 65, number / 65].map(f64::from);
                [x * unit, y * unit, 0.0]
            };
            let lower = |corner: u32| [corner, corner + 1, corner + 66];
            let upper = |corner: u32| [corner, corner + 66, corner + 65];
            let cells = (0..65 * 32).filter(|corner| corner % 65 < 64);
            let faces = cells.flat_map(|corner| [lower(corner), upper(corner)]);
            let vertices = (0..65 * 33).map(corner).collect();
            let mesh = Mesh::new(vertices, faces.collect(), &[], None).unwrap();
            Hints::new(&mesh).0.sides
        };
        let [columns, rows] = sides(1.0);
        assert!(columns > 20 && rows > 10, "{columns} {rows}");
        // The product of two sides is zero, or infinite.
        for power in [-600, 600] {
            assert_eq!(sides(2f64.powi(power)), [columns, rows]);
        }
    }
}

//! Which faces of different parts share an edge.

use std::convert::Infallible;

use rayon::prelude::*;

use crate::data::{Surface, map_batches};

/// The edge of a face opposite a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    pub(super) face: u32,
    pub(super) corner: u8,
}

/// The edges that faces of different parts share.
#[derive(Debug, Default)]
pub(super) struct Seams {
    /// Each side of a shared edge with the other one, in order.
    sides: Vec<[Side; 2]>,
}

impl Seams {
    /// Finds the edges that two faces have at the rims of their parts. `key` names a vertex alike
    /// in all parts.
    ///
    /// # Complexity
    /// Linear in the faces, on all threads; O(r log r) for r edges at the rims of parts, with 56
    /// bytes for each.
    pub(super) fn of(surface: &dyn Surface, key: &(dyn Fn(u32) -> Option<u64> + Sync)) -> Self {
        let mut open: Vec<([u64; 2], Side)> = Vec::new();
        let ask = |numbers, faces: &mut _| surface.corners_in(numbers, faces);
        let make = |faces: &[(u32, [u32; 3])]| {
            let mut open = Vec::new();
            for &(face, corners) in faces {
                for i in (0..3).filter(|&i| surface.neighbor(face, i).is_none()) {
                    if let [Some(a), Some(b)] = [1, 2].map(|k| key(corners[(i + k) % 3])) {
                        let corner = i as u8;
                        open.push(([a.min(b), a.max(b)], Side { face, corner }));
                    }
                }
            }
            open
        };
        let Ok(()) = map_batches(surface.face_count(), ask, make, |of_batch| {
            open.extend(of_batch);
            Ok::<(), Infallible>(())
        });
        open.par_sort_unstable();
        let mut sides: Vec<[Side; 2]> = Vec::new();
        for edge in open.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = *edge {
                sides.extend([[a, b], [b, a]]);
            }
        }
        sides.par_sort_unstable();
        Seams { sides }
    }

    /// Returns the other side of an edge; `None` unless parts share it.
    ///
    /// # Complexity
    /// Logarithmic.
    pub(super) fn across(&self, face: u32, corner: usize) -> Option<Side> {
        let corner = corner as u8;
        let at = self
            .sides
            .binary_search_by_key(&Side { face, corner }, |[own, _]| *own)
            .ok()?;
        Some(self.sides[at][1])
    }
}

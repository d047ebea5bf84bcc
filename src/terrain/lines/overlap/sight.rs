//! Where steps between waters can be seen.

use crate::data::Bounds;
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::lines::areas::{Water, WaterLevel};
use crate::terrain::nearest::part_before;

/// A side of a shore.
#[derive(Debug, Clone, Copy)]
struct ShoreSide([[f64; 2]; 2]);

impl Boxed for ShoreSide {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.0)
    }
}

/// A lake, by its number, and the box around it.
#[derive(Debug, Clone, Copy)]
struct Lake {
    water: usize,
    extent: Extent,
}

impl Boxed for Lake {
    fn extent(&self) -> Extent {
        self.extent
    }
}

/// What hides the steps between waters: lakes, and the bounds of the surface.
#[derive(Debug)]
pub(super) struct Sight {
    bounds: Option<Bounds>,
    lakes: Boxes<Lake>,
    shores: Boxes<ShoreSide>,
}

impl Sight {
    pub(super) fn new(waters: &[Water], bounds: Option<Bounds>) -> Self {
        let (mut lakes, mut shores) = (Vec::new(), Vec::new());
        for (water, Water { level, .. }) in waters.iter().enumerate() {
            if matches!(level, WaterLevel::Flat(_)) {
                let rings = level.rings();
                lakes.push(Lake {
                    water,
                    extent: Extent::of_plan(rings.iter().flatten().copied()),
                });
                shores.extend(
                    rings
                        .iter()
                        .flat_map(|ring| ring.windows(2))
                        .map(|pair| ShoreSide([pair[0], pair[1]])),
                );
            }
        }
        Sight {
            bounds,
            lakes: Boxes::new(lakes),
            shores: Boxes::new(shores),
        }
    }

    /// The parts of a segment, from 0 to 1, at which it may pass a shore or the border of the
    /// bounds.
    pub(super) fn parts_of(&self, segment: [[f64; 2]; 2]) -> Vec<f64> {
        let mut parts = Vec::new();
        self.shores
            .find_in(Extent::of_plan(segment), |ShoreSide(ends)| {
                parts.push(part_before(segment, *ends));
                None::<()>
            });
        if let Some(Bounds {
            min: [x0, y0, _],
            max: [x1, y1, _],
        }) = self.bounds
        {
            let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
            parts.extend(
                [[0, 1], [1, 2], [2, 3], [3, 0]]
                    .map(|side| part_before(segment, side.map(|k| corners[k]))),
            );
        }
        parts.retain(|part| *part > 0.0 && *part < 1.0);
        parts
    }

    /// Returns true if a position is within the bounds.
    pub(super) fn holds(&self, [x, y]: [f64; 2]) -> bool {
        self.bounds.as_ref().is_none_or(|bounds| bounds.holds(x, y))
    }

    /// The lakes whose box contains a position.
    pub(super) fn lakes_near(&self, q: [f64; 2]) -> Vec<usize> {
        let mut lakes = Vec::new();
        self.lakes.find(q, |lake| {
            lakes.push(lake.water);
            None::<()>
        });
        lakes
    }
}

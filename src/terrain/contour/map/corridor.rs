//! Where lines of a level may lie: within a tolerance of its height.

use rustc_hash::FxHashMap;

use super::reshaped::{Divided, is_held};
use super::work::GoOn;
use crate::data::{Surface, corners};
use crate::error::Result;
use crate::terrain::contour::crossing;
use crate::terrain::contour::index::LevelIndex;
use crate::terrain::linear::{plan, sorted};
use crate::terrain::walk::{Arrival, At, Locator, follow_linked};

/// A position in plan, with where on the surface it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub(super) point: [f64; 2],
    pub(super) at: At,
}

/// The smoothed surface, as far as lines may be moved on it.
pub(super) struct Corridor<'a> {
    surface: &'a dyn Surface,
    /// The largest difference of heights from the level along lines.
    half_width: f64,
    anchors: Anchors,
    go_on: GoOn<'a>,
}

/// Edges that lines meet where they are, and not elsewhere: held ones and those of the rim. Each
/// with its ends in order, by the bits of the point at which it crosses a level.
type Anchors = FxHashMap<[u64; 2], [[f64; 2]; 2]>;

fn key(point: [f64; 2]) -> [u64; 2] {
    point.map(f64::to_bits)
}

impl<'a> Corridor<'a> {
    /// Prepares a surface of which no vertex is on a level.
    ///
    /// # Complexity
    /// Linear in the faces, on one thread; about 70 bytes for each crossing of a level with a held
    /// edge or the rim.
    pub(super) fn new(
        surface: &'a dyn Surface,
        index: &LevelIndex,
        half_width: f64,
        go_on: GoOn<'a>,
    ) -> Self {
        let mut anchors = Anchors::default();
        for (face, vertices) in corners(surface) {
            for i in 0..3 {
                let is_rim = surface.neighbor(face, i).is_none();
                if !is_rim && !is_held(surface, face, i) {
                    continue;
                }
                let ends = [1, 2].map(|k| surface.position(vertices[(i + k) % 3]));
                let [low, high] = [f64::min, f64::max].map(|of| of(ends[0][2], ends[1][2]));
                let crossed = index.first_from(low)..index.first_from(high);
                for &level in &index.levels()[crossed] {
                    let point = crossing(ends[0], ends[1], level);
                    anchors.insert(key(point), sorted(ends.map(plan)));
                }
            }
        }
        Corridor {
            surface,
            half_width,
            anchors,
            go_on,
        }
    }

    /// Returns true if a point of a line stays where it is, because the line meets a held edge or
    /// the rim there.
    pub(super) fn is_anchor(&self, point: [f64; 2]) -> bool {
        self.anchors.contains_key(&key(point))
    }

    /// Returns where the points of a line of contours are; for an anchor, in the face of the
    /// segment after it, and also in that of the segment before it.
    pub(super) fn spots(&self, locator: &Locator<'_>, points: &[[f64; 2]]) -> Vec<[At; 2]> {
        let middle = |i: usize| {
            let (a, b) = (points.get(i)?, points.get(i + 1)?);
            Some([0, 1].map(|axis| 0.5 * a[axis] + 0.5 * b[axis]))
        };
        let face_at = |q: Option<[f64; 2]>| match q.map(|q| locator.at(q)) {
            Some(At::Inside { face }) => At::Inside { face },
            _ => At::Off,
        };
        let spot = |(i, &point): (usize, &[f64; 2])| {
            if self.is_anchor(point) {
                [i.checked_sub(1).and_then(middle), middle(i)].map(face_at)
            } else {
                [locator.at(point); 2]
            }
        };
        points.iter().enumerate().map(spot).collect()
    }

    /// Returns true if a position is on a held edge, or at a vertex, where one could end.
    fn is_held(&self, at: At) -> bool {
        match at {
            At::Off | At::Inside { .. } => false,
            At::Edge { face, corner } => is_held(self.surface, face, corner),
            At::Vertex { .. } => true,
        }
    }

    /// Counts work that is done.
    ///
    /// # Errors
    /// If it was stopped.
    pub(super) fn count(&self, vertices: u64) -> Result<()> {
        (self.go_on)(vertices)
    }

    /// Returns the number of vertices, by which work is counted.
    pub(super) fn vertex_count(&self) -> usize {
        self.surface.vertex_count()
    }

    /// Returns where a segment ends that begins at a spot, if it stays in the corridor of a level
    /// and meets no held edge before its end. None does once the work was stopped, so that lines
    /// are soon done.
    pub(super) fn passes(&self, from: Spot, to: [f64; 2], level: f64) -> Option<At> {
        self.count(0).ok()?;
        let mut largest = 0.0_f64;
        let divided = Divided(self.surface);
        let arrival = follow_linked(&divided, from.at, [from.point, to], |[_, _, z]| {
            largest = largest.max((z - level).abs());
        });
        if largest > self.half_width {
            return None;
        }
        match arrival {
            Arrival::End(at) => (self.is_anchor(to) || !self.is_held(at)).then_some(at),
            // An anchor, rounded to the other side of its edge.
            Arrival::Rim(edge) => {
                (self.anchors.get(&key(to)) == Some(&sorted(edge))).then_some(At::Off)
            }
            Arrival::Nowhere => None,
        }
    }
}

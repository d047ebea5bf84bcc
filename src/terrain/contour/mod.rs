//! Contour lines, cut straight from the triangles.
//!
//! # The rule
//!
//! Heights rounded to centimetres lie on a level all the time: corners, edges, whole triangles and
//! saddles. One rule covers them all. Let *H* be the closure of the interior of the set where the
//! surface is at the level or above. **The contour is the boundary of *H***, without what lies on
//! the edge of the data, directed so that *H* is on its right.
//!
//! *H* is a union of one polygon per face. By the heights of the corners, `+` above, `0` on and `-`
//! below the level:
//!
//! | corners | in *H* | pieces of contour |
//! |---|---|---|
//! | `+++` `++0` `+00` `000` | all of the face | none inside |
//! | `---` `--0` `-00` | nothing: a corner or an edge has no interior | none inside |
//! | `++-` `+--` | the part above the crossings | from crossing to crossing |
//! | `+0-` | the part above | from the corner to the crossing |
//!
//! What remains are the edges of faces. Along an edge `++`, `+0` or the upper part of `+-` both
//! faces belong to *H*, along `--` and `0-` neither: their pieces cancel, or there are none. Along an
//! edge `00` each face counts by its third corner, so:
//!
//! | third corners of the faces at an edge `00` | piece |
//! |---|---|
//! | `+` or `0` in one, `-` in the other | the edge |
//! | both `+` or `0`; both `-` | none |
//! | only one face: the edge of the data | none |
//!
//! So a ridge that just reaches the level, a summit on it, and the inside of a lake on it give
//! nothing, the shore of the lake gives one line, and no piece comes twice.
//!
//! # Why every line closes or ends at the edge of the data
//!
//! Pieces meet at *nodes*: the crossing of an edge `+-`, or a vertex `0`. Each face at an edge `+-` has
//! exactly one piece that ends there, and one of the two faces sees it begin and the other end,
//! because they see the edge in opposite directions. Around a vertex `0`, the sectors of the faces
//! belong to *H* or do not; going around counter-clockwise, a piece leaves the vertex where *H* ends
//! and arrives where it begins. Around an inner vertex the changes alternate and come out even: as
//! many arrive as leave. At the edge of the data the faces around a vertex form one or more *fans*;
//! within a fan the changes alternate, and one may be left over: the line ends there.
//!
//! # The turn rule
//!
//! At a vertex where more than one line passes (a saddle on the level), **an arriving piece goes on
//! with the first leaving piece counter-clockwise from it** that is not itself taken by a piece
//! arriving in between, as brackets are paired. That is the sharpest turn to the right, around one
//! sector of high ground: high ground that meets only at a vertex stays apart. Pairs of neighbors in
//! the circle never cross. At the edge of the data the circle goes on over the gap, so that a line
//! ends there only if there is nothing left to join it with.
//!
//! # Points
//!
//! Nodes are joined by the links between faces, never by comparing coordinates. The crossing of an edge
//! is computed from its smaller end, in `f64`, and lies in the box of the edge: both faces, and any
//! numbering of the vertices, give the same bits. Where ground is narrower than the steps of an
//! `f64` (0.57 and 57 * 0.01 differ in the last bit), crossings fall on vertices or on each other. Where
//! that is seen, the rule is kept for the rounded pieces: those without length go, opposite ones
//! that coincide cancel, and the others are joined anew by the turn rule. (Pieces less than such a step
//! apart may still cross by the last bit.)
//!
//! # The order
//!
//! Lines come by level and then by their points, a closed line from its smallest point. So the result
//! depends on the set of triangles alone: not on numbers, order or threads. Contours of a part of the
//! faces are those of the whole, cut to the pieces inside those faces and between two of them.

mod cut;
mod find;
mod index;
mod join;
mod line;
mod trace;

use super::Levels;
use crate::data::{ContourLine, Surface};
use crate::error::Result;
use cut::{ContourArc, Cut};
use index::LevelIndex;
use rayon::prelude::*;
use std::cmp::Ordering;
use trace::{Done, Traces};

/// Draws the contours of a surface: lines by level and then by their points, high ground on the
/// right, each closed or ending at the edge of the data. The exact rule, which covers vertices,
/// edges and triangles on a level, is told in [the module](self). Vertices must be finite.
///
/// # Errors
/// If the levels within the heights of the surface are more than [`MAX_LEVELS`](super::MAX_LEVELS).
///
/// # Complexity
/// Linear in faces and pieces of contour, but for sorting the lines: two passes over the faces at once,
/// and one for every two million pieces (or one level with more), which are drawn together while the
/// iterator waits. Faces that no level meets cost a comparison, in a raster a quarter of one. Memory: for
/// pieces drawn together, 24 bytes a piece and 16 bytes a point; 24 bytes a level; one bit a face for each
/// thread. Faces are looked at in parallel, and levels are drawn in parallel.
pub fn contours<'a, S: Surface + ?Sized>(surface: &'a S, levels: &Levels) -> Result<Contours<'a, S>> {
    let [low, high] = find::height_range(surface);
    let index = LevelIndex::new(levels.within(low, high)?);
    let counts = find::count(surface, &index);
    Ok(Contours { surface, index, counts, next_level: 0, ready: Vec::new().into_iter() })
}

/// The contours of a surface, one after the other; made by [`contours`].
#[must_use = "lines are drawn when they are asked for"]
pub struct Contours<'a, S: ?Sized> {
    surface: &'a S,
    index: LevelIndex,
    /// Pieces of each level.
    counts: Vec<usize>,
    next_level: usize,
    ready: std::vec::IntoIter<ContourLine>,
}

/// Levels are drawn together up to so many pieces.
const BAND: usize = 1 << 21;

impl<S: Surface + ?Sized> Iterator for Contours<'_, S> {
    type Item = ContourLine;

    fn next(&mut self) -> Option<ContourLine> {
        loop {
            if let Some(line) = self.ready.next() {
                return Some(line);
            }
            if self.next_level == self.counts.len() {
                return None;
            }
            self.ready = self.draw_band().into_iter();
        }
    }
}

impl<S: Surface + ?Sized> Contours<'_, S> {
    /// The pieces of all lines, counted before any is drawn. A line has a vertex for each, and one more if it is open;
    /// the few that are shorter than a rounding have none.
    pub fn arc_count(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Draws the next levels, at least one, and at most [`BAND`] pieces if they are more.
    fn draw_band(&mut self) -> Vec<ContourLine> {
        let first = self.next_level;
        let mut sum = 0;
        let fits = |&&count: &&usize| {
            sum += count;
            sum == count || sum <= BAND
        };
        let band = first..first + self.counts[first..].iter().take_while(fits).count();
        self.next_level = band.end;
        // Pieces are sorted by level, by counting.
        let found = find::arcs(self.surface, &self.index, band.clone());
        let mut starts = vec![0; band.len() + 1];
        found.iter().flatten().for_each(|(level, _)| starts[level - first + 1] += 1);
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut sorted = vec![ContourArc::Across(0); starts[band.len()]];
        let mut free = starts.clone();
        for (level, arc) in found.into_iter().flatten() {
            let slot = &mut free[level - first];
            sorted[*slot] = arc;
            *slot += 1;
        }
        let drawn: Vec<Vec<ContourLine>> = band
            .into_par_iter()
            .map_init(
                || Done::new(self.surface.face_count()),
                |done, level| {
                    let range = starts[level - first]..starts[level - first + 1];
                    draw_level(self.surface, self.index.levels()[level], &sorted[range], done)
                },
            )
            .collect();
        drawn.into_iter().flatten().collect()
    }
}

fn draw_level<S: Surface + ?Sized>(surface: &S, level: f64, arcs: &[ContourArc], done: &mut Done) -> Vec<ContourLine> {
    let Traces { traces, touches_vertices } = trace::trace(&Cut { surface, level }, arcs, done);
    let mut joined = join::join(surface, traces);
    if touches_vertices || joined.iter().any(line::falls_together) {
        joined = join::rejoin(&joined);
    }
    let mut lines: Vec<ContourLine> = joined.into_iter().map(|joined| line::finish(level, joined)).collect();
    lines.sort_by(|a, b| a.points.partial_cmp(&b.points).unwrap_or(Ordering::Equal));
    lines
}

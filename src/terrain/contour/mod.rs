//! Contour lines of a surface, computed directly from its triangles.
//!
//! # The rule
//!
//! Heights rounded to centimeters often lie exactly on a level: at corners, along edges, on whole
//! triangles and at saddles. One rule covers all of these cases. Let *H* be the closure of the
//! interior of the set where the surface is at the level or above. **The contour is the boundary of
//! *H***, except where it is the edge of the data, directed so that *H* is on its right.
//!
//! *H* is a union of one polygon per face, and the contour consists of *arcs*, each in one face or
//! on one edge. The heights of the corners, `+` above, `0` on and `-` below the level, decide:
//!
//! | corners | in *H* | arcs |
//! |---|---|---|
//! | `+++` `++0` `+00` `000` | the whole face | none inside |
//! | `---` `--0` `-00` | nothing: a corner or an edge has no interior | none inside |
//! | `++-` `+--` | the part above the crossings | from crossing to crossing |
//! | `+0-` | the part above | from the corner to the crossing |
//!
//! ```text
//!           -
//!          / \
//!     ----x-->x----     a face `++-`: the high ground, below, is on the right
//!        /     \
//!       +-------+
//! ```
//!
//! This leaves the edges of faces. Along an edge `++`, `+0` or the upper part of `+-`, both faces
//! belong to *H*, so their arcs cancel; along `--` and `0-` neither does. Along an edge `00`, each
//! face counts by its third corner:
//!
//! | third corners of the faces at an edge `00` | arc |
//! |---|---|
//! | `+` or `0` in one, `-` in the other | the edge |
//! | both `+` or `0`; both `-` | none |
//! | only one face: the edge of the data | none |
//!
//! So there is no contour on a ridge that just reaches the level, at a summit on it, or inside a
//! lake on it. The shore of the lake is one line, and no arc occurs twice.
//!
//! # Why every line closes or ends at the edge of the data
//!
//! Arcs meet at *nodes*: the crossing of an edge `+-`, or a vertex `0`. Each face at an edge `+-`
//! has exactly one arc with an end there. It starts in one of the two faces and ends in the other,
//! because they have the edge in opposite directions. Around a vertex `0`, each face's sector
//! belongs to *H* or does not. Counter-clockwise, an arc leaves the vertex where *H* ends, and
//! arrives where *H* begins. Around an inner vertex these changes alternate, so as many arcs arrive
//! as leave. At the edge of the data, the faces around a vertex form one or more *fans*. The
//! changes alternate within a fan, and one may be left over: the line ends there.
//!
//! # The turn rule
//!
//! At a vertex that more than one line passes (a saddle on the level), **an arriving arc continues
//! with the first leaving arc counter-clockwise from it** that is not taken by an arc arriving in
//! between, like pairs of brackets. This is the sharpest turn to the right, around one sector of
//! high ground: areas of high ground that meet only at a vertex stay separate. Pairs of neighbors
//! in the circle never cross. At the edge of the data the circle continues across the gap, so that
//! a line ends there only if no arc is left to join it with.
//!
//! # The loop rule
//!
//! High ground that meets *itself* at a vertex surrounds low ground. The turn rule alone would draw
//! its outer and its inner border as one line, which passes the vertex twice. So **a line is cut
//! where it passes a point for the second time**: the loop in between becomes a line of its own. No
//! line touches itself, and each closed one is the border of a simple polygon.
//!
//! ```text
//!     +-----------+
//!     |  +-----+  |     The high ground between the outer and the inner ring
//!     |  | low |  |     meets itself at x. The two are cut there; both pass x.
//!     |   \   /   |
//!     +----`x´----+
//! ```
//!
//! All passages turn around high ground, so that the loops lie on one side of the line and are
//! nested or disjoint: it does not matter which is cut first. Only an open line can come back to a
//! vertex on the other side of its loop, through a gap in the data: it ends there, and starts
//! again.
//!
//! # Points
//!
//! Nodes are joined by the links between faces, never by comparing coordinates. The crossing of an
//! edge is computed from its smaller end, in `f64`, and lies in the box of the edge. So both faces,
//! and any numbering of the vertices, give the same bits. Where ground is narrower than the steps
//! of an `f64` (0.57 and 57 * 0.01 differ in the last bit), crossings coincide with vertices or
//! with each other. If this is detected, the rule is applied to the rounded arcs: those without
//! length are removed, opposite ones that coincide cancel, and the others are joined again by the
//! turn rule.
//!
//! # Several levels
//!
//! **Arcs of two levels do not cross.** Along an edge, crossings are in the order of their levels,
//! and arcs of one face are parallel. But in a face that is narrower than some steps of an `f64`,
//! rounding may turn them. Arcs that end at such faces are compared with each other, and those that
//! cross are routed through common points, half a step away at most, by snap rounding. There lines
//! of several levels may touch, or run together. (See `narrow.rs`.)
//!
//! # The order
//!
//! Lines are sorted by level and then by their points; a closed line starts at its smallest point.
//! So the result depends on the set of triangles alone: not on numbers, order or threads. The
//! contours of some of the faces are those of all faces, restricted to the arcs inside these faces
//! and between two of them, but for arcs that are routed through common points.

mod bands;
mod cut;
mod find;
mod index;
mod join;
mod line;
mod loops;
mod map;
mod narrow;
pub mod parts;
mod polygons;
mod trace;

use super::Levels;
use crate::data::{ContourLine, Surface};
use crate::error::Result;
use bands::Bands;
pub(super) use cut::crossing;
use join::Joined;
pub use map::{
    Band, ContourLabel, GoOn, LabelRules, LabelTops, MapContours, MapLine, MapRules, contour_bands,
    contour_labels, map_contours, map_contours_while, map_of_contours, map_work,
};
use narrow::{Bends, NarrowArcs};
pub(super) use polygons::Polygons;
use trace::Traces;

/// Returns the contours of a surface, sorted by level and then by their points.
///
/// Each line has the higher ground on its right, and is closed or ends at the edge of the data.
/// [The module](self) states the exact rule, which covers vertices, edges and triangles on a level.
/// Vertices must be finite.
///
/// # Errors
/// If more than [`MAX_LEVELS`](super::MAX_LEVELS) levels lie within the heights of the surface.
///
/// # Complexity
/// Linear in faces and arcs, except for sorting the lines. Two passes over the faces find those
/// that have arcs. Levels are drawn when the iterator needs them, two million arcs at a time (or
/// one level with more); if more than four million faces have arcs, each time takes one more pass.
/// Levels that meet a face narrower than some steps of its coordinates are drawn twice. A face that
/// no level meets costs a comparison; in a raster, much less. Memory: 16 bytes for each face with
/// arcs, unless there are more than four million; 8 bytes for each arc that is drawn and 16 for
/// each of its points; 24 bytes per level; one bit per face for each thread. Faces are scanned in
/// parallel, and levels are drawn in parallel.
pub fn contours<'a, S: Surface + ?Sized>(
    surface: &'a S,
    levels: &Levels,
) -> Result<Contours<'a, S>> {
    let bands = Bands::new(surface, levels)?;
    Ok(Contours {
        bends: bends_of(&bands),
        bands,
        ready: Vec::new().into_iter(),
    })
}

/// An iterator over the contours of a surface, returned by [`contours`].
#[must_use = "lines are drawn when they are asked for"]
pub struct Contours<'a, S: ?Sized> {
    bands: Bands<'a, S>,
    bends: Bends,
    ready: std::vec::IntoIter<ContourLine>,
}

impl<S: Surface + ?Sized> Iterator for Contours<'_, S> {
    type Item = ContourLine;

    fn next(&mut self) -> Option<ContourLine> {
        loop {
            if let Some(line) = self.ready.next() {
                return Some(line);
            }
            self.ready = self.draw_band()?.into_iter();
        }
    }
}

impl<S: Surface + ?Sized> Contours<'_, S> {
    /// Returns the number of arcs of all lines, which is known before any line is drawn.
    ///
    /// A line has one vertex per arc, and one more if it is open. The few arcs that rounding
    /// collapses have none; those that are bent, where several levels would cross, have more.
    pub fn arc_count(&self) -> usize {
        self.bands.arc_count()
    }

    /// Draws the next levels; `None` after the last.
    fn draw_band(&mut self) -> Option<Vec<ContourLine>> {
        let (surface, bends) = (self.bands.surface(), &self.bends);
        let draw = |level, traces| finished(surface, level, traces, bends);
        Some(self.bands.next(draw)?.into_iter().flatten().collect())
    }
}

/// Returns the rings that consist of some arcs, by the turn rule and the loop rule: each repeats
/// its first point at the end, and has no other point twice. High ground is on the right of arcs.
/// What does not close is left out.
pub(super) fn simple_rings(arcs: Vec<[[f64; 2]; 2]>) -> Vec<Vec<[f64; 2]>> {
    let arcs = arcs.into_iter().map(|arc| Joined {
        points: arc.to_vec(),
        closed: false,
    });
    let lines = line::finish_level(0.0, arcs.collect(), true, &Bends::default());
    let rings = lines.into_iter().map(|line| line.points);
    rings
        .filter(|ring| ring.len() > 3 && ring.first() == ring.last())
        .collect()
}

/// Returns the lines of a level.
fn finished<S: Surface + ?Sized>(
    surface: &S,
    level: f64,
    Traces {
        traces,
        touches_vertices,
    }: Traces,
    bends: &Bends,
) -> Vec<ContourLine> {
    line::finish_level(level, join::join(surface, traces), touches_vertices, bends)
}

/// Returns the bends at narrow faces. The levels that meet them are drawn for that, in bands.
fn bends_of<S: Surface + ?Sized>(bands: &Bands<S>) -> Bends {
    let sites = bands.narrow_sites();
    let (mut arcs, mut rest) = (NarrowArcs::default(), &sites[..]);
    while let [(first, _), ..] = rest {
        let band = bands.band_from(*first);
        let (now, later) = rest.split_at(rest.partition_point(|(level, _)| *level < band.end));
        let lines = bands.trace(band.clone(), |level, traces| {
            finished(bands.surface(), level, traces, &Bends::default())
        });
        for (level, sites) in now {
            arcs.add(&lines[level - band.start], sites);
        }
        rest = later;
    }
    arcs.bends()
}

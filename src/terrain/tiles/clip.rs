//! Clips of a surface that comes triangle by triangle.

use rustc_hash::FxHashMap;

use super::part::TinPart;
use super::sub_constraint::rounding_reach;
use super::triangle::{TileTriangle, TileVertex};
use crate::data::{Bounds, EdgeKind};
use crate::error::{Error, Result};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::clip::Clip;
use crate::terrain::cut::{Cut, divided};
use crate::terrain::regions::{Domain, Segment};
use crate::terrain::{Inside, TinBuilder};
use crate::triangulation::geometry::Terrain;
use crate::triangulation::{ConstrainedDelaunay, OnCrossing};

/// A line is divided into about as many boxes as this for each surface, so that boxes are small
/// where it is long.
const BOXES: f64 = 65_536.0;

/// What a surface in tiles is cut along: a boundary, bounds, holes, draped lines.
///
/// Triangles that no line comes near are kept or left out whole, each by itself. All others are
/// [cut](Self::cut) together, once they are known, as the whole surface would be: a fragment
/// depends only on lines, and on triangles that lines come near. There is one exception, which is
/// refused: an edge that a line crosses, and that has a vertex within a rounding error of it
/// elsewhere, bends there, and the triangle beyond it matters, too.
#[derive(Debug)]
pub struct TileClip {
    clip: Clip,
    segments: Vec<(Domain, Segment)>,
    near: Boxes<LineBox>,
    polygons: Inside,
    holes: Inside,
}

/// The box of a part of a line, enlarged by what rounding may move.
#[derive(Debug, Clone, Copy)]
struct LineBox(Extent);

impl Boxed for LineBox {
    fn extent(&self) -> Extent {
        self.0
    }
}

/// Where a box lies that no line, or some line, comes near.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClipSide {
    /// The surface is kept there.
    Kept,
    /// The surface is left out there.
    Outside,
    /// A line may be there.
    Near,
}

impl TileClip {
    /// Takes what the surface of a builder is cut along; `None` if it is not cut. `extent` contains
    /// all points and lines.
    ///
    /// # Errors
    /// If a vertex of a line or a bound is outside of the range of the arithmetic.
    ///
    /// # Complexity
    /// O(n log n) for n segments.
    pub fn take_from(builder: &mut TinBuilder, extent: &Bounds) -> Result<Option<Self>> {
        let clip = builder.take_clip();
        builder.bounds = None;
        if clip.is_everything() {
            return Ok(None);
        }
        let segments = clip.segments()?;
        let largest = [extent.min, extent.max].as_flattened().iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        let margin = rounding_reach(largest.max(f64::MIN_POSITIVE));
        // Rounding depends on the lines' ends; those far away are left out.
        let reach = [0, 1].map(|k: usize| extent.min[k].abs().max(extent.max[k].abs()));
        let near = Boxes::new(boxes(&divided(&segments, reach), extent, margin));
        let (polygons, holes) = (Inside::new(&clip.polygons), Inside::new(&clip.holes));
        Ok(Some(TileClip { clip, segments, near, polygons, holes }))
    }

    /// Returns where a box in plan lies.
    ///
    /// # Complexity
    /// O(log n) in practice for n segments, if no line is near.
    pub fn side_of(&self, min: [f64; 2], max: [f64; 2]) -> ClipSide {
        let extent = Extent { min, max };
        let is_met = |LineBox(line_box): &LineBox| line_box.overlaps(&extent).then_some(());
        if self.near.find_in(extent, is_met).is_some() {
            return ClipSide::Near;
        }
        // Without a line near, each position of the box is as good, and none is on the border of
        // the bounds; if they are one position, they have no inside.
        let is_within = |bounds: &Bounds| (0..2).all(|k| bounds.min[k] < min[k] && min[k] < bounds.max[k]);
        let is_kept = self.clip.bounds.as_ref().is_none_or(is_within)
            && (self.clip.polygons.is_empty() || self.polygons.contains(min))
            && !self.holes.contains(min);
        if is_kept { ClipSide::Kept } else { ClipSide::Outside }
    }

    /// Returns where a triangle lies.
    pub fn side_of_triangle(&self, triangle: &TileTriangle) -> ClipSide {
        let Extent { min, max } = Extent::of(triangle.corners.map(|corner| corner.position));
        self.side_of(min, max)
    }

    /// Cuts all triangles that lines come near, and returns the triangles and fragments that are
    /// kept, or `None` if `triangles` is empty.
    ///
    /// Each triangle comes with true if it is in the surface before the cut. `reach` is the largest
    /// absolute coordinate of all points on each axis, in the units of the data.
    ///
    /// # Errors
    /// If an edge would bend away from all lines, if the triangles are not some of one
    /// triangulation, or if there are too many.
    ///
    /// # Complexity
    /// O(n log n) for n triangles and segments.
    pub fn cut(&self, triangles: &[(TileTriangle, bool)], reach: [f64; 2]) -> Result<Option<TinPart>> {
        if triangles.is_empty() {
            return Ok(None);
        }
        let mut part = Uncut::new(triangles).triangulated()?;
        self.clip.apply_to_part(&mut part.tin, &self.segments, reach)?;
        match part.tin.cut.as_ref().and_then(|cut| self.bend_away_from_lines(cut)) {
            Some(at) => Err(bends(at)),
            None => Ok(Some(part)),
        }
    }

    /// Returns a position that divides an edge and that no line is near. At a line, all triangles
    /// are known; elsewhere, the one beyond the edge may be missing.
    fn bend_away_from_lines(&self, cut: &Cut) -> Option<[f64; 2]> {
        let mut bend = None;
        cut.each_divided(|at| {
            if self.side_of(at, at) != ClipSide::Near {
                bend = Some(at);
            }
        });
        bend
    }
}

/// Triangles that lines come near, as the input of a triangulation.
struct Uncut<'a> {
    triangles: &'a [(TileTriangle, bool)],
    vertices: Vec<TileVertex>,
    /// The corners of each triangle, as indices of vertices.
    corners: Vec<[u32; 3]>,
}

impl<'a> Uncut<'a> {
    fn new(triangles: &'a [(TileTriangle, bool)]) -> Self {
        let mut vertices: Vec<TileVertex> = Vec::new();
        let mut known: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        let mut index = |corner: TileVertex| {
            *known.entry([corner.tile, corner.number]).or_insert_with(|| {
                vertices.push(corner);
                vertices.len() as u32 - 1
            })
        };
        let corners = triangles.iter().map(|(triangle, _)| triangle.corners.map(&mut index)).collect();
        Uncut { triangles, vertices, corners }
    }

    /// Returns the edges on lines, and those with a triangle on one side only, with their kinds.
    /// Others are edges of the triangulation by themselves.
    fn constraints(&self) -> Vec<([u32; 2], EdgeKind)> {
        // The kind of each edge, and the directions in which triangles pass it.
        let mut edges: FxHashMap<[u32; 2], (EdgeKind, u8)> = FxHashMap::default();
        for (corners, (triangle, _)) in self.corners.iter().zip(self.triangles) {
            for i in 0..3 {
                let [a, b] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                let (_, directions) = edges.entry([a.min(b), a.max(b)]).or_insert((triangle.edges[i], 0));
                *directions |= if a < b { 1 } else { 2 };
            }
        }
        let is_constraint =
            |(_, (kind, directions)): &([u32; 2], (EdgeKind, u8))| kind.is_constrained() || *directions != 3;
        let mut constraints: Vec<([u32; 2], EdgeKind)> =
            edges.into_iter().filter(is_constraint).map(|(edge, (kind, _))| (edge, kind)).collect();
        constraints.sort_unstable_by_key(|(edge, _)| *edge);
        constraints
    }

    /// Triangulates the vertices. The triangles that are in the surface are the faces.
    fn triangulated(&self) -> Result<TinPart> {
        let (lines, kinds): (Vec<[u32; 2]>, Vec<EdgeKind>) = self.constraints().into_iter().unzip();
        let points: Vec<[f64; 3]> = self.vertices.iter().map(|vertex| vertex.position).collect();
        let (t, ids) = ConstrainedDelaunay::from_lines(Terrain::default(), &points, &lines, OnCrossing::Reject)
            .map_err(|_| contradiction())?;
        let mut inside = vec![false; t.tds().cell_slots()];
        for (corners, (_, is_inside)) in self.corners.iter().zip(self.triangles) {
            let [a, b, c] = corners.map(|corner| ids[corner as usize]);
            match t.tds().edge(a, b) {
                Some((cell, i)) if t.tds().vertex(cell, i) == c => inside[cell.index()] = *is_inside,
                _ => return Err(contradiction()),
            }
        }
        let mut numbers = vec![[u32::MAX; 2]; t.tds().vertex_slots()];
        for (id, vertex) in ids.iter().zip(&self.vertices) {
            numbers[id.index()] = [vertex.tile, vertex.number];
        }
        let numbers = t.tds().vertices().map(|id| numbers[id.index()]).collect();
        let mut part = TinPart::new(t, kinds, Vec::new(), numbers);
        part.tin.inside = inside;
        Ok(part)
    }
}

/// Divides lines into parts, and returns their boxes. What is far beyond the extent is left out.
fn boxes(segments: &[(Domain, Segment)], extent: &Bounds, margin: f64) -> Vec<LineBox> {
    let size = [0, 1].map(|k| (extent.max[k] - extent.min[k]).max(margin));
    // The parts of lines within the extent, enlarged.
    let within = |[a, b]: &Segment| -> Option<Segment> {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in 0..2 {
            let (low, high) = (extent.min[k] - size[k], extent.max[k] + size[k]);
            let step = b[k] - a[k];
            if step == 0.0 {
                if a[k] < low || a[k] > high {
                    return None;
                }
                continue;
            }
            let (p, q) = ((low - a[k]) / step, (high - a[k]) / step);
            (from, to) = (from.max(p.min(q)), to.min(p.max(q)));
        }
        let at = |part: f64| [0, 1].map(|k| a[k] + part * (b[k] - a[k]));
        (from <= to).then(|| [if from == 0.0 { *a } else { at(from) }, if to == 1.0 { *b } else { at(to) }])
    };
    let parts: Vec<Segment> = segments.iter().filter_map(|(_, segment)| within(segment)).collect();
    let length = |[a, b]: &Segment| (b[0] - a[0]).hypot(b[1] - a[1]);
    let most = parts.iter().map(length).sum::<f64>() / BOXES;
    let mut boxes = Vec::with_capacity(parts.len());
    for part in &parts {
        let [a, b] = *part;
        // A box along an axis is thin, however long it is.
        let is_straight = a[0] == b[0] || a[1] == b[1];
        let count = if is_straight { 1.0 } else { (length(part) / most).ceil().clamp(1.0, BOXES) };
        for i in 0..count as usize {
            let at = |i: usize| [0, 1].map(|k| a[k] + (i as f64 / count) * (b[k] - a[k]));
            let Extent { min, max } = Extent::of_plan([at(i), if i + 1 == count as usize { b } else { at(i + 1) }]);
            boxes.push(LineBox(Extent { min: min.map(|c| c - margin), max: max.map(|c| c + margin) }));
        }
    }
    boxes
}

#[cold]
fn bends([x, y]: [f64; 2]) -> Error {
    Error::unsupported(format!(
        "the cut is not local: a triangle that is cut has an edge with a point next to it, at {x} {y}, closer than \
         numbers resolve"
    ))
    .cure("move the boundary a little, or build the surface without --tiles")
}

#[cold]
fn contradiction() -> Error {
    Error::format("the triangles at the clip lines are not those of one triangulation")
        .cure("the parts are of different points or lines: compute them again")
}

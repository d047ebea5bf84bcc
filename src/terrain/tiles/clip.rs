//! Clips of a surface that comes triangle by triangle.

use rustc_hash::FxHashMap;

use super::part::TinPart;
use super::sub_constraint::rounding_reach;
use super::triangle::{TileTriangle, TileVertex};
use crate::data::{Bounds, EdgeKind};
use crate::error::{Error, Result};
use crate::terrain::boxes::{Boxed, Boxes, Extent};
use crate::terrain::clip::Clip;
use crate::terrain::cut::{SurfaceCut, divided};
use crate::terrain::regions::{Domain, Segment};
use crate::terrain::{Inside, Tin, TinBuilder};
use crate::triangulation::geometry::Terrain;
use crate::triangulation::{ConstrainedDelaunay, OnCrossing};

/// A line is divided into about as many boxes as this for each surface, so that boxes are small
/// where it is long.
const BOXES: f64 = 65_536.0;

/// What a surface in tiles is cut along: a boundary, bounds, holes, draped lines.
///
/// Triangles that no line comes near are kept or left out whole, each by itself. All others are
/// [cut](Self::cut) together, once they are known, as the whole surface would be: a fragment
/// depends only on lines, and on triangles that lines come near.
///
/// There is one exception. An edge that a line crosses, and that has a vertex within a rounding
/// error of it elsewhere, bends there. So may other edges at that vertex, which no line comes near,
/// and then the triangles beyond them matter. Therefore all triangles at a [tight](Self::tight)
/// vertex are cut with those that lines come near.
#[derive(Debug)]
pub struct TileClip {
    clip: Clip,
    segments: Vec<(Domain, Segment)>,
    near: Boxes<LineBox>,
    /// How far from a line something may matter.
    margin: f64,
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
        let largest = [extent.min, extent.max]
            .as_flattened()
            .iter()
            .fold(0.0_f64, |most, c| most.max(c.abs()));
        let margin = rounding_reach(largest.max(f64::MIN_POSITIVE));
        // Rounding depends on the lines' ends; those far away are left out.
        let reach = [0, 1].map(|k: usize| extent.min[k].abs().max(extent.max[k].abs()));
        let near = Boxes::new(boxes(&divided(&segments, reach), extent, margin));
        let (polygons, holes) = (Inside::new(&clip.polygons), Inside::new(&clip.holes));
        Ok(Some(TileClip {
            clip,
            segments,
            near,
            margin,
            polygons,
            holes,
        }))
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
        let is_within =
            |bounds: &Bounds| (0..2).all(|k| bounds.min[k] < min[k] && min[k] < bounds.max[k]);
        let is_kept = self.clip.bounds.as_ref().is_none_or(is_within)
            && (self.clip.polygons.is_empty() || self.polygons.contains(min))
            && !self.holes.contains(min);
        if is_kept {
            ClipSide::Kept
        } else {
            ClipSide::Outside
        }
    }

    /// Returns the width below which a triangle makes its vertices
    /// [tight](TileVertex::is_tight): several times what rounding may bend.
    pub fn tight(&self) -> f64 {
        8.0 * self.margin
    }

    /// Returns where a triangle lies; near, if a vertex of it is tight.
    pub fn side_of_triangle(&self, triangle: &TileTriangle) -> ClipSide {
        if triangle.corners.iter().any(|corner| corner.is_tight) {
            return ClipSide::Near;
        }
        let Extent { min, max } = Extent::of(triangle.corners.map(|corner| corner.position));
        self.side_of(min, max)
    }

    /// Cuts all triangles that are [near](ClipSide::Near), and returns the triangles and fragments
    /// that are kept, or `None` if `triangles` is empty.
    ///
    /// Each triangle comes with true if it is in the surface before the cut. `reach` is the largest
    /// absolute coordinate of all points on each axis, in the units of the data.
    ///
    /// # Errors
    /// If the triangles are not all those of one triangulation that are near, or if there are too
    /// many.
    ///
    /// # Complexity
    /// O(n log n) for n triangles and segments.
    pub fn cut(
        &self,
        triangles: &[(TileTriangle, bool)],
        reach: [f64; 2],
    ) -> Result<Option<TinPart>> {
        if triangles.is_empty() {
            return Ok(None);
        }
        let uncut = Uncut::new(triangles);
        let (mut part, given) = uncut.triangulated()?;
        self.clip
            .apply_to_part(&mut part.tin, &self.segments, reach)?;
        match part.tin.cut.as_ref() {
            Some(cut) if self.lacks_triangles(cut, &part.tin, &given) => Err(contradiction()),
            Some(_) | None => Ok(Some(part)),
        }
    }

    /// Returns true if an edge was divided of which only one triangle was given, though no line is
    /// near and no end tight. With either, the other triangle would have been given, unless the
    /// edge is at the hull.
    fn lacks_triangles(&self, cut: &SurfaceCut, tin: &Tin, given: &Given) -> bool {
        let tds = tin.triangulation.tds();
        cut.divided_edges().any(|[u, v]| {
            let sides = [tds.edge(u, v), tds.edge(v, u)].into_iter().flatten();
            let is_whole = sides
                .filter(|(cell, _)| given.is_given[cell.index()])
                .count()
                == 2;
            let is_tight = [u, v].iter().any(|end| given.is_tight[end.index()]);
            let Extent { min, max } = Extent::of([u, v].map(|end| *tin.triangulation.point(end)));
            !is_whole && !is_tight && self.side_of(min, max) != ClipSide::Near
        })
    }
}

/// What of a triangulation was given.
struct Given {
    /// For each cell, true for a triangle that was given.
    is_given: Vec<bool>,
    /// For each vertex, true for a [tight](TileVertex::is_tight) one.
    is_tight: Vec<bool>,
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
            let at = *known
                .entry([corner.tile, corner.number])
                .or_insert_with(|| {
                    vertices.push(corner);
                    vertices.len() as u32 - 1
                });
            // Tasks know of different triangles at it.
            vertices[at as usize].is_tight |= corner.is_tight;
            at
        };
        let corners = triangles
            .iter()
            .map(|(triangle, _)| triangle.corners.map(&mut index))
            .collect();
        Uncut {
            triangles,
            vertices,
            corners,
        }
    }

    /// Returns the edges on lines, and those with a triangle on one side only, with their kinds.
    /// Others are edges of the triangulation by themselves.
    fn constraints(&self) -> Vec<([u32; 2], EdgeKind)> {
        // The kind of each edge, and the directions in which triangles pass it.
        let mut edges: FxHashMap<[u32; 2], (EdgeKind, u8)> = FxHashMap::default();
        for (corners, (triangle, _)) in self.corners.iter().zip(self.triangles) {
            for i in 0..3 {
                let [a, b] = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                let (_, directions) = edges
                    .entry([a.min(b), a.max(b)])
                    .or_insert((triangle.edges[i], 0));
                *directions |= if a < b { 1 } else { 2 };
            }
        }
        let is_constraint = |(_, (kind, directions)): &([u32; 2], (EdgeKind, u8))| {
            kind.is_constrained() || *directions != 3
        };
        let mut constraints: Vec<([u32; 2], EdgeKind)> = edges
            .into_iter()
            .filter(is_constraint)
            .map(|(edge, (kind, _))| (edge, kind))
            .collect();
        constraints.sort_unstable_by_key(|(edge, _)| *edge);
        constraints
    }

    /// Triangulates the vertices. The triangles that are in the surface are the faces.
    fn triangulated(&self) -> Result<(TinPart, Given)> {
        let (lines, kinds): (Vec<[u32; 2]>, Vec<EdgeKind>) = self.constraints().into_iter().unzip();
        let points: Vec<[f64; 3]> = self.vertices.iter().map(|vertex| vertex.position).collect();
        let (t, ids) = ConstrainedDelaunay::from_lines(
            Terrain::default(),
            &points,
            &lines,
            OnCrossing::Reject,
        )
        .map_err(|_| contradiction())?;
        let mut inside = vec![false; t.tds().cell_slots()];
        let mut is_given = inside.clone();
        for (corners, (_, is_inside)) in self.corners.iter().zip(self.triangles) {
            let [a, b, c] = corners.map(|corner| ids[corner as usize]);
            match t.tds().edge(a, b) {
                Some((cell, i)) if t.tds().vertex(cell, i) == c => {
                    (is_given[cell.index()], inside[cell.index()]) = (true, *is_inside);
                }
                _ => return Err(contradiction()),
            }
        }
        let mut numbers = vec![[u32::MAX; 2]; t.tds().vertex_slots()];
        let mut is_tight = vec![false; numbers.len()];
        for (id, vertex) in ids.iter().zip(&self.vertices) {
            numbers[id.index()] = [vertex.tile, vertex.number];
            is_tight[id.index()] = vertex.is_tight;
        }
        let numbers = t.tds().vertices().map(|id| numbers[id.index()]).collect();
        let mut part = TinPart::new(t, kinds, Vec::new(), numbers);
        part.take_over(&is_given, inside);
        Ok((part, Given { is_given, is_tight }))
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
        (from <= to).then(|| {
            [
                if from == 0.0 { *a } else { at(from) },
                if to == 1.0 { *b } else { at(to) },
            ]
        })
    };
    let parts: Vec<Segment> = segments
        .iter()
        .filter_map(|(_, segment)| within(segment))
        .collect();
    let length = |[a, b]: &Segment| (b[0] - a[0]).hypot(b[1] - a[1]);
    let most = parts.iter().map(length).sum::<f64>() / BOXES;
    let mut boxes = Vec::with_capacity(parts.len());
    for part in &parts {
        let [a, b] = *part;
        // A box along an axis is thin, however long it is.
        let is_straight = a[0] == b[0] || a[1] == b[1];
        let count = if is_straight {
            1.0
        } else {
            (length(part) / most).ceil().clamp(1.0, BOXES)
        };
        for i in 0..count as usize {
            let at = |i: usize| [0, 1].map(|k| a[k] + (i as f64 / count) * (b[k] - a[k]));
            let Extent { min, max } = Extent::of_plan([
                at(i),
                if i + 1 == count as usize {
                    b
                } else {
                    at(i + 1)
                },
            ]);
            boxes.push(LineBox(Extent {
                min: min.map(|c| c - margin),
                max: max.map(|c| c + margin),
            }));
        }
    }
    boxes
}

#[cold]
fn contradiction() -> Error {
    Error::format("the triangles at the clip lines are not those of one triangulation")
        .cure("the parts are of different points or lines: compute them again")
}

use std::ops::Range;

use crate::crs::Crs;
use crate::data::{Bounds, EdgeKind, Face, Surface};
use crate::triangulation::geometry::{Terrain, height_along};
use crate::triangulation::kernel::RANGE;
use crate::triangulation::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::{ConstrainedDelaunay, Flaw, Level, Location};

use super::TinReport;
use super::cut::Cut;

/// A surface of triangles over points and breaklines: a constrained Delaunay triangulation in plan, and
/// which of its triangles are part of the surface.
#[derive(Debug)]
pub struct Tin {
    pub(super) triangulation: ConstrainedDelaunay<Terrain>,
    /// For each cell number, whether it is part of the surface as a whole.
    pub(super) inside: Vec<bool>,
    /// Pieces of triangles that are part of the surface, if it was cut.
    pub(super) cut: Option<Cut>,
    pub(super) report: TinReport,
    crs: Option<Crs>,
}

impl Tin {
    /// With all finite faces.
    pub(super) fn new(triangulation: ConstrainedDelaunay<Terrain>, crs: Option<Crs>) -> Self {
        let mut tin = Tin { triangulation, inside: Vec::new(), cut: None, report: TinReport::default(), crs };
        tin.include_all();
        tin
    }

    /// Makes every finite face part of the surface.
    pub(super) fn include_all(&mut self) {
        let tds = self.triangulation.tds();
        let is_face = |cell| tds.is_used(cell) && !tds.is_infinite(cell);
        self.inside = (0..tds.cell_slots()).map(|index| is_face(CellId::new(index))).collect();
    }

    /// What went in and what became of it.
    pub fn report(&self) -> &TinReport {
        &self.report
    }

    /// The triangulation beneath, which goes on to the convex hull, and knows of no cut by a boundary or bounds.
    pub fn triangulation(&self) -> &ConstrainedDelaunay<Terrain> {
        &self.triangulation
    }

    /// Checks the triangulation up to the level, with exact predicates; no flaw means that it is a
    /// constrained Delaunay triangulation. The pieces of triangles that were cut are no part of it:
    /// [`surface_flaws`](super::surface_flaws) checks them.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.triangulation.check(level)
    }

    /// The height at a place in plan, linear on the triangle there; `None` outside of the surface, and where a coordinate is
    /// not finite.
    ///
    /// # Complexity
    /// A walk through about as many triangles as lie in a row across the surface.
    pub fn elevation(&self, x: f64, y: f64) -> Option<f64> {
        // Closer to zero than the arithmetic goes is zero; what is beyond its other end is beyond all vertices.
        let [x, y] = [x, y].map(|c| if c.abs() < RANGE.min && !RANGE.admits(c) { 0.0 } else { c });
        let location = self.triangulation.locate(&[x, y, 0.0], None);
        let in_whole = match location {
            Location::Vertex(vertex) => {
                let inside = self.triangulation.tds().around(vertex).any(|cell| self.inside[cell.index()]);
                inside.then(|| self.triangulation.point(vertex)[2])
            }
            Location::Cell { cell, .. } => {
                let beside = location.facets().map(|(cell, i)| self.triangulation.tds().neighbor(cell, i));
                let cell = std::iter::once(cell).chain(beside).find(|cell| self.inside[cell.index()]);
                let corners = |cell| self.triangulation.tds().corners(cell).map(|v| *self.triangulation.point(v));
                cell.map(|cell| linear(corners(cell), [x, y]))
            }
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => None,
        };
        in_whole.or_else(|| self.cut.as_ref()?.elevation([x, y]))
    }

    /// Leaves out the faces that can be reached from outside of the hull over unconstrained edges longer
    /// than `limit`. Returns their number.
    pub(super) fn peel(&mut self, limit: f64) -> usize {
        let tds = self.triangulation.tds();
        let mut peeled = 0;
        let at_hull = tds.corners_around(VertexId::INFINITE).map(|(cell, i)| (tds.neighbor(cell, i), cell));
        let mut exposed: Vec<(CellId, CellId)> = at_hull.collect();
        while let Some((cell, from)) = exposed.pop() {
            let i = tds.index_of_neighbor(cell, from);
            let ends = [ccw(i), cw(i)].map(|k| self.triangulation.point(tds.vertex(cell, k)));
            let length = (ends[0][0] - ends[1][0]).hypot(ends[0][1] - ends[1][1]);
            let open = self.inside[cell.index()] && !self.triangulation.is_constrained(cell, i);
            if !open || length <= limit {
                continue;
            }
            self.inside[cell.index()] = false;
            peeled += 1;
            let onward = [ccw(i), cw(i)].map(|k| tds.neighbor(cell, k));
            exposed.extend(onward.into_iter().filter(|n| self.inside[n.index()]).map(|n| (n, cell)));
        }
        peeled
    }

    /// The triangles that a cut looked at.
    pub(super) fn replaced(&self) -> &[CellId] {
        self.cut.as_ref().map(Cut::replaced).unwrap_or_default()
    }

    /// What the surface consists of.
    pub(super) fn count(&self) -> Count {
        let mut used = vec![false; self.vertex_count()];
        let mut faces = 0;
        for corners in (0..self.face_count() as u32).filter_map(|face| self.face(face)) {
            faces += 1;
            corners.iter().for_each(|&v| used[v as usize] = true);
        }
        let mut count = Count { old_vertices: 0, vertices: 0, faces, extent: Bounds::default() };
        let old = self.triangulation.tds().vertex_slots();
        for vertex in (0..used.len()).filter(|&vertex| used[vertex]) {
            count.vertices += 1;
            count.old_vertices += usize::from(vertex < old);
            count.extent.add(self.position(vertex as u32));
        }
        count
    }

    /// What the edges opposite the corners of a face are.
    ///
    /// `PERF:` without a cut, no more than a look at each neighbor.
    #[inline(always)]
    fn kinds(&self, face: u32) -> [EdgeKind; 3] {
        if self.cut.is_some() {
            return [0, 1, 2].map(|i| self.edge_kind(face, i));
        }
        let cell = CellId::new(face as usize);
        [0, 1, 2].map(|i| {
            if self.triangulation.is_constrained(cell, i) {
                EdgeKind::Breakline
            } else if self.inside[self.triangulation.tds().neighbor(cell, i).index()] {
                EdgeKind::Plain
            } else {
                EdgeKind::Rim
            }
        })
    }

    /// How many edges of the surface are breaklines, and how many lie on clip lines.
    pub(super) fn count_lines(&self) -> (usize, usize) {
        let (mut breaklines, mut clips) = (0, 0);
        let has_lines = |face: &u32| {
            self.cut.is_some() || (0..3).any(|i| self.triangulation.is_constrained(CellId::new(*face as usize), i))
        };
        for face in (0..self.face_count() as u32).filter(has_lines).filter(|&face| self.face(face).is_some()) {
            for (i, kind) in self.kinds(face).into_iter().enumerate() {
                match kind {
                    // From the face with the larger number, if there are two.
                    EdgeKind::Breakline if self.neighbor(face, i).is_none_or(|beside| beside < face) => {
                        breaklines += 1;
                    }
                    EdgeKind::Clip => clips += 1,
                    _ => {}
                }
            }
        }
        (breaklines, clips)
    }
}

/// What a surface consists of.
pub(super) struct Count {
    /// Vertices of the triangulation.
    pub(super) old_vertices: usize,
    /// These and those of the cut.
    pub(super) vertices: usize,
    pub(super) faces: usize,
    pub(super) extent: Bounds,
}

/// Where a triangle is thinner than this part of its longest side, rounding hides where across it a place lies: such
/// are made where lines are led through crossings.
const THINNEST: f64 = 1e-9;

/// The height at `q` of the plane through three points. Exactly that of a corner at a corner.
pub(super) fn linear([a, b, c]: [[f64; 3]; 3], q: [f64; 2]) -> f64 {
    let cross = |p: [f64; 3], r: [f64; 3]| (p[0] - q[0]) * (r[1] - q[1]) - (p[1] - q[1]) * (r[0] - q[0]);
    let (at_a, at_b, at_c) = (cross(b, c), cross(c, a), cross(a, b));
    let area = at_a + at_b + at_c;
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    if area.abs() <= THINNEST * longest {
        return along_sliver([a, b, c], q);
    }
    a[2] + (at_b * (b[2] - a[2]) + at_c * (c[2] - a[2])) / area
}

/// The same of a triangle that is hardly more than a line: along its two shorter sides.
fn along_sliver([a, b, c]: [[f64; 3]; 3], q: [f64; 2]) -> f64 {
    let sides = [(a, b, c), (b, c, a), (c, a, b)];
    let length = |&(p, r, _): &([f64; 3], [f64; 3], [f64; 3])| square(p, r);
    let [from, to, middle] =
        sides.into_iter().max_by(|s, t| length(s).total_cmp(&length(t))).map_or([a, b, c], Into::into);
    let is_before = (q[0] - middle[0]) * (to[0] - from[0]) + (q[1] - middle[1]) * (to[1] - from[1]) <= 0.0;
    if is_before { height_along(from, middle, q) } else { height_along(middle, to, q) }
}

/// The square of a distance in plan.
fn square(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)
}

impl Surface for Tin {
    fn vertex_count(&self) -> usize {
        self.cut.as_ref().map_or(self.triangulation.tds().vertex_slots(), Cut::vertex_count)
    }

    #[inline(always)] // into the loops over many faces
    fn position(&self, vertex: u32) -> [f64; 3] {
        match (self.triangulation.points().get(vertex as usize), &self.cut) {
            (Some(point), _) => *point,
            (None, Some(cut)) => cut.position(vertex),
            (None, None) => panic!("vertex {vertex} of {}", self.triangulation.points().len()),
        }
    }

    fn face_count(&self) -> usize {
        self.cut.as_ref().map_or(self.inside.len(), Cut::face_count)
    }

    #[inline(always)] // into the loops over many faces
    fn face(&self, face: u32) -> Option<[u32; 3]> {
        match self.inside.get(face as usize) {
            Some(inside) => {
                inside.then(|| self.triangulation.tds().corners(CellId::new(face as usize)).map(|v| v.index() as u32))
            }
            None => self.cut.as_ref()?.face(face),
        }
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        if (face as usize) < self.inside.len() {
            let beside = self.triangulation.tds().neighbor(CellId::new(face as usize), i);
            if self.inside[beside.index()] {
                return Some(beside.index() as u32);
            }
        }
        self.cut.as_ref()?.neighbor(face, i)
    }

    #[inline]
    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        if let Some(kind) = self.cut.as_ref().and_then(|cut| cut.edge_kind(face, i)) {
            return kind;
        }
        if self.triangulation.is_constrained(CellId::new(face as usize), i) {
            return EdgeKind::Breakline;
        }
        match self.neighbor(face, i) {
            Some(_) if self.cut.as_ref().is_some_and(|cut| cut.is_breakline(face, i)) => EdgeKind::Breakline,
            Some(_) => EdgeKind::Plain,
            None if self.cut.as_ref().is_some_and(|cut| cut.is_clipped(face, i)) => EdgeKind::Clip,
            None => EdgeKind::Rim,
        }
    }

    fn has_lines(&self) -> bool {
        self.report.breaklines > 0 || self.cut.is_some()
    }

    fn is_fragment(&self, face: u32) -> bool {
        face as usize >= self.inside.len()
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        faces.extend(numbers.filter_map(|number| {
            let corners = self.face(number)?;
            Some(Face { number, corners, edges: self.kinds(number) })
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliver_is_folded_at_its_middle_corner() {
        let [a, b, c] = [[0.0, 0.0, 1.0], [1.0, 3.0, 7.0], [0.5, 1.5 + 1e-13, 6.0]];
        for corners in [[a, b, c], [c, b, a], [b, c, a]] {
            for (y, z) in [(0.0, 1.0), (0.75, 3.5), (1.5, 6.0), (2.25, 6.5), (3.0, 7.0)] {
                assert!((linear(corners, [y / 3.0, y]) - z).abs() < 1e-9, "{corners:?} at {y}");
            }
        }
        assert_eq!([a, b, c].map(|p| linear([a, b, c], [p[0], p[1]])), [1.0, 7.0, 6.0]);
    }
}

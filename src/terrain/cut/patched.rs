//! A triangulation with a patch in place of some of its triangles.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::data::EdgeKind;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};

use super::patch::Patch;
use crate::terrain::lines::kinds::LineKinds;
use crate::terrain::regions::{Domain, Faces, Segment};

/// Stands for the domain of lines that are draped over the surface: they bound nothing.
pub(crate) const DRAPED: Domain = Domain::MAX;

/// A side of a face: the number of the face, and the index of the opposite corner.
type FaceSide = (u32, usize);

/// The finite faces of a triangulation, of which some are replaced by those of a patch.
///
/// Faces are numbered: first those of the triangulation, then those of the patch.
pub(super) struct Patched<'a> {
    base: &'a ConstrainedDelaunay<Terrain>,
    kinds: &'a LineKinds,
    patch: &'a Patch,
    /// For each triangle: true if the patch replaces it.
    is_replaced: Vec<bool>,
    /// For each cut line of the patch, the domains that it bounds, each as often as it was given.
    domains: Vec<Vec<Domain>>,
    /// The sides between patch and triangles that are not replaced, from both of their faces.
    border: FxHashMap<FaceSide, FaceSide>,
}

/// What a cut leaves of a patched triangulation.
#[derive(Debug)]
pub(super) struct Remains {
    /// For each face of the patch: true if it is part of the surface as a fragment.
    pub(super) is_fragment: Vec<bool>,
    /// The kinds of the sides of the fragments.
    pub(super) kinds: Vec<[EdgeKind; 3]>,
    /// The face across each side between a fragment and a whole triangle, from both of them.
    pub(super) beside: FxHashMap<FaceSide, u32>,
    /// The sides of whole triangles along which a neighboring fragment has a line, with its kind.
    /// It may be an edge other than their own that rounding has moved here.
    pub(super) lines: FxHashMap<FaceSide, EdgeKind>,
    /// The sides of triangles along which a clip line runs.
    pub(super) clipped: FxHashSet<FaceSide>,
    /// The sides of triangles along which a draped line runs.
    pub(super) draped: FxHashSet<FaceSide>,
    /// The number of triangles of which there are fragments.
    pub(super) cut: usize,
}

impl<'a> Patched<'a> {
    pub(super) fn new(
        base: &'a ConstrainedDelaunay<Terrain>,
        kinds: &'a LineKinds,
        patch: &'a Patch,
        curves: &[(Domain, Segment)],
    ) -> Self {
        let mut is_replaced = vec![false; base.tds().cell_slots()];
        patch
            .replaced
            .iter()
            .for_each(|cell| is_replaced[cell.index()] = true);
        let mut domains = vec![Vec::new(); patch.first_edge()];
        for (line, (domain, _)) in patch.segments.iter().zip(curves) {
            if let Some(line) = line {
                domains[line.index()].push(*domain);
            }
        }
        let mut patched = Patched {
            base,
            kinds,
            patch,
            is_replaced,
            domains,
            border: FxHashMap::default(),
        };
        for edge in 0..patch.edges.len() {
            let [u, v] = patch.edges[edge];
            let (Some(left), Some(right)) = (base.tds().edge(u, v), base.tds().edge(v, u)) else {
                continue;
            };
            if [left, right]
                .iter()
                .any(|(cell, _)| base.tds().is_infinite(*cell))
            {
                continue;
            }
            let [p, q] = patch.chain_of_edge(edge)[..] else {
                continue;
            };
            for ((cell, i), [p, q]) in [left, right].into_iter().zip([[q, p], [p, q]]) {
                if let Some((face, k)) = patch
                    .triangulation
                    .tds()
                    .edge(p, q)
                    .filter(|_| !patched.is_replaced[cell.index()])
                {
                    let [outer, inner] = [(cell.index() as u32, i), (patched.number(face), k)];
                    patched.border.extend([(outer, inner), (inner, outer)]);
                }
            }
        }
        patched
    }

    pub(super) fn count(&self) -> usize {
        self.first_fragment() + self.patch.cells.len()
    }

    fn first_fragment(&self) -> usize {
        self.base.tds().cell_slots()
    }

    fn number(&self, face: CellId) -> u32 {
        (self.first_fragment() + face.index()) as u32
    }

    /// The face of the patch with a number; `None` for faces of the triangulation.
    fn fragment(&self, face: u32) -> Option<CellId> {
        (face as usize)
            .checked_sub(self.first_fragment())
            .map(CellId::new)
    }

    /// A finite face, if there is one.
    pub(super) fn first(&self) -> Option<u32> {
        let whole = self
            .base
            .finite_cells()
            .find(|cell| !self.is_replaced[cell.index()]);
        let fragment = || {
            self.patch
                .cells
                .iter()
                .position(Option::is_some)
                .map(|at| self.number(CellId::new(at)))
        };
        whole.map(|cell| cell.index() as u32).or_else(fragment)
    }

    /// The corners of a face, counter-clockwise.
    pub(super) fn corners(&self, face: u32) -> [[f64; 3]; 3] {
        match self.fragment(face) {
            Some(fragment) => self
                .patch
                .triangulation
                .tds()
                .corners(fragment)
                .map(|v| *self.patch.triangulation.point(v)),
            None => self
                .base
                .tds()
                .corners(CellId::new(face as usize))
                .map(|v| *self.base.point(v)),
        }
    }

    /// The curves along the edges of the patch.
    pub(super) fn drawn(&self, curves: &[(Domain, Segment)]) -> Vec<(Domain, Segment)> {
        let mut drawn = Vec::with_capacity(curves.len());
        for (line, &(domain, segment)) in self.patch.segments.iter().zip(curves) {
            let Some(line) = line else {
                drawn.push((domain, segment));
                continue;
            };
            let site = |v: VertexId| {
                let [x, y, _] = *self.patch.triangulation.point(v);
                [x, y]
            };
            let chain = self.patch.triangulation.chain(*line);
            drawn.extend(
                chain
                    .windows(2)
                    .map(|pair| (domain, [site(pair[0]), site(pair[1])])),
            );
        }
        drawn
    }

    /// The fragments of the triangles `inside`, given the faces that are kept. On return, `inside`
    /// contains the triangles that stay whole.
    pub(super) fn remains(&self, inside: &mut [bool], kept: &[bool]) -> Remains {
        let was_inside: Vec<(CellId, bool)> = self
            .patch
            .replaced
            .iter()
            .map(|&cell| (cell, inside[cell.index()]))
            .collect();
        let whole = self.whole(inside, kept);
        for (cell, inside) in inside.iter_mut().enumerate() {
            *inside &= if self.is_replaced[cell] {
                whole.contains(&CellId::new(cell))
            } else {
                kept[cell]
            };
        }
        let in_fragments: FxHashSet<CellId> = was_inside
            .into_iter()
            .filter(|(cell, was)| *was && !whole.contains(cell))
            .map(|(cell, _)| cell)
            .collect();
        let is_fragment: Vec<bool> = (0..self.patch.cells.len())
            .map(|face| {
                kept[self.first_fragment() + face]
                    && self.patch.cells[face].is_some_and(|cell| in_fragments.contains(&cell))
            })
            .collect();
        let mut remains = Remains {
            kinds: vec![[EdgeKind::Plain; 3]; is_fragment.len()],
            beside: FxHashMap::default(),
            lines: FxHashMap::default(),
            clipped: self.sides_along(|domain| domain != DRAPED),
            draped: self.sides_along(|domain| domain == DRAPED),
            cut: 0,
            is_fragment,
        };
        let mut cut: Vec<CellId> = Vec::new();
        for face in (0..remains.is_fragment.len())
            .filter(|&face| remains.is_fragment[face])
            .map(CellId::new)
        {
            cut.extend(self.patch.cells[face.index()]);
            for i in 0..3 {
                let beyond = self.patch.triangulation.tds().neighbor(face, i);
                let whole = self
                    .whole_beside(face, i, beyond)
                    .filter(|(cell, _)| inside[*cell as usize]);
                if let Some(side) = whole {
                    remains
                        .beside
                        .extend([((self.number(face), i), side.0), (side, self.number(face))]);
                }
                let is_rim = whole.is_none() && !remains.is_fragment[beyond.index()];
                let kind = self.kind(face, i, is_rim);
                remains.lines.extend(
                    whole
                        .filter(|_| kind.is_constrained())
                        .map(|side| (side, kind)),
                );
                remains.kinds[face.index()][i] = kind;
            }
        }
        cut.sort_unstable();
        cut.dedup();
        remains.cut = cut.len();
        remains
    }

    /// The replaced triangles that stay whole: those of which all fragments are kept, unless a
    /// draped line crosses them, or a neighbor needs a vertex that one of their sides has in the
    /// patch.
    fn whole(&self, inside: &[bool], kept: &[bool]) -> FxHashSet<CellId> {
        let mut faces: FxHashMap<CellId, [usize; 2]> = FxHashMap::default();
        for (face, cell) in self.patch.cells.iter().enumerate() {
            if let Some(cell) = cell {
                let [all, left] = faces.entry(*cell).or_default();
                *all += 1;
                *left += usize::from(kept[self.first_fragment() + face]);
            }
        }
        let crossed = self.crossed();
        let is_whole = |cell: &CellId| {
            inside[cell.index()]
                && !crossed.contains(cell)
                && faces.get(cell).is_some_and(|[all, left]| all == left)
        };
        let mut whole: FxHashSet<CellId> = self
            .patch
            .replaced
            .iter()
            .copied()
            .filter(is_whole)
            .collect();
        // If a triangle has collapsed, the neighbor beyond it is not known here.
        let is_gone = |cell: CellId| {
            self.base.tds().is_infinite(cell)
                || !inside[cell.index()]
                || faces.get(&cell).is_some_and(|[_, left]| *left == 0)
        };
        let mut divided: FxHashMap<CellId, Vec<CellId>> = FxHashMap::default();
        for edge in
            (0..self.patch.edges.len()).filter(|&edge| self.patch.chain_of_edge(edge).len() > 2)
        {
            let [u, v] = self.patch.edges[edge];
            if let (Some((left, _)), Some((right, _))) =
                (self.base.tds().edge(u, v), self.base.tds().edge(v, u))
            {
                divided.entry(left).or_default().push(right);
                divided.entry(right).or_default().push(left);
            }
        }
        let mut unsure: Vec<CellId> = whole.iter().copied().collect();
        while let Some(cell) = unsure.pop() {
            let beside = divided.get(&cell).map(Vec::as_slice).unwrap_or_default();
            let fits = |beside: &CellId| whole.contains(beside) || is_gone(*beside);
            if !beside.iter().all(fits) && whole.remove(&cell) {
                unsure.extend(beside.iter().filter(|beside| whole.contains(beside)));
            }
        }
        whole
    }

    /// The replaced triangles whose interior a draped line crosses.
    fn crossed(&self) -> FxHashSet<CellId> {
        let tds = self.patch.triangulation.tds();
        let mut crossed = FxHashSet::default();
        if !self
            .domains
            .iter()
            .flatten()
            .any(|domain| *domain == DRAPED)
        {
            return crossed;
        }
        for (face, cell) in self.patch.cells.iter().enumerate() {
            let (Some(cell), face) = (cell, CellId::new(face)) else {
                continue;
            };
            let is_within =
                |i: &usize| self.patch.cells[tds.neighbor(face, *i).index()] == Some(*cell);
            let sides = 0..3;
            if sides
                .into_iter()
                .filter(is_within)
                .any(|i| self.runs_along(tds.edge_ends(face, i), |d| d == DRAPED))
            {
                crossed.insert(*cell);
            }
        }
        crossed
    }

    /// Returns true if a cut line of some domain runs along an edge of the patch.
    fn runs_along(&self, [p, q]: [VertexId; 2], is_wanted: impl Fn(Domain) -> bool) -> bool {
        let lines = self.patch.triangulation.lines_through(p, q);
        lines
            .filter_map(|line| self.domains.get(line.index()))
            .flatten()
            .any(|&domain| is_wanted(domain))
    }

    /// The sides of triangles along which a cut line of some domain runs.
    fn sides_along(&self, is_wanted: impl Fn(Domain) -> bool) -> FxHashSet<FaceSide> {
        let mut found = FxHashSet::default();
        for (edge, &[u, v]) in self.patch.edges.iter().enumerate() {
            let chain = self.patch.chain_of_edge(edge);
            if chain
                .windows(2)
                .any(|pair| self.runs_along([pair[0], pair[1]], &is_wanted))
            {
                let sides = [self.base.tds().edge(u, v), self.base.tds().edge(v, u)];
                found.extend(
                    sides
                        .into_iter()
                        .flatten()
                        .map(|(cell, i)| (cell.index() as u32, i)),
                );
            }
        }
        found
    }

    /// The triangle across a side of a face of the patch, and its side, if the two sides share both
    /// ends.
    fn whole_beside(&self, face: CellId, i: usize, beyond: CellId) -> Option<FaceSide> {
        let Some(cell) = self.patch.cells[beyond.index()] else {
            return self.border.get(&(self.number(face), i)).copied();
        };
        let ends = self
            .patch
            .triangulation
            .tds()
            .edge_ends(face, i)
            .map(|v| self.patch.vertices[v.index()]);
        let sides = 0..3;
        let is_same = |&k: &usize| {
            let [u, v] = self.base.tds().edge_ends(cell, k);
            ends == [Some(v), Some(u)]
        };
        sides
            .into_iter()
            .find(is_same)
            .map(|k| (cell.index() as u32, k))
    }

    fn kind(&self, face: CellId, i: usize, is_rim: bool) -> EdgeKind {
        if self.patch.triangulation.is_constrained(face, i) {
            let ends = self.patch.triangulation.tds().edge_ends(face, i);
            let on_lines = self.patch.edges_along(ends);
            let kinds =
                on_lines.filter_map(|edge| self.kinds.between(self.base, self.patch.edges[edge]));
            if let Some(kind) = kinds.min_by_key(|kind| kind.rank()) {
                return kind;
            }
            if self.runs_along(ends, |domain| domain == DRAPED) {
                return EdgeKind::Draped;
            }
            if is_rim && self.patch.is_cut_along(ends) {
                return EdgeKind::Clip;
            }
        }
        if is_rim {
            EdgeKind::Rim
        } else {
            EdgeKind::Plain
        }
    }
}

impl Faces for Patched<'_> {
    fn beyond(&self, face: u32, side: usize, domains: &mut Vec<Domain>) -> Option<u32> {
        let tds = self.patch.triangulation.tds();
        let across_border = self.border.get(&(face, side)).copied();
        // The side as one of a fragment, on either side of it, and the face across it.
        let (fragment, i, beyond) = match (self.fragment(face), across_border) {
            (Some(fragment), Some((beyond, _))) => (fragment, side, beyond),
            (Some(fragment), None) => {
                let beyond = tds.neighbor(fragment, side);
                self.patch.cells[beyond.index()]?;
                (fragment, side, self.number(beyond))
            }
            (None, Some((beyond, i))) => (self.fragment(beyond)?, i, beyond),
            (None, None) => {
                let beyond = self.base.tds().neighbor(CellId::new(face as usize), side);
                let is_there =
                    !self.base.tds().is_infinite(beyond) && !self.is_replaced[beyond.index()];
                return is_there.then_some(beyond.index() as u32);
            }
        };
        if self.patch.triangulation.is_constrained(fragment, i) {
            let [p, q] = tds.edge_ends(fragment, i);
            let lines = self.patch.triangulation.lines_through(p, q);
            let of_lines = lines
                .filter_map(|line| self.domains.get(line.index()))
                .flatten();
            domains.extend(of_lines.filter(|domain| **domain != DRAPED));
        }
        Some(beyond)
    }
}

//! Waters end where the surface would end without them.
//!
//! A lake or a river has no heights of its own that say where the ground is: beyond all points it
//! would be joined to them by a star of triangles that nobody measured. So it is cut at the rim of
//! the points and of the lines with heights, taken as points, before it is triangulated: the lines
//! of waters are divided there, and what is left of a water gets a new border.

use rustc_hash::FxHashMap;

use super::{EndedWaters, Overlaps, TinBuilder};
use crate::data::EdgeKind;
use crate::terrain::densified;
use crate::terrain::lines::RiverWater;
use crate::terrain::lines::areas::{Water, WaterLevel};
use crate::terrain::lines::divided::{Divided, Labels};
use crate::terrain::point_rim::PointRim;
use crate::terrain::regions::Domain;
use crate::triangulation::geometry::{Terrain, height_along};
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, LineId, OnCrossing};

impl TinBuilder {
    /// Cuts all waters at the rim of the points that were added, replaced ones included.
    pub(super) fn end_waters_at_points(&mut self) {
        if self.ended.is_none() && !self.waters.is_empty() {
            let points = [self.points.as_slice(), &self.replaced_points].concat();
            self.end_waters(points, self.max_edge);
        }
    }

    /// Cuts all waters at the rim that these points and the lines with heights have, if they are
    /// not cut yet; `limit` is the longest edge there. Without points, or if these have no surface,
    /// nothing is cut.
    pub(crate) fn end_waters(&mut self, points: Vec<[f64; 3]>, limit: Option<f64>) {
        if self.ended.is_some() || self.waters.is_empty() || points.is_empty() {
            return;
        }
        let mut ended = EndedWaters::default();
        let rim = PointRim::new(&self.with_line_vertices(points, limit), limit);
        if let (Some(bounds), Some(window)) = (&self.bounds, &self.window) {
            ended.uncertain = match &rim {
                Some(rim) => rim.uncertain(bounds, window, limit),
                None => usize::from(window.is_partial()),
            };
        }
        if let Some(cut) = rim.and_then(|rim| WaterCut::new(self, &rim.edges())) {
            ended.first_lines = self.cut_waters(&cut);
        }
        self.ended = Some(ended);
    }

    /// Adds the vertices of lines with heights to points, and others between them, so that no edge
    /// on a line is long.
    fn with_line_vertices(&self, mut points: Vec<[f64; 3]>, limit: Option<f64>) -> Vec<[f64; 3]> {
        let spacing = limit.map_or(f64::INFINITY, |limit| limit / 2.0);
        for line in 0..self.line_count() {
            match self.line_kinds[line] {
                EdgeKind::Breakline | EdgeKind::Soft | EdgeKind::Wall => {
                    points.extend(densified(self.line(line), spacing));
                }
                _ => {}
            }
        }
        points
    }

    /// Gives waters what a cut leaves of them. Returns the first line of each that is smaller now,
    /// within what is judged.
    fn cut_waters(&mut self, cut: &WaterCut) -> Vec<usize> {
        let areas = cut.areas_beyond();
        if areas.is_empty() {
            return Vec::new();
        }
        let judged = self.bounds.or(self.judged);
        let is_judged = |[x, y, _]: &[f64; 3]| judged.is_none_or(|bounds| bounds.holds(*x, *y));
        let rims = cut.rims_of(&areas, self);
        let (mut replaced, mut added, mut shortened) = (Vec::new(), Vec::new(), Vec::new());
        for (id, &number) in cut.lines.iter().enumerate() {
            let Parts { kept, left_out } = cut.parts(LineId::new(id), self.line(number));
            if left_out.is_empty() {
                continue;
            }
            // In ascending order, as the lines of waters are in the cut.
            if left_out.iter().any(is_judged) {
                shortened.push(number);
            }
            let mut kept = kept.into_iter();
            replaced.push((number, kept.next().unwrap_or_default()));
            added.extend(kept.map(|part| (number, part)));
        }
        self.replace_lines(replaced);
        for (number, part) in added {
            self.add_line_named(number, &part, self.line_kinds[number]);
        }
        let mut ended = Vec::new();
        for (area, rings) in areas.into_iter().zip(rims) {
            let first = self.waters[area].lines.start;
            let kind = self.waters[area].kind();
            self.waters[area].rim = rings
                .iter()
                .map(|ring| self.add_line_named(first, ring, kind))
                .collect();
            let after = shortened.partition_point(|&line| line < first);
            if shortened
                .get(after)
                .is_some_and(|line| self.waters[area].lines.contains(line))
            {
                ended.push(first);
            }
        }
        ended
    }

    /// Adds a line that errors call like another one; returns its number.
    fn add_line_named(&mut self, number: usize, line: &[[f64; 3]], kind: EdgeKind) -> usize {
        let given = self.line_count();
        let overlaps = self.overlaps.get_or_insert_with(|| Overlaps {
            given,
            ..Overlaps::default()
        });
        let named = overlaps.named(number);
        overlaps.named.push(named);
        self.add_line(line, kind);
        given
    }
}

impl Water {
    /// The kind of the edges around it.
    fn kind(&self) -> EdgeKind {
        match self.level {
            WaterLevel::Flat(_) => EdgeKind::Shore,
            WaterLevel::River(_) => EdgeKind::Bank,
        }
    }
}

/// What a cut leaves of a line.
struct Parts {
    kept: Vec<Vec<[f64; 3]>>,
    /// The vertices of what is left out.
    left_out: Vec<[f64; 3]>,
}

/// The lines of waters together with the rim: a triangulation of their own.
struct WaterCut {
    triangulation: ConstrainedDelaunay<Terrain>,
    /// The numbers that lines of waters have in the builder, by their ids here.
    lines: Vec<usize>,
    /// Their ids here, by these numbers.
    id_of: FxHashMap<usize, LineId>,
    labels: Labels,
    /// For each label, true if it is within the rim.
    is_within: Vec<bool>,
}

impl WaterCut {
    /// Triangulates all lines of waters with the edges of the rim. `None` if a vertex is not
    /// admitted: what is built then is an error.
    fn new(builder: &TinBuilder, rim: &[[[f64; 2]; 2]]) -> Option<Self> {
        let added = builder
            .overlaps
            .as_ref()
            .map_or(0..0, |overlaps| overlaps.given..builder.line_count());
        let lines: Vec<usize> = builder
            .waters
            .iter()
            .flat_map(|water| water.lines.clone())
            .chain(added)
            .collect();
        let id_of: FxHashMap<usize, LineId> = (lines.iter().copied())
            .zip((0..).map(LineId::new))
            .collect();
        let mut points: Vec<[f64; 3]> = Vec::new();
        let mut chains: Vec<Vec<u32>> = Vec::new();
        let mut add = |line: &mut dyn Iterator<Item = [f64; 3]>| {
            let first = points.len() as u32;
            points.extend(line);
            chains.push((first..points.len() as u32).collect());
        };
        for &line in &lines {
            add(&mut builder.line(line).iter().copied());
        }
        for edge in rim {
            add(&mut edge.iter().map(|&[x, y]| [x, y, 0.0]));
        }
        let geometry = Terrain::default();
        let (triangulation, _) =
            ConstrainedDelaunay::from_lines(geometry, &points, &chains, OnCrossing::Split).ok()?;
        let within = builder.waters.len();
        let around_waters = builder.waters.iter().enumerate().flat_map(|(area, water)| {
            let ids = water.rim.iter().filter_map(|line| id_of.get(line));
            ids.map(move |&id| (area, id))
        });
        let around_all = (lines.len()..chains.len()).map(|id| (within, LineId::new(id)));
        let labels = Divided::by_rims(&triangulation, around_waters.chain(around_all)).labels()?;
        let is_within = labels
            .areas
            .iter()
            .map(|areas| areas.contains(&within))
            .collect();
        Some(WaterCut {
            triangulation,
            lines,
            id_of,
            labels,
            is_within,
        })
    }

    /// Returns the waters that reach beyond the rim, in order.
    fn areas_beyond(&self) -> Vec<Domain> {
        let labels = self.labels.areas.iter().zip(&self.is_within);
        let mut beyond: Vec<Domain> = labels
            .filter(|(_, is_within)| !**is_within)
            .flat_map(|(areas, _)| areas.iter().copied())
            .collect();
        beyond.sort_unstable();
        beyond.dedup();
        beyond
    }

    fn label(&self, cell: CellId) -> usize {
        self.labels.of_cells[cell.index()] as usize
    }

    /// Returns true if a cell is within the rim.
    fn is_within(&self, cell: CellId) -> bool {
        self.is_within[self.label(cell)]
    }

    /// Returns the areas that a cell is in, within the rim.
    fn areas_of(&self, cell: CellId) -> &[Domain] {
        if self.is_within(cell) {
            &self.labels.areas[self.label(cell)]
        } else {
            &[]
        }
    }

    fn site(&self, vertex: VertexId) -> [f64; 2] {
        let [x, y, _] = *self.triangulation.point(vertex);
        [x, y]
    }

    /// Returns the vertices of a line here, with its heights; none is repeated at once.
    fn chain(&self, line: LineId, given: &[[f64; 3]]) -> Vec<(VertexId, [f64; 3])> {
        let vertices = self.triangulation.line_vertices(line);
        let mut chain: Vec<(VertexId, [f64; 3])> = Vec::new();
        chain.extend(vertices.first().copied().zip(given.first().copied()));
        for (ends, [p, q]) in vertices
            .windows(2)
            .zip(given.windows(2).map(|pair| [pair[0], pair[1]]))
        {
            if ends[0] == ends[1] {
                continue;
            }
            for vertex in self.triangulation.segment_chain(ends[0], ends[1]) {
                let [x, y] = self.site(vertex);
                chain.push((vertex, [x, y, height_along(p, q, [x, y])]));
            }
            chain.push((ends[1], q));
        }
        chain
    }

    /// Divides a line into what is within the rim, or on it, and what is not.
    fn parts(&self, line: LineId, given: &[[f64; 3]]) -> Parts {
        let tds = self.triangulation.tds();
        let mut parts = Parts {
            kept: Vec::new(),
            left_out: Vec::new(),
        };
        let mut was_kept = false;
        for pair in self.chain(line, given).windows(2) {
            let [(u, p), (v, q)] = [pair[0], pair[1]];
            let is_kept = tds.edge(u, v).is_some_and(|(cell, i)| {
                self.is_within(cell) || self.is_within(tds.neighbor(cell, i))
            });
            match (is_kept, parts.kept.last_mut().filter(|_| was_kept)) {
                (true, Some(part)) => part.push(q),
                (true, None) => parts.kept.push(vec![p, q]),
                (false, _) => parts.left_out.extend([p, q]),
            }
            was_kept = is_kept;
        }
        parts
    }

    /// Returns, for each of some waters in ascending order, the rings around what is left of it,
    /// with its heights.
    ///
    /// # Complexity
    /// O(n log n) in the number of cells, counted once for each water that they are in.
    fn rims_of(&self, areas: &[Domain], builder: &TinBuilder) -> Vec<Vec<Vec<[f64; 3]>>> {
        let tds = self.triangulation.tds();
        let mut borders: Vec<Vec<[VertexId; 2]>> = vec![Vec::new(); areas.len()];
        for cell in tds.cells() {
            for area in self.areas_of(cell) {
                // `within`, the rim itself, is none of the waters.
                let Ok(at) = areas.binary_search(area) else {
                    continue;
                };
                let is_beyond = |i: &usize| !self.areas_of(tds.neighbor(cell, *i)).contains(area);
                borders[at].extend((0..3).filter(is_beyond).map(|i| tds.edge_ends(cell, i)));
            }
        }
        let rings = |(&area, border): (&Domain, Vec<[VertexId; 2]>)| {
            let height = self.heights(area, builder);
            let vertex = |vertex: VertexId| {
                let [x, y] = self.site(vertex);
                [x, y, height(vertex)]
            };
            rings_of(border)
                .into_iter()
                .map(|ring| ring.into_iter().map(vertex).collect())
                .collect()
        };
        areas.iter().zip(borders).map(rings).collect()
    }

    /// Returns the height that a water has at vertices: on the lines around it, the lowest of
    /// theirs.
    fn heights<'a>(
        &'a self,
        area: Domain,
        builder: &TinBuilder,
    ) -> Box<dyn Fn(VertexId) -> f64 + 'a> {
        let river = match &builder.waters[area].level {
            WaterLevel::Flat(flat) => {
                let height = flat.height();
                return Box::new(move |_| height);
            }
            WaterLevel::River(river) => RiverWater::new(river),
        };
        let mut own: FxHashMap<VertexId, f64> = FxHashMap::default();
        for &number in &builder.waters[area].rim {
            let Some(&id) = self.id_of.get(&number) else {
                continue;
            };
            for (vertex, [_, _, z]) in self.chain(id, builder.line(number)) {
                let lowest = own.entry(vertex).or_insert(z);
                *lowest = lowest.min(z);
            }
        }
        Box::new(move |vertex| match own.get(&vertex) {
            Some(height) => *height,
            None => river.height(self.site(vertex)),
        })
    }
}

/// Joins the edges of a border to rings.
fn rings_of(border: Vec<[VertexId; 2]>) -> Vec<Vec<VertexId>> {
    let mut onward: FxHashMap<VertexId, Vec<VertexId>> = FxHashMap::default();
    for &[from, to] in &border {
        onward.entry(from).or_default().push(to);
    }
    onward.values_mut().for_each(|next| next.sort_unstable());
    let mut starts: Vec<VertexId> = border.into_iter().map(|[from, _]| from).collect();
    starts.sort_unstable();
    let mut rings = Vec::new();
    for start in starts {
        let mut ring = vec![start];
        let mut here = start;
        while let Some(next) = onward.get_mut(&here).and_then(Vec::pop) {
            ring.push(next);
            here = next;
        }
        if ring.len() > 1 {
            rings.push(ring);
        }
    }
    rings
}

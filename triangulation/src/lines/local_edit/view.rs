//! Segments and sites as an edit sees them: with its changes, before they are carried out.

use crate::arrangement::{crosses, is_aligned};
use crate::geometry::Crossing;
use crate::lines::chains::{Ends, undirected};
use crate::lines::mesh::position;
use crate::lines::near_segment::{Band, Nearby, near};
use crate::tds::{CellId, VertexId};

use super::{Edit, REACH, lies_on};

/// A list of at most this many sites is searched one by one, which is faster than by halves.
const SHORT: usize = 64;

impl<G: Crossing, V: Default, C: Copy + Default> Edit<'_, G, V, C> {
    pub(super) fn ends(&self, segment: Ends) -> [[f64; 2]; 2] {
        segment.map(|v| position(self.t, v))
    }

    /// Returns what lies within a number of units around a segment.
    pub(super) fn near_segment(&mut self, segment: Ends, reach: f64) -> Nearby {
        let band = Band::around(
            self.ends(segment),
            self.rounder.unit().map(|unit| reach * unit),
        );
        near(self.t, &band, segment[0])
    }

    /// Returns all vertices whose pixels a segment meets, in no particular order.
    pub(super) fn attractors(&mut self, segment: Ends) -> Vec<VertexId> {
        let mut vertices = if Some(segment) == self.added {
            self.near_added.clone()
        } else {
            self.near_segment(segment, REACH).vertices
        };
        vertices.retain(|&v| self.meets_pixel(segment, v));
        vertices
    }

    /// Returns the segments that meet the pixel of a vertex and do not end there, with the one that
    /// is inserted and without the one that is removed.
    pub(super) fn around(&mut self, vertex: VertexId) -> Vec<Ends> {
        if let Some(segments) = self.around.get(&vertex) {
            return segments.clone();
        }
        let edges = self.near_segment([vertex; 2], REACH).edges;
        let mut segments = self.segments_on(edges.into_iter().map(|(edge, _)| edge));
        segments.extend(self.added);
        segments.retain(|&segment| self.meets_pixel(segment, vertex));
        self.around.insert(vertex, segments.clone());
        segments
    }

    /// Determines the segments around a site at which the inserted segment crosses another one.
    pub(super) fn look_around_crossing(&mut self, site: VertexId) {
        if !self.around.contains_key(&site) {
            let at = position(self.t, site);
            let beside = self.beside_added.iter().copied();
            let all = beside.chain(self.added.map(|segment| (segment, self.ends(segment))));
            let met = all
                .filter(|&(segment, ends)| !segment.contains(&site) && self.rounder.hits(ends, at));
            let segments = met.map(|(segment, _)| segment).collect();
            self.around.insert(site, segments);
        }
    }

    /// Returns the segments that end at a vertex or run through it, without the one that is
    /// inserted or removed.
    pub(super) fn lines_at(&self, vertex: VertexId) -> Vec<Ends> {
        self.segments_on(
            self.t
                .constrained_around(vertex)
                .map(|other| undirected(vertex, other)),
        )
    }

    /// Returns the segments on edges, each once, in order, with what was given of one of its edges.
    pub(super) fn segments_on_each(&self, edges: Vec<(Ends, CellId)>) -> Vec<(Ends, CellId)> {
        let index = self.lines.index();
        let on_edge = |(edge, cell)| {
            index
                .segments_on(&self.lines.chains, edge)
                .map(move |segment| (segment, cell))
        };
        let mut segments: Vec<(Ends, CellId)> = edges.into_iter().flat_map(on_edge).collect();
        segments
            .retain(|&(segment, _)| Some(segment) != self.added && Some(segment) != self.removed);
        segments.sort_unstable();
        segments.dedup_by_key(|(segment, _)| *segment);
        segments
    }

    pub(super) fn segments_on(&self, edges: impl IntoIterator<Item = Ends>) -> Vec<Ends> {
        let index = self.lines.index();
        let segments = edges
            .into_iter()
            .flat_map(|edge| index.segments_on(&self.lines.chains, edge));
        let mut segments: Vec<Ends> = segments
            .filter(|&segment| Some(segment) != self.added && Some(segment) != self.removed)
            .collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    }

    pub(super) fn is_bent(&self, segment: Ends) -> bool {
        self.chains.get(&segment).map_or_else(
            || self.lines.chains.bent.contains_key(&segment),
            Option::is_some,
        )
    }

    /// Returns true if a segment bends to a vertex between its ends.
    pub(super) fn has_site(&self, segment: Ends, vertex: VertexId) -> bool {
        if let Some(chain) = self.chains.get(&segment) {
            return chain.as_ref().is_some_and(|sites| sites.contains(&vertex));
        }
        let Some(sites) = self.lines.chains.bent.get(&segment) else {
            return false;
        };
        if sites.len() <= SHORT {
            return sites.contains(&vertex);
        }
        sites.get(self.position_along(segment, sites, position(self.t, vertex))) == Some(&vertex)
    }

    /// Returns the current sites of a segment.
    pub(super) fn sites(&self, segment: Ends) -> Vec<VertexId> {
        let in_table = || {
            self.lines
                .chains
                .bent
                .get(&segment)
                .map(|sites| sites.to_vec())
        };
        self.chains
            .get(&segment)
            .cloned()
            .unwrap_or_else(in_table)
            .unwrap_or_default()
    }

    /// Returns how many of a segment's sites come before a site that is near the segment.
    pub(super) fn position_along(&self, segment: Ends, sites: &[VertexId], at: [f64; 2]) -> usize {
        let key = self.order_along(segment);
        let limit = key(at);
        sites.partition_point(|&site| key(position(self.t, site)) < limit)
    }

    /// Returns keys that sort the sites of a segment from its first end to its second.
    pub(super) fn order_along(
        &self,
        segment: Ends,
    ) -> impl Fn([f64; 2]) -> [f64; 2] + use<G, V, C> {
        let ends = self.ends(segment);
        let sign = if ends[0] <= ends[1] { 1.0 } else { -1.0 };
        let key = self.rounder.along(ends);
        move |at| key(at).map(|x| sign * x)
    }

    pub(super) fn sort_along(&self, segment: Ends, sites: &mut [VertexId]) {
        let in_order = self.order_along(segment);
        let key = |site: VertexId| in_order(position(self.t, site));
        sites.sort_unstable_by(|&u, &v| {
            key(u)
                .partial_cmp(&key(v))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
    }

    pub(super) fn is_given(&self, vertex: VertexId) -> bool {
        !self.lines.added.contains(vertex) && self.gone != Some(vertex)
    }

    /// Returns true if a segment that meets a site's pixel passes exactly through the site, and
    /// this is a given point.
    pub(super) fn is_exact(&self, segment: Ends, site: VertexId) -> bool {
        self.is_given(site) && is_aligned(self.ends(segment), position(self.t, site))
    }

    pub(super) fn meets_pixel(&self, segment: Ends, site: VertexId) -> bool {
        !segment.contains(&site)
            && self
                .rounder
                .hits(self.ends(segment), position(self.t, site))
    }

    pub(super) fn is_hot(&self, vertex: VertexId) -> bool {
        self.hot.get(&vertex).copied().unwrap_or_else(|| {
            self.lines.added.contains(vertex)
                || self
                    .lines_at(vertex)
                    .into_iter()
                    .any(|s| s.contains(&vertex) || self.has_site(s, vertex))
        })
    }

    pub(super) fn is_active(&self, site: VertexId) -> bool {
        self.active.contains(&site)
            || self
                .lines_at(site)
                .into_iter()
                .any(|s| self.has_site(s, site) && !self.is_exact(s, site))
    }

    /// Returns true if a segment crosses another one, which then also passes through one of its
    /// sites or ends.
    pub(super) fn crosses_any(&self, segment: Ends) -> bool {
        let ends = self.ends(segment);
        let sites = self.sites(segment).into_iter().chain(segment);
        sites.into_iter().any(|site| {
            self.lines_at(site)
                .into_iter()
                .any(|other| crosses(ends, self.ends(other)))
        })
    }

    pub(super) fn is_end(&self, site: VertexId) -> bool {
        self.lines_at(site)
            .into_iter()
            .any(|segment| segment.contains(&site))
    }

    /// Returns true if the crossing of two of the segments is rounded to a site.
    pub(super) fn is_crossing(&self, site: VertexId, segments: &[Ends]) -> bool {
        let at = position(self.t, site);
        let crosses_here = |i: usize, j: usize| {
            self.rounder
                .crossing(self.ends(segments[i]), self.ends(segments[j]))
                .is_some_and(|center| center == at)
        };
        (0..segments.len()).any(|i| (0..i).any(|j| crosses_here(i, j)))
    }

    /// Returns true if a site is a given point on one of the segments.
    pub(super) fn is_on_one(&self, site: VertexId, segments: &[Ends]) -> bool {
        let at = position(self.t, site);
        self.is_given(site)
            && segments
                .iter()
                .any(|&segment| lies_on(self.ends(segment), at))
    }
}

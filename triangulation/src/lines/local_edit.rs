//! Edits of one segment or one site, without touching what is far away.
//!
//! Which sites bend which segments is the smallest solution of these rules (see
//! [`arrangement`](crate::arrangement)):
//!
//! - A site is *hot* if a segment ends at it, if the crossing of two segments was rounded to it, or
//!   if it is a given point exactly on a bent segment.
//! - A segment is *bent* if it crosses another one, or meets the pixel of an active site that is
//!   not its end. It bends to all hot sites whose pixels it meets.
//! - A hot site is *active* if a bent segment bends to it but does not pass exactly through it
//!   as a given point.
//!
//! The segment `p q` is inserted; the box is the pixel of the site `c`:
//!
//! ```text
//!         q                              q
//!  +------|-----+                 +------|-----+
//!  |      |     |                 |      /     |
//!  |      |     |                 |     /      |
//! a|------x-----|------b         a|--. /   .---|------b
//!  |    c |     |    .d           |   c---<    |    .d
//!  |      |     |  .'             |   |\   '---|---'
//!  |      |     |.'               |   ' \      |
//!  +------|----.+                 +----'-\-----+
//!         |  .'                          |\
//!         p e                            p e
//! ```
//!
//! 1. It crosses `a b` in `x`, which is rounded to `c`: `c` becomes hot, and both segments bend to
//!    it. No given point lies there, so `c` becomes active.
//! 2. `d e` crosses neither of them, but meets the pixel of `c`: it bends to `c`, too.
//! 3. `d e` is bent now, and so it bends to all hot sites whose pixels it meets. Those that become
//!    active bend other segments, and so on. It ends, because a site becomes hot or active once.
//!
//! If `p q` is removed, all of this is retracted first: `c` is not hot, unless other segments cross
//! there, and `a b` and `d e` are straight again.
//!
//! An insertion applies the rules, starting from what is new. A removal first retracts what may
//! have depended on what is removed: from site to site, the segments there that cross no other.
//! What remains depends on crossings that remain. Then it applies the rules again.
//!
//! *Where to search.* A point of a segment is within half a unit of its chain on each axis, and a
//! point of the chain within half a unit of the segment. So a segment that meets a pixel passes
//! within one unit of its center, and a segment that crosses another one passes within half a unit
//! of it.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::arrangement::{Rounder, crosses, is_aligned};
use crate::geometry::Crossing;
use crate::locate::Location;
use crate::tds::{CellId, VertexId};

use super::chains::{Ends, undirected};
use super::change::Change;
use super::index::NotLocal;
use super::mesh::{Mesh, position};
use super::near_segment::{Band, Nearby, near};
use super::rounding::Rounding;
use super::tables::Lines;

/// How many units around a segment or a site are searched. One would suffice, except for rounding.
const REACH: f64 = 2.0;

/// How many units around an inserted segment are searched: also for segments that meet the pixels
/// of its crossings, which are up to half a unit away from it.
const WIDE_REACH: f64 = 3.0;

/// A list of at most this many sites is searched one by one, which is faster than by halves.
const SHORT: usize = 64;

/// A pending step.
enum PendingStep {
    /// A site has become hot.
    Attract(VertexId),
    /// A site has become active.
    Activate(VertexId),
    /// A segment must be bent.
    Bend(Ends),
}

/// The consequences of an edit, before they are carried out.
pub(super) struct Edit<'a, G: Crossing, V, C> {
    t: &'a mut Mesh<G, V, C>,
    lines: &'a mut Lines,
    rounder: Rounder,
    /// The segment to be inserted; not in a table of edges yet.
    added: Option<Ends>,
    /// The vertices near the segment to be inserted.
    near_added: Vec<VertexId>,
    /// The other segments near it, with their ends.
    beside_added: Vec<(Ends, [[f64; 2]; 2])>,
    /// The segment to be removed.
    removed: Option<Ends>,
    /// The given vertex to be removed.
    gone: Option<VertexId>,
    /// The sites of segments that change, in their order along them; `None` for straight ones.
    chains: FxHashMap<Ends, Option<Vec<VertexId>>>,
    hot: FxHashMap<VertexId, bool>,
    active: FxHashSet<VertexId>,
    /// The segments that meet the pixel of a site and do not end there.
    around: FxHashMap<VertexId, Vec<Ends>>,
    /// Edges that replaced a part of a segment when a site was inserted beside it.
    replacing: Vec<(Ends, Ends)>,
    /// Added vertices at which other segments cross than before.
    stale: Vec<VertexId>,
    steps: Vec<PendingStep>,
}

impl<'a, G: Crossing, V: Default, C: Copy + Default> Edit<'a, G, V, C> {
    pub(super) fn on(t: &'a mut Mesh<G, V, C>, lines: &'a mut Lines) -> Result<Self, NotLocal> {
        let rounder = if t.dimension() == 2 { lines.measured(t)?.rounder } else { None }.ok_or(NotLocal)?;
        Ok(Edit {
            t,
            lines,
            rounder,
            added: None,
            near_added: Vec::new(),
            beside_added: Vec::new(),
            removed: None,
            gone: None,
            chains: FxHashMap::default(),
            hot: FxHashMap::default(),
            active: FxHashSet::default(),
            around: FxHashMap::default(),
            replacing: Vec::new(),
            stale: Vec::new(),
            steps: Vec::new(),
        })
    }

    /// Inserts a segment that is now part of a line.
    pub(super) fn add_segment(mut self, segment: Ends) -> Result<(), NotLocal> {
        self.added = Some(segment);
        for end in segment {
            if !self.lines_at(end).into_iter().any(|other| other.contains(&end) || self.has_site(other, end)) {
                self.make_hot(end);
            }
        }
        let ends = self.ends(segment);
        let Nearby { edges, vertices } = self.near_segment(segment, WIDE_REACH);
        self.near_added = vertices;
        let mut crossed = Vec::new();
        for (other, cell) in self.segments_on_each(edges) {
            let ends_of_other = self.ends(other);
            self.beside_added.push((other, ends_of_other));
            crossed.extend(self.rounder.crossing(ends, ends_of_other).map(|center| (other, center, cell)));
        }
        if crossed.is_empty() {
            self.bend_if_attracted(segment);
        } else {
            self.expect(crossed.len() + 1);
            for &(other, center, cell) in &crossed {
                self.add_site(center, [segment, other], cell)?;
            }
            self.steps.extend(crossed.iter().map(|&(other, ..)| PendingStep::Bend(other)));
            self.steps.push(PendingStep::Bend(segment));
        }
        self.apply_rules()?;
        self.carry_out()
    }

    /// Removes a segment that is no longer part of a line.
    pub(super) fn remove_segment(mut self, segment: Ends) -> Result<(), NotLocal> {
        self.removed = Some(segment);
        let sites = self.lines.chains.sites(segment);
        self.retract(sites);
        self.apply_rules()?;
        self.carry_out()
    }

    /// Makes a vertex a given one. It is new, or was added for a crossing before.
    pub(super) fn make_given(mut self, vertex: VertexId, was_added: bool) -> Result<(), NotLocal> {
        if was_added {
            self.retract(vec![vertex]);
        } else {
            let at = position(self.t, vertex);
            let around = self.around(vertex);
            if around.into_iter().any(|segment| self.is_bent(segment) && lies_on(self.ends(segment), at)) {
                self.make_hot(vertex);
            }
        }
        self.apply_rules()?;
        self.carry_out()
    }

    /// Removes a vertex that no line was given by; if lines cross in it, makes it an added one.
    pub(super) fn withdraw(mut self, vertex: VertexId) -> Result<(), NotLocal> {
        self.gone = Some(vertex);
        self.retract(vec![vertex]);
        if self.is_hot(vertex) {
            self.steps.push(PendingStep::Activate(vertex));
            self.stale.push(vertex);
        }
        self.apply_rules()?;
        self.carry_out()
    }

    fn ends(&self, segment: Ends) -> [[f64; 2]; 2] {
        segment.map(|v| position(self.t, v))
    }

    /// Reserves memory for a number of segments and sites.
    fn expect(&mut self, count: usize) {
        self.chains.reserve(count);
        self.hot.reserve(count);
        self.active.reserve(count);
        self.around.reserve(count);
    }

    /// Returns what lies within a number of units around a segment.
    fn near_segment(&mut self, segment: Ends, reach: f64) -> Nearby {
        let band = Band::around(self.ends(segment), self.rounder.unit().map(|unit| reach * unit));
        near(self.t, &band, segment[0])
    }

    /// Returns all vertices whose pixels a segment meets, in no particular order.
    fn attractors(&mut self, segment: Ends) -> Vec<VertexId> {
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
    fn around(&mut self, vertex: VertexId) -> Vec<Ends> {
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
    fn look_around_crossing(&mut self, site: VertexId) {
        if !self.around.contains_key(&site) {
            let at = position(self.t, site);
            let beside = self.beside_added.iter().copied();
            let all = beside.chain(self.added.map(|segment| (segment, self.ends(segment))));
            let met = all.filter(|&(segment, ends)| !segment.contains(&site) && self.rounder.hits(ends, at));
            let segments = met.map(|(segment, _)| segment).collect();
            self.around.insert(site, segments);
        }
    }

    /// Returns the segments that end at a vertex or run through it, without the one that is
    /// inserted or removed.
    fn lines_at(&self, vertex: VertexId) -> Vec<Ends> {
        self.segments_on(self.t.constrained_around(vertex).map(|other| undirected(vertex, other)))
    }

    /// Returns the segments on edges, each once, in order, with what was given of one of its edges.
    fn segments_on_each(&self, edges: Vec<(Ends, CellId)>) -> Vec<(Ends, CellId)> {
        let index = self.lines.index();
        let on_edge = |(edge, cell)| index.segments_on(&self.lines.chains, edge).map(move |segment| (segment, cell));
        let mut segments: Vec<(Ends, CellId)> = edges.into_iter().flat_map(on_edge).collect();
        segments.retain(|&(segment, _)| Some(segment) != self.added && Some(segment) != self.removed);
        segments.sort_unstable();
        segments.dedup_by_key(|(segment, _)| *segment);
        segments
    }

    fn segments_on(&self, edges: impl IntoIterator<Item = Ends>) -> Vec<Ends> {
        let index = self.lines.index();
        let segments = edges.into_iter().flat_map(|edge| index.segments_on(&self.lines.chains, edge));
        let mut segments: Vec<Ends> =
            segments.filter(|&segment| Some(segment) != self.added && Some(segment) != self.removed).collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    }

    fn is_bent(&self, segment: Ends) -> bool {
        self.chains.get(&segment).map_or_else(|| self.lines.chains.bent.contains_key(&segment), Option::is_some)
    }

    /// Returns true if a segment bends to a vertex between its ends.
    fn has_site(&self, segment: Ends, vertex: VertexId) -> bool {
        if let Some(chain) = self.chains.get(&segment) {
            return chain.as_ref().is_some_and(|sites| sites.contains(&vertex));
        }
        let Some(sites) = self.lines.chains.bent.get(&segment) else { return false };
        if sites.len() <= SHORT {
            return sites.contains(&vertex);
        }
        sites.get(self.position_along(segment, sites, position(self.t, vertex))) == Some(&vertex)
    }

    /// Returns how many of a segment's sites come before a site that is near the segment.
    fn position_along(&self, segment: Ends, sites: &[VertexId], at: [f64; 2]) -> usize {
        let key = self.order_along(segment);
        let limit = key(at);
        sites.partition_point(|&site| key(position(self.t, site)) < limit)
    }

    /// Returns keys that sort the sites of a segment from its first end to its second.
    fn order_along(&self, segment: Ends) -> impl Fn([f64; 2]) -> [f64; 2] + use<G, V, C> {
        let ends = self.ends(segment);
        let sign = if ends[0] <= ends[1] { 1.0 } else { -1.0 };
        let key = self.rounder.along(ends);
        move |at| key(at).map(|x| sign * x)
    }

    fn sort_along(&self, segment: Ends, sites: &mut [VertexId]) {
        let in_order = self.order_along(segment);
        let key = |site: VertexId| in_order(position(self.t, site));
        sites.sort_unstable_by(|&u, &v| key(u).partial_cmp(&key(v)).unwrap_or(std::cmp::Ordering::Equal));
    }

    /// Returns the current sites of a segment.
    fn sites(&self, segment: Ends) -> Vec<VertexId> {
        let in_table = || self.lines.chains.bent.get(&segment).map(|sites| sites.to_vec());
        self.chains.get(&segment).cloned().unwrap_or_else(in_table).unwrap_or_default()
    }

    /// Bends a segment to one more site.
    fn insert_site(&mut self, segment: Ends, site: VertexId) {
        let mut sites = std::mem::take(self.sites_mut(segment));
        let at = self.position_along(segment, &sites, position(self.t, site));
        sites.insert(at, site);
        self.chains.insert(segment, Some(sites));
    }

    /// Returns the sites of a bent segment, mutable.
    fn sites_mut(&mut self, segment: Ends) -> &mut Vec<VertexId> {
        let table = &self.lines.chains.bent;
        let in_table = || {
            let sites = table.get(&segment)?;
            let mut copy = Vec::with_capacity(sites.len() + 2); // more will be inserted
            copy.extend_from_slice(sites);
            Some(copy)
        };
        self.chains.entry(segment).or_insert_with(in_table).get_or_insert_default()
    }

    fn is_given(&self, vertex: VertexId) -> bool {
        !self.lines.added.contains(vertex) && self.gone != Some(vertex)
    }

    /// Returns true if a segment that meets a site's pixel passes exactly through the site, and
    /// this is a given point.
    fn is_exact(&self, segment: Ends, site: VertexId) -> bool {
        self.is_given(site) && is_aligned(self.ends(segment), position(self.t, site))
    }

    fn meets_pixel(&self, segment: Ends, site: VertexId) -> bool {
        !segment.contains(&site) && self.rounder.hits(self.ends(segment), position(self.t, site))
    }

    fn is_hot(&self, vertex: VertexId) -> bool {
        self.hot.get(&vertex).copied().unwrap_or_else(|| {
            self.lines.added.contains(vertex)
                || self.lines_at(vertex).into_iter().any(|s| s.contains(&vertex) || self.has_site(s, vertex))
        })
    }

    fn is_active(&self, site: VertexId) -> bool {
        self.active.contains(&site)
            || self.lines_at(site).into_iter().any(|s| self.has_site(s, site) && !self.is_exact(s, site))
    }

    fn make_hot(&mut self, site: VertexId) {
        self.hot.insert(site, true);
        self.steps.push(PendingStep::Attract(site));
    }

    /// Makes the rounded crossing of two segments a hot site.
    /// The walk to it starts at a cell nearby.
    fn add_site(&mut self, center: [f64; 2], segments: [Ends; 2], near: CellId) -> Result<(), NotLocal> {
        let ends = segments.map(|ends| ends.map(|v| *self.t.point(v)));
        let p = self.t.geometry.meet(center, &ends.each_ref().map(|ends| ends.each_ref()));
        self.t.admit(&p).map_err(|_| NotLocal)?;
        let count = self.t.vertex_count();
        let location = self.t.locate(&p, Some(near));
        let site = match self.constraint_beside(segments[1], center, &p, location) {
            Some((cell, i)) => self.bend_edge(segments[1], p, cell, i),
            None => self.lines.insert_at(self.t, p, V::default(), location).vertex,
        };
        if self.t.vertex_count() > count {
            self.lines.added.insert(site);
            self.near_added.push(site);
            self.make_hot(site);
        } else if !self.is_hot(site) {
            self.make_hot(site);
        }
        self.look_around_crossing(site);
        Ok(())
    }

    /// Returns the constraint beside a new site of a segment, which the segment, and no other,
    /// follows now, but not once it bends to the site; as a triangle with the site and an index.
    /// `None` if it is not an edge of that triangle.
    fn constraint_beside(
        &self,
        segment: Ends,
        at: [f64; 2],
        p: &G::Point,
        location: Location,
    ) -> Option<(CellId, usize)> {
        let Location::Cell { cell, facets } = location else { return None };
        let sites = self.lines.chains.bent.get(&segment).map_or(&[][..], |sites| sites);
        let next = self.position_along(segment, sites, at);
        let from = if next == 0 { segment[0] } else { sites[next - 1] };
        let part = undirected(from, *sites.get(next).unwrap_or(&segment[1]));
        let is_part = |&i: &usize| {
            let [a, b] = self.t.tds.edge_ends(cell, i);
            self.t.is_constrained(cell, i) && undirected(a, b) == part
        };
        let i = (0..3).find(is_part).filter(|_| facets.is_empty())?;
        let mut others = self.lines.index().segments_on(&self.lines.chains, part);
        let is_only = others.all(|other| other == segment);
        (is_only && self.t.in_conflict(self.t.tds.neighbor(cell, i), p)).then_some((cell, i))
    }

    /// Inserts a site of a segment beside a constraint that is bent to it.
    fn bend_edge(&mut self, segment: Ends, p: G::Point, cell: CellId, i: usize) -> VertexId {
        let ends = self.t.tds.edge_ends(cell, i);
        let site = Lines::bend_edge(self.t, p, cell, i);
        for part in ends.map(|end| undirected(end, site)) {
            if let Some(index) = self.lines.index.get_mut() {
                index.add_node(segment, part);
            }
            self.replacing.push((segment, part));
        }
        site
    }

    /// Schedules a segment to be bent if it meets the pixel of an active site.
    fn bend_if_attracted(&mut self, segment: Ends) {
        if self.attractors(segment).into_iter().any(|v| self.is_hot(v) && self.is_active(v)) {
            self.steps.push(PendingStep::Bend(segment));
        }
    }

    /// Applies the rules until nothing changes.
    fn apply_rules(&mut self) -> Result<(), NotLocal> {
        while let Some(step) = self.steps.pop() {
            match step {
                PendingStep::Attract(site) => {
                    if self.is_given(site) && self.rounder.is_even() && !self.rounder.holds(position(self.t, site)) {
                        return Err(NotLocal); // the grid becomes another one
                    }
                    for segment in self.around(site) {
                        if self.is_bent(segment) && !self.has_site(segment, site) {
                            self.insert_site(segment, site);
                            if !self.is_exact(segment, site) {
                                self.steps.push(PendingStep::Activate(site));
                            }
                        }
                    }
                }
                PendingStep::Activate(site) => {
                    if self.active.insert(site) {
                        for segment in self.around(site) {
                            if !self.is_bent(segment) {
                                self.steps.push(PendingStep::Bend(segment));
                            }
                        }
                    }
                }
                PendingStep::Bend(segment) => {
                    if !self.is_bent(segment) {
                        self.bend(segment);
                    }
                }
            }
        }
        Ok(())
    }

    /// Bends a segment to all hot sites whose pixels it meets; given points on it become hot.
    fn bend(&mut self, segment: Ends) {
        self.chains.insert(segment, Some(Vec::new()));
        let ends = self.ends(segment);
        let mut sites = Vec::new();
        for v in self.attractors(segment) {
            if self.is_hot(v) {
                sites.push(v);
                if !self.is_exact(segment, v) {
                    self.steps.push(PendingStep::Activate(v));
                }
            } else if self.is_given(v) && lies_on(ends, position(self.t, v)) {
                self.make_hot(v);
            }
        }
        self.sort_along(segment, &mut sites);
        self.chains.insert(segment, Some(sites));
    }

    /// Retracts what may depend on some sites: the segments that bend to them and cross no other,
    /// and so on. Sites that are no longer hot are removed from their segments; segments that are
    /// still attracted are bent again.
    fn retract(&mut self, sites: Vec<VertexId>) {
        let mut seen: FxHashSet<VertexId> = sites.iter().copied().collect();
        let mut open = sites;
        let mut known: FxHashSet<Ends> = FxHashSet::default();
        let mut loose: Vec<Ends> = Vec::new();
        let mut order: Vec<VertexId> = Vec::new();
        while let Some(site) = open.pop() {
            order.push(site);
            for segment in self.lines_at(site) {
                if self.is_bent(segment) && known.insert(segment) && !self.crosses_any(segment) {
                    loose.push(segment);
                    open.extend(self.sites(segment).into_iter().filter(|&site| seen.insert(site)));
                }
            }
        }
        self.chains.extend(loose.iter().map(|&segment| (segment, None)));
        for site in order {
            let bent: Vec<Ends> = self.lines_at(site).into_iter().filter(|&s| self.is_bent(s)).collect();
            let is_hot = self.is_end(site) || self.is_crossing(site, &bent) || self.is_on_one(site, &bent);
            self.hot.insert(site, is_hot);
            for segment in bent.into_iter().filter(|_| !is_hot) {
                if self.has_site(segment, site) {
                    self.sites_mut(segment).retain(|&other| other != site);
                }
            }
        }
        for segment in loose {
            self.bend_if_attracted(segment);
        }
    }

    /// Returns true if a segment crosses another one, which then also passes through one of its
    /// sites or ends.
    fn crosses_any(&self, segment: Ends) -> bool {
        let ends = self.ends(segment);
        let sites = self.sites(segment).into_iter().chain(segment);
        sites.into_iter().any(|site| self.lines_at(site).into_iter().any(|other| crosses(ends, self.ends(other))))
    }

    fn is_end(&self, site: VertexId) -> bool {
        self.lines_at(site).into_iter().any(|segment| segment.contains(&site))
    }

    /// Returns true if the crossing of two of the segments is rounded to a site.
    fn is_crossing(&self, site: VertexId, segments: &[Ends]) -> bool {
        let at = position(self.t, site);
        let crosses_here = |i: usize, j: usize| {
            self.rounder.crossing(self.ends(segments[i]), self.ends(segments[j])).is_some_and(|center| center == at)
        };
        (0..segments.len()).any(|i| (0..i).any(|j| crosses_here(i, j)))
    }

    /// Returns true if a site is a given point on one of the segments.
    fn is_on_one(&self, site: VertexId, segments: &[Ends]) -> bool {
        let at = position(self.t, site);
        self.is_given(site) && segments.iter().any(|&segment| lies_on(self.ends(segment), at))
    }

    /// Changes the tables and the triangulation.
    fn carry_out(mut self) -> Result<(), NotLocal> {
        let leaving = self.leaving();
        let changes = self.changes(&leaving);

        // The tables.
        let edges = self.retract_parts(&changes)?;
        let chains = &mut self.lines.chains;
        let mut stale = std::mem::take(&mut self.stale);
        let mut parts: Vec<Ends> = Vec::new();
        for change in &changes {
            if change.is_bent {
                chains.bent.insert(change.segment, change.new_sites().into());
            } else {
                chains.bent.remove(&change.segment);
            }
            stale.extend(change.sites_that_change());
            parts.extend(change.new_parts());
        }
        parts.sort_unstable();
        parts.dedup();

        // The triangulation. What is in both lists stays.
        let released: Vec<Ends> = edges.iter().copied().filter(|edge| parts.binary_search(edge).is_err()).collect();
        parts.retain(|part| edges.binary_search(part).is_err());
        for [a, b] in released {
            self.lines.release(self.t, a, b);
        }
        for vertex in leaving {
            self.lines.added.remove(vertex);
            if self.lines.remove_free(self.t, vertex).is_none() {
                self.lines.owned.insert(vertex); // a new arrangement of all lines removes it
                return Err(NotLocal);
            }
        }
        if self.t.dimension() < 2 {
            return Err(NotLocal);
        }
        for [a, b] in parts {
            if !self.lines.constrain(self.t, a, b) {
                return Err(NotLocal);
            }
        }
        let (index, chains) = self.lines.index_and_chains();
        let index = index.ok_or(NotLocal)?;
        for change in &changes {
            change.new_parts().for_each(|part| index.add_part(chains, change.segment, part));
        }

        // The points of vertices at which other segments cross now.
        stale.sort_unstable();
        stale.dedup();
        self.added = None;
        stale.retain(|&v| self.lines.added.contains(v));
        stale.into_iter().for_each(|site| self.renew_point(site));
        let is_rounded = !self.lines.chains.bent.is_empty();
        self.lines.rounding =
            is_rounded.then(|| Rounding { unit: self.rounder.unit(), on_grid: self.rounder.is_even() });
        self.lines.touch();
        Ok(())
    }

    /// Takes the old parts of chains that change out of the index. Returns the edges that no other
    /// chain needs: these are to be released.
    fn retract_parts(&mut self, changes: &[Change]) -> Result<Vec<Ends>, NotLocal> {
        let (index, chains) = self.lines.index_and_chains();
        let index = index.ok_or(NotLocal)?;
        let mut edges: Vec<Ends> = Vec::new();
        for change in changes {
            change.old_parts().for_each(|part| index.remove_part(chains, change.segment, part, &mut edges));
        }
        for (segment, part) in std::mem::take(&mut self.replacing) {
            index.remove_part(chains, segment, part, &mut edges);
        }
        edges.sort_unstable();
        edges.dedup();
        let straight = |edge: &Ends| changes.binary_search_by(|change| change.segment.cmp(edge));
        let is_rerouted = |edge: &Ends| straight(edge).is_ok_and(|at| changes[at].old_parts().next().is_some());
        edges.retain(|&edge| index.segments_on(chains, edge).all(|other| other == edge && is_rerouted(&edge)));
        edges.retain(|edge| chains.splits.remove(edge).is_none());
        Ok(edges)
    }

    /// Returns the vertices that are to be removed, in order.
    fn leaving(&mut self) -> Vec<VertexId> {
        let leaves = |(&v, &is_hot): (&VertexId, &bool)| (!is_hot && self.lines.added.contains(v)).then_some(v);
        let mut leaving: Vec<VertexId> = self.hot.iter().filter_map(leaves).collect();
        if let Some(gone) = self.gone {
            self.lines.owned.remove(gone);
            if self.is_hot(gone) {
                self.lines.added.insert(gone);
            } else {
                leaving.push(gone);
            }
        }
        leaving.sort_unstable();
        leaving
    }

    /// Returns the changes of chains, ordered by segment: of those whose sites differ, and of those
    /// with a vertex that is to be removed, even if it only split one of their parts.
    fn changes(&mut self, leaving: &[VertexId]) -> Vec<Change> {
        let chains = &self.lines.chains;
        let from_end_to_end = |[a, b]: Ends, sites: &[VertexId]| [&[a], sites, &[b]].concat();
        let mut changes: Vec<Change> = Vec::new();
        for (segment, sites) in std::mem::take(&mut self.chains) {
            let is_new = Some(segment) == self.added;
            if is_new || sites.as_deref() != chains.bent.get(&segment).map(|sites| &**sites) {
                let old = if is_new { Vec::new() } else { chains.sites(segment) };
                let new = from_end_to_end(segment, sites.as_deref().unwrap_or_default());
                changes.push(Change::new(segment, old, new, sites.is_some()));
            }
        }
        if let Some(added) = self.added.filter(|added| !changes.iter().any(|change| change.segment == *added)) {
            changes.push(Change::new(added, Vec::new(), added.to_vec(), false));
        }
        if let Some(removed) = self.removed {
            changes.push(Change::new(removed, chains.sites(removed), Vec::new(), false));
        }
        changes.sort_unstable_by_key(|change| change.segment);
        for &vertex in leaving {
            for segment in self.lines_at(vertex) {
                let at = changes.binary_search_by(|change| change.segment.cmp(&segment)).unwrap_or_else(|at| {
                    let sites = self.lines.chains.sites(segment);
                    let is_bent = self.lines.chains.bent.contains_key(&segment);
                    changes.insert(at, Change::new(segment, sites.clone(), sites, is_bent));
                    at
                });
                let part = self.position_along(segment, changes[at].old_sites(), position(self.t, vertex));
                changes[at].include(part, vertex);
            }
        }
        changes
    }

    /// Updates the point at a crossing, which the geometry computes from the segments that pass
    /// there.
    fn renew_point(&mut self, site: VertexId) {
        let mut segments = self.around.remove(&site).unwrap_or_else(|| self.lines_at(site));
        segments.sort_unstable();
        segments.retain(|&segment| self.has_site(segment, site));
        let ends: Vec<[G::Point; 2]> = segments.into_iter().map(|ends| ends.map(|v| *self.t.point(v))).collect();
        let ends: Vec<[&G::Point; 2]> = ends.iter().map(|ends| ends.each_ref()).collect();
        if !ends.is_empty() {
            let p = self.t.geometry.meet(position(self.t, site), &ends);
            self.t.points[site.index()] = p;
        }
    }
}

/// Returns true if a site lies on a segment, ends included.
fn lies_on([a, b]: [[f64; 2]; 2], at: [f64; 2]) -> bool {
    let is_between = |k: usize| a[k].min(b[k]) <= at[k] && at[k] <= a[k].max(b[k]);
    is_between(0) && is_between(1) && is_aligned([a, b], at)
}

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

mod carry_out;
mod view;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::arrangement::{Rounder, is_aligned};
use crate::geometry::Crossing;
use crate::locate::Location;
use crate::tds::{CellId, VertexId};

use super::chains::{Ends, undirected};
use super::index::NotLocal;
use super::mesh::{Mesh, position};
use super::near_segment::Nearby;
use super::tables::Lines;

/// How many units around a segment or a site are searched. One would suffice, except for rounding.
const REACH: f64 = 2.0;

/// How many units around an inserted segment are searched: also for segments that meet the pixels
/// of its crossings, which are up to half a unit away from it.
const WIDE_REACH: f64 = 3.0;

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
        let rounder = if t.dimension() == 2 {
            lines.measured(t)?.rounder
        } else {
            None
        }
        .ok_or(NotLocal)?;
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
            if !self
                .lines_at(end)
                .into_iter()
                .any(|other| other.contains(&end) || self.has_site(other, end))
            {
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
            crossed.extend(
                self.rounder
                    .crossing(ends, ends_of_other)
                    .map(|center| (other, center, cell)),
            );
        }
        if crossed.is_empty() {
            self.bend_if_attracted(segment);
        } else {
            self.expect(crossed.len() + 1);
            for &(other, center, cell) in &crossed {
                self.add_site(center, [segment, other], cell)?;
            }
            self.steps
                .extend(crossed.iter().map(|&(other, ..)| PendingStep::Bend(other)));
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
            if around
                .into_iter()
                .any(|segment| self.is_bent(segment) && lies_on(self.ends(segment), at))
            {
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

    /// Reserves memory for a number of segments and sites.
    fn expect(&mut self, count: usize) {
        self.chains.reserve(count);
        self.hot.reserve(count);
        self.active.reserve(count);
        self.around.reserve(count);
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
        self.chains
            .entry(segment)
            .or_insert_with(in_table)
            .get_or_insert_default()
    }

    fn make_hot(&mut self, site: VertexId) {
        self.hot.insert(site, true);
        self.steps.push(PendingStep::Attract(site));
    }

    /// Makes the rounded crossing of two segments a hot site.
    /// The walk to it starts at a cell nearby.
    fn add_site(
        &mut self,
        center: [f64; 2],
        segments: [Ends; 2],
        near: CellId,
    ) -> Result<(), NotLocal> {
        let ends = segments.map(|ends| ends.map(|v| *self.t.point(v)));
        let p = self
            .t
            .geometry
            .meet(center, &ends.each_ref().map(|ends| ends.each_ref()));
        self.t.admit(&p).map_err(|_| NotLocal)?;
        let count = self.t.vertex_count();
        let location = self.t.locate(&p, Some(near));
        let site = match self.constraint_beside(segments[1], center, &p, location) {
            Some((cell, i)) => self.bend_edge(segments[1], p, cell, i),
            None => {
                self.lines
                    .insert_at(self.t, p, V::default(), location)
                    .vertex
            }
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
        let Location::Cell { cell, facets } = location else {
            return None;
        };
        let sites = self
            .lines
            .chains
            .bent
            .get(&segment)
            .map_or(&[][..], |sites| sites);
        let next = self.position_along(segment, sites, at);
        let from = if next == 0 {
            segment[0]
        } else {
            sites[next - 1]
        };
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
        if self
            .attractors(segment)
            .into_iter()
            .any(|v| self.is_hot(v) && self.is_active(v))
        {
            self.steps.push(PendingStep::Bend(segment));
        }
    }

    /// Applies the rules until nothing changes.
    fn apply_rules(&mut self) -> Result<(), NotLocal> {
        while let Some(step) = self.steps.pop() {
            match step {
                PendingStep::Attract(site) => {
                    if self.is_given(site)
                        && self.rounder.is_even()
                        && !self.rounder.holds(position(self.t, site))
                    {
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
                    open.extend(
                        self.sites(segment)
                            .into_iter()
                            .filter(|&site| seen.insert(site)),
                    );
                }
            }
        }
        self.chains
            .extend(loose.iter().map(|&segment| (segment, None)));
        for site in order {
            let bent: Vec<Ends> = self
                .lines_at(site)
                .into_iter()
                .filter(|&s| self.is_bent(s))
                .collect();
            let is_hot =
                self.is_end(site) || self.is_crossing(site, &bent) || self.is_on_one(site, &bent);
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
}

/// Returns true if a site lies on a segment, ends included.
fn lies_on([a, b]: [[f64; 2]; 2], at: [f64; 2]) -> bool {
    let is_between = |k: usize| a[k].min(b[k]) <= at[k] && at[k] <= a[k].max(b[k]);
    is_between(0) && is_between(1) && is_aligned([a, b], at)
}

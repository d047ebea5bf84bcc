//! How an edit changes the tables and the triangulation, once its consequences are known.

use crate::geometry::Crossing;
use crate::lines::chains::Ends;
use crate::lines::change::Change;
use crate::lines::index::NotLocal;
use crate::lines::mesh::position;
use crate::lines::on_crossing::Rounding;
use crate::tds::VertexId;

use super::Edit;

impl<G: Crossing, V: Default, C: Copy + Default> Edit<'_, G, V, C> {
    /// Changes the tables and the triangulation.
    pub(super) fn carry_out(mut self) -> Result<(), NotLocal> {
        let leaving = self.leaving();
        let changes = self.changes(&leaving);

        // The tables.
        let edges = self.retract_parts(&changes)?;
        let chains = &mut self.lines.chains;
        let mut stale = std::mem::take(&mut self.stale);
        let mut parts: Vec<Ends> = Vec::new();
        for change in &changes {
            if change.is_bent {
                chains
                    .bent
                    .insert(change.segment, change.new_sites().into());
            } else {
                chains.bent.remove(&change.segment);
            }
            stale.extend(change.sites_that_change());
            parts.extend(change.new_parts());
        }
        parts.sort_unstable();
        parts.dedup();

        // The triangulation. What is in both lists stays.
        let released: Vec<Ends> = edges
            .iter()
            .copied()
            .filter(|edge| parts.binary_search(edge).is_err())
            .collect();
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
            change
                .new_parts()
                .for_each(|part| index.add_part(chains, change.segment, part));
        }

        // The points of vertices at which other segments cross now.
        stale.sort_unstable();
        stale.dedup();
        self.added = None;
        stale.retain(|&v| self.lines.added.contains(v));
        stale.into_iter().for_each(|site| self.renew_point(site));
        let is_rounded = !self.lines.chains.bent.is_empty();
        self.lines.rounding = is_rounded.then(|| Rounding {
            unit: self.rounder.unit(),
            on_grid: self.rounder.is_even(),
        });
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
            change
                .old_parts()
                .for_each(|part| index.remove_part(chains, change.segment, part, &mut edges));
        }
        for (segment, part) in std::mem::take(&mut self.replacing) {
            index.remove_part(chains, segment, part, &mut edges);
        }
        edges.sort_unstable();
        edges.dedup();
        let straight = |edge: &Ends| changes.binary_search_by(|change| change.segment.cmp(edge));
        let is_rerouted =
            |edge: &Ends| straight(edge).is_ok_and(|at| changes[at].old_parts().next().is_some());
        edges.retain(|&edge| {
            index
                .segments_on(chains, edge)
                .all(|other| other == edge && is_rerouted(&edge))
        });
        edges.retain(|edge| chains.splits.remove(edge).is_none());
        Ok(edges)
    }

    /// Returns the vertices that are to be removed, in order.
    fn leaving(&mut self) -> Vec<VertexId> {
        let leaves = |(&v, &is_hot): (&VertexId, &bool)| {
            (!is_hot && self.lines.added.contains(v)).then_some(v)
        };
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
                let old = if is_new {
                    Vec::new()
                } else {
                    chains.sites(segment)
                };
                let new = from_end_to_end(segment, sites.as_deref().unwrap_or_default());
                changes.push(Change::new(segment, old, new, sites.is_some()));
            }
        }
        if let Some(added) = self
            .added
            .filter(|added| !changes.iter().any(|change| change.segment == *added))
        {
            changes.push(Change::new(added, Vec::new(), added.to_vec(), false));
        }
        if let Some(removed) = self.removed {
            changes.push(Change::new(
                removed,
                chains.sites(removed),
                Vec::new(),
                false,
            ));
        }
        changes.sort_unstable_by_key(|change| change.segment);
        for &vertex in leaving {
            for segment in self.lines_at(vertex) {
                let at = changes
                    .binary_search_by(|change| change.segment.cmp(&segment))
                    .unwrap_or_else(|at| {
                        let sites = self.lines.chains.sites(segment);
                        let is_bent = self.lines.chains.bent.contains_key(&segment);
                        changes.insert(at, Change::new(segment, sites.clone(), sites, is_bent));
                        at
                    });
                let part =
                    self.position_along(segment, changes[at].old_sites(), position(self.t, vertex));
                changes[at].include(part, vertex);
            }
        }
        changes
    }

    /// Updates the point at a crossing, which the geometry computes from the segments that pass
    /// there.
    fn renew_point(&mut self, site: VertexId) {
        let mut segments = self
            .around
            .remove(&site)
            .unwrap_or_else(|| self.lines_at(site));
        segments.sort_unstable();
        segments.retain(|&segment| self.has_site(segment, site));
        let ends: Vec<[G::Point; 2]> = segments
            .into_iter()
            .map(|ends| ends.map(|v| *self.t.point(v)))
            .collect();
        let ends: Vec<[&G::Point; 2]> = ends.iter().map(|ends| ends.each_ref()).collect();
        if !ends.is_empty() {
            let p = self.t.geometry.meet(position(self.t, site), &ends);
            self.t.points[site.index()] = p;
        }
    }
}

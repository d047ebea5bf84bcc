//! Checks of the tables of lines against the triangulation.

use rustc_hash::FxHashSet;

use crate::engine::ConstrainedEdges;
use crate::flaw::{Flaw, LinesFlaw};
use crate::geometry::Crossing;
use crate::tds::VertexId;
use crate::triangulation::Triangulation;

use super::chains::undirected;
use super::on_crossing::Rounding;
use super::tables::Lines;

impl Lines {
    /// Returns the flaws of the tables. Linear in the lengths of all chains.
    pub(crate) fn check<G: Crossing, V, C: Copy + Default>(
        &self,
        t: &Triangulation<G, 3, V, ConstrainedEdges<C>>,
    ) -> Vec<Flaw> {
        let is_flat = t.dimension() < 2;
        let constraints: FxHashSet<[VertexId; 2]> = match is_flat {
            true => self
                .waiting
                .iter()
                .map(|&[a, b]| undirected(a, b))
                .collect(),
            false => t.constrained_edges().collect(),
        };
        let waiting = self
            .waiting
            .iter()
            .filter(|_| !is_flat)
            .map(|&[a, b]| LinesFlaw::Waiting(a, b));
        let segments = self.chains.segments();
        let mut flaws: Vec<LinesFlaw> = waiting.collect();
        self.check_chains(t, &segments, &constraints, &mut flaws);
        flaws.extend((!self.has_fitting_grid(t, &segments)).then_some(LinesFlaw::Rounding));
        let named: FxHashSet<VertexId> = self.chains.each().flatten().copied().collect();
        let constrained: FxHashSet<VertexId> = constraints.into_iter().flatten().collect();
        let is_crossing = |v: &VertexId| constrained.contains(v) && !named.contains(v);
        flaws.extend(
            self.added
                .iter()
                .filter(|v| !is_crossing(v))
                .map(LinesFlaw::Added),
        );
        flaws.extend(
            self.owned
                .iter()
                .filter(|v| !named.contains(v))
                .map(LinesFlaw::Owned),
        );
        if let Some(index) = self.index.get() {
            flaws.extend(
                segments
                    .iter()
                    .filter(|&&ends| !index.knows(&self.chains, ends))
                    .map(|_| LinesFlaw::Index),
            );
        }
        let missing = self.missing.iter().map(|&[a, b]| Flaw::Missing(a, b));
        missing.chain(flaws.into_iter().map(Flaw::Lines)).collect()
    }

    /// Adds the flaws of segments whose chains are not constraints all along to their ends, and of
    /// entries that belong to no segment.
    fn check_chains<G: Crossing, V, C: Copy + Default>(
        &self,
        t: &Triangulation<G, 3, V, ConstrainedEdges<C>>,
        segments: &[[VertexId; 2]],
        constraints: &FxHashSet<[VertexId; 2]>,
        flaws: &mut Vec<LinesFlaw>,
    ) {
        let mut splits: FxHashSet<[VertexId; 2]> = FxHashSet::default();
        let mut bent = 0;
        for &ends in segments {
            bent += usize::from(self.chains.bent.contains_key(&ends));
            let sites = self.chains.sites(ends);
            let mut met: FxHashSet<VertexId> = sites.iter().copied().collect();
            if met.len() < sites.len()
                || !sites
                    .windows(2)
                    .all(|pair| runs_along(t, ends, [pair[0], pair[1]]))
            {
                flaws.push(LinesFlaw::Order(ends[0], ends[1]));
                continue;
            }
            let mut parts: Vec<[VertexId; 2]> = sites
                .windows(2)
                .map(|pair| undirected(pair[0], pair[1]))
                .collect();
            while let Some(part) = parts.pop() {
                match self.chains.splits.get(&part) {
                    Some(&between) if met.insert(between) => {
                        splits.insert(part);
                        parts.extend(part.map(|end| undirected(end, between)));
                    }
                    Some(_) => {
                        flaws.push(LinesFlaw::Order(ends[0], ends[1]));
                        break;
                    }
                    None if constraints.contains(&part) => {}
                    None => flaws.push(LinesFlaw::Unconstrained(ends[0], ends[1])),
                }
            }
        }
        if flaws.is_empty()
            && (bent, splits.len()) != (self.chains.bent.len(), self.chains.splits.len())
        {
            flaws.push(LinesFlaw::Stray);
        }
    }

    /// Returns true if the stored rounding fits the lines.
    fn has_fitting_grid<G: Crossing, V, C>(
        &self,
        t: &Triangulation<G, 3, V, ConstrainedEdges<C>>,
        segments: &[[VertexId; 2]],
    ) -> bool
    where
        C: Copy + Default,
    {
        let Some(Rounding { unit, on_grid }) = self.rounding else {
            return !self.recrossed;
        };
        let is_power_of_two = |x: f64| {
            let bits = x.to_bits();
            x > 0.0 && x.is_finite() && (bits.trailing_zeros() >= 52 || bits.is_power_of_two())
        };
        let is_multiple = |v: VertexId| {
            let at = t.geometry.plan(t.point(v));
            (0..2).all(|axis| at[axis] % unit[axis] == 0.0)
        };
        let mut sites = segments.iter().flat_map(|&ends| self.chains.sites(ends));
        unit.into_iter().all(is_power_of_two)
            && !(self.recrossed && on_grid)
            && (!on_grid || sites.all(is_multiple))
    }
}

/// Returns true if a sub-constraint runs in the direction of its segment, on both axes.
fn runs_along<G: Crossing, V, C: Copy + Default>(
    t: &Triangulation<G, 3, V, ConstrainedEdges<C>>,
    segment: [VertexId; 2],
    part: [VertexId; 2],
) -> bool {
    let [[a, b], [p, q]] = [segment, part].map(|ends| ends.map(|v| t.geometry.plan(t.point(v))));
    (0..2).all(|axis| {
        p[axis] == q[axis] || (p[axis] < q[axis]) == (a[axis] < b[axis]) && a[axis] != b[axis]
    })
}

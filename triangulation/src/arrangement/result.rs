//! What an arrangement consists of: sites, crossings, and the chains of segments.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::segment::Site;

/// Two segments that cross in their interiors, and the site to which the crossing was rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// The numbers of the segments, the smaller one first.
    pub segments: [u32; 2],
    /// The number of the site.
    pub site: u32,
}

/// A rounded arrangement of segments.
///
/// *Sites* are numbered: first the given ones, then those that were added.
#[derive(Debug, Clone)]
pub struct Arrangement {
    pub(super) unit: [f64; 2],
    pub(super) on_grid: bool,
    pub(super) given_count: usize,
    pub(super) added: Vec<Site>,
    pub(super) crossings: Vec<Crossing>,
    /// The sites between the ends of each segment that may bend: a range of `chain_sites`.
    pub(super) chains: FxHashMap<u32, Range<u32>>,
    pub(super) chain_sites: Vec<u32>,
}

impl Arrangement {
    /// The unit of the grid on each axis: a power of two.
    pub fn unit(&self) -> [f64; 2] {
        self.unit
    }

    /// Returns true if all ends of segments, and all given sites on segments that are routed, are
    /// multiples of the unit. The parts are then proven not to cross.
    pub fn is_on_grid(&self) -> bool {
        self.on_grid
    }

    /// The added sites: distinct.
    pub fn added(&self) -> &[Site] {
        &self.added
    }

    /// The pairs of segments that cross in their interiors, in order.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// Returns true if a segment crosses others, or comes near a site at which another one is bent.
    /// It is then routed through all sites whose pixels it meets, and through the given sites on
    /// it.
    pub fn has_chain(&self, segment: u32) -> bool {
        self.chains.contains_key(&segment)
    }

    /// The sites that a segment is routed through between its ends, in order from the first end to
    /// the second. (It also passes exactly through the given sites that lie on its parts.)
    pub fn chain(&self, segment: u32) -> &[u32] {
        self.chains.get(&segment).map_or(&[], |range| {
            &self.chain_sites[range.start as usize..range.end as usize]
        })
    }

    /// Returns the segments that are routed through added sites: pairs of the site's position among
    /// the added ones and the segment, in order.
    pub fn through_added(&self) -> Vec<(u32, u32)> {
        let given = self.given_count as u32;
        let added = |site: &u32| site.checked_sub(given);
        // Grouped by site, by counting.
        let mut ends = vec![0u32; self.added.len()];
        self.chain_sites
            .iter()
            .filter_map(added)
            .for_each(|site| ends[site as usize] += 1);
        let mut through = vec![(0, 0); starts(&mut ends) as usize];
        let mut chains: Vec<(&u32, &Range<u32>)> = self.chains.iter().collect();
        chains.sort_unstable_by_key(|(segment, _)| **segment);
        for (&segment, range) in chains {
            for site in self.chain_sites[range.start as usize..range.end as usize]
                .iter()
                .filter_map(added)
            {
                let end = &mut ends[site as usize];
                through[*end as usize] = (site, segment);
                *end += 1;
            }
        }
        through
    }
}

/// Replaces each count by the sum of those before it; returns the total.
pub(super) fn starts(counts: &mut [u32]) -> u32 {
    counts
        .iter_mut()
        .fold(0, |sum, count| sum + std::mem::replace(count, sum))
}

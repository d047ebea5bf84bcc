//! Arrangements of segments by snap rounding: segments that cross become segments that meet at
//! common ends only.
//!
//! The exact crossing of two segments is not representable in doubles. It must be rounded, which
//! bends both lines a little, so that they may cross others anew. *Snap rounding* (Hobby 1999;
//! Guibas and Marimont 1998) avoids that. The crossings of the **original** segments are rounded,
//! once, to the centers of the pixels of a grid. Every segment that meets the pixel of such a
//! center, or of an end of a segment, is routed through that center. Then no two of the resulting
//! parts cross.
//!
//! ```text
//! the segment a b meets the pixel of c      it is routed through c
//! +-------+-------+-------+                 +-------+-------+-------+
//! |       |   c   |   .b  |                 |       |   c---|---b   |
//! |       |     .-|-'     |                 |       | .'    |       |
//! +-------+-.-'---+-------+                 +-------+'------+-------+
//! |     .-|'      |       |                 |      .|       |       |
//! |   a'  |       |       |                 |   a-' |       |       |
//! +-------+-------+-------+                 +-------+-------+-------+
//! ```
//!
//! *Why.* Let a part run from center `A` to center `B`, and let `C` be a center whose pixel the
//! segment `s` does not meet. `A` and `B` lie in `s - Q`, where `Q` is a pixel around zero, and so
//! does all of `A B`, since that set is convex; `C` does not. When the line is moved from `s` to
//! `A B`, it therefore never passes over a center that it is not routed through. And lines that do
//! not cross before can only cross afterwards if one passes over an end of another.
//!
//! *The grid.* The unit on each axis is the unit in the last place of the largest coordinate on
//! that axis, among all ends of segments. Ends that are multiples of it are centers of pixels
//! themselves, pixels do not overlap, and the argument above holds without a gap: **no point of a
//! line is displaced by more than half a unit on each axis**.
//!
//! Ends may be finer than that, when coordinates near zero and large ones come together. The grid
//! is then that of the doubles themselves, whose steps shrink towards zero, so that ends still are
//! centers and pixels still tile the plane. The bound holds. But a pixel at a large coordinate may
//! bend a line across the small pixel of an end nearer to zero without meeting it. There parts may
//! still cross, and are arranged [again](Arrangement::crossing_free), with up to half a unit more
//! of displacement.
//!
//! *What stays.* A segment that crosses nothing, and does not come near a site at which another one
//! is bent, is not changed, however close it passes by an end. Unless it is to be
//! [snapped](Arrangement::with_snapped): then it is routed through every center whose pixel it
//! meets, so that lines within a rounding of it become parts of it.
//!
//! The result is a function of the set of segments: it does not depend on their order.

mod boxes;
mod builder;
mod order;
mod pixel;
mod result;
mod rounder;
mod segment;
mod sweep;

pub use result::{Arrangement, Crossing};
pub(crate) use rounder::{Rounder, crosses, is_aligned, is_ordinary, step_at};

use rustc_hash::FxHashMap;

use crate::kernel::{Adaptive, Wide};
use crate::num::unsigned_zero;
use builder::Builder;
use pixel::Grid;
use segment::{Segment, Site, SiteOf};

impl Arrangement {
    /// Arranges segments between given sites. A segment is a pair of site numbers below
    /// `given_count`.
    ///
    /// Given sites are all different, their coordinates finite and multiples of `step`, a power of
    /// two or zero; the coordinates of added sites will be multiples of it, too. Segments are all
    /// different; one from a site to itself counts as none. A given site that is no end of a
    /// segment has an effect only if it lies exactly on a segment that is bent: the segment is
    /// routed through it.
    ///
    /// # Complexity
    /// O((n + k) log n) to find the k pairs that cross among n segments. Routing segments through
    /// sites takes about as much in practice.
    pub fn new(
        given_count: usize,
        site_of: impl Fn(u32) -> Site + Sync,
        segments: &[[u32; 2]],
        step: f64,
    ) -> Self {
        Self::arrange(given_count, &site_of, segments, 0, step)
    }

    /// Like [`new`](Self::new), but the first `snapped` segments are routed through all sites whose
    /// pixels they meet, even if they cross nothing. The other segments are routed through an end
    /// of a snapped segment if they meet its pixel.
    ///
    /// # Complexity
    /// That of [`new`](Self::new).
    pub fn with_snapped(
        given_count: usize,
        site_of: impl Fn(u32) -> Site + Sync,
        segments: &[[u32; 2]],
        snapped: usize,
        step: f64,
    ) -> Self {
        Self::arrange(given_count, &site_of, segments, snapped, step)
    }

    fn arrange(
        given_count: usize,
        site_of: &SiteOf<'_>,
        segments: &[[u32; 2]],
        snapped: usize,
        step: f64,
    ) -> Self {
        let mut drawn: Vec<Segment> = segments.iter().map(|ends| ends.map(site_of)).collect();
        let larger = |sum: Site, p: &Site| [sum[0].max(p[0].abs()), sum[1].max(p[1].abs())];
        let largest = drawn.as_flattened().iter().fold([0.0; 2], larger);
        // Half of the smallest subnormal number is zero: scale away from there, by a power of two.
        const UP: f64 = f64::from_bits((1023 + 400) << 52);
        let scale: Site = largest.map(|x| if x < 1.0 / UP { UP } else { 1.0 });
        // Normalizes the sign of zero.
        let scaled = |p: Site| {
            [
                unsigned_zero(p[0] * scale[0]),
                unsigned_zero(p[1] * scale[1]),
            ]
        };
        let site_of = |i: u32| scaled(site_of(i));
        drawn
            .as_flattened_mut()
            .iter_mut()
            .for_each(|p| *p = scaled(*p));
        let smallest = scale.map(|s| step.max(f64::from_bits(1)) * s);
        // Sites on segments count like ends, once they are known.
        let mut on_segments: Vec<u32> = Vec::new();
        let mut arrangement = loop {
            let others: Vec<Site> = on_segments.iter().map(|&site| site_of(site)).collect();
            let grid = Grid::through(scaled(largest), smallest, [drawn.as_flattened(), &others]);
            let builder = Builder::new(grid, given_count, &site_of, segments, snapped, &drawn);
            let arrangement = if grid.is_ordinary {
                builder.run::<Adaptive>()
            } else {
                builder.run::<Wide>()
            };
            let before = on_segments.len();
            let given = arrangement
                .chain_sites
                .iter()
                .filter(|&&site| (site as usize) < given_count);
            on_segments.extend(given.filter(|&&site| !grid.has(site_of(site))));
            if on_segments.len() == before {
                break arrangement;
            }
        };
        for axis in 0..2 {
            arrangement.unit[axis] /= scale[axis];
            arrangement
                .added
                .iter_mut()
                .for_each(|p| p[axis] /= scale[axis]);
        }
        arrangement
    }

    /// Arranges the parts of an arrangement of these segments again, until none cross.
    ///
    /// Only off the even grid can parts cross. They are split by the same rule, and displaced by up
    /// to half a unit more each time.
    ///
    /// It terminates. The sites of a segment are ordered on both axes, those of its parts lie
    /// between their ends, and a box contains finitely many sites. Of two parts that cross, at
    /// least one is divided: they have no common end, so the site of the crossing is an end of at
    /// most one of them.
    ///
    /// # Complexity
    /// That of the arrangement for each round. There are one or two rounds, unless coordinates span
    /// hundreds of powers of two.
    #[must_use]
    pub fn crossing_free(
        mut self,
        site_of: impl Fn(u32) -> Site + Sync,
        segments: &[[u32; 2]],
        step: f64,
    ) -> Self {
        while self.again(&site_of, segments, step) {}
        self
    }

    /// Arranges the parts once more; returns false if none cross.
    fn again(&mut self, site_of: &SiteOf<'_>, segments: &[[u32; 2]], step: f64) -> bool {
        let row = |i: usize| {
            let [a, b] = segments[i];
            let sites = std::iter::once(a)
                .chain(self.chain(i as u32).iter().copied())
                .chain([b]);
            sites.collect::<Vec<u32>>()
        };
        let mut parts: Vec<[u32; 2]> = (0..segments.len())
            .flat_map(|i| {
                row(i)
                    .windows(2)
                    .map(|ends| [ends[0].min(ends[1]), ends[0].max(ends[1])])
                    .collect::<Vec<_>>()
            })
            .collect();
        parts.sort_unstable();
        parts.dedup();
        let site = |i: u32| match (i as usize).checked_sub(self.given_count) {
            None => site_of(i),
            Some(added) => self.added[added],
        };
        let inner =
            Arrangement::arrange(self.given_count + self.added.len(), &site, &parts, 0, step);
        if inner.crossings.is_empty() {
            return false;
        }
        let mut chains = FxHashMap::default();
        let mut chain_sites = Vec::new();
        for i in 0..segments.len() {
            let from = chain_sites.len() as u32;
            let mut has_chain = self.has_chain(i as u32);
            for ends in row(i).windows(2) {
                let part = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                let at = parts.partition_point(|other| *other < part) as u32;
                has_chain |= inner.has_chain(at);
                let chain = inner.chain(at);
                if ends[0] == part[0] {
                    chain_sites.extend(chain);
                } else {
                    chain_sites.extend(chain.iter().rev());
                }
                chain_sites.push(ends[1]);
            }
            chain_sites.truncate(chain_sites.len().saturating_sub(1).max(from as usize));
            if has_chain {
                chains.insert(i as u32, from..chain_sites.len() as u32);
            }
        }
        self.added.extend(inner.added);
        (self.chains, self.chain_sites) = (chains, chain_sites);
        true
    }
}

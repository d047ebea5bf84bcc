//! The phases of an arrangement: pairs that cross, sites, passes, chains.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

use rustc_hash::FxHashMap;

use crate::kernel::{Kernel, Orientation2};
use crate::num::Sign;
use crate::parallel::*;

use super::boxes::{Box2, BoxTree};
use super::pixel::Grid;
use super::result::{Arrangement, Crossing, starts};
use super::segment::{FEW, Segment, Site, SiteOf, lexicographic};
use super::sweep;

/// A segment that is routed through a site.
#[derive(Debug, Clone, Copy)]
struct SegmentAtSite {
    segment: u32,
    site: u32,
    /// True if the site is known to lie on the segment exactly; never for added sites.
    exact: bool,
}

pub(super) struct Builder<'a> {
    grid: Grid,
    given_count: usize,
    site_of: &'a SiteOf<'a>,
    ends: &'a [[u32; 2]],
    /// The number of segments, the first ones, that are routed through all pixels that they meet,
    /// even if no other segment bends them.
    snapped: usize,
    segments: &'a [Segment],
    /// The area of a box that many of the segments would overlap, if they were spread evenly.
    large: f64,
    /// True if many boxes overlap though the segments do not cross.
    is_crowded: bool,
    added: Vec<Site>,
    /// The segments whose crossing was rounded to an added site, each once, grouped by site; and
    /// where each site's segments end.
    crossed: Vec<u32>,
    crossed_ends: Vec<u32>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(
        grid: Grid,
        given_count: usize,
        site_of: &'a SiteOf<'a>,
        ends: &'a [[u32; 2]],
        snapped: usize,
        segments: &'a [Segment],
    ) -> Self {
        const MANY: f64 = 8.0;
        let whole = segments.iter().fold(Box2::NOTHING, |sum, &segment| {
            sum.with(&Box2::around(segment))
        });
        let large = MANY * whole.area() / segments.len() as f64;
        Builder {
            grid,
            given_count,
            site_of,
            ends,
            snapped,
            segments,
            large,
            is_crowded: false,
            added: Vec::new(),
            crossed: Vec::new(),
            crossed_ends: Vec::new(),
        }
    }

    pub(super) fn run<K: Kernel>(mut self) -> Arrangement {
        let pairs = self.crossing_pairs::<K>();
        let crossings = self.round::<K>(pairs);
        let (has_chain, passes) = self.route::<K>(&crossings);
        self.collect(crossings, &has_chain, passes)
    }

    fn site(&self, site: u32) -> Site {
        match (site as usize).checked_sub(self.given_count) {
            None => (self.site_of)(site),
            Some(added) => self.added[added],
        }
    }

    /// Returns a tree over some segments, which numbers them by their position in the list.
    fn tree(&self, segments: impl Iterator<Item = u32>) -> BoxTree {
        let boxes: Vec<Box2> = segments
            .map(|i| Box2::around(self.segments[i as usize]))
            .collect();
        BoxTree::new(&boxes)
    }

    /// Returns the ends of all segments, and the sites of crossings, each once.
    fn hot_sites(&self, crossings: &[Crossing]) -> Vec<u32> {
        let mut sites: Vec<u32> = self.ends.iter().flatten().copied().collect();
        sites.extend(crossings.iter().map(|crossing| crossing.site));
        sites.par_sort_unstable();
        sites.dedup();
        sites
    }

    /// Phase 1: returns the pairs of segments that cross in their interiors.
    fn crossing_pairs<K: Kernel>(&mut self) -> Vec<[u32; 2]> {
        if self.segments.len() <= FEW {
            return self.crossing_pairs_of_few::<K>();
        }
        let number = |[i, j]: [u32; 2]| u64::from(i) << 32 | u64::from(j);
        let mut pairs = self
            .crossing_pairs_by_boxes::<K>(number)
            .unwrap_or_else(|| {
                self.is_crowded = true;
                sweep::crossing_pairs::<K>(self.segments)
                    .into_iter()
                    .map(number)
                    .collect()
            });
        pairs.par_sort_unstable(); // as one number: half the time of two
        pairs
            .into_iter()
            .map(|pair| [(pair >> 32) as u32, pair as u32])
            .collect()
    }

    /// Returns the pairs that cross, each as one number, in no order; `None` as soon as too many
    /// boxes have overlapped in vain.
    ///
    /// `PERF:` takes half the time of the sweep, on one thread, for segments that are short or
    /// cross most of what they come near.
    fn crossing_pairs_by_boxes<K: Kernel>(
        &self,
        number: impl Fn([u32; 2]) -> u64 + Sync,
    ) -> Option<Vec<u64>> {
        /// The number of overlaps without a crossing, for each segment and each pair found, that
        /// take about as long as the sweep.
        const PATIENCE: usize = 64;
        const CHUNK: usize = 64;
        let tree = self.tree(0..self.segments.len() as u32);
        let (asked, allowed) = (
            AtomicUsize::new(0),
            AtomicUsize::new(PATIENCE * self.segments.len()),
        );
        // Once true, it stays true: pairs that other threads find later do not bring back those
        // that were skipped.
        let is_given_up = AtomicBool::new(false);
        let of_chunk = |(chunk, leaves): (usize, &[u32])| {
            let (mut found, mut count) = (Vec::new(), 0);
            for (at, &i) in (chunk * CHUNK + 1..).zip(leaves) {
                if is_given_up.load(Relaxed) || asked.load(Relaxed) > allowed.load(Relaxed) {
                    is_given_up.store(true, Relaxed);
                    break;
                }
                let s = self.segments[i as usize];
                let before = (found.len(), count);
                tree.visit_from(at, self.along(i), &mut |j| {
                    count += 1;
                    if cross::<K>(s, self.segments[j as usize]) {
                        found.push(number([i.min(j), i.max(j)]));
                    }
                });
                asked.fetch_add(count - before.1, Relaxed);
                allowed.fetch_add(PATIENCE * (found.len() - before.0), Relaxed);
            }
            found
        };
        let chunks = tree
            .order()
            .par_chunks(CHUNK)
            .enumerate()
            .with_min_len(FEW / CHUNK);
        let pairs = chunks.flat_map_iter(of_chunk).collect();
        (!is_given_up.into_inner()).then_some(pairs)
    }

    /// Phase 1 for few segments: from left to right, tests each against those that begin before it
    /// ends.
    ///
    /// `PERF:` for 141 segments of a coast, 90 000 instructions instead of 250 000 with a tree,
    /// which has to be built first.
    fn crossing_pairs_of_few<K: Kernel>(&self) -> Vec<[u32; 2]> {
        let mut boxes: Vec<(Box2, u32)> = self
            .segments
            .iter()
            .map(|&s| Box2::around(s))
            .zip(0..)
            .collect();
        boxes.sort_unstable_by(|(p, i), (q, j)| p.min[0].total_cmp(&q.min[0]).then(i.cmp(j)));
        let mut pairs = Vec::new();
        for (at, (boxed, i)) in boxes.iter().enumerate() {
            let beside = boxes[at + 1..]
                .iter()
                .take_while(|(other, _)| other.min[0] <= boxed.max[0]);
            for (_, j) in beside.filter(|(other, _)| other.overlaps(boxed)) {
                if cross::<K>(self.segments[*i as usize], self.segments[*j as usize]) {
                    pairs.push([*i.min(j), *i.max(j)]);
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    /// Phase 2: returns the crossings with their sites, which are the centers of their pixels. A
    /// center may be a given site; others are added.
    fn round<K: Kernel>(&mut self, pairs: Vec<[u32; 2]>) -> Vec<Crossing> {
        let round = |&[i, j]: &[u32; 2]| {
            self.grid
                .crossing::<K>(self.segments[i as usize], self.segments[j as usize])
        };
        let rounded: Vec<Site> = pairs.par_iter().with_min_len(FEW).map(round).collect();
        let mut given_at: FxHashMap<[u64; 2], Option<u32>> =
            rounded.iter().map(|&center| (key(center), None)).collect();
        if !given_at.is_empty() {
            for site in 0..self.given_count as u32 {
                if let Some(at) = given_at.get_mut(&key((self.site_of)(site))) {
                    *at = Some(site);
                }
            }
        }
        let mut centers: Vec<(Site, u32)> = Vec::new();
        let mut crossings = Vec::with_capacity(pairs.len());
        for (segments, center) in pairs.into_iter().zip(rounded) {
            let given = given_at[&key(center)];
            centers.extend(given.is_none().then_some((center, crossings.len() as u32)));
            crossings.push(Crossing {
                segments,
                site: given.unwrap_or(u32::MAX),
            });
        }
        centers.par_sort_unstable_by(|(p, i), (q, j)| lexicographic(*p, *q).then(i.cmp(j)));
        let mut here: Vec<u32> = Vec::new();
        for same in centers.chunk_by(|(p, _), (q, _)| p == q) {
            let site = (self.given_count + self.added.len()) as u32;
            here.clear();
            for &(_, crossing) in same {
                crossings[crossing as usize].site = site;
                here.extend(crossings[crossing as usize].segments);
            }
            // Two crossings of one segment may have been rounded to one site.
            here.sort_unstable();
            here.dedup();
            self.added.push(same[0].0);
            self.crossed.extend(&here);
            self.crossed_ends.push(self.crossed.len() as u32);
        }
        crossings
    }

    /// Phase 3: routes the segments that cross others, and those to be snapped, through all sites
    /// whose pixels they meet. Then, until there are no more, those that meet the pixel of a site
    /// at which another one was bent, or of an end of a snapped one.
    fn route<K: Kernel>(&self, crossings: &[Crossing]) -> (Vec<bool>, Vec<SegmentAtSite>) {
        if crossings.is_empty() && self.snapped == 0 {
            return (vec![false; self.segments.len()], Vec::new());
        }
        let mut is_hot = vec![false; self.given_count + self.added.len()];
        let sites = self.hot_sites(crossings);
        sites.iter().for_each(|&site| is_hot[site as usize] = true);
        let mut hot = vec![self.pixels(sites)];
        let mut is_active = vec![false; is_hot.len()];
        self.ends[..self.snapped]
            .as_flattened()
            .iter()
            .for_each(|&site| is_active[site as usize] = true);
        let mut has_chain = vec![false; self.segments.len()];
        let mut routed: Vec<u32> = Vec::new();
        let mut fresh: Vec<u32> = crossings
            .iter()
            .flat_map(|crossing| crossing.segments)
            .chain(0..self.snapped as u32)
            .collect();
        fresh.par_sort_unstable();
        fresh.dedup();
        let mut passes = self.passes_of_crossings();
        let mut known = 0;
        while !fresh.is_empty() {
            fresh.iter().for_each(|&i| has_chain[i as usize] = true);
            self.pass::<K>(&fresh, &hot, &mut passes);
            // Given sites that lie on a segment that may bend are kept on it.
            let heated = self.sites_exactly_on::<K>(&fresh, |site| !is_hot[site as usize]);
            heated.iter().for_each(|&site| is_hot[site as usize] = true);
            routed.append(&mut fresh);
            hot.push(self.pixels(heated));
            self.pass::<K>(&routed, &hot[hot.len() - 1..], &mut passes);
            // What was bent may bend others.
            passes[known..]
                .iter()
                .filter(|pass| !pass.exact)
                .for_each(|pass| is_active[pass.site as usize] = true);
            known = passes.len();
            let straight = (0..self.segments.len() as u32)
                .into_par_iter()
                .with_min_len(4096);
            let is_bent = |&i: &u32| {
                let mut is_bent = false;
                if !has_chain[i as usize] {
                    self.sites_on::<K>(i, &hot, |site| is_bent |= is_active[site as usize]);
                }
                is_bent
            };
            fresh = straight.filter(is_bent).collect();
        }
        (has_chain, passes)
    }

    /// Returns the passes of segments through the sites of their crossings.
    fn passes_of_crossings(&self) -> Vec<SegmentAtSite> {
        let sites = (self.given_count..self.given_count + self.added.len()).map(|site| site as u32);
        let here = |site| {
            self.crossed_at(site)
                .iter()
                .map(move |&segment| SegmentAtSite {
                    segment,
                    site,
                    exact: false,
                })
        };
        sites.flat_map(here).collect()
    }

    /// Returns a tree over the pixels of some sites.
    fn pixels(&self, sites: Vec<u32>) -> (BoxTree, Vec<u32>) {
        let boxes: Vec<Box2> = sites
            .par_iter()
            .with_min_len(FEW)
            .map(|&site| self.grid.around(self.site(site)))
            .collect();
        (BoxTree::new(&boxes), sites)
    }

    /// Returns a test for boxes that a segment may meet; for a long segment, it also rejects those
    /// on one side of it.
    ///
    /// `PERF:` for a short segment the side test rejects little, and costs more than all of the
    /// rest. Without it there, 50 000 segments between a million points take 18 ms instead of 30,
    /// and 100 000 that cross take 13 % less in total.
    fn along(&self, segment: u32) -> impl Fn(&Box2) -> bool + use<'a> {
        let s = self.segments[segment as usize];
        let around = Box2::around(s);
        let has_sides = self.grid.is_ordinary && (self.is_crowded || around.area() >= self.large);
        move |boxed| around.overlaps(boxed) & !(has_sides && boxed.is_beside(s))
    }

    /// Calls `visit` with each site in some trees whose pixel a segment meets, except for its ends
    /// and for sites added for its own crossings.
    fn sites_on<K: Kernel>(
        &self,
        segment: u32,
        trees: &[(BoxTree, Vec<u32>)],
        mut visit: impl FnMut(u32),
    ) {
        let is_met = self.along(segment);
        for (tree, sites) in trees {
            tree.visit(&is_met, |member| {
                let site = sites[member as usize];
                let is_known = self.ends[segment as usize].contains(&site)
                    || self.crossed_at(site).contains(&segment);
                if !is_known
                    && self
                        .grid
                        .hits::<K>(self.segments[segment as usize], self.site(site))
                {
                    visit(site);
                }
            });
        }
    }

    /// Adds the passes of some segments through the sites of some trees.
    fn pass<K: Kernel>(
        &self,
        segments: &[u32],
        trees: &[(BoxTree, Vec<u32>)],
        passes: &mut Vec<SegmentAtSite>,
    ) {
        let of_segments = |segments: &[u32]| {
            let mut found = Vec::new();
            for &segment in segments {
                let [a, b] = self.segments[segment as usize];
                self.sites_on::<K>(segment, trees, |site| {
                    let is_given = (site as usize) < self.given_count;
                    let exact =
                        is_given && K::sign(&Orientation2([a, b, self.site(site)])) == Sign::Zero;
                    found.push(SegmentAtSite {
                        segment,
                        site,
                        exact,
                    });
                });
            }
            found
        };
        passes.par_extend(
            segments
                .par_chunks(64)
                .with_min_len(FEW / 64)
                .flat_map_iter(of_segments),
        );
    }

    /// Returns the segments whose crossings were rounded to an added site; each of them is routed
    /// through it.
    fn crossed_at(&self, site: u32) -> &[u32] {
        let Some(added) = (site as usize).checked_sub(self.given_count) else {
            return &[];
        };
        let from = if added == 0 {
            0
        } else {
            self.crossed_ends[added - 1] as usize
        };
        &self.crossed[from..self.crossed_ends[added] as usize]
    }

    /// Returns the given sites that lie exactly on one of some segments, in order.
    fn sites_exactly_on<K: Kernel>(
        &self,
        segments: &[u32],
        is_asked: impl Fn(u32) -> bool + Sync,
    ) -> Vec<u32> {
        let sites = (0..self.given_count as u32)
            .into_par_iter()
            .with_min_len(4096);
        if !self.is_crowded {
            let tree = self.tree(segments.iter().copied());
            return sites
                .filter(|&site| is_asked(site) && self.is_on_one::<K>(site, &tree, segments))
                .collect();
        }
        // A site is in many boxes, but on few segments: look for the sites on each segment instead.
        let sites: Vec<u32> = sites.filter(|&site| is_asked(site)).collect();
        let boxes: Vec<Box2> = sites
            .iter()
            .map(|&site| Box2::around([self.site(site); 2]))
            .collect();
        let tree = BoxTree::new(&boxes);
        let on_segment = |&segment: &u32| {
            let mut found = Vec::new();
            let [a, b] = self.segments[segment as usize];
            tree.visit(self.along(segment), |member| {
                let site = sites[member as usize];
                if K::sign(&Orientation2([a, b, self.site(site)])) == Sign::Zero {
                    found.push(site);
                }
            });
            found
        };
        let mut on: Vec<u32> = segments
            .par_iter()
            .with_min_len(FEW)
            .flat_map_iter(on_segment)
            .collect();
        on.par_sort_unstable();
        on.dedup();
        on
    }

    /// Returns true if a site lies exactly on a segment of the tree.
    fn is_on_one<K: Kernel>(&self, site: u32, tree: &BoxTree, members: &[u32]) -> bool {
        let at = self.site(site);
        let mut is_on = false;
        let here = Box2::around([at, at]);
        tree.visit(
            |boxed| boxed.overlaps(&here),
            |member| {
                let [a, b] = self.segments[members[member as usize] as usize];
                is_on = is_on || K::sign(&Orientation2([a, b, at])) == Sign::Zero;
            },
        );
        is_on
    }

    /// Phase 4: returns the arrangement, with the sites of each segment in order.
    fn collect(
        self,
        crossings: Vec<Crossing>,
        has_chain: &[bool],
        passes: Vec<SegmentAtSite>,
    ) -> Arrangement {
        let along = |segment: u32, site: u32| {
            self.grid.along(self.segments[segment as usize])(self.site(site))
        };
        // Grouped by segment, by counting; then each group is sorted along its segment.
        let mut ends = vec![0; self.segments.len()];
        passes
            .iter()
            .for_each(|pass| ends[pass.segment as usize] += 1);
        starts(&mut ends);
        let mut ordered = vec![([0.0; 2], 0); passes.len()];
        for SegmentAtSite { segment, site, .. } in passes {
            let end = &mut ends[segment as usize];
            ordered[*end as usize] = (along(segment, site), site);
            *end += 1;
        }
        let mut rest = &mut ordered[..];
        let mut from = 0;
        let mut chains = FxHashMap::default();
        let mut rows = Vec::new();
        for (segment, &end) in (0..)
            .zip(&ends)
            .filter(|(segment, _)| has_chain[*segment as usize])
        {
            let (row, others) = rest.split_at_mut((end - from) as usize);
            rest = others;
            rows.push((segment, row));
            chains.insert(segment, from..end);
            from = end;
        }
        rows.into_par_iter().with_min_len(FEW).for_each(
            |(segment, row): (u32, &mut [(Site, u32)])| {
                row.sort_unstable_by(|(p, _), (q, _)| lexicographic(*p, *q));
                let [a, b] = self.segments[segment as usize];
                if lexicographic(a, b).is_gt() {
                    row.reverse();
                }
            },
        );
        let chain_sites = ordered.into_iter().map(|(_, site)| site).collect();
        let on_grid = self.grid.is_even;
        Arrangement {
            unit: self.grid.unit,
            on_grid,
            given_count: self.given_count,
            added: self.added,
            crossings,
            chains,
            chain_sites,
        }
    }
}

/// Returns true if two segments cross in their interiors.
#[inline]
pub(super) fn cross<K: Kernel>([a, b]: Segment, [c, d]: Segment) -> bool {
    let apart = |p, q, r, s| {
        K::sign(&Orientation2([p, q, r])) * K::sign(&Orientation2([p, q, s])) == Sign::Negative
    };
    apart(a, b, c, d) && apart(c, d, a, b)
}

/// Returns the bits of a site as a hash key. Equal sites have equal keys, since zeros have one
/// sign.
fn key(site: Site) -> [u64; 2] {
    site.map(f64::to_bits)
}

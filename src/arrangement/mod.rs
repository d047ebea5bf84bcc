//! Segments that cross, made into segments that meet at common ends only: snap rounding.
//!
//! Where two segments cross, coordinates of doubles do not reach: the place must be rounded, both lines bend there a
//! little, and may so cross others anew. *Snap rounding* (Hobby 1999; Guibas and Marimont 1998) ends that at once:
//! the crossings of the **original** segments are rounded, once, to the centers of the pixels of a grid; and every
//! segment that meets the pixel of such a center, or of an end of a segment, is led through that center. Then no two
//! of the pieces cross.
//!
//! *Why.* Let a piece lead from center `A` to center `B`, and let `C` be a center in whose pixel the segment `s` has
//! no point. `A` and `B` lie in `s - Q`, where `Q` is a pixel around zero, and so does all of `A B`, since that set is
//! convex; `C` does not. On its way from `s` to `A B` the line therefore never passes over a center that it is not
//! led through, and lines that do not cross at first can cross at last only by passing over an end of one of them.
//!
//! *The grid.* The unit on each axis is that of the last place of the largest coordinate there, of all ends of
//! segments. Ends that are multiples of it are centers of pixels themselves, pixels do not overlap, and the argument
//! above holds without a gap: **no point of a line is displaced by more than half a unit on each axis**.
//!
//! Ends may be finer than that, when coordinates near zero and large ones come together. The grid is then that of the doubles
//! themselves, whose steps shrink towards zero, so that ends still are centers and pixels still do not overlap. The
//! bound holds. But a pixel at a large coordinate may bend a line across the small pixel of an end nearer to zero without
//! meeting it: there pieces may cross after all (and where ends lie closer together than 2^-60 of the unit, which is the
//! smallest step). The pieces are then arranged [again](Arrangement::again), with up to another half unit of displacement.
//!
//! *What stays.* A segment that crosses nothing, and comes near nothing that another one is bent by, is not touched,
//! however close it passes by an end: nothing forces it.
//!
//! The result is a function of the set of segments: no order shows.

mod boxes;
mod pixel;

use std::ops::Range;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::kernel::{Adaptive, Kernel, Orientation2, Wide};
use crate::num::Sign;
use boxes::{Box2, BoxTree};
use pixel::Grid;

type Place = [f64; 2];
type Segment = [Place; 2];

/// Two segments that cross in their interiors, by their numbers, and the site to which the crossing was rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// The segments, the smaller number first.
    pub segments: [u32; 2],
    /// The site.
    pub site: u32,
}

/// The arrangement of some segments, rounded.
///
/// *Sites* are numbered: first the places that were given, then those that were added.
#[derive(Debug, Clone)]
pub struct Arrangement {
    unit: [f64; 2],
    on_grid: bool,
    places: usize,
    added: Vec<Place>,
    crossings: Vec<Crossing>,
    /// Of the segments that may bend: the sites between their ends.
    chains: FxHashMap<u32, Range<u32>>,
    chain_sites: Vec<u32>,
}

impl Arrangement {
    /// Arranges segments between places, given by their numbers below `places`, which are all different. Of the places
    /// that are no end of a segment, those count that lie exactly on a segment that is bent: it is led through them.
    ///
    /// All coordinates are finite. Segments are different; one from a place to itself is none.
    ///
    /// # Complexity
    /// O(n log n + k) in practice for n segments and places and k pairs of segments whose boxes overlap; quadratic at the
    /// worst, for long lines side by side across the axes.
    pub fn new(places: usize, place: impl Fn(u32) -> Place + Sync, segments: &[[u32; 2]]) -> Self {
        let largest = segments.iter().flatten().fold([0.0f64; 2], |largest, &i| {
            let p = place(i);
            [largest[0].max(p[0].abs()), largest[1].max(p[1].abs())]
        });
        // Half of the smallest subnormal number is none: away from there, by a power of two.
        const UP: f64 = f64::from_bits((1023 + 400) << 52);
        const SMALLEST: f64 = f64::from_bits(1);
        let scale: Place = largest.map(|x| if x < 1.0 / UP { UP } else { 1.0 });
        // Zero has one sign only.
        let scaled = |p: Place| [p[0] * scale[0] + 0.0, p[1] * scale[1] + 0.0];
        let place = |i: u32| scaled(place(i));
        let ends = || segments.iter().flatten().map(|&i| place(i));
        let grid = Grid::through(scaled(largest), scaled([SMALLEST; 2]), ends());
        let mut arrangement = if grid.is_ordinary {
            Builder::new(grid, places, &place, segments).run::<Adaptive>()
        } else {
            Builder::new(grid, places, &place, segments).run::<Wide>()
        };
        for axis in 0..2 {
            arrangement.unit[axis] /= scale[axis];
            arrangement.added.iter_mut().for_each(|p| p[axis] /= scale[axis]);
        }
        arrangement
    }

    /// Arranges the pieces of an arrangement of these segments: where they cross, which they can off the even grid only, they
    /// are split by the same rule, and displaced by up to another half a unit.
    ///
    /// Done again and again, it comes to an end. Sites of a segment come in order on both axes, those of its pieces lie
    /// between their ends, and there are finitely many places in a box. Of two pieces that cross at least one is divided:
    /// they have no common end, so the site of the crossing is an end of one of them at most.
    #[must_use]
    pub fn again(mut self, place: impl Fn(u32) -> Place + Sync, segments: &[[u32; 2]]) -> Self {
        let row = |i: usize| {
            let [a, b] = segments[i];
            let sites = std::iter::once(a).chain(self.chain(i as u32).iter().copied()).chain([b]);
            sites.collect::<Vec<u32>>()
        };
        let mut pieces: Vec<[u32; 2]> = (0..segments.len())
            .flat_map(|i| {
                row(i).windows(2).map(|ends| [ends[0].min(ends[1]), ends[0].max(ends[1])]).collect::<Vec<_>>()
            })
            .collect();
        pieces.sort_unstable();
        pieces.dedup();
        let site = |i: u32| match (i as usize).checked_sub(self.places) {
            None => place(i),
            Some(added) => self.added[added],
        };
        let inner = Arrangement::new(self.places + self.added.len(), site, &pieces);
        let mut chains = FxHashMap::default();
        let mut chain_sites = Vec::new();
        for i in 0..segments.len() {
            let from = chain_sites.len() as u32;
            let mut is_led = self.is_led(i as u32);
            for ends in row(i).windows(2) {
                let piece = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                let at = pieces.partition_point(|other| *other < piece) as u32;
                is_led |= inner.is_led(at);
                let chain = inner.chain(at);
                if ends[0] == piece[0] {
                    chain_sites.extend(chain);
                } else {
                    chain_sites.extend(chain.iter().rev());
                }
                chain_sites.push(ends[1]);
            }
            chain_sites.truncate(chain_sites.len().saturating_sub(1).max(from as usize));
            if is_led {
                chains.insert(i as u32, from..chain_sites.len() as u32);
            }
        }
        self.added.extend(inner.added);
        (self.chains, self.chain_sites) = (chains, chain_sites);
        self
    }

    /// The grid's unit on each axis: a power of two.
    pub fn unit(&self) -> [f64; 2] {
        self.unit
    }

    /// Whether all ends of segments are multiples of the unit, so that the pieces are proven not to cross.
    pub fn is_on_grid(&self) -> bool {
        self.on_grid
    }

    /// The sites that were added: distinct.
    pub fn added(&self) -> &[Place] {
        &self.added
    }

    /// Every pair of segments that cross in their interiors, in order.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// Whether a segment crosses others, or comes near what they are bent by; so that it is led through all sites whose
    /// pixels it meets, and through the places on it.
    pub fn is_led(&self, segment: u32) -> bool {
        self.chains.contains_key(&segment)
    }

    /// The sites that a segment is led through between its ends, in the order from its first to its second. (Beside
    /// them, it passes exactly through the places that lie on its pieces.)
    pub fn chain(&self, segment: u32) -> &[u32] {
        self.chains.get(&segment).map_or(&[], |range| &self.chain_sites[range.start as usize..range.end as usize])
    }

    /// Of every added site, the segments that are led through it: pairs of site and segment, in order.
    pub fn through_added(&self) -> Vec<(u32, u32)> {
        let given = self.places as u32;
        let mut through = Vec::new();
        for (&segment, range) in &self.chains {
            let sites = &self.chain_sites[range.start as usize..range.end as usize];
            through.extend(sites.iter().filter(|&&site| site >= given).map(|&site| (site, segment)));
        }
        through.par_sort_unstable();
        through
    }
}

/// The part for one site of such pairs.
pub fn through_site(through: &[(u32, u32)], site: u32) -> &[(u32, u32)] {
    let first = through.partition_point(|&(other, _)| other < site);
    let count = through[first..].partition_point(|&(other, _)| other == site);
    &through[first..first + count]
}

/// A segment that is led through a site.
#[derive(Debug, Clone, Copy)]
struct Pass {
    segment: u32,
    site: u32,
    /// Whether the site is known to lie on the segment exactly; of those that were added, none is.
    exact: bool,
}

struct Builder<'a, F> {
    grid: Grid,
    places: usize,
    place: &'a F,
    ends: &'a [[u32; 2]],
    segments: Vec<Segment>,
    added: Vec<Place>,
    /// The segments whose crossing was rounded to an added site, site after site, and where those of each end.
    crossed: Vec<u32>,
    crossed_ends: Vec<u32>,
}

impl<'a, F: Fn(u32) -> Place + Sync> Builder<'a, F> {
    fn new(grid: Grid, places: usize, place: &'a F, ends: &'a [[u32; 2]]) -> Self {
        let segments = ends.iter().map(|&[a, b]| [place(a), place(b)]).collect();
        Builder {
            grid,
            places,
            place,
            ends,
            segments,
            added: Vec::new(),
            crossed: Vec::new(),
            crossed_ends: Vec::new(),
        }
    }

    fn run<K: Kernel>(mut self) -> Arrangement {
        let tree = self.tree(0..self.segments.len() as u32);
        let pairs = self.crossing_pairs::<K>(&tree);
        let vertices = if pairs.is_empty() { Vec::new() } else { self.vertices() };
        let crossings = self.round::<K>(pairs, &vertices);
        let (led, passes) = self.lead::<K>(&crossings, vertices);
        self.collect(crossings, &led, passes)
    }

    fn site(&self, site: u32) -> Place {
        match (site as usize).checked_sub(self.places) {
            None => (self.place)(site),
            Some(added) => self.added[added],
        }
    }

    /// A tree over some segments, by their position in the list.
    fn tree(&self, segments: impl Iterator<Item = u32>) -> BoxTree {
        let boxes: Vec<Box2> = segments.map(|i| Box2::around(self.segments[i as usize])).collect();
        BoxTree::new(&boxes)
    }

    /// The ends of all segments, each once.
    fn vertices(&self) -> Vec<u32> {
        let mut vertices: Vec<u32> = self.ends.iter().flatten().copied().collect();
        vertices.par_sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Phase 1: the pairs of segments that cross in their interiors.
    fn crossing_pairs<K: Kernel>(&self, tree: &BoxTree) -> Vec<[u32; 2]> {
        let of_leaf = |(at, &i): (usize, &u32)| {
            let mut found = Vec::new();
            let s = self.segments[i as usize];
            tree.overlapping_from(at + 1, &Box2::around(s), &mut |j| {
                if cross::<K>(s, self.segments[j as usize]) {
                    found.push([i.min(j), i.max(j)]);
                }
            });
            found
        };
        let mut pairs: Vec<[u32; 2]> =
            tree.order().par_iter().enumerate().with_min_len(256).flat_map_iter(of_leaf).collect();
        pairs.par_sort_unstable();
        pairs
    }

    /// Phase 2: the site of each crossing. An end in whose pixel it lies; else the center of its pixel.
    fn round<K: Kernel>(&mut self, pairs: Vec<[u32; 2]>, vertices: &[u32]) -> Vec<Crossing> {
        enum Rounded {
            ToVertex(u32),
            ToCenter(Place),
        }
        let cells = Cells::new(self.grid, vertices, self.place);
        let round = |&segments: &[u32; 2]| {
            let [ab, cd] = segments.map(|i| self.segments[i as usize]);
            let center = self.grid.crossing::<K>(ab, cd);
            // Ends may be finer than the finest step. What lies beyond one would lead the line back.
            let common = Box2::around(ab).common(&Box2::around(cd));
            let holds = |&v: &u32| {
                let at = (self.place)(v);
                common.clamp(at) == at && self.grid.crossing_in::<K>(ab, cd, at)
            };
            // Of several the first in plan, whatever their numbers.
            let by_place = |&u: &u32, &v: &u32| lexicographic((self.place)(u), (self.place)(v));
            let center = common.clamp(center);
            let end = || segments.iter().flat_map(|&i| self.ends[i as usize]).find(|&end| (self.place)(end) == center);
            match cells.near(center).filter(holds).min_by(by_place).or_else(end) {
                Some(vertex) => Rounded::ToVertex(vertex),
                None => Rounded::ToCenter(center),
            }
        };
        let rounded: Vec<Rounded> = pairs.par_iter().with_min_len(256).map(round).collect();
        let mut centers: Vec<(Place, u32)> = Vec::new();
        let mut crossings = Vec::with_capacity(pairs.len());
        for (segments, rounded) in pairs.into_iter().zip(rounded) {
            let site = match rounded {
                Rounded::ToVertex(vertex) => vertex,
                Rounded::ToCenter(center) => {
                    centers.push((center, crossings.len() as u32));
                    u32::MAX
                }
            };
            crossings.push(Crossing { segments, site });
        }
        centers.par_sort_unstable_by(|(p, i), (q, j)| lexicographic(*p, *q).then(i.cmp(j)));
        for (center, crossing) in centers {
            if self.added.last() != Some(&center) {
                self.added.push(center);
                self.crossed_ends.push(0);
            }
            self.crossed.extend(crossings[crossing as usize].segments);
            if let Some(end) = self.crossed_ends.last_mut() {
                *end = self.crossed.len() as u32;
            }
            crossings[crossing as usize].site = (self.places + self.added.len() - 1) as u32;
        }
        crossings
    }

    /// Phase 3: leads the segments that cross others through all sites whose pixels they meet; and, as long as there
    /// are any, those that meet a pixel by which another was bent.
    fn lead<K: Kernel>(&self, crossings: &[Crossing], vertices: Vec<u32>) -> (Vec<u32>, Vec<Pass>) {
        if crossings.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let mut is_hot = vec![false; self.places + self.added.len()];
        let mut sites = vertices;
        sites.extend((self.places..self.places + self.added.len()).map(|site| site as u32));
        sites.iter().for_each(|&site| is_hot[site as usize] = true);
        let mut is_active = vec![false; is_hot.len()];
        let mut is_led = vec![false; self.segments.len()];
        let mut led: Vec<(BoxTree, Vec<u32>)> = Vec::new();
        let mut fresh: Vec<u32> = crossings.iter().flat_map(|crossing| crossing.segments).collect();
        fresh.par_sort_unstable();
        fresh.dedup();
        let mut passes = Vec::new();
        while !fresh.is_empty() {
            fresh.iter().for_each(|&i| is_led[i as usize] = true);
            led.push((self.tree(fresh.iter().copied()), std::mem::take(&mut fresh)));
            let newest = &led[led.len() - 1..];
            let before = passes.len();
            self.pass::<K>(&sites, newest, &mut passes);
            // Places that lie on a segment that may bend are kept on it.
            let cold = (0..self.places as u32).into_par_iter().with_min_len(4096);
            let on = |&site: &u32| !is_hot[site as usize] && self.is_on_one::<K>(site, newest);
            let heated: Vec<u32> = cold.filter(on).collect();
            heated.iter().for_each(|&site| is_hot[site as usize] = true);
            self.pass::<K>(&heated, &led, &mut passes);
            sites.extend(heated);
            // What was bent may bend others.
            let mut bent_by: Vec<u32> =
                passes[before..].iter().filter(|pass| !pass.exact).map(|pass| pass.site).collect();
            bent_by.retain(|&site| !std::mem::replace(&mut is_active[site as usize], true));
            let straight: Vec<u32> = (0..self.segments.len() as u32).filter(|&i| !is_led[i as usize]).collect();
            let rest = self.tree(straight.iter().copied());
            for site in bent_by {
                let at = self.site(site);
                rest.overlapping(&self.grid.around(at), |member| {
                    let i = straight[member as usize];
                    fresh.extend(self.meets::<K>(i, site, at).then_some(i));
                });
            }
            fresh.sort_unstable();
            fresh.dedup();
        }
        (led.into_iter().flat_map(|(_, members)| members).collect(), passes)
    }

    /// Whether a segment meets the pixel of a site that is no end of it.
    fn meets<K: Kernel>(&self, segment: u32, site: u32, at: Place) -> bool {
        !self.ends[segment as usize].contains(&site) && self.grid.hits::<K>(self.segments[segment as usize], at)
    }

    /// Adds what passes through these sites among the segments of some trees.
    fn pass<K: Kernel>(&self, sites: &[u32], trees: &[(BoxTree, Vec<u32>)], passes: &mut Vec<Pass>) {
        let of_sites = |sites: &[u32]| {
            let mut found = Vec::new();
            for &site in sites {
                let at = self.site(site);
                let around = self.grid.around(at);
                let crossed = self.crossed_at(site);
                for (tree, members) in trees {
                    tree.overlapping(&around, |member| {
                        let segment = members[member as usize];
                        if crossed.contains(&segment) {
                            found.push(Pass { segment, site, exact: false });
                        } else if self.meets::<K>(segment, site, at) {
                            let [a, b] = self.segments[segment as usize];
                            let exact = crossed.is_empty() && K::sign(&Orientation2([a, b, at])) == Sign::Zero;
                            found.push(Pass { segment, site, exact });
                        }
                    });
                }
            }
            found
        };
        passes.par_extend(sites.par_chunks(512).flat_map_iter(of_sites));
    }

    /// The segments whose crossings were rounded to an added site: they are led through it, no question.
    fn crossed_at(&self, site: u32) -> &[u32] {
        let Some(added) = (site as usize).checked_sub(self.places) else { return &[] };
        let from = if added == 0 { 0 } else { self.crossed_ends[added - 1] as usize };
        &self.crossed[from..self.crossed_ends[added] as usize]
    }

    /// Whether a place lies on a segment of the trees exactly.
    fn is_on_one<K: Kernel>(&self, site: u32, trees: &[(BoxTree, Vec<u32>)]) -> bool {
        let at = self.site(site);
        let mut is_on = false;
        for (tree, members) in trees {
            tree.overlapping(&Box2::around([at, at]), |member| {
                let [a, b] = self.segments[members[member as usize] as usize];
                is_on = is_on || K::sign(&Orientation2([a, b, at])) == Sign::Zero;
            });
        }
        is_on
    }

    /// Phase 4: the sites of each segment, in order.
    fn collect(self, crossings: Vec<Crossing>, led: &[u32], passes: Vec<Pass>) -> Arrangement {
        // Pixels come in the order of their centers on the axis along which the segment is longer, in units, and in one
        // column from one side to the other.
        let along = |segment: u32, site: u32| {
            let [a, b] = self.segments[segment as usize];
            let (a, b) = if lexicographic(a, b).is_le() { (a, b) } else { (b, a) };
            let at = self.site(site);
            let [dx, dy] = [0, 1].map(|k| b[k] / self.grid.unit[k] - a[k] / self.grid.unit[k]);
            let (first, second) = if dx.abs() >= dy.abs() { (0, 1) } else { (1, 0) };
            [first, second].map(|k| if a[k] <= b[k] { at[k] } else { -at[k] })
        };
        let mut ordered: Vec<(u32, Place, u32)> =
            passes.par_iter().map(|&Pass { segment, site, .. }| (segment, along(segment, site), site)).collect();
        drop(passes);
        ordered.par_sort_unstable_by(|p, q| p.0.cmp(&q.0).then_with(|| lexicographic(p.1, q.1)));
        let mut chains: FxHashMap<u32, Range<u32>> = led.iter().map(|&segment| (segment, 0..0)).collect();
        let mut chain_sites = Vec::with_capacity(ordered.len());
        for passes in ordered.chunk_by(|p, q| p.0 == q.0) {
            let segment = passes[0].0;
            let [a, b] = self.ends[segment as usize].map(|end| along(segment, end));
            let (first, last) = if lexicographic(a, b).is_le() { (a, b) } else { (b, a) };
            let from = chain_sites.len();
            // An end of another segment that is finer than the finest step may stand beyond our own end.
            let is_between = |at: Place| lexicographic(first, at).is_lt() && lexicographic(at, last).is_lt();
            chain_sites.extend(passes.iter().filter(|&&(_, at, _)| is_between(at)).map(|&(_, _, site)| site));
            let [a, b] = self.segments[segment as usize];
            if lexicographic(a, b).is_gt() {
                chain_sites[from..].reverse();
            }
            chains.insert(segment, from as u32..chain_sites.len() as u32);
        }
        let on_grid = self.grid.is_even();
        Arrangement {
            unit: self.grid.unit,
            on_grid,
            places: self.places,
            added: self.added,
            crossings,
            chains,
            chain_sites,
        }
    }
}

/// Whether two segments cross in their interiors.
#[inline]
fn cross<K: Kernel>([a, b]: Segment, [c, d]: Segment) -> bool {
    let apart = |p, q, r, s| K::sign(&Orientation2([p, q, r])) * K::sign(&Orientation2([p, q, s])) == Sign::Negative;
    apart(a, b, c, d) && apart(c, d, a, b)
}

fn lexicographic(p: Place, q: Place) -> std::cmp::Ordering {
    p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
}

/// Vertices by the square of pixels that they lie in.
struct Cells {
    grid: Grid,
    first: FxHashMap<[i64; 2], u32>,
    /// Vertices, each with the position of the next in its cell.
    chained: Vec<(u32, u32)>,
}

impl Cells {
    /// 2^10 pixels on a side: nearly always a neighborhood of one pixel lies in one of them.
    const SHIFT: u32 = 10;
    const LAST: u32 = u32::MAX;

    fn new(grid: Grid, vertices: &[u32], place: impl Fn(u32) -> Place) -> Self {
        let mut first = FxHashMap::with_capacity_and_hasher(vertices.len(), Default::default());
        let mut chained = Vec::with_capacity(vertices.len());
        for (at, &vertex) in vertices.iter().enumerate() {
            let cell = grid.pixel(place(vertex)).map(|steps| steps >> Self::SHIFT);
            let next = first.insert(cell, at as u32).unwrap_or(Self::LAST);
            chained.push((vertex, next));
        }
        Cells { grid, first, chained }
    }

    /// All vertices within a unit of a place, and more.
    fn near(&self, place: Place) -> impl Iterator<Item = u32> + '_ {
        let [i, j] = self.grid.pixel(place);
        let range = |steps: i64| (steps - 2) >> Self::SHIFT..=(steps + 2) >> Self::SHIFT;
        let cells = range(i).flat_map(move |x| range(j).map(move |y| [x, y]));
        cells.flat_map(|cell| {
            let next = |&at: &u32| Some(self.chained[at as usize].1).filter(|&next| next != Self::LAST);
            std::iter::successors(self.first.get(&cell).copied(), next).map(|at| self.chained[at as usize].0)
        })
    }
}

//! Finds the segments that cross by a sweep: for long segments side by side, whose boxes overlap in
//! vain.
//!
//! A line sweeps over the plane from left to right (as if slightly tilted: of sites above each
//! other, it meets the lowest first). The segments that it meets are kept in order, from the lowest
//! up. Two segments that cross are neighbors just before; so only neighbors are compared (Bentley
//! and Ottmann 1979).
//!
//! *No crossings are compared with each other*, which would take numbers of many digits. The sweep
//! stops at ends of segments only. A crossing is deferred to the first stop that is not before it.
//! There, neighbors that have crossed exchange their positions until none are left, in any order:
//! each exchange undoes one inversion, and every pair of neighbors has been compared.
//!
//! *Touching.* After a stop, the order is that just behind it. So segments that cross at the stop
//! have been exchanged, those that end there are removed, and others begin between them. Segments
//! that overlap are in any order, and stay so.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::marker::PhantomData;

use crate::kernel::{CrossingSide, Kernel, Orientation2};
use crate::num::Sign;
use crate::parallel::*;

use super::order::Order;
use super::segment::{Segment, Site, lexicographic};

/// Returns the pairs of segments that cross in their interiors, in no order.
///
/// # Complexity
/// O((n + k) log n) for n segments and k crossings, on one thread.
pub(super) fn crossing_pairs<K: Kernel>(segments: &[Segment]) -> Vec<[u32; 2]> {
    let mut sweep = Sweep::<K>::over(segments);
    let ends = sweep.ends();
    for (stop, here) in (0..).zip(ends.chunk_by(|p, q| p.at == q.at)) {
        sweep.exchange_until(stop);
        here.iter()
            .filter(|end| end.is_last)
            .for_each(|end| sweep.remove(end.segment, stop));
        sweep.exchange_until(stop);
        here.iter()
            .filter(|end| !end.is_last)
            .for_each(|end| sweep.insert(end.segment, stop));
    }
    sweep.crossed
}

/// An end of a segment.
#[derive(Clone, Copy)]
struct SegmentEnd {
    at: Site,
    segment: u32,
    is_last: bool,
}

struct Sweep<K> {
    /// The segments, each from its lexicographically smaller end to the larger.
    segments: Vec<Segment>,
    /// The sites of all ends, in order.
    stops: Vec<Site>,
    /// The stop at which each segment ends.
    lasts: Vec<u32>,
    /// The segments that the sweep line meets, from the lowest up.
    order: Order,
    /// Neighbors that cross further on: the stop at which they are to be exchanged, the lower one,
    /// the upper one.
    due: BinaryHeap<Reverse<(u32, u32, u32)>>,
    crossed: Vec<[u32; 2]>,
    kernel: PhantomData<K>,
}

impl<K: Kernel> Sweep<K> {
    fn over(segments: &[Segment]) -> Self {
        let rightward = |&[a, b]: &Segment| {
            if lexicographic(a, b).is_le() {
                [a, b]
            } else {
                [b, a]
            }
        };
        Sweep {
            segments: segments.iter().map(rightward).collect(),
            stops: Vec::new(),
            lasts: vec![0; segments.len()],
            order: Order::of(segments.len()),
            due: BinaryHeap::new(),
            crossed: Vec::new(),
            kernel: PhantomData,
        }
    }

    /// Returns all ends in the order of the sweep. Records the stops, and at which one each segment
    /// ends.
    fn ends(&mut self) -> Vec<SegmentEnd> {
        let lines = (0..).zip(&self.segments).filter(|(_, [a, b])| a != b);
        let mut ends: Vec<SegmentEnd> = lines
            .flat_map(|(segment, &[a, b])| {
                [(a, false), (b, true)].map(|(at, is_last)| SegmentEnd {
                    at,
                    segment,
                    is_last,
                })
            })
            .collect();
        ends.par_sort_unstable_by(|p, q| lexicographic(p.at, q.at).then(p.segment.cmp(&q.segment)));
        for here in ends.chunk_by(|p, q| p.at == q.at) {
            for end in here.iter().filter(|end| end.is_last) {
                self.lasts[end.segment as usize] = self.stops.len() as u32;
            }
            self.stops.push(here[0].at);
        }
        ends
    }

    /// Returns on which side of a segment a site is: positive if above.
    fn side(&self, segment: u32, site: Site) -> Sign {
        let [a, b] = self.segments[segment as usize];
        K::sign(&Orientation2([a, b, site]))
    }

    fn insert(&mut self, segment: u32, stop: u32) {
        let end = self.segments[segment as usize][1];
        let at = self.stops[stop as usize];
        let is_below = |other| match self.side(other, at) {
            Sign::Zero => self.side(other, end) == Sign::Positive, // both go on from here
            side => side == Sign::Positive,
        };
        let below = self.order.position(is_below);
        self.order.insert(segment, &below);
        self.look_at(self.order.below(segment), Some(segment), stop);
        self.look_at(Some(segment), self.order.above(segment), stop);
    }

    fn remove(&mut self, segment: u32, stop: u32) {
        let (below, above) = (self.order.below(segment), self.order.above(segment));
        self.order.remove(segment);
        self.look_at(below, above, stop);
    }

    /// Exchanges the neighbors that are due at a stop.
    fn exchange_until(&mut self, stop: u32) {
        while let Some(&Reverse((due, lower, upper))) = self.due.peek()
            && due <= stop
        {
            self.due.pop();
            if self.order.above(lower) == Some(upper) {
                self.order.exchange(lower, upper);
                self.crossed.push([lower.min(upper), lower.max(upper)]);
                self.look_at(self.order.below(upper), Some(upper), stop);
                self.look_at(Some(lower), self.order.above(lower), stop);
            }
        }
    }

    /// Records two neighbors as due to be exchanged, if they cross further on.
    fn look_at(&mut self, lower: Option<u32>, upper: Option<u32>, stop: u32) {
        let (Some(lower), Some(upper)) = (lower, upper) else {
            return;
        };
        let [a, b] = self.segments[lower as usize];
        let [c, d] = self.segments[upper as usize];
        let will_cross = self.side(lower, d) == Sign::Negative
            && self.side(upper, b) == Sign::Positive
            && self.side(lower, c) == Sign::Positive
            && self.side(upper, a) == Sign::Negative;
        if will_cross {
            let last = self.lasts[lower as usize].min(self.lasts[upper as usize]);
            let ahead = &self.stops[stop as usize..last as usize];
            let due =
                stop + ahead.partition_point(|&site| is_beyond::<K>([a, b], [c, d], site)) as u32;
            self.due.push(Reverse((due, lower, upper)));
        }
    }
}

/// Returns true if two segments cross beyond a site. The second begins above the first.
fn is_beyond<K: Kernel>(ab: Segment, cd: Segment, site: Site) -> bool {
    // Below `c d`, `a` is on its right: the turn of `c d a` is negative.
    let side = |along: usize| {
        K::sign(&CrossingSide {
            ab,
            cd,
            along,
            center: site[along],
            offset: 0.0,
        })
    };
    match side(0) {
        Sign::Zero => side(1) == Sign::Negative,
        side => side == Sign::Negative,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    use super::*;
    use crate::arrangement::builder::cross;
    use crate::kernel::{Adaptive, Predicate, Range, Wide};

    fn sorted(mut pairs: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
        pairs.sort_unstable();
        pairs
    }

    fn naive(segments: &[Segment]) -> Vec<[u32; 2]> {
        let all = (0..segments.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
        let crossing = all.filter(|&[i, j]| cross::<Adaptive>(segments[i], segments[j]));
        sorted(crossing.map(|pair| pair.map(|i| i as u32)).collect())
    }

    /// On small grids nearly all segments touch, overlap, or cross where others do.
    #[test]
    fn what_crosses_is_found_once() {
        let mut state = 7u64;
        let mut below = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % n
        };
        for round in 0..600 {
            let (side, count) = (2 + round % 9, 1 + below(40));
            let mut site = || [below(side) as f64, below(side) as f64];
            let mut segments: Vec<Segment> = (0..count).map(|_| [site(), site()]).collect();
            segments.retain(|[a, b]| a != b);
            let (found, wide) = (
                crossing_pairs::<Adaptive>(&segments),
                crossing_pairs::<Wide>(&segments),
            );
            assert_eq!(sorted(found), naive(&segments), "round {round}");
            assert_eq!(sorted(wide), naive(&segments), "round {round}");
        }
    }

    /// Lines through one site, which is rounded.
    #[test]
    fn a_sheaf_crosses_pair_by_pair() {
        let at = |angle: f64, r: f64| [0.1 + r * angle.cos(), 0.7 + r * angle.sin()];
        let sheaf = |i: u32| {
            [
                f64::from(i) * 0.31,
                std::f64::consts::PI + f64::from(i) * 0.31,
            ]
            .map(|angle| at(angle, 9.0))
        };
        let segments: Vec<Segment> = (0..10).map(sheaf).collect();
        assert_eq!(crossing_pairs::<Adaptive>(&segments).len(), 45);
    }

    static ASKED: AtomicUsize = AtomicUsize::new(0);

    #[derive(Debug, Clone, Copy, Default)]
    struct Counting;

    impl Kernel for Counting {
        const RANGE: Range = Adaptive::RANGE;

        fn sign<P: Predicate>(predicate: &P) -> Sign {
            ASKED.fetch_add(1, Relaxed);
            Adaptive::sign(predicate)
        }
    }

    /// The boxes of 2 000 segments side by side all overlap: two million pairs.
    #[test]
    fn side_by_side_few_are_compared() {
        let side_by_side = |i: u32| {
            [
                [0.1 * f64::from(i), 0.0],
                [0.1 * f64::from(i) + 1000.0, 1000.0],
            ]
        };
        let mut segments: Vec<Segment> = (0..2000).map(side_by_side).collect();
        assert!(crossing_pairs::<Counting>(&segments).is_empty());
        assert!(ASKED.swap(0, Relaxed) < 60 * 2000);
        // One segment across all of them.
        segments.push([[-1.0, 499.0], [1300.0, 501.0]]);
        assert_eq!(crossing_pairs::<Counting>(&segments).len(), 2000);
        assert!(ASKED.swap(0, Relaxed) < 120 * 2000);
    }

    /// Where many boxes overlap in vain, the pairs that were found first are incomplete; pairs that
    /// other threads find meanwhile do not complete them.
    #[test]
    fn whether_boxes_were_asked_first_does_not_show() {
        let diagonal = |x: f64, y: f64, size: f64| [[x, y], [x + size, y + size]];
        // In the first bundle nothing crosses, in the second one pair in fifty: just enough to go
        // on.
        let mut segments: Vec<Segment> = (0..600)
            .map(|i| diagonal(0.1 * f64::from(i), 0.0, 1000.0))
            .collect();
        for i in 0..1200 {
            let [from, to] = diagonal(5000.0 + 0.1 * f64::from(i), 0.0, 1000.0);
            let across = if i % 10 == 0 { 12.0 } else { 0.0 };
            segments.push([from, [to[0] + across, to[1]]]);
        }
        let expected = sorted(crossing_pairs::<Adaptive>(&segments));
        let sites: Vec<Site> = segments.as_flattened().to_vec();
        let ends: Vec<[u32; 2]> = (0..segments.len() as u32)
            .map(|i| [2 * i, 2 * i + 1])
            .collect();
        for _ in 0..50 {
            let arranged = on_threads(4, || {
                crate::arrangement::Arrangement::new(sites.len(), |i| sites[i as usize], &ends, 0.0)
            });
            assert!(
                arranged
                    .crossings()
                    .iter()
                    .map(|crossing| crossing.segments)
                    .eq(expected.iter().copied())
            );
        }
    }
}

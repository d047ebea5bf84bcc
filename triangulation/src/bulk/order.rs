//! Spatial order: points that are close in space are close in the order.
//!
//! A *record* holds a key on the [curve](Curve) in its high bits and the position of the point in
//! its low bits:
//!
//! ```text
//!   63                                     0
//!   | x y x y x y ... of the key | position |
//! ```
//!
//! 1. One pass counts the points in each *bucket* (the highest bits of the key), a second writes
//!    the records of each bucket.
//! 2. Groups of buckets that fit a core's cache are sorted by the remaining bits, from the lowest
//!    up. (Both kinds of radix sort are of Hollerith's machines, 1887; see Knuth 1973, 5.2.5.)
//! 3. Records hold the bits that distinguish a few million evenly spread points. Where these are
//!    equal, the whole key decides; where that is equal, too, a curve of its own through these
//!    points alone; and so on. So no dynamic range is too large.
//!
//! Threads share nothing but the arrays they write to, and each entry is written once. Hence
//! atomics that never wait; `PERF:` they compile to ordinary stores.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

use crate::error::{InputError, MAX_VERTICES};
use crate::geometry::Coordinates;
use crate::parallel::*;
use crate::tds::VertexId;

use super::chunks;
use super::curve::{Curve, Span, Squares};
use super::grain::Grain;

/// The largest number of bits for buckets: as many buckets as a core's cache has lines to write to.
const BUCKET_BITS: u32 = 11;

/// The bits of a digit in the sort of a group.
const DIGIT_BITS: u32 = 11;

/// The keys of points in spatial order, in the high bits of records.
#[derive(Debug, Default)]
pub(crate) struct Keys {
    records: Vec<AtomicU64>,
    /// A mask of the bits that are not part of the key.
    low: u64,
}

impl Keys {
    /// Returns the keys of points that are in spatial order already.
    pub(super) fn of(count: usize, key: &(dyn Fn(usize) -> u64 + Sync), grain: Grain) -> Self {
        let key = |i: usize| AtomicU64::new(key(i));
        Keys {
            records: (0..count)
                .into_par_iter()
                .with_min_len(grain.points)
                .map(key)
                .collect(),
            low: 0,
        }
    }

    /// Returns the bits in which the keys of two points differ.
    #[inline(always)]
    pub(super) fn difference(&self, i: usize, j: usize) -> u64 {
        (self.records[i].load(Relaxed) ^ self.records[j].load(Relaxed)) & !self.low
    }

    /// Returns true if the key of point `i` is smaller than that of point `j`.
    #[inline(always)]
    fn is_before(&self, i: usize, j: usize) -> bool {
        self.records[i].load(Relaxed) < self.records[j].load(Relaxed)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Returns true if the records contain all bits that the curve gives.
    pub(super) fn are_whole(&self) -> bool {
        self.low == 0
    }

    /// Returns true if the key of a point has the bit set.
    #[inline(always)]
    pub(super) fn has(&self, i: usize, bit: u32) -> bool {
        self.records[i].load(Relaxed) >> bit & 1 == 1
    }
}

/// Returns so many zeros.
fn zeros(count: usize, grain: Grain) -> Vec<AtomicU32> {
    chunks::filled(count, grain.points, || AtomicU32::new(0))
}

/// Points, one for each site, in spatial order.
#[derive(Debug)]
pub(crate) struct Sites<P> {
    pub(crate) points: Vec<P>,
    pub(super) keys: Keys,
    /// The curve that the points are ordered along.
    pub(super) curve: Curve,
    /// True if all points have an exact plan; in space, an exact site.
    pub(super) have_plans: bool,
}

/// Points that are to be sorted.
///
/// `PERF:` called seldom, so that sorting need not be compiled for each geometry.
trait Unsorted: Sync {
    fn count(&self) -> usize;

    /// Returns the number of coordinates.
    fn axes(&self) -> usize;

    /// Returns the key of a point.
    fn key(&self, i: usize, curve: &Curve) -> u64;

    /// Returns true if two points of equal keys share a site.
    fn is_same(&self, i: u32, j: u32) -> bool;

    /// Counts points by the squares that they are in.
    ///
    /// `PERF:` two counts for each square, in turn, so that points in one square need not wait for
    /// each other.
    fn count_by_square(&self, points: Range<usize>, squares: &Squares, counts: &mut [[u32; 2]]);

    /// Writes the records of points, each where the next one of its bucket belongs.
    fn write(&self, points: Range<usize>, curve: &Curve, buckets: BucketRecords, nexts: &mut [u32]);

    /// Returns the span of some points, in the second part of each pair.
    fn span_of(&self, points: &[(u64, u32)]) -> Span;
}

/// Where and how records are written.
#[derive(Clone, Copy)]
struct BucketRecords<'a> {
    records: &'a [AtomicU64],
    /// A mask of the bits that are not part of the key.
    low: u64,
    /// The number of the highest bits of a key that distinguish buckets.
    bits: u32,
}

/// Points given by a function, and what it means that two share a site.
struct PointsOf<C, S> {
    count: usize,
    coordinates: C,
    is_same: S,
}

impl<A, C, S> Unsorted for PointsOf<C, S>
where
    A: AsRef<[f64]>,
    C: Fn(usize) -> A + Sync,
    S: Fn(u32, u32) -> bool + Sync,
{
    fn count(&self) -> usize {
        self.count
    }

    fn axes(&self) -> usize {
        if self.count == 0 {
            0
        } else {
            (self.coordinates)(0).as_ref().len()
        }
    }

    fn key(&self, i: usize, curve: &Curve) -> u64 {
        curve.key((self.coordinates)(i).as_ref())
    }

    fn is_same(&self, i: u32, j: u32) -> bool {
        (self.is_same)(i, j)
    }

    fn count_by_square(&self, points: Range<usize>, squares: &Squares, counts: &mut [[u32; 2]]) {
        points.for_each(|i| counts[squares.of((self.coordinates)(i).as_ref())][i % 2] += 1);
    }

    fn write(
        &self,
        points: Range<usize>,
        curve: &Curve,
        buckets: BucketRecords,
        nexts: &mut [u32],
    ) {
        for i in points {
            let key = curve.key((self.coordinates)(i).as_ref());
            let next = &mut nexts[(key >> 1 >> (63 - buckets.bits)) as usize];
            buckets.records[*next as usize].store(key & !buckets.low | i as u64, Relaxed);
            *next += 1;
        }
    }

    fn span_of(&self, points: &[(u64, u32)]) -> Span {
        Span::of(points.iter().map(|&(_, i)| (self.coordinates)(i as usize)))
    }
}

/// The result of sorting.
struct SortedSites {
    /// Keys and positions of the first point of each site.
    keys: Keys,
    /// The position of every other point, and the rank of its site.
    others: Vec<(u32, u32)>,
}

impl SortedSites {
    #[inline(always)]
    fn position(&self, rank: usize) -> usize {
        (self.keys.records[rank].load(Relaxed) & self.keys.low) as usize
    }

    /// Returns the positions of the first points of all sites, in order.
    fn positions(&self) -> Vec<u32> {
        let ranks = (0..self.keys.records.len())
            .into_par_iter()
            .with_min_len(1 << 12);
        ranks.map(|rank| self.position(rank) as u32).collect()
    }

    /// Returns the first point of each site, in order, and the site of each point.
    fn sites<P: Copy + Send + Sync>(&self, points: &[P], grain: Grain) -> (Vec<P>, Vec<VertexId>) {
        let ranks = zeros(points.len(), grain);
        let site = |rank: usize| {
            let position = self.position(rank);
            ranks[position].store(rank as u32, Relaxed);
            points[position]
        };
        let count = self.keys.records.len();
        let sites = (0..count)
            .into_par_iter()
            .with_min_len(grain.points)
            .map(site)
            .collect();
        for &(position, rank) in &self.others {
            ranks[position as usize].store(rank, Relaxed);
        }
        // In place.
        let vertices = ranks
            .into_iter()
            .map(|rank| VertexId::new(rank.into_inner() as usize))
            .collect();
        (sites, vertices)
    }
}

/// Returns the positions `0..count` in the order of a Morton curve through the points' coordinates
/// (one to three of them; Morton 1966).
///
/// Points that the curve cannot distinguish are in the order of a curve through these alone, and so
/// on. Points with equal coordinates keep the order of their positions. For distinct points the
/// order is a function of the set.
///
/// # Errors
/// If there are more than 2^31 - 2 points.
///
/// # Complexity
/// O(n), on all threads, for points that are spread evenly; where many share one of a few million
/// squares, O(n log n) for each factor of 2^31 in their distances. 12 bytes a point.
pub fn spatial_order<A: AsRef<[f64]>>(
    count: usize,
    coordinates: impl Fn(usize) -> A + Sync,
) -> Result<Vec<u32>, InputError> {
    if count > MAX_VERTICES {
        return Err(InputError::TooMany);
    }
    let grain = Grain::default();
    let curve = Curve::through(
        count,
        &|range| Span::of(range.map(&coordinates)),
        grain.points,
    );
    let sorted = sort(
        &PointsOf {
            count,
            coordinates,
            is_same: |_, _| false,
        },
        &curve,
        grain,
    );
    Ok(sorted.positions())
}

impl<P: Copy + Send + Sync> Sites<P> {
    /// Returns the sites of points, and the site of each point.
    ///
    /// # Errors
    /// The first point that the geometry refuses, by its position; or too many points.
    pub(crate) fn of<G: Coordinates<N, Point = P>, const N: usize>(
        geometry: &G,
        points: &[P],
        grain: Grain,
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        let (curve, have_plans) = survey(geometry, points, grain)?;
        let coordinates = |i: usize| geometry.coordinates(&points[i]);
        let is_same = |i: u32, j: u32| {
            geometry
                .compare(&points[i as usize], &points[j as usize])
                .is_eq()
        };
        let sorted = sort(
            &PointsOf {
                count: points.len(),
                coordinates,
                is_same,
            },
            &curve,
            grain,
        );
        let (sites, vertices) = sorted.sites(points, grain);
        Ok((
            Sites {
                points: sites,
                keys: sorted.keys,
                curve,
                have_plans,
            },
            vertices,
        ))
    }

    /// Returns the sites of points that are all different and in [`spatial_order`] already.
    ///
    /// # Errors
    /// Those of [`of`](Self::of), and the first point that is not in order.
    pub(crate) fn sorted<G: Coordinates<N, Point = P>, const N: usize>(
        geometry: &G,
        points: Vec<P>,
    ) -> Result<Self, InputError> {
        let grain = Grain::default();
        let (curve, have_plans) = survey(geometry, &points, grain)?;
        let keys = Keys::of(
            points.len(),
            &|i| curve.key(geometry.coordinates(&points[i]).as_ref()),
            grain,
        );
        let is_wrong = |i: usize| {
            keys.is_before(i, i - 1)
                || keys.difference(i, i - 1) == 0
                    && geometry.compare(&points[i - 1], &points[i]).is_eq()
        };
        if let Some(position) = chunks::first_of(1..points.len(), grain.points, &is_wrong) {
            return Err(InputError::Unsorted(position));
        }
        Ok(Sites {
            points,
            keys,
            curve,
            have_plans,
        })
    }
}

/// Checks that the geometry admits all points. Returns the curve through them, and true if all of
/// them have an exact plan (in the plane) or an exact site (in space).
///
/// `PERF:` in one pass instead of three.
fn survey<G: Coordinates<N>, const N: usize>(
    geometry: &G,
    points: &[G::Point],
    grain: Grain,
) -> Result<(Curve, bool), InputError> {
    let look = |(admitted, planned, span): (bool, bool, Span), p: &G::Point| {
        let planned = planned
            & if N == 3 {
                geometry.exact_plan(p).is_some()
            } else {
                geometry.exact_site(p).is_some()
            };
        (
            admitted & geometry.admits(p),
            planned,
            span.with(geometry.coordinates(p).as_ref()),
        )
    };
    let nothing = (true, true, Span::EMPTY);
    let look_at = |range: Range<usize>| points[range].iter().fold(nothing, look);
    let (admitted, have_plans, span) =
        chunks::reduced(points.len(), grain.points, &look_at, nothing, |p, q| {
            (p.0 & q.0, p.1 & q.1, p.2.and(q.2))
        });
    if !admitted && let Some(error) = InputError::of_points(geometry, points) {
        return Err(error);
    }
    if points.len() > MAX_VERTICES {
        return Err(InputError::TooMany);
    }
    Ok((Curve::along(span), have_plans))
}

/// Sorts points.
///
/// `PERF:` with 7 bits less in the records, groups take two passes instead of three: 2 % of the
/// time of 1 million uniform points. But clusters take 10 % more, because many records are equal
/// then.
fn sort(points: &dyn Unsorted, curve: &Curve, grain: Grain) -> SortedSites {
    let count = points.count();
    let index_bits = usize::BITS - count.saturating_sub(1).leading_zeros();
    let key_bits = (index_bits + 17).min(64 - index_bits);
    let low = u64::MAX >> key_bits;

    let (records, starts) = distribute(points, curve, low, grain);
    let sorter = Sorter {
        curve,
        points,
        low,
        grain,
    };
    let groups = groups(&starts, grain);
    let sorted: Vec<(usize, Vec<(u32, u32)>)> = groups
        .par_windows(2)
        .map_init(GroupBuffers::default, |buffers, ends| {
            sorter.sort(&records[ends[0]..ends[1]], buffers)
        })
        .collect();

    // Close the gaps behind groups in which sites have several points.
    let mut others = Vec::new();
    let mut rank = 0;
    for (&start, (sites, repeated)) in groups.iter().zip(&sorted) {
        if rank != start {
            (0..*sites)
                .for_each(|i| records[rank + i].store(records[start + i].load(Relaxed), Relaxed));
        }
        others.extend(
            repeated
                .iter()
                .map(|&(position, site)| (position, rank as u32 + site)),
        );
        rank += sites;
    }
    let mut records = records;
    records.truncate(rank);
    SortedSites {
        keys: Keys { records, low },
        others,
    }
}

/// Returns the records in the order of their buckets, and the start of each bucket, followed by the
/// end.
fn distribute(
    points: &dyn Unsorted,
    curve: &Curve,
    low: u64,
    grain: Grain,
) -> (Vec<AtomicU64>, Vec<usize>) {
    let count = points.count();
    let index_bits = usize::BITS - count.leading_zeros();
    let bits = index_bits.saturating_sub(9).min(BUCKET_BITS);
    let squares = Squares::new(curve, points.axes(), bits);
    let records = chunks::filled(count, grain.points, || AtomicU64::new(0));

    let chunk = count.div_ceil(current_num_threads()).max(grain.points);
    let range = |c: usize| c * chunk..count.min((c + 1) * chunk);
    let counted = |c: usize| {
        let mut counts = vec![[0u32; 2]; 1 << bits];
        points.count_by_square(range(c), &squares, &mut counts);
        let mut by_bucket = vec![0u32; 1 << bits];
        counts
            .iter()
            .enumerate()
            .for_each(|(square, [even, odd])| by_bucket[squares.key_bits(square)] += even + odd);
        by_bucket
    };
    let mut counts: Vec<Vec<u32>> = (0..count.div_ceil(chunk))
        .into_par_iter()
        .map(counted)
        .collect();
    // Where each chunk writes its share of each bucket: buckets in order, and in each the chunks in
    // order.
    let mut starts = Vec::with_capacity((1 << bits) + 1);
    let mut start = 0;
    for bucket in 0..1 << bits {
        starts.push(start as usize);
        for counts in &mut counts {
            start += std::mem::replace(&mut counts[bucket], start);
        }
    }
    starts.push(count);
    let buckets = BucketRecords {
        records: &records,
        low,
        bits,
    };
    counts
        .par_iter_mut()
        .enumerate()
        .for_each(|(c, nexts)| points.write(range(c), curve, buckets, nexts));
    (records, starts)
}

/// Returns the ends of groups of whole buckets, beginning with 0.
fn groups(starts: &[usize], grain: Grain) -> Vec<usize> {
    let mut ends = vec![0];
    let mut last = 0;
    for (i, &end) in starts.iter().enumerate() {
        if end > last && (end - last >= grain.group || i + 1 == starts.len()) {
            ends.push(end);
            last = end;
        }
    }
    ends
}

/// Two buffers for a group.
#[derive(Default)]
struct GroupBuffers {
    records: Vec<u64>,
    spare: Vec<u64>,
}

struct Sorter<'a> {
    curve: &'a Curve,
    points: &'a dyn Unsorted,
    low: u64,
    grain: Grain<'a>,
}

impl Sorter<'_> {
    /// Sorts a group, moves the sites to its front and counts them. Points that are not the first
    /// of their site are returned separately.
    fn sort(&self, group: &[AtomicU64], buffers: &mut GroupBuffers) -> (usize, Vec<(u32, u32)>) {
        let GroupBuffers { records, spare } = buffers;
        records.clear();
        records.extend(group.iter().map(|record| record.load(Relaxed)));
        sort_records(records, spare, self.low);

        let mut others = Vec::new();
        let mut sites = 0;
        let mut i = 0;
        while i < records.len() {
            let key = records[i] | self.low;
            if records.get(i + 1).is_none_or(|next| next | self.low != key) {
                group[sites].store(records[i], Relaxed);
                sites += 1;
                i += 1;
                continue;
            }
            let end = i + records[i..].partition_point(|record| record | self.low == key);
            let run = &mut records[i..end];
            self.sort_run(run);
            let position = |record: u64| (record & self.low) as u32;
            let mut last = None;
            for &record in run.iter() {
                if last.is_some_and(|last| self.points.is_same(last, position(record))) {
                    others.push((position(record), sites as u32 - 1));
                } else {
                    last = Some(position(record));
                    group[sites].store(record, Relaxed);
                    sites += 1;
                }
            }
            i = end;
        }
        (sites, others)
    }

    /// Sorts records whose stored bits of the key are equal.
    #[cold]
    fn sort_run(&self, run: &mut [u64]) {
        let mut positions: Vec<(u64, u32)> = run
            .iter()
            .map(|record| (0, (record & self.low) as u32))
            .collect();
        self.sort_along(self.curve, &mut positions);
        for (record, (_, position)) in run.iter_mut().zip(positions) {
            *record = *record & !self.low | u64::from(position);
        }
    }

    /// Sorts by whole keys; where these are equal, along a curve through the points that share one.
    fn sort_along(&self, curve: &Curve, points: &mut [(u64, u32)]) {
        let key = |position: u32| self.points.key(position as usize, curve);
        if points.len() > self.grain.points {
            points
                .par_iter_mut()
                .for_each(|(of_point, position)| *of_point = key(*position));
            points.par_sort_unstable();
        } else {
            points
                .iter_mut()
                .for_each(|(of_point, position)| *of_point = key(*position));
            points.sort_unstable();
        }
        for equal in points
            .chunk_by_mut(|(p, _), (q, _)| p == q)
            .filter(|equal| equal.len() > 1)
        {
            let span = |range: Range<usize>| self.points.span_of(&equal[range]);
            let inner = Curve::through(equal.len(), &span, self.grain.points);
            if !inner.is_point() {
                self.sort_along(&inner, equal);
            }
        }
    }
}

/// Sorts records by their keys, the bits above `low`; equal ones stay in order of position, as they
/// come.
fn sort_records(records: &mut Vec<u64>, spare: &mut Vec<u64>, low: u64) {
    /// Below this, clearing and summing the counts takes longer than a comparison sort.
    const FEW: usize = 1 << 10;
    if records.len() < FEW {
        records.sort_unstable();
        return;
    }
    // A group has the smallest and the largest key in its first and last bucket, so that no record
    // needs the keys below the first one.
    let (least, largest) = records.iter().fold((u64::MAX, 0), |(least, largest), &r| {
        (least.min(r), largest.max(r))
    });
    let shift = low.count_ones();
    let key = |record: u64| (record >> shift) - (least >> shift);
    let bits = u64::BITS - key(largest).leading_zeros();
    let passes = bits.div_ceil(DIGIT_BITS);
    if passes == 0 {
        return;
    }
    let digit_bits = bits.div_ceil(passes);
    let digit = |record: u64, pass: usize| {
        (key(record) >> (pass as u32 * digit_bits)) as usize & ((1 << digit_bits) - 1)
    };
    let mut counts = vec![[0u32; 1 << DIGIT_BITS]; passes as usize];
    for &record in records.iter() {
        counts
            .iter_mut()
            .enumerate()
            .for_each(|(pass, counts)| counts[digit(record, pass)] += 1);
    }
    spare.resize(records.len(), 0);
    for (pass, counts) in counts.iter_mut().enumerate() {
        let mut start = 0;
        counts
            .iter_mut()
            .for_each(|count| start += std::mem::replace(count, start));
        for &record in records.iter() {
            let next = &mut counts[digit(record, pass)];
            spare[*next as usize] = record;
            *next += 1;
        }
        std::mem::swap(records, spare);
    }
}

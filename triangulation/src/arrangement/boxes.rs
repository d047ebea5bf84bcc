//! Overlaps of boxes: a packed R-tree, built once.
//!
//! Boxes are sorted into vertical slabs and within each by height (sort-tile-recursive:
//! Leutenegger, Lopez and Edgington 1997). Each row of [`FAN`] boxes gets a box around them, and so
//! on up.

use crate::parallel::*;

use super::segment::FEW;

/// The number of children of a node: a power of two.
const FAN: usize = 1 << FAN_BITS;
const FAN_BITS: usize = 3;

/// A box in plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Box2 {
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
}

impl Box2 {
    pub(super) const NOTHING: Self = Box2 {
        min: [f64::INFINITY; 2],
        max: [f64::NEG_INFINITY; 2],
    };

    pub(super) fn around([p, q]: [[f64; 2]; 2]) -> Self {
        Box2 {
            min: [p[0].min(q[0]), p[1].min(q[1])],
            max: [p[0].max(q[0]), p[1].max(q[1])],
        }
    }

    /// Returns the box grown by this much on each axis. Rounded outward, so that it stays a
    /// superset.
    pub(super) fn grown(self, by: [f64; 2]) -> Self {
        let axis = |k: usize| {
            (
                (self.min[k] - by[k]).next_down(),
                (self.max[k] + by[k]).next_up(),
            )
        };
        let [(x0, x1), (y0, y1)] = [axis(0), axis(1)];
        Box2 {
            min: [x0, y0],
            max: [x1, y1],
        }
    }

    pub(super) fn with(self, other: &Self) -> Self {
        Box2 {
            min: [self.min[0].min(other.min[0]), self.min[1].min(other.min[1])],
            max: [self.max[0].max(other.max[0]), self.max[1].max(other.max[1])],
        }
    }

    #[inline(always)]
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        // Without branches: evaluating all four is cheaper than a misprediction.
        (self.min[0] <= other.max[0])
            & (other.min[0] <= self.max[0])
            & (self.min[1] <= other.max[1])
            & (other.min[1] <= self.max[1])
    }

    /// Returns true if the whole box lies on one side of the line through a segment, and not so
    /// near to the line that rounding could hide the side. The coordinates are in the range of the
    /// fast kernels.
    #[inline(always)]
    pub(super) fn is_beside(&self, [a, b]: [[f64; 2]; 2]) -> bool {
        let [ux, uy] = [b[0] - a[0], b[1] - a[1]];
        // The corners that are furthest to the right and to the left of the direction.
        let (right_x, left_x) = if uy > 0.0 {
            (self.max[0], self.min[0])
        } else {
            (self.min[0], self.max[0])
        };
        let (right_y, left_y) = if ux > 0.0 {
            (self.min[1], self.max[1])
        } else {
            (self.max[1], self.min[1])
        };
        // Twice the area of segment and corner, and a bound on its error: four roundings, each of
        // 2^-53, in either product.
        let area = |x: f64, y: f64| {
            let (left, right) = (ux * (y - a[1]), uy * (x - a[0]));
            (
                left - right,
                4.0 * f64::EPSILON * (left.abs() + right.abs()),
            )
        };
        let (rightmost, leftmost) = (area(right_x, right_y), area(left_x, left_y));
        (rightmost.0 > rightmost.1) | (leftmost.0 < -leftmost.1)
    }

    pub(super) fn area(&self) -> f64 {
        (self.max[0] - self.min[0]) * (self.max[1] - self.min[1])
    }

    /// Returns the center on one axis; halved first, so that it does not overflow.
    fn center(&self, axis: usize) -> f64 {
        self.min[axis] / 2.0 + self.max[axis] / 2.0
    }
}

/// A tree over numbered boxes.
#[derive(Debug, Clone)]
pub(super) struct BoxTree {
    /// The numbers of the boxes in the order of the leaves.
    order: Vec<u32>,
    /// The boxes in that order, then the level of boxes around each [`FAN`] of them, and so on.
    levels: Vec<Vec<Box2>>,
}

impl BoxTree {
    pub(super) fn new(boxes: &[Box2]) -> Self {
        // The keys are stored with the numbers: half the time of looking them up.
        let centers = boxes
            .iter()
            .zip(0..)
            .map(|(boxed, i)| ([0, 1].map(|axis| boxed.center(axis)), i));
        let mut order: Vec<([f64; 2], u32)> = centers.collect();
        let by_center = |axis: usize| {
            move |(p, i): &([f64; 2], u32), (q, j): &([f64; 2], u32)| {
                p[axis].total_cmp(&q[axis]).then(i.cmp(j))
            }
        };
        order.par_sort_unstable_by(by_center(0));
        let slab = FAN * ((boxes.len() as f64 / FAN as f64).sqrt().ceil() as usize).max(1);
        order
            .par_chunks_mut(slab)
            .with_min_len(FEW.div_ceil(slab))
            .for_each(|slab| slab.sort_unstable_by(by_center(1)));
        let order: Vec<u32> = order.into_iter().map(|(_, i)| i).collect();
        let mut levels = vec![
            order
                .iter()
                .map(|&i| boxes[i as usize])
                .collect::<Vec<Box2>>(),
        ];
        while let Some(below) = levels.last().filter(|level| level.len() > 1) {
            let above = below
                .chunks(FAN)
                .map(|chunk| chunk.iter().fold(Box2::NOTHING, |sum, b| sum.with(b)))
                .collect();
            levels.push(above);
        }
        BoxTree { order, levels }
    }

    /// The numbers of the boxes in the order of the leaves.
    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }

    /// Calls `visit` with the number of every box that is met. `is_met` must also be true for every
    /// box that contains one that is met.
    #[inline]
    pub(super) fn visit(&self, is_met: impl Fn(&Box2) -> bool, mut visit: impl FnMut(u32)) {
        self.visit_from(0, is_met, &mut visit);
    }

    /// Like [`visit`](Self::visit), but for leaves from position `first` on only.
    #[inline]
    pub(super) fn visit_from(
        &self,
        first: usize,
        is_met: impl Fn(&Box2) -> bool,
        visit: &mut impl FnMut(u32),
    ) {
        let top = self.levels.len() - 1;
        let is_in = |root: &Box2| is_met(root) && (top > 0 || first == 0);
        if !self.levels[top].first().is_some_and(is_in) {
            return;
        }
        // Fewer than 12 levels number all of 32 bits.
        let mut stack = [(top as u32, 0u32); 12 * FAN + 1];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (level, node) = (stack[height].0 as usize, stack[height].1 as usize);
            if level == 0 {
                visit(self.order[node]);
                continue;
            }
            let below = &self.levels[level - 1];
            let row = node * FAN..below.len().min((node + 1) * FAN);
            // A node has FAN^level leaves in a row.
            let skipped = (first >> (FAN_BITS * (level - 1))).saturating_sub(row.start);
            for (child, boxed) in row.clone().zip(&below[row]).skip(skipped) {
                // PERF: without a branch, of which one in three would be mispredicted.
                stack[height] = (level as u32 - 1, child as u32);
                height += usize::from(is_met(boxed));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_overlaps_are_found_once() {
        let mut state = 1u64;
        let mut below = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as f64
        };
        for count in [0, 1, 7, 8, 9, 64, 65, 700] {
            let mut boxed = || Box2::around([[below(20), below(20)], [below(20), below(20)]]);
            let boxes: Vec<Box2> = (0..count).map(|_| boxed()).collect();
            let tree = BoxTree::new(&boxes);
            for query in &boxes {
                let mut found = Vec::new();
                tree.visit(|boxed| boxed.overlaps(query), |i| found.push(i));
                found.sort_unstable();
                let all: Vec<u32> = (0..count as u32)
                    .filter(|&i| boxes[i as usize].overlaps(query))
                    .collect();
                assert_eq!(found, all);
            }
            let mut pairs = 0;
            for (at, &i) in tree.order().iter().enumerate() {
                let query = boxes[i as usize];
                tree.visit_from(at + 1, |boxed| boxed.overlaps(&query), &mut |_| pairs += 1);
            }
            let all = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
            assert_eq!(
                pairs,
                all.filter(|&(i, j)| boxes[i].overlaps(&boxes[j])).count()
            );
        }
    }
}

//! A tree of boxes: finds what is at a position, or nearest to it, wherever the rest is.

use rayon::join;

use crate::data::{Surface, corners};

/// The number of items in a leaf, at most.
const LEAF: usize = 8;

/// Subtrees with fewer items are built by one thread.
const ALONE: usize = 1 << 14;

/// A box in plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
}

impl Extent {
    const EMPTY: Extent = Extent {
        min: [f64::INFINITY; 2],
        max: [f64::NEG_INFINITY; 2],
    };

    /// Returns the box of some points.
    pub(super) fn of(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        Self::of_plan(points.into_iter().map(|[x, y, _]| [x, y]))
    }

    /// Returns the box of some positions.
    pub(super) fn of_plan(sites: impl IntoIterator<Item = [f64; 2]>) -> Self {
        sites.into_iter().fold(Self::EMPTY, |extent, site| {
            extent.with(Extent {
                min: site,
                max: site,
            })
        })
    }

    /// Returns the box and a distance around it.
    pub(super) fn grown(self, by: f64) -> Self {
        Extent {
            min: self.min.map(|c| c - by),
            max: self.max.map(|c| c + by),
        }
    }

    /// Returns the box around both.
    pub(super) fn with(self, other: Extent) -> Self {
        Extent {
            min: [0, 1].map(|i| self.min[i].min(other.min[i])),
            max: [0, 1].map(|i| self.max[i].max(other.max[i])),
        }
    }

    fn middle(&self, axis: usize) -> f64 {
        self.min[axis] / 2.0 + self.max[axis] / 2.0
    }

    /// Returns true if a position is in the box or on its border.
    #[inline]
    pub(super) fn contains(&self, q: [f64; 2]) -> bool {
        (0..2).all(|i| self.min[i] <= q[i] && q[i] <= self.max[i])
    }

    pub(super) fn overlaps(&self, other: &Extent) -> bool {
        (0..2).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Returns the square of the distance to a position; 0 within.
    #[inline]
    pub(super) fn distance(&self, q: [f64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|i| (self.min[i] - q[i]).max(q[i] - self.max[i]).max(0.0));
        x * x + y * y
    }
}

/// A face of a surface, with the box around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct LocatedFace {
    pub(super) number: u32,
    pub(super) extent: Extent,
}

impl LocatedFace {
    /// Returns all faces of a surface, in order of their numbers.
    pub(super) fn all<S: Surface + ?Sized>(surface: &S) -> impl Iterator<Item = Self> + '_ {
        corners(surface).map(|(number, corners)| LocatedFace {
            number,
            extent: Extent::of(corners.map(|v| surface.position(v))),
        })
    }
}

impl Boxed for LocatedFace {
    fn extent(&self) -> Extent {
        self.extent
    }
}

/// Items with boxes, halved again and again along the longer side.
#[derive(Debug)]
pub(super) struct Boxes<T> {
    items: Vec<T>,
    /// The box of each node: its children are at twice its position plus 1 and 2.
    nodes: Vec<Extent>,
}

/// An item of a tree.
pub(super) trait Boxed: Copy + Send + Sync {
    fn extent(&self) -> Extent;
}

impl<T: Boxed> Boxes<T> {
    /// Builds the tree.
    ///
    /// # Complexity
    /// O(n log n); about 8 bytes for each item in addition to the items.
    pub(super) fn new(items: Vec<T>) -> Self {
        Self::divided(items, ALONE)
    }

    /// Builds the tree on the calling thread alone.
    ///
    /// A lock may be held meanwhile: a thread that waits for another one takes up other work, which
    /// might ask for the same lock.
    pub(super) fn by_one_thread(items: Vec<T>) -> Self {
        Self::divided(items, usize::MAX)
    }

    /// Builds the tree; subtrees with fewer items than `alone` are built by one thread.
    fn divided(mut items: Vec<T>, alone: usize) -> Self {
        let leaves = items.len().div_ceil(LEAF).max(1).next_power_of_two();
        let mut levels: Vec<Vec<Extent>> = Vec::new();
        let mut width = 1;
        while width <= leaves {
            levels.push(vec![Extent::EMPTY; width]);
            width *= 2;
        }
        let mut views: Vec<&mut [Extent]> = levels.iter_mut().map(Vec::as_mut_slice).collect();
        build(&mut items, &mut views, alone);
        Boxes {
            items,
            nodes: levels.concat(),
        }
    }

    /// Returns the items, in an order of the tree.
    pub(super) fn items(&self) -> &[T] {
        &self.items
    }

    /// Returns what the items of each node have in common. `of` returns it for the items of a leaf,
    /// and `both` for two nodes.
    ///
    /// # Complexity
    /// Linear.
    pub(super) fn in_common<C>(
        &self,
        of: impl Fn(&[T]) -> C,
        both: impl Fn(&C, &C) -> C,
    ) -> Vec<C> {
        let leaves = self.nodes.len().div_ceil(2);
        let first = self.nodes.len() - leaves;
        let mut ranges = vec![(0, self.items.len())];
        for node in 0..first {
            let (start, end) = ranges[node];
            let middle = halved(start, end);
            ranges.extend([(start, middle), (middle, end)]);
        }
        // From the last node to the first, so that children come before their parents.
        let mut found: Vec<C> = Vec::with_capacity(self.nodes.len());
        for node in (0..self.nodes.len()).rev() {
            let of_child = |child: usize| &found[self.nodes.len() - 1 - child];
            found.push(if node < first {
                both(of_child(2 * node + 1), of_child(2 * node + 2))
            } else {
                let (start, end) = ranges[node];
                of(&self.items[start..end])
            });
        }
        found.reverse();
        found
    }

    /// Calls `each` with items whose box may contain a position, until it returns a value.
    pub(super) fn find<R>(&self, q: [f64; 2], each: impl FnMut(&T) -> Option<R>) -> Option<R> {
        self.find_in(Extent { min: q, max: q }, each)
    }

    /// Calls `each` with items whose box may overlap another box, until it returns a value.
    pub(super) fn find_in<R>(
        &self,
        extent: Extent,
        each: impl FnMut(&T) -> Option<R>,
    ) -> Option<R> {
        self.find_where(|node| node.overlaps(&extent), each)
    }

    /// Calls `each` with the items of all nodes whose box is wanted, until it returns a value.
    pub(super) fn find_where<R>(
        &self,
        is_wanted: impl Fn(&Extent) -> bool,
        mut each: impl FnMut(&T) -> Option<R>,
    ) -> Option<R> {
        // Each level leaves one node behind. `PERF:` a list of its own for each call would cost
        // more than most calls.
        let mut left = [(0, 0, 0); usize::BITS as usize];
        left[0] = (0, 0, self.items.len());
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (node, start, end) = left[count];
            if start == end || !is_wanted(&self.nodes[node]) {
                continue;
            }
            if 2 * node + 2 < self.nodes.len() {
                let middle = halved(start, end);
                left[count] = (2 * node + 2, middle, end);
                left[count + 1] = (2 * node + 1, start, middle);
                count += 2;
            } else if let Some(found) = self.items[start..end].iter().find_map(&mut each) {
                return Some(found);
            }
        }
        None
    }

    /// Calls `each` with the items around a position, the boxes nearest to it first. It returns the
    /// square of the distance up to which more are wanted.
    ///
    /// `left` is memory that is kept from one call to the next.
    pub(super) fn around(&self, q: [f64; 2], left: &mut Vec<Near>, each: impl FnMut(&T) -> f64) {
        self.around_in(q, left, |_| true, each);
    }

    /// Like [`around`](Self::around), but without the nodes for which `is_wanted` is false.
    pub(super) fn around_in(
        &self,
        q: [f64; 2],
        left: &mut Vec<Near>,
        is_wanted: impl Fn(usize) -> bool,
        mut each: impl FnMut(&T) -> f64,
    ) {
        let mut wanted = f64::INFINITY;
        left.clear();
        left.push(Near {
            node: 0,
            start: 0,
            end: self.items.len(),
            distance: 0.0,
        });
        while let Some(Near {
            node,
            start,
            end,
            distance,
        }) = left.pop()
        {
            if start == end || distance > wanted || !is_wanted(node) {
                continue;
            }
            if 2 * node + 2 >= self.nodes.len() {
                self.items[start..end]
                    .iter()
                    .for_each(|item| wanted = each(item));
                continue;
            }
            let middle = halved(start, end);
            let child = |node: usize, start, end| Near {
                node,
                start,
                end,
                distance: self.nodes[node].distance(q),
            };
            let mut children = [
                child(2 * node + 1, start, middle),
                child(2 * node + 2, middle, end),
            ];
            if children[0].distance < children[1].distance {
                children.swap(0, 1);
            }
            left.extend(children);
        }
    }
}

/// A node that is still to be searched.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    node: usize,
    start: usize,
    end: usize,
    distance: f64,
}

fn halved(start: usize, end: usize) -> usize {
    start + (end - start) / 2
}

/// Sorts the items of a node into its subtrees, and finds all boxes. `levels` are the nodes below,
/// its own first.
fn build<T: Boxed>(items: &mut [T], levels: &mut [&mut [Extent]], alone: usize) {
    let extent = items
        .iter()
        .fold(Extent::EMPTY, |extent, item| extent.with(item.extent()));
    let Some((own, below)) = levels.split_first_mut() else {
        return;
    };
    if let Some(node) = own.first_mut() {
        *node = extent;
    }
    if below.is_empty() {
        return;
    }
    let axis = usize::from(extent.max[1] - extent.min[1] > extent.max[0] - extent.min[0]);
    let middle = halved(0, items.len());
    if middle < items.len() {
        let key = |item: &T| item.extent().middle(axis);
        items.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
    }
    let is_small = items.len() < alone;
    let (low, high) = items.split_at_mut(middle);
    let (mut left, mut right) = (
        Vec::with_capacity(below.len()),
        Vec::with_capacity(below.len()),
    );
    for level in below.iter_mut() {
        let (first, second) = level.split_at_mut(level.len() / 2);
        left.push(first);
        right.push(second);
    }
    if is_small {
        build(low, &mut left, alone);
        build(high, &mut right, alone);
    } else {
        join(
            || build(low, &mut left, alone),
            || build(high, &mut right, alone),
        );
    }
}

//! Which contours are small: lines and the regions beside them as a graph.
//!
//! Each line lies between two regions. A ring, or a line whose ends are on one rim, is the only
//! link between what is on its two sides: it is a bridge of the graph. A line that joins two
//! different rims is not, because there is a way around the rims. So bridges are the lines that
//! have a side, and what is reached without crossing such a line is its side:
//!
//! ```text
//!     +--------------------+
//!     |   ___              |        a --- b --- c        a: outside, b: between the
//!     |  /   \  b          |              |              rings, c: within the inner one
//!     | |  c  |         a  |              d              d: beyond the line at the rim
//!     |  \___/         ____|
//!     |               / d  |
//!     +--------------------+
//! ```

use super::regions::Extent;

/// No line, or no region.
const NONE: u32 = u32::MAX;

/// The regions on the left and on the right of a line.
pub(super) type Sides = [u32; 2];

/// A side of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SmallSide {
    /// 0 for the left, 1 for the right.
    pub(super) side: usize,
    pub(super) extent: Extent,
}

/// Lines and the regions between them.
pub(super) struct Nests {
    /// The regions beside each line, if they are known.
    lines: Vec<Option<Sides>>,
    /// Where the lines of each region start.
    starts: Vec<u32>,
    /// The lines around the regions, each with the region beyond.
    links: Vec<(u32, u32)>,
    is_removed: Vec<bool>,
}

impl Nests {
    /// Links lines and regions, of which there are `count`.
    pub(super) fn new(lines: Vec<Option<Sides>>, count: usize) -> Self {
        let mut starts = vec![0; count + 1];
        for region in lines.iter().flatten().flatten() {
            starts[*region as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next: Vec<u32> = starts.clone();
        let mut links = vec![(NONE, NONE); starts.last().copied().unwrap_or(0) as usize];
        for (line, sides) in (0..).zip(&lines) {
            let Some([left, right]) = *sides else {
                continue;
            };
            for (own, beyond) in [(left, right), (right, left)] {
                let at = &mut next[own as usize];
                links[*at as usize] = (line, beyond);
                *at += 1;
            }
        }
        Nests {
            is_removed: vec![false; lines.len()],
            lines,
            starts,
            links,
        }
    }

    fn links_of(&self, region: u32) -> &[(u32, u32)] {
        let [start, end] = [0, 1].map(|k| self.starts[region as usize + k] as usize);
        &self.links[start..end]
    }

    /// Returns what is on the left and on the right of each line; `None` for a line that has no
    /// sides, because it joins two rims.
    ///
    /// # Complexity
    /// Linear; the search for bridges of Tarjan (1974), without recursion.
    pub(super) fn sides(&self, extents: &[Extent]) -> Vec<Option<[Extent; 2]>> {
        let forest = Forest::of(self);
        // From the leaves to the roots: what is below each region, itself included.
        let mut below = extents.to_vec();
        for &region in forest.order.iter().rev() {
            let parent = forest.parent[region as usize];
            if parent != NONE {
                below[parent as usize] = below[parent as usize].and(below[region as usize]);
            }
        }
        // From the roots to the leaves: all that is not below a region.
        let mut beyond = vec![Extent::NOTHING; extents.len()];
        let mut children: Vec<u32> = Vec::new();
        for &region in &forest.order {
            children.clear();
            let is_child = |&&(line, child): &&(u32, u32)| {
                forest.line[child as usize] == line && forest.parent[child as usize] == region
            };
            children.extend(
                self.links_of(region)
                    .iter()
                    .filter(is_child)
                    .map(|link| link.1),
            );
            let mut before = beyond[region as usize].and(extents[region as usize]);
            for &child in &children {
                beyond[child as usize] = before;
                before = before.and(below[child as usize]);
            }
            let mut after = Extent::NOTHING;
            for &child in children.iter().rev() {
                beyond[child as usize] = beyond[child as usize].and(after);
                after = after.and(below[child as usize]);
            }
        }
        let sides_of = |(line, sides): (u32, &Option<Sides>)| {
            let [left, right] = (*sides)?;
            let child = [left, right]
                .into_iter()
                .find(|&region| forest.line[region as usize] == line)?;
            let is_bridge = forest.low[child as usize] == forest.time[child as usize];
            let [own, other] = [below[child as usize], beyond[child as usize]];
            is_bridge.then_some(if child == left {
                [own, other]
            } else {
                [other, own]
            })
        };
        (0..).zip(&self.lines).map(sides_of).collect()
    }

    /// Returns for the left and the right of each line whether a line is there that is wanted, was
    /// not removed, and is not this line; `None` as in [`sides`](Self::sides).
    pub(super) fn sides_with(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<Option<[bool; 2]>> {
        let mut counts = vec![Extent::NOTHING; self.starts.len() - 1];
        for (line, sides) in self.lines.iter().enumerate() {
            if !self.is_removed[line] && is_wanted(line) {
                for &region in sides.iter().flatten() {
                    counts[region as usize].area += 1;
                }
            }
        }
        let sides = self.sides(&counts).into_iter().enumerate();
        sides
            .map(|(line, counts)| {
                // A line that is wanted counts on both of its sides.
                let own = i128::from(!self.is_removed[line] && is_wanted(line));
                Some(counts?.map(|count| count.area > own))
            })
            .collect()
    }

    /// Removes a line, with all that are on one side of it.
    ///
    /// # Complexity
    /// Linear in the lines that are removed.
    pub(super) fn remove(&mut self, line: usize, side: usize) {
        let Some(sides) = self.lines[line].filter(|_| !self.is_removed[line]) else {
            return;
        };
        self.is_removed[line] = true;
        let mut open = vec![sides[side]];
        while let Some(region) = open.pop() {
            let [start, end] = [0, 1].map(|k| self.starts[region as usize + k] as usize);
            for &(line, beyond) in &self.links[start..end] {
                if !std::mem::replace(&mut self.is_removed[line as usize], true) {
                    open.push(beyond);
                }
            }
        }
    }

    /// Returns true if a line was removed.
    pub(super) fn is_removed(&self, line: usize) -> bool {
        self.is_removed[line]
    }

    /// Returns the band of each region, once the lines that were removed no longer divide them.
    /// `levels` are the indices of the levels of the lines; `own` and `extents` are the bands and
    /// the extents of the regions.
    ///
    /// The lines that are left decide: above level `k` is band `k + 1`, below is band `k`. Where
    /// none is left, the largest region does.
    pub(super) fn bands(&self, levels: &[usize], own: &[usize], extents: &[Extent]) -> Vec<usize> {
        let mut bands = own.to_vec();
        let mut is_seen = vec![false; own.len()];
        let mut group = Vec::new();
        for first in 0..own.len() as u32 {
            if std::mem::replace(&mut is_seen[first as usize], true) {
                continue;
            }
            group.clear();
            group.push(first);
            let (mut next, mut stated) = (0, None);
            while let Some(&region) = group.get(next) {
                next += 1;
                for &(line, beyond) in self.links_of(region) {
                    if !self.is_removed(line as usize) {
                        let is_high = self.lines[line as usize].is_some_and(|of| of[1] == region);
                        stated = Some(levels[line as usize] + usize::from(is_high));
                    } else if !std::mem::replace(&mut is_seen[beyond as usize], true) {
                        group.push(beyond);
                    }
                }
            }
            let largest = group
                .iter()
                .max_by_key(|&&region| extents[region as usize].area);
            let band = stated.or(largest.map(|&region| own[region as usize]));
            for &region in &group {
                bands[region as usize] = band.unwrap_or(0);
            }
        }
        bands
    }
}

/// A search in depth of all regions.
struct Forest {
    /// The regions in the order in which they were found.
    order: Vec<u32>,
    /// The position of each region in the order.
    time: Vec<u32>,
    /// The first region that is linked with one below, other than by the line to it.
    low: Vec<u32>,
    /// The region from which each was found, and the line between.
    parent: Vec<u32>,
    line: Vec<u32>,
}

impl Forest {
    fn of(nests: &Nests) -> Self {
        let count = nests.starts.len() - 1;
        let mut forest = Forest {
            order: Vec::with_capacity(count),
            time: vec![NONE; count],
            low: vec![NONE; count],
            parent: vec![NONE; count],
            line: vec![NONE; count],
        };
        // Each open region, with the number of its links that were followed.
        let mut open: Vec<(u32, usize)> = Vec::new();
        for root in 0..count as u32 {
            if forest.time[root as usize] == NONE {
                forest.enter(root);
                open.push((root, 0));
            }
            while let Some((region, followed)) = open.last_mut() {
                let region = *region;
                let Some(&(line, beyond)) = nests.links_of(region).get(*followed) else {
                    open.pop();
                    let parent = forest.parent[region as usize];
                    if parent != NONE {
                        forest.lower(parent, forest.low[region as usize]);
                    }
                    continue;
                };
                *followed += 1;
                if line == forest.line[region as usize] {
                    continue;
                }
                if forest.time[beyond as usize] == NONE {
                    forest.enter(beyond);
                    forest.parent[beyond as usize] = region;
                    forest.line[beyond as usize] = line;
                    open.push((beyond, 0));
                } else {
                    forest.lower(region, forest.time[beyond as usize]);
                }
            }
        }
        forest
    }

    fn enter(&mut self, region: u32) {
        let now = self.order.len() as u32;
        self.order.push(region);
        self.time[region as usize] = now;
        self.low[region as usize] = now;
    }

    fn lower(&mut self, region: u32, time: u32) {
        let low = &mut self.low[region as usize];
        *low = time.min(*low);
    }
}

/// Returns the small side of a line: the inside of a ring, or else the smaller one. A ring that is
/// counter-clockwise has its inside on the left.
pub(super) fn small_side(sides: [Extent; 2], turns_left: Option<bool>) -> SmallSide {
    let is_right = match turns_left {
        Some(turns_left) => !turns_left,
        None => sides[1].area < sides[0].area,
    };
    let side = usize::from(is_right);
    SmallSide {
        side,
        extent: sides[side],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas(areas: &[i128]) -> Vec<Extent> {
        let extent = |&area| Extent {
            area,
            lowest: 0.0,
            highest: area as f64,
        };
        areas.iter().map(extent).collect()
    }

    #[test]
    fn lines_have_sides_unless_they_join_rims() {
        // Regions 0 and 1 share two lines from an inner to an outer rim; 2 is in 1, and 3 in 2.
        let lines = vec![Some([0, 1]), Some([1, 0]), Some([1, 2]), Some([3, 2]), None];
        let nests = Nests::new(lines, 4);
        let extents = areas(&[100, 40, 7, 2]);
        let found = nests.sides(&extents);
        let found = found.map_areas();
        assert_eq!(found, [None, None, Some([140, 9]), Some([2, 147]), None]);
    }

    trait MapAreas {
        fn map_areas(self) -> Vec<Option<[i128; 2]>>;
    }

    impl MapAreas for Vec<Option<[Extent; 2]>> {
        fn map_areas(self) -> Vec<Option<[i128; 2]>> {
            let areas = |sides: [Extent; 2]| sides.map(|side| side.area);
            self.into_iter().map(|sides| sides.map(areas)).collect()
        }
    }

    #[test]
    fn sides_of_a_tree_have_all_that_is_beyond() {
        // A star around 0 with a chain 3-4.
        let lines = vec![Some([0, 1]), Some([2, 0]), Some([0, 3]), Some([3, 4])];
        let nests = Nests::new(lines, 5);
        let extents = areas(&[1, 10, 100, 1000, 10_000]);
        let sides = nests.sides(&extents);
        assert_eq!(sides[0].unwrap()[0].highest, 10_000.0);
        assert_eq!(
            sides.map_areas(),
            [
                Some([11_101, 10]),
                Some([100, 11_011]),
                Some([111, 11_000]),
                Some([1111, 10_000])
            ]
        );
    }

    #[test]
    fn whole_nests_go() {
        let lines = vec![Some([0, 1]), Some([1, 2]), Some([0, 3]), Some([2, 4])];
        let mut nests = Nests::new(lines, 5);
        nests.remove(1, 1);
        assert_eq!(
            [0, 1, 2, 3].map(|i| nests.is_removed(i)),
            [false, true, false, true]
        );
        let bands = nests.bands(&[0, 1, 0, 2], &[0, 1, 2, 1, 3], &areas(&[9, 5, 3, 2, 1]));
        assert_eq!(bands, [0, 1, 1, 1, 1]);
        nests.remove(0, 1);
        nests.remove(2, 1);
        let bands = nests.bands(&[0, 1, 0, 2], &[0, 1, 2, 1, 3], &areas(&[9, 5, 3, 2, 1]));
        assert_eq!(bands, [0; 5]);
    }
}

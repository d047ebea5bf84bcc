//! Triangulates one side of a long corridor in expected linear time (Shewchuk and Brown 2015).
//!
//! The *chain* is the border, on one side, of the triangles that a segment crosses; the *base* is
//! the segment. Vertices are taken out of the chain in pseudo-random order until one is left. They
//! are put back in reverse order, each into the constrained Delaunay triangulation of the others.
//! No search is needed: a vertex returns between the neighbors that it had when it was taken out
//! (Chew 1990).
//!
//! *The tree.* Vertices are named by their positions in the chain. The triangle `i < j < k` is the
//! node `j` of a binary search tree: its parent is the triangle beyond `i k`, its children are
//! those beyond `i j` and `j k`. To flip an edge is to rotate the tree.
//!
//! ```text
//!         j
//!       /   \
//!      i --- k
//!   ...         ...
//! first ======= last
//! ```
//!
//! *Which vertices may be taken out.* Without some of its vertices the chain may cross itself. The
//! polygon then has several layers. It is glued together from quadrilaterals, each between two
//! neighbors in the chain and their edges across the segment. These edges do not cross, so no
//! vertex lies inside of such a quadrilateral, and where two of them meet, their angles add up. One
//! case must be excluded: a vertex that returns into an angle of a full turn or more. Such a vertex
//! is closer to the base than both of its neighbors; so at least half of all vertices may be taken
//! out.

use crate::geometry::Geometry;
use crate::locate::Dice;
use crate::num::Sign;
use crate::tds::VertexId;
use crate::triangulation::Triangulation;

use super::constrained_edges::ConstrainedEdges;
use super::trace::CorridorSide;

/// No node.
const NONE: u32 = u32::MAX;

/// A side that is being triangulated.
struct Tree<'a, G: Geometry<3>, V, C> {
    triangulation: &'a Triangulation<G, 3, V, ConstrainedEdges<C>>,
    side: &'a CorridorSide,
    /// The triangle `i < j < k` of each node `j`, as `[i, k]`.
    bounds: Vec<[u32; 2]>,
    children: Vec<[u32; 2]>,
    /// Nodes whose edge to their parent may have to be flipped.
    to_legalize: Vec<u32>,
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, ConstrainedEdges<C>> {
    /// Triangulates a side. Adds the apexes of its parts, as positions, each part before its first
    /// and its second half. Returns `None`, and adds nothing, if predicates contradict each other.
    ///
    /// Expected time linear in the length of the chain.
    pub(crate) fn triangulate_long(
        &self,
        side: &CorridorSide,
        apexes: &mut Vec<u32>,
    ) -> Option<()> {
        let count = side.chain.len();
        let (gone, neighbors) =
            random_removal_order(count, |u, [p, n]| self.may_be_removed(side, u, p, n))?;
        let mut tree = Tree {
            triangulation: self,
            side,
            bounds: vec![[NONE; 2]; count],
            children: vec![[NONE; 2]; count],
            to_legalize: Vec::new(),
        };
        for &u in gone.iter().rev() {
            tree.insert(u, neighbors[u as usize])?;
        }
        tree.collect_apexes(apexes);
        Some(())
    }

    /// Returns true if the angle at a vertex between two others, on the side of the segment, is
    /// less than a full turn.
    fn may_be_removed(&self, side: &CorridorSide, u: u32, p: u32, n: u32) -> bool {
        let [v, first, last] = [u, p, n].map(|k| side.chain[k as usize]);
        let across = side.across[u as usize];
        // The edge across splits the angle. Both parts are less than half a turn if the neighbors
        // lie on their own sides of that edge.
        match (self.turn(v, across, first), self.turn(v, across, last)) {
            (Sign::Zero, Sign::Zero) | (Sign::Positive, Sign::Negative) => false,
            (Sign::Negative | Sign::Zero, Sign::Zero | Sign::Positive) => true,
            _ => self.turn(v, last, first) == Sign::Positive,
        }
    }
}

/// Takes all positions but the ends out of a chain, in pseudo-random order. `may_be_removed`
/// decides whether a position may be taken out, given its neighbors. Returns the order, and for
/// each position the neighbors that it had.
fn random_removal_order(
    count: usize,
    may_be_removed: impl Fn(u32, [u32; 2]) -> bool,
) -> Option<(Vec<u32>, Vec<[u32; 2]>)> {
    let mut neighbors: Vec<[u32; 2]> = (0..count as u32)
        .map(|u| [u.wrapping_sub(1), u + 1])
        .collect();
    let mut left: Vec<u32> = (1..count as u32 - 1).collect();
    let mut gone = Vec::with_capacity(left.len());
    let mut dice = Dice::default();
    while !left.is_empty() {
        let is_good =
            |&at: &usize| left.len() == 1 || may_be_removed(left[at], neighbors[left[at] as usize]);
        let mut tries = (0..16).map(|_| dice.below(left.len()));
        let at = tries
            .find(is_good)
            .or_else(|| (0..left.len()).find(is_good))?;
        let u = left.swap_remove(at);
        let [p, n] = neighbors[u as usize];
        neighbors[p as usize][1] = n;
        neighbors[n as usize][0] = p;
        gone.push(u);
    }
    Some((gone, neighbors))
}

impl<G: Geometry<3>, V, C: Copy + Default> Tree<'_, G, V, C> {
    fn vertex(&self, u: u32) -> VertexId {
        self.side.chain[u as usize]
    }

    fn turn(&self, [a, b, c]: [u32; 3]) -> Sign {
        self.triangulation
            .turn(self.vertex(a), self.vertex(b), self.vertex(c))
    }

    fn is_end(&self, u: u32) -> bool {
        u == 0 || u as usize == self.side.chain.len() - 1
    }

    /// Returns the triangle beyond the outer edge of a node, which has one of the edge's ends as
    /// its node, and which of its children the given node is.
    fn parent(&self, u: u32) -> Option<(u32, usize)> {
        let [i, k] = self.bounds[u as usize];
        if !self.is_end(i) && self.bounds[i as usize][1] == k {
            Some((i, 1))
        } else {
            (!self.is_end(k)).then_some((k, 0))
        }
    }

    /// Makes a node the child of its parent.
    fn link(&mut self, u: u32) {
        if let Some((parent, child)) = self.parent(u) {
            self.children[parent as usize][child] = u;
        }
    }

    /// Inserts a vertex between its neighbors.
    fn insert(&mut self, u: u32, [p, n]: [u32; 2]) -> Option<()> {
        self.bounds[u as usize] = [p, n];
        if self.is_end(p) && self.is_end(n) {
            return Some(()); // the first triangle
        }
        if self.turn([p, n, u]) == Sign::Positive {
            self.link(u); // an ear
            self.to_legalize.push(u);
        } else {
            self.cut(u)?;
        }
        self.legalize();
        Some(())
    }

    /// Inserts a vertex on the inner side of the edge between its neighbors. Its two edges cut off
    /// the triangles from there up to the one that contains it.
    fn cut(&mut self, u: u32) -> Option<()> {
        // The triangles met, outwards, and their subtrees.
        let (mut path, mut hanging) = (Vec::new(), Vec::new());
        let mut from = (u, self.parent(u)?);
        let [i, k, last] = loop {
            let (below, (node, child)) = from;
            path.push(node);
            hanging.push(self.children[node as usize][1 - child]);
            debug_assert!(below == u || self.children[node as usize][child] == below);
            let [i, k] = self.bounds[node as usize];
            if self.turn([i, k, u]) == Sign::Positive {
                break [i, k, node];
            }
            from = (node, self.parent(node)?);
        };
        path.sort_unstable();
        let middle = path.partition_point(|&node| node < u);
        let (before, behind) = path.split_at(middle);
        // The polygons under the vertex's two edges. The last triangle has a third part.
        let (mut left, mut right) = (vec![u], Vec::with_capacity(behind.len() + 2));
        left.extend((last > u).then_some(i));
        left.extend(before);
        right.extend(behind);
        right.extend((last < u).then_some(k));
        right.push(u);
        self.bounds[u as usize] = [i, k];
        self.bounds[last as usize] = if last < u { [i, u] } else { [u, k] };
        self.wrap(&left)?;
        self.wrap(&right)?;
        self.children[u as usize] = [NONE; 2];
        path.iter()
            .for_each(|&node| self.children[node as usize] = [NONE; 2]);
        let renewed = path
            .iter()
            .chain(&hanging)
            .chain([&u])
            .copied()
            .filter(|&node| node != NONE);
        for node in renewed {
            self.link(node);
            self.to_legalize.push(node);
        }
        Some(())
    }

    /// Triangulates a small polygon that is visible from the edge between its last and first
    /// vertex; clockwise.
    fn wrap(&mut self, polygon: &[u32]) -> Option<()> {
        let chain: Vec<VertexId> = polygon.iter().map(|&u| self.vertex(u)).collect();
        let mut parts = vec![(0, polygon.len() - 1)];
        while let Some((first, last)) = parts.pop() {
            if last - first < 2 {
                continue;
            }
            let apex = first
                + self
                    .triangulation
                    .apex(&chain[first..=last], &Triangulation::is_in_circle)?;
            let mut triangle = [first, apex, last].map(|k| polygon[k]);
            triangle.sort_unstable();
            self.bounds[triangle[1] as usize] = [triangle[0], triangle[2]];
            parts.extend([(apex, last), (first, apex)]);
        }
        Some(())
    }

    /// Flips edges until no vertex lies in the circle of its neighbor's triangle (Lawson 1977).
    fn legalize(&mut self) {
        while let Some(u) = self.to_legalize.pop() {
            let Some((parent, child)) = self.parent(u) else {
                continue;
            };
            let [i, k] = self.bounds[u as usize];
            let outer = self.bounds[parent as usize];
            let triangle = [i, k, u].map(|corner| self.vertex(corner));
            let opposite = outer[1 - child];
            if !self
                .triangulation
                .is_in_circle(triangle, self.vertex(opposite))
            {
                continue;
            }
            let above = self.parent(parent);
            let between = self.children[u as usize][1 - child];
            self.bounds[u as usize] = outer;
            self.bounds[parent as usize][child] = u;
            self.children[parent as usize][child] = between;
            self.children[u as usize][1 - child] = parent;
            if let Some((above, child)) = above {
                self.children[above as usize][child] = u;
            }
            let around = [u, self.children[u as usize][child]]
                .into_iter()
                .chain(self.children[parent as usize]);
            self.to_legalize.extend(around.filter(|&node| node != NONE));
        }
    }

    /// Appends all nodes, each before its children.
    fn collect_apexes(&self, apexes: &mut Vec<u32>) {
        let mut root = 1;
        while let Some((parent, _)) = self.parent(root) {
            root = parent;
        }
        let mut open = vec![root];
        while let Some(node) = open.pop() {
            apexes.push(node);
            let [left, right] = self.children[node as usize];
            open.extend([right, left].into_iter().filter(|&child| child != NONE));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

    use super::*;
    use crate::engine::trace::{TraceBuffers, TraceEnd};
    use crate::geometry::Plane;
    use crate::kernel::{Adaptive, Kernel, Predicate, Range};
    use crate::lines::{ConstrainedDelaunay, OnCrossing};

    type Points = Vec<[f64; 2]>;
    type Segments = Vec<[u32; 2]>;

    fn build<K: Kernel>(
        points: &[[f64; 2]],
        segments: &[[u32; 2]],
    ) -> ConstrainedDelaunay<Plane<K>> {
        ConstrainedDelaunay::from_lines(Plane::default(), points, segments, OnCrossing::Split)
            .unwrap()
            .0
    }

    /// Compares both methods on the sides of the corridors between some vertices; returns the
    /// number of sides compared.
    fn compare(t: &ConstrainedDelaunay<Plane>, dice: &mut Dice, pairs: usize) -> usize {
        let mut buffers = TraceBuffers::default();
        let vertices: Vec<VertexId> = t.tds().vertices().collect();
        let mut compared = 0;
        for _ in 0..pairs {
            let [a, b] = [0; 2].map(|_| vertices[dice.below(vertices.len())]);
            if a == b || !matches!(t.inner.trace(a, b, &mut buffers), TraceEnd::Vertex(_)) {
                continue;
            }
            buffers.right.reverse();
            for side in [&buffers.left, &buffers.right]
                .into_iter()
                .filter(|side| side.chain.len() > 3)
            {
                let (mut naive, mut random) = (Vec::new(), Vec::new());
                t.inner.wrap(side, Triangulation::is_in_circle, &mut naive);
                assert_eq!(t.inner.triangulate_long(side, &mut random), Some(()));
                assert_eq!(random, naive);
                compared += 1;
            }
        }
        compared
    }

    /// On grids, where circles are tied, with lines whose ends reach into the corridors.
    #[test]
    fn the_triangles_are_those_of_gift_wrapping() {
        let mut dice = Dice::default();
        let mut compared = 0;
        for round in 0..80 {
            let (width, height) = (12 + 6 * (round % 8), 2 + round % 9);
            let mut position = || [dice.below(width) as f64, dice.below(height) as f64];
            let points: Points = (0..10 * (1 + round)).map(|_| position()).collect();
            let count = (round % 4) as u32 * 10;
            // Short segments, which make spikes.
            let segments: Segments = (0..count.min(points.len() as u32 / 2))
                .map(|i| [2 * i, 2 * i + 1])
                .collect();
            let few: Segments = segments
                .into_iter()
                .filter(|_| dice.below(3) == 0)
                .collect();
            compared += compare(&build(&points, &few), &mut dice, 60);
        }
        let comb = |i: u32| {
            let (x, low) = (f64::from(i), 1.0 + dice.below(20) as f64);
            [[x, low], [x + dice.below(40) as f64 - 20.0, low + 30.0]]
        };
        let mut points: Points = (0..300).flat_map(comb).collect();
        let segments: Segments = (0..300).map(|i| [2 * i, 2 * i + 1]).collect();
        points.extend([[-9.0, 0.0], [309.0, 0.5]]);
        compared += compare(&build(&points, &segments), &mut dice, 2000);
        assert!(compared > 1000, "{compared} sides");
    }

    static ASKED: AtomicU64 = AtomicU64::new(0);

    #[derive(Debug, Clone, Copy, Default)]
    struct Counting;

    impl Kernel for Counting {
        const RANGE: Range = Adaptive::RANGE;

        fn sign<P: Predicate>(predicate: &P) -> Sign {
            ASKED.fetch_add(1, Relaxed);
            Adaptive::sign(predicate)
        }
    }

    /// Counts the triangles met and the predicates evaluated for long segments side by side. For
    /// 1000 segments it would be 700 times as many, if each met the triangles of all those beside
    /// it.
    #[test]
    fn bundles_take_time_near_linear() {
        let counts = [500, 1000].map(|count: u32| {
            let ends = |i: u32| {
                [
                    [0.1 * f64::from(i), 0.0],
                    [0.1 * f64::from(i) + 1000.0, 1000.0],
                ]
            };
            let points: Points = (0..count).flat_map(ends).collect();
            let segments: Segments = (0..count).map(|i| [2 * i, 2 * i + 1]).collect();
            ASKED.store(0, Relaxed);
            let t = build::<Counting>(&points, &segments);
            assert_eq!(t.constrained_edges().count(), count as usize);
            [t.lines.met() as f64, ASKED.load(Relaxed) as f64]
        });
        for (few, many) in counts[0].into_iter().zip(counts[1]) {
            assert!(many < 2.6 * few && many < 1e6, "{counts:?}");
        }
    }
}

//! Vertices where the height of a surface steps within a rounding error.
//!
//! If a point is closer to a breakline than doubles resolve, the triangle between them is as thin,
//! and as steep as the heights differ. Where a line crosses it, its sides are rounded to one
//! vertex. This vertex can have the height of only one of the sides; the triangle across the other
//! side would be tilted as a whole. So the other side gets a vertex of its own, a unit further out:
//!
//! ```text
//!          |                          |
//!   -------V------- side, breakline   |---W--- side
//!          |                   -------V------- breakline
//!          | line                     |
//! ```
//!
//! If the side itself runs in that direction, to another vertex, it uses the vertex of that one.

use std::cmp::Ordering;
use std::collections::HashSet;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::{Geometry, Terrain, height_along};
use crate::triangulation::num::{Sign, unsigned_zero};
use crate::triangulation::tds::{CellId, VertexId};

use super::order::{compare, first_corner};
use crate::terrain::lines::kinds::LineKinds;

/// Cut lines and edges of triangles after their arrangement.
pub(super) struct Arranged<'a> {
    pub(super) base: &'a ConstrainedDelaunay<Terrain>,
    pub(super) kinds: &'a LineKinds,
    /// The vertices of the triangles, which are the first points.
    pub(super) corners: &'a [VertexId],
    /// The edges of the triangles, from the smaller vertex to the larger, sorted.
    pub(super) edges: &'a [[VertexId; 2]],
    /// The distance between the centers of neighboring pixels.
    pub(super) unit: [f64; 2],
    pub(super) points: Vec<[f64; 3]>,
    /// The points of each cut line, followed by those of each edge, in order.
    pub(super) chains: Vec<Vec<u32>>,
}

/// A side that gets a vertex of its own next to a site.
struct SplitSide {
    edge: usize,
    vertex: u32,
    /// True if the vertex is on the left of the side, from the smaller to the larger of its ends.
    is_left: bool,
    /// The vertices that a line passes between the site and the vertex.
    between: Vec<u32>,
}

/// What a point that is on several edges has its height from.
struct Origin {
    /// The triangles there.
    cells: Vec<CellId>,
    height: f64,
    /// The edge; `None` if it is a vertex.
    edge: Option<usize>,
}

/// Maps sites to the new vertices next to them.
type Steps = FxHashMap<u32, Vec<SplitSide>>;

fn bits(p: &[f64; 3]) -> [u64; 2] {
    [p[0].to_bits(), p[1].to_bits()]
}

impl Arranged<'_> {
    /// Inserts vertices for the sides of steep triangles that share a vertex of a different height.
    ///
    /// # Complexity
    /// Linear in the length of all chains, except for sorting.
    pub(super) fn separate(&mut self) {
        let first_edge = self.chains.len() - self.edges.len();
        let mut edges_at: FxHashMap<u32, Vec<usize>> = FxHashMap::default();
        for (edge, chain) in self.chains[first_edge..]
            .iter()
            .enumerate()
            .filter(|(_, chain)| chain.len() > 2)
        {
            chain[1..chain.len() - 1]
                .iter()
                .for_each(|&site| edges_at.entry(site).or_default().push(edge));
        }
        let mut shared: Vec<(u32, Vec<usize>)> = edges_at.into_iter().collect();
        shared.retain(|(site, edges)| edges.len() > usize::from(self.corner(*site).is_none()));
        // Not by number: that of a crossing depends on the numbering of the edges.
        let position = |points: &[[f64; 3]], site: u32| points[site as usize].map(f64::to_bits);
        shared.sort_unstable_by_key(|(site, _)| position(&self.points, *site));
        let mut taken: HashSet<[u64; 2]> = self.points.iter().map(bits).collect();
        let mut steps: Steps = FxHashMap::default();
        for (site, edges) in shared {
            let here = self.steps_at(site, &edges, first_edge, &mut taken);
            if !here.is_empty() {
                steps.insert(site, here);
            }
        }
        if steps.is_empty() {
            return;
        }
        let order = |site: &u32| position(&self.points, *site);
        let steps = followed(steps, &order);
        for line in 0..first_edge {
            self.chains[line] = self.through_steps(&self.chains[line], &steps, first_edge);
        }
        for (site, here) in steps {
            for SplitSide { edge, vertex, .. } in here {
                let chain = &mut self.chains[first_edge + edge];
                chain
                    .iter_mut()
                    .filter(|at| **at == site)
                    .for_each(|at| *at = vertex);
            }
        }
        self.chains[first_edge..].iter_mut().for_each(Vec::dedup);
    }

    fn corner(&self, site: u32) -> Option<VertexId> {
        self.corners.get(site as usize).copied()
    }

    fn is_breakline(&self, edge: usize) -> bool {
        self.kinds.between(self.base, self.edges[edge]).is_some()
    }

    /// Compares edges by the positions of their ends.
    fn compare_edges(&self, a: usize, b: usize) -> Ordering {
        let geometry = self.base.geometry();
        let ends = |edge: usize| {
            let [p, q] = self.edges[edge].map(|vertex| self.base.point(vertex));
            if geometry.compare(p, q) == Ordering::Greater {
                [q, p]
            } else {
                [p, q]
            }
        };
        let ([a, b], [c, d]) = (ends(a), ends(b));
        geometry.compare(a, c).then_with(|| geometry.compare(b, d))
    }

    fn height_on(&self, edge: usize, site: u32) -> f64 {
        let [u, v] = self.edges[edge].map(|vertex| *self.base.point(vertex));
        let [x, y, _] = self.points[site as usize];
        height_along(u, v, [x, y])
    }

    /// The triangles of the vertex or edge that a point has its height from, and that height.
    /// `None` if there is none.
    fn origin(&self, site: u32, edges: &[usize]) -> Option<Origin> {
        let tds = self.base.tds();
        let mut origin = match self.corner(site) {
            Some(vertex) => Origin {
                cells: tds.around(vertex).collect(),
                height: self.base.point(vertex)[2],
                edge: None,
            },
            None => {
                let heights = edges
                    .iter()
                    .map(|&edge| (!self.is_breakline(edge), self.height_on(edge, site), edge));
                let (_, height, edge) = heights.min_by(|p, q| {
                    let by_height = p.0.cmp(&q.0).then(p.1.total_cmp(&q.1));
                    by_height.then_with(|| self.compare_edges(p.2, q.2))
                })?;
                let [u, v] = self.edges[edge];
                let sides = [tds.edge(u, v), tds.edge(v, u)];
                Origin {
                    cells: sides.into_iter().flatten().map(|(cell, _)| cell).collect(),
                    height,
                    edge: Some(edge),
                }
            }
        };
        // The order must not depend on the numbering of the triangles.
        origin
            .cells
            .sort_unstable_by(|&a, &b| compare(self.base, a, b));
        Some(origin)
    }

    /// The edges at a point that get a vertex of their own, those closer to the point's height
    /// first.
    fn steps_at(
        &mut self,
        site: u32,
        edges: &[usize],
        first_edge: usize,
        taken: &mut HashSet<[u64; 2]>,
    ) -> Vec<SplitSide> {
        let tds = self.base.tds();
        let Some(Origin {
            cells,
            height,
            edge: own,
        }) = self.origin(site, edges)
        else {
            return Vec::new();
        };
        let mut steps: Vec<SplitSide> = Vec::new();
        let mut seen: FxHashSet<CellId> = cells.iter().copied().collect();
        let mut ahead: Vec<(CellId, u32, f64, u32)> = cells
            .into_iter()
            .map(|cell| (cell, site, height, 0))
            .collect();
        while let Some((cell, vertex, height, distance)) = ahead.pop() {
            if tds.is_infinite(cell) {
                continue;
            }
            let first = first_corner(self.base, cell);
            for i in [0, 1, 2].map(|k| (first + k) % 3) {
                let [u, v] = tds.edge_ends(cell, i);
                let edge = self.edges.binary_search(&[u.min(v), u.max(v)]);
                let Some(edge) = edge
                    .ok()
                    .filter(|edge| edges.contains(edge) && Some(*edge) != own)
                else {
                    continue;
                };
                let beyond = tds.neighbor(cell, i);
                if !seen.insert(beyond) {
                    continue;
                }
                let z = self.height_on(edge, site);
                let is_level =
                    tds.is_infinite(beyond) || (z - height).abs() <= self.tolerance(beyond);
                let moved = if is_level {
                    None
                } else {
                    let others = self.edges_of(beyond).filter(|other| !edges.contains(other));
                    let others: Vec<usize> = others.map(|other| first_edge + other).collect();
                    self.beside(
                        site,
                        [u, v],
                        first_edge + edge,
                        distance + 1,
                        &others,
                        taken,
                    )
                };
                let (vertex, height, distance) = match moved {
                    Some(vertex) => (vertex, z, distance + 1),
                    None => (vertex, height, distance),
                };
                if vertex != site {
                    steps.push(SplitSide {
                        edge,
                        vertex,
                        is_left: v < u,
                        between: Vec::new(),
                    });
                }
                ahead.push((beyond, vertex, height, distance));
            }
        }
        // Lines along such an edge share its steps. A chain without inner points has none.
        steps.retain(|step| self.chains[first_edge + step.edge].len() > 2);
        steps
    }

    /// The largest error of a height in a triangle whose vertices are off by a unit.
    fn tolerance(&self, cell: CellId) -> f64 {
        let [a, b, c] = self
            .base
            .tds()
            .corners(cell)
            .map(|vertex| *self.base.point(vertex));
        let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        let area = u[0] * v[1] - u[1] * v[0];
        let slope = ((u[1] * v[2] - u[2] * v[1]) / area).hypot((u[2] * v[0] - u[0] * v[2]) / area);
        let highest = a[2].abs().max(b[2].abs()).max(c[2].abs());
        self.unit[0].max(self.unit[1]) * slope + 1e-12 * highest
    }

    /// The edges of a triangle, as indices.
    fn edges_of(&self, cell: CellId) -> impl Iterator<Item = usize> + '_ {
        let sides = (0..3).map(move |i| self.base.tds().edge_ends(cell, i));
        sides.filter_map(|[u, v]| self.edges.binary_search(&[u.min(v), u.max(v)]).ok())
    }

    /// A new point for the chain of an edge, some units from a site, to the right of the edge.
    ///
    /// Moved to this point, the chain meets none of the others. If the chain runs in that
    /// direction, its next point is returned instead.
    fn beside(
        &mut self,
        site: u32,
        [from, to]: [VertexId; 2],
        chain: usize,
        distance: u32,
        others: &[usize],
        taken: &mut HashSet<[u64; 2]>,
    ) -> Option<u32> {
        let [x, y, _] = self.points[site as usize];
        let [p, q] = [from, to].map(|vertex| *self.base.point(vertex));
        let right = [q[1] - p[1], p[0] - q[0]];
        let longer = right[0].abs().max(right[1].abs());
        let [i, j] = right.map(|side| (side / longer * f64::from(distance)).round());
        let is_that_direction = |other: &u32| {
            let [u, v, _] = self.points[*other as usize];
            let [u, v] = [(u - x) / self.unit[0], (v - y) / self.unit[1]];
            u * j == v * i && u * i + v * j > 0.0
        };
        if let Some(next) = self
            .beside_on(chain, site)
            .into_iter()
            .flatten()
            .find(is_that_direction)
        {
            return Some(next);
        }
        // If it meets another chain, try a little to one side, or less far.
        let turned = |[i, j]: [f64; 2], turn: f64| [i - turn * j, j + turn * i].map(f64::round);
        let tried = [
            [i, j],
            turned([i, j], 0.5),
            turned([i, j], -0.5),
            [i / 2.0, j / 2.0],
            [i / 4.0, j / 4.0],
        ];
        for [i, j] in tried {
            let moved = [
                unsigned_zero(x + i * self.unit[0]),
                unsigned_zero(y + j * self.unit[1]),
                f64::NAN,
            ];
            let is_new = self.base.geometry().admits(&moved) && !taken.contains(&bits(&moved));
            if is_new && self.is_free(site, &moved, chain, others) {
                taken.insert(bits(&moved));
                self.points.push(moved);
                return Some(self.points.len() as u32 - 1);
            }
        }
        None
    }

    /// Returns true if a chain meets no others after one of its sites is replaced by a new point.
    fn is_free(&self, site: u32, moved: &[f64; 3], chain: usize, others: &[usize]) -> bool {
        let point = |site: u32| &self.points[site as usize];
        let side = |p, q, r| self.base.geometry().orientation([p, q, r]);
        let crosses = |end: u32, [c, d]: [u32; 2]| {
            let (b, p, q) = (point(end), point(c), point(d));
            end != c
                && end != d
                && side(moved, b, p) * side(moved, b, q) != Sign::Positive
                && side(p, q, moved) * side(p, q, b) != Sign::Positive
        };
        let mut edges = others
            .iter()
            .flat_map(|&other| self.chains[other].windows(2).map(|pair| [pair[0], pair[1]]));
        let ends = self.beside_on(chain, site);
        edges.all(|edge| !ends.into_iter().flatten().any(|end| crosses(end, edge)))
    }

    /// The points before and after a site on a chain.
    fn beside_on(&self, chain: usize, site: u32) -> [Option<u32>; 2] {
        let chain = &self.chains[chain];
        let at = chain.iter().position(|&other| other == site);
        let next_to = |at: Option<usize>| at.and_then(|at| chain.get(at)).copied();
        [
            next_to(at.and_then(|at| at.checked_sub(1))),
            next_to(at.map(|at| at + 1)),
        ]
    }

    /// The chain of a line with the vertices that it passes before and after steps.
    fn through_steps(&self, chain: &[u32], steps: &Steps, first_edge: usize) -> Vec<u32> {
        let mut through = Vec::with_capacity(chain.len());
        for (at, &site) in chain.iter().enumerate() {
            let none = Vec::new();
            let here = steps.get(&site).unwrap_or(&none);
            // From the innermost to the outermost between the site and its neighbor on the line.
            let passed = |beside: u32| {
                let mut passed: Vec<u32> = Vec::new();
                for step in here
                    .iter()
                    .filter(|step| self.is_beyond(step, site, beside, first_edge))
                {
                    passed.extend(step.between.iter().chain([&step.vertex]));
                }
                passed.dedup();
                passed
            };
            if let Some(&before) = at.checked_sub(1).and_then(|before| chain.get(before)) {
                through.extend(passed(before).into_iter().rev());
            }
            through.push(site);
            if let Some(&after) = chain.get(at + 1) {
                through.extend(passed(after));
            }
        }
        through
    }

    /// Returns true if a point lies on the same side of an edge at a site as the step's vertex.
    fn is_beyond(&self, step: &SplitSide, site: u32, beside: u32, first_edge: usize) -> bool {
        let [Some(before), Some(after)] = self.beside_on(first_edge + step.edge, site) else {
            return false;
        };
        let side = |p: u32, q: u32, r: u32| {
            let [p, q, r] = [p, q, r].map(|site| self.points[site as usize]);
            self.base.geometry().orientation([&p, &q, &r])
        };
        let sides = [side(before, site, beside), side(site, after, beside)];
        let is_left = match side(before, site, after) {
            Sign::Negative => sides.contains(&Sign::Positive),
            _ => sides == [Sign::Positive; 2],
        };
        let is_along = beside == before || beside == after;
        !is_along && is_left == step.is_left
    }
}

/// Resolves steps whose vertex is itself a site on the same edge: each gets the final vertex, and
/// the vertices passed on the way. `order` is that of the sites.
fn followed(mut steps: Steps, order: &dyn Fn(&u32) -> [u64; 3]) -> Steps {
    let on = |steps: &Steps, site: u32, edge: usize| {
        steps
            .get(&site)?
            .iter()
            .find(|step| step.edge == edge)
            .map(|step| step.vertex)
    };
    let mut sites: Vec<u32> = steps.keys().copied().collect();
    sites.sort_unstable_by_key(order);
    for site in sites {
        for at in 0..steps[&site].len() {
            let SplitSide {
                edge, mut vertex, ..
            } = steps[&site][at];
            let mut between = Vec::new();
            while let Some(next) =
                on(&steps, vertex, edge).filter(|next| *next != site && !between.contains(next))
            {
                between.push(vertex);
                vertex = next;
            }
            if let Some(step) = steps.get_mut(&site).and_then(|here| here.get_mut(at)) {
                (step.vertex, step.between) = (vertex, between);
            }
        }
    }
    steps
}

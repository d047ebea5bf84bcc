//! The star of a vertex: what would fill it, what that costs, and how the vertex is removed.

use crate::triangulation::num::Sign;
use crate::triangulation::tds::{ccw, cw};

use super::error::{Slopes, Worst, decided, exceeds};
use super::lines::Lines;
use super::mesh::{Hidden, Mesh, NONE, RimEdge};

/// How many neighbors a vertex may have that is removed: filling a star takes the cube of it.
const LARGEST_STAR: usize = 48;

/// A side of the edge that would replace a line through a star.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
    Either,
}

/// The star of a vertex, and what would fill it without the vertex.
#[derive(Default)]
pub(super) struct Star {
    cells: Vec<u32>,
    /// The neighbors, counter-clockwise; the first edge of triangle `k` leads to neighbor `k`.
    pub(super) ring: Vec<u32>,
    filling: Vec<[u32; 3]>,
    /// The line through the vertex, if there is one.
    line: Option<Through>,
    polygon: Vec<u32>,
}

/// A line through the center of a star, and the edge that would replace it.
#[derive(Clone, Copy)]
struct Through {
    /// Where in the ring the line enters and leaves.
    at: [usize; 2],
    ends: [u32; 2],
    /// How many triangles of the filling are right of the edge.
    right: usize,
}

impl Star {
    /// The ends of the edge that would replace the line through the vertex.
    pub(super) fn new_edge(&self) -> Option<[u32; 2]> {
        self.line.map(|line| line.ends)
    }
}

impl Mesh<'_> {
    /// Finds the star of a vertex. At the hull it begins and ends there, and the ring has one more
    /// vertex than there are triangles.
    pub(super) fn find_star(&self, vertex: u32, star: &mut Star) {
        let first = self.cell_of[vertex as usize];
        if !self.turn_around(vertex, first, star) {
            let mut begin = first;
            loop {
                let i = self.index_of(begin, vertex);
                match self.neighbors[begin as usize][cw(i)] {
                    NONE => break,
                    before => begin = before,
                }
            }
            self.turn_around(vertex, begin, star);
            let last = star.cells[star.cells.len() - 1];
            let i = self.index_of(last, vertex);
            star.ring.push(self.corners[last as usize][cw(i)]);
        }
    }

    /// Returns some vertices and all that are adjacent to them, in the order of their numbers.
    pub(super) fn with_neighbors(&self, vertices: &[u32]) -> Vec<u32> {
        let mut star = Star::default();
        let mut all = vertices.to_vec();
        for &vertex in vertices {
            self.find_star(vertex, &mut star);
            all.extend_from_slice(&star.ring);
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Finds the star of a vertex from one of its triangles on. Returns false if that ends at the
    /// hull.
    fn turn_around(&self, vertex: u32, first: u32, star: &mut Star) -> bool {
        star.cells.clear();
        star.ring.clear();
        let mut cell = first;
        loop {
            let i = self.index_of(cell, vertex);
            star.cells.push(cell);
            star.ring.push(self.corners[cell as usize][ccw(i)]);
            cell = self.neighbors[cell as usize][ccw(i)];
            if cell == NONE || cell == first {
                return cell == first;
            }
        }
    }

    fn index_of(&self, cell: u32, vertex: u32) -> usize {
        let corners = self.corners[cell as usize];
        if corners[0] == vertex {
            0
        } else if corners[1] == vertex {
            1
        } else {
            2
        }
    }

    /// Fills the star of a vertex, which was found, without it. Returns false if it cannot be
    /// removed.
    pub(super) fn fill_star(&self, vertex: u32, star: &mut Star) -> bool {
        if star.ring.len() > LARGEST_STAR {
            return false;
        }
        let is_at_hull = star.ring.len() > star.cells.len();
        if is_at_hull && !self.is_between(vertex, [star.ring[0], star.ring[star.cells.len()]]) {
            return false;
        }
        let is_on_line = |k: usize| {
            let (cell, is_last) = match star.cells.get(k) {
                Some(&cell) => (cell, false),
                None => (star.cells[k - 1], true),
            };
            let i = self.index_of(cell, vertex);
            let side = if is_last { ccw(i) } else { cw(i) };
            self.constrained[cell as usize] >> side & 1 == 1
        };
        let mut on_line = (0..star.ring.len()).filter(|&k| is_on_line(k));
        let at = (on_line.next(), on_line.next(), on_line.next());
        drop(on_line);
        let Star {
            ring,
            filling,
            line,
            polygon,
            ..
        } = star;
        filling.clear();
        polygon.clear();
        *line = None;
        match at {
            (None, ..) => {
                polygon.extend_from_slice(ring);
                self.fill(polygon, filling)
            }
            (Some(from), Some(to), None) if is_at_hull => {
                *line = Some(Through {
                    at: [from, to],
                    ends: [ring[from], ring[to]],
                    right: ring.len() - 2,
                });
                polygon.extend_from_slice(ring);
                from == 0 && to == ring.len() - 1 && self.fill(polygon, filling)
            }
            (Some(from), Some(to), None) => {
                let ends = [ring[from], ring[to]];
                polygon.extend_from_slice(&ring[from..=to]);
                let others = ring[to..].iter().chain(&ring[..=from]).copied();
                let mut left: Vec<u32> = others.collect();
                if !self.is_free(ends, polygon) || !self.is_free(ends, &left) {
                    return false;
                }
                if !self.fill(polygon, filling) {
                    return false;
                }
                *line = Some(Through {
                    at: [from, to],
                    ends,
                    right: filling.len(),
                });
                self.fill(&mut left, filling)
            }
            // An end of a line, or where several meet.
            _ => false,
        }
    }

    /// Returns true if an edge meets no other edge of a chain between its ends.
    fn is_free(&self, [a, b]: [u32; 2], chain: &[u32]) -> bool {
        let side = |site: u32| self.orientation(a, b, site);
        let inner = &chain[1..chain.len() - 1];
        if inner.is_empty() || inner.iter().any(|&site| self.is_between(site, [a, b])) {
            return false;
        }
        chain.windows(2).all(|edge| {
            let [p, q] = [edge[0], edge[1]];
            if [p, q].iter().any(|end| *end == a || *end == b) {
                return true;
            }
            side(p) * side(q) != Sign::Negative
                || self.orientation(p, q, a) * self.orientation(p, q, b) != Sign::Negative
        })
    }

    /// Returns true if a site lies on an edge.
    fn is_between(&self, site: u32, [a, b]: [u32; 2]) -> bool {
        self.orientation(a, b, site) == Sign::Zero && (a < site) == (site < b)
    }

    /// The Delaunay triangulation of a polygon, by ears. Returns false if it is not simple.
    fn fill(&self, polygon: &mut Vec<u32>, filling: &mut Vec<[u32; 3]>) -> bool {
        while polygon.len() > 3 {
            let count = polygon.len();
            let ear = (0..count).find_map(|i| {
                let at = |k: usize| polygon[(i + k) % count];
                let ear = [at(0), at(1), at(2)];
                let is_left = self.orientation(ear[0], ear[1], ear[2]) == Sign::Positive;
                let is_ear = is_left && (3..count).all(|k| !self.is_in_circle(ear, at(k)));
                is_ear.then_some(((i + 1) % count, ear))
            });
            let Some((tip, ear)) = ear else {
                return false;
            };
            filling.push(ear);
            polygon.remove(tip);
        }
        let last = [polygon[0], polygon[1], polygon[2]];
        filling.push(last);
        self.orientation(last[0], last[1], last[2]) == Sign::Positive
    }

    /// The largest error if a vertex were removed, whose star is filled; `None` above the bound.
    pub(super) fn cost(&self, vertex: u32, star: &Star, lines: &Lines) -> Option<f64> {
        let (first, next) = match &self.hidden {
            Hidden::Lattice(_) => return self.cost_on_lattice(star),
            Hidden::Lists { first, next } => (first, next),
        };
        let (mut largest, mut triangle) = (0.0, 0);
        let mut add = |site: u32, side: Side| {
            let Some(at) = self.triangle_with(star, side, triangle, site) else {
                return false;
            };
            triangle = at;
            let error = self.error_of(star.filling[triangle], site);
            largest = f64::max(largest, error);
            error <= self.bound
        };
        if !add(vertex, Side::Either) {
            return None;
        }
        for (k, &cell) in star.cells.iter().enumerate() {
            let mut site = first[cell as usize];
            while site != NONE {
                if !add(site, self.side_of(vertex, star, k, site, lines)) {
                    return None;
                }
                site = next[site as usize];
            }
        }
        Some(largest)
    }

    /// Like [`cost`](Self::cost), where the sites are on a lattice: a vertex that is removed is
    /// hidden as any other cell, and the triangles find it themselves.
    fn cost_on_lattice(&self, star: &Star) -> Option<f64> {
        let mut largest = 0.0;
        for &triangle in &star.filling {
            let Worst { error, .. } = self.worst_in(triangle, self.bound, NONE);
            if error > self.bound {
                return None;
            }
            largest = f64::max(largest, error);
        }
        Some(largest)
    }

    /// The side of the line through a star on which a site must stay that is hidden in triangle
    /// `k`.
    fn side_of(&self, vertex: u32, star: &Star, k: usize, site: u32, lines: &Lines) -> Side {
        match star.line {
            None => Side::Either,
            Some(line) if lines.is_gone_between(site, vertex, line.ends) => Side::Either,
            Some(Through { at: [from, to], .. }) if (from..to).contains(&k) => Side::Right,
            Some(_) => Side::Left,
        }
    }

    /// The error of one site in a triangle; above the bound if, and only if, the real number is.
    fn error_of(&self, mut corners: [u32; 3], site: u32) -> f64 {
        let given = corners;
        corners.sort_unstable();
        let q = self.sites.position(site);
        let of_sites = |corners: [u32; 3]| corners.map(|site| self.sites.position(site));
        let Some(slopes) = Slopes::of(of_sites(corners)) else {
            return f64::MAX;
        };
        let error = slopes.residual(q).abs();
        decided(error, slopes.uncertainty, self.bound, || {
            exceeds(of_sites(given), q, self.bound)
        })
    }

    /// The first triangle of the filling of a star that contains a site, from `start` on; `None` if
    /// there is none on that side of the line through the star.
    fn triangle_with(&self, star: &Star, side: Side, start: usize, q: u32) -> Option<usize> {
        let all = star.filling.len();
        let range = match (star.line, side) {
            (Some(line), Side::Right) => 0..line.right,
            (Some(line), Side::Left) => line.right..all,
            _ => 0..all,
        };
        if side != Side::Either
            && let Some(Through { ends: [a, b], .. }) = star.line
            && self.orientation(a, b, q) == Sign::Zero
        {
            return None;
        }
        let contains = |&k: &usize| {
            let corners = star.filling[k];
            (0..3).all(|i| self.orientation(corners[ccw(i)], corners[cw(i)], q) != Sign::Negative)
        };
        let start = start.clamp(range.start, range.end - 1);
        (start..range.end).chain(range.start..start).find(contains)
    }

    /// Removes a vertex whose star is filled. The worst sites of the new triangles are not found.
    pub(super) fn remove(&mut self, vertex: u32, star: &Star) {
        let list = self.join_lists(&star.cells, NONE);
        let outer: Vec<RimEdge> = star
            .cells
            .iter()
            .map(|&cell| {
                let i = self.index_of(cell, vertex);
                let corners = self.corners[cell as usize];
                RimEdge {
                    ends: [corners[ccw(i)], corners[cw(i)]],
                    beyond: self.neighbors[cell as usize][i],
                    is_constrained: self.constrained[cell as usize] >> i & 1 == 1,
                }
            })
            .collect();
        for &cell in &star.cells {
            self.release(cell);
        }
        let new: Vec<u32> = star.filling.iter().map(|&t| self.take(t)).collect();
        let new_edge = star.new_edge();
        for (k, &cell) in new.iter().enumerate() {
            let corners = self.corners[cell as usize];
            for i in 0..3 {
                let ends = [corners[ccw(i)], corners[cw(i)]];
                self.cell_of[corners[i] as usize] = cell;
                if let Some(edge) = outer.iter().find(|edge| edge.ends == ends) {
                    self.neighbors[cell as usize][i] = edge.beyond;
                    self.constrained[cell as usize] |= u8::from(edge.is_constrained) << i;
                    self.set_beyond(edge.beyond, ends, cell);
                    continue;
                }
                if new_edge.is_some_and(|edge| edge == ends || edge == [ends[1], ends[0]]) {
                    self.constrained[cell as usize] |= 1 << i;
                }
                for &other in &new[..k] {
                    let opposite = self.corners[other as usize];
                    for j in 0..3 {
                        if opposite[ccw(j)] == ends[1] && opposite[cw(j)] == ends[0] {
                            self.neighbors[cell as usize][i] = other;
                            self.neighbors[other as usize][j] = cell;
                        }
                    }
                }
            }
        }
        self.cell_of[vertex as usize] = NONE;
        self.distribute(list, vertex, star, &new);
    }

    /// Distributes a vertex that was removed, and a list, among the triangles that fill its star.
    fn distribute(&mut self, mut list: u32, vertex: u32, star: &Star, new: &[u32]) {
        if let Hidden::Lattice(_) = self.hidden {
            return;
        }
        let mut triangle = 0;
        let mut site = vertex;
        loop {
            // All of the star is filled.
            triangle = self
                .triangle_with(star, Side::Either, triangle, site)
                .unwrap_or(triangle);
            self.hide(new[triangle], site);
            if list == NONE {
                return;
            }
            site = list;
            list = self.after(site);
        }
    }
}

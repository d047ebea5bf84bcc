//! A constrained Delaunay triangulation in which the sites that are no vertices know their
//! triangle.

use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::kernel::{Adaptive, InCircle, Kernel, Orientation2};
use crate::triangulation::num::Sign;
use crate::triangulation::tds::{VertexId, ccw, cw};

use super::error::{Slopes, Worst, decided, exceeds};
use super::lattice::{Columns, Lattice};
use super::sites::Sites;

/// No triangle, or no site.
pub(super) const NONE: u32 = u32::MAX;

/// How the sites that are no vertices are found in a triangle.
#[derive(Debug)]
pub(super) enum Hidden<'a> {
    /// By the columns of a lattice, which has all sites.
    Lattice(&'a Lattice),
    /// By a list for each triangle: its first site, and for each site the next.
    Lists { first: Vec<u32>, next: Vec<u32> },
}

/// A triangulation of some sites, and the distances of all others from it.
///
/// Sites are numbered by rank: from west to east, and from south to north where x is equal. Ties of
/// circles are broken as in [`ConstrainedDelaunay`], so that the triangulation is a function of the
/// vertices and the constraints alone.
pub(super) struct Mesh<'a> {
    pub(super) sites: &'a Sites,
    pub(super) hidden: Hidden<'a>,
    pub(super) bound: f64,
    /// Counter-clockwise; the first is `NONE` if the number is unused.
    pub(super) corners: Vec<[u32; 3]>,
    /// Neighbor `i` lies across the edge opposite corner `i`.
    pub(super) neighbors: Vec<[u32; 3]>,
    /// Bit `i`: the edge opposite corner `i` is constrained.
    pub(super) constrained: Vec<u8>,
    /// The worst hidden site of each triangle. Its error is above the bound if, and only if, that
    /// is true of the real number.
    pub(super) worst: Vec<Worst>,
    unused: Vec<u32>,
    /// A triangle at each vertex; `NONE` for other sites.
    pub(super) cell_of: Vec<u32>,
    /// The triangles that the last insertion made.
    pub(super) fresh: Vec<u32>,
    cavity: Vec<u32>,
    rim: Vec<RimEdge>,
    is_marked: Vec<bool>,
}

/// An edge of a cavity, counter-clockwise around it.
#[derive(Clone, Copy)]
pub(super) struct RimEdge {
    pub(super) ends: [u32; 2],
    pub(super) beyond: u32,
    pub(super) is_constrained: bool,
}

impl<'a> Mesh<'a> {
    /// The triangulation of some sites, with all others hidden in it.
    pub(super) fn new(
        sites: &'a Sites,
        bound: f64,
        vertices: &[u32],
        triangulation: &ConstrainedDelaunay<Terrain>,
        of_vertices: &[VertexId],
    ) -> Self {
        let tds = triangulation.tds();
        let mut site_of = vec![NONE; tds.vertex_slots()];
        for (&site, vertex) in vertices.iter().zip(of_vertices) {
            site_of[vertex.index()] = site;
        }
        let count = triangulation.finite_cells().count();
        let mut number_of = vec![NONE; tds.cell_slots()];
        for (number, cell) in triangulation.finite_cells().enumerate() {
            number_of[cell.index()] = number as u32;
        }
        let hidden = match sites {
            Sites::Lattice { lattice, .. } => Hidden::Lattice(lattice),
            Sites::Scattered { .. } => Hidden::Lists {
                first: vec![NONE; count],
                next: vec![NONE; sites.count()],
            },
        };
        let mut mesh = Mesh {
            cell_of: vec![NONE; sites.count()],
            sites,
            hidden,
            bound,
            corners: Vec::with_capacity(count + count / 4),
            neighbors: Vec::with_capacity(count + count / 4),
            constrained: Vec::with_capacity(count + count / 4),
            worst: vec![Worst::NONE; count],
            unused: Vec::new(),
            fresh: Vec::new(),
            cavity: Vec::new(),
            rim: Vec::new(),
            is_marked: vec![false; count],
        };
        for (number, cell) in triangulation.finite_cells().enumerate() {
            let corners = tds.corners(cell).map(|vertex| site_of[vertex.index()]);
            let beside = [0, 1, 2].map(|i| number_of[tds.neighbor(cell, i).index()]);
            let bit = |i: usize| u8::from(triangulation.is_constrained(cell, i)) << i;
            mesh.corners.push(corners);
            mesh.neighbors.push(beside);
            mesh.constrained.push(bit(0) | bit(1) | bit(2));
            for corner in corners {
                mesh.cell_of[corner as usize] = number as u32;
            }
        }
        mesh
    }

    pub(super) fn cell_slots(&self) -> u32 {
        self.corners.len() as u32
    }

    #[inline(always)]
    pub(super) fn is_used(&self, cell: u32) -> bool {
        self.corners[cell as usize][0] != NONE
    }

    #[inline(always)]
    pub(super) fn is_vertex(&self, site: u32) -> bool {
        self.cell_of[site as usize] != NONE
    }

    #[inline(always)]
    pub(super) fn plan(&self, site: u32) -> [f64; 2] {
        self.sites.plan(site)
    }

    #[inline(always)]
    pub(super) fn orientation(&self, a: u32, b: u32, c: u32) -> Sign {
        Adaptive::sign(&Orientation2([self.plan(a), self.plan(b), self.plan(c)]))
    }

    /// Returns true if a site lies inside of the circle of three others. Ties: the law of
    /// [`ConstrainedDelaunay`]: of all triangulations of points on a circle, the one without a
    /// diagonal at the last of them.
    #[inline(always)]
    pub(super) fn is_in_circle(&self, corners: [u32; 3], q: u32) -> bool {
        let [a, b, c] = corners.map(|site| self.plan(site));
        match Adaptive::sign(&InCircle([a, b, c, self.plan(q)])) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => self.is_in_tied_circle(corners, q),
        }
    }

    fn is_in_tied_circle(&self, corners: [u32; 3], q: u32) -> bool {
        let [a, b, c] = corners;
        let last = a.max(b).max(c);
        if q >= last {
            return false;
        }
        let [a, b, c] = corners.map(|corner| if corner == last { q } else { corner });
        self.orientation(a, b, c) == Sign::Positive
    }

    /// Returns a triangle that contains a site, by a walk. The site is in the convex hull of the
    /// vertices.
    ///
    /// Which side is tried first changes from step to step: with constraints, a walk that always
    /// tries them in one order may go round in circles (Devillers, Pion and Teillaud 2002).
    pub(super) fn locate(&self, mut cell: u32, q: u32) -> u32 {
        let mut from = NONE;
        let mut dice = q;
        'walk: loop {
            let corners = self.corners[cell as usize];
            // The numbers of Numerical Recipes; the high bits are the better ones.
            dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let first = (dice >> 16) as usize % 3;
            for i in [first, ccw(first), cw(first)] {
                let beyond = self.neighbors[cell as usize][i];
                if beyond != from
                    && beyond != NONE
                    && self.orientation(corners[ccw(i)], corners[cw(i)], q) == Sign::Negative
                {
                    from = cell;
                    cell = beyond;
                    continue 'walk;
                }
            }
            return cell;
        }
    }

    /// The site after another one in its list; `NONE` at the end, and on a lattice.
    pub(super) fn after(&self, site: u32) -> u32 {
        match &self.hidden {
            Hidden::Lattice(_) => NONE,
            Hidden::Lists { next, .. } => next[site as usize],
        }
    }

    /// Hides a site in a triangle that contains it.
    pub(super) fn hide(&mut self, cell: u32, site: u32) {
        if let Hidden::Lists { first, next } = &mut self.hidden {
            next[site as usize] = first[cell as usize];
            first[cell as usize] = site;
        }
    }

    /// The worst hidden site of a triangle. Ends early above `limit`: then some site that is worse
    /// than that is returned.
    pub(super) fn worst_in(&self, corners: [u32; 3], limit: f64, list: u32) -> Worst {
        let (worst, uncertainty) = match &self.hidden {
            Hidden::Lattice(lattice) => lattice.worst(corners, limit),
            Hidden::Lists { next, .. } => self.worst_of_list(corners, list, next),
        };
        if worst.error < self.bound - uncertainty || worst.error > self.bound + uncertainty {
            return worst;
        }
        self.worst_at_bound(corners, uncertainty, list)
    }

    #[inline]
    fn worst_of_list(&self, mut corners: [u32; 3], list: u32, next: &[u32]) -> (Worst, f64) {
        corners.sort_unstable();
        let Some(slopes) = Slopes::of(corners.map(|site| self.sites.position(site))) else {
            // Rounded, not really: whatever is in it is in doubt.
            let error = if list == NONE { 0.0 } else { f64::MAX };
            return (Worst { error, site: list }, 0.0);
        };
        let mut worst = Worst::NONE;
        let mut site = list;
        while site != NONE {
            worst.add(slopes.residual(self.sites.position(site)).abs(), site);
            site = next[site as usize];
        }
        (worst, slopes.uncertainty)
    }

    /// Like [`worst_in`](Self::worst_in), where some errors are too near to the bound for rounded
    /// numbers.
    #[cold]
    fn worst_at_bound(&self, corners: [u32; 3], uncertainty: f64, list: u32) -> Worst {
        let mut above = Worst::NONE;
        let mut below = Worst::NONE;
        let positions = corners.map(|site| self.sites.position(site));
        let mut judge = |error: f64, site: u32| {
            let error = decided(error, uncertainty, self.bound, || {
                exceeds(positions, self.sites.position(site), self.bound)
            });
            if error > self.bound {
                above.add(error, site);
            } else {
                below.add(error, site);
            }
        };
        match &self.hidden {
            Hidden::Lattice(lattice) => {
                // A triangle without an area in the lattice was dealt with before.
                let columns = lattice.columns(corners).into_iter();
                for column in columns.flat_map(Columns::all) {
                    for k in 0..column.heights.len() {
                        let error = column.residual(k).abs();
                        let site = column.first + k as u32;
                        if !error.is_nan() && !corners.contains(&site) {
                            judge(error, site);
                        }
                    }
                }
            }
            Hidden::Lists { next, .. } => {
                let mut sorted = corners;
                sorted.sort_unstable();
                if let Some(slopes) = Slopes::of(sorted.map(|site| self.sites.position(site))) {
                    let mut site = list;
                    while site != NONE {
                        judge(slopes.residual(self.sites.position(site)).abs(), site);
                        site = next[site as usize];
                    }
                }
            }
        }
        if above == Worst::NONE { below } else { above }
    }

    /// Finds the worst hidden site of a triangle.
    pub(super) fn measure(&mut self, cell: u32) {
        self.worst[cell as usize] = self.measured(cell);
    }

    pub(super) fn measured(&self, cell: u32) -> Worst {
        let list = self.list(cell);
        self.worst_in(self.corners[cell as usize], f64::INFINITY, list)
    }

    /// Finds the worst hidden sites of the triangles of which none is known: those that removals
    /// made, and those that are exact.
    pub(super) fn measure_new(&mut self) {
        for cell in 0..self.cell_slots() {
            if self.is_used(cell) && self.worst[cell as usize] == Worst::NONE {
                self.measure(cell);
            }
        }
    }

    fn list(&self, cell: u32) -> u32 {
        match &self.hidden {
            Hidden::Lattice(_) => NONE,
            Hidden::Lists { first, .. } => first[cell as usize],
        }
    }

    /// Inserts a site that is hidden in a triangle. The new triangles are `fresh`; their worst
    /// sites are found.
    pub(super) fn insert(&mut self, cell: u32, site: u32) {
        self.find_cavity(cell, site);
        let cavity = std::mem::take(&mut self.cavity);
        let rim = std::mem::take(&mut self.rim);
        let list = self.join_lists(&cavity, site);
        let split = self.split_by(&cavity, site);
        for &cell in &cavity {
            self.release(cell);
        }
        let mut fresh = std::mem::take(&mut self.fresh);
        fresh.clear();
        for edge in &rim {
            let [a, b] = edge.ends;
            let new = self.take([a, b, site]);
            self.neighbors[new as usize][2] = edge.beyond;
            self.set_beyond(edge.beyond, [a, b], new);
            let is_split = |end: u32| u8::from(split.is_some_and(|ends| ends.contains(&end)));
            self.constrained[new as usize] =
                u8::from(edge.is_constrained) << 2 | is_split(a) << 1 | is_split(b);
            self.cell_of[b as usize] = new;
            fresh.push(new);
        }
        for &new in &fresh {
            let [a, ..] = self.corners[new as usize];
            self.cell_of[a as usize] = new;
        }
        for &new in &fresh {
            let [_, b, _] = self.corners[new as usize];
            let next = self.cell_of[b as usize];
            if self.corners[next as usize][0] == b {
                self.neighbors[new as usize][0] = next;
                self.neighbors[next as usize][1] = new;
            }
        }
        self.cell_of[site as usize] = fresh[0];
        self.distribute_in_fan(list, &fresh);
        for &new in &fresh {
            self.measure(new);
        }
        (self.fresh, self.cavity, self.rim) = (fresh, cavity, rim);
    }

    /// Finds the triangles that a site destroys, and the edges around them.
    fn find_cavity(&mut self, cell: u32, site: u32) {
        self.cavity.clear();
        self.rim.clear();
        self.cavity.push(cell);
        self.is_marked[cell as usize] = true;
        let mut k = 0;
        while k < self.cavity.len() {
            let at = self.cavity[k] as usize;
            k += 1;
            for i in 0..3 {
                let beyond = self.neighbors[at][i];
                let is_constrained = self.constrained[at] >> i & 1 == 1;
                let ends = [self.corners[at][ccw(i)], self.corners[at][cw(i)]];
                let is_closed = beyond == NONE || is_constrained;
                let is_split = is_closed && self.orientation(ends[0], ends[1], site) == Sign::Zero;
                if is_split && beyond == NONE {
                    continue;
                }
                if is_split || !is_closed {
                    if self.is_marked[beyond as usize] {
                        continue;
                    }
                    if is_split || self.is_in_circle(self.corners[beyond as usize], site) {
                        self.is_marked[beyond as usize] = true;
                        self.cavity.push(beyond);
                        continue;
                    }
                }
                self.rim.push(RimEdge {
                    ends,
                    beyond,
                    is_constrained,
                });
            }
        }
        for &cell in &self.cavity {
            self.is_marked[cell as usize] = false;
        }
    }

    /// The ends of the constrained edge that a site lies on.
    fn split_by(&self, cavity: &[u32], site: u32) -> Option<[u32; 2]> {
        cavity.iter().find_map(|&cell| {
            let bits = self.constrained[cell as usize];
            let corners = self.corners[cell as usize];
            (0..3)
                .filter(|i| bits >> i & 1 == 1)
                .map(|i| [corners[ccw(i)], corners[cw(i)]])
                .find(|[a, b]| self.orientation(*a, *b, site) == Sign::Zero)
        })
    }

    pub(super) fn take(&mut self, corners: [u32; 3]) -> u32 {
        let number = match self.unused.pop() {
            Some(number) => number,
            None => {
                self.corners.push([NONE; 3]);
                self.neighbors.push([NONE; 3]);
                self.constrained.push(0);
                self.worst.push(Worst::NONE);
                self.is_marked.push(false);
                if let Hidden::Lists { first, .. } = &mut self.hidden {
                    first.push(NONE);
                }
                self.corners.len() as u32 - 1
            }
        };
        let at = number as usize;
        self.corners[at] = corners;
        self.neighbors[at] = [NONE; 3];
        self.constrained[at] = 0;
        self.worst[at] = Worst::NONE;
        number
    }

    pub(super) fn release(&mut self, cell: u32) {
        self.corners[cell as usize][0] = NONE;
        self.worst[cell as usize] = Worst::NONE;
        if let Hidden::Lists { first, .. } = &mut self.hidden {
            first[cell as usize] = NONE;
        }
        self.unused.push(cell);
    }

    /// Links a triangle beyond an edge to the one that is now on this side of it.
    pub(super) fn set_beyond(&mut self, beyond: u32, [a, b]: [u32; 2], cell: u32) {
        if beyond == NONE {
            return;
        }
        let corners = self.corners[beyond as usize];
        for i in 0..3 {
            if corners[ccw(i)] == b && corners[cw(i)] == a {
                self.neighbors[beyond as usize][i] = cell;
            }
        }
    }

    /// Joins the lists of triangles to one, without a site.
    pub(super) fn join_lists(&mut self, cells: &[u32], without: u32) -> u32 {
        let mut list = NONE;
        if let Hidden::Lists { first, next } = &mut self.hidden {
            for &cell in cells {
                let mut site = first[cell as usize];
                while site != NONE {
                    let after = next[site as usize];
                    if site != without {
                        next[site as usize] = list;
                        list = site;
                    }
                    site = after;
                }
            }
        }
        list
    }

    /// Distributes a list among the triangles around a new vertex, their last corner.
    fn distribute_in_fan(&mut self, mut list: u32, fan: &[u32]) {
        let mut at = fan[0];
        while list != NONE {
            let q = list;
            list = self.after(q);
            at = self.turn_to(at, q);
            self.hide(at, q);
        }
    }

    /// The triangle of a fan in whose wedge a site is.
    fn turn_to(&self, start: u32, q: u32) -> u32 {
        let mut at = start;
        let mut turned = NONE;
        loop {
            let [a, b, apex] = self.corners[at as usize];
            let [after, before, _] = self.neighbors[at as usize];
            // The same way until it is there: a fan may be more than a half turn wide.
            if turned != before && before != NONE && self.orientation(apex, a, q) == Sign::Negative
            {
                turned = at;
                at = before;
            } else if turned != after
                && after != NONE
                && self.orientation(apex, b, q) == Sign::Positive
            {
                turned = at;
                at = after;
            } else {
                return at;
            }
        }
    }
}

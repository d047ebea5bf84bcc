//! Lines added, removed and changed in place.
//!
//! The arrangement of the lines is a function of their set, and so is the triangulation of vertices and pieces. An edit
//! therefore arranges the new set of lines, compares, and carries out the difference: what comes out is what building
//! anew would have given, with other numbers.

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

use rustc_hash::FxHashMap;

use crate::arrangement::Arrangement;
use crate::geometry::{Coordinates, Crossing};
use crate::num::Sign;
use crate::tds::VertexId;

use super::super::bulk::spatial_order;
use super::super::locate::Dice;
use super::super::{ConstrainedDelaunay, InputError, LineId, PointError, RemovalError};
use super::build::points_added;
use super::paths::{segments_of, undirected};

/// What lines ask for: segments over the vertices that were given.
struct Demand {
    /// In order.
    given: Vec<VertexId>,
    /// Of each.
    places: Vec<[f64; 2]>,
    /// By positions among these.
    segments: Vec<[u32; 2]>,
}

/// A piece of a line between two sites.
type Piece = [VertexId; 2];

impl<G: Crossing + Coordinates<3>, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Adds a point; the vertex that is there already, if the site is taken. On a constraint, the
    /// constraint is split.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// A walk and time proportional to the number of triangles replaced; and a look at every segment that crosses
    /// others, if there are any: one that the point lies on exactly is led through it from now on.
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, PointError> {
        self.inner.admit(&p)?;
        let is_led = self.lies_on_led(&p);
        let vertex = self.insert_near(p, None);
        self.lent.remove(&vertex);
        if self.claim(vertex) {
            self.replace_point(vertex, p);
        }
        if is_led || self.was_tangled {
            self.rearrange();
        }
        self.insert_waiting();
        Ok(vertex)
    }

    /// Takes a vertex that was given out and returns its point. Constraints that merely run through it go on without
    /// it. Other vertices keep their numbers; the next one that is added gets the number that is now free.
    ///
    /// # Errors
    /// Why it stays.
    ///
    /// # Complexity
    /// A look at all lines; then as [`Delaunay::remove`](crate::Delaunay::remove), or, on a constraint, as
    /// [`remove_line`](Self::remove_line).
    pub fn remove(&mut self, vertex: VertexId) -> Result<G::Point, RemovalError> {
        if !self.tds().is_vertex(vertex) {
            return Err(RemovalError::NoVertex);
        }
        if self.is_added(vertex) {
            return Err(RemovalError::Crossing);
        }
        if let Some(line) = self.lines().find(|&line| self.line_vertices(line).contains(&vertex)) {
            return Err(RemovalError::Line(line));
        }
        let p = *self.point(vertex);
        if self.was_tangled || self.remove_free(vertex).is_none() {
            self.lent.insert(vertex); // needed by nothing but lines, if by these
            self.rearrange();
        }
        Ok(p)
    }

    /// The same with all lines that were given by the vertex, whose ids are returned.
    ///
    /// # Errors
    /// If there is no such vertex, or it is one that lines cross in.
    pub fn remove_with_lines(&mut self, vertex: VertexId) -> Result<(G::Point, Vec<LineId>), RemovalError> {
        let lines: Vec<LineId> = self.lines().filter(|&line| self.line_vertices(line).contains(&vertex)).collect();
        // With its last line, a vertex that came with it would go, too.
        let p = self.tds().is_vertex(vertex).then(|| *self.point(vertex)).ok_or(RemovalError::NoVertex)?;
        for &line in &lines {
            self.lines.given[line.index()] = None;
        }
        if !lines.is_empty() {
            self.lent.insert(vertex);
            self.rearrange();
            return Ok((p, lines));
        }
        Ok((self.remove(vertex)?, lines))
    }

    /// Makes a vertex that was added for a crossing, if it was, one that is given.
    fn claim(&mut self, vertex: VertexId) -> bool {
        let at = self.crossings.binary_search(&vertex);
        at.map(|at| self.crossings.remove(at)).is_ok()
    }

    /// Whether a point lies exactly on a segment that is led through sites.
    fn lies_on_led(&self, p: &G::Point) -> bool {
        let geometry = &self.inner.geometry;
        self.lines.led.keys().any(|&[a, b]| {
            let (a, b) = (self.point(a), self.point(b));
            geometry.side_of_sphere_in_flat(&[a, b], p) == Sign::Positive
                && geometry.orientation([a, b, p]) == Sign::Zero
        })
    }

    /// Adds lines through points; their vertices, where they are new, come and go with them. Returns their ids.
    ///
    /// # Errors
    /// The position, in all lines taken together, of the first point that is refused; nothing has changed then.
    ///
    /// # Complexity
    /// All lines are arranged anew, as by [`from_lines`](Self::from_lines), so that many lines are better added in one
    /// call; the triangulation changes only where they do.
    pub fn insert_lines<L: AsRef<[G::Point]>>(&mut self, lines: &[L]) -> Result<Vec<LineId>, InputError> {
        let points: Vec<G::Point> = lines.iter().flat_map(|line| line.as_ref()).copied().collect();
        if let Some(bad) = points.iter().position(|p| self.inner.admit(p).is_err()) {
            return Err(InputError::Coordinate(bad));
        }
        let vertices = self.insert_lent(&points);
        for (&vertex, &p) in vertices.iter().zip(&points) {
            if self.claim(vertex) {
                self.lent.insert(vertex);
                self.replace_point(vertex, p);
            }
        }
        let mut ids = Vec::with_capacity(lines.len());
        let mut rest = &vertices[..];
        for line in lines {
            let (here, others) = rest.split_at(line.as_ref().len());
            rest = others;
            ids.push(LineId::new(self.lines.given.len()));
            self.lines.given.push(Some(here.into()));
        }
        self.rearrange();
        Ok(ids)
    }

    /// Inserts points whose vertices, where they are new, go with the lines that need them; returns the vertices.
    fn insert_lent(&mut self, points: &[G::Point]) -> Vec<VertexId> {
        let mut vertices = vec![VertexId::INFINITE; points.len()];
        let mut near = None;
        for i in order_of_insertion(&self.inner.geometry, points) {
            let before = self.vertex_count();
            let vertex = self.insert_near(points[i as usize], near);
            if self.vertex_count() > before {
                self.lent.insert(vertex);
            }
            vertices[i as usize] = vertex;
            near = self.tds().cell_of(vertex);
        }
        vertices
    }

    /// Removes a line. Edges that other lines share stay constrained; vertices that were added for it, or came with it,
    /// go if no other line needs them. The triangulation is then the one without the line. Returns whether there was
    /// such a line.
    ///
    /// # Complexity
    /// As for [`insert_lines`](Self::insert_lines).
    pub fn remove_line(&mut self, line: LineId) -> bool {
        let removed = self.lines.given.get_mut(line.index()).and_then(Option::take).is_some();
        if removed {
            self.rearrange();
        }
        removed
    }

    /// Divides a line at one of the vertices that it was given by, counted from 0: it keeps its first part, the rest
    /// becomes a line of its own, whose id is returned. `None` where there is no such vertex, or it is an end.
    ///
    /// # Complexity
    /// Linear in the line's vertices: no triangle changes.
    pub fn split_line(&mut self, line: LineId, at: usize) -> Option<LineId> {
        let given = self.lines.given.get_mut(line.index())?;
        let vertices = given.as_deref()?;
        if at == 0 || at + 1 >= vertices.len() {
            return None;
        }
        let (first, rest) = (vertices[..=at].into(), vertices[at..].into());
        *given = Some(first);
        self.lines.given.push(Some(rest));
        self.lines.touch();
        Some(LineId::new(self.lines.given.len() - 1))
    }

    /// Appends a line to another that ends where it begins; the second id is free then. `false`, and nothing is
    /// changed, if it does not, or they are one line.
    ///
    /// # Complexity
    /// Linear in the lines' vertices: no triangle changes.
    pub fn join_lines(&mut self, first: LineId, second: LineId) -> bool {
        let (head, tail) = (self.line_vertices(first), self.line_vertices(second));
        if first == second || head.is_empty() || head.last() != tail.first() {
            return false;
        }
        let joined = [head, &tail[1..]].concat();
        self.lines.given[first.index()] = Some(joined[..].into());
        self.lines.given[second.index()] = None;
        self.lines.touch();
        true
    }

    /// Carries out the difference between what is there and what the lines ask for.
    pub(in super::super) fn rearrange(&mut self) {
        self.lines.touch();
        let used: HashSet<VertexId> = self.lines.each().flatten().copied().collect();
        let leaving: HashSet<VertexId> = self.lent.iter().copied().filter(|v| !used.contains(v)).collect();
        let demand = self.demand(&leaving);
        if self.dimension() < 2 {
            self.waiting = demand.segments.iter().map(|ends| ends.map(|i| demand.given[i as usize])).collect();
            // What lay between their ends may be there no more.
            self.lines.led.clear();
            self.lines.splits.clear();
            self.take_out(leaving);
            return;
        }
        self.waiting.clear();
        let place = |i: u32| demand.places[i as usize];
        let step = self.inner.geometry.step();
        let arrangement = Arrangement::new(demand.given.len(), place, &demand.segments, step);
        self.left_out = self.carry_out(&arrangement, &demand, leaving);
        self.was_tangled = !self.left_out.is_empty();
        if self.was_tangled {
            let arrangement = arrangement.settled(place, &demand.segments, step);
            self.left_out = self.carry_out(&arrangement, &demand, HashSet::new());
        }
    }

    /// Removes vertices that nothing needs.
    fn take_out(&mut self, leaving: HashSet<VertexId>) {
        self.lent.retain(|v| !leaving.contains(v));
        let mut leaving: Vec<VertexId> = leaving.into_iter().collect();
        leaving.sort_unstable();
        for vertex in leaving {
            self.remove_free(vertex);
        }
    }

    /// What the lines ask for, without vertices that leave.
    fn demand(&self, leaving: &HashSet<VertexId>) -> Demand {
        let is_given = |v: &VertexId| !self.is_added(*v) && !leaving.contains(v);
        let given: Vec<VertexId> = self.tds().vertices().filter(is_given).collect();
        let number = |v: VertexId| given.partition_point(|&other| other < v) as u32;
        let segments = segments_of(self.lines.each(), number);
        let places = given.iter().map(|&v| self.plan_of(v)).collect();
        Demand { given, places, segments }
    }

    /// Makes the triangulation that of an arrangement of what was asked for, without vertices that leave. Returns the
    /// pieces that cross others.
    fn carry_out(
        &mut self,
        arrangement: &Arrangement,
        Demand { given, segments, .. }: &Demand,
        mut leaving: HashSet<VertexId>,
    ) -> Vec<Piece> {
        // Phase 1: sites that stay keep their vertices, others go.
        let mut at_place: HashMap<[u64; 2], VertexId> =
            self.crossings.iter().map(|&v| (key(self.plan_of(v)), v)).collect();
        let mut sites: Vec<Option<VertexId>> = given.iter().copied().map(Some).collect();
        sites.extend(arrangement.added().iter().map(|&place| at_place.remove(&key(place))));
        leaving.extend(at_place.into_values());

        // Phase 2: which pieces are there.
        let mut splits = FxHashMap::default();
        let mut kept = HashSet::new();
        let mut way = Vec::new();
        for (i, &[a, b]) in (0..).zip(segments) {
            let mut from = sites[a as usize];
            for &site in arrangement.chain(i).iter().chain([&b]) {
                let to = sites[site as usize];
                let ends = from.zip(to);
                from = to;
                let Some((from, to)) = ends else { continue };
                way.clear();
                way.push(from);
                self.lines.walk_piece(from, to, &mut way);
                let is_there = way.windows(2).all(|edge| self.is_wall(edge[0], edge[1]));
                if is_there && !way.iter().any(|v| leaving.contains(v)) {
                    kept.extend(way.windows(2).map(|edge| undirected(edge[0], edge[1])));
                    self.lines.copy_splits(from, to, &mut splits);
                }
            }
        }

        // Phase 3: the rest is taken out.
        let constrained: Vec<Piece> = self.constrained_edges().collect();
        for [a, b] in constrained.into_iter().filter(|edge| !kept.contains(edge)) {
            self.clear_wall(a, b);
        }
        self.lines.splits = splits;
        self.crossings.retain(|v| !leaving.contains(v));
        self.take_out(leaving);

        // Phase 4: new sites and pieces are put in.
        let added = points_added(&self.inner.geometry, arrangement, segments, |i| *self.point(given[i as usize]));
        let mut near = None;
        for i in order_of_insertion(&self.inner.geometry, &added) {
            let (site, p) = (&mut sites[given.len() + i as usize], added[i as usize]);
            match *site {
                Some(vertex) => {
                    self.replace_point(vertex, p);
                }
                None => {
                    let count = self.vertex_count();
                    let vertex = self.insert_near(p, near);
                    self.crossings.extend((self.vertex_count() > count).then_some(vertex));
                    *site = Some(vertex);
                    near = self.tds().cell_of(vertex);
                }
            }
        }
        self.crossings.sort_unstable();
        let sites: Vec<VertexId> = sites.into_iter().flatten().collect(); // all of them
        let pieces = self.lines.lead(arrangement, segments, |site| sites[site as usize]);
        let crossing = self.join_all(pieces, arrangement);
        self.lines.touch();
        crossing
    }

    pub(in super::super) fn plan_of(&self, vertex: VertexId) -> [f64; 2] {
        self.inner.geometry.plan(self.point(vertex))
    }
}

/// Returns the order in which points are inserted one by one: a few as they come; many in random
/// rounds, each about twice as large as the one before and in spatial order. Then O(n log n) triangles are expected to
/// come and go, wherever the points lie (Amenta, Choi and Rote 2003).
fn order_of_insertion<G: Coordinates<3>>(geometry: &G, points: &[G::Point]) -> Vec<u32> {
    const FEW: usize = 256;
    if points.len() <= FEW {
        return (0..points.len() as u32).collect();
    }
    let Ok(mut order) = spatial_order(points.len(), |i| geometry.coordinates(&points[i])) else {
        return (0..points.len() as u32).collect(); // more than can be numbered
    };
    let mut dice = Dice::default();
    let mut rounds = vec![0; points.len()];
    // Of points on one site, which come in a row, the first stays the first.
    for here in order.chunk_by(|&i, &j| geometry.compare(&points[i as usize], &points[j as usize]).is_eq()) {
        let round = (1 << 16 | dice.below(1 << 16)).trailing_zeros();
        here.iter().for_each(|&i| rounds[i as usize] = round);
    }
    order.sort_by_key(|&i| Reverse(rounds[i as usize]));
    order
}

/// Equal places have equal keys: coordinates of vertices have one zero only.
fn key(place: [f64; 2]) -> [u64; 2] {
    place.map(|x| (x + 0.0).to_bits())
}

//! Lines added, removed and changed in place.
//!
//! The arrangement of the lines is a function of their set, and so is the triangulation of vertices and pieces. An edit
//! therefore arranges the new set of lines, compares, and carries out the difference: what comes out is what building anew
//! would have given, with other numbers.

use std::collections::{HashMap, HashSet};

use crate::arrangement::Arrangement;
use crate::geometry::{Coordinates, Crossing};
use crate::tds::VertexId;

use super::lines::{Lines, undirected};
use super::{ConstrainedDelaunay, LineId, Refused, Rounding, spatial_order};

/// A piece of a line between two sites.
type Piece = [VertexId; 2];

impl<G: Crossing + Coordinates<3>, V: Default> ConstrainedDelaunay<G, V> {
    /// Adds lines through points; their vertices, where they are new, come and go with them. Returns their ids.
    ///
    /// # Errors
    /// The position, in all lines taken together, of the first point that is refused; nothing has changed then.
    ///
    /// # Complexity
    /// All lines are arranged anew, O(n log n) for n segments of all of them, so that many lines are better added in one call;
    /// the triangulation changes only where they do.
    pub fn insert_lines<L: AsRef<[G::Point]>>(&mut self, lines: &[L]) -> Result<Vec<LineId>, Refused> {
        let points = || lines.iter().flat_map(|line| line.as_ref());
        if let Some(bad) = points().position(|p| self.inner.admit(p).is_err()) {
            return Err(Refused::Coordinate(bad));
        }
        let mut ids = Vec::with_capacity(lines.len());
        for line in lines {
            let mut vertices = Vec::with_capacity(line.as_ref().len());
            for &p in line.as_ref() {
                let before = self.vertex_count();
                let vertex = self.insert_near(p, None);
                if self.vertex_count() > before {
                    self.lent.insert(vertex);
                }
                vertices.push(vertex);
            }
            // What was added for a crossing is given now.
            self.crossings.retain(|vertex| !vertices.contains(vertex) || !self.lent.insert(*vertex));
            ids.push(LineId::new(self.lines.given.len()));
            self.lines.given.push(Some(vertices.into()));
        }
        self.rearrange();
        Ok(ids)
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

    /// Divides a line at one of the vertices that it was given by, counted from 0: it keeps its first part, the rest becomes
    /// a line of its own, whose id is returned. `None` where there is no such vertex, or it is an end.
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

    /// Appends a line to another that ends where it begins; the second id is free then. `false`, and nothing is changed, if
    /// it does not, or they are one line.
    pub fn join_lines(&mut self, first: LineId, second: LineId) -> bool {
        let (head, tail) = (self.line_vertices(first), self.line_vertices(second));
        if first == second || head.is_empty() || head.last() != tail.first() {
            return false;
        }
        let joined = head.iter().chain(&tail[1..]).copied().collect();
        self.lines.given[first.index()] = Some(joined);
        self.lines.given[second.index()] = None;
        self.lines.touch();
        true
    }

    /// Carries out the difference between what is there and what the lines ask for.
    pub(super) fn rearrange(&mut self) {
        self.lines.touch();
        if self.dimension() < 2 {
            self.waiting = self.segments();
            return;
        }
        // Vertices that nothing has given but lines that are gone.
        let used: HashSet<VertexId> = self.lines.given.iter().flatten().flatten().copied().collect();
        let mut leaving: HashSet<VertexId> = self.lent.iter().copied().filter(|v| !used.contains(v)).collect();

        // The new arrangement, over the given vertices in spatial order.
        let is_given = |v: &VertexId| self.crossings.binary_search(v).is_err() && !leaving.contains(v);
        let given: Vec<VertexId> = self.tds().vertices().filter(is_given).collect();
        let mut number: HashMap<VertexId, u32> = HashMap::new();
        for (i, v) in given.iter().enumerate().filter(|(_, v)| used.contains(v)) {
            number.insert(*v, i as u32);
        }
        let segments = self.segments();
        let numbered: Vec<[u32; 2]> = segments.iter().map(|segment| segment.map(|v| number[&v])).collect();
        let geometry = &self.inner.geometry;
        let plan = |v: VertexId| geometry.plan(&self.inner.points[v.index()]);
        let arrangement = Arrangement::new(given.len(), |i| plan(given[i as usize]), &numbered);

        // Sites that stay keep their vertices; others come, or go.
        let mut at_place: HashMap<[u64; 2], VertexId> =
            self.crossings.iter().map(|&v| (plan(v).map(f64::to_bits), v)).collect();
        let added: Vec<Option<VertexId>> =
            arrangement.added().iter().map(|place| at_place.remove(&place.map(f64::to_bits))).collect();
        leaving.extend(at_place.into_values());
        self.clear_all_of(&leaving, &arrangement, &added, &given, &segments);
    }

    /// Each segment of the lines once.
    fn segments(&self) -> Vec<[VertexId; 2]> {
        let lines = self.lines.given.iter().flatten();
        let pairs = lines.flat_map(|line| line.windows(2)).filter(|pair| pair[0] != pair[1]);
        let mut segments: Vec<[VertexId; 2]> = pairs.map(|pair| undirected(pair[0], pair[1])).collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    }
}

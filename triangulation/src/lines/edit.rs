//! Insertion, removal and change of lines.
//!
//! The result is the same, except for numbers, as that of construction from scratch. A few changes
//! are [local edits](super::local_edit). Many changes at once, and those that change the grid,
//! [arrange all lines anew](super::rearrange).

use crate::arrangement::is_ordinary;
use crate::error::{InputError, RemovalError};
use crate::geometry::{Coordinates, Crossing};
use crate::line_id::LineId;
use crate::tds::VertexId;

use super::chains::{Ends, LineVertices, segments_of, undirected};
use super::constrained_delaunay::ConstrainedDelaunay;
use super::index::NotLocal;
use super::local_edit::Edit;
use super::mesh::{Mesh, position};
use super::rearrange::order_of_insertion;
use super::tables::Lines;

impl<G: Crossing + Coordinates<3>, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Updates the lines for a given vertex, which is new, or may have been added for a crossing
    /// before.
    pub(super) fn make_given(
        &mut self,
        vertex: VertexId,
        p: G::Point,
        is_new: bool,
    ) -> Result<(), NotLocal> {
        let was_added = self.lines.added.remove(vertex);
        if was_added {
            self.lines.touch();
            self.replace_point(vertex, p);
        }
        if is_new && !is_ordinary(position(&self.inner, vertex)) {
            self.lines.index.take(); // it is computed again, with this vertex
        }
        if self.lines.chains.bent.is_empty() || !(is_new || was_added) {
            return Ok(());
        }
        Edit::on(&mut self.inner, &mut self.lines)?.make_given(vertex, was_added)
    }

    /// Removes a vertex together with all lines that were given by it. Returns its point and the
    /// ids of the lines.
    ///
    /// # Errors
    /// If there is no such vertex, or it was added where lines cross.
    pub fn remove_with_lines(
        &mut self,
        vertex: VertexId,
    ) -> Result<(G::Point, Vec<LineId>), RemovalError> {
        let p = self
            .tds()
            .is_vertex(vertex)
            .then(|| *self.point(vertex))
            .ok_or(RemovalError::NoVertex)?;
        let lines = self.lines.given_by(&self.inner, vertex);
        if lines.is_empty() {
            return Ok((self.remove(vertex)?, lines));
        }
        self.lines.owned.insert(vertex); // removed with its last line
        self.change_lines(lines.iter().map(|&line| (line, None)).collect());
        Ok((p, lines))
    }

    /// Inserts lines, given by their points, and returns their ids. The lines own their new
    /// vertices: each is removed with the last line that needs it.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one among the points of all
    /// lines. Nothing has changed then.
    ///
    /// # Complexity
    /// For a few lines, a walk from the last insertion, and time linear in the number of triangles
    /// that the lines, and the segments that they cross, meet. The first edit after construction
    /// takes linear time.
    ///
    /// Many lines at once are arranged together with all others, as by
    /// [`from_lines`](Self::from_lines). So are few lines that change the unit of the grid, or that
    /// cross others off the grid (see [`Rounding`](crate::Rounding));
    /// [`rearrangements`](Self::rearrangements) counts how often.
    pub fn insert_lines<L: AsRef<[G::Point]>>(
        &mut self,
        lines: &[L],
    ) -> Result<Vec<LineId>, InputError> {
        let points: Vec<G::Point> = lines
            .iter()
            .flat_map(|line| line.as_ref())
            .copied()
            .collect();
        for (i, p) in points.iter().enumerate() {
            self.inner.admit(p).map_err(|error| error.at(i))?;
        }
        let (vertices, is_known) = self.insert_owned(&points);
        let mut changes = Vec::with_capacity(lines.len());
        let mut rest = &vertices[..];
        for line in lines {
            let (here, others) = rest.split_at(line.as_ref().len());
            rest = others;
            changes.push((
                LineId::new(self.lines.chains.given.len()),
                Some(here.into()),
            ));
            self.lines.chains.given.push(None);
        }
        let ids = changes.iter().map(|(line, _)| *line).collect();
        let before = self.lines.replace(changes);
        if is_known
            .and_then(|()| self.lines.change(&mut self.inner, &before))
            .is_err()
        {
            self.rearrange();
        }
        Ok(ids)
    }

    /// Inserts points whose new vertices are owned by lines. Returns the vertices, and whether the
    /// existing lines could be updated locally.
    fn insert_owned(&mut self, points: &[G::Point]) -> (Vec<VertexId>, Result<(), NotLocal>) {
        let mut vertices = vec![VertexId::INFINITE; points.len()];
        let mut near = None;
        // The first triangles have to hold all that was stored without them.
        let is_local = self.dimension() == 2 && self.lines.is_few(points.len());
        let mut is_known = if is_local { Ok(()) } else { Err(NotLocal) };
        for i in order_of_insertion(&self.inner.geometry, points) {
            let (count, p) = (self.vertex_count(), points[i as usize]);
            let vertex = self.lines.insert_point(&mut self.inner, p, near);
            let is_new = self.vertex_count() > count;
            if is_new || self.is_added(vertex) {
                self.lines.owned.insert(vertex);
            }
            if is_known.is_ok() {
                is_known = self.make_given(vertex, p, is_new);
            } else if self.lines.added.remove(vertex) {
                self.replace_point(vertex, p);
            }
            vertices[i as usize] = vertex;
            near = self.tds().cell_of(vertex);
        }
        (vertices, is_known)
    }

    /// Removes a line; returns false if there is no such line. Edges that other lines share stay
    /// constrained. Vertices that were added for it or are owned by it are removed if no other line
    /// needs them. The result is the triangulation without the line.
    ///
    /// # Complexity
    /// As for [`insert_lines`](Self::insert_lines).
    pub fn remove_line(&mut self, line: LineId) -> bool {
        let is_there = self
            .lines
            .chains
            .given
            .get(line.index())
            .is_some_and(Option::is_some);
        if is_there {
            self.change_lines(vec![(line, None)]);
        }
        is_there
    }

    /// Splits a line at one of the vertices by which it was given, counted from 0. The line keeps
    /// the first part; the rest becomes a new line, whose id is returned. Returns `None` if there
    /// is no such vertex, or it is an end.
    ///
    /// # Complexity
    /// Linear in the line's vertices: no triangle changes.
    pub fn split_line(&mut self, line: LineId, at: usize) -> Option<LineId> {
        let vertices = self.line_vertices(line).to_vec();
        if at == 0 || at + 1 >= vertices.len() {
            return None;
        }
        let rest = LineId::new(self.lines.chains.given.len());
        self.lines.chains.given.push(None);
        self.lines.rename(rest, Some(vertices[at..].into()));
        self.lines.rename(line, Some(vertices[..=at].into()));
        Some(rest)
    }

    /// Appends the second line to the first, which must end where the second begins; the second id
    /// is no longer used. Returns false, and changes nothing, if the lines do not meet like this,
    /// or are one line.
    ///
    /// # Complexity
    /// Linear in the lines' vertices: no triangle changes.
    pub fn join_lines(&mut self, first: LineId, second: LineId) -> bool {
        let (head, tail) = (self.line_vertices(first), self.line_vertices(second));
        if first == second || head.is_empty() || head.last() != tail.first() {
            return false;
        }
        let joined = [head, &tail[1..]].concat();
        self.lines.rename(first, Some(joined[..].into()));
        self.lines.rename(second, None);
        true
    }

    /// Returns how many times all lines have been arranged anew since construction: by edits of
    /// many lines, and by edits that could not be local.
    pub fn rearrangements(&self) -> usize {
        self.lines.rearrangements
    }

    /// Changes the vertices of lines, or removes lines.
    pub(super) fn change_lines(&mut self, changes: Vec<(LineId, Option<LineVertices>)>) {
        let before = self.lines.replace(changes);
        if self.lines.change(&mut self.inner, &before).is_err() {
            self.rearrange();
        }
    }
}

/// Lines, each with the vertices that it had before a change.
type LinesBefore = Vec<(LineId, Option<LineVertices>)>;

impl Lines {
    /// Returns true if so few vertices of lines are changed faster one by one than by a new
    /// arrangement of all lines.
    fn is_few(&self, vertices: usize) -> bool {
        vertices <= 32 + self.chains.given.len() / 32
    }

    /// Returns the lines that were given by a vertex, in order.
    pub(super) fn given_by<G: Crossing, V, C: Copy + Default>(
        &self,
        t: &Mesh<G, V, C>,
        vertex: VertexId,
    ) -> Vec<LineId> {
        let names = |line: &LineId| self.chains.vertices(*line).contains(&vertex);
        if t.dimension() < 2 {
            return self
                .chains
                .numbered()
                .map(|(line, _)| line)
                .filter(names)
                .collect();
        }
        let index = self.index();
        let edges = t
            .constrained_around(vertex)
            .map(|other| undirected(vertex, other));
        let segments = edges.flat_map(|edge| index.segments_on(&self.chains, edge));
        let lines = segments
            .filter(|segment| segment.contains(&vertex))
            .flat_map(|segment| index.lines_of(segment));
        let mut lines: Vec<LineId> = lines
            .chain(index.dots.iter().filter(|line| names(line)))
            .copied()
            .collect();
        lines.sort_unstable();
        lines.dedup();
        lines
    }

    /// Changes the vertices of lines, or removes lines, in the table only; segments follow later.
    /// Returns the old vertices.
    fn replace(&mut self, changes: Vec<(LineId, Option<LineVertices>)>) -> LinesBefore {
        self.index(); // computed before the change
        let given = &mut self.chains.given;
        changes
            .into_iter()
            .map(|(line, new)| (line, std::mem::replace(&mut given[line.index()], new)))
            .collect()
    }

    /// Changes the vertices of a line whose new segments are present already.
    fn rename(&mut self, line: LineId, vertices: Option<LineVertices>) {
        let old = std::mem::replace(&mut self.chains.given[line.index()], vertices);
        if let Some(index) = self.index.get_mut() {
            index.rename(
                line,
                old.as_deref().unwrap_or_default(),
                self.chains.vertices(line),
            );
        }
    }

    /// Carries out a change of lines, given their old vertices.
    fn change<G: Crossing, V: Default, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        before: &LinesBefore,
    ) -> Result<(), NotLocal> {
        let vertices = |(line, old): &(LineId, Option<LineVertices>)| {
            old.as_deref().unwrap_or_default().len() + self.chains.vertices(*line).len()
        };
        if t.dimension() < 2 || !self.is_few(before.iter().map(vertices).sum()) {
            return Err(NotLocal);
        }
        for (line, old) in before {
            let old = old.as_deref().unwrap_or_default();
            let new = self.chains.vertices(*line).to_vec();
            let [gone, come]: [Vec<Ends>; 2] =
                [old, &new].map(|vertices| segments_of([vertices].into_iter(), |v| v));
            let is_in = |segments: &[Ends], segment: &Ends| segments.binary_search(segment).is_ok();
            for &segment in gone.iter().filter(|segment| !is_in(&come, segment)) {
                if self.measured(t)?.detach(segment, *line) {
                    let ends = segment.map(|v| position(t, v));
                    self.measured(t)?.count_ends(ends, false)?;
                    Edit::on(t, self)?.remove_segment(segment)?;
                }
            }
            for &segment in come.iter().filter(|segment| !is_in(&gone, segment)) {
                if !self.measured(t)?.has_segment(segment) {
                    let ends = segment.map(|v| position(t, v));
                    self.measured(t)?.count_ends(ends, true)?;
                    Edit::on(t, self)?.add_segment(segment)?;
                }
                self.measured(t)?.attach(segment, *line);
            }
            self.measured(t)?.dots.retain(|other| other != line);
            if come.is_empty() && self.chains.given[line.index()].is_some() {
                self.measured(t)?.dots.push(*line);
            }
        }
        for &vertex in before
            .iter()
            .filter_map(|(_, old)| old.as_deref())
            .flatten()
        {
            if self.owned.contains(vertex) && self.given_by(t, vertex).is_empty() {
                self.owned.remove(vertex);
                if self.remove_free(t, vertex).is_none() {
                    self.withdraw(t, vertex)?;
                } else if t.dimension() < 2 {
                    return Err(NotLocal);
                }
            }
        }
        Ok(())
    }

    /// Removes a vertex that no line was given by, and that constraints run through.
    pub(super) fn withdraw<G: Crossing, V: Default, C: Copy + Default>(
        &mut self,
        t: &mut Mesh<G, V, C>,
        vertex: VertexId,
    ) -> Result<(), NotLocal> {
        self.owned.insert(vertex); // a new arrangement of all lines removes it, too
        Edit::on(t, self)?.withdraw(vertex)
    }
}

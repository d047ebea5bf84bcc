use rustc_hash::FxHashSet;

use super::ridges::Ridges;
use super::{CellId, Complex, Links, Tds, VertexId, ccw, cw, first_of, space};

/// What a search knows of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mark {
    Unknown,
    Taken,
    /// Not taken, across whatever facet.
    Refused,
}

/// A set of cells that is to be replaced by the star of one vertex, and the facets around it: a
/// conflict zone or a hole.
///
/// The owner keeps it from one insertion to the next, so that no insertion allocates.
#[derive(Debug, Clone)]
pub(crate) struct Zone {
    /// The cells of the zone.
    pub(crate) cells: Vec<CellId>,
    /// The facets on the border: the cell within, and the index of the facet in it. In dimension 2
    /// they are in counter-clockwise order, each starting where the previous one ends; the infinite
    /// vertex may be among their ends.
    pub(crate) border: Vec<(CellId, u8)>,
    /// A mark for each cell number; all unknown between uses.
    marks: Vec<Mark>,
    /// The cells that were marked as refused.
    refused: Vec<CellId>,
    /// The facets that the search has not crossed yet.
    open: Vec<(CellId, u8)>,
    /// The facets of a star that is being linked.
    ridges: Ridges,
    /// The cells of the last star, in the order of the former border, each with the index of the
    /// apex.
    pub(crate) star: Vec<(CellId, u8)>,
}

/// The number of cells and facets for which a zone has room from the start.
const FEW: usize = 16;

impl Default for Zone {
    /// Returns an empty zone, with room for one of usual size.
    fn default() -> Self {
        Zone {
            cells: Vec::with_capacity(FEW),
            border: Vec::with_capacity(FEW),
            marks: Vec::new(),
            refused: Vec::new(),
            open: Vec::with_capacity(FEW),
            ridges: Ridges::default(),
            star: Vec::with_capacity(FEW),
        }
    }
}

impl Zone {
    /// The cells of the zone.
    pub(crate) fn cells(&self) -> &[CellId] {
        &self.cells
    }

    /// The facets on the border: a cell within, and the index of the facet in it. In dimension 2
    /// they are in counter-clockwise order, each starting where the previous one ends; the infinite
    /// vertex may be among their ends.
    pub(crate) fn border(&self) -> impl ExactSizeIterator<Item = (CellId, usize)> + '_ {
        self.border.iter().map(|&(cell, i)| (cell, i as usize))
    }

    /// Returns the finite vertices that are on no facet of the border: no cell will have them.
    pub(crate) fn inner_vertices<const N: usize, V, C: Copy + Default>(
        &self,
        tds: &Tds<N, V, C>,
    ) -> Vec<VertexId> {
        if tds.dimension() == 2 && self.border.len() == self.cells.len() + 2 {
            return Vec::new(); // by Euler's relation
        }
        let on_facet = |&(cell, i): &(CellId, u8)| {
            let vertices = tds.cell_vertices(cell).iter().enumerate();
            vertices
                .filter(move |&(k, _)| k != i as usize)
                .map(|(_, &vertex)| vertex)
        };
        let outer: FxHashSet<VertexId> = self.border.iter().flat_map(on_facet).collect();
        let mut inner: Vec<VertexId> = self
            .cells
            .iter()
            .flat_map(|&cell| tds.cell_vertices(cell))
            .copied()
            .collect();
        inner.retain(|vertex| *vertex != VertexId::INFINITE && !outer.contains(vertex));
        inner.sort_unstable();
        inner.dedup();
        inner
    }

    fn holds(&self, cell: CellId) -> bool {
        self.marks.get(cell.index()) == Some(&Mark::Taken)
    }

    #[inline(always)]
    fn add(&mut self, cell: CellId) {
        self.marks[cell.index()] = Mark::Taken;
        self.cells.push(cell);
    }

    /// Empties the zone.
    pub(crate) fn finish(&mut self) {
        for list in [&mut self.cells, &mut self.refused] {
            for cell in list.iter() {
                self.marks[cell.index()] = Mark::Unknown;
            }
            list.clear();
        }
        self.border.clear();
    }

    /// Grows the zone from a cell over every facet that `takes` accepts, and collects the border.
    ///
    /// `takes` is called with a cell of the zone, the index of the facet, and the cell beyond. In
    /// space, its answer must depend on the cell beyond alone, except at facets of the first cell.
    /// A zone that is only queried is grown in the same order in `triangulation::query`, over any
    /// [`Complex`].
    ///
    /// `PERF:` in space, a cell outside is beyond 1.3 facets on average; its answer is remembered.
    pub(crate) fn grow<const N: usize, V, C: Copy + Default>(
        &mut self,
        tds: &Tds<N, V, C>,
        start: CellId,
        mut takes: impl FnMut(CellId, usize, CellId) -> bool,
    ) {
        debug_assert!(self.cells.is_empty() && self.border.is_empty());
        if self.marks.len() < tds.cell_slots() {
            self.marks.resize(tds.links.capacity(), Mark::Unknown);
        }
        let width = tds.dimension() as u8 + 1;
        tds.fetch_neighbors(start);
        self.add(start);
        for i in (1..width).rev() {
            self.open.push((start, i));
        }
        // In space: a cell was taken after it had been refused across another facet.
        let mut has_taken_late = false;
        // Depth first, over the facets of each cell counter-clockwise from the one through which it
        // was entered: in the plane, the border is then in order.
        let mut next = Some((start, 0));
        while let Some((cell, i)) = next {
            let beyond = tds.neighbor(cell, i as usize);
            let slot = &mut self.marks[beyond.index()];
            let mark = *slot;
            next = if mark == Mark::Taken {
                self.open.pop()
            } else if (mark == Mark::Unknown || cell == start) && takes(cell, i as usize, beyond) {
                has_taken_late |= mark == Mark::Refused;
                if N == 4 {
                    tds.fetch_neighbors(beyond);
                }
                *slot = Mark::Taken;
                self.cells.push(beyond);
                let entry = tds.index_of_neighbor(beyond, cell);
                if width == 3 {
                    self.open.push((beyond, cw(entry) as u8));
                    Some((beyond, ccw(entry) as u8))
                } else {
                    let turned = |turn| {
                        let i = entry as u8 + turn;
                        (beyond, if i < width { i } else { i - width })
                    };
                    self.open.extend((2..width).rev().map(turned));
                    Some(turned(1))
                }
            } else {
                if N == 4 && mark == Mark::Unknown {
                    *slot = Mark::Refused;
                    self.refused.push(beyond);
                }
                self.border.push((cell, i));
                self.open.pop()
            };
        }
        // In the plane, a cell refused across one facet may have been accepted across another. In
        // a ball of triangles, the border has two facets more than there are cells; in any other
        // case the border has to be filtered.
        let is_border_final = match N {
            4 => !has_taken_late,
            _ => width == 3 && self.border.len() == self.cells.len() + 2,
        };
        if !is_border_final {
            let marks = &self.marks;
            self.border
                .retain(|&(cell, i)| marks[tds.neighbor(cell, i as usize).index()] != Mark::Taken);
        }
    }
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Replaces the cells of a zone by the star of `apex`, one cell for each facet of the border,
    /// and returns the new cells in the order of the border.
    ///
    /// `data` returns the payload of a new cell, given that of the cell that had the facet, and its
    /// index. In the new cell, the apex takes the index of the vertex opposite the facet in the old
    /// cell, so that the orientation is kept.
    ///
    /// The zone must be a ball; it is empty afterwards. In space its border may meet itself, as it
    /// does if predicates contradict each other: links are mutual then, too.
    pub(crate) fn star<'a>(
        &mut self,
        zone: &'a mut Zone,
        apex: VertexId,
        data: impl Fn(&C, usize) -> C,
    ) -> &'a [(CellId, u8)] {
        zone.star.clear();
        zone.star.reserve(zone.border.len());
        if self.dimension() == 2 {
            self.star_of_triangles(zone, apex, data);
        } else {
            zone.ridges
                .clear(self.dimension() as usize * zone.border.len());
            for &(old, at) in &zone.border {
                let i = usize::from(at);
                let new = self.add_to_star((old, i), apex, &data);
                self.link_to_star(&mut zone.ridges, new, i);
                zone.star.push((new, at));
            }
            if let Some(&(last, _)) = zone.star.last() {
                self.set_cell_of(apex, last);
                if zone.ridges.is_pinched() {
                    self.link_by_turning(zone);
                }
            }
        }
        self.unused.extend_from_slice(&zone.cells);
        for &cell in &zone.cells {
            self.links[cell.index()] = Links::UNUSED;
        }
        zone.finish();
        &zone.star
    }

    /// Adds the cells of a star in dimension 2, and makes the last one the cell of the apex.
    ///
    /// `PERF:` all are numbered first, so that each is written once, with all its neighbors, and
    /// nothing turns through the zone. Out of line, with the registers to itself.
    #[inline(never)]
    fn star_of_triangles(
        &mut self,
        zone: &mut Zone,
        apex: VertexId,
        data: impl Fn(&C, usize) -> C,
    ) {
        for &(_, at) in &zone.border {
            let new = self.unused.pop();
            let new = new.unwrap_or_else(|| self.add_cell(Links::UNUSED, C::default()));
            zone.star.push((new, at));
        }
        let (Some(&(first, _)), Some(&(last, _))) = (zone.star.first(), zone.star.last()) else {
            return;
        };
        debug_assert!(
            zone.border.windows(2).all(|w| {
                let [[_, end], [start, _]] = [w[0], w[1]]
                    .map(|(cell, i)| [ccw(i.into()), cw(i.into())].map(|k| self.vertex(cell, k)));
                end == start
            }),
            "the border comes in order"
        );
        let (mut before, mut new) = (last, first);
        for (k, &(old, at)) in zone.border.iter().enumerate() {
            let i = usize::from(at);
            let after = zone.star.get(k + 1).map_or(first, |&(cell, _)| cell);
            let facet = &self.links[old.index()];
            let (from, outside) = (facet.vertices[ccw(i)], facet.neighbors[i]);
            let vertices = facet.vertices;
            self.cell_data[new.index()] = data(&self.cell_data[old.index()], i);
            let links = &mut self.links[new.index()];
            *links = Links::alone(vertices);
            links.vertices[i] = apex;
            links.neighbors[i] = outside;
            links.neighbors[cw(i)] = before;
            links.neighbors[ccw(i)] = after;
            self.replace_neighbor(outside, old, new);
            self.set_cell_of(from, new);
            (before, new) = (new, after);
        }
        self.set_cell_of(apex, last);
    }

    /// Adds the cell of a star that gets a facet of the border, and links both sides of that facet.
    #[inline(always)]
    fn add_to_star(
        &mut self,
        (old, i): (CellId, usize),
        apex: VertexId,
        data: impl Fn(&C, usize) -> C,
    ) -> CellId {
        let facet = &self.links[old.index()];
        let outside = facet.neighbors[i];
        let mut links = Links::alone(facet.vertices);
        links.vertices[i] = apex;
        links.neighbors[i] = outside;
        let payload = data(&self.cell_data[old.index()], i);
        let new = self.add_cell(links, payload);
        self.replace_neighbor(outside, old, new);
        new
    }

    /// Replaces a neighbor of a cell by another one.
    #[inline(always)]
    fn replace_neighbor(&mut self, cell: CellId, old: CellId, new: CellId) {
        let neighbors = &mut self.links[cell.index()].neighbors;
        neighbors[first_of(neighbors, old).min(N - 1)] = new;
    }

    /// Links a cell of a star to those before it that share a facet at the apex, whose index is
    /// `apex`, and makes it the cell of its other vertices.
    #[inline(always)]
    fn link_to_star(&mut self, ridges: &mut Ridges, new: CellId, apex: usize) {
        let vertices = self.links[new.index()].vertices;
        let width = (self.dimension() + 1) as usize;
        for ridge in (0..N).filter(|&ridge| ridge != apex && ridge < width) {
            self.set_cell_of(vertices[ridge], new);
            if let Some((other, k)) = ridges.meet(ends(vertices, apex, ridge), (new, ridge)) {
                self.link(new, ridge, other, k);
            }
        }
    }

    /// Links the cells of a star in any dimension: turns around each ridge of the border within the
    /// zone, from one facet of the border to the next. That is right where several pairs of facets
    /// share a ridge, and slower than [`link_to_star`](Self::link_to_star).
    #[cold]
    fn link_by_turning(&mut self, zone: &Zone) {
        let width = (self.dimension() + 1) as usize;
        // The new cells are reached again from within the zone, but are not marked as part of it.
        for (&(old, i), &(new, _)) in zone.border.iter().zip(&zone.star) {
            self.links[old.index()].neighbors[i as usize] = new;
        }
        for (&(old, i), &(new, _)) in zone.border.iter().zip(&zone.star) {
            let i = i as usize;
            for ridge in (0..width).filter(|&ridge| ridge != i) {
                // `cell` has the ridge and two more vertices; go on across the facet that lacks
                // `drop`.
                let (mut cell, mut gain, mut drop) = (old, i, ridge);
                let beyond = loop {
                    let beyond = self.links[cell.index()].neighbors[drop];
                    if !zone.holds(beyond) {
                        break beyond;
                    }
                    let kept = self.links[cell.index()].vertices[gain];
                    gain = self.index_of_neighbor(beyond, cell);
                    drop = self.index_of(beyond, kept).unwrap_or(0);
                    cell = beyond;
                };
                // The border: `beyond` is the new cell there, which has the apex in the slot where
                // `drop` was, and the vertex that was met last beside the ridge.
                self.link(new, ridge, beyond, gain);
            }
        }
    }
}

/// Returns the vertices of a cell except two, which have these indices: one of a triangle, two of a
/// tetrahedron. Below full dimension, some are `NONE`.
#[inline(always)]
fn ends<const N: usize>(vertices: [VertexId; N], i: usize, j: usize) -> [VertexId; 2] {
    match N {
        4 => space::beside(i, j).map(|k| vertices[k.min(N - 1)]),
        _ => [vertices[(3 - i - j).min(N - 1)], VertexId::NONE],
    }
}

#[cfg(test)]
mod tests {
    use testkit::random::Random;

    use super::*;
    use crate::Delaunay;
    use crate::geometry::Space;
    use crate::tds::space::beside;

    /// Returns the facet at the other end of the cells of a zone that lie in a row around a ridge,
    /// given the facet at one end and the vertex opposite the ridge there.
    fn other_end(
        tds: &Tds<4, (), ()>,
        in_zone: impl Fn(CellId) -> bool,
        (cell, i): (CellId, usize),
        ridge: usize,
    ) -> (CellId, u8) {
        let [u, v] = beside(i, ridge);
        let mut around: Vec<_> = tds.cells_around_edge((cell, u, v)).collect();
        // The facet before a cell is opposite the second vertex beside the edge.
        let is_forward = beside(u, v)[1] == i;
        if !is_forward {
            around[1..].reverse();
        }
        let row = around.into_iter().take_while(|&(cell, ..)| in_zone(cell));
        let (last, u, v) = row.last().unwrap();
        (last, beside(u, v)[usize::from(!is_forward)] as u8)
    }

    /// Zones that are no balls: whatever cells are accepted, at every ridge cells of the star are
    /// neighbors if their facets bound the same row of cells.
    #[test]
    fn stars_of_any_zone_are_linked_along_the_zone() {
        let mut random = Random(85);
        let mut t = Delaunay::<Space, 4>::new(Space::new());
        for _ in 0..60 {
            t.insert([(); 3].map(|()| random.unit())).unwrap();
        }
        let (mut pinched, mut zone) = (0, Zone::default());
        for _ in 0..200 {
            let mut tds = t.inner.tds.clone();
            let accepted: Vec<bool> = (0..tds.cell_slots()).map(|_| random.below(5) < 2).collect();
            let start = CellId::new(random.index(accepted.len()));
            if !tds.is_used(start) {
                continue;
            }
            zone.grow(&tds, start, |_, _, beyond| accepted[beyond.index()]);
            let (cells, border) = (zone.cells.clone(), zone.border.clone());
            let mut expected = Vec::new();
            for &(cell, i) in &border {
                for ridge in (0..4).filter(|&ridge| ridge != usize::from(i)) {
                    let in_zone = |cell| cells.contains(&cell);
                    let other = other_end(&tds, in_zone, (cell, i.into()), ridge);
                    let position = border.iter().position(|&facet| facet == other);
                    expected.push((ridge, position.unwrap()));
                }
            }
            let apex = tds.add_vertex(());
            let star = tds.star(&mut zone, apex, |(), _| ());
            let star: Vec<CellId> = star.iter().map(|&(cell, _)| cell).collect();
            pinched += usize::from(zone.ridges.is_pinched());
            for (of_facet, &new) in expected.chunks(3).zip(&star) {
                for &(ridge, other) in of_facet {
                    assert_eq!(tds.neighbor(new, ridge), star[other]);
                }
            }
        }
        assert!(pinched > 50, "{pinched}");
    }
}

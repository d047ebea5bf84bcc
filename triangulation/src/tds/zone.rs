use rustc_hash::FxHashSet;

use super::{CellId, Tds, VertexId, ccw, cw};

/// A set of cells that is to be replaced by the star of one vertex, and the facets around it.
///
/// Kept by its owner from one insertion to the next, so that no insertion allocates.
#[derive(Debug, Clone, Default)]
pub(crate) struct Zone {
    /// The cells.
    pub(crate) cells: Vec<CellId>,
    /// The facets on its border: the cell within, and the index of the facet in it. In dimension 2 they come
    /// counter-clockwise, each where the one before ends; infinity may be between.
    pub(crate) border: Vec<(CellId, u8)>,
    /// For each cell number, whether it is in `cells`; all false between uses.
    marked: Vec<bool>,
    /// The facets that are still to be looked across.
    open: Vec<(CellId, u8)>,
    /// The cells of the last star, in the order of what was the border.
    pub(crate) star: Vec<CellId>,
}

impl Zone {
    /// The cells in the zone.
    pub(crate) fn cells(&self) -> &[CellId] {
        &self.cells
    }

    /// The facets around the zone: a cell within, and the index of the facet in it. In dimension 2 they come
    /// counter-clockwise, each where the one before ends; infinity may be between.
    pub(crate) fn border(&self) -> impl ExactSizeIterator<Item = (CellId, usize)> + '_ {
        self.border.iter().map(|&(cell, i)| (cell, i as usize))
    }

    /// The finite vertices that are on no facet of the border: no cell will be left to them.
    pub(crate) fn inner_vertices<const N: usize, V, C: Copy + Default>(&self, tds: &Tds<N, V, C>) -> Vec<VertexId> {
        if tds.dimension() == 2 && self.border.len() == self.cells.len() + 2 {
            return Vec::new(); // by Euler's relation
        }
        let on_facet = |&(cell, i): &(CellId, u8)| {
            let vertices = tds.cell_vertices(cell).iter().enumerate();
            vertices.filter(move |&(k, _)| k != i as usize).map(|(_, &vertex)| vertex)
        };
        let outer: FxHashSet<VertexId> = self.border.iter().flat_map(on_facet).collect();
        let mut inner: Vec<VertexId> = self.cells.iter().flat_map(|&cell| tds.cell_vertices(cell)).copied().collect();
        inner.retain(|vertex| *vertex != VertexId::INFINITE && !outer.contains(vertex));
        inner.sort_unstable();
        inner.dedup();
        inner
    }

    #[inline(always)]
    fn holds(&self, cell: CellId) -> bool {
        self.marked[cell.index()]
    }

    #[inline(always)]
    fn add(&mut self, cell: CellId) {
        self.marked[cell.index()] = true;
        self.cells.push(cell);
    }

    /// Empties the zone.
    pub(crate) fn finish(&mut self) {
        for cell in self.cells.drain(..) {
            self.marked[cell.index()] = false;
        }
        self.border.clear();
    }

    /// Grows the zone from a cell over every facet that `takes` accepts (asked with a cell of the zone, the index of the
    /// facet, and the cell beyond), and collects the border. A zone that is only asked for grows in the same way, in
    /// `triangulation::query`, over any [`Complex`](super::Complex).
    pub(crate) fn grow<const N: usize, V, C: Copy + Default>(
        &mut self,
        tds: &Tds<N, V, C>,
        start: CellId,
        mut takes: impl FnMut(CellId, usize, CellId) -> bool,
    ) {
        debug_assert!(self.cells.is_empty() && self.border.is_empty());
        if self.marked.len() < tds.cell_slots() {
            self.marked.resize(tds.cell_slots().max(self.marked.capacity()), false);
        }
        let width = tds.dimension() as u8 + 1;
        self.add(start);
        self.open.extend((1..width).rev().map(|i| (start, i)));
        // Depth first, over the facets of each cell counter-clockwise from where it was entered: in the plane the
        // border comes in order.
        let mut next = Some((start, 0));
        while let Some((cell, i)) = next {
            let beyond = tds.neighbor(cell, i as usize);
            next = if self.marked[beyond.index()] {
                self.open.pop()
            } else if takes(cell, i as usize, beyond) {
                self.add(beyond);
                let entry = tds.index_of_neighbor(beyond, cell) as u8;
                let turned = |turn| (beyond, if entry + turn < width { entry + turn } else { entry + turn - width });
                self.open.extend((2..width).rev().map(turned));
                Some(turned(1))
            } else {
                self.border.push((cell, i));
                self.open.pop()
            };
        }
        // A cell refused across one facet may have been taken across another. In a ball of triangles
        // there are two facets more on the border than cells, in any other case it is worth a look.
        if width != 3 || self.border.len() != self.cells.len() + 2 {
            let marked = &self.marked;
            self.border.retain(|&(cell, i)| !marked[tds.neighbor(cell, i as usize).index()]);
        }
    }
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Replaces the cells of a zone by the star of `apex`: one cell for each facet of the border. `data`
    /// says what payload that cell gets, from that of the cell that had the facet and its index. The
    /// new vertex stands in the new cell where the vertex opposite the facet stood in the old one, so
    /// that the orientation is kept.
    ///
    /// The zone must be a ball; it is empty afterwards. Returns the cells of the star, in the order of the border.
    pub(crate) fn star<'a>(
        &mut self,
        zone: &'a mut Zone,
        apex: VertexId,
        data: impl Fn(&C, usize) -> C,
    ) -> &'a [CellId] {
        zone.star.clear();
        for &(old, i) in &zone.border {
            let i = i as usize;
            let mut links = self.links[old.index()];
            links.vertices[i] = apex;
            let outside = links.neighbors[i];
            let payload = data(&self.cell_data[old.index()], i);
            let j = self.index_of_neighbor(outside, old);
            links.neighbors = [CellId::NONE; N];
            links.neighbors[i] = outside;
            let new = self.add_cell(links, payload);
            self.links[outside.index()].neighbors[j] = new;
            zone.star.push(new);
        }
        if self.dimension() == 2 {
            self.link_around(zone, apex);
        } else {
            self.link_by_turning(zone);
        }
        for &cell in &zone.cells {
            self.remove_cell(cell);
        }
        zone.finish();
        &zone.star
    }

    /// Links the triangles of a star, each to the next one, and makes them those of their vertices.
    ///
    /// `PERF:` without turning through the zone, insertion one by one takes 8 % fewer instructions (10 000 uniform
    /// points, callgrind of `bench_editing`).
    fn link_around(&mut self, zone: &Zone, apex: VertexId) {
        let around = zone.border.iter().zip(&zone.star).map(|(&(_, i), &new)| (new, i as usize));
        let Some((mut before, mut i)) = around.clone().next_back() else { return };
        self.set_cell_of(apex, before);
        for (new, k) in around {
            let start = self.links[new.index()].vertices[ccw(k)];
            debug_assert_eq!(start, self.links[before.index()].vertices[cw(i)], "the border comes in order");
            self.set_cell_of(start, new);
            self.link(before, ccw(i), new, cw(k));
            (before, i) = (new, k);
        }
    }

    /// The same in any dimension: one turns around each ridge of the border within the zone, from one facet of the
    /// border to the next.
    fn link_by_turning(&mut self, zone: &mut Zone) {
        let width = (self.dimension() + 1) as usize;
        // The new cells are found again from within the zone, and are none of its.
        for (&(old, i), &new) in zone.border.iter().zip(&zone.star) {
            self.links[old.index()].neighbors[i as usize] = new;
        }
        if zone.marked.len() < self.links.len() {
            zone.marked.resize(self.links.len().max(zone.marked.capacity()), false);
        }
        for (&(old, i), &new) in zone.border.iter().zip(&zone.star) {
            let i = i as usize;
            for ridge in 0..width {
                if ridge == i || self.links[new.index()].neighbors[ridge] != CellId::NONE {
                    continue;
                }
                // `cell` has the ridge and two more vertices; go on across the facet that drops `drop`.
                let (mut cell, mut gain, mut drop) = (old, i, ridge);
                loop {
                    let beyond = self.links[cell.index()].neighbors[drop];
                    if !zone.holds(beyond) {
                        // The border: `beyond` is the new cell there, which has the apex where `drop` was.
                        self.link(new, ridge, beyond, gain);
                        break;
                    }
                    let kept = self.links[cell.index()].vertices[gain];
                    let back = self.index_of_neighbor(beyond, cell);
                    drop = self.index_of(beyond, kept).unwrap_or(0);
                    gain = back;
                    cell = beyond;
                }
            }
        }
        for &new in &zone.star {
            let vertices = self.links[new.index()].vertices;
            vertices[..width].iter().for_each(|&vertex| self.set_cell_of(vertex, new));
        }
    }
}

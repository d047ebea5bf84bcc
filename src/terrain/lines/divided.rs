//! The cells of a triangulation, divided by the lines around areas.

use rustc_hash::FxHashMap;

use crate::terrain::regions::{self, Domain, Faces};
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, LineId};

/// The cells of a triangulation, divided by the lines around areas.
pub(crate) struct Divided<'a> {
    triangulation: &'a ConstrainedDelaunay<Terrain>,
    /// For each edge on such lines, from the smaller vertex to the larger, the areas that it
    /// bounds, each as often as lines around it run along the edge.
    domains: FxHashMap<[VertexId; 2], Vec<Domain>>,
}

impl Faces for Divided<'_> {
    fn beyond(&self, face: u32, side: usize, domains: &mut Vec<Domain>) -> Option<u32> {
        let (tds, cell) = (self.triangulation.tds(), CellId::new(face as usize));
        if self.triangulation.is_constrained(cell, side) {
            let [p, q] = tds.edge_ends(cell, side);
            domains.extend(
                self.domains
                    .get(&[p.min(q), p.max(q)])
                    .into_iter()
                    .flatten(),
            );
        }
        Some(tds.neighbor(cell, side).index() as u32)
    }
}

/// Which areas the cells of a triangulation lie in.
pub(crate) struct Labels {
    /// For each cell number, its label: an index into `areas`.
    pub(crate) of_cells: Vec<u32>,
    /// The areas of each label; none for the first.
    pub(crate) areas: Vec<Vec<Domain>>,
}

impl<'a> Divided<'a> {
    /// Divides a triangulation by the lines around areas, each with the domain that it bounds.
    pub(crate) fn by_rims(
        triangulation: &'a ConstrainedDelaunay<Terrain>,
        rims: impl IntoIterator<Item = (Domain, LineId)>,
    ) -> Self {
        let mut domains: FxHashMap<[VertexId; 2], Vec<Domain>> = FxHashMap::default();
        for (domain, line) in rims {
            for pair in triangulation.chain(line).windows(2) {
                domains
                    .entry([pair[0].min(pair[1]), pair[0].max(pair[1])])
                    .or_default()
                    .push(domain);
            }
        }
        Divided {
            triangulation,
            domains,
        }
    }

    /// The areas that each cell lies in; `None` if there are no cells.
    pub(crate) fn labels(&self) -> Option<Labels> {
        let tds = self.triangulation.tds();
        let start = tds.cell_of(VertexId::INFINITE)?;
        let mut areas: Vec<Vec<Domain>> = vec![Vec::new()];
        let of_cells = regions::label(
            self,
            tds.cell_slots(),
            start.index() as u32,
            Vec::new(),
            |within| {
                if within.is_empty() {
                    return 0;
                }
                areas.push(within.to_vec());
                areas.len() as u32 - 1
            },
        );
        Some(Labels { of_cells, areas })
    }

    /// The areas around each vertex that lies in one or on its border, ordered by vertex. An area
    /// may be named several times.
    pub(crate) fn areas_around(&self, labels: &Labels) -> Vec<(VertexId, Vec<Domain>)> {
        let tds = self.triangulation.tds();
        let mut around: FxHashMap<VertexId, Vec<Domain>> = FxHashMap::default();
        for cell in tds
            .cells()
            .filter(|cell| labels.of_cells[cell.index()] != 0)
        {
            let within = &labels.areas[labels.of_cells[cell.index()] as usize];
            for &vertex in tds
                .corners(cell)
                .iter()
                .filter(|vertex| **vertex != VertexId::INFINITE)
            {
                around.entry(vertex).or_default().extend(within);
            }
        }
        // Where rounding brought banks together, a line around an area may reach a vertex by the
        // edges on which it leaves it, so that no part of it lies between them.
        for (edge, areas) in &self.domains {
            for vertex in edge {
                if let Some(others) = around.get_mut(vertex) {
                    others.extend(areas);
                }
            }
        }
        let mut vertices: Vec<(VertexId, Vec<Domain>)> = around.into_iter().collect();
        vertices.sort_unstable_by_key(|(vertex, _)| *vertex);
        vertices
    }
}

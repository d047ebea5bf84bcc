//! The triangles that segments meet.

use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, Passage};

use crate::terrain::regions::Segment;

/// The triangles that each segment meets: inside, or along or across an edge.
///
/// A triangle that a segment touches only at a corner is not met.
///
/// # Complexity
/// Linear in the number of triangles met, after a walk to each start; for a start outside of the
/// hull, linear in the size of the hull.
pub(super) fn met<'t>(
    triangulation: &'t ConstrainedDelaunay<Terrain>,
    segments: impl IntoIterator<Item = Segment> + 't,
) -> impl Iterator<Item = Vec<CellId>> + 't {
    let tds = triangulation.tds();
    let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for vertex in tds
        .vertices()
        .filter(|&vertex| vertex != VertexId::INFINITE)
    {
        let p = triangulation.point(vertex);
        (0..2).for_each(|k| (min[k], max[k]) = (min[k].min(p[k]), max[k].max(p[k])));
    }
    let mut near = None;
    segments.into_iter().map(move |[a, b]| {
        let is_beside = (0..2).any(|k| a[k].max(b[k]) < min[k] || a[k].min(b[k]) > max[k]);
        let mut cells = Vec::new();
        if is_beside || a == b {
            return cells;
        }
        let add_both = |cells: &mut Vec<CellId>, cell: CellId, i: usize| {
            cells.extend(
                [cell, tds.neighbor(cell, i)]
                    .into_iter()
                    .filter(|&cell| !tds.is_infinite(cell)),
            );
        };
        let [from, to] = [a, b].map(|[x, y]| [x, y, 0.0]);
        for passage in triangulation.along([&from, &to], near) {
            match passage {
                Passage::Face(cell) => cells.push(cell),
                Passage::Edge(cell, i) => add_both(&mut cells, cell, i),
                Passage::Along([u, v]) => {
                    if let Some((cell, i)) = tds.edge(u, v) {
                        add_both(&mut cells, cell, i);
                    }
                }
                Passage::Vertex(_) => {}
            }
        }
        near = cells.last().copied().or(near);
        cells
    })
}

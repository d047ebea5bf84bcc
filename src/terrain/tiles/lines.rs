//! Lines in a task: which sub-constraints are known whole, and what they hide.

use rustc_hash::FxHashMap;

use super::Tile;
use super::disk::Disk;
use super::residual::{Residual, ResidualEdge};
use super::sub_constraint::SubConstraint;
use super::traps::{self, Rule};
use crate::data::EdgeKind;
use crate::error::{Error, Result};
use crate::triangulation::geometry::Terrain;
use crate::triangulation::num::unsigned_zero;
use crate::triangulation::tds::CellId;
use crate::triangulation::{ConstrainedDelaunay, Passage};

/// How many triangles the search for what a triangle sees may reach; then the triangle waits. So a
/// task takes linear time, whatever the lines.
const MOST_REACHED: usize = 256;

/// Returns those sub-constraints that have a point in a tile, with their ends in order.
///
/// # Errors
/// If one cannot be part of a line.
pub(super) fn of_tile(tile: &Tile, constraints: &[SubConstraint]) -> Result<Vec<SubConstraint>> {
    let mut own = Vec::new();
    for constraint in constraints {
        let constraint = constraint.checked()?;
        if constraint.ends[0] != constraint.ends[1] && constraint.meets(tile) {
            own.push(constraint);
        }
    }
    Ok(own)
}

/// Turns pending sub-constraints whose ends are both known into edges.
///
/// # Errors
/// If an end is in the tile and no vertex is there: a sub-constraint keeps the vertices on it in
/// the residual, so its line was given without the point.
pub(super) fn join_known(tile: &Tile, residual: &mut Residual) -> Result<()> {
    let pending = residual
        .pending
        .iter()
        .map(SubConstraint::checked)
        .collect::<Result<Vec<_>>>()?;
    let key = |site: [f64; 2]| site.map(|x| unsigned_zero(x).to_bits());
    let mut vertex_at: FxHashMap<[u64; 2], Option<u32>> = pending
        .iter()
        .flat_map(|constraint| constraint.ends)
        .map(|end| (key(end), None))
        .collect();
    if vertex_at.is_empty() {
        return Ok(());
    }
    for (number, vertex) in (0..).zip(&residual.vertices) {
        if let Some(at @ None) = vertex_at.get_mut(&key(vertex.site())) {
            *at = Some(number);
        }
    }
    residual.pending.clear();
    for constraint in pending {
        let ends = constraint
            .ends
            .map(|end| vertex_at.get(&key(end)).copied().flatten());
        for (&end, vertex) in constraint.ends.iter().zip(ends) {
            if vertex.is_none() && tile.holds(end) {
                return Err(Error::format(format!(
                    "a line ends at {end:?}, where its tile has no point"
                ))
                .cure("pass the vertices of lines as points, too, to the tile that they are in"));
            }
        }
        match ends {
            [Some(a), Some(b)] => {
                residual.edges.push(ResidualEdge {
                    ends: [a, b],
                    is_seam: false,
                    kind: constraint.kind,
                });
            }
            _ => residual.pending.push(constraint),
        }
    }
    // Each part that it meets brings it.
    let order = |constraint: &SubConstraint| (constraint.ends.map(key), constraint.kind.number());
    residual.pending.sort_unstable_by_key(order);
    residual.pending.dedup();
    Ok(())
}

/// The lines of a task: the constraints of its triangulation, which are the edges of a residual,
/// and what they mean for its triangles.
pub(super) struct Lines<'a> {
    t: &'a ConstrainedDelaunay<Terrain>,
    residual: &'a Residual,
    /// For each cell, true if a pending sub-constraint enters it or runs along one of its edges;
    /// empty without lines.
    entered: Vec<bool>,
}

impl<'a> Lines<'a> {
    /// Returns the lines of a triangulation of dimension 2. The ids of its lines are the positions
    /// of the edges.
    pub(super) fn new(
        tile: &Tile,
        t: &'a ConstrainedDelaunay<Terrain>,
        residual: &'a Residual,
    ) -> Self {
        let tds = t.tds();
        if !residual.has_lines {
            return Lines {
                t,
                residual,
                entered: Vec::new(),
            };
        }
        let mut entered = vec![false; tds.cell_slots()];
        for constraint in &residual.pending {
            // From a known end, if there is one: finding the way into the hull takes longer.
            let [a, b] = constraint.ends;
            let ends = if tile.holds(a) { [a, b] } else { [b, a] };
            let [from, to] = ends.map(|[x, y]| [x, y, 0.0]);
            for passage in t.along([&from, &to], None) {
                match passage {
                    Passage::Face(cell) => entered[cell.index()] = true,
                    Passage::Along(_) if traps::is_off(Rule::AlongEdges) => {}
                    Passage::Along([from, to]) => {
                        for (cell, _) in [tds.edge(from, to), tds.edge(to, from)]
                            .into_iter()
                            .flatten()
                        {
                            entered[cell.index()] = true;
                        }
                    }
                    // It touches these, or enters the faces beside them.
                    Passage::Edge(..) | Passage::Vertex(_) => {}
                }
            }
        }
        Lines {
            t,
            residual,
            entered,
        }
    }

    /// Returns the kind of the edge opposite corner `i` of a cell.
    pub(super) fn kind(&self, cell: CellId, i: usize) -> EdgeKind {
        if !self.t.is_constrained(cell, i) {
            return EdgeKind::Plain;
        }
        let [a, b] = self.t.tds().edge_ends(cell, i);
        let kinds = self
            .t
            .lines_through(a, b)
            .map(|line| self.residual.edges[line.index()].kind);
        kinds.min_by_key(|kind| kind.rank()).unwrap_or_default()
    }

    /// Returns true if a pending sub-constraint enters a cell or runs along one of its edges.
    pub(super) fn enter(&self, cell: CellId) -> bool {
        self.entered
            .get(cell.index())
            .is_some_and(|is_entered| *is_entered)
    }

    /// Returns true if constraints hide from a cell all that is in its disk outside of the tile. In
    /// doubt returns false.
    ///
    /// A line of sight from the cell to a position in the disk stays in the disk, and leaves
    /// triangles by edges that are not constrained. Beyond the line through such an edge it stays,
    /// too. So where the disk misses the edge, or is within the tile beyond its line, there is
    /// nothing to be seen. The search ends there. It fails where it leaves the hull.
    pub(super) fn hide_all_outside(&self, tile: &Tile, disk: &Disk, cell: CellId) -> bool {
        if !self.residual.has_lines || traps::is_off(Rule::VisiblePart) {
            return false;
        }
        let tds = self.t.tds();
        let mut reached = vec![cell];
        let mut next = 0;
        while let Some(&from) = reached.get(next) {
            next += 1;
            for i in (0..3).filter(|&i| !self.t.is_constrained(from, i)) {
                let beyond = tds.neighbor(from, i);
                if reached.contains(&beyond) {
                    continue;
                }
                let edge = tds
                    .edge_ends(from, i)
                    .map(|end| *self.t.point(end))
                    .map(|[x, y, _]| [x, y]);
                if disk.misses(edge) || disk.is_within_beyond(edge, tile) {
                    continue;
                }
                if tds.is_infinite(beyond) || reached.len() == MOST_REACHED {
                    return false;
                }
                reached.push(beyond);
            }
        }
        true
    }
}

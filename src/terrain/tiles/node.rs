//! One task: points or residuals in, final triangles and a residual out.

use super::Tile;
use super::disk::Disk;
use super::lines::{self, Lines};
use super::part::TinPart;
use super::residual::{Residual, ResidualEdge};
use super::sub_constraint::SubConstraint;
use super::triangle::{TileTriangle, TileVertex};
use crate::data::EdgeKind;
use crate::error::{Error, Result};
use crate::terrain::admitted;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, InputError, OnCrossing};

/// Triangulates the points of a tile, with lines. Calls `emit` for each final triangle, and returns
/// what may still change.
///
/// Where points share a site, the first of them is used.
///
/// Lines come as sub-constraints. The tile needs all that meet it, wherever their ends are; others
/// are ignored. They must not cross between their ends, in this tile or elsewhere; an
/// [`Arrangement`](crate::triangulation::arrangement::Arrangement) of all lines makes such ones.
/// Their ends must be points, too, of the tiles that these are in.
///
/// Vertices at triangles that are narrower than `tight` are marked, see [`TileVertex::is_tight`].
/// Only a clip needs them: [`TileClip::tight`](super::TileClip::tight) returns the width, and zero
/// marks none.
///
/// # Errors
/// If a point lies outside of the tile, whose extent is then wrong; if a point or an end of a line
/// has a coordinate that is not finite or outside of the range of the arithmetic; if a line ends in
/// the tile at a site without a point; if a kind is not that of a line; or if lines cross.
///
/// # Complexity
/// That of [`Delaunay::from_points`](crate::triangulation::Delaunay::from_points); with lines, that
/// of [`ConstrainedDelaunay::from_lines`](crate::triangulation::ConstrainedDelaunay::from_lines).
pub fn leaf(
    tile: &Tile,
    number: u32,
    points: &[[f64; 3]],
    constraints: &[SubConstraint],
    tight: f64,
    emit: &mut dyn FnMut(TileTriangle),
) -> Result<Residual> {
    reduce(
        tile,
        of_points(tile, number, points, constraints)?,
        tight,
        emit,
        |_| (),
    )
    .map(|(residual, _)| residual)
}

/// Does what [`leaf`] does, and also returns the triangulation of the tile, or `None` if it has no
/// triangle.
///
/// # Errors
/// Those of [`leaf`].
///
/// # Complexity
/// That of [`leaf`].
pub fn leaf_with_part(
    tile: &Tile,
    number: u32,
    points: &[[f64; 3]],
    constraints: &[SubConstraint],
    tight: f64,
    emit: &mut dyn FnMut(TileTriangle),
) -> Result<(Residual, Option<TinPart>)> {
    reduce(
        tile,
        of_points(tile, number, points, constraints)?,
        tight,
        emit,
        |finished| finished.into_part(),
    )
}

/// Returns the points of a tile and the sub-constraints that meet it as a residual.
fn of_points(
    tile: &Tile,
    number: u32,
    points: &[[f64; 3]],
    constraints: &[SubConstraint],
) -> Result<Residual> {
    if let Some(at) = points.iter().position(|&[x, y, _]| !tile.holds([x, y])) {
        let ([x, y, _], Tile { min, max }) = (points[at], tile);
        return Err(Error::format(format!(
            "point {at} of tile {number} is at {x} {y}, expected x from {} to below {}, y from {} to below {}",
            min[0], max[0], min[1], max[1]
        ))
        .cure("the extent of the tile is wrong: take it from the points, not from the header"));
    }
    let vertex = |(at, &position): (usize, &[f64; 3])| TileVertex {
        tile: number,
        number: at as u32,
        position,
        is_tight: false,
    };
    let vertices = points.iter().enumerate().map(vertex).collect();
    let pending = lines::of_tile(tile, constraints)?;
    let has_lines = !pending.is_empty();
    Ok(Residual {
        vertices,
        edges: Vec::new(),
        pending,
        has_lines,
    })
}

/// Merges the residuals of parts of a tile. Calls `emit` for each triangle that is final now, and
/// returns what may still change.
///
/// The tile is the union of those of the parts. With [`Tile::PLANE`] all triangles are final, and
/// the edges of the residual are those of the hull. `tight` is that of [`leaf`], the same in all
/// tasks.
///
/// # Errors
/// If an edge names a vertex that does not exist, or the residuals contradict each other: they are
/// not those of parts of one triangulation.
///
/// # Complexity
/// That of [`leaf`], for the vertices and edges of the residuals.
pub fn merge(
    tile: &Tile,
    parts: &[Residual],
    tight: f64,
    emit: &mut dyn FnMut(TileTriangle),
) -> Result<Residual> {
    reduce(tile, Residual::joined(parts)?, tight, emit, |_| ()).map(|(residual, _)| residual)
}

/// Does what [`merge`] does, and also returns the triangulation of the residuals, or `None` if it
/// has no triangle.
///
/// # Errors
/// Those of [`merge`].
///
/// # Complexity
/// That of [`merge`].
pub fn merge_with_part(
    tile: &Tile,
    parts: &[Residual],
    tight: f64,
    emit: &mut dyn FnMut(TileTriangle),
) -> Result<(Residual, Option<TinPart>)> {
    reduce(tile, Residual::joined(parts)?, tight, emit, |finished| {
        finished.into_part()
    })
}

/// A triangulation whose final triangles were emitted.
struct Finished<'a> {
    t: ConstrainedDelaunay<Terrain>,
    input: &'a Residual,
    /// For each vertex, the first one of the input at its site.
    input_of: Vec<u32>,
    /// The positions among all cells of the triangles that were emitted.
    emitted: Vec<u32>,
}

impl Finished<'_> {
    fn into_part(self) -> TinPart {
        let number = |id: VertexId| {
            let TileVertex { tile, number, .. } =
                self.input.vertices[self.input_of[id.index()] as usize];
            [tile, number]
        };
        let numbers = self.t.tds().vertices().map(number).collect();
        let kinds = self
            .input
            .edges
            .iter()
            .filter(|_| self.input.has_lines)
            .map(|edge| edge.kind)
            .collect();
        TinPart::new(self.t, kinds, self.emitted, numbers)
    }
}

/// Triangulates a residual, and emits what is final. `keep` makes something of the triangulation,
/// if there is a triangle.
fn reduce<T>(
    tile: &Tile,
    mut input: Residual,
    tight: f64,
    emit: &mut dyn FnMut(TileTriangle),
    keep: impl FnOnce(Finished) -> T,
) -> Result<(Residual, Option<T>)> {
    if let Some(at) = input
        .vertices
        .iter()
        .position(|vertex| !vertex.position[2].is_finite())
    {
        return Err(refused(InputError::NotFinite(at), &input));
    }
    lines::join_known(tile, &mut input)?;
    let points: Vec<[f64; 3]> = input
        .vertices
        .iter()
        .map(|vertex| vertex.position)
        .collect();
    // Without lines, seams are edges by themselves.
    let edges = if input.has_lines {
        &input.edges[..]
    } else {
        &[]
    };
    let lines: Vec<[u32; 2]> = edges.iter().map(|edge| edge.ends).collect();
    let (t, ids) =
        ConstrainedDelaunay::from_lines(Terrain::default(), &points, &lines, OnCrossing::Reject)
            .map_err(|error| refused(error, &input))?;
    drop(points);
    if t.dimension() < 2 {
        // Nothing is final before there is a triangle.
        return Ok((
            if tile.is_plane() {
                Residual::default()
            } else {
                input
            },
            None,
        ));
    }
    mark_tight(tile, &t, &ids, &mut input, tight);
    let task = Task::new(tile, &t, &ids, &input);
    let (residual, emitted) = task.run(&Lines::new(tile, &t, &input), emit)?;
    let input_of = task.input_of;
    Ok((
        residual,
        Some(keep(Finished {
            t,
            input: &input,
            input_of,
            emitted,
        })),
    ))
}

/// Marks the vertices at which an edge may bend where it is cut: those of triangles that are
/// narrower than `width`, and of lines that end at the border of the tile, beyond which a vertex
/// may be next to them.
///
/// An edge bends at vertices within a rounding error of it. Between the edge and such a vertex lies
/// a triangle that is as narrow, at one of the ends of the edge. So both triangles at the edge have
/// a marked corner, even if they are found by different tasks: marks are handed up.
fn mark_tight(
    tile: &Tile,
    t: &ConstrainedDelaunay<Terrain>,
    ids: &[VertexId],
    input: &mut Residual,
    width: f64,
) {
    if width <= 0.0 {
        return;
    }
    let tds = t.tds();
    let mut is_tight = vec![false; tds.vertex_slots()];
    for cell in tds.cells().filter(|&cell| !tds.is_infinite(cell)) {
        let corners = tds.corners(cell);
        let [a, b, c] = corners.map(|id| *t.point(id));
        let [u, v, w] = [[a, b], [b, c], [c, a]].map(|[p, q]| [q[0] - p[0], q[1] - p[1]]);
        let longest = [u, v, w]
            .map(|[x, y]| x.hypot(y))
            .into_iter()
            .fold(0.0, f64::max);
        if (u[0] * v[1] - u[1] * v[0]).abs() < width * longest {
            corners.iter().for_each(|id| is_tight[id.index()] = true);
        }
    }
    let ends = input
        .edges
        .iter()
        .filter(|edge| edge.kind.is_constrained())
        .flat_map(|edge| edge.ends);
    for id in ends.map(|end| ids[end as usize]) {
        let p = t.point(id);
        is_tight[id.index()] |=
            (0..2).any(|k| p[k] - tile.min[k] < width || tile.max[k] - p[k] < width);
    }
    for (vertex, id) in input.vertices.iter_mut().zip(ids) {
        vertex.is_tight |= is_tight[id.index()];
    }
}

/// A triangulation of the vertices of a residual.
struct Task<'a> {
    tile: &'a Tile,
    t: &'a ConstrainedDelaunay<Terrain>,
    /// The vertex of each one of the input.
    ids: &'a [VertexId],
    input: &'a Residual,
    /// For each vertex, the first one of the input at its site.
    input_of: Vec<u32>,
}

impl<'a> Task<'a> {
    fn new(
        tile: &'a Tile,
        t: &'a ConstrainedDelaunay<Terrain>,
        ids: &'a [VertexId],
        input: &'a Residual,
    ) -> Self {
        let mut input_of = vec![u32::MAX; t.tds().vertex_slots()];
        for (at, id) in (0..).zip(ids) {
            let first = &mut input_of[id.index()];
            *first = (*first).min(at);
        }
        Task {
            tile,
            t,
            ids,
            input,
            input_of,
        }
    }

    fn vertex(&self, id: VertexId) -> TileVertex {
        self.input.vertices[self.input_of[id.index()] as usize]
    }

    /// Emits the triangles that are final now. Returns what is left, and the positions of these
    /// triangles among all cells.
    fn run(
        &self,
        lines: &Lines,
        emit: &mut dyn FnMut(TileTriangle),
    ) -> Result<(Residual, Vec<u32>)> {
        let is_known = self.tile.is_plane();
        let is_certain = |cell: CellId, disk: Disk| {
            disk.is_within(self.tile) || lines.hide_all_outside(self.tile, &disk, cell)
        };
        let tds = self.t.tds();
        let mut is_final = self.covered()?;
        let mut emitted = Vec::new();
        for (at, cell) in (0..)
            .zip(tds.cells())
            .filter(|(_, cell)| !tds.is_infinite(*cell))
        {
            if !is_final[cell.index()] {
                let corners = tds.corners(cell).map(|id| self.vertex(id));
                let disk = || Disk::around(corners.map(|corner| corner.site()));
                if is_known
                    || !lines.enter(cell) && disk().is_some_and(|disk| is_certain(cell, disk))
                {
                    is_final[cell.index()] = true;
                    emitted.push(at);
                    emit(TileTriangle {
                        corners,
                        edges: [0, 1, 2].map(|i| lines.kind(cell, i)),
                    });
                }
            }
        }
        Ok((self.rest(&is_final, lines), emitted))
    }

    /// Returns, for each cell, true if triangles in its place were final before: if it is on the
    /// final side of seams. Found by a flood that seams stop.
    fn covered(&self) -> Result<Vec<bool>> {
        let tds = self.t.tds();
        let mut is_covered = vec![false; tds.cell_slots()];
        let seams = || {
            self.input
                .edges
                .iter()
                .filter(|edge| edge.is_seam)
                .map(|edge| edge.ends)
        };
        let mut is_seam = vec![
            [false; 3];
            if seams().next().is_none() {
                0
            } else {
                is_covered.len()
            }
        ];
        let mut flood: Vec<CellId> = Vec::new();
        for seam in seams() {
            let [from, to] = seam.map(|end| self.ids[end as usize]);
            let Some((cell, i)) = tds.edge(from, to) else {
                let [a, b] = seam.map(|end| self.input.vertices[end as usize].position);
                return Err(Error::format(format!(
                    "no edge joins {a:?} and {b:?}, as a part of the triangulation has it"
                ))
                .cure(CONTRADICTION));
            };
            let beyond = tds.neighbor(cell, i);
            is_seam[cell.index()][i] = true;
            is_seam[beyond.index()][tds.index_of_neighbor(beyond, cell)] = true;
            flood.push(cell);
        }
        while let Some(cell) = flood.pop() {
            if std::mem::replace(&mut is_covered[cell.index()], true) {
                continue;
            }
            let open = (0..3)
                .filter(|&i| !is_seam[cell.index()][i])
                .map(|i| tds.neighbor(cell, i));
            flood.extend(open);
        }
        let outside = tds
            .cells()
            .filter(|&cell| tds.is_infinite(cell) && is_covered[cell.index()]);
        let mut ends = outside.flat_map(|cell| tds.corners(cell).iter().copied());
        if let Some(at) = ends
            .find(|&end| end != VertexId::INFINITE)
            .map(|end| self.t.point(end))
        {
            return Err(Error::format(format!(
                "the seams around final triangles do not close, at {at:?}"
            ))
            .cure(CONTRADICTION));
        }
        Ok(is_covered)
    }

    /// Returns the vertices of cells that are not final, the edges between these and final ones,
    /// and the constrained edges without a final side.
    fn rest(&self, is_final: &[bool], lines: &Lines) -> Residual {
        let tds = self.t.tds();
        let mut number_of = vec![u32::MAX; tds.vertex_slots()];
        let mut rest = Residual {
            pending: self.input.pending.clone(),
            has_lines: self.input.has_lines,
            ..Residual::default()
        };
        let is_open = |cell: CellId| !is_final[cell.index()];
        for cell in tds.cells().filter(|&cell| is_open(cell)) {
            for &id in tds
                .corners(cell)
                .iter()
                .filter(|&&id| id != VertexId::INFINITE)
            {
                if number_of[id.index()] == u32::MAX {
                    number_of[id.index()] = rest.vertices.len() as u32;
                    rest.vertices.push(self.vertex(id));
                }
            }
            for i in 0..3 {
                let beyond = tds.neighbor(cell, i);
                let (is_seam, kind) = (!is_open(beyond), lines.kind(cell, i));
                // One without a final side is met twice.
                if is_seam || kind != EdgeKind::Plain && cell < beyond {
                    // Seen from beyond, in the other direction.
                    let [to, from] = tds.edge_ends(cell, i).map(|id| number_of[id.index()]);
                    rest.edges.push(ResidualEdge {
                        ends: [from, to],
                        is_seam,
                        kind,
                    });
                }
            }
        }
        rest
    }
}

/// What may have happened if parts contradict each other.
const CONTRADICTION: &str =
    "the parts are of different points or lines, or a tile's extent is wrong";

#[cold]
fn refused(error: InputError, input: &Residual) -> Error {
    match error {
        InputError::NotFinite(at) | InputError::Coordinate(at) => {
            admitted::refused(input.vertices[at].position).at(format!("point {at}"))
        }
        InputError::Crossing { at: [x, y], .. } => Error::format(format!(
            "two lines, or a line and a seam, cross near {x} {y}"
        ))
        .cure("pass all lines arranged, so that none cross; else the parts are of different lines"),
        error => Error::limit(error.to_string()),
    }
}

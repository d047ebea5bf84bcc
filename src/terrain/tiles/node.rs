//! One task: points or residuals in, final triangles and a residual out.

use super::Tile;
use super::disk::Disk;
use crate::data::EdgeKind;
use crate::error::{Error, Result};
use crate::triangulation::geometry::Plane;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{Delaunay2, InputError};

/// A vertex, with numbers that stand for it everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileVertex {
    /// The number of its tile.
    pub tile: u32,
    /// The index of its point among those of the tile.
    pub number: u32,
    /// Its position and its height, in the units of the data.
    pub position: [f64; 3],
}

impl TileVertex {
    fn site(&self) -> [f64; 2] {
        [self.position[0], self.position[1]]
    }
}

/// A triangle that is final.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileTriangle {
    /// The corners, counter-clockwise.
    pub corners: [TileVertex; 3],
    /// The kind of the edge opposite each corner.
    pub edges: [EdgeKind; 3],
}

/// What may still change of a part of the triangulation: see [the module](super).
///
/// A tile of `n` evenly spread points, with tiles all around it, has about `5.6 sqrt(n)` vertices
/// here.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Residual {
    /// The vertices of triangles that are not final.
    pub vertices: Vec<TileVertex>,
    /// The edges, as pairs of indices of vertices, on whose left side all triangles are final.
    pub seams: Vec<[u32; 2]>,
}

/// Triangulates the points of a tile. Calls `emit` for each final triangle, and returns what
/// may still change.
///
/// Where points share a site, the first of them is used.
///
/// # Errors
/// If a point lies outside of the tile, whose extent is then wrong, or has a coordinate that is not
/// finite or outside of the range of the arithmetic.
///
/// # Complexity
/// That of [`Delaunay::from_points`](crate::triangulation::Delaunay::from_points).
pub fn leaf(tile: &Tile, number: u32, points: &[[f64; 3]], emit: &mut dyn FnMut(TileTriangle)) -> Result<Residual> {
    if let Some(at) = points.iter().position(|&[x, y, _]| !tile.holds([x, y])) {
        let ([x, y, _], Tile { min, max }) = (points[at], tile);
        return Err(Error::format(format!(
            "point {at} of tile {number} is at {x} {y}, expected x from {} to below {}, y from {} to below {}",
            min[0], max[0], min[1], max[1]
        ))
        .cure("the extent of the tile is wrong: take it from the points, not from the header"));
    }
    let vertex = |(at, &position): (usize, &[f64; 3])| TileVertex { tile: number, number: at as u32, position };
    let vertices = points.iter().enumerate().map(vertex).collect();
    reduce(tile, Residual { vertices, seams: Vec::new() }, emit)
}

/// Merges the residuals of parts of a tile. Calls `emit` for each triangle that is final now, and
/// returns what may still change.
///
/// The tile is the union of those of the parts; with [`Tile::PLANE`] all triangles are final, and
/// nothing is left.
///
/// # Errors
/// If a seam names a vertex that does not exist, or the residuals contradict each other: they are
/// not those of parts of one triangulation.
///
/// # Complexity
/// That of [`Delaunay::from_points`](crate::triangulation::Delaunay::from_points) for the vertices
/// of the residuals.
pub fn merge(tile: &Tile, parts: &[Residual], emit: &mut dyn FnMut(TileTriangle)) -> Result<Residual> {
    let mut all = Residual::default();
    for (number, part) in parts.iter().enumerate() {
        let count = part.vertices.len();
        if let Some(end) = part.seams.iter().flatten().find(|&&end| end as usize >= count) {
            return Err(Error::format(format!(
                "a seam of part {number} ends at vertex {end}, expected less than {count}"
            ))
            .cure("the part is damaged: compute it again"));
        }
        let first = all.vertices.len() as u32;
        all.vertices.extend_from_slice(&part.vertices);
        all.seams.extend(part.seams.iter().map(|seam| seam.map(|end| end + first)));
    }
    reduce(tile, all, emit)
}

fn reduce(tile: &Tile, input: Residual, emit: &mut dyn FnMut(TileTriangle)) -> Result<Residual> {
    if let Some(at) = input.vertices.iter().position(|vertex| !vertex.position[2].is_finite()) {
        return Err(refused(InputError::Coordinate(at), &input));
    }
    let sites: Vec<[f64; 2]> = input.vertices.iter().map(TileVertex::site).collect();
    let (t, ids) = Delaunay2::from_points(Plane::default(), &sites).map_err(|error| refused(error, &input))?;
    if t.dimension() < 2 {
        // Nothing is final before there is a triangle.
        return Ok(if tile.is_plane() { Residual::default() } else { input });
    }
    let mut input_of = vec![u32::MAX; t.tds().vertex_slots()];
    for (at, id) in (0..).zip(&ids) {
        let first = &mut input_of[id.index()];
        *first = (*first).min(at);
    }
    let vertex = |id: VertexId| input.vertices[input_of[id.index()] as usize];

    let mut is_final = covered(&t, &ids, &input)?;
    for cell in t.finite_cells() {
        if !is_final[cell.index()] {
            let corners = t.tds().corners(cell).map(vertex);
            let sites = corners.map(|corner| corner.site());
            if tile.is_plane() || Disk::around(sites).is_some_and(|disk| disk.is_within(tile)) {
                is_final[cell.index()] = true;
                emit(TileTriangle { corners, edges: [EdgeKind::Plain; 3] });
            }
        }
    }
    Ok(if tile.is_plane() { Residual::default() } else { rest(&t, &is_final, &input, &input_of) })
}

/// Returns, for each cell, true if triangles in its place were final before: if it is on the final
/// side of seams. Found by a flood that seams stop.
fn covered(t: &Delaunay2, ids: &[VertexId], input: &Residual) -> Result<Vec<bool>> {
    let mut is_covered = vec![false; t.tds().cell_slots()];
    let mut is_seam = vec![[false; 3]; if input.seams.is_empty() { 0 } else { is_covered.len() }];
    let mut flood: Vec<CellId> = Vec::new();
    for seam in &input.seams {
        let [from, to] = seam.map(|end| ids[end as usize]);
        let Some((cell, i)) = t.tds().edge(from, to) else {
            let [a, b] = seam.map(|end| input.vertices[end as usize].position);
            return Err(Error::format(format!("no edge joins {a:?} and {b:?}, as a part of the triangulation has it"))
                .cure("the parts are of different points, or a tile's extent is wrong"));
        };
        let beyond = t.tds().neighbor(cell, i);
        is_seam[cell.index()][i] = true;
        is_seam[beyond.index()][t.tds().index_of_neighbor(beyond, cell)] = true;
        flood.push(cell);
    }
    while let Some(cell) = flood.pop() {
        if std::mem::replace(&mut is_covered[cell.index()], true) {
            continue;
        }
        let open = (0..3).filter(|&i| !is_seam[cell.index()][i]).map(|i| t.tds().neighbor(cell, i));
        flood.extend(open);
    }
    let outside = t.tds().cells().filter(|&cell| t.tds().is_infinite(cell) && is_covered[cell.index()]);
    let mut ends = outside.flat_map(|cell| t.tds().corners(cell).iter().copied());
    if let Some(at) = ends.find(|&end| end != VertexId::INFINITE).map(|end| t.point(end)) {
        return Err(Error::format(format!("the seams around final triangles do not close, at {at:?}"))
            .cure("the parts are of different points, or a tile's extent is wrong"));
    }
    Ok(is_covered)
}

/// Returns the vertices of cells that are not final, and the edges between these and final ones.
fn rest(t: &Delaunay2, is_final: &[bool], input: &Residual, input_of: &[u32]) -> Residual {
    let mut number_of = vec![u32::MAX; t.tds().vertex_slots()];
    let mut rest = Residual::default();
    let is_open = |cell: CellId| !is_final[cell.index()];
    for cell in t.tds().cells().filter(|&cell| is_open(cell)) {
        for &id in t.tds().corners(cell).iter().filter(|&&id| id != VertexId::INFINITE) {
            if number_of[id.index()] == u32::MAX {
                number_of[id.index()] = rest.vertices.len() as u32;
                rest.vertices.push(input.vertices[input_of[id.index()] as usize]);
            }
        }
        for i in (0..3).filter(|&i| !is_open(t.tds().neighbor(cell, i))) {
            // Seen from beyond, in the other direction.
            let [to, from] = t.tds().edge_ends(cell, i).map(|id| number_of[id.index()]);
            rest.seams.push([from, to]);
        }
    }
    rest
}

#[cold]
fn refused(error: InputError, input: &Residual) -> Error {
    match error {
        InputError::Coordinate(at) => {
            super::super::admitted::refused(input.vertices[at].position).at(format!("point {at}"))
        }
        error => Error::limit(error.to_string()),
    }
}

//! Water on a surface: which faces are water, and which cells of a square.

use std::collections::HashSet;

use rustc_hash::FxHashMap;

use super::boxes::{Boxed, Boxes, Extent};
use crate::data::{AT_ONCE, EdgeKind, Surface, WaterMask};
use crate::error::Result;
use crate::triangulation::num::unsigned_zero;

/// Returns the triangles of a surface that are water. Triangles that are connected without a shore
/// or a bank between them are water if all of them are at one height, or if they reach a bank, have
/// no vertices but those of banks, shores and lines of a cut, and do not reach the rim. So an
/// island is land if it has a vertex of another height.
///
/// `go_on` is called now and then, and ends the search by an error.
///
/// # Errors
/// Those of `go_on`.
///
/// # Complexity
/// Linear in the faces. In memory are the vertices of shores, and a number for each face that is
/// water or land that is connected to a shore by such triangles.
pub fn water_triangles(
    surface: &dyn Surface,
    go_on: &dyn Fn() -> Result<()>,
) -> Result<Vec<[[f64; 3]; 3]>> {
    if !surface.has_lines() {
        return Ok(Vec::new());
    }
    let mut shores = Shores::default();
    let mut faces = Vec::new();
    let mut from = 0;
    while from < surface.face_count() {
        go_on()?;
        let to = (from + AT_ONCE).min(surface.face_count());
        surface.faces_in(from as u32..to as u32, &mut faces);
        for face in faces.drain(..) {
            for (i, &kind) in face.edges.iter().enumerate() {
                if is_shore(kind) {
                    shores.faces.push(face.number);
                }
                if is_shore(kind) || kind == EdgeKind::Clip {
                    shores.add_vertices(surface, face.corners, i);
                }
            }
        }
        from = to;
    }
    let mut known = FxHashMap::default();
    let mut water = Vec::new();
    for (number, &face) in shores.faces.iter().enumerate() {
        if number.is_multiple_of(AT_ONCE) {
            go_on()?;
        }
        shores.flood(surface, face, &mut known, &mut water);
    }
    Ok(water)
}

fn is_shore(kind: EdgeKind) -> bool {
    matches!(kind, EdgeKind::Shore | EdgeKind::Bank)
}

/// The edges that enclose water.
#[derive(Default)]
struct Shores {
    /// The faces beside these edges.
    faces: Vec<u32>,
    /// The positions of their vertices, and of those where water may be cut: a vertex that parts of
    /// a surface share has a number in each part.
    vertices: HashSet<[u64; 3]>,
}

impl Shores {
    fn add_vertices(&mut self, surface: &dyn Surface, corners: [u32; 3], opposite: usize) {
        for step in [1, 2] {
            let vertex = corners[(opposite + step) % 3];
            self.vertices.insert(key(surface.position(vertex)));
        }
    }

    /// Adds the triangles that are connected to a face without a shore or a bank between them, if
    /// they are water. `known` says of faces whether they are water.
    fn flood(
        &self,
        surface: &dyn Surface,
        face: u32,
        known: &mut FxHashMap<u32, bool>,
        water: &mut Vec<[[f64; 3]; 3]>,
    ) {
        let Some([[_, _, level], ..]) = surface.triangle(face) else {
            return;
        };
        if known.contains_key(&face) {
            return;
        }
        let before = water.len();
        let [mut is_level, mut is_of_shores, mut has_bank] = [true, true, false];
        // Those up to `next` are done.
        let mut connected = vec![face];
        known.insert(face, true);
        let mut next = 0;
        while let Some(&face) = connected.get(next) {
            next += 1;
            let Some(triangle) = surface.triangle(face) else {
                continue;
            };
            water.push(triangle);
            is_level &= triangle.iter().all(|p| p[2] == level);
            is_of_shores &= triangle.iter().all(|&p| self.vertices.contains(&key(p)));
            for i in 0..3 {
                let kind = surface.edge_kind(face, i);
                has_bank |= kind == EdgeKind::Bank;
                if is_shore(kind) {
                    continue;
                }
                let Some(beyond) = surface.neighbor(face, i) else {
                    is_of_shores &= kind == EdgeKind::Clip;
                    continue;
                };
                match known.get(&beyond) {
                    None => {
                        known.insert(beyond, true);
                        connected.push(beyond);
                    }
                    Some(true) => {}
                    // What is connected to land is land.
                    Some(false) => [is_level, is_of_shores] = [false; 2],
                }
            }
            // It is land, which may be large: the rest of it need not be visited.
            if !is_level && !is_of_shores {
                break;
            }
        }
        let is_water = is_level || (is_of_shores && has_bank);
        if !is_water {
            water.truncate(before);
            known.extend(connected.into_iter().map(|face| (face, false)));
        }
    }
}

/// The bits of a position; those of -0.0 are those of 0.
fn key(position: [f64; 3]) -> [u64; 3] {
    position.map(|c| unsigned_zero(c).to_bits())
}

/// A triangle of water in plan.
#[derive(Debug, Clone, Copy)]
struct Triangle([[f64; 2]; 3]);

impl Boxed for Triangle {
    fn extent(&self) -> Extent {
        Extent::of_plan(self.0)
    }
}

/// Water, as triangles that are found by their position.
#[derive(Debug)]
pub struct Water(Boxes<Triangle>);

impl Water {
    /// Returns the water of some triangles in plan.
    ///
    /// # Complexity
    /// O(n log n) for n triangles; 56 bytes for each.
    pub fn new(triangles: impl IntoIterator<Item = [[f64; 2]; 3]>) -> Self {
        Water(Boxes::new(triangles.into_iter().map(Triangle).collect()))
    }

    /// Returns true if there is none.
    pub fn is_empty(&self) -> bool {
        self.0.items().is_empty()
    }

    /// Returns which cells of a rectangle have their centers in water. A center on an edge between
    /// two triangles is in one of them.
    ///
    /// # Complexity
    /// O(log n + k + c) for k triangles of n at the rectangle, which have c cells.
    pub fn mask(&self, [min, max]: [[f64; 2]; 2]) -> WaterMask {
        const SIDE: usize = WaterMask::SIDE;
        let cells_of = |[x, y]: [f64; 2]| {
            [
                (x - min[0]) / (max[0] - min[0]) * SIDE as f64,
                (max[1] - y) / (max[1] - min[1]) * SIDE as f64,
            ]
        };
        let mut cells = Vec::new();
        self.0.find_in(Extent { min, max }, |triangle| {
            if cells.is_empty() {
                cells.resize(SIDE * SIDE, false);
            }
            paint(triangle.0.map(cells_of), &mut cells);
            None::<()>
        });
        WaterMask::of_cells(cells)
    }
}

/// Marks the cells whose centers are in a triangle, in units of cells.
fn paint(triangle: [[f64; 2]; 3], cells: &mut [bool]) {
    const SIDE: usize = WaterMask::SIDE;
    // The first center that is not before a coordinate.
    let first = |c: f64| (c - 0.5).ceil().clamp(0.0, SIDE as f64) as usize;
    let ys = triangle.map(|[_, y]| y);
    let top = ys.into_iter().fold(f64::INFINITY, f64::min);
    let bottom = ys.into_iter().fold(f64::NEG_INFINITY, f64::max);
    for row in first(top)..first(bottom) {
        let y = row as f64 + 0.5;
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for i in 0..3 {
            let [a, b] = [triangle[i], triangle[(i + 1) % 3]];
            // From top to bottom, so that both triangles of an edge compute the same.
            let [a, b] = if a[1] <= b[1] { [a, b] } else { [b, a] };
            if a[1] <= y && y < b[1] {
                let x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                range = [range[0].min(x), range[1].max(x)];
            }
        }
        let row = &mut cells[row * SIDE..][..SIDE];
        if let Some(row) = row.get_mut(first(range[0])..first(range[1])) {
            row.fill(true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    /// Twice the area of a triangle, exact for small whole numbers.
    fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    #[test]
    fn cells_of_a_mask_are_those_whose_centers_are_in_a_triangle() {
        let mut random = Random(5);
        for _ in 0..300 {
            // Corners on the corners of cells: many edges pass through centers.
            let corner = |random: &mut Random| [0; 2].map(|_| random.below(257) as f64);
            let t = [(); 3].map(|()| corner(&mut random));
            let water = Water::new([t]);
            let side = WaterMask::SIDE;
            let cells = match water.mask([[0.0; 2], [side as f64; 2]]) {
                WaterMask::Land => vec![false; side * side],
                WaterMask::Water => vec![true; side * side],
                WaterMask::Cells(cells) => cells,
            };
            for (i, is_water) in cells.into_iter().enumerate() {
                let q = [(i % side) as f64 + 0.5, (side - i / side) as f64 - 0.5];
                let signs = [[t[0], t[1], q], [t[1], t[2], q], [t[2], t[0], q]].map(area);
                let is_inside = signs.iter().all(|&s| s > 0.0) || signs.iter().all(|&s| s < 0.0);
                let is_outside = signs.iter().any(|&s| s > 0.0) && signs.iter().any(|&s| s < 0.0);
                assert!(is_water || !is_inside, "{t:?} {q:?}");
                assert!(!is_water || !is_outside, "{t:?} {q:?}");
            }
        }
    }

    #[test]
    fn triangles_that_share_edges_leave_no_cell_between_them() {
        let mut random = Random(6);
        for _ in 0..100 {
            let middle = [0; 2].map(|_| random.unit() * 256.0);
            let corners = [[0.0, 0.0], [256.0, 0.0], [256.0, 256.0], [0.0, 256.0]];
            let fan = (0..4).map(|i| [corners[i], corners[(i + 1) % 4], middle]);
            let all = Water::new(fan).mask([[0.0; 2], [256.0; 2]]);
            assert_eq!(all, WaterMask::Water, "{middle:?}");
        }
        let none = Water::new([]);
        assert!(none.is_empty());
        assert_eq!(none.mask([[0.0; 2], [1.0; 2]]), WaterMask::Land);
    }
}

//! The triangles under a surface, as tables that a query walks through.

use rayon::prelude::*;

use crate::data::{BaseFace, Surface, orientation};
use crate::error::{Error, Result};
use crate::triangulation::num::Sign;

/// The bit of a link that interpolation must not cross; the number of the triangle is below it.
const CLOSED: u32 = 1 << 31;

/// No triangle across the edge.
const NONE: u32 = u32::MAX;

/// The number of triangles per parallel task.
const CHUNK: usize = 1 << 14;

/// The largest number of triangles between a hint and the triangle of a position. A hint is that
/// triangle or, because a rotated raster is scanned in rounded coordinates, one next to it.
const STEPS: usize = 16;

/// A triangle with its links.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linked {
    /// The corners, counter-clockwise.
    pub(super) corners: [u32; 3],
    links: [Link; 3],
}

/// What is across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Link(u32);

impl Link {
    /// Returns the triangle across the edge, if there is one.
    #[inline]
    fn any(self) -> Option<u32> {
        (self.0 != NONE).then_some(self.0 & !CLOSED)
    }

    /// Returns the triangle across the edge, unless the edge is hard.
    #[inline]
    fn open(self) -> Option<u32> {
        (self.0 < CLOSED).then_some(self.0)
    }
}

/// The triangles under a surface: their corners and links, in 24 bytes each.
#[derive(Debug)]
pub(super) struct Base {
    faces: Vec<Linked>,
    points: Vec<[f64; 3]>,
}

/// Where a position is, in terms that do not depend on the numbering of triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Site {
    /// At a vertex, on a hard edge, or outside of the base by a rounding error: the height there.
    Height(f64),
    /// On an edge at the rim of the base.
    Rim {
        /// The height, linear between the ends of the edge.
        height: f64,
        /// The number of the triangle.
        face: u32,
        /// The index of its smallest corner.
        first: usize,
    },
    /// In a triangle, or on an edge of it that interpolation crosses. Corners are counted from
    /// `first`, the smallest by x and y.
    Inside {
        /// The number of the triangle.
        face: u32,
        /// The index of its smallest corner.
        first: usize,
    },
}

impl Base {
    /// Copies the triangles under a surface.
    ///
    /// # Errors
    /// If there are more triangles than can be numbered.
    ///
    /// # Complexity
    /// Linear; 24 bytes for each triangle and each vertex.
    pub(super) fn new<S: Surface + ?Sized>(surface: &S) -> Result<Self> {
        let count = surface.base_count();
        if count >= CLOSED as usize {
            return Err(Error::limit(format!(
                "{count} triangles; this method needs less than {CLOSED}"
            ))
            .cure("use linear interpolation, or divide the area"));
        }
        let mut faces = vec![
            Linked {
                corners: [NONE; 3],
                links: [Link(NONE); 3]
            };
            count
        ];
        faces
            .par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(chunk, linked)| {
                let first = chunk * CHUNK;
                let mut found = Vec::with_capacity(linked.len());
                surface.base_faces_in(first as u32..(first + linked.len()) as u32, &mut found);
                for face in found {
                    linked[face.number as usize - first] = Linked::new(&face);
                }
            });
        let used = faces
            .par_iter()
            .flat_map_iter(|face| face.corners)
            .filter(|&v| v != NONE)
            .max();
        let points = (0..used.map_or(0, |last| last + 1))
            .into_par_iter()
            .map(|v| surface.position(v))
            .collect();
        Ok(Base { faces, points })
    }

    /// Closes the edges that violate the Delaunay law, as a mesh from a file may have; so the law
    /// holds across all others. Ties count as Delaunay, and so does what rounding may hide.
    ///
    /// # Complexity
    /// Linear.
    pub(super) fn close_where_not_delaunay(&mut self) {
        let flat: Vec<(u32, usize)> = (0..self.faces.len() as u32)
            .into_par_iter()
            .flat_map_iter(|face| (0..3).map(move |i| (face, i)))
            .filter(|&(face, i)| self.is_clearly_flat(face, i))
            .collect();
        for (face, i) in flat {
            self.faces[face as usize].links[i].0 |= CLOSED;
        }
    }

    /// Returns true if the circle of a triangle clearly contains the corner across an open edge.
    fn is_clearly_flat(&self, face: u32, i: usize) -> bool {
        /// Far above the rounding errors of the sum below.
        const CLEAR: f64 = 1e-12;
        let Some((beyond, j)) = self.across(face, i) else {
            return false;
        };
        let q = self.point(self.faces[beyond as usize].corners[j]);
        let [a, b, c] = self.faces[face as usize]
            .corners
            .map(|v| minus(self.point(v), q));
        let terms = [
            square(a) * cross(b, c),
            square(b) * cross(c, a),
            square(c) * cross(a, b),
        ];
        terms.iter().sum::<f64>() > CLEAR * terms.iter().map(|term| term.abs()).sum::<f64>()
    }

    /// Returns true if the triangle exists.
    #[inline]
    pub(super) fn is_face(&self, face: u32) -> bool {
        self.faces
            .get(face as usize)
            .is_some_and(|linked| linked.corners[0] != NONE)
    }

    /// The number of triangles, those that do not exist included.
    pub(super) fn count(&self) -> usize {
        self.faces.len()
    }

    /// Returns a triangle that exists.
    #[inline]
    pub(super) fn face(&self, face: u32) -> &Linked {
        &self.faces[face as usize]
    }

    /// Returns the coordinates of a vertex.
    #[inline]
    pub(super) fn point(&self, vertex: u32) -> [f64; 3] {
        self.points[vertex as usize]
    }

    /// Returns the coordinates of the corners of a triangle.
    #[inline]
    pub(super) fn corners(&self, face: u32) -> [[f64; 3]; 3] {
        self.faces[face as usize].corners.map(|v| self.point(v))
    }

    /// Returns the triangle across the edge opposite corner `i`, and the index of its corner
    /// opposite that edge. `None` at the rim and at closed edges.
    #[inline]
    pub(super) fn across(&self, face: u32, i: usize) -> Option<(u32, usize)> {
        let linked = self.face(face);
        let (a, b) = (linked.corners[next(i)], linked.corners[before(i)]);
        let beyond = linked.links[i].open()?;
        Some((beyond, self.opposite(beyond, a, b)?))
    }

    /// Returns the index of the corner opposite the edge from `b` to `a`; `None` if a triangle does
    /// not have that edge, which only happens in damaged files.
    #[inline]
    pub(super) fn opposite(&self, face: u32, a: u32, b: u32) -> Option<usize> {
        let [u, v, w] = self.faces.get(face as usize)?.corners;
        // `PERF:` without branches, because none of the three is more likely.
        let is = |from: u32, to: u32| (from == b) & (to == a);
        let (first, second, third) = (is(v, w), is(w, u), is(u, v));
        (first | second | third).then_some(usize::from(second) + 2 * usize::from(third))
    }

    /// Finds where a position is, from a triangle that contains it or is next to one that does.
    ///
    /// Returns the same for all triangles around the position. `None` if it is farther away.
    pub(super) fn site(&self, q: [f64; 2], hint: u32) -> Option<Site> {
        let mut face = hint;
        for _ in 0..STEPS {
            let corners = self.corners(face);
            if let Some(corner) = corners.iter().find(|p| p[0] == q[0] && p[1] == q[1]) {
                return Some(Site::Height(corner[2]));
            }
            let sides = [0, 1, 2].map(|i| side(corners[next(i)], corners[before(i)], q));
            if let Some(i) = (0..3).find(|&i| sides[i] == Sign::Negative) {
                match self.face(face).links[i].any() {
                    Some(beyond) if self.is_face(beyond) => face = beyond,
                    // Outside of the base, because of rounding.
                    _ => {
                        return Some(Site::Height(height_along(
                            corners[next(i)],
                            corners[before(i)],
                            q,
                        )));
                    }
                }
                continue;
            }
            if let Some(i) = (0..3).find(|&i| sides[i] == Sign::Zero) {
                let (p, r) = (corners[next(i)], corners[before(i)]);
                let height = height_along(p, r, q);
                match self.across(face, i) {
                    None if self.face(face).is_hard(i) => return Some(Site::Height(height)),
                    None => {
                        return Some(Site::Rim {
                            height,
                            face,
                            first: smallest(corners),
                        });
                    }
                    // Of two triangles at an edge, the one to its left, seen from its smaller end.
                    Some((beyond, _)) if is_smaller(r, p) => face = beyond,
                    Some(_) => {}
                }
            }
            return Some(Site::Inside {
                face,
                first: smallest(self.corners(face)),
            });
        }
        None
    }
}

impl Linked {
    fn new(face: &BaseFace) -> Self {
        let link = |i: usize| match face.neighbors[i] {
            Some(beyond) if beyond < CLOSED => Link(if face.edges[i].is_hard() {
                beyond | CLOSED
            } else {
                beyond
            }),
            _ => Link(NONE),
        };
        Linked {
            corners: face.corners,
            links: [0, 1, 2].map(link),
        }
    }

    /// Returns true if there is a triangle across the edge opposite corner `i`, which
    /// interpolation must not cross.
    #[inline]
    pub(super) fn is_hard(&self, i: usize) -> bool {
        self.links[i].0 >= CLOSED && self.links[i].0 != NONE
    }
}

/// The next corner, counter-clockwise.
#[inline]
pub(super) fn next(i: usize) -> usize {
    [1, 2, 0][i]
}

/// The corner before, counter-clockwise.
#[inline]
pub(super) fn before(i: usize) -> usize {
    [2, 0, 1][i]
}

/// Returns the vector in plan from `q` to `p`.
#[inline]
pub(super) fn minus(p: [f64; 3], q: [f64; 3]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

#[inline]
pub(super) fn cross(p: [f64; 2], r: [f64; 2]) -> f64 {
    p[0] * r[1] - p[1] * r[0]
}

/// Returns the square of a length.
#[inline]
pub(super) fn square(p: [f64; 2]) -> f64 {
    p[0] * p[0] + p[1] * p[1]
}

/// Returns true if the first of two points is smaller by x, then y.
fn is_smaller(p: [f64; 3], r: [f64; 3]) -> bool {
    (p[0], p[1]) < (r[0], r[1])
}

/// Returns the index of the smallest corner by x, then y.
#[inline]
fn smallest(corners: [[f64; 3]; 3]) -> usize {
    (1..3).fold(0, |first, i| {
        if is_smaller(corners[i], corners[first]) {
            i
        } else {
            first
        }
    })
}

/// Returns on which side of the line from `p` to `r` a position is: positive on the left.
#[inline]
fn side(p: [f64; 3], r: [f64; 3], q: [f64; 2]) -> Sign {
    let (left, right) = ((p[0] - q[0]) * (r[1] - q[1]), (p[1] - q[1]) * (r[0] - q[0]));
    // Six roundings at most; Shewchuk 1997 has 3 + 16 u for the factor.
    let error = 4.0 * f64::EPSILON * (left.abs() + right.abs());
    match left - right {
        turn if turn > error && error > f64::MIN_POSITIVE => Sign::Positive,
        turn if turn < -error && error > f64::MIN_POSITIVE => Sign::Negative,
        _ => orientation([p, r, [q[0], q[1], 0.0]]),
    }
}

/// Returns the height at a position on the edge between two points, interpolated along its longer
/// extent from its smaller end, so that both triangles agree.
fn height_along(p: [f64; 3], r: [f64; 3], q: [f64; 2]) -> f64 {
    let (p, r) = if is_smaller(p, r) { (p, r) } else { (r, p) };
    let (dx, dy) = (r[0] - p[0], r[1] - p[1]);
    let part = if dx.abs() > dy.abs() {
        (q[0] - p[0]) / dx
    } else {
        (q[1] - p[1]) / dy
    };
    p[2] + part.clamp(0.0, 1.0) * (r[2] - p[2])
}

/// Returns true if a position is in a triangle or on its border.
pub(super) fn holds([a, b, c]: [[f64; 3]; 3], q: [f64; 2]) -> bool {
    let q = [q[0], q[1], 0.0];
    q.iter().all(|c| c.is_finite())
        && [[a, b], [b, c], [c, a]]
            .into_iter()
            .all(|[p, r]| orientation([p, r, q]) != Sign::Negative)
}

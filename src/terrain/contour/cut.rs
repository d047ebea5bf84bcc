use crate::data::{Surface, higher, lower};
use crate::triangulation::num::unsigned_zero;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// A surface and the level of a contour.
pub(super) struct LevelCut<'a, S: ?Sized> {
    pub(super) surface: &'a S,
    pub(super) level: f64,
}

/// A face, with each corner compared to the level. Indices of corners are modulo 3.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub(super) id: u32,
    pub(super) vertices: [u32; 3],
    at: [[f64; 3]; 3],
    side: [Ordering; 3],
}

/// A part of the contour in one face or on one edge, with high ground on its right.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum ContourArc {
    /// Through the inside of a face, which has a corner above and one below the level.
    Across(u32),
    /// Along the edge opposite corner `i`, from corner `i + 2` to corner `i + 1`. The face is the
    /// one on the high side.
    Along(u32, u8),
}

/// Along or against the direction of an arc.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Forward,
    Backward,
}

/// The position at which an arc begins or ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Node {
    /// On the edge opposite the corner.
    Edge(usize),
    /// At the corner.
    Corner(usize),
}

/// An edge with one end above and one below the level, as seen from the face that a line leaves
/// through it.
pub(super) struct PassedEdge {
    pub(super) face: u32,
    /// The corner of the face opposite the edge.
    opposite: usize,
    /// The next corners, counter-clockwise, and their positions.
    pub(super) vertices: [u32; 2],
    at: [[f64; 3]; 2],
}

impl PassedEdge {
    /// Returns true if the edge has an end at a point in plan.
    #[inline]
    pub(super) fn ends_at(&self, point: [f64; 2]) -> bool {
        self.at.iter().any(|end| end[..2] == point)
    }
}

/// What a line meets in the face beyond an edge.
pub(super) enum Beyond {
    Edge(PassedEdge),
    /// The corner opposite the edge, of this face, is on the level.
    Corner(u32),
}

/// An arc that begins or ends at a vertex, as seen from the vertex.
pub(super) struct Ray {
    pub(super) face: Face,
    pub(super) arc: ContourArc,
    /// Forward if the arc leaves the vertex, backward if it arrives there.
    pub(super) direction: Direction,
}

impl ContourArc {
    /// The face to which the arc belongs.
    pub(super) fn face(self) -> u32 {
        let (ContourArc::Across(face) | ContourArc::Along(face, _)) = self;
        face
    }
}

impl<'a, S: Surface + ?Sized> LevelCut<'a, S> {
    pub(super) fn face(&self, id: u32) -> Option<Face> {
        let vertices = self.surface.face(id)?;
        let at = vertices.map(|v| self.surface.position(v));
        Some(Face {
            id,
            vertices,
            at,
            side: at.map(|p| self.side(p)),
        })
    }

    fn side(&self, at: [f64; 3]) -> Ordering {
        // Heights are finite.
        at[2].partial_cmp(&self.level).unwrap_or(Less)
    }

    /// The face across the edge opposite corner `i`, which has these ends at these positions: its
    /// number, its vertices and its corner opposite the edge.
    #[inline]
    fn beyond(
        &self,
        face: u32,
        i: usize,
        [a, b]: [u32; 2],
        at: [[f64; 3]; 2],
    ) -> Option<(u32, [u32; 3], usize)> {
        let id = self.surface.neighbor(face, i)?;
        let vertices = self.surface.face(id)?;
        let j = (0..3)
            .find(|&j| vertices[(j + 1) % 3] == b && vertices[(j + 2) % 3] == a)
            .or_else(|| self.opposite(vertices, at))?;
        Some((id, vertices, j))
    }

    /// The corner opposite an edge of a face in another part of a surface, where vertices have
    /// other numbers.
    #[cold]
    fn opposite(&self, vertices: [u32; 3], [a, b]: [[f64; 3]; 2]) -> Option<usize> {
        let corners = vertices.map(|v| self.surface.position(v));
        (0..3).find(|&j| corners[(j + 1) % 3] == b && corners[(j + 2) % 3] == a)
    }

    /// The face across the edge opposite corner `i`, and its corner opposite the edge.
    pub(super) fn across(&self, face: &Face, i: usize) -> Option<(Face, usize)> {
        let edge = [(i + 2) % 3, (i + 1) % 3];
        let [b, a] = edge.map(|k| face.vertices[k]);
        let at = [edge[1], edge[0]].map(|k| face.at[k]);
        let (id, vertices, j) = self.beyond(face.id, i, [a, b], at)?;
        let new = self.surface.position(vertices[j]);
        let mut other = Face {
            id,
            vertices,
            at: [new; 3],
            side: [self.side(new); 3],
        };
        for (k, old) in [1, 2].into_iter().zip(edge) {
            other.at[(j + k) % 3] = face.at[old];
            other.side[(j + k) % 3] = face.side[old];
        }
        Some((other, j))
    }

    /// The arc along the edge on the level, for a face whose third corner is below it.
    pub(super) fn shore(&self, id: u32) -> Option<ContourArc> {
        let face = self.face(id)?;
        let i = (0..3).find(|&i| face.has_level_edge(i))?;
        let (high, j) = self.across(&face, i)?;
        (high.side[j] != Less).then_some(ContourArc::Along(high.id, j as u8))
    }

    /// What a line meets that passes an edge.
    #[inline]
    pub(super) fn pass(&self, edge: &PassedEdge, direction: Direction) -> Option<Beyond> {
        let (id, vertices, j) = self.beyond(edge.face, edge.opposite, edge.vertices, edge.at)?;
        let new = self.surface.position(vertices[j]);
        let side = self.side(new);
        if side == Equal {
            return Some(Beyond::Corner(id));
        }
        // It goes on between the new corner and the end on the other side of the level. Forward,
        // the first end is above the level.
        let ([first, last], [at_first, at_last]) = (edge.vertices, edge.at);
        let next = match (side == Greater) == (direction == Direction::Forward) {
            true => PassedEdge {
                face: id,
                opposite: (j + 2) % 3,
                vertices: [vertices[j], last],
                at: [new, at_last],
            },
            false => PassedEdge {
                face: id,
                opposite: (j + 1) % 3,
                vertices: [first, vertices[j]],
                at: [at_first, new],
            },
        };
        Some(Beyond::Edge(next))
    }

    /// The point at which a line passes an edge.
    #[inline]
    pub(super) fn point_on(&self, edge: &PassedEdge) -> [f64; 2] {
        crossing(edge.at[0], edge.at[1], self.level)
    }

    /// The face on the high side of the edge opposite corner `i`, if the edge is an arc.
    fn high_side(&self, face: &Face, i: usize) -> Option<Face> {
        if !face.has_level_edge(i) {
            return None;
        }
        let (other, j) = self.across(face, i)?;
        match (face.side[i] != Less, other.side[j] != Less) {
            (true, false) => Some(*face),
            (false, true) => Some(other),
            _ => None,
        }
    }

    /// The arcs at a corner in the order in which a turning ray from it meets them, starting inside
    /// the face: counter-clockwise if forward, clockwise if backward.
    ///
    /// Ends after a full turn (without the arc across the first face), or at the edge of the data.
    pub(super) fn fan(&self, face: &Face, corner: usize, turn: Direction) -> Fan<'_, 'a, S> {
        Fan {
            cut: self,
            first: face.id,
            now: Some((*face, corner)),
            turn,
            waiting: None,
        }
    }

    /// The arc that follows one that ends at a corner of its face (forward), or that precedes one
    /// that begins there (backward), by the turn rule within one fan of faces.
    ///
    /// `None` if the edge of the data comes first.
    pub(super) fn continuation(
        &self,
        face: &Face,
        corner: usize,
        direction: Direction,
    ) -> Option<Ray> {
        // High ground lies between the two, so the next arc is of the other kind.
        self.fan(face, corner, direction)
            .next()
            .filter(|ray| ray.direction == direction)
    }

    /// The point of a node.
    pub(super) fn point(&self, face: &Face, node: Node) -> [f64; 2] {
        match node {
            // Adding 0 turns -0 into 0.
            Node::Corner(i) => [unsigned_zero(face.at[i][0]), unsigned_zero(face.at[i][1])],
            Node::Edge(i) => crossing(face.at[(i + 1) % 3], face.at[(i + 2) % 3], self.level),
        }
    }
}

impl Face {
    /// Returns true if a corner is above the level and one below.
    pub(super) fn is_crossed(&self) -> bool {
        self.side.contains(&Greater) && self.side.contains(&Less)
    }

    /// Returns true if the edge opposite corner `i` lies on the level.
    fn has_level_edge(&self, i: usize) -> bool {
        self.side[(i + 1) % 3] == Equal && self.side[(i + 2) % 3] == Equal
    }

    /// The node at which an arc ends (forward) or begins (backward).
    pub(super) fn node(&self, arc: ContourArc, direction: Direction) -> Node {
        match (arc, direction) {
            (ContourArc::Along(_, i), Direction::Forward) => Node::Corner((usize::from(i) + 1) % 3),
            (ContourArc::Along(_, i), Direction::Backward) => {
                Node::Corner((usize::from(i) + 2) % 3)
            }
            (ContourArc::Across(_), _) => {
                // Counter-clockwise around the face, an arc ends where the ground falls below the
                // level and begins where it rises above.
                let change = match direction {
                    Direction::Forward => [Greater, Less],
                    Direction::Backward => [Less, Greater],
                };
                let edge =
                    (0..3).find(|&i| [self.side[(i + 1) % 3], self.side[(i + 2) % 3]] == change);
                let corner = || {
                    self.side
                        .iter()
                        .position(|&side| side == Equal)
                        .unwrap_or(0)
                };
                edge.map_or_else(|| Node::Corner(corner()), Node::Edge)
            }
        }
    }

    /// The edge opposite corner `i`, as seen from the face.
    pub(super) fn edge(&self, i: usize) -> PassedEdge {
        let ends = [(i + 1) % 3, (i + 2) % 3];
        PassedEdge {
            face: self.id,
            opposite: i,
            vertices: ends.map(|k| self.vertices[k]),
            at: ends.map(|k| self.at[k]),
        }
    }

    /// The arc across the face that begins or ends at a corner on the level.
    fn ray(&self, corner: usize) -> Option<Ray> {
        let direction = match [self.side[(corner + 1) % 3], self.side[(corner + 2) % 3]] {
            [Greater, Less] => Direction::Forward,
            [Less, Greater] => Direction::Backward,
            _ => return None,
        };
        Some(Ray {
            face: *self,
            arc: ContourArc::Across(self.id),
            direction,
        })
    }
}

/// See [`LevelCut::fan`].
pub(super) struct Fan<'c, 'a, S: ?Sized> {
    cut: &'c LevelCut<'a, S>,
    first: u32,
    now: Option<(Face, usize)>,
    turn: Direction,
    waiting: Option<Ray>,
}

impl<S: Surface + ?Sized> Iterator for Fan<'_, '_, S> {
    type Item = Ray;

    fn next(&mut self) -> Option<Ray> {
        loop {
            if let Some(ray) = self.waiting.take() {
                return Some(ray);
            }
            let (face, corner) = self.now.take()?;
            // The edge to cross, by its opposite corner, and the offset of the vertex beyond it.
            let (i, beyond) = match self.turn {
                Direction::Forward => ((corner + 1) % 3, 1),
                Direction::Backward => ((corner + 2) % 3, 2),
            };
            let (next, j) = self.cut.across(&face, i)?;
            let next_corner = (j + beyond) % 3;
            if next.id != self.first {
                self.now = Some((next, next_corner));
                self.waiting = next.ray(next_corner);
            }
            if let Some(high) = self.cut.high_side(&face, i) {
                let (k, at) = if high.id == face.id {
                    (i, corner)
                } else {
                    (j, next_corner)
                };
                let direction = if at == (k + 2) % 3 {
                    Direction::Forward
                } else {
                    Direction::Backward
                };
                return Some(Ray {
                    face: high,
                    arc: ContourArc::Along(high.id, k as u8),
                    direction,
                });
            }
        }
    }
}

/// The point where an edge meets a level that lies between its ends.
///
/// It is computed from the smaller end of the edge to the larger one, so that both faces get the
/// same bits, and lies in the box of the ends. Along an edge, points are in the order of their
/// levels.
pub(in crate::terrain) fn crossing(a: [f64; 3], b: [f64; 3], level: f64) -> [f64; 2] {
    let (a, b) = if a <= b { (a, b) } else { (b, a) };
    // Differences of halves cannot overflow; otherwise halving does not change the result.
    let t = (0.5 * level - 0.5 * a[2]) / (0.5 * b[2] - 0.5 * a[2]);
    // If `t` is not a number, `low` remains.
    let between = |a: f64, b: f64| {
        let value = 2.0 * (0.5 * a + t * (0.5 * b - 0.5 * a));
        let (low, high) = (lower(a, b), higher(a, b));
        unsigned_zero(lower(higher(value, low), high))
    };
    [between(a[0], b[0]), between(a[1], b[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_are_small() {
        assert_eq!(size_of::<ContourArc>(), 8);
    }

    #[test]
    fn crossings_stay_in_the_box_of_the_edge() {
        let (a, b) = ([0.1, 1e300, -f64::MAX], [0.3, -1e300, f64::MAX]);
        for level in [-1e308, 0.0, 1e308, f64::MAX.next_down()] {
            let [x, y] = crossing(a, b, level);
            assert!(
                (0.1..=0.3).contains(&x) && (-1e300..=1e300).contains(&y),
                "{x} {y}"
            );
            assert_eq!(crossing(b, a, level), [x, y]);
        }
        assert_eq!(
            crossing([0.0, 0.0, 0.0], [3.0, -6.0, 3.0], 1.0),
            [1.0, -2.0]
        );
        // Denormal heights: somewhere on the edge.
        let [x, _] = crossing(
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 2.0 * f64::from_bits(1)],
            f64::from_bits(1),
        );
        assert!((1.0..=2.0).contains(&x), "{x}");
    }
}

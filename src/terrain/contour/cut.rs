use crate::data::Surface;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// A surface and the level at which it is cut.
pub(super) struct Cut<'a, S: ?Sized> {
    pub(super) surface: &'a S,
    pub(super) level: f64,
}

/// A face, with each corner compared with the level. Indices of corners count modulo 3.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub(super) id: u32,
    pub(super) vertices: [u32; 3],
    at: [[f64; 3]; 3],
    side: [Ordering; 3],
}

/// A part of the contour that lies in one face or on one edge. High ground is on its right.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum ContourArc {
    /// Through the inside of the face, of which one corner is higher and one lower.
    Across(u32),
    /// Along the edge opposite the corner, from corner `i + 2` to corner `i + 1`. The face is the
    /// one on the high side.
    Along(u32, u8),
}

/// Along or against the direction of a piece.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Forward,
    Backward,
}

/// Where a piece begins or ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Node {
    /// On the edge opposite the corner.
    Edge(usize),
    /// In the corner.
    Corner(usize),
}

/// A piece that begins or ends at a vertex, as seen from the vertex.
pub(super) struct Ray {
    pub(super) face: Face,
    pub(super) arc: ContourArc,
    /// Forward if the piece leaves the vertex, backward if it arrives there.
    pub(super) direction: Direction,
}

impl ContourArc {
    /// The face that it belongs to.
    pub(super) fn face(self) -> u32 {
        let (ContourArc::Across(face) | ContourArc::Along(face, _)) = self;
        face
    }
}

impl<'a, S: Surface + ?Sized> Cut<'a, S> {
    pub(super) fn face(&self, id: u32) -> Option<Face> {
        let vertices = self.surface.face(id)?;
        let at = vertices.map(|v| self.surface.position(v));
        Some(Face { id, vertices, at, side: at.map(|p| self.side(p)) })
    }

    fn side(&self, at: [f64; 3]) -> Ordering {
        // Heights are finite.
        at[2].partial_cmp(&self.level).unwrap_or(Less)
    }

    /// The face on the other side of the edge opposite corner `i`, and its corner opposite the edge.
    pub(super) fn across(&self, face: &Face, i: usize) -> Option<(Face, usize)> {
        let id = self.surface.neighbor(face.id, i)?;
        let vertices = self.surface.face(id)?;
        let edge = [(i + 2) % 3, (i + 1) % 3];
        let j = (0..3).find(|&j| [1, 2].map(|k| vertices[(j + k) % 3]) == edge.map(|k| face.vertices[k]))?;
        let new = self.surface.position(vertices[j]);
        let mut other = Face { id, vertices, at: [new; 3], side: [self.side(new); 3] };
        for (k, old) in [1, 2].into_iter().zip(edge) {
            other.at[(j + k) % 3] = face.at[old];
            other.side[(j + k) % 3] = face.side[old];
        }
        Some((other, j))
    }

    /// The piece along the edge that lies on the level, of a face that lies below it otherwise.
    pub(super) fn shore(&self, id: u32) -> Option<ContourArc> {
        let face = self.face(id)?;
        let i = (0..3).find(|&i| face.has_level_edge(i))?;
        let (high, j) = self.across(&face, i)?;
        (high.side[j] != Less).then_some(ContourArc::Along(high.id, j as u8))
    }

    /// Of the two faces at the edge opposite corner `i` the one that belongs to the high ground, if
    /// the edge is a piece of the contour.
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

    /// The pieces at a corner, in the order in which a ray from there meets them, that turns from
    /// the inside of the face: counter-clockwise if forward, clockwise if backward. Ends where it
    /// began (without the piece across that face), or at the edge of the data.
    pub(super) fn fan(&self, face: &Face, corner: usize, turn: Direction) -> Fan<'_, 'a, S> {
        Fan { cut: self, first: face.id, now: Some((*face, corner)), turn, waiting: None }
    }

    /// The piece that goes on where another one ends in a corner of its face (forward), or goes
    /// before one that begins there (backward): the turn rule within one fan of faces. None if
    /// the edge of the data comes first.
    pub(super) fn continuation(&self, face: &Face, corner: usize, direction: Direction) -> Option<Ray> {
        // High ground lies between the two, so that the next is one of the other kind.
        self.fan(face, corner, direction).next().filter(|ray| ray.direction == direction)
    }

    /// The point of a node.
    pub(super) fn point(&self, face: &Face, node: Node) -> [f64; 2] {
        match node {
            // Adding 0 turns -0 into 0.
            Node::Corner(i) => [face.at[i][0] + 0.0, face.at[i][1] + 0.0],
            Node::Edge(i) => crossing(face.at[(i + 1) % 3], face.at[(i + 2) % 3], self.level),
        }
    }
}

impl Face {
    /// Whether the edge opposite corner `i` lies on the level.
    fn has_level_edge(&self, i: usize) -> bool {
        self.side[(i + 1) % 3] == Equal && self.side[(i + 2) % 3] == Equal
    }

    /// The node at which a piece ends (forward) or begins (backward).
    pub(super) fn node(&self, arc: ContourArc, direction: Direction) -> Node {
        match (arc, direction) {
            (ContourArc::Along(_, i), Direction::Forward) => Node::Corner((usize::from(i) + 1) % 3),
            (ContourArc::Along(_, i), Direction::Backward) => Node::Corner((usize::from(i) + 2) % 3),
            (ContourArc::Across(_), _) => {
                // Counter-clockwise around the face, a piece ends where the ground falls below the
                // level and begins where it rises above.
                let change = match direction {
                    Direction::Forward => [Greater, Less],
                    Direction::Backward => [Less, Greater],
                };
                let edge = (0..3).find(|&i| [self.side[(i + 1) % 3], self.side[(i + 2) % 3]] == change);
                let corner = || self.side.iter().position(|&side| side == Equal).unwrap_or(0);
                edge.map_or_else(|| Node::Corner(corner()), Node::Edge)
            }
        }
    }

    /// Whether the edge opposite corner `i` has an end at a point in plan.
    pub(super) fn ends_at(&self, i: usize, point: [f64; 2]) -> bool {
        [1, 2].into_iter().any(|k| self.at[(i + k) % 3][..2] == point)
    }

    /// The piece across the face that begins or ends in a corner on the level.
    fn ray(&self, corner: usize) -> Option<Ray> {
        let direction = match [self.side[(corner + 1) % 3], self.side[(corner + 2) % 3]] {
            [Greater, Less] => Direction::Forward,
            [Less, Greater] => Direction::Backward,
            _ => return None,
        };
        Some(Ray { face: *self, arc: ContourArc::Across(self.id), direction })
    }
}

/// See [`Cut::fan`].
pub(super) struct Fan<'c, 'a, S: ?Sized> {
    cut: &'c Cut<'a, S>,
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
            // The edge to be turned over, by the corner opposite of it; the same corner beyond it.
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
                let (k, at) = if high.id == face.id { (i, corner) } else { (j, next_corner) };
                let direction = if at == (k + 2) % 3 { Direction::Forward } else { Direction::Backward };
                return Some(Ray { face: high, arc: ContourArc::Along(high.id, k as u8), direction });
            }
        }
    }
}

/// Where an edge meets a level that lies between its ends.
///
/// The edge is taken from its smaller end to its larger one, so that both of its faces see the same
/// bits, and never leaves the box of its ends. Along an edge, points are ordered as their levels.
fn crossing(a: [f64; 3], b: [f64; 3], level: f64) -> [f64; 2] {
    let (a, b) = if a <= b { (a, b) } else { (b, a) };
    // Halves, whose differences cannot overflow; halving changes no bit of the result otherwise.
    let t = (0.5 * level - 0.5 * a[2]) / (0.5 * b[2] - 0.5 * a[2]);
    let between = |a: f64, b: f64| {
        let value = 2.0 * (0.5 * a + t * (0.5 * b - 0.5 * a));
        value.max(a.min(b)).min(a.max(b)) + 0.0
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
            assert!((0.1..=0.3).contains(&x) && (-1e300..=1e300).contains(&y), "{x} {y}");
            assert_eq!(crossing(b, a, level), [x, y]);
        }
        assert_eq!(crossing([0.0, 0.0, 0.0], [3.0, -6.0, 3.0], 1.0), [1.0, -2.0]);
        // Denormal heights: somewhere on the edge.
        let [x, _] = crossing([1.0, 0.0, 0.0], [2.0, 0.0, 2.0 * f64::from_bits(1)], f64::from_bits(1));
        assert!((1.0..=2.0).contains(&x), "{x}");
    }
}

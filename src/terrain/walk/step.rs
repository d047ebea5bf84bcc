//! From face to face along a segment.
//!
//! All decisions are signs of exact predicates, so the row of faces, edges and vertices is that of
//! the real line; positions and heights are rounded once they are known.

use super::segment::{Event, Seen, Segment};
use crate::data::{FaceAcross, Surface};
use crate::terrain::linear::{linear, plan, turn};
use crate::terrain::overlay::from_least;
use crate::triangulation::geometry::height_along;
use crate::triangulation::num::Sign;

/// Where on a surface a position is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::terrain) enum At {
    /// Not on it, as far as it was approached.
    Off,
    /// Within a face.
    Inside { face: u32 },
    /// On the edge opposite a corner, between its ends.
    Edge { face: u32, corner: usize },
    /// At a corner.
    Vertex { face: u32, corner: usize },
}

/// What a segment comes to next.
#[derive(Debug, Clone, Copy)]
pub(super) enum Toward {
    /// An edge of a face, through the face.
    Edge(Exit),
    /// A corner of a face, through the face or along the edge opposite a corner.
    Vertex {
        face: u32,
        corner: usize,
        along: Option<usize>,
    },
}

impl Toward {
    /// The corner of a face, through the face.
    fn through(face: u32, corner: usize) -> Self {
        Toward::Vertex {
            face,
            corner,
            along: None,
        }
    }
}

/// The edge through which a segment leaves a face: opposite a corner, with its ends as the segment
/// sees them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exit {
    pub(super) face: u32,
    corner: usize,
    right: Seen,
    left: Seen,
}

impl Exit {
    /// Goes over to the edge through which the segment leaves the face across this one.
    ///
    /// # Errors
    /// Returns that face and its corner, if the segment comes to this corner instead.
    #[inline(always)]
    fn pass(&mut self, across: &FaceAcross, segment: &Segment) -> Result<(), (u32, usize)> {
        let FaceAcross {
            number: face,
            corner,
            apex,
        } = *across;
        let apex = segment.seen(apex);
        match apex.side {
            Sign::Positive => {
                self.left = apex;
                self.corner = (corner + 1) % 3;
            }
            Sign::Negative => {
                self.right = apex;
                self.corner = (corner + 2) % 3;
            }
            Sign::Zero => {
                return Err((face, corner));
            }
        }
        self.face = face;
        Ok(())
    }

    /// Returns what the segment comes to in the face across this edge.
    fn toward(mut self, across: &FaceAcross, segment: &Segment) -> Toward {
        match self.pass(across, segment) {
            Ok(()) => Toward::Edge(self),
            Err((face, corner)) => Toward::through(face, corner),
        }
    }
}

/// What a step comes to.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stepped {
    /// The end of the segment, which is here.
    Ended(At),
    /// An edge or a vertex at a position, and what comes next; `None` if the surface ends there.
    Reached(Event, Option<Toward>),
}

/// Steps over the faces of a surface.
pub(super) struct Steps<'a> {
    pub(super) surface: &'a dyn Surface,
    /// The number of faces that may still be passed. A surface of faces that do not overlap is
    /// never passed through for longer.
    left: u64,
}

/// Where a position on the edge between two points is, with its height.
pub(super) fn height_on([a, b]: [[f64; 3]; 2], [x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, height_along(a, b, [x, y])]
}

impl<'a> Steps<'a> {
    pub(super) fn new(surface: &'a dyn Surface) -> Self {
        Steps {
            surface,
            left: 8 * surface.face_count() as u64 + 64,
        }
    }

    /// Returns true if the faces are not those of a surface: there was no end to them.
    pub(super) fn are_endless(&self) -> bool {
        self.left == 0
    }

    /// Counts a face; returns `None` if there are too many.
    fn count(&mut self) -> Option<()> {
        self.left = self.left.saturating_sub(1);
        (self.left > 0).then_some(())
    }

    /// Returns a position, with the height of the surface there.
    pub(super) fn point(&self, at: At, q: [f64; 2]) -> Option<[f64; 3]> {
        let corners = |face| self.surface.triangle(face);
        Some(match at {
            At::Off => return None,
            At::Inside { face } => {
                let triangle = from_least(corners(face)?);
                [q[0], q[1], linear(triangle, q)]
            }
            At::Edge { face, corner } => {
                let corners = corners(face)?;
                height_on([1, 2].map(|k| corners[(corner + k) % 3]), q)
            }
            At::Vertex { face, corner } => corners(face)?[corner],
        })
    }

    /// Goes on to a corner of a face, through the face or along the edge opposite a corner, unless
    /// the segment ends before.
    pub(super) fn reach(
        &mut self,
        face: u32,
        corner: usize,
        along: Option<usize>,
        segment: &Segment,
        take: &mut impl FnMut(Option<[f64; 3]>),
    ) -> Stepped {
        let nowhere = Stepped::Reached(Event::Point(segment.to), None);
        if self.count().is_none() {
            return nowhere;
        }
        let Some(corners) = self.surface.triangle(face) else {
            return nowhere;
        };
        let vertex = corners[corner];
        let order = segment.compare_points(segment.to, plan(vertex));
        if order.is_gt() {
            take(Some(vertex));
            let next = self.around(face, corner, segment);
            return Stepped::Reached(Event::Point(plan(vertex)), next);
        }
        let at = match along {
            _ if order.is_eq() => At::Vertex { face, corner },
            Some(corner) => At::Edge { face, corner },
            None => At::Inside { face },
        };
        take(self.point(at, segment.to));
        Stepped::Ended(at)
    }

    /// Goes over an edge to the next one, unless the segment ends before or a vertex comes first:
    /// then returns what it came to. `across` is the face beyond the edge.
    #[inline]
    pub(super) fn cross(
        &mut self,
        exit: &mut Exit,
        across: Option<&FaceAcross>,
        segment: &Segment,
        take: &mut impl FnMut(Option<[f64; 3]>),
    ) -> Option<Stepped> {
        if self.count().is_none() {
            return Some(Stepped::Reached(Event::Point(segment.to), None));
        }
        let (face, corner) = (exit.face, exit.corner);
        let position = segment.crossing(&exit.right, &exit.left);
        let edge = [exit.left, exit.right].map(|end| plan(end.at));
        if !segment.surely_goes_on(position, &exit.right, &exit.left) {
            let at = match turn(edge[1], edge[0], segment.to) {
                Sign::Positive => Some(At::Inside { face }),
                Sign::Zero => Some(At::Edge { face, corner }),
                Sign::Negative => None,
            };
            if let Some(at) = at {
                take(self.point(at, segment.to));
                return Some(Stepped::Ended(at));
            }
        }
        take(Some(position));
        let Some(across) = across else {
            return Some(Stepped::Reached(Event::Crossing(edge), None));
        };
        let (face, corner) = exit.pass(across, segment).err()?;
        let vertex = Toward::through(face, corner);
        Some(Stepped::Reached(Event::Crossing(edge), Some(vertex)))
    }

    /// Returns the face beyond an edge.
    #[inline]
    pub(super) fn across(&self, exit: &Exit) -> Option<FaceAcross> {
        self.surface.across(exit.face, exit.corner)
    }

    /// Returns what a segment comes to in a face that it enters through the edge opposite a corner.
    pub(super) fn enter(&self, face: u32, corner: usize, segment: &Segment) -> Option<Toward> {
        let corners = self.surface.face(face)?;
        let [apex, left, right] =
            [0, 1, 2].map(|k| self.surface.position(corners[(corner + k) % 3]));
        let exit = Exit {
            face,
            corner,
            right: segment.seen(right),
            left: segment.seen(left),
        };
        let across = FaceAcross {
            number: face,
            corner,
            apex,
        };
        Some(exit.toward(&across, segment))
    }

    /// Returns what a segment comes to from its start; `None` if that is not on the surface, or the
    /// segment follows the rim or leaves the surface there.
    pub(super) fn depart(&mut self, start: At, segment: &Segment) -> Option<Toward> {
        match start {
            At::Off => None,
            At::Inside { face } => {
                let corners = self.surface.face(face)?;
                let seen = corners.map(|v| segment.seen(self.surface.position(v)));
                (0..3).find_map(|corner| {
                    let [own, right, left] = [0, 1, 2].map(|i| seen[(corner + i) % 3]);
                    match [own, right, left].map(|seen| seen.side) {
                        [_, Sign::Negative, Sign::Positive] => Some(Toward::Edge(Exit {
                            face,
                            corner,
                            right,
                            left,
                        })),
                        [Sign::Zero, Sign::Positive, Sign::Negative] => Some(Toward::Vertex {
                            face,
                            corner,
                            along: None,
                        }),
                        _ => None,
                    }
                })
            }
            At::Edge { face, corner } => {
                let corners = self.surface.face(face)?;
                let [a, b] = [1, 2].map(|k| self.surface.position(corners[(corner + k) % 3]));
                let [of_a, of_b] = [a, b].map(|end| segment.seen(end));
                match (of_a.side, of_b.side) {
                    (Sign::Positive, Sign::Negative) => self.enter(face, corner, segment),
                    (Sign::Negative, Sign::Positive) => {
                        let exit = Exit {
                            face,
                            corner,
                            right: of_a,
                            left: of_b,
                        };
                        let across = self.surface.across(face, corner)?;
                        Some(exit.toward(&across, segment))
                    }
                    (Sign::Zero, Sign::Zero) => {
                        self.surface.neighbor(face, corner)?;
                        let is_forward = segment.compare_points([a[0], a[1]], [b[0], b[1]]).is_lt();
                        Some(Toward::Vertex {
                            face,
                            corner: (corner + if is_forward { 2 } else { 1 }) % 3,
                            along: Some(corner),
                        })
                    }
                    _ => None,
                }
            }
            At::Vertex { face, corner } => self.around(face, corner, segment),
        }
    }

    /// Returns what a segment through a vertex comes to in the faces linked around it; `None` if it
    /// leaves these or follows the rim.
    pub(super) fn around(
        &mut self,
        first: u32,
        corner: usize,
        segment: &Segment,
    ) -> Option<Toward> {
        // Counter-clockwise, and from the first face clockwise if that ends at the rim.
        for turn in [1, 2] {
            let (mut face, mut k) = (first, corner);
            loop {
                if let Some(found) = self.in_wedge(face, k, segment) {
                    return Some(found);
                }
                self.count()?;
                let Some(next) = self.surface.across(face, (k + turn) % 3) else {
                    break;
                };
                if next.number == first {
                    return None;
                }
                // Not by its number, which need not be the same in faces of different files.
                k = (next.corner + turn) % 3;
                face = next.number;
            }
        }
        None
    }

    /// Returns what a segment through a corner of a face comes to in this face, or along the edges
    /// from this corner unless these are at the rim.
    fn in_wedge(&self, face: u32, corner: usize, segment: &Segment) -> Option<Toward> {
        let corners = self.surface.triangle(face)?;
        let [own, right, left] = [0, 1, 2].map(|k| corners[(corner + k) % 3]);
        let seen = [right, left].map(|p| segment.seen(p));
        let sides = seen.map(|of| of.side);
        // A face without area has no inside.
        if sides == [Sign::Negative, Sign::Positive]
            && turn(plan(own), plan(right), plan(left)) == Sign::Positive
        {
            return Some(Toward::Edge(Exit {
                face,
                corner,
                right: seen[0],
                left: seen[1],
            }));
        }
        [1, 2].into_iter().find_map(|k| {
            let (end, opposite) = ((corner + k) % 3, (corner + 3 - k) % 3);
            let is_along = sides[k - 1] == Sign::Zero
                && segment
                    .compare_points(plan(own), plan(corners[end]))
                    .is_lt()
                && self.surface.neighbor(face, opposite).is_some();
            is_along.then_some(Toward::Vertex {
                face,
                corner: end,
                along: Some(opposite),
            })
        })
    }
}

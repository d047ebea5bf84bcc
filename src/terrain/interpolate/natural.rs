//! Natural neighbor interpolation, without inserting the position.
//!
//! If a position `q` were a vertex, it would destroy the triangles whose circles contain it, its
//! *conflict zone*, and its Voronoi cell would take some area from the cells of the vertices around
//! the zone. The zone grows from the triangle at `q`, but never across a hard edge:
//!
//! ```text
//!      a-------d                   zone: a b e d, with two triangles
//!     / \  q  / \                  g: circumcenter of q and one edge of its border
//!    /   \   /   \                 c: circumcenter of a triangle in it
//!   b-----\-/-----f                cell of `d` loses the polygon g, c .. c, g
//!          e
//! ```
//!
//! # Why a hard edge may bound the zone
//!
//! Let `A(t, v)` be the area that one triangle `t` of the zone adds to what its corner `v` loses.
//! With `q` as origin, `T` twice the area of `t`, `s_v` twice the area of `q` and the edge opposite
//! `v`, and `P` the determinant of the in-circle test, it is `P^2 / (8 T s_u s_w)`. That is in
//! proportion to `s_v`, so to the barycentric coordinates of `q` in `t`. So the result is a
//! weighted mean, over the triangles of *any* zone, of the planes through them:
//!
//! - Linear functions are reproduced whatever bounds the zone.
//! - A triangle enters and leaves the zone with `P = 0`: without a jump, and without a kink.
//! - On a hard edge the two circumcenters next to it move away to infinity, and its ends get all
//!   the weight: the limit is linear between the ends, from both sides. The same holds at the rim.
//! - The edges that the zone crosses are Delaunay. So `q` sees all of it, no vertex is within it,
//!   and consecutive corners of each polygon turn one way: no area is negative.
//!
//! # Robustness
//!
//! The in-circle test is rounded. It may err only where `P` is about 0, and the triangle then adds
//! about nothing, be it in the zone or not: cocircular points need no exact arithmetic. Areas are
//! computed along a tour around the zone, in which no term is large unless an area is.

use super::base::{Base, before, cross, minus, next, square};

/// A vertex seen from the position.
#[derive(Debug, Clone, Copy)]
struct SeenVertex {
    number: u32,
    /// The vector to it.
    to: [f64; 2],
    /// The square of its distance.
    square: f64,
}

/// An edge of a triangle of the zone.
#[derive(Debug, Clone, Copy)]
struct ZoneEdge {
    face: u32,
    /// The index of the corner opposite the edge.
    i: usize,
    from: SeenVertex,
    to: SeenVertex,
    /// Twice the area of the position and the edge.
    area: f64,
    /// The circumcenter of the triangle.
    center: [f64; 2],
}

/// What is still to be done of a tour around a zone.
#[derive(Debug, Clone, Copy)]
enum TourStep {
    /// Pass an edge of a triangle of the zone, or find that it is on the border.
    Edge(ZoneEdge),
    /// Go from a triangle back to the one before it, given their circumcenters.
    Back { from: [f64; 2], to: [f64; 2] },
}

/// The memory of a tour, kept from one position to the next.
#[derive(Debug, Default)]
pub(super) struct Tour(Vec<TourStep>);

/// What a tour around a zone computes. All vectors are relative to the position.
trait Weigh {
    /// The tour passes from a triangle to a neighbor, given their circumcenters.
    fn pass(&mut self, from: [f64; 2], to: [f64; 2]);

    /// The tour comes to an edge of the border, counter-clockwise. `center` is the circumcenter of
    /// its triangle, `new` that of the position and the edge.
    fn border(&mut self, from: SeenVertex, center: [f64; 2], new: [f64; 2]);

    /// The tour is back where it began. Returns the interpolated height.
    fn height(self) -> Option<f64>;
}

/// Returns the height at a position by Sibson's weights: the areas that cells lose.
///
/// `face` contains the position, and `first` is one of its corners. `None` if a number overflows,
/// underflows, or is lost to rounding.
pub(super) fn sibson(
    base: &Base,
    face: u32,
    first: usize,
    q: [f64; 2],
    tour: &mut Tour,
) -> Option<f64> {
    travel(
        base,
        face,
        first,
        q,
        tour,
        Areas {
            mean: Mean::new(base, face, first),
            ends: None,
            lost: 0.0,
            head: 0.0,
        },
    )
}

/// Like [`sibson`], but by Laplace's weights: the length of the border between a cell and the new
/// one, over the distance.
pub(super) fn laplace(
    base: &Base,
    face: u32,
    first: usize,
    q: [f64; 2],
    tour: &mut Tour,
) -> Option<f64> {
    travel(
        base,
        face,
        first,
        q,
        tour,
        Lengths {
            mean: Mean::new(base, face, first),
            ends: None,
        },
    )
}

/// Goes around the zone of a position, counter-clockwise from a corner of the triangle there.
fn travel(
    base: &Base,
    face: u32,
    first: usize,
    q: [f64; 2],
    Tour(steps): &mut Tour,
    mut weigh: impl Weigh,
) -> Option<f64> {
    let see = |number: u32| {
        let to = minus(base.point(number), [q[0], q[1], 0.0]);
        SeenVertex {
            number,
            to,
            square: square(to),
        }
    };
    let sides = ZoneEdge::of_face(face, base.face(face).corners.map(see));
    steps.clear();
    // The last one is taken first: the edge from `first`.
    steps.extend([next(first), first, before(first)].map(|k| TourStep::Edge(sides[k])));
    // No more triangles can be passed than there are, except by rounding errors.
    let mut left = base.count();
    while let Some(step) = steps.pop() {
        let mut side = match step {
            TourStep::Back { from, to } => {
                weigh.pass(from, to);
                continue;
            }
            TourStep::Edge(side) => side,
        };
        // Into the zone, along the edges that begin where this one does.
        while let Some((beyond, j)) = base.across(side.face, side.i) {
            let apex = see(base.face(beyond).corners[j]);
            let Some([on_the_left, on_the_right]) = side.beyond(beyond, j, apex) else {
                break;
            };
            left = left.checked_sub(1)?;
            let new = on_the_left.center;
            weigh.pass(side.center, new);
            steps.push(TourStep::Back {
                from: new,
                to: side.center,
            });
            steps.push(TourStep::Edge(on_the_right));
            side = on_the_left;
        }
        weigh.border(side.from, side.center, side.new_center()?);
    }
    weigh.height().filter(|height| height.is_finite())
}

impl ZoneEdge {
    /// The edges of a triangle of the zone, by the corners opposite them.
    #[inline]
    fn of_face(face: u32, corners: [SeenVertex; 3]) -> [Self; 3] {
        let center = circumcenter(corners);
        [0, 1, 2].map(|i| {
            let (from, to) = (corners[next(i)], corners[before(i)]);
            ZoneEdge {
                face,
                i,
                from,
                to,
                area: cross(from.to, to.to),
                center,
            }
        })
    }

    /// The other two edges of the triangle beyond this one, left and right, if that triangle
    /// belongs to the zone. Its corner `apex`, with index `j`, is opposite this edge.
    #[inline]
    fn beyond(&self, face: u32, j: usize, apex: SeenVertex) -> Option<[Self; 2]> {
        let ZoneEdge { from, to, area, .. } = *self;
        let (left_area, right_area) = (cross(from.to, apex.to), cross(apex.to, to.to));
        let inside = to.square * left_area + from.square * right_area - apex.square * area;
        if inside <= 0.0 || inside.is_nan() {
            return None;
        }
        let center = circumcenter([to, from, apex]);
        let left = ZoneEdge {
            face,
            i: next(j),
            from,
            to: apex,
            area: left_area,
            center,
        };
        let right = ZoneEdge {
            face,
            i: before(j),
            from: apex,
            to,
            area: right_area,
            center,
        };
        Some([left, right])
    }

    /// The circumcenter of the position and an edge of the border; `None` if the position is on the
    /// border by a rounding error.
    #[inline]
    fn new_center(&self) -> Option<[f64; 2]> {
        let ZoneEdge { from, to, area, .. } = *self;
        if area <= 0.0 {
            return None;
        }
        let scale = 0.5 / area;
        Some([
            (from.square * to.to[1] - to.square * from.to[1]) * scale,
            (to.square * from.to[0] - from.square * to.to[0]) * scale,
        ])
    }
}

/// Returns the circumcenter of a triangle.
#[inline]
fn circumcenter([a, b, c]: [SeenVertex; 3]) -> [f64; 2] {
    let area = cross(a.to, b.to) + cross(b.to, c.to) + cross(c.to, a.to);
    let scale = 0.5 / area;
    [
        (a.square * (b.to[1] - c.to[1])
            + b.square * (c.to[1] - a.to[1])
            + c.square * (a.to[1] - b.to[1]))
            * scale,
        (a.square * (c.to[0] - b.to[0])
            + b.square * (a.to[0] - c.to[0])
            + c.square * (b.to[0] - a.to[0]))
            * scale,
    ]
}

/// A weighted mean of heights, relative to one of them.
struct Mean<'a> {
    base: &'a Base,
    origin: f64,
    weights: f64,
    heights: f64,
}

impl<'a> Mean<'a> {
    fn new(base: &'a Base, face: u32, first: usize) -> Self {
        Mean {
            base,
            origin: base.corners(face)[first][2],
            weights: 0.0,
            heights: 0.0,
        }
    }

    /// Adds a vertex. Rounding may make a weight negative that is about 0. A weight that is not a
    /// number stays, so that there is no result.
    #[inline]
    fn add(&mut self, vertex: u32, weight: f64) {
        let weight = if weight < 0.0 { 0.0 } else { weight };
        self.weights += weight;
        self.heights += weight * (self.base.point(vertex)[2] - self.origin);
    }

    fn height(&self) -> Option<f64> {
        (self.weights > 0.0).then(|| self.origin + self.heights / self.weights)
    }
}

/// The first and the last edge of the border so far.
struct Ends {
    first: u32,
    /// The circumcenters at the first edge: of its triangle, and of the position and the edge.
    begin: [[f64; 2]; 2],
    /// The circumcenter of the position and the last edge.
    last: [f64; 2],
}

/// Sibson's weights: twice the areas of the polygons that cells lose.
struct Areas<'a> {
    mean: Mean<'a>,
    ends: Option<Ends>,
    /// Of the cell of the vertex after the last edge of the border, clockwise so far.
    lost: f64,
    /// Likewise, of the vertex before the first edge: the part before that edge.
    head: f64,
}

impl Weigh for Areas<'_> {
    #[inline]
    fn pass(&mut self, from: [f64; 2], to: [f64; 2]) {
        self.lost += cross(to, from);
    }

    #[inline]
    fn border(&mut self, from: SeenVertex, center: [f64; 2], new: [f64; 2]) {
        match &mut self.ends {
            Some(ends) => {
                self.mean.add(
                    from.number,
                    self.lost + cross(new, center) + cross(ends.last, new),
                );
                ends.last = new;
            }
            None => {
                self.head = self.lost;
                self.ends = Some(Ends {
                    first: from.number,
                    begin: [center, new],
                    last: new,
                });
            }
        }
        self.lost = cross(center, new);
    }

    fn height(mut self) -> Option<f64> {
        let Ends {
            first,
            begin: [center, new],
            last,
        } = self.ends?;
        self.mean.add(
            first,
            self.lost + self.head + cross(new, center) + cross(last, new),
        );
        self.mean.height()
    }
}

/// Laplace's weights.
struct Lengths<'a> {
    mean: Mean<'a>,
    ends: Option<(SeenVertex, [f64; 2], [f64; 2])>,
}

impl Lengths<'_> {
    /// Adds a vertex whose cell borders the new one from one circumcenter to another.
    #[inline]
    fn add(&mut self, vertex: SeenVertex, from: [f64; 2], to: [f64; 2]) {
        // The border is perpendicular to the vector to the vertex.
        let along = vertex.to[0] * (to[1] - from[1]) - vertex.to[1] * (to[0] - from[0]);
        self.mean.add(vertex.number, along / vertex.square);
    }
}

impl Weigh for Lengths<'_> {
    #[inline]
    fn pass(&mut self, _from: [f64; 2], _to: [f64; 2]) {}

    #[inline]
    fn border(&mut self, from: SeenVertex, _center: [f64; 2], new: [f64; 2]) {
        match self.ends {
            Some((first, begin, last)) => {
                self.add(from, last, new);
                self.ends = Some((first, begin, new));
            }
            None => self.ends = Some((from, new, new)),
        }
    }

    fn height(mut self) -> Option<f64> {
        let (first, begin, last) = self.ends?;
        self.add(first, last, begin);
        self.mean.height()
    }
}

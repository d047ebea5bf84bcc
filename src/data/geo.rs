//! Conversions to and from the types of the [`geo`](https://docs.rs/geo) crate (0.33), for its
//! algorithms: simplification, buffers, predicates, areas.
//!
//! The types of `geo` are two-dimensional: heights are dropped in one direction, and unknown (NaN)
//! in the other.
//!
//! | from | to | |
//! |---|---|---|
//! | [`&Shape`](Shape) | [`Geometry`] | always; rings are nested into polygons |
//! | [`&Geometry`](Geometry) | [`Shape`] | unless it is a collection of several kinds |
//! | [`&ContourLine`](ContourLine) | [`LineString`] | always |
//! | [`Bounds`] | [`Rect`] | unless empty |
//! | [`Rect`] | [`Bounds`] | always, of height 0 |
//!
//! ```
//! use breakline::data::{Bounds, Shape};
//! use geo::{Area, BoundingRect, Geometry};
//!
//! let ring = |min: f64, max: f64| {
//!     vec![[min, min, 0.0], [min, max, 0.0], [max, max, 0.0], [max, min, 0.0], [min, min, 0.0]]
//! };
//! let lake_with_island = Shape::Polygon(vec![ring(0.0, 10.0), ring(4.0, 6.0)]);
//! let geometry = Geometry::from(&lake_with_island);
//! assert_eq!(geometry.unsigned_area(), 96.0);
//! let bounds = Bounds::from(geometry.bounding_rect().unwrap());
//! assert_eq!(bounds.max, [10.0, 10.0, 0.0]);
//! ```

use geo::coordinate_position::{CoordPos, coord_pos_relative_to_ring};
use geo::{
    Area, BoundingRect, Coord, CoordsIter, Geometry, GeometryCollection, LineString,
    MultiLineString,
};
use geo::{MultiPoint, MultiPolygon, Point, Polygon, Rect};

use super::{Bounds, ContourLine, Shape};
use crate::error::{Error, Result};

impl From<&Shape> for Geometry<f64> {
    /// Converts a shape to its geometry in plan.
    ///
    /// A shape of one part becomes a single geometry, one of several parts a multiple, a null shape
    /// an empty collection. The holes of a polygon follow from how its rings are nested, not from
    /// their direction: a ring within an odd number of others is a hole of the innermost of them.
    /// Outer rings become counter-clockwise and holes clockwise, as OGC requires.
    ///
    /// # Complexity
    /// Linear; for a polygon of `k` rings, `k^2` comparisons of boxes in addition.
    fn from(shape: &Shape) -> Self {
        match shape {
            Shape::Null => Geometry::GeometryCollection(GeometryCollection::default()),
            Shape::Points(points) => match points[..] {
                [point] => Point(plan(point)).into(),
                _ => MultiPoint::from_iter(points.iter().map(|&p| Point(plan(p)))).into(),
            },
            Shape::Lines(parts) => match &parts[..] {
                [line] => line_string(line).into(),
                _ => MultiLineString::from_iter(parts.iter().map(|part| line_string(part))).into(),
            },
            Shape::Polygon(rings) => {
                one_or_many(nested(rings.iter().map(|ring| line_string(ring)).collect()))
            }
            Shape::Faces(faces) => {
                one_or_many(faces.iter().filter_map(|face| polygon(face)).collect())
            }
        }
    }
}

impl TryFrom<&Geometry<f64>> for Shape {
    type Error = Error;

    /// Converts a geometry to a shape with heights of NaN; see [`Shape::set_height`].
    ///
    /// Rings are directed as described at [`Shape::Polygon`]. An empty collection becomes a null
    /// shape.
    ///
    /// # Errors
    /// If it is a collection whose members are not all points, all lines or all polygons.
    fn try_from(geometry: &Geometry<f64>) -> Result<Self> {
        Ok(match geometry {
            Geometry::Point(point) => Shape::Points(vec![vertex(point.0)]),
            Geometry::MultiPoint(points) => {
                Shape::Points(points.iter().map(|point| vertex(point.0)).collect())
            }
            Geometry::Line(line) => Shape::Lines(vec![vec![vertex(line.start), vertex(line.end)]]),
            Geometry::LineString(line) => Shape::Lines(vec![vertices(line)]),
            Geometry::MultiLineString(lines) => Shape::Lines(lines.iter().map(vertices).collect()),
            Geometry::Polygon(polygon) => Shape::Polygon(rings(polygon)),
            Geometry::MultiPolygon(polygons) => {
                Shape::Polygon(polygons.iter().flat_map(rings).collect())
            }
            Geometry::Rect(rect) => Shape::Polygon(rings(&rect.to_polygon())),
            Geometry::Triangle(triangle) => Shape::Polygon(rings(&triangle.to_polygon())),
            Geometry::GeometryCollection(members) => members
                .iter()
                .map(Shape::try_from)
                .try_fold(Shape::Null, |all, member| joined(all, member?))?,
        })
    }
}

impl From<&ContourLine> for LineString<f64> {
    /// Converts a contour to a line in plan, with higher ground on its right; the level is dropped.
    fn from(line: &ContourLine) -> Self {
        LineString::from_iter(line.points.iter().copied())
    }
}

impl TryFrom<Bounds> for Rect<f64> {
    type Error = Error;

    /// Converts a box to a rectangle in plan.
    ///
    /// # Errors
    /// If the box is empty, which a `Rect` cannot be.
    fn try_from(bounds: Bounds) -> Result<Self> {
        if bounds.is_empty() {
            return Err(Error::usage("an empty box is not a rectangle"));
        }
        let Bounds { min, max } = bounds;
        Ok(Rect::new(plan(min), plan(max)))
    }
}

impl From<Rect<f64>> for Bounds {
    /// Converts a rectangle to a box with heights of 0.
    fn from(rect: Rect<f64>) -> Self {
        let (min, max) = (rect.min(), rect.max());
        Bounds {
            min: [min.x, min.y, 0.0],
            max: [max.x, max.y, 0.0],
        }
    }
}

fn plan([x, y, _]: [f64; 3]) -> Coord<f64> {
    Coord { x, y }
}

fn vertex(at: Coord<f64>) -> [f64; 3] {
    [at.x, at.y, f64::NAN]
}

fn line_string(part: &[[f64; 3]]) -> LineString<f64> {
    LineString::from_iter(part.iter().map(|&p| plan(p)))
}

/// Returns a face in plan; `None` if it has no ring.
fn polygon(face: &[Vec<[f64; 3]>]) -> Option<Polygon<f64>> {
    let (outer, holes) = face.split_first()?;
    Some(Polygon::new(
        line_string(outer),
        holes.iter().map(|hole| line_string(hole)).collect(),
    ))
}

fn vertices(line: &LineString<f64>) -> Vec<[f64; 3]> {
    line.coords().map(|&at| vertex(at)).collect()
}

fn one_or_many(polygons: Vec<Polygon<f64>>) -> Geometry<f64> {
    match <[Polygon<f64>; 1]>::try_from(polygons) {
        Ok([polygon]) => polygon.into(),
        Err(polygons) => MultiPolygon(polygons).into(),
    }
}

/// The polygons that rings form which do not cross.
fn nested(rings: Vec<LineString<f64>>) -> Vec<Polygon<f64>> {
    let rings: Vec<Ring> = rings.into_iter().map(Ring::new).collect();
    // For each ring the rings around it, outermost first.
    let around: Vec<Vec<usize>> = (0..rings.len())
        .map(|inner| {
            let mut around: Vec<usize> = (0..rings.len())
                .filter(|&outer| rings[inner].is_in(&rings[outer]))
                .collect();
            around.sort_by(|&a, &b| rings[b].area.abs().total_cmp(&rings[a].area.abs()));
            around
        })
        .collect();
    let mut polygons: Vec<Option<Polygon<f64>>> = Vec::new();
    for (ring, around) in rings.iter().zip(&around) {
        let is_outer = around.len().is_multiple_of(2);
        polygons.push(is_outer.then(|| Polygon::new(ring.directed(1.0), Vec::new())));
    }
    for (ring, around) in rings
        .iter()
        .zip(&around)
        .filter(|(_, around)| !around.len().is_multiple_of(2))
    {
        let innermost = around.last().and_then(|&outer| polygons[outer].as_mut());
        if let Some(polygon) = innermost {
            polygon.interiors_push(ring.directed(-1.0));
        }
    }
    polygons.into_iter().flatten().collect()
}

/// A closed line, its box, and its area: positive if it runs counter-clockwise.
struct Ring {
    line: LineString<f64>,
    bounds: Option<Rect<f64>>,
    area: f64,
}

impl Ring {
    fn new(mut line: LineString<f64>) -> Self {
        line.close();
        let is_finite = line.coords().all(|at| at.x.is_finite() && at.y.is_finite());
        let bounds = line.bounding_rect().filter(|_| is_finite);
        let polygon = Polygon::new(line, Vec::new());
        let area = polygon.signed_area();
        Ring {
            line: polygon.into_inner().0,
            bounds,
            area,
        }
    }

    /// Returns true if the ring lies within another one; the two must not cross.
    fn is_in(&self, outer: &Ring) -> bool {
        let (Some(inner_box), Some(outer_box)) = (self.bounds, outer.bounds) else {
            return false;
        };
        let boxes_fit = (outer_box.min().x <= inner_box.min().x
            && inner_box.max().x <= outer_box.max().x)
            && (outer_box.min().y <= inner_box.min().y && inner_box.max().y <= outer_box.max().y);
        if !boxes_fit || self.area.abs() >= outer.area.abs() {
            return false;
        }
        // The first point that is not on the other ring decides. Vertices may all touch it;
        // midpoints of edges do so only if the edge runs along it.
        let middles = self.line.lines().map(|edge| (edge.start + edge.end) / 2.0);
        self.line
            .coords_iter()
            .chain(middles)
            .map(|at| coord_pos_relative_to_ring(at, &outer.line))
            .find(|position| *position != CoordPos::OnBoundary)
            .is_some_and(|position| position == CoordPos::Inside)
    }

    /// The line, reversed if necessary so that its area has the sign of `sign`.
    fn directed(&self, sign: f64) -> LineString<f64> {
        let mut line = self.line.clone();
        if self.area * sign < 0.0 {
            line.0.reverse();
        }
        line
    }
}

/// The rings of a polygon, directed as in [`Shape::Polygon`].
fn rings(polygon: &Polygon<f64>) -> Vec<Vec<[f64; 3]>> {
    let outer = (polygon.exterior(), -1.0);
    let holes = polygon.interiors().iter().map(|hole| (hole, 1.0));
    std::iter::once(outer)
        .chain(holes)
        .map(|(ring, sign)| vertices(&Ring::new(ring.clone()).directed(sign)))
        .collect()
}

/// Combines two shapes of one kind.
fn joined(all: Shape, more: Shape) -> Result<Shape> {
    Ok(match (all, more) {
        (Shape::Null, shape) | (shape, Shape::Null) => shape,
        (Shape::Points(a), Shape::Points(b)) => Shape::Points([a, b].concat()),
        (Shape::Lines(a), Shape::Lines(b)) => Shape::Lines([a, b].concat()),
        (Shape::Polygon(a), Shape::Polygon(b)) => Shape::Polygon([a, b].concat()),
        (a, b) => {
            let kinds = format!("{:?} and {:?}", a.kind(), b.kind()).to_lowercase();
            return Err(Error::unsupported(format!(
                "a collection of {kinds} has no single kind of geometry"
            ))
            .cure("convert its members one by one"));
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counter-clockwise if `turn` is positive.
    fn square(min: f64, max: f64, turn: f64) -> Vec<[f64; 3]> {
        let mut ring = vec![
            [min, min, 0.0],
            [max, min, 0.0],
            [max, max, 0.0],
            [min, max, 0.0],
            [min, min, 0.0],
        ];
        if turn < 0.0 {
            ring.reverse();
        }
        ring
    }

    #[test]
    fn shapes_come_back() {
        let line = vec![[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [5.0, 2.0, 0.0]];
        for shape in [
            Shape::Null,
            Shape::Points(vec![[1.0, 2.0, 0.0]]),
            Shape::Points(vec![[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]]),
            Shape::Points(Vec::new()),
            Shape::Lines(vec![line.clone()]),
            Shape::Lines(vec![line.clone(), line]),
            Shape::Polygon(vec![
                square(0.0, 9.0, -1.0),
                square(1.0, 2.0, 1.0),
                square(3.0, 4.0, 1.0),
            ]),
            Shape::Polygon(vec![square(0.0, 9.0, -1.0), square(10.0, 12.0, -1.0)]),
        ] {
            let mut back = Shape::try_from(&Geometry::from(&shape)).unwrap();
            assert!(back.vertices().all(|v| v[2].is_nan()));
            back.set_height(0.0);
            assert_eq!(back, shape);
        }
    }

    #[test]
    fn rings_nest_whatever_their_order_and_direction() {
        // A lake, an island in it with a pond, and a ring that touches the lake's shore from
        // within.
        let touching = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
        ];
        let rings = [
            square(0.0, 10.0, 1.0),
            square(2.0, 8.0, 1.0),
            square(4.0, 6.0, 1.0),
            touching,
        ];
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
            for turns in 0..16 {
                let turned = |i: usize| {
                    let mut ring = rings[i].clone();
                    if turns >> i & 1 == 1 {
                        ring.reverse();
                    }
                    ring
                };
                let geometry = Geometry::from(&Shape::Polygon(order.map(turned).to_vec()));
                assert_eq!(geometry.unsigned_area(), 100.0 - 36.0 + 4.0 - 0.5);
                let Geometry::MultiPolygon(polygons) = geometry else {
                    panic!("two polygons")
                };
                let mut holes: Vec<usize> = polygons
                    .iter()
                    .map(|polygon| polygon.interiors().len())
                    .collect();
                holes.sort_unstable();
                assert_eq!(holes, [0, 2]);
                assert!(
                    polygons
                        .iter()
                        .all(|p| Polygon::new(p.exterior().clone(), vec![]).signed_area() > 0.0)
                );
            }
        }
    }

    #[test]
    fn odd_rings_are_no_panic() {
        let nan = vec![
            [0.0, f64::NAN, 0.0],
            [1.0, 0.0, 0.0],
            [f64::INFINITY, 1.0, 0.0],
        ];
        for rings in [
            vec![],
            vec![vec![]],
            vec![nan.clone(), square(0.0, 1.0, 1.0)],
            vec![vec![[1.0; 3]], nan],
        ] {
            let count = rings.len();
            let back = Shape::try_from(&Geometry::from(&Shape::Polygon(rings))).unwrap();
            let Shape::Polygon(back) = back else {
                panic!("a polygon")
            };
            assert_eq!(back.len(), count);
        }
    }

    #[test]
    fn collections_of_one_kind_are_shapes() {
        let point = Geometry::from(Point::new(1.0, 2.0));
        let points =
            Geometry::GeometryCollection(GeometryCollection(vec![point.clone(), point.clone()]));
        assert_eq!(Shape::try_from(&points).unwrap().vertices().count(), 2);
        let line = Geometry::from(LineString::from(vec![[0.0, 0.0], [1.0, 1.0]]));
        let mixed = Geometry::GeometryCollection(GeometryCollection(vec![point, line]));
        let error = Shape::try_from(&mixed).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a collection of points and lines has no single kind of geometry"
        );
    }

    #[test]
    fn triangles_lines_and_boxes() {
        let triangle = vec![
            [0.0, 0.0, 5.0],
            [4.0, 0.0, 6.0],
            [0.0, 3.0, 7.0],
            [0.0, 0.0, 5.0],
        ];
        assert_eq!(
            Geometry::from(&Shape::Faces(vec![vec![triangle]])).unsigned_area(),
            6.0
        );
        let face = vec![square(0.0, 10.0, 1.0), square(2.0, 4.0, 1.0)];
        assert_eq!(
            Geometry::from(&Shape::Faces(vec![face, vec![]])).unsigned_area(),
            96.0
        );
        let contour = ContourLine {
            level: 5.0,
            points: vec![[0.0, 1.0], [2.0, 3.0]],
        };
        assert_eq!(
            LineString::from(&contour),
            LineString::from(vec![[0.0, 1.0], [2.0, 3.0]])
        );
        let bounds = Bounds {
            min: [1.0, 2.0, 0.0],
            max: [3.0, 5.0, 0.0],
        };
        assert_eq!(Bounds::from(Rect::try_from(bounds).unwrap()), bounds);
        assert!(Rect::try_from(Bounds::default()).is_err());
    }
}

use super::Attributes;
use super::named::named;
use crate::crs::Crs;
use crate::error::Wording;

/// The geometry of one record of a vector layer.
///
/// A vertex is `[x, y, z]`, with a `z` of NaN if it has no height. Measures (M) are dropped.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A record without geometry.
    Null,
    /// One or many points.
    Points(Vec<[f64; 3]>),
    /// The parts of a polyline.
    Lines(Vec<Vec<[f64; 3]>>),
    /// The rings of a polygon, each with its first vertex repeated at the end. Outer rings are
    /// clockwise as in a shapefile; readers do not repair the direction.
    Polygon(Vec<Vec<[f64; 3]>>),
    /// The faces of a multipatch, which may be steep or vertical: each has an outer ring, and one
    /// for each of its holes. Rings have their first vertex repeated at the end.
    Faces(Vec<Vec<Vec<[f64; 3]>>>),
}

/// Returns twice the area of a ring that repeats its first vertex, negative if it is clockwise;
/// relative to the first vertex, for precision.
pub(crate) fn doubled_area<const N: usize>(ring: &[[f64; N]]) -> f64 {
    let at = |p: &[f64; N]| [p[0] - ring[0][0], p[1] - ring[0][1]];
    let cross = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a * d - c * b;
    let sides = ring.windows(2);
    sides.map(|side| cross(at(&side[0]), at(&side[1]))).sum()
}

/// Returns the rings of one polygon, the outer one first, in the directions of [`Shape::Polygon`]:
/// the outer one clockwise, its holes counter-clockwise.
pub(crate) fn oriented(mut rings: Vec<Vec<[f64; 3]>>) -> Vec<Vec<[f64; 3]>> {
    for (i, ring) in rings.iter_mut().enumerate() {
        let is_clockwise = doubled_area(ring) < 0.0;
        if is_clockwise != (i == 0) {
            ring.reverse();
        }
    }
    rings
}

/// Returns the rings of each polygon of a [`Shape::Polygon`]: an outer one, which is clockwise, and
/// its holes after it.
pub(crate) fn polygons(rings: &[Vec<[f64; 3]>]) -> Vec<&[Vec<[f64; 3]>]> {
    let is_hole = |_: &Vec<[f64; 3]>, ring: &Vec<[f64; 3]>| doubled_area(ring) > 0.0;
    rings.chunk_by(is_hole).collect()
}

/// The kinds of [`Shape`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ShapeKind {
    /// [`Shape::Null`]
    Null,
    /// [`Shape::Points`]
    Points,
    /// [`Shape::Lines`]
    Lines,
    /// [`Shape::Polygon`]
    Polygon,
    /// [`Shape::Faces`]
    Faces,
}

impl Shape {
    /// Returns the faces of a surface if all are triangles, else a polygon with the rings of all.
    pub(crate) fn of_faces(faces: Vec<Vec<Vec<[f64; 3]>>>) -> Self {
        let is_triangle =
            |face: &Vec<Vec<[f64; 3]>>| matches!(&face[..], [ring] if ring.len() == 4);
        match faces.iter().all(is_triangle) {
            true => Shape::Faces(faces),
            false => Shape::Polygon(faces.into_iter().flatten().collect()),
        }
    }

    /// Returns the kind of the geometry.
    pub fn kind(&self) -> ShapeKind {
        match self {
            Shape::Null => ShapeKind::Null,
            Shape::Points(_) => ShapeKind::Points,
            Shape::Lines(_) => ShapeKind::Lines,
            Shape::Polygon(_) => ShapeKind::Polygon,
            Shape::Faces(_) => ShapeKind::Faces,
        }
    }

    /// Returns all vertices, in order.
    pub fn vertices(&self) -> Box<dyn Iterator<Item = &[f64; 3]> + '_> {
        match self {
            Shape::Null => Box::new(std::iter::empty()),
            Shape::Points(points) => Box::new(points.iter()),
            Shape::Lines(parts) | Shape::Polygon(parts) => Box::new(parts.iter().flatten()),
            Shape::Faces(faces) => Box::new(faces.iter().flatten().flatten()),
        }
    }

    /// Returns the number of points, lines or polygons; a polygon is an outer ring with its holes.
    pub(crate) fn part_count(&self) -> usize {
        match self {
            Shape::Null => 0,
            Shape::Points(points) => points.len(),
            Shape::Lines(parts) => parts.len(),
            Shape::Polygon(rings) => polygons(rings).len(),
            Shape::Faces(faces) => faces.len(),
        }
    }

    /// Sets the height of every vertex.
    pub fn set_height(&mut self, z: f64) {
        self.change_vertices(|p| p[2] = z);
    }

    /// Calls a function with every vertex, in order.
    pub(crate) fn change_vertices(&mut self, change: impl FnMut(&mut [f64; 3])) {
        match self {
            Shape::Null => {}
            Shape::Points(points) => points.iter_mut().for_each(change),
            Shape::Lines(parts) | Shape::Polygon(parts) => {
                parts.iter_mut().flatten().for_each(change)
            }
            Shape::Faces(faces) => faces.iter_mut().flatten().flatten().for_each(change),
        }
    }
}

/// The numbers of one attribute of a vector layer.
#[derive(Debug, Clone, Default)]
pub struct Column {
    /// The name of the attribute, as it was requested from the reader.
    pub name: String,
    /// One number per shape, in the order of [`Layer::shapes`]; NaN if the record has none.
    pub values: Vec<f64>,
}

/// The shapes of a vector file.
#[derive(Debug, Clone, Default)]
pub struct Layer {
    /// The format, such as "shapefile PolyLineZ".
    pub format: String,
    /// The shapes in the order of the file, null shapes included.
    pub shapes: Vec<Shape>,
    /// Coordinate system, if known.
    pub crs: Option<Crs>,
    /// What the file states as its coordinate system, if that is not understood.
    pub unread_crs: Option<String>,
    /// The names of the attributes.
    pub fields: Vec<String>,
    /// The numbers of the attributes that were requested, in the order of the request.
    pub columns: Vec<Column>,
    /// All attributes, if they were requested and the reader keeps them.
    pub attributes: Option<Attributes>,
    /// The numbers of the records that were chosen by a condition, counted from 1 as messages do;
    /// `None` if all were.
    pub chosen: Option<Vec<usize>>,
    /// Warnings for the user.
    pub warnings: Vec<Wording>,
}

impl Layer {
    /// Returns the column with this name: as written, else in any case.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let names = self.columns.iter().map(|column| column.name.as_str());
        named(names, name).map(|at| &self.columns[at])
    }

    /// Returns the number of a shape in the file, counted from 1, by its position in the layer.
    pub fn record(&self, at: usize) -> usize {
        let chosen = self.chosen.as_ref().and_then(|chosen| chosen.get(at));
        chosen.copied().unwrap_or(at + 1)
    }

    /// Removes the shapes that are marked false in `held`, with their values. `held` begins at the
    /// first shape that no earlier call has chosen; in the file, `before` shapes precede that one.
    pub(crate) fn keep(&mut self, before: usize, held: &[bool]) {
        let chosen = self.chosen.get_or_insert_default();
        let first = chosen.len();
        chosen.extend(
            (0..held.len())
                .filter(|&at| held[at])
                .map(|at| before + at + 1),
        );
        let columns = self.columns.iter_mut();
        columns.for_each(|column| retain(&mut column.values, first, held));
        retain(&mut self.shapes, first, held);
        if let Some(attributes) = &mut self.attributes {
            retain(&mut attributes.rows, first, held);
        }
    }

    /// Returns the parts of all lines and the rings of all polygons.
    pub fn lines(&self) -> impl Iterator<Item = &[[f64; 3]]> + '_ {
        self.shapes.iter().flat_map(|shape| match shape {
            Shape::Lines(parts) | Shape::Polygon(parts) => parts.iter().map(Vec::as_slice),
            _ => [].iter().map(Vec::as_slice),
        })
    }
}

/// Removes the values that are marked false in `held`, which begins at the value `first`.
fn retain<T>(values: &mut Vec<T>, first: usize, held: &[bool]) {
    let last = values.split_off(first.min(values.len()));
    let kept = last.into_iter().zip(held).filter(|(_, held)| **held);
    values.extend(kept.map(|(value, _)| value));
}

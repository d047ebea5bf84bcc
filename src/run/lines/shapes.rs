//! Lines and polygons from vector layers.

use std::path::Path;

use super::rings;
use crate::data::{Layer, Shape};
use crate::error::{Error, Result, Setting, Wording, wording};
use crate::terrain::Nesting;

/// The rings of a polygon, in plan.
pub(crate) type Rings = Vec<Vec<[f64; 2]>>;

/// A polygon of a layer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Polygon {
    /// The number of its record, counted from 1; that of the first line if it consists of lines.
    pub(crate) record: usize,
    pub(crate) rings: Rings,
}

/// A line of a layer, with its record and part.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Drawn {
    /// The position of its record in the layer.
    pub(crate) at: usize,
    /// The number of its record in the file, counted from 1.
    pub(crate) record: usize,
    /// The number of the part or ring, counted from 1, if there are several.
    pub(crate) part: Option<usize>,
    pub(crate) points: Vec<[f64; 3]>,
}

/// Returns the lines of a layer and the rings of its polygons, each with a height at every vertex.
///
/// # Errors
/// If there are none, a vertex has no height or a coordinate is not finite; the error names the
/// record and the vertex, counted from 1.
pub(crate) fn with_heights(layer: &Layer, path: &Path, setting: Setting) -> Result<Vec<Drawn>> {
    read(layer, path, setting, |parts| {
        check_heights(parts, layer, setting)
    })
}

/// Returns the lines of a layer and the rings of its polygons, with or without heights.
///
/// # Errors
/// If there are none, or a coordinate in plan is not finite.
pub(crate) fn in_plan(layer: &Layer, path: &Path, setting: Setting) -> Result<Vec<Drawn>> {
    read(layer, path, setting, |parts| {
        parts.iter().try_for_each(|part| check_sites(part))
    })
}

fn read(
    layer: &Layer,
    path: &Path,
    setting: Setting,
    check: impl Fn(&[Vec<[f64; 3]>]) -> Result<()>,
) -> Result<Vec<Drawn>> {
    let mut lines = Vec::new();
    for (at, shape) in layer.shapes.iter().enumerate() {
        let record = layer.record(at);
        let parts = match shape {
            Shape::Lines(parts) | Shape::Polygon(parts) => parts,
            Shape::Null | Shape::Points(_) | Shape::Faces(_) => continue,
        };
        check(parts).map_err(|e| at_record(e, path, record))?;
        lines.extend(drawn(parts, at, record));
    }
    // An empty layer is fine, as of a tile without lakes; a layer of points, say, is a mistake.
    if lines.is_empty() && !layer.shapes.is_empty() {
        return Err(no_lines(layer, path, setting));
    }
    Ok(lines)
}

/// Returns the error for a layer without lines.
#[cold]
pub(crate) fn no_lines(layer: &Layer, path: &Path, setting: Setting) -> Error {
    Error::format(format!("{} holds no lines and no polygons", kind_of(layer)))
        .in_file(path)
        .cure(wording![
            setting,
            " takes lines or polygons; points are inputs without an option"
        ])
}

/// Returns the polygons of a layer; its lines, if any, are joined to rings and form one more
/// polygon.
///
/// # Errors
/// If there are none, a coordinate is not finite, or the lines leave a gap.
pub(crate) fn polygons(layer: &Layer, path: &Path, setting: Setting) -> Result<Vec<Polygon>> {
    let (mut polygons, rings) = areas(layer, path, setting)?;
    if let Some(&(record, _)) = rings.first() {
        let rings = rings.into_iter().map(|(_, ring)| ring).collect();
        polygons.push(Polygon { record, rings });
    }
    Ok(polygons)
}

/// Returns the polygons of a layer by their records. Its lines, if any, are joined to rings. Each
/// ring is a polygon, but a ring within a polygon is a hole of it, in which rings are polygons
/// again.
///
/// # Errors
/// Those of [`polygons`]; if a coordinate of a line is so large or small that the arithmetic does
/// not cover it.
pub(crate) fn outlines(layer: &Layer, path: &Path, setting: Setting) -> Result<Vec<Polygon>> {
    let (mut polygons, rings) = areas(layer, path, setting)?;
    let (records, rings): (Vec<usize>, Rings) = rings.into_iter().unzip();
    let around = Nesting::of(&rings).map_err(|e| e.in_file(path))?.around;
    let mut by_depth: Vec<usize> = (0..rings.len()).collect();
    by_depth.sort_by_key(|&ring| around[ring].len());
    let mut depths = vec![0_usize; rings.len()];
    for ring in by_depth {
        let outer = around[ring].iter().map(|&outer| depths[outer] + 1);
        depths[ring] = outer.max().unwrap_or(0);
    }
    let is_hole = |ring: usize| depths[ring] % 2 == 1;
    let mut holes: Vec<Vec<usize>> = vec![Vec::new(); rings.len()];
    for hole in (0..rings.len()).filter(|&ring| is_hole(ring)) {
        let outer = around[hole]
            .iter()
            .filter(|&&ring| depths[ring] + 1 == depths[hole]);
        outer.for_each(|&ring| holes[ring].push(hole));
    }
    for ring in (0..rings.len()).filter(|&ring| !is_hole(ring)) {
        let all = std::iter::once(ring).chain(holes[ring].iter().copied());
        polygons.push(Polygon {
            record: records[ring],
            rings: all.map(|ring| rings[ring].clone()).collect(),
        });
    }
    polygons.sort_by_key(|polygon| polygon.record);
    Ok(polygons)
}

/// The record of the first of some lines, and the ring that they are joined to.
type Joined = (usize, Vec<[f64; 2]>);

/// Returns the polygons of a layer, and its lines joined to rings.
fn areas(layer: &Layer, path: &Path, setting: Setting) -> Result<(Vec<Polygon>, Vec<Joined>)> {
    let mut polygons = Vec::new();
    let mut lines: Vec<Drawn> = Vec::new();
    for (at, shape) in layer.shapes.iter().enumerate() {
        let record = layer.record(at);
        let (Shape::Polygon(parts) | Shape::Lines(parts)) = shape else {
            continue;
        };
        for part in parts {
            check_sites(part).map_err(|e| at_record(e, path, record))?;
        }
        match shape {
            Shape::Polygon(_) => {
                let rings = parts.iter().map(|ring| in_two(ring)).collect();
                polygons.push(Polygon { record, rings });
            }
            _ => lines.extend(drawn(parts, at, record)),
        }
    }
    let flat: Rings = lines.iter().map(|line| in_two(&line.points)).collect();
    let record = |line: usize| lines[line].record;
    let rings =
        rings::close(&flat).map_err(|gap| at_record(gap.error(), path, record(gap.line)))?;
    if polygons.is_empty() && rings.is_empty() {
        return Err(
            Error::format(format!("{} holds no polygons and no lines", kind_of(layer)))
                .in_file(path)
                .cure(wording![setting, " takes polygons, or lines that close"]),
        );
    }
    let rings = rings
        .into_iter()
        .map(|ring| (record(ring.line), ring.points));
    Ok((polygons, rings.collect()))
}

/// Returns points without their heights.
fn in_two(points: &[[f64; 3]]) -> Vec<[f64; 2]> {
    points.iter().map(|&[x, y, _]| [x, y]).collect()
}

/// Returns the parts that are lines, with their numbers.
fn drawn(parts: &[Vec<[f64; 3]>], at: usize, record: usize) -> impl Iterator<Item = Drawn> {
    let is_one_of_many = parts.len() > 1;
    let lines = (1..).zip(parts).filter(|(_, points)| points.len() > 1);
    lines.map(move |(number, points)| Drawn {
        at,
        record,
        part: is_one_of_many.then_some(number),
        points: points.clone(),
    })
}

/// Returns an error if a coordinate in plan is not finite.
fn check_sites(part: &[[f64; 3]]) -> Result<()> {
    match part
        .iter()
        .position(|p| !(p[0].is_finite() && p[1].is_finite()))
    {
        Some(vertex) => Err(not_finite(part, vertex)),
        None => Ok(()),
    }
}

fn check_heights(parts: &[Vec<[f64; 3]>], layer: &Layer, setting: Setting) -> Result<()> {
    let mut vertices = parts.iter().flatten().peekable();
    if vertices.peek().is_some() && vertices.all(|p| p[2].is_nan()) {
        return Err(Error::format("the line has no heights").cure(cure(layer, setting)));
    }
    for part in parts {
        if let Some(vertex) = part
            .iter()
            .position(|p| !p.iter().all(|value| value.is_finite()))
        {
            return Err(not_finite(part, vertex));
        }
    }
    Ok(())
}

fn cure(layer: &Layer, setting: Setting) -> Wording {
    let instead = match setting {
        Setting::Breaklines | Setting::SoftLines => wording![", or use ", Setting::DrapedLines],
        Setting::Flat => wording![", or give it with ", Setting::FlatHeight],
        _ => Wording::default(),
    };
    let attributes = match layer.fields.as_slice() {
        [] => " (this layer has no attributes)".to_owned(),
        fields => format!(" (the attributes are {})", fields.join(", ")),
    };
    let named = setting.text("FILE:FIELD");
    wording![
        "name the attribute with the heights, ",
        named,
        " or FILE:LAYER:FIELD",
        instead,
        attributes
    ]
}

#[cold]
fn not_finite(part: &[[f64; 3]], vertex: usize) -> Error {
    let [x, y, z] = part[vertex];
    let number = vertex + 1;
    if z.is_nan() && x.is_finite() && y.is_finite() {
        return Error::format(format!(
            "vertex {number} at {x} {y} has no height, though others have"
        ))
        .cure("add a height, or remove the record");
    }
    Error::format(format!(
        "vertex {number} at {x} {y} {z}: expected finite coordinates"
    ))
    .cure("repair or remove the record")
}

pub(crate) fn at_record(error: Error, path: &Path, record: usize) -> Error {
    error.in_file(path).at(format!("record {record}"))
}

fn kind_of(layer: &Layer) -> &str {
    match layer.format.as_str() {
        "" => "the layer",
        format => format,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTING: Setting = Setting::Breaklines;

    fn layer(shapes: Vec<Shape>) -> Layer {
        Layer {
            shapes,
            fields: vec!["ELEV".to_owned()],
            ..Layer::default()
        }
    }

    #[test]
    fn polygons_give_their_rings_and_null_shapes_nothing() {
        let ring = vec![
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [0.0, 1.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        let line = vec![[5.0, 5.0, 1.0], [6.0, 5.0, 2.0]];
        let shapes = vec![
            Shape::Polygon(vec![ring.clone()]),
            Shape::Null,
            Shape::Lines(vec![line.clone()]),
        ];
        let drawn = |at, points| Drawn {
            at,
            record: at + 1,
            part: None,
            points,
        };
        assert_eq!(
            with_heights(&layer(shapes), Path::new("l"), SETTING).unwrap(),
            [drawn(0, ring), drawn(2, line)]
        );
    }

    #[test]
    fn parts_are_numbered_where_there_are_several() {
        let part = |y: f64| vec![[0.0, y, 1.0], [1.0, y, 2.0]];
        let shapes = vec![Shape::Lines(vec![part(0.0), vec![], part(1.0)])];
        let lines = with_heights(&layer(shapes), Path::new("l"), SETTING).unwrap();
        assert_eq!(
            lines
                .iter()
                .map(|line| (line.at, line.part))
                .collect::<Vec<_>>(),
            [(0, Some(1)), (0, Some(3))]
        );
    }

    #[test]
    fn lines_without_heights_are_refused_with_the_cure() {
        let flat = vec![[0.0, 0.0, f64::NAN], [1.0, 0.0, f64::NAN]];
        let shapes = vec![Shape::Null, Shape::Lines(vec![flat])];
        let error = with_heights(&layer(shapes), Path::new("l.shp"), SETTING).unwrap_err();
        assert_eq!(
            error.to_string(),
            "l.shp: record 2: the line has no heights"
        );
        let cure = error.cure_text().unwrap().plain();
        assert!(
            cure.contains("FILE:FIELD") && cure.contains("ELEV"),
            "{cure}"
        );
    }

    #[test]
    fn one_missing_height_is_refused_by_record_and_vertex() {
        let line = vec![[0.0, 0.0, 1.0], [1.0, 0.0, f64::NAN]];
        let error = with_heights(
            &layer(vec![Shape::Lines(vec![line])]),
            Path::new("l.shp"),
            SETTING,
        )
        .unwrap_err();
        assert_eq!(
            error.to_string(),
            "l.shp: record 1: vertex 2 at 1 0 has no height, though others have"
        );
    }

    #[test]
    fn a_boundary_with_a_gap_names_the_record() {
        let line = |x: f64| Shape::Lines(vec![vec![[x, 0.0, f64::NAN], [x + 1.0, 0.0, f64::NAN]]]);
        let shapes = vec![line(0.0), Shape::Null, line(2.0)];
        let error = polygons(&layer(shapes), Path::new("l.shp"), SETTING).unwrap_err();
        let text = error.to_string();
        assert!(
            text.starts_with(
                "l.shp: record 1: the lines are not closed: one ends at 0 0, the next"
            ),
            "{text}"
        );
    }

    /// A square at (x, y) as a closed line.
    fn square(x: f64, y: f64, size: f64) -> Vec<[f64; 3]> {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
        let corner = |[u, v]: [f64; 2]| [x + size * u, y + size * v, f64::NAN];
        corners.map(corner).to_vec()
    }

    #[test]
    fn closed_lines_are_outlines_of_their_own_and_lines_within_them_holes() {
        let line = |x, y, size| Shape::Lines(vec![square(x, y, size)]);
        let half = |points: &[[f64; 3]]| Shape::Lines(vec![points.to_vec()]);
        let divided = square(40.0, 0.0, 5.0);
        let layer = layer(vec![
            // An island in a hole, the hole, another one of the same square, and the square.
            line(4.0, 4.0, 1.0),
            line(3.0, 3.0, 3.0),
            line(7.0, 7.0, 2.0),
            line(0.0, 0.0, 10.0),
            // Overlaps the square in part.
            line(8.0, 0.0, 4.0),
            Shape::Polygon(vec![square(20.0, 0.0, 4.0), square(21.0, 1.0, 1.0)]),
            // A ring of two lines.
            half(&divided[2..]),
            half(&divided[..3]),
            // Equal to a line above.
            line(8.0, 0.0, 4.0),
        ]);
        let found = outlines(&layer, Path::new("l"), SETTING).unwrap();
        let found: Vec<(usize, usize)> = found
            .iter()
            .map(|polygon| (polygon.record, polygon.rings.len()))
            .collect();
        assert_eq!(found, [(1, 1), (4, 3), (5, 1), (6, 2), (7, 1), (9, 1)]);
        // A boundary is one polygon of all lines.
        let found = polygons(&layer, Path::new("l"), SETTING).unwrap();
        let records: Vec<usize> = found.iter().map(|polygon| polygon.record).collect();
        assert_eq!(records, [6, 1]);
    }

    #[test]
    fn a_layer_of_the_wrong_kind_is_refused() {
        let points = layer(vec![Shape::Points(vec![[0.0; 3]])]);
        assert!(with_heights(&points, Path::new("p"), SETTING).is_err());
        assert!(in_plan(&points, Path::new("p"), SETTING).is_err());
        assert!(polygons(&points, Path::new("p"), SETTING).is_err());
    }
}

//! Parses the content of one `.shp` record into a shape.

use super::patch::{self, Patch};
use crate::data::Shape;

/// Values below this mean "no data" (ESRI Shapefile Technical Description, 1998, page 2).
pub(super) const NO_DATA: f64 = -1e38;

/// Returns the name of a shape type in the format; `None` for unknown codes.
pub(super) fn type_name(code: i32) -> Option<&'static str> {
    Some(match code {
        0 => "Null",
        1 => "Point",
        3 => "PolyLine",
        5 => "Polygon",
        8 => "MultiPoint",
        11 => "PointZ",
        13 => "PolyLineZ",
        15 => "PolygonZ",
        18 => "MultiPointZ",
        21 => "PointM",
        23 => "PolyLineM",
        25 => "PolygonM",
        28 => "MultiPointM",
        31 => "MultiPatch",
        _ => return None,
    })
}

/// Returns the bytes that a record with a shape of this type has at least, with its header.
pub(super) fn least_bytes(code: i32) -> u64 {
    // The type, then a box, counts, the start of one part, and positions.
    8 + 4
        + match code {
            1 | 11 | 21 => 16,
            8 | 18 | 28 => 32 + 4 + 16,
            3 | 13 | 23 => 32 + 8 + 4 + 2 * 16,
            5 | 15 | 25 => 32 + 8 + 4 + 4 * 16,
            31 => 32 + 8 + 8 + 3 * 16,
            _ => 0,
        }
}

fn has_z(code: i32) -> bool {
    (11..=18).contains(&code) || code == 31
}

/// Why a record yields no shape.
#[derive(Debug)]
pub(super) enum Flaw {
    /// Its counts, indices or type make no sense; the text says which.
    Damaged(String),
    /// A plan coordinate is not finite. The record is well formed, so the value was wrong before it
    /// was written, and other values may be wrong as well.
    NotFinite {
        vertex: usize,
        axis: char,
        value: f64,
    },
}

/// Oddities that do not prevent reading, counted over a file.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(super) struct Oddities {
    /// Rings that were not closed and have been closed.
    pub(super) unclosed: usize,
    /// Parts without vertices, which are dropped.
    pub(super) empty_parts: usize,
    /// Vertices that belong to no part, which are dropped.
    pub(super) loose: usize,
    /// Vertices of Z types whose height is not a number or is "no data".
    pub(super) no_height: usize,
    /// Parts of multipatches whose type is none of the format's, which are dropped.
    pub(super) unknown_parts: usize,
    /// Null shapes with bytes after their type, which are dropped.
    pub(super) full_nulls: usize,
}

/// The content of a record.
#[derive(Debug)]
pub(super) struct Parsed {
    pub(super) code: i32,
    pub(super) shape: Shape,
}

/// Parses the content of a record. The memory used is bounded by its length, whatever its counts
/// state.
pub(super) fn parse(content: &[u8], odd: &mut Oddities) -> Result<Parsed, Flaw> {
    let mut bytes = Bytes(content);
    let code = bytes.int("shape type")?;
    // Counted separately, so that a record that fails halfway changes no count.
    let mut found = *odd;
    let shape = match code {
        0 => {
            found.full_nulls += usize::from(!bytes.0.is_empty());
            Shape::Null
        }
        1 | 11 | 21 => Shape::Points(read_point(&mut bytes, code, &mut found)?),
        8 | 18 | 28 => {
            bytes.take(32, "box")?;
            let count = bytes.count("points")?;
            Shape::Points(read_vertices(&mut bytes, count, code, &mut found)?)
        }
        3 | 13 | 23 => Shape::Lines(read_parts(&mut bytes, code, &mut found)?.0),
        5 | 15 | 25 => {
            let mut rings = read_parts(&mut bytes, code, &mut found)?.0;
            rings.iter_mut().for_each(|ring| close(ring, &mut found));
            Shape::Polygon(rings)
        }
        31 => {
            let (parts, kinds) = read_parts(&mut bytes, code, &mut found)?;
            let Patch {
                faces,
                unclosed,
                unknown,
            } = patch::assemble(parts, &kinds);
            found.unclosed += unclosed;
            found.unknown_parts += unknown;
            Shape::Faces(faces)
        }
        other => {
            return Err(Flaw::Damaged(format!(
                "shape type {other} is not one of the format's"
            )));
        }
    };
    *odd = found;
    Ok(Parsed { code, shape })
}

fn read_point(bytes: &mut Bytes<'_>, code: i32, odd: &mut Oddities) -> Result<Vec<[f64; 3]>, Flaw> {
    // A point has no box and no count, and z directly follows y: as in `read_vertices`, but without
    // the ranges.
    let xy = bytes.take(16, "the point")?;
    let z = if has_z(code) {
        Some(bytes.take(8, "the height")?)
    } else {
        None
    };
    bytes.require_end(1, 8)?;
    gather(xy, z, odd)
}

/// The parts and, for a multipatch, their types.
type Parts = (Vec<Vec<[f64; 3]>>, Vec<i32>);

fn read_parts(bytes: &mut Bytes<'_>, code: i32, odd: &mut Oddities) -> Result<Parts, Flaw> {
    bytes.take(32, "box")?;
    let part_count = bytes.count("parts")?;
    let vertex_count = bytes.count("points")?;
    let starts: Vec<i64> = ints(bytes.take(4 * part_count, &format!("{part_count} part indices"))?)
        .map(i64::from)
        .collect();
    let kinds: Vec<i32> = match code {
        31 => ints(bytes.take(4 * part_count, &format!("{part_count} part types"))?).collect(),
        _ => Vec::new(),
    };
    let vertices = read_vertices(bytes, vertex_count, code, odd)?;

    let mut parts = Vec::with_capacity(part_count);
    let mut kept = Vec::with_capacity(kinds.len());
    let index = |start: i64| usize::try_from(start).ok();
    let first = starts.first().and_then(|&first| index(first));
    odd.loose += first.map_or(vertices.len(), |first| first.min(vertices.len()));
    for (i, &start) in starts.iter().enumerate() {
        let end = starts.get(i + 1).copied().unwrap_or(vertices.len() as i64);
        let range = index(start).zip(index(end));
        let part = range
            .and_then(|(start, end)| vertices.get(start..end))
            .ok_or_else(|| {
                Flaw::Damaged(format!(
                    "part {} holds points {start} to {end} of {}",
                    i + 1,
                    vertices.len()
                ))
            })?;
        if part.is_empty() {
            odd.empty_parts += 1;
            continue;
        }
        parts.push(part.to_vec());
        kept.extend(kinds.get(i));
    }
    Ok((parts, kept))
}

/// Reads `count` vertices: all x and y, then (Z types) the range of z and every z. Measures may
/// follow; they are not kept.
fn read_vertices(
    bytes: &mut Bytes<'_>,
    count: usize,
    code: i32,
    odd: &mut Oddities,
) -> Result<Vec<[f64; 3]>, Flaw> {
    let xy = bytes.take(16 * count, &format!("{count} points"))?;
    let z = match has_z(code) {
        true => {
            bytes.take(16, "range of heights")?;
            Some(bytes.take(8 * count, &format!("{count} heights"))?)
        }
        false => None,
    };
    // The types with heights or measures may have measures at their end.
    bytes.require_end(count, if code > 10 { 16 + 8 * count } else { 0 })?;
    gather(xy, z, odd)
}

fn gather(xy: &[u8], z: Option<&[u8]>, odd: &mut Oddities) -> Result<Vec<[f64; 3]>, Flaw> {
    let mut vertices = Vec::with_capacity(xy.len() / 16);
    let mut heights = z.map(doubles);
    let mut plan = doubles(xy);
    while let (Some(x), Some(y)) = (plan.next(), plan.next()) {
        for (axis, value) in [('x', x), ('y', y)] {
            if !value.is_finite() {
                return Err(Flaw::NotFinite {
                    vertex: vertices.len() + 1,
                    axis,
                    value,
                });
            }
        }
        let z = match &mut heights {
            None => f64::NAN,
            Some(heights) => match heights.next() {
                Some(z) if z.is_finite() && z >= NO_DATA => z,
                _ => {
                    odd.no_height += 1;
                    f64::NAN
                }
            },
        };
        vertices.push([x, y, z]);
    }
    Ok(vertices)
}

fn close(ring: &mut Vec<[f64; 3]>, odd: &mut Oddities) {
    if let (Some(&first), Some(&last)) = (ring.first(), ring.last())
        && first[..2] != last[..2]
    {
        odd.unclosed += 1;
        ring.push(first);
    }
}

fn doubles(bytes: &[u8]) -> impl Iterator<Item = f64> + '_ {
    bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|b| f64::from_le_bytes(*b))
}

fn ints(bytes: &[u8]) -> impl Iterator<Item = i32> + '_ {
    bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|b| i32::from_le_bytes(*b))
}

/// The bytes that have not been read yet.
struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Flaw> {
        match self.0.split_at_checked(count) {
            Some((taken, rest)) => {
                self.0 = rest;
                Ok(taken)
            }
            None => Err(Flaw::Damaged(format!(
                "{what} take {count} bytes, the record has {} left",
                self.0.len()
            ))),
        }
    }

    /// Returns an error if more bytes are left after `count` points than some writers add, unless
    /// they are measures of this length: then the count is wrong.
    fn require_end(&self, count: usize, measures: usize) -> Result<(), Flaw> {
        /// The bytes of a position in plan. Real files have fewer after their last one.
        const POSITION: usize = 16;
        match self.0.len() {
            left if left < POSITION || left == measures => Ok(()),
            left => Err(Flaw::Damaged(format!(
                "{left} bytes are left after its points, which are stated as {count}"
            ))),
        }
    }

    fn int(&mut self, what: &str) -> Result<i32, Flaw> {
        let bytes = self.take(4, what)?;
        Ok(ints(bytes).next().unwrap_or_default())
    }

    /// Reads a count, which must not be negative and must be so small that no product with the size
    /// of an item overflows.
    fn count(&mut self, what: &str) -> Result<usize, Flaw> {
        let count = self.int(what)?;
        usize::try_from(count)
            .ok()
            .filter(|&count| count <= self.0.len())
            .ok_or_else(|| {
                Flaw::Damaged(format!(
                    "{count} {what}, the record has {} bytes left",
                    self.0.len()
                ))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn content(code: i32, parts: &[i32], xy: &[[f64; 2]], tail: &[f64]) -> Vec<u8> {
        let mut bytes = code.to_le_bytes().to_vec();
        bytes.extend([0; 32]);
        let parts = if [8, 18, 28].contains(&code) {
            &[]
        } else {
            parts
        };
        if ![8, 18, 28].contains(&code) {
            bytes.extend((parts.len() as i32).to_le_bytes());
        }
        bytes.extend((xy.len() as i32).to_le_bytes());
        parts.iter().for_each(|p| bytes.extend(p.to_le_bytes()));
        xy.iter()
            .flatten()
            .chain(tail)
            .for_each(|v| bytes.extend(v.to_le_bytes()));
        bytes
    }

    fn read(bytes: &[u8]) -> (Result<Shape, String>, Oddities) {
        let mut odd = Oddities::default();
        let shape = parse(bytes, &mut odd)
            .map(|p| p.shape)
            .map_err(|flaw| format!("{flaw:?}"));
        (shape, odd)
    }

    const SQUARE: [[f64; 2]; 4] = [[0., 0.], [0., 1.], [1., 1.], [1., 0.]];

    #[test]
    fn lines_with_and_without_heights() {
        let (shape, odd) = read(&content(13, &[0, 2], &SQUARE, &[0., 9., 1., 2., 3., 4.]));
        let lines = vec![
            vec![[0., 0., 1.], [0., 1., 2.]],
            vec![[1., 1., 3.], [1., 0., 4.]],
        ];
        assert_eq!(shape.unwrap(), Shape::Lines(lines));
        assert_eq!(odd, Oddities::default());
        // Measures after them change nothing, and flat types have no heights.
        let (shape, _) = read(&content(3, &[0], &SQUARE[..2], &[]));
        assert!(shape.unwrap().vertices().all(|v| v[2].is_nan()));
        let (shape, odd) = read(&content(23, &[0], &SQUARE[..2], &[5., 6., 5., 6.]));
        assert!(shape.unwrap().vertices().all(|v| v[2].is_nan()));
        assert_eq!(odd.no_height, 0);
    }

    #[test]
    fn no_data_is_not_a_height() {
        let (shape, odd) = read(&content(
            18,
            &[],
            &SQUARE,
            &[0., 0., -1e40, f64::NAN, f64::INFINITY, 7.],
        ));
        let heights: Vec<bool> = shape.unwrap().vertices().map(|v| v[2].is_nan()).collect();
        assert_eq!(heights, [true, true, true, false]);
        assert_eq!(odd.no_height, 3);
    }

    #[test]
    fn open_rings_are_closed() {
        let (shape, odd) = read(&content(5, &[0], &SQUARE, &[]));
        let shape = shape.unwrap();
        assert_eq!(shape.vertices().count(), 5);
        assert_eq!(
            shape.vertices().next().unwrap()[..2],
            shape.vertices().last().unwrap()[..2]
        );
        assert_eq!(odd.unclosed, 1);
    }

    #[test]
    fn nothing_and_little() {
        assert_eq!(
            read(&content(3, &[], &[], &[])).0.unwrap(),
            Shape::Lines(vec![])
        );
        let (shape, odd) = read(&content(3, &[], &SQUARE, &[]));
        assert_eq!((shape.unwrap(), odd.loose), (Shape::Lines(vec![]), 4));
        let (shape, odd) = read(&content(3, &[0, 2, 2], &SQUARE, &[]));
        assert!(matches!(shape.unwrap(), Shape::Lines(parts) if parts.len() == 2));
        assert_eq!(odd.empty_parts, 1);
    }

    #[test]
    fn every_cut_is_an_error_and_none_panics() {
        for code in [1, 3, 5, 8, 11, 13, 15, 18, 31] {
            let full = match code {
                1 | 11 => {
                    let mut bytes = i32::to_le_bytes(code).to_vec();
                    bytes.extend([0; 24]);
                    bytes.truncate(if code == 1 { 20 } else { 28 });
                    bytes
                }
                31 => content(code, &[0, 0], &SQUARE[..3], &[0., 0., 1., 2., 3.]),
                _ => {
                    let z: &[f64] = if has_z(code) {
                        &[0., 0., 1., 2., 3., 4.]
                    } else {
                        &[]
                    };
                    content(code, &[0], &SQUARE, z)
                }
            };
            assert!(code == 31 || read(&full).0.is_ok(), "{code}");
            for cut in 0..full.len() {
                assert!(read(&full[..cut]).0.is_err(), "type {code} cut at {cut}");
            }
        }
    }

    #[test]
    fn counts_and_indices_are_not_trusted() {
        let good = content(13, &[0, 2], &SQUARE, &[0., 9., 1., 2., 3., 4.]);
        for (at, value, word) in [
            (36, -1, "-1 parts"),
            (36, i32::MAX, "2147483647 parts"),
            (36, 50, "50 part indices"),
            (40, -5, "-5 points"),
            (40, 1_000_004, "1000004 points"),
            (40, 12, "12 points take 192 bytes"),
            (44, -1, "part 1 holds points -1 to 2 of 4"),
            (48, 5, "part 1 holds points 0 to 5 of 4"),
            (44, 3, "part 1 holds points 3 to 2 of 4"),
            (0, 99, "shape type 99"),
        ] {
            let mut bad = good.clone();
            bad[at..at + 4].copy_from_slice(&i32::to_le_bytes(value));
            let text = read(&bad).0.unwrap_err();
            assert!(text.contains(word), "{text:?} for {word:?}");
        }
    }

    #[test]
    fn plan_coordinates_must_be_numbers() {
        let mut points = SQUARE;
        points[2][1] = f64::INFINITY;
        let text = read(&content(3, &[0], &points, &[])).0.unwrap_err();
        assert_eq!(text, "NotFinite { vertex: 3, axis: 'y', value: inf }");
    }
}

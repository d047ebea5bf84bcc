//! Geometries: a header of GeoPackage, then well-known binary (OGC 06-103r4).

use crate::data::{Bounds, Shape, oriented, polygons};
use crate::error::{Error, Result};
use crate::io::options::layers::check_depth;

/// What heights add to the codes of types.
const WITH_HEIGHTS: u32 = 1000;

const POINT: u32 = 1;
const LINE: u32 = 2;
const POLYGON: u32 = 3;
const MULTI_POINT: u32 = 4;
const MULTI_LINE: u32 = 5;
const MULTI_POLYGON: u32 = 6;
const COLLECTION: u32 = 7;
const POLYHEDRAL_SURFACE: u32 = 15;
const TIN: u32 = 16;
const TRIANGLE: u32 = 17;

/// Adds the shapes of a geometry to a list: one, or one for each member of a collection.
///
/// # Errors
/// If the bytes are not a geometry, or it has arcs.
pub(super) fn read(blob: &[u8], into: &mut Vec<Shape>) -> Result<()> {
    let mut bytes = Bytes { rest: blob };
    let header = bytes.take(4)?;
    let (magic, version, flags) = (&header[..2], header[2], header[3]);
    if magic != b"GP" || version != 0 {
        return Err(Error::format("a geometry that is not of GeoPackage"));
    }
    if flags & 0b10_0000 != 0 {
        return Err(
            Error::unsupported("a geometry of an extension of GeoPackage")
                .cure("save it as points, lines or polygons"),
        );
    }
    let envelope = match (flags >> 1) & 0b111 {
        0 => 0,
        1 => 32,
        2 | 3 => 48,
        4 => 64,
        other => return Err(Error::format(format!("an envelope of the kind {other}"))),
    };
    bytes.take(4 + envelope)?;
    bytes.geometry(0, into)
}

/// The bytes of a geometry that were not read yet.
struct Bytes<'a> {
    rest: &'a [u8],
}

/// How one geometry is stored.
#[derive(Clone, Copy)]
struct Head {
    is_little: bool,
    kind: u32,
    has_heights: bool,
    has_measures: bool,
}

impl Head {
    /// Returns the bytes of a vertex.
    fn vertex(self) -> usize {
        8 * (2 + usize::from(self.has_heights) + usize::from(self.has_measures))
    }
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or_else(|| {
            Error::format(format!(
                "a geometry that ends too early: {count} bytes are needed, {} are left",
                self.rest.len()
            ))
        })?;
        self.rest = rest;
        Ok(taken)
    }

    fn word(&mut self, is_little: bool) -> Result<u32> {
        let bytes: [u8; 4] = self.take(4)?.try_into().unwrap_or_default();
        Ok(match is_little {
            true => u32::from_le_bytes(bytes),
            false => u32::from_be_bytes(bytes),
        })
    }

    /// Returns the number of items, each of which takes at least `size` bytes.
    fn count(&mut self, head: Head, size: usize) -> Result<usize> {
        let count = self.word(head.is_little)? as usize;
        match count.checked_mul(size) {
            Some(bytes) if bytes <= self.rest.len() => Ok(count),
            _ => Err(Error::format(format!(
                "a geometry of {count} parts, in the {} bytes that are left",
                self.rest.len()
            ))),
        }
    }

    fn head(&mut self) -> Result<Head> {
        let is_little = match self.take(1)? {
            [0] => false,
            [1] => true,
            _ => return Err(Error::format("a geometry of an unknown byte order")),
        };
        let code = self.word(is_little)?;
        // PostGIS marks heights, measures and systems by the highest bits.
        if code & 0x2000_0000 != 0 {
            self.word(is_little)?;
        }
        let plain = code & 0x0fff_ffff;
        let dimensions = plain / WITH_HEIGHTS;
        if dimensions > 3 {
            return Err(Error::format(format!("a geometry of the type {code}")));
        }
        Ok(Head {
            is_little,
            kind: plain % WITH_HEIGHTS,
            has_heights: code & 0x8000_0000 != 0 || matches!(dimensions, 1 | 3),
            has_measures: code & 0x4000_0000 != 0 || dimensions >= 2,
        })
    }

    fn vertex(&mut self, head: Head) -> Result<[f64; 3]> {
        let bytes = self.take(head.vertex())?;
        let number = |at: usize| {
            let bytes: [u8; 8] = bytes[8 * at..8 * at + 8].try_into().unwrap_or_default();
            match head.is_little {
                true => f64::from_le_bytes(bytes),
                false => f64::from_be_bytes(bytes),
            }
        };
        let height = if head.has_heights {
            number(2)
        } else {
            f64::NAN
        };
        Ok([number(0), number(1), height])
    }

    fn vertices(&mut self, head: Head) -> Result<Vec<[f64; 3]>> {
        let count = self.count(head, head.vertex())?;
        (0..count).map(|_| self.vertex(head)).collect()
    }

    /// Reads a point; `None` for an empty one, whose coordinates are NaN.
    fn point(&mut self, head: Head) -> Result<Option<[f64; 3]>> {
        let vertex = self.vertex(head)?;
        Ok((!vertex[0].is_nan() || !vertex[1].is_nan()).then_some(vertex))
    }

    /// Reads the rings of one polygon as they are stored.
    fn rings(&mut self, head: Head) -> Result<Vec<Vec<[f64; 3]>>> {
        let count = self.count(head, 4)?;
        let rings = (0..count).map(|_| self.vertices(head));
        let mut rings: Vec<_> = rings.collect::<Result<_>>()?;
        rings.retain(|ring| !ring.is_empty());
        Ok(rings)
    }

    /// Reads the members of a geometry, which are of one kind.
    fn members<T>(
        &mut self,
        head: Head,
        kinds: &[u32],
        mut read: impl FnMut(&mut Self, Head) -> Result<T>,
    ) -> Result<Vec<T>> {
        let count = self.count(head, 5)?;
        let member = |_| {
            let member = self.head()?;
            if !kinds.contains(&member.kind) {
                return Err(Error::format(format!(
                    "a geometry of the type {} with a member of the type {}",
                    head.kind, member.kind
                )));
            }
            read(self, member)
        };
        (0..count).map(member).collect()
    }

    fn geometry(&mut self, depth: usize, into: &mut Vec<Shape>) -> Result<()> {
        check_depth(depth)?;
        let head = self.head()?;
        into.push(match head.kind {
            POINT => Shape::Points(self.point(head)?.into_iter().collect()),
            LINE => Shape::Lines(vec![self.vertices(head)?]),
            POLYGON | TRIANGLE => Shape::Polygon(oriented(self.rings(head)?)),
            MULTI_POINT => {
                let points = self.members(head, &[POINT], Self::point)?;
                Shape::Points(points.into_iter().flatten().collect())
            }
            MULTI_LINE => Shape::Lines(self.members(head, &[LINE], Self::vertices)?),
            MULTI_POLYGON => {
                let polygons = self.members(head, &[POLYGON], Self::rings)?;
                Shape::Polygon(polygons.into_iter().flat_map(oriented).collect())
            }
            POLYHEDRAL_SURFACE | TIN => {
                Shape::of_faces(self.members(head, &[POLYGON, TRIANGLE], Self::rings)?)
            }
            COLLECTION => {
                for _ in 0..self.count(head, 5)? {
                    self.geometry(depth + 1, into)?;
                }
                return Ok(());
            }
            8..=14 => {
                return Err(Error::unsupported("a geometry with arcs").cure(
                    "replace them by lines: ogr2ogr -nlt CONVERT_TO_LINEAR straight.gpkg FILE",
                ));
            }
            kind => return Err(Error::format(format!("a geometry of the type {kind}"))),
        });
        Ok(())
    }
}

/// How the geometries of a layer are written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Form {
    pub(super) kind: Kind,
    /// Whether all are written as geometries of several parts.
    pub(super) is_multiple: bool,
    pub(super) has_heights: bool,
    /// The number of the coordinate system in the file.
    pub(super) system: i32,
}

/// The kinds of geometries that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Point,
    Line,
    Polygon,
    /// Several kinds.
    Any,
}

impl Form {
    /// Returns the name of the type in the table of geometry columns.
    pub(super) fn name(self) -> &'static str {
        match (self.kind, self.is_multiple) {
            (Kind::Any, _) => "GEOMETRY",
            (Kind::Point, false) => "POINT",
            (Kind::Point, true) => "MULTIPOINT",
            (Kind::Line, false) => "LINESTRING",
            (Kind::Line, true) => "MULTILINESTRING",
            (Kind::Polygon, false) => "POLYGON",
            (Kind::Polygon, true) => "MULTIPOLYGON",
        }
    }

    /// Appends a header with an envelope in plan; an empty geometry has none, and a mark.
    fn header(self, bounds: &Bounds, out: &mut Vec<u8>) {
        let Bounds { min, max } = bounds;
        let is_empty = !min[0].is_finite();
        out.extend_from_slice(if is_empty { b"GP\0\x11" } else { b"GP\0\x03" });
        out.extend_from_slice(&self.system.to_le_bytes());
        if is_empty {
            return;
        }
        for number in [min[0], max[0], min[1], max[1]] {
            out.extend_from_slice(&number.to_le_bytes());
        }
    }

    fn head(self, code: u32, out: &mut Vec<u8>) {
        let heights = if self.has_heights { WITH_HEIGHTS } else { 0 };
        out.push(1);
        out.extend_from_slice(&(code + heights).to_le_bytes());
    }

    fn vertex(self, vertex: &[f64; 3], out: &mut Vec<u8>) {
        let count = if self.has_heights { 3 } else { 2 };
        for number in &vertex[..count] {
            out.extend_from_slice(&number.to_le_bytes());
        }
    }

    fn vertices<'a>(
        self,
        vertices: impl ExactSizeIterator<Item = &'a [f64; 3]>,
        out: &mut Vec<u8>,
    ) {
        out.extend_from_slice(&(vertices.len() as u32).to_le_bytes());
        vertices.for_each(|vertex| self.vertex(vertex, out));
    }

    /// Appends a geometry without vertices.
    fn empty(self, code: u32, out: &mut Vec<u8>) {
        self.head(code, out);
        match code {
            POINT => self.vertex(&[f64::NAN; 3], out),
            _ => out.extend_from_slice(&0_u32.to_le_bytes()),
        }
    }

    /// Appends the members of a geometry, or the only one alone.
    fn members<T>(
        self,
        [single, several]: [u32; 2],
        members: &[T],
        out: &mut Vec<u8>,
        write: impl Fn(&T, &mut Vec<u8>),
    ) {
        if members.is_empty() && !self.is_multiple {
            self.empty(single, out);
            return;
        }
        if self.is_multiple || members.len() > 1 {
            self.head(several, out);
            out.extend_from_slice(&(members.len() as u32).to_le_bytes());
        }
        for member in members {
            self.head(single, out);
            write(member, out);
        }
    }

    /// Appends the geometry of a shape with these bounds; false if it has none.
    pub(super) fn write(self, shape: &Shape, bounds: &Bounds, out: &mut Vec<u8>) -> bool {
        match shape {
            Shape::Null => return false,
            Shape::Points(points) => {
                self.header(bounds, out);
                self.members([POINT, MULTI_POINT], points, out, |point, out| {
                    self.vertex(point, out);
                });
            }
            Shape::Lines(parts) => {
                self.header(bounds, out);
                self.members([LINE, MULTI_LINE], parts, out, |part, out| {
                    self.vertices(part.iter(), out);
                });
            }
            Shape::Polygon(rings) => {
                self.header(bounds, out);
                let polygons = polygons(rings);
                self.members([POLYGON, MULTI_POLYGON], &polygons, out, |polygon, out| {
                    out.extend_from_slice(&(polygon.len() as u32).to_le_bytes());
                    for ring in *polygon {
                        self.vertices(ring.iter().rev(), out);
                    }
                });
            }
            Shape::Faces(faces) => {
                self.header(bounds, out);
                self.members([POLYGON, MULTI_POLYGON], faces, out, |face, out| {
                    out.extend_from_slice(&(face.len() as u32).to_le_bytes());
                    face.iter().for_each(|ring| self.vertices(ring.iter(), out));
                });
            }
        }
        true
    }
}

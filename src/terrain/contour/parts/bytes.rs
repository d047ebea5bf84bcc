//! Parts as bytes, little-endian: the heights, a table of the levels, and the parts of each level.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | `MAGIC` |
//! | 16 | the lowest and the highest height |
//! | 8 | the number of levels |
//! | 16 per level | the level, and the number of bytes of its parts |
//! | | the parts of each level |

use super::{ContourParts, LevelParts, LevelSide, LineEnd, NO_HEIGHTS, OpenLine};
use crate::error::{Error, Result};
use std::io::Write;
use std::ops::Range;

const MAGIC: [u8; 8] = *b"blparts2";

/// The bytes before the table.
const HEAD: usize = 8 + 16 + 8;

/// The bytes of a level in the table.
const ENTRY: usize = 16;

/// The levels that there are, and where their parts are.
#[derive(Debug, Clone, PartialEq)]
struct PartsTable {
    heights: [f64; 2],
    /// Each level with the range of its bytes, ascending.
    levels: Vec<(f64, Range<u64>)>,
}

impl PartsTable {
    /// Reads the table of parts; `None` if the bytes are not those that [`ContourParts::write`]
    /// wrote.
    fn read(bytes: &[u8]) -> Option<Self> {
        let (head, rest) = bytes.split_at_checked(HEAD)?;
        let count = u64::from_le_bytes(std::array::from_fn(|i| head[HEAD - 8 + i]));
        let size = usize::try_from(count).ok()?.checked_mul(ENTRY)?;
        let (table, _) = rest.split_at_checked(size)?;
        PartsReader(head).table(table, bytes.len() as u64)
    }
}

/// Parts in bytes, from which one level is read at a time.
pub struct StoredParts<'a> {
    table: PartsTable,
    bytes: &'a [u8],
}

impl<'a> StoredParts<'a> {
    /// Reads the table of levels.
    ///
    /// # Errors
    /// If the bytes are not those that [`ContourParts::write`] wrote.
    pub fn new(bytes: &'a [u8]) -> Result<Self> {
        Ok(StoredParts {
            table: PartsTable::read(bytes).ok_or_else(damaged)?,
            bytes,
        })
    }

    /// Returns the lowest and the highest height of the triangles; without triangles, infinity and
    /// its negative.
    pub fn heights(&self) -> [f64; 2] {
        self.table.heights
    }

    /// Returns the levels that have parts, ascending.
    pub fn levels(&self) -> impl Iterator<Item = f64> {
        self.table.levels.iter().map(|(level, _)| *level)
    }

    /// Reads the parts of a level; `None` if there are none.
    ///
    /// # Errors
    /// If the bytes are damaged.
    pub fn level(&self, level: f64) -> Result<Option<LevelParts>> {
        let levels = &self.table.levels;
        let Ok(at) = levels.binary_search_by(|(own, _)| own.total_cmp(&level)) else {
            return Ok(None);
        };
        let range = &levels[at].1;
        LevelParts::read(level, &self.bytes[range.start as usize..range.end as usize]).map(Some)
    }
}

impl ContourParts {
    /// Writes the parts, a few bytes at a time: `out` should have a buffer.
    ///
    /// A line takes 16 bytes per point, and up to 58 more.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        out.write_all(&MAGIC)?;
        write_point(out, self.heights)?;
        write_count(out, self.levels.len())?;
        for parts in &self.levels {
            out.write_all(&parts.level.to_le_bytes())?;
            let mut length = Length(0);
            parts.write(&mut length)?;
            write_count(out, length.0)?;
        }
        self.levels.iter().try_for_each(|parts| parts.write(out))
    }

    /// Reads all parts.
    ///
    /// # Errors
    /// If the bytes are not those that [`write`](Self::write) wrote.
    pub fn read(bytes: &[u8]) -> Result<Self> {
        let stored = StoredParts::new(bytes)?;
        let levels: Result<_> = stored
            .levels()
            .filter_map(|level| stored.level(level).transpose())
            .collect();
        Ok(ContourParts {
            heights: stored.heights(),
            levels: levels?,
        })
    }
}

impl LevelParts {
    /// Reads the parts of a level from their bytes.
    ///
    /// # Errors
    /// If the bytes are damaged.
    pub fn read(level: f64, bytes: &[u8]) -> Result<Self> {
        PartsReader(bytes)
            .level_parts(level)
            .ok_or_else(|| damaged().at(format!("level {level}")))
    }

    /// Writes the parts of the level, which [`read`](Self::read) reads; `out` should have a buffer.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        out.write_all(&[u8::from(self.touches_vertices)])?;
        write_count(out, self.closed.len())?;
        for points in &self.closed {
            write_points(out, points)?;
        }
        write_count(out, self.open.len())?;
        for line in &self.open {
            line.ends.iter().try_for_each(|end| write_end(out, end))?;
            write_points(out, &line.points)?;
        }
        write_count(out, self.sides.len())?;
        for side in &self.sides {
            side.vertices
                .iter()
                .try_for_each(|&vertex| write_vertex(out, vertex))?;
            side.at.iter().try_for_each(|&at| write_point(out, at))?;
            out.write_all(&[u8::from(side.is_high)])?;
        }
        write_points(out, &self.narrow)
    }
}

/// Counts what is written.
struct Length(usize);

impl Write for Length {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0 += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn write_count(out: &mut impl Write, count: usize) -> std::io::Result<()> {
    out.write_all(&(count as u64).to_le_bytes())
}

fn write_point(out: &mut impl Write, point: [f64; 2]) -> std::io::Result<()> {
    point
        .iter()
        .try_for_each(|x| out.write_all(&x.to_le_bytes()))
}

fn write_points(out: &mut impl Write, points: &[[f64; 2]]) -> std::io::Result<()> {
    write_count(out, points.len())?;
    points.iter().try_for_each(|&point| write_point(out, point))
}

fn write_vertex(out: &mut impl Write, vertex: [u32; 2]) -> std::io::Result<()> {
    vertex
        .iter()
        .try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

fn write_end(out: &mut impl Write, end: &LineEnd) -> std::io::Result<()> {
    match *end {
        LineEnd::Edge(edge) => {
            out.write_all(&[0])?;
            edge.iter()
                .try_for_each(|&vertex| write_vertex(out, vertex))
        }
        LineEnd::Vertex { vertex, toward } => {
            out.write_all(&[1])?;
            write_vertex(out, vertex)?;
            write_point(out, toward)
        }
    }
}

#[cold]
fn damaged() -> Error {
    Error::format("parts of contours are damaged").cure("run the task again that wrote them")
}

/// The bytes that are left to read. `None` if they end early, or have no meaning.
struct PartsReader<'a>(&'a [u8]);

impl<'a> PartsReader<'a> {
    /// The table, from the bytes before it and its own.
    fn table(mut self, table: &[u8], length: u64) -> Option<PartsTable> {
        if self.array()? != MAGIC {
            return None;
        }
        let heights = [self.double()?, self.double()?];
        let mut end = (HEAD + table.len()) as u64;
        let mut levels = Vec::with_capacity(table.len() / ENTRY);
        let mut entries = PartsReader(table);
        while !entries.0.is_empty() {
            let level = entries.double()?;
            let start = end;
            end = start.checked_add(u64::from_le_bytes(entries.array()?))?;
            levels.push((level, start..end));
        }
        let is_ascending = levels.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let is_within = levels
            .iter()
            .all(|(level, _)| heights[0] <= *level && *level <= heights[1]);
        let is_range = heights.iter().all(|height| height.is_finite()) || heights == NO_HEIGHTS;
        (end == length && is_ascending && is_within && is_range)
            .then_some(PartsTable { heights, levels })
    }

    fn level_parts(mut self, level: f64) -> Option<LevelParts> {
        let touches_vertices = self.boolean()?;
        // Of each item, the least number of bytes.
        let closed = self.many(40, |reader| {
            reader
                .points()
                .filter(|points| points.first() == points.last())
        })?;
        let open = self.many(74, Self::open_line)?;
        let sides = self.many(49, Self::side)?;
        let narrow = self.many(16, Self::point)?;
        self.0.is_empty().then_some(LevelParts {
            level,
            touches_vertices,
            closed,
            open,
            sides,
            narrow,
        })
    }

    fn open_line(&mut self) -> Option<OpenLine> {
        let ends = [self.end()?, self.end()?];
        let points = self.points()?;
        let centers = [points[0], points[points.len() - 1]];
        let has_direction = ends.iter().zip(centers).all(|(end, center)| match end {
            LineEnd::Edge(_) => true,
            LineEnd::Vertex { toward, .. } => *toward != center,
        });
        has_direction.then_some(OpenLine { points, ends })
    }

    fn end(&mut self) -> Option<LineEnd> {
        match self.boolean()? {
            false => Some([self.vertex()?, self.vertex()?])
                .filter(|[a, b]| a < b)
                .map(LineEnd::Edge),
            true => Some(LineEnd::Vertex {
                vertex: self.vertex()?,
                toward: self.point()?,
            }),
        }
    }

    fn side(&mut self) -> Option<LevelSide> {
        let vertices = [self.vertex()?, self.vertex()?];
        let at = [self.point()?, self.point()?];
        let is_edge = vertices[0] != vertices[1] && at[0] != at[1];
        Some(LevelSide {
            vertices,
            at,
            is_high: self.boolean()?,
        })
        .filter(|_| is_edge)
    }

    /// The points of a line: at least two.
    fn points(&mut self) -> Option<Vec<[f64; 2]>> {
        self.many(16, Self::point).filter(|points| points.len() > 1)
    }

    fn point(&mut self) -> Option<[f64; 2]> {
        Some([self.double()?, self.double()?]).filter(|point| point.iter().all(|x| x.is_finite()))
    }

    fn vertex(&mut self) -> Option<[u32; 2]> {
        Some([
            u32::from_le_bytes(self.array()?),
            u32::from_le_bytes(self.array()?),
        ])
    }

    /// A count, and as many items.
    fn many<T>(
        &mut self,
        least_size: usize,
        mut one: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<Vec<T>> {
        let count = self.count(least_size)?;
        let mut items = Vec::with_capacity(count);
        for _ in 0..count {
            items.push(one(self)?);
        }
        Some(items)
    }

    /// A count of items for which there are enough bytes.
    fn count(&mut self, least_size: usize) -> Option<usize> {
        let count = usize::try_from(u64::from_le_bytes(self.array()?)).ok()?;
        (count <= self.0.len() / least_size).then_some(count)
    }

    fn boolean(&mut self) -> Option<bool> {
        match self.array()? {
            [0] => Some(false),
            [1] => Some(true),
            _ => None,
        }
    }

    fn double(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(taken)
    }
}

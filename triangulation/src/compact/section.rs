//! Sections: attributes that a program appends to a triangulation.

use std::io::{self, Write};

use super::header::{pad, padded, taken};

/// Bytes of a section before its contents: its tag and their number.
pub(super) const HEAD: u64 = 16;

/// Attributes that a program appends to a [`Compact`](super::Compact) triangulation: marks of its
/// cells, a coordinate system, anything that is bytes.
///
/// Sections follow the triangulation, in any number, each with a tag that the program chooses. The
/// triangulation gives them no meaning and skips those that it is not asked for.
///
/// ```
/// use breakline_triangulation::{geometry::Plane, Compact, CompactSection, Delaunay};
///
/// let plane: Plane = Plane::default();
/// let (t, _) = Delaunay::from_points(plane, &[[0.0, 0.0], [4.0, 0.0], [1.0, 3.0]])?;
/// let mut bytes = Vec::new();
/// t.write_compact(&mut bytes)?;
/// CompactSection { tag: *b"owner   ", contents: b"city of Ulm" }.write(&mut bytes)?;
///
/// let compact = Compact::open(plane, bytes)?;
/// assert_eq!(compact.section(*b"owner   "), Some(&b"city of Ulm"[..]));
/// assert_eq!(compact.section(*b"license "), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CompactSection<'a> {
    /// The name that the section is found by.
    pub tag: [u8; 8],
    /// The bytes that the program stores.
    pub contents: &'a [u8],
}

impl<'a> CompactSection<'a> {
    /// Writes the section. What `out` has received before must be a triangulation, written by
    /// `write_compact`, and any number of other sections.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.tag)?;
        out.write_all(&(self.contents.len() as u64).to_le_bytes())?;
        out.write_all(self.contents)?;
        pad(out, self.contents.len())
    }

    /// Returns the number of bytes in the file, with tag, length and padding.
    pub(super) fn size(&self) -> usize {
        HEAD as usize + self.contents.len().next_multiple_of(8)
    }

    /// Splits bytes into the first section and the rest.
    ///
    /// # Errors
    /// If the section is incomplete: the number of bytes that it should have.
    pub(super) fn split_first(bytes: &'a [u8]) -> Result<(Self, &'a [u8]), u64> {
        let mut rest = bytes;
        let tag = taken(&mut rest);
        let length = u64::from_le_bytes(taken(&mut rest));
        let needed = HEAD
            .checked_add(length)
            .and_then(padded)
            .unwrap_or(u64::MAX);
        match usize::try_from(needed)
            .ok()
            .and_then(|needed| bytes.split_at_checked(needed))
        {
            Some((section, rest)) => {
                let contents = &section[HEAD as usize..][..length as usize];
                Ok((CompactSection { tag, contents }, rest))
            }
            None => Err(needed),
        }
    }
}

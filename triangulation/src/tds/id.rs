use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::num::NonZeroU32;

/// A 32-bit number with a type that says what it numbers. `Option<Id<T>>` has the same size.
pub struct Id<T>(NonZeroU32, PhantomData<fn() -> T>);

/// The tag of vertex numbers.
#[derive(Debug)]
pub enum VertexTag {}

/// The tag of cell numbers.
#[derive(Debug)]
pub enum CellTag {}

/// The number of a vertex.
pub type VertexId = Id<VertexTag>;

/// The number of a cell: a triangle in the plane, a tetrahedron in space; the infinite ones
/// included.
pub type CellId = Id<CellTag>;

impl<T> Id<T> {
    /// The value of slots that the dimension does not use.
    pub(crate) const NONE: Self = Self::reserved(u32::MAX - 1);

    /// The limit of ordinary numbers: all are below it.
    pub const LIMIT: usize = (u32::MAX - 2) as usize;

    const fn reserved(stored: u32) -> Self {
        match NonZeroU32::new(stored) {
            Some(stored) => Id(stored, PhantomData),
            None => unreachable!(),
        }
    }

    /// Returns the id for a position in an array.
    ///
    /// # Panics
    /// If the position is [`LIMIT`](Self::LIMIT) or above.
    #[inline(always)]
    pub fn new(index: usize) -> Self {
        assert!(index < Self::LIMIT, "more than 2^32 - 3 vertices or cells");
        match NonZeroU32::new(index as u32 + 1) {
            Some(stored) => Id(stored, PhantomData),
            None => unreachable!(),
        }
    }

    /// Returns an id with these bits. While a complex is built, other data is stored in place of
    /// ids.
    #[inline(always)]
    pub(crate) fn from_stored(stored: NonZeroU32) -> Self {
        Id(stored, PhantomData)
    }

    /// Returns the bits of an id, see [`from_stored`](Self::from_stored).
    #[inline(always)]
    pub(crate) fn stored(self) -> NonZeroU32 {
        self.0
    }

    /// The position in an array.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0.get() - 1) as usize
    }
}

impl VertexId {
    /// The vertex at infinity, joined to the hull.
    pub const INFINITE: Self = Self::reserved(u32::MAX);
}

// Derived implementations would require the same of `T`.
impl<T> Clone for Id<T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Id<T> {}

impl<T> PartialEq for Id<T> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<T> Eq for Id<T> {}

impl<T> PartialOrd for Id<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Id<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.cmp(&other.0)
    }
}

impl<T> Hash for Id<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.hash(state);
    }
}

impl<T> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.get() {
            u32::MAX => f.write_str("infinite"),
            stored if stored == u32::MAX - 1 => f.write_str("none"),
            stored => write!(f, "{}", stored - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_free() {
        assert_eq!(size_of::<Option<CellId>>(), 4);
        assert_eq!(size_of::<crate::tds::Links<3>>(), 24);
        assert_eq!(size_of::<crate::tds::Links<4>>(), 32);
    }
}

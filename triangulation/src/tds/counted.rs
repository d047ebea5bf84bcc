//! Iterators that know how many items are left.

/// An iterator with a known number of remaining items.
struct Counted<I> {
    items: I,
    left: usize,
}

impl<I: Iterator> Iterator for Counted<I> {
    type Item = I::Item;

    #[inline]
    fn next(&mut self) -> Option<I::Item> {
        let item = self.items.next()?;
        self.left -= 1;
        Some(item)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Iterator> ExactSizeIterator for Counted<I> {}

/// Returns an iterator with a known number of items.
pub(super) fn counted<I: Iterator>(
    items: I,
    left: usize,
) -> impl ExactSizeIterator<Item = I::Item> {
    Counted { items, left }
}

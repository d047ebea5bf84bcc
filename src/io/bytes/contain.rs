//! Turns panics of decoders into errors.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `decode` and returns its result, or `None` if it panicked.
///
/// Decoders from other crates may index tables with the values that they decode. A panic hook can
/// ask [`is_contained`] and print nothing then. After `None`, discard whatever `decode` was writing
/// to.
pub(crate) fn contain<T>(decode: impl FnOnce() -> T) -> Option<T> {
    let before = CONTAINED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(decode));
    CONTAINED.set(before);
    result.ok()
}

/// Returns true while the calling thread runs a decoder of another crate whose panic becomes an
/// error: a program's panic hook need not print it. The library installs no hook.
///
/// ```
/// let print = std::panic::take_hook();
/// std::panic::set_hook(Box::new(move |panic| {
///     if !breakline::io::is_contained() {
///         print(panic);
///     }
/// }));
/// ```
pub fn is_contained() -> bool {
    CONTAINED.get()
}

#[cfg(test)]
mod tests {
    use super::{contain, is_contained};

    #[test]
    fn a_panic_ends_at_the_fence() {
        assert_eq!(contain(|| 1), Some(1));
        assert_eq!((contain(is_contained), is_contained()), (Some(true), false));
        let empty: Vec<u8> = Vec::new();
        assert_eq!(contain(|| empty[std::hint::black_box(3)]), None);
        assert!(std::panic::catch_unwind(|| panic!("this one is printed")).is_err());
    }
}

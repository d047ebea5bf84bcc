//! Turns panics of decoders into errors.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `decode` and returns its result, or `None` if it panicked.
///
/// Decoders from other crates may index tables with the values that they decode. The message of
/// such a panic is suppressed, on the calling thread only: the first use installs a hook in front
/// of the current one, which still receives every other panic. After `None`, discard whatever
/// `decode` was writing to.
pub(crate) fn contain<T>(decode: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let previous = take_hook();
        set_hook(Box::new(move |panic| {
            if !CONTAINED.get() {
                previous(panic);
            }
        }));
    });
    let before = CONTAINED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(decode));
    CONTAINED.set(before);
    result.ok()
}

#[cfg(test)]
mod tests {
    use super::contain;

    #[test]
    fn a_panic_ends_at_the_fence() {
        assert_eq!(contain(|| 1), Some(1));
        let empty: Vec<u8> = Vec::new();
        assert_eq!(contain(|| empty[std::hint::black_box(3)]), None);
        assert!(std::panic::catch_unwind(|| panic!("this one is printed")).is_err());
    }
}

//! Keeps a panic of a decoder from becoming a panic of the program.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `decode`; `None` if it panicked.
///
/// Decoders from other crates may index tables by what they decode. The message that a panic prints
/// is held back for the calling thread alone: the first use puts a hook before the one in place, and
/// that hook still gets every other panic. What `decode` was writing to is to be thrown away when
/// this returns `None`.
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

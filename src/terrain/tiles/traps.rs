//! Rules that tests can switch off, one by one, to see that they would notice. Without tests all
//! rules hold, at no cost.

/// A rule without which tiles are wrong or wasteful, and which tests cannot break from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rule {
    /// Disks are enlarged by a bound of their error.
    DiskBound,
    /// Triangles wait for a pending sub-constraint that runs along their edge.
    AlongEdges,
    /// Only the part of a disk that is visible past constraints has to lie in the tile.
    VisiblePart,
}

/// Returns true if a test has switched a rule off.
#[cfg(not(test))]
pub(super) const fn is_off(_: Rule) -> bool {
    false
}

#[cfg(test)]
pub(super) use switch::{is_off, without};

#[cfg(test)]
mod switch {
    use std::cell::Cell;

    use super::Rule;

    thread_local! {
        static OFF: Cell<Option<Rule>> = const { Cell::new(None) };
    }

    pub(crate) fn is_off(rule: Rule) -> bool {
        OFF.get() == Some(rule)
    }

    /// Calls a function while a rule is switched off in this thread.
    pub(crate) fn without<T>(rule: Rule, call: impl FnOnce() -> T) -> T {
        OFF.set(Some(rule));
        let _on_again = OnAgain;
        call()
    }

    /// Switches all rules on when it is dropped, also by a test that fails.
    struct OnAgain;

    impl Drop for OnAgain {
        fn drop(&mut self) {
            OFF.set(None);
        }
    }
}

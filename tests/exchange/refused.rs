//! Texts that are refused.

use std::fmt::{Debug, Display};

/// Asserts that a text is refused with each of several changes, given as `(from, to, said)`: the
/// error names the file and says `said`.
pub(crate) fn with_each_change<T: Debug, E: Display>(
    text: &str,
    file: &str,
    read: impl Fn(&str) -> Result<T, E>,
    changes: &[(&str, &str, &str)],
) {
    for (from, to, said) in changes {
        assert!(text.contains(from), "{from}");
        let error = match read(&text.replacen(from, to, 1)) {
            Ok(read) => panic!("{said}, but this was read: {read:?}"),
            Err(error) => error.to_string(),
        };
        assert!(
            error.contains(file) && error.contains(said),
            "{said} is not in {error}"
        );
    }
}

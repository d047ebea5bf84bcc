//! Names that users type.

/// Returns the position of a name: as written, else in any case.
pub(crate) fn named<'a>(
    names: impl Iterator<Item = &'a str> + Clone,
    wanted: &str,
) -> Option<usize> {
    let exact = names.clone().position(|name| name == wanted);
    exact.or_else(|| {
        names
            .clone()
            .position(|name| name.eq_ignore_ascii_case(wanted))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_as_written_else_in_any_case() {
        let found = |wanted| named(["Z", "Name", "z", "NAME"].into_iter(), wanted);
        let expected = [Some(2), Some(0), Some(3), Some(1), None];
        assert_eq!(["z", "Z", "NAME", "name", "nam"].map(found), expected);
    }
}

//! The known name that was probably meant.

use strsim::osa_distance;

/// Returns the known name that differs in the fewest letters, if these are at most a third of the
/// letters of `name`. Two swapped letters count as one.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let most = name.chars().count().div_ceil(3);
    let name = name.replace('_', "-");
    known
        .map(|known| (osa_distance(&name, known), known))
        .filter(|(distance, _)| *distance <= most)
        .min()
        .map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_others_are_not() {
        let known = || ["resolution", "te", "align-to", "overviews"].into_iter();
        assert_eq!(nearest("resoluton", known()), Some("resolution"));
        assert_eq!(nearest("align_too", known()), Some("align-to"));
        assert_eq!(nearest("tee", known()), Some("te"));
        assert_eq!(nearest("interval", known()), None);
        assert_eq!(nearest("dme", ["drape", "dem"].into_iter()), Some("dem"));
    }
}

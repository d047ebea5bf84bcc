//! The known name that was probably meant.

/// Returns the known name that is most like a name, if one is alike.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let most = name.chars().count().div_ceil(3);
    let name = name.replace('_', "-");
    known
        .map(|known| (distance(&name, known), known))
        .filter(|(distance, _)| *distance <= most)
        .min()
        .map(|(_, known)| known)
}

/// Returns how many letters have to be inserted, removed, replaced or swapped with the next
/// (Levenshtein's distance with swaps, each letter moved once).
fn distance(from: &str, to: &str) -> usize {
    let [from, to] = [from, to].map(|text| text.chars().collect::<Vec<char>>());
    let mut rows: Vec<Vec<usize>> = vec![(0..=to.len()).collect()];
    for (i, letter) in from.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, other) in to.iter().enumerate() {
            let replaced = rows[i][j] + usize::from(letter != other);
            let least = replaced.min(rows[i][j + 1] + 1).min(row[j] + 1);
            let is_swapped = i > 0 && j > 0 && from[i - 1] == *other && to[j - 1] == *letter;
            row.push(match is_swapped {
                true => least.min(rows[i - 1][j - 1] + 1),
                false => least,
            });
        }
        rows.push(row);
    }
    rows[from.len()][to.len()]
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
        for (from, to, expected) in [
            ("", "", 0),
            ("", "ab", 2),
            ("kitten", "sitting", 3),
            ("dme", "dem", 1),
        ] {
            assert_eq!(distance(from, to), expected);
            assert_eq!(distance(to, from), expected);
        }
    }
}

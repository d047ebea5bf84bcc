//! Triangle's switches, as its users type them: several in one word, numbers right behind the letters.

use std::ffi::OsString;

/// Writes the words for `triangulate` that are made of Triangle's switches `p`, `q`, `a`, `c` and `S` only, like
/// `-pq30a0.5S9000`, as the options that they mean. `-p` says nothing that the name of the file does not.
pub(in crate::cli) fn expand_switches(args: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut is_verb = false;
    let mut is_over = false;
    let mut expanded = Vec::new();
    for arg in args {
        is_over |= arg == "--";
        let options = if is_verb && !is_over { arg.to_str().and_then(options_of) } else { None };
        is_verb |= arg == "triangulate";
        match options {
            Some(options) => expanded.extend(options.into_iter().map(OsString::from)),
            None => expanded.push(arg),
        }
    }
    expanded
}

/// What a word of switches means; `None` if it is something else.
fn options_of(word: &str) -> Option<Vec<String>> {
    let mut rest = word.strip_prefix('-').filter(|rest| !rest.is_empty())?;
    let mut options = Vec::new();
    while let Some(switch) = rest.chars().next() {
        let behind = &rest[switch.len_utf8()..];
        let length = behind.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(behind.len());
        let (number, after) = behind.split_at(length);
        match (switch, number) {
            ('p', "") => {}
            ('c', "") => options.push("--convex".to_owned()),
            ('q', "") => options.push("--min-angle=20".to_owned()),
            ('a', "") => options.push("--region-areas".to_owned()),
            ('S', "") => options.push("--max-added=0".to_owned()),
            ('S', number) => options.push(format!("--max-added={number}")),
            ('q', number) => options.push(format!("--min-angle={number}")),
            ('a', number) => options.push(format!("--max-area={number}")),
            _ => return None,
        }
        rest = after;
    }
    Some(options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_switches_are_told_from_others() {
        let expand = |text: &str| {
            let words = expand_switches(text.split(' ').map(OsString::from));
            words.iter().map(|word| word.to_str().unwrap()).collect::<Vec<_>>().join(" ")
        };
        for (typed, meant) in [
            ("b triangulate -pq30a0.5 x.poly", "b triangulate --min-angle=30 --max-area=0.5 x.poly"),
            ("b triangulate -q x.poly -c -a", "b triangulate --min-angle=20 x.poly --convex --region-areas"),
            ("b triangulate -p x.poly -o a.ele", "b triangulate x.poly -o a.ele"),
            ("b triangulate -pq30S500 x.poly -S", "b triangulate --min-angle=30 --max-added=500 x.poly --max-added=0"),
            ("b triangulate -s9 x.poly", "b triangulate -s9 x.poly"),
            ("b triangulate -v -qv -z --convex -q1.", "b triangulate -v -qv -z --convex --min-angle=1."),
            ("b triangulate - -- -q", "b triangulate - -- -q"),
            ("b tin -q x.las", "b tin -q x.las"),
        ] {
            assert_eq!(expand(typed), meant);
        }
    }
}

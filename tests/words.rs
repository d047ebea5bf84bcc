//! The words of the project: one term for each thing, as the glossary in `docs/architecture.md` has
//! it.
//!
//! The glossary is read: no identifier and no name of a file contains a word of its last column, in
//! any form that ends with `s`, `d` or neither, and no comment, message or page contains a phrase of
//! the list below it. Comments are no wider than 100 characters, so that they can be read beside
//! code. Pages and comments refer to what exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Where identifiers and comments are judged.
const SOURCES: [&str; 10] = [
    "fuzz/src",
    "src",
    "python/src",
    "tests",
    "benches",
    "examples",
    "testkit/src",
    "triangulation/src",
    "triangulation/tests",
    "triangulation/examples",
];

/// The pages that are judged.
const PAGES: [&str; 7] = [
    "README.md",
    "CHANGELOG.md",
    "docs",
    "python/README.md",
    "triangulation/README.md",
    "triangulation/docs",
    "fixtures",
];

/// The decisions, and the page that lists them.
const DECISIONS: &str = "docs/decisions";
const INDEX: &str = "docs/decisions/README.md";

/// The widest comment, indentation included.
const WIDTH: usize = 100;

/// Names of tests may be sentences: from so many words on, a name is one.
const SENTENCE: usize = 5;

/// Names that other crates have given.
const OF_OTHERS: [&str; 1] = ["in_place_scope"];

/// What the glossary forbids.
struct Rules {
    /// In names, in lower case, with their plurals and other forms.
    words: BTreeSet<String>,
    /// In prose, in lower case.
    phrases: Vec<String>,
}

/// A stretch of source text.
#[derive(Debug, PartialEq, Eq, Clone, Copy)]
enum Token<'a> {
    Identifier(&'a str),
    Comment(&'a str),
    Text(&'a str),
}

#[test]
fn identifiers_are_made_of_the_words_of_the_glossary() {
    let rules = rules();
    let faults = each_source(|path, text| {
        let sentences = names_of_tests(text);
        let identifiers: BTreeSet<&str> = tokens(text)
            .into_iter()
            .filter_map(|token| match token {
                Token::Identifier(name)
                    if !sentences.contains(name) && !OF_OTHERS.contains(&name) =>
                {
                    Some(name)
                }
                _ => None,
            })
            .collect();
        let bad = identifiers.into_iter().filter_map(|name| {
            let word = rules.forbidden_in(name)?;
            Some(format!("{}: `{name}` contains `{word}`", path.display()))
        });
        bad.collect()
    });
    assert!(
        faults.is_empty(),
        "see the glossary in docs/architecture.md\n{}",
        faults.join("\n")
    );
}

#[test]
fn file_names_are_made_of_the_words_of_the_glossary() {
    let rules = rules();
    let folders =
        SOURCES
            .iter()
            .chain(&PAGES)
            .chain(&["python/package", "python/tests", "python/benches"]);
    let mut faults: Vec<_> = folders
        .flat_map(|folder| files(Path::new(folder)))
        .filter_map(|path| {
            let word = path
                .components()
                .find_map(|name| rules.forbidden_in(name.as_os_str().to_str()?))?;
            Some(format!("{} contains `{word}`", path.display()))
        })
        .collect();
    faults.dedup();
    assert!(
        faults.is_empty(),
        "see the glossary in docs/architecture.md\n{}",
        faults.join("\n")
    );
}

#[test]
fn prose_uses_no_listed_phrase() {
    let rules = rules();
    let mut faults = each_source(|path, text| {
        let prose = tokens(text).into_iter().filter_map(|token| match token {
            Token::Comment(prose) | Token::Text(prose) => Some(prose),
            Token::Identifier(_) => None,
        });
        let prose = prose.collect::<Vec<_>>().join("\n");
        phrases_in(&prose, &rules)
            .map(|phrase| format!("{}: \"{phrase}\"", path.display()))
            .collect()
    });
    for (path, text) in pages() {
        // The list itself stands in one of the pages, up to the next heading.
        let (before, list) = text.split_once(PHRASES).unwrap_or((&text, ""));
        let after = list.split_once("\n## ").map_or("", |(_, after)| after);
        let found = [before, after]
            .into_iter()
            .flat_map(|text| phrases_in(text, &rules).collect::<Vec<_>>());
        faults.extend(found.map(|phrase| format!("{}: \"{phrase}\"", path.display())));
    }
    assert!(
        faults.is_empty(),
        "see the list in docs/architecture.md\n{}",
        faults.join("\n")
    );
}

/// Links of pages lead to files; decisions and comments name paths of the repository that exist.
#[test]
fn pages_and_comments_refer_to_what_exists() {
    let mut faults = Vec::new();
    for (path, text) in pages() {
        let folder = path.parent().unwrap();
        let links = links_in(&text).map(|target| folder.join(target));
        let named = paths_in(&text)
            .filter(|_| path.starts_with(DECISIONS))
            .map(PathBuf::from);
        let missing = links
            .chain(named)
            .filter(|target| !root().join(target).exists());
        faults.extend(missing.map(|target| format!("{}: {}", path.display(), target.display())));
    }
    let index = fs::read_to_string(root().join(INDEX)).unwrap();
    let listed: BTreeSet<&str> = links_in(&index).collect();
    let decisions = files_with(Path::new(DECISIONS), "md");
    let names = decisions
        .iter()
        .filter_map(|path| path.file_name()?.to_str());
    faults.extend(
        names
            .filter(|&name| name != "README.md" && !listed.contains(name))
            .map(|name| format!("{INDEX} does not list {name}")),
    );
    // Comments of a crate may name its own folders.
    faults.extend(each_source(|path, text| {
        let own = path
            .ancestors()
            .find(|folder| root().join(folder).join("Cargo.toml").exists())
            .unwrap();
        let exists =
            |named: &str| root().join(named).exists() || root().join(own).join(named).exists();
        let comments = tokens(text).into_iter().filter_map(|token| match token {
            Token::Comment(comment) => Some(comment),
            _ => None,
        });
        let missing = comments.flat_map(paths_in).filter(|named| !exists(named));
        missing
            .map(|named| format!("{}: {named}", path.display()))
            .collect()
    }));
    assert!(
        faults.is_empty(),
        "these do not exist:\n{}",
        faults.join("\n")
    );
}

/// The targets of the relative links of a page, without what follows a `#`.
fn links_in(text: &str) -> impl Iterator<Item = &str> {
    let targets = text
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split_once(')'));
    let relative = targets.filter(|(target, _)| !target.contains([':', ' ', '\n']));
    relative
        .filter_map(|(target, _)| target.split('#').next())
        .filter(|file| !file.is_empty())
}

/// The paths of the repository that a page names, in code.
fn paths_in(text: &str) -> impl Iterator<Item = &str> {
    let code = text
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|code| !code.contains([' ', '\n', ':']));
    code.filter(|code| {
        code.split_once('/')
            .is_some_and(|(first, _)| !first.is_empty() && root().join(first).is_dir())
    })
}

#[test]
fn links_and_paths_of_pages_are_found() {
    let links: Vec<_> =
        links_in("[a](b.md#c), [d](#e), ![f](g/h.png) and [i](https://j.k).").collect();
    assert_eq!(links, ["b.md", "g/h.png"]);
    let paths: Vec<_> =
        paths_in("`src/main.rs`, `1/2`, `src/a b`, `/src/c`, `src` and `tests/none`.").collect();
    assert_eq!(paths, ["src/main.rs", "tests/none"]);
}

/// What is typed on a command line is known in `src/cli` alone: below, texts mention it as data.
#[test]
fn texts_below_the_command_line_name_no_option() {
    let faults = each_source(|path, text| {
        let is_below = path.starts_with("src") && !path.starts_with("src/cli")
            || path.starts_with("python/src");
        let texts = tokens(text).into_iter().filter_map(|token| match token {
            Token::Text(text) if is_below && names_option(text) => Some(text),
            _ => None,
        });
        texts
            .map(|text| format!("{}: {text}", path.display()))
            .collect()
    });
    assert!(
        faults.is_empty(),
        "see `error::Wording`\n{}",
        faults.join("\n")
    );
}

/// Returns true if a text has an option or a command of the program.
fn names_option(text: &str) -> bool {
    let has_option = text.match_indices("--").any(|(at, _)| {
        let is_begin = !text[..at].ends_with('-');
        is_begin && text[at + 2..].starts_with(|c: char| c.is_ascii_alphanumeric())
    });
    has_option || text.contains("`breakline ")
}

#[test]
fn options_in_texts_are_found() {
    for text in ["use --max-edge", "--3d", "`breakline info` shows it"] {
        assert!(names_option(text), "{text}");
    }
    for text in [
        "a -- b",
        "---",
        "1--",
        "5 - -x",
        "`info`",
        "-----BEGIN",
        "--",
    ] {
        assert!(!names_option(text), "{text}");
    }
}

#[test]
fn comments_are_no_wider_than_a_hundred() {
    let faults = each_source(|path, text| {
        let mut is_example = false;
        let mut wide = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            let Some(comment) = line.trim_start().strip_prefix("//") else {
                continue;
            };
            let comment = comment.trim_start_matches(['/', '!']);
            is_example ^= comment.trim_start().starts_with("```");
            // Rows of tables, formulas, examples and addresses cannot be broken.
            let is_whole = ["     ", " |"]
                .iter()
                .any(|start| comment.starts_with(start))
                || comment.contains("://");
            if line.chars().count() > WIDTH && !is_example && !is_whole {
                wide.push(format!("{}:{number}", path.display()));
            }
        }
        wide
    });
    assert!(
        faults.is_empty(),
        "comments wider than {WIDTH}:\n{}",
        faults.join("\n")
    );
}

/// A heading in a comment that goes on in the same line is no heading of the page.
#[test]
fn headings_of_comments_stand_alone() {
    let names = ["Errors", "Complexity", "Panics"];
    let goes_on = |line: &str| {
        let heading = line
            .trim_start()
            .trim_start_matches(['/', '!'])
            .trim_start()
            .strip_prefix("# ");
        heading.is_some_and(|text| {
            names
                .iter()
                .any(|name| text.starts_with(name) && text.trim_end() != *name)
        })
    };
    assert!(goes_on("/// # Errors If it fails.") && !goes_on("    //! # Errors"));
    let faults = each_source(|path, text| {
        let lines = (1..).zip(text.lines()).filter(|(_, line)| goes_on(line));
        lines
            .map(|(number, _)| format!("{}:{number}", path.display()))
            .collect()
    });
    assert!(
        faults.is_empty(),
        "headings that go on in the same line:\n{}",
        faults.join("\n")
    );
}

#[test]
fn the_rules_can_fail() {
    assert_eq!(words_of("is_wallUp2"), ["is", "wall", "up"]);
    assert_eq!(words_of("HTTPServer"), ["http", "server"]);
    assert_eq!(words_of("replace_LAST_PLACE"), ["replace", "last", "place"]);
    let text = "let a = \"b \\\" // c\"; // d\nr#\"e\"f\"# 'g' 'h /* i /* j */ k */ b'l'";
    let expected = [
        Token::Identifier("let"),
        Token::Identifier("a"),
        Token::Text("b \\\" // c"),
        Token::Comment("// d"),
        Token::Text("e\"f"),
        Token::Identifier("h"),
        Token::Comment("/* i /* j */ k */"),
    ];
    assert_eq!(tokens(text), expected);
    let rules = rules();
    assert!(
        rules.words.contains("walled") && rules.words.len() > 10,
        "{:?}",
        rules.words
    );
    for name in [
        "place",
        "LAST_PLACES",
        "wishes",
        "isTidied",
        "settles.rs",
        "one_long_name_of_many_ways",
        "claimed",
    ] {
        assert!(rules.forbidden_in(name).is_some(), "{name}");
    }
    for name in [
        "replace",
        "leader",
        "walls",
        "always",
        "crossings",
        "one_long_name_of_many_lines",
    ] {
        assert_eq!(rules.forbidden_in(name), None, "{name}");
    }
    let tests = "#[test]\n#[ignore]\nfn all_is_in_its_place() {}\nfn nothing_is_in_its_place() {}\n#[test]\nfn a_place() {}";
    assert_eq!(
        Vec::from_iter(names_of_tests(tests)),
        ["all_is_in_its_place"]
    );
    assert!(rules.phrases.len() > 10, "{:?}", rules.phrases);
    let found = |text: &str| phrases_in(text, &rules).next().map(str::to_owned);
    assert_eq!(
        found("/// One is\n    /// told, at the\n/// most.").as_deref(),
        Some("at the most")
    );
    assert_eq!(found("at most"), None);
}

/// The heading of the list of phrases.
const PHRASES: &str = "### In prose";

/// The rules, read from the glossary: the last column of its table, and the list of phrases.
fn rules() -> Rules {
    let page = fs::read_to_string(root().join("docs/architecture.md")).unwrap();
    let (_, glossary) = page.split_once("## Glossary").expect("a glossary");
    let glossary = glossary.split("\n## ").next().unwrap();
    let (table, list) = glossary.split_once(PHRASES).expect("a list of phrases");
    let rows = table.lines().filter(|line| line.starts_with("| ")).skip(1);
    let last = rows.filter_map(|row| row.trim_end_matches('|').rsplit('|').next());
    let words = last
        .flat_map(|cell| cell.split(','))
        .map(str::trim)
        .filter(|word| !word.is_empty());
    let words = words.flat_map(forms_of);
    let phrases = list
        .lines()
        .filter_map(|line| line.strip_prefix("- \""))
        .filter_map(|line| line.split('"').next());
    Rules {
        words: words.collect(),
        phrases: phrases.map(str::to_owned).collect(),
    }
}

/// A word, its plural or third person, and its past. Its form with `ing` is not forbidden: zeros are
/// leading.
fn forms_of(word: &str) -> impl Iterator<Item = String> + '_ {
    let stem = word.strip_suffix('y').map(|stem| format!("{stem}i"));
    let stem = stem.unwrap_or_else(|| word.to_owned());
    let regular = ["", "s", "es", "d", "ed"]
        .into_iter()
        .map(move |ending| format!("{word}{ending}"));
    regular.chain(
        ["es", "ed"]
            .into_iter()
            .map(move |ending| format!("{stem}{ending}")),
    )
}

impl Rules {
    /// The word of a name that the glossary forbids.
    fn forbidden_in(&self, name: &str) -> Option<String> {
        words_of(name)
            .into_iter()
            .find(|word| self.words.contains(word))
    }
}

/// The names of tests in a source that are sentences.
fn names_of_tests(text: &str) -> BTreeSet<&str> {
    let names = text
        .split("#[test]")
        .skip(1)
        .filter_map(|rest| rest.split_once("fn ")?.1.split('(').next());
    names
        .filter(|name| words_of(name).len() >= SENTENCE)
        .collect()
}

/// The phrases that a text contains, whatever its lines and its letters' case.
fn phrases_in<'a>(text: &str, rules: &'a Rules) -> impl Iterator<Item = &'a str> {
    let plain: String = text
        .split_whitespace()
        .map(|word| word.trim_start_matches(['/', '!']))
        .filter(|word| !word.is_empty())
        .flat_map(|word| [" ", word])
        .collect::<String>()
        .to_lowercase();
    let is_there = move |phrase: &&String| {
        plain.match_indices(phrase.as_str()).any(|(at, _)| {
            let before = plain[..at].chars().next_back();
            let after = plain[at + phrase.len()..].chars().next();
            [before, after]
                .into_iter()
                .flatten()
                .all(|letter| !letter.is_alphanumeric())
        })
    };
    rules.phrases.iter().filter(is_there).map(String::as_str)
}

/// The words of an identifier, in lower case.
fn words_of(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let letters: Vec<char> = name.chars().collect();
    for (i, &letter) in letters.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| letters[i]);
        let starts = match before {
            None => true,
            Some(before) if letter.is_uppercase() && before.is_alphabetic() => {
                before.is_lowercase()
                    || letters.get(i + 1).is_some_and(|after| after.is_lowercase())
            }
            Some(before) => !before.is_alphabetic(),
        };
        if !letter.is_alphabetic() {
            continue;
        }
        match words.last_mut() {
            Some(word) if !starts => word.extend(letter.to_lowercase()),
            _ => words.push(letter.to_lowercase().collect()),
        }
    }
    words
}

/// The identifiers, comments and texts of a source, in order; numbers, letters and signs are left
/// out.
fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let taken = if rest.starts_with("//") {
            let end = rest.find('\n').unwrap_or(rest.len());
            tokens.push(Token::Comment(&rest[..end]));
            end
        } else if rest.starts_with("/*") {
            let end = end_of_block(rest);
            tokens.push(Token::Comment(&rest[..end]));
            end
        } else if let Some((open, close)) = raw_marks(rest) {
            let end = open + rest[open..].find(&close).unwrap_or(rest.len() - open);
            tokens.push(Token::Text(&rest[open..end]));
            (end + close.len()).min(rest.len())
        } else if first == '"' {
            let end = 1 + end_of_string(&rest[1..]);
            tokens.push(Token::Text(&rest[1..end]));
            (end + 1).min(rest.len())
        } else if first == '\'' {
            end_of_letter(rest)
        } else if first.is_alphabetic() || first == '_' {
            let end = rest
                .find(|c: char| !c.is_alphanumeric() && c != '_')
                .unwrap_or(rest.len());
            let is_prefix =
                matches!(&rest[..end], "b" | "c") && rest[end..].starts_with(['"', '\'']);
            if !is_prefix {
                tokens.push(Token::Identifier(&rest[..end]));
            }
            end
        } else if first.is_numeric() {
            rest.find(|c: char| !c.is_alphanumeric() && c != '_')
                .unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        rest = &rest[taken..];
    }
    tokens
}

/// Where the text of a raw string starts, and what ends it.
fn raw_marks(rest: &str) -> Option<(usize, String)> {
    let after = rest.strip_prefix("br").or_else(|| rest.strip_prefix('r'))?;
    let hashes = after.len() - after.trim_start_matches('#').len();
    after[hashes..].starts_with('"').then(|| {
        (
            rest.len() - after.len() + hashes + 1,
            format!("\"{}", "#".repeat(hashes)),
        )
    })
}

fn end_of_string(rest: &str) -> usize {
    let mut is_escaped = false;
    for (at, letter) in rest.char_indices() {
        match letter {
            '"' if !is_escaped => return at,
            '\\' => is_escaped = !is_escaped,
            _ => is_escaped = false,
        }
    }
    rest.len()
}

/// The end of a character, or that of the quote of a lifetime.
fn end_of_letter(rest: &str) -> usize {
    let mut letters = rest.char_indices().skip(1);
    match letters.next() {
        Some((_, '\\')) => rest[3..].find('\'').map_or(rest.len(), |end| end + 4),
        Some((_, _)) if rest[1..].chars().nth(1) == Some('\'') => {
            letters.next().map_or(rest.len(), |(at, _)| at + 1)
        }
        _ => 1,
    }
}

fn end_of_block(rest: &str) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at < rest.len() {
        if rest[at..].starts_with("/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if rest[at..].starts_with("*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return at;
            }
        } else {
            at += rest[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    rest.len()
}

/// What is wrong with all sources.
fn each_source(check: impl Fn(&Path, &str) -> Vec<String>) -> Vec<String> {
    let paths = SOURCES
        .iter()
        .flat_map(|folder| files_with(Path::new(folder), "rs"));
    // This file quotes what it forbids.
    let paths = paths.filter(|path| !path.ends_with("tests/words.rs"));
    paths
        .flat_map(|path| check(&path, &fs::read_to_string(root().join(&path)).unwrap()))
        .collect()
}

/// All pages with their texts.
fn pages() -> impl Iterator<Item = (PathBuf, String)> {
    let paths = PAGES
        .iter()
        .flat_map(|page| files_with(Path::new(page), "md"));
    paths.map(|path| {
        let text = fs::read_to_string(root().join(&path)).unwrap();
        (path, text)
    })
}

/// The files with an extension below a folder, or the file itself; in order. There are some.
fn files_with(path: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = files(path);
    found.retain(|path| path.extension().is_some_and(|e| e == extension));
    assert!(
        !found.is_empty(),
        "no file .{extension} in {}",
        path.display()
    );
    found
}

/// The files below a folder, or the file itself; in order.
fn files(path: &Path) -> Vec<PathBuf> {
    let full = root().join(path);
    if full.is_file() {
        return vec![path.to_owned()];
    }
    let mut entries: Vec<_> = fs::read_dir(&full)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    entries.sort();
    entries
        .into_iter()
        .flat_map(|name| files(&path.join(name)))
        .collect()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

//! No circles: what a folder holds uses each other in one direction.
//!
//! The rule: in each folder, its files and subfolders are nodes; a subfolder stands for all that it
//! holds. One node has an arrow to another if a path in its text leads there, through re-exports to
//! where the item is defined. Not judged are paths between a `mod.rs` and what its folder holds,
//! because the folder is that module's text, divided; and tests, which may build what they need by
//! modules above. Methods that are called without a path are not seen.

use std::collections::{BTreeMap, BTreeSet};

/// A module's path from the root of its crate.
type Module = Vec<String>;

#[test]
fn folders_have_no_circles() {
    let found: BTreeSet<String> = super::sources().iter().flat_map(|files| circles(files)).collect();
    assert!(found.is_empty(), "circles: {found:#?}");
}

#[test]
fn circles_are_found() {
    let in_room = |a: &str, b: &str| {
        let faces = "mod a;\nmod b;\npub(crate) mod deep;\npub use a::First;\npub use b::Second as Other;";
        let files = [("lib.rs", "mod room;"), ("room/mod.rs", faces), ("room/a.rs", a), ("room/b.rs", b)];
        let deep = [("room/deep/mod.rs", "mod x;\npub fn f() { super::Other::g() }"), ("room/deep/x.rs", "")];
        circles(&[&files[..], &deep[..]].concat())
    };
    let none: [&str; 0] = [];
    assert_eq!(in_room("use super::b::{Second, third};", ""), none, "one direction");
    assert_eq!(in_room("use super::b::Second;", "fn f() { super::a::g() }"), ["room: a, b"]);
    assert_eq!(in_room("use crate::room::b;", "use super::{\n    First,\n    X,\n};"), ["room: a, b"], "a re-export");
    assert_eq!(in_room("use super::Other;", "use crate::room::First;"), ["room: a, b"], "under another name");
    assert_eq!(in_room("use super::Other;", "// use super::First;\n/// [`First`](super::First)"), none, "comments");
    assert_eq!(in_room("use super::Other;", "#[cfg(test)]\nmod tests {\n    use super::super::a::First;\n}"), none);
    assert_eq!(in_room("", "use super::deep::x::Y;"), ["room: b, deep"], "by way of a folder");
    assert_eq!(in_room("", "use super::Unknown;"), none, "the folder is one text with what it holds");
    assert_eq!(in_room("fn f(x: super::b::Second) -> super::X", "fn f(x: crate::y::X) -> super::b::Z"), none, "itself");
}

/// The circles among files, given as paths below the folder `src` and texts: "folder: node, node",
/// in order.
pub(crate) fn circles<P: AsRef<str>, T: AsRef<str>>(files: &[(P, T)]) -> Vec<String> {
    let files = files
        .iter()
        .map(|(path, text)| (path.as_ref(), text.as_ref()))
        .filter(|(path, _)| !path.ends_with("/tests.rs"));
    let modules: BTreeMap<Module, Source> = files.map(|(path, text)| (module_of(path), Source::of(text))).collect();
    let mut arrows: BTreeMap<&[String], BTreeSet<(&str, &str)>> = BTreeMap::new();
    let targets: Vec<(&Module, Module)> = modules
        .iter()
        .flat_map(|(module, source)| source.paths.iter().map(move |path| (module, path)))
        .map(|(module, path)| (module, resolved(&modules, module, path, 0)))
        .collect();
    for (from, to) in &targets {
        let shared = from.iter().zip(to).take_while(|(a, b)| a == b).count();
        if let (Some(user), Some(used)) = (from.get(shared), to.get(shared)) {
            arrows.entry(&from[..shared]).or_default().insert((user, used));
        }
    }
    let mut found = Vec::new();
    for (folder, arrows) in arrows {
        let reach = |from: &str| {
            let mut seen = BTreeSet::new();
            let mut open = vec![from];
            while let Some(user) = open.pop() {
                open.extend(arrows.iter().filter(|(a, b)| *a == user && seen.insert(*b)).map(|(_, b)| *b));
            }
            seen
        };
        let reached: BTreeMap<&str, BTreeSet<&str>> = arrows.iter().map(|&(user, _)| (user, reach(user))).collect();
        let circle = |of: &str| -> Vec<&str> {
            let is_back = |other: &&str| reached.get(other).is_some_and(|back| back.contains(of));
            reached[of].iter().copied().filter(is_back).collect()
        };
        let circles: BTreeSet<Vec<&str>> = reached.keys().map(|user| circle(user)).filter(|c| c.len() > 1).collect();
        found.extend(circles.iter().map(|circle| format!("{}: {}", folder.join("/"), circle.join(", "))));
    }
    found
}

/// `io/geotiff/mod.rs` is `io`, `geotiff`; `lib.rs` is the root.
fn module_of(path: &str) -> Module {
    let path = path.trim_end_matches(".rs");
    let path = path.strip_suffix("/mod").unwrap_or(path);
    if ["lib", "main", "mod"].contains(&path) { Vec::new() } else { path.split('/').map(str::to_owned).collect() }
}

/// The module that a path leads to, from the module that has it in its text.
fn resolved(modules: &BTreeMap<Module, Source>, from: &Module, path: &[String], depth: u32) -> Module {
    let mut here = from.clone();
    for (i, name) in path.iter().enumerate() {
        match name.as_str() {
            "crate" => here.clear(),
            "super" => drop(here.pop()),
            "self" => {}
            _ => {
                here.push(name.clone());
                if modules.contains_key(&here) {
                    continue;
                }
                here.pop();
                // A re-export, if it is not the import that is asked about.
                let import = modules.get(&here).and_then(|source| source.imports.get(name));
                return match import.filter(|import| depth < 8 && (here != *from || *import != path)) {
                    Some(import) => resolved(modules, &here, &[import, &path[i + 1..]].concat(), depth + 1),
                    None => here,
                };
            }
        }
    }
    here
}

/// What matters of a file's text.
struct Source {
    /// All paths that start with `crate`, `super` or `self`, or are imported.
    paths: Vec<Vec<String>>,
    /// What imports are called, and their paths.
    imports: BTreeMap<String, Vec<String>>,
}

impl Source {
    fn of(text: &str) -> Self {
        let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        let code = lines.collect::<Vec<_>>().join("\n");
        let mut source = Source { paths: Vec::new(), imports: BTreeMap::new() };
        let mut before = ' ';
        for statement in code.split("use ") {
            if before.is_whitespace() || before == '(' {
                source.import(Vec::new(), statement.split(';').next().unwrap_or_default());
            }
            before = statement.chars().last().unwrap_or(' ');
        }
        for start in ["crate::", "super::", "self::"] {
            for (at, _) in code.match_indices(start) {
                if !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                    source.paths.push(path(&code[at..]));
                }
            }
        }
        source
    }

    /// Adds what one import names, braces and all.
    fn import(&mut self, mut path: Vec<String>, tree: &str) {
        let mut tree = tree.trim();
        while let Some((first, rest)) = tree.split_once("::").filter(|(first, _)| is_name(first.trim())) {
            path.push(first.trim().to_owned());
            tree = rest.trim();
        }
        if let Some(group) = tree.strip_prefix('{') {
            let mut depth = 0;
            let inner = group.rsplit_once('}').map_or(group, |(inner, _)| inner);
            let is_end = |c: char| {
                depth += i32::from(c == '{') - i32::from(c == '}');
                c == ',' && depth == 0
            };
            for item in inner.split(is_end).filter(|item| !item.trim().is_empty()) {
                self.import(path.clone(), item);
            }
            return;
        }
        let (item, alias) = tree.split_once(" as ").unwrap_or((tree, tree));
        if item.trim() != "*" && item.trim() != "self" {
            path.push(item.trim().to_owned());
        }
        let alias = if alias.trim() == "self" { path.last().cloned() } else { Some(alias.trim().to_owned()) };
        self.imports.extend(alias.map(|alias| (alias, path.clone())));
        self.paths.push(path);
    }
}

fn is_name(word: &str) -> bool {
    !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// The path at the start of a text.
fn path(mut text: &str) -> Vec<String> {
    let mut path = Vec::new();
    loop {
        let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
        if end > 0 {
            path.push(text[..end].to_owned());
        }
        match text[end..].strip_prefix("::") {
            Some(rest) if end > 0 => text = rest,
            _ => return path,
        }
    }
}

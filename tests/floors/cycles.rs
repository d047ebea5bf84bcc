//! No cycles: what a folder holds uses each other in one direction, its `mod.rs` included.

use std::collections::{BTreeMap, BTreeSet};

use super::dependencies::dependencies;
use super::{PYTHON, SOURCES, sources};

#[test]
fn folders_have_no_cycles() {
    let folders = SOURCES.map(|(folder, _)| folder).into_iter().chain(PYTHON);
    let found: Vec<String> = folders
        .flat_map(|folder| cycles(&sources(folder)))
        .collect();
    assert!(found.is_empty(), "cycles: {found:#?}");
}

#[test]
fn cycles_are_found() {
    let in_module = |a: &str, b: &str| {
        let lists =
            "mod a;\nmod b;\npub(crate) mod deep;\npub use a::First;\npub use b::Second as Other;";
        let files = [
            ("lib.rs", "mod module;"),
            ("module/mod.rs", lists),
            ("module/a.rs", a),
            ("module/b.rs", b),
        ];
        let deep = [
            (
                "module/deep/mod.rs",
                "mod x;\npub fn f() { super::Other::g() }",
            ),
            ("module/deep/x.rs", ""),
        ];
        cycles(&[&files[..], &deep[..]].concat())
    };
    let none: [&str; 0] = [];
    assert_eq!(
        in_module("use super::b::{Second, third};", ""),
        none,
        "one direction"
    );
    assert_eq!(
        in_module("use super::b::Second;", "fn f() { super::a::g() }"),
        ["module: a, b"]
    );
    assert_eq!(
        in_module(
            "use crate::module::b;",
            "use super::{\n    First,\n    X,\n};"
        ),
        ["module: a, b"],
        "a re-export"
    );
    assert_eq!(
        in_module("use super::Other;", "use crate::module::First;"),
        ["module: a, b"],
        "under another name"
    );
    assert_eq!(
        in_module(
            "use super::Other;",
            "// use super::First;\n/// [`First`](super::First)"
        ),
        none,
        "comments"
    );
    assert_eq!(
        in_module(
            "use super::Other;",
            "#[cfg(test)]\nmod tests {\n    use super::super::a::First;\n}"
        ),
        none
    );
    assert_eq!(
        in_module("", "use super::deep::x::Y;"),
        ["module: b, deep"],
        "by way of a folder"
    );
    assert_eq!(
        in_module("use super::Shared;", "use super::Shared;"),
        none,
        "what a `mod.rs` defines that uses nothing"
    );
    assert_eq!(
        in_module(
            "fn f(x: super::b::Second) -> super::X",
            "fn f(x: crate::y::X) -> super::b::Z"
        ),
        none,
        "itself"
    );
}

#[test]
fn cycles_through_the_own_file_are_found() {
    let with_own = |own: &str, a: &str| {
        let lists = format!("mod a;\npub(super) use self::a::{{First, first}};\n{own}");
        cycles(&[
            ("lib.rs", "mod module;"),
            ("module/mod.rs", &lists),
            ("module/a.rs", a),
        ])
    };
    let none: [&str; 0] = [];
    let cycle = ["module: a, mod.rs"];
    assert_eq!(
        with_own("", "use super::Shared;"),
        none,
        "lists and re-exports are no use"
    );
    assert_eq!(with_own("fn f() { a::g() }", ""), none, "one direction");
    assert_eq!(
        with_own("fn f() { a::g() }", "use super::Shared;"),
        cycle,
        "a path that starts at a declaration"
    );
    assert_eq!(
        with_own("use self::a::Second;", "use super::Shared;"),
        cycle,
        "an import"
    );
    assert_eq!(
        with_own("fn f() -> First", "use super::Shared;"),
        cycle,
        "a re-exported type that is used here, too"
    );
    assert_eq!(
        with_own("fn f() { first(1) }", "use super::Shared;"),
        cycle,
        "a re-exported function"
    );
    assert_eq!(
        with_own(
            "fn first() { x.first(1); let first = y::a::g; }",
            "use super::Shared;"
        ),
        none,
        "other names"
    );
    assert_eq!(
        with_own("fn f() -> First", "fn f() { super::first() }"),
        none,
        "itself, by its re-export"
    );
}

#[test]
fn cycles_of_python_are_found() {
    let package = |a: &str, b: &str| {
        cycles(&[
            ("__init__.py", "from ._a import A"),
            ("_a.py", a),
            ("_b.py", b),
            ("_c.pyi", ""),
        ])
    };
    let none: [&str; 0] = [];
    assert_eq!(
        package("from . import _b\nfrom ._b import B", "import os"),
        none,
        "one direction"
    );
    assert_eq!(
        package(
            "from . import _c, _b",
            "from . import _c\nfrom ._a import A"
        ),
        [": _a, _b"]
    );
    assert_eq!(
        package("from . import A", ""),
        [": _a, mod.rs"],
        "a name of the package itself"
    );
    assert_eq!(
        package(
            "from ._b import (\n    B,\n)",
            "def f():\n    from ._a import A"
        ),
        [": _a, _b"],
        "in a function"
    );
}

/// The cycles among files, given as paths below the folder `src` and texts: "folder: node, node",
/// in order.
pub(crate) fn cycles<P: AsRef<str>, T: AsRef<str>>(files: &[(P, T)]) -> Vec<String> {
    let mut found = Vec::new();
    for (folder, dependencies) in &dependencies(files) {
        let reach = |from: &str| {
            let mut seen = BTreeSet::new();
            let mut open = vec![from.to_owned()];
            while let Some(user) = open.pop() {
                let used = dependencies
                    .iter()
                    .filter(|(a, _)| *a == user)
                    .map(|(_, b)| &b[..]);
                open.extend(used.filter(|used| seen.insert(*used)).map(str::to_owned));
            }
            seen
        };
        let reached: BTreeMap<&str, BTreeSet<&str>> = dependencies
            .iter()
            .map(|(user, _)| (&user[..], reach(user)))
            .collect();
        let cycle = |of: &str| -> Vec<&str> {
            let is_back = |other: &&str| reached.get(other).is_some_and(|back| back.contains(of));
            reached[of].iter().copied().filter(is_back).collect()
        };
        let cycles: BTreeSet<Vec<&str>> = reached
            .keys()
            .map(|user| cycle(user))
            .filter(|c| c.len() > 1)
            .collect();
        found.extend(
            cycles
                .iter()
                .map(|cycle| format!("{}: {}", folder.join("/"), cycle.join(", "))),
        );
    }
    found
}

//! No circles: what a folder holds uses each other in one direction, its `mod.rs` included.

use std::collections::{BTreeMap, BTreeSet};

use super::arrows::arrows;
use super::{PYTHON, SOURCES, sources};

#[test]
fn folders_have_no_circles() {
    let folders = SOURCES.map(|(folder, _)| folder).into_iter().chain(PYTHON);
    let found: Vec<String> = folders.flat_map(|folder| circles(&sources(folder))).collect();
    assert!(found.is_empty(), "circles: {found:#?}");
}

#[test]
fn circles_are_found() {
    let in_room = |a: &str, b: &str| {
        let lists = "mod a;\nmod b;\npub(crate) mod deep;\npub use a::First;\npub use b::Second as Other;";
        let files = [("lib.rs", "mod room;"), ("room/mod.rs", lists), ("room/a.rs", a), ("room/b.rs", b)];
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
    assert_eq!(in_room("use super::Shared;", "use super::Shared;"), none, "what a `mod.rs` defines that uses nothing");
    assert_eq!(in_room("fn f(x: super::b::Second) -> super::X", "fn f(x: crate::y::X) -> super::b::Z"), none, "itself");
}

#[test]
fn circles_through_the_own_file_are_found() {
    let with_own = |own: &str, a: &str| {
        let lists = format!("mod a;\npub(super) use self::a::{{First, first}};\n{own}");
        circles(&[("lib.rs", "mod room;"), ("room/mod.rs", &lists), ("room/a.rs", a)])
    };
    let none: [&str; 0] = [];
    let circle = ["room: a, mod.rs"];
    assert_eq!(with_own("", "use super::Shared;"), none, "lists and re-exports are no use");
    assert_eq!(with_own("fn f() { a::g() }", ""), none, "one direction");
    assert_eq!(with_own("fn f() { a::g() }", "use super::Shared;"), circle, "a path that starts at a declaration");
    assert_eq!(with_own("use self::a::Second;", "use super::Shared;"), circle, "an import");
    assert_eq!(with_own("fn f() -> First", "use super::Shared;"), circle, "a re-exported type that is used here, too");
    assert_eq!(with_own("fn f() { first(1) }", "use super::Shared;"), circle, "a re-exported function");
    assert_eq!(with_own("fn first() { x.first(1); let first = y::a::g; }", "use super::Shared;"), none, "other names");
    assert_eq!(with_own("fn f() -> First", "fn f() { super::first() }"), none, "itself, by its re-export");
}

#[test]
fn circles_of_python_are_found() {
    let package =
        |a: &str, b: &str| circles(&[("__init__.py", "from ._a import A"), ("_a.py", a), ("_b.py", b), ("_c.pyi", "")]);
    let none: [&str; 0] = [];
    assert_eq!(package("from . import _b\nfrom ._b import B", "import os"), none, "one direction");
    assert_eq!(package("from . import _c, _b", "from . import _c\nfrom ._a import A"), [": _a, _b"]);
    assert_eq!(package("from . import A", ""), [": _a, mod.rs"], "a name of the package itself");
    assert_eq!(
        package("from ._b import (\n    B,\n)", "def f():\n    from ._a import A"),
        [": _a, _b"],
        "in a function"
    );
}

/// The circles among files, given as paths below the folder `src` and texts: "folder: node, node",
/// in order.
pub(crate) fn circles<P: AsRef<str>, T: AsRef<str>>(files: &[(P, T)]) -> Vec<String> {
    let mut found = Vec::new();
    for (folder, arrows) in &arrows(files) {
        let reach = |from: &str| {
            let mut seen = BTreeSet::new();
            let mut open = vec![from.to_owned()];
            while let Some(user) = open.pop() {
                let used = arrows.iter().filter(|(a, _)| *a == user).map(|(_, b)| &b[..]);
                open.extend(used.filter(|used| seen.insert(*used)).map(str::to_owned));
            }
            seen
        };
        let reached: BTreeMap<&str, BTreeSet<&str>> = arrows.iter().map(|(user, _)| (&user[..], reach(user))).collect();
        let circle = |of: &str| -> Vec<&str> {
            let is_back = |other: &&str| reached.get(other).is_some_and(|back| back.contains(of));
            reached[of].iter().copied().filter(is_back).collect()
        };
        let circles: BTreeSet<Vec<&str>> = reached.keys().map(|user| circle(user)).filter(|c| c.len() > 1).collect();
        found.extend(circles.iter().map(|circle| format!("{}: {}", folder.join("/"), circle.join(", "))));
    }
    found
}

//! The floors of modules: a file uses lower floors and its own folder, nothing else.
//!
//! Some folders have floors of their own. In all others, see [`cycles`]. `docs/architecture.md`
//! says why. What is read is the source text, so a path has to be written out
//! (`crate::data::Grid`) or imported with `use crate::...`, also inside braces.

mod cycles;
mod dependencies;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use dependencies::{OWN_FILE, dependencies};

/// Modules from the ground up. Modules on one floor do not know each other, except as [`NEIGHBORS`]
/// says.
type Floors = &'static [&'static [&'static str]];

/// Where the modules are, of each crate.
const SOURCES: [(&str, Floors); 2] = [("src", BREAKLINE), ("triangulation/src", TRIANGULATIONS)];

const BREAKLINE: Floors = &[
    &["error", "num"],
    &["kernel", "crs", "data"],
    &["arrangement", "geometry", "tds"],
    &["triangulation"],
    &["terrain", "io"],
    &["run"],
    &["cli"],
];

const TRIANGULATIONS: Floors = &[
    &["num", "parallel"],
    &["kernel"],
    &["arrangement", "geometry", "tds"],
    &["embedded", "flaw", "line_id"],
    &["error", "triangulation"],
    &["bulk", "locate"],
    &["engine"],
    &["kinds", "lines"],
    &["hierarchy", "query", "refine"],
    &["compact", "saved"],
];

/// The folders of `breakline` that have floors of their own. Their `mod.rs` only lists them.
const FOLDERS: [(&str, Floors); 2] = [("io", IO), ("run", RUN)];

const IO: Floors = &[
    &["bytes"],
    &["options"],
    &["codec"],
    &["formats"],
    &["fronts"],
];

const RUN: Floors = &[
    &["request"],
    &["context"],
    &["sources"],
    &["lines"],
    &["products"],
    &["triangulate", "verbs"],
    &["job", "space"],
    &["write"],
    &["opened"],
    &["shared"],
];

/// The binding for Python: the library, and the package around it.
const PYTHON: [&str; 2] = ["python/src", "python/package/breakline"];

/// `(user, used)` on the same floor: records carry the coordinate system that they are in, and a
/// mesh asks which way its faces turn.
const NEIGHBORS: [(&str, &str); 2] = [("data", "crs"), ("data", "kernel")];

/// Modules of the crate of triangulations that are below its root, as `breakline` sees it.
const LOWER: [&str; 5] = ["num", "kernel", "arrangement", "geometry", "tds"];

/// More lines than this are more than one idea.
const LONGEST: usize = 800;

#[test]
fn files_use_lower_floors_only() {
    let mut faults = Vec::new();
    for (crate_folder, floors) in SOURCES {
        for (path, text) in sources(crate_folder) {
            let module = path.split('/').next().unwrap().trim_end_matches(".rs");
            // The roots see everything, and what stands beside them.
            if !["lib", "main", "guide"].contains(&module) {
                let wrong = used_modules(floors, without_tests(&path, &text))
                    .into_iter()
                    .filter(|used| !may_use(floors, module, used));
                faults.extend(wrong.map(|used| format!("{path}: {module} must not use {used}")));
            }
            let lines = text.lines().count();
            if lines > LONGEST {
                faults.push(format!("{path}: {lines} lines, {LONGEST} at most"));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn folders_use_lower_floors_only() {
    let files = sources("src");
    let faults: Vec<String> = FOLDERS
        .iter()
        .flat_map(|(folder, floors)| faults_in(folder, floors, &files))
        .collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn the_rule_of_folders_can_fail() {
    let faults = |low: &str, high: &str, own: &str| {
        let list = format!("mod high;\nmod low;\npub use high::High;\n{own}");
        let files = [
            ("hut/mod.rs", &list[..]),
            ("hut/low/mod.rs", ""),
            ("hut/low/a.rs", low),
            ("hut/high.rs", high),
        ];
        faults_in("hut", &[&["low"], &["high"]], &files)
    };
    let none: [&str; 0] = [];
    let upward = ["hut: low must not use high"];
    assert_eq!(faults("", "use super::low::a::A;", ""), none);
    assert_eq!(faults("use crate::hut::high::High;", "", ""), upward);
    assert_eq!(
        faults("use crate::hut::High;", "", ""),
        upward,
        "by a re-export"
    );
    assert_eq!(
        faults("fn f() -> crate::hut::High", "", ""),
        upward,
        "a path in the text"
    );
    assert_eq!(
        faults("", "use super::Shared;", "pub struct Shared;"),
        ["hut: high must not use mod.rs"]
    );
    assert_eq!(
        faults("", "", "fn f() { low::g() }"),
        ["hut: mod.rs must not use low"]
    );
    let attic = [("hut/mod.rs", "mod attic;"), ("hut/attic.rs", "")];
    assert_eq!(
        faults_in("hut", &[&["low"], &["high"]], &attic),
        ["hut: attic has no floor"]
    );
}

/// What stands in a folder without a floor, or uses something that is not on a lower one.
fn faults_in<P: AsRef<str>, T: AsRef<str>>(
    folder: &str,
    floors: Floors,
    files: &[(P, T)],
) -> Vec<String> {
    let floor = |module: &str| floors.iter().position(|modules| modules.contains(&module));
    let inside = files
        .iter()
        .filter_map(|(path, _)| path.as_ref().strip_prefix(folder)?.strip_prefix('/'));
    let modules: BTreeSet<&str> = inside
        .map(|path| path.split('/').next().unwrap().trim_end_matches(".rs"))
        .collect();
    let own_file = OWN_FILE.trim_end_matches(".rs");
    let homeless = modules
        .into_iter()
        .filter(|module| *module != own_file && floor(module).is_none());
    let mut faults: Vec<String> = homeless
        .map(|module| format!("{folder}: {module} has no floor"))
        .collect();
    for (user, used) in dependencies(files)
        .get(&[folder.to_owned()][..])
        .into_iter()
        .flatten()
    {
        if !matches!((floor(user), floor(used)), (Some(high), Some(low)) if low < high) {
            faults.push(format!("{folder}: {user} must not use {used}"));
        }
    }
    faults
}

#[test]
fn the_rule_can_fail() {
    let in_crate = |floors, module, text: &str| {
        used_modules(floors, text)
            .iter()
            .all(|used| may_use(floors, module, used))
    };
    let check = |module, text| in_crate(BREAKLINE, module, text);
    assert!(check(
        "terrain",
        "use crate::{data::Grid, error::Result};\nlet a = crate::tds::Id;"
    ));
    assert!(check("data", "use crate::crs::Crs;"));
    assert!(
        check(
            "tds",
            "// use crate::geometry::Plane;\n/// [`io`](crate::io)"
        ),
        "comments are not imports"
    );
    assert!(!check("terrain", "use crate::io::Output;"), "sideways");
    assert!(
        !check("io", "fn f(tin: &crate::terrain::Tin)"),
        "a path in the text"
    );
    assert!(!check("tds", "use crate::geometry::Plane;"), "sideways");
    assert!(
        !check("crs", "use crate::data::Grid;"),
        "neighbors, the other way round"
    );
    assert!(
        !check(
            "kernel",
            "use crate::{\n    num::Sign,\n    triangulation::Delaunay,\n};"
        ),
        "upward, in braces"
    );
    assert!(
        !check("num", "use crate::{error::Error, kernel};"),
        "upward, a whole module"
    );
    assert!(
        !check("geometry", "use crate::Tin;"),
        "a re-export hides its floor"
    );
    assert!(
        !check("geometry", "use crate::attic::Box;"),
        "a module that has no floor"
    );
    assert!(
        !check("tds", "use super::super::geometry::Plane;"),
        "by `super`"
    );
    let check_triangulations = |module, text| in_crate(TRIANGULATIONS, module, text);
    assert!(check_triangulations(
        "lines",
        "use crate::engine::Inserted;"
    ));
    assert!(
        !check_triangulations("engine", "use crate::lines::Rounding;"),
        "upward, in the other crate"
    );
    assert!(
        !check_triangulations("query", "use crate::Delaunay;"),
        "a re-export at the root"
    );
    assert!(
        check("data", "use crate::triangulation::kernel::Exact;"),
        "a low module of the other crate"
    );
    assert!(
        !check("data", "use crate::triangulation::Delaunay;"),
        "a high one"
    );
}

fn may_use(floors: Floors, user: &str, used: &str) -> bool {
    let floor = |module| floors.iter().position(|modules| modules.contains(&module));
    let (Some(high), Some(low)) = (floor(user), floor(used)) else {
        return false;
    };
    low < high || user == used || NEIGHBORS.contains(&(user, used))
}

/// The text of a file without its tests, which may build what they need by modules above.
fn without_tests<'a>(path: &str, text: &'a str) -> &'a str {
    if path.ends_with("tests.rs") {
        ""
    } else {
        text.split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap_or_default()
    }
}

/// The first names of all paths that start at the crate, and of those that climb to it by `super`.
fn used_modules(floors: Floors, text: &str) -> Vec<String> {
    let code: String = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    // Of the other crate, modules are named, too.
    let code = LOWER.iter().fold(code, |code, module| {
        code.replace(
            &format!("crate::triangulation::{module}::"),
            &format!("crate::{module}::"),
        )
    });
    let name = |s: &str| {
        s.chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let mut modules = Vec::new();
    for path in code.split("crate::").skip(1) {
        let Some(group) = path.strip_prefix('{') else {
            modules.push(name(path));
            continue;
        };
        // What stands at depth 0 of the braces, after their start or a comma.
        let mut depth = 0;
        for item in group.split_inclusive(['{', '}', ',']) {
            let first = name(item.trim_start());
            if depth == 0 && !first.is_empty() {
                modules.push(first);
            }
            depth += i32::from(item.ends_with('{')) - i32::from(item.ends_with('}'));
            if depth < 0 {
                break;
            }
        }
    }
    let climbs: Vec<_> = code.split("super::").collect();
    let by_super = climbs
        .windows(2)
        .filter(|pair| pair[0].is_empty())
        .map(|pair| name(pair[1]));
    modules.extend(by_super.filter(|module| floors.concat().contains(&module.as_str())));
    modules
}

/// The source files in a folder, with their paths below it.
fn sources(folder: &str) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path
                .extension()
                .is_some_and(|e| ["rs", "py", "pyi"].iter().any(|known| e == *known))
            {
                let name = path
                    .strip_prefix(&root)
                    .unwrap()
                    .components()
                    .map(|part| part.as_os_str().to_str().unwrap());
                files.push((
                    name.collect::<Vec<_>>().join("/"),
                    fs::read_to_string(&path).unwrap(),
                ));
            }
        }
    }
    assert!(
        files.len() > 10,
        "found only {} files in {folder}",
        files.len()
    );
    files
}

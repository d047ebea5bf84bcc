//! Which module uses which, read from the source text.
//!
//! One module depends on another if a path in its text leads there, through re-exports to where the
//! item is defined. What a `mod.rs` declares or re-exports is no dependency; what its own code uses
//! is one. Not judged are tests, which may build what they need by modules above. Methods that are
//! called without a path are not seen.

use std::collections::{BTreeMap, BTreeSet};

/// A module's path from the root of its crate.
pub(crate) type Module = Vec<String>;

/// What a folder's own file is called among what the folder holds.
pub(crate) const OWN_FILE: &str = "mod.rs";

/// The dependencies in each folder, from user to used, among its files and subfolders. A subfolder
/// stands for all that it holds, and `mod.rs` for itself.
pub(crate) type Dependencies = BTreeMap<Module, BTreeSet<(String, String)>>;

/// Returns the dependencies among files, given as paths below the folder `src` and texts.
pub(crate) fn dependencies<P: AsRef<str>, T: AsRef<str>>(files: &[(P, T)]) -> Dependencies {
    let files = files
        .iter()
        .map(|(path, text)| (path.as_ref(), text.as_ref()))
        .filter(|(path, _)| !path.ends_with("tests.rs"));
    let source = |path: &str, text| {
        if path.contains(".py") {
            Source::of_python(text)
        } else {
            Source::of(text)
        }
    };
    let modules: BTreeMap<Module, Source> = files
        .map(|(path, text)| (module_of(path), source(path, text)))
        .collect();
    let mut dependencies = Dependencies::new();
    for (from, source) in &modules {
        for to in source
            .used(from, &modules)
            .iter()
            .map(|path| resolved(&modules, from, path, 0))
        {
            let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
            let node = |module: &Module| {
                module
                    .get(shared)
                    .map_or(OWN_FILE, String::as_str)
                    .to_owned()
            };
            if *from != to {
                dependencies
                    .entry(from[..shared].to_vec())
                    .or_default()
                    .insert((node(from), node(&to)));
            }
        }
    }
    dependencies
}

/// `io/geotiff/mod.rs` is `io`, `geotiff`; `lib.rs` is the root.
fn module_of(path: &str) -> Module {
    let path = path
        .trim_end_matches(".rs")
        .trim_end_matches(".py")
        .trim_end_matches(".pyi");
    let path = path.strip_suffix("/mod").unwrap_or(path);
    if ["lib", "main", "mod", "__init__"].contains(&path) {
        Vec::new()
    } else {
        path.split('/').map(str::to_owned).collect()
    }
}

/// The module that a path leads to, from the module that has it in its text.
fn resolved(
    modules: &BTreeMap<Module, Source>,
    from: &Module,
    path: &[String],
    depth: u32,
) -> Module {
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
                let import = modules
                    .get(&here)
                    .and_then(|source| source.imports.get(name));
                return match import.filter(|import| depth < 8 && (here != *from || *import != path))
                {
                    Some(import) => resolved(
                        modules,
                        &here,
                        &[import, &path[i + 1..]].concat(),
                        depth + 1,
                    ),
                    None => here,
                };
            }
        }
    }
    here
}

/// What matters of a file's text.
#[derive(Default)]
struct Source {
    /// All paths that start with `crate`, `super` or `self`, or are imported for the file itself.
    paths: Vec<Vec<String>>,
    /// What imports are called, and their paths.
    imports: BTreeMap<String, Vec<String>>,
    /// Those of them that are re-exported.
    exported: BTreeSet<String>,
    /// The text without comments and imports.
    code: String,
}

impl Source {
    fn of(text: &str) -> Self {
        let text = text
            .split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap_or_default();
        let lines = text
            .lines()
            .map(|line| line.split("//").next().unwrap_or_default());
        let text = lines.collect::<Vec<_>>().join("\n");
        let mut source = Source::default();
        let mut rest = &text[..];
        while let Some((before, statement)) = rest.split_once("use ") {
            source.code.push_str(before);
            let line = before.rsplit('\n').next().unwrap_or_default().trim();
            let is_public = line == "pub" || line.starts_with("pub(") && line.ends_with(')');
            if !is_public && !line.is_empty() {
                source.code.push_str("use ");
                rest = statement;
                continue;
            }
            let (tree, after) = statement.split_once(';').unwrap_or((statement, ""));
            source.import(Vec::new(), tree, is_public);
            rest = after;
        }
        source.code.push_str(rest);
        for start in ["crate::", "super::", "self::"] {
            for (at, _) in source
                .code
                .match_indices(start)
                .filter(|&(at, _)| starts_path(&source.code, at))
            {
                source.paths.push(path(&source.code[at..]));
            }
        }
        source
    }

    /// What a file of Python imports from its own package, anywhere in it.
    fn of_python(text: &str) -> Self {
        let mut source = Source::default();
        for line in text
            .lines()
            .filter_map(|line| line.trim_start().strip_prefix("from ."))
        {
            let Some((module, names)) = line.split_once(" import ") else {
                continue;
            };
            let modules: Vec<&str> = if module.is_empty() {
                names.split(',').collect()
            } else {
                vec![module]
            };
            source.paths.extend(
                modules
                    .iter()
                    .map(|name| vec!["crate".to_owned(), name.trim().to_owned()]),
            );
        }
        source
    }

    /// Adds what one import names, braces and all.
    fn import(&mut self, mut path: Vec<String>, tree: &str, is_public: bool) {
        let mut tree = tree.trim();
        while let Some((first, rest)) = tree
            .split_once("::")
            .filter(|(first, _)| is_name(first.trim()))
        {
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
                self.import(path.clone(), item, is_public);
            }
            return;
        }
        let (item, alias) = tree.split_once(" as ").unwrap_or((tree, tree));
        if item.trim() != "*" && item.trim() != "self" {
            path.push(item.trim().to_owned());
        }
        let alias = if alias.trim() == "self" {
            path.last().cloned()
        } else {
            Some(alias.trim().to_owned())
        };
        if is_public {
            self.exported.extend(alias.clone());
        } else {
            self.paths.push(path.clone());
        }
        self.imports.extend(alias.map(|alias| (alias, path)));
    }

    /// All paths that the module's own code uses, its own re-exports and the modules that it
    /// declares among them.
    fn used(&self, here: &Module, modules: &BTreeMap<Module, Source>) -> Vec<Vec<String>> {
        let mut used = self.paths.clone();
        let mut at = 0;
        for word in self
            .code
            .split_inclusive(|c: char| !c.is_alphanumeric() && c != '_')
        {
            let name = word.trim_end_matches(|c: char| !c.is_alphanumeric() && c != '_');
            let behind = &self.code[at + name.len()..];
            if !name.is_empty() && starts_path(&self.code, at) {
                let is_type = name.starts_with(|c: char| c.is_uppercase());
                if self.exported.contains(name) && (is_type || behind.starts_with(['(', ':'])) {
                    used.push(self.imports[name].clone());
                } else if behind.starts_with("::")
                    && modules.contains_key(&[&here[..], &[name.to_owned()]].concat())
                {
                    used.push(path(&self.code[at..]));
                }
            }
            at += word.len();
        }
        used
    }
}

/// Returns true if a path may start here: not behind another part of one, a field's or method's
/// dot, or the word that defines a name.
fn starts_path(code: &str, at: usize) -> bool {
    let before = &code[..at];
    let is_defined = ["fn", "mod", "struct", "enum", "trait", "type"]
        .iter()
        .any(|word| before.trim_end().ends_with(word));
    !before.ends_with(|c: char| c.is_alphanumeric() || ['_', ':', '.'].contains(&c)) && !is_defined
}

fn is_name(word: &str) -> bool {
    !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// The path at the start of a text.
fn path(mut text: &str) -> Vec<String> {
    let mut path = Vec::new();
    loop {
        let end = text
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(text.len());
        if end > 0 {
            path.push(text[..end].to_owned());
        }
        match text[end..].strip_prefix("::") {
            Some(rest) if end > 0 => text = rest,
            _ => return path,
        }
    }
}

//! From the tables of a run file to the words of single commands.

use std::collections::HashSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, Args, Command, CommandFactory, ValueHint};

use super::file::{Product, RunFile};
use super::nearest::nearest;
use super::product_words::ProductWords;
use super::tree::{Entry, Value};
use crate::cli::input::args::{Cli, RunArgs, SurfaceArgs, TileArgs};
use crate::cli::input::inputs::in_folder;
use crate::error::{Error, Result};
use crate::io::gdal;

/// The key of the files of a surface, which have no name on the command line.
pub(super) const FILES: &str = "files";

/// The key of the verb of a product.
const VERB: &str = "verb";

/// The word that stands for several files of a surface where a verb has more than one surface. The
/// single command reads them from a list of this name.
pub(crate) const LIST: &str = "@files.txt";

/// Verbs whose inputs are surfaces of their own: a product may have more `files`.
const OF_SEVERAL_SURFACES: [&str; 3] = ["volume", "compare", "profile"];

/// Options that name a file to write, and so belong to a product.
const WRITTEN: [&str; 5] = [
    "output",
    "labels_output",
    "histogram",
    "crossing_report",
    "flat_points",
];

/// The options of the command line, sorted by where they are in a run file.
pub(crate) struct Vocabulary {
    program: Command,
    /// The options of a surface, as a command.
    surface: Command,
    /// Options of verbs that a product does not have.
    of_the_run: HashSet<String>,
    /// Those that are typed for all products.
    typed_once: Command,
}

impl Vocabulary {
    pub(crate) fn new() -> Self {
        let mut program = Cli::command();
        program.build();
        let empty = || {
            Command::new("input")
                .no_binary_name(true)
                .disable_help_flag(true)
        };
        let ids = |command: &Command| -> Vec<String> {
            let ids = command.get_arguments().map(|arg| arg.get_id().to_string());
            ids.collect()
        };
        let mut surface = SurfaceArgs::augment_args(empty());
        surface.build();
        // With `memory`, which verbs without tiles have, too.
        let tiles = TileArgs::augment_args(empty());
        let global = program.get_arguments().map(|arg| arg.get_id().to_string());
        let mut of_the_run: HashSet<String> = ids(&tiles).into_iter().chain(global).collect();
        of_the_run.insert("json".to_owned());
        let typed_once = RunArgs::augment_args(empty()).args(program.get_arguments().cloned());
        Vocabulary {
            program,
            surface,
            of_the_run,
            typed_once,
        }
    }

    /// Returns the words of the options of the surface.
    ///
    /// # Errors
    /// If a key is not an option of a surface, or its value has the wrong form.
    pub(crate) fn surface_words(&self, file: &RunFile) -> Result<Vec<OsString>> {
        let of_input = |entry: &Entry| self.of_input(entry, file);
        let words: Vec<Vec<OsString>> = file.input.iter().map(of_input).collect::<Result<_>>()?;
        Ok(words.into_iter().flatten().collect())
    }

    /// Returns the command that reads the options of the surface.
    pub(crate) fn surface_command(&self) -> Command {
        self.surface.clone()
    }

    /// Returns the places of the keys of the surface.
    pub(crate) fn surface_locations(file: &RunFile) -> Vec<(String, String)> {
        file.input
            .iter()
            .map(|entry| (entry.key.clone(), location_of(entry, "input")))
            .collect()
    }

    /// Returns each product in the words of a single command.
    ///
    /// # Errors
    /// If a verb is unknown or does not make a product, a key is not one of its options, or a value
    /// has the wrong form.
    pub(crate) fn products(&self, file: &RunFile) -> Result<Vec<ProductWords>> {
        let surface = self.surface_words(file)?;
        let product = |(i, product): (usize, &Product)| {
            self.product(i + 1, product, &surface, file)
                .map_err(|e| file.located(e, &product.location))
        };
        file.products.iter().enumerate().map(product).collect()
    }

    fn product(
        &self,
        number: usize,
        product: &Product,
        surface: &[OsString],
        file: &RunFile,
    ) -> Result<ProductWords> {
        let verb = self.verb(product)?;
        let is_of_several = OF_SEVERAL_SURFACES.contains(&verb.get_name());
        let mut words = vec![OsString::from(verb.get_name())];
        match is_of_several {
            true => words.extend(of_one_word(surface)),
            false => words.extend(surface.iter().cloned()),
        }
        for entry in &product.entries {
            if entry.key != VERB {
                let at = |e: Error| file.located(e, &location_of(entry, &product.location));
                words.extend(self.of_product(entry, verb, file).map_err(at)?);
            }
        }
        let own = product.entries.iter();
        let mut locations: Vec<(String, String)> = own
            .map(|entry| (entry.key.clone(), location_of(entry, &product.location)))
            .collect();
        locations.extend(Self::surface_locations(file));
        Ok(ProductWords {
            verb: verb.get_name().to_owned(),
            words,
            number,
            is_of_several,
            location: product.location.clone(),
            locations,
        })
    }

    /// Returns the verb of a product.
    fn verb(&self, product: &Product) -> Result<&Command> {
        let entry = product.entries.iter().find(|entry| entry.key == VERB);
        let names = || self.verbs().map(Command::get_name);
        let all = || names().collect::<Vec<_>>().join(", ");
        let Some(entry) = entry else {
            return Err(Error::usage("the product has no verb")
                .cure(format!("add verb = \"dem\", or one of {}", all())));
        };
        let location = location_of(entry, &product.location);
        let Value::Word(name) = &entry.value else {
            return Err(Error::usage(format!(
                "the verb is {}, and not a name",
                entry.value.kind()
            ))
            .at(location)
            .cure(format!("use one of {}", all())));
        };
        let found = self.verbs().find(|verb| verb.get_name() == name);
        found.ok_or_else(|| {
            let error = Error::usage(format!("`{name}` is not a verb that makes a product"));
            error.at(location).cure(match nearest(name, names()) {
                Some(known) => format!("did you mean `{known}`?"),
                None => format!("use one of {}", all()),
            })
        })
    }

    /// Returns the verbs that make products of a surface.
    fn verbs(&self) -> impl Iterator<Item = &Command> {
        let has = |verb: &Command, id: &str| verb.get_arguments().any(|arg| arg.get_id() == id);
        self.program
            .get_subcommands()
            .filter(move |verb| has(verb, "breaklines") && has(verb, "output"))
    }

    fn of_input(&self, entry: &Entry, file: &RunFile) -> Result<Vec<OsString>> {
        let at = |e: Error| file.located(e, &location_of(entry, "input"));
        let args = || {
            let args = self.surface.get_arguments();
            args.filter(|arg| !WRITTEN.contains(&arg.get_id().as_str()))
        };
        if let Some(arg) = args().find(|arg| is_named(arg, &entry.key)) {
            return of_entry(arg, entry, file).map_err(at);
        }
        if let Some(error) = self.of_the_run(&entry.key) {
            return Err(at(error));
        }
        let error = Error::usage(format!("`{}` is not an option of a surface", entry.key));
        let is_of_a_product = |arg: &Arg| is_named(arg, &entry.key);
        let mut verbs = self.verbs();
        let near = nearest(&entry.key, args().flat_map(keys));
        let cure = match (
            near,
            verbs.find(|verb| verb.get_arguments().any(is_of_a_product)),
        ) {
            (_, Some(_)) => "move it to a [[product]]".to_owned(),
            (Some(known), None) => format!("did you mean `{known}`?"),
            (None, None) => "`breakline tin --help` lists the options of a surface".to_owned(),
        };
        Err(at(error.cure(cure)))
    }

    /// Returns an error for a key of what belongs to the run and not to its tables; `None` for any
    /// other.
    fn of_the_run(&self, key: &str) -> Option<Error> {
        let option = key.replace('_', "-");
        let has = |command: &Command| {
            let mut args = command.get_arguments();
            args.any(|arg| !arg.is_positional() && is_named(arg, key))
        };
        if has(&self.typed_once) {
            let error = Error::usage(format!("`{key}` is for all products"));
            return Some(error.cure(format!(
                "type it after the name of the run file: `breakline run FILE.toml --{option}`"
            )));
        }
        let has_tiles = |verb: &Command| {
            let mut args = verb.get_arguments();
            args.any(|arg| self.of_the_run.contains(arg.get_id().as_str()) && is_named(arg, key))
        };
        self.verbs().any(has_tiles).then(|| {
            Error::usage(format!("`{key}` is for jobs of single commands")).cure(
                "leave it out: points of more than the memory are built in tiles by themselves",
            )
        })
    }

    fn of_product(&self, entry: &Entry, verb: &Command, file: &RunFile) -> Result<Vec<OsString>> {
        let name = verb.get_name();
        let is_of_the_surface = |arg: &Arg| {
            let id = arg.get_id().as_str();
            let is_file = id == "inputs" && OF_SEVERAL_SURFACES.contains(&name);
            !is_file
                && !WRITTEN.contains(&id)
                && self
                    .surface
                    .get_arguments()
                    .any(|other| other.get_id() == id)
        };
        let is_of_the_run = |arg: &Arg| self.of_the_run.contains(arg.get_id().as_str());
        let own = || {
            let all = verb.get_arguments();
            all.filter(|arg| !is_of_the_surface(arg) && !is_of_the_run(arg))
        };
        if let Some(arg) = own().find(|arg| is_named(arg, &entry.key)) {
            return of_entry(arg, entry, file);
        }
        let key = &entry.key;
        if let Some(error) = self.of_the_run(key) {
            return Err(error);
        }
        Err(match verb.get_arguments().find(|arg| is_named(arg, key)) {
            Some(_) => Error::usage(format!(
                "`{key}` is an option of the surface, which all products share"
            ))
            .cure("move it to [input]; for another surface, write another run file"),
            None => {
                let error = Error::usage(format!("`{key}` is not an option of `{name}`"));
                let keys = own().flat_map(keys).chain([VERB]);
                error.cure(match nearest(key, keys) {
                    Some(known) => format!("did you mean `{known}`?"),
                    None => format!("`breakline {name} --help` lists its options"),
                })
            }
        })
    }
}

/// Returns the words of a surface with one word for all of its files: a list of them, if there are
/// several. Lines alone are a file as well, which single commands read as breaklines.
fn of_one_word(surface: &[OsString]) -> Vec<OsString> {
    let (options, files): (Vec<&OsString>, Vec<&OsString>) =
        surface.iter().partition(|word| is_option(word));
    let mut options: Vec<OsString> = options.into_iter().cloned().collect();
    let breaklines = |word: &OsString| {
        let file = word.to_str()?.strip_prefix("--breaklines=")?;
        Some(OsString::from(file))
    };
    let name = match files[..] {
        [file] => Some(file.clone()),
        // The last one: lines that are files follow the others.
        [] => (0..options.len()).rev().find_map(|i| {
            let file = breaklines(&options[i])?;
            options.remove(i);
            Some(file)
        }),
        _ => Some(LIST.into()),
    };
    name.into_iter().chain(options).collect()
}

fn is_option(word: &OsString) -> bool {
    word.to_string_lossy().starts_with("--")
}

fn location_of(entry: &Entry, own: &str) -> String {
    match entry.line {
        Some(line) => format!("line {line}"),
        None => own.to_owned(),
    }
}

/// Returns the keys that an option has in a run file.
fn keys(arg: &Arg) -> Vec<&str> {
    if arg.is_positional() {
        return vec![FILES];
    }
    let mut keys: Vec<&str> = arg.get_long().into_iter().collect();
    keys.extend(arg.get_all_aliases().unwrap_or_default());
    keys.retain(|&key| key != "help");
    keys
}

/// Returns true if a key names an option. As in Python, `_` is read as `-`.
fn is_named(arg: &Arg, key: &str) -> bool {
    keys(arg).contains(&key.replace('_', "-").as_str())
}

/// Returns the words of an option with its values.
fn of_entry(arg: &Arg, entry: &Entry, file: &RunFile) -> Result<Vec<OsString>> {
    let key = &entry.key;
    let long = arg.get_long().unwrap_or_default();
    let expected = |what: &str| {
        Error::usage(format!(
            "`{key}` is {}, expected {what}",
            entry.value.kind()
        ))
    };
    let may_lack_value = arg
        .get_num_args()
        .is_some_and(|range| range.min_values() == 0);
    let is_switch = !arg.get_action().takes_values();
    let one = |value: &Value| match value {
        Value::Word(word) => Ok(located(arg, word, &file.folder)),
        _ => Err(
            Error::usage(format!("`{key}` has {} in its list", value.kind()))
                .cure("write texts or numbers"),
        ),
    };
    let typed = |word: String| match arg.is_positional() {
        true => OsString::from(word),
        false => OsString::from(format!("--{long}={word}")),
    };
    match &entry.value {
        Value::Bool(on) if is_switch || may_lack_value => {
            Ok(on.then(|| format!("--{long}").into()).into_iter().collect())
        }
        _ if is_switch => Err(expected("true or false")),
        value @ Value::Word(_) => Ok(vec![typed(one(value)?)]),
        Value::List(list) if list.is_empty() => {
            Err(Error::usage(format!("`{key}` is an empty list"))
                .cure("leave it out, or write a value"))
        }
        Value::List(list) => {
            let values = list.iter().map(|(_, value)| one(value));
            let values: Vec<String> = values.collect::<Result<_>>()?;
            match arg.get_action() {
                ArgAction::Append => Ok(values.into_iter().map(typed).collect()),
                _ if values.len() == 1 || takes_list(arg) => Ok(vec![typed(values.join(","))]),
                _ => Err(expected("one value")),
            }
        }
        _ => Err(expected("a text, a number or a list of them")),
    }
}

/// Returns true if the value of an option is a list with commas.
fn takes_list(arg: &Arg) -> bool {
    let names = arg.get_value_names().unwrap_or_default();
    names.iter().any(|name| name.contains(','))
}

/// Returns a value; a path relative to the run file with its folder.
fn located(arg: &Arg, word: &str, folder: &Path) -> String {
    let typed = |path: PathBuf| {
        let text = path.to_string_lossy().into_owned();
        // Not an option.
        match text.starts_with('-') {
            true => format!("./{text}"),
            false => text,
        }
    };
    // Standard input, a database or an address.
    let is_no_path = word == "-" || gdal::is_name(word) || word.contains("://");
    match arg.get_value_hint() {
        ValueHint::AnyPath if is_no_path => gdal::without_secrets(word).into_owned(),
        ValueHint::AnyPath if WRITTEN.contains(&arg.get_id().as_str()) => typed(folder.join(word)),
        ValueHint::AnyPath => match word.strip_prefix('@') {
            Some(list) if !folder.join(word).exists() => {
                format!("@{}", typed(folder.join(list)))
            }
            _ => typed(in_folder(folder, word)),
        },
        // The name of something built in, or a file.
        ValueHint::FilePath if folder.join(word).exists() => typed(folder.join(word)),
        _ => word.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_by_name_is_there() {
        let vocabulary = Vocabulary::new();
        for name in OF_SEVERAL_SURFACES {
            let verb = vocabulary.verbs().find(|verb| verb.get_name() == name);
            assert!(verb.is_some(), "{name}");
        }
        for id in WRITTEN {
            let has = |verb: &Command| {
                let mut args = verb.get_arguments();
                args.any(|arg| {
                    arg.get_id() == id && matches!(arg.get_value_hint(), ValueHint::AnyPath)
                })
            };
            assert!(vocabulary.verbs().any(has), "{id}");
        }
    }

    #[test]
    fn a_surface_is_one_word_among_several() {
        for (words, expected) in [
            (&["a.xyz", "--class=2"][..], &["a.xyz", "--class=2"][..]),
            (&["a.xyz", "--class=2", "b.xyz"], &[LIST, "--class=2"]),
            (
                &[
                    "--breaklines=a.shp",
                    "--breaklines=b.shp",
                    "--bounds=0,0,1,1",
                ],
                &["b.shp", "--breaklines=a.shp", "--bounds=0,0,1,1"],
            ),
            (&["--boundary=a.shp"], &["--boundary=a.shp"]),
        ] {
            let words: Vec<OsString> = words.iter().map(OsString::from).collect();
            assert_eq!(of_one_word(&words), expected);
        }
    }
}

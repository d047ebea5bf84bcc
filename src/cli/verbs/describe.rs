//! The program's description of itself.

use clap::{Arg, ArgAction, Command, CommandFactory};
use serde_json::{Map, Value, json};

use super::product::in_lines;
use crate::cli::Exit;
use crate::cli::input::args::{Cli, DescribeArgs};
use crate::cli::report::stdout::print;
use crate::error::Result;

/// Prints the verbs and their options.
pub(crate) fn run(args: &DescribeArgs) -> Result<Exit> {
    let described = describe();
    if args.json {
        print(&in_lines(&described))?;
    } else {
        print(&as_text(&described))?;
    }
    Ok(Exit::Done)
}

/// Returns the program, its verbs and their options as JSON.
pub(crate) fn describe() -> Value {
    let mut program = Cli::command();
    program.build();
    json!({
        "name": program.get_name(),
        "version": program.get_version(),
        "about": text(program.get_about()),
        "options": program.get_arguments().filter(|arg| arg.is_global_set()).map(option).collect::<Vec<_>>(),
        "verbs": verbs(&program),
    })
}

/// Returns what comes next on the command line: verbs, or what is done with the object of a verb.
fn verbs(command: &Command) -> Vec<Value> {
    command
        .get_subcommands()
        .filter(|verb| verb.get_name() != "help")
        .map(verb)
        .collect()
}

fn verb(verb: &Command) -> Value {
    let own = verb
        .get_arguments()
        .filter(|arg| !arg.is_global_set() && !is_help(arg));
    let mut described = json!({
        "name": verb.get_name(),
        "about": text(verb.get_about()),
        "details": text(verb.get_long_about()),
        "options": own.map(option).collect::<Vec<_>>(),
    });
    let actions = verbs(verb);
    if !actions.is_empty() {
        described["actions"] = actions.into();
    }
    described
}

fn is_help(arg: &Arg) -> bool {
    matches!(
        arg.get_action(),
        ArgAction::Help | ArgAction::HelpShort | ArgAction::HelpLong | ArgAction::Version
    )
}

/// Returns an option or a positional argument; what is unset is left out.
fn option(arg: &Arg) -> Value {
    let takes_value = arg.get_action().takes_values();
    let values: Vec<Value> = if takes_value {
        let named = arg.get_possible_values();
        named
            .iter()
            .map(|value| json!({ "value": value.get_name(), "help": text(value.get_help()) }))
            .collect()
    } else {
        Vec::new()
    };
    let list = |texts: Vec<&str>| texts.into_iter().map(Value::from).collect::<Vec<_>>();
    let value_names = arg
        .get_value_names()
        .unwrap_or_default()
        .iter()
        .map(|name| name.as_str())
        .collect();
    let defaults = arg
        .get_default_values()
        .iter()
        .filter_map(|value| value.to_str())
        .collect();
    let fields = [
        (
            "name",
            json!(arg.get_long().unwrap_or(arg.get_id().as_str())),
        ),
        ("positional", json!(arg.is_positional())),
        ("short", json!(arg.get_short().map(String::from))),
        (
            "aliases",
            list(arg.get_all_aliases().unwrap_or_default()).into(),
        ),
        ("takes_value", json!(takes_value)),
        (
            "value_name",
            if takes_value {
                list(value_names).into()
            } else {
                Value::Null
            },
        ),
        ("values", values.into()),
        (
            "default",
            if takes_value {
                list(defaults).into()
            } else {
                Value::Null
            },
        ),
        ("required", json!(arg.is_required_set())),
        (
            "repeatable",
            json!(matches!(arg.get_action(), ArgAction::Append)),
        ),
        (
            "separator",
            json!(arg.get_value_delimiter().map(String::from)),
        ),
        ("group", json!(arg.get_help_heading())),
        ("help", json!(text(arg.get_help()))),
        ("details", json!(text(arg.get_long_help()))),
    ];
    let is_set = |value: &Value| match value {
        Value::Null => false,
        Value::Array(items) => !items.is_empty(),
        _ => true,
    };
    let fields = fields.into_iter().filter(|(_, value)| is_set(value));
    Value::Object(
        fields
            .map(|(name, value)| (name.to_owned(), value))
            .collect::<Map<_, _>>(),
    )
}

fn text(styled: Option<&clap::builder::StyledStr>) -> Option<String> {
    styled.map(ToString::to_string)
}

/// Returns a line for each verb and each of its options.
fn as_text(described: &Value) -> String {
    verbs_as_text(&described["verbs"], "")
}

/// Returns the lines of verbs, or of the actions of the verb that `before` names.
fn verbs_as_text(verbs: &Value, before: &str) -> String {
    let string = |value: &Value, key: &str| value[key].as_str().unwrap_or_default().to_owned();
    let mut lines = String::new();
    for verb in verbs.as_array().into_iter().flatten() {
        let name = format!("{before}{}", string(verb, "name"));
        lines += &format!("{name}: {}\n", string(verb, "about"));
        for option in verb["options"].as_array().into_iter().flatten() {
            let dashes = if option["positional"] == true {
                ""
            } else {
                "--"
            };
            let value = option["value_name"][0].as_str().filter(|_| dashes == "--");
            let value = value.map_or(String::new(), |name| format!(" {name}"));
            lines += &format!(
                "  {dashes}{}{value}: {}\n",
                string(option, "name"),
                string(option, "help")
            );
        }
        lines += &verbs_as_text(&verb["actions"], &format!("{name} "));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verbs_and_options_are_described_with_values_and_defaults() {
        let described = describe();
        let find = |list: &Value, name: &str| {
            list.as_array()
                .unwrap()
                .iter()
                .find(|item| item["name"] == name)
                .unwrap_or(&Value::Null)
                .clone()
        };
        let names: Vec<_> = described["verbs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|verb| verb["name"].clone())
            .collect();
        assert_eq!(
            names,
            [
                "info",
                "points",
                "ground",
                "tin",
                "simplify",
                "triangulate",
                "dem",
                "contour",
                "hillshade",
                "color-relief",
                "slope",
                "aspect",
                "curvature",
                "roughness",
                "tri",
                "tpi",
                "volume",
                "compare",
                "profile",
                "drape",
                "terrain-tiles",
                "sample",
                "accuracy",
                "check",
                "run",
                "crs",
                "job",
                "demo",
                "describe",
                "completions",
                "man"
            ]
        );
        let job = find(&described["verbs"], "job");
        assert_eq!(
            find(&find(&job["actions"], "run")["options"], "task")["takes_value"],
            true
        );
        let dem = find(&described["verbs"], "dem");
        let method = find(&dem["options"], "method");
        assert_eq!(method["values"][0]["value"], "linear");
        assert_eq!(
            (&method["default"][0], &method["group"]),
            (&json!("linear"), &json!("Raster"))
        );
        let breaklines = find(&dem["options"], "breaklines");
        assert_eq!(
            (&breaklines["repeatable"], &breaklines["value_name"][0]),
            (&json!(true), &json!("FILE[:NAME]"))
        );
        assert_eq!(find(&dem["options"], "inputs")["positional"], true);
        assert_eq!(find(&dem["options"], "help"), Value::Null);
        assert_eq!(find(&described["options"], "threads")["takes_value"], true);
        let text = as_text(&described);
        assert!(
            text.contains("\n  --resolution LENGTH: Size of a cell"),
            "{text}"
        );
        assert!(
            text.contains(
                "\njob status: Show which tasks are done, and which process does which\n"
            ),
            "{text}"
        );
    }
}

//! Texts as JSON, for files that another process reads: what they mention stays data.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Value, json};

use super::{Command, Feature, Part, Setting, Term, Wording};

impl Wording {
    /// Returns the text as JSON.
    fn to_json(&self) -> Value {
        let parts = self.parts().iter().map(|part| match part {
            Part::Text(text) => json!(text),
            Part::Term(term) => term_to_json(term),
        });
        parts.collect()
    }

    /// Returns the text that [`to_json`](Wording::to_json) gave; `None` for other JSON.
    fn from_json(value: &Value) -> Option<Wording> {
        let mut all = Wording::default();
        for part in value.as_array()? {
            match part.as_str() {
                Some(text) => all.push(text),
                None => all.push(term_from_json(part)?),
            }
        }
        Some(all)
    }
}

impl Serialize for Wording {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_json().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Wording {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Wording::from_json(&Value::deserialize(deserializer)?)
            .ok_or_else(|| D::Error::custom("this is no text"))
    }
}

fn term_to_json(term: &Term) -> Value {
    match term {
        Term::Setting(setting) => json!(["setting", setting.name()]),
        Term::On(setting) => json!(["on", setting.name()]),
        Term::Text(setting, value) => json!(["text", setting.name(), value]),
        Term::Number(setting, value) => json!(["number", setting.name(), value]),
        Term::Command(command, file) => json!(["command", command.name(), file]),
        Term::Build(feature) => json!(["build", feature.name()]),
    }
}

fn term_from_json(value: &Value) -> Option<Term> {
    let [form, name] = [0, 1].map(|at| value.get(at).and_then(Value::as_str));
    let (form, name) = (form?, name?);
    let third = value.get(2).and_then(Value::as_str).map(str::to_owned);
    let setting = || Setting::from_name(name);
    Some(match form {
        "setting" => Term::Setting(setting()?),
        "on" => Term::On(setting()?),
        "text" => Term::Text(setting()?, third?),
        "number" => Term::Number(setting()?, third?),
        "command" => Term::Command(
            *Command::ALL.iter().find(|known| known.name() == name)?,
            third,
        ),
        "build" => Term::Build(*Feature::ALL.iter().find(|known| known.name() == name)?),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::wording;

    #[test]
    fn every_term_is_restored() {
        let settings = Setting::ALL.iter().flat_map(|setting| {
            [
                Term::Setting(*setting),
                setting.on(),
                setting.text("a \"b\""),
                setting.number("LENGTH"),
            ]
        });
        let commands = Command::ALL
            .iter()
            .flat_map(|command| [Term::Command(*command, None), command.on("a.tin")]);
        let features = Feature::ALL.iter().map(|feature| Term::Build(*feature));
        for term in settings.chain(commands).chain(features) {
            let text = wording!["use ", term, " or [\"on\"] else"];
            assert_eq!(Wording::from_json(&text.to_json()), Some(text));
        }
        for other in [
            json!("text"),
            json!([["on"]]),
            json!([["on", "unheard-of"]]),
            json!([7]),
            json!([["text", "te"]]),
        ] {
            assert_eq!(Wording::from_json(&other), None, "{other}");
        }
    }
}

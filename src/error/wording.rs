//! Texts in which settings and commands are data.

use super::setting::{Command, Feature, Setting, Term};

/// A text in which settings, commands and features are data, so that each caller can name them in
/// its own words.
///
/// Made from a text, or by `wording!["choose with ", Setting::Class]`. It is not `Display`: what is
/// formatted into another text would be data no more.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct Wording {
    parts: Vec<Part>,
}

/// A part of a text.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Part {
    /// Words.
    Text(String),
    /// What each caller names in its own words.
    Term(Term),
}

impl Wording {
    /// Adds a text or a term at the end.
    pub fn push(&mut self, more: impl Into<Wording>) {
        for part in more.into().parts {
            match (self.parts.last_mut(), part) {
                (Some(Part::Text(text)), Part::Text(more)) => text.push_str(&more),
                (_, part) => self.parts.push(part),
            }
        }
    }

    /// Returns the parts of the text, in order.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Returns the text with the names that a caller has for terms.
    pub fn render(&self, name: &dyn Fn(&Term) -> String) -> String {
        let parts = self.parts.iter().map(|part| match part {
            Part::Text(text) => text.clone(),
            Part::Term(term) => name(term),
        });
        parts.collect()
    }

    /// Returns the text with plain names for terms.
    pub fn plain(&self) -> String {
        self.render(&Term::plain)
    }

    /// Joins several texts with one between them.
    pub fn join(texts: impl IntoIterator<Item = Wording>, between: &str) -> Wording {
        let mut all = Wording::default();
        for (i, text) in texts.into_iter().enumerate() {
            if i > 0 {
                all.push(between);
            }
            all.push(text);
        }
        all
    }
}

impl PartialEq<&str> for Wording {
    fn eq(&self, text: &&str) -> bool {
        self.plain() == *text
    }
}

impl From<Part> for Wording {
    fn from(part: Part) -> Self {
        Wording { parts: vec![part] }
    }
}

impl From<String> for Wording {
    fn from(text: String) -> Self {
        Part::Text(text).into()
    }
}

impl From<&str> for Wording {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl From<Term> for Wording {
    fn from(term: Term) -> Self {
        Part::Term(term).into()
    }
}

impl From<Setting> for Wording {
    fn from(setting: Setting) -> Self {
        Term::Setting(setting).into()
    }
}

impl From<Command> for Wording {
    fn from(command: Command) -> Self {
        Term::Command(command, None).into()
    }
}

impl From<Feature> for Wording {
    fn from(feature: Feature) -> Self {
        Term::Build(feature).into()
    }
}

/// Makes a [`Wording`] of texts, settings and other terms, in order.
macro_rules! wording {
    ($($part:expr),+ $(,)?) => {{
        let mut wording = $crate::error::Wording::default();
        $(wording.push($part);)+
        wording
    }};
}
pub(crate) use wording;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_caller_has_names_for_terms() {
        let text = wording![
            "use ",
            Setting::MaxEdge.number("LENGTH"),
            " or ",
            format!("{}: ", 7),
            Command::Info
        ];
        assert_eq!(text.plain(), "use max-edge LENGTH or 7: `info`");
        assert_eq!(text.parts().len(), 4, "words in a row are one part");
        let name = |term: &Term| match term {
            Term::Number(setting, value) => format!("{}={value}", setting.name().replace('-', "_")),
            _ => "info()".to_owned(),
        };
        assert_eq!(text.render(&name), "use max_edge=LENGTH or 7: info()");
    }

    #[test]
    fn texts_are_nested_and_joined() {
        let settings = [Setting::WallBottom, Setting::WallDrop].map(Wording::from);
        let text = wording!["give ", Wording::join(settings, " or "), "!"];
        assert_eq!(text, "give wall-bottom or wall-drop!");
        assert_eq!(Wording::join([], ", "), "");
    }
}

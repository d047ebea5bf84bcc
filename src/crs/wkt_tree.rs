//! WKT as a tree: keywords with texts, numbers and nested nodes. Independent of coordinate systems.

use crate::error::{Error, Result};

/// A node: `KEYWORD["text", 1.5, NESTED[..]]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    /// In capitals.
    pub(super) keyword: String,
    pub(super) values: Vec<Value>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Text(String),
    Number(f64),
    /// A bare word: `EAST`, `ellipsoidal`.
    Word(String),
    Node(Node),
}

/// The largest depth. Definitions are about six deep.
const DEEPEST: usize = 32;

/// The largest length. The longest definition of a registry has about 4 kB.
const LONGEST: usize = 1 << 20;

impl Node {
    /// Parses one node, and further ones after commas (Esri appends `,VERTCS[..]`).
    ///
    /// # Errors
    /// If the text is not of this form; the error names the location.
    pub(super) fn parse_all(text: &str) -> Result<Vec<Node>> {
        let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0' || c == '\u{feff}');
        if text.len() > LONGEST {
            return Err(Error::limit(format!(
                "WKT of {} bytes, expected at most {LONGEST}",
                text.len()
            )));
        }
        let mut reader = WktReader { text, at: 0 };
        let mut nodes = Vec::new();
        loop {
            match reader.value(0)? {
                Value::Node(node) => nodes.push(node),
                other => {
                    return Err(reader.error(&format!("found {other:?}, expected KEYWORD[...]")));
                }
            }
            if !reader.eat(",") {
                break;
            }
        }
        // An extra closing bracket is a common mistake, and harmless.
        while reader.eat("]") || reader.eat(")") {}
        reader.blanks();
        if reader.at < text.len() {
            return Err(reader.error("there is text after the closing bracket"));
        }
        Ok(nodes)
    }

    /// The nested nodes.
    pub(super) fn nodes(&self) -> impl DoubleEndedIterator<Item = &Node> {
        self.values.iter().filter_map(|value| match value {
            Value::Node(node) => Some(node),
            _ => None,
        })
    }

    /// The first nested node with one of these keywords.
    pub(super) fn find(&self, keywords: &[&str]) -> Option<&Node> {
        self.nodes()
            .find(|node| keywords.contains(&node.keyword.as_str()))
    }

    /// The first text, which is the name.
    pub(super) fn name(&self) -> &str {
        match self.values.first() {
            Some(Value::Text(text) | Value::Word(text)) => text,
            _ => "",
        }
    }

    /// The `index`th number.
    pub(super) fn number(&self, index: usize) -> Option<f64> {
        self.values
            .iter()
            .filter_map(|value| match value {
                Value::Number(number) => Some(*number),
                _ => None,
            })
            .nth(index)
    }

    /// The code of `AUTHORITY["EPSG","1234"]` or `ID["EPSG",1234]` directly in this node.
    pub(super) fn epsg(&self) -> Option<u32> {
        // WKT 1 puts it last. So one that is here because of a missing bracket does not take
        // precedence.
        self.nodes()
            .rev()
            .find_map(|node| {
                let is_epsg = matches!(node.keyword.as_str(), "AUTHORITY" | "ID")
                    && node.name().eq_ignore_ascii_case("EPSG");
                match node.values.get(1).filter(|_| is_epsg)? {
                    Value::Text(code) | Value::Word(code) => code.trim().parse().ok(),
                    Value::Number(code) => Some(*code as u32).filter(|n| f64::from(*n) == *code),
                    Value::Node(_) => None,
                }
            })
            .filter(|&code| code > 0)
    }
}

struct WktReader<'a> {
    text: &'a str,
    at: usize,
}

impl WktReader<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn blanks(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn eat(&mut self, token: &str) -> bool {
        self.blanks();
        let found = self.rest().starts_with(token);
        if found {
            self.at += token.len();
        }
        found
    }

    fn error(&self, what: &str) -> Error {
        let near: String = self.rest().chars().take(24).collect();
        Error::format(format!(
            "not WKT of a coordinate system: {what}, at character {} (\"{near}\")",
            self.at
        ))
    }

    fn value(&mut self, depth: usize) -> Result<Value> {
        if depth > DEEPEST {
            return Err(self.error(&format!("nested more than {DEEPEST} deep")));
        }
        if self.eat("\"") {
            return self.quoted().map(Value::Text);
        }
        let end = self
            .rest()
            .find(|c: char| !(c.is_alphanumeric() || "_+-.:/".contains(c)))
            .unwrap_or(self.rest().len());
        let word = self.rest()[..end].to_owned();
        if word.is_empty() {
            return Err(self.error("a keyword, a number or a text in quotes was expected"));
        }
        self.at += end;
        let close = if self.eat("[") {
            "]"
        } else if self.eat("(") {
            ")"
        } else {
            return Ok(match word.parse() {
                // "inf" and "nan" are not numbers in WKT.
                Ok(number) if f64::is_finite(number) => Value::Number(number),
                _ => Value::Word(word),
            });
        };
        let mut node = Node {
            keyword: word.to_ascii_uppercase(),
            values: Vec::new(),
        };
        if self.eat(close) {
            return Ok(Value::Node(node));
        }
        loop {
            node.values.push(self.value(depth + 1)?);
            if self.eat(close) {
                return Ok(Value::Node(node));
            }
            if !self.eat(",") {
                return Err(self.error(&format!("\",\" or \"{close}\" was expected")));
            }
        }
    }

    /// Reads a text after its opening quote; a doubled quote stands for one.
    fn quoted(&mut self) -> Result<String> {
        let mut text = String::new();
        loop {
            let Some(end) = self.rest().find('"') else {
                return Err(self.error("a text in quotes does not end"));
            };
            text.push_str(&self.rest()[..end]);
            self.at += end + 1;
            if !self.rest().starts_with('"') {
                return Ok(text);
            }
            text.push('"');
            self.at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Node, Value};

    #[test]
    fn reads_both_brackets_quotes_and_codes() {
        let nodes = Node::parse_all(
            " A [ \"x \"\"y\"\"\" , -1.5e3, B(EAST),AUTHORITY[\"EPSG\",\"12\"] ] \0",
        )
        .unwrap();
        assert_eq!(nodes.len(), 1);
        assert_eq!(nodes[0].name(), "x \"y\"");
        assert_eq!(nodes[0].number(0), Some(-1500.0));
        assert_eq!(
            nodes[0].find(&["B"]).unwrap().values,
            [Value::Word("EAST".into())]
        );
        assert_eq!(nodes[0].epsg(), Some(12));
        assert_eq!(Node::parse_all("A[1],B[2]").unwrap().len(), 2);
    }

    #[test]
    fn damage_is_an_error_with_the_place() {
        for text in [
            "", "A", "A[", "A[\"x", "A[1", "A[1}", "A[1],", "[1]", "A[1]x", "A[,]", "\"A\"", "A[é",
        ] {
            let error = Node::parse_all(text).unwrap_err().to_string();
            assert!(error.contains("at character"), "{text}: {error}");
        }
        assert!(Node::parse_all(&"A[".repeat(100_000)).is_err());
    }
}

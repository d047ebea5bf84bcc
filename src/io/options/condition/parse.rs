//! From words to a tree.

use super::lex::{self, Compare, Located, Token, wrong};
use crate::error::{Error, Result};

/// Limit for parentheses and `NOT` within each other.
const MAX_DEPTH: usize = 64;

/// A value: that of an attribute, by its name or its position, or a given one.
#[derive(Debug, Clone)]
pub(super) enum Operand<C> {
    Column(C),
    Null,
    Whole(i64),
    Number(f64),
    Text(String),
}

/// A condition, or a part of it.
#[derive(Debug, Clone)]
pub(super) enum Node<C> {
    All(Vec<Node<C>>),
    Any(Vec<Node<C>>),
    Not(Box<Node<C>>),
    Compare(Operand<C>, Compare, Operand<C>),
    /// One of several values.
    In(Operand<C>, Vec<Operand<C>>),
    Between(Operand<C>, Operand<C>, Operand<C>),
    Like {
        value: Operand<C>,
        pattern: Operand<C>,
        any_case: bool,
    },
    IsNull(Operand<C>),
}

impl<C> Operand<C> {
    fn map<D>(&self, find: &impl Fn(&C) -> Result<D>) -> Result<Operand<D>> {
        Ok(match self {
            Operand::Column(column) => Operand::Column(find(column)?),
            Operand::Null => Operand::Null,
            Operand::Whole(whole) => Operand::Whole(*whole),
            Operand::Number(number) => Operand::Number(*number),
            Operand::Text(text) => Operand::Text(text.clone()),
        })
    }
}

impl<C> Node<C> {
    /// Returns the same condition with other names of attributes.
    ///
    /// # Errors
    /// The first of `find`.
    pub(super) fn map<D>(&self, find: &impl Fn(&C) -> Result<D>) -> Result<Node<D>> {
        let each = |nodes: &[Node<C>]| -> Result<Vec<Node<D>>> {
            nodes.iter().map(|node| node.map(find)).collect()
        };
        Ok(match self {
            Node::All(nodes) => Node::All(each(nodes)?),
            Node::Any(nodes) => Node::Any(each(nodes)?),
            Node::Not(node) => Node::Not(Box::new(node.map(find)?)),
            Node::Compare(a, compare, b) => Node::Compare(a.map(find)?, *compare, b.map(find)?),
            Node::In(value, list) => {
                let list = list.iter().map(|one| one.map(find));
                Node::In(value.map(find)?, list.collect::<Result<_>>()?)
            }
            Node::Between(value, low, high) => {
                Node::Between(value.map(find)?, low.map(find)?, high.map(find)?)
            }
            Node::Like {
                value,
                pattern,
                any_case,
            } => Node::Like {
                value: value.map(find)?,
                pattern: pattern.map(find)?,
                any_case: *any_case,
            },
            Node::IsNull(value) => Node::IsNull(value.map(find)?),
        })
    }
}

pub(super) fn parse(text: &str) -> Result<Node<String>> {
    let mut parser = Parser {
        text,
        tokens: lex::split(text)?,
        next: 0,
        depth: 0,
    };
    let root = parser.any()?;
    match parser.next == parser.tokens.len() {
        true => Ok(root),
        false => Err(parser.expected("AND, OR or the end")),
    }
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Located>,
    next: usize,
    /// How many parentheses and `NOT` are around the next word.
    depth: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|found| &found.token)
    }

    /// Takes the next word if it is this one.
    fn takes(&mut self, wanted: &Token) -> bool {
        let is_it = self.peek() == Some(wanted);
        self.next += usize::from(is_it);
        is_it
    }

    /// Takes the next word if it is this keyword, in any case.
    fn takes_word(&mut self, keyword: &str) -> bool {
        let is_it =
            matches!(self.peek(), Some(Token::Word(word)) if word.eq_ignore_ascii_case(keyword));
        self.next += usize::from(is_it);
        is_it
    }

    fn expected(&self, what: &str) -> Error {
        match self.tokens.get(self.next) {
            Some(Located { at, written, .. }) => {
                let found = &self.text[written.clone()];
                wrong(self.text, *at, format!("expected {what}, found {found}"))
            }
            None => {
                let end = self.text.chars().count() + 1;
                wrong(self.text, end, format!("expected {what}, found the end"))
            }
        }
    }

    fn any(&mut self) -> Result<Node<String>> {
        let mut nodes = vec![self.all()?];
        while self.takes_word("OR") {
            nodes.push(self.all()?);
        }
        Ok(match nodes.len() {
            1 => nodes.remove(0),
            _ => Node::Any(nodes),
        })
    }

    fn all(&mut self) -> Result<Node<String>> {
        let mut nodes = vec![self.negated()?];
        while self.takes_word("AND") {
            nodes.push(self.negated()?);
        }
        Ok(match nodes.len() {
            1 => nodes.remove(0),
            _ => Node::All(nodes),
        })
    }

    fn negated(&mut self) -> Result<Node<String>> {
        if self.depth == MAX_DEPTH {
            let deep = format!("more than {MAX_DEPTH} parentheses and NOT within each other");
            let at = self.tokens.get(self.next).map_or(1, |found| found.at);
            return Err(wrong(self.text, at, deep));
        }
        self.depth += 1;
        let node = if self.takes_word("NOT") {
            Node::Not(Box::new(self.negated()?))
        } else if self.takes(&Token::Open) {
            let inner = self.any()?;
            self.require(&Token::Close, "AND, OR or )")?;
            inner
        } else {
            self.comparison()?
        };
        self.depth -= 1;
        Ok(node)
    }

    fn require(&mut self, token: &Token, name: &str) -> Result<()> {
        match self.takes(token) {
            true => Ok(()),
            false => Err(self.expected(name)),
        }
    }

    fn require_word(&mut self, keyword: &str) -> Result<()> {
        match self.takes_word(keyword) {
            true => Ok(()),
            false => Err(self.expected(keyword)),
        }
    }

    fn comparison(&mut self) -> Result<Node<String>> {
        let value = self.operand()?;
        if let Some(&Token::Compare(compare)) = self.peek() {
            self.next += 1;
            return Ok(Node::Compare(value, compare, self.operand()?));
        }
        if self.takes_word("IS") {
            let is_not = self.takes_word("NOT");
            self.require_word("NULL")?;
            return Ok(negated_if(is_not, Node::IsNull(value)));
        }
        let is_not = self.takes_word("NOT");
        let node = if self.takes_word("IN") {
            self.require(&Token::Open, "(")?;
            let mut list = vec![self.operand()?];
            while self.takes(&Token::Comma) {
                list.push(self.operand()?);
            }
            self.require(&Token::Close, "a comma or )")?;
            Node::In(value, list)
        } else if self.takes_word("BETWEEN") {
            let low = self.operand()?;
            self.require_word("AND")?;
            Node::Between(value, low, self.operand()?)
        } else {
            let any_case = self.takes_word("ILIKE");
            if !any_case && !self.takes_word("LIKE") {
                let what = match is_not {
                    true => "IN, BETWEEN or LIKE",
                    false => "a comparison such as =, IN, LIKE or IS NULL",
                };
                return Err(self.expected(what));
            }
            Node::Like {
                value,
                pattern: self.operand()?,
                any_case,
            }
        };
        Ok(negated_if(is_not, node))
    }

    fn operand(&mut self) -> Result<Operand<String>> {
        const WHAT: &str = "an attribute or a value";
        let sign = match self.peek() {
            Some(Token::Minus) => -1,
            Some(Token::Plus) => 1,
            _ => 0,
        };
        if sign != 0 {
            self.next += 1;
        }
        let operand = match self.peek() {
            Some(Token::Whole(whole)) => Operand::Whole(if sign < 0 { -*whole } else { *whole }),
            // The smallest whole number has no positive one.
            Some(Token::Number(number)) if sign < 0 && *number == 2.0_f64.powi(63) => {
                Operand::Whole(i64::MIN)
            }
            Some(Token::Number(number)) => {
                Operand::Number(if sign < 0 { -*number } else { *number })
            }
            _ if sign != 0 => return Err(self.expected("a number")),
            Some(Token::Text(text)) => Operand::Text(text.clone()),
            Some(Token::Name(name)) => Operand::Column(name.clone()),
            Some(Token::Word(word)) => match word.to_ascii_uppercase().as_str() {
                "NULL" => Operand::Null,
                "TRUE" => Operand::Whole(1),
                "FALSE" => Operand::Whole(0),
                "AND" | "OR" | "NOT" | "IN" | "LIKE" | "ILIKE" | "IS" | "BETWEEN" => {
                    let error = self.expected(WHAT);
                    return Err(error.cure("an attribute of this name needs double quotes"));
                }
                _ => Operand::Column(word.clone()),
            },
            _ => return Err(self.expected(WHAT)),
        };
        self.next += 1;
        Ok(operand)
    }
}

fn negated_if(is_not: bool, node: Node<String>) -> Node<String> {
    match is_not {
        true => Node::Not(Box::new(node)),
        false => node,
    }
}

//! The three truths of a condition: true, false, and `None` for unknown.

use std::cmp::Ordering;
use std::fmt;

use super::lex::{Compare, number_end};
use super::parse::{Node, Operand};
use crate::data::Value;

type Truth = Option<bool>;

/// A value that is compared.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scalar<'a> {
    Null,
    Whole(i64),
    Number(f64),
    Text(&'a str),
}

/// A number and a text that is none, of which the order is asked for.
#[derive(Debug)]
pub(super) struct Mixed(String);

impl fmt::Display for Mixed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

pub(super) fn holds(node: &Node<usize>, row: &[Value]) -> Result<Truth, Mixed> {
    let compared = |a: Scalar, compare, b: Scalar| compared(a, compare, b);
    let of = |operand| scalar(operand, row);
    Ok(match node {
        Node::All(nodes) => decided(nodes, row, false)?,
        Node::Any(nodes) => decided(nodes, row, true)?,
        Node::Not(node) => holds(node, row)?.map(|truth| !truth),
        Node::Compare(a, compare, b) => compared(of(a), *compare, of(b))?,
        Node::In(value, list) => {
            let value = of(value);
            let mut found = Some(false);
            for one in list {
                found = match compared(value, Compare::Equal, of(one))? {
                    Some(true) => return Ok(Some(true)),
                    Some(false) => found,
                    None => None,
                };
            }
            found
        }
        Node::Between(value, low, high) => {
            let value = of(value);
            let from = compared(value, Compare::AtLeast, of(low))?;
            match from {
                Some(false) => from,
                _ => match compared(value, Compare::AtMost, of(high))? {
                    Some(false) => Some(false),
                    to => from.and(to),
                },
            }
        }
        Node::Like {
            value,
            pattern,
            any_case,
        } => match (text(of(value)), text(of(pattern))) {
            (Some(value), Some(pattern)) => Some(match any_case {
                true => is_like(&value.to_lowercase(), &pattern.to_lowercase()),
                false => is_like(&value, &pattern),
            }),
            _ => None,
        },
        Node::IsNull(value) => Some(of(value) == Scalar::Null),
    })
}

/// Returns `decisive` if one of several is, else false, true or unknown as SQL has it. What comes
/// behind the one that decides is not evaluated.
fn decided(nodes: &[Node<usize>], row: &[Value], decisive: bool) -> Result<Truth, Mixed> {
    let mut result = Some(!decisive);
    for node in nodes {
        match holds(node, row)? {
            Some(truth) if truth == decisive => return Ok(Some(decisive)),
            Some(_) => {}
            None => result = None,
        }
    }
    Ok(result)
}

fn scalar<'a>(operand: &'a Operand<usize>, row: &'a [Value]) -> Scalar<'a> {
    match operand {
        Operand::Null => Scalar::Null,
        Operand::Whole(whole) => Scalar::Whole(*whole),
        Operand::Number(number) => Scalar::Number(*number),
        Operand::Text(text) => Scalar::Text(text),
        Operand::Column(at) => match row.get(*at) {
            None | Some(Value::Missing) => Scalar::Null,
            Some(Value::Whole(whole)) => Scalar::Whole(*whole),
            // What is no number is none, as in a database.
            Some(Value::Number(number)) if number.is_nan() => Scalar::Null,
            Some(Value::Number(number)) => Scalar::Number(*number),
            Some(Value::Text(text)) => Scalar::Text(text),
            Some(Value::Truth(truth)) => Scalar::Whole(i64::from(*truth)),
        },
    }
}

fn text(scalar: Scalar) -> Option<String> {
    match scalar {
        Scalar::Null => None,
        Scalar::Whole(whole) => Some(whole.to_string()),
        Scalar::Number(number) => Some(number.to_string()),
        Scalar::Text(text) => Some(text.to_owned()),
    }
}

fn compared(a: Scalar, compare: Compare, b: Scalar) -> Result<Truth, Mixed> {
    let order = match (a, b) {
        (Scalar::Null, _) | (_, Scalar::Null) => return Ok(None),
        (Scalar::Text(a), Scalar::Text(b)) => Some(a.cmp(b)),
        (Scalar::Text(a), b) => number_in(a).map(|a| ordered(a, b)),
        (a, Scalar::Text(b)) => number_in(b).map(|b| ordered(a, b)),
        (a, b) => Some(ordered(a, b)),
    };
    let Some(order) = order else {
        return match compare {
            Compare::Equal => Ok(Some(false)),
            Compare::Unequal => Ok(Some(true)),
            _ => Err(Mixed(format!("{} and {}", shown(a), shown(b)))),
        };
    };
    Ok(Some(match compare {
        Compare::Equal => order.is_eq(),
        Compare::Unequal => order.is_ne(),
        Compare::Less => order.is_lt(),
        Compare::AtMost => order.is_le(),
        Compare::Greater => order.is_gt(),
        Compare::AtLeast => order.is_ge(),
    }))
}

fn shown(scalar: Scalar) -> String {
    /// Limit for the characters of a text in a message.
    const MOST: usize = 60;
    match scalar {
        Scalar::Text(text) => format!("'{}'", text.chars().take(MOST).collect::<String>()),
        other => text(other).unwrap_or_default(),
    }
}

/// Returns the number that a text is, with blanks around it.
fn number_in(text: &str) -> Option<Scalar<'static>> {
    let text = text.trim();
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    if digits.is_empty() || number_end(digits.as_bytes()) != digits.len() {
        return None;
    }
    match text.parse() {
        Ok(whole) => Some(Scalar::Whole(whole)),
        Err(_) => Some(Scalar::Number(text.parse().ok()?)),
    }
}

/// Returns the order of two numbers, exactly; none of them is NaN.
fn ordered(a: Scalar, b: Scalar) -> Ordering {
    match (a, b) {
        (Scalar::Whole(a), Scalar::Whole(b)) => a.cmp(&b),
        (Scalar::Number(a), Scalar::Number(b)) => a.partial_cmp(&b).unwrap_or(Ordering::Equal),
        (Scalar::Whole(a), Scalar::Number(b)) => whole_to_number(a, b),
        (Scalar::Number(a), Scalar::Whole(b)) => whole_to_number(b, a).reverse(),
        _ => Ordering::Equal, // texts and missing values are no numbers
    }
}

/// Returns the order of a whole number and a number.
fn whole_to_number(whole: i64, number: f64) -> Ordering {
    const BEYOND: f64 = 9_223_372_036_854_775_808.0; // 2^63
    if number >= BEYOND {
        Ordering::Less
    } else if number < -BEYOND {
        Ordering::Greater
    } else {
        // The part before the point is exact, and decides unless it is equal.
        let before = number.trunc();
        let by_fraction = || before.partial_cmp(&number).unwrap_or(Ordering::Equal);
        whole.cmp(&(before as i64)).then_with(by_fraction)
    }
}

/// Returns true if a text is like a pattern, in which `%` stands for any characters and `_` for
/// one.
fn is_like(text: &str, pattern: &str) -> bool {
    let (text, pattern): (Vec<char>, Vec<char>) =
        (text.chars().collect(), pattern.chars().collect());
    let (mut t, mut p) = (0, 0);
    // Behind the last `%`, and how much of the text it stands for up to.
    let mut last: Option<(usize, usize)> = None;
    while t < text.len() {
        match pattern.get(p) {
            Some('%') => {
                p += 1;
                last = Some((p, t));
            }
            Some(&sign) if sign == '_' || sign == text[t] => {
                p += 1;
                t += 1;
            }
            _ => match &mut last {
                Some((behind, covered)) => {
                    *covered += 1;
                    (p, t) = (*behind, *covered);
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|&sign| sign == '%')
}

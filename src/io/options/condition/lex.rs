//! The words of a condition.

use crate::error::{Error, Result};

const EXAMPLE: &str = "write it as in kind = 'toe' AND (height > 2.5 OR height IS NULL)";

/// How two values are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compare {
    Equal,
    Unequal,
    Less,
    AtMost,
    Greater,
    AtLeast,
}

/// A word of a condition.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    /// A bare name or a keyword.
    Word(String),
    /// A name in double quotes.
    Name(String),
    Text(String),
    Whole(i64),
    Number(f64),
    Compare(Compare),
    Minus,
    Plus,
    Open,
    Close,
    Comma,
}

/// A word, and where it is in the text: the position of its first character, counted from 1, and
/// its bytes.
#[derive(Debug, Clone)]
pub(super) struct Located {
    pub(super) token: Token,
    pub(super) at: usize,
    pub(super) written: std::ops::Range<usize>,
}

/// Returns the error for a text that is no condition, with the character where it is wrong.
#[cold]
pub(super) fn wrong(text: &str, at: usize, what: String) -> Error {
    Error::usage(format!("condition `{text}`, character {at}: {what}")).cure(EXAMPLE)
}

/// Splits a text into its words.
///
/// # Errors
/// If a quote is not closed, or a character has no meaning.
pub(super) fn split(text: &str) -> Result<Vec<Located>> {
    let mut tokens = Vec::new();
    let (mut start, mut at) = (0, 1);
    while let Some(first) = text[start..].chars().next() {
        let rest = &text[start..];
        if first.is_whitespace() {
            start += first.len_utf8();
            at += 1;
            continue;
        }
        let (token, length) = match first {
            '\'' => {
                let (inner, length) = quoted(text, rest, first, at)?;
                (Token::Text(inner), length)
            }
            '"' => {
                let (inner, length) = quoted(text, rest, first, at)?;
                (Token::Name(inner), length)
            }
            _ => plain(rest, first).ok_or_else(|| {
                let cure =
                    "texts are in single quotes, names with blanks or signs in double quotes";
                wrong(text, at, format!("`{first}` has no meaning")).cure(cure)
            })?,
        };
        tokens.push(Located {
            token,
            at,
            written: start..start + length,
        });
        at += rest[..length].chars().count();
        start += length;
    }
    Ok(tokens)
}

/// Returns what is within quotes, where a doubled quote stands for one, and the bytes of the whole.
fn quoted(text: &str, rest: &str, quote: char, at: usize) -> Result<(String, usize)> {
    let mut inner = String::new();
    let mut signs = rest.char_indices().skip(1).peekable();
    while let Some((i, sign)) = signs.next() {
        if sign != quote {
            inner.push(sign);
        } else if signs.next_if(|&(_, next)| next == quote).is_some() {
            inner.push(quote);
        } else {
            return Ok((inner, i + 1));
        }
    }
    Err(wrong(text, at, format!("the quote {quote} is not closed")))
}

/// Returns the word at the beginning of a text, and its bytes; `None` if there is none.
fn plain(rest: &str, first: char) -> Option<(Token, usize)> {
    let signs = [
        ("<>", Token::Compare(Compare::Unequal)),
        ("!=", Token::Compare(Compare::Unequal)),
        ("<=", Token::Compare(Compare::AtMost)),
        (">=", Token::Compare(Compare::AtLeast)),
        ("==", Token::Compare(Compare::Equal)),
        ("=", Token::Compare(Compare::Equal)),
        ("<", Token::Compare(Compare::Less)),
        (">", Token::Compare(Compare::Greater)),
        ("-", Token::Minus),
        ("+", Token::Plus),
        ("(", Token::Open),
        (")", Token::Close),
        (",", Token::Comma),
    ];
    if let Some((sign, token)) = signs.into_iter().find(|(sign, _)| rest.starts_with(sign)) {
        return Some((token, sign.len()));
    }
    let is_inside = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    if first.is_alphabetic() || first == '_' {
        let end = rest.find(|c| !is_inside(c)).unwrap_or(rest.len());
        return Some((Token::Word(rest[..end].to_owned()), end));
    }
    let end = number_end(rest.as_bytes());
    // `5m` is no number and no name.
    if end == 0 || rest[end..].starts_with(is_inside) {
        return None;
    }
    let number = &rest[..end];
    let token = match number.parse() {
        Ok(whole) => Token::Whole(whole),
        Err(_) => Token::Number(number.parse().ok()?),
    };
    Some((token, end))
}

/// Returns the end of the number at the beginning of a text: digits, a point, an exponent; 0 if
/// there is none.
pub(super) fn number_end(text: &[u8]) -> usize {
    let digits = |from: usize| {
        let rest = text[from..].iter();
        from + rest.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let mut end = digits(0);
    let mut count = end;
    if text.get(end) == Some(&b'.') {
        let fraction = digits(end + 1);
        count += fraction - end - 1;
        end = fraction;
    }
    if count == 0 {
        return 0;
    }
    if matches!(text.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(text.get(end + 1), Some(b'-' | b'+')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

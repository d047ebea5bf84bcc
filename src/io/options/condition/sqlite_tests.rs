//! SQLite as the judge: the same conditions about the same rows of a table.

use rusqlite::types::Value as Cell;
use rusqlite::{Connection, params_from_iter};
use testkit::random::Random;

use super::*;

const NAMES: [&str; 4] = ["kind", "note", "width", "n"];
const TEXTS: [&str; 8] = ["", "toe", "Toe", "top", "t", "to%", "é", "it's"];
const NUMBERS: [&str; 9] = [
    "0",
    "1",
    "-1",
    "2.5",
    "-0.0",
    "1e3",
    "9007199254740993",
    "-9223372036854775808",
    "9007199254740992.0",
];

fn one<'a>(random: &mut Random, of: &[&'a str]) -> &'a str {
    of[random.index(of.len())]
}

fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}

/// Returns a value of texts: `NULL` at times.
fn a_text(random: &mut Random) -> String {
    match random.index(8) {
        0 => "NULL".to_owned(),
        1 => one(random, &NAMES[..2]).to_owned(),
        _ => quoted(one(random, &TEXTS)),
    }
}

fn a_number(random: &mut Random) -> String {
    match random.index(8) {
        0 => "null".to_owned(),
        1 => one(random, &NAMES[2..]).to_owned(),
        // A number in quotes is one beside an attribute of numbers.
        2 => quoted(one(random, &NUMBERS)),
        _ => one(random, &NUMBERS).to_owned(),
    }
}

fn comparison(random: &mut Random) -> String {
    let is_text = random.index(2) == 0;
    let value = |random: &mut Random| {
        if is_text {
            a_text(random)
        } else {
            a_number(random)
        }
    };
    let column = match is_text {
        true => one(random, &NAMES[..2]),
        false => one(random, &NAMES[2..]),
    };
    let not = one(random, &["", " NOT"]);
    match random.index(6) {
        0 => format!("{column} IS{not} NULL"),
        1 => {
            let list: Vec<String> = (0..1 + random.index(3)).map(|_| value(random)).collect();
            format!("{column}{not} IN ({})", list.join(", "))
        }
        2 => format!(
            "{column}{not} BETWEEN {} AND {}",
            value(random),
            value(random)
        ),
        3 if is_text => {
            let pattern = one(
                random,
                &["%", "t%", "_", "%o%", "T__", "t_%e", "%%", "", "%é", "to%"],
            );
            format!("{column}{not} LIKE {}", quoted(pattern))
        }
        _ => {
            let compare = one(random, &["=", "<>", "!=", "<", "<=", ">", ">=", "=="]);
            match random.index(2) {
                0 => format!("{column} {compare} {}", value(random)),
                _ => format!("{} {compare} {column}", value(random)),
            }
        }
    }
}

fn condition(random: &mut Random, depth: usize) -> String {
    match random.index(if depth == 0 { 2 } else { 6 }) {
        0 | 1 => comparison(random),
        2 => format!("NOT {}", in_parentheses(random, depth - 1)),
        3 => format!("not {}", comparison(random)),
        n => {
            let glue = if n == 4 { " AND " } else { " or " };
            let parts: Vec<String> = (0..2 + random.index(2))
                .map(|_| match random.index(2) {
                    0 => condition(random, depth - 1),
                    _ => in_parentheses(random, depth - 1),
                })
                .collect();
            parts.join(glue)
        }
    }
}

fn in_parentheses(random: &mut Random, depth: usize) -> String {
    format!("({})", condition(random, depth))
}

fn a_row(random: &mut Random) -> Vec<Value> {
    let mut row = Vec::new();
    for column in 0..4 {
        row.push(match (random.index(5), column) {
            (0, _) => Value::Missing,
            (_, 0 | 1) => Value::Text(one(random, &TEXTS).to_owned()),
            (_, 2) => Value::Number(one(random, &NUMBERS).parse().unwrap()),
            _ => Value::Whole([0, 1, -1, 2, 1000, (1 << 53) + 1, i64::MIN][random.index(7)]),
        });
    }
    row
}

fn cell(value: &Value) -> Cell {
    match value {
        Value::Missing => Cell::Null,
        Value::Whole(whole) => Cell::Integer(*whole),
        Value::Number(number) => Cell::Real(*number),
        Value::Text(text) => Cell::Text(text.clone()),
        Value::Truth(truth) => Cell::Integer(i64::from(*truth)),
    }
}

#[test]
fn sqlite_chooses_the_same_records() {
    let random = &mut Random(3);
    let database = Connection::open_in_memory().unwrap();
    database
        .execute_batch(
            "PRAGMA case_sensitive_like = ON;
             CREATE TABLE t (id INTEGER PRIMARY KEY, kind TEXT, note TEXT, width REAL, n INTEGER);",
        )
        .unwrap();
    let rows: Vec<Vec<Value>> = (0..60).map(|_| a_row(random)).collect();
    for row in &rows {
        let insert = "INSERT INTO t VALUES (NULL, ?, ?, ?, ?)";
        let cells = row.iter().map(cell);
        database.execute(insert, params_from_iter(cells)).unwrap();
    }
    let names: Vec<String> = NAMES.map(str::to_owned).into();
    let mut chosen = 0;
    for _ in 0..5_000 {
        let text = condition(random, 3);
        let sql = format!("SELECT id FROM t WHERE {text} ORDER BY id");
        let mut statement = database
            .prepare(&sql)
            .unwrap_or_else(|e| panic!("{text}: {e}"));
        let expected: Vec<usize> = statement
            .query_map([], |row| row.get::<_, i64>(0).map(|id| id as usize - 1))
            .unwrap()
            .map(|id| id.unwrap())
            .collect();
        let condition = Condition::parse(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        let bound = condition.bind(&names).unwrap();
        let found: Vec<usize> = (0..rows.len())
            .filter(|&row| {
                bound
                    .holds(&rows[row])
                    .unwrap_or_else(|e| panic!("{text}: {e}"))
            })
            .collect();
        assert_eq!(found, expected, "{text}");
        chosen += found.len();
    }
    // Neither everything nor nothing.
    assert!((50_000..250_000).contains(&chosen), "{chosen}");
}

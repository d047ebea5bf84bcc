use testkit::random::Random;

use super::*;

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

/// Returns what a condition says of a record with a kind, a width, a note and a flag.
fn holds(condition: &str, row: &[Value]) -> Result<bool> {
    let condition = Condition::parse(condition)?;
    let names = names(&["kind", "Width", "my note", "flag"]);
    condition.bind(&names)?.holds(row)
}

#[test]
fn what_records_are_chosen() {
    let toe = [
        text("toe"),
        Value::Number(2.5),
        Value::Missing,
        Value::Truth(true),
    ];
    for condition in [
        "kind='toe'",
        "'toe' = kind",
        "kind == 'toe'",
        "KIND = 'toe' and WIDTH >= 2.5",
        "kind <> 'top' AND kind != 'Toe'",
        "NOT kind = 'top'",
        "kind IN ('top', 'toe')",
        "kind not in ('top')",
        "kind LIKE 't_e' AND kind like '%o%' AND kind NOT LIKE 'T%' AND kind ILIKE 'T%'",
        "\"my note\" IS NULL AND kind IS NOT NULL",
        "width BETWEEN 2 AND 2.5 AND NOT (width NOT BETWEEN 2 AND 3)",
        "width > -1e3 AND width > +.5 AND width < 3.",
        "flag = TRUE AND flag <> false AND flag = 1",
        "kind = 'x' OR kind = 'y' AND width = 1 OR width = '2.50'",
        "(kind = 'x' OR kind = 'toe') AND width = 2.5",
        "kind <> 5",
        "kind <> 'toe' AND kind > 5 OR width = 2.5",
    ] {
        assert!(holds(condition, &toe).unwrap(), "{condition}");
    }
    for condition in [
        // Unknown is not true, nor is its opposite.
        "\"my note\" = 'a'",
        "NOT \"my note\" = 'a'",
        "\"my note\" = NULL",
        "kind NOT IN ('top', NULL)",
        "kind = 5",
        "width IN (1, '2')",
    ] {
        assert!(!holds(condition, &toe).unwrap(), "{condition}");
    }
    // Values that a row lacks are missing.
    assert!(holds("kind IS NULL", &[]).unwrap());
}

#[test]
fn numbers_are_compared_exactly() {
    let row = |whole: i64| [Value::Missing, Value::Whole(whole)];
    let far = i64::MAX;
    assert!(holds("width < 9223372036854775808", &row(far)).unwrap());
    assert!(!holds("width = 9.223372036854775807e18", &row(far)).unwrap());
    assert!(holds("width = -9223372036854775808", &row(i64::MIN)).unwrap());
    assert!(holds("width > 9007199254740992.0", &row((1 << 53) + 1)).unwrap());
    assert!(holds("width > -3.5 AND width < -2.5", &row(-3)).unwrap());
}

#[test]
fn an_order_of_a_number_and_a_word_is_an_error() {
    let error = holds("kind > 5", &[text("none")]).unwrap_err();
    let expected = "condition `kind > 5`: 'none' and 5 has no order";
    assert_eq!(error.to_string(), expected);
    assert!(holds("kind > 5", &[text(" 12 ")]).unwrap());
    assert!(!holds("kind > '5'", &[text("12")]).unwrap());
}

#[test]
fn what_is_no_condition() {
    for (condition, expected) in [
        (
            "",
            "character 1: expected an attribute or a value, found the end",
        ),
        (
            "kind",
            "character 5: expected a comparison such as =, IN, LIKE or IS NULL, found the end",
        ),
        (
            "kind =",
            "character 7: expected an attribute or a value, found the end",
        ),
        ("kind = 'toe", "character 8: the quote ' is not closed"),
        (
            "é = 'a' b",
            "character 9: expected AND, OR or the end, found b",
        ),
        (
            "(kind = 1",
            "character 10: expected AND, OR or ), found the end",
        ),
        (
            "kind = 1 AND",
            "character 13: expected an attribute or a value, found the end",
        ),
        ("kind IN 1", "character 9: expected (, found 1"),
        (
            "kind IN (1",
            "character 11: expected a comma or ), found the end",
        ),
        (
            "kind NOT 1",
            "character 10: expected IN, BETWEEN or LIKE, found 1",
        ),
        ("kind IS 1", "character 9: expected NULL, found 1"),
        ("kind = -'a'", "character 9: expected a number, found 'a'"),
        (
            "and = 1",
            "character 1: expected an attribute or a value, found and",
        ),
        ("kind = 5m", "character 8: `5` has no meaning"),
        ("kind % 2", "character 6: `%` has no meaning"),
    ] {
        let error = Condition::parse(condition).unwrap_err().to_string();
        assert_eq!(error, format!("condition `{condition}`, {expected}"));
    }
    let deep = format!("{}kind = 1{}", "(".repeat(100), ")".repeat(100));
    let error = Condition::parse(&deep).unwrap_err().to_string();
    assert!(error.ends_with("more than 64 parentheses and NOT within each other"));
}

#[test]
fn an_attribute_that_does_not_exist() {
    let cure = |condition: &str, names: &[String]| {
        let condition = Condition::parse(condition).unwrap();
        let error = condition.bind(names).unwrap_err();
        (error.to_string(), error.cure_text().unwrap().plain())
    };
    let known = names(&["kind", "height"]);
    let (error, near) = cure("hight > 2", &known);
    assert_eq!(error, "condition `hight > 2`: there is no field hight");
    assert_eq!(near, "is \"height\" meant? The fields are kind, height");
    assert_eq!(cure("zone = 2", &known).1, "name one of kind, height");
    assert_eq!(
        cure("a = 1", &[]).1,
        "the layer has no fields to choose records by"
    );
}

#[test]
fn nothing_panics() {
    let random = &mut Random(17);
    let parts = [
        "kind",
        "\"my note\"",
        "'toe'",
        "''",
        "5",
        "-",
        "2.5e",
        ".",
        "(",
        ")",
        ",",
        "=",
        "<>",
        "<=",
        "AND",
        "or",
        "NOT",
        "IN",
        "like",
        "IS",
        "NULL",
        "BETWEEN",
        "'%_%'",
        " ",
        "é",
        "\"",
        "'",
        "\u{0}",
        "ilike",
        "9223372036854775808",
    ];
    let row = [
        text("toé"),
        Value::Number(f64::NAN),
        Value::Whole(i64::MIN),
        Value::Truth(false),
    ];
    let mut parsed = 0;
    for _ in 0..20_000 {
        let count = random.index(9);
        let words: Vec<&str> = (0..count)
            .map(|_| parts[random.index(parts.len())])
            .collect();
        let glue = ["", " "][random.index(2)];
        if let Ok(condition) = Condition::parse(&words.join(glue)) {
            parsed += 1;
            if let Ok(bound) = condition.bind(&names(&["kind", "a", "my note", "b"])) {
                let _ = bound.holds(&row);
            }
        }
    }
    assert!(parsed > 20, "{parsed}");
}

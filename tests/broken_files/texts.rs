//! Random texts of points, against a reader that does one thing after the other.

use std::path::Path;

use breakline::data::{PointBatch, PointSource};
use breakline::error::Wording;
use breakline::io::points::Options;
use breakline::io::text;
use testkit::random::Random;

/// A point as it is written, with a class.
struct Row {
    numbers: [String; 3],
    class: u8,
    note: &'static str,
}

/// What a text is written with.
struct Style {
    separator: &'static str,
    /// The decimal mark of each coordinate.
    marks: [char; 3],
    /// The columns of x, y, z, class and a note; `None` is left out.
    columns: Vec<Column>,
    has_header: bool,
    names: [&'static str; 3],
    end: &'static str,
    is_open: bool,
    quotes: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Column {
    Axis(usize),
    Class,
    Note,
}

/// What a reader should make of a text.
enum Expected {
    Points(Vec<[f64; 3]>),
    /// The two marks, each with a number.
    TwoMarks,
    /// The name of two columns.
    TwoNames(&'static str),
}

fn style(random: &mut Random) -> Style {
    let separator = random.pick(&[";", "\t", ",", " ", "; ", "  "]);
    let mark = if separator == "," {
        '.'
    } else {
        random.pick(&['.', ','])
    };
    let mut marks = [mark; 3];
    if separator != "," && random.below(3) == 0 {
        marks[random.index(3)] = if mark == '.' { ',' } else { '.' };
    }
    let mut columns: Vec<Column> = (0..3).map(Column::Axis).collect();
    let has_header = random.below(2) == 0;
    if has_header {
        if random.below(2) == 0 {
            columns.push(Column::Class);
        }
        // A blank separates nothing from a note that is not there.
        columns.extend((random.below(3) == 0).then_some(Column::Note));
        if random.below(4) == 0 {
            let axis = random.index(3);
            columns.push(Column::Axis(axis));
        }
        random.shuffle(&mut columns);
    }
    let names = [
        random.pick(&["x", "E", "Easting", "LON (deg)"]),
        random.pick(&["y", "N", "northing", "lat"]),
        random.pick(&["z", "H", "Elevation", "alt"]),
    ];
    Style {
        separator,
        marks,
        columns,
        has_header,
        // A unit has a blank.
        names: if separator.trim().is_empty() {
            ["easting", "north", "height"]
        } else {
            names
        },
        end: random.pick(&["\n", "\r\n", "\r"]),
        is_open: random.below(4) == 0,
        quotes: random.below(4) == 0,
    }
}

fn rows(random: &mut Random) -> Vec<Row> {
    let number = |random: &mut Random| {
        let digits = 1 + random.index(6);
        let whole = random.around(10_i64.pow(digits as u32));
        match random.index(4) {
            0 => whole.to_string(),
            decimals => format!(
                "{whole}.{:0decimals$}",
                random.below(10_u64.pow(decimals as u32))
            ),
        }
    };
    (0..1 + random.index(12))
        .map(|_| Row {
            numbers: [number(random), number(random), number(random)],
            class: random.below(32) as u8,
            note: random.pick(&["tree", "v1.2.3", "a,b.c", "house"]),
        })
        .collect()
}

/// Writes the text, and computes what it contains from what is written, word by word.
fn written(style: &Style, rows: &[Row]) -> (String, Expected) {
    let quoted = |text: String| {
        if style.quotes {
            format!("\"{text}\"")
        } else {
            text
        }
    };
    let mut lines = Vec::new();
    if style.has_header {
        let name = |column: &Column| match *column {
            Column::Axis(axis) => style.names[axis].to_owned(),
            Column::Class => "Classification".to_owned(),
            Column::Note => "note".to_owned(),
        };
        lines.push(
            style
                .columns
                .iter()
                .map(|column| quoted(name(column)))
                .collect::<Vec<_>>()
                .join(style.separator),
        );
    }
    let mut seen = Vec::new();
    for row in rows {
        let mut words = Vec::new();
        for column in &style.columns {
            words.push(match *column {
                Column::Axis(axis) => {
                    row.numbers[axis].replace('.', &style.marks[axis].to_string())
                }
                Column::Class => row.class.to_string(),
                Column::Note if style.separator == "," => row.note.replace(',', "-"),
                Column::Note => row.note.to_owned(),
            });
            if let (Column::Axis(_), Some(word)) = (column, words.last()) {
                seen.extend(word.chars().filter(|c| matches!(c, '.' | ',')));
            }
        }
        lines.push(
            words
                .into_iter()
                .map(quoted)
                .collect::<Vec<_>>()
                .join(style.separator),
        );
    }
    let mut text = lines.join(style.end);
    if !style.is_open {
        text.push_str(style.end);
    }
    let repeated = (0..3).find(|&axis| {
        style
            .columns
            .iter()
            .filter(|&&column| column == Column::Axis(axis))
            .count()
            > 1
    });
    let expected = match repeated {
        Some(axis) => Expected::TwoNames(style.names[axis]),
        None if seen.contains(&'.') && seen.contains(&',') => Expected::TwoMarks,
        None => {
            let points = rows
                .iter()
                .map(|row| [0, 1, 2].map(|axis| row.numbers[axis].parse().unwrap()));
            Expected::Points(points.collect())
        }
    };
    (text, expected)
}

/// Points, classes and warnings.
type Found = (Vec<[f64; 3]>, Vec<u8>, Vec<Wording>);

fn read(text: &str) -> breakline::Result<Found> {
    let stream = std::io::Cursor::new(text.as_bytes().to_vec());
    let mut reader = text::from_stream(stream, Path::new("random.txt"), Options::default())?;
    let (mut points, mut classes, mut batch) = (Vec::new(), Vec::new(), PointBatch::default());
    loop {
        reader.read(&mut batch)?;
        if batch.is_empty() {
            return Ok((points, classes, reader.warnings().to_vec()));
        }
        points.extend((0..batch.len()).map(|i| [batch.x[i], batch.y[i], batch.z[i]]));
        classes.append(&mut batch.class);
    }
}

#[test]
fn random_texts_give_their_points_or_say_why_not() {
    let mut counts = [0; 3];
    for seed in 0..crate::cases("BREAKLINE_TEXTS", 3000) {
        let mut random = Random(seed as u64);
        let (style, rows) = (style(&mut random), rows(&mut random));
        let (text, expected) = written(&style, &rows);
        let found = read(&text);
        match (&expected, &found) {
            (Expected::Points(points), Ok((found, classes, warnings))) => {
                counts[0] += 1;
                assert_eq!(found, points, "seed {seed}: {text:?}");
                if style.columns.contains(&Column::Class) {
                    assert_eq!(
                        *classes,
                        rows.iter().map(|row| row.class).collect::<Vec<_>>(),
                        "seed {seed}: {text:?}"
                    );
                }
                let is_open = warnings
                    .iter()
                    .any(|text| text.plain().contains("no line end"));
                assert_eq!(is_open, style.is_open, "seed {seed}: {text:?}");
            }
            (Expected::TwoMarks, Err(error)) => {
                counts[1] += 1;
                let error = error.to_string();
                let names_both = error.contains("has a comma") && error.contains("has a point");
                assert!(names_both, "seed {seed}: {text:?}: {error}");
            }
            (Expected::TwoNames(name), Err(error)) => {
                counts[2] += 1;
                let name = name.split(' ').next().unwrap().to_lowercase();
                assert!(
                    error
                        .to_string()
                        .contains(&format!("both called \"{name}\"")),
                    "seed {seed}: {text:?}: {error}"
                );
            }
            _ => panic!("seed {seed}: {text:?}: {found:?}"),
        }
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

use super::*;

fn read(text: &str) -> Result<(TextReader, PointBatch)> {
    let mut reader = from_stream(
        io::Cursor::new(text.as_bytes().to_vec()),
        "points.txt",
        Options::default(),
    )?;
    let (mut all, mut batch) = (PointBatch::default(), PointBatch::default());
    loop {
        reader.read(&mut batch)?;
        if batch.is_empty() {
            return Ok((reader, all));
        }
        all.x.append(&mut batch.x);
        all.y.append(&mut batch.y);
        all.z.append(&mut batch.z);
        all.class.append(&mut batch.class);
    }
}

fn points(text: &str) -> Vec<[f64; 3]> {
    let (_, all) = read(text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
    (0..all.len())
        .map(|i| [all.x[i], all.y[i], all.z[i]])
        .collect()
}

const TWO: [[f64; 3]; 2] = [[1.5, 2.25, -3.0], [4.0, 5.0, 6.5]];

#[test]
fn a_comment_of_more_words_than_fields_is_prose() {
    assert_eq!(
        points("# height is z of x and y\n1 2 3\n"),
        [[1.0, 2.0, 3.0]]
    );
    assert_eq!(points("# columns: y x z r\n1 2 3 0\n"), [[2.0, 1.0, 3.0]]);
    assert_eq!(
        points("# exported by Foo: id x y z\n7 1 2 3\n"),
        [[1.0, 2.0, 3.0]]
    );
    assert_eq!(points("# y x z\n1 2 3 0\n"), [[2.0, 1.0, 3.0]]);
}

#[test]
fn numbers_with_gaps_are_a_warning() {
    let warned = |text: &str| !read(text).unwrap().0.warnings().is_empty();
    assert!(warned(
        "101,5000.12,2000.5,33.1\n102,5001.5,2001,33.2\n104,5002,2002,33\n"
    ));
    assert!(warned("10 5000.12 2000.5 33.1\n9 5001.5 2001 33.2\n"));
    assert!(
        !warned("101 5000 2000 33.1\n104 5001 2001 33.2\n"),
        "a grid"
    );
    assert!(!warned("101.5 5000.12 2000.5 33.1\n104 5001.5 2001 33.2\n"));
    assert!(
        !warned("101 5000.12 33.1\n104 5001.5 33.2\n"),
        "three columns"
    );
}

#[test]
fn every_spelling_of_two_points() {
    for text in [
        "1.5 2.25 -3\n4 5 6.5\n",
        "1.5 2.25 -3\n4 5 6.5",
        "  1.5   2.25\t-3 7 8 \r\n\r\n 4 5 6.5\r\n",
        "\u{feff}1.5,2.25,-3\n4,5,6.5\n",
        "1.5, 2.25, -3, tree\n4, 5, 6.5, \"house, red\"\n",
        "1,5;2,25;-3\n4;5;6,5\n",
        "1,5\t2,25\t-3\n4\t5\t6,5\n",
        "1,5 2,25 -3,0\n4 5 6,5\n",
        "\"1.5\";\"2.25\";\"-3\"\n\"4\";\"5\";\"6.5\"\n",
        "# made by hand\n1.5 2.25 -3e0\n// a comment\n+4. 5 0.65e1\n",
        "x,y,z\n1.5,2.25,-3\n4,5,6.5\n",
        "id;Northing;Easting;Height [m]\nA;2,25;1,5;-3\nB;5;4;6,5\n",
        "LAT LON ELEVATION\n2.25 1.5 -3\n5 4 6.5\n",
        "//X Y Z R G B\n1.5 2.25 -3 0 0 0\n4 5 6.5 0 0 0\n",
        "# y x z\n# made by hand\n2.25,1.5,-3\n5,4,6.5\n",
        "x y z\n1.5,2.25,-3\n4,5,6.5\n",
        "2\n1.5 2.25 -3 100\n4 5 6.5 100\n",
        "z,name,\"x\",\"y\"\n-3,\"a,b\",1.5,2.25\n6.5,c,4,5\n",
        ",x,y,z\n,1.5,2.25,-3\n,4,5,6.5\n",
    ] {
        assert_eq!(points(text), TWO, "{text:?}");
    }
}

#[test]
fn what_the_file_says_of_itself() {
    let (reader, all) = read("E,N,H,Classification\n1,2,3,2\n1,2,3,9\n").unwrap();
    assert_eq!(all.class, [2, 9]);
    assert!(reader.info().has_classes);
    assert_eq!(
        reader.info().format,
        "text, separated by commas, with header"
    );
    let (reader, all) = read("2\n1 2 3\n4 5 6\n").unwrap();
    assert!(all.class.is_empty() && !reader.info().has_classes);
    assert_eq!(reader.info().count, Some(2));
    assert!(reader.warnings().is_empty());
    for empty in ["", "\n\n", "# nothing\n", "x y z\n"] {
        assert!(points(empty).is_empty());
    }
}

#[test]
fn any_line_end_ends_a_line() {
    let lines = ["x y z", "1.5 2.25 -3", "", "4 5 6.5"];
    for end in ["\n", "\r\n", "\r"] {
        assert_eq!(points(&format!("{}{end}", lines.join(end))), TWO, "{end:?}");
        let error = read(&["1 2 3", "4 5 6", "7 8"].join(end))
            .map(|_| ())
            .unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("points.txt: line 3: 2 fields"),
            "{error}"
        );
    }
    assert_eq!(points("1.5 2.25 -3 a\r4 5 6.5 b\n"), TWO);
    // A pair that two parts of the file share.
    for length in [(1 << 17) - 12, (1 << 17) - 11, (1 << 17) - 10] {
        let comments = format!("#{}\n", "-".repeat(62)).repeat(length / 64);
        let comment = format!("#{}\n", "-".repeat(length - comments.len() - 2));
        let text = format!("{comments}{comment}1.5 2.25 -3\r\n4 5 6.5\r\nx");
        let error = read(&text).map(|_| ()).unwrap_err().to_string();
        assert!(
            error.contains(&format!("line {}:", length / 64 + 4)),
            "{error}"
        );
    }
}

#[test]
fn a_last_line_without_an_end_is_a_warning() {
    for (text, count) in [
        ("1 2 3\n4 5 6\n", 0),
        ("1 2 3\n4 5 6\r", 0),
        ("1 2 3\n4 5 6", 1),
        ("1 2 3\n4 5 6\n# e", 0),
    ] {
        assert_eq!(read(text).unwrap().0.warnings().len(), count, "{text:?}");
    }
}

#[test]
fn numbers_with_a_comma_and_numbers_with_a_point_are_refused() {
    for (text, message) in [
        (
            "500,000;600,000;3.5\n",
            "line 1: 3.5 has a point and 500,000, in line 1, has a comma",
        ),
        (
            "500,000;600,000;3\n1;2;3\n1;2.5;3\n",
            "line 3: 2.5 has a point and 500,000, in line 1, has a comma",
        ),
        (
            "1 2.5 3\n1 2 3,5\n",
            "line 2: 3,5 has a comma and 2.5, in line 1, has a point",
        ),
        (
            "x;y;z;i\n\n500,000;600,000;3;0.5\n",
            "line 3: 0.5 has a point and 500,000, in line 3, has a comma",
        ),
        (
            "500.000\t600.000\t3,5\n",
            "line 1: 3,5 has a comma and 500.000, in line 1, has a point",
        ),
        (
            "500,5, 600,5, 3,5\n",
            "line 1: \"500,5, 600,5, 3,5\": commas separate numbers and stand before decimals",
        ),
    ] {
        let error = read(text).map(|_| ()).expect_err(text);
        assert!(
            error
                .to_string()
                .starts_with(&format!("points.txt: {message}")),
            "{error}"
        );
        assert!(error.cure_text().is_some(), "{error}");
    }
    assert_eq!(
        points("1,5;2,25;-3;v1.2;A.1;1.2.3\n4;5;6,5;;;\n"),
        TWO,
        "these are not numbers"
    );
    assert_eq!(points("1.5,2.25,-3\n4,5,6.5\n"), TWO);
}

#[test]
fn a_name_of_two_columns_is_refused() {
    for (text, message) in [
        (
            "x,y,z,z\n1,2,3,4\n",
            "line 1: columns 3 and 4 are both called \"z\" in the header \"x,y,z,z\"",
        ),
        (
            "Height (m);n;e;height [ft]\n1;2;3;4\n",
            "line 1: columns 1 and 4 are both called \"height\" in",
        ),
        (
            "x y x z\n1 2 3 4\n",
            "line 1: columns 1 and 3 are both called \"x\"",
        ),
        (
            "x y z class class\n1 2 3 4 5\n",
            "line 1: columns 4 and 5 are both called \"class\"",
        ),
        (
            "# x y z z\n1 2 3 4\n",
            "line 2: columns 3 and 4 are both called \"z\"",
        ),
        (
            "id,x,y,height,elev\n1,2,3,4,5\n",
            "line 1: columns 4 (\"height\") and 5 (\"elev\") all have names of heights in",
        ),
        (
            "# x y Alt h\n1 2 3 4\n",
            "line 2: columns 3 (\"alt\") and 4 (\"h\") all have names of heights",
        ),
    ] {
        let error = read(text).map(|_| ()).expect_err(text);
        assert!(
            error
                .to_string()
                .starts_with(&format!("points.txt: {message}")),
            "{error}"
        );
        assert!(error.cure_text().unwrap().plain().contains("columns"));
    }
    let columns = "1,2,4".parse().ok();
    let named = Options {
        columns,
        ..Options::default()
    };
    let mut reader =
        from_stream(io::Cursor::new("x,y,z,z\n1,2,3,4\n"), "points.txt", named).unwrap();
    let mut batch = PointBatch::default();
    reader.read(&mut batch).unwrap();
    assert_eq!(batch.z, [4.0]);
    // Other columns may share a name; of two names for an axis the first of the table counts.
    assert_eq!(points("x y z r r\n1 2 3 4 5\n"), [[1.0, 2.0, 3.0]]);
    assert_eq!(points("lon lat x y z\n1 2 3 4 5\n"), [[3.0, 4.0, 5.0]]);
    assert_eq!(points("x y h z\n1 2 3 4\n"), [[1.0, 2.0, 4.0]]);
}

#[test]
fn fewer_points_than_stated_are_an_error_unless_a_part_is_accepted() {
    let error = read("3\n1 2 3\n4 5 6\n").map(|_| ()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "points.txt: the end: the first line states 3 points, but there are 2"
    );
    assert!(error.cure_text().unwrap().plain().contains("partial"));
    let (reader, all) = read("1\n1 2 3\n4 5 6\n").unwrap();
    assert_eq!(
        (all.len(), reader.warnings()),
        (
            2,
            &["the first line states 1 points, but there are 2".into()][..]
        )
    );
}

#[test]
fn a_bad_line_is_named() {
    for (text, message) in [
        (
            "1 2 3\n4 5\n",
            "line 2: 2 fields separated by blanks, expected at least 3: \"4 5\"",
        ),
        (
            "1,2,3\n4,5,\n",
            "line 2: z is \"\", expected a finite number: \"4,5,\"",
        ),
        (
            "1;2;3\n\n4;x5;6\n",
            "line 3: y is \"x5\", expected a finite number: \"4;x5;6\"",
        ),
        (
            "1 2 3\n1 2 nan\n",
            "line 2: z is \"nan\", expected a finite number: \"1 2 nan\"",
        ),
        (
            "1 2 3\n1 inf 3\n",
            "line 2: y is \"inf\", expected a finite number: \"1 inf 3\"",
        ),
        (
            "P1 1 2 3\n",
            "line 1: x is \"P1\", expected a finite number: \"P1 1 2 3\"",
        ),
        (
            "east,north\n1,2\n",
            "line 1: \"east,north\" is neither a point nor a header",
        ),
        (
            "a,b,c\n1,2,3\n",
            "line 1: no column for x in the header \"a,b,c\"",
        ),
        (
            "ncols 5\nnrows 4\n",
            "line 1: \"ncols 5\" is neither a point nor a header",
        ),
        (
            "x,y,z,class\n1,2,3,2.5\n",
            "line 2: class is \"2.5\", expected a whole number from 0 to 255: \"1,2,3,2.5\"",
        ),
        ("\u{fffe}1 2 3", "line 1: x is"),
    ] {
        let error = read(text).map(|(_, all)| all.len()).expect_err(text);
        assert!(
            error
                .to_string()
                .starts_with(&format!("points.txt: {message}")),
            "{error}"
        );
        assert!(error.cure_text().is_some(), "{error}");
    }
}

#[test]
fn points_before_a_bad_line_are_handed_out() {
    let mut text = "1 2 3\n".repeat(BATCH + 10);
    text.push_str("end\n");
    let mut reader = from_stream(
        io::Cursor::new(text.into_bytes()),
        "points.txt",
        Options::default(),
    )
    .unwrap();
    let mut batch = PointBatch::default();
    reader.read(&mut batch).unwrap();
    assert_eq!(batch.len(), BATCH);
    let error = reader.read(&mut batch).unwrap_err();
    assert!(
        error.to_string().contains(&format!("line {}", BATCH + 11)),
        "{error}"
    );
    reader.read(&mut batch).unwrap();
    assert!(batch.is_empty());
}

#[test]
fn a_file_without_lines_is_refused_early() {
    let error = from_stream(io::repeat(b'1'), "endless", Options::default())
        .map(|_| ())
        .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("a line of more than 65536 bytes"),
        "{error}"
    );
    let error = from_stream(
        io::Cursor::new(b"\xff\xfe1\0 \0".to_vec()),
        "wide",
        Options::default(),
    )
    .map(|_| ())
    .unwrap_err();
    assert!(error.to_string().contains("UTF-16"), "{error}");
}

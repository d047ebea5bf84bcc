//! Lines of DXF drawings.

use breakline::data::{Layer, Shape};
use breakline::io::{layer, mesh};

use crate::program::{folder_with, run_in};
use crate::refused;
use crate::sample::field;

/// A drawing of entities: pairs of codes and values, separated by blanks.
fn drawing(entities: &str) -> String {
    let pairs = |text: &str| {
        text.split(' ')
            .fold(String::new(), |all, word| all + word + "\r\n")
    };
    let frame =
        pairs("0 SECTION 2 BLOCKS 0 LINE 8 X 10 1 20 1 11 2 21 2 0 ENDSEC 0 SECTION 2 ENTITIES");
    frame + &pairs(entities) + &pairs("0 ENDSEC 0 EOF")
}

const ENTITIES: &str = "0 LINE 8 Toe 5 1F 10 1.5 20 2 30 3 11 4 21 5 31 -6e1 \
    0 POLYLINE 8 Toe 66 1 10 0 20 0 30 7.5 70 1 0 VERTEX 8 Toe 10 0 20 0 30 99 \
    0 VERTEX 8 Toe 10 1 20 0 30 99 42 0.5 0 VERTEX 8 Toe 10 1 20 1 30 99 0 SEQEND 8 Toe \
    0 POLYLINE 8 walls 66 1 70 8 0 VERTEX 8 walls 10 0 20 0 30 1 70 32 0 VERTEX 8 walls 10 2 20 0 30 2 70 32 \
    0 VERTEX 8 walls 10 9 20 9 30 9 70 16 0 SEQEND \
    0 LWPOLYLINE 8 walls 90 2 70 0 38 12.25 10 5 20 6 10 7 20 8 0 POINT 8 spots 10 1 20 2 30 3 \
    0 TEXT 8 Toe 10 0 20 0 1 hello 0 ARC 8 walls 10 0 0 ARC 8 walls 10 0 \
    0 POLYLINE 8 mesh 70 64 0 VERTEX 8 mesh 10 0 20 0 30 0 70 192 0 SEQEND";

fn read(folder: &tempfile::TempDir, text: &str, layer: Option<&str>) -> breakline::Result<Layer> {
    let path = folder.path().join("a.dxf");
    std::fs::write(&path, text).unwrap();
    let name = path.to_str().unwrap();
    layer::read(&layer.map_or(name.to_owned(), |layer| format!("{name}:{layer}")))
}

#[test]
fn lines_of_a_layer_or_of_all_are_read() {
    let folder = folder_with(&[]);
    let all = read(&folder, &drawing(ENTITIES), None).unwrap();
    let line = |points: &[[f64; 3]]| Shape::Lines(vec![points.to_vec()]);
    let toe = [
        line(&[[1.5, 2.0, 3.0], [4.0, 5.0, -60.0]]),
        line(&[
            [0.0, 0.0, 7.5],
            [1.0, 0.0, 7.5],
            [1.0, 1.0, 7.5],
            [0.0, 0.0, 7.5],
        ]),
    ];
    let walls = [
        line(&[[0.0, 0.0, 1.0], [2.0, 0.0, 2.0]]),
        line(&[[5.0, 6.0, 12.25], [7.0, 8.0, 12.25]]),
    ];
    let spots = [Shape::Points(vec![[1.0, 2.0, 3.0]])];
    assert_eq!(all.shapes, [&toe[..], &walls, &spots].concat());
    let said: Vec<String> = all.warnings.iter().map(|text| text.plain()).collect();
    assert_eq!(
        said,
        [
            "left out: 2 ARC, 1 TEXT, 1 polyface mesh",
            "1 arcs in polylines are read as straight"
        ]
    );
    let of_walls = read(&folder, &drawing(ENTITIES), Some("WALLS")).unwrap();
    assert_eq!(of_walls.shapes, walls);
    assert_eq!(of_walls.warnings, ["left out: 2 ARC"]);
    let error = read(&folder, &drawing(ENTITIES), Some("crest")).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("a.dxf: ENTITIES: there is no layer \"crest\"")
    );
    assert_eq!(
        *error.cure_text().unwrap(),
        "name one of Toe, mesh, spots, walls"
    );
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let folder = folder_with(&[]);
    let good = drawing(ENTITIES);
    let changes = [
        ("0\r\nEOF\r\n", "", "the file ends before EOF"),
        (
            "\r\n1.5\r\n",
            "\r\n1,5\r\n",
            "line 30: '1,5' is the value of code 10, expected a finite number",
        ),
        (
            "\r\n1.5\r\n",
            "\r\nnan\r\n",
            "line 30: 'nan' is the value of code 10",
        ),
        (
            "5\r\n1F\r\n",
            "five\r\n1F\r\n",
            "line 27: 'five' is not a code of DXF",
        ),
        (
            "0\r\nSEQEND\r\n8\r\nToe\r\n",
            "",
            "the entity 'POLYLINE' follows a vertex",
        ),
        (
            "70\r\n1\r\n",
            "70\r\nx\r\n",
            "'x' is the value of code 70, expected flags",
        ),
        (
            "0\r\nPOLYLINE\r\n",
            "0\r\nTEXT\r\n",
            "a vertex outside of polylines",
        ),
    ];
    refused::with_each_change(&good, "a.dxf: ", |text| read(&folder, text, None), &changes);
    let error = read(&folder, "AutoCAD Binary DXF\r\n\x1a", None)
        .unwrap_err()
        .to_string();
    assert!(error.ends_with("a.dxf: a binary drawing"));
    let path = folder.path().join("a.dxf");
    std::fs::write(&path, &good).unwrap();
    let error = layer::read(&format!("{}::Z", path.display()))
        .unwrap_err()
        .to_string();
    assert!(
        error.ends_with("a.dxf: a drawing has no attributes"),
        "{error}"
    );
}

#[test]
fn lines_that_were_written_are_breaklines_again() {
    let points: String = (0..100)
        .map(|i| format!("{} {} {}\n", i % 10, i / 10, i % 7))
        .collect();
    let line = r#"{"type":"LineString","coordinates":[[0.5,0.25,3],[8.5,8.75,4.125]]}"#;
    let folder = folder_with(&[("a.xyz", &points), ("l.json", line)]);
    let tin = |lines: &str, output: &str| {
        run_in(
            &folder,
            &[
                "tin",
                "a.xyz",
                "--a-srs",
                "EPSG:25832",
                "--breaklines",
                lines,
                "-o",
                output,
            ],
        )
        .works(&["written"]);
        std::fs::read(folder.path().join(output)).unwrap()
    };
    let expected = tin("l.json", "one.ply");
    tin("l.json", "one.dxf");
    assert_eq!(tin("one.dxf:BREAKLINES", "other.ply"), expected);
    run_in(
        &folder,
        &["tin", "a.xyz", "--breaklines", "one.dxf:toe", "-o", "x.ply"],
    )
    .fails(
        2,
        &[
            "there is no layer \"toe\"",
            "name one of BOUNDARY, BREAKLINES, SURFACE",
        ],
    );
    run_in(
        &folder,
        &[
            "profile",
            "one.ply",
            "--along",
            "one.dxf:BREAKLINES",
            "-o",
            "p.csv",
        ],
    )
    .works(&["written"]);
    // A comment states the system.
    let path = folder.path().join("b.dxf");
    mesh::write(&path, &field(Some("EPSG:25832"))).unwrap();
    let layer = layer::read(&format!("{}:WALLS", path.display())).unwrap();
    assert_eq!(layer.crs.unwrap().epsg, Some(25832));
    assert!(layer.warnings.is_empty());
}

#[test]
fn names_of_layers_in_windows_1252_and_with_escapes() {
    let folder = folder_with(&[]);
    let path = folder.path().join("a.dxf");
    let text = drawing("0 LINE 8 B?schung 10 1 20 2 30 3 11 4 21 5 31 6");
    let read = |name: &[u8], layer: &str| {
        let at = text.find('?').unwrap();
        let bytes = [&text.as_bytes()[..at], name, &text.as_bytes()[at + 1..]].concat();
        std::fs::write(&path, bytes).unwrap();
        layer::read(&format!("{}:{layer}", path.display())).map(|layer| layer.shapes.len())
    };
    for name in [&b"\xf6"[..], "ö".as_bytes(), b"\\U+00F6"] {
        assert_eq!(read(name, "Böschung").unwrap(), 1);
    }
    assert_eq!(read(b"\x80", "B€schung").unwrap(), 1);
    // What is no escape stays.
    for odd in ["\\U+12", "\\U+D800x", "\\U+éa"] {
        let error = read(odd.as_bytes(), "other").unwrap_err();
        let cure = error.cure_text().unwrap().plain();
        assert_eq!(cure, format!("name one of B{odd}schung"));
    }
}

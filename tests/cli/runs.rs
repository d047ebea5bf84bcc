//! Several products of one surface, by a run file.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use breakline::cli::{RunOptions, RunTables, run_products};
use breakline::error::Kind;
use breakline::run::Context;
use serde_json::Value;
use tempfile::TempDir;
use testkit::random::Random;

use super::{Run, SLOPE, bytes, files_of, folder_with, geojson, run_in};

/// A run of every kind of product.
const ALL: &str = r#"
[input]
files = "[ab].xyz"
breaklines = "edge.geojson"
max-edge = "none"

[[product]]
verb = "tin"
output = ["ground.ply", "ground.tin", "ground.obj", "ground.xml", "ground.2dm", "ground.glb"]
crossing-report = "crossings.csv"

[[product]]
verb = "simplify"
max-error = 0.5
output = "light.ply"

[[product]]
verb = "dem"
resolution = 0.5
te = [0, 0, 3, 3]
output = "dem.tif"

[[product]]
verb = "dem"
method = "natural"
output = "natural.asc"

[[product]]
verb = "hillshade"
azimuth = 300
output = ["shade.png", "shade.tif"]

[[product]]
verb = "color-relief"
ramp = "elevation"
output = "color.png"

[[product]]
verb = "slope"
percent = true
output = "slope.tif"

[[product]]
verb = "aspect"
output = "aspect.tif"

[[product]]
verb = "curvature"
output = "curvature.tif"

[[product]]
verb = "roughness"
output = "roughness.tif"

[[product]]
verb = "tri"
output = "tri.tif"

[[product]]
verb = "tpi"
output = "tpi.tif"

[[product]]
verb = "contour"
interval = 0.5
output = ["exact.shp", "exact.gpkg"]

[[product]]
verb = "contour"
levels = [10.25, 11.5]
smooth = true
output = "map.geojson"
labels-output = "labels.shp"

[[product]]
verb = "volume"
plane = 11
output = "volumes.csv"

[[product]]
verb = "compare"
files = "flat.xyz"
output = "difference.tif"

[[product]]
verb = "profile"
files = ["flat.xyz"]
along = "edge.geojson"
output = ["profile.csv", "profile.svg", "profile.dxf"]

[[product]]
verb = "drape"
lines = "edge.geojson"
output = "draped.geojson"

[[product]]
verb = "sample"
at = "at.csv"
add = ["height", "slope"]
output = "sampled.csv"

[[product]]
verb = "accuracy"
checkpoints = "at.csv"
output = "checks.csv"
histogram = "bins.csv"
"#;

const DEM: &str = "[input]\nfiles = \"a.xyz\"\n[[product]]\nverb = \"dem\"\noutput = \"dem.tif\"\n";

/// A folder with points, lines and a run file.
fn folder(text: &str) -> TempDir {
    let (a, b) = SLOPE.split_at(SLOPE.find("0 2 10").unwrap());
    let edge = geojson(
        25832,
        "LineString",
        "[[0.5,0.5,11],[2.5,1.5,12],[2.75,2.75,10]]",
    );
    folder_with(&[
        ("a.xyz", a),
        ("b.xyz", b),
        ("flat.xyz", "0 0 11\n3 0 11\n3 3 11\n0 3 11\n"),
        ("edge.geojson", &edge),
        ("at.csv", "x,y,z\n1.5,1.25,11\n2,2.5,12.5\n0.25,0.5,10\n"),
        ("site.toml", text),
    ])
}

fn run(folder: &TempDir, words: &str) -> Run {
    let words: Vec<&str> = words.split(' ').collect();
    run_in(folder, &[&["run"], &words[..]].concat())
}

#[track_caller]
fn json(run: &Run) -> Value {
    assert_eq!(run.code, 0, "{}", run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

fn texts(list: &Value) -> Vec<String> {
    let list = list.as_array().unwrap();
    list.iter()
        .map(|text| text.as_str().unwrap().to_owned())
        .collect()
}

#[track_caller]
fn assert_unchanged(folder: &TempDir, before: &[String]) {
    assert_eq!(files_of(folder.path()), before);
}

#[test]
fn products_have_the_bytes_of_single_commands_and_a_plan_writes_nothing() {
    let [together, single] = [(); 2].map(|()| folder(ALL));
    let before = files_of(together.path());
    let plan = json(&run(&together, "site.toml --dry-run --json"));
    assert_unchanged(&together, &before);
    run(&together, "site.toml --dry-run").ends(0, &["surface 1 ", "The same by single commands:"]);
    assert_unchanged(&together, &before);

    let done = json(&run(&together, "site.toml --json"));
    assert_eq!(
        done["surfaces"].as_array().unwrap().len(),
        2,
        "each surface is built once"
    );
    // The same files, in a list.
    std::fs::write(single.path().join("files.txt"), "a.xyz\nb.xyz\n").unwrap();
    let products = plan["products"].as_array().unwrap();
    assert_eq!(products.len(), ALL.matches("[[product]]").count());
    for (product, report) in products.iter().zip(done["products"].as_array().unwrap()) {
        let command = product["command"].as_str().unwrap();
        let words = command.split(' ').skip(1);
        let words: Vec<&str> = words.map(|word| word.trim_matches('\'')).collect();
        let alone = run_in(&single, &words);
        assert_eq!(alone.code, 0, "{command}: {}", alone.stderr);
        assert_eq!(product["verb"], report["verb"]);
        for file in texts(&product["writes"]) {
            // The log of a shapefile has no date, and a GeoPackage none either.
            assert!(
                bytes(&together, &file) == bytes(&single, &file),
                "{file} of {command}"
            );
        }
    }
    let mut expected = files_of(single.path());
    expected.retain(|name| name != "files.txt");
    assert_eq!(files_of(together.path()), expected);
    let mut written = texts(&done["files"]);
    written.sort();
    let of_products = done["products"].as_array().unwrap().iter();
    let mut of_products: Vec<String> = of_products
        .flat_map(|product| texts(&product["files"]))
        .collect();
    of_products.sort();
    assert_eq!(written, of_products);

    let volume = &done["products"][14];
    let alone = run_in(
        &single,
        &[
            "volume",
            "@files.txt",
            "--breaklines",
            "edge.geojson",
            "--max-edge",
            "none",
            "--plane",
            "11",
            "--json",
        ],
    );
    assert_eq!(volume["report"], json(&alone));

    // A second time, files are there.
    let before = files_of(together.path());
    run(&together, "site.toml").fails(1, &["ground.ply", "--overwrite"]);
    run(&together, "site.toml --overwrite").works(&["product     20 of 20: accuracy, checks.csv"]);
    assert_unchanged(&together, &before);
}

#[test]
fn paths_are_relative_to_the_run_file() {
    let folder = folder(ALL);
    let outside = folder_with(&[]);
    std::fs::rename(folder.path(), outside.path().join("site")).unwrap();
    run(&outside, "site/site.toml").works(&["site/dem.tif", "site/color.png"]);
    assert_eq!(files_of(outside.path()), ["site"]);
}

#[test]
fn larger_points_are_built_in_files_once_and_give_the_same_bytes() {
    let half = |from: u32| {
        let zeros = "0".repeat(80);
        let line = |i: u32| {
            let [x, y] = [from + i % 100, i / 100];
            format!("{x}.{zeros} {y}.{zeros} {}.{zeros}\n", x * y % 17)
        };
        (0..9000).map(line).collect::<String>()
    };
    let text = r#"
[input]
files = "tiles/*.xyz"
[[product]]
verb = "dem"
resolution = 4
output = "dem.tif"
[[product]]
verb = "contour"
interval = 8
output = "exact.shp"
[[product]]
verb = "volume"
levels = "0:16:8"
output = "volumes.csv"
[[product]]
verb = "profile"
along = "line.geojson"
output = "profile.csv"
[[product]]
verb = "sample"
at = "at.csv"
output = "sampled.csv"
"#;
    let line = geojson(25832, "LineString", "[[5.5,3],[120.25,50],[240,51]]");
    let [west, east] = [0, 100].map(half);
    let files = [
        ("tiles/west.xyz", west.as_str()),
        ("tiles/east.xyz", &east),
        ("line.geojson", &line),
        ("at.csv", "x,y\n10.5,20.25\n99.5,7\n199,89\n"),
        ("site.toml", text),
        (
            "mesh.toml",
            "[input]\nfiles = \"tiles/*.xyz\"\n[[product]]\nverb = \"tin\"\noutput = \"ground.ply\"\n",
        ),
    ];
    let [whole, in_files] = [(); 2].map(|()| folder_with(&files));
    run(&whole, "site.toml").works(&[]);
    let plan = run(&in_files, "site.toml --dry-run --memory 16MB");
    plan.ends(0, &["built in tiles, used in its files"]);
    let done = run(&in_files, "site.toml --memory 16MB");
    done.works(&["note: the points need more than "]);
    assert_eq!(
        done.stderr.matches("built in files first").count(),
        1,
        "{}",
        done.stderr
    );
    assert_eq!(files_of(whole.path()), files_of(in_files.path()));
    for file in files_of(whole.path()) {
        if whole.path().join(&file).is_file() {
            assert!(bytes(&whole, &file) == bytes(&in_files, &file), "{file}");
        }
    }
    // The order of vertices in a mesh is that of one piece.
    run(&whole, "mesh.toml").works(&[]);
    run(&in_files, "mesh.toml --memory 16MB").works(&["tiles make a TIN in parts"]);
    assert!(bytes(&whole, "ground.ply") == bytes(&in_files, "ground.ply"));
}

#[test]
fn wrong_files_are_errors_with_file_line_key_and_cure() {
    let product = "[input]\nfiles = \"a.xyz\"\n[[product]]\n";
    let input =
        |text: &str| format!("[input]\n{text}\n[[product]]\nverb = \"dem\"\noutput = \"d.tif\"\n");
    for (text, code, said) in [
        ("".to_owned(), 2, &["site.toml: there is no [input]"][..]),
        (
            "[input]\nfiles = \"a.xyz\"\n".to_owned(),
            2,
            &["site.toml: there is no [[product]]"],
        ),
        (
            "[input]\nfiles = \n".to_owned(),
            1,
            &["site.toml: line 2: "],
        ),
        (
            "[inptu]\n".to_owned(),
            2,
            &["site.toml: line 1: `inptu` is not", "did you mean [input]?"],
        ),
        (
            "input = 3\n".to_owned(),
            1,
            &["site.toml: line 1: `input` is one value"],
        ),
        (
            input("fles = \"a.xyz\""),
            2,
            &[
                "site.toml: line 2: `fles` is not an option of a surface",
                "did you mean `files`?",
            ],
        ),
        (
            input("files = \"a.xyz\"\nresolution = 1"),
            2,
            &["line 3: `resolution`", "move it to a [[product]]"],
        ),
        (
            input("files = \"a.xyz\"\ncrossing-report = \"c.csv\""),
            2,
            &["line 3: ", "move it to a [[product]]"],
        ),
        (
            input("files = \"a.xyz\"\nmax-edge = true"),
            2,
            &["line 3: `max-edge` is true or false, expected a text"],
        ),
        (
            input("files = \"a.xyz\"\nmax-edge = []"),
            2,
            &["line 3: `max-edge` is an empty list"],
        ),
        (
            input("files = \"a.xyz\"\nmax-edge = 1979-05-27"),
            2,
            &["line 3: `max-edge` is a date"],
        ),
        (
            input("files = \"a.xyz\"\nmax-edge = [[1]]"),
            2,
            &["line 3: `max-edge` has a list in its list"],
        ),
        (
            input("files = \"a.xyz\"\nmax-edge = \"wide\""),
            2,
            &["line 3: `max-edge`: "],
        ),
        (
            input("files = \"a.xyz\"\nadd-ridges = \"yes\""),
            2,
            &["line 3: `add-ridges` is one value, expected true or false"],
        ),
        (
            input("files = \"none.xyz\""),
            1,
            &["none.xyz: no such file"],
        ),
        (
            format!("{product}output = \"d.tif\"\n"),
            2,
            &[
                "line 3: the product has no verb",
                "add verb = \"dem\", or one of tin, ",
            ],
        ),
        (
            format!("{product}verb = \"den\"\n"),
            2,
            &["line 4: `den` is not a verb", "did you mean `dem`?"],
        ),
        (
            format!("{product}verb = \"info\"\n"),
            2,
            &["line 4: `info` is not a verb"],
        ),
        (
            format!("{product}verb = [1]\n"),
            2,
            &["line 4: the verb is a list"],
        ),
        (
            format!("{product}verb = \"dem\"\nresoluton = 1\noutput = \"d.tif\"\n"),
            2,
            &[
                "line 5: `resoluton` is not an option of `dem`",
                "did you mean `resolution`?",
            ],
        ),
        (
            format!("{product}verb = \"dem\"\nresolution = -1\noutput = \"d.tif\"\n"),
            2,
            &["line 5: `resolution`: "],
        ),
        (
            format!("{product}verb = \"dem\"\nmethod = \"cubic\"\noutput = \"d.tif\"\n"),
            2,
            &["line 5: `method`: `cubic`: expected one of linear, nearest"],
        ),
        (
            format!("{product}verb = \"dem\"\nclass = 2\noutput = \"d.tif\"\n"),
            2,
            &[
                "line 5: `class` is an option of the surface",
                "move it to [input]",
            ],
        ),
        (
            format!("{product}verb = \"dem\"\nfiles = \"b.xyz\"\noutput = \"d.tif\"\n"),
            2,
            &["line 5: `files` is an option of the surface"],
        ),
        (
            format!("{product}verb = \"dem\"\ntiles = \"2x2\"\noutput = \"d.tif\"\n"),
            2,
            &["line 5: `tiles` is for all products"],
        ),
        (
            format!("{product}verb = \"volume\"\njson = true\n"),
            2,
            &["line 5: `json` is for all products"],
        ),
        (
            format!("{product}verb = \"dem\"\n"),
            2,
            &["line 3: `output` is missing"],
        ),
        (
            format!("{product}verb = \"volume\"\nplane = 1\nlevels = \"0:1:1\"\n"),
            2,
            &["cannot be used with"],
        ),
        (
            format!("{product}verb = \"volume\"\n"),
            2,
            &["line 3: the base of the volumes is missing"],
        ),
        (
            format!("{product}verb = \"sample\"\nat = \"at.csv\"\n"),
            2,
            &["line 3: no output is named"],
        ),
        (
            format!("{product}verb = \"tin\"\noutput = \"x.tins\"\n"),
            2,
            &["x.tins: a TIN in parts is written alone"],
        ),
        (
            format!("{product}verb = \"dem\"\noutput = \"d.xyz1\"\n"),
            2,
            &["d.xyz1: "],
        ),
        (
            format!("{product}verb = \"dem\"\noutput = \"site.toml\"\n"),
            2,
            &["site.toml: "],
        ),
    ] {
        let folder = folder(&text);
        let before = files_of(folder.path());
        for words in ["site.toml", "site.toml --dry-run"] {
            let run = run(&folder, words);
            assert_eq!(run.code, code, "{text}: {}", run.stderr);
            run.fails(code, said);
        }
        assert_unchanged(&folder, &before);
    }
    let missing = run(&folder(""), "none.toml");
    missing.fails(1, &["none.toml: "]);
    let folder = folder(DEM);
    std::fs::write(
        folder.path().join("site.toml"),
        b"[input]\nfiles = \"\xff\"\n",
    )
    .unwrap();
    run(&folder, "site.toml").fails(1, &["site.toml: line 2: the text is not UTF-8"]);
}

#[test]
fn products_do_not_write_what_others_write_or_read() {
    let second = |text: &str| format!("{DEM}[[product]]\n{text}");
    for (text, said) in [
        (
            second("verb = \"slope\"\noutput = \"dem.tif\"\n"),
            "dem.tif: product 2 (line 6): another product writes this file, too",
        ),
        (
            second("verb = \"slope\"\noutput = \"./dem.tif\"\n"),
            "another product writes this file, too",
        ),
        (
            second("verb = \"drape\"\nlines = \"edge.geojson\"\noutput = \"edge.geojson\"\n"),
            "edge.geojson: the output is one of the inputs",
        ),
        (
            second(
                "verb = \"tin\"\noutput = \"flat.ply\"\n[[product]]\nverb = \"compare\"\nfiles = \"flat.ply\"\n",
            ),
            "flat.ply: product 2 (line 6): the output is one of the inputs",
        ),
        (
            second(
                "verb = \"accuracy\"\ncheckpoints = \"at.csv\"\n[[product]]\nverb = \"volume\"\nplane = 1\noutput = \"at.csv\"\n",
            ),
            "at.csv: product 3 (line 9): the output is one of the inputs",
        ),
    ] {
        let folder = folder(&text);
        run_in(&folder, &["tin", "flat.xyz", "-o", "flat.ply"]).works(&[]);
        let before = files_of(folder.path());
        let run = run(&folder, "site.toml --overwrite");

        assert_eq!(run.code, 2, "{text}: {}", run.stderr);
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        assert_unchanged(&folder, &before);
    }
}

#[test]
fn a_product_that_fails_late_leaves_nothing() {
    let text = format!(
        "{DEM}[[product]]\nverb = \"sample\"\nat = \"edge.geojson\"\noutput = \"s.geojson\"\n"
    );
    let folder = folder(&text);
    let before = files_of(folder.path());
    run(&folder, "site.toml").fails(1, &["edge.geojson: product 2 (sample), "]);
    assert_unchanged(&folder, &before);
    // What is there stays.
    std::fs::write(folder.path().join("dem.tif"), "kept").unwrap();
    run(&folder, "site.toml --overwrite").fails(1, &["product 2 (sample)"]);
    assert_eq!(bytes(&folder, "dem.tif"), b"kept");
}

#[test]
fn a_canceled_run_leaves_nothing() {
    let folder = folder(DEM);
    let before = files_of(folder.path());
    let canceled = AtomicBool::new(true);
    let context = Context {
        cancel: &canceled,
        ..Context::default()
    };
    let file = folder.path().join("site.toml");
    let error = run_products(RunTables::File(&file), &RunOptions::default(), &context);
    assert_eq!(error.unwrap_err().kind(), Kind::Canceled);
    assert_unchanged(&folder, &before);
}

#[test]
fn a_limit_that_is_not_met_is_a_failure_and_the_files_are_there() {
    let text = format!(
        "{DEM}[[product]]\nverb = \"accuracy\"\ncheckpoints = \"at.csv\"\naccuracy-class = 0.001\n"
    );
    let folder = folder(&text);
    let done = run(&folder, "site.toml");
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(folder.path().join("dem.tif").exists());
}

#[test]
fn damaged_files_are_errors_and_write_nothing() {
    let random = &mut Random(7);
    let context = Context::default();
    let options = RunOptions {
        overwrite: true,
        ..RunOptions::default()
    };
    let text = "[input]\nfiles = [\"a.xyz\", \"b.xyz\"]\nmax-edge = 10.5\n\n[[product]]\nverb = \"volume\"\n\
        plane = 11\noutput = \"v.csv\"\n\n[[product]]\nverb = \"sample\"\nat = \"at.csv\"\nadd = [\"height\"]\noutput = \"s.csv\"\n";
    let folder = folder(text);
    let before = files_of(folder.path());
    let file = folder.path().join("site.toml");
    let path = folder.path().display().to_string();
    let [mut refused, mut written] = [0; 2];
    for _ in 0..500 {
        let mut damaged = text.as_bytes().to_vec();
        for _ in 0..=random.index(3) {
            damage(&mut damaged, random);
        }
        std::fs::write(&file, &damaged).unwrap();
        match run_products(RunTables::File(&file), &options, &context) {
            Ok(_) => written += 1,
            Err(error) => {
                refused += 1;
                let said = error.to_string();
                assert!(
                    said.contains(&path),
                    "{said}\n{}",
                    String::from_utf8_lossy(&damaged)
                );
                assert_unchanged(&folder, &before);
            }
        }
        remove_others(folder.path(), &before);
    }
    assert!(
        refused > 300 && written > 20,
        "{refused} refused, {written} written"
    );
}

/// Changes a byte, removes or repeats some, or swaps lines. No path leaves the folder.
fn damage(text: &mut Vec<u8>, random: &mut Random) {
    if text.is_empty() {
        return;
    }
    let at = random.index(text.len());
    let end = (at + 1 + random.index(12)).min(text.len());
    match random.below(5) {
        0 => text[at] = random.pick(b"=[]\"'\n .,#\\0-9e_x\xff"),
        1 => drop(text.drain(at..end)),
        2 => {
            let again = text[at..end].to_vec();
            text.splice(at..at, again);
        }
        3 => text.truncate(at),
        _ => {
            let lines: Vec<&[u8]> = text.split_inclusive(|&byte| byte == b'\n').collect();
            let mut lines: Vec<Vec<u8>> = lines.into_iter().map(<[u8]>::to_vec).collect();
            let [one, other] = [(); 2].map(|()| random.index(lines.len()));
            lines.swap(one, other);
            *text = lines.concat();
        }
    }
}

fn remove_others(folder: &Path, known: &[String]) {
    for name in files_of(folder) {
        if !known.contains(&name) {
            std::fs::remove_file(folder.join(name)).unwrap();
        }
    }
}

#[test]
fn tables_of_a_program_are_like_a_file() {
    let folder = folder(DEM);
    let file = |name: &str| folder.path().join(name).display().to_string();
    let tables = serde_json::json!({
        "input": { "files": file("a.xyz"), "max_edge": "none", "class": null },
        "product": [
            { "verb": "dem", "output": file("dem.tif") },
            { "verb": "volume", "plane": 10 },
        ],
    });
    let tables = tables.to_string();
    let context = Context::default();
    let report =
        |tables: &str| run_products(RunTables::Json(tables), &RunOptions::default(), &context);
    let done: Value = serde_json::from_str(&report(&tables).unwrap()).unwrap();
    assert_eq!(done["products"][1]["report"]["rows"][0]["cut"], 4.5);
    assert!(folder.path().join("dem.tif").exists());
    for (wrong, said) in [
        ("3", "a run consists of tables"),
        ("{", "EOF"),
        (
            "{\"input\": {}, \"product\": {\"verb\": \"dem\"}}",
            "`files` is missing",
        ),
        (
            "{\"input\": {\"files\": \"x\"}, \"product\": [1]}",
            "product 1: a product is a table",
        ),
        (
            "{\"input\": {\"files\": \"x\"}, \"product\": [{\"verb\": \"dem\", \"a\": 1}]}",
            "product 1: `a` is not an option of `dem`",
        ),
    ] {
        let error = report(wrong).unwrap_err().to_string();
        assert!(error.contains(said), "{said}: {error}");
    }
}

#[test]
fn the_commands_of_the_page_run() {
    let page = include_str!("../../docs/run.md");
    let folder = folder_with(&[]);
    run_in(&folder, &["demo", ".", "-q"]).works(&[]);
    let toml = page
        .split("```toml\n")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    std::fs::write(folder.path().join("site.toml"), toml).unwrap();
    let commands = page
        .lines()
        .filter_map(|line| line.strip_prefix("    breakline "));
    let mut count = 0;
    for command in commands {
        let words: Vec<&str> = command.split(" > ").next().unwrap().split(' ').collect();
        run_in(&folder, &words).works(&[]);
        count += 1;
    }
    assert!(count >= 4, "{count} commands");
}

#[test]
fn shells_complete_verbs_options_and_values() {
    let folder = folder_with(&[]);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = run_in(&folder, &["completions", shell]);
        run.works(&[]);
        for word in ["color-relief", "max-edge", "breakline"] {
            assert!(run.stdout.contains(word), "{shell}: {word}");
        }
        std::fs::write(folder.path().join(shell), run.stdout).unwrap();
    }
    let script = "source ./bash
        complete_for() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
            _breakline breakline \"${@: -1}\" \"${@: -2:1}\"; echo \"${COMPREPLY[@]}\"; }
        complete_for breakline color
        complete_for breakline dem --resol
        complete_for breakline dem --method na
        complete -p breakline";
    let Ok(output) = std::process::Command::new("bash")
        .args(["--norc", "-c", script])
        .current_dir(folder.path())
        .output()
    else {
        eprintln!("skipped: there is no bash");
        return;
    };
    let said = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(
        lines[..3],
        ["color-relief", "--resolution", "natural"],
        "{said}"
    );
    assert!(lines[3].contains("-F _breakline"), "{said}");
}

#[test]
fn there_is_a_man_page_for_each_verb() {
    let folder = folder_with(&[]);
    run_in(&folder, &["man", "-o", "man1"]).works(&["pages in man1"]);
    let pages = files_of(&folder.path().join("man1"));
    let described = run_in(&folder, &["describe", "--json"]).stdout;
    let described: Value = serde_json::from_str(&described).unwrap();
    for verb in described["verbs"].as_array().unwrap() {
        let page = format!("breakline-{}.1", verb["name"].as_str().unwrap());
        assert!(pages.contains(&page), "{page}");
        let text = String::from_utf8(bytes(&folder, &format!("man1/{page}"))).unwrap();
        assert!(
            text.contains(".TH breakline-") && text.contains(".SH NAME"),
            "{text}"
        );
    }
    run_in(&folder, &["man", "-o", "man1"]).fails(1, &["--overwrite"]);
    run_in(&folder, &["man", "-o", "man1", "--overwrite"]).works(&[]);
    let printed = run_in(&folder, &["man"]).stdout;
    assert!(printed.as_bytes() == bytes(&folder, "man1/breakline.1"));
    for page in &pages {
        let checked = std::process::Command::new("groff")
            .args(["-man", "-ww", "-Tutf8", "-z", page])
            .current_dir(folder.path().join("man1"))
            .output();
        match checked {
            Ok(checked) => assert_eq!(String::from_utf8_lossy(&checked.stderr), "", "{page}"),
            Err(_) => return eprintln!("skipped: there is no groff"),
        }
    }
}

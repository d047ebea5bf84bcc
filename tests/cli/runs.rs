//! Several products of one surface, by a run file.

mod interrupted;
mod refused;

use std::path::Path;

use breakline::cli::{RunOptions, RunTables, run_products};
use breakline::run::Context;
use serde_json::Value;
use tempfile::TempDir;

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
fn names_of_folders_and_outputs_are_taken_as_they_are() {
    let text = DEM.replace("a.xyz", "*.xyz").replace("dem.tif", "@dem.tif");
    let [own, other] = ["0 0 1\n3 0 1\n0 3 1\n", "0 0 7\n3 0 7\n0 3 7\n"];
    let folder = folder_with(&[
        ("site[1]/p.xyz", own),
        ("site[1]/s.toml", &text),
        ("site1/p.xyz", other),
        ("only/own.toml", &text.replace("*.xyz", "p.xyz")),
        ("only/p.xyz", own),
    ]);
    run(&folder, "site[1]/s.toml").works(&["site[1]/@dem.tif"]);
    run(&folder, "only/own.toml").works(&["only/@dem.tif"]);
    assert!(bytes(&folder, "site[1]/@dem.tif") == bytes(&folder, "only/@dem.tif"));
}

#[test]
fn surfaces_have_the_names_that_single_commands_give_them() {
    let profile = "[[product]]\nverb = \"profile\"\nalong = \"edge.geojson\"\n\
        output = [\"p.csv\", \"p.svg\"]\n[[product]]\nverb = \"volume\"\nplane = 10\n";
    for (input, name) in [
        ("files = [\"a.xyz\", \"b.xyz\"]", "@files.txt"),
        ("breaklines = \"edge.geojson\"", "edge.geojson"),
        ("files = \"*[ab].xyz\"", "*[ab].xyz"),
    ] {
        let [together, single] =
            [(); 2].map(|()| folder(&format!("[input]\n{input}\nmax-edge = \"none\"\n{profile}")));
        let plan = json(&run(&together, "site.toml --dry-run --json"));
        let printed = run(&together, "site.toml --dry-run").stdout;
        let has_list = name.starts_with('@');
        assert_eq!(
            printed.contains("  printf '%s\\n' a.xyz b.xyz > files.txt\n"),
            has_list,
            "{printed}"
        );
        if has_list {
            assert_eq!(texts(&plan["lists"]["files.txt"]), ["a.xyz", "b.xyz"]);
            std::fs::write(single.path().join("files.txt"), "a.xyz\nb.xyz\n").unwrap();
        }
        run(&together, "site.toml").ends(0, &[]);
        let command = plan["products"][0]["command"].as_str().unwrap();
        let words = command.split(' ').skip(1);
        let words: Vec<&str> = words.map(|word| word.trim_matches('\'')).collect();
        run_in(&single, &words).works(&[]);
        for file in ["p.csv", "p.svg"] {
            assert!(
                bytes(&together, file) == bytes(&single, file),
                "{file} of {command}"
            );
        }
        let table = String::from_utf8(bytes(&together, "p.csv")).unwrap();
        assert!(table.contains(name), "{name}: {table}");
    }
}

#[test]
fn options_of_building_may_be_for_the_second_surface() {
    let text = "[input]\nfiles = \"r.tif\"\nmax-edge = \"none\"\n\
        [[product]]\nverb = \"compare\"\nfiles = \"a.xyz\"\n";
    let folder = folder(text);
    run_in(&folder, &["dem", "flat.xyz", "-o", "r.tif"]).works(&[]);
    let single = ["compare", "r.tif", "a.xyz", "--max-edge", "none"];
    let single = run_in(&folder, &single);
    single.works(&[]);
    let together = run(&folder, "site.toml");
    together.works(&[]);
    assert_eq!(
        together.stdout,
        format!("product 1: compare\n{}", single.stdout)
    );
    // Where there is nothing to build, they are an error.
    let wrong = text.replace("compare\"\nfiles = \"a.xyz\"", "dem\"\noutput = \"d.tif\"");
    std::fs::write(folder.path().join("site.toml"), wrong).unwrap();
    run(&folder, "site.toml").fails(2, &["--max-edge is for building a TIN"]);
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
        // Examples are not filled.
        let extra = text.matches("\n.SH EXTRA\n").count();
        assert_eq!(text.matches("\n.SH EXTRA\n.nf\n").count(), extra, "{text}");
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

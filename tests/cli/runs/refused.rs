//! Run files that are refused: nothing is written.

use breakline::cli::{RunOptions, RunTables, run_products};
use breakline::run::Context;
use testkit::random::Random;

use super::super::{bytes, files_of, run_in};
use super::{DEM, assert_unchanged, folder, remove_others, run};

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
            &["none.xyz: [input] of site.toml: no such file"],
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
            &["line 5: `tiles` is for jobs of single commands"],
        ),
        (
            format!("{product}verb = \"dem\"\njson = true\n"),
            2,
            &[
                "line 5: `json` is for all products",
                "`breakline run FILE.toml --json`",
            ],
        ),
        (
            input("files = \"a.xyz\"\nmemory = \"2GB\""),
            2,
            &["line 3: `memory` is for all products", "--memory`"],
        ),
        (
            input("files = \"a.xyz\"\nmax-edge = 0x1000000000000000000000000000000000000"),
            2,
            &["line 3: `max-edge`: ", "0x1000"],
        ),
        (
            input("files = \"a.xyz\"\nfiles = \"b.xyz\""),
            1,
            &["site.toml: line 3: `files` is there twice"],
        ),
        (
            "[input]\nfiles = \"a.xyz\"\n[[products]]\n".to_owned(),
            2,
            &["line 3: `products` is not", "did you mean [[product]]?"],
        ),
        (
            input("files = \"a.xyz\"\na-srs = \"EPSG:99999\""),
            2,
            &["site.toml: line 3: --a-srs EPSG:99999: "],
        ),
        (
            format!(
                "{product}verb = \"profile\"\nalong = \"edge.geojson\"\n\
                 title = [\"a\", \"b\"]\noutput = \"p.svg\"\n"
            ),
            2,
            &["line 6: `title` is a list, expected one value"],
        ),
        (
            format!(
                "{product}verb = \"profile\"\nalong = \"edge.geojson\"\n\
                 exaggeration = 2\noutput = \"p.csv\"\n"
            ),
            2,
            &["site.toml: line 6: --exaggeration is for plots"],
        ),
        (
            format!(
                "{product}verb = \"tin\"\noutput = \"new.ply\"\n\
                 [[product]]\nverb = \"compare\"\nfiles = \"new.ply\"\n"
            ),
            1,
            &[
                "new.ply: product 2 (site.toml, line 6): no such file",
                "use a second run file",
            ],
        ),
        (
            "[input]\nfiles = \"-\"\n[[product]]\nverb = \"compare\"\nfiles = \"-\"\n".to_owned(),
            2,
            &["line 3: `-` is named twice, and can be read once"],
        ),
        (
            format!(
                "{product}verb = \"sample\"\nat = \"-\"\noutput = \"1.csv\"\n\
                 [[product]]\nverb = \"sample\"\nat = \"-\"\noutput = \"2.csv\"\n"
            ),
            2,
            &["line 7: `-` is named twice, and can be read once"],
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
            &["x.tins: product 1 (site.toml, line 3): a TIN in parts is written alone"],
        ),
        (
            format!("{product}verb = \"dem\"\noutput = \"d.xyz1\"\n"),
            2,
            &["d.xyz1: product 1 (site.toml, line 3): "],
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
            "dem.tif: product 2 (site.toml, line 6): another product writes this file, too",
        ),
        (
            second("verb = \"slope\"\noutput = \"./dem.tif\"\n"),
            "another product writes this file, too",
        ),
        (
            second("verb = \"drape\"\nlines = \"edge.geojson\"\noutput = \"edge.geojson\"\n"),
            "edge.geojson: product 2 (site.toml, line 6): the output is one of the inputs",
        ),
        (
            second(
                "verb = \"tin\"\noutput = \"flat.ply\"\n[[product]]\nverb = \"compare\"\nfiles = \"flat.ply\"\n",
            ),
            "flat.ply: product 2 (site.toml, line 6): the output is one of the inputs",
        ),
        (
            second(
                "verb = \"accuracy\"\ncheckpoints = \"at.csv\"\n[[product]]\nverb = \"volume\"\nplane = 1\noutput = \"at.csv\"\n",
            ),
            "at.csv: product 3 (site.toml, line 9): the output is one of the inputs",
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
fn a_run_file_is_never_its_own_output() {
    let volume = |output: &str| {
        format!(
            "[input]\nfiles = \"a.xyz\"\n[[product]]\nverb = \"volume\"\nplane = 1\noutput = \"{output}\"\n"
        )
    };
    let folder = folder(&volume("link.csv"));
    let text = volume("own.csv");
    std::fs::write(folder.path().join("own.csv"), &text).unwrap();
    run(&folder, "own.csv --overwrite").fails(
        2,
        &["own.csv: product 1 (own.csv, line 3): the output is one of the inputs"],
    );
    assert_eq!(bytes(&folder, "own.csv"), text.as_bytes());
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("site.toml", folder.path().join("link.csv")).unwrap();
        run(&folder, "site.toml --overwrite").fails(2, &["the output is one of the inputs"]);
        assert_eq!(bytes(&folder, "site.toml"), volume("link.csv").as_bytes());
    }
}

#[test]
fn files_beside_outputs_are_not_those_of_inputs_or_of_other_products() {
    let input = "[input]\nfiles = \"a.xyz\"\na-srs = \"EPSG:25832\"\n";
    let text = format!(
        "{input}[[product]]\nverb = \"drape\"\nlines = \"lines.shp\"\noutput = \"d.geojson\"\n\
         [[product]]\nverb = \"dem\"\noutput = \"lines.asc\"\n"
    );
    let folder = folder(&text);
    let words = "contour a.xyz --a-srs EPSG:25832 --interval 0.5 -o lines.shp";
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).works(&[]);
    let before = bytes(&folder, "lines.prj");
    run(&folder, "site.toml --overwrite").fails(
        2,
        &["lines.prj: product 2 (site.toml, line 8): a file of this name is read with an input"],
    );
    assert_eq!(bytes(&folder, "lines.prj"), before);

    let text = format!(
        "{input}[[product]]\nverb = \"dem\"\noutput = \"new.asc\"\n\
         [[product]]\nverb = \"contour\"\ninterval = 0.5\noutput = \"new.shp\"\n"
    );
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    run(&folder, "site.toml").fails(2, &["new.prj: ", "another product writes this file, too"]);
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_that_is_not_there_yet_is_that_file() {
    let volume = |plane: u32, output: &str| {
        format!("[[product]]\nverb = \"volume\"\nplane = {plane}\noutput = \"{output}\"\n")
    };
    let folder = folder("");
    std::fs::create_dir(folder.path().join("real")).unwrap();
    std::os::unix::fs::symlink("real/new.csv", folder.path().join("link.csv")).unwrap();
    for [first, second] in [["real/new.csv", "link.csv"], ["link.csv", "real/new.csv"]] {
        let text = format!(
            "[input]\nfiles = \"a.xyz\"\n{}{}",
            volume(1, first),
            volume(2, second)
        );
        std::fs::write(folder.path().join("site.toml"), text).unwrap();
        run(&folder, "site.toml --overwrite").fails(2, &["another product writes this file, too"]);
        assert!(files_of(&folder.path().join("real")).is_empty());
    }
    // The answers are on stdout, and nothing else is.
    std::os::unix::fs::symlink("/dev/stdout", folder.path().join("out.csv")).unwrap();
    for output in ["out.csv", "/dev/stdout"] {
        let text = format!("[input]\nfiles = \"a.xyz\"\n{}", volume(1, output));
        std::fs::write(folder.path().join("site.toml"), text).unwrap();
        let run = run(&folder, "site.toml --overwrite --json");
        run.fails(2, &["the output of a run file is not the standard output"]);
        assert_eq!(run.stdout, "");
    }
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

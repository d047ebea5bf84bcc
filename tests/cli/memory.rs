//! Verbs that ask a surface of points which are larger than the memory.

use std::fmt::Write as _;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

use super::{files_of, folder_with};

/// The least memory that can be given.
const LITTLE: &str = "16MB";

/// Text that is taken for more points than have room in it, in two files: numbers are long.
fn points() -> TempDir {
    let half = |from: u32| {
        let mut text = String::new();
        let zeros = "0".repeat(80);
        for i in 0..9000 {
            let [x, y] = [from + i % 100, i / 100];
            writeln!(text, "{x}.{zeros} {y}.{zeros} {}.{zeros}", x * y % 17).unwrap();
        }
        text
    };
    let line = |text: &str| super::geojson(25832, "LineString", text);
    folder_with(&[
        ("tiles/west.xyz", &half(0)),
        ("tiles/east.xyz", &half(100)),
        ("at.csv", "x,y\n10.5,20.25\n99.5,7\n199,89\n700,1\n"),
        ("checks.csv", "x,y,z\n10.5,20.25,8\n99.5,7,9\n50,60,0\n"),
        ("lines.geojson", &line("[[5.5,3],[120.25,50],[240,51]]")),
        ("tmp/kept", ""),
    ])
}

fn program(folder: &TempDir, words: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
    command
        .current_dir(folder.path())
        .env("TMPDIR", folder.path().join("tmp"))
        .args(words.split(' '))
        .stdin(Stdio::piped());
    command
}

fn run(folder: &TempDir, words: &str) -> (Option<i32>, String, String) {
    let Output {
        status,
        stdout,
        stderr,
    } = program(folder, words).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code(), text(stdout), text(stderr))
}

#[track_caller]
fn assert_left_nothing(folder: &TempDir) {
    assert_eq!(files_of(&folder.path().join("tmp")), ["kept"]);
}

#[test]
fn larger_points_are_asked_in_one_command() {
    let folder = points();
    for words in [
        "sample tiles/*.xyz --at at.csv --add height,slope",
        "accuracy tiles/*.xyz --checkpoints checks.csv --json",
        "volume tiles/*.xyz --levels 0:16:8 --json",
        "profile tiles/*.xyz --along lines.geojson --json",
        "compare tiles/*.xyz tiles/west.xyz --changed 1 --json --resolution 5",
    ] {
        let (code, whole, said) = run(&folder, words);
        assert_eq!(code, Some(0), "{words}: {said}");
        assert!(
            whole.len() > 50 && !said.contains("built in files"),
            "{words}: {said}"
        );
        let (code, parts, said) = run(&folder, &format!("{words} --memory {LITTLE}"));
        assert_eq!(code, Some(0), "{words}: {said}");
        assert!(said.contains("note: the points need more than "), "{said}");
        assert_eq!(whole, parts, "{words}");
        assert_left_nothing(&folder);
    }
    for (memory, out) in [("2GB", "a.geojson"), (LITTLE, "b.geojson")] {
        let words = format!("drape tiles/*.xyz --lines lines.geojson --memory {memory} -o {out}");
        let (code, _, said) = run(&folder, &words);
        assert_eq!(
            (code, said.contains("built in files")),
            (Some(0), memory == LITTLE),
            "{said}"
        );
    }
    assert_eq!(
        super::bytes(&folder, "a.geojson"),
        super::bytes(&folder, "b.geojson")
    );
    assert_left_nothing(&folder);
}

/// The points are in degrees, and a breakline crosses the parts of the surface.
#[test]
fn terrain_tiles_of_larger_points_are_the_same_files() {
    let zeros = "0".repeat(80);
    let half = |from: u32| {
        let mut text = String::new();
        for i in 0..9000 {
            let [x, y] = [from + i % 100, i / 100];
            let [lon, lat] = [7.0 + f64::from(x) * 1e-5, 46.0 + f64::from(y) * 1e-5];
            writeln!(
                text,
                "{lon:.5}{zeros} {lat:.5}{zeros} {}.{zeros}",
                x * y % 17
            )
            .unwrap();
        }
        text
    };
    let line = "[[7.000053,46.000042,40],[7.001905,46.00083,60]]";
    let folder = folder_with(&[
        ("tiles/west.xyz", &half(0)),
        ("tiles/east.xyz", &half(100)),
        ("crest.geojson", &super::geojson(4326, "LineString", line)),
        ("tmp/kept", ""),
    ]);
    let written = |memory: &str, out: &str| {
        let words = format!(
            "terrain-tiles tiles/*.xyz --breaklines crest.geojson --a-srs EPSG:4326 \
             --vertical-offset 0 --max-level 19 --max-error 2 --memory {memory} -o {out}"
        );
        let (code, _, said) = run(&folder, &words);
        assert_eq!(code, Some(0), "{said}");
        let built_in_files = said.contains("note: the points need more than ");
        let out = folder.path().join(out);
        let mut open = vec![out.clone()];
        let mut files: Vec<(std::path::PathBuf, Vec<u8>)> = Vec::new();
        while let Some(next) = open.pop() {
            match next.is_dir() {
                true => open.extend(std::fs::read_dir(&next).unwrap().map(|e| e.unwrap().path())),
                false => {
                    let name = next.strip_prefix(&out).unwrap().to_path_buf();
                    files.push((name, std::fs::read(&next).unwrap()));
                }
            }
        }
        files.retain(|(name, _)| !name.ends_with("layer.json"));
        files.sort();
        (built_in_files, files)
    };
    let (is_in_files, whole) = written("2GB", "whole");
    assert!(!is_in_files && whole.len() > 20, "{}", whole.len());
    let (is_in_files, parts) = written(LITTLE, "parts");
    assert!(is_in_files);
    assert!(whole == parts);
    assert_left_nothing(&folder);
    let names = std::fs::read_dir(folder.path()).unwrap();
    let is_hidden = |name: &std::ffi::OsString| name.to_string_lossy().starts_with('.');
    let hidden = names.map(|e| e.unwrap().file_name()).filter(is_hidden);
    assert_eq!(hidden.count(), 0);
}

#[test]
fn memory_that_cannot_be_kept_to_is_noted_or_refused() {
    let folder = points();
    let at = "--at at.csv";
    for (words, works, said) in [
        (
            format!("sample tiles/west.xyz {at} --memory 1MB"),
            false,
            "expected at least 16MB",
        ),
        (
            format!("sample tiles/*.xyz {at} --memory {LITTLE} --method nearest"),
            true,
            "note: --memory has no effect: tiles have linear heights only",
        ),
        (
            format!("sample tiles/*.xyz {at} --memory {LITTLE} --add-ridges"),
            true,
            "note: --memory has no effect: --add-ridges does not work with tiles yet",
        ),
        (
            format!("volume tiles/west.xyz --plane 3 --memory {LITTLE} --boundary none.shp"),
            false,
            "none.shp",
        ),
    ] {
        let (found, _, printed) = run(&folder, &words);
        assert!(printed.contains(said), "{words}: {printed}");
        assert_eq!(found == Some(0), works, "{words}: {printed}");
        assert_left_nothing(&folder);
    }
    let words = format!("sample tiles/*.xyz {at} --memory {LITTLE}");
    let lost = program(&folder, &words)
        .env("TMPDIR", "lost")
        .output()
        .unwrap();
    let said = String::from_utf8(lost.stderr).unwrap();
    assert!(
        said.contains("error: lost: ") && said.contains("TMPDIR"),
        "{said}"
    );
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_no_file_of_the_surface() {
    use std::os::unix::process::ExitStatusExt;
    use std::time::{Duration, Instant};

    let folder = points();
    let is_there = |name: &str| {
        let inner = std::fs::read_dir(folder.path().join("tmp")).unwrap();
        inner
            .flatten()
            .any(|entry| entry.path().join(name).exists())
    };
    // While tiles are made, and while points are waited for.
    for name in ["surface.tins.job", "surface.tins"] {
        let words = format!("sample tiles/*.xyz --at - --memory {LITTLE}");
        let mut child = program(&folder, &words)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // `wait` would close it, and at its end the program may be done before the signal is heard.
        let points = child.stdin.take();
        let start = Instant::now();
        while !is_there(name) {
            assert!(
                start.elapsed() < Duration::from_secs(120),
                "{name} has not appeared"
            );
            std::thread::sleep(Duration::from_millis(2));
        }
        let kill = ["-c", "kill -TERM \"$0\"", &child.id().to_string()];
        assert!(Command::new("sh").args(kill).status().unwrap().success());
        assert_eq!(child.wait().unwrap().signal(), Some(15));
        drop(points);
        assert_left_nothing(&folder);
    }
}

//! Outputs appear together or not at all, whatever stands at their places.

use std::io::Write;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::*;

fn program(folder: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
    command
        .current_dir(folder.path())
        .args(args)
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

fn make_fifo(folder: &TempDir, name: &str) {
    assert!(
        Command::new("mkfifo")
            .arg(folder.path().join(name))
            .status()
            .unwrap()
            .success()
    );
}

fn mode(path: &Path) -> u32 {
    std::fs::metadata(path).unwrap().permissions().mode() & 0o7777
}

fn set_mode(path: &Path, mode: u32) {
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
}

#[track_caller]
fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "{what} has not come"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn send(signal: &str, child: &Child) {
    // The one of the shell: not every system has a program `kill`.
    let words = ["-c", "kill \"$0\" \"$1\"", signal, &child.id().to_string()];
    assert!(Command::new("sh").args(words).status().unwrap().success());
}

#[test]
fn a_folder_in_the_way_is_known_before_the_work_and_nothing_is_left() {
    let folder = folder_with(&[
        ("broken.xyz", "no numbers at all\n"),
        ("c.prj/x", ""),
        ("b.node/x", ""),
        ("t.ply/x", ""),
    ]);
    std::fs::write(folder.path().join("p.node"), "broken").unwrap();
    let before = files_of(folder.path());
    for (args, name) in [
        (["contour", "broken.xyz", "-o", "c.shp"], "c.prj"),
        (["triangulate", "p.node", "-o", "b.edge"], "b.node"),
        (["tin", "broken.xyz", "-o", "t.ply"], "t.ply"),
    ] {
        run_in(&folder, &[&args[..], &["--overwrite"]].concat())
            .fails(1, &[name, "there is a folder with this name", "hint: "]);
        assert_eq!(files_of(folder.path()), before);
    }
}

#[test]
fn a_folder_that_comes_in_the_way_during_the_work_leaves_what_was_there() {
    let folder = folder_with(&[("c.geojson", "mine"), ("c.prj", "mine"), ("c.qix", "mine")]);
    let args = [
        "contour",
        "-",
        "-o",
        "c.geojson",
        "-o",
        "c.shp",
        "--overwrite",
    ];
    let mut child = program(&folder, &args)
        .stdin(Stdio::piped())
        .spawn()
        .unwrap();
    // Waits for points; should it not have come so far, the folder is found by the first check.
    std::thread::sleep(Duration::from_millis(300));
    std::fs::create_dir(folder.path().join("c.shp")).unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(SLOPE.as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("c.shp: there is a folder with this name"),
        "{said}"
    );
    assert_eq!(
        files_of(folder.path()),
        ["c.geojson", "c.prj", "c.qix", "c.shp"]
    );
    for name in ["c.geojson", "c.prj", "c.qix"] {
        assert_eq!(bytes(&folder, name), b"mine");
    }
}

#[test]
fn a_full_disk_leaves_no_output_of_the_run() {
    if !Path::new("/dev/full").exists() {
        return eprintln!("skipped: there is no /dev/full");
    }
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    symlink("/dev/full", folder.path().join("full.obj")).unwrap();
    let run = run_in(
        &folder,
        &[
            "tin", "a.xyz", "-o", "t.stl", "-o", "full.obj", "-o", "t.ply",
        ],
    );
    run.fails(
        1,
        &["error: full.obj: the disk is full", "hint: free some space"],
    );
    assert_eq!(files_of(folder.path()), ["a.xyz", "full.obj"]);
}

#[test]
fn a_folder_that_may_not_be_written_is_told_before_the_work() {
    let folder = folder_with(&[("broken.xyz", "no numbers at all\n"), ("locked/x", "")]);
    let locked = folder.path().join("locked");
    set_mode(&locked, 0o555);
    if std::fs::write(locked.join("y"), "").is_ok() {
        return eprintln!("skipped: root may write everywhere");
    }
    run_in(&folder, &["tin", "broken.xyz", "-o", "locked/t.ply"])
        .fails(1, &["locked/t.ply: no permission"]);
    set_mode(&locked, 0o755);
}

#[test]
fn a_signal_leaves_no_temporary_file() {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0);
    for (signal, number) in [("-INT", 2), ("-TERM", 15), ("-HUP", 1)] {
        // Tests in the background of a shell ignore some, and so do their children.
        if ignored >> (number - 1) & 1 == 1 {
            eprintln!("skipped: {signal} is ignored here");
            continue;
        }
        let folder = folder_with(&[("a.xyz", SLOPE)]);
        make_fifo(&folder, "wait.obj");
        let mut child = program(&folder, &["tin", "a.xyz", "-o", "t.ply", "-o", "wait.obj"])
            .spawn()
            .unwrap();
        // With the first mesh written, it waits for a reader of the second.
        wait_until("a temporary file", || {
            let hidden = |entry: std::fs::DirEntry| {
                entry
                    .file_name()
                    .to_string_lossy()
                    .starts_with(".breakline-")
            };
            std::fs::read_dir(folder.path())
                .unwrap()
                .any(|entry| hidden(entry.unwrap()))
        });
        send(signal, &child);
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(number), "{status}");
        assert_eq!(files_of(folder.path()), ["a.xyz", "wait.obj"]);
    }
}

#[test]
fn a_signal_that_the_parent_ignored_is_ignored() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    make_fifo(&folder, "wait.obj");
    let line = format!(
        "trap '' HUP; exec {} tin a.xyz -o wait.obj",
        assert_cmd::cargo::cargo_bin!("breakline").display()
    );
    let child = Command::new("sh")
        .args(["-c", &line])
        .current_dir(folder.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(200));
    send("-HUP", &child);
    // Ends once it is read.
    let read = std::fs::read(folder.path().join("wait.obj")).unwrap();
    assert!(!read.is_empty());
    assert!({ child }.wait().unwrap().success());
}

#[test]
fn pipes_and_devices_are_written_without_a_file() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(&folder, &["tin", "a.xyz", "-o", "t.obj"]).works(&[]);
    run_in(&folder, &["dem", "t.obj", "-o", "d.tif"]).works(&[]);
    // A GeoTIFF cannot be written from front to back.
    for (verb, file, pipe) in [("tin", "t.obj", "pipe.obj"), ("dem", "d.tif", "pipe.tif")] {
        make_fifo(&folder, pipe);
        let read = {
            let path = folder.path().join(pipe);
            std::thread::spawn(move || std::fs::read(path).unwrap())
        };
        run_in(&folder, &[verb, "a.xyz", "-o", pipe]).works(&[&format!("written     {pipe}\n")]);
        assert_eq!(read.join().unwrap(), bytes(&folder, file), "{pipe}");
        std::fs::remove_file(folder.path().join(pipe)).unwrap();
    }
    symlink("/dev/stdout", folder.path().join("out.obj")).unwrap();
    let run = run_in(&folder, &["tin", "a.xyz", "-o", "out.obj"]);
    run.works(&[]);
    assert_eq!(run.stdout.as_bytes(), bytes(&folder, "t.obj"));
    // The first format of one file, where no name tells another.
    let run = run_in(&folder, &["contour", "a.xyz", "-o", "/dev/stdout"]);
    run.works(&[]);
    assert!(
        run.stdout.starts_with("{\"type\":\"FeatureCollection\""),
        "{}",
        run.stdout
    );
    run_in(&folder, &["dem", "a.xyz", "-o", "/dev/null"]).works(&[]);
    assert_eq!(
        files_of(folder.path()),
        ["a.xyz", "d.tif", "out.obj", "t.obj"]
    );
}

#[test]
fn what_is_replaced_keeps_its_mode_and_its_links() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("t.ply", "old"),
        ("deep/real.obj", "old"),
        ("locked.off", "old"),
    ]);
    let path = |name: &str| folder.path().join(name);
    set_mode(&path("t.ply"), 0o640);
    set_mode(&path("locked.off"), 0o444);
    symlink("deep/real.obj", path("t.obj")).unwrap();
    // One that leads nowhere yet.
    symlink("deep/new.stl", path("t.stl")).unwrap();
    let run = run_in(&folder, &["tin", "a.xyz", "-o", "t.stl"]);
    run.fails(1, &["t.stl: the file exists"]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "-o",
            "t.ply",
            "-o",
            "locked.off",
            "--overwrite",
        ],
    );
    run.fails(
        1,
        &["locked.off: the file is read-only", "hint: ", "chmod u+w"],
    );
    assert_eq!(
        (bytes(&folder, "t.ply"), bytes(&folder, "locked.off")),
        (b"old".to_vec(), b"old".to_vec())
    );

    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "-o",
            "t.ply",
            "-o",
            "t.obj",
            "-o",
            "t.stl",
            "--overwrite",
        ],
    );
    run.works(&[]);
    assert_eq!(mode(&path("t.ply")), 0o640);
    assert!(bytes(&folder, "t.ply").starts_with(b"ply"));
    for (link, file) in [("t.obj", "deep/real.obj"), ("t.stl", "deep/new.stl")] {
        assert!(path(link).symlink_metadata().unwrap().is_symlink());
        assert!(bytes(&folder, file).len() > 10);
    }
    assert_eq!(files_of(&path("deep")), ["new.stl", "real.obj"]);
}

#[test]
fn one_file_by_two_names_is_named_twice() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(&folder, &["tin", "a.xyz", "-o", "t.ply", "-o", "./t.ply"]).fails(
        2,
        &["the output is named twice", "give one of them another name"],
    );
    assert_eq!(files_of(folder.path()), ["a.xyz"]);
}

/// The square of the slope, so far away.
fn slope_at(offset: u32) -> String {
    let moved = |line: &str| {
        let numbers: Vec<u32> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        format!(
            "{} {} {}\n",
            numbers[0] + offset,
            numbers[1] + offset,
            numbers[2]
        )
    };
    SLOPE.lines().map(moved).collect()
}

#[test]
fn a_raster_tells_its_size_before_the_work_and_must_not_be_mostly_empty() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.xyz", &slope_at(20_000))]);
    run_in(&folder, &["dem", "a.xyz", "-o", "a.tif"])
        .works(&["raster      3 x 3 cells of 1 unit, 1 kB before compression"]);
    let run = run_in(&folder, &["dem", "a.xyz", "b.xyz", "-o", "d.tif"]);
    run.fails(
        2,
        &[
            "20003 x 20003 cells",
            "the surface is scattered",
            "hint: leave out files",
            "--te 0,0,20003,20003",
        ],
    );
    run_in(
        &folder,
        &["dem", "a.xyz", "b.xyz", "-o", "d.tif", "--te", "0,0,10,10"],
    )
    .works(&["10 x 10 cells"]);
    // Not even a tenth of it fits on any disk.
    let wide = "0 0 0\n4000000 0 0\n0 4000000 0\n";
    std::fs::write(folder.path().join("w.xyz"), wide).unwrap();
    let run = run_in(
        &folder,
        &[
            "dem",
            "w.xyz",
            "--max-edge",
            "none",
            "--resolution",
            "0.1",
            "-o",
            "w.tif",
        ],
    );
    run.fails(
        1,
        &[
            "w.tif: the cells with a value take 3200000.0 GB",
            "are free on the disk",
            "hint: ",
        ],
    );
    assert_eq!(
        files_of(folder.path()),
        ["a.tif", "a.xyz", "b.xyz", "d.tif", "w.xyz"]
    );
}

#[test]
fn a_shapefile_that_would_be_too_large_is_foreseen() {
    let points: String = (0..120).map(|y| format!("0 {y} 0\n1 {y} 0.9\n")).collect();
    let folder = folder_with(&[("a.xyz", &points)]);
    let run = run_in(
        &folder,
        &["contour", "a.xyz", "--interval", "0.000001", "-o", "c.shp"],
    );
    run.fails(
        1,
        &[
            "c.shp: 21",
            "vertices take 5.1 GB; a shapefile holds 2 GB",
            "hint: write GeoJSON",
        ],
    );
    assert_eq!(files_of(folder.path()), ["a.xyz"]);
}

#[test]
fn too_little_memory_is_told_before_the_work() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(
        &folder,
        &["dem", "a.xyz", "--te", "0,0,4096,4096", "-o", "d.tif"],
    )
    .works(&[]);
    let limited = |kilobytes: u32, arguments: &str| {
        let line = format!(
            "ulimit -v {kilobytes} && exec {} {arguments}",
            assert_cmd::cargo::cargo_bin!("breakline").display()
        );
        Command::new("sh")
            .args(["-c", &line])
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    // What the program takes with its libraries (GDAL's are large), and half of what the raster
    // does.
    let to_start = (1..200)
        .map(|step| step * 16_384)
        .find(|&kilobytes| limited(kilobytes, "--version").status.success())
        .expect("the program starts within 3 GB");
    // The most cells that are not left in their file.
    let output = limited(to_start + 65_536, "hillshade d.tif -o s.tif --threads 1");
    let said = String::from_utf8(output.stderr).unwrap();
    if cfg!(target_os = "linux") {
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(
            said.contains("d.tif: a raster of 16777216 cells takes about 134 MB of memory, and "),
            "{said}"
        );
        assert!(
            said.contains("are left by the limit of the address space (ulimit -v)"),
            "{said}"
        );
    }
}

#[test]
fn memory_that_has_no_effect_is_noted_with_what_to_do() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    run("tin a.xyz -o x.ply --memory 2GB").works(&[
        "note: --memory has no effect: x.ply: tiles make a TIN in parts: name the output .tins\n",
    ]);
    run("dem a.xyz -o d.tif --memory 2GB --crossing-report c.csv")
        .works(&["note: --memory has no effect: --crossing-report does not work with tiles yet\n"]);
    assert!(!run("tin a.xyz -o y.ply").stderr.contains("--memory"));
}

/// The program looks at the kind of a file before it reads it: a pipe can be opened only once.
#[test]
fn a_pipe_is_opened_once_and_read_to_its_end() {
    // More than a pipe holds: a writer whose reader is gone is killed.
    let text: String = (0..2500)
        .map(|i| format!("{:.9} {:.9} {:.9}\n", i % 50, i / 50, i % 7))
        .collect();
    let folder = folder_with(&[("a.xyz", &text), ("b.xyz", SLOPE)]);
    let line = geojson(25832, "LineString", "[[5.5,5.5,1],[70.5,80.5,1]]");
    std::fs::write(folder.path().join("l.geojson"), line).unwrap();
    let lidar = testkit::lidar::las(&testkit::lidar::tile([0.0, 0.0], 2), Some(25832));
    std::fs::write(folder.path().join("a.las"), lidar).unwrap();
    run_in(&folder, &["tin", "a.xyz", "-o", "a.ply"]).works(&[]);
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin"]).works(&[]);
    run_in(&folder, &["dem", "a.xyz", "-o", "a.tif"]).works(&[]);
    run_in(&folder, &["hillshade", "a.xyz", "-o", "a.png"]).works(&[]);
    for (from, pipe, words, code) in [
        ("a.xyz", "p", "tin p -o t.ply", 0),
        ("a.xyz", "p.xyz", "tin p.xyz b.xyz -o t.ply", 0),
        ("a.xyz", "p.xyz", "dem p.xyz -o t.tif --memory 100MB", 0),
        ("a.xyz", "p.xyz", "dem p.xyz -o t.tif --tiles 2x2", 2),
        ("a.xyz", "p.txt", "info p.txt", 0),
        ("a.xyz", "p.txt", "points p.txt -o t.xyz", 0),
        ("a.xyz", "p.xyz", "check p.xyz", 0),
        ("a.las", "p.las", "tin p.las -o t.ply", 0),
        ("a.las", "p.laz", "dem p.laz -o t.tif", 0),
        ("a.las", "p.las", "info p.las", 0),
        ("a.ply", "p.ply", "dem p.ply -o t.tif", 0),
        ("a.ply", "p.ply", "info p.ply", 0),
        ("a.ply", "p.ply", "check p.ply", 0),
        ("a.tin", "p.tin", "dem p.tin -o t.tif", 2),
        ("a.tif", "p.tif", "hillshade p.tif -o t.png", 2),
        ("a.tif", "p.tif", "dem a.xyz --align-to p.tif -o t.tif", 2),
        ("a.tif", "p.tif", "info p.tif", 1),
        ("a.png", "p.png", "info p.png", 0),
        (
            "l.geojson",
            "p.geojson",
            "tin a.xyz --breaklines p.geojson -o t.ply",
            0,
        ),
        (
            "l.geojson",
            "p.geojson",
            "tin a.xyz --boundary p.geojson -o t.ply",
            1,
        ),
        ("l.geojson", "p.geojson", "info p.geojson", 0),
        (
            "l.geojson",
            "p.shp",
            "tin a.xyz --breaklines p.shp -o t.ply",
            1,
        ),
    ] {
        make_fifo(&folder, pipe);
        let line = format!("cat {from} > {pipe}");
        let mut cat = Command::new("sh")
            .args(["-c", &line])
            .current_dir(folder.path())
            .spawn()
            .unwrap();
        let words: Vec<&str> = words
            .split(' ')
            .chain(
                ["--overwrite"]
                    .into_iter()
                    .filter(|_| words.contains("-o ")),
            )
            .collect();
        let mut run = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
        // Only a program that waits for a second writer takes that long.
        let run = run
            .current_dir(folder.path())
            .args(&words)
            .timeout(Duration::from_secs(120))
            .output()
            .unwrap();
        assert_eq!(
            run.status.code(),
            Some(code),
            "{words:?}: {}",
            String::from_utf8_lossy(&run.stderr)
        );
        // Nobody may have read it.
        let _ = cat.kill();
        cat.wait().unwrap();
        std::fs::remove_file(folder.path().join(pipe)).unwrap();
    }
}

/// The files that are read along with an input are inputs, whatever the case of their names, and
/// whether they exist or not: one that appears is read from then on.
#[test]
fn what_is_read_along_with_an_input_is_not_replaced() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("list.txt", "a.xyz\n"), ("o/x", "")]);
    run_in(
        &folder,
        &["contour", "a.xyz", "--a-srs", "EPSG:25832", "-o", "q.shp"],
    )
    .works(&[]);
    let path = |name: &str| folder.path().join(name);
    std::fs::rename(path("q.shp"), path("q.SHP")).unwrap();
    std::fs::rename(path("q.prj"), path("q.PRJ")).unwrap();
    std::fs::remove_file(path("q.cpg")).unwrap();
    std::fs::write(path("n.node"), "4 2 0 0\n1 0 0\n2 9 0\n3 9 9\n4 0 9\n").unwrap();
    std::fs::write(
        path("n.POLY"),
        "0 2 0 0\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n",
    )
    .unwrap();
    run_in(&folder, &["tin", "a.xyz", "--tiles", "2x2", "-o", "s.tins"]).works(&[]);
    let parts = files_of(folder.path())
        .into_iter()
        .find(|name| name.starts_with("s.tins."))
        .unwrap();
    let part = format!("{parts}/{}", files_of(&path(&parts))[0]);
    let lines = "--breaklines q.SHP --a-srs EPSG:25832";
    for (words, refused, why) in [
        (
            format!("contour a.xyz {lines} -o q.shp"),
            "q.shx",
            "a file of this name is read with an input, q.SHP",
        ),
        (
            format!("contour a.xyz {lines} -o ./o/../q.shp"),
            "q.shx",
            "read with an input, q.SHP",
        ),
        (
            format!("contour a.xyz {lines} -o o/../Q.shp"),
            "Q.shx",
            "read with an input, q.SHP",
        ),
        (
            format!("contour a.xyz {lines} -o q.SHP"),
            "q.SHP",
            "the output is one of the inputs",
        ),
        (
            "contour a.xyz --boundary q.SHP::Z -o q.shp".to_owned(),
            "q.shx",
            "read with an input, q.SHP",
        ),
        (
            "triangulate n.POLY -o n.ele".to_owned(),
            "n.node",
            "a file of this name is read with an input, n.POLY",
        ),
        (
            "triangulate n.POLY -o N.node".to_owned(),
            "N.node",
            "read with an input, n.POLY",
        ),
        (
            format!("tin s.tins -o {part}"),
            ".tin",
            "read with an input, s.tins",
        ),
        (
            "points @list.txt -o list.txt".to_owned(),
            "list.txt",
            "the output is one of the inputs",
        ),
        (
            "check @list.txt --crossing-report list.txt".to_owned(),
            "list.txt",
            "is not a format",
        ),
    ] {
        let contents = || -> Vec<Vec<u8>> {
            let own = files_of(folder.path())
                .into_iter()
                .filter(|name| path(name).is_file());
            own.map(|name| bytes(&folder, &name))
                .chain([bytes(&folder, &part)])
                .collect()
        };
        let before = (files_of(folder.path()), contents());
        let words: Vec<&str> = words.split(' ').chain(["--overwrite"]).collect();
        run_in(&folder, &words).fails(2, &[refused, why]);
        assert!((files_of(folder.path()), contents()) == before, "{words:?}");
    }
    // Elsewhere the name is free.
    let words = format!("contour a.xyz {lines} -o o/q.shp");
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).works(&[]);
}

//! The demo, and the tasks of the README on what it leaves.

use super::{files_of, folder_with, run_in};

#[test]
fn the_demo_runs_every_verb_and_prints_each_command() {
    let folder = folder_with(&[]);
    let run = run_in(&folder, &["demo", "a valley"]);
    run.works(&[
        "$ breakline info 'a valley/valley.laz'",
        "$ breakline tin ",
        "$ breakline check ",
        "$ breakline dem ",
        "$ breakline hillshade ",
        "$ breakline contour ",
    ]);
    assert!(!run.stderr.contains("warning: "), "{}", run.stderr);
    assert!(
        run.stdout.contains("62776 points") && run.stdout.contains("no flaw found"),
        "{}",
        run.stdout
    );
    let files = files_of(&folder.path().join("a valley"));
    for name in [
        "ground.ply",
        "ground.obj",
        "ground.tif",
        "hillshade.png",
        "contours.shp",
        "contours.prj",
        "contours.geojson",
    ] {
        assert!(
            files.iter().any(|file| file == name),
            "{name} is not in {files:?}"
        );
    }
    // Once more, over what is there.
    run_in(&folder, &["demo", "a valley", "-q"]).works(&[]);
    // `FOLDER/*` names parts of shapefiles, which are no files of their own.
    let run = run_in(&folder, &["info", "a valley/b*", "a valley/contours.*"]);
    run.works(&[]);
    assert!(
        run.stdout.contains("boundary.shp\n") && !run.stdout.contains(".dbf"),
        "{}",
        run.stdout
    );
}

/// Git ignores the folder that `demo` writes to by default.
#[test]
fn a_clone_stays_clean_after_the_demo() {
    let help = run_in(&folder_with(&[]), &["demo", "--help"]);
    assert!(
        help.stdout.contains("[default: breakline-demo]"),
        "{}",
        help.stdout
    );
    assert!(
        include_str!("../../.gitignore")
            .lines()
            .any(|line| line == "/breakline-demo")
    );
}

#[test]
fn the_tasks_of_the_readme_run_on_what_the_demo_leaves() {
    let folder = folder_with(&[]);
    run_in(&folder, &["demo", "."]).works(&[]);
    let readme = include_str!("../../README.md");
    let tasks = readme
        .split("## Tasks")
        .nth(1)
        .unwrap()
        .split("\n## ")
        .next()
        .unwrap();
    let commands: Vec<&str> = tasks
        .lines()
        .filter_map(|line| line.strip_prefix("    breakline "))
        .collect();
    assert_eq!(commands.len(), 19, "{commands:?}");
    for command in commands {
        let run = run_in(&folder, &command.split_whitespace().collect::<Vec<_>>());
        assert_eq!(run.code, 0, "{command}:\n{}", run.stderr);
        assert!(
            !run.stderr.contains("warning: "),
            "{command}:\n{}",
            run.stderr
        );
    }
}

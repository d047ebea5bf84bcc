//! Jobs believe no file that is not theirs and whole.

use std::path::{Path, PathBuf};

use tempfile::TempDir;
use testkit::lidar;

use super::{bytes, mark_of, output_of, plan_valley, program, run, valley};
use program::files_of;

/// All files below a folder, with their bytes, in order.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for name in files_of(folder) {
        let path = folder.join(name);
        if path.is_dir() {
            all.extend(contents(&path))
        } else {
            all.push((path.clone(), bytes(&path)))
        }
    }
    all
}

#[test]
fn a_folder_that_is_no_job_is_left_as_it_is() {
    let valley = valley();
    for plan in [
        "{}",
        "",
        "deadbeef\n{}",
        "{\"tasks\": 3, \"version\": \"1\", \"request\": \"x\", \"layout\": []}",
    ] {
        let folder = program::folder_with(&[
            ("own/plan.json", plan),
            ("own/lock", "mine"),
            ("own/command.json", "{\"steps\": 7}"),
            ("own/tasks/monday.txt", "buy milk"),
            ("own/tasks/000000.task", "a task of mine"),
        ]);
        let before = contents(folder.path());
        run(&folder, "job clean own").fails(1, &["own/plan.json: this is not the plan of a job"]);
        let words = format!("dem {valley} --tiles 2x2 --job own -o dem.tif");
        for words in [&words, &format!("{words} --resume")] {
            let refused = run(&folder, words);
            refused.fails(
                1,
                &[
                    "own/plan.json: this is not the plan of a job",
                    "name another folder (--job)",
                ],
            );
            assert!(
                !refused.stderr.contains("clean") && !refused.stderr.contains("remove"),
                "{}",
                refused.stderr
            );
        }
        run(
            &folder,
            &format!("job plan own -- dem {valley} --tiles 2x2 -o dem.tif"),
        )
        .fails(1, &["own/plan.json"]);
        assert_eq!(contents(folder.path()), before);
    }
    // Without a plan, the command of something else.
    let folder = program::folder_with(&[("own/command.json", "[1]"), ("own/lock", "mine")]);
    let before = contents(folder.path());
    run(
        &folder,
        &format!("dem {valley} --tiles 2x2 --job own -o dem.tif"),
    )
    .fails(
        2,
        &[
            "own/command.json: this was not written by a job",
            "name another folder",
        ],
    );
    run(&folder, "job clean own").fails(2, &["there is no job in this folder"]);
    assert_eq!(contents(folder.path()), before);
}

#[test]
fn what_a_job_did_not_write_stays_when_it_is_removed() {
    let folder = program::folder_with(&[
        ("kept/lock", "mine"),
        ("kept/tasks/notes.txt", "buy milk"),
        ("kept/tasks/000099.task", "not of this job, which has 7"),
        ("kept/tasks/.swap", "x"),
        ("kept/.x.unfinished", "not named as this program does"),
        ("kept/more/tasks/000000.task", "deep"),
    ]);
    let before = contents(folder.path());
    let valley = valley();
    run(
        &folder,
        &format!("job plan kept -- dem {valley} --tiles 2x2 -o dem.tif"),
    )
    .works(&[]);
    run(&folder, "job run kept").works(&[]);
    std::fs::write(
        folder
            .path()
            .join("kept/tasks/.breakline-abcdef.unfinished"),
        "of a task that was killed",
    )
    .unwrap();
    assert_eq!(files_of(&folder.path().join("kept/tasks")).len(), 7 + 4);
    run(&folder, "job clean kept").works(&[]);
    std::fs::remove_file(folder.path().join("dem.tif")).unwrap();
    assert_eq!(contents(folder.path()), before);
    // The folder that a run chooses itself, too.
    std::fs::create_dir(folder.path().join("dem.tif.job")).unwrap();
    std::fs::write(folder.path().join("dem.tif.job/mine"), "x").unwrap();
    run(&folder, &format!("dem {valley} --tiles 2x2 -o dem.tif")).works(&[]);
    assert_eq!(files_of(&folder.path().join("dem.tif.job")), ["mine"]);
}

/// The name of the output is in no other file.
#[test]
fn the_command_of_a_job_is_verified() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    run(
        &folder,
        &format!("job plan j -- dem {valley} --tiles 2x2 -o dem.tif"),
    )
    .works(&[]);
    let path = folder.path().join("j/command.json");
    let text = String::from_utf8(bytes(&path)).unwrap();
    std::fs::write(&path, text.replace("dem.tif", "dam.tif")).unwrap();
    for words in ["job run j", "job run j --task 0", "job status j"] {
        run(&folder, words).fails(
            1,
            &["j/command.json: the command of the job is damaged, or that of another one"],
        );
    }
    assert_eq!(files_of(folder.path()), ["j"]);
    run(&folder, "job clean j").works(&[]);
    run(
        &folder,
        &format!("dem {valley} --tiles 2x2 -o dem.tif --job j"),
    )
    .works(&[]);
    run(&folder, "job run j").fails(
        2,
        &[
            "that of a command which goes on itself",
            "with --resume and --job",
        ],
    );
}

/// A flipped byte in a divided file gave heights that were wrong by hundreds of meters.
#[test]
fn a_task_refuses_a_damaged_file_of_another() {
    let folder = tempfile::tempdir().unwrap();
    plan_valley(&folder);
    run(&folder, "job run j --task 0").works(&[]);
    let path = folder.path().join("j/tasks/000000.task");
    let whole = bytes(&path);
    let mut damaged = whole.clone();
    // A byte of a height in the points of the first tile, as it happens.
    damaged[22] ^= 0x40;
    std::fs::write(&path, &damaged).unwrap();
    // Whoever finds it removes it: a queue repeats what is not done.
    let refused = run(&folder, "job run j --task 1");
    refused.fails(
        4,
        &[
            "000000.task",
            "task 0 (divide",
            "its file was damaged",
            "do it again",
        ],
    );
    run(&folder, "job status j").ends(0, &["0 of 7 tasks are done"]);
    run(&folder, "job run j --task 0").works(&[]);
    assert!(bytes(&path) == whole);
    // Nobody has read it; an end that is missing; and by a command of its own.
    std::fs::write(&path, &damaged).unwrap();
    run(&folder, "job run j --task 0").works(&[]);
    assert!(bytes(&path) == whole);
    std::fs::write(&path, &whole[..whole.len() - 3]).unwrap();
    run(&folder, "job run j --task 1").fails(4, &["its file was damaged"]);
    std::fs::write(&path, &damaged).unwrap();
    run(&folder, "job status j --verify").ends(0, &["0 of 7 tasks are done"]);
    assert!(files_of(&folder.path().join("j/tasks")).is_empty());
    run(&folder, "job run j --task 0").works(&[]);
    assert!(bytes(&path) == whole);
    run(&folder, "job run j").works(&[]);
    let (expected, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    assert!(bytes(folder.path().join("dem.tif")) == expected);
}

/// The command line is right, so it is no wrong usage: doing the other task repairs it.
#[test]
fn a_task_waits_for_what_another_job_has_in_its_place() {
    let folder = tempfile::tempdir().unwrap();
    for job in ["j", "k"] {
        run(
            &folder,
            &format!("job plan {job} -- dem {} --tiles 2x2 -o dem.tif", valley()),
        )
        .works(&[]);
        run(&folder, &format!("job run {job} --task 0")).works(&[]);
    }
    let [own, other] = ["j", "k"].map(|job| folder.path().join(job).join("tasks/000000.task"));
    std::fs::copy(&other, &own).unwrap();
    run(&folder, "job run j --task 1")
        .fails(4, &["j/tasks/000000.task: this is the file of another job"]);
    run(&folder, "job status j").ends(0, &["0 of 7 tasks are done", "next: 0"]);
    run(&folder, "job run j --task 0").works(&[]);
    run(&folder, "job run j --task 1").works(&[]);
}

/// The file of a task is made again, and differs, as its input does: so is what was made from it.
#[test]
fn what_was_made_from_another_file_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let points = |z: f64| {
        let points: Vec<([f64; 3], u8)> = (0..100)
            .map(|i| ([f64::from(i % 10), f64::from(i / 10), z], 2))
            .collect();
        lidar::las(&points, Some(25832))
    };
    let [a, b] = ["a.las", "b.las"].map(|name| folder.path().join(name));
    std::fs::write(&a, points(1.0)).unwrap();
    std::fs::write(&b, points(3.0)).unwrap();
    run(
        &folder,
        "job plan j -- dem a.las b.las --tiles 2x2 --duplicates mean -o dem.tif",
    )
    .works(&[]);
    let task_count = 2 + 4 + 1 + 1;
    for task in 0..task_count {
        run(&folder, &format!("job run j --task {task}")).works(&[]);
    }
    // The first file was lost, and its input was replaced by one with as many points and its
    // extent.
    std::fs::remove_file(folder.path().join("j/tasks/000000.task")).unwrap();
    std::fs::write(&a, points(2.0)).unwrap();
    run(&folder, "job run j --task 0").works(&[]);
    run(&folder, "job status j").ends(0, &["2 of 8 tasks are done", "next: 2"]);
    run(&folder, "job run j --task 8").fails(
        4,
        &[
            "task 2 (tile 0) is not done",
            "was made again",
            "do it again",
        ],
    );
    run(&folder, "job run j").works(&[]);
    let (expected, _) = output_of(&folder, "dem a.las b.las --duplicates mean", "whole.tif");
    assert!(bytes(folder.path().join("dem.tif")) == expected);
}

#[cfg(target_os = "linux")]
mod at_once {
    use std::fs::File;
    use std::process::{Child, Command, Output, Stdio};

    use super::*;

    /// Starts the program and waits until it waits for the lock of a job.
    fn start_and_wait(folder: &TempDir, words: &str, lock: &Path) -> Child {
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
        let program = program
            .current_dir(folder.path())
            .args(words.split_whitespace());
        let child = program.stderr(Stdio::piped()).spawn().unwrap();
        let lock = lock.canonicalize().unwrap();
        let open = format!("/proc/{}/fd", child.id());
        let has_lock = || {
            let files = std::fs::read_dir(&open).unwrap().flatten();
            files
                .filter_map(|file| std::fs::read_link(file.path()).ok())
                .any(|path| path == lock)
        };
        while !has_lock() {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        child
    }

    fn said(child: Child) -> (Option<i32>, String) {
        let Output { status, stderr, .. } = child.wait_with_output().unwrap();
        (status.code(), String::from_utf8(stderr).unwrap())
    }

    /// One command waits for the lock, and gets it when the job is that of another one.
    #[test]
    fn two_commands_in_one_folder_do_not_mix() {
        let folder = tempfile::tempdir().unwrap();
        let valley = valley();
        let words = format!("dem {valley} --tiles 2x2 -o one.tif --job kept --resume");
        run(&folder, &words).works(&[]);
        std::fs::remove_file(folder.path().join("one.tif")).unwrap();
        run(
            &folder,
            &format!("job plan other -- dem {valley} --class 5 --tiles 2x2 -o two.tif"),
        )
        .works(&[]);
        let [kept, other] = ["kept", "other"].map(|name| folder.path().join(name));
        let lock = kept.join("lock");
        let held = File::open(&lock).unwrap();
        held.lock().unwrap();

        // A job that goes on, and one of its tasks.
        for words in [&words, &format!("{words} --threads 1")] {
            let plan = bytes(kept.join("plan.json"));
            let waiting = start_and_wait(&folder, words, &lock);
            std::fs::copy(other.join("plan.json"), kept.join("plan.json")).unwrap();
            held.unlock().unwrap();
            let (code, text) = said(waiting);
            assert!(
                code == Some(2)
                    && text.contains("the job was removed or replaced by another process"),
                "{text}"
            );
            std::fs::write(kept.join("plan.json"), plan).unwrap();
            held.lock().unwrap();
        }
        // A new one, which finds another at the end.
        let plan = kept.join("plan.json");
        std::fs::remove_file(&plan).unwrap();
        let waiting = start_and_wait(&folder, &words, &lock);
        std::fs::copy(other.join("plan.json"), &plan).unwrap();
        held.unlock().unwrap();
        let (code, text) = said(waiting);
        assert!(
            code == Some(2) && text.contains("there is a job in this folder already"),
            "{text}"
        );
        assert_eq!(bytes(plan), bytes(other.join("plan.json")));
        assert!(!folder.path().join("one.tif").exists());
    }

    /// The job is removed, and planned again, with a new lock, while another waits for the old one.
    #[test]
    fn a_lock_that_was_removed_holds_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let words = format!("dem {} --tiles 2x2 -o one.tif --job kept", valley());
        run(
            &folder,
            &format!("job plan kept -- {}", words.replace(" --job kept", "")),
        )
        .works(&[]);
        let lock = folder.path().join("kept/lock");
        let old = File::open(&lock).unwrap();
        old.lock().unwrap();
        let waiting = start_and_wait(&folder, "job run kept --task 0", &lock);
        std::fs::remove_file(&lock).unwrap();
        let new = File::create(&lock).unwrap();
        new.lock().unwrap();
        old.unlock().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(300));
        assert!(files_of(&folder.path().join("kept/tasks")).is_empty());
        new.unlock().unwrap();
        let (code, text) = said(waiting);
        assert_eq!(code, Some(0), "{text}");
    }
}

fn output_is_done(folder: &TempDir, job: &str) -> bool {
    let status = run(folder, &format!("job status {job} --json"));
    let status: serde_json::Value = serde_json::from_str(&status.stdout).unwrap();
    status["tasks"].as_array().unwrap().last().unwrap()["done"] == true
}

#[test]
fn an_output_counts_by_its_bytes_and_not_by_its_date() {
    use std::time::{Duration, SystemTime};
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    for (job, verb, out) in [
        ("j", "dem", "dem.tif"),
        ("k", "contour --interval 5", "lines.shp"),
        ("l", "tin", "x.tins"),
    ] {
        run(
            &folder,
            &format!("job plan {job} -- {verb} {valley} --tiles 2x2 -o {out}"),
        )
        .works(&[]);
        assert!(!output_is_done(&folder, job));
        run(&folder, &format!("job run {job}")).works(&[]);
        let path = folder.path().join(out);
        let whole = bytes(&path);
        // Clocks that disagree: the files of the tasks are from tomorrow.
        let tasks = folder.path().join(job).join("tasks");
        for name in files_of(&tasks) {
            let file = std::fs::File::options()
                .append(true)
                .open(tasks.join(name))
                .unwrap();
            file.set_modified(SystemTime::now() + Duration::from_secs(86_400))
                .unwrap();
        }
        assert!(output_is_done(&folder, job), "{verb}");
        run(&folder, &format!("job run {job}")).works(&["is written"]);
        // As a batch queue repeats the last task.
        let last = files_of(&tasks).len();
        run(&folder, &format!("job run {job} --task {last}")).works(&["is written"]);
        // A newer file, of the same length, that the job has not written.
        let mut other = whole.clone();
        let middle = other.len() / 2;
        other[middle] ^= 1;
        std::fs::write(&path, &other).unwrap();
        assert!(!output_is_done(&folder, job), "{verb}");
        run(&folder, &format!("job run {job}")).fails(1, &["the file exists"]);
        assert!(bytes(&path) == other);
        let stem = format!("{}.", path.file_stem().unwrap().to_str().unwrap());
        let own = files_of(folder.path())
            .into_iter()
            .filter(|name| name.starts_with(&stem));
        own.map(|name| folder.path().join(name))
            .filter(|path| path.is_file())
            .for_each(|path| {
                std::fs::remove_file(path).unwrap();
            });
        run(&folder, &format!("job run {job}")).works(&[]);
        assert!(
            bytes(&path) == whole && output_is_done(&folder, job),
            "{verb}"
        );
    }
    // What belongs to the output belongs to it here, too.
    std::fs::remove_file(folder.path().join("lines.dbf")).unwrap();
    assert!(!output_is_done(&folder, "k"));
    let parts = files_of(folder.path())
        .into_iter()
        .find(|name| name.starts_with("x.tins."))
        .unwrap();
    std::fs::remove_file(folder.path().join(parts).join("000000.tin")).unwrap();
    assert!(!output_is_done(&folder, "l"));
}

/// A writer that was killed leaves a temporary file next to the output.
#[test]
fn temporary_files_of_an_output_are_removed_when_a_job_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    plan_valley(&folder);
    let mark = mark_of(&folder, "j");
    let file = |name: &str| folder.path().join(name);
    let left = format!(".breakline-{mark}-abcdef");
    std::fs::write(file(&left), "half of a DEM").unwrap();
    // Of another run, which may still write; and a file that a commit had set aside.
    let others = [".breakline-zyxwvu".to_owned(), format!("{left}.old")];
    others
        .iter()
        .for_each(|name| std::fs::write(file(name), "x").unwrap());
    run(&folder, "job run j").works(&[]);
    assert!(
        !file(&left).exists() && others.iter().all(|name| file(name).exists()),
        "{:?}",
        files_of(folder.path())
    );
}

//! Jobs that are interrupted, and jobs whose tasks run one by one.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime};

use super::{bytes, layer, output_of, program, valley};
use program::{files_of, run_in};

/// The tasks that are done, with the times at which they were.
fn done(job: &Path) -> Vec<(String, SystemTime)> {
    let tasks = job.join("tasks");
    let names = files_of(&tasks)
        .into_iter()
        .filter(|name| name.ends_with(".task"));
    names
        .map(|name| {
            (
                name.clone(),
                std::fs::metadata(tasks.join(&name))
                    .unwrap()
                    .modified()
                    .unwrap(),
            )
        })
        .collect()
}

#[test]
fn other_options_of_a_map_are_named_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let points: String = (0..400)
        .map(|k| {
            let [x, y] = [k % 20, k / 20];
            format!("{x} {y} {}\n", (x * x + 3 * y) % 7)
        })
        .collect();
    std::fs::write(folder.path().join("p.xyz"), points).unwrap();
    let run = |options: &str| {
        let words = format!("contour p.xyz --tiles 2x2 --job j --overwrite -o c.geojson {options}");
        run_in(&folder, &words.split_whitespace().collect::<Vec<_>>())
    };
    run("--preset cartographic --labels-output l.geojson").works(&[]);
    for (options, differs) in [
        (
            "--preset cartographic --labels-output l.geojson --min-area 50 --labels uphill",
            "--labels, --min-area\n",
        ),
        ("--preset cartographic", "--labels-output\n"),
        ("--labels-output l.geojson --2d", "--2d, --preset\n"),
        ("", "--labels-output, --preset\n"),
    ] {
        let differs = format!("what differs: {differs}");
        run(&format!("{options} --resume --dry-run")).fails(2, &[&differs]);
    }
}

#[test]
fn what_is_missing_or_damaged_is_done_again_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!("dem {} --tiles 3x3 --job kept", valley());
    let (whole, _) = output_of(&folder, &words, "whole.tif");
    let tasks = folder.path().join("kept/tasks");
    let before = done(&folder.path().join("kept"));
    assert_eq!(before.len(), 12);
    std::fs::remove_file(tasks.join("000004.task")).unwrap();
    let mut damaged = bytes(tasks.join("000007.task"));
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    std::fs::write(tasks.join("000007.task"), damaged).unwrap();
    let cut = bytes(tasks.join("000002.task"));
    std::fs::write(tasks.join("000002.task"), &cut[..cut.len() - 3]).unwrap();
    std::fs::write(tasks.join(".breakline-x.unfinished"), "x").unwrap();

    let run = run_in(
        &folder,
        &words
            .split(' ')
            .chain(["-o", "again.tif"])
            .collect::<Vec<_>>(),
    );
    run.fails(2, &["there is a job in this folder already", "--resume"]);
    let (again, said) = output_of(&folder, &format!("{words} --resume"), "whole.tif");
    assert!(
        again == whole && said.contains("9 of 12 tasks are done"),
        "{said}"
    );
    let after = done(&folder.path().join("kept"));
    let same = before.iter().filter(|task| after.contains(task)).count();
    assert_eq!((after.len(), same, files_of(&tasks).len()), (12, 9, 12));

    // Another command, a changed input, a damaged plan.
    let other = format!("{words} --resume --resolution 2 -o other.tif");
    run_in(&folder, &other.split(' ').collect::<Vec<_>>()).fails(
        2,
        &["that of another command; what differs: --resolution\n"],
    );
    std::fs::copy(valley(), folder.path().join("b.laz")).unwrap();
    let others = format!("{words} b.laz --resume --class 2 --max-edge 7 -o other.tif");
    run_in(&folder, &others.split(' ').collect::<Vec<_>>())
        .fails(2, &["what differs: --class, --max-edge, the inputs\n"]);
    let others = format!("{words} --resume -o other.geojson").replacen("dem", "contour", 1);
    run_in(&folder, &others.split(' ').collect::<Vec<_>>()).fails(2, &["what differs: the verb\n"]);
    std::fs::write(folder.path().join("kept/plan.json"), "{}").unwrap();
    let resumed = format!("{words} --resume -o other.tif");
    run_in(&folder, &resumed.split(' ').collect::<Vec<_>>()).fails(
        1,
        &["kept/plan.json: this is not the plan of a job, or it is damaged"],
    );
}

/// What is left of a job whose plan is gone belongs to no other one.
#[test]
fn tasks_without_a_plan_do_not_count() {
    let folder = tempfile::tempdir().unwrap();
    output_of(
        &folder,
        &format!("dem {} --tiles 2x2 --job kept", valley()),
        "one.tif",
    );
    std::fs::remove_file(folder.path().join("kept/plan.json")).unwrap();
    let words = format!(
        "dem {} --tiles 2x2 --class 5 --duplicates highest",
        valley()
    );
    let (tiled, _) = output_of(&folder, &format!("{words} --job kept"), "two.tif");
    let (whole, _) = output_of(&folder, &words.replace(" --tiles 2x2", ""), "three.tif");
    assert!(tiled == whole);
}

/// A removal that was killed between the tasks and the plan.
#[test]
fn a_plan_without_tasks_can_go_on_or_be_removed() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!("dem {} --tiles 2x2 --job kept", valley());
    let (whole, _) = output_of(&folder, &words, "one.tif");
    let tasks = folder.path().join("kept/tasks");
    std::fs::remove_dir_all(&tasks).unwrap();
    let (again, said) = output_of(&folder, &format!("{words} --resume"), "one.tif");
    assert!(
        again == whole && said.contains("0 of 7 tasks are done"),
        "{said}"
    );
    std::fs::remove_dir_all(&tasks).unwrap();
    run_in(&folder, &["job", "clean", "kept"]).works(&[]);
    assert_eq!(files_of(folder.path()), ["one.tif"]);
}

#[test]
fn a_plan_is_refused_if_its_output_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let valley = valley();
    let plan = |words: &str| {
        let words = format!("job plan j -- dem {valley} {words}");
        run_in(&folder, &words.split(' ').collect::<Vec<_>>())
    };
    plan("-o none/x.tif").fails(1, &["the folder does not exist"]);
    plan("-o x.docx").fails(2, &["is not a format that can be written here"]);
    plan("-o x.tif --dry-run").fails(2, &["the command of a job has no --dry-run"]);
    plan("-o x.tif --tiles 2000000x2").fails(2, &["expected `auto`, or columns and rows"]);
    let words = format!("dem {valley} --tiles 2x2 --job x.tif -o x.tif");
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).fails(2, &["have the same name"]);
    let words = format!("job plan ./x.tif -- dem {valley} --tiles 2x2 -o x.tif");
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).fails(2, &["have the same name"]);
    assert!(files_of(folder.path()).is_empty());
}

#[test]
fn a_file_that_changes_after_the_plan_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(valley(), folder.path().join("a.laz")).unwrap();
    run_in(
        &folder,
        &[
            "job", "plan", "j", "--", "dem", "a.laz", "-o", "dem.tif", "--tiles", "2x2",
        ],
    )
    .works(&[]);
    // Before a task has read it, it might have been repaired.
    run_in(&folder, &["job", "run", "j", "--task", "0"]).works(&[]);
    let mut changed = bytes(valley());
    changed.push(0);
    std::fs::write(folder.path().join("a.laz"), changed).unwrap();
    run_in(&folder, &["job", "run", "j"]).fails(
        2,
        &["a.laz: the file has changed since the job was planned"],
    );

    // Lines, too.
    let line = |z: f64| {
        layer(
            &[vec![
                [688_050.0, 5_261_050.0, z],
                [688_300.0, 5_261_250.0, z],
            ]],
            "LineString",
        )
    };
    std::fs::write(folder.path().join("l.geojson"), line(800.0)).unwrap();
    let words = format!(
        "job plan k -- dem {} --breaklines l.geojson -o d.tif --tiles 2x2",
        valley()
    );
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).works(&[]);
    std::fs::write(folder.path().join("l.geojson"), line(801.55)).unwrap();
    run_in(&folder, &["job", "run", "k"]).fails(
        2,
        &["l.geojson: the file has changed since the job was planned"],
    );
}

#[test]
fn a_task_needs_only_the_file_that_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["a.laz", "b.laz", "c.laz"];
    let file = |name: &str| folder.path().join(name);
    for name in names {
        std::fs::copy(valley(), file(name)).unwrap();
    }
    let (whole, _) = output_of(&folder, "dem a.laz b.laz c.laz", "whole.tif");
    for (job, inputs) in [("j", "a.laz b.laz c.laz"), ("k", "?.laz")] {
        let words = format!("job plan {job} -- dem {inputs} -o dem.tif --tiles 2x2 --overwrite");
        run_in(&folder, &words.split(' ').collect::<Vec<_>>()).works(&[]);
        let kept = tempfile::tempdir().unwrap();
        let away = |name: &str| std::fs::rename(file(name), kept.path().join(name)).unwrap();
        names.iter().for_each(|name| away(name));
        for (task, name) in names.iter().enumerate() {
            run_in(&folder, &["job", "run", job, "--task", &task.to_string()]).fails(1, &[name]);
            std::fs::rename(kept.path().join(name), file(name)).unwrap();
            run_in(&folder, &["job", "run", job, "--task", &task.to_string()]).works(&[]);
            away(name);
        }
        run_in(&folder, &["job", "run", job, "--task", "3"]).works(&["tile 0"]);
        run_in(&folder, &["job", "status", job]).works(&[]);
        run_in(&folder, &["job", "run", job]).works(&[]);
        // Another file in the place of one that was read does not matter to the output alone.
        std::fs::remove_file(file("dem.tif")).unwrap();
        std::fs::write(file("a.laz"), "LASF").unwrap();
        run_in(&folder, &["job", "run", job]).fails(2, &["a.laz: the file has changed"]);
        run_in(&folder, &["job", "run", job, "--task", "9"]).works(&[]);
        assert!(bytes(file("dem.tif")) == whole);
        names
            .iter()
            .for_each(|name| std::fs::rename(kept.path().join(name), file(name)).unwrap());
    }
}

#[test]
fn files_that_were_repaired_may_be_read_in_any_order() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.laz", "b.laz"] {
        std::fs::copy(valley(), folder.path().join(name)).unwrap();
    }
    let (whole, _) = output_of(&folder, "dem a.laz b.laz", "whole.tif");
    let words = "job plan j -- dem a.laz b.laz -o dem.tif --tiles 2x2";
    run_in(&folder, &words.split(' ').collect::<Vec<_>>()).works(&[]);
    for name in ["a.laz", "b.laz"] {
        let file = std::fs::File::options()
            .append(true)
            .open(folder.path().join(name))
            .unwrap();
        file.set_modified(SystemTime::now() + Duration::from_secs(5))
            .unwrap();
    }
    std::thread::scope(|scope| {
        for task in ["0", "1"] {
            scope.spawn(|| run_in(&folder, &["job", "run", "j", "--task", task]).works(&[]));
        }
    });
    run_in(&folder, &["job", "run", "j"]).works(&[]);
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

#[test]
fn headers_alone_suffice_to_plan() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    let plan = |options: &str| {
        let words = format!(
            "job plan j --headers-only -- dem {} -o dem.tif --memory 16MB {options}",
            valley()
        );
        run_in(&folder, &words.split_whitespace().collect::<Vec<_>>())
    };
    plan("").fails(2, &["from headers alone", "--class 2"]);
    plan("--class 2").works(&["tiles"]);
    run_in(&folder, &["job", "run", "j"]).works(&[]);
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

#[test]
fn tasks_run_one_by_one_from_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    let planned = format!("job plan j -- dem {} -o dem.tif --tiles 2x2", valley());
    run_in(&folder, &planned.split(' ').collect::<Vec<_>>())
        .works(&["job run j, or j --task 0 to 7"]);
    run_in(&folder, &planned.split(' ').collect::<Vec<_>>())
        .fails(2, &["there is a job in this folder already"]);
    let elsewhere = tempfile::tempdir().unwrap();
    let job = folder.path().join("j").to_str().unwrap().to_owned();
    let task = |number: &str| run_in(&elsewhere, &["job", "run", &job, "--task", number]);
    task("2").fails(4, &["task 0 (divide", "is not done"]);
    task("7").fails(4, &["task 0 (divide", "is not done"]);
    task("8").fails(
        2,
        &["there is no task 8: the last is 7, which writes the output"],
    );
    for number in 0..8 {
        task(&number.to_string()).works(&[]);
    }
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    let status = run_in(&elsewhere, &["job", "status", &job, "--json"]);
    let status: serde_json::Value = serde_json::from_str(&status.stdout).unwrap();
    let tasks = status["tasks"].as_array().unwrap();
    assert!(
        tasks.len() == 8 && tasks.iter().all(|task| task["done"] == true),
        "{status}"
    );
    assert_eq!(tasks[5]["needs"], serde_json::json!([1, 2, 3, 4]));
    let stages: Vec<u64> = tasks
        .iter()
        .map(|task| task["stage"].as_u64().unwrap())
        .collect();
    assert_eq!(stages, [0, 1, 1, 1, 1, 2, 3, 4]);
    assert_eq!(
        run_in(&elsewhere, &["job", "status", &job]).stdout,
        "7 of 7 tasks are done\n"
    );
    run_in(&elsewhere, &["job", "clean", &job]).works(&[]);
    assert_eq!(files_of(folder.path()), ["dem.tif", "whole.tif"]);
    run_in(&elsewhere, &["job", "clean", &job]).fails(2, &["there is no job in this folder"]);
    run_in(&elsewhere, &["job", "plan", "k", "--", "check", "a.laz"])
        .fails(2, &["a job makes a DEM"]);
    let words = format!("job plan k -- tin {} -o b.ply", valley());
    run_in(&elsewhere, &words.split(' ').collect::<Vec<_>>())
        .fails(2, &["tiles make a TIN in parts"]);
    run_in(&elsewhere, &["job", "plan", "k", "--", "dem"]).fails(2, &["the command of the job"]);
}

/// Killed again and again, each time a little later, a job goes on; tasks that are done stay done.
#[test]
fn a_job_that_is_killed_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!("dem {} --tiles 12x12 --job kept", valley());
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    let target = folder.path().join("dem.tif");
    let mut known = Vec::new();
    let mut kills = 0;
    for wait in 1.. {
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
        let words = words.split(' ').chain(["--resume", "-q", "-o", "dem.tif"]);
        let mut child = program
            .current_dir(folder.path())
            .args(words)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(5 * wait));
        // SIGKILL.
        let _ = child.kill();
        kills += i32::from(!child.wait().unwrap().success());
        if folder.path().join("kept/tasks").exists() {
            let now = done(&folder.path().join("kept"));
            assert!(
                known.iter().all(|task| now.contains(task)),
                "a task was done twice"
            );
            known = now;
        }
        if target.exists() {
            break;
        }
    }
    assert!(kills > 3, "{kills}");
    assert!(bytes(&target) == whole);
}

/// Ctrl-C ends a run at once, and says how to go on.
#[cfg(unix)]
#[test]
fn a_run_that_a_signal_ends_says_how_to_go_on() {
    use std::os::unix::process::ExitStatusExt;
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    if ignored
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask >> 1 & 1 == 1)
    {
        return eprintln!("skipped: SIGINT is ignored here");
    }
    let folder = tempfile::tempdir().unwrap();
    run_in(
        &folder,
        &[
            "job",
            "plan",
            "j",
            "--",
            "dem",
            &valley(),
            "-o",
            "x.tif",
            "--tiles",
            "30x30",
        ],
    )
    .works(&[]);
    let dem = format!("dem {} --tiles 30x30 -o dem.tif --threads 1", valley());
    for (words, said) in [
        (
            dem.as_str(),
            "note: finished tasks are kept in dem.tif.job: go on with --resume\n",
        ),
        ("job run j --threads 1", "j: go on with `breakline job run "),
    ] {
        let mut program = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
        let child = program
            .current_dir(folder.path())
            .args(words.split(' '))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let job = folder
            .path()
            .join(if words == dem { "dem.tif.job" } else { "j" });
        // Its 900 tiles take far longer than it takes to see the first.
        while !job.join("tasks/000001.task").exists() {
            std::thread::sleep(Duration::from_millis(1));
        }
        // The one of the shell: not every system has a program `kill`.
        let kill = ["-c", "kill -INT \"$0\"", &child.id().to_string()];
        assert!(Command::new("sh").args(kill).status().unwrap().success());
        let ended = child.wait_with_output().unwrap();
        let text = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.signal(), Some(2), "{text}");
        assert!(text.contains(said), "{text}");
    }
    assert!(!folder.path().join("dem.tif").exists());
}

/// What would be found out when the disk is full is refused before anything is written.
#[test]
fn a_run_that_cannot_fit_on_the_disk_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("w.xyz"),
        "0 0 0\n4000000 0 0\n0 4000000 0\n4000000 4000000 1\n",
    )
    .unwrap();
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    let said = [
        "the files of the tasks take about 1280000",
        "are free on the disk",
        "hint: choose larger cells",
    ];
    let words = "dem w.xyz --resolution 0.1 --max-edge none --tiles 2x2";
    run(&format!("{words} -o d.tif")).fails(1, &said);
    run(&format!("{words} -o d.tif --dry-run")).fails(1, &said);
    run(&format!("job plan j -- {words} -o d.tif")).fails(1, &said);
    // Files far apart: of the frame around them, hardly a cell is drawn.
    let square = |x: u32| -> String {
        (0..100)
            .map(|i| format!("{} {} {i}\n", x + i % 10, x + i / 10))
            .collect()
    };
    for (name, x) in [("a.xyz", 0), ("b.xyz", 2_000_000)] {
        std::fs::write(folder.path().join(name), square(x)).unwrap();
    }
    run("dem a.xyz b.xyz --resolution 0.5 --tiles 2x2 --dry-run -o d.tif")
        .works(&["about 10 kB on the disk"]);
    assert_eq!(files_of(folder.path()), ["a.xyz", "b.xyz", "w.xyz"]);
}

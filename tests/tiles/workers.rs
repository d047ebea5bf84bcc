//! Processes that share the tasks of a job: whatever happens to them, the bytes of one.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, SystemTime};

use breakline::run::{self, Context, StoredJob, WorkOptions, WriteReport};
use tempfile::TempDir;

use super::{bytes, landscape, output_of, plan_valley, program, run, valley};
use program::files_of;

/// A worker of the job `j`, which adds what it says to a file.
fn worker(folder: &TempDir, words: &str) -> Child {
    spawn(folder, &format!("job work j {words}"))
}

fn spawn(folder: &TempDir, words: &str) -> Child {
    let said = File::options()
        .create(true)
        .append(true)
        .open(folder.path().join("said"))
        .unwrap();
    Command::new(assert_cmd::cargo::cargo_bin!("breakline"))
        .current_dir(folder.path())
        .args(words.split_whitespace())
        .stderr(said)
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

fn said(folder: &TempDir) -> String {
    String::from_utf8(bytes(folder.path().join("said"))).unwrap()
}

fn lease(folder: &TempDir, task: usize) -> PathBuf {
    folder.path().join(format!("j/tasks/{task:06}.lease"))
}

/// The lease of a process on another host, which has not been heard of for some seconds.
fn write_lease(folder: &TempDir, task: usize, expires_after: u64, silent: u64) {
    let text = format!(
        r#"{{"worker":{{"host":"elsewhere","process":7}},"id":1,"expires_after":{}}}"#,
        expires_after * 1000
    );
    std::fs::write(lease(folder, task), text).unwrap();
    let file = File::options().append(true).open(lease(folder, task));
    let written = SystemTime::now() - Duration::from_secs(silent);
    file.unwrap().set_modified(written).unwrap();
}

/// The tasks that are done, with the times at which they were.
fn done(folder: &TempDir) -> BTreeMap<usize, SystemTime> {
    let tasks = folder.path().join("j/tasks");
    let mut done = BTreeMap::new();
    for name in files_of(&tasks) {
        if let Some(task) = name.strip_suffix(".task")
            && let Ok(about) = std::fs::metadata(tasks.join(&name))
        {
            done.insert(task.parse().unwrap(), about.modified().unwrap());
        }
    }
    done
}

/// The tasks that workers have taken from others.
fn taken_over(folder: &TempDir) -> BTreeSet<usize> {
    let said = said(folder);
    let lines = said.lines().filter_map(|line| {
        let (task, _) = line
            .strip_prefix("note: task ")?
            .split_once(" is done here")?;
        task.parse().ok()
    });
    lines.collect()
}

/// Kills one of four workers again and again, and begins another one instead, until the output is
/// written. A task that is done is done once, unless it was taken from a process that was late.
#[track_caller]
fn kill_workers(folder: &TempDir, words: &str, every: Duration) -> u32 {
    let mut workers: Vec<Child> = (0..4).map(|_| worker(folder, words)).collect();
    let (mut known, mut again) = (BTreeMap::new(), BTreeSet::new());
    let mut kills = 0;
    'all: for i in (0..4).cycle() {
        // So that slow machines come to an end.
        std::thread::sleep(every + every * kills / 20);
        for (task, time) in done(folder) {
            if known
                .insert(task, time)
                .is_some_and(|before| before != time)
            {
                again.insert(task);
            }
        }
        for other in &mut workers {
            if let Some(status) = other.try_wait().unwrap() {
                assert!(status.success(), "{}", said(folder));
                break 'all;
            }
        }
        // SIGKILL.
        workers[i].kill().unwrap();
        workers[i].wait().unwrap();
        kills += 1;
        workers[i] = worker(folder, words);
    }
    for mut worker in workers {
        assert!(worker.wait().unwrap().success(), "{}", said(folder));
    }
    let late = taken_over(folder);
    assert!(again.is_subset(&late), "{again:?}, {late:?}");
    kills
}

#[test]
fn workers_that_are_killed_write_the_bytes_of_one() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    let planned = format!("job plan j -- dem {} --tiles 12x12 -o dem.tif", valley());
    run(&folder, &planned).works(&["job run j"]);
    let kills = kill_workers(&folder, "--threads 1 --lease 2", Duration::from_millis(100));
    assert!(kills > 0 && bytes(folder.path().join("dem.tif")) == whole);
    // A late one finds that all is done.
    let late = run(&folder, "job work j");
    late.works(&["dem.tif is written"]);
    run(&folder, "job clean j").works(&[]);
    assert_eq!(files_of(folder.path()), ["dem.tif", "said", "whole.tif"]);
}

/// One of four is killed each second; the environment sets the number of points:
/// `BREAKLINE_WORKERS=20000000 cargo test --release --test tiles workers`.
#[test]
fn workers_that_are_killed_each_second_write_the_bytes_of_one() {
    let points = std::env::var("BREAKLINE_WORKERS")
        .ok()
        .and_then(|n| n.parse().ok());
    let Some(points) = points else { return };
    let folder = tempfile::tempdir().unwrap();
    landscape::write(&folder.path().join("in"), points, 8).unwrap();
    let (whole, _) = output_of(&folder, "dem in/*.laz", "whole.tif");
    run(
        &folder,
        "job plan j -- dem in/*.laz --tiles 16x16 -o dem.tif",
    )
    .works(&["job run j"]);
    let kills = kill_workers(&folder, "--threads 1 --lease 10", Duration::from_secs(1));
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    eprintln!(
        "{kills} workers were killed; taken over: {:?}",
        taken_over(&folder)
    );
}

/// Two workers in one process: each output is written once, and both learn of it.
#[test]
fn workers_of_the_library_share_a_job() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    let planned = format!("job plan j -- dem {} --tiles 5x5 -o dem.tif", valley());
    run(&folder, &planned).works(&[]);
    let stored = StoredJob::read(&folder.path().join("j")).unwrap();
    let reports: Vec<WriteReport> = std::thread::scope(|scope| {
        let work = || run::work_job(&stored, &WorkOptions::default(), &Context::default());
        let workers = [scope.spawn(work), scope.spawn(work)];
        workers.map(|one| one.join().unwrap().unwrap()).into()
    });
    let written = reports
        .iter()
        .filter(|report| matches!(report, WriteReport::Written(_)));
    assert_eq!(written.count(), 1, "{reports:?}");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

/// A lease lasts while it is renewed; then others have the task.
#[test]
fn what_a_process_has_left_is_taken_once_its_lease_has_expired() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    plan_valley(&folder);
    // Of a task, of one whose lease is damaged, and of the output.
    write_lease(&folder, 0, 100, 101);
    std::fs::write(lease(&folder, 2), "").unwrap();
    write_lease(&folder, 7, 5, 3605);
    // Of a host whose clock was ahead, or before the clock of the file server was set back.
    write_lease(&folder, 3, 5, 0);
    let file = File::options()
        .append(true)
        .open(lease(&folder, 3))
        .unwrap();
    let ahead = SystemTime::now() + Duration::from_secs(3600);
    file.set_modified(ahead).unwrap();
    let status = run(&folder, "job status j").stdout;
    for line in [
        "0 of 7 tasks are done\n",
        "0: divide ",
        "valley.laz, lost by elsewhere:7, seen 1",
        "2: tile 2, done by an unknown process, seen ",
        ", lost by elsewhere:7, seen 0 s ago",
        "7: output, lost by elsewhere:7, seen 36",
    ] {
        assert!(status.contains(line), "{line} in {status}");
    }
    let work = run(&folder, "job work j --lease 1 --threads 2 --memory 16MB");
    work.works(&[
        "task 0 is done here: elsewhere:7 does not go on with it, seen 1",
        "task 2 is done here: its process does not go on with it",
        "task 3 is done here: elsewhere:7",
        "task 7 is done here: elsewhere:7",
        "tasks       7 of 7 done here",
    ]);
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    let left = files_of(&folder.path().join("j/tasks"));
    assert!(left.iter().all(|name| name.ends_with(".task")), "{left:?}");
}

/// Locks hold on one host only, or nowhere: leases of others are heeded as well.
#[test]
fn a_job_that_another_host_works_on_is_not_taken_from_it() {
    let folder = tempfile::tempdir().unwrap();
    plan_valley(&folder);
    write_lease(&folder, 3, 3600, 1);
    let before = files_of(&folder.path().join("j/tasks"));
    // Each waits for some seconds.
    std::thread::scope(|scope| {
        for words in ["job clean j", "job run j"] {
            let said = ["another process works on this job: elsewhere:7 does task 3"];
            let folder = &folder;
            scope.spawn(move || run(folder, words).fails(2, &said));
        }
    });
    assert_eq!(files_of(&folder.path().join("j/tasks")), before);
    // All that does not need it is done meanwhile.
    let mut worker = worker(&folder, "");
    while !said(&folder).contains("waits for 1 task of other processes") {
        assert_eq!(worker.try_wait().unwrap(), None, "{}", said(&folder));
        std::thread::sleep(Duration::from_millis(20));
    }
    // That process ends without having done it.
    std::fs::remove_file(lease(&folder, 3)).unwrap();
    assert!(worker.wait().unwrap().success(), "{}", said(&folder));
    assert!(folder.path().join("dem.tif").exists());
}

/// Only leases of a host that is gone, and that expire soon: they are waited for.
#[test]
fn leases_that_nobody_renews_are_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    plan_valley(&folder);
    write_lease(&folder, 3, 13, 0);
    let waits = "waits for another process that has the job: elsewhere:7 does task 3";
    run(&folder, "job run j").works(&[waits]);
    assert!(folder.path().join("dem.tif").exists());
}

/// Another host updates a job that a worker has, because locks hold on one host only: the worker
/// goes on with the job as it is planned now.
#[test]
fn a_job_that_is_updated_meanwhile_goes_on_as_it_is_now() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, heights: f64| {
        let points = (0..400).map(|i| {
            let (x, y) = (f64::from(i % 20), f64::from(i / 20));
            format!("{x} {y} {}\n", heights + (x * y) % 7.0)
        });
        std::fs::write(folder.path().join(name), points.collect::<String>()).unwrap();
    };
    write("a.xyz", 1.0);
    run(&folder, "job plan j -- dem a.xyz --tiles 2x2 -o dem.tif").works(&[]);
    let copied = |from: &str, to: &str| {
        let [from, to] = [from, to].map(|name| folder.path().join(name));
        std::fs::create_dir_all(to.join("tasks")).unwrap();
        for name in ["plan.json", "command.json"] {
            let aside = to.join("aside");
            std::fs::copy(from.join(name), &aside).unwrap();
            std::fs::rename(aside, to.join(name)).unwrap();
        }
    };
    // While it waits for all of the job, between tasks, and before its first task.
    for (round, task) in [7, 3, 0].into_iter().enumerate() {
        copied("j", "k");
        let _ = std::fs::remove_file(folder.path().join("dem.tif"));
        for name in files_of(&folder.path().join("j/tasks")) {
            std::fs::remove_file(folder.path().join("j/tasks").join(name)).unwrap();
        }
        write("a.xyz", 10.0 * (round as f64 + 2.0));
        write_lease(&folder, task, 3600, 0);
        let mut worker = worker(&folder, "");
        let waits = || said(&folder).matches("waits for").count() > round;
        wait_until(&folder, &mut worker, waits);
        run(&folder, "job run k --update").works(&[]);
        copied("k", "j");
        std::fs::remove_file(folder.path().join("dem.tif")).unwrap();
        std::fs::remove_file(lease(&folder, task)).unwrap();
        assert!(worker.wait().unwrap().success(), "{}", said(&folder));
        let (whole, _) = output_of(&folder, "dem a.xyz", "whole.tif");
        assert!(bytes(folder.path().join("dem.tif")) == whole, "{task}");
        std::fs::remove_dir_all(folder.path().join("k")).unwrap();
    }
}

#[test]
fn what_workers_find_damaged_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, _) = output_of(&folder, &format!("dem {}", valley()), "whole.tif");
    let planned = format!("job plan j -- dem {} --tiles 3x3 -o dem.tif", valley());
    run(&folder, &planned).works(&[]);
    for task in ["0", "4"] {
        run(&folder, &format!("job run j --task {task}")).works(&[]);
    }
    let damage = |task: usize| {
        let path = folder.path().join(format!("j/tasks/{task:06}.task"));
        let mut damaged = bytes(&path);
        damaged[100] ^= 1;
        std::fs::write(path, damaged).unwrap();
    };
    damage(0);
    damage(4);
    run(&folder, "job work j").works(&["11 of 12 done here", "resumed     11 of 12"]);
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

#[test]
fn a_worker_that_fails_says_how_to_go_on_and_leaves_no_lease() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(valley(), folder.path().join("a.laz")).unwrap();
    let planned = "job plan j -- dem a.laz --tiles 2x2 -o dem.tif";
    run(&folder, planned).works(&[]);
    std::fs::rename(folder.path().join("a.laz"), folder.path().join("b.laz")).unwrap();
    run(&folder, "job work j").fails(
        1,
        &[
            "a.laz: ",
            "finished tasks are kept in",
            "`breakline job work ",
        ],
    );
    assert!(files_of(&folder.path().join("j/tasks")).is_empty());
    std::fs::rename(folder.path().join("b.laz"), folder.path().join("a.laz")).unwrap();
    std::fs::write(folder.path().join("dem.tif"), "mine").unwrap();
    run(&folder, "job work j").fails(1, &["dem.tif: ", "exists"]);
    assert!(files_of(&folder.path().join("j/tasks")).is_empty());
    run(&folder, "job work none").fails(2, &["there is no job in this folder"]);
}

/// A file that cannot be read is a hole, or an error, as the job was planned.
#[test]
fn workers_skip_what_the_job_skips() {
    let folder = tempfile::tempdir().unwrap();
    landscape::write(&folder.path().join("in"), 16_000, 4).unwrap();
    let bad = folder.path().join("in/001_001.laz");
    let whole = bytes(&bad);
    std::fs::write(&bad, &whole[..whole.len() / 2]).unwrap();
    run(
        &folder,
        "job plan j -- dem in/*.laz --tiles 2x2 -o dem.tif --skip-bad",
    )
    .works(&[]);
    let mut workers = [worker(&folder, ""), worker(&folder, "")];
    for one in &mut workers {
        assert_eq!(one.wait().unwrap().code(), Some(3), "{}", said(&folder));
    }
}

/// The last task does not try files again that were skipped: that is what `job run` is for.
#[test]
fn workers_do_not_try_again_what_was_skipped() {
    let folder = tempfile::tempdir().unwrap();
    landscape::write(&folder.path().join("in"), 16_000, 4).unwrap();
    let bad = folder.path().join("in/001_001.laz");
    let whole = bytes(&bad);
    std::fs::write(&bad, &whole[..whole.len() / 2]).unwrap();
    let planned = "job plan j -- dem in/*.laz --tiles 2x2 -o dem.tif --skip-bad";
    run(&folder, planned).works(&[]);
    let mut task = 0;
    while run(&folder, &format!("job run j --task {task}")).code == 0 {
        task += 1;
    }
    let before = done(&folder);
    // The last one, which is the output, has a hole.
    assert_eq!(before.len(), task);
    std::fs::remove_file(folder.path().join("dem.tif")).unwrap();
    assert_eq!(run(&folder, "job work j").code, 3);
    assert_eq!(done(&folder), before);
}

/// A job whose tasks take long enough to see what happens meanwhile.
fn long_job(folder: &TempDir) {
    landscape::write(&folder.path().join("in"), 400_000, 1).unwrap();
    run(folder, "job plan j -- dem in/*.laz --tiles 2x2 -o dem.tif").works(&[]);
}

/// Waits until something has happened; the process must not end before.
#[track_caller]
fn wait_until(folder: &TempDir, process: &mut Child, happened: impl Fn() -> bool) {
    while !happened() {
        let ended = process.try_wait().unwrap();
        assert!(ended.is_none(), "{ended:?}: {}", said(folder));
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Who has the whole job has the lease of the output, so that others wait where locks hold on one
/// host only.
#[test]
fn a_run_of_the_whole_job_has_the_lease_of_the_output() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut whole = spawn(&folder, "job run j");
    let own = format!(r#""process":{}}}"#, whole.id());
    let has_lease = || {
        let text = std::fs::read_to_string(lease(&folder, 7));
        text.is_ok_and(|text| text.contains(&own))
    };
    wait_until(&folder, &mut whole, has_lease);
    let late = worker(&folder, "").wait_with_output().unwrap();
    assert!(late.status.success(), "{}", said(&folder));
    assert!(whole.wait().unwrap().success(), "{}", said(&folder));
    for line in [
        "waits for another process that has the job: ",
        " has the output, seen ",
        "dem.tif is written",
    ] {
        assert!(said(&folder).contains(line), "{line} in {}", said(&folder));
    }
    assert!(!lease(&folder, 7).exists());
}

/// A process whose lease another one has taken writes no output any more.
#[test]
fn a_run_that_has_lost_its_lease_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut whole = spawn(&folder, "job run j");
    wait_until(&folder, &mut whole, || !done(&folder).is_empty());
    std::fs::remove_file(lease(&folder, 7)).unwrap();
    write_lease(&folder, 7, 3600, 0);
    assert_eq!(whole.wait().unwrap().code(), Some(4), "{}", said(&folder));
    assert!(said(&folder).contains("this process gave no sign of life for so long that another"));
    assert!(!folder.path().join("dem.tif").exists() && lease(&folder, 7).exists());
    // Nor does a worker begin while another host has the whole job.
    let before = done(&folder);
    let mut worker = worker(&folder, "");
    let waits = || said(&folder).contains("has the job: elsewhere:7 has the output, seen");
    wait_until(&folder, &mut worker, waits);
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(done(&folder), before);
    std::fs::remove_file(lease(&folder, 7)).unwrap();
    assert!(worker.wait().unwrap().success(), "{}", said(&folder));
    assert!(folder.path().join("dem.tif").exists());
}

/// What somebody writes at the output while tasks are done stays.
#[test]
fn an_output_that_appears_meanwhile_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut whole = spawn(&folder, "job run j");
    wait_until(&folder, &mut whole, || !done(&folder).is_empty());
    std::fs::write(folder.path().join("dem.tif"), "mine").unwrap();
    assert_eq!(whole.wait().unwrap().code(), Some(1), "{}", said(&folder));
    assert!(said(&folder).contains("exists"), "{}", said(&folder));
    assert_eq!(bytes(folder.path().join("dem.tif")), b"mine");
    assert!(!folder.path().join("j/output.json").exists());
}

#[cfg(unix)]
fn signal(process: &Child, name: &str) {
    // The one of the shell: not every system has a program `kill`.
    let kill = ["-c", "kill -$1 $0", &process.id().to_string(), name];
    assert!(Command::new("sh").args(kill).status().unwrap().success());
}

/// A process that is stopped has a lock that nobody can take from it. It is not waited for longer
/// than its lease lasts, and does nothing that others have done when it goes on.
#[cfg(unix)]
#[test]
fn a_worker_that_is_stopped_does_not_keep_others_from_the_output() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut stopped = worker(&folder, "--threads 1 --lease 1");
    wait_until(&folder, &mut stopped, || {
        (0..7).any(|task| lease(&folder, task).exists())
    });
    signal(&stopped, "STOP");
    let mut other = worker(&folder, "--lease 1");
    assert!(other.wait().unwrap().success(), "{}", said(&folder));
    let mut lines = vec![
        "does not go on with it",
        "waits for another process that has the job",
        "the job goes on here: for",
    ];
    let holder = format!(
        "process {} on this machine has the lock of the job and is stopped",
        stopped.id()
    );
    if cfg!(target_os = "linux") {
        lines.push(&holder);
    }
    for line in lines {
        assert!(said(&folder).contains(line), "{line} in {}", said(&folder));
    }
    let written = || {
        std::fs::metadata(folder.path().join("dem.tif"))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = (done(&folder), written());
    signal(&stopped, "CONT");
    assert!(stopped.wait().unwrap().success(), "{}", said(&folder));
    assert_eq!((done(&folder), written()), before);
    let left = files_of(&folder.path().join("j/tasks"));
    assert!(left.iter().all(|name| name.ends_with(".task")), "{left:?}");
}

/// Neither does one that has the whole job: its lease expires, and then others do the tasks. If it
/// goes on, it gives no file its name.
#[cfg(unix)]
#[test]
fn a_run_that_is_stopped_does_not_keep_others_from_the_tasks() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut stopped = spawn(&folder, "job run j");
    wait_until(&folder, &mut stopped, || !done(&folder).is_empty());
    signal(&stopped, "STOP");
    let before = done(&folder);
    // As if it had been stopped for longer.
    let file = File::options().append(true).open(lease(&folder, 7));
    let written = SystemTime::now() - Duration::from_secs(100);
    file.unwrap().set_modified(written).unwrap();
    let mut other = worker(&folder, "--lease 1");
    assert!(other.wait().unwrap().success(), "{}", said(&folder));
    assert!(said(&folder).contains("the job goes on here: for"));
    let mut after = done(&folder);
    after.retain(|task, _| before.contains_key(task));
    assert_eq!(after, before);
    let written = || {
        std::fs::metadata(folder.path().join("dem.tif"))
            .unwrap()
            .modified()
    };
    let before = (done(&folder), written().unwrap());
    signal(&stopped, "CONT");
    assert_eq!(stopped.wait().unwrap().code(), Some(4), "{}", said(&folder));
    assert_eq!((done(&folder), written().unwrap()), before);
    let left = files_of(&folder.path().join("j/tasks"));
    assert!(left.iter().all(|name| name.ends_with(".task")), "{left:?}");
}

/// A lease that is held without the lock counts until it expires, also for who has the lock.
#[test]
fn a_lease_without_the_lock_counts_on_its_own_host() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut killed = worker(&folder, "--threads 1 --lease 3600");
    let held = || {
        let texts = (0..7).map(|task| std::fs::read_to_string(lease(&folder, task)));
        texts.flatten().find(|text| text.ends_with('}'))
    };
    wait_until(&folder, &mut killed, || held().is_some());
    killed.kill().unwrap();
    killed.wait().unwrap();
    let text = held().unwrap();
    assert!(text.contains(r#""has_lock":true"#), "{text}");
    let write = |text: &str| std::fs::write(lease(&folder, 3), text).unwrap();
    let without = text.replace(r#""has_lock":true"#, r#""has_lock":false"#);
    write(&without);
    run(&folder, "job clean j").fails(2, &["another process works on this job"]);
    // Another machine that has the same name.
    if text.contains(r#""boot":""#) {
        let (begin, end) = text.split_once(r#""boot":""#).unwrap();
        write(&format!(r#"{begin}"boot":"other-{end}"#));
        run(&folder, "job clean j").fails(2, &["another process works on this job"]);
    }
    write(&text);
    run(&folder, "job clean j").works(&[]);
}

/// A signal ends a worker at once; what it had is free.
#[cfg(unix)]
#[test]
fn a_worker_that_a_signal_ends_leaves_no_lease() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut worker = worker(&folder, "");
    let is_lease = |name: &String| name.ends_with(".lease");
    let leases = || {
        files_of(&folder.path().join("j/tasks"))
            .iter()
            .any(is_lease)
    };
    wait_until(&folder, &mut worker, leases);
    signal(&worker, "TERM");
    worker.wait().unwrap();
    assert!(!leases());
    let said = said(&folder);
    assert!(said.contains("go on with `breakline job work"), "{said}");
    assert!(!Path::new("dem.tif").exists());
}

/// A lease that another process has taken meanwhile stays when a signal ends this one.
#[cfg(unix)]
#[test]
fn a_signal_does_not_take_the_lease_of_another() {
    let folder = tempfile::tempdir().unwrap();
    long_job(&folder);
    let mut worker = worker(&folder, "--threads 1");
    let held = || (0..7).find(|&task| lease(&folder, task).exists());
    wait_until(&folder, &mut worker, || held().is_some());
    signal(&worker, "STOP");
    let task = held().unwrap();
    std::fs::remove_file(lease(&folder, task)).unwrap();
    write_lease(&folder, task, 3600, 0);
    let other = bytes(lease(&folder, task));
    signal(&worker, "TERM");
    signal(&worker, "CONT");
    worker.wait().unwrap();
    assert_eq!(bytes(lease(&folder, task)), other);
}

//! Inputs that change after a job was done: of its tasks only those are done again that the changes
//! reach, and the bytes are those of a new job.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::SystemTime;

use serde_json::Value;
use tempfile::TempDir;
use testkit::lidar;
use testkit::random::Random;

use super::{bytes, layer, output_of, program, run, valley};
use program::files_of;

/// Writes a file of points in the square in this column and row; squares have gaps between them.
fn write_square(path: &Path, [column, row]: [i32; 2], count: usize, seed: u64) {
    let mut random = Random(seed);
    let corner = [column, row].map(|at| f64::from(at) * 100.0);
    let mut text = String::new();
    // The corners, so that the extent is the same whatever the points.
    for [x, y] in [[0.0, 0.0], [98.0, 0.0], [0.0, 98.0], [98.0, 98.0]] {
        text += &format!("{} {} 5\n", corner[0] + x, corner[1] + y);
    }
    for _ in 4..count {
        let [x, y, z] =
            [98.0, 98.0, 30.0].map(|size| (random.unit() * size * 100.0).round() / 100.0);
        text += &format!("{:.2} {:.2} {z:.2}\n", corner[0] + x, corner[1] + y);
    }
    std::fs::write(path, text).unwrap();
}

fn square(folder: &TempDir, [column, row]: [i32; 2]) -> std::path::PathBuf {
    // So that names have the order of columns and rows, from -9 on.
    folder
        .path()
        .join(format!("in/{}_{}.xyz", column + 9, row + 9))
}

/// A folder with squares of points in so many columns and rows.
fn squares(side: i32) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("in")).unwrap();
    for at in (0..side * side).map(|i| [i % side, i / side]) {
        write_square(
            &square(&folder, at),
            at,
            300,
            at[0] as u64 * 100 + at[1] as u64,
        );
    }
    folder
}

/// The tasks of a job, without the one that writes the output.
fn tasks(folder: &TempDir, job: &str) -> Vec<Value> {
    let status = run(folder, &format!("job status {job} --json"));
    let value: Value = serde_json::from_str(&status.stdout).unwrap();
    let mut tasks = value["tasks"].as_array().unwrap().clone();
    tasks.pop();
    tasks
}

/// Those tasks for which a function returns true, and all that need them.
fn reached(tasks: &[Value], is_first: impl Fn(&Value) -> bool) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    for (number, task) in tasks.iter().enumerate() {
        let mut needs = task["needs"].as_array().unwrap().iter();
        let is_reached = needs.any(|need| reached.contains(&(need.as_u64().unwrap() as usize)));
        if is_reached || is_first(task) {
            reached.insert(number);
        }
    }
    reached
}

/// A file of a task, wherever it is: when it was written, and its bytes, since clocks are coarse.
type Stamp = (SystemTime, Vec<u8>);

/// The files of the tasks, by their numbers.
pub(super) fn stamps(folder: &TempDir, job: &str) -> Vec<(usize, Stamp)> {
    let tasks = folder.path().join(job).join("tasks");
    let stamp = |name: String| {
        let number = name.strip_suffix(".task")?.parse().ok()?;
        let path = tasks.join(name);
        let written = std::fs::metadata(&path).unwrap().modified().unwrap();
        Some((number, (written, bytes(path))))
    };
    files_of(&tasks).into_iter().filter_map(stamp).collect()
}

fn stamps_of(folder: &TempDir, job: &str) -> BTreeSet<Stamp> {
    let all = stamps(folder, job).into_iter();
    all.map(|(_, stamp)| stamp).collect()
}

/// Updates the job `j` after a change, and returns the tasks that were done again.
#[track_caller]
fn update(folder: &TempDir, change: impl FnOnce()) -> BTreeSet<usize> {
    let before = stamps_of(folder, "j");
    change();
    run(folder, "job run j --update").works(&[]);
    let again = stamps(folder, "j")
        .into_iter()
        .filter(|(_, stamp)| !before.contains(stamp));
    again.map(|(number, _)| number).collect()
}

fn is_of(task: &Value, file: &Path) -> bool {
    let input = task["input"].as_str().unwrap_or_default();
    Path::new(input).file_name() == file.file_name()
}

/// A limit that follows from the points has two digits: it stays the same if few points change. If
/// it changes, all is done again.
#[test]
fn a_limit_that_follows_from_the_points_is_found_again() {
    let folder = squares(4);
    let plan = "job plan j -- dem in/*.xyz --max-edge auto --tiles auto -o dem.tif";
    run(&folder, plan).works(&["the files", "edges over 570 units"]);
    run(&folder, "job run j").works(&[]);
    let file = square(&folder, [2, 1]);
    let again = update(&folder, || write_square(&file, [2, 1], 310, 7));
    let expected = reached(&tasks(&folder, "j"), |task| is_of(task, &file));
    assert_eq!(again, expected);
    let count = tasks(&folder, "j").len();
    let again = update(&folder, || write_square(&file, [2, 1], 3000, 8));
    assert_eq!(again.len(), count);
    let words = "dem in/*.xyz --max-edge auto";
    let (whole, said) = output_of(&folder, words, "new.tif");
    assert!(said.contains("edges over 450 units"), "{said}");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

/// One of several files changes: its tile, and what is above that.
#[test]
fn a_file_that_has_changed_is_read_again_and_no_other() {
    let folder = squares(5);
    run(
        &folder,
        "job plan j -- dem in/*.xyz --tiles auto -o dem.tif",
    )
    .works(&["the files"]);
    run(&folder, "job run j").works(&[]);
    let file = square(&folder, [3, 1]);
    let again = update(&folder, || write_square(&file, [3, 1], 350, 7));
    let expected = reached(&tasks(&folder, "j"), |task| is_of(task, &file));
    assert_eq!(again, expected);
    // A tile, two merges, the rim.
    assert!((3..=4).contains(&again.len()), "{again:?}");
    let (whole, _) = output_of(&folder, "dem in/*.xyz --tiles 1x1", "new.tif");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    // Nothing has changed.
    assert_eq!(update(&folder, || ()), BTreeSet::new());
    // Another file: what is kept for others has it, too.
    write_square(&square(&folder, [6, 6]), [6, 6], 200, 15);
    let words = "dem in/*.xyz --tiles auto -o dem.tif --job j --update";
    run(&folder, words).works(&["7750 read"]);
    run(&folder, "job run j").works(&["dem.tif is written"]);
    let command = folder.path().join("j/command.json");
    let text = String::from_utf8(bytes(&command)).unwrap();
    assert!(text.contains("15_15.xyz"), "{text}");
    // As an interruption leaves it.
    std::fs::rename(&command, folder.path().join("j/command.next.json")).unwrap();
    std::fs::write(&command, "{}").unwrap();
    run(&folder, "job run j --update").works(&["dem.tif is written"]);
    run(&folder, "job run j --update").works(&["dem.tif is written"]);
    // An output that is not as it was written is somebody's.
    write_square(&file, [3, 1], 300, 8);
    std::fs::write(folder.path().join("dem.tif"), "mine").unwrap();
    run(&folder, "job run j --update").fails(1, &["dem.tif: ", "exists"]);
    assert_eq!(bytes(folder.path().join("dem.tif")), b"mine");
}

/// The same command again, whatever has happened to the files: each product has the bytes of a new
/// one, and the tasks that are far away stay.
#[test]
fn files_that_come_and_go_change_what_they_reach() {
    let folder = squares(4);
    let mut first = BTreeSet::new();
    let change = |step: usize| match step {
        0 => {}
        1 => write_square(&square(&folder, [0, 0]), [0, 0], 250, 9),
        // Within the extent, on top of others, and beyond all of them.
        2 => write_square(&folder.path().join("in/00.xyz"), [1, 1], 120, 10),
        3 => write_square(&square(&folder, [-3, 0]), [-3, 0], 200, 11),
        4 => write_square(&square(&folder, [0, 6]), [0, 6], 200, 12),
        5 => std::fs::remove_file(square(&folder, [1, 0])).unwrap(),
        6 => std::fs::remove_file(folder.path().join("in/00.xyz")).unwrap(),
        7 => write_square(&square(&folder, [1, 0]), [1, 0], 300, 13),
        8 => std::fs::rename(square(&folder, [0, 1]), folder.path().join("in/a.xyz")).unwrap(),
        _ => unreachable!(),
    };
    let verbs = [
        ("dem", "--resolution 0.7", "dem.tif"),
        ("contour", "--interval 5", "lines.geojson"),
        ("dem", "--te -10,-10,250,333 --max-edge none", "part.tif"),
    ];
    for step in 0..=8 {
        change(step);
        // Others have several changes at a time.
        let count = if step % 4 == 0 { verbs.len() } else { 1 };
        for (verb, options, out) in &verbs[..count] {
            let words = format!("{verb} in/*.xyz {options}");
            let ran = run(&folder, &format!("{words} --update --tiles auto -o {out}"));
            ran.works(&[]);
            assert!(
                !ran.stderr.contains("all tasks are done again"),
                "{step}: {}",
                ran.stderr
            );
            let (whole, _) = output_of(
                &folder,
                &format!("{words} --tiles 1x1"),
                &format!("new_{out}"),
            );
            assert!(bytes(folder.path().join(out)) == whole, "{step}, {out}");
        }
        let now = stamps_of(&folder, "dem.tif.job");
        match step {
            0 => first = now,
            // Most tiles are those of the beginning, whatever their tasks are called.
            _ => assert!(now.intersection(&first).count() >= 8, "{step}"),
        }
    }
    // A new job would have as many tasks as there are files, and merges and a rim.
    let left = files_of(&folder.path().join("dem.tif.job/tasks"));
    assert!((17..=23).contains(&left.len()), "{left:?}");
    run(
        &folder,
        "dem in/*.xyz --resolution 2 --update --tiles auto -o dem.tif",
    )
    .fails(
        2,
        &[
            "the job in this folder is that of another command",
            "--resolution",
        ],
    );
    run(&folder, "job clean dem.tif.job").works(&[]);
    assert!(!folder.path().join("dem.tif.job").exists());
}

/// Which tasks are done again when a file comes new or goes: those of the tiles that it reaches.
#[test]
fn tiles_that_a_new_file_does_not_reach_stay() {
    let folder = squares(4);
    let words = "dem in/*.xyz --tiles auto -o dem.tif --update --job j";
    run(&folder, words).works(&[]);
    // 16 tiles, a merge, the rim.
    let first = stamps_of(&folder, "j");
    assert_eq!(first.len(), 18);
    let new = folder.path().join("in/00.xyz");
    write_square(&new, [1, 1], 120, 10);
    run(&folder, words).works(&[]);
    let second = stamps_of(&folder, "j");
    // It is divided, in the tile of another file.
    let kept = |now: &BTreeSet<Stamp>, before: &BTreeSet<Stamp>| now.intersection(before).count();
    assert_eq!((second.len(), kept(&second, &first)), (19, 15));
    std::fs::remove_file(new).unwrap();
    run(&folder, words).works(&[]);
    let third = stamps_of(&folder, "j");
    assert_eq!((third.len(), kept(&third, &first)), (18, 15));
    // As an interruption leaves them: files that have not got their new numbers yet.
    let file = |name: &str| folder.path().join("j/tasks").join(name);
    std::fs::rename(file("000001.task"), file("x")).unwrap();
    std::fs::rename(file("000003.task"), file("000001.task")).unwrap();
    std::fs::rename(file("x"), file("000003.task")).unwrap();
    run(&folder, words).works(&["dem.tif is written"]);
    assert_eq!(stamps_of(&folder, "j"), third);
    std::fs::remove_file(square(&folder, [2, 2])).unwrap();
    run(&folder, words).works(&[]);
    let fourth = stamps_of(&folder, "j");
    assert_eq!((fourth.len(), kept(&fourth, &third)), (18, 15));
}

/// With lines all files are divided. A line that changes reaches the tiles that it meets.
#[test]
fn lines_that_change_reach_their_tiles() {
    let folder = squares(3);
    let lines = |height: f64| {
        let text = layer(
            &[
                vec![[10.0, 10.0, 3.0], [30.0, 22.0, 4.0]],
                vec![[250.0, 250.0, height], [270.0, 265.0, height]],
            ],
            "LineString",
        );
        std::fs::write(folder.path().join("lines.geojson"), text).unwrap();
    };
    lines(9.0);
    let words = "dem in/*.xyz --breaklines lines.geojson --tiles 4x4";
    run(&folder, &format!("job plan j -- {words} -o dem.tif")).works(&[]);
    run(&folder, "job run j").works(&[]);
    let equal = || {
        let (whole, _) = output_of(&folder, &words.replace("4x4", "1x1"), "new.tif");
        assert!(bytes(folder.path().join("dem.tif")) == whole);
    };
    equal();
    // 9 files, the lines, 16 tiles.
    let all = tasks(&folder, "j");
    let is_tile = |task: &Value, tile: u32| task["name"] == format!("tile {tile}");
    // Another height: all files are compared with the lines again, and are as before.
    let again = update(&folder, || lines(11.0));
    let mut expected = reached(&all, |task| is_tile(task, 15));
    expected.extend(0..10);
    assert_eq!(again, expected);
    equal();
    // Points far from lines: the lines are as before.
    let file = square(&folder, [1, 0]);
    let again = update(&folder, || write_square(&file, [1, 0], 320, 14));
    let divided = all.iter().position(|task| is_of(task, &file)).unwrap();
    let is_reader = |task: &Value| {
        let name = task["name"].as_str().unwrap();
        let needs = task["needs"].as_array().unwrap();
        name.starts_with("tile ") && needs.contains(&Value::from(divided))
    };
    let mut expected = reached(&all, is_reader);
    expected.extend([divided, 9]);
    assert_eq!(again, expected);
    equal();
}

/// Many more points than the tiles were chosen for: then nothing is kept.
#[test]
fn tiles_are_chosen_again_if_they_have_no_room() {
    let folder = squares(2);
    let words = "dem in/*.xyz --tiles auto --memory 16MB --threads 8 -o dem.tif --update";
    run(&folder, words).works(&[]);
    write_square(&square(&folder, [1, 1]), [1, 1], 41_000, 3);
    run(&folder, words)
        .works(&["the inputs are no longer like those that the tiles were chosen for"]);
    let (whole, _) = output_of(&folder, "dem in/*.xyz", "new.tif");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    run(&folder, words).works(&["dem.tif is written"]);
}

/// What counts is what the tiles were chosen for, and not what they had before the last update.
#[test]
fn tiles_do_not_double_again_and_again() {
    let folder = squares(2);
    let words = "dem in/*.xyz --tiles auto --memory 16MB --threads 8 -o dem.tif --update";
    run(&folder, words).works(&[]);
    let chosen_again = |number: usize| {
        let file = folder.path().join(format!("in/a{number}.xyz"));
        write_square(&file, [1, 1], 9000, number as u64);
        let run = run(&folder, words);
        run.works(&[]);
        run.stderr.contains("the tiles were chosen for")
    };
    // 10 000 points have room, and so twice as many.
    assert_eq!([0, 1, 2].map(chosen_again), [false, false, true]);
    let (whole, _) = output_of(&folder, "dem in/*.xyz", "new.tif");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

/// Texts state neither the number of their points nor their extent, and what has no ground is read
/// to its end to find that out. Those that are as they were are not read again.
#[test]
fn files_that_have_not_changed_are_not_read() {
    let folder = squares(2);
    let las = folder.path().join("in/unclassified.las");
    std::fs::write(&las, lidar::las(&lidar::tile([200.0, 0.0], 1), None)).unwrap();
    // Without a word to the clock: who looks into the files finds something else.
    let rewrite = |path: &Path, change: &dyn Fn(&mut Vec<u8>)| {
        let before = std::fs::metadata(path).unwrap().modified().unwrap();
        let mut content = bytes(path);
        change(&mut content);
        std::fs::write(path, content).unwrap();
        let file = std::fs::File::options().append(true).open(path).unwrap();
        file.set_modified(before).unwrap();
    };
    let of_class = |class: u8| {
        move |content: &mut Vec<u8>| {
            let u32_at = |at: usize| u32::from_le_bytes(content[at..at + 4].try_into().unwrap());
            let (start, length) = (u32_at(96) as usize, content[105] as usize);
            let at = if content[104] & 0x3f < 6 { 15 } else { 16 };
            let end = content.len();
            (start..end)
                .step_by(length)
                .filter(|first| first + length <= end)
                .for_each(|first| content[first + at] = class);
        }
    };
    let words = "dem in/*.xyz in/*.las --tiles auto -o dem.tif --update";
    run(&folder, words).works(&[]);
    let before = stamps(&folder, "dem.tif.job");
    rewrite(&las, &of_class(2));
    rewrite(&square(&folder, [1, 1]), &|content| content[0] = b'9');
    run(&folder, words).works(&["dem.tif is written"]);
    assert_eq!(stamps(&folder, "dem.tif.job"), before);
}

/// The files of tasks that have to be renamed stay if one of them cannot be.
#[test]
fn a_rename_that_fails_loses_no_task() {
    let folder = squares(3);
    let words = "dem in/*.xyz --tiles 4x4 -o dem.tif --update --job j";
    run(&folder, words).works(&[]);
    let (count, before) = (stamps(&folder, "j").len(), stamps_of(&folder, "j"));
    // Comes first, and so shifts the numbers of all others.
    write_square(&folder.path().join("in/0.xyz"), [0, 0], 20, 40);
    let taken = folder.path().join("j/tasks/000007.task");
    std::fs::remove_file(&taken).unwrap();
    std::fs::create_dir(&taken).unwrap();
    run(&folder, words).fails(1, &["tasks"]);
    std::fs::remove_dir(&taken).unwrap();
    // That one, and tiles that have other files now.
    let kept = |now: BTreeSet<Stamp>| before.intersection(&now).count();
    let left = kept(stamps_of(&folder, "j"));
    assert!(left + 5 >= count, "{left} of {count}");
    run(&folder, words).works(&[]);
    let numbers: Vec<usize> = stamps(&folder, "j")
        .into_iter()
        .map(|(task, _)| task)
        .collect();
    assert_eq!(numbers, Vec::from_iter(0..numbers.len()));
    let (whole, _) = output_of(&folder, "dem in/*.xyz", "new.tif");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    let left = kept(stamps_of(&folder, "j"));
    assert!(left > 15, "{left} of {count}");
}

/// Two tasks with one key.
#[test]
fn a_file_that_is_given_twice_is_divided_twice() {
    let folder = squares(2);
    let words = "dem in/*.xyz in/9_9.xyz --tiles 2x2 --update -o dem.tif";
    run(&folder, words).works(&[]);
    let before = stamps(&folder, "dem.tif.job");
    run(&folder, words).works(&["dem.tif is written"]);
    assert_eq!(stamps(&folder, "dem.tif.job"), before);
    std::fs::remove_file(square(&folder, [1, 1])).unwrap();
    run(&folder, words).works(&[]);
    let (whole, _) = output_of(&folder, "dem in/*.xyz", "new.tif");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
}

/// A file that the job has not written is somebody's: another output, or one beside an output.
#[test]
fn only_what_the_job_has_written_is_replaced() {
    let folder = squares(2);
    let at = |name: &str| folder.path().join(name);
    let words = "contour in/*.xyz --interval 5 --tiles auto --update --job j -o a.geojson";
    run(&folder, words).works(&[]);
    let two = format!("{words} -o b.shp");
    // Nothing has changed, but an output came new.
    run(&folder, &two).works(&["b.shp"]);
    run(&folder, &two).works(&["is written"]);
    std::fs::remove_file(at("b.shp")).unwrap();
    run(&folder, &two).works(&["b.shp"]);
    let change = |seed: u64| write_square(&square(&folder, [1, 1]), [1, 1], 300, seed);
    for (number, mine) in ["c.geojson", "d.prj"].into_iter().enumerate() {
        change(20 + number as u64);
        std::fs::write(at(mine), "mine").unwrap();
        let output = mine.replace(".prj", ".shp");
        run(&folder, &format!("{words} -o {output}")).fails(1, &[mine, "exists"]);
        assert_eq!(bytes(at(mine)), b"mine");
        run(&folder, &format!("{words} -o {output} --overwrite")).works(&[&output]);
    }
}

/// A file that was there in between, and was accepted because its extent was the same.
#[test]
fn what_was_made_from_another_file_is_made_again() {
    let folder = squares(2);
    let file = square(&folder, [1, 0]);
    let kept = folder.path().join("kept");
    run(
        &folder,
        "job plan j -- dem in/*.xyz --tiles auto -o dem.tif",
    )
    .works(&[]);
    std::fs::rename(&file, &kept).unwrap();
    write_square(&file, [1, 0], 300, 21);
    run(&folder, "job run j").works(&[]);
    std::fs::rename(&kept, &file).unwrap();
    run(&folder, "job run j --update").works(&[]);
    let (whole, _) = output_of(&folder, "dem in/*.xyz --tiles 1x1", "new.tif");
    assert!(bytes(folder.path().join("dem.tif")) == whole);
    run(&folder, "job run j --update").works(&["dem.tif is written"]);
}

/// Of points at one position the first file's is used.
#[test]
fn the_order_of_files_is_not_lost() {
    let folder = squares(2);
    let file = square(&folder, [0, 0]);
    let text = String::from_utf8(bytes(&file)).unwrap();
    let higher: String = text
        .lines()
        .map(|line| format!("{} 99\n", line.rsplit_once(' ').unwrap().0))
        .collect();
    let other = folder.path().join("in/a.xyz");
    std::fs::write(&other, higher).unwrap();
    let options = "--duplicates first";
    let squares = "in/9_9.xyz in/10_9.xyz in/9_10.xyz in/10_10.xyz";
    for inputs in [
        squares.to_owned(),
        format!("{squares} in/a.xyz"),
        format!("in/a.xyz {squares}"),
    ] {
        let words = format!("dem {inputs} {options}");
        run(
            &folder,
            &format!("{words} --tiles auto --update -o dem.tif"),
        )
        .works(&[]);
        let (whole, _) = output_of(&folder, &format!("{words} --tiles 1x1"), "new.tif");
        assert!(bytes(folder.path().join("dem.tif")) == whole, "{inputs}");
    }
}

/// An update that ends before its output gets its name leaves the one before, which stays the job's
/// own, and the same command goes on.
#[test]
fn an_update_that_was_interrupted_goes_on() {
    let folder = squares(2);
    let at = |name: &str| folder.path().join(name);
    let words = "dem in/*.xyz --tiles auto --memory 16MB --threads 8 -o dem.tif";
    run(&folder, &format!("job plan j -- {words}")).works(&[]);
    run(&folder, "job run j").works(&[]);
    let mut before = (bytes(at("dem.tif")), bytes(at("j/output.json")));
    // The last time tiles are chosen again.
    for (step, count) in [350, 300, 41_000].into_iter().enumerate() {
        write_square(&square(&folder, [1, 1]), [1, 1], count, 30 + step as u64);
        run(&folder, "job run j --update").works(&[]);
        let after = (bytes(at("dem.tif")), bytes(at("j/output.json")));
        assert!(before.0 != after.0 && before.1 != after.1);
        // Before the rename, and before the record.
        for (record, again) in [
            (&after.1, "job run j --update"),
            (&after.1, "job run j"),
            (&before.1, "job work j"),
            (&before.1, "job run j --update"),
        ] {
            std::fs::write(at("dem.tif"), &before.0).unwrap();
            std::fs::write(at("j/output.json"), record).unwrap();
            run(&folder, again).works(&[]);
            assert!(bytes(at("dem.tif")) == after.0, "{step}, {again}");
        }
        before = after;
    }
    let left = files_of(&at("j"));
    assert!(left.iter().all(|name| !name.starts_with('.')), "{left:?}");
}

/// What ends an update says how to go on so that the job stays.
#[test]
fn an_update_that_fails_says_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut damaged = bytes(valley());
    let start = u32::from_le_bytes(damaged[96..100].try_into().unwrap()) as usize + 8;
    let end = damaged.len() - 40;
    damaged[start..end].fill(0xff);
    std::fs::write(folder.path().join("a.laz"), damaged).unwrap();
    let words = "dem a.laz --class 2 --tiles 2x2 --update -o dem.tif";
    for _ in 0..2 {
        run(&folder, words).fails(1, &["finished tasks are kept in ", "go on with --update"]);
    }
}

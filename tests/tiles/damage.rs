//! Random damage to the files of jobs: what comes out is what came out before, or an error that
//! names a file.
//!
//! `BREAKLINE_DAMAGE=2000 cargo test --test tiles damage` judges as many cases.

use std::path::Path;

use tempfile::TempDir;
use testkit::lidar;
use testkit::random::Random;

use super::{bytes, layer, program, run};
use program::{Run, files_of};

/// A job of each product that is done, with others whose files must not count in it.
struct Done {
    /// The command without the output.
    words: String,
    out: &'static str,
    /// What it wrote.
    product: Vec<u8>,
    /// The folders of the job; of the same command when an input was older; and of another command.
    jobs: [String; 3],
    /// What the other command wrote.
    other_product: Vec<u8>,
}

/// The bytes of an output, and of all parts that it has.
fn product(folder: &TempDir, out: &str) -> Vec<u8> {
    let path = folder.path().join(out);
    let mut all = bytes(&path);
    let parts = format!("{out}.");
    for name in files_of(folder.path())
        .iter()
        .filter(|name| name.starts_with(&parts))
    {
        let parts = path.with_file_name(name);
        files_of(&parts)
            .iter()
            .for_each(|part| all.extend(bytes(parts.join(part))));
    }
    all
}

fn remove_product(folder: &TempDir, out: &str) {
    for name in files_of(folder.path())
        .iter()
        .filter(|name| name.starts_with(out))
    {
        let path = folder.path().join(name);
        if path.is_dir() {
            std::fs::remove_dir_all(path).unwrap()
        } else {
            std::fs::remove_file(path).unwrap()
        }
    }
}

fn copy_job(folder: &TempDir, from: &str, to: &str) {
    let [from, to] = [from, to].map(|name| folder.path().join(name));
    let _ = std::fs::remove_dir_all(&to);
    std::fs::create_dir_all(to.join("tasks")).unwrap();
    let tasks = files_of(&from.join("tasks"))
        .into_iter()
        .map(|name| format!("tasks/{name}"));
    for name in tasks.chain(["plan.json".to_owned(), "command.json".to_owned()]) {
        std::fs::copy(from.join(&name), to.join(&name)).unwrap();
    }
}

/// Files of points: three that overlap, and four that are tiles; lines, and a boundary.
fn write_inputs(folder: &TempDir, random: &mut Random) {
    let mut points = |corner: [usize; 2], side: usize, count: usize| {
        let corners = [[0, 0], [side, 0], [0, side], [side, side]];
        let others = (0..count)
            .map(|_| [random.index(side + 1), random.index(side + 1)])
            .collect::<Vec<_>>();
        let all = corners.into_iter().chain(others);
        let point = |[x, y]: [usize; 2]| [(corner[0] + x) as f64, (corner[1] + y) as f64];
        let mut heights = Random(corner[0] as u64 + count as u64);
        let points = all.map(|at| (point(at), heights.index(40) as f64 / 4.0));
        let points: Vec<([f64; 3], u8)> = points
            .map(|([x, y], z)| ([x, y, z], 2 + (z as u8) % 2))
            .collect();
        lidar::las(&points, Some(25832))
    };
    for (i, corner) in [[0, 0], [8, 3], [5, 9]].into_iter().enumerate() {
        std::fs::write(
            folder.path().join(format!("{i}.las")),
            points(corner, 16, 150),
        )
        .unwrap();
    }
    for (i, corner) in [[0, 0], [11, 0], [0, 11], [11, 11]].into_iter().enumerate() {
        std::fs::write(
            folder.path().join(format!("tile{i}.las")),
            points(corner, 10, 80),
        )
        .unwrap();
    }
    let lines = [
        vec![[1.0, 2.0, 5.0], [12.0, 11.5, 7.0], [20.0, 11.0, 3.0]],
        vec![[3.0, 14.0, 9.0], [14.0, 4.5, 1.0]],
    ];
    std::fs::write(folder.path().join("l.geojson"), layer(&lines, "LineString")).unwrap();
    let ring = vec![
        [1.5, 1.5, 0.0],
        [22.5, 2.5, 0.0],
        [19.5, 23.5, 0.0],
        [2.5, 21.5, 0.0],
        [1.5, 1.5, 0.0],
    ];
    std::fs::write(folder.path().join("b.geojson"), layer(&[ring], "Polygon")).unwrap();
}

fn prepared(folder: &TempDir, random: &mut Random) -> Vec<Done> {
    let commands = [
        (
            "dem ?.las --breaklines l.geojson --boundary b.geojson --max-edge 9 --tiles 2x2",
            "dem.tif",
        ),
        ("contour ?.las --interval 0.5 --tiles 3x2", "lines.geojson"),
        (
            "tin ?.las --breaklines l.geojson --max-edge none --tiles 2x2",
            "parts.tins",
        ),
        ("hillshade tile?.las --tiles auto", "tiles.tif"),
    ];
    let job = |number: usize, what: &str, words: &str, out: &str| {
        let name = format!("{what}{number}");
        run(folder, &format!("job plan {name} -- {words} -o {out}")).works(&[]);
        run(folder, &format!("job run {name}")).works(&[]);
        let written = product(folder, out);
        remove_product(folder, out);
        (name, written)
    };
    write_inputs(folder, &mut Random(1));
    let older: Vec<_> = (0..)
        .zip(commands)
        .map(|(i, (words, out))| job(i, "older", words, out))
        .collect();
    write_inputs(folder, random);
    let all = (0..)
        .zip(commands)
        .zip(older)
        .map(|((i, (words, out)), older)| {
            let (own, product) = job(i, "own", words, out);
            let (other, other_product) = job(i, "other", &format!("{words} --class 3"), out);
            assert!(product != other_product && product != older.1, "{words}");
            Done {
                words: words.to_owned(),
                out,
                product,
                jobs: [own, older.0, other],
                other_product,
            }
        });
    all.collect()
}

/// Damages one of the files, and returns what was done.
fn damage(tasks: &Path, folder: &TempDir, done: &Done, random: &mut Random) -> String {
    let names = files_of(tasks);
    let name = &names[random.index(names.len())];
    let path = tasks.join(name);
    let mut own = bytes(&path);
    let at = match random.index(2) {
        // Anywhere, or in the end, which says what is where.
        0 => random.index(own.len().max(1)),
        _ => own.len().saturating_sub(1 + random.index(500)),
    };
    let what = match random.index(9) {
        0 | 1 if !own.is_empty() => {
            own[at] ^= 1 << random.index(8);
            std::fs::write(&path, own).unwrap();
            format!("a bit of byte {at}")
        }
        2 => {
            let count = 1 + random.index(20);
            for _ in 0..count.min(own.len()) {
                let at = random.index(own.len());
                own[at] = random.index(256) as u8;
            }
            std::fs::write(&path, own).unwrap();
            format!("{count} bytes")
        }
        3 => {
            std::fs::write(&path, &own[..at]).unwrap();
            format!("only {at} bytes")
        }
        4 => {
            std::fs::write(&path, "").unwrap();
            "empty".to_owned()
        }
        5 => {
            // A block of a disk that was never written.
            let end = own.len().min(at + 512);
            own[at.min(end)..end].fill(0);
            std::fs::write(&path, own).unwrap();
            format!("zeros from {at}")
        }
        6 => {
            let other = &names[random.index(names.len())];
            let bytes_of_other = bytes(tasks.join(other));
            std::fs::write(tasks.join(other), own).unwrap();
            std::fs::write(&path, bytes_of_other).unwrap();
            format!("exchanged with {other}")
        }
        7 => {
            let other = &names[random.index(names.len())];
            std::fs::copy(tasks.join(other), &path).unwrap();
            format!("a copy of {other}")
        }
        _ => {
            let job = &done.jobs[1 + random.index(2)];
            let from = folder.path().join(job).join("tasks");
            let others = files_of(&from);
            let same = others.contains(name) && random.index(4) > 0;
            let other = if same {
                name
            } else {
                &others[random.index(others.len())]
            };
            std::fs::copy(from.join(other), &path).unwrap();
            format!("{other} of {job}")
        }
    };
    format!("{name}: {what}")
}

/// Fails unless the run wrote the product, or named a file that is wrong. Returns whether it wrote.
#[track_caller]
fn judge(folder: &TempDir, ran: &Run, out: &str, expected: &[u8], case: &str) -> bool {
    if ran.code == 0 {
        assert!(
            product(folder, out) == expected,
            "{case}: used\n{}",
            ran.stderr
        );
        return true;
    }
    let names_it = [
        "work/tasks/",
        "work/plan.json",
        "work/command.json",
        "work: the job in this folder is that of another",
    ];
    assert!(
        names_it.iter().any(|name| ran.stderr.contains(name)),
        "{case}: not named\n{}",
        ran.stderr
    );
    assert!(!folder.path().join(out).exists(), "{case}");
    false
}

/// Runs single tasks, as a batch queue does, up to the output; damages files after one of them.
fn run_singly(folder: &TempDir, count: usize, first: usize, mut between: impl FnMut(usize)) -> Run {
    for task in first..=count {
        let ran = run(folder, &format!("job run work --task {task}"));
        if ran.code != 0 || task == count {
            return ran;
        }
        between(task);
    }
    unreachable!("the last task is the output")
}

#[test]
fn damaged_and_foreign_files_are_refused_or_made_again() {
    let cases = std::env::var("BREAKLINE_DAMAGE").map_or(12, |count| count.parse().unwrap());
    let seed = std::env::var("BREAKLINE_SEED").map_or(35, |seed| seed.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(seed);
    let all = prepared(&folder, &mut random);
    let tasks = folder.path().join("work/tasks");
    let (mut written, mut refused) = (0, 0);
    for number in 0..cases {
        let done = &all[number % all.len()];
        copy_job(&folder, &done.jobs[0], "work");
        let count = files_of(&tasks).len();
        let mode = random.index(4);
        let (mut case, mut expected) = (
            format!("case {number}, mode {mode}, {}", done.words),
            &done.product,
        );
        let ran = if mode == 0 {
            // Damage while the tasks are done one by one.
            files_of(&tasks)
                .iter()
                .for_each(|name| std::fs::remove_file(tasks.join(name)).unwrap());
            let stop = random.index(count);
            run_singly(&folder, count, 0, |task| {
                if task == stop {
                    case = format!(
                        "{case}; after task {task} {}",
                        damage(&tasks, &folder, done, &mut random)
                    );
                }
            })
        } else {
            for _ in 0..1 + random.index(2) {
                case = format!("{case}; {}", damage(&tasks, &folder, done, &mut random));
            }
            // Tasks that are still to be done, of all those that need what was damaged.
            let first = random.index(count + 1);
            for task in first..count {
                if random.index(5) > 0 {
                    let _ = std::fs::remove_file(tasks.join(format!("{task:06}.task")));
                }
            }
            case = format!("{case}; from {first}");
            match random.index(12) {
                0 => {
                    let name = random.pick(&["plan.json", "command.json"]);
                    let path = folder.path().join("work").join(name);
                    let mut text = bytes(&path);
                    let at = random.index(text.len());
                    text[at] ^= 1 << random.index(8);
                    std::fs::write(path, text).unwrap();
                    case = format!("{case}; {name} at {at}");
                }
                1 => {
                    std::fs::copy(
                        folder.path().join(&done.jobs[2]).join("plan.json"),
                        folder.path().join("work/plan.json"),
                    )
                    .unwrap();
                    case = format!("{case}; another plan");
                }
                2 => {
                    for name in ["plan.json", "command.json"] {
                        let from = folder.path().join(&done.jobs[2]).join(name);
                        std::fs::copy(from, folder.path().join("work").join(name)).unwrap();
                    }
                    expected = &done.other_product;
                    case = format!("{case}; another job");
                }
                _ => {}
            }
            match mode {
                1 => run(&folder, "job run work"),
                2 if expected == &done.product => run(
                    &folder,
                    &format!("{} --job work --resume -o {}", done.words, done.out),
                ),
                _ => run_singly(&folder, count, first, |_| {}),
            }
        };
        if judge(&folder, &ran, done.out, expected, &case) {
            written += 1;
        } else {
            refused += 1;
            // Whatever was refused is made again, unless it is the plan.
            run(&folder, "job status work --verify");
            let again = run(&folder, "job run work");
            let is_whole = judge(&folder, &again, done.out, expected, &case);
            let is_of_plan = ["plan.json", "command.json", "another command"]
                .iter()
                .any(|name| again.stderr.contains(name));
            assert!(is_whole || is_of_plan, "{case}");
        }
        remove_product(&folder, done.out);
    }
    eprintln!("{cases} cases: {written} written, {refused} refused");
    assert!(
        cases < 12 || (written > 0 && refused > 0),
        "{written} {refused}"
    );
}

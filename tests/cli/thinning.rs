//! Points that are thinned, as it is typed.

use std::fs;

use super::{bytes, fixture, folder_with, run_in, run_with};
use testkit::lidar::las;

/// Points of two classes in no order; heights repeat.
fn cloud(count: u32, offset: f64) -> Vec<([f64; 3], u8)> {
    let spread = |k: u32, factor: u32| f64::from(k.wrapping_mul(factor) >> 16) / 65536.0 * 40.0;
    (0..count)
        .map(|k| {
            let [x, y] = [spread(k, 2_654_435_769), spread(k, 1_103_515_245)];
            let [x, y] = [x, y].map(|axis| (axis * 100.0).round() / 100.0);
            ([x + offset, y, f64::from(k % 7)], 2 + (k % 2) as u8)
        })
        .collect()
}

/// The records of a LAS file in format 0.
fn records(file: &[u8]) -> Vec<&[u8]> {
    let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as usize;
    file[start..].chunks_exact(20).collect()
}

/// The position of a record in hundredths, and its height.
fn position(record: &[u8]) -> [i32; 3] {
    [0, 4, 8].map(|at| i32::from_le_bytes(record[at..at + 4].try_into().unwrap()))
}

#[test]
fn kept_points_are_records_of_the_input_in_their_order() {
    let folder = folder_with(&[]);
    for (name, offset) in [("a.las", 0.0), ("b.las", 35.0)] {
        let file = las(&cloud(3000, offset), Some(25832));
        fs::write(folder.path().join(name), file).unwrap();
    }
    run_in(&folder, &["points", "a.las", "b.las", "-o", "all.las"]).works(&["6000 points of 6000"]);
    let all = bytes(&folder, "all.las");
    let all = records(&all);
    let thin = |rule: &[&str], output: &str| {
        let words = [
            &["points", "a.las", "b.las", "--thin"],
            rule,
            &["-o", output],
        ]
        .concat();
        let run = run_in(&folder, &words);
        run.works(&["points of 6000", " thinned"]);
        bytes(&folder, output)
    };
    for rule in [
        &["grid:2"][..],
        &["grid:2", "--thin-keep", "highest"],
        &["poisson:1.5", "--seed", "18446744073709551615"],
        &["nth:7"],
        &["random:0.25"],
        &["random:0.25", "--seed", "1", "--threads", "1"],
    ] {
        let name = rule.join("-").replace(':', "-") + ".las";
        let kept = thin(rule, &name);
        let kept = records(&kept);
        let mut rest = all.iter();
        assert!(
            kept.iter().all(|record| rest.any(|other| other == record)),
            "{rule:?}"
        );
        assert!((100..3000).contains(&kept.len()), "{rule:?} {}", kept.len());
        // Selected first, then thinned.
        let words = [
            "points",
            "a.las",
            "b.las",
            "--class",
            "3",
            "-o",
            "three.las",
            "--overwrite",
        ];
        run_in(&folder, &words).works(&["3000 of other classes"]);
        let both = [
            &["points", "three.las", "--thin"],
            rule,
            &["-o", "x.las", "--overwrite"],
        ]
        .concat();
        run_in(&folder, &both).works(&[]);
        let at_once = [
            &["points", "a.las", "b.las", "--class", "3", "--thin"],
            rule,
            &["-o", "y.las", "--overwrite"],
        ]
        .concat();
        run_in(&folder, &at_once).works(&["3000 of other classes", "thinned"]);
        assert_eq!(
            records(&bytes(&folder, "x.las")),
            records(&bytes(&folder, "y.las")),
            "{rule:?}"
        );
    }
}

#[test]
fn cells_of_files_agree_and_keep_what_is_asked_for() {
    let folder = folder_with(&[]);
    // The border between the files, at 36, is a multiple of the size of a cell.
    let [left, right]: [Vec<_>; 2] = [false, true].map(|is_right| {
        cloud(6000, 20.0)
            .into_iter()
            .filter(|(p, _)| (p[0] >= 36.0) == is_right)
            .collect()
    });
    for (name, points) in [("l.las", &left), ("r.las", &right)] {
        fs::write(folder.path().join(name), las(points, None)).unwrap();
    }
    for keep in ["center", "lowest", "highest"] {
        let thin = |files: &[&str], output: &str| {
            let options = [
                "--thin",
                "grid:3",
                "--thin-keep",
                keep,
                "--overwrite",
                "-o",
                output,
            ];
            run_in(&folder, &[&["points"], files, &options].concat()).works(&[]);
        };
        thin(&["l.las", "r.las"], "once.las");
        thin(&["l.las"], "lt.las");
        thin(&["r.las"], "rt.las");
        run_in(
            &folder,
            &[
                "points",
                "lt.las",
                "rt.las",
                "-o",
                "twice.las",
                "--overwrite",
            ],
        )
        .works(&[]);
        let once = bytes(&folder, "once.las");
        assert_eq!(
            records(&once),
            records(&bytes(&folder, "twice.las")),
            "{keep}"
        );
        let all: Vec<_> = left
            .iter()
            .chain(&right)
            .map(|(p, _)| p.map(|c| (c * 100.0).round() as i32))
            .collect();
        for kept in records(&once).iter().map(|record| position(record)) {
            let cell = |p: &[i32; 3]| [p[0].div_euclid(300), p[1].div_euclid(300)];
            let heights = all.iter().filter(|p| cell(p) == cell(&kept)).map(|p| p[2]);
            match keep {
                "lowest" => assert_eq!(heights.min(), Some(kept[2])),
                "highest" => assert_eq!(heights.max(), Some(kept[2])),
                _ => assert!(heights.count() > 0),
            }
        }
    }
}

#[test]
fn real_points_keep_a_distance() {
    let folder = folder_with(&[]);
    let valley = fixture("valley.laz");
    run_in(
        &folder,
        &["points", &valley, "--thin", "poisson:8", "-o", "p.xyz"],
    )
    .works(&[" thinned"]);
    run_in(&folder, &["points", &valley, "-o", "all.xyz"]).works(&[]);
    let read = |name: &str| -> Vec<[f64; 2]> {
        let text = String::from_utf8(bytes(&folder, name)).unwrap();
        let number = |line: &str, k| line.split(' ').nth(k).unwrap().parse().unwrap();
        text.lines()
            .map(|line| [number(line, 0), number(line, 1)])
            .collect()
    };
    let (kept, all) = (read("p.xyz"), read("all.xyz"));
    let is_close = |p: &[f64; 2], q: &[f64; 2]| {
        let [x, y] = [0, 1].map(|k| (p[k] - q[k]) / 8.0);
        x * x + y * y < 1.0
    };
    for (i, p) in kept.iter().enumerate() {
        assert!(!kept[..i].iter().any(|q| is_close(p, q)), "{p:?}");
    }
    assert!(
        all.iter()
            .step_by(17)
            .all(|p| kept.iter().any(|q| q == p || is_close(p, q)))
    );
}

#[test]
fn standard_input_and_text_are_thinned() {
    let folder = folder_with(&[]);
    let text = "0.5 0.4 1\n0.5 0.5 2\n1.5 0.5 3\n-0.5 0.5 4\n";
    let run = |rule: &str, output: &str| {
        run_with(
            &folder,
            &["points", "-", "--thin", rule, "-o", output],
            text,
        )
    };
    run("grid:1", "g.xyz").works(&["3 points of 4, 1 thinned"]);
    assert_eq!(
        bytes(&folder, "g.xyz"),
        b"0.5 0.5 2\n1.5 0.5 3\n-0.5 0.5 4\n"
    );
    run("poisson:1", "p.csv").works(&["3 points of 4, 1 thinned"]);
    run("nth:3", "n.xyz").works(&["2 points of 4, 2 thinned"]);
    assert_eq!(bytes(&folder, "n.xyz"), b"0.5 0.4 1\n-0.5 0.5 4\n");
    run("random:1", "r.xyz").works(&["4 points of 4\n"]);
    run("random:1e-9", "none.xyz").fails(
        2,
        &["the thinning leaves out all 4", "a larger share for --thin"],
    );
    assert!(!folder.path().join("none.xyz").exists());
}

#[test]
fn rules_that_make_no_sense_are_refused() {
    let folder = folder_with(&[("a.xyz", "5000000 1 1\n2 2 2\n")]);
    let run = |options: &[&str]| {
        run_in(
            &folder,
            &[&["points", "a.xyz", "-o", "b.xyz"], options].concat(),
        )
    };
    for (rule, said) in [
        (
            "grid:0",
            "the size of a cell is 0: expected a finite number above zero",
        ),
        ("grid:-2", "the size of a cell is -2"),
        ("poisson:nan", "the distance is NaN"),
        ("nth:0", "every 0th point"),
        ("nth:2.5", "`2.5` is not a whole number above zero"),
        ("random:1.5", "1.5 is not a share of points"),
        ("grid:one", "`one` is not a number"),
        ("every:3", "`every:3` is no thinning: expected `grid:SIZE`"),
    ] {
        run(&["--thin", rule]).fails(2, &[said]);
    }
    run(&["--thin", "nth:2", "--thin-keep", "lowest"]).fails(
        2,
        &[
            "--thin-keep chooses the point of a cell",
            "--thin grid:SIZE",
        ],
    );
    run(&["--thin", "grid:2", "--seed", "1"]).fails(
        2,
        &[
            "--seed is of pseudo-random choices",
            "--thin poisson:DISTANCE",
        ],
    );
    run(&["--seed", "1"]).fails(2, &["--thin"]);
    run(&["--thin", "grid:1e-8"]).fails(1, &["a.xyz", "2^40 times", "a larger length for --thin"]);
    assert!(!folder.path().join("b.xyz").exists());
}

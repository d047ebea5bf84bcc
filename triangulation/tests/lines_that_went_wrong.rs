//! Lines that once failed, by name: files of `fixtures/constraints`, and lines that other packages
//! displaced.

use testkit::case::{Case, Point};
use testkit::judge;
use testkit::subject::build;

/// Every failure that was found and fixed stays here, reduced.
#[test]
fn named_cases() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/constraints");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "poly")
        {
            let case = Case::from_poly(&std::fs::read_to_string(&path).unwrap());
            assert_eq!(judge::pass(&case), Ok(()), "{}", path.display());
            count += 1;
        }
    }
    assert!(count > 0, "no case was found");
}

/// Under its usual robust setting CGAL 6.1 moves one of these by meters, depending on the order.
#[test]
fn displaced_breakline() {
    let shift = |p: Point| [p[0] + 500_000.0, p[1] + 4_649_000.0];
    let lines =
        [[[89.3, 64.3], [101.0, 65.48]], [[82.3, 63.6], [93.3, 64.7]]].map(|line| line.map(shift));
    let there = Case::of_segments(&[], &lines);
    let back = Case::of_segments(&[], &[lines[1], lines[0]]);
    assert_eq!(judge::pass(&there), Ok(()));
    assert_eq!(judge::pass(&back), Ok(()));
    let [there, back] = [there, back].map(|case| build(&case).unwrap());
    assert!(there.rounding.unwrap().on_grid);
    let points = |line: usize, built: &testkit::subject::Built| -> Vec<Point> {
        built.chains[line]
            .iter()
            .map(|&v| *built.triangulation.point(v))
            .collect()
    };
    assert_eq!(points(0, &there), points(1, &back));
    assert_eq!(points(1, &there), points(0, &back));
}

/// The format in which failures are written is the one that is read.
#[test]
fn files_keep_points_and_lines() {
    let mut case = Case::of_segments(
        &[[1e300, -1e-310], [0.1, 4_649_000.12]],
        &[[[0.0, 1.0], [2.0, 3.0]]],
    );
    case.lines.push(vec![0, 1, 2, 0]);
    case.lines.push(vec![0, 1]);
    assert_eq!(Case::from_poly(&case.to_poly()), case);
}

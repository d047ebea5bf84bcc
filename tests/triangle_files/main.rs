//! Files of Triangle: read and written through the program as it is run.
//!
//! | file | law |
//! |---|---|
//! | [`written`] | what comes out is what Triangle's users expect, number by number |
//! | [`refined`] | added vertices reach what is asked for, and carry attributes |
//! | [`damaged`] | a damaged file gives an error with file, line, value and cure, and nothing is written |
//! | [`check`] | `check` finds every kind of flaw and believes what is right |

#[path = "../common/program.rs"]
mod program;

mod check;
mod damaged;
mod refined;
mod written;

use program::{Run, files_of, folder_with, run_in};
use tempfile::TempDir;

fn run(folder: &TempDir, args: &str) -> Run {
    run_in(folder, &args.split(' ').collect::<Vec<_>>())
}

/// The numbers of a file, line by line, without comments.
fn table(folder: &TempDir, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
    let rows = text.lines().map(|line| line.split('#').next().unwrap());
    let rows = rows.map(|line| {
        line.split_whitespace()
            .map(|word| word.parse().unwrap())
            .collect()
    });
    rows.filter(|row: &Vec<f64>| !row.is_empty()).collect()
}

/// Twice the area of a triangle, exact for small whole numbers.
fn twice_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The places of the corners of all triangles of `NAME.ele`.
fn triangles(folder: &TempDir, name: &str) -> Vec<[[f64; 2]; 3]> {
    let nodes = table(folder, &format!("{name}.node"));
    let elements = table(folder, &format!("{name}.ele"));
    assert_eq!(
        (nodes[0][0], elements[0][0]),
        (nodes.len() as f64 - 1.0, elements.len() as f64 - 1.0)
    );
    let first = nodes.get(1).map_or(0.0, |row| row[0]);
    let site = |number: f64| {
        let row = &nodes[1 + (number - first) as usize];
        assert_eq!(row[0], number);
        [row[1], row[2]]
    };
    elements[1..]
        .iter()
        .map(|row| [site(row[1]), site(row[2]), site(row[3])])
        .collect()
}

/// A square with a square hole, as Triangle's page on `.poly` files has it.
const BOX: &str = "\
# A box with eight vertices in the plane, no attributes, one boundary marker.
8 2 0 1
# Outer box.
1   0 0   0
2   3 0   0
3   3 3   33
4   0 3   0
# Inner square.
5   1 1   0
6   1 2   0
7   2 1   0
8   2 2   0
# Eight segments with boundary markers.
8 1
1   1 2   5
2   5 7   10
3   7 8   10
4   8 6   10
5   6 5   10
6   2 3   0
7   3 4   0
8   4 1   0
# One hole in the middle of the inner square.
1
1   1.5 1.5
";

//! What the paper prints: Table 1 of *Triangulations in CGAL* (Boissonnat, Devillers, Pion,
//! Teillaud and Yvinec 2002), in seconds on a Pentium III of 500 MHz.

/// The sets of points, in the order of the columns below.
const SETS: [&str; 6] = ["square", "terrain", "parabola", "cube", "object", "moment"];

/// CGAL's times, by kernel and strategy. The kernels are the paper's `double`, 24-bit integers with
/// a static filter, intervals before exact integers, and exact integers alone.
const CGAL: [(&str, &str, [f64; 6]); 6] = [
    ("Fast", "jump and walk", [4.0, 5.6, 14.0, 10.6, 16.6, 20.8]),
    ("Fixed", "walk", [18.6, 20.7, 453.0, 21.0, 27.8, 27.5]),
    ("Fixed", "jump and walk", [4.2, 5.8, 16.0, 12.6, 20.2, 25.0]),
    ("Fixed", "hierarchy", [2.8, 3.6, 20.0, 12.1, 18.2, 24.0]),
    (
        "Interval",
        "jump and walk",
        [15.2, 20.7, 64.0, 62.0, 97.0, 55.0],
    ),
    (
        "Exact",
        "jump and walk",
        [151.0, 199.0, 548.0, 860.0, 1346.0, 750.0],
    ),
];

/// The least time of any program: divide and conquer in the plane (Shewchuk), the hierarchy in
/// space (Devillers).
const LEAST: [f64; 6] = [1.3, 2.2, 1.1, 10.9, 15.9, 17.0];

/// Returns CGAL's time for a set of points; `None` if the paper has none.
pub(crate) fn of_cgal(kernel: &str, strategy: &str, set: &str) -> Option<f64> {
    let column = SETS.iter().position(|&name| name == set)?;
    CGAL.iter()
        .find(|row| (row.0, row.1) == (kernel, strategy))
        .map(|row| row.2[column])
}

/// Returns the least time of any program for a set of points.
pub(crate) fn least(set: &str) -> Option<f64> {
    SETS.iter()
        .position(|&name| name == set)
        .map(|column| LEAST[column])
}

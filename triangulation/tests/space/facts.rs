//! What the tests of other packages assert, hostile sets, and files of points.

use std::path::{Path, PathBuf};

use breakline_triangulation::geometry::Space;
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::{Delaunay, Level};
use testkit::random::{Random, ulps};

use super::alpha::points_of;

type Point = [f64; 3];
type Robust = Delaunay<Space<Wide>, 4>;

#[test]
fn a_coplanar_grid_has_dimension_two() {
    let points: Vec<Point> = (0..400)
        .map(|i| [f64::from(i % 20), f64::from(i / 20), 0.0])
        .collect();
    let (bulk, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
    let mut t = Delaunay::<Space, 4>::new(Space::new());
    points.iter().for_each(|&p| _ = t.insert(p).unwrap());
    for t in [&bulk, &t] {
        assert_eq!(
            (t.dimension(), t.vertex_count(), t.finite_cells().count()),
            (2, 400, 2 * 19 * 19)
        );
        assert_eq!(t.check(Level::Law), []);
    }
}

/// Builds a set at once and one by one, checks both, and returns the number of finite cells.
fn build(name: &str, points: &[Point]) -> usize {
    let (bulk, vertices) = Robust::from_points(Space::default(), points).unwrap();
    assert_eq!(vertices.len(), points.len());
    let checked = if points.len() <= 5000 {
        Level::Law
    } else {
        Level::Links
    };
    assert_eq!(bulk.check(checked), [], "{name}");
    if points.len() <= 5000 {
        let mut t = Robust::new(Space::default());
        points.iter().for_each(|&p| _ = t.insert(p).unwrap());
        assert_eq!(t.dimension(), bulk.dimension(), "{name}");
        assert_eq!(t.tds().cell_count(), bulk.tds().cell_count(), "{name}");
    }
    bulk.finite_cells().count()
}

/// The kinds of ../shared/bench/triangulation/hostile.py, in space.
#[test]
fn hostile_sets() {
    let mut random = Random(43);
    let mut scaled = |scale: f64| {
        (0..500)
            .map(|_| [0; 3].map(|_| random.unit() * scale))
            .collect::<Vec<Point>>()
    };
    let mut sets: Vec<(&str, Vec<Point>)> = [1e300, 1e150, 1e-100, 1e-160, 1e-310]
        .map(|size| ("scaled", scaled(size)))
        .into();
    let base = scaled(1.0);
    let whole = |range: std::ops::RangeInclusive<i32>| range.map(f64::from);
    let side = whole(-15..=15)
        .flat_map(|x| whole(-15..=15).flat_map(move |y| whole(-15..=15).map(move |z| [x, y, z])));
    sets.push((
        "one sphere",
        side.filter(|p| p.iter().map(|x| x * x).sum::<f64>() == 225.0)
            .collect(),
    ));
    sets.push((
        "one sphere and its center",
        [&sets[5].1[..], &[[0.0; 3]]].concat(),
    ));
    sets.push((
        "one line",
        (0..800).map(|i| [i, 2 * i, 3 * i].map(f64::from)).collect(),
    ));
    sets.push((
        "nearly a line",
        (0..500)
            .map(|i| [0.1, 0.3, 0.7].map(|x| x * f64::from(i)))
            .collect(),
    ));
    sets.push((
        "one plane",
        (0..400)
            .map(|i| {
                [
                    f64::from(i % 20),
                    f64::from(i / 20),
                    f64::from(i % 20 + i / 20),
                ]
            })
            .collect(),
    ));
    sets.push((
        "nearly a plane",
        (0..400)
            .map(|i| {
                [
                    0.1 * f64::from(i % 20),
                    0.3 * f64::from(i / 20),
                    0.1 * f64::from(i % 20) + 0.3 * f64::from(i / 20),
                ]
            })
            .collect(),
    ));
    sets.push((
        "single roundings apart",
        (0..400)
            .map(|_| [0; 3].map(|_| ulps(0.5, random.around(3))))
            .collect(),
    ));
    let mixed = |random: &mut Random| random.unit() * 10f64.powf(60.0 * random.unit() - 30.0);
    sets.push((
        "all magnitudes",
        (0..500)
            .map(|_| [0; 3].map(|_| mixed(&mut random)))
            .collect(),
    ));
    sets.push((
        "a lattice",
        (0..1000)
            .map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from))
            .collect(),
    ));
    sets.push(("one point many times", vec![[1.5, 2.5, -3.5]; 1_000_000]));
    sets.push((
        "few points many times",
        (0..200_000).map(|_| random.pick(&base)).collect(),
    ));
    sets.push(("nothing", Vec::new()));
    let found: Vec<usize> = sets
        .iter()
        .map(|(name, points)| build(name, points))
        .collect();
    // One cell where one vertex is in dimension 0.
    assert_eq!((found[14], found[16]), (1, 0), "{found:?}");
    for bad in [f64::NAN, f64::INFINITY] {
        let mut points = base.clone();
        points[100][1] = bad;
        assert!(Robust::from_points(Space::default(), &points).is_err());
        assert!(Robust::new(Space::default()).insert(points[100]).is_err());
    }
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.retain(|file| {
        file.extension()
            .is_some_and(|extension| extension == "off" || extension == "xyz")
    });
    files.sort();
    files
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_file_of_points_checks() {
    let mut checked = 0;
    for folder in ["points3d", "points3d/generated", "plc3d"] {
        for file in files(&testkit::shared(folder)) {
            let points = points_of(&file);
            let (t, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
            assert_eq!(t.check(Level::Law), [], "{}", file.display());
            checked += usize::from(t.vertex_count() >= 8);
        }
    }
    assert!(checked >= 15, "{checked}");
}

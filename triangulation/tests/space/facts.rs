//! What the tests of other packages assert, hostile sets, and files of points.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{ConflictZone, Delaunay, Level, Regular, Triangulation};
use testkit::random::{Random, ulps};

use super::alpha::points_of;

type Point = [f64; 3];
type Robust = Delaunay<Space<Wide>, 4>;

#[test]
fn a_coplanar_grid_has_dimension_two() {
    let points: Vec<Point> = (0..400).map(|i| [f64::from(i % 20), f64::from(i / 20), 0.0]).collect();
    let (bulk, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
    let mut t = Delaunay::<Space, 4>::new(Space::new());
    points.iter().for_each(|&p| _ = t.insert(p).unwrap());
    for t in [&bulk, &t] {
        assert_eq!((t.dimension(), t.vertex_count(), t.finite_cells().count()), (2, 400, 2 * 19 * 19));
        assert_eq!(t.check(Level::Law), []);
    }
}

/// A cell by its vertices, sorted; infinite ones last.
fn sorted<G: breakline_triangulation::geometry::Geometry<4>>(t: &Triangulation<G, 4>, cell: CellId) -> Vec<VertexId> {
    let mut vertices = t.tds().cell_vertices(cell).to_vec();
    vertices.sort_unstable();
    vertices
}

/// The vertices on the facets around a zone in space.
fn border_vertices<G: breakline_triangulation::geometry::Geometry<4>>(
    t: &Triangulation<G, 4>,
    zone: &ConflictZone,
) -> BTreeSet<VertexId> {
    let others = |&(cell, i): &(CellId, usize)| {
        let vertices = t.tds().cell_vertices(cell).iter().enumerate();
        vertices.filter(move |&(k, _)| k != i).map(|(_, &v)| v).collect::<Vec<_>>()
    };
    zone.border.iter().flat_map(others).collect()
}

/// A zone is what insertion destroys, and its border what it keeps of that.
#[test]
fn a_conflict_zone_is_what_insertion_destroys() {
    let mut random = Random(41);
    let (mut closed, mut low) = (0, 0);
    for round in 0..300 {
        let sizes = [[3, 3, 3], [5, 5, 5], [4, 4, 1], [9, 1, 1], [40, 40, 40]][round % 5];
        let mut point = |weight: u64| {
            let [x, y, z] = sizes.map(|size| random.below(size) as f64);
            [x, y, z, random.below(weight) as f64]
        };
        let points: Vec<[f64; 4]> = (0..20).map(|_| point(1)).collect();
        let sites: Vec<Point> = points.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::new(), &sites).unwrap();
        for _ in 0..6 {
            let [x, y, z, _] = point(1);
            let q = [x, y, z];
            let mut after = t.clone();
            let vertex = after.insert(q).unwrap();
            let cells = |t: &Delaunay<Space, 4>| -> BTreeSet<Vec<VertexId>> {
                t.tds().cells().map(|cell| sorted(t, cell)).collect()
            };
            let (before, kept) = (cells(&t), cells(&after));
            let Some(zone) = t.conflict_zone(&q, None) else {
                assert!(before == kept || after.dimension() > t.dimension());
                continue;
            };
            let destroyed: BTreeSet<_> = before.difference(&kept).cloned().collect();
            assert_eq!(zone.cells.iter().map(|&cell| sorted(&t, cell)).collect::<BTreeSet<_>>(), destroyed);
            let star: BTreeSet<_> = kept.difference(&before).cloned().collect();
            assert_eq!(star.len(), zone.border.len());
            assert!(star.iter().all(|cell| cell.contains(&vertex)));
            low += usize::from(t.dimension() < 3);
            if t.dimension() == 3 {
                closed += 1;
                assert_eq!(zone.border.len(), 2 * border_vertices(&t, &zone).len() - 4);
            }
        }
    }
    assert!(closed > 500 && low > 100, "{closed} and {low}: hardly a test");
}

#[test]
fn a_hidden_point_destroys_nothing() {
    let mut random = Random(42);
    let mut seen = [0, 0];
    for round in 0..200 {
        let side = [3, 4, 7][round % 3];
        let mut point = || {
            let [x, y, z] = [0; 3].map(|_| random.below(side) as f64);
            [x, y, z, random.below(8) as f64]
        };
        let points: Vec<[f64; 4]> = (0..25).map(|_| point()).collect();
        let (t, _) = Regular::<WeightedSpace, 4>::from_points(WeightedSpace::new(), &points).unwrap();
        for _ in 0..6 {
            let q = point();
            let mut after = t.clone();
            after.insert(q).unwrap();
            let cells = |t: &Regular<WeightedSpace, 4>| -> BTreeSet<Vec<[u64; 4]>> {
                let bits =
                    |&v: &VertexId| if v == VertexId::INFINITE { [u64::MAX; 4] } else { t.point(v).map(f64::to_bits) };
                let corners = |cell| {
                    let mut corners: Vec<_> = t.tds().cell_vertices(cell).iter().map(bits).collect();
                    corners.sort_unstable();
                    corners
                };
                t.tds().cells().map(corners).collect()
            };
            let is_site = points.iter().any(|p| p[..3] == q[..3]);
            if is_site || t.dimension() < 3 {
                continue;
            }
            match t.conflict_zone(&q, None) {
                None => assert_eq!(cells(&t), cells(&after)),
                Some(zone) => {
                    let lost = cells(&t).difference(&cells(&after)).count();
                    assert_eq!(lost, zone.cells.len());
                    assert_eq!(zone.border.len(), 2 * border_vertices(&t, &zone).len() - 4);
                    seen[1] += 1;
                    continue;
                }
            }
            seen[0] += 1;
        }
    }
    assert!(seen.iter().all(|&seen| seen > 50), "{seen:?}: hardly a test");
}

/// Builds a set at once and one by one, checks both, and returns the number of finite cells.
fn build(name: &str, points: &[Point]) -> usize {
    let (bulk, vertices) = Robust::from_points(Space::default(), points).unwrap();
    assert_eq!(vertices.len(), points.len());
    let checked = if points.len() <= 5000 { Level::Law } else { Level::Links };
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
    let mut scaled = |scale: f64| (0..500).map(|_| [0; 3].map(|_| random.unit() * scale)).collect::<Vec<Point>>();
    let mut sets: Vec<(&str, Vec<Point>)> =
        [1e300, 1e150, 1e-100, 1e-160, 1e-310].map(|size| ("scaled", scaled(size))).into();
    let base = scaled(1.0);
    let whole = |range: std::ops::RangeInclusive<i32>| range.map(f64::from);
    let side = whole(-15..=15).flat_map(|x| whole(-15..=15).flat_map(move |y| whole(-15..=15).map(move |z| [x, y, z])));
    sets.push(("one sphere", side.filter(|p| p.iter().map(|x| x * x).sum::<f64>() == 225.0).collect()));
    sets.push(("one sphere and its center", [&sets[5].1[..], &[[0.0; 3]]].concat()));
    sets.push(("one line", (0..800).map(|i| [i, 2 * i, 3 * i].map(f64::from)).collect()));
    sets.push(("nearly a line", (0..500).map(|i| [0.1, 0.3, 0.7].map(|x| x * f64::from(i))).collect()));
    sets.push((
        "one plane",
        (0..400).map(|i| [f64::from(i % 20), f64::from(i / 20), f64::from(i % 20 + i / 20)]).collect(),
    ));
    sets.push((
        "nearly a plane",
        (0..400)
            .map(|i| {
                [0.1 * f64::from(i % 20), 0.3 * f64::from(i / 20), 0.1 * f64::from(i % 20) + 0.3 * f64::from(i / 20)]
            })
            .collect(),
    ));
    sets.push(("single roundings apart", (0..400).map(|_| [0; 3].map(|_| ulps(0.5, random.around(3)))).collect()));
    let mixed = |random: &mut Random| random.unit() * 10f64.powf(60.0 * random.unit() - 30.0);
    sets.push(("all magnitudes", (0..500).map(|_| [0; 3].map(|_| mixed(&mut random))).collect()));
    sets.push(("a lattice", (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect()));
    sets.push(("one point many times", vec![[1.5, 2.5, -3.5]; 1_000_000]));
    sets.push(("few points many times", (0..200_000).map(|_| random.pick(&base)).collect()));
    sets.push(("nothing", Vec::new()));
    let found: Vec<usize> = sets.iter().map(|(name, points)| build(name, points)).collect();
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
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_file_of_points_checks() {
    let mut checked = 0;
    for folder in ["points3d", "points3d/generated", "plc3d"] {
        for file in files(&testkit::shared(folder)).into_iter().filter(|file| file.is_file()) {
            let points = points_of(&file);
            let (t, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
            assert_eq!(t.check(Level::Law), [], "{}", file.display());
            checked += usize::from(t.vertex_count() >= 8);
        }
    }
    assert!(checked >= 15, "{checked}");
}

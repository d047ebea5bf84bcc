//! Insertions and removals in any order lead to the triangulation of the points that remain.
//!
//! With `BREAKLINE_REMOVALS=200000` in the environment, this many sequences are tried.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::kernel::{Adaptive, Exact, Interval, Kernel, Wide};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Delaunay, Level};
use testkit::random::Random;

type Point = [f64; 3];
type Cells = BTreeSet<Vec<Option<[u64; 3]>>>;

/// The cells by their points: what does not depend on numbers.
fn cells<K: Kernel>(t: &Delaunay<Space<K>, 4>) -> Cells {
    let bits =
        |&v: &VertexId| (v != VertexId::INFINITE).then(|| t.point(v).map(|x| (x + 0.0).to_bits()));
    let corners = |cell| {
        let mut corners: Vec<_> = t.tds().cell_vertices(cell).iter().map(bits).collect();
        corners.sort_unstable();
        corners
    };
    t.tds().cells().map(corners).collect()
}

/// Compares a triangulation with that of its points, built anew.
fn judge<K: Kernel>(t: &Delaunay<Space<K>, 4>) {
    let points: Vec<Point> = t.tds().vertices().map(|v| *t.point(v)).collect();
    let (anew, _) = Delaunay::from_points(Space::<K>::default(), &points).unwrap();
    assert_eq!(t.dimension(), anew.dimension(), "{points:?}");
    assert_eq!(cells(t), cells(&anew), "{points:?}");
    assert_eq!(t.check(Level::Law), [], "{points:?}");
}

/// How many sequences to try, unless the environment asks for more.
fn rounds(least: usize) -> usize {
    std::env::var("BREAKLINE_REMOVALS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(least)
}

fn sequence<K: Kernel>(random: &mut Random, point: impl Fn(&mut Random) -> Point) {
    let mut t = Delaunay::<Space<K>, 4>::new(Space::default());
    let steps = 4 + random.below(40);
    for _ in 0..steps {
        let vertices: Vec<VertexId> = t.tds().vertices().collect();
        let p = point(random);
        if random.below(5) < 3 || vertices.is_empty() {
            t.insert(p).unwrap();
            continue;
        }
        let vertex = random.pick(&vertices);
        let old = *t.point(vertex);
        if random.below(3) == 0 {
            let is_taken = vertices.iter().any(|&v| v != vertex && *t.point(v) == p);
            let moved = t.move_to(vertex, p).unwrap();
            assert_eq!(
                (*t.point(moved), moved == vertex, t.tds().is_vertex(vertex)),
                (p, !is_taken, !is_taken)
            );
        } else {
            assert_eq!(t.remove(vertex), Ok(old));
            assert!(t.remove(vertex).is_err());
        }
    }
    judge(&t);
    for vertex in t.tds().vertices().collect::<Vec<_>>() {
        t.remove(vertex).unwrap();
        judge(&t);
    }
    assert_eq!((t.dimension(), t.tds().cell_count()), (-1, 0));
}

fn on_grid(sizes: [u64; 3]) -> impl Fn(&mut Random) -> Point {
    move |random| sizes.map(|size| random.below(size) as f64)
}

#[test]
fn on_small_grids() {
    let mut random = Random(1);
    for round in 0..rounds(400) {
        let sizes = [
            [2, 2, 2],
            [3, 3, 1],
            [3, 2, 2],
            [4, 1, 1],
            [3, 3, 3],
            [5, 5, 2],
        ][round % 6];
        match round % 5 {
            0 => sequence::<Exact>(&mut random, on_grid(sizes)),
            1 => sequence::<Interval>(&mut random, on_grid(sizes)),
            2 => sequence::<Wide>(&mut random, on_grid(sizes)),
            _ => sequence::<Adaptive>(&mut random, on_grid(sizes)),
        }
    }
}

#[test]
fn of_random_points() {
    let mut random = Random(2);
    for _ in 0..rounds(100) {
        sequence::<Adaptive>(&mut random, |random| [0; 3].map(|_| random.unit()));
    }
}

/// The sequence that CGAL's tests have: a lattice, emptied vertex by vertex.
#[test]
fn a_lattice_is_emptied() {
    let points: Vec<Point> = (0..125)
        .map(|k| [k / 25, k / 5 % 5, k % 5].map(f64::from))
        .collect();
    let mut t = Delaunay::<Space, 4>::new(Space::new());
    for &p in &points {
        t.insert(p).unwrap();
    }
    judge(&t);
    for vertex in t.tds().vertices().collect::<Vec<_>>() {
        t.remove(vertex).unwrap();
        judge(&t);
    }
}

/// Where the law does not hold, the other vertices stay.
#[test]
fn without_the_law() {
    let mut t = Delaunay::<WeightedSpace, 4>::new(WeightedSpace::new());
    let corners = [
        [0.0, 0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0, 0.0],
        [0.0, 4.0, 0.0, 0.0],
        [0.0, 0.0, 4.0, 0.0],
    ];
    let first = t.insert(corners[0]).unwrap();
    corners[1..].iter().for_each(|&p| _ = t.insert(p).unwrap());
    t.insert([1.0, 1.0, 1.0, -99.0]).unwrap();
    t.remove(first).unwrap();
    assert_eq!((t.vertex_count(), t.dimension()), (4, 3));
    assert_eq!(t.check(Level::Links), []);
}

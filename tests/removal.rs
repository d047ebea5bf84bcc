//! Vertices taken out again: what is left is the triangulation of the rest, cell for cell.

mod common;

use std::collections::BTreeSet;

use breakline::geometry::{Coordinates, Geometry, Plane};
use breakline::kernel::Exact;
use breakline::num::Sign;
use breakline::tds::VertexId;
use breakline::triangulation::{ConstrainedDelaunay, Delaunay, Level, Triangulation};
use common::random::{Random, ulps};

type Point = [f64; 2];
type Constrained = ConstrainedDelaunay<Plane>;
type Free = Delaunay<Plane, 3>;

/// The finite cells of any dimension as sorted points.
fn cells<C: Copy + Default>(t: &Triangulation<Plane, 3, (), C>) -> BTreeSet<Vec<[u64; 2]>> {
    // Bits order negative numbers wrongly, which does no harm here.
    let place = |v: &VertexId| t.geometry().coordinates(t.point(*v)).map(f64::to_bits);
    t.finite_cells()
        .map(|cell| {
            let mut corners: Vec<_> = t.tds().cell_vertices(cell).iter().map(place).collect();
            corners.sort_unstable();
            corners
        })
        .collect()
}

fn fresh(points: &[Point]) -> Free {
    Delaunay::from_points(Plane::default(), points).unwrap().0
}

/// Numbers, holes and counts fit each other and the points that are left.
fn same_as_fresh(t: &Free, left: &[Point]) {
    assert_eq!(t.check(Level::Law), [], "{left:?}");
    let expected = fresh(left);
    assert_eq!((t.dimension(), t.vertex_count()), (expected.dimension(), expected.vertex_count()), "{left:?}");
    assert_eq!(t.tds().vertices().count(), t.vertex_count());
    assert_eq!(cells(t), cells(&expected), "{left:?}");
}

/// Takes the points out in this order, down to nothing, and puts them in again; each state is compared.
fn empties_and_fills(points: &[Point], order: &[usize]) {
    let (mut t, vertices): (Free, _) = Delaunay::from_points(Plane::default(), points).unwrap();
    let slots = t.tds().vertex_slots();
    let mut left = points.to_vec();
    for &at in order {
        let was_there = left.contains(&points[at]);
        left.retain(|p| *p != points[at]);
        assert_eq!(t.remove(vertices[at]), was_there.then_some(points[at]));
        assert!(!t.tds().is_vertex(vertices[at]));
        same_as_fresh(&t, &left);
    }
    assert_eq!((t.dimension(), t.vertex_count(), t.tds().cell_count()), (-1, 0, 0));
    for &at in order {
        t.insert(points[at]).unwrap();
        left.push(points[at]);
        same_as_fresh(&t, &left);
    }
    assert_eq!(t.tds().vertex_slots(), slots, "holes are filled first");
}

#[test]
fn every_vertex_of_every_subset_of_a_tiny_grid() {
    for subset in 1u32..1 << 9 {
        let points: Vec<Point> =
            (0..9).filter(|k| subset >> k & 1 == 1).map(|k| [f64::from(k % 3), f64::from(k / 3)]).collect();
        for at in 0..points.len() {
            let (mut t, vertices): (Free, _) = Delaunay::from_points(Plane::default(), &points).unwrap();
            assert_eq!(t.remove(vertices[at]), Some(points[at]));
            let mut left = points.clone();
            left.remove(at);
            same_as_fresh(&t, &left);
            t.insert(points[at]).unwrap();
            same_as_fresh(&t, &points);
        }
    }
}

/// All orders of removal of the points of a 3 x 3 grid: each state is a subset, known from the test above to be
/// right one step from a fresh one; here it is what is left of a long history.
#[test]
fn a_tiny_grid_in_all_orders() {
    fn descend(t: &Free, expected: &[BTreeSet<Vec<[u64; 2]>>], subset: usize) -> usize {
        let mut states = 1;
        for v in t.tds().vertices() {
            let mut next = t.clone();
            let [x, y] = next.remove(v).unwrap();
            let rest = subset & !(1 << (x as usize + 3 * y as usize));
            assert!(cells(&next) == expected[rest], "{subset:b} without {:?}", [x, y]);
            // Links and orientation follow from those of larger sets, which are fewer.
            if rest.count_ones() > 4 {
                assert_eq!(next.check(Level::Law), []);
            }
            states += descend(&next, expected, rest);
        }
        states
    }
    let grid = |subset: usize| -> Vec<Point> {
        (0..9).filter(|k| subset >> k & 1 == 1).map(|k| [(k % 3) as f64, (k / 3) as f64]).collect()
    };
    let expected: Vec<_> = (0..1 << 9).map(|subset| cells(&fresh(&grid(subset)))).collect();
    // 9! / k! paths for each k: 986 410 in all.
    assert_eq!(descend(&fresh(&grid(511)), &expected, 511), 986_410);
}

#[test]
fn grids_down_to_nothing_and_up_again() {
    let mut random = Random(1);
    for _ in 0..1500 {
        let side = 1 + random.below(6);
        let scale = random.pick(&[1.0, 0.37, 1e-3]);
        let points: Vec<Point> =
            (0..1 + random.below(24)).map(|_| [(); 2].map(|()| random.below(side) as f64 * scale)).collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        empties_and_fills_once_each(&points, &order);
    }
}

/// Points that are given twice share a vertex: its number is free after the first removal.
fn empties_and_fills_once_each(points: &[Point], order: &[usize]) {
    let mut seen: Vec<Point> = Vec::new();
    let mut once = Vec::new();
    for &at in order {
        if !seen.contains(&points[at]) {
            seen.push(points[at]);
            once.push(at);
        }
    }
    empties_and_fills(points, &once);
}

#[test]
fn scattered_points() {
    let mut random = Random(2);
    for round in 0..150 {
        let count = 3 + random.below(40);
        let points: Vec<Point> = (0..count)
            .map(|_| match round % 3 {
                0 => [random.unit(), random.unit()],
                1 => [500_000.0 + random.unit(), 4_649_000.0 + 1e-7 * random.unit()],
                _ => [ulps(1.0, random.around(3)), ulps(2.0, random.around(3))],
            })
            .collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        empties_and_fills_once_each(&points, &order);
    }
}

#[test]
fn collinear_points_and_one_beside() {
    let mut random = Random(3);
    for round in 0..200 {
        let [dx, dy] = random.pick(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, -1.0], [-3.0, 1.0]]);
        let count = 1 + random.below(8);
        let mut points: Vec<Point> = (0..count).map(|k| [dx * k as f64, dy * k as f64]).collect();
        if round % 2 == 0 {
            points.push([2.0, 7.0]);
        }
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        empties_and_fills(&points, &order);
    }
}

/// Vertices with hundreds of neighbors: inside of a circle or a line's ends, and at the hull.
#[test]
fn fans() {
    let circle = |k: i32| {
        let angle = f64::from(k) * 0.01;
        [100.0 * angle.cos(), 100.0 * angle.sin()]
    };
    let chords: Vec<Point> = (0..628).map(circle).collect();
    let line: Vec<Point> = (0..500).map(|k| [f64::from(k), 0.0]).collect();
    let parabola: Vec<Point> = (-250..250).map(|k| [f64::from(k), f64::from(k * k) / 512.0]).collect();
    let cap: Vec<Point> = parabola.iter().map(|&[x, y]| [x, -y]).collect();
    let lattice_circle: Vec<Point> = (-325..=325)
        .flat_map(|x: i32| {
            let y = f64::from(325 * 325 - x * x).sqrt();
            [[f64::from(x), y], [f64::from(x), -y]].into_iter().filter(move |_| y.fract() == 0.0)
        })
        .collect();
    let cases = [
        (chords.clone(), [0.0, 0.0]),
        (chords, [3.0, 99.0]),
        (line.clone(), [250.0, 1000.0]),
        (line, [-1.0, 0.0]),
        (parabola.clone(), [0.0, -1e5]),
        (parabola, [0.0, 1e5]),
        (cap, [0.0, 1e4]),
        (lattice_circle, [0.0, 0.0]),
    ];
    for (points, p) in cases {
        let mut t = fresh(&points);
        let v = t.insert(p).unwrap();
        assert_eq!(t.remove(v), Some(p));
        same_as_fresh(&t, &points);
    }
}

#[test]
fn what_is_not_there_cannot_be_removed() {
    let mut t = fresh(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let v = t.tds().vertices().next().unwrap();
    assert_eq!(t.remove(VertexId::INFINITE), None);
    assert_eq!(t.remove(VertexId::new(3)), None);
    assert!(t.remove(v).is_some());
    assert_eq!(t.remove(v), None);
    assert_eq!((t.vertex_count(), t.tds().vertex_slots(), t.tds().vertices().count()), (2, 3, 2));
}

/// Whether two segments cross between their ends.
fn cross([a, b]: &[Point; 2], [c, d]: &[Point; 2]) -> bool {
    let g = Plane::<Exact>::default();
    let turn = |p, q, r| g.orientation([p, q, r]);
    turn(a, b, c) * turn(a, b, d) == Sign::Negative && turn(c, d, a) * turn(c, d, b) == Sign::Negative
}

fn lies_on([a, b]: &[Point; 2], p: &Point) -> bool {
    let g = Plane::<Exact>::default();
    let (low, high) = if g.compare(a, b).is_lt() { (a, b) } else { (b, a) };
    g.orientation([a, b, p]) == Sign::Zero && g.compare(low, p).is_le() && g.compare(p, high).is_le()
}

fn walled(points: &[Point], walls: &[[Point; 2]]) -> Constrained {
    let (mut t, _) = Constrained::from_points(Plane::default(), points).unwrap();
    for wall in walls {
        t.insert_polyline(wall).unwrap();
    }
    t
}

fn same_walls(t: &Constrained, points: &[Point], walls: &[[Point; 2]]) {
    assert_eq!(t.check(Level::Law), [], "{points:?} {walls:?}");
    let expected = walled(points, walls);
    assert_eq!(
        (t.dimension(), t.vertex_count()),
        (expected.dimension(), expected.vertex_count()),
        "{points:?} {walls:?}"
    );
    assert_eq!(cells(t), cells(&expected), "{points:?} {walls:?}");
    let edges = |t: &Constrained| -> BTreeSet<[[u64; 2]; 2]> {
        let sorted = |[a, b]: [[u64; 2]; 2]| if a < b { [a, b] } else { [b, a] };
        t.constrained_edges().map(|edge| sorted(edge.map(|v| t.point(v).map(f64::to_bits)))).collect()
    };
    assert_eq!(edges(t), edges(&expected), "{points:?} {walls:?}");
}

/// Free vertices go one after the other; then the walls are cleared, edge by edge; then the rest goes, and all
/// comes back.
fn walls_hold(points: Vec<Point>, walls: Vec<[Point; 2]>, random: &mut Random) -> usize {
    let mut t = walled(&points, &walls);
    let mut left = points.clone();
    let mut removed = 0;
    let mut numbers: Vec<VertexId> = t.tds().vertices().collect();
    random.shuffle(&mut numbers);
    for &v in &numbers {
        let p = *t.point(v);
        let on_wall = t.constrained_edges().flatten().any(|end| end == v);
        // All that counts while the points are collinear and walls wait.
        let is_met = walls.iter().any(|wall| lies_on(wall, &p));
        match t.remove_free(v) {
            Some(point) => {
                assert!(!on_wall && point == p);
                left.retain(|q| *q != p);
                removed += 1;
                same_walls(&t, &left, &walls);
            }
            None => assert!(on_wall || is_met, "{p:?} of {points:?} {walls:?}"),
        }
    }
    let mut pieces: Vec<[VertexId; 2]> = t.constrained_edges().collect();
    random.shuffle(&mut pieces);
    if t.dimension() == 2 {
        while let Some([a, b]) = pieces.pop() {
            assert!(t.clear_wall(b, a));
            assert!(!t.clear_wall(a, b));
            let kept: Vec<[Point; 2]> = pieces.iter().map(|edge| edge.map(|v| *t.point(v))).collect();
            same_walls(&t, &left, &kept);
            // Ends in other walls' sight, which nothing holds any more.
            let gone = if random.below(2) == 0 { t.remove_free(a) } else { None };
            if let Some(p) = gone {
                left.retain(|q| *q != p);
                removed += 1;
                same_walls(&t, &left, &kept);
            }
        }
        for v in t.tds().vertices().collect::<Vec<_>>() {
            let p = t.remove_free(v).unwrap();
            left.retain(|q| *q != p);
            same_walls(&t, &left, &[]);
        }
        for &p in &points {
            t.insert(p).unwrap();
        }
        for wall in &walls {
            t.insert_polyline(wall).unwrap();
        }
        same_walls(&t, &points, &walls);
    }
    removed
}

#[test]
fn walls_stay_on_tiny_grids() {
    let mut random = Random(4);
    let mut removed = 0;
    for _ in 0..3000 {
        let side = 2 + random.below(5);
        let points: Vec<Point> =
            (0..3 + random.below(22)).map(|_| [(); 2].map(|()| random.below(side) as f64)).collect();
        let mut walls: Vec<[Point; 2]> = Vec::new();
        for _ in 0..random.below(7) {
            let wall = [random.pick(&points), random.pick(&points)];
            if wall[0] != wall[1] && !walls.iter().any(|other| cross(other, &wall)) {
                walls.push(wall);
            }
        }
        removed += walls_hold(points, walls, &mut random);
    }
    assert!(removed > 10_000, "only {removed} were free");
}

/// Walls close to each other hide vertices that lie in each other's circles.
#[test]
fn thin_corridors_between_walls() {
    let mut random = Random(5);
    let mut removed = 0;
    for _ in 0..60 {
        let mut walls: Vec<[Point; 2]> = Vec::new();
        let mut points: Vec<Point> = Vec::new();
        for _ in 0..40 {
            let [x, y] = [100.0 * random.unit(), 100.0 * random.unit()];
            let angle = random.pick(&[0.0, 0.1, 0.2]) + 0.01 * random.unit();
            let length = 60.0 * random.unit();
            let wall = [[x, y], [x + length * f64::cos(angle), y + length * f64::sin(angle)]];
            if !walls.iter().any(|other| cross(other, &wall)) {
                walls.push(wall);
            }
        }
        points.extend((0..random.below(12)).map(|_| [100.0 * random.unit(), 100.0 * random.unit()]));
        points.extend(walls.iter().flatten());
        removed += walls_hold(points, walls, &mut random);
    }
    assert!(removed > 500, "only {removed} were free");
}

#[test]
fn walls_wait_while_all_is_on_a_line() {
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
    let mut t = walled(&points, &[]);
    let apex = t.insert([1.0, 5.0]).unwrap();
    t.insert_polyline(&[points[1], points[3]]).unwrap();
    assert_eq!(t.constrained_edges().count(), 2);
    assert_eq!(t.remove_free(apex), Some([1.0, 5.0]));
    assert_eq!((t.dimension(), t.constrained_edges().count()), (1, 0));
    let first = t.tds().vertices().find(|&v| *t.point(v) == points[0]).unwrap();
    let second = t.tds().vertices().find(|&v| *t.point(v) == points[1]).unwrap();
    assert_eq!(t.remove_free(second), None);
    assert_eq!(t.remove_free(first), Some(points[0]));
    t.insert([9.0, -5.0]).unwrap();
    assert_eq!(t.constrained_edges().count(), 2);
    assert_eq!(t.check(Level::Law), []);
}

//! Free vertices taken out between walls, and walls cleared: against a fresh build. `tests/plane/removal.rs` has the same
//! without walls.

use std::collections::BTreeSet;

use crate::geometry::{Coordinates, Geometry, Plane};
use crate::kernel::Exact;
use crate::num::Sign;
use crate::tds::VertexId;
use crate::triangulation::{ConstrainedDelaunay, Flaw, Level, LinesFlaw};
use testkit::random::Random;

type Point = [f64; 2];
type Constrained = ConstrainedDelaunay<Plane>;

/// The finite cells of any dimension as sorted points.
fn cells(t: &Constrained) -> BTreeSet<Vec<[u64; 2]>> {
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
        let [a, b] = wall.map(|p| t.insert(p).unwrap());
        insert_segment(&mut t, a, b);
    }
    t
}

/// Forces the edge between two vertices, with all that it meets on its way.
fn insert_segment(t: &mut Constrained, a: VertexId, b: VertexId) {
    assert!(t.lines.constrain(&mut t.inner, a, b));
}

/// All flaws but that the tables know of constraints that no line asks for, as is so here.
fn flaws(t: &Constrained) -> Vec<Flaw> {
    t.check(Level::Law).into_iter().filter(|flaw| *flaw != Flaw::Lines(LinesFlaw::Stray)).collect()
}

fn same_walls(t: &Constrained, points: &[Point], walls: &[[Point; 2]]) {
    assert_eq!(flaws(t), [], "{points:?} {walls:?}");
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

/// Free vertices go one after the other; then the walls are cleared, edge by edge; then the rest goes, and the
/// points come back.
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
        match t.lines.remove_free(&mut t.inner, v) {
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
            assert!(t.lines.release(&mut t.inner, b, a));
            assert!(!t.lines.release(&mut t.inner, a, b));
            let kept: Vec<[Point; 2]> = pieces.iter().map(|edge| edge.map(|v| *t.point(v))).collect();
            same_walls(&t, &left, &kept);
            // Ends in other walls' sight, which nothing holds any more.
            let gone = if random.below(2) == 0 { t.lines.remove_free(&mut t.inner, a) } else { None };
            if let Some(p) = gone {
                left.retain(|q| *q != p);
                removed += 1;
                same_walls(&t, &left, &kept);
            }
        }
        for v in t.tds().vertices().collect::<Vec<_>>() {
            let p = t.lines.remove_free(&mut t.inner, v).unwrap();
            left.retain(|q| *q != p);
            same_walls(&t, &left, &[]);
        }
        for &p in &points {
            t.insert(p).unwrap();
        }
        same_walls(&t, &points, &[]);
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
    let [second, last] = [points[1], points[3]].map(|p| t.insert(p).unwrap());
    insert_segment(&mut t, second, last);
    assert_eq!(t.constrained_edges().count(), 2);
    assert_eq!(t.lines.remove_free(&mut t.inner, apex), Some([1.0, 5.0]));
    assert_eq!((t.dimension(), t.constrained_edges().count()), (1, 0));
    let first = t.tds().vertices().find(|&v| *t.point(v) == points[0]).unwrap();
    let second = t.tds().vertices().find(|&v| *t.point(v) == points[1]).unwrap();
    assert_eq!(t.lines.remove_free(&mut t.inner, second), None);
    assert_eq!(t.lines.remove_free(&mut t.inner, first), Some(points[0]));
    t.insert([9.0, -5.0]).unwrap();
    assert_eq!(t.constrained_edges().count(), 2);
    assert_eq!(flaws(&t), []);
}

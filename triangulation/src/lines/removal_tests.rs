//! Removal of free vertices between constraints, and release of constraints, compared with
//! triangulations built from scratch. `tests/plane/removal.rs` has the same without constraints.

use std::collections::BTreeSet;

use crate::flaw::{Flaw, Level, LinesFlaw};
use crate::geometry::{Coordinates, Geometry, Plane};
use crate::kernel::Exact;
use crate::num::Sign;
use crate::tds::VertexId;

use super::constrained_delaunay::ConstrainedDelaunay;
use testkit::random::Random;

type Point = [f64; 2];
type Constrained = ConstrainedDelaunay<Plane>;

/// The finite cells of any dimension as sorted points.
fn cells(t: &Constrained) -> BTreeSet<Vec<[u64; 2]>> {
    // Bits order negative numbers wrongly, which does no harm here.
    let position = |v: &VertexId| t.geometry().coordinates(t.point(*v)).map(f64::to_bits);
    t.finite_cells()
        .map(|cell| {
            let mut corners: Vec<_> = t.tds().cell_vertices(cell).iter().map(position).collect();
            corners.sort_unstable();
            corners
        })
        .collect()
}

/// Returns true if two segments cross between their ends.
fn cross([a, b]: &[Point; 2], [c, d]: &[Point; 2]) -> bool {
    let g = Plane::<Exact>::default();
    let turn = |p, q, r| g.orientation([p, q, r]);
    turn(a, b, c) * turn(a, b, d) == Sign::Negative
        && turn(c, d, a) * turn(c, d, b) == Sign::Negative
}

fn lies_on([a, b]: &[Point; 2], p: &Point) -> bool {
    let g = Plane::<Exact>::default();
    let (low, high) = if g.compare(a, b).is_lt() {
        (a, b)
    } else {
        (b, a)
    };
    g.orientation([a, b, p]) == Sign::Zero
        && g.compare(low, p).is_le()
        && g.compare(p, high).is_le()
}

fn with_constraints(points: &[Point], constraints: &[[Point; 2]]) -> Constrained {
    let (mut t, _) = Constrained::from_points(Plane::default(), points).unwrap();
    for constraint in constraints {
        let [a, b] = constraint.map(|p| t.insert(p).unwrap());
        insert_segment(&mut t, a, b);
    }
    t
}

/// Constrains the segment between two vertices, with all vertices on it.
fn insert_segment(t: &mut Constrained, a: VertexId, b: VertexId) {
    assert!(t.lines.constrain(&mut t.inner, a, b));
}

/// All flaws, except that the tables contain constraints that are on no line, which is the case
/// here.
fn flaws(t: &Constrained) -> Vec<Flaw> {
    t.check(Level::Law)
        .into_iter()
        .filter(|flaw| *flaw != Flaw::Lines(LinesFlaw::Stray))
        .collect()
}

fn same_constraints(t: &Constrained, points: &[Point], constraints: &[[Point; 2]]) {
    assert_eq!(flaws(t), [], "{points:?} {constraints:?}");
    let expected = with_constraints(points, constraints);
    assert_eq!(
        (t.dimension(), t.vertex_count()),
        (expected.dimension(), expected.vertex_count()),
        "{points:?} {constraints:?}"
    );
    assert_eq!(cells(t), cells(&expected), "{points:?} {constraints:?}");
    let edges = |t: &Constrained| -> BTreeSet<[[u64; 2]; 2]> {
        let sorted = |[a, b]: [[u64; 2]; 2]| if a < b { [a, b] } else { [b, a] };
        t.constrained_edges()
            .map(|edge| sorted(edge.map(|v| t.point(v).map(f64::to_bits))))
            .collect()
    };
    assert_eq!(edges(t), edges(&expected), "{points:?} {constraints:?}");
}

/// Removes the free vertices one after the other; then releases the constraints, edge by edge; then
/// removes the other vertices and inserts the points again. Returns the number of free vertices
/// removed.
fn constraints_hold(
    points: Vec<Point>,
    constraints: Vec<[Point; 2]>,
    random: &mut Random,
) -> usize {
    let mut t = with_constraints(&points, &constraints);
    let mut left = points.clone();
    let mut removed = 0;
    let mut numbers: Vec<VertexId> = t.tds().vertices().collect();
    random.shuffle(&mut numbers);
    for &v in &numbers {
        let p = *t.point(v);
        let on_constraint = t.constrained_edges().flatten().any(|end| end == v);
        // While the points are collinear and constraints wait, only this counts.
        let is_met = constraints.iter().any(|constraint| lies_on(constraint, &p));
        match t.lines.remove_free(&mut t.inner, v) {
            Some(point) => {
                assert!(!on_constraint && point == p);
                left.retain(|q| *q != p);
                removed += 1;
                same_constraints(&t, &left, &constraints);
            }
            None => assert!(
                on_constraint || is_met,
                "{p:?} of {points:?} {constraints:?}"
            ),
        }
    }
    let mut edges: Vec<[VertexId; 2]> = t.constrained_edges().collect();
    random.shuffle(&mut edges);
    if t.dimension() == 2 {
        while let Some([a, b]) = edges.pop() {
            assert!(t.lines.release(&mut t.inner, b, a));
            assert!(!t.lines.release(&mut t.inner, a, b));
            let kept: Vec<[Point; 2]> =
                edges.iter().map(|edge| edge.map(|v| *t.point(v))).collect();
            same_constraints(&t, &left, &kept);
            // Ends in sight of other constraints, which are free now.
            let gone = if random.below(2) == 0 {
                t.lines.remove_free(&mut t.inner, a)
            } else {
                None
            };
            if let Some(p) = gone {
                left.retain(|q| *q != p);
                removed += 1;
                same_constraints(&t, &left, &kept);
            }
        }
        for v in t.tds().vertices().collect::<Vec<_>>() {
            let p = t.lines.remove_free(&mut t.inner, v).unwrap();
            left.retain(|q| *q != p);
            same_constraints(&t, &left, &[]);
        }
        for &p in &points {
            t.insert(p).unwrap();
        }
        same_constraints(&t, &points, &[]);
    }
    removed
}

#[test]
fn constraints_stay_on_tiny_grids() {
    let mut random = Random(4);
    let mut removed = 0;
    for _ in 0..3000 {
        let side = 2 + random.below(5);
        let points: Vec<Point> = (0..3 + random.below(22))
            .map(|_| [(); 2].map(|()| random.below(side) as f64))
            .collect();
        let mut constraints: Vec<[Point; 2]> = Vec::new();
        for _ in 0..random.below(7) {
            let constraint = [random.pick(&points), random.pick(&points)];
            if constraint[0] != constraint[1]
                && !constraints.iter().any(|other| cross(other, &constraint))
            {
                constraints.push(constraint);
            }
        }
        removed += constraints_hold(points, constraints, &mut random);
    }
    assert!(removed > 10_000, "only {removed} were free");
}

/// Constraints close to each other hide vertices that lie in each other's circles.
#[test]
fn thin_corridors_between_constraints() {
    let mut random = Random(5);
    let mut removed = 0;
    for _ in 0..60 {
        let mut constraints: Vec<[Point; 2]> = Vec::new();
        let mut points: Vec<Point> = Vec::new();
        for _ in 0..40 {
            let [x, y] = [100.0 * random.unit(), 100.0 * random.unit()];
            let angle = random.pick(&[0.0, 0.1, 0.2]) + 0.01 * random.unit();
            let length = 60.0 * random.unit();
            let constraint = [
                [x, y],
                [x + length * f64::cos(angle), y + length * f64::sin(angle)],
            ];
            if !constraints.iter().any(|other| cross(other, &constraint)) {
                constraints.push(constraint);
            }
        }
        points
            .extend((0..random.below(12)).map(|_| [100.0 * random.unit(), 100.0 * random.unit()]));
        points.extend(constraints.iter().flatten());
        removed += constraints_hold(points, constraints, &mut random);
    }
    assert!(removed > 500, "only {removed} were free");
}

#[test]
fn constraints_wait_while_all_is_on_a_line() {
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]];
    let mut t = with_constraints(&points, &[]);
    let apex = t.insert([1.0, 5.0]).unwrap();
    let [second, last] = [points[1], points[3]].map(|p| t.insert(p).unwrap());
    insert_segment(&mut t, second, last);
    assert_eq!(t.constrained_edges().count(), 2);
    assert_eq!(t.lines.remove_free(&mut t.inner, apex), Some([1.0, 5.0]));
    assert_eq!((t.dimension(), t.constrained_edges().count()), (1, 0));
    let first = t
        .tds()
        .vertices()
        .find(|&v| *t.point(v) == points[0])
        .unwrap();
    let second = t
        .tds()
        .vertices()
        .find(|&v| *t.point(v) == points[1])
        .unwrap();
    assert_eq!(t.lines.remove_free(&mut t.inner, second), None);
    assert_eq!(t.lines.remove_free(&mut t.inner, first), Some(points[0]));
    t.insert([9.0, -5.0]).unwrap();
    assert_eq!(t.constrained_edges().count(), 2);
    assert_eq!(flaws(&t), []);
}

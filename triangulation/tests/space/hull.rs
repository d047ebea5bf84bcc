//! Convex hulls of small sets of points, often coplanar and collinear, against all points.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Plane, Space, WeightedSpace};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{ConvexHull, Delaunay, Regular};
use testkit::random::Random;

type Whole = [i64; 3];

/// Six times the volume of a tetrahedron: positive if `d` is where `a b c` are counter-clockwise.
fn volume([a, b, c, d]: [Whole; 4]) -> i64 {
    let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|axis| p[axis] - a[axis]));
    let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
    u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)
}

fn judge(t: &Delaunay<Space, 4>) {
    let whole = |v: VertexId| t.point(v).map(|x| x as i64);
    let all: Vec<VertexId> = t.tds().vertices().collect();
    match t.convex_hull() {
        ConvexHull::Empty => assert_eq!(t.dimension(), -1),
        ConvexHull::Point(vertex) => assert!(t.dimension() == 0 && all == [vertex]),
        ConvexHull::Segment([first, last]) => {
            assert_eq!(t.dimension(), 1);
            assert!(
                all.iter()
                    .all(|&v| whole(first) <= whole(v) && whole(v) <= whole(last))
            );
        }
        ConvexHull::Polygon(rim) => {
            assert_eq!(t.dimension(), 2);
            assert_eq!(rim.iter().collect::<BTreeSet<_>>().len(), rim.len());
        }
        ConvexHull::Polyhedron {
            vertices,
            triangles,
        } => {
            assert_eq!(t.dimension(), 3);
            assert_eq!(triangles.len(), 2 * vertices.len() - 4);
            assert!(triangles.is_sorted() && vertices.is_sorted());
            let corners: BTreeSet<VertexId> = triangles.iter().flatten().copied().collect();
            assert!(corners.iter().eq(&vertices));
            let mut edges = BTreeSet::new();
            let mut six_times = 0;
            for &[a, b, c] in &triangles {
                assert!(
                    all.iter().all(|&v| volume([a, b, c, v].map(&whole)) <= 0),
                    "convex, outwards"
                );
                assert!(
                    [[a, b], [b, c], [c, a]]
                        .into_iter()
                        .all(|edge| edges.insert(edge)),
                    "oriented"
                );
                six_times -= volume([whole(a), whole(b), whole(c), [0; 3]]);
            }
            assert!(
                edges.iter().all(|&[a, b]| edges.contains(&[b, a])),
                "closed"
            );
            let cells = t
                .finite_cells()
                .map(|cell| volume(t.tds().corners(cell).map(&whole)));
            assert_eq!(six_times, cells.sum::<i64>());
        }
    }
}

#[test]
fn of_points_on_small_grids() {
    let mut random = Random(61);
    let mut dimensions = [0; 5];
    for round in 0..1500 {
        let sizes = [
            [3, 3, 3],
            [5, 5, 5],
            [5, 5, 1],
            [6, 1, 1],
            [2, 2, 2],
            [90, 90, 90],
        ][round % 6];
        let points: Vec<[f64; 3]> = (0..random.index(30))
            .map(|_| sizes.map(|size| random.below(size) as f64))
            .collect();
        let (t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
        dimensions[(t.dimension() + 1) as usize] += 1;
        judge(&t);
    }
    assert!(dimensions.iter().all(|&count| count > 20), "{dimensions:?}");
}

/// In a plane it is that of the plane.
#[test]
fn of_coplanar_points() {
    let mut random = Random(62);
    for _ in 0..500 {
        let side = 2 + random.below(6);
        let points: Vec<[f64; 2]> = (0..random.index(25))
            .map(|_| [random.below(side) as f64, random.below(side) as f64])
            .collect();
        let (plane, _) = Delaunay::from_points(Plane::new(), &points).unwrap();
        if plane.dimension() < 2 {
            continue;
        }
        let in_space: Vec<[f64; 3]> = points.iter().map(|&[x, y]| [x, y, x + 2.0 * y]).collect();
        let (t, _) = Delaunay::from_points(Space::new(), &in_space).unwrap();
        let ConvexHull::Polygon(rim) = t.convex_hull() else {
            panic!("coplanar")
        };
        let mut rim: Vec<[f64; 2]> = rim
            .iter()
            .map(|&v| [t.point(v)[0], t.point(v)[1]])
            .collect();
        let mut expected: Vec<[f64; 2]> = plane.tds().hull().map(|v| *plane.point(v)).collect();
        for ring in [&mut rim, &mut expected] {
            let first = (0..ring.len())
                .min_by(|&i, &j| ring[i].partial_cmp(&ring[j]).unwrap())
                .unwrap();
            ring.rotate_left(first);
        }
        assert_eq!(rim, expected);
    }
}

/// A light point on the hull may be hidden; it is no part of the result.
#[test]
fn of_weighted_points() {
    let mut random = Random(63);
    let corners = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 4.0 * f64::from(bit)));
    let mut points: Vec<[f64; 4]> = corners.map(|[x, y, z]| [x, y, z, 0.0]).collect();
    points.extend((0..40).map(|_| {
        let [x, y] = [0; 2].map(|_| random.below(5) as f64);
        [x, y, 0.0, -50.0]
    }));
    let (t, _) = Regular::from_points(WeightedSpace::new(), &points).unwrap();
    let ConvexHull::Polyhedron {
        vertices,
        triangles,
    } = t.convex_hull()
    else {
        panic!("a cube")
    };
    assert_eq!((vertices.len(), triangles.len()), (8, 12));
}

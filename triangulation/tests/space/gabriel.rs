//! Gabriel facets and edges against all vertices, in exact fractions.

use breakline_triangulation::geometry::{Space, WeightedSpace};
use breakline_triangulation::kernel::Wide;
use breakline_triangulation::tds::space::Edge;
use breakline_triangulation::tds::{CellId, Tds, VertexId};
use breakline_triangulation::{Delaunay, Regular};
use dashu_ratio::RBig;
use testkit::random::Random;

type Whole = [i64; 4];

fn dot(p: &[RBig; 3], q: &[RBig; 3]) -> RBig {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

fn vector(p: Whole, from: Whole) -> [RBig; 3] {
    [0, 1, 2].map(|k| RBig::from(p[k] - from[k]))
}

/// Returns true if no point has a negative power to the smallest sphere that is orthogonal to those
/// of a simplex; its center is found by eliminating one vector after the other (Gram and Schmidt).
fn is_empty(simplex: &[Whole], points: &[Whole]) -> bool {
    let a = simplex[0];
    let mut center = [RBig::ZERO, RBig::ZERO, RBig::ZERO];
    let mut basis: Vec<[RBig; 3]> = Vec::new();
    for &p in &simplex[1..] {
        let full = vector(p, a);
        let mut rest = full.clone();
        for other in &basis {
            let share = dot(&full, other) / dot(other, other);
            rest = [0, 1, 2].map(|k| &rest[k] - &share * &other[k]);
        }
        // 2 p . center = |p|^2 - (w_p - w_a), without leaving what is right for the others.
        let missing =
            (dot(&full, &full) - RBig::from(p[3] - a[3])) / RBig::from(2) - dot(&full, &center);
        let step = missing / dot(&rest, &rest);
        center = [0, 1, 2].map(|k| &center[k] + &step * &rest[k]);
        basis.push(rest);
    }
    let power = |p: Whole| {
        let from_center: [RBig; 3] = {
            let p = vector(p, a);
            [0, 1, 2].map(|k| &p[k] - &center[k])
        };
        dot(&from_center, &from_center) - RBig::from(p[3])
    };
    let square = power(a);
    points.iter().all(|&p| power(p) >= square)
}

/// The tests of a triangulation.
struct Tests<'t> {
    facet: &'t dyn Fn((CellId, usize)) -> bool,
    edge: &'t dyn Fn(Edge) -> bool,
}

/// Returns how many facets and edges are, and are not.
fn judge(tds: &Tds<4>, tests: &Tests, whole: impl Fn(VertexId) -> Whole) -> [usize; 2] {
    let all: Vec<Whole> = tds.vertices().map(&whole).collect();
    let mut counts = [0, 0];
    let mut compare = |simplex: &[VertexId], found: bool| {
        let is_finite = !simplex.contains(&VertexId::INFINITE);
        let corners: Vec<Whole> = simplex
            .iter()
            .filter(|_| is_finite)
            .map(|&v| whole(v))
            .collect();
        assert_eq!(
            found,
            is_finite && is_empty(&corners, &all),
            "{corners:?} {all:?}"
        );
        if is_finite {
            counts[usize::from(found)] += 1;
        }
    };
    for (cell, i) in tds.facets() {
        let mut simplex = tds.cell_vertices(cell).to_vec();
        simplex.remove(i);
        compare(&simplex, (tests.facet)((cell, i)));
        let beyond = tds.neighbor(cell, i);
        assert_eq!(
            (tests.facet)((cell, i)),
            (tests.facet)((beyond, tds.index_of_neighbor(beyond, cell)))
        );
    }
    for (cell, i, j) in tds.edges() {
        compare(&tds.edge_ends((cell, i, j)), (tests.edge)((cell, i, j)));
        assert_eq!((tests.edge)((cell, i, j)), (tests.edge)((cell, j, i)));
    }
    for cell in tds.cells() {
        assert!(
            !(tests.facet)((cell, 4)) && !(tests.edge)((cell, 0, 4)) && !(tests.edge)((cell, 1, 1))
        );
    }
    counts
}

const SIZES: [[u64; 3]; 5] = [[2, 2, 2], [4, 4, 4], [5, 5, 1], [6, 1, 1], [30, 30, 30]];

#[test]
fn of_delaunay() {
    let mut random = Random(71);
    let mut counts = [0, 0];
    for round in 0..100 {
        let sizes = SIZES[round % 5];
        let points: Vec<[f64; 3]> = (0..random.index(14))
            .map(|_| sizes.map(|size| random.below(size) as f64))
            .collect();
        let (t, _) = Delaunay::from_points(Space::new(), &points).unwrap();
        let tests = Tests {
            facet: &|facet| t.is_gabriel_facet(facet),
            edge: &|edge| t.is_gabriel_edge(edge),
        };
        let found = judge(t.tds(), &tests, |v| {
            let [x, y, z] = t.point(v).map(|x| x as i64);
            [x, y, z, 0]
        });
        counts = [0, 1].map(|k| counts[k] + found[k]);
    }
    assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
}

#[test]
fn of_regular() {
    let mut random = Random(72);
    let mut counts = [0, 0];
    for round in 0..100 {
        let (sizes, weights) = (SIZES[round % 5], 1 + random.below(12));
        let point = |random: &mut Random| {
            let [x, y, z] = sizes.map(|size| random.below(size) as f64);
            [x, y, z, random.below(weights) as f64]
        };
        let points: Vec<[f64; 4]> = (0..random.index(14)).map(|_| point(&mut random)).collect();
        let (t, _) = Regular::from_points(WeightedSpace::new(), &points).unwrap();
        let tests = Tests {
            facet: &|facet| t.is_gabriel_facet(facet),
            edge: &|edge| t.is_gabriel_edge(edge),
        };
        let found = judge(t.tds(), &tests, |v| t.point(v).map(|x| x as i64));
        counts = [0, 1].map(|k| counts[k] + found[k]);
    }
    assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
}

/// Ties and near ties are decided without rounding, also where products overflow or underflow.
#[test]
fn at_the_ends_of_floating_point() {
    for scale in [1.0, 1e300, 1e-310] {
        let at = |p: [f64; 3]| p.map(|x| x * scale);
        for (top, is_gabriel) in [
            (2.0, true),
            (2.0f64.next_down(), scale < 1e-300),
            (2.0f64.next_up(), true),
        ] {
            let corners = [
                [0.0, 2.0, 0.0],
                [4.0, 2.0, 0.0],
                [2.0, 2.0, top],
                [2.0, 9.0, 0.5],
            ]
            .map(at);
            let (t, v) =
                Delaunay::<Space<Wide>, 4>::from_points(Space::default(), &corners).unwrap();
            let edge = t.tds().finite_edges().find(|&edge| {
                let ends = t.tds().edge_ends(edge);
                ends.contains(&v[0]) && ends.contains(&v[1])
            });
            assert_eq!(
                edge.map(|edge| t.is_gabriel_edge(edge)),
                Some(is_gabriel),
                "{scale} {top}"
            );
        }
    }
}
